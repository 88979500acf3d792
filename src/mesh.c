#include "mesh.h"
#include "elementkernel.h"
#include "gmsh.h"
#include "refusal.h"
#include <stdarg.h>
#include <string.h>

static const PetscReal PLANE_TOLERANCE = 1e-9; /* of the mesh's size: what counts as on the plane z = 0, or on the axis */

enum { LIST_SIZE = 512, CELL_HEADER = 5 };

/* One element of a dim - 1 group that is a face of a cell */
typedef struct {
  PetscInt cell, group, tag;
  int      number;
} RootFace;

/* What rank 0 knows before the mesh is distributed. Cells and nodes go by their ids: the order of gmsh's tags. */
typedef struct {
  GmshMesh          gmsh;
  PetscInt          n_nodes, *node, *id; /* id -> gmsh's node, and back (-1: not a body's) */
  PetscInt          n_cells, *cell_item; /* cell: item of a block */
  const GmshBlock **cell_block;
  int              *cell_body;
  PetscInt         *vertex;             /* id -> vertex number, -1: no corner */
  PetscInt          n_vertices, *point; /* id -> Plex point */
  PetscInt          n_faces, *face_ptr; /* cell -> its faces, once RootSortFaces() was called */
  RootFace         *faces;
  PetscInt         *interior; /* per group: faces between two cells */
} Root;

static const PetscInt *RootCellNodes(const Root *root, PetscInt c)
{
  return root->cell_block[c]->connectivity + root->cell_item[c] * root->cell_block[c]->nodes;
}

/* ------------------------------------------------------------------------------------------------------------- names */

/* In two dimensions a body is still called a volume, its boundary a surface. */
static const char *DimensionName(int mesh_dim, int dim)
{
  if (dim == mesh_dim) return "volume";
  if (dim == mesh_dim - 1) return "surface";
  return dim == 1 ? "curve" : "point";
}

/* Body of the scene with that name; rigid tools are bodies too. -1: none */
static int FindBody(Scene scene, const char *name, PetscBool rigid)
{
  for (int b = 0; b < scene->n_bodies; b++)
    if (!strcmp(scene->bodies[b].name, name) && !scene->bodies[b].rigid == !rigid) return b;
  return -1;
}

