/* The reader of a scene: it fills the Scene from a validated document, see scene.h. */
#include "sceneaccuracy.h"
#include "scenesensitivity.h"
#include "scenecontact.h"
#include "sceneload.h"
#include "scenemesh.h"
#include "scenemotion.h"
#include "sceneprobe.h"
#include "scenematerial.h"
#include "sceneplasticity.h"
#include "sceneread.h"
#include "scenesteps.h"
#include "scenetable.h"
#include "base/refusal.h"
#include <string.h>

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
  if (scene->plane_stress && plastic)
    PetscCall(SceneRefuse(scene, body->path, "material.law",
                          "has a state at its points, which has no plane stress; allowed with geometry: plane_stress: "
                          "laws without plasticity and routines",
                          NULL));
  if (scene->plane_stress && !body->chosen && choice != FORMULATION_FULL && choice != FORMULATION_ENHANCED)
    PetscCall(SceneRefuse(scene, body->path, "formulation",
                          "has no plane stress, in which no element locks by its volume; allowed with geometry: "
                          "plane_stress: full | enhanced | auto",
                          Formulations[choice]));
  if (body->chosen && scene->plane_stress)
    body->formulation = FORMULATION_FULL;
  else if (body->chosen && plastic)
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
  if (body->rigid && SceneHas(scene, body->path, "pretension"))
    PetscCall(
      SceneRefuse(scene, body->path, "pretension", "tightens a body that can stretch; allowed: with a volume", NULL));
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
  PetscCall(SceneCheckRoutine(scene, body));
  PetscCall(SceneReadFormulation(scene, body));
  PetscCall(SceneCheckIncompressible(scene, body));
  PetscCall(SceneReadPretension(scene, body));
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

