/* A body that is turned as a whole takes vectors along at every node, those of held nodes in the plane in which they
 * are free, whatever the cells and ranks; back again they are what they were; from a new beginning they stay. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "linear/corotation.h"

static char        folder[64];
static PetscMPIInt rank;

static const char *const files[][2] = {
  {"block.geo",
   "Point(1) = {0, 0, 0}; Point(2) = {3, 0, 0}; Point(3) = {3, 1, 0}; Point(4) = {0, 1, 0};\n"
   "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1, 2, 3, 4}; Plane "
   "Surface(1) = {1};\n"
   "Transfinite Curve{1, 3} = 4; Transfinite Curve{2, 4} = 2; Transfinite Surface{1}; Recombine Surface{1};\n"
   "If(solid) v[] = Extrude{0, 0, solid / 2} { Surface{1}; Layers{1}; Recombine; }; Physical Volume(\"block\") = "
   "{v[1]}; Physical Surface(\"end\") = {1};\n"
   "Else Physical Surface(\"block\") = {1}; Physical Curve(\"end\") = {4}; EndIf\n"},
  {"solid.yaml", "mesh: {file: block.geo, order: 2, parameters: {solid: 1}}\ngeometry: solid\nbodies: [{volume: block, "
                 "material: {law: svk, E: 1, nu: 0.3}}]\n"
                 "supports: [{surface: end, uz: 0}]\n"},
  {"sheet.yaml", "mesh: {file: block.geo, order: 1, parameters: {solid: 0.01}}\ngeometry: solid\nbodies: [{volume: "
                 "block, material: {law: svk, E: 1, nu: 0.3}}]\n"
                 "supports: [{surface: end, uz: 0}]\n"},
  {"plane.yaml", "mesh: {file: block.geo, order: 1, parameters: {solid: 0}}\ngeometry: plane_strain\nbodies: [{volume: "
                 "block, material: {law: svk, E: 1, nu: 0.3}}]\n"
                 "supports: [{surface: end, ux: 0}]\n"}};

static Mesh MakeMesh(const char *name, Scene *scene)
{
  char      path[PETSC_MAX_PATH_LEN], file[PETSC_MAX_PATH_LEN];
  PetscReal seconds;
  Mesh      mesh;

  snprintf(path, sizeof(path), "%s/%s", folder, name);
  assert_int_equal(SceneRead(PETSC_COMM_WORLD, path, 0, NULL, scene), 0);
  assert_int_equal(MeshGenerate(PETSC_COMM_WORLD, *scene, folder, PETSC_FALSE, file, &seconds), 0);
  assert_int_equal(MeshCreate(PETSC_COMM_WORLD, *scene, file, &mesh), 0);
  return mesh;
}

/* Rotation by an angle about an axis of unit length */
static void Rotation(const double axis[3], double angle, double R[9])
{
  const double c = cos(angle), s = sin(angle);

  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) R[3 * i + j] = c * (i == j) + (1 - c) * axis[i] * axis[j];
  for (int i = 0; i < 3; i++) {
    R[3 * ((i + 2) % 3) + (i + 1) % 3] += s * axis[i];
    R[3 * ((i + 1) % 3) + (i + 2) % 3] -= s * axis[i];
  }
}

/* What a vector has at a node */
static double Value(Mesh mesh, PetscInt node, int k)
{
  return sin(1 + 3.7 * (double)mesh->node_id[node] + k);
}

/* The largest miss at free dofs: from what turned values are, R NULL: from the values */
static double Miss(Mesh mesh, Vec x, const double *R)
{
  const PetscInt    *dof;
  const PetscScalar *a;
  PetscInt           first, end;
  double             most = 0;

  assert_int_equal(MeshGetGlobalDofs(mesh, &dof), 0);
  assert_int_equal(VecGetOwnershipRange(x, &first, &end), 0);
  assert_int_equal(VecGetArrayRead(x, &a), 0);
  for (PetscInt i = 0; i < mesh->n_nodes * mesh->dim; i++) {
    const PetscInt node = i / mesh->dim, k = i % mesh->dim;
    double         wanted = R ? 0 : Value(mesh, node, (int)k);

    if (dof[i] < first || dof[i] >= end) continue;
    for (int l = 0; l < mesh->dim && R; l++)
      wanted += dof[node * mesh->dim + l] >= 0 ? R[3 * k + l] * Value(mesh, node, l) : 0;
    most = PetscMax(most, fabs(PetscRealPart(a[dof[i] - first]) - wanted));
  }
  assert_int_equal(VecRestoreArrayRead(x, &a), 0);
  assert_int_equal(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD), MPI_SUCCESS);
  return most;
}

