/* What results.vtkhdf holds, as far as the two views of it must know: results.xdmf (xdmf.h) and the VTKHDF part of the
   file (vtkhdf.h). Knows the datasets of the file (fields.h), no mesh and no model. */
#pragma once
#include "base/petsccompat.h"
#include "kernels/element.h"

enum { DATASET_PATH_SIZE = 512 /* characters of a path in results.vtkhdf */ };

/* Cells of one type, of a body or of a rigid tool. Of a body they are rows first to first + n - 1 of /mesh/cells_TYPE
   and the table /mesh/block_b, where b is the place in the list of blocks; of a tool the table /tools/NAME/cells. */
typedef struct {
  const char *name;   /* of the body or the tool */
  int         number; /* index into the scene's bodies; behind these come pairs with an analytic tool */
  PetscBool   tool;
  ElementType type;
  PetscInt    first, n;
  PetscInt    nodes; /* rows of its table of nodes: /mesh/nodes, or /tools/NAME/nodes */
} FieldsBlock;

/* A nodal array of the bodies: /steps/0000/NAME, of 1, 3 or 6 columns */
typedef struct {
  const char *name;
  int         width;
  int         kind; /* a step shows it where the bit of that number is set */
} FieldsArray;

typedef struct {
  const char        *name;
  PetscInt           nodes, n_steps;
  const PetscReal   *t;     /* of the steps */
  const PetscInt    *shows; /* of the steps: bits by kind */
  int                n_blocks, n_arrays;
  FieldsBlock       *blocks; /* the bodies' ones, then the tools' ones */
  const FieldsArray *arrays;
} FieldsIndex;

/* Type of the elements of all bodies; ELEMENT_TYPES where there are several */
static inline ElementType FieldsOneType(const FieldsIndex *index)
{
  for (int b = 1; b < index->n_blocks && !index->blocks[b].tool; b++)
    if (index->blocks[b].type != index->blocks[0].type) return ELEMENT_TYPES;
  return index->blocks[0].type;
}

/* The components of a symmetric tensor, in the order of its columns */
static const char *const TensorComponents[6] = {"xx", "yy", "zz", "xy", "yz", "xz"};
