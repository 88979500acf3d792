/* The table of contact laws, and the penalty law. */
#include <string.h>
#include "contactlaw.h"

/* Chamoret et al. (2004), eq. 15, written as the derivative of psi = eps/2 min(g, 0)^2, so that the tangent (eq. 14) is
   symmetric. With a multiplier lambda the pressure is max(0, lambda - eps g). This is the same law over the gap less
   lambda/eps, and its potential differs by a constant only (Simo and Laursen 1992, Computers & Structures 42, 97-116).
 */
static void LawPenalty(double gap, const LawState *state, LawValue *value)
{
  const double g = gap - LawOnsetGap(state);

  if (g < 0)
    *value = (LawValue){0.5 * state->penalty * g * g, -state->penalty * g, state->penalty};
  else
    *value = (LawValue){0, 0, 0};
}

const Law Law_Penalty = {.symmetric = 1, .evaluate = LawPenalty};

const Law *const         Laws[]     = {CONTACT_LAWS(CHOICE_POINTER)};
static const char *const LawNames[] = {CONTACT_LAWS(CHOICE_NAME)};

/*@
  LawFind - returns the law of a name, or NULL.

  Not collective

  Input Parameter:
. name - the word of the scene

  Note:
  Plain C.
@*/
const Law *LawFind(const char *name)
{
  for (int kind = 0; kind < CONTACT_LAW_KINDS; kind++)
    if (!strcmp(LawNames[kind], name)) return Laws[kind];
  return NULL;
}
