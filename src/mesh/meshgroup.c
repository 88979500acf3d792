#include "mesh/meshgroup.h"
#include "base/refusal.h"
#include <string.h>

/* In two dimensions a body is still called a volume, its boundary a surface. */
static const char *DimensionName(int mesh_dim, int dim)
{
  if (dim == mesh_dim) return "volume";
  if (dim == mesh_dim - 1) return "surface";
  return dim == 1 ? "curve" : "point";
}

/*
  MeshGroupLabel - the DM's label of a group

  Not Collective

  Input Parameters:
+ mesh  - its dimension is read
- group - its name and dimension are read

  Output Parameter:
. label - its name; value 1 marks the points that carry the group's nodes
*/
void MeshGroupLabel(Mesh mesh, const MeshGroup *group, char label[MESH_TEXT])
{
  snprintf(label, MESH_TEXT, "%s %s", DimensionName(mesh->dim, group->dim), group->name);
}

/*
  MeshFindBody - a body of the scene by its name

  Not Collective

  Input Parameters:
+ scene - the scene
. name  - of the volume group, or of the tool's surface group
- rigid - whether a rigid tool is meant or a deformable body

  Returns its index, -1 if there is none.
*/
int MeshFindBody(Scene scene, const char *name, PetscBool rigid)
{
  for (int b = 0; b < scene->n_bodies; b++)
    if (!strcmp(scene->bodies[b].name, name) && !scene->bodies[b].rigid == !rigid) return b;
  return -1;
}

/*
  MeshFindGroup - a physical group by its name and dimension

  Not Collective

  Returns its index, -1 if the mesh has none.
*/
int MeshFindGroup(Mesh mesh, int dim, const char *name)
{
  for (int g = 0; g < mesh->n_groups; g++)
    if (mesh->groups[g].dim == dim && !strcmp(mesh->groups[g].name, name)) return g;
  return -1;
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

static void ListGroups(Mesh mesh, int dim, char list[MESH_TEXT])
{
  size_t used = 0;

  snprintf(list, MESH_TEXT, "none");
  for (int g = 0; g < mesh->n_groups && used < MESH_TEXT; g++)
    if (mesh->groups[g].dim <= dim)
      used += (size_t)snprintf(list + used, MESH_TEXT - used, "%s%s", used ? ", " : "", mesh->groups[g].name);
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
- dim   - largest dimension allowed: mesh->dim for volumes, mesh->dim - 1 for surfaces. Of groups of one name the one of
the largest dimension is taken.

  Output Parameter:
. found - belongs to the mesh. A rigid tool is returned too (not attached, without nodes and faces; see
MeshFindRigid()); any other group of which some elements do not lie on a body is refused.
*/
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

  for (int k = 0; k < face->nodes; k++)
    nodes[k] = mesh->cell_nodes[mesh->cell_ptr[cell] + element->face_nodes[group->face_number[f]][k]];
  return face->type;
}
