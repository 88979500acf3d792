/* The result directory: results.h5 with results.xdmf, steps.csv, summary.json, progress on the terminal. Does not know
   how values were computed.

   ResultsCheckDirectory() comes first, before anything is written or solved; ResultsStart() makes the directory. A
   record of the scene (scene.yaml: the file's name, then its text after -set) tells the next run whose results lie
   there. */
#pragma once
#include "solve/model.h"
#include "report/probe.h"
#include "step/stepper.h"
#include "base/timing.h"

typedef struct _n_Results *Results;

/* What all ranks together have used */
typedef struct {
  PetscReal seconds[TIMING_KINDS]; /* wall, of the slowest rank for each purpose */
  PetscReal wall_s, cpu_s,
    peak_rss_mb; /* wall_s: of the run; cpu_s: sum over the ranks; peak_rss_mb: the largest rank's */
} RunUsage;

/* The run as a whole, for summary.json */
typedef struct {
  const char          *status;  /* "done", "not converged", "stopped" */
  const char          *message; /* cause, or NULL */
  PetscReal            wall_s, mesh_s;
  const StepperReport *way; /* counts, guards that acted, where it failed */
} RunRecord;

/* Refuses a directory that holds another scene's results unless overwrite. To be called before anything is written or
 * solved. Collective. */
PetscErrorCode ResultsCheckDirectory(MPI_Comm, Scene, const char *directory, PetscBool overwrite);
/* Refuses (exit 1) a path that is too long for the results, whether or not the directory is there. Collective. */
PetscErrorCode ResultsCheckPath(MPI_Comm, const char *directory);
/* Refuses a directory whose record is of another problem than the checkpoint in it. Collective. */
PetscErrorCode ResultsCheckRestart(MPI_Comm, Scene, const char *directory);
PetscErrorCode ResultsCreate(Model, Probes, Scene, const char *directory, PetscBool quiet, Results *);
PetscErrorCode ResultsDestroy(Results *);
PetscErrorCode ResultsStart(Results); /* the first lines: version, ranks, BLAS, solver, bodies, effects */
/* Results up to the last accepted step. Loaded, ResultsStart() takes the directory back to them instead of clearing it.
 * Collective. */
PetscErrorCode ResultsArchive(Results, Archive);
PetscErrorCode ResultsGetProbes(Results, const PetscReal **values);
PetscErrorCode ResultsStep(Results, const StepRecord *);  /* an accepted step: CSV row, progress line, fields if due */
PetscErrorCode ResultsFinish(Results, const RunRecord *); /* last fields, summary.json, last line on the terminal */
/* Writes a text file of the directory under a temporary name, then renames it: it is there whole or not at all. Not
 * collective. */
PetscErrorCode ResultsReplaceFile(const char *directory, const char *name, const char *text);