/* Reads what bounds the steps of bodies that yield and of contact with friction. */
static PetscErrorCode SceneReadBounds(Scene scene)
{
  Document       *document = SceneDocument(scene);
  const PetscBool free     = (PetscBool)(scene->stepping.control != STEP_FIXED);
  const PetscBool rubs     = SceneHasFriction(scene);
  PetscBool       flows    = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (int b = 0; b < scene->n_bodies; b++)
    flows = (PetscBool)(flows || (!scene->bodies[b].rigid && scene->bodies[b].material.law == MATERIAL_VON_MISES));
  if (flows && (SchemaHas(document, "stepping.plastic_lag") || free))
    scene->stepping.plastic_lag = SchemaReal(document, "stepping.plastic_lag");
  if (rubs && (SchemaHas(document, "stepping.contact_travel") || free))
    scene->stepping.contact_travel = SchemaReal(document, "stepping.contact_travel");
  if (scene->stepping.plastic_strain > 0 && !flows)
    PetscCall(SceneRefuse(scene, "stepping", "plastic_strain",
                          "bounds plastic strains, which no body has; allowed: with law: von_mises", NULL));
  if (SchemaHas(document, "stepping.plastic_lag") && !flows)
    PetscCall(SceneRefuse(scene, "stepping", "plastic_lag",
                          "bounds plastic flow, which no body has; allowed: with law: von_mises", NULL));
  if (SchemaHas(document, "stepping.contact_travel") && !rubs)
    PetscCall(SceneRefuse(scene, "stepping", "contact_travel",
                          "bounds contact with friction, which no pair has; allowed: with friction", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadStepping(Scene scene)
{
  Document *document = SceneDocument(scene);

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
  scene->stepping.damping          = (StepDamping)SchemaChoice(document, "stepping.damping");
  scene->stepping.initial          = SchemaReal(document, "stepping.initial");
  scene->stepping.dt_min           = SchemaReal(document, "stepping.dt_min");
  scene->stepping.dt_max           = SchemaReal(document, "stepping.dt_max");
  scene->stepping.growth           = SchemaReal(document, "stepping.growth");
  if (SchemaHas(document, "stepping.plastic_strain"))
    scene->stepping.plastic_strain = SchemaReal(document, "stepping.plastic_strain");
  PetscCall(SceneReadBounds(scene));
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
  scene->solver.hold_rolling   = SchemaBoolean(document, "solver.hold_rolling");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadOutput(Scene scene)
{
  /* The first three are written without the key */
  const char *const names[] = {"displacement", "stress", "contact", "principal", "strain"};
  int *const        flags[] = {&scene->output.displacement, &scene->output.stress, &scene->output.contact,
                               &scene->output.principal, &scene->output.strain};
  Node              fields  = NodeFind(SceneDocument(scene)->root, "output.fields");

  PetscFunctionBeginUser;
  scene->output.every            = SchemaInteger(SceneDocument(scene), "output.every");
  scene->output.checkpoint       = SchemaInteger(SceneDocument(scene), "output.checkpoint");
  scene->output.error            = SchemaChoice(SceneDocument(scene), "output.error");
  scene->output.certificate      = SchemaBoolean(SceneDocument(scene), "output.certificate");
  scene->certificate.penetration = SchemaReal(SceneDocument(scene), "certificate.penetration");
  for (int k = 0; k < (int)PETSC_STATIC_ARRAY_LENGTH(names); k++) {
    *flags[k] = !fields && k < 3;
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

/* Reads the thickness of a scene in the plane. The solution does not depend on it, as all forces are per thickness. */
static PetscErrorCode SceneReadThickness(Scene scene)
{
  PetscFunctionBeginUser;
  scene->thickness     = SchemaReal(SceneDocument(scene), "thickness");
  scene->per_thickness = scene->geometry == GEOMETRY_PLANE_STRAIN && !SchemaHas(SceneDocument(scene), "thickness");
  if (SchemaHas(SceneDocument(scene), "thickness") && scene->geometry != GEOMETRY_PLANE_STRAIN)
    PetscCall(SceneRefuse(scene, "", "thickness",
                          "has no meaning here; allowed: with geometry: plane_strain or "
                          "plane_stress",
                          NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Place of plane_stress among the words of the key geometry, behind those of Geometry */
enum { SCENE_PLANE_STRESS = GEOMETRY_AXISYMMETRIC + 1 };

/* Reads all parts of the document, in the order in which mistakes are refused. */
static PetscErrorCode SceneReadAll(Scene scene, const char *file)
{
  Document *document = SceneDocument(scene);

  PetscFunctionBeginUser;
  PetscCall(SceneReadTables(document, file));
  PetscCall(SchemaCheck(document));
  PetscCall(SceneReadNames(scene, file));
  PetscCall(SceneReadSteps(scene));
  PetscCall(DocumentText(document, &scene->text));
  scene->geometry     = (Geometry)SchemaChoice(document, "geometry");
  scene->plane_stress = (int)scene->geometry == SCENE_PLANE_STRESS;
  if (scene->plane_stress) scene->geometry = GEOMETRY_PLANE_STRAIN;
  scene->kinematics = (Kinematics)SchemaChoice(document, "kinematics");
  scene->dim        = document->dim;
  PetscCall(SceneReadThickness(scene));
  PetscCall(SceneReadText(scene, "units", "length", &scene->units.length));
  PetscCall(SceneReadText(scene, "units", "force", &scene->units.force));
  PetscCall(SceneReadText(scene, "units", "stress", &scene->units.stress));
  PetscCall(SceneReadMesh(scene));
  PetscCall(SceneReadBodies(scene));
  PetscCall(SceneReadSupports(scene));
  PetscCall(SceneReadLoads(scene));
  PetscCall(SceneReadContacts(scene));
  PetscCall(SceneReadStepping(scene));
  PetscCall(SceneReadProbes(scene));
  PetscCall(SceneReadOutput(scene));
  PetscCall(SceneReadAccuracy(scene));
  PetscCall(SceneReadSensitivities(scene));
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
static const char *const changeable[] = {"certificate", "output", "sensitivity", "solver", "stepping", "units"};

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
  PetscBool same, unchanged;

  PetscFunctionBeginUser;
  PetscCall(DocumentText(document, &edited));
  same      = SceneSameProblem(text, edited);
  unchanged = (PetscBool)!strcmp(text, edited);
  PetscCall(PetscFree(edited));
  for (int i = 0; i < n_set; i++) {
    if (!strncmp(set[i], "stepping.steps", strlen("stepping.steps")) && !unchanged)
      PetscCall(RefuseInput(document->comm,
                            "-set %s: histories of loads follow from steps with names; allowed in a restart: other "
                            "keys of stepping, keys of output and solver",
                            set[i]));
  }
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

/*@
  SceneReadChanged - reads a scene again with another value of one number.

  Collective

  Input Parameters:
+ scene - the scene
. comm  - communicator of all ranks
. key   - path of the number
- value - its other value

  Output Parameter:
. changed - the other scene, to be freed with SceneDestroy()

  Note:
  It refuses a value that the key may not have.
@*/
PetscErrorCode SceneReadChanged(Scene scene, MPI_Comm comm, const char *key, double value, Scene *changed)
{
  char      edit[KEY_PATH_LENGTH + 32], *set = edit;
  Document *document;

  PetscFunctionBeginUser;
  *changed = NULL;
  PetscCall(PetscSNPrintf(edit, sizeof(edit), "%s=%.17g", key, value));
  PetscCall(DocumentReadText(comm, scene->file, scene->text, 1, &set, &document));
  PetscCall(SceneCreate(document, scene->file, changed));
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
    PetscCall(PetscFree2(s->supports[i].history.t, s->supports[i].history.v));
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
  PetscCall(PetscFree(s->units.length));
  PetscCall(PetscFree(s->units.force));
  PetscCall(PetscFree(s->units.stress));
  PetscCall(PetscFree(s->stepping.at));
  PetscCall(SceneDestroySteps(s));
  PetscCall(SceneMeshDestroy(s));
  PetscCall(ScenePairsDestroy(s->n_petsc, &s->petsc));
  PetscCall(ScenePairsDestroy(s->accuracy.n_densities, &s->accuracy.densities));
  PetscCall(SceneDestroySensitivities(s));
  PetscCall(PetscFree(s->file));
  PetscCall(PetscFree(s->directory));
  PetscCall(PetscFree(s->text));
  PetscCall(PetscFree(s->name));
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
