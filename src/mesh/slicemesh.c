/* Reads the mesh, checks it against the scene, and shares cells and nodes out by their tags. */
#include "slicemesh.h"
#include "mesh/meshgroup.h"
#include "base/exchange.h"
#include "base/integerset.h"
#include "tagranges.h"
#include <stdlib.h>
#include <string.h>

/* Distance from the plane z = 0, or from the axis, that is treated as round-off, as a part of the mesh's size. */
static const PetscReal PLANE_TOLERANCE = 1e-9;

/*@
  SliceMeshCellNodes - returns the nodes of a cell.

  Not collective

  Input Parameters:
+ slice - after SliceMeshRead()
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
+ slice - after SliceMeshRead()
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
- ids   - ascending

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
    while (ids[i] >= start[r + 1]) r++;
    remote[i] = (PetscSFNode){.rank = r, .index = ids[i] - start[r]};
  }
  PetscCall(PetscSFCreate(slice->comm, sf));
  PetscCall(PetscSFSetGraph(*sf, start[slice->rank + 1] - start[slice->rank], n, NULL, PETSC_OWN_POINTER, remote,
                            PETSC_OWN_POINTER));
  PetscCall(PetscSFSetUp(*sf));
  PetscFunctionReturn(PETSC_SUCCESS);
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

/* Bodies and order */

/* Lists the names of the groups of one dimension, as in "a, b, c", cut off where the text is full. */
static void ListPhysicals(const GmshMesh *gmsh, int dim, char list[MESH_TEXT])
{
  size_t used = 0;

  snprintf(list, MESH_TEXT, "none");
  for (int i = 0; i < gmsh->n_physicals && used < MESH_TEXT; i++)
    if (gmsh->physicals[i].dim == dim)
      used += (size_t)snprintf(list + used, MESH_TEXT - used, "%s%s", used ? ", " : "", gmsh->physicals[i].name);
}

