/* Pieces of faces and their points at the two ends of a step, see pieces.h. */
#include "pieces.h"
#include <math.h>
#include <string.h>

/* Normals that turn from a piece's by more than this belong to a sharp edge. A ring of eight pieces is round. */
#define PIECE_COSINE 0.92

/* Faces of this rank, a tool's in equal parts. */
static void OwnFaces(ContactSurface surface, PetscInt *first, PetscInt *end)
{
  PetscMPIInt rank, size;

  *first = 0;
  *end   = surface->n_faces;
  if (surface->group) return;
  (void)MPI_Comm_rank(surface->mesh->comm, &rank);
  (void)MPI_Comm_size(surface->mesh->comm, &size);
  *first = surface->n_faces / size * rank + PetscMin(rank, surface->n_faces % size);
  *end   = *first + surface->n_faces / size + (rank < surface->n_faces % size);
}

static PetscInt SurfaceNodes(ContactSurface surface)
{
  return surface->rigid ? surface->rigid->n_nodes : surface->mesh->n_nodes;
}

/* Number of a point by its node; a new one if there is none yet. */
static PetscInt PointOf(Side side, PetscInt *number, PetscInt node)
{
  if (number[node] < 0) {
    number[node]               = side->n_points;
    side->node[side->n_points] = node;
    side->n_points++;
  }
  return number[node];
}

