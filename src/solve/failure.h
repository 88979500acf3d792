/* Where a solve failed: the nodes with the largest residuals, in gmsh's tags and reference coordinates, and an element
   that was turned inside out or in which a routine of the user failed.

   FailureLocate() finds them after a failed solve, FailureText() puts them into a message. */
#pragma once
#include "bodies/loads.h"
#include "contact/contact.h"

/* Number of nodes that a failure names. */
enum { FAILURE_NODES = 3 };

typedef struct {
  ContactPlace place;
  PetscReal    residual; /* norm of the node's free components (force) */
  PetscReal    gap;      /* of the slave node (length); NaN: it is no slave node, or no master is near */
  int          body;     /* the node's, as a number in the scene; -1: unknown */
  int          pair;     /* contact pair whose surfaces are nearest to the node; -1: the scene has none */
} FailureNode;

typedef struct {
  int         n;
  FailureNode node[FAILURE_NODES]; /* the largest residual comes first */
  PetscInt    inverted;            /* gmsh's tag of an inverted element, or -1 */
  int         point;               /* of that element, where a routine of the user failed (NPT); 0: none did */
  const char *routine;             /* what it did, where there is a point */
  PetscReal   squeeze;             /* smallest distance of two corners of a cell over that before any load */
  int         squeezed_body;       /* where that is, as a number in the scene */
  int         inverted_body;       /* its body, as a number in the scene, or -1 */
  PetscBool   enhanced;            /* the scene has enhanced strains, which may have found no equilibrium */
} Failure;

PetscErrorCode FailureLocate(Mesh, Loads, Contact, const PetscReal *u, const PetscReal *f, PetscInt inverted, int fault,
                             Failure *);
void           FailureText(Scene, const Failure *, char *text, size_t size);
