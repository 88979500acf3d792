/* Contact laws: from the gap of a slave node and its state to the potential per area and its derivatives. Plain C.

   A pair has one Law, which the scene chooses by name. A law is a file in this folder that defines a Law and a line in
   base/choices.h, from which the table Laws[], the names and the scene's key follow.

   Where a term presses, its pressure is -penalty (gap - LawOnsetGap()). Linear steps count on this (activeset.h), so a
   law of another shape must be left out there. */
#pragma once
#include "base/choices.h"

typedef struct {
  double penalty;    /* force per length and area */
  double offset;     /* g_0, subtracted from the gap (length) */
  double multiplier; /* pressure where the gap is at its offset; 0 without augmentation, negative with a fluid */
} LawState;

/*@
  LawOnsetGap - returns the gap below which there is pressure.

  Not collective

  Input Parameter:
. state - penalty, offset and multiplier of a term

  Note:
  It is the offset, plus the distance over which the multiplier presses before the surfaces meet (length). Where a
  fluid carries a pressure, the multiplier is negative: contact presses only what is above it. Plain C.
@*/
static inline double LawOnsetGap(const LawState *state)
{
  return state->offset + state->multiplier / state->penalty;
}

typedef struct {
  double psi;       /* potential (energy per area) */
  double pressure;  /* -psi', not negative (force per area) */
  double stiffness; /* psi'' (force per length and area) */
} LawValue;

typedef struct {
  int symmetric; /* has a potential: Cholesky's factor and a line search on the energy are right */
  void (*evaluate)(double gap, const LawState *state, LawValue *value);
} Law;

#define LAW_DECLARE(kind, word, object) extern const Law object;
CONTACT_LAWS(LAW_DECLARE)
#undef LAW_DECLARE
extern const Law *const Laws[]; /* by ContactLawKind */

const Law *LawFind(const char *name);
