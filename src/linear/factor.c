/* Analysis and factorisation by MUMPS. Each rank gives MUMPS the entries that it has. */
#include "factorimpl.h"
#include "mumpsoptions.h"
#include "ordering.h"

/* Values of ICNTL(7): an ordering that MUMPS is given, and MUMPS's own choice. */
enum { MUMPS_GIVEN = 1, MUMPS_OWN = 7 };
/* Number of unknowns from which on rows are ordered by dissection. Below it a factorisation is not what a run spends
   its time with. */
enum { FACTOR_DISSECTED = 4000 };
/* Workspace above MUMPS's estimate (per cent). MUMPS's own 20 is too little for symmetric systems of a few thousand
   unknowns on four ranks. */
enum { FACTOR_WORKSPACE = 100 };
/* Number of times that the workspace may be doubled. Delayed pivots of regular systems have never needed more. */
enum { FACTOR_MORE = 2 };
/* Scaling (ICNTL(8)): by the diagonal. MUMPS's own choice iterates over rows and columns, which costs a seventh of a
   symmetric factorisation at 10,000 unknowns, and a fifth or more of an unsymmetric one. Stiff penalties are on the
   diagonal. */
enum { FACTOR_SCALING = 1 };
/* Memory that is reserved for the entries of a pattern, in parts of what the pattern needs. The next pattern often has
   few more entries, and new memory costs more than writing the entries does. */
#define FACTOR_ROOM 1.25

