/* Points in cells: boxes of the cells in a tree, and the reference coordinates of a point by Newton's method. */
#include "mesh/meshlocate.h"
#include "base/boxtree.h"
#include "mesh/mesh.h"
#include <math.h>

enum {
  /* Newton's method needs one step in cells with straight edges. */
  LOCATE_ITERATIONS = 10
};
/* Reference coordinates are found when they change by less than this. */
#define LOCATE_ENOUGH 1e-9
/* A point on a curved boundary lies outside the cells whose chord stands for it, by up to this part of a cell: the
   sagitta of an edge of a tenth of a turn is a twelfth of its length. */
#define LOCATE_NEAR 0.1
/* A point that is outside by less than this, in reference coordinates, is on the boundary: round-off of the mesh's
   coordinates. */
#define LOCATE_TOUCHES 1e-6

/* Solves the dim x dim system a y = b by Cramer's rule. Returns 0 if it is singular. */
static int SolveSmall(int dim, double (*a)[3], const double *b, double *y)
{
  double determinant, column[3][3];

  for (int j = dim; j < 3; j++) a[j][j] = 1;
  determinant = a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
                a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
  if (determinant == 0) return 0;
  for (int k = 0; k < dim; k++) {
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) column[i][j] = j == k ? (i < dim ? b[i] : 0) : a[i][j];
    y[k] = (column[0][0] * (column[1][1] * column[2][2] - column[1][2] * column[2][1]) -
            column[0][1] * (column[1][0] * column[2][2] - column[1][2] * column[2][0]) +
            column[0][2] * (column[1][0] * column[2][1] - column[1][1] * column[2][0])) /
           determinant;
  }
  return 1;
}

static PetscBool IsSimplex(const Element *e)
{
  return (PetscBool)(e->corners == e->dim + 1);
}

/* Reference coordinates xi[dim] of a point in the cell, or beyond it. PETSC_FALSE: Newton's method does not find
   them. */
static PetscBool ReferencePoint(ElementType type, const double *X, const double *x, double xi[3])
{
  const Element *e      = ElementGet(type);
  const double   centre = IsSimplex(e) ? 1.0 / e->corners : 0;
  double         step   = 1;

  for (int d = 0; d < 3; d++) xi[d] = centre;
  for (int k = 0; k < LOCATE_ITERATIONS && step > LOCATE_ENOUGH; k++) {
    double N[ELEMENT_MAX_NODES], dN[ELEMENT_MAX_NODES * 3], a[3][3] = {{0}}, b[3], y[3];

    ElementShape(type, xi, N, dN, NULL);
    for (int d = 0; d < e->dim; d++) {
      b[d] = x[d];
      for (int n = 0; n < e->nodes; n++) {
        b[d] -= N[n] * X[n * e->dim + d];
        for (int j = 0; j < e->dim; j++) a[d][j] += dN[n * e->dim + j] * X[n * e->dim + d];
      }
    }
    if (!SolveSmall(e->dim, a, b, y)) return PETSC_FALSE;
    step = 0;
    for (int d = 0; d < e->dim; d++) {
      xi[d] += y[d];
      step = fmax(step, fabs(y[d]));
    }
  }
  return (PetscBool)(step <= LOCATE_ENOUGH);
}

/* How far a point is outside the cell shrunk about its centre by `core`, in reference coordinates; 0 inside. */
static double Outside(const Element *e, const double xi[3], double core)
{
  const double centre = 1.0 / e->corners;
  double       last = 1, out = 0;

  for (int d = 0; d < e->dim; d++) {
    last -= xi[d];
    out = fmax(out, IsSimplex(e) ? centre * (1 - core) - xi[d] : fabs(xi[d]) - core);
  }
  return IsSimplex(e) ? fmax(out, centre * (1 - core) - last) : out;
}

/* Does the cell, shrunk about its centre by `core` in reference coordinates, contain the point? */
static PetscBool CellContains(ElementType type, const double *X, const double *x, double core)
{
  double xi[3];

  return (PetscBool)(ReferencePoint(type, X, x, xi) && !(Outside(ElementGet(type), xi, core) > 0));
}

/* The cells of a body on this rank, as the tree's visitor needs them. */
typedef struct {
  Mesh             mesh;
  const PetscInt  *cells;
  double           core;
  const PetscReal *x;
  PetscBool        inside;
} Locate;

static void VisitCell(void *context, int index, double *bound)
{
  Locate *look = context;
  double  X[ELEMENT_MAX_NODES * 3];

  MeshCellCoordinates(look->mesh, look->cells[index], X);
  if (!CellContains(look->mesh->cell_type[look->cells[index]], X, look->x, look->core)) return;
  look->inside = PETSC_TRUE;
  *bound       = -1; /* ends the search */
}

/* The box low[dim] to high[dim] around a cell whose nodes are at X[nodes][dim]. */
static void CellBox(int dim, int nodes, const double *X, PetscReal *low, PetscReal *high)
{
  for (int d = 0; d < dim; d++) {
    low[d] = high[d] = X[d];
    for (int k = 1; k < nodes; k++) {
      low[d]  = PetscMin(low[d], X[k * dim + d]);
      high[d] = PetscMax(high[d], X[k * dim + d]);
    }
  }
}

