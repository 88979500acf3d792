/* Reads the mesh, and shares cells and nodes out by their tags. */
#include "sliceread.h"
#include "base/exchange.h"
#include "gmshfile.h"
#include "slicechecks.h"
#include "sliceclockwise.h"
#include "tagranges.h"

/* Cells */

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
  PetscCall(ExchangeStarts(slice->comm, slice->n_homes, &slice->home_start));
  for (PetscInt i = 0; i < slice->n_homes; i++) id[slice->home[i]] = slice->home_start[slice->rank] + i;
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
  PetscCall(GmshListNodes(gmsh, &places)); /* the cells are gone */
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

/* Size and order */

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
  PetscCall(SliceChecksBlocks(scene, file, slice, body, complaint));
  PetscCall(ComplaintAnywhere(slice->comm, complaint, &failed));
  if (!failed) PetscCall(NumberCells(scene, file, slice, body, complaint));
  PetscCall(PetscFree(body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceRead - reads the scene's mesh from its file and checks it.

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
PetscErrorCode SliceRead(Scene scene, const char *file, SliceMesh *slice, Mesh mesh, Complaint *complaint)
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
  PetscCall(ExchangeStarts(slice->comm, slice->n_cells, &slice->cell_start));
  if (slice->cell_start[slice->size] < slice->size)
    Complain(complaint, "%s: %" PetscInt_FMT " cells cannot be shared out to %d ranks; run with fewer", file,
             slice->cell_start[slice->size], slice->size);
  PetscCall(NumberNodes(slice));
  if (scene->dim == 2) PetscCall(SliceClockwiseTurn(slice));
  PetscCall(FindBox(scene, slice, mesh));
  SliceChecksPlane(scene, file, slice, mesh->size, complaint);
  PetscCall(FindOrder(slice, mesh));
  mesh->notes       = slice->gmsh.notes;
  slice->gmsh.notes = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}
