/* Springs at the dofs as a viscous restraint: dofs on springs of their own relax in pseudo-time as the implicit Euler
 * method says in closed form, and the restraint takes what the closed form says. */
#include "../parts.h"
#include "solve/damping.h"

static const PartsBlock Bar[]  = {{"bar", 3, 1, {0, 3}, {0, 1}}};
static const char       Text[] = "geometry: plane_strain\nkinematics: small\n"
                                 "bodies: [{volume: bar, material: {law: svk, E: 100, nu: 0}}]\n"
                                 "supports: [{surface: bar_left, ux: 0}, {surface: bar_bottom, uy: 0}]\n";

enum { STEPS = 12 };
static const double STIFFNESS = 3, REST = 0.2, SCALE = 7; /* of each dof: its spring, where it comes to rest */

static Parts parts;

/* What value() says of each free dof, given the node's part of the volume: cells of 1 by 1 with four nodes. */
static void Fill(Vec v, double (*value)(double volume))
{
  const Mesh  mesh = parts.mesh;
  PetscReal  *values;
  PetscMPIInt rank;

  MPI_Comm_rank(mesh->comm, &rank);
  OK(PetscCalloc1(mesh->n_nodes * 2, &values));
  for (PetscInt i = 0; i < mesh->n_nodes * 2; i++) {
    const double x = mesh->coords[i / 2 * 2] + mesh->centre[0];

    if (mesh->node_owner[i / 2] == rank) values[i] = value(x < 0.5 || x > 2.5 ? 0.25 : 0.5);
  }
  OK(MeshLocalToGlobal(mesh, values, v));
  OK(PetscFree(values));
}

static double Volume(double V)
{
  return V;
}

/* By what the distance to the rest falls in a step */
static double Fall(double V)
{
  return SCALE * V / (STIFFNESS + SCALE * V);
}

static double Relaxed(double V)
{
  return REST * (1 - pow(Fall(V), STEPS));
}

/* The work that a dof does against the restraint: sum of SCALE V (u_n - u_(n-1))^2. For many short steps it is
   STIFFNESS REST^2 / 2, all that its spring holds at first. */
static double Taken(double V)
{
  const double q = Fall(V);

  return SCALE * V * REST * REST * (1 - q) * (1 - pow(q, 2 * STEPS)) / (1 + q);
}

/* A pseudo-time step from the anchor: solves STIFFNESS (x - REST) + SCALE V (x - anchor) = 0, and moves the anchor. */
static double Step(DofSprings damping, Mat K, Vec x)
{
  PetscReal force, energy;
  Vec       F, diagonal;

  OK(VecDuplicate(x, &F));
  OK(VecDuplicate(x, &diagonal));
  OK(VecCopy(x, F));
  OK(VecShift(F, -REST));
  OK(VecScale(F, STIFFNESS));
  OK(DofSpringsResidual(damping, x, F));
  OK(MatZeroEntries(K));
  OK(DofSpringsTangent(damping, K));
  OK(MatGetDiagonal(K, diagonal));
  OK(VecShift(diagonal, STIFFNESS));
  OK(VecPointwiseDivide(F, F, diagonal));
  OK(VecAXPY(x, -1, F));
  OK(DofSpringsLoad(damping, x, &force, &energy));
  OK(DofSpringsAnchor(damping, x));
  OK(VecDestroy(&F));
  OK(VecDestroy(&diagonal));
  return 2 * energy;
}

static void test_relaxing(void **state)
{
  double      taken = 0;
  PetscScalar all;
  PetscReal   scale, energy = 0;
  DofSprings  damping;
  Mat         K;
  Vec         x, expected;

  (void)state;
  PartsCreate(1, Bar, NULL, Text, &parts);
  OK(MatDuplicate(parts.problem->P, MAT_DO_NOT_COPY_VALUES, &K));
  OK(MatCreateVecs(K, &x, &expected));
  OK(VecZeroEntries(x));
  OK(DampingCreate(parts.mesh, parts.scene, x, &damping));
  OK(VecSet(expected, 1));
  OK(DofSpringsEnergy(damping, expected, &energy));
  assert_true(energy == 0); /* there is none before a scale is chosen */
  DofSpringsScale(damping, SCALE);
  assert_true(DofSpringsChanged(damping) && !DofSpringsChanged(damping));
  for (int n = 0; n < STEPS; n++) taken += Step(damping, K, x);
  Fill(expected, Relaxed);
  OK(VecAXPY(expected, -1, x));
  OK(VecNorm(expected, NORM_INFINITY, &energy));
  assert_near(energy, 0, 1e-14);
  Fill(expected, Taken);
  OK(VecSum(expected, &all));
  assert_near(taken, PetscRealPart(all), 1e-14);
  Fill(expected, Volume); /* a matrix whose diagonal is the volumes times 5 */
  OK(VecScale(expected, 5));
  OK(DofSpringsMean(damping, expected, &scale));
  assert_near(scale, 5, 1e-13);
  OK(DofSpringsReturn(damping, expected));
  OK(VecAXPY(expected, -1, x));
  OK(VecNorm(expected, NORM_INFINITY, &energy));
  assert_true(energy == 0);
  OK(DofSpringsDestroy(&damping));
  OK(MatDestroy(&K));
  OK(VecDestroy(&x));
  OK(VecDestroy(&expected));
  PartsDestroy(&parts);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_relaxing)};

  if (PartsStart(&argc, &argv)) return 1;
  return PartsEnd(cmocka_run_group_tests(tests, NULL, NULL));
}
