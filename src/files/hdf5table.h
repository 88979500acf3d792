/* Tables in HDF5 files whose rows are numbered independently of the ranks, so that any number of ranks writes the same
   file and can read it.

   Each rank has items of its own. Hdf5TableCreate() says which row of the table each item has; each rank writes or
   reads a contiguous part of the rows. Hdf5TableWriteReals() and Hdf5TableWriteIntegers() write items as a dataset;
   Hdf5TableCollect() and Hdf5TableSpread() bring items to their rows and back. Hdf5WriteAttribute() writes attributes. */
#pragma once
#include "base/petsccompat.h"
#include <hdf5.h>

#if !defined(H5_HAVE_PARALLEL)
  #error "files are written by all ranks: PETSc's HDF5 must be a parallel one"
#endif
_Static_assert(sizeof(PetscReal) == sizeof(double), "files hold doubles");

#define CallHDF5(call) PetscCheck((call) >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "HDF5 could not do %s", #call)

typedef struct {
  PetscSF  sf;       /* leaves: items; roots: rows */
  PetscInt total;    /* rows of all ranks */
  PetscInt first, n; /* rows of this rank */
  PetscInt items;    /* of this rank */
} Hdf5Table;

PetscErrorCode Hdf5TableCreate(MPI_Comm, PetscInt total, PetscInt n, const PetscInt *row, Hdf5Table *);
PetscErrorCode Hdf5TableCreateByKey(MPI_Comm, PetscInt n, const PetscInt *key, Hdf5Table *);
PetscErrorCode Hdf5TableDestroy(Hdf5Table *);
PetscErrorCode Hdf5TableCollect(const Hdf5Table *, int width, MPI_Datatype, const void *items, void *values);
PetscErrorCode Hdf5TableSpread(const Hdf5Table *, int width, MPI_Datatype, const void *values, void *items);
PetscErrorCode Hdf5TableWrite(hid_t file, const char *path, hsize_t total, hsize_t first, hsize_t n, int width,
                              hid_t type, const void *values);
PetscErrorCode Hdf5TableWriteReals(hid_t file, const char *path, const Hdf5Table *, int width, const PetscReal *items);
PetscErrorCode Hdf5TableWriteIntegers(hid_t file, const char *path, const Hdf5Table *, int width, const int64_t *items);
PetscErrorCode Hdf5TableCreateFile(MPI_Comm, const char *name, hid_t *file);
PetscErrorCode Hdf5TableCreateFileBehind(MPI_Comm, const char *name, hsize_t own, hid_t *file);
PetscErrorCode Hdf5TableOpenFile(MPI_Comm, const char *name, unsigned access, hid_t *file);
PetscErrorCode Hdf5WriteText(hid_t object, const char *name, const char *text);
PetscErrorCode Hdf5WriteAttribute(hid_t object, const char *name, hid_t type, hsize_t n, const void *values);
