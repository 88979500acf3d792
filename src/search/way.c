/* How far slave points and facets may move against each other while lists stand still, see way.h. */
#include "way.h"

/* The way of the bodies before tells of the way ahead as long as this is at most so many times as long. Lists are made
   for one and a half times the motion that is expected, and a step may be twice as long as the one before it. */
#define WAY_AHEAD 3

/* May lists follow from the way of the bodies? The nodes of a rigid tool that is the master are not followed, nor is
   what prescribes the motion of a tool whose edges are slave points. */
static PetscBool FollowsWay(ContactSearch s)
{
  return (PetscBool)(s->before.u && s->master && !s->master->rigid && !s->tool && !s->slaves->surface->ridge.n);
}

/*@
  SearchSetBefore - says from where the bodies came to the state of the next lists, so that these hold only what can
  come near a slave point if all of them go on in this way.

  Not collective

  Input Parameters:
+ s     - the search
. u     - local displacements u[mesh n_nodes*dim] before (length), ghosts included; borrowed, read by each search; NULL:
          nothing is known
. t     - load parameter before
. size  - largest displacement of a node since (length), over all ranks
- aside - by so much prescribed displacements leave this way (length), over all ranks

  Note:
  A search at the end of the way sees every facet that a slave point may have met on it: where both met, the facet is
  not farther away than they have moved against each other.
@*/
void SearchSetBefore(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal size, PetscReal aside)
{
  s->before = (SearchBefore){.u = u, .t = t, .size = size, .aside = aside};
}

/*@
  SearchLeavesWay - says whether prescribed displacements leave the way before by more than the reach. Lists that were
  made without them then serve no more.

  Not collective, the same on all ranks

  Input Parameter:
. s - the search
@*/
PetscBool SearchLeavesWay(ContactSearch s)
{
  return (PetscBool)(FollowsWay(s) && s->before.aside > s->reach);
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
  The slave points stand at (u, t) afterwards. A motion that is less than the reach counts for all facets: lists are
  hardly longer for it.
@*/
PetscErrorCode WayBegin(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal motion)
{
  SearchBefore *before = &s->before;
  const int     dim    = s->mesh->dim;

  PetscFunctionBeginUser;
  before->motion = motion;
  before->ahead  = before->size > 0 ? motion / before->size : PETSC_INFINITY;
  before->known  = (PetscBool)(FollowsWay(s) && motion > s->reach && before->ahead <= WAY_AHEAD);
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
  WayOf - returns how far a slave point and facets may move against each other.

  Not collective

  Input Parameters:
+ s - the search, between WayBegin() and WayEnd()
- q - the slave point
@*/
BoxTreeWay WayOf(ContactSearch s, PetscInt q)
{
  const SearchBefore *before = &s->before;

  return (BoxTreeWay){before->known ? &before->way[q * s->mesh->dim] : NULL, before->ahead, before->aside,
                      before->motion};
}

/*@
  WayApproach - returns how far the slave point and a candidate may move against each other while lists stand still
  (length).

  Not collective

  Input Parameters:
+ look - the slave point
- c    - the candidate
@*/
PetscReal WayApproach(const Nearest *look, const Candidate *c)
{
  return BoxTreeWayOn(look->lists->dim, &look->way, c->way_lower, c->way_upper);
}
