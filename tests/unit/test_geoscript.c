/* Tokens of gmsh's language, and the commands among them that reach beyond the geometry. */
#include "geoscript.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>

static void CheckForbidden(const char *text, const char *expected, int line)
{
  GeoTokens   tokens;
  const char *what;
  int         at;

  assert_int_equal(GeoTokensCreate(text, strlen(text), &tokens), 0);
  what = GeoScriptForbidden(&tokens, &at);
  if (expected) {
    assert_non_null(what);
    assert_non_null(strstr(what, expected));
    assert_int_equal(tokens.token[at].line, line);
  } else {
    assert_null(what);
  }
  assert_int_equal(GeoTokensDestroy(&tokens), 0);
}

static void test_forbidden(void **state)
{
  (void)state;
  CheckForbidden("x = 1;\nSystemCall \"ls\";", "program", 2);
  CheckForbidden("x = 2;System/* */ \n Str(\"ls\");", "program", 1);
  CheckForbidden("// SystemCall\n/* \n */ 'a text' Save 'x';", "file", 3);
  CheckForbidden("1e5SystemCall \"ls\";", "program", 1);
  CheckForbidden("Printf (\"%g)\", (1)) > \"x\";", "file", 1);
  CheckForbidden("Save View[0] \"x\";", "file", 1);
  CheckForbidden("Plugin(Remote).Run;", "plugin", 1);
  CheckForbidden("General.LogFileName = \"x\";", "files", 1);
  CheckForbidden("Solver[0].Executable = \"x\";", "program", 1);
  CheckForbidden("Geometry.DoubleClickedPointCommand = \"x\";", "program", 1);
}

static void test_allowed(void **state)
{
  (void)state;
  CheckForbidden("// SystemCall \"x\";\n/* Save \"x\"; */ x = \"Print 'y'\"; y = 'Save';", NULL, 0);
  CheckForbidden("Save = 3; Print.Background = 1; x = Save + 1; If (Save) EndIf Printf(\"Save\");", NULL, 0);
  CheckForbidden("MySystemCall = 1; SystemCall2 = 1; Mesh.MshFileVersion = 4.1; General.Terminal = 1;", NULL, 0);
  CheckForbidden("Field[1].FileName = \"x\"; Printf(\"%g > %g\", 1, 2);", NULL, 0);
  CheckForbidden("", NULL, 0);
}

static void CheckWrong(const char *text, size_t size, const char *expected)
{
  GeoTokens tokens;

  assert_int_equal(GeoTokensCreate(text, size, &tokens), 0);
  assert_int_equal(tokens.token[tokens.n - 1].kind, GEO_END);
  if (expected) {
    assert_non_null(tokens.wrong);
    assert_non_null(strstr(tokens.wrong, expected));
  } else {
    assert_null(tokens.wrong);
  }
  assert_int_equal(GeoTokensDestroy(&tokens), 0);
}

/* gmsh goes on behind such places in its own way, so that the rest of the text is not what it looks like. */
static void test_broken_texts(void **state)
{
  static char text[1100];

  (void)state;
  CheckWrong("x = \"abc;", 9, "no end");
  CheckWrong("x = 1;\0SystemCall", 17, "zero");
  memset(text, 'x', sizeof(text) - 1);
  text[0] = text[1024] = '"';
  CheckWrong(text, 1025, NULL);
  text[1024] = 'x';
  text[1025] = '"';
  CheckWrong(text, 1026, "1023");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_forbidden), cmocka_unit_test(test_allowed),
                                     cmocka_unit_test(test_broken_texts)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
