/* Equilibrium at a load parameter: from the accepted state by prediction, Newton's method and new contact lists, until
   lists, springs and penalties hold. */
#include "base/timing.h"
#include "bodies/freemodes.h"
#include "bodies/tools.h"
#include "contact/contactfacing.h"
#include "modelimpl.h"

/* Lists are made anew after this many solutions before the solve counts as failed because they do not settle. An area
   factor that solutions turn to and fro is known between two values after two of them, and halving the way from a whole
   area to one that agrees takes seven more. Another factor may begin to turn only when the first one stands. */
#define EQUILIBRIUM_MAX_LISTS 16

/* At a breakpoint of the scene's histories the lists are renewed at most this many times for offsets of surface contact
   that lag behind by little. Each time a lag shrinks to a twentieth. A lag that is left would show as a jump in the
   next step. */
#define EQUILIBRIUM_MAX_OFFSET_UPDATES 4

/* Part of the usual drift by which offsets may lag. Where histories break, offsets are not carried on to the next step,
   and the lag would appear as a jump in it. At the end they are what the answers are made with: the usual drift, a
   tenth of the largest pressure, would show in the peak, and is left at half a per cent. Bodies that roll next to
   freely never come to rest with less: crossed cylinders did not with a thousandth. */
#define EQUILIBRIUM_LAG_AT_BREAK 1e-5
#define EQUILIBRIUM_LAG_AT_END   0.05
/* With friction the load may rest after a break or a step that the scene asks for, and nothing may change while it
   rests. Then lists are renewed until what they change is rounding, at most this many times. Gaps may change by 1e-11
   of the penetration that the largest pressure causes at the automatic penalty: penalties are 3 to 100 times as stiff,
   and forces may change by 1e-9. */
#define EQUILIBRIUM_MAX_REST_UPDATES 6
#define EQUILIBRIUM_LAG_AT_REST      1e-10
/* With friction surfaces slide, and the dent moves with them: offsets that lag by the usual drift change the forces of
   a die that slides by three faces in a step by 3 %. With this value they agree with those of short steps within
   0.2 %. */
#define EQUILIBRIUM_LAG_SLIDING 0.1
/* What the springs of free bodies hold after a solve may be this part of F_ref. More is relaxed. */
#define EQUILIBRIUM_SPRINGS 1e-7
/* The springs are relaxed at most this many times. */
#define EQUILIBRIUM_MAX_RELAX 3
/* A body of which the springs hold more than this part of F_ref is in no contact that holds it. Either a load moves it
   on and on, or a tool pushes it before it against no force but that of the springs. */
#define EQUILIBRIUM_ALL 0.1

/* A rigid tool may turn by this angle (radians) in a step by its free rotations. A step is straight, which it cannot be
   where a tool goes on around, and a tool that nothing resists, because all that touches it slips, turns without end.
 */
#define EQUILIBRIUM_MOST_TURN 1

/* Penalties are stiffened at most this many times at one load parameter: twice those of pressures, and twice those of
   what sticks. The first time is enough where the error is proportional to the compliance of the penalty, which it is
   when it is small. */
#define EQUILIBRIUM_MAX_STIFFEN 4
/* Times at one load parameter that they are made stiffer because nodes stand deep in faces: once, and once more where
   the first one was too little. */
#define EQUILIBRIUM_MAX_DEEP 2
/* Raises of penalties that are tried before they stay as they are: the whole one, and its square root. */
#define EQUILIBRIUM_RAISES 2
/* A fluid may move this many times at one load parameter. It wets all places that it can at once, so that it moves a
   few times only, and each move is a small load. */
#define EQUILIBRIUM_MAX_FLUID 50

/* The multipliers of incompressible bodies are changed at most this many times in a solve. 1 or 2 are usual; each makes
   the error of the volume a hundred times smaller or more. Thin bonded layers take most, because their pressures
   change much with little motion. */
#define EQUILIBRIUM_MAX_AUGMENT 30

