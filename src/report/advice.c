/* Situations of a run and the changes that help in them, see advice.h. */
#include "advice.h"
#include "runlength.h"
#include <math.h>
#include <string.h>

/* Estimated error by penetration above which a stiffer penalty is advised, and the error that it is to leave. */
#define ADVICE_PENALTY        0.01
#define ADVICE_PENALTY_WANTED 0.003
/* Stiffer penalties still raise the forces by more than this part of their own factor. */
#define ADVICE_NO_ROOM 0.5
/* The facets' own error hides what contact resolves if it is this many penetrations. */
#define ADVICE_FACETS 10
/* Part of the slave points that may be on the lower rungs. Free ends and corners of a surface put some points there. */
#define ADVICE_FALL_BACKS 0.1
/* Part of a face of the slave by which the smooth surface and the master's faces may be apart where they meet. */
#define ADVICE_APART 0.05
/* Parts of the steps that may fail or be taken back before another step size is cheaper. */
#define ADVICE_FAILED   0.25
#define ADVICE_REPEATED 0.5
/* Lists made anew for each step, and the part of the time that search and fits may take, before shorter steps may be
   cheaper. What sliding far in a step costs in search is otherwise less than what more steps cost in solves. */
#define ADVICE_REGATHERED 1
#define ADVICE_SEARCH     0.5
/* Iterations of an accepted step above which the step is too long, and the part of them that the line search may
   shorten. Above these Newton's method works far from its end. */
#define ADVICE_ITERATIONS 12
#define ADVICE_CUTS       0.34
/* Part of the time that writing may take, in a run that is long enough to matter (s). */
#define ADVICE_OUTPUT   0.3
#define ADVICE_OUTPUT_S 10
/* Part of the time that the direct solver may take where the BLAS uses kernels for an older processor, in a run that
   is long enough to matter (s). The iterative solver takes a twentieth longer with such kernels. */
#define ADVICE_SOLVER   0.3
#define ADVICE_SOLVER_S 10

/* Part of a face size that a master node may stand in the slave, and by how much that is to exceed the slave's own
   penetration: less is the shape of the faces. */
#define ADVICE_STANDS      0.05
#define ADVICE_STANDS_OVER 2
/* Scatter of nodal pressures above which their peak is not to be trusted: it is wrong by 1.4 to 2 times as much. */
#define ADVICE_SCATTER 0.05
/* Part of the energy of friction that nodes may take whose slip turns by more than 10 degrees within a step: the
   direction of their forces lags by about half of the angle. */
#define ADVICE_TURNED 0.1
/* Part of the force of a contact with friction at nodes that have come in within a step as others left, and the one
   that shorter steps are to leave. On a rolling wheel the thrust is off by about as much. */
#define ADVICE_TRAVEL        0.02
#define ADVICE_TRAVEL_WANTED 0.01
/* Part of the shear stress of a plastic flow that a step may lose, and the one that smaller steps are to leave. */
#define ADVICE_FLOW        0.01
#define ADVICE_FLOW_WANTED 0.003
/* Part by which stresses may lag behind plastic flow in the mean over the plastic work, and the one that smaller steps
   are to leave. On a pin that is pressed into a bore forces are off by 0.6 of it. */
#define ADVICE_LAG        0.05
#define ADVICE_LAG_WANTED 0.025
/* Distance of the work on plastic bodies from what they store and dissipate, over the plastic work, above which steps
   are too long. Over a straight path the trapezoidal rule over ten steps is off by a few per cent; a point that yields
   and unloads within a step, or the other way round, takes part of the plastic work out of the balance at any length.
 */
#define ADVICE_PATH 0.05
/* It is to be more than this part of both energies, which the rule loses of elastic energy alone: on a force that grows
   with the power 1.5 of the way it is off by 0.31/n^2 over n steps, which is 1 % where n is 5 or 6. */
#define ADVICE_PATH_ELASTIC 0.01
/* Distance of work and energies over the energy that friction took, above which steps are too long for what slides. The
   rule over a few steps is off by some of it even where forces grow evenly; where a cap snaps over its neck in one step
   it is off by twice of it, and friction takes 40 % too little. */
#define ADVICE_SLIDING 0.5
/* Penetration of a slave node (face sizes) at which contact is lost because the penalty is soft, and the one that a
   stiffer penalty is to leave. */
#define ADVICE_DEEP        0.5
#define ADVICE_DEEP_WANTED 0.01

/* A cell squeezed to this part of its length in some direction may be where the law svk loses its stiffness: in
   uniaxial compression that is at 1/sqrt(3) = 0.577. */
#define ADVICE_SQUEEZED 0.7

/* Part of what a body stores that may be in strains which vary within its elements. A wall of two elements that are as
   long as wide has 0.33 and is 13 % too stiff; one of four has 0.09 and is 3 %. */
