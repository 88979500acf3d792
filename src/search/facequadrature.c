/* Quadrature rules of faces, hat functions, and areas of quadrature points. */
#include <math.h>
#include <string.h>
#include "search/facequadrature.h"

/* A point lies on an edge if twice the area of the triangle between them, in reference coordinates, is below this. It
   is the rounding of points and nodes, which are of size 1. */
#define ON_EDGE 1e-12

/* Points in each direction of a face with ends: their square is FACE_RULE_POINTS. Degree 5 is that of 3 points of
   Gauss' rule. */
enum { ENDS_LINE = 4 };

static FaceRule rules[FACE_RULES][ELEMENT_TYPES], ends[FACE_RULES][ELEMENT_TYPES];

/* Points and weights on [-1, 1]. */
typedef struct {
  double x[6], w[6];
} LineRule;

// clang-format off
/* Gauss' rules, indexed by the number of points */
static const LineRule gauss[6] = {
  [2] = {{-0.57735026918962576451, 0.57735026918962576451},
         {1, 1}},
  [3] = {{-0.77459666924148337704, 0, 0.77459666924148337704},
         {5. / 9, 8. / 9, 5. / 9}},
  [4] = {{-0.86113631159405257522, -0.33998104358485626480, 0.33998104358485626480, 0.86113631159405257522},
         {0.34785484513745385737, 0.65214515486254614263, 0.65214515486254614263, 0.34785484513745385737}},
  [5] = {{-0.90617984593866399280, -0.53846931010568309104, 0, 0.53846931010568309104, 0.90617984593866399280},
         {0.23692688505618908751, 0.47862867049936646804, 128. / 225, 0.47862867049936646804, 0.23692688505618908751}}
};
/* Lobatto's rules, which have both ends among their points: n of them are exact up to degree 2 n - 3. */
static const LineRule lobatto[7] = {
  [3] = {{-1, 0, 1},
         {1. / 3, 4. / 3, 1. / 3}},
  [4] = {{-1, -0.44721359549995793928, 0.44721359549995793928, 1},
         {1. / 6, 5. / 6, 5. / 6, 1. / 6}},
  [5] = {{-1, -0.65465367070797714380, 0, 0.65465367070797714380, 1},
         {0.1, 49. / 90, 32. / 45, 49. / 90, 0.1}},
  [6] = {{-1, -0.76505532392946469285, -0.28523151648064509631, 0.28523151648064509631, 0.76505532392946469285, 1},
         {1. / 15, 0.37847495629784698032, 0.55485837703548635302, 0.55485837703548635302, 0.37847495629784698032,
          1. / 15}}
};
// clang-format on

/* Orbits of symmetric points of a triangle: barycentric coordinates (a, b, 1 - a - b) in all their orders, with
   weights as shares of the area. Degrees 2, 4 and 6 from Dunavant, Int. J. Numer. Meth. Engng. 21 (1985), 1129. */
typedef struct {
  double a, b, weight;
} Orbit;
static const Orbit triangle3[]  = {{1. / 6, 1. / 6, 1. / 3}, {0, 0, 0}};
static const Orbit triangle6[]  = {{0.44594849091596488632, 0.44594849091596488632, 0.22338158967801146570},
                                   {0.09157621350977074346, 0.09157621350977074346, 0.10995174365532186764},
                                   {0, 0, 0}};
static const Orbit triangle12[] = {{0.24928674517091042129, 0.24928674517091042129, 0.11678627572637936603},
                                   {0.06308901449150222834, 0.06308901449150222834, 0.05084490637020681692},
                                   {0.05314504984481694735, 0.31035245103378440542, 0.08285107561837357519},
                                   {0, 0, 0}};
/* With the corners and two points on each edge, degree 5: the points of Cohen, Joly, Roberts and Tordjman, SIAM J.
   Numer. Anal. 38 (2001), 2047; figures from the five moments that they leave. */
static const Orbit triangle_ends[] = {{0, 0, 0.01487291302482058169},
                                      {0.29346955590904019039, 0.70653044409095980961, 0.04884168123405100656},
                                      {0.20734517566359092426, 0.20734517566359092426, 0.22077705784041073852},
                                      {0, 0, 0}};

