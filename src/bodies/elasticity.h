/* The elastic problem: element kernels over the local cells, their residual, energy and tangent. Knows no contact.

   The tangent is summed into one rank-local block CSR over local nodes (ghost rows included, every dof, supports too)
   and handed on: ElasticityMatrix() to a parallel AIJ matrix over the free dofs, ElasticityMultiplyLocal() to the
   prescribed dofs. */
#pragma once
#include "mesh/mesh.h"

typedef struct _n_Elasticity *Elasticity;

PetscErrorCode ElasticityCreate(Mesh, Scene, Elasticity *);
PetscErrorCode ElasticityDestroy(Elasticity *);
/* u: n_nodes*dim local displacements. Adds internal forces to f (n_nodes*dim, without summation across ranks), the
   strain energy to energy and the squares of the unassembled element forces to force2; any of these may be NULL. All
   are this rank's, and so is ok. ok = PETSC_FALSE: some determinant of F is not positive (f is filled all the same). Not collective. */
PetscErrorCode ElasticityResidual(Elasticity, const PetscReal *u, PetscReal *f, PetscReal *energy, PetscReal *force2,
                                  PetscBool *ok);
/* The tangent at u into the local block CSR, zeroed first. Not collective. */
PetscErrorCode ElasticityTangent(Elasticity, const PetscReal *u);
/* Adds an n x n block of dofs (n nodes, node-major dofs) into the local block CSR: follower loads on faces of local
 * cells. Not collective. */
PetscErrorCode ElasticityAddBlock(Elasticity, PetscInt n, const PetscInt nodes[], const PetscReal k[]);
/* y += K x with the local block CSR, local vectors, no communication. Not collective. */
PetscErrorCode ElasticityMultiplyLocal(Elasticity, const PetscReal *x, PetscReal *y);
/* Whether the tangent is symmetric (default: yes); no as soon as somebody adds unsymmetric blocks. Before the first
 * ElasticityMatrix(). */
PetscErrorCode ElasticitySetSymmetric(Elasticity, PetscBool);
/* The matrix over the global free dofs: created by the first call, filled from the local block CSR, plus another matrix
   for which there is room (NULL: none); diagonal: without that one (NULL: not asked for). The elasticity keeps
   ownership. Collective. */
PetscErrorCode ElasticityMatrix(Elasticity, Mat C, Vec diagonal, Mat *);
/* Room in it for the entries of another matrix, before the next ElasticityMatrix(). Collective. */
PetscErrorCode ElasticityMatrixJoin(Elasticity, Mat C);
/* Cauchy stress at the nodes: in each cell the least-squares fit by the corner shape functions to the quadrature
   points' stress, averaged over the cells around a node by their volume (of each body apart is not needed: bodies share
   no nodes). stress n_nodes*6 (xx yy zz xy yz xz; axisymmetric rr zz hoop rz) and the weights n_nodes are set to this
   rank's share, to be summed over ranks and divided by the caller. */
PetscErrorCode ElasticityNodalStress(Elasticity, const PetscReal *u, PetscReal *stress, PetscReal *weight);
/* Largest material stiffness measure of a cell: E (for the automatic penalty) */
PetscReal ElasticityCellModulus(Elasticity, PetscInt cell);
/* A local cell that the last residual found with det F <= 0, or -1. Not collective. */
PetscInt ElasticityInvertedCell(Elasticity);
