/* Where points stand to the pieces of the other side, see stand.h. */
#include "stand.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/*@
  LookBegin - prepares the search of pieces.

  Not collective

  Input Parameters:
+ dim  - 2 or 3
- list - the pieces, which are borrowed

  Input/Output Parameter:
. look - with its settings, zeroed before the first call; LookEnd() ends the search, LookDestroy() frees all

  Note:
  It returns 0 where memory is short.
@*/
int LookBegin(int dim, const PieceList *list, Look *look)
{
  double *lower = malloc(sizeof(double) * (size_t)(dim * list->n + 1)),
         *upper = malloc(sizeof(double) * (size_t)(dim * list->n + 1));
  int made      = lower && upper;

  look->dim    = dim;
  look->list   = list;
  look->failed = 0;
  if (look->room < list->n || !look->found) {
    free(look->found);
    look->room   = (int)list->n + 1;
    look->found  = malloc(2 * sizeof(int) * (size_t)look->room);
    look->around = look->found + look->room;
  }
  for (int k = 0; made && k < list->n; k++) {
    memcpy(&lower[k * dim], list->pieces[k].box, sizeof(double) * (size_t)dim);
    memcpy(&upper[k * dim], &list->pieces[k].box[3], sizeof(double) * (size_t)dim);
  }
  made = made && look->found && !BoxTreeBuild(dim, (int)list->n, lower, upper, &look->tree);
  free(lower);
  free(upper);
  return made;
}

/*@
  LookEnd - ends a search.

  Not collective

  Input/Output Parameter:
. look - what LookBegin() has made
@*/
void LookEnd(Look *look)
{
  BoxTreeDestroy(&look->tree);
}

/*@
  LookDestroy - frees the search.

  Not collective

  Input/Output Parameter:
. look - empty on return
@*/
void LookDestroy(Look *look)
{
  LookEnd(look);
  free(look->found);
  free(look->events);
  *look = (Look){0};
}

/*@
  LookAt - gathers the pieces that come near a box in the step.

  Not collective

  Input Parameters:
+ look   - the search
. box    - the box
- margin - how near (length)

  Note:
  look->found and look->n_found say which ones.
@*/
void LookAt(Look *look, const Box box, double margin)
{
  double lower[3], upper[3];

  for (int d = 0; d < 3; d++) {
    lower[d] = box[d] - margin;
    upper[d] = box[3 + d] + margin;
  }
  look->n_found = BoxTreeMeet(look->tree, lower, upper, look->room, look->found);
}

/*@
  LookAdd - keeps a crossing of the point or edge at hand.

  Not collective

  Input Parameters:
+ look  - the search
. piece - the piece that is crossed
- at    - when or where
@*/
void LookAdd(Look *look, const Piece *piece, Crossing at)
{
  if (look->n_events == look->room_events) {
    const int room   = 2 * look->room_events + 64;
    Event    *events = realloc(look->events, sizeof(*events) * (size_t)room);

    look->failed |= !events;
    if (!events) return;
    look->events      = events;
    look->room_events = room;
  }
  look->events[look->n_events++] = (Event){.piece = piece, .at = at};
}

static int EarlierEvent(const void *a, const void *b)
{
  const double s = ((const Event *)a)->at.s, t = ((const Event *)b)->at.s;

  return (s > t) - (s < t);
}

/*@
  LookSort - puts the crossings in their order.

  Not collective

  Input Parameter:
. look - the search
@*/
void LookSort(Look *look)
{
  if (look->n_events > 1) qsort(look->events, (size_t)look->n_events, sizeof(*look->events), EarlierEvent);
}

/*@
  HasTag - tells whether a node is a vertex of a piece.

  Not collective

  Input Parameters:
+ piece - the piece
. dim   - 2 or 3
- tag   - of the node
@*/
int HasTag(const Piece *piece, int dim, long tag)
{
  for (int a = 0; a < dim; a++)
    if (piece->tag[a] == tag) return 1;
  return 0;
}

/* Is a piece of the point's own body the wall below the point, or its own neighbourhood? */
static int IsOwnWall(int dim, const Piece *piece, const Point *point, int state, double distance)
{
  double at[3];

  if (piece->body != point->body) return 0;
  if (Dot(piece->normal[state], point->normal[state]) >= 0) return 1;
  if (PieceFront(dim, (const Place *)piece->X, point->X) >= -STAND_ROUND_OFF * piece->size) return 0;
  (void)PieceClosest(dim, (const Place *)piece->X, point->X, at);
  return distance >= STAND_OWN_WALL * Distance(point->X, at);
}

/* Does the way from a point to a foot behind which it stands enter another wall of its own body? The point is then in
   front of that wall, as a coil of a spiral spring is inside of the next one, and not in the material below the foot.
 */
