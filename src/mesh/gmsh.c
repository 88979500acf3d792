/* A scene's .geo becomes a .msh file: gmsh runs as a program of its own, once for each content of the .geo and its
   parameters. */
#include "gmsh.h"
#include "base/hash.h"
#include "geofiles.h"
#include "geoscript.h"
#include "gmshfile.h"
#include "gmshprocess.h"
#include "meshdraft.h"
#include <ctype.h>
#include <dirent.h>
#include <signal.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A message repeats so many lines of gmsh at most. One mistake makes gmsh print dozens. */
#define ERROR_LINES 6
/* Hexadecimal digits in the name of the mesh file for what is meshed. */
#define CONTENT_DIGITS 12
/* The digits behind these stand for the version of gmsh. They are apart so that a machine without gmsh finds a mesh of
   the same content. */
#define VERSION_DIGITS 4
/* Arguments of gmsh for given sizes of elements */
enum { SIZES_ARGUMENTS = 5 };

/* Appends a line of gmsh's output to a message. */
static void AppendLine(const char *line, char *text, size_t size)
{
  const size_t used = strlen(text);

  snprintf(text + used, size - used, "\n  gmsh: %.*s", (int)strcspn(line, "\n"), line);
}

/* Copies the first error lines of gmsh's output into text. All of them have the form "Error   : ..." or "Fatal   :
 * ...".
 */
static void ErrorLines(const char *output, char *text, size_t size)
{
  int lines = 0;

  text[0] = '\0';
  for (const char *line = output; line && lines < ERROR_LINES; line = strchr(line, '\n')) {
    line += *line == '\n';
    if ((strncmp(line, "Error", 5) && strncmp(line, "Fatal", 5)) || strstr(line, ": ---") == line + 8) continue;
    AppendLine(line, text, size);
    lines++;
  }
}

/* Copies the last lines of gmsh's output into text. */
static void LastLines(const char *output, char *text, size_t size)
{
  const char *line = output + strlen(output);
  int         lines;

  text[0] = '\0';
  for (lines = 0; line > output && lines < ERROR_LINES; lines++) {
    line--;
    while (line > output && line[-1] != '\n') line--;
  }
  for (; lines; lines--, line += strcspn(line, "\n") + 1) AppendLine(line, text, size);
}

/* Says that gmsh has failed: with its errors, or without any with what it printed last. */
static void ComplainFailed(Scene scene, int status, const char *errors, const char *output, Complaint *complaint)
{
  const char *where = SceneWhere(scene, "mesh", "file");
  char        last[1024];

  LastLines(output, last, sizeof(last));
  if (status > GMSH_KILLED)
    Complain(complaint, "%s: gmsh was ended on '%s' by signal %d (%s)%s; allowed: %s; its last lines:%s", where,
             scene->mesh_file, status - GMSH_KILLED, strsignal(status - GMSH_KILLED),
             status - GMSH_KILLED == SIGKILL ? ", mostly for lack of memory" : ", a crash of gmsh itself",
             status - GMSH_KILLED == SIGKILL ? "a coarser mesh, or more memory"
                                             : "another version of gmsh, other mesh.parameters, or a .msh file",
             last[0] ? last : " none");
  else if (errors[0])
    Complain(complaint, "%s: gmsh failed on '%s' (exit status %d)%s", where, scene->mesh_file, status, errors);
  else
    Complain(complaint, "%s: gmsh failed on '%s' (exit status %d) and names no error; its last lines:%s", where,
             scene->mesh_file, status, last[0] ? last : " none");
}

/* Refuses parameters that the .geo does not declare: gmsh would ignore them. A name with a dot is one of gmsh's own
   options. */
