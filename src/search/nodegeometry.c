/* Normals, spacing and fit weights of the nodes of a master surface, summed over faces and ranks. */
#include "kernels/elementkernel.h"
#include "search/nodegeometry.h"

/* Entries of a node's sums, in the order in which they are summed over ranks. */
enum {
  SUM_NORMAL     = 0,
  SUM_COVARIANCE = 3,
  SUM_PAIRS      = 9,
  SUM_AREA       = 10,
  SUM_FACES      = 11,
  SUM_TRIBUTARY  = 12,
  SUMS           = 13
};

/*@
  SurfaceNodesPerFace - returns how many nodes a face of this type brings to a surface that many such faces tile.

  Not collective

  Input Parameter:
. type - of the face

  Note:
  The area per node is the area of the face over this number.
@*/
PetscReal SurfaceNodesPerFace(ElementType type)
{
  switch (type) {
  case ELEMENT_TRI3: return 0.5;
  case ELEMENT_TRI6: return 2;
  case ELEMENT_QUAD9: return 4;
  case ELEMENT_EDGE3: return 2;
  default: return 1;
  }
}

static PetscErrorCode SumOverRanks(ContactSurface surface, PetscInt block, PetscReal *values)
{
  PetscFunctionBeginUser;
  if (surface->group)
    PetscCall(MeshSumNodes(surface->mesh, block, values)); /* a rigid tool is complete on every rank */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void FaceNodePositions(ContactSurface surface, const Facet *face, const PetscReal *x, double *X)
{
  const int dim = surface->mesh->dim;

  for (int a = 0; a < ElementGet(face->type)->nodes; a++)
    for (int d = 0; d < dim; d++) X[a * dim + d] = x[face->nodes[a] * dim + d];
}

/* Adds a face to the sums of its nodes: normal, distances to the other nodes, area. */
static void AddFace(ContactSurface surface, Geometry geometry, const Facet *face, const PetscReal *x,
                    const PetscReal *reference, PetscReal *sums)
{
  const int      dim = surface->mesh->dim, n = ElementGet(face->type)->nodes;
  const Geometry plane = dim == 3 ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN;
  double         X[FACE_MAX_NODES * 3], area[FACE_MAX_NODES] = {0}, tributary[FACE_MAX_NODES] = {0},
                                normal[FACE_MAX_NODES * 3] = {0}, total = 0;

  FaceNodePositions(surface, face, reference, X);
  FaceAreaKernel(face->type, dim, geometry, X, tributary, NULL);
  FaceNodePositions(surface, face, x, X);
  FaceAreaKernel(face->type, dim, plane, X, area, normal);
  for (int a = 0; a < n; a++) total += area[a];
  for (int a = 0; a < n; a++) {
    PetscReal *sum = &sums[face->nodes[a] * SUMS];

    for (int d = 0; d < dim; d++) sum[SUM_NORMAL + d] += normal[a * dim + d];
    for (int b = 0; b < n; b++) {
      PetscReal r[3] = {0, 0, 0};

      if (b == a) continue;
      for (int d = 0; d < dim; d++) r[d] = X[b * dim + d] - X[a * dim + d];
      for (int k = 0; k < 3; k++) {
        sum[SUM_COVARIANCE + k] += r[k] * r[k];
        sum[SUM_COVARIANCE + 3 + k] += r[k] * r[(k + 1) % 3]; /* xy yz zx */
      }
      sum[SUM_PAIRS] += 1;
    }
    sum[SUM_AREA] += total / SurfaceNodesPerFace(face->type);
    sum[SUM_FACES] += 1;
    sum[SUM_TRIBUTARY] += tributary[a];
  }
}

/* Averages the covariances over the nodes of the faces around a node. */
static PetscErrorCode AverageOverRing(ContactSurface surface, const PetscBool *some, const PetscReal *sums,
                                      PetscReal *ring)
{
  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const Facet *face = &surface->faces[f];
    const int    m    = ElementGet(face->type)->nodes;

    if (some && !some[f]) continue;
    for (int a = 0; a < m; a++) {
      for (int b = 0; b < m; b++) {
        const PetscReal *sum = &sums[face->nodes[b] * SUMS];

        for (int k = 0; k < 6; k++) ring[7 * face->nodes[a] + k] += sum[SUM_COVARIANCE + k] / sum[SUM_PAIRS];
        ring[7 * face->nodes[a] + 6] += 1;
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Present positions of the nodes of the surface's mesh or tool, of all or of those that are counted. */
static PetscErrorCode Positions(ContactSurface surface, Loads loads, const PetscReal *u, PetscReal t, PetscInt n,
                                const PetscBool *counts, PetscReal *x)
{
  const int dim = surface->mesh->dim;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    if (counts && !counts[i]) continue;
    if (surface->group) {
      for (int d = 0; d < dim; d++) x[i * dim + d] = surface->mesh->coords[i * dim + d] + u[i * dim + d];
    } else {
      PetscReal X[3] = {0, 0, 0}, y[3];

      for (int d = 0; d < dim; d++) X[d] = surface->rigid->coords[i * dim + d];
      LoadsRigidMotion(loads, surface->body, t, X, y);
      for (int d = 0; d < dim; d++) x[i * dim + d] = y[d];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the nodes of some faces. Where ranks sum the values of nodes, all nodes have values. */
static PetscErrorCode MarkNodes(ContactSurface surface, const PetscBool *some, PetscInt n, PetscBool *counts)
{
  PetscMPIInt ranks;
  PetscBool   all;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(surface->mesh->comm, &ranks));
  all = (PetscBool)(!some || (surface->group && ranks > 1));
  for (PetscInt i = 0; i < n; i++) counts[i] = all;
  for (PetscInt f = 0; f < surface->n_faces && !all; f++) {
    if (!some[f]) continue;
    for (int a = 0; a < ElementGet(surface->faces[f].type)->nodes; a++) counts[surface->faces[f].nodes[a]] = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceNodeGeometry - computes normals, spacing with its shape, and fit weights of the nodes of a master surface.

  Collective

  Input Parameters:
+ surface  - the master
. geometry - of the scene; axisymmetric weights grow with the radius
. loads    - gives the position of rigid tools
. u        - local displacements u[n_nodes*dim] (length)
. t        - load parameter
- some     - which faces of this rank count; NULL: all

  Output Parameter:
. nodes - one for each local node of the mesh, or of the rigid tool, complete on every copy of a node; those off the
          surface are 0. With `some` only nodes are set around which two rings of faces count, on all ranks

  Note:
  The shape of the spacing comes from the covariance of the one-ring, averaged over the ring's nodes. Its size comes
  from the mean area of the faces. So a support of s spacings holds about pi s^2 nodes on any mesh.
@*/
PetscErrorCode SurfaceNodeGeometry(ContactSurface surface, Geometry geometry, Loads loads, const PetscReal *u,
                                   PetscReal t, const PetscBool *some, NodeGeometry *nodes)
{
  const int        dim       = surface->mesh->dim;
  const PetscInt   n         = surface->group ? surface->mesh->n_nodes : surface->rigid->n_nodes;
  const PetscReal *reference = surface->group ? surface->mesh->coords : surface->rigid->coords;
  const PetscBool  weighted  = (PetscBool)(surface->order > 1 || geometry == GEOMETRY_AXISYMMETRIC);
  const PetscReal  area_unit = PetscPowRealInt(surface->mean_size, geometry == GEOMETRY_PLANE_STRAIN ? 1 : 2);
  PetscReal       *x, *sums, *ring;
  PetscBool       *counts;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n * dim, &x, n * SUMS, &sums, n * 7, &ring, n, &counts));
  PetscCall(MarkNodes(surface, some, n, counts));
  for (PetscInt i = 0; i < n; i++) {
    if (!counts[i]) continue;
    PetscCall(PetscArrayzero(&sums[i * SUMS], SUMS));
    PetscCall(PetscArrayzero(&ring[i * 7], 7));
  }
  PetscCall(Positions(surface, loads, u, t, n, counts, x));
  for (PetscInt f = 0; f < surface->n_faces; f++)
    if (!some || some[f]) AddFace(surface, geometry, &surface->faces[f], x, reference, sums);
  PetscCall(SumOverRanks(surface, SUMS, sums));
  PetscCall(AverageOverRing(surface, some, sums, ring));
  PetscCall(SumOverRanks(surface, 7, ring));
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal *sum = &sums[i * SUMS];
    PetscReal        area, length = 0;

    if (!counts[i]) continue;
    area = sum[SUM_FACES] > 0 ? sum[SUM_AREA] / sum[SUM_FACES] : 0;
    nodes[i] = (NodeGeometry){.spacing = dim == 3 ? PetscSqrtReal(area) : area,
                              .weight  = weighted ? sum[SUM_TRIBUTARY] / area_unit : 1};
    for (int d = 0; d < 3; d++) length += PetscSqr(sum[SUM_NORMAL + d]);
    length = PetscSqrtReal(length);
    for (int d = 0; d < 3 && length > 0; d++) nodes[i].normal[d] = sum[SUM_NORMAL + d] / length;
    for (int k = 0; k < 6 && ring[7 * i + 6] > 0; k++) nodes[i].covariance[k] = ring[7 * i + k] / ring[7 * i + 6];
  }
  PetscCall(PetscFree4(x, sums, ring, counts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Area vector of a face at positions x. */
static void FaceVector(ContactSurface surface, const Facet *face, const PetscReal *x, PetscReal vector[3])
{
  const int dim = surface->mesh->dim;
  double    X[FACE_MAX_NODES * 3], area[FACE_MAX_NODES] = {0}, normal[FACE_MAX_NODES * 3] = {0};

  FaceNodePositions(surface, face, x, X);
  FaceAreaKernel(face->type, dim, dim == 3 ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN, X, area, normal);
  vector[0] = vector[1] = vector[2] = 0;
  for (int a = 0; a < ElementGet(face->type)->nodes; a++)
    for (int d = 0; d < dim; d++) vector[d] += normal[a * dim + d];
}

static PetscReal VectorLength(const PetscReal v[3])
{
  return PetscSqrtReal(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/*@
  SurfaceMeanNormal - computes the normal of one reference plane for a surface with its mirror images, and how far the
  faces turn from it.

  Collective

  Input Parameters:
+ surface  - the surface
. loads    - gives the position of rigid tools
. n_images - number of mirror images
. images   - the images; along an axis that they mirror the normals of the whole cancel
. u        - local displacements u[n_nodes*dim] (length)
- t        - load parameter

  Output Parameters:
+ normal - area-weighted mean, unit; (0, 0, 0) for a closed surface
- cosine - smallest cosine between a face's normal and it, over all ranks; may be NULL
@*/
PetscErrorCode SurfaceMeanNormal(ContactSurface surface, Loads loads, int n_images, const SurfaceImage *images,
                                 const PetscReal *u, PetscReal t, PetscReal normal[3], PetscReal *cosine)
{
  const PetscInt n = surface->group ? surface->mesh->n_nodes : surface->rigid->n_nodes;
  PetscReal     *x, vector[3], length;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * surface->mesh->dim, &x));
  PetscCall(Positions(surface, loads, u, t, n, NULL, x));
  normal[0] = normal[1] = normal[2] = 0;
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    FaceVector(surface, &surface->faces[f], x, vector);
    for (int d = 0; d < 3; d++) normal[d] += vector[d];
  }
  if (surface->group) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, normal, 3, MPIU_REAL, MPI_SUM, surface->mesh->comm));
  for (int m = 0; m < n_images; m++) {
    for (int d = 0; d < 3; d++) normal[d] = images[m].sign[d] < 0 ? 0 : normal[d];
  }
  length = VectorLength(normal);
  for (int d = 0; d < 3 && length > 0; d++) normal[d] /= length;
  if (cosine) {
    *cosine = 1;
    for (PetscInt f = 0; f < surface->n_faces; f++) {
      FaceVector(surface, &surface->faces[f], x, vector);
      *cosine = PetscMin(*cosine, (vector[0] * normal[0] + vector[1] * normal[1] + vector[2] * normal[2]) /
                                    VectorLength(vector));
    }
    if (surface->group) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, cosine, 1, MPIU_REAL, MPI_MIN, surface->mesh->comm));
  }
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
