/* A viscous restraint of all bodies, see damping.h. */
#include "solve/damping.h"
#include "kernels/elementkernel.h"

struct _n_Damping {
  Vec       volume, anchor, work; /* of each free dof: its node's volume; where the restraint has no force */
  PetscReal scale;                /* force per length and volume; 0: none */
  PetscBool changed;              /* the scale is another one than that of the last tangent */
};

/* Gives each node of a cell an equal part of the cell's volume, at each of its dofs. Tools have none. */
static PetscErrorCode NodeVolumes(Mesh mesh, Scene scene, PetscReal *volume)
{
  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt first = mesh->cell_ptr[c], n = mesh->cell_ptr[c + 1] - first;
    PetscReal      X[ELEMENT_MAX_NODES * 3], part;

    MeshCellCoordinates(mesh, c, X);
    part = CellVolume(mesh->cell_type[c], mesh->dim, scene->geometry, X) / (PetscReal)n;
    for (PetscInt k = 0; k < n; k++)
      for (int d = 0; d < mesh->dim; d++) volume[mesh->cell_nodes[first + k] * mesh->dim + d] += part;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DampingCreate - makes the restraint, with a scale of 0.

  Collective

  Input Parameters:
+ mesh  - the mesh
. scene - its geometry
- like  - a vector of the free dofs, whose layout is taken

  Output Parameter:
. out - free it with DampingDestroy()
@*/
PetscErrorCode DampingCreate(Mesh mesh, Scene scene, Vec like, Damping *out)
{
  Damping    d;
  PetscReal *volume;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&d));
  PetscCall(VecDuplicate(like, &d->volume));
  PetscCall(VecDuplicate(like, &d->anchor));
  PetscCall(VecDuplicate(like, &d->work));
  PetscCall(VecZeroEntries(d->anchor));
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &volume));
  PetscCall(NodeVolumes(mesh, scene, volume));
  PetscCall(MeshLocalToGlobal(mesh, volume, d->volume));
  PetscCall(PetscFree(volume));
  *out = d;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DampingDestroy - frees the restraint.

  Collective

  Input Parameter:
. d - the restraint; set to NULL
@*/
PetscErrorCode DampingDestroy(Damping *d)
{
  PetscFunctionBeginUser;
  if (!*d) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDestroy(&(*d)->volume));
  PetscCall(VecDestroy(&(*d)->anchor));
  PetscCall(VecDestroy(&(*d)->work));
  PetscCall(PetscFree(*d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DampingAnchor - moves the anchor to a state, at which the restraint then has no force.

  Collective

  Input Parameters:
+ d - the restraint, or NULL
- x - free displacements (length)
@*/
PetscErrorCode DampingAnchor(Damping d, Vec x)
{
  PetscFunctionBeginUser;
  if (d) PetscCall(VecCopy(x, d->anchor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DampingReturn - gives the anchor.

  Collective

  Input Parameter:
. d - the restraint, or NULL

  Output Parameter:
. x - free displacements (length) of the anchor
@*/
PetscErrorCode DampingReturn(Damping d, Vec x)
{
  PetscFunctionBeginUser;
  if (d) PetscCall(VecCopy(d->anchor, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DampingSet - chooses the scale.

  Not collective, the same on all ranks

  Input Parameters:
+ d     - the restraint, or NULL
- scale - force per length and volume; 0: no restraint
@*/
void DampingSet(Damping d, PetscReal scale)
{
  if (!d || d->scale == scale) return;
  d->scale   = scale;
  d->changed = PETSC_TRUE;
}

/*@
  DampingChanged - says once after each change of the scale that no factor of an earlier tangent serves.

  Not collective, the same on all ranks

  Input Parameter:
. d - the restraint, or NULL
@*/
PetscBool DampingChanged(Damping d)
{
  const PetscBool changed = (PetscBool)(d && d->changed);

  if (d) d->changed = PETSC_FALSE;
  return changed;
}

/*@
  DampingMean - finds the scale at which the restraint is as stiff as the elements are, in the mean over the dofs.

  Collective

  Input Parameters:
+ d        - the restraint
- diagonal - of the elastic tangent (force per length)

  Output Parameter:
. scale - force per length and volume
@*/
PetscErrorCode DampingMean(Damping d, Vec diagonal, PetscReal *scale)
{
  PetscScalar stiffness, volume;

  PetscFunctionBeginUser;
  PetscCall(VecSum(diagonal, &stiffness));
  PetscCall(VecSum(d->volume, &volume));
  *scale = PetscRealPart(stiffness) / PetscRealPart(volume);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The forces of the restraint at x, into d->work. */
static PetscErrorCode Forces(Damping d, Vec x)
{
  PetscFunctionBeginUser;
  PetscCall(VecWAXPY(d->work, -1, d->anchor, x));
  PetscCall(VecPointwiseMult(d->work, d->work, d->volume));
  PetscCall(VecScale(d->work, d->scale));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DampingResidual - adds the forces of the restraint.

  Collective

  Input Parameters:
+ d - the restraint, or NULL
- x - free displacements (length)

  Input/Output Parameter:
. F - residual of the free dofs (force)
@*/
PetscErrorCode DampingResidual(Damping d, Vec x, Vec F)
{
  PetscFunctionBeginUser;
  if (!d || !(d->scale > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Forces(d, x));
  PetscCall(VecAXPY(F, 1, d->work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DampingLoad - finds the forces of the restraint and the work that is done against them in the pseudo-time step.

  Collective

  Input Parameters:
+ d - the restraint
- x - free displacements (length) at the end of the step

  Output Parameters:
+ force - norm of the forces
- work  - they are constant over a step of the implicit Euler method: force times displacement
@*/
PetscErrorCode DampingLoad(Damping d, Vec x, PetscReal *force, PetscReal *work)
{
  PetscScalar end, start;

  PetscFunctionBeginUser;
  PetscCall(Forces(d, x));
  PetscCall(VecNorm(d->work, NORM_2, force));
  PetscCall(VecDot(d->work, x, &end));
  PetscCall(VecDot(d->work, d->anchor, &start));
  *work = PetscRealPart(end - start);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DampingEnergy - adds the potential of the restraint, whose derivative are its forces.

  Collective

  Input Parameters:
+ d - the restraint, or NULL
- x - free displacements (length)

  Input/Output Parameter:
. energy - the sum
@*/
PetscErrorCode DampingEnergy(Damping d, Vec x, PetscReal *energy)
{
  PetscReal force = 0, work = 0;

  PetscFunctionBeginUser;
  if (!d || !(d->scale > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DampingLoad(d, x, &force, &work));
  *energy += work / 2;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DampingTangent - adds the stiffness of the restraint to a matrix.

  Collective

  Input Parameter:
. d - the restraint, or NULL

  Input/Output Parameter:
. A - the tangent
@*/
PetscErrorCode DampingTangent(Damping d, Mat A)
{
  PetscFunctionBeginUser;
  if (!d || !(d->scale > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecCopy(d->volume, d->work));
  PetscCall(VecScale(d->work, d->scale));
  PetscCall(MatDiagonalSet(A, d->work, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}
