/* A face of a contact surface with its nodes' keys and positions, in the form in which it is sent to a rank that needs
   it. A record is plain bytes, because the ranks of one run have one architecture.

   FaceRecordsShare() sends the faces of this rank to the ranks that want them, and FaceRecordsSort() puts what
   arrived into an order that does not depend on the ranks. FaceRecordFromSurface() makes a single record.
   FaceRecordKeys() gives the keys of its nodes; NodeKeysUnique() sorts keys, and NodeKeysFind() finds a node among
   them. */
#pragma once
#include "search/facequadrature.h"
#include "search/nodegeometry.h"

typedef struct {
  /* Nodes: numbers in the order of id[] on arrival, then the receiver's own numbers. */
  Facet        facet;
  PetscReal    size, height;
  PetscInt     id[FACE_MAX_NODES], owner[FACE_MAX_NODES], local[FACE_MAX_NODES];
  PetscReal    X[FACE_MAX_NODES * 3];
  NodeGeometry geometry[FACE_MAX_NODES];     /* where fits need it */
  PetscReal    offset[FACE_RULE_POINTS * 3]; /* of its quadrature points, where they have one (length) */
  PetscInt     home, home_face;              /* the face's rank, and its number there */
  FaceMarks    marks;
  PetscInt     piece; /* of the mesh, 0 where it is not sought */
  int          ends;  /* see surfaceends.h */
} FaceRecord;

/* A node of a contact surface, whichever rank owns it. */
typedef struct {
  PetscInt  id, owner, local;
  PetscReal X[3];
} NodeKey;

void           FaceRecordFromSurface(ContactSurface, const NodeGeometry *geometry, const PetscReal *offset, PetscInt f,
                                     FaceRecord *);
PetscErrorCode FaceRecordsShare(ContactSurface, const NodeGeometry *, const PetscReal *offset, const PetscInt count[],
                                const PetscInt faces[], PetscInt *n, FaceRecord **received);
void           FaceRecordsSort(PetscInt n, FaceRecord *);
void           FaceRecordKeys(const FaceRecord *, NodeKey *);
PetscInt       NodeKeysUnique(PetscInt n, NodeKey *);
int            NodeKeysFind(PetscInt n, const NodeKey *, PetscInt id);
