/* Pieces of faces and their points at the two ends of a step, see pieces.h. */
#include "pieces.h"
#include <math.h>
#include <string.h>

/* Normals that turn from a piece's by more than this belong to a sharp edge. A ring of eight pieces is round. */
#define PIECE_COSINE 0.92
/* A surface lies in a plane of symmetry, and does not go on beyond it, where less than this part of its direction lies
   along the plane: round-off of its places. */
#define PIECE_IN_PLANE 1e-6

/* Faces of this rank, a tool's in equal parts. */
static void OwnFaces(ContactSurface surface, PetscInt *first, PetscInt *end)
{
  PetscMPIInt rank, size;

  *first = 0;
  *end   = surface->n_faces;
  if (surface->group) return;
  (void)MPI_Comm_rank(surface->mesh->comm, &rank);
  (void)MPI_Comm_size(surface->mesh->comm, &size);
  *first = surface->n_faces / size * rank + PetscMin(rank, surface->n_faces % size);
  *end   = *first + surface->n_faces / size + (rank < surface->n_faces % size);
}

static PetscInt SurfaceNodes(ContactSurface surface)
{
  return surface->rigid ? surface->rigid->n_nodes : surface->mesh->n_nodes;
}

/* Number of a point by its node; a new one if there is none yet. */
static PetscInt PointOf(Side side, PetscInt *number, PetscInt node)
{
  if (number[node] < 0) {
    number[node]               = side->n_points;
    side->node[side->n_points] = node;
    side->n_points++;
  }
  return number[node];
}

/* Sums values of the points over the pieces of all ranks; n components for each. */
static PetscErrorCode SumPoints(Side side, int n, PetscReal *values)
{
  const Mesh  mesh = side->surface->mesh;
  PetscReal  *all;
  PetscMPIInt ranks;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(mesh->comm, &ranks));
  if (ranks == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(n * mesh->n_nodes, &all));
  for (PetscInt i = 0; i < side->n_points; i++)
    for (int k = 0; k < n; k++) all[n * side->node[i] + k] = values[n * i + k];
  PetscCall(MeshSumNodes(mesh, n, all));
  for (PetscInt i = 0; i < side->n_points; i++)
    for (int k = 0; k < n; k++) values[n * i + k] = all[n * side->node[i] + k];
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const PetscReal *SurfaceCoords(ContactSurface surface)
{
  return surface->rigid ? surface->rigid->coords : surface->mesh->coords;
}

/* Finds the axes across which planes of symmetry reflect the surface at its points. */
static void FindPlanes(Side side, int n_mirrors, const SurfaceImage *mirrors)
{
  const Mesh       mesh   = side->surface->mesh;
  const PetscReal *coords = SurfaceCoords(side->surface);

  for (PetscInt i = 0; i < side->n_points; i++) {
    for (int plane = 1; plane < n_mirrors; plane <<= 1) {
      if (!SurfaceOnPlane(mesh, &mirrors[plane], &coords[side->node[i] * side->dim])) continue;
      for (int d = 0; d < side->dim; d++)
        side->points[i].reflected[d] = side->points[i].reflected[d] || mirrors[plane].sign[d] < 0;
    }
  }
}

/* Adds the reflected faces to a direction of the surface at a point, which is the mean over all then. */
static void AddReflected(const Point *point, double direction[3])
{
  double kept[3], whole = 0, rest = 0;

  for (int d = 0; d < 3; d++) {
    kept[d] = point->reflected[d] ? 0 : direction[d];
    whole += direction[d] * direction[d];
    rest += kept[d] * kept[d];
  }
  if (rest > PIECE_IN_PLANE * PIECE_IN_PLANE * whole) memcpy(direction, kept, sizeof(kept));
}

/* Makes the pieces of one face. */
static void DivideFace(Side side, PetscInt f, PetscInt *number)
{
  const ContactSurface surface = side->surface;
  const MeshGroup     *group   = surface->group;
  const Facet         *face    = &surface->faces[f];
  int                  node[PIECE_MAX][3];
  const int            n = PieceDivide(face->type, node);

  for (int k = 0; k < n; k++) {
    Piece *piece = &side->pieces[side->n_pieces];

    *piece = (Piece){.face   = group ? group->face_tag[f] : surface->rigid->face_tag[f],
                     .size   = surface->face_size[f],
                     .height = surface->face_height[f],
                     .order  = surface->order,
                     .marks  = surface->face_marks ? surface->face_marks[f] : 0,
                     .body   = group ? surface->mesh->cell_body[group->face_cell[f]] : surface->body};
    for (int a = 0; a < side->dim; a++) {
      const PetscInt local = face->nodes[node[k][a]];

      side->corner[3 * side->n_pieces + a] = PointOf(side, number, local);
      piece->tag[a] = surface->rigid ? -1 - surface->rigid->node_tag[local] : surface->mesh->node_tag[local];
    }
    side->n_pieces++;
  }
}

