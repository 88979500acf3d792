#include "summary.h"
#include "commandline.h"
#include "timing.h"
#include <cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

enum { TEXT_SIZE = 4096 };

/*
  SummaryCollectUsage - What this program has used since it started, over all ranks; wall_s is left alone. Collective.
*/
PetscErrorCode SummaryCollectUsage(MPI_Comm comm, RunUsage *usage)
{
  struct rusage self;

  PetscFunctionBeginUser;
  PetscCheck(!getrusage(RUSAGE_SELF, &self), PETSC_COMM_SELF, PETSC_ERR_SYS, "getrusage failed");
  for (int k = 0; k < TIMING_KINDS; k++) usage->seconds[k] = TimingSeconds((TimingKind)k);
  usage->cpu_s       = (PetscReal)(self.ru_utime.tv_sec + self.ru_stime.tv_sec) + 1e-6 * (PetscReal)(self.ru_utime.tv_usec + self.ru_stime.tv_usec);
  usage->peak_rss_mb = (PetscReal)self.ru_maxrss / 1024.0; /* Linux counts kilobytes */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, usage->seconds, TIMING_KINDS, MPIU_REAL, MPI_MAX, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &usage->cpu_s, 1, MPIU_REAL, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &usage->peak_rss_mb, 1, MPIU_REAL, MPI_MAX, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The parts of a text between commas, without the blanks around them */
static void AddList(cJSON *json, const char *key, char *text)
{
  cJSON *list = cJSON_AddArrayToObject(json, key);
  char  *rest = NULL;

  for (char *part = strtok_r(text, ",", &rest); part; part = strtok_r(NULL, ",", &rest)) {
    part += strspn(part, " ");
    for (size_t n = strlen(part); n && part[n - 1] == ' '; n--) part[n - 1] = '\0';
    if (*part) cJSON_AddItemToArray(list, cJSON_CreateString(part));
  }
}

/* null where there is no value */
static void AddReal(cJSON *json, const char *key, PetscReal value)
{
  if (isfinite((double)value))
    cJSON_AddNumberToObject(json, key, (double)value);
  else
    cJSON_AddNullToObject(json, key);
}

/* PETSc's options as they are now, the scene's own, and those that nothing has asked for */
static PetscErrorCode AddOptions(cJSON *json, Scene scene)
{
  cJSON   *options = cJSON_AddObjectToObject(json, "options"), *map, *unused;
  char    *all, **names, **values;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetAll(NULL, &all));
  cJSON_AddStringToObject(options, "petsc", all);
  PetscCall(PetscFree(all));
  map = cJSON_AddObjectToObject(options, "scene");
  for (int i = 0; i < scene->n_petsc; i++) cJSON_AddStringToObject(map, scene->petsc[i].key, scene->petsc[i].value ? scene->petsc[i].value : "");
  unused = cJSON_AddArrayToObject(options, "unused");
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n; i++) cJSON_AddItemToArray(unused, cJSON_CreateString(names[i]));
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void AddRun(cJSON *json, const RunRecord *run)
{
  cJSON_AddStringToObject(json, "status", run->status);
  if (run->message)
    cJSON_AddStringToObject(json, "message", run->message);
  else
    cJSON_AddNullToObject(json, "message");
  cJSON_AddNumberToObject(json, "steps", (double)run->steps);
  cJSON_AddNumberToObject(json, "steps_failed", (double)run->steps_failed);
  cJSON_AddNumberToObject(json, "steps_repeated", (double)run->steps_repeated);
  cJSON_AddNumberToObject(json, "newton_iterations", (double)run->newton_iterations);
  cJSON_AddNumberToObject(json, "newton_accepted", (double)run->newton_accepted);
  cJSON_AddNumberToObject(json, "krylov_iterations", (double)run->krylov_iterations);
}

static void AddUsage(cJSON *json, const RunRecord *run, const RunUsage *usage)
{
  cJSON *seconds;

  AddReal(json, "wall_s", usage->wall_s);
  AddReal(json, "cpu_s", usage->cpu_s);
  AddReal(json, "mesh_s", run->mesh_s);
  AddReal(json, "peak_rss_mb", usage->peak_rss_mb);
  seconds = cJSON_AddObjectToObject(json, "seconds");
  for (int k = 0; k < TIMING_KINDS; k++) AddReal(seconds, TimingNames[k], usage->seconds[k]);
}

/* Contact sets that repeated themselves */
static void AddCycles(cJSON *json, const RunRecord *run)
{
  cJSON *map = cJSON_AddObjectToObject(json, "cycles");

  cJSON_AddNumberToObject(map, "found", (double)run->cycles);
  cJSON_AddNumberToObject(map, "steps_cut", (double)run->cycles_cut);
  if (run->cycles)
    cJSON_AddStringToObject(map, "last", run->cycle);
  else
    cJSON_AddNullToObject(map, "last");
}

/* What the springs of stabilised pairs did, where there are any */
static void AddSprings(cJSON *json, Scene scene, const RunRecord *run)
{
  cJSON *map;
  int    any = 0;

  for (int c = 0; c < scene->n_contacts; c++) any = any || scene->contacts[c].stabilise;
  if (!any) return;
  map = cJSON_AddObjectToObject(json, "stabilisation");
  cJSON_AddNumberToObject(map, "relaxed", (double)run->relaxed);
  AddReal(map, "energy_taken", run->taken);
  AddReal(map, "largest_energy_share", run->left);
}

