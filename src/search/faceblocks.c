/* Blocks of neighbouring faces, see faceblocks.h. */
#include "search/faceblocks.h"
#include "boundingbox.h"
#include <stdint.h>
#include <stdlib.h>

/* Faces of a block. A search looks at all boxes and at all faces of some blocks at its rim: with a million faces, at
   16,000 boxes and some thousand faces. */
enum { BLOCK_FACES = 64 };

/* Places along an axis are told apart by so many bits, three of which make a key of 63. */
enum { PLACE_BITS = 21 };

/* A face, by the place of its first node on a curve that fills space: faces that follow each other are neighbours. */
typedef struct {
  uint64_t key;
  PetscInt face;
} Place;

static int ComparePlaces(const void *a, const void *b)
{
  const Place *p = a, *q = b;

  if (p->key != q->key) return p->key < q->key ? -1 : 1;
  return p->face < q->face ? -1 : p->face > q->face;
}

/* Morton's key: the bits of the places along the axes in turn. */
static uint64_t Key(int dim, const PetscReal *x, const PetscReal *lower, PetscReal length)
{
  uint64_t place[3] = {0, 0, 0}, key = 0;

  for (int d = 0; d < dim && length > 0; d++)
    place[d] = (uint64_t)((x[d] - lower[d]) / length * (((uint64_t)1 << PLACE_BITS) - 1));
  for (int bit = PLACE_BITS - 1; bit >= 0; bit--)
    for (int d = 0; d < dim; d++) key = key << 1 | (place[d] >> bit & 1);
  return key;
}

/* Orders the faces along the curve. */
static PetscErrorCode OrderFaces(FaceBlocks blocks, const Facet *faces, const PetscReal *X)
{
  const int dim = blocks->dim;
  PetscReal box[6], length = 0;
  Place    *places;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(blocks->n_faces, &places));
  SearchBoxEmpty(dim, box);
  for (PetscInt f = 0; f < blocks->n_faces; f++) SearchBoxAdd(box, dim, &X[faces[f].nodes[0] * dim]);
  for (int d = 0; d < dim; d++) length = PetscMax(length, box[3 + d] - box[d]);
  for (PetscInt f = 0; f < blocks->n_faces; f++)
    places[f] = (Place){Key(dim, &X[faces[f].nodes[0] * dim], box, length), f};
  if (blocks->n_faces) qsort(places, blocks->n_faces, sizeof(Place), ComparePlaces);
  for (PetscInt f = 0; f < blocks->n_faces; f++) blocks->face[f] = places[f].face;
  PetscCall(PetscFree(places));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Collects the nodes of the blocks. */
static PetscErrorCode CollectNodes(FaceBlocks blocks, const Facet *faces)
{
  PetscInt n = 0, end = 0;

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < blocks->n_faces; f++) n += ElementGet(faces[f].type)->nodes;
  PetscCall(PetscMalloc2(blocks->n + 1, &blocks->node_ptr, n, &blocks->node));
  for (PetscInt b = 0; b < blocks->n; b++) {
    PetscInt count = 0;

    blocks->node_ptr[b] = end;
    for (PetscInt i = FaceBlocksFirst(b); i < FaceBlocksEnd(blocks, b); i++)
      for (int a = 0; a < ElementGet(faces[blocks->face[i]].type)->nodes; a++)
        blocks->node[end + count++] = faces[blocks->face[i]].nodes[a];
    PetscCall(PetscSortRemoveDupsInt(&count, &blocks->node[end]));
    end += count;
  }
  blocks->node_ptr[blocks->n] = end;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FaceBlocksCreate - sorts faces into blocks, and places the boxes in the reference position.

  Not collective

  Input Parameters:
+ dim     - 2 or 3
. n_faces - number of faces
. faces   - the faces, not kept
- X       - X[nodes*dim], reference coordinates of their nodes (length), not kept

  Output Parameter:
. out - the blocks
@*/
PetscErrorCode FaceBlocksCreate(int dim, PetscInt n_faces, const Facet *faces, const PetscReal *X, FaceBlocks *out)
{
  FaceBlocks blocks;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&blocks));
  blocks->dim     = dim;
  blocks->n_faces = n_faces;
  blocks->n       = (n_faces + BLOCK_FACES - 1) / BLOCK_FACES;
  PetscCall(PetscMalloc2(n_faces, &blocks->face, 6 * blocks->n, &blocks->box));
  PetscCall(OrderFaces(blocks, faces, X));
  PetscCall(CollectNodes(blocks, faces));
  FaceBlocksPlace(blocks, X, NULL);
  *out = blocks;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FaceBlocksDestroy - frees blocks.

  Not collective

  Input/Output Parameter:
. blocks - the blocks, NULL on return
@*/
PetscErrorCode FaceBlocksDestroy(FaceBlocks *blocks)
{
  PetscFunctionBeginUser;
  if (!*blocks) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2((*blocks)->face, (*blocks)->box));
  PetscCall(PetscFree2((*blocks)->node_ptr, (*blocks)->node));
  PetscCall(PetscFree(*blocks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FaceBlocksPlace - places the boxes around the nodes of their faces.

  Not collective

  Input Parameters:
+ blocks - the blocks
. X      - X[nodes*dim], reference coordinates (length)
- u      - u[nodes*dim], displacements (length); NULL: none
@*/
void FaceBlocksPlace(FaceBlocks blocks, const PetscReal *X, const PetscReal *u)
{
  const int dim = blocks->dim;

  for (PetscInt b = 0; b < blocks->n; b++) {
    PetscReal *box = &blocks->box[6 * b];

    SearchBoxEmpty(dim, box);
    for (PetscInt k = blocks->node_ptr[b]; k < blocks->node_ptr[b + 1]; k++) {
      const PetscInt first = blocks->node[k] * dim;
      PetscReal      x[3];

      for (int d = 0; d < dim; d++) x[d] = X[first + d] + (u ? u[first + d] : 0);
      SearchBoxAdd(box, dim, x);
    }
  }
}

/*@
  FaceBlocksFirst - returns the place in the order of the blocks where the faces of a block begin.

  Not collective

  Input Parameter:
. block - number of the block
@*/
PetscInt FaceBlocksFirst(PetscInt block)
{
  return block * BLOCK_FACES;
}

/*@
  FaceBlocksEnd - returns the place in the order of the blocks behind the faces of a block.

  Not collective

  Input Parameters:
+ blocks - the blocks
- block  - number of one of them
@*/
PetscInt FaceBlocksEnd(FaceBlocks blocks, PetscInt block)
{
  return PetscMin(blocks->n_faces, FaceBlocksFirst(block + 1));
}

/*@
  FaceBlocksNear - collects the faces of the blocks whose boxes meet a box.

  Not collective

  Input Parameters:
+ blocks - the blocks
- box    - lower then upper corner

  Input/Output Parameters:
+ taken - of each block: it is left out; set where its faces are collected
- faces - the faces are written here; it has room for all that are not taken yet

  Note:
  Returns the number of faces. Some of them may be farther away.
@*/
PetscInt FaceBlocksNear(FaceBlocks blocks, const PetscReal box[6], PetscBool *taken, PetscInt *faces)
{
  PetscInt n = 0;

  for (PetscInt b = 0; b < blocks->n; b++) {
    if (taken[b] || !SearchBoxesMeet(&blocks->box[6 * b], box, blocks->dim, 0)) continue;
    taken[b] = PETSC_TRUE;
    for (PetscInt i = FaceBlocksFirst(b); i < FaceBlocksEnd(blocks, b); i++) faces[n++] = blocks->face[i];
  }
  return n;
}
