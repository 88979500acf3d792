/* The elastic problem: element kernels over the local cells, and their residual, energy and tangent. Knows no contact.

   ElasticityResidual() and ElasticityTangent() evaluate this rank's cells. The tangent is summed into one rank-local
   block CSR over local nodes, with ghost rows and every dof, supported ones too. It may extrapolate pressures from an
   earlier state (pressurereference.h). ElasticityMatrix() passes it on to a
   parallel AIJ matrix over the free dofs, ElasticityMultiplyLocal() multiplies it by local vectors for the prescribed
   dofs. ElasticityNodalStress() gives stresses for output. */
#pragma once
#include "kernels/pressurereference.h"
#include "mesh/mesh.h"

typedef struct _n_Elasticity *Elasticity;

PetscErrorCode ElasticityCreate(Mesh, Scene, Elasticity *);
PetscErrorCode ElasticityDestroy(Elasticity *);
PetscErrorCode ElasticityResidual(Elasticity, const PetscReal *u, PetscReal *f, PetscReal *energy, PetscReal *force2,
                                  PetscBool *ok);
PetscErrorCode ElasticityVolumeEnergy(Elasticity, const PetscReal *u, PetscReal *energy);
PetscErrorCode ElasticityTangent(Elasticity, const PetscReal *u, const PressureReference *);
PetscBool      ElasticityExtrapolates(Elasticity);
PetscErrorCode ElasticityAddBlock(Elasticity, PetscInt n, const PetscInt nodes[], const PetscReal k[]);
PetscErrorCode ElasticityMultiplyLocal(Elasticity, const PetscReal *x, PetscReal *y);
PetscErrorCode ElasticitySetSymmetric(Elasticity, PetscBool);
PetscErrorCode ElasticityMatrix(Elasticity, Mat C, Vec diagonal, Mat *);
PetscErrorCode ElasticityMatrixJoin(Elasticity, Mat C);
PetscErrorCode ElasticityNodalStress(Elasticity, const PetscReal *u, PetscReal *stress, PetscReal *weight);
PetscReal      ElasticityCellModulus(Elasticity, PetscInt cell);
PetscInt       ElasticityInvertedCell(Elasticity);
