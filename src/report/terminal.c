/* Progress and warnings of a run on the terminal, see terminal.h. */
#include "terminal.h"
#include "advice.h"
#include "endreport.h"
#include "runlength.h"
#include "units.h"
#include "report/precheck.h"
#include "scene/commandline.h"
#include <math.h>
#include <stdio.h>

/* Damping that took more than this part of the stored energy is warned of. */
#define TERMINAL_DAMPED 0.01
/* From this part on, more was lost than is stored: the answer is that of the damping. */
#define TERMINAL_LOST 1
/* Ties that hold more than this part of the forces are told with what lowers that. It is a tenth of the error that a
   run without any settings may have. */
#define TERMINAL_TIED 1e-3
/* Motions that ties hold are unstable where their stiffness is below 0 by more than this part of their body's. The
   unevenness of meshes gives neutral ones, such as the rolling of a ball, far less. */
#define TERMINAL_UNSTABLE 1e-2
/* Surfaces that cross by less than this part of a face are said to touch: so far places go off by what curved faces of
   coarse meshes leave. */
#define TERMINAL_CROSSED 1e-3

enum {
  EFFECTS_SIZE  = 2 * PETSC_MAX_PATH_LEN, /* characters of the list of a run's effects */
  DURATION_SIZE = 32                      /* characters of a duration */
};

struct _n_Terminal {
  Model       model;
  Probes      probes;
  Scene       scene;
  char        directory[PETSC_MAX_PATH_LEN];
  PetscBool   quiet, talks; /* talks: rank 0 of a run that is not quiet */
  PetscMPIInt rank, size;
  PetscReal   t_began;                  /* load parameter at which this part of the run began */
  PetscInt    failed;                   /* attempts of this part that failed */
  PetscBool   told_steps, told_results; /* that the run gets long */
};

/*@
  TerminalCreate - prepares what a run prints; nothing is printed yet.

  Collective

  Input Parameters:
+ model     - of the run
. probes    - of that model
. scene     - of that model
. directory - of the results, named in the last line
- quiet     - nothing but warnings and errors is printed

  Output Parameter:
. result - free it with TerminalDestroy()
@*/
PetscErrorCode TerminalCreate(Model model, Probes probes, Scene scene, const char *directory, PetscBool quiet,
                              Terminal *result)
{
  const MPI_Comm comm = model->mesh->comm;
  Terminal       terminal;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&terminal));
  terminal->model  = model;
  terminal->probes = probes;
  terminal->scene  = scene;
  PetscCall(PetscStrncpy(terminal->directory, directory, sizeof(terminal->directory)));
  PetscCallMPI(MPI_Comm_rank(comm, &terminal->rank));
  PetscCallMPI(MPI_Comm_size(comm, &terminal->size));
  terminal->quiet = quiet;
  terminal->talks = terminal->rank == 0 && !quiet ? PETSC_TRUE : PETSC_FALSE;
  *result         = terminal;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TerminalDestroy - frees the object.

  Not collective

  Input Parameter:
. terminal - set to NULL
@*/
PetscErrorCode TerminalDestroy(Terminal *terminal)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(*terminal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void PrintBlas(void)
{
  Blas blas;

  BlasFind(&blas);
  printf("BLAS     ");
  BlasPrint(&blas, stdout);
  if (blas.reference)
    printf("warning: this is the reference BLAS; the direct solver is 6 to 7 times faster with OpenBLAS (Debian: apt "
           "install libopenblas0-serial)\n");
}

/* Names the linear solver as the options have left it. */
static PetscErrorCode PrintSolver(Terminal terminal)
{
  KSP           ksp;
  PC            pc;
  KSPType       method;
  PCType        conditioner;
  MatSolverType package = NULL;
  PetscBool     factors = PETSC_FALSE, own = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(SNESGetKSP(terminal->model->snes, &ksp));
  PetscCall(KSPGetType(ksp, &method));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCGetType(pc, &conditioner));
  if (conditioner) PetscCall(PetscObjectTypeCompareAny((PetscObject)pc, &factors, PCLU, PCCHOLESKY, PCILU, PCICC, ""));
  if (factors) PetscCall(PCFactorGetMatSolverType(pc, &package));
  if (conditioner) PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCSHELL, &own));
  if (own) PetscCall(PCShellGetName(pc, &conditioner));
  if (terminal->talks)
    printf("solver   %s, %s%s%s\n", method ? method : "PETSc's default", conditioner ? conditioner : "PETSc's default",
           package ? ", " : "", package ? package : "");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints program, scene and machine. */
