/* The derivatives of probes by numbers of the scene, see sensitivity.h. */
#include "sensitivity.h"
#include <math.h>
#include <string.h>
#include "base/refusal.h"
#include "files/textfile.h"
#include "report/probevariation.h"
#include "solve/twin.h"

/* By this part of itself a number is changed. Differences of residuals have no error of an iteration, so that the part
   may be small. Contacts close and open over lengths of the penetration, which may be a millionth of the bodies. */
#define SENSITIVITY_STEP 1e-7
/* By this part of itself it is changed for whole runs. They have the errors of their iterations, some 1e-9 of the
   answer. The curvature of the answer leaves the square of the part. */
#define SENSITIVITY_RUN_STEP 1e-3
/* Slopes of both sides that are so far apart, over their mean, are both said. */
#define SENSITIVITY_KINK 0.05
/* Changes of an answer, over it, that whole runs do not tell from the errors of their iterations */
#define SENSITIVITY_NOISE 1e-6
/* Twins whose mean residual is beyond this part of the forces, and beyond the second part of what the number changes,
   are in another state than the model. */
#define SENSITIVITY_APART 1e-6
#define SENSITIVITY_BEND  1e-2
/* The direct way solves on until a correction is below this part of the response, or so many times. Each correction for
   what contact lists change is some tenth of the one before. */
#define SENSITIVITY_CORRECTED 1e-6
enum { SENSITIVITY_CORRECTIONS = 20 };

enum { SENSITIVITY_ROW = 1536, SENSITIVITY_EDIT = 1024 };

/* A model of the scene with another value of one number */
typedef struct {
  Scene      scene;
  Mesh       mesh;
  Model      model;
  Probes     probes;
  Vec        F;     /* its residual (force) */
  PetscReal *value; /* of its probes */
} Twin;

/* What is known of a probe */
typedef struct {
  PetscBool wanted;
  PetscReal value;
  Vec       y; /* adjoint solution at the free dofs; NULL: the direct way is taken */
} SensitiveProbe;

typedef struct {
  Run            *run;
  const RunInput *input;
  SensitiveProbe *probe;
  Vec             F;       /* residual of the model (force) */
  Vec             place;   /* free displacements at which contact lists are made (length) */
  PetscBool       settled; /* the solution with these lists is known */
  PetscReal      *derivative, *cpu_s;
  PetscReal      *apart; /* distance of the slopes of both sides over their mean, with whole runs; else 0 */
  const char    **why;   /* it has no derivative */
} Sensitivities;

/* Does the answer depend on the way to it, or on multipliers of elements, which stay from one solve to the next? The
   model tells of these once there is one. */
static PetscBool ByRuns(const Run *run)
{
  return (PetscBool)(run->scene->sensitivities_by_runs ||
                     (run->model && ElasticityAugments(run->model->problem->elasticity)));
}

/* By which part of itself a number is changed. */
static double ChangeOf(const Run *run)
{
  return ByRuns(run) ? SENSITIVITY_RUN_STEP : SENSITIVITY_STEP;
}

