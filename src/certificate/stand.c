/* Where points stand to the pieces of the other side, see stand.h. */
#include "stand.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Crossings of one point that are followed. More than this are beyond what a step can do; the later ones are left. */
enum { STAND_EVENTS = 64 };

/* A point at one of the states. */
typedef struct {
  const Piece *piece;  /* the closest one; NULL: none near */
  int          inside; /* the point is behind it, and they look at each other */
  int          front;  /* the point is in front of it or beside its end */
  double       depth;
} Stand;

/* The point crosses a piece. */
typedef struct {
  const Piece *piece;
  Crossing     at;
} Event;

static double Dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double Distance(const double a[3], const double b[3])
{
  const double r[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};

  return sqrt(Dot(r, r));
}

static void Between(const double a[3], const double b[3], double s, double c[3])
{
  for (int d = 0; d < 3; d++) c[d] = (1 - s) * a[d] + s * b[d];
}

/*@
  LookCreate - prepares the search of pieces.

  Not collective

  Input Parameters:
+ dim  - 2 or 3
- list - the pieces, which are borrowed

  Input/Output Parameter:
. look - with its settings; free it with LookDestroy(), whatever is returned

  Note:
  It returns 0 where memory is short.
@*/
int LookCreate(int dim, const PieceList *list, Look *look)
{
  double *lower = malloc(sizeof(double) * (size_t)(dim * list->n + 1)),
         *upper = malloc(sizeof(double) * (size_t)(dim * list->n + 1));
  int made      = lower && upper;

  look->dim   = dim;
  look->list  = list;
  look->tree  = NULL;
  look->found = malloc(sizeof(int) * (size_t)(list->n + 1));
  for (int k = 0; made && k < list->n; k++) {
    double box[6];

    PieceBox(&list->pieces[k], dim, box);
    for (int d = 0; d < dim; d++) {
      lower[k * dim + d] = box[d] - 0.5 * list->pieces[k].size;
      upper[k * dim + d] = box[3 + d] + 0.5 * list->pieces[k].size;
    }
  }
  made = made && look->found && !BoxTreeBuild(dim, (int)list->n, lower, upper, &look->tree);
  free(lower);
  free(upper);
  return made;
}

/*@
  LookDestroy - frees the search.

  Not collective

  Input/Output Parameter:
. look - empty on return
@*/
void LookDestroy(Look *look)
{
  BoxTreeDestroy(&look->tree);
  free(look->found);
  look->found = NULL;
}

/* Gathers the pieces near a box. */
static void LookAt(Look *look, const double box[6], double margin)
{
  double middle[3], radius = 0;

  for (int d = 0; d < 3; d++) {
    middle[d] = 0.5 * (box[d] + box[3 + d]);
    radius += 0.25 * (box[3 + d] - box[d]) * (box[3 + d] - box[d]);
  }
  look->n_found = BoxTreeNear(look->tree, middle, sqrt(radius) + margin, (int)look->list->n, look->found);
}

static int HasTag(const Piece *piece, int dim, long tag)
{
  for (int a = 0; a < dim; a++)
    if (piece->tag[a] == tag) return 1;
  return 0;
}

/* Is a piece of the point's own body the wall below the point, or its own neighbourhood? */
static int IsOwnWall(int dim, const Piece *piece, const Point *point, int state, double distance)
{
  double normal[3], at[3];

  if (piece->body != point->body) return 0;
  PieceNormal(dim, (const Place *)piece->x[state], normal);
  if (Dot(normal, point->normal[state]) >= 0) return 1;
  if (PieceFront(dim, (const Place *)piece->X, point->X) >= -STAND_ROUND_OFF * piece->size) return 0;
  (void)PieceClosest(dim, (const Place *)piece->X, point->X, at);
  return distance >= STAND_OWN_WALL * Distance(point->X, at);
}

/* The closest point so far */
typedef struct {
  const Piece *piece;
  int          shared, interior;
  double       distance, foot[3], sum[3];
} Nearest;