static void PrintProgram(Terminal terminal)
{
  printf("burnish %s: %s (%s)\n", BURNISH_VERSION, terminal->scene->name, terminal->scene->file);
  printf("machine  %d rank%s, PETSc %d.%d.%d, %d-bit indices\n", terminal->size, terminal->size > 1 ? "s" : "",
         PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR, (int)(8 * sizeof(PetscInt)));
  PrintBlas();
}

/* Names the bodies for which `formulation: auto` took mixed elements, and those for which it had none. */
static void PrintChosen(Terminal terminal)
{
  const Scene scene = terminal->scene;

  for (int b = 0; b < scene->n_bodies; b++) {
    const SceneBody *body = &scene->bodies[b];

    if (body->rigid || !body->chosen || MaterialGetLaw(body->material.law)->plastic) continue;
    if (body->formulation == FORMULATION_MIXED)
      printf("chosen   formulation: mixed for body '%s', nu = %g\n", body->name, body->material.nu);
    else if (body->locks)
      printf("chosen   formulation: full for body '%s', nu = %g: its law has no mixed elements; it locks\n", body->name,
             body->material.nu);
  }
}

/* Tells which rigid tools have faces that were divided. */
static void PrintDivided(Terminal terminal)
{
  const Mesh mesh = terminal->model->mesh;

  for (int r = 0; r < mesh->n_rigid; r++) {
    const MeshRigid *tool = &mesh->rigid[r];

    if (tool->n_faces > tool->n_given)
      printf("chosen   faces of rigid tool '%s': %lld in the place of %lld; long ones beside short ones are divided\n",
             tool->name, (long long)tool->n_faces, (long long)tool->n_given);
  }
}

