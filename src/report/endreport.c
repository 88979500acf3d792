/* The last screen of a run, see endreport.h. */
#include "endreport.h"
#include "advice.h"
#include <math.h>

/* The sides count as equal where the master's is less than this many times the slave's: where faces of both sides are
   in contact, they differ by curvature and round-off. */
#define END_SIDES 1.01
/* Part of the force of contact that nodes bear which have come in within a step, from which on it is told. */
#define END_TRAVEL 0.001
/* Penalties that are more than this many times what the run began with have been raised: a raise that was taken back
   leaves rounding. */
#define END_RAISED 1.001

/* Less of all energies is rounding: sums over all elements and slave nodes, of which each has some 1e-16. */
#define END_NO_ENERGY 1e-12

/* What the shape of the surfaces leaves open is told above this part of the forces: that much the run lets penetration
   leave. Beyond the second part it is no longer in proportion to the gaps. */
#define END_GEOMETRY       0.004
#define END_GEOMETRY_KNOWN 0.2

/* Names of the purposes that time is spent on */
static const char *const purposes[TIMING_KINDS] = {[TIMING_SETUP]            = "set-up",
                                                   [TIMING_SEARCH]           = "search",
                                                   [TIMING_FIT]              = "fits",
                                                   [TIMING_ASSEMBLY_ELASTIC] = "elastic assembly",
                                                   [TIMING_ASSEMBLY_CONTACT] = "contact assembly",
                                                   [TIMING_SOLVE]            = "solver",
                                                   [TIMING_CERTIFICATE]      = "certificate",
                                                   [TIMING_OUTPUT]           = "output"};

static void PrintTime(const RunFigures *figures, FILE *stream)
{
  const double wall = (double)figures->usage.wall_s;
  double       rest = wall - (double)figures->run->mesh_s;

  fprintf(stream, "time    ");
  if ((double)figures->run->mesh_s >= 0.005 * wall)
    fprintf(stream, " gmsh %.0f %%,", 100 * (double)figures->run->mesh_s / wall);
  for (int k = 0; k < TIMING_KINDS; k++) {
    const double part = wall > 0 ? 100 * (double)figures->usage.seconds[k] / wall : 0;

    rest -= (double)figures->usage.seconds[k];
    if (part >= 0.5) fprintf(stream, " %s %.0f %%,", purposes[k], part);
  }
  fprintf(stream, " other %.0f %% of %.3g s; CPU %.3g s, largest rank %.0f MB\n",
          wall > 0 ? fmax(0, 100 * rest / wall) : 0, wall, (double)figures->usage.cpu_s,
          (double)figures->usage.peak_rss_mb);
}

static void PrintPair(const PairFigures *pair, FILE *stream)
{
  const ContactQuality *quality = &pair->quality;

  fprintf(stream, "contact  %s: %lld %s, penetration up to %.3g (%.2g of a face)", pair->name,
          (long long)quality->nodes, quality->faces ? "faces" : "nodes", (double)quality->max_penetration,
          (double)quality->max_penetration_over_h);
  if (quality->deepest.tag >= 0)
    fprintf(stream, " at node %lld (%.5g, %.5g, %.5g)", (long long)quality->deepest.tag, (double)quality->deepest.X[0],
            (double)quality->deepest.X[1], (double)quality->deepest.X[2]);
  if (pair->fits.points)
    fprintf(stream, "; facet error %.2g, smoothing error %.2g", (double)pair->fits.facet_error,
            (double)pair->fits.smoothing_error);
  else if (quality->sagitta > 0)
    fprintf(stream, "; facet error about %.2g", (double)quality->sagitta);
  fprintf(stream, "\n");
  if (quality->averse)
    fprintf(stream, "         %s: %lld of %lld slave points near the master do not face it and take no part\n",
            pair->name, (long long)quality->averse, (long long)quality->near);
}

