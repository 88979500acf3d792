#include "contactimpl.h"

/* The gap and its variations against an analytic master, which has no points. */
static PetscBool PointEvaluateAnalytic(const ContactPair *pair, ContactLists lists, PetscInt q)
{
  const int        dim    = lists->dim;
  const PetscReal *centre = pair->mesh->centre;
  SmootherResult  *result = &pair->work->result;
  AnalyticMaster   master = pair->scene->analytic;
  AnalyticResult   found;
  PetscReal        point[3], x[3];

  MotionPlace(&pair->scene->motion, lists->t, pair->scene->motion.point, point);
  MotionTurn(&pair->scene->motion, lists->t, pair->scene->analytic.axis, master.axis);
  for (int d = 0; d < dim; d++) x[d] = (lists->slave_X[q * dim + d] - (point[d] - centre[d])) + lists->slave_u[q * dim + d];
  if (!AnalyticEvaluate(&master, dim, x, &found)) return PETSC_FALSE;
  result->gap          = found.gap;
  result->beyond       = 0;
  result->seed         = -1;
  result->facet_served = 0;
  result->n            = 0;
  for (int d = 0; d < 3; d++) result->normal[d] = found.normal[d];
  for (int d = 0; d < dim; d++) result->N[d] = found.N[d];
  for (int d = 0; d < dim * dim; d++) result->M[d] = found.M[d];
  return PETSC_TRUE;
}

/* Gap (and variations over the fit points) of slave point q of the lists; *found is PETSC_FALSE where no master is near. */
PetscErrorCode ContactPointEvaluate(const ContactPair *pair, const Smoother *smoother, ContactLists lists, PetscInt q, int seed, SmootherWant want,
                                    PetscBool *found)
{
  const int      dim   = lists->dim;
  ContactWork   *work  = pair->work;
  const PetscInt first = lists->list_ptr[q], n = lists->list_ptr[q + 1] - first;
  SmootherInput  in;

  PetscFunctionBeginUser;
  if (!pair->master) {
    *found = PointEvaluateAnalytic(pair, lists, q);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (n > work->x_room) {
    work->x_room = 2 * n;
    PetscCall(PetscFree2(work->x, work->multiplier));
    PetscCall(PetscMalloc2(work->x_room * dim, &work->x, work->x_room, &work->multiplier));
  }
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt p = lists->list_point[first + i];

    work->multiplier[i] = lists->point_weight[p];
    for (int d = 0; d < dim; d++)
      work->x[i * dim + d] = (lists->point_X[p * dim + d] - lists->slave_X[q * dim + d]) + (lists->point_u[p * dim + d] - lists->slave_u[q * dim + d]);
  }
  in     = (SmootherInput){.dim         = dim,
                           .n_points    = (int)n,
                           .n_facets    = (int)(lists->facet_ptr[q + 1] - lists->facet_ptr[q]),
                           .x           = work->x,
                           .facets      = &lists->facet[lists->facet_ptr[q]],
                           .seed        = seed,
                           .n_fit       = (int)lists->fit_n[q],
                           .degree      = lists->degree[q],
                           .exponent    = pair->fit.exponent,
                           .multiplier  = work->multiplier,
                           .frame       = &lists->frame[9 * q],
                           .metric      = &lists->metric[4 * q],
                           .derivatives = pair->fit.derivatives,
                           .workspace   = work->workspace};
  *found = in.n_facets && smoother->evaluate(&in, want, &work->result) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many contact nodes slave point q touches once evaluated. */
int ContactPointNodes(ContactLists lists, PetscInt q, const SmootherResult *r)
{
  PetscInt n = lists->slave_ptr[q + 1] - lists->slave_ptr[q];

  for (int i = 0; i < r->n; i++) {
    const PetscInt p = lists->list_point[lists->list_ptr[q] + r->points[i]];
    n += lists->point_ptr[p + 1] - lists->point_ptr[p];
  }
  return (int)n;
}

/* Carries the variations of the last evaluation from fit points to contact nodes: N and M over nodes[*n] of the lists, in work. */
void ContactPointToNodes(const ContactPair *pair, ContactLists lists, PetscInt q, PetscReal weight, PetscBool second, PetscInt *node, PetscReal *N, int *count)
{
  ContactWork          *work = pair->work;
  const SmootherResult *r    = &work->result;
  const int             dim = lists->dim, m = (1 + r->n) * dim;
  int                   n = 0, *from = work->from;
  PetscReal            *scale = work->scale;

  for (PetscInt k = lists->slave_ptr[q]; k < lists->slave_ptr[q + 1]; k++, n++) {
    node[n] = lists->slave_node[k];
    from[n] = 0;
    for (int d = 0; d < dim; d++) scale[3 * n + d] = lists->slave_S[k];
  }
  for (int i = 0; i < r->n; i++) {
    const PetscInt      p     = lists->list_point[lists->list_ptr[q] + r->points[i]];
    const SurfaceImage *image = &pair->images[lists->point_image[p]];

    for (PetscInt k = lists->point_ptr[p]; k < lists->point_ptr[p + 1]; k++, n++) {
      node[n] = lists->point_node[k];
      from[n] = 1 + i;
      for (int d = 0; d < dim; d++) scale[3 * n + d] = image->sign[d] * lists->point_S[k];
    }
  }
  for (int a = 0; a < n; a++)
    for (int d = 0; d < dim; d++) N[a * dim + d] = weight * scale[3 * a + d] * r->N[from[a] * dim + d];
  for (int a = 0; second && a < n; a++) {
    for (int d = 0; d < dim; d++) {
      for (int b = 0; b < n; b++)
        for (int e = 0; e < dim; e++)
          work->M[(a * dim + d) * n * dim + b * dim + e] = scale[3 * a + d] * scale[3 * b + e] * r->M[(from[a] * dim + d) * m + from[b] * dim + e];
    }
  }
  *count = n;
}

/* Weighted gap of a term: NaN where none of its points has a master near or all lie past its edge. */
PetscErrorCode ContactTermGap(const ContactPair *pair, ContactLists lists, const PetscReal *factor, int *seed, PetscInt c, PetscReal *gap)
{
  PetscBool any = PETSC_FALSE;

  PetscFunctionBeginUser;
  *gap = 0;
  for (PetscInt q = pair->term_ptr[c]; q < pair->term_ptr[c + 1]; q++) {
    PetscBool found;

    if (factor[q] == 0) continue;
    PetscCall(ContactPointEvaluate(pair, pair->smoother, lists, q, seed ? seed[q] : -1, SMOOTHER_GAP, &found));
    if (!found) continue;
    any = PETSC_TRUE;
    *gap += pair->term_weight[q] * pair->work->result.gap;
    if (seed) seed[q] = pair->work->result.seed;
  }
  if (!any) *gap = NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}
