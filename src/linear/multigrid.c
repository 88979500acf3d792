/* Algebraic multigrid for the bodies and a direct solve for the contact interface, one after the other. */
#include "multigrid.h"
#include "base/freememory.h"
#include "base/hash.h"
#include "linear/directsolver.h"
#include "coarsecontact.h"
#include "gaussseidel.h"
#include "matrix/matrixrows.h"
#include "matrix/widematrix.h"

/* Prefixes of the parts' options: -bodies_... for multigrid, -interface_... for the direct solve. */
#define MULTIGRID_BODIES    "bodies_"
#define MULTIGRID_INTERFACE "interface_"
/* Multigrid is made anew when the interface has become this many times as large, or as small. It is not made anew for
   contact that only moves: where contact is on the coarse levels hardly matters, but that it is there does. */
#define MULTIGRID_CHANGE 1.5
/* Multigrid that was made for an older operator serves until its effort is this many times that of the first solve. The
   effort is the number of iterations for a power of ten in the residual. Coarse matrices cost as much as some ten
   iterations. */
#define MULTIGRID_AGE 1.5
/* Eigenvalues that the finest level's smoother damps, of the operator after symmetric Gauss-Seidel sweeps. None of
   these eigenvalues is above 1. */
#define MULTIGRID_LARGEST 1.1
#define MULTIGRID_LEAST   0.1
/* Powers of ten by which a solve must have reduced the residual before its effort is measured. The first iterations of
   any solve are the fastest. */
#define MULTIGRID_SHOWN 2
/* Number of iterations after which multigrid of an older operator is made anew, whatever its effort was at first. */
#define MULTIGRID_MOST 60
/* Overlap of the ranks' parts of the interface, in rows that contact couples: of parts with a middle, most of whose
   rows are coupled to no other rank, and of smaller ones. Without overlap two ranks take five times the iterations.
   With a middle an overlap of 2 takes one iteration in 25 less, but half as much time again for the factors, which is
   more than that saves. Without one all rows are near a cut: an overlap of 2 then takes 23 iterations instead of 68
   (rings of 29,000 unknowns on 16 ranks) and 17 instead of 41 (spheres of 35,000 on 8), as many as one rank does; a
   third row saves nothing more. */
#define MULTIGRID_OVERLAP       1
#define MULTIGRID_OVERLAP_SMALL 2
/* Part of an interface's rows that are coupled to other ranks, from which on its parts have no middle. */
#define MULTIGRID_SMALL 0.5
/* Largest number of rigid-body modes. */
#define MULTIGRID_MODES 6

struct _n_Multigrid {
  Mesh       mesh;
  PetscBool  axisymmetric, symmetric, constant;
  PetscInt   n_free, n_all;   /* rows of this rank: free dofs, all dofs of nodes that have a free one */
  PetscInt   first;           /* number of this rank's first dof of n_all among those of all ranks */
  PetscInt  *row;             /* of each free dof of this rank: its row among all dofs, counted from first */
  Vec        number;          /* of each free dof: its number among all dofs of all ranks */
  Mat        nodes;           /* the operator with all dofs of a node */
  Mat        swept;           /* stands for the smoother's copy of it; NULL: options have replaced the smoother */
  PetscBool  renew;           /* nodes must get the operator's values */
  PetscInt   made;            /* how often the bodies' coarse matrices were made */
  uint64_t   pattern;         /* of nodes, as a hash, from the second time on that they were made */
  PetscInt   solves, applied; /* operators since multigrid was made; iterations for the last of them */
  PetscReal  usual;           /* effort of the first solve that was long enough to measure it; 0: none yet */
  KSP        outer;           /* whose preconditioner this is */
  PC         bodies;
  Vec        nodes_right, nodes_left;
  Mat        contact;   /* contact part of the operator; borrowed */
  IS         interface; /* rows of this rank that contact couples; NULL: no rank has any */
  IS         reach;     /* interface, and near rows of other ranks, ascending: those that this rank factors */
  PetscInt   coupled;   /* rows of the interface on all ranks when multigrid was made */
  KSP        direct;
  Vec        interface_right, interface_left;
  Vec        residual; /* what multigrid leaves on the interface, 0 elsewhere */
  Vec        ghosts;   /* values of other ranks for the residual; NULL: one rank */
  VecScatter to_interface, to_ghosts;
};

