/* Runs of gmsh, see gmshprocess.h. */
#define _GNU_SOURCE 1 /* execvpe */
#include "gmshprocess.h"
#include "base/confinement.h"
#include "base/petsccompat.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* File in the folder of the meshes that knows the version of the gmsh that was asked last. */
#define VERSION_FILE "gmsh-version.txt"
/* Room for what tells one program file from another, in bytes: a path, LD_LIBRARY_PATH and four numbers. */
#define IDENTITY_SIZE (3 * PETSC_MAX_PATH_LEN)

/* Tells whether an environment variable belongs to MPI. A gmsh that is linked with MPI would take itself for one of our
   ranks. */
static PetscBool EnvironmentIsMPI(const char *entry)
{
  const char *const prefixes[] = {"OMPI_", "PMIX_", "ORTE_", "PRTE_", "PMI_", "HYDRA_", "MPIR_"};

  for (size_t i = 0; i < sizeof(prefixes) / sizeof(*prefixes); i++)
    if (!strncmp(entry, prefixes[i], strlen(prefixes[i]))) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The environment of gmsh, to be freed with PetscFree(). It is ours without MPI's variables and without the user's own
   gmsh options, so that the same scene gives the same mesh everywhere. */
static PetscErrorCode ChildEnvironment(char ***environment)
{
  int n = 0, kept = 0;

  PetscFunctionBeginUser;
  while (environ[n]) n++;
  PetscCall(PetscMalloc1(n + 2, environment));
  for (int i = 0; i < n; i++)
    if (!EnvironmentIsMPI(environ[i]) && strncmp(environ[i], "GMSH_HOME=", 10)) (*environment)[kept++] = environ[i];
  (*environment)[kept++] = (char *)"GMSH_HOME=/nonexistent";
  (*environment)[kept]   = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Becomes gmsh in the child process of GmshExecute(). It never returns. */
static void ChildExecute(char *const arguments[], char *const environment[], const char *confined, int output)
{
  int input = open("/dev/null", O_RDONLY);

  dup2(input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  if (confined) ConfineProcess(confined);
  execvpe(arguments[0], arguments, environment);
  _exit(GMSH_NO_PROGRAM);
}

/* Reads all that comes through a pipe and closes it with a zero. */
static PetscErrorCode ReadPipe(int end, char **text)
{
  char   part[4096];
  size_t size = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, text));
  for (ssize_t n_read; (n_read = read(end, part, sizeof(part))) > 0 || (n_read < 0 && errno == EINTR);) {
    if (n_read < 0) continue;
    PetscCall(PetscRealloc(size + (size_t)n_read + 1, text));
    memcpy(*text + size, part, (size_t)n_read);
    size += (size_t)n_read;
    (*text)[size] = '\0';
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GmshExecute - runs gmsh and waits for its end.

  Not collective

  Input Parameters:
+ arguments - of the command line, the first one "gmsh", with NULL at the end
- confined  - folder outside which gmsh may not write; it may not start programs either. NULL: it may do anything

  Output Parameters:
+ output - all that it printed, to be freed with PetscFree()
- status - its exit status, or GMSH_NO_PROGRAM, or GMSH_KILLED plus the number of the signal that ended it

  Note:
  There is no shell, so that names are taken as they are.
@*/
PetscErrorCode GmshExecute(char *const arguments[], const char *confined, char **output, int *status)
{
  char **environment;
  int    ends[2];
  pid_t  child;

  PetscFunctionBeginUser;
  PetscCall(ChildEnvironment(&environment));
  PetscCheck(!pipe(ends), PETSC_COMM_SELF, PETSC_ERR_SYS, "pipe: %s", strerror(errno));
  child = fork();
  PetscCheck(child >= 0, PETSC_COMM_SELF, PETSC_ERR_SYS, "fork: %s", strerror(errno));
  if (!child) ChildExecute(arguments, environment, confined, ends[1]);
  close(ends[1]);
  PetscCall(ReadPipe(ends[0], output));
  close(ends[0]);
  while (waitpid(child, status, 0) < 0 && errno == EINTR) continue;
  *status = WIFEXITED(*status) ? WEXITSTATUS(*status) : GMSH_KILLED + WTERMSIG(*status);
  PetscCall(PetscFree(environment));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells whether a file is a program for this machine, not a script that may call any other program. */
static PetscBool IsBinary(const char *path)
{
  FILE     *stream = access(path, X_OK) ? NULL : fopen(path, "rb");
  char      start[4];
  PetscBool is = stream && fread(start, 1, 4, stream) == 4 && !memcmp(start, "\177ELF", 4) ? PETSC_TRUE : PETSC_FALSE;

  if (stream) fclose(stream);
  return is;
}

/* Writes what tells the gmsh of PATH from any other one, in one line: its file, when that was put there, and where its
   libraries are looked for. The text is empty where that is not known: the file is no binary, or there is none. */
static void GmshIdentity(char identity[IDENTITY_SIZE])
{
  const char *search = getenv("PATH"), *libraries = getenv("LD_LIBRARY_PATH");
  char        path[PETSC_MAX_PATH_LEN];
  struct stat there;

  identity[0] = '\0';
  for (size_t length; search; search = search[length] ? search + length + 1 : NULL) {
    length = strcspn(search, ":");
    if (snprintf(path, sizeof(path), "%.*s/gmsh", (int)length, search) >= (int)sizeof(path)) return;
    if (access(path, X_OK) || stat(path, &there) || !S_ISREG(there.st_mode)) continue;
    if (!IsBinary(path)) return;
    if (snprintf(identity, IDENTITY_SIZE, "%s %lld %lld %lld.%09ld %s\n", path, (long long)there.st_ino,
                 (long long)there.st_size, (long long)there.st_ctim.tv_sec, there.st_ctim.tv_nsec,
                 libraries ? libraries : "") >= IDENTITY_SIZE)
      identity[0] = '\0';
    return;
  }
}

/* Reads the version that the file knows for this gmsh; NULL where it knows another one or none. */
static PetscErrorCode ReadVersion(const char *file, const char *identity, char **version)
{
  FILE        *stream = identity[0] ? fopen(file, "r") : NULL;
  char         text[IDENTITY_SIZE + 256];
  const size_t length = strlen(identity);
  size_t       size;

  PetscFunctionBeginUser;
  *version = NULL;
  if (!stream) PetscFunctionReturn(PETSC_SUCCESS);
  size       = fread(text, 1, sizeof(text) - 1, stream);
  text[size] = '\0';
  fclose(stream);
  if (size > length && !strncmp(text, identity, length)) PetscCall(PetscStrallocpy(text + length, version));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the file as a whole. Where that fails, gmsh is asked again the next time. */
static void WriteVersion(const char *file, const char *identity, const char *version)
{
  char  temporary[PETSC_MAX_PATH_LEN + 32];
  FILE *stream;
  int   failed;

  snprintf(temporary, sizeof(temporary), "%s.%d", file, (int)getpid());
  if (!identity[0] || !(stream = fopen(temporary, "w"))) return;
  failed = fprintf(stream, "%s%s", identity, version) < 0;
  failed |= fclose(stream);
  if (failed || rename(temporary, file)) unlink(temporary);
}

/*@
  GmshVersion - returns what gmsh says of its version.

  Not collective

  Input Parameter:
. directory - folder of the meshes, if it is there already

  Output Parameter:
. version - to be freed with PetscFree(); NULL where there is no gmsh

  Note:
  gmsh takes as long to start as a small run. So the folder keeps the answer together with the file that gave it. A gmsh
  that is a script is asked each time, as it may call another one.
@*/
PetscErrorCode GmshVersion(const char *directory, char **version)
{
  char *const ask[] = {(char *)"gmsh", (char *)"--version", NULL};
  char        file[PETSC_MAX_PATH_LEN], identity[IDENTITY_SIZE];
  int         status;

  PetscFunctionBeginUser;
  snprintf(file, sizeof(file), "%s/%s", directory, VERSION_FILE);
  GmshIdentity(identity);
  PetscCall(ReadVersion(file, identity, version));
  if (*version) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(GmshExecute(ask, NULL, version, &status));
  if (!status) WriteVersion(file, identity, *version);
  if (status == GMSH_NO_PROGRAM) PetscCall(PetscFree(*version));
  PetscFunctionReturn(PETSC_SUCCESS);
}
