/* Variables of a .geo that hold a text, and expressions with them, as far as they are known before gmsh runs.

   GeoStringsAdd() collects the variables that a file sets. GeoStringsEvaluate() gives the text of an expression that
   is made of texts, of variables that are set once, of CurrentDirectory, StrCat and Str. GeoStringsHash() tells lists
   apart. GeoStringsDestroy() frees the list. */
#pragma once
#include "geotokens.h"
#include "scene/scene.h"
#include <stdint.h>

typedef struct {
  char     *name, *value; /* value: NULL if it is no plain text */
  int       times;        /* how often the files set it */
  PetscBool constant;     /* in DefineConstant, which a parameter of the scene replaces */
  PetscBool indexed;      /* NAME~{i}: it stands for all names with this beginning */
} GeoString;

typedef struct {
  Scene      scene; /* its parameters */
  int        n, room;
  GeoString *string;
  PetscBool  shared; /* a constant may get its value from gmsh's database */
  int        n_shown;
  char     **shown; /* names of constants there */
} GeoStrings;

PetscErrorCode GeoStringsAdd(GeoStrings *, const GeoTokens *);
PetscErrorCode GeoStringsEvaluate(const GeoStrings *, const GeoTokens *, int *at, const char *directory, char **text);
uint64_t       GeoStringsHash(const GeoStrings *);
PetscErrorCode GeoStringsDestroy(GeoStrings *);