static PetscBool IsRigidGroup(Scene scene, int dim, const char *name)
{
  return dim == scene->dim - 1 && FindBody(scene, name, PETSC_TRUE) >= 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* "a, b, c": the names of one dimension, cut off where the text is full */
static void ListPhysicals(const GmshMesh *gmsh, int dim, char list[LIST_SIZE])
{
  size_t used = 0;

  snprintf(list, LIST_SIZE, "none");
  for (int i = 0; i < gmsh->n_physicals && used < LIST_SIZE; i++)
    if (gmsh->physicals[i].dim == dim) used += (size_t)snprintf(list + used, LIST_SIZE - used, "%s%s", used ? ", " : "", gmsh->physicals[i].name);
}

/* ------------------------------------------------------------------------------------- rank 0: cells, nodes and checks */

/* The one body whose volume group a block is in; -1 after a mistake */
static PetscErrorCode BlockBody(Scene scene, const char *file, const Root *root, const GmshBlock *block, int *body, GmshMessage *message)
{
  PetscFunctionBeginUser;
  *body = -1;
  for (int i = 0; i < block->n_physicals; i++) {
    const char *name  = root->gmsh.physicals[block->physical[i]].name;
    const int   found = FindBody(scene, name, PETSC_FALSE);

    if (found < 0)
      PetscCall(GmshSay(message, "%s: the mesh '%s' has a volume group '%s' that is no body of the scene; list it with its material",
                        SceneWhere(scene, "bodies", NULL), file, name));
    else if (*body >= 0) {
      PetscCall(GmshSay(message, "%s: cell %" PetscInt_FMT " is in two bodies, '%s' and '%s'", file, block->n ? block->tag[0] : 0, scene->bodies[*body].name,
                        scene->bodies[found].name));
    }
    *body = found;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All elements of one order, that of the scene */
static PetscErrorCode CheckOrder(Scene scene, const char *file, const Root *root, GmshMessage *message)
{
  const GmshBlock *first = NULL;

  PetscFunctionBeginUser;
  for (int b = 0; b < root->gmsh.n_blocks; b++) {
    const GmshBlock *block = &root->gmsh.blocks[b];

    if (!block->element || !block->n) continue;
    if (!first) first = block;
    if (block->element->order != first->element->order) {
      PetscCall(GmshSay(message, "%s: elements of two orders: %" PetscInt_FMT " is %s, %" PetscInt_FMT " is %s", file, first->tag[0], first->element->name,
                        block->tag[0], block->element->name));
    }
  }
  if (first && scene->order && first->element->order != scene->order) {
    PetscCall(GmshSay(message, "%s: order is %d, but the elements of '%s' (%s) are of order %d", SceneWhere(scene, "mesh", "order"), scene->order, file,
                      first->element->name, first->element->order));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckBodies(Scene scene, const char *file, const Root *root, const PetscInt cells[], GmshMessage *message)
{
  char list[LIST_SIZE];

  PetscFunctionBeginUser;
  ListPhysicals(&root->gmsh, scene->dim, list);
  for (int b = 0; b < scene->n_bodies; b++) {
    if (scene->bodies[b].rigid || cells[b]) continue;
    PetscCall(GmshSay(message, "%s: the mesh '%s' has no cells of a volume group '%s'; its volume groups: %s",
                      SceneWhere(scene, scene->bodies[b].path, "volume"), file, scene->bodies[b].name, list));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells by ascending tag, each in one body */
static PetscErrorCode RootCells(Scene scene, const char *file, Root *root, GmshMessage *message)
{
  const GmshMesh   *gmsh = &root->gmsh;
  PetscInt          n    = 0, *order, *tag, *item, *per_body;
  int              *body, block_body;
  const GmshBlock **block;

  PetscFunctionBeginUser;
  for (int b = 0; b < gmsh->n_blocks; b++) {
    if (gmsh->blocks[b].dim > scene->dim)
      PetscCall(GmshSay(message, "%s: the mesh '%s' has volumes; a two-dimensional one is needed", SceneWhere(scene, "geometry", NULL), file));
    if (gmsh->blocks[b].dim == scene->dim) n += gmsh->blocks[b].n;
  }
  PetscCall(PetscMalloc3(n, &root->cell_item, n, &root->cell_block, n, &root->cell_body));
  PetscCall(PetscMalloc5(n, &order, n, &tag, n, &item, n, &block, n, &body));
  PetscCall(PetscCalloc1(scene->n_bodies, &per_body));
  n = 0;
  for (int b = 0; b < gmsh->n_blocks && !message->text[0]; b++) {
    if (gmsh->blocks[b].dim != scene->dim) continue;
    PetscCall(BlockBody(scene, file, root, &gmsh->blocks[b], &block_body, message));
    if (block_body < 0) break;
    per_body[block_body] += gmsh->blocks[b].n;
    for (PetscInt i = 0; i < gmsh->blocks[b].n; i++, n++) {
      order[n] = n;
      tag[n]   = gmsh->blocks[b].tag[i];
      item[n]  = i;
      block[n] = &gmsh->blocks[b];
      body[n]  = block_body;
    }
  }
  PetscCall(CheckBodies(scene, file, root, per_body, message));
  PetscCall(PetscSortIntWithPermutation(n, tag, order));
  for (PetscInt c = 0; c < n; c++) {
    root->cell_item[c]  = item[order[c]];
    root->cell_block[c] = block[order[c]];
    root->cell_body[c]  = body[order[c]];
    if (c && tag[order[c]] == tag[order[c - 1]]) PetscCall(GmshSay(message, "%s: two cells have the tag %" PetscInt_FMT, file, tag[order[c]]));
  }
  root->n_cells = n;
  PetscCall(PetscFree5(order, tag, item, block, body));
  PetscCall(PetscFree(per_body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers the nodes that cells use by ascending tag, and the corners among them */
static PetscErrorCode RootNodes(Root *root)
{
  const PetscInt n = root->gmsh.n_nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n, &root->node, n, &root->id, n, &root->vertex, n, &root->point));
  for (PetscInt i = 0; i < n; i++) root->id[i] = root->vertex[i] = root->point[i] = -1;
  for (PetscInt c = 0; c < root->n_cells; c++)
    for (int k = 0; k < root->cell_block[c]->nodes; k++) root->id[RootCellNodes(root, c)[k]] = 0;
  for (PetscInt i = 0; i < n; i++) {
    if (root->id[i] < 0) continue;
    root->node[root->n_nodes] = i;
    root->id[i]               = root->n_nodes++;
  }
  for (PetscInt c = 0; c < root->n_cells; c++)
    for (int k = 0; k < root->cell_block[c]->element->corners; k++) root->vertex[root->id[RootCellNodes(root, c)[k]]] = 0;
  for (PetscInt i = 0; i < root->n_nodes; i++)
    if (!root->vertex[i]) root->vertex[i] = root->n_vertices++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Centre and diagonal of the bodies' bounding box */
static PetscErrorCode RootBox(Scene scene, const Root *root, Mesh mesh)
{
  PetscReal lower[3] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL}, upper[3] = {PETSC_MIN_REAL, PETSC_MIN_REAL, PETSC_MIN_REAL}, square = 0;

  PetscFunctionBeginUser;
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
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckPlane(Scene scene, const char *file, const Root *root, PetscReal size, GmshMessage *message)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < root->n_nodes && scene->dim == 2; i++) {
    const PetscReal *x   = &root->gmsh.coords[3 * root->node[i]];
    const PetscInt   tag = root->gmsh.node_tag[root->node[i]];

    if (PetscAbsReal(x[2]) > PLANE_TOLERANCE * size)
      PetscCall(GmshSay(message, "%s: node %" PetscInt_FMT " has z = %g; a two-dimensional mesh lies in the plane z = 0", file, tag, (double)x[2]));
    if (scene->geometry == GEOMETRY_AXISYMMETRIC && x[0] < -PLANE_TOLERANCE * size) {
      PetscCall(GmshSay(message, "%s: node %" PetscInt_FMT " has x = %g; an axisymmetric mesh has no negative radius x", file, tag, (double)x[0]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RootRead(Scene scene, const char *file, PetscMPIInt ranks, Root *root, Mesh mesh, GmshMessage *message)
{
  PetscFunctionBeginUser;
  PetscCall(GmshRead(file, &root->gmsh, message));
  if (message->text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CheckOrder(scene, file, root, message));
  PetscCall(RootCells(scene, file, root, message));
  if (message->text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  if (root->n_cells < ranks)
    PetscCall(GmshSay(message, "%s: %" PetscInt_FMT " cells cannot be shared out to %d ranks; run with fewer", file, root->n_cells, ranks));
  PetscCall(RootNodes(root));
  PetscCall(RootBox(scene, root, mesh));
  PetscCall(CheckPlane(scene, file, root, mesh->size, message));
  mesh->order = root->n_cells ? root->cell_block[0]->element->order : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RootFree(Root *root)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(root->cell_item, root->cell_block, root->cell_body));
  PetscCall(PetscFree4(root->node, root->id, root->vertex, root->point));
  PetscCall(PetscFree(root->face_ptr));
  PetscCall(PetscFree(root->faces));
  PetscCall(PetscFree(root->interior));
  PetscCall(GmshReset(&root->gmsh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ----------------------------------------------------------------------------------------------- rank 0: Plex topology */

static DMPolytopeType CellPolytope(ElementType type)
{
  switch (type) {
  case ELEMENT_TRI3:
  case ELEMENT_TRI6: return DM_POLYTOPE_TRIANGLE;
  case ELEMENT_QUAD4:
  case ELEMENT_QUAD9: return DM_POLYTOPE_QUADRILATERAL;
  case ELEMENT_TET4:
  case ELEMENT_TET10: return DM_POLYTOPE_TETRAHEDRON;
  default: return DM_POLYTOPE_HEXAHEDRON;
  }
}

/* Corner of gmsh's element that stands at place i of Plex's cone: there the first face of a solid points inwards */
static int PlexCorner(ElementType type, int i)
{
  static const int tet[] = {1, 0, 2, 3}, hex[] = {0, 3, 2, 1, 4, 5, 6, 7};

  if (CellPolytope(type) == DM_POLYTOPE_TETRAHEDRON) return tet[i];
  if (CellPolytope(type) == DM_POLYTOPE_HEXAHEDRON) return hex[i];
  return i;
}

/* Cells and vertices, all on rank 0 (root NULL elsewhere), then edges and faces */
static PetscErrorCode CreateTopology(MPI_Comm comm, int dim, const Root *root, DM *dm)
{
  const PetscInt n_cells = root ? root->n_cells : 0, n_points = n_cells + (root ? root->n_vertices : 0);
  PetscInt       cone[8];
  DM             cells;

  PetscFunctionBeginUser;
  PetscCall(DMCreate(comm, &cells));
  PetscCall(DMSetType(cells, DMPLEX));
  PetscCall(DMSetDimension(cells, dim));
  PetscCall(DMPlexSetChart(cells, 0, n_points));
  PetscCall(DMCreateLabel(cells, "celltype"));
  for (PetscInt c = 0; c < n_cells; c++) PetscCall(DMPlexSetConeSize(cells, c, root->cell_block[c]->element->corners));
  PetscCall(DMSetUp(cells));
  for (PetscInt c = 0; c < n_cells; c++) {
    const Element *element = root->cell_block[c]->element;

    for (int i = 0; i < element->corners; i++) cone[i] = n_cells + root->vertex[root->id[RootCellNodes(root, c)[PlexCorner(element->type, i)]]];
    PetscCall(DMPlexSetCone(cells, c, cone));
    PetscCall(DMPlexSetCellType(cells, c, CellPolytope(element->type)));
  }
  for (PetscInt v = n_cells; v < n_points; v++) PetscCall(DMPlexSetCellType(cells, v, DM_POLYTOPE_POINT));
  PetscCall(DMPlexSymmetrize(cells));
  PetscCall(DMPlexStratify(cells));
  PetscCall(DMPlexInterpolate(cells, dm));
  PetscCall(DMDestroy(&cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vertices' coordinates on the DM: for viewers only */
static PetscErrorCode SetVertexCoordinates(DM dm, int dim, const Root *root)
{
  PetscSection section;
  Vec          coordinates;
  PetscScalar *x;
  PetscInt     start, end, size, n_nodes = root ? root->n_nodes : 0;

  PetscFunctionBeginUser;
  PetscCall(DMSetCoordinateDim(dm, dim));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &start, &end));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(PetscSectionSetNumFields(section, 1));
  PetscCall(PetscSectionSetFieldComponents(section, 0, dim));
  PetscCall(PetscSectionSetChart(section, start, end));
  for (PetscInt v = start; v < end; v++) {
    PetscCall(PetscSectionSetDof(section, v, dim));
    PetscCall(PetscSectionSetFieldDof(section, v, 0, dim));
  }
  PetscCall(PetscSectionSetUp(section));
  PetscCall(PetscSectionGetStorageSize(section, &size));
  PetscCall(VecCreate(PETSC_COMM_SELF, &coordinates));
  PetscCall(PetscObjectSetName((PetscObject)coordinates, "coordinates"));
  PetscCall(VecSetSizes(coordinates, size, PETSC_DETERMINE));
  PetscCall(VecSetBlockSize(coordinates, dim));
  PetscCall(VecSetType(coordinates, VECSTANDARD));
  PetscCall(VecGetArray(coordinates, &x));
  for (PetscInt i = 0; i < n_nodes; i++) {
    if (root->vertex[i] < 0) continue;
    for (int k = 0; k < dim; k++) x[root->vertex[i] * dim + k] = root->gmsh.coords[3 * root->node[i] + k];
  }
  PetscCall(VecRestoreArray(coordinates, &x));
  PetscCall(DMSetCoordinatesLocal(dm, coordinates));
  PetscCall(VecDestroy(&coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The point of the given depth that has exactly these vertices in its closure; -1: there is none */
static PetscErrorCode PointOfVertices(DM dm, int depth, PetscInt n, const PetscInt vertices[], PetscInt *point)
{
  const PetscInt *covered;
  PetscInt        n_covered, start, end;

  PetscFunctionBeginUser;
  *point = -1;
  PetscCall(DMPlexGetDepthStratum(dm, depth, &start, &end));
  PetscCall(DMPlexGetFullJoin(dm, n, vertices, &n_covered, &covered));
  for (PetscInt i = 0; i < n_covered; i++)
    if (covered[i] >= start && covered[i] < end) *point = covered[i];
  PetscCall(DMPlexRestoreJoin(dm, n, vertices, &n_covered, &covered));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Plex point of node k of cell c: an edge or face by its corners, or the cell itself */
static PetscErrorCode NodePoint(DM dm, const Root *root, PetscInt c, int k, PetscInt *point)
{
  const Element  *element = root->cell_block[c]->element;
  const PetscInt *nodes   = RootCellNodes(root, c);
  const int      *corners = NULL;
  int             depth = 0, n = 0;
  PetscInt        vertices[4];

  PetscFunctionBeginUser;
  *point = c;
  if (k < element->corners) {
    *point = root->point[root->id[nodes[k]]];
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (k < element->corners + element->edges) {
    corners = element->edge_corners[k - element->corners];
    depth   = 1;
    n       = 2;
  } else if (element->dim == 3 && k < element->corners + element->edges + element->faces) {
    corners = element->face_nodes[k - element->corners - element->edges];
    depth   = 2;
    n       = ElementGet((ElementType)element->face_type)->corners;
  }
  for (int i = 0; i < n; i++) vertices[i] = root->point[root->id[nodes[corners[i]]]];
  if (n) PetscCall(PointOfVertices(dm, depth, n, vertices, point));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where every node sits; two nodes in one place mean cells that share an edge or face but not its middle node. */
static PetscErrorCode RootPoints(DM dm, const char *file, Root *root, GmshMessage *message)
{
  PetscInt start, p_start, p_end, *taken;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(dm, 0, &start, NULL));
  PetscCall(DMPlexGetChart(dm, &p_start, &p_end));
  PetscCall(PetscMalloc1(p_end, &taken));
  for (PetscInt p = 0; p < p_end; p++) taken[p] = -1;
  for (PetscInt i = 0; i < root->n_nodes; i++)
    if (root->vertex[i] >= 0) root->point[i] = start + root->vertex[i];
  for (PetscInt c = 0; c < root->n_cells; c++) {
    for (int k = 0; k < root->cell_block[c]->nodes; k++) {
      PetscInt *point = &root->point[root->id[RootCellNodes(root, c)[k]]];

      if (*point < 0) PetscCall(NodePoint(dm, root, c, k, point));
      PetscCheck(*point >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "No Plex point for node %d of cell %" PetscInt_FMT, k, c);
    }
  }
  for (PetscInt i = 0; i < root->n_nodes; i++) {
    PetscInt *other = &taken[root->point[i]];

    if (*other >= 0) {
      PetscCall(GmshSay(message, "%s: nodes %" PetscInt_FMT " and %" PetscInt_FMT " are both the middle of one edge or face", file,
                        root->gmsh.node_tag[root->node[*other]], root->gmsh.node_tag[root->node[i]]));
    }
    *other = i;
  }
  PetscCall(PetscFree(taken));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ------------------------------------------------------------------------------------------------------ rank 0: groups */

/* Which face of cell c has these corners (ids); -1: none */
static int FaceNumber(const Root *root, PetscInt c, int n, const PetscInt corners[])
{
  const Element  *element = root->cell_block[c]->element;
  const PetscInt *nodes   = RootCellNodes(root, c);

  for (int f = 0; f < element->faces; f++) {
    const int n_corners = ElementGet((ElementType)element->face_type)->corners;
    int       same      = 0;

    for (int i = 0; i < n_corners; i++)
      for (int k = 0; k < n; k++) same += root->id[nodes[element->face_nodes[f][i]]] == corners[k];
    if (same == n && n == n_corners) return f;
  }
  return -1;
}

/* The cell that an element of dimension dim - 1 is a face of: the one with the lower id of two. face->cell -1: none */
static PetscErrorCode FindFace(DM dm, const Root *root, const GmshBlock *block, PetscInt item, RootFace *face, PetscBool *interior)
{
  const PetscInt *cells;
  PetscInt        vertices[4], corners[4], point, n_cells;

  PetscFunctionBeginUser;
  face->cell = -1;
  face->tag  = block->tag[item];
  *interior  = PETSC_FALSE;
  for (int k = 0; k < block->nodes; k++)
    if (root->id[block->connectivity[item * block->nodes + k]] < 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < block->element->corners; k++) {
    corners[k]  = root->id[block->connectivity[item * block->nodes + k]];
    vertices[k] = root->point[corners[k]];
  }
  PetscCall(PointOfVertices(dm, block->dim, block->element->corners, vertices, &point));
  if (point < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMPlexGetSupportSize(dm, point, &n_cells));
  PetscCall(DMPlexGetSupport(dm, point, &cells));
  if (!n_cells) PetscFunctionReturn(PETSC_SUCCESS);
  face->cell = cells[0];
  for (PetscInt i = 1; i < n_cells; i++) face->cell = PetscMin(face->cell, cells[i]);
  face->number = FaceNumber(root, face->cell, block->element->corners, corners);
  if (face->number < 0) face->cell = -1;
  *interior = n_cells > 1 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Faces (dim - 1 groups), nodes (all groups, into the group's label) and counts of the elements of one block in one group */
static PetscErrorCode RootGroupBlock(DM dm, Scene scene, const char *file, Root *root, const GmshBlock *block, PetscInt g, MeshGroup *group, DMLabel label,
                                     GmshMessage *message)
{
  const PetscBool rigid = IsRigidGroup(scene, group->dim, group->name);

  PetscFunctionBeginUser;
  for (PetscInt item = 0; item < block->n; item++) {
    RootFace  face  = {.group = g};
    PetscBool loose = PETSC_FALSE, interior = PETSC_FALSE;

    for (int k = 0; k < block->nodes; k++)
      if (root->id[block->connectivity[item * block->nodes + k]] < 0) loose = PETSC_TRUE;
    if (group->dim == scene->dim - 1) {
      PetscCall(FindFace(dm, root, block, item, &face, &interior));
      loose = face.cell < 0 ? PETSC_TRUE : PETSC_FALSE;
    }
    group->n_elements++;
    if (rigid) {
      if (!loose)
        PetscCall(GmshSay(message,
                          "%s: element %" PetscInt_FMT " of the rigid surface '%s' is a face of a deformable body in '%s'; a rigid tool has a mesh of its own",
                          SceneWhere(scene, scene->bodies[FindBody(scene, group->name, PETSC_TRUE)].path, "surface"), block->tag[item], group->name, file));
      continue;
    }
    if (loose) {
      group->n_loose++;
      continue;
    }
    if (group->dim == scene->dim - 1) {
      root->faces[root->n_faces++] = face;
      root->interior[g] += interior;
    }
    for (int k = 0; k < block->nodes; k++) PetscCall(DMLabelSetValue(label, root->point[root->id[block->connectivity[item * block->nodes + k]]], 1));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GroupLabelName(Mesh mesh, const MeshGroup *group, char name[LIST_SIZE])
{
  PetscFunctionBeginUser;
  snprintf(name, LIST_SIZE, "%s %s", DimensionName(mesh->dim, group->dim), group->name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Names, tags and dimensions from rank 0 to all; a label for each group's nodes */
static PetscErrorCode ShareGroups(DM dm, Mesh mesh, const GmshMesh *gmsh)
{
  PetscMPIInt rank, length;
  PetscInt    numbers[3];
  char        label[LIST_SIZE];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  if (!rank) mesh->n_groups = gmsh->n_physicals;
  PetscCallMPI(MPI_Bcast(&mesh->n_groups, 1, MPI_INT, 0, mesh->comm));
  PetscCall(PetscCalloc1(mesh->n_groups, &mesh->groups));
  for (int g = 0; g < mesh->n_groups; g++) {
    MeshGroup *group = &mesh->groups[g];

    if (!rank) {
      numbers[0] = gmsh->physicals[g].dim;
      numbers[1] = gmsh->physicals[g].tag;
      numbers[2] = (PetscInt)strlen(gmsh->physicals[g].name) + 1;
    }
    PetscCallMPI(MPI_Bcast(numbers, 3, MPIU_INT, 0, mesh->comm));
    group->dim = (int)numbers[0];
    group->tag = numbers[1];
    PetscCall(PetscMPIIntCast(numbers[2], &length));
    PetscCall(PetscMalloc1(length, &group->name));
    if (!rank) PetscCall(PetscArraycpy(group->name, gmsh->physicals[g].name, length));
    PetscCallMPI(MPI_Bcast(group->name, length, MPI_CHAR, 0, mesh->comm));
    PetscCall(GroupLabelName(mesh, group, label));
    PetscCall(DMCreateLabel(dm, label));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Faces by cell, in the order in which they were found */
static PetscErrorCode RootSortFaces(Root *root)
{
  RootFace *sorted;
  PetscInt *next;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(root->n_cells + 1, &root->face_ptr));
  PetscCall(PetscMalloc1(root->n_faces, &sorted));
  PetscCall(PetscMalloc1(root->n_cells + 1, &next));
  for (PetscInt f = 0; f < root->n_faces; f++) root->face_ptr[root->faces[f].cell + 1]++;
  for (PetscInt c = 0; c < root->n_cells; c++) root->face_ptr[c + 1] += root->face_ptr[c];
  PetscCall(PetscArraycpy(next, root->face_ptr, root->n_cells + 1));
  for (PetscInt f = 0; f < root->n_faces; f++) sorted[next[root->faces[f].cell]++] = root->faces[f];
  PetscCall(PetscFree(root->faces));
  PetscCall(PetscFree(next));
  root->faces = sorted;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RootGroups(DM dm, Scene scene, const char *file, Root *root, Mesh mesh, GmshMessage *message)
{
  const GmshMesh *gmsh      = &root->gmsh;
  PetscInt        max_faces = 0;
  char            name[LIST_SIZE];

  PetscFunctionBeginUser;
  for (int b = 0; b < gmsh->n_blocks; b++)
    if (gmsh->blocks[b].dim == scene->dim - 1) max_faces += gmsh->blocks[b].n * gmsh->blocks[b].n_physicals;
  PetscCall(PetscMalloc1(max_faces, &root->faces));
  PetscCall(PetscCalloc1(mesh->n_groups, &root->interior));
  for (int b = 0; b < gmsh->n_blocks; b++) {
    for (int i = 0; i < gmsh->blocks[b].n_physicals; i++) {
      const int g = gmsh->blocks[b].physical[i];
      DMLabel   label;

      PetscCall(GroupLabelName(mesh, &mesh->groups[g], name));
      PetscCall(DMGetLabel(dm, name, &label));
      PetscCall(RootGroupBlock(dm, scene, file, root, &gmsh->blocks[b], g, &mesh->groups[g], label, message));
    }
  }
  PetscCall(RootSortFaces(root));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int FindGroup(Mesh mesh, int dim, const char *name)
{
  for (int g = 0; g < mesh->n_groups; g++)
    if (mesh->groups[g].dim == dim && !strcmp(mesh->groups[g].name, name)) return g;
  return -1;
}

/* A surface that the scene loads or brings into contact lies on the boundary; supports and probes may be anywhere. */
static PetscErrorCode CheckBoundary(Scene scene, const Root *root, Mesh mesh, const char *path, const char *key, const char *name, GmshMessage *message)
{
  const int g = name ? FindGroup(mesh, scene->dim - 1, name) : -1;

  PetscFunctionBeginUser;
  if (g >= 0 && root->interior[g]) {
    PetscCall(GmshSay(message, "%s: %" PetscInt_FMT " of the %" PetscInt_FMT " faces of '%s' lie between two cells; allowed: a surface on the boundary",
                      SceneWhere(scene, path, key), root->interior[g], mesh->groups[g].n_elements, name));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckUses(Scene scene, const Root *root, Mesh mesh, GmshMessage *message)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_loads; i++) {
    const SceneLoad *load = &scene->loads[i];

    if (load->kind == LOAD_PRESSURE || load->kind == LOAD_TRACTION) PetscCall(CheckBoundary(scene, root, mesh, load->path, "surface", load->region, message));
  }
  for (int i = 0; i < scene->n_contacts; i++) {
    PetscCall(CheckBoundary(scene, root, mesh, scene->contacts[i].path, "slave", scene->contacts[i].slave, message));
    PetscCall(CheckBoundary(scene, root, mesh, scene->contacts[i].path, "master", scene->contacts[i].master, message));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells with a face in contact, for the partition */
static PetscErrorCode ContactCells(Scene scene, const Root *root, Mesh mesh, PetscBool **contact)
{
  PetscBool *in_contact;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(root->n_cells, contact));
  PetscCall(PetscCalloc1(mesh->n_groups, &in_contact));
  for (int i = 0; i < scene->n_contacts; i++) {
    const char *const names[] = {scene->contacts[i].slave, scene->contacts[i].master};

    for (int k = 0; k < 2; k++) {
      const int g = names[k] ? FindGroup(mesh, scene->dim - 1, names[k]) : -1;

      if (g >= 0) in_contact[g] = PETSC_TRUE;
    }
  }
  for (PetscInt f = 0; f < root->n_faces; f++)
    if (in_contact[root->faces[f].group]) (*contact)[root->faces[f].cell] = PETSC_TRUE;
  PetscCall(PetscFree(in_contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* -------------------------------------------------------------------------------------------------------- rigid tools */

/* Node k of a face that is turned over: corners in the other sense of rotation from the first (a curve: ends swapped), edges with them */
static int ReversedNode(const Element *face, int k)
{
  const int corners = face->corners;

  if (face->dim == 1) return k < 2 ? 1 - k : k;
  if (k < corners) return (corners - k) % corners;
  return k < 2 * corners ? corners + (2 * corners - 1 - k) : k;
}

/* Is the block in group g, and which way round? 0: it is not in it */
static int BlockSign(const GmshBlock *block, int g)
{
  for (int i = 0; i < block->n_physicals; i++)
    if (block->physical[i] == g) return block->sign[i];
  return 0;
}

/* Counts the tool's faces and nodes; local: its nodes by ascending tag, -1 for other nodes of the file. Returns the length of face_nodes. */
static PetscInt RigidCount(const GmshMesh *gmsh, int g, MeshRigid *rigid, PetscInt local[])
{
  PetscInt n_entries = 0;

  for (PetscInt i = 0; i < gmsh->n_nodes; i++) local[i] = -1;
  for (int b = 0; b < gmsh->n_blocks; b++) {
    const GmshBlock *block = &gmsh->blocks[b];

    if (!BlockSign(block, g)) continue;
    rigid->n_faces += block->n;
    n_entries += block->n * block->nodes;
    for (PetscInt k = 0; k < block->n * block->nodes; k++) local[block->connectivity[k]] = 0;
  }
  for (PetscInt i = 0; i < gmsh->n_nodes; i++)
    if (!local[i]) local[i] = rigid->n_nodes++;
  return n_entries;
}

static void RigidFaces(const GmshMesh *gmsh, int g, const PetscInt local[], MeshRigid *rigid)
{
  PetscInt f = 0, n = 0;

  rigid->face_ptr[0] = 0;
  for (int b = 0; b < gmsh->n_blocks; b++) {
    const GmshBlock *block = &gmsh->blocks[b];
    const int        sign  = BlockSign(block, g);

    for (PetscInt item = 0; sign && item < block->n; item++) {
      const PetscInt *nodes = block->connectivity + item * block->nodes;

      rigid->face_type[f] = block->element->type;
      rigid->face_tag[f]  = block->tag[item];
      for (int k = 0; k < block->nodes; k++) rigid->face_nodes[n++] = local[nodes[sign < 0 ? ReversedNode(block->element, k) : k]];
      rigid->face_ptr[++f] = n;
    }
  }
}

static PetscErrorCode RootRigid(const Root *root, int g, Mesh mesh, MeshRigid *rigid)
{
  const GmshMesh *gmsh = &root->gmsh;
  PetscInt       *local, n_entries;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(gmsh->n_nodes, &local));
  n_entries = RigidCount(gmsh, g, rigid, local);
  PetscCall(PetscMalloc2(rigid->n_nodes * mesh->dim, &rigid->coords, rigid->n_nodes, &rigid->node_tag));
  PetscCall(
    PetscMalloc4(rigid->n_faces, &rigid->face_type, rigid->n_faces + 1, &rigid->face_ptr, n_entries, &rigid->face_nodes, rigid->n_faces, &rigid->face_tag));
  RigidFaces(gmsh, g, local, rigid);
  for (PetscInt i = 0; i < gmsh->n_nodes; i++) {
    if (local[i] < 0) continue;
    rigid->node_tag[local[i]] = gmsh->node_tag[i];
    for (int k = 0; k < mesh->dim; k++) rigid->coords[local[i] * mesh->dim + k] = gmsh->coords[3 * i + k] - mesh->centre[k];
  }
  PetscCall(PetscFree(local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ShareRigid(Mesh mesh, MeshRigid *rigid)
{
  PetscMPIInt rank, nodes, faces, entries;
  PetscInt    sizes[3];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  if (!rank) {
    sizes[0] = rigid->n_nodes;
    sizes[1] = rigid->n_faces;
    sizes[2] = rigid->face_ptr[rigid->n_faces];
  }
  PetscCallMPI(MPI_Bcast(sizes, 3, MPIU_INT, 0, mesh->comm));
  if (rank) {
    rigid->n_nodes = sizes[0];
    rigid->n_faces = sizes[1];
    PetscCall(PetscMalloc2(sizes[0] * mesh->dim, &rigid->coords, sizes[0], &rigid->node_tag));
    PetscCall(PetscMalloc4(sizes[1], &rigid->face_type, sizes[1] + 1, &rigid->face_ptr, sizes[2], &rigid->face_nodes, sizes[1], &rigid->face_tag));
  }
  PetscCall(PetscMPIIntCast(sizes[0] * mesh->dim, &nodes));
  PetscCall(PetscMPIIntCast(sizes[1], &faces));
  PetscCall(PetscMPIIntCast(sizes[2], &entries));
  PetscCallMPI(MPI_Bcast(rigid->coords, nodes, MPIU_REAL, 0, mesh->comm));
  PetscCallMPI(MPI_Bcast(rigid->node_tag, nodes / mesh->dim, MPIU_INT, 0, mesh->comm));
  PetscCallMPI(MPI_Bcast(rigid->face_type, faces * (PetscMPIInt)sizeof(*rigid->face_type), MPI_BYTE, 0, mesh->comm));
  PetscCallMPI(MPI_Bcast(rigid->face_ptr, faces + 1, MPIU_INT, 0, mesh->comm));
  PetscCallMPI(MPI_Bcast(rigid->face_nodes, entries, MPIU_INT, 0, mesh->comm));
  PetscCallMPI(MPI_Bcast(rigid->face_tag, faces, MPIU_INT, 0, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateRigid(Scene scene, const Root *root, Mesh mesh)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(scene->n_bodies, &mesh->rigid));
  for (int b = 0; b < scene->n_bodies; b++) {
    const int g = FindGroup(mesh, mesh->dim - 1, scene->bodies[b].name);

    if (!scene->bodies[b].rigid) continue;
    if (g < 0) {
      PetscCall(RefuseInput(mesh->comm, "%s: the mesh has no surface group '%s' for this rigid tool", SceneWhere(scene, scene->bodies[b].path, "surface"),
                            scene->bodies[b].name));
    }
    MeshRigid *rigid = &mesh->rigid[mesh->n_rigid++];

    PetscCall(PetscStrallocpy(scene->bodies[b].name, &rigid->name));
    if (root) PetscCall(RootRigid(root, g, mesh, rigid));
    PetscCall(ShareRigid(mesh, rigid));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ------------------------------------------------------------------------------------------------------- distribution */

/* What travels with the points: sections over the Plex's chart with their values */
typedef struct {
  PetscSection ids, places, cells; /* on points with a node; on cells */
  PetscInt    *id;                 /* node: id, tag */
  PetscReal   *place;              /* node: coordinates relative to the centre */
  PetscInt    *cell;               /* id, tag, type, body, n_nodes, node ids, then (group, number, tag) of each face in a group */
} Cargo;

/* fields 0: a section without fields */
static PetscErrorCode SectionCreate(DM dm, PetscInt fields, PetscSection *section)
{
  PetscInt start, end;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(dm, &start, &end));
  PetscCall(PetscSectionCreate(PetscObjectComm((PetscObject)dm), section));
  if (fields) PetscCall(PetscSectionSetNumFields(*section, fields)); /* before the chart, which the fields take over */
  PetscCall(PetscSectionSetChart(*section, start, end));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CargoAllocate(Cargo *cargo)
{
  PetscInt n_ids, n_places, n_cells;

  PetscFunctionBeginUser;
  PetscCall(PetscSectionSetUp(cargo->ids));
  PetscCall(PetscSectionSetUp(cargo->places));
  PetscCall(PetscSectionSetUp(cargo->cells));
  PetscCall(PetscSectionGetStorageSize(cargo->ids, &n_ids));
  PetscCall(PetscSectionGetStorageSize(cargo->places, &n_places));
  PetscCall(PetscSectionGetStorageSize(cargo->cells, &n_cells));
  PetscCall(PetscMalloc1(n_ids, &cargo->id));
  PetscCall(PetscMalloc1(n_places, &cargo->place));
  PetscCall(PetscMalloc1(n_cells, &cargo->cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void LoadCell(const Root *root, PetscInt c, PetscInt *record)
{
  const GmshBlock *block = root->cell_block[c];
  PetscInt         n     = CELL_HEADER;

  record[0] = c;
  record[1] = block->tag[root->cell_item[c]];
  record[2] = (PetscInt)block->element->type;
  record[3] = root->cell_body[c];
  record[4] = block->nodes;
  for (int k = 0; k < block->nodes; k++) record[n++] = root->id[RootCellNodes(root, c)[k]];
  for (PetscInt f = root->face_ptr[c]; f < root->face_ptr[c + 1]; f++) {
    record[n++] = root->faces[f].group;
    record[n++] = root->faces[f].number;
    record[n++] = root->faces[f].tag;
  }
}

static PetscErrorCode CargoLoad(DM dm, Mesh mesh, const Root *root, Cargo *cargo)
{
  const PetscInt n_nodes = root ? root->n_nodes : 0, n_cells = root ? root->n_cells : 0;
  PetscInt       offset;

  PetscFunctionBeginUser;
  PetscCall(SectionCreate(dm, 0, &cargo->ids));
  PetscCall(SectionCreate(dm, 0, &cargo->places));
  PetscCall(SectionCreate(dm, 0, &cargo->cells));
  for (PetscInt i = 0; i < n_nodes; i++) {
    PetscCall(PetscSectionSetDof(cargo->ids, root->point[i], 2));
    PetscCall(PetscSectionSetDof(cargo->places, root->point[i], mesh->dim));
  }
  for (PetscInt c = 0; c < n_cells; c++)
    PetscCall(PetscSectionSetDof(cargo->cells, c, CELL_HEADER + root->cell_block[c]->nodes + 3 * (root->face_ptr[c + 1] - root->face_ptr[c])));
  PetscCall(CargoAllocate(cargo));
  for (PetscInt i = 0; i < n_nodes; i++) {
    PetscCall(PetscSectionGetOffset(cargo->ids, root->point[i], &offset));
    cargo->id[offset]     = i;
    cargo->id[offset + 1] = root->gmsh.node_tag[root->node[i]];
    PetscCall(PetscSectionGetOffset(cargo->places, root->point[i], &offset));
    for (int k = 0; k < mesh->dim; k++) cargo->place[offset + k] = root->gmsh.coords[3 * root->node[i] + k] - mesh->centre[k];
  }
  for (PetscInt c = 0; c < n_cells; c++) {
    PetscCall(PetscSectionGetOffset(cargo->cells, c, &offset));
    LoadCell(root, c, cargo->cell + offset);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves one section's values along the migration of points */
static PetscErrorCode MoveData(DM dm, PetscSF migration, MPI_Datatype type, PetscSection *section, void **values)
{
  PetscSection moved;
  void        *arrived;

  PetscFunctionBeginUser;
  PetscCall(PetscSectionCreate(PetscObjectComm((PetscObject)dm), &moved));
  PetscCall(DMPlexDistributeData(dm, migration, *section, type, *values, moved, &arrived));
  PetscCall(PetscSectionDestroy(section));
  PetscCall(PetscFree(*values));
  *section = moved;
  *values  = arrived;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives cells to ranks; *dm is replaced, the cargo follows. On one rank nothing moves. */
static PetscErrorCode Distribute(DM *dm, Cargo *cargo)
{
  PetscSF migration;
  DM      distributed;

  PetscFunctionBeginUser;
  PetscCall(DMPlexDistribute(*dm, 0, &migration, &distributed));
  if (distributed) {
    PetscCall(MoveData(distributed, migration, MPIU_INT, &cargo->ids, (void **)&cargo->id));
    PetscCall(MoveData(distributed, migration, MPIU_REAL, &cargo->places, (void **)&cargo->place));
    PetscCall(MoveData(distributed, migration, MPIU_INT, &cargo->cells, (void **)&cargo->cell));
    PetscCall(PetscSFDestroy(&migration));
    PetscCall(DMDestroy(dm));
    *dm = distributed;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CargoFree(Cargo *cargo)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSectionDestroy(&cargo->ids));
  PetscCall(PetscSectionDestroy(&cargo->places));
  PetscCall(PetscSectionDestroy(&cargo->cells));
  PetscCall(PetscFree(cargo->id));
  PetscCall(PetscFree(cargo->place));
  PetscCall(PetscFree(cargo->cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* -------------------------------------------------------------------------------------------------------- local arrays */

/* Values of a point, none outside the section's chart */
static PetscErrorCode SectionRange(PetscSection section, PetscInt point, PetscInt *n, PetscInt *offset)
{
  PetscInt start, end;

  PetscFunctionBeginUser;
  *n = *offset = 0;
  PetscCall(PetscSectionGetChart(section, &start, &end));
  if (point < start || point >= end) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSectionGetDof(section, point, n));
  PetscCall(PetscSectionGetOffset(section, point, offset));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Local nodes: the points that carry one, in the order of the points. point_node: back, -1 without node */
static PetscErrorCode CreateNodes(Mesh mesh, const Cargo *cargo, PetscInt **point_node)
{
  PetscInt start, end, n, offset;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(mesh->dm, &start, &end));
  PetscCall(PetscMalloc1(end, point_node));
  for (PetscInt p = 0; p < end; p++) {
    PetscCall(SectionRange(cargo->ids, p, &n, &offset));
    (*point_node)[p] = n ? mesh->n_nodes++ : -1;
  }
  PetscCall(PetscMalloc6(mesh->n_nodes, &mesh->node_id, mesh->n_nodes, &mesh->node_tag, mesh->n_nodes, &mesh->node_owner, mesh->n_nodes,
                         &mesh->node_owner_local, mesh->n_nodes, &mesh->node_point, mesh->n_nodes * mesh->dim, &mesh->coords));
  PetscCall(PetscMalloc1(mesh->n_nodes * mesh->dim, &mesh->work));
  for (PetscInt p = 0; p < end; p++) {
    const PetscInt node = (*point_node)[p];

    if (node < 0) continue;
    PetscCall(SectionRange(cargo->ids, p, &n, &offset));
    mesh->node_id[node]    = cargo->id[offset];
    mesh->node_tag[node]   = cargo->id[offset + 1];
    mesh->node_point[node] = p;
    PetscCall(SectionRange(cargo->places, p, &n, &offset));
    for (int k = 0; k < mesh->dim; k++) mesh->coords[node * mesh->dim + k] = cargo->place[offset + k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Owners of the nodes from those of their points, and the SF between copies of a node */
static PetscErrorCode CreateOwners(Mesh mesh, PetscInt point_node[])
{
  PetscSF            point_sf;
  PetscInt           start, end, n_leaves, n_ghosts = 0, *owner_node, *leaf;
  const PetscInt    *leaves;
  const PetscSFNode *remotes;
  PetscSFNode       *remote;
  PetscMPIInt        rank, size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCallMPI(MPI_Comm_size(mesh->comm, &size));
  PetscCall(DMPlexGetChart(mesh->dm, &start, &end));
  PetscCall(DMGetPointSF(mesh->dm, &point_sf));
  PetscCall(PetscSFGetGraph(point_sf, NULL, &n_leaves, &leaves, &remotes));
  n_leaves = PetscMax(n_leaves, 0); /* -1: no graph, one rank */
  PetscCall(PetscMalloc1(end, &owner_node));
  PetscCall(PetscArraycpy(owner_node, point_node, end));
  if (size > 1) {
    PetscCall(PetscSFBcastBegin(point_sf, MPIU_INT, point_node, owner_node, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(point_sf, MPIU_INT, point_node, owner_node, MPI_REPLACE));
  }
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    mesh->node_owner[i]       = rank;
    mesh->node_owner_local[i] = i;
  }
  PetscCall(PetscMalloc1(n_leaves, &leaf));
  PetscCall(PetscMalloc1(n_leaves, &remote));
  for (PetscInt l = 0; l < n_leaves; l++) {
    const PetscInt point = leaves ? leaves[l] : l, node = point_node[point];

    if (node < 0) continue;
    mesh->node_owner[node]       = remotes[l].rank;
    mesh->node_owner_local[node] = owner_node[point];
    leaf[n_ghosts]               = node;
    remote[n_ghosts].rank        = remotes[l].rank;
    remote[n_ghosts++].index     = owner_node[point];
  }
  mesh->n_owned = mesh->n_nodes - n_ghosts;
  PetscCall(PetscSFCreate(mesh->comm, &mesh->node_sf));
  PetscCall(PetscSFSetGraph(mesh->node_sf, mesh->n_nodes, n_ghosts, leaf, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscSFSetUp(mesh->node_sf));
  PetscCall(PetscFree(owner_node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Local cells, and the faces that their records bring along to the groups */
static PetscErrorCode CreateCells(Mesh mesh, const Cargo *cargo)
{
  PetscInt start, n_entries = 0, n, offset, *ids, *nodes, *n_faces;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(mesh->dm, 0, &start, &mesh->n_cells));
  PetscCall(PetscCalloc1(mesh->n_groups, &n_faces));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    PetscCall(SectionRange(cargo->cells, c, &n, &offset));
    const PetscInt *record = cargo->cell + offset;

    n_entries += record[4];
    for (PetscInt f = CELL_HEADER + record[4]; f < n; f += 3) n_faces[record[f]]++;
  }
  for (int g = 0; g < mesh->n_groups; g++) {
    MeshGroup *group = &mesh->groups[g];

    PetscCall(PetscMalloc3(n_faces[g], &group->face_cell, n_faces[g], &group->face_number, n_faces[g], &group->face_tag));
  }
  PetscCall(PetscMalloc6(mesh->n_cells, &mesh->cell_id, mesh->n_cells, &mesh->cell_type, mesh->n_cells + 1, &mesh->cell_ptr, n_entries, &mesh->cell_nodes,
                         mesh->n_cells, &mesh->cell_body, mesh->n_cells, &mesh->cell_tag));
  PetscCall(PetscMalloc2(mesh->n_nodes, &ids, mesh->n_nodes, &nodes));
  PetscCall(PetscArraycpy(ids, mesh->node_id, mesh->n_nodes));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) nodes[i] = i;
  PetscCall(PetscSortIntWithArray(mesh->n_nodes, ids, nodes));
  mesh->cell_ptr[0] = 0;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    PetscCall(SectionRange(cargo->cells, c, &n, &offset));
    const PetscInt *record = cargo->cell + offset;

    mesh->cell_id[c]      = record[0];
    mesh->cell_tag[c]     = record[1];
    mesh->cell_type[c]    = (ElementType)record[2];
    mesh->cell_body[c]    = (int)record[3];
    mesh->cell_ptr[c + 1] = mesh->cell_ptr[c] + record[4];
    for (PetscInt k = 0; k < record[4]; k++) {
      PetscInt place;

      PetscCall(PetscFindInt(record[CELL_HEADER + k], mesh->n_nodes, ids, &place));
      PetscCheck(place >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "Node %" PetscInt_FMT " of cell %" PetscInt_FMT " did not come with it", record[CELL_HEADER + k],
                 record[0]);
      mesh->cell_nodes[mesh->cell_ptr[c] + k] = nodes[place];
    }
    for (PetscInt f = CELL_HEADER + record[4]; f < n; f += 3) {
      MeshGroup *group = &mesh->groups[record[f]];

      group->face_cell[group->n_faces]   = c;
      group->face_number[group->n_faces] = (int)record[f + 1];
      group->face_tag[group->n_faces++]  = record[f + 2];
    }
  }
  PetscCall(PetscFree2(ids, nodes));
  PetscCall(PetscFree(n_faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A group's nodes from its label: also those that only another rank's face touches */
static PetscErrorCode CreateGroupNodes(Mesh mesh, MeshGroup *group, const PetscInt point_node[])
{
  char            name[LIST_SIZE];
  IS              points;
  const PetscInt *point;
  PetscInt        n;

  PetscFunctionBeginUser;
  PetscCall(GroupLabelName(mesh, group, name));
  PetscCall(DMGetStratumIS(mesh->dm, name, 1, &points));
  if (!points) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ISGetLocalSize(points, &n));
  PetscCall(ISGetIndices(points, &point));
  PetscCall(PetscMalloc1(n, &group->nodes));
  for (PetscInt i = 0; i < n; i++)
    if (point_node[point[i]] >= 0) group->nodes[group->n_nodes++] = point_node[point[i]];
  PetscCall(PetscSortInt(group->n_nodes, group->nodes));
  PetscCall(ISRestoreIndices(points, &point));
  PetscCall(ISDestroy(&points));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateLocalArrays(Mesh mesh, const Cargo *cargo)
{
  PetscInt *point_node;

  PetscFunctionBeginUser;
  PetscCall(CreateNodes(mesh, cargo, &point_node));
  PetscCall(CreateOwners(mesh, point_node));
  PetscCall(CreateCells(mesh, cargo));
  for (int g = 0; g < mesh->n_groups; g++) {
    MeshGroup *group    = &mesh->groups[g];
    PetscInt   count[2] = {group->n_elements, group->n_loose};

    PetscCall(CreateGroupNodes(mesh, group, point_node));
    PetscCallMPI(MPI_Bcast(count, 2, MPIU_INT, 0, mesh->comm));
    group->n_elements = count[0];
    group->n_loose    = count[1];
  }
  PetscCall(PetscFree(point_node));
  PetscCallMPI(MPI_Allreduce(&mesh->n_owned, &mesh->n_global, 1, MPIU_INT, MPI_SUM, mesh->comm));
  PetscCallMPI(MPI_Allreduce(&mesh->n_cells, &mesh->n_cells_global, 1, MPIU_INT, MPI_SUM, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* --------------------------------------------------------------------------------------------------- create and destroy */

/*
  MeshGenerate - the scene's mesh file, made from its .geo by gmsh if need be

  Collective

  Input Parameters:
+ comm      - all ranks; rank 0 runs gmsh
. scene     - mesh file, order, parameters
- directory - where made meshes are kept

  Output Parameters:
+ file    - path of the .msh (PETSC_MAX_PATH_LEN characters)
- seconds - wall time of gmsh, 0 if nothing was made

  Note:
  Refuses a file that is neither .geo nor .msh, and what gmsh refuses.
*/
PetscErrorCode MeshGenerate(MPI_Comm comm, Scene scene, const char *directory, char *file, PetscReal *seconds)
{
  const char *ending  = strrchr(scene->mesh_file, '.');
  GmshMessage message = {""};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  *seconds = 0;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!ending || (strcmp(ending, ".geo") && strcmp(ending, ".msh"))) {
    PetscCall(RefuseInput(comm, "%s: '%s' is neither a .geo nor a .msh file", SceneWhere(scene, "mesh", "file"), scene->mesh_file));
  }
  if (!strcmp(ending, ".msh"))
    PetscCall(PetscStrncpy(file, scene->mesh_file, PETSC_MAX_PATH_LEN));
  else if (!rank)
    PetscCall(GmshGenerate(scene, directory, file, seconds, &message));
  PetscCall(RefuseInputAnywhere(comm, message.text[0] ? message.text : NULL));
  PetscCallMPI(MPI_Bcast(file, PETSC_MAX_PATH_LEN, MPI_CHAR, 0, comm));
  PetscCallMPI(MPI_Bcast(seconds, 1, MPIU_REAL, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rank 0's findings that all need */
static PetscErrorCode ShareFrame(Mesh mesh)
{
  PetscReal frame[4] = {mesh->centre[0], mesh->centre[1], mesh->centre[2], mesh->size};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(frame, 4, MPIU_REAL, 0, mesh->comm));
  PetscCallMPI(MPI_Bcast(&mesh->order, 1, MPI_INT, 0, mesh->comm));
  PetscCall(PetscArraycpy(mesh->centre, frame, 3));
  mesh->size = frame[3];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MarkAttached(Mesh mesh, Scene scene)
{
  PetscFunctionBeginUser;
  for (int g = 0; g < mesh->n_groups; g++) {
    MeshGroup *group = &mesh->groups[g];

    group->attached = group->n_loose || IsRigidGroup(scene, group->dim, group->name) ? PETSC_FALSE : PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  MeshCreate - the distributed mesh from a .msh file

  Collective

  Input Parameters:
+ comm  - all ranks; rank 0 reads
. scene - bodies, dimension, and which surfaces are loaded or in contact
- file  - a .msh file, format 4.1

  Output Parameter:
. mesh - to be destroyed with MeshDestroy(). The local section holds every dof as free until MeshSetConstraints() is called.

  Options Database Key:
. -mesh_dm_view - views the DMPlex

  Note:
  Refuses damaged files, elements that are not available, bodies without cells, cells without a body, mixed orders, a two-dimensional mesh
  out of its plane, and loads or contact on surfaces that are rigid or lie between cells.
*/
PetscErrorCode MeshCreate(MPI_Comm comm, Scene scene, const char *file, Mesh *created)
{
  Root        storage = {.n_cells = 0}, *root;
  GmshMessage message = {""};
  Cargo       cargo;
  Mesh        mesh;
  PetscBool  *contact = NULL, *constrained;
  PetscMPIInt rank, size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  root = rank ? NULL : &storage;
  PetscCall(PetscNew(&mesh));
  mesh->comm = comm;
  mesh->dim  = scene->dim;
  if (root) PetscCall(RootRead(scene, file, size, root, mesh, &message));
  PetscCall(RefuseInputAnywhere(comm, message.text[0] ? message.text : NULL));
  PetscCall(ShareFrame(mesh));
  PetscCall(CreateTopology(comm, mesh->dim, root, &mesh->dm));
  PetscCall(ShareGroups(mesh->dm, mesh, root ? &root->gmsh : NULL));
  if (root) {
    PetscCall(RootPoints(mesh->dm, file, root, &message));
    if (!message.text[0]) PetscCall(RootGroups(mesh->dm, scene, file, root, mesh, &message));
    if (!message.text[0]) PetscCall(CheckUses(scene, root, mesh, &message));
  }
  PetscCall(RefuseInputAnywhere(comm, message.text[0] ? message.text : NULL));
  if (root) PetscCall(ContactCells(scene, root, mesh, &contact));
  PetscCall(CreateRigid(scene, root, mesh));
  PetscCall(SetVertexCoordinates(mesh->dm, mesh->dim, root));
  PetscCall(PartitionCells(mesh->dm, contact, &mesh->partition));
  PetscCall(CargoLoad(mesh->dm, mesh, root, &cargo));
  if (root) PetscCall(RootFree(root));
  PetscCall(PetscFree(contact));
  PetscCall(Distribute(&mesh->dm, &cargo));
  PetscCall(CreateLocalArrays(mesh, &cargo));
  PetscCall(CargoFree(&cargo));
  PetscCall(MarkAttached(mesh, scene));
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &constrained));
  PetscCall(MeshSetConstraints(mesh, constrained));
  PetscCall(PetscFree(constrained));
  PetscCall(DMSetOptionsPrefix(mesh->dm, "mesh_"));
  PetscCall(PetscObjectSetName((PetscObject)mesh->dm, "mesh"));
  PetscCall(DMViewFromOptions(mesh->dm, NULL, "-dm_view"));
  *created = mesh;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  MeshDestroy - frees a mesh

  Collective
*/
PetscErrorCode MeshDestroy(Mesh *destroyed)
{
  Mesh mesh = *destroyed;

  PetscFunctionBeginUser;
  if (!mesh) PetscFunctionReturn(PETSC_SUCCESS);
  for (int g = 0; g < mesh->n_groups; g++) {
    PetscCall(PetscFree(mesh->groups[g].name));
    PetscCall(PetscFree(mesh->groups[g].nodes));
    PetscCall(PetscFree3(mesh->groups[g].face_cell, mesh->groups[g].face_number, mesh->groups[g].face_tag));
  }
  for (int r = 0; r < mesh->n_rigid; r++) {
    MeshRigid *rigid = &mesh->rigid[r];

    PetscCall(PetscFree(rigid->name));
    PetscCall(PetscFree2(rigid->coords, rigid->node_tag));
    PetscCall(PetscFree4(rigid->face_type, rigid->face_ptr, rigid->face_nodes, rigid->face_tag));
  }
  PetscCall(PetscFree(mesh->groups));
  PetscCall(PetscFree(mesh->rigid));
  PetscCall(PetscFree6(mesh->node_id, mesh->node_tag, mesh->node_owner, mesh->node_owner_local, mesh->node_point, mesh->coords));
  PetscCall(PetscFree6(mesh->cell_id, mesh->cell_type, mesh->cell_ptr, mesh->cell_nodes, mesh->cell_body, mesh->cell_tag));
  PetscCall(PetscFree(mesh->global_dofs));
  PetscCall(PetscFree(mesh->work));
  PetscCall(PetscSFDestroy(&mesh->node_sf));
  PetscCall(DMDestroy(&mesh->dm));
  PetscCall(PetscFree(*destroyed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ------------------------------------------------------------------------------------------------------------- queries */

static void ListGroups(Mesh mesh, int dim, char list[LIST_SIZE])
{
  size_t used = 0;

  snprintf(list, LIST_SIZE, "none");
  for (int g = 0; g < mesh->n_groups && used < LIST_SIZE; g++)
    if (mesh->groups[g].dim <= dim) used += (size_t)snprintf(list + used, LIST_SIZE - used, "%s%s", used ? ", " : "", mesh->groups[g].name);
}

/*
  MeshGetGroup - a physical group by its name, or refuses

  Collective

  Input Parameters:
+ mesh  - the mesh
. scene - with path and key: the place in the scene file that names the group
. path  - for example "contact.0"
. key   - for example "slave"
. name  - of the group
- dim   - largest dimension allowed: mesh->dim for volumes, mesh->dim - 1 for surfaces. Of groups of one name the one of the largest
          dimension is taken.

  Output Parameter:
. found - belongs to the mesh. A rigid tool is returned too (not attached, without nodes and faces; see MeshFindRigid()); any other
          group of which some elements do not lie on a body is refused.
*/
PetscErrorCode MeshGetGroup(Mesh mesh, Scene scene, const char *path, const char *key, const char *name, int dim, MeshGroup **found)
{
  char list[LIST_SIZE];
  int  g = -1, higher = -1;

  PetscFunctionBeginUser;
  *found = NULL;
  for (int d = dim; d >= 0 && g < 0; d--) g = FindGroup(mesh, d, name);
  for (int d = dim + 1; d <= mesh->dim && higher < 0; d++) higher = FindGroup(mesh, d, name);
  ListGroups(mesh, dim, list);
  if (g < 0 && higher >= 0) {
    PetscCall(RefuseInput(mesh->comm, "%s: '%s' is a %s; a %s is needed: %s", SceneWhere(scene, path, key), name,
                          DimensionName(mesh->dim, mesh->groups[higher].dim), DimensionName(mesh->dim, dim), list));
  }
  if (g < 0)
    PetscCall(RefuseInput(mesh->comm, "%s: the mesh has no %s '%s'; it has: %s", SceneWhere(scene, path, key), DimensionName(mesh->dim, dim), name, list));
  if (mesh->groups[g].n_loose) {
    PetscCall(RefuseInput(mesh->comm,
                          "%s: %" PetscInt_FMT " of the %" PetscInt_FMT
                          " elements of '%s' do not lie on any body; a surface of its own is a rigid tool: list it in bodies with `rigid`",
                          SceneWhere(scene, path, key), mesh->groups[g].n_loose, mesh->groups[g].n_elements, name));
  }
  *found = &mesh->groups[g];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  MeshFindRigid - a meshed rigid tool by the name of its surface group

  Not Collective

  Returns NULL if the scene has no such tool.
*/
MeshRigid *MeshFindRigid(Mesh mesh, const char *name)
{
  for (int r = 0; r < mesh->n_rigid; r++)
    if (!strcmp(mesh->rigid[r].name, name)) return &mesh->rigid[r];
  return NULL;
}

/*
  MeshFaceNodes - nodes of one face of a group

  Not Collective

  Input Parameters:
+ mesh  - the mesh
. group - of dimension mesh->dim - 1
- f     - 0 to group->n_faces - 1

  Output Parameter:
. nodes - local nodes in the order of the face's own element, normal out of the cell

  Returns the face's element type.
*/
ElementType MeshFaceNodes(Mesh mesh, const MeshGroup *group, PetscInt f, PetscInt nodes[FACE_MAX_NODES])
{
  const PetscInt cell    = group->face_cell[f];
  const Element *element = ElementGet(mesh->cell_type[cell]), *face = ElementGet((ElementType)element->face_type);

  for (int k = 0; k < face->nodes; k++) nodes[k] = mesh->cell_nodes[mesh->cell_ptr[cell] + element->face_nodes[group->face_number[f]][k]];
  return face->type;
}

/* -------------------------------------------------------------------------------------- global numbering and exchange */

/* The displacement's section: dim dofs on each point with a node */
static PetscErrorCode CreateSection(Mesh mesh, const PetscBool constrained[], PetscSection *section)
{
  PetscInt which[3];

  PetscFunctionBeginUser;
  PetscCall(SectionCreate(mesh->dm, 1, section));
  PetscCall(PetscSectionSetFieldName(*section, 0, "displacement"));
  PetscCall(PetscSectionSetFieldComponents(*section, 0, mesh->dim));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    PetscInt n = 0;

    for (int k = 0; k < mesh->dim; k++) n += constrained[i * mesh->dim + k];
    PetscCall(PetscSectionSetDof(*section, mesh->node_point[i], mesh->dim));
    PetscCall(PetscSectionSetFieldDof(*section, mesh->node_point[i], 0, mesh->dim));
    PetscCall(PetscSectionSetConstraintDof(*section, mesh->node_point[i], n));
    PetscCall(PetscSectionSetFieldConstraintDof(*section, mesh->node_point[i], 0, n));
  }
  PetscCall(PetscSectionSetUp(*section));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    PetscInt n = 0;

    for (int k = 0; k < mesh->dim; k++)
      if (constrained[i * mesh->dim + k]) which[n++] = k;
    if (!n) continue;
    PetscCall(PetscSectionSetConstraintIndices(*section, mesh->node_point[i], which));
    PetscCall(PetscSectionSetFieldConstraintIndices(*section, mesh->node_point[i], 0, which));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* n values of a node as one unit of communication. Real values only: two 64-bit integers would be taken for MPI's pair type. */
static PetscErrorCode NodeTypeCreate(PetscInt n, MPI_Datatype *type)
{
  PetscMPIInt count;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(n, &count));
  PetscCallMPI(MPI_Type_contiguous(count, MPIU_REAL, type));
  PetscCallMPI(MPI_Type_commit(type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Global numbers of the free dofs, from the global section (which stores -(x + 1) for points of other ranks) */
static PetscErrorCode NumberDofs(Mesh mesh, const PetscBool constrained[])
{
  PetscSection global;
  PetscInt     offset;

  PetscFunctionBeginUser;
  PetscCall(DMGetGlobalSection(mesh->dm, &global));
  PetscCall(PetscFree(mesh->global_dofs));
  PetscCall(PetscMalloc1(mesh->n_nodes * mesh->dim, &mesh->global_dofs));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    PetscCall(PetscSectionGetOffset(global, mesh->node_point[i], &offset));
    if (offset < 0) offset = -(offset + 1);
    for (int k = 0; k < mesh->dim; k++) mesh->global_dofs[i * mesh->dim + k] = constrained[i * mesh->dim + k] ? -1 : offset++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  MeshSetConstraints - says which dofs are prescribed, and numbers the free ones

  Collective

  Input Parameters:
+ mesh        - the mesh
- constrained - n_nodes*dim: this rank's local dofs; a dof is prescribed if any rank that has its node says so

  Note:
  Sets the DM's local section; vectors and matrices made before do not fit any more.
*/
PetscErrorCode MeshSetConstraints(Mesh mesh, const PetscBool *constrained)
{
  const PetscInt n = mesh->n_nodes * mesh->dim;
  PetscSection   section;
  PetscReal     *votes;
  PetscBool     *agreed;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &votes, n, &agreed));
  for (PetscInt i = 0; i < n; i++) votes[i] = constrained[i] ? 1 : 0;
  PetscCall(MeshSumNodes(mesh, mesh->dim, votes));
  for (PetscInt i = 0; i < n; i++) agreed[i] = votes[i] > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(CreateSection(mesh, agreed, &section));
  PetscCall(DMSetLocalSection(mesh->dm, section));
  PetscCall(NumberDofs(mesh, agreed));
  PetscCall(PetscSectionDestroy(&section));
  PetscCall(PetscFree2(votes, agreed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  MeshGetGlobalDofs - global numbers of the local dofs

  Not Collective

  Output Parameter:
. dofs - n_nodes*dim, -1 where constrained; also for nodes of other ranks. Belongs to the mesh; a new array after each MeshSetConstraints().
*/
PetscErrorCode MeshGetGlobalDofs(Mesh mesh, const PetscInt **dofs)
{
  PetscFunctionBeginUser;
  *dofs = mesh->global_dofs;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  MeshGlobalToLocal - free displacements from a global vector to the local array, ghost nodes included

  Collective

  Input Parameters:
+ mesh - the mesh, after MeshSetConstraints()
- x    - made by DMCreateGlobalVector()

  Output Parameter:
. u - n_nodes*dim; constrained entries are left alone
*/
PetscErrorCode MeshGlobalToLocal(Mesh mesh, Vec x, PetscReal *u)
{
  const PetscInt     n = mesh->n_nodes * mesh->dim;
  const PetscScalar *values;
  PetscInt           first, last;
  MPI_Datatype       type;

  PetscFunctionBeginUser;
  PetscCall(VecGetOwnershipRange(x, &first, &last));
  PetscCall(VecGetArrayRead(x, &values));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt dof = mesh->global_dofs[i];

    mesh->work[i] = dof >= first && dof < last ? PetscRealPart(values[dof - first]) : 0;
  }
  PetscCall(VecRestoreArrayRead(x, &values));
  PetscCall(NodeTypeCreate(mesh->dim, &type));
  PetscCall(PetscSFBcastBegin(mesh->node_sf, type, mesh->work, mesh->work, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(mesh->node_sf, type, mesh->work, mesh->work, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&type));
  for (PetscInt i = 0; i < n; i++)
    if (mesh->global_dofs[i] >= 0) u[i] = mesh->work[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  MeshLocalToGlobal - sums local contributions of all ranks into a global vector over the free dofs

  Collective

  Input Parameters:
+ mesh - the mesh, after MeshSetConstraints()
- f    - n_nodes*dim: this rank's contributions, not changed

  Output Parameter:
. F - made by DMCreateGlobalVector(); overwritten
*/
PetscErrorCode MeshLocalToGlobal(Mesh mesh, const PetscReal *f, Vec F)
{
  const PetscInt n = mesh->n_nodes * mesh->dim;
  PetscScalar   *values;
  PetscInt       first, last;
  MPI_Datatype   type;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(mesh->work, f, n));
  PetscCall(NodeTypeCreate(mesh->dim, &type));
  PetscCall(PetscSFReduceBegin(mesh->node_sf, type, f, mesh->work, MPIU_SUM));
  PetscCall(PetscSFReduceEnd(mesh->node_sf, type, f, mesh->work, MPIU_SUM));
  PetscCallMPI(MPI_Type_free(&type));
  PetscCall(VecGetOwnershipRange(F, &first, &last));
  PetscCall(VecGetArrayWrite(F, &values));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt dof = mesh->global_dofs[i];

    if (dof >= first && dof < last) values[dof - first] = mesh->work[i];
  }
  PetscCall(VecRestoreArrayWrite(F, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  MeshSumNodes - sums nodal values over all ranks' copies of a node

  Collective

  Input Parameters:
+ mesh   - the mesh
. block  - values per node
- values - n_nodes*block; on return every copy holds the same sum
*/
PetscErrorCode MeshSumNodes(Mesh mesh, PetscInt block, PetscReal *values)
{
  MPI_Datatype type;

  PetscFunctionBeginUser;
  type = MPIU_REAL; /* a contiguous type of one is no type that PetscSF can sum */
  if (block > 1) PetscCall(NodeTypeCreate(block, &type));
  PetscCall(PetscSFReduceBegin(mesh->node_sf, type, values, values, MPIU_SUM));
  PetscCall(PetscSFReduceEnd(mesh->node_sf, type, values, values, MPIU_SUM));
  PetscCall(PetscSFBcastBegin(mesh->node_sf, type, values, values, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(mesh->node_sf, type, values, values, MPI_REPLACE));
  if (block > 1) PetscCallMPI(MPI_Type_free(&type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ------------------------------------------------------------------------------------------------- quality and report */

static void CellCoordinates(Mesh mesh, Scene scene, PetscInt c, double *X)
{
  const PetscInt n = mesh->cell_ptr[c + 1] - mesh->cell_ptr[c];

  for (PetscInt a = 0; a < n; a++) {
    for (int k = 0; k < mesh->dim; k++) X[a * mesh->dim + k] = (double)mesh->coords[mesh->cell_nodes[mesh->cell_ptr[c] + a] * mesh->dim + k];
    if (scene->geometry == GEOMETRY_AXISYMMETRIC) X[a * mesh->dim] += (double)mesh->centre[0];
  }
}

/* A cell is inverted if its Jacobian changes sign, or has the wrong sign all over (then its volume is negative). */
static PetscBool CellInverted(Mesh mesh, Scene scene, PetscInt c, double *quality)
{
  double X[ELEMENT_MAX_NODES * 3];

  CellCoordinates(mesh, scene, c, X);
  *quality = ElementQuality(mesh->cell_type[c], mesh->dim, X);
  return !(*quality > 0) || !(CellVolume(mesh->cell_type[c], mesh->dim, GEOMETRY_PLANE_STRAIN, X) > 0) ? PETSC_TRUE : PETSC_FALSE;
}

/*
  MeshCheckQuality - refuses inverted cells

  Collective

  Input Parameters:
+ mesh  - the mesh
- scene - for the names of its bodies
*/
PetscErrorCode MeshCheckQuality(Mesh mesh, Scene scene)
{
  char     message[LIST_SIZE] = "";
  double   quality;
  PetscInt worst = PETSC_MAX_INT, lowest, count = 0; /* worst: this rank's lowest tag */

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    if (!CellInverted(mesh, scene, c, &quality)) continue;
    count++;
    if (mesh->cell_tag[c] > worst) continue;
    worst = mesh->cell_tag[c];
    snprintf(message, sizeof(message), "cell %" PetscInt_FMT " of body '%s' is inverted (smallest over mean Jacobian determinant %g)", mesh->cell_tag[c],
             scene->bodies[mesh->cell_body[c]].name, quality);
  }
  PetscCallMPI(MPI_Allreduce(&worst, &lowest, 1, MPIU_INT, MPI_MIN, mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPIU_INT, MPI_SUM, mesh->comm));
  if (count && lowest == worst) {
    char full[2 * LIST_SIZE];

    snprintf(full, sizeof(full), "%s: %s; inverted cells in all: %" PetscInt_FMT "; turn the entity round in gmsh, or mesh more finely where it is curved",
             SceneWhere(scene, "mesh", "file"), message, count);
    PetscCall(RefuseInputAnywhere(mesh->comm, full));
  } else
    PetscCall(RefuseInputAnywhere(mesh->comm, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SumReals(Mesh mesh, PetscMPIInt n, PetscReal values[])
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, values, n, MPIU_REAL, MPIU_SUM, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Printed by rank 0; not by PetscFPrintf(), which writes whole numbers with a point behind them */
static PetscErrorCode ReportLine(Mesh, FILE *, const char *, ...) __attribute__((format(printf, 3, 4)));

static PetscErrorCode ReportLine(Mesh mesh, FILE *stream, const char *format, ...)
{
  va_list     arguments;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  if (rank) PetscFunctionReturn(PETSC_SUCCESS);
  va_start(arguments, format);
  vfprintf(stream, format, arguments);
  va_end(arguments);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReportBody(Mesh mesh, Scene scene, int b, FILE *stream)
{
  PetscReal sums[ELEMENT_TYPES + 3] = {0}; /* cells by type, nodes, volume, sum of qualities */
  PetscReal cells                   = 0;
  char      kinds[LIST_SIZE];
  size_t    used = 0;
  struct {
    double quality;
    int    tag;
  } worst = {PETSC_MAX_REAL, 0};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    double X[ELEMENT_MAX_NODES * 3], quality;

    if (mesh->cell_body[c] != b) continue;
    (void)CellInverted(mesh, scene, c, &quality);
    CellCoordinates(mesh, scene, c, X);
    sums[mesh->cell_type[c]]++;
    sums[ELEMENT_TYPES + 1] += CellVolume(mesh->cell_type[c], mesh->dim, scene->geometry, X);
    sums[ELEMENT_TYPES + 2] += quality;
    if (quality < worst.quality || (quality == worst.quality && mesh->cell_tag[c] < worst.tag)) {
      worst.quality = quality;
      worst.tag     = (int)mesh->cell_tag[c];
    }
  }
  const int g = FindGroup(mesh, mesh->dim, scene->bodies[b].name);

  for (PetscInt i = 0; i < mesh->groups[g].n_nodes; i++) sums[ELEMENT_TYPES] += mesh->node_owner[mesh->groups[g].nodes[i]] == rank;
  PetscCall(SumReals(mesh, ELEMENT_TYPES + 3, sums));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE_INT, MPI_MINLOC, mesh->comm));
  for (int type = 0; type < ELEMENT_TYPES; type++) {
    cells += sums[type];
    if (sums[type] > 0)
      used += (size_t)snprintf(kinds + used, sizeof(kinds) - used, "%s%.0f %s", used ? ", " : "", (double)sums[type], ElementGet((ElementType)type)->name);
  }
  PetscCall(ReportLine(mesh, stream, "  body %s: %s; %.0f nodes, volume %g, quality least %.3g (cell %d), mean %.3g\n", scene->bodies[b].name, kinds,
                       (double)sums[ELEMENT_TYPES], (double)sums[ELEMENT_TYPES + 1], worst.quality, worst.tag, (double)(sums[ELEMENT_TYPES + 2] / cells)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReportSurface(Mesh mesh, Scene scene, const MeshGroup *group, FILE *stream)
{
  PetscReal sums[2] = {(PetscReal)group->n_faces, 0}; /* faces, area */

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < group->n_faces; f++) {
    PetscInt          nodes[FACE_MAX_NODES];
    const ElementType type = MeshFaceNodes(mesh, group, f, nodes);
    double            X[FACE_MAX_NODES * 3], area[FACE_MAX_NODES] = {0};

    for (int a = 0; a < ElementGet(type)->nodes; a++) {
      for (int k = 0; k < mesh->dim; k++) X[a * mesh->dim + k] = (double)mesh->coords[nodes[a] * mesh->dim + k];
      if (scene->geometry == GEOMETRY_AXISYMMETRIC) X[a * mesh->dim] += (double)mesh->centre[0];
    }
    FaceAreaKernel(type, mesh->dim, scene->geometry, X, area, NULL);
    for (int a = 0; a < ElementGet(type)->nodes; a++) sums[1] += area[a];
  }
  PetscCall(SumReals(mesh, 2, sums));
  PetscCall(ReportLine(mesh, stream, "  surface %s: %.0f faces, area %g\n", group->name, (double)sums[0], (double)sums[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  MeshReport - prints bodies, surfaces, rigid tools and the partition

  Collective; rank 0 prints

  Input Parameters:
+ mesh   - the mesh
. scene  - for its bodies
- stream - of rank 0

  Note:
  Areas and volumes are over 360 degrees if axisymmetric. A surface between cells counts once.
*/
PetscErrorCode MeshReport(Mesh mesh, Scene scene, FILE *stream)
{
  PetscFunctionBeginUser;
  PetscCall(ReportLine(mesh, stream, "mesh: %" PetscInt_FMT " cells of order %d, %" PetscInt_FMT " nodes, size %g\n", mesh->n_cells_global, mesh->order,
                       mesh->n_global, (double)mesh->size));
  for (int b = 0; b < scene->n_bodies; b++)
    if (!scene->bodies[b].rigid) PetscCall(ReportBody(mesh, scene, b, stream));
  for (int g = 0; g < mesh->n_groups; g++)
    if (mesh->groups[g].dim == mesh->dim - 1 && mesh->groups[g].attached) PetscCall(ReportSurface(mesh, scene, &mesh->groups[g], stream));
  for (int r = 0; r < mesh->n_rigid; r++) {
    PetscCall(ReportLine(mesh, stream, "  rigid tool %s: %" PetscInt_FMT " faces, %" PetscInt_FMT " nodes\n", mesh->rigid[r].name, mesh->rigid[r].n_faces,
                         mesh->rigid[r].n_nodes));
  }
  if (strcmp(mesh->partition.tool, "none")) {
    PetscCall(ReportLine(mesh, stream, "  partition by %s: edge cut %" PetscInt_FMT ", imbalance of cells %.3f, of contact cells %.3f\n", mesh->partition.tool,
                         mesh->partition.edge_cut, (double)mesh->partition.imbalance_cells, (double)mesh->partition.imbalance_contact));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
