/* Integrals over one face at a time: tractions, dead and follower pressure with their tangent, tributary areas and
   normals, products of shape functions. */
#include "kernels/elementkernel.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

static const double two_pi = 6.28318530717958647693;

/* A quadrature point of a face in one configuration */
typedef struct {
  double tangent[2][3]; /* dx/dxi_k; 2D: only k = 0 */
  double normal[3];     /* its length is the area of the point without weight and radius */
  double radius;        /* x[0] */
} FacePoint;

static void FacePointAt(const Element *e, int p, int dim, const double *X, const double *u, FacePoint *point)
{
  *point = (FacePoint){0};
  for (int a = 0; a < e->nodes; a++) {
    for (int m = 0; m < dim; m++) {
      const double x = X[a * dim + m] + (u ? u[a * dim + m] : 0);

      for (int k = 0; k < dim - 1; k++) point->tangent[k][m] += e->dN[p][a][k] * x;
      if (m == 0) point->radius += e->N[p][a] * x;
    }
  }
  if (dim == 2) {
    point->normal[0] = point->tangent[0][1];
    point->normal[1] = -point->tangent[0][0];
  } else {
    for (int m = 0; m < 3; m++) {
      const int m1 = (m + 1) % 3, m2 = (m + 2) % 3;

      point->normal[m] = point->tangent[0][m1] * point->tangent[1][m2] - point->tangent[0][m2] * point->tangent[1][m1];
    }
  }
}

/* Area of a point without weight and radius. */
static double PointArea(const FacePoint *point)
{
  return sqrt(point->normal[0] * point->normal[0] + point->normal[1] * point->normal[1] +
              point->normal[2] * point->normal[2]);
}

/* Derivative of the normal by displacement j of node b */
static void NormalVariation(const Element *e, int p, int dim, const FacePoint *point, int b, int j, double variation[3])
{
  if (dim == 2) {
    variation[0] = j == 1 ? e->dN[p][b][0] : 0;
    variation[1] = j == 0 ? -e->dN[p][b][0] : 0;
    return;
  }
  /* v x w with v = e_j dN/dxi_0, w = tangent_1, plus v x w with v = tangent_0, w = e_j dN/dxi_1 */
  for (int m = 0; m < 3; m++) {
    const int m1 = (m + 1) % 3, m2 = (m + 2) % 3;

    variation[m] = e->dN[p][b][0] * ((j == m1) * point->tangent[1][m2] - (j == m2) * point->tangent[1][m1]) +
                   e->dN[p][b][1] * (point->tangent[0][m1] * (j == m2) - point->tangent[0][m2] * (j == m1));
  }
}

/* Adds pressure int N_a d(n da)/du_b to K, which is minus the derivative of the follower pressure's force. Source:
   Bonet and Wood, section 8.5.2, before their step that makes it symmetric. */
static void AddFollowerTangent(const Element *e, int p, int dim, int axisymmetric, const FacePoint *point,
                               double pressure, double *K)
{
  const int    dofs   = e->nodes * dim;
  const double factor = e->weight[p] * pressure * (axisymmetric ? two_pi : 1);

  for (int b = 0; b < e->nodes; b++) {
    for (int j = 0; j < dim; j++) {
      double variation[3];

      NormalVariation(e, p, dim, point, b, j, variation);
      for (int i = 0; i < dim && axisymmetric; i++)
        variation[i] = variation[i] * point->radius + (j == 0 ? point->normal[i] * e->N[p][b] : 0);
      for (int a = 0; a < e->nodes; a++) {
        for (int i = 0; i < dim; i++) K[(a * dim + i) * dofs + b * dim + j] += factor * e->N[p][a] * variation[i];
      }
    }
  }
}

