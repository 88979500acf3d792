/* Boxes around points, see boundingbox.h. */
#include "boundingbox.h"

/*@
  SearchBoxEmpty - makes a box without any point.

  Not collective

  Input Parameter:
. dim - 2 or 3; in the plane the box has no height, from 0 to 0

  Output Parameter:
. box - lower then upper corner
@*/
void SearchBoxEmpty(int dim, PetscReal box[6])
{
  for (int d = 0; d < 3; d++) {
    box[d]     = d < dim ? PETSC_MAX_REAL : 0;
    box[3 + d] = d < dim ? PETSC_MIN_REAL : 0;
  }
}

/*@
  SearchBoxAdd - makes a box so large that it holds a point.

  Not collective

  Input Parameters:
+ dim - 2 or 3
- x   - x[dim], the point

  Input/Output Parameter:
. box - lower then upper corner
@*/
void SearchBoxAdd(PetscReal box[6], int dim, const PetscReal *x)
{
  for (int d = 0; d < dim; d++) {
    box[d]     = PetscMin(box[d], x[d]);
    box[3 + d] = PetscMax(box[3 + d], x[d]);
  }
}

/*@
  SearchBoxesMeet - tests whether two boxes are within a distance of each other.

  Not collective

  Input Parameters:
+ a        - box, lower then upper corner
. b        - another box
. dim      - 2 or 3
- distance - the distance (length)
@*/
PetscBool SearchBoxesMeet(const PetscReal *a, const PetscReal *b, int dim, PetscReal distance)
{
  for (int d = 0; d < dim; d++)
    if (a[d] > b[3 + d] + distance || b[d] > a[3 + d] + distance) return PETSC_FALSE;
  return PETSC_TRUE;
}
