/* The balance of outer forces and moments, see forcebalance.h. */
#include "solve/forcebalance.h"

/* Sums over the nodes that this rank owns */
typedef struct {
  PetscReal force[3], moment[3], forces, moments; /* the last two: of amounts */
} Sums;

/* Adds the force of a node. arm: from the middle of the mesh, in space or in the plane. */
static void AddNode(const PetscReal arm[3], const PetscReal force[3], Sums *sums)
{
  PetscReal moment[3], amount = 0, turning = 0;

  for (int d = 0; d < 3; d++) moment[d] = arm[(d + 1) % 3] * force[(d + 2) % 3] - arm[(d + 2) % 3] * force[(d + 1) % 3];
  for (int d = 0; d < 3; d++) {
    sums->force[d] += force[d];
    sums->moment[d] += moment[d];
    amount += PetscSqr(force[d]);
    turning += PetscSqr(moment[d]);
  }
  sums->forces += PetscSqrtReal(amount);
  sums->moments += PetscSqrtReal(turning);
}

/* Sums the forces of all bodies' nodes. inner: complete at each node */
static void SumNodes(Problem problem, PetscMPIInt rank, const PetscReal *u, const PetscReal *inner, Sums *sums)
{
  const Mesh mesh = problem->mesh;
  const int  dim = mesh->dim, axial = problem->scene->geometry == GEOMETRY_AXISYMMETRIC;
  const int  moves = problem->scene->kinematics != KINEMATICS_SMALL;

  for (PetscInt i = 0; i < mesh->n_body_nodes; i++) {
    PetscReal arm[3] = {0, 0, 0}, force[3] = {0, 0, 0};

    if (mesh->node_owner[i] != rank) continue;
    for (int d = axial; d < dim; d++) {
      arm[d]   = mesh->coords[i * dim + d] + moves * u[i * dim + d];
      force[d] = inner[i * dim + d];
    }
    AddNode(arm, force, sums);
  }
}

static PetscReal Amount(const PetscReal a[3])
{
  return PetscSqrtReal(PetscSqr(a[0]) + PetscSqr(a[1]) + PetscSqr(a[2]));
}

static PetscReal Part(PetscReal what, PetscReal of)
{
  return of > 0 ? what / of : 0;
}

/*@
  ForceBalanceFind - evaluates the residual as ProblemResidual() does, and the balance of outer forces with it.

  Collective

  Input Parameters:
+ problem - the problem
. u       - local displacements of an equilibrium, u[n_nodes*dim] (length)
- t       - its load parameter

  Output Parameters:
+ balance - the same on all ranks
- ok      - as of ProblemResidual()

  Note:
  At an equilibrium, a node's forces from elements and from contact between bodies are minus the outer force on it. What
  these add up to is out of balance. Forces that are far below those in elements count as these.
@*/
PetscErrorCode ForceBalanceFind(Problem problem, const PetscReal *u, PetscReal t, ForceBalance *balance, PetscBool *ok)
{
  const Mesh     mesh = problem->mesh;
  const PetscInt n    = mesh->n_nodes * mesh->dim;
  Sums           sums = {.forces = 0};
  PetscReal     *inner, *outer, scale;
  PetscMPIInt    rank;

  PetscFunctionBeginUser;
  PetscCall(MeshCreateLocal(mesh, mesh->dim, &inner));
  PetscCall(MeshCreateLocal(mesh, mesh->dim, &outer));
  if (problem->contact) ContactWatchOuter(problem->contact, outer);
  PetscCall(ProblemResidual(problem, u, t, t, ok));
  if (problem->contact) ContactWatchOuter(problem->contact, NULL);
  PetscCall(LoadsResidual(problem->loads, t, u, outer, NULL, NULL));
  for (PetscInt i = 0; i < n; i++) inner[i] = problem->f[i] - outer[i];
  PetscCall(MeshSumNodes(mesh, mesh->dim, inner));
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  SumNodes(problem, rank, u, inner, &sums);
  PetscCall(PetscFree(inner));
  PetscCall(PetscFree(outer));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sums, sizeof(sums) / sizeof(PetscReal), MPIU_REAL, MPI_SUM, mesh->comm));
  scale    = ProblemForceScale(problem);
  *balance = (ForceBalance){.force  = Part(Amount(sums.force), PetscMax(sums.forces, scale)),
                            .moment = Part(Amount(sums.moment), PetscMax(sums.moments, mesh->size * scale))};
  if (problem->scene->geometry == GEOMETRY_AXISYMMETRIC) balance->moment = NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}
