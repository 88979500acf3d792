/* Sphere, slab and cone that hold a facet, see facethull.h.

   Sphere and slab hold the control points of the facet as a Bezier patch, and so the patch. The cross product of the
   tangents x_,1 and x_,2 differs from that of the middle by at most

       |x_,1| D_2 + |x_,2| D_1 + D_1 D_2

   where the tangents are those of the middle, and D_1 and D_2 bound by how much they change over the facet. That over
   the length of the cross product of the middle bounds the sine of the angle between the two. */
#include "smooth/facethull.h"
#include "facetpolynomial.h"
#include <math.h>
#include <string.h>

/* Length of a vector */
static double Length(const double a[3])
{
  return sqrt(Dot(a, a));
}

/* Bounds the change of the tangents from the middle of the reference polygon to any other place on it: that of a power
   of the coordinates by `most`. Tangents of a triangle are linear. */
static void TangentChanges(const FacetPolynomial *patch, double change[2])
{
  const double most = patch->domain->sides == 3 ? 2. / 3 : 1;

  change[0] = change[1] = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double length = i + j > 1 ? most * Length(patch->c[i][j]) : 0;

      change[0] += i * length;
      change[1] += j * length;
    }
  }
}

/* Normal of the middle, and how far normals turn from it. */
static void TakeNormals(const FacetPolynomial *patch, FacetHull *hull)
{
  const double        *middle = patch->domain->centre;
  FacetPolynomialLocal l;
  double               cross[3], change[2], area;

  FacetPolynomialEvaluate(patch, middle, &l);
  for (int k = 0; k < 3; ++k) cross[k] = l.x1[(k + 1) % 3] * l.x2[(k + 2) % 3] - l.x1[(k + 2) % 3] * l.x2[(k + 1) % 3];
  area       = Length(cross);
  hull->turn = INFINITY;
  memset(hull->normal, 0, sizeof(hull->normal));
  if (!(area > sqrt(FACET_FLAT) * Length(l.x1) * Length(l.x2))) return;
  for (int k = 0; k < 3; ++k) hull->normal[k] = cross[k] / area;
  TangentChanges(patch, change);
  hull->turn = (Length(l.x1) * change[1] + Length(l.x2) * change[0] + change[0] * change[1]) / area;
}

/*@
  FacetHullOf - computes what holds a facet.

  Not collective

  Input Parameters:
+ dim   - 2 or 3
. facet - the facet
- x     - positions of the nodes, x[node][dim] (length)

  Output Parameter:
. hull - sphere, slab and cone

  Note:
  Plain C.
@*/
void FacetHullOf(int dim, const Facet *facet, const double *x, FacetHull *hull)
{
  double                X[FACE_MAX_NODES][3], control[FACE_MAX_NODES][3];
  FacetPolynomialSphere sphere;
  FacetPolynomial       patch;
  const int             nodes = FacetPolynomialGather(dim, facet, x, X);

  FacetPolynomialBound(facet->type, X, &sphere);
  FacetPolynomialCreate(facet->type, X, 2 * sphere.radius, &patch);
  memcpy(hull->centre, sphere.centre, sizeof(hull->centre));
  hull->radius = sphere.radius;
  TakeNormals(&patch, hull);
  FacetPolynomialControl(facet->type, X, control);
  hull->low  = INFINITY;
  hull->high = -INFINITY;
  for (int a = 0; a < nodes; ++a) {
    double height = 0;

    for (int k = 0; k < 3; ++k) height += hull->normal[k] * (control[a][k] - hull->centre[k]);
    hull->low  = fmin(hull->low, height);
    hull->high = fmax(hull->high, height);
  }
}

/*@
  FacetHullSide - tells on which side of a facet a point lies.

  Not collective

  Input Parameters:
+ hull      - of the facet
. point     - the point (length)
- tolerance - nearer to the border of the answer than this, there is none (length)

  Note:
  Returns 1 where the gap of FacetProject() is positive for any foot on the facet, -1 where it is negative, and 0 where
  the hull does not tell. Plain C.
@*/
int FacetHullSide(const FacetHull *hull, const double point[3], double tolerance)
{
  const double way[3] = {point[0] - hull->centre[0], point[1] - hull->centre[1], point[2] - hull->centre[2]};
  const double height = Dot(hull->normal, way), bend = hull->turn > 0 ? hull->turn * (Length(way) + hull->radius) : 0;

  if (height - hull->high > bend + tolerance) return 1;
  if (hull->low - height > bend + tolerance) return -1;
  return 0;
}
