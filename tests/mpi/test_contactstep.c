/* Contact along a load step: when nodes touch, which terms a linear step may close and how it changes their gaps, slave
 * points that were lost, sets that repeat themselves, and springs that hold bodies until contact does. */
#include "../parts.h"
#include "contactimpl.h"
#include "contact/contactcycle.h"
#include "contact/contactsprings.h"
#include "contact/contactstep.h"

/* A block with three facets on top, and one above it whose two lower nodes, 0.6 apart, are over the middle facet. */
enum { LOWER, UPPER, SHELF };
#define LEFT    PartsTag(&parts, UPPER, 0, 0)
#define RIGHT   PartsTag(&parts, UPPER, 1, 0)
#define PENALTY 1000.
static const double     Apart = 0.1, Area = 0.3;
static const PartsBlock Blocks[] = {
  {"lower", 3, 1, {0, 3}, {0, 1}},
  {"upper", 1, 1, {1.2, 1.8}, {1.1, 1.7}},
  {"lower", 3, 1, {0, 3}, {-2, -1}} /* only where a test asks for it: another part of the same master */
};

static const char Text[] =
  "geometry: plane_strain\nkinematics: finite\nbodies:\n"
  "  - {volume: lower, material: {law: svk, E: 1000, nu: 0}}\n"
  "  - {volume: upper, material: {law: svk, E: 1000, nu: 0}}\n"
  "contact: [{name: joint, slave: upper_bottom, master: lower_top, stabilise: true, smoother: facet, "
  "formulation: node_to_surface, "
  "penalty: {initial: 1000}}]\n";

static Parts parts;

/* Brings the two slave nodes to these gaps over the flat master, with the nodes above them. */
static void Lower(double left, double right)
{
  for (int j = 0; j <= 1; j++) PartsMoveNode(&parts, PartsTag(&parts, UPPER, 0, j), 0, left - Apart);
  for (int j = 0; j <= 1; j++) PartsMoveNode(&parts, PartsTag(&parts, UPPER, 1, j), 0, right - Apart);
}

static void Gather(double motion)
{
  OK(ContactGather(parts.problem->contact, parts.u, 0, 0, motion));
}

static void Evaluate(void)
{
  OK(PetscArrayzero(parts.f, parts.mesh->n_nodes * 2));
  OK(ContactResidual(parts.problem->contact, parts.u, 0, parts.f, NULL, NULL));
}

/* The same on all ranks, by the mesh's number of the node. */
static PetscInt NodeId(int tag)
{
  PetscInt id = -1;

  for (PetscInt node = 0; node < parts.mesh->n_nodes; node++)
    if (parts.mesh->node_tag[node] == tag) id = parts.mesh->node_id[node];
  OK(MPI_Allreduce(MPI_IN_PLACE, &id, 1, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD));
  return id;
}

/* The left node goes from 0.1 to -0.1 and touches in the middle of the step, the right one from 0.2 to 0.1 and would
   touch at the end of the next one. */
static void test_touches(void **state)
{
  PetscReal *u_0, changed, all;
  Touch     *touch;
  int        n;

  (void)state;
  PartsCreate(2, Blocks, NULL, Text, &parts);
  OK(PetscMalloc1(parts.mesh->n_nodes * 2, &u_0));
  Lower(0.1, 0.2);
  Gather(0.3);
  Evaluate();
  OK(ContactAccept(parts.problem->contact));
  OK(PetscArraycpy(u_0, parts.u, parts.mesh->n_nodes * 2));
  Lower(-0.1, 0.1);
  OK(ContactTouches(parts.problem->contact, u_0, 0, parts.u, 0, PETSC_TRUE, PETSC_FALSE, &n, &touch));
  assert_int_equal(n, 2);
  assert_near(touch[0].beta, 0.5, 1e-13);
  assert_near(touch[1].beta, 2, 1e-13);
  assert_true(touch[0].key == NodeId(LEFT) && touch[1].key == NodeId(RIGHT));
  assert_near(touch[0].weight, Area, 1e-14);
  OK(PetscFree(touch));
  OK(ContactTouches(parts.problem->contact, u_0, 0, parts.u, 0, PETSC_FALSE, PETSC_TRUE, &n, &touch));
  assert_true(n == 1 && touch[0].key == NodeId(RIGHT) && touch[0].weight == 1); /* only what is open at the end */
  OK(PetscFree(touch));
  Evaluate();
  OK(ContactChanges(parts.problem->contact, 0, PETSC_TRUE, &changed, &all));
  assert_near(changed, Area, 1e-14);
  assert_near(all, 2 * Area, 1e-14);
  OK(ContactChanges(parts.problem->contact, 0, PETSC_FALSE, &changed, &all));
  assert_true(changed == 1 && all == 2);
  OK(PetscFree(u_0));
  PartsDestroy(&parts);
}

