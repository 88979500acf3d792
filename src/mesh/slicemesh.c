/* Cells and nodes of a rank's slice of the mesh, and the ranks that have them. */
#include "slicemesh.h"
#include "tagranges.h"

/*@
  SliceMeshCellNodes - returns the nodes of a cell.

  Not collective

  Input Parameters:
+ slice - after SliceRead()
- c     - number of the cell in the slice

  Note:
  Returns numbers of nodes in the slice, in gmsh's order.
@*/
const PetscInt *SliceMeshCellNodes(const SliceMesh *slice, PetscInt c)
{
  return slice->cell_nodes + c * slice->width;
}

/*@
  SliceMeshRankOf - finds the rank that has an id.

  Not collective

  Input Parameters:
+ slice - after SliceRead()
. start - its home_start, face_start or cell_start
- id    - of a node or a cell
@*/
PetscMPIInt SliceMeshRankOf(const SliceMesh *slice, const PetscInt start[], PetscInt id)
{
  return TagRangesRank(slice->size, start, id);
}

/*@
  SliceMeshSF - makes an SF from a list of ids to the ranks that have them.

  Collective

  Input Parameters:
+ slice - its ranks
. start - first id of each rank, and the number of all
. n     - number of ids
- ids   - of any ranks; fastest where they ascend

  Output Parameter:
. sf - roots are the ids of this rank, leaves those of the list
@*/
PetscErrorCode SliceMeshSF(const SliceMesh *slice, const PetscInt start[], PetscInt n, const PetscInt ids[],
                           PetscSF *sf)
{
  PetscSFNode *remote;
  PetscMPIInt  r = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &remote));
  for (PetscInt i = 0; i < n; i++) {
    if (ids[i] < start[r] || ids[i] >= start[r + 1]) r = SliceMeshRankOf(slice, start, ids[i]);
    remote[i] = (PetscSFNode){.rank = r, .index = ids[i] - start[r]};
  }
  PetscCall(PetscSFCreate(slice->comm, sf));
  PetscCall(PetscSFSetGraph(*sf, start[slice->rank + 1] - start[slice->rank], n, NULL, PETSC_OWN_POINTER, remote,
                            PETSC_OWN_POINTER));
  PetscCall(PetscSFSetUp(*sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceMeshPackFace - writes one of an array of faces of groups where ExchangeRecords() sends it from.

  Not collective

  Input Parameters:
+ faces - the array, of SliceFace
- i     - number of the face

  Output Parameter:
. packed - the face; what lies between its fields is left as it is, so that no byte is undefined
@*/
void SliceMeshPackFace(const void *faces, PetscInt i, void *packed)
{
  const SliceFace *face = &((const SliceFace *)faces)[i];
  SliceFace       *to   = packed;

  to->cell   = face->cell;
  to->group  = face->group;
  to->tag    = face->tag;
  to->order  = face->order;
  to->number = face->number;
}

/*@
  SliceMeshReversedNode - returns the node at place k of a plane cell, a face or a curve whose sense is reversed.

  Not collective

  Input Parameters:
+ element - type of the cell or face
- k       - the place

  Note:
  The corners follow in the opposite sense of rotation from the first one, and the edges with them. The ends of a curve
  are swapped.
@*/
int SliceMeshReversedNode(const Element *element, int k)
{
  const int corners = element->corners;

  if (element->dim == 1) return k < 2 ? 1 - k : k;
  if (k < corners) return (corners - k) % corners;
  return k < 2 * corners ? corners + (2 * corners - 1 - k) : k;
}

/*@
  SliceMeshFreeCells - frees the cells, the elements of the file and the faces.

  Not collective

  Input Parameter:
. slice - the homes of nodes and the marks stay
@*/
PetscErrorCode SliceMeshFreeCells(SliceMesh *slice)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(slice->cell_block, slice->cell_body, slice->cell_tag, slice->cell_nodes));
  PetscCall(PetscFree2(slice->id, slice->coords));
  PetscCall(PetscFree(slice->face_ptr));
  PetscCall(PetscFree(slice->faces));
  PetscCall(PetscFree(slice->corner_faces));
  PetscCall(PetscFree(slice->cell_faces));
  for (int b = 0; slice->element_ids && b < slice->gmsh.n_blocks; b++) PetscCall(PetscFree(slice->element_ids[b]));
  PetscCall(PetscFree(slice->element_ids));
  PetscCall(GmshFreeBlocks(&slice->gmsh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceMeshReset - frees the contents of a slice.

  Not collective

  Input Parameter:
. slice - from SliceRead()
@*/
PetscErrorCode SliceMeshReset(SliceMesh *slice)
{
  PetscFunctionBeginUser;
  PetscCall(SliceMeshFreeCells(slice));
  PetscCall(PetscFree(slice->home));
  PetscCall(PetscFree(slice->home_start));
  PetscCall(PetscFree(slice->face_start));
  PetscCall(PetscFree(slice->cell_start));
  PetscCall(PetscFree(slice->interior));
  PetscCall(PetscFree(slice->marks));
  PetscCall(GmshReset(&slice->gmsh));
  PetscFunctionReturn(PETSC_SUCCESS);
}
