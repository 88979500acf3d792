/* The figures of a finished run, collected once by RunFiguresCollect(). summary.json writes them, the last screen
   prints them, and advice judges them. RunUsageCollect() is also used between steps, for a checkpoint. */
#pragma once
#include "base/blas.h"
#include "probeerrors.h"
#include "report/results.h"
#include "base/timing.h"

/* A contact pair in the last accepted state */
typedef struct {
  const char         *name;
  const SceneContact *scene;
  ContactFits         fits;
  ContactQuality      quality;
  ContactWindow       window;
  ContactFriction     friction;
  PetscReal           penalty_min, penalty_max;
  PetscReal           scatter;        /* of the nodal pressures, over their smooth part; NaN: not known */
  NodeDepth           master;         /* the master's nodes in the slave */
  PetscReal           master_deepest; /* their largest depth in all written states (length) */
  PenaltyError        penalty_error;
  PetscReal           geometry; /* distance of facets and smooth surface where it presses, over the penetration */
  PetscReal           stick_stiffened; /* factor on the automatic penalty of what sticks */
  PetscBool           penalty_stays;   /* stiffer penalties have not lowered that error */
  PetscReal           stiffened;       /* factor by which the run raised the penalty, where it may choose it */
} PairFigures;

typedef struct {
  Scene              scene;
  const RunRecord   *run;
  const StepRecord  *last; /* NULL: no step was accepted */
  int                ranks;
  PetscInt           dofs;
  char               effects[1024];
  RunUsage           usage;         /* of all parts of the run */
  PetscReal          results_bytes; /* size of results.vtkhdf */
  PetscInt           restarts;      /* their number less one */
  LinearCounts       linear;
  const char        *options_changed; /* lines, see optionrecord.h */
  PetscBool          direct;          /* the solver factors each tangent, for which it uses the BLAS */
  Blas               blas;            /* of this rank */
  PetscReal          stored;          /* energy in elements and contact; 0 where no step was damped */
  PetscBool          free_bodies;     /* some bodies are held by contact alone */
  char               moved[512];      /* which of them were moved into contact, and how far */
  char               loose[512];      /* their motions that only springs hold */
  int                n_pairs;
  PairFigures       *pairs;
  CertificateFigures certificate;
  PetscBool          certified; /* all accepted steps were judged and hold */
  int                n_fluids;
  FluidReport       *fluids;
  PetscReal         *variation; /* of each body: see errors/strainvariation.h */
  ProbeErrors        errors;    /* of the probes; NULL: not asked for */
} RunFigures;

PetscErrorCode RunUsageCollect(MPI_Comm, RunUsage *);
PetscErrorCode RunFiguresCollect(Model, Scene, const RunRecord *, const RunUsage *, PetscInt restarts,
                                 const StepRecord *last, RunFigures *);
PetscErrorCode RunFiguresDestroy(RunFigures *);
