/* Values on their way to a checkpoint file or back. The file begins with a head of ARCHIVE_HEAD bytes: a text of
   version, length and checksum with zeros behind it. HDF5 data follow. The head is written last, when all else is on
   the disk, and read first, before HDF5 opens the file. HDF5 crashes or hangs on some damaged files, so it must never
   see one. */
#define _GNU_SOURCE /* fallocate() */
#include "files/archive.h"
#include "archivememory.h"
#include "base/refusal.h"
#include "checksum.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The layout of the state. It must be raised whenever a value gets another name, shape or meaning. */
#define ARCHIVE_VERSION 24
/* The first bytes of the file, by which it is known. */
#define ARCHIVE_MARK "burnish checkpoint\nversion "
/* The length of the head in bytes, the least that HDF5 leaves alone at the start of a file. */
#define ARCHIVE_HEAD 512
/* Bytes that HDF5 itself may need for every dataset and for the file. Measured: under 1 kB and 4 kB. */
#define ARCHIVE_DATASET_BYTES 2048
#define ARCHIVE_FILE_BYTES    65536
/* Bytes that ArchiveExtract() holds at a time. */
#define ARCHIVE_PIECE (1 << 24)
/* Room for the temporary name, which is longer than the file's own. */
#define ARCHIVE_NAME (PETSC_MAX_PATH_LEN + 32)
/* Room for a message that names the file. */
#define ARCHIVE_MESSAGE (2 * PETSC_MAX_PATH_LEN)

struct _n_Archive {
  MPI_Comm    comm;
  PetscMPIInt rank;
  char        name[PETSC_MAX_PATH_LEN], temporary[ARCHIVE_NAME];
  hid_t       file;
  PetscBool   loads, measures, stays; /* stays: in memory */
  PetscInt64  bytes;                  /* counted so far, while it measures */
  Memory      memory;                 /* of this rank, where it stays there */
};

