/* Stability of elastic laws in Drucker's sense: whether stresses grow with strains. Plain C.

   MaterialIsStable() checks one state, and MaterialStableEnd() looks for the stretch at which a law loses its stability
   in a test as laboratories make them. Only the shape is checked, at constant volume, because rubber hardly changes its
   volume. */
#pragma once
#include "kernels/material.h"

/* Homogeneous tests at constant volume: stretches (l, l^-1/2, l^-1/2), (l, l, l^-2) and (l, 1, l^-1). l > 1 is tension
   and l < 1 compression. */
typedef enum { TEST_UNIAXIAL, TEST_EQUIBIAXIAL, TEST_PLANAR, MATERIAL_TESTS } MaterialTest;

extern const char *const MaterialTests[]; /* their names */

/* Stretches up to which a law is checked, as is usual */
#define STABILITY_LEAST_STRETCH 0.1
#define STABILITY_MOST_STRETCH  10.

int    MaterialIsStable(const Material *, const double stretch[3]);
double MaterialStableEnd(const Material *, MaterialTest, int tension);
