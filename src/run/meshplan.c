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
/* This factor counts for a power that is assumed, as long as there are two meshes. */
#define MESHPLAN_TWO_MESHES 3
/* Power with which the error of a contact zone's end falls with the size of the elements there. */
#define MESHPLAN_ZONE_RATE 2
/* Of the error that is wanted, that of the contact zone gets this part, where there is any: few elements take it away.
 */
#define MESHPLAN_ZONE_SHARE 0.25
/* The zone becomes at most so much finer for an error that is implied. */
#define MESHPLAN_ZONE_FINEST 0.25
/* The next mesh leaves at most this part of the error that the shares of the cells show: what they do not see may be in
   the bodies, too, and the change of the answer is to tell something. The zone has this part of its size where nothing
   is known of its error. */
#define MESHPLAN_PART 0.5
/* Power with which a quantity without an estimate is taken to converge: peaks and ends of contact zones follow the size
   of the elements. */
#define MESHPLAN_ROUGH_RATE 1
/* A change is forecast where the estimates of two meshes miss no more than this part of what they forecast: as much as
   what recovered fields give may be off. */
#define MESHPLAN_FORETOLD 0.5
/* Power of CPU seconds over unknowns before two meshes show it, and its bounds. A coarse mesh takes hardly more than
   what starts a run, so that the power shows too small; the least one is that of a sparse factor in the plane, and in
   space. */
#define MESHPLAN_CPU_POWER   1.3
#define MESHPLAN_LEAST_PLANE 1.0
#define MESHPLAN_LEAST_SOLID 1.6
#define MESHPLAN_MOST_CPU    2.0
/* Memory (MB) for each unknown more: a factor of a plane model of some thousands takes less, one in space more. */
#define MESHPLAN_MEMORY 0.01

/* Halvings of the bracket of a factor between MESHPLAN_FINER and MESHPLAN_FINEST */
enum { MESHPLAN_HALVINGS = 20 };

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
    power  = Within(log(last->cpu_s / m[n - 2].cpu_s) / log(last->unknowns / m[n - 2].unknowns),
                   dim == 3 ? MESHPLAN_LEAST_SOLID : MESHPLAN_LEAST_PLANE, MESHPLAN_MOST_CPU);
    memory = fmax((last->rss_mb - m[n - 2].rss_mb) / (last->unknowns - m[n - 2].unknowns), 0);
  }
  next.error  = last->error * pow(finer, -Rate(n, m, order));
  next.cpu_s  = last->cpu_s * pow(next.unknowns / last->unknowns, power);
  next.rss_mb = last->rss_mb + memory * (next.unknowns - last->unknowns);
  return next;
}

/* Is a mesh within limits? */
static int Fits(MeshFigures mesh, MeshFigures limit)
{
  return !(limit.cpu_s > 0 && mesh.cpu_s > limit.cpu_s) && !(limit.rss_mb > 0 && mesh.rss_mb > limit.rss_mb);
}

/* MeshPlanLargest - gives the factor of the largest mesh that may be made. n: meshes so far, at least 1; limit: CPU
   seconds and memory of a mesh, 0: none. It is 0 where none is within the limits that is finer by a step. */
double MeshPlanLargest(int n, const MeshFigures m[], int dim, int order, MeshFigures limit)
{
  double low = MESHPLAN_FINER, high = MESHPLAN_FINEST;

  if (!Fits(MeshPlanForecast(n, m, dim, order, low * m[n - 1].factor), limit)) return 0;
  if (Fits(MeshPlanForecast(n, m, dim, order, high * m[n - 1].factor), limit)) return high * m[n - 1].factor;
  for (int k = 0; k < MESHPLAN_HALVINGS; k++) {
    const double middle = sqrt(low * high);

    if (Fits(MeshPlanForecast(n, m, dim, order, middle * m[n - 1].factor), limit))
      low = middle;
    else
      high = middle;
  }
  return low * m[n - 1].factor;
}

