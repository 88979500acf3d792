/* Gauss-Seidel's method (symmetric sweeps over the nodes) as a preconditioner, and Chebyshev's iterations with it as a
   smoother, the same method on any number of ranks (sweeporder.h): no eigenvalue of the preconditioned operator is
   above 1, whoever has what; sweeps of each rank for itself go up to the number of colours, and take half as many
   iterations more. It reads a copy of the matrix in single precision, once for each iteration with its residual. */
#pragma once
#include "base/petsccompat.h"

/* Makes a preconditioner of that kind, for AIJ matrices with symmetric pattern and values, whose block size is that of
   nodes, up to three. As KSPRICHARDSON's it smooths: eigenvalues from least to largest, of which none is above 1 but by
   rounding. Logically collective. */
PetscErrorCode GaussSeidelSet(PC, PetscReal least, PetscReal largest);
/* right - A x as PCMGSetResidual() wants it, for the matrix that stands for the preconditioner's; the caller destroys
   that. NULL: options have replaced the preconditioner. Collective. */
PetscErrorCode GaussSeidelGetMat(PC, Mat *);
PetscErrorCode GaussSeidelResidual(Mat, Vec right, Vec x, Vec residual);
