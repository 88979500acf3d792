/* Mesh files of other programs become .msh files, see meshimport.h. */
#include "meshimport.h"
#include "base/hash.h"
#include "base/scripts.h"
#include "gmshprocess.h"
#include "meshdraft.h"
#include <cJSON.h>
#include <petsctime.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#define CONVERTER "convert_mesh.py"
/* Counts the changes after which the converter makes other meshes of the same files. */
#define CONVERTER_VERSION "2"
/* Files that a deck includes may include others. A circle of them would never end. */
#define DEEPEST_INCLUDE 20
/* What the converter says of its failure starts so and is repeated up to this length. */
#define SAID           "Error: "
#define MESSAGE_LENGTH 600

/*@
  MeshImportNeeded - tells whether the scene's mesh file has to be converted.

  Not collective

  Input Parameter:
. scene - of its mesh file the ending counts, and of a .msh file the format in its first lines
@*/
PetscBool MeshImportNeeded(Scene scene)
{
  const char *ending = strrchr(scene->mesh_file, '.');
  FILE       *stream;
  char        line[64] = "", version[16] = "";

  if (scene->foreign_mesh) return PETSC_TRUE;
  if (strcmp(ending, ".msh") || !(stream = fopen(scene->mesh_file, "rb"))) return PETSC_FALSE;
  if (fgets(line, sizeof(line), stream) && !strncmp(line, "$MeshFormat", 11) && fgets(line, sizeof(line), stream) &&
      sscanf(line, "%15s", version) != 1)
    version[0] = '\0';
  fclose(stream);
  return version[0] && strcmp(version, "4.1") ? PETSC_TRUE : PETSC_FALSE;
}