static void AddPoint(FaceRule *rule, double x, double y, double weight)
{
  rule->xi[rule->n][0]    = x;
  rule->xi[rule->n][1]    = y;
  rule->weight[rule->n++] = weight;
}

/* Adds the points of a list of orbits, which ends with weight 0. */
static void AddOrbits(FaceRule *rule, const Orbit *orbit)
{
  for (; orbit->weight > 0; orbit++) {
    const double l[3] = {orbit->a, orbit->b, 1 - orbit->a - orbit->b}, w = 0.5 * orbit->weight;

    for (int i = 0; i < 3; i++) {
      AddPoint(rule, l[i], l[(i + 1) % 3], w);
      if (orbit->a != orbit->b) AddPoint(rule, l[(i + 1) % 3], l[i], w);
    }
  }
}

/* Adds the n points of a line's rule in each direction of a face that is not a triangle, or on each of some equal parts
   of an edge. A point at which two parts meet is one point. */
static void AddLines(int dim, const LineRule *line, int n, int parts, FaceRule *rule)
{
  for (int part = 0; part < parts; part++) {
    const int meet = part > 0 && line->x[0] == -1;

    if (meet) rule->weight[rule->n - 1] += line->w[0] / parts;
    for (int j = 0; j < (dim > 1 ? n : 1); j++)
      for (int i = meet; i < n; i++)
        AddPoint(rule, (line->x[i] + 2 * part + 1 - parts) / parts, dim > 1 ? line->x[j] : 0,
                 line->w[i] / parts * (dim > 1 ? line->w[j] : 1));
  }
}

/* Does a point lie on an edge of a face, in 2D at an end? The tables' points do, or are far from it. */
static int OnEdge(const Element *e, const double *xi, int edge)
{
  const double *a = e->node[e->dim == 1 ? edge : e->edge_corners[edge][0]], *b;

  if (e->dim == 1) return xi[0] == a[0];
  b = e->node[e->edge_corners[edge][1]];
  return fabs((b[0] - a[0]) * (xi[1] - a[1]) - (b[1] - a[1]) * (xi[0] - a[0])) < ON_EDGE;
}

/* Completes the points of a rule with shape functions, derivatives, hat functions and the edges on which they lie. */
static void Tabulate(const Element *e, FaceRule *rule)
{
  for (int q = 0; q < rule->n; q++) {
    double dN[FACE_MAX_NODES * 2];

    ElementShape(e->type, rule->xi[q], rule->N[q], dN, NULL);
    for (int a = 0; a < e->nodes; a++)
      for (int k = 0; k < e->dim; k++) rule->dN[q][a][k] = dN[a * e->dim + k];
    FaceHat(e->type, rule->xi[q], rule->hat[q]);
    for (int edge = 0; edge < (e->dim == 1 ? 2 : e->edges); edge++)
      rule->edges[q] |= OnEdge(e, rule->xi[q], edge) << edge;
  }
}

/* Makes the points of a rule. Edges have one more point, because points cost little there and the additional one leaves
   a third of the noise of curved second-order edges. */
static void MakeRule(const Element *e, int finer, FaceRule *rule)
{
  const int more = e->dim > 1 && e->order == 1 && finer == FACE_RULE_FINEST;
  const int n    = e->order + 1 + (finer > FACE_RULE_PLAIN) + more + (e->dim == 1);

  if (e->corners == 3)
    AddOrbits(rule, n == 2 ? triangle3 : n == 3 ? triangle6 : triangle12);
  else
    AddLines(e->dim, &gauss[n], n, e->dim == 1 && finer == FACE_RULE_FINEST ? 2 : 1, rule);
  Tabulate(e, rule);
}

/* Makes the points of a rule with ends: on lines as exact as the other one, with one point more, but on faces no more
   than have room. */
static void MakeRuleWithEnds(const Element *e, int finer, FaceRule *rule)
{
  const int n = e->order + 2 + (finer > FACE_RULE_PLAIN) + (e->dim == 1), most = e->dim == 1 ? n : ENDS_LINE;

  if (e->corners == 3)
    AddOrbits(rule, triangle_ends);
  else
    AddLines(e->dim, &lobatto[n < most ? n : most], n < most ? n : most,
             e->dim == 1 && finer == FACE_RULE_FINEST ? 2 : 1, rule);
  Tabulate(e, rule);
}

