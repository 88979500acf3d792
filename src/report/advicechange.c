/* The table of changes that advice may propose, see advicechange.h. */
#include "advicechange.h"
#include "runlength.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A smallest step above this may be what stops a run; a smaller one is advised as this. It is the key's default. */
#define CHANGE_DT_MIN      1e-5
#define CHANGE_DT_MIN_NEAR 1e-4
/* Iterations that Newton's method is given by default. With twice as many it does not get on either. */
#define CHANGE_MAX_ITERATIONS 30
/* A penalty is made softer by this, down to the bodies' own stiffness; and stiffer by as much where no figure tells by
   how much. */
#define CHANGE_PENALTY 10.0
/* By how much bounds are widened. */
#define CHANGE_WIDER 10.0
/* Elastic slip, in face sizes, that hardly counts. */
#define CHANGE_STICK_SLIP 0.001
/* The preset of stepping.plastic_lag, from which a scene without a bound is counted. */
#define CHANGE_LAG_BOUND 0.2
/* The same of stepping.contact_travel. */
#define CHANGE_TRAVEL_BOUND 0.02

/* What a change moves. Changes of one axis add up or oppose each other. */
typedef enum {
  AXIS_STIFFNESS, /* of a pair's penalty */
  AXIS_STICK,     /* stiffness of what sticks by friction */
  AXIS_WINDOW,
  AXIS_RANGE,
  AXIS_UPDATES,
  AXIS_WHEN,
  AXIS_SMOOTHNESS, /* of a pair's master */
  AXIS_FORMULATION,
  AXIS_SYMMETRY,
  AXIS_ROLES,
  AXIS_ROOM, /* of the bodies between tools */
  AXIS_SLAVE_MESH,
  AXIS_MASTER_FACES,
  AXIS_MASTER_MESH,
  AXIS_HOLD, /* of bodies */
  AXIS_LAW,
  AXIS_ELEMENTS,
  AXIS_STEP, /* length of the load steps */
  AXIS_PREDICTION,
  AXIS_ITERATIONS,
  AXIS_DAMPING,
  AXIS_LINE_SEARCH,
  AXIS_WORKSPACE,
  AXIS_OUTPUT,
  AXIS_KERNELS,
  AXIS_CHECK
} ChangeAxis;

typedef struct {
  const char *key; /* of the scene, * for the number of pair or body; or what else is changed */
  ChangeAxis  axis;
  int         direction; /* on the axis: 1 or -1 */
  int (*possible)(const ChangePlace *);
  void (*write)(const ChangePlace *, char *text, size_t size);
} Change;

static const SceneContact *PairScene(const ChangePlace *at)
{
  return at->pair ? at->pair->scene : NULL;
}

static int Always(const ChangePlace *at)
{
  (void)at;
  return 1;
}

/* Writes "-set PATH.KEY=VALUE" with a value of two digits. */
static void WriteNumber(const char *path, const char *key, double value, char *text, size_t size)
{
  char rounded[32];

  snprintf(rounded, sizeof(rounded), "%.1e", value);
  snprintf(text, size, "-set %s.%s=%g", path, key, atof(rounded));
}

static int PenaltyIsChosen(const ChangePlace *at)
{
  const SceneContact *contact = PairScene(at);

  return contact && !contact->adjust && !contact->augment && !contact->penalty_may_stiffen;
}

static void WriteFreePenalty(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "-set '%s.penalty={}', so that the run chooses the penalty", PairScene(at)->path);
}

static int PenaltyIsFixed(const ChangePlace *at)
{
  return PairScene(at) && !PairScene(at)->adjust;
}

/* The factor on the penalty that the run ended with. */
static double PenaltyScale(const ChangePlace *at)
{
  return PairScene(at)->penalty_scale * fmax(1, (double)at->pair->stiffened);
}

static void WriteStiffer(const ChangePlace *at, char *text, size_t size)
{
  WriteNumber(PairScene(at)->path, "penalty.scale", PenaltyScale(at) * (at->factor > 1 ? at->factor : CHANGE_PENALTY),
              text, size);
}

static int PenaltyIsStiff(const ChangePlace *at)
{
  return PenaltyIsFixed(at) && (!PairScene(at)->penalty_auto || PenaltyScale(at) >= CHANGE_PENALTY);
}

