/* The rank that has the largest of a value that each rank has, for what one rank then tells all others. */
#pragma once
#include "base/petsccompat.h"

PetscErrorCode LargestOfRanks(MPI_Comm, PetscReal mine, PetscReal *most, PetscMPIInt *rank, PetscBool *here);
