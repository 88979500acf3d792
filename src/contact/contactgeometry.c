/* What the geometry of a pair's contact leaves open, against its penetrations. For reports. */
#include "contactimpl.h"

/* Adds a term that presses: its force times its penetration, and times the mean distance between the facets
   and the smooth surface at its slave points. */
static PetscErrorCode AddTerm(const ContactPair *pair, PetscInt c, PetscReal sum[2])
{
  const SmootherResult *result = &pair->work->result;
  const PetscReal       depth = -pair->now.gap[c], force = depth * pair->area[c] * pair->now.penalty[c];
  PetscReal             apart = 0, area = 0;

  PetscFunctionBeginUser;
  if (!(depth > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt q = pair->term_point[k];
    PetscReal      facets;
    PetscBool      found;

    if (PetscIsNanReal(pair->point_gap[q]) || !pair->lists->fit_n[q]) continue;
    PetscCall(ContactPointEvaluate(pair, pair->facets, pair->lists, q, -1, SMOOTHER_GAP, &found));
    if (!found || result->beyond != 0) continue;
    facets = result->gap;
    PetscCall(ContactPointEvaluate(pair, pair->smoother, pair->lists, q, -1, SMOOTHER_GAP, &found));
    if (!found || result->facet_served) continue;
    apart += pair->term_weight[k] * PetscAbsReal(facets - result->gap);
    area += pair->term_weight[k];
  }
  if (!(area > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  sum[0] += force * depth;
  sum[1] += force * apart / area;
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
  PetscReal          sum[2] = {0, 0};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n && pair->fit.fitted; c++) PetscCall(AddTerm(pair, c, sum));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPIU_SUM, contact->mesh->comm));
  *ratio = sum[0] > 0 ? sum[1] / sum[0] : NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}
