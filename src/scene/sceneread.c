/* Functions that all readers of a scene share, see sceneread.h. */
#include "sceneread.h"
#include <math.h>
#include <string.h>

/*@
  SceneDocument - returns the document from which the scene was read.

  Not collective

  Input Parameter:
. scene - the scene
@*/
Document *SceneDocument(Scene scene)
{
  return (Document *)scene->document;
}

/*@
  ScenePath - makes the path "list.i" of an entry of a list.

  Not collective

  Input Parameters:
+ list - path of the list
- i    - index of the entry, counted from 0

  Output Parameter:
. path - the path, to be freed with PetscFree()
@*/
PetscErrorCode ScenePath(char **path, const char *list, int i)
{
  char text[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  snprintf(text, sizeof text, "%s.%d", list, i);
  PetscCall(PetscStrallocpy(text, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneNode - returns the document's value at "path.key".

  Not collective

  Input Parameters:
+ scene - the scene
. path  - path of the map
- key   - key in the map

  Note:
  It returns NULL if the document has no such value.
@*/
Node SceneNode(Scene scene, const char *path, const char *key)
{
  char text[KEY_PATH_LENGTH];

  KeyPathJoin(text, path, key);
  return NodeFind(SceneDocument(scene)->root, text);
}

/*@
  SceneReals - copies the numbers of the list at "path.key" and returns how many there are.

  Not collective

  Input Parameters:
+ scene - the scene
. path  - path of the map
- key   - key in the map

  Output Parameter:
. v - the numbers; it must have room for all of them

  Note:
  If the document has no such list, v is not changed and the result is 0.
@*/
int SceneReals(Scene scene, const char *path, const char *key, double *v)
{
  Node list = SceneNode(scene, path, key);

  for (int i = 0; list && i < list->n; i++) (void)NodeReal(list->child[i], &v[i]);
  return list ? list->n : 0;
}

/*@
  SceneReadText - copies the text at "path.key" or its default.

  Not collective

  Input Parameters:
+ scene - the scene
. path  - path of the map
- key   - key in the map

  Output Parameter:
. text - the copy, to be freed with PetscFree(), or NULL if there is neither a text nor a default
@*/
PetscErrorCode SceneReadText(Scene scene, const char *path, const char *key, char **text)
{
  PetscFunctionBeginUser;
  PetscCall(PetscStrallocpy(SchemaText(SceneDocument(scene), "%s.%s", path, key), text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneReadValue - reads the number or the expression at "path.key".

  Collective

  Input Parameters:
+ scene - the scene, of which the geometry has been read
. path  - path of the map or the list
- key   - key in the map, or index in the list

  Output Parameters:
+ value      - the number; that of an expression without variables is computed
- expression - an expression with variables, to be freed with ExpressionDestroy(); else NULL

  Note:
  It refuses an expression that cannot be evaluated.
@*/
PetscErrorCode SceneReadValue(Scene scene, const char *path, const char *key, double *value, Expression *expression)
{
  static const PetscReal origin[3] = {0, 0, 0};
  Node                   node      = SceneNode(scene, path, key);
  char                   mistake[800];

  PetscFunctionBeginUser;
  if (NodeReal(node, value)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ExpressionCreate(node->text, scene->geometry, expression, mistake, sizeof mistake));
  if (mistake[0]) PetscCall(SceneRefuse(scene, path, key, mistake, NULL));
  if (!ExpressionIsNumber(*expression)) PetscFunctionReturn(PETSC_SUCCESS);
  *value = ExpressionValue(*expression, origin, 0);
  PetscCall(ExpressionDestroy(expression));
  if (!isfinite(*value))
    PetscCall(SceneRefuse(scene, path, key, "is not finite; allowed: a finite number", node->text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneHas - tells whether the document itself has a value at "path.key".

  Not collective

  Input Parameters:
+ scene - the scene
. path  - path of the map
- key   - key in the map

  Note:
  It returns 1 or 0. A default does not count.
@*/
int SceneHas(Scene scene, const char *path, const char *key)
{
  return SceneNode(scene, path, key) != NULL;
}

/*@
  SceneRefuse - refuses the value at "path.key" with the text "about what".

  Collective

  Input Parameters:
+ scene - the scene
. path  - path of the map
. key   - key in the map, or "" for the map itself
. what  - text that says what is wrong with the value and what is allowed
- about - the value, or NULL

  Note:
  It returns REFUSED, see RefuseInput().
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

/*@
  SceneFindBody - returns the body of a name, among the rigid tools or the deformable bodies that have been read.

  Not collective

  Input Parameters:
+ scene - the scene
. name  - physical group of the body
- rigid - 1 for a rigid tool, 0 for a deformable body

  Note:
  It returns NULL if there is no such body.
@*/
const SceneBody *SceneFindBody(Scene scene, const char *name, int rigid)
{
  for (int i = 0; i < scene->n_bodies; i++) {
    if (scene->bodies[i].rigid == rigid && !strcmp(scene->bodies[i].name, name)) return &scene->bodies[i];
  }
  return NULL;
}

/*@
  SceneReadFactors - reads a list of breakpoints and factors.

  Not collective

  Input Parameters:
+ scene - the scene
. path  - path of a part of the scene
- key   - key of the list below it

  Output Parameter:
. history - the list, to be freed with PetscFree2(); n is 0 where the scene has none
@*/
PetscErrorCode SceneReadFactors(Scene scene, const char *path, const char *key, History *history)
{
  Node list = SceneNode(scene, path, key);

  PetscFunctionBeginUser;
  history->n = list ? list->n : 0;
  if (!list) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(history->n, &history->t, history->n, &history->v));
  for (int i = 0; i < list->n; i++) {
    (void)NodeReal(list->child[i]->child[0], &history->t[i]);
    (void)NodeReal(list->child[i]->child[1], &history->v[i]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneReadHistory - reads the history below a path.

  Not collective

  Input Parameters:
+ scene - the scene
- path  - path of a part of the scene

  Output Parameter:
. history - the breakpoints and factors, to be freed with PetscFree2(); where the scene has none, the factor is the load
            parameter itself
@*/
PetscErrorCode SceneReadHistory(Scene scene, const char *path, History *history)
{
  PetscFunctionBeginUser;
  PetscCall(SceneReadFactors(scene, path, "history", history));
  if (history->n) PetscFunctionReturn(PETSC_SUCCESS);
  history->n = 2;
  PetscCall(PetscCalloc2(history->n, &history->t, history->n, &history->v));
  history->t[1] = history->v[1] = 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneFilePath - writes the path with which the process can open a file that the scene names; relative names count from
  the folder of the scene. Tells whether it fits.

  Not collective

  Input Parameters:
+ scene - the scene
. file  - its name in the scene
- size  - of path

  Output Parameter:
. path - the path
@*/
PetscBool SceneFilePath(Scene scene, const char *file, char *path, size_t size)
{
  return (PetscBool)((size_t)snprintf(path, size, "%s%s%s", file[0] == '/' ? "" : scene->directory,
                                      file[0] == '/' ? "" : "/", file) < size);
}

/*@
  SceneReadPairs - reads a map of keys and values that are not in the schema.

  Not collective

  Input Parameters:
+ scene - the scene
- key   - path of the map

  Output Parameters:
+ n     - number of its entries, 0 where the scene has none
- pairs - the entries, freed with the scene; the value null becomes an empty text
@*/
PetscErrorCode SceneReadPairs(Scene scene, const char *key, int *n, ScenePair **pairs)
{
  Node map = NodeFind(SceneDocument(scene)->root, key);

  PetscFunctionBeginUser;
  *n = map ? map->n : 0;
  PetscCall(PetscCalloc1(*n, pairs));
  for (int i = 0; i < *n; i++) {
    const Node value = map->child[i];

    PetscCall(PetscStrallocpy(map->key[i] + (map->key[i][0] == '-'), &(*pairs)[i].key));
    PetscCall(
      PetscStrallocpy(value->plain && (!strcmp(value->text, "null") || !strcmp(value->text, "~")) ? "" : value->text,
                      &(*pairs)[i].value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ScenePairsDestroy - frees pairs of keys and values.

  Not collective

  Input Parameters:
+ n     - number of pairs
- pairs - from SceneReadPairs()
@*/
PetscErrorCode ScenePairsDestroy(int n, ScenePair **pairs)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < n; i++) {
    PetscCall(PetscFree((*pairs)[i].key));
    PetscCall(PetscFree((*pairs)[i].value));
  }
  PetscCall(PetscFree(*pairs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneRefuseRigid - refuses a surface that belongs to a rigid tool.

  Not collective

  Input Parameters:
+ scene   - the scene
. path    - path of a part of the scene
. key     - key below it that names the surface
- surface - name of the surface, may be NULL
@*/
PetscErrorCode SceneRefuseRigid(Scene scene, const char *path, const char *key, const char *surface)
{
  PetscFunctionBeginUser;
  if (surface && SceneFindBody(scene, surface, 1))
    PetscCall(SceneRefuse(
      scene, path, key, "is a rigid tool, moved by its own motion; allowed: a surface of a deformable body", surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}
