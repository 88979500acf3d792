/* Motions of rigid tools and analytic masters, with what pushes them, see scenemotion.h. */
#include "scenemotion.h"
#include "sceneread.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const Components[] = {"ux", "uy", "uz", "rx", "ry", "rz"};

/* Load parameters, spread evenly from 0 to 1, at which expressions of t are tried when they are read. */
enum { SCENE_SAMPLES = 16 };

/*@
  SceneDestroyMotion - frees what a motion holds.

  Not collective

  Input Parameter:
. motion - the motion; the struct itself belongs to the caller
@*/
PetscErrorCode SceneDestroyMotion(Motion *motion)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < motion->n; k++) {
    PetscCall(PetscFree2(motion->components[k].history.t, motion->components[k].history.v));
    PetscCall(ExpressionDestroy(&motion->components[k].expression));
  }
  for (int c = 0; c < MOTION_COMPONENTS; c++) PetscCall(ExpressionDestroy(&motion->force_expression[c]));
  PetscCall(PetscFree2(motion->history.t, motion->history.v));
  PetscCall(PetscFree(motion->components));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a number or an expression of t alone; a tool has no place at which x, y or z could be taken. */
static PetscErrorCode SceneReadOfTime(Scene scene, const char *path, const char *key, double *value,
                                      Expression *expression)
{
  PetscFunctionBeginUser;
  PetscCall(SceneReadValue(scene, path, key, value, expression));
  for (int k = EXPRESSION_X; k <= EXPRESSION_THETA; k++)
    if (ExpressionUses(*expression, (ExpressionVariable)k))
      PetscCall(SceneRefuse(scene, path, key,
                            "differs from place to place, but a tool is rigid; allowed: a number or an expression of t",
                            NULL));
  for (int k = 0; *expression && k <= SCENE_SAMPLES; k++) {
    static const PetscReal origin[3] = {0, 0, 0};

    if (!isfinite(ExpressionValue(*expression, origin, (PetscReal)k / SCENE_SAMPLES)))
      PetscCall(SceneRefuse(scene, path, key,
                            "is not finite for some t between 0 and 1; allowed: an expression that is finite there",
                            NULL));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads one component of an entry of a motion. */
static PetscErrorCode SceneReadComponent(Scene scene, const char *path, int k, MotionComponent *component)
{
  const char *key = Components[k];

  PetscFunctionBeginUser;
  component->component = k;
  PetscCall(SceneReadOfTime(scene, path, key, &component->value, &component->expression));
  if (component->expression && SceneHas(scene, path, "history"))
    PetscCall(SceneRefuse(scene, path, "history",
                          "stands beside an expression, which is the value at t itself; allowed: one of them", NULL));
  PetscCall(SceneReadHistory(scene, path, &component->history));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the geometry has a component of a motion: ux to rz. */
static int SceneHasComponent(Scene scene, int k)
{
  if (scene->geometry == GEOMETRY_AXISYMMETRIC) return k == 1;
  return scene->dim == 3 || k < 2 || k == 5;
}

/* Reads the free components of a tool. */
static PetscErrorCode SceneReadFree(Scene scene, const char *tool, Motion *motion)
{
  const int n = SchemaCount(SceneDocument(scene), "%s.free", tool);
  char      index[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  for (int i = 0; i < n; i++) {
    const char *word;
    int         k = 0;

    snprintf(index, sizeof index, "free.%d", i);
    word = SceneNode(scene, tool, index)->text;
    while (k < MOTION_COMPONENTS - 1 && strcmp(word, Components[k]) != 0) k++;
    if (!SceneHasComponent(scene, k))
      PetscCall(SceneRefuse(scene, tool, index,
                            scene->dim == 3 || scene->geometry == GEOMETRY_AXISYMMETRIC
                              ? "would break the symmetry about the axis; allowed: uy"
                              : "leads out of the plane; allowed: ux, uy, rz",
                            word));
    if (motion->free[k]++) PetscCall(SceneRefuse(scene, tool, index, "is named twice; allowed: once", word));
    motion->n_free++;
  }
  for (int m = 0; m < motion->n; m++)
    if (motion->free[motion->components[m].component])
      PetscCall(SceneRefuse(scene, tool, "free", "is moved by motion as well; allowed: one of both",
                            Components[motion->components[m].component]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads force and moment on a tool. They may act along free components only: the others take them without any effect.
 */
static PetscErrorCode SceneReadForces(Scene scene, const char *tool, Motion *motion)
{
  static const char *const keys[] = {"0", "1", "2", "x", "y", "z"};
  char                     path[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  for (int k = 0; k < MOTION_COMPONENTS; k++) {
    KeyPathJoin(path, tool, k < 3 ? "force" : "moment");
    if (!SceneNode(scene, path, keys[k])) continue;
    PetscCall(SceneReadOfTime(scene, path, keys[k], &motion->force[k], &motion->force_expression[k]));
    if ((motion->force[k] != 0 || motion->force_expression[k]) && !motion->free[k])
      PetscCall(SceneRefuse(scene, path, keys[k],
                            "acts along a component that is not free and has no effect; allowed: 0, or this component "
                            "under free",
                            Components[k]));
  }
  if (motion->n_free)
    PetscCall(SceneReadHistory(scene, tool, &motion->history));
  else if (SceneHas(scene, tool, "history"))
    PetscCall(SceneRefuse(scene, tool, "history",
                          "is a factor on force and moment, but nothing is free; allowed: with free, or under motion",
                          NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the direction of a bolt. */
static PetscErrorCode SceneReadAxis(Scene scene, const char *path, SceneBody *body)
{
  double square = 0;

  PetscFunctionBeginUser;
  (void)SceneReals(scene, path, "axis", body->axis);
  for (int d = 0; d < 3; d++) square += body->axis[d] * body->axis[d];
  if (!(square > 0))
    PetscCall(SceneRefuse(scene, path, "axis", "has no direction; allowed: a vector other than 0", NULL));
  for (int d = 0; d < 3; d++) body->axis[d] /= sqrt(square);
  if (scene->geometry == GEOMETRY_AXISYMMETRIC && body->axis[0] != 0)
    PetscCall(SceneRefuse(scene, path, "axis", "would break the symmetry about the axis; allowed: [0, 1]", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads from when on a bolt keeps its length. */
static PetscErrorCode SceneReadLocked(Scene scene, const char *path, SceneBody *body)
{
  const Node node = SceneNode(scene, path, "locked");

  PetscFunctionBeginUser;
  body->locked = 2;
  if (!node) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; !NodeReal(node, &body->locked) && i < scene->stepping.n_steps; i++)
    if (!strcmp(scene->stepping.steps[i].name, node->text)) body->locked = scene->stepping.steps[i].begin;
  if (body->locked < 0 || body->locked > 1)
    PetscCall(SceneRefuse(scene, path, "locked",
                          "is no step and no load parameter; allowed: a number from 0 to 1, or a name under "
                          "stepping.steps",
                          node->text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneReadPretension - reads how a body is tightened as a bolt.

  Not collective

  Input Parameters:
+ scene - the scene
- body  - a deformable body; those of its fields that describe a bolt are set
@*/
PetscErrorCode SceneReadPretension(Scene scene, SceneBody *body)
{
  char path[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  if (!SceneHas(scene, body->path, "pretension")) PetscFunctionReturn(PETSC_SUCCESS);
  KeyPathJoin(path, body->path, "pretension");
  body->bolt             = 1;
  body->motion.n_free    = 1;
  body->motion.free[0]   = 1;
  body->motion.thickness = scene->thickness;
  PetscCall(SceneReadAxis(scene, path, body));
  PetscCall(SceneReadOfTime(scene, path, "force", &body->motion.force[0], &body->motion.force_expression[0]));
  if (body->motion.force_expression[0] && SceneHas(scene, path, "history"))
    PetscCall(SceneRefuse(scene, path, "history",
                          "stands beside an expression, which is the value at t itself; allowed: one of them", NULL));
  PetscCall(SceneReadHistory(scene, path, &body->motion.history));
  PetscCall(SceneReadLocked(scene, path, body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneReadMotion - reads motion, free components, force and moment of a tool.

  Not collective

  Input Parameters:
+ scene - the scene
- tool  - path of the rigid tool or of the analytic master

  Output Parameter:
. motion - the motion, to be freed with SceneDestroyMotion()
@*/
PetscErrorCode SceneReadMotion(Scene scene, const char *tool, Motion *motion)
{
  const int n = SchemaCount(SceneDocument(scene), "%s.motion", tool);
  char      path[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  motion->thickness = scene->thickness;
  PetscCall(PetscCalloc1(MOTION_COMPONENTS * n, &motion->components));
  for (int i = 0; i < n; i++) {
    const int before = motion->n;

    snprintf(path, sizeof path, "%s.motion.%d", tool, i);
    for (int k = 0; k < MOTION_COMPONENTS; k++) {
      if (!SceneHas(scene, path, Components[k])) continue;
      if (scene->geometry == GEOMETRY_AXISYMMETRIC && k > 1)
        PetscCall(
          SceneRefuse(scene, path, Components[k], "would break the symmetry about the axis; allowed: ux, uy", NULL));
      PetscCall(SceneReadComponent(scene, path, k, &motion->components[motion->n++]));
    }
    if (motion->n == before)
      PetscCall(SceneRefuse(scene, path, "",
                            "moves nothing; allowed: at least one displacement (ux ...) or rotation (rz ...)", NULL));
  }
  PetscCall(SceneReadFree(scene, tool, motion));
  PetscCall(SceneReadForces(scene, tool, motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}
