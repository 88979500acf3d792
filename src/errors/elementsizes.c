/* Sizes of the elements of the next mesh, see elementsizes.h. */
#include "errors/elementsizes.h"
#include "errors/contactzone.h"
#include "errors/singularpoints.h"
#include "mesh/meshsizes.h"

/* An element becomes at most so much smaller from one mesh to the next. */
#define SIZES_SMALLER 0.25
/* At a point where stresses have no bound and in a zone in contact it becomes at most as much smaller as else in two
   meshes. */
#define SIZES_PLACES (SIZES_SMALLER * SIZES_SMALLER)
/* Cells of a regular mesh whose size grows by 0.35 of the distance: for each factor e in distance, in a sixth of the
   plane (2 pi / 6 over 0.43, the area of a regular triangle, and the square of the growth). */
#define SIZES_GRADED 20
/* Cells with a smaller error than this part of the mean count as having this part. */
#define SIZES_LEAST_ERROR 1e-8
/* Where the zone in contact has too many elements, they become larger by this factor at a time. */
#define SIZES_ZONE_STEP 1.2
/* Halvings of the bracket of ln s. The bracket has the width of all doubles' logarithms at most. */
enum { SIZES_HALVINGS = 60 };

typedef struct {
  Mesh       mesh;
  PetscReal *weight, *error, *size; /* error to the power -1 / (2p + d); error; present size */
  PetscReal  larger;                /* a cell becomes at most so many times larger */
  PetscBool *touches;               /* the cell lies at a surface of a contact pair */
  PetscBool *zone;                  /* it is in contact there */
  PetscBool *singular;              /* it has a point with stresses without a bound as a corner */
  PetscReal  in_zone;               /* a cell of the zone has at most this part of its size */
} Present;

/* The factor on the size of a cell. */
static PetscReal Factor(const Present *p, PetscInt cell, PetscReal s)
{
  const int       power = 2 * p->mesh->order, dim = p->mesh->dim;
  const PetscReal most   = p->zone[cell] ? p->in_zone : p->touches[cell] ? 1 : p->larger;
  PetscReal       factor = s * p->weight[cell], least = SIZES_SMALLER;

  if (p->singular[cell]) {
    factor = PetscPowReal((PetscReal)power / SINGULAR_RATE * PetscPowRealInt(factor, power + dim),
                          (PetscReal)1 / (SINGULAR_RATE + dim));
    least  = SIZES_PLACES;
  }
  return PetscMin(PetscMax(factor, least), most);
}

/* New cells in the place of a cell that becomes smaller by the factor r. Around a singular point sizes grow with the
   distance, so that each factor e in distance takes as many cells. */
static PetscReal NewCells(const Present *p, PetscInt cell, PetscReal r)
{
  const int dim = p->mesh->dim;

  if (!p->singular[cell] || r >= 1) return PetscPowRealInt(r, -dim);
  return PetscPowRealInt(r, 2 - dim) * PetscMin(1 / (r * r), 1 - SIZES_GRADED * PetscLogReal(r));
}

/* Elements and error of the next mesh for the common factor s. */
static PetscErrorCode Forecast(const Present *p, PetscReal s, SizesForecast *forecast)
{
  const Mesh mesh   = p->mesh;
  PetscReal  sum[4] = {0, 0, 0, (PetscReal)mesh->n_cells_global};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscReal r = Factor(p, c, s);

    sum[0] += NewCells(p, c, r);
    sum[1] += p->error[c] * PetscPowRealInt(r, p->singular[c] ? SINGULAR_RATE : 2 * mesh->order);
    sum[2] += p->error[c];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPIU_SUM, mesh->comm));
  forecast->elements = sum[0] / sum[3];
  forecast->error    = sum[2] > 0 ? sum[1] / sum[2] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the cells with faces on a surface. */
static void MarkCells(const MeshGroup *group, PetscBool *touches)
{
  for (PetscInt f = 0; group && f < group->n_faces; f++) touches[group->face_cell[f]] = PETSC_TRUE;
}

