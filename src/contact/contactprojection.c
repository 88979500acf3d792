/* Gaps of all slave points of a pair at given displacements, and how its contact nodes move. */
#include "contactimpl.h"
#include "base/timing.h"
#include "kernels/rigidkernel.h"

/* Finds the gap of a slave point, with its first variation where `vary`. Where nothing has moved since the lists were
   made, the gap of the search's fit is taken, if it is the smoother's own; the work's points and factors are then
   those of an earlier evaluation. */
static PetscErrorCode PointGap(const ContactPair *pair, NeighbourLists lists, PetscInt q, int seed, PetscBool vary,
                               PetscBool *found)
{
  SmootherResult *result = &pair->work->result;

  PetscFunctionBeginUser;
  if (vary || !lists->made || !lists->fit_n[q] || !pair->smoother->search_gap)
    PetscCall(ContactPointEvaluate(pair, pair->smoother, lists, q, seed, vary ? SMOOTHER_FIRST_VARIATION : SMOOTHER_GAP,
                                   found));
  else {
    *found       = PETSC_TRUE;
    result->gap  = lists->gap[q];
    result->seed = seed;
    for (int d = 0; d < 3; d++) result->normal[d] = lists->normal[3 * q + d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPointGaps - finds the gaps of all slave points of this rank, at the positions of the lists' last update.

  Not collective

  Input Parameters:
+ pair   - the pair
. lists  - the lists, in force or next
. factor - area factors; points of factor 0 are not asked for
- force  - forces of the previous projection, or NULL; a point with one will most likely have one again, so that its
           first variation is kept at once; the lists must be those in force

  Input/Output Parameter:
. seed - facets of the previous projection, rewritten; or NULL

  Output Parameters:
+ gap     - gaps (length), NaN where there is none
- normals - three components for each point, out of the master at the foot; or NULL
@*/
PetscErrorCode ContactPointGaps(const ContactPair *pair, NeighbourLists lists, const PetscReal *factor,
                                const PetscReal *force, int *seed, PetscReal *gap, PetscReal *normals)
{
  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < lists->n_slaves; q++) {
    const PetscBool vary  = (PetscBool)(force && force[q] != 0 && factor[q] > 0);
    PetscBool       found = PETSC_FALSE;

    if (factor[q] > 0) PetscCall(PointGap(pair, lists, q, seed ? seed[q] : -1, vary, &found));
    if (vary) PetscCall(ContactVariationsKeep(pair, q, found));
    gap[q] = found ? pair->work->result.gap : NAN;
    if (found && seed) seed[q] = pair->work->result.seed;
    for (int d = 0; normals && d < 3; d++)
      normals[3 * q + d] = found && d < lists->dim ? pair->work->result.normal[d] : 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairProject - moves the points of a pair's lists to (u, t) and projects every slave point.

  Collective

  Input Parameters:
+ contact - the contact
. pair    - the pair
. u       - local displacements, u[n_nodes*dim] (length)
- t       - load parameter

  Note:
  Nothing is done where the last projection was at the same place. This is so three times in four, as the solver asks
  for residual, energy and tangent of each iterate one by one.
@*/
PetscErrorCode ContactPairProject(Contact contact, ContactPair *pair, const PetscReal *u, PetscReal t)
{
  PetscBool moved;

  PetscFunctionBeginUser;
  PetscCall(NeighbourListsUpdate(pair->search, pair->lists, u, t, &moved));
  if (moved) pair->fresh = PETSC_FALSE;
  if (pair->projected && !moved) PetscFunctionReturn(PETSC_SUCCESS);
  pair->projected = PETSC_TRUE;
  ContactVariationsReset(pair->variations);
  if (pair->friction) PetscCall(FrictionForget(pair));
  PetscCall(PetscLogEventBegin(contact->event_project, 0, 0, 0, 0));
  if (pair->fit.fitted) TimingBegin(TIMING_FIT);
  if (pair->fit.fitted) PetscCall(PetscLogEventBegin(contact->event_fit, 0, 0, 0, 0));
  PetscCall(ContactPointGaps(pair, pair->lists, pair->factor, pair->point_force, pair->seed, pair->point_gap,
                             pair->point_normal));
  if (pair->fit.fitted) PetscCall(PetscLogEventEnd(contact->event_fit, 0, 0, 0, 0));
  if (pair->fit.fitted) TimingEnd(TIMING_FIT);
  PetscCall(PetscLogEventEnd(contact->event_project, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An analytic master that moves has the same effect as slave nodes that move against it: each less what moves with the
   tool at its place, to first order. */
static void AnalyticTravel(Contact contact, const ContactPair *pair, PetscReal t, PetscReal t_next, PetscReal *values)
{
  const Motion        *motion = &pair->scene->motion;
  const NeighbourLists lists  = pair->lists;
  const int            dim    = contact->mesh->dim;
  PetscReal            from[MOTION_COMPONENTS], to[MOTION_COMPONENTS], point[3];
  double               rate[3][3], spin[3] = {0, 0, 0};

  MotionComponents(motion, t, from);
  MotionComponents(motion, t_next, to);
  MotionPlace(motion, t, motion->point, point);
  RigidTurnRate(&from[3], rate);
  for (int k = 0; k < 3; k++)
    for (int d = 0; d < 3; d++) spin[d] += rate[k][d] * (to[3 + k] - from[3 + k]);
  for (PetscInt i = 0; i < lists->n_nodes; i++) {
    PetscReal arm[3] = {0, 0, 0};

    for (int d = 0; d < dim; d++)
      arm[d] = lists->X[i * dim + d] + lists->u[i * dim + d] + contact->mesh->centre[d] - point[d];
    for (int d = 0; d < dim; d++) {
      const int e = (d + 1) % 3, g = (d + 2) % 3;

      values[i * dim + d] -= to[d] - from[d] + spin[e] * arm[g] - spin[g] * arm[e];
    }
  }
}

/*@
  ContactPairMove - computes how the contact nodes of a pair move with local displacements, with tools and an analytic
  master.

  Collective

  Input Parameters:
+ contact - the contact
. pair    - the pair
. x       - local displacements, x[n_nodes*dim] (length)
. t       - load parameter where the motion of tools begins
- t_next  - load parameter where it ends

  Output Parameter:
. values - values[contact nodes*dim] (length)
@*/
PetscErrorCode ContactPairMove(Contact contact, ContactPair *pair, const PetscReal *x, PetscReal t, PetscReal t_next,
                               PetscReal *values)
{
  PetscFunctionBeginUser;
  PetscCall(NeighbourListsBroadcast(pair->search, pair->lists, x, t, t_next, values));
  if (!pair->master && !pair->tool && t != t_next) AnalyticTravel(contact, pair, t, t_next, values);
  PetscFunctionReturn(PETSC_SUCCESS);
}
