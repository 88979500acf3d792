/* The cells behind surfaces in contact, see contactzone.h. */
#include "errors/contactzone.h"
#include "mesh/meshdofs.h"
#include "mesh/meshgroup.h"
#include "mesh/meshsizes.h"
#include <math.h>

/* A face is in contact where a node of it bears more than this part of the largest nodal force of the pair. Fits spread
   small forces over the master's nodes beyond the zone's end. */
#define ZONE_LEAST_FORCE 0.01

/* A sphere whose zone ends at a (1 + x) presses with a force that is less by this times x^2. */
#define ZONE_SPHERE 1.5

/* Sums over faces: of forces, of these times the logarithm of the cells' sizes, number of slave faces that are not in
   contact */
enum { SUM_FORCE, SUM_LOG_SIZE, SUM_OUT, SUMS };

/* Gives each node the magnitude of its force from a pair, on all ranks that have it; *most: of all of them. */
static PetscErrorCode NodalForces(Model model, int pair, PetscReal *force, PetscReal *most)
{
  const Mesh  mesh = model->mesh;
  PetscReal  *f;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &f));
  PetscCall(ContactPairStifferForces(model->contact, pair, BY_PENETRATION, f));
  *most = 0;
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    PetscReal square = 0;

    for (int d = 0; d < mesh->dim && mesh->node_owner[n] == rank; d++)
      square += f[n * mesh->dim + d] * f[n * mesh->dim + d];
    force[n] = PetscSqrtReal(square);
    *most    = PetscMax(*most, force[n]);
  }
  PetscCall(MeshSumNodes(mesh, 1, force));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 1, MPIU_REAL, MPIU_MAX, mesh->comm));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is a face in contact? Its nodes; total: sum of their forces. */
static PetscBool FaceBears(Mesh mesh, const MeshGroup *group, PetscInt face, const PetscReal *force, PetscReal least,
                           PetscInt nodes[FACE_MAX_NODES], int *corners, PetscReal *total)
{
  const Element *element = ElementGet(MeshFaceNodes(mesh, group, face, nodes));
  PetscReal      most    = 0;

  *corners = element->corners;
  *total   = 0;
  for (int k = 0; k < element->nodes; k++) {
    most = PetscMax(most, force[nodes[k]]);
    *total += force[nodes[k]];
  }
  return (PetscBool)(most > least);
}

/* Marks the cells behind the faces of a surface that are in contact, where these are wanted, and adds to the sums. */
static void MarkFaces(Mesh mesh, const MeshGroup *group, const PetscReal *force, PetscReal least, const PetscReal *size,
                      PetscBool *cells, PetscReal sum[SUMS])
{
  for (PetscInt f = 0; group && f < group->n_faces; f++) {
    PetscInt  nodes[FACE_MAX_NODES];
    PetscReal total;
    int       corners;

    if (!FaceBears(mesh, group, f, force, least, nodes, &corners, &total)) {
      sum[SUM_OUT]++;
      continue;
    }
    if (cells) cells[group->face_cell[f]] = PETSC_TRUE;
    sum[SUM_FORCE] += total;
    sum[SUM_LOG_SIZE] += total * PetscLogReal(size[group->face_cell[f]]);
  }
}

/* Marks the corners at which faces in contact meet others. */
static PetscErrorCode MarkEnd(Mesh mesh, const MeshGroup *group, const PetscReal *force, PetscReal least,
                              PetscReal *mark)
{
  PetscReal *around;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * mesh->n_nodes, &around));
  for (PetscInt f = 0; group && f < group->n_faces; f++) {
    PetscInt        nodes[FACE_MAX_NODES];
    PetscReal       total;
    int             corners;
    const PetscBool in = FaceBears(mesh, group, f, force, least, nodes, &corners, &total);

    for (int k = 0; k < corners; k++) around[2 * nodes[k] + in]++;
  }
  PetscCall(MeshSumNodes(mesh, 2, around));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) mark[n] = around[2 * n] > 0 && around[2 * n + 1] > 0;
  PetscCall(PetscFree(around));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts the layers of faces in contact between the end of the zone and its middle. */
static PetscErrorCode CountLayers(Mesh mesh, const MeshGroup *group, const PetscReal *force, PetscReal least,
                                  PetscReal *layers)
{
  PetscReal *mark, *next;
  PetscBool *taken;
  PetscInt   more = 1;

  PetscFunctionBeginUser;
  *layers = 0;
  PetscCall(PetscCalloc3(mesh->n_nodes, &mark, mesh->n_nodes, &next, group ? group->n_faces : 0, &taken));
  PetscCall(MarkEnd(mesh, group, force, least, mark));
  while (more) {
    more = 0;
    PetscCall(PetscArrayzero(next, mesh->n_nodes));
    for (PetscInt f = 0; group && f < group->n_faces; f++) {
      PetscInt  nodes[FACE_MAX_NODES];
      PetscReal total;
      int       corners;
      PetscBool touches = PETSC_FALSE;

      if (taken[f] || !FaceBears(mesh, group, f, force, least, nodes, &corners, &total)) continue;
      for (int k = 0; k < corners; k++) touches = (PetscBool)(touches || mark[nodes[k]] > 0);
      if (!touches) continue;
      taken[f] = PETSC_TRUE;
      more     = 1;
      for (int k = 0; k < corners; k++) next[nodes[k]] = 1;
    }
    PetscCall(MeshSumNodes(mesh, 1, next));
    PetscCall(PetscArraycpy(mark, next, mesh->n_nodes));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &more, 1, MPIU_INT, MPI_MAX, mesh->comm));
    *layers += (PetscReal)more;
  }
  PetscCall(PetscFree3(mark, next, taken));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums up one pair over all ranks, and counts its layers. sizes: of the cells. */