/* Prints from which side the surfaces stand deeper in each other. Nothing is enforced at the master's nodes. */
static void PrintSides(const PairFigures *pair, FILE *stream)
{
  const NodeDepth *master = &pair->master;
  const double     slave  = (double)PetscMax(pair->quality.max_penetration, 0);

  if (!pair->scene->master || (!pair->quality.nodes && !master->nodes)) return;
  if ((double)master->depth <= END_SIDES * slave)
    fprintf(stream,
            "sides    %s: the slave's penetration is the larger; the master's nodes stand up to %.3g in the "
            "slave\n",
            pair->name, (double)master->depth);
  else
    fprintf(stream,
            "sides    %s: the master's side is the larger: its node %lld (%.5g, %.5g, %.5g) stands %.3g (%.2g of a "
            "face) deep in the slave\n",
            pair->name, (long long)master->tag, (double)master->X[0], (double)master->X[1], (double)master->X[2],
            (double)master->depth, (double)master->over_h);
}

/* Prints what sticks and what slips. */
static void PrintFriction(const PairFigures *pair, FILE *stream)
{
  const ContactFriction *friction = &pair->friction;
  const double           area     = (double)(friction->sticking_area + friction->slipped_area),
               total              = (double)(friction->slid + friction->elastic);

  if (!pair->scene->friction) return;
  fprintf(stream, "friction %s: ", pair->name);
  if (area > 0)
    fprintf(stream, "%.3g %% of the area in contact sticks (%lld nodes, %lld slip); ",
            100 * (double)friction->sticking_area / area, (long long)friction->sticking, (long long)friction->slipping);
  else
    fprintf(stream, "no contact; ");
  fprintf(stream, "slip so far up to %.3g, elastic slip up to %.3g", (double)friction->slid, (double)friction->elastic);
  if (total > 0) fprintf(stream, " (%.2g %% of both)", 100 * (double)friction->elastic / total);
  fprintf(stream, "; energy taken %.4g\n", (double)friction->dissipated);
  if (friction->travel >= END_TRAVEL)
    fprintf(
      stream,
      "         it travels along the slave: nodes that came into contact in a step and stick bear up to %.2g %% of "
      "its force, and friction may be off by as much\n",
      100 * (double)friction->travel);
  if (friction->footless)
    fprintf(stream,
            "         %lld of these nodes have points whose normal meets no face of the master: friction lacks there\n",
            (long long)friction->footless);
}

/* Prints what facets in the place of the smooth surface would change, where that is more than penetration leaves. The
   error of the elements is in neither. */
static void PrintGeometryError(const PairFigures *pair, FILE *stream)
{
  const double change = (double)(pair->geometry * pair->penalty_error.force);

  if (!(pair->geometry > 1) || !(change > END_GEOMETRY)) return;
  if (change < END_GEOMETRY_KNOWN)
    fprintf(stream,
            "         not in it: the shape of the surfaces; facets in their place change forces by about %.2g %%\n",
            100 * change);
  else
    fprintf(stream,
            "         not in it: the shape of the surfaces; facets in their place change forces by more than %g "
            "%%\n",
            100 * END_GEOMETRY_KNOWN);
}

/* Prints what penetration and elastic slip leave of error, as estimated at the end of the load. */
static void PrintPenaltyError(const PairFigures *pair, FILE *stream)
{
  const PenaltyError *error = &pair->penalty_error;

  if (isnan((double)error->force) || !pair->quality.nodes) return;
  fprintf(
    stream,
    "error    %s: penetration leaves about %.2g %% in forces, %.2g %% in pressures, %.2g %% in the peak pressure, "
    "%.2g %% in displacements",
    pair->name, 100 * (double)error->force, 100 * (double)error->pressure, 100 * (double)error->peak,
    100 * (double)error->displacement);
  if (pair->scene->penalty_may_stiffen && (double)pair->stiffened > END_RAISED)
    fprintf(stream, "; penalty raised %.3g times for it%s", (double)pair->stiffened,
            pair->penalty_stays ? ", which lowered it by less than forecast: it was raised no more" : "");
  fprintf(stream, "\n");
  PrintGeometryError(pair, stream);
  if (!pair->scene->friction) return;
  fprintf(stream, "         elastic slip leaves about %.2g %% in forces, %.2g %% in displacements",
          100 * (double)error->slip_force, 100 * (double)error->slip_displacement);
  if ((double)pair->stick_stiffened > END_RAISED)
    fprintf(stream, "; its penalty raised %.3g times for it", (double)pair->stick_stiffened);
  fprintf(stream, "\n");
}

