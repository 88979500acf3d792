/* The reader of a scene: it fills the Scene from a validated document, see scene.h. */
#include "sceneload.h"
#include "scenemotion.h"
#include "sceneprobe.h"
#include "scenedefaults.h"
#include "scenematerial.h"
#include "sceneplasticity.h"
#include "sceneread.h"
#include "scenesurfaces.h"
#include "base/refusal.h"
#include <string.h>

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
      "needs a law whose volume part is separate; allowed with svk and hyperfoam: full | enhanced | fbar, with umat: "
      "full | fbar",
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
  if (!SceneHas(scene, contact->path, "friction.stick.slip")) PetscFunctionReturn(PETSC_SUCCESS);
  contact->stick_slip = SchemaReal(document, "%s.friction.stick.slip", contact->path);
  if (contact->stick_penalty > 0)
    PetscCall(SceneRefuse(scene, contact->path, "friction.stick.slip",
                          "stands beside a stick.penalty, which says how surfaces stick as well; allowed: one of them",
                          NULL));
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
    if (pair->master.group[0])
      PetscCall(PetscStrallocpy(pair->master.group, &contact->master));
    else
      PetscCall(SceneReadAnalytic(scene, contact));
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
  scene->stepping.damped           = SchemaChoice(document, "stepping.damping");
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

    PetscCall(SceneDestroyMotion(&body->motion));
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
    PetscCall(SceneDestroyMotion(&contact->motion));
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
