/* The end of contact along a line of nodes, from their pressures. Plain C. */
#pragma once

/* What the pressures of a line of nodes are: values there, or factors of hat functions, whose sum is the pressure (surface to surface). */
typedef enum { EDGE_AT_NODES, EDGE_OF_HATS } EdgePressures;

/* x[n] ascending coordinates and p[n] nodal pressures, loaded where p > 0; max_side: the end at large x, else at small x. Hertz's pressure falls to
   its edge as the root of the distance; the edge is that of the root through the last two loaded nodes, bounded by the next open one, or that of the
   root with the force and the moment of the hat functions beyond the last but one. Half way to the open node where only one node is loaded; the last
   node of the line if that is loaded. NaN: no node is loaded. *spacing: distance of the last loaded and the open node, 0 at the line's end. */
double ContactEdge(EdgePressures, int n, const double *x, const double *p, int max_side, double *spacing);
