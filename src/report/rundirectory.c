/* Which directory a run may write into, and the record of the scene in it, see rundirectory.h. */
#include "report/rundirectory.h"
#include "base/refusal.h"
#include "files/textfile.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Open MPI 4 ends with a buffer overflow where the path of a file that all ranks write has some 240 characters. This
   many are allowed for the directory, counted from the root. */
#define DIRECTORY_LONGEST 220

enum {
  MESSAGE_SIZE = 2 * PETSC_MAX_PATH_LEN, /* characters of a refusal, which names up to two paths */
  LINE_SIZE    = 160                     /* characters of a line of a scene that a refusal quotes */
};

/* The record has the name of the scene's file in its first line, then the text of the scene. */
static const char RecordName[] = "scene.yaml", RecordHead[] = "# scene: ", SummaryName[] = "summary.json";

static PetscBool FileExists(const char *directory, const char *name)
{
  char path[TEXTFILE_PATH_SIZE];

  snprintf(path, sizeof(path), "%s/%s", directory, name);
  return access(path, F_OK) ? PETSC_FALSE : PETSC_TRUE;
}

static void FileRemove(const char *directory, const char *name)
{
  char path[TEXTFILE_PATH_SIZE];

  snprintf(path, sizeof(path), "%s/%s", directory, name);
  unlink(path);
}

/* Copies the line at text without its end. */
static void LineCopy(const char *text, char line[LINE_SIZE])
{
  snprintf(line, LINE_SIZE, "%.*s", (int)strcspn(text, "\n"), text);
}

/* Copies the first lines in which two texts differ; the end of a text is "(nothing)". */
static void FirstDifference(const char *a, const char *b, char line_a[LINE_SIZE], char line_b[LINE_SIZE])
{
  const size_t end = strlen("\n");

  while (*a && *b && strcspn(a, "\n") == strcspn(b, "\n") && !strncmp(a, b, strcspn(a, "\n"))) {
    a += strcspn(a, "\n");
    b += strcspn(b, "\n");
    a += *a ? end : 0;
    b += *b ? end : 0;
  }
  LineCopy(*a ? a : "(nothing)", line_a);
  LineCopy(*b ? b : "(nothing)", line_b);
}

/* Counts the characters in the path of a directory from the root. */
static size_t PathLength(const char *directory)
{
  char here[PETSC_MAX_PATH_LEN];

  return strlen(directory) + (directory[0] != '/' && getcwd(here, sizeof(here)) ? strlen(here) + 1 : 0);
}

/* Rank 0 says why the results in a directory are not those of this scene; an empty message if they may be. */
static void RecordComplaint(Scene scene, const char *directory, char message[MESSAGE_SIZE])
{
  char *record = TextFileRead(directory, RecordName), there[LINE_SIZE], line_there[LINE_SIZE], line_here[LINE_SIZE];
  const char *text;

  if (record && !strncmp(record, RecordHead, strlen(RecordHead))) {
    LineCopy(record + strlen(RecordHead), there);
    text = strchr(record, '\n');
    text = text ? text + 1 : "";
    if (strcmp(text, scene->text)) {
      FirstDifference(text, scene->text, line_there, line_here);
      snprintf(message, MESSAGE_SIZE,
               "%s holds the results of another scene: of %s, not of %s (first difference: \"%s\" there, \"%s\" here); "
               "allowed: another directory (-o DIR), or "
               "-overwrite",
               directory, there, scene->file, line_there, line_here);
    }
  } else if (record || FileExists(directory, SummaryName) || FileExists(directory, "steps.csv")) {
    snprintf(message, MESSAGE_SIZE,
             "%s holds results of an unknown scene, not of %s: it has no %s of ours; allowed: another directory (-o "
             "DIR), or -overwrite",
             directory, scene->file, RecordName);
  }
  free(record);
}

/* Rank 0 says why the directory may not be used; an empty message if it may. */
static void DirectoryComplaint(Scene scene, const char *directory, PetscBool overwrite, char message[MESSAGE_SIZE])
{
  struct stat status;

  *message = '\0';
  if (stat(directory, &status))
    return;
  else if (!S_ISDIR(status.st_mode))
    snprintf(message, MESSAGE_SIZE,
             "-o %s: a file of that name is in the way; allowed: a directory, or a name that is free", directory);
  else if (!overwrite)
    RecordComplaint(scene, directory, message);
}

