/* A box of distorted cells for the oracle and the bench of assembly. BoxCreate() makes it as a mesh of the library,
   which is built by hand for one rank and has no supports. BoxCreatePetsc() makes it as a PetscFE problem with the same
   nodes, law (St. Venant-Kirchhoff) and quadrature. Each program includes this file once. */
#pragma once
#include "bodies/elasticity.h"
#include "kernels/elementkernel.h"
#include <petscds.h>
#include <math.h>

/* A cube is divided into one tetrahedron for each order of the three axes. */
enum { BOX_TETS_PER_CUBE = 6 };

typedef struct {
  ElementType type;
  PetscInt    n; /* number of cubes per side */
  Mesh        mesh;
  Scene       scene;
  PetscReal  *u;       /* a smooth displacement with finite strains */
  PetscInt   *corners; /* corners of each cell in DMPlex's order; only nodes at corners are numbered */
} Box;

/* Young's modulus (stress) and Poisson's ratio of the box */
static const PetscReal box_E = 200, box_nu = 0.3;
static PetscInt       *box_dofs; /* result of MeshGetGlobalDofs(), which is every local dof */

/* Replaces the function of the mesh, which works only for meshes that were read from files. */
PetscErrorCode MeshGetGlobalDofs(Mesh mesh, const PetscInt **dofs)
{
  (void)mesh;
  *dofs = box_dofs;
  return PETSC_SUCCESS;
}

/* Distorts the unit cube smoothly, so that the cells are no parallelepipeds. */
static inline void BoxPosition(const PetscReal s[3], PetscReal x[3])
{
  x[0] = 2 * s[0] + 0.1 * PetscSinReal(3 * s[1]) - 0.05 * s[2] * s[2];
  x[1] = 1.5 * s[1] + 0.1 * s[0] * s[2];
  x[2] = s[2] + 0.08 * PetscCosReal(2 * s[0]) * s[1];
}

/* A smooth displacement with finite strains, as a function for DMProjectFunctionLocal() */
static inline PetscErrorCode BoxDisplacement(PetscInt dim, PetscReal time, const PetscReal x[], PetscInt n,
                                             PetscScalar u[], void *context)
{
  (void)dim;
  (void)time;
  (void)n;
  (void)context;
  u[0] = 0.1 * x[0] + 0.05 * PetscSinReal(x[1]) * x[2];
  u[1] = -0.08 * x[1] * x[1] + 0.03 * x[0];
  u[2] = 0.06 * PetscCosReal(x[0]) * x[1] + 0.02 * x[2] * x[2];
  return PETSC_SUCCESS;
}

/* The coordinates themselves, as a function for DMProjectFunctionLocal() */
static inline PetscErrorCode BoxIdentity(PetscInt dim, PetscReal time, const PetscReal x[], PetscInt n, PetscScalar u[],
                                         void *context)
{
  (void)time;
  (void)n;
  (void)context;
  for (PetscInt i = 0; i < dim; i++) u[i] = x[i];
  return PETSC_SUCCESS;
}

/* Gives corner c of cell t of a cube, in {0, 1}^3. The cell is the only hexahedron, or the tetrahedron that follows one
   order of the axes. */
static inline void BoxCorner(const Element *e, int t, int c, int corner[3])
{
  static const int axes[BOX_TETS_PER_CUBE][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {2, 1, 0}, {0, 2, 1}};

  for (int k = 0; k < 3; k++) corner[k] = e->corners == 8 && e->node[c][k] > 0;
  if (e->corners == 8) return;
  if (t >= 3 && (c == 1 || c == 2)) c = 3 - c; /* With an odd order of the axes it would be left-handed. */
  for (int k = 0; k < c; k++) corner[axes[t][k]] = 1;
}

static inline PetscInt BoxGridIndex(PetscInt side, const PetscInt at[3])
{
  return (at[2] * side + at[1]) * side + at[0];
}