#define ADVICE_VARIATION 0.2

/* A rule writes into text[ADVICE_TEXT] what is wrong and returns a positive number if it applies, else 0: for the run,
   for a body, and for a pair. Where a value is wrong by a known factor, that is the number; else it is 1. */
typedef double (*RunRuleFn)(const RunFigures *, char *text);
typedef double (*BodyRuleFn)(const RunFigures *, int body, char *text);
typedef double (*PairRuleFn)(const RunFigures *, const PairFigures *, char *text);

/* The largest error by penetration that counts for a pair. */
static PetscReal ErrorByPenetration(const PairFigures *pair)
{
  const PenaltyError *part = &pair->penalty_error;

  return PetscMax(PetscMax(part->force, part->displacement), pair->scene->penalty_may_stiffen ? 0 : part->pressure);
}

static double PenetrationIsDeep(const RunFigures *figures, const PairFigures *pair, char *text)
{
  const SceneContact *scene = pair->scene;
  const PetscReal     error = ErrorByPenetration(pair);

  (void)figures;
  if (scene->adjust || scene->augment || pair->penalty_stays || !(error > ADVICE_PENALTY)) return 0;
  snprintf(text, ADVICE_TEXT, "%s: penetration leaves about %.2g %% of error", pair->name, (double)(100 * error));
  return (double)(error / ADVICE_PENALTY_WANTED);
}

/* Forces follow the penalty where bodies that keep their volume have no room: they overlap then, stiff as it may be. */
static double ForcesFollowPenalty(const RunFigures *figures, const PairFigures *pair, char *text)
{
  (void)figures;
  if (!pair->penalty_stays || !(pair->penalty_error.force > ADVICE_NO_ROOM)) return 0;
  snprintf(text, ADVICE_TEXT, "%s: penetration leaves about %.2g %% of error, as forces grow with the penalty",
           pair->name, (double)(100 * pair->penalty_error.force));
  return 1;
}

static double PenetrationStays(const RunFigures *figures, const PairFigures *pair, char *text)
{
  const PetscReal error = ErrorByPenetration(pair);

  (void)figures;
  if (!pair->penalty_stays || !(error > ADVICE_PENALTY) || pair->penalty_error.force > ADVICE_NO_ROOM) return 0;
  snprintf(text, ADVICE_TEXT, "%s: penetration leaves about %.2g %% of error, which stiffer penalties hardly lower",
           pair->name, (double)(100 * error));
  return 1;
}

static double SlipIsElastic(const RunFigures *figures, const PairFigures *pair, char *text)
{
  const PetscReal error = PetscMax(pair->penalty_error.slip_force, pair->penalty_error.slip_displacement);

  (void)figures;
  if (!pair->scene->friction || !(error > ADVICE_PENALTY)) return 0;
  snprintf(text, ADVICE_TEXT, "%s: elastic slip leaves about %.2g %% of error", pair->name, (double)(100 * error));
  return (double)(error / ADVICE_PENALTY_WANTED);
}

static double SlaveHangsOver(const RunFigures *figures, const PairFigures *pair, char *text)
{
  (void)figures;
  if (!pair->quality.hanging) return 0;
  snprintf(text, ADVICE_TEXT, "%s: %lld slave points hang over the end of '%s' and take no part there", pair->name,
           (long long)pair->quality.hanging, pair->scene->master);
  return 1;
}

/*@
  AdviceMasterStands - says whether nodes of a pair's master stand in the slave by more than contact explains.

  Not collective

  Input Parameter:
. pair - its figures
@*/
PetscBool AdviceMasterStands(const PairFigures *pair)
{
  return (PetscBool)(pair->master.over_h > ADVICE_STANDS &&
                     pair->master.depth > ADVICE_STANDS_OVER * pair->quality.max_penetration);
}

static double MasterStandsIn(const RunFigures *figures, const PairFigures *pair, char *text)
{
  const NodeDepth *master = &pair->master;

  (void)figures;
  if (!AdviceMasterStands(pair)) return 0;
  snprintf(text, ADVICE_TEXT,
           "%s: nodes of '%s' stand up to %.2g of a face deep between the slave's, displacements may be off by %.2g%s",
           pair->name, pair->scene->master, (double)master->over_h, (double)master->depth,
           pair->quality.edges ? "" : ", and an edge presses there square to its sides, not to the slave");
  return 1;
}

static double EdgesPress(const RunFigures *figures, const PairFigures *pair, char *text)
{
  (void)figures;
  if (!pair->quality.edges) return 0;
  snprintf(
    text, ADVICE_TEXT,
    "%s: sharp edges of '%s' press on single faces of '%s': where the dent is as deep as a face, forces across an "
    "edge may be off by a third of its force",
    pair->name, pair->scene->master, pair->scene->slave);
  return 1;
}

