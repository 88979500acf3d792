/* Laws of isotropic hardening. */
#include "hardening.h"
#include <float.h>
#include <math.h>
#include <stddef.h>

/* Iterations of the scalar equation. Newton's method on a concave curve takes 3 to 8 of them. A table takes one for
   each row that it passes. Bisection alone would take 60. */
enum { MAX_ITERATIONS = HARDENING_MAX_ROWS + 60 };
/* The equation is solved when its residual is below this part of the trial stress: a few units of round-off. */
static const double solved = 4 * DBL_EPSILON;

/* Evaluates a table. */
static double TableStress(const Hardening *h, double strain, double *slope, double *work)
{
  int    k    = 0;
  double area = 0, stress, part;

  while (k < h->rows - 2 && strain > h->table[k + 1][0]) {
    area += (h->table[k + 1][0] - h->table[k][0]) * (h->table[k + 1][1] + h->table[k][1]) / 2;
    k++;
  }
  *slope = h->rows > 1 ? (h->table[k + 1][1] - h->table[k][1]) / (h->table[k + 1][0] - h->table[k][0]) : 0;
  part   = strain - h->table[k][0];
  stress = h->table[k][1] + *slope * part;
  *work  = area + part * (h->table[k][1] + stress) / 2;
  return stress;
}

/*@
  HardeningStress - returns the yield stress.

  Not collective

  Input Parameters:
+ h      - the hardening
- strain - equivalent plastic strain, >= 0

  Output Parameters:
+ slope - derivative of the yield stress (stress)
- work  - integral of the yield stress from 0 to strain (stress): the plastic work per volume
@*/
double HardeningStress(const Hardening *h, double strain, double *slope, double *work)
{
  double stress = h->yield + h->linear * strain;

  if (h->rows) return TableStress(h, strain, slope, work);
  *slope = h->linear;
  *work  = strain * (h->yield + h->linear * strain / 2);
  if (h->rate > 0) {
    const double more = h->saturation - h->yield, gone = -expm1(-h->rate * strain);

    stress += more * gone;
    *slope += more * h->rate * (1 - gone);
    *work += more * (strain - gone / h->rate);
  }
  if (h->strength > 0) {
    const double sum = h->strain + strain, n = h->exponent;
    const double swift = h->strength * pow(sum, n), first = h->strength * pow(h->strain, n);

    stress += swift - first;
    *slope += n * swift / sum;
    *work += (swift * sum - first * h->strain) / (n + 1) - first * strain;
  }
  return stress;
}

/*@
  HardeningReturn - solves trial - stiffness x = yield stress(strain + x) for the increment x > 0 of the equivalent
  plastic strain.

  Not collective

  Input Parameters:
+ h         - the hardening
. strain    - equivalent plastic strain before
. trial     - equivalent stress of the trial state, above the yield stress
- stiffness - three times the shear modulus (stress)

  Note:
  The left side falls and the right side does not, so there is one solution. It lies between 0 and (trial - yield
  stress) / stiffness. Newton's method, with bisection where it leaves the interval.
@*/
double HardeningReturn(const Hardening *h, double strain, double trial, double stiffness)
{
  double slope, work, low = 0, high = (trial - HardeningStress(h, strain, &slope, &work)) / stiffness;
  double x = high * stiffness / (stiffness + slope);

  for (int i = 0; i < MAX_ITERATIONS; i++) {
    const double left = trial - stiffness * x - HardeningStress(h, strain + x, &slope, &work);
    double       next;

    if (fabs(left) <= solved * trial) break;
    if (left > 0)
      low = x;
    else
      high = x;
    next = x + left / (stiffness + slope);
    if (!(next >= low && next <= high)) next = (low + high) / 2;
    if (next == x) break;
    x = next;
  }
  return x;
}