static int IsBeforeWall(const Look *look, const Point *point, int state, const double foot[3])
{
  const double *p = point->x[state];

  for (int i = 0; i < look->n_found; i++) {
    const Piece *piece = &look->list->pieces[look->found[i]];
    double       from, to, at[3], closest[3];

    if (piece->body != point->body || HasTag(piece, look->dim, point->tag)) continue;
    from = PieceFront(look->dim, (const Place *)piece->x[state], p);
    to   = PieceFront(look->dim, (const Place *)piece->x[state], foot);
    if (from <= STAND_TIE * piece->size || to >= -STAND_TIE * piece->size) continue;
    for (int d = 0; d < 3; d++) at[d] = p[d] + from / (from - to) * (foot[d] - p[d]);
    (void)PieceClosest(look->dim, (const Place *)piece->x[state], at, closest);
    if (Distance(at, closest) <= STAND_TIE * piece->size) return 1;
  }
  return 0;
}

/* The closest point so far */
typedef struct {
  const Piece *piece;
  int          shared, interior;
  double       distance, foot[3], sum[3];
} Nearest;

/* An order of pieces that is the same on any number of ranks. */
static int EarlierPiece(const Piece *a, const Piece *b)
{
  if (a->face != b->face) return a->face < b->face;
  for (int k = 0; k < 3; k++)
    if (a->tag[k] != b->tag[k]) return a->tag[k] < b->tag[k];
  return 0;
}

static void KeepNearest(const Piece *piece, int state, const double foot[3], int interior, double distance,
                        Nearest *nearest)
{
  const double  tie    = STAND_TIE * piece->size;
  const double *normal = piece->normal[state];

  if (distance > nearest->distance + tie) return;
  if (distance > nearest->distance - tie && Distance(foot, nearest->foot) <= tie) {
    if (EarlierPiece(piece, nearest->piece)) nearest->piece = piece;
    nearest->shared++;
    for (int d = 0; d < 3; d++) nearest->sum[d] += normal[d];
    return;
  }
  if (distance >= nearest->distance) return;
  *nearest = (Nearest){piece, 1, interior, distance, {foot[0], foot[1], foot[2]}, {normal[0], normal[1], normal[2]}};
}

/* Cosine between a point's direction from its closest point and the sum of the normals there, from which the point is
   behind the surface and not beside its end. A point behind it lies between the normals of the pieces that share the
   closest point, so that it is no farther off their sum than one of these. */
static double BehindFrom(const Look *look, const Point *point, int state, const Nearest *nearest)
{
  const double length = sqrt(Dot(nearest->sum, nearest->sum));
  double       least  = 1;

  if (nearest->interior) return STAND_CORNER;
  for (int i = 0; i < look->n_found && nearest->shared > 1 && length > 0; i++) {
    const Piece *piece = &look->list->pieces[look->found[i]];
    double       foot[3];

    if (HasTag(piece, look->dim, point->tag)) continue;
    PieceClosest(look->dim, (const Place *)piece->x[state], point->x[state], foot);
    if (Distance(foot, nearest->foot) > STAND_TIE * piece->size) continue;
    least = fmin(least, Dot(piece->normal[state], nearest->sum) / length);
  }
  return fmax(STAND_CORNER, STAND_END * least);
}

/*@
  PointStand - finds where a point stands at one of the states.

  Not collective

  Input Parameters:
+ look  - the search, after LookAt()
. point - the point
- state - 0 or 1
@*/
Stand PointStand(const Look *look, const Point *point, int state)
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
    if (piece->body == point->body && IsBeforeWall(look, point, state, foot)) continue;
    KeepNearest(piece, state, foot, interior, distance, &nearest);
  }
  if (!nearest.piece || FaceMarksTreated(point->marks, nearest.piece->marks)) return stand;
  for (int d = 0; d < 3; d++) r[d] = point->x[state][d] - nearest.foot[d];
  length       = sqrt(Dot(nearest.sum, nearest.sum)) * nearest.distance;
  cosine       = length > 0 ? Dot(r, nearest.sum) / length : 1;
  stand.piece  = nearest.piece;
  stand.depth  = nearest.distance;
  stand.front  = cosine > -STAND_CORNER || (cosine > -STAND_END && cosine > -BehindFrom(look, point, state, &nearest));
  stand.inside = !stand.front && Dot(nearest.sum, point->normal[state]) < 0;
  return stand;
}

/*@
  AllowedDepth - returns the depth to which a point may stand in a piece, without what geometry and the scene explain.

  Not collective

  Input Parameters:
+ look  - the search
. point - the point
- piece - the piece
@*/
double AllowedDepth(const Look *look, const Point *point, const Piece *piece)
{
  double allowed = look->penetration * fmin(point->size, piece->size);

  if (!look->walls) return allowed;
  if (point->height > 0) allowed = fmin(allowed, STAND_WALL * point->height);
  if (piece->height > 0) allowed = fmin(allowed, STAND_WALL * piece->height);
  return allowed;
}

/* The depth up to which edges explain that faces cross: a part of the thinner element below, as no wall is thinner. A
   rigid tool has no elements. */
static double EdgeDepth(const Point *point, const Piece *piece)
{
  const double most = fmax(point->height, piece->height);

  return STAND_EDGE * (point->height > 0 && piece->height > 0 ? fmin(point->height, piece->height) : most);
}

