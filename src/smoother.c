#include <string.h>
#include "smoother.h"

static int SmootherEvaluate_Facet(const SmootherInput *in, SmootherWant want, SmootherResult *out)
{
  const Facet *facet;
  Foot         foot;

  if (!FacetClosest(in->dim, in->n_facets, in->facets, in->x, in->seed, &foot)) return 0;
  facet       = &in->facets[foot.facet];
  out->gap    = foot.gap;
  out->beyond = foot.beyond;
  out->seed   = foot.facet;
  memcpy(out->normal, foot.normal, sizeof(out->normal));
  out->n = ElementGet(facet->type)->nodes;
  memcpy(out->points, facet->nodes, out->n * sizeof(int));
  if (want >= SMOOTHER_FIRST_VARIATION) FacetFirstVariation(in->dim, facet, in->x, &foot, out->N);
  if (want >= SMOOTHER_SECOND_VARIATION) FacetSecondVariation(in->dim, facet, in->x, &foot, out->M);
  return 1;
}

const Smoother Smoothers[] = {
  {"facet", FACE_MAX_NODES, SmootherEvaluate_Facet},
  {NULL,    0,              NULL                  }
};

/* SmootherFind - the smoother of that name, or NULL. Not collective. */
const Smoother *SmootherFind(const char *name)
{
  for (const Smoother *smoother = Smoothers; smoother->name; smoother++)
    if (!strcmp(smoother->name, name)) return smoother;
  return NULL;
}
