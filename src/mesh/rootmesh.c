/* Reads the mesh on rank 0, checks it against the scene, and numbers cells and nodes. */
#include "rootmesh.h"
#include "cellfaces.h"
#include "mesh/meshgroup.h"
#include <string.h>

/* Distance from the plane z = 0, or from the axis, that is treated as round-off, as a part of the mesh's size. */
static const PetscReal PLANE_TOLERANCE = 1e-9;

/*@
  RootMeshCellNodes - returns the nodes of a cell.

  Not collective, on rank 0

  Input Parameters:
+ root - after RootMeshRead()
- c    - id of the cell

  Note:
  Returns indices into the nodes of root->gmsh, in gmsh's order.
@*/
const PetscInt *RootMeshCellNodes(const RootMesh *root, PetscInt c)
{
  return root->cell_block[c]->connectivity + root->cell_item[c] * root->cell_block[c]->nodes;
}

/*@
  RootMeshReversedNode - returns the node at place k of a plane cell, a face or a curve whose sense is reversed.

  Not collective

  Input Parameters:
+ element - type of the cell or face
- k       - the place

  Note:
  The corners follow in the opposite sense of rotation from the first one, and the edges with them. The ends of a curve
  are swapped.
@*/
int RootMeshReversedNode(const Element *element, int k)
{
  const int corners = element->corners;

  if (element->dim == 1) return k < 2 ? 1 - k : k;
  if (k < corners) return (corners - k) % corners;
  return k < 2 * corners ? corners + (2 * corners - 1 - k) : k;
}

/*@
  RootMeshMark - says that a node is on a group.

  Not collective, on rank 0

  Input Parameters:
+ root - after its marks were made
. g    - number of the group
- id   - of the node
@*/
void RootMeshMark(RootMesh *root, int g, PetscInt id)
{
  root->marks[g / ROOT_MARKS * root->n_nodes + id] |= 1 << g % ROOT_MARKS;
}

