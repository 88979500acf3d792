/* A piecewise linear factor over the load parameter t, constant beyond its ends. Plain C. */
#pragma once

typedef struct {
  int     n; /* breakpoints, at least 2, t strictly increasing */
  double *t, *v;
} History;

double HistoryValue(const History *, double t);
int    HistoryBreaks(const History *, double t); /* does its slope change at t? */
