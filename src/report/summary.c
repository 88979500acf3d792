/* The run in one JSON file, see summary.h. */
#include "summary.h"
#include "advice.h"
#include "units.h"
#include "files/textfile.h"
#include "scene/commandline.h"
#include "scene/stepcolumns.h"
#include <cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Adds the parts of a text between separators, without the blanks around them. */
static void AddList(cJSON *json, const char *key, char *text, const char *separators)
{
  cJSON *list = cJSON_AddArrayToObject(json, key);
  char  *rest = NULL;

  for (char *part = strtok_r(text, separators, &rest); part; part = strtok_r(NULL, separators, &rest)) {
    part += strspn(part, " ");
    for (size_t n = strlen(part); n && part[n - 1] == ' '; n--) part[n - 1] = '\0';
    if (*part) cJSON_AddItemToArray(list, cJSON_CreateString(part));
  }
}

/* Adds a number, or null where there is no value. */
static void AddReal(cJSON *json, const char *key, PetscReal value)
{
  if (isfinite((double)value))
    cJSON_AddNumberToObject(json, key, (double)value);
  else
    cJSON_AddNullToObject(json, key);
}

/* Adds PETSc's options as they are now, the scene's own, those that nothing has asked for, and those that a restart has
   changed. */
static PetscErrorCode AddOptions(cJSON *json, Scene scene, const char *changed)
{
  cJSON   *options = cJSON_AddObjectToObject(json, "options"), *map, *unused;
  char    *all, **names, **values;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetAll(NULL, &all));
  cJSON_AddStringToObject(options, "petsc", all);
  PetscCall(PetscFree(all));
  map = cJSON_AddObjectToObject(options, "scene");
  for (int i = 0; i < scene->n_petsc; i++)
    cJSON_AddStringToObject(map, scene->petsc[i].key, scene->petsc[i].value ? scene->petsc[i].value : "");
  unused = cJSON_AddArrayToObject(options, "unused");
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n; i++) cJSON_AddItemToArray(unused, cJSON_CreateString(names[i]));
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscCall(PetscStrallocpy(changed, &all));
  AddList(options, "changed", all, "\n");
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds what the linear algebra ran with; null where it is not known. */
static void AddBlas(cJSON *json, const Blas *blas)
{
  cJSON *map = cJSON_AddObjectToObject(json, "blas");

  cJSON_AddStringToObject(map, "file", blas->file);
  if (blas->kernels)
    cJSON_AddStringToObject(map, "kernels", blas->kernels);
  else
    cJSON_AddNullToObject(map, "kernels");
}

static void AddRun(cJSON *json, const RunRecord *run)
{
  cJSON_AddStringToObject(json, "status", run->status);
  if (run->message)
    cJSON_AddStringToObject(json, "message", run->message);
  else
    cJSON_AddNullToObject(json, "message");
  cJSON_AddNumberToObject(json, "steps", (double)run->way->steps);
  cJSON_AddNumberToObject(json, "steps_failed", (double)run->way->steps_failed);
  cJSON_AddNumberToObject(json, "steps_repeated", (double)run->way->steps_repeated);
  cJSON_AddNumberToObject(json, "newton_iterations", (double)run->way->newton_iterations);
  cJSON_AddNumberToObject(json, "newton_accepted", (double)run->way->newton_accepted);
  cJSON_AddNumberToObject(json, "krylov_iterations", (double)run->way->krylov_iterations);
}

static void AddUsage(cJSON *json, const RunFigures *figures)
{
  cJSON *seconds;

  AddReal(json, "wall_s", figures->usage.wall_s);
  AddReal(json, "cpu_s", figures->usage.cpu_s);
  AddReal(json, "mesh_s", figures->run->mesh_s);
  AddReal(json, "peak_rss_mb", figures->usage.peak_rss_mb);
  seconds = cJSON_AddObjectToObject(json, "seconds");
  for (int k = 0; k < TIMING_KINDS; k++) AddReal(seconds, TimingNames[k], figures->usage.seconds[k]);
}

