/* Shows that assembled forces and tangents agree with PetscFE's, entry by entry, on distorted cells with finite
 * strains. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include "../box.h"

/* Largest allowed difference of an entry, relative to the largest entry */
static const PetscReal agreement = 1e-10;

#define CHECK(call) assert_int_equal((call), PETSC_SUCCESS)

/* Finds the nodes of the library's mesh by their coordinates. place[k] is the node of PETSc's local dofs 3 k, 3 k + 1
   and 3 k + 2. */
static PetscErrorCode MatchNodes(const Box *box, DM dm, PetscInt *place)
{
  PetscErrorCode (*identity[1])(PetscInt, PetscReal, const PetscReal[], PetscInt, PetscScalar[],
                                void *) = {BoxIdentity};
  const PetscReal    tolerance          = 1e-8; /* length; the nodes of the unit box are 0.1 apart */
  const PetscScalar *x;
  Vec                coords;

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalVector(dm, &coords));
  PetscCall(DMProjectFunctionLocal(dm, 0, identity, NULL, INSERT_ALL_VALUES, coords));
  PetscCall(VecGetArrayRead(coords, &x));
  for (PetscInt k = 0; k < box->mesh->n_nodes; k++) {
    place[k] = -1;
    for (PetscInt n = 0; n < box->mesh->n_nodes && place[k] < 0; n++) {
      PetscReal distance = 0;

      for (int i = 0; i < 3; i++)
        distance = PetscMax(distance, PetscAbsReal(x[3 * k + i] - box->mesh->coords[3 * n + i]));
      if (distance < tolerance) place[k] = n;
    }
    PetscCheck(place[k] >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "PETSc's node %" PetscInt_FMT " is none of ours", k);
  }
  PetscCall(VecRestoreArrayRead(coords, &x));
  PetscCall(DMRestoreLocalVector(dm, &coords));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the largest difference of the forces, divided by the largest force. */
static PetscErrorCode CompareResiduals(const Box *box, DM dm, Elasticity e, const PetscInt *place, Vec u,
                                       PetscReal *difference)
{
  PetscReal         *f, largest = 0;
  const PetscScalar *petsc_f;
  PetscBool          ok;
  Vec                F;

  PetscFunctionBeginUser;
  *difference = 0;
  PetscCall(PetscCalloc1(box->mesh->n_nodes * 3, &f));
  PetscCall(ElasticityResidual(e, box->u, f, NULL, NULL, &ok));
  PetscCheck(ok, PETSC_COMM_SELF, PETSC_ERR_PLIB, "the displacement turns cells inside out");
  PetscCall(DMGetLocalVector(dm, &F));
  PetscCall(VecZeroEntries(F));
  PetscCall(DMPlexSNESComputeResidualFEM(dm, u, F, NULL));
  PetscCall(VecGetArrayRead(F, &petsc_f));
  for (PetscInt k = 0; k < box->mesh->n_nodes * 3; k++) {
    const PetscReal ours = f[place[k / 3] * 3 + k % 3];

    largest     = PetscMax(largest, PetscAbsReal(ours));
    *difference = PetscMax(*difference, PetscAbsReal(ours - petsc_f[k]));
  }
  *difference /= largest;
  PetscCall(VecRestoreArrayRead(F, &petsc_f));
  PetscCall(DMRestoreLocalVector(dm, &F));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the largest difference of the entries, divided by the largest entry. Fails unless both matrices have the
   same pattern. */
static PetscErrorCode CompareTangents(const Box *box, DM dm, Elasticity e, const PetscInt *place, Vec u,
                                      PetscReal *difference)
{
  PetscReal largest = 0;
  PetscInt  rows;
  Mat       K, J;

  PetscFunctionBeginUser;
  *difference = 0;
  PetscCall(ElasticityTangent(e, box->u, NULL));
  PetscCall(ElasticityMatrix(e, NULL, NULL, &K));
  PetscCall(DMCreateMatrix(dm, &J));
  PetscCall(DMPlexSNESComputeJacobianFEM(dm, u, J, J, NULL));
  PetscCall(MatGetSize(K, &rows, NULL));
  for (PetscInt row = 0; row < rows; row++) {
    const PetscInt     our_row = place[row / 3] * 3 + row % 3;
    const PetscInt    *columns;
    const PetscScalar *values;
    PetscInt           count, our_count;

    PetscCall(MatGetRow(J, row, &count, &columns, &values));
    PetscCall(MatGetRow(K, our_row, &our_count, NULL, NULL));
    PetscCheck(count == our_count, PETSC_COMM_SELF, PETSC_ERR_PLIB,
               "row %" PetscInt_FMT " has %" PetscInt_FMT " entries, PETSc's %" PetscInt_FMT, our_row, our_count,
               count);
    PetscCall(MatRestoreRow(K, our_row, &our_count, NULL, NULL));
    for (PetscInt k = 0; k < count; k++) {
      PetscScalar ours;

      PetscCall(MatGetValue(K, our_row, place[columns[k] / 3] * 3 + columns[k] % 3, &ours));
      largest     = PetscMax(largest, PetscAbsScalar(ours));
      *difference = PetscMax(*difference, PetscAbsScalar(ours - values[k]));
    }
    PetscCall(MatRestoreRow(J, row, &count, &columns, &values));
  }
  *difference /= largest;
  PetscCall(MatDestroy(&J));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Compare(ElementType type, PetscInt n)
{
  PetscErrorCode (*displacement[1])(PetscInt, PetscReal, const PetscReal[], PetscInt, PetscScalar[],
                                    void *) = {BoxDisplacement};
  PetscReal  residual, tangent;
  PetscInt  *place;
  Elasticity e;
  Box        box;
  DM         dm;
  Vec        u;

  CHECK(BoxCreate(type, n, &box));
  CHECK(ElasticityCreate(box.mesh, box.scene, &e));
  CHECK(BoxCreatePetsc(&box, &dm));
  CHECK(PetscMalloc1(box.mesh->n_nodes, &place));
  CHECK(MatchNodes(&box, dm, place));
  CHECK(DMGetLocalVector(dm, &u));
  CHECK(DMProjectFunctionLocal(dm, 0, displacement, NULL, INSERT_ALL_VALUES, u));
  CHECK(CompareResiduals(&box, dm, e, place, u, &residual));
  CHECK(CompareTangents(&box, dm, e, place, u, &tangent));
  print_message("%s, %d cells: largest relative difference of forces %.1e, of tangents %.1e\n", ElementGet(type)->name,
                (int)box.mesh->n_cells, residual, tangent);
  assert_true(residual < agreement);
  assert_true(tangent < agreement);
  CHECK(DMRestoreLocalVector(dm, &u));
  CHECK(PetscFree(place));
  CHECK(DMDestroy(&dm));
  CHECK(ElasticityDestroy(&e));
  CHECK(BoxDestroy(&box));
}

static void Tet4(void **state)
{
  (void)state;
  Compare(ELEMENT_TET4, 3);
}

static void Tet10(void **state)
{
  (void)state;
  Compare(ELEMENT_TET10, 2);
}

static void Hex8(void **state)
{
  (void)state;
  Compare(ELEMENT_HEX8, 4);
}

static void Hex27(void **state)
{
  (void)state;
  Compare(ELEMENT_HEX27, 3);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Tet4), cmocka_unit_test(Tet10), cmocka_unit_test(Hex8),
                                     cmocka_unit_test(Hex27)};
  int                     failed;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  PetscCall(PetscFinalize());
  return failed;
}
