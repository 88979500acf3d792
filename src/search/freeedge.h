/* The free edges of a slave surface (its free ends in 2D) in the reference configuration, and the distance to them:
   where a contact surface really ends and pressures may be singular. Edges on a plane of symmetry of the pair, or on
   the axis of revolution, are not free. */
#pragma once
#include "mesh/mesh.h"

typedef struct _n_FreeEdges *FreeEdges;

/* The contact gives the planes of symmetry. Collective. */
PetscErrorCode FreeEdgesCreate(Mesh, Scene, const SceneContact *, const MeshGroup *surface, FreeEdges *);
PetscErrorCode FreeEdgesDestroy(FreeEdges *);
/* From a point in reference coordinates, components beyond the mesh's dimension 0; PETSC_MAX_REAL: the surface has no
 * free edge. Not collective. */
PetscReal FreeEdgesDistance(FreeEdges, const PetscReal x[3]);
