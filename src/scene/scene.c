/* The reader of a scene: it fills the Scene from a validated document, see scene.h. */
#include "sceneprobe.h"
#include "scenedefaults.h"
#include "scenematerial.h"
#include "sceneplasticity.h"
#include "sceneread.h"
#include "scenesurfaces.h"
#include "base/refusal.h"
#include <string.h>

static const char *const Displacements[] = {"ux", "uy", "uz"}, *const Components[] = {
                                                                 "ux", "uy", "uz",
                                                                 "rx", "ry", "rz"}; /* of a rigid motion */

/* Load parameters, spread evenly from 0 to 1, at which expressions of t are tried when they are read. */
enum { SCENE_SAMPLES = 16 };

/* Reads a list of breakpoints and factors; n is 0 where the scene has none. */
static PetscErrorCode SceneReadFactors(Scene scene, const char *path, const char *key, History *history)
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

/* Reads the history below a path. Without one, the factor is the load parameter itself. */
static PetscErrorCode SceneReadHistory(Scene scene, const char *path, History *history)
{
  PetscFunctionBeginUser;
  PetscCall(SceneReadFactors(scene, path, "history", history));
  if (history->n) PetscFunctionReturn(PETSC_SUCCESS);
  history->n = 2;
  PetscCall(PetscCalloc2(history->n, &history->t, history->n, &history->v));
  history->t[1] = history->v[1] = 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a map of keys and values that are not in the schema. The value null becomes an empty text. */
static PetscErrorCode SceneReadPairs(Scene scene, const char *key, int *n, ScenePair **pairs)
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

static PetscErrorCode SceneReadMesh(Scene scene)
{
  const char *file = SchemaText(SceneDocument(scene), "mesh.file"), *dot = strrchr(file, '.');
  const int   geo = dot && !strcmp(dot, ".geo");
  char        path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  if (!geo && (!dot || strcmp(dot, ".msh")))
    PetscCall(SceneRefuse(scene, "mesh", "file", "is no mesh file; allowed: a .geo or a .msh file", file));
  if (snprintf(path, sizeof path, "%s%s%s", file[0] == '/' ? "" : scene->directory, file[0] == '/' ? "" : "/", file) >=
      (int)sizeof path)
    PetscCall(SceneRefuse(scene, "mesh", "file", "the path is too long", NULL));
  PetscCall(PetscStrallocpy(path, &scene->mesh_file));
  scene->order =
    SchemaHas(SceneDocument(scene), "mesh.order") ? SchemaInteger(SceneDocument(scene), "mesh.order") : geo;
  PetscCall(SceneReadPairs(scene, "mesh.parameters", &scene->n_parameters, &scene->parameters));
  for (int i = 0; i < scene->n_parameters; i++) {
    if (!scene->parameters[i].value[0])
      PetscCall(SceneRefuse(scene, "mesh.parameters", scene->parameters[i].key,
                            "has no value; allowed: a number or a text", NULL));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MotionFree(Motion *motion)
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

/* Reads the motion of a rigid tool or an analytic master, whose path is `tool`. */
static PetscErrorCode SceneReadMotion(Scene scene, const char *tool, Motion *motion)
{
  const int n = SchemaCount(SceneDocument(scene), "%s.motion", tool);
  char      path[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(MOTION_COMPONENTS * n, &motion->components));
  for (int i = 0; i < n; i++) {
    const int before = motion->n;

    snprintf(path, sizeof path, "%s.motion.%d", tool, i);
    for (int k = 0; k < MOTION_COMPONENTS; k++) {
      if (!SceneHas(scene, path, Components[k])) continue;
      if (scene->geometry == GEOMETRY_AXISYMMETRIC && k != 1)
        PetscCall(
          SceneRefuse(scene, path, Components[k], "would break the symmetry about the axis; allowed: uy", NULL));
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

/* Bulk modulus over shear modulus from which elements with full integration lock noticeably (nu = 0.475), so that
   `auto` takes mixed ones. */
static const double stiff_volume = 20;

static int SceneStiffVolume(const SceneBody *body)
{
  const Material *material = &body->material;
  const double    mu       = MaterialShear(material);

  return material->constants[0] + (MaterialGetLaw(material->law)->isochoric ? 0 : 2 * mu / 3) > stiff_volume * mu;
}

/* Says whether mixed elements exist for the law of a body. With small strains all laws are Hooke's. */
static int SceneLawSplits(Scene scene, const SceneBody *body)
{
  const MaterialLaw law = body->material.law;

  return MaterialGetLaw(law)->separable || (scene->kinematics == KINEMATICS_SMALL && law != MATERIAL_UMAT);
}

static PetscErrorCode SceneReadFormulation(Scene scene, SceneBody *body)
{
  const int choice  = SchemaChoice(SceneDocument(scene), "%s.formulation", body->path);
  const int plastic = MaterialGetLaw(body->material.law)->plastic;

  PetscFunctionBeginUser;
  body->chosen = choice == FORMULATIONS;
  if (body->chosen && plastic)
    body->formulation = scene->order == 1                          ? FORMULATION_FBAR
                        : body->material.law == MATERIAL_VON_MISES ? FORMULATION_MIXED
                                                                   : FORMULATION_FULL;
  else if (body->chosen)
    body->formulation = SceneStiffVolume(body) && SceneLawSplits(scene, body) ? FORMULATION_MIXED : FORMULATION_FULL;
  else
    body->formulation = (Formulation)choice;
  if ((body->formulation == FORMULATION_ENHANCED || body->formulation == FORMULATION_FBAR) && scene->order == 2)
    PetscCall(SceneRefuse(scene, body->path, "formulation",
                          "is for first-order elements; allowed with mesh.order: 2: full | mixed",
                          Formulations[body->formulation]));
  if (body->formulation == FORMULATION_ENHANCED && body->material.law == MATERIAL_UMAT)
    PetscCall(SceneRefuse(scene, body->path, "formulation", "needs an energy; allowed with umat: full | fbar",
                          Formulations[body->formulation]));
  if (body->formulation == FORMULATION_MIXED && !SceneLawSplits(scene, body))
    PetscCall(SceneRefuse(
      scene, body->path, "formulation",
      "needs a law whose volume part is separate; allowed with svk: full | enhanced | fbar, with umat: full | "
      "fbar",
      Formulations[body->formulation]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadBody(Scene scene, SceneBody *body)
{
  static const char Needs[] = "a body is volume with material, or surface with rigid";

  PetscFunctionBeginUser;
  body->rigid = SceneHas(scene, body->path, "surface");
  if (body->rigid == SceneHas(scene, body->path, "volume"))
    PetscCall(SceneRefuse(scene, body->path, "",
                          body->rigid ? "has both a volume and a surface; allowed:"
                                      : "has neither a volume nor a surface; allowed:",
                          NULL));
  if (!SceneHas(scene, body->path, body->rigid ? "rigid" : "material"))
    PetscCall(SceneRefuse(scene, body->path, body->rigid ? "rigid" : "material", Needs, "is missing; allowed:"));
  if (SceneHas(scene, body->path, body->rigid ? "material" : "rigid"))
    PetscCall(SceneRefuse(scene, body->path, body->rigid ? "material" : "rigid", Needs, "has no place here; allowed:"));
  PetscCall(SceneReadText(scene, body->path, body->rigid ? "surface" : "volume", &body->name));
  if (body->rigid) {
    char tool[KEY_PATH_LENGTH];

    snprintf(tool, sizeof tool, "%s.rigid", body->path);
    (void)SceneReals(scene, body->path, "rigid.point", body->motion.point);
    PetscCall(SceneReadMotion(scene, tool, &body->motion));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SceneReadMaterial(scene, body));
  PetscCall(SceneReadPlasticity(scene, body));
  PetscCall(SceneReadRoutine(scene, body));
  PetscCall(SceneReadFormulation(scene, body));
  PetscCall(SceneCheckIncompressible(scene, body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadBodies(Scene scene)
{
  int deformable = 0;

  PetscFunctionBeginUser;
  scene->n_bodies = SchemaCount(SceneDocument(scene), "bodies");
  PetscCall(PetscCalloc1(scene->n_bodies, &scene->bodies));
  for (int i = 0; i < scene->n_bodies; i++) {
    SceneBody *body = &scene->bodies[i];

    PetscCall(ScenePath(&body->path, "bodies", i));
    PetscCall(SceneReadBody(scene, body));
    if (SceneFindBody(scene, body->name, body->rigid) != body)
      PetscCall(SceneRefuse(scene, body->path, body->rigid ? "surface" : "volume", "is a body already; allowed: once",
                            body->name));
    deformable += !body->rigid;
  }
  if (!deformable)
    PetscCall(
      SceneRefuse(scene, "bodies", "", "has only rigid tools; allowed: at least one volume with material", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a surface that belongs to a rigid tool. */
static PetscErrorCode SceneRefuseRigid(Scene scene, const char *path, const char *key, const char *surface)
{
  PetscFunctionBeginUser;
  if (surface && SceneFindBody(scene, surface, 1))
    PetscCall(SceneRefuse(
      scene, path, key, "is a rigid tool, moved by its own motion; allowed: a surface of a deformable body", surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

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
    load->kind = LOAD_DISPLACEMENT;
    PetscCall(SceneReadHistory(scene, load->path, &load->history));
  }
  load->has[component]        = 1;
  load->expression[component] = expression;
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

/* Reads the supports, and makes room for the loads, because supports with an expression are among them. */
static PetscErrorCode SceneReadSupports(Scene scene)
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
    if (load->kind == LOAD_TRACTION || load->kind == LOAD_BODY_FORCE)
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
  static const char *const Kinds[] = {"displacement", "pressure", "traction", "body_force"};
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
                          "allowed: exactly one of displacement (ux, uy, uz), pressure, traction, body_force",
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
  PetscCall(SceneReadHistory(scene, load->path, &load->history));
  PetscCall(SceneReadWhere(scene, load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadLoads(Scene scene)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < SchemaCount(SceneDocument(scene), "loads"); i++) {
    SceneLoad *load = &scene->loads[scene->n_loads++];

    PetscCall(ScenePath(&load->path, "loads", i));
    PetscCall(SceneReadLoad(scene, load));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads an analytic master, which is a plane, a cylinder or a sphere. */
static PetscErrorCode SceneReadAnalytic(Scene scene, SceneContact *contact)
{
  static const char *const shapes[] = {"plane", "cylinder", "sphere"};
  char                     tool[KEY_PATH_LENGTH];
  double                   length = 0;
  int                      count  = 0;

  PetscFunctionBeginUser;
  for (int k = 0; k < 3; k++) {
    snprintf(tool, sizeof tool, "master.%s", shapes[k]);
    if (!SceneHas(scene, contact->path, tool)) continue;
    contact->analytic.shape = (AnalyticShape)k;
    count++;
  }
  if (count != 1)
    PetscCall(SceneRefuse(scene, contact->path, "master",
                          count ? "names several shapes; allowed: a surface, or one of plane, cylinder, sphere"
                                : "is empty; allowed: a surface, or one of plane, cylinder, sphere",
                          NULL));
  snprintf(tool, sizeof tool, "%s.master.%s", contact->path, shapes[contact->analytic.shape]);
  (void)SceneReals(scene, tool, contact->analytic.shape == ANALYTIC_SPHERE ? "centre" : "point", contact->motion.point);
  /* In 2D a cylinder is a circle, and its axis is normal to the plane. In an axisymmetric scene its axis is that of
     revolution. */
  contact->analytic.axis[scene->geometry == GEOMETRY_AXISYMMETRIC ? 1 : 2] = 1;
  if (contact->analytic.shape == ANALYTIC_PLANE || scene->dim == 3) {
    contact->analytic.axis[1] = contact->analytic.axis[2] = 0;
    (void)SceneReals(scene, tool, contact->analytic.shape == ANALYTIC_PLANE ? "normal" : "axis",
                     contact->analytic.axis);
  }
  if (contact->analytic.shape != ANALYTIC_PLANE) {
    contact->analytic.radius = SchemaReal(SceneDocument(scene), "%s.radius", tool);
    contact->analytic.inside = SchemaChoice(SceneDocument(scene), "%s.side", tool);
  }
  for (int d = 0; d < 3; d++) length += contact->analytic.axis[d] * contact->analytic.axis[d];
  if (contact->analytic.shape != ANALYTIC_SPHERE && length == 0)
    PetscCall(SceneRefuse(scene, tool, contact->analytic.shape == ANALYTIC_PLANE ? "normal" : "axis",
                          "has no direction; allowed: any vector but zero", NULL));
  if (scene->geometry == GEOMETRY_AXISYMMETRIC && contact->analytic.shape != ANALYTIC_PLANE &&
      contact->motion.point[0] != 0)
    PetscCall(SceneRefuse(scene, tool, contact->analytic.shape == ANALYTIC_SPHERE ? "centre" : "point",
                          "is off the axis, where it would be no body of revolution of that name; allowed: x = 0",
                          NULL));
  if (scene->geometry == GEOMETRY_AXISYMMETRIC && contact->analytic.shape == ANALYTIC_PLANE &&
      contact->analytic.axis[0] != 0)
    PetscCall(
      SceneRefuse(scene, tool, "normal", "is oblique to the axis: that is a cone, not a plane; allowed: [0, y]", NULL));
  PetscCall(SceneReadMotion(scene, tool, &contact->motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads when pressures become multipliers. SceneReadAdjustment() reads g_max and its unit. */
static PetscErrorCode SceneReadAugmentation(Scene scene, SceneContact *contact)
{
  static const char *const needs[] = {"penalty.g_max", "penalty.unit"};

  PetscFunctionBeginUser;
  contact->augment     = SchemaBoolean(SceneDocument(scene), "%s.penalty.augment", contact->path);
  contact->max_updates = SchemaInteger(SceneDocument(scene), "%s.penalty.max_updates", contact->path);
  if (contact->augment && contact->adjust)
    PetscCall(SceneRefuse(
      scene, contact->path, "penalty.augment",
      "is true beside adjust: true; allowed: one of them (augment keeps the penalty, adjust changes it)", NULL));
  for (size_t k = 0; contact->augment && k < PETSC_STATIC_ARRAY_LENGTH(needs); k++)
    if (!SceneHas(scene, contact->path, needs[k]))
      PetscCall(SceneRefuse(scene, contact->path, needs[k], "is missing; allowed with augment: g_max and unit", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads how the penalty follows the penetration, and the window of the penetration. */
static PetscErrorCode SceneReadAdjustment(Scene scene, SceneContact *contact)
{
  static const char *const needs[] = {"penalty.g_min", "penalty.g_max", "penalty.unit"};

  PetscFunctionBeginUser;
  contact->adjust = SchemaBoolean(SceneDocument(scene), "%s.penalty.adjust", contact->path);
  for (size_t k = 0; contact->adjust && k < PETSC_STATIC_ARRAY_LENGTH(needs); k++)
    if (!SceneHas(scene, contact->path, needs[k]))
      PetscCall(
        SceneRefuse(scene, contact->path, needs[k], "is missing; allowed with adjust: g_min, g_max and unit", NULL));
  contact->adjust_converged = SchemaChoice(SceneDocument(scene), "%s.penalty.when", contact->path);
  contact->clamp            = SchemaReal(SceneDocument(scene), "%s.penalty.clamp", contact->path);
  contact->range            = SchemaReal(SceneDocument(scene), "%s.penalty.range", contact->path);
  if (SceneHas(scene, contact->path, "penalty.unit"))
    contact->window_in_spacings = SchemaChoice(SceneDocument(scene), "%s.penalty.unit", contact->path);
  if (SceneHas(scene, contact->path, "penalty.g_min"))
    contact->g_min = SchemaReal(SceneDocument(scene), "%s.penalty.g_min", contact->path);
  if (SceneHas(scene, contact->path, "penalty.g_max"))
    contact->g_max = SchemaReal(SceneDocument(scene), "%s.penalty.g_max", contact->path);
  if (contact->g_min > 0 && contact->g_max > 0 && contact->g_min >= contact->g_max)
    PetscCall(SceneRefuse(scene, contact->path, "penalty.g_min", "is not below g_max; allowed: g_min < g_max", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the penalty at the start of the run, and how it follows the penetration. */
static PetscErrorCode SceneReadPenalty(Scene scene, SceneContact *contact)
{
  Document *document = SceneDocument(scene);

  PetscFunctionBeginUser;
  PetscCall(SceneReadAdjustment(scene, contact));
  PetscCall(SceneReadAugmentation(scene, contact));
  contact->penalty_auto        = SchemaChoice(document, "%s.penalty.initial", contact->path) == 0;
  contact->penalty             = contact->penalty_auto ? 0 : SchemaReal(document, "%s.penalty.initial", contact->path);
  contact->penalty_may_stiffen = SchemaChoice(document, "%s.penalty.scale", contact->path) == 0 &&
                                 contact->penalty_auto && !contact->adjust && !contact->augment;
  if (SchemaChoice(document, "%s.penalty.scale", contact->path) != 0)
    contact->penalty_scale = SchemaReal(document, "%s.penalty.scale", contact->path);
  else
    contact->penalty_scale = contact->penalty_may_stiffen ? SCENE_PENALTY_SCALE : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads what becomes of initial overlaps, and the overlap that is added to that of the meshes. */
static PetscErrorCode SceneReadOverlap(Scene scene, SceneContact *contact)
{
  static const char add[] = "initial_overlap.add";

  PetscFunctionBeginUser;
  contact->initial_overlap = OVERLAP_ADD;
  if (SceneHas(scene, contact->path, add))
    PetscCall(SceneReadValue(scene, contact->path, add, &contact->added_overlap, &contact->overlap_expression));
  else
    contact->initial_overlap = (InitialOverlap)SchemaChoice(SceneDocument(scene), "%s.initial_overlap", contact->path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses factors on the coefficient of friction below 0. */
static PetscErrorCode SceneCheckFactors(Scene scene, const SceneContact *contact, const char *key,
                                        const History *factors)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < factors->n; i++)
    if (factors->v[i] < 0)
      PetscCall(SceneRefuse(scene, contact->path, key, "has a factor below 0; allowed: 0 and above", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the friction of a pair. */
static PetscErrorCode SceneReadFriction(Scene scene, SceneContact *contact)
{
  Document *document = SceneDocument(scene);

  PetscFunctionBeginUser;
  if (!SceneHas(scene, contact->path, "friction")) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SceneReadValue(scene, contact->path, "friction.mu", &contact->mu, &contact->mu_expression));
  PetscCall(SceneReadFactors(scene, contact->path, "friction.history", &contact->mu_history));
  PetscCall(SceneReadFactors(scene, contact->path, "friction.over_pressure", &contact->mu_pressure));
  PetscCall(SceneCheckFactors(scene, contact, "friction.history", &contact->mu_history));
  PetscCall(SceneCheckFactors(scene, contact, "friction.over_pressure", &contact->mu_pressure));
  contact->cohesion = SchemaReal(document, "%s.friction.cohesion", contact->path);
  if (SceneHas(scene, contact->path, "friction.tau_max"))
    contact->tau_max = SchemaReal(document, "%s.friction.tau_max", contact->path);
  contact->friction = contact->mu > 0 || contact->mu_expression || contact->cohesion > 0;
  if (contact->mu_history.n && contact->mu_expression && ExpressionUses(contact->mu_expression, EXPRESSION_T))
    PetscCall(SceneRefuse(scene, contact->path, "friction.history",
                          "stands beside an expression with t, which is the value at t itself; allowed: one of them",
                          NULL));
  if (contact->penalty_may_stiffen && contact->friction) contact->penalty_scale = SCENE_FRICTION_SCALE;
  if (contact->mu < 0)
    PetscCall(SceneRefuse(scene, contact->path, "friction.mu", "is below 0; allowed: 0 and above", NULL));
  if (SchemaChoice(document, "%s.friction.stick.penalty", contact->path) != 0)
    contact->stick_penalty = SchemaReal(document, "%s.friction.stick.penalty", contact->path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads name, slave and master of a pair. alone: it is the only one of its entry. */
static PetscErrorCode SceneReadSides(Scene scene, const SurfacePair *pair, int alone, SceneContact *contact)
{
  PetscFunctionBeginUser;
  contact->listed = pair->listed;
  contact->share  = pair->share;
  if (contact->listed) {
    PetscCall(
      SceneNameSurfacePair(pair, alone, SchemaText(SceneDocument(scene), "%s.name", contact->path), &contact->name));
    PetscCall(PetscStrallocpy(pair->slave.group, &contact->slave));
    PetscCall(PetscStrallocpy(pair->master.group, &contact->master));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SceneReadText(scene, contact->path, "name", &contact->name));
  PetscCall(SceneReadText(scene, contact->path, "slave", &contact->slave));
  PetscCall(SceneReadText(scene, contact->path, "master", &contact->master));
  if (!contact->master) PetscCall(SceneReadAnalytic(scene, contact));
  PetscCall(SceneRefuseRigid(scene, contact->path, "slave", contact->slave));
  if (contact->master && !strcmp(contact->slave, contact->master))
    PetscCall(SceneRefuse(scene, contact->path, "master",
                          "is the slave too; allowed: another surface (surfaces: [...] has a surface meet itself)",
                          contact->master));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadContact(Scene scene, SceneContact *contact)
{
  Node symmetry = SceneNode(scene, contact->path, "symmetry");

  PetscFunctionBeginUser;
  contact->master_normal = (MasterNormal)SchemaChoice(SceneDocument(scene), "%s.master_normal", contact->path);
  contact->law           = (ContactLawKind)SchemaChoice(SceneDocument(scene), "%s.law", contact->path);
  contact->smoother      = SchemaChoice(SceneDocument(scene), "%s.smoother", contact->path);
  contact->formulation   = (ContactFormulation)SchemaChoice(SceneDocument(scene), "%s.formulation", contact->path);
  if (contact->formulation == CONTACT_FORMULATION_AUTO)
    contact->formulation =
      contact->master && strcmp(contact->slave, contact->master) ? CONTACT_SURFACE_TO_SURFACE : CONTACT_NODE_TO_SURFACE;
  contact->live_offset = SchemaChoice(SceneDocument(scene), "%s.offset", contact->path);
  contact->degree      = SchemaChoice(SceneDocument(scene), "%s.degree", contact->path) == 0 ? 4 : 2;
  contact->support =
    SceneHas(scene, contact->path, "support") ? SchemaReal(SceneDocument(scene), "%s.support", contact->path) : 0;
  contact->weight =
    SceneHas(scene, contact->path, "weight") ? SchemaReal(SceneDocument(scene), "%s.weight", contact->path) : 0;
  contact->global_frame        = SchemaChoice(SceneDocument(scene), "%s.frame", contact->path);
  contact->diffuse_derivatives = SchemaChoice(SceneDocument(scene), "%s.derivatives", contact->path);
  PetscCall(SceneReadOverlap(scene, contact));
  contact->stabilise     = (Stabilise)SchemaChoice(SceneDocument(scene), "%s.stabilise", contact->path);
  contact->feature_angle = SchemaReal(SceneDocument(scene), "%s.feature_angle", contact->path);
  PetscCall(SceneReadPenalty(scene, contact));
  PetscCall(SceneReadFriction(scene, contact));
  contact->find_symmetry = !symmetry;
  contact->n_symmetry    = symmetry ? symmetry->n : 0;
  PetscCall(PetscCalloc1(contact->n_symmetry, &contact->symmetry));
  for (int i = 0; i < contact->n_symmetry; i++)
    PetscCall(PetscStrallocpy(symmetry->child[i]->text, &contact->symmetry[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the contact pairs as they are listed. */
static PetscErrorCode SceneReadPairsOfContact(Scene scene, int n, const SurfacePair *pairs)
{
  PetscFunctionBeginUser;
  scene->n_contacts = n;
  PetscCall(PetscCalloc1(scene->n_contacts, &scene->contacts));
  for (int i = 0; i < scene->n_contacts; i++) {
    const int alone = (i == 0 || pairs[i - 1].entry != pairs[i].entry) &&
                      (i == scene->n_contacts - 1 || pairs[i + 1].entry != pairs[i].entry);

    PetscCall(ScenePath(&scene->contacts[i].path, "contact", pairs[i].entry));
    PetscCall(SceneReadSides(scene, &pairs[i], alone, &scene->contacts[i]));
    PetscCall(SceneReadContact(scene, &scene->contacts[i]));
    for (int j = 0; j < i; j++) {
      if (!strcmp(scene->contacts[i].name, scene->contacts[j].name))
        PetscCall(SceneRefuse(scene, scene->contacts[i].path, "name",
                              "names another pair already; allowed: names used once", scene->contacts[i].name));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadContacts(Scene scene)
{
  SurfacePair   *pairs = NULL;
  int            n     = 0;
  PetscErrorCode refused;

  PetscFunctionBeginUser;
  refused = SceneListSurfacePairs(scene, &n, &pairs);
  if (!refused) refused = SceneReadPairsOfContact(scene, n, pairs);
  PetscCall(PetscFree(pairs));
  PetscCall(refused);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadStepping(Scene scene)
{
  Document *document = SceneDocument(scene);
  PetscBool flows    = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (SchemaHas(document, "stepping.N_c") && SchemaHas(document, "stepping.N_c_fraction"))
    PetscCall(SceneRefuse(scene, "stepping", "N_c_fraction", "stands beside N_c; allowed: one of them", NULL));
  scene->stepping.control = (StepControlKind)SchemaChoice(document, "stepping.control");
  if (SchemaHas(document, "stepping.N_c")) scene->stepping.N_c = SchemaInteger(document, "stepping.N_c");
  if (SchemaHas(document, "stepping.N_c_fraction"))
    scene->stepping.N_c_fraction = SchemaReal(document, "stepping.N_c_fraction");
  if (scene->stepping.control == STEP_CONTACT && !scene->stepping.N_c && !(scene->stepping.N_c_fraction > 0))
    PetscCall(SceneRefuse(scene, "stepping", "control",
                          "contact needs N_c (nodes) or N_c_fraction (of the slave area); allowed: one of them", NULL));
  scene->stepping.predict_linearly = SchemaChoice(document, "stepping.prediction");
  scene->stepping.initial          = SchemaReal(document, "stepping.initial");
  scene->stepping.dt_min           = SchemaReal(document, "stepping.dt_min");
  scene->stepping.dt_max           = SchemaReal(document, "stepping.dt_max");
  scene->stepping.growth           = SchemaReal(document, "stepping.growth");
  if (SchemaHas(document, "stepping.plastic_strain"))
    scene->stepping.plastic_strain = SchemaReal(document, "stepping.plastic_strain");
  for (int b = 0; b < scene->n_bodies; b++)
    flows = (PetscBool)(flows || (!scene->bodies[b].rigid && scene->bodies[b].material.law == MATERIAL_VON_MISES));
  if (scene->stepping.plastic_strain > 0 && !flows)
    PetscCall(SceneRefuse(scene, "stepping", "plastic_strain",
                          "bounds plastic strains, which no body has; allowed: with law: von_mises", NULL));
  if (scene->stepping.dt_min > scene->stepping.dt_max)
    PetscCall(SceneRefuse(scene, "stepping", "dt_min", "is above dt_max; allowed: dt_min <= initial <= dt_max", NULL));
  if (SchemaHas(document, "stepping.initial") &&
      (scene->stepping.initial < scene->stepping.dt_min || scene->stepping.initial > scene->stepping.dt_max))
    PetscCall(SceneRefuse(scene, "stepping", "initial",
                          "is not between dt_min and dt_max; allowed: dt_min <= initial <= dt_max", NULL));
  scene->stepping.initial = PetscMin(PetscMax(scene->stepping.initial, scene->stepping.dt_min), scene->stepping.dt_max);
  scene->stepping.n_at    = SchemaCount(document, "stepping.at");
  PetscCall(PetscCalloc1(scene->stepping.n_at, &scene->stepping.at));
  (void)SceneReals(scene, "stepping", "at", scene->stepping.at);
  scene->solver.type           = (SolverType)SchemaChoice(document, "solver.type");
  scene->solver.tolerance      = SchemaReal(document, "solver.tolerance");
  scene->solver.max_iterations = SchemaInteger(document, "solver.max_iterations");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadOutput(Scene scene)
{
  const char *const names[] = {"displacement", "stress", "contact"};
  int *const        flags[] = {&scene->output.displacement, &scene->output.stress, &scene->output.contact};
  Node              fields  = NodeFind(SceneDocument(scene)->root, "output.fields");

  PetscFunctionBeginUser;
  scene->output.every            = SchemaInteger(SceneDocument(scene), "output.every");
  scene->output.checkpoint       = SchemaInteger(SceneDocument(scene), "output.checkpoint");
  scene->output.certificate      = SchemaBoolean(SceneDocument(scene), "output.certificate");
  scene->certificate.penetration = SchemaReal(SceneDocument(scene), "certificate.penetration");
  for (int k = 0; k < 3; k++) {
    *flags[k] = !fields;
    for (int i = 0; fields && i < fields->n; i++) *flags[k] |= !strcmp(fields->child[i]->text, names[k]);
  }
  PetscCall(SceneReadPairs(scene, "petsc", &scene->n_petsc, &scene->petsc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whole scenes */

/* Sets the names of the file, of its directory and of the scene. */
static PetscErrorCode SceneReadNames(Scene scene, const char *file)
{
  const char *slash = strrchr(file, '/'), *stem = slash ? slash + 1 : file;
  char       *dot;

  PetscFunctionBeginUser;
  PetscCall(PetscStrallocpy(file, &scene->file));
  PetscCall(PetscStrallocpy(slash ? file : ".", &scene->directory));
  if (slash) scene->directory[PetscMax(1, slash - file)] = 0;
  PetscCall(PetscStrallocpy(SchemaHas(SceneDocument(scene), "name") ? SchemaText(SceneDocument(scene), "name") : stem,
                            &scene->name));
  dot = strrchr(scene->name, '.');
  if (!SchemaHas(SceneDocument(scene), "name") && dot && dot > scene->name) *dot = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads all parts of the document, in the order in which mistakes are refused. */
static PetscErrorCode SceneReadAll(Scene scene, const char *file)
{
  Document *document = SceneDocument(scene);

  PetscFunctionBeginUser;
  PetscCall(SchemaCheck(document));
  PetscCall(SceneReadNames(scene, file));
  PetscCall(DocumentText(document, &scene->text));
  scene->geometry   = (Geometry)SchemaChoice(document, "geometry");
  scene->kinematics = (Kinematics)SchemaChoice(document, "kinematics");
  scene->dim        = document->dim;
  PetscCall(SceneReadMesh(scene));
  PetscCall(SceneReadBodies(scene));
  PetscCall(SceneReadSupports(scene));
  PetscCall(SceneReadLoads(scene));
  PetscCall(SceneReadContacts(scene));
  PetscCall(SceneReadStepping(scene));
  PetscCall(SceneReadProbes(scene));
  PetscCall(SceneReadOutput(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the scene of a document. The scene owns the document from then on. A refusal frees both. */
static PetscErrorCode SceneCreate(Document *document, const char *file, Scene *scene)
{
  PetscErrorCode code;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(scene));
  (*scene)->document = document;
  code               = SceneReadAll(*scene, file);
  if (code) PetscCall(SceneDestroy(scene));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneRead - reads a scene file, edits and validates it, and makes the scene.

  Collective

  Input Parameters:
+ comm  - communicator of all ranks
. file  - path with which rank 0 can open the file
. n_set - number of edits
- set   - edits KEY=VALUE, in order; the last one of a key counts

  Output Parameter:
. scene - the scene, to be freed with SceneDestroy()

  Note:
  It refuses the first mistake. The keys are in schemakeys.c. After a refusal there is no scene, and all memory is free.
@*/
PetscErrorCode SceneRead(MPI_Comm comm, const char *file, int n_set, char *const *set, Scene *scene)
{
  Document *document;

  PetscFunctionBeginUser;
  *scene = NULL;
  PetscCall(DocumentRead(comm, file, n_set, set, &document));
  PetscCall(SceneCreate(document, file, scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The parts of a scene that a restart may change, because the state of the run does not depend on them. */
static const char *const changeable[] = {"certificate", "output", "solver", "stepping"};

/* Tells whether the first component of a path is one of these parts. One of the characters of `end` follows it. */
static PetscBool IsChangeable(const char *path, const char *end)
{
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(changeable); i++) {
    const size_t n = strlen(changeable[i]);

    if (!strncmp(path, changeable[i], n) && path[n] && strchr(end, path[n])) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Returns the next line of a text that belongs to the problem. The other lines are the parts that may change, each with
   its key and all values below the key. */
static const char *ProblemLine(const char *text)
{
  PetscBool skips = PETSC_FALSE;

  while (*text) {
    if (*text != ' ' && *text != '-') skips = IsChangeable(text, ":");
    if (!skips) return text;
    text += strcspn(text, "\n");
    text += *text == '\n';
  }
  return text;
}

/*@
  SceneSameProblem - tells whether two scenes differ only in what a restart may change.

  Not collective

  Input Parameters:
+ a - Scene.text of one scene
- b - Scene.text of the other scene

  Note:
  A restart may change output, solver and stepping, because the state of a run does not depend on them.
@*/
PetscBool SceneSameProblem(const char *a, const char *b)
{
  for (a = ProblemLine(a), b = ProblemLine(b); *a && *b; a = ProblemLine(a), b = ProblemLine(b)) {
    const size_t n = strcspn(a, "\n"), m = strcspn(b, "\n");

    if (n != m || strncmp(a, b, n)) return PETSC_FALSE;
    a += n + (a[n] == '\n');
    b += m + (b[m] == '\n');
  }
  return !*a && !*b ? PETSC_TRUE : PETSC_FALSE;
}

/* Refuses edits that make another problem of the text. Edits that change nothing are allowed, so that a command may be
   repeated with the edits with which it was first given. */
static PetscErrorCode CheckEdits(Document *document, const char *text, int n_set, char *const *set)
{
  char     *edited;
  PetscBool same;

  PetscFunctionBeginUser;
  PetscCall(DocumentText(document, &edited));
  same = SceneSameProblem(text, edited);
  PetscCall(PetscFree(edited));
  for (int i = 0; i < n_set && !same; i++) {
    if (!IsChangeable(set[i], ".="))
      PetscCall(RefuseInput(
        document->comm,
        "-set %s: a restart goes on with the scene as it is; allowed: keys of output, solver and stepping", set[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneReadAgain - reads the scene of a checkpoint from the text that the run has kept.

  Collective

  Input Parameters:
+ comm  - communicator of all ranks
. file  - name of the scene file when the run began
. where - name that replaces the file name in messages
. text  - Scene.text of the run
. n_set - number of edits
- set   - edits KEY=VALUE, in order

  Output Parameter:
. scene - the scene, to be freed with SceneDestroy()

  Note:
  It refuses edits that make another problem of the scene. Edits may change output, solver and stepping only. After a
  refusal there is no scene, and all memory is free.
@*/
PetscErrorCode SceneReadAgain(MPI_Comm comm, const char *file, const char *where, const char *text, int n_set,
                              char *const *set, Scene *scene)
{
  Document      *document;
  PetscErrorCode code;

  PetscFunctionBeginUser;
  *scene = NULL;
  PetscCall(DocumentReadText(comm, where, text, n_set, set, &document));
  code = CheckEdits(document, text, n_set, set);
  if (code) PetscCall(DocumentDestroy(document));
  PetscCall(code);
  PetscCall(SceneCreate(document, file, scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairsDestroy(int n, ScenePair **pairs)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < n; i++) {
    PetscCall(PetscFree((*pairs)[i].key));
    PetscCall(PetscFree((*pairs)[i].value));
  }
  PetscCall(PetscFree(*pairs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneDestroyBodies(Scene scene)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_bodies; i++) {
    SceneBody *body = &scene->bodies[i];

    PetscCall(MotionFree(&body->motion));
    UmatClose(&body->material.umat);
    PetscCall(PetscFree(body->path));
    PetscCall(PetscFree(body->name));
  }
  PetscCall(PetscFree(scene->bodies));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneDestroyContacts(Scene scene)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_contacts; i++) {
    SceneContact *contact = &scene->contacts[i];

    for (int k = 0; k < contact->n_symmetry; k++) PetscCall(PetscFree(contact->symmetry[k]));
    PetscCall(ExpressionDestroy(&contact->overlap_expression));
    PetscCall(ExpressionDestroy(&contact->mu_expression));
    PetscCall(PetscFree2(contact->mu_history.t, contact->mu_history.v));
    PetscCall(PetscFree2(contact->mu_pressure.t, contact->mu_pressure.v));
    PetscCall(PetscFree(contact->symmetry));
    PetscCall(PetscFree(contact->path));
    PetscCall(PetscFree(contact->name));
    PetscCall(PetscFree(contact->slave));
    PetscCall(PetscFree(contact->master));
    PetscCall(MotionFree(&contact->motion));
  }
  PetscCall(PetscFree(scene->contacts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneDestroy - frees a scene.

  Not collective

  Input Parameter:
. scene - the scene, which may be NULL; it is NULL afterwards
@*/
PetscErrorCode SceneDestroy(Scene *scene)
{
  Scene s = *scene;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SceneDestroyBodies(s));
  PetscCall(SceneDestroyContacts(s));
  for (int i = 0; i < s->n_supports; i++) {
    PetscCall(PetscFree(s->supports[i].path));
    PetscCall(PetscFree(s->supports[i].surface));
  }
  for (int i = 0; i < s->n_loads; i++) {
    for (int k = 0; k < 3; k++) PetscCall(ExpressionDestroy(&s->loads[i].expression[k]));
    PetscCall(PetscFree2(s->loads[i].history.t, s->loads[i].history.v));
    PetscCall(PetscFree(s->loads[i].path));
    PetscCall(PetscFree(s->loads[i].region));
    PetscCall(PetscFree(s->loads[i].from.surface));
    PetscCall(PetscFree(s->loads[i].to.surface));
  }
  for (int i = 0; i < s->n_probes; i++) {
    PetscCall(PetscFree(s->probes[i].path));
    PetscCall(PetscFree(s->probes[i].name));
    PetscCall(PetscFree(s->probes[i].target));
    PetscCall(PetscFree(s->probes[i].body));
  }
  PetscCall(PetscFree(s->supports));
  PetscCall(PetscFree(s->loads));
  PetscCall(PetscFree(s->probes));
  PetscCall(PetscFree(s->stepping.at));
  PetscCall(PairsDestroy(s->n_parameters, &s->parameters));
  PetscCall(PairsDestroy(s->n_petsc, &s->petsc));
  PetscCall(PetscFree(s->file));
  PetscCall(PetscFree(s->directory));
  PetscCall(PetscFree(s->text));
  PetscCall(PetscFree(s->name));
  PetscCall(PetscFree(s->mesh_file));
  PetscCall(DocumentDestroy(SceneDocument(s)));
  PetscCall(PetscFree(*scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneWhere - returns the place of a value for the start of a message, as "FILE:LINE: PATH.KEY".

  Not collective

  Input Parameters:
+ scene - the scene
. path  - path of a part of the scene ("contact.0"), or "" or NULL
- key   - key below the path, or "" or NULL

  Note:
  An example is "runs/a.yaml:12: contact.0.slave". The line is that of the value, or of its nearest ancestor that the
  document has. If that came from a -set, "-set KEY" replaces file and line. The text belongs to the scene and is valid
  until the next call.
@*/
const char *SceneWhere(Scene scene, const char *path, const char *key)
{
  char text[KEY_PATH_LENGTH];

  KeyPathJoin(text, path ? path : "", key ? key : "");
  if (!key || !*key) snprintf(text, sizeof text, "%s", path ? path : "");
  return DocumentWhere(SceneDocument(scene), text);
}

/*@
  SceneReference - prints the scene reference, which is every key with its type, range, unit, default and help.

  Not collective

  Input Parameter:
. file - the stream to print to

  Note:
  For one rank. The reference is made from the table of schemakeys.c.
@*/
PetscErrorCode SceneReference(FILE *file)
{
  PetscFunctionBeginUser;
  SchemaReference(file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool MotionBreaks(const Motion *motion, PetscReal t)
{
  for (int m = 0; m < motion->n; m++)
    if (HistoryBreaks(&motion->components[m].history, t)) return PETSC_TRUE;
  return HistoryBreaks(&motion->history, t) ? PETSC_TRUE : PETSC_FALSE;
}

/*@
  SceneIsPlastic - tells whether some body has a plastic law.

  Not collective

  Input Parameter:
. scene - the scene
@*/
PetscBool SceneIsPlastic(Scene scene)
{
  for (int b = 0; b < scene->n_bodies; b++)
    if (!scene->bodies[b].rigid && MaterialGetLaw(scene->bodies[b].material.law)->plastic) return PETSC_TRUE;
  return PETSC_FALSE;
}

/*@
  SceneHasRoutine - tells whether the law of some body is a routine of the user, which has no potential.

  Not collective, the same on all ranks

  Input Parameter:
. scene - the scene
@*/
PetscBool SceneHasRoutine(Scene scene)
{
  for (int b = 0; b < scene->n_bodies; b++)
    if (scene->bodies[b].material.umat) return PETSC_TRUE;
  return PETSC_FALSE;
}

/*@
  SceneBreaks - tells whether some load, imposed displacement or motion has a breakpoint at load parameter t.

  Not collective

  Input Parameters:
+ scene - the scene
- t     - load parameter

  Note:
  At a breakpoint the rate of the load may change. The solution before it therefore predicts nothing about the solution
  after it.
@*/
PetscBool SceneBreaks(Scene scene, PetscReal t)
{
  for (int l = 0; l < scene->n_loads; l++)
    if (HistoryBreaks(&scene->loads[l].history, t)) return PETSC_TRUE;
  for (int b = 0; b < scene->n_bodies; b++)
    if (MotionBreaks(&scene->bodies[b].motion, t)) return PETSC_TRUE;
  for (int c = 0; c < scene->n_contacts; c++)
    if (MotionBreaks(&scene->contacts[c].motion, t)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/*@
  SceneLoadVaries - tells whether a component of a load is an expression with t, to which no history applies.

  Not collective

  Input Parameters:
+ load      - the load
- component - 0 to 2; 0 for a pressure
@*/
PetscBool SceneLoadVaries(const SceneLoad *load, int component)
{
  return ExpressionUses(load->expression[component], EXPRESSION_T);
}

/*@
  SceneLoadValue - returns a component of a load at a place, without the factor of its history.

  Not collective

  Input Parameters:
+ load      - the load
. component - 0 to 2; 0 for a pressure
. X         - reference coordinates of the place (length); the third is 0 in the plane
- t         - load parameter

  Note:
  Where SceneLoadVaries(), this is the whole value at t. Otherwise it does not depend on t. It is not finite where an
  expression has no value.
@*/
PetscReal SceneLoadValue(const SceneLoad *load, int component, const PetscReal X[3], PetscReal t)
{
  return load->expression[component] ? ExpressionValue(load->expression[component], X, t) : load->value[component];
}
