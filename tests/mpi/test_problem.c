/* The problem of a scene: its residual is the derivative of its energy, its tangent that of its residual; energies,
 * reactions and motions are those found by hand. Newton's method on it converges with order two, solves a linear
 * problem at once and finds the contact that is known; histories are extrapolated where they are smooth. */
#include "../parts.h"
#include "modelimpl.h"
#include "contactimpl.h"

enum { LOWER, UPPER };
static const PartsBlock Blocks[] = {{"lower", 3, 1, {0, 3}, {0, 1}}, {"upper", 2, 1, {1.2, 1.8}, {1.1, 1.7}}};
static const PartsBlock Bar[]    = {{"bar", 3, 1, {0, 3}, {0, 1}}};
#define LEFT PartsTag(&parts, UPPER, 0, 0)

static Parts parts;

static double Residual(Parts *p, const PetscReal *u, PetscReal *f)
{
  PetscReal energy;
  PetscBool ok;

  OK(ProblemResidual(p->problem, u, 1, 1, &ok));
  assert_true(ok);
  OK(PetscArraycpy(f, p->problem->f, p->mesh->n_nodes * 2));
  OK(ProblemEnergy(p->problem, u, 1, ENERGY_POTENTIAL, &energy, &ok));
  return energy;
}

/* Both bodies bend, the upper one into the lower one. */
static void Bend(const double X[2], double x[2])
{
  const double s = X[0] - 1.45;

  x[0] = X[0] + (X[1] > 1.05 ? 0.02 * X[1] : 0.01 * s * X[1]);
  x[1] = X[1] + (X[1] > 1.05 ? -0.15 + 0.03 * s : -0.12 * s * s * X[1]);
}

static void test_consistent(void **state)
{
  static const char text[] =
    "geometry: plane_strain\nkinematics: finite\nbodies:\n"
    "  - {volume: lower, material: {law: svk, E: 1000, nu: 0.3}}\n"
    "  - {volume: upper, material: {law: neo_hookean, E: 500, nu: 0.2}}\n"
    "supports: [{surface: lower_bottom, ux: 0, uy: 0}]\n"
    "loads:\n  - {surface: upper_top, pressure: 20}\n  - {surface: upper_right, traction: [3, -4]}\n"
    "  - {volume: lower, body_force: [1, -2]}\n"
    "contact: [{name: joint, slave: upper_bottom, master: lower_top, smoother: facet, "
    "formulation: node_to_surface, penalty: {initial: 1000}}]\n";
  double        force, energy;
  PetscReal     part[3], all;
  PetscBool     ok;
  TangentChange change;
  Vec           v, joined, bordered;

  (void)state;
  PartsCreate(2, Blocks, NULL, text, &parts);
  PartsMove(&parts, Bend);
  OK(LoadsPrescribe(parts.problem->loads, 1, parts.u));
  OK(ProblemGatherLists(parts.problem, parts.u, 0, 1, 0.3));
  (void)Residual(&parts, parts.u, parts.f);
  OK(ProblemTangent(parts.problem, parts.u, NULL, 1, &change));
  assert_non_null(change.C);
  PartsDifferences(&parts, parts.problem->A, Residual, 1e-6, &force, &energy);
  assert_true(force < 1e-6 && energy < 1e-6);

  OK(ProblemEnergy(parts.problem, parts.u, 1, ENERGY_ELASTIC, &part[0], &ok));
  OK(ProblemEnergy(parts.problem, parts.u, 1, ENERGY_LOADS, &part[1], &ok));
  OK(ProblemEnergy(parts.problem, parts.u, 1, ENERGY_CONTACT, &part[2], &ok));
  OK(ProblemEnergy(parts.problem, parts.u, 1, ENERGY_POTENTIAL, &all, &ok));
  assert_true(part[0] > 0 && part[1] != 0 && part[2] > 0);
  assert_near(all, part[0] + part[1] + part[2], 1e-13 * fabs(all));

  /* The bordered form keeps contact apart and multiplies alike. */
  OK(MatCreateVecs(parts.problem->A, &v, &joined));
  OK(VecDuplicate(joined, &bordered));
  PartsDirection(&parts, v, parts.f);
  OK(MatMult(parts.problem->A, v, joined));
  OK(ProblemSetForm(parts.problem, TANGENT_BORDERED));
  OK(ProblemTangent(parts.problem, parts.u, NULL, 1, &change));
  OK(MatMult(parts.problem->A, v, bordered));
  OK(VecNorm(joined, NORM_2, &part[0]));
  OK(VecAXPY(bordered, -1, joined));
  OK(VecNorm(bordered, NORM_2, &part[1]));
  assert_true(part[1] < 1e-13 * part[0]);
  OK(MatMult(parts.problem->P, v, bordered)); /* P alone is without contact */
  OK(VecAXPY(bordered, -1, joined));
  OK(VecNorm(bordered, NORM_2, &part[1]));
  assert_true(part[1] > 1e-3 * part[0]);
  OK(VecDestroy(&v));
  OK(VecDestroy(&joined));
  OK(VecDestroy(&bordered));
  PartsDestroy(&parts);
}

