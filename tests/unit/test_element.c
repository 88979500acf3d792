/* Shows that every reference element's tables agree with each other and with what defines them. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include "kernels/element.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* int x^i y^j z^k over the reference element: a simplex has i! j! k! / (i + j + k + dim)! */
static double Monomial(const Element *e, int i, int j, int k)
{
  if (e->corners == e->dim + 1 && e->dim > 1)
    return tgamma(i + 1) * tgamma(j + 1) * tgamma(k + 1) / tgamma(i + j + k + e->dim + 1);
  return (i % 2 || j % 2 || k % 2) ? 0
                                   : 2. / (i + 1) * (e->dim > 1 ? 2. / (j + 1) : 1) * (e->dim > 2 ? 2. / (k + 1) : 1);
}

static int IsSimplex(const Element *e)
{
  return e->corners == e->dim + 1 && e->dim > 1;
}

/* a point inside every reference element */
static const double inside[3] = {0.21, 0.37, 0.13};

static void NodesAreKronecker(void **state)
{
  (void)state;
  for (int type = 0; type < ELEMENT_TYPES; type++) {
    const Element *e = ElementGet(type);
    double         N[ELEMENT_MAX_NODES];

    assert_int_equal(e->type, type);
    for (int a = 0; a < e->nodes; a++) {
      ElementShape(type, e->node[a], N, NULL, NULL);
      for (int b = 0; b < e->nodes; b++) assert_near(N[b], a == b, 1e-15);
    }
  }
}

static void ShapesSumToOne(void **state)
{
  (void)state;
  for (int type = 0; type < ELEMENT_TYPES; type++) {
    const Element *e = ElementGet(type);
    double         N[ELEMENT_MAX_NODES], sum = 0, position[3] = {0};

    ElementShape(type, inside, N, NULL, NULL);
    for (int a = 0; a < e->nodes; a++) {
      sum += N[a];
      for (int k = 0; k < e->dim; k++) position[k] += N[a] * e->node[a][k];
    }
    assert_near(sum, 1, 1e-14);
    for (int k = 0; k < e->dim; k++) assert_near(position[k], inside[k], 1e-14);
  }
}

static void DerivativesAreDifferences(void **state)
{
  const double h = 1e-5;

  (void)state;
  for (int type = 0; type < ELEMENT_TYPES; type++) {
    const Element *e = ElementGet(type);
    double         dN[ELEMENT_MAX_NODES * 3], d2N[ELEMENT_MAX_NODES * 9];

    ElementShape(type, inside, NULL, dN, d2N);
    for (int k = 0; k < e->dim; k++) {
      double plus[3] = {inside[0], inside[1], inside[2]}, minus[3] = {inside[0], inside[1], inside[2]};
      double N_plus[ELEMENT_MAX_NODES], N_minus[ELEMENT_MAX_NODES], dN_plus[ELEMENT_MAX_NODES * 3],
        dN_minus[ELEMENT_MAX_NODES * 3];

      plus[k] += h;
      minus[k] -= h;
      ElementShape(type, plus, N_plus, dN_plus, NULL);
      ElementShape(type, minus, N_minus, dN_minus, NULL);
      for (int a = 0; a < e->nodes; a++) {
        assert_near(dN[a * e->dim + k], (N_plus[a] - N_minus[a]) / (2 * h), 1e-9);
        for (int l = 0; l < e->dim; l++)
          assert_near(d2N[(a * e->dim + l) * e->dim + k],
                      (dN_plus[a * e->dim + l] - dN_minus[a * e->dim + l]) / (2 * h), 1e-9);
      }
    }
  }
}

static void QuadratureIsExact(void **state)
{
  (void)state;
  for (int type = 0; type < 2 * ELEMENT_TYPES; type++) {
    const Element *e = type < ELEMENT_TYPES ? ElementGet(type) : ElementGetProducts(type - ELEMENT_TYPES);
    const int      degree =
      IsSimplex(e) ? (e->points == 1 ? 1 : 2) : 2 * e->order + 1; /* total degree; per direction for tensor products */

    for (int i = 0; i <= degree; i++) {
      for (int j = 0; j <= (e->dim > 1 ? degree : 0); j++) {
        for (int k = 0; k <= (e->dim > 2 ? degree : 0); k++) {
          double sum = 0;

          if (IsSimplex(e) && i + j + k > degree) continue;
          for (int p = 0; p < e->points; p++)
            sum += e->weight[p] * pow(e->point[p][0], i) * pow(e->point[p][1], j) * pow(e->point[p][2], k);
          assert_near(sum, Monomial(e, i, j, k), 1e-14);
        }
      }
    }
  }
}

