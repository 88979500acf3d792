/* Slave points of both formulations: where they are, their normals, weights and offsets. */
#include "search/slavepoints.h"
#include "search/surfaceends.h"
#include "slavelevers.h"

/* Makes the star forest from the owners to the nodes, whose keys are complete. Nodes of a tool have no owner. */
static PetscErrorCode CreateForest(SlavePoints points)
{
  PetscSFNode   *remote;
  const int      dim    = points->mesh->dim;
  const PetscInt leaves = points->surface->ridge.n ? 0 : points->n_nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(leaves, &remote));
  for (PetscInt i = 0; i < leaves; i++) remote[i] = (PetscSFNode){points->nodes[i].owner, points->nodes[i].local};
  PetscCall(PetscSFCreate(points->mesh->comm, &points->sf));
  PetscCall(
    PetscSFSetGraph(points->sf, points->mesh->n_nodes, leaves, NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscSFSetUp(points->sf));
  PetscCallMPI(MPI_Type_contiguous(dim, MPIU_REAL, &points->block));
  PetscCallMPI(MPI_Type_commit(&points->block));
  PetscCall(PetscCalloc1(points->n_nodes * dim, &points->u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a rank own one of a face's nodes? */
static PetscBool OwnsNode(ContactSurface surface, PetscInt f, PetscMPIInt r)
{
  const Facet *facet = &surface->faces[f];

  for (int a = 0; a < ElementGet(facet->type)->nodes; a++)
    if (surface->mesh->node_owner[facet->nodes[a]] == r) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Sends each face to each rank that owns one of its nodes, and sorts what has arrived. */
static PetscErrorCode ShareFaces(ContactSurface surface, PetscInt *n_records, FaceRecord **records)
{
  PetscInt   *count, *faces, total = 0;
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(surface->mesh->comm, &size));
  PetscCall(PetscCalloc1(size, &count));
  PetscCall(PetscMalloc1(PetscMin(size, FACE_MAX_NODES) * surface->n_faces, &faces));
  for (PetscMPIInt r = 0; r < size; r++) {
    for (PetscInt f = 0; f < surface->n_faces; f++) {
      if (!OwnsNode(surface, f, r)) continue;
      faces[total++] = f;
      count[r]++;
    }
  }
  PetscCall(FaceRecordsShare(surface, NULL, NULL, count, faces, n_records, records));
  FaceRecordsSort(*n_records, *records);
  PetscCall(PetscFree(faces));
  PetscCall(PetscFree(count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the nodes of slave points that are nodes, and those around them where faces have arrived. */
static PetscErrorCode TakeNodes(SlavePoints points, const PetscInt nodes[], PetscInt n_records,
                                const FaceRecord *records)
{
  const PetscInt n    = points->n;
  Mesh           mesh = points->mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n + n_records * FACE_MAX_NODES, &points->nodes));
  for (PetscInt i = 0; i < n; i++) {
    points->nodes[i] = (NodeKey){.id    = mesh->node_id[nodes[i]],
                                 .owner = mesh->node_owner[nodes[i]],
                                 .local = mesh->node_owner_local[nodes[i]]};
    for (int d = 0; d < mesh->dim; d++) points->nodes[i].X[d] = mesh->coords[nodes[i] * mesh->dim + d];
  }
  points->n_nodes = n;
  for (PetscInt f = 0; f < n_records; f++) {
    FaceRecordKeys(&records[f], &points->nodes[points->n_nodes]);
    points->n_nodes += ElementGet(records[f].facet.type)->nodes;
  }
  points->n_nodes = NodeKeysUnique(points->n_nodes, points->nodes);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SlavePointsCreateNodes - makes slave points that are nodes: S = 1, no offset.

  Collective

  Input Parameters:
+ surface - the slave surface
. n       - number of nodes
. nodes   - local nodes, nodes[n]
. size    - size of the faces around each of them (length)
. height  - height of the elements below these faces (length)
- levers  - make the points' levers

  Output Parameter:
. out - the slave points
@*/
PetscErrorCode SlavePointsCreateNodes(ContactSurface surface, PetscInt n, const PetscInt nodes[],
                                      const PetscReal size[], const PetscReal height[], PetscBool levers,
                                      SlavePoints *out)
{
  Mesh        mesh      = surface->mesh;
  PetscInt    n_records = 0;
  FaceRecord *records   = NULL;
  SlavePoints points;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&points));
  points->mesh    = mesh;
  points->surface = surface;
  points->n       = n;
  if (levers) PetscCall(ShareFaces(surface, &n_records, &records));
  PetscCall(TakeNodes(points, nodes, n_records, records));
  PetscCall(PetscMalloc6(n + 1, &points->ptr, n, &points->node, n, &points->S, n, &points->hat, n, &points->weight,
                         n * mesh->dim, &points->offset));
  PetscCall(PetscArrayzero(points->offset, n * mesh->dim));
  PetscCall(PetscMalloc2(n, &points->size, n, &points->height));
  PetscCall(PetscArraycpy(points->size, size, n));
  PetscCall(PetscArraycpy(points->height, height, n));
  for (PetscInt q = 0; q < n; q++) {
    points->ptr[q]  = q;
    points->node[q] = NodeKeysFind(points->n_nodes, points->nodes, mesh->node_id[nodes[q]]);
    points->S[q] = points->hat[q] = points->weight[q] = 1;
  }
  points->ptr[n] = n;
  if (levers) PetscCall(SlaveLeversAroundNodes(points, n_records, records));
  PetscCall(PetscFree(records));
  PetscCall(CreateForest(points));
  *out = points;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SlavePointsCreateRidge - makes slave points of a rigid tool's edges; each rank has a part of them.

  Collective

  Input Parameters:
+ surface - with points in the place of faces
- loads   - gives the motion of the tool; borrowed

  Output Parameter:
. out - the slave points
@*/
PetscErrorCode SlavePointsCreateRidge(ContactSurface surface, Loads loads, SlavePoints *out)
{
  const Mesh         mesh  = surface->mesh;
  const RidgePoints *ridge = &surface->ridge;
  PetscInt           first, n;
  PetscMPIInt        rank, size;
  SlavePoints        points;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCallMPI(MPI_Comm_size(mesh->comm, &size));
  first = (PetscInt)((PetscInt64)ridge->n * rank / size);
  n     = (PetscInt)((PetscInt64)ridge->n * (rank + 1) / size) - first;
  PetscCall(PetscNew(&points));
  points->mesh    = mesh;
  points->surface = surface;
  points->loads   = loads;
  points->n = points->n_nodes = n;
  PetscCall(PetscMalloc1(n, &points->nodes));
  PetscCall(PetscMalloc1(6 * n, &points->sides));
  PetscCall(PetscMalloc6(n + 1, &points->ptr, n, &points->node, n, &points->S, n, &points->hat, n, &points->weight,
                         n * mesh->dim, &points->offset));
  PetscCall(PetscArrayzero(points->offset, n * mesh->dim));
  PetscCall(PetscMalloc2(n, &points->size, n, &points->height));
  for (PetscInt q = 0; q < n; q++) {
    points->nodes[q] = (NodeKey){.id = first + q, .owner = rank, .local = -1};
    PetscCall(PetscArraycpy(points->nodes[q].X, ridge->point[first + q].X, 3));
    points->ptr[q] = points->node[q] = q;
    points->S[q] = points->hat[q] = points->weight[q] = 1;
    points->size[q] = points->height[q] = surface->mean_size;
  }
  points->ptr[n] = n;
  PetscCall(CreateForest(points));
  PetscCall(PetscCalloc1(n * mesh->dim, &points->end));
  *out = points;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the nodes and faces of the points from the faces that arrived. */
static PetscErrorCode TakeRecords(SlavePoints points, PetscInt n_records, FaceRecord *records)
{
  PetscSFNode *remote;

  PetscFunctionBeginUser;
  points->n_faces = n_records;
  PetscCall(PetscMalloc4(n_records, &points->faces, n_records + 1, &points->first, n_records, &points->ends, n_records,
                         &points->piece));
  PetscCall(PetscMalloc1(n_records * FACE_MAX_NODES, &points->nodes));
  for (PetscInt f = 0; f < n_records; f++) {
    FaceRecordKeys(&records[f], &points->nodes[points->n_nodes]);
    points->n_nodes += ElementGet(records[f].facet.type)->nodes;
  }
  points->n_nodes = NodeKeysUnique(points->n_nodes, points->nodes);
  PetscCall(PetscMalloc1(n_records, &remote));
  for (PetscInt f = 0; f < n_records; f++) {
    points->faces[f] = records[f].facet;
    points->ends[f]  = records[f].ends;
    points->piece[f] = records[f].piece;
    for (int a = 0; a < ElementGet(records[f].facet.type)->nodes; a++)
      points->faces[f].nodes[a] = NodeKeysFind(points->n_nodes, points->nodes, records[f].id[a]);
    remote[f] = (PetscSFNode){records[f].home, records[f].home_face};
  }
  PetscCall(PetscSFCreate(points->mesh->comm, &points->face_sf));
  PetscCall(PetscSFSetGraph(points->face_sf, points->surface->n_faces, n_records, NULL, PETSC_OWN_POINTER, remote,
                            PETSC_OWN_POINTER));
  PetscCall(PetscSFSetUp(points->face_sf));
  PetscCallMPI(MPI_Type_contiguous(FACE_RULE_POINTS * points->mesh->dim, MPIU_REAL, &points->face_block));
  PetscCallMPI(MPI_Type_commit(&points->face_block));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SlavePointsCreateQuadrature - makes the slave points of surface-to-surface contact: the quadrature points of every
  face that touches a node of this rank.

  Collective

  Input Parameters:
+ surface  - the slave surface
. geometry - axisymmetric weights are over 360 degrees
. finer    - how fine the quadrature is, see FaceRuleGet()
- levers   - make the points' levers

  Output Parameter:
. out - the slave points, with offsets 0
@*/
PetscErrorCode SlavePointsCreateQuadrature(ContactSurface surface, Geometry geometry, int finer, PetscBool levers,
                                           SlavePoints *out)
{
  const int   dim = surface->mesh->dim;
  PetscInt    n_records, n = 0, entries = 0;
  FaceRecord *records;
  SlavePoints points;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&points));
  points->mesh    = surface->mesh;
  points->surface = surface;
  points->finer   = finer;
  PetscCall(ShareFaces(surface, &n_records, &records));
  PetscCall(TakeRecords(points, n_records, records));
  for (PetscInt f = 0; f < n_records; f++) {
    points->first[f] = n;
    n += FaceRuleOf(points->faces[f].type, finer, points->ends[f])->n;
    entries += FaceRuleOf(points->faces[f].type, finer, points->ends[f])->n * ElementGet(records[f].facet.type)->nodes;
  }
  points->first[n_records] = points->n = n;
  PetscCall(PetscMalloc6(n + 1, &points->ptr, entries, &points->node, entries, &points->S, entries, &points->hat, n,
                         &points->weight, n * dim, &points->offset));
  PetscCall(PetscArrayzero(points->offset, n * dim));
  PetscCall(PetscMalloc2(n, &points->size, n, &points->height));
  entries = 0;
  for (PetscInt f = 0; f < n_records; f++) {
    const Facet    *facet = &points->faces[f];
    const FaceRule *rule  = FaceRuleOf(facet->type, finer, points->ends[f]);
    const int       nodes = ElementGet(facet->type)->nodes;
    double          X[FACE_MAX_NODES * 3];

    for (int a = 0; a < nodes; a++)
      for (int d = 0; d < dim; d++) X[a * dim + d] = points->nodes[facet->nodes[a]].X[d];
    FaceRuleAreas(rule, facet->type, dim, geometry, X, &points->weight[points->first[f]], NULL);
    for (int q = 0; q < rule->n; q++) {
      points->ptr[points->first[f] + q]    = entries;
      points->size[points->first[f] + q]   = records[f].size;
      points->height[points->first[f] + q] = records[f].height;
      for (int a = 0; a < nodes; a++, entries++) {
        points->node[entries] = facet->nodes[a];
        points->S[entries]    = rule->N[q][a];
        points->hat[entries]  = rule->hat[q][a];
      }
    }
  }
  points->ptr[n] = entries;
  if (levers) PetscCall(SlaveLeversOnFaces(points));
  PetscCall(PetscFree(records));
  PetscCall(CreateForest(points));
  PetscCall(PetscCalloc1(3 * points->n_nodes, &points->normal));
  *out = points;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SlavePointIsOwn - tells whether a rank is the one that counts point q.

  Not collective

  Input Parameters:
+ points - the slave points
. q      - the point
- rank   - the rank

  Note:
  Several ranks may hold a point. The owner of its first node counts it.
@*/
PetscBool SlavePointIsOwn(SlavePoints points, PetscInt q, PetscMPIInt rank)
{
  return points->nodes[points->node[points->ptr[q]]].owner == rank ? PETSC_TRUE : PETSC_FALSE;
}

/*@
  SlavePointFace - returns the number of the face with point q, in surface-to-surface contact.

  Not collective

  Input Parameters:
+ points - the slave points
- q      - the point
@*/
PetscInt SlavePointFace(SlavePoints points, PetscInt q)
{
  PetscInt low = 0, high = points->n_faces;

  while (high - low > 1) {
    const PetscInt middle = (low + high) / 2;

    if (points->first[middle] <= q)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/*@
  SlavePointsDestroy - frees slave points.

  Collective

  Input/Output Parameter:
. points - the slave points, NULL on return
@*/
PetscErrorCode SlavePointsDestroy(SlavePoints *points)
{
  SlavePoints p = *points;

  PetscFunctionBeginUser;
  if (!p) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSFDestroy(&p->sf));
  PetscCallMPI(MPI_Type_free(&p->block));
  if (p->face_sf) {
    PetscCall(PetscSFDestroy(&p->face_sf));
    PetscCallMPI(MPI_Type_free(&p->face_block));
    PetscCall(PetscFree4(p->faces, p->first, p->ends, p->piece));
    PetscCall(FaceMapsDestroy(&p->maps));
    PetscCall(PetscFree(p->normal));
  }
  PetscCall(SlaveLeversDestroy(p));
  PetscCall(PetscFree(p->end));
  PetscCall(PetscFree(p->sides));
  PetscCall(PetscFree6(p->ptr, p->node, p->S, p->hat, p->weight, p->offset));
  PetscCall(PetscFree2(p->size, p->height));
  PetscCall(PetscFree(p->nodes));
  PetscCall(PetscFree(p->u));
  PetscCall(PetscFree(*points));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves points on edges of a tool with it, and turns the sides of the edges. */
static void MoveRidge(SlavePoints points, PetscReal t)
{
  const int         dim = points->mesh->dim, body = points->surface->body;
  const RidgePoint *ridge = points->surface->ridge.point;

  for (PetscInt q = 0; q < points->n; q++) {
    const RidgePoint *point = &ridge[points->nodes[q].id];
    PetscReal         x[3];

    LoadsRigidMotion(points->loads, body, t, point->X, x);
    for (int d = 0; d < dim; d++) points->u[q * dim + d] = x[d] - point->X[d];
    for (int k = 0; k < 2; k++)
      LoadsRigidTurn(points->loads, body, t, &point->sides[3 * k], &points->sides[6 * q + 3 * k]);
  }
}

/*@
  SlavePointsMove - fetches the displacements of the nodes, or moves them with their tool.

  Collective

  Input Parameters:
+ points - the slave points
. u      - local displacements u[mesh n_nodes*dim] (length), read at owned nodes
- t      - load parameter, for points of a rigid tool; ToolsPlace() has placed one with unknowns
@*/
PetscErrorCode SlavePointsMove(SlavePoints points, const PetscReal *u, PetscReal t)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSFBcastBegin(points->sf, points->block, u, points->u, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(points->sf, points->block, u, points->u, MPI_REPLACE));
  if (points->surface->ridge.n) MoveRidge(points, t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SlavePointsPosition - computes the position of a point after the last move, without its offset.

  Not collective

  Input Parameters:
+ points - the slave points
- q      - the point

  Output Parameter:
. x - x[dim], relative to the mesh's centre (length)
@*/
void SlavePointsPosition(SlavePoints points, PetscInt q, PetscReal *x)
{
  const int dim = points->mesh->dim;

  for (int d = 0; d < dim; d++) x[d] = 0;
  for (PetscInt k = points->ptr[q]; k < points->ptr[q + 1]; k++)
    for (int d = 0; d < dim; d++)
      x[d] += points->S[k] * (points->nodes[points->node[k]].X[d] + points->u[points->node[k] * dim + d]);
}

/* Marks the mesh's nodes, on all ranks, of which some points are made. */
static PetscErrorCode MarkNodes(SlavePoints points, const PetscBool *some, PetscReal *marks)
{
  PetscReal *mine;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(points->n_nodes, &mine));
  for (PetscInt q = 0; q < points->n; q++)
    for (PetscInt k = points->ptr[q]; k < points->ptr[q + 1] && some[q]; k++) mine[points->node[k]] = 1;
  PetscCall(PetscArrayzero(marks, points->mesh->n_nodes));
  PetscCall(PetscSFReduceBegin(points->sf, MPIU_REAL, mine, marks, MPIU_MAX));
  PetscCall(PetscSFReduceEnd(points->sf, MPIU_REAL, mine, marks, MPIU_MAX));
  PetscCall(MeshSumNodes(points->mesh, 1, marks));
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has a face a marked node? marks NULL: it counts as one. */
static PetscBool IsMarked(const Facet *face, const PetscReal *marks)
{
  for (int a = 0; a < ElementGet(face->type)->nodes && marks; a++)
    if (marks[face->nodes[a]] > 0) return PETSC_TRUE;
  return (PetscBool)!marks;
}

/* Normals at points on edges of a tool: the mean of both sides. */
static void RidgeNormals(SlavePoints points, PetscReal *normals)
{
  for (PetscInt q = 0; q < points->n; q++)
    for (int d = 0; d < 3; d++) normals[3 * q + d] = points->sides[6 * q + d] + points->sides[6 * q + 3 + d];
}

/* Normals at nodes: the area-weighted mean normal of the faces around each node. */
static PetscErrorCode NodeNormals(SlavePoints points, const PetscReal *u, PetscReal *normals)
{
  Mesh       mesh = points->mesh;
  PetscReal *area, *all;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(mesh->n_nodes, &area, 3 * mesh->n_nodes, &all));
  PetscCall(SurfaceNodeNormals(points->surface, u, area, all));
  for (PetscInt q = 0; q < points->n; q++) /* slave nodes are owned */
    for (int d = 0; d < 3; d++) normals[3 * q + d] = all[3 * points->nodes[points->node[q]].local + d];
  PetscCall(PetscFree2(area, all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mean normals of the faces around each node, weighted by the hat functions. On a plane of symmetry the other half
   cancels the part along the plane's normal. some: only nodes of which these points are made are right; NULL: all. */
static PetscErrorCode HatNormals(SlavePoints points, int n_images, const SurfaceImage *images, const PetscReal *u,
                                 const PetscBool *some)
{
  Mesh       mesh = points->mesh;
  const int  dim  = mesh->dim;
  PetscReal *sum, *at, *marks = NULL;

  PetscFunctionBeginUser;
  if (some) PetscCall(PetscMalloc1(mesh->n_nodes, &marks));
  if (some) PetscCall(MarkNodes(points, some, marks));
  PetscCall(PetscCalloc2(mesh->n_nodes * dim, &sum, points->n_nodes * dim, &at));
  for (PetscInt f = 0; f < points->surface->n_faces; f++) {
    const Facet    *facet = &points->surface->faces[f];
    const FaceRule *rule  = SurfaceRule(points->surface, f, points->finer);
    const int       nodes = ElementGet(facet->type)->nodes;
    double          x[FACE_MAX_NODES * 3], area[FACE_RULE_POINTS], normal[FACE_RULE_POINTS * 3];

    if (!IsMarked(facet, marks)) continue;
    for (int a = 0; a < nodes; a++)
      for (int d = 0; d < dim; d++)
        x[a * dim + d] = mesh->coords[facet->nodes[a] * dim + d] + u[facet->nodes[a] * dim + d];
    FaceRuleAreas(rule, facet->type, dim, GEOMETRY_SOLID, x, area, normal);
    for (int q = 0; q < rule->n; q++)
      for (int a = 0; a < nodes; a++)
        for (int d = 0; d < dim; d++) sum[facet->nodes[a] * dim + d] += area[q] * rule->hat[q][a] * normal[3 * q + d];
  }
  PetscCall(MeshSumNodes(mesh, dim, sum));
  PetscCall(PetscSFBcastBegin(points->sf, points->block, sum, at, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(points->sf, points->block, sum, at, MPI_REPLACE));
  for (PetscInt i = 0; i < points->n_nodes; i++) {
    for (int d = 0; d < dim; d++) points->normal[3 * i + d] = at[i * dim + d];
    for (int bit = 1; bit < n_images; bit <<= 1)
      for (int d = 0; d < dim && SurfaceOnPlane(mesh, &images[bit], points->nodes[i].X); d++)
        if (images[bit].sign[d] < 0) points->normal[3 * i + d] = 0;
  }
  PetscCall(PetscFree2(sum, at));
  PetscCall(PetscFree(marks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SlavePointsFacePositions - returns where the nodes of a face are.

  Not collective

  Input Parameters:
+ points - the points of surface-to-surface contact, after SlavePointsMove()
- f      - the face

  Output Parameter:
. x - x[nodes*dim] (length)
@*/
void SlavePointsFacePositions(SlavePoints points, PetscInt f, PetscReal *x)
{
  const Facet *facet = &points->faces[f];
  const int    dim   = points->mesh->dim;

  for (int a = 0; a < ElementGet(facet->type)->nodes; a++)
    for (int d = 0; d < dim; d++)
      x[a * dim + d] = points->nodes[facet->nodes[a]].X[d] + points->u[facet->nodes[a] * dim + d];
}

/*@
  SlavePointsNormals - computes the normals at the points after the last move.

  Collective

  Input Parameters:
+ points   - the slave points; their mean normals around nodes are set in surface-to-surface contact
. n_images - number of mirror images of the pair
. images   - the images
. u        - local displacements u[mesh n_nodes*dim] of the last SlavePointsMove(), ghosts included
- some     - which points are asked for; NULL: all, on all ranks

  Output Parameter:
. normals - normals[n*3], out of the slave's body, of any length; those of points that are not asked for may not be set
@*/
PetscErrorCode SlavePointsNormals(SlavePoints points, int n_images, const SurfaceImage *images, const PetscReal *u,
                                  const PetscBool *some, PetscReal *normals)
{
  const int dim = points->mesh->dim;

  PetscFunctionBeginUser;
  if (points->surface->ridge.n)
    RidgeNormals(points, normals);
  else if (points->face_sf)
    PetscCall(HatNormals(points, n_images, images, u, some));
  else
    PetscCall(NodeNormals(points, u, normals));
  for (PetscInt f = 0; f < points->n_faces; f++) {
    const Facet *facet = &points->faces[f];
    double       x[FACE_MAX_NODES * 3], area[FACE_RULE_POINTS];
    PetscBool    asked = (PetscBool)!some;

    for (PetscInt q = points->first[f]; q < points->first[f + 1] && !asked; q++) asked = some[q];
    if (!asked) continue;
    SlavePointsFacePositions(points, f, x);
    FaceRuleAreas(FaceRuleOf(facet->type, points->finer, points->ends[f]), facet->type, dim, GEOMETRY_SOLID, x, area,
                  &normals[3 * points->first[f]]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SlavePointsFindEnds - finds at which nodes the slave surface ends, and which way.

  Collective

  Input Parameters:
+ points - the slave points
- u      - local displacements u[mesh n_nodes*dim] (length), ghosts included
@*/
PetscErrorCode SlavePointsFindEnds(SlavePoints points, const PetscReal *u)
{
  const int  dim = points->mesh->dim;
  PetscReal *end;

  PetscFunctionBeginUser;
  if (points->surface->ridge.n) PetscFunctionReturn(PETSC_SUCCESS); /* edges of a tool have no end */
  if (!points->end) PetscCall(PetscMalloc1(points->n_nodes * dim, &points->end));
  PetscCall(PetscMalloc1(points->mesh->n_nodes * dim, &end));
  PetscCall(SurfaceNodeEnds(points->surface, u, end));
  PetscCall(PetscSFBcastBegin(points->sf, points->block, end, points->end, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(points->sf, points->block, end, points->end, MPI_REPLACE));
  PetscCall(PetscFree(end));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the faces of the points on this rank that are touched where they live. */
static PetscErrorCode TouchedFaces(SlavePoints points, const PetscBool *touched, PetscInt *n, PetscInt **faces)
{
  PetscInt *at_home, *here;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(points->surface->n_faces, &at_home, points->n_faces, &here));
  for (PetscInt f = 0; f < points->surface->n_faces; f++) at_home[f] = touched[f];
  PetscCall(PetscSFBcastBegin(points->face_sf, MPIU_INT, at_home, here, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(points->face_sf, MPIU_INT, at_home, here, MPI_REPLACE));
  PetscCall(PetscMalloc1(points->n_faces, faces));
  *n = 0;
  for (PetscInt f = 0; f < points->n_faces; f++)
    if (here[f]) (*faces)[(*n)++] = f;
  PetscCall(PetscFree2(at_home, here));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest offset of the points of some faces (length). */
static PetscReal LargestOffset(SlavePoints points, PetscInt n, const PetscInt *faces)
{
  const int dim  = points->mesh->dim;
  PetscReal most = 0;

  for (PetscInt i = 0; i < n; i++) {
    for (PetscInt q = points->first[faces[i]]; q < points->first[faces[i] + 1]; q++) {
      PetscReal square = 0;

      for (int d = 0; d < dim; d++) square += PetscSqr(points->offset[q * dim + d]);
      most = PetscMax(most, square);
    }
  }
  return PetscSqrtReal(most);
}

/*@
  SlavePointsSetOffsets - takes the offsets of this rank's own faces to the points on all ranks.

  Collective

  Input Parameters:
+ points  - the slave points
. offset  - offset[faces of the surface][FACE_RULE_POINTS*dim] (length)
- touched - touched[faces of the surface]: the others have always been 0
@*/
PetscErrorCode SlavePointsSetOffsets(SlavePoints points, const PetscReal *offset, const PetscBool *touched)
{
  const int  dim = points->mesh->dim;
  PetscReal *arrived;
  PetscInt   n, *faces;
  PetscSF    some;

  PetscFunctionBeginUser;
  PetscCall(TouchedFaces(points, touched, &n, &faces));
  PetscCall(PetscSFCreateEmbeddedLeafSF(points->face_sf, n, faces, &some));
  PetscCall(PetscMalloc1(points->n_faces * FACE_RULE_POINTS * dim, &arrived));
  PetscCall(PetscSFBcastBegin(some, points->face_block, offset, arrived, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(some, points->face_block, offset, arrived, MPI_REPLACE));
  for (PetscInt i = 0; i < n; i++)
    PetscCall(PetscArraycpy(&points->offset[points->first[faces[i]] * dim], &arrived[faces[i] * FACE_RULE_POINTS * dim],
                            (points->first[faces[i] + 1] - points->first[faces[i]]) * dim));
  points->most_offset = LargestOffset(points, n, faces);
  PetscCall(PetscFree(arrived));
  PetscCall(PetscSFDestroy(&some));
  PetscCall(PetscFree(faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SlavePointsSetMaps - takes the maps of this rank's own faces to the points on all ranks.

  Collective

  Input Parameters:
+ points - the slave points
- maps   - maps of this rank's faces

  Note:
  Later calls do nothing, because the maps do not change.
@*/
PetscErrorCode SlavePointsSetMaps(SlavePoints points, const FaceMaps *maps)
{
  PetscFunctionBeginUser;
  if (!points->maps.ptr) PetscCall(FaceMapsFetch(points->face_sf, maps, &points->maps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SlavePointsHatAreas - computes the areas int psi dA of all local nodes of the mesh, with the hat functions psi.

  Collective

  Input Parameters:
+ points   - the slave points
. geometry - axisymmetric areas are over 360 degrees
- u        - local displacements u[n_nodes*dim], ghosts included; NULL: reference configuration

  Output Parameter:
. area - area[n_nodes], complete on every copy of a node
@*/
PetscErrorCode SlavePointsHatAreas(SlavePoints points, Geometry geometry, const PetscReal *u, PetscReal *area)
{
  Mesh      mesh = points->mesh;
  const int dim  = mesh->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(area, mesh->n_nodes));
  for (PetscInt f = 0; f < points->surface->n_faces; f++) {
    const Facet    *facet = &points->surface->faces[f];
    const FaceRule *rule  = SurfaceRule(points->surface, f, points->finer);
    const int       nodes = ElementGet(facet->type)->nodes;
    double          x[FACE_MAX_NODES * 3], parts[FACE_RULE_POINTS];

    for (int a = 0; a < nodes; a++)
      for (int d = 0; d < dim; d++)
        x[a * dim + d] = mesh->coords[facet->nodes[a] * dim + d] + (u ? u[facet->nodes[a] * dim + d] : 0);
    FaceRuleAreas(rule, facet->type, dim, geometry, x, parts, NULL);
    for (int q = 0; q < rule->n; q++)
      for (int a = 0; a < nodes; a++) area[facet->nodes[a]] += parts[q] * rule->hat[q][a];
  }
  PetscCall(MeshSumNodes(mesh, 1, area));
  PetscFunctionReturn(PETSC_SUCCESS);
}
