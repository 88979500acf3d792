/* Which contact terms press at the end of a linear step. The step is that of a tangent in which some terms take part,
   pressed or pulled, and others do not; what the law says of their gaps at the end differs from that for terms that
   open or close on the way. Each of these is a force on the step, whose influence on all gaps is a column; with the
   columns of all that change the step's own contact problem is solved to its end, as if the tangent had had the right
   ones.

     ActiveSetCreate(); then ActiveSetSolve() until it asks for no more columns, ActiveSetAddColumns() for those that it
   asks for

   No MPI; one rank needs it. */
#pragma once
#include "base/petsccompat.h"

typedef struct {
  PetscReal opening;   /* gap where the step begins, less the one at rest (length) */
  PetscReal pressure;  /* that the residual has there */
  PetscReal stiffness; /* that the tangent has; 0: the term takes no part in it */
  PetscReal penalty;   /* stiffness when pressed */
} ActiveSetTerm;

typedef struct _n_Pressing *ActiveSet;

/* travel[n]: by how much the step opens the gaps. Arrays are copied. */
PetscErrorCode ActiveSetCreate(PetscInt n, const ActiveSetTerm *, const PetscReal *travel, ActiveSet *);
PetscErrorCode ActiveSetDestroy(ActiveSet *);
/* Terms which[m] and their columns G[m][n]: by how much an excess of 1 of a term closes all gaps. */
PetscErrorCode ActiveSetAddColumns(ActiveSet, PetscInt m, const PetscInt *which, const PetscReal *G);
/* Goes on as far as the columns at hand allow. *m: of terms which[n] columns are missing; 0: it ended. *settled: with a
 * set of terms that is right. */
PetscErrorCode ActiveSetSolve(ActiveSet, PetscInt *m, PetscInt *which, PetscBool *converged);
/* For each column its term's excess, the pressure in residual and tangent less the law's; which terms press at the end
 * (n). They belong to the object. */
void ActiveSetGet(ActiveSet, const PetscReal **excess, const PetscBool **pressed);