/* Returns DMPlex's number of gmsh's corner k. DMPlex swaps the first two corners of a tetrahedron and lists the bottom
   face of a hexahedron in the opposite direction. */
static inline int BoxPlexPlace(const Element *e, int k)
{
  if (e->corners == 4) return k < 2 ? 1 - k : k;
  return k == 1 ? 3 : k == 3 ? 1 : k;
}

/* Sets the nodes and corners of cell c, which is cell t of a cube. */
static inline void BoxCell(Box *box, const PetscInt cube[3], int t, PetscInt c)
{
  const Element    *e           = ElementGet(box->type);
  const ElementType first_order = e->order == 1 ? e->type : (ElementType)(e->type - 1);
  PetscReal         x[8][3];
  int               corner[8][3];

  for (int k = 0; k < e->corners; k++) {
    PetscInt  at[3];
    PetscReal s[3];

    BoxCorner(e, t, k, corner[k]);
    for (int i = 0; i < 3; i++) {
      at[i] = cube[i] + corner[k][i];
      s[i]  = (PetscReal)at[i] / box->n;
    }
    BoxPosition(s, x[k]);
    box->corners[c * e->corners + BoxPlexPlace(e, k)] = BoxGridIndex(box->n + 1, at);
  }
  for (int a = 0; a < e->nodes; a++) {
    PetscReal N[8];
    PetscInt  at[3], node;

    ElementShape(first_order, e->node[a], N, NULL, NULL);
    for (int i = 0; i < 3; i++) {
      PetscReal sum = cube[i];

      for (int k = 0; k < e->corners; k++) sum += N[k] * corner[k][i];
      at[i] = (PetscInt)lround(e->order * sum);
    }
    node                                    = BoxGridIndex(e->order * box->n + 1, at);
    box->mesh->cell_nodes[c * e->nodes + a] = node;
    for (int i = 0; i < 3; i++) {
      box->mesh->coords[node * 3 + i] = 0;
      for (int k = 0; k < e->corners; k++) box->mesh->coords[node * 3 + i] += N[k] * x[k][i];
    }
  }
}