static double PressuresScatter(const RunFigures *figures, const PairFigures *pair, char *text)
{
  (void)figures;
  if (!(pair->scatter > ADVICE_SCATTER)) return 0;
  snprintf(text, ADVICE_TEXT, "%s: nodal pressures scatter by %.0f %% rms from node to node, their peak by more",
           pair->name, (double)(100 * pair->scatter));
  return 1;
}

static double SlipTurns(const RunFigures *figures, const PairFigures *pair, char *text)
{
  const ContactFriction *friction = &pair->friction;

  (void)figures;
  if (!(friction->turned > ADVICE_TURNED * friction->dissipated)) return 0;
  snprintf(text, ADVICE_TEXT,
           "%s: %.2g %% of the energy of friction is taken where the slip turns by more than 10 degrees in a step",
           pair->name, (double)(100 * friction->turned / friction->dissipated));
  return 1;
}

static double ContactTravels(const RunFigures *figures, const PairFigures *pair, char *text)
{
  const double travel = (double)pair->friction.travel;

  (void)figures;
  if (!(travel > ADVICE_TRAVEL)) return 0;
  snprintf(text, ADVICE_TEXT,
           "%s: contact travels along the slave: nodes that come in within a step and stick bear up to %.2g %% of its "
           "force, and forces of friction may be off by as much",
           pair->name, 100 * travel);
  return travel / ADVICE_TRAVEL_WANTED;
}

static double FacetsAreCoarse(const RunFigures *figures, const PairFigures *pair, char *text)
{
  const PetscReal error = pair->quality.sagitta, small = PetscMax(pair->quality.max_penetration, 0);

  (void)figures;
  if (pair->fits.points || !pair->quality.nodes || error <= ADVICE_FACETS * small) return 0;
  snprintf(text, ADVICE_TEXT, "%s: the facets' own error, about %.2g, is %.2g times the penetration", pair->name,
           (double)error, (double)(error / small));
  return 1;
}

static double FitsFallBack(const RunFigures *figures, const PairFigures *pair, char *text)
{
  const PetscInt low = pair->fits.within_low; /* points beyond the master's end fall back for that alone */

  (void)figures;
  if (low <= ADVICE_FALL_BACKS * pair->fits.within) return 0;
  snprintf(text, ADVICE_TEXT, "%s: %lld of %lld slave points have no fit of their degree", pair->name, (long long)low,
           (long long)pair->fits.within);
  return 1;
}

static double FitsAreApart(const RunFigures *figures, const PairFigures *pair, char *text)
{
  (void)figures;
  if (!pair->quality.nodes || !(pair->fits.apart_over_h > ADVICE_APART)) return 0;
  snprintf(text, ADVICE_TEXT, "%s: the smooth surface is up to %.2g of a face of the slave off the faces of '%s'",
           pair->name, (double)pair->fits.apart_over_h, pair->scene->master);
  return 1;
}

static double WindowIsMissed(const RunFigures *figures, const PairFigures *pair, char *text)
{
  (void)figures;
  if (pair->scene->augment || !pair->window.outside) return 0;
  snprintf(text, ADVICE_TEXT, "%s: %lld of %lld loaded nodes are outside the window", pair->name,
           (long long)pair->window.outside, (long long)pair->window.loaded);
  return 1;
}

static double UpdatesAreFew(const RunFigures *figures, const PairFigures *pair, char *text)
{
  if (!pair->window.missed) return 0;
  snprintf(text, ADVICE_TEXT,
           "%s: %lld of %lld steps ended with nodes beyond g_max after max_updates, the last with %lld of %lld nodes "
           "up to %.3g g_max",
           pair->name, (long long)pair->window.missed, (long long)figures->run->way->steps,
           (long long)pair->window.outside, (long long)pair->window.loaded, (double)pair->window.excess);
  return 1;
}

static double BodyLocks(const RunFigures *figures, int b, char *text)
{
  const SceneBody *body = &figures->scene->bodies[b];

  if (!body->locks) return 0;
  if (MaterialGetLaw(body->material.law)->plastic)
    snprintf(text, ADVICE_TEXT,
             "body '%s' flows in elements of first order with full integration, which lock (too stiff)", body->name);
  else
    snprintf(text, ADVICE_TEXT,
             "body '%s' has nu = %g in elements of first order with full integration, which lock (too stiff)",
             body->name, body->material.nu);
  return 1;
}

static double BodyBends(const RunFigures *figures, int b, char *text)
{
  const PetscReal part = figures->variation[b];

  if (figures->scene->bodies[b].locks || part <= ADVICE_VARIATION) return 0;
  snprintf(text, ADVICE_TEXT,
           "body '%s' stores %.0f %% of its energy in strains that vary within elements of first order: it bends, and "
           "they bend too stiffly",
           figures->scene->bodies[b].name, (double)(100 * part));
  return 1;
}

