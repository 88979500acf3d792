#include "contactimpl.h"
#include "base/refusal.h"
#include "base/timing.h"

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
  Contact contact;
  int     capacity = 0, fits = 0; /* most fit points of a smoother; pairs with fits */

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&contact));
  *out             = contact; /* ContactDestroy() frees what a refusal leaves */
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
  PetscCall(PetscCalloc1(contact->n_pairs, &contact->pairs));
  PetscCall(RefuseRepeatedPairs(mesh, scene));
  for (int p = 0; p < contact->n_pairs; p++) {
    PetscCall(ContactPairCreate(mesh, scene, elasticity, loads, &scene->contacts[p], &contact->pairs[p]));
    contact->pairs[p].work = &contact->work;
    capacity               = PetscMax(capacity, contact->pairs[p].smoother->capacity);
    fits += contact->pairs[p].fit.degree > 0;
  }
  if (fits) PetscCall(PetscMalloc1(FitWorkspace(mesh->dim, 4, FIT_MAX_POINTS), &contact->work.workspace));
  PetscCall(PetscMalloc3(capacity, &contact->work.result.points, 3 * (capacity + 1), &contact->work.result.N,
                         PetscSqr(3 * (capacity + 1)), &contact->work.result.M));
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
  PetscCall(PetscFree3(c->work.result.points, c->work.result.N, c->work.result.M));
  PetscCall(ContactWorkDestroy(&c->work));
  PetscCall(PetscFree(c->work.workspace));
  PetscCall(BlockMatrixDestroy(&c->blocks));
  PetscCall(ContactVectorsFree(&c->border));
  PetscCall(ContactVectorsFree(&c->one));
  PetscCall(PetscFree(*contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- residual ---------- */

/* Moves the lists' points to (u, t) and projects every slave point. The gaps stand already where the last evaluation
   was at the same place: three in four, as the solver asks for residual, energy and tangent of each iterate one by one.
 */
PetscErrorCode ContactPairProject(Contact contact, ContactPair *pair, const PetscReal *u, PetscReal t)
{
  PetscBool moved;

  PetscFunctionBeginUser;
  PetscCall(NeighbourListsUpdate(pair->search, pair->lists, u, t, &moved));
  if (moved) pair->fresh = PETSC_FALSE;
  if (pair->projected && !moved) PetscFunctionReturn(PETSC_SUCCESS);
  pair->projected = PETSC_TRUE;
  ContactVariationsReset(pair->variations);
  PetscCall(PetscLogEventBegin(contact->event_project, 0, 0, 0, 0));
  if (pair->fit.degree) TimingBegin(TIMING_FIT);
  if (pair->fit.degree) PetscCall(PetscLogEventBegin(contact->event_fit, 0, 0, 0, 0));
  PetscCall(ContactPointGaps(pair, pair->lists, pair->factor, pair->point_force, pair->seed, pair->point_gap,
                             pair->point_normal));
  if (pair->fit.degree) PetscCall(PetscLogEventEnd(contact->event_fit, 0, 0, 0, 0));
  if (pair->fit.degree) TimingEnd(TIMING_FIT);
  PetscCall(PetscLogEventEnd(contact->event_project, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a linear step counts on of an open term: what was closed stays so, pressed or pulled; what touches at the start
   of a run resists, for a body that only contact holds. In surface contact the mean over the faces around a node that
   touches is open by their curvature: such terms are pulled, all of them, as those that only resist would hold the
   others open. */
static void TermHold(const ContactPair *pair, PetscInt c, PetscReal opening, LawValue *value)
{
  const PetscBool closed = pair->held[c], means = (PetscBool)(pair->slave_offsets && pair->fit.degree);

  if (!closed && !(pair->touching && opening <= (means ? ContactMeanOpening(pair, c) : ContactTouchTolerance(pair, c))))
    return;
  value->stiffness = PetscMin(pair->most, pair->now.penalty[c]);
  if (closed || pair->slave_offsets) value->pressure = -value->stiffness * opening;
}

/* What the law is to know of a term. */
LawState ContactTermState(const ContactPair *pair, PetscInt c, PetscReal t)
{
  return (LawState){PetscMin(pair->most, pair->now.penalty[c]), ContactTermOffset(pair, c, t), pair->now.multiplier[c]};
}

/* ContactTermLaw - law, gap (length; may be NULL) and area of a term in the state of the last projection; in a linear
 * step what it counts on. Not collective.
 */
void ContactTermLaw(const ContactPair *pair, PetscInt c, PetscReal t, LawValue *value, PetscReal *gap, PetscReal *area)
{
  const LawState  state = ContactTermState(pair, c, t);
  const PetscReal found = ContactTermGap(pair, pair->factor, pair->point_gap, c, area);

  *value = (LawValue){0, 0, 0};
  if (gap) *gap = found;
  if (PetscIsNanReal(found)) return;
  pair->law->evaluate(found, &state, value);
  if (pair->holding && value->stiffness == 0) TermHold(pair, c, found - LawOnsetGap(&state), value);
}

/* ContactTermForce - what a term's own gap, of the last projection, presses with (force). Not collective.

   In surface contact it is not the nodal force, most of which may be the neighbours': they press on the faces that they
   share with it. */
PetscReal ContactTermForce(const ContactPair *pair, PetscInt c)
{
  LawValue  value;
  PetscReal area;

  if (!pair->slaves->face_sf) return pair->force[c];
  ContactTermLaw(pair, c, pair->t, &value, NULL, &area);
  return value.pressure * area;
}

/* Direction of a term's contact: the mean of its points'. */
static void TermNormal(ContactPair *pair, PetscInt c)
{
  PetscReal *normal = &pair->normal[3 * c], length = 0;

  for (int d = 0; d < 3; d++) normal[d] = 0;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++)
    for (int d = 0; d < 3; d++)
      normal[d] +=
        pair->term_weight[k] * pair->factor[pair->term_point[k]] * pair->point_normal[3 * pair->term_point[k] + d];
  for (int d = 0; d < 3; d++) length += PetscSqr(normal[d]);
  for (int d = 0; d < 3 && length > 0; d++) normal[d] /= PetscSqrtReal(length);
}

/* A pressure of a term presses on all of its points. */
static void TermPress(ContactPair *pair, PetscInt c, PetscReal pressure)
{
  if (pressure == 0) return;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++)
    pair->point_force[pair->term_point[k]] += pressure * pair->term_weight[k] * pair->factor[pair->term_point[k]];
}

/* Adds the forces of the loaded slave points to the contact nodes' values. */
static PetscErrorCode PairForces(ContactPair *pair, PetscReal *values)
{
  const int                dim = pair->mesh->dim;
  const ContactVariations *v   = pair->variations;

  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < pair->lists->n_slaves; q++) {
    const PetscReal force = pair->point_force[q];

    if (force == 0) continue;
    PetscCall(ContactVariationsNeed(pair, q));
    for (PetscInt i = v->first[q]; i < v->end[q]; i++)
      for (int d = 0; d < dim; d++) values[v->number[i] * dim + d] -= force * v->N[i * dim + d];
    for (int d = 0; d < dim && v->first[q] < v->end[q]; d++) pair->total[d] += force * v->own[q * dim + d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Normal nodal forces of terms that share their points: the points' forces by the hat functions, those of terms on
 * other ranks too. */
static PetscErrorCode PairSharedForces(ContactPair *pair)
{
  const int      dim   = pair->mesh->dim;
  NeighbourLists lists = pair->lists;
  PetscReal     *values, *nodal;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(lists->n_nodes * dim, &values, pair->mesh->n_nodes * dim, &nodal));
  for (PetscInt q = 0; q < lists->n_slaves; q++)
    for (PetscInt k = pair->slaves->ptr[q], node = lists->slave_ptr[q]; k < pair->slaves->ptr[q + 1]; k++, node++)
      values[lists->slave_node[node] * dim] += pair->slaves->hat[k] * pair->point_force[q];
  PetscCall(NeighbourListsReduce(lists, values, nodal));
  for (PetscInt c = 0; c < pair->n; c++) pair->force[c] = nodal[pair->node[c] * dim];
  PetscCall(PetscFree2(values, nodal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairResidual(Contact contact, ContactPair *pair, const PetscReal *u, PetscReal t, PetscReal *f,
                                   PetscReal *energy, PetscReal *force2)
{
  PetscReal *values;

  PetscFunctionBeginUser;
  PetscCall(ContactPairProject(contact, pair, u, t));
  if (f) PetscCall(PetscArrayzero(pair->point_force, pair->lists->n_slaves));
  for (PetscInt c = 0; c < pair->n; c++) {
    LawValue  value;
    PetscReal gap, area;

    ContactTermLaw(pair, c, t, &value, &gap, &area);
    if (energy) *energy += area * value.psi;
    if (force2) *force2 += 2 * PetscSqr(area * value.pressure); /* on the slave and on the master */
    if (!f) continue;
    pair->now.gap[c]    = gap;
    pair->now.status[c] = value.stiffness > 0 ? CONTACT_CLOSED : CONTACT_OPEN;
    TermPress(pair, c, value.pressure);
    TermNormal(pair, c);
  }
  if (!f) PetscFunctionReturn(PETSC_SUCCESS);
  pair->t = t;
  PetscCall(PetscArrayzero(pair->total, 3));
  PetscCall(PetscCalloc1(pair->lists->n_nodes * contact->mesh->dim, &values));
  PetscCall(PairForces(pair, values));
  PetscCall(NeighbourListsReduce(pair->lists, values, f));
  if (pair->slaves->face_sf) PetscCall(PairSharedForces(pair));
  for (PetscInt c = 0; c < pair->n && !pair->slaves->face_sf; c++)
    pair->force[c] = pair->point_force[pair->term_point[pair->term_ptr[c]]];
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactHoldActiveSet - between the two calls what is in contact at the first one stays so, pressed or pulled, in
   residual and tangent.

   Not collective. For a linear step from a solution: fresh lists and offsets move the surfaces a little, which is a
   load of the step, not an opening. touching: what is open within ContactTouchTolerance() is closed too (Chamoret et
   al. start from surfaces that touch). */
PetscErrorCode ContactHoldActiveSet(Contact contact, PetscBool holding, PetscBool touching)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    pair->holding  = holding;
    pair->touching = touching;
    for (PetscInt c = 0; c < pair->n && holding; c++)
      pair->held[c] = (PetscBool)(pair->now.status[c] == CONTACT_CLOSED);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactResidual - contact forces, energy and their unassembled norm at (u, t).

   Collective, with the same arguments NULL on all ranks. u[n_nodes*dim]: local displacements (length). f[n_nodes*dim]:
   contact forces are subtracted as external ones are, complete at owned nodes; with f gaps, status and nodal forces
   become the present state. energy, force2 (sum of the squared forces of the terms on either side): this rank's, added
   to. Each of the three may be NULL.

   Source: Chamoret et al. 2004, eq. 12 and 15. */
PetscErrorCode ContactResidual(Contact contact, const PetscReal *u, PetscReal t, PetscReal *f, PetscReal *energy,
                               PetscReal *force2)
{
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_residual, 0, 0, 0, 0));
  for (int p = 0; p < contact->n_pairs; p++)
    PetscCall(PairResidual(contact, &contact->pairs[p], u, t, f, energy, force2));
  PetscCall(PetscLogEventEnd(contact->event_residual, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactMarkPredicted - what is in contact now is what ContactUnpredictedEnergy() takes for foreseen. Not collective.
 */
PetscErrorCode ContactMarkPredicted(Contact contact)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++) pair->predicted[c] = (PetscBool)(pair->now.status[c] == CONTACT_CLOSED);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactUnpredictedEnergy - energy of the terms in contact at (u, t) that ContactMarkPredicted() found open, of this
   rank, added to.

   Collective. u[n_nodes*dim]: local displacements (length). */
PetscErrorCode ContactUnpredictedEnergy(Contact contact, const PetscReal *u, PetscReal t, PetscReal *energy)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    PetscCall(ContactPairProject(contact, pair, u, t));
    for (PetscInt c = 0; c < pair->n; c++) {
      LawValue  value;
      PetscReal area;

      ContactTermLaw(pair, c, t, &value, NULL, &area);
      if (!pair->predicted[c]) *energy += area * value.psi;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- tangent ---------- */

/* Pressure whose turning with the surface counts in a tangent: in a linear step that of the accepted state, not what
   pulls a term to its place. The state before any load is in no equilibrium: its overlaps pull, and their pressure
   grows with the penalty until the tangent is indefinite. */
static PetscReal TermTurningPressure(const ContactPair *pair, PetscInt c, PetscReal t, const LawValue *value)
{
  const ContactState *accepted = &pair->accepted;

  if (!pair->holding) return value->pressure;
  if (pair->touching) return 0;
  return accepted->status[c] == CONTACT_CLOSED
           ? accepted->multiplier[c] + accepted->penalty[c] * (ContactTermOffset(pair, c, t) - accepted->gap[c])
           : 0;
}

/* Stiffness of the terms, 0 where they take no part, and the forces of slave points that turn with the surface. */
static PetscErrorCode PairStiffness(Contact contact, ContactPair *pair, const PetscReal *u, PetscReal t)
{
  PetscFunctionBeginUser;
  PetscCall(ContactPairProject(contact, pair, u, t));
  PetscCall(PetscArrayzero(pair->point_force, pair->lists->n_slaves));
  for (PetscInt c = 0; c < pair->n; c++) {
    LawValue  value;
    PetscReal area;

    ContactTermLaw(pair, c, t, &value, NULL, &area);
    pair->stiffness_before[c] = pair->stiffness[c];
    pair->stiffness[c]        = value.stiffness;
    if (value.stiffness > 0) TermPress(pair, c, TermTurningPressure(pair, c, t, &value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Names the block over the nodes of some slave points, unless there are none. */
static PetscErrorCode NameBlock(Contact contact, const ContactPair *pair, int p, PetscInt n, const PetscInt *points)
{
  PetscFunctionBeginUser;
  PetscCall(ContactVariationsNodes(pair, n, points));
  PetscCall(
    BlockMatrixName(contact->blocks, p, pair->work->count, pair->work->number, (PetscBool)(contact->product != NULL)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The loaded points of a face, which share most of their nodes */
static PetscInt FacePoints(const ContactPair *pair, PetscInt face, PetscInt points[FACE_RULE_POINTS])
{
  PetscInt n = 0;

  for (PetscInt q = pair->slaves->first[face]; q < pair->slaves->first[face + 1]; q++)
    if (pair->point_force[q] != 0) points[n++] = q;
  return n;
}

/* Names the blocks of a pair: one for each active term, and where terms share their points one for each loaded face. */
static PetscErrorCode PairName(Contact contact, const ContactPair *pair, int p)
{
  PetscInt points[FACE_RULE_POINTS];

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++)
    if (pair->stiffness[c] > 0)
      PetscCall(
        NameBlock(contact, pair, p, pair->term_ptr[c + 1] - pair->term_ptr[c], &pair->term_point[pair->term_ptr[c]]));
  for (PetscInt face = 0; pair->slaves->face_sf && face < pair->slaves->n_faces; face++)
    PetscCall(NameBlock(contact, pair, p, FacePoints(pair, face, points), points));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The block A psi'' Nbar Nbar^T of a term, which stands alone where it shares its points; else with -p M of its one
 * point. */
static PetscErrorCode TermBlock(Contact contact, const ContactPair *pair, int p, PetscInt c, PetscInt n,
                                const PetscInt *nodes, double (*own)[FIT_DERIVATIVES_OWN])
{
  const PetscInt q = pair->term_point[pair->term_ptr[c]];
  PetscReal     *v, area;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n * contact->mesh->dim + BLOCK_PADDING, &v));
  ContactTermGap(pair, pair->factor, pair->point_gap, c, &area);
  ContactTermVary(pair, c, PetscSqrtReal(pair->stiffness[c] / area), v);
  if (pair->slaves->face_sf)
    PetscCall(BlockMatrixAddOuter(contact->blocks, p, n, nodes, v));
  else {
    PetscCall(ContactSecondBegin(pair, n, 1));
    FitDerivativesAddOuter(&pair->work->sum, 1, v);
    if (pair->point_force[q] != 0) PetscCall(ContactSecondAdd(pair, q, -pair->point_force[q], own));
    ContactSecondEnd(pair);
    PetscCall(BlockMatrixAdd(contact->blocks, p, n, nodes, pair->work->M));
  }
  PetscCall(PetscFree(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The block -sum p M of the points of one face: their second variations are summed before they are taken apart. */
static PetscErrorCode FaceBlock(Contact contact, const ContactPair *pair, int p, PetscInt face, PetscInt n,
                                const PetscInt *nodes, double (*own)[FIT_DERIVATIVES_OWN])
{
  PetscInt       points[FACE_RULE_POINTS];
  const PetscInt loaded = FacePoints(pair, face, points);

  PetscFunctionBeginUser;
  PetscCall(ContactSecondBegin(pair, n, loaded));
  for (PetscInt k = 0; k < loaded; k++)
    PetscCall(ContactSecondAdd(pair, points[k], -pair->point_force[points[k]], own));
  ContactSecondEnd(pair);
  PetscCall(BlockMatrixAdd(contact->blocks, p, n, nodes, pair->work->M));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Blocks of what belongs to the fit points one by one, for all slave points at once: one for the points of a face,
 * which are made of the same nodes. */
static PetscErrorCode OwnBlocks(Contact contact, const ContactPair *pair, int p,
                                const double (*own)[FIT_DERIVATIVES_OWN])
{
  NeighbourLists lists = pair->lists;

  PetscFunctionBeginUser;
  for (PetscInt first = 0, end; first < lists->n_points; first = end) {
    PetscInt  n, with, *nodes;
    PetscReal most = 0;

    end = NeighbourListsAlikeEnd(lists, first);
    for (PetscInt k = first; k < end; k++)
      for (int e = 0; e < FIT_DERIVATIVES_OWN; e++) most = PetscMax(most, PetscAbsReal(own[k][e]));
    if (most == 0) continue;
    PetscCall(ContactPointsToNodes(pair, first, end));
    nodes = pair->work->number;
    PetscCall(BlockMatrixSort(contact->blocks, p, pair->work->count, nodes, &with));
    n = contact->product ? pair->work->count : with;
    PetscCall(ContactBlockBegin(pair, n, nodes));
    PetscCall(ContactOwnToNodes(pair, n, first, end, own));
    PetscCall(BlockMatrixAdd(contact->blocks, p, n, nodes, pair->work->M));
    ContactBlockEnd(pair, n, nodes);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the blocks of a pair as PairName() named them, from block number *block on. */
static PetscErrorCode PairBlocks(Contact contact, ContactPair *pair, int p, PetscInt *block)
{
  const PetscInt  faces = pair->slaves->face_sf ? pair->slaves->n_faces : 0;
  const PetscInt *nodes;
  PetscInt        n;
  double(*own)[FIT_DERIVATIVES_OWN] = NULL;

  PetscFunctionBeginUser;
  if (pair->fit.degree) PetscCall(PetscCalloc1(pair->lists->n_points, &own));
  for (PetscInt k = 0; k < pair->n + faces; k++) {
    if (k < pair->n && pair->stiffness[k] <= 0) continue;
    BlockMatrixGetNodes(contact->blocks, (*block)++, &n, &nodes);
    if (!n) continue;
    PetscCall(ContactBlockBegin(pair, n, nodes));
    if (k < pair->n)
      PetscCall(TermBlock(contact, pair, p, k, n, nodes, own));
    else
      PetscCall(FaceBlock(contact, pair, p, k - pair->n, n, nodes, own));
    ContactBlockEnd(pair, n, nodes);
  }
  if (pair->fit.degree) PetscCall(OwnBlocks(contact, pair, p, own));
  PetscCall(PetscFree(own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of the contact matrix on this rank: the free dofs that it owns */
static PetscErrorCode ContactMatrixRows(Contact contact, PetscInt *rows)
{
  PetscSection section;

  PetscFunctionBeginUser;
  PetscCall(DMGetGlobalSection(contact->mesh->dm, &section));
  PetscCall(PetscSectionGetConstrainedStorageSize(section, rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Names all blocks and finds their places. */
static PetscErrorCode PlaceBlocks(Contact contact, PetscBool *changed)
{
  const PetscInt **dof;
  PetscInt        *n, rows;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(contact->n_pairs, &dof, contact->n_pairs, &n));
  for (int p = 0; p < contact->n_pairs; p++) {
    dof[p] = contact->pairs[p].lists->dof;
    n[p]   = contact->pairs[p].lists->n_nodes;
  }
  PetscCall(BlockMatrixBegin(contact->blocks, contact->n_pairs, n, dof));
  PetscCall(PetscFree2(dof, n));
  for (int p = 0; p < contact->n_pairs; p++) PetscCall(PairName(contact, &contact->pairs[p], p));
  PetscCall(ContactMatrixRows(contact, &rows));
  PetscCall(BlockMatrixPlace(contact->blocks, rows, changed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactTangent - the derivative of ContactResidual()'s forces by the free displacements: A (psi'' N N^T - p M) for
   each closed term, p its pressure.

   Collective. u, t: as of ContactResidual(). *C: over the global free dofs, the contact's own; *changed: its pattern is
   new. Source: Chamoret et al. 2004, eq. 14. */
PetscErrorCode ContactTangent(Contact contact, const PetscReal *u, PetscReal t, Mat *C, PetscBool *changed)
{
  PetscInt block = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_tangent, 0, 0, 0, 0));
  for (int p = 0; p < contact->n_pairs; p++) PetscCall(PairStiffness(contact, &contact->pairs[p], u, t));
  PetscCall(PlaceBlocks(contact, changed));
  for (int p = 0; p < contact->n_pairs; p++) {
    if (contact->product) BlockMatrixMultiply(contact->blocks, contact->product[p].x, contact->product[p].y);
    PetscCall(PairBlocks(contact, &contact->pairs[p], p, &block));
  }
  PetscCall(BlockMatrixEnd(contact->blocks, C));
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

/* ContactPairMove - how the contact nodes of a pair move with local displacements x, tools and an analytic master from
   t to t_next: values[lists n_nodes*dim]. Collective. */
PetscErrorCode ContactPairMove(Contact contact, ContactPair *pair, const PetscReal *x, PetscReal t, PetscReal t_next,
                               PetscReal *values)
{
  PetscFunctionBeginUser;
  PetscCall(NeighbourListsBroadcast(pair->search, pair->lists, x, t, t_next, values));
  if (!pair->master) AnalyticTravel(contact, pair, t, t_next, values);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactMultiplyBegin - the next ContactTangent() is multiplied with x, prescribed dofs included.

   Collective. x[n_nodes*dim]: local displacements (length), ghosts included, to which the rigid tools' motion from t to
   t_next is joined. Lists stay until ContactMultiplyEnd(). */
PetscErrorCode ContactMultiplyBegin(Contact contact, const PetscReal *x, PetscReal t, PetscReal t_next)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(contact->n_pairs, &contact->product));
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair    *pair    = &contact->pairs[p];
    ContactProduct *product = &contact->product[p];
    const PetscInt  n       = pair->lists->n_nodes * contact->mesh->dim;

    PetscCall(PetscCalloc2(n, &product->x, n, &product->y));
    PetscCall(ContactPairMove(contact, pair, x, t, t_next, product->x));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactMultiplyEnd - y += C x of the tangent since ContactMultiplyBegin().

   Collective. y[n_nodes*dim]: local forces, complete at owned nodes. */
PetscErrorCode ContactMultiplyEnd(Contact contact, PetscReal *y)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    PetscCall(NeighbourListsReduce(contact->pairs[p].lists, contact->product[p].y, y));
    PetscCall(PetscFree2(contact->product[p].x, contact->product[p].y));
  }
  PetscCall(PetscFree(contact->product));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- state ---------- */

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
