/* The factor of a sparse matrix by MUMPS, spoken to without PETSc's interface in between: that hands it no ordering on
   more than one rank, no right-hand sides with few entries, and a MUMPS without METIS cuts graphs so unevenly that a
   second rank gains little. */
#pragma once
#include "linear/borderedfactor.h"

typedef struct _n_Factor *Factor;

/* How it is ordered, by MUMPS's numbers (its ICNTL(7)); METIS is ours, whether MUMPS has it or not. Automatic: METIS
 * for what is not small. */
enum { FACTOR_AUTOMATIC = -1, FACTOR_MINIMUM_DEGREE = 0, FACTOR_MINIMUM_FILL = 2, FACTOR_METIS = 5 };

/* What it takes, by analysis: operations; entries of the factor; memory of the largest and of all ranks (MB) */
typedef struct {
  PetscReal operations, entries, memory_mb[2];
} FactorCost;

/* symmetric: all matrices will be; L D L^T then, which need not be positive definite. Collective.
   Options Database Keys: -mat_mumps_icntl_<i>, -mat_mumps_cntl_<i>, as of PETSc's interface. */
PetscErrorCode FactorCreate(MPI_Comm, PetscBool symmetric, Factor *);
PetscErrorCode FactorDestroy(Factor *);
/* Are the values of these options numbers? An error of PETSc's if not. Not collective. */
PetscErrorCode FactorCheckOptions(void);
/* For the analyses to come; what -mat_mumps_icntl_7 says stays. *chosen (or NULL): it has said nothing. Logically
 * collective. */
PetscErrorCode FactorSetOrdering(Factor, int ordering, PetscBool *chosen);
/* For the matrices to come, which have K's pattern and a border: K is ordered by minimum fill, or degree if that was
 * set. Symmetric ones only. Collective. */
PetscErrorCode FactorPrepareBorder(Factor, Mat K, PCFailedReason *);
/* What is factored and solved with until the next call is the matrix, of the pattern that FactorPrepareBorder() was
   told, and these vectors, K + V V^T; NULL: the matrix. Collective, borrowed until the next call. */
PetscErrorCode FactorSetBorder(Factor, const Border *);
/* Has the next factor a border? Not collective, the same on all ranks. */
PetscBool FactorHasBorder(Factor);
/* Orders an AIJ matrix of symmetric pattern and counts what its factor will take. Collective. */
PetscErrorCode FactorAnalyse(Factor, Mat A, PCFailedReason *);
/* Factors it, after an analysis where its pattern is not that of the last; with more workspace where MUMPS finds its
 * own too short. Collective. */
PetscErrorCode FactorMake(Factor, Mat A, PCFailedReason *);
/* x = A^-1 b. Collective. */
PetscErrorCode FactorSolve(Factor, Vec b, Vec x);
/* X = A^-1 B, both dense; that most of B is zero is made use of. Collective. */
PetscErrorCode FactorSolveColumns(Factor, Mat B, Mat X);
/* Of the last analysis. Not collective, the same on all ranks. */
void FactorGetCost(Factor, FactorCost *);
