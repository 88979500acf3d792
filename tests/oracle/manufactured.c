/* Shows that every element converges to an exact field at the rate of its order, which is p + 1 in the L2 norm, on
   curved and unstructured meshes. Small strains are tested for all elements and geometries, finite strains for some of
   them. On more than one rank, shows that the error does not depend on the number of ranks.

   The field is chosen. Its stress and body force follow from the laws in the form of a textbook. The library gets only
   the nodal values of the field on the boundary and the nodal forces, and it computes the displacement of the interior.
   The argument is the folder of the meshes (default: meshes). */
#include "bodies/elasticity.h"
#include <petscksp.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include "../rule.h"

/* Largest number of meshes of a case, half width of the difference stencil in steps, and largest number of Newton
   steps. MAX_NEWTON is twice the number that quadratic convergence from
   the nodal values of the field needs. */
enum { LEVELS = 3, STENCIL = 3, MAX_NEWTON = 6 };

/* The rate over all meshes of a case must exceed p + 1 minus this margin. The rate is a least-squares fit, because
   unstructured meshes scatter. */
static const PetscReal rate_margin = 0.2;
/* Largest relative difference of the errors on different numbers of ranks */
static const PetscReal rank_agreement = 1e-10;
/* Residual over the norm of the unassembled internal forces at which Newton's method has converged. Rounding is 1e-15.
 */
static const PetscReal newton_done = 1e-12;
/* Young's modulus (stress) and Poisson's ratio */
static const PetscReal young = 200, poisson = 0.3;
/* Inner radius of an axisymmetric box away from the axis. The sides of the box are 1. */
static const PetscReal offset_radius = 0.5;

#define CHECK(call) assert_int_equal((call), PETSC_SUCCESS)

typedef struct {
  ElementType type;
  Geometry    geometry;
  PetscBool   axis; /* whether an axisymmetric box touches the axis r = 0 */
  MaterialLaw law;  /* MATERIAL_LINEAR stands for small strains */
  Formulation formulation;
  int         levels, n[LEVELS];
} Case;

