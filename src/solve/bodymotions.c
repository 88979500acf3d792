/* Rigid motions of the bodies that only contact holds: velocities, large motions, products, and the work of the loads.
 */
#include "freebodiesimpl.h"
#include "mesh/pressurenodes.h"

/* A load drives a motion if its force along it is above this part of the sum of the amounts. */
#define FREE_BODIES_DRIVEN 1e-6
/* A rotation whose mean motion is below this part of the body's size is about its middle. Less is round-off, as in
   RigidReduce(). */
#define FREE_BODIES_CENTRED 1e-9

/* The velocity of a node under a motion of its piece, in units of the piece's size. */
static void NodeVelocity(FreeBodies b, PetscInt node, const PetscReal *u, const double motion[RIGID_MODES], double v[3])
{
  FreeModesNodeVelocity(b->mesh, &b->pieces[b->piece[node]], node, u, motion, v);
}

/* The displacement row[m] (length) of component d of a node under the motions first to first + m - 1 of its piece. */
void FreeBodiesRow(FreeBodies b, PetscInt node, const PetscReal *u, int d, int first, int m, double row[])
{
  double v[3];

  for (int k = 0; k < m; k++) {
    NodeVelocity(b, node, u, b->motion[first + k], v);
    row[k] = b->pieces[b->piece[node]].size * v[d];
  }
}

/* The motion of a piece by the coordinates a[n] of all. */
void FreeBodiesPieceMotion(FreeBodies b, PetscInt piece, const double a[], double q[RIGID_MODES])
{
  for (int i = 0; i < RIGID_MODES; i++) q[i] = 0;
  for (int k = 0; k < b->n; k++)
    for (int i = 0; i < RIGID_MODES && b->owner[k] == piece; i++) q[i] += a[k] * b->motion[k][i];
}

/* Says whether a motion turns its piece. */
PetscBool FreeBodiesTurns(FreeBodies b, int k)
{
  const double *q = b->motion[k];

  return (PetscBool)(q[0] != 0 || q[1] != 0 || q[2] != 0);
}

/* The velocities du[n_nodes*dim] (length) of a motion a[n] of the bodies at displacements u. */
void FreeBodiesVelocity(FreeBodies b, const PetscReal *u, const double a[], PetscReal *du)
{
  const int dim  = b->mesh->dim;
  PetscInt  last = -1;
  double    q[RIGID_MODES], v[3];

  for (PetscInt i = 0; i < b->mesh->n_nodes; i++) {
    if (b->piece[i] != last) FreeBodiesPieceMotion(b, b->piece[i], a, q);
    last = b->piece[i];
    NodeVelocity(b, i, u, q, v);
    for (int d = 0; d < dim; d++) du[i * dim + d] = IsPressureNode(b->mesh, i) ? 0 : b->pieces[last].size * v[d];
  }
}

/* Moves the bodies by a[n]: adds it to the displacements u. The nodes of a tool add its rotation vectors. */
void FreeBodiesMove(FreeBodies b, const double a[], PetscReal *u)
{
  const int dim  = b->mesh->dim;
  PetscInt  last = -1;
  double    q[RIGID_MODES], x[3], by[3];

  for (PetscInt i = 0; i < b->mesh->n_nodes; i++) {
    const FreePiece *piece = &b->pieces[b->piece[i]];

    if (b->piece[i] != last) FreeBodiesPieceMotion(b, b->piece[i], a, q);
    last = b->piece[i];
    NodeVelocity(b, i, u, q, by);
    if (b->scene->kinematics == KINEMATICS_FINITE && !(piece->tool && i != piece->tool->node)) {
      for (int d = 0; d < 3; d++)
        x[d] = d < dim ? (b->mesh->coords[i * dim + d] + u[i * dim + d] - piece->centre[d]) / piece->size : 0;
      for (int d = 0; d < 3; d++) by[d] = -x[d];
      RigidMove(q, x);
      for (int d = 0; d < 3; d++) by[d] += x[d];
    }
    for (int d = 0; d < dim && !IsPressureNode(b->mesh, i); d++) u[i * dim + d] += piece->size * by[d];
  }
}

/* Products gram[n][n] of the motions at displacements u: mean over the volume of each piece (length^2). */
PetscErrorCode FreeBodiesGram(FreeBodies b, const PetscReal *u, double gram[])
{
  const int n = b->n;
  double   *volume;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(b->n_pieces, &volume));
  PetscCall(PetscArrayzero(gram, n * n));
  for (PetscInt i = 0; i < b->mesh->n_nodes; i++) {
    volume[b->piece[i]] += b->weight[i];
    for (int k = 0; k < n; k++) {
      double v[3], w[3];

      if (b->owner[k] != b->piece[i]) continue;
      NodeVelocity(b, i, u, b->motion[k], v);
      for (int l = 0; l < n; l++) {
        if (b->owner[l] != b->piece[i]) continue;
        NodeVelocity(b, i, u, b->motion[l], w);
        for (int d = 0; d < b->mesh->dim; d++) gram[k * n + l] += b->weight[i] * v[d] * w[d];
      }
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, gram, n * n, MPI_DOUBLE, MPI_SUM, b->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, volume, (PetscMPIInt)b->n_pieces, MPI_DOUBLE, MPI_SUM, b->mesh->comm));
  for (int k = 0; k < n; k++)
    for (int l = 0; l < n; l++) gram[k * n + l] *= PetscSqr(b->pieces[b->owner[k]].size) / volume[b->owner[k]];
  PetscCall(PetscFree(volume));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the translations, numbers which[m] of the motions, out of motion k: as much of each as it has in the mean over
   its body. gram[n][n]: the products of all; factor: Cholesky's factor of those of the translations. */
