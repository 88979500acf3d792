/* Rigid motions that a scene leaves its bodies: those that only contact can hold, and those that nothing holds, for
   which the tangent is singular whatever the load. They are found from the mesh, the supports and the contact surfaces
   before anything is solved.

   FreeModesCreate() finds them; FreeModesReport() prints them, FreeModesRefuse() refuses a scene with a body that
   can never be held; FreeModesDestroy(). FreeModesUnheld() answers a simpler question without the object. */
#pragma once
#include "bodies/loads.h"

typedef struct _n_FreeModes *FreeModes;

PetscErrorCode FreeModesCreate(Mesh, Scene, Loads, FreeModes *);
PetscErrorCode FreeModesDestroy(FreeModes *);
PetscErrorCode FreeModesReport(FreeModes, PetscBool held, FILE *);
PetscErrorCode FreeModesRefuse(FreeModes);
PetscErrorCode FreeModesUnheld(Mesh, Scene, Loads, size_t size, char *text);