static const Case cases[] = {
  {ELEMENT_TRI3, GEOMETRY_PLANE_STRAIN, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_FULL, 3, {8, 16, 32}},
  {ELEMENT_TRI3, GEOMETRY_AXISYMMETRIC, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_FULL, 3, {8, 16, 32}},
  {ELEMENT_TRI3, GEOMETRY_AXISYMMETRIC, PETSC_TRUE, MATERIAL_LINEAR, FORMULATION_FULL, 3, {8, 16, 32}},
  {ELEMENT_TRI6, GEOMETRY_PLANE_STRAIN, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_FULL, 3, {8, 16, 32}},
  {ELEMENT_TRI6, GEOMETRY_AXISYMMETRIC, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_FULL, 3, {8, 16, 32}},
  {ELEMENT_TRI6, GEOMETRY_AXISYMMETRIC, PETSC_TRUE, MATERIAL_LINEAR, FORMULATION_FULL, 3, {8, 16, 32}},
  {ELEMENT_QUAD4, GEOMETRY_PLANE_STRAIN, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_FULL, 3, {8, 16, 32}},
  {ELEMENT_QUAD4, GEOMETRY_AXISYMMETRIC, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_FULL, 3, {8, 16, 32}},
  {ELEMENT_QUAD4, GEOMETRY_AXISYMMETRIC, PETSC_TRUE, MATERIAL_LINEAR, FORMULATION_FULL, 3, {8, 16, 32}},
  {ELEMENT_QUAD9, GEOMETRY_PLANE_STRAIN, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_FULL, 3, {4, 8, 16}},
  {ELEMENT_QUAD9, GEOMETRY_AXISYMMETRIC, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_FULL, 3, {4, 8, 16}},
  {ELEMENT_QUAD9, GEOMETRY_AXISYMMETRIC, PETSC_TRUE, MATERIAL_LINEAR, FORMULATION_FULL, 3, {4, 8, 16}},
  {ELEMENT_TET4, GEOMETRY_SOLID, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_FULL, 3, {4, 8, 12}},
  {ELEMENT_TET10, GEOMETRY_SOLID, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_FULL, 3, {4, 6, 8}},
  {ELEMENT_HEX8, GEOMETRY_SOLID, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_FULL, 3, {4, 8, 12}},
  {ELEMENT_HEX27, GEOMETRY_SOLID, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_FULL, 3, {2, 4, 6}},
  {ELEMENT_QUAD4, GEOMETRY_PLANE_STRAIN, PETSC_FALSE, MATERIAL_SVK, FORMULATION_FULL, 2, {8, 16}},
  {ELEMENT_QUAD4, GEOMETRY_PLANE_STRAIN, PETSC_FALSE, MATERIAL_NEO_HOOKEAN, FORMULATION_FULL, 2, {8, 16}},
  {ELEMENT_QUAD4, GEOMETRY_AXISYMMETRIC, PETSC_TRUE, MATERIAL_SVK, FORMULATION_FULL, 2, {8, 16}},
  {ELEMENT_QUAD4, GEOMETRY_AXISYMMETRIC, PETSC_TRUE, MATERIAL_NEO_HOOKEAN, FORMULATION_FULL, 2, {8, 16}},
  {ELEMENT_HEX8, GEOMETRY_SOLID, PETSC_FALSE, MATERIAL_SVK, FORMULATION_FULL, 2, {4, 8}},
  {ELEMENT_HEX8, GEOMETRY_SOLID, PETSC_FALSE, MATERIAL_NEO_HOOKEAN, FORMULATION_FULL, 2, {4, 8}},
  {ELEMENT_HEX27, GEOMETRY_SOLID, PETSC_FALSE, MATERIAL_SVK, FORMULATION_FULL, 2, {2, 4}},
  {ELEMENT_HEX27, GEOMETRY_SOLID, PETSC_FALSE, MATERIAL_NEO_HOOKEAN, FORMULATION_FULL, 2, {2, 4}},
  {ELEMENT_QUAD4, GEOMETRY_PLANE_STRAIN, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_ENHANCED, 3, {8, 16, 32}},
  {ELEMENT_QUAD4, GEOMETRY_AXISYMMETRIC, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_ENHANCED, 3, {8, 16, 32}},
  {ELEMENT_QUAD4, GEOMETRY_AXISYMMETRIC, PETSC_TRUE, MATERIAL_LINEAR, FORMULATION_ENHANCED, 3, {8, 16, 32}},
  {ELEMENT_HEX8, GEOMETRY_SOLID, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_ENHANCED, 3, {4, 8, 12}},
  {ELEMENT_QUAD4, GEOMETRY_PLANE_STRAIN, PETSC_FALSE, MATERIAL_SVK, FORMULATION_ENHANCED, 2, {8, 16}},
  {ELEMENT_QUAD4, GEOMETRY_AXISYMMETRIC, PETSC_TRUE, MATERIAL_NEO_HOOKEAN, FORMULATION_ENHANCED, 2, {8, 16}},
  {ELEMENT_HEX8, GEOMETRY_SOLID, PETSC_FALSE, MATERIAL_SVK, FORMULATION_ENHANCED, 2, {4, 8}},
  {ELEMENT_HEX8, GEOMETRY_SOLID, PETSC_FALSE, MATERIAL_NEO_HOOKEAN, FORMULATION_ENHANCED, 2, {4, 8}},
  {ELEMENT_QUAD4, GEOMETRY_PLANE_STRAIN, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_FBAR, 3, {8, 16, 32}},
  {ELEMENT_QUAD4, GEOMETRY_AXISYMMETRIC, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_FBAR, 3, {8, 16, 32}},
  {ELEMENT_QUAD4, GEOMETRY_AXISYMMETRIC, PETSC_TRUE, MATERIAL_LINEAR, FORMULATION_FBAR, 3, {8, 16, 32}},
  {ELEMENT_HEX8, GEOMETRY_SOLID, PETSC_FALSE, MATERIAL_LINEAR, FORMULATION_FBAR, 3, {4, 8, 12}},
  {ELEMENT_QUAD4, GEOMETRY_PLANE_STRAIN, PETSC_FALSE, MATERIAL_SVK, FORMULATION_FBAR, 2, {8, 16}},
  {ELEMENT_QUAD4, GEOMETRY_AXISYMMETRIC, PETSC_TRUE, MATERIAL_NEO_HOOKEAN, FORMULATION_FBAR, 2, {8, 16}},
  {ELEMENT_HEX8, GEOMETRY_SOLID, PETSC_FALSE, MATERIAL_SVK, FORMULATION_FBAR, 2, {4, 8}},
  {ELEMENT_HEX8, GEOMETRY_SOLID, PETSC_FALSE, MATERIAL_NEO_HOOKEAN, FORMULATION_FBAR, 2, {4, 8}},
};
enum { CASES = sizeof(cases) / sizeof(*cases) };

