/* Access to physical groups, rigid tools and bodies by their names. */
#include "mesh/meshgroup.h"
#include "base/refusal.h"
#include <string.h>

/* Returns the word for a dimension. In two dimensions a body is still called a volume and its boundary a surface. */
static const char *DimensionName(int mesh_dim, int dim)
{
  if (dim == mesh_dim) return "volume";
  if (dim == mesh_dim - 1) return "surface";
  return dim == 1 ? "curve" : "point";
}

/*@
  MeshGroupLabel - returns the name of the DM's label that marks a group.

  Not collective

  Input Parameters:
+ mesh  - only its dimension is read
- group - only its name and dimension are read

  Output Parameter:
. label - name of the label

  Note:
  The label has the value 1 on the points of the group's nodes. Volumes have none.
@*/
void MeshGroupLabel(Mesh mesh, const MeshGroup *group, char label[MESH_TEXT])
{
  snprintf(label, MESH_TEXT, "%s %s", DimensionName(mesh->dim, group->dim), group->name);
}

/*@
  MeshGroupsMeet - tells whether two groups have a node in common.

  Collective

  Input Parameters:
+ mesh - the mesh
. a    - a group; NULL: it has no nodes
- b    - likewise

  Output Parameter:
. meet - the same on all ranks
@*/
PetscErrorCode MeshGroupsMeet(Mesh mesh, const MeshGroup *a, const MeshGroup *b, PetscBool *meet)
{
  PetscFunctionBeginUser;
  *meet = PETSC_FALSE;
  for (PetscInt i = 0, j = 0; a && b && !*meet && i < a->n_nodes && j < b->n_nodes;) {
    *meet = (PetscBool)(a->nodes[i] == b->nodes[j]);
    if (a->nodes[i] < b->nodes[j])
      i++;
    else
      j++;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, meet, 1, MPIU_BOOL, MPI_LOR, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshFindBody - finds a body of the scene by its name.

  Not collective

  Input Parameters:
+ scene - the scene
. name  - name of the volume group, or of the tool's surface group
- rigid - PETSC_TRUE for a rigid tool, PETSC_FALSE for a deformable body

  Note:
  Returns the index into scene->bodies, -1 if there is none.
@*/
int MeshFindBody(Scene scene, const char *name, PetscBool rigid)
{
  for (int b = 0; b < scene->n_bodies; b++)
    if (!strcmp(scene->bodies[b].name, name) && !scene->bodies[b].rigid == !rigid) return b;
  return -1;
}

/*@
  MeshFindGroup - finds a physical group by its name and dimension.

  Not collective

  Input Parameters:
+ mesh - the mesh
. dim  - dimension of the group
- name - name of the group

  Note:
  Returns the index into mesh->groups, -1 if there is none.
@*/
int MeshFindGroup(Mesh mesh, int dim, const char *name)
{
  for (int g = 0; g < mesh->n_groups; g++)
    if (mesh->groups[g].dim == dim && !strcmp(mesh->groups[g].name, name)) return g;
  return -1;
}

/*@
  MeshFindRigid - finds a meshed rigid tool by the name of its surface group.

  Not collective

  Input Parameters:
+ mesh - the mesh
- name - name of the surface group

  Note:
  Returns NULL if there is no such tool.
@*/
MeshRigid *MeshFindRigid(Mesh mesh, const char *name)
{
  for (int r = 0; r < mesh->n_rigid; r++)
    if (!strcmp(mesh->rigid[r].name, name)) return &mesh->rigid[r];
  return NULL;
}

static void ListGroups(Mesh mesh, int dim, char list[MESH_TEXT])
{
  size_t used = 0;

  snprintf(list, MESH_TEXT, "none");
  for (int g = 0; g < mesh->n_groups && used < MESH_TEXT; g++)
    if (mesh->groups[g].dim <= dim)
      used += (size_t)snprintf(list + used, MESH_TEXT - used, "%s%s", used ? ", " : "", mesh->groups[g].name);
}

/*@
  MeshGetGroup - finds a physical group by its name, or refuses.

  Collective

  Input Parameters:
+ mesh  - the mesh
. scene - with path and key: the place in the scene file that names the group, for the refusal
. path  - for example "contact.0"
. key   - for example "slave"
. name  - name of the group
- dim   - largest dimension allowed: mesh->dim for volumes, mesh->dim - 1 for surfaces

  Output Parameter:
. found - belongs to the mesh

  Note:
  Of several groups with the name, the one of the largest dimension is returned. The refusal says which groups there
  are. A rigid tool is returned too; it is not attached and has no nodes and faces, see MeshFindRigid(). Any other group
  is refused if some of its elements do not lie on a body, and each that has no elements: gmsh writes the names of
  groups without entities, too.
@*/
PetscErrorCode MeshGetGroup(Mesh mesh, Scene scene, const char *path, const char *key, const char *name, int dim,
                            MeshGroup **found)
{
  char list[MESH_TEXT];
  int  g = -1, higher = -1;

  PetscFunctionBeginUser;
  *found = NULL;
  for (int d = dim; d >= 0 && g < 0; d--) g = MeshFindGroup(mesh, d, name);
  for (int d = dim + 1; d <= mesh->dim && higher < 0; d++) higher = MeshFindGroup(mesh, d, name);
  ListGroups(mesh, dim, list);
  if (g < 0 && higher >= 0) {
    PetscCall(RefuseInput(mesh->comm, "%s: '%s' is a %s; a %s is needed: %s", SceneWhere(scene, path, key), name,
                          DimensionName(mesh->dim, mesh->groups[higher].dim), DimensionName(mesh->dim, dim), list));
  }
  if (g < 0)
    PetscCall(RefuseInput(mesh->comm, "%s: the mesh has no %s '%s'; it has: %s", SceneWhere(scene, path, key),
                          DimensionName(mesh->dim, dim), name, list));
  if (!mesh->groups[g].n_elements)
    PetscCall(RefuseInput(mesh->comm, "%s: '%s' has no elements in the mesh; a %s with some is needed: %s",
                          SceneWhere(scene, path, key), name, DimensionName(mesh->dim, dim), list));
  if (mesh->groups[g].n_loose) {
    PetscCall(RefuseInput(
      mesh->comm,
      "%s: %" PetscInt_FMT " of the %" PetscInt_FMT
      " elements of '%s' do not lie on any body; a surface of its own is a rigid tool: list it in bodies with `rigid`",
      SceneWhere(scene, path, key), mesh->groups[g].n_loose, mesh->groups[g].n_elements, name));
  }
  *found = &mesh->groups[g];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshFaceNodes - returns the nodes of one face of a group.

  Not collective

  Input Parameters:
+ mesh  - the mesh
. group - of dimension mesh->dim - 1
- f     - 0 to group->n_faces - 1

  Output Parameter:
. nodes - local nodes in the order of the face's own element; the normal points out of the cell

  Note:
  Returns the face's element type.
@*/
ElementType MeshFaceNodes(Mesh mesh, const MeshGroup *group, PetscInt f, PetscInt nodes[FACE_MAX_NODES])
{
  const PetscInt cell    = group->face_cell[f];
  const Element *element = ElementGet(mesh->cell_type[cell]), *face = ElementGet((ElementType)element->face_type);

  for (int k = 0; k < face->nodes; k++)
    nodes[k] = mesh->cell_nodes[mesh->cell_ptr[cell] + element->face_nodes[group->face_number[f]][k]];
  return face->type;
}

/*@
  MeshAddNote - adds a line to what the first lines of a run say of the mesh.

  Not collective, for rank 0

  Input Parameters:
+ mesh - the mesh
- text - the line
@*/
PetscErrorCode MeshAddNote(Mesh mesh, const char *text)
{
  const size_t used = mesh->notes ? strlen(mesh->notes) : 0, more = strlen(text) + 2;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc(used + more, &mesh->notes));
  snprintf(mesh->notes + used, more, "%s\n", text);
  PetscFunctionReturn(PETSC_SUCCESS);
}
