/* Shows that mixed elements converge at the rates of their order on jittered meshes of a nearly incompressible solid:
   p + 1 for the displacement and p for the pressure, in the L2 norm. Elements whose pressures are not stable pass tests
   with uniform fields and fail this one. That is so of quad4 and hex8: their constant pressures have a part that
   alternates from element to element. The mean stress at the nodes, which is output, does not have it (Johnson and
   Pitkaranta, Mathematics of Computation 38, 1982), and it is what is tested for them.

   The field is one of Papkovich and Neuber without body force, u = grad(x . B) - 4 (1 - nu) B with a harmonic B: it
   solves Navier's equations for every nu, and its pressure lambda div u = -4 nu mu div B stays where nu goes to 1/2.
   Displacements are imposed on x_min and y_min. The tractions of the other sides are those of the field. In a corner of
   three imposed sides a tetrahedron has no free node, and its pressure would be undetermined. The argument is the
   folder of the meshes (default: meshes); a second argument is a file for the table. Small strains. */
#include "bodies/elasticity.h"
#include "kernels/elementkernel.h"
#include "mesh/pressurenodes.h"
#include <petscksp.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include "../rule.h"

enum { LEVELS = 3, QUANTITIES = 3 };

/* The rates over all meshes of a case must exceed those of theory minus these margins. Jittered meshes scatter, and
   constant pressures of first-order elements more so. */
static const PetscReal rate_margin = 0.25;
static const PetscReal young = 3, poisson = 0.4999;
/* Corners inside are moved by up to this part of the smallest edge of a regular mesh in every direction. */
static const PetscReal jitter = 0.1;

#define CHECK(call) assert_int_equal((call), PETSC_SUCCESS)

typedef struct {
  ElementType type;
  Geometry    geometry;
  int         n[LEVELS];
} Case;

static const Case cases[] = {
  {ELEMENT_QUAD4, GEOMETRY_PLANE_STRAIN, {8, 16, 32}}, {ELEMENT_QUAD4, GEOMETRY_AXISYMMETRIC, {8, 16, 32}},
  {ELEMENT_QUAD9, GEOMETRY_PLANE_STRAIN, {4, 8, 16}},  {ELEMENT_QUAD9, GEOMETRY_AXISYMMETRIC, {4, 8, 16}},
  {ELEMENT_TRI3, GEOMETRY_PLANE_STRAIN, {8, 16, 32}},  {ELEMENT_TRI3, GEOMETRY_AXISYMMETRIC, {8, 16, 32}},
  {ELEMENT_TRI6, GEOMETRY_PLANE_STRAIN, {4, 8, 16}},   {ELEMENT_TRI6, GEOMETRY_AXISYMMETRIC, {4, 8, 16}},
  {ELEMENT_HEX8, GEOMETRY_SOLID, {4, 8, 12}},          {ELEMENT_HEX27, GEOMETRY_SOLID, {2, 4, 6}},
  {ELEMENT_TET4, GEOMETRY_SOLID, {4, 8, 12}},          {ELEMENT_TET10, GEOMETRY_SOLID, {6, 8, 10}},
};
enum { CASES = sizeof(cases) / sizeof(*cases) };

static char  folder[64], meshes[PATH_MAX];
static FILE *table;

/* The exact field */

