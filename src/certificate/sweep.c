/* Crossings of points, edges and pieces of faces along straight motions, see sweep.h. */
#include "certificate/sweep.h"
#include "base/vectors.h"
#include <math.h>
#include <string.h>

/* Halvings of an interval with one root of a polynomial: to the last bit. */
enum { SWEEP_HALVINGS = 60 };

/*@
  PieceDivide - divides a face into pieces with the same orientation.

  Not collective

  Input Parameter:
. type - of the face

  Output Parameter:
. node - nodes of each piece, by their numbers in the face; two of them for edges

  Note:
  It returns the number of pieces.
@*/
int PieceDivide(ElementType type, int node[PIECE_MAX][3])
{
  static const int pieces[ELEMENT_TYPES]              = {[ELEMENT_EDGE2] = 1, [ELEMENT_EDGE3] = 2, [ELEMENT_TRI3] = 1,
                                                         [ELEMENT_TRI6] = 4,  [ELEMENT_QUAD4] = 2, [ELEMENT_QUAD9] = 8};
  static const int nodes[ELEMENT_TYPES][PIECE_MAX][3] = {
    [ELEMENT_EDGE2] = {{0, 1}},
    [ELEMENT_EDGE3] = {{0, 2}, {2, 1}},
    [ELEMENT_TRI3]  = {{0, 1, 2}},
    [ELEMENT_TRI6]  = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}},
    [ELEMENT_QUAD4] = {{0, 1, 2}, {0, 2, 3}},
    [ELEMENT_QUAD9] = {{0, 4, 8}, {4, 1, 8}, {1, 5, 8}, {5, 2, 8}, {2, 6, 8}, {6, 3, 8}, {3, 7, 8}, {7, 0, 8}}};

  memcpy(node, nodes[type], sizeof(nodes[type]));
  return pieces[type];
}

/* Normal of a piece with its length in 2D, or twice its area, as length. */
static void RawNormal(int dim, const Place x[], double normal[3])
{
  double a[3], b[3];

  Minus(x[1], x[0], a);
  if (dim == 2) {
    normal[0] = a[1];
    normal[1] = -a[0];
    normal[2] = 0;
    return;
  }
  Minus(x[2], x[0], b);
  Cross(a, b, normal);
}

/*@
  PieceNormal - computes the unit normal of a piece; 0 where the piece has no area.

  Not collective

  Input Parameters:
+ dim - 2 or 3
- x   - its vertices

  Output Parameter:
. normal - the normal
@*/
void PieceNormal(int dim, const Place x[], double normal[3])
{
  double length;

  RawNormal(dim, x, normal);
  length = sqrt(Dot(normal, normal));
  for (int d = 0; d < 3; d++) normal[d] = length > 0 ? normal[d] / length : 0;
}

/*@
  PieceFront - returns how far a place is in front of the plane of a piece (length); negative: behind it.

  Not collective

  Input Parameters:
+ dim - 2 or 3
. x   - vertices of the piece
- p   - the place
@*/
double PieceFront(int dim, const Place x[], const Place p)
{
  double normal[3], r[3];

  PieceNormal(dim, x, normal);
  Minus(p, x[0], r);
  return Dot(normal, r);
}

/*@
  PieceHeight - returns how far the middle of a piece is from the smooth surface that has the normals of its vertices:
  half the mean of n_a.(x_m - x_a) (length, not negative).

  Not collective

  Input Parameters:
+ dim    - 2 or 3
. x      - vertices of the piece
. normal - at the vertices, of any length
- cosine - normals that turn from the piece's by more belong to a sharp edge and do not count
@*/
double PieceHeight(int dim, const Place x[], const Place normal[], double cosine)
{
  double own[3], middle[3] = {0, 0, 0}, height = 0;

  PieceNormal(dim, x, own);
  for (int a = 0; a < dim; a++)
    for (int d = 0; d < 3; d++) middle[d] += x[a][d] / dim;
  for (int a = 0; a < dim; a++) {
    const double length = sqrt(Dot(normal[a], normal[a]));
    double       r[3];

    if (!(Dot(normal[a], own) >= cosine * length) || !(length > 0)) continue;
    Minus(middle, x[a], r);
    height += Dot(normal[a], r) / (2 * length * dim);
  }
  return fabs(height);
}

