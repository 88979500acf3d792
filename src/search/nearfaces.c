/* Faces of slave and master that are near the other side, found without a search: by a grid over the other side. */
#include "searchimpl.h"

/* The grid has at most this many cells along each axis, 4096 in the plane and 32768 in space, which ranks exchange. */
#define NEAR_CELLS_2D 64
#define NEAR_CELLS_3D 32

/* Cells that a surface meets. */
typedef struct {
  int            dim, n[3];
  PetscReal      lower[3], size[3]; /* of the grid and of a cell (length) */
  unsigned char *met;
} NearGrid;

/* A side of the search as the grids see it. */
typedef struct {
  ContactSurface   surface;
  const PetscBool *some;   /* these faces count; NULL: all */
  PetscReal        all[6]; /* box of the faces that count, with their images, over all ranks */
} NearSide;

/* Handles the box of an image of face f. */
typedef void (*NearVisit)(PetscInt f, const PetscReal box[6], void *context);

/* Visits the boxes of a face, and those of all its images where it is a master's. */
static void VisitFace(ContactSearch s, ContactSurface surface, PetscInt f, const PetscReal *u, PetscReal t,
                      NearVisit visit, void *context)
{
  const int       dim = s->mesh->dim, nodes = ElementGet(surface->faces[f].type)->nodes;
  const PetscBool master = (PetscBool)(surface == s->master);
  PetscReal       x[FACE_MAX_NODES * 3], box[6];

  SearchFacePositions(s, surface, f, u, t, x);
  for (int m = 0; m < (master ? s->n_images : 1); m++) {
    if (master && s->images[m].left_out) continue;
    SearchFaceBox(dim, nodes, x, master ? &s->images[m] : NULL, box);
    visit(f, box, context);
  }
}

