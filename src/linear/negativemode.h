/* A negative eigenvalue of a matrix and its eigenvector, from the matrix's factor.

   The number of negative eigenvalues of a symmetric matrix comes with its factor (FactorNegatives()). Of another matrix
   nothing comes but whether the number is odd. A few solves find such an eigenvalue: those of a tangent that has lost
   its stability are close to 0, so that they are large ones of its inverse. */
#pragma once
#include "linear/factor.h"

PetscErrorCode NegativeModeFind(Factor, Vec mode, PetscReal *eigenvalue);
