/* An image of the bytes that a growing HDF5 file overwrites, see fileimage.h. */
#include "files/fileimage.h"
#include "files/hdf5table.h"
#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A run of bytes of the file, with its offset and its length in bytes. An image is an array of runs, which together are
   all bytes between the values of the datasets. Each run is followed by its bytes. The first run of an image has no
   bytes. Its `first` is the length of the file, and its `n` is the number of runs that follow. */
typedef struct {
  int64_t first, n;
} Run;

/* A list of runs of a file. It holds the values of the datasets until RunsInvert() replaces them by the other bytes. */
typedef struct {
  size_t n, room;
  Run   *run;
} Runs;

/* Orders runs by their offset, for qsort(). */
static int RunCompare(const void *a, const void *b)
{
  const Run *p = a, *q = b;

  return (p->first > q->first) - (p->first < q->first);
}

static PetscErrorCode RunsAdd(Runs *runs, int64_t first, int64_t n)
{
  PetscFunctionBeginUser;
  if (runs->n == runs->room) {
    runs->room = 2 * runs->room + 64;
    PetscCall(PetscRealloc(runs->room * sizeof(Run), &runs->run));
  }
  runs->run[runs->n++] = (Run){first, n};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the bytes of one dataset to the runs. H5Lvisit() calls this function for every link of the file. */
static herr_t VisitLink(hid_t file, const char *name, const H5L_info_t *info, void *runs)
{
  hid_t   object = H5Oopen(file, name, H5P_DEFAULT);
  haddr_t first  = H5Iget_type(object) == H5I_DATASET ? H5Dget_offset(object) : HADDR_UNDEF;

  (void)info;
  if (object < 0 || (first != HADDR_UNDEF && RunsAdd(runs, (int64_t)first, (int64_t)H5Dget_storage_size(object))))
    return -1;
  return H5Oclose(object);
}

/* Replaces the runs by all bytes between them. */
static PetscErrorCode RunsInvert(Runs *runs, int64_t length)
{
  Runs    between = {0};
  int64_t at      = 0;

  PetscFunctionBeginUser;
  qsort(runs->run, runs->n, sizeof(Run), RunCompare);
  for (size_t k = 0; k < runs->n; k++) {
    if (runs->run[k].first > at) PetscCall(RunsAdd(&between, at, runs->run[k].first - at));
    at = runs->run[k].first + runs->run[k].n;
  }
  if (length > at) PetscCall(RunsAdd(&between, at, length - at));
  PetscCall(PetscFree(runs->run));
  *runs = between;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FileImageTake - copies all bytes of an HDF5 file except the values of its datasets.

  Not collective

  Input Parameter:
. name - of the file, which must be closed

  Output Parameters:
+ data - the copy, to be freed with PetscFree()
- size - its size in bytes

  Note:
  For one rank. The datasets must be contiguous, as Hdf5TableWrite() makes them. The file is also synchronised with the
  disk, because the image is of no use without the values. Errors: PETSC_ERR_FILE_OPEN, PETSC_ERR_FILE_READ.
@*/
PetscErrorCode FileImageTake(const char *name, char **data, PetscInt64 *size)
{
  Runs        runs = {0};
  struct stat status;
  FILE       *stream;
  char       *at;
  hid_t       file;

  PetscFunctionBeginUser;
  file = H5Fopen(name, H5F_ACC_RDONLY, H5P_DEFAULT);
  PetscCheck(file >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "HDF5 could not open %s", name);
  CallHDF5(H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, VisitLink, &runs));
  CallHDF5(H5Fclose(file));
  stream = fopen(name, "r+b");
  PetscCheck(stream && !fstat(fileno(stream), &status), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "Cannot read %s: %s",
             name, strerror(errno));
  PetscCall(RunsInvert(&runs, (int64_t)status.st_size));
  *size = sizeof(Run);
  for (size_t k = 0; k < runs.n; k++) *size += (PetscInt64)sizeof(Run) + runs.run[k].n;
  PetscCall(PetscMalloc1(*size, data));
  at         = *data;
  *(Run *)at = (Run){(int64_t)status.st_size, (int64_t)runs.n};
  at += sizeof(Run);
  for (size_t k = 0; k < runs.n; k++) {
    const size_t n = (size_t)runs.run[k].n;

    memcpy(at, &runs.run[k], sizeof(Run));
    PetscCheck(!fseeko(stream, runs.run[k].first, SEEK_SET) && fread(at + sizeof(Run), 1, n, stream) == n,
               PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "Cannot read %s: %s", name, strerror(errno));
    at += sizeof(Run) + n;
  }
  fsync(fileno(stream)); /* The image is of no use if the values are not on the disk. */
  fclose(stream);
  PetscCall(PetscFree(runs.run));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FileImagePutBack - puts the copied bytes back and cuts the file to the length that it had.

  Not collective

  Input Parameters:
+ name - of the file, which must be closed
- data - the copy from FileImageTake()

  Output Parameter:
. done - PETSC_FALSE if the file is missing or shorter than it was; the file is then not changed

  Note:
  For one rank. Errors: PETSC_ERR_FILE_WRITE.
@*/
PetscErrorCode FileImagePutBack(const char *name, const char *data, PetscBool *done)
{
  struct stat status;
  FILE       *stream = fopen(name, "r+b");
  Run         head, run;
  PetscBool   failed = PETSC_FALSE;

  PetscFunctionBeginUser;
  memcpy(&head, data, sizeof(Run));
  *done = stream && !fstat(fileno(stream), &status) && status.st_size >= head.first ? PETSC_TRUE : PETSC_FALSE;
  data += sizeof(Run);
  for (int64_t k = 0; *done && k < head.n; k++) {
    memcpy(&run, data, sizeof(Run));
    data += sizeof(Run);
    if (fseeko(stream, run.first, SEEK_SET) || fwrite(data, 1, (size_t)run.n, stream) != (size_t)run.n)
      failed = PETSC_TRUE;
    data += run.n;
  }
  if (*done && (fflush(stream) || ftruncate(fileno(stream), head.first))) failed = PETSC_TRUE;
  if (stream && fclose(stream)) failed = PETSC_TRUE;
  PetscCheck(!failed, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "Cannot write %s: %s", name, strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}
