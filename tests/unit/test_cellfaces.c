/* Cell faces: cells that share a face are found by its corners in any order, the one with the lower id first. A row of
   bricks has the expected neighbours. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "cellfaces.h"

enum { CELLS = 3, LAYERS = CELLS + 1, LAYER = 4, NODES = LAYERS * LAYER, CORNERS = 8 };

/* Makes bricks in a row: brick c is between layers c and c + 1, whose nodes are numbered around the layer. */
static void MakeRow(GmshBlock *block, RootMesh *root)
{
  static PetscInt         connectivity[CELLS * CORNERS], item[CELLS], id[NODES], vertex[NODES];
  static const GmshBlock *of_cell[CELLS];

  for (PetscInt c = 0; c < CELLS; c++) {
    for (PetscInt k = 0; k < CORNERS; k++) connectivity[c * CORNERS + k] = c * LAYER + k;
    item[c]    = c;
    of_cell[c] = block;
  }
  for (PetscInt i = 0; i < NODES; i++) id[i] = vertex[i] = i;
  *block = (GmshBlock){.dim          = 3,
                       .element      = ElementGet(ELEMENT_HEX8),
                       .nodes        = CORNERS,
                       .n            = CELLS,
                       .connectivity = connectivity};
  *root  = (RootMesh){.n_nodes    = NODES,
                      .id         = id,
                      .vertex     = vertex,
                      .n_vertices = NODES,
                      .n_cells    = CELLS,
                      .cell_item  = item,
                      .cell_block = of_cell};
  assert_int_equal(CellFacesCreate(root), PETSC_SUCCESS);
}

static void FreeRow(RootMesh *root)
{
  assert_int_equal(PetscFree(root->corner_faces), PETSC_SUCCESS);
  assert_int_equal(PetscFree(root->cell_faces), PETSC_SUCCESS);
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
  const PetscInt  shared[] = {6, 4, 7, 5}, end[] = {1, 0, 3, 2}, none[] = {0, 1, 6, 7}, middle[] = {0, -1, 3, 2};
  const CellFace *face;
  GmshBlock       block;
  RootMesh        root;

  (void)state;
  MakeRow(&block, &root);
  assert_int_equal(CellFacesFind(&root, LAYER, shared, &face), 2);
  ExpectFace(&face[0], 0, shared[0]);
  ExpectFace(&face[1], 1, shared[0]);
  assert_int_equal(CellFacesFind(&root, LAYER, end, &face), 1);
  ExpectFace(face, 0, end[0]);
  assert_int_equal(CellFacesFind(&root, LAYER, none, &face), 0);
  assert_int_equal(CellFacesFind(&root, LAYER, middle, &face), 0);
  assert_int_equal(CellFacesFind(&root, LAYER - 1, shared, &face), 0);
  FreeRow(&root);
}

static void TestNeighbours(void **state)
{
  const PetscInt expected_offsets[CELLS + 1] = {0, 1, 3, 4}, expected[] = {1, 0, 2, 1};
  GmshBlock      block;
  RootMesh       root;
  PetscInt      *offsets, *adjacency;

  (void)state;
  MakeRow(&block, &root);
  assert_int_equal(CellFacesNeighbours(&root, &offsets, &adjacency), PETSC_SUCCESS);
  assert_memory_equal(offsets, expected_offsets, sizeof(expected_offsets));
  assert_memory_equal(adjacency, expected, sizeof(expected));
  assert_int_equal(PetscFree(offsets), PETSC_SUCCESS);
  assert_int_equal(PetscFree(adjacency), PETSC_SUCCESS);
  FreeRow(&root);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestFind), cmocka_unit_test(TestNeighbours)};
  int                     failed;

  if (PetscInitializeNoArguments()) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
