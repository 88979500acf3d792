/* Gauss-Seidel's method (symmetric sweeps over small dense blocks) as a preconditioner, the same method on any number of ranks: rows that are coupled to other
   ranks are swept colour by colour of the ranks, with what the ranks before have found, the others meanwhile. So no eigenvalue of the preconditioned operator
   is above 1, whoever has what; sweeps of each rank for itself go up to the number of colours, and take half as many iterations more. */
#pragma once
#include "petsccompat.h"

/* Makes a preconditioner of that kind, for AIJ matrices with symmetric pattern and values; rows next to each other with the same columns, up to three, are a
   block. Logically collective. */
PetscErrorCode GaussSeidelSet(PC);
