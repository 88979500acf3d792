#include "contactimpl.h"
#include "timing.h"

/* ContactPointVary - first variation of a slave point over contact nodes, in the pair's work. Not collective. second: what ContactSecondAdd() needs too. */
PetscErrorCode ContactPointVary(const ContactPair *pair, PetscInt q, PetscBool second, PetscBool *found)
{
  PetscFunctionBeginUser;
  if (pair->fit.degree) TimingBegin(TIMING_FIT);
  PetscCall(ContactPointEvaluate(pair, pair->smoother, pair->lists, q, pair->seed[q], second ? SMOOTHER_SECOND_VARIATION : SMOOTHER_FIRST_VARIATION, found));
  if (pair->fit.degree) TimingEnd(TIMING_FIT);
  if (*found) PetscCall(ContactPointToNodes(pair, pair->lists, q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Add(ContactVariations *all, const ContactWork *work, int dim, PetscInt q)
{
  PetscFunctionBeginUser;
  if (all->n + work->count > all->room) {
    all->room = 2 * (all->n + work->count);
    PetscCall(PetscRealloc(all->room * sizeof(PetscInt), &all->number));
    PetscCall(PetscRealloc(all->room * dim * sizeof(PetscReal), &all->N));
  }
  all->first[q] = all->n;
  PetscCall(PetscArraycpy(&all->number[all->n], work->number, work->count));
  PetscCall(PetscArraycpy(&all->N[all->n * dim], work->N, work->count * dim));
  all->n += work->count;
  all->last[q] = all->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactVariationsCreate - the points of all terms that are wanted, at the last projection. Not collective. wanted[n]: of the pair's terms. */
PetscErrorCode ContactVariationsCreate(const ContactPair *pair, const PetscBool *wanted, ContactVariations *all)
{
  const int dim = pair->mesh->dim;
  PetscInt  n   = pair->lists->n_slaves;
  PetscBool found;

  PetscFunctionBeginUser;
  *all = (ContactVariations){0};
  PetscCall(PetscMalloc3(n, &all->first, n, &all->last, pair->lists->n_nodes, &all->place));
  for (PetscInt q = 0; q < n; q++) all->first[q] = all->last[q] = -1;
  for (PetscInt i = 0; i < pair->lists->n_nodes; i++) all->place[i] = -1;
  for (PetscInt c = 0; c < pair->n; c++) {
    for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1] && wanted[c]; k++) {
      const PetscInt q = pair->term_point[k];

      if (all->first[q] >= 0 || pair->factor[q] == 0) continue;
      PetscCall(ContactPointVary(pair, q, PETSC_FALSE, &found));
      if (found) PetscCall(Add(all, pair->work, dim, q));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactVariationsDestroy - Not collective. */
PetscErrorCode ContactVariationsDestroy(ContactVariations *all)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(all->first, all->last, all->place));
  PetscCall(PetscFree(all->number));
  PetscCall(PetscFree(all->N));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactVariationsNumber - numbers the nodes of some points, how many there are: their places until ContactVariationsForget(). Not collective. */
PetscInt ContactVariationsNumber(PetscInt n, const PetscInt *points, ContactVariations *all)
{
  PetscInt m = 0;

  for (PetscInt k = 0; k < n; k++)
    for (PetscInt i = all->first[points[k]]; i < all->last[points[k]]; i++)
      if (all->place[all->number[i]] < 0) all->place[all->number[i]] = m++;
  return m;
}

/* ContactVariationsName - writes the dofs of the numbered nodes, dim for each, to entry[]. Not collective. */
void ContactVariationsName(int dim, PetscInt n, const PetscInt *points, const ContactVariations *all, PetscInt *entry)
{
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt i = all->first[points[k]]; i < all->last[points[k]]; i++)
      for (int d = 0; d < dim; d++) entry[all->place[all->number[i]] * dim + d] = all->number[i] * dim + d;
}

/* ContactVariationsForget - Not collective. */
void ContactVariationsForget(PetscInt n, const PetscInt *points, ContactVariations *all)
{
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt i = all->first[points[k]]; i < all->last[points[k]]; i++) all->place[all->number[i]] = -1;
}

/* ContactTermVary - N[] += scale times the sum of a term's points' variations, weighted by their areas; its points' nodes are numbered. Not collective. */
void ContactTermVary(const ContactPair *pair, PetscInt c, PetscReal scale, const ContactVariations *all, PetscReal *N)
{
  const int dim = pair->mesh->dim;

  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt  q      = pair->term_point[k];
    const PetscReal weight = scale * pair->term_weight[k] * pair->factor[q];

    for (PetscInt i = all->first[q]; i < all->last[q]; i++)
      for (int d = 0; d < dim; d++) N[all->place[all->number[i]] * dim + d] += weight * all->N[i * dim + d];
  }
}
