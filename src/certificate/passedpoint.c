/* Points that pass faces of the other side in a step, see stand.h. */
#include "stand.h"
#include <math.h>

/* How far a point is behind the plane of a piece at a time of the step. */
static double BehindAt(int dim, const Piece *piece, const Point *point, double s)
{
  double x[3][3], p[3];

  for (int a = 0; a < dim; a++) Between(piece->x[0][a], piece->x[1][a], s, x[a]);
  Between(point->x[0], point->x[1], s, p);
  return -PieceFront(dim, (const Place *)x, p);
}

static double Cosine(const Piece *a, const Piece *b)
{
  return Dot(a->normal[1], b->normal[1]);
}

/* Do two pieces share a vertex? The flanks of a tip do, the sides of a film or a sheet do not. */
static int Adjoin(int dim, const Piece *a, const Piece *b)
{
  for (int i = 0; i < dim; i++)
    if (HasTag(b, dim, a->tag[i])) return 1;
  return 0;
}

/* Keeps that a point or an edge has passed the piece where it came in, if that is the worst. */
static void KeepPassed(const Point *point, long second, const Event *in, double depth, double allowed, Finding *worst)
{
  const Finding finding = {.kind    = FINDING_PASSED,
                           .ratio   = depth / allowed,
                           .depth   = depth,
                           .allowed = allowed,
                           .tag     = {point->tag, second},
                           .face    = in->piece->face,
                           .X       = {point->X[0], point->X[1], point->X[2]}};

  FindingKeep(&finding, worst);
}

/*@
  PassageFinding - judges a point, or an edge at a place, that was behind one piece and has come out of another one, or
  stands in it.

  Not collective

  Input Parameters:
+ look   - the pieces of the other side
. point  - the point
. second - of an edge: tag of its second end, else 0
. in     - where and when it came in
. out    - where and when it came out
- depth  - how deep it was in between (length)

  Input/Output Parameter:
. worst - the worst finding so far

  Note:
  Where the two pieces are no opposite sides of a wall, it is back on the side from which it came: straight motions cut
  corners. Where contact presses, it may pass the tip of a wedge as deep as it may stand in it. A wall whose sides do
  not meet is passed however thin it is, unless its faces are farther than that from the curved surface that they stand
  for.
@*/
void PassageFinding(const Look *look, const Point *point, long second, const Event *in, const Event *out, double depth,
                    Finding *worst)
{
  const int carried = point->closed || in->piece->closed || out->piece->closed;
  double    allowed = STAND_ROUND_OFF * fmin(point->size, fmin(in->piece->size, out->piece->size));

  if (Cosine(in->piece, out->piece) > STAND_OPPOSED) return;
  if (carried && Adjoin(look->dim, in->piece, out->piece))
    allowed = look->penetration * fmin(point->size, fmin(in->piece->size, out->piece->size));
  allowed += look->overlap + fmax(in->piece->sagitta, out->piece->sagitta);
  if (!(depth > allowed)) return;
  KeepPassed(point, second, in, depth, allowed, worst);
}

/* Finds where a point crossed a piece, on the piece as it is at the end. Returns 0 where that cannot be told. */
static int CrossedAt(int dim, const Event *event, const Point *point, Place at)
{
  const Piece *piece = event->piece;
  Place        x[3], p;

  for (int a = 0; a < dim; a++) Between(piece->x[0][a], piece->x[1][a], event->at.s, x[a]);
  Between(point->x[0], point->x[1], event->at.s, p);
  return PieceCarry(dim, (const Place *)x, p, (const Place *)piece->x[1], at);
}

/* How deep a place is in the other side at the end, where a place on its surface is not farther than `reach`; less than
   0 in front of it. The pieces at hand are those around the place then. */
static double DepthAtEnd(Look *look, const Place p, double reach)
{
  double least = INFINITY, depth = 0;
  Box    box;

  BoxAround(1, (const Place *)p, box);
  LookAt(look, box, reach);
  for (int i = 0; i < look->n_found; i++) {
    const Place *x = (const Place *)look->list->pieces[look->found[i]].x[1];
    double       foot[3];

    (void)PieceClosest(look->dim, x, p, foot);
    if (Distance(foot, p) >= least) continue;
    least = Distance(foot, p);
    depth = PieceFront(look->dim, x, p) > 0 ? -least : least;
  }
  return depth;
}

/* Judges a point that came in and went out on the same side of a body. A straight motion cuts the corners of what the
   point slides along or turns about. Where contact presses at neither state, nothing has led the point around the body:
   it has been carried through something that should have held it, such as the lip of a snap joint, if the chord between
   the places where it crossed the body lies deep in the body as it is at the end. */
