/* Eigenvalues and eigenvectors of symmetric 3 x 3 tensors by Jacobi's method. It is accurate and its vectors are
   orthogonal also where eigenvalues are equal. Source: Golub and Van Loan, "Matrix Computations", section 8.5. */
#include "principal.h"
#include <float.h>
#include <math.h>

/* Sweeps over the three pairs of axes. Convergence is quadratic: 4 to 6 sweeps are enough for every tensor. */
enum { MAX_SWEEPS = 12 };
/* A component off the diagonal that is below this part of the diagonal changes no digit of values and vectors. */
static const double negligible = 1e-18;

/* Entries of a where the mask is set, and of b elsewhere */
LANES_INLINE Lanes Choose(LaneMask mask, Lanes a, Lanes b)
{
  return (Lanes)(((LaneMask)a & mask) | ((LaneMask)b & ~mask));
}

LANES_INLINE Lanes SquareRoot(Lanes a)
{
  Lanes root;

  for (int lane = 0; lane < LANES; lane++) root[lane] = sqrt(a[lane]);
  return root;
}

/* Computes the tangent of the angle that makes component b between axes with values p and q vanish. Returns whether
   some lane needs a rotation. A lane that needs none gets the tangent 0, so that it does not depend on the others. */
LANES_INLINE int Angle(const Lanes *p, const Lanes *q, const Lanes *b, Lanes *t)
{
  const Lanes    h = *q - *p, twice = 2 * *b, none = {0};
  const Lanes    root  = LanesAbsolute(h) + SquareRoot(h * h + twice * twice);
  const LaneMask large = LanesAbsolute(twice) > negligible * (LanesAbsolute(*p) + LanesAbsolute(*q));
  const LaneMask some = large & (root > DBL_MIN), down = h < 0;
  long long      rotates = 0;

  *t = Choose(some, Choose(down, -twice, twice) / Choose(some, root, none + 1), none);
  for (int lane = 0; lane < LANES; lane++) rotates |= some[lane];
  return rotates != 0;
}

/* Rotates axes p and q. b is the component between them, d and e are those with the third axis. */
LANES_INLINE int Rotate(Lanes *p, Lanes *q, Lanes *b, Lanes *d, Lanes *e, Lanes axis_p[3], Lanes axis_q[3])
{
  const Lanes none = {0}, d0 = *d, e0 = *e;
  Lanes       t, c, s;
  LaneMask    turns;

  if (!Angle(p, q, b, &t)) return 0;
  turns = t != 0;
  c     = 1 / SquareRoot(1 + t * t);
  *p    = Choose(turns, *p - t * *b, *p);
  *q    = Choose(turns, *q + t * *b, *q);
  *b    = Choose(turns, none, *b);
  s     = t * c;
  *d    = c * d0 - s * e0;
  *e    = s * d0 + c * e0;
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
