/* The faces around a box, as records and candidates, for a search that is made there. */
#include "searchimpl.h"

/* Positions of a candidate's nodes as long as they are numbers of contact nodes. */
static void ImagePositions(ContactSearch s, NeighbourLists lists, const Candidate *c, PetscReal *x)
{
  const int dim = lists->dim;

  for (int a = 0; a < ElementGet(c->facet.type)->nodes; a++) {
    PetscReal y[3];

    for (int d = 0; d < dim; d++) y[d] = lists->X[c->facet.nodes[a] * dim + d] + lists->u[c->facet.nodes[a] * dim + d];
    SurfaceReflect(&s->images[c->image], dim, y, &x[a * dim]);
  }
}

/* Takes in how far the nodes of a candidate have moved before, from their displacements then. */
static void TakeWay(ContactSearch s, NeighbourLists lists, const PetscReal *before, Candidate *c)
{
  for (int d = 0; d < lists->dim; d++) {
    for (int a = 0; a < ElementGet(c->facet.type)->nodes; a++) {
      const PetscInt  i   = c->facet.nodes[a] * lists->dim + d;
      const PetscReal way = s->images[c->image].sign[d] * (lists->u[i] - before[i]);

      c->way_lower[d] = a ? PetscMin(c->way_lower[d], way) : way;
      c->way_upper[d] = a ? PetscMax(c->way_upper[d], way) : way;
    }
  }
}

/* Makes candidates of all faces and mirror images near a box, in an order that does not depend on the ranks. before:
   displacements of the contact nodes before, or NULL. */
