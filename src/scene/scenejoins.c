/* Pairs of lists whose surfaces are joined, see scenejoins.h. */
#include "scene/scenejoins.h"
#include "scenecontact.h"
#include "sceneread.h"
#include <string.h>

/* Characters of the name of joined surfaces, after which it only counts the others */
enum { JOINT_NAME = 80 };

/* Between the names of joined surfaces */
#define JOINT "+"

static PetscBool IsOfList(const SceneContact *pair, const char *path)
{
  return (PetscBool)(pair->listed && !strcmp(pair->path, path));
}

/* Is it a pair of two surfaces of the list? */
static PetscBool IsListed(const SceneContact *pair, const char *path)
{
  return (PetscBool)(IsOfList(pair, path) && pair->master);
}

/* Has the list of an entry a pair of this slave and this master? */
static PetscBool HasPair(Scene scene, const char *path, const char *slave, const char *master)
{
  for (int i = 0; i < scene->n_contacts; i++) {
    const SceneContact *pair = &scene->contacts[i];

    if (IsListed(pair, path) && !strcmp(pair->slave, slave) && !strcmp(pair->master, master)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/*@
  SceneListedTogether - says whether a list of surfaces has two of them meet the same slave.

  Not collective

  Input Parameters:
+ scene - the scene
. path  - place of the list in the scene, such as "contact.0"
. a     - a surface
- b     - another one

  Note:
  Surfaces that no list has are never together.
@*/
PetscBool SceneListedTogether(Scene scene, const char *path, const char *a, const char *b)
{
  for (int i = 0; i < scene->n_contacts; i++) {
    const SceneContact *contact = &scene->contacts[i];

    if (IsListed(contact, path) && !strcmp(contact->master, a) && HasPair(scene, path, contact->slave, b))
      return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Place of a surface among the pairs of a list. */
static int ListPlace(Scene scene, const char *path, const char *surface)
{
  int place = 0;

  while (place < scene->n_contacts &&
         (!IsOfList(&scene->contacts[place], path) || strcmp(scene->contacts[place].slave, surface) != 0))
    place++;
  return place;
}

/*@
  SceneJointName - names surfaces of a list that are joined.

  Not collective

  Input Parameters:
+ scene - the scene
. path  - place of the list in the scene
- n     - number of surfaces, 2 or more

  Input/Output Parameter:
. parts - their names, which are brought into the order of the list

  Output Parameter:
. name - for two surfaces a+b, the last ones of many as their number; to be freed with PetscFree()
@*/
PetscErrorCode SceneJointName(Scene scene, const char *path, int n, char *parts[], char **name)
{
  size_t used = 0, room = 16;
  int    i = 0;

  PetscFunctionBeginUser;
  for (int k = 1; k < n; k++) {
    for (int m = k; m > 0 && ListPlace(scene, path, parts[m]) < ListPlace(scene, path, parts[m - 1]); m--) {
      char *before = parts[m - 1];

      parts[m - 1] = parts[m];
      parts[m]     = before;
    }
  }
  for (int k = 0; k < n; k++) room += strlen(parts[k]) + 1;
  PetscCall(PetscMalloc1(room, name));
  for (; i < n && used < JOINT_NAME; i++)
    used += (size_t)snprintf(*name + used, room - used, "%s%s", i ? JOINT : "", parts[i]);
  if (i < n) snprintf(*name + used, room - used, JOINT "%d", n - i);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is a name among others? */
static PetscBool IsAmong(const char *name, int n, const char *const names[])
{
  for (int k = 0; k < n; k++)
    if (!strcmp(names[k], name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The name by which users know a surface. */
static const char *Label(Scene scene, const char *surface)
{
  char skin[KEY_PATH_LENGTH];

  for (int b = 0; b < scene->n_bodies; b++) {
    SceneBodySkin(&scene->bodies[b], skin, sizeof skin);
    if (!strcmp(skin, surface)) return scene->bodies[b].name;
  }
  return surface;
}

/* The name that a surface has when parts are joined. */
static const char *Joined(const char *surface, int n, const char *const parts[], const char *joint)
{
  return surface && IsAmong(surface, n, parts) ? joint : surface;
}

/* Adds two parts that a pair leaves out. */
static PetscErrorCode AddApart(const char *slave, const char *master, SceneContact *pair)
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(pair->n_apart + 1) * sizeof(*pair->apart), &pair->apart));
  PetscCall(PetscStrallocpy(slave, &pair->apart[pair->n_apart].slave));
  PetscCall(PetscStrallocpy(master, &pair->apart[pair->n_apart++].master));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Notes the parts that a pair leaves out as that of joined surfaces: those which the list has not had meet. The scene
   and the pair have the names of parts yet. A surface that is not joined is its only part. */
static PetscErrorCode KeepApart(Scene scene, int n, const char *const parts[], SceneContact *pair)
{
  const char        *own[] = {pair->slave, pair->master};
  const PetscBool    slave = IsAmong(own[0], n, parts), master = IsAmong(own[1], n, parts);
  const char *const *slaves  = slave ? parts : (const char *const *)&own[0];
  const char *const *masters = master ? parts : (const char *const *)&own[1];

  PetscFunctionBeginUser;
  for (int s = 0; s < (slave ? n : 1); s++)
    for (int m = slave && master ? s : 0; m < (master ? n : 1); m++)
      if (!HasPair(scene, pair->path, slaves[s], masters[m]) && !HasPair(scene, pair->path, masters[m], slaves[s]))
        PetscCall(AddApart(slaves[s], masters[m], pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds for each pair of a list the first one that has the same surfaces, when parts are joined: first[n_contacts].
   Others, and those of other entries, are their own. */
static void FindFirst(Scene scene, const char *path, int n, const char *const parts[], int *first)
{
  for (int i = 0; i < scene->n_contacts; i++) {
    const SceneContact *pair = &scene->contacts[i];

    first[i] = i;
    for (int k = 0; k < i && first[i] == i && IsOfList(pair, path); k++) {
      const SceneContact *other = &scene->contacts[k];

      if (!IsOfList(other, path) || !other->master != !pair->master) continue;
      if (strcmp(Joined(other->slave, n, parts, ""), Joined(pair->slave, n, parts, "")) != 0) continue;
      if (pair->master && strcmp(Joined(other->master, n, parts, ""), Joined(pair->master, n, parts, "")) != 0)
        continue;
      first[i] = first[k];
    }
  }
}

static PetscErrorCode Rename(const char *name, char **text)
{
  char *old = *text;

  PetscFunctionBeginUser;
  PetscCall(PetscStrallocpy(name, text));
  PetscCall(PetscFree(old));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the first one of pairs with the same surfaces, with what the others leave out. */
static PetscErrorCode KeepFirst(Scene scene, const int *first)
{
  int *place, n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(scene->n_contacts, &place));
  for (int i = 0; i < scene->n_contacts; i++) {
    SceneContact *pair = &scene->contacts[i];

    place[i] = n;
    if (first[i] == i) {
      scene->contacts[n++] = *pair;
      continue;
    }
    for (int k = 0; k < pair->n_apart; k++)
      PetscCall(AddApart(pair->apart[k].slave, pair->apart[k].master, &scene->contacts[place[first[i]]]));
    PetscCall(SceneDestroyContact(pair));
  }
  scene->n_contacts = n;
  PetscCall(PetscFree(place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the pairs of a list the names of their surfaces. The only one has that of the list. */
static PetscErrorCode NamePairs(Scene scene, const char *path)
{
  const char *entry  = SchemaText(SceneDocument(scene), "%s.name", path);
  int         n_list = 0;

  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_contacts; i++) n_list += IsOfList(&scene->contacts[i], path);
  for (int i = 0; i < scene->n_contacts; i++) {
    SceneContact *pair = &scene->contacts[i];
    char          name[4 * KEY_PATH_LENGTH];

    if (!IsOfList(pair, path)) continue;
    snprintf(name, sizeof name, "%s.%s.%s", entry, Label(scene, pair->slave),
             pair->master ? Label(scene, pair->master) : strrchr(pair->name, '.') + 1);
    PetscCall(Rename(n_list > 1 ? name : entry, &pair->name));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneJoinSurfaces - has surfaces of a list be one surface.

  Collective

  Input Parameters:
+ scene - the scene
. path  - place of the list in the scene
. n     - number of surfaces
. parts - their names in the mesh; the caller's own, as those of pairs change
- joint - name in the mesh of the surface that has the faces of all of them

  Note:
  Of pairs whose surfaces have become the same the first one is kept. It notes in `apart` which parts the list does not
  have meet. Names of pairs change; SceneCheckProbePairs() refuses probes with names that are no more.
@*/
PetscErrorCode SceneJoinSurfaces(Scene scene, const char *path, int n, const char *const parts[], const char *joint)
{
  int *first;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(scene->n_contacts, &first));
  FindFirst(scene, path, n, parts, first);
  for (int i = 0; i < scene->n_contacts; i++)
    if (first[i] == i && IsListed(&scene->contacts[i], path))
      PetscCall(KeepApart(scene, n, parts, &scene->contacts[i]));
  PetscCall(KeepFirst(scene, first));
  PetscCall(PetscFree(first));
  for (int i = 0; i < scene->n_contacts; i++) {
    SceneContact *pair = &scene->contacts[i];

    if (!IsOfList(pair, path)) continue;
    if (IsAmong(pair->slave, n, parts)) PetscCall(Rename(joint, &pair->slave));
    if (pair->master && IsAmong(pair->master, n, parts)) PetscCall(Rename(joint, &pair->master));
  }
  PetscCall(NamePairs(scene, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneMayBeJoint - says whether a pair can have a name when the mesh has shown which surfaces are joined.

  Not collective

  Input Parameters:
+ scene - the scene, of which the contact pairs have been read
- name  - the name
@*/
PetscBool SceneMayBeJoint(Scene scene, const char *name)
{
  for (int i = 0; i < scene->n_contacts; i++) {
    const SceneContact *pair = &scene->contacts[i];
    const char         *list = SchemaText(SceneDocument(scene), "%s.name", pair->path);
    const size_t        n    = strlen(list);

    if (!pair->listed || strncmp(name, list, n) != 0) continue;
    if (!name[n] || (name[n] == '.' && strstr(name + n, JOINT))) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}
