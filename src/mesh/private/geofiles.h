/* The files that a scene's .geo reads, and what they do besides geometry.

   GeoFilesRead() follows Include, Merge, ShapeFromFile, ListFromFile, FileExists and the files of size fields. It
   hashes what they hold, collects the parameters that they declare, and refuses commands that run programs or write
   files (geoscript.h). The name of a file may be a text, a variable that has one value, CurrentDirectory, or these put
   together by StrCat or Str. GeoFilesReset() frees the lists. */
#pragma once
#include "base/complaint.h"
#include "geodensities.h"
#include "geoparameters.h"
#include "scene/scene.h"
#include <stdint.h>

typedef struct {
  uint64_t      content;  /* hash of all files that are read */
  GeoParameters declared; /* by the .geo and the files that it reads */
  GeoDensities  densities; /* those of these parameters that refine the mesh */
  PetscBool     open;     /* the geometry may read files that are not known here, so that `content` may miss a change */
} GeoFiles;

PetscErrorCode GeoFilesRead(Scene, PetscBool trust, GeoFiles *, Complaint *);
PetscErrorCode GeoFilesReset(GeoFiles *);
