/* Splits faces of a rigid tool at the middles of edges. ToolSplitClose() completes the marks, ToolSplit() makes the new
   faces in the place of the old ones. A middle is in the middle of the edge itself, so that no point of the surface
   moves. */
#pragma once
#include "tooledges.h"

/* What an edge was before a split: an edge, or the half of it at one of its corners. */
typedef struct {
  PetscInt edge; /* -1: it is new */
  int      end;  /* the half at corner[end] of that edge; -1: the whole edge */
  PetscInt node; /* the node there */
} ToolOrigin;

PetscErrorCode ToolSplitClose(const MeshRigid *, const ToolEdges *, PetscBool *marked);
PetscErrorCode ToolSplit(const ToolEdges *, const PetscBool *marked, PetscInt *node_tag, PetscInt *face_tag,
                         MeshRigid *, ToolOrigin **);