static inline PetscErrorCode BoxCreate(ElementType type, PetscInt n, Box *box)
{
  const Element *e    = ElementGet(type);
  const PetscInt side = e->order * n + 1, per_cube = e->corners == 8 ? 1 : BOX_TETS_PER_CUBE;
  PetscInt       c = 0;
  Mesh           m;

  PetscFunctionBeginUser;
  *box = (Box){.type = type, .n = n};
  PetscCall(PetscCalloc1(1, &box->mesh));
  PetscCall(PetscCalloc1(1, &box->scene));
  m          = box->mesh;
  m->comm    = PETSC_COMM_SELF;
  m->dim     = 3;
  m->order   = e->order;
  m->n_nodes = m->n_owned = m->n_global = side * side * side;
  m->n_cells = m->n_cells_global = n * n * n * per_cube;
  PetscCall(PetscCalloc1(m->n_nodes, &m->node_owner));
  PetscCall(PetscCalloc1(m->n_nodes * 3, &m->coords));
  PetscCall(PetscMalloc1(m->n_cells, &m->cell_type));
  PetscCall(PetscCalloc1(m->n_cells, &m->cell_body));
  PetscCall(PetscMalloc1(m->n_cells + 1, &m->cell_ptr));
  PetscCall(PetscMalloc1(m->n_cells * e->nodes, &m->cell_nodes));
  PetscCall(PetscMalloc1(m->n_cells * e->corners, &box->corners));
  for (PetscInt k = 0; k < n; k++) {
    for (PetscInt j = 0; j < n; j++) {
      for (PetscInt i = 0; i < n; i++) {
        for (int t = 0; t < per_cube; t++, c++) BoxCell(box, (PetscInt[3]){i, j, k}, t, c);
      }
    }
  }
  for (c = 0; c < m->n_cells; c++) m->cell_type[c] = type;
  for (c = 0; c <= m->n_cells; c++) m->cell_ptr[c] = c * e->nodes;
  box->scene->geometry   = GEOMETRY_SOLID;
  box->scene->kinematics = KINEMATICS_FINITE;
  box->scene->n_bodies   = 1;
  PetscCall(PetscCalloc1(1, &box->scene->bodies));
  box->scene->bodies[0].material = MaterialFromModuli(MATERIAL_SVK, box_E, box_nu);
  PetscCall(PetscMalloc1(m->n_nodes * 3, &box_dofs));
  PetscCall(PetscMalloc1(m->n_nodes * 3, &box->u));
  for (PetscInt k = 0; k < m->n_nodes * 3; k++) box_dofs[k] = k;
  for (PetscInt k = 0; k < m->n_nodes; k++)
    PetscCall(BoxDisplacement(3, 0, &m->coords[k * 3], 3, &box->u[k * 3], NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode BoxDestroy(Box *box)
{
  Mesh m = box->mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(m->node_owner));
  PetscCall(PetscFree(m->coords));
  PetscCall(PetscFree(m->cell_type));
  PetscCall(PetscFree(m->cell_body));
  PetscCall(PetscFree(m->cell_ptr));
  PetscCall(PetscFree(m->cell_nodes));
  PetscCall(PetscFree(box->mesh));
  PetscCall(PetscFree(box->scene->bodies));
  PetscCall(PetscFree(box->scene));
  PetscCall(PetscFree(box->u));
  PetscCall(PetscFree(box->corners));
  PetscCall(PetscFree(box_dofs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The arguments of PETSc's pointwise functions, and the suppression of warnings about those that are not used */
#define BOX_POINTWISE_ARGUMENTS                                                                                     \
  PetscInt dim, PetscInt Nf, PetscInt NfAux, const PetscInt uOff[], const PetscInt uOff_x[], const PetscScalar u[], \
    const PetscScalar u_t[], const PetscScalar u_x[], const PetscInt aOff[], const PetscInt aOff_x[],               \
    const PetscScalar a[], const PetscScalar a_t[], const PetscScalar a_x[], PetscReal t

#define BOX_POINTWISE_UNUSED                                                                                         \
  (void)dim, (void)Nf, (void)NfAux, (void)uOff, (void)uOff_x, (void)u, (void)u_t, (void)aOff, (void)aOff_x, (void)a, \
    (void)a_t, (void)a_x, (void)t, (void)numConstants, (void)constants, (void)x

/* Computes the deformation gradient F and the second Piola-Kirchhoff stress S of the law, written as in a textbook. */
static inline void BoxStress(const PetscScalar u_x[], PetscReal F[3][3], PetscReal S[3][3], PetscReal *lambda,
                             PetscReal *mu)
{
  PetscReal trace = 0;

  *lambda = box_E * box_nu / ((1 + box_nu) * (1 - 2 * box_nu));
  *mu     = box_E / (2 * (1 + box_nu));
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) F[i][j] = u_x[3 * i + j] + (i == j);
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) S[i][j] = 0.5 * (F[0][i] * F[0][j] + F[1][i] * F[1][j] + F[2][i] * F[2][j] - (i == j));
    trace += S[i][i];
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) S[i][j] = 2 * *mu * S[i][j] + (i == j ? *lambda * trace : 0);
  }
}

static inline void BoxResidual(BOX_POINTWISE_ARGUMENTS, const PetscReal x[], PetscInt numConstants,
                               const PetscScalar constants[], PetscScalar f1[])
{
  PetscReal F[3][3], S[3][3], lambda, mu;

  BOX_POINTWISE_UNUSED;
  BoxStress(u_x, F, S, &lambda, &mu);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) f1[3 * i + j] = F[i][0] * S[0][j] + F[i][1] * S[1][j] + F[i][2] * S[2][j];
  }
}

