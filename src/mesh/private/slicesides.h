/* What nodes know of the faces of groups around them, before distribution.

   SliceSidesGather() brings it to the homes of the nodes, one record for each node of each face, in the same order on
   any number of ranks. SliceFaceNormal() gives centre and normal of a face. */
#pragma once
#include "slicemesh.h"

/* A face at one of its nodes: its normal out of the cell there, times area over reference area, and the way from the
   node to the centre of its corners. */
typedef struct {
  PetscInt  id, group;
  PetscReal normal[3], way[3];
} NodeSide;

PetscErrorCode SliceSidesGather(const SliceMesh *, const PetscBool *groups, PetscInt *n, NodeSide **);
void           SliceFaceNormal(const SliceMesh *, const SliceFace *, PetscReal centre[3], PetscReal normal[3]);
