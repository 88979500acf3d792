#include "searchimpl.h"

static void BoxEmpty(PetscReal box[6])
{
  for (int d = 0; d < 3; d++) {
    box[d]     = PETSC_MAX_REAL;
    box[3 + d] = PETSC_MIN_REAL;
  }
}

static void BoxAdd(PetscReal box[6], int dim, const PetscReal *x)
{
  for (int d = 0; d < dim; d++) {
    box[d]     = PetscMin(box[d], x[d]);
    box[3 + d] = PetscMax(box[3 + d], x[d]);
  }
}

PetscBool SearchBoxesMeet(const PetscReal *a, const PetscReal *b, int dim, PetscReal distance)
{
  for (int d = 0; d < dim; d++)
    if (a[d] > b[3 + d] + distance || b[d] > a[3 + d] + distance) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Box of the slave points of this rank at displacement u. */
void SearchSlaveBox(ContactSearch s, const PetscReal *u, PetscReal box[6])
{
  const int dim = s->mesh->dim;

  BoxEmpty(box);
  for (PetscInt i = 0; i < s->n_slaves; i++) {
    PetscReal x[3];

    for (int d = 0; d < dim; d++) x[d] = s->mesh->coords[s->slaves[i] * dim + d] + u[s->slaves[i] * dim + d];
    BoxAdd(box, dim, x);
  }
}

static PetscBool SomeImageMeets(ContactSearch s, int n, const PetscReal *x, const PetscReal box[6], PetscReal distance)
{
  const int dim = s->mesh->dim;

  for (int m = 0; m < s->n_images; m++) {
    PetscReal face[6], y[3];

    BoxEmpty(face);
    for (int a = 0; a < n; a++) {
      SurfaceReflect(&s->images[m], dim, &x[a * dim], y);
      BoxAdd(face, dim, y);
    }
    if (SearchBoxesMeet(face, box, dim, distance)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static void RecordFromMesh(ContactSearch s, const NodeGeometry *geometry, PetscInt f, FaceRecord *record)
{
  Mesh         mesh  = s->mesh;
  const Facet *facet = &s->master->faces[f];

  *record = (FaceRecord){.facet = *facet, .size = s->master->face_size[f]};
  for (int a = 0; a < ElementGet(facet->type)->nodes; a++) {
    const PetscInt node = facet->nodes[a];

    record->id[a]    = mesh->node_id[node];
    record->owner[a] = mesh->node_owner[node];
    record->local[a] = mesh->node_owner_local[node];
    if (geometry) record->geometry[a] = geometry[node];
    for (int d = 0; d < mesh->dim; d++) record->X[a * 3 + d] = mesh->coords[node * mesh->dim + d];
  }
}

/* Sends this rank's faces of a deformable master to every rank whose slaves they may reach; returns what arrived (itself included). */
PetscErrorCode SearchExchangeFaces(ContactSearch s, const NodeGeometry *geometry, const PetscReal *u, const PetscReal *boxes, PetscReal distance,
                                   PetscInt *n_records, FaceRecord **records)
{
  Mesh        mesh = s->mesh;
  const int   dim  = mesh->dim;
  PetscMPIInt size, *send_bytes, *send_start, *receive_bytes, *receive_start;
  PetscInt    total = 0, *count, room;
  FaceRecord *send;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(mesh->comm, &size));
  PetscCall(PetscMalloc5(size, &send_bytes, size, &send_start, size, &receive_bytes, size, &receive_start, size, &count));
  PetscCall(PetscArrayzero(count, size));
  room = PetscMax(1, s->master->n_faces);
  PetscCall(PetscMalloc1(room, &send));
  for (PetscMPIInt r = 0; r < size; r++) {
    PetscCall(PetscMPIIntCast(total * (PetscInt)sizeof(FaceRecord), &send_start[r]));
    for (PetscInt f = 0; f < s->master->n_faces; f++) {
      const Facet *facet = &s->master->faces[f];
      const int    n     = ElementGet(facet->type)->nodes;
      PetscReal    x[FACE_MAX_NODES * 3];

      for (int a = 0; a < n; a++)
        for (int d = 0; d < dim; d++) x[a * dim + d] = mesh->coords[facet->nodes[a] * dim + d] + u[facet->nodes[a] * dim + d];
      if (!SomeImageMeets(s, n, x, &boxes[6 * r], distance)) continue;
      if (total == room) PetscCall(PetscRealloc((room *= 2) * sizeof(FaceRecord), &send));
      RecordFromMesh(s, geometry, f, &send[total++]);
      count[r]++;
    }
    PetscCall(PetscMPIIntCast(count[r] * (PetscInt)sizeof(FaceRecord), &send_bytes[r]));
  }
  PetscCallMPI(MPI_Alltoall(send_bytes, 1, MPI_INT, receive_bytes, 1, MPI_INT, mesh->comm));
  total = 0;
  for (PetscMPIInt r = 0; r < size; r++) {
    PetscCall(PetscMPIIntCast(total, &receive_start[r]));
    total += receive_bytes[r];
  }
  *n_records = total / (PetscInt)sizeof(FaceRecord);
  PetscCall(PetscMalloc1(*n_records, records));
  PetscCallMPI(MPI_Alltoallv(send, send_bytes, send_start, MPI_BYTE, *records, receive_bytes, receive_start, MPI_BYTE, mesh->comm));
  PetscCall(PetscFree(send));
  PetscCall(PetscFree5(send_bytes, send_start, receive_bytes, receive_start, count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where node n of the rigid tool is at t, relative to the mesh's centre. */
void SearchRigidPosition(ContactSearch s, PetscInt n, PetscReal t, PetscReal x[3])
{
  const int dim  = s->mesh->dim;
  PetscReal X[3] = {0, 0, 0};

  for (int d = 0; d < dim; d++) X[d] = s->master->rigid->coords[n * dim + d];
  LoadsRigidMotion(s->loads, s->master->body, t, X, x);
}

/* The faces of a rigid tool that come near this rank's slaves; every rank has them all. */
PetscErrorCode SearchPickRigidFaces(ContactSearch s, const NodeGeometry *geometry, PetscReal t, const PetscReal box[6], PetscReal distance, PetscInt *n_records,
                                    FaceRecord **records)
{
  const int dim = s->mesh->dim;

  PetscFunctionBeginUser;
  *n_records = 0;
  PetscCall(PetscMalloc1(s->master->n_faces, records));
  for (PetscInt f = 0; f < s->master->n_faces; f++) {
    const Facet *facet = &s->master->faces[f];
    const int    n     = ElementGet(facet->type)->nodes;
    PetscReal    x[FACE_MAX_NODES * 3];

    for (int a = 0; a < n; a++) {
      PetscReal y[3];

      SearchRigidPosition(s, facet->nodes[a], t, y);
      for (int d = 0; d < dim; d++) x[a * dim + d] = y[d];
    }
    if (!SomeImageMeets(s, n, x, box, distance)) continue;
    (*records)[*n_records] = (FaceRecord){.facet = *facet, .size = s->master->face_size[f]};
    for (int a = 0; a < n; a++) {
      (*records)[*n_records].id[a] = facet->nodes[a];
      if (geometry) (*records)[*n_records].geometry[a] = geometry[facet->nodes[a]];
    }
    (*n_records)++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
