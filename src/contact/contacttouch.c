/* Contact along a load step: when open slave nodes will touch, and how many changed their status. */
#include "contactimpl.h"
#include "base/gathertable.h"

/* Gaps up to this part of the face size are no gaps: the node touches already, and no load step makes it touch later.
 */
#define CONTACT_RESTING 1e-9

/* What is known of the slave points at one time: gaps by the pair's smoother and by its facets (NaN: no master is
   near), and whether the gap is that of a fit. */
typedef struct {
  PetscReal *gap, *facet; /* by the pair's smoother; by facets */
  PetscBool *fitted;
} Distances;

/* Measures all slave points of a pair at (u, t). */
static PetscErrorCode PairMeasure(ContactPair *pair, const PetscReal *u, PetscReal t, Distances *out)
{
  const PetscInt n = pair->lists->n_slaves;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &out->gap, n, &out->facet, n, &out->fitted));
  PetscCall(NeighbourListsUpdate(pair->search, pair->lists, u, t, NULL));
  pair->projected = PETSC_FALSE; /* the last projection was elsewhere */
  for (PetscInt q = 0; q < n; q++) {
    PetscBool found;

    out->gap[q] = out->facet[q] = NAN;
    out->fitted[q]              = PETSC_FALSE;
    if (pair->factor[q] == 0) continue;
    PetscCall(ContactPointEvaluate(pair, pair->smoother, pair->lists, q, -1, SMOOTHER_GAP, &found));
    if (!found) continue;
    out->gap[q]    = pair->work->result.gap;
    out->fitted[q] = (PetscBool)(pair->fit.fitted && !pair->work->result.facet_served);
    if (!pair->fit.fitted) continue;
    PetscCall(ContactPointEvaluate(pair, pair->facets, pair->lists, q, -1, SMOOTHER_GAP, &found));
    if (found) out->facet[q] = pair->work->result.gap;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DistancesDestroy(Distances *d)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(d->gap, d->facet, d->fitted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Weighted gaps of a term at both times, from the points that are known at both. A point that is fitted at only one
   of them is measured to the facets at both, because fit and facets lie apart and their difference is no approach.
   NaN: there is no such point. */
static void TermGaps(const ContactPair *pair, PetscInt c, const Distances *before, const Distances *after,
                     PetscReal gap[2])
{
  PetscReal area = 0;

  gap[0] = gap[1] = 0;
  for (PetscInt i = pair->term_ptr[c]; i < pair->term_ptr[c + 1]; i++) {
    const PetscInt  q    = pair->term_point[i];
    const PetscBool same = (PetscBool)(before->fitted[q] == after->fitted[q]);
    const PetscReal g[2] = {same ? before->gap[q] : before->facet[q], same ? after->gap[q] : after->facet[q]};

    if (PetscIsNanReal(g[0]) || PetscIsNanReal(g[1])) continue;
    area += pair->term_weight[i] * pair->factor[q];
    for (int k = 0; k < 2; k++) gap[k] += pair->term_weight[i] * pair->factor[q] * g[k];
  }
  for (int k = 0; k < 2; k++) gap[k] = area > 0 ? gap[k] / area : NAN;
}

/* Room for the touches of all pairs on this rank, three columns each. */
static PetscErrorCode TouchStepRows(Contact contact, PetscReal **rows)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) n += contact->pairs[p].n_sides;
  PetscCall(PetscMalloc1(3 * n, rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Number of the node of a term, or of the point on an edge of a tool, the same on any ranks. */
static PetscInt NodeId(const ContactPair *pair, PetscInt c)
{
  return ContactOnTool(pair) ? pair->node[c] : pair->mesh->node_id[pair->node[c]];
}

/*@
  ContactTouches - finds when the open slave nodes will touch, beta_k, if all goes on as from (u_0, t_0) to (u, t).

  Collective

  Input Parameters:
+ contact    - the contact
. u_0        - local displacements at the start, u_0[n_nodes*dim] (length), within the reach of the present lists
. t_0        - load parameter at the start
. u          - local displacements at the end, likewise
. t          - load parameter at the end
. by_area    - a node weighs its reference area; else it weighs 1
- still_open - only nodes that are open at (u, t) are listed

  Output Parameters:
+ n     - number of touches
- touch - the touches of all ranks, sorted, the same on all ranks; to be freed with PetscFree()

  Note:
  Source: Chamoret et al. (2004), eqs 17 and 18.
@*/
PetscErrorCode ContactTouches(Contact contact, const PetscReal *u_0, PetscReal t_0, const PetscReal *u, PetscReal t,
                              PetscBool by_area, PetscBool still_open, int *n, Touch **touch)
{
  PetscReal  *rows;
  PetscInt    count = 0;
  GatherTable table;

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_touch, 0, 0, 0, 0));
  PetscCall(TouchStepRows(contact, &rows));
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];
    Distances    before, after;

    PetscCall(PairMeasure(pair, u_0, t_0, &before));
    PetscCall(PairMeasure(pair, u, t, &after));
    for (PetscInt c = 0; c < pair->n_sides; c++) {
      PetscReal gap[2], beta;

      TermGaps(pair, c, &before, &after, gap);
      gap[0] -= ContactTermOnsetGap(pair, c, t_0);
      gap[1] -= ContactTermOnsetGap(pair, c, t);
      beta = TouchStepBeta(gap[0], gap[1], CONTACT_RESTING * pair->size[c]);
      if (PetscIsNanReal(beta) || (still_open && !(gap[1] > 0))) continue;
      rows[3 * count]     = beta;
      rows[3 * count + 1] = (PetscReal)NodeId(pair, c) * contact->n_pairs + p;
      rows[3 * count + 2] = by_area ? pair->area[c] : 1;
      count++;
    }
    PetscCall(DistancesDestroy(&before));
    PetscCall(DistancesDestroy(&after));
  }
  PetscCall(GatherTableCreate(contact->mesh->comm, 3, count, rows, &table));
  PetscCall(PetscMalloc1(table.n, touch));
  for (PetscInt i = 0; i < table.n; i++)
    (*touch)[i] = (Touch){table.row[3 * i], table.row[3 * i + 1], table.row[3 * i + 2]};
  *n = (int)table.n;
  PetscCall(GatherTableDestroy(&table));
  PetscCall(PetscFree(rows));
  PetscCall(PetscLogEventEnd(contact->event_touch, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactChanges - sums how much came into contact or left it since the accepted state.

  Collective

  Input Parameters:
+ contact - the contact
. t_0     - load parameter of the accepted state
- by_area - sums reference areas; else numbers of nodes

  Output Parameters:
+ changed - the sum over nodes whose status is another one
- all     - the sum over all slave nodes

  Note:
  A node that touched already is no change, as no load step makes it touch later.
@*/
PetscErrorCode ContactChanges(Contact contact, PetscReal t_0, PetscBool by_area, PetscReal *changed, PetscReal *all)
{
  PetscReal sum[2] = {0, 0};

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n_sides; c++) {
      const PetscReal weight = by_area ? pair->area[c] : 1,
                      gap    = pair->accepted.gap[c] - ContactTermOffset(pair, c, t_0);
      const PetscBool resting =
        (PetscBool)(pair->accepted.status[c] == CONTACT_OPEN && gap <= CONTACT_RESTING * pair->size[c]);

      sum[1] += weight;
      if (pair->now.status[c] != pair->accepted.status[c] && !resting) sum[0] += weight;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, contact->mesh->comm));
  *changed = sum[0];
  *all     = sum[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}