/* Lists the cells of a body on this rank with their boxes. */
static PetscErrorCode ListCells(Mesh mesh, int body, PetscInt *n, PetscInt *cells, PetscReal *lower, PetscReal *upper)
{
  double X[ELEMENT_MAX_NODES * 3];

  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    if (mesh->cell_body[c] != body) continue;
    MeshCellCoordinates(mesh, c, X);
    CellBox(mesh->dim, ElementGet(mesh->cell_type[c])->nodes, X, &lower[*n * mesh->dim], &upper[*n * mesh->dim]);
    cells[(*n)++] = c;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshPointsInBody - says which points lie in the cells of a body, in the reference configuration.

  Collective

  Input Parameters:
+ mesh - the mesh
. body - number of the body in the scene
. core - 1: anywhere in a cell; less: in the cell shrunk about its centre by this factor
. n    - number of points, the same on all ranks
- x    - x[n*dim], relative to the mesh's centre (length), the same on all ranks

  Output Parameter:
. inside - inside[n], the same on all ranks
@*/
PetscErrorCode MeshPointsInBody(Mesh mesh, int body, double core, PetscInt n, const PetscReal *x, PetscBool *inside)
{
  PetscInt   n_cells, *cells;
  PetscReal *lower, *upper;
  int       *found;
  BoxTree    tree;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(mesh->n_cells, &cells, mesh->n_cells * mesh->dim, &lower, mesh->n_cells * mesh->dim, &upper, n,
                         &found));
  PetscCall(ListCells(mesh, body, &n_cells, cells, lower, upper));
  PetscCheck(!BoxTreeBuild(mesh->dim, (int)n_cells, lower, upper, &tree), PETSC_COMM_SELF, PETSC_ERR_MEM,
             "no memory for the tree of cells");
  for (PetscInt i = 0; i < n; i++) {
    double bound = 0; /* the boxes that hold the point */
    Locate look  = {mesh, cells, core, &x[i * mesh->dim], PETSC_FALSE};

    BoxTreeClosest(tree, look.x, NULL, &bound, VisitCell, &look);
    found[i] = look.inside;
  }
  BoxTreeDestroy(&tree);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, found, (PetscMPIInt)n, MPI_INT, MPI_LOR, mesh->comm));
  for (PetscInt i = 0; i < n; i++) inside[i] = found[i] ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscFree4(cells, lower, upper, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is the point in the box of a cell that is wider by LOCATE_NEAR of its size on every side? */
static PetscBool NearBox(int dim, int nodes, const double *X, const PetscReal *x)
{
  PetscReal low[3], high[3], size = 0;

  CellBox(dim, nodes, X, low, high);
  for (int d = 0; d < dim; d++) size = PetscMax(size, high[d] - low[d]);
  for (int d = 0; d < dim; d++)
    if (x[d] < low[d] - LOCATE_NEAR * size || x[d] > high[d] + LOCATE_NEAR * size) return PETSC_FALSE;
  return PETSC_TRUE;
}

/*@
  MeshLocatePoint - finds the cell of a body in which a point lies in the reference configuration, or beside which it
  lies by no more than the chord of a curved boundary leaves out.

  Collective

  Input Parameters:
+ mesh - the mesh
. body - number of the body in the scene
- x    - x[dim], relative to the mesh's centre (length), the same on all ranks

  Output Parameters:
+ place   - the cell, on the one rank that has it; cell is -1 on the others, and on all ranks if there is none
- outside - how far the point is outside that cell, in its reference coordinates (no unit), the same on all ranks;
            PETSC_INFINITY if there is none

  Note:
  Of several cells the one counts whose inside is nearest, then the one of the lowest rank.
@*/
PetscErrorCode MeshLocatePoint(Mesh mesh, int body, const PetscReal *x, CellPlace *place, PetscReal *outside)
{
  PetscReal   least;
  PetscMPIInt rank, first;

  PetscFunctionBeginUser;
  place->cell = -1;
  *outside    = PETSC_INFINITY;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const ElementType type = mesh->cell_type[c];
    double            X[ELEMENT_MAX_NODES * 3], xi[3], out;

    if (mesh->cell_body[c] != body) continue;
    MeshCellCoordinates(mesh, c, X);
    if (!NearBox(mesh->dim, ElementGet(type)->nodes, X, x) || !ReferencePoint(type, X, x, xi)) continue;
    out = Outside(ElementGet(type), xi, 1);
    if (out < LOCATE_TOUCHES) out = 0;
    if (!(out <= LOCATE_NEAR && out < *outside)) continue;
    *outside    = out;
    place->cell = c;
    ElementShape(type, xi, place->N, NULL, NULL);
  }
  PetscCallMPI(MPI_Allreduce(outside, &least, 1, MPIU_REAL, MPI_MIN, mesh->comm));
  first = place->cell >= 0 && *outside == least ? rank : PETSC_MPI_INT_MAX;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, mesh->comm));
  if (first != rank) place->cell = -1;
  *outside = least;
  PetscFunctionReturn(PETSC_SUCCESS);
}
