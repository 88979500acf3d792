/* The reader of the probes of a scene, see sceneprobe.h. */
#include "sceneprobe.h"
#include "sceneread.h"
#include "scene/scenejoins.h"
#include "scene/stepcolumns.h"
#include <string.h>

static const char *const Axes[] = {"x", "y", "z"};

/* The key of each kind of probe, the keys that it needs and the keys that it may have, in the order of ProbeKind. Every
   probe may also have the keys of ProbeCommon. */
static const struct {
  const char *kind, *needs, *takes;
} ProbeForms[PROBE_KINDS] = {
  [PROBE_REACTION]           = {"reaction", "component", ""},
  [PROBE_CONTACT_FORCE]      = {"contact_force", "component", ""},
  [PROBE_DISPLACEMENT]       = {"displacement", "component", "body"},
  [PROBE_DISTANCE]           = {"distance", "", "body change"},
  [PROBE_GAP]                = {"gap", "at", ""},
  [PROBE_CONTACT_EDGE]       = {"contact_edge", "axis side", "at"},
  [PROBE_PRESSURE_MAX]       = {"pressure_max", "", "at"},
  [PROBE_PRESSURE_MEAN]      = {"pressure_mean", "", "at within"},
  [PROBE_PRESSURE_DEVIATION] = {"pressure_deviation", "", "measure excluding only"},
  [PROBE_CONTACT_AREA]       = {"contact_area", "", ""},
  [PROBE_REACTION_TORQUE]    = {"reaction_torque", "", "axis at"},
  [PROBE_CONTACT_TORQUE]     = {"contact_torque", "", "axis at"},
  [PROBE_FRICTION_FORCE]     = {"friction_force", "component", ""},
  [PROBE_FRICTION_TORQUE]    = {"friction_torque", "", "axis at"},
  [PROBE_SLIPPED_AREA]       = {"slipped_area", "", ""},
  [PROBE_ELASTIC_SLIP]       = {"elastic_slip", "", ""},
  [PROBE_TOOL_MOTION]        = {"tool_motion", "component", ""},
  [PROBE_TOOL_ROTATION]      = {"tool_rotation", "", "component"},
  [PROBE_BOLT_FORCE]         = {"bolt_force", "", ""},
  [PROBE_BOLT_SHORTENING]    = {"bolt_shortening", "", ""},
  [PROBE_FLUID_FRONT]        = {"fluid_front", "axis side", ""},
  [PROBE_FLUID_AREA]         = {"fluid_area", "", ""},
  [PROBE_SEAL_PRESSURE]      = {"seal_pressure", "", ""},
};
static const char ProbeCommon[] = "name absolute factor";

/* Tells whether a word is among words with blanks between them. */
static int ProbeHasWord(const char *words, const char *word)
{
  const size_t n = strlen(word);

  for (const char *w = words; *w; w += strcspn(w, " "), w += *w == ' ') {
    if (strcspn(w, " ") == n && !strncmp(w, word, n)) return 1;
  }
  return 0;
}

/* Finds the kind of a probe. Refuses a probe without exactly one kind, without a key that its kind needs, or with a key
   that its kind does not take. */
