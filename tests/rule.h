/* An integration rule of a cell for tests that integrate exact fields. Include it once in a program. RuleCreate() makes
   the rule of an element type. */
#pragma once
#include "kernels/element.h"
#include <petscdt.h>

enum { RULE_POINTS = 64 }; /* of a cell, at most */

/* A quadrature of order p + 2 in each direction, which is more than that of the elements */
typedef struct {
  int       points;
  PetscReal weight[RULE_POINTS], N[RULE_POINTS][ELEMENT_MAX_NODES], dN[RULE_POINTS][ELEMENT_MAX_NODES * 3];
} Rule;

static PetscErrorCode RuleCreate(ElementType type, Rule *rule)
{
  const Element   *e       = ElementGet(type);
  const PetscBool  simplex = e->corners == e->dim + 1 ? PETSC_TRUE : PETSC_FALSE;
  const PetscReal *points, *weights;
  PetscQuadrature  quadrature;
  PetscInt         n;

  PetscFunctionBeginUser;
  if (simplex)
    PetscCall(PetscDTStroudConicalQuadrature(e->dim, 1, e->order + 2, -1, 1, &quadrature));
  else
    PetscCall(PetscDTGaussTensorQuadrature(e->dim, 1, e->order + 2, -1, 1, &quadrature));
  PetscCall(PetscQuadratureGetData(quadrature, NULL, NULL, &n, &points, &weights));
  PetscCheck(n <= RULE_POINTS, PETSC_COMM_SELF, PETSC_ERR_PLIB, "%" PetscInt_FMT " quadrature points", n);
  rule->points = (int)n;
  for (int q = 0; q < rule->points; q++) { /* The sides of PETSc's simplex are 2. */
    PetscReal xi[3];

    rule->weight[q] = weights[q] / (simplex ? 1 << e->dim : 1);
    for (int k = 0; k < e->dim; k++) xi[k] = simplex ? (points[q * e->dim + k] + 1) / 2 : points[q * e->dim + k];
    ElementShape(type, xi, rule->N[q], rule->dN[q], NULL);
  }
  PetscCall(PetscQuadratureDestroy(&quadrature));
  PetscFunctionReturn(PETSC_SUCCESS);
}
