/* The order in which a sparse matrix is eliminated: nested dissection by METIS. METIS gets the graph of the matrix's
   nodes, not that of its rows. Call OrderingFind() once for each new pattern. */
#pragma once
#include "base/petsccompat.h"

PetscErrorCode OrderingFind(Mat A, PetscInt **position);