static void WriteSofter(const ChangePlace *at, char *text, size_t size)
{
  WriteNumber(PairScene(at)->path, "penalty.scale", PenaltyScale(at) / CHANGE_PENALTY, text, size);
}

static int HasFriction(const ChangePlace *at)
{
  return PairScene(at) && PairScene(at)->friction;
}

/* Where the scene names no elastic slip, one that hardly counts. */
static void WriteStick(const ChangePlace *at, char *text, size_t size)
{
  const SceneContact *contact = PairScene(at);

  if (contact->stick_penalty > 0)
    WriteNumber(contact->path, "friction.stick.penalty", contact->stick_penalty * at->factor, text, size);
  else
    WriteNumber(contact->path, "friction.stick.slip",
                contact->stick_slip > 0 ? contact->stick_slip / at->factor : CHANGE_STICK_SLIP, text, size);
}

static int HasWindow(const ChangePlace *at)
{
  return PairScene(at) && (PairScene(at)->adjust || PairScene(at)->augment);
}

static void WriteWindow(const ChangePlace *at, char *text, size_t size)
{
  WriteNumber(PairScene(at)->path, "penalty.g_max", CHANGE_WIDER * PairScene(at)->g_max, text, size);
}

static int IsAdjusted(const ChangePlace *at)
{
  return PairScene(at) && PairScene(at)->adjust;
}

static void WriteRange(const ChangePlace *at, char *text, size_t size)
{
  WriteNumber(PairScene(at)->path, "penalty.range", PetscSqr(CHANGE_WIDER) * PairScene(at)->range, text, size);
}

static int IsAugmented(const ChangePlace *at)
{
  return PairScene(at) && PairScene(at)->augment;
}

static void WriteUpdates(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "-set %s.penalty.max_updates=%d", PairScene(at)->path, 4 * PairScene(at)->max_updates);
}

static int IsAdjustedByStep(const ChangePlace *at)
{
  return IsAdjusted(at) && !PairScene(at)->adjust_converged;
}

static int IsAdjustedInStep(const ChangePlace *at)
{
  return IsAdjusted(at) && PairScene(at)->adjust_converged;
}

static void WriteConverged(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "-set %s.penalty.when=converged", PairScene(at)->path);
}

static void WriteStep(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "-set %s.penalty.when=step", PairScene(at)->path);
}

static int HasFacets(const ChangePlace *at)
{
  return PairScene(at) && PairScene(at)->master && PairScene(at)->smoother == SMOOTHER_FACET;
}

static void WriteDiffuse(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "-set %s.smoother=diffuse", PairScene(at)->path);
}

static int HasNodes(const ChangePlace *at)
{
  return PairScene(at) && PairScene(at)->formulation == CONTACT_NODE_TO_SURFACE;
}

static void WriteSurface(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "-set %s.formulation=surface_to_surface", PairScene(at)->path);
}

static int HasDegree4(const ChangePlace *at)
{
  return PairScene(at) && PairScene(at)->master && PairScene(at)->smoother != SMOOTHER_FACET &&
         PairScene(at)->degree == 4;
}

static void WriteDegree2(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "-set %s.degree=2", PairScene(at)->path);
}

static int MayHaveSymmetry(const ChangePlace *at)
{
  return PairScene(at) && PairScene(at)->master && !PairScene(at)->n_symmetry && at->figures->scene->n_supports > 0;
}

static void WriteSymmetry(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "%s.symmetry with the planes of symmetry, if its surfaces end at some", PairScene(at)->path);
}

static int MasterIsRigid(Scene scene, const char *master)
{
  for (int b = 0; b < scene->n_bodies; b++)
    if (scene->bodies[b].rigid && !strcmp(scene->bodies[b].name, master)) return 1;
  return 0;
}

static int MayExchange(const ChangePlace *at)
{
  return PairScene(at) && PairScene(at)->master && !PairScene(at)->listed &&
         !MasterIsRigid(at->figures->scene, PairScene(at)->master);
}

static void WriteRoles(const ChangePlace *at, char *text, size_t size)
{
  const SceneContact *contact = PairScene(at);

  snprintf(text, size, "-set %s.slave=%s -set %s.master=%s", contact->path, contact->master, contact->path,
           contact->slave);
}

static int HasPair(const ChangePlace *at)
{
  return PairScene(at) ? 1 : 0;
}

