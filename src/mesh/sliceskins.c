/* Outer faces of bodies as groups, see sliceskins.h. */
#include "sliceskins.h"
#include "cellfaces.h"
#include "mesh/meshgroup.h"
#include "base/exchange.h"
#include <string.h>

/* Faces on the axis, or flat on a plane of symmetry, lie there within this part of the mesh's size: round-off of its
   coordinates. */
#define SKIN_FLAT 1e-6

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
  SliceSkinsCount - counts the skins that contact pairs ask for.

  Not collective

  Input Parameter:
. scene - the scene
@*/
int SliceSkinsCount(Scene scene)
{
  char name[MESH_TEXT];
  int  n = 0;

  for (int b = 0; b < scene->n_bodies; b++) n += IsWanted(scene, b, name);
  return n;
}

/*@
  SliceSkinsShare - names the groups of the skins.

  Not collective

  Input Parameters:
+ scene - the scene
- first - number of the first of these groups

  Output Parameter:
. mesh - dimension and name of these groups are set
@*/
PetscErrorCode SliceSkinsShare(Scene scene, Mesh mesh, int first)
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
static void FaceRange(const SliceMesh *slice, PetscInt cell, int number, int d, PetscReal range[2])
{
  const Element  *element = slice->cell_block[cell]->element;
  const PetscInt *nodes   = SliceMeshCellNodes(slice, cell);

  range[0] = PETSC_MAX_REAL;
  range[1] = PETSC_MIN_REAL;
  for (int k = 0; k < ElementGet((ElementType)element->face_type)->corners; k++) {
    const PetscReal x = slice->coords[3 * nodes[element->face_nodes[number][k]] + d];

    range[0] = PetscMin(range[0], x);
    range[1] = PetscMax(range[1], x);
  }
}

/* Marks the faces on planes of symmetry: flat, normal to an axis, and held along it alone. */
static void MarkSymmetry(Scene scene, const SliceMesh *slice, Mesh mesh, PetscBool *inner)
{
  for (PetscInt f = 0; f < slice->n_faces; f++) {
    const SliceFace *face = &slice->faces[f];
    const PetscInt   cell = face->cell - slice->cell_start[slice->rank];
    const int        d    = SlidingComponent(scene, &mesh->groups[face->group]);
    PetscReal        range[2];

    if (d < 0) continue;
    FaceRange(slice, cell, face->number, d, range);
    if (range[1] - range[0] <= SKIN_FLAT * mesh->size) inner[SLICE_CELL_FACES * cell + face->number] = PETSC_TRUE;
  }
}

/* A face of a cell between two cells */
typedef struct {
  PetscInt cell, number;
} InnerFace;

static void PackInner(const void *context, PetscInt i, void *packed)
{
  const CellFace *face  = &((const CellFace *)context)[i];
  InnerFace      *inner = packed;

  inner->cell   = face->cell;
  inner->number = face->number;
}

