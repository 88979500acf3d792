/* Records of one size that go from any rank to any rank. ExchangeRecords() sends them; the caller packs each one into
   the place from which it is sent, so that there is no copy of them besides. ExchangeSources() says from which ranks
   they come, so that each can be answered. ExchangeStarts() numbers what the ranks have. */
#pragma once
#include "base/petsccompat.h"

/* Writes record i, whose bytes are all zero. */
typedef void (*ExchangePack)(const void *context, PetscInt i, void *record);

PetscErrorCode ExchangeRecords(MPI_Comm, size_t bytes, PetscInt n, const PetscMPIInt to[], ExchangePack,
                               const void *context, PetscInt *n_arrived, void **arrived);
PetscErrorCode ExchangeSources(MPI_Comm, PetscInt n, const PetscMPIInt to[], PetscMPIInt **from);
PetscErrorCode ExchangeStarts(MPI_Comm, PetscInt n, PetscInt **start);
