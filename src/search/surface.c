/* Contact surfaces: faces, sizes, free edges, nodal areas, mirror images. */
#include "kernels/elementkernel.h"
#include "base/refusal.h"
#include "search/surface.h"

/* Directions are distinguished by cells on the faces of a cube, with this many cells along an edge of the cube. A
   cell is some 20 degrees wide, so that normals count as opposed up to the cosine SURFACE_OPPOSED. */
enum { SURFACE_CELLS = 4, SURFACE_DIRECTIONS = 6 * SURFACE_CELLS * SURFACE_CELLS };
#define SURFACE_OPPOSED 0.25

/* Coordinates of a face's nodes, displaced by u unless u is NULL. */
static void FaceCoordinates(ContactSurface surface, const Facet *face, const PetscReal *u, double *X)
{
  Mesh             mesh   = surface->mesh;
  const PetscReal *coords = surface->rigid ? surface->rigid->coords : mesh->coords;

  for (int a = 0; a < ElementGet(face->type)->nodes; a++) {
    for (int d = 0; d < mesh->dim; d++) {
      X[a * mesh->dim + d] = coords[face->nodes[a] * mesh->dim + d] + (u ? u[face->nodes[a] * mesh->dim + d] : 0);
    }
  }
}

/* Plain area (length in 2D), also in axisymmetric scenes: sizes are lengths in the meridian. */
static PetscReal FaceArea(ContactSurface surface, const Facet *face, const double *X)
{
  const int dim                  = surface->mesh->dim;
  double    area[FACE_MAX_NODES] = {0}, sum = 0;

  FaceAreaKernel(face->type, dim, dim == 3 ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN, X, area, NULL);
  for (int a = 0; a < ElementGet(face->type)->nodes; a++) sum += area[a];
  return sum;
}

