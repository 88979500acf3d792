/* Supports and loads of a scene, see sceneload.h. */
#include "sceneload.h"
#include "sceneread.h"
#include "scenesteps.h"
#include <string.h>

static const char *const Displacements[] = {"ux", "uy", "uz"};

/* Reads one component of a support. An expression makes it an imposed displacement, which is kept among the loads. */
static PetscErrorCode SceneReadSupportValue(Scene scene, SceneSupport *support, int component)
{
  SceneLoad *load       = NULL;
  Expression expression = NULL;
  double     value;

  PetscFunctionBeginUser;
  PetscCall(SceneReadValue(scene, support->path, Displacements[component], &value, &expression));
  support->fixed[component] = !expression;
  if (!expression && value != 0)
    PetscCall(SceneRefuse(scene, support->path, Displacements[component],
                          "a support holds at 0; allowed: 0 (an imposed displacement is a load, under loads:), or an "
                          "expression of the place or of t",
                          NULL));
  if (!expression) PetscFunctionReturn(PETSC_SUCCESS);
  if (scene->n_loads) load = &scene->loads[scene->n_loads - 1];
  if (!load || strcmp(load->path, support->path)) {
    load = &scene->loads[scene->n_loads++];
    PetscCall(PetscStrallocpy(support->path, &load->path));
    PetscCall(PetscStrallocpy(support->surface, &load->region));
    load->kind   = LOAD_DISPLACEMENT;
    load->during = support->during;
    if (!load->during.some) PetscCall(SceneReadHistory(scene, load->path, &load->history));
  }
  load->has[component]        = 1;
  load->expression[component] = expression;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads in which steps a support holds that prescribes displacements. */
static PetscErrorCode SceneReadSupportSpan(Scene scene, SceneSupport *support)
{
  PetscFunctionBeginUser;
  PetscCall(SceneReadSpan(scene, support->path, &support->during));
  if (support->during.some && SceneHas(scene, support->path, "spring"))
    PetscCall(SceneRefuse(scene, support->path, "spring",
                          "stands beside a displacement with `during`; allowed: an entry for each of the two", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the factor on the springs of a support. */
static PetscErrorCode SceneReadSpringHistory(Scene scene, SceneSupport *support)
{
  PetscFunctionBeginUser;
  PetscCall(SceneReadFactors(scene, support->path, "history", &support->history));
  if (!support->history.n) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 3; k++)
    if (SceneHas(scene, support->path, Displacements[k]))
      PetscCall(SceneRefuse(scene, support->path, Displacements[k],
                            "stands beside a history, which only springs take; allowed: an entry for each of the "
                            "two, or `during`, which names the steps in which it holds",
                            NULL));
  for (int i = 0; i < support->history.n; i++)
    if (support->history.v[i] < 0)
      PetscCall(SceneRefuse(scene, support->path, "history", "has a negative factor; allowed: 0 or more", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the springs of a support. Returns in *any whether there are some. */
static PetscErrorCode SceneReadSprings(Scene scene, SceneSupport *support, int *any)
{
  PetscFunctionBeginUser;
  *any = 0;
  if (!SceneReals(scene, support->path, "spring", support->spring)) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < scene->dim; k++) {
    if (support->spring[k] > 0 && SceneHas(scene, support->path, Displacements[k]))
      PetscCall(SceneRefuse(scene, support->path, "spring",
                            "acts along a component that the support prescribes too; allowed: one of the two for each "
                            "component",
                            Displacements[k]));
    *any = *any || support->spring[k] > 0;
  }
  if (!*any)
    PetscCall(
      SceneRefuse(scene, support->path, "spring", "holds nothing; allowed: at least one stiffness above 0", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneReadSupports - reads the supports.

  Not collective

  Input Parameter:
. scene - the scene

  Note:
  It makes room for the loads, because supports with an expression are among them.
@*/
PetscErrorCode SceneReadSupports(Scene scene)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(SchemaCount(SceneDocument(scene), "loads") + SchemaCount(SceneDocument(scene), "supports"),
                         &scene->loads));
  scene->n_supports = SchemaCount(SceneDocument(scene), "supports");
  PetscCall(PetscCalloc1(scene->n_supports, &scene->supports));
  for (int i = 0; i < scene->n_supports; i++) {
    SceneSupport *support = &scene->supports[i];
    int           held    = 0;

    PetscCall(ScenePath(&support->path, "supports", i));
    PetscCall(SceneReadText(scene, support->path, "surface", &support->surface));
    PetscCall(SceneRefuseRigid(scene, support->path, "surface", support->surface));
    PetscCall(SceneReadSupportSpan(scene, support));
    PetscCall(SceneReadSpringHistory(scene, support));
    PetscCall(SceneReadSprings(scene, support, &held));
    for (int k = 0; k < 3; k++) {
      if (!SceneHas(scene, support->path, Displacements[k])) continue;
      PetscCall(SceneReadSupportValue(scene, support, k));
      held++;
    }
    if (!held)
      PetscCall(SceneRefuse(scene, support->path, "",
                            "holds nothing; allowed: at least one of ux: 0, uy: 0, uz: 0 (3D), spring", NULL));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the values of a load of any kind. */
static PetscErrorCode SceneReadLoadValues(Scene scene, SceneLoad *load, const char *kind)
{
  char path[KEY_PATH_LENGTH], index[2] = "0";

  PetscFunctionBeginUser;
  KeyPathJoin(path, load->path, kind);
  for (int k = 0; k < scene->dim; k++) {
    index[0] = (char)('0' + k);
    if (load->kind >= LOAD_TRACTION)
      PetscCall(SceneReadValue(scene, path, index, &load->value[k], &load->expression[k]));
    else if (load->kind == LOAD_DISPLACEMENT ? load->has[k] : !k)
      PetscCall(SceneReadValue(scene, load->path, load->kind == LOAD_PRESSURE ? kind : Displacements[k],
                               &load->value[k], &load->expression[k]));
    if (SceneLoadVaries(load, k) && SceneHas(scene, load->path, "history"))
      PetscCall(SceneRefuse(scene, load->path, "history",
                            "stands beside an expression with t, which is the value at t itself; allowed: one of them",
                            NULL));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a force that differs from place to place: it is the sum over all places. */
static PetscErrorCode SceneCheckForce(Scene scene, const SceneLoad *load)
{
  PetscFunctionBeginUser;
  for (int c = 0; c < scene->dim; c++)
    for (int k = EXPRESSION_X; k <= EXPRESSION_THETA; k++)
      if (load->expression[c] && ExpressionUses(load->expression[c], (ExpressionVariable)k))
        PetscCall(SceneRefuse(scene, load->path, "force",
                              "differs from place to place; allowed: numbers or expressions of t (traction may differ)",
                              NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads an end of a surface. */
static PetscErrorCode SceneReadEnd(Scene scene, const char *path, const char *key, SceneEnd *end)
{
  const Node node = SceneNode(scene, path, key);

  PetscFunctionBeginUser;
  if (!node) PetscFunctionReturn(PETSC_SUCCESS);
  end->has_point = node->kind == NODE_LIST;
  if (end->has_point)
    (void)SceneReals(scene, path, key, end->point);
  else
    PetscCall(SceneReadText(scene, path, key, &end->surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses what a fluid that enters between surfaces cannot have: another pressure at each place, suction, a direction
   that does not follow the face. */
static PetscErrorCode SceneCheckFluid(Scene scene, SceneLoad *load)
{
  const Expression formula = load->expression[0];

  PetscFunctionBeginUser;
  for (int k = EXPRESSION_X; k <= EXPRESSION_THETA; k++)
    if (formula && ExpressionUses(formula, (ExpressionVariable)k))
      PetscCall(SceneRefuse(scene, load->path, "pressure",
                            "differs from place to place; allowed with where: open: a number or an expression of t",
                            NULL));
  if (!formula && load->value[0] < 0)
    PetscCall(SceneRefuse(scene, load->path, "pressure",
                          "is negative; allowed with where: open: 0 or more (a fluid presses)", NULL));
  for (int i = 0; i < load->history.n; i++)
    if (load->history.v[i] < 0)
      PetscCall(SceneRefuse(scene, load->path, "history",
                            "has a negative factor; allowed with where: open: 0 or more (a fluid presses)", NULL));
  if (SceneHas(scene, load->path, "follower") && !load->follower && scene->kinematics == KINEMATICS_FINITE)
    PetscCall(SceneRefuse(scene, load->path, "follower",
                          "is false; allowed with where: open and finite kinematics: true, which is its default there",
                          NULL));
  load->follower = 1;
  if (!scene->n_contacts && !SchemaCount(SceneDocument(scene), "contact"))
    PetscCall(
      SceneRefuse(scene, load->path, "where", "is open, but no contact is given; allowed: with contact pairs", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads where a pressure acts, after its values. */
static PetscErrorCode SceneReadWhere(Scene scene, SceneLoad *load)
{
  static const char *const Ends[] = {"from", "to"};

  PetscFunctionBeginUser;
  load->open = SchemaChoice(SceneDocument(scene), "%s.where", load->path) == 1;
  if (load->open && load->kind != LOAD_PRESSURE)
    PetscCall(SceneRefuse(scene, load->path, "where", "is open; allowed: with pressure", NULL));
  for (int k = 0; k < 2; k++)
    if (!load->open && SceneHas(scene, load->path, Ends[k]))
      PetscCall(SceneRefuse(scene, load->path, Ends[k], "has no place here; allowed: with where: open", NULL));
  if (!load->open) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SceneReadEnd(scene, load->path, "from", &load->from));
  PetscCall(SceneReadEnd(scene, load->path, "to", &load->to));
  PetscCall(SceneCheckFluid(scene, load));
  for (SceneLoad *other = scene->loads; other < load; other++)
    if (other->open && !strcmp(other->region, load->region))
      PetscCall(SceneRefuse(scene, load->path, "surface", "has a fluid already; allowed: one load with where: open",
                            load->region));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadLoad(Scene scene, SceneLoad *load)
{
  static const char *const Kinds[] = {"displacement", "pressure", "traction", "force", "body_force"};
  int                      kinds   = 0;
  const char              *region;

  PetscFunctionBeginUser;
  for (int k = 0; k < 3; k++) load->has[k] = SceneHas(scene, load->path, Displacements[k]);
  for (int kind = LOAD_DISPLACEMENT; kind <= LOAD_BODY_FORCE; kind++) {
    if (kind == LOAD_DISPLACEMENT ? !(load->has[0] || load->has[1] || load->has[2])
                                  : !SceneHas(scene, load->path, Kinds[kind]))
      continue;
    load->kind = (LoadKind)kind;
    kinds++;
  }
  if (kinds != 1)
    PetscCall(SceneRefuse(scene, load->path, "",
                          "allowed: exactly one of displacement (ux, uy, uz), pressure, traction, force, body_force",
                          kinds ? "has more than one kind;" : "has no kind;"));
  region = load->kind == LOAD_BODY_FORCE ? "volume" : "surface";
  if (!SceneHas(scene, load->path, region))
    PetscCall(SceneRefuse(scene, load->path, region, Kinds[load->kind], "is missing; allowed: where it acts, for a"));
  if (SceneHas(scene, load->path, "surface") && SceneHas(scene, load->path, "volume"))
    PetscCall(SceneRefuse(scene, load->path, load->kind == LOAD_BODY_FORCE ? "surface" : "volume", region,
                          "has no place here; allowed: only"));
  PetscCall(SceneReadText(scene, load->path, region, &load->region));
  if (load->kind == LOAD_BODY_FORCE && !SceneFindBody(scene, load->region, 0))
    PetscCall(
      SceneRefuse(scene, load->path, region, "is no deformable body; allowed: a volume under bodies:", load->region));
  if (load->kind != LOAD_BODY_FORCE) PetscCall(SceneRefuseRigid(scene, load->path, region, load->region));
  load->follower = SchemaBoolean(SceneDocument(scene), "%s.follower", load->path);
  if (load->follower && load->kind != LOAD_PRESSURE)
    PetscCall(
      SceneRefuse(scene, load->path, "follower", "only a pressure follows the face; allowed: with pressure", NULL));
  PetscCall(SceneReadLoadValues(scene, load, Kinds[load->kind]));
  if (load->kind == LOAD_FORCE) PetscCall(SceneCheckForce(scene, load));
  PetscCall(SceneReadHistory(scene, load->path, &load->history));
  PetscCall(SceneReadWhere(scene, load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneReadLoads - reads the loads, after SceneReadSupports().

  Not collective

  Input Parameter:
. scene - the scene
@*/
PetscErrorCode SceneReadLoads(Scene scene)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < SchemaCount(SceneDocument(scene), "loads"); i++) {
    SceneLoad *load = &scene->loads[scene->n_loads++];

    PetscCall(ScenePath(&load->path, "loads", i));
    PetscCall(SceneReadLoad(scene, load));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
