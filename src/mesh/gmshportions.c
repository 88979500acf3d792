/* The portions of a mesh file that ranks keep, see gmshportions.h. */
#include "gmshportions.h"
#include "kernels/element.h"

/* Items that are sent together. */
enum { PORTION = 4096 };
/* Values of an element: its tag and those of its nodes. */
enum { PORTION_WIDTH = 1 + ELEMENT_MAX_NODES };

/* What is sent. Before the values comes a head that says which they are; `room` is the number of such values that the
   rank gets in all. */
enum { PORTION_TAGS, PORTION_PLACES, PORTION_ELEMENTS, PORTION_END };
enum { HEAD_KIND, HEAD_BLOCK, HEAD_WIDTH, HEAD_ROOM, HEAD_N, HEAD_SIZE };

/* Where a rank's range of places in the file begins. */
static PetscInt RangeStart(const Portions *p, PetscMPIInt rank)
{
  return (PetscInt)((PetscInt64)p->n_all * rank / p->size);
}

/* How many of the items [first, first + n) are a rank's. The last rank has what is beyond the number that the file
   states. */
static PetscInt RangeCount(const Portions *p, PetscMPIInt rank, PetscInt first, PetscInt n)
{
  const PetscInt low  = PetscMax(first, RangeStart(p, rank));
  const PetscInt high = rank + 1 < p->size ? PetscMin(first + n, RangeStart(p, rank + 1)) : first + n;

  return PetscMax(0, high - low);
}