static double StepsFail(const RunFigures *figures, char *text)
{
  const StepperReport *way = figures->run->way;

  if (!way->done || way->steps_failed <= ADVICE_FAILED * PetscMax(way->steps, 1)) return 0;
  snprintf(text, ADVICE_TEXT, "%lld steps failed on the way to %lld", (long long)way->steps_failed,
           (long long)way->steps);
  return 1;
}

static double StepsRepeat(const RunFigures *figures, char *text)
{
  const StepperReport *way = figures->run->way;

  if (way->leaks || way->steps_repeated <= ADVICE_REPEATED * PetscMax(way->steps, 1)) return 0;
  snprintf(text, ADVICE_TEXT, "%lld steps were taken back by the control", (long long)way->steps_repeated);
  return 1;
}

static double NeighbourListsAreRemade(const RunFigures *figures, char *text)
{
  const PetscInt  times   = figures->run->way->regathered;
  const PetscReal seconds = figures->usage.seconds[TIMING_SEARCH] + figures->usage.seconds[TIMING_FIT];

  if (times <= ADVICE_REGATHERED * PetscMax(figures->run->way->steps, 1)) return 0;
  if (seconds <= ADVICE_SEARCH * figures->usage.wall_s) return 0;
  snprintf(text, ADVICE_TEXT,
           "search took %.0f %% of the time: contact slides far in a step, and lists were made anew %lld times within "
           "steps; smaller ones may be cheaper",
           (double)(100 * seconds / figures->usage.wall_s), (long long)times);
  return 1;
}

static double StepsAreLong(const RunFigures *figures, char *text)
{
  const StepperReport *way  = figures->run->way;
  const PetscReal      each = (PetscReal)way->newton_accepted / PetscMax(way->steps, 1);

  if (each <= ADVICE_ITERATIONS) return 0;
  snprintf(text, ADVICE_TEXT, "%.1f iterations a step; smaller ones may need fewer in all", (double)each);
  return 1;
}

static double LineSearchCuts(const RunFigures *figures, char *text)
{
  const StepperReport *way = figures->run->way;

  if (LoadStepperCuts(way) <= ADVICE_CUTS * way->newton_iterations) return 0;
  snprintf(text, ADVICE_TEXT, "the line search shortened %lld of %lld iterations", (long long)LoadStepperCuts(way),
           (long long)way->newton_iterations);
  return 1;
}

/* A step takes the directions of its flow from the whole stretch since its start. In simple shear these lag behind the
   true ones: where the equivalent plastic strain grows by a in a step, the shear stress at its end is the true one over
   cosh(sqrt(3)/2 a). Flow along a straight path of the logarithmic strain loses nothing. */
static double FlowLoss(double growth)
{
  return 1 - 1 / cosh(sqrt(3) / 2 * growth);
}

static double FlowTurns(const RunFigures *figures, char *text)
{
  const double growth = figures->last ? (double)figures->last->energy.growth : 0, loss = FlowLoss(growth);

  if (figures->scene->kinematics != KINEMATICS_FINITE || !(loss > ADVICE_FLOW)) return 0;
  snprintf(text, ADVICE_TEXT,
           "plastic strain grows by up to %.2g in a step, which costs a flow in shear %.2g %% of its stress", growth,
           100 * loss);
  return growth / (2 / sqrt(3) * acosh(1 / (1 - ADVICE_FLOW_WANTED)));
}

/* Steps take one direction for their whole flow; where it turns, as below contact that travels, stresses lag behind it.
 */
static double FlowLags(const RunFigures *figures, char *text)
{
  const EnergyFigures energy = figures->last ? figures->last->energy : (EnergyFigures){0};
  const double        lag    = energy.plastic > 0 ? (double)(energy.lag / energy.plastic) : 0;

  if (!(lag > ADVICE_LAG)) return 0;
  snprintf(text, ADVICE_TEXT,
           "stresses lag behind the turns of plastic flow by %.2g %%, and forces may be off by as much", 100 * lag);
  return lag / ADVICE_LAG_WANTED;
}

/* Plastic work depends on the path. A step knows nothing of what loads and unloads within it, as where contact travels
   along a body that flows. Then the work of the forces at the ends of the steps is not what the body took. */
