/* The parameters that a .geo file declares: the names that gmsh's options -setnumber and -setstring can change.

   gmsh accepts any name and ignores names that the file does not declare. It also ignores a name to which the file
   assigns a value without declaring it (n = 4;). A file declares a parameter by DefineConstant[n = {4}] or by If
   (!Exists(n)). GeoParametersAdd() collects these names; call it for the text of each file. GeoParametersFind() then
   determines whether a name is a parameter, and GeoParametersText() lists them all. GeoParametersReset() frees the
   list. */
#pragma once
#include "base/petsccompat.h"

typedef struct {
  int n, room;
  /* A "*" at the end stands for any characters: of DefineConstant[n~{i} = 4] only n_ is known. */
  char **name;
} GeoParameters;

PetscErrorCode GeoParametersAdd(const char *text, GeoParameters *);
PetscBool      GeoParametersFind(const GeoParameters *, const char *name);
PetscErrorCode GeoParametersText(const GeoParameters *, char **text);
PetscErrorCode GeoParametersReset(GeoParameters *);
PetscErrorCode GeoTextStrip(const char *text, PetscBool strings, char **stripped);
