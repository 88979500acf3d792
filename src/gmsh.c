#define _GNU_SOURCE 1 /* execvpe, memmem */
#include "gmsh.h"
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum {
  GMSH_POINT         = 15, /* gmsh's type number of a point */
  GMSH_POLYGON       = 34, /* from here on gmsh's numbers are for elements without a fixed shape */
  INCLUDE_DEPTH      = 16, /* a .geo that includes itself must not recurse for ever */
  ERROR_LINES        = 6,  /* of gmsh that a message repeats: one mistake makes it print dozens */
  CONTENT_DIGITS     = 12, /* of the file name's hash: what is meshed ... */
  VERSION_DIGITS     = 4,  /* ... and by which gmsh, so that a machine without gmsh can still find the mesh */
  TEXT_PARTS_IN_NAME = 64  /* room in a path for "/mesh-", hash, process number and ending */
};

static const char *const RefusedElements[] = {[6] = "6-node prism",       [7] = "5-node pyramid",      [13] = "18-node prism", [14] = "14-node pyramid",
                                              [16] = "8-node quadrangle", [17] = "20-node hexahedron", [18] = "15-node prism", [19] = "13-node pyramid"};

/*
  GmshSay - writes down a mistake unless an earlier one stands there already

  Not Collective

  Input Parameters:
+ message - where the first mistake is kept
- format  - and its arguments, as for printf
*/
PetscErrorCode GmshSay(GmshMessage *message, const char *format, ...)
{
  va_list arguments;

  PetscFunctionBeginUser;
  if (message->text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  va_start(arguments, format);
  vsnprintf(message->text, sizeof(message->text), format, arguments);
  va_end(arguments);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ------------------------------------------------------------------------------------------------------------ files */

static PetscErrorCode FileLoad(const char *file, char **data, size_t *size, PetscBool *found)
{
  FILE *stream = fopen(file, "rb");
  long  length = -1;

  PetscFunctionBeginUser;
  *data  = NULL;
  *size  = 0;
  *found = PETSC_FALSE;
  if (!stream) PetscFunctionReturn(PETSC_SUCCESS);
  if (!fseek(stream, 0, SEEK_END)) length = ftell(stream);
  if (length >= 0) {
    rewind(stream);
    PetscCall(PetscMalloc1((size_t)length + 1, data));
    *size          = fread(*data, 1, (size_t)length, stream);
    (*data)[*size] = '\0';
    *found         = PETSC_TRUE;
  }
  fclose(stream);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ------------------------------------------------------------------------------------------------------ running gmsh */

/* Is this variable Open MPI's? A gmsh that is linked with MPI would take itself for a rank of ours. */
static PetscBool EnvironmentIsMPI(const char *entry)
{
  const char *const prefixes[] = {"OMPI_", "PMIX_", "ORTE_", "PRTE_", "PMI_", "HYDRA_", "MPIR_"};

  for (size_t i = 0; i < sizeof(prefixes) / sizeof(*prefixes); i++)
    if (!strncmp(entry, prefixes[i], strlen(prefixes[i]))) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The child's half of GmshExecute(): never returns. Status 127: no such program. */
static void ChildExecute(char *const arguments[], char *const environment[], int output)
{
  int input = open("/dev/null", O_RDONLY);

  dup2(input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  execvpe(arguments[0], arguments, environment);
  _exit(127);
}

/* Runs gmsh without a shell; output: all that it printed (to be freed by PetscFree), status 127: there is no gmsh. */
static PetscErrorCode GmshExecute(char *const arguments[], char **output, int *status)
{
  char **environment, part[4096];
  int    n = 0, kept = 0, ends[2];
  size_t size = 0;
  pid_t  child;

  PetscFunctionBeginUser;
  while (environ[n]) n++;
  PetscCall(PetscMalloc1(n + 2, &environment));
  for (int i = 0; i < n; i++)
    if (!EnvironmentIsMPI(environ[i]) && strncmp(environ[i], "GMSH_HOME=", 10)) environment[kept++] = environ[i];
  environment[kept++] = (char *)"GMSH_HOME=/nonexistent"; /* the same scene gives the same mesh whatever the user's own gmsh options are */
  environment[kept]   = NULL;
  PetscCheck(!pipe(ends), PETSC_COMM_SELF, PETSC_ERR_SYS, "pipe: %s", strerror(errno));
  child = fork();
  PetscCheck(child >= 0, PETSC_COMM_SELF, PETSC_ERR_SYS, "fork: %s", strerror(errno));
  if (!child) ChildExecute(arguments, environment, ends[1]);
  close(ends[1]);
  PetscCall(PetscCalloc1(1, output));
  for (ssize_t n_read; (n_read = read(ends[0], part, sizeof(part))) > 0 || (n_read < 0 && errno == EINTR);) {
    if (n_read < 0) continue;
    PetscCall(PetscRealloc(size + (size_t)n_read + 1, output));
    memcpy(*output + size, part, (size_t)n_read);
    size += (size_t)n_read;
    (*output)[size] = '\0';
  }
  close(ends[0]);
  while (waitpid(child, status, 0) < 0 && errno == EINTR) continue;
  *status = WIFEXITED(*status) ? WEXITSTATUS(*status) : 128;
  PetscCall(PetscFree(environment));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first error lines of gmsh's output into text; all of them are of the form "Error   : ..." */
static void ErrorLines(const char *output, char *text, size_t size)
{
  int lines = 0;

  text[0] = '\0';
  for (const char *line = output; line && lines < ERROR_LINES; line = strchr(line, '\n')) {
    line += *line == '\n';
    if (strncmp(line, "Error", 5) || strstr(line, ": ---") == line + 8) continue;
    size_t used = strlen(text);
    snprintf(text + used, size - used, "\n  gmsh: %.*s", (int)strcspn(line, "\n"), line);
    lines++;
  }
}

/* What goes into a mesh: hashed by FNV-1a (64 bits; Fowler, Noll, Vo), which needs no library and spreads well enough for a file name */
typedef struct {
  Scene      scene;
  uint64_t   content;
  PetscBool *used; /* per parameter: some file speaks of it */
} Fingerprint;

static const uint64_t FNV_BASIS = 14695981039346656037ull, FNV_PRIME = 1099511628211ull;

static uint64_t Hash(uint64_t hash, const char *data, size_t size)
{
  for (size_t i = 0; i < size; i++) hash = (hash ^ (unsigned char)data[i]) * FNV_PRIME;
  return hash;
}

static PetscBool HasWord(const char *text, const char *word)
{
  size_t length = strlen(word);

  for (const char *at = text; (at = strstr(at, word)); at += length) {
    int before = at > text ? (unsigned char)at[-1] : ' ', after = (unsigned char)at[length];
    if (!isalnum(before) && before != '_' && !isalnum(after) && after != '_') return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscErrorCode FingerprintFile(Fingerprint *, const char *, int);

/* Follows every Include "FILE" and Merge "FILE"; a name that gmsh computes cannot be followed. */
static PetscErrorCode FingerprintIncludes(Fingerprint *print, const char *file, const char *text, int depth)
{
  const char *const commands[] = {"Include", "Merge"};
  const char       *slash      = strrchr(file, '/');
  int               directory  = slash ? (int)(slash - file) + 1 : 0;

  PetscFunctionBeginUser;
  for (int i = 0; i < 2; i++) {
    for (const char *at = text; (at = strstr(at, commands[i]));) {
      char path[PETSC_MAX_PATH_LEN];

      at += strlen(commands[i]);
      at += strspn(at, " \t");
      if (*at != '"') continue;
      at++;
      snprintf(path, sizeof(path), "%.*s%.*s", *at == '/' ? 0 : directory, file, (int)strcspn(at, "\"\n"), at);
      PetscCall(FingerprintFile(print, path, depth + 1));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FingerprintFile(Fingerprint *print, const char *file, int depth)
{
  char     *text;
  size_t    size;
  PetscBool found;

  PetscFunctionBeginUser;
  if (depth > INCLUDE_DEPTH) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FileLoad(file, &text, &size, &found));
  if (!found) PetscFunctionReturn(PETSC_SUCCESS); /* gmsh complains if it matters */
  print->content = Hash(print->content, text, size + 1);
  for (int i = 0; i < print->scene->n_parameters; i++)
    if (HasWord(text, print->scene->parameters[i].key)) print->used[i] = PETSC_TRUE;
  PetscCall(FingerprintIncludes(print, file, text, depth));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The order of parameters in the scene does not matter: each is hashed apart and the hashes are added. */
static PetscErrorCode FingerprintScene(Scene scene, uint64_t *content, GmshMessage *message)
{
  Fingerprint print = {.scene = scene, .content = FNV_BASIS};
  char        text[64];
  uint64_t    sum = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(scene->n_parameters, &print.used));
  PetscCall(FingerprintFile(&print, scene->mesh_file, 0));
  for (int i = 0; i < scene->n_parameters; i++) {
    const ScenePair *pair = &scene->parameters[i];
    /* a name with a dot is one of gmsh's own options */
    if (!print.used[i] && !strchr(pair->key, '.'))
      PetscCall(GmshSay(message, "%s: '%s' has no parameter of this name", SceneWhere(scene, "mesh.parameters", pair->key), scene->mesh_file));
    sum += Hash(Hash(FNV_BASIS, pair->key, strlen(pair->key) + 1), pair->value, strlen(pair->value) + 1);
  }
  snprintf(text, sizeof(text), "%016llx %d %d", (unsigned long long)sum, scene->dim, scene->order);
  *content = Hash(print.content, text, strlen(text));
  PetscCall(PetscFree(print.used));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The newest mesh of this content in the directory, whichever gmsh made it */
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

static PetscErrorCode MeshGeometry(Scene scene, const char *file, GmshMessage *message)
{
  char         temporary[PETSC_MAX_PATH_LEN + TEXT_PARTS_IN_NAME], dim[16], order[16], errors[1024], *output;
  const char **arguments;
  int          n = 0, status;
  struct stat  made;

  PetscFunctionBeginUser;
  snprintf(temporary, sizeof(temporary), "%s.%d.tmp", file, (int)getpid());
  snprintf(dim, sizeof(dim), "-%d", scene->dim);
  snprintf(order, sizeof(order), "%d", PetscMax(scene->order, 1));
  const char *const fixed[] = {
    "gmsh", scene->mesh_file, dim, "-order", order, "-format", "msh41", "-nt", "1", "-v", "2", "-setnumber", "Mesh.SecondOrderIncomplete", "0"};
  PetscCall(PetscMalloc1(sizeof(fixed) / sizeof(*fixed) + 3 * (size_t)scene->n_parameters + 3, &arguments));
  for (; n < (int)(sizeof(fixed) / sizeof(*fixed)); n++) arguments[n] = fixed[n];
  for (int i = 0; i < scene->n_parameters; i++) {
    arguments[n++] = IsNumber(scene->parameters[i].value) ? "-setnumber" : "-setstring";
    arguments[n++] = scene->parameters[i].key;
    arguments[n++] = scene->parameters[i].value;
  }
  arguments[n++] = "-o";
  arguments[n++] = temporary;
  arguments[n]   = NULL;
  PetscCall(GmshExecute((char *const *)arguments, &output, &status));
  ErrorLines(output, errors, sizeof(errors));
  if (status || errors[0])
    PetscCall(GmshSay(message, "%s: gmsh failed on '%s' (exit status %d)%s", SceneWhere(scene, "mesh", "file"), scene->mesh_file, status, errors));
  else if (stat(temporary, &made))
    PetscCall(GmshSay(message, "%s: gmsh wrote no mesh for '%s'", SceneWhere(scene, "mesh", "file"), scene->mesh_file));
  else if (rename(temporary, file))
    PetscCall(GmshSay(message, "cannot write '%s': %s", file, strerror(errno)));
  unlink(temporary);
  PetscCall(PetscFree(output));
  PetscCall(PetscFree(arguments));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeDirectories(const char *directory, GmshMessage *message)
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(path, directory, sizeof(path)));
  for (char *at = path + 1; *path && *at; at++) {
    if (*at != '/') continue;
    *at = '\0';
    mkdir(path, 0777);
    *at = '/';
  }
  if (mkdir(path, 0777) && errno != EEXIST) PetscCall(GmshSay(message, "cannot make the directory '%s' for meshes: %s", directory, strerror(errno)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  GmshGenerate - makes the scene's mesh file from its .geo, once

  Not Collective; meant for one rank

  Input Parameters:
+ scene     - file, parameters, order and dimension are read
- directory - where mesh files are kept (made if it is not there)

  Output Parameters:
+ file    - the mesh file, DIRECTORY/mesh-HASH.msh (PETSC_MAX_PATH_LEN characters)
. seconds - wall time of gmsh, 0 if the file was there already
- message - what was wrong, if anything

  Note:
  HASH stands for the contents of the .geo and of what it includes, the parameters, dimension and order (first CONTENT_DIGITS digits) and
  gmsh's version (the rest). Where there is no gmsh, a mesh of the same contents is taken whichever version made it.
*/
PetscErrorCode GmshGenerate(Scene scene, const char *directory, char *file, PetscReal *seconds, GmshMessage *message)
{
  char *const    ask[] = {(char *)"gmsh", (char *)"--version", NULL};
  char           prefix[TEXT_PARTS_IN_NAME], *version;
  int            status;
  uint64_t       content = 0;
  PetscBool      found;
  struct stat    there;
  PetscLogDouble start, end;

  PetscFunctionBeginUser;
  *seconds = 0;
  *file    = '\0';
  if (stat(scene->mesh_file, &there)) PetscCall(GmshSay(message, "%s: there is no file '%s'", SceneWhere(scene, "mesh", "file"), scene->mesh_file));
  if (strlen(directory) + TEXT_PARTS_IN_NAME > PETSC_MAX_PATH_LEN) PetscCall(GmshSay(message, "the path '%s' is too long", directory));
  if (message->text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FingerprintScene(scene, &content, message));
  if (message->text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  snprintf(prefix, sizeof(prefix), "mesh-%0*llx", CONTENT_DIGITS, (unsigned long long)(content >> (64 - 4 * CONTENT_DIGITS)));
  PetscCall(GmshExecute(ask, &version, &status));
  if (status == 127) {
    PetscCall(FindMesh(directory, prefix, file, &found));
    if (!found) {
      PetscCall(GmshSay(message, "%s: gmsh is not installed here and '%s' has not been meshed yet; where gmsh is, `burnish -mesh %s` makes %s/%s*.msh",
                        SceneWhere(scene, "mesh", "file"), scene->mesh_file, scene->file, directory, prefix));
    }
  } else {
    uint64_t hash = Hash(FNV_BASIS, version, strlen(version));

    snprintf(file, PETSC_MAX_PATH_LEN, "%s/%s%0*llx.msh", directory, prefix, VERSION_DIGITS, (unsigned long long)(hash >> (64 - 4 * VERSION_DIGITS)));
    if (stat(file, &there)) {
      PetscCall(PetscTime(&start));
      PetscCall(MakeDirectories(directory, message));
      if (!message->text[0]) PetscCall(MeshGeometry(scene, file, message));
      PetscCall(PetscTime(&end));
      *seconds = (PetscReal)(end - start);
    }
  }
  PetscCall(PetscFree(version));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ------------------------------------------------------------------------------------------------------ reading .msh */

/* An entity of the geometry and the physical groups it is in (signed tags) */
typedef struct {
  int dim, tag, n, *physical;
} Entity;

/* A cursor over the file in memory. After the first mistake every read returns 0, so that loops come to their end. */
typedef struct {
  const char  *file;
  char        *data;
  size_t       size, at;
  PetscBool    binary;
  char         section[64];
  GmshMessage *message;
  GmshMesh    *mesh;
  PetscInt     n_entities;
  Entity      *entities;
  PetscBool   *used; /* node -> some element has it */
} Reader;

static PetscBool ReaderFailed(const Reader *r)
{
  return r->message->text[0] ? PETSC_TRUE : PETSC_FALSE;
}

/* The file ends or makes no sense: says in which section and where. */
static void ReaderDamaged(Reader *r)
{
  size_t line = 1;

  if (ReaderFailed(r)) return;
  for (size_t i = 0; i < r->at && i < r->size; i++) line += r->data[i] == '\n';
  if (r->binary)
    (void)GmshSay(r->message, "%s: the file is truncated or damaged in section %s (byte %zu of %zu)", r->file, r->section, r->at, r->size);
  else
    (void)GmshSay(r->message, "%s:%zu: the file is truncated or damaged in section %s", r->file, line, r->section);
}

static void ReadBytes(Reader *r, void *value, size_t size)
{
  memset(value, 0, size);
  if (ReaderFailed(r)) return;
  if (r->size - r->at < size)
    ReaderDamaged(r);
  else {
    memcpy(value, r->data + r->at, size);
    r->at += size;
  }
}

static long long ReadTextInteger(Reader *r)
{
  char     *end;
  long long value;

  if (ReaderFailed(r)) return 0;
  value = strtoll(r->data + r->at, &end, 10);
  if (end == r->data + r->at || !isspace((unsigned char)*end))
    ReaderDamaged(r);
  else
    r->at = (size_t)(end - r->data);
  return value;
}

static int ReadInt(Reader *r)
{
  int value;

  if (!r->binary) return (int)ReadTextInteger(r);
  ReadBytes(r, &value, sizeof(value));
  return value;
}

static long long ReadSize(Reader *r)
{
  int64_t value;

  if (!r->binary) return ReadTextInteger(r);
  ReadBytes(r, &value, sizeof(value));
  return value;
}

/* A number of things that follow: each takes at least one byte, so that a damaged count cannot ask for more memory than the file has */
static PetscInt ReadCount(Reader *r)
{
  long long value = ReadSize(r);

  if (value < 0 || (size_t)value > r->size - r->at || value > PETSC_MAX_INT) {
    ReaderDamaged(r);
    return 0;
  }
  return (PetscInt)value;
}

static PetscInt ReadTag(Reader *r)
{
  long long value = ReadSize(r);

  if (value < 0 || value > PETSC_MAX_INT) (void)GmshSay(r->message, "%s: tag %lld does not fit into this build's index type", r->file, value);
  return (PetscInt)value;
}

static double ReadDouble(Reader *r)
{
  double value = 0;
  char  *end;

  if (r->binary) {
    ReadBytes(r, &value, sizeof(value));
    return value;
  }
  if (ReaderFailed(r)) return 0;
  value = strtod(r->data + r->at, &end);
  if (end == r->data + r->at || !isspace((unsigned char)*end))
    ReaderDamaged(r);
  else
    r->at = (size_t)(end - r->data);
  return value;
}

static void SkipSpace(Reader *r)
{
  while (r->at < r->size && isspace((unsigned char)r->data[r->at])) r->at++;
}

/* The rest of the line, without the end of line */
static void ReadLine(Reader *r, char *line, size_t size)
{
  size_t length = strcspn(r->data + r->at, "\r\n");

  snprintf(line, size, "%.*s", (int)PetscMin(length, size - 1), r->data + r->at);
  r->at += length;
  while (r->at < r->size && (r->data[r->at] == '\r' || r->data[r->at] == '\n')) {
    if (r->data[r->at++] == '\n') break;
  }
}

static PetscErrorCode ReadFormat(Reader *r)
{
  char line[256], version[16] = "";
  int  binary = 0, size = 0, one = 1;

  PetscFunctionBeginUser;
  ReadLine(r, line, sizeof(line));
  if (sscanf(line, "%15s %d %d", version, &binary, &size) != 3)
    ReaderDamaged(r);
  else if (strcmp(version, "4.1")) {
    PetscCall(
      GmshSay(r->message, "%s: file format %s is not read, only gmsh's 4.1; convert it: gmsh %s -save -format msh41 -o NEW.msh", r->file, version, r->file));
  } else if (size != 8)
    PetscCall(GmshSay(r->message, "%s: written with data size %d, only 8 is read", r->file, size));
  if (!ReaderFailed(r) && binary) {
    r->binary = PETSC_TRUE;
    ReadBytes(r, &one, sizeof(one));
    if (one != 1)
      PetscCall(
        GmshSay(r->message, "%s: binary file of a machine with another byte order; write it as text: gmsh FILE.geo -format msh41 without -bin", r->file));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Names are text in binary files too. */
static PetscErrorCode ReadPhysicalNames(Reader *r)
{
  PetscBool binary = r->binary;
  PetscInt  n;

  PetscFunctionBeginUser;
  r->binary = PETSC_FALSE;
  n         = ReadCount(r);
  PetscCall(PetscCalloc1(n, &r->mesh->physicals));
  for (PetscInt i = 0; i < n && !ReaderFailed(r); i++) {
    GmshPhysical *physical = &r->mesh->physicals[i];
    char          line[512];
    size_t        length;

    physical->dim = ReadInt(r);
    physical->tag = (PetscInt)ReadTextInteger(r);
    SkipSpace(r);
    ReadLine(r, line, sizeof(line));
    length = strlen(line);
    if (length < 3 || line[0] != '"' || line[length - 1] != '"')
      ReaderDamaged(r);
    else
      line[length - 1] = '\0';
    PetscCall(PetscStrallocpy(line + 1, &physical->name));
    r->mesh->n_physicals++;
  }
  r->binary = binary;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadEntities(Reader *r)
{
  PetscInt n[4], total = 0;

  PetscFunctionBeginUser;
  for (int dim = 0; dim < 4; dim++) {
    n[dim] = ReadCount(r);
    total += n[dim];
  }
  if (ReaderFailed(r)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(total, &r->entities));
  for (int dim = 0; dim < 4; dim++) {
    for (PetscInt i = 0; i < n[dim] && !ReaderFailed(r); i++) {
      Entity *entity = &r->entities[r->n_entities++];

      entity->dim = dim;
      entity->tag = ReadInt(r);
      for (int k = 0; k < (dim ? 6 : 3); k++) (void)ReadDouble(r); /* its point or bounding box */
      entity->n = (int)ReadCount(r);
      PetscCall(PetscMalloc1(entity->n, &entity->physical));
      for (int k = 0; k < entity->n; k++) entity->physical[k] = ReadInt(r);
      if (!dim) continue;
      for (PetscInt k = ReadCount(r); k > 0; k--) (void)ReadInt(r); /* what bounds it */
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes by ascending tag, whatever their order in the file */
static PetscErrorCode SortNodes(Reader *r)
{
  GmshMesh  *mesh   = r->mesh;
  PetscBool  sorted = PETSC_TRUE;
  PetscInt  *order, *tags;
  PetscReal *coords;

  PetscFunctionBeginUser;
  for (PetscInt i = 1; i < mesh->n_nodes; i++) sorted = sorted && mesh->node_tag[i] > mesh->node_tag[i - 1] ? PETSC_TRUE : PETSC_FALSE;
  if (sorted) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc3(mesh->n_nodes, &order, mesh->n_nodes, &tags, 3 * mesh->n_nodes, &coords));
  PetscCall(PetscArraycpy(tags, mesh->node_tag, mesh->n_nodes));
  PetscCall(PetscArraycpy(coords, mesh->coords, 3 * mesh->n_nodes));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) order[i] = i;
  PetscCall(PetscSortIntWithPermutation(mesh->n_nodes, tags, order));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    mesh->node_tag[i] = tags[order[i]];
    for (int k = 0; k < 3; k++) mesh->coords[3 * i + k] = coords[3 * order[i] + k];
    if (i && mesh->node_tag[i] == mesh->node_tag[i - 1]) PetscCall(GmshSay(r->message, "%s: node %" PetscInt_FMT " occurs twice", r->file, mesh->node_tag[i]));
  }
  PetscCall(PetscFree3(order, tags, coords));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadNodes(Reader *r)
{
  GmshMesh *mesh   = r->mesh;
  PetscInt  blocks = ReadCount(r), n = ReadCount(r), done = 0;

  PetscFunctionBeginUser;
  (void)ReadSize(r); /* smallest and largest tag */
  (void)ReadSize(r);
  PetscCall(PetscMalloc2(n, &mesh->node_tag, 3 * n, &mesh->coords));
  for (PetscInt b = 0; b < blocks && !ReaderFailed(r); b++) {
    int      dim        = ReadInt(r);
    int      parametric = (ReadInt(r), ReadInt(r)); /* the entity's tag is not needed */
    PetscInt in_block   = ReadCount(r);

    if (in_block > n - done) ReaderDamaged(r);
    for (PetscInt i = 0; i < in_block && !ReaderFailed(r); i++) mesh->node_tag[done + i] = ReadTag(r);
    for (PetscInt i = 0; i < in_block && !ReaderFailed(r); i++) {
      for (int k = 0; k < 3; k++) mesh->coords[3 * (done + i) + k] = ReadDouble(r);
      for (int k = 0; parametric && k < dim; k++) (void)ReadDouble(r); /* position on the entity */
    }
    done += in_block;
  }
  if (done != n) ReaderDamaged(r);
  if (ReaderFailed(r)) PetscFunctionReturn(PETSC_SUCCESS);
  mesh->n_nodes = n;
  PetscCall(SortNodes(r));
  PetscCall(PetscCalloc1(n, &r->used));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RefuseElement(Reader *r, int type, int dim, int entity)
{
  const char *known = type >= 0 && type < (int)(sizeof(RefusedElements) / sizeof(*RefusedElements)) ? RefusedElements[type] : NULL;
  char        name[64];

  PetscFunctionBeginUser;
  if (ReaderFailed(r)) PetscFunctionReturn(PETSC_SUCCESS);
  if (known)
    snprintf(name, sizeof(name), "%s", known);
  else
    snprintf(name, sizeof(name), "gmsh's type %d%s", type, type > GMSH_POINT && type < GMSH_POLYGON ? ", of order 3 or higher" : "");
  if (type == 16 || type == 17) {
    PetscCall(GmshSay(r->message, "%s: serendipity elements (%s) are not available; mesh with: gmsh FILE.geo -order 2 -setnumber Mesh.SecondOrderIncomplete 0",
                      r->file, name));
  } else {
    PetscCall(GmshSay(r->message,
                      "%s: elements on entity %d of dimension %d are not available (%s); there are tri3, tri6, quad4, quad9, tet4, tet10, hex8, hex27", r->file,
                      entity, dim, name));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Index of a node's tag, -1: there is none. Tags are mostly without gaps, so the first guess is right. */
static PetscInt NodeIndex(const GmshMesh *mesh, PetscInt tag)
{
  PetscInt guess = mesh->n_nodes ? tag - mesh->node_tag[0] : -1;

  if (guess < 0 || (guess < mesh->n_nodes && mesh->node_tag[guess] == tag)) return guess < 0 ? -1 : guess;
  if (PetscFindInt(tag, mesh->n_nodes, mesh->node_tag, &guess)) return -1;
  return guess < 0 ? -1 : guess;
}

static int PhysicalIndex(const GmshMesh *mesh, int dim, PetscInt tag)
{
  for (int i = 0; i < mesh->n_physicals; i++)
    if (mesh->physicals[i].dim == dim && mesh->physicals[i].tag == tag) return i;
  return -1;
}

/* The groups of the entity a block lies on. A group that has no name in the file is added under its number. */
static PetscErrorCode BlockPhysicals(Reader *r, int dim, int tag, GmshBlock *block)
{
  GmshMesh     *mesh   = r->mesh;
  const Entity *entity = NULL;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < r->n_entities && !entity; i++)
    if (r->entities[i].dim == dim && r->entities[i].tag == tag) entity = &r->entities[i];
  if (!entity || !entity->n) PetscFunctionReturn(PETSC_SUCCESS);
  block->n_physicals = entity->n;
  PetscCall(PetscMalloc2(entity->n, &block->physical, entity->n, &block->sign));
  for (int i = 0; i < entity->n; i++) {
    int physical = PetscAbsInt(entity->physical[i]), index = PhysicalIndex(mesh, dim, physical);

    if (index < 0) {
      char name[16];

      snprintf(name, sizeof(name), "%d", physical);
      index = mesh->n_physicals++;
      PetscCall(PetscRealloc((size_t)mesh->n_physicals * sizeof(*mesh->physicals), &mesh->physicals));
      mesh->physicals[index] = (GmshPhysical){.dim = dim, .tag = physical};
      PetscCall(PetscStrallocpy(name, &mesh->physicals[index].name));
    }
    block->physical[i] = index;
    block->sign[i]     = entity->physical[i] < 0 ? -1 : 1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BlockFree(GmshBlock *block)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(block->tag));
  PetscCall(PetscFree(block->connectivity));
  PetscCall(PetscFree2(block->physical, block->sign));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadBlock(Reader *r)
{
  GmshMesh *mesh   = r->mesh;
  GmshBlock block  = {.dim = ReadInt(r)};
  int       entity = ReadInt(r), type = ReadInt(r);

  PetscFunctionBeginUser;
  block.n       = ReadCount(r);
  block.element = ElementFromGmsh(type);
  block.nodes   = block.element ? block.element->nodes : 1;
  if (!block.element && type != GMSH_POINT) PetscCall(RefuseElement(r, type, block.dim, entity));
  if (ReaderFailed(r)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(block.n, &block.tag));
  PetscCall(PetscMalloc1(block.n * block.nodes, &block.connectivity));
  for (PetscInt i = 0; i < block.n && !ReaderFailed(r); i++) {
    block.tag[i] = ReadTag(r);
    for (int k = 0; k < block.nodes && !ReaderFailed(r); k++) {
      PetscInt tag = ReadTag(r), node = NodeIndex(mesh, tag);

      if (node < 0)
        PetscCall(GmshSay(r->message, "%s: element %" PetscInt_FMT " has node %" PetscInt_FMT ", which is not in the file", r->file, block.tag[i], tag));
      else
        r->used[node] = PETSC_TRUE;
      block.connectivity[i * block.nodes + k] = node;
    }
  }
  PetscCall(BlockPhysicals(r, block.dim, entity, &block));
  if (block.n_physicals) {
    PetscCall(PetscRealloc((size_t)(mesh->n_blocks + 1) * sizeof(*mesh->blocks), &mesh->blocks));
    mesh->blocks[mesh->n_blocks++] = block;
  } else
    PetscCall(BlockFree(&block));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadElements(Reader *r)
{
  PetscInt blocks = ReadCount(r);

  PetscFunctionBeginUser;
  if (!r->mesh->node_tag) ReaderDamaged(r);      /* nodes come first */
  for (int i = 0; i < 3; i++) (void)ReadSize(r); /* number of elements, smallest and largest tag */
  for (PetscInt b = 0; b < blocks && !ReaderFailed(r); b++) PetscCall(ReadBlock(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadSection(Reader *r, unsigned *seen)
{
  static const struct {
    const char *name;
    PetscErrorCode (*read)(Reader *);
  } sections[] = {
    {"$MeshFormat",    ReadFormat       },
    {"$PhysicalNames", ReadPhysicalNames},
    {"$Entities",      ReadEntities     },
    {"$Nodes",         ReadNodes        },
    {"$Elements",      ReadElements     }
  };
  char  closing[72];
  char *end;
  int   known = -1;

  PetscFunctionBeginUser;
  ReadLine(r, r->section, sizeof(r->section));
  r->section[strcspn(r->section, " \t")] = '\0';
  for (int i = 0; i < (int)(sizeof(sections) / sizeof(*sections)); i++)
    if (!strcmp(r->section, sections[i].name)) known = i;
  if (!strcmp(r->section, "$PartitionedEntities"))
    PetscCall(GmshSay(r->message, "%s: the mesh is partitioned already; write it without partitions, ranks are given out here", r->file));
  if ((known != 0) != (*seen & 1)) PetscCall(GmshSay(r->message, "%s: this is no gmsh mesh file (.msh, format 4.1)", r->file));
  if (ReaderFailed(r)) PetscFunctionReturn(PETSC_SUCCESS);
  snprintf(closing, sizeof(closing), "$End%s", r->section + 1);
  if (known >= 0) {
    if (*seen & (1u << known)) ReaderDamaged(r); /* twice */
    *seen |= 1u << known;
    PetscCall(sections[known].read(r));
    if (ReaderFailed(r)) PetscFunctionReturn(PETSC_SUCCESS);
    SkipSpace(r);
    if (r->size - r->at < strlen(closing) || strncmp(r->data + r->at, closing, strlen(closing)))
      ReaderDamaged(r);
    else
      r->at += strlen(closing);
  } else {
    end = memmem(r->data + r->at, r->size - r->at, closing, strlen(closing));
    if (!end)
      ReaderDamaged(r);
    else
      r->at = (size_t)(end - r->data) + strlen(closing);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int ComparePhysicals(const void *a, const void *b)
{
  const GmshPhysical *p = a, *q = b;

  if (p->dim != q->dim) return p->dim > q->dim ? -1 : 1;
  return p->tag < q->tag ? -1 : p->tag > q->tag;
}

/* Groups by descending dimension, then tag; blocks follow. */
static PetscErrorCode SortPhysicals(GmshMesh *mesh)
{
  GmshPhysical *old;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_physicals, &old));
  PetscCall(PetscArraycpy(old, mesh->physicals, mesh->n_physicals));
  qsort(mesh->physicals, (size_t)mesh->n_physicals, sizeof(*mesh->physicals), ComparePhysicals);
  for (int b = 0; b < mesh->n_blocks; b++) {
    for (int i = 0; i < mesh->blocks[b].n_physicals; i++) {
      const GmshPhysical *physical = &old[mesh->blocks[b].physical[i]];

      mesh->blocks[b].physical[i] = PhysicalIndex(mesh, physical->dim, physical->tag);
    }
  }
  PetscCall(PetscFree(old));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  GmshRead - reads a gmsh file of format 4.1, text or binary

  Not Collective; meant for one rank

  Input Parameter:
. file - path

  Output Parameters:
+ mesh    - nodes by ascending tag, elements of the physical groups, groups; to be freed with GmshReset(), also after a mistake
- message - what is wrong with the file, if anything: missing, truncated, other format, no physical names, elements that are not available,
            nodes without elements

  Note:
  Format: the gmsh reference manual, "MSH file format, version 4.1".
*/
PetscErrorCode GmshRead(const char *file, GmshMesh *mesh, GmshMessage *message)
{
  Reader    r    = {.file = file, .message = message, .mesh = mesh};
  unsigned  seen = 0; /* bit per section of ReadSection()'s table */
  PetscBool found;

  PetscFunctionBeginUser;
  *mesh = (GmshMesh){0};
  PetscCall(FileLoad(file, &r.data, &r.size, &found));
  if (!found)
    PetscCall(GmshSay(message, "%s: there is no such file, or it cannot be read", file));
  else if (!r.size)
    PetscCall(GmshSay(message, "%s: the file is empty", file));
  for (SkipSpace(&r); found && r.at < r.size && !ReaderFailed(&r); SkipSpace(&r)) PetscCall(ReadSection(&r, &seen));
  if (!(seen & 8)) PetscCall(GmshSay(message, "%s: the file has no nodes", file));
  if (!(seen & 16)) PetscCall(GmshSay(message, "%s: the file has no elements", file));
  if (!(seen & 2))
    PetscCall(GmshSay(message, "%s: the file has no physical names; name volumes and surfaces in gmsh: Physical Volume(\"NAME\") = {...};", file));
  for (PetscInt i = 0; i < mesh->n_nodes && !ReaderFailed(&r); i++)
    if (!r.used[i]) PetscCall(GmshSay(message, "%s: node %" PetscInt_FMT " belongs to no element", file, mesh->node_tag[i]));
  if (!ReaderFailed(&r)) PetscCall(SortPhysicals(mesh));
  for (PetscInt i = 0; i < r.n_entities; i++) PetscCall(PetscFree(r.entities[i].physical));
  PetscCall(PetscFree(r.entities));
  PetscCall(PetscFree(r.used));
  PetscCall(PetscFree(r.data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  GmshReset - frees what GmshRead() made

  Not Collective
*/
PetscErrorCode GmshReset(GmshMesh *mesh)
{
  PetscFunctionBeginUser;
  for (int b = 0; b < mesh->n_blocks; b++) PetscCall(BlockFree(&mesh->blocks[b]));
  for (int i = 0; i < mesh->n_physicals; i++) PetscCall(PetscFree(mesh->physicals[i].name));
  PetscCall(PetscFree(mesh->blocks));
  PetscCall(PetscFree(mesh->physicals));
  PetscCall(PetscFree2(mesh->node_tag, mesh->coords));
  *mesh = (GmshMesh){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}
