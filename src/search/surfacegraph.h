/* The nodes of a surface of the bodies with their neighbours along the edges of its faces, whole on every rank, in an
   order that does not depend on the ranks.

   SurfaceGraphCreate() makes it. SurfaceGraphGather() gives every rank the values of all nodes,
   SurfaceGraphScatter() brings values back to the local nodes. SurfaceGraphGroup() and SurfaceGraphPoint() find nodes
   of the surface. */
#pragma once
#include "base/passage.h"
#include "mesh/mesh.h"

typedef struct {
  Mesh             mesh;
  const MeshGroup *group;
  PassageGraph     graph;
  PetscInt        *id;    /* node_id, ascending */
  PetscInt        *local; /* local node, -1: not on this rank */
  PetscBool       *own;   /* this rank owns the node */
  PetscReal       *X;     /* n*3: reference coordinates as in the mesh file */
  char            *rim;   /* the surface ends at the node */
  int             *ptr, *adj;
} *SurfaceGraph;

PetscErrorCode SurfaceGraphCreate(Mesh, const MeshGroup *, SurfaceGraph *);
PetscErrorCode SurfaceGraphDestroy(SurfaceGraph *);
PetscErrorCode SurfaceGraphGather(SurfaceGraph, const PetscReal *local, PetscReal *values);
void           SurfaceGraphScatter(SurfaceGraph, const char *flag, PetscReal *local);
PetscErrorCode SurfaceGraphGroup(SurfaceGraph, const MeshGroup *, char *flag, PetscInt *n);
PetscInt       SurfaceGraphNearest(SurfaceGraph, const PetscReal X[3], PetscReal *distance, PetscReal *reach);
