/* A frame that turns with a face of the master, and how a vector with fixed components in it varies. */
#include "frictionframe.h"
#include <math.h>
#include <string.h>

static double Dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void Cross(const double a[3], const double b[3], double c[3])
{
  for (int d = 0; d < 3; d++) c[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
}

/* Changes d by what a unit vector u changes where its vector, of the given length, changes by d: (I - u u^T) d/length.
 */
static void Unit(const double u[3], double length, double d[3])
{
  const double along = Dot(u, d);

  for (int i = 0; i < 3; i++) d[i] = (d[i] - along * u[i]) / length;
}

/*@
  FrictionFrameMake - makes the frame of a face at a place.

  Not collective

  Input Parameter:
. tangent - the face's tangents there (length)

  Output Parameter:
. frame - the frame

  Note:
  Returns 0 where the tangents span no plane. Plain C.
@*/
int FrictionFrameMake(const double tangent[2][3], FrictionFrame *frame)
{
  double normal[3];

  memset(frame, 0, sizeof(*frame));
  memcpy(frame->tangent, tangent, sizeof(frame->tangent));
  Cross(tangent[0], tangent[1], normal);
  frame->length = sqrt(Dot(tangent[0], tangent[0]));
  frame->area   = sqrt(Dot(normal, normal));
  if (!(frame->area > 0)) return 0;
  for (int d = 0; d < 3; d++) {
    frame->axis[0][d] = tangent[0][d] / frame->length;
    frame->axis[2][d] = normal[d] / frame->area;
  }
  Cross(frame->axis[2], frame->axis[0], frame->axis[1]);
  return 1;
}

/*@
  FrictionFrameTake - gives the components of a vector in the frame.

  Not collective

  Input Parameters:
+ frame - the frame
- v     - the vector

  Output Parameter:
. component - along t_1, t_2 and n

  Note:
  Plain C.
@*/
void FrictionFrameTake(const FrictionFrame *frame, const double v[3], double component[3])
{
  for (int i = 0; i < 3; i++) component[i] = Dot(frame->axis[i], v);
}

/*@
  FrictionFrameCarry - gives the vector that has these components in the frame.

  Not collective

  Input Parameters:
+ frame     - the frame
- component - along t_1, t_2 and n

  Output Parameter:
. v - the vector

  Note:
  Plain C.
@*/
void FrictionFrameCarry(const FrictionFrame *frame, const double component[3], double v[3])
{
  for (int d = 0; d < 3; d++) {
    v[d] = 0;
    for (int i = 0; i < 3; i++) v[d] += component[i] * frame->axis[i][d];
  }
}

/*@
  FrictionFrameVary - gives the derivatives of a vector with fixed components by the face's tangents.

  Not collective

  Input Parameters:
+ frame     - the frame
- component - along t_1, t_2 and n

  Output Parameter:
. by - by a_1 and a_2

  Note:
  Dt_1 = (I - t_1 t_1^T) Da_1/|a_1|, Dn = (I - n n^T) (Da_1 x a_2 + a_1 x Da_2)/|a_1 x a_2|,
  Dt_2 = Dn x t_1 + n x Dt_1. Plain C.
@*/
void FrictionFrameVary(const FrictionFrame *frame, const double component[3], double by[2][3][3])
{
  const double *t = frame->axis[0], *n = frame->axis[2];

  for (int a = 0; a < 2; a++) {
    for (int j = 0; j < 3; j++) {
      double unit[3] = {j == 0, j == 1, j == 2}, Dt[3] = {0, 0, 0}, Dn[3], turned[3], other[3];

      if (a == 0) {
        memcpy(Dt, unit, sizeof(Dt));
        Unit(t, frame->length, Dt);
        Cross(unit, frame->tangent[1], Dn);
      } else
        Cross(frame->tangent[0], unit, Dn);
      Unit(n, frame->area, Dn);
      Cross(Dn, t, turned);
      Cross(n, Dt, other);
      for (int i = 0; i < 3; i++)
        by[a][i][j] = component[0] * Dt[i] + component[1] * (turned[i] + other[i]) + component[2] * Dn[i];
    }
  }
}
