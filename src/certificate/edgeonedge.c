/* Sharp edges of both sides: those that stand across each other, and those that cross a body, see stand.h.

   Two edges stand across each other where the normal of both lies between the faces around the one, and its opposite
   between those around the other: each is the outermost part of its body there. Points of faces do not hold them. */
#include "stand.h"
#include <math.h>
#include <string.h>

/* The ends of an edge of a piece at one of the states. */
static void EndsOf(const Piece *piece, int edge, int state, Place ends[2])
{
  for (int i = 0; i < 2; i++) memcpy(ends[i], piece->x[state][(edge + i) % 3], sizeof(Place));
}

/* Cosine of the angle between an edge and the faces around it, from which a face does not hold what lies along the
   edge: over the length of the face it goes off by more than is allowed to stand in it. */
static double LeavesFace(const Look *look)
{
  return 1 / sqrt(1 + look->penetration * look->penetration);
}

/* Does the surface turn outwards at an edge of a piece, by so much that something can stand across the edge? */
static int IsSharp(const Look *look, const Piece *piece, int edge)
{
  const double *n = piece->normal[1], *across = piece->across[edge], leaves = LeavesFace(look);
  double        t[3];

  if (Dot(n, across) > 2 * leaves * leaves - 1) return 0;
  Minus(piece->x[1][(edge + 1) % 3], piece->x[1][edge], t);
  return across[0] * (t[1] * n[2] - t[2] * n[1]) + across[1] * (t[2] * n[0] - t[0] * n[2]) +
           across[2] * (t[0] * n[1] - t[1] * n[0]) >
         0;
}

/* Does a direction, times a sign, lie between the normals of the faces around an edge? */
static int IsBetween(const Look *look, const double normal[3], int sign, const Piece *piece, int edge)
{
  const double one = sign * Dot(normal, piece->normal[1]), other = sign * Dot(normal, piece->across[edge]),
               turn = Dot(piece->normal[1], piece->across[edge]), leaves = LeavesFace(look);

  return one + other > 0 && one >= turn && other >= turn && one <= leaves && other <= leaves;
}

/* Six times the volume between two edges, of one sign as long as they have not crossed. */
static double Volume(const Place a[2], const Place b[2])
{
  double u[3], v[3], r[3];

  Minus(a[1], a[0], u);
  Minus(b[1], b[0], v);
  Minus(b[0], a[0], r);
  return r[0] * (u[1] * v[2] - u[2] * v[1]) + r[1] * (u[2] * v[0] - u[0] * v[2]) + r[2] * (u[0] * v[1] - u[1] * v[0]);
}

/* Are two edges of one body on the same sides of each other as in the reference state? Then they have a wall between
   them. */
static int IsOwnEdge(const Edge *edge, const Place a[2], const Piece *piece, int k, const Place b[2])
{
  Place X[2], Y[2];

  if (piece->body != edge->of[0]->body) return 0;
  for (int i = 0; i < 2; i++) {
    memcpy(X[i], edge->end[i]->X, sizeof(Place));
    memcpy(Y[i], piece->X[(k + i) % 3], sizeof(Place));
  }
  return Volume((const Place *)X, (const Place *)Y) * Volume(a, b) >= 0;
}

/* Sine of the angle between an edge and the nearer face around another one; 0 where it lies across both. normal: of
   both edges, times a sign out of the body of these faces. */
static double OffFace(const double normal[3], int sign, const Piece *piece, int edge)
{
  const double cosine = fmax(sign * Dot(normal, piece->normal[1]), sign * Dot(normal, piece->across[edge]));

  return cosine < STAND_ALONG ? 0 : sqrt(fmax(0, 1 - cosine * cosine));
}

/* Depth of an edge, at a place, that a face explains which holds a pressed end of it: from there the edge goes off. */
static double HeldDepth(const Place ends[2], const int pressed[2], double at, double off)
{
  double r[3];

  Minus(ends[1], ends[0], r);
  return off * sqrt(Dot(r, r)) * fmax(pressed[0] ? at : 0, pressed[1] ? 1 - at : 0);
}

/* Keeps how deep an edge stands across another one. at: the place on it; held: depth that faces explain. */
static void KeepAcross(const Look *look, const Edge *edge, double at, const Piece *piece, double depth, double held,
                       Finding *worst)
{
  for (int k = 0; k < 2 && edge->of[k]; k++) {
    const Point  point     = EdgePoint(edge, edge->of[k], at);
    const double explained = fmax(piece->sagitta, edge->of[k]->sagitta) + look->overlap + held,
                 allowed   = AllowedDepth(look, &point, piece) + explained;
    Finding finding        = {.ratio   = depth / allowed,
                              .depth   = depth,
                              .allowed = allowed,
                              .over_h  = fmax(0, depth - explained) / fmin(point.size, piece->size),
                              .tag     = {edge->end[0]->tag, edge->end[1]->tag},
                              .face    = piece->face,
                              .X       = {point.X[0], point.X[1], point.X[2]}};

    if (finding.ratio > 1) finding.kind = FINDING_EDGES;
    FindingKeep(&finding, worst);
  }
}

