/* What tools do to the bodies from outside, and what contact itself stores, for the balance of energies. */
#include "contactimpl.h"
#include "base/vectors.h"
#include "kernels/rigidkernel.h"

/*@
  ContactPairMotion - returns the motion of the tool that is the master of a pair, where all of it is prescribed.

  Not collective

  Input Parameters:
+ contact - the contact
- p       - number of the pair

  Note:
  NULL: the master is no tool, or does not move, or has free motions. The forces on a tool of the last kind are in the
  residual.
@*/
const Motion *ContactPairMotion(Contact contact, int p)
{
  const ContactPair *pair   = &contact->pairs[p];
  const Motion      *motion = NULL;

  if (pair->tool) return NULL;
  if (!pair->master) motion = &pair->scene->motion;
  if (pair->master && pair->master->rigid) motion = &contact->scene->bodies[pair->master->body].motion;
  return motion && motion->n ? motion : NULL;
}

/* Adds the forces that hold the tool of a pair to out, by components of its motion. values: forces over the contact
   nodes, subtracted as external ones are. Contact does not change when slave and tool move together as one rigid body,
   so that the slave nodes tell everything. */
void ContactPairHold(Contact contact, const ContactPair *pair, PetscReal t, const PetscReal *values, PetscReal *out)
{
  const Motion *motion =
    ContactPairMotion(contact, ContactIsRidge(pair) ? pair->tool_pair : (int)(pair - contact->pairs));
  const NeighbourLists lists = pair->lists;
  const int            dim   = contact->mesh->dim;
  PetscReal            q[MOTION_COMPONENTS], point[3], moment[3] = {0, 0, 0};
  double               spin[3][3];

  if (!motion) return;
  MotionComponents(motion, t, q);
  MotionPlace(motion, t, motion->point, point);
  RigidTurnRate(&q[3], spin);
  for (PetscInt i = 0; i < lists->n_deformable; i++) {
    PetscReal arm[3] = {0, 0, 0}, force[3] = {0, 0, 0}, part[3];

    for (int d = 0; d < dim; d++) {
      arm[d]   = lists->X[i * dim + d] + lists->u[i * dim + d] + contact->mesh->centre[d] - point[d];
      force[d] = -values[i * dim + d];
      out[d] += force[d];
    }
    Cross(arm, force, part);
    for (int d = 0; d < 3; d++) moment[d] += part[d];
  }
  for (int k = 0; k < 3; k++)
    for (int d = 0; d < 3; d++) out[3 + k] += spin[k][d] * moment[d];
}

/*@
  ContactWatchTools - from now on adds the forces that hold the tools with prescribed motions to an array.

  Not collective

  Input Parameters:
+ contact - the contact
- hold    - hold[n_pairs*MOTION_COMPONENTS], to which ContactResidual() adds this rank's part of the force and moment
            that drive the tool of each pair, by components of its motion; borrowed. NULL ends it
@*/
void ContactWatchTools(Contact contact, PetscReal *hold)
{
  contact->hold = hold;
}

/* Energies of a pair on this rank */
typedef struct {
  PetscReal stored, given;
  PetscReal lets_go, touches; /* parts of given where the whole pair is open at the end of the step, at its start */
  PetscReal pressed[2];       /* terms that press: in the accepted state, now */
  PetscReal far;              /* terms that press now and were too far away in the accepted state to have a gap there */
} PairEnergy;

/* Adds those of a term's normal pressure. Between the accepted state and the present one the trapezoidal rule gives
   contact the work (p_0 + p_1) (gap_0 - gap_1)/2. With p = penalty (onset - gap), this is the growth of p^2/(2 penalty)
   less what the changes of onset and penalty give. Where the whole pair is open at one end of the step, it is less the
   force at the other end over half of the opening, too, through which nothing presses; other terms take or leave the
   force of a single one. A multiplier presses without a penetration: its part is in neither. */
static void AddPressure(const ContactPair *pair, PetscInt c, PetscReal t_0, PairEnergy *energy)
{
  const ContactState *accepted = &pair->accepted;
  const LawState      now      = ContactTermState(pair, c, pair->t, ContactTermMost(pair, c));
  const LawState      before   = ContactTermStateIn(pair, c, accepted, t_0, PETSC_MAX_REAL);
  LawValue            value, then = {0, 0, 0};
  PetscReal           area, held, gap;

  ContactTermLaw(pair, c, pair->t, &value, &gap, &area);
  if (PetscIsNanReal(gap)) return;
  if (!PetscIsNanReal(accepted->gap[c]) && ContactPairPresence(pair, t_0) > 0)
    pair->law->evaluate(accepted->gap[c], &before, &then);
  held = PetscSqr(PetscMax(now.multiplier, 0)) / (2 * now.penalty);
  if (value.pressure > 0) energy->stored += area * (value.psi - held);
  energy->far += PetscIsNanReal(accepted->gap[c]) && value.pressure > 0;
  if (PetscIsNanReal(accepted->gap[c])) return;
  energy->pressed[0] += then.pressure > 0;
  energy->pressed[1] += value.pressure > 0;
  if (!(value.pressure > 0)) energy->lets_go += area * then.pressure / 2 * (gap - LawOnsetGap(&now));
  if (!(then.pressure > 0)) energy->touches -= area * value.pressure / 2 * (accepted->gap[c] - LawOnsetGap(&before));
  if (!(value.pressure > 0 && then.pressure > 0)) return;
  energy->given += area * (value.pressure + then.pressure) / 2 * (LawOnsetGap(&now) - LawOnsetGap(&before));
  energy->given += area * value.pressure * then.pressure / 2 * (1 / before.penalty - 1 / now.penalty);
  energy->given -= area * (held - PetscSqr(PetscMax(before.multiplier, 0)) / (2 * before.penalty));
}

