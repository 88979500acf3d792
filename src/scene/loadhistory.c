/* Factors over the load parameter, and the prescribed motions that are built from them, see loadhistory.h. */
#include "scene/loadhistory.h"
#include <math.h>

/* Returns the interval i with t[i] <= t < t[i + 1]: -1 before the first breakpoint, n - 1 from the last one on. */
static int HistoryInterval(const History *history, double t)
{
  int below = -1, above = history->n; /* t[below] <= t < t[above] */

  while (above - below > 1) {
    const int middle = below + (above - below) / 2;

    if (t >= history->t[middle])
      below = middle;
    else
      above = middle;
  }
  return below;
}

/*@
  HistoryBreaks - tells whether the load parameter t is a breakpoint of a history, at which its slope may change.

  Not collective

  Input Parameters:
+ history - the factor over the load parameter
- t       - load parameter

  Note:
  Plain C. It returns 1 at a breakpoint, else 0. The comparison is exact.
@*/
int HistoryBreaks(const History *history, double t)
{
  const int i = HistoryInterval(history, t);

  return i >= 0 && t == history->t[i];
}

/*@
  HistoryValue - returns the factor of a history at the load parameter t (no unit).

  Not collective

  Input Parameters:
+ history - the factor over the load parameter
- t       - load parameter

  Note:
  Plain C. The factor is linear between the breakpoints, exact at them, and has the end values beyond them.
@*/
double HistoryValue(const History *history, double t)
{
  const int i = HistoryInterval(history, t);

  if (i < 0) return history->v[0];
  if (i == history->n - 1) return history->v[i];
  return history->v[i] + HistorySlope(history, t) * (t - history->t[i]);
}

/*@
  HistoryFactor - returns the factor of a history, or 1 where there is none (no unit).

  Not collective

  Input Parameters:
+ history - the factor over the load parameter, or NULL
- t       - load parameter
@*/
double HistoryFactor(const History *history, double t)
{
  return history ? HistoryValue(history, t) : 1;
}

/*@
  HistorySlope - returns the slope of a history at t, to the right of it (1 over the unit of t).

  Not collective

  Input Parameters:
+ history - the factor
- t       - load parameter, or what else it is over

  Note:
  Plain C. It is 0 beyond the breakpoints.
@*/
double HistorySlope(const History *history, double t)
{
  const int i = HistoryInterval(history, t);

  if (i < 0 || i == history->n - 1) return 0;
  return (history->v[i + 1] - history->v[i]) / (history->t[i + 1] - history->t[i]);
}

/*@
  MotionComponents - gives the translation and the rotation vector of a motion at the load parameter t.

  Not collective

  Input Parameters:
+ motion - of the body
- t      - load parameter

  Output Parameter:
. q - ux, uy, uz (length) and the rotation vector rx, ry, rz (radians)

  Note:
  Free components have the values of MotionSet(); at the load parameter of MotionAccept() those of the accepted state,
  unless the iterate is there too.
@*/
void MotionComponents(const Motion *motion, double t, double q[MOTION_COMPONENTS])
{
  const double          origin[3] = {0, 0, 0};
  const FreeComponents *state     = t == motion->accepted.t && t != motion->now.t ? &motion->accepted : &motion->now;

  for (int c = 0; c < MOTION_COMPONENTS; c++) q[c] = motion->free[c] ? state->value[c] : 0;
  for (int m = 0; m < motion->n; m++) {
    const MotionComponent *c = &motion->components[m];
    const double           value =
      c->expression ? ExpressionValue(c->expression, origin, t) : c->value * HistoryValue(&c->history, t);

    q[c->component] += c->component < 3 ? value : value * M_PI / 180;
  }
}

/* Gives the translation (length) and the rotation vector (radians) at t. */
static void MotionAt(const Motion *motion, double t, double shift[3], double turn[3])
{
  double q[MOTION_COMPONENTS];

  MotionComponents(motion, t, q);
  for (int d = 0; d < 3; d++) {
    shift[d] = q[d];
    turn[d]  = q[3 + d];
  }
}

