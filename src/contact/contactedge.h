/* The end of contact along a line of nodes, from their pressures. Plain C. */
#pragma once

/* What a loaded node says: contact reaches it, or hat functions carry force to it that reaches the node before it
 * (surface to surface). */
typedef enum { EDGE_AT_NODES, EDGE_OF_HATS } EdgeReach;

/* x[n] ascending coordinates and p[n] nodal pressures (normal force over area), loaded where p > 0; max_side: the end
   at large x, else at small x. Hertz's pressure falls to its edge as the root of the distance; the edge is that of the
   root with the moments of the nodal forces about two nodes near the end, or through two pressures where they alone
   fall (a shell's highest are at the edge), bounded by the next open node. Half way to it where only one node is
   loaded; the last node of the line if that is loaded. NaN: no node is loaded. *spacing: distance of the last loaded
   and the open node, 0 at the line's end. */
double ContactEdge(EdgeReach, int n, const double *x, const double *p, int max_side, double *spacing);
