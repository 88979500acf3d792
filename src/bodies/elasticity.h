/* The elastic problem: element kernels over the local cells, and their residual, energy and tangent. Knows no contact.

   ElasticityResidual() and ElasticityTangent() evaluate this rank's cells. The tangent is summed into one rank-local
   block CSR over local nodes, with ghost rows and every dof, supported ones too. It may extrapolate stresses from an
   earlier state (stressreference.h). ElasticityMatrix() passes it on to a parallel AIJ matrix over the free dofs.
   ElasticityMultiplyLocal() multiplies it by local vectors for the prescribed dofs. ElasticityReleaseTangent() frees it
   until the next tangent. ElasticityNodalStress() gives stresses for output. ElasticityPlacePoints() places the
   quadrature points of one cell, ElasticityPointStates() and ElasticityPointRates() show those of a batch.

   Mixed elements whose volume is kept exactly, or nearly so, have multipliers (volumes.c). ElasticityFollow() changes
   them in an iteration of Newton's method, ElasticityAugment() after a solve until the volume is right.
   ElasticityAccept() keeps them with the accepted state, ElasticityRestore() returns to those. ElasticityKeep() and
   ElasticityReturn() do so for states on the way.
   ElasticitySetEnclosed() comes before all these: it tells the bodies whose level of pressure is free.

   Plastic bodies have an accepted state at each quadrature point. All evaluations start from it;
   ElasticityAcceptPlastic() alone changes it. ElasticityArchivePlastic() saves and loads it. */
#pragma once
#include "files/archive.h"
#include "kernels/elementkernel.h"
#include "kernels/stressreference.h"
#include "mesh/mesh.h"

/* Values of ElasticityNodalStrain() at a node */
enum { STRAIN_FIELDS = 7 };

typedef struct _n_Elasticity *Elasticity;

PetscErrorCode ElasticityCreate(Mesh, Scene, Elasticity *);
PetscErrorCode ElasticityDestroy(Elasticity *);
PetscErrorCode ElasticityResidual(Elasticity, const PetscReal *u, PetscReal *f, PetscReal *energy, PetscReal *force2,
                                  PetscBool *ok);
PetscErrorCode ElasticityVolumeEnergy(Elasticity, const PetscReal *u, PetscReal *energy);
PetscErrorCode ElasticityTangent(Elasticity, const PetscReal *u, const StressReference *);
PetscErrorCode ElasticityReleaseTangent(Elasticity);
PetscErrorCode ElasticityExtrapolates(Elasticity, PetscBool *any, PetscBool *rubber);
PetscErrorCode ElasticityAddBlock(Elasticity, PetscInt n, const PetscInt nodes[], const PetscReal k[]);
PetscErrorCode ElasticityMultiplyLocal(Elasticity, const PetscReal *x, PetscReal *y);
PetscErrorCode ElasticityMultiplyTransposed(Elasticity, const PetscReal *x, PetscReal *y);
PetscErrorCode ElasticitySetSymmetric(Elasticity, PetscBool);
PetscErrorCode ElasticityMatrix(Elasticity, Mat C, Vec diagonal, Mat *);
PetscErrorCode ElasticityMatrixJoin(Elasticity, Mat C);
PetscErrorCode ElasticityNodalStress(Elasticity, const PetscReal *u, PetscReal *stress, PetscReal *weight);
PetscErrorCode ElasticityNodalStrain(Elasticity, const PetscReal *u, PetscReal *strain, PetscReal *weight);
/* Columns of the plastic strain at the nodes: equivalent, tensor */
enum { PLASTIC_FIELDS = 7 };

/* What a step makes of plastic flow */
typedef struct {
  PetscReal growth; /* of the equivalent plastic strain of a point, the largest */
  PetscReal work;   /* plastic work */
  PetscReal lag;    /* the same, each point's times the part by which its stress lags behind the flow */
  PetscReal begun;  /* the same of points that begin to flow, times the growth of strain over the elastic one */
} PlasticPath;

