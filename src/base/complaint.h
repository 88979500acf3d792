/* The first mistake that one rank finds in the user's input, in words.

   A rank that looks at its part of the input calls Complain() for each mistake. Afterwards all ranks call
   ComplaintRefuse(), which refuses together what any rank has found. ComplaintAnywhere() only says whether there is
   anything. Only the first mistake of a rank is kept, because
   later ones are mostly its consequences. */
#pragma once
#include "base/petsccompat.h"

typedef struct {
  char text[2048]; /* empty: no mistake */
} Complaint;

void           Complain(Complaint *, const char *, ...) __attribute__((format(printf, 2, 3)));
PetscErrorCode ComplaintAnywhere(MPI_Comm, const Complaint *, PetscBool *);
PetscErrorCode ComplaintRefuse(MPI_Comm, const Complaint *);
