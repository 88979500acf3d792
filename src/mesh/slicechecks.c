/* Checks of the mesh file against the scene: names of bodies, order of the elements, plane of the nodes. */
#include "slicechecks.h"
#include "mesh/meshgroup.h"
#include <string.h>

/* Distance from the plane z = 0, or from the axis, that is treated as round-off, as a part of the mesh's size. */
static const PetscReal PLANE_TOLERANCE = 1e-9;

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
static void CheckBodyNames(Scene scene, const char *file, const SliceMesh *slice, Complaint *complaint)
{
  const GmshMesh *gmsh = &slice->gmsh;
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
static int BlockBody(Scene scene, const char *file, const SliceMesh *slice, const GmshBlock *block,
                     Complaint *complaint)
{
  int body = -1;

  for (int i = 0; i < block->n_physicals; i++) {
    const char *name  = slice->gmsh.physicals[block->physical[i]].name;
    const int   found = MeshFindBody(scene, name, PETSC_FALSE);

    if (found < 0) {
      Complain(complaint,
               "%s: the mesh '%s' has a volume group '%s' that is no body of the scene; list it with its material",
               SceneWhere(scene, "bodies", NULL), file, name);
    } else if (body >= 0) {
      Complain(complaint, "%s: cell %" PetscInt_FMT " is in two bodies, '%s' and '%s'", file, block->first_tag,
               scene->bodies[body].name, scene->bodies[found].name);
    }
    body = found;
  }
  return body;
}

/* Checks that all elements have one order, which is that of the scene. */
static void CheckOrder(Scene scene, const char *file, const SliceMesh *slice, Complaint *complaint)
{
  const GmshBlock *first = NULL;

  for (int b = 0; b < slice->gmsh.n_blocks; b++) {
    const GmshBlock *block = &slice->gmsh.blocks[b];

    if (!block->element || !block->n_all) continue;
    if (!first) first = block;
    if (block->element->order != first->element->order) {
      Complain(complaint, "%s: elements of two orders: %" PetscInt_FMT " is %s, %" PetscInt_FMT " is %s", file,
               first->first_tag, first->element->name, block->first_tag, block->element->name);
    }
  }
  if (first && scene->order && first->element->order != scene->order) {
    Complain(complaint, "%s: order is %d, but the elements of '%s' (%s) are of order %d",
             SceneWhere(scene, "mesh", "order"), scene->order, file, first->element->name, first->element->order);
  }
}

static void CheckBodies(Scene scene, const char *file, const SliceMesh *slice, const PetscInt cells[],
                        Complaint *complaint)
{
  char list[MESH_TEXT];

  ListPhysicals(&slice->gmsh, scene->dim, list);
  for (int b = 0; b < scene->n_bodies; b++) {
    if (scene->bodies[b].rigid || cells[b]) continue;
    Complain(complaint, "%s: the mesh '%s' has no cells of a volume group '%s'; its volume groups: %s",
             SceneWhere(scene, scene->bodies[b].path, "volume"), file, scene->bodies[b].name, list);
  }
}

/* Counts the cells of the scene's dimension and complains of elements of a higher dimension. */
static PetscInt CountCells(Scene scene, const char *file, const GmshMesh *gmsh, Complaint *complaint)
{
  PetscInt n = 0;

  for (int b = 0; b < gmsh->n_blocks; b++) {
    if (gmsh->blocks[b].dim > scene->dim)
      Complain(complaint, "%s: the mesh '%s' has volumes; a two-dimensional one is needed",
               SceneWhere(scene, "geometry", NULL), file);
    if (gmsh->blocks[b].dim == scene->dim) n += gmsh->blocks[b].n_all;
  }
  return n;
}

/* Finds the body of each block, -1 for a block without cells, and checks that every body has cells. */
static PetscErrorCode BlockBodies(Scene scene, const char *file, const SliceMesh *slice, int body[],
                                  Complaint *complaint)
{
  PetscInt *per_body;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(scene->n_bodies, &per_body));
  for (int b = 0; b < slice->gmsh.n_blocks; b++) {
    const GmshBlock *block = &slice->gmsh.blocks[b];

    body[b] = block->dim == scene->dim ? BlockBody(scene, file, slice, block, complaint) : -1;
    if (body[b] >= 0) per_body[body[b]] += block->n_all;
  }
  CheckBodies(scene, file, slice, per_body, complaint);
  PetscCall(PetscFree(per_body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceChecksBlocks - checks groups and blocks against the scene, and finds the body of each block.

  Collective

  Input Parameters:
+ scene - bodies, dimension and order
. file  - path, for messages
- slice - its mesh file is read

  Output Parameters:
+ body      - of each block, -1 for one without cells
- complaint - says what is wrong with the file, if anything, on the first rank
@*/
PetscErrorCode SliceChecksBlocks(Scene scene, const char *file, const SliceMesh *slice, int body[],
                                 Complaint *complaint)
{
  PetscFunctionBeginUser;
  if (!slice->rank) {
    CheckBodyNames(scene, file, slice, complaint);
    CheckOrder(scene, file, slice, complaint);
    (void)CountCells(scene, file, &slice->gmsh, complaint);
    PetscCall(BlockBodies(scene, file, slice, body, complaint));
  }
  PetscCallMPI(MPI_Bcast(body, slice->gmsh.n_blocks, MPI_INT, 0, slice->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceChecksPlane - checks that a two-dimensional mesh lies in its plane, and has no negative radii.

  Not collective

  Input Parameters:
+ scene - its geometry
. file  - path, for messages
. slice - its nodes are numbered
- size  - of the mesh

  Output Parameter:
. complaint - says which node of this home is off the plane, if any
@*/
void SliceChecksPlane(Scene scene, const char *file, const SliceMesh *slice, PetscReal size, Complaint *complaint)
{
  for (PetscInt i = 0; i < slice->n_homes && scene->dim == 2; i++) {
    const PetscReal *x   = &slice->gmsh.coords[3 * slice->home[i]];
    const PetscInt   tag = slice->gmsh.node_tag[slice->home[i]];

    if (PetscAbsReal(x[2]) > PLANE_TOLERANCE * size)
      Complain(complaint, "%s: node %" PetscInt_FMT " has z = %g; a two-dimensional mesh lies in the plane z = 0", file,
               tag, (double)x[2]);
    if (scene->geometry == GEOMETRY_AXISYMMETRIC && x[0] < -PLANE_TOLERANCE * size) {
      Complain(complaint, "%s: node %" PetscInt_FMT " has x = %g; an axisymmetric mesh has no negative radius x", file,
               tag, (double)x[0]);
    }
  }
}
