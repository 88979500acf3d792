/* The state of a run on its way to a file or back. Every object names its values in one function, NameArchive(object,
   archive), which saves them or takes them over, so that what is saved is what is restored. The file is the same on any
   number of ranks and serves any.

     ArchiveMeasure() for the size; ArchiveCreate(), the objects' functions, ArchiveClose(); ArchiveOpen(), the same
   functions, ArchiveClose()

   A new file is written under a temporary name, synced, and renamed when it is whole: the one before stays until then.
 */
#pragma once
#include "files/hdf5table.h"
#include <stdio.h>

typedef struct _n_Archive *Archive;

PetscErrorCode ArchiveMeasure(MPI_Comm, Archive *);     /* saves nowhere, counts bytes */
PetscErrorCode ArchiveSize(Archive, PetscInt64 *bytes); /* all ranks together */
PetscErrorCode ArchiveCreate(MPI_Comm, const char *file, PetscInt64 bytes, Archive *);
PetscErrorCode ArchiveOpen(MPI_Comm, const char *file,
                           Archive *); /* refuses what is no whole archive of this version */
PetscErrorCode ArchiveClose(Archive *);
PetscBool      ArchiveLoads(Archive); /* values come from the file */
PetscErrorCode ArchiveHas(Archive, const char *name, PetscBool *);
/* Values that all ranks share: rank 0's are saved. Collective. */
PetscErrorCode ArchiveReals(Archive, const char *name, PetscInt n, PetscReal *values);
PetscErrorCode ArchiveIntegers(Archive, const char *name, PetscInt n, PetscInt *values);
/* The same, value i at *place[i] */
PetscErrorCode ArchiveRealsAt(Archive, const char *name, PetscInt n, PetscReal *const *place);
PetscErrorCode ArchiveIntegersAt(Archive, const char *name, PetscInt n, PetscInt *const *place);
PetscErrorCode ArchiveBoolean(Archive, const char *name, PetscBool *value);
/* The same of any length; loaded, they are new and the caller's. Collective. */
PetscErrorCode ArchiveIntegerList(Archive, const char *name, PetscInt *n, PetscInt **list);
PetscErrorCode ArchiveText(Archive, const char *name, char **text);
/* Items that ranks hold parts of, by the rows of a table. Collective. */
PetscErrorCode ArchiveRows(Archive, const char *name, const Hdf5Table *, int width, PetscReal *items);
/* Bytes, one rank's after the other's; loaded, they are shared out anew and the caller's. Collective. */
PetscErrorCode ArchiveBytes(Archive, const char *name, PetscInt64 *n, char **bytes);
/* All of these bytes to a stream on rank 0, loading only. Collective. */
PetscErrorCode ArchiveExtract(Archive, const char *name, FILE *);