#define STRETCH 1.5
#define BAR_E   100.
/* Nominal stress of a bar without lateral contraction in St. Venant-Kirchhoff's law: F S, with S = E (F^2 - 1) / 2 */
static const double Nominal = STRETCH * BAR_E * (STRETCH * STRETCH - 1) / 2;

static const char *BarText(const char *kinematics, const char *law, const char *loads)
{
  static char text[1024];

  snprintf(text, sizeof(text),
           "geometry: plane_strain\nkinematics: %s\nbodies: [{volume: bar, material: {law: %s, E: %g, nu: 0}}]\n"
           "supports: [{surface: bar_left, ux: 0}, {surface: bar_bottom, uy: 0}]\nloads: [%s]\n"
           "solver: {type: direct, tolerance: 1e-12}\n",
           kinematics, law, BAR_E, loads);
  return text;
}

static void Stretch(const double X[2], double x[2])
{
  x[0] = STRETCH * X[0];
  x[1] = X[1];
}

/* A stretched bar of 3 by 1: elastic energy, potential of a traction, reaction, force scale, motions. */
static void test_bar(void **state)
{
  const double strain = (STRETCH * STRETCH - 1) / 2;
  PetscReal    energy, force[3], motion, *zero;
  PetscBool    ok;

  (void)state;
  PartsCreate(1, Bar, NULL,
              BarText("finite", "svk",
                      "{surface: bar_right, ux: 1.5, history: [[0, 0], [0.5, 1], [1, 0.5]]}, "
                      "{surface: bar_top, traction: [2, 0]}"),
              &parts);
  PartsMove(&parts, Stretch);
  OK(ProblemEnergy(parts.problem, parts.u, 0.5, ENERGY_ELASTIC, &energy, &ok));
  assert_near(energy, 3 * BAR_E * strain * strain / 2, 1e-12);
  OK(ProblemEnergy(parts.problem, parts.u, 0.5, ENERGY_LOADS, &energy, &ok));
  assert_near(energy, -0.5 * 2 * 3 * 0.75, 1e-12); /* half the traction, times the mean displacement */
  OK(ProblemResidual(parts.problem, parts.u, 0, 0, &ok));
  OK(ProblemReaction(parts.problem, &parts.mesh->groups[MeshFindGroup(parts.mesh, 1, "bar_right")], force, NULL));
  assert_near(force[0], Nominal, 1e-11);
  assert_near(force[1], 0, 1e-12);
  OK(ProblemReaction(parts.problem, &parts.mesh->groups[MeshFindGroup(parts.mesh, 1, "bar_left")], force, NULL));
  assert_near(force[0], -Nominal, 1e-11);
  assert_near(ProblemForceScale(parts.problem), Nominal * sqrt(3 * 4 * 0.25),
              1e-11); /* half of it at 4 nodes of 3 cells */
  OK(PetscCalloc1(parts.mesh->n_nodes * 2, &zero));
  OK(ProblemMotion(parts.problem, zero, 0, parts.u, 1, &motion));
  assert_near(motion, 1.5, 1e-14);
  OK(ProblemImposedMotion(parts.problem, zero, 0, 0.25, &motion));
  assert_near(motion, 0.75, 1e-14);
  OK(ProblemImposedMotion(parts.problem, parts.u, 0.5, 1, &motion));
  assert_near(motion, 0.75, 1e-14);
  OK(PetscFree(zero));
  PartsDestroy(&parts);
}

