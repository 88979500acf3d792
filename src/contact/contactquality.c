/* How well the surfaces of the pairs lie on each other: overlaps before any load, gaps and penetrations, nodes that
   both surfaces have. */
#include "contactimpl.h"
#include "base/complaint.h"
#include "base/refusal.h"
#include "mesh/meshdofs.h"

/* Gaps below this part of a face size are round-off of coordinates and projections. */
#define QUALITY_ROUND_OFF 1e-9
/* Expressions of overlap and friction are evaluated at the ends of this many intervals of the load parameter before the
   run, so that a value that is not finite is mostly found then. */
enum { QUALITY_SAMPLES = 16 };

/* Finds the node whose value is the largest of all ranks; of nodes that differ by round-off it is the one of lowest
   tag. value[c] is of each term, NaN where it has none; a face stands for its first node. Tag -1: no term has any. */
static PetscErrorCode FindPlace(Mesh mesh, const ContactPair *pair, const PetscReal value[], PetscReal largest,
                                ContactPlace *place)
{
  PetscReal X[3] = {PETSC_MIN_REAL, PETSC_MIN_REAL, PETSC_MIN_REAL};
  PetscInt  tag = PETSC_MAX_INT, at = -1;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) {
    if (!(value[c] >= largest - QUALITY_ROUND_OFF * pair->slave->mean_size) || ContactTermTag(pair, c) >= tag) continue;
    at  = c;
    tag = ContactTermTag(pair, c);
  }
  PetscCallMPI(MPI_Allreduce(&tag, &place->tag, 1, MPIU_INT, MPI_MIN, mesh->comm));
  if (tag == place->tag && at >= 0) ContactTermPlace(pair, at, X);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, X, 3, MPIU_REAL, MPIU_MAX, mesh->comm));
  if (place->tag == PETSC_MAX_INT) place->tag = -1;
  for (int d = 0; d < 3; d++) place->X[d] = place->tag >= 0 ? X[d] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Distance of a slave point from its face (length): the offset that brings it onto the surface through the nodes around
   it. Where the curvature jumps, at the end of a radius, that surface swings by as much. */
static PetscReal PointOffset(const ContactPair *pair, PetscInt q)
{
  const int dim = pair->lists->dim;
  PetscReal on_face[3], sum = 0;

  SlavePointsPosition(pair->slaves, q, on_face);
  for (int d = 0; d < dim; d++)
    sum += PetscSqr(pair->lists->slave_X[q * dim + d] + pair->lists->slave_u[q * dim + d] - on_face[d]);
  return PetscSqrtReal(sum);
}

/* Overlap before any load that the surfaces' own shapes explain (length): the facets' sagitta, the offsets of the slave
   points, and the distance between the master's facets and its smooth surface. */
static PetscErrorCode TermOverlapExplained(const ContactPair *pair, PetscInt c, PetscReal *explained)
{
  PetscReal apart = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1] && pair->fit.fitted; k++) {
    const PetscInt q = pair->term_point[k];
    PetscBool      found;

    if (PetscIsNanReal(pair->point_gap[q])) continue;
    apart = PetscMax(apart, PointOffset(pair, q));
    if (!pair->lists->fit_n[q]) continue;
    apart = PetscMax(apart, pair->lists->residual[q]);
    PetscCall(ContactPointEvaluate(pair, pair->facets, pair->lists, q, -1, SMOOTHER_GAP, &found));
    if (found) apart = PetscMax(apart, PetscAbsReal(pair->work->result.gap - pair->point_gap[q]));
  }
  *explained = ContactTouchTolerance(pair, c) + apart;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairGaps - measures how the surfaces of a pair lie to each other in the present state; offsets (g_0) do not
  count.

  Collective

  Input Parameters:
+ contact - the contact, after ContactResidual(); meant for the state before any load
- p       - number of the pair

  Output Parameter:
. gaps - counts, gaps and overlaps
@*/
PetscErrorCode ContactPairGaps(Contact contact, int p, ContactGaps *gaps)
{
  const ContactPair *pair     = &contact->pairs[p];
  PetscInt           count[4] = {pair->n_nodes, 0, 0, 0};
  PetscReal          range[2] = {PETSC_MIN_REAL, PETSC_MIN_REAL}, area = 0, *depth; /* -least, most */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(pair->n, &depth));
  for (PetscInt c = pair->n_nodes; c < pair->n; c++) depth[c] = NAN;
  for (PetscInt c = 0; c < pair->n_nodes; c++) {
    const PetscInt  term = ContactNodeTerm(pair, &pair->now, c);
    const PetscReal here = pair->now.gap[term],
                    gap  = PetscAbsReal(here) <= QUALITY_ROUND_OFF * pair->size[c] ? 0 : here;

    PetscReal explained;

    depth[c] = -gap;
    if (PetscIsNanReal(gap)) continue;
    if (gap < 0) PetscCall(TermOverlapExplained(pair, term, &explained));
    count[1]++;
    count[2] += gap < 0;
    count[3] += gap < 0 && gap < -explained;
    if (gap < 0) area += pair->area[term];
    range[1] = PetscMax(range[1], gap);
    range[0] = PetscMax(range[0], -gap);
  }
  *gaps = (ContactGaps){.least = 0};
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 4, MPIU_INT, MPI_SUM, contact->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, range, 2, MPIU_REAL, MPIU_MAX, contact->mesh->comm));
  PetscCall(FindPlace(contact->mesh, pair, depth, range[0], &gaps->deepest));
  PetscCall(PetscFree(depth));
  PetscCallMPI(MPI_Allreduce(&area, &gaps->area, 1, MPIU_REAL, MPIU_SUM, contact->mesh->comm));
  gaps->nodes       = count[0];
  gaps->near        = count[1];
  gaps->overlapping = count[2];
  gaps->refused     = count[3];
  gaps->least       = count[1] ? -range[0] : 0;
  gaps->most        = count[1] ? range[1] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far first-order facets lie off the curved surface whose normals turn as theirs do: this rank's sum, and its
   number of slave points. */
static void SumSagitta(const ContactPair *pair, PetscMPIInt rank, PetscReal sum[2])
{
  if (!pair->master || pair->master->order > 1) return;
  for (PetscInt q = 0; q < pair->lists->n_slaves; q++) {
    if (pair->lists->facet_ptr[q] == pair->lists->facet_ptr[q + 1] || !SlavePointIsOwn(pair->slaves, q, rank)) continue;
    sum[0] += pair->lists->kappa[q] * PetscSqr(pair->master->mean_size) / 8;
    sum[1]++;
  }
}

/* Counts this rank's slave points near the master, and those of them that do not face it. */
static void CountAverse(const ContactPair *pair, PetscMPIInt rank, PetscInt count[2])
{
  const NeighbourLists lists = pair->lists;

  for (PetscInt q = 0; q < lists->n_slaves && pair->master; q++) {
    if (!SlavePointIsOwn(pair->slaves, q, rank)) continue;
    count[0] += lists->averse[q] || lists->facet_ptr[q] < lists->facet_ptr[q + 1];
    count[1] += lists->averse[q];
  }
}