/* The case that is solved on any number of ranks */
static const Case parallel_case = {
  ELEMENT_TET10, GEOMETRY_SOLID, PETSC_FALSE, MATERIAL_NEO_HOOKEAN, FORMULATION_FULL, 1, {4}};

static PetscMPIInt rank;
static char        folder[64], meshes[PATH_MAX];

/* The exact field */

/* Computes the field u_i = a sin(k_i . s + p_i) with s = x, and its gradient H at 3 i + I. In the axisymmetric case x =
   r, y = z and s = (r^2, z), and u_r is multiplied by r, which makes the field smooth on the axis. H[8] is then the
   hoop strain. */
static void Exact(Geometry geometry, const PetscReal x[3], PetscReal u[3], PetscReal H[9])
{
  static const PetscReal k[3][3] = {{1.9, 1.1, -0.7}, {-1.3, 2.1, 0.9}, {0.8, 1.2, 1.7}};
  /* With an amplitude above 0.075, svk loses its ellipticity in compression. */
  static const PetscReal phase[3] = {0.4, 1.1, -0.6}, amplitude = 0.06;
  const int              dim = geometry == GEOMETRY_SOLID ? 3 : 2, axisymmetric = geometry == GEOMETRY_AXISYMMETRIC;

  for (int r = 0; r < 9; r++) H[r] = 0;
  for (int i = 0; i < dim; i++) {
    PetscReal angle = phase[i];

    for (int j = 0; j < dim; j++) angle += k[i][j] * (axisymmetric && j == 0 ? x[0] * x[0] : x[j]);
    u[i] = amplitude * PetscSinReal(angle);
    for (int j = 0; j < dim; j++)
      H[3 * i + j] = amplitude * PetscCosReal(angle) * k[i][j] * (axisymmetric && j == 0 ? 2 * x[0] : 1);
  }
  if (axisymmetric) {
    H[8] = u[0];
    H[0] = u[0] + x[0] * H[0];
    H[1] *= x[0];
    u[0] *= x[0];
  }
}

/* Computes the first Piola-Kirchhoff stress P. The laws are Hooke's law, P = F (lambda tr(E) 1 + 2 mu E) for svk, and
   P = mu (F - F^-T) + lambda ln J F^-T for neo_hookean. */
static void Stress(MaterialLaw law, const PetscReal H[9], PetscReal P[9])
{
  const PetscReal lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson)), mu = young / (2 * (1 + poisson));
  PetscReal       F[9], S[9], C[9], trace = 0, J = 0;

  for (int r = 0; r < 9; r++) F[r] = H[r] + (r % 4 == 0);
  for (int i = 0; i < 3; i++) { /* S holds the strain, C the cofactors of F. */
    for (int j = 0; j < 3; j++) {
      const int i1 = 3 * ((i + 1) % 3), i2 = 3 * ((i + 2) % 3), j1 = (j + 1) % 3, j2 = (j + 2) % 3;

      C[3 * i + j] = F[i1 + j1] * F[i2 + j2] - F[i1 + j2] * F[i2 + j1];
      S[3 * i + j] = (H[3 * i + j] + H[3 * j + i]) / 2;
      for (int m = 0; m < 3 && law == MATERIAL_SVK; m++) S[3 * i + j] += H[3 * m + i] * H[3 * m + j] / 2;
    }
    trace += S[4 * i];
    J += F[i] * C[i];
  }
  for (int r = 0; r < 9; r++) S[r] = 2 * mu * S[r] + (r % 4 == 0 ? lambda * trace : 0);
  for (int r = 0; r < 9; r++) {
    const int i = 3 * (r / 3), j = r % 3;

    if (law == MATERIAL_LINEAR)
      P[r] = S[r];
    else if (law == MATERIAL_SVK)
      P[r] = F[i] * S[j] + F[i + 1] * S[3 + j] + F[i + 2] * S[6 + j];
    else
      P[r] = mu * F[r] + (lambda * PetscLogReal(J) - mu) * C[r] / J;
  }
}