static PetscErrorCode SumPair(Model model, int pair, const PetscReal *sizes, PetscBool *cells, PetscReal sum[SUMS],
                              PetscReal *layers)
{
  const Mesh   mesh             = model->mesh;
  PetscReal    of_masters[SUMS] = {0}, most, *force;
  ContactSides sides;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(sum, SUMS));
  PetscCall(PetscCalloc1(mesh->n_nodes, &force));
  PetscCall(NodalForces(model, pair, force, &most));
  ContactPairSides(model->contact, pair, &sides);
  MarkFaces(mesh, sides.slave->group, force, ZONE_LEAST_FORCE * most, sizes, cells, sum);
  if (sides.master) MarkFaces(mesh, sides.master->group, force, ZONE_LEAST_FORCE * most, sizes, cells, of_masters);
  sum[SUM_FORCE] += of_masters[SUM_FORCE];
  sum[SUM_LOG_SIZE] += of_masters[SUM_LOG_SIZE];
  PetscCall(CountLayers(mesh, sides.slave->group, force, ZONE_LEAST_FORCE * most, layers));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, SUMS, MPIU_REAL, MPIU_SUM, mesh->comm));
  PetscCall(PetscFree(force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static ContactZone MakeZone(const PetscReal sum[SUMS], PetscReal layers)
{
  return (ContactZone){.size   = sum[SUM_FORCE] > 0 ? PetscExpReal(sum[SUM_LOG_SIZE] / sum[SUM_FORCE]) : 0,
                       .layers = layers,
                       .force  = sum[SUM_FORCE],
                       .ends   = (PetscBool)(sum[SUM_FORCE] > 0 && sum[SUM_OUT] > 0)};
}

/* Sums up the pairs from first to before end. */
static PetscErrorCode FindZone(Model model, int first, int end, PetscBool *cells, ContactZone *zone)
{
  const Mesh mesh      = model->mesh;
  PetscReal  all[SUMS] = {0}, most = 0, of_most = 0, *sizes, *measure;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(mesh->n_cells, &sizes, mesh->n_cells, &measure));
  MeshCellSizes(mesh, sizes, measure);
  for (int p = first; p < end; p++) {
    PetscReal sum[SUMS], layers = 0;

    PetscCall(SumPair(model, p, sizes, cells, sum, &layers));
    for (int s = 0; s < SUMS; s++) all[s] += sum[s];
    if (sum[SUM_FORCE] <= most) continue;
    most    = sum[SUM_FORCE];
    of_most = layers;
  }
  *zone = MakeZone(all, of_most);
  PetscCall(PetscFree2(sizes, measure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactZoneFind - finds the cells behind surfaces in contact.

  Collective

  Input Parameter:
. model - at its solution

  Output Parameters:
+ cells - for each local cell: a face of it is in contact; NULL: not wanted
- zone  - of all pairs, the same on all ranks; its layers are those of the pair with the largest forces
@*/
PetscErrorCode ContactZoneFind(Model model, PetscBool *cells, ContactZone *zone)
{
  PetscFunctionBeginUser;
  if (cells) PetscCall(PetscArrayzero(cells, model->mesh->n_cells));
  PetscCall(FindZone(model, 0, ContactPairs(model->contact), cells, zone));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactZoneOfPair - finds the zone in which the surfaces of one pair are in contact.

  Collective

  Input Parameters:
+ model - at its solution
- pair  - number of the pair

  Output Parameters:
+ cells - for each local cell: a face of it is in contact
- zone  - the same on all ranks
@*/
PetscErrorCode ContactZoneOfPair(Model model, int pair, PetscBool *cells, ContactZone *zone)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(cells, model->mesh->n_cells));
  PetscCall(FindZone(model, pair, pair + 1, cells, zone));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactZoneOff - gives how far the end of a zone may be off, over the extent of the zone: by half a face.

  Not collective

  Input Parameter:
. zone - of ContactZoneFind() or ContactZoneOfPair()
@*/
PetscReal ContactZoneOff(const ContactZone *zone)
{
  return zone->layers > 0 ? 0.5 / zone->layers : 0;
}

/*@
  ContactZoneLeft - gives what the end of a zone may leave of error, over its forces, see ContactZoneOff().

  Not collective

  Input Parameter:
. zone - of ContactZoneFind() or ContactZoneOfPair()
@*/
PetscReal ContactZoneLeft(const ContactZone *zone)
{
  return ZONE_SPHERE * PetscSqr(ContactZoneOff(zone));
}

/*@
  ContactZoneLayers - gives the layers that a zone needs to leave no more than a part of its forces.

  Not collective

  Input Parameter:
. left - the part
@*/
PetscReal ContactZoneLayers(PetscReal left)
{
  return PetscCeilReal(0.5 * PetscSqrtReal(ZONE_SPHERE / left));
}
