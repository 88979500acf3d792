/* What a run writes, step by step: ties its directory, tables, fields and the terminal, see results.h. */
#include "report/results.h"
#include "errorfields.h"
#include "fields.h"
#include "optionrecord.h"
#include "report/rundirectory.h"
#include "runlength.h"
#include "stepscsv.h"
#include "summary.h"
#include "terminal.h"

enum { ARCHIVE_NAME_SIZE = 160 /* characters of a value's name in a checkpoint */ };

struct _n_Results {
  Model       model;
  Probes      probes;
  Scene       scene;
  char        directory[PETSC_MAX_PATH_LEN];
  PetscMPIInt rank;
  StepsCsv    csv;
  Fields      fields;
  Terminal    terminal;
  ProbeErrors errors; /* NULL: the scene does not ask for them */
  PetscReal  *values; /* of the probes, at the last accepted step */
  PetscBool  *met;    /* per contact pair: some slave node has met its master */
  StepRecord  last;
  PetscReal   deepest;          /* largest penetration so far, in face sizes */
  PetscReal  *standing;         /* per contact pair: largest depth of master nodes in written states (length) */
  PetscReal   standing_over_h;  /* the largest of all pairs, in face sizes */
  PetscBool   stepped, written; /* there is an accepted step; results.vtkhdf holds it */
  double      started;          /* MPI_Wtime() of ResultsStart() */
  RunUsage    before;           /* of the parts of the run before this one */
  PetscInt    restarts;         /* how many they are */

  OptionRecord options; /* PETSc's, and how they changed at restarts */
};

/*@
  ResultsCreate - prepares the results of a run; no file is touched before ResultsStart().

  Collective

  Input Parameters:
+ model     - of the run, read at each step
. probes    - of that model
. scene     - of that model
. directory - for the results
- quiet     - nothing is printed but warnings and errors

  Output Parameter:
. result - free it with ResultsDestroy()
@*/
PetscErrorCode ResultsCreate(Model model, Probes probes, Scene scene, const char *directory, PetscBool quiet,
                             Results *result)
{
  Results results;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&results));
  results->model  = model;
  results->probes = probes;
  results->scene  = scene;
  PetscCall(PetscStrncpy(results->directory, directory, sizeof(results->directory)));
  PetscCallMPI(MPI_Comm_rank(model->mesh->comm, &results->rank));
  PetscCall(PetscCalloc3(scene->n_probes, &results->values, scene->n_contacts, &results->met, scene->n_contacts,
                         &results->standing));
  PetscCall(StepsCsvCreate(scene, directory, &results->csv));
  PetscCall(FieldsCreate(model, scene, directory, &results->fields));
  PetscCall(ProbeErrorsCreate(model, probes, scene, &results->errors));
  PetscCall(OptionRecordCreate(&results->options));
  PetscCall(TerminalCreate(model, probes, scene, directory, quiet, &results->terminal));
  *result = results;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ResultsDestroy - closes the files and frees the results; the files stay.

  Collective

  Input Parameter:
. results - set to NULL
@*/
PetscErrorCode ResultsDestroy(Results *results)
{
  PetscFunctionBeginUser;
  if (!*results) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StepsCsvDestroy(&(*results)->csv));
  PetscCall(FieldsDestroy(&(*results)->fields));
  PetscCall(OptionRecordDestroy(&(*results)->options));
  PetscCall(ProbeErrorsDestroy(&(*results)->errors));
  PetscCall(TerminalDestroy(&(*results)->terminal));
  PetscCall(PetscFree3((*results)->values, (*results)->met, (*results)->standing));
  PetscCall(PetscFree(*results));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ResultsGetProbes - gives the values of the probes at the last accepted step.

  Not collective

  Input Parameter:
. results - the results

  Output Parameter:
