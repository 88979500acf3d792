#include "bodies/loosebody.h"

/* LooseBodies - names of the deformable bodies none of whose displacements is prescribed, into text[size].

   Collective. A body that is held in one direction only is not among them: this is a hint for a message, not a proof.
 */
PetscErrorCode LooseBodies(Mesh mesh, Scene scene, Loads loads, char *text, size_t size)
{
  PetscInt *held;
  size_t    used;

  PetscFunctionBeginUser;
  text[0] = '\0';
  PetscCall(PetscCalloc1(scene->n_bodies, &held));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt k = mesh->cell_ptr[c]; k < mesh->cell_ptr[c + 1]; k++)
      for (int d = 0; d < mesh->dim; d++)
        held[mesh->cell_body[c]] += LoadsPrescribed(loads, mesh->cell_nodes[k] * mesh->dim + d) ? 1 : 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, held, scene->n_bodies, MPIU_INT, MPI_SUM, mesh->comm));
  for (int b = 0; b < scene->n_bodies; b++) {
    if (held[b] || scene->bodies[b].rigid) continue;
    PetscCall(PetscStrlen(text, &used));
    PetscCall(PetscSNPrintf(text + used, size - used, "%s'%s'", used ? ", " : "", scene->bodies[b].name));
  }
  PetscCall(PetscFree(held));
  PetscFunctionReturn(PETSC_SUCCESS);
}
