/* The end of contact along a line of nodes, from their pressures. Plain C. */
#pragma once

/* x[n] ascending coordinates and p[n] nodal pressures, loaded where p > 0; max_side: the end at large x, else at small x. The zero of p^2,
   extrapolated linearly from the last two loaded nodes and bounded by the next open one (Hertz's pressure falls so at its edge); half way
   to the open node where only one node is loaded; the last node of the line if that is loaded. NaN: no node is loaded. *spacing: distance
   of the last loaded and the open node, 0 at the line's end. */
double ContactEdge(int n, const double *x, const double *p, int max_side, double *spacing);
