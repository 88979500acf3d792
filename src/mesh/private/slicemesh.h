/* A rank's slice of the mesh before distribution: bodies' cells and nodes, numbered by gmsh's tags and checked against
   the scene. Cells and nodes are shared out evenly by their tags, so that no rank knows the whole mesh. A cell is in
   the slice of one rank, which knows its nodes too. Each node has a home, the rank to whose part of gmsh's nodes it
   belongs, where things that several slices know of it meet.

   SliceRead() fills it; CellFacesCreate() and SliceGroupsFind() add faces and groups. SliceMeshFreeCells() frees cells
   and faces, SliceMeshReset() all. */
#pragma once
#include "gmshmesh.h"
#include "mesh/meshdata.h"

/* Most corners of a face of a cell: those of a quadrangle. */
enum { CELL_FACE_CORNERS = 4 };
/* Most faces of a cell. */
enum { SLICE_CELL_FACES = 6 };
/* Groups for which one integer has a bit. */
enum { SLICE_MARKS = 31 };

/* One element of a group of dimension dim - 1 that is a face of a cell. */
typedef struct {
  PetscInt cell, group, tag; /* cell: its id */
  PetscInt order;            /* its place among the elements of all groups in the file */
  int      number;
} SliceFace;

/* One face of a cell, on the rank that has its lowest corner: ids of its corners, ascending, and of the cell. */
typedef struct {
  PetscInt    corner[CELL_FACE_CORNERS], cell;
  int         body;
  signed char number;
  signed char side;  /* of the face on which the cell's other corners are: 1 where its normal points, -1, or 0: both */
  signed char sense; /* in which way the cell goes round the corners, 1 or -1 */
} CellFace;

/* Cells and nodes are numbered by their ids, in the order of gmsh's tags. */
typedef struct {
  MPI_Comm    comm;
  PetscMPIInt rank, size;
  GmshMesh    gmsh; /* its elements are those of lower dimension than the bodies', after SliceRead() */
  /* Nodes of cells whose home is this rank: their ids follow on home_start[rank]. */
  PetscInt  n_homes, *home; /* place among this rank's part of gmsh's nodes */
  PetscInt *home_start;     /* first id of each rank, and the number of all nodes */
  /* The cells of this slice: their ids follow on cell_start[rank]. */
  PetscInt          n_cells, *cell_start; /* first id of each rank, and the number of all cells */
  const GmshBlock **cell_block;
  int              *cell_body;
  PetscInt         *cell_tag, *cell_nodes; /* numbers of nodes in this slice, width for each cell */
  int               width;
  PetscInt          n_nodes, *id; /* of the nodes of these cells, ascending */
  PetscReal        *coords;       /* n_nodes*3 */
  PetscInt        **element_ids;  /* for each block of lower dimension, ids of its elements' nodes, -1: of no body */
  PetscInt          n_faces, *face_ptr; /* start of each cell's faces in groups, from SliceGroupsFind() */
  SliceFace        *faces;
  /* From CellFacesCreate(): ranges of lowest corners of faces, by the first id of each rank, the number of ids of this
     rank's range, and for each of them the start of its faces. */
  PetscInt *face_start, n_corners, *corner_faces;
  CellFace *cell_faces;
  PetscInt *interior; /* for each group, faces between two cells */
  /* A bit for each group and node of this home, from SliceGroupsFind(): those of SLICE_MARKS groups are in marks[i],
     those of the next ones in marks[n_homes + i]. */
  int *marks;
} SliceMesh;

PetscErrorCode  SliceMeshFreeCells(SliceMesh *);
PetscErrorCode  SliceMeshReset(SliceMesh *);
const PetscInt *SliceMeshCellNodes(const SliceMesh *, PetscInt cell);
PetscMPIInt     SliceMeshRankOf(const SliceMesh *, const PetscInt start[], PetscInt id);
PetscErrorCode  SliceMeshSF(const SliceMesh *, const PetscInt start[], PetscInt n, const PetscInt ids[], PetscSF *);
void            SliceMeshPackFace(const void *faces, PetscInt i, void *packed);
int             SliceMeshReversedNode(const Element *, int k);
