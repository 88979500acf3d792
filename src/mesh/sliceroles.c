/* Roles of slave and master by the edges of both, see sliceroles.h. */
#include "sliceroles.h"
#include "slicesides.h"
#include "base/gathertable.h"
#include "base/vectors.h"
#include "mesh/meshgroup.h"
#include "scene/sceneroles.h"
#include <string.h>

/* A side that is square to the surface, but for round-off, does not face it: cosine of their normals. */
#define ROLES_SQUARE 1e-3
/* An edge stands on a surface where each of its sides is off that by more than this: cosine of 30 degrees. */
#define ROLES_STANDS 0.866

/* A node on the edge of a wedge, with the unit normals of its sides that differ most. */
typedef struct {
  PetscReal X[3], normal[2][3];
} WedgeNode;

enum { WEDGE_COLUMNS = sizeof(WedgeNode) / sizeof(PetscReal) };

/* The face nearest to the node of a wedge: distance of their centres (length), and its unit normal. */
typedef struct {
  PetscReal distance, normal[3];
} NearFace;

/* Finds the sides of a node that differ most, if they are those of a convex wedge. */
static PetscBool FindWedge(PetscInt n, const NodeSide sides[], WedgeNode *wedge)
{
  PetscReal least = VECTORS_WEDGE;

  for (PetscInt i = 0; i < n; i++) {
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal *a = sides[i].normal, *b = sides[k].normal;
      const PetscReal  length[] = {PetscSqrtReal(Dot(a, a)), PetscSqrtReal(Dot(b, b))};
      const PetscReal  cosine   = length[0] * length[1] > 0 ? Dot(a, b) / (length[0] * length[1]) : 1;

      if (cosine >= least || Dot(a, sides[k].way) >= 0) continue;
      least = cosine;
      for (int d = 0; d < 3; d++) wedge->normal[0][d] = a[d] / length[0];
      for (int d = 0; d < 3; d++) wedge->normal[1][d] = b[d] / length[1];
    }
  }
  return (PetscBool)(least < VECTORS_WEDGE);
}

/* Finds the nodes on wedges of a group, all of them on every rank: rows that are WedgeNode. */
static PetscErrorCode GatherWedges(const SliceMesh *slice, const Mesh mesh, int group, GatherTable *wedges)
{
  PetscInt   n_sides, n_own = 0;
  PetscBool *groups;
  NodeSide  *sides;
  WedgeNode *own;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_groups, &groups));
  groups[group] = PETSC_TRUE;
  PetscCall(SliceSidesGather(slice, groups, &n_sides, &sides));
  PetscCall(PetscMalloc1(n_sides, &own));
  for (PetscInt i = 0, same; i < n_sides; i += same) {
    const PetscInt home = sides[i].id - slice->home_start[slice->rank];

    for (same = 1; i + same < n_sides && sides[i + same].id == sides[i].id;) same++;
    if (!FindWedge(same, &sides[i], &own[n_own])) continue;
    for (int d = 0; d < 3; d++) own[n_own].X[d] = slice->gmsh.coords[3 * slice->home[home] + d];
    n_own++;
  }
  PetscCall(GatherTableCreate(slice->comm, WEDGE_COLUMNS, n_own, (const PetscReal *)own, wedges));
  PetscCall(PetscFree(groups));
  PetscCall(PetscFree(sides));
  PetscCall(PetscFree(own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the face of a group that is nearest to each of n nodes, by centres: near[n], the same on all ranks. */
static PetscErrorCode FindNearest(const SliceMesh *slice, int group, PetscInt n, const WedgeNode wedges[],
                                  NearFace near[])
{
  PetscReal *least, *normals;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &least, 3 * n, &normals));
  for (PetscInt i = 0; i < n; i++) near[i].distance = PETSC_MAX_REAL;
  for (PetscInt f = 0; f < slice->n_faces; f++) {
    PetscReal centre[3], normal[3];

    if (slice->faces[f].group != group) continue;
    SliceFaceNormal(slice, &slice->faces[f], centre, normal);
    for (PetscInt i = 0; i < n; i++) {
      const PetscReal distance = Distance(centre, wedges[i].X);

      if (distance > near[i].distance) continue;
      for (int d = 0; d < 3; d++) near[i].normal[d] = normal[d] + (distance < near[i].distance ? 0 : near[i].normal[d]);
      near[i].distance = distance;
    }
  }
  for (PetscInt i = 0; i < n; i++) least[i] = near[i].distance;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, least, (PetscMPIInt)n, MPIU_REAL, MPIU_MIN, slice->comm));
  for (PetscInt i = 0; i < n; i++) /* of faces as near as each other, the mean normal */
    for (int d = 0; d < 3; d++) normals[3 * i + d] = near[i].distance > least[i] ? 0 : near[i].normal[d];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, normals, (PetscMPIInt)(3 * n), MPIU_REAL, MPIU_SUM, slice->comm));
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal length = PetscSqrtReal(Dot(&normals[3 * i], &normals[3 * i]));

    near[i].distance = least[i];
    for (int d = 0; d < 3; d++) near[i].normal[d] = length > 0 ? normals[3 * i + d] / length : 0;
  }
  PetscCall(PetscFree2(least, normals));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does an edge stand on a face? Both its sides look to the face, and none of them lies on it. */
