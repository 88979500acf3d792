/* The mesh of a file: its groups, and its nodes and elements, which the ranks share. */
#include "gmshmesh.h"
#include "base/exchange.h"
#include "tagranges.h"
#include <stdio.h>
#include <stdlib.h>

/* Groups */

/*@
  GmshPhysicalIndex - finds a group.

  Not collective

  Input Parameters:
+ mesh - its groups
. dim  - its dimension
- tag  - its tag

  Note:
  Returns its index, -1: there is no such group.
@*/
int GmshPhysicalIndex(const GmshMesh *mesh, int dim, PetscInt tag)
{
  for (int i = 0; i < mesh->n_physicals; i++)
    if (mesh->physicals[i].dim == dim && mesh->physicals[i].tag == tag) return i;
  return -1;
}

/*@
  GmshAddPhysical - adds a group that has no name in the file.

  Not collective

  Input Parameters:
+ mesh - gets the group
. dim  - its dimension
- tag  - its tag, which becomes its name

  Output Parameter:
. index - its place in the mesh
@*/
PetscErrorCode GmshAddPhysical(GmshMesh *mesh, int dim, PetscInt tag, int *index)
{
  char name[24];

  PetscFunctionBeginUser;
  snprintf(name, sizeof(name), "%" PetscInt_FMT, tag);
  *index = mesh->n_physicals++;
  PetscCall(PetscRealloc((size_t)mesh->n_physicals * sizeof(*mesh->physicals), &mesh->physicals));
  mesh->physicals[*index] = (GmshPhysical){.dim = dim, .tag = tag};
  PetscCall(PetscStrallocpy(name, &mesh->physicals[*index].name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int ComparePhysicals(const void *a, const void *b)
{
  const GmshPhysical *p = a, *q = b;

  if (p->dim != q->dim) return p->dim > q->dim ? -1 : 1;
  return p->tag < q->tag ? -1 : p->tag > q->tag;
}

/*@
  GmshSortPhysicals - sorts the groups by descending dimension, then by tag.

  Not collective

  Input Parameter:
. mesh - the groups of its blocks are updated
@*/
PetscErrorCode GmshSortPhysicals(GmshMesh *mesh)
{
  GmshPhysical *old;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_physicals, &old));
  PetscCall(PetscArraycpy(old, mesh->physicals, mesh->n_physicals));
  qsort(mesh->physicals, (size_t)mesh->n_physicals, sizeof(*mesh->physicals), ComparePhysicals);
  for (int b = 0; b < mesh->n_blocks; b++) {
    for (int i = 0; i < mesh->blocks[b].n_physicals; i++) {
      const GmshPhysical *physical = &old[mesh->blocks[b].physical[i]];

      mesh->blocks[b].physical[i] = GmshPhysicalIndex(mesh, physical->dim, physical->tag);
    }
  }
  PetscCall(PetscFree(old));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes and elements of all ranks */

static PetscErrorCode BlockFree(GmshBlock *block)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(block->tag));
  PetscCall(PetscFree(block->connectivity));
  PetscCall(PetscFree2(block->physical, block->sign));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Entries of what is told of a block. The indices of its groups and their signs follow. */
enum { BLOCK_DIM, BLOCK_TYPE, BLOCK_NODES, BLOCK_ALL, BLOCK_FIRST_TAG, BLOCK_PHYSICALS, BLOCK_HEADER };

/* Writes down what is told of the blocks. Returns the number of entries. */
static PetscInt LoadBlocks(const GmshMesh *mesh, PetscInt *told)
{
  PetscInt n = 0;

  for (int b = 0; b < mesh->n_blocks; b++) {
    const GmshBlock *block = &mesh->blocks[b];

    if (told) {
      told[n + BLOCK_DIM]       = block->dim;
      told[n + BLOCK_TYPE]      = block->element ? block->element->gmsh : GMSH_POINT;
      told[n + BLOCK_NODES]     = block->nodes;
      told[n + BLOCK_ALL]       = block->n_all;
      told[n + BLOCK_FIRST_TAG] = block->first_tag;
      told[n + BLOCK_PHYSICALS] = block->n_physicals;
      for (int i = 0; i < block->n_physicals; i++) {
        told[n + BLOCK_HEADER + 2 * i]     = block->physical[i];
        told[n + BLOCK_HEADER + 2 * i + 1] = block->sign[i];
      }
    }
    n += BLOCK_HEADER + 2 * block->n_physicals;
  }
  return n;
}

/* Makes blocks without elements of what was told. */
static PetscErrorCode MakeBlocks(const PetscInt *told, GmshMesh *mesh)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_blocks, &mesh->blocks));
  for (int b = 0; b < mesh->n_blocks; b++, told += BLOCK_HEADER + 2 * told[BLOCK_PHYSICALS]) {
    GmshBlock *block = &mesh->blocks[b];

    *block = (GmshBlock){.dim         = (int)told[BLOCK_DIM],
                         .element     = ElementFromGmsh((int)told[BLOCK_TYPE]),
                         .nodes       = (int)told[BLOCK_NODES],
                         .n_all       = told[BLOCK_ALL],
                         .first_tag   = told[BLOCK_FIRST_TAG],
                         .n_physicals = (int)told[BLOCK_PHYSICALS]};
    PetscCall(PetscMalloc2(block->n_physicals, &block->physical, block->n_physicals, &block->sign));
    for (int i = 0; i < block->n_physicals; i++) {
      block->physical[i] = (int)told[BLOCK_HEADER + 2 * i];
      block->sign[i]     = (int)told[BLOCK_HEADER + 2 * i + 1];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells all ranks of the blocks. */
static PetscErrorCode ShareBlocks(MPI_Comm comm, GmshMesh *mesh)
{
  PetscMPIInt rank, count;
  PetscInt    n[3] = {mesh->n_physicals, mesh->n_blocks, LoadBlocks(mesh, NULL)}, *told;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Bcast(n, 3, MPIU_INT, 0, comm));
  mesh->n_physicals = (int)n[0];
  mesh->n_blocks    = (int)n[1];
  PetscCall(PetscMPIIntCast(n[2], &count));
  PetscCall(PetscMalloc1(count, &told));
  if (!rank) LoadBlocks(mesh, told);
  PetscCallMPI(MPI_Bcast(told, count, MPIU_INT, 0, comm));
  if (rank) PetscCall(MakeBlocks(told, mesh));
  PetscCall(PetscFree(told));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A node on its way to the rank of its tag */
typedef struct {
  PetscInt  tag;
  PetscReal x[3];
} TravelNode;

static void PackNode(const void *context, PetscInt i, void *packed)
{
  const Portions *portions = context;
  TravelNode     *node     = packed;

  node->tag = portions->node_tag[i];
  for (int k = 0; k < 3; k++) node->x[k] = portions->coords[3 * i + k];
}

/* Gives the nodes to the ranks by ascending tag, because their order in the file is arbitrary. */
static PetscErrorCode SortNodes(MPI_Comm comm, const char *file, Portions *portions, GmshMesh *mesh,
                                Complaint *complaint)
{
  PetscMPIInt size, *to;
  PetscInt   *first, *order, *tags;
  TravelNode *nodes;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMalloc1(portions->n_tags, &to));
  PetscCall(TagRangesChoose(comm, portions->n_tags, portions->node_tag, &first));
  for (PetscInt i = 0; i < portions->n_tags; i++) to[i] = TagRangesRank(size, first, portions->node_tag[i]);
  PetscCall(PetscFree(first));
  PetscCall(ExchangeRecords(comm, sizeof(TravelNode), portions->n_tags, to, PackNode, portions, &mesh->n_nodes,
                            (void **)&nodes));
  PetscCall(PetscFree(to));
  PetscCall(PetscFree(portions->node_tag));
  PetscCall(PetscFree(portions->coords));
  PetscCall(PetscMalloc2(mesh->n_nodes, &order, mesh->n_nodes, &tags));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    order[i] = i;
    tags[i]  = nodes[i].tag;
  }
  PetscCall(PetscSortIntWithPermutation(mesh->n_nodes, tags, order));
  PetscCall(PetscMalloc2(mesh->n_nodes, &mesh->node_tag, 3 * mesh->n_nodes, &mesh->coords));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    mesh->node_tag[i] = tags[order[i]];
    for (int k = 0; k < 3; k++) mesh->coords[3 * i + k] = nodes[order[i]].x[k];
    if (i && mesh->node_tag[i] == mesh->node_tag[i - 1])
      Complain(complaint, "%s: node %" PetscInt_FMT " occurs twice", file, mesh->node_tag[i]);
  }
  PetscCall(PetscFree(nodes));
  PetscCall(PetscFree2(order, tags));
  PetscCall(ExchangeStarts(comm, mesh->n_nodes, &mesh->node_start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the blocks this rank's elements. Their nodes are tags yet. */
static PetscErrorCode TakeElements(Portions *portions, GmshMesh *mesh)
{
  PetscFunctionBeginUser;
  for (int b = 0; b < portions->n_blocks; b++) {
    PortionBlock *portion = &portions->blocks[b];

    mesh->blocks[b].n            = portion->n;
    mesh->blocks[b].tag          = portion->tag;
    mesh->blocks[b].connectivity = portion->connectivity;
    portion->tag = portion->connectivity = NULL;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GmshListNodes - lists the nodes of all elements, tags or places as the blocks have them.

  Not collective

  Input Parameter:
. mesh - the mesh

  Output Parameter:
. nodes - each of them once; to be freed with IntegerSetDestroy()
@*/
PetscErrorCode GmshListNodes(const GmshMesh *mesh, IntegerSet *nodes)
{
  PetscInt        *size;
  const PetscInt **list;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(mesh->n_blocks, &size, mesh->n_blocks, &list));
  for (int b = 0; b < mesh->n_blocks; b++) {
    size[b] = mesh->blocks[b].n * mesh->blocks[b].nodes;
    list[b] = mesh->blocks[b].connectivity;
  }
  PetscCall(IntegerSetCreate(mesh->n_blocks, size, list, nodes));
  PetscCall(PetscFree2(size, list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void PackInteger(const void *context, PetscInt i, void *packed)
{
  *(PetscInt *)packed = ((const PetscInt *)context)[i];
}

/* Says to which rank a question about each of the tags goes, which ascend: the last one whose first tag is not larger.
 */
static PetscErrorCode ChooseAsked(MPI_Comm comm, const GmshMesh *mesh, PetscInt n, const PetscInt tags[],
                                  PetscMPIInt to[])
{
  PetscMPIInt size, asked = 0;
  PetscInt   *first, mine = mesh->n_nodes ? mesh->node_tag[0] : PETSC_MAX_INT;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMalloc1(size, &first));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPIU_INT, first, 1, MPIU_INT, comm));
  for (PetscInt i = 0; i < n; i++) {
    for (PetscMPIInt r = asked + 1; r < size; r++)
      if (first[r] <= tags[i]) asked = r;
    to[i] = asked;
  }
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the places of nodes by their tags, which ascend; -1: there is no such node. Marks them as used. */
static PetscErrorCode FindNodes(MPI_Comm comm, const GmshMesh *mesh, PetscInt n, const PetscInt tags[],
                                PetscInt **places, char used[])
{
  PetscMPIInt rank, *to, *from;
  PetscInt    n_asked, n_answers, *asked;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMalloc1(n, &to));
  PetscCall(ChooseAsked(comm, mesh, n, tags, to));
  PetscCall(ExchangeSources(comm, n, to, &from));
  PetscCall(ExchangeRecords(comm, sizeof(PetscInt), n, to, PackInteger, tags, &n_asked, (void **)&asked));
  for (PetscInt i = 0; i < n_asked; i++) {
    PetscInt place;

    PetscCall(PetscFindInt(asked[i], mesh->n_nodes, mesh->node_tag, &place));
    asked[i] = place < 0 ? -1 : mesh->node_start[rank] + place;
    if (place >= 0) used[place] = 1;
  }
  PetscCall(ExchangeRecords(comm, sizeof(PetscInt), n_asked, from, PackInteger, asked, &n_answers, (void **)places));
  PetscCall(PetscFree(asked));
  PetscCall(PetscFree(from));
  PetscCall(PetscFree(to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Replaces the tags of the elements' nodes by their places, and looks for nodes that are not there or not used. */
static PetscErrorCode PlaceNodes(MPI_Comm comm, const char *file, GmshMesh *mesh, Complaint *missing, Complaint *unused)
{
  IntegerSet tags;
  PetscInt  *places;
  char      *used;

  PetscFunctionBeginUser;
  PetscCall(GmshListNodes(mesh, &tags));
  PetscCall(PetscCalloc1(mesh->n_nodes, &used));
  PetscCall(FindNodes(comm, mesh, tags.n, tags.value, &places, used));
  for (int b = 0; b < mesh->n_blocks; b++) {
    const GmshBlock *block = &mesh->blocks[b];

    for (PetscInt k = 0; k < block->n * block->nodes; k++) {
      const PetscInt tag = block->connectivity[k];
      const PetscInt at  = IntegerSetPlace(&tags, tag);

      block->connectivity[k] = places[at];
      if (places[at] < 0)
        Complain(missing, "%s: element %" PetscInt_FMT " has node %" PetscInt_FMT ", which is not in the file", file,
                 block->tag[k / block->nodes], tag);
    }
  }
  for (PetscInt i = 0; i < mesh->n_nodes; i++)
    if (!used[i]) Complain(unused, "%s: node %" PetscInt_FMT " belongs to no element", file, mesh->node_tag[i]);
  PetscCall(IntegerSetDestroy(&tags));
  PetscCall(PetscFree(places));
  PetscCall(PetscFree(used));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves out the blocks that belong to no physical group. */
static PetscErrorCode DropBlocks(GmshMesh *mesh)
{
  int n = 0;

  PetscFunctionBeginUser;
  for (int b = 0; b < mesh->n_blocks; b++) {
    if (mesh->blocks[b].n_physicals)
      mesh->blocks[n++] = mesh->blocks[b];
    else
      PetscCall(BlockFree(&mesh->blocks[b]));
  }
  mesh->n_blocks = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GmshJoin - makes the mesh of the portions of all ranks.

  Collective

  Input Parameters:
+ comm     - the ranks that share the mesh
. file     - path, for messages
. portions - what each rank keeps; the mesh takes it
- mesh     - on the first rank, groups and blocks without elements

  Output Parameter:
. complaint - says what is wrong with the file, if anything, on some ranks
@*/
PetscErrorCode GmshJoin(MPI_Comm comm, const char *file, Portions *portions, GmshMesh *mesh, Complaint *complaint)
{
  Complaint missing = {""};
  PetscBool failed;

  PetscFunctionBeginUser;
  PetscCall(ComplaintAnywhere(comm, complaint, &failed));
  if (failed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ShareBlocks(comm, mesh));
  PetscCall(SortNodes(comm, file, portions, mesh, complaint));
  PetscCall(TakeElements(portions, mesh));
  PetscCall(ComplaintAnywhere(comm, complaint, &failed));
  if (failed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PlaceNodes(comm, file, mesh, &missing, complaint));
  PetscCall(ComplaintAnywhere(comm, &missing, &failed));
  if (failed) *complaint = missing;
  PetscCall(DropBlocks(mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GmshFreeElements - frees this rank's elements of a block.

  Not collective

  Input Parameter:
. block - has none afterwards
@*/
PetscErrorCode GmshFreeElements(GmshBlock *block)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(block->tag));
  PetscCall(PetscFree(block->connectivity));
  block->n = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GmshFreeBlocks - frees all blocks.

  Not collective

  Input Parameter:
. mesh - its nodes and groups stay
@*/
PetscErrorCode GmshFreeBlocks(GmshMesh *mesh)
{
  PetscFunctionBeginUser;
  for (int b = 0; b < mesh->n_blocks; b++) PetscCall(BlockFree(&mesh->blocks[b]));
  PetscCall(PetscFree(mesh->blocks));
  mesh->n_blocks = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GmshReset - frees what GmshRead() made.

  Not collective

  Input Parameter:
. mesh - emptied
@*/
PetscErrorCode GmshReset(GmshMesh *mesh)
{
  PetscFunctionBeginUser;
  PetscCall(GmshFreeBlocks(mesh));
  for (int i = 0; mesh->physicals && i < mesh->n_physicals; i++) PetscCall(PetscFree(mesh->physicals[i].name));
  PetscCall(PetscFree(mesh->physicals));
  PetscCall(PetscFree(mesh->notes));
  PetscCall(PetscFree2(mesh->node_tag, mesh->coords));
  PetscCall(PetscFree(mesh->node_start));
  *mesh = (GmshMesh){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}
