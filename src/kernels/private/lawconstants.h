/* The constants with which a law is evaluated at one point, for output: ElementLawConstants() leaves out the part that
   the pressure of a mixed element takes over. Plain C. */
#pragma once
#include "kernels/elementkernel.h"

int ElementLawConstants(const KernelCase *, const double *constants, double used[MATERIAL_MAX_CONSTANTS]);
