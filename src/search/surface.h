/* One side of a contact pair in the reference configuration: its faces on this rank, their sizes, free edges, mirror
   planes, areas. Knows nothing of gaps. Faces of a deformable body live with their cells; those of a rigid tool stand
   whole on every rank. */
#pragma once
#include "bodies/elasticity.h"
#include "smooth/facet.h"

/* Reflection through a coordinate plane or a product of such planes: x' = sign * x + shift, by component. Image 0 is
   the identity, image m the product of the planes whose bits are set in m; of two planes normal to one axis each
   mirrors once, their product is left out. */
enum { SURFACE_AXIS_PLANES = 2, SURFACE_MAX_IMAGES = 1 << 3 * SURFACE_AXIS_PLANES };
typedef struct {
  PetscReal sign[3], shift[3];
  PetscBool reverses, left_out; /* reverses: turns the orientation of a face over */
} SurfaceImage;

typedef struct {
  Mesh             mesh;
  const MeshGroup *group; /* deformable, else NULL */
  const MeshRigid *rigid; /* or a rigid tool, and which body of the scene it is */
  int              body;
  int              order;               /* of the faces */
  PetscInt         n_faces;             /* this rank's */
  Facet           *faces;               /* nodes: local nodes of the mesh, or of the rigid tool */
  PetscReal       *face_size;           /* sqrt(area), a length in 2D */
  PetscReal        mean_size, max_size; /* over all ranks */
  PetscReal        max_extent;          /* longest face, corner to corner */
  PetscReal        stiffness;           /* area-weighted mean of E over element height, all ranks; 0 for a rigid tool */
} *ContactSurface;

PetscErrorCode SurfaceCreate(Mesh, Scene, Elasticity, const char *path, const char *key, const char *name,
                             ContactSurface *);
PetscErrorCode SurfaceDestroy(ContactSurface *);
/* Marks the edges at which a master surface ends (bits free_edges of its faces): held by one face only and on no plane
 * of symmetry. Collective. */
PetscErrorCode SurfaceFindFreeEdges(ContactSurface, int n_images, const SurfaceImage *);
/* Tributary areas and normals (area-weighted sum of the faces', not normalised) of all local nodes at displacement u
   (NULL: reference), complete on every copy. area n_nodes, normal n_nodes*3 (may be NULL). Deformable surfaces only.
   Collective. */
PetscErrorCode SurfaceNodeAreas(ContactSurface, Geometry, const PetscReal *u, PetscReal *area, PetscReal *normal);
/* Around each local node, reference configuration: mean face size, how far the faces turn from their mean normal
   (radians), and the node's tributary area as a share of the whole area of its faces (1/4 on 4-node faces; about 0 for
   corners of 6-node triangles). Collective. */
PetscErrorCode SurfaceNodeSizes(ContactSurface, Geometry, PetscReal *size, PetscReal *turn, PetscReal *share);
/* The planes of symmetry of a pair as images, checked: planar, normal to an axis, held by a support. Collective. */
PetscErrorCode SurfaceImages(Mesh, Scene, const SceneContact *, int *n_images, SurfaceImage images[SURFACE_MAX_IMAGES]);
/* y = the image of x, dim components. */
void SurfaceReflect(const SurfaceImage *, int dim, const PetscReal *x, PetscReal *y);
/* The face as its mirror image sees it: node order turned over where the image reverses orientation. */
Facet SurfaceImageFacet(const Facet *, const SurfaceImage *);
/* Does any face of a master look towards any of the nodes (n of them, normals by local node, 3 each, any length)?
 * Reference configuration. Collective. */
PetscErrorCode SurfaceFaces(ContactSurface master, PetscInt n, const PetscInt nodes[], const PetscReal normals[],
                            PetscBool *facing);