static void AddGuards(cJSON *json, const StepperReport *way)
{
  cJSON *map = cJSON_AddObjectToObject(json, "guards"), *cuts;

  cJSON_AddNumberToObject(map, "line_search_cuts", (double)LoadStepperCuts(way));
  cuts = cJSON_AddObjectToObject(map, "cut_causes");
  for (int cause = 0; cause < CUT_CAUSES; cause++)
    cJSON_AddNumberToObject(cuts, CutCauses[cause], (double)way->cuts[cause]);
  cJSON_AddNumberToObject(map, "line_search_turned", (double)way->turned);
  cJSON_AddNumberToObject(map, "lists_made_anew", (double)way->regathered);
  cJSON_AddNumberToObject(map, "penalty_solves", (double)way->adjusted);
  cJSON_AddNumberToObject(map, "fluid_solves", (double)way->wetted);
}

/* Adds what is known of contact sets that repeated themselves. */
static void AddCycles(cJSON *json, const StepperReport *way)
{
  cJSON *map = cJSON_AddObjectToObject(json, "cycles");

  cJSON_AddNumberToObject(map, "found", (double)way->cycles);
  cJSON_AddNumberToObject(map, "steps_cut", (double)way->cycles_cut);
  if (way->cycles)
    cJSON_AddStringToObject(map, "last", way->cycle);
  else
    cJSON_AddNullToObject(map, "last");
}

/* Adds what is known of jumps to another equilibrium. */
static void AddJumps(cJSON *json, const StepperReport *way)
{
  cJSON *map = cJSON_AddObjectToObject(json, "jumps");

  cJSON_AddNumberToObject(map, "found", (double)way->jumps);
  if (way->jumps)
    cJSON_AddStringToObject(map, "last", way->jump);
  else
    cJSON_AddNullToObject(map, "last");
}

/* Adds what is known of the stability of accepted states. */
static void AddStability(cJSON *json, const StepperReport *way)
{
  cJSON *map = cJSON_AddObjectToObject(json, "stability");

  cJSON_AddNumberToObject(map, "unstable_steps", (double)way->unstable_steps);
  cJSON_AddNumberToObject(map, "most_negative_eigenvalues", (double)way->most_negatives);
  cJSON_AddNumberToObject(map, "negative_eigenvalues", (double)way->negatives);
  AddReal(map, "energy_given", way->gives);
}

/* Adds what the viscous restraint of steps that failed without it has done. */
static void AddDamping(cJSON *json, const RunFigures *figures)
{
  const StepperReport *way = figures->run->way;
  cJSON               *map = cJSON_AddObjectToObject(json, "damping");

  cJSON_AddNumberToObject(map, "steps", (double)way->damped);
  AddReal(map, "energy_taken", way->damping * figures->scene->thickness);
  AddReal(map, "stored_energy", figures->stored * figures->scene->thickness);
}

/* Adds what was done for bodies that only contact holds, if there are any. */
static void AddSprings(cJSON *json, const RunFigures *figures)
{
  const StepperReport *way = figures->run->way;
  cJSON               *map;

  if (!figures->free_bodies) return;
  map = cJSON_AddObjectToObject(json, "stabilisation");
  cJSON_AddStringToObject(map, "moved", figures->moved);
  cJSON_AddStringToObject(map, "held_by_springs", figures->loose);
  AddReal(map, "force_share", way->share);
  AddReal(map, "held_force_share", way->tied);
  AddReal(map, "held_instability", way->unstable);
  cJSON_AddNumberToObject(map, "held_soft_steps", (double)way->held);
  AddReal(map, "held_soft_friction", way->friction);
  cJSON_AddNumberToObject(map, "held_soft_motions", (double)way->motions);
  cJSON_AddNumberToObject(map, "relaxed", (double)way->relaxed);
  AddReal(map, "energy_taken", way->taken * figures->scene->thickness);
  AddReal(map, "largest_energy_share", way->left);
}

