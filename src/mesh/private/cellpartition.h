/* Decides which rank gets which cell before distribution. METIS partitions the graph of the cells if this is small.
   Otherwise each rank joins cells to clusters, METIS partitions their graph on the first rank, and the ranks refine the
   borders between parts cell by cell. So the first rank never has the graph of a large mesh. */
#pragma once
#include "cellgraph.h"

PetscErrorCode CellPartition(const CellGraph *, PetscMPIInt part[], Partition *);
