/* Strain and energy density at the nodes, for output. */
#include "elasticityimpl.h"
#include "kernels/pointstrain.h"

/* Adds the share of one cell to its nodes. */
static void AddCell(Elasticity e, CellGroup *g, PetscInt slot, const PetscReal *u, PetscReal *strain, PetscReal *weight)
{
  const Element  *element = ElementGet(g->kernel.type);
  const PetscInt *nodes   = &e->mesh->cell_nodes[e->mesh->cell_ptr[g->cell[slot]]];
  PetscReal       X[MAX_DOFS], cell_u[MAX_DOFS], constants[MATERIAL_MAX_CONSTANTS], m[MIXED_PRESSURES], volume = 0;
  PetscReal       points[ELEMENT_MAX_POINTS * 6], energy[ELEMENT_MAX_POINTS], volumes[ELEMENT_MAX_POINTS];

  ElasticityGatherCell(e, g, slot, u, X, cell_u, constants, m);
  ElementPointStrain(&g->kernel, X, cell_u, constants, m, points, energy);
  ElementPointVolumes(g->kernel.type, element->dim, g->kernel.geometry, X, volumes);
  for (int p = 0; p < element->points; p++) volume += volumes[p];
  for (int a = 0; a < element->nodes; a++) {
    PetscReal *node = &strain[nodes[a] * STRAIN_FIELDS];

    weight[nodes[a]] += volume;
    for (int p = 0; p < element->points; p++) {
      for (int c = 0; c < 6; c++) node[c] += volume * element->fit[a][p] * points[p * 6 + c];
      node[6] += volume * element->fit[a][p] * energy[p];
    }
  }
}

/*@
  ElasticityNodalStrain - computes this rank's share of strain and energy density at the nodes.

  Not collective

  Input Parameters:
+ e - the elasticity
- u - local displacements (length) [n_nodes*dim]

  Output Parameters:
+ strain - volume of the cells around a node times the strain there [n_nodes*STRAIN_FIELDS]: xx yy zz xy yz xz, then the
           energy per reference volume, NaN of laws with a state
- weight - volume of the cells around a node [n_nodes]

  Note:
  As in ElasticityNodalStress().
@*/
PetscErrorCode ElasticityNodalStrain(Elasticity e, const PetscReal *u, PetscReal *strain, PetscReal *weight)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(strain, e->mesh->n_nodes * STRAIN_FIELDS));
  PetscCall(PetscArrayzero(weight, e->mesh->n_nodes));
  for (int g = 0; g < e->n_groups; g++)
    for (PetscInt slot = 0; slot < e->groups[g].n_cells; slot++) AddCell(e, &e->groups[g], slot, u, strain, weight);
  PetscFunctionReturn(PETSC_SUCCESS);
}
