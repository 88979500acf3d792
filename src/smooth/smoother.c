#include <string.h>
#include "smooth/smoother.h"

/* SmootherEvaluate_Facet - gap and variations against the closest facet of the list. Returns 0 when the list holds
 * none. Not collective. */
int SmootherEvaluate_Facet(const SmootherInput *in, SmootherWant want, SmootherResult *out)
{
  const Facet *facet;
  Foot         foot;

  if (!FacetClosest(in->dim, in->n_facets, in->facets, in->x, in->seed, &foot)) return 0;
  facet         = &in->facets[foot.facet];
  out->gap      = foot.gap;
  out->beyond   = foot.beyond;
  out->factored = 0;
  out->seed     = foot.facet;
  memcpy(out->normal, foot.normal, sizeof(out->normal));
  out->n = ElementGet(facet->type)->nodes;
  memcpy(out->points, facet->nodes, out->n * sizeof(int));
  if (want == SMOOTHER_FIRST_VARIATION) FacetFirstVariation(in->dim, facet, in->x, &foot, out->N);
  if (want == SMOOTHER_SECOND_VARIATION) FacetSecondVariation(in->dim, facet, in->x, &foot, out->M);
  return 1;
}

/* The fit where there is one, the facets on the last rung of the ladder or where the fit has no foot. */
static int SmootherEvaluate_Diffuse(const SmootherInput *in, SmootherWant want, SmootherResult *out)
{
  static const FitWant wants[] = {[SMOOTHER_GAP]              = FIT_GAP_ONLY,
                                  [SMOOTHER_FIRST_VARIATION]  = FIT_FIRST_VARIATION,
                                  [SMOOTHER_SECOND_VARIATION] = FIT_SECOND_VARIATION};
  FitProblem           problem = {.dim         = in->dim,
                                  .degree      = in->degree,
                                  .exponent    = in->exponent,
                                  .n           = in->n_fit,
                                  .x           = in->x,
                                  .multiplier  = in->multiplier,
                                  .derivatives = in->derivatives};
  FitResult            fit     = {.points  = out->points,
                                  .N       = want == SMOOTHER_FIRST_VARIATION ? out->N : NULL,
                                  .factors = &out->factors};

  out->facet_served = 0;
  if (in->n_fit) {
    memcpy(problem.frame, in->frame, sizeof(problem.frame));
    memcpy(problem.metric, in->metric, sizeof(problem.metric));
    if (DiffuseFitEvaluate(&problem, wants[want], in->workspace, &fit) && !(fit.guards & FIT_FAR_FOOT)) {
      out->gap      = fit.gap;
      out->factored = 1;
      out->beyond   = 0; /* faded by the facets' free edges when lists are made */
      out->seed     = in->seed;
      out->n        = fit.n;
      memcpy(out->normal, fit.normal, sizeof(out->normal));
      return 1;
    }
  }
  out->facet_served = 1;
  return SmootherEvaluate_Facet(in, want, out);
}

const Smoother Smoother_Facet   = {FACE_MAX_NODES, 0, SmootherEvaluate_Facet};
const Smoother Smoother_Diffuse = {FIT_MAX_POINTS, 1, SmootherEvaluate_Diffuse};

const Smoother *const Smoothers[]     = {SMOOTHERS(CHOICE_POINTER)};
const char *const     SmootherNames[] = {SMOOTHERS(CHOICE_NAME)};
