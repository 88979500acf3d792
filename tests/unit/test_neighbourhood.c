/* Fits never use points past a sharp edge or on the far side of a thin wall. They use points across a blunt edge.
   Points beyond the support are left out. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include "neighbourhood.h"

enum { SIDE = 6, FACETS = 2 * SIDE, POINTS = 2 * (2 * SIDE + 2) };

/* A strip of 2D edges along x that bends up by `angle` at x = 0, and a second strip below it at a distance, which
   faces down: the far side of the wall. */
typedef struct {
  Facet        facets[FACETS + SIDE];
  PetscReal    normals[3 * (FACETS + SIDE)], x[2 * POINTS];
  NodeGeometry geometry[POINTS];
  PetscInt     n_points;
} Strip;

static void AddEdge(Strip *s, PetscInt f, int a, int b)
{
  const PetscReal t[2]   = {s->x[2 * b] - s->x[2 * a], s->x[2 * b + 1] - s->x[2 * a + 1]};
  const PetscReal length = hypot(t[0], t[1]), n[3] = {t[1] / length, -t[0] / length, 0};

  s->facets[f] = (Facet){.type = ELEMENT_EDGE2, .nodes = {a, b}, .tag = f};
  for (int d = 0; d < 3; d++) {
    s->normals[3 * f + d] = n[d];
    s->geometry[a].normal[d] += n[d] / 2;
    s->geometry[b].normal[d] += n[d] / 2;
  }
}

static void MakeStrip(Strip *s, PetscReal angle, PetscReal wall, SurfaceView *view)
{
  *s = (Strip){.n_points = 2 * SIDE + 1 + SIDE + 1};
  for (int i = 0; i <= 2 * SIDE; i++) { /* from right to left, so that the normal points up */
    const PetscReal r = SIDE - i;

    s->x[2 * i]     = r > 0 ? r : r * cos(angle);
    s->x[2 * i + 1] = r > 0 ? 0 : -r * sin(angle);
  }
  for (int i = 0; i <= SIDE; i++) {
    s->x[2 * (2 * SIDE + 1 + i)]     = i;
    s->x[2 * (2 * SIDE + 1 + i) + 1] = -wall;
  }
  for (PetscInt f = 0; f < FACETS; f++) AddEdge(s, f, (int)f, (int)f + 1);
  for (PetscInt f = 0; f < SIDE; f++) AddEdge(s, FACETS + f, 2 * SIDE + 1 + (int)f, 2 * SIDE + 2 + (int)f);
  for (PetscInt p = 0; p < s->n_points; p++) s->geometry[p].weight = 1;
  *view = (SurfaceView){.dim            = 2,
                        .n_facets       = FACETS + SIDE,
                        .n_points       = s->n_points,
                        .facets         = s->facets,
                        .normals        = s->normals,
                        .reference      = s->normals,
                        .x              = s->x,
                        .geometry       = s->geometry,
                        .feature_cosine = cos(45 * PETSC_PI / 180)};
}

/* Gathers around (1.5, 0) within `radius` and counts the points of the flat flank, of the bent flank (without the
   node on the edge) and of the far side. */
static void Count(PetscReal angle, PetscReal wall, PetscReal radius, int count[3])
{
  const PetscReal foot[3] = {1.5, 0, 0}, up[3] = {0, 1, 0};
  const NeighbourhoodSupport support = {.metric = {1 / (radius * radius), 0, 0, 0, 1 / (radius * radius), 0, 0, 0, 0}};
  Strip            strip;
  SurfaceView      view;
  Neighbourhoods   nb;
  const PetscReal *rho2;
  PetscInt         points[POINTS], n, found;

  MakeStrip(&strip, angle, wall, &view);
  assert_int_equal(NeighbourhoodsCreate(&view, &nb), PETSC_SUCCESS);
  assert_int_equal(NeighbourhoodGather(nb, SIDE - 2, foot, up, &support, 1, POINTS, points, &rho2, &n, &found),
                   PETSC_SUCCESS);
  assert_int_equal(n, found);
  count[0] = count[1] = count[2] = 0;
  for (PetscInt i = 0; i < n; i++) count[points[i] <= SIDE ? 0 : points[i] <= 2 * SIDE ? 1 : 2]++;
  assert_int_equal(NeighbourhoodsDestroy(&nb), PETSC_SUCCESS);
}

static void test_sharp_edge(void **state)
{
  int count[3];

  (void)state;
  Count(60 * PETSC_PI / 180, 100, 4, count); /* sharper than the 45 degrees of a feature edge */
  assert_int_equal(count[0], 6);
  assert_int_equal(count[1], 0);
}

static void test_blunt_edge(void **state)
{
  int count[3];

  (void)state;
  Count(20 * PETSC_PI / 180, 100, 4, count);
  assert_int_equal(count[0], 6);
  assert_true(count[1] >= 2);
}

static void test_thin_wall(void **state)
{
  int count[3];

  (void)state;
  Count(0, 0.01, 4, count); /* the far side is a hundred times nearer than the next node */
  assert_int_equal(count[0] + count[1], 8);
  assert_int_equal(count[2], 0);
}

static void test_support(void **state)
{
  int count[3];

  (void)state;
  Count(0, 100, 1.6, count);
  assert_int_equal(count[0], 4); /* nodes 0, 1, 2, 3 */
  assert_int_equal(count[1], 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_sharp_edge), cmocka_unit_test(test_blunt_edge),
                                     cmocka_unit_test(test_thin_wall), cmocka_unit_test(test_support)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
