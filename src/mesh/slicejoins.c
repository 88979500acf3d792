/* Groups of joined surfaces, see slicejoins.h. */
#include "slicejoins.h"
#include "slicesides.h"
#include "base/vectors.h"
#include "mesh/meshgroup.h"
#include "scene/scenejoins.h"
#include <string.h>

/* The surfaces of one list */
typedef struct {
  Scene       scene;
  const char *path;
  PetscReal   angle;    /* feature_angle (radians) */
  int         n_groups; /* of the mesh */
  PetscBool  *listed;   /* [n_groups] */
  PetscBool  *sharp;    /* [n_groups * n_groups], symmetric: they are sides of a sharp edge */
} JoinList;

/* Adds up the sides of each node and group. */
static void SumSides(PetscInt *n, NodeSide *sides)
{
  PetscInt sums = 0;

  for (PetscInt i = 0; i < *n; i++) {
    if (!sums || sides[sums - 1].id != sides[i].id || sides[sums - 1].group != sides[i].group) {
      sides[sums++] = sides[i];
      continue;
    }
    for (int d = 0; d < 3; d++) sides[sums - 1].normal[d] += sides[i].normal[d];
    for (int d = 0; d < 3; d++) sides[sums - 1].way[d] += sides[i].way[d];
  }
  *n = sums;
}

/* Is the node on a sharp edge between two groups, past which the second one falls away? */
static PetscBool IsSharp(const NodeSide *a, const NodeSide *b, PetscReal cosine)
{
  const PetscReal length = PetscSqrtReal(Dot(a->normal, a->normal) * Dot(b->normal, b->normal));

  return (PetscBool)(length > 0 && Dot(a->normal, b->normal) < cosine * length && Dot(a->normal, b->way) < 0);
}

/* Finds which listed surfaces are sides of a sharp convex edge. */
static PetscErrorCode FindSharp(const SliceMesh *slice, JoinList *list)
{
  const int       n_groups = list->n_groups;
  const PetscReal cosine   = PetscCosReal(list->angle);
  PetscInt        n;
  NodeSide       *sides;

  PetscFunctionBeginUser;
  PetscCall(SliceSidesGather(slice, list->listed, &n, &sides));
  SumSides(&n, sides);
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = i + 1; j < n && sides[j].id == sides[i].id; j++)
      if (IsSharp(&sides[i], &sides[j], cosine))
        list->sharp[sides[i].group * n_groups + sides[j].group] =
          list->sharp[sides[j].group * n_groups + sides[i].group] = PETSC_TRUE;
  PetscCall(PetscFree(sides));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, list->sharp, n_groups * n_groups, MPIU_BOOL, MPI_LOR, slice->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Groups */

/* Adds a group that has the faces of others, each of them once. */
static PetscErrorCode AddGroup(SliceMesh *slice, Mesh mesh, int n, const int parts[], const char *name)
{
  const int      g      = mesh->n_groups++;
  const PetscInt before = slice->n_faces;
  PetscBool     *has, *of;
  MeshGroup     *group;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)mesh->n_groups * sizeof(MeshGroup), &mesh->groups));
  PetscCall(PetscRealloc((size_t)mesh->n_groups * sizeof(PetscInt), &slice->interior));
  group  = &mesh->groups[g];
  *group = (MeshGroup){.dim = mesh->dim - 1};
  PetscCall(PetscStrallocpy(name, &group->name));
  slice->interior[g] = 0;
  PetscCall(PetscCalloc1(SLICE_CELL_FACES * slice->n_cells, &has));
  PetscCall(PetscCalloc1(mesh->n_groups, &of));
  for (int k = 0; k < n; k++) of[parts[k]] = PETSC_TRUE;
  for (int k = 0; k < n; k++) slice->interior[g] += slice->interior[parts[k]];
  PetscCall(PetscRealloc((size_t)(2 * slice->n_faces) * sizeof(SliceFace), &slice->faces));
  for (PetscInt f = 0; f < before; f++) {
    SliceFace  face = slice->faces[f];
    PetscBool *have = &has[SLICE_CELL_FACES * (face.cell - slice->cell_start[slice->rank]) + face.number];

    if (!of[face.group] || *have) continue;
    *have                          = PETSC_TRUE;
    face.group                     = g;
    slice->faces[slice->n_faces++] = face;
  }
  group->n_elements = slice->n_faces - before;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &group->n_elements, 1, MPIU_INT, MPI_SUM, slice->comm));
  PetscCall(PetscFree(has));
  PetscCall(PetscFree(of));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Notes for the first lines of the run which surfaces are joined. */
