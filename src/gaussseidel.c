#include "gaussseidel.h"
#include "matrixrows.h"

/* Most rows of a block */
enum { BLOCK_ROWS = MATRIX_NODE_ROWS };

enum { FORWARD, BACKWARD, WAYS };

/* Rows next to each other with the same columns */
typedef struct {
  PetscInt  row, size;
  PetscInt  diagonal;                         /* where its own columns start in each of its rows */
  PetscInt  mixed;                            /* which of these it is; -1: it has no columns of others, lower ones are swept before it, higher ones after it */
  PetscReal inverse[BLOCK_ROWS * BLOCK_ROWS]; /* of the block on the diagonal */
} Block;

/* Where the entries of a block start in the list of those that are swept before it (forward) and after it (backward) */
typedef struct {
  PetscInt first[MATRIX_BLOCKS * WAYS + 1]; /* columns of this rank, then of others; in each those of either way; where they end */
} Mixed;

typedef struct _n_GaussSeidel {
  PetscInt   n_blocks, n_inner; /* of which so many have no columns of others */
  Block     *block;             /* these first, then those at the border; either in ascending order */
  PetscInt   n_mixed;
  Mixed     *mixed;
  PetscInt  *entry;            /* of the mixed blocks: which of a row's */
  PetscInt  *place;            /* of each row: when it is swept, blocks that are together have the same */
  int        colours, colour;  /* of the ranks; this one's */
  int       *ghost_colour;     /* of each column of other ranks */
  PetscSF    sf;               /* to these columns; NULL: one rank */
  PetscReal *x, *rest, *ghost; /* rest: right-hand side less the rows before */
} * GaussSeidel;

/* The matrix for the time of a sweep */
typedef struct {
  MatrixRows         rows[MATRIX_BLOCKS];
  const PetscScalar *value[MATRIX_BLOCKS];
} Operator;

