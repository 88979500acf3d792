/* Names that PETSc 3.18 or the newest release lacks, so that one source builds against both, with 32-bit and with
   64-bit indices. Nothing else belongs here. */
#pragma once
#include <petscsnes.h>
#include <petscdmplex.h>
#include <petscsf.h>

#if PETSC_VERSION_LT(3, 19, 0)
  #define PETSC_SUCCESS ((PetscErrorCode)0)
#endif
#if PETSC_VERSION_LT(3, 25, 0)
  #define SNES_DIVERGED_FUNCTION_NANORINF SNES_DIVERGED_FNORM_NAN
#endif
/* Numbers of ranks that a PetscSF returns. */
#if PETSC_VERSION_LT(3, 23, 0)
typedef PetscInt SFCount;
#else
typedef PetscMPIInt SFCount;
#endif
