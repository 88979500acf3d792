/* Refusals: wrong input of the user comes back as an error code with a message, and nothing ends the process.

   RefuseInput() refuses a mistake that every rank knows, for instance one in the scene, which all ranks read.
   RefuseInputAnywhere() refuses a mistake that only some ranks know, for instance one in their part of the mesh; all
   ranks always call it. Both keep the message and return REFUSED, which PetscCall() hands up to the caller of the run.
   All ranks get the code together, so that they leave together. The error handler of errorlog.h lets this code pass
   without a trace. The caller of the run takes the message with RefusalTake(). Internal errors are no refusals: they
   have other codes of PETSc.

   The message is kept for the process as a whole, because an error code of PETSc has room for a number only. One
   process therefore reads or runs one scene at a time. */
#pragma once
#include "base/petsccompat.h"

/* PETSc itself may return this code for a wrong option. It is a refusal only while RefusalIsPending(). */
#define REFUSED PETSC_ERR_USER_INPUT

PetscErrorCode RefuseInput(MPI_Comm, const char *, ...) __attribute__((format(printf, 2, 3)));
PetscErrorCode RefuseInputAnywhere(MPI_Comm, const char *);
PetscBool      RefusalIsPending(void);
PetscErrorCode RefusalTake(char **);
