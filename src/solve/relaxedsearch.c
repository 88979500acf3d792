/* A line search that lets the energy rise over a step and looks on after the next ones whether it has paid. */
#include "modelimpl.h"

/* The energy must fall by this part of what its slope promises. */
#define SEARCH_FALL 1e-4
/* A step over which the energy rises is kept if the energy has fallen below that of its start after this many more
   steps. The first of them mostly does it, and needs a second one where contact opens or closes. */
#define SEARCH_PATIENCE 2
/* The next such step turns the cells at most by this part of a step that did not pay, and by this multiple of one that
   did. */
#define SEARCH_SHRINK 0.25
#define SEARCH_GROW   2.0
/* A step that leaves the contact lists or inverts an element is halved this many times. */
#define SEARCH_HALVINGS 3
/* Over a step as long as the linear problem says the work is half of what the slope promises, or more where the tangent
   is indefinite. More than this multiple of the promise is no work, but the residual of an element that is all but
   inverted at a point of Simpson's rule. */
#define SEARCH_PROMISE 10
/* Part of a step over which smooth quantities do not change noticeably */
#define SEARCH_TRIFLE 1e-3
/* Without an energy a step is shortened this many times, each time to between a tenth and a half. */
#define SEARCH_CUTS 20

/* Where a search stands: vectors of SNES, which owns them. */
typedef struct {
  Model          model;
  SNESLineSearch search;
  SNES           snes;
  Vec            x, F, y, w, G; /* iterate, residual, step; a trial point and its residual */
} Search;