/* Says whether pairs come and go. These are judged only while they are wholly there. */
static PetscBool PairsFade(const Scene scene)
{
  PetscBool fade = PETSC_FALSE;

  for (int p = 0; p < scene->n_contacts; p++) fade = (PetscBool)(fade || scene->contacts[p].presence.n);
  return fade;
}

/* Prints what is certified. */
static void PrintCertificate(const RunFigures *figures, FILE *stream)
{
  const CertificateFigures *found = &figures->certificate;

  if (!figures->certified || !figures->last) return;
  fprintf(
    stream,
    "certified: nothing passed through anything unseen in %lld steps; faces cross by up to %.2g of a face, %.2g of "
    "what is allowed; outer forces balance to %.1e",
    (long long)(found->steps - found->refused), (double)found->over_h, (double)found->ratio, (double)found->force);
  if (figures->scene->geometry != GEOMETRY_AXISYMMETRIC) fprintf(stream, ", moments to %.1e", (double)found->moment);
  if (found->refused) fprintf(stream, "; %lld steps did not hold and were cut", (long long)found->refused);
  if (PairsFade(figures->scene)) fprintf(stream, "; pairs that come and go were judged while they were wholly there");
  fprintf(stream, "\n");
}

/* Says that nobody has looked for edges that cross edges, where listed surfaces may do so. */
static void PrintUnjudged(const RunFigures *figures, FILE *stream)
{
  const Scene scene  = figures->scene;
  PetscBool   listed = PETSC_FALSE;

  for (int p = 0; p < scene->n_contacts; p++)
    listed = (PetscBool)(listed || (scene->contacts[p].listed && scene->contacts[p].master));
  if (!listed || scene->geometry != GEOMETRY_SOLID || scene->output.certificate) return;
  fprintf(stream, "unjudged edges that cross edges have no contact, and were not looked for: "
                  "-set output.certificate=true does\n");
}

/* Prints where a fluid is, and when it leaked. */
static void PrintFluid(const FluidReport *fluid, FILE *stream)
{
  fprintf(stream, "fluid    on '%s': pressure %.4g, on %.3g %% of the surface", fluid->load->region,
          (double)fluid->pressure, 100 * (double)fluid->wetted);
  if (isfinite((double)fluid->leak_t))
    fprintf(stream, "; leaks at a pressure of %.4g, on the way to t = %.6g", (double)fluid->leak_pressure,
            (double)fluid->leak_t);
  else if (isfinite((double)fluid->barrier))
    fprintf(stream, "; tight, the contact as it is holds up to %.4g", (double)fluid->barrier);
  fprintf(stream, "\n");
}

/* Prints one guard that acted, with a separator before all but the first one. */
static void PrintGuard(FILE *stream, int *n, long long times, const char *what)
{
  if (!times) return;
  fprintf(stream, "%s%s %lld", (*n)++ ? ", " : "guards   ", what, times);
}

/* Prints why steps were cut, behind their number. */
static void PrintCutCauses(const StepperReport *way, FILE *stream)
{
  int n = 0;

  for (int cause = 0; cause < CUT_CAUSES; cause++) {
    if (way->cuts[cause])
      fprintf(stream, "%s%s %lld", n++ ? ", " : " (", CutCauses[cause], (long long)way->cuts[cause]);
  }
  if (n) fprintf(stream, ")");
}

static void PrintGuards(const RunFigures *figures, FILE *stream)
{
  const StepperReport *way = figures->run->way;
  int                  n   = 0;
  long long            low = 0, clamped = 0, light = 0, missed = 0;

  for (int p = 0; p < figures->n_pairs; p++) {
    low += figures->pairs[p].fits.points - figures->pairs[p].fits.plain;
    clamped += figures->pairs[p].window.clamped;
    light += figures->pairs[p].window.light;
    missed += figures->pairs[p].window.missed;
  }
  PrintGuard(stream, &n, LoadStepperCuts(way), "iterations cut by the line search:");
  PrintCutCauses(way, stream);
  PrintGuard(stream, &n, way->turned, "iterations turned downhill:");
  PrintGuard(stream, &n, way->regathered, "lists made anew within steps:");
  PrintGuard(stream, &n, way->adjusted, "steps solved on with new penalties or multipliers:");
  PrintGuard(stream, &n, way->wetted, "steps solved on with fluids that moved:");
  PrintGuard(stream, &n, missed, "steps beyond g_max after all updates:");
  PrintGuard(stream, &n, clamped, "penalties cut short:");
  PrintGuard(stream, &n, light, "light nodes spared:");
  PrintGuard(stream, &n, low, "fits off the plain rung:");
  fprintf(stream, n ? "\n" : "guards   none acted\n");
}

