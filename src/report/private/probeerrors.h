/* The estimated errors of a run's probes: made once at its end, then printed, and written to summary.json.

   ProbeErrorsCreate() makes the object where the scene asks for it, else NULL, which all functions take.
   ProbeErrorsEstimate() is called at the solution of the last step, before it is accepted, and ProbeErrorsAccept() once
   it is. */
#pragma once
#include <stdio.h>
#include "errors/contactzone.h"
#include "errors/quantityerror.h"
#include "report/probevariation.h"

typedef struct _n_ProbeErrors *ProbeErrors;

PetscErrorCode       ProbeErrorsCreate(Model, Probes, Scene, ProbeErrors *);
PetscErrorCode       ProbeErrorsDestroy(ProbeErrors *);
void                 ProbeErrorsSetHistory(ProbeErrors, const PetscReal *steps, PetscReal cpu_s);
PetscReal            ProbeErrorsHistorySeconds(ProbeErrors);
PetscErrorCode       ProbeErrorsEstimate(ProbeErrors);
PetscErrorCode       ProbeErrorsAccept(ProbeErrors, const PetscReal *values);
const QuantityError *ProbeErrorsGet(ProbeErrors, int probe, PetscReal *value, const char **why);
const ContactZone   *ProbeErrorsZone(ProbeErrors, int pair);
void                 ProbeErrorsPrint(ProbeErrors, FILE *);
void                 ProbeErrorsWarn(ProbeErrors);
