/* Outer faces of bodies as groups, see rootskins.h. */
#include "rootskins.h"
#include "mesh/meshgroup.h"
#include <string.h>

/* Faces on the axis, or flat on a plane of symmetry, lie there within this part of the mesh's size: round-off of its
   coordinates. */
#define SKIN_FLAT 1e-6

/* Most faces of a cell. */
enum { SKIN_CELL_FACES = 6 };

/* Does a contact pair ask for the skin of a body? */
static PetscBool IsWanted(Scene scene, int body, char name[MESH_TEXT])
{
  if (scene->bodies[body].rigid) return PETSC_FALSE;
  SceneBodySkin(&scene->bodies[body], name, MESH_TEXT);
  for (int c = 0; c < scene->n_contacts; c++)
    if (scene->contacts[c].listed &&
        (!strcmp(scene->contacts[c].slave, name) || SceneContactHasMaster(&scene->contacts[c], name)))
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/*@
  RootSkinsCount - counts the skins that contact pairs ask for.

  Not collective

  Input Parameter:
. scene - the scene
@*/
int RootSkinsCount(Scene scene)
{
  char name[MESH_TEXT];
  int  n = 0;

  for (int b = 0; b < scene->n_bodies; b++) n += IsWanted(scene, b, name);
  return n;
}

/*@
  RootSkinsShare - names the groups of the skins.

  Not collective

  Input Parameters:
+ scene - the scene
- first - number of the first of these groups

  Output Parameter:
. mesh - dimension and name of these groups are set
@*/
PetscErrorCode RootSkinsShare(Scene scene, Mesh mesh, int first)
{
  char name[MESH_TEXT];

  PetscFunctionBeginUser;
  for (int b = 0; b < scene->n_bodies; b++) {
    if (!IsWanted(scene, b, name)) continue;
    mesh->groups[first].dim = scene->dim - 1;
    PetscCall(PetscStrallocpy(name, &mesh->groups[first++].name));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The one component of the displacement that supports fix on a group all the time; -1: none, or several. */
static int SlidingComponent(Scene scene, const MeshGroup *group)
{
  int fixed[3] = {0, 0, 0}, found = -1;

  for (int s = 0; s < scene->n_supports; s++)
    for (int d = 0; d < 3 && !strcmp(scene->supports[s].surface, group->name); d++)
      fixed[d] = fixed[d] || (scene->supports[s].fixed[d] && !scene->supports[s].during.some);
  for (int d = 0; d < 3; d++) {
    if (!fixed[d]) continue;
    if (found >= 0) return -1;
    found = d;
  }
  return found;
}

/* Range of a coordinate over the corners of a face of a cell. */
static void FaceRange(const RootMesh *root, PetscInt cell, int number, int d, PetscReal range[2])
{
  const Element  *element = root->cell_block[cell]->element;
  const PetscInt *nodes   = RootMeshCellNodes(root, cell);

  range[0] = PETSC_MAX_REAL;
  range[1] = PETSC_MIN_REAL;
  for (int k = 0; k < ElementGet((ElementType)element->face_type)->corners; k++) {
    const PetscReal x = root->gmsh.coords[3 * nodes[element->face_nodes[number][k]] + d];

    range[0] = PetscMin(range[0], x);
    range[1] = PetscMax(range[1], x);
  }
}

/* Marks the faces on planes of symmetry: flat, normal to an axis, and held along it alone. */
static void MarkSymmetry(Scene scene, const RootMesh *root, Mesh mesh, PetscBool *inner)
{
  for (PetscInt f = 0; f < root->n_faces; f++) {
    const RootFace *face = &root->faces[f];
    const int       d    = SlidingComponent(scene, &mesh->groups[face->group]);
    PetscReal       range[2];

    if (d < 0) continue;
    FaceRange(root, face->cell, face->number, d, range);
    if (range[1] - range[0] <= SKIN_FLAT * mesh->size) inner[SKIN_CELL_FACES * face->cell + face->number] = PETSC_TRUE;
  }
}

/* Marks the faces between two cells, and those on the axis. */
static void MarkInner(Scene scene, const RootMesh *root, Mesh mesh, PetscBool *inner)
{
  const CellFace *end = root->cell_faces + root->corner_faces[root->n_vertices];

  for (const CellFace *face = root->cell_faces; face < end; face++) {
    const CellFace *others[] = {face - 1, face + 1};
    PetscReal       range[2];
    PetscBool      *mark = &inner[SKIN_CELL_FACES * face->cell + face->number];

    for (int k = 0; k < 2; k++)
      if (others[k] >= root->cell_faces && others[k] < end &&
          !memcmp(others[k]->corner, face->corner, sizeof(face->corner)))
        *mark = PETSC_TRUE;
    if (scene->geometry != GEOMETRY_AXISYMMETRIC) continue;
    FaceRange(root, face->cell, face->number, 0, range);
    if (range[1] <= SKIN_FLAT * mesh->size) *mark = PETSC_TRUE;
  }
}

/* Adds a face to a skin, and marks its nodes. */
static void AddFace(RootMesh *root, const RootFace *face)
{
  const Element  *element = root->cell_block[face->cell]->element;
  const PetscInt *nodes   = RootMeshCellNodes(root, face->cell);

  root->faces[root->n_faces++] = *face;
  for (int k = 0; k < ElementGet((ElementType)element->face_type)->nodes; k++)
    RootMeshMark(root, (int)face->group, root->id[nodes[element->face_nodes[face->number][k]]]);
}

/*@
  RootSkinsAdd - adds the outer faces of bodies to the groups' faces, and marks their nodes.

  Not collective, on rank 0

  Input Parameters:
+ scene - the scene
. mesh  - its size and its groups; the numbers of elements of the skins are set
- first - number of the first skin

  Input/Output Parameter:
. root - its faces, not sorted yet

  Note:
  The tags of these faces follow on the largest one of an element in the file, in the order of the cells.
@*/
PetscErrorCode RootSkinsAdd(Scene scene, RootMesh *root, Mesh mesh, int first)
{
  PetscBool *inner;
  PetscInt   tag = 0;

  PetscFunctionBeginUser;
  if (first == mesh->n_groups) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(SKIN_CELL_FACES * root->n_cells, &inner));
  MarkSymmetry(scene, root, mesh, inner);
  MarkInner(scene, root, mesh, inner);
  for (int b = 0; b < root->gmsh.n_blocks; b++)
    for (PetscInt i = 0; i < root->gmsh.blocks[b].n; i++) tag = PetscMax(tag, root->gmsh.blocks[b].tag[i]);
  PetscCall(PetscRealloc((root->n_faces + SKIN_CELL_FACES * root->n_cells) * sizeof(RootFace), &root->faces));
  for (int g = first; g < mesh->n_groups; g++) {
    char name[MESH_TEXT];

    for (PetscInt c = 0; c < root->n_cells; c++) {
      SceneBodySkin(&scene->bodies[root->cell_body[c]], name, sizeof(name));
      for (int k = 0; k < root->cell_block[c]->element->faces && !strcmp(name, mesh->groups[g].name); k++) {
        const RootFace face = {.cell = c, .group = g, .tag = tag + 1, .number = k};

        if (inner[SKIN_CELL_FACES * c + k]) continue;
        AddFace(root, &face);
        mesh->groups[g].n_elements++;
        tag++;
      }
    }
  }
  PetscCall(PetscFree(inner));
  PetscFunctionReturn(PETSC_SUCCESS);
}
