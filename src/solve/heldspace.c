/* The space of the soft motions that are held: how motions are added to it, and their answers to a new tangent. */
#include "files/archive.h"
#include "mesh/meshdofs.h"
#include "modelimpl.h"

/*@
  ModelHeldDestroy - frees the motions that are held.

  Collective

  Input Parameter:
. held - the motions
@*/
PetscErrorCode ModelHeldDestroy(HeldMotion *held)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < HELD_MOST; i++) {
    PetscCall(VecDestroy(&held->b[i]));
    PetscCall(VecDestroy(&held->w[i]));
  }
  PetscCall(VecDestroy(&held->last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether motions remain what they are once they have been found. In space a body has many, and those of the next
   tangent are others: held along these it would be free along the ones before, and go on along them from list to list.
   In the plane there is one, which is followed. */
static PetscBool Remain(Model model)
{
  return (PetscBool)(model->mesh->dim == 3);
}

/*@
  ModelHeldBegin - begins a load step with the motions that were held in the accepted state.

  Not collective

  Input Parameter:
. model - the model
@*/
void ModelHeldBegin(Model model)
{
  HeldMotion *held = &model->work->hold;

  held->wanted   = held->accepted;
  held->n        = 0;
  held->known    = Remain(model) ? held->accepted : 0;
  held->ready    = PETSC_FALSE;
  held->released = PETSC_FALSE;
  held->moves    = PETSC_FALSE;
  held->stays    = PETSC_FALSE;
  held->idle     = 0;
  held->times    = 0;
  held->rested   = PETSC_TRUE;
}

/*@
  ModelHeldFail - notes that a load step is taken back. Where it has moved held motions on, they are held more firmly.

  Not collective

  Input Parameter:
. model - the model
@*/
void ModelHeldFail(Model model)
{
  HeldMotion *held = &model->work->hold;

  held->firm = (PetscBool)(held->firm || (Remain(model) && held->times > 0));
}

/*@
  ModelHeldBeginSolve - begins a solve of Newton's method with the motions that are held.

  Not collective

  Input Parameter:
. model - the model
@*/
void ModelHeldBeginSolve(Model model)
{
  HeldMotion *held = &model->work->hold;

  held->anew   = (PetscBool) !(Remain(model) && held->known);
  held->futile = PETSC_FALSE;
}

/* Makes room for motion i. */
static PetscErrorCode MakeRoom(HeldMotion *held, int i, Vec like)
{
  PetscFunctionBeginUser;
  if (held->b[i]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(like, &held->b[i]));
  PetscCall(VecDuplicate(like, &held->w[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelHeldArchive - saves or loads the motions that were held in the accepted state.

  Collective

  Input Parameters:
+ model   - between two steps
. archive - decides whether they are saved or loaded
- nodes   - rows of the mesh's nodes
@*/
PetscErrorCode ModelHeldArchive(Model model, Archive archive, const Hdf5Table *nodes)
{
  HeldMotion *held     = &model->work->hold;
  PetscInt    accepted = held->accepted, firm = held->firm, dull = held->dull;
  PetscReal  *b;

  PetscFunctionBeginUser;
  PetscCall(ArchiveIntegers(archive, "model/held_motions", 1, &accepted));
  PetscCheck(accepted >= 0 && accepted <= HELD_MOST, model->mesh->comm, PETSC_ERR_FILE_UNEXPECTED,
             "%" PetscInt_FMT " held motions", accepted);
  held->accepted = (int)accepted;
  PetscCall(ArchiveIntegers(archive, "model/held_firmly", 1, &firm));
  PetscCall(ArchiveIntegers(archive, "model/held_moves_futile", 1, &dull));
  held->firm = (PetscBool)firm;
  held->dull = (PetscBool)dull;
  PetscCall(PetscCalloc1(model->mesh->n_nodes * model->mesh->dim, &b));
  for (int i = 0; Remain(model) && i < held->accepted; i++) {
    char name[32];

    PetscCall(PetscSNPrintf(name, sizeof(name), "model/held_motion_%d", i));
    PetscCall(MakeRoom(held, i, model->x));
    if (!ArchiveLoads(archive)) PetscCall(MeshGlobalToLocal(model->mesh, held->b[i], b));
    PetscCall(ArchiveRows(archive, name, nodes, model->mesh->dim, b));
    if (ArchiveLoads(archive)) PetscCall(MeshCollectFree(model->mesh, b, held->b[i]));
  }
  PetscCall(PetscFree(b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the answer of the next motion, which is then held. One that no force moves is not. */
static PetscErrorCode Answer(Model model)
{
  HeldMotion *held = &model->work->hold;
  const int   i    = held->n;

  PetscFunctionBeginUser;
  PetscCall(ModelHeldSolve(model, held->b[i], held->w[i]));
  PetscCall(VecDotRealPart(held->b[i], held->w[i], &held->compliance[i]));
  if (held->compliance[i] != 0) held->n++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelHeldAdd - finds the softest motion besides those that are held, and holds it too.

  Collective

  Input Parameters:
+ model - after a solve with the present tangent
- start - any vector that has a part of the motion (length)

  Output Parameters:
+ stiffness - of the tangent along it
- part      - of the motion in the vector (length)
@*/
PetscErrorCode ModelHeldAdd(Model model, Vec start, PetscReal *stiffness, PetscReal *part)
{
  HeldMotion *held = &model->work->hold;
  const int   i    = held->n;
  Vec         v;

  PetscFunctionBeginUser;
  PetscCall(MakeRoom(held, i, start));
  PetscCall(VecDuplicate(start, &v));
  PetscCall(ModelSoftMotion(model, start, v, stiffness, part));
  PetscCall(ModelDropPressures(model, v, held->b[i]));
  PetscCall(VecDestroy(&v));
  PetscCall(Answer(model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelHeldOut - takes the motions that are held out of the answer to forces that has just been found.

  Collective

  Input Parameters:
+ model - after a solve with the present tangent
- y     - its solution (length)

  Output Parameter:
. y - without the motions
@*/
PetscErrorCode ModelHeldOut(Model model, Vec y)
{
  PetscFunctionBeginUser;
  if (!model->work->hold.wanted) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelHeldRefresh(model, y));
  PetscCall(ModelHeldTakeOut(model, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelHeldRefresh - finds the answers of the motions that are to be held to the present tangent, and the motions, where
  they are not known or are to be found anew.

  Collective

  Input Parameters:
+ model - after a solve with that tangent
- y     - the step (length)
@*/
PetscErrorCode ModelHeldRefresh(Model model, Vec y)
{
  HeldMotion *held  = &model->work->hold;
  const int   known = held->known;
  PetscReal   stiffness, part;
  Vec         start;

  PetscFunctionBeginUser;
  held->n = 0;
  PetscCall(VecDuplicate(y, &start));
  for (int i = 0; i < held->wanted && held->n == i; i++) {
    if (i < known && !held->anew) {
      PetscCall(Answer(model));
      continue;
    }
    PetscCall(VecCopy(i > 0 && i < known ? held->b[i] : y, start));
    PetscCall(ModelHeldTakeOut(model, start));
    PetscCall(ModelHeldAdd(model, start, &stiffness, &part));
  }
  PetscCall(VecDestroy(&start));
  held->wanted = held->known = held->n;
  held->anew                 = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
