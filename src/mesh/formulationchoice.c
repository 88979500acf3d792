/* Which formulation a body or a contact pair takes, by the shape of its cells. */
#include "mesh/mesh.h"
#include "kernels/elementkernel.h"
#include "formulationchoice.h"

/* Says for each body whether a cell of it in the slice has a kernel of its formulation. */
static void FindServed(Scene scene, const SliceMesh *slice, PetscBool *served)
{
  for (PetscInt c = 0; c < slice->n_cells; c++) {
    const int        b      = slice->cell_body[c];
    const KernelCase kernel = {.type        = slice->cell_block[c]->element->type,
                               .geometry    = scene->geometry,
                               .formulation = scene->bodies[b].formulation};

    served[b] = (PetscBool)(served[b] || ElementKernelExists(&kernel));
  }
}

/*@
  FormulationsChoose - gives bodies for which fbar was chosen, and of which no cell has it, another formulation.

  Collective

  Input Parameters:
+ scene - its bodies, of which formulation may change
. slice - after SliceRead()
- mesh  - its communicator

  Note:
  Plastic flow keeps volumes, and triangles and tetrahedra of first order with full integration lock then: a strip that
  is bent to four times its thickness needs 32 % too much force, with pressures at the nodes 3 %. Those make the tangent
  one of a saddle, which the iterative solver cannot take, and routines of the user have no split into shape and volume;
  there the integration is full.
@*/
PetscErrorCode FormulationsChoose(Scene scene, const SliceMesh *slice, Mesh mesh)
{
  PetscBool *served;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(scene->n_bodies, &served));
  FindServed(scene, slice, served);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, served, scene->n_bodies, MPIU_BOOL, MPI_LOR, mesh->comm));
  for (int b = 0; b < scene->n_bodies; b++) {
    SceneBody      *body = &scene->bodies[b];
    const PetscBool mixes =
      (PetscBool)(body->material.law == MATERIAL_VON_MISES && scene->solver.type != SOLVER_ITERATIVE);

    if (body->rigid || !body->chosen || served[b]) continue;
    if (body->formulation == FORMULATION_FBAR) body->formulation = mixes ? FORMULATION_MIXED : FORMULATION_FULL;
  }
  PetscCall(PetscFree(served));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FormulationsCrowded - gives up the pressures at nodes of a plastic body that has them by choice.

  Not collective

  Input Parameter:
. body - its nodes hold as many other pressures as they can
@*/
void FormulationsCrowded(SceneBody *body)
{
  if (body->chosen && body->material.law == MATERIAL_VON_MISES && body->formulation == FORMULATION_MIXED)
    body->formulation = FORMULATION_FULL;
}

/*@
  ContactFormulationsChoose - measures the gap to an analytic master on the faces of the slave, where these are 6-node
  triangles.

  Collective

  Input Parameters:
+ scene - its contact pairs, of which formulation may change where it was chosen
. slice - after SliceGroupsFind()
- mesh  - names of the groups

  Note:
  Corners of 6-node triangles have no part of the face's area. Node to surface would leave them without a force, and a
  tool would go into the body there.
@*/
PetscErrorCode ContactFormulationsChoose(Scene scene, const SliceMesh *slice, Mesh mesh)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_contacts; i++) {
    SceneContact *contact = &scene->contacts[i];
    const int     group   = contact->slave ? MeshFindGroup(mesh, scene->dim - 1, contact->slave) : -1;
    int           corners = 0;

    if (!contact->formulation_chosen || contact->formulation == CONTACT_SURFACE_TO_SURFACE) continue;
    for (PetscInt f = 0; f < slice->n_faces && !corners; f++)
      corners =
        slice->faces[f].group == group &&
        slice->cell_block[slice->faces[f].cell - slice->cell_start[slice->rank]]->element->type == ELEMENT_TET10;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &corners, 1, MPI_INT, MPI_MAX, mesh->comm));
    if (corners) contact->formulation = CONTACT_SURFACE_TO_SURFACE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