static void Shift(const double X[2], double x[2])
{
  x[0] = X[0] + 1e4 / 3;
  x[1] = X[1] - 1e4 / 7;
}

/* A body that is far away and without any force: its residual is below the estimate of round-off, which is
   proportional to the way. */
static void test_round_off(void **state)
{
  static const char text[] = "geometry: plane_strain\nkinematics: finite\n"
                             "bodies: [{volume: bar, material: {law: svk, E: 100, nu: 0.3}}]\n";
  PetscReal         estimate, twice, norm;
  PetscBool         ok;
  TangentChange     change;
  Vec               x, F;

  (void)state;
  PartsCreate(1, Bar, NULL, text, &parts);
  PartsMove(&parts, Shift);
  OK(MatCreateVecs(parts.problem->A, &x, &F));
  OK(MeshCollectFree(parts.mesh, parts.u, x));
  OK(ProblemSetTrial(parts.problem, x, 0));
  OK(ProblemResidual(parts.problem, parts.problem->trial, 0, 0, &ok));
  OK(ProblemCollectResidual(parts.problem, x, F));
  OK(ProblemTangent(parts.problem, parts.problem->trial, NULL, 0, &change));
  OK(ProblemRoundOff(parts.problem, &estimate));
  OK(VecNorm(F, NORM_2, &norm));
  assert_true(norm > 0 && norm < estimate);
  assert_near(estimate, PROBLEM_ROUND_OFF * PETSC_MACHINE_EPSILON * parts.problem->stiffness * 1e4 / 3,
              1e-9 * estimate);
  OK(VecScale(x, 2));
  OK(ProblemSetTrial(parts.problem, x, 0));
  OK(ProblemRoundOff(parts.problem, &twice));
  assert_near(twice, 2 * estimate, 1e-12 * estimate);
  OK(VecDestroy(&x));
  OK(VecDestroy(&F));
  PartsDestroy(&parts);
}

static void Flatten(const double X[2], double x[2])
{
  x[0] = X[0];
  x[1] = 1e-6 * X[1];
}

static void Halve(const double X[2], double x[2])
{
  x[0] = X[0];
  x[1] = 0.5 * X[1];
}

/* Stiffness of the bar after `move`, from which round-off is estimated, and norm of the diagonal of its tangent. */
static void Stiffness(void (*move)(const double X[2], double x[2]), PetscReal *stiffness, PetscReal *diagonal)
{
  TangentChange change;

  PartsMove(&parts, move);
  OK(ProblemTangent(parts.problem, parts.u, NULL, 0, &change));
  OK(VecNorm(parts.problem->diagonal, NORM_2, diagonal));
  *stiffness = parts.problem->stiffness;
}

/* Where elements are nearly inverted, their stiffness has no bound. Residuals that are no round-off stay above the
   estimate even so. */
static void test_round_off_flat(void **state)
{
  static const char text[] = "geometry: plane_strain\nkinematics: finite\n"
                             "bodies: [{volume: bar, material: {law: neo_hookean, E: 100, nu: 0.3}}]\n";
  PetscReal         undeformed, half, flat, diagonal;

  (void)state;
  PartsCreate(1, Bar, NULL, text, &parts);
  OK(VecNorm(parts.problem->undeformed, NORM_2, &undeformed));
  Stiffness(Halve, &half, &diagonal);
  assert_near(half, diagonal, 1e-12 * diagonal);
  Stiffness(Flatten, &flat, &diagonal);
  assert_true(diagonal > 1e6 * undeformed);
  assert_true(flat > undeformed && flat < 1.001 * PROBLEM_STIFFENING * undeformed);
  PartsDestroy(&parts);
}

