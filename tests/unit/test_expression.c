/* Shows that expressions have the values of their formulas, say which variables they use, and refuse every other text
   with the place of the mistake, in any locale. */
#include "scene/expression.h"
#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

static const double X[3] = {-1.5, 2, 0.25}, T = 0.375;

static Expression Make(const char *text, Geometry geometry)
{
  Expression expression;
  char       mistake[800];

  assert_int_equal(ExpressionCreate(text, geometry, &expression, mistake, sizeof mistake), 0);
  assert_string_equal(mistake, "");
  assert_non_null(expression);
  return expression;
}

static void AssertValue(const char *text, Geometry geometry, double value)
{
  Expression expression = Make(text, geometry);

  if (!(fabs(ExpressionValue(expression, X, T) - value) <= 1e-15 * fabs(value)))
    fail_msg("%s: %.17g instead of %.17g", text, ExpressionValue(expression, X, T), value);
  assert_int_equal(ExpressionDestroy(&expression), 0);
  assert_null(expression);
}

static void AssertMistake(const char *text, Geometry geometry, const char *expect)
{
  Expression expression;
  char       mistake[800];

  assert_int_equal(ExpressionCreate(text, geometry, &expression, mistake, sizeof mistake), 0);
  assert_null(expression);
  if (!strstr(mistake, expect)) fail_msg("%s: '%s' lacks '%s'", text, mistake, expect);
  if (!strstr(mistake, "; allowed: an expression of x, y, ")) fail_msg("%s: '%s' allows nothing", text, mistake);
}

static void ValuesAreThoseOfTheFormulas(void **state)
{
  (void)state;
  AssertValue("1e7 + 1e6*cos(2*theta)", GEOMETRY_SOLID, 1e7 + 1e6 * cos(2 * atan2(X[1], X[0])));
  AssertValue("x*y*z - t", GEOMETRY_SOLID, X[0] * X[1] * X[2] - T);
  AssertValue("r", GEOMETRY_SOLID, 2.5);
  AssertValue("r", GEOMETRY_PLANE_STRAIN, 2.5);
  AssertValue("r", GEOMETRY_AXISYMMETRIC, X[0]);
  AssertValue("theta/pi", GEOMETRY_PLANE_STRAIN, atan2(X[1], X[0]) / M_PI);
  AssertValue("2.5E-3", GEOMETRY_SOLID, 2.5e-3);
  AssertValue(".5*y", GEOMETRY_SOLID, 1);
  AssertValue("-y^2", GEOMETRY_SOLID, -4);
  AssertValue("y^3^2", GEOMETRY_SOLID, 512);
  AssertValue("t < 0.5 && x <= 0 ? 3 : 4", GEOMETRY_SOLID, 3);
  AssertValue("t == 0.375 || x != 0 ? 3 : 4", GEOMETRY_SOLID, 3);
  AssertValue("max(x, y, z) + min(x, y)", GEOMETRY_SOLID, 0.5);
  AssertValue("sin(y) + cos(y) + tan(y) + asin(t) + acos(t) + atan(y) + atan2(y, x)", GEOMETRY_SOLID,
              sin(2) + cos(2) + tan(2) + asin(T) + acos(T) + atan(2) + atan2(2, -1.5));
  AssertValue("sinh(y) + cosh(y) + tanh(y) + exp(y)", GEOMETRY_SOLID, sinh(2) + cosh(2) + tanh(2) + exp(2));
  AssertValue("ln(y) + log10(y) + sqrt(y) + abs(x) + sign(x)", GEOMETRY_SOLID, log(2) + log10(2) + sqrt(2) + 0.5);
}

static void UsesAreThoseOfTheText(void **state)
{
  Expression expression = Make("1e3*exp(x) + t", GEOMETRY_SOLID);

  (void)state;
  for (int v = 0; v < EXPRESSION_VARIABLES; v++)
    assert_int_equal(ExpressionUses(expression, v), v == EXPRESSION_X || v == EXPRESSION_T);
  assert_false(ExpressionIsNumber(expression));
  assert_int_equal(ExpressionDestroy(&expression), 0);
  expression = Make("2*(3 + pi)", GEOMETRY_SOLID);
  assert_true(ExpressionIsNumber(expression));
  assert_int_equal(ExpressionDestroy(&expression), 0);
  assert_false(ExpressionUses(NULL, EXPRESSION_T));
}

