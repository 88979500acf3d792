/* Bodies whose volume is enclosed, see enclosedbodies.h. */
#include "enclosedbodies.h"
#include "base/complaint.h"
#include "base/refusal.h"
#include "kernels/elementkernel.h"
#include "mesh/mesh.h"
#include "mesh/meshdofs.h"
#include "mesh/pressurenodes.h"

/* Derivatives of the volume of a body by its nodes are zero below this part of the largest one: interior nodes have
   round-off only. */
#define ENCLOSED_ROUND_OFF 1e-8

/* Adds the derivatives of the volume of a body by its nodes: the forces of a uniform pressure 1. */
static void AddVolumeGradient(Mesh mesh, Geometry geometry, PetscInt body, PetscReal *gradient)
{
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt *nodes = &mesh->cell_nodes[mesh->cell_ptr[c]];
    const int       n     = ElementGet(mesh->cell_type[c])->nodes;
    PetscReal       X[ELEMENT_MAX_NODES * 3], f[ELEMENT_MAX_NODES * 3];

    if (mesh->cell_body[c] != body) continue;
    MeshGatherNodes(mesh, n, nodes, mesh->coords, X);
    CellVolumeGradient(mesh->cell_type[c], mesh->dim, geometry, X, f);
    for (int a = 0; a < n * mesh->dim; a++) gradient[nodes[a / mesh->dim] * mesh->dim + a % mesh->dim] += f[a];
  }
}

/* Finds out whether the volume of a body is enclosed. */
static PetscErrorCode FindEnclosed(Mesh mesh, Scene scene, const PetscBool *prescribed, PetscInt body,
                                   PetscBool *enclosed)
{
  const PetscInt n          = mesh->n_nodes * mesh->dim;
  PetscReal      largest[2] = {0, 0}; /* of all nodes, of those that are free */
  PetscReal     *gradient;
  PetscMPIInt    rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscCalloc1(n, &gradient));
  AddVolumeGradient(mesh, scene->geometry, body, gradient);
  PetscCall(MeshSumNodes(mesh, mesh->dim, gradient));
  for (PetscInt d = 0; d < n; d++) {
    largest[0] = PetscMax(largest[0], PetscAbsReal(gradient[d]));
    if (!prescribed[d] && mesh->node_owner[d / mesh->dim] == rank)
      largest[1] = PetscMax(largest[1], PetscAbsReal(gradient[d]));
  }
  PetscCall(PetscFree(gradient));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest, 2, MPIU_REAL, MPI_MAX, mesh->comm));
  *enclosed = (PetscBool)(largest[1] <= ENCLOSED_ROUND_OFF * largest[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses an enclosed body whose nodes have pressures: nothing would tell an impossible change of its volume. */
static PetscErrorCode RefusePressureNodes(Mesh mesh, Scene scene, PetscInt body)
{
  Complaint complaint = {""};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells && !complaint.text[0]; c++)
    if (mesh->cell_body[c] == body && CellHasPressureNodes(mesh, scene, c))
      Complain(&complaint,
               "%s: body '%s' keeps its volume exactly, and displacements are prescribed on its whole surface: its "
               "pressure is not determined, which mixed tri3 and tet4 do not treat; allowed: mesh.order: 2, or nu "
               "below 0.5",
               SceneWhere(scene, scene->bodies[body].path, "material"), scene->bodies[body].name);
  PetscCall(ComplaintRefuse(mesh->comm, &complaint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  EnclosedBodiesFind - finds bodies that keep their volume exactly and have no free node whose motion would change it.

  Collective

  Input Parameters:
+ mesh       - the mesh
. scene      - its bodies, of which enclosed and condensed are set
- prescribed - whether a displacement is supported or imposed [n_nodes*dim]

  Note:
  The pressure of such a body is determined up to a constant only; its mean becomes zero, which needs pressures of
  elements. Those of second order condense theirs. A body with cells that cannot do so is refused.
@*/
PetscErrorCode EnclosedBodiesFind(Mesh mesh, Scene scene, const PetscBool *prescribed)
{
  PetscFunctionBeginUser;
  for (int b = 0; b < scene->n_bodies; b++) {
    SceneBody *body     = &scene->bodies[b];
    PetscBool  enclosed = PETSC_FALSE;

    if (body->rigid || body->formulation != FORMULATION_MIXED || !PetscIsInfReal(body->material.constants[0])) continue;
    PetscCall(FindEnclosed(mesh, scene, prescribed, b, &enclosed));
    if (!enclosed && body->enclosed)
      PetscCall(RefuseInput(mesh->comm,
                            "%s: body '%s' keeps its volume exactly, and displacements are prescribed on its whole "
                            "surface in some steps only; allowed: in all of them or in none, or nu below 0.5",
                            SceneWhere(scene, body->path, "material"), body->name));
    if (!enclosed) continue;
    body->enclosed = body->condensed = 1;
    PetscCall(RefusePressureNodes(mesh, scene, b));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
