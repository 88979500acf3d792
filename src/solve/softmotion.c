/* The softest motion in a linear step, by inverse iterations. */
#include "mesh/meshdofs.h"
#include "mesh/pressurenodes.h"
#include "modelimpl.h"

/* Inverse iterations that start from a step. The step itself is one more: it is a solve, too. */
enum { SOFT_ITERATIONS = 2 };

/* Copies a vector of the free dofs without the pressures of nodes. */
static PetscErrorCode DropPressures(Mesh mesh, Vec from, Vec to)
{
  const PetscInt n = mesh->n_nodes * mesh->dim;
  PetscReal     *f;

  PetscFunctionBeginUser;
  if (!mesh->saddle) {
    PetscCall(VecCopy(from, to));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscCalloc1(n, &f));
  PetscCall(MeshGlobalToLocal(mesh, from, f));
  for (PetscInt i = 0; i < n; i++)
    if (IsPressureNode(mesh, i / mesh->dim)) f[i] = 0;
  PetscCall(MeshCollectFree(mesh, f, to));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelSoftPart - finds the part of a linear step that is its softest motion.

  Collective

  Input Parameters:
+ model - after a solve with the tangent at the step's start
- y     - the step: free displacements (length)

  Output Parameters:
+ soft      - that part (length)
- stiffness - of the tangent along it; below 0 where it leads to or from a saddle

  Notes:
  Rubber that can roll or slide along rigid walls with next to no energy has one motion that is softer than all others
by orders of magnitude. Newton's step may be much too long in this one motion alone, while the rest of the step is
right. The motion keeps the volume where nodes have pressures.
@*/
PetscErrorCode ModelSoftPart(Model model, Vec y, Vec soft, PetscReal *stiffness)
{
  PetscReal norm, part, length;
  KSP       ksp;
  Vec       b;

  PetscFunctionBeginUser;
  PetscCall(SNESGetKSP(model->snes, &ksp));
  PetscCall(VecDuplicate(y, &b));
  PetscCall(VecCopy(y, soft));
  for (int i = 0; i < SOFT_ITERATIONS; i++) {
    PetscCall(DropPressures(model->mesh, soft, b));
    PetscCall(VecNorm(b, NORM_2, &norm));
    if (norm > 0) PetscCall(VecScale(b, 1 / norm));
    PetscCall(KSPSolve(ksp, b, soft));
  }
  PetscCall(VecDotRealPart(soft, b, stiffness));
  PetscCall(DropPressures(model->mesh, soft, b));
  PetscCall(VecDotRealPart(b, b, &length));
  PetscCall(VecDotRealPart(b, y, &part));
  PetscCall(VecScale(soft, length > 0 ? part / length : 0));
  PetscCall(VecDestroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