/*@
  PieceAngle - returns the angle of a triangle at one of its vertices (radians).

  Not collective

  Input Parameters:
+ x - its vertices
- a - number of the vertex
@*/
double PieceAngle(const Place x[], int a)
{
  double p[3], q[3], c[3];

  Minus(x[(a + 1) % 3], x[a], p);
  Minus(x[(a + 2) % 3], x[a], q);
  Cross(p, q, c);
  return atan2(sqrt(Dot(c, c)), Dot(p, q));
}

/*@
  PieceAcross - finds the normal of the surface on the other side of an edge of a triangle.

  Not collective

  Input Parameters:
+ x     - vertices of the triangle
. a     - number of the edge, from vertex a to the next one
. one   - direction of the surface at vertex a: normals around it, weighted by their angles there
- other - at the next one

  Output Parameter:
. across - unit normal: the triangle's own one, reflected at the mean direction along the edge

  Note:
  Where the edge goes straight on at its ends, both flanks have the same angles there, and this is exact on any
  triangles. Where the surface ends at the edge, it is the triangle's own normal.
@*/
void PieceAcross(const Place x[], int a, const double one[3], const double other[3], double across[3])
{
  const double l = sqrt(Dot(one, one)), m = sqrt(Dot(other, other));
  double       normal[3], t[3], mean[3], along, own;

  PieceNormal(3, x, normal);
  Minus(x[(a + 1) % 3], x[a], t);
  for (int d = 0; d < 3; d++) mean[d] = (l > 0 ? one[d] / l : 0) + (m > 0 ? other[d] / m : 0);
  along = Dot(mean, t) / fmax(Dot(t, t), 1e-300);
  for (int d = 0; d < 3; d++) mean[d] -= along * t[d];
  own = Dot(mean, mean);
  own = own > 0 ? Dot(normal, mean) / own : 0;
  for (int d = 0; d < 3; d++) across[d] = own > 0 ? 2 * own * mean[d] - normal[d] : normal[d];
}

/* Where on the line from a to b the foot of p is: 0 at a, 1 at b; NAN where these are one. */
static double Along(const Place a, const Place b, const Place p)
{
  double t[3], r[3];

  Minus(b, a, t);
  Minus(p, a, r);
  return Dot(r, t) / Dot(t, t);
}

/* Closest point of a segment; returns whether it is between the ends. */
static int SegmentClosest(const Place a, const Place b, const Place p, Place closest)
{
  const double along = Along(a, b, p);

  Between(a, b, fmin(1, fmax(0, along)), closest);
  return along > 0 && along < 1;
}

/* Barycentric coordinates of the foot of a place on the plane of a triangle; 0 where it has no area. */
static int Barycentric(const Place x[], const Place p, double lambda[3])
{
  double a[3], b[3], r[3], aa, ab, bb, ra, rb, area2;

  Minus(x[1], x[0], a);
  Minus(x[2], x[0], b);
  Minus(p, x[0], r);
  aa = Dot(a, a), ab = Dot(a, b), bb = Dot(b, b), ra = Dot(r, a), rb = Dot(r, b);
  area2 = aa * bb - ab * ab;
  if (!(area2 > 0)) return 0;
  lambda[1] = (bb * ra - ab * rb) / area2;
  lambda[2] = (aa * rb - ab * ra) / area2;
  lambda[0] = 1 - lambda[1] - lambda[2];
  return 1;
}

/* Is the foot of a place on the line or plane of a piece in it, or SWEEP_BORDER past its border? */
static int OverPiece(int dim, const Place x[], const Place p)
{
  double lambda[3], along;

  if (dim == 3)
    return Barycentric(x, p, lambda) && lambda[0] >= -SWEEP_BORDER && lambda[1] >= -SWEEP_BORDER &&
           lambda[2] >= -SWEEP_BORDER;
  along = Along(x[0], x[1], p);
  return along >= -SWEEP_BORDER && along <= 1 + SWEEP_BORDER;
}

/*@
  PieceClosest - finds the point of a piece that is closest to a place.

  Not collective

  Input Parameters:
+ dim - 2 or 3
. x   - vertices of the piece
- p   - the place

  Output Parameter:
. closest - that point

  Note:
  It returns 1 if the point is inside the piece, 0 if it is on its border.
@*/
int PieceClosest(int dim, const Place x[], const Place p, Place closest)
{
  double lambda[3], least = INFINITY;

  if (dim == 2) return SegmentClosest(x[0], x[1], p, closest);
  if (Barycentric(x, p, lambda) && lambda[0] > 0 && lambda[1] > 0 && lambda[2] > 0) {
    for (int d = 0; d < 3; d++) closest[d] = lambda[0] * x[0][d] + lambda[1] * x[1][d] + lambda[2] * x[2][d];
    return 1;
  }
  for (int e = 0; e < 3; e++) {
    double at[3], r[3];

    (void)SegmentClosest(x[e], x[(e + 1) % 3], p, at);
    Minus(p, at, r);
    if (Dot(r, r) >= least) continue;
    least = Dot(r, r);
    memcpy(closest, at, sizeof(at));
  }
  return 0;
}

