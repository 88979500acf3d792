/* A round patch of a contact surface, see surfacepatch.h. */
#include "surfacepatch.h"
#include "facequadrature.h"

/* How much a point counts. X: its reference place (length). */
static PetscReal PatchWeight(int dim, const PetscReal *X, const PetscReal middle[3], PetscReal radius)
{
  PetscReal square = 0;

  for (int d = 0; d < dim; d++) square += PetscSqr((X[d] - middle[d]) / radius);
  return square < 1 ? PetscSqr(1 - square) : 0;
}

/* The mean of a pressure p over a patch is a sum of nodal forces F_a = int N_a p dA, each times a coefficient c_a,
   where sum c_a N_a stands for the weight w of the patch. The best c belong to the projection of w: with the mass
   matrix M and its sums of rows A, c = M^-1 W, W_a = int N_a w dA. Of the series c = (1 + (1 - A^-1 M) + ...) A^-1 W
   two terms are taken: the second one takes away the error of the first, which is of the square of the faces' size, as
   nodal forces are means of p and their sum is one more. It is left out where it is above this part of the first, all
   nodes together: such a patch is hardly wider than a face, and the series tells nothing. A tenth of it is left at
   most. */
#define PATCH_RESOLVED (1.0 / 3)

/* As the arguments of SurfacePatchAreas(). */
typedef struct {
  PetscBool        hats;
  const PetscReal *middle;
  PetscReal        radius;
} Patch;

/* Adds int N_a f dA of one face at its nodes. f is the weight of the patch, or that of values at the nodes. whole gets
   the areas and may be NULL. */
static void AddFace(ContactSurface surface, Geometry geometry, const Patch *patch, PetscInt f, const PetscReal *value,
                    PetscReal *sum, PetscReal *whole)
{
  const Mesh      mesh  = surface->mesh;
  const int       dim   = mesh->dim;
  const Facet    *face  = &surface->faces[f];
  const FaceRule *rule  = FaceRuleGet(face->type, FACE_RULE_FINEST);
  const int       nodes = ElementGet(face->type)->nodes;
  double          x[FACE_MAX_NODES * 3], part[FACE_RULE_POINTS];

  for (int a = 0; a < nodes; a++)
    for (int d = 0; d < dim; d++) x[a * dim + d] = mesh->coords[face->nodes[a] * dim + d];
  FaceRuleAreas(rule, face->type, dim, geometry, x, part, NULL);
  for (int q = 0; q < rule->n; q++) {
    const double *spread = patch->hats ? rule->hat[q] : rule->N[q];
    PetscReal     X[3] = {0}, here = 0;

    for (int d = 0; d < dim; d++) {
      X[d] = mesh->centre[d];
      for (int a = 0; a < nodes; a++) X[d] += rule->N[q][a] * x[a * dim + d];
    }
    if (value)
      for (int a = 0; a < nodes; a++) here += spread[a] * value[face->nodes[a]];
    else
      here = PatchWeight(dim, X, patch->middle, patch->radius);
    for (int a = 0; a < nodes; a++) {
      sum[face->nodes[a]] += here * part[q] * spread[a];
      if (whole) whole[face->nodes[a]] += part[q] * spread[a];
    }
  }
}

/* Tells whether the second term of the series is small against the first: `again` has M A^-1 W. */
static PetscErrorCode PatchIsResolved(Mesh mesh, const PetscReal *area, const PetscReal *again, PetscBool *resolved)
{
  PetscReal   sum[2] = {0};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    if (mesh->node_owner[n] != rank) continue;
    sum[0] += PetscAbsReal(area[n] - again[n]);
    sum[1] += PetscAbsReal(area[n]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPIU_SUM, mesh->comm));
  *resolved = (PetscBool)(sum[0] <= PATCH_RESOLVED * sum[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfacePatchAreas - computes what the pressure of each node of a surface, its force over its area, counts in a mean
  over a round patch, in the reference configuration.

  Collective

  Input Parameters:
+ surface  - a deformable surface
. geometry - axisymmetric areas are over 360 degrees
. hats     - PETSC_TRUE: with the hat functions of surface-to-surface contact in the place of the shape functions
. middle   - of the patch, reference coordinates, not relative to the mesh's centre (length)
- radius   - of the patch (length)

  Output Parameter:
. area - area[n_nodes], complete on every copy of a node, 0 off the patch
@*/
PetscErrorCode SurfacePatchAreas(ContactSurface surface, Geometry geometry, PetscBool hats, const PetscReal middle[3],
                                 PetscReal radius, PetscReal *area)
{
  const Mesh  mesh  = surface->mesh;
  const Patch patch = {hats, middle, radius};
  PetscReal  *whole, *weight, *again;
  PetscBool   resolved;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(mesh->n_nodes, &whole, mesh->n_nodes, &weight, mesh->n_nodes, &again));
  PetscCall(PetscArrayzero(area, mesh->n_nodes));
  for (PetscInt f = 0; f < surface->n_faces; f++) AddFace(surface, geometry, &patch, f, NULL, area, whole);
  PetscCall(MeshSumNodes(mesh, 1, area));
  PetscCall(MeshSumNodes(mesh, 1, whole));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) weight[n] = whole[n] > 0 ? area[n] / whole[n] : 0;
  for (PetscInt f = 0; f < surface->n_faces; f++) AddFace(surface, geometry, &patch, f, weight, again, NULL);
  PetscCall(MeshSumNodes(mesh, 1, again));
  PetscCall(PatchIsResolved(mesh, area, again, &resolved));
  for (PetscInt n = 0; n < mesh->n_nodes && resolved; n++) area[n] += area[n] - again[n];
  PetscCall(PetscFree3(whole, weight, again));
  PetscFunctionReturn(PETSC_SUCCESS);
}
