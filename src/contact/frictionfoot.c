/* The foot of a slave point on a face of the master, and the nodal forces of its friction there. */
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
  double dN[FACE_MAX_NODES * 2], d2N[FACE_MAX_NODES * 4];

  ElementShape(e->type, f->xi, f->N, dN, d2N);
  memset(tangent, 0, 2 * sizeof(*tangent));
  memset(f->bend, 0, sizeof(f->bend));
  for (int d = 0; d < 3; d++) y[d] = 0;
  if (dim == 2) tangent[1][2] = 1;
  for (int k = 0; k < e->nodes; k++) {
    for (int d = 0; d < dim; d++) y[d] += f->N[k] * x[k * dim + d];
    for (int a = 0; a < e->dim; a++) {
      f->dN[k][a] = dN[k * e->dim + a];
      for (int d = 0; d < dim; d++) tangent[a][d] += f->dN[k][a] * x[k * dim + d];
      for (int b = 0; b < e->dim; b++) {
        f->d2N[k][a][b] = d2N[(k * e->dim + a) * e->dim + b];
        for (int d = 0; d < dim; d++) f->bend[a][b][d] += f->d2N[k][a][b] * x[k * dim + d];
      }
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
  FrictionFootForces - gives the force on a node of the face as a linear map of the force of the slave point.

  Not collective

  Input Parameters:
+ foot - the foot
- node - of the face

  Output Parameter:
. force - the force on the node is force F; that on the slave point is F itself

  Note:
  Plain C.
@*/
void FrictionFootForces(const FrictionFoot *foot, int node, double force[3][3])
{
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      force[i][j] = i == j ? -foot->N[node] : 0;
      for (int a = 0; a < foot->tangents; a++)
        force[i][j] += foot->distance * foot->dN[node][a] * foot->normal[i] * foot->inverse[1 + a][j];
    }
  }
}

/* The change of F^a where the force is held: G D[c; F] = -c Dn - F^b Dy_,b, with Dy_,b = sum_k N_k,b dx_k + y_,ba Dxi_a
   and G [Ddistance; Dxi] = w - distance Dn. */
static void VaryComponents(const FrictionFoot *f, const double part[3], int a, double by_place[3], double by_normal[3],
                           double by_tangent[2][3])
{
  const double *row = f->inverse[1 + a];

  for (int j = 0; j < 3; j++) {
    double bent = 0;

    for (int b = 0; b < f->tangents; b++) {
      for (int c = 0; c < f->tangents; c++) {
        double along = 0;

        for (int d = 0; d < 3; d++) along += row[d] * f->bend[b][c][d];
        bent += part[1 + b] * along * f->inverse[1 + c][j];
      }
      by_tangent[b][j] = -part[1 + b] * row[j];
    }
    by_place[j]  = -bent;
    by_normal[j] = -part[0] * row[j] + f->distance * bent;
  }
}

/*@
  FrictionFootVary - gives the derivatives of the force on a node of the face, where the force of the slave point is
held.

  Not collective

  Input Parameters:
+ foot - the foot
. F    - the force of the slave point
- node - of the face

  Output Parameter:
. by - the derivatives

  Note:
  Plain C.
@*/
void FrictionFootVary(const FrictionFoot *foot, const double F[3], int node, FrictionFootVariation *by)
{
  const double *n = foot->normal, distance = foot->distance;
  double        part[3] = {0, 0, 0}; /* c and F^a */

  memset(by, 0, sizeof(*by));
  for (int i = 0; i < 1 + foot->tangents; i++)
    for (int d = 0; d < 3; d++) part[i] += foot->inverse[i][d] * F[d];
  for (int a = 0; a < foot->tangents; a++) {
    const double dN = foot->dN[node][a];
    double       place[3], normal[3], tangent[2][3], bend = 0; /* of F^a; bend: factor of Dxi_a, of all F^b N_k,ba */

    VaryComponents(foot, part, a, place, normal, tangent);
    for (int b = 0; b < foot->tangents; b++) bend += foot->d2N[node][b][a] * part[1 + b];
    for (int i = 0; i < 3; i++) {
      by->by_normal[i][i] += distance * dN * part[1 + a];
      for (int j = 0; j < 3; j++) {
        const double along = foot->inverse[1 + a][j], away = foot->inverse[0][j]; /* Dxi_a and Ddistance by w */

        by->by_place[i][j] +=
          -F[i] * dN * along + n[i] * (dN * part[1 + a] * away + distance * bend * along + distance * dN * place[j]);
        by->by_normal[i][j] += distance * F[i] * dN * along -
                               distance * n[i] * (dN * part[1 + a] * away + distance * bend * along) +
                               distance * dN * n[i] * normal[j];
        for (int b = 0; b < foot->tangents; b++) by->by_tangent[b][i][j] += distance * dN * n[i] * tangent[b][j];
      }
    }
  }
}
