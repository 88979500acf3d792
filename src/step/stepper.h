/* The load stepper: takes a model from t = 0 to t = 1. An object in the manner of TS (Create, Set..., Solve, Monitor,
   View), with what a quasi-static contact problem needs: a step is accepted or taken back whole, and steps land exactly
   on 1, on every `at` of the scene and on every breakpoint of a history. How dt follows from what happened is a step
   control, chosen by name (stepcontrol.h).

     LoadStepperCreate(); LoadStepperSetModel(); LoadStepperSetFromScene(); LoadStepperSetFromOptions();
   LoadStepperMonitorSet(); LoadStepperSolve()

   A stepper that has loaded its state goes on from there. */
#pragma once
#include "solve/model.h"

/* One accepted step */
typedef struct {
  PetscInt       step, attempts, newton, krylov; /* newton and krylov: failed attempts before it included */
  PetscReal      t, dt, residual;
  PetscReal      beta; /* beta_{N_c}; NaN: not the control by contact, or no node approached */
  PetscInt       tied; /* nodes that touched together beyond those wanted, as no step separates them */
  ContactSummary contact;
} StepRecord;

/* The way so far */
typedef struct {
  PetscBool done, stopped;                       /* t = 1 was reached; LoadStepperStop() ended it before */
  PetscInt  steps, steps_failed, steps_repeated; /* repeated: converged, but taken back by the control */
  PetscInt  newton_iterations, newton_accepted, krylov_iterations;
  PetscInt  relaxed; /* times that the springs of stabilised pairs were relaxed */
  PetscReal taken,
    left; /* energy that they took out; the largest part of an accepted state's energy that was left in them */
  PetscInt  cycles, cycles_cut;         /* times a contact set repeated itself; steps that failed for it */
  char      cycle[512];                 /* the last time: load parameter, period, nodes */
  PetscInt  regathered, adjusted, cuts; /* of SolveReport, all solves */
  PetscReal t;                          /* of the last good state */
  char      message[1024];              /* why it ended early: cause, load parameter, nodes, what was tried */
  struct {
    SolveReport solve;          /* the last attempt */
    PetscInt    attempts;       /* of that step */
    PetscReal   t, first, last; /* load parameter that was not reached; dt tried */
  } failed;                     /* if it is not done */
} StepperReport;

typedef struct _n_LoadStepper *LoadStepper;
typedef PetscErrorCode (*LoadStepperMonitorFn)(LoadStepper, const StepRecord *, void *);

PetscErrorCode LoadStepperCreate(MPI_Comm, LoadStepper *);
PetscErrorCode LoadStepperDestroy(LoadStepper *);
PetscErrorCode LoadStepperSetModel(LoadStepper, Model);
PetscErrorCode LoadStepperSetFromScene(LoadStepper, Scene);
PetscErrorCode LoadStepperSetFromOptions(LoadStepper);
PetscErrorCode LoadStepperMonitorSet(LoadStepper, LoadStepperMonitorFn, void *);
PetscErrorCode LoadStepperStop(LoadStepper); /* from the monitor: no step after this one. Logically collective */
PetscErrorCode LoadStepperSolve(LoadStepper, StepperReport *);
/* Step size and counts, as they were at the last accepted step: from the monitor, after LoadStepperSolve(), or loading
 * before it. Collective. */
PetscErrorCode LoadStepperArchive(LoadStepper, Archive);
PetscErrorCode LoadStepperView(LoadStepper, PetscViewer);
