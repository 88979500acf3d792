/* Integrals over one cell at a time: volume, quality, body force and stress. They are called once for each step or run,
   not for each iteration, so they are not batched. */
#include "elementbatch.h"
#include "lawconstants.h"
#include <float.h>
#include <math.h>
#include <stddef.h>

/* J[k][m] = dX_m/dxi_k; returns its determinant. */
static double Jacobian(int nodes, int dim, const double *dN, int stride, const double *X, double J[3][3])
{
  for (int k = 0; k < dim; k++) {
    for (int m = 0; m < dim; m++) {
      J[k][m] = 0;
      for (int a = 0; a < nodes; a++) J[k][m] += dN[a * stride + k] * X[a * dim + m];
    }
  }
  if (dim == 2) return J[0][0] * J[1][1] - J[0][1] * J[1][0];
  return J[0][0] * (J[1][1] * J[2][2] - J[1][2] * J[2][1]) + J[0][1] * (J[1][2] * J[2][0] - J[1][0] * J[2][2]) +
         J[0][2] * (J[1][0] * J[2][1] - J[1][1] * J[2][0]);
}

static double Radius(const Element *e, int p, int dim, const double *X)
{
  double radius = 0;

  for (int a = 0; a < e->nodes; a++) radius += e->N[p][a] * X[a * dim];
  return radius;
}

/* Reference volume of quadrature point p */
static double PointVolume(const Element *e, int p, int dim, Geometry geometry, const double *X, double J[3][3])
{
  const double volume = e->weight[p] * Jacobian(e->nodes, dim, e->dN[p][0], 3, X, J);

  return geometry == GEOMETRY_AXISYMMETRIC ? volume * two_pi * Radius(e, p, dim, X) : volume;
}