/* Computes a harmonic function e^(c x_k) cos(a x_l + p) cos(b x_m + q), c^2 = a^2 + b^2, with its derivatives. */
static void Harmonic(int dim, int k, const PetscReal x[3], PetscReal *value, PetscReal first[3], PetscReal second[9])
{
  const int       l = (k + 1) % dim, m = (k + 2) % dim;
  const PetscReal a = 1.1 - 0.2 * k, b = dim == 3 ? 0.8 + 0.1 * k : 0, c = PetscSqrtReal(a * a + b * b);
  const PetscReal p = 0.3 + 0.4 * k, q = dim == 3 ? -0.2 + 0.5 * k : 0;
  PetscReal       d[3][3]; /* derivatives of the factors */
  const int       axis[3] = {k, l, m};
  const int       factors = dim;

  d[0][0] = PetscExpReal(c * x[k]);
  d[0][1] = c * d[0][0];
  d[0][2] = c * c * d[0][0];
  d[1][0] = PetscCosReal(a * x[l] + p);
  d[1][1] = -a * PetscSinReal(a * x[l] + p);
  d[1][2] = -a * a * d[1][0];
  d[2][0] = dim == 3 ? PetscCosReal(b * x[m] + q) : 1;
  d[2][1] = dim == 3 ? -b * PetscSinReal(b * x[m] + q) : 0;
  d[2][2] = -b * b * d[2][0];
  *value  = d[0][0] * d[1][0] * d[2][0];
  for (int i = 0; i < factors; i++) {
    first[axis[i]] = 1;
    for (int f = 0; f < 3; f++) first[axis[i]] *= d[f][f == i];
    for (int j = 0; j < factors; j++) {
      second[3 * axis[i] + axis[j]] = 1;
      for (int f = 0; f < 3; f++) second[3 * axis[i] + axis[j]] *= d[f][(f == i) + (f == j)];
    }
  }
}

/* The field in the plane and in space, and its gradient at 3 i + j */
static void ExactCartesian(int dim, const PetscReal x[3], PetscReal u[3], PetscReal H[9])
{
  const PetscReal factor = 4 * (1 - poisson);
  PetscReal       B[3], D[3][3], S[3][9];

  for (int k = 0; k < dim; k++) Harmonic(dim, k, x, &B[k], D[k], S[k]);
  for (int i = 0; i < dim; i++) {
    u[i] = (1 - factor) * B[i];
    for (int k = 0; k < dim; k++) u[i] += x[k] * D[k][i];
    for (int j = 0; j < dim; j++) {
      H[3 * i + j] = (1 - factor) * D[i][j] + D[j][i];
      for (int k = 0; k < dim; k++) H[3 * i + j] += x[k] * S[k][3 * i + j];
    }
  }
}

/* The axisymmetric field, with B = phi e_z and harmonic polynomials phi of r and z */
static void ExactRing(const PetscReal x[3], PetscReal u[3], PetscReal H[9])
{
  const PetscReal r = x[0], z = x[1], factor = 4 * (1 - poisson);
  const PetscReal f = z * z - r * r / 2 + 0.5 * (z * z * z - 1.5 * z * r * r) +
                      0.3 * (z * z * z * z - 3 * z * z * r * r + 0.375 * r * r * r * r);
  const PetscReal fr  = -r - 1.5 * z * r + 0.3 * (-6 * z * z * r + 1.5 * r * r * r);
  const PetscReal fz  = 2 * z + 0.5 * (3 * z * z - 1.5 * r * r) + 0.3 * (4 * z * z * z - 6 * z * r * r);
  const PetscReal frr = -1 - 1.5 * z + 0.3 * (-6 * z * z + 4.5 * r * r), frz = -1.5 * r - 3.6 * z * r;
  const PetscReal fzz = 2 + 3 * z + 0.3 * (12 * z * z - 6 * r * r);

  u[0] = z * fr;
  u[1] = (1 - factor) * f + z * fz;
  H[0] = z * frr;
  H[1] = fr + z * frz;
  H[3] = (1 - factor) * fr + z * frz;
  H[4] = (2 - factor) * fz + z * fzz;
  H[8] = z * fr / r;
}

static void Exact(Geometry geometry, const PetscReal x[3], PetscReal u[3], PetscReal H[9])
{
  for (int r = 0; r < 9; r++) H[r] = 0;
  if (geometry == GEOMETRY_AXISYMMETRIC)
    ExactRing(x, u, H);
  else
    ExactCartesian(geometry == GEOMETRY_SOLID ? 3 : 2, x, u, H);
}

static PetscReal ExactPressure(const PetscReal H[9])
{
  return young * poisson / ((1 + poisson) * (1 - 2 * poisson)) * (H[0] + H[4] + H[8]);
}

/* The mesh */