/* Terms of a linear step: gaps change by what the slave moves less what the facet moves under it, and a pressure of 1
   has the forces that do this work. A term farther than three times the motion is none. */
static void test_linear_step(void **state)
{
  PetscReal           *du, travel[2], work[2];
  PetscInt             n, rows;
  const PetscInt       which[] = {0, 1};
  const ActiveSetTerm *terms;
  ContactStep          step;
  PetscBool            within, changed;
  Vec                  v, y;
  Mat                  B, C;
  int                  left;

  (void)state;
  PartsCreate(2, Blocks, NULL, Text, &parts);
  OK(PetscCalloc1(parts.mesh->n_nodes * 2, &du));
  Lower(-0.05, 0.02);
  Gather(0.1);
  Evaluate();
  OK(ContactTangent(parts.problem->contact, parts.u, 0, &C, &changed));
  for (PetscInt node = 0; node < parts.mesh->n_nodes; node++) {
    const int tag = parts.mesh->node_tag[node];

    if (tag == LEFT) du[node * 2 + 1] = -0.04;
    if (tag == PartsTag(&parts, LOWER, 2, 1)) du[node * 2 + 1] = 0.01; /* a fifth of it under the left node */
  }
  OK(ContactStepCreate(parts.problem->contact, parts.u, du, 0, 1, &step));
  OK(ContactStepGetTerms(step, &n, &terms));
  assert_int_equal(n, 2); /* a motion of 0.04 reaches gaps up to 0.12 */
  left = terms[0].opening < 0 ? 0 : 1;
  assert_near(terms[left].opening, -0.05, 1e-13);
  assert_near(terms[left].pressure, 50, 1e-10);
  assert_true(terms[left].stiffness > 0 && terms[left].penalty == PENALTY);
  assert_near(terms[1 - left].opening, 0.02, 1e-13);
  assert_true(terms[1 - left].pressure == 0 && terms[1 - left].stiffness == 0);
  OK(ContactStepTravel(step, du, 0, 1, travel, NULL));
  /* The chord between the slave nodes does not count, only their feet do: 1.2 and 1.8, a fifth and four fifths. */
  assert_near(travel[left], -0.04 - 0.2 * 0.01, 1e-13);
  assert_near(travel[1 - left], -0.8 * 0.01, 1e-13);
  OK(ContactMatrixRows(parts.problem->contact, &rows));
  OK(ContactStepForces(step, rows, 2, which, &B));
  OK(MatCreateVecs(B, &y, &v));
  OK(MeshCollectFree(parts.mesh, du, v));
  OK(MatMultTranspose(B, v, y));
  for (int k = 0; k < 2; k++) {
    Vec column;

    OK(MatDenseGetColumnVecRead(B, k, &column));
    OK(VecDot(column, v, &work[k]));
    OK(MatDenseRestoreColumnVecRead(B, k, &column));
    assert_near(work[k], Area * travel[k], 1e-13);
  }
  OK(ContactStepWithin(step, du, 0, 1, &within));
  assert_true(within);
  for (PetscInt i = 0; i < parts.mesh->n_nodes * 2; i++) du[i] *= 4;
  OK(ContactStepWithin(step, du, 0, 1, &within));
  assert_false(within);
  OK(ContactStepDestroy(&step));
  for (PetscInt i = 0; i < parts.mesh->n_nodes * 2; i++) du[i] /= 32; /* 0.005: reaches neither gap */
  OK(ContactStepCreate(parts.problem->contact, parts.u, du, 0, 1, &step));
  OK(ContactStepGetTerms(step, &n, &terms));
  assert_int_equal(n, 0);
  OK(ContactStepDestroy(&step));
  OK(VecDestroy(&v));
  OK(VecDestroy(&y));
  OK(MatDestroy(&B));
  OK(PetscFree(du));
  PartsDestroy(&parts);
}

