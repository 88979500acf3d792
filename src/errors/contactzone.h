/* The zone in which surfaces are in contact, by the cells behind it.

   What is in contact counts as known in estimates of errors, so that the error of the zone's end is in no cell's share.
   Pressures begin there as the root of the distance d, the surfaces part as d^(3/2), and the pressures of an adjoint
   solution, in which the zone stays as it is, are as d^(-1/2). Within the face of length h at the end their product
   leaves h^(3/2 - 1/2 + 1) = h^2.

   How much that may be, a sphere's contact says. By Mossakovskii F is the integral of 2 E* a over the approach a^2 / R;
   a zone that ends at a (1 + x) instead leaves 1.5 x^2 of the force. The end is off by half a face at most. Source:
   Johnson, Contact Mechanics (Cambridge, 1985), 4 and 5. */
#pragma once
#include "solve/model.h"

typedef struct {
  PetscReal size;   /* mean size of the cells behind faces in contact, weighted with the forces; 0: there are none */
  PetscReal layers; /* of faces, one inside the other, from the end of the zone to its middle; 0: it has no end */
  PetscReal force;  /* sum of the magnitudes of the nodal forces on faces in contact */
  PetscBool ends;   /* some face of a slave is in contact, and some is not */
} ContactZone;

PetscErrorCode ContactZoneFind(Model, PetscBool *cells, ContactZone *);
PetscErrorCode ContactZoneOfPair(Model, int pair, PetscBool *cells, ContactZone *);
PetscReal      ContactZoneOff(const ContactZone *);
PetscReal      ContactZoneLeft(const ContactZone *);
PetscReal      ContactZoneLayers(PetscReal left);
