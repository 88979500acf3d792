/* An image of what an HDF5 file that grows overwrites: all of its bytes but the values of its datasets.

   FileImageTake() copies these bytes. FileImagePutBack() puts them back and cuts the file to its old length. The file
   is then what it was, however it was left. In this way a file is taken back to a checkpoint without a copy of its
   data. */
#pragma once
#include "base/petsccompat.h"

PetscErrorCode FileImageTake(const char *file, char **data, PetscInt64 *size);
PetscErrorCode FileImagePutBack(const char *file, const char *data, PetscBool *done);