/* held: component that nodes at z = 0 may not move in, -1: none */
static void Turn(const char *name, int held, const double axis[3], double angle)
{
  Scene           scene;
  Mesh            mesh = MakeMesh(name, &scene);
  const int       dim  = mesh->dim;
  PetscReal      *u, *from;
  PetscBool      *constrained;
  const PetscInt *dof;
  PetscInt        first, end;
  double          R[9];
  Corotation      turn;
  Vec             x;

  Rotation(axis, angle, R);
  assert_int_equal(PetscCalloc3(mesh->n_nodes * dim, &u, mesh->n_nodes * dim, &from, mesh->n_nodes * dim, &constrained),
                   0);
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    constrained[n * dim + PetscMax(held, 0)] =
      (PetscBool)(held >= 0 && fabs(mesh->coords[n * dim + held] + mesh->centre[held]) < 1e-9);
    for (int k = 0; k < dim; k++) from[n * dim + k] = 0.3 * (k + 1); /* a shift turns nothing */
    for (int k = 0; k < dim; k++)
      for (int l = 0; l < dim; l++) u[n * dim + k] += (R[3 * k + l] - (k == l)) * mesh->coords[n * dim + l];
  }
  assert_int_equal(MeshSetConstraints(mesh, constrained), 0);
  assert_int_equal(MeshGetGlobalDofs(mesh, &dof), 0);
  assert_int_equal(MeshCreateVector(mesh, &x), 0);
  assert_int_equal(VecGetOwnershipRange(x, &first, &end), 0);
  for (PetscInt i = 0; i < mesh->n_nodes * dim; i++)
    if (dof[i] >= first && dof[i] < end)
      assert_int_equal(VecSetValue(x, dof[i], Value(mesh, i / dim, (int)(i % dim)), INSERT_VALUES), 0);
  assert_int_equal(VecAssemblyBegin(x), 0);
  assert_int_equal(VecAssemblyEnd(x), 0);
  assert_int_equal(CorotationCreate(mesh, &turn), 0);
  assert_int_equal(CorotationMove(turn, from), 0);
  assert_int_equal(CorotationBegin(turn), 0);
  assert_int_equal(CorotationMove(turn, u), 0);
  assert_int_equal(CorotationFind(turn), 0);
  assert_int_equal(CorotationApply(turn, PETSC_FALSE, x), 0);
  assert_true(Miss(mesh, x, R) < 1e-12);
  assert_int_equal(CorotationApply(turn, PETSC_TRUE, x), 0);
  assert_true(Miss(mesh, x, NULL) < 1e-12);
  assert_int_equal(CorotationBegin(turn), 0);
  assert_int_equal(CorotationApply(turn, PETSC_TRUE, x), 0);
  assert_true(Miss(mesh, x, NULL) < 1e-12);
  assert_int_equal(CorotationDestroy(&turn), 0);
  assert_int_equal(VecDestroy(&x), 0);
  assert_int_equal(PetscFree3(u, from, constrained), 0);
  assert_int_equal(MeshDestroy(&mesh), 0);
  assert_int_equal(SceneDestroy(&scene), 0);
}

static void test_body_turns_as_a_whole(void **state)
{
  const double slanted[3] = {2. / 7, 3. / 7, 6. / 7}, z[3] = {0, 0, 1};

  (void)state;
  Turn("solid.yaml", -1, slanted, 0.7);
  Turn("solid.yaml", -1, slanted, -2.5);
  Turn("sheet.yaml", -1, slanted, 0.7);
  Turn("plane.yaml", -1, z, 0.7);
}

static void test_held_nodes_turn_in_their_plane(void **state)
{
  const double z[3] = {0, 0, 1};

  (void)state;
  Turn("solid.yaml", 2, z, 0.7);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_body_turns_as_a_whole),
                                     cmocka_unit_test(test_held_nodes_turn_in_their_plane)};
  char                    name[128];
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (MPI_Comm_rank(PETSC_COMM_WORLD, &rank)) return 1;
  snprintf(folder, sizeof(folder), "/tmp/burnish_turn_XXXXXX");
  if (!rank && !mkdtemp(folder)) return 1;
  if (MPI_Bcast(folder, sizeof(folder), MPI_CHAR, 0, PETSC_COMM_WORLD)) return 1;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(files) && !rank; i++) {
    FILE *stream;

    snprintf(name, sizeof(name), "%s/%s", folder, files[i][0]);
    stream = fopen(name, "w");
    if (!stream || fputs(files[i][1], stream) < 0 || fclose(stream)) return 1;
  }
  if (MPI_Barrier(PETSC_COMM_WORLD)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (MPI_Barrier(PETSC_COMM_WORLD)) return 1;
  snprintf(name, sizeof(name), "rm -r %s", folder);
  if (!rank && system(name)) failed++;
  if (PetscFinalize()) return 1;
  return failed;
}
