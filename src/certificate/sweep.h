/* Points, edges and faces that move along straight lines from one state to the next: where they cross. Plain C.

   Faces are divided into pieces as the results show them: segments in two dimensions, triangles in three. A piece has
   as many vertices as there are dimensions. Faces of second order are divided at their middle nodes. The front of a
   piece is where its normal points (element.h). Positions have three components, in two dimensions the third is 0.

   SweepPoint() finds when a moving point crosses a moving piece, SweepEdges() when a moving edge crosses a moving edge,
   SweepHinge() whether two pieces have turned through each other about what they share. PieceClosest() finds the point
   of a piece that is closest to a place, PieceCarry() where a place on it comes with it, PiecePierce() where an edge
   stands through a piece. PieceHeight() measures how far a piece is from a smooth surface with the normals of its
   vertices. PieceDivide() divides faces into pieces. */
#pragma once
#include "kernels/element.h"

/* Most pieces of a face, and most crossings of a point and a piece: the roots of a cubic polynomial. */
enum { PIECE_MAX = 8, SWEEP_MAX = 3 };

/* A crossing counts on a piece or an edge and this little past its border, in parts of the piece. What moves exactly
   over the border of two pieces is thus seen by both, and by none of them never. */
#define SWEEP_BORDER 1e-9
/* Edges whose directions have a smaller sine between them are parallel. They do not cross. */
#define SWEEP_PARALLEL 1e-6

typedef double Place[3];

typedef struct {
  double s;      /* when, from 0 to 1 */
  int    inward; /* from the front to the back; of edges: the sign of their distance turns from plus to minus */
} Crossing;

/* Two edges at the end of their motion, and when they crossed */
typedef struct {
  double distance;           /* along their common normal, with the sign that it had before the crossing (length) */
  int    over;               /* their closest points are inside both */
  double place;              /* that of the first edge on it, 0 to 1; where they are over each other */
  double s[SWEEP_MAX];       /* when they crossed */
  Place  towards[SWEEP_MAX]; /* common normal then, from the first edge to the other one before they crossed */
} EdgeEnd;

int    PieceDivide(ElementType, int node[PIECE_MAX][3]);
void   PieceNormal(int dim, const Place x[], double normal[3]);
double PieceFront(int dim, const Place x[], const Place p);
double PieceHeight(int dim, const Place x[], const Place normal[], double cosine);
double PieceAngle(const Place x[], int a);
void   PieceAcross(const Place x[], int a, const double one[3], const double other[3], double across[3]);
int    PieceClosest(int dim, const Place x[], const Place p, Place closest);
int    PieceCarry(int dim, const Place from[], const Place p, const Place to[], Place out);
int    PiecePierce(int dim, const Place x[], const double normal[3], const Place edge[2], double *at, int *inward);
int    SweepPoint(int dim, const Place start[], const Place end[], const Place from, const Place to, Crossing[]);
int    SweepHinge(int dim, const Place start[], const Place end[], const Place from, const Place to);
int    EdgesAcross(const Place a[2], const Place b[2], double at[2], double normal[3]);
int    SweepEdges(const Place a0[2], const Place a1[2], const Place b0[2], const Place b1[2], EdgeEnd *);
