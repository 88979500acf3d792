/* The plastic law with backstresses, for VonMisesLaw() only. */
#pragma once
#include "kernels/vonmises.h"

void BackstressLaw(int finite, const Lanes H[9], const Lanes *dilatation, const Lanes *bulk, const Lanes *shear,
                   const Hardening *, double dt, const Lanes state[], Lanes *W, Lanes P[9],
                   Lanes A[MATERIAL_TANGENT_SIZE], Lanes next[]);
