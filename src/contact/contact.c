#include "contactimpl.h"
#include "base/refusal.h"

/* Two pairs of the same surfaces would press twice. */
static PetscErrorCode RefuseRepeatedPairs(Mesh mesh, Scene scene)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < scene->n_contacts; p++) {
    for (int q = 0; q < p; q++) {
      const SceneContact *a = &scene->contacts[p], *b = &scene->contacts[q];
      const PetscBool     meshed = (PetscBool)(a->master && b->master),
                      same       = (PetscBool)(meshed && !strcmp(a->slave, b->slave) && !strcmp(a->master, b->master));
      const PetscBool swapped    = (PetscBool)(meshed && !strcmp(a->slave, b->master) && !strcmp(a->master, b->slave));

      if (same || swapped)
        PetscCall(RefuseInput(
          mesh->comm,
          "%s: contact '%s' is '%s' once more%s: their forces would add up; allowed: one pair for each two surfaces",
          SceneWhere(scene, a->path, "slave"), a->name, b->name, swapped ? ", slave and master swapped" : ""));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactCreate - all pairs of the scene, without lists yet.

   Collective. Refuses what the mesh shows to be wrong: missing or empty surfaces, a rigid slave, planes of symmetry
   that are none. */
PetscErrorCode ContactCreate(Mesh mesh, Scene scene, Elasticity elasticity, Loads loads, Contact *out)
{
  Contact         contact;
  const Smoother *smoother;
  int             capacity = 0, dense = 0;
  long            workspace = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&contact));
  contact->mesh    = mesh;
  contact->scene   = scene;
  contact->loads   = loads;
  contact->n_pairs = scene->n_contacts;
  PetscCall(PetscLogEventRegister("ContactSearch", SNES_CLASSID, &contact->event_search));
  PetscCall(PetscLogEventRegister("ContactProject", SNES_CLASSID, &contact->event_project));
  PetscCall(PetscLogEventRegister("ContactResidual", SNES_CLASSID, &contact->event_residual));
  PetscCall(PetscLogEventRegister("ContactTangent", SNES_CLASSID, &contact->event_tangent));
  PetscCall(PetscLogEventRegister("ContactFit", SNES_CLASSID, &contact->event_fit));
  PetscCall(PetscLogEventRegister("ContactOffset", SNES_CLASSID, &contact->event_offset));
  PetscCall(PetscLogEventRegister("ContactAdjust", SNES_CLASSID, &contact->event_adjust));
  PetscCall(PetscLogEventRegister("ContactTouch", SNES_CLASSID, &contact->event_touch));
  PetscCall(BlockMatrixCreate(mesh->comm, mesh->dim, &contact->blocks));
  PetscCall(RefuseRepeatedPairs(mesh, scene));
  PetscCall(PetscCalloc1(contact->n_pairs, &contact->pairs));
  for (int p = 0; p < contact->n_pairs; p++) {
    PetscCall(ContactPairCreate(mesh, scene, elasticity, loads, &scene->contacts[p], &contact->pairs[p]));
    contact->pairs[p].work = &contact->work;
    smoother               = contact->pairs[p].smoother;
    capacity               = PetscMax(capacity, PetscMax(smoother->capacity, contact->pairs[p].facets->capacity));
    dense = PetscMax(dense, PetscMax(smoother->dense_capacity, contact->pairs[p].facets->dense_capacity));
    if (smoother->workspace) workspace = PetscMax(workspace, smoother->workspace(mesh->dim));
  }
  PetscCall(ContactWorkCreate(capacity, dense, workspace, &contact->work));
  *out = contact;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactDestroy - Collective. */
PetscErrorCode ContactDestroy(Contact *contact)
{
  Contact c = *contact;

  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  for (int p = 0; p < c->n_pairs; p++) PetscCall(ContactPairDestroy(&c->pairs[p]));
  PetscCall(PetscFree(c->pairs));
  PetscCall(ContactWorkDestroy(&c->work));
  PetscCall(BlockMatrixDestroy(&c->blocks));
  PetscCall(ContactVectorsFree(&c->border));
  PetscCall(ContactVectorsFree(&c->one));
  PetscCall(PetscFree(*contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactAccept - the present state becomes the one that ContactRestore() returns to. Not collective. */
PetscErrorCode ContactAccept(Contact contact)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++)
    PetscCall(ContactStateCopy(&contact->pairs[p].now, &contact->pairs[p].accepted));
  PetscCall(BlockMatrixMark(contact->blocks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactRestore - takes the state back to the last ContactAccept(); the lists are not part of it: ContactGather(). Not
 * collective. */
PetscErrorCode ContactRestore(Contact contact)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    PetscCall(ContactStateCopy(&pair->accepted, &pair->now));
    if (pair->before) PetscCall(PetscArraycpy(pair->before, pair->accepted.gap, pair->n));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactTangentRestore - the tangent's pattern is again that of the last ContactAccept(): it orders the solver's sums.
 * Collective. */
PetscErrorCode ContactTangentRestore(Contact contact)
{
  PetscInt rows;

  PetscFunctionBeginUser;
  PetscCall(ContactMatrixRows(contact, &rows));
  PetscCall(BlockMatrixReturn(contact->blocks, rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairArchive(ContactPair *pair, int p, Archive archive)
{
  PetscInt *id;
  char      name[PETSC_MAX_PATH_LEN];
  Hdf5Table nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(pair->n, &id));
  for (PetscInt c = 0; c < pair->n; c++) id[c] = pair->mesh->node_id[pair->node[c]];
  PetscCall(Hdf5TableCreateByKey(pair->mesh->comm, pair->n, id, &nodes));
  PetscCall(PetscFree(id));
  PetscCall(PetscSNPrintf(name, sizeof(name), "contact/%d/state", p));
  PetscCall(ContactStateArchive(&pair->accepted, archive, name, &nodes));
  PetscCall(Hdf5TableDestroy(&nodes));
  PetscCall(PetscSNPrintf(name, sizeof(name), "contact/%d/slave_offsets", p));
  if (pair->slave_offsets) PetscCall(OffsetsArchive(pair->slave_offsets, archive, name));
  PetscCall(PetscSNPrintf(name, sizeof(name), "contact/%d/master_offsets", p));
  if (pair->master_offsets) PetscCall(OffsetsArchive(pair->master_offsets, archive, name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactArchive - saves or takes over the accepted state by node and face, with what else the next steps depend on to
   the last bit: offsets to extrapolate from, lists that stand ready, the kept pattern of the matrix.

   Collective. u[n_nodes*dim], t: the accepted state of the model. Loaded, it is the present state too;
   ContactResidual() gives its forces. */
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
