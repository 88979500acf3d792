/* The integration rules of mixed elements, see mixedrule.h. */
#include "mixedrule.h"
#include <string.h>

/* Rules by element. The stress is output at the points of the element's own table. */
static MixedRule rules[ELEMENT_TYPES], output_rules[ELEMENT_TYPES];

/* Adds the points whose barycentric coordinates are the permutations of (a, ..., a, rest): those with rest at one place
   or, for a pair, with (1 - 2 a) / 2 at two of four places. */
static void AddPoints(MixedRule *rule, int dim, int pair, double a, double weight)
{
  const double rest = pair ? 0.5 - a : 1 - dim * a, volume = dim == 2 ? 1. / 2 : 1. / 6;

  for (int i = 0; i <= dim; i++) {
    for (int j = pair ? i + 1 : i; j <= (pair ? dim : i); j++) {
      for (int k = 0; k < dim; k++) rule->point[rule->points][k] = k + 1 == i || k + 1 == j ? rest : a;
      rule->weight[rule->points++] = volume * weight;
    }
  }
}

/* The bubble needs more points than a straight tri6 or tet10 without it: degree 4 with 6 points (Dunavant 1985), degree
   5 with 14 points (Walkington 2000). All weights are positive. */
static void SetPoints(MixedRule *rule, const Element *e, int output)
{
  rule->points = 0;
  if (e->type == ELEMENT_TRI6 && !output) {
    AddPoints(rule, 2, 0, 0.44594849091596488632, 0.22338158967801146570);
    AddPoints(rule, 2, 0, 0.09157621350977074346, 0.10995174365532186764);
  } else if (e->type == ELEMENT_TET10 && !output) {
    AddPoints(rule, 3, 0, 0.31088591926330060980, 0.11268792571801585080);
    AddPoints(rule, 3, 0, 0.09273525031089122640, 0.07349304311636194954);
    AddPoints(rule, 3, 1, 0.04550370412564964949, 0.04254602077708146644);
  } else {
    rule->points = e->points;
    memcpy(rule->point, e->point, sizeof(e->point));
    memcpy(rule->weight, e->weight, sizeof(e->weight));
  }
}

/* The product of the barycentric coordinates, 1 in the middle, with its derivatives */
static void BubbleShape(int dim, const double *xi, double *N, double dN[3])
{
  double L[4] = {1, 0, 0, 0};
  int    product;

  for (int k = 0; k < dim; k++) {
    L[0] -= xi[k];
    L[k + 1] = xi[k];
  }
  product = dim == 2 ? 27 : 256;
  *N      = product;
  for (int k = 0; k <= dim; k++) *N *= L[k];
  for (int k = 0; k < dim; k++) {
    double others = product;

    for (int l = 1; l <= dim; l++) others *= l == k + 1 ? 1 : L[l];
    dN[k] = others * (L[0] - L[k + 1]);
  }
}

static void CompleteRule(MixedRule *rule, const Element *e, int output)
{
  SetPoints(rule, e, output);
  for (int q = 0; q < rule->points; q++) {
    double dN[ELEMENT_MAX_NODES * 3];

    ElementShape(e->type, rule->point[q], rule->N[q], dN, NULL);
    for (int a = 0; a < e->nodes; a++) {
      for (int k = 0; k < e->dim; k++) rule->dN[q][a][k] = dN[a * e->dim + k];
    }
    if (e->nodes < ELEMENT_MAX_NODES) BubbleShape(e->dim, rule->point[q], &rule->N[q][e->nodes], rule->dN[q][e->nodes]);
  }
}

/*@
  MixedRuleGet - gives the integration rule of a mixed element.

  Not collective

  Input Parameters:
+ e      - the element
- output - 1: at the points of the element's own table, at which stresses are output; 0: those of the energy
@*/
const MixedRule *MixedRuleGet(const Element *e, int output)
{
  MixedRule *rule = output ? &output_rules[e->type] : &rules[e->type];

  if (!rule->points) CompleteRule(rule, e, output);
  return rule;
}
