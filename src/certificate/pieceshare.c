/* The way of pieces to the ranks that they come near, see pieces.h. */
#include "pieces.h"

/* The mirror image of a piece. */
static Piece ImageOf(const Piece *piece, const SurfaceImage *image, int dim)
{
  Piece out = *piece;

  for (int a = 0; a < dim; a++) {
    const int b = image->reverses && a < 2 ? 1 - a : a;

    out.tag[a] = piece->tag[b];
    out.tip[a] = piece->tip[b];
    for (int d = 0; d < dim; d++)
      out.across[a][d] = image->sign[d] * piece->across[image->reverses ? (3 - a) % 3 : a][d];
    SurfaceReflect(image, dim, piece->X[b], out.X[a]);
    for (int state = 0; state < 2; state++) SurfaceReflect(image, dim, piece->x[state][b], out.x[state][a]);
  }
  PiecePlace(&out, dim);
  return out;
}

/* Makes room for so many pieces. What is in the list stays. */
static PetscErrorCode PieceListRoom(PieceList *list, PetscInt n)
{
  PetscFunctionBeginUser;
  if (n <= list->room) PetscFunctionReturn(PETSC_SUCCESS);
  list->room = PetscMax(n, 2 * list->room);
  PetscCall(PetscRealloc(list->room * sizeof(Piece), &list->pieces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a piece if it comes near a box. */
static PetscErrorCode AddNear(const Piece *piece, const Box near, PieceList *list)
{
  PetscFunctionBeginUser;
  if (!BoxesMeet(piece->box, near, piece->size)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PieceListRoom(list, list->n + 1));
  list->pieces[list->n++] = *piece;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the pieces, with images, that come near a box. */
static PetscErrorCode ListNear(Side side, const Box near, int n_images, const SurfaceImage *images, PieceList *list)
{
  PetscFunctionBeginUser;
  list->n = 0;
  for (PetscInt k = 0; k < side->n_pieces; k++) PetscCall(AddNear(&side->pieces[k], near, list));
  for (int m = 1; m < n_images; m++) {
    if (images[m].left_out) continue;
    for (PetscInt k = 0; k < side->n_pieces; k++) {
      const Piece image = ImageOf(&side->pieces[k], &images[m], side->dim);

      PetscCall(AddNear(&image, near, list));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sends pieces to the ranks whose boxes they meet. */
static PetscErrorCode SendPieces(MPI_Comm comm, int ranks, const Box *boxes, const PieceList *mine, PieceList *list)
{
  PetscMPIInt *count, *start, *arrive, *from;
  PetscInt     n = 0;
  Piece       *send;
  MPI_Datatype piece;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc4(ranks, &count, ranks + 1, &start, ranks, &arrive, ranks + 1, &from));
  for (int pass = 0; pass < 2; pass++) {
    if (pass) PetscCall(PetscMalloc1(n, &send));
    n = 0;
    for (int r = 0; r < ranks; r++) {
      for (PetscInt k = 0; k < mine->n; k++) {
        if (!BoxesMeet(mine->pieces[k].box, boxes[r], mine->pieces[k].size)) continue;
        if (pass) send[n] = mine->pieces[k];
        n++;
      }
      PetscCall(PetscMPIIntCast(n, &start[r + 1]));
      count[r] = start[r + 1] - start[r];
    }
  }
  PetscCallMPI(MPI_Alltoall(count, 1, MPI_INT, arrive, 1, MPI_INT, comm));
  for (int r = 0; r < ranks; r++) from[r + 1] = from[r] + arrive[r];
  list->n = from[ranks];
  PetscCall(PieceListRoom(list, list->n));
  PetscCallMPI(MPI_Type_contiguous((int)sizeof(Piece), MPI_BYTE, &piece));
  PetscCallMPI(MPI_Type_commit(&piece));
  PetscCallMPI(MPI_Alltoallv(send, count, start, piece, list->pieces, arrive, from, piece, comm));
  PetscCallMPI(MPI_Type_free(&piece));
  PetscCall(PetscFree(send));
  PetscCall(PetscFree4(count, start, arrive, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SideShare - collects the pieces of a side that come near this rank's points of the other one.

  Collective

  Input Parameters:
+ side     - after SideMeasure()
. near     - box of the other side's points on this rank
. n_images - mirror images that count, the identity included
- images   - the images

  Input/Output Parameter:
. list - of an earlier call, or zeroed; free its pieces with PetscFree()
@*/
PetscErrorCode SideShare(Side side, const Box near, int n_images, const SurfaceImage *images, PieceList *list)
{
  const MPI_Comm comm = side->surface->mesh->comm;
  PieceList      mine = {0};
  Box           *boxes, all;
  PetscMPIInt    ranks;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &ranks));
  if (ranks == 1) {
    PetscCall(ListNear(side, near, n_images, images, list));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (int k = 0; k < 6; k++) all[k] = near[k];
  BoxJoin(comm, all);
  PetscCall(ListNear(side, all, n_images, images, &mine));
  PetscCall(PetscMalloc1(ranks, &boxes));
  PetscCallMPI(MPI_Allgather(near, 6, MPIU_REAL, boxes, 6, MPIU_REAL, comm));
  PetscCall(SendPieces(comm, ranks, (const Box *)boxes, &mine, list));
  PetscCall(PetscFree(boxes));
  PetscCall(PetscFree(mine.pieces));
  PetscFunctionReturn(PETSC_SUCCESS);
}
