/* How far slave points and facets may move against each other while lists stand still, see way.h. */
#include "way.h"

/* The way of the bodies before tells of the way ahead as long as this is at most so many times as long. Lists are made
   for one and a half times the motion that is expected, and a step may be twice as long as the one before it. */
#define WAY_AHEAD 3

/*@
  SearchSetBefore - says from where the bodies came to the state of the next lists, so that these hold only what can
  come near a slave point if all of them go on in this way.

  Not collective

  Input Parameters:
+ s    - the search
. u    - local displacements u[mesh n_nodes*dim] before (length), ghosts included; borrowed, read by each search; NULL:
         nothing is known
. t    - load parameter before
- size - largest displacement of a node since (length), over all ranks

  Note:
  A search at the end of the way sees every facet that a slave point may have met on it: where both met, the facet is
not farther away than they have moved against each other.
@*/
void SearchSetBefore(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal size)
{
  s->before = (SearchBefore){.u = u, .t = t, .size = size};
}

/*@
  WayBegin - takes in how the slave points have moved before a search.

  Collective

  Input Parameters:
+ s      - the search
. u      - local displacements u[mesh n_nodes*dim] (length), ghosts included, of the search
. t      - its load parameter
- motion - relative motion (length) for which lists are to be good

  Note:
  The slave points stand at (u, t) afterwards. The nodes of a rigid tool that is the master are not followed.
@*/
PetscErrorCode WayBegin(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal motion)
{
  SearchBefore *before = &s->before;
  const int     dim    = s->mesh->dim;

  PetscFunctionBeginUser;
  before->ahead = before->size > 0 ? motion / before->size : PETSC_INFINITY;
  before->known = (PetscBool)(before->u && s->master && !s->master->rigid && !s->tool && before->ahead <= WAY_AHEAD);
  if (before->known) {
    PetscCall(PetscMalloc1(s->slaves->n * dim, &before->way));
    ToolsPlace(s->mesh, before->u, before->t);
    PetscCall(SlavePointsMove(s->slaves, before->u, before->t));
    for (PetscInt q = 0; q < s->slaves->n; q++) SlavePointsPosition(s->slaves, q, &before->way[q * dim]);
    ToolsPlace(s->mesh, u, t);
  }
  PetscCall(SlavePointsMove(s->slaves, u, t));
  for (PetscInt q = 0; q < s->slaves->n && before->known; q++) {
    PetscReal x[3];

    SlavePointsPosition(s->slaves, q, x);
    for (int d = 0; d < dim; d++) before->way[q * dim + d] = x[d] - before->way[q * dim + d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  WayEnd - frees what WayBegin() took in.

  Not collective

  Input Parameter:
. s - the search
@*/
PetscErrorCode WayEnd(ContactSearch s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->before.way));
  s->before.known = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  WayApproach - returns a bound for how far the slave point and a facet move against each other while lists stand still
  (length).

  Not collective

  Input Parameters:
+ look - the slave point
- c    - the facet
@*/
PetscReal WayApproach(const Nearest *look, const Candidate *c)
{
  PetscReal square = 0;

  if (!look->way) return look->motion;
  for (int d = 0; d < look->lists->dim; d++)
    square +=
      PetscSqr(PetscMax(PetscAbsReal(look->way[d] - c->way_lower[d]), PetscAbsReal(look->way[d] - c->way_upper[d])));
  return PetscMin(look->motion, look->ahead * PetscSqrtReal(square));
}

/*@
  WayNarrow - keeps of some facets those that are within reach or may come there.

  Not collective

  Input Parameters:
+ look  - the slave point
. reach - largest distance (length)
- n     - number of facets

  Input/Output Parameter:
. found - the facets; those that are kept are in the same order

  Note:
  Returns how many are kept.
@*/
int WayNarrow(const Nearest *look, PetscReal reach, int n, int *found)
{
  int kept = 0;

  if (!look->way) return n;
  for (int i = 0; i < n; i++) {
    const Candidate *c = &look->candidates[found[i]];

    if (CandidateBoxDistance(look->lists->dim, c, look->x) <= reach + WayApproach(look, c)) found[kept++] = found[i];
  }
  return kept;
}
