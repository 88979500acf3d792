/* Bodies that share nodes but no face, see hinges.h. */
#include "bodies/hinges.h"

/* Marks the local nodes of each body, on[n_bodies][n_nodes], complete on every copy of a node. */
static PetscErrorCode MarkBodies(Mesh mesh, int n_bodies, char *on)
{
  PetscReal *mark;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes, &mark));
  for (int b = 0; b < n_bodies; b++) {
    PetscCall(PetscArrayzero(mark, mesh->n_nodes));
    for (PetscInt c = 0; c < mesh->n_cells; c++)
      for (PetscInt k = mesh->cell_ptr[c]; mesh->cell_body[c] == b && k < mesh->cell_ptr[c + 1]; k++)
        mark[mesh->cell_nodes[k]] = 1;
    PetscCall(MeshSumNodes(mesh, 1, mark));
    for (PetscInt n = 0; n < mesh->n_nodes; n++) on[b * mesh->n_nodes + n] = mark[n] > 0;
  }
  PetscCall(PetscFree(mark));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether a cell has a face all of whose nodes are on another body. */
static PetscBool CellMeets(Mesh mesh, PetscInt c, const char *on)
{
  const Element *e = ElementGet(mesh->cell_type[c]);

  for (int f = 0; f < e->faces; f++) {
    PetscBool all = PETSC_TRUE;

    for (int a = 0; a < ElementGet(e->face_type)->nodes; a++)
      all = (PetscBool)(all && on[mesh->cell_nodes[mesh->cell_ptr[c] + e->face_nodes[f][a]]]);
    if (all) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Counts for each two bodies the nodes and the cells with a face that they share: count[n_bodies][n_bodies] of owned
   nodes, faces[n_bodies][n_bodies], and the smallest tag of a node, of all ranks. */
static PetscErrorCode CountShared(Mesh mesh, int n_bodies, const char *on, PetscInt *count, PetscInt *faces,
                                  PetscInt *tag)
{
  const PetscMPIInt n = n_bodies * n_bodies;
  PetscMPIInt       rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  for (int i = 0; i < n; i++) {
    count[i] = faces[i] = 0;
    tag[i]              = PETSC_MAX_INT;
  }
  for (int a = 0; a < n_bodies; a++) {
    for (int b = 0; b < a; b++) {
      for (PetscInt k = 0; k < mesh->n_nodes; k++) {
        if (!on[a * mesh->n_nodes + k] || !on[b * mesh->n_nodes + k] || mesh->node_owner[k] != rank) continue;
        count[a * n_bodies + b]++;
        tag[a * n_bodies + b] = PetscMin(tag[a * n_bodies + b], mesh->node_tag[k]);
      }
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, n, MPIU_INT, MPI_SUM, mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, tag, n, MPIU_INT, MPI_MIN, mesh->comm));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const int a = mesh->cell_body[c];

    for (int b = 0; b < a; b++)
      if (count[a * n_bodies + b]) faces[a * n_bodies + b] += CellMeets(mesh, c, &on[b * mesh->n_nodes]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, faces, n, MPIU_INT, MPI_SUM, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  HingesWarn - warns of bodies that share nodes but no face.

  Collective

  Input Parameters:
+ mesh   - the mesh
. scene  - names the bodies
- stream - of rank 0, which prints

  Note:
  A tangent along the hinge is singular unless something else holds both bodies, and no contact is found there, because
  a node of both has no master.
@*/
PetscErrorCode HingesWarn(Mesh mesh, Scene scene, FILE *stream)
{
  const int   n = scene->n_bodies;
  PetscInt   *count, *faces, *tag;
  char       *on;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  if (n < 2) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscMalloc1(n * mesh->n_nodes, &on));
  PetscCall(PetscMalloc3(n * n, &count, n * n, &faces, n * n, &tag));
  PetscCall(MarkBodies(mesh, n, on));
  PetscCall(CountShared(mesh, n, on, count, faces, tag));
  for (int a = 0; a < n && !rank; a++)
    for (int b = 0; b < a; b++)
      if (count[a * n + b] && !faces[a * n + b])
        fprintf(stream,
                "burnish: warning: '%s' and '%s' share %" PetscInt_FMT " node%s, as node %" PetscInt_FMT
                ", but no face: they hinge there; has the mesher merged points in which they touch?\n",
                scene->bodies[b].name, scene->bodies[a].name, count[a * n + b], count[a * n + b] > 1 ? "s" : "",
                tag[a * n + b]);
  PetscCall(PetscFree3(count, faces, tag));
  PetscCall(PetscFree(on));
  PetscFunctionReturn(PETSC_SUCCESS);
}
