/* The graph of the cells of two blocks in contact: every face between cells and every link is an edge, whether the
   graph is whole on the first rank or shared out; clusters have all cells and edges; the parts of the clusters' graph
   are as good as those of the whole one. Ranks may have no cells. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "cellfaces.h"
#include "cellpartition.h"
#include "graphclusters.h"
#include "graphrefine.h"

/* Bricks along the sides of each block at most, nodes of both */
enum { LONG = 24, WIDE = 12, HIGH = 6, BLOCKS = 2, CORNERS = 8 };
enum { MOST_CELLS = BLOCKS * LONG * WIDE * HIGH, MOST_NODES = BLOCKS * (LONG + 1) * (WIDE + 1) * (HIGH + 1) };

/* Cells of a cluster in these tests */
enum { CLUSTER = 8 };

/* Largest edge cut of parts of clusters over that of parts of cells, and largest part over the mean */
#define MOST_CUT       1.2
#define MOST_IMBALANCE 1.05

static PetscMPIInt rank, size;

/* Two blocks, one above the other, with nodes of their own */
typedef struct {
  int              n[3]; /* bricks of a block along its sides */
  GmshBlock        block;
  SliceMesh        slice;
  PetscInt         home_start[8], cell_start[8], id[MOST_NODES], nodes[MOST_CELLS * CORNERS], cell_tag[MOST_CELLS];
  PetscReal        coords[3 * MOST_NODES];
  int              body[MOST_CELLS];
  const GmshBlock *of_cell[MOST_CELLS];
  PetscBool        contact[MOST_CELLS];
  CellLinks        links;
  CellGraph        graph;
} Blocks;

static PetscInt NodeOf(const int n[3], int block, int i, int j, int k)
{
  return ((block * (n[2] + 1) + k) * (n[1] + 1) + j) * (n[0] + 1) + i;
}

static PetscInt CellCount(const int n[3])
{
  return (PetscInt)BLOCKS * n[0] * n[1] * n[2];
}

/* Faces between the cells of both blocks */
static PetscInt FaceCount(const int n[3])
{
  return (PetscInt)BLOCKS * ((n[0] - 1) * n[1] * n[2] + n[0] * (n[1] - 1) * n[2] + n[0] * n[1] * (n[2] - 1));
}

/* Nodes of both blocks, which all ranks know. */
static void MakeNodes(Blocks *b)
{
  const int *n = b->n;

  for (int block = 0; block < BLOCKS; block++)
    for (int k = 0; k <= n[2]; k++)
      for (int j = 0; j <= n[1]; j++)
        for (int i = 0; i <= n[0]; i++) {
          const PetscInt  node = NodeOf(n, block, i, j, k);
          const PetscReal x[3] = {i, j, block * n[2] + k};

          b->id[node] = node;
          for (int d = 0; d < 3; d++) b->coords[3 * node + d] = x[d];
        }
}

/* Place of a cell: its id tells nothing of it, as with tetrahedra of gmsh. The prime divides no number of cells here.
 */
static void PlaceOf(const int n[3], PetscInt cell, int at[4])
{
  const PetscInt mixed = cell * 7919 % CellCount(n);

  at[0] = (int)(mixed % n[0]);
  at[1] = (int)(mixed / n[0] % n[1]);
  at[2] = (int)(mixed / (n[0] * n[1]) % n[2]);
  at[3] = (int)(mixed / (n[0] * n[1] * n[2]));
}

/* Is the cell in contact with the other block? */
static PetscBool IsInContact(const int n[3], const int at[4])
{
  return (PetscBool)(at[3] ? at[2] == 0 : at[2] == n[2] - 1);
}

