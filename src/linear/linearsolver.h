/* The solver of the tangent systems, behind SNES's KSP. It is direct (MUMPS, directsolver.h), with a factor that may
   serve more than one tangent (reusedfactor.h), or it is GMRES with a preconditioner of its own (multigrid.h).

   LinearSolverCreate() sets the KSP up as the scene says; options that are set on the KSP later take precedence. Before
   each solve with a new operator call LinearSolverNext(), and LinearSolverSetBorder() before that where
   LinearSolverBorders() says so. The other functions tell how precisely to solve, or use the factor for more
   right-hand sides. */
#pragma once
#include "linear/factor.h"
#include "linear/reusedfactor.h"
#include "mesh/mesh.h"

typedef struct _n_LinearSolver *LinearSolver;

PetscErrorCode LinearSolverCreate(KSP, Mesh, Scene, PetscBool symmetric, LinearSolver *);
PetscErrorCode LinearSolverDestroy(LinearSolver *);
PetscErrorCode LinearSolverOrder(LinearSolver, Mat K, PetscBool couples);
PetscBool      LinearSolverIterates(LinearSolver);
PetscBool      LinearSolverBorders(LinearSolver);
PetscErrorCode LinearSolverSetBorder(LinearSolver, const Border *);
PetscErrorCode LinearSolverRelease(LinearSolver);
PetscErrorCode LinearSolverNext(LinearSolver, const PetscReal *u, Mat C, PetscBool pattern, PetscInt changes,
                                PetscBool *older);
PetscErrorCode LinearSolverRenew(LinearSolver);
PetscErrorCode LinearSolverSetEnough(LinearSolver, PetscReal residual);
PetscErrorCode LinearSolverTransposed(LinearSolver, Mat A, Vec b, Vec x, PetscBool *solved);
PetscErrorCode LinearSolverDirect(LinearSolver, PetscBool *direct);
PetscErrorCode LinearSolverColumns(LinearSolver, Mat B, Mat X, PetscBool *able);
PetscErrorCode LinearSolverSetStart(LinearSolver, PetscReal residual);
PetscErrorCode LinearSolverSetPrediction(LinearSolver, PetscBool);
PetscErrorCode LinearSolverOwnFactor(LinearSolver, Factor *);
PetscErrorCode LinearSolverNegatives(LinearSolver, PetscInt *negatives);
PetscErrorCode LinearSolverParity(LinearSolver, PetscInt *parity);
ReusedFactor   LinearSolverKept(LinearSolver);
