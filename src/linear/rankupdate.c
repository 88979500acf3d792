/* Updates of an inverse by the formula of Sherman, Morrison and Woodbury. */
#include "rankupdate.h"
#include "linear/directsolver.h"

struct _n_RankUpdate {
  MPI_Comm     comm;
  PetscInt     m, n;      /* rows of this rank, columns of N */
  PetscReal   *s;         /* s[n] */
  PetscInt    *ptr, *row; /* columns of N by their entries, as few differ from zero; row: local */
  PetscScalar *value, *Z; /* values of these entries; Z = A^-1 N, n columns of m rows */
  PetscBool    regular;
  Mat          core; /* diag(1/s) + N^T Z, factored; all of it on each rank */
  Vec          y, share;
};

/* Takes the columns of a dense N. */
static PetscErrorCode TakeColumns(RankUpdate update, Mat N, const PetscReal *s)
{
  const PetscInt     m = update->m, n = update->n;
  PetscInt           more, entries = n ? update->ptr[n] : 0, room = entries;
  const PetscScalar *from;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(N, NULL, &more));
  PetscCall(PetscRealloc((n + more) * sizeof(PetscReal), &update->s));
  PetscCall(PetscRealloc((n + more + 1) * sizeof(PetscInt), &update->ptr));
  PetscCall(PetscArraycpy(&update->s[n], s, more));
  PetscCall(MatDenseGetArrayRead(N, &from));
  for (PetscInt i = 0; i < more * m; i++) room += from[i] != 0;
  PetscCall(PetscRealloc((room + 1) * sizeof(PetscInt), &update->row)); /* a rank may have no entry */
  PetscCall(PetscRealloc((room + 1) * sizeof(PetscScalar), &update->value));
  for (PetscInt k = 0; k < more; k++) {
    update->ptr[n + k] = entries;
    for (PetscInt i = 0; i < m; i++) {
      if (from[k * m + i] == 0) continue;
      update->row[entries]     = i;
      update->value[entries++] = from[k * m + i];
    }
  }
  update->ptr[n + more] = entries;
  PetscCall(MatDenseRestoreArrayRead(N, &from));
  update->n = n + more;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the last columns of Z. One solve for all of them takes a fifth of the time of one solve for each. */
static PetscErrorCode SolveColumns(RankUpdate update, PC factored, Mat N)
{
  Mat                Z;
  PetscInt           more;
  const PetscScalar *from;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(N, NULL, &more));
  PetscCall(MatDuplicate(N, MAT_DO_NOT_COPY_VALUES, &Z));
  PetscCall(DirectSolverColumns(factored, N, Z));
  PetscCall(PetscRealloc((update->n * update->m + 1) * sizeof(PetscScalar), &update->Z));
  PetscCall(MatDenseGetArrayRead(Z, &from));
  PetscCall(PetscArraycpy(&update->Z[(update->n - more) * update->m], from, more * update->m));
  PetscCall(MatDenseRestoreArrayRead(Z, &from));
  PetscCall(MatDestroy(&Z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* to[n] = N^T from, with this rank's rows only */
static void ProjectOnUpdates(RankUpdate update, const PetscScalar *from, PetscScalar *to)
{
  for (PetscInt j = 0; j < update->n; j++) {
    to[j] = 0;
    for (PetscInt e = update->ptr[j]; e < update->ptr[j + 1]; e++) to[j] += update->value[e] * from[update->row[e]];
  }
}

static PetscErrorCode FactorCore(RankUpdate update)
{
  const PetscInt n = update->n;
  PetscScalar   *core;
  PetscErrorCode code;

  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&update->core));
  PetscCall(VecDestroy(&update->y));
  PetscCall(VecDestroy(&update->share));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, n, n, NULL, &update->core));
  PetscCall(MatCreateVecs(update->core, &update->share, &update->y));
  PetscCall(MatDenseGetArray(update->core, &core));
  for (PetscInt k = 0; k < n; k++) ProjectOnUpdates(update, &update->Z[k * update->m], &core[k * n]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, core, (PetscMPIInt)(n * n), MPIU_SCALAR, MPIU_SUM, update->comm));
  for (PetscInt k = 0; k < n; k++) core[k * (n + 1)] += 1 / update->s[k];
  PetscCall(MatDenseRestoreArray(update->core, &core));
  PetscCall(
    PetscPushErrorHandler(PetscReturnErrorHandler, NULL)); /* PETSc takes a pivot of exactly zero for an error */
  code = MatLUFactor(update->core, NULL, NULL, NULL);
  PetscCall(PetscPopErrorHandler());
  update->regular = code ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RankUpdateAdd - adds columns to an update, or makes the first update.

  Collective

  Input Parameters:
+ factored - preconditioner with the factor of A, as of DirectSolverColumns()
. N        - new columns, dense
- s        - s[columns of N]: their factors, the same on all ranks

  Input and Output Parameter:
. update - NULL inside: it is created; destroy it with RankUpdateDestroy()

  Notes:
  A column with s and the same column with -s cancel each other.

  Source: Golub, Van Loan, Matrix Computations, sec. 2.1.4 (Sherman, Morrison, Woodbury).
@*/
PetscErrorCode RankUpdateAdd(RankUpdate *update, PC factored, Mat N, const PetscReal *s)
{
  PetscFunctionBeginUser;
  if (!*update) {
    PetscCall(PetscNew(update));
    (*update)->comm = PetscObjectComm((PetscObject)N);
    PetscCall(MatGetLocalSize(N, &(*update)->m, NULL));
  }
  PetscCall(TakeColumns(*update, N, s));
  PetscCall(SolveColumns(*update, factored, N));
  PetscCall(FactorCore(*update));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RankUpdateDestroy - frees an update.

  Not collective

  Input Parameter:
. update - may be NULL inside
@*/
PetscErrorCode RankUpdateDestroy(RankUpdate *update)
{
  PetscFunctionBeginUser;
  if (!*update) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatDestroy(&(*update)->core));
  PetscCall(VecDestroy(&(*update)->y));
  PetscCall(VecDestroy(&(*update)->share));
  PetscCall(PetscFree((*update)->s));
  PetscCall(PetscFree((*update)->ptr));
  PetscCall(PetscFree((*update)->row));
  PetscCall(PetscFree((*update)->value));
  PetscCall(PetscFree((*update)->Z));
  PetscCall(PetscFree(*update));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RankUpdateApply - turns a solution with A into one with A + N diag(s) N^T.

  Collective

  Input Parameter:
. update - the update

  Input and Output Parameter:
. x - A^-1 b becomes (A + N diag(s) N^T)^-1 b; it stays where that sum is singular
@*/
PetscErrorCode RankUpdateApply(RankUpdate update, Vec x)
{
  const PetscScalar *share;
  PetscScalar       *a, *y;

  PetscFunctionBeginUser;
  if (!update->regular) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArray(x, &a));
  PetscCall(VecGetArray(update->y, &y));
  ProjectOnUpdates(update, a, y);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, y, (PetscMPIInt)update->n, MPIU_SCALAR, MPIU_SUM, update->comm));
  PetscCall(VecRestoreArray(update->y, &y));
  PetscCall(MatSolve(update->core, update->y, update->share));
  PetscCall(VecGetArrayRead(update->share, &share));
  for (PetscInt k = 0; k < update->n; k++)
    for (PetscInt i = 0; i < update->m; i++) a[i] -= update->Z[k * update->m + i] * share[k];
  PetscCall(VecRestoreArrayRead(update->share, &share));
  PetscCall(VecRestoreArray(x, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}