/* The part that is left of an error from one mesh to the next, where elements became smaller by the shares of the
   cells. An error that these do not see is that of the contact zone, or falls more slowly than they do: its power is
   taken as half of theirs. What the shares themselves miss falls as they do. */
static double AdaptedPart(const MeshChange *c)
{
  return c->zone > 0 ? fmax(c->fall, pow(c->zone, -MESHPLAN_ZONE_RATE)) : sqrt(c->fall);
}

/* The part that is left of an error from one mesh to the next. */
static double PartLeft(const MeshChange *c, int order)
{
  const double rate  = isnan(c->estimate) ? MESHPLAN_ROUGH_RATE : FirstRate(order),
               least = c->finer > 1 ? pow(c->finer, -rate) : 0;

  if (isnan(c->estimate)) return least > 0 ? fmin(least, MESHPLAN_SLOWEST) : MESHPLAN_SLOWEST;
  if (!isfinite(c->fall)) return MESHPLAN_SLOWEST;
  return fmin(c->even ? fmax(c->fall, least) : AdaptedPart(c), MESHPLAN_SLOWEST);
}

/* The part of the change that the estimates have not forecast. */
static double Unforecast(const MeshChange *c)
{
  return fabs(isnan(c->estimate) ? c->change : c->change - (c->before - c->estimate));
}

/* MeshPlanForetold - says whether the estimates of two meshes have forecast the change of the answer. */
int MeshPlanForetold(const MeshChange *c)
{
  return Unforecast(c) <= MESHPLAN_FORETOLD * fabs(c->before - c->estimate);
}

/* Do sizes by the shares of the cells stand beside those of a zone in contact? */
static int HasZone(const MeshChange *c)
{
  return !c->even && !isnan(c->estimate) && c->zone > 0;
}

/* MeshPlanUnseen - gives the error of the last of two meshes that its estimate does not see. NaN: the mesh before was
   too coarse to tell. order: of the elements. */
double MeshPlanUnseen(const MeshChange *c, int order)
{
  const double left = PartLeft(c, order);

  if (HasZone(c) && Unforecast(c) > fmax(MESHPLAN_TWO_MESHES * c->most, c->allowed)) return NAN;
  return Unforecast(c) * left / (1 - left);
}

/* MeshPlanImplied - gives the error of the last of two meshes that the change of the answer implies. NaN: it implies
   nothing. order: of the elements. */
double MeshPlanImplied(const MeshChange *c, int order)
{
  const double safety = HasZone(c) && !c->known ? MESHPLAN_TWO_MESHES : MESHPLAN_SAFETY;

  return (isnan(c->estimate) ? 0 : MESHPLAN_SAFETY * fabs(c->estimate)) + safety * MeshPlanUnseen(c, order);
}

/* MeshPlanSplit - gives errors of the bodies and of the contact zone their shares. wanted: error that the next mesh is
   to have with the factor of safety; zone: NaN where it is not known. */
MeshWish MeshPlanSplit(double wanted, double bodies, double zone)
{
  const double sum = wanted / MESHPLAN_SAFETY, for_bodies = fmax((1 - MESHPLAN_ZONE_SHARE) * sum, sum - zone),
               for_zone = fmax(MESHPLAN_ZONE_SHARE * sum, sum - bodies);
  MeshWish wish         = {.bodies = fmin(for_bodies / bodies, 1), .zone = MESHPLAN_PART};

  if (!isnan(zone)) wish.zone = fmin(fmax(sqrt(for_zone / zone), MESHPLAN_ZONE_FINEST), 1);
  if (!isnan(zone)) wish.bodies = fmin(wish.bodies, MESHPLAN_PART);
  return wish;
}

/* MeshPlanResolve - gives the part of their size that elements at surfaces in contact are to have where a first mesh
   does not resolve the zone: the end is then to leave no more than the error that is asked for. left: what it may leave
   (ContactZoneLeft()); to: the error over the value. */
double MeshPlanResolve(double left, double to)
{
  return left > to ? sqrt(to / left) : 1;
}