/* Marks the faces between two cells. */
static PetscErrorCode MarkShared(const SliceMesh *slice, PetscBool *inner)
{
  const PetscInt n_all = slice->corner_faces[slice->n_corners];
  PetscInt       n, same;
  PetscMPIInt   *to;
  InnerFace     *shared;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n_all, &to));
  for (PetscInt f = 0; f < n_all; f += same) {
    same = CellFacesSame(slice, &slice->cell_faces[f]);
    for (PetscInt k = f; k < f + same; k++)
      to[k] = same > 1 ? SliceMeshRankOf(slice, slice->cell_start, slice->cell_faces[k].cell) : -1;
  }
  PetscCall(
    ExchangeRecords(slice->comm, sizeof(InnerFace), n_all, to, PackInner, slice->cell_faces, &n, (void **)&shared));
  for (PetscInt i = 0; i < n; i++)
    inner[SLICE_CELL_FACES * (shared[i].cell - slice->cell_start[slice->rank]) + shared[i].number] = PETSC_TRUE;
  PetscCall(PetscFree(shared));
  PetscCall(PetscFree(to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the faces on the axis. */
static void MarkAxis(const SliceMesh *slice, PetscReal size, PetscBool *inner)
{
  PetscReal range[2];

  for (PetscInt c = 0; c < slice->n_cells; c++) {
    for (int k = 0; k < slice->cell_block[c]->element->faces; k++) {
      FaceRange(slice, c, k, 0, range);
      if (range[1] <= SKIN_FLAT * size) inner[SLICE_CELL_FACES * c + k] = PETSC_TRUE;
    }
  }
}

/* The largest tag of an element of all ranks. */
static PetscErrorCode LargestTag(const SliceMesh *slice, PetscInt *tag)
{
  PetscFunctionBeginUser;
  *tag = 0;
  for (PetscInt c = 0; c < slice->n_cells; c++) *tag = PetscMax(*tag, slice->cell_tag[c]);
  for (int b = 0; b < slice->gmsh.n_blocks; b++)
    for (PetscInt i = 0; i < slice->gmsh.blocks[b].n; i++) *tag = PetscMax(*tag, slice->gmsh.blocks[b].tag[i]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, tag, 1, MPIU_INT, MPI_MAX, slice->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the faces of one skin that are not inner ones. tag: the largest one so far */
static PetscErrorCode AddSkin(Scene scene, SliceMesh *slice, Mesh mesh, int g, const PetscBool *inner, PetscInt *tag)
{
  const PetscInt before = slice->n_faces;
  PetscInt       n, last;
  char           name[MESH_TEXT];

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < slice->n_cells; c++) {
    SceneBodySkin(&scene->bodies[slice->cell_body[c]], name, sizeof(name));
    for (int k = 0; k < slice->cell_block[c]->element->faces && !strcmp(name, mesh->groups[g].name); k++) {
      if (inner[SLICE_CELL_FACES * c + k]) continue;
      slice->faces[slice->n_faces++] = (SliceFace){.cell   = slice->cell_start[slice->rank] + c,
                                                   .group  = g,
                                                   .order  = PETSC_MAX_INT - SLICE_CELL_FACES + k, /* the last ones */
                                                   .number = k};
    }
  }
  n = slice->n_faces - before;
  PetscCallMPI(MPI_Scan(&n, &last, 1, MPIU_INT, MPI_SUM, slice->comm));
  for (PetscInt f = before; f < slice->n_faces; f++) slice->faces[f].tag = *tag + last - n + f - before + 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPIU_INT, MPI_SUM, slice->comm));
  mesh->groups[g].n_elements = n;
  *tag += n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceSkinsAdd - adds the outer faces of bodies to the groups' faces.

  Collective

  Input Parameters:
+ scene - the scene
. mesh  - its size and its groups; the numbers of elements of the skins are set
- first - number of the first skin

  Input/Output Parameter:
. slice - its faces, not sorted yet

  Note:
  The tags of these faces follow on the largest one of an element in the file, in the order of the cells.
@*/
PetscErrorCode SliceSkinsAdd(Scene scene, SliceMesh *slice, Mesh mesh, int first)
{
  PetscBool *inner;
  PetscInt   tag;

  PetscFunctionBeginUser;
  if (first == mesh->n_groups) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(SLICE_CELL_FACES * slice->n_cells, &inner));
  MarkSymmetry(scene, slice, mesh, inner);
  PetscCall(MarkShared(slice, inner));
  if (scene->geometry == GEOMETRY_AXISYMMETRIC) MarkAxis(slice, mesh->size, inner);
  PetscCall(LargestTag(slice, &tag));
  PetscCall(
    PetscRealloc((size_t)(slice->n_faces + SLICE_CELL_FACES * slice->n_cells) * sizeof(SliceFace), &slice->faces));
  for (int g = first; g < mesh->n_groups; g++) PetscCall(AddSkin(scene, slice, mesh, g, inner, &tag));
  PetscCall(PetscFree(inner));
  PetscFunctionReturn(PETSC_SUCCESS);
}
