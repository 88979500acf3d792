/* Quadrature on the faces of a contact surface, finer than that of the elements where asked, and the positive hat
   functions by which surface contact weighs its slave nodes. Plain C. */
#pragma once
#include "kernels/element.h"
#include "scene/scene.h"

enum { FACE_RULE_POINTS = 16 };

typedef struct {
  int    n;
  double xi[FACE_RULE_POINTS][2], weight[FACE_RULE_POINTS];
  double N[FACE_RULE_POINTS][FACE_MAX_NODES],
    dN[FACE_RULE_POINTS][FACE_MAX_NODES][2];    /* shape functions and their derivatives */
  double hat[FACE_RULE_POINTS][FACE_MAX_NODES]; /* FaceHat() */
} FaceRule;

/* The rule of a face type; finer: one order more. EDGE2 3 | 4 points, EDGE3 4 | 5, TRI3 3 | 6, TRI6 6 | 12, QUAD4 4 |
 * 9, QUAD9 9 | 16. */
const FaceRule *FaceRuleGet(ElementType, int finer);
/* Positive functions of sum 1: first order the shape functions, second order linear on the face split at its mid-side
 * nodes. psi[nodes] */
void FaceHat(ElementType, const double *xi, double *psi);
/* Area weights of the rule's points (axisymmetric: 2 pi R) on a face with nodes X[nodes][dim], and unit normals [n][3]
 * (may be NULL) */
void FaceRuleAreas(const FaceRule *, ElementType, int dim, Geometry, const double *X, double *area, double *normal);