/*@
  FactorCheckOptions - checks MUMPS's parameters among PETSc's options.

  Not collective

  Note:
  The values must be numbers in the ranges that MUMPS documents (private/mumpsoptions.h). An error of PETSc's otherwise,
  whose message names the option.
@*/
PetscErrorCode FactorCheckOptions(void)
{
  MUMPS_INT   icntl[MUMPS_ICNTL];
  DMUMPS_REAL cntl[MUMPS_CNTL];

  PetscFunctionBeginUser;
  PetscCall(MumpsOptionsRead(icntl, cntl));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FactorBegin(Factor f)
{
  DMUMPS_STRUC_C *mumps = &f->mumps;

  PetscFunctionBeginUser;
  mumps->comm_fortran = (MUMPS_INT)MPI_Comm_c2f(f->comm);
  mumps->par          = 1;                    /* the first rank works too */
  mumps->sym          = f->symmetric ? 2 : 0; /* 2: need not be positive definite */
  PetscCall(FactorCall(f, MUMPS_BEGIN));
  PetscCheck(mumps->INFOG(1) >= 0, f->comm, PETSC_ERR_LIB, "MUMPS does not start: INFOG(1) = %d, INFOG(2) = %d",
             (int)mumps->INFOG(1), (int)mumps->INFOG(2));
  for (int i = 1; i <= 4; i++) mumps->ICNTL(i) = 0; /* MUMPS prints nothing */
  mumps->ICNTL(6)  = 0;                             /* large entries are on the diagonal already */
  mumps->ICNTL(8)  = FACTOR_SCALING;
  mumps->ICNTL(14) = FACTOR_WORKSPACE;
  PetscCall(MumpsOptionsRead(mumps->icntl, mumps->cntl));
  f->workspace     = mumps->ICNTL(14);
  mumps->ICNTL(33) = !f->symmetric;       /* the determinant; symmetric factors count negative pivots */
  mumps->ICNTL(18) = f->size > 1 ? 3 : 0; /* 3: each rank gives the entries that it has */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FactorCreate - creates a solver by factorisation, without a matrix.

  Collective

  Input Parameters:
+ comm      - ranks that share the factor
- symmetric - all matrices will be symmetric; MUMPS then factors L D L^T, which need not be positive definite

  Output Parameter:
. out - the new object; destroy it with FactorDestroy()

  Options Database Keys:
+ -mat_mumps_icntl_<number> <integer> - one of MUMPS's integer parameters, as of PETSc's interface
- -mat_mumps_cntl_<number> <real>     - one of MUMPS's real parameters
@*/
PetscErrorCode FactorCreate(MPI_Comm comm, PetscBool symmetric, Factor *out)
{
  Factor f;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  PetscCall(PetscCommDuplicate(comm, &f->comm, NULL));
  PetscCallMPI(MPI_Comm_rank(f->comm, &f->rank));
  PetscCallMPI(MPI_Comm_size(f->comm, &f->size));
  f->symmetric = symmetric;
  PetscCall(FactorBegin(f));
  PetscCall(FactorSetOrdering(f, FACTOR_AUTOMATIC, NULL));
  *out = f;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FactorDestroy - frees the factor and ends its instance of MUMPS.

  Collective

  Input Parameter:
. factor - may be NULL inside
@*/
PetscErrorCode FactorDestroy(Factor *factor)
{
  Factor f = *factor;

  PetscFunctionBeginUser;
  if (!f) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FactorCall(f, MUMPS_END));
  PetscCall(PetscFree2(f->from[MATRIX_OWN], f->from[MATRIX_OTHERS]));
  PetscCall(PetscFree3(f->row, f->column, f->value));
  PetscCall(PetscFree(f->position));
  PetscCall(PetscFree(f->mine));
  PetscCall(FactorSolutionFree(&f->solution));
  PetscCall(BorderedFactorDestroy(&f->bordering));
  PetscCall(PetscCommDestroy(&f->comm));
  PetscCall(PetscFree(*factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FactorSetOrdering - sets the ordering for the analyses to come.

  Logically collective

  Input Parameters:
+ f        - the factor
- ordering - FACTOR_AUTOMATIC, FACTOR_METIS or another value of MUMPS's ICNTL(7)

  Output Parameter:
. chosen - the ordering is the one that was given here; PETSC_FALSE where the option -mat_mumps_icntl_7 has set another
           one, which stays. May be NULL.
@*/
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

/*@
  FactorSetBorder - sets the border of the matrices to come.

  Collective

  Input Parameters:
+ f      - the factor, after FactorPrepareBorder()
- border - vectors V; borrowed until the next call. NULL: no border

  Note:
  What is factored and solved with from the next FactorMake() on is K + V V^T, where K has the pattern that
  FactorPrepareBorder() was given. The present factor stays as it is.
@*/
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

/*@
  FactorHasBorder - tells whether the next factor has a border.

  Not collective, the same on all ranks

  Input Parameter:
. f - the factor
@*/
PetscBool FactorHasBorder(Factor f)
{
  return f->bordered;
}

/* The first entry of local row r, of number start + r, that is not below the diagonal. Columns ascend, so bisection
   finds it. */
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

/* Finds and counts the entries of this rank that MUMPS is given: of a symmetric matrix none below the diagonal. */
static PetscErrorCode FindEntries(Factor f, Mat A)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(f->from[MATRIX_OWN], f->from[MATRIX_OTHERS]));
  PetscCall(PetscMalloc2(f->rows, &f->from[MATRIX_OWN], f->rows, &f->from[MATRIX_OTHERS]));
  f->own = 0;
  for (int block = 0; block < MATRIX_BLOCKS; block++) {
    MatrixRows rows;

    PetscCall(MatrixRowsGet(A, block, &rows));
    for (PetscInt r = 0; rows.mat && r < rows.n; r++) {
      f->from[block][r] = f->symmetric ? FirstEntry(&rows, f->start, r) : rows.ptr[r];
      f->own += rows.ptr[r + 1] - f->from[block][r];
    }
    PetscCall(MatrixRowsRestore(&rows));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes rows and columns of the matrix's entries, from 1. */
static PetscErrorCode TakePlaces(Factor f, Mat A)
{
  MUMPS_INT *row = f->row, *column = f->column;

  PetscFunctionBeginUser;
  for (int block = 0; block < MATRIX_BLOCKS; block++) {
    MatrixRows rows;

    PetscCall(MatrixRowsGet(A, block, &rows));
    for (PetscInt r = 0; rows.mat && r < rows.n; r++) {
      const PetscInt from = f->from[block][r], n = rows.ptr[r + 1] - from;

      for (PetscInt k = 0; k < n; k++) row[k] = (MUMPS_INT)(f->start + r + 1);
      for (PetscInt k = 0; k < n; k++) column[k] = (MUMPS_INT)(MatrixRowsColumn(&rows, f->start, from + k) + 1);
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

/* Reserves memory for the entries. *kept: the arrays have not moved, so their contents are still there. */
static PetscErrorCode FactorReserve(Factor f, PetscBool *kept)
{
  PetscFunctionBeginUser;
  *kept = (PetscBool)(f->row && f->entries <= f->room);
  if (*kept) PetscFunctionReturn(PETSC_SUCCESS);
  f->room = (PetscInt)PetscMin(FACTOR_ROOM * (PetscReal)f->entries, (PetscReal)PETSC_MAX_INT);
  PetscCall(PetscFree3(f->row, f->column, f->value));
  PetscCall(PetscMalloc3(f->room, &f->row, f->room, &f->column, f->room, &f->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes rows and columns of the border's entries, from 1, behind those of the matrix. */
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

/* Finds whether the arrays hold the rows and columns of this matrix with its present pattern. */
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

/* Writes rows and columns of all entries. Those of the matrix are kept if the matrix and its pattern are the same. */
static PetscErrorCode PlaceEntries(Factor f, Mat A)
{
  PetscBool again, kept;

  PetscFunctionBeginUser;
  PetscCall(IsPlaced(f, A, &again));
  if (!again) PetscCall(FindEntries(f, A));
  f->entries = f->own + (f->bordered ? BorderedFactorCountEntries(f->bordering) : 0);
  PetscCall(FactorReserve(f, &kept));
  if (!again || !kept) PetscCall(TakePlaces(f, A));
  if (f->bordered) PetscCall(PlaceBorder(f));
  PetscCall(PetscObjectGetId((PetscObject)A, &f->matrix));
  PetscCall(MatGetNonzeroState(A, &f->pattern));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives MUMPS this rank's entries. */
static PetscErrorCode SetEntries(Factor f, Mat A)
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

/* Gives MUMPS the number of rows of all ranks, border included, and lists the rows of this one. All numbers of rows and
   columns that MUMPS is given are at most the number that is checked here. */
static PetscErrorCode SetSize(Factor f, Mat A)
{
  PetscFunctionBeginUser;
  PetscCall(MatGetSize(A, &f->n, NULL));
  PetscCall(MatGetLocalSize(A, &f->rows, NULL));
  PetscCall(MatGetOwnershipRange(A, &f->start, NULL));
  PetscCall(FactorIntCast((int64_t)f->n + (f->bordered ? BorderedFactorCount(f->bordering) : 0), &f->mumps.n));
  PetscCall(PetscFree(f->mine));
  PetscCall(PetscMalloc1(f->rows, &f->mine));
  for (PetscInt i = 0; i < f->rows; i++) f->mine[i] = (MUMPS_INT)(f->start + i + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetOrdering(Factor f, Mat A)
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

/* Why a job failed, in the terms of PETSc's interface to MUMPS. Source: MUMPS 5.5 Users' guide, section 8. */
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

static PetscErrorCode FactorGetReason(Factor f, const char *job, PCFailedReason *reason)
{
  PetscFunctionBeginUser;
  *reason = Reason(f);
  if (*reason)
    PetscCall(PetscInfo(NULL, "MUMPS's %s failed: INFOG(1) = %d, INFOG(2) = %d\n", job, (int)f->mumps.INFOG(1),
                        (int)f->mumps.INFOG(2)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FactorAnalyse - orders a matrix and counts what its factor will take.

  Collective

  Input Parameters:
+ f - the factor
- A - AIJ matrix of symmetric pattern

  Output Parameter:
. reason - why there can be no factor; PC_NOERROR also for a matrix without rows

  Note:
  The present factor is lost.
@*/
PetscErrorCode FactorAnalyse(Factor f, Mat A, PCFailedReason *reason)
{
  PetscFunctionBeginUser;
  f->exists          = PETSC_FALSE;
  f->analysed        = PETSC_FALSE;
  f->mumps.ICNTL(14) = f->workspace;
  *reason            = PC_NOERROR;
  PetscCall(SetSize(f, A));
  if (!f->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SetEntries(f, A));
  PetscCall(SetOrdering(f, A));
  PetscCall(FactorCall(f, MUMPS_ANALYSE));
  PetscCall(FactorGetReason(f, "analysis", reason));
  if (*reason) PetscFunctionReturn(PETSC_SUCCESS);
  f->changed  = PETSC_FALSE;
  f->analysed = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds whether the matrix has another pattern, ordering or border than the one that was analysed last; the same on all
   ranks. */
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

/*@
  FactorPrepareBorder - orders a symmetric matrix K such that borders can join it.

  Collective

  Input Parameters:
+ f - the factor, for symmetric matrices, without a border
- K - matrix whose pattern the bordered matrices will have

  Output Parameter:
. reason - why K cannot be ordered; there can be no borders then

  Note:
  K is ordered by minimum fill, or by minimum degree if that was set. An analysis of K that was made before is used.
@*/
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

/* Finds whether the workspace or the message buffers were too short. ICNTL(14) makes both longer. */
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

/* Factors. Where the workspace was too short it is doubled, FACTOR_MORE times at most. */
static PetscErrorCode CallFactor(Factor f)
{
  PetscFunctionBeginUser;
  PetscCall(FactorCall(f, MUMPS_FACTOR));
  for (int more = 0; more < FACTOR_MORE && IsShort(f); more++) {
    f->mumps.ICNTL(14) = PetscMax(2 * f->mumps.ICNTL(14), FACTOR_WORKSPACE);
    PetscCall(FactorCall(f, MUMPS_FACTOR));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the sign of the determinant, which MUMPS gives to the first rank. */
static PetscErrorCode FactorFindOdd(Factor f)
{
  PetscFunctionBeginUser;
  f->odd = (PetscBool)(f->mumps.RINFOG(12) < 0);
  PetscCallMPI(MPI_Bcast(&f->odd, sizeof(f->odd), MPI_BYTE, 0, f->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FactorMake - factors a matrix.

  Collective

  Input Parameters:
+ f - the factor
- A - AIJ matrix of symmetric pattern; its values are copied

  Output Parameter:
. reason - why there is no factor; PC_NOERROR also for a matrix without rows

  Note:
  The matrix is analysed before if its pattern is not that of the last analysis. MUMPS gets more workspace where it
  finds its own too short.
@*/
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
  PetscCall(FactorSolutionForget(&f->solution));
  PetscCall(CallFactor(f));
  PetscCall(FactorGetReason(f, "factorisation", reason));
  f->exists = *reason ? PETSC_FALSE : PETSC_TRUE;
  if (f->exists && !f->symmetric) PetscCall(FactorFindOdd(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FactorIsSymmetric - tells whether the factor is L D L^T of symmetric matrices.

  Not collective

  Input Parameter:
. f - the factor
@*/
PetscBool FactorIsSymmetric(Factor f)
{
  return f->symmetric;
}

/*@
  FactorExists - tells whether there is a factor, of the last matrix or of an earlier one.

  Not collective

  Input Parameter:
. f - the factor
@*/
PetscBool FactorExists(Factor f)
{
  return f->exists;
}

/*@
  FactorNegatives - returns the number of negative eigenvalues of the matrix that was factored, with what its border
  stands for.

  Not collective, the same on all ranks

  Input Parameter:
. f - the factor

  Note:
  Returns -1 where there is no factor, or none of a symmetric matrix.

  Source: Sylvester's law of inertia. Each vector of a border adds one negative eigenvalue of its own.
@*/
PetscInt FactorNegatives(Factor f)
{
  if (!f->exists || !f->symmetric) return -1;
  return PetscMax(0, f->mumps.INFOG(12) - (FactorHasBorder(f) ? BorderedFactorCount(f->bordering) : 0));
}

/*@
  FactorParity - tells whether the matrix that was factored has an odd number of negative eigenvalues.

  Not collective, the same on all ranks

  Input Parameter:
. f - the factor

  Notes:
  Returns 1 where the number is odd, 0 where it is even, -1 where there is no factor.

  The sign of the determinant says so, of matrices that are not symmetric, too: complex eigenvalues come in pairs.
@*/
PetscInt FactorParity(Factor f)
{
  if (!f->exists) return -1;
  return f->symmetric ? FactorNegatives(f) % 2 : (PetscInt)f->odd;
}

/*@
  FactorGetCost - gets what the factor takes, by the last analysis.

  Not collective, the same on all ranks

  Input Parameter:
. f - the factor

  Output Parameter:
. cost - operations (RINFOG(1)), entries (INFOG(20), negative: in millions) and memory (MB, INFOG(16) and INFOG(17))
@*/
void FactorGetCost(Factor f, FactorCost *cost)
{
  const DMUMPS_STRUC_C *mumps   = &f->mumps;
  const PetscReal       entries = mumps->INFOG(20);

  *cost = (FactorCost){.operations = mumps->RINFOG(1),
                       .entries    = entries < 0 ? -1e6 * entries : entries,
                       .memory_mb  = {mumps->INFOG(16), mumps->INFOG(17)}};
}
