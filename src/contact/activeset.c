/* Which contact terms press at the end of a linear step: Newton's method on the step's own contact problem. */
#include "activesetimpl.h"

/* Most active sets that are tried with the columns that are known. Each set follows from the gaps of the one before.
   Sets that have not converged by then repeat themselves. */
#define ACTIVE_SET_MAX_SETS 30

/* With friction sets that repeat themselves are left for relaxation: so many rounds of so many sweeps, after each of
   which this number of sets is tried. */
#define ACTIVE_SET_RELAX_ROUNDS 4
#define ACTIVE_SET_RELAX_SWEEPS 200
#define ACTIVE_SET_RELAX_SETS   10

/* Most steps of the search that follows then. Each lowers the energy, and a set does not come twice. */
#define ACTIVE_SET_MAX_SEARCHES 100

/* A slope of the energy is zero if it is this part of that where the search begins. */
#define ACTIVE_SET_SLOPE 1e-9

/* Slip of a term along a tangent at the end, elastic slip where the step begins included. */
static PetscReal EndSlip(const ActiveSet p, PetscInt i, PetscInt a)
{
  return p->terms[i].friction.law.slip[a] + (a + 1 < p->parts ? p->end[(a + 1) * p->n + i] : 0);
}

/* Finds terms whose slip has turned round since they were looked at last. In a set each slips on in its direction, and
   the next set would turn it round again. Between the two it sticks. */
static void LookAtSlips(ActiveSet p)
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

/* Makes room for friction, and looks at the slips of the step as it is. */
static PetscErrorCode BeginFriction(ActiveSet p)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(p->n, &p->slipped, p->n, &p->sticks, 2 * p->n, &p->slip));
  for (PetscInt i = 0; i < p->n; i++) {
    const ActiveSetFriction *friction  = &p->terms[i].friction;
    PetscReal                stiffness = 0;

    for (int a = 0; a < p->parts - 1; a++) stiffness += friction->by_slip[a][a];
    for (int a = 0; a < 2; a++) p->slip[2 * i + a] = friction->law.slip[a];
    /* What slips has the stiffness of what sticks across its slip at most. */
    p->slipped[i] = (PetscBool)(p->terms[i].stiffness > 0 && stiffness < (p->parts - 1.5) * friction->law.stiffness);
  }
  LookAtSlips(p);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ActiveSetCreate - begins with the terms that the step as it is would press.

  Not collective

  Input Parameters:
+ n      - number of terms
. parts  - components of a term: 1, with friction 2 or 3
. most   - number of columns that friction may not exceed
. terms  - their state where the step begins; copied
- travel - by how much the step opens the gaps and slides the terms along their tangents, travel[parts*n] (length);
           copied

  Output Parameter:
. out - the active set
@*/
PetscErrorCode ActiveSetCreate(PetscInt n, PetscInt parts, PetscInt most, const ActiveSetTerm *terms,
                               const PetscReal *travel, ActiveSet *out)
{
  ActiveSet p;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&p));
  p->n     = n;
  p->parts = parts;
  p->most  = most;
  PetscCall(
    PetscMalloc5(n, &p->terms, parts * n, &p->travel, parts * n, &p->end, n, &p->pressed, parts * n, &p->column));
  PetscCall(PetscArraycpy(p->terms, terms, n));
  PetscCall(PetscArraycpy(p->travel, travel, parts * n));
  PetscCall(PetscArraycpy(p->end, travel, parts * n));
  for (PetscInt i = 0; i < n; i++) p->pressed[i] = (PetscBool)(terms[i].opening + travel[i] < 0);
  for (PetscInt i = 0; i < parts * n; i++) p->column[i] = -1;
  if (parts > 1) PetscCall(BeginFriction(p));
  *out = p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ActiveSetDestroy - frees an active set.

  Not collective

  Input Parameter:
