/* Ranges of tags, see tagranges.h. They come from samples of the tags of all ranks. */
#include "tagranges.h"
#include "base/integerset.h"

/* Samples for each range. Parts then differ by a few per cent of the mean. */
enum { TAG_SAMPLES = 64 };

/* Gathers samples of the tags of all ranks, sorted, as many of each rank as it has parts of all tags. */
static PetscErrorCode GatherSamples(MPI_Comm comm, PetscMPIInt size, PetscInt n, const PetscInt sorted[],
                                    PetscMPIInt *n_samples, PetscInt **samples)
{
  PetscInt    n_all = 0, *mine;
  PetscMPIInt n_mine, *count, *start;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(&n, &n_all, 1, MPIU_INT, MPI_SUM, comm));
  n_mine = n_all ? (PetscMPIInt)(((PetscInt64)n * TAG_SAMPLES * size + n_all - 1) / n_all) : 0;
  PetscCall(PetscMalloc3(n_mine, &mine, size, &count, size, &start));
  for (PetscMPIInt i = 0; i < n_mine; i++) mine[i] = sorted[(PetscInt64)n * i / n_mine];
  PetscCallMPI(MPI_Allgather(&n_mine, 1, MPI_INT, count, 1, MPI_INT, comm));
  *n_samples = 0;
  for (PetscMPIInt r = 0; r < size; r++) {
    start[r] = *n_samples;
    *n_samples += count[r];
  }
  PetscCall(PetscMalloc1(*n_samples, samples));
  PetscCallMPI(MPI_Allgatherv(mine, n_mine, MPIU_INT, *samples, count, start, MPIU_INT, comm));
  PetscCall(PetscSortInt(*n_samples, *samples));
  PetscCall(PetscFree3(mine, count, start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TagRangesChoose - chooses ranges of tags for the ranks.

  Collective

  Input Parameters:
+ comm - the ranks
. n    - number of tags of this rank
- tags - in any order

  Output Parameter:
. first - first tag of each rank's range [ranks]; to be freed with PetscFree()

  Note:
  The range of the first rank has no lower end, and that of the last one no upper end. Where there are few tags some
  ranges are empty.
@*/
PetscErrorCode TagRangesChoose(MPI_Comm comm, PetscInt n, const PetscInt tags[], PetscInt **first)
{
  PetscMPIInt size, n_samples = 0;
  PetscInt   *sorted, *samples;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscCalloc1(size, first));
  if (size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(n, &sorted));
  PetscCall(PetscArraycpy(sorted, tags, n));
  PetscCall(PetscSortInt(n, sorted));
  PetscCall(GatherSamples(comm, size, n, sorted, &n_samples, &samples));
  for (PetscMPIInt r = 1; r < size; r++)
    (*first)[r] = n_samples ? samples[(PetscInt64)n_samples * r / size] : PETSC_MAX_INT;
  PetscCall(PetscFree(samples));
  PetscCall(PetscFree(sorted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TagRangesRank - finds the rank in whose range a tag is: the last one whose first tag is not larger.

  Not collective

  Input Parameters:
+ size  - number of ranks
. first - first tag of each rank's range, ascending; that of the first rank does not matter
- tag   - the tag
@*/
PetscMPIInt TagRangesRank(PetscMPIInt size, const PetscInt first[], PetscInt tag)
{
  return (PetscMPIInt)IntegersLast(size, first, tag);
}
