/* DMPlex of the whole mesh on rank 0, from gmsh's cells. */
#include "roottopology.h"

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

/* Returns the corner of gmsh's element at place i of Plex' cone. In Plex, the normal of the first face of a solid
   points inwards. */
static int PlexCorner(ElementType type, int i)
{
  static const int tet[] = {1, 0, 2, 3}, hex[] = {0, 3, 2, 1, 4, 5, 6, 7};

  if (CellPolytope(type) == DM_POLYTOPE_TETRAHEDRON) return tet[i];
  if (CellPolytope(type) == DM_POLYTOPE_HEXAHEDRON) return hex[i];
  return i;
}

/*@
  RootTopologyCreate - creates the DMPlex of the cells, all on rank 0.

  Collective

  Input Parameters:
+ comm  - all ranks
. dim   - dimension of the cells
. order - order of the elements
- root  - on rank 0; NULL on other ranks

  Output Parameter:
. dm - points are the cells, by their ids, the vertices and, for second order, faces and edges

  Note:
  Edges and faces are points only where nodes sit on them. With first-order elements no nodes do, and to make these
  points would take half of the time before the first unknown.
@*/
PetscErrorCode RootTopologyCreate(MPI_Comm comm, int dim, int order, const RootMesh *root, DM *dm)
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

    for (int i = 0; i < element->corners; i++)
      cone[i] = n_cells + root->vertex[root->id[RootMeshCellNodes(root, c)[PlexCorner(element->type, i)]]];
    PetscCall(DMPlexSetCone(cells, c, cone));
    PetscCall(DMPlexSetCellType(cells, c, CellPolytope(element->type)));
  }
  for (PetscInt v = n_cells; v < n_points; v++) PetscCall(DMPlexSetCellType(cells, v, DM_POLYTOPE_POINT));
  PetscCall(DMPlexSymmetrize(cells));
  PetscCall(DMPlexStratify(cells));
  if (order > 1) {
    PetscCall(DMPlexInterpolate(cells, dm));
    PetscCall(DMDestroy(&cells));
  } else
    *dm = cells;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates a section with dim values on each vertex. */
static PetscErrorCode SetCoordinateSection(PetscSection section, PetscInt start, PetscInt end, int dim)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSectionSetNumFields(section, 1));
  PetscCall(PetscSectionSetFieldComponents(section, 0, dim));
  PetscCall(PetscSectionSetChart(section, start, end));
  for (PetscInt v = start; v < end; v++) {
    PetscCall(PetscSectionSetDof(section, v, dim));
    PetscCall(PetscSectionSetFieldDof(section, v, 0, dim));
  }
  PetscCall(PetscSectionSetUp(section));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RootTopologySetCoordinates - sets the vertices' coordinates of the DM, for viewers only.

  Collective

  Input Parameters:
+ dm   - from RootTopologyCreate()
. dim  - components
- root - on rank 0; NULL on other ranks
@*/
PetscErrorCode RootTopologySetCoordinates(DM dm, int dim, const RootMesh *root)
{
  PetscSection section;
  Vec          coordinates;
  PetscScalar *x;
  PetscInt     start, end, n_nodes = root ? root->n_nodes : 0;

  PetscFunctionBeginUser;
  PetscCall(DMSetCoordinateDim(dm, dim));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &start, &end));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(SetCoordinateSection(section, start, end, dim));
  PetscCall(VecCreate(PETSC_COMM_SELF, &coordinates));
  PetscCall(PetscObjectSetName((PetscObject)coordinates, "coordinates"));
  PetscCall(VecSetSizes(coordinates, (end - start) * dim, PETSC_DETERMINE));
  PetscCall(VecSetBlockSize(coordinates, dim));
  PetscCall(VecSetType(coordinates, VECSTANDARD));
  PetscCall(VecGetArray(coordinates, &x));
  for (PetscInt i = 0; i < n_nodes; i++) {
    for (int k = 0; k < dim && root->vertex[i] >= 0; k++)
      x[root->vertex[i] * dim + k] = root->gmsh.coords[3 * root->node[i] + k];
  }
  PetscCall(VecRestoreArray(coordinates, &x));
  PetscCall(DMSetCoordinatesLocal(dm, coordinates));
  PetscCall(VecDestroy(&coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the edge (depth 1) or face (depth 2) that has exactly these vertices in its closure; -1 if there is none. */
static PetscErrorCode FindPoint(DM dm, int depth, PetscInt n, const PetscInt vertices[], PetscInt *point)
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

/* Finds the Plex point of node k of cell c: a vertex, an edge or face by its corners, or the cell itself. */
static PetscErrorCode NodePoint(DM dm, const RootMesh *root, PetscInt c, int k, PetscInt *point)
{
  const Element  *element = root->cell_block[c]->element;
  const PetscInt *nodes   = RootMeshCellNodes(root, c);
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
  if (n) PetscCall(FindPoint(dm, depth, n, vertices, point));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Complains of two nodes on one point. This occurs where cells share an edge or face but not its middle node. */
static PetscErrorCode CheckPlaces(DM dm, const char *file, const RootMesh *root, Complaint *complaint)
{
  PetscInt end, *taken;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(dm, NULL, &end));
  PetscCall(PetscMalloc1(end, &taken));
  for (PetscInt p = 0; p < end; p++) taken[p] = -1;
  for (PetscInt i = 0; i < root->n_nodes; i++) {
    PetscInt *other = &taken[root->point[i]];

    if (*other >= 0) {
      Complain(complaint, "%s: nodes %" PetscInt_FMT " and %" PetscInt_FMT " are both the middle of one edge or face",
               file, root->gmsh.node_tag[root->node[*other]], root->gmsh.node_tag[root->node[i]]);
    }
    *other = i;
  }
  PetscCall(PetscFree(taken));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RootTopologyPlaceNodes - finds the Plex point of every node.

  Not collective, on rank 0

  Input Parameters:
+ dm   - from RootTopologyCreate()
- file - name of the mesh, for the complaint

  Output Parameters:
+ root      - point of each node is set
- complaint - cells that share an edge or face but not its middle node
@*/
PetscErrorCode RootTopologyPlaceNodes(DM dm, const char *file, RootMesh *root, Complaint *complaint)
{
  PetscInt start;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(dm, 0, &start, NULL));
  for (PetscInt i = 0; i < root->n_nodes; i++)
    if (root->vertex[i] >= 0) root->point[i] = start + root->vertex[i];
  for (PetscInt c = 0; c < root->n_cells; c++) {
    for (int k = 0; k < root->cell_block[c]->nodes; k++) {
      PetscInt *point = &root->point[root->id[RootMeshCellNodes(root, c)[k]]];

      if (*point < 0) PetscCall(NodePoint(dm, root, c, k, point));
      PetscCheck(*point >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "No Plex point for node %d of cell %" PetscInt_FMT, k,
                 c);
    }
  }
  PetscCall(CheckPlaces(dm, file, root, complaint));
  PetscFunctionReturn(PETSC_SUCCESS);
}