/* How the linear solves went */
static void AddLinear(cJSON *json, LinearCheck check)
{
  cJSON       *map = cJSON_AddObjectToObject(json, "linear");
  LinearCounts counts;

  LinearCheckGetCounts(check, &counts);
  cJSON_AddNumberToObject(map, "solves", (double)counts.solves);
  cJSON_AddNumberToObject(map, "refined", (double)counts.refined);
  cJSON_AddNumberToObject(map, "refinement_steps", (double)counts.steps);
  cJSON_AddNumberToObject(map, "inaccurate", (double)counts.inaccurate);
  AddReal(map, "largest_residual", counts.worst);
}

/* The last accepted state */
static void AddState(cJSON *json, Scene scene, PetscBool has_contact, const StepRecord *last, const PetscReal *probes)
{
  const PetscBool touches = has_contact && last ? PETSC_TRUE : PETSC_FALSE;
  cJSON          *map;

  AddReal(json, "t", last ? last->t : 0.0);
  AddReal(json, "max_penetration", touches ? last->contact.max_penetration : NAN);
  AddReal(json, "max_penetration_over_h", touches ? last->contact.max_penetration_over_h : NAN);
  cJSON_AddNumberToObject(json, "contact_nodes", touches ? (double)last->contact.nodes : 0.0);
  map = cJSON_AddObjectToObject(json, "probes");
  for (int i = 0; i < scene->n_probes; i++) AddReal(map, scene->probes[i].name, last ? probes[i] : NAN);
}

static void AddPartition(cJSON *json, const Mesh mesh)
{
  cJSON *map = cJSON_AddObjectToObject(json, "partition");

  cJSON_AddStringToObject(map, "tool", mesh->partition.tool);
  cJSON_AddNumberToObject(map, "edge_cut", (double)mesh->partition.edge_cut);
  AddReal(map, "imbalance_cells", mesh->partition.imbalance_cells);
  AddReal(map, "imbalance_contact", mesh->partition.imbalance_contact);
}

static PetscErrorCode AddContact(cJSON *json, Contact contact)
{
  cJSON *list = cJSON_AddArrayToObject(json, "contact");

  PetscFunctionBeginUser;
  for (int p = 0; p < (contact ? ContactPairs(contact) : 0); p++) {
    cJSON        *pair = cJSON_CreateObject(), *penalty;
    PetscReal     least, most;
    ContactFits   fits;
    ContactWindow window;

    PetscCall(ContactPairFits(contact, p, &fits));
    PetscCall(ContactPairPenalty(contact, p, &least, &most));
    PetscCall(ContactPairWindow(contact, p, &window));
    cJSON_AddItemToArray(list, pair);
    cJSON_AddStringToObject(pair, "name", ContactPairName(contact, p));
    cJSON_AddNumberToObject(pair, "fall_backs", (double)(fits.points - fits.plain));
    penalty = cJSON_AddObjectToObject(pair, "penalty");
    AddReal(penalty, "min", least);
    AddReal(penalty, "max", most);
    cJSON_AddNumberToObject(penalty, "raised", (double)window.raised);
    cJSON_AddNumberToObject(penalty, "lowered", (double)window.lowered);
    cJSON_AddNumberToObject(penalty, "clamped", (double)window.clamped);
    cJSON_AddNumberToObject(penalty, "light", (double)window.light);
    cJSON_AddNumberToObject(penalty, "outside_window", (double)window.outside);
    cJSON_AddNumberToObject(penalty, "largest_excess", (double)window.excess);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  SummaryWrite - Writes summary.json under a temporary name and renames it. Collective.

  Input: model, scene, directory (exists), run (counts), usage (of all parts of the run), restarts (number of the parts less one), last (last accepted step,
  NULL: none), probes[scene->n_probes] (final values, NaN: none). Errors: PETSC_ERR_FILE_OPEN, PETSC_ERR_FILE_WRITE, PETSC_ERR_MEM.
*/
PetscErrorCode SummaryWrite(Model model, Scene scene, const char *directory, const RunRecord *run, const RunUsage *usage, PetscInt restarts,
                            const StepRecord *last, const PetscReal *probes)
{
  const Mesh  mesh = model->mesh;
  cJSON      *json = cJSON_CreateObject();
  char        effects[TEXT_SIZE], *text;
  PetscMPIInt rank, size;
  PetscInt    dofs;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCallMPI(MPI_Comm_size(mesh->comm, &size));
  PetscCall(ModelEffects(model, effects, sizeof(effects)));
  PetscCall(ModelDofs(model, &dofs));
  cJSON_AddStringToObject(json, "name", scene->name);
  cJSON_AddStringToObject(json, "version", BURNISH_VERSION);
  cJSON_AddNumberToObject(json, "ranks", size);
  cJSON_AddNumberToObject(json, "dofs", (double)dofs);
  cJSON_AddNumberToObject(json, "elements", (double)mesh->n_cells_global);
  AddList(json, "effects", effects);
  PetscCall(AddOptions(json, scene));
  AddRun(json, run);
  cJSON_AddNumberToObject(json, "restarts", (double)restarts);
  AddCycles(json, run);
  AddSprings(json, scene, run);
  AddLinear(json, model->linear);
  AddUsage(json, run, usage);
  AddState(json, scene, model->contact ? PETSC_TRUE : PETSC_FALSE, last, probes);
  AddPartition(json, mesh);
  PetscCall(AddContact(json, model->contact));
  text = cJSON_Print(json);
  PetscCheck(text, PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for summary.json");
  if (rank == 0) PetscCall(ResultsReplaceFile(directory, "summary.json", text));
  cJSON_free(text);
  cJSON_Delete(json);
  PetscFunctionReturn(PETSC_SUCCESS);
}