/* States on the way whose multipliers are kept: the start of a step whose line search is not over */
typedef enum { VOLUMES_OF_SEARCH, VOLUMES_KEPT } VolumesKept;

void           ElasticitySetTime(Elasticity, PetscReal t);
PetscErrorCode ElasticityAcceptPlastic(Elasticity, const PetscReal *u, PetscReal t, PlasticPath *);
void           ElasticityForgetFlow(Elasticity);
PetscErrorCode ElasticityArchivePlastic(Elasticity, Archive);
PetscErrorCode ElasticityPlasticPath(Elasticity, const PetscReal *u, PetscReal t, PlasticPath *);
PetscErrorCode ElasticityNodalPlasticStrain(Elasticity, PetscReal *strain, PetscReal *weight);
PetscInt64     ElasticityPlasticPoints(Elasticity, PetscInt64 *bytes);
PetscErrorCode ElasticityPlasticWork(Elasticity, PetscReal *work, PetscReal *strain);
PetscErrorCode ElasticityAugment(Elasticity, const PetscReal *u, PetscBool *holds);
PetscErrorCode ElasticityFollow(Elasticity, const PetscReal *u, const StressReference *, PetscReal part);
PetscErrorCode ElasticityYield(Elasticity, const PetscReal *u, const PetscReal *next);
PetscBool      ElasticityYields(Elasticity);
void           ElasticityYieldSet(Elasticity, PetscBool yields);
void           ElasticityYieldForces(Elasticity, PetscBool yield);
PetscErrorCode ElasticityAccept(Elasticity);
PetscErrorCode ElasticityRestore(Elasticity);
PetscErrorCode ElasticityKeep(Elasticity, VolumesKept);
PetscErrorCode ElasticityReturn(Elasticity, VolumesKept);
PetscErrorCode ElasticityArchive(Elasticity, Archive);
PetscBool      ElasticityAugments(Elasticity);
PetscErrorCode ElasticitySetEnclosed(Elasticity, Scene, const PetscBool *prescribed);
PetscBool      ElasticityEnclosedChange(Elasticity);
PetscErrorCode ElasticityHas(Elasticity, Formulation, PetscBool *any);
/* Points of a cell: the quadrature points of the element, or those of ElementGetProducts() */
typedef enum { POINTS_OF_ELEMENT, POINTS_OF_PRODUCTS } CellPoints;

enum { ELASTICITY_BATCH = KERNEL_LANES };

/* The points of one cell, or how they change along a motion */
typedef struct {
  PetscReal H[ELEMENT_MAX_POINTS * 9];    /* displacement gradients at 3 i + I */
  PetscReal P[ELEMENT_MAX_POINTS * 9];    /* first Piola-Kirchhoff stresses, with small strains the stresses */
  PetscReal pressure[ELEMENT_MAX_POINTS]; /* of a mixed element (stress), 0 of others */
  PetscReal compliance; /* of the volume of a mixed element: one over the modulus (one over stress); 0 of others */
} PointStates;

PetscErrorCode ElasticityPlacePoints(Elasticity, PetscInt cell, CellPoints, PetscReal *x, PetscReal *volume);
PetscInt       ElasticityBatches(Elasticity);
void           ElasticityBatch(Elasticity, PetscInt batch, int *n, const PetscInt **cell);
PetscErrorCode ElasticityPointStates(Elasticity, PetscInt batch, CellPoints, const PetscReal *u, PointStates *);
PetscErrorCode ElasticityPointRates(Elasticity, PetscInt batch, CellPoints, const PetscReal *u, const PetscReal *v,
                                    PetscBool stresses, PointStates *);
PetscErrorCode ElasticityPointModes(Elasticity, PetscInt batch, const PetscReal *v, PointStates *);
PetscReal      ElasticityCellModulus(Elasticity, PetscInt cell);
PetscInt       ElasticityInvertedCell(Elasticity, int *fault);
