/* The estimated errors of a run's probes, see probeerrors.h. */
#include "probeerrors.h"
#include <math.h>

/* The end of a zone of contact is told of where it may leave more than this part of the forces: so much the run lets
   penetration leave. */
#define PROBEERRORS_ZONE 0.004
/* Zones with less than this part of the forces of the most loaded one are not told of. */
#define PROBEERRORS_LIGHT 0.01

struct _n_ProbeErrors {
  Model          model;
  Probes         probes;
  Scene          scene;
  PetscReal     *value; /* of each probe */
  const char   **why;   /* why there is no estimate of it; NULL: there is one */
  QuantityError *error;
  ContactZone   *zone;      /* of each pair */
  PetscBool      estimated; /* at a solution that is not accepted yet */
  PetscReal      history_s; /* CPU seconds of the run that gave what the load steps leave; NaN: there was none */
  PetscLogEvent  event;
};

/*@
  ProbeErrorsCreate - makes room for the errors of all probes.

  Not collective

  Input Parameters:
+ model  - of the run
. probes - of that model
- scene  - of that model

  Output Parameter:
. result - NULL: the scene does not ask for them
@*/
PetscErrorCode ProbeErrorsCreate(Model model, Probes probes, Scene scene, ProbeErrors *result)
{
  ProbeErrors  errors;
  PetscClassId classid;

  PetscFunctionBeginUser;
  *result = NULL;
  if (!scene->output.error) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&errors));
  errors->model     = model;
  errors->probes    = probes;
  errors->scene     = scene;
  errors->history_s = NAN;
  PetscCall(PetscCalloc4(scene->n_probes, &errors->value, scene->n_probes, &errors->why, scene->n_probes,
                         &errors->error, ContactPairs(model->contact), &errors->zone));
  for (int i = 0; i < scene->n_probes; i++) errors->why[i] = "the run ended before the end of its load";
  PetscCall(PetscClassIdRegister("ProbeErrors", &classid));
  PetscCall(PetscLogEventRegister("ProbeErrors", classid, &errors->event));
  *result = errors;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProbeErrorsDestroy - frees the errors.

  Not collective

  Input Parameter:
. errors - set to NULL; may be NULL already
@*/
PetscErrorCode ProbeErrorsDestroy(ProbeErrors *errors)
{
  PetscFunctionBeginUser;
  if (!*errors) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; i < (*errors)->scene->n_probes; i++) PetscCall(QuantityErrorReset(&(*errors)->error[i]));
  PetscCall(PetscFree4((*errors)->value, (*errors)->why, (*errors)->error, (*errors)->zone));
  PetscCall(PetscFree(*errors));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the zones of contact, and by how much of itself the share of each cell may be off as they end elsewhere. */
static PetscErrorCode FindZones(ProbeErrors errors, PetscReal *off)
{
  const Mesh mesh = errors->model->mesh;
  PetscBool *behind;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_cells, &behind));
  for (int p = 0; p < ContactPairs(errors->model->contact); p++) {
    PetscCall(ContactZoneOfPair(errors->model, p, behind, &errors->zone[p]));
    for (PetscInt c = 0; c < mesh->n_cells; c++)
      if (behind[c]) off[c] = PetscMax(off[c], ContactZoneOff(&errors->zone[p]));
  }
  PetscCall(PetscFree(behind));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Estimates the errors of those probes that have a first variation. */
