/* Cell faces: cells that share a face are found by its corners in any order, the one with the lower id first. A row of
   bricks has the expected pairs of neighbours. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "cellfaces.h"

enum { CELLS = 3, LAYERS = CELLS + 1, LAYER = 4, NODES = LAYERS * LAYER, CORNERS = 8 };

/* Makes bricks in a row: brick c is between layers c and c + 1, whose nodes are numbered around the layer. */
static void MakeRow(GmshBlock *block, SliceMesh *slice)
{
  static const PetscReal  corner[LAYER][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  static PetscInt         nodes[CELLS * CORNERS], id[NODES], cell_start[] = {0, CELLS}, home_start[] = {0, NODES};
  static PetscReal        coords[3 * NODES];
  static int              body[CELLS];
  static const GmshBlock *of_cell[CELLS];

  for (PetscInt c = 0; c < CELLS; c++) {
    for (PetscInt k = 0; k < CORNERS; k++) nodes[c * CORNERS + k] = c * LAYER + k;
    of_cell[c] = block;
  }
  for (PetscInt i = 0; i < NODES; i++) {
    id[i]             = i;
    coords[3 * i]     = corner[i % LAYER][0];
    coords[3 * i + 1] = corner[i % LAYER][1];
    coords[3 * i + 2] = (PetscReal)(i / LAYER);
  }
  *block = (GmshBlock){.dim = 3, .element = ElementGet(ELEMENT_HEX8), .nodes = CORNERS};
  *slice = (SliceMesh){.comm       = PETSC_COMM_SELF,
                       .size       = 1,
                       .n_homes    = NODES,
                       .home_start = home_start,
                       .n_nodes    = NODES,
                       .id         = id,
                       .coords     = coords,
                       .n_cells    = CELLS,
                       .cell_start = cell_start,
                       .cell_nodes = nodes,
                       .width      = CORNERS,
                       .cell_body  = body,
                       .cell_block = of_cell};
  assert_int_equal(CellFacesCreate(slice), PETSC_SUCCESS);
}

static void FreeRow(SliceMesh *slice)
{
  assert_int_equal(CellFacesFree(slice), PETSC_SUCCESS);
  assert_int_equal(PetscFree(slice->face_start), PETSC_SUCCESS);
}

/* Looks for a face by its corners in any order. */
static PetscInt Find(const SliceMesh *slice, const PetscInt ids[LAYER], const CellFace **face)
{
  PetscInt corner[CELL_FACE_CORNERS];

  CellFacesSortCorners(LAYER, ids, corner);
  return CellFacesFind(slice, corner, face);
}

/* Expects that the face has the given cell and nodes; its number is that of the element table. */
static void ExpectFace(const CellFace *face, PetscInt cell, PetscInt first_layer_node)
{
  const Element *brick = ElementGet(ELEMENT_HEX8);

  assert_int_equal(face->cell, cell);
  for (int k = 0; k < LAYER; k++)
    assert_int_equal((cell * LAYER + brick->face_nodes[face->number][k]) / LAYER, first_layer_node / LAYER);
}

static void TestFind(void **state)
{
  const PetscInt  shared[] = {6, 4, 7, 5}, end[] = {1, 0, 3, 2}, none[] = {0, 1, 6, 7};
  const CellFace *face;
  GmshBlock       block;
  SliceMesh       slice;

  (void)state;
  MakeRow(&block, &slice);
  assert_int_equal(Find(&slice, shared, &face), 2);
  ExpectFace(&face[0], 0, shared[0]);
  ExpectFace(&face[1], 1, shared[0]);
  assert_int_equal(Find(&slice, end, &face), 1);
  ExpectFace(face, 0, end[0]);
  assert_int_equal(Find(&slice, none, &face), 0);
  FreeRow(&slice);
}

static void TestPairs(void **state)
{
  const PetscInt expected[] = {0, 1, 1, 2};
  GmshBlock      block;
  SliceMesh      slice;
  PetscInt       n, *pairs;

  (void)state;
  MakeRow(&block, &slice);
  assert_int_equal(CellFacesPairs(&slice, &n, &pairs), PETSC_SUCCESS);
  assert_int_equal(n, CELLS - 1);
  assert_memory_equal(pairs, expected, sizeof(expected));
  assert_int_equal(PetscFree(pairs), PETSC_SUCCESS);
  FreeRow(&slice);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestFind), cmocka_unit_test(TestPairs)};
  int                     failed;

  if (PetscInitializeNoArguments()) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