static PetscErrorCode AddNote(const SliceMesh *slice, Mesh mesh, const JoinList *list, int n, const char *const parts[],
                              const char *joint)
{
  char   text[MESH_TEXT];
  size_t length = 0;

  PetscFunctionBeginUser;
  if (slice->rank) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < n && length < sizeof text; k++)
    length += (size_t)snprintf(text + length, sizeof text - length, "%s'%s'", k ? ", " : "", parts[k]);
  if (length < sizeof text)
    snprintf(text + length, sizeof text - length, " meet at sharp edges: %s has them as one surface '%s'", list->path,
             joint);
  PetscCall(MeshAddNote(mesh, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Joins some groups. */
static PetscErrorCode Join(SliceMesh *slice, Mesh mesh, const JoinList *list, int n, const int parts[])
{
  char **names, *joint;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &names));
  for (int k = 0; k < n; k++) PetscCall(PetscStrallocpy(mesh->groups[parts[k]].name, &names[k]));
  PetscCall(SceneJointName(list->scene, list->path, n, names, &joint));
  if (MeshFindGroup(mesh, mesh->dim - 1, joint) < 0) PetscCall(AddGroup(slice, mesh, n, parts, joint));
  PetscCall(AddNote(slice, mesh, list, n, (const char *const *)names, joint));
  PetscCall(SceneJoinSurfaces(list->scene, list->path, n, (const char *const *)names, joint));
  for (int k = 0; k < n; k++) PetscCall(PetscFree(names[k]));
  PetscCall(PetscFree(names));
  PetscCall(PetscFree(joint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Must two surfaces of the list be joined? */
static PetscBool AreJoined(Mesh mesh, const JoinList *list, int a, int b)
{
  return (PetscBool)(list->sharp[a * list->n_groups + b] &&
                     SceneListedTogether(list->scene, list->path, mesh->groups[a].name, mesh->groups[b].name));
}

/* Joins the surfaces of a list from edge to edge. */
static PetscErrorCode JoinSides(SliceMesh *slice, Mesh mesh, const JoinList *list)
{
  const int  n_groups = list->n_groups;
  int       *parts, n;
  PetscBool *done, *together;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(n_groups, &parts, n_groups, &done, (size_t)n_groups * n_groups, &together));
  for (int a = 0; a < n_groups; a++) /* before names change */
    for (int b = 0; b < n_groups; b++) together[a * n_groups + b] = AreJoined(mesh, list, a, b);
  for (int a = 0; a < n_groups; a++) {
    if (done[a]) continue;
    parts[0] = a;
    n        = 1;
    for (int k = 0; k < n; k++) {
      for (int b = 0; b < n_groups; b++) {
        if (b == a || done[b] || !together[parts[k] * n_groups + b]) continue;
        done[b]    = PETSC_TRUE;
        parts[n++] = b;
      }
    }
    if (n > 1) PetscCall(Join(slice, mesh, list, n, parts));
  }
  PetscCall(PetscFree3(parts, done, together));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds and joins the surfaces of the list of a pair. */
static PetscErrorCode JoinOfPair(Scene scene, SliceMesh *slice, Mesh mesh, const SceneContact *pair)
{
  JoinList list = {.scene = scene, .path = pair->path, .angle = SceneSharpAngle(pair), .n_groups = mesh->n_groups};
  int      n    = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(list.n_groups, &list.listed, (size_t)list.n_groups * list.n_groups, &list.sharp));
  for (int g = 0; g < list.n_groups; g++) {
    list.listed[g] = (PetscBool)(mesh->groups[g].dim == mesh->dim - 1 &&
                                 SceneListedTogether(scene, list.path, mesh->groups[g].name, mesh->groups[g].name));
    n += list.listed[g];
  }
  if (n > 1) PetscCall(FindSharp(slice, &list));
  if (n > 1) PetscCall(JoinSides(slice, mesh, &list));
  PetscCall(PetscFree2(list.listed, list.sharp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceJoinsAdd - joins surfaces of one list that are sides of sharp convex edges, and adds groups with their faces.

  Collective

  Input Parameter:
. scene - its contact pairs change where surfaces are joined

  Input/Output Parameters:
+ slice - its faces, not sorted yet, and the numbers of those between two cells
- mesh  - its groups, and notes of what is joined

  Note:
  Refuses probes of pairs that are no more.
@*/
PetscErrorCode SliceJoinsAdd(Scene scene, SliceMesh *slice, Mesh mesh)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < scene->n_contacts; p++) {
    PetscBool first = (PetscBool)scene->contacts[p].listed;

    for (int q = 0; q < p && first; q++)
      first = (PetscBool)(strcmp(scene->contacts[p].path, scene->contacts[q].path) != 0);
    if (first) PetscCall(JoinOfPair(scene, slice, mesh, &scene->contacts[p]));
  }
  PetscCall(SceneCheckProbePairs(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}