static PetscErrorCode SceneCreate(const Case *test, int n, Scene *scene)
{
  static const char *const names[] =
    {[GEOMETRY_SOLID] = "solid", [GEOMETRY_PLANE_STRAIN] = "plane_strain", [GEOMETRY_AXISYMMETRIC] = "axisymmetric"};
  const Element *e = ElementGet(test->type);
  char           file[PETSC_MAX_PATH_LEN];
  FILE          *stream;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(file, sizeof(file), "%s/scene.yaml", folder));
  stream = fopen(file, "w");
  PetscCheck(stream, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write %s", file);
  fprintf(stream,
          "geometry: %s\nkinematics: small\nbodies: [{volume: block, material: {law: linear, E: %g, nu: %g}}]\n",
          names[test->geometry], young, poisson);
  fprintf(stream, "mesh: {file: %s/%s.geo, order: %d, parameters: {nx: %d, ny: %d", meshes,
          e->dim == 3 ? "block" : "square", e->order, n, n);
  if (e->dim == 3) fprintf(stream, ", nz: %d", n);
  fprintf(stream, ", %s: %d}}\n", e->dim == 3 ? "tet" : "tri", e->corners == e->dim + 1);
  fclose(stream);
  PetscCall(SceneRead(PETSC_COMM_SELF, file, 0, NULL, scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the nodes of the boundary and prescribes the displacements of two sides. */
static PetscErrorCode Constrain(Scene scene, Mesh mesh, PetscBool *boundary)
{
  static const char *const sides[] = {"x_min", "y_min", "x_max", "y_max", "z_min", "z_max"};
  PetscBool               *constrained;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &constrained));
  for (int side = 0; side < 2 * mesh->dim; side++) {
    MeshGroup *group;

    PetscCall(MeshGetGroup(mesh, scene, "supports.0", "surface", sides[side], mesh->dim - 1, &group));
    for (PetscInt k = 0; k < group->n_nodes; k++) {
      boundary[group->nodes[k]] = PETSC_TRUE;
      for (int i = 0; i < mesh->dim && side < 2; i++) constrained[group->nodes[k] * mesh->dim + i] = PETSC_TRUE;
    }
  }
  PetscCall(PressureNodesConstrain(mesh, scene, constrained));
  PetscCall(MeshSetConstraints(mesh, constrained));
  PetscCall(PetscFree(constrained));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves the corners inside at random, and the other nodes along with them, so that edges remain straight. */
static PetscErrorCode Jitter(const Case *test, Mesh mesh, int n, const PetscBool *boundary)
{
  const Element    *e     = ElementGet(test->type);
  const int         dim   = mesh->dim;
  unsigned          state = 1;
  PetscReal        *shift;
  const ElementType first = e->order == 1 ? e->type : (ElementType)(e->type - 1);

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * dim, &shift));
  for (PetscInt k = 0; k < mesh->n_nodes * dim; k++) {
    state    = state * 1664525u + 1013904223u;
    shift[k] = boundary[k / dim] ? 0 : 2 * jitter / n * ((PetscReal)(state >> 8) / (1 << 24) - 0.5);
  }
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt *nodes = &mesh->cell_nodes[mesh->cell_ptr[c]];

    for (int a = e->corners; a < e->nodes; a++) {
      double N[ELEMENT_MAX_NODES];

      ElementShape(first, e->node[a], N, NULL, NULL);
      for (int i = 0; i < dim; i++) {
        shift[nodes[a] * dim + i] = 0;
        for (int b = 0; b < e->corners; b++) shift[nodes[a] * dim + i] += N[b] * shift[nodes[b] * dim + i];
      }
    }
  }
  for (PetscInt k = 0; k < mesh->n_nodes * dim; k++) mesh->coords[k] += shift[k];
  PetscCall(PetscFree(shift));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes scene and mesh, and the nodal values of the field. The axisymmetric box is away from the axis. */