static double PathIsCoarse(const RunFigures *figures, char *text)
{
  const EnergyFigures energy  = figures->last ? figures->last->energy : (EnergyFigures){0};
  const double        plastic = (double)energy.plastic, sum = (double)energy.elastic + plastic,
               lost = plastic + (double)energy.outer.friction, bodies = fabs((double)energy.work - sum),
               outside  = (double)EnergyApart(&energy);
  const PetscBool inner = (PetscBool)(bodies > ADVICE_PATH * plastic && bodies > ADVICE_PATH_ELASTIC * sum),
                  outer = (PetscBool)(outside > ADVICE_PATH * lost && outside > ADVICE_PATH_ELASTIC * sum);

  if (!(plastic > 0 && (inner || outer))) return 0;
  snprintf(
    text, ADVICE_TEXT,
    "work and energies are %.2g %% of %s apart: steps may be too long for the path of plastic flow and of contact, and "
    "forces and strains wrong; compare with shorter ones",
    100 * (inner ? bodies / plastic : outside / lost),
    inner || !(energy.outer.friction > 0) ? "the plastic work" : "plastic work and friction");
  return 1;
}

/* What friction takes depends on the path, and so does the largest force on it. Where it takes next to nothing beside
   what bodies store, the rule's own error for these is all that is seen. */
static double SlidingIsCoarse(const RunFigures *figures, char *text)
{
  const EnergyFigures energy = figures->last ? figures->last->energy : (EnergyFigures){0};
  const double        taken = (double)energy.outer.friction, apart = (double)EnergyApart(&energy);

  if (energy.plastic > 0 || !(taken > 0) || !(apart > ADVICE_SLIDING * taken)) return 0;
  if (!(fmin(apart, taken) > ADVICE_PATH_ELASTIC * (double)energy.elastic)) return 0;
  snprintf(text, ADVICE_TEXT,
           "work and energies are %.2g %% of what friction took apart: steps may be too long for what slides, and that "
           "energy and the largest force on the way wrong; compare with shorter ones",
           100 * apart / taken);
  return 1;
}

static double OutputIsSlow(const RunFigures *figures, char *text)
{
  const PetscReal seconds = figures->usage.seconds[TIMING_OUTPUT];

  if (seconds <= ADVICE_OUTPUT_S || seconds <= ADVICE_OUTPUT * figures->usage.wall_s) return 0;
  snprintf(text, ADVICE_TEXT, "writing took %.0f %% of the time", (double)(100 * seconds / figures->usage.wall_s));
  return 1;
}

static double StepsAreMany(const RunFigures *figures, char *text)
{
  return RunStepsAreMany(figures->scene, figures->run->way->steps, figures->run->way->steps_failed, text);
}

static double ResultsAreLarge(const RunFigures *figures, char *text)
{
  return RunResultsAreLarge(figures->scene, figures->results_bytes, 1, text);
}

static double KernelsAreOld(const RunFigures *figures, char *text)
{
  const PetscReal seconds = figures->usage.seconds[TIMING_SOLVE];
  const Blas     *blas    = &figures->blas;

  if (!blas->faster_kernels || !figures->direct || seconds <= ADVICE_SOLVER_S ||
      seconds <= ADVICE_SOLVER * figures->usage.wall_s)
    return 0;
  snprintf(text, ADVICE_TEXT,
           "the direct solver took %.0f %% of the time, with OpenBLAS's kernels for older processors (%s)",
           (double)(100 * seconds / figures->usage.wall_s), blas->kernels);
  return 1;
}

/* What is wrong, and the changes that help, the best first */
typedef struct {
  PairRuleFn pair;
  BodyRuleFn body;
  RunRuleFn  run;
  ChangeKind changes[ADVICE_CHANGES];
} Situation;

