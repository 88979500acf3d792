/* The smoother of the facets: the gap is measured to the closest facet of the list. */
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

const Smoother Smoother_Facet = {.capacity       = FACE_MAX_NODES,
                                 .dense_capacity = FACE_MAX_NODES,
                                 .evaluate       = SmootherEvaluate_Facet};
