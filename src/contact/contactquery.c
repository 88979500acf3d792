#include "contactimpl.h"
#include "penaltylaw.h"

/* Nodes outside the window of their penalty, all pairs; -1: no pair has one. */
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

/* ContactSummarise - counts, penetrations (lengths), penalties and total force of all pairs in the present state, the
   same on all ranks.

   Collective. in and out count against the accepted state: to be called before ContactAccept(). */
PetscErrorCode ContactSummarise(Contact contact, ContactSummary *summary)
{
  PetscInt  count[3] = {0, 0, 0};
  PetscReal most[5] = {0, 0, PETSC_MIN_REAL, PETSC_MIN_REAL, 0}, total[3] = {0, 0, 0},
            least = PETSC_MAX_REAL; /* most: penetration, over h, -penalty_min, penalty_max, force of a term */
  PetscInt outside;

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++) {
      const PetscReal penetration =
        pair->now.status[c] == CONTACT_CLOSED ? ContactTermOffset(pair, c, pair->t) - pair->now.gap[c] : 0;

      count[0] += pair->now.status[c] == CONTACT_CLOSED;
      count[1] += pair->now.status[c] == CONTACT_CLOSED && pair->accepted.status[c] == CONTACT_OPEN;
      count[2] += pair->now.status[c] == CONTACT_OPEN && pair->accepted.status[c] == CONTACT_CLOSED;
      most[0] = PetscMax(most[0], penetration);
      most[1] = PetscMax(most[1], penetration / pair->size[c]);
      most[2] = PetscMax(most[2], -pair->now.penalty[c]);
      most[3] = PetscMax(most[3], pair->now.penalty[c]);
      most[4] = PetscMax(most[4], ContactTermForce(pair, c));
    }
    for (int d = 0; d < 3; d++) total[d] += pair->total[d];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 3, MPIU_INT, MPI_SUM, contact->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 5, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, total, 3, MPIU_REAL, MPI_SUM, contact->mesh->comm));
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++)
      if (pair->now.status[c] == CONTACT_CLOSED && ContactTermForce(pair, c) > PENALTY_LOADED * most[4])
        least = PetscMin(least, ContactTermOffset(pair, c, pair->t) - pair->now.gap[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPIU_REAL, MPI_MIN, contact->mesh->comm));
  PetscCall(CountOutside(contact, &outside));
  *summary = (ContactSummary){.nodes                  = count[0],
                              .in                     = count[1],
                              .out                    = count[2],
                              .max_penetration        = most[0],
                              .max_penetration_over_h = most[1],
                              .min_penetration        = count[0] && least < PETSC_MAX_REAL ? least : 0,
                              .penalty_min            = -most[2],
                              .penalty_max            = most[3],
                              .outside_window         = outside,
                              .force = PetscSqrtReal(PetscSqr(total[0]) + PetscSqr(total[1]) + PetscSqr(total[2]))};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactRoundOff - what rounding of positions leaves of the residual where the penalty is largest: penalty times area
   times machine epsilon times model size.

   Collective. *force: the same on all ranks. */
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

/* ContactGetNodes - what this rank's slave nodes of pair p show: areas, gaps, forces, pressures, normals.

   Collective. u[n_nodes*dim]: local displacements (length), for the current tributary areas (finite kinematics; else
   the reference's). The arrays belong to the contact and stand until its next call. */
PetscErrorCode ContactGetNodes(Contact contact, int p, const PetscReal *u, ContactNodes *nodes)
{
  ContactPair *pair = &contact->pairs[p];
  PetscReal   *area;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(contact->mesh->n_nodes, &area));
  if (contact->scene->kinematics == KINEMATICS_SMALL) u = NULL;
  if (pair->formulation.surface)
    PetscCall(SlavePointsHatAreas(pair->slaves, pair->geometry, u, area));
  else
    PetscCall(SurfaceNodeAreas(pair->slave, pair->geometry, u, area, NULL));
  for (PetscInt c = 0; c < pair->n; c++) pair->pressure[c] = pair->force[c] / area[pair->node[c]];
  PetscCall(PetscFree(area));
  *nodes = (ContactNodes){pair->n,           pair->node,  pair->area,     pair->now.gap,
                          pair->now.penalty, pair->force, pair->pressure, pair->normal};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactMasterForce - total force of pair p on its master in the present state, the same on all ranks; axisymmetric:
   over 360 degrees.

   Collective. */
PetscErrorCode ContactMasterForce(Contact contact, int p, PetscReal force[3])
{
  const ContactPair *pair = &contact->pairs[p];

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) force[d] = -pair->total[d];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, 3, MPIU_REAL, MPI_SUM, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactGapAt - gap (length) of pair p at a slave node, the same on all ranks.

   Collective. u[n_nodes*dim], t: the present state; node_id: the mesh's rank-independent number. The state's own gap
   where there is one; else the signed distance to the whole master without its mirror images (SearchDistance()). NaN:
   no node of the slave surface. */
