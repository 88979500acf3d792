/* Weak springs that hold bodies until contact does, see contactsprings.h. */
#include "contact/contactsprings.h"

struct _n_Stabiliser {
  Vec stiffness, anchor, work; /* force per length of each free dof; where the spring has no force */
};

/*@
  ContactSpringsCreate - makes springs.

  Collective

  Input Parameters:
+ mesh      - the mesh
. stiffness - stiffness[n_nodes*dim] (force per length) of the spring at each local dof; 0 at the nodes of other ranks
- like      - a vector of the free dofs, whose layout is taken

  Output Parameter:
. out - the springs, without force at displacements of 0

  Note:
  Source: the proximal point method (Rockafellar 1976) on the potential energy.
@*/
PetscErrorCode ContactSpringsCreate(Mesh mesh, const PetscReal *stiffness, Vec like, ContactSprings *out)
{
  ContactSprings s;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  PetscCall(VecDuplicate(like, &s->stiffness));
  PetscCall(VecDuplicate(like, &s->anchor));
  PetscCall(VecDuplicate(like, &s->work));
  PetscCall(VecZeroEntries(s->anchor));
  PetscCall(MeshLocalToGlobal(mesh, stiffness, s->stiffness));
  *out = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSpringsDestroy - frees the springs.

  Collective

  Input Parameter:
. s - the springs; set to NULL
@*/
PetscErrorCode ContactSpringsDestroy(ContactSprings *s)
{
  PetscFunctionBeginUser;
  if (!*s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDestroy(&(*s)->stiffness));
  PetscCall(VecDestroy(&(*s)->anchor));
  PetscCall(VecDestroy(&(*s)->work));
  PetscCall(PetscFree(*s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSpringsRelax - moves the anchors of all springs, so that they are without force at x.

  Collective

  Input Parameters:
+ s - the springs, or NULL
- x - free displacements (length)
@*/
PetscErrorCode ContactSpringsRelax(ContactSprings s, Vec x)
{
  PetscFunctionBeginUser;
  if (s) PetscCall(VecCopy(x, s->anchor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The springs' forces at x, into the work vector. */
static PetscErrorCode SpringForces(ContactSprings s, Vec x)
{
  PetscFunctionBeginUser;
  PetscCall(VecWAXPY(s->work, -1, s->anchor, x));
  PetscCall(VecPointwiseMult(s->work, s->work, s->stiffness));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSpringsResidual - adds the springs' forces to the residual.

  Collective

  Input Parameters:
+ s - the springs, or NULL: nothing is added
- x - free displacements (length)

  Input/Output Parameter:
. F - residual
@*/
PetscErrorCode ContactSpringsResidual(ContactSprings s, Vec x, Vec F)
{
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SpringForces(s, x));
  PetscCall(VecAXPY(F, 1, s->work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSpringsLoad - finds the norm of the springs' forces and the energy in them.

  Collective

  Input Parameters:
+ s - the springs, or NULL
- x - free displacements (length)

  Output Parameters:
+ force  - norm of the forces
- energy - of all springs
@*/
PetscErrorCode ContactSpringsLoad(ContactSprings s, Vec x, PetscReal *force, PetscReal *energy)
{
  PetscScalar work[2] = {0, 0};

  PetscFunctionBeginUser;
  *force = *energy = 0;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SpringForces(s, x));
  PetscCall(VecNorm(s->work, NORM_2, force));
  PetscCall(VecDot(s->work, x, &work[0]));
  PetscCall(VecDot(s->work, s->anchor, &work[1]));
  *energy = PetscRealPart(work[0] - work[1]) / 2;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSpringsEnergy - adds the springs' energy, the sum over all ranks.

  Collective

  Input Parameters:
+ s - the springs, or NULL
- x - free displacements (length)

  Input/Output Parameter:
. energy - the energy
@*/
PetscErrorCode ContactSpringsEnergy(ContactSprings s, Vec x, PetscReal *energy)
{
  PetscReal force, mine;

  PetscFunctionBeginUser;
  PetscCall(ContactSpringsLoad(s, x, &force, &mine));
  *energy += mine;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSpringsTangent - adds the springs' stiffness to the diagonal of a matrix.

  Collective

  Input Parameter:
. s - the springs, or NULL

  Input/Output Parameter:
. A - the tangent
@*/
PetscErrorCode ContactSpringsTangent(ContactSprings s, Mat A)
{
  PetscFunctionBeginUser;
  if (s) PetscCall(MatDiagonalSet(A, s->stiffness, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}