static PetscErrorCode CheckParameters(Scene scene, PetscBool trust, const GeoFiles *files, Complaint *complaint)
{
  char *names;

  PetscFunctionBeginUser;
  PetscCall(GeoParametersText(&files->declared, &names));
  for (int i = 0; i < scene->n_parameters; i++) {
    const char *key  = scene->parameters[i].key;
    const char *what = trust ? NULL : GeoOptionForbidden(key, (int)strlen(key));

    if (what)
      Complain(complaint,
               "%s: %s; allowed: options of geometry and mesh (-trust on the command line allows the others)",
               SceneWhere(scene, "mesh.parameters", key), what);
    if (files->open || strchr(key, '.') || GeoParametersFind(&files->declared, key)) continue;
    Complain(complaint, "%s: '%s' declares no parameter of this name; allowed: %s",
             SceneWhere(scene, "mesh.parameters", key), scene->mesh_file, names);
  }
  PetscCall(PetscFree(names));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Hashes the sizes of elements that the scene gives. */
static PetscErrorCode HashSizes(Scene scene, uint64_t *content, Complaint *complaint)
{
  char  *text;
  size_t size;

  PetscFunctionBeginUser;
  if (!scene->sizes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(GmshFileLoad(scene->sizes, &text, &size));
  if (!text)
    Complain(complaint, "%s: there is no file '%s'", SceneWhere(scene, "mesh", "sizes"), scene->sizes);
  else
    *content = HashBytes(*content, text, size);
  PetscCall(PetscFree(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Hashes all that the mesh depends on. The order of parameters in the scene does not matter, as each is hashed apart
   and the hashes are added. *open: the geometry may read files that the hash does not know. */
static PetscErrorCode HashScene(Scene scene, PetscBool trust, uint64_t *content, PetscBool *open, Complaint *complaint)
{
  GeoFiles files;
  char     text[64];
  uint64_t sum = 0;

  PetscFunctionBeginUser;
  PetscCall(GeoFilesRead(scene, trust, &files, complaint));
  PetscCall(CheckParameters(scene, trust, &files, complaint));
  for (int i = 0; i < scene->n_parameters; i++) {
    const ScenePair *pair = &scene->parameters[i];

    sum += HashFinish(
      HashBytes(HashBytes(HASH_START, pair->key, strlen(pair->key) + 1), pair->value, strlen(pair->value) + 1));
  }
  snprintf(text, sizeof(text), "%016llx %d %d", (unsigned long long)sum, scene->dim, scene->order);
  *content = HashBytes(files.content, text, strlen(text));
  PetscCall(HashSizes(scene, content, complaint));
  *open    = files.open;
  PetscCall(GeoFilesReset(&files));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the newest mesh of this content in the directory, whichever gmsh made it. */
static PetscErrorCode FindMesh(const char *directory, const char *prefix, char *file, PetscBool *found)
{
  DIR        *entries = opendir(directory);
  struct stat status;
  time_t      newest = 0;

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  if (!entries) PetscFunctionReturn(PETSC_SUCCESS);
  for (struct dirent *entry; (entry = readdir(entries));) {
    char   path[PETSC_MAX_PATH_LEN];
    size_t length = strlen(prefix);

    if (strncmp(entry->d_name, prefix, length) || strcmp(entry->d_name + strlen(entry->d_name) - 4, ".msh") ||
        strlen(entry->d_name) != length + VERSION_DIGITS + 4)
      continue;
    snprintf(path, sizeof(path), "%s/%s", directory, entry->d_name);
    if (stat(path, &status) || (*found && status.st_mtime <= newest)) continue;
    newest = status.st_mtime;
    *found = PETSC_TRUE;
    PetscCall(PetscStrncpy(file, path, PETSC_MAX_PATH_LEN));
  }
  closedir(entries);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool IsNumber(const char *text)
{
  char *end;

  strtod(text, &end);
  return *text && !*end ? PETSC_TRUE : PETSC_FALSE;
}

/* Runs gmsh on the .geo, in a folder of its own, beyond which it may not write unless the user trusts the scene. The
   mesh gets its name when it is whole. */
static PetscErrorCode MeshGeometry(Scene scene, const char *file, PetscBool trust, Complaint *complaint)
{
  MeshDraft    draft;
  char         dim[16], order[16], errors[1024], *output;
  const char **arguments;
  int          n = 0, status;

  PetscFunctionBeginUser;
  MeshDraftCreate(file, &draft, complaint);
  if (complaint->text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  snprintf(dim, sizeof(dim), "-%d", scene->dim);
  snprintf(order, sizeof(order), "%d", PetscMax(scene->order, 1));
  const char *const fixed[] = {"gmsh",
                               scene->mesh_file,
                               dim,
                               "-order",
                               order,
                               "-format",
                               "msh41",
                               "-nt",
                               "1",
                               "-v",
                               "2",
                               "-setnumber",
                               "Mesh.SecondOrderIncomplete",
                               "0"};
  /* Sizes of the scene's take the place of fields, and within bodies of all others. Sizes at points still bound those of
     curves. NULL: the name of their file */
  static const char *const sizes[SIZES_ARGUMENTS] = {"-bgm", NULL, "-setnumber", "Mesh.MeshSizeExtendFromBoundary",
                                                     "0"};

  PetscCall(PetscMalloc1(sizeof(fixed) / sizeof(*fixed) + 3 * (size_t)scene->n_parameters + SIZES_ARGUMENTS + 3,
                         &arguments));
  for (; n < (int)(sizeof(fixed) / sizeof(*fixed)); n++) arguments[n] = fixed[n];
  for (int i = 0; i < scene->n_parameters; i++) {
    arguments[n++] = IsNumber(scene->parameters[i].value) ? "-setnumber" : "-setstring";
    arguments[n++] = scene->parameters[i].key;
    arguments[n++] = scene->parameters[i].value;
  }
  for (int i = 0; scene->sizes && i < SIZES_ARGUMENTS; i++) arguments[n++] = sizes[i] ? sizes[i] : scene->sizes;
  arguments[n++] = "-o";
  arguments[n++] = draft.mesh;
  arguments[n]   = NULL;
  PetscCall(GmshExecute((char *const *)arguments, trust ? NULL : draft.folder, &output, &status));
  ErrorLines(output, errors, sizeof(errors));
  if (status || errors[0])
    ComplainFailed(scene, status, errors, output, complaint);
  else if (access(draft.mesh, F_OK))
    Complain(complaint, "%s: gmsh wrote no mesh for '%s'", SceneWhere(scene, "mesh", "file"), scene->mesh_file);
  PetscCall(MeshDraftFinish(&draft, file, complaint));
  PetscCall(PetscFree(output));
  PetscCall(PetscFree(arguments));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GmshGenerate - makes the scene's mesh file from its .geo, once.

  Not collective

  Input Parameters:
+ scene     - its mesh file, parameters, order and dimension are read
. directory - where mesh files are kept; it is made if it is not there
- trust     - PETSC_TRUE: the geometry may run programs and write files

  Output Parameters:
+ file      - the mesh file, DIRECTORY/mesh-HASH.msh (PETSC_MAX_PATH_LEN characters)
. seconds   - wall time of gmsh, 0 if the file was there already
- complaint - what was wrong, if anything

  Note:
  This is meant for one rank. The first CONTENT_DIGITS digits of HASH stand for the contents of the .geo and of what it
  includes, the parameters, dimension and order. The other digits stand for gmsh's version. Where there is no gmsh, a
  mesh of the same contents is taken whichever version made it. A parameter that the .geo does not declare is a
  complaint that lists those that it declares (geoparameters.h).

  A mesh that is there is taken as it is, unless the geometry may read files that the hash does not know: then it is
made anew each time.
@*/
PetscErrorCode GmshGenerate(Scene scene, const char *directory, PetscBool trust, char *file, PetscReal *seconds,
                            Complaint *complaint)
{
  char           prefix[MESH_NAME_ROOM], *version;
  uint64_t       content = 0;
  PetscBool      found, open = PETSC_FALSE;
  struct stat    there;
  PetscLogDouble start, end;

  PetscFunctionBeginUser;
  *seconds = 0;
  *file    = '\0';
  MeshDraftCheck(scene, directory, complaint);
  if (complaint->text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(HashScene(scene, trust, &content, &open, complaint));
  if (complaint->text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  snprintf(prefix, sizeof(prefix), "mesh-%0*llx", CONTENT_DIGITS,
           (unsigned long long)(content >> (64 - 4 * CONTENT_DIGITS)));
  PetscCall(GmshVersion(directory, &version));
  if (!version) {
    PetscCall(FindMesh(directory, prefix, file, &found));
    if (!found) {
      Complain(complaint,
               "%s: gmsh is not installed here and '%s' has not been meshed yet; where gmsh is, `burnish -mesh %s` "
               "makes %s/%s*.msh",
               SceneWhere(scene, "mesh", "file"), scene->mesh_file, scene->file, directory, prefix);
    }
  } else {
    uint64_t hash = HashBytes(HASH_START, version, strlen(version));

    snprintf(file, PETSC_MAX_PATH_LEN, "%s/%s%0*llx.msh", directory, prefix, VERSION_DIGITS,
             (unsigned long long)(hash >> (64 - 4 * VERSION_DIGITS)));
    if (open || stat(file, &there)) {
      PetscCall(PetscTime(&start));
      PetscCall(MeshGeometry(scene, file, trust, complaint));
      PetscCall(PetscTime(&end));
      *seconds = (PetscReal)(end - start);
    }
  }
  PetscCall(PetscFree(version));
  PetscFunctionReturn(PETSC_SUCCESS);
}
