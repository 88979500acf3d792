/* The shared room for the evaluation of slave points: its memory, the list of contact nodes and the nodes of a block.
 */
#include "contactwork.h"
#include "matrix/blockmatrix.h"

/*@
  ContactWorkCreate - allocates what the evaluation of one slave point fills.

  Not collective

  Input Parameters:
+ capacity       - the most points that take part in an evaluation, over all smoothers in use
. dense_capacity - the most points of a result whose second variation is a dense matrix
- workspace      - numbers of workspace that a smoother needs; 0 for none

  Output Parameter:
. work - the room; all other members must be zero before the call
@*/
PetscErrorCode ContactWorkCreate(int capacity, int dense_capacity, long workspace, ContactWork *work)
{
  PetscFunctionBeginUser;
  if (workspace) PetscCall(PetscMalloc1(workspace, &work->workspace));
  PetscCall(PetscMalloc3(capacity, &work->result.points, 3 * (capacity + 1), &work->result.N,
                         PetscSqr(3 * (dense_capacity + 1)), &work->result.M));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactWorkDestroy - frees the arrays of a work.

  Not collective

  Input Parameter:
. work - the room; the structure itself belongs to the caller
@*/
PetscErrorCode ContactWorkDestroy(ContactWork *work)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(work->result.points, work->result.N, work->result.M));
  PetscCall(PetscFree3(work->x, work->multiplier, work->hoop));
  PetscCall(PetscFree6(work->map.ptr, work->map.run, work->map.node, work->map.S, work->map.sign, work->number));
  PetscCall(PetscFree(work->N));
  PetscCall(PetscFree(work->sum_workspace));
  PetscCall(PetscFree(work->M));
  PetscCall(PetscFree(work->slot));
  PetscCall(PetscFree(work->workspace));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactWorkMap - gives the map in the work as the kernels of the fit take it.

  Not collective

  Input Parameters:
+ work    - the room
- n_nodes - nodes that the slots in the map count
@*/
FitDerivatives ContactWorkMap(const ContactWork *work, PetscInt n_nodes)
{
  const ContactMap *map = &work->map;

  return (FitDerivatives){(int)n_nodes, map->ptr, map->run, map->node, map->S, map->sign};
}

/* Makes room for the slots of all contact nodes. New slots are -1. */
static PetscErrorCode WorkReserveSlots(ContactWork *work, PetscInt contact_nodes)
{
  PetscFunctionBeginUser;
  if (contact_nodes <= work->slot_room) PetscFunctionReturn(PETSC_SUCCESS);
  work->slot_room = 2 * contact_nodes;
  PetscCall(PetscFree(work->slot));
  PetscCall(PetscMalloc1(work->slot_room, &work->slot));
  for (PetscInt i = 0; i < work->slot_room; i++) work->slot[i] = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactWorkReserveMap - makes room for a map, for as many nodes in `number`, and for the slots.

  Not collective

  Input Parameters:
+ work          - the room; what map and number held is lost where they grow
. contact_nodes - number of contact nodes of the lists
. rows          - rows of the map: the slave point and the points that take part
- entries       - entries of the map in all rows together
@*/
PetscErrorCode ContactWorkReserveMap(ContactWork *work, PetscInt contact_nodes, int rows, PetscInt entries)
{
  PetscFunctionBeginUser;
  PetscCall(WorkReserveSlots(work, contact_nodes));
  if (rows <= work->map.rows_room && entries <= work->map.entries_room) PetscFunctionReturn(PETSC_SUCCESS);
  work->map.rows_room    = PetscMax(work->map.rows_room, 2 * rows);
  work->map.entries_room = PetscMax(work->map.entries_room, 2 * (int)entries);
  PetscCall(PetscFree6(work->map.ptr, work->map.run, work->map.node, work->map.S, work->map.sign, work->number));
  PetscCall(PetscMalloc6(work->map.rows_room + 1, &work->map.ptr, work->map.rows_room, &work->map.run,
                         work->map.entries_room, &work->map.node, work->map.entries_room, &work->map.S,
                         3 * work->map.entries_room, &work->map.sign, work->map.entries_room, &work->number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactWorkReserveBlock - makes room for the matrix M of a block.

  Not collective

  Input Parameters:
+ work - the room; what M held is lost where it grows
- m    - rows of the block: its nodes times the dimension
@*/
PetscErrorCode ContactWorkReserveBlock(ContactWork *work, PetscInt m)
{
  PetscFunctionBeginUser;
  if (m * m + BLOCK_PADDING <= work->M_room) PetscFunctionReturn(PETSC_SUCCESS);
  work->M_room = 2 * m * m + BLOCK_PADDING;
  PetscCall(PetscFree(work->M));
  PetscCall(PetscMalloc1(work->M_room, &work->M));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactWorkNodesBegin - begins an empty list of contact nodes in `number` and `count`.

  Not collective

  Input Parameters:
+ work          - the room
. contact_nodes - number of contact nodes of the lists
- room          - how many nodes will be mentioned at most, repetitions counted
@*/
PetscErrorCode ContactWorkNodesBegin(ContactWork *work, PetscInt contact_nodes, PetscInt room)
{
  PetscFunctionBeginUser;
  PetscCall(ContactWorkReserveMap(work, contact_nodes, 0, room));
  work->count = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactWorkNodesAdd - adds those of some nodes that are not in the list yet; their places in the list become their
  slots.

  Not collective

  Input Parameters:
+ work  - the room, after ContactWorkNodesBegin()
. n     - number of nodes
- nodes - contact nodes, which may repeat themselves
@*/
void ContactWorkNodesAdd(ContactWork *work, PetscInt n, const PetscInt nodes[])
{
  for (PetscInt a = 0; a < n; a++) {
    int *slot = &work->slot[nodes[a]];

    if (*slot >= 0) continue;
    *slot                       = (int)work->count;
    work->number[work->count++] = nodes[a];
  }
}

/*@
  ContactWorkNodesEnd - ends a list: the nodes stay in `number`, their slots become -1 again.

  Not collective

  Input Parameter:
. work - the room, after ContactWorkNodesBegin()
@*/
void ContactWorkNodesEnd(ContactWork *work)
{
  ContactWorkBlockEnd(work, work->count, work->number);
}

/*@
  ContactWorkBlockBegin - sets the slots of a block's nodes to their places in the block.

  Not collective

  Input Parameters:
+ work          - the room
. contact_nodes - number of contact nodes of the lists
. n             - nodes of the block
- nodes         - contact nodes, each once

  Note:
  Contact nodes that are not in the block keep the slot -1 and take no part in it.
@*/
PetscErrorCode ContactWorkBlockBegin(ContactWork *work, PetscInt contact_nodes, PetscInt n, const PetscInt nodes[])
{
  PetscFunctionBeginUser;
  PetscCall(WorkReserveSlots(work, contact_nodes));
  for (PetscInt i = 0; i < n; i++) work->slot[nodes[i]] = (int)i;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactWorkBlockEnd - sets the slots of a block's nodes back to -1.

  Not collective

  Input Parameters:
+ work  - the room
. n     - nodes of the block
- nodes - contact nodes, as given to ContactWorkBlockBegin()
@*/
void ContactWorkBlockEnd(ContactWork *work, PetscInt n, const PetscInt nodes[])
{
  for (PetscInt i = 0; i < n; i++) work->slot[nodes[i]] = -1;
}
