/* Gaps, forces, energy and tangent of contact have the values found by hand, on flat, inclined and curved masters, node
 * to surface and surface to surface; so have penalties that follow their window, multipliers and initial overlaps.
 * Lists serve as long as they are good. */
#include "../parts.h"
#include "contactimpl.h"

#define PENALTY 1000.

/* A block with three facets on top, and one above it whose two lower nodes, 0.6 apart, are over the middle facet. */
enum { LOWER, UPPER };
#define LEFT  PartsTag(&parts, UPPER, 0, 0)
#define RIGHT PartsTag(&parts, UPPER, 1, 0)
static const double     Apart = 0.1, Area = 0.3;
static const PartsBlock Blocks[] = {{"lower", 3, 1, {0, 3}, {0, 1}}, {"upper", 1, 1, {1.2, 1.8}, {1.1, 1.7}}};

static Parts parts;

/* Scene of two bodies and one pair. pair: further keys of it. Facets at slave nodes are the simplest contact. */
static const char *SceneText(const char *kinematics, const char *pair)
{
  static char text[1024];

  snprintf(text, sizeof(text),
           "geometry: plane_strain\nkinematics: %s\nbodies:\n"
           "  - {volume: lower, material: {law: %s, E: 1000, nu: 0}}\n"
           "  - {volume: upper, material: {law: %s, E: 1000, nu: 0}}\n"
           "contact: [{name: joint, slave: upper_bottom, master: lower_top, %s%s%s}]\n",
           kinematics, kinematics[0] == 's' ? "linear" : "svk", kinematics[0] == 's' ? "linear" : "svk",
           strstr(pair, "smoother") ? "" : "smoother: facet, ",
           strstr(pair, "formulation") ? "" : "formulation: node_to_surface, ", pair);
  return text;
}

static const char *PenaltyText(const char *more)
{
  static char text[256];

  snprintf(text, sizeof(text), "penalty: {initial: %g%s}", PENALTY, more);
  return text;
}

