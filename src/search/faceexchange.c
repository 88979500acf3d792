/* The exchange of master faces: those that may reach the boxes of the ranks. */
#include "searchimpl.h"

/*@
  SearchExchangeFaces - sends this rank's faces of a deformable master to every rank whose box they may reach, itself
  included.

  Collective

  Input Parameters:
+ s        - the search
. geometry - geometry of the nodes, or NULL
. u        - local displacements (length)
. boxes    - boxes of all ranks, 6 entries each
- distance - reach of the faces (length)

  Output Parameters:
+ n_records - number of faces that arrived
- records   - these faces, to be freed with PetscFree()
@*/
PetscErrorCode SearchExchangeFaces(ContactSearch s, const NodeGeometry *geometry, const PetscReal *u,
                                   const PetscReal *boxes, PetscReal distance, PetscInt *n_records,
                                   FaceRecord **records)
{
  PetscMPIInt size;
  PetscInt   *count, *faces = NULL, total = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(s->mesh->comm, &size));
  PetscCall(PetscMalloc1(size, &count));
  for (PetscMPIInt r = 0; r < size; r++) {
    PetscInt *near;

    PetscCall(SearchNearBox(s, s->master, u, 0, &boxes[6 * r], distance, &count[r], &near));
    PetscCall(PetscRealloc((total + count[r]) * sizeof(*faces), &faces));
    PetscCall(PetscArraycpy(faces + total, near, count[r]));
    total += count[r];
    PetscCall(PetscFree(near));
  }
  PetscCall(FaceRecordsShare(s->master, geometry, s->offset, count, faces, n_records, records));
  PetscCall(PetscFree(faces));
  PetscCall(PetscFree(count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchPickRigidFaces - picks the faces of a rigid tool that come near a box; every rank has all of them.

  Not collective

  Input Parameters:
+ s        - the search
. geometry - geometry of the tool's nodes, or NULL
. t        - load parameter
. box      - box of this rank
- distance - reach of the faces (length)

  Output Parameters:
+ n_records - number of faces
- records   - these faces, to be freed with PetscFree()
@*/
PetscErrorCode SearchPickRigidFaces(ContactSearch s, const NodeGeometry *geometry, PetscReal t, const PetscReal box[6],
                                    PetscReal distance, PetscInt *n_records, FaceRecord **records)
{
  PetscInt *faces;

  PetscFunctionBeginUser;
  PetscCall(SearchNearBox(s, s->master, NULL, t, box, distance, n_records, &faces));
  PetscCall(PetscMalloc1(*n_records, records));
  for (PetscInt i = 0; i < *n_records; i++)
    FaceRecordFromSurface(s->master, geometry, s->offset, faces[i], &(*records)[i]);
  PetscCall(PetscFree(faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}