/*@
  FaceRuleGet - returns the quadrature rule of a type of face, which is tabulated on first use.

  Not collective

  Input Parameters:
+ type  - of the face
- finer - FACE_RULE_PLAIN; FACE_RULE_FINER: of one order more; FACE_RULE_FINEST: this one on each half of an edge, and
          of one order more still on other first-order faces

  Note:
  Number of points, plain | finer | finest: EDGE2 3 | 4 | 8, EDGE3 4 | 5 | 10, TRI3 3 | 6 | 12, TRI6 6 | 12 | 12,
  QUAD4 4 | 9 | 16, QUAD9 9 | 16 | 16. Plain C.
@*/
const FaceRule *FaceRuleGet(ElementType type, int finer)
{
  FaceRule *rule = &rules[finer][type];

  if (!rule->n) MakeRule(ElementGet(type), finer, rule);
  return rule;
}

/*@
  FaceRuleWithEnds - returns the quadrature rule of a type of face whose outer points lie on its edges and corners, in
  2D at its ends. It is tabulated on first use.

  Not collective

  Input Parameters:
+ type  - of the face
- finer - as for FaceRuleGet()

  Note:
  All weights are positive. Number of points, plain | finer | finest: EDGE2 4 | 5 | 9, EDGE3 5 | 6 | 11, triangles 12,
  QUAD4 9 | 16 | 16, QUAD9 16. Plain C.
@*/
const FaceRule *FaceRuleWithEnds(ElementType type, int finer)
{
  FaceRule *rule = &ends[finer][type];

  if (!rule->n) MakeRuleWithEnds(ElementGet(type), finer, rule);
  return rule;
}

/*@
  FaceRuleOf - returns the quadrature rule of a face of a slave.

  Not collective

  Input Parameters:
+ type  - of the face
. finer - as for FaceRuleGet()
- ends  - bit e: the surface ends at edge e of the face, see surfaceends.h; 0: nowhere

  Note:
  Plain C.
@*/
const FaceRule *FaceRuleOf(ElementType type, int finer, int ends)
{
  return ends ? FaceRuleWithEnds(type, finer) : FaceRuleGet(type, finer);
}

/* Hat functions of a 6-node triangle, which is split into four small triangles by the barycentric coordinates l.
   Node 3 + i is the middle of corners i and i + 1. */
static void HatTriangle(const double l[3], double *psi)
{
  for (int i = 0; i < 3; i++) {
    if (l[i] < 0.5) continue;
    psi[i]               = 2 * l[i] - 1;
    psi[3 + i]           = 2 * l[(i + 1) % 3];
    psi[3 + (i + 2) % 3] = 2 * l[(i + 2) % 3];
    return;
  }
  for (int i = 0; i < 3; i++) psi[3 + i] = 1 - 2 * l[(i + 2) % 3];
}

/*@
  FaceHat - evaluates the positive weighting functions of a face's nodes, whose sum is 1.

  Not collective

  Input Parameters:
+ type - of the face
- xi   - reference coordinates

  Output Parameter:
. psi - the functions, psi[nodes]

  Note:
  First order: the shape functions. Second order: linear on the face, which is split at its mid-side nodes. So every
  node has area on every element; with second-order shape functions the corners of triangles would have none. Plain C.
@*/
void FaceHat(ElementType type, const double *xi, double *psi)
{
  const Element *e = ElementGet(type);

  if (e->order == 1) {
    ElementShape(type, xi, psi, NULL, NULL);
    return;
  }
  memset(psi, 0, e->nodes * sizeof(double));
  if (e->corners == 3 && e->dim == 2) {
    const double l[3] = {1 - xi[0] - xi[1], xi[0], xi[1]};

    HatTriangle(l, psi);
    return;
  }
  for (int a = 0; a < e->nodes; a++) { /* nodes are at -1, 0, 1: the distance between them is 1 */
    psi[a] = 1;
    for (int k = 0; k < e->dim; k++) psi[a] *= fmax(0, 1 - fabs(xi[k] - e->node[a][k]));
  }
}

/* Value at xi of the polynomial that is 1 at one quadrature point of an element of second order and 0 at its others: on
   three points of Gauss' rule in each direction, or on the three points of a triangle. */
