/* Faces of all cells on rank 0, sorted by their corners, and the graph of cells that share faces. */
#include "cellfaces.h"

/* A corner that is off the plane of a face by less than this part of the face's size tells no side. */
#define CELL_FACE_FLAT 1e-6

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

/*@
  CellFacesFree - frees the list of faces.

  Not collective, on rank 0

  Input Parameter:
. root - may have no list
@*/
PetscErrorCode CellFacesFree(RootMesh *root)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(root->corner_faces));
  PetscCall(PetscFree(root->cell_faces));
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

/* On which side of a face with a normal through a place all other corners of a cell lie: 1, -1, or 0 where they lie on
   both. */
static int CellSide(const RootMesh *root, const CellFace *face, const PetscReal normal[3], const PetscReal place[3],
                    PetscReal flat)
{
  const Element  *e      = root->cell_block[face->cell]->element;
  const PetscInt *nodes  = RootMeshCellNodes(root, face->cell);
  PetscReal       lowest = PETSC_MAX_REAL, highest = PETSC_MIN_REAL;

  for (int a = 0; a < e->corners; a++) {
    PetscReal height = 0;
    PetscBool on     = PETSC_FALSE;

    for (int k = 0; k < CELL_FACE_CORNERS; k++)
      on = (PetscBool)(on || root->vertex[root->id[nodes[a]]] == face->corner[k]);
    if (on) continue;
    for (int d = 0; d < 3; d++) height += normal[d] * (root->gmsh.coords[3 * nodes[a] + d] - place[d]);
    lowest  = PetscMin(lowest, height);
    highest = PetscMax(highest, height);
  }
  return lowest > flat ? 1 : highest < -flat ? -1 : 0;
}

/* Mean place, normal and size of a face: in 2D across the edge, of a quadrangle across its diagonals. */
static void FacePlane(const RootMesh *root, const CellFace *face, PetscReal place[3], PetscReal normal[3],
                      PetscReal *size)
{
  const Element  *e                       = root->cell_block[face->cell]->element;
  const PetscInt *nodes                   = RootMeshCellNodes(root, face->cell);
  const int       corners                 = ElementGet((ElementType)e->face_type)->corners;
  PetscReal       x[CELL_FACE_CORNERS][3] = {{0}}, a[3], b[3] = {0, 0, 1}, square = 0, length = 0;

  for (int d = 0; d < 3; d++) {
    place[d] = 0;
    for (int k = 0; k < corners; k++) {
      x[k][d] = root->gmsh.coords[3 * nodes[e->face_nodes[face->number][k]] + d];
      place[d] += x[k][d] / corners;
    }
    a[d] = x[corners == 4 ? 2 : 1][d] - x[0][d];
    if (corners > 2) b[d] = x[corners == 4 ? 3 : 2][d] - x[corners == 4 ? 1 : 0][d];
    square += PetscSqr(a[d]);
  }
  for (int d = 0; d < 3; d++) {
    normal[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
    length += PetscSqr(normal[d]);
  }
  for (int d = 0; d < 3 && length > 0; d++) normal[d] /= PetscSqrtReal(length);
  *size = PetscSqrtReal(square);
}

/*@
  CellFacesCheck - complains of a body that is meshed twice somewhere: two of its cells lie on the same side of a face
  that they share.

  Not collective, on rank 0

  Input Parameters:
+ scene - the scene
. file  - the mesh file, for the message
- root  - after CellFacesCreate()

  Output Parameter:
. complaint - what is wrong

  Note:
  Both cells would carry load, so that the body would be twice as stiff there, and it would have no skin.
@*/
void CellFacesCheck(Scene scene, const char *file, const RootMesh *root, Complaint *complaint)
{
  const CellFace *end = root->cell_faces + root->corner_faces[root->n_vertices];
  PetscReal       place[3], normal[3], again[3], size;

  for (const CellFace *face = root->cell_faces; face + 1 < end; face++) {
    const PetscInt cell = face->cell, other = face[1].cell;
    int            side;

    if (CompareCorners(face->corner, face[1].corner) || root->cell_body[cell] != root->cell_body[other]) continue;
    FacePlane(root, &face[1], place, again, &size);
    FacePlane(root, face, place, normal, &size);
    /* Cells beside each other go round their face in opposite ways, also where one of them is inverted. */
    if (normal[0] * again[0] + normal[1] * again[1] + normal[2] * again[2] <= 0) continue;
    side = CellSide(root, face, normal, place, CELL_FACE_FLAT * size);
    if (side == 0 || side != CellSide(root, &face[1], normal, place, CELL_FACE_FLAT * size)) continue;
    Complain(complaint,
             "%s: cells %" PetscInt_FMT " and %" PetscInt_FMT
             " of '%s' lie on the same side of the face between them, at (%g, %g, %g): the body is meshed twice there; "
             "name each of its parts once",
             file, root->cell_block[cell]->tag[root->cell_item[cell]],
             root->cell_block[other]->tag[root->cell_item[other]], scene->bodies[root->cell_body[cell]].name, place[0],
             place[1], place[2]);
    return;
  }
}
