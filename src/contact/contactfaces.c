/* Terms of faces, which stand beside those of nodes in surface to surface contact of first order.

   With terms of nodes alone, the contact ends at a node of the slave. Where it moves over the slave, it ends at one
   node after the other, and forces swing at the pace of the faces. The term of a face has the mean gap over the face,
   so it ends half a face farther on, and most of the swing cancels. */
#include "contactimpl.h"

/* Share of each face's area that its own term takes; the terms of its nodes take the rest. A half cylinder drawn over a
   block, 3 to 7 nodes in contact, swing of the force across and along (rms, %): share 0: 1.4 to 0.16 and 0.33 to 0.02;
   0.3: 0.22 to 0.06 and 0.22 to 0.05; 0.5: 0.5 to 0.14 and 0.24 to 0.06. It is flat from 0.2 to 0.35. Under a constant
   pressure all terms press alike, whatever the share. */
#define FACE_SHARE 0.3

/* Largest penalty of a face's term, in automatic penalties. Terms of nodes and faces together are twice as many as the
   freedoms of the surface, so stiff ones hold it too tightly: with 10000 automatic penalties on both, a tube pushed
   over a barb takes 1150 iterations, with this bound 130, with terms of nodes alone 219. It is the default penalty, at
   which the share was measured. */
#define FACE_STIFFEST 30

/*@
  ContactFacesServe - says whether a pair has terms of faces.

  Not collective

  Input Parameters:
+ pair  - the pair, with its formulation
. scene - the scene
- order - of the elements

  Note:
  What is stated for nodes keeps terms of nodes alone: windows of penetrations, multipliers, friction, and fluids
between the surfaces. In second order the terms of the middle nodes have the part of those of faces: the noise is half
as large as that of first order with them, and terms of faces leave it as it is.
@*/
PetscBool ContactFacesServe(const ContactPair *pair, Scene scene, int order)
{
  const SceneContact *contact = pair->scene;

  return (PetscBool)(pair->formulation.surface && order == 1 && !contact->adjust && !contact->augment &&
                     !contact->friction && !SceneHasFluid(scene));
}

/*@
  ContactFacesAdd - adds the terms of faces to those of nodes. A face's term is on the rank that owns its first node.

  Not collective

  Input Parameters:
+ pair - the pair, with the terms of its nodes, and room for all faces behind them
- turn - turn[n_nodes] of the normals of the faces around each local node
@*/
PetscErrorCode ContactFacesAdd(ContactPair *pair, const PetscReal turn[])
{
  const SlavePoints slaves = pair->slaves;
  PetscMPIInt       rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(pair->mesh->comm, &rank));
  PetscCall(PetscMalloc1(slaves->n_faces, &pair->face));
  for (PetscInt f = 0; f < slaves->n_faces; f++) {
    PetscInt c = pair->n;

    if (!SlavePointIsOwn(slaves, slaves->first[f], rank)) continue;
    pair->face[c - pair->n_sides] = f;
    pair->node[c]                 = slaves->nodes[slaves->faces[f].nodes[0]].local;
    pair->size[c]                 = slaves->size[slaves->first[f]];
    pair->turn[c]                 = turn[pair->node[c]];
    pair->area[c]                 = 0;
    for (PetscInt q = slaves->first[f]; q < slaves->first[f + 1]; q++)
      pair->area[c] += pair->scene->share * slaves->weight[q];
    pair->n++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactFacesShare - returns the share of each face's area that the terms of its nodes take (1: there are no terms of
  faces).

  Not collective

  Input Parameter:
. pair - the pair
@*/
PetscReal ContactFacesShare(const ContactPair *pair)
{
  return pair->formulation.faces ? 1 - FACE_SHARE : 1;
}

/*@
  ContactFacesPoints - lists the slave points of the terms of faces, with their areas in them.

  Not collective

  Input Parameter:
. pair - the pair; term_ptr[c + 1] is where the points of each of these terms begin, on return where they end
@*/
void ContactFacesPoints(ContactPair *pair)
{
  const SlavePoints slaves = pair->slaves;

  for (PetscInt c = pair->n_sides; c < pair->n; c++) {
    const PetscInt f = pair->face[c - pair->n_sides];

    for (PetscInt q = slaves->first[f]; q < slaves->first[f + 1]; q++) {
      const PetscInt at = pair->term_ptr[c + 1]++;

      pair->term_point[at]  = q;
      pair->term_weight[at] = FACE_SHARE * pair->scene->share * slaves->weight[q];
    }
  }
}

/*@
  ContactTermPenalty - returns what counts of the penalty of a term (force per length and area).

  Not collective

  Input Parameters:
+ pair    - the pair
. c       - the term
- penalty - its penalty in some state
@*/
PetscReal ContactTermPenalty(const ContactPair *pair, PetscInt c, PetscReal penalty)
{
  return c < pair->n_sides ? penalty : PetscMin(penalty, FACE_STIFFEST * pair->automatic);
}

/*@
  ContactTermAtBound - says whether the penalty of a term would count for no more if it were raised.

  Not collective

  Input Parameters:
+ pair - the pair
- c    - the term
@*/
PetscBool ContactTermAtBound(const ContactPair *pair, PetscInt c)
{
  return (PetscBool)(c >= pair->n_sides && pair->now.penalty[c] >= (1 - PETSC_SMALL) * FACE_STIFFEST * pair->automatic);
}

/*@
  ContactTermId - returns a number of a term that no other term of its pair has, the same on any ranks.

  Not collective

  Input Parameters:
+ pair - the pair
- c    - the term
@*/
PetscInt ContactTermId(const ContactPair *pair, PetscInt c)
{
  if (ContactOnTool(pair)) return pair->node[c];
  if (c < pair->n_nodes) return pair->mesh->node_id[pair->node[c]];
  if (c < pair->n_sides) return ContactCornerId(pair, c);
  return -1 - (PetscInt)pair->slaves->faces[pair->face[c - pair->n_sides]].tag;
}
