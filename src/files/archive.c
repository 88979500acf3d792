#define _GNU_SOURCE /* fallocate() */
#include "files/archive.h"
#include "base/refusal.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

/* The layout of the state; to be raised whenever a value gets another name, shape or meaning. */
#define ARCHIVE_VERSION 4
/* The attribute by which the file is known. */
#define ARCHIVE_MARK "burnish_checkpoint"
/* What HDF5 itself may need: for every dataset and for the file, bytes. Measured: under 1 kB and 4 kB. */
#define ARCHIVE_DATASET_BYTES 2048
#define ARCHIVE_FILE_BYTES    65536

enum { ARCHIVE_PIECE = 1 << 24 /* bytes that ArchiveExtract() holds at a time */, NAME_SIZE = PETSC_MAX_PATH_LEN + 32 };

struct _n_Archive {
  MPI_Comm    comm;
  PetscMPIInt rank;
  char        name[PETSC_MAX_PATH_LEN], temporary[NAME_SIZE];
  hid_t       file;
  PetscBool   loads, measures;
  PetscInt64  bytes;
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

/* ArchiveMeasure - an archive that only counts. Not collective. */
PetscErrorCode ArchiveMeasure(MPI_Comm comm, Archive *archive)
{
  PetscFunctionBeginUser;
  PetscCall(ArchiveNew(comm, "", archive));
  (*archive)->measures = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ArchiveSize - bytes that the file will have at most, after ArchiveMeasure() and all values. Collective. */
PetscErrorCode ArchiveSize(Archive archive, PetscInt64 *bytes)
{
  PetscFunctionBeginUser;
  *bytes = archive->bytes;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, bytes, 1, MPIU_INT64, MPI_SUM, archive->comm));
  *bytes += ARCHIVE_FILE_BYTES;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rank 0: why a file of that size cannot be written, or 0. File systems that cannot reserve room are not asked. */
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

/* ArchiveCreate - a new file under its temporary name.

   Collective. bytes: ArchiveSize(). Errors: PETSC_ERR_FILE_WRITE with its cause where there is no room for so many; the
   file `name` is not touched. */
PetscErrorCode ArchiveCreate(MPI_Comm comm, const char *name, PetscInt64 bytes, Archive *archive)
{
  const int64_t version = ARCHIVE_VERSION;
  int           cause   = 0;
  hid_t         space, attribute;

  PetscFunctionBeginUser;
  PetscCall(ArchiveNew(comm, name, archive));
  if (!(*archive)->rank) cause = ReserveRoom((*archive)->temporary, bytes);
  if (cause) PetscCall(PetscFree(*archive));
  PetscCheck(!cause, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE,
             "cannot write %s (%.3g MB): %s; what stood there before is intact", name, 1e-6 * (double)bytes,
             strerror(cause));
  PetscCallMPI(MPI_Barrier(comm));
  PetscCall(Hdf5TableCreateFile(comm, (*archive)->temporary, &(*archive)->file));
  CallHDF5(space = H5Screate(H5S_SCALAR));
  CallHDF5(attribute = H5Acreate2((*archive)->file, ARCHIVE_MARK, H5T_NATIVE_INT64, space, H5P_DEFAULT, H5P_DEFAULT));
  CallHDF5(H5Awrite(attribute, H5T_NATIVE_INT64, &version));
  CallHDF5(H5Aclose(attribute));
  CallHDF5(H5Sclose(space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* HDF5 says nothing of its own while a file is looked at that may be anything. */
static herr_t QuietAttribute(hid_t file, int64_t *version)
{
  hid_t  attribute = H5Aexists(file, ARCHIVE_MARK) > 0 ? H5Aopen(file, ARCHIVE_MARK, H5P_DEFAULT) : -1;
  herr_t status    = -1;

  if (attribute >= 0) {
    status = H5Aread(attribute, H5T_NATIVE_INT64, version);
    H5Aclose(attribute);
  }
  return status;
}

/* Rank 0: why the file is no archive of ours, or an empty message */
static void FileComplaint(const char *name, char *message, size_t size)
{
  int64_t     version = -1;
  H5E_auto2_t report;
  void       *context;
  hid_t       file;

  *message = '\0';
  if (access(name, R_OK)) {
    snprintf(message, size,
             "%s: %s; allowed: -restart with a directory whose run has written a checkpoint (output.checkpoint, or a "
             "stopped run)",
             name, strerror(errno));
    return;
  }
  H5Eget_auto2(H5E_DEFAULT, &report, &context);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  file = H5Fopen(name, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0)
    snprintf(message, size, "%s is no HDF5 file, or a part of it is missing; allowed: a whole checkpoint of burnish",
             name);
  else if (QuietAttribute(file, &version) < 0)
    snprintf(message, size, "%s was not written by burnish; allowed: a checkpoint of burnish", name);
  else if (version != ARCHIVE_VERSION)
    snprintf(message, size, "%s is a checkpoint of version %lld; allowed: version %d, of this burnish", name,
             (long long)version, ARCHIVE_VERSION);
  if (file >= 0) H5Fclose(file);
  H5Eset_auto2(H5E_DEFAULT, report, context);
}

/* ArchiveOpen - a file to load from.

   Collective. Refuses (exit 1) a file that is missing, truncated, foreign or of another version. */
PetscErrorCode ArchiveOpen(MPI_Comm comm, const char *name, Archive *archive)
{
  char message[2 * PETSC_MAX_PATH_LEN] = "";

  PetscFunctionBeginUser;
  PetscCall(ArchiveNew(comm, name, archive));
  if (!(*archive)->rank) FileComplaint(name, message, sizeof(message));
  PetscCall(RefuseInputAnywhere(comm, *message ? message : NULL));
  PetscCall(Hdf5TableOpenFile(comm, name, H5F_ACC_RDONLY, &(*archive)->file));
  (*archive)->loads = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rank 0: everything to the disk, then the final name; the cause of a failure, or 0 */
static int MoveInPlace(const char *temporary, const char *name)
{
  char  directory[PETSC_MAX_PATH_LEN];
  char *slash;
  int   file = open(temporary, O_RDONLY), cause = 0;

  if (file < 0) return errno;
  if (fsync(file)) cause = errno;
  close(file);
  if (cause || rename(temporary, name)) return cause ? cause : errno;
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

/* ArchiveClose - ends it; a saved file takes the place of the one before.

   Collective. Errors: PETSC_ERR_FILE_WRITE, with the file before intact. */
PetscErrorCode ArchiveClose(Archive *archive)
{
  Archive a     = *archive;
  int     cause = 0;

  PetscFunctionBeginUser;
  if (!a) PetscFunctionReturn(PETSC_SUCCESS);
  if (!a->measures) {
    if (!a->loads) CallHDF5(H5Fflush(a->file, H5F_SCOPE_GLOBAL)); /* every rank syncs what it wrote */
    CallHDF5(H5Fclose(a->file));
  }
  if (!a->measures && !a->loads) {
    PetscCallMPI(MPI_Barrier(a->comm));
    if (!a->rank) cause = MoveInPlace(a->temporary, a->name);
    PetscCheck(!cause, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write %s: %s; what stood there before is intact",
               a->name, strerror(cause));
    PetscCallMPI(MPI_Barrier(a->comm)); /* it is there when any rank goes on */
  }
  PetscCall(PetscFree(*archive));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ArchiveLoads - do values come from the file, to be taken over? Not collective. */
PetscBool ArchiveLoads(Archive archive)
{
  return archive->loads;
}

/* Opens a dataset to be read and refuses one that is missing or has another number of values than wanted; < 0: any
 * number. */
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
  if (found < 0 || (values >= 0 && found != values))
    PetscCall(RefuseInput(
      a->comm, "%s is damaged: /%s has %lld values where %lld belong; allowed: a whole checkpoint of this scene",
      a->name, name, (long long)PetscMax(found, 0), (long long)values));
  *size = (hsize_t)found;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ArchiveHas - does the file hold such a value? Loading only. Collective. */
PetscErrorCode ArchiveHas(Archive a, const char *name, PetscBool *there)
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  *there = PETSC_TRUE;
  for (const char *end = name; *there && end;
       end             = strchr(end + 1, '/')) { /* H5Lexists() wants every group on the way to be there */
    if (end == name) continue;
    snprintf(path, sizeof(path), "%.*s", (int)(end - name), name);
    *there = H5Lexists(a->file, path, H5P_DEFAULT) > 0 ? PETSC_TRUE : PETSC_FALSE;
  }
  if (*there) *there = H5Lexists(a->file, name, H5P_DEFAULT) > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads rows first to first + n - 1 of `width` values. */
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

/* n values of one HDF5 type, `size` bytes each, the same on all ranks. */
static PetscErrorCode ArchiveShared(Archive a, const char *name, PetscInt n, hid_t type, size_t size, void *values)
{
  hid_t   data;
  hsize_t found;

  PetscFunctionBeginUser;
  if (a->loads) {
    PetscCall(OpenDataset(a, name, n, &data, &found));
    PetscCall(ReadPart(data, 0, found, 1, type, values));
    CallHDF5(H5Dclose(data));
  } else if (a->measures)
    a->bytes += a->rank ? 0 : ARCHIVE_DATASET_BYTES + n * (PetscInt64)size;
  else
    PetscCall(Hdf5TableWrite(a->file, name, (hsize_t)n, 0, a->rank ? 0 : (hsize_t)n, 1, type, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ArchiveReals - n numbers that all ranks share. Collective. */
PetscErrorCode ArchiveReals(Archive a, const char *name, PetscInt n, PetscReal *values)
{
  PetscFunctionBeginUser;
  PetscCall(ArchiveShared(a, name, n, H5T_NATIVE_DOUBLE, sizeof(double), values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ArchiveIntegers - n whole numbers that all ranks share. Collective. */
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

/* ArchiveRealsAt - n numbers that all ranks share, each in its own place. Collective. */
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

/* ArchiveIntegersAt - n whole numbers that all ranks share, each in its own place. Collective. */
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

/* ArchiveBoolean - Collective. */
PetscErrorCode ArchiveBoolean(Archive a, const char *name, PetscBool *value)
{
  PetscInt number = *value;

  PetscFunctionBeginUser;
  PetscCall(ArchiveIntegers(a, name, 1, &number));
  *value = number ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The length of what is loaded next. */
static PetscErrorCode LoadedLength(Archive a, const char *name, PetscInt *n)
{
  hid_t   data;
  hsize_t found;

  PetscFunctionBeginUser;
  PetscCall(OpenDataset(a, name, -1, &data, &found));
  CallHDF5(H5Dclose(data));
  *n = (PetscInt)found;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ArchiveIntegerList - any number of whole numbers that all ranks share; loaded, free with PetscFree(). Collective. */
PetscErrorCode ArchiveIntegerList(Archive a, const char *name, PetscInt *n, PetscInt **list)
{
  PetscFunctionBeginUser;
  if (a->loads) {
    PetscCall(LoadedLength(a, name, n));
    PetscCall(PetscMalloc1(*n, list));
  }
  PetscCall(ArchiveIntegers(a, name, *n, *list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ArchiveText - a text that all ranks share; loaded, free with PetscFree(). Collective. */
PetscErrorCode ArchiveText(Archive a, const char *name, char **text)
{
  PetscInt n;

  PetscFunctionBeginUser;
  if (a->loads) {
    PetscCall(LoadedLength(a, name, &n));
    PetscCall(PetscCalloc1(n + 1, text));
  } else
    PetscCall(PetscIntCast(strlen(*text), &n));
  PetscCall(ArchiveShared(a, name, n, H5T_NATIVE_CHAR, 1, *text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ArchiveRows - items[rows->items * width], by their rows. Collective. */
PetscErrorCode ArchiveRows(Archive a, const char *name, const Hdf5Table *rows, int width, PetscReal *items)
{
  PetscReal *values;
  hid_t      data;
  hsize_t    found;

  PetscFunctionBeginUser;
  if (a->loads) {
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

/* ArchiveBytes - *n bytes of this rank, behind those of the ranks before it; loaded, each rank gets an equal share, to
   be freed with PetscFree(). Collective. */
PetscErrorCode ArchiveBytes(Archive a, const char *name, PetscInt64 *n, char **bytes)
{
  PetscInt64  first = 0, total;
  PetscMPIInt size;
  hid_t       data;
  hsize_t     found;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(a->comm, &size));
  if (a->loads) {
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

/* ArchiveExtract - all bytes of ArchiveBytes() to a stream of rank 0's. Collective; loading only. Errors:
 * PETSC_ERR_FILE_WRITE. */
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
