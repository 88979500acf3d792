/* Rotations of nodes as polar factors. */
#include "linear/corotation.h"

/* Most iterations of Newton's method for the polar factor. It doubles the number of correct digits in each iteration
   once it is near the solution; rotations with moderate strains take three to five. */
#define TURN_ITERATIONS 12
/* Least determinant of a gradient of unit size. A gradient with less is that of a body that is squeezed flat or turned
   inside out, and no rotation can be found from it. */
#define TURN_LEAST 1e-6

enum { ENTRIES = 9 }; /* entries of a 3 x 3 matrix; in the plane its third row and column are those of the identity */

struct _n_Corotation {
  Mesh       mesh;
  PetscReal *from, *to; /* local displacements (length): where the rotations begin, and the present ones */
  PetscReal *turn;      /* rotations, turn[n_nodes][ENTRIES] */
  PetscBool  turned;    /* at least one rotation is not the identity */
};

/*@
  CorotationCreate - creates the rotations of a mesh's nodes, all of them the identity.

  Not collective

  Input Parameter:
. mesh - borrowed; its constraints need not be set yet

  Output Parameter:
. turn - the rotations; destroy them with CorotationDestroy()
@*/
PetscErrorCode CorotationCreate(Mesh mesh, Corotation *turn)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(turn));
  (*turn)->mesh = mesh;
  PetscCall(PetscCalloc3(mesh->n_nodes * mesh->dim, &(*turn)->from, mesh->n_nodes * mesh->dim, &(*turn)->to,
                         mesh->n_nodes * ENTRIES, &(*turn)->turn));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CorotationDestroy - frees the rotations.

  Not collective

  Input Parameter:
. turn - may be NULL inside
@*/
PetscErrorCode CorotationDestroy(Corotation *turn)
{
  PetscFunctionBeginUser;
  if (!*turn) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree3((*turn)->from, (*turn)->to, (*turn)->turn));
  PetscCall(PetscFree(*turn));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CorotationMove - sets the present displacements.

  Not collective

  Input Parameters:
+ turn - the rotations
- u    - u[n_nodes*dim]: local displacements, ghosts included (length); copied
@*/
PetscErrorCode CorotationMove(Corotation turn, const PetscReal *u)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(turn->to, u, turn->mesh->n_nodes * turn->mesh->dim));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CorotationBegin - makes the present displacements those where rotations begin.

  Not collective

  Input Parameter:
. turn - the rotations, the identity from now on
@*/
PetscErrorCode CorotationBegin(Corotation turn)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(turn->from, turn->to, turn->mesh->n_nodes * turn->mesh->dim));
  turn->turned = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums the products of a cell's nodes, each about the cell's centre, in the two states. The sum is scaled to unit size,
   so that cells of all sizes have the same weight. */
static void CellProduct(Corotation turn, PetscInt cell, PetscReal product[ENTRIES])
{
  const Mesh      mesh = turn->mesh;
  const int       dim  = mesh->dim;
  const PetscInt *node = &mesh->cell_nodes[mesh->cell_ptr[cell]], n = mesh->cell_ptr[cell + 1] - mesh->cell_ptr[cell];
  PetscReal       before[3] = {0}, after[3] = {0}, size = 0;

  for (int e = 0; e < ENTRIES; e++) product[e] = 0;
  for (PetscInt k = 0; k < n; k++) {
    for (int d = 0; d < dim; d++) {
      before[d] += (mesh->coords[node[k] * dim + d] + turn->from[node[k] * dim + d]) / n;
      after[d] += (mesh->coords[node[k] * dim + d] + turn->to[node[k] * dim + d]) / n;
    }
  }
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal *x = &mesh->coords[node[k] * dim], *u = &turn->from[node[k] * dim], *v = &turn->to[node[k] * dim];

    for (int j = 0; j < dim; j++) {
      const PetscReal old = x[j] + u[j] - before[j];

      size += old * old;
      for (int i = 0; i < dim; i++) product[3 * i + j] += (x[i] + v[i] - after[i]) * old;
    }
  }
  for (int e = 0; e < ENTRIES && size > 0; e++) product[e] /= size;
}

static void Cofactors(const PetscReal a[ENTRIES], PetscReal cofactor[ENTRIES])
{
  for (int i = 0; i < 3; i++) {
    const int p = (i + 1) % 3, q = (i + 2) % 3;

    for (int j = 0; j < 3; j++) {
      const int r = (j + 1) % 3, s = (j + 2) % 3;

      cofactor[3 * i + j] = a[3 * p + r] * a[3 * q + s] - a[3 * p + s] * a[3 * q + r];
    }
  }
}

static PetscReal Determinant(const PetscReal a[ENTRIES], const PetscReal cofactor[ENTRIES])
{
  return a[0] * cofactor[0] + a[1] * cofactor[1] + a[2] * cofactor[2];
}

static void Identity(PetscReal a[ENTRIES])
{
  for (int e = 0; e < ENTRIES; e++) a[e] = e % 4 == 0;
}

