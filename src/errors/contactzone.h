/* The zone in which surfaces are in contact, by the cells behind it.

   What is in contact counts as known in estimates of errors, so that the error of the zone's end is in no cell's share.
   Pressures begin there as the root of the distance d, the surfaces part as d^(3/2), and the pressures of an adjoint
   solution, in which the zone stays as it is, are as d^(-1/2). Within the face of length h at the end their product
   leaves h^(3/2 - 1/2 + 1) = h^2. Source: Johnson, Contact Mechanics (Cambridge, 1985), 4 and 5. */
#pragma once
#include "solve/model.h"

typedef struct {
  PetscReal size;  /* mean size of the cells behind faces in contact, weighted with the forces; 0: there are none */
  PetscReal faces; /* of slaves in contact */
  PetscBool ends;  /* some face of a slave is in contact, and some is not */
} ContactZone;

PetscErrorCode ContactZoneFind(Model, PetscBool *cells, ContactZone *);
