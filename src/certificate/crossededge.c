/* Edges that stand in the other side or have crossed its edges, see stand.h. */
#include "stand.h"
#include <string.h>
#include <math.h>

/* Finds the places where an edge stands through pieces at the end, in their order. */
static void FindCuts(Look *look, const Edge *edge)
{
  Place ends[2];
  Box   box;

  look->n_events = 0;
  for (int i = 0; i < 2; i++) memcpy(ends[i], edge->end[i]->x[1], sizeof(Place));
  BoxAround(2, (const Place *)ends, box);
  for (int i = 0; i < look->n_found; i++) {
    const Piece *piece = &look->list->pieces[look->found[i]];
    Crossing     at;

    if (!BoxesMeet(box, piece->box, 0) || EdgeLeavesOut(look, edge, piece)) continue;
    if (PiecePierce(look->dim, (const Place *)piece->x[1], piece->normal[1], (const Place *)ends, &at.s, &at.inward))
      LookAdd(look, piece, at);
  }
  LookSort(look);
}

/* Judges the middle between two places where an edge goes through pieces. These are no farther than its closest
   piece can be. */
static void JudgeMiddle(Look *look, const Edge *edge, double in, double out, Finding *worst)
{
  const long   tag[2] = {edge->end[0]->tag, edge->end[1]->tag};
  const double half   = 0.5 * (out - in) * Distance(edge->end[0]->x[1], edge->end[1]->x[1]);

  for (int k = 0; k < 2 && edge->of[k]; k++) {
    const Point middle = EdgePoint(edge, edge->of[k], 0.5 * (in + out));
    Box         box;
    Stand       stand;

    BoxAround(1, (const Place *)&middle.x[1], box);
    LookAt(look, box, half);
    stand = PointStand(look, &middle, 1);
    JudgeDepth(look, &middle, &stand, tag, worst);
  }
}

/* Judges the parts of an edge that stand in the other side at the end, between two places where it goes through. In a
   part that reaches to an end of the edge, the point there is the deepest; in space the part may stand across edges. */
static void JudgeCuts(Look *look, const Edge *edge, Finding *worst)
{
  double in = edge->end[0]->inside ? 0 : -1;

  FindCuts(look, edge);
  for (int i = 0; i < look->n_events; i++) {
    const Crossing at = look->events[i].at;

    if (at.inward && in < 0) in = at.s;
    if (at.inward || in < 0) continue;
    if (in > 0) JudgeMiddle(look, edge, in, at.s, worst);
    EdgeOnEdges(look, edge, in, at.s, worst);
    in = -1;
  }
  if (in >= 0 && edge->end[1]->inside) EdgeOnEdges(look, edge, in, 1, worst);
}

/* Does an edge look at a piece, with one of the faces around it? */
static int LooksAt(const Edge *edge, const Piece *piece)
{
  for (int k = 0; k < 2 && edge->of[k]; k++)
    if (Dot(edge->of[k]->normal[1], piece->normal[1]) < 0) return 1;
  return 0;
}

/* Least depth that the faces around an edge allow in a piece. */
static double EdgeAllowed(const Look *look, const Edge *edge, const Piece *piece, double depth)
{
  double allowed = INFINITY;

  for (int k = 0; k < 2 && edge->of[k]; k++) {
    const Point point = EdgePoint(edge, edge->of[k], 0.5);

    allowed = fmin(allowed, AllowedDepth(look, &point, piece) + ExplainedDepth(look, &point, piece, depth));
  }
  return allowed;
}

/* Does an edge first come out of the body around an edge of a piece? Edges that touch may be crossed by round-off. */
static int GoesOut(const EdgeEnd *end, const Piece *piece, int e)
{
  return Dot(end->towards[0], piece->normal[1]) + Dot(end->towards[0], piece->across[e]) > 0;
}

/* Depth of a place behind the faces around an edge of a piece, at the end of the step: below 0 in front of the body.
   Where an edge slides along a face over the end of that face, it has crossed the edge there by as much as it has slid,
   but stands no deeper than it is pressed into the face. */
static double DepthBehind(const Piece *piece, int e, const Place at)
{
  double one = 0, other = 0, t[3], out[3];

  for (int d = 0; d < 3; d++) {
    const double r = piece->x[1][e][d] - at[d];

    one += piece->normal[1][d] * r;
    other += piece->across[e][d] * r;
    t[d] = piece->x[1][(e + 1) % 3][d] - piece->x[1][e][d];
  }
  Cross(t, piece->normal[1], out);
  return Dot(piece->across[e], out) > 0 ? fmin(one, other) : fmax(one, other);
}

/* Judges an edge, with the box that it sweeps, that crosses the edges of a piece. a: its ends at both states. */
static void JudgeCrossings(const Look *look, const Edge *edge, Place a[2][2], const Box box, const Piece *piece,
                           Finding *worst)
{
  for (int e = 0; e < 3; e++) {
    Place   b[2][2];
    Box     other;
    EdgeEnd last;
    Place   at;
    double  allowed, depth;
    Finding finding;

    for (int state = 0; state < 2; state++)
      for (int i = 0; i < 2; i++) memcpy(b[state][i], piece->x[state][(e + i) % 3], sizeof(Place));
    BoxAround(4, (const Place *)b, other);
    if (!BoxesMeet(box, other, 0)) continue;
    if (!SweepEdges((const Place *)a[0], (const Place *)a[1], (const Place *)b[0], (const Place *)b[1], &last))
      continue;
    depth = GoesOut(&last, piece, e) ? last.distance : -last.distance;
    if (!last.over || depth <= 0) continue;
    for (int d = 0; d < 3; d++) at[d] = (1 - last.place) * a[1][0][d] + last.place * a[1][1][d];
    depth   = fmin(depth, DepthBehind(piece, e, at));
    allowed = EdgeAllowed(look, edge, piece, depth);
    if (!(depth > allowed)) continue;
    finding = (Finding){.kind    = FINDING_EDGES,
                        .ratio   = depth / allowed,
                        .depth   = depth,
                        .allowed = allowed,
                        .tag     = {edge->end[0]->tag, edge->end[1]->tag},
                        .face    = piece->face,
                        .X       = {edge->end[0]->X[0], edge->end[0]->X[1], edge->end[0]->X[2]}};
    FindingKeep(&finding, worst);
  }
}

/*@
  EdgeFinding - judges an edge: its depth at the end of the step, and whether it has crossed edges.

  Not collective

  Input Parameters:
+ look      - the pieces of the other side
. edge      - the edge
- crossings - in space: judge crossings of edges as well, which one of two sides has to

  Input/Output Parameter:
. worst - the worst finding so far
@*/
void EdgeFinding(Look *look, const Edge *edge, int crossings, Finding *worst)
{
  Place x[2][2];
  Box   box;

  for (int state = 0; state < 2; state++)
    for (int i = 0; i < 2; i++) memcpy(x[state][i], edge->end[i]->x[state], sizeof(Place));
  BoxAround(4, (const Place *)x, box);
  LookAt(look, box, 0);
  if (!look->n_found) return;
  for (int i = 0; crossings && look->dim == 3 && i < look->n_found; i++) {
    const Piece *piece = &look->list->pieces[look->found[i]];

    if (LooksAt(edge, piece) && !EdgeLeavesOut(look, edge, piece)) JudgeCrossings(look, edge, x, box, piece, worst);
  }
  if (crossings && look->dim == 3) EdgePassage(look, edge, box, worst);
  JudgeCuts(look, edge, worst);
}