static void KeepNearest(int dim, const Piece *piece, int state, const double foot[3], int interior, double distance,
                        Nearest *nearest)
{
  const double tie = STAND_TIE * piece->size;
  double       normal[3];

  if (distance > nearest->distance + tie) return;
  PieceNormal(dim, (const Place *)piece->x[state], normal);
  if (distance > nearest->distance - tie && Distance(foot, nearest->foot) <= tie) {
    nearest->shared++;
    for (int d = 0; d < 3; d++) nearest->sum[d] += normal[d];
    return;
  }
  if (distance >= nearest->distance) return;
  *nearest = (Nearest){piece, 1, interior, distance, {foot[0], foot[1], foot[2]}, {normal[0], normal[1], normal[2]}};
}

/* Finds where a point stands at one of the states. */
static Stand PointStand(const Look *look, const Point *point, int state)
{
  Nearest nearest = {.distance = INFINITY};
  Stand   stand   = {.piece = NULL};
  double  r[3], cosine, length;

  for (int i = 0; i < look->n_found; i++) {
    const Piece *piece = &look->list->pieces[look->found[i]];
    double       foot[3], distance;
    int          interior;

    if (HasTag(piece, look->dim, point->tag)) continue;
    interior = PieceClosest(look->dim, (const Place *)piece->x[state], point->x[state], foot);
    distance = Distance(foot, point->x[state]);
    if (distance > nearest.distance + STAND_TIE * piece->size) continue;
    if (IsOwnWall(look->dim, piece, point, state, distance)) continue;
    KeepNearest(look->dim, piece, state, foot, interior, distance, &nearest);
  }
  if (!nearest.piece) return stand;
  for (int d = 0; d < 3; d++) r[d] = point->x[state][d] - nearest.foot[d];
  length       = sqrt(Dot(nearest.sum, nearest.sum)) * nearest.distance;
  cosine       = length > 0 ? Dot(r, nearest.sum) / length : 1;
  stand.piece  = nearest.piece;
  stand.depth  = nearest.distance;
  stand.front  = cosine > -(nearest.shared > 1 || nearest.interior ? STAND_CORNER : STAND_END);
  stand.inside = !stand.front && Dot(nearest.sum, point->normal[state]) < 0;
  return stand;
}

/* Depth to which a point may stand in a piece, without what geometry and the scene explain. */
static double AllowedDepth(const Look *look, double size, double height, int seen, const Piece *piece)
{
  double allowed = look->penetration * fmin(size, piece->size);

  if (seen || piece->seen) allowed *= STAND_SEEN;
  if (!look->walls) return allowed;
  if (height > 0) allowed = fmin(allowed, STAND_WALL * height);
  if (piece->height > 0) allowed = fmin(allowed, STAND_WALL * piece->height);
  return allowed;
}

/*@
  FindingWorse - tells whether a finding is worse than another one. Findings that are equal up to round-off are told
  apart by tags.

  Not collective

  Input Parameters:
+ finding - the finding
- than    - the other one
@*/
int FindingWorse(const Finding *finding, const Finding *than)
{
  if ((finding->kind != FINDING_NONE) != (than->kind != FINDING_NONE)) return finding->kind != FINDING_NONE;
  if (fabs(finding->ratio - than->ratio) > STAND_ROUND_OFF * than->ratio) return finding->ratio > than->ratio;
  if (finding->tag[0] != than->tag[0]) return finding->tag[0] < than->tag[0];
  return finding->face < than->face;
}

/* Keeps the worse one of two findings, and the largest depth over a face of both. */
static void Keep(const Finding *finding, Finding *worst)
{
  const double over_h = fmax(finding->over_h, worst->over_h);

  if (FindingWorse(finding, worst)) *worst = *finding;
  worst->over_h = over_h;
}

/* Judges the depth of a point, or of a place on an edge, in a piece at the end of the step. */
static void JudgeDepth(const Look *look, const Point *point, const Stand *stand, const long tag[2], Finding *worst)
{
  double  own, explained;
  Finding finding;

  if (!stand->inside || stand->depth <= STAND_ROUND_OFF * stand->piece->size) return;
  own       = AllowedDepth(look, point->size, point->height, point->seen, stand->piece);
  explained = stand->piece->sagitta + look->overlap;
  finding   = (Finding){.ratio   = stand->depth / (own + explained),
                        .depth   = stand->depth,
                        .allowed = own + explained,
                        .over_h  = fmax(0, stand->depth - explained) / fmin(point->size, stand->piece->size),
                        .tag     = {tag[0], tag[1]},
                        .face    = stand->piece->face,
                        .X       = {point->X[0], point->X[1], point->X[2]}};
  if (finding.ratio > 1) finding.kind = FINDING_DEPTH;
  Keep(&finding, worst);
}

