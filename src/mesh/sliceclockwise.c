/* Turns plane surfaces that run clockwise in the file. */
#include "sliceclockwise.h"
#include "base/exchange.h"
#include <stdlib.h>

/* Does the outline of a plane cell run clockwise? */
static PetscBool CellIsClockwise(const SliceMesh *slice, PetscInt cell)
{
  const PetscInt *nodes = SliceMeshCellNodes(slice, cell);
  const int       n     = slice->cell_block[cell]->element->corners;
  PetscReal       twice = 0;

  for (int k = 0; k < n; k++) {
    const PetscReal *a = &slice->coords[3 * nodes[k]], *b = &slice->coords[3 * nodes[(k + 1) % n]];
    const PetscReal *o = &slice->coords[3 * nodes[0]];

    twice += (a[0] - o[0]) * (b[1] - o[1]) - (b[0] - o[0]) * (a[1] - o[1]);
  }
  return (PetscBool)(twice < 0);
}

/* An edge of a plane cell: its ends in ascending order, whether the cell runs along it that way, and whether the cell's
   surface runs clockwise. */
typedef struct {
  PetscInt node[2];
  int      along, clockwise;
} PlaneEdge;

static int PlaneEdgeCompare(const void *a, const void *b)
{
  const PlaneEdge *p = a, *q = b;

  if (p->node[0] != q->node[0]) return p->node[0] < q->node[0] ? -1 : 1;
  if (p->node[1] != q->node[1]) return p->node[1] < q->node[1] ? -1 : 1;
  return 0;
}

typedef struct {
  const SliceMesh *slice;
  const PetscBool *clockwise; /* for each block */
} Outlines;

/* Packs edge i % CELL_FACE_CORNERS of a cell. */
static void PackEdge(const void *context, PetscInt i, void *packed)
{
  const Outlines  *outlines = context;
  const SliceMesh *slice    = outlines->slice;
  const PetscInt   cell = i / CELL_FACE_CORNERS, *nodes = SliceMeshCellNodes(slice, cell);
  const int        k = (int)(i % CELL_FACE_CORNERS), corners = slice->cell_block[cell]->element->corners;
  const PetscInt   from = slice->id[nodes[k]], to = slice->id[nodes[(k + 1) % corners]];
  PlaneEdge       *edge = packed;

  edge->node[0]   = PetscMin(from, to);
  edge->node[1]   = PetscMax(from, to);
  edge->along     = from < to;
  edge->clockwise = outlines->clockwise[slice->cell_block[cell] - slice->gmsh.blocks];
}

/* Does a surface that runs clockwise lie on the same side of a common edge as one that does not? It is then folded over
   it, and turning its cells would hide that. */
static PetscErrorCode FindFold(const SliceMesh *slice, const PetscBool *clockwise, PetscBool *folded)
{
  const Outlines outlines = {slice, clockwise};
  PetscInt       n        = slice->n_cells * CELL_FACE_CORNERS;
  PetscMPIInt   *to;
  PlaneEdge     *edges;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &to));
  for (PetscInt i = 0; i < n; i++) {
    PlaneEdge edge;

    to[i] = -1;
    if (i % CELL_FACE_CORNERS >= slice->cell_block[i / CELL_FACE_CORNERS]->element->corners) continue;
    PackEdge(&outlines, i, &edge);
    to[i] = SliceMeshRankOf(slice, slice->home_start, edge.node[0]);
  }
  PetscCall(ExchangeRecords(slice->comm, sizeof(PlaneEdge), n, to, PackEdge, &outlines, &n, (void **)&edges));
  if (n) qsort(edges, (size_t)n, sizeof(*edges), PlaneEdgeCompare);
  *folded = PETSC_FALSE;
  for (PetscInt i = 1; i < n; i++)
    if (!PlaneEdgeCompare(&edges[i - 1], &edges[i]) && edges[i - 1].clockwise != edges[i].clockwise &&
        edges[i - 1].along != edges[i].along)
      *folded = PETSC_TRUE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, folded, 1, MPIU_BOOL, MPI_LOR, slice->comm));
  PetscCall(PetscFree(edges));
  PetscCall(PetscFree(to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says which surfaces run clockwise: all their cells do. Returns whether any does. */
static PetscErrorCode FindClockwise(const SliceMesh *slice, PetscBool *clockwise, PetscBool *any)
{
  const GmshMesh *gmsh = &slice->gmsh;
  PetscInt       *n;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(gmsh->n_blocks, &n));
  for (PetscInt c = 0; c < slice->n_cells; c++) n[slice->cell_block[c] - gmsh->blocks] += CellIsClockwise(slice, c);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n, gmsh->n_blocks, MPIU_INT, MPI_SUM, slice->comm));
  *any = PETSC_FALSE;
  for (int b = 0; b < gmsh->n_blocks; b++) {
    clockwise[b] = (PetscBool)(n[b] && n[b] == gmsh->blocks[b].n_all);
    *any         = (PetscBool)(*any || clockwise[b]);
  }
  PetscCall(PetscFree(n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceClockwiseTurn - turns the plane cells of those surfaces whose outline runs clockwise in the file.

  Collective

  Input Parameter:
. slice - its cells and nodes are numbered

  Note:
  A surface of which only some cells do is tangled, and one that is folded over its neighbour is wrong; they are left as
  they are.
@*/
PetscErrorCode SliceClockwiseTurn(SliceMesh *slice)
{
  PetscBool *clockwise, folded = PETSC_FALSE, any = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(slice->gmsh.n_blocks, &clockwise));
  PetscCall(FindClockwise(slice, clockwise, &any));
  if (any) PetscCall(FindFold(slice, clockwise, &folded));
  for (PetscInt c = 0; any && !folded && c < slice->n_cells; c++) {
    const GmshBlock *block = slice->cell_block[c];
    PetscInt        *nodes = slice->cell_nodes + c * slice->width, old[ELEMENT_MAX_NODES];

    if (!clockwise[block - slice->gmsh.blocks]) continue;
    for (int k = 0; k < block->nodes; k++) old[k] = nodes[k];
    for (int k = 0; k < block->nodes; k++) nodes[k] = old[SliceMeshReversedNode(block->element, k)];
  }
  PetscCall(PetscFree(clockwise));
  PetscFunctionReturn(PETSC_SUCCESS);
}
