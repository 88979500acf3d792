/* An archive is the state of a run on its way to a file or back. Every object names its values in one function,
   NameArchive(object, archive). That function saves the values or takes them over, so that what is saved is what is
   restored. The file is the same on any number of ranks and serves any number.

     to save: ArchiveMeasure(), the objects' functions, ArchiveSize(), ArchiveClose() for the size of the file; then
              ArchiveCreate(), the objects' functions, ArchiveClose()
     to load: ArchiveOpen(), the objects' functions, ArchiveClose()
     to make objects anew: ArchiveKeep(), the old objects' functions, ArchiveTurn(), the new objects' functions,
              ArchiveClose(); each rank keeps its own values, and nothing is written

   A new file is written under a temporary name, goes to the disk, and is renamed when it is whole. The file before it
   stays until then. The file begins with a text that holds version, length and checksum, and HDF5 data follow.
   ArchiveOpen() refuses a file of which a single bit has changed. */
#pragma once
#include "files/hdf5table.h"
#include <stdio.h>

typedef struct _n_Archive *Archive;

PetscErrorCode ArchiveMeasure(MPI_Comm, Archive *);
PetscErrorCode ArchiveKeep(MPI_Comm, Archive *);
void           ArchiveTurn(Archive);
PetscBool      ArchiveRenumbers(Archive);
PetscErrorCode ArchiveSize(Archive, PetscInt64 *bytes);
PetscErrorCode ArchiveCreate(MPI_Comm, const char *file, PetscInt64 bytes, Archive *);
PetscErrorCode ArchiveOpen(MPI_Comm, const char *file, Archive *);
PetscErrorCode ArchiveClose(Archive *);
PetscBool      ArchiveLoads(Archive);
PetscErrorCode ArchiveHas(Archive, const char *name, PetscBool *);
/* Values that all ranks share: those of rank 0 are saved. */
PetscErrorCode ArchiveReals(Archive, const char *name, PetscInt n, PetscReal *values);
PetscErrorCode ArchiveIntegers(Archive, const char *name, PetscInt n, PetscInt *values);
PetscErrorCode ArchiveRealsAt(Archive, const char *name, PetscInt n, PetscReal *const *place);
PetscErrorCode ArchiveIntegersAt(Archive, const char *name, PetscInt n, PetscInt *const *place);
PetscErrorCode ArchiveBoolean(Archive, const char *name, PetscBool *value);
PetscErrorCode ArchiveString(Archive, const char *name, size_t size, char *text);
/* The same of any length: what is loaded is new and the caller's. */
PetscErrorCode ArchiveIntegerList(Archive, const char *name, PetscInt *n, PetscInt **list);
PetscErrorCode ArchiveText(Archive, const char *name, char **text);
/* Values of which each rank has a part. */
PetscErrorCode ArchiveRows(Archive, const char *name, const Hdf5Table *, int width, PetscReal *items);
PetscErrorCode ArchiveBytes(Archive, const char *name, PetscInt64 *n, char **bytes);
PetscErrorCode ArchiveExtract(Archive, const char *name, FILE *);
