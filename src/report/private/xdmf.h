/* results.xdmf: the text through which ParaView reads results.h5. XdmfWrite() writes it anew for all steps so far.
   Knows the datasets of the file (fields.h), no mesh and no model. */
#pragma once
#include "base/petsccompat.h"
#include "kernels/element.h"

/* Cells of one body and type: rows first to first + n - 1 of /mesh/cells_TYPE. Block b is also a table of its own,
   /mesh/block_b. */
typedef struct {
  const char *body;
  ElementType type;
  PetscInt    first, n;
} XdmfBlock;

/* A nodal array that ParaView shows: from /steps/0000/NAME, of 1, 3 or 6 columns */
typedef struct {
  const char *name;
  int         width;
  int         kind; /* a step shows it where the bit of that number is set */
} XdmfArray;

typedef struct {
  const char      *name;
  PetscInt         nodes, n_steps;
  const PetscReal *t;     /* of the steps */
  const PetscInt  *shows; /* of the steps: bits by kind */
  int              n_blocks, n_arrays;
  XdmfBlock       *blocks;
  const XdmfArray *arrays;
} Xdmf;

PetscErrorCode XdmfWrite(const Xdmf *, const char *directory);