static int EarlierEvent(const void *a, const void *b)
{
  const double s = ((const Event *)a)->at.s, t = ((const Event *)b)->at.s;

  return (s > t) - (s < t);
}

/* Finds the crossings of a point, in the order of time. */
static int PointEvents(const Look *look, const Point *point, Event events[STAND_EVENTS])
{
  int n = 0;

  for (int i = 0; i < look->n_found; i++) {
    const Piece *piece = &look->list->pieces[look->found[i]];
    Crossing     crossing[SWEEP_MAX];
    int          times;

    if (HasTag(piece, look->dim, point->tag)) continue;
    times =
      SweepPoint(look->dim, (const Place *)piece->x[0], (const Place *)piece->x[1], point->x[0], point->x[1], crossing);
    for (int k = 0; k < times && n < STAND_EVENTS; k++) events[n++] = (Event){piece, crossing[k]};
  }
  qsort(events, (size_t)n, sizeof(*events), EarlierEvent);
  return n;
}

/* How far a point is behind the plane of a piece at a time of the step. */
static double BehindAt(int dim, const Piece *piece, const Point *point, double s)
{
  double x[3][3], p[3];

  for (int a = 0; a < dim; a++) Between(piece->x[0][a], piece->x[1][a], s, x[a]);
  Between(point->x[0], point->x[1], s, p);
  return -PieceFront(dim, (const Place *)x, p);
}

static double Cosine(int dim, const Piece *a, const Piece *b)
{
  double m[3], n[3];

  PieceNormal(dim, (const Place *)a->x[1], m);
  PieceNormal(dim, (const Place *)b->x[1], n);
  return Dot(m, n);
}

/* Keeps that a point has passed the piece where it came in, if that is the worst. */
static void KeepPassed(const Point *point, const Event *in, double depth, double allowed, Finding *worst)
{
  const Finding finding = {.kind    = FINDING_PASSED,
                           .ratio   = depth / allowed,
                           .depth   = depth,
                           .allowed = allowed,
                           .tag     = {point->tag, 0},
                           .face    = in->piece->face,
                           .X       = {point->X[0], point->X[1], point->X[2]}};

  Keep(&finding, worst);
}

/* Judges a point that was behind one piece and has come out of another one, or stands in it. Where the two are no
   opposite sides of a wall, it is back on the side from which it came: straight motions cut corners. Where contact
   presses, it may pass the tip of a wedge as deep as it may stand in it. */
static void JudgePassage(const Look *look, const Point *point, const Event *in, const Event *out, Finding *worst)
{
  const double depth =
    fmin(BehindAt(look->dim, in->piece, point, out->at.s), BehindAt(look->dim, out->piece, point, in->at.s));
  const int carried = point->closed || in->piece->closed || out->piece->closed;
  double    allowed = STAND_ROUND_OFF * fmin(point->size, fmin(in->piece->size, out->piece->size));

  if (Cosine(look->dim, in->piece, out->piece) > STAND_OPPOSED) return;
  if (carried) allowed = look->penetration * fmin(point->size, fmin(in->piece->size, out->piece->size));
  allowed += look->overlap;
  if (!(depth > allowed)) return;
  KeepPassed(point, in, depth, allowed, worst);
}

/* Judges a point that has crossed a piece and is not found behind any surface at the end. */
static void JudgeGone(const Look *look, const Point *point, const Event *in, const Stand *end, Finding *worst)
{
  const double depth = BehindAt(look->dim, in->piece, point, 1);
  const double allowed =
    AllowedDepth(look, point->size, point->height, point->seen, in->piece) + in->piece->sagitta + look->overlap;
  double foot[3];

  if (!(depth > allowed) || (end->piece && end->front)) return;
  (void)PieceClosest(look->dim, (const Place *)in->piece->x[1], point->x[1], foot);
  if (Distance(foot, point->x[1]) > depth + 0.5 * in->piece->size) return; /* it left past an end */
  KeepPassed(point, in, depth, allowed, worst);
}

