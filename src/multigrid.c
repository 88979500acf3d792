#include "multigrid.h"
#include "directsolver.h"
#include "matrixrows.h"

/* The parts have option names of their own: -bodies_... for multigrid, -interface_... for the direct solve */
#define MULTIGRID_BODIES    "bodies_"
#define MULTIGRID_INTERFACE "interface_"
/* Multigrid made for an older operator with the same interface serves until it takes this many times the iterations it took at first: its coarse
   matrices cost as much as some ten iterations. */
#define MULTIGRID_AGE 1.5
/* Most rigid-body modes there are */
#define MULTIGRID_MODES 6

struct _n_Multigrid {
  Mesh       mesh;
  PetscBool  axisymmetric, symmetric;
  PetscInt   n_free, n_all, first; /* rows of this rank: free dofs, all dofs of nodes that have one; the latter's first number of all ranks */
  PetscInt  *row;                  /* of each free dof of this rank: its row among all dofs, counted from first */
  Vec        number;               /* of each free dof: its number among all dofs of all ranks */
  PetscInt  *ghost;                /* the same for the operator's columns of other ranks */
  Mat        nodes;                /* the operator with all dofs of a node */
  PetscBool  changed, renew;       /* the operator has another pattern than that; its values are wanted */
  PetscInt   applied, usual;       /* iterations since the last operator; of the first one after multigrid was made, 0: not over yet */
  PC         bodies;
  Vec        nodes_right, nodes_left, rest;
  IS         interface; /* rows of this rank that contact couples; NULL: no rank has any */
  KSP        direct;
  Vec        interface_right, interface_left;
  VecScatter to_interface;
};

/* ---------- whole nodes ---------- */

