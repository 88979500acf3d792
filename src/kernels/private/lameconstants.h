/* Lame's constants: MaterialLame() computes them, and MaterialLameShear() is the shear modulus of the laws whose
   constants they are. Plain C. */
#pragma once
#include "kernels/material.h"

MaterialShearFn MaterialLameShear;
void            MaterialLame(double E, double nu, double *lambda, double *mu);
