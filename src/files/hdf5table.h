/* Tables in HDF5 files whose rows go by rank-independent numbers: the same file comes from any number of ranks, and
   serves any. Each rank has items of its own; they go to the rows of the table, of which each rank writes or reads a
   contiguous part, and back. */
#pragma once
#include "base/petsccompat.h"
#include <hdf5.h>

#if !defined(H5_HAVE_PARALLEL)
  #error "files are written by all ranks: PETSc's HDF5 must be a parallel one"
#endif
_Static_assert(sizeof(PetscReal) == sizeof(double), "files hold doubles");

#define CallHDF5(call) PetscCheck((call) >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "HDF5 could not do %s", #call)

typedef struct {
  PetscSF  sf; /* leaves: items; roots: rows */
  PetscInt total, first, n, items;
} Hdf5Table;

/* Item i stands in row[i] of `total` rows; items that share a row must be equal. Collective. */
PetscErrorCode Hdf5TableCreate(MPI_Comm, PetscInt total, PetscInt n, const PetscInt *row, Hdf5Table *);
/* One row for each key of all ranks, ascending; every rank sees all keys: for what is small beside the mesh.
 * Collective. */
PetscErrorCode Hdf5TableCreateByKey(MPI_Comm, PetscInt n, const PetscInt *key, Hdf5Table *);
PetscErrorCode Hdf5TableDestroy(Hdf5Table *);
/* Items (width values of a type each) to the ranks that hold their rows, and back. Collective. */
PetscErrorCode Hdf5TableCollect(const Hdf5Table *, int width, MPI_Datatype, const void *items, void *values);
PetscErrorCode Hdf5TableSpread(const Hdf5Table *, int width, MPI_Datatype, const void *values, void *items);
/* Makes the dataset `path` with the groups above it; every rank writes its part, n rows from row `first` on.
 * Collective. */
PetscErrorCode Hdf5TableWrite(hid_t file, const char *path, hsize_t total, hsize_t first, hsize_t n, int width,
                              hid_t type, const void *values);
PetscErrorCode Hdf5TableWriteReals(hid_t file, const char *path, const Hdf5Table *, int width, const PetscReal *items);
PetscErrorCode Hdf5TableWriteIntegers(hid_t file, const char *path, const Hdf5Table *, int width, const int64_t *items);
/* A file on all ranks: made anew, or opened with access H5F_ACC_RDWR or H5F_ACC_RDONLY. Collective. */
PetscErrorCode Hdf5TableCreateFile(MPI_Comm, const char *name, hid_t *file);
PetscErrorCode Hdf5TableCreateFileBehind(MPI_Comm, const char *name, hsize_t own, hid_t *file);
PetscErrorCode Hdf5TableOpenFile(MPI_Comm, const char *name, unsigned access, hid_t *file);
