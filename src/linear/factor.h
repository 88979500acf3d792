/* The factor of a sparse matrix, made by MUMPS, and solves with it.

   MUMPS is called directly, not through PETSc's interface. That interface gives MUMPS no ordering on more than one rank
   and no right-hand sides with few entries. A MUMPS without METIS cuts graphs so unevenly that a second rank gains
   little.

   Create a Factor, make it with FactorMake() for each new matrix, and solve with FactorSolve(), FactorSolveTransposed()
   or FactorSolveColumns(). FactorAnalyse() alone finds what a factor would cost. FactorPrepareBorder() and
   FactorSetBorder() add a sum of few v v^T to the matrix without a change of its ordering (borderedfactor.h). */
#pragma once
#include "linear/borderedfactor.h"

typedef struct _n_Factor *Factor;

/* Orderings, by MUMPS's numbers (ICNTL(7)). METIS is called by this program, whether MUMPS has it or not. Automatic:
   METIS for all but small matrices. */
enum { FACTOR_AUTOMATIC = -1, FACTOR_MINIMUM_DEGREE = 0, FACTOR_MINIMUM_FILL = 2, FACTOR_METIS = 5 };

/* What a factor takes */
typedef struct {
  PetscReal operations, entries; /* floating-point operations; entries of the factor */
  PetscReal memory_mb[2];        /* of the largest rank, of all ranks (MB) */
} FactorCost;

PetscErrorCode FactorCheckOptions(void);
PetscErrorCode FactorCreate(MPI_Comm, PetscBool symmetric, Factor *);
PetscErrorCode FactorDestroy(Factor *);
PetscErrorCode FactorSetOrdering(Factor, int ordering, PetscBool *chosen);
PetscErrorCode FactorPrepareBorder(Factor, Mat K, PCFailedReason *);
PetscErrorCode FactorSetBorder(Factor, const Border *);
PetscBool      FactorHasBorder(Factor);
PetscErrorCode FactorAnalyse(Factor, Mat A, PCFailedReason *);
PetscErrorCode FactorMake(Factor, Mat A, PCFailedReason *);
PetscErrorCode FactorSolve(Factor, Vec b, Vec x);
PetscErrorCode FactorSolveTransposed(Factor, Vec b, Vec x);
PetscErrorCode FactorSolveColumns(Factor, Mat B, Mat X);
PetscBool      FactorIsSymmetric(Factor);
PetscBool      FactorExists(Factor);
PetscInt       FactorNegatives(Factor);
PetscInt       FactorParity(Factor);
void           FactorGetCost(Factor, FactorCost *);
