/* Blocks of neighbouring faces with boxes around them. What lies far from a box is then left out block by block, and a
   search costs what is near and not what there is.

   FaceBlocksCreate() sorts faces into blocks by where they are in the reference position. FaceBlocksPlace() moves the
   boxes with the nodes. Faces of a rigid tool keep the boxes that they have in the tool's own frame. FaceBlocksNear()
   collects the faces of all blocks whose boxes come near a box. */
#pragma once
#include "mesh/mesh.h"
#include "smooth/facet.h"

typedef struct {
  int        dim;
  PetscInt   n, n_faces, *face; /* blocks; faces, block after block */
  PetscInt  *node_ptr, *node;   /* nodes of each block, each once */
  PetscReal *box;               /* of each block, lower then upper corner */
} *FaceBlocks;

PetscErrorCode FaceBlocksCreate(int dim, PetscInt n_faces, const Facet *faces, const PetscReal *X, FaceBlocks *);
PetscErrorCode FaceBlocksDestroy(FaceBlocks *);
void           FaceBlocksPlace(FaceBlocks, const PetscReal *X, const PetscReal *u);
PetscInt       FaceBlocksEnd(FaceBlocks, PetscInt block);
PetscInt       FaceBlocksFirst(PetscInt block);
PetscInt       FaceBlocksNear(FaceBlocks, const PetscReal box[6], PetscBool *taken, PetscInt *faces);
