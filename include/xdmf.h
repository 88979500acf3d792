/* results.xdmf: the text through which ParaView reads results.h5. Knows the file's datasets (fields.h), no mesh and no model. */
#pragma once
#include "petsccompat.h"
#include "element.h"

/* Cells of one body and type: rows first .. first+n-1 of the total of /mesh/cells_TYPE */
typedef struct {
  const char *body;
  ElementType type;
  PetscInt    first, n, total;
} XdmfBlock;

/* A nodal array that ParaView shows: from /steps/0000/DATASET, of `width` columns */
typedef struct {
  const char *title, *dataset;
  int         width, column; /* column -1: all of them, as a vector or a scalar */
  int         kind;          /* a step shows it where the bit of that number is set */
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

/* Writes the text for all steps so far into a directory, whole or not at all. Not collective: for one rank. */
PetscErrorCode XdmfWrite(const Xdmf *, const char *directory);
