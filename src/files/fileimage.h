/* What an HDF5 file that grows writes over: all of its bytes but the values of its datasets. With these put back and
   the file cut to its old length it is what it was, however it was left: so a file is taken back to a checkpoint
   without a copy of its data. */
#pragma once
#include "base/petsccompat.h"

/* data: to be freed with PetscFree(). The file must be closed. Not collective: for one rank. */
PetscErrorCode FileImageTake(const char *file, char **data, PetscInt64 *size);
/* *done: PETSC_FALSE if the file is missing or shorter than it was; it is left alone then. Not collective: for one
 * rank. */
PetscErrorCode FileImagePutBack(const char *file, const char *data, PetscBool *done);