/*@
  RunDirectoryCheckPath - refuses a directory whose path is too long for the files in it.

  Collective

  Input Parameters:
+ comm      - of the run
- directory - for the results; need not exist
@*/
PetscErrorCode RunDirectoryCheckPath(MPI_Comm comm, const char *directory)
{
  char        message[MESSAGE_SIZE] = "";
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank && PathLength(directory) > DIRECTORY_LONGEST)
    snprintf(
      message, sizeof(message),
      "-o %s: the path has %zu characters from the root; allowed: at most %d, as MPI's files take no longer ones",
      directory, PathLength(directory), DIRECTORY_LONGEST);
  PetscCall(RefuseInputAnywhere(comm, *message ? message : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RunDirectoryCheck - refuses a directory that a run must not write into.

  Collective

  Input Parameters:
+ comm      - of the run
. scene     - that is to be solved
. directory - for its results; need not exist
- overwrite - results of another scene may be overwritten

  Note:
  It refuses a name that is not a directory's and, unless overwrite is set, a directory with the results of
  another or an unknown scene. Results of the same scene are overwritten without
  a word. Nothing is written here. Call it before anything is written or solved.
@*/
PetscErrorCode RunDirectoryCheck(MPI_Comm comm, Scene scene, const char *directory, PetscBool overwrite)
{
  char        message[MESSAGE_SIZE] = "";
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) DirectoryComplaint(scene, directory, overwrite, message);
  PetscCall(RefuseInputAnywhere(comm, *message ? message : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RunDirectoryCheckRestart - refuses a directory whose record is of another problem than the checkpoint in it.

  Collective

  Input Parameters:
+ comm      - of the run
. scene     - of the checkpoint
- directory - of the results and the checkpoint

  Note:
  It refuses a record of another problem. A directory without a record is allowed: a checkpoint may be taken elsewhere.
@*/
PetscErrorCode RunDirectoryCheckRestart(MPI_Comm comm, Scene scene, const char *directory)
{
  char        message[MESSAGE_SIZE] = "", *record = NULL, *text;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) record = TextFileRead(directory, RecordName);
  text = record ? strchr(record, '\n') : NULL;
  if (text && !SceneSameProblem(text + 1, scene->text))
    snprintf(message, MESSAGE_SIZE,
             "%s holds the results of another scene than checkpoint.h5 there, which is of %s; allowed: the checkpoint "
             "of these results",
             directory, scene->file);
  free(record);
  PetscCall(RefuseInputAnywhere(comm, *message ? message : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rank 0 makes the directory and those above it; the message stays empty if the directory is there in the end. */
static void MakeDirectories(const char *directory, char message[MESSAGE_SIZE])
{
  char path[PETSC_MAX_PATH_LEN];

  *message = '\0';
  snprintf(path, sizeof(path), "%s", directory);
  for (char *slash = strchr(path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
    *slash = '\0';
    mkdir(path, 0777);
    *slash = '/';
  }
  if (mkdir(path, 0777) && errno != EEXIST)
    snprintf(message, MESSAGE_SIZE, "-o %s: the directory cannot be made: %s; allowed: a place that can be written",
             directory, strerror(errno));
  else if (access(path, W_OK | X_OK))
    snprintf(message, MESSAGE_SIZE, "-o %s: %s; allowed: a directory that can be written", directory, strerror(errno));
}

/*@
  RunDirectoryMake - makes the directory of a run and those above it.

  Collective

  Input Parameters:
+ comm      - of the run
- directory - for its results; may exist already

  Note:
  It refuses a directory that cannot be made or written.
@*/
PetscErrorCode RunDirectoryMake(MPI_Comm comm, const char *directory)
{
  char        message[MESSAGE_SIZE] = "";
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) MakeDirectories(directory, message);
  PetscCall(RefuseInputAnywhere(comm, *message ? message : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RunDirectoryClear - removes what an earlier run left in a directory.

  Not collective

  Input Parameter:
. directory - of the run

  Note:
  For one rank. A run that is killed then leaves no file of another run. steps.csv and scene.yaml are not removed, as
  the run begins with writing them anew.
@*/
void RunDirectoryClear(const char *directory)
{
  static const char *const names[] = {SummaryName,  "results.xdmf",  "bodies.xdmf",       "results.vtkhdf",
                                      "results.h5", "checkpoint.h5", "checkpoint.h5.tmp", "error.log"};

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(names); i++) FileRemove(directory, names[i]);
}

/*@
  RunDirectoryClearSummary - removes the summary of the run that a restart continues.

  Not collective

  Input Parameter:
. directory - of the run

  Note:
  For one rank. The summary is written again when the continued run ends.
@*/
void RunDirectoryClearSummary(const char *directory)
{
  FileRemove(directory, SummaryName);
}

/*@
  RunDirectoryWriteRecord - writes the record of a scene into the directory of its results.

  Not collective

  Input Parameters:
+ scene     - that the results are of
- directory - of the results; exists

  Note:
  For one rank. Errors: those of TextFileReplace().
@*/
PetscErrorCode RunDirectoryWriteRecord(Scene scene, const char *directory)
{
  const size_t size = strlen(RecordHead) + strlen(scene->file) + strlen(scene->text) + sizeof("\n");
  char        *text;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(size, &text));
  snprintf(text, size, "%s%s\n%s", RecordHead, scene->file, scene->text);
  PetscCall(TextFileReplace(directory, RecordName, text));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}
