/* Points and faces of a slave against an analytic tool along a step. */
#pragma once
#include "stand.h"

/* An analytic tool at the two states: the point of its motion, relative to the mesh's centre, and its axis or normal.
 */
typedef struct {
  int             dim;
  AnalyticSurface surface;
  Place           point[2], axis[2];
  double          penetration, overlap; /* of Look */
  int             apart;
} AnalyticTool;

void AnalyticPointFinding(const AnalyticTool *, const Point *, Finding *worst);
void AnalyticPieceFinding(const AnalyticTool *, const Piece *, Finding *worst);
