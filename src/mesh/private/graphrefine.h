/* Better borders between the parts of a partition of clusters: GraphRefine() moves single cells. */
#pragma once
#include "cellgraph.h"

PetscErrorCode GraphRefine(const CellGraph *, PetscInt parts, PetscInt part[]);