/*@
  PieceCarry - takes a place on a piece along with it.

  Not collective

  Input Parameters:
+ dim  - 2 or 3
. from - vertices of the piece
. p    - the place on it
- to   - vertices of the piece elsewhere

  Output Parameter:
. out - where the place has come

  Note:
  It returns 0 where the piece has no extent.
@*/
int PieceCarry(int dim, const Place from[], const Place p, const Place to[], Place out)
{
  double lambda[3] = {0, 0, 0};

  if (dim == 3) {
    if (!Barycentric(from, p, lambda)) return 0;
  } else {
    lambda[1] = Along(from[0], from[1], p);
    lambda[0] = 1 - lambda[1];
    if (isnan(lambda[1])) return 0;
  }
  for (int d = 0; d < 3; d++) {
    out[d] = 0;
    for (int a = 0; a < dim; a++) out[d] += lambda[a] * to[a][d];
  }
  return 1;
}

/*@
  PiecePierce - finds where an edge stands through a piece.

  Not collective

  Input Parameters:
+ dim    - 2 or 3
. x      - vertices of the piece
. normal - its normal
- edge   - the ends of the edge

  Output Parameters:
+ at     - place on the edge, 0 to 1
- inward - 1 where the edge goes from the front of the piece to its back

  Note:
  It returns 0 where it does not.
@*/
int PiecePierce(int dim, const Place x[], const double normal[3], const Place edge[2], double *at, int *inward)
{
  double p[3], r[2][3], from, to;

  for (int i = 0; i < 2; i++) Minus(edge[i], x[0], r[i]);
  from = Dot(normal, r[0]);
  to   = Dot(normal, r[1]);
  if ((from >= 0) == (to >= 0)) return 0;
  *at     = from / (from - to);
  *inward = from >= 0;
  Between(edge[0], edge[1], *at, p);
  return OverPiece(dim, x, p);
}

static double Value(int degree, const double c[], double s)
{
  double value = c[degree];

  for (int k = degree - 1; k >= 0; k--) value = value * s + c[k];
  return value;
}

/* Places where a polynomial of degree 2 or 3 stops growing or falling, between 0 and 1, in ascending order. */
static int Turns(const double c[4], double s[2])
{
  const double a = 3 * c[3], b = 2 * c[2], rest = c[1], square = b * b - 4 * a * rest;
  double       root, q, found[2];
  int          n = 0, kept = 0;

  if (a == 0) {
    if (b != 0) found[n++] = -rest / b;
  } else if (square > 0) {
    root = sqrt(square);
    q    = -0.5 * (b + (b < 0 ? -root : root));
    if (q != 0) found[n++] = rest / q;
    found[n++] = q / a;
    if (n == 2 && found[0] > found[1]) {
      const double swap = found[0];

      found[0] = found[1];
      found[1] = swap;
    }
  }
  for (int k = 0; k < n; k++)
    if (found[k] > 0 && found[k] < 1) s[kept++] = found[k];
  return kept;
}

/* Changes of sign of a polynomial of degree 3 between 0 and 1; 0 counts as positive. */
static int Roots(const double c[4], Crossing roots[SWEEP_MAX])
{
  double turn[4] = {0};
  int    n = Turns(c, &turn[1]), found = 0;

  turn[n + 1] = 1;
  for (int k = 0; k <= n; k++) {
    double    low = turn[k], high = turn[k + 1];
    const int before = Value(3, c, low) >= 0;

    if (before == (Value(3, c, high) >= 0)) continue;
    for (int i = 0; i < SWEEP_HALVINGS && low < high; i++) {
      const double middle = 0.5 * (low + high);

      if ((Value(3, c, middle) >= 0) == before)
        low = middle;
      else
        high = middle;
    }
    roots[found++] = (Crossing){high, before};
  }
  return found;
}

