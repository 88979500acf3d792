/* Which contact terms press at the end of a linear step.

   The step is that of a tangent in which some terms take part, pressed or pulled, and others do not. What the law says
   of their gaps at the end differs from that for terms that open or close in the step. Each of these is a force on the
   step, whose influence on all gaps is a column. With the columns of all terms that change, the step's own contact
   problem is solved to its end, as if the tangent had had the right terms.

   With friction a term has parts besides its pressure: the tractions along its tangents. The step opens its gap and
   slides it along these tangents. Whether it sticks or slips at the end, and in which direction, is found as well.
   The n terms have parts*n components: first all pressures, then all tractions along the first tangents, and so on.

   ActiveSetCreate(), then ActiveSetSolve() until it asks for no more columns, and ActiveSetAddColumns() for those that
   it asks for. No function communicates, and one rank needs it. */
#pragma once
#include "base/petsccompat.h"
#include "contact/frictionlaw.h"

enum { ACTIVE_SET_PARTS = 3 }; /* of a term, at most */

/* Friction of a term, along its two tangents. */
typedef struct {
  FrictionInput law;           /* in a frame whose first axes are the tangents; stiffness 0: there is no friction */
  PetscReal     traction[2];   /* in the residual where the step begins */
  PetscReal     by_slip[2][2]; /* in the tangent */
  PetscReal     by_gap[2];
} ActiveSetFriction;

typedef struct {
  PetscReal         opening;   /* gap where the step begins, less LawOnsetGap() (length) */
  PetscReal         pressure;  /* in the residual there */
  PetscReal         stiffness; /* in the tangent; 0: the term takes no part in it */
  PetscReal         penalty;   /* stiffness when pressed */
  PetscReal         area;      /* on which its pressure acts */
  PetscReal         share;     /* of the area that the slave has there; the rest is past an end of the master */
  ActiveSetFriction friction;
} ActiveSetTerm;

typedef struct _n_Pressing *ActiveSet;

PetscErrorCode ActiveSetCreate(PetscInt n, PetscInt parts, PetscInt most, const ActiveSetTerm *,
                               const PetscReal *travel, ActiveSet *);
PetscErrorCode ActiveSetDestroy(ActiveSet *);
void           ActiveSetLeaveRelaxation(ActiveSet);
void           ActiveSetBound(ActiveSet, PetscReal allowed, PetscReal solves);
void           ActiveSetEnough(ActiveSet, PetscReal force);
void           ActiveSetAllowPart(ActiveSet);
PetscErrorCode ActiveSetAddColumns(ActiveSet, PetscInt m, const PetscInt *which, const PetscReal *G);
PetscErrorCode ActiveSetSolve(ActiveSet, PetscInt *m, PetscInt *which, PetscBool *converged);
void           ActiveSetRest(ActiveSet, PetscInt *m, PetscInt *which);
PetscErrorCode ActiveSetLimit(ActiveSet, PetscInt most, PetscInt *m, PetscInt *which);
void           ActiveSetGet(ActiveSet, const PetscReal **excess, const PetscBool **pressed, PetscReal *part);
