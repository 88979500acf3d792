/* Entries and elimination order of a bordered matrix. */
#include "linear/borderedfactor.h"

struct _n_BorderedFactor {
  MPI_Comm    comm;
  PetscMPIInt rank, size;
  PetscInt    n;        /* rows of K on all ranks */
  PetscInt   *position; /* place of each row in the elimination of K, from 0; on the first rank */
  Border      border;
  PetscInt    before, count;                /* vectors of the ranks before this one, of all ranks */
  PetscInt    n_seen, *seen_ptr, *seen_row; /* pattern of the vectors that were ordered last */
};

/*@
  BorderedFactorCreate - creates the borders of a matrix K, without vectors.

  Collective

  Input Parameters:
+ comm     - ranks of K; borrowed
. n        - rows of K on all ranks
- position - position[n]: place of each row in the elimination of K, from 0; copied. On the first rank, NULL elsewhere.

  Output Parameter:
. out - the borders; destroy them with BorderedFactorDestroy()
@*/
PetscErrorCode BorderedFactorCreate(MPI_Comm comm, PetscInt n, const PetscInt *position, BorderedFactor *out)
{
  BorderedFactor b;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  b->comm = comm;
  b->n    = n;
  PetscCallMPI(MPI_Comm_rank(comm, &b->rank));
  PetscCallMPI(MPI_Comm_size(comm, &b->size));
  if (!b->rank) PetscCall(PetscMalloc1(n, &b->position));
  if (!b->rank) PetscCall(PetscArraycpy(b->position, position, n));
  *out = b;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BorderedFactorDestroy - frees the borders.

  Not collective

  Input Parameter:
. bordering - may be NULL inside
@*/
PetscErrorCode BorderedFactorDestroy(BorderedFactor *bordering)
{
  BorderedFactor b = *bordering;

  PetscFunctionBeginUser;
  if (!b) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree(b->position));
  PetscCall(PetscFree(b->seen_ptr));
  PetscCall(PetscFree(b->seen_row));
  PetscCall(PetscFree(*bordering));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds whether the vectors of this rank have the pattern that was noted. */
static PetscErrorCode HavePattern(BorderedFactor b, PetscBool *same)
{
  const Border *border = &b->border;

  PetscFunctionBeginUser;
  *same = (PetscBool)(b->seen_ptr && b->n_seen == border->n);
  if (*same && border->n) PetscCall(PetscArraycmp(b->seen_ptr, border->ptr, border->n + 1, same));
  if (*same && border->n) PetscCall(PetscArraycmp(b->seen_row, border->row, border->ptr[border->n], same));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode NotePattern(BorderedFactor b)
{
  const Border  *border  = &b->border;
  const PetscInt entries = border->n ? border->ptr[border->n] : 0;

  PetscFunctionBeginUser;
  b->n_seen = border->n;
  PetscCall(PetscRealloc((border->n + 1) * sizeof(PetscInt), &b->seen_ptr));
  PetscCall(PetscRealloc(entries * sizeof(PetscInt), &b->seen_row));
  PetscCall(PetscArraycpy(b->seen_ptr, border->ptr, border->n ? border->n + 1 : 0));
  PetscCall(PetscArraycpy(b->seen_row, border->row, entries));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BorderedFactorSet - sets the vectors.

  Collective

  Input Parameters:
+ b      - the borders
- border - this rank's vectors; the arrays are borrowed until the next call

  Output Parameter:
. changed - the vectors have other rows than those that BorderedFactorOrder() ordered last; the same on all ranks
@*/
PetscErrorCode BorderedFactorSet(BorderedFactor b, const Border *border, PetscBool *changed)
{
  PetscBool same;
  int       differs;

  PetscFunctionBeginUser;
  b->border = *border;
  PetscCallMPI(MPI_Scan(&b->border.n, &b->before, 1, MPIU_INT, MPI_SUM, b->comm));
  b->before -= b->border.n;
  PetscCallMPI(MPI_Allreduce(&b->border.n, &b->count, 1, MPIU_INT, MPI_SUM, b->comm));
  PetscCall(HavePattern(b, &same));
  differs = !same;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &differs, 1, MPI_INT, MPI_MAX, b->comm));
  *changed = differs ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BorderedFactorCount - counts the vectors of all ranks.

  Not collective, the same on all ranks

  Input Parameter:
. b - the borders
@*/
PetscInt BorderedFactorCount(BorderedFactor b)
{
  return b->count;
}

/*@
  BorderedFactorCountEntries - counts the entries of this rank's vectors in the bordered matrix.

  Not collective

  Input Parameter:
. b - the borders

  Note:
  Counted are the entries above the diagonal, and for each vector the -1 on the diagonal.
@*/
PetscInt BorderedFactorCountEntries(BorderedFactor b)
{
  return b->border.n ? b->border.ptr[b->border.n] + b->border.n : 0;
}

/*@
  BorderedFactorNumber - writes rows and columns of this rank's vectors in the bordered matrix.

  Not collective

  Input Parameter:
. b - the borders

  Output Parameters:
+ row    - row[BorderedFactorCountEntries()], from 0
- column - as many columns, from 0

  Note:
  The vectors' unknowns follow those of K. The -1 of each vector comes behind its entries.
@*/
void BorderedFactorNumber(BorderedFactor b, PetscInt *row, PetscInt *column)
{
  const Border *border = &b->border;

  for (PetscInt v = 0; v < border->n; v++) {
    const PetscInt own = b->n + b->before + v;

    for (PetscInt k = border->ptr[v]; k < border->ptr[v + 1]; k++) {
      *row++    = border->row[k];
      *column++ = own;
    }
    *row++ = *column++ = own;
  }
}

/*@
  BorderedFactorTake - writes the values of this rank's vectors in the bordered matrix.

  Not collective

  Input Parameter:
. b - the borders

  Output Parameter:
. value - value[BorderedFactorCountEntries()], in the order of BorderedFactorNumber()
@*/
void BorderedFactorTake(BorderedFactor b, PetscScalar *value)
{
  const Border *border = &b->border;

  for (PetscInt v = 0; v < border->n; v++) {
    for (PetscInt k = border->ptr[v]; k < border->ptr[v + 1]; k++) *value++ = border->value[k];
    *value++ = -1;
  }
}

/* Finds for each vector of all ranks the last of its rows in the elimination of K; on the first rank. */
static PetscErrorCode FindLast(BorderedFactor b, PetscInt *last)
{
  const Border *border = &b->border;
  PetscMPIInt   mine, *counts, *first;
  PetscInt      entries = border->n ? border->ptr[border->n] : 0, n, *row, *vector, *all_rows, *all_vectors;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(entries, &mine));
  PetscCall(PetscMalloc4(b->size, &counts, b->size + 1, &first, entries, &row, entries, &vector));
  for (PetscInt v = 0; v < border->n; v++)
    for (PetscInt k = border->ptr[v]; k < border->ptr[v + 1]; k++) vector[k] = b->before + v;
  PetscCall(PetscArraycpy(row, border->row, entries));
  PetscCallMPI(MPI_Gather(&mine, 1, MPI_INT, counts, 1, MPI_INT, 0, b->comm));
  first[0] = 0;
  for (PetscMPIInt r = 0; r < b->size; r++) first[r + 1] = b->rank ? 0 : first[r] + counts[r];
  n = first[b->size];
  PetscCall(PetscMalloc2(n, &all_rows, n, &all_vectors));
  PetscCallMPI(MPI_Gatherv(row, mine, MPIU_INT, all_rows, counts, first, MPIU_INT, 0, b->comm));
  PetscCallMPI(MPI_Gatherv(vector, mine, MPIU_INT, all_vectors, counts, first, MPIU_INT, 0, b->comm));
  for (PetscInt k = 0; k < n; k++) last[all_vectors[k]] = PetscMax(last[all_vectors[k]], b->position[all_rows[k]]);
  PetscCall(PetscFree2(all_rows, all_vectors));
  PetscCall(PetscFree4(counts, first, row, vector));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BorderedFactorOrder - orders the bordered matrix.

  Collective

  Input Parameter:
. b - the borders with their vectors

  Output Parameter:
. position - place of each row of the bordered matrix in the elimination, from 0; on the first rank, NULL elsewhere. The
             caller frees it.

  Note:
  The unknown of a vector follows the last of the vector's rows. After that row it is all that is left of them. If it
  were eliminated later, it would be in every front until then.
@*/
PetscErrorCode BorderedFactorOrder(BorderedFactor b, PetscInt **position)
{
  PetscInt *last, *follow;

  PetscFunctionBeginUser;
  *position = NULL;
  PetscCall(NotePattern(b));
  PetscCall(PetscCalloc2(b->rank ? 0 : b->count, &last, b->rank ? 0 : b->n + 1, &follow));
  PetscCall(FindLast(b, last));
  if (!b->rank) {
    PetscCall(PetscMalloc1(b->n + b->count, position));
    for (PetscInt v = 0; v < b->count; v++) follow[last[v] + 1]++;
    for (PetscInt p = 0; p < b->n; p++) follow[p + 1] += follow[p]; /* number of vectors that follow rows before p */
    for (PetscInt r = 0; r < b->n; r++) (*position)[r] = b->position[r] + follow[b->position[r]];
    for (PetscInt v = 0; v < b->count; v++) (*position)[b->n + v] = last[v] + 1 + follow[last[v]]++;
  }
  PetscCall(PetscFree2(last, follow));
  PetscFunctionReturn(PETSC_SUCCESS);
}
