/* A face of a contact surface with its nodes' keys and positions, on its way to a rank that needs it. Plain bytes: the
   ranks of one run have one architecture. */
#pragma once
#include "search/facequadrature.h"
#include "search/nodegeometry.h"

typedef struct {
  Facet        facet; /* nodes: numbers in id[] order on arrival, then whatever the receiver numbers them by */
  PetscReal    size;
  PetscInt     id[FACE_MAX_NODES], owner[FACE_MAX_NODES], local[FACE_MAX_NODES];
  PetscReal    X[FACE_MAX_NODES * 3];
  NodeGeometry geometry[FACE_MAX_NODES];     /* where fits need it */
  PetscReal    offset[FACE_RULE_POINTS * 3]; /* of its quadrature points, where they have one */
  PetscInt     home, home_face;              /* which rank and which of its faces it is */
} FaceRecord;

/* A node of a contact surface, wherever it is owned */
typedef struct {
  PetscInt  id, owner, local;
  PetscReal X[3];
} NodeKey;

/* Face f of the surface as a record. geometry: by local node, or NULL; offset: [faces][FACE_RULE_POINTS*dim], or NULL.
 * Not collective. */
void FaceRecordFromSurface(ContactSurface, const NodeGeometry *geometry, const PetscReal *offset, PetscInt f,
                           FaceRecord *);
/* Does rank r want face f of this rank? */
typedef PetscBool (*FaceWantedFn)(const void *context, PetscInt f, PetscMPIInt r);
/* Sends this rank's faces to the ranks that want them; what arrives is the caller's to free. Collective. */
PetscErrorCode FaceRecordsShare(ContactSurface, const NodeGeometry *, const PetscReal *offset, FaceWantedFn,
                                const void *context, PetscInt *n, FaceRecord **received);
/* Sorts by the faces' tags. */
void FaceRecordsSort(PetscInt n, FaceRecord *);
/* The keys of a record's nodes, [nodes] */
void FaceRecordKeys(const FaceRecord *, NodeKey *);
/* Sorts keys by id and drops repeated ones; returns how many remain. */
PetscInt NodeKeysUnique(PetscInt n, NodeKey *);
/* Place of an id among sorted keys, which hold it. */
int NodeKeysFind(PetscInt n, const NodeKey *, PetscInt id);
