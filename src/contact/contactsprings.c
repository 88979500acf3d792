/* Weak springs that hold bodies until contact does. */
#include "contact/contactsprings.h"
#include "contactimpl.h"

/* Stiffness of the springs as a part of the automatic penalty, which is the stiffness of the elements at the surface.
   Each pass leaves about this part, times the number of elements through a body, of the force of the pass before. A
   body that nothing holds moves in one pass by its penetration at rest divided by this part. */
#define CONTACT_SPRINGS_STIFFNESS 1e-3

struct _n_Stabiliser {
  Vec stiffness, anchor, work; /* force per length of each free dof; where the spring has no force */
};

/* Adds to each owned node of a deformable surface its area times the stiffness. */
static PetscErrorCode AddSurface(ContactSurface surface, Geometry geometry, PetscReal stiffness, PetscReal *values)
{
  Mesh        mesh = surface->mesh;
  PetscReal  *area;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscMalloc1(mesh->n_nodes, &area));
  PetscCall(SurfaceNodeAreas(surface, geometry, NULL, area, NULL));
  for (PetscInt i = 0; i < surface->group->n_nodes; i++) {
    const PetscInt node = surface->group->nodes[i];

    for (int d = 0; d < mesh->dim && mesh->node_owner[node] == rank; d++)
      values[node * mesh->dim + d] += stiffness * PetscMax(area[node], 0);
  }
  PetscCall(PetscFree(area));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSpringsCreate - makes springs on the deformable surfaces of all pairs that ask for it, slave and master.

  Collective

  Input Parameters:
+ contact - the contact, borrowed for the call
- like    - a vector of the free dofs, whose layout is taken

  Output Parameter:
. out - the springs, without force at displacements of 0; NULL where no pair asks for them

  Note:
  Source: the proximal point method (Rockafellar 1976) on the potential energy.
@*/
PetscErrorCode ContactSpringsCreate(Contact contact, Vec like, ContactSprings *out)
{
  ContactSprings s;
  PetscReal     *values;
  PetscBool      any = PETSC_FALSE;

  PetscFunctionBeginUser;
  *out = NULL;
  for (int p = 0; p < contact->n_pairs; p++) any = (PetscBool)(any || contact->pairs[p].scene->stabilise);
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&s));
  PetscCall(VecDuplicate(like, &s->stiffness));
  PetscCall(VecDuplicate(like, &s->anchor));
  PetscCall(VecDuplicate(like, &s->work));
  PetscCall(VecZeroEntries(s->anchor));
  PetscCall(PetscCalloc1(contact->mesh->n_nodes * contact->mesh->dim, &values));
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    if (!pair->scene->stabilise) continue;
    PetscCall(AddSurface(pair->slave, pair->geometry, CONTACT_SPRINGS_STIFFNESS * pair->automatic, values));
    if (pair->master && pair->master->group)
      PetscCall(AddSurface(pair->master, pair->geometry, CONTACT_SPRINGS_STIFFNESS * pair->automatic, values));
  }
  PetscCall(MeshLocalToGlobal(contact->mesh, values, s->stiffness));
  PetscCall(PetscFree(values));
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