/* Keeps what has come for this rank. */
static PetscErrorCode Keep(Portions *p, const PetscInt head[], const PetscInt values[], const PetscReal places[])
{
  const PetscInt n = head[HEAD_N], block = head[HEAD_BLOCK];

  PetscFunctionBeginUser;
  if (head[HEAD_KIND] == PORTION_TAGS) {
    if (!p->node_tag) PetscCall(PetscMalloc1(head[HEAD_ROOM], &p->node_tag));
    PetscCall(PetscArraycpy(p->node_tag + p->n_tags, values, n));
    p->n_tags += n;
  } else if (head[HEAD_KIND] == PORTION_PLACES) {
    if (!p->coords) PetscCall(PetscMalloc1(3 * head[HEAD_ROOM], &p->coords));
    PetscCall(PetscArraycpy(p->coords + 3 * p->n_places, places, 3 * n));
    p->n_places += n;
  } else {
    PortionBlock *kept;

    if (block >= p->n_blocks) {
      if (block >= p->room) {
        p->room = 2 * (int)block + 1;
        PetscCall(PetscRealloc((size_t)p->room * sizeof(*p->blocks), &p->blocks));
      }
      while (p->n_blocks <= block) p->blocks[p->n_blocks++] = (PortionBlock){0};
    }
    kept        = &p->blocks[block];
    kept->nodes = (int)head[HEAD_WIDTH] - 1;
    if (!kept->tag) PetscCall(PetscMalloc1(head[HEAD_ROOM], &kept->tag));
    if (!kept->connectivity) PetscCall(PetscMalloc1(head[HEAD_ROOM] * kept->nodes, &kept->connectivity));
    for (PetscInt i = 0; i < n; i++, kept->n++) {
      kept->tag[kept->n] = values[i * head[HEAD_WIDTH]];
      PetscCall(
        PetscArraycpy(kept->connectivity + kept->n * kept->nodes, values + i * head[HEAD_WIDTH] + 1, kept->nodes));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sends the items that are waiting. */
static PetscErrorCode Flush(Portions *p)
{
  PetscInt    head[HEAD_SIZE];
  PetscMPIInt count;

  PetscFunctionBeginUser;
  if (!p->n) PetscFunctionReturn(PETSC_SUCCESS);
  head[HEAD_KIND]  = p->kind;
  head[HEAD_BLOCK] = p->block;
  head[HEAD_WIDTH] = p->width;
  head[HEAD_ROOM] =
    p->kind == PORTION_ELEMENTS ? RangeCount(p, p->to, p->first, p->n_block) : RangeCount(p, p->to, 0, p->n_all);
  head[HEAD_N] = p->n;
  if (p->to == p->rank)
    PetscCall(Keep(p, head, p->values, p->places));
  else {
    PetscCall(PetscMPIIntCast(p->n * p->width, &count));
    PetscCallMPI(MPI_Send(head, HEAD_SIZE, MPIU_INT, p->to, 0, p->comm));
    if (p->kind == PORTION_PLACES)
      PetscCallMPI(MPI_Send(p->places, count, MPIU_REAL, p->to, 0, p->comm));
    else
      PetscCallMPI(MPI_Send(p->values, count, MPIU_INT, p->to, 0, p->comm));
  }
  p->n = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes room for the next item, which has this place among those of its kind in the file. */
static PetscErrorCode Next(Portions *p, int kind, PetscInt place, int width)
{
  const int change = kind != p->kind || p->n == PORTION;

  PetscFunctionBeginUser;
  if (change) PetscCall(Flush(p));
  p->kind  = kind;
  p->width = width;
  if (change && (place < RangeStart(p, p->to))) p->to = 0;
  while (p->to + 1 < p->size && place >= RangeStart(p, p->to + 1)) {
    PetscCall(Flush(p));
    p->to++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PortionsCreate - begins to share a file out.

  Collective

  Input Parameter:
. comm - the ranks

  Output Parameter:
. p - to be freed with PortionsReset()
@*/
PetscErrorCode PortionsCreate(MPI_Comm comm, Portions *p)
{
  PetscFunctionBeginUser;
  *p = (Portions){.comm = comm, .kind = PORTION_END};
  PetscCallMPI(MPI_Comm_rank(comm, &p->rank));
  PetscCallMPI(MPI_Comm_size(comm, &p->size));
  PetscCall(PetscMalloc2(PORTION * PORTION_WIDTH, &p->values, 3 * PORTION, &p->places));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PortionsNodes - begins with the nodes.

  Not collective, on the first rank

  Input Parameters:
+ p - from PortionsCreate()
- n - number of nodes in the file
@*/
PetscErrorCode PortionsNodes(Portions *p, PetscInt n)
{
  PetscFunctionBeginUser;
  PetscCall(Flush(p));
  p->n_all = n;
  p->to    = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PortionsTag - gives the tag of a node to its rank.

  Not collective, on the first rank

  Input Parameters:
+ p   - after PortionsNodes()
. i   - place of the node in the file, ascending
- tag - its tag
@*/
PetscErrorCode PortionsTag(Portions *p, PetscInt i, PetscInt tag)
{
  PetscFunctionBeginUser;
  PetscCall(Next(p, PORTION_TAGS, i, 1));
  p->values[p->n++] = tag;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PortionsPlace - gives the coordinates of a node to its rank.

  Not collective, on the first rank

  Input Parameters:
+ p - after PortionsNodes()
. i - place of the node in the file, ascending
- x - its coordinates
@*/
PetscErrorCode PortionsPlace(Portions *p, PetscInt i, const PetscReal x[3])
{
  PetscFunctionBeginUser;
  PetscCall(Next(p, PORTION_PLACES, i, 3));
  PetscCall(PetscArraycpy(p->places + 3 * p->n++, x, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PortionsElements - begins with the elements.

  Not collective, on the first rank

  Input Parameters:
+ p - from PortionsCreate()
- n - number of elements in the file as it states it, by which the ranges are chosen
@*/
PetscErrorCode PortionsElements(Portions *p, PetscInt n)
{
  PetscFunctionBeginUser;
  PetscCall(Flush(p));
  p->n_all = PetscMax(n, 0);
  p->at = p->n_block = 0;
  p->block           = -1;
  p->to              = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PortionsBlock - begins a block of elements.

  Not collective, on the first rank

  Input Parameters:
+ p     - after PortionsElements()
. nodes - of each element
- n     - number of elements
@*/
PetscErrorCode PortionsBlock(Portions *p, int nodes, PetscInt n)
{
  PetscFunctionBeginUser;
  PetscCall(Flush(p));
  p->block++;
  p->width   = 1 + nodes;
  p->first   = p->at;
  p->n_block = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PortionsElement - gives an element to its rank.

  Not collective, on the first rank

  Input Parameters:
+ p     - after PortionsBlock()
. tag   - of the element
- nodes - tags of its nodes
@*/
PetscErrorCode PortionsElement(Portions *p, PetscInt tag, const PetscInt nodes[])
{
  PetscFunctionBeginUser;
  PetscCall(Next(p, PORTION_ELEMENTS, p->at++, p->width));
  p->values[p->n * p->width] = tag;
  PetscCall(PetscArraycpy(p->values + p->n * p->width + 1, nodes, p->width - 1));
  p->n++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PortionsEnd - sends what is left and tells the other ranks that there is no more.

  Not collective, on the first rank

  Input Parameter:
. p - from PortionsCreate()
@*/
PetscErrorCode PortionsEnd(Portions *p)
{
  const PetscInt head[HEAD_SIZE] = {PORTION_END};

  PetscFunctionBeginUser;
  PetscCall(Flush(p));
  for (PetscMPIInt r = 1; r < p->size; r++) PetscCallMPI(MPI_Send(head, HEAD_SIZE, MPIU_INT, r, 0, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PortionsReceive - takes what the first rank sends, until it ends.

  Not collective, on the other ranks

  Input Parameter:
. p - from PortionsCreate()
@*/
PetscErrorCode PortionsReceive(Portions *p)
{
  PetscInt    head[HEAD_SIZE];
  PetscMPIInt count;

  PetscFunctionBeginUser;
  for (;;) {
    PetscCallMPI(MPI_Recv(head, HEAD_SIZE, MPIU_INT, 0, 0, p->comm, MPI_STATUS_IGNORE));
    if (head[HEAD_KIND] == PORTION_END) break;
    PetscCall(PetscMPIIntCast(head[HEAD_N] * head[HEAD_WIDTH], &count));
    if (head[HEAD_KIND] == PORTION_PLACES)
      PetscCallMPI(MPI_Recv(p->places, count, MPIU_REAL, 0, 0, p->comm, MPI_STATUS_IGNORE));
    else
      PetscCallMPI(MPI_Recv(p->values, count, MPIU_INT, 0, 0, p->comm, MPI_STATUS_IGNORE));
    PetscCall(Keep(p, head, p->values, p->places));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PortionsReset - frees what nobody has taken.

  Not collective

  Input Parameter:
. p - from PortionsCreate()
@*/
PetscErrorCode PortionsReset(Portions *p)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(p->values, p->places));
  PetscCall(PetscFree(p->node_tag));
  PetscCall(PetscFree(p->coords));
  for (int b = 0; b < p->n_blocks; b++) {
    PetscCall(PetscFree(p->blocks[b].tag));
    PetscCall(PetscFree(p->blocks[b].connectivity));
  }
  PetscCall(PetscFree(p->blocks));
  PetscFunctionReturn(PETSC_SUCCESS);
}