/* Counts this rank's slave points past a free edge of the master that have lost half of their area for their depth. */
static PetscErrorCode CountHanging(const ContactPair *pair, PetscMPIInt rank, PetscInt *hanging)
{
  const NeighbourLists lists = pair->lists;

  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < lists->n_slaves && pair->master; q++) {
    const SmootherResult *result = &pair->work->result;
    PetscBool             found;

    if (!SlavePointIsOwn(pair->slaves, q, rank) || lists->share[q] == 0) continue;
    PetscCall(ContactPointEvaluate(pair, pair->facets, lists, q, lists->nearest[q], SMOOTHER_GAP, &found));
    if (found && result->beyond > 0 && -result->gap > NEIGHBOUR_LISTS_DEEP / 2 * pair->slaves->size[q]) (*hanging)++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts the points on edges of the tool that press, and takes their penetrations where they are deeper. */
static PetscErrorCode AddRidgeQuality(const ContactPair *ridge, ContactPressing *pressing, ContactQuality *quality)
{
  ContactPressing edges;
  PetscReal      *depth;

  PetscFunctionBeginUser;
  PetscCall(ContactPairPressing(ridge, &edges));
  quality->nodes += edges.n;
  quality->edges = edges.n;
  if (!pressing->n) quality->faces = PETSC_FALSE;
  PetscCall(PetscMalloc1(ridge->n, &depth));
  for (PetscInt c = 0; c < ridge->n; c++)
    depth[c] = ridge->now.status[c] == CONTACT_CLOSED ? ContactTermOffset(ridge, c, ridge->t) - ridge->now.gap[c] : NAN;
  if (edges.depth > pressing->depth) PetscCall(FindPlace(ridge->mesh, ridge, depth, edges.depth, &quality->deepest));
  PetscCall(PetscFree(depth));
  pressing->depth  = PetscMax(pressing->depth, edges.depth);
  pressing->over_h = PetscMax(pressing->over_h, edges.over_h);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairQuality - measures the penetrations of a pair in the present state, against the size of its faces and
  against what facets leave out.

  Collective

  Input Parameters:
+ contact - the contact, after ContactResidual()
- p       - number of the pair

  Output Parameter:
. quality - penetrations, sagitta of the facets, slave points that take no part
@*/
PetscErrorCode ContactPairQuality(Contact contact, int p, ContactQuality *quality)
{
  const ContactPair *pair     = &contact->pairs[p];
  PetscInt           count[3] = {0, 0, 0}; /* points near, averse, hanging */
  ContactPressing    pressing;
  PetscMPIInt        rank;
  PetscReal          sum[2] = {0, 0}, *depth;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(pair->n, &depth));
  PetscCall(ContactPairPressing(pair, &pressing));
  for (PetscInt c = 0; c < pair->n; c++) {
    const PetscBool counts = (PetscBool)((c >= pair->n_sides) == pressing.faces);

    depth[c] =
      counts && pair->now.status[c] == CONTACT_CLOSED ? ContactTermOffset(pair, c, pair->t) - pair->now.gap[c] : NAN;
  }
  PetscCallMPI(MPI_Comm_rank(contact->mesh->comm, &rank));
  SumSagitta(pair, rank, sum);
  CountAverse(pair, rank, count);
  PetscCall(CountHanging(pair, rank, &count[2]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 3, MPIU_INT, MPI_SUM, contact->mesh->comm));
  *quality = (ContactQuality){.nodes   = pressing.n,
                              .faces   = pressing.faces,
                              .near    = count[0],
                              .averse  = count[1],
                              .hanging = count[2]};
  if (pair->master) quality->turned = pair->master->turned;
  PetscCall(FindPlace(contact->mesh, pair, depth, pressing.depth, &quality->deepest));
  PetscCall(PetscFree(depth));
  if (pair->ridge) PetscCall(AddRidgeQuality(&contact->pairs[pair->ridge], &pressing, quality));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPIU_SUM, contact->mesh->comm));
  quality->max_penetration        = pressing.depth;
  quality->max_penetration_over_h = pressing.over_h;
  quality->sagitta                = sum[1] > 0 ? sum[0] / sum[1] : 0;
  if (quality->sagitta <= QUALITY_ROUND_OFF * pair->slave->mean_size) quality->sagitta = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairDistance - computes the distance between slave and master of a pair, whichever way their normals point.

  Collective

  Input Parameters:
+ contact - the contact
. p       - number of the pair
. u       - local displacements of the present state, u[n_nodes*dim] (length), ghosts included
- t       - its load parameter

  Output Parameter:
. distance - the distance (length), the same on all ranks

  Note:
  It searches the whole surfaces, and is meant for a pair that never met.
