/* A formula of the scene, see expression.h. */
#include "scene/expression.h"
#include <ctype.h>
#include <math.h>
#include <muParserDLL.h>
#include <string.h>

/* The names of the variables, in the order of ExpressionVariable, and those that each geometry has */
static const char *const Variables[]   = {"x", "y", "z", "r", "theta", "t"};
static const char *const VariablesOf[] = {[GEOMETRY_SOLID]        = "x, y, z, r, theta, t",
                                          [GEOMETRY_PLANE_STRAIN] = "x, y, r, theta, t",
                                          [GEOMETRY_AXISYMMETRIC] = "x, y, r, t"};

/* The functions of muParser that are the same in all its versions; log is not */
#define FUNCTIONS "sin, cos, tan, asin, acos, atan, atan2, sinh, cosh, tanh, exp, ln, log10, sqrt, abs, sign, min, max"

const char ExpressionLanguage[] = "numbers, pi, + - * / ^ ( ), comparisons, && ||, a ? b : c, " FUNCTIONS;

struct _n_Expression {
  Geometry         geometry;
  muParserHandle_t parser;
  double           variable[EXPRESSION_VARIABLES]; /* muParser reads the variables here */
  PetscBool        uses[EXPRESSION_VARIABLES];
};

/* Tells whether a list of words has a word of n characters. */
static PetscBool ListHas(const char *words, const char *word, size_t n)
{
  for (size_t length; *words; words += length + strspn(words + length, ", ")) {
    length = strcspn(words, ",");
    if (length == n && !strncmp(words, word, n)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Returns the length of the number at the start of a text, or 0. */
static size_t NumberLength(const char *text)
{
  size_t n = strspn(text, "0123456789."), exponent;

  if (!n || (text[n] != 'e' && text[n] != 'E')) return n;
  exponent = n + 1 + (text[n + 1] == '+' || text[n + 1] == '-');
  return isdigit((unsigned char)text[exponent]) ? exponent + strspn(text + exponent, "0123456789") : n;
}

/* Returns the length of the first character of a text in UTF-8. */
static int CharacterLength(const char *text)
{
  int n = 1;

  while (((unsigned char)text[n] & 0xc0) == 0x80) n++;
  return n;
}

/* Writes what is wrong at a place of the text, counted from 0, and what is allowed. A negative place is left out. */
static void Mistake(const char *text, Geometry geometry, int at, const char *what, int n, const char *wrong,
                    char *mistake, size_t size)
{
  char place[40] = "";

  if (at >= 0) snprintf(place, sizeof place, "character %d: ", at + 1);
  snprintf(mistake, size, "\"%.100s%s\": %s%.*s%s; allowed: an expression of %s, %s", text,
           strlen(text) > 100 ? "..." : "", place, n, what, wrong, VariablesOf[geometry], ExpressionLanguage);
}

/* Checks the names and characters of a text, and notes which variables occur in it. */
static PetscBool NamesAreKnown(const char *text, Expression expression, char *mistake, size_t size)
{
  const Geometry geometry = expression->geometry;

  for (const char *c = text; *c;) {
    size_t n = NumberLength(c);

    if (!n) {
      n = strspn(c, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_");
      if (n && !ListHas(VariablesOf[geometry], c, n) && !ListHas("pi, " FUNCTIONS, c, n)) {
        Mistake(text, geometry, (int)(c - text), c, (int)PetscMin(n, 40),
                ListHas(VariablesOf[GEOMETRY_SOLID], c, n) ? " has no meaning in this geometry" : " is no known name",
                mistake, size);
        return PETSC_FALSE;
      }
      for (int v = 0; v < EXPRESSION_VARIABLES; v++)
        if (n && ListHas(Variables[v], c, n)) expression->uses[v] = PETSC_TRUE;
    }
    if (!n &&
        (!strchr(" +-*/^(),<>=!?:&|", *c) || (*c == '=' && c[1] != '=' && (c == text || !strchr("<>=!", c[-1]))))) {
      Mistake(text, geometry, (int)(c - text), c, CharacterLength(c),
              *c == '=' ? " is no operator (== compares)" : " is not allowed", mistake, size);
      return PETSC_FALSE;
    }
    c += n ? n : 1;
  }
  return PETSC_TRUE;
}

/* Writes the mistake that muParser has found. Its functions share one buffer for texts. */
static void ParserMistake(const char *text, Expression expression, char *mistake, size_t size)
{
  static const char *const ends[] = {" found at ", " at position", " at expression"}; /* muParser's own place */
  char                     wrong[200];

  snprintf(wrong, sizeof wrong, "%s", mupGetErrorMsg(expression->parser));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(ends); k++) {
    char *end = strstr(wrong, ends[k]);

    if (end) *end = 0;
  }
  wrong[0] = (char)tolower((unsigned char)wrong[0]);
  Mistake(text, expression->geometry, PetscMin((int)mupGetErrorPos(expression->parser), (int)strlen(text)), "", 0,
          wrong, mistake, size);
}

/* Lets muParser translate the text. It does so with the first evaluation, here at the origin. */
static PetscBool Parse(const char *text, Expression expression, char *mistake, size_t size)
{
  const PetscReal origin[3] = {0, 0, 0};
  int             values    = 0;

  mupDefineConst(expression->parser, "pi", M_PI);
  for (int v = 0; v < EXPRESSION_VARIABLES; v++)
    mupDefineVar(expression->parser, Variables[v], &expression->variable[v]);
  mupSetExpr(expression->parser, text);
  if (!mupError(expression->parser)) {
    (void)mupEvalMulti(expression->parser, &values);
    if (!mupError(expression->parser)) {
      (void)ExpressionValue(expression, origin, 0);
      if (values == 1) return PETSC_TRUE;
      Mistake(text, expression->geometry, -1, "", 0, "has a comma outside a function (numbers take a point)", mistake,
              size);
      return PETSC_FALSE;
    }
  }
  ParserMistake(text, expression, mistake, size);
  return PETSC_FALSE;
}

/*@
  ExpressionCreate - makes an expression from its text.

  Not collective

  Input Parameters:
+ text     - the text, without control characters
. geometry - of the scene, which decides what r is and which names have a meaning
- size     - room in `mistake`

  Output Parameters:
+ expression - to be freed with ExpressionDestroy(), or NULL if there is a mistake
- mistake    - the text, what is wrong at which of its characters and what is allowed; "" if nothing is wrong
@*/
PetscErrorCode ExpressionCreate(const char *text, Geometry geometry, Expression *expression, char *mistake, size_t size)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(expression));
  (*expression)->geometry = geometry;
  (*expression)->parser   = mupCreate(muBASETYPE_FLOAT);
  mistake[0]              = 0;
  PetscCheck((*expression)->parser, PETSC_COMM_SELF, PETSC_ERR_MEM, "muParser has no memory for a parser");
  if (!NamesAreKnown(text, *expression, mistake, size) || !Parse(text, *expression, mistake, size))
    PetscCall(ExpressionDestroy(expression));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ExpressionDestroy - frees an expression.

  Not collective

  Input Parameter:
. expression - may be NULL; it is NULL afterwards
@*/
PetscErrorCode ExpressionDestroy(Expression *expression)
{
  PetscFunctionBeginUser;
  if (*expression) mupRelease((*expression)->parser);
  PetscCall(PetscFree(*expression));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ExpressionUses - tells whether a variable occurs in an expression.

  Not collective

  Input Parameters:
+ expression - the expression, or NULL, which has no variable
- variable   - the variable
@*/
PetscBool ExpressionUses(Expression expression, ExpressionVariable variable)
{
  return expression ? expression->uses[variable] : PETSC_FALSE;
}

/*@
  ExpressionIsNumber - tells whether no variable occurs in an expression.

  Not collective

  Input Parameter:
. expression - the expression
@*/
PetscBool ExpressionIsNumber(Expression expression)
{
  for (int v = 0; v < EXPRESSION_VARIABLES; v++)
    if (expression->uses[v]) return PETSC_FALSE;
  return PETSC_TRUE;
}

/*@
  ExpressionValue - evaluates an expression at a place and a load parameter.

  Not collective

  Input Parameters:
+ expression - the expression
. X          - reference coordinates (length); the third is 0 in the plane
- t          - load parameter

  Note:
  The value is not finite where the expression has none there.
@*/
PetscReal ExpressionValue(Expression expression, const PetscReal X[3], PetscReal t)
{
  double *v = expression->variable;

  v[EXPRESSION_X] = X[0];
  v[EXPRESSION_Y] = X[1];
  v[EXPRESSION_Z] = X[2];
  v[EXPRESSION_T] = t;
  if (expression->uses[EXPRESSION_R])
    v[EXPRESSION_R] = expression->geometry == GEOMETRY_AXISYMMETRIC ? X[0] : hypot(X[0], X[1]);
  if (expression->uses[EXPRESSION_THETA]) v[EXPRESSION_THETA] = atan2(X[1], X[0]);
  return mupEval(expression->parser);
}
