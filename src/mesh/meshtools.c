/* Rigid tools with free motions and their nodes, see meshtools.h. */
#include "meshtools.h"
#include "kernels/elementkernel.h"

/* A bolt whose length is kept gives way by this part of its elastic elongation in a step. It is far below what any mesh
   resolves, and leaves a linear solver nine of the sixteen digits. */
#define BOLT_GIVE 1e-6

/* Adds a tool if its motion has free components. */
static PetscErrorCode AddTool(Mesh mesh, Motion *motion, const char *name, int body, int contact)
{
  PetscFunctionBeginUser;
  if (motion->n_free)
    mesh->tools[mesh->n_tools++] = (MeshTool){.name = name, .motion = motion, .body = body, .contact = contact};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshToolsList - lists the scene's tools with free motions.

  Not collective

  Input Parameters:
+ scene - the scene, which keeps names and motions
- mesh  - its tools are set, without nodes
@*/
PetscErrorCode MeshToolsList(Scene scene, Mesh mesh)
{
  static const char *const shapes[] = {"plane", "cylinder", "sphere"};

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(scene->n_bodies + scene->n_contacts, &mesh->tools));
  for (int b = 0; b < scene->n_bodies; b++)
    PetscCall(AddTool(mesh, &scene->bodies[b].motion, scene->bodies[b].name, b, -1));
  for (int c = 0; c < scene->n_contacts; c++)
    PetscCall(AddTool(mesh, &scene->contacts[c].motion, scene->contacts[c].name, -1, c));
  for (int k = 0; k < mesh->n_tools; k++) {
    MeshTool           *tool    = &mesh->tools[k];
    const SceneContact *contact = tool->contact < 0 ? NULL : &scene->contacts[tool->contact];

    tool->bolt = tool->body >= 0 && scene->bodies[tool->body].bolt ? &scene->bodies[tool->body] : NULL;
    if (contact)
      PetscCall(PetscSNPrintf(tool->path, sizeof(tool->path), "contact.%d.master.%s", tool->contact,
                              shapes[contact->analytic.shape]));
    else
      PetscCall(
        PetscSNPrintf(tool->path, sizeof(tool->path), "bodies.%d.%s", tool->body, tool->bolt ? "pretension" : "rigid"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshToolsPlaceNodes - fills the arrays of the tools' nodes, but for their owners.

  Collective

  Input Parameter:
. mesh - its nodes, with those of the cells filled in

  Note:
  Their ids follow those of the nodes of cells and pressures. They have no tag in gmsh's file, and 0 stands for it.
@*/
PetscErrorCode MeshToolsPlaceNodes(Mesh mesh)
{
  PetscInt last = -1;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < mesh->n_body_nodes; i++) last = PetscMax(last, mesh->node_id[i]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &last, 1, MPIU_INT, MPI_MAX, mesh->comm));
  mesh->n_body_global = last + 1;
  for (int k = 0; k < mesh->n_tools; k++) {
    MeshTool *tool   = &mesh->tools[k];
    PetscReal square = 0;

    tool->node = mesh->n_body_nodes + mesh->n_pressure_nodes + TOOL_NODES * k;
    for (int d = 0; d < mesh->dim; d++) square += PetscSqr(tool->motion->point[d] - mesh->centre[d]);
    tool->arm = PetscSqrtReal(square) + mesh->size / 2; /* no place on the bodies is farther from the point */
    for (int i = 0; i < TOOL_NODES; i++) {
      const PetscInt node = tool->node + i;

      mesh->node_id[node]  = (mesh->has_pressures ? 2 : 1) * mesh->n_body_global + TOOL_NODES * k + i;
      mesh->node_tag[node] = 0;
      for (int d = 0; d < mesh->dim; d++) mesh->coords[node * mesh->dim + d] = tool->motion->point[d] - mesh->centre[d];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshToolsMeasureBolts - measures the bodies that are tightened as bolts.

  Collective

  Input Parameters:
+ scene - the scene
- mesh  - distributed; length and stiffness of its bolts are set
@*/
PetscErrorCode MeshToolsMeasureBolts(Scene scene, Mesh mesh)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < mesh->n_tools; k++) {
    MeshTool *tool    = &mesh->tools[k];
    PetscReal ends[2] = {PETSC_MIN_REAL, PETSC_MIN_REAL}; /* -lowest, highest */
    PetscReal volume  = 0;

    if (!tool->bolt) continue;
    for (PetscInt c = 0; c < mesh->n_cells; c++) {
      const PetscInt n = mesh->cell_ptr[c + 1] - mesh->cell_ptr[c];
      PetscReal      X[ELEMENT_MAX_NODES * 3];

      if (mesh->cell_body[c] != tool->body) continue;
      for (PetscInt a = 0; a < n * mesh->dim; a++)
        X[a] = mesh->coords[mesh->cell_nodes[mesh->cell_ptr[c] + a / mesh->dim] * mesh->dim + a % mesh->dim];
      volume += CellVolume(mesh->cell_type[c], mesh->dim, scene->geometry, X);
      for (PetscInt a = 0; a < n; a++) {
        PetscReal along = 0;

        for (int d = 0; d < mesh->dim; d++) along += tool->bolt->axis[d] * X[a * mesh->dim + d];
        ends[0] = PetscMax(ends[0], -along);
        ends[1] = PetscMax(ends[1], along);
      }
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, ends, 2, MPIU_REAL, MPI_MAX, mesh->comm));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &volume, 1, MPIU_REAL, MPI_SUM, mesh->comm));
    tool->length    = ends[0] + ends[1];
    tool->stiffness = tool->bolt->material.E * volume / PetscSqr(tool->length) / BOLT_GIVE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
