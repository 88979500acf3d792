/* Tables in HDF5 files by rows that do not depend on the ranks, see hdf5table.h. */
#include "files/hdf5table.h"
#include <string.h>

/*@
  Hdf5TableCreate - describes the rows of a table and which of them are items of this rank.

  Collective

  Input Parameters:
+ comm  - of the run
. total - rows of the table
. n     - items of this rank
- row   - row of each item; items that share a row must be equal, any one of them is written

  Output Parameter:
. rows - free it with Hdf5TableDestroy()
@*/
PetscErrorCode Hdf5TableCreate(MPI_Comm comm, PetscInt total, PetscInt n, const PetscInt *row, Hdf5Table *rows)
{
  PetscLayout layout;

  PetscFunctionBeginUser;
  PetscCall(PetscLayoutCreate(comm, &layout));
  PetscCall(PetscLayoutSetSize(layout, total));
  PetscCall(PetscLayoutSetUp(layout));
  PetscCall(PetscLayoutGetLocalSize(layout, &rows->n));
  PetscCall(PetscLayoutGetRange(layout, &rows->first, NULL));
  rows->total = total;
  rows->items = n;
  PetscCall(PetscSFCreate(comm, &rows->sf));
  PetscCall(PetscSFSetGraphLayout(rows->sf, layout, n, NULL, PETSC_COPY_VALUES, row));
  PetscCall(PetscLayoutDestroy(&layout));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  Hdf5TableCreateByKey - describes a table with one row for each key, in ascending order.

  Collective

  Input Parameters:
+ comm - of the run
. n    - items of this rank
- key  - of each item; each key is on one rank once

  Output Parameter:
. rows - free it with Hdf5TableDestroy()

  Note:
  Every rank sees all keys: for tables that are small beside the mesh.
@*/
PetscErrorCode Hdf5TableCreateByKey(MPI_Comm comm, PetscInt n, const PetscInt *key, Hdf5Table *rows)
{
  PetscMPIInt size, mine, total = 0, *counts, *starts;
  PetscInt   *all, *row;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMPIIntCast(n, &mine));
  PetscCall(PetscMalloc3(n, &row, size, &counts, size, &starts));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, counts, 1, MPI_INT, comm));
  for (PetscMPIInt r = 0; r < size; r++) {
    starts[r] = total;
    total += counts[r];
  }
  PetscCall(PetscMalloc1(total, &all));
  PetscCallMPI(MPI_Allgatherv(key, mine, MPIU_INT, all, counts, starts, MPIU_INT, comm));
  PetscCall(PetscSortInt(total, all));
  for (PetscInt k = 0; k < n; k++) PetscCall(PetscFindInt(key[k], total, all, &row[k]));
  PetscCall(Hdf5TableCreate(comm, total, n, row, rows));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree3(row, counts, starts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  Hdf5TableDestroy - frees the description of a table.

  Collective

  Input Parameter:
. rows - the table
@*/
PetscErrorCode Hdf5TableDestroy(Hdf5Table *rows)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSFDestroy(&rows->sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  Hdf5TableCollect - brings items to the ranks that write their rows.

  Collective

  Input Parameters:
+ rows  - the table
. width - values of an item
. type  - MPI type of a value
- items - [rows->items * width]

  Output Parameter:
. values - [rows->n * width], in the order of the rows
@*/
PetscErrorCode Hdf5TableCollect(const Hdf5Table *rows, int width, MPI_Datatype type, const void *items, void *values)
{
  MPI_Datatype unit;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Type_contiguous(width, type, &unit));
  PetscCallMPI(MPI_Type_commit(&unit));
  PetscCall(PetscSFReduceBegin(rows->sf, unit, items, values, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(rows->sf, unit, items, values, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&unit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  Hdf5TableSpread - brings rows to the ranks that have them as items: the reverse of Hdf5TableCollect().

  Collective

  Input Parameters:
+ rows   - the table
. width  - values of an item
. type   - MPI type of a value
- values - [rows->n * width], in the order of the rows

  Output Parameter:
. items - [rows->items * width]
@*/
PetscErrorCode Hdf5TableSpread(const Hdf5Table *rows, int width, MPI_Datatype type, const void *values, void *items)
{
  MPI_Datatype unit;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Type_contiguous(width, type, &unit));
  PetscCallMPI(MPI_Type_commit(&unit));
  PetscCall(PetscSFBcastBegin(rows->sf, unit, values, items, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(rows->sf, unit, values, items, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&unit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  Hdf5TableWrite - makes a dataset, with the groups above it, of which every rank writes a part.

  Collective

  Input Parameters:
+ file   - open on all ranks
. path   - of the dataset
. total  - rows of all ranks
. first  - first row of this rank
. n      - rows of this rank
. width  - values of a row
. type   - native HDF5 type of the values
- values - [n * width]
@*/
PetscErrorCode Hdf5TableWrite(hid_t file, const char *path, hsize_t total, hsize_t first, hsize_t n, int width,
                              hid_t type, const void *values)
{
  const hsize_t size[2] = {total, (hsize_t)width}, start[2] = {first, 0}, count[2] = {n, (hsize_t)width};
  const int     rank = width > 1 ? 2 : 1;
  hid_t         space, memory, links, transfer, data;

  PetscFunctionBeginUser;
  CallHDF5(space = H5Screate_simple(rank, size, NULL));
  CallHDF5(memory = H5Screate_simple(rank, count, NULL));
  CallHDF5(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL));
  if (!n) {
    CallHDF5(H5Sselect_none(space));
    CallHDF5(H5Sselect_none(memory));
  }
  CallHDF5(links = H5Pcreate(H5P_LINK_CREATE));
  CallHDF5(H5Pset_create_intermediate_group(links, 1));
  CallHDF5(data = H5Dcreate2(file, path, type, space, links, H5P_DEFAULT, H5P_DEFAULT));
  CallHDF5(transfer = H5Pcreate(H5P_DATASET_XFER));
  CallHDF5(H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE));
  if (total) CallHDF5(H5Dwrite(data, type, memory, space, transfer, values)); /* HDF5 gives an empty dataset no place */
  CallHDF5(H5Dclose(data));
  CallHDF5(H5Pclose(transfer));
  CallHDF5(H5Pclose(links));
  CallHDF5(H5Sclose(memory));
  CallHDF5(H5Sclose(space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes items of a type, `size` bytes a value, as a dataset. */
static PetscErrorCode WriteItems(hid_t file, const char *path, const Hdf5Table *rows, int width, MPI_Datatype unit,
                                 hid_t type, size_t size, const void *items)
{
  char *values;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((size_t)rows->n * width * size, &values));
  PetscCall(Hdf5TableCollect(rows, width, unit, items, values));
  PetscCall(
    Hdf5TableWrite(file, path, (hsize_t)rows->total, (hsize_t)rows->first, (hsize_t)rows->n, width, type, values));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  Hdf5TableWriteReals - writes items as a dataset of doubles.

  Collective

  Input Parameters:
+ file  - open on all ranks
. path  - of the dataset, which is made with the groups above it
. rows  - the table
. width - values of an item
- items - [rows->items * width]
@*/
PetscErrorCode Hdf5TableWriteReals(hid_t file, const char *path, const Hdf5Table *rows, int width,
                                   const PetscReal *items)
{
  PetscFunctionBeginUser;
  PetscCall(WriteItems(file, path, rows, width, MPIU_REAL, H5T_NATIVE_DOUBLE, sizeof(PetscReal), items));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  Hdf5TableWriteIntegers - writes items as a dataset of 64-bit integers.

  Collective

  Input Parameters:
+ file  - open on all ranks
. path  - of the dataset, which is made with the groups above it
. rows  - the table
. width - values of an item
- items - [rows->items * width]
@*/
PetscErrorCode Hdf5TableWriteIntegers(hid_t file, const char *path, const Hdf5Table *rows, int width,
                                      const int64_t *items)
{
  PetscFunctionBeginUser;
  PetscCall(WriteItems(file, path, rows, width, MPI_INT64_T, H5T_NATIVE_INT64, sizeof(int64_t), items));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FileAccess(MPI_Comm comm, hid_t *access)
{
  PetscFunctionBeginUser;
  CallHDF5(*access = H5Pcreate(H5P_FILE_ACCESS));
  CallHDF5(H5Pset_fapl_mpio(*access, comm, MPI_INFO_NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  Hdf5TableCreateFileBehind - creates an HDF5 file behind bytes that are the caller's, in the place of any old file.

  Collective

  Input Parameters:
+ comm - the ranks on which it is open
. name - of the file
- own  - number of bytes at the start that HDF5 leaves alone (its "user block"): 0, or a power of 2 from 512 on

  Output Parameter:
. file - to be closed with H5Fclose()

  Note:
  Errors: PETSC_ERR_FILE_OPEN.
@*/
PetscErrorCode Hdf5TableCreateFileBehind(MPI_Comm comm, const char *name, hsize_t own, hid_t *file)
{
  hid_t access, creation;

  PetscFunctionBeginUser;
  PetscCall(FileAccess(comm, &access));
  CallHDF5(creation = H5Pcreate(H5P_FILE_CREATE));
  CallHDF5(H5Pset_userblock(creation, own));
  *file = H5Fcreate(name, H5F_ACC_TRUNC, creation, access);
  PetscCheck(*file >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "HDF5 could not make %s", name);
  CallHDF5(H5Pclose(creation));
  CallHDF5(H5Pclose(access));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  Hdf5TableCreateFile - makes a new HDF5 file in the place of any old one and opens it on all ranks.

  Collective

  Input Parameters:
+ comm - of the run
- name - of the file

  Output Parameter:
. file - close it with H5Fclose()

  Note:
  Errors: PETSC_ERR_FILE_OPEN.
@*/
PetscErrorCode Hdf5TableCreateFile(MPI_Comm comm, const char *name, hid_t *file)
{
  PetscFunctionBeginUser;
  PetscCall(Hdf5TableCreateFileBehind(comm, name, 0, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  Hdf5TableOpenFile - opens an HDF5 file on all ranks.

  Collective

  Input Parameters:
+ comm - of the run
. name - of the file
- mode - H5F_ACC_RDWR or H5F_ACC_RDONLY

  Output Parameter:
. file - close it with H5Fclose()

  Note:
  Errors: PETSC_ERR_FILE_OPEN.
@*/
PetscErrorCode Hdf5TableOpenFile(MPI_Comm comm, const char *name, unsigned mode, hid_t *file)
{
  hid_t access;

  PetscFunctionBeginUser;
  PetscCall(FileAccess(comm, &access));
  *file = H5Fopen(name, mode, access);
  PetscCheck(*file >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "HDF5 could not open %s", name);
  CallHDF5(H5Pclose(access));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  Hdf5WriteText - writes a text as an attribute of a group or a dataset, in the place of one of the same name.

  Collective on the file

  Input Parameters:
+ object - the group or the dataset
. name   - of the attribute
- text   - the value, not empty

  Note:
  Errors: PETSC_ERR_FILE_WRITE.
@*/
PetscErrorCode Hdf5WriteText(hid_t object, const char *name, const char *text)
{
  hid_t type;

  PetscFunctionBeginUser;
  CallHDF5(type = H5Tcopy(H5T_C_S1));
  CallHDF5(H5Tset_size(type, strlen(text)));
  CallHDF5(H5Tset_strpad(type, H5T_STR_NULLPAD));
  PetscCall(Hdf5WriteAttribute(object, name, type, 1, text));
  CallHDF5(H5Tclose(type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  Hdf5WriteAttribute - writes an attribute of a group or a dataset, in the place of one of the same name.

  Collective on the file

  Input Parameters:
+ object - the group or the dataset
. name   - of the attribute
. type   - HDF5 type of the values
. n      - number of values; 1 makes a scalar
- values - the values

  Note:
  Errors: PETSC_ERR_FILE_WRITE.
@*/
PetscErrorCode Hdf5WriteAttribute(hid_t object, const char *name, hid_t type, hsize_t n, const void *values)
{
  hid_t space, attribute;

  PetscFunctionBeginUser;
  if (H5Aexists(object, name) > 0) CallHDF5(H5Adelete(object, name));
  CallHDF5(space = n > 1 ? H5Screate_simple(1, &n, NULL) : H5Screate(H5S_SCALAR));
  CallHDF5(attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT));
  CallHDF5(H5Awrite(attribute, type, values));
  CallHDF5(H5Aclose(attribute));
  CallHDF5(H5Sclose(space));
  PetscFunctionReturn(PETSC_SUCCESS);
}
