/* Edges of a rigid tool's faces, and how the surface goes on across them. In the plane each face is an edge itself. */
#pragma once
#include "mesh/meshdata.h"

/* Faces that meet at a larger angle than this one are two surfaces: cos 60 degrees, as for fits. */
#define TOOL_SMOOTH_COSINE 0.5

enum { TOOL_FACE_EDGES = 4 };

typedef struct {
  PetscInt  corner[2];
  PetscInt  middle;  /* node between them, of faces of second order; otherwise -1 */
  PetscInt  face[2]; /* the first two faces that have it; the second is -1 where there is one only */
  PetscInt  n_faces;
  PetscBool smooth; /* two faces meet here as one surface; in the plane a face has no such edge */
} ToolEdge;

typedef struct {
  int        dim;
  PetscInt   n;
  ToolEdge  *edge;
  PetscInt  *of_face;              /* edges of face f: of_face[TOOL_FACE_EDGES*f + k], in the order of its corners */
  PetscInt  *node_ptr, *node_edge; /* edges at a node, CSR */
  PetscBool *curved;               /* of a face: the surface of which it is a part is not in a plane */
} ToolEdges;

PetscErrorCode ToolEdgesCreate(int dim, const MeshRigid *, ToolEdges *);
PetscErrorCode ToolEdgesDestroy(ToolEdges *);
PetscInt       ToolEdgeOther(const ToolEdge *, PetscInt node);
PetscReal      ToolEdgeLength(int dim, const MeshRigid *, const ToolEdge *);
PetscInt       ToolEdgeNext(const ToolEdges *, const MeshRigid *, PetscInt edge, PetscInt node);
