/* A formula of the scene for a load, a displacement or a length, as a number over place and load parameter.

   ExpressionCreate() reads a text such as "1e7 + 1e6*cos(2*theta)" and says what is wrong with it. ExpressionValue()
   evaluates it. ExpressionUses() tells whether a variable occurs in it.

   The names are x, y and z, the reference coordinates; r and theta, the distance from the axis z and the angle about it
   in radians, within (-pi, pi]; and t, the load parameter. A scene in the plane has no z. In an axisymmetric scene r is
   x, and there is neither z nor theta. ExpressionLanguage[] lists everything else.

   The parser is muParser. It is created with the expression, so a scene without expressions has none. muParser reads
   numbers with a decimal point in every locale and runs on the calling thread. The names of a text are checked before
   muParser sees it, because it has functions and constants that differ between its versions, texts in quotes and
   assignments to variables. */
#pragma once
#include "base/petsccompat.h"
#include "kernels/formulation.h"

/* The longest text of an expression, in characters */
enum { EXPRESSION_LONGEST = 1000 };

typedef enum {
  EXPRESSION_X,
  EXPRESSION_Y,
  EXPRESSION_Z,
  EXPRESSION_R,
  EXPRESSION_THETA,
  EXPRESSION_T,
  EXPRESSION_VARIABLES
} ExpressionVariable;

typedef struct _n_Expression *Expression;

extern const char ExpressionLanguage[];

PetscErrorCode ExpressionCreate(const char *text, Geometry, Expression *, char *mistake, size_t);
PetscErrorCode ExpressionDestroy(Expression *);
PetscBool      ExpressionUses(Expression, ExpressionVariable);
PetscBool      ExpressionIsNumber(Expression);
PetscReal      ExpressionValue(Expression, const PetscReal X[3], PetscReal t);
