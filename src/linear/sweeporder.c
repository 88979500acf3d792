/* Colours of ranks and places of nodes for sweeps across all ranks. */
#include "sweeporder.h"
#include "matrix/matrixrows.h"

/* Lists the ranks that own ghosts of this one, ascending. ranks: room for all ranks */
static void SweepOrderListNeighbours(PetscInt n, const PetscInt *row, const PetscInt *ranges, PetscMPIInt *ranks,
                                     PetscMPIInt *count)
{
  PetscMPIInt rank = 0;

  *count = 0;
  for (PetscInt k = 0; k < n; k++) {
    while (row[k] >= ranges[rank + 1]) rank++;
    if (!*count || ranks[*count - 1] != rank) ranks[(*count)++] = rank;
  }
}

/* Gives each rank, one after the other, the first colour that no neighbour before it has. All ranks find the same
   colours. */
static PetscErrorCode ColourRanks(MPI_Comm comm, const PetscMPIInt *mine, PetscMPIInt count, int *colour)
{
  PetscMPIInt  size, *counts, *first, *all;
  PetscMPIInt *taken;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMalloc3(size, &counts, size + 1, &first, size, &taken));
  PetscCallMPI(MPI_Allgather(&count, 1, MPI_INT, counts, 1, MPI_INT, comm));
  first[0] = 0;
  for (PetscMPIInt r = 0; r < size; r++) first[r + 1] = first[r] + counts[r];
  PetscCall(PetscMalloc1(first[size], &all));
  PetscCallMPI(MPI_Allgatherv(mine, count, MPI_INT, all, counts, first, MPI_INT, comm));
  for (PetscMPIInt c = 0; c < size; c++) taken[c] = -1;
  for (PetscMPIInt r = 0; r < size; r++) {
    for (PetscMPIInt k = first[r]; k < first[r + 1]; k++)
      if (all[k] < r) taken[colour[all[k]]] = r;
    for (colour[r] = 0; taken[colour[r]] == r;) colour[r]++;
  }
  PetscCall(PetscFree(all));
  PetscCall(PetscFree3(counts, first, taken));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the colours of this rank and of its ghosts. The place of a ghost tells whether it is swept before this rank or
   after it. row: first row of each ghost, ascending */
static PetscErrorCode PlaceGhosts(SweepOrder o, Mat mat, const PetscInt *row)
{
  const MPI_Comm  comm = PetscObjectComm((PetscObject)mat);
  const PetscInt *ranges;
  PetscMPIInt     size, rank, count, *ranks;
  int            *colour;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(MatGetOwnershipRanges(mat, &ranges));
  PetscCall(PetscMalloc2(size, &ranks, size, &colour));
  SweepOrderListNeighbours(o->n_ghosts, row, ranges, ranks, &count);
  PetscCall(ColourRanks(comm, ranks, count, colour));
  o->colour = colour[rank];
  for (PetscMPIInt r = 0; r < size; r++) o->colours = PetscMax(o->colours, colour[r] + 1);
  for (PetscInt k = 0, r = 0; k < o->n_ghosts; k++) {
    while (row[k] >= ranges[r + 1]) r++;
    o->place[o->n + k] = colour[r] < o->colour ? -1 : o->n;
  }
  PetscCall(PetscFree2(ranks, colour));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the nodes of other ranks that are coupled to this one, and how their values come. Nodes are taken as a whole,
   even where some of their rows are no columns here. *row: first row of each; the caller frees it. */
static PetscErrorCode FindGhosts(SweepOrder o, Mat mat, const MatrixRows *others, PetscInt **row)
{
  PetscInt    n = 0, *rows;
  PetscLayout layout;

  PetscFunctionBeginUser;
  *row = NULL;
  if (!others->mat) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatGetSize(others->mat, NULL, &n));
  PetscCall(PetscMalloc1(n, row));
  PetscCall(PetscMalloc1(n * o->size, &rows));
  PetscCall(PetscMalloc1(n, &o->ghost));
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt d = others->global[k] % o->size, first = others->global[k] - d;

    if (!o->n_ghosts || (*row)[o->n_ghosts - 1] != first) (*row)[o->n_ghosts++] = first;
    o->ghost[k] = (o->n_ghosts - 1) * o->size + d;
  }
  for (PetscInt k = 0; k < o->n_ghosts * o->size; k++) rows[k] = (*row)[k / o->size] + k % o->size;
  PetscCall(MatGetLayouts(mat, &layout, NULL));
  PetscCall(PetscSFCreate(PetscObjectComm((PetscObject)mat), &o->sf));
  PetscCall(PetscSFSetGraphLayout(o->sf, layout, o->n_ghosts * o->size, NULL, PETSC_COPY_VALUES, rows));
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the part of a node with regard to its ghosts; SWEEP_BEFORE: it has none. */
static int FindPart(const SweepOrder o, const MatrixRows *others, PetscInt node)
{
  PetscBool lower = PETSC_FALSE, higher = PETSC_FALSE;

  if (!others->mat) return SWEEP_BEFORE;
  for (PetscInt k = others->ptr[node * o->size]; k < others->ptr[(node + 1) * o->size]; k++) {
    const PetscInt place = o->place[o->n + o->ghost[others->column[k]] / o->size];

    lower  = (PetscBool)(lower || place < 0);
    higher = (PetscBool)(higher || place >= 0);
  }
  if (!lower && !higher) return SWEEP_BEFORE;
  return lower && higher ? SWEEP_TURN : lower ? SWEEP_LAST : SWEEP_FIRST;
}