static PetscErrorCode SceneProbeKind(Scene scene, SceneProbe *probe)
{
  static const char *const Optional[] = {"component", "body",    "change",    "at",   "axis",
                                         "side",      "measure", "excluding", "only", "within"};
  Node                     node       = NodeFind(SceneDocument(scene)->root, probe->path);
  int                      kinds      = 0;
  char                     allowed[500];

  PetscFunctionBeginUser;
  for (int k = 0; k < PROBE_KINDS; k++) {
    if (!SceneHas(scene, probe->path, ProbeForms[k].kind)) continue;
    probe->kind = (ProbeKind)k;
    kinds++;
  }
  if (kinds != 1) {
    allowed[0] = 0;
    for (int k = 0; k < PROBE_KINDS; k++)
      snprintf(allowed + strlen(allowed), sizeof allowed - strlen(allowed), "%s%s", k ? ", " : "", ProbeForms[k].kind);
    PetscCall(
      SceneRefuse(scene, probe->path, "", allowed,
                  kinds ? "has more than one kind; allowed: exactly one of" : "has no kind; allowed: exactly one of"));
  }
  snprintf(allowed, sizeof allowed, "%s %s %s %s", ProbeForms[probe->kind].kind, ProbeForms[probe->kind].needs,
           ProbeForms[probe->kind].takes, ProbeCommon);
  for (size_t i = 0; i < sizeof Optional / sizeof Optional[0]; i++) {
    if (ProbeHasWord(ProbeForms[probe->kind].needs, Optional[i]) && !SceneHas(scene, probe->path, Optional[i]))
      PetscCall(SceneRefuse(scene, probe->path, Optional[i], ProbeForms[probe->kind].kind, "is missing; needed by"));
  }
  for (int i = 0; i < node->n; i++) {
    if (!ProbeHasWord(allowed, node->key[i]))
      PetscCall(SceneRefuse(scene, probe->path, node->key[i], allowed, "has no place in this kind of probe; allowed:"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a probe whose target is not the name of a contact pair. */
static PetscErrorCode SceneRefuseProbeTarget(Scene scene, SceneProbe *probe)
{
  char pairs[400] = "allowed: the name of a pair under contact:";

  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_contacts; i++) {
    if (!strcmp(scene->contacts[i].name, probe->target)) PetscFunctionReturn(PETSC_SUCCESS);
    snprintf(pairs + strlen(pairs), sizeof pairs - strlen(pairs), "%s %s", i ? "," : "", scene->contacts[i].name);
  }
  PetscCall(
    SceneRefuse(scene, probe->path, ProbeForms[probe->kind].kind, pairs, "there is no contact pair of this name;"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses the reaction of a tool that is the master of no pair. */
static PetscErrorCode SceneRefuseProbeReaction(Scene scene, SceneProbe *probe)
{
  PetscFunctionBeginUser;
  if (!SceneFindBody(scene, probe->target, 1)) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; i < scene->n_contacts; i++)
    if (SceneContactHasMaster(&scene->contacts[i], probe->target)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SceneRefuse(scene, probe->path, ProbeForms[probe->kind].kind,
                        "is a rigid tool that is the master of no contact pair; allowed: a surface of a deformable "
                        "body, or a tool that is a master",
                        probe->target));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a probe of a bolt whose target is none. */
static PetscErrorCode SceneRefuseProbeBolt(Scene scene, SceneProbe *probe)
{
  const SceneBody *body = SceneFindBody(scene, probe->target, 0);

  PetscFunctionBeginUser;
  if (!body || !body->bolt)
    PetscCall(SceneRefuse(scene, probe->path, ProbeForms[probe->kind].kind,
                          "is no bolt; allowed: the volume of a body with the key pretension", probe->target));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a probe of friction whose target is a pair without. */
static PetscErrorCode SceneRefuseProbeFriction(Scene scene, SceneProbe *probe)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_contacts; i++)
    if (!strcmp(scene->contacts[i].name, probe->target) && !scene->contacts[i].friction)
      PetscCall(SceneRefuse(scene, probe->path, ProbeForms[probe->kind].kind,
                            "has no friction; allowed: the name of a pair with the key friction", probe->target));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has a pair the name of a probe's target? */
static int ProbeHasPair(Scene scene, const SceneProbe *probe)
{
  int found = 0;

  for (int i = 0; i < scene->n_contacts; i++) found = found || !strcmp(scene->contacts[i].name, probe->target);
  return found;
}

static int ProbeIsTorque(ProbeKind kind)
{
  return kind == PROBE_REACTION_TORQUE || kind == PROBE_CONTACT_TORQUE || kind == PROBE_FRICTION_TORQUE;
}

/* Reads the axis of a torque: its direction, which in the plane can only be z, and a point of it. */
static PetscErrorCode SceneReadProbeTorque(Scene scene, SceneProbe *probe)
{
  const char *kind = ProbeForms[probe->kind].kind;
  const Node  at   = SceneNode(scene, probe->path, "at");

  PetscFunctionBeginUser;
  if (scene->geometry == GEOMETRY_AXISYMMETRIC)
    PetscCall(
      SceneRefuse(scene, probe->path, kind, "is 0 in an axisymmetric scene; allowed: in the other geometries", NULL));
  if (scene->dim == 3 && !SceneHas(scene, probe->path, "axis"))
    PetscCall(SceneRefuse(scene, probe->path, "axis", kind, "is missing; in space it is needed by"));
  if (scene->dim == 2) {
    if (SceneHas(scene, probe->path, "axis") && probe->axis != 2)
      PetscCall(SceneRefuse(scene, probe->path, "axis", "lies in the plane; allowed: z", NULL));
    probe->axis = 2;
  }
  if (!at) PetscFunctionReturn(PETSC_SUCCESS);
  if (at->kind != NODE_LIST)
    PetscCall(SceneRefuse(scene, probe->path, "at", "has the wrong type; allowed: a point of the axis", NULL));
  (void)SceneReals(scene, probe->path, "at", probe->point[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a probe of a tool whose target is a pair with a deformable master. */
static PetscErrorCode SceneRefuseProbeTool(Scene scene, SceneProbe *probe)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_contacts; i++) {
    const SceneContact *contact = &scene->contacts[i];

    if (!strcmp(contact->name, probe->target) && contact->master && !SceneFindBody(scene, contact->master, 1))
      PetscCall(SceneRefuse(scene, probe->path, ProbeForms[probe->kind].kind,
                            "has a deformable master; allowed: a pair whose master is a rigid tool", probe->target));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a probe ask something of a contact pair? */
static int ProbeOfPair(ProbeKind kind)
{
  return kind != PROBE_DISPLACEMENT && kind != PROBE_DISTANCE && kind < PROBE_FLUID_FRONT && kind != PROBE_BOLT_FORCE &&
         kind != PROBE_BOLT_SHORTENING && kind != PROBE_REACTION && kind != PROBE_REACTION_TORQUE;
}

/* Refuses a probe whose target is no pair, or not one of the kind that it needs. */
static PetscErrorCode SceneRefuseProbePair(Scene scene, SceneProbe *probe)
{
  PetscFunctionBeginUser;
  PetscCall(SceneRefuseProbeTarget(scene, probe));
  if (probe->kind >= PROBE_FRICTION_FORCE) PetscCall(SceneRefuseProbeFriction(scene, probe));
  if (probe->kind == PROBE_TOOL_MOTION || probe->kind == PROBE_TOOL_ROTATION)
    PetscCall(SceneRefuseProbeTool(scene, probe));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a probe whose target is not a surface on which a fluid acts. */
static PetscErrorCode SceneRefuseProbeFluid(Scene scene, SceneProbe *probe)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_loads; i++)
    if (scene->loads[i].open && !strcmp(scene->loads[i].region, probe->target)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SceneRefuse(scene, probe->path, ProbeForms[probe->kind].kind,
                        "has no fluid; allowed: the surface of a pressure with where: open", probe->target));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the patch over which a mean is taken. */
static PetscErrorCode SceneReadProbePatch(Scene scene, SceneProbe *probe)
{
  const Node at = SceneNode(scene, probe->path, "at");

  PetscFunctionBeginUser;
  if (!at && !SceneHas(scene, probe->path, "within")) PetscFunctionReturn(PETSC_SUCCESS);
  if (!at || !SceneHas(scene, probe->path, "within"))
    PetscCall(SceneRefuse(scene, probe->path, at ? "within" : "at",
                          "is missing; allowed: at and within together, the middle and the radius of a patch", NULL));
  if (at->kind != NODE_LIST)
    PetscCall(SceneRefuse(scene, probe->path, "at", "has the wrong type; allowed: the middle of the patch", NULL));
  (void)SceneReals(scene, probe->path, "at", probe->point[0]);
  probe->within = SchemaReal(SceneDocument(scene), "%s.within", probe->path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the key `at`. It is a point for a probe of the gap, and one reference coordinate for the other kinds. */
static PetscErrorCode SceneReadProbeAt(Scene scene, SceneProbe *probe)
{
  Node at = SceneNode(scene, probe->path, "at");

  PetscFunctionBeginUser;
  if (ProbeIsTorque(probe->kind)) {
    PetscCall(SceneReadProbeTorque(scene, probe));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (probe->kind == PROBE_PRESSURE_MEAN) {
    PetscCall(SceneReadProbePatch(scene, probe));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (probe->kind == PROBE_GAP) {
    if (at->kind != NODE_LIST)
      PetscCall(SceneRefuse(scene, probe->path, "at", "has the wrong type; allowed: the point of a slave node", NULL));
    (void)SceneReals(scene, probe->path, "at", probe->point[0]);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (!at && probe->kind == PROBE_CONTACT_EDGE && scene->dim == 3)
    PetscCall(
      SceneRefuse(scene, probe->path, "at", "is missing; needed by contact_edge in 3D, such as {z: 100}", NULL));
  if (!at) PetscFunctionReturn(PETSC_SUCCESS);
  if (at->kind != NODE_MAP || at->n != 1)
    PetscCall(
      SceneRefuse(scene, probe->path, "at", "is not one coordinate; allowed: one of {x: }, {y: }, {z: }", NULL));
  probe->has_at = 1;
  for (int k = 0; k < 3; k++) {
    if (!strcmp(at->key[0], Axes[k])) probe->at_axis = k;
  }
  (void)NodeReal(at->child[0], &probe->at_value);
  if (probe->kind == PROBE_CONTACT_EDGE && probe->at_axis == probe->axis)
    PetscCall(SceneRefuse(scene, probe->path, "at",
                          "fixes the axis along which the edge is sought; allowed: another coordinate", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a name that is not unique, because the name becomes a column of steps.csv and a key of the summary. */
static PetscErrorCode SceneCheckProbeName(Scene scene, const SceneProbe *probe)
{
  PetscFunctionBeginUser;
  for (int k = 0; k <= STEP_COLUMNS; k++) {
    const char *column = k < STEP_COLUMNS ? StepColumnNames[k] : STEP_COLUMN_DURING;

    if (!strcmp(probe->name, column))
      PetscCall(SceneRefuse(scene, probe->path, "name", "is a column of steps.csv already; allowed: another name",
                            probe->name));
  }
  for (const SceneProbe *other = scene->probes; other < probe; other++) {
    if (!strcmp(probe->name, other->name))
      PetscCall(
        SceneRefuse(scene, probe->path, "name", "names another probe already; allowed: names used once", probe->name));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells whether a probe's value is one per thickness of the plane. */
static int ProbePerThickness(ProbeKind kind)
{
  return kind == PROBE_REACTION || kind == PROBE_BOLT_FORCE || kind == PROBE_CONTACT_FORCE ||
         kind == PROBE_CONTACT_AREA || kind == PROBE_FRICTION_FORCE || kind == PROBE_SLIPPED_AREA ||
         ProbeIsTorque(kind);
}

static PetscErrorCode SceneReadProbe(Scene scene, SceneProbe *probe)
{
  Document   *document = SceneDocument(scene);
  const char *path     = probe->path;
  Node        points;

  PetscFunctionBeginUser;
  PetscCall(SceneReadText(scene, path, "name", &probe->name));
  PetscCall(SceneProbeKind(scene, probe));
  if (probe->kind == PROBE_DISPLACEMENT) {
    (void)SceneReals(scene, path, "displacement", probe->point[0]);
  } else if (probe->kind == PROBE_DISTANCE) {
    points = SceneNode(scene, path, "distance");
    for (int i = 0; i < 2; i++) {
      for (int k = 0; k < points->child[i]->n; k++) (void)NodeReal(points->child[i]->child[k], &probe->point[i][k]);
    }
  } else {
    PetscCall(SceneReadText(scene, path, ProbeForms[probe->kind].kind, &probe->target));
    if (probe->kind >= PROBE_FLUID_FRONT)
      PetscCall(SceneRefuseProbeFluid(scene, probe));
    else if (probe->kind == PROBE_BOLT_FORCE || probe->kind == PROBE_BOLT_SHORTENING)
      PetscCall(SceneRefuseProbeBolt(scene, probe));
    else if (probe->kind == PROBE_REACTION || probe->kind == PROBE_REACTION_TORQUE)
      PetscCall(SceneRefuseProbeReaction(scene, probe));
    else if (ProbeHasPair(scene, probe) || !SceneMayBeJoint(scene, probe->target))
      PetscCall(SceneRefuseProbePair(scene, probe));
  }
  probe->component = PetscMax(0, SchemaChoice(document, "%s.component", path));
  if (probe->kind == PROBE_TOOL_ROTATION) {
    if (scene->dim == 3 && !SceneHas(scene, path, "component"))
      PetscCall(
        SceneRefuse(scene, path, "component", "is missing; needed by tool_rotation in 3D; allowed: x | y | z", NULL));
    if (scene->dim == 2 && SceneHas(scene, path, "component"))
      PetscCall(
        SceneRefuse(scene, path, "component", "has no place here; in the plane a tool turns about z alone", NULL));
    if (scene->dim == 2) probe->component = 2;
  }
  probe->axis     = PetscMax(0, SchemaChoice(document, "%s.axis", path));
  probe->max_side = SchemaChoice(document, "%s.side", path) == 1;
  PetscCall(SceneReadProbeAt(scene, probe));
  PetscCall(SceneReadText(scene, path, "body", &probe->body));
  if (probe->body && !SceneFindBody(scene, probe->body, 0))
    PetscCall(SceneRefuse(scene, path, "body", "is no deformable body; allowed: a volume under bodies:", probe->body));
  probe->change      = SchemaBoolean(document, "%s.change", path);
  probe->rms         = SchemaChoice(document, "%s.measure", path) == 1;
  probe->edge_filter = SceneHas(scene, path, "excluding") ? 1 : SceneHas(scene, path, "only") ? 2 : 0;
  probe->edge_faces =
    probe->edge_filter ? SchemaReal(document, "%s.%s", path, probe->edge_filter == 1 ? "excluding" : "only") : 0;
  if (SceneHas(scene, path, "excluding") && SceneHas(scene, path, "only"))
    PetscCall(SceneRefuse(scene, path, "only", "stands beside excluding; allowed: one of them", NULL));
  probe->absolute = SchemaBoolean(document, "%s.absolute", path);
  probe->factor   = SchemaReal(document, "%s.factor", path);
  if (ProbePerThickness(probe->kind)) probe->factor *= scene->thickness;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneReadProbes - reads the probes of the document into the scene.

  Collective

  Input Parameter:
. scene - the scene, whose bodies and contact pairs have been read

  Note:
  It refuses the first mistake.
@*/
PetscErrorCode SceneReadProbes(Scene scene)
{
  PetscFunctionBeginUser;
  scene->n_probes = SchemaCount(SceneDocument(scene), "probes");
  PetscCall(PetscCalloc1(scene->n_probes, &scene->probes));
  for (int i = 0; i < scene->n_probes; i++) {
    PetscCall(ScenePath(&scene->probes[i].path, "probes", i));
    PetscCall(SceneReadProbe(scene, &scene->probes[i]));
    PetscCall(SceneCheckProbeName(scene, &scene->probes[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneCheckProbePairs - refuses probes of contact pairs that there are not.

  Collective

  Input Parameter:
. scene - the scene, after the mesh has shown which surfaces of lists are joined (scenejoins.h)

  Note:
  SceneRead() has refused other names already.
@*/
PetscErrorCode SceneCheckProbePairs(Scene scene)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_probes; i++)
    if (ProbeOfPair(scene->probes[i].kind)) PetscCall(SceneRefuseProbePair(scene, &scene->probes[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
