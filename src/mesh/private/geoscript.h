/* What a file in gmsh's language does besides geometry: it may run programs and write files.

   GeoScriptForbidden() finds the first command that does so. GeoOptionForbidden() tells it of one of gmsh's options,
   such as General.LogFileName. */
#pragma once
#include "geotokens.h"

const char *GeoScriptForbidden(const GeoTokens *, int *at);
const char *GeoOptionForbidden(const char *option, int length);