/*@
  SensitivitiesCheck - refuses numbers that cannot be changed a little.

  Collective

  Input Parameter:
. run - with its scene
@*/
PetscErrorCode SensitivitiesCheck(Run *run)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < run->scene->n_sensitivities; i++) {
    const SceneSensitivity *s = &run->scene->sensitivities[i];
    Scene                   changed;

    PetscCall(SceneReadChanged(run->scene, run->comm, s->key, s->value * (1 + ChangeOf(run)), &changed));
    PetscCall(SceneDestroy(&changed));
    PetscCall(SceneReadChanged(run->scene, run->comm, s->key, s->value * (1 - ChangeOf(run)), &changed));
    PetscCall(SceneDestroy(&changed));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is a number one of the mesh? */
static PetscBool MovesMesh(const char *key)
{
  return (PetscBool)!strncmp(key, "mesh.", strlen("mesh."));
}

/* Have two scenes the same pairs? The mesh decides which surfaces are joined and which roles are swapped. */
static PetscBool SamePairs(const Scene one, const Scene other)
{
  PetscBool same = (PetscBool)(one->n_contacts == other->n_contacts);

  for (int i = 0; i < one->n_contacts && same; i++)
    same = (PetscBool)!strcmp(one->contacts[i].slave, other->contacts[i].slave);
  return same;
}

/* Makes a twin. */
static PetscErrorCode TwinCreate(const Sensitivities *all, const char *key, PetscReal value, Twin *twin)
{
  Run      *run = all->run;
  PetscBool same;
  PetscReal seconds;
  char      file[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  *twin = (Twin){.scene = NULL};
  PetscCall(SceneReadChanged(run->scene, run->comm, key, (double)value, &twin->scene));
  PetscCall(PetscStrncpy(file, run->mesh_file, sizeof(file)));
  if (MovesMesh(key) || all->input->restart) /* a restart does not keep the file that its checkpoint has */
    PetscCall(MeshGenerate(run->comm, twin->scene, "out", all->input->trust, file, &seconds));
  PetscCall(MeshCreate(run->comm, twin->scene, file, &twin->mesh));
  if (!SamePairs(run->scene, twin->scene))
    PetscCall(RefuseInput(run->comm,
                          "%s: %s gives contact other pairs when it changes a little; allowed for a sensitivity: "
                          "parameters that keep which surfaces are joined and which are slaves",
                          SceneWhere(run->scene, "sensitivity", NULL), key));
  PetscCall(MeshCheckFormulations(twin->mesh, twin->scene));
  PetscCall(ModelCreate(twin->scene, twin->mesh, &twin->model));
  PetscCall(ProbesCreate(twin->model, twin->scene, &twin->probes));
  PetscCall(ModelPlace(twin->model, twin->scene->stepping.initial));
  PetscCall(ModelSetUp(twin->model));
  PetscCall(ModelTwinFollow(twin->model, run->model, &same));
  if (!same)
    PetscCall(RefuseInput(run->comm,
                          "%s: %s gives the mesh other nodes or cells when it changes a little; allowed for a "
                          "sensitivity: parameters that move nodes and keep their connections",
                          SceneWhere(run->scene, "sensitivity", NULL), key));
  PetscCall(VecDuplicate(run->model->x, &twin->F));
  PetscCall(PetscMalloc1(twin->scene->n_probes, &twin->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TwinDestroy(Twin *twin)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(twin->value));
  PetscCall(VecDestroy(&twin->F));
  PetscCall(ProbesDestroy(&twin->probes));
  PetscCall(ModelDestroy(&twin->model));
  PetscCall(MeshDestroy(&twin->mesh));
  PetscCall(SceneDestroy(&twin->scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SensitivitiesCheckModel - refuses parameters that change the connections of the mesh.

  Collective

  Input Parameters:
+ run   - with its model, after ModelSetUp()
- input - what the user asks for

  Note:
  Pressures of elements that keep their volume exactly are multipliers, which follow a number of the scene as
  displacements do.
@*/
PetscErrorCode SensitivitiesCheckModel(Run *run, const RunInput *input)
{
  const Sensitivities all = {.run = run, .input = input};

  PetscFunctionBeginUser;
  for (int i = 0; i < run->scene->n_sensitivities; i++) {
    const SceneSensitivity *s = &run->scene->sensitivities[i];

    for (int side = -1; side <= 1 && MovesMesh(s->key); side += 2) {
      Twin twin;

      PetscCall(TwinCreate(&all, s->key, (PetscReal)(s->value * (1 + side * ChangeOf(run))), &twin));
      PetscCall(TwinDestroy(&twin));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Residual and probes of a twin at free displacements. */
static PetscErrorCode TwinEvaluate(Twin *twin, Vec x, PetscReal t, PetscBool *ok)
{
  PetscBool mine;

  PetscFunctionBeginUser;
  PetscCall(ModelTwinEvaluate(twin->model, x, t, twin->F, &mine));
  PetscCall(ProbesEvaluate(twin->probes, twin->value));
  *ok = (PetscBool)(*ok && mine);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do the residuals of the twins lie on either side of that of the model? */
static PetscErrorCode Beside(const Sensitivities *all, const Twin twin[2], PetscBool *beside)
{
  PetscReal norm, between;
  Vec       mean;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(all->F, &mean));
  PetscCall(VecCopy(twin[0].F, mean));
  PetscCall(VecAXPY(mean, -1, twin[1].F));
  PetscCall(VecNorm(mean, NORM_2, &between));
  PetscCall(VecAXPY(mean, 2, twin[1].F));
  PetscCall(VecAXPY(mean, -2, all->F));
  PetscCall(VecNorm(mean, NORM_2, &norm));
  PetscCall(VecDestroy(&mean));
  *beside = (PetscBool)(norm <= 2 * PetscMax(SENSITIVITY_APART * ProblemForceScale(all->run->model->problem),
                                             SENSITIVITY_BEND * between));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The derivatives of all wanted probes by the number that differs by h in the two twins, the adjoint way, and of those
   that take the direct way what they have without a change of the displacements. */
static PetscErrorCode AddAdjoints(const Sensitivities *all, const Twin twin[2], PetscReal h, Vec change,
                                  PetscReal derivative[])
{
  PetscFunctionBeginUser;
  for (int p = 0; p < all->run->scene->n_probes; p++) {
    PetscReal follows = 0;

    if (all->probe[p].y) PetscCall(VecDot(all->probe[p].y, change, &follows));
    derivative[p] = (twin[0].value[p] - twin[1].value[p]) / (2 * h) + follows;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The derivative of the residual, from the twins. */
static PetscErrorCode Slope(const Twin twin[2], PetscReal h, Vec slope)
{
  PetscFunctionBeginUser;
  PetscCall(VecWAXPY(slope, -1, twin[1].F, twin[0].F));
  PetscCall(VecScale(slope, 1 / (2 * h)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves the twins along with the solution, contact lists included, and gives what is left of their residuals. */
static PetscErrorCode Follow(const Sensitivities *all, Twin twin[2], PetscReal h, Vec response, Vec change,
                             PetscBool *ok)
{
  const Model model = all->run->model;
  Vec         x;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(response, &x));
  for (int k = 0; k < 2; k++) {
    PetscCall(VecWAXPY(x, k ? -h : h, response, all->place));
    PetscCall(ModelTwinGather(twin[k].model, x, model->t));
    PetscCall(VecWAXPY(x, k ? -h : h, response, model->x));
    PetscCall(TwinEvaluate(&twin[k], x, model->t, ok));
  }
  PetscCall(Slope(twin, h, change));
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same for the probes that take the direct way. What moves contact lists changes the equations a little besides:
   the response is corrected for it. */
static PetscErrorCode Direct(const Sensitivities *all, Twin twin[2], PetscReal h, Vec change, PetscReal derivative[],
                             PetscBool *ok)
{
  PetscBool any     = PETSC_FALSE;
  PetscReal size[2] = {1, 0}; /* of the last correction, and of the response */
  Vec       response, more;

  PetscFunctionBeginUser;
  for (int p = 0; p < all->run->scene->n_probes; p++)
    any = (PetscBool)(any || (all->probe[p].wanted && !all->probe[p].y));
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(change, &response));
  PetscCall(VecDuplicate(change, &more));
  PetscCall(VecZeroEntries(response));
  for (int k = 0; k < SENSITIVITY_CORRECTIONS && *ok && size[0] > SENSITIVITY_CORRECTED * size[1]; k++) {
    PetscCall(ModelRespond(all->run->model, change, more, ok));
    PetscCall(VecAXPY(response, 1, more));
    PetscCall(VecNorm(more, NORM_2, &size[0]));
    PetscCall(VecNorm(response, NORM_2, &size[1]));
    if (*ok) PetscCall(Follow(all, twin, h, response, change, ok));
  }
  for (int p = 0; p < all->run->scene->n_probes; p++)
    if (!all->probe[p].y) derivative[p] = (twin[0].value[p] - twin[1].value[p]) / (2 * h);
  PetscCall(VecDestroy(&response));
  PetscCall(VecDestroy(&more));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The derivatives of all wanted probes by one number. */
static PetscErrorCode Differentiate(const Sensitivities *all, const SceneSensitivity *s, PetscReal derivative[],
                                    const char **why)
{
  const Model     model = all->run->model;
  const PetscReal h     = SENSITIVITY_STEP * PetscAbsReal((PetscReal)s->value);
  PetscBool       ok = PETSC_TRUE, beside = PETSC_FALSE;
  Twin            twin[2];
  Vec             change;

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) {
    PetscCall(TwinCreate(all, s->key, (PetscReal)s->value + (k ? -h : h), &twin[k]));
    PetscCall(ModelTwinGather(twin[k].model, all->place, model->t));
    PetscCall(TwinEvaluate(&twin[k], model->x, model->t, &ok));
  }
  PetscCall(Beside(all, twin, &beside));
  PetscCall(VecDuplicate(model->x, &change));
  PetscCall(Slope(twin, h, change));
  PetscCall(AddAdjoints(all, twin, h, change, derivative));
  if (ok && beside) PetscCall(Direct(all, twin, h, change, derivative, &ok));
  *why = ok && beside && all->settled
           ? NULL
           : "the solution is no function of the scene's end alone, or cannot be solved with";
  PetscCall(VecDestroy(&change));
  for (int k = 0; k < 2; k++) PetscCall(TwinDestroy(&twin[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do contact lists hold what follows the displacements from one solution to the next: supports of fits, offsets and
   areas of quadrature points? A first variation does not have that. */
static PetscBool ListsFollow(Contact contact)
{
  PetscBool follow = (PetscBool)(contact && ContactHasFits(contact));

  for (int p = 0; contact && p < ContactPairs(contact); p++)
    follow = (PetscBool)(follow || ContactPairIsSurface(contact, p));
  return follow;
}

/* Is the first variation of a probe good enough for an estimate of an error alone? That of a mean pressure leaves areas
   and normals as they are, that of a torque the arms. */
static PetscBool VariesRoughly(const SceneProbe *probe)
{
  return (PetscBool)(probe->kind == PROBE_PRESSURE_MEAN || probe->kind == PROBE_REACTION_TORQUE ||
                     probe->kind == PROBE_CONTACT_TORQUE);
}

/* Finds the values of the probes, and the adjoint solutions of those that have a first variation. */
static PetscErrorCode FindAdjoints(Sensitivities *all)
{
  Run            *run    = all->run;
  const int       n      = run->scene->n_probes;
  const PetscInt  dofs   = run->mesh->n_nodes * run->mesh->dim;
  int             m      = 0, *probe;
  const PetscBool direct = ListsFollow(all->run->model->contact);
  PetscReal      *value;
  Functional     *functional;
  Adjoint        *adjoint;
  PetscBool       ok;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n, &probe, n, &value, n, &functional, n, &adjoint));
  PetscCall(ProblemSetTrial(run->model->problem, run->model->x, run->model->t));
  PetscCall(ProblemResidual(run->model->problem, run->model->problem->trial, run->model->t, run->model->t, &ok));
  PetscCall(ProblemCollectResidual(run->model->problem, run->model->x, all->F));
  PetscCall(ProbesEvaluate(run->probes, value));
  for (int p = 0; p < n; p++) {
    const char *why = NULL;

    all->probe[p].value = value[p];
    if (direct || !all->probe[p].wanted || VariesRoughly(&run->scene->probes[p])) continue;
    PetscCall(ProbeVary(run->probes, p, &functional[m], &why));
    if (why) PetscCall(ProbeVariationFree(&functional[m]));
    probe[m] = p;
    m += !why;
  }
  for (int k = 0; k < m; k++) PetscCall(PetscCalloc1(dofs, &adjoint[k].y));
  PetscCall(ModelAdjoint(run->model, m, functional, adjoint));
  for (int k = 0; k < m; k++) {
    if (adjoint[k].known) {
      PetscCall(VecDuplicate(run->model->x, &all->probe[probe[k]].y));
      PetscCall(MeshCollectFree(run->mesh, adjoint[k].y, all->probe[probe[k]].y));
    }
    PetscCall(ProbeVariationFree(&functional[k]));
    PetscCall(PetscFree(adjoint[k].y));
  }
  PetscCall(PetscFree4(probe, value, functional, adjoint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is a sensitivity the first one in the list by its number? The number is dealt with once. */
static PetscBool IsFirst(Scene scene, int i)
{
  int first = 0;

  while (strcmp(scene->sensitivities[first].key, scene->sensitivities[i].key)) first++;
  return (PetscBool)(first == i);
}

/* Finds all derivatives: for each number once. */
static PetscErrorCode FindAll(Sensitivities *all)
{
  const Scene scene = all->run->scene;
  PetscReal  *derivative;
  RunUsage    begin, end;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(scene->n_probes, &derivative));
  for (int i = 0; i < scene->n_sensitivities; i++) {
    const SceneSensitivity *s   = &scene->sensitivities[i];
    const char             *why = NULL;

    if (!IsFirst(scene, i)) continue;
    PetscCall(ResultsGetUsage(all->run->results, &begin));
    PetscCall(Differentiate(all, s, derivative, &why));
    PetscCall(ResultsGetUsage(all->run->results, &end));
    for (int j = i; j < scene->n_sensitivities; j++) {
      if (strcmp(scene->sensitivities[j].key, s->key)) continue;
      all->derivative[j] = why ? NAN : derivative[scene->sensitivities[j].probe];
      all->why[j]        = why;
      all->cpu_s[j]      = end.cpu_s - begin.cpu_s;
    }
  }
  PetscCall(PetscFree(derivative));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints the derivatives. */
static void Print(const Sensitivities *all)
{
  const Scene scene = all->run->scene;

  for (int i = 0; i < scene->n_sensitivities; i++) {
    const SceneSensitivity *s     = &scene->sensitivities[i];
    const PetscReal         value = all->probe[s->probe].value;

    if (all->why[i])
      printf("derivative of %s by %s: not known: %s\n", scene->probes[s->probe].name, s->key, all->why[i]);
    else {
      printf("derivative of %s by %s: %.6g; 1 %% of it changes %s by %.3g %%", scene->probes[s->probe].name, s->key,
             (double)all->derivative[i], scene->probes[s->probe].name,
             (double)(all->derivative[i] * (PetscReal)s->value / value));
      if (ByRuns(all->run)) printf("; by whole runs, %.3g s of CPU", (double)all->cpu_s[i]);
      if (all->apart[i] > SENSITIVITY_KINK)
        printf("; the slopes on both sides are %.2g %% apart", 100 * (double)all->apart[i]);
      printf("\n");
    }
  }
}

/* Writes sensitivity.csv. */
static PetscErrorCode Write(const Sensitivities *all)
{
  const Scene  scene = all->run->scene;
  const size_t size  = (size_t)(scene->n_sensitivities + 1) * SENSITIVITY_ROW;
  char        *text;
  size_t       used;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(size, &text));
  used = (size_t)snprintf(text, size, "probe,key,value,number,derivative,way,cpu_s\n");
  for (int i = 0; i < scene->n_sensitivities; i++) {
    const SceneSensitivity *s = &scene->sensitivities[i];

    used +=
      (size_t)snprintf(text + used, size - used, "%s,%s,%.15g,%.15g,%.10g,%s,%.3f\n", scene->probes[s->probe].name,
                       s->key, (double)all->probe[s->probe].value, s->value, (double)all->derivative[i],
                       ByRuns(all->run)         ? "runs"
                       : all->probe[s->probe].y ? "adjoint"
                                                : "direct",
                       (double)all->cpu_s[i]);
  }
  PetscCall(TextFileReplace(all->run->directory, "sensitivity.csv", text));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes room for the derivatives. */
static PetscErrorCode SensitivitiesBegin(Sensitivities *all)
{
  const Scene scene = all->run->scene;
  const int   n     = scene->n_sensitivities;

  PetscFunctionBeginUser;
  PetscCall(
    PetscCalloc5(scene->n_probes, &all->probe, n, &all->derivative, n, &all->cpu_s, n, &all->apart, n, &all->why));
  for (int i = 0; i < n; i++) all->probe[scene->sensitivities[i].probe].wanted = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints and writes the derivatives, and frees them. */
static PetscErrorCode SensitivitiesEnd(Sensitivities *all)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(all->run->comm, &rank));
  if (!rank && !all->input->quiet) Print(all);
  if (!rank) PetscCall(Write(all));
  for (int p = 0; p < all->run->scene->n_probes; p++) PetscCall(VecDestroy(&all->probe[p].y));
  PetscCall(PetscFree5(all->probe, all->derivative, all->cpu_s, all->apart, all->why));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SensitivitiesFind - finds the derivatives that the scene asks for, prints them and writes sensitivity.csv.

  Collective

  Input Parameters:
+ run   - at the solution of its last step, before that is accepted
- input - what the user asks for

  Note:
  Refuses a parameter of the mesh that gives it other nodes or cells.
@*/
PetscErrorCode SensitivitiesFind(Run *run, const RunInput *input)
{
  Sensitivities all = {.run = run, .input = input};

  PetscFunctionBeginUser;
  if (!run->scene->n_sensitivities || ByRuns(run)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SensitivitiesBegin(&all));
  PetscCall(VecDuplicate(run->model->x, &all.F));
  PetscCall(VecDuplicate(run->model->x, &all.place));
  PetscCall(ModelSettleLists(run->model, all.place, &all.settled));
  PetscCall(FindAdjoints(&all));
  PetscCall(FindAll(&all));
  PetscCall(VecDestroy(&all.F));
  PetscCall(VecDestroy(&all.place));
  PetscCall(SensitivitiesEnd(&all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The probes of a run with another value of a number. key: NULL changes nothing. */
static PetscErrorCode RunChanged(const Sensitivities *all, RunAgainFn solve, const char *key, double value,
                                 PetscReal values[], PetscReal *cpu_s, PetscBool *known)
{
  char        edit[SENSITIVITY_EDIT];
  const Again again = {solve, "changed", 1, key ? edit : NULL};

  PetscFunctionBeginUser;
  if (key) PetscCall(PetscSNPrintf(edit, sizeof(edit), "%s=%.17g", key, value));
  PetscCall(AgainSolve(all->run, all->input, &again, values, cpu_s, known));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The derivatives of all wanted probes by the number of a sensitivity, from two whole runs. value[0], value[1]: room
   for their probes; value[2]: those of such a run with the number as it is. */
static PetscErrorCode DifferentiateRuns(Sensitivities *all, RunAgainFn solve, int i, PetscReal *const value[3])
{
  const Scene             scene = all->run->scene;
  const SceneSensitivity *s     = &scene->sensitivities[i];
  const PetscReal         h     = (PetscReal)(SENSITIVITY_RUN_STEP * fabs(s->value));
  PetscReal               cpu_s[2];
  PetscBool               known[2];

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++)
    PetscCall(RunChanged(all, solve, s->key, s->value + (k ? -(double)h : (double)h), value[k], &cpu_s[k], &known[k]));
  for (int j = i; j < scene->n_sensitivities; j++) {
    const int       p       = scene->sensitivities[j].probe;
    const PetscReal between = value[0][p] - value[1][p], bend = value[0][p] + value[1][p] - 2 * value[2][p];

    if (strcmp(scene->sensitivities[j].key, s->key)) continue;
    all->why[j]        = known[0] && known[1] ? NULL : "a run with a number that is a little different does not end";
    all->derivative[j] = all->why[j] ? NAN : between / (2 * h);
    if (PetscAbsReal(between) > SENSITIVITY_NOISE * PetscAbsReal(all->probe[p].value))
      all->apart[j] = PetscAbsReal(2 * bend / between);
    all->cpu_s[j] = cpu_s[0] + cpu_s[1];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The derivatives by all numbers. value: as for DifferentiateRuns(). */
static PetscErrorCode FindAllByRuns(Sensitivities *all, RunAgainFn solve, PetscReal *const value[3])
{
  const Scene scene = all->run->scene;
  PetscReal   cpu_s;
  PetscBool   known;

  PetscFunctionBeginUser;
  PetscCall(RunChanged(all, solve, NULL, 0, value[2], &cpu_s, &known));
  for (int i = 0; i < scene->n_sensitivities; i++)
    if (IsFirst(scene, i)) PetscCall(DifferentiateRuns(all, solve, i, value));
  for (int i = 0; i < scene->n_sensitivities; i++) { /* the run that serves all numbers counts for the first one */
    if (!strcmp(scene->sensitivities[0].key, scene->sensitivities[i].key)) all->cpu_s[i] += cpu_s;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SensitivitiesFindByRuns - finds the derivatives that the scene asks for where its answer depends on the way to it.

  Collective

  Input Parameters:
+ run   - at its end, before its results are finished
. input - what the user asks for
- solve - solves a scene besides, and gives its probes

  Note:
  A run that was continued has none: it does not know all of its steps.
@*/
PetscErrorCode SensitivitiesFindByRuns(Run *run, const RunInput *input, RunAgainFn solve)
{
  const Scene      scene = run->scene;
  Sensitivities    all   = {.run = run, .input = input};
  const PetscReal *values;
  PetscReal       *value[3];

  PetscFunctionBeginUser;
  if (!scene->n_sensitivities || !ByRuns(run)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SensitivitiesBegin(&all));
  PetscCall(PetscCalloc3(scene->n_probes, &value[0], scene->n_probes, &value[1], scene->n_probes, &value[2]));
  PetscCall(ResultsGetProbes(run->results, &values));
  for (int p = 0; p < scene->n_probes; p++) all.probe[p].value = value[2][p] = values[p];
  for (int i = 0; i < scene->n_sensitivities; i++) {
    all.derivative[i] = NAN;
    all.why[i]        = "a run that was continued does not know where all its steps ended";
  }
  if (!input->restart) PetscCall(FindAllByRuns(&all, solve, value));
  PetscCall(PetscFree3(value[0], value[1], value[2]));
  PetscCall(SensitivitiesEnd(&all));
  PetscFunctionReturn(PETSC_SUCCESS);
}