/*@
  PointFinding - follows a point along the step and judges what has happened to it.

  Not collective

  Input Parameters:
+ look  - the pieces of the other side
- point - the point

  Input/Output Parameter:
. worst - the worst finding so far

  Notes:
  A point has come in where it crosses a piece to its back, or where it stood behind one at the start. It has come out
  where it crosses a piece to its front, or where it stands behind one on the other side of a wall at the end. In
between it was as deep as it was behind the first piece when it came out, or behind the last one when it came in.
@*/
void PointFinding(Look *look, const Point *point, Finding *worst)
{
  Event  events[STAND_EVENTS], in = {.piece = NULL};
  double box[6];
  Stand  start, end;
  int    n, crossed = 0;

  for (int d = 0; d < 3; d++) {
    box[d]     = fmin(point->x[0][d], point->x[1][d]);
    box[3 + d] = fmax(point->x[0][d], point->x[1][d]);
  }
  LookAt(look, box, 0.5 * point->size);
  if (!look->n_found) return;
  start = PointStand(look, point, 0);
  end   = PointStand(look, point, 1);
  JudgeDepth(look, point, &end, (long[2]){point->tag, 0}, worst);
  n = PointEvents(look, point, events);
  if (start.inside) in = (Event){start.piece, {0, 1}};
  for (int k = 0; k < n; k++) {
    if (events[k].at.inward && !in.piece) {
      in      = events[k];
      crossed = 1;
    } else if (!events[k].at.inward && in.piece) {
      JudgePassage(look, point, &in, &events[k], worst);
      in.piece = NULL;
      crossed  = 0;
    }
  }
  if (in.piece && end.inside && Cosine(look->dim, in.piece, end.piece) <= STAND_OPPOSED)
    JudgePassage(look, point, &in, &(Event){end.piece, {1, 0}}, worst);
  if (in.piece && crossed && !end.inside) JudgeGone(look, point, &in, &end, worst);
}

/* A point on an edge, for its depth. */
static Point EdgePoint(const Piece *piece, const Point *const end[2], double s)
{
  Point point = {.tag    = end[0]->tag,
                 .size   = piece->size,
                 .height = piece->height,
                 .body   = piece->body,
                 .closed = piece->closed,
                 .seen   = piece->seen};

  Between(end[0]->X, end[1]->X, s, point.X);
  for (int state = 0; state < 2; state++) {
    Between(end[0]->x[state], end[1]->x[state], s, point.x[state]);
    for (int d = 0; d < 3; d++) point.normal[state][d] = end[0]->normal[state][d] + end[1]->normal[state][d];
  }
  return point;
}

/* Judges the part of an edge that stands in the other side at the end, between two places where it goes through. */
static void JudgeEdgeDepth(const Look *look, const Piece *piece, const Point *const end[2], Finding *worst)
{
  const Place edge[2] = {{end[0]->x[1][0], end[0]->x[1][1], end[0]->x[1][2]},
                         {end[1]->x[1][0], end[1]->x[1][1], end[1]->x[1][2]}};
  double      in[STAND_EVENTS];
  double      out[STAND_EVENTS];
  int         n_in = 0, n_out = 0;

  for (int i = 0; i < look->n_found; i++) {
    const Piece *other = &look->list->pieces[look->found[i]];
    double       at;
    int          inward;

    if (HasTag(other, look->dim, end[0]->tag) || HasTag(other, look->dim, end[1]->tag)) continue;
    if (!PiecePierce(look->dim, (const Place *)other->x[1], edge, &at, &inward)) continue;
    if (inward && n_in < STAND_EVENTS) in[n_in++] = at;
    if (!inward && n_out < STAND_EVENTS) out[n_out++] = at;
  }
  for (int i = 0; i < n_in; i++) {
    double next = 2;
    Point  middle;
    Stand  stand;

    for (int k = 0; k < n_out; k++)
      if (out[k] > in[i] && out[k] < next) next = out[k];
    if (next > 1) continue;
    middle = EdgePoint(piece, end, 0.5 * (in[i] + next));
    stand  = PointStand(look, &middle, 1);
    JudgeDepth(look, &middle, &stand, (long[2]){end[0]->tag, end[1]->tag}, worst);
  }
}

