/* Which contact terms press, stick and slip at the end of a linear step, by way of shorter steps: the sets of each
   begin where that of the one before ended. */
#include "activesetimpl.h"

/* Part of the whole step that is tried first, and the least one. */
#define PATH_FIRST 0.25
#define PATH_LEAST 0.02
/* A part that has ended makes the next one so much longer, another one so much shorter. */
#define PATH_LONGER  2.0
#define PATH_SHORTER 0.5
/* Sets that are tried for a part. With a short part a few terms change, one after the other. */
#define PATH_SETS 40
/* Parts that are tried in all. Each takes a few dense solves of the size of the contact, far less than the columns. */
#define PATH_TRIES 16

/* The step ends at this part of the whole one: the sets begin with the excess at hand. */
static void EndAt(ActiveSet p, const PetscReal *whole, PetscReal part)
{
  for (PetscInt i = 0; i < p->parts * p->n; i++) p->travel[i] = part * whole[i];
  for (PetscInt i = 0; i < p->n; i++) p->sticks[i] = PETSC_FALSE;
  (void)ActiveSetFollow(p);
}

/*@
  ActiveSetFollowPath - goes to the end of the step by parts of it, where sets for the whole step repeat themselves.

  Not collective

  Input Parameter:
. p - the active set, with friction

  Output Parameters:
+ m         - number of components whose columns are missing; 0: it ended
. which     - their numbers; room for parts*n
- converged - where it ended: with a set of terms that is right

  Note:
  At the beginning of the step the law and the residual agree, and no term has an excess. Where the load turns round,
  all that slips sticks and slips back, one term after the other. A set for the whole step lets all of it slip to and
  fro. Of 3001 random bodies with four terms and a coefficient of 1.5, 51 do not end in equilibrium in this way, and 72
  do not without it.
@*/
PetscErrorCode ActiveSetFollowPath(ActiveSet p, PetscInt *m, PetscInt *which, PetscBool *converged)
{
  const PetscInt all = p->parts * p->n;
  PetscReal     *whole, *excess, part = 0, step = PATH_FIRST;
  PetscBool      regular, changed;

  PetscFunctionBeginUser;
  *m         = 0;
  *converged = PETSC_FALSE;
  PetscCall(PetscMalloc2(all, &whole, p->m, &excess));
  PetscCall(PetscArraycpy(whole, p->travel, all));
  PetscCall(PetscArrayzero(p->excess, p->m));
  PetscCall(PetscArrayzero(excess, p->m));
  for (int tried = 0; tried < PATH_TRIES && !*m && !*converged && step >= PATH_LEAST; tried++) {
    const PetscReal next = PetscMin(1, part + step);

    EndAt(p, whole, next);
    PetscCall(ActiveSetFollowSets(p, PATH_SETS, m, which, &regular, &changed));
    if (!*m && regular && !changed) {
      part = next;
      step *= PATH_LONGER;
      PetscCall(PetscArraycpy(excess, p->excess, p->m));
      *converged = (PetscBool)(part == 1);
    } else if (!*m) {
      step *= PATH_SHORTER;
      PetscCall(PetscArraycpy(p->excess, excess, p->m));
    }
  }
  PetscCall(PetscArraycpy(p->travel, whole, all));
  if (!*converged) EndAt(p, whole, 1);
  PetscCall(PetscFree2(whole, excess));
  PetscFunctionReturn(PETSC_SUCCESS);
}
