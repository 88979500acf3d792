/* Where a point stands to the pieces of the other side, and what has happened to it in a step. Plain C on pieces.

   LookAt() gathers the pieces that a point or an edge may meet, PointStand() finds the closest one at one of the two
   states, JudgeDepth() judges that. PointFinding() follows a point along the step, EdgeFinding() judges an edge,
   against the faces and, if asked, the edges of the other side. EdgeOnEdges() judges an edge that stands across edges,
   EdgePassage() one that has crossed a body in the step. FoldFinding() judges the pieces of one face, which turn
   through each other where it folds. Each keeps the worst of what was found. */
#pragma once
#include "base/boxtree.h"
#include "base/vectors.h"
#include "pieces.h"

/* Two pieces share a closest point where their distances differ by less than this, in parts of the size. */
#define STAND_TIE 1e-9
/* Cosine between a point's direction from its closest point and the normals there, from which the point is over a
   corner and not beside it: behind a concave corner of three square faces it is 0.577. */
#define STAND_CORNER 0.5
/* The same where the surface ends, times the least cosine between the normals there and their sum: the point is beside
   the surface otherwise. */
#define STAND_END 0.999
/* A body's own wall that is nearer than this part of its reference distance has been entered (ownbody.h). */
#define STAND_OWN_WALL 0.25
/* Part of the height of an element up to which faces may cross where any side of a body may meet any other one: deeper,
   the other side of a wall would be nearer (ownbody.h). */
#define STAND_WALL 0.25
/* The same up to which edges explain it: deeper, a face has passed through the element. */
#define STAND_EDGE 1.0
/* Part of a face around a point in which its closest piece is looked for. What goes deeper has crossed a piece. */
#define STAND_REACH 0.5
/* Normals whose cosine is below this belong to the two sides of a wall, not of a corner. */
#define STAND_OPPOSED (-0.5)
/* Cosine of the angle up to which an edge lies along a face and not across it, 30 degrees: half a face behind a point
   that the face holds, it is a quarter of a face off. */
#define STAND_ALONG 0.866
/* Depths below this part of a face are round-off. */
#define STAND_ROUND_OFF 1e-6

typedef enum { FINDING_NONE, FINDING_DEPTH, FINDING_PASSED, FINDING_EDGES, FINDING_FOLDED, FINDING_KINDS } FindingKind;

/* The worst that was found. */
typedef struct {
  FindingKind kind;    /* FINDING_NONE: within what is allowed */
  double      ratio;   /* depth over what is allowed; of a passage at least 1, of a fold INFINITY */
  double      depth;   /* length */
  double      allowed; /* length */
  double      over_h;  /* depth without what geometry explains, over the size of the smaller face */
  long        tag[2];  /* gmsh's tags of the point or of an edge; of a tool -1 - tag. The second is 0 for a point */
  long        face;    /* gmsh's tag of the face that was passed or is stood in, or is folded about the point or edge */
  int         side;    /* that of the point or edge: 0 the slave's, 1 the master's */
  Place       X;       /* reference place (length) */
} Finding;

/* A point at one of the states. */
typedef struct {
  const Piece *piece;  /* the closest one; NULL: none near, or another pair treats it */
  int          inside; /* the point is behind it, and they look at each other */
  int          front;  /* the point is in front of it or beside its end */
  double       depth;
} Stand;

/* A point crosses a piece, or an edge stands through it: at.s is the place on the edge then. */
typedef struct {
  const Piece *piece;
  Crossing     at;
  int          edge; /* number of the edge in the piece that an edge crosses */
} Event;

/* The pieces of the other side. What is allocated serves again in the next step. */
typedef struct _n_Look {
  int              dim;
  const PieceList *list;
  struct _n_Look  *own;  /* pieces of the points' own side, a rigid tool, near the other one; NULL: none */
  BoxTree          tree; /* NULL: of the own side before the first depth that asks for it */
  int             *found, n_found, room; /* pieces at hand */
  int             *around;               /* work space of as much room */
  Event           *events;
  int              n_events, room_events;
  double           penetration; /* allowed depth in parts of the smaller face */
  double           overlap;     /* depth that the scene leaves (length) */
  int              walls;       /* any side of a body may meet any other one */
  int              slave[2];    /* contact holds the points and edges that are judged; the vertices of the pieces */
  int              apart;       /* contact of the pair presses nowhere at either state */
  int              failed;      /* memory was short: what was found does not count */
} Look;

int    LookBegin(int dim, const PieceList *, Look *);
void   LookEnd(Look *);
void   LookDestroy(Look *);
void   LookAt(Look *, const Box, double margin);
void   LookAdd(Look *, const Piece *, Crossing);
void   LookSort(Look *);
Stand  PointStand(const Look *, const Point *, int state);
int    HasTag(const Piece *, int dim, long tag);
double AllowedDepth(const Look *, const Point *, const Piece *);
double ArcDepth(const Point *);
double ExplainedDepth(const Look *, const Point *, const Piece *, double depth);
void   JudgeDepth(const Look *, const Point *, const Stand *, const long tag[2], Finding *worst);
void   FindingKeep(const Finding *, Finding *worst);
int    FindingWorse(const Finding *, const Finding *than);
void   PointFinding(Look *, Point *, Finding *worst);
Point  EdgePoint(const Edge *edge, const Piece *piece, double s);
int    EdgeLeavesOut(const Look *, const Edge *, const Piece *);
void   EdgeOnEdges(Look *, const Edge *, double in, double out, Finding *worst);
void   EdgePassage(Look *, const Edge *, const Box, Finding *worst);
void   PassageFinding(const Look *, const Point *, long second, const Event *in, const Event *out, double depth,
                      Finding *worst);
void   EdgeFinding(Look *, const Edge *, int crossings, Finding *worst);
void   FoldFinding(int dim, int n, const Piece pieces[], Finding *worst);
