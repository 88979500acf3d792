#include "base/errorlog.h"

/* The error handler's file name, and whether it has taken PETSc's error stream over. PETSc's handlers are per process,
 * so this is too. */
static struct {
  char      file[PETSC_MAX_PATH_LEN];
  PetscBool open;
} ErrorLog;

static PetscErrorCode ErrorLogHandler(MPI_Comm comm, int line, const char *function, const char *file,
                                      PetscErrorCode code, PetscErrorType type, const char *message, void *context)
{
  if (!ErrorLog.open) {
    FILE *log = fopen(ErrorLog.file, "w");

    ErrorLog.open = PETSC_TRUE;
    fprintf(stderr, "burnish: internal error or machine failure: %s; the trace is in %s\n",
            message ? message : "no message", log ? ErrorLog.file : "what follows");
    if (log) PETSC_STDERR = log;
  }
  PetscTraceBackErrorHandler(comm, line, function, file, code, type, message, context);
  fflush(PETSC_STDERR);
  return code;
}

/* ErrorLogOpen - sends the traces of PETSc's errors to directory/error.log.

   Not collective; each rank that fails writes its trace, the last one stays. directory must exist when an error comes,
   else the trace goes to stderr. */
PetscErrorCode ErrorLogOpen(const char *directory)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(ErrorLog.file, sizeof(ErrorLog.file), "%s/error.log", directory));
  PetscCall(PetscPushErrorHandler(ErrorLogHandler, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}