/* Adds to the text that a slave node rests on an edge between facets. *found: such a node exists. */
static PetscErrorCode ModelBlameFacets(Model model, char *text, size_t size, PetscBool *found)
{
  ContactPlace place;
  size_t       used;

  PetscFunctionBeginUser;
  PetscCall(ModelLocateEdge(model, found, &place));
  PetscCall(PetscStrlen(text, &used));
  if (*found)
    PetscCall(PetscSNPrintf(
      text + used, size - used,
      "; node %" PetscInt_FMT
      " rests on an edge between two facets, which push it there from either side: no equilibrium is near",
      place.tag));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to the text that the penalty is too stiff, where rounding alone may keep the residual above the tolerance. */
static PetscErrorCode ModelBlamePenalty(Model model, char *text, size_t size)
{
  const PetscReal allowed = model->scene->solver.tolerance * ProblemForceScale(model->problem);
  PetscReal       force;
  size_t          used;

  PetscFunctionBeginUser;
  if (!model->contact) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactRoundOff(model->contact, &force));
  PetscCall(PetscStrlen(text, &used));
  if (force > PROBLEM_ROUND_OFF * allowed)
    PetscCall(
      PetscSNPrintf(text + used, size - used,
                    "; the penalty is too stiff: rounding of positions alone is a force of %.2g, the tolerance is %.2g",
                    (double)force, (double)allowed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to the text which bodies the loads drive out from between others at displacements u, and what would hold them.
   touching: nothing may press there. *any: there are some. */
static PetscErrorCode ModelBlameLoose(Model model, const PetscReal *u, PetscReal t, PetscBool touching, char *text,
                                      size_t size, PetscBool *any)
{
  char   bodies[256];
  size_t used;

  PetscFunctionBeginUser;
  *any = PETSC_FALSE;
  if (!model->problem->bodies) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FreeBodiesDrivenOut(model->problem->bodies, u, t, model->t, touching, sizeof(bodies), bodies));
  *any = (PetscBool)(bodies[0] != '\0');
  if (!*any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrlen(text, &used));
  PetscCall(
    PetscSNPrintf(text + used, size - used,
                  "%sthe loads on other bodies drive out %s, which contact does not hold: %sfriction, a support "
                  "or a spring does",
                  used ? "; " : "", bodies, SceneHasFriction(model->scene) ? "more " : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Completes the report on a motion that the loads drive, or tells instead of it which bodies they drive out. */
static PetscErrorCode ModelBlameDriven(Model model, SolveReport *report)
{
  char      bodies[sizeof(report->detail)] = "";
  PetscBool out;

  PetscFunctionBeginUser;
  PetscCall(ModelBlameLoose(model, model->problem->trial, model->t, PETSC_FALSE, bodies, sizeof(bodies), &out));
  if (out)
    PetscCall(PetscStrncpy(report->detail, bodies, sizeof(report->detail)));
  else
    PetscCall(PetscStrlcat(report->detail,
                           SceneHasFriction(model->scene)
                             ? ", is driven by the loads, and friction alone holds it, which slips"
                             : ", is driven by the loads, and contact alone holds it",
                           sizeof(report->detail)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes into the report what is known of a failed solve: the bodies that nothing holds where the system is singular,
   otherwise the nodes with the largest residuals. */
static PetscErrorCode ModelExplainFailure(Model model, SolveReport *report)
{
  const PetscBool adrift = (PetscBool)(report->result == SOLVE_LINEAR || report->result == SOLVE_ADRIFT);
  char            loose[128];
  PetscBool       edge = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(FailureLocate(model->mesh, model->problem->loads, model->contact, model->u, model->problem->f,
                          model->problem->inverted, model->problem->fault, &report->failure));
  if (report->result == SOLVE_DOMAIN && report->failure.point) report->result = SOLVE_ROUTINE;
  report->failure.enhanced = ProblemHasFormulation(model->problem, FORMULATION_ENHANCED);
  if (report->result == SOLVE_LEAK || report->result == SOLVE_LEAKED)
    FluidLeakText(model->problem->fluids, report->detail, sizeof(report->detail));
  if (report->result == SOLVE_WINDOW || report->result == SOLVE_LOST || report->result == SOLVE_LEAK ||
      report->result == SOLVE_LEAKED || report->result == SOLVE_TURNED)
    PetscFunctionReturn(PETSC_SUCCESS); /* the report has its detail already */
  if (report->result == SOLVE_CYCLE) {
    PetscCall(PetscStrncpy(report->detail, report->cycle, sizeof(report->detail)));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (model->problem->bodies)
    PetscCall(FreeBodiesLoose(model->problem->bodies, model->problem->trial, model->t, PETSC_TRUE,
                              sizeof(report->detail), report->detail));
  if (report->detail[0] && !adrift) PetscCall(ModelBlameDriven(model, report));
  if (report->detail[0]) PetscFunctionReturn(PETSC_SUCCESS);
  if (adrift) PetscCall(FreeModesUnheld(model->mesh, model->scene, model->problem->loads, sizeof(loose), loose));
  if (adrift && loose[0])
    PetscCall(
      PetscSNPrintf(report->detail, sizeof(report->detail), "no support and no imposed displacement holds %s%s", loose,
                    !model->contact || report->result == SOLVE_ADRIFT ? "" : " (contact may, with stabilise: auto)"));
  else {
    FailureText(model->scene, &report->failure, report->detail, sizeof(report->detail));
    if (report->result == SOLVE_LINE_SEARCH || report->result == SOLVE_ITERATIONS || report->result == SOLVE_STALLED)
      PetscCall(ModelBlameFacets(model, report->detail, sizeof(report->detail), &edge));
    if (!edge) PetscCall(ModelBlamePenalty(model, report->detail, sizeof(report->detail)));
    PetscCall(ModelBlameLoose(model, model->work->accepted_u, model->work->accepted_t, PETSC_TRUE, report->detail,
                              sizeof(report->detail), &edge));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves bodies that no contact holds yet along the loads at t until they touch. This changes the accepted state, which
   has no force along these motions, wherever the bodies are. */
static PetscErrorCode ModelSettle(Model model, PetscReal t)
{
  ModelWork   *work = model->work;
  SettleResult settled;
  PetscReal   *u;

  PetscFunctionBeginUser;
  work->adrift = PETSC_FALSE;
  if (!model->problem->bodies || work->searched) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(model->mesh->n_nodes * model->mesh->dim, &u));
  PetscCall(PetscArraycpy(u, work->accepted_u, model->mesh->n_nodes * model->mesh->dim));
  PetscCall(
    FreeBodiesSettle(model->problem->bodies, work->accepted_t, t, (PetscBool)(work->accepted_t == 0), u, &settled));
  work->adrift   = (PetscBool)(settled == SETTLE_ADRIFT);
  work->searched = (PetscBool)!work->adrift; /* a step that is tried again starts where the bodies are now */
  if (settled == SETTLE_MOVED) {
    work->settled      = PETSC_TRUE;
    work->looked_ahead = PETSC_FALSE;
    PetscCall(PetscArraycpy(work->accepted_u, u, model->mesh->n_nodes * model->mesh->dim));
    PetscCall(MeshCollectFree(model->mesh, u, work->accepted_x));
    PetscCall(VecCopy(work->accepted_x, model->x));
    if (work->extrapolation) PetscCall(ExtrapolationReplace(work->extrapolation, u, work->accepted_t));
    PetscCall(FluidBegin(model->problem->fluids, work->accepted_u, t));
  }
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the load changes its rate at t, or the scene asks for a step. */
static PetscBool ModelAsked(Model model, PetscReal t)
{
  const Scene scene = model->scene;
  PetscBool   asked = (PetscBool)SceneBreaks(scene, t);

  for (int i = 0; i < scene->stepping.n_at; i++) asked = (PetscBool)(asked || scene->stepping.at[i] == t);
  return asked;
}

/* Says whether the state at t is an answer, not one on the way: the load ends there, or ModelAsked(). */
static PetscBool ModelIsShown(Model model, PetscReal t)
{
  return (PetscBool)(t >= 1 || ModelAsked(model, t));
}

/* Starts a load step from the accepted state to t: restores its contact state and makes lists for the expected motion.
   That motion is the imposed one, or the one that the rate of the last step predicts if that is larger. Lists that are
   ready serve if they are good for it; new ones have PROBLEM_MOTION_SAFETY in hand. */
static PetscErrorCode ModelDepart(Model model, PetscReal t)
{
  ModelWork      *work      = model->work;
  const PetscReal predicted = work->rate * (t - work->accepted_t);
  PetscReal       motion;

  PetscFunctionBeginUser;
  PetscCall(ElasticityRestore(model->problem->elasticity));
  if (model->contact) PetscCall(ContactRestore(model->contact));
  PetscCall(ModelDragBegin(model));
  PetscCall(FluidBegin(model->problem->fluids, work->accepted_u, t));
  PetscCall(ModelSettle(model, t));
  PetscCall(ContactSpringsRelax(model->problem->springs, work->accepted_x));
  model->t                 = t;
  model->problem->inverted = -1;
  work->start              = 0;
  work->strayed            = PETSC_FALSE;
  work->cycling            = PETSC_FALSE;
  work->cycles             = 0;
  work->augmented          = PETSC_FALSE;
  work->cycle[0]           = '\0';
  work->energy             = 0;
  ModelHeldBegin(model);
  ModelForgetPenaltyError(model, ModelIsShown(model, t));
  PetscCall(ModelStepFromSolved(model, work->accepted_u));
  if (!model->contact) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemImposedMotion(model->problem, work->accepted_u, work->accepted_t, t, &motion));
  motion = ContactMotionAtHand(model->contact, PetscMax(motion, predicted),
                               PetscMax(motion, PROBLEM_MOTION_SAFETY * predicted));
  PetscCall(ProblemGatherLists(model->problem, work->accepted_u, work->accepted_t, t, motion));
  if (model->problem->bodies && !work->adrift)
    PetscCall(FreeBodiesTie(model->problem->bodies, work->accepted_u, work->accepted_t, t, PETSC_TRUE, work->settled,
                            model->problem->springs, &model->problem->tied));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets model->x for a step that ends before the look-ahead, if the look-ahead started from an extrapolated state.
   model->x is then the extrapolated state at model->t plus `part` of the difference between the look-ahead and the
   extrapolated state at its end. *made says whether this was possible. */
static PetscErrorCode ModelTakeExtrapolatedPart(Model model, PetscReal part, PetscBool *made)
{
  ModelWork *work = model->work;
  PetscReal *u;
  Vec        end;

  PetscFunctionBeginUser;
  *made = work->look_ahead_extrapolated;
  if (!*made) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(model->mesh->n_nodes * model->mesh->dim, &u));
  PetscCall(VecDuplicate(model->x, &end));
  PetscCall(ModelExtrapolate(model, work->look_ahead_t, u, end, made));
  if (*made) PetscCall(ModelExtrapolate(model, model->t, u, model->x, made));
  if (*made) {
    PetscCall(VecAXPBYPCZ(model->x, part, -part, 1, work->look_ahead, end));
    PetscCall(ProblemSetTrial(model->problem, model->x, model->t));
    PetscCall(
      ProblemInOrder(model->problem, work->accepted_u, work->accepted_t, model->problem->trial, model->t, made));
    if (*made) PetscCall(ModelStepFrom(model, u));
  }
  PetscCall(VecDestroy(&end));
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets model->x to the part of the way to the look-ahead that belongs to model->t. */
static PetscErrorCode ModelTakePart(Model model)
{
  ModelWork      *work = model->work;
  const PetscReal part = (model->t - work->accepted_t) / (work->look_ahead_t - work->accepted_t);

  PetscFunctionBeginUser;
  PetscCall(ModelTakeExtrapolatedPart(model, part, &work->extrapolated));
  if (!work->extrapolated) PetscCall(VecAXPBYPCZ(model->x, 1 - part, part, 0, work->accepted_x, work->look_ahead));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets model->x to the first iterate of Newton's method: from a look-ahead where there is one, else by a prediction. */
static PetscErrorCode ModelStart(Model model, SolveReport *report)
{
  PetscFunctionBeginUser;
  model->work->unsettled = PETSC_FALSE;
  model->work->held      = PETSC_TRUE;
  if (model->work->looked_ahead)
    PetscCall(ModelTakePart(model));
  else
    PetscCall(ModelPredict(model, report));
  PetscCall(ModelPredictFar(model, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether lists are to settle at the solution: friction may rest there, or the load ends and all surfaces in
   contact stick. Collective. */
static PetscErrorCode ModelRests(Model model, PetscBool *rests)
{
  const PetscBool friction = ContactHasFriction(model->contact);

  PetscFunctionBeginUser;
  *rests = (PetscBool)(friction && ModelIsShown(model, model->t));
  for (int p = 0; *rests && model->t >= 1 && p < ContactPairs(model->contact); p++) {
    ContactFriction state;

    PetscCall(ContactPairFriction(model->contact, p, &state));
    *rests = (PetscBool)(state.slipping == 0);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Part of the usual drift by which offsets may lag after the solve and so many updates of them, and gaps with friction.
   Solutions that are not the last ones of a step need no other than those within the load's way. */
static PetscErrorCode ModelLag(Model model, PetscInt times, PetscReal *lag)
{
  PetscBool rests;

  PetscFunctionBeginUser;
  *lag = ContactHasFriction(model->contact) ? EQUILIBRIUM_LAG_SLIDING : 1;
  if (model->work->staged) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelRests(model, &rests));
  if (SceneBreaks(model->scene, model->t)) *lag = EQUILIBRIUM_LAG_AT_BREAK;
  if (model->t >= 1) *lag = EQUILIBRIUM_LAG_AT_END;
  if (rests) *lag = EQUILIBRIUM_LAG_AT_REST;
  if (times >= (rests ? EQUILIBRIUM_MAX_REST_UPDATES : EQUILIBRIUM_MAX_OFFSET_UPDATES)) *lag = 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the offsets of contact lag and solutions without friction may be found loosely. */
static PetscBool ModelLags(Model model)
{
  return (PetscBool)(model->contact && ContactOffsetsLag(model->contact) && !ContactHasFriction(model->contact));
}

/* Says whether area factors and fits may lag to the next step: no answers are asked for, and lists have been made anew
   or have held at a solution of this step, so many times. Without that a tube on a barb takes 102 instead of 51
   iterations. A motion that is held is judged by a thousandth of the forces, and what lags is more: with it a coarse
   O-ring in space (30 %, then 4 MPa of fluid) stops at 3.3 MPa, and is done without it. */
static PetscBool ModelPasses(Model model, PetscInt times)
{
  return (PetscBool)(times > 0 && !model->work->hold.wanted && !ModelIsShown(model, model->t));
}

/* Says whether solutions are found loosely at first, because lists will most likely change at the first one: offsets
   lag, and they did not hold at the first solution of the step before, or are not extrapolated, or are to lag less than
   usual. Not so with friction, as what sticks and what slips is not known before. */
static PetscErrorCode ModelSolvesLoosely(Model model, PetscBool *loosely)
{
  const ModelWork *work = model->work;
  PetscReal        lag;

  PetscFunctionBeginUser;
  *loosely = PETSC_FALSE;
  if (!ModelLags(model)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelLag(model, 0, &lag));
  *loosely = (PetscBool)(!work->accepted_held || SceneBreaks(model->scene, work->accepted_t) || lag < 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves with frozen contact lists until the lists hold at the solution. Where they will most likely change after the
   first one, solutions are found loosely, until lists hold at one of them; from there the solve goes on to the
   tolerance. */
static PetscErrorCode ModelSolveLists(Model model, SolveReport *report)
{
  ModelWork *work = model->work;
  PetscBool  hold = PETSC_FALSE, lost = PETSC_FALSE;
  PetscInt   times = 0, first = 0, before;
  PetscReal  lag = 1;

  PetscFunctionBeginUser;
  work->renewed = 0;
  PetscCall(ModelSolvesLoosely(model, &work->loosely));
  while (!hold && report->result == SOLVE_CONVERGED) {
    work->left   = PETSC_FALSE;
    work->nearly = -1;
    before       = report->newton;
    PetscCall(ModelDragSolve(model, report));
    work->begun = 0;
    if (report->result != SOLVE_CONVERGED || !model->contact) break;
    work->renewed += work->left;
    if (!first && !work->left) first = ModelLags(model) && work->nearly >= 0 ? before + work->nearly : report->newton;
    PetscCall(ModelLag(model, times, &lag));
    if (work->left && work->shift.on)
      PetscCall(ModelShiftRenew(model));
    else
      PetscCall(ProblemRenewLists(model->problem, work->accepted_u, work->accepted_t, model->t, work->left, lag,
                                  ModelPasses(model, times + report->stiffened), &hold));
    if (!work->left && !hold) PetscCall(ModelShiftLists(model, model->x, model->problem->expected));
    PetscCall(ContactLocateLost(model->contact, &lost, report->detail, sizeof(report->detail)));
    if (lost) report->result = SOLVE_LOST;
    if (lost || (hold && !work->loosely)) break;
    if (hold) {
      work->loosely = hold = PETSC_FALSE;
      work->begun          = report->newton - before;
      continue;
    }
    report->regathered++;
    work->held = PETSC_FALSE;
    if (!work->left && times++ == EQUILIBRIUM_MAX_LISTS) report->result = SOLVE_LISTS;
    if (!work->left && report->result == SOLVE_CONVERGED) PetscCall(ModelFollowLists(model, report));
  }
  work->loosely = PETSC_FALSE;
  if (!report->first) report->first = times > 1 ? report->newton : first;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves until contact lists hold and incompressible bodies have their volume. */
static PetscErrorCode ModelSolveVolumes(Model model, SolveReport *report)
{
  PetscBool holds = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt times = 0; report->result == SOLVE_CONVERGED; times++) {
    PetscCall(ModelSolveLists(model, report));
    if (report->result != SOLVE_CONVERGED) break;
    PetscCall(ElasticityAugment(model->problem->elasticity, model->problem->trial, &holds));
    if (holds) break;
    if (times == EQUILIBRIUM_MAX_AUGMENT || ElasticityEnclosedChange(model->problem->elasticity))
      report->result = SOLVE_VOLUME;
    report->adjusted++;
    model->work->augmented = PETSC_TRUE;
    model->work->energy    = 0; /* multipliers are part of the energy */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Measures what springs and ties hold at the solution, into the report. *more: the springs hold more than they may.
 *tied: the ties do. *flown: rounding excuses what the springs hold, as displacements have grown, but they have more
   energy than the bodies, as those of a body that a load drives away have. */
static PetscErrorCode ModelMeasureSprings(Model model, SolveReport *report, PetscBool *more, PetscBool *tied,
                                          PetscBool *flown)
{
  const PetscReal scale = ProblemForceScale(model->problem);
  PetscReal       springs, ties, energy, stored, round_off;
  PetscBool       ok;

  PetscFunctionBeginUser;
  PetscCall(ContactSpringsLoad(model->problem->springs, model->x, &springs, &ties, &energy));
  PetscCall(
    ProblemEnergy(model->problem, model->problem->trial, model->t, ENERGY_ELASTIC | ENERGY_CONTACT, &stored, &ok));
  PetscCall(ProblemRoundOff(model->problem, &round_off));
  report->taken += energy;
  report->left  = stored > 0 ? energy / stored : 0;
  report->share = scale > 0 ? springs / scale : 0;
  report->tied  = scale > 0 ? ties / scale : 0;
  *more         = (PetscBool)(springs > PetscMax(round_off, EQUILIBRIUM_SPRINGS * scale));
  *tied         = (PetscBool)(ties > PetscMax(round_off, EQUILIBRIUM_SPRINGS * scale));
  *flown        = (PetscBool)(!*more && springs > EQUILIBRIUM_SPRINGS * scale && energy > stored);
  PetscCall(
    PetscInfo(model->snes, "springs hold %g, ties %g of the forces\n", (double)report->share, (double)report->tied));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends a solve in which springs and ties hold most of the forces. A tool may push a body before it against nothing
   else, which is a solution, or a load moves a body on and on, which is none. */
static PetscErrorCode ModelJudgeDrift(Model model, SolveReport *report)
{
  PetscFunctionBeginUser;
  PetscCall(FreeBodiesLoose(model->problem->bodies, model->problem->trial, model->t, PETSC_TRUE, sizeof(report->detail),
                            report->detail));
  if (report->detail[0]) report->result = SOLVE_ADRIFT;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves on after springs were relaxed and ties released at the solution x. A body that ties have held may not find its
   place without them. It is then tied again where it was. *again: that was done, and no more is to be tried. */
static PetscErrorCode ModelSolveReleased(Model model, SolveReport *report, PetscBool *again)
{
  const Problem problem = model->problem;
  Vec           x;

  PetscFunctionBeginUser;
  *again = PETSC_FALSE;
  PetscCall(VecDuplicate(model->x, &x));
  PetscCall(VecCopy(model->x, x));
  PetscCall(ContactSpringsRelax(problem->springs, x));
  PetscCall(ModelSolveVolumes(model, report));
  if (report->result != SOLVE_CONVERGED) PetscCall(ContactSpringsRetie(problem->springs, again));
  if (*again) {
    problem->tied        = PETSC_TRUE;
    model->work->cycling = PETSC_FALSE;
    report->result       = SOLVE_CONVERGED;
    PetscCall(VecCopy(x, model->x));
    PetscCall(ContactSpringsRelax(problem->springs, x));
    PetscCall(ModelSolveVolumes(model, report));
  }
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves with the springs and ties of free bodies. Springs are so weak that they hold next to nothing where contact
   holds; where they hold more, as with a soft body, they are relaxed and the step is solved on. Ties hold motions that
   no load drives. Those that contact has come to hold are released, and the step is solved on, too. The others stay. */
static PetscErrorCode ModelSolveHeld(Model model, SolveReport *report)
{
  const Problem problem = model->problem;
  PetscBool     more = PETSC_FALSE, tied = PETSC_FALSE, again = PETSC_FALSE, flown;
  KSP           ksp;

  PetscFunctionBeginUser;
  PetscCall(SNESGetKSP(model->snes, &ksp));
  PetscCall(ModelSolveVolumes(model, report));
  for (PetscInt times = 0; problem->springs && report->result == SOLVE_CONVERGED; times++) {
    PetscCall(ModelMeasureSprings(model, report, &more, &tied, &flown));
    if (flown || PetscMax(report->share, report->tied) > EQUILIBRIUM_ALL) {
      PetscCall(ModelJudgeDrift(model, report));
      break;
    }
    if (more && times == EQUILIBRIUM_MAX_RELAX) PetscCall(ModelJudgeDrift(model, report));
    if (again || times == EQUILIBRIUM_MAX_RELAX) break;
    if (tied)
      PetscCall(FreeBodiesRelease(problem->bodies, problem->trial, ProblemForceScale(problem), ksp, problem->springs,
                                  &tied, &report->unstable));
    if (!more && !tied) break;
    report->relaxed++;
    problem->tied = (PetscBool)(problem->tied || tied);
    PetscCall(ModelSolveReleased(model, report, &again));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the run may choose penalties of a pair: those of pressures, or those of what sticks, too. */
static PetscBool ModelChooses(Model model, PetscBool sticks)
{
  for (int p = 0; p < ContactPairs(model->contact); p++) {
    const SceneContact *scene = ContactPairScene(model->contact, p);

    if (sticks ? scene->stick_may_stiffen : scene->penalty_may_stiffen) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Says whether the error that penetration leaves is to be estimated at t: at the end of the load, for the report; where
   the load changes its rate or the scene asks for a step, if the run may choose a penalty; and in every step if it may
   choose both of a pair with friction. What such a pair has slipped with soft penalties stays, and later solutions
   depend on it. */
static PetscBool ModelEstimatesAt(Model model, PetscReal t)
{
  return (PetscBool)(t >= 1 || ModelChooses(model, PETSC_TRUE) ||
                     (ModelChooses(model, PETSC_FALSE) && ModelAsked(model, t)));
}

/* Goes back to the solution x with the penalties before, as no solution was found with those that are factor[] times as
   stiff. The step is not to fail for a smaller error; the estimate says what is left. forecast: see
   ModelSolveStiffened(). */
static PetscErrorCode ModelSoften(Model model, const PetscReal factor[], PetscBool forecast, Vec x, SolveReport *report)
{
  PetscFunctionBeginUser;
  PetscCall(PetscInfo(model->snes, "no solution with stiffer penalties: they stay as they were\n"));
  PetscCall(ModelUnstiffen(model, factor, forecast));
  PetscCall(VecCopy(x, model->x));
  PetscCall(ProblemSetTrial(model->problem, model->x, model->t));
  ContactForgetLost(model->contact);
  model->work->cycling     = PETSC_FALSE;
  model->problem->inverted = -1;
  report->detail[0]        = '\0';
  report->result           = SOLVE_CONVERGED;
  PetscCall(ModelSolveHeld(model, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves on with penalties that are factor[] times as stiff, or, where no solution is found, by the square root of that
   only. If there is none either, the state is the one before. forecast: an estimate says what the raise is to bring. */
static PetscErrorCode ModelSolveStiffened(Model model, PetscReal factor[], PetscBool forecast, SolveReport *report,
                                          ContactWindowState *window)
{
  Vec x;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(model->x, &x));
  PetscCall(VecCopy(model->x, x));
  for (int attempt = 0; attempt < EQUILIBRIUM_RAISES && *window == WINDOW_HOLDS; attempt++) {
    if (attempt) PetscCall(ModelStiffenLess(model, factor, forecast));
    PetscCall(ModelPredictStiffer(model, factor, (PetscBool)(forecast && !attempt), report));
    PetscCall(ModelRaise(model, factor));
    PetscCall(ModelSolveHeld(model, report));
    if (report->result == SOLVE_CONVERGED)
      *window = WINDOW_MISSED;
    else
      PetscCall(ModelSoften(model, factor, forecast, x, report));
    if (report->result != SOLVE_CONVERGED) break;
  }
  PetscCall(VecDestroy(&x));
  if (*window == WINDOW_MISSED || report->result != SOLVE_CONVERGED || !forecast) PetscFunctionReturn(PETSC_SUCCESS);
  report->stiffened = EQUILIBRIUM_MAX_STIFFEN;
  PetscCall(ModelEstimatePenalty(model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves with stiffer penalties, which the run may choose, where nodes stand deep in faces. WINDOW_MISSED: the step
   must be solved on. */
static PetscErrorCode ModelBoundDepth(Model model, SolveReport *report, ContactWindowState *window)
{
  PetscBool  stiffened = PETSC_FALSE;
  PetscReal *factor;

  PetscFunctionBeginUser;
  if (report->deep == EQUILIBRIUM_MAX_DEEP) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(PENALTY_SOURCES * ContactPairs(model->contact), &factor));
  PetscCall(ModelStiffenDeep(model, factor, &stiffened));
  if (stiffened) {
    report->deep++;
    report->adjusted++;
    PetscCall(ModelSolveStiffened(model, factor, PETSC_FALSE, report, window));
    if (*window == WINDOW_HOLDS) report->deep = EQUILIBRIUM_MAX_DEEP;
  }
  PetscCall(PetscFree(factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Estimates what penetration leaves of error, and solves with stiffer penalties, which the run may choose, where that
   is too much. WINDOW_MISSED: the step must be solved on. */
static PetscErrorCode ModelCheckPenalty(Model model, SolveReport *report, ContactWindowState *window)
{
  PetscBool  stiffened = PETSC_FALSE;
  PetscReal *factor;

  PetscFunctionBeginUser;
  PetscCall(ModelEstimatePenalty(model));
  if (report->stiffened == EQUILIBRIUM_MAX_STIFFEN) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(PENALTY_SOURCES * ContactPairs(model->contact), &factor));
  PetscCall(ModelStiffen(model, factor, &stiffened));
  if (stiffened) {
    report->stiffened++;
    report->adjusted++;
    PetscCall(ModelSolveStiffened(model, factor, PETSC_TRUE, report, window));
  }
  PetscCall(PetscFree(factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lets the fluids move at the solution. *moved: the step must be solved on. A fluid that reaches its other end ends the
   solve: how its pressure falls along a leak is not known. */
static PetscErrorCode ModelMoveFluids(Model model, SolveReport *report, PetscBool *moved)
{
  const Fluids fluids = model->problem->fluids;
  PetscBool    leaks, closely;

  PetscFunctionBeginUser;
  PetscCall(FluidMove(fluids, model->problem->trial, model->t, moved));
  PetscCall(FluidReaches(fluids, model->work->accepted_t, model->t, model->scene->stepping.dt_min, &leaks, &closely));
  if (leaks)
    report->result = closely ? SOLVE_LEAKED : SOLVE_LEAK;
  else if (*moved && report->wetted++ == EQUILIBRIUM_MAX_FLUID)
    report->result = SOLVE_FLUID;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends a solve in which a tool has turned too far. */
static PetscErrorCode ModelJudgeTurn(Model model, SolveReport *report)
{
  const MeshTool *tool;
  const PetscReal turn = ToolsTurn(model->mesh, model->work->accepted_u, model->problem->trial, &tool);

  PetscFunctionBeginUser;
  if (report->result != SOLVE_CONVERGED || turn <= EQUILIBRIUM_MOST_TURN) PetscFunctionReturn(PETSC_SUCCESS);
  report->result = SOLVE_TURNED;
  PetscCall(PetscSNPrintf(report->detail, sizeof(report->detail),
                          "'%s' turned by %.4g degrees, of which %.3g are allowed", tool->name,
                          (double)(turn * 180 / PETSC_PI), (double)(EQUILIBRIUM_MOST_TURN * 180 / PETSC_PI)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Begins a load step to model->t by a linear step with the first shift of the tangent. */
static PetscErrorCode ModelStartSlowly(Model model, SolveReport *report)
{
  PetscFunctionBeginUser;
  PetscCall(ModelDepart(model, model->t));
  PetscCall(VecCopy(model->work->accepted_x, model->x));
  PetscCall(ModelShiftLists(model, model->x, model->problem->expected));
  PetscCall(ModelPredict(model, report));
  PetscCall(ModelPredictFar(model, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends a solve before it begins where its first iterate turns surfaces that lie opposite each other too far for the
   lists of the step. The iterate remains as the look-ahead of a shorter step. */
static PetscErrorCode ModelJudgeFacing(Model model, SolveReport *report)
{
  ModelWork *work = model->work;

  PetscFunctionBeginUser;
  if (!model->contact || report->result != SOLVE_CONVERGED || PetscIsInfReal(model->most_facing))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemSetTrial(model->problem, model->x, model->t));
  PetscCall(ContactFacingTurn(model->contact, work->accepted_u, model->problem->trial, &report->facing));
  if (report->facing <= model->most_facing) PetscFunctionReturn(PETSC_SUCCESS);
  report->result = SOLVE_FACING;
  if (work->looked_ahead) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecCopy(model->x, work->look_ahead));
  work->look_ahead_t            = model->t;
  work->look_ahead_extrapolated = work->extrapolated;
  work->looked_ahead            = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether a solve has failed on its way from the first iterate. */
static PetscBool LosesWay(SolveResult result)
{
  return (PetscBool)(result == SOLVE_ITERATIONS || result == SOLVE_STALLED || result == SOLVE_LINE_SEARCH ||
                     result == SOLVE_DOMAIN || result == SOLVE_CYCLE);
}

/* Finds the first solution of a load step to t from the accepted state once more, by way of softened penalties for all
   contact. */
static PetscErrorCode ModelSolveSoftly(Model model, PetscReal t, SolveReport *report)
{
  PetscFunctionBeginUser;
  PetscCall(PetscInfo(model->snes, "%s: once more with softened penalties\n", SolveResults[report->result]));
  report->result = SOLVE_CONVERGED;
  PetscCall(ModelDepart(model, t));
  PetscCall(ModelStart(model, report));
  if (SolveHasNotBegun(report->result)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelRampPenalty(model, PETSC_TRUE, report));
  if (report->result == SOLVE_CONVERGED) PetscCall(ModelSolveHeld(model, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the first solution of a load step to t from the accepted state once more, with springs against sliding instead
   of held motions. */
static PetscErrorCode ModelSolveDragged(Model model, PetscReal t, SolveReport *report)
{
  PetscFunctionBeginUser;
  report->result = SOLVE_CONVERGED;
  PetscCall(ModelDragNote(model));
  PetscCall(ModelDragStart(model));
  PetscCall(ModelDepart(model, t));
  PetscCall(ModelStart(model, report));
  if (SolveHasNotBegun(report->result)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelSolveHeld(model, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves on until lists hold and springs hold little. Where that finds no way, the load step to t begins once more with
   springs against sliding, if held motions may give way to them. */
static PetscErrorCode ModelSolveOn(Model model, PetscReal t, SolveReport *report)
{
  PetscFunctionBeginUser;
  if (report->result == SOLVE_CONVERGED) PetscCall(ModelSolveHeld(model, report));
  if ((LosesWay(report->result) || report->result == SOLVE_LISTS) && ModelMayDrag(model))
    PetscCall(ModelSolveDragged(model, t, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the first solution of a load step to t from the accepted state. */
static PetscErrorCode ModelSolveFirst(Model model, PetscReal t, PetscBool slowly, SolveReport *report)
{
  PetscBool overdone;

  PetscFunctionBeginUser;
  if (slowly) {
    model->t = t;
    PetscCall(ModelSolveDamped(model, ModelStartSlowly, ModelSolveHeld, report));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ModelDepart(model, t));
  if (model->work->adrift) {
    report->result = SOLVE_ADRIFT;
    PetscCall(ProblemSetTrial(model->problem, model->x, model->t));
  } else
    PetscCall(ModelStart(model, report));
  PetscCall(ModelJudgeFacing(model, report));
  if (SolveHasNotBegun(report->result)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelContactOverdone(model, &overdone));
  PetscCall(ModelRampPenalty(model, PETSC_FALSE, report));
  PetscCall(ModelSolveOn(model, t, report));
  if (overdone && LosesWay(report->result)) PetscCall(ModelSolveSoftly(model, t, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends a solve: says why it failed, or takes the solution. */
static PetscErrorCode ModelEndSolve(Model model, SolveReport *report)
{
  PetscFunctionBeginUser;
  PetscCall(ModelJudgeTurn(model, report));
  report->cycles   = model->work->cycles;
  report->motions  = model->work->drag.on ? 1 : model->work->hold.wanted;
  report->friction = model->work->hold.wanted ? model->work->hold.friction : model->work->drag.friction;
  PetscCall(PetscStrncpy(report->cycle, model->work->cycle, sizeof(report->cycle)));
  if (report->result != SOLVE_CONVERGED) {
    PetscCall(ModelExplainFailure(model, report));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscArraycpy(model->u, model->problem->trial, model->mesh->n_nodes * model->mesh->dim));
  PetscCall(ModelFindStability(model, report));
  PetscCall(ModelFindJump(model, report));
  if (report->result != SOLVE_CONVERGED) PetscCall(ModelExplainFailure(model, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether lists need not settle before penalties are as stiff as they are to be: friction may rest at t, and the
   run may choose penalties. Each settling takes up to EQUILIBRIUM_MAX_REST_UPDATES lists, and penalties change up to
   EQUILIBRIUM_MAX_STIFFEN times: a clamp of 2160 dofs took 41 lists at two breaks. */
static PetscBool ModelStages(Model model, PetscReal t)
{
  return (PetscBool)(ModelIsShown(model, t) && ContactHasFriction(model->contact) && ModelChooses(model, PETSC_FALSE));
}

/* Ends the stages of penalties: lists are to settle at the next solution, if they need not at the one found. */
static void ModelEndStages(Model model, ContactWindowState *window)
{
  if (model->work->staged) *window = WINDOW_MISSED;
  model->work->staged = PETSC_FALSE;
}

/* Finds equilibrium at t, at once or slowly. */
static PetscErrorCode ModelSolveWay(Model model, PetscReal t, PetscBool slowly, SolveReport *report)
{
  ContactWindowState window = WINDOW_MISSED;
  PetscBool          moved;

  PetscFunctionBeginUser;
  *report             = (SolveReport){.result = SOLVE_CONVERGED, .failure = {.inverted = -1, .inverted_body = -1}};
  model->work->staged = ModelStages(model, t);
  PetscCall(ModelSolveFirst(model, t, slowly, report));
  while (model->contact && window == WINDOW_MISSED && report->result == SOLVE_CONVERGED) {
    PetscCall(ModelMoveFluids(model, report, &moved));
    if (!moved && report->result == SOLVE_CONVERGED) {
      PetscCall(ContactAdjustPenalty(model->contact, &window));
      report->adjusted += window == WINDOW_MISSED;
      if (window == WINDOW_AT_BOUND) {
        PetscCall(ContactLocateOutside(model->contact, report->detail, sizeof(report->detail)));
        report->result = SOLVE_WINDOW;
      }
      if (window == WINDOW_HOLDS && ModelEstimatesAt(model, t)) PetscCall(ModelCheckPenalty(model, report, &window));
      if (window == WINDOW_HOLDS && report->result == SOLVE_CONVERGED)
        PetscCall(ModelBoundDepth(model, report, &window));
      if (window == WINDOW_HOLDS && report->result == SOLVE_CONVERGED) ModelEndStages(model, &window);
    }
    if (window == WINDOW_MISSED && report->result == SOLVE_CONVERGED) PetscCall(ModelSolveOn(model, t, report));
  }
  model->work->staged = PETSC_FALSE;
  PetscCall(ModelShiftEnd(model, &report->damping));
  PetscCall(ModelEndSolve(model, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelSolve - finds equilibrium at a load parameter, starting from the accepted state.

  Collective

  Input Parameters:
+ model - it has an accepted state
- t     - load parameter

  Output Parameter:
. report - whether equilibrium was found, what the solve cost, and where a failed solve failed

  Notes:
  On success model->u, model->x and the contact state are the solution, which is not accepted yet. On failure the caller
  must call ModelRestore(). With SOLVE_FACING the solve has not begun, and a shorter step takes its first iterate. With
  SOLVE_FAR it has not begun, either.

  Contact lists are made before the first solve and are frozen in each solve by Newton's method. After each solve they
  are checked and made anew, at most EQUILIBRIUM_MAX_LISTS times. Then penalties that are adjusted within the step are
  changed, and the step is solved on from there, until the penetrations are in their window or no more can be done. At
  t = 1, at breakpoints of the load and where the scene asks for a step, the error that penetration leaves is estimated,
  and penalties that no key of the scene sets are made stiffer where it is large. With friction that is done in every
  step.
@*/
PetscErrorCode ModelSolve(Model model, PetscReal t, SolveReport *report)
{
  PetscFunctionBeginUser;
  PetscCall(ModelSolveWay(model, t, PETSC_FALSE, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelSolveSlowly - finds equilibrium at a load parameter by Newton's method with shifted tangents.

  Collective

  Input Parameters:
+ model - it has an accepted state
- t     - load parameter

  Output Parameter:
. report - as ModelSolve() says; report->damping is the energy that was taken away

  Note:
  For load steps at which ModelSolve() fails, as where a body snaps through. See ModelSolveDamped().
@*/
PetscErrorCode ModelSolveSlowly(Model model, PetscReal t, SolveReport *report)
{
  PetscFunctionBeginUser;
  PetscCall(ModelSolveWay(model, t, PETSC_TRUE, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelLookAhead - computes displacements at t by one linear solve with the contact set of the accepted state.

  Collective

  Input Parameters:
+ model - it has an accepted state, at which it stands
- t     - load parameter

  Output Parameters:
+ u      - local displacements u[n_nodes*dim] (length), prescribed ones included
- report - the solve's costs and failures are added to it

  Notes:
  The result is a guess from which the caller may see what will touch. The state is the accepted one afterwards, and the
  contact lists are those for the way to t. The next ModelSolve() starts from this result instead of a prediction of its
  own, so that the linear solve is made only once.
@*/
PetscErrorCode ModelLookAhead(Model model, PetscReal t, PetscReal *u, SolveReport *report)
{
  const PetscInt regathered = report->regathered;

  PetscFunctionBeginUser;
  PetscCall(ModelDepart(model, t));
  PetscCall(ModelPredict(model, report));
  if (report->regathered > regathered)
    PetscCall(ProblemGatherLists(model->problem, model->work->accepted_u, model->work->accepted_t, t,
                                 model->problem->expected));
  PetscCall(ProblemSetTrial(model->problem, model->x, model->t));
  PetscCall(PetscArraycpy(u, model->problem->trial, model->mesh->n_nodes * model->mesh->dim));
  PetscCall(VecCopy(model->x, model->work->look_ahead));
  PetscCall(VecCopy(model->work->accepted_x, model->x));
  model->work->look_ahead_t            = t;
  model->work->look_ahead_extrapolated = model->work->extrapolated;
  model->work->looked_ahead            = report->result == SOLVE_CONVERGED ? PETSC_TRUE : PETSC_FALSE;
  model->t                             = model->work->accepted_t;
  PetscCall(FluidRestore(model->problem->fluids, model->work->accepted_u, model->t));
  PetscFunctionReturn(PETSC_SUCCESS);
}