/* Coefficients of the product a(s) x b(s) of vectors that change linearly from 0 to 1, for s^0 to s^2. */
static void CrossOfMoving(const double a0[3], const double a1[3], const double b0[3], const double b1[3],
                          double c[3][3])
{
  double da[3], db[3], x[3], y[3];

  Minus(a1, a0, da);
  Minus(b1, b0, db);
  Cross(a0, b0, c[0]);
  Cross(a0, db, x);
  Cross(da, b0, y);
  for (int d = 0; d < 3; d++) c[1][d] = x[d] + y[d];
  Cross(da, db, c[2]);
}

/* Coefficients of the product of c(s), of degree 2, with r(s), which changes linearly. */
static void DotOfMoving(double c[3][3], const double r0[3], const double r1[3], double poly[4])
{
  double dr[3];

  Minus(r1, r0, dr);
  poly[0] = Dot(c[0], r0);
  poly[1] = Dot(c[1], r0) + Dot(c[0], dr);
  poly[2] = Dot(c[2], r0) + Dot(c[1], dr);
  poly[3] = Dot(c[2], dr);
}

/* Changes of side of a moving point to the plane of a moving piece. */
static int PlaneCrossings(int dim, const Place start[], const Place end[], const Place from, const Place to,
                          Crossing roots[SWEEP_MAX])
{
  static const double axis[3] = {0, 0, 1};
  double              a0[3], a1[3], b0[3], b1[3], r0[3], r1[3], c[3][3], poly[4];

  Minus(start[1], start[0], a0);
  Minus(end[1], end[0], a1);
  if (dim == 3) {
    Minus(start[2], start[0], b0);
    Minus(end[2], end[0], b1);
  } else { /* its product with the tangent is the normal of a segment */
    memcpy(b0, axis, sizeof(b0));
    memcpy(b1, axis, sizeof(b1));
  }
  CrossOfMoving(a0, a1, b0, b1, c);
  Minus(from, start[0], r0);
  Minus(to, end[0], r1);
  DotOfMoving(c, r0, r1, poly);
  return Roots(poly, roots);
}

/*@
  SweepPoint - finds when a moving point crosses a moving piece.

  Not collective

  Input Parameters:
+ dim   - 2 or 3
. start - vertices of the piece at 0
. end   - at 1
. from  - the point at 0
- to    - at 1

  Output Parameter:
. crossing - of SWEEP_MAX, in the order of time

  Notes:
  It returns their number. A point on the plane of the piece counts as in front of it.
  Between the two states the point is behind the plane of the piece where n(s).(p(s) - x(s)) is negative: a polynomial
  of degree 2 in two dimensions and of degree 3 in three.
@*/
int SweepPoint(int dim, const Place start[], const Place end[], const Place from, const Place to, Crossing crossing[])
{
  Crossing  roots[SWEEP_MAX];
  const int n    = PlaneCrossings(dim, start, end, from, to, roots);
  int       kept = 0;

  for (int k = 0; k < n; k++) {
    double x[3][3], p[3];

    for (int a = 0; a < dim; a++) Between(start[a], end[a], roots[k].s, x[a]);
    Between(from, to, roots[k].s, p);
    if (OverPiece(dim, (const double(*)[3])x, p)) crossing[kept++] = roots[k];
  }
  return kept;
}

/* Are two places on the same side of a hinge in their common plane? In two dimensions the hinge is a point. */
static int SameSide(int dim, const Place x[], const Place p)
{
  double hinge[3] = {0, 0, 1}, a[3], b[3], c[3], d[3];

  if (dim == 3) Minus(x[1], x[0], hinge);
  Minus(x[dim - 1], x[0], a);
  Minus(p, x[0], b);
  Cross(hinge, a, c);
  Cross(hinge, b, d);
  return Dot(c, d) > 0;
}

/*@
  SweepHinge - says whether two moving pieces that share a vertex in the plane, an edge in space, have turned through
  each other.

  Not collective

  Input Parameters:
+ dim   - 2 or 3
. start - vertices of the first piece at 0, the shared ones first
. end   - at 1
. from  - the other piece's vertex that is not shared, at 0
- to    - at 1

  Note:
  They are closed where they lie in one plane and on one side of what they share. They have turned through each other
  after an odd number of such times.
@*/
int SweepHinge(int dim, const Place start[], const Place end[], const Place from, const Place to)
{
  Crossing  roots[SWEEP_MAX];
  const int n      = PlaneCrossings(dim, start, end, from, to, roots);
  int       closed = 0;

  for (int k = 0; k < n; k++) {
    double x[3][3], p[3];

    for (int a = 0; a < dim; a++) Between(start[a], end[a], roots[k].s, x[a]);
    Between(from, to, roots[k].s, p);
    closed += SameSide(dim, (const double(*)[3])x, p);
  }
  return closed % 2;
}