/*@
  MotionSet - sets the free components of a motion at the iterate.

  Not collective

  Input Parameters:
+ motion - of the body
. t      - load parameter of the iterate
- q      - lengths and radians; only free components are read
@*/
void MotionSet(Motion *motion, double t, const double q[MOTION_COMPONENTS])
{
  motion->now.t = t;
  for (int c = 0; c < MOTION_COMPONENTS; c++) motion->now.value[c] = motion->free[c] ? q[c] : 0;
}

/*@
  MotionAccept - makes values of the free components those of the accepted state, and of the iterate.

  Not collective

  Input Parameters:
+ motion - of the body
. t      - load parameter of the accepted state
- q      - lengths and radians; only free components are read
@*/
void MotionAccept(Motion *motion, double t, const double q[MOTION_COMPONENTS])
{
  MotionSet(motion, t, q);
  motion->accepted = motion->now;
}

/*@
  MotionForce - returns the force (or moment) on a rigid body along a component of its motion at the load parameter t;
in the plane per thickness.

  Not collective

  Input Parameters:
+ motion    - of the body
. t         - load parameter
- component - 0 to 2 for forces, 3 to 5 for moments
@*/
double MotionForce(const Motion *motion, double t, int component)
{
  const double     origin[3] = {0, 0, 0};
  const Expression formula   = motion->force_expression[component];

  const double part = motion->thickness > 0 ? 1 / motion->thickness : 1;

  if (formula) return part * ExpressionValue(formula, origin, t);
  return part * motion->force[component] * (motion->history.n ? HistoryValue(&motion->history, t) : 0);
}

/* Computes v = R(turn) V by Rodrigues' formula. */
static void RotatePoint(const double turn[3], const double V[3], double v[3])
{
  const double angle = sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
  double       a[3], s, c, along = 0;

  for (int d = 0; d < 3; d++) v[d] = V[d];
  if (angle == 0) return;
  s = sin(angle);
  c = cos(angle);
  for (int d = 0; d < 3; d++) a[d] = turn[d] / angle;
  for (int d = 0; d < 3; d++) along += a[d] * V[d];
  for (int d = 0; d < 3; d++)
    v[d] = c * V[d] + s * (a[(d + 1) % 3] * V[(d + 2) % 3] - a[(d + 2) % 3] * V[(d + 1) % 3]) + (1 - c) * along * a[d];
}

/*@
  MotionPlace - gives the place at load parameter t of a point that moves with a rigid body.

  Not collective

  Input Parameters:
+ motion - of the body
. t      - load parameter
- X      - the point's place at t = 0 (length), in the coordinates of motion->point

  Output Parameter:
. x - its place at t (length)

  Note:
  Plain C. Where nothing moves, x is X to the last bit.
@*/
void MotionPlace(const Motion *motion, double t, const double X[3], double x[3])
{
  double shift[3], turn[3], arm[3], turned[3];

  MotionAt(motion, t, shift, turn);
  for (int d = 0; d < 3; d++) arm[d] = X[d] - motion->point[d];
  RotatePoint(turn, arm, turned);
  for (int d = 0; d < 3; d++) x[d] = X[d] + shift[d] + (turned[d] - arm[d]);
}

/*@
  MotionTurn - turns a direction that is fixed to a rigid body to the load parameter t.

  Not collective

  Input Parameters:
+ motion - of the body
. t      - load parameter
- V      - the direction at t = 0

  Output Parameter:
. v - the direction at t, as long as V

  Note:
  Plain C.
@*/
void MotionTurn(const Motion *motion, double t, const double V[3], double v[3])
{
  double shift[3], turn[3];

  MotionAt(motion, t, shift, turn);
  RotatePoint(turn, V, v);
}