static double Residual(Parts *p, const PetscReal *u, PetscReal *f)
{
  double energy = 0;

  OK(ContactResidual(p->problem->contact, u, 0, f, &energy, NULL));
  OK(MPI_Allreduce(MPI_IN_PLACE, &energy, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  return energy;
}

/* Lists and forces at parts.u. */
static double Evaluate(void)
{
  OK(ContactGather(parts.problem->contact, parts.u, 0, 0, 0));
  OK(PetscArrayzero(parts.f, parts.mesh->n_nodes * 2));
  return Residual(&parts, parts.u, parts.f);
}

/* What the slave node of a tag shows; all ranks get it. */
typedef struct {
  double gap, penalty, force, pressure, normal[3], closed, multiplier, onset;
} Shown;

static Shown Show(int tag, double t)
{
  const ContactPair *pair     = &parts.problem->contact->pairs[0];
  double             value[9] = {0};
  ContactNodes       nodes;

  OK(ContactGetNodes(parts.problem->contact, 0, parts.u, &nodes));
  for (int c = 0; c < nodes.n; c++) {
    if (parts.mesh->node_tag[nodes.node[c]] != tag) continue;
    value[0] = nodes.gap[c], value[1] = nodes.penalty[c], value[2] = nodes.force[c], value[3] = nodes.pressure[c];
    value[4] = nodes.normal[3 * c], value[5] = nodes.normal[3 * c + 1],
    value[6] = pair->now.status[c] == CONTACT_CLOSED;
    value[7] = pair->now.multiplier[c], value[8] = ContactTermOnsetGap(pair, c, t);
  }
  OK(MPI_Allreduce(MPI_IN_PLACE, value, 9, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  return (Shown){value[0], value[1], value[2], value[3], {value[4], value[5], 0}, value[6], value[7], value[8]};
}

/* Brings the two slave nodes to these gaps over the flat master; the rest of the block follows the left one. */
static void Lower(double left, double right)
{
  for (int j = 0; j <= 1; j++) PartsMoveNode(&parts, PartsTag(&parts, UPPER, 0, j), 0, left - Apart);
  for (int j = 0; j <= 1; j++) PartsMoveNode(&parts, PartsTag(&parts, UPPER, 1, j), 0, right - Apart);
}

/* A node past the end of the master presses on what the master would be there. It stands in nothing. */
static void test_depth(void **state)
{
  static const PartsBlock over[] = {{"lower", 3, 1, {0, 3}, {0, 1}}, {"upper", 1, 1, {2.6, 3.2}, {1.1, 1.7}}};
  const double            deep = 0.02, size = 0.6;
  PetscReal               over_h;

  (void)state;
  PartsCreate(2, over, NULL, SceneText("finite", PenaltyText("")), &parts);
  Lower(-deep, -3 * deep);
  (void)Evaluate();
  assert_true(Show(LEFT, 0).closed == 1 && Show(RIGHT, 0).closed == 1);
  assert_near(Show(RIGHT, 0).gap, -3 * deep, 1e-14);
  OK(ContactPairDepth(parts.problem->contact, 0, &over_h));
  assert_near(over_h, deep / size, 1e-14);
  Lower(-3 * deep, -deep);
  (void)Evaluate();
  OK(ContactPairDepth(parts.problem->contact, 0, &over_h));
  assert_near(over_h, 3 * deep / size, 1e-14);
  PartsDestroy(&parts);
}

/* The left node presses, 0.2 along the facet from its left end; the right one is open. */
static void test_flat(void **state)
{
  const double   depth = 0.05, force = PENALTY * depth * Area;
  double         energy, master[3];
  ContactSummary summary;

  (void)state;
  PartsCreate(2, Blocks, NULL, SceneText("finite", PenaltyText("")), &parts);
  Lower(-depth, 0.02);
  energy = Evaluate();
  assert_near(Show(LEFT, 0).gap, -depth, 1e-14);
  assert_near(Show(RIGHT, 0).gap, 0.02, 1e-14);
  assert_true(Show(LEFT, 0).closed == 1 && Show(RIGHT, 0).closed == 0);
  assert_near(Show(LEFT, 0).force, force, 1e-11);
  assert_true(Show(RIGHT, 0).force == 0 && Show(RIGHT, 0).pressure == 0);
  assert_near(Show(LEFT, 0).normal[1], 1, 1e-14);
  assert_near(energy, PENALTY * depth * depth / 2 * Area, 1e-12);
  assert_near(PartsSum(&parts, parts.f, LEFT, 1), -force, 1e-11); /* external forces are subtracted */
  assert_near(PartsSum(&parts, parts.f, PartsTag(&parts, LOWER, 1, 1), 1), 0.8 * force, 1e-11);
  assert_near(PartsSum(&parts, parts.f, PartsTag(&parts, LOWER, 2, 1), 1), 0.2 * force, 1e-11);
  for (int i = 0; i <= 3; i += 3) assert_near(PartsSum(&parts, parts.f, PartsTag(&parts, LOWER, i, 1), 1), 0, 0);
  OK(ContactMasterForce(parts.problem->contact, 0, master));
  assert_near(master[0], 0, 1e-12);
  assert_near(master[1], -force, 1e-11);
  OK(ContactSummarise(parts.problem->contact, &summary));
  assert_true(summary.nodes == 1 && summary.in == 1 && summary.out == 0 && summary.outside_window == -1);
  assert_near(summary.max_penetration, depth, 1e-14);
  assert_near(summary.max_penetration_over_h, depth / 0.6, 1e-14);
  assert_near(summary.force, force, 1e-11);
  OK(ContactAccept(parts.problem->contact));
  Lower(0.01, -0.03);
  (void)Evaluate();
  OK(ContactSummarise(parts.problem->contact, &summary));
  assert_true(summary.nodes == 1 && summary.in == 1 && summary.out == 1);
  PartsDestroy(&parts);
}

/* The end of the middle facet at x = 2 is raised by a half. */
#define SLOPE 0.5

/* Gap to the inclined facet, and force along its normal, which the facet's nodes share by the foot. */
static void test_inclined(void **state)
{
  const double cosine = 1 / sqrt(1 + SLOPE * SLOPE), sine = SLOPE * cosine;
  const double y     = 1.06;                           /* of the left node, below the facet's point 1.1 over it */
  const double gap   = (y - 1 - SLOPE * 0.2) * cosine; /* distance to the facet's line */
  const double foot  = 0.2 * cosine + (y - 1) * sine;  /* along the facet from its left end */
  const double share = foot * cosine;                  /* of the facet's length, which is 1 / cosine */
  const double force = -PENALTY * gap * Area;

  (void)state;
  PartsCreate(2, Blocks, NULL, SceneText("finite", PenaltyText("")), &parts);
  Lower(y - 1, 1);
  PartsMoveNode(&parts, PartsTag(&parts, LOWER, 2, 1), 0, SLOPE);
  (void)Evaluate();
  assert_near(Show(LEFT, 0).gap, gap, 1e-13);
  assert_near(Show(LEFT, 0).normal[0], -sine, 1e-13);
  assert_near(Show(LEFT, 0).normal[1], cosine, 1e-13);
  assert_near(PartsSum(&parts, parts.f, LEFT, 0), force * sine, 1e-11);
  assert_near(PartsSum(&parts, parts.f, LEFT, 1), -force * cosine, 1e-11);
  assert_near(PartsSum(&parts, parts.f, PartsTag(&parts, LOWER, 1, 1), 1), (1 - share) * force * cosine, 1e-11);
  assert_near(PartsSum(&parts, parts.f, PartsTag(&parts, LOWER, 2, 1), 1), share * force * cosine, 1e-11);
  PartsDestroy(&parts);
}

/* The upper block is tilted into a lower one that is bent upwards, without any symmetry. */
static void Bend(const double X[2], double x[2])
{
  const double s = X[0] - 1.45;

  if (X[1] > 1.05) {
    x[0] = X[0] + 0.02 * X[1];
    x[1] = X[1] - 0.15 + 0.03 * s;
  } else {
    x[0] = X[0] + 0.01 * s * X[1];
    x[1] = X[1] - 0.12 * s * s * X[1];
  }
}

/* Forces are the energy's derivative and the tangent is theirs, on faces and fits, points and surfaces. */
static void test_tangent(void **state)
{
  static const PartsBlock  fine[]  = {{"lower", 12, 1, {0, 3}, {0, 1}}, {"upper", 3, 1, {1.1, 1.7}, {1.1, 1.7}}};
  static const char *const pairs[] = {"", "smoother: diffuse, ", "formulation: surface_to_surface, ",
                                      "smoother: diffuse, formulation: surface_to_surface, ",
                                      "smoother: diffuse, formulation: surface_to_surface, offset: live, "};
  char                     pair[512];
  double                   force, energy;
  PetscBool                changed;
  Mat                      C;

  (void)state;
  for (int k = 0; k < 5; k++) {
    snprintf(pair, sizeof(pair), "%s%s", pairs[k], PenaltyText(""));
    PartsCreate(2, fine, NULL, SceneText("finite", pair), &parts);
    PartsMove(&parts, Bend);
    (void)Evaluate();
    OK(ContactTangent(parts.problem->contact, parts.u, 0, &C, &changed));
    PartsDifferences(&parts, C, Residual, 1e-6, &force, &energy);
    assert_true(force < 1e-6 && energy < 1e-6);
    PartsDestroy(&parts);
  }
}

/* Onto a circle of radius 4 about (1.5, -3) that touches the block's top in its middle. */
static void ToCircle(const double X[2], double x[2])
{
  const double R = 4, angle = (X[0] - 1.5) / R;

  x[0] = 1.5 + (R + X[1] - 1) * sin(angle);
  x[1] = -3 + (R + X[1] - 1) * cos(angle);
}

/* Distances to a curved master: exact to its facets, which are chords; to the circle itself by the fit, whose degree 4
   leaves an error of about x^6 / (16 R^5), 1e-6 within its support. The facets are 1.7e-3 away. */
static void test_curved(void **state)
{
  static const PartsBlock fine[] = {{"lower", 13, 1, {0, 3}, {0, 1}}, {"upper", 2, 1, {1.3, 1.7}, {1.1, 1.5}}};
  const double half = 3. / 13 / 2, facet = 4 * cos(half / 4) - 3; /* height of the middle facet, symmetric to x = 1.5 */

  (void)state;
  for (int fit = 0; fit < 2; fit++) {
    char pair[512];

    snprintf(pair, sizeof(pair), "%s%s", fit ? "smoother: diffuse, " : "", PenaltyText(""));
    PartsCreate(2, fine, NULL, SceneText("finite", pair), &parts);
    PartsMove(&parts, ToCircle);
    for (int i = 0; i <= 2; i++)
      for (int j = 0; j <= 1; j++) PartsMoveNode(&parts, PartsTag(&parts, UPPER, i, j), 0, 0);
    (void)Evaluate();
    if (fit) {
      assert_near(Show(PartsTag(&parts, UPPER, 1, 0), 0).gap, 0.1, 1e-6);
      assert_near(Show(LEFT, 0).gap, hypot(0.2, 4.1) - 4, 1e-6);
      assert_near(Show(LEFT, 0).normal[0], -0.2 / hypot(0.2, 4.1), 1e-5);
    } else
      assert_near(Show(PartsTag(&parts, UPPER, 1, 0), 0).gap, 1.1 - facet, 1e-13);
    PartsDestroy(&parts);
  }
}

/* A uniform penetration of faces that do not match: each slave node gets its share of the faces exactly; the master
   gets the same force with the same moment. */
static void test_uniform(void **state)
{
  static const PartsBlock across[] = {{"lower", 3, 1, {0, 3}, {0, 1}}, {"upper", 4, 1, {0, 3}, {1.1, 1.7}}};
  const double            depth = 0.01, pressure = PENALTY * depth;
  double                  sum = 0, moment = 0;

  (void)state;
  PartsCreate(2, across, NULL, SceneText("finite", "formulation: surface_to_surface, penalty: {initial: 1000}"),
              &parts);
  for (int i = 0; i <= 4; i++)
    for (int j = 0; j <= 1; j++) PartsMoveNode(&parts, PartsTag(&parts, UPPER, i, j), 0, -Apart - depth);
  assert_near(Evaluate(), pressure * depth / 2 * 3, 1e-12);
  for (int i = 0; i <= 4; i++) {
    const double area = i % 4 ? 0.75 : 0.375;

    assert_near(Show(PartsTag(&parts, UPPER, i, 0), 0).gap, -depth, 1e-13);
    assert_near(Show(PartsTag(&parts, UPPER, i, 0), 0).pressure, pressure, 1e-10);
    assert_near(PartsSum(&parts, parts.f, PartsTag(&parts, UPPER, i, 0), 1), -pressure * area, 1e-11);
    assert_near(PartsSum(&parts, parts.f, PartsTag(&parts, UPPER, i, 0), 0), 0, 1e-12);
  }
  for (int i = 0; i <= 3; i++) {
    sum += PartsSum(&parts, parts.f, PartsTag(&parts, LOWER, i, 1), 1);
    moment += i * PartsSum(&parts, parts.f, PartsTag(&parts, LOWER, i, 1), 1);
  }
  assert_near(sum, 3 * pressure, 1e-11);
  assert_near(moment, 4.5 * pressure, 1e-11);
  PartsDestroy(&parts);
}

/* Penetrations of 0.12 and 0.004 in a window from 0.01 to 0.1: updates aim at 0.06 from above, at 0.016 from below. */
static void test_window(void **state)
{
  ContactWindow      window;
  ContactWindowState adjusted;

  (void)state;
  PartsCreate(2, Blocks, NULL,
              SceneText("finite", PenaltyText(", adjust: true, g_min: 0.01, g_max: 0.1, unit: length")), &parts);
  Lower(-0.12, -0.004);
  (void)Evaluate();
  OK(ContactPairWindow(parts.problem->contact, 0, &window));
  assert_true(window.loaded == 2 && window.outside == 2 && window.raised == 0 && window.lowered == 0);
  assert_near(window.excess, 1.2, 1e-12);
  OK(ContactAdjustPenalty(parts.problem->contact, &adjusted));
  assert_int_equal(adjusted, WINDOW_MISSED);
  assert_near(Show(LEFT, 0).penalty, PENALTY * 2, 1e-9);
  assert_near(Show(RIGHT, 0).penalty, PENALTY / 4, 1e-9);
  OK(ContactPairWindow(parts.problem->contact, 0, &window));
  assert_true(window.raised == 1 && window.lowered == 1 && window.clamped == 0);
  OK(ContactRestore(parts.problem->contact));
  assert_near(Show(LEFT, 0).penalty, PENALTY, 0);
  Lower(-0.05, 0.02); /* within the window, and open */
  (void)Evaluate();
  OK(ContactAdjustPenalty(parts.problem->contact, &adjusted));
  assert_int_equal(adjusted, WINDOW_HOLDS);
  assert_near(Show(LEFT, 0).penalty, PENALTY, 0);
  PartsDestroy(&parts);
}

/* The same with updates of at most a factor of 1.5 */
static void test_clamp(void **state)
{
  ContactWindow      window;
  ContactWindowState adjusted;

  (void)state;
  PartsCreate(2, Blocks, NULL,
              SceneText("finite", PenaltyText(", adjust: true, g_min: 0.01, g_max: 0.1, unit: length, clamp: 1.5")),
              &parts);
  Lower(-0.12, -0.004);
  (void)Evaluate();
  OK(ContactAdjustPenalty(parts.problem->contact, &adjusted));
  assert_near(Show(LEFT, 0).penalty, PENALTY * 1.5, 1e-9);
  assert_near(Show(RIGHT, 0).penalty, PENALTY / 1.5, 1e-9);
  OK(ContactPairWindow(parts.problem->contact, 0, &window));
  assert_int_equal(window.clamped, 2);
  PartsDestroy(&parts);
}

/* The pressure becomes the multiplier, and presses from an opening of multiplier over penalty on. */
static void test_augment(void **state)
{
  ContactWindowState augmented;

  (void)state;
  PartsCreate(2, Blocks, NULL, SceneText("finite", PenaltyText(", augment: true, g_max: 1e-3, unit: length")), &parts);
  Lower(-0.05, 0.02);
  (void)Evaluate();
  OK(ContactAdjustPenalty(parts.problem->contact, &augmented));
  assert_int_equal(augmented, WINDOW_MISSED);
  assert_near(Show(LEFT, 0).multiplier, PENALTY * 0.05, 1e-10);
  assert_near(Show(RIGHT, 0).multiplier, 0, 0);
  assert_near(Show(LEFT, 0).onset, 0.05, 1e-14);
  assert_near(Show(RIGHT, 0).onset, 0, 0);
  (void)Evaluate();
  assert_near(Show(LEFT, 0).force, PENALTY * 0.1 * Area, 1e-10);
  Lower(0.02, 0.02);
  (void)Evaluate();
  assert_near(Show(LEFT, 0).force, PENALTY * 0.03 * Area, 1e-10);
  Lower(-0.0005, 0.02); /* within the bound: it stands */
  (void)Evaluate();
  OK(ContactAdjustPenalty(parts.problem->contact, &augmented));
  assert_int_equal(augmented, WINDOW_HOLDS);
  assert_near(Show(LEFT, 0).multiplier, PENALTY * 0.05, 1e-10);
  PartsDestroy(&parts);
}

/* Softened penalties limit energy and force, as multiples of the automatic penalty of 1000, and leave the penalties as
   they are. Terms that a prediction counted on are limited only where all are. */
static void test_soften(void **state)
{
  PetscReal most;

  (void)state;
  PartsCreate(2, Blocks, NULL, SceneText("finite", "penalty: {initial: auto, scale: 5}"), &parts);
  Lower(-0.05, 0.02);
  assert_near(Evaluate(), 5000 * 0.05 * 0.05 / 2 * Area, 1e-10);
  OK(ContactStiffest(parts.problem->contact, &most));
  assert_near(most, 5, 1e-12);
  OK(ContactSoften(parts.problem->contact, 0.2, PETSC_TRUE));
  assert_near(Evaluate(), 200 * 0.05 * 0.05 / 2 * Area, 1e-10);
  assert_near(Show(LEFT, 0).force, 200 * 0.05 * Area, 1e-10);
  assert_near(Show(LEFT, 0).penalty, 5000, 1e-9);
  OK(ContactMarkPredicted(parts.problem->contact));
  OK(ContactSoften(parts.problem->contact, 0.2, PETSC_FALSE));
  assert_near(Evaluate(), 5000 * 0.05 * 0.05 / 2 * Area, 1e-10);
  OK(ContactSoften(parts.problem->contact, 10, PETSC_TRUE)); /* above the penalty: no limit */
  assert_near(Evaluate(), 5000 * 0.05 * 0.05 / 2 * Area, 1e-10);
  OK(ContactSoften(parts.problem->contact, PETSC_MAX_REAL, PETSC_TRUE));
  assert_near(Evaluate(), 5000 * 0.05 * 0.05 / 2 * Area, 1e-10);
  PartsDestroy(&parts);
}

/* Pressure at load parameter t of surfaces whose meshes overlap by 0.01 */
static double OverlapPressure(double t)
{
  OK(PetscArrayzero(parts.f, parts.mesh->n_nodes * 2));
  OK(ContactResidual(parts.problem->contact, parts.u, t, parts.f, NULL, NULL));
  return Show(LEFT, t).pressure;
}

static void test_overlap(void **state)
{
  static const PartsBlock  overlapping[] = {{"lower", 3, 1, {0, 3}, {0, 1}}, {"upper", 1, 1, {1.2, 1.8}, {0.99, 1.59}}};
  static const char *const words[]       = {"resolve", "ramp", "ignore"};
  const double             share[3][3] = {{1, 1, 1}, {0, 0.25, 1}, {0, 0, 0}}, t[] = {0, 0.25, 1};
  char                     pair[512];
  ContactGaps              gaps;

  (void)state;
  for (int k = 0; k < 3; k++) {
    snprintf(pair, sizeof(pair), "initial_overlap: %s, %s", words[k], PenaltyText(""));
    PartsCreate(2, overlapping, NULL, SceneText("finite", pair), &parts);
    (void)Evaluate();
    OK(ContactPairGaps(parts.problem->contact, 0, &gaps));
    assert_true(gaps.nodes == 2 && gaps.near == 2 && gaps.overlapping == 2 && gaps.deepest.tag == LEFT);
    assert_near(gaps.least, -0.01, 1e-14);
    assert_near(gaps.area, 2 * Area, 1e-14);
    OK(ContactTakeOverlap(parts.problem->contact));
    for (int i = 0; i < 3; i++) assert_near(OverlapPressure(t[i]), share[k][i] * PENALTY * 0.01, 1e-10);
    PartsDestroy(&parts);
  }
}

/* Some motion of the nodes without any symmetry. */
static void MakeMotion(double scale, PetscReal *v)
{
  const PetscReal *X = parts.mesh->coords;

  for (PetscInt i = 0; i < parts.mesh->n_nodes; i++) {
    v[2 * i]     = scale * sin(2 * X[2 * i] + 3 * X[2 * i + 1]);
    v[2 * i + 1] = scale * cos(3 * X[2 * i] - 2 * X[2 * i + 1] + 0.4);
  }
}

/* Loads of the first pair at u + h v, where penalties are exp(h) times as stiff. */
static ContactLoad LoadAt(PenaltySource source, const PetscReal *v, double h)
{
  Contact     contact = parts.problem->contact;
  PetscReal  *u;
  ContactLoad load;

  OK(PetscMalloc1(parts.mesh->n_nodes * 2, &u));
  for (PetscInt i = 0; i < parts.mesh->n_nodes * 2; i++) u[i] = parts.u[i] + h * v[i];
  OK(source == BY_SLIP ? ContactStiffenStick(contact, 0, exp(h)) : ContactStiffen(contact, 0, exp(h)));
  OK(PetscArrayzero(parts.f, parts.mesh->n_nodes * 2));
  (void)Residual(&parts, u, parts.f);
  OK(ContactPairLoad(contact, 0, u, &load));
  OK(source == BY_SLIP ? ContactStiffenStick(contact, 0, exp(-h)) : ContactStiffen(contact, 0, exp(-h)));
  OK(PetscFree(u));
  return load;
}

/* Forces that stiffer penalties add where nothing moves, as the difference over h. */
static double ForcesDiffer(PenaltySource source, double h)
{
  const PetscInt n     = parts.mesh->n_nodes * 2;
  double         error = 0, most = 0;
  PetscReal     *f, *still;

  OK(PetscCalloc2(n, &f, n, &still));
  (void)LoadAt(source, still, 0);
  OK(ContactStifferForces(parts.problem->contact, source, f));
  for (int side = -1; side <= 1; side += 2) {
    (void)LoadAt(source, still, side * h);
    for (PetscInt i = 0; i < n; i++) f[i] -= side * parts.f[i] / (2 * h);
  }
  for (PetscInt i = 0; i < n; i++) {
    most  = PetscMax(most, fabs(parts.f[i]));
    error = PetscMax(error, fabs(f[i]));
  }
  OK(PetscFree2(f, still));
  OK(MPI_Allreduce(MPI_IN_PLACE, &error, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD));
  OK(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD));
  return error / most;
}

/* Changes of the loads by stiffer penalties and a motion are their differences, with friction that sticks or slips by a
   shift of the upper block. */
static void CheckStiffer(PenaltySource source, double shift)
{
  const double h = 1e-6;
  PetscReal   *v;
  ContactLoad  change, now, low, high;

  (void)Evaluate();
  for (PetscInt i = 0; i < parts.mesh->n_nodes; i++)
    if (parts.mesh->coords[2 * i + 1] + parts.mesh->centre[1] > 1.05) parts.u[2 * i] += shift;
  assert_true(ForcesDiffer(source, h) < 1e-8);
  OK(PetscMalloc1(parts.mesh->n_nodes * 2, &v));
  MakeMotion(0.1, v);
  now = LoadAt(source, v, 0);
  OK(ContactLoadChanges(parts.problem->contact, source, parts.u, v, &change));
  low  = LoadAt(source, v, -h);
  high = LoadAt(source, v, h);
  assert_near(change.force, (high.force - low.force) / (2 * h), 1e-7 * now.force);
  assert_near(change.pressure, (high.pressure - low.pressure) / (2 * h), 1e-7 * now.pressure);
  assert_near(change.peak, (high.peak - low.peak) / (2 * h), 1e-7 * now.peak);
  for (int d = 0; d < 3; d++)
    assert_near(change.friction[d], (high.friction[d] - low.friction[d]) / (2 * h), 1e-7 * now.force);
  OK(PetscFree(v));
}

static void test_stiffer(void **state)
{
  static const PartsBlock  fine[]   = {{"lower", 12, 1, {0, 3}, {0, 1}}, {"upper", 3, 1, {1.1, 1.7}, {1.1, 1.7}}};
  static const char *const pairs[]  = {"", "smoother: diffuse, ", "formulation: surface_to_surface, ",
                                       "smoother: diffuse, formulation: surface_to_surface, "};
  static const double      shifts[] = {1e-4, 0.04}; /* what is in contact sticks, slips */
  char                     pair[512];

  (void)state;
  for (int k = 0; k < 12; k++) {
    const PenaltySource source = k < 8 ? BY_PENETRATION : BY_SLIP;

    snprintf(pair, sizeof(pair), "%s%s%s", pairs[k % 4], k < 4 ? "" : "friction: {mu: 0.3}, ", PenaltyText(""));
    PartsCreate(2, fine, NULL, SceneText("finite", pair), &parts);
    PartsMove(&parts, Bend);
    for (int s = 0; s < (k < 4 ? 1 : 2); s++) CheckStiffer(source, shifts[s]);
    PartsDestroy(&parts);
  }
}

/* A step that starts where a failed one did takes the lists with which that one began, if they are good for its motion.
   From another place or for more motion there are new ones. */
static void test_again(void **state)
{
  const PetscReal    way = 0.3;
  const ContactPair *pair;
  NeighbourLists     lists;
  double             energy;

  (void)state;
  PartsCreate(2, Blocks, NULL, SceneText("finite", PenaltyText("")), &parts);
  pair = &parts.problem->contact->pairs[0];
  Lower(-0.01, 0.02);
  OK(ContactGather(parts.problem->contact, parts.u, 0, 0, way));
  lists  = pair->lists;
  energy = Residual(&parts, parts.u, NULL);
  assert_true(energy > 0);
  Lower(-0.05, 0.01);
  assert_true(Residual(&parts, parts.u, NULL) > energy);
  Lower(-0.01, 0.02);
  OK(ContactGather(parts.problem->contact, parts.u, 0, 0, way / 2));
  assert_ptr_equal(pair->lists, lists);
  assert_null(pair->next);
  assert_true(pair->motion == way);
  assert_true(Residual(&parts, parts.u, NULL) == energy);
  OK(ContactGather(parts.problem->contact, parts.u, 0, 0, 2 * way));
  assert_true(pair->motion == 2 * way);
  assert_true(Residual(&parts, parts.u, NULL) == energy);
  Lower(-0.05, 0.01);
  OK(ContactGather(parts.problem->contact, parts.u, 0, 0, way));
  assert_true(pair->motion == way);
  PartsDestroy(&parts);
}

/* Lists that are ready serve for the motion that they were made for, and no more. */
static void test_at_hand(void **state)
{
  const PetscReal least = 0.3, made = 0.4, motion = 0.6;
  Contact         contact;
  PetscBool       hold;

  (void)state;
  PartsCreate(2, Blocks, NULL, SceneText("finite", PenaltyText("")), &parts);
  contact = parts.problem->contact;
  Lower(-0.01, 0.02);
  (void)Evaluate();
  assert_true(ContactMotionAtHand(contact, least, motion) == motion);
  OK(ContactListsHold(contact, parts.u, 0, 0, made, 1, PETSC_FALSE, &hold));
  assert_true(hold);
  assert_true(ContactMotionAtHand(contact, least, motion) == made);
  assert_true(ContactMotionAtHand(contact, 0.5, motion) == motion);
  OK(ContactGather(contact, parts.u, 0, 0, made));
  assert_true(contact->pairs[0].motion == made);
  assert_true(ContactMotionAtHand(contact, least, motion) == motion);
  PartsDestroy(&parts);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_flat),   cmocka_unit_test(test_depth),   cmocka_unit_test(test_inclined),
    cmocka_unit_test(test_curved), cmocka_unit_test(test_tangent), cmocka_unit_test(test_uniform),
    cmocka_unit_test(test_window), cmocka_unit_test(test_clamp),   cmocka_unit_test(test_augment),
    cmocka_unit_test(test_soften), cmocka_unit_test(test_overlap), cmocka_unit_test(test_stiffer),
    cmocka_unit_test(test_again),  cmocka_unit_test(test_at_hand)};

  if (PartsStart(&argc, &argv)) return 1;
  return PartsEnd(cmocka_run_group_tests(tests, NULL, NULL));
}
