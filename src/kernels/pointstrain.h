/* Strains at points, and principal values of tensors, for output. Plain C.

   ElementPointStrain() gives strain and energy density at the quadrature points of an element. StrainOfGradient() gives
   the strain of a displacement gradient, PrincipalValues() the principal values and axes of a symmetric tensor. */
#pragma once
#include "kernels/elementkernel.h"

void StrainOfGradient(int finite, const double H[9], double strain[6]);
void PrincipalValues(const double tensor[6], double value[3], double axis[3][3]);
void ElementPointStrain(const KernelCase *, const double *X, const double *u, const double *constants,
                        const double *multiplier, double *strain, double *energy);
