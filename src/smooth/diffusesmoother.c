/* The smoother of the diffuse fit, which falls back on the facets. */
#include <string.h>
#include "smooth/smoother.h"

/* Uses the fit where there is one. The facets are used where every fit failed its guards when the lists were made,
   or where the fit has no foot. In the first case they may be lifted to the smooth surface. */
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
                                  .hoop        = in->hoop,
                                  .derivatives = in->derivatives};
  FitResult            fit     = {.points  = out->points,
                                  .N       = want == SMOOTHER_FIRST_VARIATION ? out->N : NULL,
                                  .factors = &out->factors};

  out->facet_served = 0;
  if (in->n_fit) {
    memcpy(problem.frame, in->frame, sizeof(problem.frame));
    memcpy(problem.metric, in->metric, sizeof(problem.metric));
    if (in->bend) problem.bend = *in->bend;
    if (DiffuseFitEvaluate(&problem, wants[want], in->workspace, &fit) && !(fit.guards & FIT_FAR_FOOT)) {
      out->gap      = fit.gap;
      out->factored = 1;
      out->beyond   = 0; /* the caller fades the contact by the facets' free edges when lists are made */
      out->seed     = in->seed;
      out->n        = fit.n;
      memcpy(out->normal, fit.normal, sizeof(out->normal));
      return 1;
    }
  }
  out->facet_served = 1;
  if (!SmootherEvaluate_Facet(in, want, out)) return 0;
  out->gap -= in->lift;
  return 1;
}

/* Length of the workspace for the diffuse fit, in doubles. It holds the highest degree and the longest list, because
   one workspace serves all pairs. */
static long SmootherWorkspace_Diffuse(int dim)
{
  return FitWorkspace(dim, dim == 2 ? FIT_REVOLVED + 4 : 4, FIT_MAX_POINTS);
}

const Smoother Smoother_Diffuse = {.capacity       = FIT_MAX_POINTS,
                                   .dense_capacity = FACE_MAX_NODES,
                                   .fitted         = 1,
                                   .search_gap     = 1,
                                   .workspace      = SmootherWorkspace_Diffuse,
                                   .evaluate       = SmootherEvaluate_Diffuse};