/* Adds how the linear solves went. */
static void AddLinear(cJSON *json, const LinearCounts *counts)
{
  cJSON *map = cJSON_AddObjectToObject(json, "linear");

  cJSON_AddNumberToObject(map, "solves", (double)counts->solves);
  cJSON_AddNumberToObject(map, "refined", (double)counts->refined);
  cJSON_AddNumberToObject(map, "refinement_steps", (double)counts->steps);
  cJSON_AddNumberToObject(map, "inaccurate", (double)counts->inaccurate);
  AddReal(map, "largest_residual", counts->worst);
  if (!counts->kept.made) return;
  cJSON_AddNumberToObject(map, "factors", (double)counts->kept.made);
  cJSON_AddNumberToObject(map, "older_factors", (double)counts->kept.served);
  cJSON_AddNumberToObject(map, "older_factor_iterations", (double)counts->kept.iterations);
  cJSON_AddNumberToObject(map, "own_factor_iterations", (double)counts->kept.finishing);
}

/* Adds the last accepted state. */
static void AddState(cJSON *json, Scene scene, PetscBool has_contact, const StepRecord *last, const PetscReal *probes)
{
  const PetscBool touches = has_contact && last ? PETSC_TRUE : PETSC_FALSE;
  cJSON          *map;

  AddReal(json, "t", last ? last->t : 0.0);
  if (scene->stepping.n_steps)
    cJSON_AddStringToObject(json, STEP_COLUMN_DURING, SceneStepAt(scene, last ? last->t : 0.0));
  AddReal(json, "max_penetration", touches ? last->contact.max_penetration : NAN);
  AddReal(json, "max_penetration_over_h", touches ? last->contact.max_penetration_over_h : NAN);
  cJSON_AddNumberToObject(json, "contact_nodes", touches ? (double)last->contact.nodes : 0.0);
  map = cJSON_AddObjectToObject(json, "probes");
  for (int i = 0; i < scene->n_probes; i++) AddReal(map, scene->probes[i].name, last ? probes[i] : NAN);
}

/* Adds the units of the values, what forces are meant of, and the units of the probes. */
static void AddUnits(cJSON *json, Scene scene)
{
  cJSON *map = cJSON_AddObjectToObject(json, "units"), *probes;
  char   text[UNITS_TEXT];

  cJSON_AddStringToObject(map, "length", UnitsLength(scene));
  cJSON_AddStringToObject(map, "force", UnitsForce(scene));
  UnitsStress(scene, text);
  cJSON_AddStringToObject(map, "stress", text);
  cJSON_AddBoolToObject(map, "named", UnitsNamed(scene));
  UnitsForces(scene, text);
  cJSON_AddStringToObject(map, "forces", text);
  probes = cJSON_AddObjectToObject(map, "probes");
  for (int i = 0; i < scene->n_probes; i++) {
    UnitsProbe(scene, &scene->probes[i], text);
    cJSON_AddStringToObject(probes, scene->probes[i].name, text);
  }
}

/* Adds the estimated errors of the probes, if the scene asks for them. */
static void AddErrors(cJSON *json, const RunFigures *figures)
{
  cJSON *map = figures->errors ? cJSON_AddObjectToObject(json, "error") : NULL;

  if (map && !isnan((double)ProbeErrorsHistorySeconds(figures->errors)))
    AddReal(json, "error_history_cpu_s", ProbeErrorsHistorySeconds(figures->errors));
  for (int i = 0; map && i < figures->scene->n_probes; i++) {
    cJSON               *probe = cJSON_AddObjectToObject(map, figures->scene->probes[i].name), *parts;
    const char          *why;
    PetscReal            value;
    const QuantityError *error = ProbeErrorsGet(figures->errors, i, &value, &why);

    if (why) cJSON_AddStringToObject(probe, "not_estimated", why);
    if (why) continue;
    AddReal(probe, "value", value);
    AddReal(probe, "sum", error->sum);
    AddReal(probe, "magnitude", error->magnitude);
    AddReal(probe, "uncertain", error->uncertain);
    cJSON_AddBoolToObject(probe, "cancels", QuantityErrorCancels(error));
    AddReal(probe, "spread", error->spread);
    AddReal(probe, "per_cent", value != 0 ? 100 * error->sum / PetscAbsReal(value) : NAN);
    parts = cJSON_AddObjectToObject(probe, "causes");
    for (int c = 0; c < ERROR_CAUSES; c++)
      if (isnan((double)error->part[c]))
        cJSON_AddStringToObject(parts, ErrorCauses[c], "not included");
      else
        AddReal(parts, ErrorCauses[c], error->part[c]);
  }
}