static void ExactStress(const Case *test, const PetscReal x[3], PetscReal P[9])
{
  PetscReal u[3], H[9];

  Exact(test->geometry, x, u, H);
  Stress(test->law, H, P);
}

/* Computes the body force -Div P by central differences of order 6. The field has wavelengths above 2, so that the
   errors of truncation and of rounding are both below 1e-11 of the force. */
static void ExactForce(const Case *test, const PetscReal x[3], PetscReal b[3])
{
  static const PetscReal weight[STENCIL] = {3. / 4, -3. / 20, 1. / 60}, step = 0.01;
  const int              dim = test->geometry == GEOMETRY_SOLID ? 3 : 2;
  PetscReal              P[9];

  for (int i = 0; i < 3; i++) b[i] = 0;
  for (int j = 0; j < dim; j++) {
    for (int m = -STENCIL; m <= STENCIL; m++) {
      PetscReal y[3] = {x[0], x[1], x[2]};

      if (!m) continue;
      y[j] += m * step;
      ExactStress(test, y, P);
      for (int i = 0; i < dim; i++) b[i] -= (m > 0 ? 1 : -1) * weight[abs(m) - 1] / step * P[3 * i + j];
    }
  }
  if (test->geometry == GEOMETRY_AXISYMMETRIC) {
    ExactStress(test, x, P);
    b[0] -= (P[0] - P[8]) / x[0];
    b[1] -= P[3] / x[0];
  }
}

/* The mesh */

/* Bends the box, so that cells are no parallelepipeds and cells of second order have curved sides. Points with r = 0
   stay on the axis. */
static void Bend(const Case *test, PetscReal x[3])
{
  const PetscReal s[3] = {x[0], x[1], x[2]};

  x[0] = s[0] * (1 + 0.15 * PetscSinReal(2 * s[1] + 1));
  x[1] = s[1] + 0.1 * PetscSinReal(2 * s[0]);
  x[2] = s[2] + 0.12 * s[0] * s[1];
  if (test->geometry == GEOMETRY_AXISYMMETRIC && !test->axis) x[0] += offset_radius;
}

