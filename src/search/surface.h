/* One side of a contact pair in the reference configuration: its faces on this rank, their sizes, free edges, mirror
   planes and areas. It knows nothing of gaps. Faces of a deformable body live with their cells. Faces of a rigid tool
   are all present on every rank.

   SurfaceCreate() makes a surface. SurfaceImages() makes the mirror images of a pair, and SurfaceFindFreeEdges()
   needs them to mark the edges at which a master ends. SurfaceImageBeyondAxis() finds those at negative radii.
   SurfaceNodeEnds() says where a surface ends, and which way. SurfaceNodeAreas(), SurfaceNodeNormals() and
   SurfaceNodeSizes() measure deformable surfaces around their nodes. SurfaceFaces() checks that two surfaces face each
   other at all. SurfaceReflect() and SurfaceImageFacet() take positions and faces to a mirror image. */
#pragma once
#include "bodies/elasticity.h"
#include "search/faceblocks.h"
#include <stdint.h>

/* Marks of a face, see facemarks.h */
typedef uint64_t FaceMarks;

/* The deviation of a plane of symmetry from flatness, and of its normal from an axis, may reach this fraction of the
   model's size. It is the round-off of a CAD kernel. */
#define SURFACE_FLATNESS 1e-6

/* A mirror image: reflection through a coordinate plane or a product of such planes, x' = sign * x + shift, by
   component. Image 0 is the identity. Image m is the product of the planes whose bits are set in m. Two planes
   normal to one axis each mirror once, and their product is left out. */
enum { SURFACE_AXIS_PLANES = 2, SURFACE_MAX_IMAGES = 1 << 3 * SURFACE_AXIS_PLANES };
typedef struct {
  PetscReal sign[3], shift[3];
  PetscBool reverses, left_out; /* reverses: inverts the orientation of a face */
} SurfaceImage;

/* A point on a sharp convex edge of a rigid tool, see ridgepoints.h */
typedef struct {
  PetscReal X[3];     /* relative to the mesh's centre (length) */
  PetscReal area;     /* reference area */
  PetscReal sides[6]; /* unit normals of both sides of the edge */
  PetscInt  tag;      /* gmsh's tag of an end of the edge */
} RidgePoint;

typedef struct {
  PetscInt    n;
  RidgePoint *point;
} RidgePoints;

typedef struct _n_ContactSurface {
  Mesh             mesh;
  const MeshGroup *group; /* of a deformable body, else NULL */
  const MeshRigid *rigid; /* a rigid tool, else NULL; body: its number in the scene, else -1 */
  int              body;
  int              order;               /* of the faces */
  PetscInt         n_faces;             /* on this rank */
  Facet           *faces;               /* nodes: local nodes of the mesh, or of the rigid tool */
  PetscReal       *face_size;           /* sqrt(area), a length in 2D */
  PetscReal       *face_height;         /* of the element below each face (length); 0 for a rigid tool */
  PetscReal        mean_size, max_size; /* mean and largest face size, over all ranks */
  PetscReal        max_extent;          /* longest distance between two corners of a face */
  /* Area-weighted mean of E over element height, over all ranks; 0 for a rigid tool. */
  PetscReal   stiffness;
  FaceMarks  *face_marks; /* of each face; NULL: there are none */
  PetscInt   *face_piece; /* of each face: the connected piece of the mesh to which it belongs; NULL: not sought */
  int        *face_ends;  /* of each face, bit e: edge e is an end, see surfaceends.h; NULL: none was sought */
  PetscInt    turned;     /* faces of a rigid tool whose normals were turned */
  RidgePoints ridge;      /* points of a rigid tool that it has in the place of faces */
  FaceBlocks  blocks;     /* NULL before a search has asked for them; of a rigid tool in its own frame */
} *ContactSurface;

PetscErrorCode SurfaceCreate(Mesh, Scene, Elasticity, const char *path, const char *key, const char *name,
                             ContactSurface *);
PetscErrorCode SurfaceDestroy(ContactSurface *);
PetscErrorCode SurfaceTakePieces(ContactSurface, const PetscInt piece[]);
PetscBool      SurfaceOnPlane(Mesh, const SurfaceImage *, const PetscReal *x);
PetscErrorCode SurfaceFindFreeEdges(ContactSurface, int n_images, const SurfaceImage *);
PetscErrorCode SurfaceNodeEnds(ContactSurface, const PetscReal *u, PetscReal *end);
PetscErrorCode SurfaceNodeAreas(ContactSurface, Geometry, const PetscReal *u, PetscReal *area);
PetscErrorCode SurfaceNodeNormals(ContactSurface, const PetscReal *u, PetscReal *area, PetscReal *normal);
PetscErrorCode SurfaceNodeSizes(ContactSurface, Geometry, int n_images, const SurfaceImage *, PetscReal *size,
                                PetscReal *turn, PetscReal *share);
PetscErrorCode SurfaceImages(Mesh, Scene, const SceneContact *, ContactSurface slave, ContactSurface master,
                             int *n_images, SurfaceImage images[SURFACE_MAX_IMAGES]);
PetscErrorCode SurfaceImagesFromSupports(Mesh, Scene, ContactSurface slave, ContactSurface master, PetscBool smoothly,
                                         int *n_images, SurfaceImage images[SURFACE_MAX_IMAGES]);
PetscBool      SurfaceImageBeyondAxis(const SurfaceImage *);
void           SurfaceReflect(const SurfaceImage *, int dim, const PetscReal *x, PetscReal *y);
Facet          SurfaceImageFacet(const Facet *, const SurfaceImage *);
PetscErrorCode SurfaceFaces(ContactSurface master, PetscInt n, const PetscInt nodes[], const PetscReal normals[],
                            PetscBool *facing);
