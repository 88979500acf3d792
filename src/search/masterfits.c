/* Fits about the faces of the master that a rank owns, see searchimpl.h. */
#include "searchimpl.h"

/*@
  MasterFitsCreate - prepares fits about this rank's own faces of the master.

  Collective

  Input Parameters:
+ s    - the search
. u    - local displacements u[n_nodes*dim] (length), ghosts included
. t    - load parameter
- some - which of the faces; NULL: all

  Output Parameter:
. fits - free them with MasterFitsDestroy()
@*/
PetscErrorCode MasterFitsCreate(ContactSearch s, const PetscReal *u, PetscReal t, const PetscBool *some,
                                MasterFits *fits)
{
  PetscReal box[6];

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&fits->lists));
  SearchMasterBox(s, u, t, some, box);
  PetscCall(SearchFieldCreate(s, u, t, box, SearchFitReach(s), s->fit->fitted, fits->lists, &fits->field));
  PetscCall(FitSupportCreate(s, fits->lists, &fits->field, &fits->fit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MasterFitsDestroy - frees prepared fits.

  Collective

  Input Parameter:
. fits - their arrays are freed
@*/
PetscErrorCode MasterFitsDestroy(MasterFits *fits)
{
  PetscFunctionBeginUser;
  PetscCall(FitSupportDestroy(&fits->fit));
  PetscCall(SearchFieldDestroy(&fits->field));
  PetscCall(NeighbourListsDestroy(&fits->lists));
  PetscFunctionReturn(PETSC_SUCCESS);
}
