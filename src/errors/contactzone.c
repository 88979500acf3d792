/* The cells behind surfaces in contact, see contactzone.h. */
#include "errors/contactzone.h"
#include "mesh/meshdofs.h"
#include "mesh/meshgroup.h"
#include "mesh/meshsizes.h"
#include <math.h>

/* A face is in contact where a node of it bears more than this part of the largest nodal force of the pair. Fits spread
   small forces over the master's nodes beyond the zone's end. */
#define ZONE_LEAST_FORCE 0.01

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

/* Marks the cells behind the faces of a surface that are in contact, where these are wanted, and adds their forces and
   the logarithms of their sizes, weighted with these, to sum; to faces the numbers of those that are and are not. */
static void MarkFaces(Mesh mesh, const MeshGroup *group, const PetscReal *force, PetscReal least, const PetscReal *size,
                      PetscBool *cells, PetscReal sum[2], PetscReal faces[2])
{
  for (PetscInt f = 0; group && f < group->n_faces; f++) {
    PetscInt  nodes[FACE_MAX_NODES];
    const int n    = ElementGet(MeshFaceNodes(mesh, group, f, nodes))->nodes;
    PetscReal most = 0, total = 0;

    for (int k = 0; k < n; k++) {
      most = PetscMax(most, force[nodes[k]]);
      total += force[nodes[k]];
    }
    faces[most > least ? 0 : 1]++;
    if (!(most > least)) continue;
    if (cells) cells[group->face_cell[f]] = PETSC_TRUE;
    sum[0] += total;
    sum[1] += total * PetscLogReal(size[group->face_cell[f]]);
  }
}

/*@
  ContactZoneFind - finds the cells behind surfaces in contact.

  Collective

  Input Parameter:
. model - at its solution

  Output Parameters:
+ cells - for each local cell: a face of it is in contact; NULL: not wanted
- zone  - the same on all ranks
@*/
PetscErrorCode ContactZoneFind(Model model, PetscBool *cells, ContactZone *zone)
{
  const Mesh mesh   = model->mesh;
  PetscReal  sum[4] = {0, 0, 0, 0}, of_masters[2] = {0, 0}, *force, *sizes, *measure;

  PetscFunctionBeginUser;
  if (cells) PetscCall(PetscArrayzero(cells, mesh->n_cells));
  PetscCall(PetscCalloc3(mesh->n_nodes, &force, mesh->n_cells, &sizes, mesh->n_cells, &measure));
  MeshCellSizes(mesh, sizes, measure);
  for (int p = 0; p < ContactPairs(model->contact); p++) {
    ContactSides sides;
    PetscReal    most;

    PetscCall(NodalForces(model, p, force, &most));
    ContactPairSides(model->contact, p, &sides);
    MarkFaces(mesh, sides.slave->group, force, ZONE_LEAST_FORCE * most, sizes, cells, sum, &sum[2]);
    if (sides.master)
      MarkFaces(mesh, sides.master->group, force, ZONE_LEAST_FORCE * most, sizes, cells, sum, of_masters);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPIU_SUM, mesh->comm));
  *zone = (ContactZone){.size  = sum[0] > 0 ? PetscExpReal(sum[1] / sum[0]) : 0,
                        .faces = sum[2],
                        .ends  = (PetscBool)(sum[0] > 0 && sum[3] > 0)};
  PetscCall(PetscFree3(force, sizes, measure));
  PetscFunctionReturn(PETSC_SUCCESS);
}
