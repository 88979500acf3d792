/* Pressures near the end of a contact zone, see endpressure.h. */
#include "kernels/endpressure.h"
#include "kernels/recovery.h"
#include <math.h>

/* The function, which is about 1, is within some of this part of its largest value: round-off. */
static const double met = 1e-15;
/* Where round-off lets no step rise, so near is enough. */
static const double near = 1e-8;
/* A step counts that raises the function by this part of what its slope promises (Armijo). */
static const double enough = 1e-4;
/* Steps, and halvings of one: moments at the very edge of the region have no pressure that is found in fewer. */
enum { MOST_STEPS = 60, MOST_HALVINGS = 40, MATRIX = ENDPRESSURE_TERMS * (ENDPRESSURE_TERMS + 1) / 2 };

/* A region, with weights over their sum, and the moments that are wanted, over the force */
typedef struct {
  int           terms, points;
  const double *term, *weight;
  double        area, moment[ENDPRESSURE_TERMS];
} Region;

static double Square(const Region *r, const double *a, int point)
{
  double q = 0;

  for (int i = 0; i < r->terms; i++) q += a[i] * r->term[point * r->terms + i];
  return q;
}

/* Adds a point to a matrix: the derivative of its pressure's moments. square: of the pressure. */
static void AddPoint(const Region *r, int point, double square, double *matrix)
{
  double scaled[ENDPRESSURE_TERMS];

  for (int i = 0; i < r->terms; i++)
    scaled[i] = sqrt(r->weight[point] / (2 * r->area * sqrt(square))) * r->term[point * r->terms + i];
  RecoveryAdd(r->terms, scaled, matrix);
}

/* The concave function whose largest value is sought, a . moment - int 2/3 (a . terms)^(3/2); its slope and minus its
   second derivatives where they are wanted. */
static double Value(const Region *r, const double *a, double *slope, double *matrix)
{
  double value = 0;

  for (int i = 0; i < r->terms; i++) value += a[i] * r->moment[i];
  for (int i = 0; i < r->terms && slope; i++) slope[i] = r->moment[i];
  for (int i = 0; i < MATRIX && matrix; i++) matrix[i] = 0;
  for (int k = 0; k < r->points; k++) {
    const double *term = &r->term[k * r->terms], q = Square(r, a, k), weight = r->weight[k] / r->area;
    const double  p = q > 0 ? sqrt(q) : 0;

    if (!(p > 0)) continue;
    value -= weight * 2. / 3 * q * p;
    for (int i = 0; i < r->terms && slope; i++) slope[i] -= weight * p * term[i];
    if (matrix) AddPoint(r, k, q, matrix);
  }
  return value;
}

/* Goes from a along a direction as far as the function rises. promise: slope along it. Returns 0 where it does not. */
static int Step(const Region *r, double promise, const double *direction, double *a)
{
  const double before = Value(r, a, 0, 0);
  double       length = 1;

  for (int halving = 0; halving < MOST_HALVINGS; halving++, length /= 2) {
    double there[ENDPRESSURE_TERMS];

    for (int i = 0; i < r->terms; i++) there[i] = a[i] + length * direction[i];
    if (!(Value(r, there, 0, 0) >= before + enough * length * promise)) continue;
    for (int i = 0; i < r->terms; i++) a[i] = there[i];
    return 1;
  }
  return 0;
}

/* Newton's method from a constant pressure. */
static int Maximise(const Region *r, double *a)
{
  for (int step = 0; step < MOST_STEPS; step++) {
    double slope[ENDPRESSURE_TERMS], direction[ENDPRESSURE_TERMS], matrix[MATRIX], variance, promise = 0;

    Value(r, a, slope, matrix);
    for (int i = 0; i < r->terms; i++) direction[i] = slope[i];
    if (RecoveryFactor(r->terms - 1, 1, matrix, &variance) < 1) return 0;
    RecoverySolve(r->terms, matrix, 1, direction);
    for (int i = 0; i < r->terms; i++) promise += slope[i] * direction[i];
    if (promise <= met || !Step(r, promise, direction, a)) return promise <= near;
  }
  return 0;
}

/* The square below which that of a point does not count for its rate: the mean of one over its root over a square with
   the end of the zone at one side is that of one over the root of this. */
static double Least(int terms, double extent, const double *square)
{
  double slope = 0;

  for (int i = 1; i < terms; i++) slope += square[i] * square[i];
  return extent * sqrt(slope) / 2;
}

/* Finds the rate whose moments are those that are given, over the area. */
static int FindRate(const Region *r, const double *a, double least, double *rate)
{
  double matrix[MATRIX] = {0}, variance;

  for (int k = 0; k < r->points; k++) {
    const double square = Square(r, a, k);

    if (square > 0) AddPoint(r, k, fmax(square, least), matrix);
  }
  if (RecoveryFactor(r->terms - 1, 1, matrix, &variance) < 1) return 0;
  RecoverySolve(r->terms, matrix, 1, rate);
  return 1;
}

/*@
  EndPressureFit - finds the pressure that has a force and moments, and its rate.

  Not collective

  Input Parameters:
+ terms       - 2 or 3: 1 and the coordinates
. points      - number of points of the region
. extent      - half of the side of the square for which a point stands, in the unit of the terms
. term        - at the points [points][terms]
. weight      - areas of the points
. moment      - of the pressures: the integrals of the pressure times the terms
- moment_rate - their rates

  Output Parameter:
. fit - the pressure

  Note:
  Returns 0 where there is no such pressure.
@*/
int EndPressureFit(int terms, int points, double extent, const double *term, const double *weight, const double *moment,
                   const double *moment_rate, EndPressure *fit)
{
  Region r                    = {.terms = terms, .points = points, .term = term, .weight = weight};
  double a[ENDPRESSURE_TERMS] = {1, 0, 0}, mean;

  *fit = (EndPressure){.square = {0}};
  for (int k = 0; k < points; k++) r.area += weight[k];
  if (!(moment[0] > 0) || !(r.area > 0)) return 0;
  mean = moment[0] / r.area;
  for (int i = 0; i < terms; i++) r.moment[i] = moment[i] / moment[0];
  if (!Maximise(&r, a)) return 0;
  for (int i = 0; i < terms; i++) fit->rate[i] = moment_rate[i] / r.area;
  if (!FindRate(&r, a, Least(terms, extent, a), fit->rate)) return 0;
  for (int i = 0; i < terms; i++) {
    fit->square[i] = mean * mean * a[i];
    fit->rate[i] *= mean;
  }
  fit->least = Least(terms, extent, fit->square);
  return 1;
}

/*@
  EndPressureAt - gives the pressure at a place, and its rate.

  Not collective

  Input Parameters:
+ square      - of the pressure as EndPressureFit() has it, of either sign
. square_rate - the rate of it
- least       - that of EndPressureFit()

  Output Parameters:
+ pressure - 0 beyond the end
- rate     - likewise
@*/
void EndPressureAt(double square, double square_rate, double least, double *pressure, double *rate)
{
  *pressure = square > 0 ? sqrt(square) : 0;
  *rate     = square > 0 ? square_rate / (2 * sqrt(fmax(square, least))) : 0;
}
