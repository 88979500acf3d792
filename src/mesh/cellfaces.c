/* Faces of all cells on rank 0, sorted by their corners, and the graph of cells that share faces. */
#include "cellfaces.h"

/* Sorts the corners in ascending order and fills up with PETSC_MAX_INT where there are fewer. */
static void SortCorners(int n, const PetscInt vertices[], PetscInt corner[CELL_FACE_CORNERS])
{
  for (int k = 0; k < CELL_FACE_CORNERS; k++) {
    const PetscInt vertex = k < n ? vertices[k] : PETSC_MAX_INT;
    int            place  = k;

    for (; place > 0 && corner[place - 1] > vertex; place--) corner[place] = corner[place - 1];
    corner[place] = vertex;
  }
}

static int CompareCorners(const PetscInt a[], const PetscInt b[])
{
  for (int k = 0; k < CELL_FACE_CORNERS; k++)
    if (a[k] != b[k]) return a[k] < b[k] ? -1 : 1;
  return 0;
}

static void LoadFace(const RootMesh *root, PetscInt c, int number, CellFace *face)
{
  const Element  *element = root->cell_block[c]->element;
  const PetscInt *nodes   = RootMeshCellNodes(root, c);
  const int       corners = ElementGet((ElementType)element->face_type)->corners;
  PetscInt        vertices[CELL_FACE_CORNERS];

  for (int k = 0; k < corners; k++) vertices[k] = root->vertex[root->id[nodes[element->face_nodes[number][k]]]];
  face->cell   = c;
  face->number = number;
  SortCorners(corners, vertices, face->corner);
}

/* Sorts faces that have the same lowest corner by their other corners. Faces with equal corners keep the order of their
   cells. A corner has few faces, so they are sorted by insertion. */
static void SortCellFaces(PetscInt n, CellFace faces[])
{
  for (PetscInt f = 1; f < n; f++) {
    const CellFace face  = faces[f];
    PetscInt       place = f;

    for (; place > 0 && CompareCorners(faces[place - 1].corner, face.corner) > 0; place--)
      faces[place] = faces[place - 1];
    faces[place] = face;
  }
}

/*@
  CellFacesCreate - lists the faces of all cells.

  Not collective, on rank 0

  Input Parameter:
. root - after RootMeshRead()

  Output Parameter:
. root - cell_faces has each face once for each cell that has it; faces whose lowest corner is vertex v start at
  corner_faces[v], and equal faces are adjacent

  Note:
  DMPlexInterpolate() would give the same information, but takes twenty times as long and makes edges and orientations
  that are not needed.
@*/
PetscErrorCode CellFacesCreate(RootMesh *root)
{
  PetscInt *next;
  CellFace  face;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(root->n_vertices + 1, &root->corner_faces));
  PetscCall(PetscMalloc1(root->n_vertices + 1, &next));
  for (PetscInt c = 0; c < root->n_cells; c++) {
    for (int f = 0; f < root->cell_block[c]->element->faces; f++) {
      LoadFace(root, c, f, &face);
      root->corner_faces[face.corner[0] + 1]++;
    }
  }
  for (PetscInt v = 0; v < root->n_vertices; v++) root->corner_faces[v + 1] += root->corner_faces[v];
  PetscCall(PetscArraycpy(next, root->corner_faces, root->n_vertices + 1));
  PetscCall(PetscMalloc1(root->corner_faces[root->n_vertices], &root->cell_faces));
  for (PetscInt c = 0; c < root->n_cells; c++) {
    for (int f = 0; f < root->cell_block[c]->element->faces; f++) {
      LoadFace(root, c, f, &face);
      root->cell_faces[next[face.corner[0]]++] = face;
    }
  }
  for (PetscInt v = 0; v < root->n_vertices; v++)
    SortCellFaces(root->corner_faces[v + 1] - root->corner_faces[v], &root->cell_faces[root->corner_faces[v]]);
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts the cells that have the same face as the first of these. */
static PetscInt CountSame(const CellFace face[], const CellFace *end)
{
  PetscInt n = 1;

  while (face + n < end && !CompareCorners(face[n].corner, face->corner)) n++;
  return n;
}

/*@
  CellFacesFind - finds the cells that have a face.

  Not collective, on rank 0

  Input Parameters:
+ root     - after CellFacesCreate()
. n        - number of corners
- vertices - vertex numbers of the corners, in any order; -1: not a corner of a cell

  Output Parameter:
. face - the face of the first cell, followed by those of the other cells, by ascending cell; NULL if there is none

  Note:
  Returns the number of cells that have the face.
@*/
PetscInt CellFacesFind(const RootMesh *root, int n, const PetscInt vertices[], const CellFace **face)
{
  PetscInt corner[CELL_FACE_CORNERS];

  *face = NULL;
  if (n > CELL_FACE_CORNERS) return 0;
  SortCorners(n, vertices, corner);
  if (corner[0] < 0) return 0;
  for (PetscInt f = root->corner_faces[corner[0]]; f < root->corner_faces[corner[0] + 1]; f++) {
    if (CompareCorners(root->cell_faces[f].corner, corner)) continue;
    *face = &root->cell_faces[f];
    return CountSame(*face, &root->cell_faces[root->corner_faces[corner[0] + 1]]);
  }
  return 0;
}

/*@
  CellFacesNeighbours - computes the graph of cells that share faces.

  Not collective, on rank 0

  Input Parameter:
. root - after CellFacesCreate()

  Output Parameters:
+ offsets   - start of each cell's neighbours in adjacency [n_cells + 1]
- adjacency - neighbours across faces

  Note:
  The caller frees both arrays with PetscFree().
@*/
PetscErrorCode CellFacesNeighbours(const RootMesh *root, PetscInt **offsets, PetscInt **adjacency)
{
  const CellFace *end = root->cell_faces + root->corner_faces[root->n_vertices];
  PetscInt        same, *next;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(root->n_cells + 1, offsets));
  PetscCall(PetscMalloc1(root->n_cells, &next));
  for (const CellFace *face = root->cell_faces; face < end; face += same) {
    same = CountSame(face, end);
    for (PetscInt i = 0; i < same; i++) (*offsets)[face[i].cell + 1] += same - 1;
  }
  for (PetscInt c = 0; c < root->n_cells; c++) (*offsets)[c + 1] += (*offsets)[c];
  PetscCall(PetscMalloc1((*offsets)[root->n_cells], adjacency));
  PetscCall(PetscArraycpy(next, *offsets, root->n_cells));
  for (const CellFace *face = root->cell_faces; face < end; face += same) {
    same = CountSame(face, end);
    for (PetscInt i = 0; i < same; i++)
      for (PetscInt k = 0; k < same; k++)
        if (k != i) (*adjacency)[next[face[i].cell]++] = face[k].cell;
  }
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}
