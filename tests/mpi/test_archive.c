/* What goes into an archive comes out of it, whole, on the same ranks; a file that is given up leaves the one before
 * alone. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>
#include <unistd.h>
#include "files/archive.h"

enum { ROWS = 5, WIDTH = 2 }; /* of each rank */
static const char name[] = "test_archive.h5";

typedef struct {
  PetscReal  real[2], items[ROWS * WIDTH];
  PetscInt   n, *list;
  PetscInt64 n_bytes;
  char      *text, *bytes;
  PetscBool  flag;
} State;

static PetscMPIInt Rank(void)
{
  PetscMPIInt rank;

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}

/* Items stand in rows that go down with the rank, so that they have a way to go. */
static void StateArchive(State *state, Archive archive)
{
  PetscMPIInt size;
  PetscInt    key[ROWS];
  Hdf5Table   rows;

  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  for (int i = 0; i < ROWS; i++) key[i] = 10 * (size - Rank()) - i;
  assert_int_equal(Hdf5TableCreateByKey(PETSC_COMM_WORLD, ROWS, key, &rows), 0);
  assert_int_equal(rows.total, ROWS * size);
  assert_int_equal(ArchiveReals(archive, "group/real", 2, state->real), 0);
  assert_int_equal(ArchiveRows(archive, "group/items", &rows, WIDTH, state->items), 0);
  assert_int_equal(ArchiveIntegerList(archive, "list", &state->n, &state->list), 0);
  assert_int_equal(ArchiveText(archive, "text", &state->text), 0);
  assert_int_equal(ArchiveBytes(archive, "bytes", &state->n_bytes, &state->bytes), 0);
  assert_int_equal(ArchiveBoolean(archive, "flag", &state->flag), 0);
  assert_int_equal(ArchiveReals(archive, "none", 0, NULL), 0);
  assert_int_equal(Hdf5TableDestroy(&rows), 0);
}

static State StateFill(PetscInt *list, char *text, char *bytes)
{
  State state = {.real    = {1.0 / 3, NAN},
                 .n       = 3,
                 .list    = list,
                 .text    = text,
                 .bytes   = bytes,
                 .n_bytes = 1 + Rank(),
                 .flag    = PETSC_TRUE};

  for (int i = 0; i < ROWS * WIDTH; i++) state.items[i] = 100 * Rank() + i;
  for (int i = 0; i < state.n_bytes; i++) bytes[i] = (char)('a' + Rank());
  return state;
}

static void Save(State *state)
{
  Archive    archive;
  PetscInt64 bytes;

  assert_int_equal(ArchiveMeasure(PETSC_COMM_WORLD, &archive), 0);
  StateArchive(state, archive);
  assert_int_equal(ArchiveSize(archive, &bytes), 0);
  assert_int_equal(ArchiveClose(&archive), 0);
  assert_int_equal(ArchiveCreate(PETSC_COMM_WORLD, name, bytes, &archive), 0);
  assert_false(ArchiveLoads(archive));
  StateArchive(state, archive);
  assert_int_equal(ArchiveClose(&archive), 0);
}

/* Loads a state, compares it with what was saved, and frees it. */
static void Load(const State *saved, Archive archive)
{
  State      loaded = {0};
  PetscInt64 all    = saved->n_bytes, bytes;
  PetscBool  there;

  assert_true(ArchiveLoads(archive));
  StateArchive(&loaded, archive);
  assert_true(loaded.real[0] == 1.0 / 3 && PetscIsNanReal(loaded.real[1]) && loaded.flag);
  assert_memory_equal(loaded.items, saved->items, sizeof(saved->items));
  assert_int_equal(loaded.n, 3);
  assert_memory_equal(loaded.list, saved->list, 3 * sizeof(PetscInt));
  assert_string_equal(loaded.text, saved->text);
  bytes = loaded.n_bytes;
  assert_int_equal(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPIU_INT64, MPI_SUM, PETSC_COMM_WORLD), 0);
  assert_int_equal(MPI_Allreduce(MPI_IN_PLACE, &bytes, 1, MPIU_INT64, MPI_SUM, PETSC_COMM_WORLD), 0);
  assert_true(all == bytes);
  assert_int_equal(ArchiveHas(archive, "group/items", &there), 0);
  assert_true(there);
  assert_int_equal(ArchiveHas(archive, "no/such/value", &there), 0);
  assert_false(there);
  PetscFree(loaded.list);
  PetscFree(loaded.text);
  PetscFree(loaded.bytes);
}

static void test_round_trip(void **unused)
{
  PetscInt list[3] = {7, -1, 3};
  char     text[]  = "a text\n", bytes[64];
  State    saved   = StateFill(list, text, bytes);
  Archive  archive;

  (void)unused;
  Save(&saved);
  assert_int_not_equal(access("test_archive.h5.tmp", F_OK), 0);
  assert_int_equal(ArchiveOpen(PETSC_COMM_WORLD, name, &archive), 0);
  assert_false(ArchiveRenumbers(archive));
  Load(&saved, archive);
  assert_int_equal(ArchiveClose(&archive), 0);
}

/* An archive in memory gives each rank its own values. */
static void test_memory(void **unused)
{
  PetscInt list[3] = {7, -1, 3};
  char     text[]  = "a text\n", bytes[64];
  State    saved   = StateFill(list, text, bytes);
  Archive  archive;

  (void)unused;
  assert_int_equal(ArchiveKeep(PETSC_COMM_WORLD, &archive), 0);
  assert_true(ArchiveRenumbers(archive));
  assert_false(ArchiveLoads(archive));
  StateArchive(&saved, archive);
  ArchiveTurn(archive);
  Load(&saved, archive);
  Load(&saved, archive);
  assert_int_equal(ArchiveClose(&archive), 0);
}

/* No disk has so much room, and a file that cannot be finished is not begun. */
static void test_no_room(void **unused)
{
  PetscMPIInt size;
  Archive     archive;

  (void)unused;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  if (size > 1) skip(); /* the error is rank 0's, the others would wait for it */
  PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  assert_int_equal(ArchiveCreate(PETSC_COMM_WORLD, name, (PetscInt64)1 << 60, &archive), PETSC_ERR_FILE_WRITE);
  PetscPopErrorHandler();
  assert_int_equal(access(name, F_OK), 0);
  assert_int_not_equal(access("test_archive.h5.tmp", F_OK), 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_round_trip), cmocka_unit_test(test_memory),
                                     cmocka_unit_test(test_no_room)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  MPI_Barrier(PETSC_COMM_WORLD);
  if (!Rank()) unlink(name);
  return PetscFinalize() || failed;
}