/* What ContactListsHold() says of slave points that were lost; text: what the message must have, NULL: none was. */
static void CheckLost(double motion, const char *text)
{
  char      message[256] = "";
  PetscBool hold, lost;

  Evaluate();
  OK(ContactListsHold(parts.problem->contact, parts.u, 0, motion, motion, 1, PETSC_FALSE, &hold));
  OK(ContactLocateLost(parts.problem->contact, &lost, message, sizeof(message)));
  if (lost != (text != NULL) || (text && !strstr(message, text))) print_error("'%s', not '%s'\n", message, text);
  assert_true(lost == (text != NULL));
  if (text) assert_non_null(strstr(message, text));
}

/* Points that came through their master, with another part of it before them now; deep ones whose faces turned away;
   closed ones that are open farther than anything moved. An ordinary opening and a deep penetration are no loss. */
static void test_lost(void **state)
{
  (void)state;
  PartsCreate(3, Blocks, NULL, Text, &parts);
  Lower(0.1, 0.1);
  Gather(3);
  Lower(-1.5, -1.4); /* 0.5 in front of the lower part, which is the nearer one now */
  CheckLost(1.6, "was 1.5 behind its master and is found 0.5 in front of another part of it");
  PartsDestroy(&parts);

  PartsCreate(2, Blocks, NULL, Text, &parts);
  Lower(0.1, 0.1);
  Gather(1);
  Lower(-0.8, -0.8);
  CheckLost(1, NULL);
  PartsMoveNode(&parts, LEFT, 0.6, -0.8 - Apart); /* changes places with the right one: the face looks upwards */
  PartsMoveNode(&parts, RIGHT, -0.6, -0.8 - Apart);
  CheckLost(1, "was 0.8 behind its master and is found with no master near");
  Lower(-0.05, -0.05);
  Gather(1);
  CheckLost(1, NULL);
  OK(ContactAccept(parts.problem->contact));
  Lower(1, 1);
  CheckLost(1, NULL);
  CheckLost(0.1, "was 0.05 behind its master and is found 1 in front of another part of it");
  PartsDestroy(&parts);
}

/* Looks at the set in contact of the two nodes: bit 0 the left one, bit 1 the right one. */
static PetscInt Look(ContactCycle cycle, int set, double residual, PetscInt *steady)
{
  PetscInt period;

  Lower(set & 1 ? -0.01 : 0.01, set & 2 ? -0.01 : 0.01);
  Evaluate();
  OK(ContactCycleLook(cycle, residual, &period, steady));
  return period;
}

static void test_cycle(void **state)
{
  static const int two[] = {1, 2, 1, 2}, three[] = {1, 2, 3, 1, 2, 3};
  char             text[256], expected[256];
  PetscInt         steady, period = 0;
  ContactCycle     cycle;

  (void)state;
  PartsCreate(2, Blocks, NULL, Text, &parts);
  OK(ContactCycleCreate(parts.problem->contact, &cycle));
  Gather(0.1);
  OK(ContactCycleStart(cycle));
  for (int k = 0; k < 4; k++) {
    assert_int_equal(period, 0); /* none before the last */
    period = Look(cycle, two[k], 1, &steady);
  }
  assert_int_equal(period, 2);
  OK(ContactCycleLocate(cycle, 2, text, sizeof(text)));
  snprintf(expected, sizeof(expected),
           "the contact set repeats every 2 iterations, 2 nodes come and go: node %d of 'joint', node %d of 'joint'",
           LEFT, RIGHT);
  assert_string_equal(text, expected);
  OK(ContactCycleStart(cycle));
  period = 0;
  for (int k = 0; k < 6; k++) {
    assert_int_equal(period, 0);
    period = Look(cycle, three[k], 1, &steady);
  }
  assert_int_equal(period, 3);
  OK(ContactCycleStart(cycle)); /* a residual that falls to less than half over a period is progress */
  for (int k = 0; k < 4; k++) assert_int_equal(Look(cycle, two[k], pow(0.6, k), &steady), 0);
  OK(ContactCycleStart(cycle)); /* a set that stays is no cycle */
  for (int k = 0; k < 6; k++) {
    assert_int_equal(Look(cycle, 3, 1, &steady), 0);
    assert_int_equal(steady, k);
  }
  OK(ContactCycleDestroy(&cycle));
  PartsDestroy(&parts);
}