static PetscBool Stands(const WedgeNode *wedge, const NearFace *face)
{
  for (int k = 0; k < 2; k++) {
    const PetscReal cosine = -Dot(wedge->normal[k], face->normal);

    if (cosine <= ROLES_SQUARE || cosine >= ROLES_STANDS) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Says whether some edge of a wedge of a group stands on the nearest face of another group. */
static PetscErrorCode HasStanding(const SliceMesh *slice, const Mesh mesh, int group, int on, PetscBool *stands)
{
  GatherTable      table;
  const WedgeNode *wedges;
  NearFace        *near;

  PetscFunctionBeginUser;
  *stands = PETSC_FALSE;
  PetscCall(GatherWedges(slice, mesh, group, &table));
  wedges = (const WedgeNode *)table.row;
  PetscCall(PetscMalloc1(table.n, &near));
  if (table.n) PetscCall(FindNearest(slice, on, table.n, wedges, near));
  for (PetscInt i = 0; i < table.n; i++) *stands = (PetscBool)(*stands || Stands(&wedges[i], &near[i]));
  PetscCall(PetscFree(near));
  PetscCall(GatherTableDestroy(&table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceRolesChoose - swaps slave and master of the pairs whose master has a sharp edge that stands on the slave, and
  whose slave has none that stands on the master.

  Collective

  Input Parameters:
+ scene - its pairs by slave and master, of which roles may change
- slice - with the faces of the groups

  Input/Output Parameter:
. mesh - its notes tell which roles were swapped
@*/
PetscErrorCode SliceRolesChoose(Scene scene, const SliceMesh *slice, Mesh mesh)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < scene->n_contacts; p++) {
    SceneContact *pair      = &scene->contacts[p];
    const int     slave     = MeshFindGroup(mesh, mesh->dim - 1, pair->slave);
    const int     master    = pair->master ? MeshFindGroup(mesh, mesh->dim - 1, pair->master) : -1;
    PetscBool     stands[2] = {PETSC_FALSE, PETSC_FALSE};
    char          text[MESH_TEXT];

    if (slave < 0 || master < 0 || !SceneMaySwapRoles(scene, pair)) continue;
    PetscCall(HasStanding(slice, mesh, master, slave, &stands[0]));
    if (stands[0]) PetscCall(HasStanding(slice, mesh, slave, master, &stands[1]));
    if (!stands[0] || stands[1]) continue;
    SceneSwapRoles(scene, pair);
    snprintf(text, sizeof text, "contact '%s': '%s' has a sharp edge that stands on '%s' and is the slave in its place",
             pair->name, pair->slave, pair->master);
    if (!slice->rank) PetscCall(MeshAddNote(mesh, text));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
