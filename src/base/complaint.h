/* The first mistake found, in words, on the one rank that looked: all ranks then refuse together (RefuseInputAnywhere()
   of refusal.h). What is found later is mostly a consequence of the first. */
#pragma once
#include "base/petsccompat.h"

typedef struct {
  char text[2048]; /* empty: none */
} Complaint;

/* Writes down a mistake unless an earlier one stands there already. Not collective. */
void Complain(Complaint *, const char *, ...) __attribute__((format(printf, 2, 3)));
/* Refuses what any rank has complained of. Collective. */
PetscErrorCode ComplaintRefuse(MPI_Comm, const Complaint *);
