/* Coulomb's law at one slave node and its derivatives. */
#include "contact/frictionlaw.h"
#include <math.h>
#include <string.h>

typedef double Matrix[3][3];

/* The tangents of a node, and their derivatives by the unit normal and by `along`. */
typedef struct {
  double n[3], t[2][3], length; /* length: of the vector along the normal */
  Matrix by_n[2], by_along[2];
} Tangents;

static double Dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void Cross(const double a[3], const double b[3], double c[3])
{
  for (int d = 0; d < 3; d++) c[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
}

/* m = scale (I - u u^T). */
static void Projector(double scale, const double u[3], Matrix m)
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) m[i][j] = scale * ((i == j) - u[i] * u[j]);
}

static void Product(Matrix a, Matrix b, Matrix c)
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) c[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
}

/* Unit normal and tangents without derivatives. Returns the length of the tangent part of `along`. */
static double MakeTangents(const double normal[3], const double along[3], Tangents *x)
{
  double length, across;

  x->length = sqrt(Dot(normal, normal));
  for (int d = 0; d < 3; d++) x->n[d] = normal[d] / x->length;
  across = Dot(x->n, along);
  for (int d = 0; d < 3; d++) x->t[0][d] = along[d] - across * x->n[d];
  length = sqrt(Dot(x->t[0], x->t[0]));
  for (int d = 0; d < 3; d++) x->t[0][d] /= length;
  Cross(x->n, x->t[0], x->t[1]);
  return length;
}

/* The derivatives of the tangents. With b = P along, Db = P Dalong - (n.along) Dn - n (along.Dn), Dt_1 = (I - t_1
   t_1^T) Db/|b| and Dt_2 = Dn x t_1 + n x Dt_1. */
static void VaryTangents(const double along[3], double length, Tangents *x)
{
  const double across = Dot(x->n, along), *n = x->n, *t = x->t[0];
  Matrix       Q, b, P;

  Projector(1 / length, t, Q);
  Projector(1, n, P);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) b[i][j] = -across * (i == j) - n[i] * along[j];
  Product(Q, b, x->by_n[0]);
  Product(Q, P, x->by_along[0]);
  for (int j = 0; j < 3; j++) {
    double column[3], unit[3] = {j == 0, j == 1, j == 2}, turned[3], other[3];

    for (int i = 0; i < 3; i++) column[i] = x->by_n[0][i][j];
    Cross(n, column, turned);
    Cross(unit, t, other);
    for (int i = 0; i < 3; i++) x->by_n[1][i][j] = turned[i] + other[i];
    for (int i = 0; i < 3; i++) column[i] = x->by_along[0][i][j];
    Cross(n, column, turned);
    for (int i = 0; i < 3; i++) x->by_along[1][i][j] = turned[i];
  }
}

/*@
  FrictionComponents - gives the components of a vector along the tangents of a node.

  Not collective

  Input Parameters:
+ normal - as in FrictionInput
. along  - as in FrictionInput
- v      - the vector

  Output Parameter:
. component - along t_1 and t_2

  Note:
  Plain C.
@*/
void FrictionComponents(const double normal[3], const double along[3], const double v[3], double component[2])
{
  Tangents x;

  MakeTangents(normal, along, &x);
  for (int k = 0; k < 2; k++) component[k] = Dot(x.t[k], v);
}

/* Share of the slip that counts, and its derivative by the gap. */
static double CountedShare(const FrictionInput *in, double *rate)
{
  double depth, way;

  *rate = 0;
  if (!(in->began > 0)) return 1;
  if (!(in->pressure > 0)) return 0;
  depth = in->pressure / in->stiffness;
  way   = in->began + depth;
  *rate = -in->rate / in->stiffness * in->began / (way * way);
  return depth / way;
}

/*@
  FrictionCountedShare - gives the share of its slip that counts at a node: that since the touch.

  Not collective

  Input Parameters:
+ in       - the node; its own pressure does not count
- pressure - force per area

  Note:
  Plain C.
@*/
double FrictionCountedShare(const FrictionInput *in, double pressure)
{
  FrictionInput at = *in;
  double        rate;

  at.pressure = pressure;
  return CountedShare(&at, &rate);
}