/* Height of a surface over a chord, over half the chord. Where it turns by an edge, that is the tip there. Where it is
   round, and each of its pieces turns by as much, it goes on turning over the chord. */
static double TipOver(double chord, double tip, double side)
{
  return fmin(PIECE_TIP, tip * fmax(1, 0.5 * chord / side));
}

/* The highest of the vertices of a side's pieces that are within a chord of a place at the end. */
static double TipAround(const Look *side, const double x[3], double chord)
{
  double tip = 0, lower[3], upper[3];
  int    n;

  for (int d = 0; d < 3; d++) {
    lower[d] = x[d] - chord;
    upper[d] = x[d] + chord;
  }
  n = BoxTreeMeet(side->tree, lower, upper, side->room, side->around);
  for (int i = 0; i < n; i++) {
    const Piece *piece = &side->list->pieces[side->around[i]];

    for (int a = 0; a < side->dim; a++)
      if (Distance(piece->x[1][a], x) <= chord) tip = fmax(tip, TipOver(chord, piece->tip[a], piece->side));
  }
  return tip;
}

/* Makes the tree of the points' own side when a depth first asks for it: in most steps none does. */
static int LookOwn(Look *own)
{
  if (!own || own->failed) return 0;
  if (!own->tree) own->failed = !LookBegin(own->dim, own->list, own);
  return !own->failed;
}

/* The highest of the point and of the vertices of either side that are within a chord of it at the end: a chord that
   rests on a tool's flat on one side of the point rises beside it where the flat ends in a rounded edge. */
static double TipNear(const Look *look, const Point *point, double chord)
{
  const double *x   = point->x[1];
  double        tip = fmax(TipOver(chord, point->tip, point->side), TipAround(look, x, chord));

  return LookOwn(look->own) ? fmax(tip, TipAround(look->own, x, chord)) : tip;
}

/*@
  ArcDepth - returns how far the straight motion of a point is off the arc of a body that turns as the surface there.

  Not collective

  Input Parameter:
. point - the point
@*/
double ArcDepth(const Point *point)
{
  const double *a = point->normal[0], *b = point->normal[1], lengths = sqrt(Dot(a, a) * Dot(b, b));
  const double  turn = lengths > 0 ? acos(fmax(-1, fmin(1, Dot(a, b) / lengths))) : 0;

  return 0.5 * Distance(point->x[0], point->x[1]) * tan(turn / 4);
}

/*@
  ExplainedDepth - returns the depth of a point in a piece that the shape of the faces and the scene explain.

  Not collective

  Input Parameters:
+ look  - the search
. point - the point
. piece - the piece
- depth - of the point: shapes are looked for where it is not allowed without

  Note:
  Contact holds the slave at its points, in the mean over a face. An edge whose flanks rest on two points that are a
  face apart stands in this chord by half of it times the tip. So far from an edge faces may cross. Where no term
  presses, nothing holds the flanks, and this explains nothing.
@*/
double ExplainedDepth(const Look *look, const Point *point, const Piece *piece, double depth)
{
  const double explained = piece->sagitta + look->overlap;
  double       chord     = 0;

  if (!point->closed && !piece->closed) return explained;
  if (depth <= explained + AllowedDepth(look, point, piece)) return explained;
  if (look->slave[0]) chord = point->order * point->side;
  if (look->slave[1]) chord = fmax(chord, piece->order * piece->side);
  return explained + fmin(0.5 * chord * TipNear(look, point, chord), EdgeDepth(point, piece));
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

/*@
  FindingKeep - keeps the worse one of two findings, and the largest depth over a face of both.

  Not collective

  Input Parameter:
. finding - the finding

  Input/Output Parameter:
. worst - the worst finding so far
@*/
void FindingKeep(const Finding *finding, Finding *worst)
{
  const double over_h = fmax(finding->over_h, worst->over_h);

  if (FindingWorse(finding, worst)) *worst = *finding;
  worst->over_h = over_h;
}

/*@
  JudgeDepth - judges the depth of a point, or of a place on an edge, in a piece at the end of the step.

  Not collective

  Input Parameters:
+ look  - the search
. point - the point
. stand - where it stands at the end
- tag   - of the node, or of both ends of the edge

  Input/Output Parameter:
. worst - the worst finding so far
@*/
void JudgeDepth(const Look *look, const Point *point, const Stand *stand, const long tag[2], Finding *worst)
{
  double  own, explained;
  Finding finding;

  if (!stand->inside || stand->depth <= STAND_ROUND_OFF * stand->piece->size) return;
  own       = AllowedDepth(look, point, stand->piece);
  explained = ExplainedDepth(look, point, stand->piece, stand->depth);
  finding   = (Finding){.ratio   = stand->depth / (own + explained),
                        .depth   = stand->depth,
                        .allowed = own + explained,
                        .over_h  = fmax(0, stand->depth - explained) / fmin(point->size, stand->piece->size),
                        .tag     = {tag[0], tag[1]},
                        .face    = stand->piece->face,
                        .X       = {point->X[0], point->X[1], point->X[2]}};
  if (finding.ratio > 1) finding.kind = FINDING_DEPTH;
  FindingKeep(&finding, worst);
}
