/* The BLAS in use, asked of the dynamic linker and of OpenBLAS itself. */
#define _GNU_SOURCE /* dladdr() */
#include "base/blas.h"
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* OpenBLAS's kernels for processors that have no more than SSE. Later kernels are not listed: OpenBLAS chooses them
   only where they are right (Zen on a processor of AMD), where somebody has asked for them, or where it was built
   without those for AVX-512. */
static const char *const sse_kernels[] = {"Generic", "Katmai", "Coppermine",   "Northwood", "Prescott",   "Banias",
                                          "Atom",    "Core2",  "Penryn",       "Nehalem",   "Dunnington", "Athlon",
                                          "Opteron", "Nano",   "Opteron_SSE3", "Barcelona", "Bobcat"};

/*@
  ProcessorGetVectors - returns the widest vectors of the processor that the operating system lets programs use

  Not collective, plain C
@*/
ProcessorVectors ProcessorGetVectors(void)
{
#if defined(__x86_64__) && defined(__GNUC__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512cd"))
    return PROCESSOR_AVX512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return PROCESSOR_AVX2;
#endif
  return PROCESSOR_OTHER;
}

/*@
  BlasFasterKernels - returns the name of OpenBLAS's kernels that would be much faster than those in use

  Not collective, plain C

  Input Parameters:
+ kernels - OpenBLAS's name for the kernels in use; NULL where the BLAS is another library
- vectors - of the processor

  Note:
  Returns NULL if there are no faster ones.
@*/
const char *BlasFasterKernels(const char *kernels, ProcessorVectors vectors)
{
  static const char *const made_for[] =
    {[PROCESSOR_OTHER] = NULL, [PROCESSOR_AVX2] = "Haswell", [PROCESSOR_AVX512] = "SkylakeX"};

  for (size_t i = 0; i < sizeof(sse_kernels) / sizeof(sse_kernels[0]); i++)
    if (kernels && !strcasecmp(kernels, sse_kernels[i])) return made_for[vectors];
  return NULL;
}

/* The text that a function of the loaded libraries returns; NULL if there is no such function. */
static const char *LibraryText(const char *function)
{
  char *(*text)(void);

  *(void **)&text = dlsym(RTLD_DEFAULT, function);
  return text ? text() : NULL;
}

static void BlasFindFile(Blas *blas)
{
  static const char *const fast[] = {"openblas", "mkl",   "blis",      "atlas", "libsci",
                                     "essl",     "armpl", "flexiblas", "nvpl",  "accelerate"};
  void                    *dgemm  = dlsym(RTLD_DEFAULT, "dgemm_");
  char                    *real   = NULL;
  Dl_info                  info;

  if (dgemm && dladdr(dgemm, &info) && info.dli_fname) real = realpath(info.dli_fname, NULL);
  snprintf(blas->file, sizeof(blas->file), "%s", real ? real : "unknown");
  blas->reference = real && strstr(real, "blas");
  for (size_t i = 0; i < sizeof(fast) / sizeof(fast[0]); i++)
    if (real && strcasestr(real, fast[i])) blas->reference = 0;
  free(real);
}

/*@
  BlasFind - finds out which BLAS is in use and which kernels it has chosen

  Not collective, plain C

  Output Parameter:
. blas - what was found
@*/
void BlasFind(Blas *blas)
{
  const char *made = LibraryText("openblas_get_config");

  *blas = (Blas){.can_choose = made && strstr(made, "DYNAMIC_ARCH")};
  BlasFindFile(blas);
  if (strcasestr(blas->file, "openblas"))
    blas->kernels = LibraryText("openblas_get_corename"); /* another library may have loaded OpenBLAS */
  blas->faster_kernels = BlasFasterKernels(blas->kernels, ProcessorGetVectors());
}

/*@
  BlasPrint - prints the rest of a line: the file, the kernels, and how to have faster ones of the same library

  Not collective, plain C

  Input Parameters:
+ blas   - from BlasFind()
- stream - where to print
@*/
void BlasPrint(const Blas *blas, FILE *stream)
{
  fprintf(stream, "%s", blas->file);
  if (blas->kernels) fprintf(stream, ", kernels %s", blas->kernels);
  if (blas->faster_kernels && blas->can_choose)
    fprintf(stream, "; faster here: OPENBLAS_CORETYPE=%s", blas->faster_kernels);
  fprintf(stream, "\n");
}
