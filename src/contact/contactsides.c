/* What the certificate asks of a pair: its surfaces, where its terms press, overlaps that the scene leaves. */
#include "contactimpl.h"

/*@
  ContactPairSides - returns the surfaces of a pair.

  Not collective

  Input Parameters:
+ contact - the contact
- p       - number of the pair

  Output Parameter:
. sides - they belong to the contact
@*/
void ContactPairSides(Contact contact, int p, ContactSides *sides)
{
  const ContactPair *pair = &contact->pairs[p];

  *sides = (ContactSides){.scene     = pair->scene,
                          .slave     = pair->slave,
                          .master    = pair->master,
                          .n_images  = pair->scene->listed ? pair->n_images : 1,
                          .images    = pair->images,
                          .n_mirrors = pair->n_mirrors,
                          .mirrors   = pair->mirrors};
}

/* Part of a face within which an open mean gap hides that the other surface stands in the face: an edge of a right
   angle in its middle stands in it by half of it where the mean gap is 0. */
#define SIDES_NEAR 0.5

/* Does a term hold the surfaces around it in a state? A gap at a node says nothing of the faces around it; a mean over
   these does, where it is open as well, as long as parts of the face can be closed. */
static PetscBool Holds(const ContactPair *pair, const ContactState *state, PetscInt c)
{
  if (state->status[c] == CONTACT_CLOSED) return PETSC_TRUE;
  return (PetscBool)(pair->formulation.surface && state->gap[c] <= SIDES_NEAR * pair->size[c]);
}

/* Adds to the mesh's nodes of all faces near those points on edges of a tool that hold the surfaces. */
static PetscErrorCode MarkRidgeFaces(const ContactPair *pair, PetscReal *mine)
{
  PetscBool *holds;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(pair->n, &holds));
  for (PetscInt c = 0; c < pair->n; c++)
    holds[c] = (PetscBool)(Holds(pair, &pair->now, c) || Holds(pair, &pair->accepted, c));
  PetscCall(ContactRidgeFaces(pair, holds, mine));
  PetscCall(PetscFree(holds));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is a term of a pair closed in either state? */
static PetscBool IsClosed(const ContactPair *pair, PetscInt c)
{
  return (PetscBool)(pair->now.status[c] == CONTACT_CLOSED || pair->accepted.status[c] == CONTACT_CLOSED);
}

/*@
  ContactPairApart - says whether a pair presses nowhere, now and in the accepted state.

  Collective

  Input Parameters:
+ contact - the contact
- p       - number of the pair

  Output Parameter:
. apart - the same on all ranks
@*/
PetscErrorCode ContactPairApart(Contact contact, int p, PetscBool *apart)
{
  const ContactPair *pair = &contact->pairs[p], *ridge = pair->ridge ? &contact->pairs[pair->ridge] : NULL;
  PetscMPIInt        open = 1;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n && open; c++) open = !IsClosed(pair, c);
  for (PetscInt c = 0; ridge && c < ridge->n && open; c++) open = !IsClosed(ridge, c);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &open, 1, MPI_INT, MPI_LAND, contact->mesh->comm));
  *apart = (PetscBool)open;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairPressed - marks the slave nodes of a pair that are closed, now or in the accepted state. In surface to
  surface contact nodes with an open mean gap of up to half a face count, too.

  Collective

  Input Parameters:
+ contact - the contact
- p       - number of the pair

  Input/Output Parameter:
. pressed - pressed[nodes of the mesh]: where it is so, a number above 0 is added on all ranks

  Note:
  Where a sharp edge of the tool presses, the nodes of the faces around it count.
@*/
PetscErrorCode ContactPairPressed(Contact contact, int p, PetscReal *pressed)
{
  const ContactPair *pair = &contact->pairs[p];
  const Mesh         mesh = contact->mesh;
  PetscReal         *mine;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes, &mine));
  for (PetscInt c = 0; c < pair->n; c++) {
    if (Holds(pair, &pair->now, c) || Holds(pair, &pair->accepted, c)) mine[pair->node[c]] = 1;
  }
  if (pair->ridge) PetscCall(MarkRidgeFaces(&contact->pairs[pair->ridge], mine));
  PetscCall(MeshSumNodes(mesh, 1, mine));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) pressed[n] += mine[n];
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairOverlap - returns the largest overlap that initial_overlap leaves in a pair (length).

  Collective

  Input Parameters:
+ contact - the contact
. p       - number of the pair
- t       - load parameter

  Output Parameter:
. overlap - not negative, the same on all ranks
@*/
PetscErrorCode ContactPairOverlap(Contact contact, int p, PetscReal t, PetscReal *overlap)
{
  const ContactPair *pair = &contact->pairs[p];

  PetscFunctionBeginUser;
  *overlap = 0;
  for (PetscInt c = 0; c < pair->n_sides; c++) *overlap = PetscMax(*overlap, -ContactTermOverlap(pair, c, t));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, overlap, 1, MPIU_REAL, MPIU_MAX, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