static inline void BoxJacobian(BOX_POINTWISE_ARGUMENTS, PetscReal shift, const PetscReal x[], PetscInt numConstants,
                               const PetscScalar constants[], PetscScalar g3[])
{
  PetscReal F[3][3], S[3][3], lambda, mu;

  BOX_POINTWISE_UNUSED;
  (void)shift;
  BoxStress(u_x, F, S, &lambda, &mu);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      for (int m = 0; m < 3; m++) {
        for (int l = 0; l < 3; l++) {
          PetscReal value = lambda * F[i][m] * F[j][l] + mu * F[i][l] * F[j][m];

          if (i == j) value += S[m][l];
          if (m == l) value += mu * (F[i][0] * F[j][0] + F[i][1] * F[j][1] + F[i][2] * F[j][2]);
          g3[((i * 3 + j) * 3 + m) * 3 + l] = value;
        }
      }
    }
  }
}

/* Makes the quadrature of the library's element on PETSc's reference cell, which is [-1, 1]^3 or a simplex in it. */
static inline PetscErrorCode BoxQuadrature(const Element *e, PetscQuadrature *quadrature)
{
  PetscReal *points, *weights;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(e->points * 3, &points));
  PetscCall(PetscMalloc1(e->points, &weights));
  for (int p = 0; p < e->points; p++) {
    weights[p] = e->weight[p] * (e->corners == 8 ? 1 : 8);
    for (int k = 0; k < 3; k++) points[p * 3 + k] = e->corners == 8 ? e->point[p][k] : 2 * e->point[p][k] - 1;
  }
  PetscCall(PetscQuadratureCreate(PETSC_COMM_SELF, quadrature));
  PetscCall(PetscQuadratureSetData(*quadrature, 3, 1, e->points, points, weights));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the same problem as a DMPlex with a PetscFE. */
static inline PetscErrorCode BoxCreatePetsc(const Box *box, DM *dm)
{
  const Element  *e        = ElementGet(box->type);
  const PetscInt  vertices = (box->n + 1) * (box->n + 1) * (box->n + 1);
  PetscQuadrature quadrature;
  PetscReal      *coords;
  PetscFE         fe;
  PetscDS         ds;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(vertices * 3, &coords));
  for (PetscInt c = 0; c < box->mesh->n_cells; c++) {
    for (int k = 0; k < e->corners; k++)
      PetscCall(PetscArraycpy(&coords[box->corners[c * e->corners + BoxPlexPlace(e, k)] * 3],
                              &box->mesh->coords[box->mesh->cell_nodes[c * e->nodes + k] * 3], 3));
  }
  PetscCall(DMPlexCreateFromCellListPetsc(PETSC_COMM_SELF, 3, box->mesh->n_cells, vertices, e->corners, PETSC_TRUE,
                                          box->corners, 3, coords, dm));
  PetscCall(PetscFree(coords));
  PetscCall(PetscFECreateLagrange(PETSC_COMM_SELF, 3, 3, e->corners == 4 ? PETSC_TRUE : PETSC_FALSE, e->order,
                                  PETSC_DETERMINE, &fe));
  PetscCall(BoxQuadrature(e, &quadrature));
  PetscCall(PetscFESetQuadrature(fe, quadrature));
  PetscCall(PetscQuadratureDestroy(&quadrature));
  PetscCall(DMSetField(*dm, 0, NULL, (PetscObject)fe));
  PetscCall(PetscFEDestroy(&fe));
  PetscCall(DMCreateDS(*dm));
  PetscCall(DMGetDS(*dm, &ds));
  PetscCall(PetscDSSetResidual(ds, 0, NULL, BoxResidual));
  PetscCall(PetscDSSetJacobian(ds, 0, 0, NULL, NULL, NULL, BoxJacobian));
  PetscFunctionReturn(PETSC_SUCCESS);
}
