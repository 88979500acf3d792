/* Which contact terms press at the end of a linear step, by relaxation: term by term, each with all others as they are.
 */
#include "activesetimpl.h"

/* Most iterations of Newton's method for one component. Its equation is monotone and nearly piecewise linear; two or
   three are usual. */
#define RELAX_ITERATIONS 12
/* Sweeps have come to rest if they change no excess by more than this part of the traction that is no matter. */
#define RELAX_ENOUGH 0.1
/* A component is balanced to this part of that. */
#define RELAX_BALANCED 0.1
/* A pressure that changes by this many times all that the step as it is would make of the gaps belongs to sweeps that
   go astray. So they do in steps of a strip of steel that few nodes hold between punch and die. */
#define RELAX_FARTHEST 1e3

/* By how much the law of the component of column j is out of balance where its excess is changed by `change`, and the
   derivative of that. Other parts of its term move along with it. */
static PetscReal Imbalance(ActiveSet p, PetscInt j, PetscReal change, PetscReal *slope)
{
  const PetscInt   i = p->term[j] % p->n;
  const PetscReal *G = &p->G[j * p->parts * p->n];
  PetscReal        kept[ACTIVE_SET_PARTS], by[ACTIVE_SET_PARTS], imbalance;

  for (PetscInt part = 0; part < p->parts; part++) {
    kept[part] = p->end[part * p->n + i];
    p->end[part * p->n + i] -= change * G[part * p->n + i];
  }
  p->pressed[i] = (PetscBool)(p->terms[i].opening + p->end[i] < 0);
  imbalance     = ActiveSetExcess(p, p->term[j], by) - p->excess[j] - change;
  *slope        = -1;
  for (PetscInt part = 0; part < p->parts; part++) {
    *slope -= by[part] * G[part * p->n + i];
    p->end[part * p->n + i] = kept[part];
  }
  return imbalance;
}

/* The change of the excess of column j that balances its component. A bracket keeps Newton's method from going to and
   fro between two pieces of the law. A force that grows as it is yielded to, because friction elsewhere answers it, has
   no balance of its own; it stays as it is. */
static PetscReal Balanced(ActiveSet p, PetscInt j, PetscReal enough)
{
  PetscReal change = 0, low = -PETSC_MAX_REAL, high = PETSC_MAX_REAL, slope;

  for (int k = 0; k < RELAX_ITERATIONS; k++) {
    const PetscReal imbalance = Imbalance(p, j, change, &slope);

    if (PetscAbsReal(imbalance) <= enough || !(slope < 0)) break;
    if (imbalance > 0)
      low = change;
    else
      high = change;
    change -= imbalance / slope;
    if (change <= low || change >= high) change = (low + high) / 2;
  }
  return change;
}

/* Balances all columns once. *most: the largest change of an excess, or what is left of imbalance. *strays: one changed
   by more than `farthest`, or by no number. Columns that answer each other may grow by orders of magnitude within one
   sweep, so that each is looked at. */
static void Sweep(ActiveSet p, PetscReal enough, PetscReal farthest, PetscReal *most, PetscBool *strays)
{
  const PetscInt all = p->parts * p->n;
  PetscReal      slope;

  *most = 0;
  for (PetscInt j = 0; j < p->m && !*strays; j++) {
    const PetscInt  i      = p->term[j] % p->n;
    const PetscReal change = Balanced(p, j, RELAX_BALANCED * enough);
    const PetscReal left   = Imbalance(p, j, change, &slope);

    *strays = (PetscBool) !(PetscAbsReal(change) + PetscAbsReal(left) < farthest);
    *most   = PetscMax(*most, PetscMax(PetscAbsReal(change), PetscAbsReal(left)));
    p->excess[j] += change;
    for (PetscInt k = 0; k < all && change != 0; k++) p->end[k] -= change * p->G[j * all + k];
    p->work += change != 0 ? all : 0;
    p->pressed[i] = (PetscBool)(p->terms[i].opening + p->end[i] < 0);
  }
}

/*@
  ActiveSetRelax - balances the terms one after the other, again and again.

  Not collective

  Input Parameters:
+ p      - the active set, with some columns
- sweeps - over all columns, at most

  Output Parameter:
. settled - the sweeps came to rest: what the laws say of the components that have columns is what the excess makes of
            them, but for what is no matter to friction

  Notes:
  Newton's method for all terms at once goes in cycles where friction is large: what one set lets slip presses another
  term off, which the next set brings back. Each term alone has one answer as a rule, whatever its neighbours do, and
  the sweeps come to rest in far more cases, though slowly. A component that has no balance of its own keeps them from
  it: a step that is taken in spite of it leads a roller that is drawn along from one state to the next. Where sweeps go
  astray, the excess stays as it was.

  Source: Jourdan, Alart, Jean, A Gauss-Seidel like algorithm to solve frictional contact problems, CMAME 155 (1998)
  31-47.
@*/
PetscErrorCode ActiveSetRelax(ActiveSet p, PetscInt sweeps, PetscBool *settled)
{
  const PetscReal enough = RELAX_ENOUGH * ActiveSetNegligible(p);
  PetscReal       scale = 0, most = 0, *excess;
  PetscBool       strays = PETSC_FALSE;

  PetscFunctionBeginUser;
  *settled = PETSC_FALSE;
  PetscCall(PetscMalloc1(p->m, &excess));
  PetscCall(PetscArraycpy(excess, p->excess, p->m));
  for (PetscInt i = 0; i < p->n; i++) {
    const ActiveSetTerm *term = &p->terms[i];

    scale = PetscMax(scale, term->penalty * PetscMax(PetscAbsReal(term->opening), PetscAbsReal(p->travel[i])));
  }
  for (PetscInt sweep = 0; sweep < sweeps && !*settled && !strays && !ActiveSetSpent(p); sweep++) {
    Sweep(p, enough, RELAX_FARTHEST * scale, &most, &strays);
    *settled = (PetscBool)(!strays && most <= enough);
  }
  if (strays) PetscCall(PetscArraycpy(p->excess, excess, p->m));
  if (strays) (void)ActiveSetFollow(p);
  PetscCall(PetscFree(excess));
  for (PetscInt i = 0; i < p->n; i++) p->pressed[i] = (PetscBool)(p->terms[i].opening + p->end[i] < 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}