/* Numbers all dofs of the nodes of this rank that have a free one. */
static PetscErrorCode NumberNodes(Multigrid m)
{
  const int       dim = m->mesh->dim;
  const PetscInt *dofs;
  PetscInt        begin, end;
  PetscMPIInt     rank;
  PetscScalar    *number;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->mesh->comm, &rank));
  PetscCall(MeshGetGlobalDofs(m->mesh, &dofs));
  PetscCall(DMCreateGlobalVector(m->mesh->dm, &m->number));
  PetscCall(VecGetOwnershipRange(m->number, &begin, &end));
  m->n_free = end - begin;
  PetscCall(PetscMalloc1(m->n_free, &m->row));
  for (PetscInt node = 0; node < m->mesh->n_nodes; node++) {
    PetscBool free = PETSC_FALSE;

    if (m->mesh->node_owner[node] != rank) continue;
    for (int d = 0; d < dim; d++) {
      if (dofs[node * dim + d] < 0) continue;
      m->row[dofs[node * dim + d] - begin] = m->n_all + d;
      free                                 = PETSC_TRUE;
    }
    if (free) m->n_all += dim;
  }
  PetscCallMPI(MPI_Exscan(&m->n_all, &m->first, 1, MPIU_INT, MPI_SUM, m->mesh->comm));
  if (!rank) m->first = 0;
  PetscCall(VecGetArray(m->number, &number));
  for (PetscInt i = 0; i < m->n_free; i++) number[i] = m->first + m->row[i];
  PetscCall(VecRestoreArray(m->number, &number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rigid-body modes of a node at x: displacement in direction d of mode k. Translations first, then rotations; axisymmetric: along the axis only. */
static PetscReal ModeValue(int dim, const PetscReal *x, int k, int d)
{
  const int from = dim == 2 ? 0 : (k - dim + 1) % 3, to = dim == 2 ? 1 : (k - dim + 2) % 3;

  if (k < dim) return k == d ? 1 : 0;
  return d == from ? -x[to] : d == to ? x[from] : 0;
}

/* The modes of all bodies together, orthonormal; 0 where a dof is constrained. */
static PetscErrorCode ModesCreate(Multigrid m, MatNullSpace *modes)
{
  const int       dim = m->mesh->dim, first = m->axisymmetric ? 1 : 0, count = m->axisymmetric ? 1 : dim * (dim + 1) / 2;
  const PetscInt *dofs;
  PetscInt        begin, end;
  PetscScalar    *value, product[MULTIGRID_MODES];
  PetscReal       length;
  Vec             mode[MULTIGRID_MODES];

  PetscFunctionBeginUser;
  PetscCall(MeshGetGlobalDofs(m->mesh, &dofs));
  PetscCall(VecGetOwnershipRange(m->number, &begin, &end));
  for (int k = 0; k < count; k++) {
    PetscCall(VecDuplicate(m->nodes_right, &mode[k]));
    PetscCall(VecGetArray(mode[k], &value));
    for (PetscInt i = 0; i < m->mesh->n_nodes * dim; i++)
      if (dofs[i] >= begin && dofs[i] < end) value[m->row[dofs[i] - begin]] = ModeValue(dim, &m->mesh->coords[i - i % dim], first + k, (int)(i % dim));
    PetscCall(VecRestoreArray(mode[k], &value));
    if (k) PetscCall(VecMDot(mode[k], k, mode, product));
    for (int l = 0; l < k; l++) product[l] = -product[l];
    if (k) PetscCall(VecMAXPY(mode[k], k, product, mode));
    PetscCall(VecNormalize(mode[k], &length));
  }
  PetscCall(MatNullSpaceCreate(m->mesh->comm, PETSC_FALSE, count, mode, modes));
  for (int k = 0; k < count; k++) PetscCall(VecDestroy(&mode[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers of the operator's columns of other ranks among all dofs. */
static PetscErrorCode NumberGhosts(Multigrid m, Mat A)
{
  MatrixRows         rows;
  PetscInt           n;
  const PetscScalar *value;
  Vec                ghosts;
  IS                 from;
  VecScatter         scatter;

  PetscFunctionBeginUser;
  PetscCall(MatrixRowsGet(A, MATRIX_OTHERS, &rows));
  if (!rows.mat) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatGetSize(rows.mat, NULL, &n));
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, n, &ghosts));
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, n, rows.global, PETSC_USE_POINTER, &from));
  PetscCall(VecScatterCreate(m->number, from, ghosts, NULL, &scatter));
  PetscCall(VecScatterBegin(scatter, m->number, ghosts, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, m->number, ghosts, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(PetscFree(m->ghost));
  PetscCall(PetscMalloc1(n, &m->ghost));
  PetscCall(VecGetArrayRead(ghosts, &value));
  for (PetscInt i = 0; i < n; i++) m->ghost[i] = (PetscInt)PetscRealPart(value[i]);
  PetscCall(VecRestoreArrayRead(ghosts, &value));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(ISDestroy(&from));
  PetscCall(VecDestroy(&ghosts));
  PetscCall(MatrixRowsRestore(&rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One block of the operator's rows: counts its entries per row of all dofs, or sets their values in m->nodes. */
static PetscErrorCode CopyRows(Multigrid m, Mat A, int block, PetscInt *count)
{
  MatrixRows         rows;
  PetscInt           room = 0, *column = NULL;
  const PetscScalar *value;

  PetscFunctionBeginUser;
  PetscCall(MatrixRowsGet(A, block, &rows));
  if (!rows.mat) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatSeqAIJGetArrayRead(rows.mat, &value));
  for (PetscInt i = 0; i < rows.n; i++) room = PetscMax(room, rows.ptr[i + 1] - rows.ptr[i]);
  PetscCall(PetscMalloc1(room, &column));
  for (PetscInt i = 0; i < rows.n; i++) {
    const PetscInt row = m->first + m->row[i], first = rows.ptr[i], entries = rows.ptr[i + 1] - first;

    if (count) {
      count[m->row[i]] = entries;
      continue;
    }
    for (PetscInt k = 0; k < entries; k++) column[k] = block == MATRIX_OWN ? m->first + m->row[rows.column[first + k]] : m->ghost[rows.column[first + k]];
    PetscCall(MatSetValues(m->nodes, 1, &row, entries, column, &value[first], INSERT_VALUES));
  }
  PetscCall(PetscFree(column));
  PetscCall(MatSeqAIJRestoreArrayRead(rows.mat, &value));
  PetscCall(MatrixRowsRestore(&rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An empty matrix over all dofs with room for the operator's entries and the diagonal of constrained dofs. */
static PetscErrorCode CreateNodesMatrix(Multigrid m, Mat A)
{
  PetscInt    *own, *others;
  MatNullSpace modes;

  PetscFunctionBeginUser;
  PetscCall(NumberGhosts(m, A));
  PetscCall(PetscCalloc2(m->n_all, &own, m->n_all, &others));
  PetscCall(CopyRows(m, A, MATRIX_OWN, own));
  PetscCall(CopyRows(m, A, MATRIX_OTHERS, others));
  for (PetscInt i = 0; i < m->n_all; i++) own[i] = PetscMax(own[i], 1);
  PetscCall(MatDestroy(&m->nodes));
  PetscCall(MatCreate(m->mesh->comm, &m->nodes));
  PetscCall(MatSetSizes(m->nodes, m->n_all, m->n_all, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetBlockSize(m->nodes, m->mesh->dim));
  PetscCall(MatSetType(m->nodes, MATAIJ));
  PetscCall(MatSeqAIJSetPreallocation(m->nodes, 0, own));
  PetscCall(MatMPIAIJSetPreallocation(m->nodes, 0, own, 0, others));
  PetscCall(MatSetOption(m->nodes, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE));
  PetscCall(PetscFree2(own, others));
  if (!m->nodes_right) PetscCall(MatCreateVecs(m->nodes, &m->nodes_right, &m->nodes_left));
  PetscCall(ModesCreate(m, &modes));
  PetscCall(MatSetNearNullSpace(m->nodes, modes));
  PetscCall(MatNullSpaceDestroy(&modes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Constrained dofs get the mean of the others on the diagonal, so that no coarse row mixes scales. */
static PetscErrorCode SetConstrainedRows(Multigrid m, Mat A)
{
  PetscBool  *free;
  PetscScalar mean;
  PetscInt    n;
  Vec         diagonal;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(m->number, &diagonal));
  PetscCall(MatGetDiagonal(A, diagonal));
  PetscCall(VecSum(diagonal, &mean));
  PetscCall(VecGetSize(diagonal, &n));
  mean /= n;
  PetscCall(VecDestroy(&diagonal));
  PetscCall(PetscCalloc1(m->n_all, &free));
  for (PetscInt i = 0; i < m->n_free; i++) free[m->row[i]] = PETSC_TRUE;
  for (PetscInt i = 0; i < m->n_all; i++) {
    const PetscInt row = m->first + i;

    if (!free[i]) PetscCall(MatSetValues(m->nodes, 1, &row, 1, &row, &mean, INSERT_VALUES));
  }
  PetscCall(PetscFree(free));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateBodies(Multigrid m)
{
  PetscFunctionBeginUser;
  PetscCall(PCDestroy(&m->bodies)); /* levels of other sizes survive a reset */
  PetscCall(PCCreate(m->mesh->comm, &m->bodies));
  PetscCall(PCSetOptionsPrefix(m->bodies, MULTIGRID_BODIES));
  PetscCall(PCSetType(m->bodies, PCGAMG));
  PetscCall(PCGAMGSetReuseInterpolation(m->bodies, PETSC_TRUE));
  PetscCall(PCSetFromOptions(m->bodies));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multigrid for the operator; its coarse spaces stay as long as the pattern does. */
static PetscErrorCode SetUpBodies(Multigrid m, Mat A)
{
  PetscFunctionBeginUser;
  if (m->changed) {
    PetscCall(CreateNodesMatrix(m, A));
    PetscCall(CreateBodies(m));
    m->changed = PETSC_FALSE;
  }
  PetscCall(CopyRows(m, A, MATRIX_OWN, NULL));
  PetscCall(CopyRows(m, A, MATRIX_OTHERS, NULL));
  PetscCall(SetConstrainedRows(m, A));
  PetscCall(MatAssemblyBegin(m->nodes, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(m->nodes, MAT_FINAL_ASSEMBLY));
  PetscCall(MatSetOption(m->nodes, MAT_SYMMETRIC, m->symmetric));
  PetscCall(PCSetOperators(m->bodies, m->nodes, m->nodes));
  PetscCall(PCSetUp(m->bodies));
  m->renew = PETSC_FALSE;
  m->usual = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplyBodies(Multigrid m, Vec right, Vec left)
{
  const PetscScalar *from;
  PetscScalar       *to;

  PetscFunctionBeginUser;
  PetscCall(VecSet(m->nodes_right, 0));
  PetscCall(VecGetArrayRead(right, &from));
  PetscCall(VecGetArray(m->nodes_right, &to));
  for (PetscInt i = 0; i < m->n_free; i++) to[m->row[i]] = from[i];
  PetscCall(VecRestoreArray(m->nodes_right, &to));
  PetscCall(VecRestoreArrayRead(right, &from));
  PetscCall(PCApply(m->bodies, m->nodes_right, m->nodes_left));
  PetscCall(VecGetArrayRead(m->nodes_left, &from));
  PetscCall(VecGetArray(left, &to));
  for (PetscInt i = 0; i < m->n_free; i++) to[i] = from[m->row[i]];
  PetscCall(VecRestoreArray(left, &to));
  PetscCall(VecRestoreArrayRead(m->nodes_left, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- interface ---------- */

static PetscErrorCode ForgetInterface(Multigrid m)
{
  PetscFunctionBeginUser;
  PetscCall(ISDestroy(&m->interface));
  PetscCall(VecDestroy(&m->interface_right));
  PetscCall(VecDestroy(&m->interface_left));
  PetscCall(VecScatterDestroy(&m->to_interface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* MultigridSetContact - the contact part C of the next operator K + C, whose non-zero rows are the interface.

   Collective. changed: the operator has another pattern than the last one. */
PetscErrorCode MultigridSetContact(Multigrid m, Mat C, PetscBool changed)
{
  PetscInt  begin, end, n = 0, all, *rows;
  PetscBool same = PETSC_FALSE;
  IS        before;

  PetscFunctionBeginUser;
  m->changed   = (PetscBool)(m->changed || changed);
  before       = m->interface;
  m->interface = NULL;
  PetscCall(ForgetInterface(m));
  PetscCall(MatGetOwnershipRange(C, &begin, &end));
  PetscCall(PetscMalloc1(end - begin, &rows));
  for (PetscInt row = begin; row < end; row++) {
    PetscInt           entries;
    const PetscScalar *value;
    PetscBool          coupled = PETSC_FALSE;

    PetscCall(MatGetRow(C, row, &entries, NULL, &value));
    for (PetscInt k = 0; k < entries && !coupled; k++) coupled = (PetscBool)(value[k] != 0);
    PetscCall(MatRestoreRow(C, row, &entries, NULL, &value));
    if (coupled) rows[n++] = row;
  }
  PetscCallMPI(MPI_Allreduce(&n, &all, 1, MPIU_INT, MPI_SUM, m->mesh->comm));
  if (all) PetscCall(ISCreateGeneral(m->mesh->comm, n, rows, PETSC_COPY_VALUES, &m->interface));
  PetscCall(PetscFree(rows));
  if (m->interface && before) PetscCall(ISEqual(m->interface, before, &same));
  if (!same) m->renew = PETSC_TRUE;
  PetscCall(ISDestroy(&before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* MultigridRenew - the next operator is a new beginning: multigrid is made for it, whatever was solved before. Not collective. */
PetscErrorCode MultigridRenew(Multigrid m)
{
  PetscFunctionBeginUser;
  m->renew = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Factors of the operator's rows and columns of the interface, on all ranks together. */
static PetscErrorCode SetUpInterface(Multigrid m, Mat A)
{
  Mat block;

  PetscFunctionBeginUser;
  if (!m->interface) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatCreateSubMatrix(A, m->interface, m->interface, MAT_INITIAL_MATRIX, &block));
  PetscCall(MatSetOption(block, MAT_SYMMETRIC, m->symmetric));
  PetscCall(KSPReset(m->direct));
  PetscCall(KSPSetOperators(m->direct, block, block));
  PetscCall(KSPSetUp(m->direct));
  if (!m->to_interface) {
    PetscCall(MatCreateVecs(block, &m->interface_left, &m->interface_right));
    PetscCall(VecScatterCreate(m->number, m->interface, m->interface_right, NULL, &m->to_interface));
  }
  PetscCall(MatDestroy(&block));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* left += (interface solve of right) */
static PetscErrorCode AddInterface(Multigrid m, Vec right, Vec left)
{
  PetscFunctionBeginUser;
  PetscCall(VecScatterBegin(m->to_interface, right, m->interface_right, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(m->to_interface, right, m->interface_right, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(KSPSolve(m->direct, m->interface_right, m->interface_left));
  PetscCall(VecScatterBegin(m->to_interface, m->interface_left, left, ADD_VALUES, SCATTER_REVERSE));
  PetscCall(VecScatterEnd(m->to_interface, m->interface_left, left, ADD_VALUES, SCATTER_REVERSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- the preconditioner ---------- */

static PetscErrorCode SetUp(PC pc)
{
  Multigrid m;
  Mat       A;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &m));
  PetscCall(PCGetOperators(pc, NULL, &A));
  if (!m->usual) m->usual = m->applied;
  if (m->renew || m->applied > MULTIGRID_AGE * m->usual) PetscCall(SetUpBodies(m, A));
  PetscCall(SetUpInterface(m, A));
  m->applied = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bodies first, then the interface for what they left. */
static PetscErrorCode Apply(PC pc, Vec right, Vec left)
{
  Multigrid m;
  Mat       A;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &m));
  m->applied++;
  PetscCall(ApplyBodies(m, right, left));
  if (!m->interface) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PCGetOperators(pc, NULL, &A));
  if (!m->rest) PetscCall(VecDuplicate(m->number, &m->rest));
  PetscCall(MatMult(A, left, m->rest));
  PetscCall(VecAYPX(m->rest, -1, right));
  PetscCall(AddInterface(m, m->rest, left));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateDirect(Multigrid m)
{
  PetscFunctionBeginUser;
  PetscCall(KSPCreate(m->mesh->comm, &m->direct));
  PetscCall(KSPSetOptionsPrefix(m->direct, MULTIGRID_INTERFACE));
  PetscCall(DirectSolverSet(m->direct, m->symmetric));
  PetscCall(KSPSetFromOptions(m->direct));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* MultigridCreate - makes pc the preconditioner; the caller destroys *out after pc.

   Collective. mesh: borrowed, its constraints set. axisymmetric: the only rigid-body mode is the one along the axis. symmetric: of the operators.
   Options Database Keys: -bodies_pc_..., -bodies_mg_... of multigrid; -interface_ksp_..., -interface_pc_... of the direct solve. */
PetscErrorCode MultigridCreate(Mesh mesh, PetscBool axisymmetric, PetscBool symmetric, PC pc, Multigrid *out)
{
  Multigrid m;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  m->mesh         = mesh;
  m->axisymmetric = axisymmetric;
  m->symmetric    = symmetric;
  m->changed = m->renew = PETSC_TRUE;
  PetscCall(NumberNodes(m));
  PetscCall(CreateDirect(m));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, m));
  PetscCall(PCShellSetName(pc, "multigrid for the bodies, direct solve for the contact interface"));
  PetscCall(PCShellSetSetUp(pc, SetUp));
  PetscCall(PCShellSetApply(pc, Apply));
  *out = m;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* MultigridDestroy - Collective. */
PetscErrorCode MultigridDestroy(Multigrid *multigrid)
{
  Multigrid m = *multigrid;

  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ForgetInterface(m));
  PetscCall(KSPDestroy(&m->direct));
  PetscCall(PCDestroy(&m->bodies));
  PetscCall(MatDestroy(&m->nodes));
  PetscCall(VecDestroy(&m->nodes_right));
  PetscCall(VecDestroy(&m->nodes_left));
  PetscCall(VecDestroy(&m->rest));
  PetscCall(VecDestroy(&m->number));
  PetscCall(PetscFree(m->row));
  PetscCall(PetscFree(m->ghost));
  PetscCall(PetscFree(*multigrid));
  PetscFunctionReturn(PETSC_SUCCESS);
}