/*@
  EdgeOnEdges - judges how deep a sharp edge stands across sharp edges of the other side at the end of the step.

  Not collective

  Input Parameters:
+ look - the search
. edge - the edge
. in   - where it goes into the other side, 0 to 1
- out  - where it comes out

  Input/Output Parameter:
. worst - the worst finding so far

  Note:
  What the shape of faces explains elsewhere, an edge that stands between the points of a face, does not count here. An
  edge whose pressed end rests on a face, along which it lies, may leave that face beyond its end.
@*/
void EdgeOnEdges(Look *look, const Edge *edge, double in, double out, Finding *worst)
{
  const Piece *own        = edge->of[0];
  const int    pressed[2] = {edge->end[0]->closed, edge->end[1]->closed};
  Place        a[2], part[2];
  Box          box;

  if (look->dim == 2 || !IsSharp(look, own, edge->number)) return;
  for (int i = 0; i < 2; i++) memcpy(a[i], edge->end[i]->x[1], sizeof(Place));
  Between(a[0], a[1], in, part[0]);
  Between(a[0], a[1], out, part[1]);
  BoxAround(2, (const Place *)part, box);
  LookAt(look, box, own->size);
  for (int i = 0; i < look->n_found; i++) {
    const Piece *piece = &look->list->pieces[look->found[i]];

    for (int k = 0; k < 3; k++) {
      double at[2], normal[3], p[3], q[3], r[3], depth, held;
      Place  b[2];
      int    sign;

      if (!IsSharp(look, piece, k) || EdgeLeavesOut(look, edge, piece)) continue;
      EndsOf(piece, k, 1, b);
      if (!EdgesAcross((const Place *)a, (const Place *)b, at, normal) || at[0] < in || at[0] > out) continue;
      sign = Dot(normal, piece->normal[1]) + Dot(normal, piece->across[k]) > 0 ? 1 : -1;
      if (!IsBetween(look, normal, sign, piece, k) || !IsBetween(look, normal, -sign, own, edge->number)) continue;
      if (IsOwnEdge(edge, (const Place *)a, piece, k, (const Place *)b)) continue;
      held = fmax(HeldDepth((const Place *)a, pressed, at[0], OffFace(normal, sign, piece, k)),
                  HeldDepth((const Place *)b, (int[2]){piece->closed, piece->closed}, at[1],
                            OffFace(normal, -sign, own, edge->number)));
      Between(a[0], a[1], at[0], p);
      Between(b[0], b[1], at[1], q);
      Minus(q, p, r);
      depth = sign * Dot(normal, r);
      if (depth > 0) KeepAcross(look, edge, at[0], piece, depth, held, worst);
    }
  }
}

/* Distance of the lines of two edges at a time of the step. */
static double LineDistance(Place a[2][2], const Piece *piece, int k, double s)
{
  Place  b[2][2], p[2], q[2];
  double at[2], normal[3], r[3];

  for (int state = 0; state < 2; state++) EndsOf(piece, k, state, b[state]);
  for (int i = 0; i < 2; i++) {
    Between(a[0][i], a[1][i], s, p[i]);
    Between(b[0][i], b[1][i], s, q[i]);
  }
  (void)EdgesAcross((const Place *)p, (const Place *)q, at, normal);
  Minus(q[0], p[0], r);
  return fabs(Dot(normal, r));
}

/* Lists when an edge crosses sharp edges of the other side, in the order of time. */
static void EdgeEvents(Look *look, const Edge *edge, Place a[2][2], const Box box)
{
  look->n_events = 0;
  for (int i = 0; i < look->n_found; i++) {
    const Piece *piece = &look->list->pieces[look->found[i]];

    for (int k = 0; k < 3; k++) {
      Place   b[2][2];
      Box     other;
      EdgeEnd end;
      int     n;

      if (!IsSharp(look, piece, k) || EdgeLeavesOut(look, edge, piece)) continue;
      for (int state = 0; state < 2; state++) EndsOf(piece, k, state, b[state]);
      BoxAround(4, (const Place *)b, other);
      if (!BoxesMeet(box, other, 0)) continue;
      n = SweepEdges((const Place *)a[0], (const Place *)a[1], (const Place *)b[0], (const Place *)b[1], &end);
      for (int c = 0; c < n; c++) {
        const double along = Dot(end.towards[c], piece->normal[1]) + Dot(end.towards[c], piece->across[k]);

        LookAdd(look, piece, (Crossing){end.s[c], along < 0});
        if (!look->failed) look->events[look->n_events - 1].edge = k;
      }
    }
  }
  LookSort(look);
}

/*@
  EdgePassage - judges a sharp edge that has crossed edges on both sides of a wall in the step, in space.

  Not collective

  Input Parameters:
+ look - the search, after LookAt() around the way of the edge
. edge - the edge
- box  - that it sweeps

  Input/Output Parameter:
. worst - the worst finding so far
@*/
void EdgePassage(Look *look, const Edge *edge, const Box box, Finding *worst)
{
  const Point point = EdgePoint(edge, edge->of[0], 0.5);
  Place       a[2][2];

  if (!IsSharp(look, edge->of[0], edge->number)) return;
  for (int state = 0; state < 2; state++)
    for (int i = 0; i < 2; i++) memcpy(a[state][i], edge->end[i]->x[state], sizeof(Place));
  EdgeEvents(look, edge, a, box);
  for (int i = 0; i < look->n_events; i++) {
    const Event *in = &look->events[i];

    for (int o = i + 1; o < look->n_events && in->at.inward; o++) {
      const Event *out = &look->events[o];

      if (out->at.inward) continue;
      PassageFinding(look, &point, edge->end[1]->tag, in, out, LineDistance(a, in->piece, in->edge, out->at.s), worst);
    }
  }
}