/* Finds the name of the file that an *INCLUDE card reads. */
static PetscBool IncludedFile(const char *line, const char *file, char included[PETSC_MAX_PATH_LEN])
{
  const char *input = NULL, *slash = strrchr(file, '/');
  size_t      length;

  if (strncasecmp(line, "*INCLUDE", 8)) return PETSC_FALSE;
  for (const char *at = line; *at && *at != '\n' && !input; at++)
    if (!strncasecmp(at, "INPUT", 5)) input = strchr(at, '=');
  if (!input) return PETSC_FALSE;
  input += 1 + strspn(input + 1, " \t\"");
  length = strcspn(input, "\",\r\n");
  while (length && input[length - 1] == ' ') length--;
  return snprintf(included, PETSC_MAX_PATH_LEN, "%.*s%.*s", *input == '/' || !slash ? 0 : (int)(slash - file + 1), file,
                  (int)length, input) < PETSC_MAX_PATH_LEN
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* Hashes a file and those that it includes. Files that are not there are the converter's to name. */
static PetscErrorCode HashFile(const char *file, int depth, uint64_t *hash)
{
  char   included[PETSC_MAX_PATH_LEN], part[BUFSIZ], *line = NULL;
  FILE  *stream = fopen(file, "r");
  size_t size   = 0;

  PetscFunctionBeginUser;
  if (!stream) PetscFunctionReturn(PETSC_SUCCESS);
  for (size_t n; (n = fread(part, 1, sizeof(part), stream));) *hash = HashBytes(*hash, part, n);
  rewind(stream);
  while (depth < DEEPEST_INCLUDE && getline(&line, &size, stream) >= 0)
    if (IncludedFile(line, file, included)) PetscCall(HashFile(included, depth + 1, hash));
  free(line);
  fclose(stream);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Joins the names of the scene's bodies with commas, to be freed with PetscFree(). Where groups of a file overlap, they
   say which of them are bodies. */
static PetscErrorCode BodyNames(Scene scene, char **names)
{
  size_t size = 1;

  PetscFunctionBeginUser;
  for (int b = 0; b < scene->n_bodies; b++) size += strlen(scene->bodies[b].name) + 1;
  PetscCall(PetscCalloc1(size, names));
  for (int b = 0; b < scene->n_bodies; b++) {
    if (b) strcat(*names, ",");
    strcat(*names, scene->bodies[b].name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says how CAD geometry is meshed, as the converter's option --cad=TEXT, to be freed with PetscFree(). For other files
   the text is empty. */
static PetscErrorCode CadOption(Scene scene, char **option)
{
  cJSON *json = cJSON_CreateObject(), *list = cJSON_AddArrayToObject(json, "surfaces");
  char  *text;

  PetscFunctionBeginUser;
  if (scene->mesh_size > 0) cJSON_AddNumberToObject(json, "size", scene->mesh_size);
  cJSON_AddNumberToObject(json, "order", scene->order);
  for (int i = 0; i < scene->n_cad_surfaces; i++) {
    const SceneCadSurface *surface = &scene->cad_surfaces[i];
    cJSON                 *entry   = cJSON_CreateObject();

    cJSON_AddItemToArray(list, entry);
    cJSON_AddStringToObject(entry, "name", surface->name);
    if (surface->has_point) cJSON_AddItemToObject(entry, "point", cJSON_CreateDoubleArray(surface->point, scene->dim));
    if (surface->body) cJSON_AddStringToObject(entry, "body", surface->body);
    if (surface->size > 0) cJSON_AddNumberToObject(entry, "size", surface->size);
  }
  text = cJSON_PrintUnformatted(json);
  PetscCheck(text, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the option of the converter");
  PetscCall(PetscCalloc1(strlen(text) + 7, option));
  if (scene->cad) snprintf(*option, strlen(text) + 7, "--cad=%s", text);
  cJSON_free(text);
  cJSON_Delete(json);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Runs the converter, which may write in the draft's folder only. */
static PetscErrorCode Convert(Scene scene, const char *names, const char *cad, const char *file, Complaint *complaint)
{
  MeshDraft   draft;
  char        python[SCRIPTS_PATH], script[SCRIPTS_PATH], dim[16], *output;
  const char *said;
  int         status;

  PetscFunctionBeginUser;
  if (!ScriptsFind(CONVERTER, script, python))
    Complain(complaint,
             "%s: '%s' must be converted by " CONVERTER ", which is not found; set " SCRIPTS_VARIABLE
             " to the folder in which scripts/" CONVERTER " is",
             SceneWhere(scene, "mesh", "file"), scene->mesh_file);
  if (!complaint->text[0]) MeshDraftCreate(file, &draft, complaint);
  if (complaint->text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  snprintf(dim, sizeof(dim), "%d", scene->dim);
  const char *const arguments[] = {python, "-B",       script, scene->mesh_file,  draft.mesh, "--dim",
                                   dim,    "--bodies", names,  *cad ? cad : NULL, NULL};
  PetscCall(GmshExecute((char *const *)arguments, draft.folder, &output, &status));
  said = strstr(output, SAID);
  for (size_t n = strlen(output); n && output[n - 1] == '\n'; n--)
    output[n - 1] = '\0'; /* the code of the message follows */
  if (status == GMSH_NO_PROGRAM)
    Complain(complaint, "%s: '%s' must be converted, and there is no Python here (%s); `make deps` installs one",
             SceneWhere(scene, "mesh", "file"), scene->mesh_file, python);
  else if (status)
    Complain(complaint, "%s: '%s' is not taken: %.*s", SceneWhere(scene, "mesh", "file"), scene->mesh_file,
             MESSAGE_LENGTH, said ? said + strlen(SAID) : output);
  PetscCall(MeshDraftFinish(&draft, file, complaint));
  PetscCall(PetscFree(output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshImport - makes the scene's mesh file from a mesh file of another program, once.

  Not collective

  Input Parameters:
+ scene     - its mesh file, bodies and dimension are read
- directory - where mesh files are kept; it is made if it is not there

  Output Parameters:
+ file      - the mesh file, DIRECTORY/mesh-HASH.msh (PETSC_MAX_PATH_LEN characters)
. seconds   - wall time of the converter, 0 if the file was there already
- complaint - what was wrong, if anything

  Note:
  This is meant for one rank. HASH stands for the contents of the file and of what it includes, the names of the bodies,
  the dimension, the options for CAD geometry and the version of the converter. The converter is found by ScriptsFind().
@*/
PetscErrorCode MeshImport(Scene scene, const char *directory, char *file, PetscReal *seconds, Complaint *complaint)
{
  char          *names, *cad, text[16];
  uint64_t       hash = HASH_START;
  PetscLogDouble start, end;
  struct stat    there;

  PetscFunctionBeginUser;
  *seconds = 0;
  *file    = '\0';
  MeshDraftCheck(scene, directory, complaint);
  if (complaint->text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(HashFile(scene->mesh_file, 0, &hash));
  PetscCall(BodyNames(scene, &names));
  PetscCall(CadOption(scene, &cad));
  hash = HashBytes(hash, cad, strlen(cad) + 1);
  snprintf(text, sizeof(text), "%d " CONVERTER_VERSION, scene->dim);
  hash = HashFinish(HashBytes(HashBytes(hash, names, strlen(names) + 1), text, strlen(text)));
  snprintf(file, PETSC_MAX_PATH_LEN, "%s/mesh-%016llx.msh", directory, (unsigned long long)hash);
  if (stat(file, &there)) {
    PetscCall(PetscTime(&start));
    PetscCall(Convert(scene, names, cad, file, complaint));
    PetscCall(PetscTime(&end));
    *seconds = (PetscReal)(end - start);
  }
  PetscCall(PetscFree(cad));
  PetscCall(PetscFree(names));
  PetscFunctionReturn(PETSC_SUCCESS);
}
