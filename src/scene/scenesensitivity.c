/* Reads the sensitivities that a scene asks for, see scenesensitivity.h. */
#include "scenesensitivity.h"
#include "sceneread.h"
#include "schemakeys.h"
#include <string.h>

/* Parts of a scene whose numbers the solution depends on smoothly */
static const char *const parts[] = {"bodies.", "supports.", "loads.", "contact.", "probes.", "mesh.parameters."};

/* Finds the number of a probe; -1: there is none of that name. */
static int FindProbe(Scene scene, const char *name)
{
  for (int i = 0; i < scene->n_probes; i++)
    if (!strcmp(scene->probes[i].name, name)) return i;
  return -1;
}

/* Tells whether a key may have any number near its own. */
static PetscBool MayChange(const char *path)
{
  const SchemaKey *key = SchemaKeyFind(path);

  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(parts); k++)
    if (!strncmp(path, parts[k], strlen(parts[k]))) return (PetscBool)(!key || !(key->type & INTEGER));
  return PETSC_FALSE;
}

/* Refuses an entry of the list. */
static PetscErrorCode Refuse(Scene scene, const char *about, const char *what)
{
  PetscFunctionBeginUser;
  PetscCall(SceneRefuse(scene, "sensitivity", "", what, about));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a key and its value. */
static PetscErrorCode ReadKey(Scene scene, int probe, const char *key)
{
  const Node       value = NodeFind(SceneDocument(scene)->root, key);
  SceneSensitivity s     = {.probe = probe};

  PetscFunctionBeginUser;
  if (!MayChange(key))
    PetscCall(Refuse(scene, key,
                     "is no key for a sensitivity; allowed: paths of numbers below bodies, supports, loads, contact, "
                     "probes and mesh.parameters, such as bodies.0.material.E"));
  if (!value || value->kind != NODE_SCALAR || !NodeReal(value, &s.value) || s.value == 0)
    PetscCall(Refuse(scene, key,
                     "has no number other than 0 in the scene, for a sensitivity; allowed: a key with such a number "
                     "(-set can give it one)"));
  PetscCall(PetscStrallocpy(key, &s.key));
  scene->sensitivities[scene->n_sensitivities++] = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads an entry PROBE:KEY,KEY. */
static PetscErrorCode ReadEntry(Scene scene, const char *entry)
{
  char probe[KEY_PATH_LENGTH], key[KEY_PATH_LENGTH];
  int  i;

  PetscFunctionBeginUser;
  if (!strchr(entry, ':') || strlen(entry) >= sizeof(probe))
    PetscCall(Refuse(scene, entry, "names no probe and key; allowed: PROBE:KEY or PROBE:KEY,KEY"));
  snprintf(probe, sizeof probe, "%.*s", (int)strcspn(entry, ":"), entry);
  i = FindProbe(scene, probe);
  if (i < 0) PetscCall(Refuse(scene, probe, "is no probe; allowed: the name of one under probes:"));
  for (const char *rest = strchr(entry, ':'); *rest; rest += strcspn(rest, ",")) {
    rest += 1 + strspn(rest + 1, " ");
    snprintf(key, sizeof key, "%.*s", (int)strcspn(rest, ", "), rest);
    PetscCall(ReadKey(scene, i, key));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneReadSensitivities - reads of which probes the derivatives by which keys are wanted.

  Collective

  Input Parameter:
. scene - the scene, whose bodies, loads, contacts and probes have been read

  Note:
  It refuses the first mistake.
@*/
PetscErrorCode SceneReadSensitivities(Scene scene)
{
  const Node list = NodeFind(SceneDocument(scene)->root, "sensitivity");
  size_t     n    = 0;

  PetscFunctionBeginUser;
  if (!list) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; i < list->n; i++) n += strlen(list->child[i]->text) + 1;
  PetscCall(PetscCalloc1(n, &scene->sensitivities)); /* an entry has no more keys than characters */
  if (SceneHasFluid(scene))
    PetscCall(Refuse(scene, NULL,
                     "is not available where a fluid enters between surfaces, as the places that it wets change one by "
                     "one; allowed: other loads"));
  scene->sensitivities_by_runs = SceneDependsOnPath(scene);
  for (int i = 0; i < list->n; i++) PetscCall(ReadEntry(scene, list->child[i]->text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneDestroySensitivities - frees what SceneReadSensitivities() has made.

  Not collective

  Input Parameter:
. scene - the scene
@*/
PetscErrorCode SceneDestroySensitivities(Scene scene)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_sensitivities; i++) PetscCall(PetscFree(scene->sensitivities[i].key));
  PetscCall(PetscFree(scene->sensitivities));
  PetscFunctionReturn(PETSC_SUCCESS);
}
