/* Faces of all cells, shared out and sorted by their corners, and the graph of cells that share faces. */
#include "cellfaces.h"
#include "base/exchange.h"
#include "tagranges.h"

/* A corner that is off the plane of a face by less than this part of the face's size tells no side. */
#define CELL_FACE_FLAT 1e-6

/*@
  CellFacesSortCorners - sorts the corners of a face in ascending order and fills up with PETSC_MAX_INT where there are
  fewer than the most.

  Not collective

  Input Parameters:
+ n   - number of corners
- ids - of the corners

  Output Parameter:
. corner - sorted
@*/
void CellFacesSortCorners(int n, const PetscInt ids[], PetscInt corner[CELL_FACE_CORNERS])
{
  for (int k = 0; k < CELL_FACE_CORNERS; k++) {
    const PetscInt id    = k < n ? ids[k] : PETSC_MAX_INT;
    int            place = k;

    for (; place > 0 && corner[place - 1] > id; place--) corner[place] = corner[place - 1];
    corner[place] = id;
  }
}

static int CompareCorners(const PetscInt a[], const PetscInt b[])
{
  for (int k = 0; k < CELL_FACE_CORNERS; k++)
    if (a[k] != b[k]) return a[k] < b[k] ? -1 : 1;
  return 0;
}

