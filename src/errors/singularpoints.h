/* Points where the stresses have no bound, by the shares of the cells in an error.

   At a sharp corner, or where a support ends, stresses are as d^(lambda - 1) with lambda < 1 at the distance d. The
   error per measure of a mesh of one size and of order p is then as d^(-2 (1 + p - lambda)), and that of the cells at
   the point itself falls as h^(2 lambda) only, whatever the order. lambda is at least 1/2, that of a crack. A node is
   such a point where the cells around it have many times the error of the cells around these, which are some three
   times as far away. Source: Szabo and Babuska, Finite Element Analysis (Wiley, 1991), 10. */
#pragma once
#include "mesh/meshdata.h"

/* Least power with which the error of the cells at such a point falls with their size, 2 lambda */
#define SINGULAR_RATE 1

PetscErrorCode SingularCellsFind(Mesh, const PetscReal *error, const PetscBool *skip, PetscBool *cells);
