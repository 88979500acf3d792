/* Rows of long faces on a flat ring bend like circles. Compact faces are left alone. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include "facerows.h"

enum { AROUND = 24, ACROSS = 20, NODES = (AROUND + 1) * (ACROSS + 1), FACETS = AROUND * ACROSS };

/* Half of a flat ring in the plane z = 0. */
typedef struct {
  Facet          facets[FACETS];
  PetscReal      normals[3 * FACETS], x[3 * NODES];
  NodeGeometry   geometry[NODES];
  SurfaceView    view;
  Neighbourhoods neighbourhoods;
  FaceRows       rows;
} Ring;

static void MakeRing(Ring *ring, PetscReal radius, PetscReal width)
{
  *ring = (Ring){.view = {.dim            = 3,
                          .n_facets       = FACETS,
                          .n_points       = NODES,
                          .facets         = ring->facets,
                          .normals        = ring->normals,
                          .reference      = ring->normals,
                          .x              = ring->x,
                          .geometry       = ring->geometry,
                          .feature_cosine = cos(45 * PETSC_PI / 180)}};
  for (int j = 0, p = 0; j <= ACROSS; j++) {
    for (int i = 0; i <= AROUND; i++, p++) {
      const PetscReal r = radius + width * (j - ACROSS / 2.), angle = PETSC_PI * (i - AROUND / 2.) / AROUND;

      ring->x[3 * p]     = r * cos(angle);
      ring->x[3 * p + 1] = r * sin(angle);
    }
  }
  for (int j = 0, f = 0; j < ACROSS; j++) {
    for (int i = 0; i < AROUND; i++, f++) {
      const int p = j * (AROUND + 1) + i;

      ring->facets[f] =
        (Facet){.type = ELEMENT_QUAD4, .nodes = {p + AROUND + 1, p + AROUND + 2, p + 1, p}, .tag = f};
      ring->normals[3 * f + 2] = 1;
    }
  }
  assert_int_equal(NeighbourhoodsCreate(&ring->view, &ring->neighbourhoods), PETSC_SUCCESS);
  assert_int_equal(FaceRowsCreate(&ring->view, ring->neighbourhoods, &ring->rows), PETSC_SUCCESS);
}

static void Follow(Ring *ring, FaceRow *row)
{
  const PetscInt  start   = ACROSS / 2 * AROUND + AROUND / 2, p = ACROSS / 2 * (AROUND + 1) + AROUND / 2;
  const PetscReal foot[3] = {ring->x[3 * p], ring->x[3 * p + 1], 0}, up[3] = {0, 0, 1};

  assert_int_equal(FaceRowsFollow(ring->rows, start, foot, up, 3, row), PETSC_SUCCESS);
  assert_int_equal(FaceRowsDestroy(&ring->rows), PETSC_SUCCESS);
  assert_int_equal(NeighbourhoodsDestroy(&ring->neighbourhoods), PETSC_SUCCESS);
}

/* The circle through (R, 0) leaves its tangent by R - sqrt(R^2 - t^2) = t^2/2R + t^4/8R^3 + ... towards the axis. */
static void test_ring(void **state)
{
  const PetscReal radius = 100;
  static Ring     ring;
  FaceRow         row;
  PetscReal       across, bend, reach = 40, circle = radius - sqrt(radius * radius - reach * reach);

  (void)state;
  MakeRing(&ring, radius, radius * PETSC_PI / AROUND / 10);
  Follow(&ring, &row);
  assert_true(row.share == 1);
  assert_true(fabs(row.along[1]) > 1 - 1e-6);
  across = -row.along[1]; /* radial component of `along`, turned to the left */
  bend   = reach * reach * (row.h[0] + reach * (row.h[1] + reach * row.h[2]));
  assert_true(fabs(across * bend + circle) < 0.05 * circle);
  assert_true(fabs(sqrt(row.length2 / row.width2) - 10) < 0.5);
}

static void test_compact(void **state)
{
  static Ring ring;
  FaceRow     row;

  (void)state;
  MakeRing(&ring, 100, 100 * PETSC_PI / AROUND / 1.5);
  Follow(&ring, &row);
  assert_true(row.share == 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_ring), cmocka_unit_test(test_compact)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
