/* Integration rules of mixed elements, with the shape functions of the nodes and, in tri6 and tet10, of an inner node.
   MixedRuleGet() gives the one of an element. Plain C. */
#pragma once
#include "kernels/element.h"

/* Points of an integration rule, with the shape functions of the nodes and of the inner node, which is the last. */
typedef struct {
  int    points;
  double point[ELEMENT_MAX_POINTS][3], weight[ELEMENT_MAX_POINTS];
  double N[ELEMENT_MAX_POINTS][ELEMENT_MAX_NODES], dN[ELEMENT_MAX_POINTS][ELEMENT_MAX_NODES][3];
} MixedRule;

const MixedRule *MixedRuleGet(const Element *, int output);
