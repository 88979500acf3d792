/* How the tangent systems are solved, behind SNES's KSP: directly (MUMPS), or by GMRES with a preconditioner of its own (multigrid.h). */
#pragma once
#include "mesh.h"

typedef struct _n_LinearSolver *LinearSolver;

/* Sets a KSP up as the scene says. symmetric: all its operators are. Options set on the KSP later win. Collective. */
PetscErrorCode LinearSolverCreate(KSP, Mesh, Scene, PetscBool symmetric, LinearSolver *);
/* After the KSP is destroyed. Collective. */
PetscErrorCode LinearSolverDestroy(LinearSolver *);
/* The contact part of the next operator; changed: that has a new pattern. Collective. */
PetscErrorCode LinearSolverSetContact(LinearSolver, Mat C, PetscBool changed);
/* What follows must not depend on what was solved before. Not collective. */
PetscErrorCode LinearSolverRenew(LinearSolver);
/* The residual (2-norm) with which the nonlinear solver will be content: much smaller ones are not worth iterations. Logically collective. */
PetscErrorCode LinearSolverSetEnough(LinearSolver, PetscReal residual);
