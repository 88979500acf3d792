/* Mesh files in the making, see meshdraft.h. */
#include "meshdraft.h"
#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Bytes in which the last line of a mesh ends and begins. */
#define LAST_BYTES 512

/* Makes the directories above a path. */
static void MakeDirectoriesAbove(const char *path, Complaint *complaint)
{
  char directory[PETSC_MAX_PATH_LEN];

  snprintf(directory, sizeof(directory), "%s", path);
  for (char *at = directory + 1; *at; at++) {
    if (*at != '/') continue;
    *at = '\0';
    if (mkdir(directory, 0777) && errno != EEXIST)
      Complain(complaint, "cannot make the directory '%s' for meshes: %s", directory, strerror(errno));
    *at = '/';
  }
}

/*@
  MeshDraftCheck - checks that the scene's mesh file is there, to make a mesh of it.

  Not collective

  Input Parameters:
+ scene     - its mesh file is looked for
- directory - where mesh files are kept

  Output Parameter:
. complaint - says that there is no such file, or that paths of meshes would be too long
@*/
void MeshDraftCheck(Scene scene, const char *directory, Complaint *complaint)
{
  struct stat there;

  if (stat(scene->mesh_file, &there))
    Complain(complaint, "%s: there is no file '%s'", SceneWhere(scene, "mesh", "file"), scene->mesh_file);
  else if (!S_ISREG(there.st_mode))
    Complain(complaint, "%s: '%s' is no file", SceneWhere(scene, "mesh", "file"), scene->mesh_file);
  if (strlen(directory) + MESH_NAME_ROOM > PETSC_MAX_PATH_LEN)
    Complain(complaint, "the path '%s' is too long", directory);
}

/*@
  MeshDraftCreate - makes the folder in which a program makes a mesh.

  Not collective

  Input Parameter:
. file - path that the mesh shall have; the directories above it are made

  Output Parameters:
+ draft     - the folder, and the file that the program shall write
- complaint - says what cannot be made
@*/
void MeshDraftCreate(const char *file, MeshDraft *draft, Complaint *complaint)
{
  snprintf(draft->folder, sizeof(draft->folder), "%s.%d", file, (int)getpid());
  snprintf(draft->mesh, sizeof(draft->mesh), "%s/mesh", draft->folder);
  MakeDirectoriesAbove(file, complaint);
  if (!complaint->text[0] && mkdir(draft->folder, 0777) && errno != EEXIST)
    Complain(complaint, "cannot make the directory '%s' for a mesh: %s", draft->folder, strerror(errno));
}

/* Tells whether the file ends as a mesh ends. On a full disk gmsh leaves a part of it, or nothing, and reports
   success. */
static PetscBool IsWhole(const char *file)
{
  FILE  *stream = fopen(file, "rb");
  char   text[LAST_BYTES + 1], *line;
  size_t size;

  if (!stream) return PETSC_FALSE;
  if (fseek(stream, -LAST_BYTES, SEEK_END)) rewind(stream); /* the file is shorter */
  size = fread(text, 1, LAST_BYTES, stream);
  fclose(stream);
  while (size && isspace((unsigned char)text[size - 1])) size--;
  text[size] = '\0';
  line       = text + size;
  while (line > text && line[-1] != '\n') line--;
  return strncmp(line, "$End", 4) ? PETSC_FALSE : PETSC_TRUE;
}

/*@
  MeshDraftFinish - gives the mesh its name, if nothing went wrong, and removes the folder.

  Not collective

  Input Parameters:
+ draft - from MeshDraftCreate()
- file  - path that the mesh gets

  Input/Output Parameter:
. complaint - with a complaint the mesh is dropped; says if the file is not whole or cannot get its name
@*/
PetscErrorCode MeshDraftFinish(MeshDraft *draft, const char *file, Complaint *complaint)
{
  const PetscBool whole = IsWhole(draft->mesh);

  PetscFunctionBeginUser;
  if (!complaint->text[0] && !whole)
    Complain(complaint, "cannot write '%s': a part of it is there; is the disk full?", file);
  if (!complaint->text[0] && rename(draft->mesh, file))
    Complain(complaint, "cannot write '%s': %s", file, strerror(errno));
  unlink(draft->mesh);
  rmdir(draft->folder);
  PetscFunctionReturn(PETSC_SUCCESS);
}