static void TakeTranslations(FreeBodies b, int m, const int which[], const double gram[], const double factor[], int k)
{
  double part[m > 0 ? m : 1];

  for (int i = 0; i < m; i++) part[i] = gram[which[i] * b->n + k];
  RigidSolve(m, factor, part);
  for (int i = 0; i < m; i++)
    for (int j = 0; j < RIGID_MODES && PetscAbsReal(part[i]) > FREE_BODIES_CENTRED; j++)
      b->motion[k][j] -= part[i] * b->motion[which[i]][j];
}

/* Writes the motions of bodies at displacements u. Rotations are about the middle of the body, as far as its
   translations are free. About a point far away a rotation is nearly a translation, and what holds the one seems to
   hold the other. */
PetscErrorCode FreeBodiesCentre(FreeBodies b, const PetscReal *u)
{
  const int n = b->n;
  int       m = 0, *which;
  double   *gram, *factor;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &which, n * n, &gram, n * n, &factor));
  for (int k = 0, i = 0; k < n; k++) {
    i = k > 0 && b->owner[k] == b->owner[k - 1] ? i + 1 : 0;
    PetscCall(PetscArraycpy(b->motion[k], &b->pieces[b->owner[k]].free[i * RIGID_MODES], RIGID_MODES));
  }
  PetscCall(FreeBodiesGram(b, u, gram));
  for (int k = 0; k < n; k++)
    if (!FreeBodiesTurns(b, k)) which[m++] = k;
  for (int i = 0; i < m; i++)
    for (int j = 0; j < m; j++) factor[i * m + j] = gram[which[i] * n + which[j]];
  RigidCholesky(m, factor, factor);
  for (int k = 0; k < n; k++)
    if (FreeBodiesTurns(b, k)) TakeTranslations(b, m, which, gram, factor, k);
  PetscCall(PetscFree3(which, gram, factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Longest velocity (length) of the nodes of each piece under the motion a[n], of all ranks. */
PetscErrorCode FreeBodiesLongest(FreeBodies b, const PetscReal *u, const double a[], PetscReal *longest)
{
  const int  dim = b->mesh->dim;
  PetscReal *v;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(b->mesh->n_nodes * dim, &v));
  PetscCall(PetscArrayzero(longest, b->n_pieces));
  FreeBodiesVelocity(b, u, a, v);
  for (PetscInt i = 0; i < b->mesh->n_nodes; i++) {
    PetscReal square = 0;

    for (int d = 0; d < dim; d++) square += PetscSqr(v[i * dim + d]);
    longest[b->piece[i]] = PetscMax(longest[b->piece[i]], PetscSqrtReal(square));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, longest, (PetscMPIInt)b->n_pieces, MPIU_REAL, MPIU_MAX, b->mesh->comm));
  PetscCall(PetscFree(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The work force[n] of the loads at t along each motion at displacements u, and the sum of its amounts over the nodes.
   Where they nearly cancel the force is 0. */
PetscErrorCode FreeBodiesForce(FreeBodies b, const PetscReal *u, PetscReal t, double force[], double scale[])
{
  const PetscInt size = b->mesh->n_nodes * b->mesh->dim;
  PetscReal     *f, *v, square = 0;
  double        *a;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(size, &f));
  PetscCall(PetscMalloc1(size, &v));
  PetscCall(PetscCalloc1(b->n, &a));
  PetscCall(LoadsResidual(b->loads, t, u, f, NULL, &square));
  for (int k = 0; k < b->n; k++) {
    force[k] = scale[k] = 0;
    a[k]                = 1;
    FreeBodiesVelocity(b, u, a, v);
    a[k] = 0;
    for (PetscInt i = 0; i < size; i++) {
      force[k] -= f[i] * v[i];
      scale[k] += PetscAbsReal(f[i] * v[i]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, b->n, MPI_DOUBLE, MPI_SUM, b->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, scale, b->n, MPI_DOUBLE, MPI_SUM, b->mesh->comm));
  for (int k = 0; k < b->n; k++)
    if (PetscAbsReal(force[k]) <= FREE_BODIES_DRIVEN * scale[k]) force[k] = 0;
  PetscCall(PetscFree(a));
  PetscCall(PetscFree(v));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mean motion of a piece along its coordinate k (length) under the free displacements x, at displacements u. */
PetscErrorCode FreeBodiesMeanMotion(FreeBodies b, const PetscReal *u, Vec x, int k, PetscReal *mean)
{
  const int  n = b->n, dim = b->mesh->dim;
  double    *gram, *a, volume = 0;
  PetscReal *z;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * n, &gram));
  PetscCall(PetscCalloc2(n + 1, &a, b->mesh->n_nodes * dim, &z));
  PetscCall(MeshGlobalToLocal(b->mesh, x, z));
  PetscCall(FreeBodiesGram(b, u, gram));
  for (PetscInt i = 0; i < b->mesh->n_nodes; i++) {
    double v[3];

    if (b->piece[i] != b->owner[k]) continue;
    volume += b->weight[i];
    for (int l = 0; l < n; l++) {
      if (b->owner[l] != b->owner[k]) continue;
      NodeVelocity(b, i, u, b->motion[l], v);
      for (int d = 0; d < dim; d++) a[l] += b->weight[i] * b->pieces[b->owner[k]].size * v[d] * z[i * dim + d];
    }
  }
  a[n] = volume;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, a, n + 1, MPI_DOUBLE, MPI_SUM, b->mesh->comm));
  volume = a[n];
  RigidCholesky(n, gram, gram);
  RigidSolve(n, gram, a);
  *mean = b->pieces[b->owner[k]].size * a[k] / volume;
  PetscCall(PetscFree2(a, z));
  PetscCall(PetscFree(gram));
  PetscFunctionReturn(PETSC_SUCCESS);
}
