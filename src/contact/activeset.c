/* Which contact terms press at the end of a linear step: Newton's method on the step's own contact problem. */
#include "contact/activeset.h"

/* Most active sets that are tried with the columns that are known. Each set follows from the gaps of the one before.
   Sets that have not converged by then repeat themselves. */
#define ACTIVE_SET_MAX_SETS 30

/* Rounding of a pressure, as a part of it. */
#define ACTIVE_SET_ROUND_OFF 1e-12

struct _n_Pressing {
  PetscInt       n, m;
  ActiveSetTerm *terms;
  PetscReal     *travel, *end; /* n; end: with the excess at hand */
  PetscBool     *pressed;      /* n: the set at hand */
  PetscInt      *column;       /* n: -1: none */
  PetscInt      *term;         /* of each column */
  PetscReal     *G, *excess;   /* m*n, m */
};

/*@
  ActiveSetCreate - begins with the terms that the step as it is would press.

  Not collective

  Input Parameters:
+ n      - number of terms
. terms  - their state where the step begins; copied
- travel - by how much the step opens the gaps, travel[n] (length); copied

  Output Parameter:
. out - the active set
@*/
PetscErrorCode ActiveSetCreate(PetscInt n, const ActiveSetTerm *terms, const PetscReal *travel, ActiveSet *out)
{
  ActiveSet p;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&p));
  p->n = n;
  PetscCall(PetscMalloc5(n, &p->terms, n, &p->travel, n, &p->end, n, &p->pressed, n, &p->column));
  PetscCall(PetscArraycpy(p->terms, terms, n));
  PetscCall(PetscArraycpy(p->travel, travel, n));
  PetscCall(PetscArraycpy(p->end, travel, n));
  for (PetscInt i = 0; i < n; i++) {
    p->pressed[i] = (PetscBool)(terms[i].opening + travel[i] < 0);
    p->column[i]  = -1;
  }
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
  PetscCall(PetscFree(p->term));
  PetscCall(PetscFree(p->G));
  PetscCall(PetscFree(p->excess));
  PetscCall(PetscFree(*pressing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ActiveSetAddColumns - adds the columns of some terms.

  Not collective

  Input Parameters:
+ p     - the active set
. m     - number of terms
. which - their numbers, which[m]
- G     - G[m][n]: by how much an excess of 1 of a term closes all gaps
@*/
PetscErrorCode ActiveSetAddColumns(ActiveSet p, PetscInt m, const PetscInt *which, const PetscReal *G)
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((p->m + m) * sizeof(PetscInt), &p->term));
  PetscCall(PetscRealloc((p->m + m) * sizeof(PetscReal), &p->excess));
  PetscCall(PetscRealloc((p->m + m) * p->n * sizeof(PetscReal), &p->G));
  PetscCall(PetscArraycpy(&p->G[p->m * p->n], G, m * p->n));
  for (PetscInt k = 0; k < m; k++) {
    p->column[which[k]] = p->m;
    p->excess[p->m]     = 0;
    p->term[p->m++]     = which[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Residual and tangent give a term a pressure that is linear in its travel. The difference between this pressure and
   that of the law is start + rate * travel. Both numbers are zero where residual and tangent treat the term as the law
   does. */
static void Excess(const ActiveSetTerm *term, PetscBool pressed, PetscReal *start, PetscReal *rate)
{
  *start = term->pressure + (pressed ? term->penalty * term->opening : 0);
  *rate  = (pressed ? term->penalty : 0) - term->stiffness;
  if (PetscAbsReal(*start) <= ACTIVE_SET_ROUND_OFF * PetscAbsReal(term->pressure)) *start = 0;
}

/* Terms of the set at hand that need a column and have none. */
static PetscInt Missing(ActiveSet p, PetscInt *which)
{
  PetscInt m = 0;

  for (PetscInt i = 0; i < p->n; i++) {
    PetscReal start, rate;

    Excess(&p->terms[i], p->pressed[i], &start, &rate);
    if (p->column[i] < 0 && (start != 0 || rate != 0)) which[m++] = i;
  }
  return m;
}

/* Solves for the excess pressures e of the present set: e - rate (travel - G e) = start. *regular is PETSC_TRUE if the
   matrix is not singular. */
static PetscErrorCode Balance(ActiveSet p, PetscBool *regular)
{
  const PetscInt m = p->m;
  PetscScalar   *a, *b;
  PetscReal     *A;
  PetscErrorCode code;
  Mat            matrix;
  Vec            right, e;

  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, m, m, NULL, &matrix));
  PetscCall(MatCreateVecs(matrix, &e, &right));
  PetscCall(MatDenseGetArray(matrix, &a));
  PetscCall(VecGetArray(right, &b));
  for (PetscInt j = 0; j < m; j++) {
    PetscReal start, rate;

    Excess(&p->terms[p->term[j]], p->pressed[p->term[j]], &start, &rate);
    b[j] = start + rate * p->travel[p->term[j]];
    A    = &p->G[p->term[j]];
    for (PetscInt l = 0; l < m; l++) a[l * m + j] = (l == j) + rate * A[l * p->n];
  }
  PetscCall(VecRestoreArray(right, &b));
  PetscCall(MatDenseRestoreArray(matrix, &a));
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL)); /* to PETSc a pivot of exactly zero is an error */
  code = MatLUFactor(matrix, NULL, NULL, NULL);
  PetscCall(PetscPopErrorHandler());
  *regular = code ? PETSC_FALSE : PETSC_TRUE;
  if (*regular) {
    PetscCall(MatSolve(matrix, right, e));
    PetscCall(VecGetArray(e, &b));
    for (PetscInt j = 0; j < m; j++) {
      p->excess[j] = PetscRealPart(b[j]);
      if (PetscIsInfOrNanReal(p->excess[j])) *regular = PETSC_FALSE;
    }
    PetscCall(VecRestoreArray(e, &b));
  }
  PetscCall(MatDestroy(&matrix));
  PetscCall(VecDestroy(&right));
  PetscCall(VecDestroy(&e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the set that the excess at hand leads to, and says whether it is another one. */
static PetscBool Follow(ActiveSet p)
{
  PetscBool changed = PETSC_FALSE;

  for (PetscInt i = 0; i < p->n; i++) {
    PetscBool pressed;

    p->end[i] = p->travel[i];
    for (PetscInt j = 0; j < p->m; j++) p->end[i] -= p->G[j * p->n + i] * p->excess[j];
    pressed       = (PetscBool)(p->terms[i].opening + p->end[i] < 0);
    changed       = (PetscBool)(changed || pressed != p->pressed[i]);
    p->pressed[i] = pressed;
  }
  return changed;
}

/*@
  ActiveSetSolve - goes on with the contact problem of the step as far as the columns at hand allow.

  Not collective

  Input Parameter:
. p - the active set

  Output Parameters:
+ m         - number of terms whose columns are missing; 0: it ended
. which     - their numbers; room for n
- converged - where it ended: with a set of terms that is right

  Note:
  Newton's method is here that of active sets. Sources: Josephy, Newton's method for generalized equations, 1979 (the
  problem linearised except for its contact conditions); Hintermueller, Ito, Kunisch, The primal-dual active set
  strategy as a semismooth Newton method, SIAM J. Optim. 13 (2003) 865-888.
@*/
PetscErrorCode ActiveSetSolve(ActiveSet p, PetscInt *m, PetscInt *which, PetscBool *converged)
{
  PetscBool regular = PETSC_TRUE, changed = PETSC_TRUE;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < ACTIVE_SET_MAX_SETS && changed && regular; i++) {
    *m         = Missing(p, which);
    *converged = (PetscBool)(!*m && !p->m);
    if (*m || *converged) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(Balance(p, &regular));
    if (regular) changed = Follow(p);
  }
  *converged = (PetscBool)(regular && !changed);
  PetscFunctionReturn(PETSC_SUCCESS);
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
+ excess  - for each column its term's excess: the pressure in residual and tangent, less the law's; belongs to the
            object
- pressed - which terms press at the end, pressed[n]; belongs to the object
@*/
void ActiveSetGet(ActiveSet p, const PetscReal **excess, const PetscBool **pressed)
{
  *excess  = p->excess;
  *pressed = p->pressed;
}
