/* Rigid tools as meshes that move, for pictures: meshed tools as they are, analytic ones as plane, tube, sphere, line
   or circle about the bodies.

   ToolShapesCreate() makes them, ToolShapesDestroy() frees them. ToolShapePlace() gives how far the nodes of one have
   moved. The shapes are whole on every rank. A plane and a cylinder have no ends: they are drawn as long as the bodies
   are large. */
#pragma once
#include "mesh/mesh.h"

typedef struct {
  char          name[160]; /* of the tool's surface; PAIR_plane, PAIR_cylinder or PAIR_sphere of an analytic one; each
                              has another */
  int           number; /* index into the scene's bodies; of an analytic one their number plus the index of its pair */
  const Motion *motion;
  PetscInt      n_nodes, n_cells;
  PetscReal    *nodes; /* n_nodes*3, at the start, absolute */
  ElementType   type;  /* of all its cells */
  int64_t      *cells; /* n_cells * nodes of the element */
} ToolShape;

typedef struct {
  int        n;
  ToolShape *shape;
} ToolShapes;

PetscErrorCode ToolShapesCreate(Mesh, Scene, ToolShapes *);
void           ToolShapePlace(const ToolShape *, PetscReal t, PetscReal *displacement);
PetscErrorCode ToolShapesDestroy(ToolShapes *);