/* The model of parts.scene; the problem of parts goes, because a model makes its own. */
static Model Start(void)
{
  Model model;

  OK(ProblemDestroy(&parts.problem));
  OK(ModelCreate(parts.scene, parts.mesh, &model));
  OK(ModelPlace(model, 1));
  OK(ModelSetUp(model));
  return model;
}

/* The bar under the traction that stretches it by a half: the residual's exponent doubles from iterate to iterate. */
static void test_quadratic(void **state)
{
  PetscReal   norm[30];
  PetscInt    n;
  char        load[128];
  SolveReport report;
  Model       model;

  (void)state;
  snprintf(load, sizeof(load), "{surface: bar_right, traction: [%.17g, 0]}", Nominal);
  PartsCreate(1, Bar, NULL, BarText("finite", "svk", load), &parts);
  model = Start();
  OK(SNESSetConvergenceHistory(model->snes, norm, NULL, 30, PETSC_TRUE));
  OK(ModelSolve(model, 1, &report));
  assert_int_equal(report.result, SOLVE_CONVERGED);
  OK(SNESGetConvergenceHistory(model->snes, NULL, NULL, &n));
  assert_true(n >= 4);
  for (PetscInt k = 0; k + 1 < n; k++) /* the stiffness grows by 4.75 / 1, so that the factor is below 1 */
    if (norm[k] < 0.1 * Nominal) assert_true(norm[k + 1] < norm[k] * norm[k] / Nominal + 1e-11 * Nominal);
  for (PetscInt node = 0; node < parts.mesh->n_nodes; node++) {
    double X[2];

    PartsPlace(&parts, node, X);
    assert_near(model->u[node * 2], (STRETCH - 1) * X[0], 1e-9);
    assert_near(model->u[node * 2 + 1], 0, 1e-9);
  }
  OK(ModelDestroy(&model));
  PartsDestroy(&parts);
}

/* One linear solve finds the answer of a linear problem: u = sigma x / E. */
static void test_linear(void **state)
{
  SolveReport report;
  Model       model;

  (void)state;
  PartsCreate(1, Bar, NULL, BarText("small", "linear", "{surface: bar_right, traction: [5, 0]}"), &parts);
  model = Start();
  assert_true(ProblemIsLinear(model->problem));
  OK(ModelSolve(model, 1, &report));
  assert_int_equal(report.result, SOLVE_CONVERGED);
  assert_true(report.newton == 1 && report.krylov == 1 && report.cuts[CUT_SHAPE] == 0);
  for (PetscInt node = 0; node < parts.mesh->n_nodes; node++) {
    double X[2];

    PartsPlace(&parts, node, X);
    assert_near(model->u[node * 2], 5 * X[0] / BAR_E, 1e-12);
  }
  OK(ModelRestore(model)); /* back to t = 0, and to the same answer */
  assert_true(model->t == 0);
  OK(ModelSolve(model, 1, &report));
  assert_int_equal(report.newton, 1);
  OK(ModelAccept(model));
  OK(ModelDestroy(&model));
  PartsDestroy(&parts);
}

/* Two blocks one above the other, 0.1 apart, in the plane without Poisson's ratio: the upper one is pressed down by
   0.3. The pair's other keys and the rest of the scene follow. */
static const PartsBlock column[] = {{"lower", 2, 1, {0, 1}, {0, 1}}, {"upper", 2, 1, {0, 1}, {1.1, 1.7}}};
#define COLUMN                                                                        \
  "geometry: plane_strain\nkinematics: small\nbodies:\n"                              \
  "  - {volume: lower, material: {law: linear, E: 1000, nu: 0}}\n"                    \
  "  - {volume: upper, material: {law: linear, E: 500, nu: 0}}\n"                     \
  "supports: [{surface: lower_bottom, ux: 0, uy: 0}, {surface: upper_top, ux: 0}]\n"  \
  "loads: [{surface: upper_top, uy: -0.3}]\n"                                         \
  "contact: [{name: joint, slave: lower_top, master: upper_bottom, smoother: facet, " \
  "formulation: node_to_surface"

