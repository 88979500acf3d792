/* How one set of terms leads to the next: Newton's method for what presses, sticks and slips at the end of a linear
   step, with the columns that are known. */
#include "activesetimpl.h"

/* A slope of the energy is zero if it is this part of that where the search begins. */
#define ACTIVE_SET_SLOPE 1e-9

/* Damped changes are halved at most so many times. */
#define ACTIVE_SET_HALVINGS 5

/* Slip of a term along a tangent at the end, elastic slip where the step begins included. */
static PetscReal EndSlip(const ActiveSet p, PetscInt i, PetscInt a)
{
  return p->terms[i].friction.law.slip[a] + (a + 1 < p->parts ? p->end[(a + 1) * p->n + i] : 0);
}

/* Finds terms whose slip has turned round since they were looked at last. In a set each slips on in its direction, and
   the next set would turn it round again. Between the two it sticks. */
void ActiveSetLookAtSlips(ActiveSet p)
{
  for (PetscInt i = 0; i < p->n && p->parts > 1; i++) {
    const FrictionInput *law      = &p->terms[i].friction.law;
    const PetscReal      opening  = p->terms[i].opening + p->end[i];
    const PetscReal      pressure = PetscMax(0, -p->terms[i].penalty * opening);
    PetscReal            along = 0, square = 0, most;

    for (int a = 0; a < 2; a++) {
      const PetscReal slip = EndSlip(p, i, a);

      along += slip * p->slip[2 * i + a];
      square += PetscSqr(slip);
      p->slip[2 * i + a] = slip;
    }
    most          = law->stiffness * FrictionCountedShare(law, pressure) * PetscSqrtReal(square);
    p->sticks[i]  = (PetscBool)(p->slipped[i] && along < 0);
    p->slipped[i] = (PetscBool)(!p->sticks[i] && most > FrictionBound(law, pressure));
  }
}

/* Terms of the set at hand that need a column and have none. */
PetscInt ActiveSetMissing(ActiveSet p, PetscInt *which)
{
  PetscInt m = 0;

  for (PetscInt i = 0; i < p->n; i++) {
    PetscReal start, rate;

    ActiveSetPressureExcess(&p->terms[i], p->pressed[i], &start, &rate);
    if (p->column[i] < 0 && (start != 0 || rate != 0)) which[m++] = i;
  }
  return m;
}

/* Components of friction, of the terms where the law at the end matters, that have no column. Where there would be too
   many, none is asked for. */
PetscInt ActiveSetMissingFriction(ActiveSet p, PetscInt *which)
{
  const PetscReal negligible = ActiveSetNegligible(p);
  PetscReal       by[ACTIVE_SET_PARTS];
  PetscInt        m = 0;

  for (PetscInt i = 0; i < p->n; i++) {
    PetscBool matters = PETSC_FALSE;

    for (PetscInt part = 1; part < p->parts; part++)
      matters = (PetscBool)(matters || (p->column[part * p->n + i] < 0 &&
                                        PetscAbsReal(ActiveSetExcess(p, part * p->n + i, by)) > negligible));
    for (PetscInt part = 1; part < p->parts && matters; part++)
      if (p->column[part * p->n + i] < 0) which[m++] = part * p->n + i;
  }
  return p->m + m <= p->most ? m : 0;
}

/* Solves a x = b for dense columns a[m*m] and b[m], both overwritten; x is left in b. *regular is PETSC_TRUE if the
   matrix is not singular. */
