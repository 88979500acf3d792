/* Physical groups before distribution: faces, marked nodes and the checks of how the scene uses groups. */
#include "rootgroups.h"
#include "cellfaces.h"
#include "rootskins.h"
#include "mesh/meshgroup.h"
#include <string.h>

static PetscBool IsRigidGroup(Scene scene, int dim, const char *name)
{
  return dim == scene->dim - 1 && MeshFindBody(scene, name, PETSC_TRUE) >= 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* Sends a group's name, tag and dimension from rank 0 to all ranks. */
static PetscErrorCode ShareGroup(Mesh mesh, const GmshPhysical *physical, MeshGroup *group)
{
  PetscInt    numbers[3] = {0, 0, 0};
  PetscMPIInt length;

  PetscFunctionBeginUser;
  if (physical) {
    numbers[0] = physical->dim;
    numbers[1] = physical->tag;
    numbers[2] = (PetscInt)strlen(physical->name) + 1;
  }
  PetscCallMPI(MPI_Bcast(numbers, 3, MPIU_INT, 0, mesh->comm));
  group->dim = (int)numbers[0];
  group->tag = numbers[1];
  PetscCall(PetscMPIIntCast(numbers[2], &length));
  PetscCall(PetscMalloc1(length, &group->name));
  if (physical) PetscCall(PetscArraycpy(group->name, physical->name, length));
  PetscCallMPI(MPI_Bcast(group->name, length, MPI_CHAR, 0, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RootGroupsShare - makes mesh->groups on all ranks, without nodes and faces.

  Collective

  Input Parameters:
+ scene - its contact pairs may ask for the skins of bodies, which are the last groups
. mesh  - its groups are set
- root  - on rank 0; NULL on other ranks
@*/
PetscErrorCode RootGroupsShare(Scene scene, Mesh mesh, const RootMesh *root)
{
  const int skins = RootSkinsCount(scene);

  PetscFunctionBeginUser;
  if (root) mesh->n_groups = root->gmsh.n_physicals;
  PetscCallMPI(MPI_Bcast(&mesh->n_groups, 1, MPI_INT, 0, mesh->comm));
  mesh->n_groups += skins;
  PetscCall(PetscCalloc1(mesh->n_groups, &mesh->groups));
  PetscCall(RootSkinsShare(scene, mesh, mesh->n_groups - skins));
  for (int g = 0; g < mesh->n_groups - skins; g++)
    PetscCall(ShareGroup(mesh, root ? &root->gmsh.physicals[g] : NULL, &mesh->groups[g]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Faces of groups */

/* Whether the element has a node that no cell uses. */
static PetscBool IsLoose(const RootMesh *root, const GmshBlock *block, PetscInt item)
{
  for (int k = 0; k < block->nodes; k++)
    if (root->id[block->connectivity[item * block->nodes + k]] < 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Finds the cell of which an element of dimension dim - 1 is a face; of two cells the one with the lower id. face->cell
   is -1 if there is none. interior: the face lies between two cells. */
static void FindFace(const RootMesh *root, const GmshBlock *block, PetscInt item, RootFace *face, PetscBool *interior)
{
  const PetscInt *nodes = &block->connectivity[item * block->nodes];
  const CellFace *found;
  PetscInt        vertices[CELL_FACE_CORNERS], n_cells;

  face->cell = -1;
  face->tag  = block->tag[item];
  *interior  = PETSC_FALSE;
  if (IsLoose(root, block, item)) return;
  for (int k = 0; k < block->element->corners; k++) vertices[k] = root->vertex[root->id[nodes[k]]];
  n_cells = CellFacesFind(root, block->element->corners, vertices, &found);
  if (!n_cells) return;
  face->cell   = found->cell;
  face->number = found->number;
  *interior    = n_cells > 1 ? PETSC_TRUE : PETSC_FALSE;
}

/* Adds one element of a deformable body's group: its face, if the group is a surface, and marks its nodes. Returns
   whether the element does not lie on a body. */
static PetscBool AddElement(RootMesh *root, const GmshBlock *block, PetscInt item, int g, PetscBool surface)
{
  RootFace  face     = {.group = g};
  PetscBool interior = PETSC_FALSE;

  if (surface) FindFace(root, block, item, &face, &interior);
  if (IsLoose(root, block, item) || (surface && face.cell < 0)) return PETSC_TRUE;
  if (surface) {
    root->faces[root->n_faces++] = face;
    root->interior[g] += interior;
  }
  for (int k = 0; k < block->nodes; k++) RootMeshMark(root, g, root->id[block->connectivity[item * block->nodes + k]]);
  return PETSC_FALSE;
}

/* Complains if an element of a rigid tool is a face of a body. */
static void CheckRigidBlock(Scene scene, const char *file, const RootMesh *root, const GmshBlock *block,
                            const char *name, Complaint *complaint)
{
  for (PetscInt item = 0; item < block->n; item++) {
    RootFace  face;
    PetscBool interior;

    FindFace(root, block, item, &face, &interior);
    if (face.cell < 0) continue;
    Complain(complaint,
             "%s: element %" PetscInt_FMT
             " of the rigid surface '%s' is a face of a deformable body in '%s'; a rigid tool has a mesh of its own",
             SceneWhere(scene, scene->bodies[MeshFindBody(scene, name, PETSC_TRUE)].path, "surface"), block->tag[item],
             name, file);
  }
}

/* Adds the elements of one block to one of its groups. */
static void AddCellBlock(Scene scene, RootMesh *root, const GmshBlock *block, int g, Mesh mesh)
{
  MeshGroup      *group   = &mesh->groups[g];
  const PetscBool surface = group->dim == scene->dim - 1 ? PETSC_TRUE : PETSC_FALSE;

  for (PetscInt item = 0; item < block->n; item++) group->n_loose += AddElement(root, block, item, g, surface);
}

/* Sorts the faces by cell; faces of one cell keep their order. */
static PetscErrorCode SortGroupFaces(RootMesh *root)
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

/*@
  RootGroupsFind - finds the groups' faces, sorted by cell, and marks their nodes.

  Not collective, on rank 0

  Input Parameters:
+ scene - says which groups are rigid tools
. file  - name of the mesh, for the complaint
- root  - after CellFacesCreate()

  Output Parameters:
+ root      - its faces and marks are set
. mesh      - the groups' numbers of elements are set, on rank 0 only
- complaint - a rigid tool that shares faces with a body
@*/
PetscErrorCode RootGroupsFind(Scene scene, const char *file, RootMesh *root, Mesh mesh, Complaint *complaint)
{
  const GmshMesh *gmsh      = &root->gmsh;
  PetscInt        max_faces = 0;

  PetscFunctionBeginUser;
  for (int b = 0; b < gmsh->n_blocks; b++)
    if (gmsh->blocks[b].dim == scene->dim - 1) max_faces += gmsh->blocks[b].n * gmsh->blocks[b].n_physicals;
  PetscCall(PetscMalloc1(max_faces, &root->faces));
  PetscCall(PetscCalloc1(mesh->n_groups, &root->interior));
  PetscCall(PetscCalloc1((mesh->n_groups + ROOT_MARKS - 1) / ROOT_MARKS * root->n_nodes, &root->marks));
  for (int b = 0; b < gmsh->n_blocks; b++) {
    const GmshBlock *block = &gmsh->blocks[b];

    for (int i = 0; i < block->n_physicals; i++) {
      MeshGroup *group = &mesh->groups[block->physical[i]];

      group->n_elements += block->n;
      if (IsRigidGroup(scene, group->dim, group->name))
        CheckRigidBlock(scene, file, root, block, group->name, complaint);
      else
        AddCellBlock(scene, root, block, block->physical[i], mesh);
    }
  }
  PetscCall(RootSkinsAdd(scene, root, mesh, gmsh->n_physicals));
  PetscCall(SortGroupFaces(root));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RootGroupsShareCounts - sends to all ranks what RootGroupsFind() counted, and sets which groups lie on bodies.

  Collective

  Input Parameters:
+ scene - says which groups are rigid tools
- mesh  - n_elements, n_loose and attached of its groups are set
@*/
PetscErrorCode RootGroupsShareCounts(Scene scene, Mesh mesh)
{
  PetscFunctionBeginUser;
  for (int g = 0; g < mesh->n_groups; g++) {
    MeshGroup *group    = &mesh->groups[g];
    PetscInt   count[2] = {group->n_elements, group->n_loose};

    PetscCallMPI(MPI_Bcast(count, 2, MPIU_INT, 0, mesh->comm));
    group->n_elements = count[0];
    group->n_loose    = count[1];
    group->attached   = group->n_loose || IsRigidGroup(scene, group->dim, group->name) ? PETSC_FALSE : PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks of how the scene uses groups */

/* Complains if a surface that the scene loads or brings into contact is not on the boundary. */
static void CheckBoundary(Scene scene, const RootMesh *root, Mesh mesh, const char *path, const char *key,
                          const char *name, Complaint *complaint)
{
  const int g = name ? MeshFindGroup(mesh, scene->dim - 1, name) : -1;

  if (g >= 0 && root->interior[g]) {
    Complain(complaint,
             "%s: %" PetscInt_FMT " of the %" PetscInt_FMT
             " faces of '%s' lie between two cells; allowed: a surface on the boundary",
             SceneWhere(scene, path, key), root->interior[g], mesh->groups[g].n_elements, name);
  }
}

/*@
  RootGroupsCheckUses - checks that surfaces which the scene loads or brings into contact are on the boundary.

  Not collective, on rank 0

  Input Parameters:
+ scene - its pressures, tractions and contact pairs are checked; supports and probes may be anywhere
. root  - after RootGroupsFind()
- mesh  - names of the groups

  Output Parameter:
. complaint - the first surface that has faces between two cells
@*/
void RootGroupsCheckUses(Scene scene, const RootMesh *root, Mesh mesh, Complaint *complaint)
{
  for (int i = 0; i < scene->n_loads; i++) {
    const SceneLoad *load = &scene->loads[i];

    if (load->kind == LOAD_PRESSURE || load->kind == LOAD_TRACTION)
      CheckBoundary(scene, root, mesh, load->path, "surface", load->region, complaint);
  }
  for (int i = 0; i < scene->n_contacts; i++) {
    CheckBoundary(scene, root, mesh, scene->contacts[i].path, "slave", scene->contacts[i].slave, complaint);
    if (scene->contacts[i].master)
      CheckBoundary(scene, root, mesh, scene->contacts[i].path, "master", scene->contacts[i].master, complaint);
  }
}

/*@
  RootGroupsContactCells - finds the cells with a face in contact, for the partition.

  Not collective, on rank 0

  Input Parameters:
+ scene - its contact pairs
. root  - after RootGroupsFind()
- mesh  - names of the groups

  Output Parameter:
. contact - for each cell; to be freed with PetscFree()
@*/
PetscErrorCode RootGroupsContactCells(Scene scene, const RootMesh *root, Mesh mesh, PetscBool **contact)
{
  PetscBool *in_contact;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(root->n_cells, contact));
  PetscCall(PetscCalloc1(mesh->n_groups, &in_contact));
  for (int i = 0; i < scene->n_contacts; i++) {
    const char *const names[] = {scene->contacts[i].slave, scene->contacts[i].master};

    for (int k = 0; k < 2; k++) {
      const int g = names[k] ? MeshFindGroup(mesh, scene->dim - 1, names[k]) : -1;

      if (g >= 0) in_contact[g] = PETSC_TRUE;
    }
  }
  for (PetscInt f = 0; f < root->n_faces; f++)
    if (in_contact[root->faces[f].group]) (*contact)[root->faces[f].cell] = PETSC_TRUE;
  PetscCall(PetscFree(in_contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}
