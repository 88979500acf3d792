/* First variations of slave points that are kept from one projection to the next. */
#include "contactimpl.h"
#include "base/timing.h"

/*@
  ContactVariationsCreate - makes room for the first variations of some slave points, none of which is known.

  Not collective

  Input Parameters:
+ dim      - dimension
- n_points - number of slave points

  Output Parameter:
. variations - the room
@*/
PetscErrorCode ContactVariationsCreate(int dim, PetscInt n_points, ContactVariations **variations)
{
  ContactVariations *v;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&v));
  v->n_points = n_points;
  PetscCall(PetscMalloc3(n_points, &v->first, n_points, &v->end, n_points * dim, &v->own));
  ContactVariationsReset(v);
  *variations = v;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactVariationsDestroy - frees the variations.

  Not collective

  Input Parameter:
. variations - the variations; set to NULL
@*/
PetscErrorCode ContactVariationsDestroy(ContactVariations **variations)
{
  ContactVariations *v = *variations;

  PetscFunctionBeginUser;
  if (!v) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree3(v->first, v->end, v->own));
  PetscCall(PetscFree(v->number));
  PetscCall(PetscFree(v->N));
  PetscCall(PetscFree(*variations));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactVariationsReset - forgets all variations, because the points have moved or their lists are new.

  Not collective

  Input Parameter:
. v - the variations
@*/
void ContactVariationsReset(ContactVariations *v)
{
  v->n = 0;
  for (PetscInt q = 0; q < v->n_points; q++) v->first[q] = -1;
}

