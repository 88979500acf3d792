#include "scene/motion.h"
#include <math.h>

/* Translation and rotation vector (radians) at t. */
static void MotionAt(const Motion *motion, double t, double shift[3], double turn[3])
{
  for (int d = 0; d < 3; d++) shift[d] = turn[d] = 0;
  for (int m = 0; m < motion->n; m++) {
    const MotionComponent *c     = &motion->components[m];
    const double           value = c->value * HistoryValue(&c->history, t);

    if (c->component < 3)
      shift[c->component] += value;
    else
      turn[c->component - 3] += value * M_PI / 180;
  }
}

/* v = R(turn) V, Rodrigues' formula. */
static void RotatePoint(const double turn[3], const double V[3], double v[3])
{
  const double angle = sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]), s = sin(angle), c = cos(angle);
  double       a[3] = {0, 0, 0}, along = 0;

  for (int d = 0; d < 3 && angle > 0; d++) a[d] = turn[d] / angle;
  for (int d = 0; d < 3; d++) along += a[d] * V[d];
  for (int d = 0; d < 3; d++)
    v[d] = c * V[d] + s * (a[(d + 1) % 3] * V[(d + 2) % 3] - a[(d + 2) % 3] * V[(d + 1) % 3]) + (1 - c) * along * a[d];
}

/* MotionPlace - where the point of the body that was at X is at load parameter t. X, x: lengths, in the coordinates of
 * motion->point. Not collective. */
void MotionPlace(const Motion *motion, double t, const double X[3], double x[3])
{
  double shift[3], turn[3], arm[3], turned[3];

  MotionAt(motion, t, shift, turn);
  for (int d = 0; d < 3; d++) arm[d] = X[d] - motion->point[d];
  RotatePoint(turn, arm, turned);
  for (int d = 0; d < 3; d++) x[d] = X[d] + shift[d] + (turned[d] - arm[d]); /* exactly X where nothing moves */
}

/* MotionTurn - a direction fixed to the body, V at t = 0, at load parameter t. Not collective. */
void MotionTurn(const Motion *motion, double t, const double V[3], double v[3])
{
  double shift[3], turn[3];

  MotionAt(motion, t, shift, turn);
  RotatePoint(turn, V, v);
}
