/* Rigid motions that a scene leaves its bodies: those that only contact can hold, and those that nothing holds, for
   which the tangent is singular whatever the load. They are found from the mesh, the supports and the contact surfaces
   before anything is solved.

   FreeModesCreate() finds them; FreeModesReport() prints them, FreeModesRefuse() refuses a scene with a body that
   can never be held; FreeModesDestroy(). FreeModesGetPieces() shows the motions that supports leave to each piece of
   the mesh, FreeModesMotionText() puts a motion into words. FreeModesUnheld() answers a simpler question without the
   object. */
#pragma once
#include "bodies/loads.h"
#include "kernels/rigidkernel.h"

/* Characters of the text of one motion or name. */
enum { FREE_TEXT = 320 };

/* A connected piece of the mesh. Its motions are measured at its own centre, in units of its size (rigidkernel.h). */
typedef struct {
  char            name[FREE_TEXT];
  PetscReal       centre[3], size; /* of its bounding box, relative to the mesh's centre; half the diagonal */
  int             body;            /* one of its bodies */
  PetscBool       paired;          /* a contact pair knows it */
  const MeshTool *tool;            /* it is a rigid tool, whose size is its arm; NULL: it has cells */
  int             n_free;          /* motions that supports leave */
  double          free[RIGID_MODES * RIGID_MODES];
} FreePiece;

typedef struct _n_FreeModes *FreeModes;

PetscErrorCode FreeModesCreate(Mesh, Scene, Loads, FreeModes *);
PetscErrorCode FreeModesDestroy(FreeModes *);
PetscErrorCode FreeModesReport(FreeModes, PetscBool held, FILE *);
PetscErrorCode FreeModesRefuse(FreeModes, const char *step);
PetscBool      FreeModesAny(FreeModes);
PetscErrorCode FreeModesGetPieces(FreeModes, PetscInt *n, const FreePiece **pieces, const PetscInt **piece);
void           FreeModesMotionText(FreeModes, PetscInt piece, const double motion[RIGID_MODES], char text[FREE_TEXT]);
PetscErrorCode FreeModesOnSide(FreeModes, int contact, PetscBool master, int on[]);
void FreeModesNodeVelocity(Mesh, const FreePiece *, PetscInt node, const PetscReal *u, const double motion[RIGID_MODES],
                           double v[3]);
PetscErrorCode FreeModesUnheld(Mesh, Scene, Loads, size_t size, char *text);
