#include <string.h>
#include "law.h"

/* Chamoret et al. 2004, eq. 15, written as the derivative of psi = eps/2 min(g, 0)^2 so that the tangent (eq. 14) is symmetric. */
static void LawPenalty(double gap, const LawState *state, LawValue *value)
{
  const double g = gap - state->offset;

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