/* Adds what the ends of the zones of contact may leave of error, which is in no estimate. */
static void AddZones(cJSON *json, const RunFigures *figures)
{
  cJSON *map = figures->errors && figures->n_pairs ? cJSON_AddObjectToObject(json, "error_zones") : NULL;

  for (int p = 0; map && p < figures->n_pairs; p++) {
    const ContactZone *zone = ProbeErrorsZone(figures->errors, p);
    cJSON             *pair = cJSON_AddObjectToObject(map, figures->pairs[p].name);

    AddReal(pair, "faces", zone->layers);
    AddReal(pair, "per_cent", 100 * ContactZoneLeft(zone));
  }
}

/* Adds the energies of a run whose steps are judged, and more of them where bodies yield. */
static void AddEnergy(cJSON *json, const RunFigures *figures)
{
  const EnergyFigures energy  = figures->last ? figures->last->energy : (EnergyFigures){0};
  const PetscBool     plastic = SceneIsPlastic(figures->scene);
  cJSON              *map;

  if (!plastic && !figures->certified) return;
  map = cJSON_AddObjectToObject(json, "energy");
  AddReal(map, "elastic", energy.elastic);
  AddReal(map, "plastic", energy.plastic);
  AddReal(map, "contact", energy.outer.stored);
  AddReal(map, "friction", energy.outer.friction);
  AddReal(map, "damping", energy.damping);
  AddReal(map, "held", energy.outer.held);
  AddReal(map, "external", energy.outer.work);
  if (!plastic) return;
  AddReal(map, "work", energy.work);
  AddReal(map, "apart", energy.plastic > 0 ? EnergyApart(&energy) / (energy.plastic + energy.outer.friction) : NAN);
  AddReal(map, "lag", energy.plastic > 0 ? energy.lag / energy.plastic : NAN);
  AddReal(json, "max_plastic_strain", energy.strain);
  AddReal(json, "max_plastic_growth", energy.growth);
}

static void AddAdviceLine(const char *line, void *list)
{
  cJSON_AddItemToArray(list, cJSON_CreateString(line));
}

/* Adds the lines of advice as the last screen prints them. */
static void AddAdvice(cJSON *json, const RunFigures *figures)
{
  AdviceGive(figures, AddAdviceLine, cJSON_AddArrayToObject(json, "advice"));
}

static void AddPartition(cJSON *json, const Mesh mesh)
{
  cJSON *map = cJSON_AddObjectToObject(json, "partition");

  cJSON_AddStringToObject(map, "tool", mesh->partition.tool);
  cJSON_AddNumberToObject(map, "edge_cut", (double)mesh->partition.edge_cut);
  AddReal(map, "imbalance_cells", mesh->partition.imbalance_cells);
  AddReal(map, "imbalance_contact", mesh->partition.imbalance_contact);
}

/* Adds how deep the master's nodes stand in the slave; null where the master is analytic. */
static void AddMasterDepth(cJSON *pair, const PairFigures *figure)
{
  const NodeDepth *master = &figure->master;
  const PetscBool  meshed = figure->scene->master ? PETSC_TRUE : PETSC_FALSE;

  AddReal(pair, "master_depth", meshed ? master->depth : NAN);
  AddReal(pair, "master_depth_over_h", meshed ? master->over_h : NAN);
  AddReal(pair, "master_depth_largest", meshed ? figure->master_deepest : NAN);
  AddReal(pair, "master_depth_node", meshed && master->tag >= 0 ? (PetscReal)master->tag : NAN);
  cJSON_AddNumberToObject(pair, "master_depth_nodes", (double)master->nodes);
}