/* Computes the Cauchy stress (P F^T + pressure) / det F. With small strains it is P + pressure. */
static void CauchyStress(const double H[9], const double P[9], double pressure, int finite, double stress[6])
{
  static const int component[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  double           F[9], determinant;

  for (int r = 0; r < 9; r++) F[r] = finite ? H[r] + (r % 4 == 0) : (r % 4 == 0);
  determinant =
    F[0] * (F[4] * F[8] - F[5] * F[7]) + F[1] * (F[5] * F[6] - F[3] * F[8]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
  for (int c = 0; c < 6; c++) {
    const int i = component[c][0], j = component[c][1];

    stress[c] =
      (P[3 * i] * F[3 * j] + P[3 * i + 1] * F[3 * j + 1] + P[3 * i + 2] * F[3 * j + 2] + (i == j) * pressure) /
      determinant;
  }
}

/* Stress of a plastic law at one point */
static void PlasticStress(const KernelCase *kernel, const double *X, const double *u, const double *constants, int p,
                          const double H[9], double P[9])
{
  const PlasticBatch *plastic = kernel->plastic;
  const int           states  = ElementStates(kernel);
  const int           at      = ElementStatePoints(kernel) - ElementGet(kernel->type)->points + p;
  const Lanes         bulk = (Lanes){0} + constants[0], shear = (Lanes){0} + constants[1];
  Lanes               lanes_H[9], lanes_P[9], state[PLASTIC_MAX_STATE], dilatation;

  if (plastic->umat) {
    const UmatPlace place = UmatPlaceAt(ElementGet(kernel->type), kernel->kinematics == KINEMATICS_FINITE, plastic,
                                        plastic->lane, p, X, u, 1);
    double          W;

    (void)UmatPoint(plastic->umat, &place, H, &plastic->state[at * states * KERNEL_LANES + plastic->lane], KERNEL_LANES,
                    &W, P, NULL, NULL, NULL, NULL);
    return;
  }
  for (int r = 0; r < 9; r++) lanes_H[r] = (Lanes){0} + H[r];
  for (int k = 0; k < states; k++)
    state[k] = (Lanes){0} + plastic->state[(at * states + k) * KERNEL_LANES + plastic->lane];
  MaterialDilatation(lanes_H, &dilatation);
  VonMisesLaw(kernel->kinematics == KINEMATICS_FINITE, lanes_H, &dilatation, &bulk, &shear, plastic->hardening,
              plastic->dt, state, NULL, lanes_P, NULL, NULL);
  for (int r = 0; r < 9; r++) P[r] = lanes_P[r][0];
}

/*@
  ElementLawConstants - takes the constants with which a law is evaluated at one point, and returns their number.

  Not collective

  Input Parameters:
+ kernel    - of the element
- constants - of the law

  Output Parameter:
. used - the constants; in a mixed element without the bulk modulus, as the pressure takes its place
@*/
int ElementLawConstants(const KernelCase *kernel, const double *constants, double used[MATERIAL_MAX_CONSTANTS])
{
  const int n = kernel->n_constants ? kernel->n_constants : MaterialGetLaw(kernel->law)->constants;

  for (int k = 0; k < n; k++) used[k] = constants[k];
  if (kernel->formulation == FORMULATION_MIXED) used[0] = 0; /* the pressure takes the place of this part */
  return n;
}

/* First Piola-Kirchhoff stress of the law at one point, without the pressure of a mixed element. used: n constants of
   ElementLawConstants(). */
static void LawStress(const KernelCase *kernel, const double *X, const double *u, int n, const double *used, int p,
                      const double H[9], double P[9])
{
  if (kernel->plastic)
    PlasticStress(kernel, X, u, used, p, H, P);
  else
    MaterialEvaluate(kernel->law, n, used, H, NULL, P, NULL);
}

/*@
  ElementPointStress - computes the Cauchy stress at the quadrature points of one element.

  Not collective

  Input Parameters:
+ kernel    - element type, geometry, kinematics and law
. X         - reference coordinates (length) [nodes][dim]; axisymmetric: X[.][0] is the radius
. u         - displacements (length) [nodes][dim]
. constants  - of the law [n_constants]
- multiplier - of a mixed element (stress times root of volume) [pressures]; NULL: they are 0

  Output Parameters:
+ stress - xx yy zz xy yz xz at each point [points][6]; axisymmetric: rr zz hoop rz 0 0
- volume - reference volume of each point [points]
@*/
void ElementPointStress(const KernelCase *kernel, const double *X, const double *u, const double *constants,
                        const double *multiplier, double *stress, double *volume)
{
  const Element *e      = ElementGet(kernel->type);
  const int      finite = kernel->kinematics == KINEMATICS_FINITE;
  double         H[ELEMENT_MAX_POINTS * 9], pressure[ELEMENT_MAX_POINTS], used[MATERIAL_MAX_CONSTANTS];
  const int      n = ElementLawConstants(kernel, constants, used);

  ElementPointState(kernel, X, u, constants, multiplier, H, pressure);
  for (int p = 0; p < e->points; p++) {
    double J[3][3], P[9];

    volume[p] = PointVolume(e, p, e->dim, kernel->geometry, X, J);
    LawStress(kernel, X, u, n, used, p, &H[9 * p], P);
    CauchyStress(&H[9 * p], P, pressure[p], finite, &stress[6 * p]);
  }
}

/* Adds the stress pressure F^-T of a mixed element, with small strains pressure 1, to P. */
static void AddPressureStress(const double H[9], double pressure, int finite, double P[9])
{
  double F[9], determinant = 0;

  for (int r = 0; r < 9; r++) F[r] = (finite ? H[r] : 0) + (r % 4 == 0);
  for (int J = 0; J < 3; J++)
    determinant += F[J] * (F[3 + (J + 1) % 3] * F[6 + (J + 2) % 3] - F[3 + (J + 2) % 3] * F[6 + (J + 1) % 3]);
  for (int i = 0; i < 3; i++) {
    for (int J = 0; J < 3; J++) {
      const int i1 = 3 * ((i + 1) % 3), i2 = 3 * ((i + 2) % 3), J1 = (J + 1) % 3, J2 = (J + 2) % 3;

      P[3 * i + J] += pressure * (F[i1 + J1] * F[i2 + J2] - F[i1 + J2] * F[i2 + J1]) / determinant;
    }
  }
}

/* First Piola-Kirchhoff stresses of the law at point p of LANES elements of a batch, without the pressure of mixed
   elements. */
static void PartStress(const KernelCase *kernel, int part, const double *constants, int p, const double *H, double *P)
{
  const PlasticBatch *plastic = kernel->plastic;
  const ElasticLaw   *law     = MaterialGetLaw(kernel->law);
  const int           n       = kernel->n_constants ? kernel->n_constants : law->constants;
  Lanes               lanes_H[9], lanes_P[9], used[MATERIAL_MAX_CONSTANTS], state[PLASTIC_MAX_STATE], dilatation;

  for (int r = 0; r < 9; r++) lanes_H[r] = CONST_LANE(H + part, 9 * p + r);
  for (int k = 0; k < n; k++) used[k] = CONST_LANE(constants + part, k);
  if (kernel->formulation == FORMULATION_MIXED) used[0] = (Lanes){0};
  MaterialDilatation(lanes_H, &dilatation);
  if (plastic) {
    const int states = ElementStates(kernel), at = ElementStatePoints(kernel) - ElementGet(kernel->type)->points + p;

    for (int k = 0; k < states; k++) state[k] = CONST_LANE(plastic->state + part, at * states + k);
    VonMisesLaw(kernel->kinematics == KINEMATICS_FINITE, lanes_H, &dilatation, &used[0], &used[1], plastic->hardening,
                plastic->dt, state, NULL, lanes_P, NULL, NULL);
  } else
    law->evaluate(lanes_H, &dilatation, n, used, NULL, lanes_P, NULL);
  for (int r = 0; r < 9; r++) LANE(P + part, 9 * p + r) = lanes_P[r];
}

/* Likewise of a routine of the user, one element after the other. */
static void RoutineStress(const KernelCase *kernel, const double *X, const double *u, int p, const double *H, double *P)
{
  const PlasticBatch *plastic = kernel->plastic;
  const int           states  = ElementStates(kernel);
  const int           at      = ElementStatePoints(kernel) - ElementGet(kernel->type)->points + p;

  for (int lane = 0; lane < KERNEL_LANES; lane++) {
    const UmatPlace place = UmatPlaceAt(ElementGet(kernel->type), kernel->kinematics == KINEMATICS_FINITE, plastic,
                                        lane, p, X + lane, u + lane, KERNEL_LANES);
    double          H_at[9], P_at[9], W;

    for (int r = 0; r < 9; r++) H_at[r] = H[(9 * p + r) * KERNEL_LANES + lane];
    (void)UmatPoint(plastic->umat, &place, H_at, &plastic->state[at * states * KERNEL_LANES + lane], KERNEL_LANES, &W,
                    P_at, NULL, NULL, NULL, NULL);
    for (int r = 0; r < 9; r++) P[(9 * p + r) * KERNEL_LANES + lane] = P_at[r];
  }
}

/* Adds the stress pressure F^-T of mixed elements, with small strains pressure 1, at point p. */
static void AddPressureStresses(int finite, int p, const double *H, const double *pressure, double *P)
{
  for (int lane = 0; lane < KERNEL_LANES; lane++) {
    double H_at[9], P_at[9] = {0};

    for (int r = 0; r < 9; r++) H_at[r] = H[(9 * p + r) * KERNEL_LANES + lane];
    AddPressureStress(H_at, pressure[p * KERNEL_LANES + lane], finite, P_at);
    for (int r = 0; r < 9; r++) P[(9 * p + r) * KERNEL_LANES + lane] += P_at[r];
  }
}

/*@
  ElementBatchNominal - computes displacement gradients and first Piola-Kirchhoff stresses at the quadrature points of a
  batch of KERNEL_LANES elements.

  Not collective

  Input Parameters:
+ kernel     - element type, geometry, kinematics, law and formulation of the batch
. X          - reference coordinates (length) [nodes][dim][lanes]; axisymmetric: X[.][0] is the radius
. u          - displacements (length) [nodes][dim][lanes]
. constants  - of the law [n_constants][lanes]
- multiplier - of mixed elements (stress times root of volume) [pressures][lanes]; NULL: they are 0

  Output Parameters:
+ H        - as of ElementBatchStates() [points][9][lanes]
. pressure - likewise [points][lanes]
- P        - at 3 i + I, with the pressure of a mixed element; with small strains the stress [points][9][lanes]; or NULL
@*/
void ElementBatchNominal(const KernelCase *kernel, const double *X, const double *u, const double *constants,
                         const double *multiplier, double *H, double *pressure, double *P)
{
  const int finite = kernel->kinematics == KINEMATICS_FINITE;

  ElementBatchStates(kernel, X, u, constants, multiplier, H, pressure);
  for (int p = 0; p < ElementGet(kernel->type)->points && P; p++) {
    if (kernel->plastic && kernel->plastic->umat)
      RoutineStress(kernel, X, u, p, H, P);
    else
      for (int part = 0; part < KERNEL_LANES; part += LANES) PartStress(kernel, part, constants, p, H, P);
    if (kernel->formulation == FORMULATION_MIXED) AddPressureStresses(finite, p, H, pressure, P);
  }
}

/*@
  ElementStress - computes the Cauchy stress of one element, averaged over its volume.

  Not collective

  Input Parameters:
+ kernel    - element type, geometry, kinematics and law
. X         - reference coordinates (length) [nodes][dim]; axisymmetric: X[.][0] is the radius
. u         - displacements (length) [nodes][dim]
. constants  - of the law [n_constants]
- multiplier - of a mixed element (stress times root of volume) [pressures]; NULL: they are 0

  Output Parameters:
+ stress - xx yy zz xy yz xz; axisymmetric: rr zz hoop rz 0 0
- volume - reference volume; axisymmetric: over 360 degrees
@*/
void ElementStress(const KernelCase *kernel, const double *X, const double *u, const double *constants,
                   const double *multiplier, double stress[6], double *volume)
{
  const int points = ElementGet(kernel->type)->points;
  double    point_stress[ELEMENT_MAX_POINTS * 6], point_volume[ELEMENT_MAX_POINTS];

  ElementPointStress(kernel, X, u, constants, multiplier, point_stress, point_volume);
  *volume = 0;
  for (int c = 0; c < 6; c++) stress[c] = 0;
  for (int p = 0; p < points; p++) {
    *volume += point_volume[p];
    for (int c = 0; c < 6; c++) stress[c] += point_volume[p] * point_stress[6 * p + c];
  }
  for (int c = 0; c < 6; c++) stress[c] /= *volume;
}

/*@
  ElementVolumeEnergy - computes the part of one element's energy that belongs to the volume alone.

  Not collective

  Input Parameters:
+ kernel    - element type, geometry, kinematics and law
. X         - reference coordinates (length) [nodes][dim]; axisymmetric: X[.][0] is the radius
. u         - displacements (length) [nodes][dim] of an element that is not inverted
. constants  - of the law
- multiplier - of a mixed element [pressures]; NULL: they are 0

  Note:
  It is 0 with small strains and with laws that are not separable, see ElasticLaw. With multipliers it has a constant
  part, the same at every u.
@*/
double ElementVolumeEnergy(const KernelCase *kernel, const double *X, const double *u, const double *constants,
                           const double *multiplier)
{
  const int      mixed  = kernel->formulation == FORMULATION_MIXED;
  const Element *e      = ElementGet(kernel->type);
  double         energy = 0, modulus = constants[0], H[ELEMENT_MAX_POINTS * 9], pressure[ELEMENT_MAX_POINTS];

  if (!MaterialGetLaw(kernel->law)->separable || kernel->kinematics == KINEMATICS_SMALL) return 0;
  if (mixed) {
    VolumeModuli moduli;

    ElementVolumeModuli(kernel, constants, 1, &moduli);
    modulus = moduli.kappa + moduli.local;
  }
  ElementPointState(kernel, X, u, constants, multiplier, H, pressure);
  for (int p = 0; p < e->points; p++) {
    const double *h = &H[9 * p];
    double        J[3][3], log_J;

    log_J = log((1 + h[0]) * ((1 + h[4]) * (1 + h[8]) - h[5] * h[7]) - h[1] * (h[3] * (1 + h[8]) - h[5] * h[6]) +
                h[2] * (h[3] * h[7] - (1 + h[4]) * h[6]));
    energy += (mixed ? pressure[p] * pressure[p] / modulus : modulus * log_J * log_J) / 2 *
              PointVolume(e, p, e->dim, kernel->geometry, X, J);
  }
  return energy;
}

/*@
  ElementQuality - computes the scaled Jacobian of one cell, which says how far it is from a parallelepiped.

  Not collective

  Input Parameters:
+ type - element type of a cell
. dim  - its dimension
- X    - reference coordinates (length) [nodes][dim]

  Output Parameter:
. quality - smallest determinant of dX/dxi at nodes and quadrature points, divided by its mean

  Note:
  The value is 1 for a parallelepiped and not positive for an inverted cell. It is -1 if the mean is not positive.
@*/
double ElementQuality(ElementType type, int dim, const double *X)
{
  const Element *e     = ElementGet(type);
  double         least = DBL_MAX, mean = 0, total = 0, J[3][3], dN[ELEMENT_MAX_NODES * 3];

  for (int p = 0; p < e->points; p++) {
    const double determinant = Jacobian(e->nodes, dim, e->dN[p][0], 3, X, J);

    least = fmin(least, determinant);
    mean += e->weight[p] * determinant;
    total += e->weight[p];
  }
  for (int a = 0; a < e->nodes; a++) {
    ElementShape(type, e->node[a], NULL, dN, NULL);
    least = fmin(least, Jacobian(e->nodes, dim, dN, dim, X, J));
  }
  return mean > 0 ? least * total / mean : -1;
}

/*@
  BodyForceKernel - adds the external force of a body force on one cell.

  Not collective

  Input Parameters:
+ type     - element type of a cell
. dim      - its dimension
. geometry - axisymmetric: forces over 360 degrees
. X        - reference coordinates (length) [nodes][dim]
. value    - force per reference volume [dim]
- stride   - of value from one quadrature point to the next; 0 if the force is constant

  Output Parameter:
. f - nodal forces [nodes][dim], added to
@*/
void BodyForceKernel(ElementType type, int dim, Geometry geometry, const double *X, const double *value, int stride,
                     double *f)
{
  const Element *e = ElementGet(type);

  for (int p = 0; p < e->points; p++) {
    double       J[3][3];
    const double volume = PointVolume(e, p, dim, geometry, X, J);

    for (int a = 0; a < e->nodes; a++) {
      for (int i = 0; i < dim; i++) f[a * dim + i] += volume * e->N[p][a] * value[p * stride + i];
    }
  }
}

/*@
  ElementPointVolumes - computes the reference volumes of the quadrature points of one cell.

  Not collective

  Input Parameters:
+ type     - element type of a cell
. dim      - its dimension
. geometry - solid, plane strain or axisymmetric
- X        - reference coordinates (length) [nodes][dim]

  Output Parameter:
. volume - as CellVolume() sums them [points]
@*/
void ElementPointVolumes(ElementType type, int dim, Geometry geometry, const double *X, double *volume)
{
  const Element *e = ElementGet(type);
  double         J[3][3];

  for (int p = 0; p < e->points; p++) volume[p] = PointVolume(e, p, dim, geometry, X, J);
}

/*@
  ElementStateVolumes - computes the reference volumes of the points of an element that have a plastic state.

  Not collective

  Input Parameters:
+ kernel - element type, geometry and formulation
- X      - reference coordinates (length) [nodes][dim]; axisymmetric: X[.][0] is the radius

  Output Parameter:
. volume - [ElementStatePoints()]; 0 of points that give results alone
@*/
void ElementStateVolumes(const KernelCase *kernel, const double *X, double *volume)
{
  const Element *e = ElementGet(kernel->type);

  if (ElementStatePoints(kernel) == e->points) {
    ElementPointVolumes(kernel->type, e->dim, kernel->geometry, X, volume);
    return;
  }
  MixedPointVolumes(e, kernel->geometry, X, volume);
  for (int p = MixedPoints(e); p < ElementStatePoints(kernel); p++) volume[p] = 0;
}

/*@
  CellVolume - returns the volume of one cell by its quadrature. In 2D this is the area, or the volume over 360 degrees
  if axisymmetric.

  Not collective

  Input Parameters:
+ type     - element type of a cell
. dim      - its dimension
. geometry - solid, plane strain or axisymmetric
- X        - reference coordinates (length) [nodes][dim]
@*/
double CellVolume(ElementType type, int dim, Geometry geometry, const double *X)
{
  const Element *e      = ElementGet(type);
  double         volume = 0, J[3][3];

  for (int p = 0; p < e->points; p++) volume += PointVolume(e, p, dim, geometry, X, J);
  return volume;
}

/*@
  CellLength - returns a length of one cell: the side of the square or cube with its area or volume, over its order.

  Not collective

  Input Parameters:
+ type - of the cell
. dim  - number of coordinates
- X    - of its nodes (length) [nodes][dim]
@*/
double CellLength(ElementType type, int dim, const double *X)
{
  const double volume = CellVolume(type, dim, dim == 3 ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN, X);

  return (dim == 3 ? cbrt(volume) : sqrt(volume)) / ElementGet(type)->order;
}

/*@
  CellVolumeGradient - computes the derivatives of the volume of one cell by the coordinates of its nodes.

  Not collective

  Input Parameters:
+ type     - element type of a cell
. dim      - its dimension
. geometry - solid, plane strain or axisymmetric
- X        - reference coordinates (length) [nodes][dim]

  Output Parameter:
. gradient - [nodes][dim]
@*/
void CellVolumeGradient(ElementType type, int dim, Geometry geometry, const double *X, double *gradient)
{
  const Element *e = ElementGet(type);

  for (int k = 0; k < e->nodes * dim; k++) gradient[k] = 0;
  for (int p = 0; p < e->points; p++) {
    double       J[3][3] = {{0}};
    const double volume  = PointVolume(e, p, dim, geometry, X, J),
                 ring    = geometry == GEOMETRY_AXISYMMETRIC ? two_pi * Radius(e, p, dim, X) : 1;

    if (dim == 2) J[2][2] = 1;
    for (int a = 0; a < e->nodes; a++) {
      for (int m = 0; m < dim; m++) {
        const int m1 = (m + 1) % 3, m2 = (m + 2) % 3;

        for (int k = 0; k < dim; k++) { /* the cofactors of J */
          const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;

          gradient[a * dim + m] +=
            e->weight[p] * ring * (J[k1][m1] * J[k2][m2] - J[k1][m2] * J[k2][m1]) * e->dN[p][a][k];
        }
        if (geometry == GEOMETRY_AXISYMMETRIC && m == 0)
          gradient[a * dim] += volume * e->N[p][a] / Radius(e, p, dim, X);
      }
    }
  }
}
