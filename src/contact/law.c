#include <string.h>
#include "law.h"

/* LawOnsetGap - the gap below which there is pressure (length). Not collective. */
double LawOnsetGap(const LawState *state)
{
  return state->offset + state->multiplier / state->penalty;
}

/* Chamoret et al. 2004, eq. 15, written as the derivative of psi = eps/2 min(g, 0)^2 so that the tangent (eq. 14) is
   symmetric. With a multiplier lambda the pressure is max(0, lambda - eps g): the same law over the gap less lambda/eps
   (Simo and Laursen 1992, Computers & Structures 42, 97-116; its potential but for a constant). */
static void LawPenalty(double gap, const LawState *state, LawValue *value)
{
  const double g = gap - LawOnsetGap(state);

  if (g < 0)
    *value = (LawValue){0.5 * state->penalty * g * g, -state->penalty * g, state->penalty};
  else
    *value = (LawValue){0, 0, 0};
}

const Law Laws[] = {
  {"penalty", 1, LawPenalty},
  {NULL,      0, NULL      }
};

/* LawFind - the law of that name, or NULL. Not collective. */
const Law *LawFind(const char *name)
{
  for (const Law *law = Laws; law->name; law++)
    if (!strcmp(law->name, name)) return law;
  return NULL;
}