static PetscErrorCode DenseSolve(PetscInt m, PetscReal *a, PetscReal *b, PetscBool *regular)
{
  PetscErrorCode code;
  Mat            matrix;
  Vec            right, x;

  PetscFunctionBeginUser;
  *regular = PETSC_TRUE;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, m, m, a, &matrix));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, m, b, &right));
  PetscCall(VecDuplicate(right, &x));
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL)); /* to PETSc a pivot of exactly zero is an error */
  code = MatLUFactor(matrix, NULL, NULL, NULL);
  PetscCall(PetscPopErrorHandler());
  *regular = code ? PETSC_FALSE : PETSC_TRUE;
  if (*regular) PetscCall(MatSolve(matrix, right, x));
  if (*regular) PetscCall(VecCopy(x, right));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&right));
  PetscCall(MatDestroy(&matrix));
  for (PetscInt j = 0; j < m && *regular; j++) *regular = (PetscBool)!PetscIsInfOrNanReal(b[j]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* By how much the derivatives of a column's excess change it under 1 on column l. */
static PetscReal Influence(const ActiveSet p, PetscInt j, const PetscReal by[ACTIVE_SET_PARTS], PetscInt l)
{
  PetscReal influence = 0;

  for (PetscInt part = 0; part < p->parts; part++)
    influence += by[part] * p->G[l * p->parts * p->n + part * p->n + p->term[j] % p->n];
  return influence;
}

/* The change of the excess e of all columns by one iteration of Newton's method for e = excess(travel - G e). *regular
   is PETSC_TRUE if its matrix is not singular. Columns whose excess does not depend on travels have it at once, and
   only the others are unknowns. */
static PetscErrorCode Balance(ActiveSet p, PetscBool *regular)
{
  PetscInt  *unknown, k = 0;
  PetscReal *a, *b, *by;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(p->m, &unknown));
  PetscCall(PetscMalloc1(ACTIVE_SET_PARTS * p->m, &by));
  for (PetscInt j = 0; j < p->m; j++) {
    PetscReal *d    = &by[ACTIVE_SET_PARTS * k];
    PetscBool  free = PETSC_FALSE;

    p->change[j] = ActiveSetExcess(p, p->term[j], d) - p->excess[j];
    for (int part = 0; part < ACTIVE_SET_PARTS; part++) free = (PetscBool)(free || d[part] != 0);
    if (free) unknown[k++] = j;
  }
  PetscCall(PetscMalloc2(k * k, &a, k, &b));
  for (PetscInt i = 0; i < k; i++) b[i] = p->change[unknown[i]];
  for (PetscInt i = 0; i < k; i++) p->change[unknown[i]] = 0;
  for (PetscInt l = 0; l < k; l++)
    for (PetscInt i = 0; i < k; i++)
      a[l * k + i] = (l == i) + Influence(p, unknown[i], &by[ACTIVE_SET_PARTS * i], unknown[l]);
  for (PetscInt l = 0; l < p->m; l++)
    for (PetscInt i = 0; i < k && p->change[l] != 0; i++)
      b[i] -= p->change[l] * Influence(p, unknown[i], &by[ACTIVE_SET_PARTS * i], l);
  PetscCall(DenseSolve(k, a, b, regular));
  p->work += (PetscReal)k * k * (p->parts + k / 3.0);
  for (PetscInt i = 0; i < k; i++) p->change[unknown[i]] = b[i];
  PetscCall(PetscFree2(a, b));
  PetscCall(PetscFree(by));
  PetscCall(PetscFree(unknown));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* By how much an excess[m] of all columns closes the gaps, and slides the terms back: closing[components], the first
   ones of parts*n. Columns are long, so that each is passed through once. */
static void Closing(ActiveSet p, const PetscReal *excess, PetscInt components, PetscReal *closing)
{
  for (PetscInt i = 0; i < components; i++) closing[i] = 0;
  for (PetscInt j = 0; j < p->m; j++) {
    const PetscReal *column = &p->G[j * p->parts * p->n];

    if (excess[j] == 0) continue;
    for (PetscInt i = 0; i < components; i++) closing[i] += column[i] * excess[j];
    p->work += components;
  }
}

/* Says whether the problem has taken as much work as it may: what was allowed, or that of some dense solves. */
PetscBool ActiveSetSpent(ActiveSet p)
{
  const PetscReal columns = (PetscReal)p->m;

  return (PetscBool)(p->work > PetscMax(p->allowed, p->solves * columns * columns * columns / 3));
}

/* Finds the set that the excess at hand leads to, and says whether it is another one, or friction's excess another. */
PetscBool ActiveSetFollow(ActiveSet p)
{
  const PetscInt all     = p->parts * p->n;
  PetscBool      changed = PETSC_FALSE;
  PetscReal      by[ACTIVE_SET_PARTS], negligible;

  Closing(p, p->excess, all, p->end);
  for (PetscInt i = 0; i < all; i++) p->end[i] = p->travel[i] - p->end[i];
  for (PetscInt i = 0; i < p->n; i++) {
    const PetscBool pressed = (PetscBool)(p->terms[i].opening + p->end[i] < 0);

    changed       = (PetscBool)(changed || pressed != p->pressed[i]);
    p->pressed[i] = pressed;
  }
  ActiveSetLookAtSlips(p);
  negligible = ActiveSetNegligible(p);
  for (PetscInt j = 0; j < p->m; j++)
    if (p->term[j] >= p->n && PetscAbsReal(ActiveSetExcess(p, p->term[j], by) - p->excess[j]) > negligible)
      changed = PETSC_TRUE;
  return changed;
}

/* Slope of the energy of the step without friction, at a part of the change of the excess; closing[n]: of all gaps, by
   the whole change. */
static PetscReal Slope(const ActiveSet p, const PetscReal *closing, PetscReal part)
{
  PetscReal slope = 0, start, rate;

  for (PetscInt i = 0; i < p->n; i++) {
    const PetscReal end = p->end[i] - part * closing[i];
    const PetscInt  j   = p->column[i];

    ActiveSetPressureExcess(&p->terms[i], (PetscBool)(p->terms[i].opening + end < 0), &start, &rate);
    slope += p->terms[i].area * closing[i] * ((j < 0 ? 0 : p->excess[j] + part * p->change[j]) - start - rate * end);
  }
  return slope;
}

/* The part of the change of the excess at which the energy is least. Its slope is continuous, and linear between the
   parts[] at which a gap opens or closes. */
static PetscErrorCode LeastEnergy(ActiveSet p, PetscReal *part)
{
  PetscReal *closing, *parts, low, high;
  PetscInt   first = 0, last = 1;

  PetscFunctionBeginUser;
  *part = 1;
  PetscCall(PetscMalloc2(p->n, &closing, p->n + 2, &parts));
  parts[0] = 0;
  Closing(p, p->change, p->n, closing);
  for (PetscInt i = 0; i < p->n; i++) {
    if (closing[i] != 0) parts[last] = (p->terms[i].opening + p->end[i]) / closing[i];
    if (closing[i] != 0 && parts[last] > 0 && parts[last] < 1) last++;
  }
  PetscCall(PetscSortReal(last, parts));
  parts[last] = 1;
  low         = Slope(p, closing, 0);
  high        = Slope(p, closing, 1);
  while (last > first + 1) {
    const PetscInt  middle = (first + last) / 2;
    const PetscReal slope  = Slope(p, closing, parts[middle]);

    if (slope < 0) {
      first = middle;
      low   = slope;
    } else {
      last = middle;
      high = slope;
    }
  }
  if (low < 0 && high > -ACTIVE_SET_SLOPE * low)
    *part = parts[first] - (parts[last] - parts[first]) * low / (high - low);
  PetscCall(PetscFree2(closing, parts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Norm of the difference between what the laws say of the columns' components and the excess at hand. */
static PetscReal Imbalance(ActiveSet p)
{
  PetscReal by[ACTIVE_SET_PARTS], square = 0;

  for (PetscInt j = 0; j < p->m; j++) square += PetscSqr(ActiveSetExcess(p, p->term[j], by) - p->excess[j]);
  return PetscSqrtReal(square);
}

/* Shortens the change of the excess, which has been made, until the columns are less out of balance than before, or to
   the part after which they are least so. */
static void Dampen(ActiveSet p, PetscReal before)
{
  PetscReal part = 1, best = 1, least = Imbalance(p);

  for (int k = 0; k < ACTIVE_SET_HALVINGS && !(least < before); k++) {
    PetscReal now;

    part /= 2;
    for (PetscInt j = 0; j < p->m; j++) p->excess[j] -= part * p->change[j];
    (void)ActiveSetFollow(p);
    now = Imbalance(p);
    if (!(now < least)) continue;
    least = now;
    best  = part;
  }
  for (PetscInt j = 0; j < p->m && best > part; j++) p->excess[j] += (best - part) * p->change[j];
  if (best > part) (void)ActiveSetFollow(p);
}

/* Changes the excess of all columns as Balance() has found, in a search as far as the energy falls. *changed: the set
   is another one, or the step was shortened. */
static PetscErrorCode Advance(ActiveSet p, PetscBool damped, PetscBool *changed)
{
  const PetscReal before = damped ? Imbalance(p) : 0;
  PetscReal       part   = 1;

  PetscFunctionBeginUser;
  if (p->searches) PetscCall(LeastEnergy(p, &part));
  for (PetscInt j = 0; j < p->m; j++) p->excess[j] += part * p->change[j];
  *changed = (PetscBool)(ActiveSetFollow(p) || part < 1);
  if (*changed && damped) Dampen(p, before);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Follows the sets, at most so many, until a column is missing or one set leads to itself. */
PetscErrorCode ActiveSetFollowSets(ActiveSet p, PetscInt most, PetscInt *m, PetscInt *which, PetscBool *regular,
                                   PetscBool *changed)
{
  PetscFunctionBeginUser;
  *m       = 0;
  *regular = *changed = PETSC_TRUE;
  for (PetscInt i = 0; i < most && *changed && *regular && !ActiveSetSpent(p); i++) {
    *m = ActiveSetMissing(p, which);
    if (!*m && !p->m) *m = ActiveSetMissingFriction(p, which);
    if (*m || !p->m) break;
    PetscCall(Balance(p, regular));
    if (*regular) PetscCall(Advance(p, (PetscBool)(p->damped || (p->parts > 1 && i >= ACTIVE_SET_UNDAMPED)), changed));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
