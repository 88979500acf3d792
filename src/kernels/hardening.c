/* Laws of isotropic hardening, and of the overstress. */
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
  HardeningMost - returns the largest equivalent stress that slow flow can reach: yield stress and backstresses.

  Not collective

  Input Parameters:
+ h      - the hardening
- strain - equivalent plastic strain, >= 0

  Output Parameter:
. slope - its derivative by the strain (stress)

  Note:
  The backstresses are those of a straight path from no strain.
@*/
double HardeningMost(const Hardening *h, double strain, double *slope)
{
  double work, sum = HardeningStress(h, strain, slope, &work);

  for (int k = 0; k < h->terms; k++) {
    const double C = h->backstress[k][0], gamma = h->backstress[k][1];

    sum += gamma > 0 ? -C / gamma * expm1(-gamma * strain) : C * strain;
    *slope += C * exp(-gamma * strain);
  }
  return sum;
}

/*@
  HardeningOverstress - returns what the rate of the plastic strain adds to the yield stress.

  Not collective

  Input Parameters:
+ h         - the hardening
. increment - of the equivalent plastic strain, >= 0
- dt        - time in which it grew, > 0 if the hardening has an overstress

  Output Parameters:
+ slope - derivative of the overstress by the increment (stress); 0 at an increment of 0
- work  - integral of the overstress over the increment (stress)
@*/
double HardeningOverstress(const Hardening *h, double increment, double dt, double *slope, double *work)
{
  double stress;

  *slope = *work = 0;
  if (h->overstress <= 0 || increment <= 0) return 0;
  stress = h->overstress * pow(increment / (h->speed * dt), 1 / h->power);
  *slope = stress / (h->power * increment);
  *work  = stress * increment / (1 + 1 / h->power);
  return stress;
}

/*@
  HardeningReturn - solves trial - stiffness x = yield stress(strain + x) + overstress(x) for the increment x > 0 of the
  equivalent plastic strain.

  Not collective

  Input Parameters:
+ h         - the hardening
. strain    - equivalent plastic strain before
. dt        - time of the increment
. trial     - equivalent stress of the trial state, above the yield stress
- stiffness - three times the shear modulus (stress)

  Note:
  The left side falls and the right side does not, so there is one solution. It lies between 0 and (trial - yield
  stress) / stiffness. Newton's method, with bisection where it leaves the interval.
@*/
double HardeningReturn(const Hardening *h, double strain, double dt, double trial, double stiffness)
{
  double slope, work, more, low = 0, high = (trial - HardeningStress(h, strain, &slope, &work)) / stiffness;
  double x = high * stiffness / (stiffness + slope);

  for (int i = 0; i < MAX_ITERATIONS; i++) {
    const double over = HardeningOverstress(h, x, dt, &more, &work);
    const double left = trial - stiffness * x - HardeningStress(h, strain + x, &slope, &work) - over;
    double       next;

    slope += more;
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
