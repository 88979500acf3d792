/* Gauss-Seidel's method (symmetric sweeps over the nodes) as a preconditioner, and Chebyshev's iterations with it as a
   smoother. It is the same method on any number of ranks (sweeporder.h). No eigenvalue of the preconditioned operator
   is above 1, whatever the partition is. With sweeps of each rank for itself eigenvalues go up to the number of colours
   of ranks, and solves take 1.5 times as many iterations.

   The method reads a copy of the matrix in single precision (blockrows.h), once for each iteration with its residual.
   GaussSeidelSet() sets a preconditioner up; GaussSeidelGetMat() and GaussSeidelResidual() give multigrid its
   residuals.

   Measured: PETSc's smoothers on the finest level of the same multigrid, against this one (CPU time of the run, Krylov
   iterations, one rank). On spheres of 109,000 unknowns KSPRICHARDSON with PCSOR takes 1.44 times as much and 22
   iterations instead of 18, KSPCHEBYSHEV with PCSOR 1.55 times and 19, PCPBJACOBI 1.60 times and 35. On rings of
   120,000 unknowns KSPRICHARDSON with PCSOR takes 1.44 times as much and 32 iterations instead of 25. */
#pragma once
#include "base/petsccompat.h"

PetscErrorCode GaussSeidelSet(PC, PetscReal least, PetscReal largest);
PetscErrorCode GaussSeidelForget(PC);
PetscErrorCode GaussSeidelGetMat(PC, Mat *);
PetscErrorCode GaussSeidelResidual(Mat, Vec right, Vec x, Vec residual);
