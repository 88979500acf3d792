/* The BLAS that the dynamic linker has chosen: which library it is, and whether it uses the vectors of the processor.

   BlasFind() finds out, BlasPrint() says it. OpenBLAS holds kernels for many processors and chooses among them by the
   model number of the processor when it starts. A version before 0.3.25 takes the kernels of 2004 on an Intel processor
   that is newer than itself. BlasFasterKernels() names better ones. */
#pragma once
#include <stdio.h>

/* Widest vectors of a processor for which there are kernels */
typedef enum { PROCESSOR_OTHER, PROCESSOR_AVX2, PROCESSOR_AVX512 } ProcessorVectors;

typedef struct {
  char        file[4096];     /* that holds dgemm, or "unknown" */
  int         reference;      /* it is the slow reference BLAS that Debian installs by default */
  const char *kernels;        /* OpenBLAS's name for the kernels in use; NULL: another BLAS */
  const char *faster_kernels; /* kernels that would be faster here; NULL: none, or not known */
  int         can_choose;     /* it holds several kernels and takes those that OPENBLAS_CORETYPE names */
} Blas;

void             BlasFind(Blas *);
void             BlasPrint(const Blas *, FILE *);
ProcessorVectors ProcessorGetVectors(void);
const char      *BlasFasterKernels(const char *kernels, ProcessorVectors);
