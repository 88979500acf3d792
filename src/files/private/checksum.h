/* The checksum of a file, by which a reader sees that no bit has changed since it was written.

   All ranks read the file together, each a part of its blocks, so that the cost falls with their number. The checksum
   does not depend on how many ranks they are. Checksum64() is the code of one block: a cyclic redundancy code (CRC) of
   64 bits. It finds every change within 64 neighbouring bits for certain, a single bit among them, and misses any
   other change with a probability of 2^-64. */
#pragma once
#include "base/petsccompat.h"
#include <stdint.h>

uint64_t       Checksum64(const void *bytes, size_t n);
PetscErrorCode ChecksumFile(MPI_Comm, const char *file, PetscInt64 start, PetscInt64 *bytes, uint64_t *checksum);
