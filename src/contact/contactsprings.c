/* Weak springs that hold bodies until contact does, see contactsprings.h. */
#include "contact/contactsprings.h"

struct _n_Stabiliser {
  DofSprings dofs; /* the springs without the ties; their anchor is that of all */
  PetscInt   n_ties;
  SpringTie *ties;
  PetscReal *stretch; /* n_ties (length), at the last evaluation */
  PetscReal *rest;    /* n_ties (length): stretch that they have at the anchor */
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
  PetscCall(DofSpringsCreate(mesh, stiffness, like, &s->dofs));
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
  PetscCall(DofSpringsDestroy(&(*s)->dofs));
  PetscCall(PetscFree3((*s)->ties, (*s)->stretch, (*s)->rest));
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
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArrayzero(s->rest, s->n_ties));
  PetscCall(DofSpringsAnchor(s->dofs, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSpringsSetTies - replaces the ties.

  Collective

  Input Parameters:
+ s    - the springs
. n    - number of ties
- ties - ties[n], the same on all ranks; copied
@*/
PetscErrorCode ContactSpringsSetTies(ContactSprings s, PetscInt n, const SpringTie *ties)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(s->ties, s->stretch, s->rest));
  PetscCall(PetscMalloc3(n, &s->ties, n, &s->stretch, n, &s->rest));
  PetscCall(PetscArraycpy(s->ties, ties, n));
  PetscCall(PetscArrayzero(s->stretch, n));
  PetscCall(PetscArrayzero(s->rest, n));
  s->n_ties = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSpringsRelease - releases all ties but those of some motions.

  Not collective, the same on all ranks

  Input Parameters:
+ s    - the springs
. n    - number of motions that stay tied
- kept - their numbers

  Output Parameter:
. any - one was released
@*/
PetscErrorCode ContactSpringsRelease(ContactSprings s, int n, const int *kept, PetscBool *any)
{
  PetscFunctionBeginUser;
  *any = PETSC_FALSE;
  for (PetscInt i = 0; i < s->n_ties; i++) {
    PetscBool keep = PETSC_FALSE;

    for (int k = 0; k < n; k++) keep = (PetscBool)(keep || kept[k] == s->ties[i].motion);
    if (keep || s->ties[i].released) continue;
    s->ties[i].released = *any = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSpringsMark - notes whether the motion of a tie is unstable.

  Not collective, the same on all ranks

  Input Parameters:
+ s        - the springs
. motion   - number of the motion, which is tied
- unstable - without its tie the motion would go on by itself
@*/
PetscErrorCode ContactSpringsMark(ContactSprings s, int motion, PetscBool unstable)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n_ties; i++)
    if (s->ties[i].motion == motion) s->ties[i].unstable = unstable;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSpringsRetie - ties what was released.

  Not collective, the same on all ranks

  Input Parameter:
. s - the springs

  Output Parameter:
. any - one had been released
@*/
PetscErrorCode ContactSpringsRetie(ContactSprings s, PetscBool *any)
{
  PetscFunctionBeginUser;
  *any = PETSC_FALSE;
  for (PetscInt i = 0; i < s->n_ties; i++) {
    *any                = (PetscBool)(*any || s->ties[i].released);
    s->ties[i].released = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSpringsGetTie - finds the tie of a motion.

  Not collective

  Input Parameters:
+ s      - the springs
- motion - number of the motion

  Output Parameters:
+ tie   - the tie, which may have been released; NULL: there is none
- force - its force along the motion at the last evaluation; may be NULL
@*/
void ContactSpringsGetTie(ContactSprings s, int motion, const SpringTie **tie, PetscReal *force)
{
  *tie = NULL;
  for (PetscInt i = 0; i < s->n_ties; i++) {
    if (s->ties[i].motion != motion) continue;
    *tie = &s->ties[i];
    if (force) *force = s->ties[i].stiffness * s->stretch[i];
  }
}

/*@
  ContactSpringsHaveTie - says whether a motion is tied, and not released.

  Not collective

  Input Parameters:
+ s      - the springs
- motion - number of the motion
@*/
PetscBool ContactSpringsHaveTie(ContactSprings s, int motion)
{
  const SpringTie *tie;

  ContactSpringsGetTie(s, motion, &tie, NULL);
  return (PetscBool)(tie && !tie->released);
}

/* Computes the stretches of all ties at x into s->stretch, whether they are released or not. */
static PetscErrorCode StretchAll(ContactSprings s, Vec x)
{
  const PetscScalar *d;
  PetscInt           first, end;
  Vec                moved;

  PetscFunctionBeginUser;
  if (!s->n_ties) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DofSpringsStretch(s->dofs, x, &moved));
  PetscCall(VecGetOwnershipRange(moved, &first, &end));
  PetscCall(VecGetArrayRead(moved, &d));
  for (PetscInt i = 0; i < s->n_ties; i++) {
    const SpringTie *tie = &s->ties[i];

    s->stretch[i] = 0;
    for (PetscInt k = 0; k < tie->n; k++)
      if (tie->dof[k] >= first && tie->dof[k] < end)
        s->stretch[i] += tie->value[k] * PetscRealPart(d[tie->dof[k] - first]);
  }
  PetscCall(VecRestoreArrayRead(moved, &d));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s->stretch, (PetscMPIInt)s->n_ties, MPIU_REAL, MPI_SUM,
                             PetscObjectComm((PetscObject)x)));
  for (PetscInt i = 0; i < s->n_ties; i++) s->stretch[i] += s->rest[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the stretches of the ties at x into s->stretch; a released one has none. */
static PetscErrorCode Stretch(ContactSprings s, Vec x)
{
  PetscFunctionBeginUser;
  PetscCall(StretchAll(s, x));
  for (PetscInt i = 0; i < s->n_ties; i++)
    if (s->ties[i].released) s->stretch[i] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSpringsSlacken - moves the anchors of the springs, so that they are without force at x. Ties keep theirs.

  Collective

  Input Parameters:
+ s - the springs, or NULL
- x - free displacements (length)
@*/
PetscErrorCode ContactSpringsSlacken(ContactSprings s, Vec x)
{
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StretchAll(s, x));
  PetscCall(PetscArraycpy(s->rest, s->stretch, s->n_ties));
  PetscCall(DofSpringsAnchor(s->dofs, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSpringsResidual - adds the forces of springs and ties to the residual.

  Collective

  Input Parameters:
+ s - the springs, or NULL: nothing is added
- x - free displacements (length)

  Input/Output Parameter:
. F - residual
@*/
PetscErrorCode ContactSpringsResidual(ContactSprings s, Vec x, Vec F)
{
  PetscScalar *f;
  PetscInt     first, end;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Stretch(s, x));
  PetscCall(DofSpringsResidual(s->dofs, x, F));
  PetscCall(VecGetOwnershipRange(F, &first, &end));
  PetscCall(VecGetArray(F, &f));
  for (PetscInt i = 0; i < s->n_ties; i++) {
    const SpringTie *tie = &s->ties[i];

    for (PetscInt k = 0; k < tie->n; k++)
      if (tie->dof[k] >= first && tie->dof[k] < end)
        f[tie->dof[k] - first] += tie->stiffness * s->stretch[i] * tie->value[k];
  }
  PetscCall(VecRestoreArray(F, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSpringsLoad - finds the forces in springs and ties and the energy in both.

  Collective

  Input Parameters:
+ s - the springs, or NULL
- x - free displacements (length)

  Output Parameters:
+ force  - norm of the forces of the springs
. tied   - largest force along the motion that a tie holds
- energy - of all
@*/
PetscErrorCode ContactSpringsLoad(ContactSprings s, Vec x, PetscReal *force, PetscReal *tied, PetscReal *energy)
{
  PetscFunctionBeginUser;
  *force = *tied = *energy = 0;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Stretch(s, x));
  PetscCall(DofSpringsLoad(s->dofs, x, force, energy));
  for (PetscInt i = 0; i < s->n_ties; i++) {
    *tied = PetscMax(*tied, s->ties[i].stiffness * PetscAbsReal(s->stretch[i]));
    *energy += s->ties[i].stiffness * PetscSqr(s->stretch[i]) / 2;
  }
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
  PetscReal force, tied, mine;

  PetscFunctionBeginUser;
  PetscCall(ContactSpringsLoad(s, x, &force, &tied, &mine));
  *energy += mine;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSpringsTangent - adds the stiffness of springs and ties to a matrix.

  Collective

  Input Parameter:
. s - the springs, or NULL

  Input/Output Parameter:
. A - the tangent; its pattern couples the dofs of each tie
@*/
PetscErrorCode ContactSpringsTangent(ContactSprings s, Mat A)
{
  PetscInt first, end;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DofSpringsTangent(s->dofs, A));
  if (!s->n_ties) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatGetOwnershipRange(A, &first, &end));
  for (PetscInt i = 0; i < s->n_ties; i++) {
    const SpringTie *tie = &s->ties[i];

    for (PetscInt k = 0; k < tie->n && !tie->released; k++)
      for (PetscInt l = 0; l < tie->n && tie->dof[k] >= first && tie->dof[k] < end; l++)
        PetscCall(MatSetValue(A, tie->dof[k], tie->dof[l], tie->stiffness * tie->value[k] * tie->value[l], ADD_VALUES));
  }
  PetscCall(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}