static int HasMeshedMaster(const ChangePlace *at)
{
  return PairScene(at) && PairScene(at)->master;
}

static void WriteFinerSlave(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "a finer mesh at '%s'", PairScene(at)->slave);
}

static void WriteRoom(const ChangePlace *at, char *text, size_t size)
{
  (void)at;
  snprintf(text, size, "room for bodies that keep their volume, by the motion of a tool or at a wall, or a smaller nu");
}

static void WriteFinerMaster(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "a finer or more even mesh at '%s'", PairScene(at)->master);
}

static int MasterEnds(const ChangePlace *at)
{
  return HasMeshedMaster(at) && at->pair->quality.hanging > 0;
}

static void WriteWholeMaster(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "the faces of the body that follow beyond the end of '%s', in this surface",
           PairScene(at)->master);
}

static int IsLoose(const ChangePlace *at)
{
  return PairScene(at) && PairScene(at)->stabilise == STABILISE_FALSE;
}

static void WriteStabilise(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "-set %s.stabilise=auto", PairScene(at)->path);
}

/* The first load of the scene that is a force, or NULL. */
static const SceneLoad *ForceLoad(Scene scene)
{
  for (int i = 0; i < scene->n_loads; i++)
    if (scene->loads[i].kind >= LOAD_PRESSURE && scene->loads[i].kind <= LOAD_FORCE) return &scene->loads[i];
  return NULL;
}

static int HasForceLoad(const ChangePlace *at)
{
  return ForceLoad(at->figures->scene) ? 1 : 0;
}

static void WriteDisplacement(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "an imposed displacement of '%s' instead of its force", ForceLoad(at->figures->scene)->region);
}

static int HasBody(const ChangePlace *at)
{
  return at->body >= 0;
}

static void WriteSupport(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "a support that holds '%s'; -check tells which motions are free",
           at->figures->scene->bodies[at->body].name);
}

static int MayBeCrushed(const ChangePlace *at)
{
  return at->body >= 0 && !at->figures->scene->bodies[at->body].rigid &&
         at->figures->scene->bodies[at->body].material.law == MATERIAL_SVK;
}

static void WriteLaw(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "-set %s.material.law=neo_hookean", at->figures->scene->bodies[at->body].path);
}

static int IsEnhanced(const ChangePlace *at)
{
  return at->body >= 0 && at->figures->scene->bodies[at->body].formulation == FORMULATION_ENHANCED;
}

static void WriteFormulation(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "-set %s.formulation=full", at->figures->scene->bodies[at->body].path);
}

static int IsNamed(const ChangePlace *at)
{
  return at->body >= 0 && !at->figures->scene->bodies[at->body].chosen;
}

static void WriteAuto(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "-set %s.formulation=auto", at->figures->scene->bodies[at->body].path);
}

/* Bodies of which the run itself gives others than full elements, and routines of the user, have no enhanced ones. */
static int IsFull(const ChangePlace *at)
{
  return at->body >= 0 && at->figures->scene->bodies[at->body].formulation == FORMULATION_FULL &&
         at->figures->scene->bodies[at->body].material.law != MATERIAL_UMAT;
}

static void WriteEnhanced(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "-set %s.formulation=enhanced", at->figures->scene->bodies[at->body].path);
}

static int IsFirstOrder(const ChangePlace *at)
{
  return at->figures->scene->order != 2;
}

static void WriteSecondOrder(const ChangePlace *at, char *text, size_t size)
{
  (void)at;
  snprintf(text, size, "-set mesh.order=2");
}

/* Mean length of the steps so far. */
static double MeanStep(const ChangePlace *at)
{
  const StepperReport *way = at->figures->run->way;

  return way->steps > 0 ? (double)way->t / (double)way->steps : at->figures->scene->stepping.initial;
}

/* Steps are not shorter already than the solver can make use of, nor so many that the progress has asked for longer
   ones. */
static int MayBeShorter(const ChangePlace *at)
{
  return MeanStep(at) > CHANGE_DT_MIN_NEAR && at->figures->run->way->steps <= RUN_MANY_STEPS;
}

/* A result that may be wrong needs shorter steps, however many there are. */
static int PathMayBeFiner(const ChangePlace *at)
{
  return MeanStep(at) > CHANGE_DT_MIN_NEAR;
}