/* Finds sums over the pieces around the points of a deformable body: sizes, heights, number. */
static PetscErrorCode MeasureBody(Side side, PetscReal *sum)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < side->n_pieces; k++) {
    for (int a = 0; a < side->dim; a++) {
      PetscReal *at = &sum[3 * side->corner[3 * k + a]];

      at[0] += side->pieces[k].size;
      at[1] += side->pieces[k].height;
      at[2] += 1;
    }
  }
  PetscCall(SumPoints(side, 3, sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the same of a tool, and the directions of its surface. All its faces are on each rank, its pieces are not.
   number: of the points of all nodes, -1 for nodes without one. */
static void MeasureTool(Side side, const PetscInt *number, PetscReal *sum)
{
  const ContactSurface surface = side->surface;

  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const Facet *face = &surface->faces[f];
    int          node[PIECE_MAX][3];
    const int    n = PieceDivide(face->type, node);

    for (int k = 0; k < n; k++) {
      Place X[3] = {{0}}, normal;

      for (int a = 0; a < side->dim; a++)
        for (int d = 0; d < side->dim; d++) X[a][d] = surface->rigid->coords[face->nodes[node[k][a]] * side->dim + d];
      PieceNormal(side->dim, (const Place *)X, normal);
      for (int a = 0; a < side->dim; a++) {
        const PetscInt i     = number[face->nodes[node[k][a]]];
        const double   angle = side->dim == 3 ? PieceAngle((const Place *)X, a) : 0;

        if (i < 0) continue;
        sum[3 * i] += surface->face_size[f];
        sum[3 * i + 2] += 1;
        for (int d = 0; d < 3; d++) {
          side->points[i].turns[d] += normal[d];
          side->points[i].ridge_turns[d] += angle * normal[d];
        }
      }
    }
  }
  for (PetscInt i = 0; i < side->n_points; i++) {
    AddReflected(&side->points[i], side->points[i].turns);
    AddReflected(&side->points[i], side->points[i].ridge_turns);
  }
}

/* Finds means of sizes and heights around the points, which do not change. */
static PetscErrorCode MeasurePoints(Side side, const PetscInt *number)
{
  PetscReal *sum;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(3 * side->n_points, &sum));
  if (side->surface->rigid)
    MeasureTool(side, number, sum);
  else
    PetscCall(MeasureBody(side, sum));
  for (PetscInt i = 0; i < side->n_points; i++) {
    side->points[i].size   = sum[3 * i] / sum[3 * i + 2];
    side->points[i].number = sum[3 * i + 2];
    side->points[i].order  = side->surface->order;
    side->points[i].side   = side->points[i].size / side->surface->order; /* a tool keeps this */
    side->points[i].height = sum[3 * i + 1] / sum[3 * i + 2];
  }
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the points their tags and bodies, and the marks of the faces around them on all ranks. */
static PetscErrorCode NamePoints(Side side)
{
  const MPI_Comm comm = side->surface->mesh->comm;
  FaceMarks      used = 0;
  PetscReal     *has;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < side->n_pieces; k++) {
    for (int a = 0; a < side->dim; a++) {
      Point *point = &side->points[side->corner[3 * k + a]];

      point->tag  = side->pieces[k].tag[a];
      point->body = side->pieces[k].body;
      point->marks |= side->pieces[k].marks;
    }
    used |= side->pieces[k].marks;
  }
  if (side->surface->rigid) PetscFunctionReturn(PETSC_SUCCESS); /* all its faces have the same marks */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &used, 1, MPI_UINT64_T, MPI_BOR, comm));
  PetscCall(PetscMalloc1(side->n_points, &has));
  for (FaceMarks mark = 1; mark && mark <= used; mark <<= 1) {
    if (!(used & mark)) continue;
    for (PetscInt i = 0; i < side->n_points; i++) has[i] = (side->points[i].marks & mark) != 0;
    PetscCall(SumPoints(side, 1, has));
    for (PetscInt i = 0; i < side->n_points; i++)
      if (has[i] > 0) side->points[i].marks |= mark;
  }
  PetscCall(PetscFree(has));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SideCreate - finds the pieces, points and edges of a surface on this rank.

  Collective

  Input Parameters:
+ surface   - borrowed
. loads     - give the places of tools; borrowed
. n_mirrors - number of mirror images
- mirrors   - of the pair; the surface goes on beyond their planes

  Output Parameter:
. out - free it with SideDestroy()
@*/
PetscErrorCode SideCreate(ContactSurface surface, Loads loads, int n_mirrors, const SurfaceImage *mirrors, Side *out)
{
  PetscInt first, end, *number, n = SurfaceNodes(surface);
  Side     side;

  PetscFunctionBeginUser;
  OwnFaces(surface, &first, &end);
  PetscCall(PetscNew(&side));
  side->surface = surface;
  side->loads   = loads;
  side->dim     = surface->mesh->dim;
  PetscCall(PetscMalloc1(n, &number));
  for (PetscInt i = 0; i < n; i++) number[i] = -1;
  PetscCall(PetscMalloc1(PetscMin(n, (end - first) * FACE_MAX_NODES), &side->node));
  PetscCall(PetscMalloc1((end - first) * PIECE_MAX, &side->pieces));
  PetscCall(PetscCalloc1((end - first) * PIECE_MAX * 3, &side->corner));
  for (PetscInt f = first; f < end; f++) DivideFace(side, f, number);
  PetscCall(PetscCalloc1(side->n_points, &side->points));
  FindPlanes(side, n_mirrors, mirrors);
  PetscCall(MeasurePoints(side, number));
  PetscCall(PetscFree(number));
  PetscCall(NamePoints(side));
  PetscCall(SideEdges(side));
  *out = side;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SideDestroy - frees a side.

  Collective

  Input/Output Parameter:
. side - NULL on return; may be NULL before
@*/
PetscErrorCode SideDestroy(Side *side)
{
  PetscFunctionBeginUser;
  if (!*side) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree((*side)->node));
  PetscCall(PetscFree((*side)->points));
  PetscCall(PetscFree((*side)->corner));
  PetscCall(PetscFree((*side)->edges));
  PetscCall(PetscFree((*side)->pieces));
  PetscCall(PetscFree(*side));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Places the points at one state. Rigid tools are where ToolsPlace() has put them. */
static void PlacePoints(Side side, int state, const PetscReal *u, PetscReal t)
{
  const ContactSurface surface = side->surface;
  const PetscReal     *coords  = SurfaceCoords(surface);

  for (PetscInt i = 0; i < side->n_points; i++) {
    Point         *point = &side->points[i];
    const PetscInt node  = side->node[i];

    for (int d = 0; d < side->dim; d++) point->X[d] = coords[node * side->dim + d];
    if (surface->rigid)
      LoadsRigidMotion(side->loads, surface->body, t, point->X, point->x[state]);
    else
      for (int d = 0; d < side->dim; d++) point->x[state][d] = point->X[d] + u[node * side->dim + d];
  }
}

/* Sums over the pieces around each point of a deformable body: normals of both states, longest sides, normals at the
   end weighted by angles. */
enum { AROUND_NORMALS = 6, AROUND_RIDGE, AROUND = AROUND_RIDGE + 3 };

/* Finds the directions of a deformable surface at the points, of both states, and the mean side around them. */
static PetscErrorCode PointsAround(Side side)
{
  PetscReal *sum;

  PetscFunctionBeginUser;
  if (side->surface->rigid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(AROUND * side->n_points, &sum));
  for (PetscInt k = 0; k < side->n_pieces; k++) {
    const Piece *piece = &side->pieces[k];

    for (int a = 0; a < side->dim; a++) {
      PetscReal   *at    = &sum[AROUND * side->corner[3 * k + a]];
      const double angle = side->dim == 3 ? PieceAngle((const Place *)piece->x[1], a) : 0;

      for (int i = 0; i < AROUND_NORMALS; i++) at[i] += piece->normal[i / 3][i % 3];
      at[AROUND_NORMALS] += piece->side;
      for (int d = 0; d < 3; d++) at[AROUND_RIDGE + d] += angle * piece->normal[1][d];
    }
  }
  PetscCall(SumPoints(side, AROUND, sum));
  for (PetscInt i = 0; i < side->n_points; i++) {
    for (int state = 0; state < 2; state++) AddReflected(&side->points[i], &sum[AROUND * i + 3 * state]);
    AddReflected(&side->points[i], &sum[AROUND * i + AROUND_RIDGE]);
    memcpy(side->points[i].normal, &sum[AROUND * i], AROUND_NORMALS * sizeof(PetscReal));
    memcpy(side->points[i].ridge, &sum[AROUND * i + AROUND_RIDGE], sizeof(Place));
    side->points[i].side = sum[AROUND * i + AROUND_NORMALS] / side->points[i].number;
  }
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds how sharp the surface is at the points at the end. The normals of two flanks with the turn phi add up to
   2 cos(phi/2). */
static void FindTips(Side side)
{
  for (PetscInt i = 0; i < side->n_points; i++) {
    Point        *point  = &side->points[i];
    const double *n      = point->normal[1];
    const double  cosine = fmin(1, sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / point->number);

    point->tip = fmin(PIECE_TIP, sqrt(1 - cosine * cosine) / fmax(cosine, 0.5));
  }
  for (PetscInt k = 0; k < side->n_pieces; k++) {
    for (int a = 0; a < side->dim; a++) side->pieces[k].tip[a] = side->points[side->corner[3 * k + a]].tip;
  }
}

/*@
  SideMove - places pieces and points at the two ends of a step.

  Collective

  Input Parameters:
+ side - the side
. u    - local displacements at both ends, of all nodes of the mesh (length)
- t    - load parameters of both ends

  Note:
  Tools are left where they are at the second end.
@*/
PetscErrorCode SideMove(Side side, const PetscReal *const u[2], const PetscReal t[2])
{
  PetscFunctionBeginUser;
  for (int state = 0; state < 2; state++) {
    if (side->surface->rigid) ToolsPlace(side->surface->mesh, u[state], t[state]);
    PlacePoints(side, state, u[state], t[state]);
    for (PetscInt i = 0; i < side->n_points && side->surface->rigid; i++) {
      Point *point = &side->points[i];

      LoadsRigidTurn(side->loads, side->surface->body, t[state], point->turns, point->normal[state]);
      if (state) LoadsRigidTurn(side->loads, side->surface->body, t[state], point->ridge_turns, point->ridge);
    }
  }
  for (PetscInt k = 0; k < side->n_pieces; k++) {
    Piece *piece = &side->pieces[k];

    for (int a = 0; a < side->dim; a++) {
      const Point *point = &side->points[side->corner[3 * k + a]];

      memcpy(piece->X[a], point->X, sizeof(Place));
      for (int state = 0; state < 2; state++) memcpy(piece->x[state][a], point->x[state], sizeof(Place));
    }
    PiecePlace(piece, side->dim);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SideMeasure - finds the directions of the surface, how far it is from a smooth one, and where contact pressed.

  Collective

  Input Parameters:
+ side   - after SideMove()
- closed - of each node of the mesh: above 0 where a term pressed at one of the ends
@*/
PetscErrorCode SideMeasure(Side side, const PetscReal *closed)
{
  PetscFunctionBeginUser;
  PetscCall(PointsAround(side));
  for (PetscInt i = 0; i < side->n_points; i++)
    side->points[i].closed = !side->surface->rigid && closed[side->node[i]] > 0;
  FindTips(side);
  for (PetscInt k = 0; k < side->n_pieces; k++) {
    Piece *piece = &side->pieces[k];
    Place  normal[3];

    piece->closed = 0;
    for (int a = 0; a < side->dim; a++) {
      const Point *point = &side->points[side->corner[3 * k + a]];

      piece->closed |= point->closed;
      memcpy(normal[a], point->normal[1], sizeof(Place));
    }
    for (int a = 0; a < 3 && side->dim == 3; a++) {
      const Point *one   = &side->points[side->corner[3 * k + a]],
                  *other = &side->points[side->corner[3 * k + (a + 1) % 3]];

      PieceAcross((const Place *)piece->x[1], a, one->ridge, other->ridge, piece->across[a]);
    }
    piece->sagitta = PieceHeight(side->dim, (const Place *)piece->x[1], (const Place *)normal, PIECE_COSINE);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SideBox - computes the box that the side sweeps on this rank.

  Not collective

  Input Parameter:
. side - after SideMove()

  Output Parameter:
. box - the lower corner is above the upper one where there are no points
@*/
void SideBox(Side side, Box box)
{
  BoxAround(0, NULL, box);
  for (PetscInt k = 0; k < side->n_pieces; k++) {
    const Piece *piece = &side->pieces[k];

    for (int d = 0; d < 3; d++) {
      box[d]     = PetscMin(box[d], piece->box[d]);
      box[3 + d] = PetscMax(box[3 + d], piece->box[3 + d]);
    }
  }
}
