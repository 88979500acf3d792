/* An image of the bytes that a growing HDF5 file overwrites, which are all its bytes except the values of its datasets.

   FileImageTake() copies these bytes at a checkpoint. FileImagePutBack() puts them back and cuts the file to its old
   length. The file then has its old content again, in whatever state the run has left it. A restart in this way sets a
   file back to a checkpoint without a copy of its data. */
#pragma once
#include "base/petsccompat.h"

PetscErrorCode FileImageTake(const char *file, char **data, PetscInt64 *size);
PetscErrorCode FileImagePutBack(const char *file, const char *data, PetscBool *done);
