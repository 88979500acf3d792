/* Middle nodes of edges and faces, see rootmiddles.h. */
#include "rootmiddles.h"
#include <stdlib.h>

/* A node in the middle of an edge or a face, by the vertex numbers of its corners, ascending, then -1. */
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
static PetscBool LoadMiddle(const RootMesh *root, PetscInt cell, int k, Middle *middle)
{
  const Element  *e       = root->cell_block[cell]->element;
  const PetscInt *nodes   = RootMeshCellNodes(root, cell);
  const int       face    = k - e->corners - e->edges;
  const int      *corners = face < 0 ? e->edge_corners[k - e->corners] : e->face_nodes[face];
  const int       n       = face < 0 ? 2 : ElementGet((ElementType)e->face_type)->corners;

  if (face >= 0 && (e->dim < 3 || face >= e->faces)) return PETSC_FALSE;
  for (int i = 0; i < CELL_FACE_CORNERS; i++) {
    const PetscInt vertex = i < n ? root->vertex[root->id[nodes[corners[i]]]] : -1;
    int            place  = i;

    for (; vertex >= 0 && place > 0 && middle->corner[place - 1] > vertex; place--)
      middle->corner[place] = middle->corner[place - 1];
    middle->corner[place] = vertex;
  }
  return PETSC_TRUE;
}

/* Lists the middle nodes of all cells, each once. */
static PetscErrorCode ListMiddles(const RootMesh *root, PetscInt *n, Middle **middles)
{
  PetscBool *seen;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PetscCalloc1(root->n_nodes, &seen));
  PetscCall(PetscMalloc1(root->n_nodes - root->n_vertices, middles));
  for (PetscInt c = 0; c < root->n_cells; c++) {
    for (int k = root->cell_block[c]->element->corners; k < root->cell_block[c]->nodes; k++) {
      const PetscInt id = root->id[RootMeshCellNodes(root, c)[k]];

      if (seen[id] || root->vertex[id] >= 0 || !LoadMiddle(root, c, k, &(*middles)[*n])) continue;
      (*middles)[(*n)++].id = id;
      seen[id]              = PETSC_TRUE;
    }
  }
  PetscCall(PetscFree(seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RootMiddlesCheck - complains of two nodes in the middle of one edge or face. This occurs where cells share it, but not
  its middle node.

  Not collective, on rank 0

  Input Parameters:
+ file - name of the mesh, for the complaint
- root - after RootMeshRead()

  Output Parameter:
. complaint - of the nodes with the lowest tags
@*/
PetscErrorCode RootMiddlesCheck(const char *file, const RootMesh *root, Complaint *complaint)
{
  PetscInt n, last = PETSC_MAX_INT, before = -1;
  Middle  *middles;

  PetscFunctionBeginUser;
  PetscCall(ListMiddles(root, &n, &middles));
  if (n) qsort(middles, (size_t)n, sizeof(*middles), CompareMiddles);
  for (PetscInt i = 1; i < n; i++) {
    const Middle *a = &middles[i - 1], *b = &middles[i];

    if (b->id > last || memcmp(a->corner, b->corner, sizeof(a->corner))) continue;
    before = a->id;
    last   = b->id;
  }
  if (before >= 0)
    Complain(complaint, "%s: nodes %" PetscInt_FMT " and %" PetscInt_FMT " are both the middle of one edge or face",
             file, root->gmsh.node_tag[root->node[before]], root->gmsh.node_tag[root->node[last]]);
  PetscCall(PetscFree(middles));
  PetscFunctionReturn(PETSC_SUCCESS);
}