/* Springs of 2 at each free dof and a tie of stiffness 5 that measures the sum of the dofs of a node: force, energy and
   tangent of a shift of both bodies; none once they are relaxed, and no force of the tie while it is released. */
static void test_springs(void **state)
{
  const double   shift   = 0.1;
  ContactSprings springs = NULL;
  SpringTie      tie     = {.motion = 3, .stiffness = 5, .n = 2, .dof = {0, 1}, .value = {1, 1}};
  PetscReal      force, tied, energy, added = 1, *stiffness;
  PetscInt       n;
  PetscBool      any;
  PetscMPIInt    rank;
  Vec            x, F, Kx;
  Mat            K;

  (void)state;
  PartsCreate(2, Blocks, NULL, Text, &parts);
  assert_non_null(parts.problem->springs); /* the problem has its own */
  OK(MatDuplicate(parts.problem->P, MAT_DO_NOT_COPY_VALUES, &K));
  OK(MatCreateVecs(K, &x, &F));
  OK(VecDuplicate(x, &Kx));
  OK(VecGetSize(x, &n));
  OK(PetscCalloc1(parts.mesh->n_nodes * 2, &stiffness));
  MPI_Comm_rank(parts.mesh->comm, &rank);
  for (PetscInt i = 0; i < parts.mesh->n_nodes * 2; i++) stiffness[i] = parts.mesh->node_owner[i / 2] == rank ? 2 : 0;
  OK(ContactSpringsCreate(parts.mesh, stiffness, x, &springs));
  OK(ContactSpringsSetTies(springs, 1, &tie));
  assert_true(ContactSpringsHaveTie(springs, 3) && !ContactSpringsHaveTie(springs, 0));
  OK(VecSet(x, shift));
  OK(VecZeroEntries(F));
  OK(ContactSpringsResidual(springs, x, F));
  OK(VecSum(F, &added));
  assert_near(added, 2 * shift * n + 2 * 5 * 2 * shift, 1e-12);
  OK(ContactSpringsLoad(springs, x, &force, &tied, &energy));
  assert_near(force, 2 * shift * sqrt(n), 1e-12);
  assert_near(tied, 5 * 2 * shift, 1e-13);
  assert_near(energy, 2 * n * shift * shift / 2 + 5 * 4 * shift * shift / 2, 1e-12);
  added = 1;
  OK(ContactSpringsEnergy(springs, x, &added));
  assert_near(added, 1 + energy, 1e-14);
  OK(MatZeroEntries(K));
  OK(ContactSpringsTangent(springs, K));
  OK(MatMult(K, x, Kx));
  OK(VecAXPY(Kx, -1, F));
  OK(VecNorm(Kx, NORM_INFINITY, &energy));
  assert_near(energy, 0, 1e-14);
  OK(ContactSpringsRelease(springs, 1, (int[]){3}, &any));
  assert_false(any);
  OK(ContactSpringsRelease(springs, 0, NULL, &any));
  assert_true(any);
  OK(ContactSpringsLoad(springs, x, &force, &tied, &energy));
  assert_true(tied == 0);
  OK(ContactSpringsRetie(springs, &any));
  assert_true(any);
  OK(ContactSpringsRelax(springs, x));
  OK(ContactSpringsLoad(springs, x, &force, &tied, &energy));
  assert_true(force == 0 && tied == 0 && energy == 0);
  OK(ContactSpringsDestroy(&springs));
  OK(PetscFree(stiffness));
  OK(VecDestroy(&x));
  OK(VecDestroy(&F));
  OK(VecDestroy(&Kx));
  OK(MatDestroy(&K));
  PartsDestroy(&parts);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_touches), cmocka_unit_test(test_linear_step),
                                     cmocka_unit_test(test_lost), cmocka_unit_test(test_cycle),
                                     cmocka_unit_test(test_springs)};

  if (PartsStart(&argc, &argv)) return 1;
  return PartsEnd(cmocka_run_group_tests(tests, NULL, NULL));
}