static PetscErrorCode OperatorGet(PC pc, Operator *A)
{
  Mat mat;

  PetscFunctionBeginUser;
  PetscCall(PCGetOperators(pc, NULL, &mat));
  for (int b = 0; b < MATRIX_BLOCKS; b++) {
    A->value[b] = NULL;
    PetscCall(MatrixRowsGet(mat, b, &A->rows[b]));
    if (A->rows[b].mat) PetscCall(MatSeqAIJGetArrayRead(A->rows[b].mat, &A->value[b]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode OperatorRestore(Operator *A)
{
  PetscFunctionBeginUser;
  for (int b = 0; b < MATRIX_BLOCKS; b++) {
    if (A->rows[b].mat) PetscCall(MatSeqAIJRestoreArrayRead(A->rows[b].mat, &A->value[b]));
    PetscCall(MatrixRowsRestore(&A->rows[b]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- colours of ranks ---------- */

/* Ranks that own columns of this one's, ascending; ranks: room for all. */
static void ListNeighbours(const MatrixRows *others, PetscInt n, const PetscInt *ranges, PetscMPIInt *ranks, PetscMPIInt *count)
{
  PetscMPIInt rank = 0;

  *count = 0;
  for (PetscInt k = 0; k < n; k++) {
    while (others->global[k] >= ranges[rank + 1]) rank++;
    if (!*count || ranks[*count - 1] != rank) ranks[(*count)++] = rank;
  }
}

/* The first colour that no neighbour before has, rank by rank: all ranks find the same. */
static PetscErrorCode ColourRanks(MPI_Comm comm, const PetscMPIInt *mine, PetscMPIInt count, int *colour)
{
  PetscMPIInt  size, *counts, *first, *all;
  PetscMPIInt *taken;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMalloc3(size, &counts, size + 1, &first, size, &taken));
  PetscCallMPI(MPI_Allgather(&count, 1, MPI_INT, counts, 1, MPI_INT, comm));
  first[0] = 0;
  for (PetscMPIInt r = 0; r < size; r++) first[r + 1] = first[r] + counts[r];
  PetscCall(PetscMalloc1(first[size], &all));
  PetscCallMPI(MPI_Allgatherv(mine, count, MPI_INT, all, counts, first, MPI_INT, comm));
  for (PetscMPIInt c = 0; c < size; c++) taken[c] = -1;
  for (PetscMPIInt r = 0; r < size; r++) {
    for (PetscMPIInt k = first[r]; k < first[r + 1]; k++)
      if (all[k] < r) taken[colour[all[k]]] = r;
    for (colour[r] = 0; taken[colour[r]] == r;) colour[r]++;
  }
  PetscCall(PetscFree(all));
  PetscCall(PetscFree3(counts, first, taken));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How values of other ranks come here, and whose they are. */
static PetscErrorCode FindGhosts(GaussSeidel g, Mat mat, const MatrixRows *others)
{
  const PetscInt *ranges;
  PetscInt        n;
  PetscMPIInt     size, rank, count, *ranks;
  PetscLayout     layout;
  int            *colour;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)mat), &size));
  PetscCallMPI(MPI_Comm_rank(PetscObjectComm((PetscObject)mat), &rank));
  PetscCall(MatGetSize(others->mat, NULL, &n));
  PetscCall(MatGetLayouts(mat, &layout, NULL));
  PetscCall(MatGetOwnershipRanges(mat, &ranges));
  PetscCall(PetscSFCreate(PetscObjectComm((PetscObject)mat), &g->sf));
  PetscCall(PetscSFSetGraphLayout(g->sf, layout, n, NULL, PETSC_COPY_VALUES, others->global));
  PetscCall(PetscMalloc2(n, &g->ghost, n, &g->ghost_colour));
  PetscCall(PetscMalloc2(size, &ranks, size, &colour));
  ListNeighbours(others, n, ranges, ranks, &count);
  PetscCall(ColourRanks(PetscObjectComm((PetscObject)mat), ranks, count, colour));
  g->colour = colour[rank];
  for (PetscMPIInt r = 0; r < size; r++) g->colours = PetscMax(g->colours, colour[r] + 1);
  for (PetscInt k = 0, r = 0; k < n; k++) {
    while (others->global[k] >= ranges[r + 1]) r++;
    g->ghost_colour[k] = colour[r];
  }
  PetscCall(PetscFree2(ranks, colour));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- blocks ---------- */

static PetscBool IsBorder(const Operator *A, const Block *b)
{
  const MatrixRows *others = &A->rows[MATRIX_OTHERS];

  return others->mat && others->ptr[b->row + b->size] > others->ptr[b->row] ? PETSC_TRUE : PETSC_FALSE;
}

/* Where a block starts in its rows: it is rows next to each other of a symmetric pattern, so its columns are there, next to each other. */
static PetscErrorCode FindDiagonal(const MatrixRows *own, Block *b)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFindInt(b->row, own->ptr[b->row + 1] - own->ptr[b->row], &own->column[own->ptr[b->row]], &b->diagonal));
  PetscCheck(b->diagonal >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "row %" PetscInt_FMT " has no entry on the diagonal", b->row);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Blocks of alike rows, those without columns of others first. */
static PetscErrorCode FindBlocks(GaussSeidel g, const Operator *A)
{
  const MatrixRows *own = &A->rows[MATRIX_OWN];
  PetscInt          n   = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(own->n, &g->block));
  for (int border = 0; border < 2; border++) {
    if (border) g->n_inner = n;
    for (PetscInt row = 0; row < own->n;) {
      Block b = {.row = row, .size = MatrixRowsAlike(A->rows, row)};

      row += b.size;
      if ((int)IsBorder(A, &b) != border) continue;
      PetscCall(FindDiagonal(own, &b));
      g->block[n++] = b;
    }
  }
  g->n_blocks = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ranks of even colours sweep their border first, those of odd ones last: of two ranks none waits for the other. */
static PetscBool IsBorderFirst(GaussSeidel g)
{
  return g->colour % 2 == 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* Has it columns of others, or lower ones of this rank that are swept after it, or higher ones before it? */
static PetscBool IsMixed(GaussSeidel g, const Operator *A, const Block *b)
{
  const MatrixRows *own = &A->rows[MATRIX_OWN];

  if (IsBorder(A, b)) return PETSC_TRUE;
  for (PetscInt k = own->ptr[b->row]; k < own->ptr[b->row + 1]; k++) {
    const PetscInt column = own->column[k];

    if (column < b->row && g->place[column] > g->place[b->row]) return PETSC_TRUE;
    if (column >= b->row + b->size && g->place[column] < g->place[b->row]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* When each row is swept, and which blocks are mixed; *entries: those of the latter. */
static PetscErrorCode PlaceBlocks(GaussSeidel g, const Operator *A, PetscInt *entries)
{
  const PetscInt n_border = g->n_blocks - g->n_inner;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(A->rows[MATRIX_OWN].n, &g->place));
  for (PetscInt k = 0; k < g->n_blocks; k++)
    for (PetscInt r = 0; r < g->block[k].size; r++) g->place[g->block[k].row + r] = !IsBorderFirst(g) ? k : k < g->n_inner ? k + n_border : k - g->n_inner;
  *entries = 0;
  for (PetscInt k = 0; k < g->n_blocks; k++) {
    Block *b = &g->block[k];

    b->mixed = IsMixed(g, A, b) ? g->n_mixed++ : -1;
    for (int m = 0; m < MATRIX_BLOCKS && b->mixed >= 0; m++)
      if (A->rows[m].mat) *entries += A->rows[m].ptr[b->row + 1] - A->rows[m].ptr[b->row];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is a column swept before a block (forward), or after it (backward)? */
static PetscBool IsSwept(GaussSeidel g, const Block *b, int block, PetscInt column, int way)
{
  const PetscInt place = block == MATRIX_OWN ? g->place[column] : g->ghost_colour[column], at = block == MATRIX_OWN ? g->place[b->row] : g->colour;

  return (way == FORWARD ? place < at : place > at) ? PETSC_TRUE : PETSC_FALSE;
}

/* Lists what each mixed block looks at on either way, so that no sweep need ask: at 100,000 unknowns they are a tenth of the blocks on two ranks. */
static PetscErrorCode ListMixed(GaussSeidel g, const Operator *A, PetscInt entries)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(g->n_mixed, &g->mixed));
  PetscCall(PetscMalloc1(entries, &g->entry));
  for (PetscInt k = 0; k < g->n_blocks; k++) {
    const Block *b = &g->block[k];

    for (int list = 0; list < MATRIX_BLOCKS * WAYS && b->mixed >= 0; list++) {
      const int         block = list / WAYS;
      const MatrixRows *rows  = &A->rows[block];
      const PetscInt    first = rows->mat ? rows->ptr[b->row] : 0, end = rows->mat ? rows->ptr[b->row + 1] : 0;

      g->mixed[b->mixed].first[list] = n;
      for (PetscInt l = first; l < end; l++)
        if (IsSwept(g, b, block, rows->column[l], list % WAYS)) g->entry[n++] = l - first;
      g->mixed[b->mixed].first[list + 1] = n;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The inverse of a block by Gauss and Jordan's method, 0 where it has none: what cannot be solved for stays as it is. */
static void InvertBlock(const Operator *A, Block *b)
{
  const PetscInt  n   = b->size;
  const PetscInt *ptr = A->rows[MATRIX_OWN].ptr;
  PetscReal       a[BLOCK_ROWS][BLOCK_ROWS], scale = 0, *inverse = b->inverse;

  for (PetscInt i = 0; i < n; i++) {
    for (PetscInt j = 0; j < n; j++) {
      a[i][j]            = A->value[MATRIX_OWN][ptr[b->row + i] + b->diagonal + j];
      inverse[i * n + j] = i == j;
    }
    scale = PetscMax(scale, PetscAbsReal(a[i][i]));
  }
  for (PetscInt p = 0; p < n; p++) {
    const PetscReal pivot = a[p][p];

    if (PetscAbsReal(pivot) <= PETSC_MACHINE_EPSILON * scale) {
      for (PetscInt k = 0; k < n * n; k++) inverse[k] = 0;
      return;
    }
    for (PetscInt j = 0; j < n; j++) {
      a[p][j] /= pivot;
      inverse[p * n + j] /= pivot;
    }
    for (PetscInt i = 0; i < n; i++) {
      const PetscReal factor = a[i][p];

      for (PetscInt j = 0; j < n && i != p; j++) {
        a[i][j] -= factor * a[p][j];
        inverse[i * n + j] -= factor * inverse[p * n + j];
      }
    }
  }
}

/* ---------- sweeps ---------- */

/* rest -= (some of the columns of a block's rows) x; size a constant where this is called. Two sums a row: one would wait for itself. */
static inline void Subtract(const int size, PetscInt n, const PetscInt *column, const PetscScalar *value[], const PetscReal *x, PetscReal *rest)
{
  PetscReal even[BLOCK_ROWS] = {0}, odd[BLOCK_ROWS] = {0};
  PetscInt  k;

  for (k = 0; k + 1 < n; k += 2) {
    const PetscReal x0 = x[column[k]], x1 = x[column[k + 1]];

    for (int r = 0; r < size; r++) {
      even[r] += value[r][k] * x0;
      odd[r] += value[r][k + 1] * x1;
    }
  }
  for (int r = 0; r < size; r++) {
    if (k < n) even[r] += value[r][k] * x[column[k]];
    rest[r] -= even[r] + odd[r];
  }
}

/* The same for a mixed block, by its list */
static inline void SubtractMixed(const int size, GaussSeidel g, const Operator *A, const Block *b, int way, PetscReal *rest)
{
  const PetscInt  *first = g->mixed[b->mixed].first;
  const PetscReal *x[]   = {g->x, g->ghost};

  for (int block = 0; block < MATRIX_BLOCKS; block++, first += WAYS) {
    const MatrixRows  *rows = &A->rows[block];
    const PetscScalar *value[BLOCK_ROWS];
    const PetscInt    *column;
    PetscReal          sum[BLOCK_ROWS] = {0};

    if (!rows->mat) continue;
    column = &rows->column[rows->ptr[b->row]];
    for (int r = 0; r < size; r++) value[r] = &A->value[block][rows->ptr[b->row + r]];
    for (PetscInt l = first[way]; l < first[way + 1]; l++) {
      const PetscInt  k  = g->entry[l];
      const PetscReal xk = x[block][column[k]];

      for (int r = 0; r < size; r++) sum[r] += value[r][k] * xk;
    }
    for (int r = 0; r < size; r++) rest[r] -= sum[r];
  }
}

static inline void SweepBlock(const int size, GaussSeidel g, const Operator *A, const Block *b, int way)
{
  const MatrixRows  *own  = &A->rows[MATRIX_OWN];
  const PetscInt     from = way == FORWARD ? 0 : b->diagonal + size, to = way == FORWARD ? b->diagonal : own->ptr[b->row + 1] - own->ptr[b->row];
  const PetscScalar *value[BLOCK_ROWS];
  PetscReal         *rest = &g->rest[b->row];

  for (int r = 0; r < size; r++) value[r] = &A->value[MATRIX_OWN][own->ptr[b->row + r] + from];
  if (b->mixed < 0)
    Subtract(size, to - from, &own->column[own->ptr[b->row] + from], value, g->x, rest);
  else
    SubtractMixed(size, g, A, b, way, rest);
  for (int r = 0; r < size; r++) {
    g->x[b->row + r] = 0;
    for (int c = 0; c < size; c++) g->x[b->row + r] += b->inverse[r * size + c] * rest[c];
  }
}

/* Blocks from..to-1, or from the last of them to the first. */
static void Sweep(GaussSeidel g, const Operator *A, PetscInt from, PetscInt to, int way)
{
  for (PetscInt k = from; k < to; k++) {
    const Block *b = &g->block[way == FORWARD ? k : from + to - 1 - k];

    if (b->size == 3)
      SweepBlock(3, g, A, b, way);
    else
      SweepBlock((int)b->size, g, A, b, way);
  }
}

/* One way through all rows. The ranks take turns at their borders, colour after colour; meanwhile, or before, they sweep what is inside. */
static PetscErrorCode SweepAll(GaussSeidel g, const Operator *A, int way)
{
  const PetscBool border_first = (PetscBool)(IsBorderFirst(g) == (way == FORWARD));

  PetscFunctionBeginUser;
  if (!border_first || !g->sf) Sweep(g, A, 0, g->n_inner, way);
  for (int turn = 0; g->sf && turn < g->colours; turn++) {
    const PetscBool mine = (PetscBool)(g->colour == (way == FORWARD ? turn : g->colours - 1 - turn)), last = (PetscBool)(turn == g->colours - 1);

    if (mine) Sweep(g, A, g->n_inner, g->n_blocks, way);
    if (!last) PetscCall(PetscSFBcastBegin(g->sf, MPIU_SCALAR, g->x, g->ghost, MPI_REPLACE));
    if (mine && border_first) Sweep(g, A, 0, g->n_inner, way);
    if (!last) PetscCall(PetscSFBcastEnd(g->sf, MPIU_SCALAR, g->x, g->ghost, MPI_REPLACE));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- the preconditioner ---------- */

static PetscErrorCode Reset(GaussSeidel g)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSFDestroy(&g->sf));
  PetscCall(PetscFree(g->block));
  PetscCall(PetscFree(g->place));
  PetscCall(PetscFree(g->mixed));
  PetscCall(PetscFree(g->entry));
  PetscCall(PetscFree2(g->ghost, g->ghost_colour));
  PetscCall(PetscFree(g->rest));
  *g = (struct _n_GaussSeidel){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUp(PC pc)
{
  GaussSeidel g;
  Operator    A;
  Mat         mat;
  PetscInt    entries = 0;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &g));
  PetscCall(PCGetOperators(pc, NULL, &mat));
  PetscCall(Reset(g));
  PetscCall(OperatorGet(pc, &A));
  if (A.rows[MATRIX_OTHERS].mat) PetscCall(FindGhosts(g, mat, &A.rows[MATRIX_OTHERS]));
  PetscCall(FindBlocks(g, &A));
  PetscCall(PlaceBlocks(g, &A, &entries));
  PetscCall(ListMixed(g, &A, entries));
  for (PetscInt k = 0; k < g->n_blocks; k++) InvertBlock(&A, &g->block[k]);
  PetscCall(PetscMalloc1(A.rows[MATRIX_OWN].n, &g->rest));
  PetscCall(OperatorRestore(&A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forward and back again from 0. On the way back the rows before a block need not be looked at: what they leave is known from the way there. */
static PetscErrorCode Apply(PC pc, Vec right, Vec left)
{
  GaussSeidel        g;
  Operator           A;
  const PetscScalar *from;
  PetscInt           n;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &g));
  PetscCall(OperatorGet(pc, &A));
  PetscCall(VecGetLocalSize(right, &n));
  PetscCall(VecGetArrayRead(right, &from));
  PetscCall(PetscArraycpy(g->rest, from, n));
  PetscCall(VecRestoreArrayRead(right, &from));
  PetscCall(VecGetArrayWrite(left, &g->x));
  PetscCall(SweepAll(g, &A, FORWARD));
  PetscCall(SweepAll(g, &A, BACKWARD));
  PetscCall(VecRestoreArrayWrite(left, &g->x));
  PetscCall(OperatorRestore(&A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(PC pc)
{
  GaussSeidel g;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &g));
  PetscCall(Reset(g));
  PetscCall(PetscFree(g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* GaussSeidelSet - makes a preconditioner one symmetric sweep of Gauss-Seidel's method, over blocks of rows with the same columns.

   Logically collective. pc: of AIJ matrices whose pattern and values are symmetric, of any number of ranks.
   Source: Saad, Iterative Methods for Sparse Linear Systems, 4.1 and 12.4; the order of ranks: Adams, A distributed memory unstructured Gauss-Seidel algorithm
   for multigrid smoothers, 2001. */
PetscErrorCode GaussSeidelSet(PC pc)
{
  GaussSeidel g;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&g));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, g));
  PetscCall(PCShellSetName(pc, "symmetric Gauss-Seidel sweep across all ranks"));
  PetscCall(PCShellSetSetUp(pc, SetUp));
  PetscCall(PCShellSetApply(pc, Apply));
  PetscCall(PCShellSetDestroy(pc, Destroy));
  PetscFunctionReturn(PETSC_SUCCESS);
}
