/* Shows that loads on faces have the right resultants, that follower tangents are derivatives, and that areas and
 * normals are right. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>
#include "kernels/elementkernel.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

enum { MAX_DOFS = FACE_MAX_NODES * 3 };

typedef struct {
  ElementType type;
  int         dim;
  Geometry    geometry;
} Case;

static const Case cases[] = {
  {ELEMENT_EDGE2, 2, GEOMETRY_PLANE_STRAIN}, {ELEMENT_EDGE3, 2, GEOMETRY_PLANE_STRAIN},
  {ELEMENT_EDGE2, 2, GEOMETRY_AXISYMMETRIC}, {ELEMENT_EDGE3, 2, GEOMETRY_AXISYMMETRIC},
  {ELEMENT_TRI3, 3, GEOMETRY_SOLID},         {ELEMENT_TRI6, 3, GEOMETRY_SOLID},
  {ELEMENT_QUAD4, 3, GEOMETRY_SOLID},        {ELEMENT_QUAD9, 3, GEOMETRY_SOLID},
};
enum { CASES = sizeof(cases) / sizeof(*cases) };

static double Random(void)
{
  static unsigned state = 4321;

  state = state * 1664525u + 1013904223u;
  return (double)(state >> 8) / (1 << 24) - 0.5;
}

/* A distorted, curved face around x = 3 with random displacements */
static void MakeFace(const Case *c, double *X, double *u)
{
  const Element *e = ElementGet(c->type);

  for (int a = 0; a < e->nodes; a++) {
    for (int i = 0; i < c->dim; i++) {
      X[a * c->dim + i] = e->node[a][i] + 0.2 * Random() + (i == 0 ? 3 : 0);
      u[a * c->dim + i] = 0.2 * Random();
    }
  }
}

static void FollowerTangentIsTheDerivative(void **state)
{
  const double pressure = 2.5, h = 1e-5;

  (void)state;
  for (int k = 0; k < CASES; k++) {
    const int dofs = ElementGet(cases[k].type)->nodes * cases[k].dim;
    double    X[MAX_DOFS], u[MAX_DOFS], f[MAX_DOFS] = {0}, K[MAX_DOFS * MAX_DOFS] = {0}, energy = 0;

    MakeFace(&cases[k], X, u);
    FaceLoadKernel(cases[k].type, cases[k].dim, cases[k].geometry, FACE_FOLLOWER_PRESSURE, X, u, &pressure, 0, f, K,
                   &energy);
    assert_true(energy == 0);
    for (int j = 0; j < dofs; j++) {
      double plus[MAX_DOFS] = {0}, minus[MAX_DOFS] = {0};

      u[j] += h;
      FaceLoadKernel(cases[k].type, cases[k].dim, cases[k].geometry, FACE_FOLLOWER_PRESSURE, X, u, &pressure, 0, plus,
                     NULL, NULL);
      u[j] -= 2 * h;
      FaceLoadKernel(cases[k].type, cases[k].dim, cases[k].geometry, FACE_FOLLOWER_PRESSURE, X, u, &pressure, 0, minus,
                     NULL, NULL);
      u[j] += h;
      for (int i = 0; i < dofs; i++) assert_near(K[i * dofs + j], -(plus[i] - minus[i]) / (2 * h), 1e-8);
    }
  }
}

static void DeadLoadsHaveAPotential(void **state)
{
  const double value[3] = {1.5, -0.7, 0.4}, h = 1e-4;

  (void)state;
  for (int k = 0; k < CASES; k++) {
    for (FaceLoad load = FACE_TRACTION; load <= FACE_DEAD_PRESSURE; load++) {
      const int dofs = ElementGet(cases[k].type)->nodes * cases[k].dim;
      double    X[MAX_DOFS], u[MAX_DOFS], f[MAX_DOFS] = {0}, K[MAX_DOFS * MAX_DOFS] = {0};

      MakeFace(&cases[k], X, u);
      FaceLoadKernel(cases[k].type, cases[k].dim, cases[k].geometry, load, X, u, value, 0, f, K, NULL);
      for (int j = 0; j < dofs * dofs; j++) assert_true(K[j] == 0);
      for (int j = 0; j < dofs; j++) {
        double unused[MAX_DOFS] = {0}, plus = 0, minus = 0;

        u[j] += h;
        FaceLoadKernel(cases[k].type, cases[k].dim, cases[k].geometry, load, X, u, value, 0, unused, NULL, &plus);
        u[j] -= 2 * h;
        FaceLoadKernel(cases[k].type, cases[k].dim, cases[k].geometry, load, X, u, value, 0, unused, NULL, &minus);
        u[j] += h;
        assert_near(f[j], -(plus - minus) / (2 * h), 1e-9);
      }
    }
  }
}