/* Halves the steps by their length alone. */
static void WritePath(const ChangePlace *at, char *text, size_t size)
{
  WriteNumber("stepping", at->figures->scene->stepping.control == STEP_FIXED ? "initial" : "dt_max", MeanStep(at) / 2,
              text, size);
}

static void WriteShorter(const ChangePlace *at, char *text, size_t size)
{
  const Scene scene = at->figures->scene;

  if (scene->stepping.control == STEP_CONTACT && scene->stepping.N_c_fraction > 0)
    WriteNumber("stepping", "N_c_fraction", scene->stepping.N_c_fraction / 2, text, size);
  else
    WritePath(at, text, size);
}

static void WriteFlow(const ChangePlace *at, char *text, size_t size)
{
  WriteNumber("stepping", "plastic_strain", (double)at->figures->last->energy.growth / at->factor, text, size);
}

/* The present bound over what the lag is to fall by; without a bound, that of the scenes that name none. */
static void WriteLag(const ChangePlace *at, char *text, size_t size)
{
  const double bound = at->figures->scene->stepping.plastic_lag;

  WriteNumber("stepping", "plastic_lag", (bound > 0 ? bound : CHANGE_LAG_BOUND) / at->factor, text, size);
}

/* As it is with the lag, but that the preset is what is asked for where the scene names no bound. */
static void WriteTravel(const ChangePlace *at, char *text, size_t size)
{
  const double bound = at->figures->scene->stepping.contact_travel;

  WriteNumber("stepping", "contact_travel", bound > 0 ? bound / at->factor : CHANGE_TRAVEL_BOUND, text, size);
}

static int StopsEarly(const ChangePlace *at)
{
  return at->figures->scene->stepping.dt_min > CHANGE_DT_MIN_NEAR;
}

static void WriteShorterMin(const ChangePlace *at, char *text, size_t size)
{
  (void)at;
  WriteNumber("stepping", "dt_min", CHANGE_DT_MIN, text, size);
}

static int CountsNodes(const ChangePlace *at)
{
  return at->figures->scene->stepping.control == STEP_CONTACT;
}

static void WriteMoreNodes(const ChangePlace *at, char *text, size_t size)
{
  const Scene scene = at->figures->scene;

  if (scene->stepping.N_c)
    snprintf(text, size, "-set stepping.N_c=%d", 2 * scene->stepping.N_c);
  else
    WriteNumber("stepping", "N_c_fraction", fmin(1, 2 * scene->stepping.N_c_fraction), text, size);
}

static int PredictsAfterwards(const ChangePlace *at)
{
  return CountsNodes(at) && !at->figures->scene->stepping.predict_linearly;
}

static void WritePrediction(const ChangePlace *at, char *text, size_t size)
{
  (void)at;
  snprintf(text, size, "-set stepping.prediction=tangent");
}

static int HasFewIterations(const ChangePlace *at)
{
  return at->figures->scene->solver.max_iterations < CHANGE_MAX_ITERATIONS;
}

static void WriteIterations(const ChangePlace *at, char *text, size_t size)
{
  (void)at;
  snprintf(text, size, "-set solver.max_iterations=%d", CHANGE_MAX_ITERATIONS);
}

static int IsUndamped(const ChangePlace *at)
{
  return at->figures->scene->stepping.damping != DAMPING_AUTO;
}

static void WriteDamping(const ChangePlace *at, char *text, size_t size)
{
  (void)at;
  snprintf(text, size, "-set stepping.damping=auto, where a body snaps or buckles");
}

static void WriteLineSearch(const ChangePlace *at, char *text, size_t size)
{
  (void)at;
  snprintf(text, size, "-snes_linesearch_type bt, PETSc's default, if another one was chosen");
}

static void WriteWorkspace(const ChangePlace *at, char *text, size_t size)
{
  (void)at;
  snprintf(text, size, "-mat_mumps_icntl_14 200, or more ranks");
}

static int WritesOften(const ChangePlace *at)
{
  return at->figures->scene->output.every > 0;
}

static void WriteOutput(const ChangePlace *at, char *text, size_t size)
{
  snprintf(text, size, "-set output.every=%d", 10 * at->figures->scene->output.every);
}

static int HasFasterKernels(const ChangePlace *at)
{
  return at->figures->blas.faster_kernels ? 1 : 0;
}