/* Several expressions live at a time, each with its own variables. */
static void ExpressionsAreApart(void **state)
{
  Expression a = Make("x", GEOMETRY_SOLID), b = Make("x + t", GEOMETRY_SOLID);

  (void)state;
  assert_true(ExpressionValue(a, X, T) == X[0]);
  assert_true(ExpressionValue(b, (double[3]){5, 0, 0}, 1) == 6);
  assert_true(ExpressionValue(a, X, T) == X[0]);
  assert_int_equal(ExpressionDestroy(&a), 0);
  assert_int_equal(ExpressionDestroy(&b), 0);
}

static void ValuesMayBeInfinite(void **state)
{
  Expression expression = Make("sqrt(x)", GEOMETRY_SOLID);

  (void)state;
  assert_false(isfinite(ExpressionValue(expression, X, T)));
  assert_true(ExpressionValue(expression, (double[3]){4, 0, 0}, 0) == 2);
  assert_int_equal(ExpressionDestroy(&expression), 0);
}

static void MistakesHaveTheirPlace(void **state)
{
  (void)state;
  AssertMistake("1e7 + 1e6*cos(2*thta)", GEOMETRY_SOLID, "character 17: thta is no known name");
  AssertMistake("x + log(y)", GEOMETRY_SOLID, "character 5: log is no known name");
  AssertMistake("_pi", GEOMETRY_SOLID, "character 1: _pi is no known name");
  AssertMistake("0x10", GEOMETRY_SOLID, "character 2: x10 is no known name");
  AssertMistake("x + z", GEOMETRY_PLANE_STRAIN, "character 5: z has no meaning in this geometry");
  AssertMistake("theta", GEOMETRY_AXISYMMETRIC, "character 1: theta has no meaning in this geometry");
  AssertMistake("x = 3", GEOMETRY_SOLID, "character 3: = is no operator");
  AssertMistake("(x=3)", GEOMETRY_SOLID, "character 3: = is no operator");
  AssertMistake("x*y; 3", GEOMETRY_SOLID, "character 4: ; is not allowed");
  AssertMistake("x \"y\"", GEOMETRY_SOLID, "character 3: \" is not allowed");
  AssertMistake("µ*x", GEOMETRY_SOLID, "character 1: µ is not allowed");
  AssertMistake("cos(2*x", GEOMETRY_SOLID, "character 8: missing parenthesis");
  AssertMistake("x)", GEOMETRY_SOLID, "character 2: unexpected parenthesis");
  AssertMistake("x +", GEOMETRY_SOLID, "character 4: unexpected end of expression");
  AssertMistake("2 x", GEOMETRY_SOLID, "character 3: unexpected variable \"x\"");
  AssertMistake("1.5.2", GEOMETRY_SOLID, "character 4: unexpected value");
  AssertMistake("sin(x, y)", GEOMETRY_SOLID, "too many parameters for function \"sin\"");
  AssertMistake("min()", GEOMETRY_SOLID, "too few parameters for function \"min\"");
  AssertMistake("x < 1 ? 2", GEOMETRY_SOLID, "missing an else clause");
  AssertMistake("1,5", GEOMETRY_SOLID, "has a comma outside a function");
  AssertMistake("1e400", GEOMETRY_SOLID, "character 1: unexpected token");
  AssertMistake("nan", GEOMETRY_SOLID, "character 1: nan is no known name");
}

/* A locale with a decimal comma changes nothing. The test says nothing where the machine has no such locale. */
static void LocaleDoesNotMatter(void **state)
{
  static const char *const names[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE.utf8", "de_DE"};

  (void)state;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(names) && !setlocale(LC_ALL, names[k]); k++) {}
  AssertValue("1.5*y", GEOMETRY_SOLID, 3);
  AssertMistake("1,5*y", GEOMETRY_SOLID, "has a comma outside a function");
  setlocale(LC_ALL, "C");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(ValuesAreThoseOfTheFormulas), cmocka_unit_test(UsesAreThoseOfTheText),
    cmocka_unit_test(ExpressionsAreApart),         cmocka_unit_test(ValuesMayBeInfinite),
    cmocka_unit_test(MistakesHaveTheirPlace),      cmocka_unit_test(LocaleDoesNotMatter),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
