/* Plastic flow in a step: the acceptance of its end, how much flows, and how well the step resolves turns of the flow.

   A step takes one direction for its whole flow. The true direction at its end is on by as much as the flow turns in
   half a step, and the stress lags behind by that angle. From step to step the direction is known: the turn between
   two steps is that between their middles. */
#include "elasticityimpl.h"
#include <math.h>

/* Copies the accepted states of all groups, or returns to a copy. */
static PetscErrorCode CopyStates(Elasticity e, PetscBool save, PetscReal **copy)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < e->n_groups; k++) {
    CellGroup   *g = &e->groups[k];
    const size_t n = (size_t)g->n_batches * KERNEL_LANES * ElasticityCellStates(g);

    if (!g->state) continue;
    if (save) PetscCall(PetscMalloc1(n, &copy[k]));
    PetscCall(save ? PetscArraycpy(copy[k], g->state, n) : PetscArraycpy(g->state, copy[k], n));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeCopies(Elasticity e, PetscReal **copy)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < e->n_groups; k++) PetscCall(PetscFree(copy[k]));
  PetscCall(PetscFree(copy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the plastic state of a group's cells at u the accepted one. */
static PetscErrorCode AcceptGroup(Elasticity e, CellGroup *g, const PetscReal *u)
{
  const size_t dofs = (size_t)g->nodes * e->dim;

  PetscFunctionBeginUser;
  for (PetscInt batch = 0; batch < g->n_batches && g->state; batch++) {
    const size_t first = (size_t)batch * KERNEL_LANES;

    ElasticityGather(e, g, batch, u, e->u);
    ElementAcceptState(&g->kernel, &g->X[first * dofs], e->u, &g->constants[first * g->kernel.n_constants],
                       ElasticityMultipliers(e, g, batch));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Product of two symmetric tensors xx yy zz xy yz xz */
static PetscReal Product(const PetscReal a[6], const PetscReal b[6])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

/* Adds a point that flows. before, now: growth of its plastic strain tensor in the step before and in this one; part:
   of the way between the middles of both steps that lies in this one, 0: that before does not count; growth: of the
   equivalent strain; work: plastic; elastic: strain */
static void AddPoint(const PetscReal before[6], const PetscReal now[6], PetscReal part, PetscReal growth,
                     PetscReal work, PetscReal elastic, PlasticPath *path)
{
  const PetscReal lengths = PetscSqrtReal(Product(before, before) * Product(now, now));

  path->growth = PetscMax(path->growth, growth);
  path->work += work;
  if (part > 0 && lengths > 0) {
    const PetscReal turn = acos(PetscMax(-1, PetscMin(1, Product(before, now) / lengths)));

    path->lag += work * sin(PetscMin(PETSC_PI / 2, part * turn));
  } else if (elastic > 0)
    path->begun += work * growth / elastic;
}

/* Adds what a cell's points of this rank flow from the states `start` to the accepted ones. keep: their growth becomes
   that of the last step. */
static void AddCell(Elasticity e, CellGroup *g, const PetscReal *start, PetscInt slot, PetscReal part, PetscBool keep,
                    PlasticPath *path)
{
  const PetscReal modulus = e->cell_modulus[g->cell[slot]];
  PetscReal       X[MAX_DOFS], volume[ELEMENT_MAX_POINTS];

  ElasticitySlotCoordinates(e, g, slot, X);
  ElementStateVolumes(&g->kernel, X, volume);
  for (int p = 0; p < ElementStatePoints(&g->kernel); p++) {
    PetscReal *flow   = &g->flow[(slot * ElementStatePoints(&g->kernel) + p) * PLASTIC_FLOW];
    PetscReal  growth = ElasticityPointStrain(g, g->state, slot, p) - ElasticityPointStrain(g, start, slot, p);
    PetscReal  from[PLASTIC_FLOW], now[PLASTIC_FLOW] = {0}, work;

    if (growth > 0) {
      ElasticityPointTensor(g, start, slot, p, from);
      ElasticityPointTensor(g, g->state, slot, p, now);
      for (int k = 0; k < PLASTIC_FLOW; k++) now[k] -= from[k];
      work = ElasticityPointWork(g, g->state, slot, p) - ElasticityPointWork(g, start, slot, p);
      AddPoint(flow, now, part, growth, volume[p] * work, work / (growth * modulus), path);
    }
    for (int k = 0; k < PLASTIC_FLOW && keep; k++) flow[k] = now[k];
  }
}

/* Accepts the states at (u, t), and sums up over this rank what flowed from those before, which are in start. */
static PetscErrorCode Flow(Elasticity e, const PetscReal *u, PetscReal t, PetscReal *const start[], PetscBool keep,
                           PlasticPath *path)
{
  const PetscReal dt = t - e->accepted_t, part = e->flow_dt > 0 && dt > 0 ? dt / (dt + e->flow_dt) : 0;

  PetscFunctionBeginUser;
  *path = (PlasticPath){0};
  ElasticitySetTime(e, t);
  for (int k = 0; k < e->n_groups; k++) {
    CellGroup *g = &e->groups[k];

    PetscCall(AcceptGroup(e, g, u));
    for (PetscInt slot = 0; slot < g->n_cells && g->flow; slot++) AddCell(e, g, start[k], slot, part, keep, path);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityAcceptPlastic - makes the plastic state at given displacements the accepted one, from which all others
start.

  Not collective

  Input Parameters:
+ e - the elasticity
. u - local displacements (length) [n_nodes*dim] of a state that is accepted
- t - its time

  Output Parameter:
. path - the flow of this rank's quadrature points since the state before, see ElasticityPlasticPath()

  Note:
  Residual, tangent and energy at u and t stay the same, up to round-off. Nothing happens where no body is plastic.
@*/
PetscErrorCode ElasticityAcceptPlastic(Elasticity e, const PetscReal *u, PetscReal t, PlasticPath *path)
{
  PetscReal **start;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(e->n_groups, &start));
  PetscCall(CopyStates(e, PETSC_TRUE, start));
  PetscCall(Flow(e, u, t, start, PETSC_TRUE, path));
  PetscCall(FreeCopies(e, start));
  e->flow_dt    = t - e->accepted_t;
  e->accepted_t = t;
  ElasticitySetTime(e, t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityForgetFlow - tells that the last step says nothing of the direction of the next flow, as the load turns.

  Not collective

  Input Parameter:
. e - the elasticity
@*/
void ElasticityForgetFlow(Elasticity e)
{
  e->flow_dt = 0;
}

/*@
  ElasticityPlasticPath - says what a step from the accepted state makes of plastic flow.

  Collective

  Input Parameters:
+ e - the elasticity
. u - local displacements (length) [n_nodes*dim]
- t - load parameter at u

  Output Parameter:
. path - over all quadrature points of all ranks but those of routines of users

  Notes:
  The accepted state stays what it is. The lag of a point is the sine of the angle by which its flow turns in half a
  step, from the growth of its plastic strain in this step and in the one before. The sum weighs it with the plastic
  work. Points that begin to flow have no lag that is known.
@*/
PetscErrorCode ElasticityPlasticPath(Elasticity e, const PetscReal *u, PetscReal t, PlasticPath *path)
{
  PetscReal **start, sum[3];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(e->n_groups, &start));
  PetscCall(CopyStates(e, PETSC_TRUE, start));
  PetscCall(Flow(e, u, t, start, PETSC_FALSE, path));
  PetscCall(CopyStates(e, PETSC_FALSE, start));
  PetscCall(FreeCopies(e, start));
  sum[0] = path->work;
  sum[1] = path->lag;
  sum[2] = path->begun;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &path->growth, 1, MPIU_REAL, MPI_MAX, e->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, e->mesh->comm));
  path->work  = sum[0];
  path->lag   = sum[1];
  path->begun = sum[2];
  PetscFunctionReturn(PETSC_SUCCESS);
}
