/* The friction that would hold what holds soft motions, see ModelJudgeHeld(). */
#include "kernels/rigidkernel.h"
#include "mesh/meshdofs.h"
#include "modelimpl.h"

/* The motion that friction resists least is found by squares that are weighted anew so many times at most, until the
   coefficient changes by less than this. */
enum { FRICTION_TIMES = 50 };
#define FRICTION_SAME 1e-3
/* Weights are bounded: a node that moves by less than this part of the farthest one counts as if it moved so far. */
#define FRICTION_LEAST 1e-6

/* Local nodes with contact forces, and how they move in each motion. */
typedef struct {
  Mesh       mesh;
  int        n;     /* motions */
  PetscInt   nodes; /* with a force */
  PetscReal *force; /* of each node */
  PetscReal *b;     /* b[nodes][n][dim]: displacement of each node in each motion */
} Rubbing;

/* Collects the nodes with forces. The caller frees force and b by PetscFree2(). */
static PetscErrorCode CollectRubbing(Model model, Rubbing *r)
{
  const HeldMotion *held = &model->work->hold;
  const Mesh        mesh = model->mesh;
  const int         dim = mesh->dim, n = held->known;
  PetscReal        *force, *b;

  PetscFunctionBeginUser;
  *r = (Rubbing){.mesh = mesh, .n = n};
  PetscCall(PetscCalloc2(mesh->n_nodes, &force, mesh->n_nodes * dim, &b));
  for (int p = 0; p < ContactPairs(model->contact); p++) PetscCall(ContactTermForces(model->contact, p, 0, force));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) r->nodes += force[i] != 0;
  PetscCall(PetscCalloc2(r->nodes, &r->force, r->nodes * n * dim, &r->b));
  for (int k = 0; k < n; k++) {
    PetscInt at = 0;

    PetscCall(MeshGlobalToLocal(mesh, held->b[k], b));
    for (PetscInt i = 0; i < mesh->n_nodes; i++) {
      if (force[i] == 0) continue;
      r->force[at] = force[i];
      for (int d = 0; d < dim; d++) r->b[(at * n + k) * dim + d] = b[i * dim + d];
      at++;
    }
  }
  PetscCall(PetscFree2(force, b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far node i moves in the sum of motions v[n]. */
static PetscReal Rub(const Rubbing *r, PetscInt i, const PetscReal *v)
{
  PetscReal square = 0;

  for (int d = 0; d < r->mesh->dim; d++) {
    PetscReal sum = 0;

    for (int k = 0; k < r->n; k++) sum += v[k] * r->b[(i * r->n + k) * r->mesh->dim + d];
    square += PetscSqr(sum);
  }
  return PetscSqrtReal(square);
}

/* Work that friction with a coefficient of 1 takes over the motions v[n], and the matrix M[n][n] of the squares whose
   half is that work at v and which bound it from above elsewhere. */
static PetscErrorCode FrictionWork(const Rubbing *r, const PetscReal *v, PetscReal *work, PetscReal *M)
{
  const int   n = r->n, dim = r->mesh->dim;
  PetscReal   farthest = 0;
  PetscMPIInt size;

  PetscFunctionBeginUser;
  *work = 0;
  PetscCall(PetscArrayzero(M, n * n));
  for (PetscInt i = 0; i < r->nodes; i++) farthest = PetscMax(farthest, Rub(r, i, v));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &farthest, 1, MPIU_REAL, MPI_MAX, r->mesh->comm));
  for (PetscInt i = 0; i < r->nodes && farthest > 0; i++) {
    const PetscReal *b      = &r->b[i * n * dim];
    const PetscReal  rub    = Rub(r, i, v);
    const PetscReal  weight = r->force[i] / PetscMax(rub, FRICTION_LEAST * farthest);

    *work += r->force[i] * rub;
    for (int j = 0; j < n; j++)
      for (int k = 0; k < n; k++)
        for (int d = 0; d < dim; d++) M[j * n + k] += weight * b[j * dim + d] * b[k * dim + d];
  }
  PetscCall(PetscMPIIntCast(n * n, &size));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, work, 1, MPIU_REAL, MPI_SUM, r->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, M, size, MPIU_REAL, MPI_SUM, r->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelHeldFriction - finds the coefficient of friction that would hold the forces along the motions that are held.

  Collective

  Input Parameter:
. model - after ModelHeldResidual()

  Output Parameter:
. coefficient - the least one; infinite where nothing is in contact

  Notes:
  Friction holds a body if no motion v takes more work from it than the force gives: f . v <= mu sum f_c |v_c|, with the
  contact forces f_c of nodes. Of the sums of motions the worst one is found, whose friction is least for a force that
  gives 1: a convex problem, by squares that are weighted anew (Weiszfeld 1937). Friction falls from each motion to the
  next one. For one motion it is known at once.
@*/
PetscErrorCode ModelHeldFriction(Model model, PetscReal *coefficient)
{
  const HeldMotion *held = &model->work->hold;
  const int         n    = held->known;
  PetscReal         v[HELD_MOST], x[HELD_MOST], M[HELD_MOST * HELD_MOST], square = 0, given, work, least = 0;
  PetscBool         ok = PETSC_TRUE;
  Rubbing           r;

  PetscFunctionBeginUser;
  PetscCall(CollectRubbing(model, &r));
  for (int k = 0; k < n; k++) square += PetscSqr(held->force[k]);
  for (int k = 0; k < n; k++) v[k] = held->force[k] / square;
  for (int i = 0; i < FRICTION_TIMES && ok; i++) {
    PetscCall(FrictionWork(&r, v, &work, M));
    if (i && work > (1 - FRICTION_SAME) * least) {
      least = PetscMin(least, work);
      break;
    }
    least = work;
    if (n == 1) break;
    RigidCholesky(n, M, M);
    for (int k = 0; k < n; k++) x[k] = held->force[k];
    RigidSolve(n, M, x);
    given = 0;
    for (int k = 0; k < n; k++) given += held->force[k] * x[k];
    ok = (PetscBool)(given > 0); /* no where M is singular */
    for (int k = 0; k < n && ok; k++) v[k] = x[k] / given;
  }
  *coefficient = least > 0 ? 1 / least : PETSC_INFINITY;
  PetscCall(PetscFree2(r.force, r.b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