static const Situation situations[] = {
  {.pair = PenetrationIsDeep, .changes = {CHANGE_FREE_PENALTY, CHANGE_STIFFER}},
  {.pair = ForcesFollowPenalty, .changes = {CHANGE_ROOM}},
  {.pair = PenetrationStays, .changes = {CHANGE_FINER_SLAVE}},
  {.pair = SlipIsElastic, .changes = {CHANGE_STICK}},
  {.pair = SlaveHangsOver, .changes = {CHANGE_WHOLE_MASTER}},
  {.pair = MasterStandsIn, .changes = {CHANGE_FINER_SLAVE, CHANGE_ROLES}},
  {.pair = EdgesPress, .changes = {CHANGE_FINER_SLAVE}},
  {.pair = PressuresScatter, .changes = {CHANGE_SURFACE, CHANGE_FINER_SLAVE}},
  {.pair = SlipTurns, .changes = {CHANGE_SHORTER}},
  {.pair = ContactTravels, .changes = {CHANGE_TRAVEL}},
  {.pair = FacetsAreCoarse, .changes = {CHANGE_DIFFUSE, CHANGE_FINER_MASTER}},
  {.pair = FitsFallBack, .changes = {CHANGE_FINER_MASTER, CHANGE_SYMMETRY, CHANGE_DEGREE_2}},
  {.pair = FitsAreApart, .changes = {CHANGE_FINER_MASTER}},
  {.pair = WindowIsMissed, .changes = {CHANGE_WHEN_CONVERGED, CHANGE_WIDER_WINDOW, CHANGE_RANGE}},
  {.pair = UpdatesAreFew, .changes = {CHANGE_STIFFER, CHANGE_UPDATES, CHANGE_WIDER_WINDOW}},
  {.body = BodyLocks, .changes = {CHANGE_AUTO, CHANGE_SECOND_ORDER}},
  {.body = BodyBends, .changes = {CHANGE_SECOND_ORDER, CHANGE_ENHANCED}},
  {.run = StepsFail, .changes = {CHANGE_SHORTER}},
  {.run = StepsRepeat, .changes = {CHANGE_PREDICTION, CHANGE_MORE_NODES}},
  {.run = NeighbourListsAreRemade, .changes = {CHANGE_SHORTER}},
  {.run = StepsAreLong, .changes = {CHANGE_SHORTER}},
  {.run = LineSearchCuts, .changes = {CHANGE_SHORTER}},
  {.run = FlowTurns, .changes = {CHANGE_FLOW}},
  {.run = FlowLags, .changes = {CHANGE_LAG}},
  {.run = PathIsCoarse, .changes = {CHANGE_PATH}},
  {.run = SlidingIsCoarse, .changes = {CHANGE_PATH}},
  {.run = OutputIsSlow, .changes = {CHANGE_OUTPUT}},
  {.run = StepsAreMany, .changes = {CHANGE_LONGER}},
  {.run = ResultsAreLarge, .changes = {CHANGE_LESS_OUTPUT}},
  {.run = KernelsAreOld, .changes = {CHANGE_KERNELS}}};

/* What is tried after each kind of failed solve, the most promising first. The last one of each can always be made. */
static const ChangeKind tries[][ADVICE_CHANGES] = {
  [SOLVE_CONVERGED]   = {CHANGE_NONE},
  [SOLVE_ITERATIONS]  = {CHANGE_WHOLE_MASTER, CHANGE_ITERATIONS, CHANGE_SHORTER_MIN, CHANGE_DIFFUSE, CHANGE_SOFTER,
                         CHANGE_DAMPING, CHANGE_SHORTER, CHANGE_CHECK},
  [SOLVE_STALLED]     = {CHANGE_WHOLE_MASTER, CHANGE_SHORTER_MIN, CHANGE_DIFFUSE, CHANGE_SOFTER, CHANGE_DAMPING,
                         CHANGE_SHORTER, CHANGE_CHECK},
  [SOLVE_LINE_SEARCH] = {CHANGE_WHOLE_MASTER, CHANGE_SHORTER_MIN, CHANGE_DIFFUSE, CHANGE_SOFTER, CHANGE_DISPLACEMENT,
                         CHANGE_DAMPING, CHANGE_SHORTER, CHANGE_CHECK},
  [SOLVE_DOMAIN]      = {CHANGE_SHORTER_MIN, CHANGE_LAW, CHANGE_FORMULATION, CHANGE_SHORTER, CHANGE_CHECK},
  [SOLVE_LINEAR]      = {CHANGE_STABILISE, CHANGE_SUPPORT, CHANGE_DISPLACEMENT, CHANGE_CHECK},
  [SOLVE_WORKSPACE]   = {CHANGE_WORKSPACE},
  [SOLVE_LISTS]       = {CHANGE_WHOLE_MASTER, CHANGE_SHORTER_MIN, CHANGE_SHORTER, CHANGE_FINER_MASTER, CHANGE_CHECK},
  [SOLVE_CYCLE]       = {CHANGE_SHORTER_MIN, CHANGE_SYMMETRY, CHANGE_LINE_SEARCH},
  [SOLVE_LOST]        = {CHANGE_FREE_PENALTY, CHANGE_STIFFER, CHANGE_SHORTER_MIN, CHANGE_SHORTER, CHANGE_FINER_MASTER,
                         CHANGE_CHECK},
  [SOLVE_UNCERTIFIED] = {CHANGE_FREE_PENALTY, CHANGE_STIFFER, CHANGE_SHORTER_MIN, CHANGE_SHORTER, CHANGE_FINER_MASTER,
                         CHANGE_CHECK},
  [SOLVE_ADRIFT]      = {CHANGE_DISPLACEMENT, CHANGE_SUPPORT, CHANGE_CHECK},
  [SOLVE_WINDOW]      = {CHANGE_RANGE, CHANGE_WIDER_WINDOW, CHANGE_WHEN_STEP, CHANGE_CHECK},
  [SOLVE_VOLUME]      = {CHANGE_SHORTER_MIN, CHANGE_SHORTER, CHANGE_CHECK},
  [SOLVE_FLUID]       = {CHANGE_SHORTER_MIN, CHANGE_SHORTER, CHANGE_CHECK},
  [SOLVE_LEAK]        = {CHANGE_SHORTER_MIN, CHANGE_CHECK},
  [SOLVE_LEAKED]      = {CHANGE_DISPLACEMENT, CHANGE_CHECK},
  [SOLVE_TURNED]      = {CHANGE_SHORTER_MIN, CHANGE_CHECK},
  [SOLVE_FACING]      = {CHANGE_SHORTER_MIN, CHANGE_CHECK},
  [SOLVE_FAR]         = {CHANGE_SHORTER_MIN, CHANGE_SHORTER, CHANGE_CHECK},
  [SOLVE_ROUTINE]     = {CHANGE_SHORTER_MIN, CHANGE_SHORTER, CHANGE_CHECK},
  [SOLVE_JUMP]        = {CHANGE_DAMPING, CHANGE_SHORTER_MIN, CHANGE_SHORTER, CHANGE_CHECK},
  [SOLVE_UNSTABLE]    = {CHANGE_DAMPING, CHANGE_SHORTER_MIN, CHANGE_SHORTER, CHANGE_CHECK},
  [SOLVE_NAN]         = {CHANGE_SHORTER_MIN, CHANGE_SHORTER, CHANGE_CHECK}};

