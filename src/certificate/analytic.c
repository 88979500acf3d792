/* Analytic tools: points of the slave that pass them, and tools that pass between the points, see analytic.h. */
#include "analytic.h"
#include <math.h>
#include <string.h>

/* Part of a face's size up to which the shape of a tool that is as narrow as the face explains that it stands in the
   face between nodes. */
#define TOOL_SAGITTA 0.25

/* Position from a tool's centre, or at right angles from its axis, at one of the states. */
static void FromTool(const AnalyticTool *tool, const Place x, int state, Place r)
{
  const double *axis = tool->axis[state];
  double        along;

  for (int d = 0; d < 3; d++) r[d] = x[d] - tool->point[state][d];
  if (tool->surface.shape != ANALYTIC_CYLINDER) return;
  along = Dot(r, axis) / Dot(axis, axis);
  for (int d = 0; d < 3; d++) r[d] -= along * axis[d];
  if (tool->dim == 2) r[2] = 0;
}

/* Gap of a position that FromTool() has given. */
static double GapOf(const AnalyticTool *tool, const Place r, int state)
{
  const double *axis = tool->axis[state];

  if (tool->surface.shape == ANALYTIC_PLANE) return Dot(r, axis) / sqrt(Dot(axis, axis));
  return (tool->surface.inside ? -1 : 1) * (sqrt(Dot(r, r)) - tool->surface.radius);
}

static void Note(FindingKind kind, double depth, double allowed, double over_h, const Point *point, Finding *worst)
{
  const double most = fmax(over_h, worst->over_h);
  Finding      finding;

  finding = (Finding){.kind    = depth > allowed ? kind : FINDING_NONE,
                      .ratio   = depth / allowed,
                      .depth   = depth,
                      .allowed = allowed,
                      .tag     = {point->tag, 0},
                      .X       = {point->X[0], point->X[1], point->X[2]}};
  if (FindingWorse(&finding, worst)) *worst = finding;
  worst->over_h = most;
}

/*@
  AnalyticPointFinding - judges a point of the slave: its depth in the tool at the end, and whether it has passed
  through a cylinder or a sphere.

  Not collective

  Input Parameters:
+ tool  - the tool
- point - the point

  Input/Output Parameter:
. worst - the worst finding so far

  Note:
  A straight motion past a round tool cuts a corner. The point has passed through it where it came in and went out on
  opposite sides: nearer to the centre than the radius times the cosine of half the angle between their normals. Where
  the tool presses nowhere at either state, it has also where it was deeper than it may stand.
@*/
void AnalyticPointFinding(const AnalyticTool *tool, const Point *point, Finding *worst)
{
  const double tip     = point->closed ? 0.5 * point->order * point->side * point->tip : 0;
  const double allowed = tool->penetration * point->size + tool->overlap + tip;
  Place        r[2], closest, at;
  double       start, end, least;
  int          opposite, leapt;

  for (int state = 0; state < 2; state++) FromTool(tool, point->x[state], state, r[state]);
  start = GapOf(tool, r[0], 0);
  end   = GapOf(tool, r[1], 1);
  if (end < 0) Note(FINDING_DEPTH, -end, allowed, fmax(0, -end - tool->overlap) / point->size, point, worst);
  if (tool->surface.shape == ANALYTIC_PLANE || tool->surface.inside || -end > allowed) return;
  (void)PieceClosest(2, (const Place *)r, (const Place){0, 0, 0}, closest);
  memcpy(at, closest, sizeof(at));
  least    = GapOf(tool, at, 1);
  opposite = least + tool->surface.radius <= sqrt((1 + STAND_OPPOSED) / 2) * tool->surface.radius;
  leapt    = tool->apart && start >= 0 && end >= 0 && -least > allowed + ArcDepth(point);
  if ((opposite && -least > allowed) || leapt) Note(FINDING_PASSED, -least, allowed, 0, point, worst);
}

/*@
  AnalyticPieceFinding - judges a piece of the slave between its vertices: how deep a cylinder or a sphere stands in it,
  and whether the middle of the tool has passed it.

  Not collective

  Input Parameters:
+ tool  - the tool
- piece - the piece

  Input/Output Parameter:
. worst - the worst finding so far

  Note:
  Where vertices touch the tool, it stands in the piece by R - sqrt(R^2 - l^2/4), with the longest side l. Its shape
  explains this much, up to a quarter of the face: a narrower tool would not be seen by the vertices.
@*/
void AnalyticPieceFinding(const AnalyticTool *tool, const Piece *piece, Finding *worst)
{
  static const Place centre = {0, 0, 0};
  const double       radius = tool->surface.radius, own = tool->penetration * piece->size;
  Place              x[2][3], foot;
  Point              point = {.tag = piece->tag[0]};
  Crossing           crossing[SWEEP_MAX];
  double             side2 = 0, explained, depth;
  int                n;

  if (tool->surface.shape == ANALYTIC_PLANE || tool->surface.inside) return;
  memcpy(point.X, piece->X[0], sizeof(Place));
  for (int state = 0; state < 2; state++)
    for (int a = 0; a < tool->dim; a++) FromTool(tool, piece->x[state][a], state, x[state][a]);
  for (int a = 0; a < tool->dim; a++) {
    double t[3];

    for (int d = 0; d < 3; d++) t[d] = x[1][(a + 1) % tool->dim][d] - x[1][a][d];
    side2 = fmax(side2, Dot(t, t));
  }
  (void)PieceClosest(tool->dim, (const Place *)x[1], centre, foot);
  depth     = radius - sqrt(Dot(foot, foot));
  explained = radius - sqrt(fmax(0, radius * radius - side2 / 4));
  explained = fmin(explained, TOOL_SAGITTA * piece->size) + tool->overlap;
  if (depth > STAND_ROUND_OFF * piece->size && PieceFront(tool->dim, (const Place *)x[1], centre) > 0)
    Note(FINDING_DEPTH, depth, own + explained, fmax(0, depth - explained) / piece->size, &point, worst);
  if (tool->surface.shape == ANALYTIC_CYLINDER && tool->dim == 3) return; /* its points pass the tool then */
  n = SweepPoint(tool->dim, (const Place *)x[0], (const Place *)x[1], centre, centre, crossing);
  for (int k = 0; k < n; k++)
    if (crossing[k].inward) Note(FINDING_PASSED, 2 * radius, STAND_ROUND_OFF * piece->size, 0, &point, worst);
}