/* Sums values of the points over the pieces of all ranks; n components for each. */
static PetscErrorCode SumPoints(Side side, int n, PetscReal *values)
{
  const Mesh mesh = side->surface->mesh;
  PetscReal *all;

  PetscFunctionBeginUser;
  if (side->surface->rigid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(n * mesh->n_nodes, &all));
  for (PetscInt i = 0; i < side->n_points; i++)
    for (int k = 0; k < n; k++) all[n * side->node[i] + k] = values[n * i + k];
  PetscCall(MeshSumNodes(mesh, n, all));
  for (PetscInt i = 0; i < side->n_points; i++)
    for (int k = 0; k < n; k++) values[n * i + k] = all[n * side->node[i] + k];
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the pieces of one face. */
static void DivideFace(Side side, PetscInt f, PetscInt *number)
{
  const ContactSurface surface = side->surface;
  const MeshGroup     *group   = surface->group;
  const Facet         *face    = &surface->faces[f];
  int                  node[PIECE_MAX][3];
  const int            n = PieceDivide(face->type, node);

  for (int k = 0; k < n; k++) {
    Piece *piece = &side->pieces[side->n_pieces];

    *piece = (Piece){.face   = group ? group->face_tag[f] : surface->rigid->face_tag[f],
                     .size   = surface->face_size[f],
                     .height = surface->face_height[f],
                     .body   = group ? surface->mesh->cell_body[group->face_cell[f]] : surface->body};
    for (int a = 0; a < side->dim; a++) {
      const PetscInt local = face->nodes[node[k][a]];

      side->corner[3 * side->n_pieces + a] = PointOf(side, number, local);
      piece->tag[a] = surface->rigid ? -1 - surface->rigid->node_tag[local] : surface->mesh->node_tag[local];
    }
    side->n_pieces++;
  }
}

/* Finds means of sizes and heights around the points, which do not change. */
static PetscErrorCode MeasurePoints(Side side)
{
  PetscReal *sum;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(3 * side->n_points, &sum));
  for (PetscInt k = 0; k < side->n_pieces; k++) {
    for (int a = 0; a < side->dim; a++) {
      const PetscInt i = side->corner[3 * k + a];

      sum[3 * i] += side->pieces[k].size;
      sum[3 * i + 1] += side->pieces[k].height;
      sum[3 * i + 2] += 1;
      side->points[i].tag  = side->pieces[k].tag[a];
      side->points[i].body = side->pieces[k].body;
    }
  }
  PetscCall(SumPoints(side, 3, sum));
  for (PetscInt i = 0; i < side->n_points; i++) {
    side->points[i].size   = sum[3 * i] / sum[3 * i + 2];
    side->points[i].weight = sum[3 * i];
    side->points[i].height = sum[3 * i + 1] / sum[3 * i + 2];
  }
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SideCreate - finds the pieces and points of a surface on this rank.

  Collective

  Input Parameters:
+ surface - borrowed
- loads   - give the places of tools; borrowed

  Output Parameter:
. out - free it with SideDestroy()
@*/
PetscErrorCode SideCreate(ContactSurface surface, Loads loads, Side *out)
{
  PetscInt first, end, *number, n = SurfaceNodes(surface);
  Side     side;

  PetscFunctionBeginUser;
  OwnFaces(surface, &first, &end);
  PetscCall(PetscNew(&side));
  side->surface = surface;
  side->loads   = loads;
  side->dim     = surface->mesh->dim;
  PetscCall(PetscMalloc1(n, &number));
  for (PetscInt i = 0; i < n; i++) number[i] = -1;
  PetscCall(PetscMalloc1(PetscMin(n, (end - first) * FACE_MAX_NODES), &side->node));
  PetscCall(PetscMalloc1((end - first) * PIECE_MAX, &side->pieces));
  PetscCall(PetscCalloc1((end - first) * PIECE_MAX * 3, &side->corner));
  for (PetscInt f = first; f < end; f++) DivideFace(side, f, number);
  PetscCall(PetscFree(number));
  PetscCall(PetscCalloc1(side->n_points, &side->points));
  PetscCall(MeasurePoints(side));
  *out = side;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SideDestroy - frees a side.

  Collective

  Input/Output Parameter:
. side - NULL on return; may be NULL before
@*/
PetscErrorCode SideDestroy(Side *side)
{
  PetscFunctionBeginUser;
  if (!*side) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree((*side)->node));
  PetscCall(PetscFree((*side)->points));
  PetscCall(PetscFree((*side)->corner));
  PetscCall(PetscFree((*side)->pieces));
  PetscCall(PetscFree(*side));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Places the points at one state. Rigid tools are where ToolsPlace() has put them. */
static void PlacePoints(Side side, int state, const PetscReal *u, PetscReal t)
{
  const ContactSurface surface = side->surface;
  const PetscReal     *coords  = surface->rigid ? surface->rigid->coords : surface->mesh->coords;

  for (PetscInt i = 0; i < side->n_points; i++) {
    Point         *point = &side->points[i];
    const PetscInt node  = side->node[i];

    for (int d = 0; d < side->dim; d++) point->X[d] = coords[node * side->dim + d];
    if (surface->rigid)
      LoadsRigidMotion(side->loads, surface->body, t, point->X, point->x[state]);
    else
      for (int d = 0; d < side->dim; d++) point->x[state][d] = point->X[d] + u[node * side->dim + d];
  }
}

/* Sums the normals of pieces at the points, with their areas, of both states. */
static PetscErrorCode PointNormals(Side side)
{
  PetscReal *normal;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(6 * side->n_points, &normal));
  for (PetscInt k = 0; k < side->n_pieces; k++) {
    for (int state = 0; state < 2; state++) {
      double own[3];

      PieceNormal(side->dim, (const Place *)side->pieces[k].x[state], own);
      for (int a = 0; a < side->dim; a++)
        for (int d = 0; d < 3; d++)
          normal[6 * side->corner[3 * k + a] + 3 * state + d] += own[d] * side->pieces[k].size;
    }
  }
  PetscCall(SumPoints(side, 6, normal));
  for (PetscInt i = 0; i < side->n_points; i++) memcpy(side->points[i].normal, &normal[6 * i], 6 * sizeof(PetscReal));
  PetscCall(PetscFree(normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks points and pieces where contact presses or an edge is sharp: there the normals around cancel. */
static void MarkSeen(Side side)
{
  for (PetscInt i = 0; i < side->n_points; i++) {
    Point        *point = &side->points[i];
    const double *n     = point->normal[1];

    point->seen = point->closed || sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) < PIECE_COSINE * point->weight;
  }
  for (PetscInt k = 0; k < side->n_pieces; k++) {
    side->pieces[k].seen = 0;
    for (int a = 0; a < side->dim; a++) side->pieces[k].seen |= side->points[side->corner[3 * k + a]].seen;
  }
}

/*@
  SideMove - places pieces and points at the two ends of a step.

  Collective

  Input Parameters:
+ side   - the side
. u      - local displacements at both ends, of all nodes of the mesh (length)
. t      - load parameters of both ends
- closed - of each node of the mesh: above 0 where a term pressed at one of the ends

  Note:
  Tools are left where they are at the second end.
@*/
PetscErrorCode SideMove(Side side, const PetscReal *const u[2], const PetscReal t[2], const PetscReal *closed)
{
  PetscFunctionBeginUser;
  for (int state = 0; state < 2; state++) {
    if (side->surface->rigid) ToolsPlace(side->surface->mesh, u[state], t[state]);
    PlacePoints(side, state, u[state], t[state]);
  }
  for (PetscInt i = 0; i < side->n_points; i++)
    side->points[i].closed = !side->surface->rigid && closed[side->node[i]] > 0;
  for (PetscInt k = 0; k < side->n_pieces; k++) {
    Piece *piece = &side->pieces[k];

    piece->closed = 0;
    for (int a = 0; a < side->dim; a++) {
      const Point *point = &side->points[side->corner[3 * k + a]];

      memcpy(piece->X[a], point->X, sizeof(Place));
      for (int state = 0; state < 2; state++) memcpy(piece->x[state][a], point->x[state], sizeof(Place));
      piece->closed |= point->closed;
    }
  }
  PetscCall(PointNormals(side));
  MarkSeen(side);
  for (PetscInt k = 0; k < side->n_pieces; k++) {
    Place normal[3];

    for (int a = 0; a < side->dim; a++)
      memcpy(normal[a], side->points[side->corner[3 * k + a]].normal[1], sizeof(Place));
    side->pieces[k].sagitta =
      PieceHeight(side->dim, (const Place *)side->pieces[k].x[1], (const Place *)normal, PIECE_COSINE);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void BoxEmpty(PetscReal box[6])
{
  for (int d = 0; d < 3; d++) {
    box[d]     = PETSC_MAX_REAL;
    box[3 + d] = PETSC_MIN_REAL;
  }
}

static void BoxAdd(PetscReal box[6], const Place x)
{
  for (int d = 0; d < 3; d++) {
    box[d]     = PetscMin(box[d], x[d]);
    box[3 + d] = PetscMax(box[3 + d], x[d]);
  }
}

/*@
  PieceBox - computes the box that a piece sweeps.

  Not collective

  Input Parameters:
+ piece - the piece
- dim   - 2 or 3

  Output Parameter:
. box - lower, then upper corner
@*/
void PieceBox(const Piece *piece, int dim, PetscReal box[6])
{
  BoxEmpty(box);
  for (int state = 0; state < 2; state++)
    for (int a = 0; a < dim; a++) BoxAdd(box, piece->x[state][a]);
}

/*@
  SideBox - computes the box that the side sweeps on this rank.

  Not collective

  Input Parameter:
. side - after SideMove()

  Output Parameter:
. box - lower, then upper corner; the lower one is above the upper one where there are no points
@*/
void SideBox(Side side, PetscReal box[6])
{
  BoxEmpty(box);
  for (PetscInt i = 0; i < side->n_points; i++)
    for (int state = 0; state < 2; state++) BoxAdd(box, side->points[i].x[state]);
}

/*@
  BoxJoin - joins the boxes of all ranks.

  Collective

  Input Parameters:
+ comm - the ranks
- box  - of this rank; the joined box on return
@*/
void BoxJoin(MPI_Comm comm, PetscReal box[6])
{
  (void)MPI_Allreduce(MPI_IN_PLACE, box, 3, MPIU_REAL, MPI_MIN, comm);
  (void)MPI_Allreduce(MPI_IN_PLACE, &box[3], 3, MPIU_REAL, MPI_MAX, comm);
}

/*@
  BoxesMeet - tells whether two boxes are within a distance of each other.

  Not collective

  Input Parameters:
+ a        - a box
. b        - another one
- distance - the distance (length)
@*/
PetscBool BoxesMeet(const PetscReal a[6], const PetscReal b[6], PetscReal distance)
{
  for (int d = 0; d < 3; d++)
    if (a[d] > b[3 + d] + distance || b[d] > a[3 + d] + distance) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* The mirror image of a piece. */
static Piece ImageOf(const Piece *piece, const SurfaceImage *image, int dim)
{
  Piece out = *piece;

  for (int a = 0; a < dim; a++) {
    const int b = image->reverses && a < 2 ? 1 - a : a;

    out.tag[a] = piece->tag[b];
    SurfaceReflect(image, dim, piece->X[b], out.X[a]);
    for (int state = 0; state < 2; state++) SurfaceReflect(image, dim, piece->x[state][b], out.x[state][a]);
  }
  return out;
}

/* Lists the pieces, with images, that come near a box. */
static PetscErrorCode ListNear(Side side, const PetscReal near[6], int n_images, const SurfaceImage *images,
                               PieceList *list)
{
  PetscFunctionBeginUser;
  list->n = 0;
  PetscCall(PetscMalloc1(side->n_pieces * PetscMax(n_images, 1), &list->pieces));
  for (int m = 0; m < PetscMax(n_images, 1); m++) {
    if (m && images[m].left_out) continue;
    for (PetscInt k = 0; k < side->n_pieces; k++) {
      PetscReal box[6];
      Piece    *piece = &list->pieces[list->n];

      *piece = m ? ImageOf(&side->pieces[k], &images[m], side->dim) : side->pieces[k];
      PieceBox(piece, side->dim, box);
      list->n += BoxesMeet(box, near, piece->size);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sends pieces to the ranks whose boxes they meet. counts, starts: bytes. */
static PetscErrorCode SendPieces(MPI_Comm comm, int ranks, const PetscReal *boxes, int dim, const PieceList *mine,
                                 PieceList *list)
{
  PetscMPIInt *count, *start, *arrive, *from;
  PetscInt     n = 0;
  Piece       *send;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc4(ranks, &count, ranks + 1, &start, ranks, &arrive, ranks + 1, &from));
  for (int pass = 0; pass < 2; pass++) {
    if (pass) PetscCall(PetscMalloc1(n, &send));
    n = 0;
    for (int r = 0; r < ranks; r++) {
      for (PetscInt k = 0; k < mine->n; k++) {
        PetscReal box[6];

        PieceBox(&mine->pieces[k], dim, box);
        if (!BoxesMeet(box, &boxes[6 * r], mine->pieces[k].size)) continue;
        if (pass) send[n] = mine->pieces[k];
        n++;
      }
      start[r + 1] = (PetscMPIInt)(n * (PetscInt)sizeof(Piece));
      count[r]     = start[r + 1] - start[r];
    }
  }
  PetscCallMPI(MPI_Alltoall(count, 1, MPI_INT, arrive, 1, MPI_INT, comm));
  for (int r = 0; r < ranks; r++) from[r + 1] = from[r] + arrive[r];
  list->n = from[ranks] / (PetscInt)sizeof(Piece);
  PetscCall(PetscMalloc1(list->n, &list->pieces));
  PetscCallMPI(MPI_Alltoallv(send, count, start, MPI_BYTE, list->pieces, arrive, from, MPI_BYTE, comm));
  PetscCall(PetscFree(send));
  PetscCall(PetscFree4(count, start, arrive, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SideShare - collects the pieces of a side that come near this rank's points of the other one.

  Collective

  Input Parameters:
+ side     - after SideMove()
. near     - box of the other side's points on this rank
. n_images - mirror images that count, the identity included
- images   - the images

  Output Parameter:
. list - free its pieces with PetscFree()
@*/
PetscErrorCode SideShare(Side side, const PetscReal near[6], int n_images, const SurfaceImage *images, PieceList *list)
{
  const MPI_Comm comm = side->surface->mesh->comm;
  PetscReal     *boxes, all[6];
  PieceList      mine;
  PetscMPIInt    ranks;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &ranks));
  for (int k = 0; k < 6; k++) all[k] = near[k];
  BoxJoin(comm, all);
  PetscCall(ListNear(side, all, n_images, images, &mine));
  if (ranks == 1) {
    *list = mine;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc1(6 * ranks, &boxes));
  PetscCallMPI(MPI_Allgather(near, 6, MPIU_REAL, boxes, 6, MPIU_REAL, comm));
  PetscCall(SendPieces(comm, ranks, boxes, side->dim, &mine, list));
  PetscCall(PetscFree(boxes));
  PetscCall(PetscFree(mine.pieces));
  PetscFunctionReturn(PETSC_SUCCESS);
}