/* What is tried where surfaces cross and no term presses, or a face folds: no penalty and no step acts there. */
static const ChangeKind unheld[ADVICE_CHANGES] = {CHANGE_SHORTER_MIN, CHANGE_ROLES, CHANGE_FINER_MASTER, CHANGE_CHECK};

/* Was a step refused because a face would fold over itself? Contact has no part in that. */
static int Folds(const SolveReport *solve)
{
  return strstr(solve->detail, "folds over itself") != NULL;
}

/* Does a line name a change already? */
static int Names(const AdviceLine *line, ChangeKind change)
{
  for (int k = 0; k < line->n; k++)
    if (line->changes[k] == change) return 1;
  return 0;
}

/* Does a change oppose one of the lines so far? */
static int Opposes(const Advice *advice, ChangeKind change, const PairFigures *pair)
{
  for (int i = 0; i < advice->n; i++)
    for (int k = 0; k < advice->lines[i].n; k++)
      if (AdviceChangesOppose(advice->lines[i].changes[k], advice->lines[i].at.pair, change, pair)) return 1;
  return 0;
}

/* Adds a line, with those of its changes that can be made and that no earlier line opposes. A line without any is left
   out. */
static void AddLine(Advice *advice, const char *text, const ChangePlace *at, const ChangeKind *changes)
{
  AdviceLine *line = &advice->lines[advice->n];

  if (advice->n == ADVICE_LINES) return;
  *line = (AdviceLine){.at = *at};
  snprintf(line->text, ADVICE_TEXT, "%s", text);
  for (int k = 0; changes[k] != CHANGE_NONE && line->n < ADVICE_CHANGES; k++)
    if (AdviceChangePossible(changes[k], at) && !Names(line, changes[k]) && !Opposes(advice, changes[k], at->pair))
      line->changes[line->n++] = changes[k];
  advice->n += line->n > 0;
}

/* The pair of a failure: the one that its message names where the failure is that of a pair, or else that of the node
   with the largest residual. */
static const PairFigures *FailedPair(const RunFigures *figures)
{
  const SolveReport *solve = &figures->run->way->failed.solve;
  const int          pair  = solve->failure.n ? solve->failure.node[0].pair : -1;
  const int          named = solve->result == SOLVE_LOST || solve->result == SOLVE_UNCERTIFIED ||
                    solve->result == SOLVE_WINDOW || solve->result == SOLVE_CYCLE;

  for (int p = 0; p < figures->n_pairs && named; p++) {
    char quoted[ADVICE_TEXT];

    snprintf(quoted, sizeof(quoted), "'%s'", figures->pairs[p].name);
    if (strstr(solve->detail, quoted)) return &figures->pairs[p];
  }
  return pair >= 0 && pair < figures->n_pairs ? &figures->pairs[pair] : NULL;
}