static PetscErrorCode ArchiveNew(MPI_Comm comm, const char *name, Archive *archive)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(archive));
  (*archive)->comm = comm;
  PetscCallMPI(MPI_Comm_rank(comm, &(*archive)->rank));
  PetscCall(PetscStrncpy((*archive)->name, name, sizeof((*archive)->name)));
  snprintf((*archive)->temporary, sizeof((*archive)->temporary), "%s.tmp", name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveMeasure - creates an archive that saves nothing and counts bytes.

  Collective

  Input Parameter:
. comm - the ranks that have parts of the values

  Output Parameter:
. archive - to be closed with ArchiveClose()
@*/
PetscErrorCode ArchiveMeasure(MPI_Comm comm, Archive *archive)
{
  PetscFunctionBeginUser;
  PetscCall(ArchiveNew(comm, "", archive));
  (*archive)->measures = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveKeep - creates an archive that saves values in memory, for objects that are made anew on the same ranks.

  Collective

  Input Parameter:
. comm - the ranks that have parts of the values

  Output Parameter:
. archive - ArchiveTurn() makes it load; to be closed with ArchiveClose()
@*/
PetscErrorCode ArchiveKeep(MPI_Comm comm, Archive *archive)
{
  PetscFunctionBeginUser;
  PetscCall(ArchiveNew(comm, "", archive));
  (*archive)->stays = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveTurn - lets an archive in memory load what it has saved.

  Not collective, the same on all ranks

  Input Parameter:
. archive - from ArchiveKeep()
@*/
void ArchiveTurn(Archive archive)
{
  archive->loads = PETSC_TRUE;
}

/*@
  ArchiveRenumbers - tells whether the objects that load may number their unknowns otherwise than those that saved.

  Not collective

  Input Parameter:
. archive - any
@*/
PetscBool ArchiveRenumbers(Archive archive)
{
  return archive->stays;
}

/* Saves or loads a value of this rank in memory. */
static PetscErrorCode ArchiveHere(Archive a, const char *name, size_t bytes, void *value)
{
  const void *kept;
  size_t      found;

  PetscFunctionBeginUser;
  if (!a->loads) {
    PetscCall(MemorySave(&a->memory, name, bytes, value));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(MemoryFind(a->memory, name, &found, &kept));
  PetscCheck(found == bytes, PETSC_COMM_SELF, PETSC_ERR_PLIB, "/%s has %zu bytes in memory, not %zu", name, found,
             bytes);
  PetscCall(PetscMemcpy(value, kept, bytes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveSize - returns how many bytes the file will have at most.

  Collective

  Input Parameter:
. archive - from ArchiveMeasure(), after all values have been named

  Output Parameter:
. bytes - of all ranks together
@*/
PetscErrorCode ArchiveSize(Archive archive, PetscInt64 *bytes)
{
  PetscFunctionBeginUser;
  *bytes = archive->bytes;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, bytes, 1, MPIU_INT64, MPI_SUM, archive->comm));
  *bytes += ARCHIVE_FILE_BYTES;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns why rank 0 cannot write a file of that size, or 0. File systems that cannot reserve room pass. */
static int ReserveRoom(const char *name, PetscInt64 bytes)
{
  const int file = open(name, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  int       cause;

  if (file < 0) return errno;
  cause = fallocate(file, 0, 0, bytes) ? errno : 0;
  if (close(file) && !cause) cause = errno;
  if (cause) unlink(name);
  return cause == EOPNOTSUPP || cause == ENOSYS ? 0 : cause;
}

/*@
  ArchiveCreate - creates an archive that saves values in a new file, under a temporary name until ArchiveClose().

  Collective

  Input Parameters:
+ comm  - the ranks that have parts of the values
. name  - of the file
- bytes - that it will have at most, from ArchiveSize()

  Output Parameter:
. archive - to be closed with ArchiveClose()

  Note:
  Errors: PETSC_ERR_FILE_WRITE with its cause where there is no room for so many bytes. The file `name` is not touched.
@*/
PetscErrorCode ArchiveCreate(MPI_Comm comm, const char *name, PetscInt64 bytes, Archive *archive)
{
  int cause = 0;

  PetscFunctionBeginUser;
  PetscCall(ArchiveNew(comm, name, archive));
  if (!(*archive)->rank) cause = ReserveRoom((*archive)->temporary, bytes);
  if (cause) PetscCall(PetscFree(*archive));
  PetscCheck(!cause, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE,
             "cannot write %s (%.3g MB): %s; what stood there before is intact", name, 1e-6 * (double)bytes,
             strerror(cause));
  PetscCallMPI(MPI_Barrier(comm));
  PetscCall(Hdf5TableCreateFileBehind(comm, (*archive)->temporary, ARCHIVE_HEAD, &(*archive)->file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The head of a file of this version. */
static void HeadFill(PetscInt64 bytes, uint64_t checksum, char head[ARCHIVE_HEAD])
{
  memset(head, 0, ARCHIVE_HEAD);
  snprintf(head, ARCHIVE_HEAD, ARCHIVE_MARK "%d\nbytes %lld\nchecksum %016llx\n", ARCHIVE_VERSION, (long long)bytes,
           (unsigned long long)checksum);
}

/* Reads the head of a file on rank 0 and says why the file is no archive of this version, or nothing. */
static void HeadComplaint(const char *name, char head[ARCHIVE_HEAD], char *message, size_t size)
{
  const size_t mark   = strlen(ARCHIVE_MARK);
  FILE        *stream = fopen(name, "rb");
  size_t       n;

  *message = '\0';
  if (!stream) {
    snprintf(message, size,
             "%s: %s; allowed: -restart with a directory whose run has written a checkpoint (output.checkpoint, or a "
             "stopped run)",
             name, strerror(errno));
    return;
  }
  n = fread(head, 1, ARCHIVE_HEAD, stream);
  fclose(stream);
  if (n < mark || memcmp(head, ARCHIVE_MARK, mark))
    snprintf(message, size,
             "%s was not written by burnish, or by an older version of it, or its first bytes are damaged; allowed: a "
             "checkpoint of this burnish",
             name);
  else if (n < ARCHIVE_HEAD)
    snprintf(message, size, "%s is damaged: a part of it is missing; allowed: a whole checkpoint", name);
  else if (atoi(head + mark) != ARCHIVE_VERSION)
    snprintf(message, size, "%s is a checkpoint of version %d; allowed: version %d, of this burnish", name,
             atoi(head + mark), ARCHIVE_VERSION);
}

/* Compares the head with the one that belongs to the length and the checksum of the file on rank 0. */
static void BodyComplaint(const char *name, PetscInt64 bytes, uint64_t checksum, const char head[ARCHIVE_HEAD],
                          char *message, size_t size)
{
  long long length = -1;
  char      belongs[ARCHIVE_HEAD];

  *message = '\0';
  HeadFill(bytes, checksum, belongs);
  if (!memcmp(head, belongs, ARCHIVE_HEAD)) return;
  if (sscanf(head, ARCHIVE_MARK "%*d\nbytes %lld", &length) == 1 && length > (long long)bytes)
    snprintf(message, size,
             "%s is damaged: it has %lld bytes of %lld, a part of it is missing; allowed: a whole checkpoint", name,
             (long long)bytes, length);
  else
    snprintf(message, size,
             "%s is damaged: its bytes do not match its checksum, so they have changed since it was written; allowed: "
             "a whole checkpoint",
             name);
}

/*@
  ArchiveOpen - opens a file from which values are loaded.

  Collective

  Input Parameters:
+ comm - the ranks that want parts of the values
- name - of the file

  Output Parameter:
. archive - to be closed with ArchiveClose()

  Note:
  A file that is missing, truncated, foreign, of another version, or of which a single bit has changed is refused
  (exit 1). All ranks read the whole file once for that.
@*/
PetscErrorCode ArchiveOpen(MPI_Comm comm, const char *name, Archive *archive)
{
  char        message[ARCHIVE_MESSAGE] = "", head[ARCHIVE_HEAD + 1] = ""; /* the last byte ends the text */
  PetscInt64  bytes;
  uint64_t    checksum;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) HeadComplaint(name, head, message, sizeof(message));
  PetscCall(RefuseInputAnywhere(comm, *message ? message : NULL));
  PetscCall(ChecksumFile(comm, name, ARCHIVE_HEAD, &bytes, &checksum));
  if (!rank) BodyComplaint(name, bytes, checksum, head, message, sizeof(message));
  PetscCall(RefuseInputAnywhere(comm, *message ? message : NULL));
  PetscCall(ArchiveNew(comm, name, archive));
  PetscCall(Hdf5TableOpenFile(comm, name, H5F_ACC_RDONLY, &(*archive)->file));
  (*archive)->loads = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the head on rank 0 and sends everything to the disk. Returns the cause of a failure, or 0. */
static int WriteHead(const char *name, const char head[ARCHIVE_HEAD])
{
  const int file  = open(name, O_WRONLY);
  int       cause = 0;

  if (file < 0) return errno;
  errno = EIO; /* where the write is short */
  if (pwrite(file, head, ARCHIVE_HEAD, 0) != ARCHIVE_HEAD || fsync(file)) cause = errno;
  close(file);
  return cause;
}

/* Gives the file its final name on rank 0. Returns the cause of a failure, or 0. */
static int MoveInPlace(const char *temporary, const char *name)
{
  char  directory[PETSC_MAX_PATH_LEN];
  char *slash;
  int   file;

  if (rename(temporary, name)) return errno;
  snprintf(directory, sizeof(directory), "%s", name);
  slash = strrchr(directory, '/');
  if (slash) *slash = '\0';
  file = open(slash ? directory : ".", O_RDONLY);
  if (file >= 0) {
    fsync(file); /* file systems that cannot sync a directory keep names in order all the same */
    close(file);
  }
  return 0;
}

/* Completes a saved file and puts it in the place of the one before. */
static PetscErrorCode ArchiveFinish(Archive a)
{
  char       head[ARCHIVE_HEAD];
  PetscInt64 bytes;
  uint64_t   checksum;
  int        cause = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Barrier(a->comm)); /* every rank has written its part */
  PetscCall(ChecksumFile(a->comm, a->temporary, ARCHIVE_HEAD, &bytes, &checksum));
  HeadFill(bytes, checksum, head);
  if (!a->rank) cause = WriteHead(a->temporary, head);
  if (!a->rank && !cause) cause = MoveInPlace(a->temporary, a->name);
  PetscCheck(!cause, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write %s: %s; what stood there before is intact",
             a->name, strerror(cause));
  PetscCallMPI(MPI_Barrier(a->comm)); /* the file is there when any rank goes on */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveClose - ends an archive. A saved file takes the place of the one before.

  Collective

  Input Parameter:
. archive - from ArchiveMeasure(), ArchiveKeep(), ArchiveCreate() or ArchiveOpen(); NULL does nothing

  Note:
  Errors: PETSC_ERR_FILE_WRITE; the file before is intact then.
@*/
PetscErrorCode ArchiveClose(Archive *archive)
{
  Archive a = *archive;

  PetscFunctionBeginUser;
  if (!a) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MemoryDestroy(&a->memory));
  if (!a->measures && !a->stays) {
    if (!a->loads) CallHDF5(H5Fflush(a->file, H5F_SCOPE_GLOBAL)); /* every rank sends to the disk what it wrote */
    CallHDF5(H5Fclose(a->file));
    if (!a->loads) PetscCall(ArchiveFinish(a));
  }
  PetscCall(PetscFree(*archive));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveLoads - tells whether values come from the file and are to be taken over.

  Not collective

  Input Parameter:
. archive - any
@*/
PetscBool ArchiveLoads(Archive archive)
{
  return archive->loads;
}

/* Opens a dataset for reading. Refuses one that is missing or has another number of values than wanted. A negative
   number allows any. */
static PetscErrorCode OpenDataset(Archive a, const char *name, hssize_t values, hid_t *data, hsize_t *size)
{
  hid_t     space;
  hssize_t  found = -1;
  PetscBool there;

  PetscFunctionBeginUser;
  *size = 0;
  *data = -1;
  PetscCall(ArchiveHas(a, name, &there));
  if (there) *data = H5Dopen2(a->file, name, H5P_DEFAULT);
  if (*data >= 0) {
    CallHDF5(space = H5Dget_space(*data));
    found = H5Sget_simple_extent_npoints(space);
    CallHDF5(H5Sclose(space));
  }
  if (found < 0 || (values >= 0 && found != values)) {
    if (*data >= 0) CallHDF5(H5Dclose(*data));
    PetscCall(RefuseInput(
      a->comm, "%s is damaged: /%s has %lld values where %lld belong; allowed: a whole checkpoint of this scene",
      a->name, name, (long long)PetscMax(found, 0), (long long)values));
  }
  *size = (hsize_t)found;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveHas - tells whether the archive holds a value of that name.

  Collective

  Input Parameters:
+ a    - from ArchiveOpen() or ArchiveKeep()
- name - of the value

  Output Parameter:
. there - whether it does
@*/
PetscErrorCode ArchiveHas(Archive a, const char *name, PetscBool *there)
{
  char        path[PETSC_MAX_PATH_LEN];
  const void *kept;
  size_t      bytes;

  PetscFunctionBeginUser;
  if (a->stays) {
    PetscCall(MemoryFind(a->memory, name, &bytes, &kept));
    *there = kept ? PETSC_TRUE : PETSC_FALSE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  *there = PETSC_TRUE;
  /* H5Lexists() wants every group on the way to be there. */
  for (const char *end = strchr(name + 1, '/'); *there && end; end = strchr(end + 1, '/')) {
    snprintf(path, sizeof(path), "%.*s", (int)(end - name), name);
    *there = H5Lexists(a->file, path, H5P_DEFAULT) > 0 ? PETSC_TRUE : PETSC_FALSE;
  }
  if (*there) *there = H5Lexists(a->file, name, H5P_DEFAULT) > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the rows first to first + n - 1, each of `width` values. */
static PetscErrorCode ReadPart(hid_t data, hsize_t first, hsize_t n, int width, hid_t type, void *values)
{
  const hsize_t start[2] = {first, 0}, count[2] = {n, (hsize_t)width};
  hid_t         space, memory;

  PetscFunctionBeginUser;
  CallHDF5(space = H5Dget_space(data));
  CallHDF5(memory = H5Screate_simple(width > 1 ? 2 : 1, count, NULL));
  CallHDF5(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL));
  if (n) CallHDF5(H5Dread(data, type, memory, space, H5P_DEFAULT, values));
  CallHDF5(H5Sclose(memory));
  CallHDF5(H5Sclose(space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Saves or loads n values of one HDF5 type, `size` bytes each, the same on all ranks. */
static PetscErrorCode ArchiveShared(Archive a, const char *name, PetscInt n, hid_t type, size_t size, void *values)
{
  hid_t   data;
  hsize_t found;

  PetscFunctionBeginUser;
  if (a->stays) {
    PetscCall(ArchiveHere(a, name, (size_t)n * size, values));
  } else if (a->loads) {
    PetscCall(OpenDataset(a, name, n, &data, &found));
    PetscCall(ReadPart(data, 0, found, 1, type, values));
    CallHDF5(H5Dclose(data));
  } else if (a->measures)
    a->bytes += a->rank ? 0 : ARCHIVE_DATASET_BYTES + n * (PetscInt64)size;
  else
    PetscCall(Hdf5TableWrite(a->file, name, (hsize_t)n, 0, a->rank ? 0 : (hsize_t)n, 1, type, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveReals - saves or loads numbers that all ranks share.

  Collective

  Input Parameters:
+ a    - the archive
. name - of the value, its groups with slashes between them
- n    - how many numbers there are; a file with another number is refused

  Input/Output Parameter:
. values - rank 0's are saved, all ranks get the loaded ones
@*/
PetscErrorCode ArchiveReals(Archive a, const char *name, PetscInt n, PetscReal *values)
{
  PetscFunctionBeginUser;
  PetscCall(ArchiveShared(a, name, n, H5T_NATIVE_DOUBLE, sizeof(double), values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveIntegers - saves or loads whole numbers that all ranks share.

  Collective

  Input Parameters:
+ a    - the archive
. name - of the value
- n    - how many numbers there are; a file with another number is refused

  Input/Output Parameter:
. values - rank 0's are saved, all ranks get the loaded ones
@*/
PetscErrorCode ArchiveIntegers(Archive a, const char *name, PetscInt n, PetscInt *values)
{
  int64_t *wide;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &wide));
  for (PetscInt i = 0; i < n; i++) wide[i] = values[i];
  PetscCall(ArchiveShared(a, name, n, H5T_NATIVE_INT64, sizeof(int64_t), wide));
  for (PetscInt i = 0; i < n; i++) values[i] = (PetscInt)wide[i];
  PetscCall(PetscFree(wide));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveRealsAt - saves or loads numbers that all ranks share, each in a place of its own.

  Collective

  Input Parameters:
+ a     - the archive
. name  - of the value
. n     - how many numbers there are
- place - place[i] points to number i, which is saved or overwritten
@*/
PetscErrorCode ArchiveRealsAt(Archive a, const char *name, PetscInt n, PetscReal *const *place)
{
  PetscReal *values;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &values));
  for (PetscInt i = 0; i < n; i++) values[i] = *place[i];
  PetscCall(ArchiveReals(a, name, n, values));
  for (PetscInt i = 0; i < n; i++) *place[i] = values[i];
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveIntegersAt - saves or loads whole numbers that all ranks share, each in a place of its own.

  Collective

  Input Parameters:
+ a     - the archive
. name  - of the value
. n     - how many numbers there are
- place - place[i] points to number i, which is saved or overwritten
@*/
PetscErrorCode ArchiveIntegersAt(Archive a, const char *name, PetscInt n, PetscInt *const *place)
{
  PetscInt *values;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &values));
  for (PetscInt i = 0; i < n; i++) values[i] = *place[i];
  PetscCall(ArchiveIntegers(a, name, n, values));
  for (PetscInt i = 0; i < n; i++) *place[i] = values[i];
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveBoolean - saves or loads a truth value that all ranks share.

  Collective

  Input Parameters:
+ a    - the archive
- name - of the value

  Input/Output Parameter:
. value - is saved or overwritten
@*/
PetscErrorCode ArchiveBoolean(Archive a, const char *name, PetscBool *value)
{
  PetscInt number = *value;

  PetscFunctionBeginUser;
  PetscCall(ArchiveIntegers(a, name, 1, &number));
  *value = number ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many values of `size` bytes are to be loaded. */
static PetscErrorCode LoadedLength(Archive a, const char *name, size_t size, PetscInt *n)
{
  const void *kept;
  size_t      bytes;
  hid_t       data;
  hsize_t     found;

  PetscFunctionBeginUser;
  if (a->stays) {
    PetscCall(MemoryFind(a->memory, name, &bytes, &kept));
    *n = (PetscInt)(bytes / size);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(OpenDataset(a, name, -1, &data, &found));
  CallHDF5(H5Dclose(data));
  *n = (PetscInt)found;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveIntegerList - saves or loads any number of whole numbers that all ranks share.

  Collective

  Input Parameters:
+ a    - the archive
- name - of the value

  Input/Output Parameters:
+ n    - how many numbers there are
- list - is saved; a loaded one is new, to be freed with PetscFree()
@*/
PetscErrorCode ArchiveIntegerList(Archive a, const char *name, PetscInt *n, PetscInt **list)
{
  PetscFunctionBeginUser;
  if (a->loads) {
    PetscCall(LoadedLength(a, name, sizeof(int64_t), n));
    PetscCall(PetscMalloc1(*n, list));
  }
  PetscCall(ArchiveIntegers(a, name, *n, *list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveText - saves or loads a text of any length that all ranks share.

  Collective

  Input Parameters:
+ a    - the archive
- name - of the value

  Input/Output Parameter:
. text - is saved; a loaded one is new, to be freed with PetscFree()
@*/
PetscErrorCode ArchiveText(Archive a, const char *name, char **text)
{
  PetscInt n;

  PetscFunctionBeginUser;
  if (a->loads) {
    PetscCall(LoadedLength(a, name, 1, &n));
    PetscCall(PetscCalloc1(n + 1, text));
  } else
    PetscCall(PetscIntCast(strlen(*text), &n));
  PetscCall(ArchiveShared(a, name, n, H5T_NATIVE_CHAR, 1, *text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveString - saves or loads a text in an array that all ranks share.

  Collective

  Input Parameters:
+ a    - the archive
. name - of the value
- size - of the array; a loaded text that is longer is cut

  Input/Output Parameter:
. text - is saved or overwritten
@*/
PetscErrorCode ArchiveString(Archive a, const char *name, size_t size, char *text)
{
  char *copy = text;

  PetscFunctionBeginUser;
  PetscCall(ArchiveText(a, name, &copy));
  if (!a->loads) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrncpy(text, copy, size));
  PetscCall(PetscFree(copy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveRows - saves or loads items of which each rank has a part, by their rows in a table.

  Collective

  Input Parameters:
+ a     - the archive
. name  - of the value
. rows  - the row of each of this rank's items
- width - numbers of one item

  Input/Output Parameter:
. items - items[rows->items*width] are saved or overwritten
@*/
PetscErrorCode ArchiveRows(Archive a, const char *name, const Hdf5Table *rows, int width, PetscReal *items)
{
  PetscReal *values;
  hid_t      data;
  hsize_t    found;

  PetscFunctionBeginUser;
  if (a->stays) {
    PetscCall(ArchiveHere(a, name, (size_t)rows->items * (size_t)width * sizeof(PetscReal), items));
  } else if (a->loads) {
    PetscCall(OpenDataset(a, name, (hssize_t)rows->total * width, &data, &found));
    PetscCall(PetscMalloc1(rows->n * width, &values));
    PetscCall(ReadPart(data, (hsize_t)rows->first, (hsize_t)rows->n, width, H5T_NATIVE_DOUBLE, values));
    CallHDF5(H5Dclose(data));
    PetscCall(Hdf5TableSpread(rows, width, MPIU_REAL, values, items));
    PetscCall(PetscFree(values));
  } else if (a->measures)
    a->bytes += rows->n * width * (PetscInt64)sizeof(double) + (a->rank ? 0 : ARCHIVE_DATASET_BYTES);
  else
    PetscCall(Hdf5TableWriteReals(a->file, name, rows, width, items));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveBytes - saves or loads bytes of which each rank has a part.

  Collective

  Input Parameters:
+ a    - the archive
- name - of the value

  Input/Output Parameters:
+ n     - number of bytes of this rank
- bytes - are saved behind those of the ranks before; loaded, each rank gets an equal share, from memory its own, to
  be freed with PetscFree()
@*/
PetscErrorCode ArchiveBytes(Archive a, const char *name, PetscInt64 *n, char **bytes)
{
  PetscInt64  first = 0, total;
  PetscMPIInt size;
  PetscInt    length;
  hid_t       data;
  hsize_t     found;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(a->comm, &size));
  if (a->stays) {
    if (a->loads) {
      PetscCall(LoadedLength(a, name, 1, &length));
      *n = length;
      PetscCall(PetscMalloc1(*n, bytes));
    }
    PetscCall(ArchiveHere(a, name, (size_t)*n, *bytes));
  } else if (a->loads) {
    PetscCall(OpenDataset(a, name, -1, &data, &found));
    total = (PetscInt64)found;
    first = total * a->rank / size;
    *n    = total * (a->rank + 1) / size - first;
    PetscCall(PetscMalloc1(*n, bytes));
    PetscCall(ReadPart(data, (hsize_t)first, (hsize_t)*n, 1, H5T_NATIVE_CHAR, *bytes));
    CallHDF5(H5Dclose(data));
  } else if (a->measures)
    a->bytes += *n + (a->rank ? 0 : ARCHIVE_DATASET_BYTES);
  else {
    PetscCallMPI(MPI_Exscan(n, &first, 1, MPIU_INT64, MPI_SUM, a->comm));
    PetscCallMPI(MPI_Allreduce(n, &total, 1, MPIU_INT64, MPI_SUM, a->comm));
    PetscCall(Hdf5TableWrite(a->file, name, (hsize_t)total, a->rank ? (hsize_t)first : 0, (hsize_t)*n, 1,
                             H5T_NATIVE_CHAR, *bytes));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ArchiveExtract - writes all bytes that ArchiveBytes() has saved to a stream on rank 0.

  Collective

  Input Parameters:
+ a      - from ArchiveOpen()
. name   - of the value
- stream - on rank 0, other ranks may pass NULL

  Note:
  Rank 0 holds 16 MB of them at a time. Errors: PETSC_ERR_FILE_WRITE.
@*/
PetscErrorCode ArchiveExtract(Archive a, const char *name, FILE *stream)
{
  hid_t   data;
  hsize_t total;
  char   *piece;

  PetscFunctionBeginUser;
  PetscCall(OpenDataset(a, name, -1, &data, &total));
  PetscCall(PetscMalloc1(ARCHIVE_PIECE, &piece));
  for (hsize_t at = 0; !a->rank && at < total; at += ARCHIVE_PIECE) {
    const size_t n = (size_t)PetscMin(total - at, (hsize_t)ARCHIVE_PIECE);

    PetscCall(ReadPart(data, at, n, 1, H5T_NATIVE_CHAR, piece));
    PetscCheck(fwrite(piece, 1, n, stream) == n, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE,
               "cannot hold a copy of /%s of %s: %s", name, a->name, strerror(errno));
  }
  PetscCall(PetscFree(piece));
  CallHDF5(H5Dclose(data));
  PetscFunctionReturn(PETSC_SUCCESS);
}
