/* The figures of a finished run, collected once: summary.json writes them, the last screen prints them, advice judges them. */
#pragma once
#include "results.h"
#include "timing.h"

/* A contact pair in the last accepted state */
typedef struct {
  const char         *name;
  const SceneContact *scene;
  ContactFits         fits;
  ContactQuality      quality;
  ContactWindow       window;
  PetscReal           penalty_min, penalty_max;
} PairFigures;

typedef struct {
  Scene             scene;
  const RunRecord  *run;
  const StepRecord *last; /* NULL: no step was accepted */
  int               ranks;
  PetscInt          dofs;
  char              effects[1024];
  PetscReal         seconds[TIMING_KINDS]; /* wall, of the slowest rank for each purpose */
  PetscReal         cpu_s, peak_rss_mb;    /* all ranks, largest rank */
  int               n_pairs;
  PairFigures      *pairs;
} RunFigures;

/* Borrows scene, run and last. Collective. */
PetscErrorCode RunFiguresCollect(Model, Scene, const RunRecord *, const StepRecord *last, RunFigures *);
PetscErrorCode RunFiguresDestroy(RunFigures *);
/* The error of the surface that a pair is solved with (length): of the fits, or of the facets; 0: analytic or flat */
PetscReal PairSurfaceError(const PairFigures *);