static PetscErrorCode CreateMesh(const Case *test, int n, Scene *scene, Mesh *mesh, PetscReal **u)
{
  char       file[PETSC_MAX_PATH_LEN];
  PetscReal  seconds;
  PetscBool *boundary;

  PetscFunctionBeginUser;
  PetscCall(SceneCreate(test, n, scene));
  PetscCall(MeshGenerate(PETSC_COMM_SELF, *scene, folder, PETSC_FALSE, file, &seconds));
  PetscCall(MeshCreate(PETSC_COMM_SELF, *scene, file, mesh));
  PetscCall(PetscCalloc1((*mesh)->n_nodes, &boundary));
  PetscCall(Constrain(*scene, *mesh, boundary));
  PetscCall(Jitter(test, *mesh, n, boundary));
  PetscCall(PetscFree(boundary));
  PetscCall(PetscMalloc1((*mesh)->n_nodes * (*mesh)->dim, u));
  for (PetscInt k = 0; k < (*mesh)->n_nodes; k++) {
    const int  dim  = (*mesh)->dim;
    PetscReal *node = &(*mesh)->coords[k * dim], value[3], H[9];

    if (test->geometry == GEOMETRY_AXISYMMETRIC) node[0] += 1;
    Exact(test->geometry, node, value, H);
    PetscCall(PetscArraycpy(&(*u)[k * dim], value, dim));
  }
  PetscCall(MeshCheckQuality(*mesh, *scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Integrals */

/* Gives the place of a point with shape functions N and dN in a cell, and the gradients g[nodes][3] of the nodes; the
   third of an axisymmetric one is N / r. Returns the volume of the point. */
static PetscReal Place(const Case *test, Mesh mesh, PetscInt c, const PetscReal *N, const PetscReal *dN, int stride,
                       PetscReal weight, PetscReal x[3], PetscReal g[][3])
{
  const int       dim     = mesh->dim;
  const PetscInt *nodes   = &mesh->cell_nodes[mesh->cell_ptr[c]];
  const int       n       = (int)(mesh->cell_ptr[c + 1] - mesh->cell_ptr[c]);
  PetscReal       J[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, C[3][3], volume = 0;

  for (int i = 0; i < dim; i++) {
    x[i] = 0;
    for (int a = 0; a < n; a++) x[i] += N[a] * mesh->coords[nodes[a] * dim + i];
    for (int k = 0; k < dim; k++) {
      J[i][k] = 0;
      for (int a = 0; a < n; a++) J[i][k] += dN[a * stride + k] * mesh->coords[nodes[a] * dim + i];
    }
  }
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++)
      C[i][k] = J[(i + 1) % 3][(k + 1) % 3] * J[(i + 2) % 3][(k + 2) % 3] -
                J[(i + 1) % 3][(k + 2) % 3] * J[(i + 2) % 3][(k + 1) % 3];
  }
  for (int k = 0; k < 3; k++) volume += J[0][k] * C[0][k];
  for (int a = 0; a < n; a++) {
    for (int i = 0; i < 3; i++) {
      g[a][i] = 0;
      for (int k = 0; k < dim && i < dim; k++) g[a][i] += C[i][k] * dN[a * stride + k] / volume;
    }
    if (test->geometry == GEOMETRY_AXISYMMETRIC) g[a][2] = N[a] / x[0];
  }
  return volume * weight * (test->geometry == GEOMETRY_AXISYMMETRIC ? 2 * PETSC_PI * x[0] : 1);
}

/* Subtracts the nodal forces of the exact stress from f. Those of the nodes inside are zero. */
static void SubtractForce(const Rule *rule, const Case *test, Mesh mesh, PetscReal *f)
{
  const PetscReal mu = young / (2 * (1 + poisson));

  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    for (int q = 0; q < rule->points; q++) {
      PetscReal       x[3]   = {0}, u[3], H[9], g[ELEMENT_MAX_NODES][3];
      const PetscReal volume = Place(test, mesh, c, rule->N[q], rule->dN[q], mesh->dim, rule->weight[q], x, g);
      PetscReal       p;

      Exact(test->geometry, x, u, H);
      p = ExactPressure(H);
      for (PetscInt k = mesh->cell_ptr[c]; k < mesh->cell_ptr[c + 1]; k++) {
        const PetscReal *ga = g[k - mesh->cell_ptr[c]];

        for (int i = 0; i < mesh->dim; i++) {
          PetscReal sum = p * ga[i];

          for (int j = 0; j < mesh->dim; j++) sum += mu * (H[3 * i + j] + H[3 * j + i]) * ga[j];
          if (test->geometry == GEOMETRY_AXISYMMETRIC && i == 0) sum += (p + 2 * mu * H[8]) * ga[2];
          f[mesh->cell_nodes[k] * mesh->dim + i] -= volume * sum;
        }
      }
    }
  }
}

/* Mean stress of the output at the nodes */
static PetscErrorCode NodalMean(Elasticity e, Mesh mesh, const PetscReal *u, PetscReal *mean)
{
  PetscReal *stress, *weight;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(mesh->n_nodes * 6, &stress, mesh->n_nodes, &weight));
  PetscCall(ElasticityNodalStress(e, u, stress, weight));
  for (PetscInt k = 0; k < mesh->n_body_nodes; k++)
    mean[k] = (stress[6 * k] + stress[6 * k + 1] + stress[6 * k + 2]) / (3 * weight[k]);
  PetscCall(PetscFree2(stress, weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the squares of the error of the pressure of the corners of a cell, and of the field's pressure. The pressure is
   linear, so that its value in the middle of an edge is the mean of those of its ends. The cells fill a box of volume 1,
   which is that of the first two coordinates in the plane. */
static void AddNodalPressureError(const Rule *rule, const Case *test, Mesh mesh, PetscInt c, const PetscReal *u,
                                  PetscReal sum[2])
{
  const Element  *e     = ElementGet(mesh->cell_type[c]);
  const PetscInt *nodes = &mesh->cell_nodes[mesh->cell_ptr[c]];
  const PetscReal mu = young / (2 * (1 + poisson)), unit = mu * PetscPowReal(mesh->n_cells_global, 1. / mesh->dim);

  for (int q = 0; q < rule->points; q++) {
    PetscReal       x[3] = {0}, exact[3], D[9], g[ELEMENT_MAX_NODES][3], p = 0;
    const PetscReal volume = Place(test, mesh, c, rule->N[q], rule->dN[q], mesh->dim, rule->weight[q], x, g);

    Exact(test->geometry, x, exact, D);
    for (int k = 0; k < e->nodes; k++) {
      const int edge = k - e->corners, a = edge < 0 ? k : e->edge_corners[edge][0],
                b = edge < 0 ? k : e->edge_corners[edge][1];

      p += rule->N[q][k] * unit / 2 *
           (u[PressureNodeOf(mesh, nodes[a]) * mesh->dim] + u[PressureNodeOf(mesh, nodes[b]) * mesh->dim]);
    }
    sum[0] += volume * PetscSqr(p - ExactPressure(D));
    sum[1] += volume * PetscSqr(ExactPressure(D));
  }
}

/* Computes the L2 norms of the errors of displacement, of the element's pressure and of the mean stress at the nodes,
   over those of the field. */
static void Errors(const Rule *rule, const Case *test, Mesh mesh, const PetscReal *u, const PetscReal *mean,
                   PetscReal error[QUANTITIES])
{
  const Element   *e                   = ElementGet(test->type);
  const KernelCase kernel              = {.type        = test->type,
                                          .geometry    = test->geometry,
                                          .kinematics  = KINEMATICS_SMALL,
                                          .law         = MATERIAL_LINEAR,
                                          .formulation = FORMULATION_MIXED};
  const PetscReal  compression         = young / (3 * (1 - 2 * poisson)); /* bulk modulus */
  const Material   material            = MaterialFromModuli(MATERIAL_LINEAR, young, poisson);
  PetscReal        sum[2 * QUANTITIES] = {0};

  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt *nodes = &mesh->cell_nodes[mesh->cell_ptr[c]];
    PetscReal       X[ELEMENT_MAX_NODES * 3], cell_u[ELEMENT_MAX_NODES * 3], H[ELEMENT_MAX_POINTS * 9],
      pressure[ELEMENT_MAX_POINTS], x[3] = {0}, exact[3], D[9], g[ELEMENT_MAX_NODES][3];

    for (int k = 0; k < e->nodes * e->dim; k++) {
      X[k]      = mesh->coords[nodes[k / e->dim] * e->dim + k % e->dim];
      cell_u[k] = u[nodes[k / e->dim] * e->dim + k % e->dim];
    }
    for (int q = 0; q < rule->points; q++) {
      const PetscReal volume = Place(test, mesh, c, rule->N[q], rule->dN[q], e->dim, rule->weight[q], x, g);

      Exact(test->geometry, x, exact, D);
      for (int i = 0; i < e->dim; i++) {
        PetscReal difference = -exact[i];

        for (int a = 0; a < e->nodes; a++) difference += rule->N[q][a] * cell_u[a * e->dim + i];
        sum[0] += volume * difference * difference;
        sum[1] += volume * exact[i] * exact[i];
      }
      D[0] = compression * (D[0] + D[4] + D[8]);
      sum[5] += volume * D[0] * D[0];
      for (int a = 0; a < e->nodes; a++) D[0] -= rule->N[q][a] * mean[nodes[a]];
      sum[4] += volume * D[0] * D[0];
    }
    if (ElementNodes(&kernel) > e->nodes) {
      AddNodalPressureError(rule, test, mesh, c, u, &sum[2]);
      continue;
    }
    ElementPointState(&kernel, X, cell_u, material.constants, NULL, H, pressure);
    for (int q = 0; q < e->points; q++) {
      const PetscReal volume = Place(test, mesh, c, e->N[q], e->dN[q][0], 3, e->weight[q], x, g);

      Exact(test->geometry, x, exact, D);
      sum[2] += volume * PetscSqr(pressure[q] - ExactPressure(D));
      sum[3] += volume * PetscSqr(ExactPressure(D));
    }
  }
  for (int i = 0; i < QUANTITIES; i++) error[i] = PetscSqrtReal(sum[2 * i] / sum[2 * i + 1]);
}

/* The solution */

static PetscErrorCode SolveLinear(Mesh mesh, Elasticity e, PetscReal *f, PetscReal *u)
{
  PetscReal *du;
  Vec        R, dx;
  KSP        ksp;
  PC         pc;
  Mat        K;
  PetscBool  ok;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &du));
  PetscCall(MeshCreateVector(mesh, &R));
  PetscCall(VecDuplicate(R, &dx));
  PetscCall(ElasticityResidual(e, u, f, NULL, NULL, &ok));
  PetscCall(MeshLocalToGlobal(mesh, f, R));
  PetscCall(ElasticityTangent(e, u, NULL));
  PetscCall(ElasticityMatrix(e, NULL, NULL, &K));
  PetscCall(KSPCreate(mesh->comm, &ksp));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, mesh->has_pressures ? PCLU : PCCHOLESKY));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(KSPSetOperators(ksp, K, K));
  PetscCall(KSPSolve(ksp, R, dx));
  PetscCall(MeshGlobalToLocal(mesh, dx, du));
  for (PetscInt k = 0; k < mesh->n_nodes * mesh->dim; k++) u[k] -= du[k];
  PetscCall(KSPDestroy(&ksp));
  PetscCall(VecDestroy(&R));
  PetscCall(VecDestroy(&dx));
  PetscCall(PetscFree(du));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Solve(const Case *test, int n, PetscReal *h, PetscReal error[QUANTITIES])
{
  static Rule rule;
  PetscReal  *u, *f, *mean;
  Elasticity  e;
  Scene       scene;
  Mesh        mesh;

  PetscFunctionBeginUser;
  PetscCall(CreateMesh(test, n, &scene, &mesh, &u));
  PetscCall(ElasticityCreate(mesh, scene, &e));
  PetscCall(ElasticitySetSymmetric(e, (PetscBool)!mesh->has_pressures));
  PetscCall(RuleCreate(test->type, &rule));
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &f));
  SubtractForce(&rule, test, mesh, f);
  PetscCall(SolveLinear(mesh, e, f, u));
  PetscCall(PetscMalloc1(mesh->n_nodes, &mean));
  PetscCall(NodalMean(e, mesh, u, mean));
  Errors(&rule, test, mesh, u, mean, error);
  PetscCall(PetscFree(mean));
  *h = PetscPowReal(mesh->n_cells_global, -1. / mesh->dim);
  PetscCall(PetscFree(f));
  PetscCall(PetscFree(u));
  PetscCall(ElasticityDestroy(&e));
  PetscCall(MeshDestroy(&mesh));
  PetscCall(SceneDestroy(&scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Rate(const PetscReal h[], PetscReal error[][QUANTITIES], int from, int to, int which)
{
  return PetscLogReal(error[to][which] / error[from][which]) / PetscLogReal(h[to] / h[from]);
}

static void Converges(void **state)
{
  static const char *const names[] =
    {[GEOMETRY_SOLID] = "solid", [GEOMETRY_PLANE_STRAIN] = "plane strain", [GEOMETRY_AXISYMMETRIC] = "axisymmetric"};
  const Case    *test = *state;
  const Element *e    = ElementGet(test->type);
  PetscReal      h[LEVELS], error[LEVELS][QUANTITIES], rate[QUANTITIES];

  for (int k = 0; k < LEVELS; k++) {
    char line[256];

    CHECK(Solve(test, test->n[k], &h[k], error[k]));
    for (int i = 0; i < QUANTITIES; i++) rate[i] = k ? Rate(h, error, k - 1, k, i) : NAN;
    print_message("%-6s %-13s %8.4f %12.4e %12.4e %12.4e %6.2f %6.2f %6.2f\n", e->name, names[test->geometry], h[k],
                  error[k][0], error[k][1], error[k][2], rate[0], rate[1], rate[2]);
    snprintf(line, sizeof(line), "%s,%s,%.6g,%.6g,%.6g,%.6g,%.3f,%.3f,%.3f\n", e->name, names[test->geometry], h[k],
             error[k][0], error[k][1], error[k][2], rate[0], rate[1], rate[2]);
    if (table) fputs(line, table);
  }
  assert_true(Rate(h, error, 0, LEVELS - 1, 0) > e->order + 1 - rate_margin);
  assert_true(Rate(h, error, 0, LEVELS - 1, e->order == 1 ? 2 : 1) > e->order - rate_margin);
}

int main(int argc, char **argv)
{
  struct CMUnitTest tests[CASES];
  char              command[128];
  int               failed;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCheck(realpath(argc > 1 ? argv[1] : "meshes", meshes), PETSC_COMM_WORLD, PETSC_ERR_FILE_OPEN,
             "there is no folder of meshes; name it as the argument");
  if (argc > 2) table = fopen(argv[2], "w");
  if (table)
    fputs("element,geometry,h,error_displacement,error_pressure,error_mean,rate_displacement,rate_pressure,rate_mean\n",
          table);
  PetscCall(PetscSNPrintf(folder, sizeof(folder), "/tmp/burnish_incompressible_XXXXXX"));
  PetscCheck(mkdtemp(folder), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot make %s", folder);
  for (int k = 0; k < CASES; k++) {
    tests[k]               = (struct CMUnitTest)cmocka_unit_test(Converges);
    tests[k].initial_state = (void *)&cases[k];
  }
  print_message("%-6s %-13s %8s %12s %12s %12s %6s %6s %6s\n", "element", "geometry", "h", "L2 error u", "L2 error p",
                "nodal mean", "rate u", "rate p", "mean");
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  PetscCall(PetscSNPrintf(command, sizeof(command), "rm -r %s", folder));
  if (system(command)) failed++;
  if (table) fclose(table);
  PetscCall(PetscFinalize());
  return failed;
}