/* Does the mesh have a group of this name and dimension? */
static PetscBool HasPhysical(const GmshMesh *gmsh, int dim, const char *name)
{
  for (int i = 0; i < gmsh->n_physicals; i++)
    if (gmsh->physicals[i].dim == dim && !strcmp(gmsh->physicals[i].name, name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* What a group of a body's name that has the other dimension says about the scene; "" where there is none. */
static const char *OtherGeometry(Scene scene, const GmshMesh *gmsh, const char *name)
{
  if (!HasPhysical(gmsh, 5 - scene->dim, name)) return "";
  return scene->dim == 3 ? "; the name is that of a plane surface: allowed are geometry plane_strain, plane_stress or "
                           "axisymmetric"
                         : "; the name is that of a volume: allowed is geometry solid";
}

/* Checks that every deformable body is a volume group of the mesh. This comes first, because a misspelt name also
   leaves a group without a body. */
static void CheckBodyNames(Scene scene, const char *file, const SliceMesh *slice, Complaint *complaint)
{
  const GmshMesh *gmsh = &slice->gmsh;
  char            list[MESH_TEXT];

  ListPhysicals(gmsh, scene->dim, list);
  for (int b = 0; b < scene->n_bodies; b++) {
    const char *name = scene->bodies[b].name;

    if (scene->bodies[b].rigid || HasPhysical(gmsh, scene->dim, name)) continue;
    Complain(complaint, "%s: the mesh '%s' has no volume group '%s'; its volume groups: %s%s",
             SceneWhere(scene, scene->bodies[b].path, "volume"), file, name, list, OtherGeometry(scene, gmsh, name));
  }
}

/* Returns the one body whose volume group contains the block, -1 after a mistake. */
static int BlockBody(Scene scene, const char *file, const SliceMesh *slice, const GmshBlock *block,
                     Complaint *complaint)
{
  int body = -1;

  for (int i = 0; i < block->n_physicals; i++) {
    const char *name  = slice->gmsh.physicals[block->physical[i]].name;
    const int   found = MeshFindBody(scene, name, PETSC_FALSE);

    if (found < 0) {
      Complain(complaint,
               "%s: the mesh '%s' has a volume group '%s' that is no body of the scene; list it with its material",
               SceneWhere(scene, "bodies", NULL), file, name);
    } else if (body >= 0) {
      Complain(complaint, "%s: cell %" PetscInt_FMT " is in two bodies, '%s' and '%s'", file, block->first_tag,
               scene->bodies[body].name, scene->bodies[found].name);
    }
    body = found;
  }
  return body;
}

/* Checks that all elements have one order, which is that of the scene. */
static void CheckOrder(Scene scene, const char *file, const SliceMesh *slice, Complaint *complaint)
{
  const GmshBlock *first = NULL;

  for (int b = 0; b < slice->gmsh.n_blocks; b++) {
    const GmshBlock *block = &slice->gmsh.blocks[b];

    if (!block->element || !block->n_all) continue;
    if (!first) first = block;
    if (block->element->order != first->element->order) {
      Complain(complaint, "%s: elements of two orders: %" PetscInt_FMT " is %s, %" PetscInt_FMT " is %s", file,
               first->first_tag, first->element->name, block->first_tag, block->element->name);
    }
  }
  if (first && scene->order && first->element->order != scene->order) {
    Complain(complaint, "%s: order is %d, but the elements of '%s' (%s) are of order %d",
             SceneWhere(scene, "mesh", "order"), scene->order, file, first->element->name, first->element->order);
  }
}

static void CheckBodies(Scene scene, const char *file, const SliceMesh *slice, const PetscInt cells[],
                        Complaint *complaint)
{
  char list[MESH_TEXT];

  ListPhysicals(&slice->gmsh, scene->dim, list);
  for (int b = 0; b < scene->n_bodies; b++) {
    if (scene->bodies[b].rigid || cells[b]) continue;
    Complain(complaint, "%s: the mesh '%s' has no cells of a volume group '%s'; its volume groups: %s",
             SceneWhere(scene, scene->bodies[b].path, "volume"), file, scene->bodies[b].name, list);
  }
}

/* Cells */

/* Counts the cells of the scene's dimension and complains of elements of a higher dimension. */
static PetscInt CountCells(Scene scene, const char *file, const GmshMesh *gmsh, Complaint *complaint)
{
  PetscInt n = 0;

  for (int b = 0; b < gmsh->n_blocks; b++) {
    if (gmsh->blocks[b].dim > scene->dim)
      Complain(complaint, "%s: the mesh '%s' has volumes; a two-dimensional one is needed",
               SceneWhere(scene, "geometry", NULL), file);
    if (gmsh->blocks[b].dim == scene->dim) n += gmsh->blocks[b].n_all;
  }
  return n;
}

/* Finds the body of each block, -1 for a block without cells, and checks that every body has cells. */
static PetscErrorCode BlockBodies(Scene scene, const char *file, const SliceMesh *slice, int body[],
                                  Complaint *complaint)
{
  PetscInt *per_body;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(scene->n_bodies, &per_body));
  for (int b = 0; b < slice->gmsh.n_blocks; b++) {
    const GmshBlock *block = &slice->gmsh.blocks[b];

    body[b] = block->dim == scene->dim ? BlockBody(scene, file, slice, block, complaint) : -1;
    if (body[b] >= 0) per_body[body[b]] += block->n_all;
  }
  CheckBodies(scene, file, slice, per_body, complaint);
  PetscCall(PetscFree(per_body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks groups and blocks, and finds the body of each block. */
static PetscErrorCode CheckBlocks(Scene scene, const char *file, const SliceMesh *slice, int body[],
                                  Complaint *complaint)
{
  PetscFunctionBeginUser;
  if (!slice->rank) {
    CheckBodyNames(scene, file, slice, complaint);
    CheckOrder(scene, file, slice, complaint);
    (void)CountCells(scene, file, &slice->gmsh, complaint);
    PetscCall(BlockBodies(scene, file, slice, body, complaint));
  }
  PetscCallMPI(MPI_Bcast(body, slice->gmsh.n_blocks, MPI_INT, 0, slice->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Entries of a cell's record on its way to its slice. The places of its nodes among gmsh's follow. */
enum { CELL_TAG, CELL_BLOCK, CELL_HEADER };

/* The cells of this rank's part of the file. */
typedef struct {
  const GmshMesh *gmsh;
  int             width;
  PetscInt        n, *tag, *item;
  int            *block;
} FileCells;

static PetscErrorCode ListFileCells(Scene scene, const GmshMesh *gmsh, FileCells *cells)
{
  PetscFunctionBeginUser;
  *cells = (FileCells){.gmsh = gmsh};
  for (int b = 0; b < gmsh->n_blocks; b++) cells->n += gmsh->blocks[b].dim == scene->dim ? gmsh->blocks[b].n : 0;
  PetscCall(PetscMalloc3(cells->n, &cells->tag, cells->n, &cells->item, cells->n, &cells->block));
  cells->n = 0;
  for (int b = 0; b < gmsh->n_blocks; b++) {
    for (PetscInt i = 0; i < gmsh->blocks[b].n && gmsh->blocks[b].dim == scene->dim; i++, cells->n++) {
      cells->tag[cells->n]   = gmsh->blocks[b].tag[i];
      cells->item[cells->n]  = i;
      cells->block[cells->n] = b;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void PackCell(const void *context, PetscInt i, void *packed)
{
  const FileCells *cells  = context;
  const GmshBlock *block  = &cells->gmsh->blocks[cells->block[i]];
  PetscInt        *record = packed;

  record[CELL_TAG]   = cells->tag[i];
  record[CELL_BLOCK] = cells->block[i];
  for (int k = 0; k < cells->width; k++) /* the first node fills up what larger cells need */
    record[CELL_HEADER + k] = block->connectivity[cells->item[i] * block->nodes + (k < block->nodes ? k : 0)];
}

/* Sends the cells of the file to the ranks of their tags and frees them. */
static PetscErrorCode SendCells(Scene scene, SliceMesh *slice, PetscInt *n, PetscInt **records)
{
  GmshMesh    *gmsh = &slice->gmsh;
  FileCells    cells;
  PetscInt    *first;
  PetscMPIInt *to;

  PetscFunctionBeginUser;
  slice->width = 0;
  for (int b = 0; b < gmsh->n_blocks; b++)
    if (gmsh->blocks[b].dim == scene->dim) slice->width = PetscMax(slice->width, gmsh->blocks[b].nodes);
  PetscCall(ListFileCells(scene, gmsh, &cells));
  cells.width = slice->width;
  PetscCall(PetscMalloc1(cells.n, &to));
  PetscCall(TagRangesChoose(slice->comm, cells.n, cells.tag, &first));
  for (PetscInt i = 0; i < cells.n; i++) to[i] = SliceMeshRankOf(slice, first, cells.tag[i]);
  PetscCall(PetscFree(first));
  PetscCall(ExchangeRecords(slice->comm, (size_t)(CELL_HEADER + slice->width) * sizeof(PetscInt), cells.n, to, PackCell,
                            &cells, n, (void **)records));
  PetscCall(PetscFree(to));
  PetscCall(PetscFree3(cells.tag, cells.item, cells.block));
  for (int b = 0; b < gmsh->n_blocks; b++)
    if (gmsh->blocks[b].dim == scene->dim) PetscCall(GmshFreeElements(&gmsh->blocks[b]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers the cells by ascending tag. Their nodes are places among gmsh's yet. body: of each block */
static PetscErrorCode NumberCells(Scene scene, const char *file, SliceMesh *slice, const int body[],
                                  Complaint *complaint)
{
  PetscInt n, *records, *order, *tag;
  int      stride;

  PetscFunctionBeginUser;
  PetscCall(SendCells(scene, slice, &n, &records));
  stride = CELL_HEADER + slice->width;
  PetscCall(PetscMalloc2(n, &order, n, &tag));
  PetscCall(PetscMalloc4(n, &slice->cell_block, n, &slice->cell_body, n, &slice->cell_tag, n * slice->width,
                         &slice->cell_nodes));
  for (PetscInt c = 0; c < n; c++) {
    order[c] = c;
    tag[c]   = records[c * stride + CELL_TAG];
  }
  PetscCall(PetscSortIntWithPermutation(n, tag, order));
  for (PetscInt c = 0; c < n; c++) {
    const PetscInt *record = &records[order[c] * stride];

    slice->cell_tag[c]   = record[CELL_TAG];
    slice->cell_block[c] = &slice->gmsh.blocks[record[CELL_BLOCK]];
    slice->cell_body[c]  = body[record[CELL_BLOCK]];
    PetscCall(PetscArraycpy(&slice->cell_nodes[c * slice->width], &record[CELL_HEADER], slice->width));
    if (c && slice->cell_tag[c] == slice->cell_tag[c - 1])
      Complain(complaint, "%s: two cells have the tag %" PetscInt_FMT, file, slice->cell_tag[c]);
  }
  slice->n_cells = n;
  PetscCall(PetscFree2(order, tag));
  PetscCall(PetscFree(records));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Shares the numbers that ranks have of something: start of each rank, and the number of all. */
static PetscErrorCode ShareStarts(const SliceMesh *slice, PetscInt n, PetscInt **start)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(slice->size + 1, start));
  (*start)[0] = 0;
  PetscCallMPI(MPI_Allgather(&n, 1, MPIU_INT, *start + 1, 1, MPIU_INT, slice->comm));
  for (PetscMPIInt r = 0; r < slice->size; r++) (*start)[r + 1] += (*start)[r];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes */

/* Lists the places of the slice's nodes among gmsh's, and numbers them in the cells by this list. */
static PetscErrorCode ListNodes(SliceMesh *slice, IntegerSet *places)
{
  const PetscInt        n     = slice->n_cells * slice->width;
  const PetscInt *const nodes = slice->cell_nodes;

  PetscFunctionBeginUser;
  PetscCall(IntegerSetCreate(1, &n, &nodes, places));
  for (PetscInt k = 0; k < n; k++) slice->cell_nodes[k] = IntegerSetPlace(places, slice->cell_nodes[k]);
  slice->n_nodes = places->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers gmsh's nodes that cells use: id of each in this rank's part, -1: no cell uses it. */
static PetscErrorCode NumberHomes(SliceMesh *slice, PetscSF sf, PetscInt id[])
{
  PetscInt *ones;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(slice->n_nodes, &ones));
  for (PetscInt i = 0; i < slice->n_nodes; i++) ones[i] = 1;
  for (PetscInt i = 0; i < slice->gmsh.n_nodes; i++) id[i] = -1;
  PetscCall(PetscSFReduceBegin(sf, MPIU_INT, ones, id, MPI_MAX));
  PetscCall(PetscSFReduceEnd(sf, MPIU_INT, ones, id, MPI_MAX));
  PetscCall(PetscFree(ones));
  PetscCall(PetscMalloc1(slice->gmsh.n_nodes, &slice->home));
  for (PetscInt i = 0; i < slice->gmsh.n_nodes; i++)
    if (id[i] > 0) slice->home[slice->n_homes++] = i;
  PetscCall(ShareStarts(slice, slice->n_homes, &slice->home_start));
  for (PetscInt i = 0; i < slice->n_homes; i++) id[slice->home[i]] = slice->home_start[slice->rank] + i;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the places of the nodes of the elements of lower dimension. */
static PetscErrorCode ListElementNodes(const GmshMesh *gmsh, IntegerSet *places)
{
  PetscInt        *size;
  const PetscInt **list;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(gmsh->n_blocks, &size, gmsh->n_blocks, &list));
  for (int b = 0; b < gmsh->n_blocks; b++) {
    size[b] = gmsh->blocks[b].n * gmsh->blocks[b].nodes;
    list[b] = gmsh->blocks[b].connectivity;
  }
  PetscCall(IntegerSetCreate(gmsh->n_blocks, size, list, places));
  PetscCall(PetscFree2(size, list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the ids of the nodes of elements of lower dimension. */
static PetscErrorCode FindElementIds(SliceMesh *slice, const PetscInt id[])
{
  const GmshMesh *gmsh = &slice->gmsh;
  IntegerSet      places;
  PetscInt       *ids;
  PetscSF         sf;

  PetscFunctionBeginUser;
  PetscCall(ListElementNodes(gmsh, &places));
  PetscCall(PetscMalloc1(places.n, &ids));
  PetscCall(SliceMeshSF(slice, gmsh->node_start, places.n, places.value, &sf));
  PetscCall(PetscSFBcastBegin(sf, MPIU_INT, id, ids, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, MPIU_INT, id, ids, MPI_REPLACE));
  PetscCall(PetscSFDestroy(&sf));
  PetscCall(PetscCalloc1(gmsh->n_blocks, &slice->element_ids));
  for (int b = 0; b < gmsh->n_blocks; b++) {
    const GmshBlock *block = &gmsh->blocks[b];

    PetscCall(PetscMalloc1(block->n * block->nodes, &slice->element_ids[b]));
    for (PetscInt k = 0; k < block->n * block->nodes; k++)
      slice->element_ids[b][k] = ids[IntegerSetPlace(&places, block->connectivity[k])];
  }
  PetscCall(PetscFree(ids));
  PetscCall(IntegerSetDestroy(&places));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers the nodes that cells use, by ascending tag, and gets those of the slice. */
static PetscErrorCode NumberNodes(SliceMesh *slice)
{
  IntegerSet   places;
  PetscInt    *id;
  PetscSF      sf;
  MPI_Datatype place;

  PetscFunctionBeginUser;
  PetscCall(ListNodes(slice, &places));
  PetscCall(SliceMeshSF(slice, slice->gmsh.node_start, places.n, places.value, &sf));
  PetscCall(IntegerSetDestroy(&places));
  PetscCall(PetscMalloc1(slice->gmsh.n_nodes, &id));
  PetscCall(NumberHomes(slice, sf, id));
  PetscCall(PetscMalloc2(slice->n_nodes, &slice->id, 3 * slice->n_nodes, &slice->coords));
  PetscCall(PetscSFBcastBegin(sf, MPIU_INT, id, slice->id, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, MPIU_INT, id, slice->id, MPI_REPLACE));
  PetscCallMPI(MPI_Type_contiguous(3, MPIU_REAL, &place));
  PetscCallMPI(MPI_Type_commit(&place));
  PetscCall(PetscSFBcastBegin(sf, place, slice->gmsh.coords, slice->coords, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, place, slice->gmsh.coords, slice->coords, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&place));
  PetscCall(PetscSFDestroy(&sf));
  PetscCall(FindElementIds(slice, id));
  PetscCall(PetscFree(id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Surfaces that run clockwise */

/* Does the outline of a plane cell run clockwise? */
static PetscBool CellIsClockwise(const SliceMesh *slice, PetscInt cell)
{
  const PetscInt *nodes = SliceMeshCellNodes(slice, cell);
  const int       n     = slice->cell_block[cell]->element->corners;
  PetscReal       twice = 0;

  for (int k = 0; k < n; k++) {
    const PetscReal *a = &slice->coords[3 * nodes[k]], *b = &slice->coords[3 * nodes[(k + 1) % n]];
    const PetscReal *o = &slice->coords[3 * nodes[0]];

    twice += (a[0] - o[0]) * (b[1] - o[1]) - (b[0] - o[0]) * (a[1] - o[1]);
  }
  return (PetscBool)(twice < 0);
}

/* An edge of a plane cell: its ends in ascending order, whether the cell runs along it that way, and whether the cell's
   surface runs clockwise. */
typedef struct {
  PetscInt node[2];
  int      along, clockwise;
} PlaneEdge;

static int PlaneEdgeCompare(const void *a, const void *b)
{
  const PlaneEdge *p = a, *q = b;

  if (p->node[0] != q->node[0]) return p->node[0] < q->node[0] ? -1 : 1;
  if (p->node[1] != q->node[1]) return p->node[1] < q->node[1] ? -1 : 1;
  return 0;
}

typedef struct {
  const SliceMesh *slice;
  const PetscBool *clockwise; /* for each block */
} Outlines;

/* Packs edge i % CELL_FACE_CORNERS of a cell. */
static void PackEdge(const void *context, PetscInt i, void *packed)
{
  const Outlines  *outlines = context;
  const SliceMesh *slice    = outlines->slice;
  const PetscInt   cell = i / CELL_FACE_CORNERS, *nodes = SliceMeshCellNodes(slice, cell);
  const int        k = (int)(i % CELL_FACE_CORNERS), corners = slice->cell_block[cell]->element->corners;
  const PetscInt   from = slice->id[nodes[k]], to = slice->id[nodes[(k + 1) % corners]];
  PlaneEdge       *edge = packed;

  edge->node[0]   = PetscMin(from, to);
  edge->node[1]   = PetscMax(from, to);
  edge->along     = from < to;
  edge->clockwise = outlines->clockwise[slice->cell_block[cell] - slice->gmsh.blocks];
}

/* Does a surface that runs clockwise lie on the same side of a common edge as one that does not? It is then folded over
   it, and turning its cells would hide that. */
static PetscErrorCode FindFold(const SliceMesh *slice, const PetscBool *clockwise, PetscBool *folded)
{
  const Outlines outlines = {slice, clockwise};
  PetscInt       n        = slice->n_cells * CELL_FACE_CORNERS;
  PetscMPIInt   *to;
  PlaneEdge     *edges;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &to));
  for (PetscInt i = 0; i < n; i++) {
    PlaneEdge edge;

    to[i] = -1;
    if (i % CELL_FACE_CORNERS >= slice->cell_block[i / CELL_FACE_CORNERS]->element->corners) continue;
    PackEdge(&outlines, i, &edge);
    to[i] = SliceMeshRankOf(slice, slice->home_start, edge.node[0]);
  }
  PetscCall(ExchangeRecords(slice->comm, sizeof(PlaneEdge), n, to, PackEdge, &outlines, &n, (void **)&edges));
  if (n) qsort(edges, (size_t)n, sizeof(*edges), PlaneEdgeCompare);
  *folded = PETSC_FALSE;
  for (PetscInt i = 1; i < n; i++)
    if (!PlaneEdgeCompare(&edges[i - 1], &edges[i]) && edges[i - 1].clockwise != edges[i].clockwise &&
        edges[i - 1].along != edges[i].along)
      *folded = PETSC_TRUE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, folded, 1, MPIU_BOOL, MPI_LOR, slice->comm));
  PetscCall(PetscFree(edges));
  PetscCall(PetscFree(to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says which surfaces run clockwise: all their cells do. Returns whether any does. */
static PetscErrorCode FindClockwise(const SliceMesh *slice, PetscBool *clockwise, PetscBool *any)
{
  const GmshMesh *gmsh = &slice->gmsh;
  PetscInt       *n;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(gmsh->n_blocks, &n));
  for (PetscInt c = 0; c < slice->n_cells; c++) n[slice->cell_block[c] - gmsh->blocks] += CellIsClockwise(slice, c);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n, gmsh->n_blocks, MPIU_INT, MPI_SUM, slice->comm));
  *any = PETSC_FALSE;
  for (int b = 0; b < gmsh->n_blocks; b++) {
    clockwise[b] = (PetscBool)(n[b] && n[b] == gmsh->blocks[b].n_all);
    *any         = (PetscBool)(*any || clockwise[b]);
  }
  PetscCall(PetscFree(n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Turns the plane cells of those surfaces whose outline runs clockwise in the file. A surface of which only some cells
   do is tangled, and one that is folded over its neighbour is wrong; they are left as they are. */
static PetscErrorCode TurnClockwise(SliceMesh *slice)
{
  PetscBool *clockwise, folded = PETSC_FALSE, any = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(slice->gmsh.n_blocks, &clockwise));
  PetscCall(FindClockwise(slice, clockwise, &any));
  if (any) PetscCall(FindFold(slice, clockwise, &folded));
  for (PetscInt c = 0; any && !folded && c < slice->n_cells; c++) {
    const GmshBlock *block = slice->cell_block[c];
    PetscInt        *nodes = slice->cell_nodes + c * slice->width, old[ELEMENT_MAX_NODES];

    if (!clockwise[block - slice->gmsh.blocks]) continue;
    for (int k = 0; k < block->nodes; k++) old[k] = nodes[k];
    for (int k = 0; k < block->nodes; k++) nodes[k] = old[SliceMeshReversedNode(block->element, k)];
  }
  PetscCall(PetscFree(clockwise));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bounding box and plane */

/* Computes the centre and the diagonal of the bodies' bounding box. */
static PetscErrorCode FindBox(Scene scene, const SliceMesh *slice, Mesh mesh)
{
  PetscReal ends[6], square = 0; /* -lowest, then highest */

  PetscFunctionBeginUser;
  for (int k = 0; k < 6; k++) ends[k] = PETSC_MIN_REAL;
  for (PetscInt i = 0; i < slice->n_nodes; i++) {
    for (int k = 0; k < 3; k++) {
      ends[k]     = PetscMax(ends[k], -slice->coords[3 * i + k]);
      ends[3 + k] = PetscMax(ends[3 + k], slice->coords[3 * i + k]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, ends, 6, MPIU_REAL, MPI_MAX, slice->comm));
  for (int k = 0; k < scene->dim; k++) {
    mesh->centre[k] = (ends[3 + k] - ends[k]) / 2;
    square += PetscSqr(ends[3 + k] + ends[k]);
  }
  mesh->size = PetscSqrtReal(square);
  if (scene->geometry == GEOMETRY_AXISYMMETRIC) mesh->centre[0] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void CheckPlane(Scene scene, const char *file, const SliceMesh *slice, PetscReal size, Complaint *complaint)
{
  for (PetscInt i = 0; i < slice->n_homes && scene->dim == 2; i++) {
    const PetscReal *x   = &slice->gmsh.coords[3 * slice->home[i]];
    const PetscInt   tag = slice->gmsh.node_tag[slice->home[i]];

    if (PetscAbsReal(x[2]) > PLANE_TOLERANCE * size)
      Complain(complaint, "%s: node %" PetscInt_FMT " has z = %g; a two-dimensional mesh lies in the plane z = 0", file,
               tag, (double)x[2]);
    if (scene->geometry == GEOMETRY_AXISYMMETRIC && x[0] < -PLANE_TOLERANCE * size) {
      Complain(complaint, "%s: node %" PetscInt_FMT " has x = %g; an axisymmetric mesh has no negative radius x", file,
               tag, (double)x[0]);
    }
  }
}

/* The order of the elements, of which the first cell decides. */
static PetscErrorCode FindOrder(const SliceMesh *slice, Mesh mesh)
{
  PetscFunctionBeginUser;
  mesh->order = slice->n_cells ? slice->cell_block[0]->element->order : 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &mesh->order, 1, MPI_INT, MPI_MAX, slice->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes cells and nodes of the file's elements, unless there is a complaint. */
static PetscErrorCode ReadCells(Scene scene, const char *file, SliceMesh *slice, Complaint *complaint)
{
  PetscBool failed;
  int      *body;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(slice->gmsh.n_blocks, &body));
  PetscCall(CheckBlocks(scene, file, slice, body, complaint));
  PetscCall(ComplaintAnywhere(slice->comm, complaint, &failed));
  if (!failed) PetscCall(NumberCells(scene, file, slice, body, complaint));
  PetscCall(PetscFree(body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceMeshRead - reads the scene's mesh from its file and checks it.

  Collective

  Input Parameters:
+ scene - bodies, dimension and order
- file  - path of a .msh file, format 4.1

  Output Parameters:
+ slice     - to be freed with SliceMeshReset(), also after a complaint
. mesh      - its order, centre and size are set
- complaint - says what is wrong with the file, if anything, on some ranks

  Note:
  Plane surfaces whose cells run clockwise are turned. Complains of what GmshRead() found, two orders or an order that
  is not the scene's, a body without cells, a cell without a body or in two, equal tags, a two-dimensional mesh that is
  not in its plane or has negative radii, and fewer cells than ranks.
@*/
PetscErrorCode SliceMeshRead(Scene scene, const char *file, SliceMesh *slice, Mesh mesh, Complaint *complaint)
{
  PetscBool failed;

  PetscFunctionBeginUser;
  *slice = (SliceMesh){.comm = mesh->comm};
  PetscCallMPI(MPI_Comm_rank(slice->comm, &slice->rank));
  PetscCallMPI(MPI_Comm_size(slice->comm, &slice->size));
  PetscCall(GmshRead(slice->comm, file, &slice->gmsh, complaint));
  PetscCall(ComplaintAnywhere(slice->comm, complaint, &failed));
  if (failed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ReadCells(scene, file, slice, complaint));
  PetscCall(ComplaintAnywhere(slice->comm, complaint, &failed));
  if (failed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ShareStarts(slice, slice->n_cells, &slice->cell_start));
  if (slice->cell_start[slice->size] < slice->size)
    Complain(complaint, "%s: %" PetscInt_FMT " cells cannot be shared out to %d ranks; run with fewer", file,
             slice->cell_start[slice->size], slice->size);
  PetscCall(NumberNodes(slice));
  if (scene->dim == 2) PetscCall(TurnClockwise(slice));
  PetscCall(FindBox(scene, slice, mesh));
  CheckPlane(scene, file, slice, mesh->size, complaint);
  PetscCall(FindOrder(slice, mesh));
  mesh->notes       = slice->gmsh.notes;
  slice->gmsh.notes = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceMeshCellCounts - returns how many cells each slice has, to gather or to scatter something of all cells.

  Not collective

  Input Parameter:
. slice - after SliceMeshRead()

  Output Parameters:
+ counts - of each rank; to be freed together with starts by PetscFree2()
- starts - first id of each rank
@*/
PetscErrorCode SliceMeshCellCounts(const SliceMesh *slice, PetscMPIInt **counts, PetscMPIInt **starts)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(slice->size, counts, slice->size, starts));
  for (PetscMPIInt r = 0; r < slice->size; r++) {
    PetscCall(PetscMPIIntCast(slice->cell_start[r], &(*starts)[r]));
    PetscCall(PetscMPIIntCast(slice->cell_start[r + 1] - slice->cell_start[r], &(*counts)[r]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
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
. slice - from SliceMeshRead()
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
