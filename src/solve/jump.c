/* Jumps to another equilibrium: a load that a body cannot carry any more makes it snap through. */
#include "base/largest.h"
#include "modelimpl.h"

/* A node jumps that moves this many times as fast for the load as the fastest one did in the step before. Along a path
   of equilibria the velocity changes little from step to step; where the path ends it grows without bound. */
#define JUMP_FASTER 4

/* Attempts of a step, each shorter than the one before, that jump by at least this part of what that did: their length
   is not the cause. After so many of them the jump stays. */
#define JUMP_ALIKE 0.9
enum { JUMP_TIMES = 2 };

/* Says whether a jump by a distance stays, although a shorter step might not jump. before: distance by which the last
   attempt of this step jumped; 0: it did not. alike: attempts that jumped by as much as the one before them. */
static PetscBool JumpStays(ModelWork *work, PetscReal distance, PetscReal before, PetscInt alike)
{
  const PetscInt now = before > 0 && distance >= JUMP_ALIKE * before ? alike + 1 : 0;

  if (now >= JUMP_TIMES) return PETSC_TRUE;
  work->jumped      = distance;
  work->jumps_alike = now;
  return PETSC_FALSE;
}

/*@
  ModelFindJump - finds out whether a solve ended in an equilibrium that the accepted state does not lead to.

  Collective

  Input Parameter:
. model - after a solve that converged

  Input/Output Parameter:
. report - says how often Newton's steps were turned; jump[] names the node that moved most, or stays empty

  Note:
  Two things together tell a jump: the tangent became indefinite on the way, so that steps were turned round or the
  solve needed a viscous restraint, and the bodies moved much faster than in the step before. The first step of a run
  has none before it. Without contact, whose changes make the tangent of an iterate indefinite, too, it is then to be
  repeated with a smaller one, unless a viscous restraint has led it. So is a step that jumped after it was close to an
  equilibrium and turned round where that was a saddle: its length may have led it away from its path, unless shorter
  and shorter steps jump alike.
@*/
PetscErrorCode ModelFindJump(Model model, SolveReport *report)
{
  ModelWork      *work    = model->work;
  const Mesh      mesh    = model->mesh;
  const int       dim     = mesh->dim;
  const PetscReal allowed = JUMP_FASTER * work->rate * (model->t - work->accepted_t);
  const PetscReal before  = work->jumped;
  const PetscInt  alike   = work->jumps_alike;
  PetscInt        at      = -1;
  PetscReal       X[3], farthest = 0, most;
  PetscMPIInt     rank;
  PetscBool       here;

  PetscFunctionBeginUser;
  work->jumped      = 0;
  work->jumps_alike = 0;
  if (!report->turned && !report->damped) PetscFunctionReturn(PETSC_SUCCESS);
  if (!(work->rate > 0)) {
    if (!model->contact && !report->damped && work->accepted_t == 0) {
      model->problem->inverted = -1;
      report->result           = SOLVE_JUMP;
    }
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt n = 0; n < mesh->n_body_nodes; n++) {
    PetscReal square = 0;

    for (int d = 0; d < dim; d++) square += PetscSqr(model->u[n * dim + d] - work->accepted_u[n * dim + d]);
    if (square <= farthest) continue;
    farthest = square;
    at       = n;
  }
  PetscCall(LargestOfRanks(mesh->comm, farthest, &most, &rank, &here));
  if (most <= PetscSqr(allowed)) PetscFunctionReturn(PETSC_SUCCESS);
  if (work->strayed && !report->damped && !JumpStays(work, PetscSqrtReal(most), before, alike)) {
    model->problem->inverted = -1;
    report->result           = SOLVE_JUMP;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (here) {
    MeshNodePlace(mesh, at, X);
    PetscCall(PetscSNPrintf(report->jump, sizeof(report->jump),
                            "node %" PetscInt_FMT
                            " (%.5g, %.5g, %.5g) moved by %.3g, %.2g times as far for the load as "
                            "in the step before",
                            mesh->node_tag[at], (double)X[0], (double)X[1], (double)X[2], sqrt((double)most),
                            sqrt((double)most) * JUMP_FASTER / (double)allowed));
  }
  PetscCallMPI(MPI_Bcast(report->jump, sizeof(report->jump), MPI_CHAR, rank, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
