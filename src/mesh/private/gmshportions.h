/* The portions of a mesh file that ranks keep: the first rank reads nodes and elements one by one, and each rank gets
   those of a range of places in the file. So no rank holds them all.

   The first rank calls PortionsNodes(), then PortionsTag() and PortionsPlace() for each node, PortionsElements(), for
   each block PortionsBlock() and then PortionsElement() for each of its elements, and PortionsEnd(). The others call
   PortionsReceive(), which returns at PortionsEnd(). PortionsReset() frees what is left. */
#pragma once
#include "base/petsccompat.h"

/* The elements of one block that a rank keeps: tags [n] and tags of nodes [n*nodes]. */
typedef struct {
  int      nodes;
  PetscInt n, *tag, *connectivity;
} PortionBlock;

typedef struct {
  /* What this rank keeps */
  PetscInt      n_tags, n_places, *node_tag;
  PetscReal    *coords;         /* 3*n_places */
  int           n_blocks, room; /* room: for so many blocks */
  PortionBlock *blocks;
  /* What is sent next, on the first rank */
  MPI_Comm    comm;
  PetscMPIInt rank, size, to;
  int         kind, block, width; /* width: values of an item */
  PetscInt    n_all;              /* nodes or elements of the file */
  PetscInt    at;                 /* how many of them came before */
  PetscInt    first, n_block;     /* the block of elements */
  PetscInt    n, *values;         /* items */
  PetscReal  *places;
} Portions;

PetscErrorCode PortionsCreate(MPI_Comm, Portions *);
PetscErrorCode PortionsNodes(Portions *, PetscInt n);
PetscErrorCode PortionsTag(Portions *, PetscInt i, PetscInt tag);
PetscErrorCode PortionsPlace(Portions *, PetscInt i, const PetscReal x[3]);
PetscErrorCode PortionsElements(Portions *, PetscInt n);
PetscErrorCode PortionsBlock(Portions *, int nodes, PetscInt n);
PetscErrorCode PortionsElement(Portions *, PetscInt tag, const PetscInt nodes[]);
PetscErrorCode PortionsEnd(Portions *);
PetscErrorCode PortionsReceive(Portions *);
PetscErrorCode PortionsReset(Portions *);
