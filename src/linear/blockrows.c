/* Copies matrices into blocks of single precision. */
#include "blockrows.h"
#include "matrix/matrixrows.h"

/* Where the blocks of the present rows are. */
typedef struct {
  PetscInt  count[BLOCKROWS_PARTS]; /* blocks so far */
  PetscInt *last, *block; /* of each other node: the place that has coupled to it last, and the number of that block */
} Builder;

/* Finds the block that couples the node at a place with another node; a new one the first time. Values are written as
   far as there is memory for them. */
static PetscInt FindBlock(BlockRows rows, const SweepOrder order, Builder *builder, PetscInt place, PetscInt other,
                          int *part)
{
  *part = order->place[other] < place ? BLOCKROWS_BEFORE : BLOCKROWS_AFTER;
  if (builder->last[other] != place) {
    builder->last[other]  = place;
    builder->block[other] = builder->count[*part]++;
    if (rows->part[*part].column) rows->part[*part].column[builder->block[other]] = other * order->size;
  }
  return builder->block[other];
}

/* Adds the entries that one block of the matrix has in a node's rows. */
static void AddEntries(BlockRows rows, const SweepOrder order, Builder *builder, PetscInt place, const MatrixRows *from,
                       int block)
{
  const int      size = order->size;
  const PetscInt row  = order->node[place] * size;

  for (int r = 0; from->mat && r < size; r++) {
    for (PetscInt k = from->ptr[row + r]; k < from->ptr[row + r + 1]; k++) {
      const PetscInt column = block == MATRIX_OWN ? from->column[k] : order->n * size + order->ghost[from->column[k]];
      int            part;
      const PetscInt b = FindBlock(rows, order, builder, place, column / size, &part);

      if (rows->part[part].value)
        rows->part[part].value[(b * size + column % size) * size + r] = (float)PetscRealPart(from->value[k]);
    }
  }
}

/* Goes through all entries. It counts blocks, or writes them where there is memory. */
static PetscErrorCode AddAll(Mat mat, SweepOrder order, BlockRows rows, PetscInt count[BLOCKROWS_PARTS])
{
  const PetscInt n       = order->n + order->n_ghosts;
  Builder        builder = {{0}, NULL, NULL};
  MatrixRows     from[MATRIX_BLOCKS];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &builder.last, n, &builder.block));
  for (PetscInt i = 0; i < n; i++) builder.last[i] = -1;
  for (int b = 0; b < MATRIX_BLOCKS; b++) PetscCall(MatrixRowsGet(mat, b, &from[b]));
  for (PetscInt place = 0; place < order->n; place++) {
    int part;

    for (int p = 0; p < BLOCKROWS_PARTS; p++) rows->part[p].first[place] = builder.count[p];
    (void)FindBlock(rows, order, &builder, place, order->node[place], &part); /* the node itself comes first */
    for (int b = 0; b < MATRIX_BLOCKS; b++) AddEntries(rows, order, &builder, place, &from[b], b);
  }
  for (int p = 0; p < BLOCKROWS_PARTS; p++) rows->part[p].first[order->n] = count[p] = builder.count[p];
  for (int b = 0; b < MATRIX_BLOCKS; b++) PetscCall(MatrixRowsRestore(&from[b]));
  PetscCall(PetscFree2(builder.last, builder.block));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockRowsCreate - copies an assembled AIJ matrix.

  Not collective

  Input Parameters:
+ mat   - blocks of up to BLOCKROWS_SIZE rows; entries that it lacks within a block are zero
- order - order of its nodes

  Output Parameter:
. rows - the copy; destroy it with BlockRowsDestroy()

  Note:
  Values beyond the range of single precision become infinite.
@*/
PetscErrorCode BlockRowsCreate(Mat mat, SweepOrder order, BlockRows *rows)
{
  const PetscInt size = order->size;
  PetscInt       count[BLOCKROWS_PARTS];

  PetscFunctionBeginUser;
  PetscCheck(size <= BLOCKROWS_SIZE, PETSC_COMM_SELF, PETSC_ERR_SUP, "blocks of %" PetscInt_FMT " rows", size);
  PetscCall(PetscNew(rows));
  for (int p = 0; p < BLOCKROWS_PARTS; p++) PetscCall(PetscMalloc1(order->n + 1, &(*rows)->part[p].first));
  PetscCall(AddAll(mat, order, *rows, count));
  for (int p = 0; p < BLOCKROWS_PARTS; p++) {
    PetscCall(PetscMalloc1(count[p], &(*rows)->part[p].column));
    PetscCall(PetscCalloc1(count[p] * size * size + BLOCKROWS_LANES, &(*rows)->part[p].value));
  }
  PetscCall(AddAll(mat, order, *rows, count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockRowsDestroy - frees the copy of a matrix.

  Not collective

  Input Parameter:
. rows - may be NULL inside
@*/
PetscErrorCode BlockRowsDestroy(BlockRows *rows)
{
  PetscFunctionBeginUser;
  if (!*rows) PetscFunctionReturn(PETSC_SUCCESS);
  for (int p = 0; p < BLOCKROWS_PARTS; p++) {
    PetscCall(PetscFree((*rows)->part[p].first));
    PetscCall(PetscFree((*rows)->part[p].column));
    PetscCall(PetscFree((*rows)->part[p].value));
  }
  PetscCall(PetscFree(*rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}
