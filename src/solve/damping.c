/* Springs at the dofs of all bodies, see damping.h. */
#include "solve/damping.h"
#include "kernels/elementkernel.h"

/* Gives each node of a cell an equal part of the cell's volume, at each of its dofs. Tools have none. */
static PetscErrorCode NodeVolumes(Mesh mesh, Scene scene, PetscReal *volume)
{
  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt first = mesh->cell_ptr[c], n = mesh->cell_ptr[c + 1] - first;
    PetscReal      X[ELEMENT_MAX_NODES * 3], part;

    MeshCellCoordinates(mesh, c, X);
    part = CellVolume(mesh->cell_type[c], mesh->dim, scene->geometry, X) / (PetscReal)n;
    for (PetscInt k = 0; k < n; k++)
      for (int d = 0; d < mesh->dim; d++) volume[mesh->cell_nodes[first + k] * mesh->dim + d] += part;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DampingCreate - makes the springs, with a scale of 0.

  Collective

  Input Parameters:
+ mesh  - the mesh
. scene - its geometry
- like  - a vector of the free dofs, whose layout is taken

  Output Parameter:
. damping - free it with DofSpringsDestroy()
@*/
PetscErrorCode DampingCreate(Mesh mesh, Scene scene, Vec like, DofSprings *damping)
{
  PetscReal *volume;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &volume));
  PetscCall(NodeVolumes(mesh, scene, volume));
  PetscCall(DofSpringsCreate(mesh, volume, like, damping));
  DofSpringsScale(*damping, 0);
  PetscCall(PetscFree(volume));
  PetscFunctionReturn(PETSC_SUCCESS);
}