static void JudgeGraze(Look *look, const Point *point, const Event *in, const Event *out, Finding *worst)
{
  const double size = fmin(point->size, fmin(in->piece->size, out->piece->size));
  const double allowed =
    look->penetration * size + look->overlap + fmax(in->piece->sagitta, out->piece->sagitta) + ArcDepth(point);
  Place  from, to, middle;
  double depth;

  if (!look->apart || in->at.s == 0) return;
  if (!CrossedAt(look->dim, in, point, from) || !CrossedAt(look->dim, out, point, to)) return;
  Between(from, to, 0.5, middle);
  depth = DepthAtEnd(look, middle, Distance(from, middle));
  if (depth > allowed) KeepPassed(point, 0, in, depth, allowed, worst);
}

/* Judges a point that came in and went out, or stands at the end behind what it would have come out of. */
static void JudgePassage(Look *look, const Point *point, const Event *in, const Event *out, Finding *worst)
{
  const double depth =
    fmin(BehindAt(look->dim, in->piece, point, out->at.s), BehindAt(look->dim, out->piece, point, in->at.s));

  if (Cosine(in->piece, out->piece) > STAND_OPPOSED)
    JudgeGraze(look, point, in, out, worst);
  else
    PassageFinding(look, point, 0, in, out, depth, worst);
}

/* Judges a point that has gone behind a piece and is not found behind any surface at the end. */
static void JudgeGone(const Look *look, const Point *point, const Event *in, const Stand *end, Finding *worst)
{
  const double depth   = BehindAt(look->dim, in->piece, point, 1);
  const double allowed = AllowedDepth(look, point, in->piece) + ExplainedDepth(look, point, in->piece, depth);
  double       foot[3];

  if (!(depth > allowed) || (end->piece && end->front)) return;
  (void)PieceClosest(look->dim, (const Place *)in->piece->x[1], point->x[1], foot);
  if (Distance(foot, point->x[1]) > depth + 0.5 * in->piece->size) return; /* it left past an end */
  KeepPassed(point, 0, in, depth, allowed, worst);
}

/* Finds the crossings of a point, in the order of time. */
static void PointEvents(Look *look, const Point *point, const Box box)
{
  look->n_events = 0;
  for (int i = 0; i < look->n_found; i++) {
    const Piece *piece = &look->list->pieces[look->found[i]];
    Crossing     crossing[SWEEP_MAX];
    int          times;

    if (!BoxesMeet(box, piece->box, 0) || HasTag(piece, look->dim, point->tag)) continue;
    if (FaceMarksTreated(point->marks, piece->marks)) continue;
    times =
      SweepPoint(look->dim, (const Place *)piece->x[0], (const Place *)piece->x[1], point->x[0], point->x[1], crossing);
    for (int k = 0; k < times; k++) LookAdd(look, piece, crossing[k]);
  }
  LookSort(look);
}

/*@
  PointFinding - follows a point along the step and judges what has happened to it.

  Not collective

  Input Parameters:
+ look  - the pieces of the other side
- point - the point; says on return whether it is inside

  Input/Output Parameter:
. worst - the worst finding so far

  Notes:
  A point has come in where it crosses a piece to its back, or where it stood behind one at the start. It has come out
  where it crosses a piece to its front, or where it stands behind one on the other side of a wall at the end. In
  between it was as deep as it was behind the first piece when it came out, or behind the last one when it came in.
@*/
void PointFinding(Look *look, Point *point, Finding *worst)
{
  Event in = {.piece = NULL};
  Box   box;
  Stand start, end;

  BoxAround(2, (const Place *)point->x, box);
  point->inside = 0;
  LookAt(look, box, STAND_REACH * point->size + look->overlap);
  if (!look->n_found) return;
  start = PointStand(look, point, 0);
  end   = PointStand(look, point, 1);

  point->inside = end.inside;
  JudgeDepth(look, point, &end, (long[2]){point->tag, 0}, worst);
  PointEvents(look, point, box);
  if (start.inside) in = (Event){.piece = start.piece, .at = {0, 1}};
  for (int k = 0; k < look->n_events; k++) {
    const Event *event = &look->events[k];

    if (event->at.inward && !in.piece) {
      in = *event;
    } else if (!event->at.inward && in.piece) {
      JudgePassage(look, point, &in, event, worst);
      in.piece = NULL;
    }
  }
  if (in.piece && end.inside && Cosine(in.piece, end.piece) <= STAND_OPPOSED)
    JudgePassage(look, point, &in, &(Event){.piece = end.piece, .at = {1, 0}}, worst);
  if (in.piece && !end.inside) JudgeGone(look, point, &in, &end, worst);
}
