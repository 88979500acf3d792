/* Middle nodes of edges and faces, see slicemiddles.h. */
#include "slicemiddles.h"
#include "cellfaces.h"
#include "base/exchange.h"
#include <stdlib.h>
#include <string.h>

/* A node in the middle of an edge or a face, by the ids of its corners, ascending, as of a face. */
typedef struct {
  PetscInt corner[CELL_FACE_CORNERS], id;
} Middle;

static int CompareMiddles(const void *a, const void *b)
{
  const Middle *p = a, *q = b;

  for (int k = 0; k < CELL_FACE_CORNERS; k++)
    if (p->corner[k] != q->corner[k]) return p->corner[k] < q->corner[k] ? -1 : 1;
  return (p->id > q->id) - (p->id < q->id);
}

/* Fills in the corners between which node k of a cell lies. Returns PETSC_FALSE where it lies on no edge or face of
   another cell. */
static PetscBool LoadMiddle(const SliceMesh *slice, PetscInt cell, int k, Middle *middle)
{
  const Element  *e       = slice->cell_block[cell]->element;
  const PetscInt *nodes   = SliceMeshCellNodes(slice, cell);
  const int       face    = k - e->corners - e->edges;
  const int      *corners = face < 0 ? e->edge_corners[k - e->corners] : e->face_nodes[face];
  const int       n       = face < 0 ? 2 : ElementGet((ElementType)e->face_type)->corners;
  PetscInt        ids[CELL_FACE_CORNERS];

  if (face >= 0 && (e->dim < 3 || face >= e->faces)) return PETSC_FALSE;
  for (int i = 0; i < n; i++) ids[i] = slice->id[nodes[corners[i]]];
  CellFacesSortCorners(n, ids, middle->corner);
  middle->id = slice->id[nodes[k]];
  return PETSC_TRUE;
}

/* Lists the middle nodes of the slice's cells. A node that is the middle of one edge in several cells is there once. */
static PetscErrorCode ListMiddles(const SliceMesh *slice, PetscInt *n, Middle **middles)
{
  PetscInt *known, room = 0;

  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt c = 0; c < slice->n_cells; c++)
    room += slice->cell_block[c]->nodes - slice->cell_block[c]->element->corners;
  PetscCall(PetscMalloc1(slice->n_nodes, &known));
  for (PetscInt i = 0; i < slice->n_nodes; i++) known[i] = -1;
  room = PetscMin(room, slice->n_nodes);
  PetscCall(PetscMalloc1(room, middles));
  for (PetscInt c = 0; c < slice->n_cells; c++) {
    for (int k = slice->cell_block[c]->element->corners; k < slice->cell_block[c]->nodes; k++) {
      PetscInt *first = &known[SliceMeshCellNodes(slice, c)[k]];
      Middle    middle;

      if (!LoadMiddle(slice, c, k, &middle)) continue;
      if (*first >= 0 && !memcmp((*middles)[*first].corner, middle.corner, sizeof(middle.corner))) continue;
      if (*n == room) PetscCall(PetscRealloc((size_t)(room = 2 * room + 1) * sizeof(Middle), middles));
      if (*first < 0) *first = *n;
      (*middles)[(*n)++] = middle;
    }
  }
  PetscCall(PetscFree(known));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void PackMiddle(const void *context, PetscInt i, void *packed)
{
  *(Middle *)packed = ((const Middle *)context)[i];
}

/* Sends the middle nodes to the ranks that know the faces with their lowest corners. These have about as many each;
   homes have not, because corners often have lower tags than all middle nodes. */
static PetscErrorCode SendMiddles(const SliceMesh *slice, PetscInt *n, Middle **middles)
{
  PetscInt     n_mine;
  Middle      *mine;
  PetscMPIInt *to;

  PetscFunctionBeginUser;
  PetscCall(ListMiddles(slice, &n_mine, &mine));
  PetscCall(PetscMalloc1(n_mine, &to));
  for (PetscInt i = 0; i < n_mine; i++) to[i] = SliceMeshRankOf(slice, slice->face_start, mine[i].corner[0]);
  PetscCall(ExchangeRecords(slice->comm, sizeof(Middle), n_mine, to, PackMiddle, mine, n, (void **)middles));
  PetscCall(PetscFree(to));
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells all ranks the tag of a node. */
static PetscErrorCode FindTag(const SliceMesh *slice, PetscInt id, PetscInt *tag)
{
  const PetscInt i = id - slice->home_start[slice->rank];

  PetscFunctionBeginUser;
  *tag = i >= 0 && i < slice->n_homes ? slice->gmsh.node_tag[slice->home[i]] : 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, tag, 1, MPIU_INT, MPI_SUM, slice->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceMiddlesCheck - complains of two nodes in the middle of one edge or face. This occurs where cells share it, but
  not its middle node.

  Collective

  Input Parameters:
+ file  - name of the mesh, for the complaint
- slice - after CellFacesCreate()

  Output Parameter:
. complaint - of the nodes with the lowest tags
@*/
PetscErrorCode SliceMiddlesCheck(const char *file, const SliceMesh *slice, Complaint *complaint)
{
  PetscInt n, found[2] = {PETSC_MAX_INT, -1}, last, tags[2]; /* found: the higher id, and the lower one */
  Middle  *middles;

  PetscFunctionBeginUser;
  PetscCall(SendMiddles(slice, &n, &middles));
  if (n) qsort(middles, (size_t)n, sizeof(*middles), CompareMiddles);
  for (PetscInt i = 1; i < n; i++) {
    const Middle *a = &middles[i - 1], *b = &middles[i];

    if (a->id == b->id || b->id >= found[0] || memcmp(a->corner, b->corner, sizeof(a->corner))) continue;
    found[0] = b->id;
    found[1] = a->id;
  }
  PetscCall(PetscFree(middles));
  PetscCallMPI(MPI_Allreduce(&found[0], &last, 1, MPIU_INT, MPI_MIN, slice->comm));
  if (last == PETSC_MAX_INT) PetscFunctionReturn(PETSC_SUCCESS);
  if (last != found[0]) found[1] = -1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &found[1], 1, MPIU_INT, MPI_MAX, slice->comm));
  PetscCall(FindTag(slice, found[1], &tags[0]));
  PetscCall(FindTag(slice, last, &tags[1]));
  Complain(complaint, "%s: nodes %" PetscInt_FMT " and %" PetscInt_FMT " are both the middle of one edge or face", file,
           tags[0], tags[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
