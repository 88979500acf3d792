/* The end of contact along a line of nodes, from their pressures. Plain C. */
#pragma once

/* What a loaded node says. EDGE_AT_NODES: contact reaches the node. EDGE_OF_HATS: hat functions carry force to the node
   where contact reaches the node before it (surface to surface). */
typedef enum { EDGE_AT_NODES, EDGE_OF_HATS } EdgeReach;

double ContactEdge(EdgeReach, int n, const double *x, const double *p, int max_side, double *spacing);
