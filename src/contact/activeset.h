/* Which contact terms press at the end of a linear step.

   The step is that of a tangent in which some terms take part, pressed or pulled, and others do not. What the law says
   of their gaps at the end differs from that for terms that open or close in the step. Each of these is a force on the
   step, whose influence on all gaps is a column. With the columns of all terms that change, the step's own contact
   problem is solved to its end, as if the tangent had had the right terms.

   ActiveSetCreate(), then ActiveSetSolve() until it asks for no more columns, and ActiveSetAddColumns() for those that
   it asks for. No function communicates, and one rank needs it. */
#pragma once
#include "base/petsccompat.h"

typedef struct {
  PetscReal opening;   /* gap where the step begins, less LawOnsetGap() (length) */
  PetscReal pressure;  /* in the residual there */
  PetscReal stiffness; /* in the tangent; 0: the term takes no part in it */
  PetscReal penalty;   /* stiffness when pressed */
} ActiveSetTerm;

typedef struct _n_Pressing *ActiveSet;

PetscErrorCode ActiveSetCreate(PetscInt n, const ActiveSetTerm *, const PetscReal *travel, ActiveSet *);
PetscErrorCode ActiveSetDestroy(ActiveSet *);
PetscErrorCode ActiveSetAddColumns(ActiveSet, PetscInt m, const PetscInt *which, const PetscReal *G);
PetscErrorCode ActiveSetSolve(ActiveSet, PetscInt *m, PetscInt *which, PetscBool *converged);
PetscErrorCode ActiveSetLimit(ActiveSet, PetscInt most, PetscInt *m, PetscInt *which);
void           ActiveSetGet(ActiveSet, const PetscReal **excess, const PetscBool **pressed);
