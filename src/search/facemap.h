/* Quadrature points of faces as fixed combinations of nodes, both of the nodes of the face and of nodes around it: x =
   sum S (image of x_node). So a point may lie off its face, on the surface through the nodes around it (offset.h), and
   follow these nodes.

   FaceMapsFetch() brings the maps of faces from the ranks where the faces live, and FaceMapsDestroy() frees them.
   FaceMapShift() gives the constant part of a point's position. */
#pragma once
#include "search/facerecord.h"

typedef struct {
  NodeKey node;
  int     image;               /* mirror image of the node (SurfaceImage) */
  double  S[FACE_RULE_POINTS]; /* share of the node in each of the face's points */
} FaceMapEntry;

/* Maps of some faces. If ptr is NULL, there are no maps, and the shape functions of the faces are used. */
typedef struct {
  /* n: number of faces. The entries of face f are ptr[f] to ptr[f + 1] - 1; its own nodes come first, in their
     order. */
  PetscInt      n, *ptr;
  FaceMapEntry *entry;
} FaceMaps;

PetscErrorCode FaceMapsFetch(PetscSF faces, const FaceMaps *home, FaceMaps *maps);
PetscErrorCode FaceMapsDestroy(FaceMaps *);
void FaceMapShift(const FaceMaps *, PetscInt face, int point, int dim, const SurfaceImage *, PetscReal *shift);
