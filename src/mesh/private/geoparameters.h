/* The parameters that a .geo file declares: the names that gmsh's options -setnumber and -setstring can change.

   gmsh accepts any name and ignores names that the file does not use. It also ignores a name to which the file assigns
   a value without declaring it (n = 4;). A file declares a parameter by DefineConstant[n = {4}] or by If (!Exists(n)).
   A name that a file uses without a value of its own is a parameter, too: the file then cannot be read without it.
   GeoParametersAdd() collects all these names; call it for the text of each file. GeoParametersFind() then determines
   whether a name is a parameter, and GeoParametersText() lists those that are declared. GeoParametersReset() frees the
   lists. */
#pragma once
#include "base/petsccompat.h"

typedef struct {
  int    n, room;
  char **name;
} GeoNames;

typedef struct {
  GeoNames declared; /* "n_*" stands for all names with this beginning, because of DefineConstant[n~{i} = 4] */
  GeoNames used;     /* names that occur in an expression */
  GeoNames assigned; /* names that get a value from the file, loop variables among them */
} GeoParameters;

PetscErrorCode GeoParametersAdd(const char *text, GeoParameters *);
PetscBool      GeoParametersFind(const GeoParameters *, const char *name);
PetscErrorCode GeoParametersText(const GeoParameters *, char **text);
PetscErrorCode GeoParametersReset(GeoParameters *);