PetscErrorCode ContactGapAt(Contact contact, int p, const PetscReal *u, PetscReal t, PetscInt node_id, PetscReal *gap)
{
  Mesh               mesh = contact->mesh;
  const ContactPair *pair = &contact->pairs[p];
  PetscReal found[5]      = {-1, 0, 0, 0, 0}; /* 1: a node of the slave surface, 2: with a finite gap; gap; position */

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < pair->slave->group->n_nodes; i++) {
    const PetscInt node = pair->slave->group->nodes[i];

    if (mesh->node_id[node] != node_id) continue;
    found[0] = 1;
    for (int d = 0; d < mesh->dim; d++) found[2 + d] = mesh->coords[node * mesh->dim + d] + u[node * mesh->dim + d];
  }
  for (PetscInt c = 0; c < pair->n; c++) {
    if (mesh->node_id[pair->node[c]] != node_id || PetscIsNanReal(pair->now.gap[c])) continue;
    found[0] = 2;
    found[1] = pair->now.gap[c];
  }
  {
    struct {
      double found;
      int    rank;
    } mine = {found[0], 0}, best;

    PetscCallMPI(MPI_Comm_rank(mesh->comm, &mine.rank));
    PetscCallMPI(MPI_Allreduce(&mine, &best, 1, MPI_DOUBLE_INT, MPI_MAXLOC, mesh->comm));
    PetscCallMPI(MPI_Bcast(found, 5, MPIU_REAL, best.rank, mesh->comm));
  }
  *gap = found[0] < 0 ? NAN : found[1];
  if (found[0] == 1) PetscCall(SearchDistance(pair->search, u, t, &found[2], gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactPairPenalty - smallest and largest penalty (force per length and area) of pair p over all ranks. Collective.
 */
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

/* ContactPairSurface - the group of the slave surface of pair p (the mesh's) and its mean face size (length). Not
 * collective. */
PetscErrorCode ContactPairSurface(Contact contact, int p, const MeshGroup **slave, PetscReal *mean_face_size)
{
  PetscFunctionBeginUser;
  *slave          = contact->pairs[p].slave->group;
  *mean_face_size = contact->pairs[p].slave->mean_size;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactPairFits - how the fits of a pair stand: counts by rung, neighbours, guards, and the two errors of the
 * surface. Collective. */
PetscErrorCode ContactPairFits(Contact contact, int p, ContactFits *fits)
{
  ContactPair   *pair             = &contact->pairs[p];
  NeighbourLists lists            = pair->lists;
  PetscInt       count[RUNGS + 3] = {0}; /* by rung, facets, points, neighbours */
  PetscReal      most[6]          = {PETSC_MIN_REAL,
                                     PETSC_MIN_REAL,
                                     PETSC_MIN_REAL,
                                     0,
                                     0,
                                     0}; /* -fewest, most neighbours, -pivot, Lambda, smoothing, facets */
  PetscMPIInt    rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(contact->mesh->comm, &rank));
  for (PetscInt q = 0; q < lists->n_slaves; q++) {
    PetscReal gap;
    PetscBool found;

    if (!pair->fit.fitted || lists->facet_ptr[q] == lists->facet_ptr[q + 1] || !SlavePointIsOwn(pair->slaves, q, rank))
      continue;
    count[RUNGS + 1]++;
    count[lists->fit_n[q] ? lists->rung[q] : RUNGS]++;
    if (!lists->fit_n[q]) continue;
    PetscCall(ContactPointEvaluate(pair, pair->smoother, lists, q, -1, SMOOTHER_GAP, &found));
    if (!found || pair->work->result.facet_served) continue;
    gap = pair->work->result.gap;
    count[RUNGS + 2] += pair->work->result.n;
    most[0] = PetscMax(most[0], -(PetscReal)pair->work->result.n);
    most[1] = PetscMax(most[1], (PetscReal)pair->work->result.n);
    most[2] = PetscMax(most[2], -lists->pivot[q]);
    most[3] = PetscMax(most[3], lists->amplified[q]);
    most[4] = PetscMax(most[4], lists->residual[q]);
    PetscCall(ContactPointEvaluate(pair, pair->facets, lists, q, -1, SMOOTHER_GAP, &found));
    if (pair->work->result.beyond == 0) most[5] = PetscMax(most[5], PetscAbsReal(pair->work->result.gap - gap));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, RUNGS + 3, MPIU_INT, MPI_SUM, contact->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 6, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  *fits = (ContactFits){.points          = count[RUNGS + 1],
                        .plain           = count[0],
                        .facets          = count[RUNGS],
                        .amplified       = most[3],
                        .smoothing_error = most[4],
                        .facet_error     = most[5]};
  for (int r = 1; r < RUNGS; r++)
    *(r <= RUNG_WIDER ? &fits->wider : r <= RUNG_DEGREE_2 ? &fits->degree_2 : &fits->linear) += count[r];
  if (fits->points > fits->facets) {
    fits->neighbours_min  = (PetscInt)-most[0];
    fits->neighbours_max  = (PetscInt)most[1];
    fits->neighbours_mean = (PetscReal)count[RUNGS + 2] / (fits->points - fits->facets);
    fits->pivot           = -most[2];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairText - writes what touches what, and how, into the caller's buffer, such as "plate_bottom on pipe_outer,
  diffuse, degree 4, support 3.6, weight 3.5".

  Not collective

  Input Parameters:
+ contact - the contact
. p       - number of the pair
- size    - characters that the buffer holds

  Output Parameter:
. text - the text, cut where the buffer ends
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
  PetscFunctionReturn(PETSC_SUCCESS);
}
