/* The foot of a slave point on a face of the master, the nodal forces of its friction there, and the lever that
   balances their moments. */
#include "frictionfoot.h"
#include <math.h>
#include <string.h>

enum {
  /* Newton's method takes one iteration on flat faces and three to five on curved ones. */
  FOOT_ITERATIONS = 20
};
/* Size of the last step on the reference face; as convergence is quadratic, the next one is below rounding. */
#define FOOT_SETTLED 1e-10
/* A foot this far outside of the reference face, which is 2 wide, is none. The iteration may lead anywhere from there.
 */
#define FOOT_FAR 4.0

/* The inverse of the matrix with the given columns. Returns 0 where it is singular. */
static int Invert(const double a[3], const double b[3], const double c[3], double inverse[3][3])
{
  const double *column[3] = {a, b, c};
  double        det = 0, size = 1;

  for (int i = 0; i < 3; i++) {
    const double *u = column[(i + 1) % 3], *v = column[(i + 2) % 3];

    for (int d = 0; d < 3; d++) inverse[i][d] = u[(d + 1) % 3] * v[(d + 2) % 3] - u[(d + 2) % 3] * v[(d + 1) % 3];
  }
  for (int d = 0; d < 3; d++) det += a[d] * inverse[0][d];
  for (int i = 0; i < 3; i++) {
    double square = 0;

    for (int d = 0; d < 3; d++) square += column[i][d] * column[i][d];
    size *= sqrt(square);
  }
  if (!(fabs(det) > 1e-12 * size)) return 0;
  for (int i = 0; i < 3; i++)
    for (int d = 0; d < 3; d++) inverse[i][d] /= det;
  return 1;
}

/* How far xi is outside of the reference face. */
static double Outside(const Element *e, const double xi[2])
{
  double most = 0;

  if (e->corners == 3) return fmax(0, fmax(-xi[0], fmax(-xi[1], xi[0] + xi[1] - 1)));
  for (int k = 0; k < e->dim; k++) most = fmax(most, fabs(xi[k]) - 1);
  return most;
}

/* Shape functions at xi; returns the point of the face and its tangents. The second tangent of an edge is the third
   axis. */
static void Shapes(int dim, const Element *e, const double *x, FrictionFoot *f, double y[3], double tangent[2][3])
{
  double dN[FACE_MAX_NODES * 2];

  ElementShape(e->type, f->xi, f->N, dN, NULL);
  memset(tangent, 0, 2 * sizeof(*tangent));
  for (int d = 0; d < 3; d++) y[d] = 0;
  if (dim == 2) tangent[1][2] = 1;
  for (int k = 0; k < e->nodes; k++) {
    for (int d = 0; d < dim; d++) y[d] += f->N[k] * x[k * dim + d];
    for (int a = 0; a < e->dim; a++) {
      f->dN[k][a] = dN[k * e->dim + a];
      for (int d = 0; d < dim; d++) tangent[a][d] += f->dN[k][a] * x[k * dim + d];
    }
  }
}

/*@
  FrictionFootFind - finds the foot of a slave point on a face.

  Not collective

  Input Parameters:
+ dim    - 2 or 3
. type   - of the face
. x      - positions of its nodes relative to the slave point (length), dim components each
- normal - of any length but 0

  Output Parameter:
. foot - the foot

  Note:
  Returns 0 where the line does not hit the face or its continuation nearby. Plain C.
@*/
int FrictionFootFind(int dim, ElementType type, const double *x, const double normal[3], FrictionFoot *foot)
{
  const Element *e = ElementGet(type);
  double         y[3], tangent[2][3];
  int            settled = 0;

  *foot = (FrictionFoot){.nodes = e->nodes, .tangents = e->dim};
  if (e->corners == 3) foot->xi[0] = foot->xi[1] = 1.0 / 3;
  for (int d = 0; d < dim; d++) foot->normal[d] = normal[d];
  for (int i = 0; i < FOOT_ITERATIONS; i++) {
    double step = 0;

    Shapes(dim, e, x, foot, y, tangent);
    if (!Invert(foot->normal, tangent[0], tangent[1], foot->inverse)) return 0;
    foot->distance = 0;
    for (int d = 0; d < 3; d++) foot->distance -= foot->inverse[0][d] * y[d];
    if (settled) break;
    for (int a = 0; a < e->dim; a++) {
      double change = 0;

      for (int d = 0; d < 3; d++) change -= foot->inverse[1 + a][d] * y[d];
      foot->xi[a] += change;
      step = fmax(step, fabs(change));
    }
    if (!(step < 1e300) || Outside(e, foot->xi) > FOOT_FAR) return 0;
    settled = step <= FOOT_SETTLED;
  }
  foot->outside = Outside(e, foot->xi);
  return settled;
}

