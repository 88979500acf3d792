/* What lets one source build against PETSc 3.18 and the newest release, with 32- and 64-bit indices. Nothing else
 * belongs here. */
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
