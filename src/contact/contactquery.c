/* What contact shows to reports, probes and results. Nothing here changes the state. */
#include "base/largest.h"
#include "base/vectors.h"
#include "contactimpl.h"
#include "penaltyrule.h"
#include "search/surfacepatch.h"

/* Areas of shape functions below this part of the area of the term are zero: corners of 6-node triangles. */
#define CONTACT_NO_SHAPE_AREA 1e-3
/* Facets whose nodes are this part of their size off a plane are flat: meshes are often written with 7 digits. */
#define CONTACT_FLAT 1e-5
/* A plane of symmetry is at zero if it is within this part of the model's size: coordinates of a mesh are rounded. */
#define CONTACT_ROUND 1e-12

/* Nodes outside the window of their penalty, all pairs; -1: no pair has a window. */
static PetscErrorCode CountOutside(Contact contact, PetscInt *outside)
{
  PetscFunctionBeginUser;
  *outside = -1;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactWindow window;

    if (!contact->pairs[p].scene->adjust && !contact->pairs[p].scene->augment) continue;
    PetscCall(ContactPairWindow(contact, p, &window));
    *outside = PetscMax(0, *outside) + window.outside;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Smallest penetration of the loaded terms of all pairs, all ranks; PETSC_MAX_REAL: none is loaded. largest: force of a
   term. */
static PetscErrorCode LeastPenetration(Contact contact, PetscReal largest, PetscReal *least)
{
  PetscFunctionBeginUser;
  *least = PETSC_MAX_REAL;
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n_sides; c++)
      if (pair->now.status[c] == CONTACT_CLOSED && ContactTermForce(pair, c) > PENALTY_LOADED * largest)
        *least = PetscMin(*least, ContactTermOffset(pair, c, pair->t) - pair->now.gap[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, least, 1, MPIU_REAL, MPI_MIN, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Energy that friction has taken so far in all pairs, of all ranks; NaN without friction. */
static PetscErrorCode Dissipated(Contact contact, PetscReal *energy)
{
  PetscFunctionBeginUser;
  *energy = 0;
  for (int p = 0; p < contact->n_pairs; p++) *energy += contact->pairs[p].now.dissipated;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, energy, 1, MPIU_REAL, MPIU_SUM, contact->mesh->comm));
  if (!ContactHasFriction(contact)) *energy = NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Status of a term; of a node, that of the side with the least gap. */
static ContactStatus StatusAt(const ContactPair *pair, const ContactState *state, PetscInt c)
{
  return state->status[c < pair->n_nodes ? ContactNodeTerm(pair, state, c) : c];
}

/* Counts the closed terms from number first to end - 1, each node once, and makes most[2] as large as their largest
   penetration (length) and the largest one over the face size. */
static PetscInt FindDeepest(const ContactPair *pair, PetscInt first, PetscInt end, PetscReal most[2])
{
  PetscInt closed = 0;

  for (PetscInt c = first; c < end; c++) {
    const PetscReal penetration = ContactTermOffset(pair, c, pair->t) - pair->now.gap[c];

    if (c < pair->n_nodes || c >= pair->n_sides) closed += StatusAt(pair, &pair->now, c) == CONTACT_CLOSED;
    if (pair->now.status[c] != CONTACT_CLOSED) continue;
    most[0] = PetscMax(most[0], penetration);
    most[1] = PetscMax(most[1], penetration / pair->size[c]);
  }
  return closed;
}

/*@
  ContactPairPressing - counts what of a pair is in contact: its closed nodes, or its closed faces where no node is
  closed.

  Collective

  Input Parameter:
. pair - the pair, after ContactResidual()

  Output Parameter:
. pressing - the count and the largest penetrations of what is counted, the same on all ranks
@*/
PetscErrorCode ContactPairPressing(const ContactPair *pair, ContactPressing *pressing)
{
  PetscReal most[4] = {0, 0, 0, 0}; /* of nodes and of faces */
  PetscInt  count[2];
  PetscBool faces;

  PetscFunctionBeginUser;
  count[0] = FindDeepest(pair, 0, pair->n_sides, &most[0]);
  count[1] = FindDeepest(pair, pair->n_sides, pair->n, &most[2]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 2, MPIU_INT, MPI_SUM, pair->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 4, MPIU_REAL, MPI_MAX, pair->mesh->comm));
  if (ContactPairPresence(pair, pair->t) < 1) PetscCall(PetscArrayzero(most, 4)); /* what comes or goes is no error */
  faces = (PetscBool)(!count[0] && count[1]);
  *pressing =
    (ContactPressing){.n = count[faces], .faces = faces, .depth = most[2 * faces], .over_h = most[2 * faces + 1]};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSummarise - counts contact and collects penetrations (length), penalties and the total force of all pairs in
  the present state.

  Collective

  Input Parameter:
. contact - the contact, before ContactAccept(): changes count against the accepted state

  Output Parameter:
. summary - the same on all ranks
@*/
PetscErrorCode ContactSummarise(Contact contact, ContactSummary *summary)
{
  PetscInt  count[2] = {0, 0};                              /* nodes that closed, that opened */
  PetscReal most[3]  = {PETSC_MIN_REAL, PETSC_MIN_REAL, 0}; /* -penalty_min, penalty_max, force of a term */
  PetscReal total[3] = {0, 0, 0}, least, dissipated, depth = 0, over_h = 0;
  PetscInt  pressing = 0;
  PetscInt  outside;

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];
    ContactPressing    one;

    PetscCall(ContactPairPressing(pair, &one));
    pressing += one.n;
    depth  = PetscMax(depth, one.depth);
    over_h = PetscMax(over_h, one.over_h);
    for (PetscInt c = 0; c < pair->n_nodes; c++) {
      const ContactStatus now = StatusAt(pair, &pair->now, c), before = StatusAt(pair, &pair->accepted, c);

      count[0] += now == CONTACT_CLOSED && before == CONTACT_OPEN;
      count[1] += now == CONTACT_OPEN && before == CONTACT_CLOSED;
    }
    for (PetscInt c = 0; c < pair->n_sides; c++) {
      most[0] = PetscMax(most[0], -pair->now.penalty[c]);
      most[1] = PetscMax(most[1], pair->now.penalty[c]);
      most[2] = PetscMax(most[2], ContactTermForce(pair, c));
    }
    for (int d = 0; d < 3; d++) total[d] += ContactIsRidge(pair) ? -pair->total[d] : pair->total[d];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 2, MPIU_INT, MPI_SUM, contact->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 3, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, total, 3, MPIU_REAL, MPI_SUM, contact->mesh->comm));
  PetscCall(Dissipated(contact, &dissipated));
  PetscCall(LeastPenetration(contact, most[2], &least));
  PetscCall(CountOutside(contact, &outside));
  *summary = (ContactSummary){.nodes                  = pressing,
                              .in                     = count[0],
                              .out                    = count[1],
                              .max_penetration        = depth,
                              .max_penetration_over_h = over_h,
                              .min_penetration        = least < PETSC_MAX_REAL ? least : 0,
                              .penalty_min            = -most[0],
                              .penalty_max            = most[1],
                              .outside_window         = outside,
                              .dissipated             = dissipated,
                              .force = PetscSqrtReal(PetscSqr(total[0]) + PetscSqr(total[1]) + PetscSqr(total[2]))};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactRoundOff - estimates what rounding of positions leaves of the residual where the penalty is largest: penalty
  times area times machine epsilon times model size.

  Collective

  Input Parameter:
. contact - the contact

  Output Parameter:
. force - the same on all ranks
@*/
PetscErrorCode ContactRoundOff(Contact contact, PetscReal *force)
{
  PetscFunctionBeginUser;
  *force = 0;
  for (int p = 0; p < contact->n_pairs; p++)
    for (PetscInt c = 0; c < contact->pairs[p].n; c++)
      *force = PetscMax(*force, contact->pairs[p].now.penalty[c] * contact->pairs[p].area[c]);
  *force *= PETSC_MACHINE_EPSILON * contact->mesh->size;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, 1, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to the pressures of a pair what its partner's slave points press on the same surface from the other side, as
   forces over the areas of the shape functions. Corners of 6-node triangles have none; there the own side stands for
   both. Where no partner is near there is no direction, and no pressure. */
static PetscErrorCode AddPartner(Contact contact, const ContactPair *pair, const PetscReal *u,
                                 const PetscReal *reaction, PetscReal *pressure)
{
  const int  dim = contact->mesh->dim;
  PetscReal *area;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(contact->mesh->n_nodes, &area));
  PetscCall(SurfaceNodeAreas(pair->slave, pair->geometry, u, area));
  for (PetscInt c = 0; c < pair->n_nodes; c++) {
    const PetscInt  node  = pair->node[c];
    const PetscReal own   = pair->scene->share * pressure[c];
    PetscReal       other = 0;

    for (int d = 0; d < dim; d++)
      other += reaction[node * dim + d] * pair->normal[3 * ContactNodeTerm(pair, &pair->now, c) + d];
    pressure[c] = own + (area[node] > CONTACT_NO_SHAPE_AREA * pair->whole[c] ? other / area[node] : own);
  }
  PetscCall(PetscFree(area));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactNodePressures - finds the pressures of slave nodes that belong to nodal forces.

  Collective

  Input Parameters:
+ contact  - the contact
. p        - number of the pair
. u        - local displacements, u[n_nodes*dim] (length), for present tributary areas; with small kinematics those of
             the reference are taken
. force    - normal force of each slave node of this rank
- reaction - forces of the partner on its master, by node of the mesh, where two pairs treat two surfaces from either
             side; else NULL

  Output Parameters:
+ area     - area[n_nodes] tributary areas of the mesh's nodes
- pressure - of each slave node; where there is a partner, that of both together

  Note:
  It is linear in force and reaction.
@*/
PetscErrorCode ContactNodePressures(Contact contact, int p, const PetscReal *u, const PetscReal *force,
                                    const PetscReal *reaction, PetscReal *area, PetscReal *pressure)
{
  const ContactPair *pair = &contact->pairs[p];

  PetscFunctionBeginUser;
  if (contact->scene->kinematics == KINEMATICS_SMALL) u = NULL;
  if (pair->formulation.surface)
    PetscCall(SlavePointsHatAreas(pair->slaves, pair->geometry, u, area));
  else
    PetscCall(SurfaceNodeAreas(pair->slave, pair->geometry, u, area));
  for (PetscInt c = 0; c < pair->n_nodes; c++) {
    area[pair->node[c]] *= pair->scene->share;
    pressure[c] = force[c] / area[pair->node[c]];
  }
  if (reaction) PetscCall(AddPartner(contact, pair, u, reaction, pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPatchAreas - computes what each slave node of a pair counts in a mean over a round patch, with the functions by
  which its pressure is spread.

  Collective

  Input Parameters:
+ contact - the contact
. p       - number of the pair
. middle  - of the patch, reference coordinates (length)
- radius  - of the patch (length)

  Output Parameter:
. area - area[n_nodes] of the mesh's nodes, see SurfacePatchAreas()
@*/
PetscErrorCode ContactPatchAreas(Contact contact, int p, const PetscReal middle[3], PetscReal radius, PetscReal *area)
{
  const ContactPair *pair = &contact->pairs[p];

  PetscFunctionBeginUser;
  PetscCall(SurfacePatchAreas(pair->slave, pair->geometry, (PetscBool)pair->formulation.surface, middle, radius, area));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactGetNodes - gets what this rank's slave nodes of a pair show: areas, gaps, forces, pressures, normals.

  Collective

  Input Parameters:
+ contact - the contact
. p       - number of the pair
- u       - local displacements, u[n_nodes*dim] (length), for present tributary areas; with small kinematics those of
            the reference are taken

  Output Parameter:
. nodes - arrays of the contact, valid until its next call

  Note:
  Where two pairs treat two surfaces from either side, pressures are those of both together; forces are the pair's own.
@*/
PetscErrorCode ContactGetNodes(Contact contact, int p, const PetscReal *u, ContactNodes *nodes)
{
  ContactPair *pair    = &contact->pairs[p];
  const int    partner = ContactPairPartner(contact, p);
  PetscReal   *area;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(contact->mesh->n_nodes, &area));
  PetscCall(ContactNodePressures(contact, p, u, pair->force, partner >= 0 ? contact->pairs[partner].reaction : NULL,
                                 area, pair->pressure));
  for (PetscInt c = 0; c < pair->n_nodes; c++) {
    const PetscInt term = ContactNodeTerm(pair, &pair->now, c);

    pair->shown_gap[c] = pair->now.gap[term];
    for (int d = 0; d < 3; d++) pair->shown_normal[3 * c + d] = pair->normal[3 * term + d];
  }
  *nodes = (ContactNodes){.n        = pair->n_nodes,
                          .node     = pair->node,
                          .area     = pair->whole,
                          .gap      = pair->shown_gap,
                          .penalty  = pair->now.penalty,
                          .force    = pair->force,
                          .pressure = pair->pressure,
                          .normal   = pair->shown_normal};
  if (pair->friction) PetscCall(FrictionShow(pair, area, nodes));
  PetscCall(PetscFree(area));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactMasterForce - sums the force of a pair on its master in the present state; axisymmetric: over 360 degrees.

  Collective

  Input Parameters:
+ contact - the contact
- p       - number of the pair

  Output Parameter:
. force - the same on all ranks
@*/
PetscErrorCode ContactMasterForce(Contact contact, int p, PetscReal force[3])
{
  const ContactPair *pair = &contact->pairs[p];

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) force[d] = -pair->total[d] + (pair->ridge ? contact->pairs[pair->ridge].total[d] : 0);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, 3, MPIU_REAL, MPI_SUM, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the moment of this rank's normal forces on the slave points of a pair, times a factor. */
static void AddMoment(const ContactPair *pair, PetscReal factor, PetscReal moment[3])
{
  const NeighbourLists lists = pair->lists;
  const int            dim   = pair->mesh->dim;

  for (PetscInt q = 0; q < lists->n_slaves; q++) {
    if (pair->point_force[q] == 0 || pair->variations->first[q] == pair->variations->end[q]) continue;
    for (PetscInt k = lists->slave_ptr[q]; k < lists->slave_ptr[q + 1]; k++) {
      const PetscInt node = lists->slave_node[k];
      PetscReal      x[3] = {0, 0, 0}, force[3] = {0, 0, 0}, part[3];

      for (int d = 0; d < dim; d++) {
        x[d]     = lists->X[node * dim + d] + lists->u[node * dim + d] + pair->mesh->centre[d];
        force[d] = factor * pair->point_force[q] * lists->slave_S[k] * pair->images[lists->slave_side[k]].sign[d] *
                   pair->variations->own[q * dim + d];
      }
      Cross(x, force, part);
      for (int d = 0; d < 3; d++) moment[d] += part[d];
    }
  }
}

/*@
  ContactMasterMoment - sums the moments about the origin of the scene of a pair's forces on its master in the present
  state.

  Collective

  Input Parameters:
+ contact - the contact, in the plane or in space
- p       - number of the pair

  Output Parameter:
. moment - the same on all ranks (force times length); in the plane the third one alone

  Note:
  Normal forces have the lever arms of the slave's nodes that bear them, forces of friction those of their feet.
@*/
PetscErrorCode ContactMasterMoment(Contact contact, int p, PetscReal moment[3])
{
  const ContactPair *pair = &contact->pairs[p];
  ContactFriction    friction;

  PetscFunctionBeginUser;
  moment[0] = moment[1] = moment[2] = 0;
  AddMoment(pair, -1, moment);
  if (pair->ridge) AddMoment(&contact->pairs[pair->ridge], 1, moment);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, moment, 3, MPIU_REAL, MPI_SUM, contact->mesh->comm));
  if (!pair->friction) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactPairFriction(contact, p, &friction));
  for (int d = 0; d < 3; d++) moment[d] += friction.moment[d];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactGapAt - finds the gap of a pair at a slave node (length), the same on all ranks.

  Collective

  Input Parameters:
+ contact - the contact
. p       - number of the pair
. u       - local displacements of the present state, u[n_nodes*dim] (length)
. t       - its load parameter
- node_id - the mesh's number of the node, which does not depend on the ranks

  Output Parameter:
. gap - the state's own gap where there is one; else the signed distance to the whole master without its mirror
        images, SearchDistance(); NaN where the node is none of the slave surface
@*/
PetscErrorCode ContactGapAt(Contact contact, int p, const PetscReal *u, PetscReal t, PetscInt node_id, PetscReal *gap)
{
  Mesh               mesh = contact->mesh;
  const ContactPair *pair = &contact->pairs[p];
  PetscMPIInt        rank;
  PetscReal found[5] = {-1, 0, 0, 0, 0}; /* 1: a node of the slave surface, 2: with a finite gap; gap; position */

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < pair->slave->group->n_nodes; i++) {
    const PetscInt node = pair->slave->group->nodes[i];

    if (mesh->node_id[node] != node_id) continue;
    found[0] = 1;
    for (int d = 0; d < mesh->dim; d++) found[2 + d] = mesh->coords[node * mesh->dim + d] + u[node * mesh->dim + d];
  }
  for (PetscInt c = 0; c < pair->n_nodes; c++) {
    const PetscReal here = pair->now.gap[ContactNodeTerm(pair, &pair->now, c)];

    if (mesh->node_id[pair->node[c]] != node_id || PetscIsNanReal(here)) continue;
    found[0] = 2;
    found[1] = here;
  }
  PetscCall(LargestOfRanks(mesh->comm, found[0], NULL, &rank, NULL));
  PetscCallMPI(MPI_Bcast(found, 5, MPIU_REAL, rank, mesh->comm));
  *gap = found[0] < 0 ? NAN : found[1];
  if (found[0] == 1) PetscCall(SearchDistance(pair->search, u, t, &found[2], gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairPenalty - finds the smallest and the largest penalty of a pair over all ranks (force per length and
  area).

  Collective

  Input Parameters:
+ contact - the contact
- p       - number of the pair

  Output Parameters:
+ least - smallest penalty
- most  - largest penalty
@*/
PetscErrorCode ContactPairPenalty(Contact contact, int p, PetscReal *least, PetscReal *most)
{
  const ContactPair *pair     = &contact->pairs[p];
  PetscReal          range[2] = {PETSC_MIN_REAL, PETSC_MIN_REAL};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) {
    range[0] = PetscMax(range[0], -pair->now.penalty[c]);
    range[1] = PetscMax(range[1], pair->now.penalty[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, range, 2, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  *least = -range[0];
  *most  = range[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairSurface - gets the slave surface of a pair.

  Not collective

  Input Parameters:
+ contact - the contact
- p       - number of the pair

  Output Parameters:
+ slave          - its group, the mesh's
- mean_face_size - mean size of its faces (length)
@*/
PetscErrorCode ContactPairSurface(Contact contact, int p, const MeshGroup **slave, PetscReal *mean_face_size)
{
  PetscFunctionBeginUser;
  *slave          = contact->pairs[p].slave->group;
  *mean_face_size = contact->pairs[p].slave->mean_size;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairToolMoves - says whether the master of a pair is a rigid tool that forces move.

  Not collective

  Input Parameters:
+ contact - the contact
- p       - number of the pair
@*/
PetscBool ContactPairToolMoves(Contact contact, int p)
{
  return (PetscBool)(contact->pairs[p].tool != NULL);
}

/* What is counted of the fits of a pair, so that one sum and one maximum over the ranks complete it. */
typedef struct {
  PetscInt rung[RUNGS + 1]; /* slave points by rung, then those that only facets serve */
  PetscInt points, neighbours;
  PetscInt within,
    within_low; /* not beyond a free edge of the master; of these, those of degree 2 and less where it is not flat */
  PetscReal least_neighbours, least_pivot; /* negative, as a maximum is taken */
  PetscReal most_neighbours, amplified, residual, facets, apart;
} FitTally;

/* Whether a facet turns from the normal by no more than edges may at which fits do not end. */
static PetscBool IsOfSurface(const ContactPair *pair, const Facet *facet, const PetscReal normal[3])
{
  const int dim = pair->lists->dim, corners = ElementGet(facet->type)->corners;
  PetscReal t[2][3] = {{0}, {0, 0, 1}}, n[3];

  for (int k = 0; k < dim - 1; k++) {
    const PetscReal *from = &pair->work->x[facet->nodes[corners == 4 ? k : 0] * dim];
    const PetscReal *to   = &pair->work->x[facet->nodes[corners == 4 ? k + 2 : k + 1] * dim];

    for (int d = 0; d < dim; d++) t[k][d] = to[d] - from[d];
  }
  Cross(t[0], t[1], n);
  return (PetscBool)(PetscAbsReal(Dot(n, normal)) >= PetscCosReal(pair->fit.feature_angle) * PetscSqrtReal(Dot(n, n)));
}

/* Says whether all facets in the list of slave point q that may be one surface with the closest one lie in one plane,
   or on one straight line. The point was just evaluated with the facets, and its positions are still in the work
   space. */
static PetscBool ListIsFlat(const ContactPair *pair, PetscInt q)
{
  NeighbourLists        lists  = pair->lists;
  const SmootherResult *result = &pair->work->result;

  for (PetscInt i = lists->facet_ptr[q]; i < lists->facet_ptr[q + 1]; i++) {
    const Facet *facet = &lists->facet[i];

    if (!IsOfSurface(pair, facet, result->normal)) continue;
    for (int a = 0; a < ElementGet(facet->type)->nodes; a++) {
      const PetscReal *x   = &pair->work->x[facet->nodes[a] * lists->dim];
      PetscReal        off = result->gap;

      for (int d = 0; d < lists->dim; d++) off += result->normal[d] * x[d];
      if (PetscAbsReal(off) > CONTACT_FLAT * lists->facet_size[i]) return PETSC_FALSE;
    }
  }
  return PETSC_TRUE;
}

/* Adds slave point q, which has a master near, to the counts. */
static PetscErrorCode TallyPoint(const ContactPair *pair, PetscInt q, FitTally *tally)
{
  NeighbourLists        lists  = pair->lists;
  const SmootherResult *result = &pair->work->result;
  const int             rung   = lists->fit_n[q] ? lists->rung[q] : RUNGS;
  PetscReal             facets;
  PetscBool             found, within;

  PetscFunctionBeginUser;
  if (lists->rung[q] == RUNG_UNASKED) PetscFunctionReturn(PETSC_SUCCESS);
  tally->points++;
  tally->rung[rung]++;
  PetscCall(ContactPointEvaluate(pair, pair->facets, lists, q, -1, SMOOTHER_GAP, &found));
  facets = result->gap;
  within = found && result->beyond == 0 ? PETSC_TRUE : PETSC_FALSE;
  tally->within += within;
  tally->within_low += within && rung > RUNG_WIDER && !ListIsFlat(pair, q);
  if (!lists->fit_n[q]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactPointEvaluate(pair, pair->smoother, lists, q, -1, SMOOTHER_GAP, &found));
  if (!found || result->facet_served) PetscFunctionReturn(PETSC_SUCCESS);
  tally->neighbours += result->n;
  tally->least_neighbours = PetscMax(tally->least_neighbours, -(PetscReal)result->n);
  tally->most_neighbours  = PetscMax(tally->most_neighbours, (PetscReal)result->n);
  tally->least_pivot      = PetscMax(tally->least_pivot, -lists->pivot[q]);
  tally->amplified        = PetscMax(tally->amplified, lists->amplified[q]);
  tally->residual         = PetscMax(tally->residual, lists->residual[q]);
  if (within) tally->facets = PetscMax(tally->facets, PetscAbsReal(facets - result->gap));
  if (within && PetscAbsReal(facets) < pair->slaves->size[q])
    tally->apart = PetscMax(tally->apart, PetscAbsReal(facets - result->gap) / pair->slaves->size[q]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums and maxima over all ranks. */
static PetscErrorCode TallyReduce(MPI_Comm comm, FitTally *tally)
{
  PetscInt  count[RUNGS + 5];
  PetscReal most[] = {
    tally->least_neighbours, tally->least_pivot, tally->most_neighbours, tally->amplified, tally->residual,
    tally->facets,           tally->apart};

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(count, tally->rung, RUNGS + 1));
  count[RUNGS + 1] = tally->points;
  count[RUNGS + 2] = tally->neighbours;
  count[RUNGS + 3] = tally->within;
  count[RUNGS + 4] = tally->within_low;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, RUNGS + 5, MPIU_INT, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 7, MPIU_REAL, MPI_MAX, comm));
  PetscCall(PetscArraycpy(tally->rung, count, RUNGS + 1));
  tally->points           = count[RUNGS + 1];
  tally->neighbours       = count[RUNGS + 2];
  tally->within           = count[RUNGS + 3];
  tally->within_low       = count[RUNGS + 4];
  tally->least_neighbours = most[0];
  tally->least_pivot      = most[1];
  tally->most_neighbours  = most[2];
  tally->amplified        = most[3];
  tally->residual         = most[4];
  tally->facets           = most[5];
  tally->apart            = most[6];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairFits - counts how the fits of a pair turned out: by rung of the ladder, neighbours, guards, and the two
  errors of the surface.

  Collective

  Input Parameters:
+ contact - the contact
- p       - number of the pair

  Output Parameter:
. fits - the same on all ranks; zeros where the master is not fitted
@*/
PetscErrorCode ContactPairFits(Contact contact, int p, ContactFits *fits)
{
  const ContactPair *pair  = &contact->pairs[p];
  NeighbourLists     lists = pair->lists;
  FitTally           tally = {.least_neighbours = PETSC_MIN_REAL,
                              .most_neighbours  = PETSC_MIN_REAL,
                              .least_pivot      = PETSC_MIN_REAL};
  PetscMPIInt        rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(contact->mesh->comm, &rank));
  for (PetscInt q = 0; q < lists->n_slaves && pair->fit.fitted; q++)
    if (lists->facet_ptr[q] < lists->facet_ptr[q + 1] && SlavePointIsOwn(pair->slaves, q, rank))
      PetscCall(TallyPoint(pair, q, &tally));
  PetscCall(TallyReduce(contact->mesh->comm, &tally));
  *fits = (ContactFits){.points          = tally.points,
                        .within          = tally.within,
                        .within_low      = tally.within_low,
                        .plain           = tally.rung[0],
                        .facets          = tally.rung[RUNGS],
                        .amplified       = tally.amplified,
                        .smoothing_error = tally.residual,
                        .apart_over_h    = tally.apart,
                        .facet_error     = tally.facets};
  for (int r = 1; r < RUNGS; r++)
    *(r <= RUNG_WIDER ? &fits->wider : r <= RUNG_DEGREE_2 ? &fits->degree_2 : &fits->linear) += tally.rung[r];
  if (fits->points > fits->facets) {
    fits->neighbours_min  = (PetscInt)-tally.least_neighbours;
    fits->neighbours_max  = (PetscInt)tally.most_neighbours;
    fits->neighbours_mean = (PetscReal)tally.neighbours / (fits->points - fits->facets);
    fits->pivot           = -tally.least_pivot;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Appends the planes of symmetry that the supports have shown. */
static void AppendPlanes(const ContactPair *pair, char *text, size_t size)
{
  const PetscReal round = CONTACT_ROUND * pair->mesh->size;
  const char     *word  = ", mirrored at";

  for (int bit = 1; bit < pair->n_images && pair->scene->find_symmetry; bit <<= 1) {
    const SurfaceImage *image = &pair->images[bit];
    const size_t        used  = strlen(text);

    for (int d = 0; d < pair->mesh->dim; d++) {
      const PetscReal at = image->shift[d] / 2 + pair->mesh->centre[d];

      if (image->sign[d] > 0 || (pair->geometry == GEOMETRY_AXISYMMETRIC && image->shift[d] == 0 && d == 0)) continue;
      snprintf(text + used, size - used, "%s %c = %g", word, "xyz"[d], PetscAbsReal(at) > round ? (double)at : 0.0);
      word = " and";
    }
  }
}

/*@
  ContactPairText - writes what touches what, and how, such as "plate_bottom on pipe_outer, diffuse, degree 4, support
  3.6, weight 3.5, mirrored at x = 0".

  Not collective

  Input Parameters:
+ contact - the contact
. p       - number of the pair
- size    - characters that the text holds

  Output Parameter:
. text - the caller's buffer; the text is cut where it ends
@*/
PetscErrorCode ContactPairText(Contact contact, int p, char *text, size_t size)
{
  static const char *const shapes[] = {"plane", "cylinder", "sphere"};
  const ContactPair       *pair     = &contact->pairs[p];
  const SceneContact      *scene    = pair->scene;
  const char              *how      = "";

  PetscFunctionBeginUser;
  if (pair->formulation.surface) how = ", surface to surface";
  if (pair->formulation.surface && OffsetsMaps(pair->slave_offsets)) how = ", surface to surface with live offsets";
  if (!pair->master)
    snprintf(text, size, "%s on an analytic %s%s", scene->slave, shapes[scene->analytic.shape], how);
  else if (!pair->fit.fitted)
    snprintf(text, size, "%s on %s, %s%s", scene->slave, scene->master,
             pair->smoother == pair->facets ? "facets" : SmootherNames[scene->smoother], how);
  else
    snprintf(text, size, "%s on %s, %s%s, degree %d, support %g, weight %g", scene->slave, scene->master,
             SmootherNames[scene->smoother], how, pair->fit.degree,
             (double)(pair->fit.integral ? pair->fit.support / pair->master->order : pair->fit.support),
             (double)pair->fit.exponent);
  AppendPlanes(pair, text, size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairTermStiffness - returns the stiffness of one term of a pair at the automatic penalty, in the mean over its
  terms: about that of the elements below one slave node.

  Collective

  Input Parameters:
+ contact - the contact
- pair    - its number

  Output Parameter:
. stiffness - force per length, the same on all ranks
@*/
PetscErrorCode ContactPairTermStiffness(Contact contact, int pair, PetscReal *stiffness)
{
  const ContactPair *p      = &contact->pairs[pair];
  PetscReal          sum[2] = {0, (PetscReal)p->n_nodes};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < p->n_nodes; c++) sum[0] += p->whole[c];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, contact->mesh->comm));
  *stiffness = sum[1] > 0 ? p->automatic * sum[0] / sum[1] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts the nodes of faces around points on edges of a tool that are closed, each with its label. */
static PetscErrorCode AddRidgeClosed(const ContactPair *ridge, const PetscInt *label, PetscInt *closed)
{
  PetscBool *some;
  PetscReal *mine;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(ridge->n, &some));
  PetscCall(PetscCalloc1(ridge->mesh->n_nodes, &mine));
  for (PetscInt c = 0; c < ridge->n; c++) some[c] = (PetscBool)(ridge->now.status[c] == CONTACT_CLOSED);
  PetscCall(ContactRidgeFaces(ridge, some, mine));
  for (PetscInt i = 0; i < ridge->mesh->n_nodes; i++) closed[label[i]] += mine[i] > 0;
  PetscCall(PetscFree(some));
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairClosed - says whether a pair has closed terms at the nodes of some bodies.

  Collective

  Input Parameters:
+ contact - the contact
. pair    - number of the pair
. label   - label[n_nodes] of each local node, from 0 to n - 1
- n       - number of labels

  Output Parameter:
. closed - closed[n]: terms of slave nodes and faces with that label that are closed in the present state, of all
           ranks; of a tool's edge that presses the nodes around it
@*/
PetscErrorCode ContactPairClosed(Contact contact, int pair, const PetscInt *label, PetscInt n, PetscInt *closed)
{
  const ContactPair *p = &contact->pairs[pair];

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(closed, n));
  for (PetscInt c = 0; c < p->n; c++) closed[label[p->node[c]]] += p->now.status[c] == CONTACT_CLOSED;
  if (p->ridge) PetscCall(AddRidgeClosed(&contact->pairs[p->ridge], label, closed));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, closed, (PetscMPIInt)n, MPIU_INT, MPI_SUM, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