/* Evaluates the residual at x - lambda y, into G. *ok: no element is inverted there, and the contact lists reach. */
static PetscErrorCode Try(const Search *s, PetscReal lambda, PetscBool *ok)
{
  PetscBool inverted;

  PetscFunctionBeginUser;
  PetscCall(VecWAXPY(s->w, -lambda, s->y, s->x));
  PetscCall(SNESComputeFunction(s->snes, s->w, s->G));
  PetscCall(SNESGetFunctionDomainError(s->snes, &inverted));
  *ok = (PetscBool)!inverted;
  if (*ok && s->model->contact) PetscCall(ContactListsReach(s->model->contact, ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rise of the energy in use between two iterates, PETSC_MAX_REAL where an element is inverted at the second. */
static PetscErrorCode OneRise(const Search *s, Vec from, Vec to, PetscReal *rise)
{
  PetscReal before, after;

  PetscFunctionBeginUser;
  PetscCall(SNESComputeObjective(s->snes, from, &before));
  PetscCall(SNESComputeObjective(s->snes, to, &after));
  *rise = after >= MODEL_INVERTED ? PETSC_MAX_REAL : after - before;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The lesser rise of two energies: that of volumes that yield, which forgives a change of volume that the next step
   makes up for, and the true one. Along a soft motion whose pressures change, the first may rise all the way. */
static PetscErrorCode EnergyRise(const Search *s, Vec from, Vec to, PetscReal *rise)
{
  const Elasticity elasticity = s->model->problem->elasticity;
  PetscReal        real;

  PetscFunctionBeginUser;
  PetscCall(OneRise(s, from, to, rise));
  if (!ElasticityYields(elasticity) || *rise == PETSC_MAX_REAL) PetscFunctionReturn(PETSC_SUCCESS);
  ElasticityYieldSet(elasticity, PETSC_FALSE);
  PetscCall(OneRise(s, from, to, &real));
  ElasticityYieldSet(elasticity, PETSC_TRUE);
  *rise = PetscMin(*rise, real);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far the whole step turns a cell. */
static PetscErrorCode Turn(const Search *s, PetscReal *turn)
{
  const PetscInt n = s->model->mesh->n_nodes * s->model->mesh->dim;
  PetscReal     *u;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &u));
  PetscCall(ProblemDisplacements(s->model->problem, s->x, s->model->t, u));
  PetscCall(VecWAXPY(s->w, -1, s->y, s->x));
  PetscCall(ProblemSetTrial(s->model->problem, s->w, s->model->t));
  PetscCall(ModelLargestTurn(s->model, u, s->model->problem->trial, turn));
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The work that is done against the residual on the straight way from x to x - lambda y, by Simpson's rule, which is
   exact for energies of fourth degree. PETSC_MAX_REAL where an element is inverted. yields: the work against the
   residual of volumes that yield. */
static PetscErrorCode OneWork(const Search *s, Vec x, Vec y, PetscReal lambda, PetscBool yields, PetscReal *rise)
{
  const Elasticity elasticity = s->model->problem->elasticity;
  PetscReal        work, slope = 0, sum = 0;
  PetscBool        inverted = PETSC_FALSE;

  PetscFunctionBeginUser;
  ElasticityYieldForces(elasticity, yields);
  for (int i = 0; i <= 2 && !inverted; i++) {
    const PetscBool known = (PetscBool)(i == 0 && x == s->x && !yields);

    if (!known) {
      PetscCall(VecWAXPY(s->w, -lambda * i / 2, y, x));
      PetscCall(SNESComputeFunction(s->snes, s->w, s->G));
      PetscCall(SNESGetFunctionDomainError(s->snes, &inverted));
    }
    PetscCall(VecDotRealPart(known ? s->F : s->G, y, &work));
    if (i == 0) slope = work;
    sum += (i == 1 ? 4 : 1) * work;
  }
  ElasticityYieldForces(elasticity, PETSC_FALSE);
  inverted = (PetscBool)(inverted || PetscIsInfOrNanReal(sum) ||
                         (slope > 0 && sum > 6 * SEARCH_PROMISE * PetscMax(1, lambda) * slope));
  *rise    = inverted ? PETSC_MAX_REAL : -lambda / 6 * sum;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The lesser work against two residuals, as EnergyRise() says of energies. */
static PetscErrorCode WorkRise(const Search *s, Vec x, Vec y, PetscReal lambda, PetscReal *rise)
{
  const PetscBool yields = ElasticityYields(s->model->problem->elasticity);
  PetscReal       real;

  PetscFunctionBeginUser;
  PetscCall(OneWork(s, x, y, lambda, yields, rise));
  if (!yields) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(OneWork(s, x, y, lambda, PETSC_FALSE, &real));
  *rise = PetscMin(*rise, real);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rise of the energy from x to x - lambda y, PETSC_MAX_REAL where an element is inverted. Loads that follow the
   surface have no energy, and work takes its place. */
static PetscErrorCode Rise(const Search *s, PetscReal lambda, PetscReal *rise)
{
  PetscFunctionBeginUser;
  if (ProblemConservative(s->model->problem)) {
    PetscCall(VecWAXPY(s->w, -lambda, s->y, s->x));
    PetscCall(EnergyRise(s, s->x, s->w, rise));
  } else
    PetscCall(WorkRise(s, s->x, s->y, lambda, rise));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends the search at x - lambda y, where no element is inverted. */
static PetscErrorCode Take(const Search *s, PetscReal lambda)
{
  PetscFunctionBeginUser;
  PetscCall(VecAXPY(s->x, -lambda, s->y));
  PetscCall(SNESComputeFunction(s->snes, s->x, s->F));
  PetscCall(SNESLineSearchSetLambda(s->search, lambda));
  PetscCall(SNESLineSearchSetReason(s->search, SNES_LINESEARCH_SUCCEEDED));
  PetscCall(SNESLineSearchComputeNorms(s->search));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lets the energy in use be the true one if that of volumes that yield rises from the start of the step on. */
static PetscErrorCode ChooseFalling(const Search *s)
{
  const Elasticity elasticity = s->model->problem->elasticity;
  PetscReal        rise;

  PetscFunctionBeginUser;
  if (!ElasticityYields(elasticity)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecWAXPY(s->w, -SEARCH_TRIFLE, s->y, s->x));
  PetscCall(OneRise(s, s->x, s->w, &rise));
  if (rise > 0) ElasticityYieldSet(elasticity, PETSC_FALSE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends the search as PETSc's backtracking does. */
static PetscErrorCode Backtrack(const Search *s)
{
  SNESLineSearch       plain = s->model->work->backtracking;
  SNESLineSearchReason reason;
  PetscReal            lambda, norm;

  PetscFunctionBeginUser;
  PetscCall(SNESLineSearchGetDamping(s->search, &lambda));
  PetscCall(SNESLineSearchSetDamping(plain, lambda));
  PetscCall(VecNorm(s->F, NORM_2, &norm));
  PetscCall(SNESLineSearchApply(plain, s->x, s->F, &norm, s->y));
  PetscCall(SNESLineSearchGetLambda(plain, &lambda));
  PetscCall(SNESLineSearchGetReason(plain, &reason));
  PetscCall(SNESLineSearchSetLambda(s->search, lambda));
  PetscCall(SNESLineSearchSetReason(s->search, reason));
  PetscCall(SNESLineSearchComputeNorms(s->search));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes a step over which the energy falls by -rise. One that led uphill and was turned round leads away from a saddle.
   Close to it the step is tiny and the way down is long: each such step goes only as far as the saddle is away. It is
   doubled as long as energy or work fall further and cells do not turn far. A quarter of an O-ring in space (hex27, nu
   0.499) takes 31 iterations, and without that 41. */
static PetscErrorCode Descend(const Search *s, PetscReal rise)
{
  PetscReal turn, next, lambda = 1;
  PetscBool ok = s->model->work->uphill;

  PetscFunctionBeginUser;
  if (!ok) {
    PetscCall(Take(s, 1));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(Turn(s, &turn));
  while (ok && 2 * lambda * turn <= MODEL_FARTHEST) {
    PetscCall(Rise(s, 2 * lambda, &next));
    ok = (PetscBool)(next < rise);
    if (!ok) break;
    PetscCall(Try(s, 2 * lambda, &ok));
    rise = next;
    lambda *= ok ? 2 : 1;
  }
  PetscCall(Take(s, lambda));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stays where the step begins, as close to an equilibrium it leads uphill, and no part of it lowers the energy. There
   the tangent is indefinite, and the equilibrium that the step seeks is a saddle, or none. From now on steps are turned
   there as elsewhere. *stays: that was done. */
static PetscErrorCode StayUphill(const Search *s, PetscReal slope, PetscBool *stays)
{
  ModelWork *work = s->model->work;

  PetscFunctionBeginUser;
  *stays = (PetscBool)(slope < 0 && !work->relaxed.turns);
  if (!*stays) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscInfo(s->snes, "close to an equilibrium a step uphill does not pay: slope %g\n", (double)slope));
  work->relaxed.turns = work->strayed = PETSC_TRUE;
  if (s->model->contact) PetscCall(ContactCycleStart(work->watch));
  PetscCall(Take(s, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Shortens the step until the energy falls. */
static PetscErrorCode Shorten(const Search *s)
{
  PetscReal lambda, slope, rise;
  PetscBool stays;

  PetscFunctionBeginUser;
  PetscCall(VecDotRealPart(s->F, s->y, &slope));
  PetscCall(StayUphill(s, slope, &stays));
  if (stays) PetscFunctionReturn(PETSC_SUCCESS);
  if (ProblemConservative(s->model->problem)) {
    PetscCall(ChooseFalling(s));
    PetscCall(Backtrack(s));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SNESLineSearchGetDamping(s->search, &lambda));
  for (int i = 0; i < SEARCH_CUTS; i++) {
    PetscCall(Rise(s, lambda, &rise));
    if (rise <= -SEARCH_FALL * lambda * slope) {
      PetscCall(Take(s, lambda));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    lambda *=
      rise == PETSC_MAX_REAL ? 0.5 : PetscMax(0.1, PetscMin(0.5, lambda * slope / (2 * (rise + lambda * slope))));
  }
  PetscCall(SNESLineSearchSetReason(s->search, SNES_LINESEARCH_FAILED_REDUCT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the start of a step, from which the next one is judged. */
static PetscErrorCode Keep(const Search *s, PetscReal rise, PetscReal slope, PetscReal turn)
{
  RelaxedStep *step = &s->model->work->relaxed;

  PetscFunctionBeginUser;
  if (!step->x) {
    PetscCall(VecDuplicate(s->x, &step->x));
    PetscCall(VecDuplicate(s->x, &step->y));
  }
  PetscCall(VecCopy(s->x, step->x));
  PetscCall(VecCopy(s->y, step->y));
  PetscCall(ElasticityKeep(s->model->problem->elasticity, VOLUMES_OF_SEARCH));
  step->waits = PETSC_TRUE;
  step->times = 0;
  step->rise  = rise;
  step->slope = slope;
  step->turn  = turn;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lets cells turn farther in the next step that is bounded so, after one that turned them by `turn` has paid. */
static void LengthenBound(RelaxedStep *step, PetscReal turn)
{
  step->farthest = PetscMin(MODEL_FARTHEST, PetscMax(step->farthest, SEARCH_GROW * turn));
}

/* Takes the step as far as cells may turn in it and lists reach, although the energy rises. *taken: it could be. The
   pressures of stiff volumes change along the step as the step's linear problem says, however far it goes, and whether
   it leads to a minimum or away from a saddle. Where the energy falls over the shortened step, the next one is still
   judged from its start. It may end where a tangent leads nowhere: a thin rubber disc that a pressure bulges, whose work
   falls over each part of a step that cells may turn, would crawl. */
static PetscErrorCode Relax(const Search *s, PetscReal rise, PetscReal slope, PetscBool *taken)
{
  ModelWork *work = s->model->work;
  PetscReal  turn, lambda;

  PetscFunctionBeginUser;
  PetscCall(Turn(s, &turn));
  lambda = PetscMin(1, work->relaxed.farthest / turn);
  *taken = PETSC_FALSE;
  for (int i = 0; i <= SEARCH_HALVINGS && !*taken; i++, lambda /= *taken ? 1 : 2) {
    if (lambda < 1) PetscCall(Rise(s, lambda, &rise));
    if (rise < PETSC_MAX_REAL) PetscCall(Try(s, lambda, taken));
  }
  if (!*taken) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Keep(s, rise, slope, lambda * turn));
  work->relaxed.linear = PETSC_TRUE;
  work->uphill         = PETSC_FALSE;
  PetscCall(Take(s, lambda));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lets the energies of this search be those of volumes that yield: the whole step ends at x - y. */
static PetscErrorCode YieldVolumes(const Search *s)
{
  const PetscInt n       = s->model->mesh->n_nodes * s->model->mesh->dim;
  Problem        problem = s->model->problem;
  PetscReal     *u;

  PetscFunctionBeginUser;
  if (!ProblemHasFormulation(problem, FORMULATION_MIXED)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(n, &u));
  PetscCall(ProblemDisplacements(problem, s->x, s->model->t, u));
  PetscCall(VecWAXPY(s->w, -1, s->y, s->x));
  PetscCall(ProblemSetTrial(problem, s->w, s->model->t));
  PetscCall(ElasticityYield(problem->elasticity, u, problem->trial));
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns to the start of the step that waits, and shortens it. Pressures of exact volumes have followed the steps
   since, and are again those with which it was found. */
static PetscErrorCode Return(const Search *s)
{
  ModelWork   *work = s->model->work;
  RelaxedStep *step = &work->relaxed;

  PetscFunctionBeginUser;
  step->waits    = PETSC_FALSE;
  step->farthest = SEARCH_SHRINK * step->turn;
  PetscCall(VecCopy(step->x, s->x));
  PetscCall(VecCopy(step->y, s->y));
  PetscCall(VecCopy(step->y, work->step));
  PetscCall(ElasticityReturn(s->model->problem->elasticity, VOLUMES_OF_SEARCH));
  PetscCall(SNESComputeFunction(s->snes, s->x, s->F));
  work->objective = OBJECTIVE_ENERGY;
  PetscCall(YieldVolumes(s));
  PetscCall(Shorten(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rise of the energy from the start of the step that waits to the end of the step at hand. Multipliers have changed
   on the way, and energy and work with them. */
static PetscErrorCode RiseSince(const Search *s, PetscReal *rise)
{
  Vec end, way;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(s->x, &end));
  PetscCall(VecWAXPY(end, -1, s->y, s->x));
  if (ProblemConservative(s->model->problem))
    PetscCall(EnergyRise(s, s->model->work->relaxed.x, end, rise));
  else {
    PetscCall(VecDuplicate(s->x, &way));
    PetscCall(VecWAXPY(way, -1, end, s->model->work->relaxed.x));
    PetscCall(WorkRise(s, s->model->work->relaxed.x, way, 1, rise));
    PetscCall(VecDestroy(&way));
  }
  PetscCall(VecDestroy(&end));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Judges the step that waits at the end of one more step, over which the energy changes by `rise`. */
static PetscErrorCode Judge(const Search *s, PetscReal rise)
{
  RelaxedStep *step  = &s->model->work->relaxed;
  PetscReal    since = step->rise + rise;
  PetscBool    paid, reached = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (rise < PETSC_MAX_REAL) PetscCall(RiseSince(s, &since));
  paid = (PetscBool)(rise < PETSC_MAX_REAL && since <= -SEARCH_FALL * step->slope);
  if (!paid && rise < PETSC_MAX_REAL && ++step->times < SEARCH_PATIENCE) PetscCall(Try(s, 1, &reached));
  if (!paid && !reached) {
    PetscCall(Return(s));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (paid) {
    if (s->model->contact) PetscCall(ContactCycleStart(s->model->work->watch)); /* a lower energy is no repetition */
    step->waits = PETSC_FALSE;
    LengthenBound(step, step->turn);
  }
  step->rise = since;
  PetscCall(Take(s, 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Searches close to equilibrium where there is no energy: the step is taken if work is done against the residual over
   it. Along the bent way of a soft motion the residual rises, however right the step is. *taken: it was. */
static PetscErrorCode SearchClosely(const Search *s, PetscReal slope, PetscBool *taken)
{
  PetscReal rise;

  PetscFunctionBeginUser;
  *taken = PETSC_FALSE;
  if (ProblemConservative(s->model->problem) || !(slope > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Rise(s, 1, &rise));
  *taken = (PetscBool)(rise <= -SEARCH_FALL * slope);
  if (*taken) PetscCall(Take(s, 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does the energy rise over steps since stiffness jumps on the way? So it does where bodies yield: a point that unloads
   is stiffer by orders of magnitude than the tangent says. The energy then rises from the middle of the step on, and
   the steps after it do not make up for that. */
static PetscBool SearchJumps(const Search *s)
{
  return (PetscBool)(ProblemConservative(s->model->problem) && ProblemIsPlastic(s->model->problem));
}

/* Searches for balance along the step, where bodies yield. *taken: there is one, and the energy falls on the way, as
   far as it can be told. */
static PetscErrorCode SearchBalance(const Search *s, PetscReal slope, PetscBool *taken)
{
  PetscReal part, rise = -slope;

  PetscFunctionBeginUser;
  *taken = PETSC_FALSE;
  if (!(slope > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelSearchSlope(s->model, s->search, slope, 1, &part));
  if (part == 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->model->work->objective == OBJECTIVE_ENERGY) PetscCall(Rise(s, part, &rise));
  *taken = (PetscBool)(rise <= -SEARCH_FALL * part * slope);
  if (*taken) PetscCall(Take(s, part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chooses how much of the step is taken, by energies. */
static PetscErrorCode SearchByEnergy(const Search *s, PetscReal slope)
{
  PetscReal rise;
  PetscBool taken = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(YieldVolumes(s));
  PetscCall(Rise(s, 1, &rise));
  if (s->model->work->relaxed.waits)
    PetscCall(Judge(s, rise));
  else if (rise <= -SEARCH_FALL * slope)
    PetscCall(Descend(s, rise));
  else {
    if (!s->model->work->shift.on) PetscCall(Relax(s, rise, slope, &taken));
    if (!taken) PetscCall(Shorten(s));
  }
  ElasticityYieldSet(s->model->problem->elasticity, PETSC_FALSE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes a step in which motions that were held move on, or the part of it that inverts no element. Where lists do not
   reach, new ones are made there; a part that they reach is taken when no more are to be made. The energy may rise, as
   in Relax(): its bound is that of the motions. *taken: it could be. */
static PetscErrorCode TakeMove(const Search *s, PetscBool *taken)
{
  ModelWork      *work   = s->model->work;
  const PetscBool anew   = (PetscBool)(work->renewed < MODEL_MAX_REGATHER);
  PetscReal       lambda = 1;
  PetscBool       inverted;

  PetscFunctionBeginUser;
  *taken = PETSC_FALSE;
  for (int i = 0; i <= SEARCH_HALVINGS && !*taken; i++, lambda /= *taken ? 1 : 2) {
    PetscCall(Try(s, lambda, taken));
    PetscCall(SNESGetFunctionDomainError(s->snes, &inverted));
    *taken = (PetscBool)(*taken || (anew && !inverted));
  }
  work->hold.turn *= lambda;
  if (!*taken) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->model->contact) PetscCall(ContactCycleStart(work->watch));
  work->relaxed.waits  = PETSC_FALSE;
  work->relaxed.linear = PETSC_TRUE;
  work->uphill         = PETSC_FALSE;
  PetscCall(Take(s, lambda));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelSearchRelaxed - the line search of Newton's method without friction.

  Collective

  Input Parameters:
+ search  - a shell, whose SNES has its objective where there is an energy
- context - the model

  Notes:
  A soft motion along a bent way, as of rubber that rolls in its groove, is stiff to either side. Over a step along the
  tangent of the way the energy rises, however right the step is, and the next step, which corrects the stiff part, is
  small. A search that asks for less energy at once cuts the first of each such pair to a small part. This one takes it
  and keeps its start. It returns there if the energy has not fallen below that at the start after SEARCH_PATIENCE more
  steps, and does what it would have done at once: it shortens the step. How far cells turn in such a step is bounded,
  and the bound follows whether the last ones have paid.

  Where residuals are compared, at iterates close to equilibrium, and where the contact set repeats itself, steps are
  shortened as before. Where bodies yield, ModelSearchSlope() comes first. Without an energy work is compared there
first, which has no round-off of large energies.

  Source: Chamberlain, Powell, Lemarechal and Pedersen, The watchdog technique for forcing convergence in algorithms for
  constrained optimization, Math. Programming Study 16 (1982) 1-17.
@*/
PetscErrorCode ModelSearchRelaxed(SNESLineSearch search, void *context)
{
  Search     s    = {.model = context, .search = search};
  ModelWork *work = s.model->work;
  PetscReal  lambda, slope;
  PetscBool  changed, taken = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(SNESLineSearchGetSNES(search, &s.snes));
  PetscCall(SNESLineSearchGetVecs(search, &s.x, &s.F, &s.y, &s.w, &s.G));
  PetscCall(SNESLineSearchGetDamping(search, &lambda));
  PetscCall(SNESLineSearchPreCheck(search, s.x, s.y, &changed));
  work->relaxed.linear = PETSC_FALSE;
  if (work->hold.wanted && work->hold.moving) PetscCall(TakeMove(&s, &taken));
  if (taken) PetscFunctionReturn(PETSC_SUCCESS);
  if (work->hold.wanted && work->hold.moving) ModelReleaseHeld(s.model);
  if (lambda < 1) work->relaxed.waits = PETSC_FALSE;
  PetscCall(VecDotRealPart(s.F, s.y, &slope));
  if (work->shift.on && lambda == 1 && work->objective == OBJECTIVE_RESIDUAL) {
    PetscCall(Take(&s, 1));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (!work->relaxed.waits && (lambda < 1 || work->objective == OBJECTIVE_RESIDUAL || SearchJumps(&s))) {
    if (lambda == 1) PetscCall(SearchClosely(&s, slope, &taken));
    if (lambda == 1 && SearchJumps(&s)) PetscCall(SearchBalance(&s, slope, &taken));
    if (!taken) PetscCall(Backtrack(&s));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SearchByEnergy(&s, slope));
  PetscFunctionReturn(PETSC_SUCCESS);
}
