/* One factor for more than one tangent. Where little has changed since the factor was made, a few iterations of GMRES
   with it cost less than a new factor, and give the same solution. Contact terms that opened or closed since then are
   made up for by updates of low rank, and rotations of the bodies by corotation.h.

   Before each solve with a new operator call ReusedFactorNext(), and ReusedFactorUpdate() where it asks for the
   changes; after the KSP's own solve call ReusedFactorSolve(). Call ReusedFactorRenew() at the start of a load step:
   nothing that was solved before then has an influence, so that a step repeats itself to the last bit. */
#pragma once
#include "linear/corotation.h"

typedef struct _n_ReusedFactor *ReusedFactor;

typedef struct {
  PetscInt made;               /* factors */
  PetscInt served, iterations; /* solves with the factor of an older tangent, and their iterations */
  PetscInt finishing;          /* iterations of solves with a tangent's own factor, which leaves out a part */
} KeptCounts;

PetscErrorCode ReusedFactorCreate(KSP, ReusedFactor *);
PetscErrorCode ReusedFactorDestroy(ReusedFactor *);
PetscErrorCode ReusedFactorSetCorotation(ReusedFactor, Corotation);
PetscErrorCode ReusedFactorRenew(ReusedFactor);
PetscErrorCode ReusedFactorNext(ReusedFactor, PetscInt changes, PetscBool pattern, PetscBool *serves);
PetscErrorCode ReusedFactorUpdate(ReusedFactor, Mat N, const PetscReal *s);
PetscErrorCode ReusedFactorSetEnough(ReusedFactor, PetscReal residual);
PetscErrorCode ReusedFactorSolve(ReusedFactor, Mat A, Vec b, Vec x, PetscReal *tolerance, PetscReal *norm,
                                 PetscBool *failed);
PetscErrorCode ReusedFactorOwn(ReusedFactor, PetscBool *failed);
PetscBool      ReusedFactorIsOwn(ReusedFactor);
void           ReusedFactorGetCounts(ReusedFactor, KeptCounts *);
