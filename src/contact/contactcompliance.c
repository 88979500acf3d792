/* First variations of contact by its penalties and by the shape of its masters: the forces that stiffer penalties add
   where nothing moves, and how the loads of the pairs change along the motion that follows. What is in contact stays
   so, and what slips goes on slipping. No step is taken, so that no digits are lost. */
#include "base/largest.h"
#include "contactimpl.h"

/* Present areas of slave nodes are compared to both sides along a motion, where it is this part of the mean size of the
   slave's faces. The error of the difference, which is as the square, and that of rounding are then both about 1e-10 of
   the difference. */
#define COMPLIANCE_AREA_STEP 1e-5

/* Changes of a pair for each unit of ln s, s being the factor on the penalties. */
typedef struct {
  PetscReal *on_point, *friction; /* of each slave point: normal force, and 3 of friction */
  PetscReal *force, *on_node;     /* of each slave node: normal force, and of each term 3 of friction */
  PetscReal *reaction;            /* on the master by node of the mesh; NULL: the pair has no partner */
} PairChange;

/* Change of a term's pressure by its stiffer penalty, where nothing moves. A penalty that is at its bound stays. */
static PetscReal TermStiffer(const ContactPair *pair, PetscInt c, const LawValue *value)
{
  const LawState state = ContactTermState(pair, c, pair->t, ContactTermMost(pair, c));

  return ContactTermAtBound(pair, c) ? 0 : value->pressure - state.multiplier;
}

