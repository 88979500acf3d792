/* Faces and node keys: making, sending and sorting them. */
#include "search/facerecord.h"
#include "base/exchange.h"

/*@
  FaceRecordFromSurface - makes a record of a face of a surface, with its nodes' keys and reference positions.

  Not collective

  Input Parameters:
+ surface  - the surface
. geometry - by local node of the mesh or the tool, or NULL
. offset   - offset[faces][FACE_RULE_POINTS*dim] (length), or NULL
- f        - number of the face on this rank

  Output Parameter:
. record - the record, whose home is left 0
@*/
void FaceRecordFromSurface(ContactSurface surface, const NodeGeometry *geometry, const PetscReal *offset, PetscInt f,
                           FaceRecord *record)
{
  Mesh         mesh  = surface->mesh;
  const int    dim   = mesh->dim;
  const Facet *facet = &surface->faces[f];

  *record =
    (FaceRecord){.facet = *facet, .size = surface->face_size[f], .height = surface->face_height[f], .home_face = f};
  if (surface->face_marks) record->marks = surface->face_marks[f];
  if (surface->face_piece) record->piece = surface->face_piece[f];
  if (surface->face_ends) record->ends = surface->face_ends[f];
  for (int a = 0; a < ElementGet(facet->type)->nodes; a++) {
    const PetscInt node = facet->nodes[a];

    record->id[a] = surface->rigid ? node : mesh->node_id[node];
    if (geometry) record->geometry[a] = geometry[node];
    if (surface->rigid) continue;
    record->owner[a] = mesh->node_owner[node];
    record->local[a] = mesh->node_owner_local[node];
    for (int d = 0; d < dim; d++) record->X[a * 3 + d] = mesh->coords[node * dim + d];
  }
  for (int i = 0; offset && i < FACE_RULE_POINTS * dim; i++) record->offset[i] = offset[f * FACE_RULE_POINTS * dim + i];
}

/* The faces that are sent, and of what surface. */
typedef struct {
  ContactSurface      surface;
  const NodeGeometry *geometry;
  const PetscReal    *offset;
  const PetscInt     *faces;
  PetscMPIInt         rank;
} Sending;

static void PackFace(const void *context, PetscInt i, void *packed)
{
  const Sending *sending = context;
  FaceRecord    *record  = packed;

  FaceRecordFromSurface(sending->surface, sending->geometry, sending->offset, sending->faces[i], record);
  record->home = sending->rank;
}

/*@
  FaceRecordsShare - sends faces of this rank to the ranks that want them, itself included.

  Collective

  Input Parameters:
+ surface  - the surface
. geometry - as in FaceRecordFromSurface()
. offset   - as in FaceRecordFromSurface()
. count    - count[ranks]: number of faces that each rank wants
- faces    - these faces, rank after rank

  Output Parameters:
+ n        - number of records that arrived
- received - the records, in the order of the ranks from which they come

  Note:
  The caller frees received with PetscFree().
@*/
PetscErrorCode FaceRecordsShare(ContactSurface surface, const NodeGeometry *geometry, const PetscReal *offset,
                                const PetscInt count[], const PetscInt faces[], PetscInt *n, FaceRecord **received)
{
  const MPI_Comm comm    = surface->mesh->comm;
  Sending        sending = {.surface = surface, .geometry = geometry, .offset = offset, .faces = faces};
  PetscMPIInt    size, *to;
  PetscInt       total = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_rank(comm, &sending.rank));
  for (PetscMPIInt r = 0; r < size; r++) total += count[r];
  PetscCall(PetscMalloc1(total, &to));
  total = 0;
  for (PetscMPIInt r = 0; r < size; r++)
    for (PetscInt i = 0; i < count[r]; i++) to[total++] = r;
  PetscCall(ExchangeRecords(comm, sizeof(FaceRecord), total, to, PackFace, &sending, n, (void **)received));
  PetscCall(PetscFree(to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FaceRecordKeys - writes the keys of a record's nodes.

  Not collective

  Input Parameter:
. record - the record

  Output Parameter:
. keys - keys[nodes of the face], in the face's order
@*/
void FaceRecordKeys(const FaceRecord *record, NodeKey *keys)
{
  for (int a = 0; a < ElementGet(record->facet.type)->nodes; a++) {
    keys[a] = (NodeKey){.id = record->id[a], .owner = record->owner[a], .local = record->local[a]};
    for (int d = 0; d < 3; d++) keys[a].X[d] = record->X[a * 3 + d];
  }
}

static int FaceRecordCompare(const void *a, const void *b)
{
  const FaceRecord *p = a, *q = b;
  return p->facet.tag < q->facet.tag ? -1 : p->facet.tag > q->facet.tag;
}

static int NodeKeyCompare(const void *a, const void *b)
{
  const NodeKey *p = a, *q = b;
  return p->id < q->id ? -1 : p->id > q->id;
}

/*@
  NodeKeysUnique - sorts keys by id and drops repeated ones.

  Not collective

  Input Parameter:
. n - number of keys

  Input/Output Parameter:
. keys - keys[n], sorted in place

  Note:
  Returns the number of keys that remain.
@*/
PetscInt NodeKeysUnique(PetscInt n, NodeKey *keys)
{
  PetscInt kept = 0;

  if (n) qsort(keys, n, sizeof(*keys), NodeKeyCompare);
  for (PetscInt i = 0; i < n; i++)
    if (!kept || keys[i].id != keys[kept - 1].id) keys[kept++] = keys[i];
  return kept;
}

/*@
  FaceRecordsSort - sorts records by the faces' tags, an order that does not depend on the ranks.

  Not collective

  Input Parameter:
. n - number of records

  Input/Output Parameter:
. records - the records
@*/
void FaceRecordsSort(PetscInt n, FaceRecord *records)
{
  if (n) qsort(records, n, sizeof(*records), FaceRecordCompare);
}

/*@
  NodeKeysFind - finds the position of an id among sorted keys.

  Not collective

  Input Parameters:
+ n    - number of keys
. keys - of NodeKeysUnique()
- id   - an id that is among them
@*/
int NodeKeysFind(PetscInt n, const NodeKey *keys, PetscInt id)
{
  const NodeKey  wanted = {.id = id};
  const NodeKey *found  = bsearch(&wanted, keys, n, sizeof(*keys), NodeKeyCompare);

  return (int)(found - keys);
}
