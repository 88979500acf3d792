#include "scene/history.h"

/* The interval i with t[i] <= t < t[i + 1]; -1 before the first breakpoint, n - 1 from the last one on. */
static int HistoryInterval(const History *history, double t)
{
  int i = -1;

  while (i + 1 < history->n && t >= history->t[i + 1]) i++;
  return i;
}

/* HistoryBreaks - whether t is one of its breakpoints. Not collective. */
int HistoryBreaks(const History *history, double t)
{
  const int i = HistoryInterval(history, t);

  return i >= 0 && t == history->t[i];
}

/* HistoryValue - the factor at load parameter t: linear between breakpoints, the end values beyond them. Exact at
   breakpoints.

   Not collective. t: load parameter. Returns the factor (no unit). */
double HistoryValue(const History *history, double t)
{
  const int i = HistoryInterval(history, t);

  if (i < 0) return history->v[0];
  if (i == history->n - 1) return history->v[i];
  return history->v[i] +
         (history->v[i + 1] - history->v[i]) / (history->t[i + 1] - history->t[i]) * (t - history->t[i]);
}
