/* The load stepper: it takes a model from its load parameter t to 1, in steps that are accepted or taken back whole.

   It is an object in the manner of PETSc's TS. The calls are LoadStepperCreate(), LoadStepperSetModel(),
   LoadStepperSetFromScene(), LoadStepperSetFromOptions(), LoadStepperMonitorSet() and LoadStepperSolve(), in this
   order. Steps end exactly on 1, on every `at` of the scene and on every breakpoint of a history. A step control, which
   the scene chooses by name (stepcontrol.h), decides how dt follows from what happened. A stepper that has loaded its
   state by LoadStepperArchive() goes on from there. */
#pragma once
#include "solve/model.h"

/* One accepted step. */
typedef struct {
  PetscInt       step;
  PetscInt       attempts;       /* solves that were tried for this step */
  PetscInt       newton, krylov; /* iterations, those of failed attempts before it included */
  PetscReal      t, dt;
  PetscReal      residual; /* |R|_2 / F_ref */
  PetscReal      beta;     /* beta_{N_c}; NaN: another control than that by contact, or no node approached */
  PetscInt       tied;     /* nodes beyond those wanted that touched together, so that no step separates them */
  ContactSummary contact;
  EnergyFigures  energy; /* of the accepted state; zero where the model has no balance */
} StepRecord;

/* All steps so far. */
typedef struct {
  PetscBool done;                                /* t = 1 was reached, or a fluid leaks */
  PetscBool leaks;                               /* a fluid leaks: the load ends before t = 1 */
  PetscBool stopped;                             /* LoadStepperStop() ended it before */
  PetscInt  steps, steps_failed, steps_repeated; /* repeated: taken back, to touch or move less, or to find a leak */
  PetscInt  newton_iterations, newton_accepted, krylov_iterations;
  PetscInt  relaxed;        /* times that the contact springs were relaxed */
  PetscReal taken;          /* energy that the contact springs took out of the bodies */
  PetscReal left;           /* largest part of an accepted state's energy that was left in them */
  PetscReal share;          /* their forces in the last accepted state, over F_ref */
  PetscReal tied;           /* largest force of a tie there, over F_ref */
  PetscReal unstable;       /* how unstable a tied motion was, as a part of its body's stiffness, in the worst step */
  PetscReal friction;       /* coefficient of friction that would hold what held a soft motion, in the worst step */
  PetscInt  held;           /* accepted steps in which one was held */
  PetscInt  motions;        /* most of them that were held at the end of an accepted step */
  PetscInt  unstable_steps; /* accepted steps that ended in an unstable equilibrium, as far as it is known */
  PetscInt  negatives;      /* negative eigenvalues of the tangent in the last accepted state that they are known of */
  PetscReal gives;          /* energy that the unstable motion gives there, over what is stored; 0: it is stable */
  PetscInt  most_negatives; /* most of them */
  PetscReal unstable_from;  /* load parameter of the first of the accepted states up to the last one that have any */
  PetscInt  cycles;         /* times that a contact set repeated itself */
  PetscInt  cycles_cut;     /* steps that failed because of that */
  char      cycle[512];     /* the last repetition: load parameter, period, nodes */
  PetscInt  jumps;          /* accepted steps that ended in another equilibrium */
  char      jump[512];      /* the last of them: load parameters, node, distance */
  PetscInt  damped;         /* accepted steps that needed a viscous restraint */
  PetscReal damping;        /* energy that it took in them */
  PetscInt  regathered, adjusted, turned; /* of SolveReport, for all solves */
  PetscInt  wetted;                       /* likewise */
  PetscInt  cuts[CUT_CAUSES];             /* likewise */
  PetscReal t;                            /* of the last accepted state */
  char      message[1024];                /* why it ended early: cause, load parameter, nodes, what was tried */
  struct {
    SolveReport solve;       /* of the last attempt */
    PetscInt    attempts;    /* of that step */
    PetscReal   t;           /* load parameter that was not reached */
    PetscReal   first, last; /* dt of the first and of the last attempt */
  } failed;                  /* the step that failed, if done and stopped are false */
} StepperReport;

typedef struct _n_LoadStepper *LoadStepper;
typedef PetscErrorCode (*LoadStepperMonitorFn)(LoadStepper, const StepRecord *, void *);
typedef PetscErrorCode (*LoadStepperLastFn)(void *);

PetscErrorCode LoadStepperCreate(MPI_Comm, LoadStepper *);
PetscErrorCode LoadStepperDestroy(LoadStepper *);
PetscErrorCode LoadStepperSetModel(LoadStepper, Model);
PetscErrorCode LoadStepperSetFromScene(LoadStepper, Scene);
PetscErrorCode LoadStepperSetFromOptions(LoadStepper);
PetscErrorCode LoadStepperMonitorSet(LoadStepper, LoadStepperMonitorFn, void *);
PetscErrorCode LoadStepperLastSet(LoadStepper, LoadStepperLastFn, void *);
PetscErrorCode LoadStepperStop(LoadStepper);
PetscErrorCode LoadStepperSolve(LoadStepper, StepperReport *);
PetscErrorCode LoadStepperArchive(LoadStepper, Archive);
PetscInt       LoadStepperCuts(const StepperReport *);
PetscErrorCode LoadStepperView(LoadStepper, PetscViewer);