/*@
  FaceLoadKernel - adds external force, tangent and potential of a load on one face.

  Not collective

  Input Parameters:
+ type     - element type of the face, nodes in the order that makes its normal point outward
. dim      - dimension of the space, 2 or 3
. geometry - axisymmetric: forces over 360 degrees, X[.][0] is the radius
. load     - traction, dead pressure or follower pressure
. X        - reference coordinates (length) [nodes][dim]
. u        - displacements (length) [nodes][dim]
. value    - traction (force per reference area) [dim], or the pressure, which is positive if it pushes on the face
- stride   - of value from one quadrature point to the next; 0 if the load is constant

  Output Parameters:
+ f      - external force [nodes][dim], added to
. K      - minus its derivative by u [nodes*dim][nodes*dim], added to, or NULL
- energy - potential -int t.u of the load, added to, or NULL

  Note:
  K is zero for dead loads and unsymmetric for a follower pressure. A follower pressure has no potential, so nothing is
  added to energy.

  Source:
  Bonet and Wood, "Nonlinear Continuum Mechanics for Finite Element Analysis", section 8.5.2
@*/
void FaceLoadKernel(ElementType type, int dim, Geometry geometry, FaceLoad load, const double *X, const double *u,
                    const double *value, int stride, double *f, double *K, double *energy)
{
  const Element *e            = ElementGetFace(type);
  const int      axisymmetric = geometry == GEOMETRY_AXISYMMETRIC, follows = load == FACE_FOLLOWER_PRESSURE;

  for (int p = 0; p < e->points; p++) {
    const double *at = &value[p * stride];
    FacePoint     point;
    double        force[3], scale = e->weight[p];

    FacePointAt(e, p, dim, X, follows ? u : NULL, &point);
    if (axisymmetric) scale *= two_pi * point.radius;
    for (int i = 0; i < dim; i++) {
      if (load == FACE_TRACTION)
        force[i] = scale * at[i] * PointArea(&point);
      else
        force[i] = -scale * at[0] * point.normal[i];
    }
    for (int a = 0; a < e->nodes; a++) {
      for (int i = 0; i < dim; i++) {
        f[a * dim + i] += e->N[p][a] * force[i];
        if (energy && !follows) *energy -= e->N[p][a] * force[i] * u[a * dim + i];
      }
    }
    if (K && follows) AddFollowerTangent(e, p, dim, axisymmetric, &point, at[0], K);
  }
}

/*@
  FaceAreaKernel - adds tributary areas and normals of the nodes of one face.

  Not collective

  Input Parameters:
+ type     - element type of the face, nodes in the order that makes its normal point outward
. dim      - dimension of the space, 2 or 3
. geometry - axisymmetric: areas over 360 degrees, X[.][0] is the radius
- X        - coordinates (length) [nodes][dim], reference or current

  Output Parameters:
+ area   - int N_a dA [nodes], added to; negative or zero at corners of second-order triangles
- normal - int N_a n dA [nodes][dim], added to, or NULL
@*/
void FaceAreaKernel(ElementType type, int dim, Geometry geometry, const double *X, double *area, double *normal)
{
  const Element *e = ElementGetFace(type);

  for (int p = 0; p < e->points; p++) {
    FacePoint point;
    double    scale = e->weight[p];

    FacePointAt(e, p, dim, X, NULL, &point);
    if (geometry == GEOMETRY_AXISYMMETRIC) scale *= two_pi * point.radius;
    for (int a = 0; a < e->nodes; a++) {
      area[a] += scale * e->N[p][a] * PointArea(&point);
      for (int i = 0; i < dim && normal; i++) normal[a * dim + i] += scale * e->N[p][a] * point.normal[i];
    }
  }
}

/*@
  FaceMassKernel - computes the integrals of the products of a face's shape functions.

  Not collective

  Input Parameters:
+ type     - element type of the face
. dim      - dimension of the space, 2 or 3
. geometry - axisymmetric: areas over 360 degrees, X[.][0] is the radius
- X        - reference coordinates (length) [nodes][dim]

  Output Parameter:
. matrix - int N_a N_b dA [nodes][nodes] (area)
@*/
void FaceMassKernel(ElementType type, int dim, Geometry geometry, const double *X, double *matrix)
{
  const Element *e = ElementGetFace(type);

  memset(matrix, 0, sizeof(*matrix) * (size_t)(e->nodes * e->nodes));
  for (int p = 0; p < e->points; p++) {
    FacePoint point;
    double    area;

    FacePointAt(e, p, dim, X, NULL, &point);
    area = e->weight[p] * PointArea(&point) * (geometry == GEOMETRY_AXISYMMETRIC ? two_pi * point.radius : 1);
    for (int a = 0; a < e->nodes; a++)
      for (int b = 0; b < e->nodes; b++) matrix[a * e->nodes + b] += area * e->N[p][a] * e->N[p][b];
  }
}