/*@
  ContactVariationsKeep - keeps the first variation of a slave point that was evaluated last.

  Not collective

  Input Parameters:
+ pair  - the pair
. q     - the slave point
- found - whether a master is near
@*/
PetscErrorCode ContactVariationsKeep(const ContactPair *pair, PetscInt q, PetscBool found)
{
  const int          dim  = pair->mesh->dim;
  const ContactWork *work = pair->work;
  ContactVariations *v    = pair->variations;

  PetscFunctionBeginUser;
  v->first[q] = v->end[q] = v->n;
  if (!found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactPointToNodes(pair, pair->lists, q));
  if (v->n + work->count + TOOL_NODES > v->room) {
    v->room = 2 * (v->n + work->count + TOOL_NODES);
    PetscCall(PetscRealloc(v->room * sizeof(PetscInt), &v->number));
    PetscCall(PetscRealloc(v->room * dim * sizeof(PetscReal), &v->N));
  }
  PetscCall(PetscArraycpy(&v->number[v->n], work->number, work->count));
  PetscCall(PetscArraycpy(&v->N[v->n * dim], work->N, work->count * dim));
  PetscCall(PetscArraycpy(&v->own[q * dim], work->result.N, dim));
  v->n += work->count;
  if (pair->tool) {
    PetscCall(ContactToolVariation(pair, work->count, work->number, work->N, &v->N[v->n * dim]));
    for (int k = 0; k < TOOL_NODES; k++) v->number[v->n++] = pair->lists->tool + k;
  }
  v->end[q] = v->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactVariationsOwn - returns the number of nodes of the first variation of a slave point without those of a tool,
  which are the last ones.

  Not collective

  Input Parameters:
+ pair - the pair
- q    - the slave point, after ContactVariationsNeed()
@*/
PetscInt ContactVariationsOwn(const ContactPair *pair, PetscInt q)
{
  const PetscInt n = pair->variations->end[q] - pair->variations->first[q];

  return pair->tool && n ? n - TOOL_NODES : n;
}

/* Evaluates the first variation of a slave point. */
static PetscErrorCode Evaluate(const ContactPair *pair, PetscInt q, PetscBool *found)
{
  PetscFunctionBeginUser;
  PetscCall(ContactPointEvaluate(pair, pair->smoother, pair->lists, q, pair->seed[q], SMOOTHER_FIRST_VARIATION, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactVariationsNeed - evaluates the first variation of a slave point, unless it is kept.

  Not collective

  Input Parameters:
+ pair - the pair
- q    - the slave point
@*/
PetscErrorCode ContactVariationsNeed(const ContactPair *pair, PetscInt q)
{
  PetscBool found;

  PetscFunctionBeginUser;
  if (pair->variations->first[q] >= 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (pair->fit.fitted) TimingBegin(TIMING_FIT);
  PetscCall(Evaluate(pair, q, &found));
  PetscCall(ContactVariationsKeep(pair, q, found));
  if (pair->fit.fitted) TimingEnd(TIMING_FIT);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactVariationsAlong - finds the change of the gap of a slave point along a motion of the contact nodes.

  Not collective

  Input Parameters:
+ pair   - the pair
. q      - the slave point
- motion - motion[n_nodes*dim] of the nodes of its lists (length)

  Output Parameter:
. change - of the gap (length)
@*/
PetscErrorCode ContactVariationsAlong(const ContactPair *pair, PetscInt q, const PetscReal *motion, PetscReal *change)
{
  const int                dim = pair->mesh->dim;
  const ContactVariations *v   = pair->variations;

  PetscFunctionBeginUser;
  *change = 0;
  PetscCall(ContactVariationsNeed(pair, q));
  for (PetscInt i = v->first[q]; i < v->end[q]; i++)
    for (int d = 0; d < dim; d++) *change += v->N[i * dim + d] * motion[v->number[i] * dim + d];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactVariationsOwnPart - gives the part of a first variation that belongs to the slave point itself.

  Not collective

  Input Parameters:
+ pair - the pair
- q    - the slave point

  Output Parameters:
+ own   - own[dim] (no unit)
- found - PETSC_FALSE where no master is near

  Note:
  A variation that is not kept is not carried to nodes for this.
@*/
PetscErrorCode ContactVariationsOwnPart(const ContactPair *pair, PetscInt q, PetscReal own[], PetscBool *found)
{
  const int                dim = pair->mesh->dim;
  const ContactVariations *v   = pair->variations;

  PetscFunctionBeginUser;
  if (v->first[q] < 0) {
    if (pair->fit.fitted) TimingBegin(TIMING_FIT);
    PetscCall(Evaluate(pair, q, found));
    if (pair->fit.fitted) TimingEnd(TIMING_FIT);
  } else
    *found = (PetscBool)(v->first[q] < v->end[q]);
  if (*found) PetscCall(PetscArraycpy(own, v->first[q] < 0 ? pair->work->result.N : &v->own[q * dim], dim));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactVariationsNodes - lists the nodes of the first variations of some slave points, each once, into the work's
  number.

  Not collective

  Input Parameters:
+ pair   - the pair
. n      - number of slave points
- points - the slave points; those without area have no nodes
@*/
PetscErrorCode ContactVariationsNodes(const ContactPair *pair, PetscInt n, const PetscInt points[])
{
  const ContactVariations *v     = pair->variations;
  PetscInt                 nodes = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) {
    if (pair->factor[points[k]] == 0) continue;
    PetscCall(ContactVariationsNeed(pair, points[k]));
    nodes += v->end[points[k]] - v->first[points[k]];
  }
  PetscCall(ContactWorkNodesBegin(pair->work, pair->lists->n_nodes, nodes));
  for (PetscInt k = 0; k < n; k++)
    if (pair->factor[points[k]] != 0)
      ContactWorkNodesAdd(pair->work, v->end[points[k]] - v->first[points[k]], &v->number[v->first[points[k]]]);
  ContactWorkNodesEnd(pair->work);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactTermVary - adds scale times a term's first variation, weighted by the areas of its points, over the nodes of
  the block at hand.

  Not collective

  Input Parameters:
+ pair  - the pair, after ContactWorkBlockBegin(); the term's variations are kept, ContactVariationsNodes()
. c     - the term
- scale - factor

  Input/Output Parameter:
. v - dim entries for each node of the block
@*/
void ContactTermVary(const ContactPair *pair, PetscInt c, PetscReal scale, PetscReal *v)
{
  const int                dim = pair->mesh->dim;
  const ContactVariations *all = pair->variations;

  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt  q      = pair->term_point[k];
    const PetscReal weight = scale * pair->term_weight[k] * pair->factor[q];

    for (PetscInt i = all->first[q]; weight != 0 && i < all->end[q]; i++) {
      const int place = pair->work->slot[all->number[i]];

      for (int d = 0; place >= 0 && d < dim; d++) v[place * dim + d] += weight * all->N[i * dim + d];
    }
  }
}