/* Change of a term's gap along a motion of the contact nodes. area: of the term. */
static PetscErrorCode TermGapAlong(const ContactPair *pair, PetscInt c, PetscReal area, const PetscReal *motion,
                                   PetscReal *change)
{
  PetscFunctionBeginUser;
  *change = 0;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt  q      = pair->term_point[k];
    const PetscReal weight = pair->term_weight[k] * pair->factor[q];
    PetscReal       of_point;

    if (weight == 0) continue;
    PetscCall(ContactVariationsAlong(pair, q, motion, &of_point));
    *change += weight / area * of_point;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the change of a term's friction to the forces of its slave points. stiffer: change of its pressure where nothing
   moves. motion: relative to a tool with unknowns; NULL: nothing moves. */
static PetscErrorCode TermFriction(const ContactPair *pair, PetscInt c, PenaltySource source, PetscReal stiffer,
                                   const PetscReal *motion, PetscReal *friction)
{
  PetscReal        change[3] = {0, 0, 0}, closer;
  FrictionInput    in;
  FrictionTraction out;
  PetscBool        acts;

  PetscFunctionBeginUser;
  PetscCall(FrictionTerm(pair, c, pair->t, &in, &out, &acts));
  if (!acts) PetscFunctionReturn(PETSC_SUCCESS);
  if (motion) PetscCall(FrictionTermAlong(pair, c, &out, motion, change));
  closer = in.rate > 0 ? stiffer / in.rate : 0; /* a fluid may press in the contact's place */
  for (int d = 0; d < 3; d++) change[d] += source == BY_SLIP ? out.by_stiffness[d] : -out.by_gap[d] * closer;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt q = pair->term_point[k];

    for (int d = 0; d < 3 && FrictionTermTakes(pair, k); d++)
      friction[3 * q + d] += pair->term_weight[k] * pair->factor[q] * change[d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Changes of the forces of slave points. motion: of the contact nodes; NULL: nothing moves. */
static PetscErrorCode PointChanges(ContactPair *pair, PenaltySource source, const PetscReal *motion, PairChange *change)
{
  const PetscInt n        = pair->lists->n_nodes * pair->mesh->dim;
  PetscReal     *relative = NULL;

  PetscFunctionBeginUser;
  if (pair->friction && motion) {
    PetscCall(PetscMalloc1(n, &relative));
    PetscCall(PetscArraycpy(relative, motion, n));
    if (pair->tool) PetscCall(ContactToolRelative(pair, relative));
  }
  for (PetscInt c = 0; c < pair->n; c++) {
    PetscReal area, stiffer, gap = 0;
    LawValue  value;

    ContactTermLaw(pair, c, pair->t, &value, NULL, &area);
    if (!(value.stiffness > 0)) continue;
    stiffer = source == BY_PENETRATION ? TermStiffer(pair, c, &value) : 0;
    if (motion) PetscCall(TermGapAlong(pair, c, area, motion, &gap));
    ContactTermPress(pair, c, stiffer - value.stiffness * gap, change->on_point);
    if (pair->friction) PetscCall(TermFriction(pair, c, source, stiffer, relative, change->friction));
  }
  PetscCall(PetscFree(relative));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairChangeCreate(const ContactPair *pair, PairChange *change)
{
  const PetscInt points = pair->lists->n_slaves;

  PetscFunctionBeginUser;
  *change = (PairChange){.on_point = NULL};
  PetscCall(PetscCalloc4(points, &change->on_point, 3 * points, &change->friction, pair->n_nodes, &change->force,
                         3 * pair->n, &change->on_node));
  if (pair->scene->share < 1) PetscCall(MeshCreateLocal(pair->mesh, pair->mesh->dim, &change->reaction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairChangeDestroy(PairChange *change)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(change->on_point, change->friction, change->force, change->on_node));
  PetscCall(PetscFree(change->reaction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the forces of a pair's slave points to those of the mesh. */
static PetscErrorCode AddForces(ContactPair *pair, const PairChange *change, PetscReal *f)
{
  PetscReal *values;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(pair->lists->n_nodes * pair->mesh->dim, &values));
  PetscCall(ContactPointForces(pair, change->on_point, values));
  for (PetscInt q = 0; pair->friction && q < pair->lists->n_slaves; q++)
    PetscCall(FrictionPointForces(pair, q, &change->friction[3 * q], values));
  if (pair->tool) PetscCall(ContactToolForces(pair, values));
  PetscCall(NeighbourListsReduce(pair->lists, values, f));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Changes of the forces of slave points where the master's nodes move by `motion` for the gaps alone. */
static PetscErrorCode ShapeChanges(ContactPair *pair, const PetscReal *motion, PairChange *change)
{
  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) {
    PetscReal area, gap;
    LawValue  value;

    ContactTermLaw(pair, c, pair->t, &value, NULL, &area);
    if (!(value.stiffness > 0)) continue;
    PetscCall(TermGapAlong(pair, c, area, motion, &gap));
    ContactTermPress(pair, c, -value.stiffness * gap, change->on_point);
    if (pair->friction)
      PetscCall(TermFriction(pair, c, BY_PENETRATION, -value.stiffness * gap, NULL, change->friction));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does the miss of the master's nodes say what its surface leaves of error? Facets meet their nodes, and miss the
   surface between them. Nodes that are slaves as well would move with the points whose gaps are measured. */
static PetscErrorCode ShapeKnown(const ContactPair *pair, const PetscReal *miss, PetscBool *known)
{
  const MeshGroup *group = pair->slave->group;
  const int        dim   = pair->mesh->dim;

  PetscFunctionBeginUser;
  *known = PETSC_TRUE;
  for (PetscInt i = 0; i < group->n_nodes; i++)
    for (int d = 0; d < dim; d++) *known = (PetscBool)(*known && miss[group->nodes[i] * dim + d] == 0);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, known, 1, MPIU_BOOL, MPI_LAND, pair->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairShapeForces - computes the forces that a pair adds where its master is nearer to its own nodes, and nothing
  moves.

  Collective

  Input Parameters:
+ contact - the contact, in the state of its last ContactResidual() with forces
. p       - number of the pair
- u       - local displacements of that residual, u[n_nodes*dim] (length)

  Input/Output Parameter:
. f - as of ContactPairStifferForces()

  Output Parameter:
. known - PETSC_FALSE: not known for a meshed rigid master, one of facets, and one that shares nodes with its slave

  Note:
  The true surface goes through the nodes. The smooth one misses them by m and is, to first order, a linear function of
  their positions: fitted to nodes that are moved by m it is nearer to the true one by one order (twicing). The slave's
  own surface interpolates its nodes. An analytic master is the true surface.
@*/
PetscErrorCode ContactPairShapeForces(Contact contact, int p, const PetscReal *u, PetscReal *f, PetscBool *known)
{
  ContactPair *pair = &contact->pairs[p];
  PetscReal   *miss, *motion;
  PairChange   change;

  PetscFunctionBeginUser;
  *known = (PetscBool)(!pair->master || (pair->fit.fitted && !pair->master->rigid && !pair->slave->rigid));
  if (!*known || !pair->master) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(contact->mesh->n_nodes * contact->mesh->dim, &miss, pair->lists->n_nodes * contact->mesh->dim,
                         &motion));
  PetscCall(SearchMasterMiss(pair->search, u, pair->t, miss));
  PetscCall(ShapeKnown(pair, miss, known));
  if (*known) {
    PetscCall(PairChangeCreate(pair, &change));
    PetscCall(ContactPairMove(contact, pair, miss, pair->t, pair->t, motion));
    PetscCall(ShapeChanges(pair, motion, &change));
    PetscCall(AddForces(pair, &change, f));
    PetscCall(PairChangeDestroy(&change));
  }
  PetscCall(PetscFree2(miss, motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairStifferForces - computes the forces that stiffer penalties add in one pair where nothing moves.

  Collective

  Input Parameters:
+ contact - the contact, in the state of its last ContactResidual() with forces
. p       - number of the pair
- source  - which penalties become stiffer

  Input/Output Parameter:
. f - forces for each unit of the logarithm of the factor on the penalties are subtracted as external ones are,
      f[n_nodes*dim], complete at owned nodes
@*/
PetscErrorCode ContactPairStifferForces(Contact contact, int p, PenaltySource source, PetscReal *f)
{
  ContactPair *pair = &contact->pairs[p];
  PairChange   change;

  PetscFunctionBeginUser;
  PetscCall(PairChangeCreate(pair, &change));
  PetscCall(PointChanges(pair, source, NULL, &change));
  PetscCall(AddForces(pair, &change, f));
  PetscCall(PairChangeDestroy(&change));
  if (pair->ridge) PetscCall(ContactPairStifferForces(contact, pair->ridge, source, f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStifferForces - computes the forces that stiffer penalties add where nothing moves.

  Collective

  Input Parameters:
+ contact - the contact, in the state of its last ContactResidual() with forces
- source  - which penalties become stiffer

  Input/Output Parameter:
. f - as of ContactPairStifferForces(), of all pairs
@*/
PetscErrorCode ContactStifferForces(Contact contact, PenaltySource source, PetscReal *f)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_scene; p++) PetscCall(ContactPairStifferForces(contact, p, source, f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Changes of the forces of a pair along a motion of the mesh's nodes. */
static PetscErrorCode PairForcesAlong(Contact contact, ContactPair *pair, PenaltySource source, const PetscReal *v,
                                      PairChange *change)
{
  const PetscInt n = pair->lists->n_nodes * contact->mesh->dim;
  PetscReal     *motion, *values;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n, &motion, n, &values));
  PetscCall(ContactPairMove(contact, pair, v, pair->t, pair->t, motion));
  PetscCall(PointChanges(pair, source, motion, change));
  PetscCall(ContactNodalForces(pair, change->on_point, change->force));
  if (pair->friction) PetscCall(FrictionNodalForces(pair, change->friction, change->on_node));
  if (change->reaction) {
    PetscCall(ContactPointForces(pair, change->on_point, values));
    PetscCall(ContactPointReactions(pair, change->on_point, values, change->reaction));
  }
  PetscCall(PetscFree2(motion, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The factor on the motion v with which areas are compared; 0: the slave does not move. */
static PetscErrorCode AreaStep(const ContactPair *pair, const PetscReal *v, PetscReal *step)
{
  const MeshGroup *group = pair->slave->group;
  const int        dim   = pair->mesh->dim;
  PetscReal        most  = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < group->n_nodes; i++)
    for (int d = 0; d < dim; d++) most = PetscMax(most, PetscAbsReal(v[group->nodes[i] * dim + d]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPIU_MAX, pair->mesh->comm));
  *step = most > 0 ? COMPLIANCE_AREA_STEP * pair->slave->mean_size / most : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to the changes of nodal pressures what comes from present areas that change. */
static PetscErrorCode AddAreaChange(Contact contact, int p, const PetscReal *reaction, const PetscReal *u,
                                    const PetscReal *v, PetscReal *change)
{
  const ContactPair *pair = &contact->pairs[p];
  const PetscInt     n    = contact->mesh->n_nodes * contact->mesh->dim;
  PetscReal         *moved, *area, *pressure, step = 0;

  PetscFunctionBeginUser;
  if (contact->scene->kinematics == KINEMATICS_SMALL) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AreaStep(pair, v, &step));
  if (step == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc3(n, &moved, contact->mesh->n_nodes, &area, pair->n_nodes, &pressure));
  for (int side = -1; side <= 1; side += 2) {
    for (PetscInt i = 0; i < n; i++) moved[i] = u[i] + side * step * v[i];
    PetscCall(ContactNodePressures(contact, p, moved, pair->force, reaction, area, pressure));
    for (PetscInt c = 0; c < pair->n_nodes; c++) change[c] += side * pressure[c] / (2 * step);
  }
  PetscCall(PetscFree3(moved, area, pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums up the changes of a pair's nodes as ContactPairLoad() sums up what they bear. pressure: changes of theirs;
   point_force: of points on sharp edges of its tool. */
static PetscErrorCode SumChanges(const ContactPair *pair, const ContactNodes *nodes, const PairChange *change,
                                 PetscInt points, const PetscReal *point_force, const PetscReal *pressure,
                                 ContactLoad *load)
{
  PetscReal   sum[8] = {0}, largest = 0, peak = 0;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < nodes->n; c++) {
    for (int d = 0; d < 3 && pair->friction; d++) sum[4 + d] += change->on_node[3 * c + d];
    if (!(nodes->force[c] > 0)) continue;
    sum[0] += nodes->force[c];
    sum[1] += nodes->force[c] * nodes->pressure[c];
    sum[2] += change->force[c];
    sum[3] += change->force[c] * nodes->pressure[c] + nodes->force[c] * pressure[c];
    if (nodes->pressure[c] <= largest) continue;
    largest = nodes->pressure[c];
    peak    = pressure[c];
  }
  for (PetscInt c = 0; c < points; c++) sum[7] += point_force[c];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 8, MPIU_REAL, MPIU_SUM, pair->mesh->comm));
  PetscCall(LargestOfRanks(pair->mesh->comm, largest, NULL, &rank, NULL));
  PetscCallMPI(MPI_Bcast(&peak, 1, MPIU_REAL, rank, pair->mesh->comm));
  *load = (ContactLoad){.force    = sum[2] + sum[7],
                        .pressure = sum[0] > 0 ? (sum[3] - sum[1] / sum[0] * sum[2]) / sum[0] : 0,
                        .peak     = peak,
                        .friction = {sum[4], sum[5], sum[6]}};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactLoadChanges - computes how the loads of all pairs change with stiffer penalties.

  Collective

  Input Parameters:
+ contact - the contact, in the state of its last ContactResidual() with forces
. source  - which penalties become stiffer
. u       - local displacements of that residual, u[n_nodes*dim] (length)
- v       - how they change for each unit of the logarithm of the factor on the penalties, v[n_nodes*dim] (length),
            ghosts included

  Output Parameter:
. change - derivative of ContactPairLoad() by the logarithm of the factor, for each pair

  Notes:
  The largest pressure is that of the node where it is now. With a tool that turns freely, friction is as the tool sees
  it. Where two pairs treat two surfaces from either side, the directions in which the partner presses stay.
@*/
PetscErrorCode ContactLoadChanges(Contact contact, PenaltySource source, const PetscReal *u, const PetscReal *v,
                                  ContactLoad change[])
{
  PairChange *pairs;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(contact->n_pairs, &pairs));
  for (int p = 0; p < contact->n_pairs; p++) {
    PetscCall(PairChangeCreate(&contact->pairs[p], &pairs[p]));
    PetscCall(PairForcesAlong(contact, &contact->pairs[p], source, v, &pairs[p]));
  }
  for (int p = 0; p < contact->n_scene; p++) {
    const int          partner = ContactPairPartner(contact, p);
    const ContactPair *pair    = &contact->pairs[p];
    PetscReal         *pressure, *area;
    ContactNodes       nodes;

    PetscCall(PetscMalloc2(pair->n_nodes, &pressure, contact->mesh->n_nodes, &area));
    PetscCall(ContactNodePressures(contact, p, u, pairs[p].force, partner >= 0 ? pairs[partner].reaction : NULL, area,
                                   pressure));
    PetscCall(AddAreaChange(contact, p, partner >= 0 ? contact->pairs[partner].reaction : NULL, u, v, pressure));
    PetscCall(ContactGetNodes(contact, p, u, &nodes));
    PetscCall(SumChanges(pair, &nodes, &pairs[p], pair->ridge ? contact->pairs[pair->ridge].n : 0,
                         pairs[pair->ridge].force, pressure, &change[p]));
    PetscCall(PetscFree2(pressure, area));
  }
  for (int p = 0; p < contact->n_pairs; p++) PetscCall(PairChangeDestroy(&pairs[p]));
  PetscCall(PetscFree(pairs));
  PetscFunctionReturn(PETSC_SUCCESS);
}
