/* The load stepper: tries load steps, lets them land on required load parameters, accepts them or takes them back. */
#include "step/stepper.h"
#include "stepcontrol.h"

/* Load parameters that are closer than this are the same one; t runs from 0 to 1. */
#define STEPPER_SAME_T 1e-12
/* Steps aim at this part of the bounds on plastic flow and on the travel of contact, so that few are taken back. */
#define STEPPER_STRAIN 0.8
/* Points that begin to flow in a step have no direction to compare with, so that the lag of their stresses is not
   known. In the mean over the step's plastic work they flow by at most so many times their elastic strain. An elastic
   strain that turns no longer matters then, and the next step can tell how the flow turns. */
#define STEPPER_BEGUN 20
/* A step that was shortened for its lag or its travel is to have at most this part of that of the attempt before, which
   was 1.4 times as long or longer. Else its length is not the cause, and shorter steps would not help. */
#define STEPPER_GAIN 0.9
/* Faces of a body that lie opposite other faces of it may turn by this angle (radians) in a step. Lists of its start
   hold what faces a point there, and as two sides turn, half of the 60 degrees that a normal in a fit may be off is
   what each has. A tube that is flattened until its inner wall touches loses points with 35 degrees, and with more the
   ends of its fold pass through each other. */
#define STEPPER_FACING (PETSC_PI / 6)
/* A failed step is tried again with this part of its dt. */
#define STEPPER_CUT 0.5
/* The load at which depths exceed what the certificate allows is sought to this part of load and depth. What is allowed
   is no more accurate. */
#define STEPPER_DEPTH 0.02
/* A step stretches to the next landing point if that is at most this many dt away. At sqrt(2) the one longer step
   differs from dt by the same factor as two shorter ones. */
#define STEPPER_STRETCH 1.4142135623730951
/* After this many failed static solves for a load, or where no shorter step is allowed, the next solve is damped, as
   `stepping.damping` says. Shorter steps are cheaper where they help, and at a limit point no static step does: shorter
   and shorter ones would only come nearer to it. In the step after a damped one the first failure is enough. Where
   damping is the last resort, it waits for STEPPER_LAST failures, because the energy that a damped solve takes away is
   known the better the shorter its step is. It is then tried once; the next damped solve is that where the run would
   stop. */
#define STEPPER_STATIC 3
#define STEPPER_LAST   6
/* If the landing point is at most this many dt away, the way to it is halved, so that no very short step remains. */
#define STEPPER_HALVE 2.0

/* What bounds a step and may have another cause than its length */
typedef enum { BOUND_LAG, BOUND_TRAVEL, BOUND_FACING, BOUND_FAR, BOUNDS } Bound;

/* The last step that was taken back for its lag or its travel. What it used may belong to the load at its end, as where
   the run chooses penalties there, and a later step to the same end uses as much, however short it is. */
typedef struct {
  PetscReal end;         /* load parameter; 0: none */
  PetscReal lag, travel; /* used of what is allowed */
} Refused;

/* Accepted steps whose pace tells a limit load: two pairs of neighbours must tell the same */
enum { PACE_STEPS = 3 };

/* How fast the bodies have moved for the load in the last accepted steps, the last one first */
typedef struct {
  int       n;
  PetscReal middle[PACE_STEPS], rate[PACE_STEPS]; /* t in the middle of the step; largest displacement per unit of t */
  PetscReal dt;                                   /* of the last one */
} Pace;

/* Load that static solves do not reach */
typedef struct {
  PetscReal at;       /* the least one; 0: none */
  PetscInt  failures; /* of solves for it or more, since the last damped solve */
  PetscInt  slowly;   /* damped solves that failed for it */
} Wall;

/* What attempts have taught that the next ones use */
typedef struct {
  Refused refused;
  Wall    wall;
} Tried;

struct _n_LoadStepper {
  MPI_Comm             comm;
  Model                model;
  StepControlKind      kind;
  const StepControl   *control; /* of this kind */
  StepSize             size;
  StepSize             start; /* size at the last accepted step */
  StepperReport        report;
  PetscInt             n_landings, next_landing;
  PetscReal           *landings; /* load parameters that steps must end on, ascending; the last one is 1 */
  LoadStepperLastFn    last;     /* NULL: nobody wants the last solution */
  void                *last_context;
  LoadStepperMonitorFn monitor;
  void                *monitor_context;
  PetscReal            used[BOUNDS]; /* by the last attempt of this step, of what is allowed; 0: none */
  Tried                tried, known; /* known: in the accepted state */
  PetscBool            in_vain;      /* this step was shortened for a bound that it passes all the same */
  PetscBool            shortens;     /* this step may be made shorter if its first linear step goes too far */
  PetscReal            most_facing;  /* turn (radians) of surfaces that lie opposite each other in this step */
  Pace                 pace;
  PetscInt             damped; /* 1: the last accepted step was damped */
  PetscBool            view;
};

/*@
  LoadStepperCreate - creates a load stepper without a model.

  Collective

  Input Parameter:
. comm - the ranks of the model

  Output Parameter:
. stepper - the stepper
@*/
PetscErrorCode LoadStepperCreate(MPI_Comm comm, LoadStepper *stepper)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(stepper));
  (*stepper)->comm = comm;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadStepperDestroy - destroys the stepper; the model remains.

  Collective

  Input Parameter:
. stepper - set to NULL; may be NULL already
@*/
PetscErrorCode LoadStepperDestroy(LoadStepper *stepper)
{
  PetscFunctionBeginUser;
  if (!*stepper) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree((*stepper)->landings));
  PetscCall(PetscFree(*stepper));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadStepperSetModel - gives the stepper its model.

  Not collective

  Input Parameters:
+ stepper - the stepper
- model   - borrowed, after ModelSetUp()
@*/
PetscErrorCode LoadStepperSetModel(LoadStepper stepper, Model model)
{
  PetscFunctionBeginUser;
  stepper->model = model;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the breakpoints of a history between 0 and 1. */
static PetscErrorCode AddHistory(const History *history, PetscInt *n, PetscReal *landings)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < history->n; i++)
    if (history->t[i] > STEPPER_SAME_T && history->t[i] < 1 - STEPPER_SAME_T) landings[(*n)++] = history->t[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the breakpoints of all histories of a motion. */
static PetscErrorCode AddMotion(const Motion *motion, PetscInt *n, PetscReal *landings)
{
  PetscFunctionBeginUser;
  for (int m = 0; m < motion->n; m++) PetscCall(AddHistory(&motion->components[m].history, n, landings));
  PetscCall(AddHistory(&motion->history, n, landings));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Number of breakpoints of a motion, for the length of the array. */
static PetscInt MotionBreakpoints(const Motion *motion)
{
  PetscInt n = motion->history.n;

  for (int m = 0; m < motion->n; m++) n += motion->components[m].history.n;
  return n;
}

/* Collects every load parameter that a step must end on: `at` of the scene, the breakpoints of all histories, and 1. */
static PetscErrorCode LoadStepperSetLandings(LoadStepper stepper, Scene scene)
{
  PetscInt n = scene->stepping.n_at + scene->stepping.n_steps + 1, kept = 0;

  PetscFunctionBeginUser;
  for (int l = 0; l < scene->n_loads; l++) n += scene->loads[l].history.n;
  for (int s = 0; s < scene->n_supports; s++) n += scene->supports[s].history.n;
  for (int b = 0; b < scene->n_bodies; b++) n += MotionBreakpoints(&scene->bodies[b].motion);
  for (int c = 0; c < scene->n_contacts; c++) n += MotionBreakpoints(&scene->contacts[c].motion);
  PetscCall(PetscFree(stepper->landings));
  PetscCall(PetscMalloc1(n, &stepper->landings));
  n = 0;
  for (int i = 0; i < scene->stepping.n_at; i++) stepper->landings[n++] = scene->stepping.at[i];
  for (int i = 0; i < scene->stepping.n_steps; i++) stepper->landings[n++] = scene->stepping.steps[i].until;
  for (int s = 0; s < scene->n_supports; s++) PetscCall(AddHistory(&scene->supports[s].history, &n, stepper->landings));
  for (int l = 0; l < scene->n_loads; l++) PetscCall(AddHistory(&scene->loads[l].history, &n, stepper->landings));
  for (int b = 0; b < scene->n_bodies; b++) PetscCall(AddMotion(&scene->bodies[b].motion, &n, stepper->landings));
  for (int c = 0; c < scene->n_contacts; c++) PetscCall(AddMotion(&scene->contacts[c].motion, &n, stepper->landings));
  stepper->landings[n++] = 1;
  PetscCall(PetscSortReal(n, stepper->landings));
  for (PetscInt i = 0; i < n; i++) {
    if (stepper->landings[i] <= STEPPER_SAME_T) continue;
    if (!kept || stepper->landings[i] > stepper->landings[kept - 1] + STEPPER_SAME_T)
      stepper->landings[kept++] = stepper->landings[i];
  }
  stepper->n_landings = kept;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadStepperSetFromScene - takes control, dt with its bounds, and landing points from the scene.

  Not collective

  Input Parameters:
+ stepper - the stepper
- scene   - the only source of these values
@*/
PetscErrorCode LoadStepperSetFromScene(LoadStepper stepper, Scene scene)
{
  PetscFunctionBeginUser;
  stepper->kind    = scene->stepping.control;
  stepper->control = StepControls[stepper->kind];
  stepper->size    = (StepSize){.initial   = scene->stepping.initial,
                                .dt_min    = PetscMax(scene->stepping.dt_min, STEPPER_SAME_T),
                                .dt_max    = scene->stepping.dt_max,
                                .growth    = scene->stepping.growth,
                                .wanted    = scene->stepping.N_c ? scene->stepping.N_c : scene->stepping.N_c_fraction,
                                .by_area   = (PetscBool)!scene->stepping.N_c,
                                .linearly  = (PetscBool)scene->stepping.predict_linearly,
                                .shortfall = 1,
                                .beta      = NAN,
                                .dt        = scene->stepping.initial};
  PetscCall(LoadStepperSetLandings(stepper, scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadStepperSetFromOptions - reads from PETSc's options what is neither physics nor a value of the stepping.

  Collective

  Input Parameter:
. stepper - the stepper

  Options Database Key:
. -load_stepper_view - print the stepper before it starts
@*/
PetscErrorCode LoadStepperSetFromOptions(LoadStepper stepper)
{
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-load_stepper_view", &stepper->view, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadStepperMonitorSet - sets a function that is called after each accepted step.

  Logically collective

  Input Parameters:
+ stepper - the stepper
. monitor - the function
- context - handed to it; borrowed
@*/
PetscErrorCode LoadStepperMonitorSet(LoadStepper stepper, LoadStepperMonitorFn monitor, void *context)
{
  PetscFunctionBeginUser;
  stepper->monitor         = monitor;
  stepper->monitor_context = context;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadStepperLastSet - sets a function that is called at the solution of the last step, before that is accepted.

  Logically collective

  Input Parameters:
+ stepper - the stepper
. last    - the function; it leaves the model as it is
- context - handed to it; borrowed
@*/
PetscErrorCode LoadStepperLastSet(LoadStepper stepper, LoadStepperLastFn last, void *context)
{
  PetscFunctionBeginUser;
  stepper->last         = last;
  stepper->last_context = context;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadStepperView - prints control, dt, its bounds and the landing points.

  Collective on the viewer

  Input Parameters:
+ stepper - after LoadStepperSetFromScene()
- viewer  - of type ASCII
@*/
PetscErrorCode LoadStepperView(LoadStepper stepper, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer, "LoadStepper: control %s, initial %g, dt_min %g, dt_max %g, growth %g\n",
                                   StepControlNames[stepper->kind], (double)stepper->size.initial,
                                   (double)stepper->size.dt_min, (double)stepper->size.dt_max,
                                   (double)stepper->size.growth));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  lands on"));
  for (PetscInt i = 0; i < stepper->n_landings; i++)
    PetscCall(PetscViewerASCIIPrintf(viewer, " %g", (double)stepper->landings[i]));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the end of a step of about dt from t: exactly the next landing point, where that is near. *clipped: the step
   was shortened for it, so that its dt says nothing about what the model can take. */
static PetscReal StepEnd(LoadStepper stepper, PetscReal t, PetscReal dt, PetscBool *clipped)
{
  PetscReal landing, remaining;

  while (stepper->landings[stepper->next_landing] <= t + STEPPER_SAME_T) stepper->next_landing++;
  landing   = stepper->landings[stepper->next_landing];
  remaining = landing - t;
  *clipped  = PETSC_FALSE;
  if (remaining <= PetscMax(dt, PetscMin(STEPPER_STRETCH * dt, stepper->size.dt_max)) + STEPPER_SAME_T) {
    *clipped = remaining < dt - STEPPER_SAME_T ? PETSC_TRUE : PETSC_FALSE;
    return landing;
  }
  if (remaining < STEPPER_HALVE * dt) {
    *clipped = PETSC_TRUE;
    return t + remaining / 2;
  }
  return t + dt;
}

/*@
  LoadStepperCuts - returns the number of iterations that the line search shortened, for whatever cause.

  Not collective

  Input Parameter:
. report - the report
@*/
PetscInt LoadStepperCuts(const StepperReport *report)
{
  PetscInt sum = 0;

  for (int cause = 0; cause < CUT_CAUSES; cause++) sum += report->cuts[cause];
  return sum;
}

/* Adds the costs of a solve to the record of its step and to the report. */
static void CountSolve(PetscReal t, const SolveReport *solve, StepRecord *record, StepperReport *report)
{
  report->relaxed += solve->relaxed;
  report->cycles += solve->cycles;
  report->cycles_cut += solve->result == SOLVE_CYCLE;
  if (solve->cycles)
    snprintf(report->cycle, sizeof(report->cycle), "on the way to t = %.6g %s", (double)t, solve->cycle);
  record->newton += solve->newton;
  record->krylov += solve->krylov;
  report->newton_iterations += solve->newton;
  report->krylov_iterations += solve->krylov;
  report->regathered += solve->regathered;
  report->adjusted += solve->adjusted;
  report->wetted += solve->wetted;
  for (int cause = 0; cause < CUT_CAUSES; cause++) report->cuts[cause] += solve->cuts[cause];
  report->turned += solve->turned;
}

/* Calls the control's prediction, once for each step. */
static PetscErrorCode LoadStepperPredict(LoadStepper stepper, StepRecord *record)
{
  SolveReport solve = {.result = SOLVE_CONVERGED};
  PetscBool   clipped;

  PetscFunctionBeginUser;
  if (!stepper->control->predict) PetscFunctionReturn(PETSC_SUCCESS);
  (void)StepEnd(stepper, stepper->model->t, stepper->size.dt, &clipped); /* sets stepper->next_landing */
  PetscCall(stepper->control->predict(stepper->model, stepper->landings[stepper->next_landing] - stepper->model->t,
                                      &stepper->size, &solve));
  CountSolve(stepper->model->t, &solve, record, &stepper->report);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The next step is as at the start, unless steps have become shorter: those before say nothing of it. */
static void StartAnew(StepSize *size)
{
  size->dt      = PetscMin(size->dt, size->initial);
  size->last_dt = size->failed_dt = 0;
}

/* Where supports come or leave, bodies begin to move otherwise than before. */
static PetscErrorCode LoadStepperMeetSupports(LoadStepper stepper)
{
  PetscBool changed;

  PetscFunctionBeginUser;
  PetscCall(ModelChangeSupports(stepper->model, &changed));
  if (!changed) PetscFunctionReturn(PETSC_SUCCESS);
  StartAnew(&stepper->size);
  stepper->start = stepper->size;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where a fluid begins to press, the steps before say nothing of it: it moves bodies that only contact holds, until
   contact holds them elsewhere. */
static PetscErrorCode LoadStepperMeetFluid(Model model, StepSize *size)
{
  PetscBool begins = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (SceneBreaks(model->scene, model->t)) PetscCall(FluidBegins(model->problem->fluids, model->t, &begins));
  if (begins) StartAnew(size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The iterations of a solve by which the next step is chosen: those to its first solution. What it takes to make lists
   anew once does not depend on the length of the step, nor what stiffer penalties take or a fluid that moves on. */
static PetscInt StepIterations(const SolveReport *solve)
{
  return solve->first && !solve->damped ? solve->first : solve->newton;
}

/* Multiplies force and energies of a record by the thickness of the plane. */
static void ScaleRecord(Scene scene, StepRecord *record)
{
  PetscReal *per_thickness[] = {
    &record->contact.force,         &record->contact.dissipated,  &record->energy.elastic,
    &record->energy.plastic,        &record->energy.work,         &record->energy.lag,
    &record->energy.damping,        &record->energy.dissipated,   &record->energy.least,
    &record->energy.outer.work,     &record->energy.outer.stored, &record->energy.outer.given,
    &record->energy.outer.friction, &record->energy.outer.held};

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(per_thickness); i++) *per_thickness[i] *= scene->thickness;
}

/* Adds the step from t - dt to t that was accepted to the pace. A damped step, or one that jumped, begins it anew. So
   does a load that changes its rate. */
static void PaceAdd(Pace *pace, Model model, PetscReal dt, PetscBool jumped)
{
  const PetscBool anew = (PetscBool)(jumped || SceneBreaks(model->scene, model->t));

  for (int i = PACE_STEPS - 1; i > 0; i--) {
    pace->middle[i] = pace->middle[i - 1];
    pace->rate[i]   = pace->rate[i - 1];
  }
  pace->middle[0] = model->t - dt / 2;
  pace->rate[0]   = ModelRate(model);
  pace->dt        = dt;
  pace->n         = anew ? 0 : PetscMin(PACE_STEPS, pace->n + 1);
}

/* Notes the stability of the accepted state. Where it is not known, it is taken for that of the state before. */
static void LoadStepperNoteStability(StepperReport *report, const SolveReport *solve)
{
  const PetscInt  negatives = solve->negatives;
  const PetscReal gives     = negatives > 0 ? solve->gives : 0;

  if (negatives < 0) return;
  if (gives > MODEL_GIVES && report->gives <= MODEL_GIVES) report->unstable_from = report->t;
  report->negatives = negatives;
  report->gives     = gives;
  report->unstable_steps += gives > MODEL_GIVES;
  report->most_negatives = PetscMax(report->most_negatives, negatives);
}

/* Accepts a converged step of dt: fills its record, lets the control choose the next dt, which is at most `most` and
   which it must not shrink below dt_min, and accepts the state. */
static PetscErrorCode LoadStepperAccept(LoadStepper stepper, PetscReal dt, PetscReal most, PetscBool clipped,
                                        const SolveReport *solve, StepRecord *record)
{
  Model          model  = stepper->model;
  StepperReport *report = &stepper->report;

  PetscFunctionBeginUser;
  record->t        = model->t;
  record->dt       = dt;
  record->residual = solve->residual;
  if (model->contact) PetscCall(ContactSummarise(model->contact, &record->contact));
  PetscCall(stepper->control->next(model, dt, clipped, StepIterations(solve), &stepper->size));
  stepper->size.dt = PetscMin(stepper->size.dt, most);
  PetscCall(LoadStepperMeetFluid(model, &stepper->size));
  stepper->size.dt = PetscMin(stepper->size.dt_max, PetscMax(stepper->size.dt, PetscMin(dt, stepper->size.dt_min)));
  record->beta     = stepper->size.beta;
  record->tied     = stepper->size.tied;
  if (stepper->last && model->t >= 1 - STEPPER_SAME_T) PetscCall(stepper->last(stepper->last_context));
  PetscCall(ModelAccept(model));
  PaceAdd(&stepper->pace, model, dt, (PetscBool)(solve->jump[0] || solve->damped));
  record->energy         = EnergyBalanceGet(model->balance);
  record->energy.damping = report->damping + solve->damping;
  ScaleRecord(model->scene, record);
  if (solve->jump[0]) {
    report->jumps++;
    PetscCall(PetscSNPrintf(report->jump, sizeof(report->jump), "from t = %.6g to %.6g: %s", (double)report->t,
                            (double)model->t, solve->jump));
  }
  if (model->t >= stepper->tried.wall.at) stepper->tried.wall = (Wall){0};
  stepper->damped = solve->damped > 0;
  report->damped += stepper->damped;
  report->damping += solve->damping;
  stepper->start = stepper->size;
  stepper->known = stepper->tried;
  report->t      = model->t;
  report->steps++;
  report->newton_accepted += solve->newton;
  report->taken += solve->taken;
  report->left     = PetscMax(report->left, solve->left);
  report->share    = solve->share;
  report->tied     = solve->tied;
  report->unstable = PetscMax(report->unstable, solve->unstable);
  report->friction = PetscMax(report->friction, solve->friction);
  report->held += solve->friction > 0;
  LoadStepperNoteStability(report, solve);
  report->motions = PetscMax(report->motions, solve->motions);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the way that a solve failed may be due to an unstable equilibrium. */
static PetscBool MayBeUnstable(SolveResult result)
{
  switch (result) {
  case SOLVE_ITERATIONS:
  case SOLVE_STALLED:
  case SOLVE_LINE_SEARCH:
  case SOLVE_DOMAIN:
  case SOLVE_LINEAR:
  case SOLVE_LISTS:
  case SOLVE_CYCLE:
  case SOLVE_LOST:
  case SOLVE_UNSTABLE:
  case SOLVE_NAN: return PETSC_TRUE;
  default: return PETSC_FALSE;
  }
}

/* The load parameter at which two steps say that the pace is without bound; infinite where it does not grow. The way to
   a limit load is a parabola, at whose end the rate goes with the inverse of the square root of the distance. */
static PetscReal PaceEnd(const Pace *pace, int step)
{
  const PetscReal now = PetscSqr(pace->rate[step]), before = PetscSqr(pace->rate[step + 1]);

  if (now <= before) return PETSC_INFINITY;
  return (now * pace->middle[step] - before * pace->middle[step + 1]) / (now - before);
}

/* Says whether the pace before the state at t tells a limit load within one more step like the last one. */
static PetscBool PaceLimited(const Pace *pace, PetscReal t, PetscReal *limit)
{
  if (pace->n < PACE_STEPS) return PETSC_FALSE;
  *limit = PetscMax(t, PaceEnd(pace, 0));
  return (PetscBool)(*limit <= t + pace->dt && PaceEnd(pace, 1) <= t + (t - pace->middle[PACE_STEPS - 1]));
}

/* Writes into the report that the step from t to `end` failed for good. first, dt: of its first and its last attempt.
 */
static PetscErrorCode ReportFailure(LoadStepper stepper, PetscReal t, PetscReal end, PetscReal first, PetscReal dt,
                                    PetscInt attempts, const SolveReport *solve)
{
  StepperReport *report    = &stepper->report;
  PetscReal      limit     = t;
  char           text[128] = "";

  PetscFunctionBeginUser;
  if (MayBeUnstable(solve->result) && PaceLimited(&stepper->pace, t, &limit))
    PetscCall(PetscSNPrintf(text, sizeof(text), "; the bodies move ever faster, as before a limit load at t = %.4g",
                            (double)limit));
  PetscCall(PetscSNPrintf(report->message, sizeof(report->message),
                          "no equilibrium from t = %.6g to %.6g: %s; %s%s; tried %" PetscInt_FMT
                          " steps, dt from %.3g down to %.3g (dt_min %.3g)",
                          (double)t, (double)end, SolveResults[solve->result], solve->detail, text, attempts,
                          (double)first, (double)dt, (double)stepper->size.dt_min));
  report->failed.solve    = *solve;
  report->failed.attempts = attempts;
  report->failed.t        = end;
  report->failed.first    = first;
  report->failed.last     = dt;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is the load known at which faces cross deeper than is allowed, to a part of it, and is the depth there close to that
   bound? Shorter steps would only come closer to it. */
static PetscBool BoundIsReached(const SolveReport *solve, PetscReal dt, PetscReal end)
{
  return (PetscBool)(solve->result == SOLVE_UNCERTIFIED && solve->excess <= 1 + STEPPER_DEPTH &&
                     dt <= STEPPER_DEPTH * end);
}

/* What the lag of plastic bodies in a step uses of what the scene allows: 1 is all of it. It is measured against the
   plastic work of the step, or against what the mean step of that length has where this one has less. */
static PetscReal LagUsed(LoadStepper stepper, const PlasticPath *path, PetscReal dt)
{
  const Model     model = stepper->model;
  const PetscReal lag   = model->scene->stepping.plastic_lag,
                  work  = PetscMax(path->work, EnergyBalanceGet(model->balance).plastic * dt / model->t);

  return lag > 0 && work > 0 ? PetscMax(path->lag / lag, path->begun / STEPPER_BEGUN) / work : 0;
}

/* What the step uses of a bound that may have another cause than its length is new. Says whether the step stays: it
   keeps to the bound, or was shortened for it in vain. */
static PetscBool StepStays(LoadStepper stepper, Bound bound, PetscReal used)
{
  const PetscReal before = stepper->used[bound];

  stepper->used[bound] = used;
  return (PetscBool)(used <= 1 || (before > 0 && used > STEPPER_GAIN * before));
}

/* What a step that stays used of a bound, for the length of the next one. Where it was shortened in vain, more than is
   allowed does not come from the length, and the next step is to be as long as this one was before. */
static PetscReal UsedByLength(LoadStepper stepper, PetscReal used, PetscBool stays)
{
  if (!stays || used <= 1) return used;
  stepper->in_vain = PETSC_TRUE;
  return STEPPER_STRAIN;
}

/* What the flow of the bodies in a step of dt to the present solution uses of what the scene allows, and whether the
   step stays. */
static PetscErrorCode LoadStepperFlow(LoadStepper stepper, PetscReal dt, PetscReal *used, PetscBool *stays)
{
  const Model     model  = stepper->model;
  const PetscReal strain = model->scene->stepping.plastic_strain;
  PetscReal       growth, lag;
  PlasticPath     path;

  PetscFunctionBeginUser;
  *used  = 0;
  *stays = PETSC_TRUE;
  if (!ProblemIsPlastic(model->problem) || !(strain > 0 || model->scene->stepping.plastic_lag > 0))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ElasticityPlasticPath(model->problem->elasticity, model->u, model->t, &path));
  growth = strain > 0 ? path.growth / strain : 0;
  lag    = LagUsed(stepper, &path, dt);
  *stays = StepStays(stepper, BOUND_LAG, lag);
  *used  = PetscMax(growth, UsedByLength(stepper, lag, *stays));
  *stays = (PetscBool)(*stays && growth <= 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same of the travel of contact with friction. Pressures rise from the ends of a contact, so that the force which
   comes in grows with the square of the way. The square root uses the bound in proportion to dt. */
static PetscErrorCode LoadStepperTravel(LoadStepper stepper, PetscReal *used, PetscBool *stays)
{
  const Model     model = stepper->model;
  const PetscReal bound = model->scene->stepping.contact_travel;
  PetscReal       travel;

  PetscFunctionBeginUser;
  *used  = 0;
  *stays = PETSC_TRUE;
  if (!model->contact) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactTravel(model->contact, &travel));
  if (!(bound > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  *used  = PetscSqrtReal(travel / bound);
  *stays = StepStays(stepper, BOUND_TRAVEL, *used);
  *used  = UsedByLength(stepper, *used, *stays);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes back a converged step for its bounds. The next one is of dt. */
static void LoadStepperRefuse(LoadStepper stepper, PetscReal dt)
{
  stepper->tried.refused = (Refused){stepper->model->t, stepper->used[BOUND_LAG], stepper->used[BOUND_TRAVEL]};
  stepper->size.dt       = dt;
}

/* A step to the end of the one that was taken back last is compared with that. */
static void LoadStepperRemember(LoadStepper stepper, PetscReal end)
{
  if (end != stepper->tried.refused.end) return;
  stepper->used[BOUND_LAG]    = stepper->tried.refused.lag;
  stepper->used[BOUND_TRAVEL] = stepper->tried.refused.travel;
}

/* Says whether bodies flow and contact travels by no more than the scene allows in the step to the present solution, or
   dt is the smallest one. A step that is taken back is followed by a shorter one, one that stays bounds the next dt. A
   step stays, too, that is shorter than the attempt before and uses as much: that does not come from the length. */
static PetscErrorCode LoadStepperBound(LoadStepper stepper, PetscReal dt, PetscReal *most, PetscBool *within)
{
  PetscReal flow, travel, used;
  PetscBool stays, remains;

  PetscFunctionBeginUser;
  *most = stepper->size.dt_max;
  PetscCall(LoadStepperFlow(stepper, dt, &flow, &stays));
  PetscCall(LoadStepperTravel(stepper, &travel, &remains));
  used    = PetscMax(flow, travel);
  *within = (PetscBool)(dt <= stepper->size.dt_min || (stays && remains));
  if (used > 0) *most = PetscMax(stepper->size.dt_min, STEPPER_STRAIN / used * dt);
  if (*within)
    *most = PetscMax(*most, STEPPER_CUT * dt);
  else
    LoadStepperRefuse(stepper, PetscMin(STEPPER_CUT * dt, *most)); /* a landing may stretch it by STEPPER_STRETCH */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether a solve ended in an unstable equilibrium, after a state that was not known for one. */
static PetscBool LosesStability(const StepperReport *report, const SolveReport *solve)
{
  return (PetscBool)(solve->result == SOLVE_CONVERGED && solve->negatives > 0 && solve->gives > MODEL_GIVES &&
                     !(report->gives > MODEL_GIVES));
}

/* Says whether an unstable equilibrium counts as none. Where damping is the last resort it does if solves for the load
   have failed: Newton's method has then wandered there, and does not follow the stable states before. That is asked
   once only: a damped solve comes next. */
static PetscBool RefusesUnstable(LoadStepper stepper)
{
  const Wall       *wall    = &stepper->tried.wall;
  const StepDamping damping = stepper->model->scene->stepping.damping;

  return (PetscBool)(damping == DAMPING_AUTO || (damping == DAMPING_LAST && wall->failures > 0 && !wall->slowly));
}

/* Says whether static solves have failed so often that the next one is damped. */
static PetscBool StepperTurnsSlow(LoadStepper stepper)
{
  const PetscBool by_itself = (PetscBool)(stepper->model->scene->stepping.damping == DAMPING_AUTO);

  return (PetscBool)(stepper->tried.wall.failures >= (by_itself ? STEPPER_STATIC : STEPPER_LAST));
}

/* Solves for a step of dt to `end`. An unstable equilibrium counts as none where damping may lead to a stable one.
   Where static solves have failed often enough, the next one is damped, and the count starts anew. No shorter static
   step follows a damped one or one of dt_min, either. */
static PetscErrorCode LoadStepperTry(LoadStepper stepper, PetscReal end, PetscReal dt, SolveReport *solve)
{
  const StepDamping damping = stepper->model->scene->stepping.damping;
  const PetscBool   last    = (PetscBool)(STEPPER_CUT * dt < stepper->size.dt_min || stepper->damped);
  const PetscBool   slowly  = StepperTurnsSlow(stepper);
  PetscBool         leaves;

  PetscFunctionBeginUser;
  PetscCall(
    PetscInfo(stepper->model->snes, "step to t = %g, dt %g%s\n", (double)end, (double)dt, slowly ? ", damped" : ""));
  stepper->model->doubts   = (PetscBool)(damping == DAMPING_AUTO && stepper->tried.wall.failures > 0);
  stepper->model->shortens = (PetscBool)(stepper->shortens && !slowly && STEPPER_CUT * dt >= stepper->size.dt_min);
  if (slowly) {
    PetscCall(ModelSolveSlowly(stepper->model, end, solve));
    stepper->tried.wall.failures = 0;
    stepper->tried.wall.slowly += solve->result != SOLVE_CONVERGED;
  } else {
    PetscCall(ModelSolve(stepper->model, end, solve));
    leaves = (PetscBool)(LosesStability(&stepper->report, solve) && RefusesUnstable(stepper));
    if (leaves) solve->result = SOLVE_UNSTABLE;
    if (damping != DAMPING_NONE && MayBeUnstable(solve->result)) {
      stepper->tried.wall.at = stepper->tried.wall.at > 0 ? PetscMin(stepper->tried.wall.at, end) : end;
      stepper->tried.wall.failures += last || (leaves && damping == DAMPING_LAST)
                                        ? STEPPER_LAST
                                        : damping == DAMPING_AUTO || !stepper->tried.wall.slowly;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the control and the bounds take a step that has converged. */
static PetscErrorCode LoadStepperJudge(LoadStepper stepper, PetscReal dt, PetscReal *most, PetscBool *taken)
{
  PetscFunctionBeginUser;
  *most  = 0;
  *taken = PETSC_TRUE;
  if (stepper->control->judge) PetscCall(stepper->control->judge(stepper->model, dt, &stepper->size, taken));
  if (*taken) PetscCall(LoadStepperBound(stepper, dt, most, taken));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Shortens a step of dt in which surfaces that lie opposite each other would turn too far. Where a shorter one did not
   make that less, its length is not the cause, and they may. */
static void LoadStepperFace(LoadStepper stepper, PetscReal dt, PetscReal turn)
{
  if (StepStays(stepper, BOUND_FACING, turn / STEPPER_FACING))
    stepper->most_facing = INFINITY;
  else
    stepper->size.dt = PetscMax(STEPPER_CUT, STEPPER_STRAIN * STEPPER_FACING / turn) * dt;
}

/* Shortens a step of dt that was not begun: see LoadStepperFace(); or its first linear step goes too far, by `far`, and
   no way in pieces gets there. Newton's method fails in such steps, or takes many iterations. Where a shorter one went
   as far, the length is not the cause, and Newton's method is tried. */
static void LoadStepperShorten(LoadStepper stepper, PetscReal dt, const SolveReport *solve)
{
  if (solve->result == SOLVE_FACING)
    LoadStepperFace(stepper, dt, solve->facing);
  else {
    stepper->report.steps_repeated++;
    stepper->shortens = (PetscBool)!StepStays(stepper, BOUND_FAR, solve->far);
    if (stepper->shortens) stepper->size.dt = STEPPER_CUT * dt;
  }
}

/* Tries one step, and repeats it with smaller dt until it converges and the control accepts it, or dt falls below
   dt_min. A step whose first linear solve is singular is not repeated, because the tangent at its start is singular for
   any dt. A fluid that leaks ends the steps. */
static PetscErrorCode LoadStepperAdvance(LoadStepper stepper, StepRecord *record, PetscBool *advanced)
{
  Model           model  = stepper->model;
  StepperReport  *report = &stepper->report;
  const PetscReal t = model->t, first = stepper->size.dt;
  const PetscBool recovers = (PetscBool)(stepper->size.failed_dt > 0);
  const PetscReal last     = stepper->size.last_dt;
  SolveReport     solve, cause  = {0}; /* cause: the last static solve, whose failure is the one to tell of */
  PetscReal       most, longest = 0;   /* of the attempts that failed */
  PetscBool       clipped, singular;

  PetscFunctionBeginUser;
  *advanced = PETSC_FALSE;
  PetscCall(PetscArrayzero(stepper->used, BOUNDS));
  stepper->in_vain     = PETSC_FALSE;
  stepper->most_facing = STEPPER_FACING;
  stepper->shortens    = (PetscBool)(stepper->kind != STEP_FIXED);
  *record              = (StepRecord){.step = report->steps + 1};
  PetscCall(LoadStepperPredict(stepper, record));
  while (PETSC_TRUE) {
    const PetscReal end = StepEnd(stepper, t, stepper->size.dt, &clipped), dt = end - t;

    LoadStepperRemember(stepper, end);
    model->most_facing = STEPPER_CUT * dt < stepper->size.dt_min ? INFINITY : stepper->most_facing;
    PetscCall(LoadStepperTry(stepper, end, dt, &solve));
    record->attempts += !SolveHasNotBegun(solve.result);
    CountSolve(end, &solve, record, &stepper->report);
    if (solve.result == SOLVE_CONVERGED) {
      PetscCall(LoadStepperJudge(stepper, dt, &most, advanced));
      if (!*advanced) {
        PetscCall(ModelRestore(model));
        report->steps_repeated++;
        continue;
      }
      PetscCall(ModelCertify(model, &solve));
    }
    if (SolveHasNotBegun(solve.result)) {
      PetscCall(ModelRestore(model));
      LoadStepperShorten(stepper, dt, &solve);
      continue;
    }
    *advanced = (PetscBool)(solve.result == SOLVE_CONVERGED);
    if (*advanced) {
      if (solve.damped || solve.jump[0])
        stepper->size.last_dt = last; /* behind a jump steps may be as long as before */
      PetscCall(LoadStepperAccept(stepper, dt, most, clipped, &solve, record));
      if (stepper->in_vain) stepper->size.dt = PetscMax(stepper->size.dt, first);
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    PetscCall(
      PetscInfo(model->snes, "step to t = %g failed: %s; %s\n", (double)end, SolveResults[solve.result], solve.detail));
    PetscCall(ModelRestore(model));
    report->leaks = (PetscBool)(solve.result == SOLVE_LEAKED);
    if (report->leaks) {
      PetscCall(
        PetscSNPrintf(report->message, sizeof(report->message), "ended at t = %.6g: %s", (double)t, solve.detail));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    *(solve.result == SOLVE_LEAK ? &report->steps_repeated : &report->steps_failed) += 1;
    if (!solve.damped) cause = solve;
    singular = (PetscBool)((solve.result == SOLVE_LINEAR && solve.newton == 1) ||
                           (solve.result == SOLVE_ADRIFT && !solve.newton));
    if (StepperTurnsSlow(stepper) && !singular) continue; /* a damped solve of the same dt comes next */
    if (solve.result != SOLVE_LEAK) longest = PetscMax(longest, dt);
    stepper->size.failed_dt = recovers ? 0 : longest; /* what fails again on the way back is no matter of the place */
    stepper->size.dt        = STEPPER_CUT * dt;
    stepper->size.last_dt   = 0; /* the control is not to return to a length like the one that has failed */
    if (stepper->size.dt < stepper->size.dt_min || singular || BoundIsReached(&solve, dt, end)) {
      PetscCall(ReportFailure(stepper, t, end, first, dt, record->attempts, &cause));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  }
}

/*@
  LoadStepperStop - ends LoadStepperSolve() before its next step.

  Logically collective

  Input Parameter:
. stepper - called from its monitor
@*/
PetscErrorCode LoadStepperStop(LoadStepper stepper)
{
  PetscFunctionBeginUser;
  stepper->report.stopped = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadStepperSolve - steps the model from its t to 1, or until no step above dt_min converges.

  Collective

  Input Parameter:
. stepper - it has its model and the values of the scene

  Output Parameter:
. report - how it ended and what it cost

  Note:
  The monitor is called after each accepted step. Where a step fails for good, the model is at the last accepted state
  afterwards. A linear problem is solved in one step between landing points.
@*/
PetscErrorCode LoadStepperSolve(LoadStepper stepper, StepperReport *report)
{
  PetscBool  advanced = PETSC_TRUE;
  StepRecord record;

  PetscFunctionBeginUser;
  if (ProblemIsLinear(stepper->model->problem)) stepper->size.dt = stepper->size.initial = stepper->size.dt_max = 1;
  stepper->start        = stepper->size;
  stepper->report.t     = stepper->model->t;
  stepper->next_landing = 0;
  if (stepper->view) PetscCall(LoadStepperView(stepper, PETSC_VIEWER_STDOUT_(stepper->comm)));
  while (stepper->report.t < 1 - STEPPER_SAME_T && advanced && !stepper->report.stopped) {
    PetscCall(LoadStepperMeetSupports(stepper));
    PetscCall(LoadStepperAdvance(stepper, &record, &advanced));
    if (advanced && stepper->monitor) PetscCall(stepper->monitor(stepper, &record, stepper->monitor_context));
  }
  stepper->report.done    = (PetscBool)(stepper->report.t >= 1 - STEPPER_SAME_T || stepper->report.leaks);
  stepper->report.stopped = (PetscBool)(stepper->report.stopped && !stepper->report.done);
  *report                 = stepper->report;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether an archive has a value, or is to get it. Older archives lack some. */
static PetscErrorCode Holds(Archive archive, const char *name, PetscBool *holds)
{
  PetscFunctionBeginUser;
  *holds = PETSC_TRUE;
  if (ArchiveLoads(archive)) PetscCall(ArchiveHas(archive, name, holds));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Saves or loads what attempts have taught. */
static PetscErrorCode ArchiveTried(Archive archive, Tried *tried)
{
  Refused   *refused = &tried->refused;
  PetscReal *used[]  = {&refused->end, &refused->lag, &refused->travel};
  PetscInt  *count[] = {&tried->wall.failures, &tried->wall.slowly};
  PetscBool  holds;

  PetscFunctionBeginUser;
  PetscCall(Holds(archive, "stepper/refused", &holds));
  if (holds) PetscCall(ArchiveRealsAt(archive, "stepper/refused", PETSC_STATIC_ARRAY_LENGTH(used), used));
  PetscCall(Holds(archive, "stepper/wall", &holds));
  if (!holds) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ArchiveReals(archive, "stepper/wall", 1, &tried->wall.at));
  PetscCall(ArchiveIntegersAt(archive, "stepper/failures", PETSC_STATIC_ARRAY_LENGTH(count), count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadStepperArchive - saves or loads the size of the next step and the counts, as they were at the last accepted step.

  Collective

  Input Parameters:
+ stepper - to save: from the monitor or after LoadStepperSolve(); to load: after LoadStepperSetFromScene()
- archive - decides whether they are saved or loaded

  Notes:
  A failed step is not part of what is saved. After loading it is tried again from its first dt, with the solver or the
  stepping that the user has changed. dt_max of the scene bounds the dt that is loaded. Where `initial` of the scene
  differs from that of the saved run, dt is that of the scene.
@*/
PetscErrorCode LoadStepperArchive(LoadStepper stepper, Archive archive)
{
  StepperReport *report  = &stepper->report;
  StepSize       size    = ArchiveLoads(archive) ? stepper->size : stepper->start;
  PetscReal      initial = size.initial, dt = size.dt;
  PetscReal     *real[]    = {&initial,
                              &dt,
                              &size.beta,
                              &size.together,
                              &size.shortfall,
                              &size.planned,
                              &report->taken,
                              &report->left,
                              &report->share,
                              &report->tied,
                              &size.last_dt,
                              &size.last_iterations,
                              &report->damping,
                              &size.failed_dt,
                              &report->unstable,
                              &report->friction,
                              &report->unstable_from,
                              &report->gives};
  PetscInt      *integer[] = {&report->steps,           &report->steps_failed,
                              &report->steps_repeated,  &report->newton_iterations,
                              &report->newton_accepted, &report->krylov_iterations,
                              &report->regathered,      &report->adjusted,
                              &report->wetted,          &report->turned,
                              &report->relaxed,         &report->cycles,
                              &report->cycles_cut,      &report->jumps,
                              &report->damped,          &report->held,
                              &stepper->damped,         &size.tied,
                              &report->motions,         &report->unstable_steps,
                              &report->negatives,       &report->most_negatives};

  PetscFunctionBeginUser;
  PetscCall(ArchiveRealsAt(archive, "stepper/size", PETSC_STATIC_ARRAY_LENGTH(real), real));
  PetscCall(ArchiveIntegersAt(archive, "stepper/counts", PETSC_STATIC_ARRAY_LENGTH(integer), integer));
  PetscCall(ArchiveTried(archive, &stepper->known));
  PetscCall(ArchiveIntegers(archive, "stepper/cuts", CUT_CAUSES, report->cuts));
  PetscCall(ArchiveString(archive, "stepper/cycle", sizeof(report->cycle), report->cycle));
  PetscCall(ArchiveString(archive, "stepper/jump", sizeof(report->jump), report->jump));
  if (!ArchiveLoads(archive)) PetscFunctionReturn(PETSC_SUCCESS);
  if (initial == stepper->size.initial) size.dt = PetscMin(size.dt_max, dt);
  stepper->size  = size;
  stepper->tried = stepper->known;
  PetscFunctionReturn(PETSC_SUCCESS);
}
