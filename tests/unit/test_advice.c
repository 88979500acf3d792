/* Advice is given for figures that are bad and only for those: errors by penetration, coarse facets,
 * fits that fall back, steps that fail, old kernels. No two lines pull one key in opposite directions, whatever goes
 * wrong together, and every change can be made in the scene. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>
#include "advice.h"
#include "runlength.h"

typedef struct {
  __typeof__(*(Scene)NULL) whole;
  SceneContact             scene;
  SceneBody                body;
  PairFigures              pair;
  StepperReport            way;
  RunRecord                run;
  StepRecord               last;
  PetscReal                variation; /* of the body */
  RunFigures               figures;
} Case;

/* A run without a fault: faces of size 1, facets on a flat master, ten steps of five iterations */
static void Good(Case *c)
{
  memset(c, 0, sizeof(*c));
  c->scene          = (SceneContact){.path          = "contact.0",
                                     .name          = "sole",
                                     .slave         = "floor",
                                     .master        = "foot",
                                     .penalty_auto  = 1,
                                     .penalty_scale = 10};
  c->pair           = (PairFigures){.name    = "sole",
                                    .scene   = &c->scene,
                                    .quality = {.nodes = 5, .max_penetration = 1e-4, .max_penetration_over_h = 1e-4}};
  c->pair.stiffened = 1;
  c->way  = (StepperReport){.done = PETSC_TRUE, .steps = 10, .t = 1, .newton_iterations = 50, .newton_accepted = 50};
  c->run  = (RunRecord){.way = &c->way};
  c->body = (SceneBody){.path = "bodies.0", .name = "block", .material.law = MATERIAL_SVK};
  c->whole.n_bodies              = 1;
  c->whole.bodies                = &c->body;
  c->whole.stepping.control      = STEP_ITERATIONS;
  c->whole.stepping.initial      = 0.1;
  c->whole.stepping.dt_min       = 1e-5;
  c->whole.solver.max_iterations = 30;
  c->whole.output.every          = 1;
  c->figures                     = (RunFigures){.scene     = &c->whole,
                                                .run       = &c->run,
                                                .usage     = {.wall_s = 1},
                                                .last      = &c->last,
                                                .n_pairs   = 1,
                                                .pairs     = &c->pair,
                                                .variation = &c->variation};
}

static void Collect(const char *line, void *text)
{
  strcat(text, line);
  strcat(text, "\n");
}

/* The only advice has this in it; NULL: there is none */
static void Expect(const Case *c, const char *part)
{
  char text[10 * ADVICE_TEXT] = "";

  AdviceGive(&c->figures, Collect, text);
  if (!part) {
    assert_string_equal(text, "");
  } else {
    if (!strstr(text, part)) fail_msg("\"%s\" is not in \"%s\"", part, text);
    assert_ptr_equal(strchr(text, '\n'), text + strlen(text) - 1);
  }
}

/* A run of more than a hundred steps or a gigabyte of results has a line that says why and what to change. */
static void test_length(void **state)
{
  static double t[200], v[200];
  SceneLoad     load = {.history = {2, t, v}};
  Case          c;

  (void)state;
  Good(&c);
  c.figures.scene->loads            = &load;
  c.figures.scene->n_loads          = 1;
  c.figures.scene->stepping.control = STEP_ITERATIONS;
  c.figures.scene->stepping.dt_max  = 1;
  c.way.steps                       = 100;
  Expect(&c, NULL);
  c.way.steps = c.way.newton_accepted = 101;
  Expect(&c, "101 steps: solves take many iterations, so that stepping.control: iterations keeps dt small; control:");
  c.figures.scene->stepping.control = STEP_CONTACT;
  Expect(&c, "stepping.control: contact lets few nodes come into contact in each; a larger stepping.N_c or");
  load.history.n = 200;
  Expect(&c, "they end on 198 load parameters of stepping.at and of histories; fewer of these");
  c.figures.scene->stepping.dt_max = 0.01;
  Expect(&c, "stepping.dt_max = 0.01 allows no longer ones; a larger dt_max");
  c.figures.scene->stepping.control = STEP_FIXED;
  c.figures.scene->stepping.initial = 0.01;
  Expect(&c, "stepping.control: fixed takes stepping.initial = 0.01; a larger one, or control: iterations");
  c.way.newton_accepted = 2000; /* steps are long too, but what the progress has said holds */
  Expect(&c, "stepping.control: fixed takes stepping.initial = 0.01; a larger one, or control: iterations");
  c.way.newton_accepted = 101;
  c.way.steps_failed    = 6;
  Expect(&c, "6 attempts failed and cut dt; a finer mesh of the slave");
  c.way.steps                   = 10;
  c.way.steps_failed            = 0;
  c.figures.results_bytes       = 2.5e9;
  c.figures.scene->output.every = 1;
  Expect(&c, "results.vtkhdf has 2.5 GB with output.every: 1; output.every: 3, or fewer output.fields");
  c.figures.results_bytes = 1e9;
  Expect(&c, NULL);
}

