/* How the tangent systems are solved, behind SNES's KSP: directly (MUMPS), or by GMRES with a preconditioner of its own
 * (multigrid.h). */
#pragma once
#include "linear/borderedfactor.h"
#include "linear/reusedfactor.h"
#include "mesh/mesh.h"

typedef struct _n_LinearSolver *LinearSolver;

/* Sets a KSP up as the scene says. symmetric: all its operators are. Options set on the KSP later win. Collective. */
PetscErrorCode LinearSolverCreate(KSP, Mesh, Scene, PetscBool symmetric, LinearSolver *);
/* After the KSP is destroyed. Collective. */
PetscErrorCode LinearSolverDestroy(LinearSolver *);
/* With the pattern of the first operator's elastic part, before contact joins it, which a run that is restarted finds
   too; where many operators are to come. couples: contact couples many unknowns with each other. Collective; once. */
PetscErrorCode LinearSolverOrder(LinearSolver, Mat K, PetscBool couples);
/* Does it want to be told what contact adds as a sum of v v^T? Not collective, the same on all ranks. */
PetscBool LinearSolverBorders(LinearSolver);
/* That, of the next operator, before LinearSolverNext(); borrowed until the next call. Collective. */
PetscErrorCode LinearSolverSetBorder(LinearSolver, const Border *);
/* Before each solve with a new operator. u: local displacements (n_nodes*dim) that it is the tangent at; C: its contact
   part, NULL: none; pattern: it has a new one; changes: contact terms that came, went or changed their stiffness since
   the operator before; *older: an older factor serves and wants to be told of them (ReusedFactorUpdate()). Collective.
 */
PetscErrorCode LinearSolverNext(LinearSolver, const PetscReal *u, Mat C, PetscBool pattern, PetscInt changes,
                                PetscBool *older);
/* What follows must not depend on what was solved before. Not collective. */
PetscErrorCode LinearSolverRenew(LinearSolver);
/* The residual (2-norm) with which the nonlinear solver will be content: much smaller ones are not worth iterations.
 * Logically collective. */
PetscErrorCode LinearSolverSetEnough(LinearSolver, PetscReal residual);
/* Is there a factor, so that LinearSolverColumns() may be asked? Not collective, the same on all ranks. */
PetscErrorCode LinearSolverDirect(LinearSolver, PetscBool *direct);
/* X = A^-1 B for dense B and X, A the operator of the last solve; *able: that could be done. Collective. */
PetscErrorCode LinearSolverColumns(LinearSolver, Mat B, Mat X, PetscBool *able);
/* For the solve that predicts a step: the residual (2-norm) that the last prediction left, 0: unknown. Logically
 * collective. */
PetscErrorCode LinearSolverSetStart(LinearSolver, PetscReal residual);
/* Around the solve that predicts a step, whose first guess of what is in contact should hold. Logically collective. */
PetscErrorCode LinearSolverSetPrediction(LinearSolver, PetscBool);
/* The factor that may serve more than one operator, for those who watch the solves; NULL: there is none. Not
 * collective. */
ReusedFactor LinearSolverKept(LinearSolver);
