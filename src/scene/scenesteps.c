/* Steps with names, see scenesteps.h. */
#include "scenesteps.h"
#include <string.h>

/* Load parameters that are closer than this are the same one, as they are for the load stepper. */
#define STEPS_SAME_T 1e-12

/* Characters of a history with at most six points */
enum { STEPS_HISTORY = 400 };

/* Returns the index of the step of a name, or -1. */
static int FindStep(Scene scene, const char *name)
{
  for (int i = 0; i < scene->stepping.n_steps; i++)
    if (!strcmp(scene->stepping.steps[i].name, name)) return i;
  return -1;
}

/* Reads the names of the steps and where they end. */
static PetscErrorCode ReadList(Scene scene)
{
  const int n = SchemaCount(SceneDocument(scene), "stepping.steps");

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &scene->stepping.steps));
  for (int i = 0; i < n; i++) {
    SceneStep *step = &scene->stepping.steps[i];
    char       path[KEY_PATH_LENGTH];

    snprintf(path, sizeof path, "stepping.steps.%d", i);
    step->begin = i ? step[-1].until : 0;
    step->until = SchemaReal(SceneDocument(scene), "%s.until", path);
    if (step->until <= step->begin)
      PetscCall(SceneRefuse(scene, path, "until",
                            "does not increase from one step to the next; allowed: increasing "
                            "values of t, the last one 1",
                            NULL));
    PetscCall(SceneReadText(scene, path, "name", &step->name));
    if (FindStep(scene, step->name) >= 0)
      PetscCall(SceneRefuse(scene, path, "name", "is a step already; allowed: one step of each name", step->name));
    scene->stepping.n_steps++;
    if (i == n - 1 && step->until != 1)
      PetscCall(SceneRefuse(scene, path, "until", "is where the last step ends; allowed: 1", NULL));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the first and the last step of a `during`, which is a name or a list of names. */
static PetscErrorCode FindSpan(Scene scene, const char *path, Node during, int span[2])
{
  const int n = during->kind == NODE_LIST ? during->n : 1;

  PetscFunctionBeginUser;
  if (!scene->stepping.n_steps)
    PetscCall(
      SceneRefuse(scene, path, "during", "names a step, but there are none; allowed: with stepping.steps", NULL));
  if (!n)
    PetscCall(
      SceneRefuse(scene, path, "during", "names no step; allowed: a name under stepping.steps, or a list", NULL));
  for (int i = 0; i < n; i++) {
    const char *name = n > 1 || during->kind == NODE_LIST ? during->child[i]->text : during->text;
    const int   k    = FindStep(scene, name);

    if (k < 0) PetscCall(SceneRefuse(scene, path, "during", "is no step; allowed: a name under stepping.steps", name));
    if (i && k != span[1] + 1)
      PetscCall(SceneRefuse(scene, path, "during",
                            "does not follow the step named before; allowed: steps one after the other (an entry for "
                            "each part of several)",
                            name));
    if (!i) span[0] = k;
    span[1] = k;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a point to a history, in which the last one may be at the same t. */
static void AddPoint(char text[STEPS_HISTORY], double *last, double t, int factor)
{
  const size_t n = strlen(text);

  if (t <= *last) return;
  snprintf(text + n, STEPS_HISTORY - n, "%s[%.17g, %d]", n ? ", " : "[", t, factor);
  *last = t;
}

/* Writes what is moved: from 0 to 1 over the steps, and 1 from then on. */
static void WayText(const SceneStep *first, const SceneStep *final, char text[STEPS_HISTORY])
{
  double last = -1;

  AddPoint(text, &last, 0, 0);
  AddPoint(text, &last, first->begin, 0);
  AddPoint(text, &last, final->until, 1);
  AddPoint(text, &last, 1, 1);
}

/* Writes what acts: from 0 to 1 over the first step, 1 until the final one ends, and back to 0 over the step that
   follows. */
static void ForceText(const SceneStep *first, const SceneStep *final, char text[STEPS_HISTORY])
{
  double last = -1;

  AddPoint(text, &last, 0, 0);
  AddPoint(text, &last, first->begin, 0);
  AddPoint(text, &last, first->until, 1);
  AddPoint(text, &last, final->until, 1);
  if (final->until < 1) AddPoint(text, &last, final[1].until, 0);
  AddPoint(text, &last, 1, final->until < 1 ? 0 : 1);
}

/* Says whether a path is that of a support or of a contact pair, which are there, and not one of a tool's forces. */
static int IsThere(const char *path)
{
  return !strncmp(path, "supports.", 9) || (!strncmp(path, "contact.", 8) && !strchr(path + 8, '.'));
}

/* Springs and pairs are there from the start where the first step is named. */
static void SpringText(const SceneStep *first, const SceneStep *final, char text[STEPS_HISTORY])
{
  ForceText(first, final, text);
  if (first->begin == 0) text[strlen("[[0, ")] = '1';
}

/* Notes in a step what acts during it, for -check. */
static PetscErrorCode Note(SceneStep *step, const char *path)
{
  char *before = step->acts;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(strlen(path) + (before ? strlen(before) : 0) + 3, &step->acts));
  sprintf(step->acts, "%s%s%s", before ? before : "", before ? ", " : "", path);
  PetscCall(PetscFree(before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Puts a history in the place of the `during` of a map. That of a support that prescribes displacements stays: these
   are there or not. */
static PetscErrorCode ResolveMap(Scene scene, Node map, int place, const char *path)
{
  const Node during              = map->child[place];
  const int  prescribes          = NodeChild(map, "ux") || NodeChild(map, "uy") || NodeChild(map, "uz");
  const int  moves               = strstr(path, ".motion.") || prescribes;
  char       text[STEPS_HISTORY] = "", below[KEY_PATH_LENGTH];
  int        span[2]             = {0, 0};

  PetscFunctionBeginUser;
  if (NodeChild(map, "history"))
    PetscCall(SceneRefuse(scene, path, "during", "stands beside a history; allowed: one of them", NULL));
  PetscCall(FindSpan(scene, path, during, span));
  for (int k = span[0]; k <= span[1]; k++) PetscCall(Note(&scene->stepping.steps[k], path));
  if (prescribes && !strncmp(path, "supports.", 9)) PetscFunctionReturn(PETSC_SUCCESS);
  if (IsThere(path))
    SpringText(&scene->stepping.steps[span[0]], &scene->stepping.steps[span[1]], text);
  else
    (moves ? WayText : ForceText)(&scene->stepping.steps[span[0]], &scene->stepping.steps[span[1]], text);
  strcat(text, "]");
  KeyPathJoin(below, path, "during");
  PetscCall(DocumentReplace(SceneDocument(scene), during, below, text));
  PetscCall(PetscFree(map->key[place]));
  PetscCall(PetscStrallocpy("history", &map->key[place]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Looks for `during` in a node and all nodes below it. */
static PetscErrorCode ResolveBelow(Scene scene, Node node, const char *path)
{
  char below[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  for (int i = 0; i < node->n; i++) {
    if (node->kind == NODE_MAP && !strcmp(node->key[i], "during")) {
      PetscCall(ResolveMap(scene, node, i, path));
      continue;
    }
    if (node->kind == NODE_MAP)
      KeyPathJoin(below, path, node->key[i]);
    else
      KeyPathJoinIndex(below, path, i);
    PetscCall(ResolveBelow(scene, node->child[i], below));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneReadSteps - reads the steps with names, and puts histories in the place of the names of steps.

  Collective

  Input Parameter:
. scene - the scene, of which the document has been checked and nothing else was read
@*/
PetscErrorCode SceneReadSteps(Scene scene)
{
  static const char *const parts[] = {"bodies", "supports", "loads", "contact"};

  PetscFunctionBeginUser;
  PetscCall(ReadList(scene));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(parts); i++) {
    const Node node = NodeFind(SceneDocument(scene)->root, parts[i]);

    if (node) PetscCall(ResolveBelow(scene, node, parts[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneReadSpan - reads the steps of a `during` that SceneReadSteps() has left in its place.

  Not collective

  Input Parameters:
+ scene - the scene
- path  - of the map with the key

  Output Parameter:
. span - the steps; without the key it says all the time
@*/
PetscErrorCode SceneReadSpan(Scene scene, const char *path, SceneSpan *span)
{
  const Node during = SceneNode(scene, path, "during");
  int        ends[2];

  PetscFunctionBeginUser;
  *span = (SceneSpan){.some = 0};
  if (!during) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FindSpan(scene, path, during, ends));
  *span = (SceneSpan){1, ends[0], ends[1]};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneDestroySteps - frees what SceneReadSteps() made.

  Not collective

  Input Parameter:
. scene - the scene
@*/
PetscErrorCode SceneDestroySteps(Scene scene)
{
  PetscFunctionBeginUser;
  for (int i = 0; scene->stepping.steps && i < SchemaCount(SceneDocument(scene), "stepping.steps"); i++) {
    PetscCall(PetscFree(scene->stepping.steps[i].name));
    PetscCall(PetscFree(scene->stepping.steps[i].acts));
  }
  PetscCall(PetscFree(scene->stepping.steps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneStepAt - returns the name of the step that ends at a load parameter or is under way there.

  Not collective

  Input Parameters:
+ scene - the scene
- t     - load parameter

  Note:
  It returns NULL where the scene has no steps with names.
@*/
const char *SceneStepAt(Scene scene, PetscReal t)
{
  for (int i = 0; i < scene->stepping.n_steps; i++)
    if (t <= scene->stepping.steps[i].until || i == scene->stepping.n_steps - 1) return scene->stepping.steps[i].name;
  return NULL;
}

/*@
  SceneStepFrom - returns the number of the step that is under way from a load parameter on.

  Not collective

  Input Parameters:
+ scene - the scene
- t     - load parameter

  Note:
  Where one step ends and the next one begins it is the number of the next one. It is 0 without steps with names.
@*/
int SceneStepFrom(Scene scene, PetscReal t)
{
  int i = 0;

  while (i < scene->stepping.n_steps - 1 && t >= scene->stepping.steps[i].until - STEPS_SAME_T) i++;
  return i;
}
