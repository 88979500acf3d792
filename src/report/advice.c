/* Rules that turn the figures of a run into advice, see advice.h. */
#include "advice.h"

/* Estimated error by penetration above which a stiffer penalty is advised, and the error that it is to leave. */
#define ADVICE_PENALTY        0.01
#define ADVICE_PENALTY_WANTED 0.003
/* The facets' own error hides what contact resolves if it is this many penetrations. */
#define ADVICE_FACETS 10
/* Part of the slave points that may be on the lower rungs. Free ends and corners of a surface put some points there. */
#define ADVICE_FALL_BACKS 0.1
/* Parts of the steps that may fail or be taken back, and lists made anew for each step, before another step size is
   cheaper. */
#define ADVICE_FAILED     0.25
#define ADVICE_REPEATED   0.5
#define ADVICE_REGATHERED 1
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

/* A rule writes into text[ADVICE_TEXT] what to do and returns 1 if it applies, else 0: for the run, and for a pair. */
typedef int (*RunRuleFn)(const RunFigures *, char *text);
typedef int (*PairRuleFn)(const RunFigures *, const PairFigures *, char *text);

static int PenetrationIsDeep(const RunFigures *figures, const PairFigures *pair, char *text)
{
  const SceneContact *scene = pair->scene;
  const PenaltyError *part  = &pair->penalty_error;
  const PetscReal     error =
    PetscMax(PetscMax(part->force, part->displacement), scene->penalty_may_stiffen ? 0 : part->pressure);

  (void)figures;
  if (scene->adjust || scene->augment || !(error > ADVICE_PENALTY)) return 0;
  if (!scene->penalty_may_stiffen)
    snprintf(text, ADVICE_TEXT,
             "%s: penetration leaves about %.2g %% of error: no penalty keys, so that the run chooses the penalty, or "
             "%.2g times the penalty",
             pair->name, (double)(100 * error), (double)(error / ADVICE_PENALTY_WANTED));
  else
    snprintf(text, ADVICE_TEXT, "%s: penetration leaves about %.2g %% of error: penalty: {scale: %.2g}", pair->name,
             (double)(100 * error), scene->penalty_scale * (double)(pair->stiffened * error / ADVICE_PENALTY_WANTED));
  return 1;
}

static int FacetsAreCoarse(const RunFigures *figures, const PairFigures *pair, char *text)
{
  const PetscReal error = pair->quality.sagitta, small = PetscMax(pair->quality.max_penetration, 0);

  (void)figures;
  if (pair->fits.points || !pair->quality.nodes || error <= ADVICE_FACETS * small) return 0;
  snprintf(text, ADVICE_TEXT,
           "%s: the facets' own error, about %.2g, is %.2g times the penetration: smoother: diffuse, or a finer master",
           pair->name, (double)error, (double)(error / small));
  return 1;
}

static int FitsFallBack(const RunFigures *figures, const PairFigures *pair, char *text)
{
  const PetscInt low = pair->fits.degree_2 + pair->fits.linear + pair->fits.facets;

  (void)figures;
  if (low <= ADVICE_FALL_BACKS * pair->fits.points) return 0;
  snprintf(text, ADVICE_TEXT,
           "%s: %lld of %lld slave points have no fit of their degree: a finer or more even master there, its symmetry "
           "planes named, or degree: 2",
           pair->name, (long long)low, (long long)pair->fits.points);
  return 1;
}

static int WindowIsMissed(const RunFigures *figures, const PairFigures *pair, char *text)
{
  (void)figures;
  if (pair->scene->augment || !pair->window.outside) return 0;
  snprintf(
    text, ADVICE_TEXT,
    "%s: %lld of %lld loaded nodes are outside the window: when: converged, a wider window, or more penalty.range",
    pair->name, (long long)pair->window.outside, (long long)pair->window.loaded);
  return 1;
}

static int UpdatesAreFew(const RunFigures *figures, const PairFigures *pair, char *text)
{
  if (!pair->window.missed) return 0;
  snprintf(text, ADVICE_TEXT,
           "%s: %lld of %lld steps ended with nodes beyond g_max after max_updates, the last with %lld of %lld nodes "
           "up to %.3g g_max: a stiffer penalty.scale, "
           "more max_updates, or a larger g_max",
           pair->name, (long long)pair->window.missed, (long long)figures->run->way->steps,
           (long long)pair->window.outside, (long long)pair->window.loaded, (double)pair->window.excess);
  return 1;
}

static const PairRuleFn pair_rules[] = {PenetrationIsDeep, FacetsAreCoarse, FitsFallBack, WindowIsMissed,
                                        UpdatesAreFew};

static int StepsFail(const RunFigures *figures, char *text)
{
  const StepperReport *way = figures->run->way;

  if (!way->done || way->steps_failed <= ADVICE_FAILED * PetscMax(way->steps, 1)) return 0;
  snprintf(text, ADVICE_TEXT,
           "%lld steps failed on the way to %lld: a smaller stepping.initial or dt_max, or stepping.control: contact",
           (long long)way->steps_failed, (long long)way->steps);
  return 1;
}

static int StepsRepeat(const RunFigures *figures, char *text)
{
  const StepperReport *way = figures->run->way;

  if (way->steps_repeated <= ADVICE_REPEATED * PetscMax(way->steps, 1)) return 0;
  snprintf(
    text, ADVICE_TEXT,
    "%lld steps were taken back by the control: stepping.prediction: tangent, or more nodes a step (N_c, N_c_fraction)",
    (long long)way->steps_repeated);
  return 1;
}

