/* The parameters that a .geo file declares: the names that -setnumber and -setstring of gmsh can change.

   gmsh takes any name and ignores those that the file does not ask for. It also ignores a name that the file assigns
   without asking (n = 4;). A file asks by DefineConstant[n = {4}], or by If (!Exists(n)). GeoParametersAdd() collects
   these names from the text of each file in turn. GeoParametersFind() and GeoParametersText() then tell which names
   there are. */
#pragma once
#include "base/petsccompat.h"

typedef struct {
  int    n, room;
  char **name; /* an end "*" stands for any characters: of DefineConstant[n~{i} = 4] only n_ is known */
} GeoParameters;

PetscErrorCode GeoParametersAdd(const char *text, GeoParameters *);
PetscBool      GeoParametersFind(const GeoParameters *, const char *name);
PetscErrorCode GeoParametersText(const GeoParameters *, char **text);
PetscErrorCode GeoParametersReset(GeoParameters *);
PetscErrorCode GeoTextStrip(const char *text, PetscBool strings, char **stripped);
