/* PETSc's options of a run, and how they changed at its restarts.

   PETSc takes options from the scene, the command line and the environment. None of them is read again from the
   checkpoint at a restart, so a run may go on with others. OptionRecordCreate() notes the options that hold now.
   OptionRecordArchive() keeps them in the checkpoint, compares them at a restart, and notes one line for each that is
   another one. OptionRecordPrint() and the text `changes` show these lines. */
#pragma once
#include "files/archive.h"

typedef struct {
  char  *now;     /* all options, as PetscOptionsGetAll() has them */
  char  *changes; /* a line for each option that changed at some restart, empty: none */
  size_t latest;  /* where the lines of the last restart begin in it */
} OptionRecord;

PetscErrorCode OptionRecordCreate(OptionRecord *);
PetscErrorCode OptionRecordDestroy(OptionRecord *);
PetscErrorCode OptionRecordArchive(OptionRecord *, PetscInt step, Archive);
void           OptionRecordPrint(const OptionRecord *, FILE *);
