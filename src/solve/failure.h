/* Where a solve failed: the nodes with the largest residuals, in gmsh's tags and reference coordinates, and an element
 * turned inside out. */
#pragma once
#include "contact/contact.h"
#include "bodies/loads.h"

enum { FAILURE_NODES = 3 };

typedef struct {
  ContactPlace place;
  PetscReal    residual; /* norm of the node's free components, a force */
  PetscReal    gap;      /* of the slave node; NaN: it is none, or no master is near */
} FailureNode;

typedef struct {
  int         n;
  FailureNode node[FAILURE_NODES]; /* largest residual first */
  PetscInt    inverted;            /* element, or -1 */
  PetscBool   enhanced;            /* it may be that its enhanced strains found no equilibrium */
} Failure;

/* f: n_nodes*dim local residuals of the failed iterate; inverted: an element of this rank, or -1; contact may be NULL.
 * Collective. */
PetscErrorCode FailureLocate(Mesh, Loads, Contact, const PetscReal *f, PetscInt inverted, Failure *);
/* "largest residual at node 17 (1, 2, 3)", for a message. Not collective. */
void FailureText(const Failure *, char *text, size_t size);