/* Elastic slip e of a node that only sticks, with that of its grip, and its derivatives. gripped: the latter. */
static void ElasticSlip(const FrictionInput *in, double e[3], double gripped[3], FrictionTraction *by)
{
  double   rate, share = CountedShare(in, &rate), across, kept[2];
  Tangents x;
  Matrix   by_n, P, turn;

  for (int k = 0; k < 2; k++) kept[k] = in->kept[k] + in->grip[k] / in->stiffness;
  VaryTangents(in->along, MakeTangents(in->normal, in->along, &x), &x);
  across = Dot(x.n, in->slip);
  Projector(1, x.n, P);
  Projector(1 / x.length, x.n, turn);
  for (int i = 0; i < 3; i++) {
    gripped[i]    = (in->grip[0] * x.t[0][i] + in->grip[1] * x.t[1][i]) / in->stiffness;
    e[i]          = kept[0] * x.t[0][i] + kept[1] * x.t[1][i] + in->slip[i] - across * x.n[i];
    by->by_gap[i] = rate * e[i];
    e[i] *= share;
    for (int j = 0; j < 3; j++) {
      by_n[i][j] =
        share * (kept[0] * x.by_n[0][i][j] + kept[1] * x.by_n[1][i][j] - across * (i == j) - x.n[i] * in->slip[j]);
      by->by_along[i][j] = share * (kept[0] * x.by_along[0][i][j] + kept[1] * x.by_along[1][i][j]);
      by->by_slip[i][j]  = share * P[i][j];
    }
  }
  Product(by_n, turn, by->by_normal);
}

/* Takes derivatives of e to those of the traction: m e. */
static void ApplyMatrix(Matrix m, FrictionTraction *by)
{
  FrictionTraction e = *by;

  Product(m, e.by_normal, by->by_normal);
  Product(m, e.by_slip, by->by_slip);
  Product(m, e.by_along, by->by_along);
  for (int i = 0; i < 3; i++) by->by_gap[i] = Dot(m[i], e.by_gap);
}

/* The largest traction that sticks, and its slope over the pressure. Where a linear step holds a node in slip, its
   pressure may be negative and counts with its sign. */
static double Bound(const FrictionInput *in, double *slope)
{
  const double pressure = in->pressure + in->fluid, bound = in->cohesion + in->coefficient * pressure;

  *slope = 0;
  if (!(pressure > 0) && in->state != FRICTION_SLIPS) return 0;
  if (in->limit > 0 && bound >= in->limit) return in->limit;
  *slope = in->coefficient + in->steepness * pressure;
  return bound;
}

/* The bound with which a node that slips resists turns of its slip. Where a linear step pulls at it, that of the
   pressure which is expected at the end counts: without it nothing would hold the node across its slip. */
static double TurningBound(const FrictionInput *in, double bound)
{
  return bound > 0 || in->pressure > 0 ? bound : FrictionBound(in, in->expected);
}

/*@
  FrictionBound - gives the largest traction that sticks at a pressure (force per area).

  Not collective

  Input Parameters:
+ in       - the node; its own pressure does not count, and its coefficient stays
- pressure - force per area; the bound is 0 where it is not positive

  Note:
  Plain C.
@*/
double FrictionBound(const FrictionInput *in, double pressure)
{
  FrictionInput at = *in;
  double        slope;

  at.pressure = pressure;
  at.state    = FRICTION_DECIDES;
  return Bound(&at, &slope);
}

/*@
  FrictionEvaluate - evaluates Coulomb's law at a node.

  Not collective

  Input Parameter:
. in - the node

  Output Parameter:
. out - traction and its derivatives

  Note:
  The derivative by the gap has both parts, that of the pressure and that of beta. Plain C.
@*/
void FrictionEvaluate(const FrictionInput *in, FrictionTraction *out)
{
  double       slope, rate, e[3], gripped[3], rest[3], length, bound = Bound(in, &slope);
  const double share = CountedShare(in, &rate);
  Matrix       m;

  ElasticSlip(in, e, gripped, out);
  length     = sqrt(Dot(e, e));
  out->state = in->state;
  if (in->state == FRICTION_DECIDES) out->state = in->stiffness * length > bound ? FRICTION_SLIPS : FRICTION_STICKS;
  if (!(length > 0)) out->state = FRICTION_STICKS;
  if (out->state == FRICTION_STICKS) {
    memset(m, 0, sizeof(m));
    for (int i = 0; i < 3; i++) m[i][i] = in->stiffness;
    ApplyMatrix(m, out);
    for (int i = 0; i < 3; i++) rest[i] = e[i] - gripped[i];
    for (int i = 0; i < 3; i++) out->traction[i] = in->stiffness * e[i];
    for (int i = 0; i < 3; i++) out->by_stiffness[i] = share * in->stiffness * rest[i]; /* beta falls as that grows */
    out->elastic = sqrt(Dot(rest, rest));
    out->slipped = 0;
    return;
  }
  for (int i = 0; i < 3; i++) e[i] /= length;
  Projector(fmax(0, TurningBound(in, bound)) / length, e, m);
  ApplyMatrix(m, out);
  for (int i = 0; i < 3; i++) {
    rest[i]              = bound / in->stiffness * e[i] - gripped[i];
    out->traction[i]     = bound * e[i];
    out->by_stiffness[i] = -share * Dot(m[i], gripped); /* beta turns nothing, and |t| is the bound */
    out->by_gap[i] -= slope * in->rate * e[i];
  }
  out->elastic = sqrt(Dot(rest, rest));
  out->slipped = length - bound / in->stiffness;
}