/* Two blocks in line, 0.1 apart, pressed by 0.3: springs in series, which the linear step with contact finds. */
static void test_linear_contact(void **state)
{
  static const char text[]     = COLUMN ", penalty: {initial: 2000}}]\nsolver: {type: direct, tolerance: 1e-12}\n";
  const double      compliance = 1 / 1000. + 0.6 / 500. + 1 / 2000.;
  const double      pressure = 0.2 / compliance, share = 1 / 2000. / compliance;
  PenaltyError      error;
  PetscReal         force[3];
  SolveReport       report;
  Model             model;

  (void)state;
  PartsCreate(2, column, NULL, text, &parts);
  model = Start();
  OK(ModelSolve(model, 1, &report));
  assert_int_equal(report.result, SOLVE_CONVERGED);
  OK(ContactMasterForce(model->contact, 0, force));
  assert_near(force[1], pressure, 1e-9);
  OK(ProblemReaction(model->problem, &parts.mesh->groups[MeshFindGroup(parts.mesh, 1, "upper_top")], force, NULL));
  assert_near(force[1], -pressure, 1e-9);
  assert_true(report.newton <= 2);
  error = ModelPenaltyError(model, 0); /* of the three springs in series, the third is the penalty */
  assert_near(error.force, share, 1e-9);
  assert_near(error.pressure, share, 1e-9);
  assert_near(error.peak, share, 1e-9);
  assert_near(error.displacement, share * pressure * 0.6 / 500. / 0.3, 1e-9);
  OK(ModelDestroy(&model));
  PartsDestroy(&parts);
}

/* A raise of the penalty for depth that fails and then succeeds by its square root has no estimate to be judged by: the
   next one does not take it for a raise that brought too little. */
static void test_raise_for_depth(void **state)
{
  static const char text[] = COLUMN "}]\ncertificate: {penetration: 1e-12}\nsolver: {type: direct, tolerance: 1e-12}\n";
  PetscReal         factor[PENALTY_SOURCES];
  PetscBool         stiffened;
  SolveReport       report;
  Model             model;

  (void)state;
  PartsCreate(2, column, NULL, text, &parts);
  model = Start();
  OK(ModelSolve(model, 1, &report));
  assert_int_equal(report.result, SOLVE_CONVERGED);
  assert_false(ModelPenaltyStays(model, 0));
  OK(ModelStiffenDeep(model, factor, &stiffened));
  assert_true(stiffened && factor[BY_PENETRATION] > 1);
  OK(ModelUnstiffen(model, factor, PETSC_FALSE));
  OK(ModelStiffenLess(model, factor, PETSC_FALSE));
  OK(ModelEstimatePenalty(model));
  assert_false(ModelPenaltyStays(model, 0));
  OK(ModelUnstiffen(model, factor, PETSC_TRUE)); /* one for an estimate would have been judged */
  assert_true(ModelPenaltyStays(model, 0));
  OK(ModelDestroy(&model));
  PartsDestroy(&parts);
}

/* The upper block is moved so that its left node alone meets the lower one. */
static void test_active_set(void **state)
{
  static const char text[] =
    "geometry: plane_strain\nkinematics: small\nbodies:\n"
    "  - {volume: lower, material: {law: linear, E: 1000, nu: 0.3}}\n"
    "  - {volume: upper, material: {law: linear, E: 1000, nu: 0.3}}\n"
    "supports: [{surface: lower_bottom, ux: 0, uy: 0}, {surface: upper_left, ux: 0}, {surface: upper_right, ux: 0}]\n"
    "loads: [{surface: upper_left, uy: -0.2}, {surface: upper_right, uy: 0.1}]\n"
    "contact: [{name: joint, slave: upper_bottom, master: lower_top, smoother: facet, "
    "formulation: node_to_surface, penalty: {initial: 2000}}]\n"
    "solver: {type: direct, tolerance: 1e-12}\n";
  PetscReal      force[3], reaction[3];
  ContactSummary summary;
  ContactNodes   nodes;
  SolveReport    report;
  Model          model;

  (void)state;
  PartsCreate(2, Blocks, NULL, text, &parts);
  model = Start();
  OK(ModelSolve(model, 1, &report));
  assert_int_equal(report.result, SOLVE_CONVERGED);
  /* The first linear step finds the set. The others follow the facet, which turns under the node, with order two:
     today two, so that all take three. A step that changes the set would take one more each time. */
  assert_true(report.newton <= 4);
  OK(ContactSummarise(model->contact, &summary));
  assert_true(summary.nodes == 1 && summary.in == 1 && summary.out == 0);
  OK(ContactGetNodes(model->contact, 0, model->u, &nodes));
  for (PetscInt c = 0; c < nodes.n; c++) {
    if (parts.mesh->node_tag[nodes.node[c]] != LEFT)
      assert_true(nodes.force[c] == 0 && nodes.gap[c] > 0);
    else
      assert_near(nodes.force[c], -2000 * nodes.area[c] * nodes.gap[c], 1e-10);
  }
  OK(ContactMasterForce(model->contact, 0, force));
  OK(ProblemReaction(model->problem, &parts.mesh->groups[MeshFindGroup(parts.mesh, 1, "lower_bottom")], reaction, NULL));
  assert_true(force[1] < 0);
  assert_near(reaction[1], -force[1], 1e-9);
  OK(ModelDestroy(&model));
  PartsDestroy(&parts);
}

