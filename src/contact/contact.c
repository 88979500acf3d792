/* The contact object: all pairs of a scene, their accepted state, and what a checkpoint keeps of them. */
#include "contactimpl.h"
#include "search/surfaceends.h"
#include "mesh/meshpieces.h"

/* Offsets of surfaces that occur in several pairs are taken once, by the first one. */
static PetscErrorCode LendOffsets(Contact contact)
{
  enum { SIDES = 2 };

  PetscFunctionBeginUser;
  for (int i = 0; i < SIDES * contact->n_pairs; i++) {
    const ContactPair *pair    = &contact->pairs[i / SIDES];
    Offsets            offsets = i % SIDES ? pair->master_offsets : pair->slave_offsets;
    PetscBool          alike   = PETSC_FALSE;

    for (int k = i - 1; k >= 0 && offsets && !alike; k--) {
      const ContactPair *other  = &contact->pairs[k / SIDES];
      Offsets            lender = k % SIDES ? other->master_offsets : other->slave_offsets;

      if (lender) PetscCall(OffsetsLend(lender, offsets, &alike));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the connected pieces of the mesh, once for all pairs, where the scene lists surfaces; else *piece is NULL. */
static PetscErrorCode FindPieces(Mesh mesh, Scene scene, PetscInt **piece)
{
  PetscBool listed = PETSC_FALSE;
  PetscInt  n;

  PetscFunctionBeginUser;
  *piece = NULL;
  for (int p = 0; p < scene->n_contacts; p++) listed = (PetscBool)(listed || scene->contacts[p].listed);
  if (!listed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(mesh->n_nodes, piece));
  PetscCall(MeshFindPieces(mesh, &n, *piece));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Can the sharp edges of the master of a pair have a pair of their own? */
static PetscBool MayHaveRidge(Scene scene, const ContactPair *pair)
{
  return (PetscBool)(pair->master && pair->master->rigid && !pair->friction && !SceneHasFluid(scene) &&
                     !pair->fit.global_frame);
}

/* Can the sharp edges of the deformable master of a pair have a pair of their own? */
static PetscBool MayHaveEdges(Scene scene, const ContactPair *pair)
{
  return (PetscBool)(SurfaceFollowsEdges(pair->mesh, scene->geometry) && pair->master && !pair->master->rigid &&
                     !pair->friction && !SceneHasFluid(scene) && !pair->fit.global_frame && !pair->scene->listed);
}

/* Adds pairs of the sharp edges of tools behind those of the scene, where the tools have any. */
static PetscErrorCode AddRidges(Contact contact, Elasticity elasticity)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_scene; p++) {
    ContactPair *pair = &contact->pairs[p], *ridge = &contact->pairs[contact->n_pairs];

    if (MayHaveEdges(contact->scene, pair)) PetscCall(ContactPairCreateEdges(contact, elasticity, p, ridge));
    if (MayHaveRidge(contact->scene, pair)) PetscCall(ContactPairCreateRidge(contact, elasticity, p, ridge));
    if (!ridge->slave) continue;
    ridge->work = &contact->work;
    pair->ridge = contact->n_pairs++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactCreate - creates all pairs of the scene, without lists.

  Collective

  Input Parameters:
+ mesh       - the mesh, borrowed
. scene      - the scene, borrowed
. elasticity - the bodies, for the automatic penalty
- loads      - prescribed motions of bodies and tools, borrowed

  Output Parameter:
. out - the contact

  Notes:
  Refuses what the mesh shows to be wrong: surfaces that are missing or empty, a rigid slave, two pairs of the same
  surfaces or of the same faces and tool, planes of symmetry that are none, faces that two lists have.

  ContactGather() makes the first lists.
@*/
PetscErrorCode ContactCreate(Mesh mesh, Scene scene, Elasticity elasticity, Loads loads, Contact *out)
{
  Contact         contact;
  const Smoother *smoother;
  int             capacity = 0, dense = 0;
  long            workspace = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&contact));
  *out             = contact; /* ContactDestroy() frees what a refusal leaves */
  contact->mesh    = mesh;
  contact->scene   = scene;
  contact->loads   = loads;
  contact->n_pairs = contact->n_scene = scene->n_contacts;
  PetscCall(PetscLogEventRegister("ContactSearch", SNES_CLASSID, &contact->event_search));
  PetscCall(PetscLogEventRegister("ContactProject", SNES_CLASSID, &contact->event_project));
  PetscCall(PetscLogEventRegister("ContactResidual", SNES_CLASSID, &contact->event_residual));
  PetscCall(PetscLogEventRegister("ContactTangent", SNES_CLASSID, &contact->event_tangent));
  PetscCall(PetscLogEventRegister("ContactFit", SNES_CLASSID, &contact->event_fit));
  PetscCall(PetscLogEventRegister("ContactOffset", SNES_CLASSID, &contact->event_offset));
  PetscCall(PetscLogEventRegister("ContactAdjust", SNES_CLASSID, &contact->event_adjust));
  PetscCall(PetscLogEventRegister("ContactTouch", SNES_CLASSID, &contact->event_touch));
  PetscCall(BlockMatrixCreate(mesh->comm, mesh->dim, &contact->blocks));
  PetscCall(PetscCalloc1(2 * contact->n_pairs, &contact->pairs)); /* with room for those of sharp edges */
  PetscCall(FindPieces(mesh, scene, &contact->piece));
  for (int p = 0; p < contact->n_pairs; p++) {
    PetscCall(
      ContactPairCreate(mesh, scene, elasticity, loads, contact->piece, &scene->contacts[p], &contact->pairs[p]));
    contact->pairs[p].work = &contact->work;
    smoother               = contact->pairs[p].smoother;
    capacity               = PetscMax(capacity, PetscMax(smoother->capacity, contact->pairs[p].facets->capacity));
    dense = PetscMax(dense, PetscMax(smoother->dense_capacity, contact->pairs[p].facets->dense_capacity));
    if (smoother->workspace) workspace = PetscMax(workspace, smoother->workspace(mesh->dim));
  }
  PetscCall(PetscFree(contact->piece));
  PetscCall(LendOffsets(contact));
  PetscCall(ContactRefuseRepeated(contact));
  PetscCall(ContactOverride(contact, elasticity));
  PetscCall(AddRidges(contact, elasticity));
  PetscCall(ContactWorkCreate(capacity, dense, workspace, &contact->work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactDestroy - frees the contact and its tangent.

  Collective

  Input Parameter:
. contact - the contact; set to NULL
@*/
PetscErrorCode ContactDestroy(Contact *contact)
{
  Contact c = *contact;

  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  for (int p = 0; p < c->n_pairs; p++) PetscCall(ContactPairDestroy(&c->pairs[p]));
  PetscCall(PetscFree(c->pairs));
  PetscCall(PetscFree(c->piece));
  PetscCall(PetscFree(c->u_gathered));
  PetscCall(PetscFree(c->u_before));
  PetscCall(ContactWorkDestroy(&c->work));
  PetscCall(BlockMatrixDestroy(&c->blocks));
  PetscCall(ContactVectorsFree(&c->border));
  PetscCall(ContactVectorsFree(&c->one));
  PetscCall(PetscFree(*contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactAccept - takes the present state as the accepted one, to which ContactRestore() returns.

  Not collective

  Input Parameter:
. contact - the contact, after ContactResidual() with forces at the solution
@*/
PetscErrorCode ContactAccept(Contact contact)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++)
    PetscCall(ContactStateCopy(&contact->pairs[p].now, &contact->pairs[p].accepted));
  PetscCall(BlockMatrixMark(contact->blocks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactRestore - takes the present state back to the last ContactAccept().

  Not collective

  Input Parameter:
. contact - the contact

  Note:
  Lists are not part of the state: ContactGather() makes them.
@*/
PetscErrorCode ContactRestore(Contact contact)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    PetscCall(ContactStateCopy(&pair->accepted, &pair->now));
    if (pair->before) PetscCall(PetscArraycpy(pair->before, pair->accepted.gap, pair->n));
    PetscCall(PetscArrayzero(pair->expected, pair->n));
    PetscCall(PetscArrayzero(pair->arrived, pair->n));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactTangentRestore - takes the pattern of the tangent back to that of the last ContactAccept().

  Collective

  Input Parameter:
. contact - the contact

  Note:
  The pattern sets the order in which a solver sums, so results after a cutback are those of a run without it.
@*/
PetscErrorCode ContactTangentRestore(Contact contact)
{
  PetscInt rows;

  PetscFunctionBeginUser;
  PetscCall(ContactMatrixRows(contact, &rows));
  PetscCall(BlockMatrixReturn(contact->blocks, rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Saves or loads the accepted state of a pair by term, and the offsets of its sides by face. */
static PetscErrorCode PairArchive(ContactPair *pair, int p, Archive archive)
{
  PetscInt *id;
  char      name[PETSC_MAX_PATH_LEN];
  Hdf5Table terms;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(pair->n, &id));
  for (PetscInt c = 0; c < pair->n; c++) id[c] = ContactTermId(pair, c);
  PetscCall(Hdf5TableCreateByKey(pair->mesh->comm, pair->n, id, &terms));
  PetscCall(PetscFree(id));
  PetscCall(PetscSNPrintf(name, sizeof(name), "contact/%d/state", p));
  PetscCall(ContactStateArchive(&pair->accepted, archive, name, &terms));
  PetscCall(Hdf5TableDestroy(&terms));
  PetscCall(PetscSNPrintf(name, sizeof(name), "contact/%d/slave_offsets", p));
  if (pair->slave_offsets) PetscCall(OffsetsArchive(pair->slave_offsets, archive, name));
  PetscCall(PetscSNPrintf(name, sizeof(name), "contact/%d/master_offsets", p));
  if (pair->master_offsets) PetscCall(OffsetsArchive(pair->master_offsets, archive, name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactArchive - saves or loads the accepted state, with all else that the next steps depend on to the last bit.

  Collective

  Input Parameters:
+ contact - the contact
. archive - says whether it saves or loads
. u       - local displacements of the accepted state, u[n_nodes*dim] (length), ghosts included
- t       - its load parameter

  Note:
  Besides the state these are the offsets to extrapolate from, the lists that are ready for the next step, and the
  kept pattern of the matrix. After loading, the accepted state is the present one too, and ContactResidual() gives
  its forces.
@*/
PetscErrorCode ContactArchive(Contact contact, Archive archive, const PetscReal *u, PetscReal t)
{
  PetscInt rows;

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) PetscCall(PairArchive(&contact->pairs[p], p, archive));
  PetscCall(ContactMatrixRows(contact, &rows));
  PetscCall(BlockMatrixArchive(contact->blocks, archive, "contact/pattern", rows));
  if (ArchiveLoads(archive)) PetscCall(ContactRestore(contact));
  PetscCall(ContactListsArchive(contact, archive, u, t));
  PetscFunctionReturn(PETSC_SUCCESS);
}
