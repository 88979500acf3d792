/* Contact pairs of a scene, see scenecontact.h. */
#include "scenecontact.h"
#include "scenedefaults.h"
#include "scenemotion.h"
#include "sceneread.h"
#include "scenesurfaces.h"
#include <string.h>

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
    PetscCall(SceneRefuse(scene, tool, "normal",
                          "is not along the axis: that is a cone or a cylinder, not a plane; allowed: [0, y]; a wall "
                          "around the axis is master: {cylinder: ...}, a cone a rigid body with its line in the mesh",
                          NULL));
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
  contact->stick_may_stiffen = contact->friction && contact->penalty_may_stiffen && !(contact->stick_penalty > 0);
  if (!SceneHas(scene, contact->path, "friction.stick.slip")) PetscFunctionReturn(PETSC_SUCCESS);
  contact->stick_may_stiffen = 0;
  contact->stick_slip        = SchemaReal(document, "%s.friction.stick.slip", contact->path);
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

/* Reads when the pair is there. Its penalty is then not chosen by the run, which would take its fading for softness. */
static PetscErrorCode SceneReadPresence(Scene scene, SceneContact *contact)
{
  PetscFunctionBeginUser;
  PetscCall(SceneReadFactors(scene, contact->path, "history", &contact->presence));
  if (!contact->presence.n) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; i < contact->presence.n; i++)
    if (contact->presence.v[i] < 0 || contact->presence.v[i] > 1)
      PetscCall(
        SceneRefuse(scene, contact->path, "history", "is a part of the pair; allowed: factors from 0 to 1", NULL));
  if (contact->adjust || contact->augment)
    PetscCall(
      SceneRefuse(scene, contact->path, contact->adjust ? "penalty.adjust" : "penalty.augment",
                  "follows the penetration, which grows while the pair comes and goes; allowed: a fixed penalty, "
                  "or a pair that is always there",
                  NULL));
  if (contact->penalty_may_stiffen) contact->penalty_scale = SCENE_PRESENCE_SCALE;
  contact->penalty_may_stiffen = contact->stick_may_stiffen = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads one pair's keys other than its name and sides.

   Surfaces of meshes are met on the slave's faces, and so is a surface that meets itself. Scenes of self contact, node
   to surface and then surface to surface (iterations; failed steps; force, and in brackets its limit of finer meshes
   where that is known):
   - tube flattened, quad4 of size 1 and 1/2: 37, 58; 0, 1; 12.66, 12.65 (12.55), and 71, 93; 1, 3; 12.54, 12.53; quad8
     with mixed elements: stops at t = 0.92, 39; 19, 0; -, 12.41
   - the same tube, flattened further, size 1/2: 370, 129; 5, 3; 98.3 with 5 % of error left, 103.5 with 0.3 %
   - quarter of a tube that meets its mirror image, 16, 32 and 64 faces: 59, 56; 2, 1; 30.22, 30.74, then 66, 64; 1, 1;
     30.49, 30.47, then 248, 186; 4, 4; 30.26, 30.24
   - bumper of three folds, quad4 of size 1, 1/2, 1/4: 28, 30; 0, 0, then 109, 46; 2, 2, then 167, 94; 4, 2; the forces
     0.4, 0.3, 0.2 % apart; quad8 of size 2: stops at t = 0.97, 29; 21, 0
   - ring that is crumpled in a channel: 183, 262; 3, 4; 21.49, 21.55; quad8: 273, 282; 4, 5; 20.10, 20.04
   - bellows with V-shaped folds whose sharp corners meet held rings, quad4 of size 1, 1/2, 1/4: 27, 21; 0,
   0; 9.59, 9.37, then 30, 27; 0, 0; 5.118, 5.113, then 29, 32; 0, 0; 4.144, 4.143 At sharp corners the nodes' gaps say
   too little of what lies between them. CPU time of small scenes is 0.7 to 3 times as long. Where a surface meets
   itself at no more than a few nodes there is no difference (comb of springs, C-shaped strip: 11, 11 and 3, 3
   iterations; the same force). */
static PetscErrorCode SceneReadContact(Scene scene, SceneContact *contact)
{
  Node symmetry = SceneNode(scene, contact->path, "symmetry");

  PetscFunctionBeginUser;
  contact->keep_roles         = SchemaChoice(SceneDocument(scene), "%s.roles", contact->path) == 1;
  contact->master_normal      = (MasterNormal)SchemaChoice(SceneDocument(scene), "%s.master_normal", contact->path);
  contact->law                = (ContactLawKind)SchemaChoice(SceneDocument(scene), "%s.law", contact->path);
  contact->smoother           = SchemaChoice(SceneDocument(scene), "%s.smoother", contact->path);
  contact->formulation        = (ContactFormulation)SchemaChoice(SceneDocument(scene), "%s.formulation", contact->path);
  contact->formulation_chosen = contact->formulation == CONTACT_FORMULATION_AUTO;
  if (contact->formulation_chosen)
    contact->formulation = contact->master ? CONTACT_SURFACE_TO_SURFACE : CONTACT_NODE_TO_SURFACE;
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
  PetscCall(SceneReadPresence(scene, contact));
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

PetscErrorCode SceneReadContacts(Scene scene)
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

/* Frees what a pair holds. */
PetscErrorCode SceneDestroyContact(SceneContact *contact)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < contact->n_symmetry; k++) PetscCall(PetscFree(contact->symmetry[k]));
  for (int k = 0; k < contact->n_apart; k++) {
    PetscCall(PetscFree(contact->apart[k].slave));
    PetscCall(PetscFree(contact->apart[k].master));
  }
  PetscCall(PetscFree(contact->apart));
  PetscCall(ExpressionDestroy(&contact->overlap_expression));
  PetscCall(ExpressionDestroy(&contact->mu_expression));
  PetscCall(PetscFree2(contact->presence.t, contact->presence.v));
  PetscCall(PetscFree2(contact->mu_history.t, contact->mu_history.v));
  PetscCall(PetscFree2(contact->mu_pressure.t, contact->mu_pressure.v));
  PetscCall(PetscFree(contact->symmetry));
  PetscCall(PetscFree(contact->path));
  PetscCall(PetscFree(contact->name));
  PetscCall(PetscFree(contact->slave));
  PetscCall(PetscFree(contact->master));
  PetscCall(SceneDestroyMotion(&contact->motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneDestroyContacts(Scene scene)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_contacts; i++) PetscCall(SceneDestroyContact(&scene->contacts[i]));
  PetscCall(PetscFree(scene->contacts));
  PetscFunctionReturn(PETSC_SUCCESS);
}
