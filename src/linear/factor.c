#include "linear/factor.h"
#include "matrix/matrixrows.h"
#include "ordering.h"
#include <dmumps_c.h>

/* MUMPS's parameters have numbers, from 1. */
#define MUMPS_ICNTL  60
#define MUMPS_CNTL   15
#define ICNTL(i)     icntl[(i) - 1]
#define INFOG(i)     infog[(i) - 1]
#define RINFOG(i)    rinfog[(i) - 1]
#define MPI_MUMPSINT (sizeof(MUMPS_INT) == sizeof(int64_t) ? MPI_INT64_T : MPI_INT32_T)

/* Its jobs */
enum { MUMPS_BEGIN = -1, MUMPS_END = -2, MUMPS_ANALYSE = 1, MUMPS_FACTOR = 2, MUMPS_SOLVE = 3 };
/* Its ICNTL(7) for an ordering that it is given, and for its own choice */
enum { MUMPS_GIVEN = 1, MUMPS_OWN = 7 };
/* Unknowns from which on rows are ordered by dissection: below, a factorisation is not what a run spends its time with.
 */
enum { FACTOR_DISSECTED = 4000 };
/* Workspace above its estimate, in per cent. Its own 20 is too little for symmetric systems of a few thousand dofs on
 * four ranks. */
enum { FACTOR_WORKSPACE = 100 };
/* How often it may be doubled: to a multiple of the estimate that delayed pivots of regular systems never need */
enum { FACTOR_MORE = 2 };
/* How it scales symmetric systems: by the diagonal. Its own choice iterates over rows and columns, which costs a
   seventh of a factorisation at 10,000 dofs; stiff penalties stand on the diagonal. */
enum { FACTOR_SCALING = 1 };
/* Columns that are solved for at a time: enough for products of matrices, few enough for the first rank's memory. */
enum { FACTOR_COLUMNS = 128 };

/* Memory for entries over what a pattern has, for the next one, which often has few more: new memory costs more than
 * what is written there. */
#define FACTOR_ROOM 1.25

struct _n_Factor {
  MPI_Comm         comm;
  PetscMPIInt      rank, size, *count, *first; /* rows of each rank */
  PetscBool        symmetric, exists;          /* there is a factor */
  int              ordering;
  PetscObjectId    matrix; /* whose entries' rows and columns stand below, 0: none's; and its pattern */
  PetscObjectState pattern;
  PetscBool        analysed;     /* and that, as it is ordered and bordered now */
  PetscInt         n, rows;      /* rows of all ranks, of this one */
  PetscInt         entries, own; /* of this rank: all, those of the matrix */
  PetscInt *from[MATRIX_BLOCKS]; /* of each row and block, its first entry that is taken: of a symmetric matrix none
                                    below the diagonal */
  PetscInt       room;
  MUMPS_INT     *row, *column; /* entries of this rank, from 1, in memory for `room` */
  PetscScalar   *value;
  BorderedFactor bordering; /* NULL: none was prepared */
  PetscBool      bordered;  /* the next matrix is */
  PetscBool      changed;   /* by another border than the one that was analysed */
  MUMPS_INT      workspace; /* ICNTL(14) at first */
  MUMPS_INT     *position;  /* of rows, where the ordering is given; on the first rank, as are: */
  PetscScalar   *right;     /* room for right-hand sides and solutions */
  DMUMPS_STRUC_C mumps;
};

static PetscErrorCode Call(Factor f, int job)
{
  PetscFunctionBeginUser;
  f->mumps.job = job;
  dmumps_c(&f->mumps);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- parameters ---------- */

/* -mat_mumps_<kind>_<i> */
static PetscErrorCode ReadOptions(MUMPS_INT *icntl, DMUMPS_REAL *cntl)
{
  char      name[64];
  PetscInt  integer;
  PetscReal real;
  PetscBool given;

  PetscFunctionBeginUser;
  for (int i = 1; i <= MUMPS_ICNTL; i++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "-mat_mumps_icntl_%d", i));
    PetscCall(PetscOptionsGetInt(NULL, NULL, name, &integer, &given));
    if (given) ICNTL(i) = (MUMPS_INT)integer;
  }
  for (int i = 1; i <= MUMPS_CNTL; i++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "-mat_mumps_cntl_%d", i));
    PetscCall(PetscOptionsGetReal(NULL, NULL, name, &real, &given));
    if (given) cntl[i - 1] = real;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* FactorCheckOptions - Not collective. */
