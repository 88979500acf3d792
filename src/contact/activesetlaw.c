/* What the laws of contact and friction say of the terms at the end of a linear step, against residual and tangent. */
#include "activesetimpl.h"

/* Rounding of a pressure, as a part of it. */
#define ACTIVE_SET_ROUND_OFF 1e-12

/* What friction's law says of a traction at the end may differ from what residual and tangent do by this part of the
   largest traction that any term can bear, or by what ActiveSetEnough() allows, if that is less. Newton's method takes
   such differences in its stride, and columns for all terms whose direction of slip turns a little would cost more than
   they save. */
#define ACTIVE_SET_FRICTION 0.01
/* And by this part of the largest pressure: without a coefficient, as before friction sets in, rounding would decide
   whether tractions still change. Newton's method is content with more. */
#define ACTIVE_SET_TRIFLE 1e-9

/* Residual and tangent give a term a pressure that is linear in its travel. The difference between this pressure and
   that of the law is start + rate * travel. Both numbers are zero where residual and tangent treat the term as the law
   does. */
void ActiveSetPressureExcess(const ActiveSetTerm *term, PetscBool pressed, PetscReal *start, PetscReal *rate)
{
  *start = term->pressure + (pressed ? term->penalty * term->opening : 0);
  *rate  = (pressed ? term->penalty : 0) - term->stiffness;
  if (PetscAbsReal(*start) <= ACTIVE_SET_ROUND_OFF * PetscAbsReal(term->pressure)) *start = 0;
}

/* What residual and tangent make of a component at the end, less what the laws say of it, and the derivatives of this
   excess by the travel of the parts of its term. */
PetscReal ActiveSetExcess(ActiveSet p, PetscInt component, PetscReal by[ACTIVE_SET_PARTS])
{
  const PetscInt           i = component % p->n, part = component / p->n, a = part - 1;
  const ActiveSetTerm     *term     = &p->terms[i];
  const ActiveSetFriction *friction = &term->friction;
  FrictionInput            in       = friction->law;
  FrictionTraction         out;
  PetscReal                excess, start, rate;

  for (int l = 0; l < ACTIVE_SET_PARTS; l++) by[l] = 0;
  if (!part) {
    ActiveSetPressureExcess(term, p->pressed[i], &start, &rate);
    by[0] = rate;
    return start + rate * p->end[i];
  }
  if (in.stiffness == 0 || p->plain) return 0;
  excess = friction->traction[a] + friction->by_gap[a] * p->end[i];
  by[0]  = friction->by_gap[a];
  for (PetscInt l = 1; l < p->parts; l++) {
    excess += friction->by_slip[a][l - 1] * p->end[l * p->n + i];
    by[l] = friction->by_slip[a][l - 1];
    in.slip[l - 1] += p->end[l * p->n + i];
  }
  if (!p->pressed[i] && !(in.fluid > 0)) return excess;
  in.pressure = p->pressed[i] ? -term->penalty * (term->opening + p->end[i]) : 0;
  in.rate     = p->pressed[i] ? term->penalty : 0;
  in.state    = p->sticks[i] ? FRICTION_STICKS : FRICTION_DECIDES;
  FrictionEvaluate(&in, &out);
  by[0] -= out.by_gap[a];
  for (PetscInt l = 1; l < p->parts; l++) by[l] -= out.by_slip[a][l - 1];
  return excess - out.traction[a];
}

/* Largest traction that is no matter to friction. */
PetscReal ActiveSetNegligible(ActiveSet p)
{
  PetscReal most = 0, largest = 0;

  for (PetscInt i = 0; i < p->n && p->parts > 1; i++) {
    const PetscReal pressure = -p->terms[i].penalty * (p->terms[i].opening + p->end[i]);

    if (p->pressed[i]) most = PetscMax(most, FrictionBound(&p->terms[i].friction.law, pressure));
    largest = PetscMax(largest, pressure);
  }
  return PetscMax(PetscMin(ACTIVE_SET_FRICTION * most, p->enough), ACTIVE_SET_TRIFLE * largest);
}
