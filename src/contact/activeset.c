/* Which contact terms press at the end of a linear step: Newton's method on the step's own contact problem. */
#include "activesetimpl.h"

/* Most active sets that are tried with the columns that are known. Each set follows from the gaps of the one before.
   Sets that have not converged by then repeat themselves. */
#define ACTIVE_SET_MAX_SETS 30

/* With friction sets that repeat themselves are left for so many damped ones from where the step begins. Then follows
   relaxation: so many rounds of so many sweeps, after each of which this number of sets is tried. */
#define ACTIVE_SET_DAMPED       20
#define ACTIVE_SET_RELAX_ROUNDS 4
#define ACTIVE_SET_RELAX_SWEEPS 200
#define ACTIVE_SET_RELAX_SETS   10

/* Most steps of the search that follows then. Each lowers the energy, and a set does not come twice. */
#define ACTIVE_SET_MAX_SEARCHES 100

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
    p->slipped[i] = (PetscBool)((p->terms[i].stiffness > 0 || friction->law.fluid > 0) &&
                                stiffness < (p->parts - 1.5) * friction->law.stiffness);
  }
  ActiveSetLookAtSlips(p);
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
  p->n       = n;
  p->parts   = parts;
  p->most    = most;
  p->allowed = PETSC_MAX_REAL;
  p->enough  = PETSC_MAX_REAL;
  PetscCall(
    PetscMalloc5(n, &p->terms, parts * n, &p->travel, parts * n, &p->end, n, &p->pressed, parts * n, &p->column));
  PetscCall(PetscArraycpy(p->terms, terms, n));
  PetscCall(PetscArraycpy(p->travel, travel, parts * n));
  PetscCall(PetscArraycpy(p->end, travel, parts * n));
  for (PetscInt i = 0; i < n; i++) p->pressed[i] = (PetscBool)(terms[i].opening + travel[i] < 0);
  for (PetscInt i = 0; i < parts * n; i++) p->column[i] = -1;
  if (parts > 1) PetscCall(BeginFriction(p));
  p->part = 1;
  *out    = p;
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
  PetscCall(PetscFree(p->whole));
  PetscCall(PetscFree(p->kept));
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

/* Follows damped sets from the step as it is: it was rounding that chose where undamped ones have wandered to.
 *converged as ActiveSetSolve() says. */
static PetscErrorCode BeginAgain(ActiveSet p, PetscInt *m, PetscInt *which, PetscBool *converged)
{
  PetscBool regular, changed;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(p->excess, p->m));
  (void)ActiveSetFollow(p);
  for (PetscInt i = 0; i < p->n; i++) p->slipped[i] = p->sticks[i] = PETSC_FALSE;
  p->damped = PETSC_TRUE;
  PetscCall(ActiveSetFollowSets(p, ACTIVE_SET_DAMPED, m, which, &regular, &changed));
  p->damped  = PETSC_FALSE;
  *converged = (PetscBool)(!*m && regular && !changed);
  for (PetscInt i = 0; i < p->n; i++) p->sticks[i] = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After damped sets that have repeated themselves: relaxes the terms, and follows the sets from where that leads to.
 *converged as ActiveSetSolve() says. */
