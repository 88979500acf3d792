/* Blocks as factors: the kept factors, and the shell matrix that multiplies by them. */
#include "matrix/blockfactors.h"
#include "base/lanes.h"

/* Rows of the factors that one pass over a block's vector serves: their sums and coefficients stay in registers. */
enum { PASS_ROWS = 4 };

/* One block: nodes at[nodes] to at[nodes + n - 1]; K and then J in value, from `first` on. K is left out where `whole`.
 */
typedef struct {
  PetscInt  n, nodes, depth, stride;
  size_t    first;
  PetscBool whole;
} KeptBlock;

struct _n_BlockFactors {
  MPI_Comm   comm;
  int        size; /* dofs of a node */
  PetscInt   rows, n_nodes, *dof;
  PetscSF    sf; /* from the rows of all ranks to the dofs of the nodes */
  Mat        matrix;
  PetscInt   n, room, n_at, at_room, most; /* most: longest row of factors */
  KeptBlock *block;
  PetscInt  *at;
  size_t     n_value, value_room;
  PetscReal *value;
  PetscReal *x, *y, *block_x, *block_y;
};

/*@
  BlockFactorsCreate - creates an empty sum.

  Collective

  Input Parameters:
+ comm - all ranks
- size - dofs of a node

  Output Parameter:
. factors - destroyed with BlockFactorsDestroy()
@*/
PetscErrorCode BlockFactorsCreate(MPI_Comm comm, int size, BlockFactors *factors)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(factors));
  (*factors)->comm = comm;
  (*factors)->size = size;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockFactorsReset - destroys the sum's matrix.

  Collective

  Input Parameter:
