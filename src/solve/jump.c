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

/* Energy that a step gives away, as a part of the larger work over it, with the forces of either end, from which it may
   have jumped. Where bodies turn, both are large and cancel. */
#define JUMP_RELEASED 0.1

/* Says whether a jump by a distance stays, although a shorter step might not jump, or because there is none that is
   allowed. before: distance by which the last attempt of this step jumped; 0: it did not. alike: attempts that jumped
   by as much as the one before them. */
static PetscBool JumpStays(Model model, PetscReal distance, PetscReal before, PetscInt alike)
{
  ModelWork     *work = model->work;
  const PetscInt now  = before > 0 && distance >= JUMP_ALIKE * before ? alike + 1 : 0;

  if (now >= JUMP_TIMES || model->t - work->accepted_t < 2 * model->scene->stepping.dt_min) return PETSC_TRUE;
  work->jumped      = distance;
  work->jumps_alike = now;
  return PETSC_FALSE;
}

/* Finds out whether the bodies may have given energy away between the accepted state and the present solution: whether
   they store clearly less than the work of the internal forces over the displacements of the step, by the trapezoidal
   rule. So they do where these forces have fallen on the way, as a load beyond the largest one that can be carried
   makes them do. On a smooth path the difference falls with the square of the step's length. */
static PetscErrorCode ModelReleased(Model model, PetscBool *released)
{
  const ModelWork *work = model->work;
  const Mesh       mesh = model->mesh;
  const PetscInt   n    = mesh->n_nodes * mesh->dim;
  Elasticity       e    = model->problem->elasticity;
  PetscReal *f, mean, sum[5] = {0, 0, 0, 0, 0}; /* energies, work with the forces of either end, ranks that fail */
  PetscBool  ok;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &f));
  for (int end = 0; end < 2; end++) { /* the present state is evaluated last, so that the bodies are left in it */
    PetscCall(PetscArrayzero(f, n));
    PetscCall(ElasticityResidual(e, end ? model->u : work->accepted_u, f, &sum[end], NULL, &ok));
    for (PetscInt k = 0; k < n; k++) sum[2 + end] += f[k] * (model->u[k] - work->accepted_u[k]);
    if (!ok) sum[4] = 1;
  }
  PetscCall(PetscFree(f));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 5, MPIU_REAL, MPI_SUM, mesh->comm));
  mean      = (sum[2] + sum[3]) / 2;
  *released = (PetscBool)(sum[4] == 0 && mean - (sum[1] - sum[0]) >
                                           JUMP_RELEASED * PetscMax(PetscAbsReal(sum[2]), PetscAbsReal(sum[3])));
  PetscCall(PetscInfo(model->snes, "stored %g, work with the forces of the start %g, of the end %g\n",
                      (double)(sum[1] - sum[0]), (double)sum[2], (double)sum[3]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the local body node that has moved farthest in the step on any rank. here: it is on this rank. */
static PetscErrorCode ModelFarthest(Model model, PetscInt *at, PetscReal *distance, PetscMPIInt *rank, PetscBool *here)
{
  const PetscReal *u_0      = model->work->accepted_u;
  const int        dim      = model->mesh->dim;
  PetscReal        farthest = 0;

  PetscFunctionBeginUser;
  *at = -1;
  for (PetscInt n = 0; n < model->mesh->n_body_nodes; n++) {
    PetscReal square = 0;

    for (int d = 0; d < dim; d++) square += PetscSqr(model->u[n * dim + d] - u_0[n * dim + d]);
    if (square <= farthest) continue;
    farthest = square;
    *at      = n;
  }
  PetscCall(LargestOfRanks(model->mesh->comm, PetscSqrtReal(farthest), distance, rank, here));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelFindJump - finds out whether a solve ended in an equilibrium that the accepted state does not lead to.

  Collective

  Input Parameter:
. model - after a solve that converged

  Input/Output Parameter:
. report - says how often Newton's steps were turned; jump[] names the node that moved most, or stays empty

  Note:
  Two things together tell a jump. The bodies moved much faster than in the step before. And the tangent became
  indefinite on the way, so that steps were turned round or the solve needed a viscous restraint, or else the bodies
  have given energy away. The first step of a run has none before it. Without contact, whose changes make the tangent
  of an iterate indefinite, too, it is then to be repeated with a smaller one, unless a viscous restraint has led it.
  Two kinds of jumps may come from the step's length, and it is repeated unless shorter and shorter steps jump alike:
  those after a step that was turned round close to an equilibrium, where that was a saddle, and those that energy
  alone tells.
@*/
PetscErrorCode ModelFindJump(Model model, SolveReport *report)
{
  ModelWork      *work     = model->work;
  const PetscReal allowed  = JUMP_FASTER * work->rate * (model->t - work->accepted_t);
  const PetscReal before   = work->jumped;
  const PetscInt  alike    = work->jumps_alike;
  PetscBool       released = PETSC_FALSE, here;
  PetscInt        at;
  PetscReal       X[3], distance;
  PetscMPIInt     rank;

  PetscFunctionBeginUser;
  work->jumped      = 0;
  work->jumps_alike = 0;
  if (!(work->rate > 0)) {
    if (report->turned && !model->contact && !report->damped && work->accepted_t == 0) {
      model->problem->inverted = -1;
      report->result           = SOLVE_JUMP;
    }
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ModelFarthest(model, &at, &distance, &rank, &here));
  if (distance <= allowed) PetscFunctionReturn(PETSC_SUCCESS);
  if (!report->turned && !report->damped) {
    PetscCall(ModelReleased(model, &released));
    if (!released) PetscFunctionReturn(PETSC_SUCCESS);
  }
  if ((work->strayed || released) && !report->damped && !JumpStays(model, distance, before, alike)) {
    model->problem->inverted = -1;
    report->result           = SOLVE_JUMP;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (here) {
    MeshNodePlace(model->mesh, at, X);
    PetscCall(PetscSNPrintf(report->jump, sizeof(report->jump),
                            "node %" PetscInt_FMT
                            " (%.5g, %.5g, %.5g) moved by %.3g, %.2g times as far for the load as "
                            "in the step before",
                            model->mesh->node_tag[at], (double)X[0], (double)X[1], (double)X[2], (double)distance,
                            (double)distance * JUMP_FASTER / (double)allowed));
  }
  PetscCallMPI(MPI_Bcast(report->jump, sizeof(report->jump), MPI_CHAR, rank, model->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
