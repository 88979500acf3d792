/* When open slave nodes touch, and how much of a load step brings as many of them into contact as wanted. */
#include "contact/touchstep.h"
#include <math.h>

/* Sums of weights that fall short of the wanted one by this fraction reach it: areas are sums whose last digits
   depend on their order. */
#define TOUCH_STEP_ROUND_OFF 1e-9

/*@
  TouchStepBeta - computes the part of a step at whose end a node touches, beta_k = g_t / (g_t - g_{t+dt}), eq. 17 of
  Chamoret et al. (2004).

  Not collective

  Input Parameters:
+ before  - gap at the start of the step (length); NaN: unknown
. after   - gap at its end (length)
- resting - gap up to which a node touches already (length)

  Note:
  Returns NaN for a node that is no candidate. A candidate is open at the start and approaches. Plain C.
@*/
double TouchStepBeta(double before, double after, double resting)
{
  return before > resting && after < before ? before / (before - after) : NAN;
}

/*@
  TouchStepChoose - finds the part of a step at which the weights of the touching nodes reach the wanted sum,
  beta_{N_c}, eqs 18 and 20 of Chamoret et al. (2004).

  Not collective

  Input Parameters:
+ n      - number of touches
. touch  - touches, ascending in beta
. wanted - number of nodes, or an area
- apart  - betas that differ by no more than this touch together

  Output Parameter:
. choice - beta and what touches by then; the last touch where there are fewer than wanted

  Note:
  Plain C.
@*/
void TouchStepChoose(int n, const Touch *touch, double wanted, double apart, TouchStepChoice *choice)
{
  *choice = (TouchStepChoice){.beta = NAN};
  while (choice->nodes < n && choice->met < (1 - TOUCH_STEP_ROUND_OFF) * wanted) {
    choice->beta = touch[choice->nodes].beta;
    choice->met += touch[choice->nodes++].weight;
  }
  while (choice->nodes > 0 && choice->nodes < n && touch[choice->nodes].beta <= choice->beta + apart) {
    choice->met += touch[choice->nodes++].weight;
    choice->tied++;
  }
}