. f - the sum, which BlockFactorsPlace() must place again
@*/
PetscErrorCode BlockFactorsReset(BlockFactors f)
{
  PetscFunctionBeginUser;
  BlockFactorsClear(f);
  PetscCall(MatDestroy(&f->matrix));
  PetscCall(PetscSFDestroy(&f->sf));
  PetscCall(PetscFree3(f->dof, f->x, f->y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockFactorsDestroy - frees a sum and its matrix.

  Collective

  Input Parameter:
. factors - may be NULL inside; set to NULL
@*/
PetscErrorCode BlockFactorsDestroy(BlockFactors *factors)
{
  PetscFunctionBeginUser;
  if (!*factors) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(BlockFactorsReset(*factors));
  PetscCall(PetscFree((*factors)->block));
  PetscCall(PetscFree((*factors)->at));
  PetscCall(PetscFree((*factors)->value));
  PetscCall(PetscFree2((*factors)->block_x, (*factors)->block_y));
  PetscCall(PetscFree(*factors));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sum of the products of two vectors over `groups` groups of lanes, for several rows of both factors at once. */
LANES_INLINE void DotRows(const int rows, PetscInt groups, PetscInt stride, const PetscReal *K, const PetscReal *J,
                          const PetscReal *x, PetscReal *along_K, PetscReal *along_J)
{
  Lanes a[PASS_ROWS] = {{0}}, b[PASS_ROWS] = {{0}};

  for (PetscInt i = 0; i < groups * LANES; i += LANES) {
    const Lanes at = *(const LanesInArray *)(x + i);

    for (int r = 0; r < rows; r++) {
      a[r] += at * *(const LanesInArray *)(K + r * stride + i);
      b[r] += at * *(const LanesInArray *)(J + r * stride + i);
    }
  }
  for (int r = 0; r < rows; r++) {
    along_K[r] = LanesSum(a[r]);
    along_J[r] = LanesSum(b[r]);
  }
}

/* y += factor (K^T J + J^T K) x for some rows of the factors. */
LANES_INLINE void MultiplyRows(const int rows, PetscInt groups, PetscInt stride, PetscReal factor, const PetscReal *K,
                               const PetscReal *J, const PetscReal *x, PetscReal *y)
{
  PetscReal along_K[PASS_ROWS], along_J[PASS_ROWS];

  DotRows(rows, groups, stride, K, J, x, along_K, along_J);
  for (int r = 0; r < rows; r++) {
    along_K[r] *= factor;
    along_J[r] *= factor;
  }
  for (PetscInt i = 0; i < groups * LANES; i += LANES) {
    LanesInArray *to  = (LanesInArray *)(y + i);
    Lanes         sum = *to;

    for (int r = 0; r < rows; r++) {
      sum += along_J[r] * *(const LanesInArray *)(K + r * stride + i);
      sum += along_K[r] * *(const LanesInArray *)(J + r * stride + i);
    }
    *to = sum;
  }
}

/* y += A x, from the upper triangle of A. */
static void MultiplyUpper(PetscInt m, PetscInt stride, const PetscReal *A, const PetscReal *x, PetscReal *y)
{
  for (PetscInt i = 0; i < m; i++) {
    const PetscReal *row = A + i * stride;
    PetscReal        sum = row[i] * x[i];

    for (PetscInt j = i + 1; j < m; j++) {
      sum += row[j] * x[j];
      y[j] += row[j] * x[i];
    }
    y[i] += sum;
  }
}

/*@
  BlockFactorMultiply - adds the product of a block with a vector.

  Not collective

  Input Parameters:
+ m     - rows of the block
. block - the block; numbers of its rows from m up to the next whole number of lanes are finite
- x     - the vector, with zeros from m up to the next whole number of lanes

  Input/Output Parameter:
. y - of the same length; what is beyond m is of no use
@*/
void BlockFactorMultiply(PetscInt m, const BlockFactor *block, const PetscReal *x, PetscReal *y)
{
  const PetscInt   groups = LanesGroups((int)m), stride = block->stride;
  const PetscReal *K = block->K, *J = block->J;
  PetscInt         k = 0;

  if (!K) {
    MultiplyUpper(m, stride, J, x, y);
    return;
  }
  for (; k + PASS_ROWS <= block->depth; k += PASS_ROWS)
    MultiplyRows(PASS_ROWS, groups, stride, block->factor, K + k * stride, J + k * stride, x, y);
  for (; k < block->depth; k++) MultiplyRows(1, groups, stride, block->factor, K + k * stride, J + k * stride, x, y);
}

/* The block that is kept under a number. */
static BlockFactor Kept(BlockFactors f, PetscInt b)
{
  const KeptBlock *kept = &f->block[b];
  const PetscReal *K    = &f->value[kept->first];

  return (BlockFactor){kept->depth, kept->stride, 1, kept->whole ? NULL : K,
                       kept->whole ? K : K + kept->depth * kept->stride};
}

/* y += (sum of all blocks) x, over the nodes. */
static void MultiplyAll(BlockFactors f, const PetscReal *x, PetscReal *y)
{
  const int size = f->size;

  for (PetscInt b = 0; b < f->n; b++) {
    const KeptBlock  *kept = &f->block[b];
    const PetscInt   *at = &f->at[kept->nodes], m = kept->n * size;
    const BlockFactor block = Kept(f, b);

    for (PetscInt i = 0; i < kept->stride; i++) {
      f->block_x[i] = i < m ? x[at[i / size] * size + i % size] : 0;
      f->block_y[i] = 0;
    }
    BlockFactorMultiply(m, &block, f->block_x, f->block_y);
    for (PetscInt i = 0; i < m; i++) y[at[i / size] * size + i % size] += f->block_y[i];
  }
}

static PetscErrorCode BlockFactorsMult(Mat matrix, Vec in, Vec out)
{
  BlockFactors       f;
  const PetscScalar *x;
  PetscScalar       *y;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(matrix, &f));
  PetscCall(VecGetArrayRead(in, &x));
  PetscCall(PetscSFBcastBegin(f->sf, MPIU_SCALAR, x, f->x, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(f->sf, MPIU_SCALAR, x, f->x, MPI_REPLACE));
  PetscCall(VecRestoreArrayRead(in, &x));
  PetscCall(PetscArrayzero(f->y, f->n_nodes * f->size));
  MultiplyAll(f, f->x, f->y);
  PetscCall(VecZeroEntries(out));
  PetscCall(VecGetArray(out, &y));
  PetscCall(PetscSFReduceBegin(f->sf, MPIU_SCALAR, f->y, y, MPIU_SUM));
  PetscCall(PetscSFReduceEnd(f->sf, MPIU_SCALAR, f->y, y, MPIU_SUM));
  PetscCall(VecRestoreArray(out, &y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the way from the rows of all ranks to the dofs of the nodes. */
static PetscErrorCode PlaceDofs(BlockFactors f)
{
  PetscLayout layout;
  PetscInt    leaves = 0, *leaf, *root;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(f->n_nodes * f->size, &leaf, f->n_nodes * f->size, &root));
  for (PetscInt i = 0; i < f->n_nodes * f->size; i++) {
    if (f->dof[i] < 0) continue;
    leaf[leaves]   = i;
    root[leaves++] = f->dof[i];
  }
  PetscCall(PetscLayoutCreate(f->comm, &layout));
  PetscCall(PetscLayoutSetLocalSize(layout, f->rows));
  PetscCall(PetscLayoutSetUp(layout));
  PetscCall(PetscSFCreate(f->comm, &f->sf));
  PetscCall(PetscSFSetGraphLayout(f->sf, layout, leaves, leaf, PETSC_COPY_VALUES, root));
  PetscCall(PetscLayoutDestroy(&layout));
  PetscCall(PetscFree2(leaf, root));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockFactorsPlace - makes the sum's matrix over the dofs of some nodes. There are no blocks in it yet.

  Collective

  Input Parameters:
+ f    - the sum; its former matrix is destroyed
. rows - rows of the matrix on this rank
. n    - number of nodes
- dof  - dof[n*size]: global dofs, -1 where there is none
@*/
PetscErrorCode BlockFactorsPlace(BlockFactors f, PetscInt rows, PetscInt n, const PetscInt dof[])
{
  PetscFunctionBeginUser;
  PetscCall(BlockFactorsReset(f));
  f->rows    = rows;
  f->n_nodes = n;
  PetscCall(PetscCalloc3(n * f->size, &f->dof, n * f->size, &f->x, n * f->size, &f->y));
  PetscCall(PetscArraycpy(f->dof, dof, n * f->size));
  PetscCall(PlaceDofs(f));
  PetscCall(MatCreateShell(f->comm, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE, f, &f->matrix));
  PetscCall(MatShellSetOperation(f->matrix, MATOP_MULT, (void (*)(void))BlockFactorsMult));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockFactorsClear - begins a new sum without blocks.

  Not collective

  Input Parameter:
. f - the sum
@*/
void BlockFactorsClear(BlockFactors f)
{
  f->n = f->n_at = 0;
  f->n_value     = 0;
}

/* Makes room for one block more. */
static PetscErrorCode Reserve(BlockFactors f, PetscInt n, PetscInt stride, size_t values)
{
  PetscFunctionBeginUser;
  if (f->n + 1 > f->room) PetscCall(PetscRealloc((f->room = 2 * (f->n + 1)) * sizeof(*f->block), &f->block));
  if (f->n_at + n > f->at_room) PetscCall(PetscRealloc((f->at_room = 2 * (f->n_at + n)) * sizeof(*f->at), &f->at));
  if (f->n_value + values > f->value_room)
    PetscCall(PetscRealloc((f->value_room = 2 * (f->n_value + values)) * sizeof(*f->value), &f->value));
  if (stride > f->most) {
    f->most = 2 * stride;
    PetscCall(PetscFree2(f->block_x, f->block_y));
    PetscCall(PetscMalloc2(f->most, &f->block_x, f->most, &f->block_y));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies a factor with m numbers in a row, of which there are zeros beyond m. */
static void CopyRows(PetscInt m, PetscReal factor, const BlockFactor *block, const PetscReal *from, PetscInt stride,
                     PetscReal *to)
{
  for (PetscInt k = 0; k < block->depth; k++)
    for (PetscInt i = 0; i < stride; i++) to[k * stride + i] = i < m ? factor * from[k * block->stride + i] : 0;
}

/*@
  BlockFactorsAdd - adds a block.

  Not collective

  Input Parameters:
+ f      - the sum, after BlockFactorsPlace()
. n      - number of nodes
. number - the nodes, among those of BlockFactorsPlace()
- block  - over these nodes and perhaps some more, which come last and are left out; it is copied
@*/
PetscErrorCode BlockFactorsAdd(BlockFactors f, PetscInt n, const PetscInt number[], const BlockFactor *block)
{
  const PetscInt m = n * f->size, stride = LanesGroups((int)m) * LANES;
  KeptBlock      kept   = {.n = n, .nodes = f->n_at, .depth = block->depth, .stride = stride, .first = f->n_value};
  BlockFactor    copied = *block;
  size_t         values;

  PetscFunctionBeginUser;
  kept.whole = block->K ? PETSC_FALSE : PETSC_TRUE;
  if (kept.whole) copied.depth = kept.depth = m;
  values = (size_t)kept.depth * stride;
  PetscCall(Reserve(f, n, stride, kept.whole ? values : 2 * values));
  PetscCall(PetscArraycpy(&f->at[f->n_at], number, n));
  if (!kept.whole) CopyRows(m, block->factor, &copied, block->K, stride, &f->value[f->n_value]);
  CopyRows(m, 1, &copied, block->J, stride, &f->value[f->n_value + (kept.whole ? 0 : values)]);
  f->block[f->n++] = kept;
  f->n_at += n;
  f->n_value += kept.whole ? values : 2 * values;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockFactorsGet - returns the sum as a matrix, which multiplies by the blocks that there are when it does so; NULL
  where none has been placed.

  Not collective

  Input Parameter:
. f - the sum
@*/
Mat BlockFactorsGet(BlockFactors f)
{
  return f->matrix;
}

/* Entry (i, j) of a block, i <= j. */
static PetscReal Entry(const BlockFactor *block, PetscInt i, PetscInt j)
{
  const PetscReal *K = block->K, *J = block->J;
  PetscReal        sum = 0;

  if (!K) return J[i * block->stride + j];
  for (PetscInt k = 0; k < block->depth; k++, K += block->stride, J += block->stride) sum += K[i] * J[j] + J[i] * K[j];
  return sum;
}

/* Adds a block's entries to those of the matrix; rows and columns without a dof are left out. */
static PetscErrorCode FormBlock(BlockFactors f, PetscInt b, Mat formed)
{
  const KeptBlock  *kept  = &f->block[b];
  const BlockFactor block = Kept(f, b);
  const PetscInt    m     = kept->n * f->size;
  PetscInt         *dof;
  PetscScalar      *M;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(m, &dof, m * m, &M));
  for (PetscInt i = 0; i < m; i++) {
    dof[i] = f->dof[f->at[kept->nodes + i / f->size] * f->size + i % f->size];
    for (PetscInt j = i; j < m; j++) M[i * m + j] = M[j * m + i] = Entry(&block, i, j);
  }
  PetscCall(MatSetValues(formed, m, dof, m, dof, M, ADD_VALUES));
  PetscCall(PetscFree2(dof, M));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sorts the blocks by nodes: those of node i are of[first[i]] to of[first[i+1] - 1]. Both are freed by the caller. */
static PetscErrorCode BlocksOfNodes(BlockFactors f, PetscInt **first, PetscInt **of)
{
  PetscInt *next;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(f->n_nodes + 2, first));
  PetscCall(PetscMalloc1(f->n_at, of));
  next = *first + 1; /* filling moves the ends of all nodes on to where they belong */
  for (PetscInt i = 0; i < f->n_at; i++) next[f->at[i] + 1]++;
  for (PetscInt i = 0; i < f->n_nodes; i++) next[i + 1] += next[i];
  for (PetscInt b = 0; b < f->n; b++)
    for (PetscInt i = 0; i < f->block[b].n; i++) (*of)[next[f->at[f->block[b].nodes + i]]++] = b;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts the entries that the blocks place in each row of this rank. What several ranks place counts for each of them.
 */
static PetscErrorCode CountEntries(BlockFactors f, PetscInt *entries)
{
  PetscInt *first, *of, *seen, *mine; /* seen: by which node last, plus 1 */

  PetscFunctionBeginUser;
  PetscCall(BlocksOfNodes(f, &first, &of));
  PetscCall(PetscCalloc2(f->n_nodes, &seen, f->n_nodes * f->size, &mine));
  for (PetscInt i = 0; i < f->n_nodes; i++) {
    PetscInt count = 0;

    for (PetscInt k = first[i]; k < first[i + 1]; k++) {
      const KeptBlock *block = &f->block[of[k]];

      for (PetscInt j = 0; j < block->n; j++) {
        PetscInt *by = &seen[f->at[block->nodes + j]];

        count += *by != i + 1;
        *by = i + 1;
      }
    }
    for (int d = 0; d < f->size; d++) mine[i * f->size + d] = count * f->size;
  }
  PetscCall(PetscArrayzero(entries, f->rows));
  PetscCall(PetscSFReduceBegin(f->sf, MPIU_INT, mine, entries, MPI_SUM));
  PetscCall(PetscSFReduceEnd(f->sf, MPIU_INT, mine, entries, MPI_SUM));
  PetscCall(PetscFree2(seen, mine));
  PetscCall(PetscFree(first));
  PetscCall(PetscFree(of));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the AIJ matrix with room for all entries of the blocks. */
static PetscErrorCode CreateFormed(BlockFactors f, Mat *formed)
{
  PetscInt *inner, *outer, columns;

  PetscFunctionBeginUser;
  PetscCall(MatCreate(f->comm, formed));
  PetscCall(MatSetSizes(*formed, f->rows, f->rows, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(*formed, MATAIJ));
  PetscCall(MatGetSize(f->matrix, NULL, &columns));
  PetscCall(PetscMalloc2(f->rows, &inner, f->rows, &outer));
  PetscCall(CountEntries(f, inner));
  for (PetscInt i = 0; i < f->rows; i++) {
    outer[i] = PetscMin(inner[i], columns - f->rows);
    inner[i] = PetscMin(inner[i], f->rows);
  }
  PetscCall(MatSeqAIJSetPreallocation(*formed, 0, inner));
  PetscCall(MatMPIAIJSetPreallocation(*formed, 0, inner, 0, outer));
  PetscCall(PetscFree2(inner, outer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockFactorsForm - makes an AIJ matrix of a matrix of BlockFactorsGet(), for a solver that needs the entries.

  Collective

  Input Parameter:
. matrix - such a matrix

  Output Parameter:
. formed - destroyed by the caller; NULL if the matrix is none
@*/
PetscErrorCode BlockFactorsForm(Mat matrix, Mat *formed)
{
  BlockFactors f;
  PetscBool    shell;

  PetscFunctionBeginUser;
  *formed = NULL;
  PetscCall(PetscObjectTypeCompare((PetscObject)matrix, MATSHELL, &shell));
  if (!shell) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatShellGetContext(matrix, &f));
  PetscCall(CreateFormed(f, formed));
  for (PetscInt b = 0; b < f->n; b++) PetscCall(FormBlock(f, b, *formed));
  PetscCall(MatAssemblyBegin(*formed, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*formed, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}
