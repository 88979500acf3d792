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

/* Handles the box of an image of face f. */
typedef void (*NearVisit)(PetscInt f, const PetscReal box[6], void *context);

/* Visits the boxes of this rank's faces of a surface, and those of all images of a master's. some: which faces; NULL:
   all. */
static void VisitBoxes(ContactSearch s, ContactSurface surface, const PetscBool *some, const PetscReal *u, PetscReal t,
                       NearVisit visit, void *context)
{
  const int       dim    = s->mesh->dim;
  const PetscBool master = (PetscBool)(surface == s->master);

  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const int nodes = ElementGet(surface->faces[f].type)->nodes;
    PetscReal x[FACE_MAX_NODES * 3], y[3], box[6];

    if (some && !some[f]) continue;
    SearchFacePositions(s, surface, f, u, t, x);
    for (int m = 0; m < (master ? s->n_images : 1); m++) {
      if (master && s->images[m].left_out) continue;
      SearchBoxEmpty(box);
      for (int a = 0; a < nodes; a++) {
        for (int d = 0; d < dim; d++) y[d] = x[a * dim + d];
        if (master) SurfaceReflect(&s->images[m], dim, &x[a * dim], y);
        SearchBoxAdd(box, dim, y);
      }
      visit(f, box, context);
    }
  }
}

static void AddBox(PetscInt f, const PetscReal box[6], void *context)
{
  PetscReal *all = context;

  (void)f;
  SearchBoxAdd(all, 3, box);
  SearchBoxAdd(all, 3, &box[3]);
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

/* Makes the grid of a surface and of its images for tests at a distance. Collective. */
static PetscErrorCode GridCreate(ContactSearch s, ContactSurface surface, const PetscBool *some, const PetscReal *u,
                                 PetscReal t, PetscReal distance, NearGrid *grid)
{
  const int most = s->mesh->dim == 2 ? NEAR_CELLS_2D : NEAR_CELLS_3D;
  PetscReal all[6], upper[3];
  int       cells = 1;

  PetscFunctionBeginUser;
  grid->dim = s->mesh->dim;
  SearchBoxEmpty(all);
  VisitBoxes(s, surface, some, u, t, AddBox, all);
  PetscCallMPI(MPI_Allreduce(all, grid->lower, 3, MPIU_REAL, MPIU_MIN, s->mesh->comm));
  PetscCallMPI(MPI_Allreduce(&all[3], upper, 3, MPIU_REAL, MPIU_MAX, s->mesh->comm));
  for (int d = 0; d < 3; d++) {
    const PetscReal length = upper[d] - grid->lower[d];

    grid->size[d] = PetscMax(distance, length / most);
    grid->n[d]    = d < grid->dim && length > 0 ? PetscMin(most, 1 + (int)(length / grid->size[d])) : 1;
    cells *= grid->n[d];
  }
  PetscCall(PetscCalloc1(cells, &grid->met));
  VisitBoxes(s, surface, some, u, t, MarkCells, grid);
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
  const ContactSurface side[2] = {s->slaves->surface, s->master};
  PetscBool *const     near[2] = {slave, master};
  const PetscBool      tested  = SearchTestsPartners(s);

  PetscFunctionBeginUser;
  ToolsPlace(s->mesh, u, t);
  if (tested) PetscCall(SearchPartnersFaces(s, u, t, motion, slave));
  if (tested && !s->partners.any) PetscCall(PetscArrayzero(master, s->master->n_faces));
  if (tested && !s->partners.any) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = tested ? 1 : 0; k < 2; k++) {
    NearTest test = {.distance = SearchListsDistance(s, motion), .near = near[k]};
    NearGrid grid;

    PetscCall(GridCreate(s, side[1 - k], tested ? slave : NULL, u, t, test.distance, &grid));
    PetscCall(PetscArrayzero(near[k], side[k]->n_faces));
    test.grid = &grid;
    VisitBoxes(s, side[k], NULL, u, t, TestFace, &test);
    PetscCall(PetscFree(grid.met));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
