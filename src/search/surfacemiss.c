/* How far the smooth surface of a master misses the nodes that it stands for. */
#include "searchimpl.h"

/* Adds to the sums of a face's nodes how far the fit about each one misses it, and one to its count. A node without a
   fit is met by its facets. sums: [n_nodes][dim + 1]. */
static PetscErrorCode AddFace(FitSupport *fit, PetscInt candidate, const Facet *face, PetscReal *sums)
{
  const int      dim     = fit->lists->dim;
  const Element *element = ElementGet(face->type);

  PetscFunctionBeginUser;
  for (int a = 0; a < element->nodes; a++) {
    FitFoot          at  = {.facet = candidate, .xi = {element->node[a][0], element->node[a][1]}};
    const PetscReal *x   = &fit->view.x[fit->view.facets[candidate].nodes[a] * dim];
    PetscReal       *sum = &sums[face->nodes[a] * (dim + 1)];
    FitProblem       problem;
    FitResult        result;
    int              rung;

    for (int d = 0; d < dim; d++) at.X[d] = at.foot[d] = x[d];
    for (int d = 0; d < 3; d++) at.outward[d] = fit->normals[3 * candidate + d];
    PetscCall(FitSupportClimb(fit, &at, RUNG_PLAIN, &problem, &result, &rung));
    sum[dim]++;
    for (int d = 0; d < dim && rung != RUNG_FACET; d++) sum[d] += result.gap * result.normal[d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Visits this rank's own faces. */
static PetscErrorCode AddFaces(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal *sums)
{
  MasterFits fits;

  PetscFunctionBeginUser;
  PetscCall(MasterFitsCreate(s, u, t, NULL, &fits));
  for (PetscInt f = 0; f < s->master->n_faces; f++) {
    const Facet *face = &s->master->faces[f];

    PetscCall(AddFace(&fits.fit, SearchFieldOwn(&fits.field, face) - fits.field.candidates, face, sums));
  }
  PetscCall(MasterFitsDestroy(&fits));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchMasterMiss - finds how far the smooth surface of a deformable master misses its nodes.

  Collective

  Input Parameters:
+ s - the search, whose lists come with fits
. u - local displacements u[n_nodes*dim] (length), ghosts included
- t - load parameter

  Output Parameter:
. miss - from the smooth surface to each node, 0 elsewhere; miss[n_nodes*dim] (length), ghosts included

  Note:
  A surface that is fitted to nodes that are moved by this is nearer to them by one order: twicing, Tukey, Exploratory
  Data Analysis (1977).
@*/
PetscErrorCode SearchMasterMiss(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal *miss)
{
  const Mesh mesh = s->mesh;
  const int  dim  = mesh->dim;
  PetscReal *sums;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * (dim + 1), &sums));
  PetscCall(AddFaces(s, u, t, sums));
  PetscCall(MeshSumNodes(mesh, dim + 1, sums));
  for (PetscInt n = 0; n < mesh->n_nodes; n++)
    for (int d = 0; d < dim; d++)
      miss[n * dim + d] = sums[n * (dim + 1) + dim] > 0 ? sums[n * (dim + 1) + d] / sums[n * (dim + 1) + dim] : 0;
  PetscCall(PetscFree(sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}
