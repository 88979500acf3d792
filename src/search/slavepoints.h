/* Where a slave surface is measured: points that are fixed combinations of slave nodes, plus an offset. Node to
   surface: the nodes themselves. Surface to surface: the quadrature points of the faces around this rank's nodes,
   whichever rank the faces live on, with area weights and the hat functions by which a slave node weighs them. Knows no
   master. */
#pragma once
#include "search/facemap.h"

typedef struct {
  Mesh           mesh;
  ContactSurface surface;
  PetscInt       n_nodes; /* nodes that the points stand on, by ascending id */
  NodeKey       *nodes;
  PetscSF        sf; /* roots: the owners' local nodes; leaves: these nodes */
  MPI_Datatype   block;
  PetscReal     *u;                /* n_nodes*dim: displacements of the last SlavePointsMove() */
  PetscInt       n, *ptr, *node;   /* points and the nodes that each is made of */
  PetscReal     *S, *hat, *weight; /* shape and hat functions at these nodes; area weight of each point */
  PetscReal     *offset;           /* n*dim, along the normal of the moment */
  /* surface to surface only */
  PetscInt     n_faces;
  Facet       *faces;      /* nodes: places in nodes[] */
  PetscInt    *first;      /* point of each face's rule */
  int          finer;      /* quadrature of one order more */
  PetscSF      face_sf;    /* roots: faces where they live */
  MPI_Datatype face_block; /* FACE_RULE_POINTS*dim reals */
  FaceMaps     maps;       /* of the faces, where offsets are live: the points instead of shape functions */
} *SlavePoints;

/* n local nodes as slave points. Collective. */
PetscErrorCode SlavePointsCreateNodes(ContactSurface, PetscInt n, const PetscInt nodes[], SlavePoints *);
/* The quadrature points of all faces around this rank's nodes. Collective. */
PetscErrorCode SlavePointsCreateQuadrature(ContactSurface, Geometry, int finer, SlavePoints *);
PetscErrorCode SlavePointsDestroy(SlavePoints *);
/* Fetches the displacements of the nodes; u: n_nodes*dim of the mesh. Collective. */
PetscErrorCode SlavePointsMove(SlavePoints, const PetscReal *u);
/* Does point q count for that rank? One rank of those that hold it. Not collective. */
PetscBool SlavePointIsOwn(SlavePoints, PetscInt q, PetscMPIInt rank);
/* Position of point q after the last move, without its offset. */
void SlavePointsPosition(SlavePoints, PetscInt q, PetscReal *x);
/* Normals out of the slave at the points (n*3, any length) after the last move to u. Collective. */
PetscErrorCode SlavePointsNormals(SlavePoints, const PetscReal *u, PetscReal *normals);
/* Takes the offsets of this rank's own faces [faces of the surface][FACE_RULE_POINTS*dim] to the points of whatever
 * rank. Collective. */
PetscErrorCode SlavePointsSetOffsets(SlavePoints, const PetscReal *offset);
/* Takes maps of this rank's own faces to the points of whatever rank, once. Collective. */
PetscErrorCode SlavePointsSetMaps(SlavePoints, const FaceMaps *);
/* int psi dA of all local nodes of the mesh, positions X + u (NULL: reference), complete on every copy. Collective. */
PetscErrorCode SlavePointsHatAreas(SlavePoints, Geometry, const PetscReal *u, PetscReal *area);
