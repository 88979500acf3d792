/* Gaps of all slave points of a pair at given displacements, and how its contact nodes move. */
#include "contactimpl.h"
#include "base/timing.h"

/* The gap of a slave point, with its first variation where `vary`; where nothing has moved since its fit was made, that
 * tells it. */
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
    result->gap  = lists->gap[q]; /* facet_served, points and factors are those of the point before */
    result->seed = seed;
    for (int d = 0; d < 3; d++) result->normal[d] = lists->normal[3 * q + d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactPointGaps - gaps (lengths) of the slave points of this rank, positions as the lists were last updated.

   Not collective. factor[n_slaves]: points of factor 0 are not asked for; seed[n_slaves]: the facets of last time,
   rewritten, or NULL; gap[n_slaves]: NaN where there is none; normals[3*n_slaves]: out of the master at the feet, or
   NULL. force[n_slaves]: points with one, of last time, will most likely have one again, and their first variations are
   taken among the pair's, whose lists these are; or NULL. */
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

/* Moves the lists' points to (u, t) and projects every slave point. The gaps stand already where the last evaluation
   was at the same place: three in four, as the solver asks for residual, energy and tangent of each iterate one by one.
 */
PetscErrorCode ContactPairProject(Contact contact, ContactPair *pair, const PetscReal *u, PetscReal t)
{
  PetscBool moved;

  PetscFunctionBeginUser;
  PetscCall(NeighbourListsUpdate(pair->search, pair->lists, u, t, &moved));
  if (moved) pair->fresh = PETSC_FALSE;
  if (pair->projected && !moved) PetscFunctionReturn(PETSC_SUCCESS);
  pair->projected = PETSC_TRUE;
  ContactVariationsReset(pair->variations);
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

/* An analytic master that moves by d is to the slave nodes as if they had moved by -d. */
static void AnalyticTravel(Contact contact, const ContactPair *pair, PetscReal t, PetscReal t_next, PetscReal *values)
{
  const int dim = contact->mesh->dim;
  PetscReal from[3], to[3];

  MotionPlace(&pair->scene->motion, t, pair->scene->motion.point, from);
  MotionPlace(&pair->scene->motion, t_next, pair->scene->motion.point, to);
  for (PetscInt i = 0; i < pair->lists->n_nodes * dim; i++) values[i] -= to[i % dim] - from[i % dim];
}

/* ContactPairMove - how the contact nodes of a pair move with local displacements x, tools and an analytic master from
   t to t_next: values[lists n_nodes*dim]. Collective. */
PetscErrorCode ContactPairMove(Contact contact, ContactPair *pair, const PetscReal *x, PetscReal t, PetscReal t_next,
                               PetscReal *values)
{
  PetscFunctionBeginUser;
  PetscCall(NeighbourListsBroadcast(pair->search, pair->lists, x, t, t_next, values));
  if (!pair->master) AnalyticTravel(contact, pair, t, t_next, values);
  PetscFunctionReturn(PETSC_SUCCESS);
}
