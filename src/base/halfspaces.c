/* The point nearest to a given one in the intersection of half-spaces: the dual active-set method. */
#include "base/halfspaces.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A normal whose part outside the span of the active ones is below this, over its length, lies in their span. */
#define HALFSPACES_SPAN 1e-7
/* Changes of the active set, over the number of dimensions. Few are needed; round-off could make the set repeat itself.
 */
#define HALFSPACES_CHANGES 100

/* The active half-spaces. Their normals are the columns of Q R, Q orthonormal and R upper triangular. */
typedef struct {
  int     dim, n, *which;
  double *Q, *R, *multiplier; /* Q[j*dim]: column j; R[i*dim + j] */
} Active;

static double Dot(int n, const double *a, const double *b)
{
  double sum = 0;

  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

/* Splits a normal into its part z outside the span of the active ones and coefficients in Q (into d). Twice, against
   round-off. Returns the length of z. */
static double Split(const Active *a, const double *normal, double *z, double *d)
{
  memcpy(z, normal, a->dim * sizeof(double));
  for (int j = 0; j < a->n; j++) d[j] = 0;
  for (int pass = 0; pass < 2; pass++) {
    for (int j = 0; j < a->n; j++) {
      const double part = Dot(a->dim, &a->Q[j * a->dim], z);

      d[j] += part;
      for (int i = 0; i < a->dim; i++) z[i] -= part * a->Q[j * a->dim + i];
    }
  }
  return sqrt(Dot(a->dim, z, z));
}

static void Append(Active *a, int which, double multiplier, const double *z, double length, const double *d)
{
  for (int j = 0; j < a->n; j++) a->R[j * a->dim + a->n] = d[j];
  a->R[a->n * a->dim + a->n] = length;
  for (int i = 0; i < a->dim; i++) a->Q[a->n * a->dim + i] = z[i] / length;
  a->which[a->n]        = which;
  a->multiplier[a->n++] = multiplier;
}

/* Takes half-space k out and factors the others anew. */
static void Remove(Active *a, int k, const double *normal, double *z, double *d)
{
  const int n = a->n;

  a->n = k;
  for (int j = k + 1; j < n; j++) {
    const double *column = &normal[a->which[j] * a->dim];
    const double  length = Split(a, column, z, d);

    Append(a, a->which[j], a->multiplier[j], z, length, d);
  }
}

/* The half-space that y violates the most, or -1. */
static int MostViolated(int dim, int n, const double *normal, const double *bound, const char *skip, double tolerance,
                        const double *y)
{
  double most = tolerance;
  int    p    = -1;

  for (int i = 0; i < n; i++) {
    const double short_of = skip[i] ? 0 : bound[i] - Dot(dim, &normal[i * dim], y);

    if (!(short_of > most)) continue;
    most = short_of;
    p    = i;
  }
  return p;
}

/* Moves y into half-space p and keeps it in the active ones, of which some may be dropped. Returns 0 where that is
   impossible. d and r have room for dim numbers, z too. */
static int Enter(Active *a, int p, const double *normal, const double *bound, double *y, double *z, double *d,
                 double *r)
{
  const double *own = &normal[p * a->dim], size = sqrt(Dot(a->dim, own, own));
  double        multiplier = 0;

  while (1) {
    const double length = Split(a, own, z, d), slope = length > HALFSPACES_SPAN * size ? length * length : 0;
    double       step = INFINITY, full;
    int          drop = -1;

    for (int i = a->n - 1; i >= 0; i--) {
      r[i] = d[i];
      for (int j = i + 1; j < a->n; j++) r[i] -= a->R[i * a->dim + j] * r[j];
      r[i] /= a->R[i * a->dim + i];
    }
    for (int j = 0; j < a->n; j++) {
      if (!(r[j] > 0) || !(a->multiplier[j] / r[j] < step)) continue;
      step = a->multiplier[j] / r[j];
      drop = j;
    }
    full = slope > 0 ? (bound[p] - Dot(a->dim, own, y)) / slope : INFINITY;
    if (isinf(full) && drop < 0) return 0;
    if (full <= step) {
      step = full;
      drop = -1;
    }
    for (int i = 0; i < a->dim && slope > 0; i++) y[i] += step * z[i];
    for (int j = 0; j < a->n; j++) a->multiplier[j] -= step * r[j];
    multiplier += step;
    if (drop < 0) {
      Append(a, p, multiplier, z, length, d);
      return 1;
    }
    Remove(a, drop, normal, z, d);
  }
}

/*@
  HalfspacesProject - moves a point to the nearest one that lies in all of some half-spaces.

  Not collective

  Input Parameters:
+ dim       - number of dimensions
. n         - number of half-spaces
. normal    - normal[n*dim], of any length
. bound     - bound[n]: y is in half-space i where normal_i . y >= bound_i
- tolerance - by how much normal . y may be short of the bound

  Input/Output Parameter:
. y - the point

  Note:
  Returns how many half-spaces could not be met, because they have no point in common with the others; the result is
  then a point of the others. Source: Goldfarb and Idnani, A numerically stable dual method for solving strictly convex
  quadratic programs, Math. Programming 27 (1983) 1-33. Plain C.
@*/
int HalfspacesProject(int dim, int n, const double *normal, const double *bound, double tolerance, double y[])
{
  double *room  = malloc((2 * (size_t)dim * dim + 4 * (size_t)dim + 1) * sizeof(double));
  int    *which = malloc(((size_t)dim + 1) * sizeof(int)), left_out = 0;
  char   *skip = calloc((size_t)n + 1, 1);
  double *z = room + 2 * dim * dim, *d = z + dim, *r = d + dim;
  Active  a = {.dim = dim, .which = which, .Q = room, .R = room + dim * dim, .multiplier = r + dim};

  for (int change = 0; room && which && skip && change < HALFSPACES_CHANGES * dim; change++) {
    const int p = MostViolated(dim, n, normal, bound, skip, tolerance, y);

    if (p < 0) break;
    if (Enter(&a, p, normal, bound, y, z, d, r)) continue;
    skip[p] = 1;
    left_out++;
  }
  free(skip);
  free(which);
  free(room);
  return left_out;
}