. pressing - the active set; set to NULL
@*/
PetscErrorCode ActiveSetDestroy(ActiveSet *pressing)
{
  ActiveSet p = *pressing;

  PetscFunctionBeginUser;
  if (!p) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree5(p->terms, p->travel, p->end, p->pressed, p->column));
  PetscCall(PetscFree3(p->slipped, p->sticks, p->slip));
  PetscCall(PetscFree(p->term));
  PetscCall(PetscFree(p->G));
  PetscCall(PetscFree(p->excess));
  PetscCall(PetscFree(p->change));
  PetscCall(PetscFree(*pressing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ActiveSetAddColumns - adds the columns of some terms.

  Not collective

  Input Parameters:
+ p     - the active set
. m     - number of components
. which - their numbers, which[m]
- G     - G[m][parts*n]: by how much an excess of 1 of a component closes all gaps, and slides all terms back
@*/
PetscErrorCode ActiveSetAddColumns(ActiveSet p, PetscInt m, const PetscInt *which, const PetscReal *G)
{
  const PetscInt all = p->parts * p->n;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((p->m + m) * sizeof(PetscInt), &p->term));
  PetscCall(PetscRealloc((p->m + m) * sizeof(PetscReal), &p->excess));
  PetscCall(PetscRealloc((p->m + m) * sizeof(PetscReal), &p->change));
  PetscCall(PetscRealloc((p->m + m) * all * sizeof(PetscReal), &p->G));
  PetscCall(PetscArraycpy(&p->G[p->m * all], G, m * all));
  for (PetscInt k = 0; k < m; k++) {
    p->column[which[k]] = p->m;
    p->excess[p->m]     = 0;
    p->term[p->m++]     = which[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Terms of the set at hand that need a column and have none. */
static PetscInt Missing(ActiveSet p, PetscInt *which)
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
static PetscInt MissingFriction(ActiveSet p, PetscInt *which)
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
  for (PetscInt i = 0; i < k; i++) {
    for (PetscInt l = 0; l < k; l++)
      a[l * k + i] = (l == i) + Influence(p, unknown[i], &by[ACTIVE_SET_PARTS * i], unknown[l]);
    for (PetscInt l = 0; l < p->m; l++)
      if (p->change[l] != 0) b[i] -= p->change[l] * Influence(p, unknown[i], &by[ACTIVE_SET_PARTS * i], l);
  }
  PetscCall(DenseSolve(k, a, b, regular));
  for (PetscInt i = 0; i < k; i++) p->change[unknown[i]] = b[i];
  PetscCall(PetscFree2(a, b));
  PetscCall(PetscFree(by));
  PetscCall(PetscFree(unknown));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* By how much an excess[m] of all columns closes a gap, or slides a term back. */
static PetscReal Closing(const ActiveSet p, const PetscReal *excess, PetscInt component)
{
  PetscReal closing = 0;

  for (PetscInt j = 0; j < p->m; j++) closing += p->G[j * p->parts * p->n + component] * excess[j];
  return closing;
}

/* Finds the set that the excess at hand leads to, and says whether it is another one, or friction's excess another. */
static PetscBool Follow(ActiveSet p)
{
  const PetscInt all     = p->parts * p->n;
  PetscBool      changed = PETSC_FALSE;
  PetscReal      by[ACTIVE_SET_PARTS], negligible;

  for (PetscInt i = 0; i < all; i++) p->end[i] = p->travel[i] - Closing(p, p->excess, i);
  for (PetscInt i = 0; i < p->n; i++) {
    const PetscBool pressed = (PetscBool)(p->terms[i].opening + p->end[i] < 0);

    changed       = (PetscBool)(changed || pressed != p->pressed[i]);
    p->pressed[i] = pressed;
  }
  LookAtSlips(p);
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
static PetscErrorCode LeastEnergy(const ActiveSet p, PetscReal *part)
{
  PetscReal *closing, *parts, low, high;
  PetscInt   first = 0, last = 1;

  PetscFunctionBeginUser;
  *part = 1;
  PetscCall(PetscMalloc2(p->n, &closing, p->n + 2, &parts));
  parts[0] = 0;
  for (PetscInt i = 0; i < p->n; i++) {
    closing[i] = Closing(p, p->change, i);
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

/* Changes the excess of all columns as Balance() has found, in a search as far as the energy falls. *changed: the set
   is another one, or the step was shortened. */
static PetscErrorCode Advance(ActiveSet p, PetscBool *changed)
{
  PetscReal part = 1;

  PetscFunctionBeginUser;
  if (p->searches) PetscCall(LeastEnergy(p, &part));
  for (PetscInt j = 0; j < p->m; j++) p->excess[j] += part * p->change[j];
  *changed = (PetscBool)(Follow(p) || part < 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Follows the sets, at most so many, until a column is missing or one set leads to itself. */
static PetscErrorCode FollowSets(ActiveSet p, PetscInt most, PetscInt *m, PetscInt *which, PetscBool *regular,
                                 PetscBool *changed)
{
  PetscFunctionBeginUser;
  *regular = *changed = PETSC_TRUE;
  for (PetscInt i = 0; i < most && *changed && *regular; i++) {
    *m = Missing(p, which);
    if (!*m && !p->m) *m = MissingFriction(p, which);
    if (*m || !p->m) break;
    PetscCall(Balance(p, regular));
    if (*regular) PetscCall(Advance(p, changed));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After sets with friction that have repeated themselves: relaxes the terms, and follows the sets from where that leads
   to. *converged as ActiveSetSolve() says. */
static PetscErrorCode Relax(ActiveSet p, PetscInt *m, PetscInt *which, PetscBool *converged)
{
  PetscBool settled = PETSC_FALSE, regular, changed;

  PetscFunctionBeginUser;
  for (PetscInt round = 0; round < ACTIVE_SET_RELAX_ROUNDS && !*m && !*converged; round++) {
    PetscCall(ActiveSetRelax(p, ACTIVE_SET_RELAX_SWEEPS, &settled));
    LookAtSlips(p);
    *m = Missing(p, which);
    if (!*m) *m = MissingFriction(p, which);
    if (*m) break;
    if (settled) {
      *converged = PETSC_TRUE;
      break;
    }
    PetscCall(FollowSets(p, ACTIVE_SET_RELAX_SETS, m, which, &regular, &changed));
    *converged = (PetscBool)(!*m && regular && !changed);
    for (PetscInt i = 0; i < p->n; i++) p->sticks[i] = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After sets that have repeated themselves: searches from where they have led to; with friction begins again with the
   friction that residual and tangent have. */
static PetscErrorCode ChangeWay(ActiveSet p)
{
  PetscFunctionBeginUser;
  if (p->parts == 1)
    p->searches = PETSC_TRUE;
  else {
    p->plain = PETSC_TRUE;
    PetscCall(PetscArrayzero(p->excess, p->m));
    Follow(p);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ActiveSetLeaveRelaxation - says that sets with friction that repeat themselves are not to be relaxed.

  Not collective

  Input Parameter:
. p - the active set
@*/
void ActiveSetLeaveRelaxation(ActiveSet p)
{
  p->unrelaxed = PETSC_TRUE;
}

/*@
  ActiveSetSolve - goes on with the contact problem of the step as far as the columns at hand allow.

  Not collective

  Input Parameter:
. p - the active set

  Output Parameters:
+ m         - number of components whose columns are missing; 0: it ended
. which     - their numbers; room for parts*n
- converged - where it ended: with a set of terms that is right

  Notes:
  Where friction keeps it from an end, it is solved with the friction that residual and tangent have. Without friction
  sets may repeat themselves where bodies bend, because a force at one place opens gaps at others. Each step then ends
  where the energy is least along it, which always comes to an end if the tangent is positive definite.

  Newton's method is here that of active sets. Sources: Josephy, Newton's method for generalized equations, 1979 (the
  problem linearised except for its contact conditions); Hintermueller, Ito, Kunisch, The primal-dual active set
  strategy as a semismooth Newton method, SIAM J. Optim. 13 (2003) 865-888; Sun, On piecewise quadratic Newton and
  trust region problems, Math. Program. 76 (1997) 451-467 (the search ends); Alart, Curnier, A mixed formulation for
  frictional contact problems prone to Newton like solution methods, CMAME 92 (1991) 353-375.
@*/
PetscErrorCode ActiveSetSolve(ActiveSet p, PetscInt *m, PetscInt *which, PetscBool *converged)
{
  PetscBool regular, changed;

  PetscFunctionBeginUser;
  do {
    const PetscInt most = p->searches ? ACTIVE_SET_MAX_SEARCHES : ACTIVE_SET_MAX_SETS;

    PetscCall(FollowSets(p, most, m, which, &regular, &changed));
    *converged = (PetscBool)(!*m && (!p->m || (regular && !changed)));
    if (*m || !p->m) PetscFunctionReturn(PETSC_SUCCESS);
    for (PetscInt i = 0; i < p->n && p->parts > 1; i++) p->sticks[i] = PETSC_FALSE;
    if (regular) *m = MissingFriction(p, which);
    if (!*m && !*converged && p->parts > 1 && !p->unrelaxed) PetscCall(Relax(p, m, which, converged));
    if (*m || *converged || p->plain || (p->parts == 1 && (p->searches || !regular)))
      PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(ChangeWay(p));
  } while (PETSC_TRUE);
}

/*@
  ActiveSetRest - finds all components that have no column.

  Not collective

  Input Parameter:
. p - the active set

  Output Parameters:
+ m     - number of them
- which - their numbers; room for parts*n
@*/
void ActiveSetRest(ActiveSet p, PetscInt *m, PetscInt *which)
{
  *m = 0;
  for (PetscInt i = 0; i < p->parts * p->n; i++)
    if (p->column[i] < 0) which[(*m)++] = i;
}

/* Sorts terms by depth where the step ends, the deepest first. */
static int CompareDepth(const void *a, const void *b, void *context)
{
  const ActiveSet p = (ActiveSet)context;
  const PetscInt  i = *(const PetscInt *)a, j = *(const PetscInt *)b;
  const PetscReal left = p->terms[i].opening + p->end[i], right = p->terms[j].opening + p->end[j];

  if (left != right) return left < right ? -1 : 1;
  return i < j ? -1 : 1;
}

/*@
  ActiveSetLimit - takes terms out of the set again that the step has pressed, so that fewer columns are missing.

  Not collective

  Input Parameters:
+ p    - the active set, after ActiveSetSolve()
- most - number of columns that may be missing

  Input/Output Parameters:
+ m     - number of terms whose columns are missing
- which - their numbers

  Note:
  The deepest ones stay. Those that are still pressed with them come back. A body that is held in one point goes so far
  in a linear step that it presses nearly all terms; few of them bear it.
@*/
PetscErrorCode ActiveSetLimit(ActiveSet p, PetscInt most, PetscInt *m, PetscInt *which)
{
  PetscInt first = 0;

  PetscFunctionBeginUser;
  if (*m <= most) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < *m; k++) { /* terms that residual and tangent press have no choice */
    const PetscInt i = which[k];

    if (p->terms[i].pressure == 0 && p->terms[i].stiffness == 0) continue;
    which[k]       = which[first];
    which[first++] = i;
  }
  if (first >= most) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscTimSort(*m - first, &which[first], sizeof(PetscInt), CompareDepth, p));
  for (PetscInt k = most; k < *m; k++) p->pressed[which[k]] = PETSC_FALSE;
  *m = most;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ActiveSetGet - gets the result.

  Not collective

  Input Parameter:
. p - the active set

  Output Parameters:
+ excess  - for each column the excess of its component: the pressure or traction in residual and tangent, less the
            law's; belongs to the object
- pressed - which terms press at the end, pressed[n]; belongs to the object
@*/
void ActiveSetGet(ActiveSet p, const PetscReal **excess, const PetscBool **pressed)
{
  *excess  = p->excess;
  *pressed = p->pressed;
}
