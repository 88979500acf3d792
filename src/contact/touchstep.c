#include "contact/touchstep.h"
#include <math.h>

/* Sums of weights that reach the wanted one but for this fraction reach it: areas are sums whose last digits depend on
 * their order. */
#define TOUCH_STEP_ROUND_OFF 1e-9

/* TouchStepBeta - beta_k = g_t / (g_t - g_{t+dt}), NaN for a node that is no candidate. Not collective.

   before, after: gaps at the ends of a step (length; NaN: unknown); a candidate is open before (above resting) and
   approaches. Source: Chamoret et al. 2004, eq. 17. */
double TouchStepBeta(double before, double after, double resting)
{
  return before > resting && after < before ? before / (before - after) : NAN;
}

/* TouchStepChoose - beta_{N_c} of a sorted list: the first at which the weights sum up to the wanted one, the last if
   there are fewer. Not collective.

   touch[n]: ascending in beta; wanted: a number of nodes or an area; apart: betas that differ by no more than this
   belong to one tie, which touches together. Source: Chamoret et al. 2004, eqs 18 and 20. */
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