/* Adds to what touches the part of a term that was too far away in the accepted state to have a gap there: its opening
   then follows from the way of the nodes since. */
static PetscErrorCode AddFar(const ContactPair *pair, PetscInt c, PetscReal t_0, const PetscReal *way,
                             PairEnergy *energy)
{
  const LawState before = ContactTermStateIn(pair, c, &pair->accepted, t_0, PETSC_MAX_REAL);
  LawValue       value;
  PetscReal      area, gap, part, closed = 0;

  PetscFunctionBeginUser;
  ContactTermLaw(pair, c, pair->t, &value, &gap, &area);
  if (!PetscIsNanReal(pair->accepted.gap[c]) || !(value.pressure > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt q = pair->term_point[k];

    if (PetscIsNanReal(pair->point_gap[q])) continue;
    PetscCall(ContactVariationsAlong(pair, q, way, &part));
    closed -= pair->term_weight[k] * pair->factor[q] * part;
  }
  energy->touches -= value.pressure / 2 * (closed + area * (gap - LawOnsetGap(&before)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds what AddFar() does for all terms of a pair. The part of this rank is in energy->touches alone. */
static PetscErrorCode PairAddFar(Contact contact, ContactPair *pair, PetscReal t_0, const PetscReal *du,
                                 PairEnergy *energy)
{
  PetscReal *way;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(pair->lists->n_nodes * contact->mesh->dim, &way));
  PetscCall(ContactPairMove(contact, pair, du, t_0, pair->t, way));
  for (PetscInt c = 0; c < pair->n; c++) PetscCall(AddFar(pair, c, t_0, way, energy));
  PetscCall(PetscFree(way));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds those of a term's elastic slip, which begins a step as what the accepted penalty made of it. The tractions less
   their multipliers are stored. A multiplier takes energy along the elastic slip. */
static void AddElasticSlip(const ContactPair *pair, PetscInt c, PairEnergy *energy)
{
  const PetscReal *held_before = &pair->accepted.grip[3 * c], *held = &pair->now.grip[3 * c];
  const PetscReal  stiffness = pair->friction->stiffness, stick = pair->friction->automatic * pair->accepted.stick;
  PetscReal        area = 0, square = 0, product = 0, taken = 0;

  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++)
    if (FrictionTermTakes(pair, k)) area += pair->term_weight[k] * pair->factor[pair->term_point[k]];
  for (int d = 0; d < 3; d++) {
    const PetscReal before = pair->accepted.traction[3 * c + d] - held_before[d];
    const PetscReal now    = pair->now.traction[3 * c + d] - held[d];

    square += PetscSqr(now);
    product += before * now;
    taken += (held_before[d] + held[d]) / 2 * (now - before) / stiffness;
  }
  energy->given -= area * taken;
  energy->stored += area * square / (2 * stiffness);
  if (pair->scene->stick_slip == 0) energy->given += area * product / 2 * (1 / stick - 1 / stiffness);
}

/*@
  ContactStored - computes what contact stores in the state of the last residual, and what it was given since the
  accepted one without any motion: by overlaps that grow over t, and by penalties that change.

  Collective

  Input Parameters:
+ contact - the contact, after ContactResidual() with forces and before ContactAccept()
. t_0     - load parameter of the accepted state
. du      - local displacements since then, du[n_nodes*dim] (length)
- moved   - bodies were moved since then, so that its gaps are not those at which the step began

  Output Parameters:
+ stored - energy in penetrations and elastic slip, the same on all ranks
- given  - energy, the same on all ranks; what the trapezoidal rule counts for forces through the opening of a pair that
           lets go or touches is taken out of it

  Note:
  Where a penalty is raised, bodies that overlapped are pushed apart by twice the energy that the penetrations lose.
@*/
PetscErrorCode ContactStored(Contact contact, PetscReal t_0, const PetscReal *du, PetscBool moved, PetscReal *stored,
                             PetscReal *given)
{
  PetscFunctionBeginUser;
  *stored = *given = 0;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair   = &contact->pairs[p];
    PairEnergy   energy = {.stored = 0}, far = {.stored = 0};

    for (PetscInt c = 0; c < pair->n; c++) {
      AddPressure(pair, c, t_0, &energy);
      if (pair->friction) AddElasticSlip(pair, c, &energy);
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &energy, sizeof(energy) / sizeof(PetscReal), MPIU_REAL, MPI_SUM,
                               contact->mesh->comm));
    *stored += energy.stored;
    *given += energy.given;
    if (energy.pressed[1] == 0) *given += energy.lets_go;
    if (energy.pressed[0] > 0 || moved) continue;
    if (energy.far > 0) PetscCall(PairAddFar(contact, pair, t_0, du, &far));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &far.touches, 1, MPIU_REAL, MPI_SUM, contact->mesh->comm));
    *given += energy.touches + far.touches;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