static void WriteKernels(const ChangePlace *at, char *text, size_t size)
{
  const Blas *blas = &at->figures->blas;

  snprintf(text, size, "%s%s",
           blas->can_choose ? "in the environment OPENBLAS_CORETYPE="
                            : "an OpenBLAS made with DYNAMIC_ARCH=1, or TARGET=",
           blas->faster_kernels);
}

static void WriteCheck(const ChangePlace *at, char *text, size_t size)
{
  (void)at;
  snprintf(text, size, "-check for free motions, gaps and cells of low quality");
}

/* The line that has the change tells it, with the key that rules the steps or the output. */
static void WriteNothing(const ChangePlace *at, char *text, size_t size)
{
  (void)at;
  (void)size;
  text[0] = '\0';
}

static const Change changes[CHANGES] = {
  [CHANGE_FREE_PENALTY]   = {"contact.*.penalty", AXIS_STIFFNESS, 1, PenaltyIsChosen, WriteFreePenalty},
  [CHANGE_STIFFER]        = {"contact.*.penalty.scale", AXIS_STIFFNESS, 1, PenaltyIsFixed, WriteStiffer},
  [CHANGE_SOFTER]         = {"contact.*.penalty.scale", AXIS_STIFFNESS, -1, PenaltyIsStiff, WriteSofter},
  [CHANGE_STICK]          = {"contact.*.friction.stick", AXIS_STICK, 1, HasFriction, WriteStick},
  [CHANGE_WIDER_WINDOW]   = {"contact.*.penalty.g_max", AXIS_WINDOW, 1, HasWindow, WriteWindow},
  [CHANGE_RANGE]          = {"contact.*.penalty.range", AXIS_RANGE, 1, IsAdjusted, WriteRange},
  [CHANGE_UPDATES]        = {"contact.*.penalty.max_updates", AXIS_UPDATES, 1, IsAugmented, WriteUpdates},
  [CHANGE_WHEN_CONVERGED] = {"contact.*.penalty.when", AXIS_WHEN, 1, IsAdjustedByStep, WriteConverged},
  [CHANGE_WHEN_STEP]      = {"contact.*.penalty.when", AXIS_WHEN, -1, IsAdjustedInStep, WriteStep},
  [CHANGE_DIFFUSE]        = {"contact.*.smoother", AXIS_SMOOTHNESS, 1, HasFacets, WriteDiffuse},
  [CHANGE_SURFACE]        = {"contact.*.formulation", AXIS_FORMULATION, 1, HasNodes, WriteSurface},
  [CHANGE_DEGREE_2]       = {"contact.*.degree", AXIS_SMOOTHNESS, 1, HasDegree4, WriteDegree2},
  [CHANGE_SYMMETRY]       = {"contact.*.symmetry", AXIS_SYMMETRY, 1, MayHaveSymmetry, WriteSymmetry},
  [CHANGE_ROLES]          = {"contact.*.slave", AXIS_ROLES, 1, MayExchange, WriteRoles},
  [CHANGE_ROOM]           = {"room", AXIS_ROOM, 1, HasPair, WriteRoom},
  [CHANGE_FINER_SLAVE]    = {"mesh of the slave", AXIS_SLAVE_MESH, 1, HasPair, WriteFinerSlave},
  [CHANGE_FINER_MASTER]   = {"mesh of the master", AXIS_MASTER_MESH, 1, HasMeshedMaster, WriteFinerMaster},
  [CHANGE_WHOLE_MASTER]   = {"faces of the master", AXIS_MASTER_FACES, 1, MasterEnds, WriteWholeMaster},
  [CHANGE_STABILISE]      = {"contact.*.stabilise", AXIS_HOLD, 1, IsLoose, WriteStabilise},
  [CHANGE_DISPLACEMENT]   = {"loads", AXIS_HOLD, 1, HasForceLoad, WriteDisplacement},
  [CHANGE_SUPPORT]        = {"supports", AXIS_HOLD, 1, HasBody, WriteSupport},
  [CHANGE_LAW]            = {"bodies.*.material.law", AXIS_LAW, 1, MayBeCrushed, WriteLaw},
  [CHANGE_FORMULATION]    = {"bodies.*.formulation", AXIS_ELEMENTS, 1, IsEnhanced, WriteFormulation},
  [CHANGE_AUTO]           = {"bodies.*.formulation", AXIS_ELEMENTS, 1, IsNamed, WriteAuto},
  [CHANGE_SECOND_ORDER]   = {"mesh.order", AXIS_ELEMENTS, 1, IsFirstOrder, WriteSecondOrder},
  [CHANGE_ENHANCED]       = {"bodies.*.formulation", AXIS_ELEMENTS, 1, IsFull, WriteEnhanced},
  [CHANGE_SHORTER]        = {"stepping", AXIS_STEP, -1, MayBeShorter, WriteShorter},
  [CHANGE_SHORTER_MIN]    = {"stepping.dt_min", AXIS_STEP, -1, StopsEarly, WriteShorterMin},
  [CHANGE_FLOW]           = {"stepping.plastic_strain", AXIS_STEP, -1, MayBeShorter, WriteFlow},
  [CHANGE_LAG]            = {"stepping.plastic_lag", AXIS_STEP, -1, MayBeShorter, WriteLag},
  [CHANGE_TRAVEL]         = {"stepping.contact_travel", AXIS_STEP, -1, PathMayBeFiner, WriteTravel},
  [CHANGE_PATH]           = {"stepping", AXIS_STEP, -1, PathMayBeFiner, WritePath},
  [CHANGE_MORE_NODES]     = {"stepping.N_c", AXIS_STEP, 1, CountsNodes, WriteMoreNodes},
  [CHANGE_LONGER]         = {"stepping", AXIS_STEP, 1, Always, WriteNothing},
  [CHANGE_PREDICTION]     = {"stepping.prediction", AXIS_PREDICTION, 1, PredictsAfterwards, WritePrediction},
  [CHANGE_ITERATIONS]     = {"solver.max_iterations", AXIS_ITERATIONS, 1, HasFewIterations, WriteIterations},
  [CHANGE_DAMPING]        = {"stepping.damping", AXIS_DAMPING, 1, IsUndamped, WriteDamping},
  [CHANGE_LINE_SEARCH]    = {"PETSc option", AXIS_LINE_SEARCH, 1, Always, WriteLineSearch},
  [CHANGE_WORKSPACE]      = {"PETSc option", AXIS_WORKSPACE, 1, Always, WriteWorkspace},
  [CHANGE_OUTPUT]         = {"output.every", AXIS_OUTPUT, 1, WritesOften, WriteOutput},
  [CHANGE_LESS_OUTPUT]    = {"output", AXIS_OUTPUT, 1, Always, WriteNothing},
  [CHANGE_KERNELS]        = {"environment", AXIS_KERNELS, 1, HasFasterKernels, WriteKernels},
  [CHANGE_CHECK]          = {"command line", AXIS_CHECK, 1, Always, WriteCheck}};