@*/
PetscErrorCode ContactPairDistance(Contact contact, int p, const PetscReal *u, PetscReal t, PetscReal *distance)
{
  const ContactPair *pair = &contact->pairs[p];

  PetscFunctionBeginUser;
  if (pair->master) {
    PetscCall(SearchLeastDistance(pair->search, u, t, distance));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  *distance = PETSC_MAX_REAL;
  for (PetscInt q = 0; q < pair->lists->n_slaves; q++) {
    PetscBool found;

    PetscCall(ContactPointEvaluate(pair, pair->facets, pair->lists, q, -1, SMOOTHER_GAP, &found));
    if (found) *distance = PetscMin(*distance, PetscAbsReal(pair->work->result.gap));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, distance, 1, MPIU_REAL, MPI_MIN, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairJoined - counts the slave nodes of a pair that are nodes of its master as well, where the surfaces are
  one and never part; none where a list of surfaces has a body meet itself.

  Collective

  Input Parameters:
+ contact - the contact
- p       - number of the pair

  Output Parameters:
+ nodes - their number
- place - one of them, where there is any
@*/
PetscErrorCode ContactPairJoined(Contact contact, int p, PetscInt *nodes, ContactPlace *place)
{
  const ContactPair *pair = &contact->pairs[p];
  Mesh               mesh = contact->mesh;
  PetscReal         *of_master, *joined;

  PetscFunctionBeginUser;
  *nodes = 0;
  if (!pair->master || pair->master->rigid || pair->one_body) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(mesh->n_nodes, &of_master, pair->n, &joined));
  PetscCall(PetscArrayzero(of_master, mesh->n_nodes));
  for (PetscInt f = 0; f < pair->master->n_faces; f++) {
    const Facet *face = &pair->master->faces[f];

    for (int i = 0; i < ElementGet(face->type)->nodes; i++) of_master[face->nodes[i]] = 1;
  }
  PetscCall(MeshSumNodes(mesh, 1, of_master));
  for (PetscInt c = 0; c < pair->n_nodes; c++) {
    joined[c] = of_master[pair->node[c]] > 0 ? 1 : NAN;
    *nodes += of_master[pair->node[c]] > 0;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, nodes, 1, MPIU_INT, MPI_SUM, mesh->comm));
  PetscCall(FindPlace(mesh, pair, joined, 1, place));
  PetscCall(PetscFree2(of_master, joined));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactNodeGap - returns the smallest gap of a local node among all pairs that it is a slave of, in the present
  state (length).

  Not collective

  Input Parameters:
+ contact - the contact
- node    - local node

  Note:
  NaN: the node is no slave, no master is near, or it is another rank's.
@*/
PetscReal ContactNodeGap(Contact contact, PetscInt node)
{
  PetscReal gap = NAN;

  for (int p = 0; p < contact->n_scene; p++)
    for (PetscInt c = 0; c < contact->pairs[p].n_nodes; c++)
      if (contact->pairs[p].node[c] == node) gap = fmin(gap, contact->pairs[p].now.gap[c]);
  return gap;
}

/* Refuses a pair in which no master face looks towards any slave node: a surface turned inside out, or the wrong one.
   Surfaces of a list need not look at each other: they are all paired, whether they can meet or not. */
static PetscErrorCode PairCheckFacing(Contact contact, const ContactPair *pair)
{
  Mesh       mesh = contact->mesh;
  PetscReal *area, *normal;
  PetscBool  facing;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(mesh->n_nodes, &area, 3 * mesh->n_nodes, &normal));
  PetscCall(SurfaceNodeNormals(pair->slave, NULL, area, normal));
  PetscCall(SurfaceFaces(pair->master, pair->n_nodes, pair->node, normal, &facing));
  PetscCall(PetscFree2(area, normal));
  if (!facing) {
    PetscCall(RefuseInput(mesh->comm,
                          "%s: contact '%s': no face of '%s' faces '%s', their outward normals point the same way; "
                          "allowed: surfaces that look at each other "
                          "(name the other side of a body, or set master_normal: auto for a rigid tool)",
                          SceneWhere(contact->scene, pair->scene->path, "master"), pair->scene->name,
                          pair->scene->master, pair->scene->slave));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Added overlap (length) or coefficient of friction at a slave node. */
typedef PetscReal (*ValueAtNode)(const ContactPair *, PetscInt c, PetscReal t);

/* The expression itself: where it is below 0 it counts as 0, and so would what is no number. */
static PetscReal CoefficientAtNode(const ContactPair *pair, PetscInt c, PetscReal t)
{
  PetscReal X[3];

  MeshNodePlace(pair->mesh, pair->node[c], X);
  return ExpressionValue(pair->scene->mu_expression, X, t);
}

/* Refuses an expression that is not finite at a node of the slave, between t = 0 and t = 1. */
static PetscErrorCode PairCheckFinite(Contact contact, const ContactPair *pair, const char *key, ValueAtNode value)
{
  Complaint complaint = {""};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n_nodes; c++) {
    for (int k = 0; k <= QUALITY_SAMPLES; k++) {
      const PetscReal t = (PetscReal)k / QUALITY_SAMPLES;

      if (PetscIsInfOrNanReal(value(pair, c, t)))
        Complain(&complaint,
                 "%s: the expression has no finite value at node %" PetscInt_FMT
                 " at t = %g; allowed: an expression that is finite on the slave",
                 SceneWhere(contact->scene, pair->scene->path, key), ContactTermTag(pair, c), (double)t);
    }
  }
  PetscCall(ComplaintRefuse(contact->mesh->comm, &complaint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses values of a pair that are not finite. */
static PetscErrorCode PairCheckValues(Contact contact, const ContactPair *pair)
{
  PetscFunctionBeginUser;
  if (pair->scene->overlap_expression)
    PetscCall(PairCheckFinite(contact, pair, "initial_overlap.add", ContactTermAddedOverlap));
  if (pair->scene->mu_expression) PetscCall(PairCheckFinite(contact, pair, "friction.mu", CoefficientAtNode));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactTakeOverlap - treats surfaces that overlap before any load as the scene asks for.

  Collective

  Input Parameter:
. contact - the contact, after ContactResidual() with forces at the undeformed state

  Note:
  With initial_overlap: refuse, it refuses the deepest overlap of each pair that is more than the surfaces' own
  shapes explain, sagitta of facets and error of fits; the message names pair, node and depth. It also refuses added
  overlaps and coefficients of friction that are not finite. With ramp and ignore it keeps the overlaps as g_0.
@*/
PetscErrorCode ContactTakeOverlap(Contact contact)
{
  Mesh mesh = contact->mesh;

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair  = &contact->pairs[p];
    PetscReal    worst = 0, explained;
    PetscInt     at    = -1;
    struct {
      double gap;
      int    rank;
    } mine = {0, 0}, least;
    char complaint[512];

    if (pair->master && !pair->scene->listed && !ContactIsRidge(pair)) PetscCall(PairCheckFacing(contact, pair));
    PetscCall(PairCheckValues(contact, pair));
    if (!ContactIsRidge(pair)) PetscCall(ContactRefuseImmersed(contact, p));
    for (PetscInt c = 0; c < pair->n; c++) {
      if (pair->scene->initial_overlap == OVERLAP_RAMP || pair->scene->initial_overlap == OVERLAP_IGNORE)
        pair->now.offset[c] = pair->now.gap[c] < 0 ? pair->now.gap[c] : 0;
      if (pair->scene->initial_overlap != OVERLAP_REFUSE && pair->scene->initial_overlap != OVERLAP_ADD) continue;
      if (!(pair->now.gap[c] < 0) || pair->now.gap[c] >= worst) continue;
      PetscCall(TermOverlapExplained(pair, c, &explained));
      if (pair->now.gap[c] >= -explained - ContactEndDepth(pair, c)) continue;
      worst = pair->now.gap[c];
      at    = c;
    }
    mine.gap = worst;
    PetscCallMPI(MPI_Comm_rank(mesh->comm, &mine.rank));
    PetscCallMPI(MPI_Allreduce(&mine, &least, 1, MPI_DOUBLE_INT, MPI_MINLOC, mesh->comm));
    if (at >= 0) {
      PetscCall(PetscSNPrintf(complaint, sizeof(complaint),
                              "%s: contact '%s': slave node %" PetscInt_FMT
                              " lies %g behind the master before any load; allowed: surfaces that touch or are apart, "
                              "or initial_overlap: resolve, ramp or ignore",
                              SceneWhere(contact->scene, pair->scene->path, "initial_overlap"), pair->scene->name,
                              ContactTermTag(pair, at), (double)-worst));
    }
    PetscCall(RefuseInputAnywhere(mesh->comm, at >= 0 && least.rank == mine.rank ? complaint : NULL));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