/* Writes the scene of a case to a file on rank 0 and reads it. */
static PetscErrorCode SceneCreate(MPI_Comm comm, const Case *test, int n, Scene *scene)
{
  static const char *const names[] =
    {[GEOMETRY_SOLID] = "solid", [GEOMETRY_PLANE_STRAIN] = "plane_strain", [GEOMETRY_AXISYMMETRIC] = "axisymmetric"};
  const Element *e = ElementGet(test->type);
  char           file[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(file, sizeof(file), "%s/scene.yaml", folder));
  if (!rank) {
    FILE *stream = fopen(file, "w");

    PetscCheck(stream, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write %s", file);
    fprintf(
      stream,
      "geometry: %s\nkinematics: %s\nbodies: [{volume: block, formulation: %s, material: {law: %s, E: %g, nu: %g}}]\n",
      names[test->geometry], test->law == MATERIAL_LINEAR ? "small" : "finite", Formulations[test->formulation],
      MaterialLaws[test->law], young, poisson);
    fprintf(stream, "mesh: {file: %s/%s.geo, order: %d, parameters: {nx: %d, ny: %d", meshes,
            e->dim == 3 ? "block" : "square", e->order, n, n);
    if (e->dim == 3) fprintf(stream, ", nz: %d", n);
    fprintf(stream, ", %s: %d}}\n", e->dim == 3 ? "tet" : "tri", e->corners == e->dim + 1);
    fclose(stream);
  }
  PetscCallMPI(MPI_Barrier(PETSC_COMM_WORLD));
  PetscCall(SceneRead(comm, file, 0, NULL, scene));
  PetscCallMPI(MPI_Barrier(PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prescribes the displacement on the whole boundary. The axis is no boundary, and only the radial displacement is
   prescribed there. */
static PetscErrorCode Constrain(const Case *test, Scene scene, Mesh mesh)
{
  static const char *const sides[] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  PetscBool               *constrained;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &constrained));
  for (int side = 0; side < 2 * mesh->dim; side++) {
    MeshGroup *group;

    PetscCall(MeshGetGroup(mesh, scene, "supports.0", "surface", sides[side], mesh->dim - 1, &group));
    for (PetscInt k = 0; k < group->n_nodes; k++) {
      for (int i = 0; i < (test->axis && side == 0 ? 1 : mesh->dim); i++)
        constrained[group->nodes[k] * mesh->dim + i] = PETSC_TRUE;
    }
  }
  PetscCall(MeshSetConstraints(mesh, constrained));
  PetscCall(PetscFree(constrained));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the scene and the mesh, bends the mesh and computes the nodal values u of the field. The coordinates of the
   mesh are relative to its centre, and the field has its origin there. */
static PetscErrorCode CreateMesh(MPI_Comm comm, const Case *test, int n, Scene *scene, Mesh *mesh, PetscReal **u)
{
  char        file[PETSC_MAX_PATH_LEN];
  PetscReal   seconds;
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCall(SceneCreate(comm, test, n, scene));
  PetscCall(MeshGenerate(comm, *scene, folder, PETSC_FALSE, file, &seconds));
  PetscCall(MeshCreate(comm, *scene, file, mesh));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCheck(size == 1 || (*mesh)->n_cells < (*mesh)->n_cells_global, PETSC_COMM_SELF, PETSC_ERR_PLIB,
             "one rank has all the cells");
  PetscCall(PetscMalloc1((*mesh)->n_nodes * (*mesh)->dim, u));
  for (PetscInt k = 0; k < (*mesh)->n_nodes; k++) {
    const int  dim  = (*mesh)->dim;
    PetscReal *node = &(*mesh)->coords[k * dim], x[3] = {0}, value[3], H[9];

    PetscCall(PetscArraycpy(x, node, dim));
    Bend(test, x);
    Exact(test->geometry, x, value, H);
    PetscCall(PetscArraycpy(node, x, dim));
    PetscCall(PetscArraycpy(&(*u)[k * dim], value, dim));
  }
  PetscCall(MeshCheckQuality(*mesh, *scene));
  PetscCall(Constrain(test, *scene, *mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Integrals */

/* Gives the place of point q of a cell. Returns the volume of the point, over 360 degrees if axisymmetric. */
static PetscReal RulePoint(const Rule *rule, int q, const Case *test, Mesh mesh, PetscInt c, PetscReal x[3])
{
  const int       dim   = mesh->dim;
  const PetscInt *nodes = &mesh->cell_nodes[mesh->cell_ptr[c]], n = mesh->cell_ptr[c + 1] - mesh->cell_ptr[c];
  PetscReal       J[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, volume = 0;

  for (int i = 0; i < dim; i++) {
    x[i] = 0;
    for (PetscInt a = 0; a < n; a++) { x[i] += rule->N[q][a] * mesh->coords[nodes[a] * dim + i]; }
    for (int k = 0; k < dim; k++) {
      J[i][k] = 0;
      for (PetscInt a = 0; a < n; a++) J[i][k] += rule->dN[q][a * dim + k] * mesh->coords[nodes[a] * dim + i];
    }
  }
  for (int k = 0; k < 3; k++)
    volume += J[0][k] * (J[1][(k + 1) % 3] * J[2][(k + 2) % 3] - J[1][(k + 2) % 3] * J[2][(k + 1) % 3]);
  return volume * rule->weight[q] * (test->geometry == GEOMETRY_AXISYMMETRIC ? 2 * PETSC_PI * x[0] : 1);
}

/* Subtracts the nodal forces of the exact body force from f. */
static void SubtractForce(const Rule *rule, const Case *test, Mesh mesh, PetscReal *f)
{
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    for (int q = 0; q < rule->points; q++) {
      PetscReal       x[3], b[3];
      const PetscReal volume = RulePoint(rule, q, test, mesh, c, x);

      ExactForce(test, x, b);
      for (PetscInt k = mesh->cell_ptr[c]; k < mesh->cell_ptr[c + 1]; k++) {
        for (int i = 0; i < mesh->dim; i++)
          f[mesh->cell_nodes[k] * mesh->dim + i] -= volume * rule->N[q][k - mesh->cell_ptr[c]] * b[i];
      }
    }
  }
}

/* Computes the L2 norm of the difference between u and the exact field, divided by the norm of the field. Collective.
 */
static PetscErrorCode L2Error(const Rule *rule, const Case *test, Mesh mesh, const PetscReal *u, PetscReal *error)
{
  PetscReal sum[2] = {0, 0};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    for (int q = 0; q < rule->points; q++) {
      PetscReal       x[3], exact[3], H[9];
      const PetscReal volume = RulePoint(rule, q, test, mesh, c, x);

      Exact(test->geometry, x, exact, H);
      for (int i = 0; i < mesh->dim; i++) {
        PetscReal difference = -exact[i];

        for (PetscInt k = mesh->cell_ptr[c]; k < mesh->cell_ptr[c + 1]; k++)
          difference += rule->N[q][k - mesh->cell_ptr[c]] * u[mesh->cell_nodes[k] * mesh->dim + i];
        sum[0] += volume * difference * difference;
        sum[1] += volume * exact[i] * exact[i];
      }
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPIU_SUM, mesh->comm));
  *error = PetscSqrtReal(sum[0] / sum[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The solution */

/* Solves by Newton's method from the nodal values of the exact field. `load` is minus the external forces. Small
   strains need one step. Collective. */
static PetscErrorCode Newton(Mesh mesh, Elasticity e, const PetscReal *load, PetscReal *u, PetscInt *steps)
{
  const PetscInt n = mesh->n_nodes * mesh->dim;
  PetscReal     *f, *du, norm, scale;
  Vec            R, dx;
  KSP            ksp;
  PC             pc;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &f));
  PetscCall(PetscCalloc1(n, &du));
  PetscCall(MeshCreateVector(mesh, &R));
  PetscCall(VecDuplicate(R, &dx));
  PetscCall(KSPCreate(mesh->comm, &ksp));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCCHOLESKY));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  for (*steps = 0;; ++*steps) {
    PetscBool ok;
    Mat       K;

    PetscCall(PetscArraycpy(f, load, n));
    scale = 0;
    PetscCall(ElasticityResidual(e, u, f, NULL, &scale, &ok));
    PetscCheck(ok, PETSC_COMM_SELF, PETSC_ERR_PLIB, "the solution turns cells inside out");
    PetscCall(MeshLocalToGlobal(mesh, f, R));
    PetscCall(VecNorm(R, NORM_2, &norm));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &scale, 1, MPIU_REAL, MPIU_SUM, mesh->comm));
    if (norm <= newton_done * PetscSqrtReal(scale) || *steps == MAX_NEWTON) break;
    PetscCall(ElasticityTangent(e, u, NULL));
    PetscCall(ElasticityMatrix(e, NULL, NULL, &K));
    PetscCall(KSPSetOperators(ksp, K, K));
    PetscCall(KSPSolve(ksp, R, dx));
    PetscCall(MeshGlobalToLocal(mesh, dx, du));
    for (PetscInt k = 0; k < n; k++) u[k] -= du[k];
  }
  PetscCall(KSPDestroy(&ksp));
  PetscCall(VecDestroy(&R));
  PetscCall(VecDestroy(&dx));
  PetscCall(PetscFree(f));
  PetscCall(PetscFree(du));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves on one mesh. Gives the error, the number of Newton steps and h, the side of a cube that has the mean size of a
   cell of a unit box. Collective. */
static PetscErrorCode Solve(MPI_Comm comm, const Case *test, int n, PetscReal *h, PetscReal *error, PetscInt *steps)
{
  static Rule rule;
  PetscReal  *u, *load;
  Elasticity  e;
  Scene       scene;
  Mesh        mesh;

  PetscFunctionBeginUser;
  PetscCall(CreateMesh(comm, test, n, &scene, &mesh, &u));
  PetscCall(ElasticityCreate(mesh, scene, &e));
  PetscCall(RuleCreate(test->type, &rule));
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &load));
  SubtractForce(&rule, test, mesh, load);
  PetscCall(Newton(mesh, e, load, u, steps));
  PetscCall(L2Error(&rule, test, mesh, u, error));
  *h = PetscPowReal(mesh->n_cells_global, -1. / mesh->dim);
  PetscCall(PetscFree(load));
  PetscCall(PetscFree(u));
  PetscCall(ElasticityDestroy(&e));
  PetscCall(MeshDestroy(&mesh));
  PetscCall(SceneDestroy(&scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const char *GeometryText(const Case *test)
{
  if (test->geometry == GEOMETRY_SOLID) return "solid";
  if (test->geometry == GEOMETRY_PLANE_STRAIN) return "plane strain";
  return test->axis ? "axisymmetric, axis" : "axisymmetric";
}

/* Returns the slope of the least-squares line through log(error) over log(h). */
static PetscReal Rate(int levels, const PetscReal h[], const PetscReal error[])
{
  PetscReal mean[2] = {0, 0}, sum[2] = {0, 0};

  for (int k = 0; k < levels; k++) {
    mean[0] += PetscLogReal(h[k]) / levels;
    mean[1] += PetscLogReal(error[k]) / levels;
  }
  for (int k = 0; k < levels; k++) {
    const PetscReal x = PetscLogReal(h[k]) - mean[0];

    sum[0] += x * x;
    sum[1] += x * (PetscLogReal(error[k]) - mean[1]);
  }
  return sum[1] / sum[0];
}

static void Converges(void **state)
{
  const Case     *test  = *state;
  const Element  *e     = ElementGet(test->type);
  const PetscReal bound = e->order + 1 - rate_margin;
  PetscReal       h[LEVELS], error[LEVELS];

  for (int k = 0; k < test->levels; k++) {
    PetscInt steps;

    CHECK(Solve(PETSC_COMM_WORLD, test, test->n[k], &h[k], &error[k], &steps));
    print_message("%-6s %-19s %-12s %-9s %8.4f %12.4e %7d", e->name, GeometryText(test), MaterialLaws[test->law],
                  Formulations[test->formulation], h[k], error[k], (int)steps);
    if (k) print_message(" %6.2f", Rate(2, &h[k - 1], &error[k - 1]));
    if (k == test->levels - 1) print_message(" %6.2f > %.1f", Rate(test->levels, h, error), bound);
    print_message("\n");
    assert_true(steps < MAX_NEWTON && (test->law != MATERIAL_LINEAR || steps == 1));
  }
  assert_true(Rate(test->levels, h, error) > bound);
}

static void SameOnAllRanks(void **state)
{
  PetscReal h, error, alone;
  PetscInt  steps, steps_alone;

  (void)state;
  CHECK(Solve(PETSC_COMM_WORLD, &parallel_case, parallel_case.n[0], &h, &error, &steps));
  CHECK(Solve(PETSC_COMM_SELF, &parallel_case, parallel_case.n[0], &h, &alone, &steps_alone));
  if (!rank)
    print_message("relative L2 error %.4e, on one rank different by %.1e of it\n", error,
                  PetscAbsReal(error - alone) / alone);
  assert_true(PetscAbsReal(error - alone) < rank_agreement * alone);
  assert_int_equal(steps, steps_alone);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest parallel[] = {cmocka_unit_test(SameOnAllRanks)};
  struct CMUnitTest       tests[CASES];
  PetscMPIInt             size;
  char                    command[128];
  int                     failed;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCheck(realpath(argc > 1 ? argv[1] : "meshes", meshes), PETSC_COMM_WORLD, PETSC_ERR_FILE_OPEN,
             "there is no folder of meshes; name it as the argument");
  PetscCall(PetscSNPrintf(folder, sizeof(folder), "/tmp/burnish_manufactured_XXXXXX"));
  PetscCheck(rank || mkdtemp(folder), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot make %s", folder);
  PetscCallMPI(MPI_Bcast(folder, sizeof(folder), MPI_CHAR, 0, PETSC_COMM_WORLD));
  for (int k = 0; k < CASES; k++) {
    tests[k]               = (struct CMUnitTest)cmocka_unit_test(Converges);
    tests[k].initial_state = (void *)&cases[k];
  }
  if (size > 1)
    failed = cmocka_run_group_tests(parallel, NULL, NULL);
  else {
    print_message("%-6s %-19s %-12s %-9s %8s %12s %7s %6s %6s\n", "element", "geometry", "law", "strains", "h",
                  "L2 error", "Newton", "rate", "all");
    failed = cmocka_run_group_tests(tests, NULL, NULL);
  }
  PetscCall(PetscSNPrintf(command, sizeof(command), "rm -r %s", folder));
  PetscCallMPI(MPI_Barrier(PETSC_COMM_WORLD));
  if (!rank && system(command)) failed++;
  PetscCall(PetscFinalize());
  return failed;
}
