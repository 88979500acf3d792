/* What rank 0 knows of the mesh before distribution: the bodies' cells and nodes, numbered by gmsh's tags and checked
   against the scene. On other ranks a pointer to a RootMesh is NULL. RootMeshRead() fills it; CellFacesCreate()
   and RootGroupsFind() add faces and groups. RootMeshFreeCells() frees cells and faces, RootMeshReset() all. */
#pragma once
#include "gmshfile.h"
#include "mesh/meshdata.h"

/* Most corners of a face of a cell: those of a quadrangle. */
enum { CELL_FACE_CORNERS = 4 };
/* Groups for which one integer has a bit. */
enum { ROOT_MARKS = 31 };

/* One element of a group of dimension dim - 1 that is a face of a cell. */
typedef struct {
  PetscInt cell, group, tag;
  int      number;
} RootFace;

/* One face of a cell: vertex numbers of its corners, ascending. */
typedef struct {
  PetscInt corner[CELL_FACE_CORNERS], cell;
  int      number;
} CellFace;

/* Cells and nodes are numbered by their ids, in the order of gmsh's tags. */
typedef struct {
  GmshMesh          gmsh;
  PetscInt          n_nodes, *node, *id; /* gmsh's node of each id; id of each gmsh node, -1: it belongs to no body */
  PetscInt          n_cells, *cell_item; /* place of each cell in its block */
  const GmshBlock **cell_block;
  int              *cell_body;
  PetscInt         *vertex; /* vertex number of each id, -1: it is no corner */
  PetscInt          n_vertices;
  PetscInt          n_faces, *face_ptr; /* start of each cell's faces in groups, from RootGroupsFind() */
  RootFace         *faces;
  /* For each vertex, the start of the cells' faces of which it is the lowest corner, from CellFacesCreate(). */
  PetscInt *corner_faces;
  CellFace *cell_faces;
  PetscInt *interior; /* for each group, faces between two cells */
  /* A bit for each group and id, from RootGroupsFind(): those of ROOT_MARKS groups are in marks[id], those of the next
     ones in marks[n_nodes + id]. */
  int *marks;
} RootMesh;

PetscErrorCode  RootMeshRead(Scene, const char *file, PetscMPIInt ranks, RootMesh *, Mesh, Complaint *);
PetscErrorCode  RootMeshFreeCells(RootMesh *);
PetscErrorCode  RootMeshReset(RootMesh *);
const PetscInt *RootMeshCellNodes(const RootMesh *, PetscInt cell);
void            RootMeshMark(RootMesh *, int group, PetscInt id);
int             RootMeshReversedNode(const Element *, int k);
