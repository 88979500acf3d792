/* The mesh of a file of gmsh in plain arrays, of which each rank has a part. GmshAddPhysical(), GmshPhysicalIndex() and
   GmshSortPhysicals() serve for its groups. GmshJoin() makes nodes and elements of the portions that ranks have got of
   the file. GmshFreeElements() and GmshFreeBlocks() free elements, GmshReset() all arrays. */
#pragma once
#include "base/complaint.h"
#include "base/integerset.h"
#include "gmshportions.h"
#include "kernels/element.h"

enum { GMSH_POINT = 15 }; /* gmsh's type number of a point */

typedef struct {
  int      dim;
  PetscInt tag;
  char    *name; /* of a group without a name: its number */
} GmshPhysical;

/* The elements of one type on one geometric entity: how many there are, and those of this rank. The ranks have them in
   the order of the file. */
typedef struct {
  int            dim;
  const Element *element;                /* NULL: the elements are points */
  int            nodes;                  /* per element */
  PetscInt       n_all, first_tag;       /* number in the file, tag of the first one */
  PetscInt       n, *tag;                /* of this rank */
  PetscInt      *connectivity;           /* n*nodes places among all nodes by ascending tag, in gmsh's node order */
  int            n_physicals, *physical; /* indices into GmshMesh.physicals */
  /* For each group: -1 if the group names the entity with a minus sign, which reverses its normals. The node order of
     the elements is not changed. */
  int *sign;
} GmshBlock;

typedef struct {
  PetscInt      n_nodes, *node_tag; /* of this rank: ascending, and larger than those of lower ranks */
  PetscReal    *coords;             /* n_nodes*3 */
  PetscInt     *node_start;         /* for each rank, how many nodes lower ranks have; behind them the number of all */
  int           n_physicals;
  GmshPhysical *physicals; /* by descending dimension, then by tag; on the first rank only */
  int           n_blocks;
  GmshBlock    *blocks; /* those that belong to a physical group */
  char         *notes; /* on the first rank: lines of the file's comments that start with "note: ", without these words;
                          may be NULL */
} GmshMesh;

int            GmshPhysicalIndex(const GmshMesh *, int dim, PetscInt tag);
PetscErrorCode GmshAddPhysical(GmshMesh *, int dim, PetscInt tag, int *index);
PetscErrorCode GmshSortPhysicals(GmshMesh *);
PetscErrorCode GmshJoin(MPI_Comm, const char *file, Portions *, GmshMesh *, Complaint *);
PetscErrorCode GmshListNodes(const GmshMesh *, IntegerSet *);
PetscErrorCode GmshFreeElements(GmshBlock *);
PetscErrorCode GmshFreeBlocks(GmshMesh *);
PetscErrorCode GmshReset(GmshMesh *);
