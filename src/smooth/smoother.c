/* The table of smoothers and the two built-in ones: the facets, and the diffuse fit, which falls back on the facets. */
#include <string.h>
#include "smooth/smoother.h"

/*@
  SmootherEvaluate_Facet - finds gap and variations against the closest facet of the list.

  Not collective

  Input Parameters:
+ in   - list of a slave point; the fit in it is not read
- want - the variation that is wanted

  Output Parameter:
. out - gap, normal, points that take part, and the variation

  Note:
  Returns 0 when the list holds no facet. Other smoothers call it where they have no surface of their own. Plain C.
@*/
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

/* Uses the fit where there is one. The facets are used where every fit failed its guards when the lists were made,
   or where the fit has no foot. */
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
      out->beyond   = 0; /* the caller fades the contact by the facets' free edges when lists are made */
      out->seed     = in->seed;
      out->n        = fit.n;
      memcpy(out->normal, fit.normal, sizeof(out->normal));
      return 1;
    }
  }
  out->facet_served = 1;
  return SmootherEvaluate_Facet(in, want, out);
}

/* Length of the workspace for the diffuse fit, in doubles. It holds the highest degree and the longest list, because
   one workspace serves all pairs. */
static long SmootherWorkspace_Diffuse(int dim)
{
  return FitWorkspace(dim, 4, FIT_MAX_POINTS);
}

const Smoother Smoother_Facet   = {.capacity       = FACE_MAX_NODES,
                                   .dense_capacity = FACE_MAX_NODES,
                                   .evaluate       = SmootherEvaluate_Facet};
const Smoother Smoother_Diffuse = {.capacity       = FIT_MAX_POINTS,
                                   .dense_capacity = FACE_MAX_NODES,
                                   .fitted         = 1,
                                   .search_gap     = 1,
                                   .workspace      = SmootherWorkspace_Diffuse,
                                   .evaluate       = SmootherEvaluate_Diffuse};

const Smoother *Smoothers[SMOOTHER_MAX + 1]     = {SMOOTHERS(CHOICE_POINTER)};
const char     *SmootherNames[SMOOTHER_MAX + 1] = {SMOOTHERS(CHOICE_NAME)};
char            SmootherWords[SMOOTHER_WORDS]   = SMOOTHERS(CHOICE_BAR);

/*@
  SmootherRegister - adds a smoother to the table, so that scenes can choose it by name.

  Not collective

  Input Parameters:
+ name     - the word in the scene: letters, digits and underscores; it is not copied
- smoother - its needs and its evaluation; it is not copied

  Note:
  Returns 1 when the smoother was added. Returns 0 when the name is empty, taken or holds other characters, or when
  SMOOTHER_MAX or SMOOTHER_WORDS leaves no room. It must be called before the scene is read, with the same smoothers in
  the same order on all ranks. Plain C.
@*/
int SmootherRegister(const char *name, const Smoother *smoother)
{
  const size_t length = strlen(name), used = strlen(SmootherWords), bar = sizeof " | " - 1;
  int          n = 0;

  for (; SmootherNames[n]; n++)
    if (!strcmp(SmootherNames[n], name)) return 0;
  if (n == SMOOTHER_MAX || used + bar + length + 1 > SMOOTHER_WORDS) return 0;
  if (!length || strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") != length) return 0;
  memcpy(&SmootherWords[used], " | ", bar);
  memcpy(&SmootherWords[used + bar], name, length + 1);
  SmootherNames[n] = name;
  Smoothers[n]     = smoother;
  return 1;
}