static PetscErrorCode SurfaceFacesFromGroup(ContactSurface surface)
{
  const MeshGroup *group = surface->group;

  PetscFunctionBeginUser;
  surface->n_faces = group->n_faces;
  PetscCall(PetscCalloc3(surface->n_faces, &surface->faces, surface->n_faces, &surface->face_size, surface->n_faces,
                         &surface->face_height));
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    Facet   *face = &surface->faces[f];
    PetscInt nodes[FACE_MAX_NODES];

    face->type = MeshFaceNodes(surface->mesh, group, f, nodes);
    face->tag  = (long)group->face_tag[f];
    for (int a = 0; a < ElementGet(face->type)->nodes; a++) face->nodes[a] = (int)nodes[a];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SurfaceFacesFromRigid(ContactSurface surface)
{
  const MeshRigid *rigid = surface->rigid;

  PetscFunctionBeginUser;
  surface->n_faces = rigid->n_faces;
  PetscCall(PetscCalloc3(surface->n_faces, &surface->faces, surface->n_faces, &surface->face_size, surface->n_faces,
                         &surface->face_height));
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    Facet *face = &surface->faces[f];

    face->type = rigid->face_type[f];
    face->tag  = (long)rigid->face_tag[f];
    for (int a = 0; a < ElementGet(face->type)->nodes; a++)
      face->nodes[a] = (int)rigid->face_nodes[rigid->face_ptr[f] + a];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Area of a face times the height of the element below it: the element's volume (simplices: dim times that). */
static PetscReal FaceLayer(ContactSurface surface, PetscInt f)
{
  Mesh           mesh = surface->mesh;
  const PetscInt c    = surface->group->face_cell[f];
  const Element *e    = ElementGet(mesh->cell_type[c]);
  double         X[ELEMENT_MAX_NODES * 3], volume;

  MeshCellCoordinates(mesh, c, X);
  volume = CellVolume(mesh->cell_type[c], mesh->dim, mesh->dim == 3 ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN, X);
  return volume * (e->corners == e->dim + 1 ? e->dim : 1);
}

/* Longest distance between two corners of a face. */
static PetscReal FaceExtent(int dim, const Facet *face, const double *X)
{
  PetscReal most = 0;

  for (int a = 0; a < ElementGet(face->type)->corners; a++) {
    for (int b = 0; b < a; b++) {
      PetscReal r2 = 0;

      for (int d = 0; d < dim; d++) r2 += PetscSqr(X[a * dim + d] - X[b * dim + d]);
      most = PetscMax(most, PetscSqrtReal(r2));
    }
  }
  return most;
}

/* Measures sizes and stiffness of the faces, over all ranks. */
static PetscErrorCode SurfaceMeasure(ContactSurface surface, Elasticity elasticity)
{
  Mesh      mesh   = surface->mesh;
  PetscReal sum[4] = {0, 0, 0, 0}, most[2] = {0, 0}; /* sum: area, faces, size, stiffness * area; most: size, extent */
  double    X[FACE_MAX_NODES * 3];

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    PetscReal area, layer;

    FaceCoordinates(surface, &surface->faces[f], NULL, X);
    area                  = FaceArea(surface, &surface->faces[f], X);
    surface->face_size[f] = mesh->dim == 3 ? PetscSqrtReal(area) : area;
    most[0]               = PetscMax(most[0], surface->face_size[f]);
    most[1]               = PetscMax(most[1], FaceExtent(mesh->dim, &surface->faces[f], X));
    sum[0] += area;
    sum[1] += 1;
    sum[2] += surface->face_size[f];
    if (!surface->group) continue;
    layer                   = FaceLayer(surface, f);
    surface->face_height[f] = layer / area;
    sum[3] += area * (ElasticityCellModulus(elasticity, surface->group->face_cell[f]) * area / layer);
  }
  if (surface->group) {
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPI_SUM, mesh->comm));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPI_MAX, mesh->comm));
  }
  surface->mean_size  = sum[2] / sum[1];
  surface->order      = mesh->order;
  surface->max_size   = most[0];
  surface->max_extent = most[1];
  surface->stiffness  = sum[3] / sum[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceCreate - makes the contact surface of a name: a surface of a deformable body or of a meshed rigid tool.

  Collective

  Input Parameters:
+ mesh       - the mesh
. scene      - the scene
. elasticity - gives the moduli of the cells
. path       - path of the scene's key that names the surface, for messages
. key        - that key
- name       - of the surface

  Output Parameter:
. out - the surface

  Note:
  Refuses unknown and empty surfaces.
@*/
PetscErrorCode SurfaceCreate(Mesh mesh, Scene scene, Elasticity elasticity, const char *path, const char *key,
                             const char *name, ContactSurface *out)
{
  ContactSurface surface;
  PetscInt       faces;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&surface));
  *out           = surface; /* SurfaceDestroy() frees what a refusal leaves */
  surface->mesh  = mesh;
  surface->body  = -1;
  surface->rigid = MeshFindRigid(mesh, name);
  if (surface->rigid) {
    surface->body = MeshFindBody(scene, name, PETSC_TRUE);
    PetscCall(SurfaceFacesFromRigid(surface));
    faces = surface->n_faces;
  } else {
    MeshGroup *group;

    PetscCall(MeshGetGroup(mesh, scene, path, key, name, mesh->dim - 1, &group));
    surface->group = group;
    PetscCall(SurfaceFacesFromGroup(surface));
    PetscCallMPI(MPI_Allreduce(&surface->n_faces, &faces, 1, MPIU_INT, MPI_SUM, mesh->comm));
  }
  if (!faces)
    PetscCall(RefuseInput(
      mesh->comm, "%s: the contact surface '%s' has no faces; allowed: a physical surface with at least one face",
      SceneWhere(scene, path, key), name));
  PetscCall(SurfaceMeasure(surface, elasticity));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceDestroy - frees a surface.

  Collective

  Input/Output Parameter:
. surface - the surface, NULL on return
@*/
PetscErrorCode SurfaceDestroy(ContactSurface *surface)
{
  PetscFunctionBeginUser;
  if (!*surface) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree3((*surface)->faces, (*surface)->face_size, (*surface)->face_height));
  PetscCall(PetscFree((*surface)->face_marks));
  PetscCall(PetscFree((*surface)->face_piece));
  PetscCall(PetscFree((*surface)->face_ends));
  PetscCall(PetscFree((*surface)->ridge.point));
  PetscCall(FaceBlocksDestroy(&(*surface)->blocks));
  PetscCall(PetscFree(*surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceTakePieces - notes the connected piece of the mesh to which each face belongs.

  Not collective

  Input Parameters:
+ surface - the surface of deformable bodies
- piece   - of each local node, from MeshFindPieces()
@*/
PetscErrorCode SurfaceTakePieces(ContactSurface surface, const PetscInt piece[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(surface->n_faces + 1, &surface->face_piece)); /* not NULL on a rank without faces */
  for (PetscInt f = 0; f < surface->n_faces; f++) surface->face_piece[f] = piece[surface->faces[f].nodes[0]];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An edge of a face (an end in 2D) with the rank-independent numbers of its corners. */
typedef struct {
  PetscInt id[2], face;
  int      edge;
} FaceEdge;

static int FaceEdgeCompare(const void *a, const void *b)
{
  const FaceEdge *p = a, *q = b;

  if (p->id[0] != q->id[0]) return p->id[0] < q->id[0] ? -1 : 1;
  if (p->id[1] != q->id[1]) return p->id[1] < q->id[1] ? -1 : 1;
  return 0;
}

/* Number of edges of a face; in 2D its two ends. */
static int FaceEdges(const Facet *face)
{
  const Element *e = ElementGet(face->type);
  return e->dim == 1 ? 2 : e->edges;
}

/* Numbers, within the face, of the nodes at the ends of an edge. Returns how many there are: 1 in 2D, else 2. */
static int FaceEdgeNodes(const Facet *face, int edge, int corners[2])
{
  const Element *e = ElementGet(face->type);

  corners[0] = e->dim == 1 ? edge : e->edge_corners[edge][0];
  corners[1] = e->dim == 1 ? edge : e->edge_corners[edge][1];
  return e->dim == 1 ? 1 : 2;
}

/* Drops every edge that occurs more than once. Sorts the list and returns the number of edges that remain. */
static PetscInt KeepSingleEdges(PetscInt n, FaceEdge *edges)
{
  PetscInt kept = 0;

  if (n) qsort(edges, n, sizeof(*edges), FaceEdgeCompare);
  for (PetscInt i = 0; i < n;) {
    PetscInt j = i + 1;

    while (j < n && !FaceEdgeCompare(&edges[i], &edges[j])) j++;
    if (j == i + 1) edges[kept++] = edges[i];
    i = j;
  }
  return kept;
}

/*@
  SurfaceOnPlane - says whether a position lies on the plane of an image.

  Not collective

  Input Parameters:
+ mesh  - the mesh, whose size is the scale
. image - an image of one plane
- x     - position x[dim], relative to the mesh's centre (length)
@*/
PetscBool SurfaceOnPlane(Mesh mesh, const SurfaceImage *image, const PetscReal *x)
{
  for (int d = 0; d < mesh->dim; d++)
    if (PetscAbsReal(image->sign[d] * x[d] + image->shift[d] - x[d]) > SURFACE_FLATNESS * mesh->size)
      return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Does a plane of symmetry hold all nodes of the edge? */
static PetscBool EdgeOnSymmetry(ContactSurface surface, const FaceEdge *edge, int n_images, const SurfaceImage *images)
{
  const PetscReal *coords = surface->rigid ? surface->rigid->coords : surface->mesh->coords;
  const Facet     *face   = &surface->faces[edge->face];
  int              corners[2];
  const int        n = FaceEdgeNodes(face, edge->edge, corners);

  for (int plane = 1; plane < n_images; plane <<= 1) {
    PetscBool on = PETSC_TRUE;

    for (int i = 0; i < n; i++)
      on = (PetscBool)(on && SurfaceOnPlane(surface->mesh, &images[plane],
                                            &coords[face->nodes[corners[i]] * surface->mesh->dim]));
    if (on) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Drops those single edges of this rank that another rank holds too. They are partition borders, not ends of the
   surface. */
static PetscErrorCode DropPartitionBorders(MPI_Comm comm, PetscInt *n, FaceEdge *edges)
{
  PetscMPIInt size, mine, *counts, *starts;
  PetscInt   *all, *send, total = 0, kept = 0;
  FaceEdge   *every;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMalloc3(size, &counts, size, &starts, 2 * *n, &send));
  PetscCall(PetscMPIIntCast(2 * *n, &mine));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, counts, 1, MPI_INT, comm));
  for (PetscMPIInt r = 0; r < size; r++) {
    PetscCall(PetscMPIIntCast(total, &starts[r]));
    total += counts[r];
  }
  for (PetscInt i = 0; i < *n; i++)
    for (int k = 0; k < 2; k++) send[2 * i + k] = edges[i].id[k];
  PetscCall(PetscMalloc2(total, &all, total / 2, &every));
  PetscCallMPI(MPI_Allgatherv(send, mine, MPIU_INT, all, counts, starts, MPIU_INT, comm));
  for (PetscInt i = 0; i < total / 2; i++) every[i] = (FaceEdge){{all[2 * i], all[2 * i + 1]}, 0, 0};
  total = KeepSingleEdges(total / 2, every);
  for (PetscInt i = 0; i < *n; i++)
    if (bsearch(&edges[i], every, total, sizeof(*every), FaceEdgeCompare)) edges[kept++] = edges[i];
  *n = kept;
  PetscCall(PetscFree2(all, every));
  PetscCall(PetscFree3(counts, starts, send));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceFindFreeEdges - marks the edges (ends in 2D) that belong to one face only, over all ranks, and do not lie on a
  plane of symmetry.

  Collective

  Input Parameters:
+ n_images - number of images
- images   - of SurfaceImages() for the pair; with their planes the test is the same for bodies, tools and the axis

  Input/Output Parameter:
. surface - the surface; the bits free_edges of its faces are set
@*/
PetscErrorCode SurfaceFindFreeEdges(ContactSurface surface, int n_images, const SurfaceImage *images)
{
  Mesh      mesh = surface->mesh;
  PetscInt  n    = 0;
  FaceEdge *edges;

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < surface->n_faces; f++) n += FaceEdges(&surface->faces[f]);
  PetscCall(PetscMalloc1(n, &edges));
  n = 0;
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const Facet *face = &surface->faces[f];

    for (int e = 0; e < FaceEdges(face); e++) {
      int      corners[2];
      PetscInt a, b;

      FaceEdgeNodes(face, e, corners);
      a          = surface->rigid ? face->nodes[corners[0]] : mesh->node_id[face->nodes[corners[0]]];
      b          = surface->rigid ? face->nodes[corners[1]] : mesh->node_id[face->nodes[corners[1]]];
      edges[n++] = (FaceEdge){{PetscMin(a, b), PetscMax(a, b)}, f, e};
    }
  }
  n = KeepSingleEdges(n, edges);
  if (surface->group) PetscCall(DropPartitionBorders(mesh->comm, &n, edges));
  for (PetscInt i = 0; i < n; i++) {
    if (EdgeOnSymmetry(surface, &edges[i], n_images, images)) continue;
    surface->faces[edges[i].face].free_edges |= 1 << edges[i].edge;
  }
  PetscCall(PetscFree(edges));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The way out of a face across one of its edges, in the plane of the face, of length 1. X: coordinates of the face's
   nodes. */
static void FaceOutward(const Facet *face, int edge, int dim, const double *X, PetscReal out[3])
{
  const int corners  = ElementGet(face->type)->corners;
  PetscReal along[3] = {0}, square = 0, length = 0, part = 0;
  int       ends[2];

  FaceEdgeNodes(face, edge, ends);
  for (int d = 0; d < dim; d++) {
    PetscReal centre = 0;

    for (int a = 0; a < corners; a++) centre += X[a * dim + d] / corners;
    along[d] = X[ends[1] * dim + d] - X[ends[0] * dim + d];
    out[d]   = (X[ends[0] * dim + d] + X[ends[1] * dim + d]) / 2 - centre;
    square += PetscSqr(along[d]);
    part += along[d] * out[d];
  }
  for (int d = 0; d < dim && square > 0; d++) out[d] -= part / square * along[d];
  for (int d = 0; d < dim; d++) length += PetscSqr(out[d]);
  for (int d = 0; d < dim && length > 0; d++) out[d] /= PetscSqrtReal(length);
}

/*@
  SurfaceNodeEnds - finds which way a surface ends at its nodes: the sum of the ways out across the free edges around
  each of them, in the plane of the surface, each of length 1, so that a corner ends both ways alike.

  Collective

  Input Parameters:
+ surface - a deformable surface, after SurfaceFindFreeEdges()
- u       - local displacements u[n_nodes*dim] (length)

  Output Parameter:
. end - end[n_nodes*dim] of any length, complete on every copy of a node, 0 where the surface does not end
@*/
PetscErrorCode SurfaceNodeEnds(ContactSurface surface, const PetscReal *u, PetscReal *end)
{
  Mesh      mesh = surface->mesh;
  const int dim  = mesh->dim;
  double    X[FACE_MAX_NODES * 3];

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(end, mesh->n_nodes * dim));
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const Facet   *face = &surface->faces[f];
    const Element *of   = ElementGet(face->type);

    for (int e = 0; face->free_edges && e < FaceEdges(face); e++) {
      PetscReal out[3];
      int       ends[2];

      if (!(face->free_edges >> e & 1)) continue;
      FaceCoordinates(surface, face, u, X);
      FaceOutward(face, e, dim, X, out);
      for (int d = 0; d < dim; d++) {
        for (int k = 0; k < FaceEdgeNodes(face, e, ends); k++) end[face->nodes[ends[k]] * dim + d] += out[d];
        if (of->dim == 2 && of->order == 2) end[face->nodes[of->corners + e] * dim + d] += out[d];
      }
    }
  }
  PetscCall(MeshSumNodes(mesh, dim, end));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums up the areas of this rank's faces at their nodes, and their normals; normal may be NULL. */
static PetscErrorCode AddFaces(ContactSurface surface, Geometry geometry, const PetscReal *u, PetscReal *area,
                               PetscReal *normal)
{
  const int dim = surface->mesh->dim;
  double    X[FACE_MAX_NODES * 3];

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(area, surface->mesh->n_nodes));
  if (normal) PetscCall(PetscArrayzero(normal, 3 * surface->mesh->n_nodes));
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const Facet *face              = &surface->faces[f];
    double       a[FACE_MAX_NODES] = {0}, n[FACE_MAX_NODES * 3] = {0};

    FaceCoordinates(surface, face, u, X);
    FaceAreaKernel(face->type, dim, geometry, X, a, n);
    for (int i = 0; i < ElementGet(face->type)->nodes; i++) {
      area[face->nodes[i]] += a[i];
      for (int d = 0; normal && d < dim; d++) normal[3 * face->nodes[i] + d] += n[i * dim + d];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceNodeAreas - computes tributary areas int N_a dA of all local nodes, summed over the faces of all ranks.

  Collective

  Input Parameters:
+ surface  - a deformable surface
. geometry - axisymmetric areas are over 360 degrees
- u        - local displacements u[n_nodes*dim] (length); NULL: reference configuration

  Output Parameter:
. area - area[n_nodes], complete on every copy of a node, 0 off the surface
@*/
PetscErrorCode SurfaceNodeAreas(ContactSurface surface, Geometry geometry, const PetscReal *u, PetscReal *area)
{
  PetscFunctionBeginUser;
  PetscCall(AddFaces(surface, geometry, u, area, NULL));
  PetscCall(MeshSumNodes(surface->mesh, 1, area));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceNodeNormals - computes normals int N_a n dA of all local nodes beside their tributary areas, both without the
  circumference of axisymmetric scenes.

  Collective

  Input Parameters:
+ surface - a deformable surface
- u       - local displacements u[n_nodes*dim] (length); NULL: reference configuration

  Output Parameters:
+ area   - as of SurfaceNodeAreas()
- normal - normal[n_nodes*3], likewise, with an area as length
@*/
PetscErrorCode SurfaceNodeNormals(ContactSurface surface, const PetscReal *u, PetscReal *area, PetscReal *normal)
{
  PetscFunctionBeginUser;
  PetscCall(AddFaces(surface, surface->mesh->dim == 3 ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN, u, area, normal));
  PetscCall(MeshSumNodes(surface->mesh, 1, area));
  PetscCall(MeshSumNodes(surface->mesh, 3, normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Angle between the faces around a node, with their mirror images, and their mean normal: the resultant of faces that
   turn by +-a is cos a of their area. *ends is PETSC_FALSE where an image continues the surface. */
static PetscReal NodeTurn(Mesh mesh, PetscInt n, int n_images, const SurfaceImage *images, PetscReal area,
                          const PetscReal normal[3], PetscBool *ends)
{
  PetscReal square = 0, kept[3] = {normal[0], normal[1], normal[2]};

  *ends = PETSC_TRUE;
  for (int bit = 1; bit < n_images; bit <<= 1) {
    if (!SurfaceOnPlane(mesh, &images[bit], &mesh->coords[n * mesh->dim])) continue;
    *ends = PETSC_FALSE;
    for (int d = 0; d < mesh->dim; d++) kept[d] = images[bit].sign[d] < 0 ? 0 : kept[d];
  }
  for (int d = 0; d < 3; d++) square += PetscSqr(kept[d]);
  return area > 0 ? PetscAcosReal(PetscMin(1, PetscSqrtReal(square) / area)) : 0;
}

/* Sums over the faces around each node the largest turn at a node of the face. */
static PetscErrorCode FaceTurns(ContactSurface surface, const PetscReal *turn, PetscReal *around)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(around, surface->mesh->n_nodes));
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const Facet *face = &surface->faces[f];
    PetscReal    most = 0;

    for (int i = 0; i < ElementGet(face->type)->nodes; i++) most = PetscMax(most, turn[face->nodes[i]]);
    for (int i = 0; i < ElementGet(face->type)->nodes; i++) around[face->nodes[i]] += most;
  }
  PetscCall(MeshSumNodes(surface->mesh, 1, around));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceNodeSizes - measures the faces around each local node in the reference configuration.

  Collective

  Input Parameters:
+ surface  - a deformable surface
. geometry - of the scene
. n_images - number of mirror images
- images   - the images, which continue the surface

  Output Parameters:
+ size  - size[n_nodes]: mean face size (length)
. turn  - turn[n_nodes]: angle between the faces and their mean normal (radians), from the resultant of their areas
- share - share[n_nodes]: tributary area over the whole area of the faces, which is 1/4 on 4-node faces and about 0 for
          corners of 6-node triangles

  Note:
  All values are 0 off the surface. Where the surface ends and no image continues it, its turn is that of the nodes next
  to the end. Second-order faces bend within themselves, which their corners do not show; their nodes share the largest
  turn of the faces around.
@*/
PetscErrorCode SurfaceNodeSizes(ContactSurface surface, Geometry geometry, int n_images, const SurfaceImage *images,
                                PetscReal *size, PetscReal *turn, PetscReal *share)
{
  enum { SIZE, FACES, AREA, SUMS };
  Mesh       mesh = surface->mesh;
  PetscReal *sum, *normal, *area, *around;
  PetscBool *ends;
  double     X[FACE_MAX_NODES * 3];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(SUMS * mesh->n_nodes, &sum, 3 * mesh->n_nodes, &normal, mesh->n_nodes, &area, mesh->n_nodes,
                         &around, mesh->n_nodes, &ends));
  PetscCall(PetscArrayzero(sum, SUMS * mesh->n_nodes));
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const Facet *face                  = &surface->faces[f];
    const int    n                     = ElementGet(face->type)->nodes;
    double       parts[FACE_MAX_NODES] = {0}, whole = 0;

    FaceCoordinates(surface, face, NULL, X);
    FaceAreaKernel(face->type, mesh->dim, geometry, X, parts, NULL);
    for (int i = 0; i < n; i++) whole += parts[i];
    for (int i = 0; i < n; i++) {
      PetscReal *at = &sum[SUMS * face->nodes[i]];

      at[SIZE] += surface->face_size[f];
      at[FACES] += 1;
      at[AREA] += whole;
    }
  }
  PetscCall(MeshSumNodes(mesh, SUMS, sum));
  PetscCall(SurfaceNodeAreas(surface, geometry, NULL, area));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    size[n]  = sum[SUMS * n + FACES] > 0 ? sum[SUMS * n + SIZE] / sum[SUMS * n + FACES] : 0;
    share[n] = sum[SUMS * n + AREA] > 0 ? area[n] / sum[SUMS * n + AREA] : 0;
  }
  PetscCall(SurfaceNodeNormals(surface, NULL, area, normal));
  for (PetscInt n = 0; n < mesh->n_nodes; n++)
    turn[n] = NodeTurn(mesh, n, n_images, images, area[n], &normal[3 * n], &ends[n]);
  PetscCall(FaceTurns(surface, turn, around));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    const PetscReal faces = sum[SUMS * n + FACES];

    if (faces > 0 && ((ends[n] && faces == 1) || surface->order > 1)) turn[n] = PetscMax(turn[n], around[n] / faces);
  }
  PetscCall(PetscFree5(sum, normal, area, around, ends));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceImageFacet - returns a facet as one of its mirror images.

  Not collective

  Input Parameters:
+ facet - the facet
- image - the image

  Note:
  Where the image reverses the orientation, the order of the nodes is reversed too, so that the normal points out of the
  image again. The bits of free edges follow.
@*/
Facet SurfaceImageFacet(const Facet *facet, const SurfaceImage *image)
{
  const Element *e     = ElementGet(facet->type);
  const int      edges = FaceEdges(facet), middles = e->dim == 1 ? 1 : e->edges;
  Facet          out = *facet;

  if (!image->reverses) return out;
  for (int c = 0; c < e->corners; c++) out.nodes[c] = facet->nodes[e->dim == 1 ? 1 - c : (e->corners - c) % e->corners];
  for (int m = 0; e->order == 2 && m < middles; m++)
    out.nodes[e->corners + m] = facet->nodes[e->corners + middles - 1 - m];
  out.free_edges = 0;
  for (int k = 0; k < edges; k++)
    if (facet->free_edges >> k & 1) out.free_edges |= 1 << (edges - 1 - k);
  return out;
}

/* The cell of the cube into which a direction points. DirectionMiddle() gives the direction of a cell's middle. */
static int DirectionCell(const PetscReal v[3])
{
  int axis = 0, cell[2];

  for (int d = 1; d < 3; d++)
    if (PetscAbsReal(v[d]) > PetscAbsReal(v[axis])) axis = d;
  for (int k = 0; k < 2; k++)
    cell[k] =
      PetscMin(SURFACE_CELLS - 1, (int)((v[(axis + 1 + k) % 3] / PetscAbsReal(v[axis]) + 1) / 2 * SURFACE_CELLS));
  return ((2 * axis + (v[axis] < 0)) * SURFACE_CELLS + cell[0]) * SURFACE_CELLS + cell[1];
}

static void DirectionMiddle(int index, PetscReal v[3])
{
  const int cell[2] = {index / SURFACE_CELLS % SURFACE_CELLS, index % SURFACE_CELLS},
            side = index / (SURFACE_CELLS * SURFACE_CELLS), axis = side / 2;

  v[axis] = side % 2 ? -1 : 1;
  for (int k = 0; k < 2; k++) v[(axis + 1 + k) % 3] = (2 * cell[k] + 1.0) / SURFACE_CELLS - 1;
}

/*@
  SurfaceFaces - tests whether any face of the master has a normal opposed to that of any of these nodes, in the
  reference configuration.

  Collective

  Input Parameters:
+ master  - the master surface
. n       - number of nodes of this rank
. nodes   - the nodes
- normals - normals[3*local node], of any length

  Output Parameter:
. facing - the answer, the same on all ranks

  Note:
  The directions of the faces are gathered in cells of about 20 degrees, so that ranks exchange a small table of fixed
  size.
@*/
PetscErrorCode SurfaceFaces(ContactSurface master, PetscInt n, const PetscInt nodes[], const PetscReal normals[],
                            PetscBool *facing)
{
  const int dim                       = master->mesh->dim;
  int       there[SURFACE_DIRECTIONS] = {0}, found = 0;
  double    X[FACE_MAX_NODES * 3];

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < master->n_faces; f++) {
    double    area[FACE_MAX_NODES] = {0}, normal[FACE_MAX_NODES * 3] = {0};
    PetscReal sum[3] = {0, 0, 0};

    FaceCoordinates(master, &master->faces[f], NULL, X);
    FaceAreaKernel(master->faces[f].type, dim, dim == 3 ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN, X, area, normal);
    for (int a = 0; a < ElementGet(master->faces[f].type)->nodes; a++)
      for (int d = 0; d < dim; d++) sum[d] += normal[a * dim + d];
    if (sum[0] != 0 || sum[1] != 0 || sum[2] != 0) there[DirectionCell(sum)] = 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, there, SURFACE_DIRECTIONS, MPI_INT, MPI_MAX, master->mesh->comm));
  for (int k = 0; k < SURFACE_DIRECTIONS && !found; k++) {
    PetscReal m[3];

    if (!there[k]) continue;
    DirectionMiddle(k, m);
    for (PetscInt i = 0; i < n && !found; i++) {
      const PetscReal *v       = &normals[3 * nodes[i]];
      PetscReal        product = 0, lengths[2] = {0, 0};

      for (int d = 0; d < 3; d++) {
        product += v[d] * m[d];
        lengths[0] += v[d] * v[d];
        lengths[1] += m[d] * m[d];
      }
      found = product < SURFACE_OPPOSED * PetscSqrtReal(lengths[0] * lengths[1]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPI_INT, MPI_MAX, master->mesh->comm));
  *facing = found ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