/* Marks the cells at the surfaces of contact pairs. */
static PetscErrorCode FindTouching(Model model, PetscBool *touches)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < ContactPairs(model->contact); p++) {
    ContactSides sides;

    ContactPairSides(model->contact, p, &sides);
    MarkCells(sides.slave->group, touches);
    if (sides.master) MarkCells(sides.master->group, touches);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the errors of the cells. *least, *most: of their powers. */
static PetscErrorCode Take(const PetscReal *cell_error, Present *p, PetscReal *least, PetscReal *most)
{
  const Mesh mesh = p->mesh;
  PetscReal  sum = 0, bound[2] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL};

  PetscFunctionBeginUser;
  MeshCellSizes(mesh, p->size, p->weight);
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    p->error[c] = PetscAbsReal(cell_error[c]);
    sum += p->error[c];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPIU_SUM, mesh->comm));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscReal mean = sum > 0 ? sum / (PetscReal)mesh->n_cells_global : 1;

    p->weight[c] = PetscPowReal(PetscMax(p->error[c] / mean, SIZES_LEAST_ERROR), -1.0 / (2 * mesh->order + mesh->dim));
    bound[0]     = PetscMax(bound[0], -p->weight[c]);
    bound[1]     = PetscMax(bound[1], p->weight[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, bound, 2, MPIU_REAL, MPIU_MAX, mesh->comm));
  *least = -bound[0];
  *most  = bound[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the elements of the zone in contact no smaller than those which the largest number of elements allows. */
static PetscErrorCode BoundZone(Present *p, PetscReal s, PetscReal most)
{
  SizesForecast forecast;

  PetscFunctionBeginUser;
  p->in_zone = PetscMin(PetscMax(p->in_zone, SIZES_PLACES), 1);
  PetscCall(Forecast(p, s, &forecast));
  while (forecast.elements > most && p->in_zone < 1) {
    p->in_zone = PetscMin(SIZES_ZONE_STEP * p->in_zone, 1);
    PetscCall(Forecast(p, s, &forecast));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElementSizesFind - finds sizes of elements that leave a part of the present error.

  Collective

  Input Parameters:
+ model      - on the present mesh
. cell_error - what each local cell leaves of error; the sign does not count
. part       - of the present error that is to be left
. larger     - an element becomes at most so many times larger
. in_zone    - an element at surfaces in contact has at most this part of its present size
- most       - elements at most, over the present ones; then more error is left

  Output Parameters:
+ size     - wanted at each local cell
- forecast - of the next mesh
@*/
PetscErrorCode ElementSizesFind(Model model, const PetscReal *cell_error, PetscReal part, PetscReal larger,
                                PetscReal in_zone, PetscReal most, PetscReal *size, SizesForecast *forecast)
{
  const Mesh  mesh = model->mesh;
  Present     p    = {.mesh = mesh, .larger = larger, .in_zone = in_zone};
  PetscReal   low, high, least = 0, largest = 0;
  ContactZone zone;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc6(mesh->n_cells, &p.weight, mesh->n_cells, &p.error, mesh->n_cells, &p.size, mesh->n_cells,
                         &p.touches, mesh->n_cells, &p.zone, mesh->n_cells, &p.singular));
  PetscCall(FindTouching(model, p.touches));
  PetscCall(ContactZoneFind(model, p.zone, &zone));
  PetscCall(Take(cell_error, &p, &least, &largest));
  PetscCall(SingularCellsFind(mesh, cell_error, p.touches, p.singular));
  low  = PetscLogReal(SIZES_SMALLER / largest); /* all cells become as small, and as large, as they may */
  high = PetscLogReal(larger / least);
  PetscCall(BoundZone(&p, PetscExpReal(high), most));
  for (int k = 0; k < SIZES_HALVINGS; k++) {
    const PetscReal middle = 0.5 * (low + high);

    PetscCall(Forecast(&p, PetscExpReal(middle), forecast));
    if (forecast->error > part && forecast->elements < most)
      high = middle;
    else
      low = middle;
  }
  for (PetscInt c = 0; c < mesh->n_cells; c++) size[c] = p.size[c] * Factor(&p, c, PetscExpReal(high));
  PetscCall(PetscFree6(p.weight, p.error, p.size, p.touches, p.zone, p.singular));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ToolSizesFind - finds sizes of the elements of rigid tools: the mean of what the elements are to have that may meet
  it.

  Collective

  Input Parameters:
+ model - on the present mesh
- size  - wanted at each local cell (length)

  Output Parameter:
. tool - tool[mesh->n_rigid] (length); 0: nothing may meet it

  Note:
  The mean is the geometric one over the cells at the slaves of the pairs whose master the tool is. A mesh of a tool
  that remains as it is would leave an error which no finer mesh of the bodies takes away.
@*/
PetscErrorCode ToolSizesFind(Model model, const PetscReal *size, PetscReal *tool)
{
  const Mesh mesh = model->mesh;

  PetscFunctionBeginUser;
  for (int r = 0; r < mesh->n_rigid; r++) {
    PetscReal sum[2] = {0, 0};

    for (int p = 0; p < ContactPairs(model->contact); p++) {
      ContactSides sides;

      ContactPairSides(model->contact, p, &sides);
      if (!sides.master || sides.master->rigid != &mesh->rigid[r]) continue;
      for (PetscInt f = 0; f < sides.slave->group->n_faces; f++) {
        sum[0] += PetscLogReal(size[sides.slave->group->face_cell[f]]);
        sum[1]++;
      }
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPIU_SUM, mesh->comm));
    tool[r] = sum[1] > 0 ? PetscExpReal(sum[0] / sum[1]) : 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
