/* The parameters of a .geo are the names that it asks gmsh for, in whichever way, and no others. */
#include "geoparameters.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>

static void CheckList(const char *text, const char *expected)
{
  GeoParameters parameters = {0};
  char         *names;

  assert_int_equal(GeoParametersAdd(text, &parameters), 0);
  assert_int_equal(GeoParametersText(&parameters, &names), 0);
  if (expected)
    assert_string_equal(names, expected);
  else
    assert_non_null(strstr(names, "DefineConstant"));
  PetscFree(names);
  assert_int_equal(GeoParametersReset(&parameters), 0);
}

static void test_declarations(void **state)
{
  (void)state;
  CheckList("DefineConstant[n = 4];", "n");
  CheckList("DefineConstant [ n = {4, Name \"a, b = [\"}, m_2={2, Choices{0, 1}},\n  last ];", "n, m_2, last");
  CheckList("DefineConstant[a = Max(b, c), d = {e[1], Min 0}, a = 3];", "a, d");
  CheckList("If (!Exists(w))\n w = 2;\nEndIf\nIf (Exists (v)) EndIf", "w, v");
  CheckList("DefineConstant[a = 1]; DefineConstant[b = \"text\"];", "a, b");
}

static void test_no_declarations(void **state)
{
  (void)state;
  CheckList("n = 4; Printf(\"%g\", m);", NULL);
  CheckList("// DefineConstant[n = 4];\n/* DefineConstant[m = 4];\n*/ Printf(\"DefineConstant[k = 1]\");", NULL);
  CheckList("MyDefineConstant[n = 4]; DefineConstants[m = 2]; x = \"unfinished", NULL);
  CheckList("DefineConstant", NULL);
  CheckList("DefineConstant[", NULL);
  CheckList("/* unfinished DefineConstant[n = 4];", NULL);
}

static void test_computed_names(void **state)
{
  GeoParameters parameters = {0};

  (void)state;
  assert_int_equal(GeoParametersAdd("DefineConstant[n~{i} = 4, m = 1];", &parameters), 0);
  assert_true(GeoParametersFind(&parameters, "n_1"));
  assert_true(GeoParametersFind(&parameters, "m"));
  assert_false(GeoParametersFind(&parameters, "n"));
  assert_false(GeoParametersFind(&parameters, "m_1"));
  assert_int_equal(GeoParametersReset(&parameters), 0);
}

/* A name that the file uses and never sets is wanted from outside; one that it sets is not. */
static void test_names_without_value(void **state)
{
  GeoParameters parameters = {0};

  (void)state;
  assert_int_equal(GeoParametersAdd("draw = 1; k += 1; l[] = {1}; If(solid) x = 2 * width; EndIf\n"
                                    "For j In {0 : many} Point(j) = {x, j == 1, 0}; EndFor\n"
                                    "Transfinite Curve{1} = 4; Recombine Surface{1}; Physical Volume(1) = {1};",
                                    &parameters),
                   0);
  assert_true(GeoParametersFind(&parameters, "solid"));
  assert_true(GeoParametersFind(&parameters, "width"));
  assert_true(GeoParametersFind(&parameters, "many"));
  assert_false(GeoParametersFind(&parameters, "draw"));
  assert_false(GeoParametersFind(&parameters, "k"));
  assert_false(GeoParametersFind(&parameters, "l"));
  assert_false(GeoParametersFind(&parameters, "x"));
  assert_false(GeoParametersFind(&parameters, "j"));
  assert_false(GeoParametersFind(&parameters, "Point"));
  assert_false(GeoParametersFind(&parameters, "Physical"));
  assert_false(GeoParametersFind(&parameters, "Transfinite"));
  assert_false(GeoParametersFind(&parameters, "Recombine"));
  assert_false(GeoParametersFind(&parameters, "missing"));
  assert_int_equal(GeoParametersReset(&parameters), 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_declarations), cmocka_unit_test(test_no_declarations),
                                     cmocka_unit_test(test_computed_names), cmocka_unit_test(test_names_without_value)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
