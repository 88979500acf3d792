/* Nodes for the pressures of mixed triangles and tetrahedra. Where a body has such cells, every node of the mesh's
   cells has a second one in the same place. One of its displacements stands for the pressure if it is a corner of
   such a cell (kernels/nodalpressurekernel.c), and supports hold the rest. Pressures jump between bodies of different
   materials, which take different displacements where they share nodes. These nodes follow those of the cells in the
   same order and belong to the same ranks. PressureNodesExist() finds out whether a mesh needs them,
   PressureNodesConstrain() holds what is no unknown, PressureNodeOf() and IsPressureNode() tell which they are. */
#pragma once
#include "mesh/meshdata.h"

PetscBool      CellHasPressureNodes(Mesh, Scene, PetscInt cell);
PetscErrorCode PressureNodesConstrain(Mesh, Scene, PetscBool *constrained);

/* The node for the pressure of a node of the cells, in a mesh that has such nodes */
static inline PetscInt PressureNodeOf(Mesh mesh, PetscInt node)
{
  return mesh->n_body_nodes + node;
}

static inline PetscBool IsPressureNode(Mesh mesh, PetscInt node)
{
  return (PetscBool)(node >= mesh->n_body_nodes && node < mesh->n_body_nodes + mesh->n_pressure_nodes);
}
