/* Links between slave and master cells, found by a box tree of cell centres. */
#include "slicelinks.h"
#include "mesh/meshgroup.h"
#include "base/boxtree.h"
#include "base/exchange.h"

/* Largest distance of the centres of linked cells, as a multiple of the slave cell's size. Cells farther apart may
   never touch. Without this limit, all cells of a surface that faces an edge from a distance would be linked to one
   cell. */
#define LINK_REACH 4

/* A cell of a surface, and the centre of its nodes; size: twice the largest distance of a node from there */
typedef struct {
  PetscInt  cell;
  PetscReal centre[3], size;
} SurfaceCell;

/* The cells of a surface, on the first rank; centre: n*3 */
typedef struct {
  PetscInt     n;
  SurfaceCell *cell;
  PetscReal   *centre;
} SurfaceCells;

typedef struct {
  const SurfaceCells *cells;
  const PetscReal    *point;
  PetscInt            closest;
} Nearest;

static PetscReal FaceDistance(const PetscReal *a, const PetscReal *b)
{
  return PetscSqrtReal(PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]) + PetscSqr(a[2] - b[2]));
}

/* Some cells of a slice, by their numbers there */
typedef struct {
  const SliceMesh *slice;
  const PetscInt  *cell;
} SliceCells;

static void PackSurfaceCell(const void *context, PetscInt i, void *packed)
{
  const SliceCells *cells = context;
  const SliceMesh  *slice = cells->slice;
  const PetscInt    cell = cells->cell[i], *nodes = SliceMeshCellNodes(slice, cell);
  const int         n  = slice->cell_block[cell]->nodes;
  SurfaceCell      *to = packed;

  to->cell = slice->cell_start[slice->rank] + cell;
  for (int d = 0; d < 3; d++)
    for (int k = 0; k < n; k++) to->centre[d] += slice->coords[3 * nodes[k] + d] / n;
  for (int k = 0; k < n; k++) to->size = PetscMax(to->size, 2 * FaceDistance(to->centre, &slice->coords[3 * nodes[k]]));
}

/* Gathers the cells of a surface on the first rank. */
static PetscErrorCode FindCells(const SliceMesh *slice, int group, SurfaceCells *cells)
{
  SliceCells   mine = {.slice = slice};
  PetscInt     n    = 0, *cell;
  PetscMPIInt *to;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(slice->n_faces, &cell));
  for (PetscInt f = 0; f < slice->n_faces; f++)
    if (slice->faces[f].group == group) cell[n++] = slice->faces[f].cell - slice->cell_start[slice->rank];
  PetscCall(PetscSortRemoveDupsInt(&n, cell));
  PetscCall(PetscCalloc1(n, &to));
  mine.cell = cell;
  PetscCall(
    ExchangeRecords(slice->comm, sizeof(SurfaceCell), n, to, PackSurfaceCell, &mine, &cells->n, (void **)&cells->cell));
  PetscCall(PetscFree(to));
  PetscCall(PetscFree(cell));
  PetscCall(PetscMalloc1(cells->n * 3, &cells->centre));
  for (PetscInt i = 0; i < cells->n; i++) PetscCall(PetscArraycpy(&cells->centre[3 * i], cells->cell[i].centre, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeCells(SurfaceCells *cells)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(cells->cell));
  PetscCall(PetscFree(cells->centre));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Visitor for BoxTreeClosest(). Of centres at equal distance the first one counts. */
static void VisitCentre(void *context, int i, double *bound)
{
  Nearest        *nearest  = context;
  const PetscReal distance = FaceDistance(nearest->point, &nearest->cells->centre[3 * i]);

  if (distance > *bound || (distance == *bound && nearest->closest >= 0 && nearest->closest < i)) return;
  nearest->closest = i;
  *bound           = distance;
}

static PetscErrorCode LinkPair(const SliceMesh *slice, int slave_group, int master_group, CellLinks *links)
{
  SurfaceCells slave, master;
  BoxTree      tree;

  PetscFunctionBeginUser;
  PetscCall(FindCells(slice, slave_group, &slave));
  PetscCall(FindCells(slice, master_group, &master));
  PetscCheck(!BoxTreeBuild(3, (int)master.n, master.centre, master.centre, &tree), PETSC_COMM_SELF, PETSC_ERR_MEM,
             "no memory for %" PetscInt_FMT " cells", master.n);
  PetscCall(PetscRealloc((links->n + slave.n) * 2 * sizeof(PetscInt), &links->cell));
  for (PetscInt i = 0; i < slave.n; i++) {
    Nearest   nearest = {.cells = &master, .point = &slave.centre[3 * i], .closest = -1};
    PetscReal bound   = LINK_REACH * slave.cell[i].size;

    BoxTreeClosest(tree, nearest.point, NULL, &bound, VisitCentre, &nearest);
    if (nearest.closest < 0 || master.cell[nearest.closest].cell == slave.cell[i].cell) continue;
    links->cell[2 * links->n]       = slave.cell[i].cell;
    links->cell[2 * links->n++ + 1] = master.cell[nearest.closest].cell;
  }
  BoxTreeDestroy(&tree);
  PetscCall(FreeCells(&slave));
  PetscCall(FreeCells(&master));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceLinksFind - finds cells that face each other across contact in the reference configuration.

  Collective

  Input Parameters:
+ scene - its contact pairs; analytic masters and rigid tools have no cells
. slice - after SliceGroupsFind()
- mesh  - names of the groups

  Output Parameter:
. links - on the first rank: each cell of a slave with the nearest cell of its master, by the distance of their centres

  Note:
  CellGraphCreate() frees them.
@*/
PetscErrorCode SliceLinksFind(Scene scene, const SliceMesh *slice, Mesh mesh, CellLinks *links)
{
  PetscFunctionBeginUser;
  *links = (CellLinks){0};
  for (int i = 0; i < scene->n_contacts; i++) {
    const SceneContact *pair   = &scene->contacts[i];
    const int           slave  = MeshFindGroup(mesh, scene->dim - 1, pair->slave);
    const int           master = pair->master ? MeshFindGroup(mesh, scene->dim - 1, pair->master) : -1;

    if (slave >= 0 && master >= 0) PetscCall(LinkPair(slice, slave, master, links));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
