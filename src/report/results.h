/* The results of a run: its directory with results.vtkhdf, results.xdmf, steps.csv and summary.json, and the progress
   on the terminal. Ties the parts that write them; does not know how values were computed.

   ResultsCreate() touches no file. ResultsStart() makes the directory and prints the first lines, ResultsStep() writes
   each accepted step, ResultsLastSolution() comes before the last one is accepted, ResultsFinish() ends the run however
   it went. ResultsArchive() keeps the state of all this in a checkpoint; loaded before ResultsStart(), it lets the run
   go on in the same files. Which directory may be used is decided before, by rundirectory.h. */
#pragma once
#include "errors/quantityerror.h"
#include "solve/model.h"
#include "report/probe.h"
#include "step/stepper.h"
#include "base/timing.h"

typedef struct _n_Results *Results;

/* What all ranks together have used */
typedef struct {
  PetscReal seconds[TIMING_KINDS]; /* wall time by purpose, of the slowest rank for each (s) */
  PetscReal wall_s;                /* of the run */
  PetscReal cpu_s;                 /* sum over the ranks */
  PetscReal peak_rss_mb;           /* the largest rank's */
} RunUsage;

/* The run as a whole, for summary.json */
typedef struct {
  const char          *status;  /* "done", "not converged", "stopped" */
  const char          *message; /* cause, or NULL */
  PetscReal            wall_s, mesh_s;
  const StepperReport *way; /* counts, guards that acted, where it failed */
} RunRecord;

PetscErrorCode ResultsCreate(Model, Probes, Scene, const char *directory, PetscBool quiet, Results *);
PetscErrorCode ResultsDestroy(Results *);
PetscErrorCode ResultsStart(Results);
PetscErrorCode ResultsLastSolution(Results);
PetscErrorCode ResultsStep(Results, const StepRecord *);
PetscErrorCode ResultsFinish(Results, const RunRecord *);
PetscErrorCode ResultsArchive(Results, Archive);
PetscErrorCode ResultsGetProbes(Results, const PetscReal **values);
PetscErrorCode ResultsSetHistoryErrors(Results, const PetscReal *steps, PetscReal cpu_s);
PetscErrorCode ResultsGetError(Results, int probe, PetscReal *value, const char **why, const QuantityError **);
PetscErrorCode ResultsGetUsage(Results, RunUsage *);
