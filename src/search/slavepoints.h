/* The slave points of a pair: fixed combinations of slave nodes, plus an offset, at which the gap is measured. In
   node-to-surface contact they are the nodes themselves. In surface-to-surface contact they are the quadrature points
   of the faces around this rank's nodes, on whichever rank the faces live, with area weights and the hat functions by
   which a slave node weighs them. They know no master. Points on the edges of a rigid tool have nodes of their own,
   whose ids are numbers of ridge points, and move with the tool.

   SlavePointsCreateNodes(), SlavePointsCreateQuadrature() or SlavePointsCreateRidge() makes them.
   SlavePointsSetOffsets() or SlavePointsSetMaps() brings the offsets of the faces to the points. SlavePointsMove()
   fetches displacements; SlavePointsPosition() and SlavePointsNormals() refer to the last move. SlavePointsFindEnds()
   finds where the slave ends. SlavePointsHatAreas() gives the nodal areas of surface-to-surface contact. */
#pragma once
#include "bodies/loads.h"
#include "search/facemap.h"

typedef struct {
  Mesh           mesh;
  ContactSurface surface;
  PetscInt       n_nodes; /* nodes of which the points are made, by ascending id */
  NodeKey       *nodes;
  PetscSF        sf; /* roots: local nodes of their owners; leaves: these nodes */
  MPI_Datatype   block;
  PetscReal     *u;                /* n_nodes*dim: displacements at the last SlavePointsMove() (length) */
  PetscInt       n, *ptr, *node;   /* points, and the nodes of which each is made */
  PetscReal     *S, *hat, *weight; /* shape and hat functions at these nodes; area weight of each point */
  PetscReal     *size, *height;    /* of the slave's faces at each point, and of the elements below them (length) */
  PetscReal     *offset;           /* n*dim, along the normal at the time when it was taken (length) */
  PetscReal      most_offset;      /* the largest one on this rank (length) */
  /* Where friction needs them: the nodes around each point with two slopes each, so that sum slope x are tangents of
     the slave's surface at the point. NULL: not asked for. */
  PetscInt  *lever_ptr, *lever_node;
  PetscReal *lever_slope;
  /* Points on edges of a tool only: what moves it, and the normals of both sides of the edge after SlavePointsMove(),
     6 of each point. */
  Loads      loads;
  PetscReal *sides;
  PetscReal *end; /* n_nodes*dim: SurfaceNodeEnds() at the last SlavePointsFindEnds(), of any length */
  /* The following members are for surface-to-surface contact only. */
  PetscReal   *normal; /* n_nodes*3: mean normal around each node after SlavePointsNormals(), of any length */
  PetscInt     n_faces;
  Facet       *faces;      /* nodes: positions in nodes[] */
  PetscInt    *first;      /* first point of each face */
  int         *ends;       /* of each face, see surfaceends.h; the rule of a face with an end has points on it */
  PetscInt    *piece;      /* of the mesh, of each face; 0 where it is not sought */
  int          finer;      /* how fine the quadrature is, see FaceRuleGet() */
  PetscSF      face_sf;    /* roots: faces where they live */
  MPI_Datatype face_block; /* FACE_RULE_POINTS*dim reals */
  /* Maps of the faces, where offsets are live: they replace the shape functions. */
  FaceMaps maps;
} *SlavePoints;

PetscErrorCode SlavePointsCreateNodes(ContactSurface, PetscInt n, const PetscInt nodes[], const PetscReal size[],
                                      const PetscReal height[], PetscBool levers, SlavePoints *);
PetscErrorCode SlavePointsCreateQuadrature(ContactSurface, Geometry, int finer, PetscBool levers, SlavePoints *);
PetscErrorCode SlavePointsCreateRidge(ContactSurface, Loads, SlavePoints *);
PetscErrorCode SlavePointsDestroy(SlavePoints *);
PetscErrorCode SlavePointsMove(SlavePoints, const PetscReal *u, PetscReal t);
PetscBool      SlavePointIsOwn(SlavePoints, PetscInt q, PetscMPIInt rank);
PetscInt       SlavePointFace(SlavePoints, PetscInt q);
void           SlavePointsPosition(SlavePoints, PetscInt q, PetscReal *x);
void           SlavePointsFacePositions(SlavePoints, PetscInt f, PetscReal *x);
PetscErrorCode SlavePointsNormals(SlavePoints, int n_images, const SurfaceImage *, const PetscReal *u,
                                  const PetscBool *some, PetscReal *normals);
PetscErrorCode SlavePointsFindEnds(SlavePoints, const PetscReal *u);
PetscErrorCode SlavePointsSetOffsets(SlavePoints, const PetscReal *offset, const PetscBool *touched);
PetscErrorCode SlavePointsSetMaps(SlavePoints, const FaceMaps *);
PetscErrorCode SlavePointsHatAreas(SlavePoints, Geometry, const PetscReal *u, PetscReal *area);
