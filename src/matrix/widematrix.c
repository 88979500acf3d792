/* Wide matrices: the lender's entries are moved and its columns are renumbered in place, and back. */
#include "matrix/widematrix.h"
#include "matrix/matrixrows.h"
#include "matrix/nodematrix.h"

/* One block of the lender. Its columns and values are written only while nobody else reads them, and all of them are
   put back; the lender's state therefore stays the same. */
typedef struct {
  MatrixRows   rows;
  PetscInt    *ptr; /* of the wide matrix */
  PetscInt    *column;
  PetscScalar *value;
  /* Entries that WideMatrixAdd() has changed: where they are, and the lender's values. */
  PetscInt     n_kept, *place;
  PetscScalar *kept;
  /* Entries that are left out: where they were, and their columns. compact: row pointers without them */
  PetscInt *compact, n_out, *out, *out_column;
} WideBlock;

struct _n_WideMatrix {
  MPI_Comm  comm;
  PetscInt *narrow; /* of each row of the wide matrix, the lender's; -1: it is empty */
  PetscInt *ghost;  /* of each column of other ranks, its column in the wide matrix */
  PetscInt  n, size;
  PetscBool added;
  WideBlock block[MATRIX_BLOCKS];
};

/* Makes the row pointers of the wide matrix. alone: entries of a row that the lender does not have */
static PetscErrorCode SpreadRows(WideMatrix loan, WideBlock *block, PetscInt alone)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(loan->n + 1, &block->ptr));
  block->ptr[0] = 0;
  for (PetscInt i = 0; i < loan->n; i++) {
    const PetscInt r = loan->narrow[i];

    block->ptr[i + 1] = block->ptr[i] + (r < 0 ? alone : block->rows.ptr[r + 1] - block->rows.ptr[r]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves the entries of row i from the lender's place to that in the wide matrix, or back. */
static void MoveRow(WideMatrix loan, WideBlock *block, PetscInt i, PetscBool back)
{
  const PetscInt r = loan->narrow[i], n = block->rows.ptr[r + 1] - block->rows.ptr[r];
  const PetscInt from = back ? block->ptr[i] : block->rows.ptr[r], to = back ? block->rows.ptr[r] : block->ptr[i];

  memmove(&block->column[to], &block->column[from], n * sizeof(PetscInt));
  memmove(&block->value[to], &block->value[from], n * sizeof(PetscScalar));
}

/* Makes room for the rows that the lender does not have, from the last row to the first, and fills them. The columns
   are those of the wide matrix already. */
static void Spread(WideMatrix loan, WideBlock *own, PetscReal diagonal)
{
  for (PetscInt i = loan->n; i-- > 0;) {
    if (loan->narrow[i] >= 0)
      MoveRow(loan, own, i, PETSC_FALSE);
    else {
      own->column[own->ptr[i]] = i;
      own->value[own->ptr[i]]  = diagonal;
    }
  }
}

/* Renumbers the columns of a block in place. */
static void Renumber(WideBlock *block, const PetscInt *to)
{
  for (PetscInt k = 0; k < block->rows.ptr[block->rows.n]; k++) block->column[k] = to[block->column[k]];
}

/* Marks the nodes to which a block has entries other than 0 in the rows of a node, and the node itself. */
static void MarkNodes(WideMatrix loan, const WideBlock *block, PetscInt node, PetscInt *mark)
{
  mark[node] = node;
  for (PetscInt k = block->ptr[node * loan->size]; k < block->ptr[(node + 1) * loan->size]; k++)
    if (block->value[k] != 0) mark[block->column[k] / loan->size] = node;
}

/* Takes the entries between two nodes out that all are 0. Entries of whole nodes stay together. */
static PetscErrorCode LeaveOut(WideMatrix loan, WideBlock *block)
{
  PetscInt *mark, zeros = 0, to = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < block->ptr[loan->n]; k++) zeros += block->value[k] == 0;
  PetscCall(PetscMalloc2(zeros, &block->out, zeros, &block->out_column));
  if (!block->compact) PetscCall(PetscMalloc1(loan->n + 1, &block->compact));
  PetscCall(PetscMalloc1(loan->n / loan->size, &mark));
  for (PetscInt node = 0; node < loan->n / loan->size; node++) mark[node] = -1;
  for (PetscInt i = 0; i < loan->n; i++) {
    if (i % loan->size == 0) MarkNodes(loan, block, i / loan->size, mark);
    block->compact[i] = to;
    for (PetscInt k = block->ptr[i]; k < block->ptr[i + 1]; k++) {
      if (mark[block->column[k] / loan->size] == i / loan->size) {
        block->column[to]  = block->column[k];
        block->value[to++] = block->value[k];
      } else {
        block->out[block->n_out]          = k;
        block->out_column[block->n_out++] = block->column[k];
      }
    }
  }
  block->compact[loan->n] = to;
  PetscCall(PetscFree(mark));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Puts the entries back that were left out. */
static PetscErrorCode PutBack(WideMatrix loan, WideBlock *block)
{
  PetscInt from = block->ptr[loan->n] - block->n_out;

  PetscFunctionBeginUser;
  for (PetscInt to = block->ptr[loan->n]; block->n_out > 0;) {
    if (block->out[block->n_out - 1] == --to) {
      block->column[to] = block->out_column[--block->n_out];
      block->value[to]  = 0;
    } else {
      block->column[to] = block->column[--from];
      block->value[to]  = block->value[from];
    }
  }
  PetscCall(PetscFree2(block->out, block->out_column));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  WideMatrixBorrow - borrows the arrays of a lender.

  Collective

  Input Parameters:
+ lender - matrix of a NodeMatrix; nobody may read it until WideMatrixReturn()
. rows   - where its rows and columns are in the wide matrix; its ghost is taken over
- size   - block size of the wide matrix

  Output Parameter:
. loan - what WideMatrixReturn() gives back

  Note:
  A NodeMatrix has room for the entries on the diagonal if all rows of the wide matrix are dofs of nodes of which the
  lender has a row.
@*/
PetscErrorCode WideMatrixBorrow(Mat lender, const WideRows *rows, PetscInt size, WideMatrix *loan)
{
  WideMatrix made;
  PetscInt   n, room;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&made));
  made->comm  = PetscObjectComm((PetscObject)lender);
  made->n     = rows->n;
  made->size  = size;
  made->ghost = rows->ghost;
  PetscCall(MatGetLocalSize(lender, &n, NULL));
  PetscCall(PetscMalloc1(rows->n, &made->narrow));
  for (PetscInt i = 0; i < rows->n; i++) made->narrow[i] = -1;
  for (PetscInt r = 0; r < n; r++) made->narrow[rows->row[r]] = r;
  for (int b = 0; b < MATRIX_BLOCKS; b++) {
    WideBlock *block = &made->block[b];

    PetscCall(MatrixRowsGet(lender, b, &block->rows));
    if (!block->rows.mat) continue;
    block->column = (PetscInt *)block->rows.column;
    block->value  = (PetscScalar *)block->rows.value;
    PetscCall(SpreadRows(made, block, b == MATRIX_OWN ? 1 : 0));
  }
  PetscCall(NodeMatrixRoom(lender, &room));
  PetscCheck(made->block[MATRIX_OWN].ptr[rows->n] <= room, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE,
             "the lender has room for %" PetscInt_FMT " entries", room);
  Renumber(&made->block[MATRIX_OWN], rows->row);
  Spread(made, &made->block[MATRIX_OWN], rows->diagonal);
  *loan = made;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  WideMatrixCreate - makes the wide matrix from the arrays of the lender.

  Collective

  Input Parameters:
+ loan - from WideMatrixBorrow(); of the matrices that are made from it only the last one may be read
- full - with entries between two nodes of this rank that all are 0

  Output Parameter:
. wide - the wide matrix; the caller destroys it

  Note:
  Like any such matrix of several ranks, it counts the columns of other ranks among themselves. They ascend as the
  lender's do, so these numbers are the lender's: none of these columns is left out.
@*/
PetscErrorCode WideMatrixCreate(WideMatrix loan, PetscBool full, Mat *wide)
{
  WideBlock *own = &loan->block[MATRIX_OWN], *others = &loan->block[MATRIX_OTHERS];
  PetscInt  *ptr;
  Mat        part[MATRIX_BLOCKS];

  PetscFunctionBeginUser;
  PetscCall(PutBack(loan, own));
  if (!full) PetscCall(LeaveOut(loan, own));
  ptr = full ? own->ptr : own->compact;
  if (others->rows.mat) {
    Renumber(others, loan->ghost);
    PetscCall(MatCreateMPIAIJWithSplitArrays(loan->comm, loan->n, loan->n, PETSC_DETERMINE, PETSC_DETERMINE, ptr,
                                             own->column, own->value, others->ptr, others->column, others->value,
                                             wide));
    PetscCall(MatMPIAIJGetSeqAIJ(*wide, &part[MATRIX_OWN], &part[MATRIX_OTHERS], NULL));
    PetscCall(MatSetBlockSize(part[MATRIX_OWN], loan->size));
    PetscCall(MatSetBlockSizes(part[MATRIX_OTHERS], loan->size, 1));
  } else
    PetscCall(MatCreateSeqAIJWithArrays(loan->comm, loan->n, loan->n, ptr, own->column, own->value, wide));
  PetscCall(MatSetBlockSize(*wide, loan->size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds one row of a term to a block, whose row begins at `to`. Both ascend by the numbers that `number` and the term
   have for their columns. */
static void AddRow(WideBlock *block, PetscInt row, PetscInt to, const PetscInt *number, PetscReal factor,
                   const MatrixRows *term, PetscBool again)
{
  for (PetscInt k = term->ptr[row]; k < term->ptr[row + 1]; k++) {
    const PetscInt column = MatrixRowsColumn(term, 0, k);

    if (again)
      to = block->place[block->n_kept];
    else {
      while (number[block->column[to]] < column) to++;
      block->place[block->n_kept] = to;
      block->kept[block->n_kept]  = block->value[to];
    }
    block->value[to] = block->kept[block->n_kept++] + factor * term->value[k];
  }
}

/*@
  WideMatrixAdd - adds a multiple of a matrix to the wide matrix.

  Not collective

  Input Parameters:
+ loan   - from WideMatrixBorrow()
. factor - of the term
- term   - AIJ matrix over the rows and columns of the lender, which has an entry for each of its entries

  Note:
  Another call, with the same term, puts another multiple of it in the place of the first. Matrices that were made
  before a call may not be read after it. WideMatrixReturn() gives the lender its own values back, to the last bit.
@*/
PetscErrorCode WideMatrixAdd(WideMatrix loan, PetscReal factor, Mat term)
{
  const PetscBool again = loan->added;

  PetscFunctionBeginUser;
  loan->added = PETSC_TRUE;
  PetscCall(PutBack(loan, &loan->block[MATRIX_OWN]));
  for (int b = 0; b < MATRIX_BLOCKS; b++) {
    WideBlock      *block  = &loan->block[b];
    const PetscInt *number = b == MATRIX_OWN ? loan->narrow : block->rows.global;
    MatrixRows      rows;

    PetscCall(MatrixRowsGet(term, b, &rows));
    if (!rows.mat) continue;
    block->n_kept = 0;
    if (!again) PetscCall(PetscMalloc2(rows.ptr[rows.n], &block->place, rows.ptr[rows.n], &block->kept));
    for (PetscInt i = 0; i < loan->n; i++)
      if (loan->narrow[i] >= 0) AddRow(block, loan->narrow[i], block->ptr[i], number, factor, &rows, again);
    PetscCall(MatrixRowsRestore(&rows));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  WideMatrixReturn - gives the arrays back to the lender, which is as it was before.

  Not collective

  Input Parameter:
. loan - set to NULL

  Note:
  The matrices that were made from it must have been destroyed before.
@*/
PetscErrorCode WideMatrixReturn(WideMatrix *loan)
{
  WideMatrix made = *loan;

  PetscFunctionBeginUser;
  PetscCall(PutBack(made, &made->block[MATRIX_OWN]));
  for (int b = 0; b < MATRIX_BLOCKS; b++)
    for (PetscInt k = 0; k < made->block[b].n_kept; k++)
      made->block[b].value[made->block[b].place[k]] = made->block[b].kept[k];
  for (PetscInt i = 0; i < made->n; i++)
    if (made->narrow[i] >= 0) MoveRow(made, &made->block[MATRIX_OWN], i, PETSC_TRUE);
  Renumber(&made->block[MATRIX_OWN], made->narrow);
  for (int b = 0; b < MATRIX_BLOCKS; b++) {
    WideBlock *block = &made->block[b];

    PetscCall(PetscFree2(block->place, block->kept));
    PetscCall(PetscFree(block->ptr));
    PetscCall(PetscFree(block->compact));
    PetscCall(MatrixRowsRestore(&block->rows));
  }
  PetscCall(PetscFree(made->narrow));
  PetscCall(PetscFree(made->ghost));
  PetscCall(PetscFree(*loan));
  PetscFunctionReturn(PETSC_SUCCESS);
}
