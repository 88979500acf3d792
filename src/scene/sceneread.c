/* What all readers of a scene share, see sceneread.h. */
#include "sceneread.h"
#include <string.h>

/* SceneDocument - the tree that the scene was read from. Not collective. */
Document *SceneDocument(Scene scene)
{
  return (Document *)scene->document;
}

/* ScenePath - "list.i" as a text of its own. Not collective. */
PetscErrorCode ScenePath(char **path, const char *list, int i)
{
  char text[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  snprintf(text, sizeof text, "%s.%d", list, i);
  PetscCall(PetscStrallocpy(text, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SceneNode - the document's value at path.key, NULL if there is none. Not collective. */
Node SceneNode(Scene scene, const char *path, const char *key)
{
  char text[KEY_PATH_LENGTH];

  KeyPathJoin(text, path, key);
  return NodeFind(SceneDocument(scene)->root, text);
}

/* SceneReals - a list of numbers into v; absent: v stays as it is. Returns how many there are. Not collective. */
int SceneReals(Scene scene, const char *path, const char *key, double *v)
{
  Node list = SceneNode(scene, path, key);

  for (int i = 0; list && i < list->n; i++) (void)NodeReal(list->child[i], &v[i]);
  return list ? list->n : 0;
}

/* SceneReadText - a copy of the text at path.key, or its default; NULL if there is neither. Not collective. */
PetscErrorCode SceneReadText(Scene scene, const char *path, const char *key, char **text)
{
  PetscFunctionBeginUser;
  PetscCall(PetscStrallocpy(SchemaText(SceneDocument(scene), "%s.%s", path, key), text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SceneHas - whether the document itself has a value at path.key. Not collective. */
int SceneHas(Scene scene, const char *path, const char *key)
{
  return SceneNode(scene, path, key) != NULL;
}

/*@
  SceneRefuse - refuses the value at path.key with the text "about what".

  Collective

  Input Parameters:
+ scene - the scene
. path  - of the map
. key   - in the map, or "" for the map itself
. what  - what is wrong with the value; what is allowed
- about - the value, or NULL

  Note:
  Returns REFUSED.
@*/
PetscErrorCode SceneRefuse(Scene scene, const char *path, const char *key, const char *what, const char *about)
{
  char text[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  KeyPathJoin(text, path, key);
  PetscCall(
    DocumentRefuse(SceneDocument(scene), *key ? text : path, "%s%s%s", about ? about : "", about ? " " : "", what));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SceneFindBody - the body of that name, among the rigid tools or the deformable ones read so far; NULL if there is
 * none. Not collective. */
const SceneBody *SceneFindBody(Scene scene, const char *name, int rigid)
{
  for (int i = 0; i < scene->n_bodies; i++) {
    if (scene->bodies[i].rigid == rigid && !strcmp(scene->bodies[i].name, name)) return &scene->bodies[i];
  }
  return NULL;
}