static PetscErrorCode PrintHead(Terminal terminal, PetscInt restarts, PetscInt last_step, const OptionRecord *options)
{
  char     effects[EFFECTS_SIZE];
  PetscInt dofs;

  PetscFunctionBeginUser;
  PetscCall(ModelEffects(terminal->model, effects, sizeof(effects)));
  PetscCall(ModelDofs(terminal->model, &dofs));
  if (terminal->talks) PrintProgram(terminal);
  if (terminal->talks && restarts)
    printf("restart  after step %lld, t = %g\n", (long long)last_step, (double)terminal->model->t);
  if (terminal->talks) OptionRecordPrint(options, stdout);
  PetscCall(PrintSolver(terminal));
  if (!terminal->quiet) PetscCall(MeshReport(terminal->model->mesh, terminal->scene, stdout));
  if (terminal->talks) printf("dofs     %lld free\neffects  %s\n", (long long)dofs, *effects ? effects : "none");
  if (!terminal->quiet) PetscCall(PrecheckPlasticity(terminal->model, stdout));
  if (terminal->talks) PrintChosen(terminal);
  if (terminal->talks) PrintDivided(terminal);
  if (!terminal->quiet) PetscCall(PrecheckMotions(terminal->model, stdout));
  if (terminal->talks) {
    printf("\n%5s %9s %9s %10s %10s %5s %5s %8s %12s %8s %8s\n", "step", "t", "dt", "iterations", "in contact", "in",
           "out", "beta", "penetration", "spent", "left");
    fflush(stdout);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Warns of bodies that lock. */
static void WarnLocking(Terminal terminal)
{
  for (int b = 0; b < terminal->scene->n_bodies && !terminal->rank; b++) {
    const SceneBody *body    = &terminal->scene->bodies[b];
    const int        plastic = body->locks && MaterialGetLaw(body->material.law)->plastic;

    if (!body->locks) continue;
    if (plastic)
      fprintf(
        stderr,
        "burnish: warning: %s: plastic flow keeps volumes, and elements of first order with full integration lock "
        "(too stiff); mesh.order: 2 and formulation: fbar do not [B503]\n",
        SceneWhere(terminal->scene, body->path, "material.law"));
    else
      fprintf(stderr,
              "burnish: warning: %s: nu = %g with elements of first order and full integration: they lock (too stiff); "
              "%s [B503]\n",
              SceneWhere(terminal->scene, body->path, "material.nu"), body->material.nu,
              body->chosen ? "mesh.order: 2 does not" : "mesh.order: 2 or formulation: mixed does not");
  }
}

/* Warns of pairs whose surfaces share nodes. A mesh generator that merges the points in which two bodies touch joins
   the bodies: no load separates them, and no gap shows it. */
static PetscErrorCode WarnJoined(Terminal terminal)
{
  const Scene  scene = terminal->scene;
  PetscInt     nodes;
  ContactPlace place;

  PetscFunctionBeginUser;
  for (int p = 0; p < scene->n_contacts; p++) {
    const SceneContact *contact = &scene->contacts[p];

    PetscCall(ContactPairJoined(terminal->model->contact, p, &nodes, &place));
    if (terminal->rank || !nodes) continue;
    fprintf(stderr,
            "burnish: warning: contact '%s': '%s' and '%s' have %" PetscInt_FMT
            " node%s in common, as node %" PetscInt_FMT
            " (%.6g, %.6g, %.6g): there they are one body and never part [B504]\n",
            contact->name, contact->slave, contact->master, nodes, nodes > 1 ? "s" : "", place.tag, (double)place.X[0],
            (double)place.X[1], (double)place.X[2]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TerminalBegin - prints the first lines of a run and warns of bodies that lock and of pairs that are joined.

  Collective

  Input Parameters:
+ terminal  - of the run
. restarts  - how many parts the run had before this one
. last_step - the last accepted step of those parts
- options   - PETSc's options, of which those are printed that the last restart changed

  Note:
  The model is in the state from which this part of the run begins. The first lines name version, ranks, BLAS, solver,
  mesh, effects and the rigid motions that only contact holds.
@*/
PetscErrorCode TerminalBegin(Terminal terminal, PetscInt restarts, PetscInt last_step, const OptionRecord *options)
{
  PetscFunctionBeginUser;
  terminal->t_began = terminal->model->t;
  PetscCall(PrintHead(terminal, restarts, last_step, options));
  WarnLocking(terminal);
  PetscCall(WarnJoined(terminal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TerminalWarnLost - warns that a file is not the one that the loaded checkpoint belongs to.

  Not collective

  Input Parameters:
+ terminal  - of the run
. name      - of the file in the directory
- last_step - step of the checkpoint
@*/
void TerminalWarnLost(Terminal terminal, const char *name, PetscInt last_step)
{
  if (terminal->rank == 0)
    fprintf(stderr, "burnish: warning: %s/%s is not what the checkpoint left: it begins anew after step %lld [B508]\n",
            terminal->directory, name, (long long)last_step);
}

/* Writes a duration as "12.3 s", "4:05 min" or "2:07 h". */
static const char *DurationText(double seconds, char text[DURATION_SIZE])
{
  const long s = (long)seconds;

  if (s < 60)
    snprintf(text, DURATION_SIZE, "%.1f s", seconds);
  else if (s < 3600)
    snprintf(text, DURATION_SIZE, "%ld:%02ld min", s / 60, s % 60);
  else
    snprintf(text, DURATION_SIZE, "%ld:%02ld h", s / 3600, s / 60 % 60);
  return text;
}

/* Prints the columns that only a run with contact has. */
static void PrintStepContact(const StepRecord *step)
{
  printf(" %10lld %5lld %5lld", (long long)step->contact.nodes, (long long)step->contact.in,
         (long long)step->contact.out);
  if (isfinite((double)step->beta))
    printf(" %8.3g", (double)step->beta);
  else
    printf(" %8s", "-");
  printf(" %12.3e", (double)step->contact.max_penetration);
}

/* Says once that the steps get many, and once that the results get large. */
static void PrintLength(Terminal terminal, const StepRecord *step)
{
  char text[RUN_LENGTH_TEXT];

  terminal->failed += step->attempts - 1;
  if (!terminal->told_steps && RunStepsAreMany(terminal->scene, step->step, terminal->failed, text)) {
    terminal->told_steps = PETSC_TRUE;
    printf("      %s\n", text);
  }
  if (!terminal->told_results &&
      RunResultsAreLarge(terminal->scene, RunResultsBytes(terminal->directory), step->t, text)) {
    terminal->told_results = PETSC_TRUE;
    printf("      %s\n", text);
  }
}

/* Names the step that has ended, where the scene has steps with names. */
static void PrintNamedStep(Terminal terminal, const StepRecord *step)
{
  const Scene scene = terminal->scene;

  for (int i = 0; i < scene->stepping.n_steps; i++)
    if (scene->stepping.steps[i].until == step->t)
      printf("      step '%s' has ended%s%s%s\n", scene->stepping.steps[i].name,
             i + 1 < scene->stepping.n_steps ? ", '" : "",
             i + 1 < scene->stepping.n_steps ? scene->stepping.steps[i + 1].name : "",
             i + 1 < scene->stepping.n_steps ? "' begins" : "");
}

/*@
  TerminalStep - prints the line of an accepted step, and once why a run gets long.

  Not collective

  Input Parameters:
+ terminal - of the run
. step     - the step
- spent    - wall time since this part of the run began (s)

  Note:
  The time that is left is estimated from the time spent for each unit of the load parameter.
@*/
void TerminalStep(Terminal terminal, const StepRecord *step, PetscReal spent)
{
  const double seconds = (double)spent, covered = (double)(step->t - terminal->t_began);
  char         spent_text[DURATION_SIZE], left_text[DURATION_SIZE];

  if (!terminal->talks) return;
  printf("%5lld %9.5g %9.3g %10lld", (long long)step->step, (double)step->t, (double)step->dt, (long long)step->newton);
  if (terminal->model->contact)
    PrintStepContact(step);
  else
    printf(" %10s %5s %5s %8s %12s", "-", "-", "-", "-", "-");
  printf(" %8s %8s\n", DurationText(seconds, spent_text),
         covered > 0.0 ? DurationText(seconds * (1.0 - (double)step->t) / covered, left_text) : "-");
  PrintNamedStep(terminal, step);
  if (step->tied)
    printf("      %lld nodes come into contact together: no step above dt_min separates them\n", (long long)step->tied);
  PrintLength(terminal, step);
  fflush(stdout);
}

/* Prints the final values of the probes; a contact edge with the node spacing that is its resolution. */
static PetscErrorCode PrintProbes(Terminal terminal, const PetscReal *values)
{
  PetscFunctionBeginUser;
  printf("\n");
  for (int i = 0; i < terminal->scene->n_probes; i++) {
    PetscReal spacing;
    char      unit[UNITS_TEXT];

    PetscCall(ProbesGetSpacing(terminal->probes, i, &spacing));
    printf("%-20s ", terminal->scene->probes[i].name);
    if (isfinite((double)values[i]))
      printf("%.9g", (double)values[i]);
    else
      printf("no value");
    UnitsProbe(terminal->scene, &terminal->scene->probes[i], unit);
    if (isfinite((double)values[i]) && UnitsNamed(terminal->scene) && *unit) printf(" %s", unit);
    if (isfinite((double)spacing)) printf(" (node spacing %.3g)", (double)spacing);
    printf("\n");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void PrintAugmented(const PairFigures *pair)
{
  const ContactWindow *window = &pair->window;

  printf("penalty of %s: augmented %lld times, %lld steps beyond g_max all the same; at the end %lld of %lld nodes "
         "in contact, largest penetration or "
         "opening %.3g g_max\n",
         pair->name, (long long)window->augmented, (long long)window->missed, (long long)window->outside,
         (long long)window->loaded, (double)window->excess);
}

static void PrintAdjusted(const PairFigures *pair)
{
  const ContactWindow *window = &pair->window;

  printf("penalty of %s: raised %lld times, lowered %lld, cut short %lld, light nodes spared %lld; at the end %lld "
         "of %lld loaded nodes outside the "
         "window, largest penetration %.3g g_max\n",
         pair->name, (long long)window->raised, (long long)window->lowered, (long long)window->clamped,
         (long long)window->light, (long long)window->outside, (long long)window->loaded, (double)window->excess);
}

/* Prints what the penalties' adjustment and augmentation did, with the window at the last accepted step. */
static void PrintWindows(const RunFigures *figures)
{
  for (int p = 0; p < figures->n_pairs; p++) {
    const PairFigures *pair = &figures->pairs[p];

    if (pair->scene->augment)
      PrintAugmented(pair);
    else if (pair->scene->adjust)
      PrintAdjusted(pair);
  }
}

/* Warns of PETSc options that nothing used. PETSc asks for the options that it knows and never looks at the others, so
   that a misspelt one would go unnoticed. */
static PetscErrorCode WarnUnused(void)
{
  PetscInt n;
  char   **names, **values;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n; i++)
    fprintf(stderr, "burnish: warning: nothing used the PETSc option -%s; is it misspelt? [B505]\n", names[i]);
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says at the top of the last screen which pairs never came into contact, and warns of them on stderr. */
static void PrintUnmet(Terminal terminal, const PetscReal *apart)
{
  const Scene scene = terminal->scene;

  for (int p = 0; p < scene->n_contacts && terminal->talks; p++)
    if (apart[p] >= 0)
      printf("\ncontact %s never came near: nearest distance %.3g at the end\n", scene->contacts[p].name,
             (double)apart[p]);
  for (int p = 0; p < scene->n_contacts && !terminal->rank; p++) {
    const SceneContact *contact = &scene->contacts[p];

    if (apart[p] < 0) continue;
    fprintf(stderr,
            "burnish: warning: contact '%s': no node of '%s' met '%s' in this run, nearest distance %.3g; if it should "
            "have: do the normals of the two point to each other? [B506]\n",
            contact->name, contact->slave, contact->master ? contact->master : "its analytic master", (double)apart[p]);
  }
}

/* Warns of surfaces that cross in a run in which no contact has pressed: its results are those of no contact. */
static void WarnCrossed(const RunFigures *figures, PetscBool met)
{
  const PetscReal over_h = figures->certificate.over_h;

  if (!met && over_h > TERMINAL_CROSSED)
    fprintf(
      stderr,
      "burnish: warning: surfaces cross by up to %.3g of a face in this run, and no contact pressed: the faces are "
      "too large for what touches [B154]\n",
      (double)over_h);
}

/* The pair in which the edge of a wedge stands between the points of its slave and presses nowhere; NULL: none. */
static const PairFigures *PairOnWedge(const RunFigures *figures)
{
  for (int p = 0; p < figures->n_pairs; p++)
    if (figures->pairs[p].master.wedge && !figures->pairs[p].quality.edges && AdviceMasterStands(&figures->pairs[p]))
      return &figures->pairs[p];
  return NULL;
}

/* Warns of the edge of a wedge between the points of a slave: its force has the direction of chance. */
static void WarnWedge(const RunFigures *figures)
{
  const PairFigures *pair = PairOnWedge(figures);

  if (!pair) return;
  fprintf(stderr,
          "burnish: warning: contact '%s': a sharp edge of '%s' stands %.2g of a face deep between the points of '%s', "
          "at (%.6g, %.6g, %.6g), and presses along its sides: forces across the edge are not to be trusted [B157]\n",
          pair->name, pair->scene->master, (double)pair->master.over_h, pair->scene->slave, (double)pair->master.X[0],
          (double)pair->master.X[1], (double)pair->master.X[2]);
}

/* Warns of penetrations of more than a face size, whose results are those of no contact. */
static void WarnDeep(PetscReal deepest, PetscReal standing)
{
  if (deepest > 1)
    fprintf(stderr,
            "burnish: warning: a slave node was up to %.3g face sizes behind its master: the penalty is too soft for "
            "what presses [B507]\n",
            (double)deepest);
  if (standing > PetscMax(1, deepest))
    fprintf(stderr,
            "burnish: warning: a master node stood up to %.3g face sizes deep in its slave: contact is enforced at the "
            "slave's points alone, which are too far apart there [B507]\n",
            (double)standing);
}

/* Warns of linear solves that did not become as accurate as they should be. */
static void WarnInaccurate(const RunFigures *figures)
{
  const LinearCounts *counts = &figures->linear;

  if (!counts->inaccurate) return;
  fprintf(stderr,
          "burnish: warning: %lld of %lld linear solves left a relative residual of up to %.2g, more than 100 times "
          "the tolerance, and refinement could not lower "
          "it; %sthe system is badly conditioned: is a penalty too large?\n",
          (long long)counts->inaccurate, (long long)counts->solves, (double)counts->worst,
          figures->run->message ? "" : "Newton's method converged all the same, but ");
}

/* The energy that damping took, over what is stored at the end. */
static PetscReal DampingShare(const RunFigures *figures)
{
  const PetscReal taken = figures->run->way->damping;

  if (!(taken > 0)) return 0;
  return figures->stored > 0 ? taken / figures->stored : PETSC_INFINITY;
}

/* Says what damping took out of the bodies in steps that failed without it. Warns where that is much. */
static void PrintDamping(const RunFigures *figures)
{
  const StepperReport *report    = figures->run->way;
  const PetscReal      thickness = figures->scene->thickness, share = DampingShare(figures);

  if (!report->damped) return;
  printf("damping of steps that failed without it: %lld steps, took an energy of %.4g, %.2g of what is stored; all "
         "steps end in static equilibrium\n",
         (long long)report->damped, (double)(report->damping * thickness), (double)share);
  if (share > TERMINAL_LOST)
    fprintf(
      stderr,
      "burnish: warning: damping took an energy of %.4g, more than the %.4g that is stored at the end: the answer "
      "is that of the damping. It is no answer to the load until shorter steps (stepping.dt_max) lose less\n",
      (double)(report->damping * thickness), (double)(figures->stored * thickness));
  else if (share > TERMINAL_DAMPED)
    fprintf(stderr,
            "burnish: warning: damping took %.3g of the energy that is stored at the end: the bodies went through "
            "states that are no static equilibria, and inertia may bring real parts elsewhere\n",
            (double)share);
}

/* Says what was done for bodies that only contact holds. */
static void PrintFreeBodies(const RunFigures *figures)
{
  const StepperReport *report = figures->run->way;

  if (figures->moved[0]) printf("moved into contact, without force: %s\n", figures->moved);
  if (figures->loose[0])
    printf("held where it is, as neither contact nor a load acts that way: %s; by up to %.2g of the forces%s\n",
           figures->loose, (double)report->tied,
           report->tied > TERMINAL_TIED ? ", which finer faces where they touch lower, unless a load acts a little "
                                          "that way"
                                        : "");
  if (figures->loose[0] && report->unstable > TERMINAL_UNSTABLE)
    printf(
      "         it does not stand there by itself: bodies that lie on each other would roll off. If nothing real holds "
      "them, such as friction on a flat or a guide, the answer is not theirs\n");
  if (report->held)
    printf("held along %s, as rolling, whose stiffness is that of the mesh: bodies that only contact holds, in "
           "%lld steps, as a coefficient of friction of %.2g would (solver.hold_rolling)\n",
           report->motions > 1 ? "soft motions" : "a soft motion", (long long)report->held, (double)report->friction);
  if (figures->free_bodies)
    printf("weak springs of free bodies: relaxed %lld times, hold %.2g of the forces at the end\n",
           (long long)report->relaxed, (double)report->share);
}

/* Does the last state give much energy away if anything disturbs it? */
static int EndsUnstable(const StepperReport *report)
{
  return report->gives > MODEL_GIVES;
}

/* Says which accepted states were no stable equilibria, and what leads to those. */
static void PrintStability(const RunFigures *figures)
{
  const StepperReport *report = figures->run->way;

  if (!report->unstable_steps) return;
  printf("unstable equilibria: at the end of %lld of %lld steps, up to %lld negative eigenvalue%s of the tangent",
         (long long)report->unstable_steps, (long long)report->steps, (long long)report->most_negatives,
         report->most_negatives > 1 ? "s" : "");
  if (report->gives > 0 && !isinf(report->gives))
    printf("; in the last state a turn by 0.1 along the unstable motion gives %.2g of the stored energy",
           (double)report->gives);
  printf("\n");
  if (EndsUnstable(report))
    printf(
      "         so it is since t = %.6g. Real bodies buckle or snap there; shorter steps (stepping.dt_max), a small "
      "load that leads one way%s may find a stable state\n",
      (double)report->unstable_from,
      figures->scene->stepping.damping == DAMPING_AUTO ? "" : ", or stepping.damping=auto");
}

static void PrintLast(Terminal terminal, const RunFigures *figures)
{
  const RunRecord     *run    = figures->run;
  const StepperReport *report = run->way;
  char                 text[DURATION_SIZE];

  if (report->jumps)
    printf(
      "jumped to another equilibrium: %lld time%s, the last %s; no equilibrium lies between, and inertia may bring "
      "a real part elsewhere\n",
      (long long)report->jumps, report->jumps > 1 ? "s" : "", report->jump);
  PrintStability(figures);
  if (report->cycles)
    printf("contact sets that repeated themselves: %lld, steps cut for it %lld; the last time %s\n",
           (long long)report->cycles, (long long)report->cycles_cut, report->cycle);
  printf("%s%s: %lld steps (%lld failed, %lld repeated), %lld iterations, %s; results in %s\n", run->status,
         DampingShare(figures) > TERMINAL_LOST ? ", but damping took more than is stored"
         : PairOnWedge(figures)                ? ", but a sharp edge stands in its slave"
         : EndsUnstable(report)                ? ", but in an unstable equilibrium"
                                               : "",
         (long long)report->steps, (long long)report->steps_failed, (long long)report->steps_repeated,
         (long long)report->newton_iterations, DurationText((double)run->wall_s, text), terminal->directory);
  fflush(stdout);
}

/*@
  TerminalEnd - prints the last lines of a run and warns of what its figures show.

  Not collective

  Input Parameters:
+ terminal - of the run
- last     - figures of the run and final values

  Note:
  To be called however the run ended. Without an accepted step there are no probes and no unmet pairs to speak of.
@*/
PetscErrorCode TerminalEnd(Terminal terminal, const TerminalLast *last)
{
  const RunFigures   *figures = last->figures;
  const LinearCounts *counts  = &figures->linear;
  const RunRecord    *run     = figures->run;

  PetscFunctionBeginUser;
  PrintUnmet(terminal, last->apart);
  if (terminal->talks && figures->last) PetscCall(PrintProbes(terminal, last->probes));
  if (terminal->talks) {
    PrintWindows(figures);
    EndReportPrint(figures, stdout);
    PrintFreeBodies(figures);
    PrintDamping(figures);
  }
  if (terminal->rank) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(WarnUnused());
  WarnDeep(last->deepest, last->standing);
  WarnCrossed(figures, last->met);
  WarnWedge(figures);
  ProbeErrorsWarn(figures->errors);
  if (terminal->talks && counts->refined)
    printf("linear solves: %lld of %lld refined, in %lld steps\n", (long long)counts->refined,
           (long long)counts->solves, (long long)counts->steps);
  WarnInaccurate(figures);
  if (run->message) fprintf(stderr, "burnish: %s: %s\n", run->status, run->message);
  if (terminal->talks) PrintLast(terminal, figures);
  PetscFunctionReturn(PETSC_SUCCESS);
}
