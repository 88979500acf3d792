/* Sets of integers, see integerset.h. */
#include "base/integerset.h"

/* Bits of a word */
enum { WORD = 64 };

/* Finds the least and the largest integer of the lists. Returns how many entries the lists have. */
static PetscInt FindEnds(int n_lists, const PetscInt size[], const PetscInt *const list[], PetscInt ends[2])
{
  PetscInt n = 0;

  ends[0] = PETSC_MAX_INT;
  ends[1] = PETSC_MIN_INT;
  for (int l = 0; l < n_lists; l++) {
    n += size[l];
    for (PetscInt i = 0; i < size[l]; i++) {
      ends[0] = PetscMin(ends[0], list[l][i]);
      ends[1] = PetscMax(ends[1], list[l][i]);
    }
  }
  return n;
}

static PetscErrorCode SortLists(int n_lists, const PetscInt size[], const PetscInt *const list[], PetscInt n,
                                IntegerSet *set)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &set->value));
  for (int l = 0; l < n_lists; l++) {
    PetscCall(PetscArraycpy(set->value + set->n, list[l], size[l]));
    set->n += size[l];
  }
  PetscCall(PetscSortRemoveDupsInt(&set->n, set->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MarkLists(int n_lists, const PetscInt size[], const PetscInt *const list[], PetscInt first,
                                PetscInt words, IntegerSet *set)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(words, &set->bits));
  PetscCall(PetscMalloc1(words, &set->before));
  for (int l = 0; l < n_lists; l++)
    for (PetscInt i = 0; i < size[l]; i++)
      set->bits[(list[l][i] - first) / WORD] |= (uint64_t)1 << (list[l][i] - first) % WORD;
  for (PetscInt w = 0; w < words; w++) {
    set->before[w] = set->n;
    set->n += __builtin_popcountll(set->bits[w]);
  }
  PetscCall(PetscMalloc1(set->n, &set->value));
  for (PetscInt w = 0, at = 0; w < words; w++)
    for (uint64_t rest = set->bits[w]; rest; rest &= rest - 1)
      set->value[at++] = first + w * WORD + __builtin_ctzll(rest);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  IntegerSetCreate - makes a set of the integers in some lists.

  Not collective

  Input Parameters:
+ n_lists - number of lists
. size    - number of entries of each
- list    - the lists, of which none has a negative entry

  Output Parameter:
. set - freed by IntegerSetDestroy()
@*/
PetscErrorCode IntegerSetCreate(int n_lists, const PetscInt size[], const PetscInt *const list[], IntegerSet *set)
{
  PetscInt ends[2], n = FindEnds(n_lists, size, list, ends);

  PetscFunctionBeginUser;
  *set = (IntegerSet){0};
  if (n && (ends[1] - ends[0]) / WORD < n)
    PetscCall(MarkLists(n_lists, size, list, ends[0], (ends[1] - ends[0]) / WORD + 1, set));
  else
    PetscCall(SortLists(n_lists, size, list, n, set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  IntegersLast - finds the last of ascending integers that is not larger than a value.

  Not collective

  Input Parameters:
+ n         - number of integers
. ascending - the integers
- value     - the value

  Note:
  Returns its index, 0 where all are larger.
@*/
PetscInt IntegersLast(PetscInt n, const PetscInt ascending[], PetscInt value)
{
  PetscInt low = 0, high = n; /* it is in [low, high) */

  while (high - low > 1) {
    const PetscInt middle = low + (high - low) / 2;

    if (value >= ascending[middle])
      low = middle;
    else
      high = middle;
  }
  return low;
}

/*@
  IntegerSetPlace - finds the place of an integer among those of a set.

  Not collective

  Input Parameters:
+ set   - from IntegerSetCreate()
- value - one of its integers

  Note:
  Returns the index into set->value.
@*/
PetscInt IntegerSetPlace(const IntegerSet *set, PetscInt value)
{
  if (set->bits) {
    const PetscInt at = value - set->value[0];

    return set->before[at / WORD] + __builtin_popcountll(set->bits[at / WORD] & (((uint64_t)1 << at % WORD) - 1));
  }
  return IntegersLast(set->n, set->value, value);
}

/*@
  IntegerSetDestroy - frees a set.

  Not collective

  Input Parameter:
. set - empty afterwards
@*/
PetscErrorCode IntegerSetDestroy(IntegerSet *set)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(set->value));
  PetscCall(PetscFree(set->bits));
  PetscCall(PetscFree(set->before));
  *set = (IntegerSet){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}
