/* Which contact terms press, stick and slip at the end of a linear step, by way of shorter steps: the sets of each
   begin where those of the one before ended. */
#include "activesetimpl.h"

/* Part of the whole step that is tried first, and the least one. */
#define PATH_FIRST 0.25
#define PATH_LEAST 0.02
/* A part that has ended makes the next one so much longer, another one so much shorter. */
#define PATH_LONGER  2.0
#define PATH_SHORTER 0.5
/* Sets that are tried for a part. With a short part a few terms change, one after the other. */
#define PATH_SETS 20
/* Parts that are tried in all. Each takes a few dense solves of the size of the contact, far less than the columns. */
#define PATH_TRIES 24

/* The step ends at a part of the whole one: the sets begin with the excess at hand, and with no memory of slips. */
static void EndAt(ActiveSet p, PetscReal part)
{
  for (PetscInt i = 0; i < p->parts * p->n; i++) p->travel[i] = part * p->whole[i];
  for (PetscInt i = 0; i < p->n; i++) p->slipped[i] = p->sticks[i] = PETSC_FALSE;
  p->part = part;
  (void)ActiveSetFollow(p);
}

/* Begins the way where the step begins. There laws and residual agree, and no term has an excess. */
static PetscErrorCode Begin(ActiveSet p)
{
  const PetscInt all = p->parts * p->n;

  PetscFunctionBeginUser;
  if (!p->whole) {
    PetscCall(PetscMalloc1(all, &p->whole));
    PetscCall(PetscArraycpy(p->whole, p->travel, all));
  }
  p->reached = 0;
  p->stride  = PATH_FIRST;
  p->m_kept  = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Goes on from the part that was reached, as far as that can be done, or until columns are missing. */
static PetscErrorCode Go(ActiveSet p, PetscInt *m, PetscInt *which)
{
  PetscBool regular, changed;

  PetscFunctionBeginUser;
  *m = 0;
  while (p->tries < PATH_TRIES && p->reached < 1 && p->stride >= PATH_LEAST && !ActiveSetSpent(p)) {
    const PetscReal next = PetscMin(1, p->reached + p->stride);

    PetscCall(PetscArraycpy(p->excess, p->kept, p->m));
    EndAt(p, next);
    PetscCall(ActiveSetFollowSets(p, PATH_SETS, m, which, &regular, &changed));
    if (*m) break;
    p->tries++;
    p->stride *= regular && !changed ? PATH_LONGER : PATH_SHORTER;
    if (!regular || changed) continue;
    p->reached = next;
    PetscCall(PetscArraycpy(p->kept, p->excess, p->m));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ActiveSetFollowPath - goes towards the end of the step by parts of it, where sets for the whole step repeat
themselves.

  Not collective

  Input Parameter:
. p - the active set, with friction; it goes on where columns were missing

  Output Parameters:
+ m     - number of components whose columns are missing; 0: it ended
. which - their numbers; room for parts*n
- ended - where it ended: with a set that is right at the end of the step or of a part of it, which is p->part

  Notes:
  A linear step may have no end with friction, or several, and a state on the way there where what slips goes on by
  itself. A part of the step up to that state lowers the residual as far, and Newton's method goes on from there with
  the tangent of what presses, sticks and slips then.

  Source: Ralph, Global convergence of damped Newton's method for nonsmooth equations via the path search, Math. Oper.
  Res. 19 (1994) 352-389.
@*/
PetscErrorCode ActiveSetFollowPath(ActiveSet p, PetscInt *m, PetscInt *which, PetscBool *ended)
{
  PetscFunctionBeginUser;
  if (!p->on_path) PetscCall(Begin(p));
  p->on_path = PETSC_TRUE;
  *ended     = PETSC_FALSE;
  PetscCall(PetscRealloc(p->m * sizeof(PetscReal), &p->kept));
  PetscCall(PetscArrayzero(&p->kept[p->m_kept], p->m - p->m_kept));
  p->m_kept = p->m;
  PetscCall(Go(p, m, which));
  if (*m) PetscFunctionReturn(PETSC_SUCCESS);
  *ended = (PetscBool)(p->reached >= PATH_LEAST);
  PetscCall(PetscArraycpy(p->excess, p->kept, p->m));
  EndAt(p, *ended ? p->reached : 1);
  p->on_path   = PETSC_FALSE;
  p->left_path = (PetscBool) !*ended;
  PetscFunctionReturn(PETSC_SUCCESS);
}