/* Do the boxes of two edges meet over the step? */
static int EdgesNear(const Point *const a[2], const Place b0[2], const Place b1[2])
{
  for (int d = 0; d < 3; d++) {
    const double low  = fmin(fmin(a[0]->x[0][d], a[1]->x[0][d]), fmin(a[0]->x[1][d], a[1]->x[1][d])),
                 high = fmax(fmax(a[0]->x[0][d], a[1]->x[0][d]), fmax(a[0]->x[1][d], a[1]->x[1][d]));

    if (fmin(fmin(b0[0][d], b0[1][d]), fmin(b1[0][d], b1[1][d])) > high) return 0;
    if (fmax(fmax(b0[0][d], b0[1][d]), fmax(b1[0][d], b1[1][d])) < low) return 0;
  }
  return 1;
}

/* Judges an edge that crosses the edges of another piece. */
static void JudgeEdgeCrossings(const Look *look, const Piece *piece, const Point *const end[2], const Piece *other,
                               Finding *worst)
{
  const double own       = AllowedDepth(look, piece->size, piece->height, piece->seen, other);
  const double explained = other->sagitta + look->overlap;
  Place        a[2][2];

  for (int state = 0; state < 2; state++)
    for (int i = 0; i < 2; i++) memcpy(a[state][i], end[i]->x[state], sizeof(Place));
  for (int e = 0; e < 3; e++) {
    Place   b[2][2];
    EdgeEnd last;
    Finding finding;

    for (int state = 0; state < 2; state++)
      for (int i = 0; i < 2; i++) memcpy(b[state][i], other->x[state][(e + i) % 3], sizeof(Place));
    if (other->tag[e] == end[0]->tag || other->tag[e] == end[1]->tag || other->tag[(e + 1) % 3] == end[0]->tag ||
        other->tag[(e + 1) % 3] == end[1]->tag)
      continue;
    if (!EdgesNear(end, (const Place *)b[0], (const Place *)b[1])) continue;
    if (!SweepEdges((const Place *)a[0], (const Place *)a[1], (const Place *)b[0], (const Place *)b[1], &last))
      continue;
    if (!last.over || !(-last.distance > own + explained)) continue;
    finding = (Finding){.kind    = FINDING_EDGES,
                        .ratio   = -last.distance / (own + explained),
                        .depth   = -last.distance,
                        .allowed = own + explained,
                        .tag     = {end[0]->tag, end[1]->tag},
                        .face    = other->face,
                        .X       = {end[0]->X[0], end[0]->X[1], end[0]->X[2]}};
    Keep(&finding, worst);
  }
}

/*@
  PieceFindings - judges the edges of a piece: their depth at the end of the step, and in space whether they have
crossed edges.

  Not collective

  Input Parameters:
+ look   - the pieces of the other side
. piece  - the piece
- corner - its vertices as points

  Input/Output Parameter:
. worst - the worst finding so far

  Note:
  An edge that two pieces of this rank share is looked at from both.
@*/
void PieceFindings(Look *look, const Piece *piece, const Point *const corner[3], Finding *worst)
{
  const int edges = look->dim == 2 ? 1 : 3;
  double    box[6], normal[3], other_normal[3];

  PieceBox(piece, look->dim, box);
  LookAt(look, box, 0);
  if (!look->n_found) return;
  PieceNormal(look->dim, (const Place *)piece->x[1], normal);
  for (int e = 0; e < edges; e++) {
    const Point *const end[2] = {corner[e], corner[(e + 1) % look->dim]};

    JudgeEdgeDepth(look, piece, end, worst);
    for (int i = 0; look->dim == 3 && i < look->n_found; i++) {
      const Piece *other = &look->list->pieces[look->found[i]];

      PieceNormal(look->dim, (const Place *)other->x[1], other_normal);
      if (Dot(normal, other_normal) < 0) JudgeEdgeCrossings(look, piece, end, other, worst);
    }
  }
}