/* Prints whether a step gave energy back that flow and friction had taken. What is less than rounding is none. */
static void PrintDissipation(const EnergyFigures *energy, FILE *stream)
{
  const double sum = (double)EnergySum(energy), least = (double)energy->least;

  if (!(energy->dissipated > 0) && !(least < 0)) return;
  if (least < -END_NO_ENERGY * sum)
    fprintf(stream, "; a step dissipated %.2g %% of them", 100 * least / sum);
  else
    fprintf(stream, "; no step dissipated less than nothing");
}

/* Prints the work from outside, the energies of bodies and of contact, and how far the work is from their sum.
   jumped: the bodies jumped to another equilibrium. */
static void PrintEnergy(const EnergyFigures *energy, PetscBool plastic, PetscBool jumped, FILE *stream)
{
  const OuterFigures outer = energy->outer;
  const double       sum = (double)EnergySum(energy), apart = (double)EnergyApart(energy);

  fprintf(stream, "energy   work %.6g from outside = %.6g elastic", (double)outer.work, (double)energy->elastic);
  if (plastic) fprintf(stream, " + %.6g plastic", (double)energy->plastic);
  if (outer.stored > 0) fprintf(stream, " + %.4g contact", (double)outer.stored);
  if (outer.friction > 0) fprintf(stream, " + %.6g friction", (double)outer.friction);
  if (energy->damping > 0) fprintf(stream, " + %.4g damping", (double)energy->damping);
  if (outer.held != 0) fprintf(stream, " + %.4g held", (double)outer.held);
  if (isnan(apart)) fprintf(stream, ", without that of overlaps resolved at once");
  if (sum > 0 && !isnan(apart))
    fprintf(stream, ", %.2g %% apart by %sthe trapezoidal rule over the steps", 100 * apart / sum,
            jumped ? "what was lost in jumps and " : "");
  PrintDissipation(energy, stream);
  if (plastic)
    fprintf(stream, "; largest plastic strain %.4g, growth in a step up to %.2g", (double)energy->strain,
            (double)energy->growth);
  fprintf(stream, "\n");
  if (energy->lag > 0) /* of routines of users alone none is known */
    fprintf(
      stream,
      "         stresses lag behind the turns of plastic flow by %.2g %% in the mean, as far as the steps show it\n",
      100 * (double)(energy->lag / energy->plastic));
}

/* The stream, and how many changes to try have been printed */
typedef struct {
  FILE *stream;
  int   n;
} Tries;

static void PrintTry(const char *change, void *context)
{
  Tries *tries = context;

  fprintf(tries->stream, "%s %s\n", tries->n++ ? "or      " : "try     ", change);
}

