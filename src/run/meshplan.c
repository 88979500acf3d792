/* How much finer the next mesh has to be, see meshplan.h. */
#include "meshplan.h"
#include <math.h>

/* A mesh is at most so many times finer than the last one: powers are not known well enough to go further. */
#define MESHPLAN_FINEST 3
/* It is at least so much finer, or the estimate would hardly change. */
#define MESHPLAN_FINER 1.2
/* The power of the error is at least this one. A smaller one is that of meshes that are too coarse to tell. */
#define MESHPLAN_LEAST_RATE 0.7
/* The error of the next mesh is taken as at most this part of the last one's, where the change of the answer is to tell
   how much is left: that of elements MESHPLAN_WITNESS times smaller at the power MESHPLAN_LEAST_RATE. */
#define MESHPLAN_SLOWEST 0.75
/* What the change implies is taken so many times: where several causes leave errors, the one that falls slowest shows
   least in a change. It is the factor of Roache's grid convergence index for a measured power. */
#define MESHPLAN_SAFETY 1.25
/* Power of CPU seconds over unknowns before two meshes show it, and its bounds. */
#define MESHPLAN_CPU_POWER 1.3
#define MESHPLAN_LEAST_CPU 0.8
#define MESHPLAN_MOST_CPU  2.0
/* Memory (MB) for each unknown more: a factor of a plane model of some thousands takes less, one in space more. */
#define MESHPLAN_MEMORY 0.01

static double Within(double value, double least, double most)
{
  return isfinite(value) ? fmin(fmax(value, least), most) : least;
}

/* The power that is assumed before it is measured. The one that smooth solutions have is twice the order; edges of
   contact and corners make it smaller. */
static double FirstRate(int order)
{
  return order + 1;
}

/* The power with which the error falls with the factor. */
static double Rate(int n, const MeshFigures m[], int order)
{
  if (n < 2) return FirstRate(order);
  return Within(log(m[n - 2].error / m[n - 1].error) / log(m[n - 1].factor / m[n - 2].factor), MESHPLAN_LEAST_RATE,
                2 * order);
}

/* MeshPlanFactor - gives the factor of the next mesh. n: meshes so far, at least 1; order: of the elements; wanted:
   error of the next mesh. */
double MeshPlanFactor(int n, const MeshFigures m[], int order, double wanted)
{
  const MeshFigures *last = &m[n - 1];

  return last->factor * Within(pow(last->error / wanted, 1 / Rate(n, m, order)), MESHPLAN_FINER, MESHPLAN_FINEST);
}

/* MeshPlanForecast - gives the figures that a mesh is to be expected to have. n: meshes so far, at least 1. */
MeshFigures MeshPlanForecast(int n, const MeshFigures m[], int dim, int order, double factor)
{
  const MeshFigures *last  = &m[n - 1];
  const double       finer = factor / last->factor;
  double             power = MESHPLAN_CPU_POWER, memory = MESHPLAN_MEMORY;
  MeshFigures        next = {.factor = factor, .unknowns = last->unknowns * pow(finer, dim)};

  if (n > 1) {
    power  = Within(log(last->cpu_s / m[n - 2].cpu_s) / log(last->unknowns / m[n - 2].unknowns), MESHPLAN_LEAST_CPU,
                    MESHPLAN_MOST_CPU);
    memory = fmax((last->rss_mb - m[n - 2].rss_mb) / (last->unknowns - m[n - 2].unknowns), 0);
  }
  next.error  = last->error * pow(finer, -Rate(n, m, order));
  next.cpu_s  = last->cpu_s * pow(next.unknowns / last->unknowns, power);
  next.rss_mb = last->rss_mb + memory * (next.unknowns - last->unknowns);
  return next;
}

/* MeshPlanImplied - gives the error of the last of two meshes that the change of the answer implies. change: of the
   answer; fall: estimated error of the last mesh over that of the one before; finer: all elements became smaller by
   this factor, or 0; order: of the elements. */
double MeshPlanImplied(double change, double fall, double finer, int order)
{
  const double most = finer > 1 ? pow(finer, -FirstRate(order)) : 0,
               left = isfinite(fall) ? fmin(fmax(fall, most), MESHPLAN_SLOWEST) : MESHPLAN_SLOWEST;

  return MESHPLAN_SAFETY * fabs(change) * left / (1 - left);
}