static void QuadratureHasTheNumberOfPointsOfFullIntegration(void **state)
{
  const int points[ELEMENT_TYPES] = {2, 3, 1, 3, 4, 9, 1, 4, 8, 27};

  (void)state;
  for (int type = 0; type < ELEMENT_TYPES; type++) assert_int_equal(ElementGet(type)->points, points[type]);
  assert_int_equal(ElementGetFace(ELEMENT_TRI3)->points, 3);
  assert_ptr_equal(ElementGetFace(ELEMENT_QUAD9), ElementGet(ELEMENT_QUAD9));
}

/* Products of two linear fields need points that are exact to degree 2; all have the same weight, as cells are moved.
 */
static void ProductsHaveTheirPoints(void **state)
{
  (void)state;
  for (int type = 0; type < ELEMENT_TYPES; type++) {
    const Element *e = ElementGetProducts(type);

    assert_int_equal(e->type, type);
    if (ElementGet(type)->points > 1) {
      assert_ptr_equal(e, ElementGet(type));
      continue;
    }
    assert_int_equal(e->points, e->dim + 1);
    for (int p = 0; p < e->points; p++) assert_near(e->weight[p], ElementGet(type)->weight[0] / e->points, 1e-15);
  }
}

static void TablesAreTheShapesAtThePoints(void **state)
{
  (void)state;
  for (int type = 0; type < ELEMENT_TYPES; type++) {
    const Element *e = ElementGet(type);
    double         N[ELEMENT_MAX_NODES], dN[ELEMENT_MAX_NODES * 3];

    for (int p = 0; p < e->points; p++) {
      ElementShape(type, e->point[p], N, dN, NULL);
      for (int a = 0; a < e->nodes; a++) {
        assert_near(e->N[p][a], N[a], 0);
        for (int k = 0; k < e->dim; k++) assert_near(e->dN[p][a][k], dN[a * e->dim + k], 0);
      }
    }
  }
}

static void FacesPointOutward(void **state)
{
  (void)state;
  for (int type = 0; type < ELEMENT_TYPES; type++) {
    const Element *e = ElementGet(type);

    for (int f = 0; f < e->faces; f++) {
      const Element *face = ElementGet(e->face_type);
      double         x[ELEMENT_MAX_NODES][3], middle[3] = {0}, centre[3] = {0}, normal[3], out = 0;

      for (int a = 0; a < face->nodes; a++) {
        for (int k = 0; k < 3; k++) x[a][k] = e->node[e->face_nodes[f][a]][k];
      }
      for (int k = 0; k < 3; k++) {
        for (int a = 0; a < face->corners; a++) middle[k] += x[a][k] / face->corners;
        for (int a = 0; a < e->corners; a++) centre[k] += e->node[a][k] / e->corners;
      }
      if (e->dim == 2) {
        normal[0] = x[1][1] - x[0][1];
        normal[1] = x[0][0] - x[1][0];
        normal[2] = 0;
      } else {
        for (int k = 0; k < 3; k++) {
          const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;

          normal[k] = (x[1][k1] - x[0][k1]) * (x[2][k2] - x[0][k2]) - (x[1][k2] - x[0][k2]) * (x[2][k1] - x[0][k1]);
        }
      }
      for (int k = 0; k < 3; k++) out += normal[k] * (middle[k] - centre[k]);
      assert_true(out > 0);
    }
  }
}

/* The face's own shape functions give the same points as the cell's, and the cell's other nodes do not matter there */
static void FacesAreTracesOfTheCell(void **state)
{
  (void)state;
  for (int type = 0; type < ELEMENT_TYPES; type++) {
    const Element *e = ElementGet(type);

    for (int f = 0; f < e->faces; f++) {
      const Element *face = ElementGet(e->face_type);
      double         N_face[FACE_MAX_NODES], N[ELEMENT_MAX_NODES], xi[3] = {0};
      double         rest = 0;

      ElementShape(face->type, inside, N_face, NULL, NULL);
      for (int a = 0; a < face->nodes; a++) {
        for (int k = 0; k < e->dim; k++) xi[k] += N_face[a] * e->node[e->face_nodes[f][a]][k];
      }
      ElementShape(type, xi, N, NULL, NULL);
      for (int a = 0; a < e->nodes; a++) rest += fabs(N[a]);
      for (int a = 0; a < face->nodes; a++) {
        assert_near(N[e->face_nodes[f][a]], N_face[a], 1e-14);
        rest -= fabs(N_face[a]);
      }
      assert_near(rest, 0, 1e-13);
    }
  }
}

