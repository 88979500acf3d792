/* The free edges of a slave surface (in 2D its free ends) in the reference configuration, and the distance to them. At
   a free edge the contact surface really ends, and pressures may be singular there. Edges on a plane of symmetry of the
   pair, or on the axis of revolution, are not free.

   FreeEdgesCreate() finds the edges once, and FreeEdgesDistance() is then called for any point. */
#pragma once
#include "mesh/mesh.h"

typedef struct _n_FreeEdges *FreeEdges;

PetscErrorCode FreeEdgesCreate(Mesh, Scene, const SceneContact *, const MeshGroup *surface, FreeEdges *);
PetscErrorCode FreeEdgesDestroy(FreeEdges *);
PetscReal      FreeEdgesDistance(FreeEdges, const PetscReal x[3]);