/* Does the outline of a plane cell run clockwise? */
static PetscBool CellIsClockwise(const GmshMesh *gmsh, const GmshBlock *block, PetscInt item)
{
  const PetscInt *nodes = block->connectivity + item * block->nodes;
  const int       n     = block->element->corners;
  PetscReal       twice = 0;

  for (int k = 0; k < n; k++) {
    const PetscReal *a = &gmsh->coords[3 * nodes[k]], *b = &gmsh->coords[3 * nodes[(k + 1) % n]];
    const PetscReal *o = &gmsh->coords[3 * nodes[0]];

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

/* Does a surface that runs clockwise lie on the same side of a common edge as one that does not? It is then folded over
   it, and turning its cells would hide that. */
static PetscErrorCode FindFold(const GmshMesh *gmsh, const PetscBool *clockwise, PetscBool *folded)
{
  PetscInt   n = 0;
  PlaneEdge *edges;

  PetscFunctionBeginUser;
  for (int b = 0; b < gmsh->n_blocks; b++)
    if (gmsh->blocks[b].dim == 2) n += gmsh->blocks[b].n * CELL_FACE_CORNERS;
  PetscCall(PetscMalloc1(n, &edges));
  n = 0;
  for (int b = 0; b < gmsh->n_blocks; b++) {
    const GmshBlock *block = &gmsh->blocks[b];

    for (PetscInt i = 0; i < block->n && block->dim == 2; i++) {
      const PetscInt *nodes   = block->connectivity + i * block->nodes;
      const int       corners = block->element->corners;

      for (int k = 0; k < corners; k++) {
        const PetscInt from = nodes[k], to = nodes[(k + 1) % corners];

        edges[n++] = (PlaneEdge){{PetscMin(from, to), PetscMax(from, to)}, from < to, clockwise[b]};
      }
    }
  }
  if (n) qsort(edges, n, sizeof(*edges), PlaneEdgeCompare);
  *folded = PETSC_FALSE;
  for (PetscInt i = 1; i < n; i++)
    if (!PlaneEdgeCompare(&edges[i - 1], &edges[i]) && edges[i - 1].clockwise != edges[i].clockwise &&
        edges[i - 1].along != edges[i].along)
      *folded = PETSC_TRUE;
  PetscCall(PetscFree(edges));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Turns the plane cells of those surfaces whose outline runs clockwise in the file. A surface of which only some cells
   do is tangled, and one that is folded over its neighbour is wrong; they are left as they are. */
static PetscErrorCode TurnClockwise(GmshMesh *gmsh)
{
  PetscBool *clockwise, folded = PETSC_FALSE;
  int        any = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(gmsh->n_blocks, &clockwise));
  for (int b = 0; b < gmsh->n_blocks; b++) {
    const GmshBlock *block = &gmsh->blocks[b];
    PetscInt         n     = 0;

    if (block->dim != 2 || !block->n) continue;
    for (PetscInt i = 0; i < block->n; i++) n += CellIsClockwise(gmsh, block, i);
    clockwise[b] = (PetscBool)(n == block->n);
    any          = any || clockwise[b];
  }
  if (any) PetscCall(FindFold(gmsh, clockwise, &folded));
  for (int b = 0; b < gmsh->n_blocks; b++) {
    const GmshBlock *block = &gmsh->blocks[b];

    for (PetscInt i = 0; i < block->n && clockwise[b] && !folded; i++) {
      PetscInt *nodes = block->connectivity + i * block->nodes, old[ELEMENT_MAX_NODES];

      for (int k = 0; k < block->nodes; k++) old[k] = nodes[k];
      for (int k = 0; k < block->nodes; k++) nodes[k] = old[RootMeshReversedNode(block->element, k)];
    }
  }
  PetscCall(PetscFree(clockwise));
  PetscFunctionReturn(PETSC_SUCCESS);
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
static void CheckBodyNames(Scene scene, const char *file, const RootMesh *root, Complaint *complaint)
{
  const GmshMesh *gmsh = &root->gmsh;
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
static int BlockBody(Scene scene, const char *file, const RootMesh *root, const GmshBlock *block, Complaint *complaint)
{
  int body = -1;

  for (int i = 0; i < block->n_physicals; i++) {
    const char *name  = root->gmsh.physicals[block->physical[i]].name;
    const int   found = MeshFindBody(scene, name, PETSC_FALSE);

    if (found < 0) {
      Complain(complaint,
               "%s: the mesh '%s' has a volume group '%s' that is no body of the scene; list it with its material",
               SceneWhere(scene, "bodies", NULL), file, name);
    } else if (body >= 0) {
      Complain(complaint, "%s: cell %" PetscInt_FMT " is in two bodies, '%s' and '%s'", file,
               block->n ? block->tag[0] : 0, scene->bodies[body].name, scene->bodies[found].name);
    }
    body = found;
  }
  return body;
}

/* Checks that all elements have one order, which is that of the scene. */
static void CheckOrder(Scene scene, const char *file, const RootMesh *root, Complaint *complaint)
{
  const GmshBlock *first = NULL;

  for (int b = 0; b < root->gmsh.n_blocks; b++) {
    const GmshBlock *block = &root->gmsh.blocks[b];

    if (!block->element || !block->n) continue;
    if (!first) first = block;
    if (block->element->order != first->element->order) {
      Complain(complaint, "%s: elements of two orders: %" PetscInt_FMT " is %s, %" PetscInt_FMT " is %s", file,
               first->tag[0], first->element->name, block->tag[0], block->element->name);
    }
  }
  if (first && scene->order && first->element->order != scene->order) {
    Complain(complaint, "%s: order is %d, but the elements of '%s' (%s) are of order %d",
             SceneWhere(scene, "mesh", "order"), scene->order, file, first->element->name, first->element->order);
  }
}

static void CheckBodies(Scene scene, const char *file, const RootMesh *root, const PetscInt cells[],
                        Complaint *complaint)
{
  char list[MESH_TEXT];

  ListPhysicals(&root->gmsh, scene->dim, list);
  for (int b = 0; b < scene->n_bodies; b++) {
    if (scene->bodies[b].rigid || cells[b]) continue;
    Complain(complaint, "%s: the mesh '%s' has no cells of a volume group '%s'; its volume groups: %s",
             SceneWhere(scene, scene->bodies[b].path, "volume"), file, scene->bodies[b].name, list);
  }
}

/* Numbering */

/* Counts the cells of the scene's dimension and complains of elements of a higher dimension. */
static PetscInt CountCells(Scene scene, const char *file, const GmshMesh *gmsh, Complaint *complaint)
{
  PetscInt n = 0;

  for (int b = 0; b < gmsh->n_blocks; b++) {
    if (gmsh->blocks[b].dim > scene->dim)
      Complain(complaint, "%s: the mesh '%s' has volumes; a two-dimensional one is needed",
               SceneWhere(scene, "geometry", NULL), file);
    if (gmsh->blocks[b].dim == scene->dim) n += gmsh->blocks[b].n;
  }
  return n;
}

/* Finds the body of each block, -1 for a block without cells, and checks that every body has cells. */
static PetscErrorCode BlockBodies(Scene scene, const char *file, const RootMesh *root, int body[], Complaint *complaint)
{
  PetscInt *per_body;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(scene->n_bodies, &per_body));
  for (int b = 0; b < root->gmsh.n_blocks; b++) {
    const GmshBlock *block = &root->gmsh.blocks[b];

    body[b] = block->dim == scene->dim ? BlockBody(scene, file, root, block, complaint) : -1;
    if (body[b] >= 0) per_body[body[b]] += block->n;
  }
  CheckBodies(scene, file, root, per_body, complaint);
  PetscCall(PetscFree(per_body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers the cells by ascending tag and finds the body of each. */
static PetscErrorCode NumberCells(Scene scene, const char *file, RootMesh *root, Complaint *complaint)
{
  const GmshMesh *gmsh = &root->gmsh;
  const PetscInt  n    = CountCells(scene, file, gmsh, complaint);
  PetscInt        done = 0, *order, *tag, *item;
  int            *block, *body;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &root->cell_item, n, &root->cell_block, n, &root->cell_body));
  PetscCall(PetscMalloc5(n, &order, n, &tag, n, &item, n, &block, gmsh->n_blocks, &body));
  PetscCall(BlockBodies(scene, file, root, body, complaint));
  for (int b = 0; b < gmsh->n_blocks; b++) {
    for (PetscInt i = 0; i < gmsh->blocks[b].n && gmsh->blocks[b].dim == scene->dim; i++, done++) {
      order[done] = done;
      tag[done]   = gmsh->blocks[b].tag[i];
      item[done]  = i;
      block[done] = b;
    }
  }
  PetscCall(PetscSortIntWithPermutation(n, tag, order));
  for (PetscInt c = 0; c < n; c++) {
    root->cell_item[c]  = item[order[c]];
    root->cell_block[c] = &gmsh->blocks[block[order[c]]];
    root->cell_body[c]  = body[block[order[c]]];
    if (c && tag[order[c]] == tag[order[c - 1]])
      Complain(complaint, "%s: two cells have the tag %" PetscInt_FMT, file, tag[order[c]]);
  }
  root->n_cells = n;
  PetscCall(PetscFree5(order, tag, item, block, body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers the nodes that cells use, by ascending tag, and the corners among them. */
static PetscErrorCode RootMeshNumberNodes(RootMesh *root)
{
  const PetscInt n = root->gmsh.n_nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &root->node, n, &root->id, n, &root->vertex));
  for (PetscInt i = 0; i < n; i++) root->id[i] = root->vertex[i] = -1;
  for (PetscInt c = 0; c < root->n_cells; c++)
    for (int k = 0; k < root->cell_block[c]->nodes; k++) root->id[RootMeshCellNodes(root, c)[k]] = 0;
  for (PetscInt i = 0; i < n; i++) {
    if (root->id[i] < 0) continue;
    root->node[root->n_nodes] = i;
    root->id[i]               = root->n_nodes++;
  }
  for (PetscInt c = 0; c < root->n_cells; c++)
    for (int k = 0; k < root->cell_block[c]->element->corners; k++)
      root->vertex[root->id[RootMeshCellNodes(root, c)[k]]] = 0;
  for (PetscInt i = 0; i < root->n_nodes; i++)
    if (!root->vertex[i]) root->vertex[i] = root->n_vertices++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bounding box and plane */

/* Computes the centre and the diagonal of the bodies' bounding box. */
static void FindBox(Scene scene, const RootMesh *root, Mesh mesh)
{
  PetscReal lower[3] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL},
            upper[3] = {PETSC_MIN_REAL, PETSC_MIN_REAL, PETSC_MIN_REAL}, square = 0;

  for (PetscInt i = 0; i < root->n_nodes; i++) {
    for (int k = 0; k < 3; k++) {
      const PetscReal x = root->gmsh.coords[3 * root->node[i] + k];

      lower[k] = PetscMin(lower[k], x);
      upper[k] = PetscMax(upper[k], x);
    }
  }
  for (int k = 0; k < scene->dim; k++) {
    mesh->centre[k] = (lower[k] + upper[k]) / 2;
    square += PetscSqr(upper[k] - lower[k]);
  }
  mesh->size = PetscSqrtReal(square);
  if (scene->geometry == GEOMETRY_AXISYMMETRIC) mesh->centre[0] = 0;
}

static void CheckPlane(Scene scene, const char *file, const RootMesh *root, PetscReal size, Complaint *complaint)
{
  for (PetscInt i = 0; i < root->n_nodes && scene->dim == 2; i++) {
    const PetscReal *x   = &root->gmsh.coords[3 * root->node[i]];
    const PetscInt   tag = root->gmsh.node_tag[root->node[i]];

    if (PetscAbsReal(x[2]) > PLANE_TOLERANCE * size)
      Complain(complaint, "%s: node %" PetscInt_FMT " has z = %g; a two-dimensional mesh lies in the plane z = 0", file,
               tag, (double)x[2]);
    if (scene->geometry == GEOMETRY_AXISYMMETRIC && x[0] < -PLANE_TOLERANCE * size) {
      Complain(complaint, "%s: node %" PetscInt_FMT " has x = %g; an axisymmetric mesh has no negative radius x", file,
               tag, (double)x[0]);
    }
  }
}

/*@
  RootMeshRead - reads the scene's mesh from its file and checks it.

  Not collective, on rank 0

  Input Parameters:
+ scene - bodies, dimension and order
. file  - path of a .msh file, format 4.1
- ranks - number of ranks; each must get a cell

  Output Parameters:
+ root      - to be freed with RootMeshReset(), also after a complaint
. mesh      - its order, centre and size are set
- complaint - says what is wrong with the file, if anything

  Note:
  Plane surfaces whose cells run clockwise are turned. Complains of what GmshRead() found, two orders or an order that
is not the scene's, a body without cells, a cell without a body or in two, equal tags, a two-dimensional mesh that is
not in its plane or has negative radii, and fewer cells than ranks.
@*/
PetscErrorCode RootMeshRead(Scene scene, const char *file, PetscMPIInt ranks, RootMesh *root, Mesh mesh,
                            Complaint *complaint)
{
  PetscFunctionBeginUser;
  *root = (RootMesh){.n_cells = 0};
  PetscCall(GmshRead(file, &root->gmsh, complaint));
  if (complaint->text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  CheckBodyNames(scene, file, root, complaint);
  CheckOrder(scene, file, root, complaint);
  if (scene->dim == 2) PetscCall(TurnClockwise(&root->gmsh));
  PetscCall(NumberCells(scene, file, root, complaint));
  if (complaint->text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  if (root->n_cells < ranks)
    Complain(complaint, "%s: %" PetscInt_FMT " cells cannot be shared out to %d ranks; run with fewer", file,
             root->n_cells, ranks);
  PetscCall(RootMeshNumberNodes(root));
  FindBox(scene, root, mesh);
  CheckPlane(scene, file, root, mesh->size, complaint);
  mesh->notes      = root->gmsh.notes;
  root->gmsh.notes = NULL;
  mesh->order      = root->n_cells ? root->cell_block[0]->element->order : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RootMeshFreeCells - frees the cells, the elements of the file and the faces.

  Not collective, on rank 0

  Input Parameter:
. root - its nodes and marks stay
@*/
PetscErrorCode RootMeshFreeCells(RootMesh *root)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(root->cell_item, root->cell_block, root->cell_body));
  PetscCall(PetscFree(root->face_ptr));
  PetscCall(PetscFree(root->faces));
  PetscCall(CellFacesFree(root));
  PetscCall(GmshFreeBlocks(&root->gmsh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RootMeshReset - frees the contents of the root mesh.

  Not collective, on rank 0

  Input Parameter:
. root - from RootMeshRead()
@*/
PetscErrorCode RootMeshReset(RootMesh *root)
{
  PetscFunctionBeginUser;
  PetscCall(RootMeshFreeCells(root));
  PetscCall(PetscFree3(root->node, root->id, root->vertex));
  PetscCall(PetscFree(root->interior));
  PetscCall(PetscFree(root->marks));
  PetscCall(GmshReset(&root->gmsh));
  PetscFunctionReturn(PETSC_SUCCESS);
}