. values - scene->n_probes, which belong to the results; NULL before the first accepted step
@*/
PetscErrorCode ResultsGetProbes(Results results, const PetscReal **values)
{
  PetscFunctionBeginUser;
  *values = results->stepped ? results->values : NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ResultsGetError - gives the estimated error of a probe at the end of the load.

  Not collective

  Input Parameters:
+ results - of a run whose scene has output.error
- probe   - number of the probe

  Output Parameters:
+ value - of the probe
. why   - why there is no estimate; NULL: there is one
- error - the estimate
@*/
PetscErrorCode ResultsGetError(Results results, int probe, PetscReal *value, const char **why,
                               const QuantityError **error)
{
  PetscFunctionBeginUser;
  *error = ProbeErrorsGet(results->errors, probe, value, why);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ResultsSetHistoryErrors - gives the estimates of a run what its load steps leave of error.

  Not collective

  Input Parameters:
+ results - of a run whose scene has output.error, at its end
. steps   - of each probe: true less computed value
- cpu_s   - CPU seconds that it took to find them
@*/
PetscErrorCode ResultsSetHistoryErrors(Results results, const PetscReal *steps, PetscReal cpu_s)
{
  PetscFunctionBeginUser;
  ProbeErrorsSetHistory(results->errors, steps, cpu_s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the directory back to the loaded checkpoint. */
static PetscErrorCode ResultsResume(Results results)
{
  PetscBool lost = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(FieldsResume(results->fields, &lost));
  if (lost) TerminalWarnLost(results->terminal, "results.vtkhdf", results->last.step);
  if (results->rank) PetscFunctionReturn(PETSC_SUCCESS);
  RunDirectoryClearSummary(results->directory);
  PetscCall(RunDirectoryWriteRecord(results->scene, results->directory));
  PetscCall(StepsCsvResume(results->csv, &lost));
  if (lost) {
    TerminalWarnLost(results->terminal, "steps.csv", results->last.step);
    PetscCall(StepsCsvBegin(results->csv));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ResultsStart - makes the directory with the record of the scene and the head of steps.csv, and prints the first lines.

  Collective

  Input Parameter:
. results - of the run

  Note:
  The time of the run counts from here. After ResultsArchive() has loaded a checkpoint the directory is taken back to it
  instead of being cleared. It refuses a directory that cannot be made or written.
@*/
PetscErrorCode ResultsStart(Results results)
{
  PetscFunctionBeginUser;
  results->started = MPI_Wtime();
  PetscCall(RunDirectoryMake(results->model->mesh->comm, results->directory));
  if (results->restarts)
    PetscCall(ResultsResume(results));
  else if (results->rank == 0) {
    RunDirectoryClear(results->directory);
    PetscCall(RunDirectoryWriteRecord(results->scene, results->directory));
    PetscCall(StepsCsvBegin(results->csv));
  }
  PetscCall(TerminalBegin(results->terminal, results->restarts, results->last.step, &results->options));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Measures how deep the master's nodes stand in the slave. */
static PetscErrorCode ResultsWatchMasters(Results results)
{
  Model model = results->model;

  PetscFunctionBeginUser;
  for (int p = 0; p < results->scene->n_contacts; p++) {
    NodeDepth depth;

    PetscCall(ContactPairMasterDepth(model->contact, p, model->u, model->t, &depth));
    results->standing[p]     = PetscMax(results->standing[p], depth.depth);
    results->standing_over_h = PetscMax(results->standing_over_h, depth.over_h);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the state of the last accepted step into results.vtkhdf. */
static PetscErrorCode ResultsWriteFields(Results results)
{
  PetscFunctionBeginUser;
  PetscCall(FieldsWrite(results->fields, results->last.step, results->last.t));
  PetscCall(ResultsWatchMasters(results));
  results->written = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Notes which pairs have come into contact by now. */
static PetscErrorCode ResultsWatchContact(Results results)
{
  Model model = results->model;

  PetscFunctionBeginUser;
  for (int p = 0; p < results->scene->n_contacts; p++) {
    ContactLoad load;

    if (results->met[p]) continue;
    PetscCall(ContactPairLoad(model->contact, p, model->u, &load));
    results->met[p] = load.force > 0 ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ResultsLastSolution - takes what the results need of the solution at the end of the load, before it is accepted.

  Collective

  Input Parameter:
. results - of the run, after ResultsStart()
@*/
PetscErrorCode ResultsLastSolution(Results results)
{
  PetscFunctionBeginUser;
  PetscCall(ProbeErrorsEstimate(results->errors));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ResultsStep - writes an accepted step: probes, a row of steps.csv, a line on the terminal, and fields where they are
  due.

  Collective

  Input Parameters:
+ results - of the run, after ResultsStart()
- step    - the step, whose state the model is in

  Note:
  Fields are due at every output.every-th step.
@*/
PetscErrorCode ResultsStep(Results results, const StepRecord *step)
{
  const int every = results->scene->output.every;

  PetscFunctionBeginUser;
  PetscCall(ProbesEvaluate(results->probes, results->values));
  PetscCall(ProbeErrorsAccept(results->errors, results->values));
  TimingBegin(TIMING_OUTPUT);
  PetscCall(ResultsWatchContact(results));
  results->last    = *step;
  results->stepped = PETSC_TRUE;
  results->written = PETSC_FALSE;
  results->deepest = PetscMax(results->deepest, step->contact.max_penetration_over_h);
  if (results->rank == 0)
    PetscCall(
      StepsCsvWrite(results->csv, step, results->before.wall_s + MPI_Wtime() - results->started, results->values));
  if (every > 0 && step->step % every == 0) PetscCall(ResultsWriteFields(results));
  TimingEnd(TIMING_OUTPUT);
  TerminalStep(results->terminal, step, MPI_Wtime() - results->started);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ResultsGetUsage - adds up what all parts of the run have used until now.

  Collective

  Input Parameter:
. results - of the run

  Output Parameter:
. usage - the same on all ranks
@*/
PetscErrorCode ResultsGetUsage(Results results, RunUsage *usage)
{
  const RunUsage *before = &results->before;

  PetscFunctionBeginUser;
  PetscCall(RunUsageCollect(results->model->mesh->comm, usage));
  usage->wall_s = before->wall_s + MPI_Wtime() - results->started;
  usage->cpu_s += before->cpu_s;
  usage->peak_rss_mb = PetscMax(usage->peak_rss_mb, before->peak_rss_mb);
  for (int k = 0; k < TIMING_KINDS; k++) usage->seconds[k] += before->seconds[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Saves or takes over the last accepted step, and whether there is one. */
static PetscErrorCode ResultsArchiveStep(Results results, Archive archive)
{
  StepRecord     *last      = &results->last;
  ContactSummary *contact   = &last->contact;
  PetscReal      *real[]    = {&last->t,
                               &last->dt,
                               &last->residual,
                               &last->beta,
                               &results->deepest,
                               &results->standing_over_h,
                               &contact->max_penetration,
                               &contact->min_penetration,
                               &contact->max_penetration_over_h,
                               &contact->penalty_min,
                               &contact->penalty_max,
                               &contact->force,
                               &last->energy.elastic,
                               &last->energy.plastic,
                               &last->energy.work,
                               &last->energy.strain,
                               &last->energy.growth,
                               &last->energy.lag,
                               &last->energy.damping,
                               &last->energy.dissipated,
                               &last->energy.least,
                               &last->energy.outer.work,
                               &last->energy.outer.stored,
                               &last->energy.outer.given,
                               &last->energy.outer.friction,
                               &last->energy.outer.held};
  PetscInt       *integer[] = {&last->step,     &last->attempts, &last->newton, &last->krylov,           &last->tied,
                               &contact->nodes, &contact->in,    &contact->out, &contact->outside_window};

  PetscFunctionBeginUser;
  PetscCall(ArchiveBoolean(archive, "results/stepped", &results->stepped));
  PetscCall(ArchiveBoolean(archive, "results/last_written", &results->written));
  PetscCall(ArchiveRealsAt(archive, "results/step_reals", PETSC_STATIC_ARRAY_LENGTH(real), real));
  PetscCall(ArchiveIntegersAt(archive, "results/step_numbers", PETSC_STATIC_ARRAY_LENGTH(integer), integer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Saves what all parts of the run have used, or takes it over as used before this part. */
static PetscErrorCode ResultsArchiveUsage(Results results, Archive archive)
{
  RunUsage   usage    = {0};
  PetscReal *used[]   = {&usage.wall_s, &usage.cpu_s, &usage.peak_rss_mb};
  PetscInt   restarts = results->restarts;

  PetscFunctionBeginUser;
  if (!ArchiveLoads(archive)) PetscCall(ResultsGetUsage(results, &usage));
  PetscCall(ArchiveRealsAt(archive, "results/used", PETSC_STATIC_ARRAY_LENGTH(used), used));
  PetscCall(ArchiveReals(archive, "results/seconds", TIMING_KINDS, usage.seconds));
  PetscCall(ArchiveIntegers(archive, "results/restarts", 1, &restarts));
  if (!ArchiveLoads(archive)) PetscFunctionReturn(PETSC_SUCCESS);
  results->before   = usage;
  results->restarts = restarts + 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ResultsArchive - saves or takes over what the directory holds up to the last accepted step.

  Collective

  Input Parameters:
+ results - of the run
- archive - the checkpoint

  Note:
  Saving also sends steps.csv to the disk. Loading comes between ResultsCreate() and ResultsStart(), which then takes
  the files of the directory back to this step; no file is touched before.
@*/
PetscErrorCode ResultsArchive(Results results, Archive archive)
{
  PetscFunctionBeginUser;
  PetscCall(ResultsArchiveStep(results, archive));
  PetscCall(OptionRecordArchive(&results->options, results->last.step, archive));
  PetscCall(ArchiveReals(archive, "results/standing", results->scene->n_contacts, results->standing));
  PetscCall(ArchiveReals(archive, "results/probes", results->scene->n_probes, results->values));
  for (int p = 0; p < results->scene->n_contacts; p++) {
    char name[ARCHIVE_NAME_SIZE];

    PetscCall(PetscSNPrintf(name, sizeof(name), "results/met/%d", p));
    PetscCall(ArchiveBoolean(archive, name, &results->met[p]));
  }
  PetscCall(StepsCsvArchive(results->csv, archive));
  PetscCall(ResultsArchiveUsage(results, archive));
  PetscCall(FieldsArchive(results->fields, archive));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ResultsFinish - writes the last accepted state into results.vtkhdf unless it is there, summary.json, and the last
lines on the terminal.

  Collective

  Input Parameters:
+ results - of the run
- run     - how it ended

  Note:
  To be called however the run ended, with the model in its last accepted state. A message in the record goes to stderr,
  also when quiet.
@*/
PetscErrorCode ResultsFinish(Results results, const RunRecord *run)
{
  RunUsage     usage;
  RunFigures   figures;
  PetscReal   *apart;
  TerminalLast last = {.figures = &figures, .probes = results->values, .deepest = results->deepest};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(results->scene->n_contacts, &apart));
  last.apart = apart;
  last.met   = (PetscBool)!results->stepped;
  for (int p = 0; p < results->scene->n_contacts; p++) {
    apart[p] = -1;
    last.met = (PetscBool)(last.met || results->met[p]);
    if (results->stepped && !results->met[p] && !results->scene->contacts[p].listed) /* most of a list never meet */
      PetscCall(ContactPairDistance(results->model->contact, p, results->model->u, results->model->t, &apart[p]));
  }
  TimingBegin(TIMING_OUTPUT);
  if (results->stepped && !results->written) PetscCall(ResultsWriteFields(results));
  if (results->written)
    PetscCall(ErrorFieldsWrite(results->model->mesh, results->scene, results->errors, results->directory));
  TimingEnd(TIMING_OUTPUT);
  PetscCall(ResultsGetUsage(results, &usage));
  usage.wall_s = results->before.wall_s + run->wall_s;
  PetscCall(RunFiguresCollect(results->model, results->scene, run, &usage, results->restarts,
                              results->stepped ? &results->last : NULL, &figures));
  figures.errors          = results->errors;
  figures.options_changed = results->options.changes;
  figures.results_bytes   = RunResultsBytes(results->directory);
  for (int p = 0; p < figures.n_pairs; p++)
    figures.pairs[p].master_deepest = PetscMax(figures.pairs[p].master.depth, results->standing[p]);
  last.standing = results->standing_over_h;
  if (!results->rank) PetscCall(SummaryWrite(results->model->mesh, &figures, results->directory, results->values));
  PetscCall(TerminalEnd(results->terminal, &last));
  PetscCall(PetscFree(apart));
  PetscCall(RunFiguresDestroy(&figures));
  PetscFunctionReturn(PETSC_SUCCESS);
}
