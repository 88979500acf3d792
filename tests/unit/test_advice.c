/* Advice is given for figures that are bad and only for those: errors by penetration, coarse facets,
 * fits that fall back, steps that fail, old kernels. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>
#include "advice.h"

typedef struct {
  SceneContact  scene;
  PairFigures   pair;
  StepperReport way;
  RunRecord     run;
  StepRecord    last;
  RunFigures    figures;
} Case;

/* A run without a fault: faces of size 1, facets on a flat master, ten steps of five iterations */
static void Good(Case *c)
{
  memset(c, 0, sizeof(*c));
  c->scene          = (SceneContact){.name = "sole", .penalty_auto = 1, .penalty_scale = 10};
  c->pair           = (PairFigures){.name    = "sole",
                                    .scene   = &c->scene,
                                    .quality = {.nodes = 5, .max_penetration = 1e-4, .max_penetration_over_h = 1e-4}};
  c->pair.stiffened = 1;
  c->way            = (StepperReport){.done = PETSC_TRUE, .steps = 10, .newton_iterations = 50, .newton_accepted = 50};
  c->run            = (RunRecord){.way = &c->way};
  c->figures = (RunFigures){.run = &c->run, .usage = {.wall_s = 1}, .last = &c->last, .n_pairs = 1, .pairs = &c->pair};
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
    assert_non_null(strstr(text, part));
    assert_ptr_equal(strchr(text, '\n'), text + strlen(text) - 1);
  }
}

static void test_pairs(void **state)
{
  Case c;

  (void)state;
  Good(&c);
  Expect(&c, NULL);
  c.pair.penalty_error.pressure = 0.03;
  Expect(&c, "10 times the penalty");
  c.scene.penalty_may_stiffen = 1;
  Expect(&c, NULL); /* pressures may scatter, and no penalty changes that */
  c.pair.penalty_error.force = 0.03;
  Expect(&c, "penalty: {scale: 1e+02}"); /* 3 % to 0.3 % */
  c.scene.adjust = 1;
  Expect(&c, NULL);
  Good(&c);
  c.pair.penalty_error.force = NAN; /* not estimated */
  Expect(&c, NULL);
  Good(&c);
  c.pair.fits = (ContactFits){.points = 20, .plain = 20, .smoothing_error = 1e-2};
  Expect(&c, NULL);
  c.pair.fits.plain  = 17;
  c.pair.fits.linear = 3;
  Expect(&c, "3 of 20 slave points");
  Good(&c);
  c.pair.quality.sagitta = 2e-3;
  Expect(&c, "smoother: diffuse");
  Good(&c);
  c.pair.window = (ContactWindow){.outside = 2, .loaded = 5};
  Expect(&c, "2 of 5 loaded nodes");
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
  c.way.steps_repeated = 6;
  Expect(&c, "taken back");
  Good(&c);
  c.way.regathered = 11;
  Expect(&c, "lists");
  Good(&c);
  c.way.cuts = 20;
  Expect(&c, "line search");
  Good(&c);
  c.way.newton_iterations = c.way.newton_accepted = 130;
  Expect(&c, "13.0 iterations a step");
  Good(&c);
  c.figures.usage.wall_s                 = 40;
  c.figures.usage.seconds[TIMING_OUTPUT] = 20;
  Expect(&c, "50 %");
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
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_pairs), cmocka_unit_test(test_steps),
                                     cmocka_unit_test(test_kernels)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
