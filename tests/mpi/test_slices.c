/* Slices of a mesh before distribution: no rank, and not the first one either, holds many more of the cells, the nodes
   and the faces than the mean, also where tags have gaps and do not follow the order of the file. Together the slices
   are the whole mesh. */
#include "sliceread.h"
#include "cellfaces.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Bricks along each side of a block */
enum { BRICKS = 12, NODES = (BRICKS + 1) * (BRICKS + 1) * (BRICKS + 1), CELLS = BRICKS * BRICKS * BRICKS };

/* Largest number that a rank holds over the mean. The ranges of tags come from samples. */
#define MOST 1.2

static char        folder[64];
static PetscMPIInt rank, size;

/* A tag for the i-th thing of n, which is far from those of its neighbours; spread: tags have gaps that grow. */
static int Tag(int i, int n, int spread)
{
  const int mixed = (int)((long)i * 7919 % n); /* a prime that divides no n here */

  return spread ? 1 + mixed * (1 + mixed) : 1 + mixed;
}

static int NodeTag(int i, int j, int k, int spread)
{
  return Tag((k * (BRICKS + 1) + j) * (BRICKS + 1) + i, NODES, spread);
}

static void WriteCells(FILE *file, int spread)
{
  static const int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

  fprintf(file, "$Elements\n1 %d 1 %d\n3 1 5 %d\n", CELLS, CELLS, CELLS);
  for (int c = 0; c < CELLS; c++) {
    fprintf(file, "%d", Tag(c, CELLS, spread));
    for (int a = 0; a < 8; a++)
      fprintf(file, " %d",
              NodeTag(c % BRICKS + corner[a][0], c / BRICKS % BRICKS + corner[a][1],
                      c / (BRICKS * BRICKS) + corner[a][2], spread));
    fprintf(file, "\n");
  }
  fprintf(file, "$EndElements\n");
}

/* Writes a block of bricks in gmsh's format. */
static void WriteMesh(const char *path, int spread)
{
  FILE *file = fopen(path, "w");

  assert_non_null(file);
  fprintf(file, "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"block\"\n$EndPhysicalNames\n");
  fprintf(file, "$Entities\n0 0 0 1\n1 0 0 0 1 1 1 1 1 0\n$EndEntities\n$Nodes\n1 %d 1 %d\n3 1 0 %d\n", NODES, NODES,
          NODES);
  for (int pass = 0; pass < 2; pass++)
    for (int k = 0; k <= BRICKS; k++)
      for (int j = 0; j <= BRICKS; j++)
        for (int i = 0; i <= BRICKS; i++) {
          if (pass)
            fprintf(file, "%d %d %d\n", i, j, k);
          else
            fprintf(file, "%d\n", NodeTag(i, j, k, spread));
        }
  fprintf(file, "$EndNodes\n");
  WriteCells(file, spread);
  fclose(file);
}

/* Expects that the ranks have so many together, and none of them many more than the mean. */
static void ExpectShare(const char *what, PetscInt mine, PetscInt all)
{
  PetscInt sum, most;

  assert_int_equal(MPI_Allreduce(&mine, &sum, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD), MPI_SUCCESS);
  assert_int_equal(MPI_Allreduce(&mine, &most, 1, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD), MPI_SUCCESS);
  assert_int_equal(sum, all);
  if (most > MOST * all / size) fail_msg("a rank has %d of the %d %s, %d ranks", (int)most, (int)all, what, (int)size);
}

static void CheckSlices(int spread)
{
  char      path[128], yaml[128];
  Complaint complaint = {""};
  SliceMesh slice;
  Scene     scene;
  Mesh      mesh;
  FILE     *file;

  snprintf(path, sizeof(path), "%s/block.msh", folder);
  snprintf(yaml, sizeof(yaml), "%s/block.yaml", folder);
  if (!rank) {
    WriteMesh(path, spread);
    file = fopen(yaml, "w");
    assert_non_null(file);
    fprintf(file, "mesh: {file: block.msh, order: 1}\ngeometry: solid\nbodies: [{volume: block, material: {law: svk, "
                  "E: 1, nu: 0.3}}]\n");
    fclose(file);
  }
  assert_int_equal(MPI_Barrier(PETSC_COMM_WORLD), MPI_SUCCESS);
  assert_int_equal(SceneRead(PETSC_COMM_WORLD, yaml, 0, NULL, &scene), 0);
  assert_int_equal(PetscNew(&mesh), 0);
  mesh->comm = PETSC_COMM_WORLD;
  mesh->dim  = 3;
  assert_int_equal(SliceRead(scene, path, &slice, mesh, &complaint), 0);
  assert_string_equal(complaint.text, "");
  ExpectShare("cells", slice.n_cells, CELLS);
  ExpectShare("nodes", slice.gmsh.n_nodes, NODES);
  ExpectShare("homes", slice.n_homes, NODES);
  assert_int_equal(CellFacesCreate(&slice), 0);
  ExpectShare("faces", slice.corner_faces[slice.n_corners], 6 * CELLS);
  for (PetscInt c = 1; c < slice.n_cells; c++) assert_true(slice.cell_tag[c] > slice.cell_tag[c - 1]);
  for (PetscInt i = 1; i < slice.n_nodes; i++) assert_true(slice.id[i] > slice.id[i - 1]);
  assert_true(mesh->size > BRICKS && mesh->centre[0] == BRICKS / 2.);
  assert_int_equal(SliceMeshReset(&slice), 0);
  assert_int_equal(PetscFree(mesh), 0);
  assert_int_equal(SceneDestroy(&scene), 0);
}

static void test_tags_mixed(void **state)
{
  (void)state;
  CheckSlices(0);
}

static void test_tags_far_apart(void **state)
{
  (void)state;
  CheckSlices(1);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_tags_mixed), cmocka_unit_test(test_tags_far_apart)};
  char                    path[128];
  int                     failed;

  if (PetscInitializeNoArguments()) return 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  if (!rank) {
    snprintf(folder, sizeof(folder), "/tmp/burnish_slices_XXXXXX");
    if (!mkdtemp(folder)) return 1;
  }
  if (MPI_Bcast(folder, sizeof(folder), MPI_CHAR, 0, PETSC_COMM_WORLD)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (MPI_Barrier(PETSC_COMM_WORLD)) return 1;
  for (int i = 0; i < 2 && !rank; i++) {
    snprintf(path, sizeof(path), "%s/block.%s", folder, i ? "yaml" : "msh");
    unlink(path);
  }
  if (!rank) rmdir(folder);
  return PetscFinalize() ? 1 : failed;
}
