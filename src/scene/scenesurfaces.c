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
  {"master", "names a surface beside surfaces; allowed: it among the surfaces, or an analytic master"},
};

/* Does an entry name these two surfaces as slave and master, in either role? */
static int NamesPair(Scene scene, const char *a, const char *b)
{
  for (int i = 0; i < SchemaCount(SceneDocument(scene), "contact"); i++) {
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

static int SameName(const ListedSurface *surface, Node name)
{
  return !strcmp(surface->label, name->text);
}

/* Does the entry exclude contact of these two? */
static int Excludes(Node exclude, const ListedSurface *a, const ListedSurface *b)
{
  for (int i = 0; exclude && i < exclude->n; i++) {
    const Node left = exclude->child[i]->child[0], right = exclude->child[i]->child[exclude->child[i]->n - 1];

    if ((SameName(a, left) && SameName(b, right)) || (SameName(a, right) && SameName(b, left))) return 1;
  }
  return 0;
}

/*@
  SceneBodySkin - writes the name of the group of all outer faces of a deformable body, which the mesh makes where a
  contact pair asks for it.

  Not collective

  Input Parameters:
+ body - the body
- size - characters that name holds

  Output Parameter:
. name - the name
@*/
void SceneBodySkin(const SceneBody *body, char *name, size_t size)
{
  snprintf(name, size, "skin of %s", body->name);
}

/* Lists the surfaces of an entry; `all` stands for the outer faces of all bodies. */
static PetscErrorCode ListSurfaces(Scene scene, Node surfaces, int *n, ListedSurface **list)
{
  const int all = surfaces->kind == NODE_SCALAR;

  PetscFunctionBeginUser;
  *n = all ? scene->n_bodies : surfaces->n;
  PetscCall(PetscCalloc1(*n, list));
  for (int i = 0; i < *n; i++) {
    ListedSurface *surface = &(*list)[i];

    surface->label = all ? scene->bodies[i].name : surfaces->child[i]->text;
    surface->rigid = all ? scene->bodies[i].rigid : SceneFindBody(scene, surface->label, 1) != NULL;
    if (all && !surface->rigid)
      SceneBodySkin(&scene->bodies[i], surface->group, sizeof surface->group);
    else
      snprintf(surface->group, sizeof surface->group, "%s", surface->label);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses an exclusion that is not of two of the surfaces. */
static PetscErrorCode CheckExclude(Scene scene, const char *path, Node exclude, int n, const ListedSurface *list)
{
  PetscFunctionBeginUser;
  for (int i = 0; exclude && i < exclude->n; i++) {
    const Node pair = exclude->child[i];
    char       key[KEY_PATH_LENGTH];

    snprintf(key, sizeof key, "exclude.%d", i);
    if (pair->n < 1 || pair->n > 2)
      PetscCall(SceneRefuse(scene, path, key, "is no pair; allowed: [a, b], or [a] for a and itself", NULL));
    for (int k = 0; k < pair->n; k++) {
      int known = 0;

      for (int s = 0; s < n; s++) known = known || SameName(&list[s], pair->child[k]);
      if (!known)
        PetscCall(SceneRefuse(scene, path, key,
                              "is not among the surfaces; allowed: listed surfaces, with all the names of bodies",
                              pair->child[k]->text));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckEntry(Scene scene, const char *path, Node surfaces)
{
  PetscFunctionBeginUser;
  for (int k = 0; surfaces && k < 2; k++) {
    const Node node = SceneNode(scene, path, Unfit[k].key);

    if (node && node->kind != NODE_MAP) PetscCall(SceneRefuse(scene, path, Unfit[k].key, Unfit[k].what, NULL));
  }
  for (int k = 0; !surfaces && k < 2; k++)
    if (!SceneHas(scene, path, Unfit[k].key))
      PetscCall(SceneRefuse(scene, path, Unfit[k].key, "is missing; allowed: slave and master, or surfaces", NULL));
  if (surfaces && SchemaChoice(SceneDocument(scene), "%s.frame", path) != 0)
    PetscCall(SceneRefuse(scene, path, "frame", "is global; allowed with surfaces: local", NULL));
  if (!surfaces && SceneHas(scene, path, "exclude"))
    PetscCall(
      SceneRefuse(scene, path, "exclude", "has no place beside slave and master; allowed: with surfaces", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The analytic master of an entry, whose group has no name. Several pairs would each push a tool of their own, so its
   motion has no free components. */
static PetscErrorCode AnalyticOfEntry(Scene scene, const char *path, Node master, ListedSurface *tool)
{
  char key[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  *tool = (ListedSurface){.label = master->n ? master->key[0] : "", .rigid = 1};
  snprintf(key, sizeof key, "master.%s.free", tool->label);
  if (master->n && SceneHas(scene, path, key))
    PetscCall(SceneRefuse(scene, path, key,
                          "is not available with surfaces; allowed: motion, a meshed tool, or slave and master", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the pairs of listed surfaces. */
static PetscErrorCode AddListed(Scene scene, int entry, const char *path, int n_list, const ListedSurface *list, int *n,
                                SurfacePair *pairs)
{
  const Node    exclude = SceneNode(scene, path, "exclude"), master = SceneNode(scene, path, "master");
  const int     before     = *n;
  int           deformable = 0;
  ListedSurface tool;

  PetscFunctionBeginUser;
  if (master) PetscCall(AnalyticOfEntry(scene, path, master, &tool));
  PetscCall(CheckExclude(scene, path, exclude, n_list, list));
  for (int s = 0; s < n_list; s++) {
    deformable += !list[s].rigid;
    for (int m = 0; m < n_list && !list[s].rigid; m++) {
      if (NamesPair(scene, list[s].group, list[m].group) || Excludes(exclude, &list[s], &list[m])) continue;
      pairs[(*n)++] = (SurfacePair){entry, 1, list[s], list[m], list[m].rigid ? 1 : 0.5};
    }
    if (master && !list[s].rigid) pairs[(*n)++] = (SurfacePair){entry, 1, list[s], tool, 1};
  }
  if (!deformable)
    PetscCall(
      SceneRefuse(scene, path, "surfaces", "has no surface of a deformable body; allowed: a list with one", NULL));
  if (*n == before)
    PetscCall(SceneRefuse(scene, path, "exclude", "leaves no pair; allowed: exclusions that leave one", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the pairs of one entry. */
static PetscErrorCode ListEntry(Scene scene, int entry, int *n, SurfacePair **pairs)
{
  char           path[KEY_PATH_LENGTH];
  Node           surfaces;
  int            n_list = 1;
  ListedSurface *list   = NULL;
  PetscErrorCode refused;

  PetscFunctionBeginUser;
  snprintf(path, sizeof path, "contact.%d", entry);
  surfaces = SceneNode(scene, path, "surfaces");
  PetscCall(CheckEntry(scene, path, surfaces));
  if (surfaces) PetscCall(ListSurfaces(scene, surfaces, &n_list, &list));
  PetscCall(PetscRealloc((*n + n_list * (n_list + 1)) * sizeof(**pairs), pairs));
  if (!surfaces) {
    (*pairs)[(*n)++] = (SurfacePair){.entry = entry, .share = 1};
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  refused = AddListed(scene, entry, path, n_list, list, n, *pairs);
  PetscCall(PetscFree(list));
  PetscCall(refused);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneListSurfacePairs - lists the pairs of all contact entries, those of a list of surfaces one by one.

  Collective

  Input Parameter:
. scene - the scene, of which the bodies have been read

  Output Parameters:
+ n     - number of pairs
- pairs - the pairs in the order of the entries, to be freed with PetscFree(), after a refusal too

  Note:
  Refuses entries with neither slave and master nor surfaces, and what is not available with surfaces.
@*/
PetscErrorCode SceneListSurfacePairs(Scene scene, int *n, SurfacePair **pairs)
{
  PetscFunctionBeginUser;
  *n     = 0;
  *pairs = NULL;
  for (int i = 0; i < SchemaCount(SceneDocument(scene), "contact"); i++) PetscCall(ListEntry(scene, i, n, pairs));
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
  snprintf(text, sizeof text, "%s.%s.%s", entry, pair->slave.label, pair->master.label);
  PetscCall(PetscStrallocpy(alone ? entry : text, name));
  PetscFunctionReturn(PETSC_SUCCESS);
}