/* Adds what friction does in a pair that has some. */
static void AddFriction(cJSON *pair, const PairFigures *figure)
{
  const ContactFriction *friction = &figure->friction;
  cJSON                 *map      = cJSON_AddObjectToObject(pair, "friction");

  cJSON_AddItemToObject(map, "force", cJSON_CreateDoubleArray(friction->force, 3));
  cJSON_AddNumberToObject(map, "sticking", (double)friction->sticking);
  cJSON_AddNumberToObject(map, "slipping", (double)friction->slipping);
  cJSON_AddNumberToObject(map, "without_foot", (double)friction->footless);
  AddReal(map, "sticking_area", friction->sticking_area);
  AddReal(map, "slipping_area", friction->slipped_area);
  AddReal(map, "elastic_slip", friction->elastic);
  AddReal(map, "error_force", figure->penalty_error.slip_force);
  AddReal(map, "error_displacement", figure->penalty_error.slip_displacement);
  AddReal(map, "stiffened", figure->stick_stiffened);
  AddReal(map, "slip", friction->slid);
  AddReal(map, "dissipated", friction->dissipated);
  AddReal(map, "dissipated_turning", friction->turned);
  AddReal(map, "travel", friction->travel);
}

static void AddContact(cJSON *json, const RunFigures *figures)
{
  cJSON *list = cJSON_AddArrayToObject(json, "contact");

  for (int p = 0; p < figures->n_pairs; p++) {
    const PairFigures   *figure = &figures->pairs[p];
    const ContactWindow *window = &figure->window;
    cJSON               *pair   = cJSON_CreateObject(), *penalty;

    cJSON_AddItemToArray(list, pair);
    cJSON_AddStringToObject(pair, "name", figure->name);
    cJSON_AddNumberToObject(pair, "nodes", (double)figure->quality.nodes);
    AddReal(pair, "max_penetration", figure->quality.max_penetration);
    AddReal(pair, "max_penetration_over_h", figure->quality.max_penetration_over_h);
    AddMasterDepth(pair, figure);
    AddReal(pair, "pressure_scatter", figure->scatter);
    AddReal(pair, "facet_error", figure->fits.points ? figure->fits.facet_error : figure->quality.sagitta);
    AddReal(pair, "smoothing_error", figure->fits.points ? figure->fits.smoothing_error : NAN);
    cJSON_AddNumberToObject(pair, "fall_backs", (double)(figure->fits.points - figure->fits.plain));
    penalty = cJSON_AddObjectToObject(pair, "penalty");
    AddReal(penalty, "min", figure->penalty_min);
    AddReal(penalty, "max", figure->penalty_max);
    AddReal(penalty, "error_force", figure->penalty_error.force);
    AddReal(penalty, "error_pressure", figure->penalty_error.pressure);
    AddReal(penalty, "error_peak", figure->penalty_error.peak);
    AddReal(penalty, "error_displacement", figure->penalty_error.displacement);
    AddReal(penalty, "stiffened", figure->stiffened);
    cJSON_AddNumberToObject(penalty, "raised", (double)window->raised);
    cJSON_AddNumberToObject(penalty, "lowered", (double)window->lowered);
    cJSON_AddNumberToObject(penalty, "clamped", (double)window->clamped);
    cJSON_AddNumberToObject(penalty, "light", (double)window->light);
    cJSON_AddNumberToObject(penalty, "augmented", (double)window->augmented);
    cJSON_AddNumberToObject(penalty, "missed", (double)window->missed);
    cJSON_AddNumberToObject(penalty, "outside_window", (double)window->outside);
    cJSON_AddNumberToObject(penalty, "largest_excess", (double)window->excess);
    if (figure->scene->friction) AddFriction(pair, figure);
  }
}

/* An energy over all that bodies and contact store and have dissipated; NaN where that is nothing. */
static PetscReal EnergyPart(const RunFigures *figures, PetscReal energy)
{
  const PetscReal sum = figures->last ? EnergySum(&figures->last->energy) : 0;

  return sum > 0 ? energy / sum : NAN;
}

