/* Quadrature points of faces as fixed combinations of nodes, those of the face and those around it: x = sum S (image of
   x_node). So a point may lie off its face, where the surface through the nodes around is (offset.h), and follow them.
 */
#pragma once
#include "search/facerecord.h"

typedef struct {
  NodeKey node;
  int     image;               /* which mirror image of the node (SurfaceImage) */
  double  S[FACE_RULE_POINTS]; /* its share in each of the face's points */
} FaceMapEntry;

/* Maps of some faces; ptr NULL: there are none, the faces' shape functions serve */
typedef struct {
  PetscInt n, *ptr; /* faces; entries of face f are ptr[f] to ptr[f + 1] - 1, first its own nodes, in their order */
  FaceMapEntry *entry;
} FaceMaps;

/* Maps of faces that live on other ranks. faces: roots are those of home, leaves those of *maps. Collective. */
PetscErrorCode FaceMapsFetch(PetscSF faces, const FaceMaps *home, FaceMaps *maps);
PetscErrorCode FaceMapsDestroy(FaceMaps *);
/* The part of a point's position that stands still: what the shifts of its nodes' images sum up to. shift[dim] */
void FaceMapShift(const FaceMaps *, PetscInt face, int point, int dim, const SurfaceImage *, PetscReal *shift);
