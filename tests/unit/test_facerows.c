/* Rows of long faces around flat rings and cones bend like circles, and those around a cylinder do not bend. Compact
   faces are left alone. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include "smooth/diffusefit.h"
#include "facerows.h"

enum { AROUND = 24, ACROSS = 20, NODES = (AROUND + 1) * (ACROSS + 1), FACETS = AROUND * ACROSS };

/* Half of a ring on a cone about the z axis. */
typedef struct {
  Facet          facets[FACETS];
  PetscReal      normals[3 * FACETS], x[3 * NODES];
  NodeGeometry   geometry[NODES];
  SurfaceView    view;
  Neighbourhoods neighbourhoods;
  FaceRows       rows;
} Ring;

/* rise: of the cone, over its radius; 0: the ring is flat. width: of the faces */
static void MakeRing(Ring *ring, PetscReal radius, PetscReal width, PetscReal rise)
{
  const PetscReal slant = sqrt(1 + rise * rise);

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
      const PetscReal out = width / slant * (j - ACROSS / 2.), angle = PETSC_PI * (i - AROUND / 2.) / AROUND;

      ring->x[3 * p]     = (radius + out) * cos(angle);
      ring->x[3 * p + 1] = (radius + out) * sin(angle);
      ring->x[3 * p + 2] = rise * out;
    }
  }
  for (int j = 0, f = 0; j < ACROSS; j++) {
    for (int i = 0; i < AROUND; i++, f++) {
      const int       p     = j * (AROUND + 1) + i;
      const PetscReal angle = PETSC_PI * (i + 0.5 - AROUND / 2.) / AROUND;

      ring->facets[f] = (Facet){.type = ELEMENT_QUAD4, .nodes = {p + AROUND + 1, p + AROUND + 2, p + 1, p}, .tag = f};
      ring->normals[3 * f]     = -rise / slant * cos(angle);
      ring->normals[3 * f + 1] = -rise / slant * sin(angle);
      ring->normals[3 * f + 2] = 1 / slant;
    }
  }
  assert_int_equal(NeighbourhoodsCreate(&ring->view, &ring->neighbourhoods), PETSC_SUCCESS);
  assert_int_equal(FaceRowsCreate(&ring->view, ring->neighbourhoods, &ring->rows), PETSC_SUCCESS);
}

/* along: of the foot, in faces from the end of a face */
static void Follow(Ring *ring, PetscReal rise, PetscReal along, FaceRow *row)
{
  const PetscInt  start = ACROSS / 2 * AROUND + AROUND / 2, p = ACROSS / 2 * (AROUND + 1) + AROUND / 2;
  const PetscReal slant = sqrt(1 + rise * rise), radius = ring->x[3 * p], angle = PETSC_PI * along / AROUND,
                  foot[3] = {radius * cos(angle), radius * sin(angle), 0},
                  up[3]   = {-rise / slant * cos(angle), -rise / slant * sin(angle), 1 / slant};

  assert_int_equal(FaceRowsFollow(ring->rows, start, foot, up, 3, row), PETSC_SUCCESS);
  assert_int_equal(FaceRowsDestroy(&ring->rows), PETSC_SUCCESS);
  assert_int_equal(NeighbourhoodsDestroy(&ring->neighbourhoods), PETSC_SUCCESS);
  if (row->share == 0) return;
  assert_true(fabs(row->along[1] * cos(angle) - row->along[0] * sin(angle)) > 1 - 1e-5);
  assert_true(fabs(sqrt(row->length2 / row->width2) - 10) < 0.5);
}

/* The circle through (R, 0) leaves its tangent by R - sqrt(R^2 - t^2) = t^2/2R + t^4/8R^3 + ... towards the axis. On
   the cone the part of it in the tangent plane is seen. */
static void test_ring(void **state)
{
  const PetscReal radius = 100, reach = 40, circle = radius - sqrt(radius * radius - reach * reach);
  static Ring     ring;
  FaceRow         row;

  (void)state;
  for (int rise = 0; rise <= 1; rise++) {
    for (int part = 0; part <= 2; part++) {
      PetscReal bend;

      MakeRing(&ring, radius, radius * PETSC_PI / AROUND / 10, rise);
      Follow(&ring, rise, part / 4., &row);
      assert_true(row.share == 1 && row.bends == 1);
      bend = FitBendAside(row.h, reach);
      assert_true(fabs(fabs(bend) - circle / sqrt(1 + rise)) < 0.02 * circle);
    }
  }
}

static void test_cylinder(void **state)
{
  const PetscReal rise = 1e3;
  static Ring     ring;
  FaceRow         row;

  (void)state;
  MakeRing(&ring, 100, 100 * PETSC_PI / AROUND / 10, rise);
  Follow(&ring, rise, 0.25, &row);
  assert_true(row.share == 1 && row.bends == 0);
}

static void test_compact(void **state)
{
  static Ring ring;
  FaceRow     row;

  (void)state;
  MakeRing(&ring, 100, 100 * PETSC_PI / AROUND / 1.5, 0);
  Follow(&ring, 0, 0, &row);
  assert_true(row.share == 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_ring), cmocka_unit_test(test_cylinder),
                                     cmocka_unit_test(test_compact)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
