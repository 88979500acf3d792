/* Eigenvalues and eigenvectors of symmetric 3 x 3 tensors by Jacobi's method. It is accurate and its vectors are
   orthogonal also where eigenvalues are equal. Source: Golub and Van Loan, "Matrix Computations", section 8.5. */
#include "principal.h"
#include <float.h>
#include <math.h>

/* Sweeps over the three pairs of axes. Convergence is quadratic: 4 to 6 sweeps are enough for every tensor. */
enum { MAX_SWEEPS = 12 };
/* A component off the diagonal that is below this part of the diagonal changes no digit of values and vectors. */
static const double negligible = 1e-18;

/* Computes the tangent of the angle that makes component b between axes with values p and q vanish. Returns whether
   some lane needs a rotation. A lane that needs none gets the tangent 0, so that it does not depend on the others. */
LANES_INLINE int Angle(const Lanes *p, const Lanes *q, const Lanes *b, Lanes *t)
{
  int rotates = 0;

  for (int lane = 0; lane < LANES; lane++) {
    const double h = (*q)[lane] - (*p)[lane], twice = 2 * (*b)[lane];
    const double root = fabs(h) + sqrt(h * h + twice * twice);
    const int    some = fabs(twice) > negligible * (fabs((*p)[lane]) + fabs((*q)[lane])) && root > DBL_MIN;

    (*t)[lane] = some ? (h < 0 ? -twice : twice) / root : 0;
    rotates |= some;
  }
  return rotates;
}

/* Rotates axes p and q. b is the component between them, d and e are those with the third axis. */
LANES_INLINE int Rotate(Lanes *p, Lanes *q, Lanes *b, Lanes *d, Lanes *e, Lanes axis_p[3], Lanes axis_q[3])
{
  Lanes t, c, s, d0, e0;

  if (!Angle(p, q, b, &t)) return 0;
  for (int lane = 0; lane < LANES; lane++) {
    c[lane] = 1 / sqrt(1 + t[lane] * t[lane]);
    if (t[lane] != 0) {
      (*p)[lane] -= t[lane] * (*b)[lane];
      (*q)[lane] += t[lane] * (*b)[lane];
      (*b)[lane] = 0;
    }
  }
  s  = t * c;
  d0 = *d;
  e0 = *e;
  *d = c * d0 - s * e0;
  *e = s * d0 + c * e0;
  for (int i = 0; i < 3; i++) {
    const Lanes a = axis_p[i];

    axis_p[i] = c * a - s * axis_q[i];
    axis_q[i] = s * a + c * axis_q[i];
  }
  return 1;
}

/*@
  PrincipalAxes - computes eigenvalues and eigenvectors of symmetric tensors.

  Not collective

  Input Parameter:
. tensor - xx yy zz xy yz xz

  Output Parameters:
+ value - the eigenvalues, in no order
- axis  - axis[a] is the unit vector of value[a]
@*/
void PrincipalAxes(const Lanes tensor[6], Lanes value[3], Lanes axis[3][3])
{
  Lanes xy = tensor[3], yz = tensor[4], xz = tensor[5];
  int   rotated = 1;

  for (int a = 0; a < 3; a++) {
    value[a] = tensor[a];
    for (int i = 0; i < 3; i++) axis[a][i] = (Lanes){0} + (double)(a == i);
  }
  for (int sweep = 0; rotated && sweep < MAX_SWEEPS; sweep++) {
    rotated = Rotate(&value[0], &value[1], &xy, &xz, &yz, axis[0], axis[1]);
    rotated |= Rotate(&value[0], &value[2], &xz, &xy, &yz, axis[0], axis[2]);
    rotated |= Rotate(&value[1], &value[2], &yz, &xy, &xz, axis[1], axis[2]);
  }
}
