/* Ranges of tags, one for each rank, so that all ranks have about as many things with tags. TagRangesChoose() chooses
   them, TagRangesRank() says in which of them a tag is. */
#pragma once
#include "base/petsccompat.h"

PetscErrorCode TagRangesChoose(MPI_Comm, PetscInt n, const PetscInt tags[], PetscInt **first);
PetscMPIInt    TagRangesRank(PetscMPIInt size, const PetscInt first[], PetscInt tag);