static PetscErrorCode Estimate(ProbeErrors errors, const PetscReal *off, Functional *functional)
{
  const int      all = errors->scene->n_probes;
  int            n   = 0, *probe;
  QuantityError *error;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(all, &probe, all, &error));
  for (int i = 0; i < all; i++) {
    PetscCall(ProbeVary(errors->probes, i, &functional[n], &errors->why[i]));
    if (errors->why[i]) PetscCall(ProbeVariationFree(&functional[n]));
    probe[n] = i;
    n += !errors->why[i];
  }
  PetscCall(QuantityErrorsEstimate(errors->model, n, functional, off, error));
  for (int k = 0; k < n; k++) {
    errors->error[probe[k]] = error[k];
    errors->why[probe[k]]   = error[k].why;
    PetscCall(ProbeVariationFree(&functional[k]));
  }
  PetscCall(PetscFree2(probe, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProbeErrorsEstimate - estimates the errors of all probes at the model's present solution.

  Collective

  Input Parameter:
. errors - may be NULL

  Note:
  To be called before the solution is accepted: states of plastic bodies and of friction are those of the step then.
@*/
PetscErrorCode ProbeErrorsEstimate(ProbeErrors errors)
{
  const int   wanted = errors ? errors->scene->accuracy.probe : -1;
  Functional *functional;
  PetscReal  *off;
  Model       model;
  PetscBool   ok;

  PetscFunctionBeginUser;
  if (!errors || !errors->scene->n_probes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscLogEventBegin(errors->event, 0, 0, 0, 0));
  model = errors->model;
  PetscCall(ProblemSetTrial(model->problem, model->x, model->t));
  PetscCall(ProblemResidual(model->problem, model->problem->trial, model->t, model->t, &ok));
  PetscCall(ProbesEvaluate(errors->probes, errors->value)); /* first variations take their signs from here */
  PetscCall(PetscCalloc2(errors->scene->n_probes, &functional, model->mesh->n_cells, &off));
  PetscCall(FindZones(errors, off));
  PetscCall(Estimate(errors, off, functional));
  if (wanted >= 0 && errors->why[wanted]) {
    PetscCall(QuantityErrorReset(&errors->error[wanted]));
    PetscCall(QuantityErrorShares(model, &errors->error[wanted]));
  }
  PetscCall(PetscFree2(functional, off));
  errors->estimated = PETSC_TRUE;
  PetscCall(PetscLogEventEnd(errors->event, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProbeErrorsAccept - takes the values of the probes in the accepted state, which some probes have from there on alone,
  such as the pressure that a seal holds.

  Not collective

  Input Parameters:
+ errors - after ProbeErrorsEstimate(); may be NULL
- values - of all probes
@*/
PetscErrorCode ProbeErrorsAccept(ProbeErrors errors, const PetscReal *values)
{
  PetscFunctionBeginUser;
  if (!errors || !errors->estimated) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArraycpy(errors->value, values, errors->scene->n_probes));
  for (int i = 0; i < errors->scene->n_probes; i++) {
    if (!errors->why[i] || !errors->error[i].shared) continue;
    if (PetscIsInfOrNanReal(values[i]))
      PetscCall(QuantityErrorReset(&errors->error[i]));
    else
      QuantityErrorScale(values[i], &errors->error[i]);
  }
  errors->estimated = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProbeErrorsGet - gives the error of a probe.

  Not collective

  Input Parameters:
+ errors - the errors
- probe  - number of the probe

  Output Parameters:
+ value - of the probe
- why   - why there is no estimate; NULL: there is one. The error of the probe whose accuracy the scene asks for then
          has what QuantityErrorShares() knows
@*/
const QuantityError *ProbeErrorsGet(ProbeErrors errors, int probe, PetscReal *value, const char **why)
{
  *value = errors->value[probe];
  *why   = errors->why[probe];
  return &errors->error[probe];
}

/*@
  ProbeErrorsZone - gives the zone of contact of a pair, of which no estimate holds the end.

  Not collective

  Input Parameters:
+ errors - the errors
- pair   - number of the pair
@*/
const ContactZone *ProbeErrorsZone(ProbeErrors errors, int pair)
{
  return &errors->zone[pair];
}

/*@
  ProbeErrorsSetHistory - gives the estimates what the load steps leave of error.

  Not collective

  Input Parameters:
+ errors - the errors
. steps  - of each probe: true less computed value
- cpu_s  - CPU seconds that it took to find them
@*/
void ProbeErrorsSetHistory(ProbeErrors errors, const PetscReal *steps, PetscReal cpu_s)
{
  errors->history_s = cpu_s;
  for (int i = 0; i < errors->scene->n_probes; i++)
    if (!errors->why[i]) QuantityErrorSetSteps(&errors->error[i], steps[i]);
}

/*@
  ProbeErrorsHistorySeconds - returns the CPU seconds of the run that gave what the load steps leave; NaN: none did.

  Not collective

  Input Parameter:
. errors - the errors
@*/
PetscReal ProbeErrorsHistorySeconds(ProbeErrors errors)
{
  return errors->history_s;
}

/* Prints one probe: the sum, then its parts. Where these cancel, what the error may be stands first. */
static void PrintError(const char *name, PetscReal value, const QuantityError *error, FILE *stream)
{
  const double part = value != 0 ? 100 / fabs((double)value) : NAN;

  fprintf(stream, "error    %s: ", name);
  if (QuantityErrorCancels(error)) {
    fprintf(stream, "up to +-%.3g", (double)error->uncertain);
    if (isfinite(part)) fprintf(stream, " (%.2g %%)", part * (double)error->uncertain);
    fprintf(stream, ", with either sign, as its parts cancel: ");
  }
  fprintf(stream, "%+.3g", (double)error->sum);
  if (isfinite(part)) fprintf(stream, " (%+.2g %%)", part * (double)error->sum);
  fprintf(stream, " =");
  for (int c = 0; c < ERROR_CAUSES; c++) {
    if (error->part[c] == 0) continue;
    if (isnan((double)error->part[c]))
      fprintf(stream, " %s not included", ErrorCauses[c]);
    else
      fprintf(stream, " %s %+.3g", ErrorCauses[c], (double)error->part[c]);
    if (isfinite(part) && !isnan((double)error->part[c])) fprintf(stream, " (%+.2g %%)", part * (double)error->part[c]);
  }
  fprintf(stream, "\n");
  if (!QuantityErrorCancels(error)) return;
  fprintf(stream, "         the shares of the elements have a magnitude of %.3g", (double)error->spread);
  if (isfinite(part)) fprintf(stream, " (%.2g %%)", part * (double)error->spread);
  fprintf(stream, "\n");
}

/*@
  ProbeErrorsPrint - prints the estimated errors, true less computed values.

  Not collective

  Input Parameters:
+ errors - may be NULL
- stream - where to
@*/
void ProbeErrorsPrint(ProbeErrors errors, FILE *stream)
{
  for (int i = 0; errors && i < errors->scene->n_probes; i++) {
    const char *name = errors->scene->probes[i].name;

    if (errors->why[i])
      fprintf(stream, "error    %s: not estimated: %s\n", name, errors->why[i]);
    else
      PrintError(name, errors->value[i], &errors->error[i], stream);
  }
  if (errors && !isnan((double)errors->history_s))
    fprintf(stream, "error    what the load steps leave: by a second run, CPU %.2f s\n", (double)errors->history_s);
}

/*@
  ProbeErrorsWarn - warns of zones of contact with so few faces that what no estimate sees may be large.

  Not collective

  Input Parameter:
. errors - may be NULL

  Note:
  Nothing is said where meshes follow each other until an accuracy is reached: there the change of the answer counts.
@*/
void ProbeErrorsWarn(ProbeErrors errors)
{
  const Contact contact = errors ? errors->model->contact : NULL;
  PetscReal     most    = 0;

  if (!errors || errors->scene->accuracy.probe >= 0) return;
  for (int p = 0; p < ContactPairs(contact); p++) most = PetscMax(most, errors->zone[p].force);
  for (int p = 0; p < ContactPairs(contact); p++) {
    const ContactZone *zone = &errors->zone[p];
    const PetscReal    left = ContactZoneLeft(zone);

    if (!(left > PROBEERRORS_ZONE) || zone->force < PROBEERRORS_LIGHT * most) continue;
    fprintf(stderr,
            "burnish: warning: contact '%s': its zone has %g face%s of '%s' from its end to its middle, so that its "
            "end may leave up to %.2g %% of its forces, which no estimated error holds; %g faces leave %g %%: finer "
            "elements there, or meshes of the run's own choice (-to) [B156]\n",
            ContactPairName(contact, p), (double)zone->layers, zone->layers > 1 ? "s" : "",
            ContactPairScene(contact, p)->slave, 100 * (double)left, (double)ContactZoneLayers(PROBEERRORS_ZONE),
            100 * PROBEERRORS_ZONE);
  }
}
