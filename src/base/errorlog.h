/* Internal errors and machine failures (exit status 4): PETSc's trace goes to DIR/error.log, the terminal gets one
 * line. */
#pragma once
#include "base/petsccompat.h"

/* From here on traces go to directory/error.log (made when the first error comes). Not collective. */
PetscErrorCode ErrorLogOpen(const char *directory);
