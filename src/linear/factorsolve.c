/* Solves with a factor by MUMPS. Dense right-hand sides go to MUMPS from the ranks that have their rows, and solutions
   come back from the ranks that have eliminated them; no rank holds a whole vector. Right-hand sides with few entries
   are gathered on the first rank, as MUMPS takes them only there. */
#include "factorimpl.h"

/* ICNTL(20): how MUMPS is given right-hand sides. */
enum { RIGHT_SPARSE = 1, RIGHT_DISTRIBUTED = 10 };
/* ICNTL(9): any number but 1 */
enum { SOLVE_TRANSPOSED = 2 };
/* ICNTL(21): solutions stay on the ranks that have eliminated their unknowns. */
enum { SOLUTION_DISTRIBUTED = 1 };
/* Columns that are solved for at a time. They are enough for products of matrices, and few enough for the memory of the
   first rank, which gathers the right-hand sides' entries. */
enum { FACTOR_COLUMNS = 128 };

#define MPI_MUMPSINT (sizeof(MUMPS_INT) == sizeof(int64_t) ? MPI_INT64_T : MPI_INT32_T)

/*@
  FactorSolutionForget - forgets on which ranks the last factor's unknowns are.

  Collective

  Input Parameter:
. solution - of a factor; the memory stays for the next one

  Note:
  Call it before each factorisation: pivots that are delayed move to other ranks.
@*/
PetscErrorCode FactorSolutionForget(FactorSolution *solution)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSFDestroy(&solution->to_rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FactorSolutionFree - frees everything of the solution.

  Collective

  Input Parameter:
. solution - of a factor
@*/
PetscErrorCode FactorSolutionFree(FactorSolution *solution)
{
  PetscFunctionBeginUser;
  PetscCall(FactorSolutionForget(solution));
  PetscCall(PetscFree(solution->row));
  PetscCall(PetscFree(solution->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives MUMPS memory for solutions of so many columns. INFO(23) is the number of this rank's unknowns. MUMPS wants
   arrays where there are none, too. */
static PetscErrorCode FactorReserveSolution(Factor f, PetscInt columns)
{
  FactorSolution *s      = &f->solution;
  const size_t    rows   = (size_t)f->mumps.INFO(23);
  const size_t    values = rows * (size_t)columns;

  PetscFunctionBeginUser;
  if (!s->row || rows > s->room_row) {
    PetscCall(PetscFree(s->row));
    PetscCall(PetscMalloc1(rows + 1, &s->row));
    s->room_row = rows;
  }
  if (!s->value || values > s->room_value) {
    PetscCall(PetscFree(s->value));
    PetscCall(PetscMalloc1(values + 1, &s->value));
    s->room_value = values;
  }
  f->mumps.lsol_loc = f->mumps.INFO(23);
  f->mumps.isol_loc = s->row;
  f->mumps.sol_loc  = s->value;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds how solutions come from the ranks that have eliminated their unknowns to those that have the rows. Unknowns of
   the border, which follow the matrix's, stay where they are. */
static PetscErrorCode FindPivots(Factor f)
{
  FactorSolution *s     = &f->solution;
  const PetscInt  n     = (PetscInt)f->mumps.lsol_loc;
  PetscInt        found = 0, *place, *row;
  PetscLayout     rows;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &place, n, &row));
  for (PetscInt k = 0; k < n; k++) {
    if (s->row[k] > f->n) continue;
    place[found] = k;
    row[found++] = (PetscInt)(s->row[k] - 1);
  }
  PetscCall(PetscLayoutCreateFromSizes(f->comm, f->rows, f->n, 1, &rows));
  PetscCall(PetscSFCreate(f->comm, &s->to_rows));
  PetscCall(PetscSFSetGraphLayout(s->to_rows, rows, found, place, PETSC_COPY_VALUES, row));
  PetscCall(PetscLayoutDestroy(&rows));
  PetscCall(PetscFree2(place, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves for the right-hand sides that MUMPS was given, `columns` of them, and writes x[columns][rows]. */
static PetscErrorCode FactorSolveOnce(Factor f, PetscInt columns, PetscScalar *x)
{
  DMUMPS_STRUC_C *mumps = &f->mumps;

  PetscFunctionBeginUser;
  PetscCall(FactorReserveSolution(f, columns));
  PetscCall(FactorIntCast(columns, &mumps->nrhs));
  mumps->ICNTL(21) = SOLUTION_DISTRIBUTED;
  PetscCall(FactorCall(f, MUMPS_SOLVE));
  PetscCheck(mumps->INFOG(1) >= 0, f->comm, PETSC_ERR_LIB, "MUMPS does not solve: INFOG(1) = %d, INFOG(2) = %d",
             (int)mumps->INFOG(1), (int)mumps->INFOG(2));
  if (!f->solution.to_rows) PetscCall(FindPivots(f));
  for (PetscInt j = 0; j < columns; j++) {
    const PetscScalar *from = &f->solution.value[(size_t)j * (size_t)mumps->lsol_loc];
    PetscScalar       *to   = &x[(size_t)j * (size_t)f->rows];

    PetscCall(PetscSFReduceBegin(f->solution.to_rows, MPIU_SCALAR, from, to, MPI_REPLACE));
    PetscCall(PetscSFReduceEnd(f->solution.to_rows, MPIU_SCALAR, from, to, MPI_REPLACE));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FactorSolve - solves A x = b.

  Collective

  Input Parameters:
+ f - holds the factor of A
- b - right-hand side, distributed as the rows of A

  Output Parameter:
. x - solution; infinite where there is no factor

  Notes:
  MUMPS reads each rank's part of b where it is (ICNTL(20) = 10) and leaves b as it was. Rows that no rank gives, those
  of a border, have a right-hand side of zero.

  MUMPS refines no solutions that stay distributed, so ICNTL(10) is refused. linearcheck.h refines solutions.
@*/
PetscErrorCode FactorSolve(Factor f, Vec b, Vec x)
{
  DMUMPS_STRUC_C    *mumps = &f->mumps;
  const PetscScalar *from;
  PetscScalar       *to;

  PetscFunctionBeginUser;
  if (!f->n) PetscFunctionReturn(PETSC_SUCCESS);
  if (!f->exists) PetscCall(VecSet(x, INFINITY));
  if (!f->exists) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(b, &from));
  PetscCall(VecGetArrayWrite(x, &to));
  mumps->ICNTL(20) = RIGHT_DISTRIBUTED;
  PetscCall(FactorIntCast(f->rows, &mumps->nloc_rhs));
  mumps->lrhs_loc = mumps->nloc_rhs;
  mumps->irhs_loc = f->mine;
  mumps->rhs_loc  = (PetscScalar *)from;
  PetscCall(FactorSolveOnce(f, 1, to));
  mumps->rhs_loc = NULL;
  PetscCall(VecRestoreArrayWrite(x, &to));
  PetscCall(VecRestoreArrayRead(b, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FactorSolveTransposed - solves A^T x = b.

  Collective

  Input Parameters:
+ f - holds the factor of A
- b - right-hand side, distributed as the rows of A

  Output Parameter:
. x - solution; infinite where there is no factor
@*/
PetscErrorCode FactorSolveTransposed(Factor f, Vec b, Vec x)
{
  const MUMPS_INT plain = f->mumps.ICNTL(9);

  PetscFunctionBeginUser;
  PetscCall(FactorSolutionForget(&f->solution)); /* pivots off the diagonal: it lies as the rows do, not the columns */
  f->mumps.ICNTL(9) = SOLVE_TRANSPOSED;
  PetscCall(FactorSolve(f, b, x));
  f->mumps.ICNTL(9) = plain;
  PetscCall(FactorSolutionForget(&f->solution));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Entries of right-hand sides that differ from zero: of this rank, or of all ranks on the first one */
typedef struct {
  PetscInt     columns;
  MUMPS_INT   *ptr, *row; /* from 1 */
  PetscScalar *value;
} SparseColumns;

static PetscErrorCode SparseCreate(PetscInt columns, int64_t entries, SparseColumns *sparse)
{
  MUMPS_INT end;

  PetscFunctionBeginUser;
  PetscCall(FactorIntCast(entries + 1, &end)); /* the last of ptr */
  sparse->columns = columns;
  PetscCall(PetscCalloc3(columns + 1, &sparse->ptr, (size_t)entries, &sparse->row, (size_t)entries, &sparse->value));
  sparse->ptr[0] = 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SparseFree(SparseColumns *sparse)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(sparse->ptr, sparse->row, sparse->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the entries of this rank's rows b[columns][rows]. */
static PetscErrorCode SparseFind(Factor f, PetscInt columns, const PetscScalar *b, SparseColumns *sparse)
{
  const size_t rows = (size_t)f->rows;
  int64_t      n    = 0;

  PetscFunctionBeginUser;
  for (size_t i = 0; i < (size_t)columns * rows; i++) n += b[i] != 0;
  PetscCall(SparseCreate(columns, n, sparse));
  n = 0;
  for (PetscInt j = 0; j < columns; j++) {
    for (size_t i = 0; i < rows; i++) {
      if (b[(size_t)j * rows + i] == 0) continue;
      sparse->row[n]     = f->mine[i];
      sparse->value[n++] = b[(size_t)j * rows + i];
    }
    sparse->ptr[j + 1] = (MUMPS_INT)(n + 1);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where each rank's entries begin on the first rank; an error where MPI cannot count them */
static PetscErrorCode SparseOffsets(Factor f, const PetscMPIInt *counts, PetscMPIInt *first)
{
  PetscFunctionBeginUser;
  first[0] = 0;
  for (PetscMPIInt r = 0; r < f->size; r++) {
    const int64_t next = (int64_t)first[r] + counts[r];

    PetscCheck(next <= PETSC_MPI_INT_MAX, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "%" PRId64 " entries of right-hand sides are more than MPI can count", next);
    first[r + 1] = (PetscMPIInt)next;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gathers the entries on the first rank, column by column; within a column one rank's follow the other's. */
static PetscErrorCode SparseGather(Factor f, const SparseColumns *mine, SparseColumns *all)
{
  const PetscMPIInt width = (PetscMPIInt)mine->columns + 1;
  PetscMPIInt       count, *counts, *first;
  MUMPS_INT        *ptr, *row;
  PetscScalar      *value;
  PetscInt          n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast((PetscInt)(mine->ptr[mine->columns] - 1), &count));
  PetscCall(PetscCalloc3(f->size, &counts, f->size + 1, &first, f->size * width, &ptr));
  PetscCallMPI(MPI_Gather(&count, 1, MPI_INT, counts, 1, MPI_INT, 0, f->comm));
  PetscCall(SparseOffsets(f, counts, first));
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

/* Gives MUMPS the entries on the first rank. It refuses any that other ranks have. */
static void SetSparseColumns(Factor f, SparseColumns *all)
{
  f->mumps.ICNTL(20) = RIGHT_SPARSE;
  if (f->rank) return;
  f->mumps.nz_rhs      = all->ptr[all->columns] - 1;
  f->mumps.irhs_ptr    = all->ptr;
  f->mumps.irhs_sparse = all->row;
  f->mumps.rhs_sparse  = all->value;
}

/* x = A^-1 b, b[columns][rows] and x[columns][rows] of this rank */
static PetscErrorCode SolveSparse(Factor f, PetscInt columns, const PetscScalar *b, PetscScalar *x)
{
  SparseColumns mine, all;
  MUMPS_INT     entries;

  PetscFunctionBeginUser;
  PetscCall(SparseFind(f, columns, b, &mine));
  PetscCall(SparseGather(f, &mine, &all));
  entries = all.ptr[columns] - 1;
  PetscCallMPI(MPI_Bcast(&entries, 1, MPI_MUMPSINT, 0, f->comm));
  PetscCall(PetscArrayzero(x, (size_t)columns * (size_t)f->rows));
  if (entries) {
    SetSparseColumns(f, &all);
    PetscCall(FactorSolveOnce(f, columns, x));
  }
  PetscCall(SparseFree(&all));
  PetscCall(SparseFree(&mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FactorSolveColumns - solves A X = B for dense B and X.

  Collective

  Input Parameters:
+ f - holds the factor of A; an error where there is none
- B - right-hand sides

  Output Parameter:
. X - solutions

  Notes:
  Columns of B and X stand next to each other: their leading dimension is the number of this rank's rows.

  MUMPS is given the entries of B that differ from zero, and eliminates only what they reach (ICNTL(20) = 1). For forces
  on contact nodes this takes half of the time. MUMPS takes such right-hand sides on the first rank only; solutions stay
  distributed.
@*/
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
    PetscCall(SolveSparse(f, PetscMin(FACTOR_COLUMNS, columns - j), &b[(size_t)j * (size_t)f->rows],
                          &x[(size_t)j * (size_t)f->rows]));
  PetscCall(MatDenseRestoreArrayWrite(X, &x));
  PetscCall(MatDenseRestoreArrayRead(B, &b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
