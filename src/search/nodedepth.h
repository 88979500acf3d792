/* How deep the nodes of a master stand in its slave. Contact is enforced at slave points alone, so that a master node
   between them may stand deeper in the slave than any slave point stands in the master. This is for reports: nothing
   of it enters the solution.

   NodeDepthsCreate() prepares the search of the slave's facets, NodeDepthsMeasure() finds the deepest node in a
   state. */
#pragma once
#include "search/search.h"

typedef struct _n_NodeDepths *NodeDepths;

/* The master node that stands deepest in the slave */
typedef struct {
  PetscInt  nodes;  /* master nodes that stand in the slave at all */
  PetscReal depth;  /* of the deepest one (length); 0: none */
  PetscReal over_h; /* largest depth over the size of the slave face that is stood in */
  PetscInt  tag;    /* gmsh's tag of the deepest node, -1: none */
  PetscReal X[3];   /* its reference coordinates */
  PetscBool wedge;  /* it is on an edge of less than 90 degrees between faces of the master */
} NodeDepth;

PetscErrorCode NodeDepthsCreate(Mesh, Scene, Loads, ContactSurface slave, ContactSurface master, int n_images,
                                const SurfaceImage *, NodeDepths *);
PetscErrorCode NodeDepthsDestroy(NodeDepths *);
PetscErrorCode NodeDepthsMeasure(NodeDepths, const PetscReal *u, PetscReal t, const PetscReal *allowed, NodeDepth *);
PetscErrorCode NodeDepthsSagitta(NodeDepths, PetscReal feature_angle, PetscReal *sagitta);
