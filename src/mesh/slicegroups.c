/* Physical groups before distribution: faces, marked nodes and the checks of how the scene uses groups. */
#include "slicegroups.h"
#include "cellfaces.h"
#include "slicejoins.h"
#include "sliceroles.h"
#include "sliceskins.h"
#include "mesh/meshgroup.h"
#include "base/exchange.h"
#include <stdlib.h>
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
  SliceGroupsShare - makes mesh->groups on all ranks, without nodes and faces.

  Collective

  Input Parameters:
+ scene - its contact pairs may ask for the skins of bodies, which are the last groups
. mesh  - its groups are set
- slice - after SliceRead()
@*/
PetscErrorCode SliceGroupsShare(Scene scene, Mesh mesh, const SliceMesh *slice)
{
  const GmshMesh *gmsh = &slice->gmsh;

  PetscFunctionBeginUser;
  mesh->n_groups = gmsh->n_physicals + SliceSkinsCount(scene);
  PetscCall(PetscCalloc1(mesh->n_groups, &mesh->groups));
  PetscCall(SliceSkinsShare(scene, mesh, gmsh->n_physicals));
  for (int g = 0; g < gmsh->n_physicals; g++)
    PetscCall(ShareGroup(mesh, slice->rank ? NULL : &gmsh->physicals[g], &mesh->groups[g]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Faces of groups */

/* An element of a surface on its way to where the cells of its face are known */
typedef struct {
  PetscInt corner[CELL_FACE_CORNERS], group, tag, order;
} SurfaceElement;

/* The elements of lower dimension of this rank's part of the file, once for each of their groups. */
typedef struct {
  const SliceMesh *slice;
  PetscInt         n, *item, *order;
  int             *block, *group;
} GroupElements;

/* Lists the elements of the groups of one dimension, or those of lower ones. They are numbered in the order of the
   file's blocks, of a block's groups and of its elements. */
static PetscErrorCode ListElements(const SliceMesh *slice, int dim, PetscBool lower, GroupElements *list)
{
  const GmshMesh *gmsh = &slice->gmsh;
  PetscInt        n = 0, before = 0, *first;

  PetscFunctionBeginUser;
  *list = (GroupElements){.slice = slice};
  PetscCall(PetscMalloc1(gmsh->n_blocks, &first));
  for (int b = 0; b < gmsh->n_blocks; b++) {
    first[b] = gmsh->blocks[b].n;
    n += gmsh->blocks[b].n * gmsh->blocks[b].n_physicals;
  }
  PetscCallMPI(MPI_Scan(MPI_IN_PLACE, first, gmsh->n_blocks, MPIU_INT, MPI_SUM, slice->comm));
  PetscCall(PetscMalloc4(n, &list->item, n, &list->order, n, &list->block, n, &list->group));
  for (int b = 0; b < gmsh->n_blocks; b++) {
    const GmshBlock *block = &gmsh->blocks[b];

    for (int i = 0; i < block->n_physicals; i++, before += block->n_all) {
      if (lower ? block->dim >= dim : block->dim != dim) continue;
      for (PetscInt item = 0; item < block->n; item++, list->n++) {
        list->item[list->n]  = item;
        list->order[list->n] = before + first[b] - block->n + item;
        list->block[list->n] = b;
        list->group[list->n] = block->physical[i];
      }
    }
  }
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeElements(GroupElements *list)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(list->item, list->order, list->block, list->group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ids of the nodes of an element in the list. */
static const PetscInt *ElementIds(const GroupElements *list, PetscInt i)
{
  return list->slice->element_ids[list->block[i]] + list->item[i] * list->slice->gmsh.blocks[list->block[i]].nodes;
}

/* Whether the element has a node that no cell uses. */
static PetscBool IsLoose(const GroupElements *list, PetscInt i)
{
  for (int k = 0; k < list->slice->gmsh.blocks[list->block[i]].nodes; k++)
    if (ElementIds(list, i)[k] < 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

static void PackSurface(const void *context, PetscInt i, void *packed)
{
  const GroupElements *list    = context;
  const GmshBlock     *block   = &list->slice->gmsh.blocks[list->block[i]];
  SurfaceElement      *element = packed;

  CellFacesSortCorners(block->element ? block->element->corners : 1, ElementIds(list, i), element->corner);
  element->group = list->group[i];
  element->tag   = block->tag[list->item[i]];
  element->order = list->order[i];
}

/* Sends the elements of surfaces to the ranks that know the faces with their lowest corners. Counts those that lie on
 * no body. */
static PetscErrorCode SendSurfaces(Scene scene, const SliceMesh *slice, Mesh mesh, PetscInt *n,
                                   SurfaceElement **elements)
{
  GroupElements list;
  PetscMPIInt  *to;

  PetscFunctionBeginUser;
  PetscCall(ListElements(slice, scene->dim - 1, PETSC_FALSE, &list));
  PetscCall(PetscMalloc1(list.n, &to));
  for (PetscInt i = 0; i < list.n; i++) {
    SurfaceElement element;

    to[i] = -1;
    if (IsLoose(&list, i)) {
      mesh->groups[list.group[i]].n_loose++;
      continue;
    }
    PackSurface(&list, i, &element);
    to[i] = SliceMeshRankOf(slice, slice->face_start, element.corner[0]);
  }
  PetscCall(ExchangeRecords(slice->comm, sizeof(SurfaceElement), list.n, to, PackSurface, &list, n, (void **)elements));
  PetscCall(PetscFree(to));
  PetscCall(FreeElements(&list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Complains of the first element of a rigid tool that is a face of a body. order: its place, or PETSC_MAX_INT */
static PetscErrorCode ComplainRigid(Scene scene, const char *file, const SliceMesh *slice, Mesh mesh, PetscInt order,
                                    PetscInt tag, int group, Complaint *complaint)
{
  const char *name  = group < 0 ? NULL : mesh->groups[group].name;
  PetscInt    first = order;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPIU_INT, MPI_MIN, slice->comm));
  if (name && first == order)
    Complain(complaint,
             "%s: element %" PetscInt_FMT
             " of the rigid surface '%s' is a face of a deformable body in '%s'; a rigid tool has a mesh of its own",
             SceneWhere(scene, scene->bodies[MeshFindBody(scene, name, PETSC_TRUE)].path, "surface"), tag, name, file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the faces of the surfaces' elements, of two cells the one with the lower id: faces, with room for n. */
static PetscErrorCode FindFaces(Scene scene, const char *file, SliceMesh *slice, Mesh mesh, PetscInt n,
                                const SurfaceElement elements[], PetscInt *n_faces, SliceFace faces[],
                                Complaint *complaint)
{
  PetscInt order = PETSC_MAX_INT, tag = 0;
  int      rigid = -1;

  PetscFunctionBeginUser;
  *n_faces = 0;
  for (PetscInt i = 0; i < n; i++) {
    const SurfaceElement *element = &elements[i];
    const CellFace       *found;
    MeshGroup            *group    = &mesh->groups[element->group];
    const PetscBool       is_rigid = IsRigidGroup(scene, group->dim, group->name);
    const PetscInt        n_cells  = CellFacesFind(slice, element->corner, &found);

    if (!n_cells)
      group->n_loose++;
    else if (is_rigid && element->order < order) {
      order = element->order;
      tag   = element->tag;
      rigid = (int)element->group;
    } else if (!is_rigid) {
      slice->interior[element->group] += n_cells > 1;
      faces[(*n_faces)++] = (SliceFace){.cell   = found->cell,
                                        .group  = element->group,
                                        .tag    = element->tag,
                                        .order  = element->order,
                                        .number = found->number};
    }
  }
  PetscCall(ComplainRigid(scene, file, slice, mesh, order, tag, rigid, complaint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the slices the faces of their cells. */
static PetscErrorCode CollectFaces(Scene scene, const char *file, SliceMesh *slice, Mesh mesh, Complaint *complaint)
{
  PetscInt        n, n_faces;
  SurfaceElement *elements;
  SliceFace      *faces;
  PetscMPIInt    *to;

  PetscFunctionBeginUser;
  PetscCall(SendSurfaces(scene, slice, mesh, &n, &elements));
  PetscCall(PetscMalloc2(n, &faces, n, &to));
  PetscCall(FindFaces(scene, file, slice, mesh, n, elements, &n_faces, faces, complaint));
  PetscCall(PetscFree(elements));
  for (PetscInt f = 0; f < n_faces; f++) to[f] = SliceMeshRankOf(slice, slice->cell_start, faces[f].cell);
  PetscCall(ExchangeRecords(slice->comm, sizeof(SliceFace), n_faces, to, SliceMeshPackFace, faces, &slice->n_faces,
                            (void **)&slice->faces));
  PetscCall(PetscFree2(faces, to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int CompareFaces(const void *a, const void *b)
{
  const SliceFace *p = a, *q = b;

  if (p->cell != q->cell) return p->cell < q->cell ? -1 : 1;
  return (p->order > q->order) - (p->order < q->order);
}

/* Sorts the faces by cell, and those of a cell in the order of the file. */
static PetscErrorCode SortFaces(SliceMesh *slice)
{
  PetscFunctionBeginUser;
  if (slice->n_faces) qsort(slice->faces, (size_t)slice->n_faces, sizeof(SliceFace), CompareFaces);
  PetscCall(PetscCalloc1(slice->n_cells + 1, &slice->face_ptr));
  for (PetscInt f = 0; f < slice->n_faces; f++)
    slice->face_ptr[slice->faces[f].cell - slice->cell_start[slice->rank] + 1]++;
  for (PetscInt c = 0; c < slice->n_cells; c++) slice->face_ptr[c + 1] += slice->face_ptr[c];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks of nodes */

/* Says that a node is on a group. */
static void Mark(int *marks, PetscInt n, int group, PetscInt i)
{
  marks[group / SLICE_MARKS * n + i] |= 1 << group % SLICE_MARKS;
}

/* A node of an element on a curve or point */
typedef struct {
  PetscInt id, group;
} GroupNode;

/* Packs node i % ELEMENT_MAX_NODES of an element. */
static void PackGroupNode(const void *context, PetscInt i, void *packed)
{
  const GroupElements *list = context;
  GroupNode           *node = packed;

  node->id    = ElementIds(list, i / ELEMENT_MAX_NODES)[i % ELEMENT_MAX_NODES];
  node->group = list->group[i / ELEMENT_MAX_NODES];
}

/* Marks the nodes of groups of lower dimension than surfaces at their homes, and counts their elements that lie on no
   body. */
static PetscErrorCode MarkLower(Scene scene, SliceMesh *slice, Mesh mesh)
{
  GroupElements list;
  GroupNode    *nodes;
  PetscInt      n;
  PetscMPIInt  *to;

  PetscFunctionBeginUser;
  PetscCall(ListElements(slice, scene->dim - 1, PETSC_TRUE, &list));
  PetscCall(PetscMalloc1(list.n * ELEMENT_MAX_NODES, &to));
  for (PetscInt i = 0; i < list.n; i++) {
    const PetscBool loose = IsLoose(&list, i);

    mesh->groups[list.group[i]].n_loose += loose;
    for (int k = 0; k < ELEMENT_MAX_NODES; k++)
      to[i * ELEMENT_MAX_NODES + k] = loose || k >= slice->gmsh.blocks[list.block[i]].nodes
                                        ? -1
                                        : SliceMeshRankOf(slice, slice->home_start, ElementIds(&list, i)[k]);
  }
  PetscCall(ExchangeRecords(slice->comm, sizeof(GroupNode), list.n * ELEMENT_MAX_NODES, to, PackGroupNode, &list, &n,
                            (void **)&nodes));
  for (PetscInt i = 0; i < n; i++)
    Mark(slice->marks, slice->n_homes, (int)nodes[i].group, nodes[i].id - slice->home_start[slice->rank]);
  PetscCall(PetscFree(nodes));
  PetscCall(PetscFree(to));
  PetscCall(FreeElements(&list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the nodes of the slice's cells that are on volumes and surfaces. */
static void MarkCells(const SliceMesh *slice, int *marks)
{
  for (PetscInt c = 0; c < slice->n_cells; c++) {
    const GmshBlock *block = slice->cell_block[c];
    const PetscInt  *nodes = SliceMeshCellNodes(slice, c);

    for (int i = 0; i < block->n_physicals; i++)
      for (int k = 0; k < block->nodes; k++) Mark(marks, slice->n_nodes, block->physical[i], nodes[k]);
    for (PetscInt f = slice->face_ptr[c]; f < slice->face_ptr[c + 1]; f++)
      for (int k = 0; k < ElementGet((ElementType)block->element->face_type)->nodes; k++)
        Mark(marks, slice->n_nodes, (int)slice->faces[f].group,
             nodes[block->element->face_nodes[slice->faces[f].number][k]]);
  }
}

/* Brings the marks of all slices together at the homes of the nodes. */
static PetscErrorCode MarkHomes(Scene scene, SliceMesh *slice, Mesh mesh)
{
  const int words = (mesh->n_groups + SLICE_MARKS - 1) / SLICE_MARKS;
  int      *marks;
  PetscSF   homes;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(words * slice->n_homes, &slice->marks));
  PetscCall(MarkLower(scene, slice, mesh));
  PetscCall(PetscCalloc1(words * slice->n_nodes, &marks));
  MarkCells(slice, marks);
  PetscCall(SliceMeshSF(slice, slice->home_start, slice->n_nodes, slice->id, &homes));
  for (int w = 0; w < words; w++) {
    PetscCall(
      PetscSFReduceBegin(homes, MPI_INT, marks + w * slice->n_nodes, slice->marks + w * slice->n_homes, MPI_BOR));
    PetscCall(PetscSFReduceEnd(homes, MPI_INT, marks + w * slice->n_nodes, slice->marks + w * slice->n_homes, MPI_BOR));
  }
  PetscCall(PetscSFDestroy(&homes));
  PetscCall(PetscFree(marks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds up what the ranks have counted of the groups, and sets which groups lie on bodies. */
static PetscErrorCode CountElements(Scene scene, SliceMesh *slice, Mesh mesh)
{
  PetscInt *loose;

  PetscFunctionBeginUser;
  for (int b = 0; b < slice->gmsh.n_blocks; b++)
    for (int i = 0; i < slice->gmsh.blocks[b].n_physicals; i++)
      mesh->groups[slice->gmsh.blocks[b].physical[i]].n_elements += slice->gmsh.blocks[b].n_all;
  PetscCall(PetscMalloc1(mesh->n_groups, &loose));
  for (int g = 0; g < mesh->n_groups; g++)
    loose[g] = IsRigidGroup(scene, mesh->groups[g].dim, mesh->groups[g].name) ? 0 : mesh->groups[g].n_loose;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, loose, mesh->n_groups, MPIU_INT, MPI_SUM, slice->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, slice->interior, mesh->n_groups, MPIU_INT, MPI_SUM, slice->comm));
  for (int g = 0; g < mesh->n_groups; g++) {
    MeshGroup *group = &mesh->groups[g];

    group->n_loose  = loose[g];
    group->attached = group->n_loose || IsRigidGroup(scene, group->dim, group->name) ? PETSC_FALSE : PETSC_TRUE;
  }
  PetscCall(PetscFree(loose));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceGroupsFind - finds the groups' faces, sorted by cell, and marks their nodes.

  Collective

  Input Parameters:
+ scene - says which groups are rigid tools; its lists have surfaces joined where the mesh shows that they must be
. file  - name of the mesh, for the complaint
- slice - after CellFacesCreate()

  Output Parameters:
+ slice     - its faces and marks are set
. mesh      - n_elements, n_loose and attached of its groups are set
- complaint - a rigid tool that shares faces with a body, on one rank
@*/
PetscErrorCode SliceGroupsFind(Scene scene, const char *file, SliceMesh *slice, Mesh mesh, Complaint *complaint)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_groups, &slice->interior));
  PetscCall(CollectFaces(scene, file, slice, mesh, complaint));
  PetscCall(SliceSkinsAdd(scene, slice, mesh, slice->gmsh.n_physicals));
  PetscCall(SliceJoinsAdd(scene, slice, mesh));
  PetscCall(SliceRolesChoose(scene, slice, mesh));
  PetscCall(SortFaces(slice));
  PetscCall(MarkHomes(scene, slice, mesh));
  PetscCall(CountElements(scene, slice, mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks of how the scene uses groups */

/* Complains if a surface that the scene loads or brings into contact is not on the boundary. */
static void CheckBoundary(Scene scene, const SliceMesh *slice, Mesh mesh, const char *path, const char *key,
                          const char *name, Complaint *complaint)
{
  const int g = name ? MeshFindGroup(mesh, scene->dim - 1, name) : -1;

  if (g >= 0 && slice->interior[g]) {
    Complain(complaint,
             "%s: %" PetscInt_FMT " of the %" PetscInt_FMT
             " faces of '%s' lie between two cells; allowed: a surface on the boundary",
             SceneWhere(scene, path, key), slice->interior[g], mesh->groups[g].n_elements, name);
  }
}

/*@
  SliceGroupsCheckUses - checks that surfaces which the scene loads or brings into contact are on the boundary.

  Not collective

  Input Parameters:
+ scene - its pressures, tractions and contact pairs are checked; supports and probes may be anywhere
. slice - after SliceGroupsFind()
- mesh  - names of the groups

  Output Parameter:
. complaint - the first surface that has faces between two cells
@*/
void SliceGroupsCheckUses(Scene scene, const SliceMesh *slice, Mesh mesh, Complaint *complaint)
{
  for (int i = 0; i < scene->n_loads; i++) {
    const SceneLoad *load = &scene->loads[i];

    if (load->kind == LOAD_PRESSURE || load->kind == LOAD_TRACTION)
      CheckBoundary(scene, slice, mesh, load->path, "surface", load->region, complaint);
  }
  for (int i = 0; i < scene->n_contacts; i++) {
    CheckBoundary(scene, slice, mesh, scene->contacts[i].path, "slave", scene->contacts[i].slave, complaint);
    if (scene->contacts[i].master)
      CheckBoundary(scene, slice, mesh, scene->contacts[i].path, "master", scene->contacts[i].master, complaint);
  }
}

/*@
  SliceGroupsContactCells - finds the cells with a face in contact, for the partition.

  Not collective

  Input Parameters:
+ scene - its contact pairs
. slice - after SliceGroupsFind()
- mesh  - names of the groups

  Output Parameter:
. contact - for each cell of the slice; to be freed with PetscFree()
@*/
PetscErrorCode SliceGroupsContactCells(Scene scene, const SliceMesh *slice, Mesh mesh, PetscBool **contact)
{
  PetscBool *in_contact;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(slice->n_cells, contact));
  PetscCall(PetscCalloc1(mesh->n_groups, &in_contact));
  for (int i = 0; i < scene->n_contacts; i++) {
    const char *const names[] = {scene->contacts[i].slave, scene->contacts[i].master};

    for (int k = 0; k < 2; k++) {
      const int g = names[k] ? MeshFindGroup(mesh, scene->dim - 1, names[k]) : -1;

      if (g >= 0) in_contact[g] = PETSC_TRUE;
    }
  }
  for (PetscInt f = 0; f < slice->n_faces; f++)
    if (in_contact[slice->faces[f].group])
      (*contact)[slice->faces[f].cell - slice->cell_start[slice->rank]] = PETSC_TRUE;
  PetscCall(PetscFree(in_contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}
