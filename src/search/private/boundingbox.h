/* Boxes around points, along the axes: lower corner, then upper corner.

   SearchBoxEmpty() begins a box, SearchBoxAdd() makes it hold a point, and SearchBoxesMeet() compares two boxes. */
#pragma once
#include <petscsys.h>

void      SearchBoxEmpty(int dim, PetscReal box[6]);
void      SearchBoxAdd(PetscReal box[6], int dim, const PetscReal *x);
PetscBool SearchBoxesMeet(const PetscReal *a, const PetscReal *b, int dim, PetscReal distance);
