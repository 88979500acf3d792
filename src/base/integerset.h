/* A set of integers, such as the nodes that some cells use. IntegerSetCreate() makes it of lists in which they may
   occur many times, IntegerSetPlace() finds the place of one of them, and IntegerSetDestroy() frees it. IntegersLast()
   finds the place of a value among ascending integers.

   A bit for each integer between the first and the last one takes less time than sorting and searching. Where they are
   so far apart that the bits would take more memory than the lists, they are sorted. */
#pragma once
#include "base/petsccompat.h"
#include <stdint.h>

typedef struct {
  PetscInt  n, *value; /* ascending */
  uint64_t *bits;      /* NULL: they are far apart */
  PetscInt *before;    /* for each word of bits, how many values are in the words before it */
} IntegerSet;

PetscErrorCode IntegerSetCreate(int n_lists, const PetscInt size[], const PetscInt *const list[], IntegerSet *);
PetscInt       IntegerSetPlace(const IntegerSet *, PetscInt value);
PetscErrorCode IntegerSetDestroy(IntegerSet *);
PetscInt       IntegersLast(PetscInt n, const PetscInt ascending[], PetscInt value);