static void PrintFailure(const RunFigures *figures, FILE *stream)
{
  Tries                tries   = {.stream = stream};
  const StepperReport *way     = figures->run->way;
  const Failure       *failure = &way->failed.solve.failure;

  fprintf(stream, "failed   on the way from t = %.6g to %.6g: %s\n", (double)way->t, (double)way->failed.t,
          SolveResults[way->failed.solve.result]);
  if (failure->point)
    fprintf(stream, "where    element %lld of '%s', point %d: the routine umat %s\n", (long long)failure->inverted,
            failure->inverted_body >= 0 ? figures->scene->bodies[failure->inverted_body].name : "", failure->point,
            failure->routine);
  else if (failure->inverted >= 0)
    fprintf(stream, "where    element %lld of '%s' was turned inside out\n", (long long)failure->inverted,
            failure->inverted_body >= 0 ? figures->scene->bodies[failure->inverted_body].name : "");
  for (int i = 0; i < failure->n; i++) {
    const FailureNode *node = &failure->node[i];

    fprintf(stream, "where    node %lld (%.6g, %.6g, %.6g): residual %.3g", (long long)node->place.tag,
            (double)node->place.X[0], (double)node->place.X[1], (double)node->place.X[2], (double)node->residual);
    if (isfinite((double)node->gap)) fprintf(stream, ", gap %.3g", (double)node->gap);
    if (node->body >= 0) fprintf(stream, "; body '%s'", figures->scene->bodies[node->body].name);
    if (node->pair >= 0) fprintf(stream, ", pair '%s'", figures->pairs[node->pair].name);
    fprintf(stream, "\n");
  }
  if (way->failed.solve.result == SOLVE_WINDOW || way->failed.solve.result == SOLVE_UNCERTIFIED)
    fprintf(stream, "where    %s\n", way->failed.solve.detail);
  fprintf(stream,
          "tried    %lld times, dt from %.3g down to %.3g (dt_min %.3g), the last time %lld iterations to a residual "
          "of %.2g\n",
          (long long)way->failed.attempts, (double)way->failed.first, (double)way->failed.last,
          figures->scene->stepping.dt_min, (long long)way->failed.solve.newton, (double)way->failed.solve.residual);
  AdviceTry(figures, PrintTry, &tries);
}

static void PrintAdvice(const char *line, void *stream)
{
  fprintf(stream, "advice   %s\n", line);
}

/* Does a pair of a list of surfaces touch nothing, and has it not slid before? */
static PetscBool IsIdle(const PairFigures *pair)
{
  return (PetscBool)(pair->scene->listed && !pair->quality.nodes && !pair->quality.averse && !pair->master.nodes &&
                     !(pair->scene->friction && (pair->friction.slid > 0 || pair->friction.dissipated > 0)));
}

/* Prints what is known of each pair. Lists of surfaces may have many pairs that touch nothing: they are counted. */
static void PrintPairs(const RunFigures *figures, FILE *stream)
{
  int idle = 0, listed = 0;

  for (int p = 0; p < figures->n_pairs; p++) {
    idle += IsIdle(&figures->pairs[p]);
    listed += figures->pairs[p].scene->listed;
  }
  for (int p = 0; p < figures->n_pairs; p++) {
    const PairFigures *pair = &figures->pairs[p];

    if (idle > 1 && IsIdle(pair)) continue;
    PrintPair(pair, stream);
    PrintFriction(pair, stream);
    PrintPenaltyError(pair, stream);
    PrintSides(pair, stream);
  }
  if (idle > 1) fprintf(stream, "contact  %d of the %d pairs of listed surfaces touch nothing\n", idle, listed);
}

/*@
  EndReportPrint - prints the last screen of a run but for probes and the closing line.

  Not collective

  Input Parameters:
+ figures - of the run; contact is that of the last accepted state
- stream  - where to

  Note:
  For one rank.
@*/
void EndReportPrint(const RunFigures *figures, FILE *stream)
{
  const StepperReport *way = figures->run->way;

  fprintf(stream, "\neffects  %s; %lld dofs on %d rank%s\n", figures->effects, (long long)figures->dofs, figures->ranks,
          figures->ranks > 1 ? "s" : "");
  fprintf(stream, "steps    %lld, failed %lld, repeated %lld; iterations %lld, of these %lld in accepted steps\n",
          (long long)way->steps, (long long)way->steps_failed, (long long)way->steps_repeated,
          (long long)way->newton_iterations, (long long)way->newton_accepted);
  PrintTime(figures, stream);
  if (figures->last) PrintPairs(figures, stream);
  ProbeErrorsPrint(figures->errors, stream);
  for (int i = 0; i < figures->n_fluids && figures->last; i++) PrintFluid(&figures->fluids[i], stream);
  if (figures->last && (SceneIsPlastic(figures->scene) || figures->certified))
    PrintEnergy(&figures->last->energy, SceneIsPlastic(figures->scene), way->jumps > 0, stream);
  PrintCertificate(figures, stream);
  PrintUnjudged(figures, stream);
  PrintGuards(figures, stream);
  if (way->failed.attempts) PrintFailure(figures, stream);
  AdviceGive(figures, PrintAdvice, stream);
}