/* A body that locks has a line as long as the scene can be changed. */
static void test_locking(void **state)
{
  Case c;

  (void)state;
  Good(&c);
  c.body.locks       = 1;
  c.body.material.nu = 0.499;
  Expect(&c, "body 'block' has nu = 0.499 in elements of first order with full integration, which lock (too stiff): "
             "-set bodies.0.formulation=auto, or -set mesh.order=2");
  c.body.chosen = 1;
  Expect(&c, "(too stiff): -set mesh.order=2");
  c.body.locks = 0;
  Expect(&c, NULL);
}

/* A body of first order that bends has a line, unless it locks by its volume. */
static void test_bending(void **state)
{
  Case c;

  (void)state;
  Good(&c);
  c.variation = 0.19;
  Expect(&c, NULL);
  c.variation = 0.33;
  Expect(&c,
         "body 'block' stores 33 % of its energy in strains that vary within elements of first order: it bends, and "
         "they bend too stiffly: -set mesh.order=2, or -set bodies.0.formulation=enhanced");
  c.body.locks = 1;
  Expect(&c, "lock (too stiff)");
}

/* The size of the results is foretold from a tenth of a gigabyte on. */
static void test_foretold(void **state)
{
  char  text[RUN_LENGTH_TEXT];
  Scene scene;

  (void)state;
  PetscNew(&scene);
  scene->output.every = 2;
  assert_int_equal(RunResultsAreLarge(scene, 9e7, 0.01, text), 0);
  assert_int_equal(RunResultsAreLarge(scene, 2e8, 0.5, text), 0);
  assert_int_equal(RunResultsAreLarge(scene, 2e8, 0.1, text), 1);
  assert_string_equal(text, "results.vtkhdf will have 2.0 GB with output.every: 2; output.every: 4, or fewer "
                            "output.fields");
  PetscFree(scene);
}

static void test_pairs(void **state)
{
  Case c;

  (void)state;
  Good(&c);
  Expect(&c, NULL);
  c.pair.penalty_error.pressure = 0.03;
  Expect(&c, "-set 'contact.0.penalty={}', so that the run chooses the penalty, or -set contact.0.penalty.scale=100");
  c.scene.penalty_may_stiffen = 1;
  Expect(&c, NULL); /* pressures may scatter, and no penalty changes that */
  c.pair.penalty_error.force = 0.03;
  Expect(&c, "error: -set contact.0.penalty.scale=100"); /* 3 % to 0.3 % */
  c.scene.adjust = 1;
  Expect(&c, NULL);
  Good(&c);
  c.pair.penalty_error.force = NAN; /* not estimated */
  Expect(&c, NULL);
  Good(&c);
  c.pair.fits = (ContactFits){.points = 20, .within = 20, .plain = 20, .smoothing_error = 1e-2};
  Expect(&c, NULL);
  c.pair.fits.plain  = 17;
  c.pair.fits.linear = 3; /* beyond the end of the master */
  c.pair.fits.within = 17;
  Expect(&c, NULL);
  c.pair.fits.within     = 20;
  c.pair.fits.within_low = 3;
  Expect(&c, "3 of 20 slave points");
  Good(&c);
  c.pair.fits.apart_over_h = 0.2;
  Expect(&c,
         "the smooth surface is up to 0.2 of a face of the slave off the faces of 'foot': a finer or more even mesh");
  Good(&c);
  c.pair.quality.sagitta = 2e-3;
  Expect(&c, "smoother=diffuse");
  Good(&c);
  c.pair.window  = (ContactWindow){.outside = 2, .loaded = 5};
  c.scene.adjust = 1;
  Expect(&c, "2 of 5 loaded nodes");
  c.scene.adjust  = 0;
  c.scene.augment = 1;
  Expect(&c, NULL); /* steps that miss the bound count, not the state that is left */
  c.pair.window.missed = 3;
  Expect(&c, "3 of 10 steps ended with nodes beyond g_max after max_updates");
}