static PetscErrorCode MakeCandidates(ContactSearch s, NeighbourLists lists, const PetscReal *before,
                                     const PetscReal box[6], PetscReal distance, SearchField *field)
{
  const int dim = lists->dim;
  PetscReal x[FACE_MAX_NODES * 3];

  PetscFunctionBeginUser;
  field->n_candidates = 0;
  PetscCall(PetscMalloc1(field->n_records * s->n_images, &field->candidates));
  for (PetscInt r = 0; r < field->n_records; r++) {
    const FaceRecord *record = &field->records[r];

    for (int m = 0; m < s->n_images; m++) {
      Candidate *c = &field->candidates[field->n_candidates];
      PetscReal  own[6];

      if (s->images[m].left_out) continue;
      *c           = (Candidate){.record = r,
                                 .image  = m,
                                 .piece  = record->piece,
                                 .facet  = SurfaceImageFacet(&record->facet, &s->images[m])};
      c->facet.tag = record->facet.tag * SURFACE_MAX_IMAGES + m;
      ImagePositions(s, lists, c, x);
      CandidatePlace(dim, x, record->size, c);
      for (int d = 0; d < 3; d++) {
        own[d]     = c->lower[d];
        own[3 + d] = c->upper[d];
      }
      if (!SearchBoxesMeet(own, box, dim, distance)) continue;
      if (before) TakeWay(s, lists, before, c);
      if (s->listed) CandidateHull(dim, x, c);
      field->n_candidates++;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the way from the master's faces, each on its own rank, to the faces that arrived on this rank. The caller
   destroys it. */
PetscErrorCode SearchFieldWay(ContactSearch s, const SearchField *field, PetscSF *faces)
{
  PetscSFNode *remote;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(field->n_records, &remote));
  for (PetscInt r = 0; r < field->n_records; r++)
    remote[r] = (PetscSFNode){field->records[r].home, field->records[r].home_face};
  PetscCall(PetscSFCreate(s->mesh->comm, faces));
  PetscCall(
    PetscSFSetGraph(*faces, s->master->n_faces, field->n_records, NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscSFSetUp(*faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fetches the maps of the faces that arrived. */
static PetscErrorCode FetchMaps(ContactSearch s, SearchField *field)
{
  PetscSF faces;

  PetscFunctionBeginUser;
  PetscCall(SearchFieldWay(s, field, &faces));
  PetscCall(FaceMapsFetch(faces, s->maps, &field->maps));
  PetscCall(PetscSFDestroy(&faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the faces of the master within a distance of the boxes, and takes in their largest present extent (length). */
static PetscErrorCode MarkNear(ContactSearch s, const PetscReal *u, PetscReal t, PetscInt n_boxes,
                               const PetscReal *boxes, PetscReal distance, PetscBool *some, PetscReal *extent)
{
  const int dim = s->mesh->dim;
  PetscReal x[FACE_MAX_NODES * 3], box[6];

  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < n_boxes; b++) {
    PetscInt n, *faces;

    PetscCall(SearchNearBox(s, s->master, u, t, &boxes[6 * b], distance, &n, &faces));
    for (PetscInt i = 0; i < n; i++) {
      PetscReal square = 0;

      some[faces[i]] = PETSC_TRUE;
      SearchFacePositions(s, s->master, faces[i], u, t, x);
      SearchFaceBox(dim, ElementGet(s->master->faces[faces[i]].type)->nodes, x, NULL, box);
      for (int d = 0; d < dim; d++) square += PetscSqr(box[3 + d] - box[d]);
      *extent = PetscMax(*extent, PetscSqrtReal(square));
    }
    PetscCall(PetscFree(faces));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the faces of the master whose nodes' geometry is needed, or from which it comes: the geometry of a node takes
   two rings of faces around it. A ring is no farther from the boxes than the one inside of it by the largest extent of
   a face there. Ranks agree where they share nodes. */
static PetscErrorCode MarkFaces(ContactSearch s, const PetscReal *u, PetscReal t, PetscInt n_boxes,
                                const PetscReal *boxes, PetscReal distance, PetscBool *some)
{
  enum { RINGS = 2 };

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(some, s->master->n_faces));
  for (int ring = 0; ring <= RINGS; ring++) {
    PetscReal extent = 0;

    PetscCall(MarkNear(s, u, t, n_boxes, boxes, distance, some, &extent));
    if (ring < RINGS && !s->master->rigid)
      PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &extent, 1, MPIU_REAL, MPIU_MAX, s->mesh->comm));
    distance += (1 + SEARCH_ON_PLANE) * extent; /* round-off leaves no face out that touches */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the geometry of the nodes of the faces within a distance of the boxes. */
static PetscErrorCode NodesGeometry(ContactSearch s, const PetscReal *u, PetscReal t, PetscInt n_boxes,
                                    const PetscReal *boxes, PetscReal distance, NodeGeometry *geometry)
{
  PetscBool *some;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->master->n_faces, &some));
  PetscCall(MarkFaces(s, u, t, n_boxes, boxes, distance, some));
  PetscCall(SurfaceNodeGeometry(s->master, s->scene->geometry, s->loads, u, t, some, geometry));
  PetscCall(PetscFree(some));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchFieldCreate - collects the faces around a box, and puts their nodes, images and points into lists.

  Collective

  Input Parameters:
+ s        - the search
. u        - local displacements u[mesh n_nodes*dim] (length), ghosts included
. t        - load parameter, for rigid tools
. box      - box of this rank, lower then upper corner
. distance - faces within this distance of the box are collected (length)
- fits     - fits are to be made, so that the faces bring the geometry of their nodes

  Output Parameters:
+ lists - the lists, still without slave points
- field - the faces as records and candidates

  Note:
  The caller frees the field with SearchFieldDestroy().
@*/
PetscErrorCode SearchFieldCreate(ContactSearch s, const PetscReal *u, PetscReal t, const PetscReal box[6],
                                 PetscReal distance, PetscBool fits, NeighbourLists lists, SearchField *field)
{
  Mesh          mesh = s->mesh;
  PetscMPIInt   size;
  PetscReal    *boxes, *before = NULL;
  NodeGeometry *geometry = NULL;
  const int     rigid    = s->master && s->master->rigid;

  PetscFunctionBeginUser;
  *field     = (SearchField){0};
  lists->dim = mesh->dim;
  ToolsPlace(mesh, u, t);
  PetscCall(SearchStateBegin(s));
  PetscCallMPI(MPI_Comm_size(mesh->comm, &size));
  PetscCall(PetscMalloc1(6 * size, &boxes));
  if (s->master && !rigid) PetscCallMPI(MPI_Allgather(box, 6, MPIU_REAL, boxes, 6, MPIU_REAL, mesh->comm));
  if (fits) {
    PetscCall(PetscMalloc1(rigid ? s->master->rigid->n_nodes : mesh->n_nodes, &geometry));
    PetscCall(NodesGeometry(s, u, t, rigid ? 1 : size, rigid ? box : boxes, distance, geometry));
  }
  if (!s->master)
    PetscCall(PetscMalloc1(0, &field->records));
  else if (rigid)
    PetscCall(SearchPickRigidFaces(s, geometry, t, box, distance, &field->n_records, &field->records));
  else
    PetscCall(SearchExchangeFaces(s, geometry, u, boxes, distance, &field->n_records, &field->records));
  PetscCall(PetscFree(boxes));
  PetscCall(SearchStateEnd(s));
  FaceRecordsSort(field->n_records, field->records);
  PetscCall(PetscFree(geometry));
  if (s->maps && s->maps->ptr) PetscCall(FetchMaps(s, field)); /* partners are sought before there are maps */
  PetscCall(NeighbourListsCreateNodes(s, field, lists));
  if (s->before.known) {
    PetscCall(PetscMalloc1(lists->n_nodes * lists->dim, &before));
    PetscCall(NeighbourListsUpdateNodes(s, lists, s->before.u, s->before.t));
    PetscCall(PetscArraycpy(before, lists->u, lists->n_nodes * lists->dim));
  }
  PetscCall(NeighbourListsUpdateNodes(s, lists, u, t));
  PetscCall(MakeCandidates(s, lists, before, box, distance, field));
  PetscCall(PetscFree(before));
  PetscCall(NeighbourListsCreatePoints(s, t, lists, field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchFieldDestroy - frees the faces that were collected.

  Not collective

  Input/Output Parameter:
. field - the faces
@*/
PetscErrorCode SearchFieldDestroy(SearchField *field)
{
  PetscFunctionBeginUser;
  PetscCall(FaceMapsDestroy(&field->maps));
  PetscCall(PetscFree(field->candidates));
  PetscCall(PetscFree(field->records));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchListsDistance - returns the distance (length) from the slave points within which faces are collected for lists.

  Not collective

  Input Parameters:
+ s      - the search
- motion - relative motion (length) for which the lists must be good
@*/
PetscReal SearchListsDistance(ContactSearch s, PetscReal motion)
{
  return s->reach + PetscMax(s->margin, SearchFitReach(s)) + 2 * motion;
}

static int CompareTags(const void *a, const void *b)
{
  const Candidate *p = a, *q = b;

  return p->facet.tag < q->facet.tag ? -1 : p->facet.tag > q->facet.tag;
}

/*@
  SearchFieldOwn - returns the candidate of a face of this rank, not of its images.

  Not collective

  Input Parameters:
+ field - the candidates
- face  - a face of the master
@*/
const Candidate *SearchFieldOwn(const SearchField *field, const Facet *face)
{
  const Candidate wanted = {.facet = {.tag = face->tag * SURFACE_MAX_IMAGES}};

  return bsearch(&wanted, field->candidates, field->n_candidates, sizeof(Candidate), CompareTags);
}