/* Numbers all dofs of this rank's nodes that have a free dof. */
static PetscErrorCode MultigridNumberNodes(Multigrid m)
{
  const int       dim = m->mesh->dim;
  const PetscInt *dofs;
  PetscInt        begin, end;
  PetscMPIInt     rank;
  PetscScalar    *number;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->mesh->comm, &rank));
  PetscCall(MeshGetGlobalDofs(m->mesh, &dofs));
  PetscCall(MeshCreateVector(m->mesh, &m->number));
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

/* Displacement in direction d of rigid-body mode k, of a node at x. Translations come first, then rotations. An
   axisymmetric body can only move along the axis. */
static PetscReal ModeValue(int dim, const PetscReal *x, int k, int d)
{
  const int from = dim == 2 ? 0 : (k - dim + 1) % 3, to = dim == 2 ? 1 : (k - dim + 2) % 3;

  if (k < dim) return k == d ? 1 : 0;
  return d == from ? -x[to] : d == to ? x[from] : 0;
}

/* Creates the modes of all bodies together. They are orthonormal, and 0 where a dof is constrained. */
static PetscErrorCode ModesCreate(Multigrid m, MatNullSpace *modes)
{
  const int dim = m->mesh->dim, first = m->axisymmetric ? 1 : 0, count = m->axisymmetric ? 1 : dim * (dim + 1) / 2;
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
      if (dofs[i] >= begin && dofs[i] < end)
        value[m->row[dofs[i] - begin]] = ModeValue(dim, &m->mesh->coords[i - i % dim], first + k, (int)(i % dim));
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

/* Creates what fetches the values of a matrix's columns of other ranks; nothing where the matrix has no such block. */
static PetscErrorCode CreateGhosts(Multigrid m, Mat A, Vec *ghosts, VecScatter *scatter)
{
  MatrixRows rows;
  PetscInt   n;
  IS         from;

  PetscFunctionBeginUser;
  PetscCall(MatrixRowsGet(A, MATRIX_OTHERS, &rows));
  if (!rows.mat) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatGetSize(rows.mat, NULL, &n));
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, n, ghosts));
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, n, rows.global, PETSC_USE_POINTER, &from));
  PetscCall(VecScatterCreate(m->number, from, *ghosts, NULL, scatter));
  PetscCall(ISDestroy(&from));
  PetscCall(MatrixRowsRestore(&rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the numbers among all dofs of a matrix's columns of other ranks. The caller frees *ghost. */
static PetscErrorCode NumberGhosts(Multigrid m, Mat A, PetscInt **ghost)
{
  PetscInt           n;
  const PetscScalar *value;
  Vec                ghosts  = NULL;
  VecScatter         scatter = NULL;

  PetscFunctionBeginUser;
  *ghost = NULL;
  PetscCall(CreateGhosts(m, A, &ghosts, &scatter));
  if (!ghosts) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecScatterBegin(scatter, m->number, ghosts, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, m->number, ghosts, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetSize(ghosts, &n));
  PetscCall(PetscMalloc1(n, ghost));
  PetscCall(VecGetArrayRead(ghosts, &value));
  for (PetscInt i = 0; i < n; i++) (*ghost)[i] = (PetscInt)PetscRealPart(value[i]);
  PetscCall(VecRestoreArrayRead(ghosts, &value));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(VecDestroy(&ghosts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds half the sum of the absolute values of contact's entries, which is that of its diagonal where contact couples
   each node to one other. Where it couples a node to many, as with surfaces to surfaces, the diagonal would be a small
   part of what resists when surfaces move as a whole. */
static PetscErrorCode SumContact(Multigrid m, PetscReal *half)
{
  PetscInt           begin, end, entries;
  const PetscScalar *value;

  PetscFunctionBeginUser;
  *half = 0;
  PetscCall(MatGetOwnershipRange(m->contact, &begin, &end));
  for (PetscInt row = begin; row < end; row++) {
    PetscCall(MatGetRow(m->contact, row, &entries, NULL, &value));
    for (PetscInt k = 0; k < entries; k++) *half += PetscAbsScalar(value[k]) / 2;
    PetscCall(MatRestoreRow(m->contact, row, &entries, NULL, &value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds how stiff contact may be for multigrid, in parts of its full stiffness: at most as stiff as the bodies are
   where contact is. *mean: mean diagonal entry of the bodies. With stiffer contact smoothers diverge whose largest
   eigenvalue is estimated. The interface's solve makes up for the rest. */
static PetscErrorCode SoftenContact(Multigrid m, Mat A, PetscReal *softness, PetscReal *mean)
{
  PetscReal          sum[3] = {0, 0, 0}; /* bodies' diagonal where contact is, and everywhere; stiffness of contact */
  const PetscScalar *whole, *contact = NULL;
  Vec                diagonal, of_contact;
  PetscInt           n;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(m->number, &diagonal));
  PetscCall(VecDuplicate(m->number, &of_contact));
  PetscCall(MatGetDiagonal(A, diagonal));
  if (m->interface) PetscCall(MatGetDiagonal(m->contact, of_contact));
  if (m->interface) PetscCall(SumContact(m, &sum[2]));
  PetscCall(VecGetArrayRead(of_contact, &contact));
  PetscCall(VecGetArrayRead(diagonal, &whole));
  for (PetscInt i = 0; i < m->n_free; i++) {
    sum[0] += contact[i] != 0 ? PetscRealPart(whole[i] - contact[i]) : 0;
    sum[1] += PetscRealPart(whole[i] - contact[i]);
  }
  PetscCall(VecRestoreArrayRead(diagonal, &whole));
  PetscCall(VecRestoreArrayRead(of_contact, &contact));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, m->mesh->comm));
  PetscCall(VecGetSize(diagonal, &n));
  *softness = sum[0] > 0 && sum[2] > sum[0] ? sum[0] / sum[2] : 1;
  *mean     = sum[1] / n;
  PetscCall(VecDestroy(&diagonal));
  PetscCall(VecDestroy(&of_contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Puts another matrix in the place of the operator over all dofs. All that refers to the old one refers to it then. */
static PetscErrorCode ReplaceNodes(Multigrid m, Mat nodes)
{
  PetscFunctionBeginUser;
  if (m->nodes)
    PetscCall(MatHeaderReplace(m->nodes, &nodes));
  else
    m->nodes = nodes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the bodies' operator over all dofs from the arrays of the operator: where there is contact, without the entries
   in which it alone is. The diagonal of constrained dofs is the mean of the others, so that no coarse row mixes scales.
 */
static PetscErrorCode BorrowNodes(Multigrid m, Mat A, PetscReal *softness, WideMatrix *loan)
{
  PetscInt    *ghost;
  PetscReal    mean = 1;
  Mat          nodes;
  MatNullSpace modes;

  PetscFunctionBeginUser;
  PetscCall(SoftenContact(m, A, softness, &mean));
  PetscCall(NumberGhosts(m, A, &ghost));
  PetscCall(WideMatrixBorrow(A, &(WideRows){m->n_all, m->row, ghost, mean}, m->mesh->dim, loan));
  if (m->interface) PetscCall(WideMatrixAdd(*loan, -1, m->contact));
  PetscCall(WideMatrixCreate(*loan, (PetscBool)!m->interface, &nodes));
  PetscCall(ReplaceNodes(m, nodes));
  if (!m->nodes_right) PetscCall(MatCreateVecs(m->nodes, &m->nodes_right, &m->nodes_left));
  PetscCall(ModesCreate(m, &modes));
  PetscCall(MatSetNearNullSpace(m->nodes, modes));
  PetscCall(MatNullSpaceDestroy(&modes));
  PetscCall(MatSetOption(m->nodes, MAT_SYMMETRIC, m->symmetric));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateBodies(Multigrid m)
{
  PetscReal zero = 0;

  PetscFunctionBeginUser;
  PetscCall(PCCreate(m->mesh->comm, &m->bodies));
  PetscCall(PCSetOptionsPrefix(m->bodies, MULTIGRID_BODIES));
  PetscCall(PCSetType(m->bodies, PCGAMG));
  PetscCall(PCGAMGSetThreshold(m->bodies, &zero, 1));
  PetscCall(PCSetFromOptions(m->bodies));
  PetscCall(PCGAMGSetReuseInterpolation(m->bodies, PETSC_TRUE)); /* SmoothFinest() is done once for all */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has Gauss-Seidel's method smooth the finest level. It takes half of the iterations of Jacobi's, and on finer meshes
   the number grows more slowly. The coarse levels keep Jacobi's method: aggregates of few nodes leave rotations without
   stiffness, by which Gauss-Seidel's method would divide. */
static PetscErrorCode SmoothFinest(Multigrid m)
{
  KSP      ksp;
  PC       pc;
  PetscInt levels;

  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&m->swept));
  PetscCall(PCMGGetLevels(m->bodies, &levels));
  if (levels == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PCMGGetSmoother(m->bodies, levels - 1, &ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(GaussSeidelSet(pc, MULTIGRID_LEAST, MULTIGRID_LARGEST));
  PetscCall(KSPSetType(ksp, KSPRICHARDSON));
  PetscCall(KSPSetFromOptions(ksp));
  PetscCall(GaussSeidelGetMat(pc, &m->swept));
  if (m->swept) PetscCall(PCMGSetResidual(m->bodies, levels - 1, GaussSeidelResidual, m->swept));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has multigrid stay as it is, whatever happens to its operator, or follow it again, for which the smoother's copy of
   the old operator is freed. */
static PetscErrorCode HoldBodies(Multigrid m, PetscBool hold)
{
  KSP      finest;
  PC       sweeps;
  PetscInt levels;

  PetscFunctionBeginUser;
  PetscCall(PCMGGetLevels(m->bodies, &levels));
  PetscCall(PCMGGetSmoother(m->bodies, levels - 1, &finest));
  PetscCall(KSPGetPC(finest, &sweeps));
  if (hold) {
    PetscCall(KSPSetReusePreconditioner(finest, PETSC_FALSE));
    PetscCall(KSPSetOperators(finest, m->nodes, m->nodes));
    PetscCall(KSPSetUp(finest)); /* copies the operator */
    PetscCall(KSPSetReusePreconditioner(finest, PETSC_TRUE));
  } else if (m->swept)
    PetscCall(GaussSeidelForget(sweeps));
  PetscCall(PCSetReusePreconditioner(m->bodies, hold));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateEmpty(Multigrid m, Mat *empty)
{
  PetscFunctionBeginUser;
  PetscCall(MatCreate(m->mesh->comm, empty));
  PetscCall(MatSetSizes(*empty, m->n_all, m->n_all, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetBlockSize(*empty, m->mesh->dim));
  PetscCall(MatSetType(*empty, MATAIJ));
  PetscCall(MatSeqAIJSetPreallocation(*empty, 0, NULL));
  PetscCall(MatMPIAIJSetPreallocation(*empty, 0, NULL, 0, NULL));
  PetscCall(MatAssemblyBegin(*empty, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*empty, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the arrays back to the operator once multigrid is made. The finest level's smoother and its residual have a
   copy of their own, in single precision, and the coarse matrices need the operator again only when they are made anew.
   A smoother that options have set needs all of it: it gets a copy. */
static PetscErrorCode ReturnNodes(Multigrid m, WideMatrix *loan)
{
  Mat left;

  PetscFunctionBeginUser;
  PetscCall(HoldBodies(m, PETSC_TRUE));
  if (m->swept)
    PetscCall(CreateEmpty(m, &left));
  else
    PetscCall(MatDuplicate(m->nodes, MAT_COPY_VALUES, &left));
  PetscCall(ReplaceNodes(m, left));
  PetscCall(WideMatrixReturn(loan));
  FreeMemoryReturn();
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forgets how the coarse matrices were made. The next ones have other entries, and memory is freed. */
static PetscErrorCode ForgetProducts(Multigrid m)
{
  PetscInt levels;

  PetscFunctionBeginUser;
  PetscCall(PCMGGetLevels(m->bodies, &levels));
  for (PetscInt l = 0; l < levels - 1; l++) {
    KSP level;
    Mat mat;

    PetscCall(PCMGGetSmoother(m->bodies, l, &level));
    PetscCall(KSPGetOperators(level, NULL, &mat));
    PetscCall(MatProductClear(mat));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds contact to coarse matrices that were made for the bodies alone. */
static PetscErrorCode AddContact(Multigrid m, PetscReal softness)
{
  PetscInt        n, begin, *to;
  const PetscInt *from;
  Mat             contact;
  IS              rows;

  PetscFunctionBeginUser;
  PetscCall(ISGetLocalSize(m->interface, &n));
  PetscCall(VecGetOwnershipRange(m->number, &begin, NULL));
  PetscCall(PetscMalloc1(n, &to));
  PetscCall(ISGetIndices(m->interface, &from));
  for (PetscInt i = 0; i < n; i++) to[i] = m->first + m->row[from[i] - begin];
  PetscCall(ISRestoreIndices(m->interface, &from));
  PetscCall(ISCreateGeneral(m->mesh->comm, n, to, PETSC_OWN_POINTER, &rows));
  PetscCall(MatCreateSubMatrix(m->contact, m->interface, m->interface, MAT_INITIAL_MATRIX, &contact));
  PetscCall(CoarseContactAdd(m->bodies, contact, rows, softness, m->mesh->dim, (PetscBool)(m->made > 1)));
  PetscCall(MatDestroy(&contact));
  PetscCall(ISDestroy(&rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Puts the operator with soft contact in the place of the bodies' one, for the finest level's smoother. It has all
   entries of the operator. */
static PetscErrorCode AddToFinest(Multigrid m, PetscReal softness, WideMatrix loan)
{
  Mat nodes;

  PetscFunctionBeginUser;
  PetscCall(WideMatrixAdd(loan, softness - 1, m->contact));
  PetscCall(WideMatrixCreate(loan, PETSC_TRUE, &nodes));
  PetscCall(ReplaceNodes(m, nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds whether the bodies' operator has another pattern than that of the last call. An entry may come or go in which
   the bodies' stiffness is 0, and to nodes of other ranks entries are there where contact alone is. */
static PetscErrorCode PatternChanges(Multigrid m, PetscBool *changes)
{
  uint64_t hash = HASH_START;
  int      same;

  PetscFunctionBeginUser;
  for (int b = 0; b < MATRIX_BLOCKS; b++) {
    MatrixRows rows;

    PetscCall(MatrixRowsGet(m->nodes, b, &rows));
    if (!rows.mat) continue;
    for (PetscInt i = 0; i < rows.n; i++) hash = HashFinish(hash ^ (uint64_t)rows.ptr[i + 1]);
    for (PetscInt k = 0; k < rows.ptr[rows.n]; k++) hash = HashFinish(hash ^ (uint64_t)MatrixRowsColumn(&rows, 0, k));
    PetscCall(MatrixRowsRestore(&rows));
  }
  same       = hash == m->pattern;
  m->pattern = hash;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_INT, MPI_LAND, m->mesh->comm));
  *changes = same ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the coarse matrices of the bodies. The first ones are made without anything that would serve the next ones:
   most of the largest runs need no others, and it is a part of all memory. */
static PetscErrorCode MakeCoarse(Multigrid m)
{
  PetscBool changes = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (m->made) PetscCall(PatternChanges(m, &changes));
  if (m->made && changes) PetscCall(ForgetProducts(m));
  PetscCall(PCSetOperators(m->bodies, m->nodes, m->nodes));
  PetscCall(PCSetUp(m->bodies));
  if (!m->made) PetscCall(ForgetProducts(m));
  m->made++;
  m->usual  = 0;
  m->solves = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes multigrid for the operator. Its coarse spaces stay: they are those of the bodies, whose pattern does not change
   where contact's does. Of bodies whose stiffness stays the coarse matrices stay, too, unless multigrid has aged. */
static PetscErrorCode SetUpBodies(Multigrid m, Mat A, PetscBool aged)
{
  const PetscBool fresh    = m->bodies ? PETSC_FALSE : PETSC_TRUE;
  PetscReal       softness = 1;
  WideMatrix      loan;

  PetscFunctionBeginUser;
  if (fresh)
    PetscCall(CreateBodies(m));
  else {
    PetscCall(HoldBodies(m, PETSC_FALSE));
    PetscCall(CoarseContactRemove(m->bodies));
  }
  FreeMemoryReturn();
  PetscCall(BorrowNodes(m, A, &softness, &loan));
  if (!m->constant || m->made < 2 || aged) PetscCall(MakeCoarse(m));
  if (m->interface) {
    PetscCall(AddContact(m, softness));
    PetscCall(AddToFinest(m, softness, loan));
  }
  if (fresh) PetscCall(SmoothFinest(m));
  PetscCall(ReturnNodes(m, &loan));
  m->renew   = PETSC_FALSE;
  m->coupled = 0;
  if (m->interface) PetscCall(ISGetSize(m->interface, &m->coupled));
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

static PetscErrorCode ForgetInterface(Multigrid m)
{
  PetscFunctionBeginUser;
  PetscCall(ISDestroy(&m->interface));
  PetscCall(ISDestroy(&m->reach));
  PetscCall(VecDestroy(&m->interface_right));
  PetscCall(VecDestroy(&m->interface_left));
  PetscCall(VecScatterDestroy(&m->to_interface));
  PetscCall(VecDestroy(&m->ghosts));
  PetscCall(VecScatterDestroy(&m->to_ghosts));
  PetscCall(KSPDestroy(&m->direct));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the rows that each rank factors: its rows of the interface, and those of other ranks that contact couples to
   them. Of the solution the rank keeps its own rows: restricted additive Schwarz (Cai and Sarkis, SIAM J. Sci. Comput.
   21, 1999). With one factor over all ranks they would wait for each other longer than they work. */
static PetscErrorCode FindReach(Multigrid m, PetscInt overlap)
{
  PetscMPIInt     size;
  PetscInt        n;
  const PetscInt *rows;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(m->mesh->comm, &size));
  PetscCall(ISGetLocalSize(m->interface, &n));
  PetscCall(ISGetIndices(m->interface, &rows));
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, n, rows, PETSC_COPY_VALUES, &m->reach));
  PetscCall(ISRestoreIndices(m->interface, &rows));
  if (size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatIncreaseOverlap(m->contact, 1, &m->reach, overlap));
  PetscCall(ISSort(m->reach));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds whether contact couples a row of this rank, and whether it does so to rows of other ranks. */
static PetscErrorCode FindCoupling(Mat C, PetscInt row, PetscInt begin, PetscInt end, PetscBool *coupled,
                                   PetscBool *across)
{
  PetscInt           entries;
  const PetscInt    *column;
  const PetscScalar *value;

  PetscFunctionBeginUser;
  *coupled = *across = PETSC_FALSE;
  PetscCall(MatGetRow(C, row, &entries, &column, &value));
  for (PetscInt k = 0; k < entries && !*across; k++) {
    if (value[k] == 0) continue;
    *coupled = PETSC_TRUE;
    *across  = (PetscBool)(column[k] < begin || column[k] >= end);
  }
  PetscCall(MatRestoreRow(C, row, &entries, &column, &value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MultigridSetContact - sets the contact part of the next operator K + C.

  Collective

  Input Parameters:
+ m - the preconditioner
- C - contact part; its non-zero rows are the interface. Borrowed until the next call.
@*/
PetscErrorCode MultigridSetContact(Multigrid m, Mat C)
{
  PetscInt begin, end, n[2] = {0, 0}, all[2], *rows; /* rows of the interface; of these, coupled to other ranks */

  PetscFunctionBeginUser;
  m->contact = C;
  PetscCall(ForgetInterface(m));
  PetscCall(MatGetOwnershipRange(C, &begin, &end));
  PetscCall(PetscMalloc1(end - begin, &rows));
  for (PetscInt row = begin; row < end; row++) {
    PetscBool coupled, across;

    PetscCall(FindCoupling(C, row, begin, end, &coupled, &across));
    if (coupled) rows[n[0]++] = row;
    n[1] += across;
  }
  PetscCallMPI(MPI_Allreduce(n, all, 2, MPIU_INT, MPI_SUM, m->mesh->comm));
  if (all[0]) {
    PetscCall(ISCreateGeneral(m->mesh->comm, n[0], rows, PETSC_COPY_VALUES, &m->interface));
    PetscCall(FindReach(m, all[1] > MULTIGRID_SMALL * all[0] ? MULTIGRID_OVERLAP_SMALL : MULTIGRID_OVERLAP));
  }
  PetscCall(PetscFree(rows));
  if (all[0] > MULTIGRID_CHANGE * m->coupled || m->coupled > MULTIGRID_CHANGE * all[0]) m->renew = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MultigridRelease - frees the factor of the interface, which serves one operator only.

  Collective

  Input Parameter:
. m - the preconditioner, before the next MultigridSetContact()
@*/
PetscErrorCode MultigridRelease(Multigrid m)
{
  PetscFunctionBeginUser;
  PetscCall(ForgetInterface(m));
  FreeMemoryReturn();
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MultigridRenew - has multigrid made for the next operator.

  Not collective

  Input Parameter:
. m - the preconditioner
@*/
PetscErrorCode MultigridRenew(Multigrid m)
{
  PetscFunctionBeginUser;
  m->renew = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateDirect(Multigrid m, Mat A)
{
  PetscInt n;

  PetscFunctionBeginUser;
  if (!m->residual) PetscCall(VecDuplicate(m->number, &m->residual));
  PetscCall(VecSet(m->residual, 0));
  PetscCall(CreateGhosts(m, A, &m->ghosts, &m->to_ghosts));
  PetscCall(ISGetLocalSize(m->reach, &n));
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, n, &m->interface_right));
  PetscCall(VecDuplicate(m->interface_right, &m->interface_left));
  PetscCall(VecScatterCreate(m->number, m->reach, m->interface_right, NULL, &m->to_interface));
  PetscCall(KSPCreate(PETSC_COMM_SELF, &m->direct));
  PetscCall(KSPSetOptionsPrefix(m->direct, MULTIGRID_INTERFACE));
  PetscCall(DirectSolverSet(m->direct, m->symmetric));
  PetscCall(KSPSetFromOptions(m->direct));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Factors the operator's rows and columns of the interface. */
static PetscErrorCode SetUpInterface(Multigrid m, Mat A)
{
  PetscInt n;
  Mat     *blocks;

  PetscFunctionBeginUser;
  if (!m->interface) PetscFunctionReturn(PETSC_SUCCESS);
  if (!m->direct) PetscCall(CreateDirect(m, A));
  PetscCall(VecGetSize(m->interface_right, &n));
  PetscCall(MatCreateSubMatrices(A, n ? 1 : 0, &m->reach, &m->reach, MAT_INITIAL_MATRIX, &blocks));
  if (n) {
    PetscCall(MatSetOption(blocks[0], MAT_SYMMETRIC, m->symmetric));
    PetscCall(KSPSetOperators(m->direct, blocks[0], blocks[0]));
    PetscCall(KSPSetUp(m->direct));
  }
  PetscCall(MatDestroySubMatrices(n ? 1 : 0, &blocks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Subtracts (one block of the operator) x from the residual, in rows of the interface. begin: first row of this rank */
static PetscErrorCode SubtractBlock(Mat A, int block, PetscInt n, const PetscInt *interface, PetscInt begin, Vec x,
                                    PetscScalar *residual)
{
  MatrixRows         rows;
  const PetscScalar *from;

  PetscFunctionBeginUser;
  PetscCall(MatrixRowsGet(A, block, &rows));
  if (!rows.mat) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(x, &from));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt row = interface[i] - begin;
    PetscScalar    sum = 0;

    for (PetscInt k = rows.ptr[row]; k < rows.ptr[row + 1]; k++) sum += rows.value[k] * from[rows.column[k]];
    residual[row] -= sum;
  }
  PetscCall(VecRestoreArrayRead(x, &from));
  PetscCall(MatrixRowsRestore(&rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes m->residual = right - A left in the rows of the interface only, which are few. */
static PetscErrorCode MultigridFindResidual(Multigrid m, Mat A, Vec right, Vec left)
{
  PetscInt           n, begin;
  const PetscInt    *interface;
  const PetscScalar *from;
  PetscScalar       *residual;

  PetscFunctionBeginUser;
  if (m->ghosts) PetscCall(VecScatterBegin(m->to_ghosts, left, m->ghosts, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetOwnershipRange(left, &begin, NULL));
  PetscCall(ISGetLocalSize(m->interface, &n));
  PetscCall(ISGetIndices(m->interface, &interface));
  PetscCall(VecGetArrayRead(right, &from));
  PetscCall(VecGetArray(m->residual, &residual));
  for (PetscInt i = 0; i < n; i++) residual[interface[i] - begin] = from[interface[i] - begin];
  PetscCall(SubtractBlock(A, MATRIX_OWN, n, interface, begin, left, residual));
  if (m->ghosts) PetscCall(VecScatterEnd(m->to_ghosts, left, m->ghosts, INSERT_VALUES, SCATTER_FORWARD));
  if (m->ghosts) PetscCall(SubtractBlock(A, MATRIX_OTHERS, n, interface, begin, m->ghosts, residual));
  PetscCall(VecRestoreArray(m->residual, &residual));
  PetscCall(VecRestoreArrayRead(right, &from));
  PetscCall(ISRestoreIndices(m->interface, &interface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the interface's solution for `right` to `left`. */
static PetscErrorCode AddInterface(Multigrid m, Vec right, Vec left)
{
  PetscInt           n, n_own, first;
  const PetscInt    *own, *reach;
  const PetscScalar *from;
  PetscScalar       *to;

  PetscFunctionBeginUser;
  PetscCall(VecScatterBegin(m->to_interface, right, m->interface_right, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(m->to_interface, right, m->interface_right, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetSize(m->interface_right, &n));
  if (n) PetscCall(KSPSolve(m->direct, m->interface_right, m->interface_left));
  PetscCall(VecGetOwnershipRange(left, &first, NULL));
  PetscCall(ISGetLocalSize(m->interface, &n_own));
  PetscCall(ISGetIndices(m->interface, &own));
  PetscCall(ISGetIndices(m->reach, &reach));
  PetscCall(VecGetArrayRead(m->interface_left, &from));
  PetscCall(VecGetArray(left, &to));
  for (PetscInt i = 0, k = 0; i < n_own; i++) {
    while (reach[k] != own[i]) k++;
    to[own[i] - first] += from[k];
  }
  PetscCall(VecRestoreArray(left, &to));
  PetscCall(VecRestoreArrayRead(m->interface_left, &from));
  PetscCall(ISRestoreIndices(m->reach, &reach));
  PetscCall(ISRestoreIndices(m->interface, &own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the effort of the last solve: iterations for each power of ten in the residual; 0 where the solve was too short
   to measure it. The first iteration does not count. It is the interface's, whose stiff forces may be all that there is
   at first. */
static PetscErrorCode LastEffort(Multigrid m, PetscReal *effort)
{
  const PetscReal *residual;
  PetscInt         n;
  PetscReal        shown;

  PetscFunctionBeginUser;
  *effort = 0;
  PetscCall(KSPGetResidualHistory(m->outer, &residual, &n));
  if (n < 3 || !(residual[n - 1] > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  shown = PetscLog10Real(residual[1] / residual[n - 1]);
  if (shown >= MULTIGRID_SHOWN) *effort = (n - 2) / shown;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds whether multigrid is too old for the present operators. */
static PetscErrorCode IsAged(Multigrid m, PetscBool *aged)
{
  PetscReal effort = 0;

  PetscFunctionBeginUser;
  *aged = PETSC_FALSE;
  PetscCall(LastEffort(m, &effort));
  if (!(m->usual > 0)) m->usual = effort;
  *aged = (PetscBool)((m->solves > 1 && m->applied > MULTIGRID_MOST) || effort > MULTIGRID_AGE * m->usual);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MultigridSetUp(PC pc)
{
  Multigrid m;
  Mat       A;
  PetscBool aged;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &m));
  PetscCall(PCGetOperators(pc, NULL, &A));
  PetscCall(IsAged(m, &aged));
  if (m->renew || aged) PetscCall(SetUpBodies(m, A, aged));
  PetscCall(SetUpInterface(m, A));
  m->applied = 0;
  m->solves++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Applies multigrid to the bodies, then solves on the interface for what that has left. */
static PetscErrorCode MultigridApply(PC pc, Vec right, Vec left)
{
  Multigrid m;
  Mat       A;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &m));
  m->applied++;
  PetscCall(ApplyBodies(m, right, left));
  if (!m->interface) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PCGetOperators(pc, NULL, &A));
  PetscCall(MultigridFindResidual(m, A, right, left));
  PetscCall(AddInterface(m, m->residual, left));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MultigridCreate - creates the preconditioner and sets a KSP up with it.

  Collective

  Input Parameters:
+ mesh         - borrowed, its constraints set
. axisymmetric - the only rigid-body mode is the one along the axis
. symmetric    - all operators are symmetric
. constant     - the bodies' stiffness stays the same, but for little
- ksp          - of matrices over the mesh's free dofs; it keeps its residuals for the preconditioner

  Output Parameter:
. out - destroy it with MultigridDestroy(), after the KSP

  Options Database Keys:
+ -bodies_pc_..., -bodies_mg_...         - multigrid for the bodies
- -interface_ksp_..., -interface_pc_... - direct solve for the interface
@*/
PetscErrorCode MultigridCreate(Mesh mesh, PetscBool axisymmetric, PetscBool symmetric, PetscBool constant, KSP ksp,
                               Multigrid *out)
{
  Multigrid m;
  PC        pc;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  m->outer        = ksp;
  m->mesh         = mesh;
  m->axisymmetric = axisymmetric;
  m->symmetric    = symmetric;
  m->constant     = constant;
  m->renew        = PETSC_TRUE;
  PetscCall(MultigridNumberNodes(m));
  PetscCall(KSPSetResidualHistory(ksp, NULL, PETSC_DECIDE, PETSC_TRUE));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, m));
  PetscCall(PCShellSetName(pc, "multigrid for the bodies, direct solve for the contact interface"));
  PetscCall(PCShellSetSetUp(pc, MultigridSetUp));
  PetscCall(PCShellSetApply(pc, MultigridApply));
  *out = m;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MultigridDestroy - frees the preconditioner.

  Collective

  Input Parameter:
. multigrid - may be NULL inside
@*/
PetscErrorCode MultigridDestroy(Multigrid *multigrid)
{
  Multigrid m = *multigrid;

  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ForgetInterface(m));
  PetscCall(PCDestroy(&m->bodies));
  PetscCall(MatDestroy(&m->nodes));
  PetscCall(MatDestroy(&m->swept));
  PetscCall(VecDestroy(&m->nodes_right));
  PetscCall(VecDestroy(&m->nodes_left));
  PetscCall(VecDestroy(&m->residual));
  PetscCall(VecDestroy(&m->number));
  PetscCall(PetscFree(m->row));
  PetscCall(PetscFree(*multigrid));
  PetscFunctionReturn(PETSC_SUCCESS);
}
