/* Loads have the resultants found by hand at any load parameter: tractions, dead and follower pressures, body forces,
 * in the plane and around an axis. Supports and imposed displacements follow their histories. The tangent of a follower
 * pressure is the derivative of its forces. Solves of the run are counted. */
#include "../parts.h"
#include "kernels/elementkernel.h"
#include "solve/model.h"

/* A block of 3 by 2 whose lower left corner is at (1, 0): around the axis a ring of radii 1 and 4 */
static const PartsBlock Block[] = {{"block", 3, 2, {1, 4}, {0, 2}}};

static Parts parts;

static void Create(const char *geometry, const char *kinematics, const char *loads)
{
  static char text[2048];

  snprintf(text, sizeof(text),
           "geometry: %s\nkinematics: %s\nbodies: [{volume: block, material: {law: %s, E: 100, nu: 0.3}}]\n%s\n",
           geometry, kinematics, kinematics[0] == 's' ? "linear" : "svk", loads);
  PartsCreate(1, Block, NULL, text, &parts);
}

/* Sum of the external forces at (t, parts.u), their moment about the origin, and the potential, over all ranks. */
typedef struct {
  double force[2], moment, energy;
} Resultant;

static Resultant Resulting(double t)
{
  double sum[4] = {0};

  OK(PetscArrayzero(parts.f, parts.mesh->n_nodes * 2));
  OK(LoadsResidual(parts.problem->loads, t, parts.u, parts.f, &sum[3], NULL));
  for (PetscInt node = 0; node < parts.mesh->n_nodes; node++) {
    const PetscReal *f = &parts.f[node * 2], *u = &parts.u[node * 2];
    double           X[2];

    PartsPlace(&parts, node, X);
    for (int d = 0; d < 2; d++) sum[d] -= f[d];
    sum[2] -= (X[0] + u[0]) * f[1] - (X[1] + u[1]) * f[0];
  }
  OK(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  return (Resultant){{sum[0], sum[1]}, sum[2], sum[3]};
}

static void CheckResultant(double t, double fx, double fy, double moment)
{
  const Resultant r = Resulting(t);

  assert_near(r.force[0], fx, 1e-11);
  assert_near(r.force[1], fy, 1e-11);
  assert_near(r.moment, moment, 1e-11);
}

/* A quarter turn about the origin, and twice the size. */
static void TurnAndGrow(const double X[2], double x[2])
{
  x[0] = -2 * X[1];
  x[1] = 2 * X[0];
}

static void test_traction(void **state)
{
  (void)state;
  Create("plane_strain", "finite",
         "loads: [{surface: block_top, traction: [3, -4], history: [[0, 0], [0.5, 1], [1, -1]]}]");
  CheckResultant(0, 0, 0, 0);
  CheckResultant(0.25, 4.5, -6, 2.5 * -6 - 2 * 4.5); /* half of 3 long times (3, -4), acting at (2.5, 2) */
  CheckResultant(0.5, 9, -12, 2.5 * -12 - 2 * 9);
  CheckResultant(1, -9, 12, -(2.5 * -12 - 2 * 9));
  assert_near(PartsSum(&parts, parts.f, PartsTag(&parts, 0, 0, 2), 1), -2, 1e-13); /* half a face */
  assert_near(PartsSum(&parts, parts.f, PartsTag(&parts, 0, 1, 2), 1), -4, 1e-13);
  assert_near(PartsSum(&parts, parts.f, PartsTag(&parts, 0, 1, 1), 1), 0, 0);
  PartsMove(&parts, TurnAndGrow); /* dead: the force stays, and works on the displacement of its point, which is now
                                     at (-4, 5) */
  assert_near(Resulting(0.5).force[0], 9, 1e-11);
  assert_near(Resulting(0.5).energy, -(9 * (-4 - 2.5) - 12 * (5 - 2)), 1e-11);
  assert_true(LoadsConservative(parts.problem->loads));
  PartsDestroy(&parts);
}

static void test_pressure(void **state)
{
  (void)state;
  Create("plane_strain", "finite", "loads: [{surface: block_right, pressure: 5}]");
  CheckResultant(0.4, -0.4 * 10, 0, 0.4 * 10); /* against the normal (1, 0), at (4, 1) */
  PartsMove(&parts, TurnAndGrow);
  CheckResultant(0.4, -0.4 * 10, 0, 0.4 * 10 * 8); /* the same force, at (-2, 8) */
  PartsDestroy(&parts);

  Create("plane_strain", "finite", "loads: [{surface: block_right, pressure: 5, follower: true}]");
  CheckResultant(0.4, -0.4 * 10, 0, 0.4 * 10);
  PartsMove(&parts, TurnAndGrow);
  CheckResultant(0.4, 0, -0.4 * 20, 0.4 * 20 * 2); /* against (0, 1) on twice the length, at (-2, 8) */
  assert_false(LoadsConservative(parts.problem->loads));
  PartsDestroy(&parts);

  Create("plane_strain", "small", "loads: [{surface: block_right, pressure: 5, follower: true}]");
  PartsMove(&parts, TurnAndGrow);
  assert_near(Resulting(1).force[0], -10, 1e-11); /* with small kinematics nothing follows */
  PartsDestroy(&parts);
}

/* Weight of 6 square units, its centre at (2.5, 1); around the axis the rings' volume and areas over 360 degrees. */
static void test_body_force(void **state)
{
  (void)state;
  Create("plane_strain", "finite", "loads: [{volume: block, body_force: [0.5, -2], history: [[0, 1], [1, 1]]}]");
  CheckResultant(0.3, 3, -12, 2.5 * -12 - 1 * 3);
  PartsDestroy(&parts);

  Create("axisymmetric", "finite", "loads: [{volume: block, body_force: [0, -2]}]");
  assert_near(Resulting(1).force[1], -2 * PETSC_PI * (16 - 1) * 2, 1e-10);
  PartsDestroy(&parts);

  Create("axisymmetric", "finite",
         "loads: [{surface: block_right, pressure: 3}, {surface: block_top, traction: [0, 1]}]");
  assert_near(Resulting(1).force[0], -3 * 2 * PETSC_PI * 4 * 2, 1e-10);
  assert_near(Resulting(1).force[1], PETSC_PI * (16 - 1), 1e-10);
  PartsDestroy(&parts);
}

/* A support stays at 0, imposed displacements follow their histories; both are constrained, all other dofs are free. */
static void test_prescribed(void **state)
{
  const double t[] = {0, 0.1, 0.2, 0.6, 1}, factor[] = {0, 0.5, 1, 0.5, 0};
  PetscInt     constrained = 0, rows;

  (void)state;
  Create("plane_strain", "finite",
         "supports: [{surface: block_bottom, uy: 0}]\n"
         "loads: [{surface: block_top, ux: 0.3, uy: -0.4, history: [[0, 0], [0.2, 1], [1, 0]]}]");
  for (int i = 0; i < 5; i++) {
    for (PetscInt k = 0; k < parts.mesh->n_nodes * 2; k++) parts.u[k] = 7;
    OK(LoadsPrescribe(parts.problem->loads, t[i], parts.u));
    for (PetscInt node = 0; node < parts.mesh->n_nodes; node++) {
      double X[2];

      PartsPlace(&parts, node, X);
      assert_near(parts.u[node * 2], X[1] > 1.5 ? 0.3 * factor[i] : 7, 1e-15);
      assert_near(parts.u[node * 2 + 1], X[1] > 1.5 ? -0.4 * factor[i] : X[1] < 0.5 ? 0 : 7, 1e-15);
    }
  }
  for (PetscInt node = 0; node < parts.mesh->n_nodes; node++)
    for (int d = 0; d < 2; d++)
      constrained += parts.mesh->node_owner[node] == parts_rank && LoadsPrescribed(parts.problem->loads, node * 2 + d);
  OK(MPI_Allreduce(MPI_IN_PLACE, &constrained, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  assert_int_equal(constrained, 2 * 4 + 4);
  OK(MatGetSize(parts.problem->P, &rows, NULL));
  assert_int_equal(rows, 2 * 12 - constrained);
  PartsDestroy(&parts);
}

/* Loads alone, whose forces are subtracted. */
static double Forces(Parts *p, const PetscReal *u, PetscReal *f)
{
  OK(LoadsResidual(p->problem->loads, 0.8, u, f, NULL, NULL));
  return 0;
}

static void Bend(const double X[2], double x[2])
{
  x[0] = X[0] + 0.1 * X[1] * X[1] - 0.05 * X[0];
  x[1] = X[1] + 0.08 * X[0] * X[0];
}

/* The tangent of the elements with and without the load: their difference is the load's. */
static void test_follower_tangent(void **state)
{
  static const char *const geometries[] = {"plane_strain", "axisymmetric"};
  double                   force, energy;
  Mat                      without, with;

  (void)state;
  for (int g = 0; g < 2; g++) {
    Create(geometries[g], "finite",
           "loads: [{surface: block_right, pressure: 5, follower: true}, {surface: block_top, pressure: -3, follower: "
           "true}]");
    PartsMove(&parts, Bend);
    OK(ElasticityTangent(parts.problem->elasticity, parts.u, NULL));
    OK(ElasticityMatrix(parts.problem->elasticity, NULL, NULL, &with));
    OK(MatDuplicate(with, MAT_COPY_VALUES, &without));
    OK(ElasticityTangent(parts.problem->elasticity, parts.u, NULL));
    OK(LoadsTangent(parts.problem->loads, 0.8, parts.u, parts.problem->elasticity));
    OK(ElasticityMatrix(parts.problem->elasticity, NULL, NULL, &with));
    OK(MatAYPX(without, -1, with, SAME_NONZERO_PATTERN));
    PartsDifferences(&parts, without, Forces, 1e-5, &force, &energy);
    assert_true(force < 1e-7);
    OK(MatDestroy(&without));
    PartsDestroy(&parts);
  }
}

/* Makes the loads of the second step anew, as a run does where a step ends: every node has gone by (0.2, -0.1), and
   supports exert 3 along y on each. */
static void EnterSecondStep(void)
{
  const PetscInt n = parts.mesh->n_nodes * 2;
  Archive        archive;

  for (PetscInt i = 0; i < n; i++) {
    parts.u[i] = i % 2 ? -0.1 : 0.2;
    parts.f[i] = i % 2 ? 3 : 0;
  }
  assert_int_equal(LoadsPhase(parts.problem->loads), 0);
  OK(LoadsChangePhase(parts.problem->loads, 1, parts.u, parts.f));
  OK(ArchiveKeep(PETSC_COMM_WORLD, &archive));
  OK(LoadsArchive(parts.problem->loads, archive));
  ArchiveTurn(archive);
  OK(ProblemDestroy(&parts.problem));
  OK(ProblemCreate(parts.scene, parts.mesh, 1, &parts.problem));
  OK(LoadsArchive(parts.problem->loads, archive));
  OK(ArchiveClose(&archive));
}

/* A support leaves: its forces fade, and their potential gives them. Another one comes: it holds where nodes are, or
   leads them from there to an expression. */
static void test_changing_supports(void **state)
{
  static const double times[] = {0.5, 0.625, 0.75, 0.9};
  Resultant           r;

  (void)state;
  Create("plane_strain", "small",
         "supports: [{surface: block_top, uy: 0, during: a}, {surface: block_bottom, uy: 0, during: [b, c]},\n"
         "  {surface: block_left, ux: \"0.1*x + y\", during: [b, c]}]\nloads: []\n"
         "stepping: {control: fixed, initial: 0.1, steps: [{name: a, until: 0.5}, {name: b, until: 0.75}, {name: c, "
         "until: 1}]}");
  CheckResultant(0.2, 0, 0, 0);
  EnterSecondStep();
  assert_int_equal(LoadsPhase(parts.problem->loads), 1);
  for (int k = 0; k < 4; k++) {
    const double t = times[k], left = PetscMax(0, (0.75 - t) / 0.25);

    r = Resulting(t);
    assert_near(r.force[0], 0, 1e-12);
    assert_near(r.force[1], 4 * 3 * left, 1e-12); /* four nodes on top */
    assert_near(r.energy, -4 * 3 * left * -0.1, 1e-12);
    OK(LoadsPrescribe(parts.problem->loads, t, parts.u));
    for (PetscInt node = 0; node < parts.mesh->n_nodes; node++) {
      double X[2];

      PartsPlace(&parts, node, X);
      if (LoadsPrescribed(parts.problem->loads, node * 2))
        assert_near(parts.u[node * 2], 0.2 * left + (0.1 * X[0] + X[1]) * (1 - left), 1e-14);
      assert_near(parts.u[node * 2 + 1], -0.1, 1e-15);
    }
  }
  PartsDestroy(&parts);
}

/* A linear problem is solved once for each load parameter, and every solve is looked at. */
static void test_counts(void **state)
{
  LinearCounts counts;
  SolveReport  report;
  Model        model;

  (void)state;
  Create("plane_strain", "small",
         "supports: [{surface: block_bottom, ux: 0, uy: 0}]\nloads: [{surface: block_top, traction: [1, 2]}]\n"
         "solver: {type: direct}");
  OK(ProblemDestroy(&parts.problem));
  OK(ModelCreate(parts.scene, parts.mesh, &model));
  OK(ModelPlace(model, 1));
  OK(ModelSetUp(model));
  for (int step = 1; step <= 2; step++) {
    OK(ModelSolve(model, 0.5 * step, &report));
    assert_int_equal(report.result, SOLVE_CONVERGED);
    OK(ModelAccept(model));
    LinearCheckGetCounts(model->linear, &counts);
    assert_true(counts.solves == step && counts.refined == 0 && counts.steps == 0 && counts.inaccurate == 0);
    assert_true(counts.worst < 1e-12);
    assert_false(LinearCheckLost(model->linear));
  }
  OK(ModelDestroy(&model));
  PartsDestroy(&parts);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_traction),
                                     cmocka_unit_test(test_pressure),
                                     cmocka_unit_test(test_body_force),
                                     cmocka_unit_test(test_prescribed),
                                     cmocka_unit_test(test_follower_tangent),
                                     cmocka_unit_test(test_changing_supports),
                                     cmocka_unit_test(test_counts)};

  if (PartsStart(&argc, &argv)) return 1;
  return PartsEnd(cmocka_run_group_tests(tests, NULL, NULL));
}