static PetscReal Norm(const PetscReal a[ENTRIES])
{
  PetscReal square = 0;

  for (int e = 0; e < ENTRIES; e++) square += PetscSqr(a[e]);
  return PetscSqrtReal(square);
}

/* Finds the rotation of a node with three free dofs: the polar factor of the sum a. Newton's iterates are scaled,
   because the sums of flat cells have singular values far apart. Source: Higham, Computing the polar decomposition -
   with applications, SIAM J. Sci. Stat. Comput. 7 (1986) 1160-1174. */
static void TurnInSpace(PetscReal a[ENTRIES])
{
  const PetscReal size = Norm(a);
  PetscReal       cofactor[ENTRIES];

  for (int e = 0; e < ENTRIES && size > 0; e++) a[e] /= size;
  for (int i = 0; i < TURN_ITERATIONS; i++) {
    PetscReal determinant, scale, change = 0;

    Cofactors(a, cofactor);
    determinant = Determinant(a, cofactor);
    if (!(determinant > TURN_LEAST)) break;
    scale = PetscSqrtReal(Norm(cofactor) / (determinant * Norm(a)));
    for (int e = 0; e < ENTRIES; e++) {
      const PetscReal next = 0.5 * (scale * a[e] + cofactor[e] / (scale * determinant));

      change = PetscMax(change, PetscAbsReal(next - a[e]));
      a[e]   = next;
    }
    if (change < PETSC_SQRT_MACHINE_EPSILON) return;
  }
  Identity(a);
}

/* Finds the rotation of a node that is free in components p and q only: in their plane, the nearest to the sum's part.
 */
static void TurnInPlane(int p, int q, PetscReal a[ENTRIES])
{
  const PetscReal c = a[4 * p] + a[4 * q], s = a[3 * q + p] - a[3 * p + q], length = PetscSqrtReal(c * c + s * s);

  Identity(a);
  if (!(length > 0)) return;
  a[4 * p] = a[4 * q] = c / length;
  a[3 * q + p]        = s / length;
  a[3 * p + q]        = -s / length;
}

/* Turns the sum of a node's cells into the node's rotation. A node that is held does not rotate. */
static void Corotations(int dim, const PetscInt dof[], PetscReal a[ENTRIES])
{
  int free[3], n = 0;

  for (int d = 0; d < dim; d++)
    if (dof[d] >= 0) free[n++] = d;
  if (n == 3)
    TurnInSpace(a);
  else if (n == 2)
    TurnInPlane(free[0], free[1], a);
  else
    Identity(a);
}

/*@
  CorotationFind - finds the rotations from the state of CorotationBegin() to the present one.

  Collective

  Input Parameter:
. turn - the rotations

  Note:
  The rotation of a node is that of all cells around it, on all ranks.
@*/
PetscErrorCode CorotationFind(Corotation turn)
{
  const Mesh      mesh = turn->mesh;
  const PetscInt *dof;
  PetscReal       product[ENTRIES];

  PetscFunctionBeginUser;
  PetscCall(MeshGetGlobalDofs(mesh, &dof));
  PetscCall(PetscArrayzero(turn->turn, mesh->n_nodes * ENTRIES));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    CellProduct(turn, c, product);
    for (PetscInt k = mesh->cell_ptr[c]; k < mesh->cell_ptr[c + 1]; k++)
      for (int e = 0; e < ENTRIES; e++) turn->turn[mesh->cell_nodes[k] * ENTRIES + e] += product[e];
  }
  PetscCall(MeshSumNodes(mesh, ENTRIES, turn->turn));
  for (PetscInt n = 0; n < mesh->n_body_nodes; n++)
    Corotations(mesh->dim, &dof[n * mesh->dim], &turn->turn[n * ENTRIES]);
  turn->turned = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CorotationApply - rotates a vector, node by node.

  Not collective

  Input Parameters:
+ turn - the rotations
- back - rotate back, from the present state to the state of CorotationBegin()

  Input and Output Parameter:
. x - vector over the free dofs
@*/
PetscErrorCode CorotationApply(Corotation turn, PetscBool back, Vec x)
{
  const int       dim = turn->mesh->dim;
  const PetscInt *dof;
  PetscInt        first, end;
  PetscScalar    *a;

  PetscFunctionBeginUser;
  if (!turn->turned) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MeshGetGlobalDofs(turn->mesh, &dof));
  PetscCall(VecGetOwnershipRange(x, &first, &end));
  PetscCall(VecGetArray(x, &a));
  for (PetscInt n = 0; n < turn->mesh->n_body_nodes; n++) {
    const PetscReal *R    = &turn->turn[n * ENTRIES];
    PetscScalar      v[3] = {0};

    for (int d = 0; d < dim; d++) {
      const PetscInt i = dof[n * dim + d];

      if (i >= first && i < end) v[d] = a[i - first];
    }
    for (int d = 0; d < dim; d++) {
      const PetscInt i = dof[n * dim + d];

      if (i < first || i >= end) continue;
      a[i - first] = 0;
      for (int e = 0; e < dim; e++) a[i - first] += (back ? R[3 * e + d] : R[3 * d + e]) * v[e];
    }
  }
  PetscCall(VecRestoreArray(x, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}
