#include "contactimpl.h"
#include "base/timing.h"

/* ContactVariationsCreate - room for the first variations of so many slave points, none of them known. Not collective.
 */
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

/* ContactVariationsDestroy - Not collective. */
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

/* ContactVariationsReset - none is known: the points have moved, or their lists are new. Not collective. */
void ContactVariationsReset(ContactVariations *v)
{
  v->n = 0;
  for (PetscInt q = 0; q < v->n_points; q++) v->first[q] = -1;
}

/* ContactVariationsKeep - takes that of point q from the pair's work, where it was evaluated last. Not collective.
 * found: a master is near. */
PetscErrorCode ContactVariationsKeep(const ContactPair *pair, PetscInt q, PetscBool found)
{
  const int          dim  = pair->mesh->dim;
  const ContactWork *work = pair->work;
  ContactVariations *v    = pair->variations;

  PetscFunctionBeginUser;
  v->first[q] = v->end[q] = v->n;
  if (!found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactPointToNodes(pair, pair->lists, q));
  if (v->n + work->count > v->room) {
    v->room = 2 * (v->n + work->count);
    PetscCall(PetscRealloc(v->room * sizeof(PetscInt), &v->number));
    PetscCall(PetscRealloc(v->room * dim * sizeof(PetscReal), &v->N));
  }
  PetscCall(PetscArraycpy(&v->number[v->n], work->number, work->count));
  PetscCall(PetscArraycpy(&v->N[v->n * dim], work->N, work->count * dim));
  PetscCall(PetscArraycpy(&v->own[q * dim], work->result.N, dim));
  v->n += work->count;
  v->end[q] = v->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactVariationsNeed - sees that the first variation of point q is among the pair's. Not collective. */
PetscErrorCode ContactVariationsNeed(const ContactPair *pair, PetscInt q)
{
  PetscBool found;

  PetscFunctionBeginUser;
  if (pair->variations->first[q] >= 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (pair->fit.degree) TimingBegin(TIMING_FIT);
  PetscCall(
    ContactPointEvaluate(pair, pair->smoother, pair->lists, q, pair->seed[q], SMOOTHER_FIRST_VARIATION, &found));
  PetscCall(ContactVariationsKeep(pair, q, found));
  if (pair->fit.degree) TimingEnd(TIMING_FIT);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactVariationsNodes - the nodes of the first variations of some slave points, each once, into the work's number;
   points without area have none. Not collective. */
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
  PetscCall(ContactNodesBegin(pair, nodes));
  for (PetscInt k = 0; k < n; k++)
    if (pair->factor[points[k]] != 0)
      ContactNodesAdd(pair, v->end[points[k]] - v->first[points[k]], &v->number[v->first[points[k]]]);
  ContactNodesEnd(pair);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactTermVary - v[] += scale times the sum of a term's points' variations, weighted by their areas, over the nodes
   of the block at hand; they are there (ContactVariationsNodes()). Not collective. */
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

/* Room for one vector more, of so many entries at most. */
static PetscErrorCode VectorsReserve(ContactVectors *vectors, PetscInt entries)
{
  const PetscInt used = vectors->n ? vectors->ptr[vectors->n] : 0;

  PetscFunctionBeginUser;
  if (vectors->n + 2 > vectors->vectors_room) {
    vectors->vectors_room = 2 * (vectors->n + 2);
    PetscCall(PetscRealloc(vectors->vectors_room * sizeof(PetscInt), &vectors->ptr));
  }
  if (used + entries > vectors->room) {
    vectors->room = 2 * (used + entries);
    PetscCall(PetscRealloc(vectors->room * sizeof(PetscInt), &vectors->row));
    PetscCall(PetscRealloc(vectors->room * sizeof(PetscScalar), &vectors->value));
  }
  vectors->ptr[vectors->n] = used;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactVectorsAdd - scale times the sum of a term's points' variations, weighted by their areas, over the free dofs,
 * as one vector more. Not collective. */
PetscErrorCode ContactVectorsAdd(ContactVectors *vectors, const ContactPair *pair, PetscInt c, PetscReal scale)
{
  const int                dim = pair->mesh->dim;
  const ContactVariations *all = pair->variations;
  const PetscInt          *dof = pair->lists->dof;
  PetscInt                 n   = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt q = pair->term_point[k];

    if (pair->factor[q] == 0) continue;
    PetscCall(ContactVariationsNeed(pair, q));
    n += (all->end[q] - all->first[q]) * dim;
  }
  PetscCall(VectorsReserve(vectors, n));
  n = vectors->ptr[vectors->n];
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt  q      = pair->term_point[k];
    const PetscReal weight = scale * pair->term_weight[k] * pair->factor[q];

    for (PetscInt i = all->first[q] * dim; weight != 0 && i < all->end[q] * dim; i++) {
      const PetscInt row = dof[all->number[i / dim] * dim + i % dim];

      if (row < 0) continue;
      vectors->row[n]     = row;
      vectors->value[n++] = weight * all->N[i];
    }
  }
  vectors->ptr[++vectors->n] = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactVectorsAddZeros - Not collective. */
PetscErrorCode ContactVectorsAddZeros(ContactVectors *vectors, PetscInt n, const PetscInt row[])
{
  PetscInt first;

  PetscFunctionBeginUser;
  PetscCall(VectorsReserve(vectors, n));
  first = vectors->ptr[vectors->n];
  PetscCall(PetscArraycpy(&vectors->row[first], row, n));
  PetscCall(PetscArrayzero(&vectors->value[first], n));
  vectors->ptr[++vectors->n] = first + n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactVectorsFree - Not collective. There are none afterwards. */
PetscErrorCode ContactVectorsFree(ContactVectors *vectors)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(vectors->ptr));
  PetscCall(PetscFree(vectors->row));
  PetscCall(PetscFree(vectors->value));
  *vectors = (ContactVectors){.n = 0};
  PetscFunctionReturn(PETSC_SUCCESS);
}
