/* The parameters of a .geo file that refine its mesh, as the file itself declares them.

   The Name that DefineConstant gives a parameter says what it is: it begins with "elements" or "faces" if it counts
   them (n = {8, Name "elements along each side"}), with "element size" if it is a size, and with "divides" if sizes are
   divided by it. GeoDensitiesAdd() collects those of a file and looks for the word Transfinite: such a geometry divides
   curves by itself. GeoDensitiesReset() frees the list. */
#pragma once
#include "geotokens.h"
#include "scene/scene.h"

typedef struct {
  char       *name;
  PetscReal   value; /* default */
  DensityKind kind;
} GeoDensity;

typedef struct {
  int         n;
  GeoDensity *density;
  PetscBool   structured; /* the word Transfinite occurs */
} GeoDensities;

PetscErrorCode GeoDensitiesAdd(GeoDensities *, const GeoTokens *);
PetscErrorCode GeoDensitiesReset(GeoDensities *);
