/* The figures of a finished run, collected once: summary.json writes them, the last screen prints them, advice judges
 * them. */
#pragma once
#include "base/blas.h"
#include "report/results.h"
#include "base/timing.h"

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
  RunUsage          usage;    /* of all parts of the run */
  PetscInt          restarts; /* their number less one */
  LinearCounts      linear;
  const char       *options_changed; /* lines, see optionrecord.h */
  PetscBool         direct;          /* the solver factors each tangent, which is the BLAS's work */
  Blas              blas;            /* of this rank */
  int               n_pairs;
  PairFigures      *pairs;
} RunFigures;

/* What this program has used since it started, over all ranks; wall_s is left alone. Collective. */
PetscErrorCode RunUsageCollect(MPI_Comm, RunUsage *);
/* Borrows scene, run and last. Collective. */
PetscErrorCode RunFiguresCollect(Model, Scene, const RunRecord *, const RunUsage *, PetscInt restarts,
                                 const StepRecord *last, RunFigures *);
PetscErrorCode RunFiguresDestroy(RunFigures *);
/* The error of the surface that a pair is solved with (length): of the fits, or of the facets; 0: analytic or flat */
PetscReal PairSurfaceError(const PairFigures *);