/*@
  FrictionFootVary - gives the derivatives of the force on a node of the master's face, where the force of the slave
  point is held.

  Not collective

  Input Parameters:
+ foot - the foot
. F    - the force of the slave point
- node - of the face

  Output Parameter:
. by - the derivatives

  Note:
  With G = (n, y_,1, y_,2) and G (Ddistance, Dxi) = w - distance Dn, the force -N_k F changes by -F N_k,a Dxi_a.
  Plain C.
@*/
void FrictionFootVary(const FrictionFoot *foot, const double F[3], int node, FrictionFootVariation *by)
{
  memset(by, 0, sizeof(*by));
  for (int a = 0; a < foot->tangents; a++) {
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++) {
        const double change = F[i] * foot->dN[node][a] * foot->inverse[1 + a][j];

        by->by_place[i][j] -= change;
        by->by_normal[i][j] += foot->distance * change;
      }
    }
  }
}

/*@
  FrictionLeverMake - makes the lever of a slave point.

  Not collective

  Input Parameters:
+ dim     - 2 or 3
. normal  - of the slave point, as that of the foot
- tangent - z_1 and z_2; z_2 does not count in two dimensions

  Output Parameter:
. lever - the lever

  Note:
  Returns 0 where the tangents and the normal span no space. Plain C.
@*/
int FrictionLeverMake(int dim, const double normal[3], const double tangent[2][3], FrictionLever *lever)
{
  const double axis[3] = {0, 0, 1};

  lever->tangents = dim - 1;
  return Invert(normal, tangent[0], dim == 2 ? axis : tangent[1], lever->inverse);
}

/*@
  FrictionLeverForces - gives the force on a node of the lever as a linear map of the force of the slave point.

  Not collective

  Input Parameters:
+ lever - the lever
. foot  - the foot of its slave point
- slope - D of the node

  Output Parameter:
. force - the force on the node is force F

  Note:
  Plain C.
@*/
void FrictionLeverForces(const FrictionLever *lever, const FrictionFoot *foot, const double slope[2],
                         double force[3][3])
{
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      force[i][j] = 0;
      for (int a = 0; a < lever->tangents; a++)
        force[i][j] += foot->distance * slope[a] * foot->normal[i] * lever->inverse[1 + a][j];
    }
  }
}

/*@
  FrictionLeverVary - gives the derivatives of the force on a node of the lever, where the force of the slave point is
  held.

  Not collective

  Input Parameters:
+ lever - the lever
. foot  - the foot of its slave point
. F     - the force of the slave point
- slope - D of the node

  Output Parameter:
. by - the derivatives

  Note:
  With Z = (n, z_1, z_2), Z D(c, F^a) = -c Dn - F^b Dz_b. Plain C.
@*/
void FrictionLeverVary(const FrictionLever *lever, const FrictionFoot *foot, const double F[3], const double slope[2],
                       FrictionFootVariation *by)
{
  const double *n = foot->normal, *away = foot->inverse[0], distance = foot->distance;
  double        part[3] = {0, 0, 0}, row[3] = {0, 0, 0}, sum = 0; /* c and F^a; sum_a D_a times row a; sum_a D_a F^a */

  memset(by, 0, sizeof(*by));
  for (int i = 0; i < 1 + lever->tangents; i++)
    for (int d = 0; d < 3; d++) part[i] += lever->inverse[i][d] * F[d];
  for (int a = 0; a < lever->tangents; a++) {
    sum += slope[a] * part[1 + a];
    for (int d = 0; d < 3; d++) row[d] += slope[a] * lever->inverse[1 + a][d];
  }
  for (int i = 0; i < 3; i++) {
    by->by_normal[i][i] += distance * sum;
    for (int j = 0; j < 3; j++) {
      by->by_place[i][j] += sum * n[i] * away[j];
      by->by_normal[i][j] -= distance * n[i] * (sum * away[j] + part[0] * row[j]);
      for (int b = 0; b < lever->tangents; b++) by->by_tangent[b][i][j] -= distance * part[1 + b] * n[i] * row[j];
    }
  }
}
