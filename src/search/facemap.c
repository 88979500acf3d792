/* Maps of faces on their way between ranks. */
#include "search/facemap.h"

/* Sends blocks of `size` bytes from roots to leaves. */
static PetscErrorCode Broadcast(PetscSF sf, size_t size, const void *roots, void *leaves)
{
  MPI_Datatype block;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Type_contiguous((int)size, MPI_BYTE, &block));
  PetscCallMPI(MPI_Type_commit(&block));
  PetscCall(PetscSFBcastBegin(sf, block, roots, leaves, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, block, roots, leaves, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&block));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the star forest of the faces' entries. The entries of each leaf follow one another as those of its root do.
   start[leaf] is the first entry of the root. */
static PetscErrorCode CreateEntryForest(PetscSF faces, const FaceMaps *home, const PetscInt start[],
                                        const FaceMaps *maps, PetscSF *sf)
{
  const PetscSFNode *root;
  PetscSFNode       *remote;

  PetscFunctionBeginUser;
  PetscCall(PetscSFGetGraph(faces, NULL, NULL, NULL, &root));
  PetscCall(PetscMalloc1(maps->ptr[maps->n], &remote));
  for (PetscInt f = 0; f < maps->n; f++)
    for (PetscInt k = maps->ptr[f]; k < maps->ptr[f + 1]; k++)
      remote[k] = (PetscSFNode){root[f].rank, start[f] + k - maps->ptr[f]};
  PetscCall(PetscSFCreate(PetscObjectComm((PetscObject)faces), sf));
  PetscCall(
    PetscSFSetGraph(*sf, home->ptr[home->n], maps->ptr[maps->n], NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscSFSetUp(*sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FaceMapsFetch - fetches the maps of faces from the ranks where the faces live.

  Collective

  Input Parameters:
+ faces - star forest: its roots are the faces of home, in their order, and its leaves are the faces that are wanted,
          without gaps
- home  - maps of this rank's faces

  Output Parameter:
. maps - maps of the leaves

  Note:
  The caller frees the maps with FaceMapsDestroy().
@*/
PetscErrorCode FaceMapsFetch(PetscSF faces, const FaceMaps *home, FaceMaps *maps)
{
  PetscInt *start, *end, n;
  PetscSF   entries;

  PetscFunctionBeginUser;
  PetscCall(PetscSFGetGraph(faces, NULL, &n, NULL, NULL));
  PetscCall(PetscMalloc2(n, &start, n, &end));
  PetscCall(Broadcast(faces, sizeof(PetscInt), home->ptr, start));
  PetscCall(Broadcast(faces, sizeof(PetscInt), home->ptr + 1, end));
  maps->n = n;
  PetscCall(PetscMalloc1(n + 1, &maps->ptr));
  maps->ptr[0] = 0;
  for (PetscInt f = 0; f < n; f++) maps->ptr[f + 1] = maps->ptr[f] + end[f] - start[f];
  PetscCall(PetscMalloc1(maps->ptr[n], &maps->entry));
  PetscCall(CreateEntryForest(faces, home, start, maps, &entries));
  PetscCall(Broadcast(entries, sizeof(FaceMapEntry), home->entry, maps->entry));
  PetscCall(PetscSFDestroy(&entries));
  PetscCall(PetscFree2(start, end));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FaceMapsDestroy - frees maps of faces.

  Not collective

  Input/Output Parameter:
. maps - the maps, empty on return
@*/
PetscErrorCode FaceMapsDestroy(FaceMaps *maps)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(maps->ptr));
  PetscCall(PetscFree(maps->entry));
  *maps = (FaceMaps){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FaceMapShift - computes the constant part of a point's position, which is the sum of the shifts of its nodes' images.

  Not collective

  Input Parameters:
+ maps   - maps of faces
. face   - number of the face among them
. point  - point of the face's rule
. dim    - 2 or 3
- images - the mirror images to which the entries refer

  Output Parameter:
. shift - shift[dim] (length)
@*/
void FaceMapShift(const FaceMaps *maps, PetscInt face, int point, int dim, const SurfaceImage *images, PetscReal *shift)
{
  for (int d = 0; d < dim; d++) shift[d] = 0;
  for (PetscInt k = maps->ptr[face]; k < maps->ptr[face + 1]; k++)
    for (int d = 0; d < dim; d++) shift[d] += maps->entry[k].S[point] * images[maps->entry[k].image].shift[d];
}