/* Mean place, normal and size of a face: in 2D across the edge, of a quadrangle across its diagonals. */
static void FacePlane(const SliceMesh *slice, PetscInt cell, int number, PetscReal place[3], PetscReal normal[3],
                      PetscReal *size)
{
  const Element  *e                       = slice->cell_block[cell]->element;
  const PetscInt *nodes                   = SliceMeshCellNodes(slice, cell);
  const int       corners                 = ElementGet((ElementType)e->face_type)->corners;
  PetscReal       x[CELL_FACE_CORNERS][3] = {{0}}, a[3], b[3] = {0, 0, 1}, square = 0, length = 0;

  for (int d = 0; d < 3; d++) {
    place[d] = 0;
    for (int k = 0; k < corners; k++) {
      x[k][d] = slice->coords[3 * nodes[e->face_nodes[number][k]] + d];
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

/* On which side of a face all other corners of its cell lie: 1 where the face's normal points, -1, or 0 where they lie
   on both. */
static int CellSide(const SliceMesh *slice, PetscInt cell, int number)
{
  const Element  *e       = slice->cell_block[cell]->element;
  const PetscInt *nodes   = SliceMeshCellNodes(slice, cell);
  const int       corners = ElementGet((ElementType)e->face_type)->corners;
  PetscReal       lowest = PETSC_MAX_REAL, highest = PETSC_MIN_REAL, place[3], normal[3], size;

  FacePlane(slice, cell, number, place, normal, &size);
  for (int a = 0; a < e->corners; a++) {
    PetscReal height = 0;
    PetscBool on     = PETSC_FALSE;

    for (int k = 0; k < corners; k++) on = (PetscBool)(on || e->face_nodes[number][k] == a);
    if (on) continue;
    for (int d = 0; d < 3; d++) height += normal[d] * (slice->coords[3 * nodes[a] + d] - place[d]);
    lowest  = PetscMin(lowest, height);
    highest = PetscMax(highest, height);
  }
  return lowest > CELL_FACE_FLAT * size ? 1 : highest < -CELL_FACE_FLAT * size ? -1 : 0;
}

/* In which way a face goes round: 1 if, from its lowest corner on, the next one is lower than the one before. Of an
   edge, if it goes from its lower end to the higher one. */
static int FaceSense(int n, const PetscInt ids[])
{
  int lowest = 0;

  for (int k = 1; k < n; k++)
    if (ids[k] < ids[lowest]) lowest = k;
  if (n == 2) return lowest ? -1 : 1;
  return ids[(lowest + 1) % n] < ids[(lowest + n - 1) % n] ? 1 : -1;
}

/* Ids of the corners of a face of a cell. Returns their number. */
static int FaceCorners(const SliceMesh *slice, PetscInt cell, int number, PetscInt ids[CELL_FACE_CORNERS])
{
  const Element  *e       = slice->cell_block[cell]->element;
  const PetscInt *nodes   = SliceMeshCellNodes(slice, cell);
  const int       corners = ElementGet((ElementType)e->face_type)->corners;

  for (int k = 0; k < corners; k++) ids[k] = slice->id[nodes[e->face_nodes[number][k]]];
  return corners;
}

/* Packs face i % SLICE_CELL_FACES of a cell. */
static void PackFace(const void *context, PetscInt i, void *packed)
{
  const SliceMesh *slice  = context;
  const PetscInt   cell   = i / SLICE_CELL_FACES;
  const int        number = (int)(i % SLICE_CELL_FACES);
  CellFace        *face   = packed;
  PetscInt         ids[CELL_FACE_CORNERS];
  const int        corners = FaceCorners(slice, cell, number, ids);

  CellFacesSortCorners(corners, ids, face->corner);
  face->cell   = slice->cell_start[slice->rank] + cell;
  face->body   = slice->cell_body[cell];
  face->number = (signed char)number;
  face->side   = (signed char)CellSide(slice, cell, number);
  face->sense  = (signed char)FaceSense(corners, ids);
}

/* Of so many cells one is asked for the corners by which ranges of faces are chosen. */
enum { CELLS_ASKED = 16 };

/* Chooses ranges of lowest corners, so that ranks have as many faces. */
static PetscErrorCode ChooseRanges(SliceMesh *slice)
{
  PetscInt n = 0, *lowest, ids[CELL_FACE_CORNERS], corner[CELL_FACE_CORNERS];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((slice->n_cells / CELLS_ASKED + 1) * SLICE_CELL_FACES, &lowest));
  for (PetscInt c = 0; c < slice->n_cells; c += CELLS_ASKED) {
    for (int k = 0; k < slice->cell_block[c]->element->faces; k++) {
      CellFacesSortCorners(FaceCorners(slice, c, k, ids), ids, corner);
      lowest[n++] = corner[0];
    }
  }
  PetscCall(TagRangesChoose(slice->comm, n, lowest, &slice->face_start));
  PetscCall(PetscFree(lowest));
  slice->face_start[0] = 0;
  for (PetscMPIInt r = 1; r < slice->size; r++)
    slice->face_start[r] = PetscMin(slice->face_start[r], slice->home_start[slice->size]);
  slice->n_corners =
    (slice->rank + 1 < slice->size ? slice->face_start[slice->rank + 1] : slice->home_start[slice->size]) -
    slice->face_start[slice->rank];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sends the faces of the slice's cells to the ranks that have their lowest corners. */
static PetscErrorCode SendFaces(const SliceMesh *slice, PetscInt *n, CellFace **faces)
{
  const PetscInt n_all = slice->n_cells * SLICE_CELL_FACES;
  PetscMPIInt   *to;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n_all, &to));
  for (PetscInt i = 0; i < n_all; i++) {
    const PetscInt cell = i / SLICE_CELL_FACES;
    PetscInt       ids[CELL_FACE_CORNERS], corner[CELL_FACE_CORNERS];

    to[i] = -1;
    if (i % SLICE_CELL_FACES >= slice->cell_block[cell]->element->faces) continue;
    CellFacesSortCorners(FaceCorners(slice, cell, (int)(i % SLICE_CELL_FACES), ids), ids, corner);
    to[i] = SliceMeshRankOf(slice, slice->face_start, corner[0]);
  }
  PetscCall(ExchangeRecords(slice->comm, sizeof(CellFace), n_all, to, PackFace, slice, n, (void **)faces));
  PetscCall(PetscFree(to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sorts faces that have the same lowest corner by their other corners, and equal ones by their cells. A corner has few
   faces, so they are sorted by insertion. */
static void SortCellFaces(PetscInt n, CellFace faces[])
{
  for (PetscInt f = 1; f < n; f++) {
    const CellFace face  = faces[f];
    PetscInt       place = f;

    for (; place > 0; place--) {
      const int order = CompareCorners(faces[place - 1].corner, face.corner);

      if (order < 0 || (!order && faces[place - 1].cell < face.cell)) break;
      faces[place] = faces[place - 1];
    }
    faces[place] = face;
  }
}

/* Brings the faces of each lowest corner together, where they are: those of corner i start at start[i]. */
static PetscErrorCode GroupFaces(PetscInt first, PetscInt n_corners, const PetscInt start[], CellFace faces[])
{
  PetscInt *next;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n_corners, &next));
  PetscCall(PetscArraycpy(next, start, n_corners));
  for (PetscInt i = 0; i < n_corners; i++) {
    while (next[i] < start[i + 1]) {
      const CellFace face   = faces[next[i]];
      const PetscInt corner = face.corner[0] - first;

      faces[next[i]]        = faces[next[corner]];
      faces[next[corner]++] = face;
    }
  }
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CellFacesCreate - lists the faces of all cells.

  Collective

  Input Parameter:
. slice - after SliceRead()

  Output Parameter:
. slice - cell_faces has each face once for each cell that has it; those whose lowest corner is the i-th id of this
  rank's range start at corner_faces[i], and equal faces are adjacent, by ascending cell
@*/
PetscErrorCode CellFacesCreate(SliceMesh *slice)
{
  PetscInt n, first;

  PetscFunctionBeginUser;
  PetscCall(ChooseRanges(slice));
  PetscCall(SendFaces(slice, &n, &slice->cell_faces));
  first = slice->face_start[slice->rank];
  PetscCall(PetscCalloc1(slice->n_corners + 1, &slice->corner_faces));
  for (PetscInt f = 0; f < n; f++) slice->corner_faces[slice->cell_faces[f].corner[0] - first + 1]++;
  for (PetscInt i = 0; i < slice->n_corners; i++) slice->corner_faces[i + 1] += slice->corner_faces[i];
  PetscCall(GroupFaces(first, slice->n_corners, slice->corner_faces, slice->cell_faces));
  for (PetscInt i = 0; i < slice->n_corners; i++)
    SortCellFaces(slice->corner_faces[i + 1] - slice->corner_faces[i], &slice->cell_faces[slice->corner_faces[i]]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CellFacesFree - frees the list of faces.

  Not collective

  Input Parameter:
. slice - may have no list
@*/
PetscErrorCode CellFacesFree(SliceMesh *slice)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(slice->corner_faces));
  PetscCall(PetscFree(slice->cell_faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CellFacesSame - counts the cells that have a face.

  Not collective

  Input Parameters:
+ slice - after CellFacesCreate()
- face  - the first of those with its corners
@*/
PetscInt CellFacesSame(const SliceMesh *slice, const CellFace *face)
{
  const CellFace *end = slice->cell_faces + slice->corner_faces[slice->n_corners];
  PetscInt        n   = 1;

  while (face + n < end && !CompareCorners(face[n].corner, face->corner)) n++;
  return n;
}

/*@
  CellFacesFind - finds the cells that have a face.

  Not collective, on the rank that has its lowest corner

  Input Parameters:
+ slice  - after CellFacesCreate()
- corner - ids of its corners, sorted by CellFacesSortCorners()

  Output Parameter:
. face - the face of the first cell, followed by those of the other cells, by ascending cell; NULL if there is none

  Note:
  Returns the number of cells that have the face.
@*/
PetscInt CellFacesFind(const SliceMesh *slice, const PetscInt corner[CELL_FACE_CORNERS], const CellFace **face)
{
  const PetscInt i = corner[0] - slice->face_start[slice->rank];

  *face = NULL;
  for (PetscInt f = slice->corner_faces[i]; f < slice->corner_faces[i + 1]; f++) {
    if (CompareCorners(slice->cell_faces[f].corner, corner)) continue;
    *face = &slice->cell_faces[f];
    return CellFacesSame(slice, *face);
  }
  return 0;
}

/* The graph */

/*@
  CellFacesPairs - lists the pairs of cells that share a face of this rank.

  Not collective

  Input Parameter:
. slice - after CellFacesCreate()

  Output Parameters:
+ n     - number of pairs
- pairs - ids of the cells [2*n], to be freed with PetscFree()
@*/
PetscErrorCode CellFacesPairs(const SliceMesh *slice, PetscInt *n, PetscInt **pairs)
{
  const CellFace *end = slice->cell_faces + slice->corner_faces[slice->n_corners];
  PetscInt        same, at = 0;

  PetscFunctionBeginUser;
  *n = 0;
  for (const CellFace *face = slice->cell_faces; face < end; face += same) {
    same = CellFacesSame(slice, face);
    *n += same * (same - 1) / 2;
  }
  PetscCall(PetscMalloc1(2 * *n, pairs));
  for (const CellFace *face = slice->cell_faces; face < end; face += same) {
    same = CellFacesSame(slice, face);
    for (PetscInt i = 0; i < same; i++) {
      for (PetscInt k = i + 1; k < same; k++) {
        (*pairs)[at++] = face[i].cell;
        (*pairs)[at++] = face[k].cell;
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bodies that are meshed twice */

/* The first face of this rank whose two cells lie on the same side of it; NULL: there is none. */
static const CellFace *FindDouble(const SliceMesh *slice)
{
  const CellFace *end = slice->cell_faces + slice->corner_faces[slice->n_corners];

  for (const CellFace *face = slice->cell_faces; face + 1 < end; face++) {
    const CellFace *other = face + 1;

    if (CompareCorners(face->corner, other->corner) || face->body != other->body) continue;
    /* Cells beside each other go round their face in opposite ways, also where one of them is inverted. */
    if (face->sense == other->sense && face->side && face->side == other->side) return face;
  }
  return NULL;
}

/*@
  CellFacesCheck - complains of a body that is meshed twice somewhere: two of its cells lie on the same side of a face
  that they share.

  Collective

  Input Parameters:
+ scene - the scene
. file  - the mesh file, for the message
- slice - after CellFacesCreate()

  Output Parameter:
. complaint - what is wrong, on the first rank

  Note:
  Both cells would carry load, so that the body would be twice as stiff there, and it would have no skin.
@*/
PetscErrorCode CellFacesCheck(Scene scene, const char *file, const SliceMesh *slice, Complaint *complaint)
{
  const CellFace *found    = FindDouble(slice);
  PetscMPIInt     rank     = found ? slice->rank : slice->size;
  PetscInt        cells[4] = {0, 0, 0, 0}, tags[2] = {0, 0}; /* cells: two ids, number of the face, body */
  PetscReal       place[3] = {0, 0, 0}, normal[3], size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &rank, 1, MPI_INT, MPI_MIN, slice->comm));
  if (rank == slice->size) PetscFunctionReturn(PETSC_SUCCESS);
  if (rank == slice->rank) {
    cells[0] = found->cell;
    cells[1] = found[1].cell;
    cells[2] = found->number;
    cells[3] = found->body;
  }
  PetscCallMPI(MPI_Bcast(cells, 4, MPIU_INT, rank, slice->comm));
  for (int k = 0; k < 2; k++) {
    const PetscInt c = cells[k] - slice->cell_start[slice->rank];

    if (c < 0 || c >= slice->n_cells) continue;
    tags[k] = slice->cell_tag[c];
    if (!k) FacePlane(slice, c, (int)cells[2], place, normal, &size);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, tags, 2, MPIU_INT, MPI_SUM, slice->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, place, 3, MPIU_REAL, MPI_SUM, slice->comm));
  if (slice->rank) PetscFunctionReturn(PETSC_SUCCESS);
  Complain(complaint,
           "%s: cells %" PetscInt_FMT " and %" PetscInt_FMT
           " of '%s' lie on the same side of the face between them, at (%g, %g, %g): the body is meshed twice there; "
           "name each of its parts once",
           file, tags[0], tags[1], scene->bodies[cells[3]].name, place[0], place[1], place[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