/* A history of degree 3 or less is extrapolated exactly; after a jump it is not trusted; a break forgets it. */
static double Cubic(double t, PetscInt k, int jump)
{
  return (1 + 0.1 * k) * t - 0.4 * t * t + 0.02 * k * t * t * t + jump;
}

static void test_extrapolation(void **state)
{
  static const double t[] = {0.05, 0.1, 0.25, 0.4, 0.5, 0.6};
  PetscBool           smooth;
  Extrapolation       extrapolation;
  PetscInt            n;

  (void)state;
  PartsCreate(1, Bar, NULL, BarText("finite", "svk", "{surface: bar_right, ux: 1}"), &parts);
  n = parts.mesh->n_nodes * 2;
  OK(ExtrapolationCreate(parts.mesh, &extrapolation));
  for (int i = 0; i < 6; i++) {
    for (PetscInt k = 0; k < n; k++) parts.u[k] = Cubic(t[i], parts.mesh->node_tag[k / 2], 0);
    OK(ExtrapolationAdd(extrapolation, parts.u, t[i]));
    OK(ExtrapolationEvaluate(extrapolation, t[i] + 0.01, parts.f, &smooth));
    if (i < 2) assert_false(smooth); /* nothing to judge by */
  }
  OK(ExtrapolationEvaluate(extrapolation, 0.8, parts.f, &smooth));
  assert_true(smooth);
  for (PetscInt k = 0; k < n; k++) assert_near(parts.f[k], Cubic(0.8, parts.mesh->node_tag[k / 2], 0), 1e-12);
  for (PetscInt k = 0; k < n; k++) parts.u[k] = Cubic(0.7, parts.mesh->node_tag[k / 2], 1);
  OK(ExtrapolationAdd(extrapolation, parts.u, 0.7));
  OK(ExtrapolationEvaluate(extrapolation, 0.8, parts.f, &smooth));
  assert_false(smooth);
  OK(ExtrapolationForget(extrapolation));
  for (int i = 0; i < 2; i++) {
    OK(ExtrapolationEvaluate(extrapolation, 0.95, parts.f, &smooth));
    assert_false(smooth);
    for (PetscInt k = 0; k < n; k++) parts.u[k] = 1 + k * (0.8 + 0.1 * i);
    OK(ExtrapolationAdd(extrapolation, parts.u, 0.8 + 0.1 * i));
  }
  OK(ExtrapolationDestroy(&extrapolation));
  PartsDestroy(&parts);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_consistent),     cmocka_unit_test(test_bar),
    cmocka_unit_test(test_round_off),      cmocka_unit_test(test_round_off_flat),
    cmocka_unit_test(test_quadratic),      cmocka_unit_test(test_linear),
    cmocka_unit_test(test_linear_contact), cmocka_unit_test(test_raise_for_depth),
    cmocka_unit_test(test_active_set),     cmocka_unit_test(test_extrapolation)};

  if (PartsStart(&argc, &argv)) return 1;
  return PartsEnd(cmocka_run_group_tests(tests, NULL, NULL));
}
