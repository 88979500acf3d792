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
} WideBlock;

struct _n_WideMatrix {
  PetscInt *narrow; /* of each row of the wide matrix, the lender's; -1: it is empty */
  PetscInt  n;
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

/* Creates the wide matrix from the lender's arrays. Like any such matrix of several ranks, it counts the columns of
   other ranks among themselves. They ascend as the lender's do, so these numbers are the lender's. */
static PetscErrorCode MakeWide(WideMatrix loan, Mat lender, const WideRows *rows, PetscInt size, Mat *wide)
{
  WideBlock *own = &loan->block[MATRIX_OWN], *others = &loan->block[MATRIX_OTHERS];
  Mat        part[MATRIX_BLOCKS];

  PetscFunctionBeginUser;
  Renumber(own, rows->row);
  Spread(loan, own, rows->diagonal);
  if (others->rows.mat) {
    Renumber(others, rows->ghost);
    PetscCall(MatCreateMPIAIJWithSplitArrays(PetscObjectComm((PetscObject)lender), loan->n, loan->n, PETSC_DETERMINE,
                                             PETSC_DETERMINE, own->ptr, own->column, own->value, others->ptr,
                                             others->column, others->value, wide));
    PetscCall(MatMPIAIJGetSeqAIJ(*wide, &part[MATRIX_OWN], &part[MATRIX_OTHERS], NULL));
    PetscCall(MatSetBlockSize(part[MATRIX_OWN], size));
    PetscCall(MatSetBlockSizes(part[MATRIX_OTHERS], size, 1));
  } else
    PetscCall(MatCreateSeqAIJWithArrays(PetscObjectComm((PetscObject)lender), loan->n, loan->n, own->ptr, own->column,
                                        own->value, wide));
  PetscCall(MatSetBlockSize(*wide, size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  WideMatrixBorrow - makes a wide matrix from the arrays of a lender.

  Collective

  Input Parameters:
+ lender - matrix of a NodeMatrix; nobody may read it until WideMatrixReturn()
. rows   - where its rows and columns are in the wide matrix; not needed afterwards
- size   - block size of the wide matrix

  Output Parameters:
+ wide - the wide matrix; the caller destroys it
- loan - what WideMatrixReturn() gives back

  Note:
  A NodeMatrix has room for the entries on the diagonal if all rows of the wide matrix are dofs of nodes of which the
  lender has a row.
@*/
PetscErrorCode WideMatrixBorrow(Mat lender, const WideRows *rows, PetscInt size, Mat *wide, WideMatrix *loan)
{
  WideMatrix made;
  PetscInt   n, room;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&made));
  made->n = rows->n;
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
  PetscCall(MakeWide(made, lender, rows, size, wide));
  *loan = made;
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
  Another call, with the same term, puts another multiple of it in the place of the first. WideMatrixReturn() gives the
lender its own values back, to the last bit.
@*/
PetscErrorCode WideMatrixAdd(WideMatrix loan, PetscReal factor, Mat term)
{
  const PetscBool again = loan->added;

  PetscFunctionBeginUser;
  loan->added = PETSC_TRUE;
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
  The wide matrix must have been destroyed before.
@*/
PetscErrorCode WideMatrixReturn(WideMatrix *loan)
{
  WideMatrix made = *loan;

  PetscFunctionBeginUser;
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
    PetscCall(MatrixRowsRestore(&block->rows));
  }
  PetscCall(PetscFree(made->narrow));
  PetscCall(PetscFree(*loan));
  PetscFunctionReturn(PETSC_SUCCESS);
}
