/* gmsh's .msh files (format 4.1, text and binary) as plain arrays, read by one rank. Knows nothing of scenes and
   bodies.

   An own reader instead of DMPlex's: it keeps gmsh's tags (the rank-independent keys), second-order nodes in gmsh's
   order, groups of every dimension, and says in words what is wrong with a file. */
#pragma once
#include "base/complaint.h"
#include "kernels/element.h"

typedef struct {
  int      dim;
  PetscInt tag;
  char    *name; /* a group without a name goes by its number */
} GmshPhysical;

/* The elements of one type on one geometric entity */
typedef struct {
  int            dim;
  const Element *element; /* NULL: points */
  int            nodes;   /* per element */
  PetscInt       n, *tag;
  PetscInt      *connectivity;           /* n*nodes indices into the node arrays, gmsh's node order */
  int            n_physicals, *physical; /* indices into GmshMesh.physicals */
  int *sign; /* -1: the group names the entity with a minus sign, which turns its normals over (the elements are not
                turned) */
} GmshBlock;

typedef struct {
  PetscInt      n_nodes, *node_tag; /* ascending */
  PetscReal    *coords;             /* n_nodes*3 */
  int           n_physicals;
  GmshPhysical *physicals; /* ordered by descending dimension, then tag */
  int           n_blocks;
  GmshBlock    *blocks; /* those that belong to a physical group */
} GmshMesh;

/* Reads a .msh file. Not collective. */
PetscErrorCode GmshRead(const char *file, GmshMesh *, Complaint *);
/* Frees what GmshRead() made. Not collective. */
PetscErrorCode GmshReset(GmshMesh *);
/* A whole file in memory, closed by a zero; *data NULL: it cannot be read. Not collective. */
PetscErrorCode GmshFileLoad(const char *file, char **data, size_t *size);