static void test_steps(void **state)
{
  Case c;

  (void)state;
  Good(&c);
  c.way.steps_failed = 2;
  Expect(&c, NULL);
  c.way.steps_failed = 3;
  Expect(&c, "3 steps failed");
  c.way.done = PETSC_FALSE; /* the failure says more */
  Expect(&c, NULL);
  Good(&c);
  c.way.steps_repeated     = 6;
  c.whole.stepping.control = STEP_CONTACT;
  Expect(&c, "taken back by the control: -set stepping.prediction=tangent, or -set stepping.N_c_fraction=");
  Good(&c);
  c.way.regathered = 11; /* costs little, less than more steps would */
  Expect(&c, NULL);
  c.figures.usage.seconds[TIMING_SEARCH] = 0.4;
  c.figures.usage.seconds[TIMING_FIT]    = 0.2;
  Expect(&c, "search took 60 % of the time");
  Good(&c);
  c.way.cuts[CUT_SHAPE] = 20;
  Expect(&c, "line search");
  Good(&c);
  c.way.newton_iterations = c.way.newton_accepted = 130;
  Expect(&c, "13.0 iterations a step");
  Good(&c);
  c.figures.usage.wall_s                 = 40;
  c.figures.usage.seconds[TIMING_OUTPUT] = 20;
  Expect(&c, "50 %");
}

/* Long steps of plastic flow in finite strains; the advised bound does not lead to the same advice. */
static void test_flow(void **state)
{
  Case c;

  (void)state;
  Good(&c);
  c.whole.kinematics   = KINEMATICS_FINITE;
  c.last.energy.growth = 0.15;
  Expect(&c, NULL);
  c.last.energy.growth = 0.6;
  Expect(&c, "plastic strain grows by up to 0.6 in a step, which costs a flow in shear 12 % of its stress: -set "
             "stepping.plastic_strain=0.09");
  c.whole.stepping.plastic_strain = c.last.energy.growth = 0.09;
  Expect(&c, NULL);
  c.whole.kinematics   = KINEMATICS_SMALL;
  c.last.energy.growth = 0.6;
  Expect(&c, NULL);
}

/* Steps that are too long for the path of plastic flow; what the trapezoidal rule loses of elastic energy alone does
   not count, and many steps are no reason to be silent. */
static void test_path(void **state)
{
  Case c;

  (void)state;
  Good(&c);
  c.last.energy = (EnergyFigures){.elastic = 700, .plastic = 1000, .work = 1660, .outer = {.work = 1660}};
  Expect(&c, NULL);
  c.last.energy.work = 1400;
  Expect(&c,
         "work and energies are 30 % of the plastic work apart: steps may be too long for the path of plastic flow and "
         "of contact, and forces and strains wrong; compare with shorter ones: -set stepping.dt_max=0.05");
  c.last.energy.work       = 1700;
  c.last.energy.outer.work = 2200; /* from outside, of which friction takes less than is missing */
  Expect(&c, "are 50 % of the plastic work apart");
  c.last.energy.outer.friction = 250;
  Expect(&c, "are 20 % of plastic work and friction apart");
  c.last.energy.outer.friction = 500;
  Expect(&c, NULL);
  c.last.energy.outer.given = 100; /* nothing does the work of overlaps that are resolved at once */
  c.last.energy.outer.work  = 0;
  Expect(&c, NULL);
  c.last.energy      = (EnergyFigures){.elastic = 700, .plastic = 1000, .outer = {.work = 1700}};
  c.last.energy.work = 2000; /* either sign */
  Expect(&c, "are 30 % of the plastic work apart");
  c.whole.stepping.control = STEP_FIXED;
  Expect(&c, "-set stepping.initial=0.05");
  c.whole.stepping.dt_max = 1;
  c.way.steps = c.way.newton_accepted = 200;
  Expect(&c, "-set stepping.initial=0.0025");
  c.last.energy         = (EnergyFigures){.elastic = 1e5, .plastic = 1000, .work = 1.005e5, .outer = {.work = 1.005e5}};
  c.way.steps           = 10;
  c.way.newton_accepted = 50;
  Expect(&c, NULL);
}

static void test_sliding(void **state)
{
  Case c;

  (void)state;
  Good(&c);
  c.last.energy = (EnergyFigures){.elastic = 180, .outer = {.work = 980, .friction = 780}};
  Expect(&c, NULL);
  c.last.energy.outer.work = 1500;
  Expect(&c, "are 69 % of what friction took apart: steps may be too long for what slides");
  c.last.energy.outer.friction = 1200;
  Expect(&c, NULL);
}