/* Adds what to try after a failed solve. */
static void AddTries(const RunFigures *figures, Advice *advice)
{
  const SolveReport *solve    = &figures->run->way->failed.solve;
  const Failure     *failure  = &solve->failure;
  ChangePlace        at       = {.figures = figures, .pair = FailedPair(figures), .body = -1, .factor = 1};
  const int          squeezed = failure->squeeze > 0 && failure->squeeze < ADVICE_SQUEEZED;
  ChangeKind         changes[ADVICE_CHANGES + 1] = {CHANGE_LAW};
  const ChangeKind  *first                       = squeezed ? changes : changes + 1;

  memcpy(changes + 1, tries[solve->result], sizeof(tries[0]));
  if (failure->n) at.body = failure->node[0].body;
  if (squeezed)
    at.body = failure->squeezed_body;
  else if ((solve->result == SOLVE_DOMAIN || solve->result == SOLVE_ROUTINE) && failure->inverted_body >= 0)
    at.body = failure->inverted_body;
  if (solve->result == SOLVE_LOST) { /* a node that was not deep was lost by a long step */
    const PetscReal deep = at.pair ? at.pair->quality.max_penetration_over_h : 0;

    first     = changes + (deep > ADVICE_DEEP ? 1 : 3); /* without what makes the penalty stiffer */
    at.factor = (double)(deep / ADVICE_DEEP_WANTED);
  }
  if (solve->result == SOLVE_UNCERTIFIED && at.pair && (!at.pair->quality.nodes || Folds(solve))) first = unheld;
  AddLine(advice, "", &at, first);
  advice->tries = advice->n > 0;
  if (advice->n && advice->lines[0].n > 1 && advice->lines[0].changes[advice->lines[0].n - 1] == CHANGE_CHECK)
    advice->lines[0].n--; /* there is something better */
}

/*@
  AdviceCollect - collects what to try after a failure and what to change, in lines that do not contradict each other.

  Not collective

  Input Parameter:
. figures - of the run

  Output Parameter:
. advice - its lines; after a failure the first one is what to try

  Note:
  Every change can be made in the scene at hand. Where two lines would pull a key in opposite directions, the later one
  is without that change.
@*/
void AdviceCollect(const RunFigures *figures, Advice *advice)
{
  char text[ADVICE_TEXT];

  advice->n = advice->tries = 0;
  if (figures->run->way->failed.attempts) AddTries(figures, advice);
  for (int p = 0; p < figures->n_pairs && figures->last; p++) {
    for (size_t s = 0; s < sizeof(situations) / sizeof(situations[0]); s++) {
      const PairFigures *pair   = &figures->pairs[p];
      const double       factor = situations[s].pair ? situations[s].pair(figures, pair, text) : 0;
      const ChangePlace  at     = {.figures = figures, .pair = pair, .body = -1, .factor = factor};

      if (factor > 0) AddLine(advice, text, &at, situations[s].changes);
    }
  }
  for (int b = 0; b < figures->scene->n_bodies; b++) {
    for (size_t s = 0; s < sizeof(situations) / sizeof(situations[0]); s++) {
      const ChangePlace at = {.figures = figures, .body = b, .factor = 1};

      if (situations[s].body && situations[s].body(figures, b, text) > 0)
        AddLine(advice, text, &at, situations[s].changes);
    }
  }
  for (size_t s = 0; s < sizeof(situations) / sizeof(situations[0]); s++) {
    const double      factor = situations[s].run ? situations[s].run(figures, text) : 0;
    const ChangePlace at     = {.figures = figures, .body = -1, .factor = factor};

    if (factor > 0) AddLine(advice, text, &at, situations[s].changes);
  }
}

/*@
  AdviceGive - passes on one line for each figure of a run that is bad and can be improved.

  Not collective

  Input Parameters:
+ figures - of the run
. print   - called for each line
- context - passed on to print
@*/
void AdviceGive(const RunFigures *figures, AdvicePrintFn print, void *context)
{
  Advice advice;

  AdviceCollect(figures, &advice);
  for (int i = advice.tries; i < advice.n; i++) {
    const AdviceLine *line = &advice.lines[i];
    char              text[2 * ADVICE_TEXT];
    size_t            used;

    snprintf(text, sizeof(text), "%s", line->text);
    for (int k = 0; k < line->n; k++) {
      char change[ADVICE_TEXT];

      AdviceChangeWrite(line->changes[k], &line->at, change, sizeof(change));
      if (!change[0]) continue; /* the line has told it */
      used = strlen(text);
      snprintf(text + used, sizeof(text) - used, "%s%s", k ? ", or " : ": ", change);
    }
    print(text, context);
  }
}

/*@
  AdviceTry - passes on the changes to try after a failed run, the most promising first.

  Not collective

  Input Parameters:
+ figures - of the run
. print   - called for each change
- context - passed on to print
@*/
void AdviceTry(const RunFigures *figures, AdvicePrintFn print, void *context)
{
  Advice advice;
  char   text[ADVICE_TEXT];

  AdviceCollect(figures, &advice);
  for (int k = 0; k < advice.lines[0].n && advice.tries; k++) {
    AdviceChangeWrite(advice.lines[0].changes[k], &advice.lines[0].at, text, sizeof(text));
    print(text, context);
  }
}