/*@
  AdviceChangePossible - tells whether a change can be made: 1, or 0 where the scene has no such key, has that value
  already, or another key of it rules the value.

  Not collective

  Input Parameters:
+ change - the change
- at     - what it is made to
@*/
int AdviceChangePossible(ChangeKind change, const ChangePlace *at)
{
  return changes[change].possible(at);
}

/*@
  AdviceChangeWrite - writes a possible change as the user makes it, with -set where it is one key.

  Not collective

  Input Parameters:
+ change - the change
. at     - what it is made to
- size   - of the text

  Output Parameter:
. text - the change in words
@*/
void AdviceChangeWrite(ChangeKind change, const ChangePlace *at, char *text, size_t size)
{
  changes[change].write(at, text, size);
}

/* Changes of pairs do not touch other pairs; all others are the whole run's. */
static int IsOfPair(ChangeKind change)
{
  return changes[change].axis <= AXIS_MASTER_MESH;
}

/*@
  AdviceChangesOppose - tells whether two changes move one axis or one key in opposite directions: 1 or 0.

  Not collective

  Input Parameters:
+ a      - a change
. pair_a - the pair that it is made to, or NULL
. b      - another one
- pair_b - the pair that it is made to, or NULL
@*/
int AdviceChangesOppose(ChangeKind a, const PairFigures *pair_a, ChangeKind b, const PairFigures *pair_b)
{
  const int same = changes[a].axis == changes[b].axis || !strcmp(changes[a].key, changes[b].key);

  if (!same || changes[a].direction == changes[b].direction) return 0;
  return !IsOfPair(a) || pair_a == pair_b;
}
