/* What the geometry of a pair's contact leaves open, against its penetrations. For reports. */
#include "contactimpl.h"

/* The distance between the facets and the smooth surface at slave point q; NaN where there is none. */
static PetscErrorCode PointApart(const ContactPair *pair, PetscInt q, PetscReal *apart)
{
  const SmootherResult *result = &pair->work->result;
  PetscReal             facets;
  PetscBool             found;

  PetscFunctionBeginUser;
  *apart = NAN;
  if (PetscIsNanReal(pair->point_gap[q]) || !pair->lists->fit_n[q]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactPointEvaluate(pair, pair->facets, pair->lists, q, -1, SMOOTHER_GAP, &found));
  if (!found || result->beyond != 0) PetscFunctionReturn(PETSC_SUCCESS);
  facets = result->gap;
  PetscCall(ContactPointEvaluate(pair, pair->smoother, pair->lists, q, -1, SMOOTHER_GAP, &found));
  if (found && !result->facet_served) *apart = PetscAbsReal(facets - result->gap);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a term that presses: its force times its penetration, and times the mean distance between the facets
   and the smooth surface at its slave points. apart: that of each point, -1 where it has not been found yet, as terms
   share points. */
static PetscErrorCode AddTerm(const ContactPair *pair, PetscInt c, PetscReal *apart, PetscReal sum[2])
{
  const PetscReal depth = -pair->now.gap[c], force = depth * pair->area[c] * pair->now.penalty[c];
  PetscReal       mean = 0, area = 0;

  PetscFunctionBeginUser;
  if (!(depth > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt q = pair->term_point[k];

    if (apart[q] < 0) PetscCall(PointApart(pair, q, &apart[q]));
    if (PetscIsNanReal(apart[q])) continue;
    mean += pair->term_weight[k] * apart[q];
    area += pair->term_weight[k];
  }
  if (!(area > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  sum[0] += force * depth;
  sum[1] += force * mean / area;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairGeometry - compares the distance between the facets and the smooth surface, where a pair presses, with its
  penetrations.

  Collective

  Input Parameters:
+ contact - the contact, after ContactResidual()
- p       - number of the pair

  Output Parameter:
. ratio - the mean distance over the mean penetration, both weighted by the contact forces; NaN where nothing presses,
          or where the master is not fitted

  Note:
  A change of all gaps by their penetration changes forces by what penetration leaves of error in them. So facets in the
  place of the smooth surface change forces by about this many times that error.
@*/
PetscErrorCode ContactPairGeometry(Contact contact, int p, PetscReal *ratio)
{
  const ContactPair *pair   = &contact->pairs[p];
  const PetscInt     n      = pair->fit.fitted ? pair->lists->n_slaves : 0;
  PetscReal          sum[2] = {0, 0}, *apart;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &apart));
  for (PetscInt q = 0; q < n; q++) apart[q] = -1;
  for (PetscInt c = 0; c < pair->n && pair->fit.fitted; c++) PetscCall(AddTerm(pair, c, apart, sum));
  PetscCall(PetscFree(apart));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPIU_SUM, contact->mesh->comm));
  *ratio = sum[0] > 0 ? sum[1] / sum[0] : NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}