/* Cells with all nodes displaced at random: pressure on the closed surface has no resultant, dead or follower.
 * Axisymmetric: only its axial part */
static void PressureOnAClosedSurfaceHasNoResultant(void **state)
{
  const double pressure = 3;

  (void)state;
  for (int type = ELEMENT_TRI3; type < ELEMENT_TYPES; type++) {
    const Element *e = ElementGet(type), *face = ElementGet(e->face_type);

    for (Geometry geometry = e->dim == 3 ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN;
         geometry <= (e->dim == 3 ? GEOMETRY_SOLID : GEOMETRY_AXISYMMETRIC); geometry++) {
      double X[ELEMENT_MAX_NODES][3], u[ELEMENT_MAX_NODES][3];

      for (int a = 0; a < e->nodes; a++) {
        for (int i = 0; i < 3; i++) {
          X[a][i] = e->node[a][i] + 0.1 * Random() + (i == 0 ? 3 : 0);
          u[a][i] = 0.2 * Random();
        }
      }
      for (FaceLoad load = FACE_DEAD_PRESSURE; load <= FACE_FOLLOWER_PRESSURE; load++) {
        double sum[3] = {0}, largest = 0;

        for (int k = 0; k < e->faces; k++) {
          double face_X[MAX_DOFS], face_u[MAX_DOFS], f[MAX_DOFS] = {0};

          for (int a = 0; a < face->nodes; a++) {
            for (int i = 0; i < e->dim; i++) {
              face_X[a * e->dim + i] = X[e->face_nodes[k][a]][i];
              face_u[a * e->dim + i] = u[e->face_nodes[k][a]][i];
            }
          }
          FaceLoadKernel(face->type, e->dim, geometry, load, face_X, face_u, &pressure, 0, f, NULL, NULL);
          for (int j = 0; j < face->nodes * e->dim; j++) {
            sum[j % e->dim] += f[j];
            largest = fmax(largest, fabs(f[j]));
          }
        }
        for (int i = geometry == GEOMETRY_AXISYMMETRIC; i < e->dim; i++) assert_near(sum[i], 0, 1e-13 * largest);
      }
    }
  }
}

/* Pressure pushes against the outward normal, and a follower pressure on an undeformed face is the dead one */
static void PressureActsInward(void **state)
{
  const double pressure = 2, square[12] = {0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1}, edge[4] = {1, 5, 2, 5};
  double       f[MAX_DOFS] = {0}, zero[MAX_DOFS] = {0}, follower[MAX_DOFS] = {0};

  (void)state;
  FaceLoadKernel(ELEMENT_QUAD4, 3, GEOMETRY_SOLID, FACE_DEAD_PRESSURE, square, zero, &pressure, 0, f, NULL, NULL);
  FaceLoadKernel(ELEMENT_QUAD4, 3, GEOMETRY_SOLID, FACE_FOLLOWER_PRESSURE, square, zero, &pressure, 0, follower, NULL,
                 NULL);
  for (int a = 0; a < 4; a++) {
    assert_near(f[3 * a + 2], -0.5, 1e-15);
    for (int i = 0; i < 3; i++) assert_true(f[3 * a + i] == follower[3 * a + i]);
  }
  memset(f, 0, sizeof(f));
  /* travelling along +x the outside is to the right, at -y; over 360 degrees the ring from radius 1 to 2 */
  FaceLoadKernel(ELEMENT_EDGE2, 2, GEOMETRY_AXISYMMETRIC, FACE_DEAD_PRESSURE, edge, zero, &pressure, 0, f, NULL, NULL);
  assert_near(f[1] + f[3], 2 * M_PI * (4 - 1), 1e-13);
  assert_near(f[0], 0, 1e-15);
}

