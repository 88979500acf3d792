/* Partition: two strips of cells that face each other across contact are cut across both strips, not separated from
   each other. The number of faces that are cut does not include links. Parts of few cells are found, too. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include "../celllists.h"

enum { LENGTH = 24, WIDTH = 3, STRIPS = 2, CELLS = STRIPS * LENGTH * WIDTH };

static PetscInt Cell(int strip, int along, int across)
{
  return (strip * LENGTH + along) * WIDTH + across;
}

/* Sets the neighbours across faces: strips of LENGTH by WIDTH cells, which share no faces. */
static void Strips(PetscInt offsets[CELLS + 1], PetscInt adjacency[4 * CELLS])
{
  PetscInt n = 0;

  for (int s = 0; s < STRIPS; s++) {
    for (int i = 0; i < LENGTH; i++) {
      for (int j = 0; j < WIDTH; j++) {
        offsets[Cell(s, i, j)] = n;
        if (i) adjacency[n++] = Cell(s, i - 1, j);
        if (j) adjacency[n++] = Cell(s, i, j - 1);
        if (j + 1 < WIDTH) adjacency[n++] = Cell(s, i, j + 1);
        if (i + 1 < LENGTH) adjacency[n++] = Cell(s, i + 1, j);
      }
    }
  }
  offsets[CELLS] = n;
}

/* Counts the links between the strips whose ends are in different parts, and the faces that are cut. */
static void Cut(PetscInt n_links, PetscInt *links_cut, PetscInt *faces_cut)
{
  PetscInt  offsets[CELLS + 1], adjacency[4 * CELLS], part[CELLS], link[2 * LENGTH], count[STRIPS];
  CellLinks links = {n_links, link};

  Strips(offsets, adjacency);
  for (int i = 0; i < LENGTH; i++) {
    link[2 * i]     = Cell(0, i, WIDTH - 1);
    link[2 * i + 1] = Cell(1, i, 0);
  }
  assert_int_equal(PartitionGraph(CELLS, offsets, adjacency, NULL, &links, STRIPS, part, faces_cut), 0);
  assert_true(PartitionImbalance(CELLS, part, NULL, STRIPS, count) < 1.1);
  *links_cut = 0;
  for (int i = 0; i < LENGTH; i++) *links_cut += part[link[2 * i]] != part[link[2 * i + 1]];
}

static void test_links_are_not_cut(void **state)
{
  PetscInt links_cut = 0, faces_cut = 0;

  (void)state;
  Cut(0, &links_cut, &faces_cut);
  assert_int_equal(links_cut, LENGTH);
  assert_int_equal(faces_cut, 0);
  Cut(LENGTH, &links_cut, &faces_cut);
  assert_true(links_cut <= 2);
  assert_true(faces_cut >= STRIPS * WIDTH && faces_cut <= 2 * STRIPS * WIDTH);
}

/* Parts of two or three cells, of which some should have one in contact: there is a partition all the same. */
static void test_small_parts(void **state)
{
  enum { PARTS = CELLS / 2 };
  PetscInt  offsets[CELLS + 1], adjacency[4 * CELLS], part[CELLS], count[PARTS], faces_cut;
  PetscBool contact[CELLS];
  CellLinks links = {0};

  (void)state;
  Strips(offsets, adjacency);
  for (int s = 0; s < STRIPS; s++)
    for (int i = 0; i < LENGTH; i++)
      for (int j = 0; j < WIDTH; j++) contact[Cell(s, i, j)] = (PetscBool)(j == (s ? 0 : WIDTH - 1));
  assert_int_equal(PartitionGraph(CELLS, offsets, adjacency, contact, &links, PARTS, part, &faces_cut), 0);
  assert_true(PartitionImbalance(CELLS, part, NULL, PARTS, count) <= 4);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_links_are_not_cut), cmocka_unit_test(test_small_parts)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
