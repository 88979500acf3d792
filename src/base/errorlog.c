/* PETSc's traces in a file, refusals without a trace. */
#include "base/errorlog.h"
#include "base/refusal.h"

/* Longest message that is kept for ErrorLogMessage(), in characters. PETSc's own messages have at most 2048. */
enum { ERROR_LOG_MESSAGE = 2048 };

static struct {
  char      file[PETSC_MAX_PATH_LEN];   /* empty: no directory is known yet */
  char      message[ERROR_LOG_MESSAGE]; /* of the first error; empty: there was none */
  FILE     *log;                        /* PETSC_STDERR while it is not NULL */
  FILE     *terminal;                   /* PETSC_STDERR as it was before */
  PetscBool told;                       /* the line on the terminal is written */
} ErrorLog;

/* Writes the line on the terminal and turns PETSc's error stream into the file. */
static void ErrorLogTell(const char *message)
{
  ErrorLog.told = PETSC_TRUE;
  ErrorLog.log  = fopen(ErrorLog.file, "w");
  fprintf(stderr, "burnish: internal error or machine failure: %s; the trace is in %s [B400]\n",
          message ? message : "no message", ErrorLog.log ? ErrorLog.file : "what follows");
  if (!ErrorLog.log) return;
  ErrorLog.terminal = PETSC_STDERR;
  PETSC_STDERR      = ErrorLog.log;
}

static PetscErrorCode ErrorLogHandler(MPI_Comm comm, int line, const char *function, const char *file,
                                      PetscErrorCode code, PetscErrorType type, const char *message, void *context)
{
  if (code == REFUSED && type == PETSC_ERROR_REPEAT && RefusalIsPending()) return code;
  if (!ErrorLog.message[0])
    snprintf(ErrorLog.message, sizeof(ErrorLog.message), "%s", message && *message ? message : "no message");
  if (!ErrorLog.told && ErrorLog.file[0]) ErrorLogTell(message);
  PetscTraceBackErrorHandler(comm, line, function, file, code, type, message, context);
  fflush(PETSC_STDERR);
  return code;
}

/*@
  ErrorLogBegin - installs the error handler of a run

  Not collective
@*/
PetscErrorCode ErrorLogBegin(void)
{
  PetscFunctionBeginUser;
  ErrorLog.file[0] = ErrorLog.message[0] = '\0';
  ErrorLog.told                          = PETSC_FALSE;
  PetscCall(PetscPushErrorHandler(ErrorLogHandler, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ErrorLogSetDirectory - sends the traces of PETSc's errors to directory/error.log from now on

  Not collective

  Input Parameter:
. directory - of the results. It must exist when an error comes, otherwise the trace goes to stderr.

  Note:
  Each rank that fails writes the file anew, so that the trace of the last one stays.
@*/
PetscErrorCode ErrorLogSetDirectory(const char *directory)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(ErrorLog.file, sizeof(ErrorLog.file), "%s/error.log", directory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ErrorLogMessage - returns the message of the first error since ErrorLogBegin(), empty if there was none

  Not collective
@*/
const char *ErrorLogMessage(void)
{
  return ErrorLog.message;
}

/*@
  ErrorLogEnd - removes the error handler, closes the file and gives PETSc's error stream back

  Not collective
@*/
PetscErrorCode ErrorLogEnd(void)
{
  PetscFunctionBeginUser;
  PetscCall(PetscPopErrorHandler());
  if (ErrorLog.log) {
    PETSC_STDERR = ErrorLog.terminal;
    fclose(ErrorLog.log);
    ErrorLog.log = NULL;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
