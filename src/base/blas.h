/* The BLAS that the dynamic linker chose: whose it is, and whether it makes use of what the processor has. OpenBLAS
   holds kernels for many processors and chooses by model number when it starts: one of before 0.3.25 takes those of
   2004 on an Intel processor that is newer than itself. */
#pragma once
#include <stdio.h>

/* Vectors that a processor has, as far as kernels are made for them */
typedef enum { PROCESSOR_OTHER, PROCESSOR_AVX2, PROCESSOR_AVX512 } ProcessorVectors;

typedef struct {
  char        file[4096];     /* that holds dgemm; "unknown" */
  int         reference;      /* the slow one that Debian installs by default */
  const char *kernels;        /* OpenBLAS's name for those it uses; NULL: another BLAS */
  const char *faster_kernels; /* those that would serve better here; NULL: these do, or not known */
  int         can_choose;     /* it holds several and takes those that OPENBLAS_CORETYPE names */
} Blas;

void             BlasFind(Blas *);
void             BlasPrint(const Blas *, FILE *); /* the rest of a line */
ProcessorVectors ProcessorGetVectors(void);
/* Which of OpenBLAS's kernels would be much faster than those that it uses on a processor; NULL: none. */
const char *BlasFasterKernels(const char *kernels, ProcessorVectors);
