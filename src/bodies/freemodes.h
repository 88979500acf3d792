/* Rigid motions that a scene leaves its bodies, found from the mesh, the supports and the contact surfaces before
   anything is solved: what only contact can hold, and what nothing holds (the tangent is singular then, whatever the
   load).

     FreeModesCreate(); FreeModesReport() or FreeModesRefuse(); FreeModesDestroy() */
#pragma once
#include "bodies/loads.h"

typedef struct _n_FreeModes *FreeModes;

PetscErrorCode FreeModesCreate(Mesh, Scene, Loads, FreeModes *);
PetscErrorCode FreeModesDestroy(FreeModes *);
/* One line for each motion, by body and direction; held: also a line that names the bodies that supports hold. Rank 0
 * prints. Collective. */
PetscErrorCode FreeModesReport(FreeModes, PetscBool held, FILE *);
/* Refuses (exit 1) a body that can move and that no contact pair knows. Collective. */
PetscErrorCode FreeModesRefuse(FreeModes);
/* "'ring', 'shaft'": bodies that no support and no imposed displacement holds. Collective. */
PetscErrorCode FreeModesUnheld(Mesh, Scene, Loads, size_t size, char *text);