/* Adds what is certified; nothing where the scene switches it off or has no contact. */
static void AddCertificate(cJSON *json, const RunFigures *figures)
{
  cJSON *map;

  if (!figures->certified) return;
  cJSON_AddBoolToObject(json, "certified", !strcmp(figures->run->status, "done"));
  map = cJSON_AddObjectToObject(json, "certificate");
  cJSON_AddNumberToObject(map, "steps", (double)figures->certificate.steps);
  cJSON_AddNumberToObject(map, "refused", (double)figures->certificate.refused);
  AddReal(map, "largest_over_h", figures->certificate.over_h);
  AddReal(map, "largest_over_allowed", figures->certificate.ratio);
  AddReal(map, "residual", figures->last ? figures->last->residual : NAN);
  AddReal(map, "force_balance", figures->certificate.force);
  AddReal(map, "moment_balance", figures->scene->geometry == GEOMETRY_AXISYMMETRIC ? NAN : figures->certificate.moment);
  AddReal(map, "energy_apart", EnergyPart(figures, figures->last ? EnergyApart(&figures->last->energy) : NAN));
  AddReal(map, "least_dissipation", EnergyPart(figures, figures->last ? figures->last->energy.least : NAN));
  AddReal(map, "dissipated_by_friction", figures->last ? figures->last->contact.dissipated : NAN);
  AddReal(map, "dissipated_by_flow",
          figures->last && SceneIsPlastic(figures->scene) ? figures->last->energy.plastic : NAN);
}

/* Adds the fluids that enter between surfaces, if there are any. */
static void AddFluids(cJSON *json, const RunFigures *figures)
{
  cJSON *list = figures->n_fluids ? cJSON_AddArrayToObject(json, "fluids") : NULL;

  for (int i = 0; i < figures->n_fluids; i++) {
    const FluidReport *report = &figures->fluids[i];
    cJSON             *fluid  = cJSON_CreateObject();

    cJSON_AddItemToArray(list, fluid);
    cJSON_AddStringToObject(fluid, "surface", report->load->region);
    AddReal(fluid, "pressure", report->pressure);
    AddReal(fluid, "wetted", report->wetted);
    AddReal(fluid, "seal_pressure", report->barrier);
    AddReal(fluid, "leak_t", report->leak_t);
    AddReal(fluid, "leak_pressure", report->leak_pressure);
  }
}

/*@
  SummaryWrite - writes summary.json.

  Not collective

  Input Parameters:
+ mesh      - of the run
. figures   - of the run
. directory - of the results; exists
- probes    - final values of the scene's probes, NaN where there is none

  Note:
  For one rank. Errors: those of TextFileReplace(), and PETSC_ERR_MEM.
@*/
PetscErrorCode SummaryWrite(const Mesh mesh, const RunFigures *figures, const char *directory, const PetscReal *probes)
{
  const RunRecord *run  = figures->run;
  cJSON           *json = cJSON_CreateObject();
  char             effects[sizeof(figures->effects)], *text;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(effects, figures->effects, sizeof(effects)));
  cJSON_AddStringToObject(json, "name", figures->scene->name);
  cJSON_AddStringToObject(json, "version", BURNISH_VERSION);
  cJSON_AddNumberToObject(json, "ranks", figures->ranks);
  cJSON_AddNumberToObject(json, "dofs", (double)figures->dofs);
  cJSON_AddNumberToObject(json, "elements", (double)mesh->n_cells_global);
  AddList(json, "effects", effects, ",");
  PetscCall(AddOptions(json, figures->scene, figures->options_changed));
  AddBlas(json, &figures->blas);
  AddRun(json, run);
  cJSON_AddNumberToObject(json, "restarts", (double)figures->restarts);
  AddCycles(json, run->way);
  AddJumps(json, run->way);
  AddStability(json, run->way);
  AddDamping(json, figures);
  AddSprings(json, figures);
  AddLinear(json, &figures->linear);
  AddUsage(json, figures);
  AddGuards(json, run->way);
  AddState(json, figures->scene, figures->n_pairs ? PETSC_TRUE : PETSC_FALSE, figures->last, probes);
  AddUnits(json, figures->scene);
  AddErrors(json, figures);
  AddZones(json, figures);
  AddEnergy(json, figures);
  AddPartition(json, mesh);
  AddContact(json, figures);
  AddFluids(json, figures);
  AddCertificate(json, figures);
  AddAdvice(json, figures);
  text = cJSON_Print(json);
  PetscCheck(text, PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for summary.json");
  PetscCall(TextFileReplace(directory, "summary.json", text));
  cJSON_free(text);
  cJSON_Delete(json);
  PetscFunctionReturn(PETSC_SUCCESS);
}
