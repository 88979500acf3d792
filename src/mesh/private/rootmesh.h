/* What rank 0 knows of the mesh before it is distributed: the bodies' cells and nodes, numbered by gmsh's tags and
   checked against the scene. Elsewhere a RootMesh pointer is NULL. */
#pragma once
#include "gmshfile.h"
#include "mesh/meshdata.h"

/* One element of a dim - 1 group that is a face of a cell */
typedef struct {
  PetscInt cell, group, tag;
  int      number;
} RootFace;

enum { CELL_FACE_CORNERS = 4 };

/* One face of a cell: its corners' vertex numbers, ascending */
typedef struct {
  PetscInt corner[CELL_FACE_CORNERS], cell;
  int      number;
} CellFace;

/* Cells and nodes go by their ids: the order of gmsh's tags. */
typedef struct {
  GmshMesh          gmsh;
  PetscInt          n_nodes, *node, *id; /* id -> gmsh's node, and back (-1: not a body's) */
  PetscInt          n_cells, *cell_item; /* cell: item of a block */
  const GmshBlock **cell_block;
  int              *cell_body;
  PetscInt         *vertex;             /* id -> vertex number, -1: no corner */
  PetscInt          n_vertices, *point; /* id -> Plex point; by RootTopologyPlaceNodes() */
  PetscInt          n_faces, *face_ptr; /* cell -> its faces in groups; by RootGroupsFind() */
  RootFace         *faces;
  PetscInt *corner_faces; /* vertex -> the cells' faces of which it is the lowest corner; by CellFacesCreate() */
  CellFace *cell_faces;
  PetscInt *interior; /* per group: faces between two cells */
} RootMesh;

/* Reads and checks the file; the mesh gets its order and the bodies' box. To be reset also after a complaint. Not
 * collective. */
PetscErrorCode RootMeshRead(Scene, const char *file, PetscMPIInt ranks, RootMesh *, Mesh, Complaint *);
/* Frees all of it. Not collective. */
PetscErrorCode RootMeshReset(RootMesh *);
/* The cell's nodes as indices of gmsh's, in gmsh's order */
const PetscInt *RootMeshCellNodes(const RootMesh *, PetscInt cell);
