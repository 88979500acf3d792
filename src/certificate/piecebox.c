/* Boxes around places and pieces, see pieces.h. */
#include "pieces.h"
#include <math.h>

/*@
  BoxAround - computes the box around some places.

  Not collective

  Input Parameters:
+ n - their number; without any the lower corner is above the upper one
- x - the places

  Output Parameter:
. box - the box
@*/
void BoxAround(int n, const Place x[], Box box)
{
  for (int d = 0; d < 3; d++) {
    box[d]     = PETSC_MAX_REAL;
    box[3 + d] = PETSC_MIN_REAL;
    for (int a = 0; a < n; a++) {
      box[d]     = PetscMin(box[d], x[a][d]);
      box[3 + d] = PetscMax(box[3 + d], x[a][d]);
    }
  }
}

/*@
  BoxJoin - joins the boxes of all ranks.

  Collective

  Input Parameters:
+ comm - the ranks
- box  - of this rank; the joined box on return
@*/
void BoxJoin(MPI_Comm comm, Box box)
{
  (void)MPI_Allreduce(MPI_IN_PLACE, box, 3, MPIU_REAL, MPI_MIN, comm);
  (void)MPI_Allreduce(MPI_IN_PLACE, &box[3], 3, MPIU_REAL, MPI_MAX, comm);
}

/*@
  BoxesMeet - tells whether two boxes are within a distance of each other.

  Not collective

  Input Parameters:
+ a        - a box
. b        - another one
- distance - the distance (length)
@*/
PetscBool BoxesMeet(const Box a, const Box b, PetscReal distance)
{
  for (int d = 0; d < 3; d++)
    if (a[d] > b[3 + d] + distance || b[d] > a[3 + d] + distance) return PETSC_FALSE;
  return PETSC_TRUE;
}

/*@
  PiecePlace - finds the box that a piece sweeps, its normals and its longest side from its vertices.

  Not collective

  Input Parameter:
. dim - 2 or 3

  Input/Output Parameter:
. piece - with its places
@*/
void PiecePlace(Piece *piece, int dim)
{
  Box end;

  BoxAround(dim, (const Place *)piece->x[0], piece->box);
  BoxAround(dim, (const Place *)piece->x[1], end);
  for (int d = 0; d < 3; d++) {
    piece->box[d]     = PetscMin(piece->box[d], end[d]);
    piece->box[3 + d] = PetscMax(piece->box[3 + d], end[3 + d]);
  }
  for (int state = 0; state < 2; state++) PieceNormal(dim, (const Place *)piece->x[state], piece->normal[state]);
  piece->side = 0;
  for (int a = 0; a < dim; a++) {
    const double *p = piece->x[1][a], *q = piece->x[1][(a + 1) % dim];

    piece->side = fmax(piece->side, sqrt(PetscSqr(p[0] - q[0]) + PetscSqr(p[1] - q[1]) + PetscSqr(p[2] - q[2])));
  }
}
