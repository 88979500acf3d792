/* A spring at each free dof, see dofsprings.h. */
#include "bodies/dofsprings.h"

struct _n_DofSprings {
  Vec       weight, anchor, work; /* of each free dof; where the spring has no force (length) */
  PetscReal scale;                /* times the weight: force per length */
  PetscReal shift;                /* times the weight: a stiffness without force (force per length) */
  PetscBool changed;              /* the scale is another one than that of the last tangent */
};

/*@
  DofSpringsCreate - makes springs with a scale of 1.

  Collective

  Input Parameters:
+ mesh   - the mesh
. weight - weight[n_nodes*dim] of each local dof; the parts of several ranks add up
- like   - a vector of the free dofs, whose layout is taken

  Output Parameter:
. out - the springs, without force at displacements of 0; free them with DofSpringsDestroy()
@*/
PetscErrorCode DofSpringsCreate(Mesh mesh, const PetscReal *weight, Vec like, DofSprings *out)
{
  DofSprings s;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  PetscCall(VecDuplicate(like, &s->weight));
  PetscCall(VecDuplicate(like, &s->anchor));
  PetscCall(VecDuplicate(like, &s->work));
  PetscCall(VecZeroEntries(s->anchor));
  PetscCall(MeshLocalToGlobal(mesh, weight, s->weight));
  s->scale   = 1;
  s->changed = PETSC_TRUE;
  *out       = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DofSpringsDestroy - frees the springs.

  Collective

  Input Parameter:
. s - the springs; set to NULL
@*/
PetscErrorCode DofSpringsDestroy(DofSprings *s)
{
  PetscFunctionBeginUser;
  if (!*s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDestroy(&(*s)->weight));
  PetscCall(VecDestroy(&(*s)->anchor));
  PetscCall(VecDestroy(&(*s)->work));
  PetscCall(PetscFree(*s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DofSpringsAnchor - moves the anchor to a state, at which the springs then have no force.

  Collective

  Input Parameters:
+ s - the springs
- x - free displacements (length)
@*/
PetscErrorCode DofSpringsAnchor(DofSprings s, Vec x)
{
  PetscFunctionBeginUser;
  PetscCall(VecCopy(x, s->anchor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DofSpringsReturn - gives the anchor.

  Collective

  Input Parameter:
. s - the springs

  Output Parameter:
. x - free displacements (length) of the anchor
@*/
PetscErrorCode DofSpringsReturn(DofSprings s, Vec x)
{
  PetscFunctionBeginUser;
  PetscCall(VecCopy(s->anchor, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DofSpringsScale - chooses the scale.

  Not collective, the same on all ranks

  Input Parameters:
+ s     - the springs
- scale - times the weights, it is the stiffness (force per length); 0: no springs
@*/
void DofSpringsScale(DofSprings s, PetscReal scale)
{
  if (s->scale == scale) return;
  s->scale   = scale;
  s->changed = PETSC_TRUE;
}

/*@
  DofSpringsChanged - says once after each change of the scale that no factor of an earlier tangent serves.

  Not collective, the same on all ranks

  Input Parameter:
. s - the springs, or NULL
@*/
PetscBool DofSpringsChanged(DofSprings s)
{
  const PetscBool changed = (PetscBool)(s && s->changed);

  if (s) s->changed = PETSC_FALSE;
  return changed;
}

/*@
  DofSpringsMean - finds the scale at which the springs are as stiff as a matrix is, in the mean over the dofs that have
  one.

  Collective

  Input Parameters:
+ s        - the springs
- diagonal - of the matrix (force per length)

  Output Parameter:
. scale - see DofSpringsScale()
@*/
PetscErrorCode DofSpringsMean(DofSprings s, Vec diagonal, PetscReal *scale)
{
  const PetscScalar *stiffness, *weight;
  PetscReal          sum[2] = {0, 0};
  PetscInt           n;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(diagonal, &n));
  PetscCall(VecGetArrayRead(diagonal, &stiffness));
  PetscCall(VecGetArrayRead(s->weight, &weight));
  for (PetscInt i = 0; i < n; i++) {
    if (weight[i] == 0) continue;
    sum[0] += stiffness[i];
    sum[1] += weight[i];
  }
  PetscCall(VecRestoreArrayRead(diagonal, &stiffness));
  PetscCall(VecRestoreArrayRead(s->weight, &weight));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, PetscObjectComm((PetscObject)diagonal)));
  *scale = sum[0] / sum[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DofSpringsMoving - computes the energy of springs of scale 1 where all dofs are stretched alike.

  Collective

  Input Parameters:
+ s      - the springs
- motion - the stretch (length)

  Output Parameter:
. energy - half the sum of the weights times the squared stretch
@*/
PetscErrorCode DofSpringsMoving(DofSprings s, PetscReal motion, PetscReal *energy)
{
  PetscScalar weight;

  PetscFunctionBeginUser;
  PetscCall(VecSum(s->weight, &weight));
  *energy = PetscRealPart(weight) * PetscSqr(motion) / 2;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DofSpringsStretch - computes x less the anchor.

  Collective

  Input Parameters:
+ s - the springs
- x - free displacements (length)

  Output Parameter:
. stretch - owned by the springs, until their next function is called (length)
@*/
PetscErrorCode DofSpringsStretch(DofSprings s, Vec x, Vec *stretch)
{
  PetscFunctionBeginUser;
  PetscCall(VecWAXPY(s->work, -1, s->anchor, x));
  *stretch = s->work;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DofSpringsForces - computes the forces.

  Collective

  Input Parameters:
+ s - the springs
- x - free displacements (length)

  Output Parameter:
. force - owned by the springs, until their next function is called
@*/
PetscErrorCode DofSpringsForces(DofSprings s, Vec x, Vec *force)
{
  PetscFunctionBeginUser;
  PetscCall(DofSpringsStretch(s, x, force));
  PetscCall(VecPointwiseMult(*force, *force, s->weight));
  PetscCall(VecScale(*force, s->scale));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DofSpringsResidual - adds the forces.

  Collective

  Input Parameters:
+ s - the springs, or NULL
- x - free displacements (length)

  Input/Output Parameter:
. F - residual of the free dofs (force)
@*/
PetscErrorCode DofSpringsResidual(DofSprings s, Vec x, Vec F)
{
  Vec force = NULL;

  PetscFunctionBeginUser;
  if (!s || !(s->scale > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DofSpringsForces(s, x, &force));
  PetscCall(VecAXPY(F, 1, force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DofSpringsLoad - finds how large the forces are, and the energy.

  Collective

  Input Parameters:
+ s - the springs
- x - free displacements (length)

  Output Parameters:
+ force  - norm of the forces
- energy - half of forces times displacements from the anchor
@*/
PetscErrorCode DofSpringsLoad(DofSprings s, Vec x, PetscReal *force, PetscReal *energy)
{
  PetscScalar end, start;
  Vec         forces;

  PetscFunctionBeginUser;
  PetscCall(DofSpringsForces(s, x, &forces));
  PetscCall(VecNorm(forces, NORM_2, force));
  PetscCall(VecDot(forces, x, &end));
  PetscCall(VecDot(forces, s->anchor, &start));
  *energy = PetscRealPart(end - start) / 2;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DofSpringsEnergy - adds the energy, whose derivative are the forces.

  Collective

  Input Parameters:
+ s - the springs, or NULL
- x - free displacements (length)

  Input/Output Parameter:
. energy - the sum
@*/
PetscErrorCode DofSpringsEnergy(DofSprings s, Vec x, PetscReal *energy)
{
  PetscReal force, mine = 0;

  PetscFunctionBeginUser;
  if (!s || !(s->scale > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DofSpringsLoad(s, x, &force, &mine));
  *energy += mine;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DofSpringsShift - chooses a stiffness that the tangent has besides, as if the springs were anchored at each iterate.

  Not collective, the same on all ranks

  Input Parameters:
+ s     - the springs
- shift - times the weights, it is the stiffness (force per length); 0: none
@*/
void DofSpringsShift(DofSprings s, PetscReal shift)
{
  s->shift = shift;
}

/*@
  DofSpringsShiftWork - computes the work against springs with the stiffness of the shift, with the force that they have
  at the end all the way from the anchor.

  Collective

  Input Parameters:
+ s - the springs
- x - free displacements (length)

  Output Parameter:
. work - shift times the sum of the weights times the squared stretch
@*/
PetscErrorCode DofSpringsShiftWork(DofSprings s, Vec x, PetscReal *work)
{
  PetscScalar squares;
  Vec         stretch = NULL;

  PetscFunctionBeginUser;
  PetscCall(DofSpringsStretch(s, x, &stretch));
  PetscCall(VecPointwiseMult(stretch, stretch, stretch));
  PetscCall(VecDot(stretch, s->weight, &squares));
  *work = s->shift * PetscRealPart(squares);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DofSpringsStiffen - adds a stiffness to a matrix.

  Collective

  Input Parameters:
+ s     - the springs
- scale - times the weights, it is the stiffness (force per length)

  Input/Output Parameter:
. A - the tangent
@*/
PetscErrorCode DofSpringsStiffen(DofSprings s, PetscReal scale, Mat A)
{
  PetscFunctionBeginUser;
  PetscCall(VecCopy(s->weight, s->work));
  PetscCall(VecScale(s->work, scale));
  PetscCall(MatDiagonalSet(A, s->work, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DofSpringsTangent - adds the stiffness to a matrix.

  Collective

  Input Parameter:
. s - the springs, or NULL

  Input/Output Parameter:
. A - the tangent
@*/
PetscErrorCode DofSpringsTangent(DofSprings s, Mat A)
{
  PetscFunctionBeginUser;
  if (!s || !(s->scale + s->shift > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DofSpringsStiffen(s, s->scale + s->shift, A));
  PetscFunctionReturn(PETSC_SUCCESS);
}
