/* Contact entries that list surfaces. Each deformable surface of the list becomes the slave of every surface of it,
   itself included. Where both of two surfaces are slaves, each counts with half its area, so that E = (E_12 + E_21)/2.
   Rigid tools are masters only. */
#include "scenesurfaces.h"
#include "sceneread.h"
#include <string.h>

/* Keys that have no meaning where no slave is named, or that are not available there, with what is allowed. */
static const struct {
  const char *key, *what;
} Unfit[] = {
  {"slave", "has no place beside surfaces; allowed: slave and master, or surfaces"},
  {"master", "has no place beside surfaces; allowed: slave and master, or surfaces"},
  {"friction", "is not available with surfaces yet; allowed: with slave and master"},
  {"initial_overlap",
   "is not available with surfaces; allowed: with slave and master (surfaces must touch or be apart at the start)"},
};

/* Does an entry name these two surfaces as slave and master, in either role? */
static int NamesPair(Scene scene, int n_entries, const char *a, const char *b)
{
  for (int i = 0; i < n_entries; i++) {
    char path[KEY_PATH_LENGTH];
    Node slave, master;

    snprintf(path, sizeof path, "contact.%d", i);
    slave  = SceneNode(scene, path, "slave");
    master = SceneNode(scene, path, "master");
    if (!slave || !master || !master->text) continue;
    if (!strcmp(slave->text, a) && !strcmp(master->text, b)) return 1;
    if (!strcmp(slave->text, b) && !strcmp(master->text, a)) return 1;
  }
  return 0;
}

static PetscErrorCode CheckEntry(Scene scene, const char *path, Node surfaces)
{
  int deformable = 0;

  PetscFunctionBeginUser;
  for (size_t k = 0; surfaces && k < PETSC_STATIC_ARRAY_LENGTH(Unfit); k++)
    if (SceneHas(scene, path, Unfit[k].key)) PetscCall(SceneRefuse(scene, path, Unfit[k].key, Unfit[k].what, NULL));
  for (int k = 0; !surfaces && k < 2; k++)
    if (!SceneHas(scene, path, Unfit[k].key))
      PetscCall(SceneRefuse(scene, path, Unfit[k].key, "is missing; allowed: slave and master, or surfaces", NULL));
  for (int i = 0; surfaces && i < surfaces->n; i++) {
    deformable += !SceneFindBody(scene, surfaces->child[i]->text, 1);
    for (int j = 0; j < i; j++)
      if (!strcmp(surfaces->child[i]->text, surfaces->child[j]->text))
        PetscCall(SceneRefuse(scene, path, "surfaces", "is listed twice; allowed: each surface once",
                              surfaces->child[i]->text));
  }
  if (surfaces && !deformable)
    PetscCall(
      SceneRefuse(scene, path, "surfaces", "has no surface of a deformable body; allowed: a list with one", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneListSurfacePairs - lists the pairs of all contact entries, those of a list of surfaces one by one.

  Collective

  Input Parameter:
. scene - the scene, of which the bodies have been read

  Output Parameters:
+ n     - number of pairs
- pairs - the pairs in the order of the entries, to be freed with PetscFree()

  Note:
  Refuses entries with neither slave and master nor surfaces, and what is not available with surfaces.
@*/
PetscErrorCode SceneListSurfacePairs(Scene scene, int *n, SurfacePair **pairs)
{
  const int entries = SchemaCount(SceneDocument(scene), "contact");
  int       room    = 0;

  PetscFunctionBeginUser;
  *n     = 0;
  *pairs = NULL;
  for (int i = 0; i < entries; i++) {
    char path[KEY_PATH_LENGTH];
    Node surfaces;

    snprintf(path, sizeof path, "contact.%d", i);
    surfaces = SceneNode(scene, path, "surfaces");
    PetscCall(CheckEntry(scene, path, surfaces));
    room += surfaces ? surfaces->n * surfaces->n : 1;
    PetscCall(PetscRealloc(room * sizeof(**pairs), pairs));
    if (!surfaces) (*pairs)[(*n)++] = (SurfacePair){i, NULL, NULL, 1};
    for (int s = 0; surfaces && s < surfaces->n; s++) {
      for (int m = 0; m < surfaces->n; m++) {
        const char *slave = surfaces->child[s]->text, *master = surfaces->child[m]->text;

        if (SceneFindBody(scene, slave, 1) || NamesPair(scene, entries, slave, master)) continue;
        (*pairs)[(*n)++] = (SurfacePair){i, slave, master, SceneFindBody(scene, master, 1) ? 1 : 0.5};
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneNameSurfacePair - names a pair of a list of surfaces.

  Not collective

  Input Parameters:
+ pair  - the pair
. alone - 1 if it is the only one of its entry
- entry - name of the entry

  Output Parameter:
. name - the entry's name, or with slave and master after it; to be freed with PetscFree()
@*/
PetscErrorCode SceneNameSurfacePair(const SurfacePair *pair, int alone, const char *entry, char **name)
{
  char text[3 * KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  snprintf(text, sizeof text, "%s.%s.%s", entry, pair->slave, pair->master);
  PetscCall(PetscStrallocpy(alone ? entry : text, name));
  PetscFunctionReturn(PETSC_SUCCESS);
}