/* What can go wrong in a scene, all of it at once */
static void Bad(Case *c, StepControlKind control, int formulation, int adjust, int augment)
{
  Good(c);
  c->scene.smoother                       = SMOOTHER_FACET;
  c->scene.formulation                    = (ContactFormulation)formulation;
  c->scene.degree                         = 4;
  c->scene.adjust                         = adjust;
  c->scene.adjust_converged               = adjust == 2;
  c->scene.augment                        = augment;
  c->scene.max_updates                    = 10;
  c->scene.penalty_scale                  = 1000;
  c->scene.g_max                          = 1e-3;
  c->scene.range                          = 1e4;
  c->whole.stepping.control               = control;
  c->whole.stepping.N_c_fraction          = 0.05;
  c->whole.stepping.dt_min                = 0.01;
  c->pair.penalty_error.force             = 0.05;
  c->pair.scatter                         = 0.2;
  c->pair.master                          = (NodeDepth){.nodes = 3, .depth = 0.2, .over_h = 0.2};
  c->pair.quality.sagitta                 = 0.1;
  c->pair.window                          = (ContactWindow){.outside = 2, .loaded = 5, .missed = 3, .excess = 4};
  c->way.steps_failed                     = 9;
  c->way.steps_repeated                   = 9;
  c->way.regathered                       = 20;
  c->figures.usage.seconds[TIMING_SEARCH] = 0.6 * c->figures.usage.wall_s;
  c->way.cuts[CUT_SHAPE]                  = 40;
  c->way.newton_accepted                  = 500;
  c->whole.kinematics                     = KINEMATICS_FINITE;
  c->last.energy                          = (EnergyFigures){.plastic = 1, .work = 2, .growth = 0.5};
}

/* Lines do not contradict each other, and each change of theirs can be made and is written. */
static void Agree(const Case *c)
{
  Advice advice;

  AdviceCollect(&c->figures, &advice);
  assert_true(advice.n > 0);
  for (int i = 0; i < advice.n; i++) {
    assert_true(advice.lines[i].n > 0);
    for (int k = 0; k < advice.lines[i].n; k++) {
      char text[ADVICE_TEXT] = "";

      assert_true(AdviceChangePossible(advice.lines[i].changes[k], &advice.lines[i].at));
      AdviceChangeWrite(advice.lines[i].changes[k], &advice.lines[i].at, text, sizeof(text));
      assert_true(strlen(text) > 0);
      for (int j = 0; j < i; j++)
        for (int l = 0; l < advice.lines[j].n; l++) {
          const ChangeKind a = advice.lines[i].changes[k], b = advice.lines[j].changes[l];

          assert_false(AdviceChangesOppose(a, advice.lines[i].at.pair, b, advice.lines[j].at.pair));
        }
    }
  }
}

static void test_agree(void **state)
{
  Case c;

  (void)state;
  for (int control = 0; control < STEP_CONTROL_KINDS; control++)
    for (int form = 0; form < 2; form++)
      for (int adjust = 0; adjust < 3; adjust++)
        for (int augment = 0; augment < 2 - (adjust > 0); augment++)
          for (int result = SOLVE_CONVERGED; result <= SOLVE_NAN; result++) {
            Bad(&c, (StepControlKind)control, form, adjust, augment);
            c.way.done                = (PetscBool)(result == SOLVE_CONVERGED);
            c.way.failed.attempts     = result != SOLVE_CONVERGED;
            c.way.failed.solve.result = (SolveResult)result;
            Agree(&c);
          }
}

/* A failure is advised first, and what opposes it is left out. */
static void test_order(void **state)
{
  Case   c;
  Advice advice;

  (void)state;
  Bad(&c, STEP_CONTACT, CONTACT_SURFACE_TO_SURFACE, 0, 0);
  c.scene.smoother             = SMOOTHER_DIFFUSE;
  c.way.done                   = PETSC_FALSE;
  c.way.failed.attempts        = 1;
  c.way.failed.solve.result    = SOLVE_LINE_SEARCH;
  c.way.failed.solve.failure.n = 1; /* body 0, pair 0 */
  AdviceCollect(&c.figures, &advice);
  assert_true(advice.tries);
  assert_int_equal(advice.lines[0].changes[0], CHANGE_SHORTER_MIN);
  assert_int_equal(advice.lines[0].changes[1], CHANGE_SOFTER); /* diffuse it is */
  for (int i = 1; i < advice.n; i++)
    for (int k = 0; k < advice.lines[i].n; k++) {
      assert_int_not_equal(advice.lines[i].changes[k], CHANGE_STIFFER);
      assert_int_not_equal(advice.lines[i].changes[k], CHANGE_FREE_PENALTY);
      assert_int_not_equal(advice.lines[i].changes[k], CHANGE_MORE_NODES);
    }
  c.way.failed.solve.failure.squeeze = 0.6; /* the law is what fails */
  AdviceCollect(&c.figures, &advice);
  assert_int_equal(advice.lines[0].changes[0], CHANGE_LAW);
  c.way.failed.solve.result             = SOLVE_LOST;
  c.way.failed.solve.failure.squeeze    = 0.9;
  c.pair.quality.max_penetration_over_h = 1.2;
  AdviceCollect(&c.figures, &advice);
  assert_int_equal(advice.lines[0].changes[0], CHANGE_FREE_PENALTY);
  c.pair.quality.max_penetration_over_h = 0;
  AdviceCollect(&c.figures, &advice);
  assert_int_equal(advice.lines[0].changes[0], CHANGE_SHORTER_MIN);
  c.way.failed.solve.result  = SOLVE_UNCERTIFIED;
  c.way.failed.solve.failure = (Failure){.n = 1, .node = {{.body = -1}}, .inverted_body = -1};
  for (int nodes = 0; nodes < 2; nodes++) { /* where nothing presses, no penalty acts */
    int stiffer = 0;

    c.pair.quality.nodes = nodes;
    AdviceCollect(&c.figures, &advice);
    for (int k = 0; k < advice.lines[0].n; k++) stiffer |= advice.lines[0].changes[k] == CHANGE_STIFFER;
    assert_int_equal(stiffer, nodes);
  }
}

