#include "bordering.h"
#include "matrixrows.h"

struct _n_Bordering {
  MPI_Comm    comm;
  PetscMPIInt rank, size;
  PetscInt    n, first, rows;                             /* rows of K: of all ranks; the first of this one, how many */
  PetscInt   *width[MATRIX_BLOCKS];                       /* of K's rows */
  PetscInt   *ptr[MATRIX_BLOCKS], *column[MATRIX_BLOCKS]; /* K's pattern on and above the diagonal, columns in the numbers of all ranks */
  PetscInt   *position;                                   /* of K's rows, on the first rank */
  Border      border;
  PetscInt    before, count;                /* vectors of ranks before this one, of all ranks */
  PetscInt    n_seen, *seen_ptr, *seen_row; /* the pattern of the vectors before */
};

/* Notes which entries K has on and above the diagonal in one of its blocks. */
static PetscErrorCode NoteBlock(Bordering b, Mat K, int block)
{
  MatrixRows rows;
  PetscInt   n = 0;

  PetscFunctionBeginUser;
  PetscCall(MatrixRowsGet(K, block, &rows));
  PetscCall(PetscCalloc2(b->rows + 1, &b->ptr[block], b->rows, &b->width[block]));
  PetscCall(PetscMalloc1(rows.mat ? rows.ptr[b->rows] : 0, &b->column[block]));
  for (PetscInt r = 0; r < b->rows; r++) {
    b->width[block][r] = rows.mat ? rows.ptr[r + 1] - rows.ptr[r] : 0;
    for (PetscInt k = rows.mat ? rows.ptr[r] : 0; rows.mat && k < rows.ptr[r + 1]; k++) {
      const PetscInt c = MatrixRowsColumn(&rows, b->first, k);

      if (c >= b->first + r) b->column[block][n++] = c;
    }
    b->ptr[block][r + 1] = n;
  }
  PetscCall(MatrixRowsRestore(&rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BorderingCreate - Collective. */
PetscErrorCode BorderingCreate(Mat K, const PetscInt *position, Bordering *out)
{
  Bordering b;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  b->comm = PetscObjectComm((PetscObject)K);
  PetscCallMPI(MPI_Comm_rank(b->comm, &b->rank));
  PetscCallMPI(MPI_Comm_size(b->comm, &b->size));
  PetscCall(MatGetSize(K, &b->n, NULL));
  PetscCall(MatGetLocalSize(K, &b->rows, NULL));
  PetscCall(MatGetOwnershipRange(K, &b->first, NULL));
  for (int block = 0; block < MATRIX_BLOCKS; block++) PetscCall(NoteBlock(b, K, block));
  if (!b->rank) PetscCall(PetscMalloc1(b->n, &b->position));
  if (!b->rank) PetscCall(PetscArraycpy(b->position, position, b->n));
  *out = b;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BorderingDestroy - Not collective. */
PetscErrorCode BorderingDestroy(Bordering *bordering)
{
  Bordering b = *bordering;

  PetscFunctionBeginUser;
  if (!b) PetscFunctionReturn(PETSC_SUCCESS);
  for (int block = 0; block < MATRIX_BLOCKS; block++) PetscCall(PetscFree2(b->ptr[block], b->width[block]));
  for (int block = 0; block < MATRIX_BLOCKS; block++) PetscCall(PetscFree(b->column[block]));
  PetscCall(PetscFree(b->position));
  PetscCall(PetscFree(b->seen_ptr));
  PetscCall(PetscFree(b->seen_row));
  PetscCall(PetscFree(*bordering));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Have the vectors of this rank the pattern of those before? If not, it is noted. */
static PetscErrorCode NotePattern(Bordering b, PetscBool *same)
{
  const Border  *border  = &b->border;
  const PetscInt entries = border->n ? border->ptr[border->n] : 0;

  PetscFunctionBeginUser;
  *same = (PetscBool)(b->seen_ptr && b->n_seen == border->n);
  if (*same && border->n) PetscCall(PetscArraycmp(b->seen_ptr, border->ptr, border->n + 1, same));
  if (*same && border->n) PetscCall(PetscArraycmp(b->seen_row, border->row, entries, same));
  if (*same) PetscFunctionReturn(PETSC_SUCCESS);
  b->n_seen = border->n;
  PetscCall(PetscRealloc((border->n + 1) * sizeof(PetscInt), &b->seen_ptr));
  PetscCall(PetscRealloc(entries * sizeof(PetscInt), &b->seen_row));
  PetscCall(PetscArraycpy(b->seen_ptr, border->ptr, border->n ? border->n + 1 : 0));
  PetscCall(PetscArraycpy(b->seen_row, border->row, entries));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BorderingSet - Collective. Arrays and matrix stay the caller's until the next call. */
PetscErrorCode BorderingSet(Bordering b, const Border *border, PetscBool *changed)
{
  PetscBool same;
  int       differs;

  PetscFunctionBeginUser;
  b->border = *border;
  PetscCallMPI(MPI_Scan(&b->border.n, &b->before, 1, MPIU_INT, MPI_SUM, b->comm));
  b->before -= b->border.n;
  PetscCallMPI(MPI_Allreduce(&b->border.n, &b->count, 1, MPIU_INT, MPI_SUM, b->comm));
  PetscCall(NotePattern(b, &same));
  differs = !same;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &differs, 1, MPI_INT, MPI_MAX, b->comm));
  *changed = differs ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BorderingCount - Not collective. */
PetscInt BorderingCount(Bordering b)
{
  return b->count;
}

/* ---------- entries ---------- */

/* The value of a column in a row, searched from *at on, as columns ascend; 0 where the row lacks it. */
static PetscScalar Look(const MatrixRows *rows, PetscInt first, PetscInt end, PetscInt column, PetscInt *at)
{
  for (; *at < end; ++*at) {
    const PetscInt c = MatrixRowsColumn(rows, first, *at);

    if (c == column) return rows->value[*at];
    if (c > column) return 0;
  }
  return 0;
}

/* A - C in a row of one block, where K has entries. */
static void TakeRow(Bordering b, int block, PetscInt r, const MatrixRows *a, const MatrixRows *c, PetscScalar *value)
{
  const PetscInt n = b->ptr[block][r + 1] - b->ptr[block][r], *column = &b->column[block][b->ptr[block][r]];
  PetscInt       in_a = a->ptr[r], in_c = c->mat ? c->ptr[r] : 0;

  for (PetscInt k = 0; k < n; k++) {
    value[k] = Look(a, b->first, a->ptr[r + 1], column[k], &in_a);
    if (c->mat) value[k] -= Look(c, b->first, c->ptr[r + 1], column[k], &in_c);
  }
}

/* The same in all rows; those that C is not in are K's. */
static PetscErrorCode TakeBlock(Bordering b, Mat A, int block, PetscScalar *value)
{
  MatrixRows a, c = {.mat = NULL};

  PetscFunctionBeginUser;
  PetscCall(MatrixRowsGet(A, block, &a));
  if (b->border.sum) PetscCall(MatrixRowsGet(b->border.sum, block, &c));
  for (PetscInt r = 0; a.mat && r < b->rows; r++) {
    const PetscInt n = b->ptr[block][r + 1] - b->ptr[block][r];

    if (a.ptr[r + 1] - a.ptr[r] == b->width[block][r] && (!c.mat || c.ptr[r + 1] == c.ptr[r]))
      PetscCall(PetscArraycpy(value, &a.value[a.ptr[r + 1] - n], n));
    else
      TakeRow(b, block, r, &a, &c, value);
    value += n;
  }
  if (c.mat) PetscCall(MatrixRowsRestore(&c));
  PetscCall(MatrixRowsRestore(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vectors' values, and -1 on their diagonal */
static void TakeVectors(Bordering b, PetscScalar *value)
{
  const Border *border = &b->border;

  for (PetscInt v = 0; v < border->n; v++) {
    for (PetscInt k = border->ptr[v]; k < border->ptr[v + 1]; k++) *value++ = border->value[k];
    *value++ = -1;
  }
}

/* BorderingCountEntries - Not collective. */
void BorderingCountEntries(Bordering b, PetscInt n[BORDERING_PARTS])
{
  n[BORDERING_BODIES]  = b->ptr[MATRIX_OWN][b->rows] + b->ptr[MATRIX_OTHERS][b->rows];
  n[BORDERING_VECTORS] = b->border.n ? b->border.ptr[b->border.n] + b->border.n : 0;
}

static void NumberBodies(Bordering b, PetscInt *row, PetscInt *column)
{
  for (int block = 0; block < MATRIX_BLOCKS; block++) {
    for (PetscInt r = 0; r < b->rows; r++) {
      for (PetscInt k = b->ptr[block][r]; k < b->ptr[block][r + 1]; k++) {
        *row++    = b->first + r;
        *column++ = b->column[block][k];
      }
    }
  }
}

static void NumberVectors(Bordering b, PetscInt *row, PetscInt *column)
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

/* BorderingNumber - Not collective. row, column: as many as BorderingCountEntries() says. */
void BorderingNumber(Bordering b, int part, PetscInt *row, PetscInt *column)
{
  if (part == BORDERING_BODIES)
    NumberBodies(b, row, column);
  else
    NumberVectors(b, row, column);
}

/* BorderingTake - Not collective. A has entries wherever K has, and C's. */
PetscErrorCode BorderingTake(Bordering b, Mat A, PetscScalar *value)
{
  PetscFunctionBeginUser;
  for (int block = 0; block < MATRIX_BLOCKS; block++) {
    PetscCall(TakeBlock(b, A, block, value));
    value += b->ptr[block][b->rows];
  }
  TakeVectors(b, value);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- order ---------- */

/* The last row that each vector of all ranks has in the order of K, on the first rank */
static PetscErrorCode FindLast(Bordering b, PetscInt *last)
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

/* BorderingOrder - Collective. A vector's unknown follows the last of its rows: from there on it is all that is left of them, and to eliminate it later would
   have it stand in every front up to there. */
PetscErrorCode BorderingOrder(Bordering b, PetscInt **position)
{
  PetscInt *last, *follow;

  PetscFunctionBeginUser;
  *position = NULL;
  PetscCall(PetscCalloc2(b->rank ? 0 : b->count, &last, b->rank ? 0 : b->n + 1, &follow));
  PetscCall(FindLast(b, last));
  if (!b->rank) {
    PetscCall(PetscMalloc1(b->n + b->count, position));
    for (PetscInt v = 0; v < b->count; v++) follow[last[v] + 1]++;
    for (PetscInt p = 0; p < b->n; p++) follow[p + 1] += follow[p]; /* vectors that follow rows before p */
    for (PetscInt r = 0; r < b->n; r++) (*position)[r] = b->position[r] + follow[b->position[r]];
    for (PetscInt v = 0; v < b->count; v++) (*position)[b->n + v] = last[v] + 1 + follow[last[v]]++;
  }
  PetscCall(PetscFree2(last, follow));
  PetscFunctionReturn(PETSC_SUCCESS);
}
