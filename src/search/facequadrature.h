/* Quadrature on the faces of a contact surface, and the positive hat functions by which surface contact weighs its
   slave nodes. Plain C.

   FaceRuleGet() returns the rule of a type of face; the rule is finer than that of the elements if this is asked
   for. FaceRuleWithEnds() returns one whose outer points lie on the edges and corners of the face; FaceRuleOf()
   chooses between the two. FaceRuleAreas() computes the areas and normals of the rule's points on a given face.
   FaceHat() evaluates the hat functions, FaceHatAround() stands for them at the element's own quadrature points. */
#pragma once
#include "kernels/element.h"
#include "scene/scene.h"

enum { FACE_RULE_POINTS = 16 };

/* How fine a rule is: plain, of one order more, and the finest: this one on each half of an edge, and of one order more
   still on a first-order face that is no edge. */
enum { FACE_RULE_PLAIN, FACE_RULE_FINER, FACE_RULE_FINEST, FACE_RULES };

typedef struct {
  int    n;
  double xi[FACE_RULE_POINTS][2], weight[FACE_RULE_POINTS];
  double N[FACE_RULE_POINTS][FACE_MAX_NODES],
    dN[FACE_RULE_POINTS][FACE_MAX_NODES][2];    /* shape functions and their derivatives */
  double hat[FACE_RULE_POINTS][FACE_MAX_NODES]; /* of FaceHat() */
  int    edges[FACE_RULE_POINTS];               /* bit e: the point lies on edge e of the face, in 2D on its end e */
} FaceRule;

const FaceRule *FaceRuleGet(ElementType, int finer);
const FaceRule *FaceRuleWithEnds(ElementType, int finer);
const FaceRule *FaceRuleOf(ElementType, int finer, int ends);
void            FaceHat(ElementType, const double *xi, double *psi);
void            FaceHatAround(ElementType, int point, int finer, double *psi);
void FaceRuleAreas(const FaceRule *, ElementType, int dim, Geometry, const double *X, double *area, double *normal);