static void test_sides(void **state)
{
  Case c;

  (void)state;
  Good(&c);
  c.pair.scatter = NAN;
  Expect(&c, NULL);
  c.pair.scatter      = 0.2;
  c.scene.formulation = CONTACT_NODE_TO_SURFACE;
  Expect(&c, "sole: nodal pressures scatter by 20 % rms from node to node, their peak by more: -set "
             "contact.0.formulation=surface_to_surface, or a finer mesh at 'floor'");
  c.scene.formulation = CONTACT_SURFACE_TO_SURFACE;
  Expect(&c, "by more: a finer mesh at 'floor'");
  Good(&c);
  c.pair.master = (NodeDepth){.nodes = 1, .depth = 0.3, .over_h = 0.3};
  Expect(&c, "nodes of 'foot' stand up to 0.3 of a face deep between the slave's, displacements may be off by 0.3, and "
             "an edge presses there square to its sides, not to the slave: a finer mesh at 'floor', or -set "
             "contact.0.slave=foot -set contact.0.master=floor");
  Good(&c);
  c.pair.quality.hanging = 3;
  Expect(&c, "3 slave points hang over the end of 'foot' and take no part there: the faces of the body that follow "
             "beyond the end of 'foot', in this surface");
  c.pair.quality.hanging = 0;
  c.pair.master          = (NodeDepth){.nodes = 1, .depth = 0.3, .over_h = 0.3};
  c.body                 = (SceneBody){.path = "bodies.0", .name = "foot", .rigid = 1};
  Expect(&c, "not to the slave: a finer mesh at 'floor'"); /* a tool is no slave */
}

static void test_kernels(void **state)
{
  Case c;

  (void)state;
  Good(&c);
  c.figures.direct                      = PETSC_TRUE;
  c.figures.usage.wall_s                = 40;
  c.figures.usage.seconds[TIMING_SOLVE] = 20;
  c.figures.blas                        = (Blas){.kernels = "SkylakeX", .can_choose = 1};
  Expect(&c, NULL);
  c.figures.blas = (Blas){.kernels = "Prescott", .faster_kernels = "SkylakeX", .can_choose = 1};
  Expect(&c, "50 % of the time, with OpenBLAS's kernels for older processors (Prescott): in the environment "
             "OPENBLAS_CORETYPE=SkylakeX");
  c.figures.blas.can_choose = 0;
  Expect(&c, "an OpenBLAS made with DYNAMIC_ARCH=1, or TARGET=SkylakeX");
  c.figures.direct = PETSC_FALSE; /* little of its work is the BLAS's */
  Expect(&c, NULL);
  c.figures.direct       = PETSC_TRUE;
  c.figures.usage.wall_s = 100;
  Expect(&c, NULL);
  c.figures.usage.wall_s = c.figures.usage.seconds[TIMING_SOLVE] = 5;
  Expect(&c, NULL);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_length),   cmocka_unit_test(test_locking), cmocka_unit_test(test_bending),
    cmocka_unit_test(test_foretold), cmocka_unit_test(test_pairs),   cmocka_unit_test(test_steps),
    cmocka_unit_test(test_agree),    cmocka_unit_test(test_order),   cmocka_unit_test(test_sides),
    cmocka_unit_test(test_kernels),  cmocka_unit_test(test_flow),    cmocka_unit_test(test_path),
    cmocka_unit_test(test_sliding)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