static void MakeCells(Blocks *b, PetscInt first, PetscInt n_cells)
{
  static const int corner[CORNERS][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                         {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

  for (PetscInt c = 0; c < n_cells; c++) {
    int at[4];

    PlaceOf(b->n, first + c, at);
    for (int k = 0; k < CORNERS; k++)
      b->nodes[c * CORNERS + k] = NodeOf(b->n, at[3], at[0] + corner[k][0], at[1] + corner[k][1], at[2] + corner[k][2]);
    b->body[c]     = at[3];
    b->cell_tag[c] = first + c;
    b->of_cell[c]  = &b->block;
    b->contact[c]  = IsInContact(b->n, at);
  }
}

/* Links the cells of the first block in contact to those above them. */
static void MakeLinks(Blocks *b)
{
  PetscInt *above;
  int       at[4];

  b->links = (CellLinks){0};
  if (rank) return;
  assert_int_equal(PetscMalloc1(b->n[0] * b->n[1], &above), 0);
  assert_int_equal(PetscMalloc1(2 * b->n[0] * b->n[1], &b->links.cell), 0);
  for (int pass = 0; pass < BLOCKS; pass++)
    for (PetscInt c = 0; c < CellCount(b->n); c++) {
      PlaceOf(b->n, c, at);
      if (!IsInContact(b->n, at) || at[3] == pass) continue;
      if (!pass) {
        above[at[1] * b->n[0] + at[0]] = c;
        continue;
      }
      b->links.cell[2 * b->links.n]       = c;
      b->links.cell[2 * b->links.n++ + 1] = above[at[1] * b->n[0] + at[0]];
    }
  assert_int_equal(PetscFree(above), 0);
}

/* Makes the slices of two blocks and their graph. */
static void MakeBlocks(int n_long, int n_wide, int n_high, PetscInt whole, Blocks **made)
{
  PetscInt n_cells, n_nodes;
  Blocks  *b;

  assert_int_equal(PetscNew(made), 0);
  b       = *made;
  b->n[0] = n_long;
  b->n[1] = n_wide;
  b->n[2] = n_high;
  n_cells = CellCount(b->n);
  n_nodes = NodeOf(b->n, BLOCKS - 1, n_long, n_wide, n_high) + 1;
  for (PetscMPIInt r = 0; r <= size; r++) {
    b->home_start[r] = n_nodes * r / size;
    b->cell_start[r] = n_cells * r / size;
  }
  MakeNodes(b);
  MakeCells(b, b->cell_start[rank], b->cell_start[rank + 1] - b->cell_start[rank]);
  MakeLinks(b);
  b->block = (GmshBlock){.dim = 3, .element = ElementGet(ELEMENT_HEX8), .nodes = CORNERS};
  b->slice = (SliceMesh){.comm       = PETSC_COMM_WORLD,
                         .rank       = rank,
                         .size       = size,
                         .home_start = b->home_start,
                         .n_nodes    = n_nodes,
                         .id         = b->id,
                         .coords     = b->coords,
                         .n_cells    = b->cell_start[rank + 1] - b->cell_start[rank],
                         .cell_start = b->cell_start,
                         .cell_nodes = b->nodes,
                         .width      = CORNERS,
                         .cell_tag   = b->cell_tag,
                         .cell_body  = b->body,
                         .cell_block = b->of_cell};
  assert_int_equal(CellFacesCreate(&b->slice), 0);
  assert_int_equal(CellGraphCreate(&b->slice, b->contact, &b->links, whole, &b->graph), 0);
}

static void FreeBlocks(Blocks *b)
{
  assert_int_equal(CellGraphDestroy(&b->graph), 0);
  assert_int_equal(PetscFree(b->slice.face_start), 0);
  assert_int_equal(PetscFree(b), 0);
}

static PetscInt Sum(PetscInt mine)
{
  assert_int_equal(MPI_Allreduce(MPI_IN_PLACE, &mine, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD), MPI_SUCCESS);
  return mine;
}

/* Expects all cells, faces, links and marks of contact in the graph. */
static void CheckGraph(int n_long, int n_wide, int n_high, PetscInt whole)
{
  PetscInt ends[CELL_LINK_WEIGHT + 1] = {0}, contact = 0, *values;
  Blocks  *b;

  MakeBlocks(n_long, n_wide, n_high, whole, &b);
  const CellGraph *graph = &b->graph;

  assert_int_equal(graph->whole, CellCount(b->n) <= whole);
  if (graph->whole) assert_int_equal(graph->n, rank ? 0 : CellCount(b->n));
  assert_int_equal(Sum(graph->n), CellCount(b->n));
  for (PetscInt v = 0; v < graph->n; v++) contact += graph->contact[v];
  assert_int_equal(Sum(contact), BLOCKS * n_long * n_wide);
  for (PetscInt k = 0; k < graph->offsets[graph->n]; k++) {
    ends[graph->weight[k]]++;
    assert_in_range(graph->neighbours[k], 0, graph->n + graph->n_ghosts - 1);
  }
  assert_int_equal(Sum(ends[1]), 2 * FaceCount(b->n));
  assert_int_equal(Sum(ends[CELL_LINK_WEIGHT]), 2 * n_long * n_wide);
  /* each ghost is its vertex: neighbours' numbers add up to the same from both ends */
  PetscInt from = 0, to = 0;

  assert_int_equal(PetscMalloc1(graph->n + graph->n_ghosts, &values), 0);
  for (PetscInt v = 0; v < graph->n; v++) values[v] = graph->start[rank] + v;
  assert_int_equal(CellGraphFetch(graph, values), 0);
  for (PetscInt v = 0; v < graph->n; v++)
    for (PetscInt k = graph->offsets[v]; k < graph->offsets[v + 1]; k++) {
      from += values[v];
      to += values[graph->neighbours[k]];
    }
  assert_int_equal(Sum(from), Sum(to));
  assert_int_equal(PetscFree(values), 0);
  FreeBlocks(b);
}

static void TestGraph(void **state)
{
  (void)state;
  CheckGraph(LONG, WIDE, HIGH, MOST_CELLS);
  CheckGraph(LONG, WIDE, HIGH, 0);
  CheckGraph(1, 1, 1, MOST_CELLS);
  CheckGraph(1, 1, 1, 0);
}

/* The shares of the ranks are even where there are many cells, and most neighbours are on one rank. */
static void TestShares(void **state)
{
  Blocks *b;

  (void)state;
  MakeBlocks(LONG, WIDE, HIGH, 0, &b);
  assert_true((PetscReal)b->graph.n * size <= 1.2 * MOST_CELLS);
  assert_true(b->graph.n_ghosts <= b->graph.n / 2);
  FreeBlocks(b);
}

/* Expects that clusters have all cells, at most so many each, and that their edges are the same from both ends. */
static void CheckCoarse(const Blocks *b, const WeightedGraph *coarse)
{
  PetscInt cells = 0, contact = 0, back;

  for (PetscInt i = 0; i < coarse->n; i++) {
    assert_in_range(coarse->cells[i], 1, CLUSTER);
    cells += coarse->cells[i];
    contact += coarse->contact[i];
    for (PetscInt k = coarse->offsets[i]; k < coarse->offsets[i + 1]; k++) {
      const PetscInt to = coarse->neighbours[k];

      assert_int_not_equal(to, i);
      back = 0;
      for (PetscInt m = coarse->offsets[to]; m < coarse->offsets[to + 1]; m++)
        if (coarse->neighbours[m] == i) back += coarse->weight[m];
      assert_int_equal(back, coarse->weight[k]);
    }
  }
  assert_int_equal(cells, CellCount(b->n));
  assert_int_equal(contact, BLOCKS * b->n[0] * b->n[1]);
}

static void CheckClusters(int n_long, int n_wide, int n_high)
{
  PetscInt      n, *cluster;
  WeightedGraph coarse;
  Blocks       *b;

  MakeBlocks(n_long, n_wide, n_high, 0, &b);
  assert_int_equal(PetscMalloc1(b->graph.n, &cluster), 0);
  assert_int_equal(GraphClustersFind(&b->graph, CLUSTER, &n, cluster), 0);
  for (PetscInt v = 0; v < b->graph.n; v++) assert_in_range(cluster[v], 0, n - 1);
  assert_int_equal(GraphClustersGather(&b->graph, n, cluster, &coarse), 0);
  n = Sum(n);
  assert_int_equal(coarse.n, rank ? 0 : n);
  if (!rank) CheckCoarse(b, &coarse);
  if (!rank && CellCount(b->n) == MOST_CELLS) assert_true(coarse.n <= 2 * MOST_CELLS / CLUSTER);
  assert_int_equal(WeightedGraphFree(&coarse), 0);
  assert_int_equal(PetscFree(cluster), 0);
  FreeBlocks(b);
}

static void TestClusters(void **state)
{
  (void)state;
  CheckClusters(LONG, WIDE, HIGH);
  CheckClusters(1, 1, 1);
}

/* Parts whose borders are ragged become smooth, and stay balanced. */
static void TestRefine(void **state)
{
  PetscInt  *part, count[2] = {0, 0}, cut = 0;
  Blocks    *b;
  const int *n;

  (void)state;
  MakeBlocks(LONG, WIDE, HIGH, 0, &b);
  n = b->n;
  assert_int_equal(PetscMalloc1(b->graph.n + b->graph.n_ghosts, &part), 0);
  PetscMPIInt *mine, *theirs;

  assert_int_equal(PetscMalloc2(b->slice.n_cells, &mine, b->graph.n, &theirs), 0);
  for (PetscInt c = 0; c < b->slice.n_cells; c++) {
    int at[4];

    PlaceOf(n, b->cell_start[rank] + c, at);
    mine[c] = at[0] + (at[1] + at[2]) % 2 < LONG / 2 ? 0 : 1;
  }
  assert_int_equal(PetscSFReduceBegin(b->graph.cells, MPI_INT, mine, theirs, MPI_REPLACE), 0);
  assert_int_equal(PetscSFReduceEnd(b->graph.cells, MPI_INT, mine, theirs, MPI_REPLACE), 0);
  for (PetscInt v = 0; v < b->graph.n; v++) part[v] = theirs[v];
  assert_int_equal(GraphRefine(&b->graph, 2, part), 0);
  assert_int_equal(CellGraphFetch(&b->graph, part), 0);
  for (PetscInt v = 0; v < b->graph.n; v++) {
    assert_in_range(part[v], 0, 1);
    count[part[v]]++;
    for (PetscInt k = b->graph.offsets[v]; k < b->graph.offsets[v + 1]; k++)
      cut += b->graph.weight[k] == 1 && part[v] != part[b->graph.neighbours[k]];
  }
  for (int p = 0; p < 2; p++) assert_true((PetscReal)Sum(count[p]) <= MOST_IMBALANCE * MOST_CELLS / 2);
  /* a plane has BLOCKS*WIDE*HIGH faces; the ragged border has more than twice as many */
  assert_true((PetscReal)Sum(cut) / 2 <= MOST_CUT * BLOCKS * WIDE * HIGH);
  assert_int_equal(PetscFree2(mine, theirs), 0);
  assert_int_equal(PetscFree(part), 0);
  FreeBlocks(b);
}

/* Partitions the blocks by the whole graph, or by clusters. */
static void Cut(PetscInt whole, Partition *partition)
{
  PetscMPIInt *part;
  PetscInt    *count;
  Blocks      *b;

  MakeBlocks(LONG, WIDE, HIGH, whole, &b);
  assert_int_equal(PetscMalloc1(b->slice.n_cells, &part), 0);
  assert_int_equal(PetscCalloc1(size, &count), 0);
  assert_int_equal(CellPartition(&b->graph, part, partition), 0);
  for (PetscInt c = 0; c < b->slice.n_cells; c++) {
    assert_in_range(part[c], 0, size - 1);
    count[part[c]]++;
  }
  for (PetscMPIInt r = 0; r < size; r++)
    assert_true((PetscReal)(Sum(count[r]) * size) <= (partition->imbalance_cells + 1e-6) * MOST_CELLS);
  assert_true(partition->imbalance_cells <= MOST_IMBALANCE);
  assert_int_equal(PetscFree(count), 0);
  assert_int_equal(PetscFree(part), 0);
  FreeBlocks(b);
}

static void TestPartition(void **state)
{
  Partition whole, clusters;

  (void)state;
  if (size == 1) return;
  Cut(MOST_CELLS, &whole);
  Cut(0, &clusters);
  assert_true(whole.edge_cut > 0 && clusters.edge_cut > 0);
  assert_true((PetscReal)clusters.edge_cut <= MOST_CUT * (PetscReal)whole.edge_cut);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestGraph), cmocka_unit_test(TestShares),
                                     cmocka_unit_test(TestClusters), cmocka_unit_test(TestRefine),
                                     cmocka_unit_test(TestPartition)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
