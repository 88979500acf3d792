/* Bodies that lie in each other before any load: what surfaces alone do not show. A surface that is deeper in the other
   body than the search reaches finds no master, or one that it is in front of, and the run would end well without
   contact. */
#include "contactimpl.h"
#include "base/refusal.h"
#include "mesh/mesh.h"
#include "mesh/meshlocate.h"

/* A cell whose centre lies in another body's cell, shrunk by this factor, is in that body, whatever the facets leave of
   a curved surface. */
#define IMMERSED_CORE 0.75

/* The same for a point that should be in a body: the factor by which cells are widened. */
#define IMMERSED_WIDE 1.000001

/* Points of all ranks. */
typedef struct {
  PetscInt   n;
  PetscReal *x;      /* n*dim (length) */
  PetscBool *inside; /* of one of the bodies that are asked for */
} ImmersedPoints;

/* Marks the bodies to which the faces of a surface belong, on all ranks. */
static PetscErrorCode MarkBodies(Mesh mesh, Scene scene, const MeshGroup *group, int *bodies)
{
  PetscFunctionBeginUser;
  for (int b = 0; b < scene->n_bodies; b++) bodies[b] = 0;
  for (PetscInt f = 0; f < group->n_faces; f++) bodies[mesh->cell_body[group->face_cell[f]]] = 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, bodies, scene->n_bodies, MPI_INT, MPI_LOR, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gathers points of all ranks and asks whether they are in one of the bodies. */
static PetscErrorCode AskBodies(Mesh mesh, int n_bodies, const int *bodies, double core, PetscInt n, const PetscReal *x,
                                ImmersedPoints *all)
{
  PetscMPIInt size, mine, total = 0, *counts, *starts;
  PetscBool  *inside;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(mesh->comm, &size));
  PetscCall(PetscMalloc2(size, &counts, size, &starts));
  PetscCall(PetscMPIIntCast(n * mesh->dim, &mine));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, counts, 1, MPI_INT, mesh->comm));
  for (PetscMPIInt r = 0; r < size; r++) {
    starts[r] = total;
    total += counts[r];
  }
  all->n = total / mesh->dim;
  PetscCall(PetscMalloc2(total, &all->x, all->n, &all->inside));
  PetscCallMPI(MPI_Allgatherv(x, mine, MPIU_REAL, all->x, counts, starts, MPIU_REAL, mesh->comm));
  PetscCall(PetscFree2(counts, starts));
  PetscCall(PetscArrayzero(all->inside, all->n));
  PetscCall(PetscMalloc1(all->n, &inside));
  for (int b = 0; b < n_bodies; b++) {
    if (!bodies[b]) continue;
    PetscCall(MeshPointsInBody(mesh, b, core, all->n, all->x, inside));
    for (PetscInt i = 0; i < all->n; i++) all->inside[i] = (PetscBool)(all->inside[i] || inside[i]);
  }
  PetscCall(PetscFree(inside));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Centre of a face, which its own cell has on its boundary, however curved it is. */
static void FaceCentre(Mesh mesh, const Facet *face, PetscReal *x)
{
  const Element *e     = ElementGet(face->type);
  double         xi[2] = {0, 0}, N[FACE_MAX_NODES], dN[FACE_MAX_NODES * 2];

  if (e->corners == 3) xi[0] = xi[1] = 1.0 / 3;
  ElementShape(e->type, xi, N, dN, NULL);
  for (int d = 0; d < mesh->dim; d++) x[d] = 0;
  for (int a = 0; a < e->nodes; a++)
    for (int d = 0; d < mesh->dim; d++) x[d] += N[a] * mesh->coords[face->nodes[a] * mesh->dim + d];
}

/* Mean of a cell's corners. */
static void CellCentre(Mesh mesh, PetscInt c, PetscReal *x)
{
  const int corners = ElementGet(mesh->cell_type[c])->corners;
  double    X[ELEMENT_MAX_NODES * 3];

  MeshCellCoordinates(mesh, c, X);
  for (int d = 0; d < mesh->dim; d++) x[d] = 0;
  for (int k = 0; k < corners; k++)
    for (int d = 0; d < mesh->dim; d++) x[d] += X[k * mesh->dim + d] / corners;
}

/* Centres of the cells behind the faces of a surface, or of the faces, but for faces with a node that is marked, for
   faces that are met, where these are given, and for those that a pair with slave and master treats. */