PetscErrorCode FactorCheckOptions(void)
{
  MUMPS_INT   icntl[MUMPS_ICNTL];
  DMUMPS_REAL cntl[MUMPS_CNTL];

  PetscFunctionBeginUser;
  PetscCall(ReadOptions(icntl, cntl));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FactorBegin(Factor f)
{
  DMUMPS_STRUC_C *mumps = &f->mumps;

  PetscFunctionBeginUser;
  mumps->comm_fortran = (MUMPS_INT)MPI_Comm_c2f(f->comm);
  mumps->par          = 1;                    /* the first rank works too */
  mumps->sym          = f->symmetric ? 2 : 0; /* 2: need not be positive definite */
  PetscCall(Call(f, MUMPS_BEGIN));
  PetscCheck(mumps->INFOG(1) >= 0, f->comm, PETSC_ERR_LIB, "MUMPS does not start: INFOG(1) = %d, INFOG(2) = %d",
             (int)mumps->INFOG(1), (int)mumps->INFOG(2));
  for (int i = 1; i <= 4; i++) mumps->ICNTL(i) = 0; /* prints nothing */
  mumps->ICNTL(6) = 0;                              /* nor brings large entries to the diagonal, where they are */
  if (f->symmetric) mumps->ICNTL(8) = FACTOR_SCALING;
  mumps->ICNTL(14) = FACTOR_WORKSPACE;
  PetscCall(ReadOptions(mumps->icntl, mumps->cntl));
  f->workspace     = mumps->ICNTL(14);
  mumps->ICNTL(18) = f->size > 1 ? 3 : 0; /* entries: of each rank where it has them */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* FactorCreate - Collective; destroy it with FactorDestroy(). */
PetscErrorCode FactorCreate(MPI_Comm comm, PetscBool symmetric, Factor *out)
{
  Factor f;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  PetscCall(PetscCommDuplicate(comm, &f->comm, NULL));
  PetscCallMPI(MPI_Comm_rank(f->comm, &f->rank));
  PetscCallMPI(MPI_Comm_size(f->comm, &f->size));
  PetscCall(PetscCalloc2(f->size, &f->count, f->size + 1, &f->first));
  f->symmetric = symmetric;
  PetscCall(FactorBegin(f));
  PetscCall(FactorSetOrdering(f, FACTOR_AUTOMATIC, NULL));
  *out = f;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* FactorDestroy - Collective. */
PetscErrorCode FactorDestroy(Factor *factor)
{
  Factor f = *factor;

  PetscFunctionBeginUser;
  if (!f) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Call(f, MUMPS_END));
  PetscCall(PetscFree2(f->from[MATRIX_OWN], f->from[MATRIX_OTHERS]));
  PetscCall(PetscFree3(f->row, f->column, f->value));
  PetscCall(PetscFree(f->position));
  PetscCall(PetscFree(f->right));
  PetscCall(PetscFree2(f->count, f->first));
  PetscCall(BorderedFactorDestroy(&f->bordering));
  PetscCall(PetscCommDestroy(&f->comm));
  PetscCall(PetscFree(*factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* FactorSetOrdering - Logically collective. */
PetscErrorCode FactorSetOrdering(Factor f, int ordering, PetscBool *chosen)
{
  PetscInt  asked;
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-mat_mumps_icntl_7", &asked, &given));
  if (given) ordering = (int)asked;
  if (ordering != f->ordering) f->analysed = PETSC_FALSE;
  f->ordering = ordering;
  if (chosen) *chosen = given ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* FactorSetBorder - Collective. The factor that there is stays as it is. */
PetscErrorCode FactorSetBorder(Factor f, const Border *border)
{
  const PetscBool bordered = border ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCheck(!border || f->bordering, f->comm, PETSC_ERR_ARG_WRONGSTATE, "borders have not been prepared for");
  if (border) PetscCall(BorderedFactorSet(f->bordering, border, &f->changed));
  if (bordered != f->bordered) f->analysed = PETSC_FALSE;
  f->bordered = bordered;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* FactorHasBorder - Not collective. */
PetscBool FactorHasBorder(Factor f)
{
  return f->bordered;
}

/* ---------- the matrix ---------- */

/* The first entry of row r, start + r of all ranks, that is not below the diagonal, by bisection: columns ascend. */
static PetscInt FirstEntry(const MatrixRows *rows, PetscInt start, PetscInt r)
{
  PetscInt low = rows->ptr[r], high = rows->ptr[r + 1];

  while (low < high) {
    const PetscInt middle = low + (high - low) / 2;

    if (MatrixRowsColumn(rows, start, middle) < start + r)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* Finds and counts the entries of this rank that MUMPS is given. */
static PetscErrorCode FindEntries(Factor f, Mat A, PetscInt start)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(f->from[MATRIX_OWN], f->from[MATRIX_OTHERS]));
  PetscCall(PetscMalloc2(f->rows, &f->from[MATRIX_OWN], f->rows, &f->from[MATRIX_OTHERS]));
  f->own = 0;
  for (int block = 0; block < MATRIX_BLOCKS; block++) {
    MatrixRows rows;

    PetscCall(MatrixRowsGet(A, block, &rows));
    for (PetscInt r = 0; rows.mat && r < rows.n; r++) {
      f->from[block][r] = f->symmetric ? FirstEntry(&rows, start, r) : rows.ptr[r];
      f->own += rows.ptr[r + 1] - f->from[block][r];
    }
    PetscCall(MatrixRowsRestore(&rows));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows and columns of the entries, from 1 */
static PetscErrorCode TakePlaces(Factor f, Mat A, PetscInt start)
{
  MUMPS_INT *row = f->row, *column = f->column;

  PetscFunctionBeginUser;
  for (int block = 0; block < MATRIX_BLOCKS; block++) {
    MatrixRows rows;

    PetscCall(MatrixRowsGet(A, block, &rows));
    for (PetscInt r = 0; rows.mat && r < rows.n; r++) {
      const PetscInt from = f->from[block][r], n = rows.ptr[r + 1] - from;

      for (PetscInt k = 0; k < n; k++) row[k] = (MUMPS_INT)(start + r + 1);
      for (PetscInt k = 0; k < n; k++) column[k] = (MUMPS_INT)(MatrixRowsColumn(&rows, start, from + k) + 1);
      row += n;
      column += n;
    }
    PetscCall(MatrixRowsRestore(&rows));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TakeValues(Factor f, Mat A)
{
  PetscScalar *value = f->value;

  PetscFunctionBeginUser;
  for (int block = 0; block < MATRIX_BLOCKS; block++) {
    MatrixRows rows;

    PetscCall(MatrixRowsGet(A, block, &rows));
    for (PetscInt r = 0; rows.mat && r < rows.n; r++) {
      const PetscInt from = f->from[block][r], n = rows.ptr[r + 1] - from;

      PetscCall(PetscArraycpy(value, &rows.value[from], n));
      value += n;
    }
    PetscCall(MatrixRowsRestore(&rows));
  }
  if (f->bordered) BorderedFactorTake(f->bordering, value);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Memory for the entries; *kept: what stood there stands there still. */
static PetscErrorCode FactorReserve(Factor f, PetscBool *kept)
{
  PetscFunctionBeginUser;
  *kept = (PetscBool)(f->row && f->entries <= f->room);
  if (*kept) PetscFunctionReturn(PETSC_SUCCESS);
  f->room = (PetscInt)(FACTOR_ROOM * f->entries);
  PetscCall(PetscFree3(f->row, f->column, f->value));
  PetscCall(PetscMalloc3(f->room, &f->row, f->room, &f->column, f->room, &f->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows and columns of the border's entries, from 1, behind those of the matrix */
static PetscErrorCode PlaceBorder(Factor f)
{
  const PetscInt from = f->own, n = f->entries - from;
  PetscInt      *row, *column;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &row, n, &column));
  BorderedFactorNumber(f->bordering, row, column);
  for (PetscInt k = 0; k < n; k++) f->row[from + k] = (MUMPS_INT)(row[k] + 1);
  for (PetscInt k = 0; k < n; k++) f->column[from + k] = (MUMPS_INT)(column[k] + 1);
  PetscCall(PetscFree2(row, column));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do the places of a matrix with this pattern stand there? */
static PetscErrorCode IsPlaced(Factor f, Mat A, PetscBool *is)
{
  PetscObjectId    matrix;
  PetscObjectState pattern;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectGetId((PetscObject)A, &matrix));
  PetscCall(MatGetNonzeroState(A, &pattern));
  *is = (PetscBool)(matrix == f->matrix && pattern == f->pattern);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows and columns of all entries; those of the matrix stand where they stood, if it is the same. */
static PetscErrorCode PlaceEntries(Factor f, Mat A)
{
  PetscInt  start;
  PetscBool again, kept;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(A, &start, NULL));
  PetscCall(IsPlaced(f, A, &again));
  if (!again) PetscCall(FindEntries(f, A, start));
  f->entries = f->own + (f->bordered ? BorderedFactorCountEntries(f->bordering) : 0);
  PetscCall(FactorReserve(f, &kept));
  if (!again || !kept) PetscCall(TakePlaces(f, A, start));
  if (f->bordered) PetscCall(PlaceBorder(f));
  PetscCall(PetscObjectGetId((PetscObject)A, &f->matrix));
  PetscCall(MatGetNonzeroState(A, &f->pattern));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* MUMPS is told where the entries are. */
static PetscErrorCode ShowEntries(Factor f, Mat A)
{
  DMUMPS_STRUC_C *mumps = &f->mumps;

  PetscFunctionBeginUser;
  PetscCall(PlaceEntries(f, A));
  PetscCall(TakeValues(f, A));
  if (f->size > 1) {
    mumps->nnz_loc = f->entries;
    mumps->irn_loc = f->row;
    mumps->jcn_loc = f->column;
    mumps->a_loc   = f->value;
  } else {
    mumps->nnz = f->entries;
    mumps->irn = f->row;
    mumps->jcn = f->column;
    mumps->a   = f->value;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of all ranks */
static PetscErrorCode ShowSize(Factor f, Mat A)
{
  const PetscInt *ranges;
  PetscInt        all;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(A, &f->n, NULL));
  PetscCall(MatGetLocalSize(A, &f->rows, NULL));
  all        = f->n + (f->bordered ? BorderedFactorCount(f->bordering) : 0);
  f->mumps.n = (MUMPS_INT)all;
  PetscCheck(f->mumps.n == all, f->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "%" PetscInt_FMT " unknowns are more than MUMPS can count", all);
  PetscCall(MatGetOwnershipRanges(A, &ranges));
  for (PetscMPIInt r = 0; r < f->size; r++) {
    PetscCall(PetscMPIIntCast(ranges[r + 1], &f->first[r + 1]));
    f->count[r] = f->first[r + 1] - f->first[r];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ShowOrdering(Factor f, Mat A)
{
  int       ordering = f->ordering;
  PetscInt *position;

  PetscFunctionBeginUser;
  if (ordering == FACTOR_AUTOMATIC) ordering = f->n < FACTOR_DISSECTED ? MUMPS_OWN : FACTOR_METIS;
  f->mumps.ICNTL(7) = (MUMPS_INT)(f->bordered || ordering == FACTOR_METIS ? MUMPS_GIVEN : ordering);
  if (f->mumps.ICNTL(7) != MUMPS_GIVEN) PetscFunctionReturn(PETSC_SUCCESS);
  if (f->bordered)
    PetscCall(BorderedFactorOrder(f->bordering, &position));
  else
    PetscCall(OrderingFind(A, &position));
  PetscCall(PetscFree(f->position));
  if (!f->rank) PetscCall(PetscMalloc1(f->mumps.n, &f->position));
  for (MUMPS_INT i = 0; i < f->mumps.n && !f->rank; i++) f->position[i] = (MUMPS_INT)(position[i] + 1);
  f->mumps.perm_in = f->position;
  PetscCall(PetscFree(position));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Why a job failed, as PETSc's interface to MUMPS tells it. Source: MUMPS 5.5 Users' guide, section 8. */
static PCFailedReason Reason(Factor f)
{
  switch (f->mumps.INFOG(1)) {
  case -10: return PC_FACTOR_NUMERIC_ZEROPIVOT;
  case -6: return PC_FACTOR_STRUCT_ZEROPIVOT;
  case -5:
  case -7:
  case -8:
  case -9:
  case -11:
  case -12:
  case -13:
  case -14:
  case -15:
  case -17:
  case -18:
  case -19:
  case -20: return PC_FACTOR_OUTMEMORY;
  default: return f->mumps.INFOG(1) < 0 ? PC_FACTOR_OTHER : PC_NOERROR;
  }
}

static PetscErrorCode Tell(Factor f, const char *job, PCFailedReason *reason)
{
  PetscFunctionBeginUser;
  *reason = Reason(f);
  if (*reason)
    PetscCall(PetscInfo(NULL, "MUMPS's %s failed: INFOG(1) = %d, INFOG(2) = %d\n", job, (int)f->mumps.INFOG(1),
                        (int)f->mumps.INFOG(2)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* FactorAnalyse - Collective. *reason: why there will be no factor; a matrix without rows has one. */
PetscErrorCode FactorAnalyse(Factor f, Mat A, PCFailedReason *reason)
{
  PetscFunctionBeginUser;
  f->exists          = PETSC_FALSE;
  f->analysed        = PETSC_FALSE;
  f->mumps.ICNTL(14) = f->workspace;
  *reason            = PC_NOERROR;
  PetscCall(ShowSize(f, A));
  if (!f->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ShowEntries(f, A));
  PetscCall(ShowOrdering(f, A));
  PetscCall(PetscFree(f->right));
  PetscCall(Call(f, MUMPS_ANALYSE));
  PetscCall(Tell(f, "analysis", reason));
  if (*reason) PetscFunctionReturn(PETSC_SUCCESS);
  f->changed  = PETSC_FALSE;
  f->analysed = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has it another pattern than the last that was analysed? The same on all ranks. */
static PetscErrorCode IsNew(Factor f, Mat A, PetscBool *is)
{
  PetscBool placed;
  int       differs;

  PetscFunctionBeginUser;
  PetscCall(IsPlaced(f, A, &placed));
  differs = !f->analysed || !placed || (f->bordered && f->changed);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &differs, 1, MPI_INT, MPI_MAX, f->comm));
  *is = differs ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* FactorPrepareBorder - Collective. *reason: why K cannot be ordered; there are no borders then. An analysis of K that
 * there is serves. */
PetscErrorCode FactorPrepareBorder(Factor f, Mat K, PCFailedReason *reason)
{
  const int ordering = f->ordering;
  PetscBool is_new;
  PetscInt *position = NULL;

  PetscFunctionBeginUser;
  PetscCheck(!f->bordered, f->comm, PETSC_ERR_ARG_WRONGSTATE, "there is a border already");
  *reason = PC_NOERROR;
  if (ordering != FACTOR_MINIMUM_DEGREE) PetscCall(FactorSetOrdering(f, FACTOR_MINIMUM_FILL, NULL));
  PetscCall(IsNew(f, K, &is_new));
  if (is_new) PetscCall(FactorAnalyse(f, K, reason));
  if (!*reason && f->n && !f->rank) PetscCall(PetscMalloc1(f->n, &position));
  for (PetscInt i = 0; position && i < f->n; i++) position[i] = f->mumps.sym_perm[i] - 1;
  PetscCall(FactorSetOrdering(f, ordering, NULL));
  if (*reason || !f->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(BorderedFactorDestroy(&f->bordering));
  PetscCall(BorderedFactorCreate(f->comm, f->n, position, &f->bordering));
  PetscCall(PetscFree(position));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Were workspace or the buffers of messages too short, which ICNTL(14) makes longer? */
static PetscBool IsShort(Factor f)
{
  switch (f->mumps.INFOG(1)) {
  case -8:
  case -9:
  case -17:
  case -20: return PETSC_TRUE;
  default: return PETSC_FALSE;
  }
}

/* Factors; where the workspace was too short, with twice the surplus, and that once more. */
static PetscErrorCode CallFactor(Factor f)
{
  PetscFunctionBeginUser;
  PetscCall(Call(f, MUMPS_FACTOR));
  for (int more = 0; more < FACTOR_MORE && IsShort(f); more++) {
    f->mumps.ICNTL(14) = PetscMax(2 * f->mumps.ICNTL(14), FACTOR_WORKSPACE);
    PetscCall(Call(f, MUMPS_FACTOR));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* FactorMake - Collective. *reason: as of FactorAnalyse(). A's values are copied. */
PetscErrorCode FactorMake(Factor f, Mat A, PCFailedReason *reason)
{
  PetscBool is_new;

  PetscFunctionBeginUser;
  *reason = PC_NOERROR;
  PetscCall(IsNew(f, A, &is_new));
  if (is_new) PetscCall(FactorAnalyse(f, A, reason));
  f->exists = PETSC_FALSE;
  if (*reason || !f->n) PetscFunctionReturn(PETSC_SUCCESS);
  if (!is_new) PetscCall(TakeValues(f, A));
  PetscCall(CallFactor(f));
  PetscCall(Tell(f, "factorisation", reason));
  f->exists = *reason ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* FactorGetCost - INFOG(16), INFOG(17): memory; INFOG(20): entries, negative: in millions; RINFOG(1): operations. Not
 * collective. */
void FactorGetCost(Factor f, FactorCost *cost)
{
  const DMUMPS_STRUC_C *mumps   = &f->mumps;
  const PetscReal       entries = mumps->INFOG(20);

  *cost = (FactorCost){
    .operations = mumps->RINFOG(1),
    .entries    = entries < 0 ? -1e6 * entries : entries,
    .memory_mb  = {mumps->INFOG(16), mumps->INFOG(17)}
  };
}

/* ---------- solves ---------- */

/* Solves for `columns` of them; the solutions stand in right. */
static PetscErrorCode FactorSolveOnce(Factor f, PetscInt columns)
{
  DMUMPS_STRUC_C *mumps = &f->mumps;

  PetscFunctionBeginUser;
  mumps->nrhs      = (MUMPS_INT)columns;
  mumps->lrhs      = mumps->n;
  mumps->rhs       = f->right;
  mumps->ICNTL(21) = 0; /* the solution: all of it on the first rank */
  PetscCall(Call(f, MUMPS_SOLVE));
  PetscCheck(mumps->INFOG(1) >= 0, f->comm, PETSC_ERR_LIB, "MUMPS does not solve: INFOG(1) = %d, INFOG(2) = %d",
             (int)mumps->INFOG(1), (int)mumps->INFOG(2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Room for `columns` on the first rank */
static PetscErrorCode MakeRoom(Factor f, PetscInt columns)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(f->right));
  if (!f->rank) PetscCall(PetscMalloc1((size_t)f->mumps.n * columns, &f->right));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* FactorSolve - Collective. Infinity where there is no factor. */
PetscErrorCode FactorSolve(Factor f, Vec b, Vec x)
{
  const PetscScalar *from;
  PetscScalar       *to;

  PetscFunctionBeginUser;
  if (!f->n) PetscFunctionReturn(PETSC_SUCCESS);
  if (!f->exists) PetscCall(VecSet(x, INFINITY));
  if (!f->exists) PetscFunctionReturn(PETSC_SUCCESS);
  if (!f->right) PetscCall(MakeRoom(f, 1));
  PetscCall(VecGetArrayRead(b, &from));
  PetscCallMPI(
    MPI_Gatherv(from, f->count[f->rank], MPIU_SCALAR, f->right, f->count, f->first, MPIU_SCALAR, 0, f->comm));
  PetscCall(VecRestoreArrayRead(b, &from));
  for (MUMPS_INT i = (MUMPS_INT)f->n; i < f->mumps.n && !f->rank; i++) f->right[i] = 0; /* the border's */
  f->mumps.ICNTL(20) = 0;                                                               /* dense */
  PetscCall(FactorSolveOnce(f, 1));
  PetscCall(VecGetArrayWrite(x, &to));
  PetscCallMPI(MPI_Scatterv(f->right, f->count, f->first, MPIU_SCALAR, to, f->count[f->rank], MPIU_SCALAR, 0, f->comm));
  PetscCall(VecRestoreArrayWrite(x, &to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Entries of right-hand sides that differ from zero: first each rank's, then all of them on the first rank */
typedef struct {
  PetscInt     columns;
  MUMPS_INT   *ptr, *row; /* from 1 */
  PetscScalar *value;
} SparseColumns;

static PetscErrorCode SparseCreate(PetscInt columns, PetscInt entries, SparseColumns *sparse)
{
  PetscFunctionBeginUser;
  sparse->columns = columns;
  PetscCall(PetscCalloc3(columns + 1, &sparse->ptr, entries, &sparse->row, entries, &sparse->value));
  sparse->ptr[0] = 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SparseFree(SparseColumns *sparse)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(sparse->ptr, sparse->row, sparse->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of this rank's rows b[columns][rows] */
static PetscErrorCode SparseFind(Factor f, PetscInt columns, const PetscScalar *b, SparseColumns *sparse)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < columns * f->rows; i++) n += b[i] != 0;
  PetscCall(SparseCreate(columns, n, sparse));
  n = 0;
  for (PetscInt j = 0; j < columns; j++) {
    for (PetscInt i = 0; i < f->rows; i++) {
      if (b[j * f->rows + i] == 0) continue;
      sparse->row[n]     = (MUMPS_INT)(f->first[f->rank] + i + 1);
      sparse->value[n++] = b[j * f->rows + i];
    }
    sparse->ptr[j + 1] = (MUMPS_INT)(n + 1);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Column by column, of each the ranks' one after the other; all: on the first rank */
static PetscErrorCode SparseGather(Factor f, const SparseColumns *mine, SparseColumns *all)
{
  const PetscMPIInt width = (PetscMPIInt)mine->columns + 1, count = (PetscMPIInt)(mine->ptr[mine->columns] - 1);
  PetscMPIInt      *counts, *first;
  MUMPS_INT        *ptr, *row;
  PetscScalar      *value;
  PetscInt          n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(f->size, &counts, f->size + 1, &first, f->size * width, &ptr));
  PetscCallMPI(MPI_Gather(&count, 1, MPI_INT, counts, 1, MPI_INT, 0, f->comm));
  for (PetscMPIInt r = 0; r < f->size; r++) first[r + 1] = first[r] + counts[r];
  PetscCall(PetscMalloc2(first[f->size], &row, first[f->size], &value));
  PetscCallMPI(MPI_Gather(mine->ptr, width, MPI_MUMPSINT, ptr, width, MPI_MUMPSINT, 0, f->comm));
  PetscCallMPI(MPI_Gatherv(mine->row, count, MPI_MUMPSINT, row, counts, first, MPI_MUMPSINT, 0, f->comm));
  PetscCallMPI(MPI_Gatherv(mine->value, count, MPIU_SCALAR, value, counts, first, MPIU_SCALAR, 0, f->comm));
  PetscCall(SparseCreate(mine->columns, first[f->size], all));
  for (PetscInt j = 0; j < mine->columns; j++) {
    for (PetscMPIInt r = 0; r < f->size; r++)
      for (MUMPS_INT k = ptr[r * width + j]; k < ptr[r * width + j + 1]; k++, n++) {
        all->row[n]   = row[first[r] + k - 1];
        all->value[n] = value[first[r] + k - 1];
      }
    all->ptr[j + 1] = (MUMPS_INT)(n + 1);
  }
  PetscCall(PetscFree2(row, value));
  PetscCall(PetscFree3(counts, first, ptr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* MUMPS is told of right-hand sides on the first rank, and refuses any that others have. */
static void ShowColumns(Factor f, SparseColumns *all)
{
  f->mumps.ICNTL(20) = 1; /* sparse */
  if (f->rank) return;
  f->mumps.nz_rhs      = all->ptr[all->columns] - 1;
  f->mumps.irhs_ptr    = all->ptr;
  f->mumps.irhs_sparse = all->row;
  f->mumps.rhs_sparse  = all->value;
}

/* x = A^-1 b, `columns` of this rank's rows each */
static PetscErrorCode SolveSparse(Factor f, PetscInt columns, const PetscScalar *b, PetscScalar *x)
{
  SparseColumns mine, all;
  PetscMPIInt   entries;

  PetscFunctionBeginUser;
  PetscCall(SparseFind(f, columns, b, &mine));
  PetscCall(SparseGather(f, &mine, &all));
  entries = (PetscMPIInt)(all.ptr[columns] - 1);
  PetscCallMPI(MPI_Bcast(&entries, 1, MPI_INT, 0, f->comm));
  PetscCall(PetscArrayzero(x, columns * f->rows));
  if (entries) {
    PetscCall(MakeRoom(f, columns));
    ShowColumns(f, &all);
    PetscCall(FactorSolveOnce(f, columns));
    for (PetscInt j = 0; j < columns; j++)
      PetscCallMPI(MPI_Scatterv(f->rank ? NULL : &f->right[(size_t)j * f->mumps.n], f->count, f->first, MPIU_SCALAR,
                                &x[j * f->rows], f->count[f->rank], MPIU_SCALAR, 0, f->comm));
    PetscCall(PetscFree(f->right));
  }
  PetscCall(SparseFree(&all));
  PetscCall(SparseFree(&mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  FactorSolveColumns - X = A^-1 B for dense B and X

  Collective

  Notes:
  The last matrix must have been factored: an error otherwise. Columns of B and X stand next to each other (their
  leading dimension is that of the rows).

  MUMPS is given the entries of B that differ from zero, and eliminates only what they reach (its ICNTL(20)): for forces
  on contact nodes, half of the time.
*/
PetscErrorCode FactorSolveColumns(Factor f, Mat B, Mat X)
{
  PetscInt           columns;
  const PetscScalar *b;
  PetscScalar       *x;

  PetscFunctionBeginUser;
  PetscCheck(f->exists, f->comm, PETSC_ERR_ARG_WRONGSTATE, "there is no factor");
  PetscCall(MatGetSize(B, NULL, &columns));
  PetscCall(MatDenseGetArrayRead(B, &b));
  PetscCall(MatDenseGetArrayWrite(X, &x));
  for (PetscInt j = 0; j < columns; j += FACTOR_COLUMNS)
    PetscCall(SolveSparse(f, PetscMin(FACTOR_COLUMNS, columns - j), &b[j * f->rows], &x[j * f->rows]));
  PetscCall(MatDenseRestoreArrayWrite(X, &x));
  PetscCall(MatDenseRestoreArrayRead(B, &b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