/* Closest points of two straight lines: their places on the edges, 0 to 1; 0 for parallel edges. */
static int LinesClosest(const Place a[2], const Place b[2], double at[2])
{
  double u[3], v[3], w[3], uu, uv, vv, uw, vw, area2;

  Minus(a[1], a[0], u);
  Minus(b[1], b[0], v);
  Minus(b[0], a[0], w);
  uu = Dot(u, u), uv = Dot(u, v), vv = Dot(v, v), uw = Dot(u, w), vw = Dot(v, w);
  area2 = uu * vv - uv * uv;
  if (!(area2 > SWEEP_PARALLEL * SWEEP_PARALLEL * uu * vv)) return 0;
  at[0] = (uw * vv - uv * vw) / area2;
  at[1] = (uw * uv - uu * vw) / area2;
  return 1;
}

/*@
  EdgesAcross - finds where two edges are closest, if that is inside both of them.

  Not collective

  Input Parameters:
+ a - ends of the first edge
- b - of the other one

  Output Parameters:
+ at     - the places on both edges, 0 to 1
- normal - unit normal of both

  Note:
  It returns 0 where it is outside of one of them, or where they are parallel.
@*/
int EdgesAcross(const Place a[2], const Place b[2], double at[2], double normal[3])
{
  double u[3], v[3], length;

  if (!LinesClosest(a, b, at)) return 0;
  Minus(a[1], a[0], u);
  Minus(b[1], b[0], v);
  Cross(u, v, normal);
  length = sqrt(Dot(normal, normal));
  for (int d = 0; d < 3; d++) normal[d] /= length;
  return at[0] >= -SWEEP_BORDER && at[0] <= 1 + SWEEP_BORDER && at[1] >= -SWEEP_BORDER && at[1] <= 1 + SWEEP_BORDER;
}

/*@
  SweepEdges - finds whether a moving edge has crossed another one, and how far it is past it at the end.

  Not collective

  Input Parameters:
+ a0 - ends of the first edge at 0
. a1 - at 1
. b0 - ends of the other edge at 0
- b1 - at 1

  Output Parameter:
. end - the edges at 1

  Note:
  It returns the number of crossings. After an odd number the edges are on the other side of each other, and the
  distance is negative. Edges that are parallel at the time do not cross; then their ends cross faces.
@*/
int SweepEdges(const Place a0[2], const Place a1[2], const Place b0[2], const Place b1[2], EdgeEnd *end)
{
  double   u0[3], u1[3], v0[3], v1[3], r0[3], r1[3], c[3][3], normal[3], poly[4];
  Crossing roots[SWEEP_MAX];
  double   at[2];
  int      n, crossed = 0, first = 1;

  Minus(a0[1], a0[0], u0);
  Minus(a1[1], a1[0], u1);
  Minus(b0[1], b0[0], v0);
  Minus(b1[1], b1[0], v1);
  CrossOfMoving(u0, u1, v0, v1, c);
  Minus(b0[0], a0[0], r0);
  Minus(b1[0], a1[0], r1);
  DotOfMoving(c, r0, r1, poly);
  n = Roots(poly, roots);
  for (int k = 0; k < n; k++) {
    double a[2][3], b[2][3];

    for (int i = 0; i < 2; i++) {
      Between(a0[i], a1[i], roots[k].s, a[i]);
      Between(b0[i], b1[i], roots[k].s, b[i]);
    }
    if (!EdgesAcross((const double(*)[3])a, (const double(*)[3])b, at, normal)) continue;
    if (!crossed) first = roots[k].inward ? 1 : -1;
    end->s[crossed] = roots[k].s;
    for (int d = 0; d < 3; d++) end->towards[crossed][d] = roots[k].inward ? normal[d] : -normal[d];
    crossed++;
  }
  if (!crossed) return 0;
  Cross(u1, v1, normal);
  end->distance = first * Dot(normal, r1) / fmax(sqrt(Dot(normal, normal)), 1e-300);
  end->over     = EdgesAcross(a1, b1, at, normal);
  end->place    = end->over ? at[0] : 0;
  return crossed;
}