/* Visits the faces of a side within a distance of a box, or where some count, all of these. */
static PetscErrorCode VisitNear(ContactSearch s, const NearSide *side, const PetscReal *u, PetscReal t,
                                const PetscReal near[6], PetscReal distance, NearVisit visit, void *context)
{
  PetscInt n = 0, *faces = NULL;

  PetscFunctionBeginUser;
  for (PetscInt f = 0; side->some && f < side->surface->n_faces; f++)
    if (side->some[f]) VisitFace(s, side->surface, f, u, t, visit, context);
  if (!side->some) PetscCall(SearchNearBox(s, side->surface, u, t, near, distance, &n, &faces));
  for (PetscInt i = 0; i < n; i++) VisitFace(s, side->surface, faces[i], u, t, visit, context);
  PetscCall(PetscFree(faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void AddBox(PetscInt f, const PetscReal box[6], void *context)
{
  PetscReal *all = context;

  (void)f;
  SearchBoxAdd(all, 3, box);
  SearchBoxAdd(all, 3, &box[3]);
}

/* Takes in the boxes of all blocks of a deformable side, with the images of a master's. */
static PetscErrorCode AddBlocks(ContactSearch s, const NearSide *side, const PetscReal *u, PetscReal all[6])
{
  const int       dim    = s->mesh->dim;
  const PetscBool master = (PetscBool)(side->surface == s->master);
  FaceBlocks      blocks;

  PetscFunctionBeginUser;
  PetscCall(SearchBlocks(s, side->surface, u, &blocks));
  for (int m = 0; m < (master ? s->n_images : 1); m++) {
    if (master && s->images[m].left_out) continue;
    for (PetscInt i = 0; i < 2 * blocks->n; i++) {
      PetscReal x[3] = {0, 0, 0};

      for (int d = 0; d < dim; d++) x[d] = blocks->box[3 * i + d];
      if (master) SurfaceReflect(&s->images[m], dim, &blocks->box[3 * i], x);
      SearchBoxAdd(all, 3, x);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the box of a side over all ranks. Of a tool, the faces count that are within a distance of the other side. */
static PetscErrorCode SideBox(ContactSearch s, const PetscReal *u, PetscReal t, const NearSide *other,
                              PetscReal distance, NearSide *side)
{
  PetscFunctionBeginUser;
  SearchBoxEmpty(s->mesh->dim, side->all);
  if (side->surface->rigid || side->some)
    PetscCall(VisitNear(s, side, u, t, other->all, distance, AddBox, side->all));
  else
    PetscCall(AddBlocks(s, side, u, side->all));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, side->all, 3, MPIU_REAL, MPIU_MIN, s->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &side->all[3], 3, MPIU_REAL, MPIU_MAX, s->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells from first[d] to last[d] that a box meets; none where last[d] < first[d]. */
static void CellsOf(const NearGrid *grid, const PetscReal box[6], PetscReal distance, int first[3], int last[3])
{
  for (int d = 0; d < 3; d++) {
    const PetscReal low  = d < grid->dim ? (box[d] - distance - grid->lower[d]) / grid->size[d] : 0,
                    high = d < grid->dim ? (box[3 + d] + distance - grid->lower[d]) / grid->size[d] : 0;

    first[d] = low > 0 ? (int)PetscMin(low, grid->n[d]) : 0;
    last[d]  = high >= 0 ? (int)PetscMin(high, grid->n[d] - 1) : -1;
  }
}

static void MarkCells(PetscInt f, const PetscReal box[6], void *context)
{
  NearGrid *grid = context;
  int       first[3], last[3];

  (void)f;
  CellsOf(grid, box, 0, first, last);
  for (int k = first[2]; k <= last[2]; k++)
    for (int j = first[1]; j <= last[1]; j++)
      for (int i = first[0]; i <= last[0]; i++) grid->met[(k * grid->n[1] + j) * grid->n[0] + i] = 1;
}

/* Makes the grid of a side for tests of the other one at a distance. Faces leave no mark that are farther from the
   other side than this and a cell. Collective. */
static PetscErrorCode GridCreate(ContactSearch s, const NearSide *side, const NearSide *other, const PetscReal *u,
                                 PetscReal t, PetscReal distance, NearGrid *grid)
{
  const int most  = s->mesh->dim == 2 ? NEAR_CELLS_2D : NEAR_CELLS_3D;
  PetscReal reach = distance;
  int       cells = 1;

  PetscFunctionBeginUser;
  grid->dim = s->mesh->dim;
  for (int d = 0; d < 3; d++) {
    const PetscReal length = side->all[3 + d] - side->all[d];

    grid->lower[d] = side->all[d];
    grid->size[d]  = PetscMax(distance, length / most);
    grid->n[d]     = d < grid->dim && length > 0 ? PetscMin(most, 1 + (int)(length / grid->size[d])) : 1;
    cells *= grid->n[d];
    reach = PetscMax(reach, distance + 2 * grid->size[d]);
  }
  PetscCall(PetscCalloc1(cells, &grid->met));
  PetscCall(VisitNear(s, side, u, t, other->all, reach, MarkCells, grid));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, grid->met, cells, MPI_UNSIGNED_CHAR, MPI_MAX, s->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  const NearGrid *grid;
  PetscReal       distance;
  PetscBool      *near;
} NearTest;

static void TestFace(PetscInt f, const PetscReal box[6], void *context)
{
  const NearTest *test = context;
  const NearGrid *grid = test->grid;
  int             first[3], last[3];

  if (test->near[f]) return;
  CellsOf(grid, box, test->distance, first, last);
  for (int k = first[2]; k <= last[2] && !test->near[f]; k++)
    for (int j = first[1]; j <= last[1] && !test->near[f]; j++)
      for (int i = first[0]; i <= last[0] && !test->near[f]; i++)
        if (grid->met[(k * grid->n[1] + j) * grid->n[0] + i]) test->near[f] = PETSC_TRUE;
}

/*@
  SearchNearFaces - finds the faces of this rank that a search may need: those near the other side.

  Collective

  Input Parameters:
+ s      - the search; it has a master
. u      - local displacements u[mesh n_nodes*dim] (length), ghosts included
. t      - load parameter, for rigid tools
- motion - relative motion (length) for which lists are to be good

  Output Parameters:
+ slave  - slave[faces of the slave on this rank]: PETSC_FALSE where no image of the master is near
- master - master[faces of the master on this rank]: PETSC_FALSE where no face of the slave is near an image of it

  Note:
  A face that is not near is farther from the other side than SearchLists() collects faces, or has no partner on its own
  body. The converse does not hold: boxes and cells of a grid are compared. The answer does not depend on the ranks.
@*/
PetscErrorCode SearchNearFaces(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal motion, PetscBool *slave,
                               PetscBool *master)
{
  PetscBool *const near[2]  = {slave, master};
  const PetscBool  tested   = SearchTestsPartners(s);
  const PetscReal  distance = SearchListsDistance(s, motion);
  NearSide         side[2]  = {{.surface = s->slaves->surface, .some = tested ? slave : NULL}, {.surface = s->master}};

  PetscFunctionBeginUser;
  ToolsPlace(s->mesh, u, t);
  for (int k = 0; k < 2; k++) PetscCall(PetscArrayzero(near[k], side[k].surface->n_faces));
  if (tested) PetscCall(SearchPartnersFaces(s, u, t, motion, slave));
  if (tested && !s->partners.any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SearchStateBegin(s));
  for (int k = 0; k < 2; k++) PetscCall(SideBox(s, u, t, &side[0], distance, &side[k]));
  for (int k = tested ? 1 : 0; k < 2; k++) {
    NearGrid grid;
    NearTest test = {.grid = &grid, .distance = distance, .near = near[k]};

    PetscCall(GridCreate(s, &side[1 - k], &side[k], u, t, distance, &grid));
    PetscCall(VisitNear(s, &side[k], u, t, side[1 - k].all, (1 + SEARCH_ON_PLANE) * distance, TestFace, &test));
    PetscCall(PetscFree(grid.met));
  }
  PetscCall(SearchStateEnd(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