static int NeighbourListsAreRemade(const RunFigures *figures, char *text)
{
  const PetscInt times = figures->run->way->regathered;

  if (times <= ADVICE_REGATHERED * PetscMax(figures->run->way->steps, 1)) return 0;
  snprintf(text, ADVICE_TEXT,
           "contact lists were made anew %lld times within steps: contact slides far in one; smaller steps "
           "(stepping.dt_max) are cheaper",
           (long long)times);
  return 1;
}

static int StepsAreLong(const RunFigures *figures, char *text)
{
  const StepperReport *way  = figures->run->way;
  const PetscReal      each = (PetscReal)way->newton_accepted / PetscMax(way->steps, 1);

  if (each <= ADVICE_ITERATIONS) return 0;
  snprintf(text, ADVICE_TEXT, "%.1f iterations a step: smaller steps (stepping.initial, dt_max) may need fewer in all",
           (double)each);
  return 1;
}

static int LineSearchCuts(const RunFigures *figures, char *text)
{
  const StepperReport *way = figures->run->way;

  if (way->cuts <= ADVICE_CUTS * way->newton_iterations) return 0;
  snprintf(text, ADVICE_TEXT,
           "the line search shortened %lld of %lld iterations: smaller steps, or a softer penalty at first (adjust)",
           (long long)way->cuts, (long long)way->newton_iterations);
  return 1;
}

static int OutputIsSlow(const RunFigures *figures, char *text)
{
  const PetscReal seconds = figures->usage.seconds[TIMING_OUTPUT];

  if (seconds <= ADVICE_OUTPUT_S || seconds <= ADVICE_OUTPUT * figures->usage.wall_s) return 0;
  snprintf(text, ADVICE_TEXT, "writing took %.0f %% of the time: output.every, or fewer output.fields",
           (double)(100 * seconds / figures->usage.wall_s));
  return 1;
}

static int KernelsAreOld(const RunFigures *figures, char *text)
{
  const PetscReal seconds = figures->usage.seconds[TIMING_SOLVE];
  const Blas     *blas    = &figures->blas;

  if (!blas->faster_kernels || !figures->direct || seconds <= ADVICE_SOLVER_S ||
      seconds <= ADVICE_SOLVER * figures->usage.wall_s)
    return 0;
  snprintf(text, ADVICE_TEXT,
           "the direct solver took %.0f %% of the time, with OpenBLAS's kernels for older processors (%s): %s%s",
           (double)(100 * seconds / figures->usage.wall_s), blas->kernels,
           blas->can_choose ? "in the environment OPENBLAS_CORETYPE="
                            : "an OpenBLAS made with DYNAMIC_ARCH=1, or TARGET=",
           blas->faster_kernels);
  return 1;
}

static const RunRuleFn run_rules[] = {StepsFail,    StepsRepeat,  NeighbourListsAreRemade, StepsAreLong, LineSearchCuts,
                                      OutputIsSlow, KernelsAreOld};

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
  char text[ADVICE_TEXT];

  for (int p = 0; p < figures->n_pairs && figures->last; p++)
    for (size_t r = 0; r < sizeof(pair_rules) / sizeof(pair_rules[0]); r++)
      if (pair_rules[r](figures, &figures->pairs[p], text)) print(text, context);
  for (size_t r = 0; r < sizeof(run_rules) / sizeof(run_rules[0]); r++)
    if (run_rules[r](figures, text)) print(text, context);
}

/*@
  AdviceForFailure - returns what helps most often after each kind of failed solve.

  Not collective

  Input Parameter:
. result - how the solve ended

  Note:
  The text is empty where there is nothing to try.
@*/
const char *AdviceForFailure(SolveResult result)
{
  static const char *const tries[] = {
    [SOLVE_CONVERGED]   = "",
    [SOLVE_ITERATIONS]  = "a smaller stepping.initial and dt_min, more solver.max_iterations, a smaller penalty.scale",
    [SOLVE_LINE_SEARCH] = "a smaller stepping.dt_min, a smaller penalty.scale; a load beyond what the structure "
                          "carries has no equilibrium: displacements instead",
    [SOLVE_DOMAIN]    = "smaller steps (stepping.initial, dt_min), a finer mesh around the element, law: neo_hookean, "
                        "which resists being crushed",
    [SOLVE_LINEAR]    = "supports for what -check says that contact only or nothing holds, or an imposed displacement "
                        "instead of a force until contact is made",
    [SOLVE_WORKSPACE] = "-mat_mumps_icntl_14 200, or more ranks",
    [SOLVE_LISTS]     = "a smaller stepping.dt_min and dt_max, a finer or smoother master where the node is",
    [SOLVE_CYCLE] = "PETSc's default line search (bt) if another one was chosen, smaller steps, `symmetry` in the pair "
                    "where it ends at such a plane",
    [SOLVE_LOST] =
      "smaller steps (stepping.initial, dt_max), a stiffer penalty (penalty.scale), a finer master where the node is",
    [SOLVE_ADRIFT] = "an imposed displacement instead of a force until contact is made, or a smaller gap at the start",
    [SOLVE_WINDOW] = "a wider window (penalty.g_min, g_max), more penalty.range, or when: step",
    [SOLVE_NAN]    = "-check for cells of low quality, smaller steps; if it stays, a report to the authors"};

  return tries[result];
}
