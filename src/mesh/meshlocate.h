/* Which points lie in a body, and in which of its cells. MeshPointsInBody() and MeshLocatePoint() ask the cells of all
   ranks. */
#pragma once
#include "kernels/element.h"
#include "mesh/meshdata.h"

/* A point in a cell */
typedef struct {
  PetscInt  cell;                 /* number on this rank; -1: another rank has it, or none */
  PetscReal N[ELEMENT_MAX_NODES]; /* shape functions of the cell's nodes there (no unit) */
} CellPlace;

PetscErrorCode MeshPointsInBody(Mesh, int body, double core, PetscInt n, const PetscReal *x, PetscBool *inside);
PetscErrorCode MeshLocatePoint(Mesh, int body, const PetscReal *x, CellPlace *, PetscReal *outside);
