/* Places on edges as points, and which pieces an edge does not meet, see stand.h. */
#include "stand.h"
#include <math.h>

/*@
  EdgePoint - makes a point of a place on an edge, for its depth. Of the two faces around it the worse one counts.

  Not collective

  Input Parameters:
+ edge  - the edge
. piece - one of the two around it
- s     - the place, 0 to 1
@*/
Point EdgePoint(const Edge *edge, const Piece *piece, double s)
{
  Point point = {.tag    = edge->end[0]->tag,
                 .size   = piece->size,
                 .height = piece->height,
                 .marks  = edge->end[0]->marks & edge->end[1]->marks,
                 .body   = piece->body,
                 .closed = piece->closed,
                 .side   = piece->side,
                 .order  = piece->order,
                 .tip    = fmin(edge->end[0]->tip, edge->end[1]->tip)};

  Between(edge->end[0]->X, edge->end[1]->X, s, point.X);
  for (int state = 0; state < 2; state++) {
    Between(edge->end[0]->x[state], edge->end[1]->x[state], s, point.x[state]);
    for (int d = 0; d < 3; d++)
      point.normal[state][d] = edge->end[0]->normal[state][d] + edge->end[1]->normal[state][d];
  }
  return point;
}

/*@
  EdgeLeavesOut - says whether a piece is at one of the ends of an edge, or treated by another pair together with the
  edge.

  Not collective

  Input Parameters:
+ look  - the search
. edge  - the edge
- piece - the piece
@*/
int EdgeLeavesOut(const Look *look, const Edge *edge, const Piece *piece)
{
  return HasTag(piece, look->dim, edge->end[0]->tag) || HasTag(piece, look->dim, edge->end[1]->tag) ||
         FaceMarksTreated(edge->end[0]->marks & edge->end[1]->marks, piece->marks);
}