static PetscErrorCode Centres(Mesh mesh, ContactSurface surface, PetscBool faces, const PetscReal *mark,
                              const PetscBool *met, PetscInt *n, PetscReal *x)
{
  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const PetscInt c      = surface->group->face_cell[f];
    const Facet   *face   = &surface->faces[f];
    PetscBool      marked = PETSC_FALSE;

    for (int a = 0; a < ElementGet(face->type)->nodes; a++)
      marked = (PetscBool)(marked || (mark && mark[face->nodes[a]] > 0));
    if (marked || (met && met[f]) || (surface->face_marks && surface->face_marks[f])) continue;
    if (faces)
      FaceCentre(mesh, face, &x[*n * mesh->dim]);
    else
      CellCentre(mesh, c, &x[*n * mesh->dim]);
    (*n)++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the centre of a cell behind one surface, or of a face of it, that is in the bodies of the other. */
static PetscErrorCode FindImmersed(Mesh mesh, int n_bodies, const int *bodies, ContactSurface surface, PetscBool faces,
                                   const PetscReal *mark, const PetscBool *met, PetscReal X[3], PetscBool *found)
{
  PetscInt       n;
  PetscReal     *x;
  ImmersedPoints all;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(surface->n_faces * mesh->dim, &x));
  PetscCall(Centres(mesh, surface, faces, mark, met, &n, x));
  PetscCall(AskBodies(mesh, n_bodies, bodies, IMMERSED_CORE, n, x, &all));
  *found = PETSC_FALSE;
  for (PetscInt i = 0; i < all.n && !*found; i++) {
    *found = all.inside[i];
    for (int d = 0; d < 3; d++) X[d] = d < mesh->dim ? all.x[i * mesh->dim + d] + mesh->centre[d] : 0;
  }
  PetscCall(PetscFree2(all.x, all.inside));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Places of the nodes of a pair that overlap and of their images, and points that are twice as deep. */
static void OverlapPoints(Contact contact, const ContactPair *pair, PetscInt *n, PetscReal *x, PetscReal *y)
{
  const Mesh mesh = contact->mesh;
  const int  dim  = mesh->dim;

  *n = 0;
  for (PetscInt c = 0; c < pair->n_sides; c++) {
    const PetscReal *X = &mesh->coords[pair->node[c] * dim];

    if (!(pair->now.gap[c] + ContactEndDepth(pair, c) < -ContactTouchTolerance(pair, c))) continue;
    for (int m = 0; m < pair->n_images; m++, (*n)++) {
      PetscReal deeper[3];

      for (int d = 0; d < dim; d++) deeper[d] = X[d] + pair->now.gap[c] * pair->normal[3 * c + d];
      SurfaceReflect(&pair->images[m], dim, X, &x[*n * dim]);
      SurfaceReflect(&pair->images[m], dim, deeper, &y[*n * dim]);
    }
  }
}

/* Says whether most nodes that overlap are deeper than half the wall of the master. A point twice as deep is then
   beyond the wall. A node past the end of the master's surface, which the surface goes on to in thought, is in no
   wall. */
static PetscErrorCode OverlapIsDeep(Contact contact, const ContactPair *pair, const int *bodies, PetscBool *deep)
{
  const Mesh     mesh = contact->mesh;
  PetscInt       n = 0, beyond = 0, within = 0;
  PetscReal     *x, *y;
  ImmersedPoints at, deeper;

  PetscFunctionBeginUser;
  PetscCall(
    PetscMalloc2(pair->n_sides * pair->n_images * mesh->dim, &x, pair->n_sides * pair->n_images * mesh->dim, &y));
  OverlapPoints(contact, pair, &n, x, y);
  PetscCall(AskBodies(mesh, contact->scene->n_bodies, bodies, IMMERSED_WIDE, n, x, &at));
  PetscCall(AskBodies(mesh, contact->scene->n_bodies, bodies, IMMERSED_WIDE, n, y, &deeper));
  for (PetscInt i = 0; i < at.n; i += pair->n_images) {
    PetscBool inside = PETSC_FALSE, node = PETSC_FALSE;

    for (int m = 0; m < pair->n_images; m++) {
      node   = (PetscBool)(node || at.inside[i + m]);
      inside = (PetscBool)(inside || deeper.inside[i + m]);
    }
    within += node;
    beyond += node && !inside;
  }
  *deep = (PetscBool)(2 * beyond > within);
  PetscCall(PetscFree2(at.x, at.inside));
  PetscCall(PetscFree2(deeper.x, deeper.inside));
  PetscCall(PetscFree2(x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds a face of a listed surface that lies in the master's bodies, though none of its nodes has found a master: it is
   deeper than points are taken to have entered what faces them. room: by local node */
static PetscErrorCode FindPointless(Contact contact, const ContactPair *pair, const int *bodies, PetscReal *room,
                                    PetscReal X[3], PetscBool *found)
{
  const Mesh mesh = contact->mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(room, mesh->n_nodes));
  for (PetscInt c = 0; c < pair->n_nodes; c++)
    room[pair->node[c]] = !PetscIsNanReal(pair->now.gap[ContactNodeTerm(pair, &pair->now, c)]);
  PetscCall(MeshSumNodes(mesh, 1, room));
  PetscCall(FindImmersed(mesh, contact->scene->n_bodies, bodies, pair->slave, PETSC_TRUE, room, NULL, X, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds a face of a listed surface that lies in cells of its own bodies, though none of its points has found a master:
   parts of one body, which share no nodes, lie in each other. The cell below a face, shrunk, does not hold its centre.
   bodies: of the surface */
static PetscErrorCode FindHidden(Contact contact, const ContactPair *pair, const int *bodies, PetscReal X[3],
                                 PetscBool *found)
{
  const SlavePoints points = pair->slaves;
  const PetscInt    faces  = pair->slave->n_faces;
  int              *has, *any;
  PetscBool        *met;

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  if (!points->face_sf) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc3(points->n_faces, &has, faces, &any, faces, &met));
  for (PetscInt f = 0; f < points->n_faces; f++)
    for (PetscInt q = points->first[f]; q < points->first[f + 1]; q++)
      has[f] = has[f] || !PetscIsNanReal(pair->point_gap[q]);
  PetscCall(PetscSFReduceBegin(points->face_sf, MPI_INT, has, any, MPI_MAX));
  PetscCall(PetscSFReduceEnd(points->face_sf, MPI_INT, has, any, MPI_MAX));
  for (PetscInt f = 0; f < faces; f++) met[f] = (PetscBool)any[f];
  PetscCall(
    FindImmersed(contact->mesh, contact->scene->n_bodies, bodies, pair->slave, PETSC_TRUE, NULL, met, X, found));
  PetscCall(PetscFree3(has, any, met));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactRefuseImmersed - refuses a pair whose bodies lie in the same place, or overlap by more than half a wall.

  Collective

  Input Parameters:
+ contact - the contact, after ContactResidual() with forces at the undeformed state
- p       - number of the pair

  Note:
  Smaller overlaps are left to the scene's initial_overlap.
@*/
PetscErrorCode ContactRefuseImmersed(Contact contact, int p)
{
  const ContactPair *pair  = &contact->pairs[p];
  Mesh               mesh  = contact->mesh;
  Scene              scene = contact->scene;
  int               *slave, *master, same = 0;
  PetscReal         *overlaps, X[3];
  PetscBool          found = PETSC_FALSE, deep = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!pair->master || pair->master->rigid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(scene->n_bodies, &slave, scene->n_bodies, &master));
  PetscCall(MarkBodies(mesh, scene, pair->slave->group, slave));
  PetscCall(MarkBodies(mesh, scene, pair->master->group, master));
  for (int b = 0; b < scene->n_bodies; b++) same = same || (slave[b] && master[b]);
  if (same && pair->scene->listed) PetscCall(FindHidden(contact, pair, slave, X, &found));
  if (!same) {
    int any = 0;

    PetscCall(PetscCalloc1(mesh->n_nodes, &overlaps));
    for (PetscInt c = 0; c < pair->n_nodes; c++)
      overlaps[pair->node[c]] = pair->now.gap[ContactNodeTerm(pair, &pair->now, c)] < 0;
    for (PetscInt c = 0; c < pair->n_sides; c++)
      any = any || pair->now.gap[c] + ContactEndDepth(pair, c) < -ContactTouchTolerance(pair, c);
    PetscCall(MeshSumNodes(mesh, 1, overlaps));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_LOR, mesh->comm));
    PetscCall(FindImmersed(mesh, scene->n_bodies, master, pair->slave, PETSC_FALSE, overlaps, NULL, X, &found));
    PetscCall(PetscArrayzero(overlaps, mesh->n_nodes));
    if (!found && !any)
      PetscCall(FindImmersed(mesh, scene->n_bodies, slave, pair->master, PETSC_FALSE, overlaps, NULL, X, &found));
    if (!found && pair->scene->listed) PetscCall(FindPointless(contact, pair, master, overlaps, X, &found));
    if (!found && any) PetscCall(OverlapIsDeep(contact, pair, master, &deep));
    PetscCall(PetscFree(overlaps));
  }
  PetscCall(PetscFree2(slave, master));
  if (found)
    PetscCall(
      RefuseInput(mesh->comm,
                  "%s: contact '%s': the bodies of '%s' and '%s' lie in each other before any load, as at (%.6g, "
                  "%.6g, %.6g), so deep that their surfaces do not meet; allowed: bodies that touch, are apart or "
                  "overlap by less than half a wall (move one of them)%s",
                  SceneWhere(scene, pair->scene->path, "master"), pair->scene->name, pair->scene->slave,
                  pair->scene->master, (double)X[0], (double)X[1], (double)X[2],
                  pair->scene->listed ? ", with surfaces by less than a quarter of an element's height, or a pair with "
                                        "slave and master"
                                      : ""));
  if (deep)
    PetscCall(RefuseInput(mesh->comm,
                          "%s: contact '%s': '%s' overlaps the body of '%s' by more than half of its wall before any "
                          "load; allowed: bodies that touch, are apart or overlap by less (move one of them)",
                          SceneWhere(scene, pair->scene->path, "master"), pair->scene->name, pair->scene->slave,
                          pair->scene->master));
  PetscFunctionReturn(PETSC_SUCCESS);
}
