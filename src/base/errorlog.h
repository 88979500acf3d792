/* The error handler of a run. It writes the traces of internal errors and machine failures (exit status 4) to
   DIR/error.log and one line to the terminal. It lets refusals (refusal.h) pass without a word.

   ErrorLogBegin() installs the handler and ErrorLogEnd() removes it, around each run. ErrorLogSetDirectory() names the
   directory of the results as soon as it is known; until then the trace goes to stderr. ErrorLogMessage() says what the
   first error was.

   The state belongs to the process as a whole, because PETSc's error handlers and its error stream PETSC_STDERR do. */
#pragma once
#include "base/petsccompat.h"

PetscErrorCode ErrorLogBegin(void);
PetscErrorCode ErrorLogSetDirectory(const char *directory);
const char    *ErrorLogMessage(void);
PetscErrorCode ErrorLogEnd(void);