static void MiddleNodesLieOnTheirEdges(void **state)
{
  (void)state;
  for (int type = 0; type < ELEMENT_TYPES; type++) {
    const Element *e = ElementGet(type);

    for (int i = 0; i < e->edges && e->order == 2; i++) {
      for (int k = 0; k < 3; k++)
        assert_near(e->node[e->corners + i][k],
                    (e->node[e->edge_corners[i][0]][k] + e->node[e->edge_corners[i][1]][k]) / 2, 1e-16);
    }
  }
}

/* Positions of gmsh's and VTK's hex27 nodes as their manuals draw them: edges and faces by the corners around them */
static void Hex27FollowsTheManuals(void **state)
{
  const int      gmsh_faces[6][3] = {{0, 0, -1}, {0, -1, 0}, {-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int      vtk_faces[6][3]  = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
  const int      vtk_edges[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                     {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  const Element *e                = ElementGet(ELEMENT_HEX27);

  (void)state;
  for (int f = 0; f < 6; f++) {
    for (int k = 0; k < 3; k++) {
      assert_near(e->node[20 + f][k], gmsh_faces[f][k], 0);
      assert_near(e->node[e->xdmf_order[20 + f]][k], vtk_faces[f][k], 0);
    }
  }
  for (int i = 0; i < 12; i++) {
    for (int k = 0; k < 3; k++)
      assert_near(e->node[e->xdmf_order[8 + i]][k], (e->node[vtk_edges[i][0]][k] + e->node[vtk_edges[i][1]][k]) / 2, 0);
  }
}

static void XdmfOrdersArePermutations(void **state)
{
  (void)state;
  for (int type = 0; type < ELEMENT_TYPES; type++) {
    const Element *e    = ElementGet(type);
    unsigned       seen = 0;

    for (int a = 0; a < e->nodes; a++) seen |= 1u << e->xdmf_order[a];
    assert_true(seen == (1u << e->nodes) - 1);
  }
}

static void FitReproducesLinearFields(void **state)
{
  (void)state;
  for (int type = 0; type < ELEMENT_TYPES; type++) {
    const Element *e = ElementGet(type);

    for (int a = 0; a < e->nodes; a++) {
      double constant = 0, linear = 0;

      for (int p = 0; p < e->points; p++) {
        constant += e->fit[a][p];
        linear += e->fit[a][p] * (e->point[p][0] + 2 * e->point[p][1] - 3 * e->point[p][2]);
      }
      assert_near(constant, 1, 1e-14);
      if (e->points > 1) assert_near(linear, e->node[a][0] + 2 * e->node[a][1] - 3 * e->node[a][2], 1e-13);
    }
  }
}

static void GmshNumbersAreFound(void **state)
{
  (void)state;
  for (int type = 0; type < ELEMENT_TYPES; type++)
    assert_ptr_equal(ElementFromGmsh(ElementGet(type)->gmsh), ElementGet(type));
  assert_null(ElementFromGmsh(17)); /* hex20 */
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(NodesAreKronecker),
    cmocka_unit_test(ShapesSumToOne),
    cmocka_unit_test(DerivativesAreDifferences),
    cmocka_unit_test(QuadratureIsExact),
    cmocka_unit_test(QuadratureHasTheNumberOfPointsOfFullIntegration),
    cmocka_unit_test(ProductsHaveTheirPoints),
    cmocka_unit_test(TablesAreTheShapesAtThePoints),
    cmocka_unit_test(FacesPointOutward),
    cmocka_unit_test(FacesAreTracesOfTheCell),
    cmocka_unit_test(MiddleNodesLieOnTheirEdges),
    cmocka_unit_test(Hex27FollowsTheManuals),
    cmocka_unit_test(XdmfOrdersArePermutations),
    cmocka_unit_test(FitReproducesLinearFields),
    cmocka_unit_test(GmshNumbersAreFound),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
