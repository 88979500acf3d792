#include "contactimpl.h"
#include "refusal.h"

/* Two pairs of the same surfaces would press twice. */
static PetscErrorCode RefuseRepeatedPairs(Mesh mesh, Scene scene)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < scene->n_contacts; p++) {
    for (int q = 0; q < p; q++) {
      const SceneContact *a = &scene->contacts[p], *b = &scene->contacts[q];
      const PetscBool meshed = (PetscBool)(a->master && b->master), same = (PetscBool)(meshed && !strcmp(a->slave, b->slave) && !strcmp(a->master, b->master));
      const PetscBool swapped = (PetscBool)(meshed && !strcmp(a->slave, b->master) && !strcmp(a->master, b->slave));

      if (same || swapped)
        PetscCall(RefuseInput(mesh->comm, "%s: contact '%s' is '%s' once more%s: their forces would add up; allowed: one pair for each two surfaces",
                              SceneWhere(scene, a->path, "slave"), a->name, b->name, swapped ? ", slave and master swapped" : ""));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactCreate - all pairs of the scene, without lists yet.

   Collective. Refuses what the mesh shows to be wrong: missing or empty surfaces, a rigid slave, planes of symmetry that are none. */
PetscErrorCode ContactCreate(Mesh mesh, Scene scene, Elasticity elasticity, Loads loads, Contact *out)
{
  Contact contact;
  int     capacity = 0, points = 1; /* most fit points of a smoother, most slave points of a term */

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
  PetscCall(BlockMatrixCreate(mesh->comm, &contact->blocks));
  PetscCall(RefuseRepeatedPairs(mesh, scene));
  PetscCall(PetscCalloc1(contact->n_pairs, &contact->pairs));
  for (int p = 0; p < contact->n_pairs; p++) {
    PetscCall(ContactPairCreate(mesh, scene, elasticity, loads, &scene->contacts[p], &contact->pairs[p]));
    contact->pairs[p].work = &contact->work;
    capacity               = PetscMax(capacity, contact->pairs[p].smoother->capacity);
  }
  PetscCall(PetscMalloc1(FitWorkspace(mesh->dim, 4, FIT_MAX_POINTS), &contact->work.workspace));
  PetscCall(PetscMalloc4(capacity, &contact->work.result.points, 3 * (capacity + 1), &contact->work.result.N, capacity + 1, &contact->work.from,
                         3 * (capacity + 1), &contact->work.scale));
  PetscCall(PetscMalloc4(PetscSqr(3 * (capacity + 1)), &contact->work.result.M, points * (capacity + 1), &contact->work.node, 3 * points * (capacity + 1),
                         &contact->work.N, PetscSqr(3 * (capacity + 1)), &contact->work.M));
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
  PetscCall(PetscFree4(c->work.result.points, c->work.result.N, c->work.from, c->work.scale));
  PetscCall(PetscFree4(c->work.result.M, c->work.node, c->work.N, c->work.M));
  PetscCall(PetscFree2(c->work.x, c->work.multiplier));
  PetscCall(PetscFree(c->work.workspace));
  PetscCall(BlockMatrixDestroy(&c->blocks));
  PetscCall(PetscFree(*contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- residual ---------- */

/* Moves the lists' points to (u, t) and projects every slave point: gaps into pair->trial, normals into pair->normal. */
static PetscErrorCode PairProject(Contact contact, ContactPair *pair, const PetscReal *u, PetscReal t)
{
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_project, 0, 0, 0, 0));
  PetscCall(ListsUpdate(pair->search, pair->lists, u, t));
  for (PetscInt c = 0; c < pair->n; c++) {
    PetscCall(ContactTermGap(pair, pair->lists, pair->factor, pair->seed, c, &pair->trial[c]));
    for (int d = 0; d < 3; d++) pair->normal[3 * c + d] = PetscIsNanReal(pair->trial[c]) || d >= contact->mesh->dim ? 0 : contact->work.result.normal[d];
  }
  PetscCall(PetscLogEventEnd(contact->event_project, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void TermLaw(const ContactPair *pair, PetscInt c, PetscReal gap, PetscReal t, LawValue *value)
{
  const LawState state = {pair->now.penalty[c], ContactTermOffset(pair, c, t), pair->now.multiplier[c]};

  *value = (LawValue){0, 0, 0};
  if (!PetscIsNanReal(gap)) pair->law->evaluate(gap, &state, value);
}

/* Adds the forces of a loaded term to the contact nodes' values and keeps what probes show of it. */
static PetscErrorCode TermForces(Contact contact, ContactPair *pair, PetscInt c, PetscReal pressure, PetscReal *values, PetscReal *force2)
{
  const int    dim  = contact->mesh->dim;
  ContactWork *work = &contact->work;
  PetscBool    found;
  int          n;

  PetscFunctionBeginUser;
  for (PetscInt q = pair->term_ptr[c]; q < pair->term_ptr[c + 1]; q++) {
    const PetscReal force = pressure * pair->area[c] * pair->term_weight[q] * pair->factor[q];

    if (pair->factor[q] == 0) continue;
    PetscCall(ContactPointEvaluate(pair, pair->smoother, pair->lists, q, pair->seed[q], SMOOTHER_FIRST_VARIATION, &found));
    if (!found) continue;
    ContactPointToNodes(pair, pair->lists, q, 1, PETSC_FALSE, work->node, work->N, &n);
    for (int i = 0; i < n * dim; i++) {
      values[work->node[i / dim] * dim + i % dim] -= force * work->N[i];
      *force2 += PetscSqr(force * work->N[i]);
    }
    pair->force[c] += force;
    for (int d = 0; d < dim; d++) pair->vector[3 * c + d] += force * work->result.N[d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairResidual(Contact contact, ContactPair *pair, const PetscReal *u, PetscReal t, PetscReal *f, PetscReal *energy, PetscReal *force2)
{
  PetscReal *values, sum = 0;
  LawValue   value;

  PetscFunctionBeginUser;
  PetscCall(PairProject(contact, pair, u, t));
  PetscCall(PetscCalloc1(pair->lists->n_nodes * contact->mesh->dim, &values));
  for (PetscInt c = 0; c < pair->n; c++) {
    TermLaw(pair, c, pair->trial[c], t, &value);
    for (PetscInt q = pair->term_ptr[c]; energy && q < pair->term_ptr[c + 1]; q++)
      *energy += pair->area[c] * pair->term_weight[q] * pair->factor[q] * value.psi;
    if (!f) continue;
    pair->now.gap[c]    = pair->trial[c];
    pair->now.status[c] = value.stiffness > 0 ? CONTACT_CLOSED : CONTACT_OPEN;
    pair->force[c]      = 0;
    PetscCall(PetscArrayzero(&pair->vector[3 * c], 3));
    if (value.pressure != 0) PetscCall(TermForces(contact, pair, c, value.pressure, values, &sum));
  }
  if (f) {
    pair->t = t;
    PetscCall(ListsReduce(pair->lists, values, f));
  }
  if (force2) *force2 += sum;
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactResidual - contact forces, energy and their unassembled norm at (u, t).

   Collective, with the same arguments NULL on all ranks. u[n_nodes*dim]: local displacements (length). f[n_nodes*dim]: contact forces are
   subtracted as external ones are, complete at owned nodes; with f gaps, status and nodal forces become the present state. energy, force2
   (sum of the squared forces of the terms): this rank's, added to. Each of the three may be NULL.

   Source: Chamoret et al. 2004, eq. 12 and 15. */
PetscErrorCode ContactResidual(Contact contact, const PetscReal *u, PetscReal t, PetscReal *f, PetscReal *energy, PetscReal *force2)
{
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_residual, 0, 0, 0, 0));
  for (int p = 0; p < contact->n_pairs; p++) PetscCall(PairResidual(contact, &contact->pairs[p], u, t, f, energy, force2));
  PetscCall(PetscLogEventEnd(contact->event_residual, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- tangent ---------- */

/* The block of one active term: A (psi'' Nbar Nbar^T - p sum_q w_q M_q), over its points' nodes one after another (a node may occur twice). */
static PetscErrorCode TermBlock(Contact contact, const ContactPair *pair, int p, PetscInt c, PetscReal pressure, PetscReal stiffness)
{
  const int    dim  = contact->mesh->dim;
  ContactWork *work = &contact->work;
  PetscReal    area = 0, *value;
  PetscInt     m = 0, first = 0, *entry;
  PetscBool    found;

  PetscFunctionBeginUser;
  for (PetscInt q = pair->term_ptr[c]; q < pair->term_ptr[c + 1]; q++) {
    if (pair->factor[q] == 0) continue;
    PetscCall(ContactPointEvaluate(pair, pair->smoother, pair->lists, q, pair->seed[q], SMOOTHER_GAP, &found));
    if (found) m += ContactPointNodes(pair->lists, q, &work->result) * dim;
  }
  PetscCall(BlockMatrixAdd(contact->blocks, p, m, &entry, &value));
  for (PetscInt q = pair->term_ptr[c]; q < pair->term_ptr[c + 1]; q++) {
    const PetscReal weight = pair->area[c] * pair->term_weight[q] * pair->factor[q];
    int             n;

    if (pair->factor[q] == 0) continue;
    PetscCall(ContactPointEvaluate(pair, pair->smoother, pair->lists, q, pair->seed[q], SMOOTHER_SECOND_VARIATION, &found));
    if (!found) continue;
    ContactPointToNodes(pair, pair->lists, q, pair->term_weight[q], PETSC_TRUE, work->node, &work->N[first], &n);
    for (PetscInt i = 0; i < n * dim; i++) {
      entry[first + i] = work->node[i / dim] * dim + i % dim;
      for (PetscInt j = 0; j < n * dim; j++) value[(first + i) * m + first + j] = -pressure * weight * work->M[i * n * dim + j];
    }
    area += weight;
    first += n * dim;
  }
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = 0; j < m; j++) value[i * m + j] += area * stiffness * work->N[i] * work->N[j];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairBlocks(Contact contact, ContactPair *pair, int p, const PetscReal *u, PetscReal t, PetscBool touching)
{
  PetscFunctionBeginUser;
  PetscCall(PairProject(contact, pair, u, t));
  for (PetscInt c = 0; c < pair->n; c++) {
    const PetscReal gap = pair->trial[c];
    LawValue        value;

    TermLaw(pair, c, gap, t, &value);
    if (touching && gap - ContactTermOffset(pair, c, t) >= 0 && gap - ContactTermOffset(pair, c, t) <= ContactTouchTolerance(pair, c))
      value.stiffness = pair->now.penalty[c];
    if (value.stiffness > 0) PetscCall(TermBlock(contact, pair, p, c, value.pressure, value.stiffness));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactTangent - the derivative of ContactResidual()'s forces by the free displacements: A (psi'' N N^T - p M) for each closed term, p its pressure.

   Collective. u, t: as of ContactResidual(); touching: open nodes within ContactTouchTolerance() take part with their stiffness too. *C: over the
   global free dofs, the contact's own; *changed: its pattern is new. Source: Chamoret et al. 2004, eq. 14. */
PetscErrorCode ContactTangent(Contact contact, const PetscReal *u, PetscReal t, PetscBool touching, Mat *C, PetscBool *changed)
{
  const PetscInt **dof;
  PetscSection     section;
  PetscInt         size;

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_tangent, 0, 0, 0, 0));
  PetscCall(BlockMatrixReset(contact->blocks));
  PetscCall(PetscMalloc1(contact->n_pairs, &dof));
  for (int p = 0; p < contact->n_pairs; p++) {
    PetscCall(PairBlocks(contact, &contact->pairs[p], p, u, t, touching));
    dof[p] = contact->pairs[p].lists->dof;
  }
  PetscCall(DMGetGlobalSection(contact->mesh->dm, &section));
  PetscCall(PetscSectionGetConstrainedStorageSize(section, &size));
  PetscCall(BlockMatrixAssemble(contact->blocks, size, dof, C, changed));
  PetscCall(PetscFree(dof));
  PetscCall(PetscLogEventEnd(contact->event_tangent, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An analytic master that moves by d is to the slave nodes as if they had moved by -d. */
static void AnalyticTravel(Contact contact, const ContactPair *pair, PetscReal t, PetscReal t_next, PetscReal *values)
{
  const int dim = contact->mesh->dim;
  PetscReal from[3], to[3];

  MotionPlace(&pair->scene->motion, t, pair->scene->motion.point, from);
  MotionPlace(&pair->scene->motion, t_next, pair->scene->motion.point, to);
  for (PetscInt i = 0; i < pair->lists->n_nodes * dim; i++) values[i] -= to[i % dim] - from[i % dim];
}

/* ContactMultiply - y += C x with the blocks of the last ContactTangent(), prescribed dofs included.

   Collective. x[n_nodes*dim]: local displacements (length), ghosts included, to which the rigid tools' motion from t to t_next is joined;
   y[n_nodes*dim]: local forces, complete at owned nodes. */
PetscErrorCode ContactMultiply(Contact contact, const PetscReal *x, PetscReal t, PetscReal t_next, PetscReal *y)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair   *pair = &contact->pairs[p];
    const PetscInt n    = pair->lists->n_nodes * contact->mesh->dim;
    PetscReal     *in, *out;

    PetscCall(PetscMalloc2(n, &in, n, &out));
    PetscCall(PetscArrayzero(out, n));
    PetscCall(ListsBroadcast(pair->search, pair->lists, x, t, t_next, in));
    if (!pair->master) AnalyticTravel(contact, pair, t, t_next, in);
    PetscCall(BlockMatrixMultiply(contact->blocks, p, in, out));
    PetscCall(ListsReduce(pair->lists, out, y));
    PetscCall(PetscFree2(in, out));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- state ---------- */

/* ContactAccept - the present state becomes the one that ContactRestore() returns to. Not collective. */
PetscErrorCode ContactAccept(Contact contact)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) PetscCall(ContactStateCopy(&contact->pairs[p].now, &contact->pairs[p].accepted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactRestore - takes the state back to the last ContactAccept(); the lists are not part of it: ContactGather(). Not collective. */
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
