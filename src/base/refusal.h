/* How a user's mistake ends the program: one message on stderr, exit status 1, nothing overwritten.

   RefuseInput()         every rank knows the mistake (it stands in the scene, which all ranks read)
   RefuseInputAnywhere() some rank may know one (it stands in that rank's part of the mesh); always called by all ranks

   Neither returns after a refusal: they end MPI and PETSc in order and leave the process. Internal errors are not
   refusals: those go through PETSc's error codes and end with status 4. */
#pragma once
#include "base/petsccompat.h"

enum { EXIT_DONE = 0, EXIT_WRONG_INPUT = 1, EXIT_NOT_CONVERGED = 2, EXIT_STOPPED = 3, EXIT_MACHINE = 4 };

PetscErrorCode RefuseInput(MPI_Comm, const char *, ...) __attribute__((format(printf, 2, 3)));
PetscErrorCode RefuseInputAnywhere(MPI_Comm, const char *); /* NULL: this rank has nothing to complain of */
