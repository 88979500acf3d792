/* The errors of elements in results.vtkhdf, see errorfields.h. */
#include "errorfields.h"
#include "files/hdf5table.h"
#include "files/textfile.h"

enum { PATH_ROOM = 160 };

/* Writes the centres of the cells. */
static PetscErrorCode WriteCentres(Mesh mesh, const Hdf5Table *rows, hid_t file)
{
  PetscReal *centres;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_cells * 3, &centres));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const int corners = ElementGet(mesh->cell_type[c])->corners;

    for (int k = 0; k < corners; k++)
      for (int i = 0; i < mesh->dim; i++)
        centres[3 * c + i] += mesh->coords[mesh->cell_nodes[mesh->cell_ptr[c] + k] * mesh->dim + i] / corners;
    for (int i = 0; i < mesh->dim; i++) centres[3 * c + i] += mesh->centre[i];
  }
  PetscCall(Hdf5TableWriteReals(file, "/error/centres", rows, 3, centres));
  PetscCall(PetscFree(centres));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ErrorFieldsWrite - adds the errors of the elements to results.vtkhdf.

  Collective

  Input Parameters:
+ mesh      - of the run
. scene     - its probes
. errors    - of the probes; NULL: nothing is written
- directory - of the results, which holds results.vtkhdf

  Note:
  Errors: PETSC_ERR_FILE_OPEN, PETSC_ERR_FILE_WRITE.
@*/
PetscErrorCode ErrorFieldsWrite(Mesh mesh, Scene scene, ProbeErrors errors, const char *directory)
{
  char      path[TEXTFILE_PATH_SIZE], name[PATH_ROOM];
  Hdf5Table rows;
  hid_t     file, group;

  PetscFunctionBeginUser;
  if (!errors) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/results.vtkhdf", directory));
  PetscCall(Hdf5TableOpenFile(mesh->comm, path, H5F_ACC_RDWR, &file));
  CallHDF5(group = H5Gcreate2(file, "/error", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  CallHDF5(H5Gclose(group));
  PetscCall(Hdf5TableCreate(mesh->comm, mesh->n_cells_global, mesh->n_cells, mesh->cell_id, &rows));
  PetscCall(WriteCentres(mesh, &rows, file));
  for (int i = 0; i < scene->n_probes; i++) {
    PetscReal            value;
    const char          *why;
    const QuantityError *error = ProbeErrorsGet(errors, i, &value, &why);

    if (why || !error->shared) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "/error/%s", scene->probes[i].name));
    PetscCall(Hdf5TableWriteReals(file, name, &rows, 1, error->cells));
  }
  PetscCall(Hdf5TableDestroy(&rows));
  CallHDF5(H5Fclose(file));
  PetscFunctionReturn(PETSC_SUCCESS);
}
