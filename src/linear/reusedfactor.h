/* A factor that serves more than one tangent: where little has changed since it was made, a few iterations of GMRES
   with it cost less than a new one, and give the same solution; of contact terms that came or went it is told. Only of
   what was solved since the last ReusedFactorRenew(), so that a step repeats itself to the last bit. */
#pragma once
#include "linear/corotation.h"

typedef struct _n_KeptFactor *ReusedFactor;

typedef struct {
  PetscInt made;               /* factors */
  PetscInt served, iterations; /* solves with the factor of an older tangent, iterations of these */
  PetscInt finishing;          /* iterations of solves with their own factor, which leaves out a part */
} KeptCounts;

/* For a KSP that factors (preonly); one that options have made another is left alone. Collective. */
PetscErrorCode ReusedFactorCreate(KSP, ReusedFactor *);
PetscErrorCode ReusedFactorDestroy(ReusedFactor *);
/* The operators are tangents of bodies that turn, by this object, which knows the state of each before
 * ReusedFactorNext(); borrowed. Not collective. */
PetscErrorCode ReusedFactorSetCorotation(ReusedFactor, Corotation);
/* The next tangent is factored, whatever has changed. Not collective. */
PetscErrorCode ReusedFactorRenew(ReusedFactor);
/* Before each solve with a new operator. changes: contact terms that came, went or changed their stiffness since the
   operator before; pattern: it has a new one. *serves: the factor does, the KSP leaves it alone, and it wants to be
   told of the changes, if there are. Collective. */
PetscErrorCode ReusedFactorNext(ReusedFactor, PetscInt changes, PetscBool pattern, PetscBool *serves);
/* After that: the changes are N diag(s) N^T, N dense, which is written to. Collective. */
PetscErrorCode ReusedFactorUpdate(ReusedFactor, Mat N, const PetscReal *s);
/* The residual (2-norm) that is enough for whoever solves, such as what ends Newton's method: a small part of it may be
 * left. Logically collective. */
PetscErrorCode ReusedFactorSetEnough(ReusedFactor, PetscReal residual);
/* After the KSP's own solve of A x = b: goes on from x by iterations where the factor is not A's, or has a border,
   which leaves a small part of A out; where these do not converge, with a new factor. *tolerance: relative residual
   that was asked for, left alone where the factor solves; *norm: the residual, negative: not known; *failed: a factor
   had to be made and could not. Collective. */
PetscErrorCode ReusedFactorSolve(ReusedFactor, Mat A, Vec b, Vec x, PetscReal *tolerance, PetscReal *norm,
                                 PetscBool *failed);
/* After that: the factor becomes A's own, but for a part that is left out, where it is an older one. Collective. */
PetscErrorCode ReusedFactorOwn(ReusedFactor, PetscBool *failed);
void           ReusedFactorGetCounts(ReusedFactor, KeptCounts *);
