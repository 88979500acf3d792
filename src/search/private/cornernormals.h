/* Normals of a faceted surface that do not jump from facet to facet: means of the facets around each corner, and
   between the corners the shape functions. The part works on the facets that a rank holds, without communication.

   CornerNormalsCreate() makes the means once for a view of the surface, CornerNormalsAt() gives the normal at a place
   of a facet, and CornerNormalsBulge() says how far a smooth surface with such normals is off it. */
#pragma once
#include "neighbourhood.h"

typedef struct _n_CornerNormals *CornerNormals;

PetscErrorCode CornerNormalsCreate(const SurfaceView *, CornerNormals *);
PetscErrorCode CornerNormalsDestroy(CornerNormals *);
void           CornerNormalsAt(CornerNormals, PetscInt facet, const double *xi, PetscReal normal[3]);
PetscReal      CornerNormalsBulge(CornerNormals, PetscInt facet);