/* Numbers the places. Nodes without ghosts come before the turn and after it in shares by which each colour comes to
   its turn when the colour before it has had its own: no rank waits as long as its turn is short. */
static PetscErrorCode PlaceNodes(SweepOrder o, const MatrixRows *others)
{
  PetscInt count[SWEEP_PARTS] = {0}, next[SWEEP_PARTS], inner;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(o->n, &o->node));
  for (PetscInt i = 0; i < o->n; i++) {
    o->place[i] = FindPart(o, others, i);
    count[o->place[i]]++;
  }
  inner = count[SWEEP_BEFORE];
  if (o->colours > 1) count[SWEEP_BEFORE] = (PetscInt)((PetscInt64)inner * o->colour / (o->colours - 1));
  count[SWEEP_AFTER] = inner - count[SWEEP_BEFORE];
  for (int part = 0; part < SWEEP_PARTS; part++) {
    next[part]         = o->first[part];
    o->first[part + 1] = o->first[part] + count[part];
  }
  for (PetscInt i = 0; i < o->n; i++) {
    const int part =
      o->place[i] == SWEEP_BEFORE && next[SWEEP_BEFORE] == o->first[SWEEP_BEFORE + 1] ? SWEEP_AFTER : (int)o->place[i];

    o->place[i]          = next[part]++;
    o->node[o->place[i]] = i;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SweepOrderCreate - finds the order of a matrix's nodes.

  Collective

  Input Parameter:
. mat - AIJ of symmetric pattern; its blocks are square and each is on one rank

  Output Parameter:
. order - destroy it with SweepOrderDestroy()

  Notes:
  The nodes of a part come in ascending order.

  Source: Adams, A distributed memory unstructured Gauss-Seidel algorithm for multigrid smoothers, 2001.
@*/
PetscErrorCode SweepOrderCreate(Mat mat, SweepOrder *order)
{
  SweepOrder o;
  MatrixRows others;
  PetscInt   size, rows, *ghost;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&o));
  PetscCall(MatGetBlockSize(mat, &size));
  PetscCall(MatGetLocalSize(mat, &rows, NULL));
  PetscCall(MatrixRowsGet(mat, MATRIX_OTHERS, &others));
  o->size = (int)size;
  o->n    = rows / size;
  PetscCall(FindGhosts(o, mat, &others, &ghost));
  PetscCall(PetscMalloc1(o->n + o->n_ghosts, &o->place));
  if (o->sf) PetscCall(PlaceGhosts(o, mat, ghost));
  PetscCall(PlaceNodes(o, &others));
  PetscCall(PetscFree(ghost));
  PetscCall(MatrixRowsRestore(&others));
  *order = o;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SweepOrderDestroy - frees the order.

  Collective

  Input Parameter:
. order - may be NULL inside
@*/
PetscErrorCode SweepOrderDestroy(SweepOrder *order)
{
  SweepOrder o = *order;

  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSFDestroy(&o->sf));
  PetscCall(PetscFree(o->node));
  PetscCall(PetscFree(o->place));
  PetscCall(PetscFree(o->ghost));
  PetscCall(PetscFree(*order));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SweepOrderShareBegin - begins to fetch the values of ghosts.

  Collective

  Input Parameter:
. o - the order

  Input and Output Parameter:
. x - x[(n + n_ghosts)*size]: the values of this rank's nodes, and behind them those of ghosts, which are fetched
@*/
PetscErrorCode SweepOrderShareBegin(SweepOrder o, PetscReal *x)
{
  PetscFunctionBeginUser;
  if (o->sf) PetscCall(PetscSFBcastBegin(o->sf, MPIU_REAL, x, x + o->n * o->size, MPI_REPLACE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SweepOrderShareEnd - ends what SweepOrderShareBegin() has begun.

  Collective

  Input Parameter:
. o - the order

  Input and Output Parameter:
. x - the same array
@*/
PetscErrorCode SweepOrderShareEnd(SweepOrder o, PetscReal *x)
{
  PetscFunctionBeginUser;
  if (o->sf) PetscCall(PetscSFBcastEnd(o->sf, MPIU_REAL, x, x + o->n * o->size, MPI_REPLACE));
  PetscFunctionReturn(PETSC_SUCCESS);
}
