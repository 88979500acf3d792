/* Reads gmsh's .msh files (format 4.1, text and binary) into plain arrays on one rank. It knows nothing of scenes and
   bodies. GmshRead() reads a file, GmshFreeBlocks() frees the elements, GmshReset() all arrays. GmshFileLoad() loads
   any file as text.

   DMPlex's reader is not used, because this one keeps gmsh's tags, which are the keys that do not depend on the number
   of ranks, keeps second-order nodes in gmsh's order, reads groups of every dimension, and describes what is wrong with
   a file. */
#pragma once
#include "base/complaint.h"
#include "kernels/element.h"

typedef struct {
  int      dim;
  PetscInt tag;
  char    *name; /* of a group without a name: its number */
} GmshPhysical;

/* The elements of one type on one geometric entity. */
typedef struct {
  int            dim;
  const Element *element; /* NULL: the elements are points */
  int            nodes;   /* per element */
  PetscInt       n, *tag;
  PetscInt      *connectivity;           /* n*nodes indices into the node arrays, in gmsh's node order */
  int            n_physicals, *physical; /* indices into GmshMesh.physicals */
  /* For each group: -1 if the group names the entity with a minus sign, which reverses its normals. The node order of
     the elements is not changed. */
  int *sign;
} GmshBlock;

typedef struct {
  PetscInt      n_nodes, *node_tag; /* ascending */
  PetscReal    *coords;             /* n_nodes*3 */
  int           n_physicals;
  GmshPhysical *physicals; /* by descending dimension, then by tag */
  int           n_blocks;
  GmshBlock    *blocks; /* those that belong to a physical group */
  char         *notes;  /* lines of the file's comments that start with "note: ", without these words; may be NULL */
} GmshMesh;

PetscErrorCode GmshRead(const char *file, GmshMesh *, Complaint *);
PetscErrorCode GmshFreeBlocks(GmshMesh *);
PetscErrorCode GmshReset(GmshMesh *);
PetscErrorCode GmshFileLoad(const char *file, char **data, size_t *size);