static PetscErrorCode Relax(ActiveSet p, PetscInt *m, PetscInt *which, PetscBool *converged)
{
  PetscBool settled = PETSC_FALSE, regular, changed;

  PetscFunctionBeginUser;
  for (PetscInt round = 0; round < ACTIVE_SET_RELAX_ROUNDS && !*m && !*converged && !ActiveSetSpent(p); round++) {
    PetscCall(ActiveSetRelax(p, ACTIVE_SET_RELAX_SWEEPS, &settled));
    ActiveSetLookAtSlips(p);
    *m = ActiveSetMissing(p, which);
    if (!*m) *m = ActiveSetMissingFriction(p, which);
    if (*m) break;
    if (settled) {
      *converged = PETSC_TRUE;
      break;
    }
    PetscCall(ActiveSetFollowSets(p, ACTIVE_SET_RELAX_SETS, m, which, &regular, &changed));
    *converged = (PetscBool)(!*m && regular && !changed);
    for (PetscInt i = 0; i < p->n; i++) p->sticks[i] = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After sets with friction that have repeated themselves: tries damped ones, then relaxation. */
static PetscErrorCode LeaveCycle(ActiveSet p, PetscInt *m, PetscInt *which, PetscBool *converged)
{
  PetscFunctionBeginUser;
  PetscCall(BeginAgain(p, m, which, converged));
  if (!*m && !*converged) PetscCall(Relax(p, m, which, converged));
  if (!*m && *converged) *m = ActiveSetMissingFriction(p, which);
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
    (void)ActiveSetFollow(p);
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
  ActiveSetBound - bounds the work that is done before the problem is left unsolved.

  Not collective

  Input Parameters:
+ p       - the active set
. allowed - products of two numbers
- solves  - dense solves with all columns at hand, if that is more

  Note:
  The bound is looked at after each dense solve and after each sweep of relaxation, so that it is passed by one of them
  at most.
@*/
void ActiveSetBound(ActiveSet p, PetscReal allowed, PetscReal solves)
{
  p->allowed = allowed;
  p->solves  = solves;
}

/*@
  ActiveSetEnough - says what force may be left out of balance by friction.

  Not collective

  Input Parameters:
+ p     - the active set
- force - norm of the forces of all terms

  Note:
  It is shared by all terms as if they had the largest area of one of them.
@*/
void ActiveSetEnough(ActiveSet p, PetscReal force)
{
  PetscReal area = 0;

  for (PetscInt i = 0; i < p->n; i++) area = PetscMax(area, p->terms[i].area);
  if (area > 0) p->enough = force / (area * PetscSqrtReal((PetscReal)p->n));
}

/*@
  ActiveSetAllowPart - says that with friction the step may end at a part of itself.

  Not collective

  Input Parameter:
. p - the active set
@*/
void ActiveSetAllowPart(ActiveSet p)
{
  p->partial = (PetscBool)(p->parts > 1);
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
  Where friction keeps it from an end, the step is gone by parts of it, if it may end at one; where that leads nowhere,
  it is solved with the friction that residual and tangent have. Without friction sets may repeat themselves where
  bodies bend, because a force at one place opens gaps at others. Each step then ends where the energy is least along
  it, which always comes to an end if the tangent is positive definite.

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
    const PetscInt most = p->searches    ? ACTIVE_SET_MAX_SEARCHES
                          : p->parts > 1 ? ACTIVE_SET_UNDAMPED
                                         : ACTIVE_SET_MAX_SETS;

    if (!p->on_path) {
      PetscCall(ActiveSetFollowSets(p, most, m, which, &regular, &changed));
      *converged = (PetscBool)(!*m && (!p->m || (regular && !changed)));
      if (*m || !p->m) PetscFunctionReturn(PETSC_SUCCESS);
      for (PetscInt i = 0; i < p->n && p->parts > 1; i++) p->sticks[i] = PETSC_FALSE;
      if (regular) *m = ActiveSetMissingFriction(p, which);
      if (!*m && !*converged && p->parts > 1 && !p->unrelaxed) PetscCall(LeaveCycle(p, m, which, converged));
    }
    if (p->on_path || (!*m && !*converged && p->partial && !p->left_path)) {
      PetscCall(ActiveSetFollowPath(p, m, which, converged));
      if (*converged) *m = ActiveSetMissingFriction(p, which);
    }
    if (*m || *converged || p->plain || ActiveSetSpent(p) || (p->parts == 1 && (p->searches || !regular)))
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
+ m     - number of components whose columns are missing
- which - their numbers

  Note:
  Missing components are all pressures of terms, or all of friction, of which none is taken out. The deepest
  terms stay. Those that are still pressed with them come back. A body that is held in one point goes so far in a
  linear step that it presses nearly all terms; few of them bear it.
@*/
PetscErrorCode ActiveSetLimit(ActiveSet p, PetscInt most, PetscInt *m, PetscInt *which)
{
  PetscInt first = 0;

  PetscFunctionBeginUser;
  if (*m <= most || which[0] >= p->n) PetscFunctionReturn(PETSC_SUCCESS);
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
. pressed - which terms press at the end, pressed[n]; belongs to the object
- part    - of the step, at which it ends; 1 unless ActiveSetAllowPart() was called
@*/
void ActiveSetGet(ActiveSet p, const PetscReal **excess, const PetscBool **pressed, PetscReal *part)
{
  *part    = p->part;
  *excess  = p->excess;
  *pressed = p->pressed;
}
