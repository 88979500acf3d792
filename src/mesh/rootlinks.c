/* Links between slave and master cells, found by a box tree of cell centres. */
#include "rootlinks.h"
#include "mesh/meshgroup.h"
#include "base/boxtree.h"

/* Largest distance of the centres of linked cells, as a multiple of the slave cell's size. Cells farther apart may
   never touch. Without this limit, all cells of a surface that faces an edge from a distance would be linked to one
   cell. */
#define LINK_REACH 4

/* The cells of a surface, with the centres of their nodes. */
typedef struct {
  PetscInt   n, *cell;
  PetscReal *centre; /* n*3 */
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

static void CellCentre(const RootMesh *root, PetscInt cell, PetscReal centre[3])
{
  const PetscInt *nodes = RootMeshCellNodes(root, cell);
  const int       n     = root->cell_block[cell]->nodes;

  for (int d = 0; d < 3; d++) {
    centre[d] = 0;
    for (int k = 0; k < n; k++) centre[d] += root->gmsh.coords[3 * nodes[k] + d] / n;
  }
}

/* Returns twice the largest distance of a node from the centre. */
static PetscReal CellSize(const RootMesh *root, PetscInt cell, const PetscReal centre[3])
{
  const PetscInt *nodes = RootMeshCellNodes(root, cell);
  PetscReal       size  = 0;

  for (int k = 0; k < root->cell_block[cell]->nodes; k++)
    size = PetscMax(size, 2 * FaceDistance(centre, &root->gmsh.coords[3 * nodes[k]]));
  return size;
}

static PetscErrorCode FindCells(const RootMesh *root, int group, SurfaceCells *cells)
{
  PetscFunctionBeginUser;
  *cells = (SurfaceCells){0};
  PetscCall(PetscMalloc1(root->n_faces, &cells->cell));
  for (PetscInt f = 0; f < root->n_faces; f++)
    if (root->faces[f].group == group) cells->cell[cells->n++] = root->faces[f].cell;
  PetscCall(PetscSortRemoveDupsInt(&cells->n, cells->cell));
  PetscCall(PetscMalloc1(cells->n * 3, &cells->centre));
  for (PetscInt i = 0; i < cells->n; i++) CellCentre(root, cells->cell[i], &cells->centre[3 * i]);
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

static PetscErrorCode LinkPair(const RootMesh *root, int slave_group, int master_group, CellLinks *links)
{
  SurfaceCells slave, master;
  BoxTree      tree;

  PetscFunctionBeginUser;
  PetscCall(FindCells(root, slave_group, &slave));
  PetscCall(FindCells(root, master_group, &master));
  PetscCheck(!BoxTreeBuild(3, (int)master.n, master.centre, master.centre, &tree), PETSC_COMM_SELF, PETSC_ERR_MEM,
             "no memory for %" PetscInt_FMT " cells", master.n);
  PetscCall(PetscRealloc((links->n + slave.n) * 2 * sizeof(PetscInt), &links->cell));
  for (PetscInt i = 0; i < slave.n; i++) {
    Nearest   nearest = {.cells = &master, .point = &slave.centre[3 * i], .closest = -1};
    PetscReal bound   = LINK_REACH * CellSize(root, slave.cell[i], nearest.point);

    BoxTreeClosest(tree, nearest.point, NULL, &bound, VisitCentre, &nearest);
    if (nearest.closest < 0 || master.cell[nearest.closest] == slave.cell[i]) continue;
    links->cell[2 * links->n]       = slave.cell[i];
    links->cell[2 * links->n++ + 1] = master.cell[nearest.closest];
  }
  BoxTreeDestroy(&tree);
  PetscCall(FreeCells(&slave));
  PetscCall(FreeCells(&master));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RootLinksFind - finds cells that face each other across contact in the reference configuration.

  Not collective, on rank 0

  Input Parameters:
+ scene - its contact pairs; analytic masters and rigid tools have no cells
. root  - after RootGroupsFind()
- mesh  - names of the groups

  Output Parameter:
. links - each cell of a slave with the nearest cell of its master, by the distance of their centres

  Note:
  The caller frees links->cell with PetscFree().
@*/
PetscErrorCode RootLinksFind(Scene scene, const RootMesh *root, Mesh mesh, CellLinks *links)
{
  PetscFunctionBeginUser;
  *links = (CellLinks){0};
  for (int i = 0; i < scene->n_contacts; i++) {
    const SceneContact *pair   = &scene->contacts[i];
    const int           slave  = MeshFindGroup(mesh, scene->dim - 1, pair->slave);
    const int           master = pair->master ? MeshFindGroup(mesh, scene->dim - 1, pair->master) : -1;

    if (slave >= 0 && master >= 0) PetscCall(LinkPair(root, slave, master, links));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
