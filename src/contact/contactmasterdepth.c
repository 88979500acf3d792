/* Penetration measured from the master's side: how deep its nodes stand in the slave. For reports. */
#include "contactimpl.h"

/* Adds to the depth that is allowed in each face what the overlaps before any load leave there, and takes off what the
   scene adds to them: the lowest g_0 of the face's nodes that carry a term. */
static PetscErrorCode AllowOverlap(Contact contact, const ContactPair *pair, PetscReal t, PetscReal *allowed)
{
  const Mesh mesh = contact->mesh;
  PetscReal *offset, *terms;

  PetscFunctionBeginUser;
  if (pair->scene->initial_overlap != OVERLAP_RAMP && pair->scene->initial_overlap != OVERLAP_IGNORE &&
      pair->scene->initial_overlap != OVERLAP_ADD)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(mesh->n_nodes, &offset, mesh->n_nodes, &terms));
  for (PetscInt c = 0; c < pair->n_nodes; c++) {
    offset[pair->node[c]] = ContactTermOverlap(pair, c, t);
    for (PetscInt i = pair->first_side[c]; i < pair->first_side[c + 1]; i++)
      offset[pair->node[c]] = PetscMin(offset[pair->node[c]], ContactTermOverlap(pair, i, t));
    terms[pair->node[c]] = 1;
  }
  PetscCall(MeshSumNodes(mesh, 1, offset));
  PetscCall(MeshSumNodes(mesh, 1, terms));
  for (PetscInt f = 0; f < pair->slave->n_faces; f++) {
    const Facet *face = &pair->slave->faces[f];
    PetscReal    most = PETSC_MIN_REAL;

    for (int a = 0; a < ElementGet(face->type)->nodes; a++)
      if (terms[face->nodes[a]] > 0) most = PetscMax(most, -offset[face->nodes[a]]);
    if (most > PETSC_MIN_REAL) allowed[f] += most;
  }
  PetscCall(PetscFree2(offset, terms));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairMasterDepth - measures how deep the master's nodes stand in the slave.

  Collective

  Input Parameters:
+ contact - the contact
. p       - number of the pair
. u       - local displacements of the present state, u[n_nodes*dim] (length)
- t       - its load parameter

  Output Parameter:
. depth - the same on all ranks; no nodes where the master is analytic, or where it is a slave too

  Note:
  Depths do not count that first-order facets of a concave slave explain, nor overlaps that initial_overlap leaves;
  overlaps that it adds do count. The search is made when this is called first.
@*/
PetscErrorCode ContactPairMasterDepth(Contact contact, int p, const PetscReal *u, PetscReal t, NodeDepth *depth)
{
  ContactPair *pair = &contact->pairs[p];
  PetscReal   *allowed;

  PetscFunctionBeginUser;
  *depth = (NodeDepth){.tag = -1};
  if (!pair->master || pair->scene->share < 1) PetscFunctionReturn(PETSC_SUCCESS);
  if (!pair->depths)
    PetscCall(NodeDepthsCreate(contact->mesh, contact->scene, contact->loads, pair->slave, pair->master, pair->n_images,
                               pair->images, &pair->depths));
  PetscCall(PetscMalloc1(pair->slave->n_faces, &allowed));
  PetscCall(NodeDepthsSagitta(pair->depths, pair->fit.feature_angle, allowed));
  PetscCall(AllowOverlap(contact, pair, t, allowed));
  PetscCall(NodeDepthsMeasure(pair->depths, u, t, allowed, depth));
  PetscCall(PetscFree(allowed));
  PetscFunctionReturn(PETSC_SUCCESS);
}