static double PointPolynomial(const Element *e, int point, const double *xi)
{
  const double a     = sqrt(0.6);
  double       value = 1;

  if (e->corners == 3 && e->dim == 2) {
    const double at[3] = {1 - e->point[point][0] - e->point[point][1], e->point[point][0], e->point[point][1]};
    const double l[3]  = {1 - xi[0] - xi[1], xi[0], xi[1]};

    for (int i = 0; i < 3; i++)
      if (at[i] > 0.5) value = 2 * l[i] - 1. / 3;
    return value;
  }
  for (int k = 0; k < e->dim; k++) {
    const double x = xi[k] / a, side = round(e->point[point][k]);

    value *= side == 0 ? 1 - x * x : 0.5 * x * (x + side);
  }
  return value;
}

/*@
  FaceHatAround - gives the values at one of the element's quadrature points that stand for the hat functions there.

  Not collective

  Input Parameters:
+ type  - of the face
. point - number of the point in ElementGetFace()
- finer - of contact's rule, see FaceRuleGet()

  Output Parameter:
. psi - the values, psi[nodes]; their sum is 1

  Note:
  Hat functions of second-order faces have edges, for which the element's rule is not made. With these values it gives
  the integrals of the hats, and of their products with shape functions (in triangles: with linear functions), that the
  rule of contact gives. Some values are a little below 0. First order: the hat functions at the point. Plain C.
@*/
void FaceHatAround(ElementType type, int point, int finer, double *psi)
{
  const Element  *e    = ElementGetFace(type);
  const FaceRule *rule = FaceRuleGet(type, finer);

  if (e->order == 1) {
    FaceHat(type, e->point[point], psi);
    return;
  }
  memset(psi, 0, e->nodes * sizeof(double));
  for (int q = 0; q < rule->n; q++) {
    const double share = rule->weight[q] / e->weight[point] * PointPolynomial(e, point, rule->xi[q]);

    for (int a = 0; a < e->nodes; a++) psi[a] += share * rule->hat[q][a];
  }
}

/* FaceRuleAreas() for one dimension, which is a constant where this is called. */
static inline void RuleAreas(const int dim, const FaceRule *rule, int nodes, int axisymmetric, const double *X,
                             double *area, double *normal)
{
  const double two_pi = 6.28318530717958647693;

  for (int q = 0; q < rule->n; q++) {
    double t[2][3] = {{0}}, n[3], radius = 0, length;

    for (int a = 0; a < nodes; a++) {
      for (int k = 0; k < dim - 1; k++)
        for (int d = 0; d < dim; d++) t[k][d] += rule->dN[q][a][k] * X[a * dim + d];
    }
    for (int a = 0; a < nodes && axisymmetric; a++) radius += rule->N[q][a] * X[a * dim];
    if (dim == 2) {
      n[0] = t[0][1];
      n[1] = -t[0][0];
      n[2] = 0;
    } else {
      for (int d = 0; d < 3; d++) n[d] = t[0][(d + 1) % 3] * t[1][(d + 2) % 3] - t[0][(d + 2) % 3] * t[1][(d + 1) % 3];
    }
    length  = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    area[q] = rule->weight[q] * length * (axisymmetric ? two_pi * radius : 1);
    for (int d = 0; d < 3 && normal; d++) normal[3 * q + d] = length > 0 ? n[d] / length : 0;
  }
}

/*@
  FaceRuleAreas - computes the part of a face's area that each point of a rule represents, and the normals there.

  Not collective

  Input Parameters:
+ rule     - of FaceRuleGet()
. type     - of the face
. dim      - 2 or 3
. geometry - axisymmetric areas are multiplied by 2 pi R, over 360 degrees
- X        - reference or current coordinates of the nodes, X[nodes][dim]

  Output Parameters:
+ area   - area[n] of the rule's n points
- normal - normal[n][3], unit, out of the body; may be NULL

  Note:
  Plain C.
@*/
void FaceRuleAreas(const FaceRule *rule, ElementType type, int dim, Geometry geometry, const double *X, double *area,
                   double *normal)
{
  const int nodes = ElementGet(type)->nodes, axisymmetric = geometry == GEOMETRY_AXISYMMETRIC;

  if (dim == 3)
    RuleAreas(3, rule, nodes, axisymmetric, X, area, normal);
  else
    RuleAreas(2, rule, nodes, axisymmetric, X, area, normal);
}