/* The rows of the products of shape functions sum to the tributary areas */
static void MassHasTheAreas(void **state)
{
  (void)state;
  for (int k = 0; k < CASES; k++) {
    const int n = ElementGet(cases[k].type)->nodes;
    double    X[MAX_DOFS], u[MAX_DOFS], area[FACE_MAX_NODES] = {0}, matrix[FACE_MAX_NODES * FACE_MAX_NODES];

    MakeFace(&cases[k], X, u);
    FaceAreaKernel(cases[k].type, cases[k].dim, cases[k].geometry, X, area, NULL);
    FaceMassKernel(cases[k].type, cases[k].dim, cases[k].geometry, X, matrix);
    for (int a = 0; a < n; a++) {
      double sum = 0;

      for (int b = 0; b < n; b++) {
        sum += matrix[a * n + b];
        assert_near(matrix[a * n + b], matrix[b * n + a], 1e-15);
      }
      assert_near(sum, area[a], 1e-13);
    }
  }
}

static void TractionHasItsResultant(void **state)
{
  const double value[3] = {1.5, -0.7, 0.4};

  (void)state;
  for (int k = 0; k < CASES; k++) {
    const Element *e = ElementGet(cases[k].type);
    double         X[MAX_DOFS], u[MAX_DOFS], f[MAX_DOFS] = {0}, area[FACE_MAX_NODES] = {0}, total = 0, sum[3] = {0};

    MakeFace(&cases[k], X, u);
    FaceLoadKernel(cases[k].type, cases[k].dim, cases[k].geometry, FACE_TRACTION, X, u, value, 0, f, NULL, NULL);
    FaceAreaKernel(cases[k].type, cases[k].dim, cases[k].geometry, X, area, NULL);
    for (int a = 0; a < e->nodes; a++) {
      total += area[a];
      for (int i = 0; i < cases[k].dim; i++) sum[i] += f[a * cases[k].dim + i];
    }
    for (int i = 0; i < cases[k].dim; i++) assert_near(sum[i], total * value[i], 1e-13 * total);
  }
}

static void TributaryAreasAreKnownOnes(void **state)
{
  /* shares of the nodes of a flat face, by the integrals of their shape functions */
  const double edge3[3] = {1. / 6, 1. / 6, 4. / 6}, tri6[6] = {0, 0, 0, 1. / 3, 1. / 3, 1. / 3};
  const double quad9[9] = {1. / 36, 1. / 36, 1. / 36, 1. / 36, 4. / 36, 4. / 36, 4. / 36, 4. / 36, 16. / 36};
  const struct {
    ElementType   type;
    int           dim;
    double        area;
    const double *share;
  } faces[] = {
    {ELEMENT_EDGE3, 2, 4, edge3},
    {ELEMENT_TRI6, 3, 3, tri6},
    {ELEMENT_QUAD9, 3, 24, quad9},
  };

  (void)state;
  for (int k = 0; k < 3; k++) {
    const Element *e           = ElementGet(faces[k].type);
    double         X[MAX_DOFS] = {0}, area[FACE_MAX_NODES] = {0}, normal[MAX_DOFS] = {0};

    for (int a = 0; a < e->nodes; a++) {
      X[a * faces[k].dim] = 2 * e->node[a][0];
      if (faces[k].dim == 3) X[a * 3 + 1] = 3 * e->node[a][1];
    }
    FaceAreaKernel(faces[k].type, faces[k].dim, GEOMETRY_SOLID, X, area, normal);
    for (int a = 0; a < e->nodes; a++) {
      assert_near(area[a], faces[k].share[a] * faces[k].area, 1e-14);
      assert_near(normal[a * faces[k].dim + faces[k].dim - 1], (faces[k].dim == 3 ? 1 : -1) * area[a], 1e-14);
    }
  }
}

static void AxisymmetricAreaIsThatOfACone(void **state)
{
  const double cone[4] = {1, 0, 3, 2}; /* radii 1 and 3, slant length 2 sqrt 2 */
  double       area[2] = {0}, normal[4] = {0};

  (void)state;
  FaceAreaKernel(ELEMENT_EDGE2, 2, GEOMETRY_AXISYMMETRIC, cone, area, normal);
  assert_near(area[0] + area[1], M_PI * (1 + 3) * 2 * sqrt(2), 1e-13);
  assert_near(normal[1] + normal[3], -M_PI * (9 - 1), 1e-13);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(FollowerTangentIsTheDerivative),
    cmocka_unit_test(DeadLoadsHaveAPotential),
    cmocka_unit_test(PressureOnAClosedSurfaceHasNoResultant),
    cmocka_unit_test(PressureActsInward),
    cmocka_unit_test(MassHasTheAreas),
    cmocka_unit_test(TractionHasItsResultant),
    cmocka_unit_test(TributaryAreasAreKnownOnes),
    cmocka_unit_test(AxisymmetricAreaIsThatOfACone),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
