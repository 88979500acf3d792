/* The error that penetration leaves in forces, pressures and displacements, and what is done about it.

   A quantity q depends on the factor s on all penalties like q(s) = q_0 (1 - c / s) once the penalties are stiff. Then
   its error q_0 - q is dq/d(ln s). One linear solve with the tangent gives du/d(ln s), because the residual depends on
   ln s through the penalty part of the contact forces alone. The derivatives of forces and pressures follow from it by
   their first variations (contact/contactcompliance.c). Nothing is compared over a finite step, in which what
   penetrates is so small that rounding of positions would show.

   The penalty of what sticks leaves an error in the same way: surfaces that stick give way by an elastic slip, as they
   give way by penetrations. Its estimate is the same with tractions of friction where it sticks in the place of the
   contact forces. What has slipped is free of it. */
#include "mesh/pressurenodes.h"
#include "modelimpl.h"

/* Penalties that the run may choose are made stiffer where an estimate is above this. */
#define PENALTY_ERROR_LARGE 0.004
/* The mean pressure may have so many times the error. Where the slave's nodes are denser than the master's, pressures
   scatter, and stiffer penalties let them scatter more; where a bent ring closes on a shaft, soft ones spread by a
   third too far what bears at a few places. The largest pressure does not count. */
#define PENALTY_ERROR_PRESSURE 10
/* Where the scene asks for an accuracy, it is at most this part of the allowed error: the rest is for the mesh. */
#define PENALTY_ERROR_SHARE 0.3
/* They are made so stiff that this part of it is to be expected. */
#define PENALTY_ERROR_WANTED 0.5
/* Close to the threshold the factor rises from 1, by this part of itself for each part of the estimate: an estimate
   that rounding moves over the threshold, on other ranks, then hardly changes the answer. */
#define PENALTY_RISE 6
/* They are made stiffer by at most this factor at a time. An estimate that asks for more is beyond the range in which
   the error is proportional to the compliance. */
#define PENALTY_MOST_STIFFER 30
/* A raise of the penalties by a factor is to lower the estimate by that factor. A raise that brings less than this
   power of it has not brought what it was made for: what is left does not come from the penalty, or it is at a few
   terms that hardly have an area, such as those over the end of a surface. The pair is then stiffened no more. */
#define PENALTY_GAIN 0.5
/* In any step, penalties that the run may choose are made stiffer where a node stands deeper in a face than this part
   of what the certificate allows. They are made so stiff that the second part is to be expected. */
#define PENALTY_DEEP    0.6
#define PENALTY_SHALLOW 0.2
/* A pair whose depth a raise has hardly lowered is raised for it again where it is so many times as deep. */
#define PENALTY_DEEPER 2
/* A pair whose forces are below this part of those of the most loaded pair does not stiffen its penalty, because its
   own error hardly counts in the model. Its errors are measured by this part of the forces and pressures there. */
#define PENALTY_LIGHT_PAIR 1e-3
/* Friction below this part of the pressure's forces is measured by this part of them: its own error hardly counts. */
#define PENALTY_LIGHT_FRICTION 0.02

/* Raises are judged by source, those for the depth of nodes by one source more. */
enum { BY_DEPTH = PENALTY_SOURCES, PENALTY_JUDGED };

/* No estimate */
static const PenaltyError unknown =
  {.force = NAN, .pressure = NAN, .peak = NAN, .displacement = NAN, .slip_force = NAN, .slip_displacement = NAN};

/* Makes room for the estimates; none is known yet. */
PetscErrorCode ModelCreatePenaltyError(Model model)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(ContactPairs(model->contact), &model->work->penalty_error));
  PetscCall(PetscCalloc3(PENALTY_JUDGED * ContactPairs(model->contact), &model->work->stiffened_at,
                         PENALTY_JUDGED * ContactPairs(model->contact), &model->work->stiffened_by,
                         PENALTY_JUDGED * ContactPairs(model->contact), &model->work->accepted_stays));
  ModelForgetPenaltyError(model, PETSC_TRUE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Begins a solve without estimates. anew: the load is at its end or at a state that the scene asks for. Penalties may
   be raised there, too, that stay because a raise in a step before has brought too little, and for the error of
   pressures, on which the way to other states does not depend. */
void ModelForgetPenaltyError(Model model, PetscBool anew)
{
  const int n = ContactPairs(model->contact);

  model->work->weighs_pressure = anew;
  for (int k = 0; k < PENALTY_JUDGED * n; k++) {
    model->work->stiffened_at[k] = 0;
    model->work->stiffened_by[k] = anew ? 0 : model->work->accepted_stays[k];
  }
  for (int p = 0; p < n; p++) model->work->penalty_error[p] = unknown;
}

/* Accepts which penalties stay as they are. */
void ModelAcceptPenaltyError(Model model)
{
  for (int k = 0; k < PENALTY_JUDGED * ContactPairs(model->contact); k++)
    model->work->accepted_stays[k] = PetscMin(0, model->work->stiffened_by[k]);
}

/* Saves or loads the estimates with the model. */
PetscErrorCode ModelArchivePenaltyError(Model model, Archive archive)
{
  const int n = ContactPairs(model->contact);

  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(
    ArchiveReals(archive, "model/penalty_error", PENALTY_ERROR_VALUES * n, &model->work->penalty_error[0].force));
  PetscCall(ArchiveReals(archive, "model/penalty_stiffened", PENALTY_JUDGED * n, model->work->stiffened_by));
  PetscCall(ArchiveReals(archive, "model/penalty_stays", PENALTY_JUDGED * n, model->work->accepted_stays));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelPenaltyError - returns the error that penetration leaves in a pair, as estimated.

  Not collective

  Input Parameters:
+ model - the model
- pair  - number of the pair

  Note:
  The values are NaN where no estimate was made in the last step; at the end of the load one is made.
@*/
PenaltyError ModelPenaltyError(Model model, int pair)
{
  return model->work->penalty_error[pair];
}

/*@
  ModelPenaltyStays - says whether stiffer penalties have not lowered the error that is estimated for a pair.

  Not collective

  Input Parameters:
+ model - the model
- pair  - number of the pair

  Note:
  The last solve has made them stiffer, and the estimate fell by much less than was forecast, or there was no solution.
@*/
PetscBool ModelPenaltyStays(Model model, int pair)
{
  return (PetscBool)(model->work->stiffened_by[pair] < 0);
}

/* Makes a pair's penalties stiffer in the present state. The last tangent is not that of the new ones. */
static PetscErrorCode StiffenPair(Model model, PenaltySource source, int p, PetscReal factor)
{
  PetscFunctionBeginUser;
  PetscCall(VecDestroy(&model->work->tangent_x));
  PetscCall((source == BY_SLIP ? ContactStiffenStick : ContactStiffen)(model->contact, p, factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes penalties stiffer by the factors of ModelStiffen() or ModelStiffenDeep(). */
PetscErrorCode ModelRaise(Model model, const PetscReal factor[])
{
  const int pairs = ContactPairs(model->contact);

  PetscFunctionBeginUser;
  for (int k = 0; k < PENALTY_SOURCES * pairs; k++)
    if (factor[k] != 1) PetscCall(StiffenPair(model, (PenaltySource)(k / pairs), k % pairs, factor[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes back what ModelRaise() has done, as no solution was found with penalties that are factor[] times as stiff.
   forecast: the raise was for an estimate, which judges it. */
PetscErrorCode ModelUnstiffen(Model model, const PetscReal factor[], PetscBool forecast)
{
  const int pairs = ContactPairs(model->contact);

  PetscFunctionBeginUser;
  for (int source = 0; source < PENALTY_SOURCES; source++)
    for (int p = 0; p < pairs; p++) {
      const int k = source * pairs + p;

      if (factor[k] == 1) continue;
      PetscCall(StiffenPair(model, (PenaltySource)source, p, 1 / factor[k]));
      if (forecast)
        model->work->stiffened_by[k] = -factor[k];
      else if (source == BY_PENETRATION)
        model->work->stiffened_by[BY_DEPTH * pairs + p] = 0; /* nothing has been raised that could be judged */
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* -dR/d(ln s) of the free residual at the trial state, which is that of the last residual. */
static PetscErrorCode ModelStifferForces(Model model, PenaltySource source, Vec forces)
{
  PetscReal *f;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(model->mesh->n_nodes * model->mesh->dim, &f));
  PetscCall(ContactStifferForces(model->contact, source, f));
  PetscCall(MeshLocalToGlobal(model->mesh, f, forces));
  PetscCall(VecScale(forces, -1));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The sum of such forces of the pressures of all pairs, each times the part of the compliance that is lost where
   penalties become factor[] times as stiff. */
static PetscErrorCode ModelRaisedForces(Model model, const PetscReal factor[], Vec forces)
{
  const int      pairs = ContactPairs(model->contact);
  const PetscInt n     = model->mesh->n_nodes * model->mesh->dim;
  PetscReal     *f, *sum;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n, &f, n, &sum));
  for (int p = 0; p < pairs; p++) {
    if (factor[p] == 1) continue;
    PetscCall(PetscArrayzero(f, n));
    PetscCall(ContactPairStifferForces(model->contact, p, BY_PENETRATION, f));
    for (PetscInt i = 0; i < n; i++) sum[i] += (1 - 1 / factor[p]) * f[i];
  }
  PetscCall(MeshLocalToGlobal(model->mesh, sum, forces));
  PetscCall(VecScale(forces, -1));
  PetscCall(PetscFree2(f, sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* du/d(ln s) of the free displacements at the trial state, for each source that the scene has. *known: the linear
   solves succeeded. */
static PetscErrorCode ModelPenaltySlopes(Model model, int sources, Vec slope[], PetscBool *known)
{
  Vec forces;
  KSP ksp;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(model->x, &forces));
  PetscCall(ModelLinearise(model, &ksp));
  PetscCall(ModelReleaseTangent(model));
  *known = PETSC_TRUE;
  PetscCall(LinearSolverSetPrediction(model->work->solver, PETSC_TRUE)); /* small changes of large stiff forces */
  for (int source = 0; source < sources && *known; source++) {
    PetscCall(ModelStifferForces(model, (PenaltySource)source, forces));
    PetscCall(KSPSolve(ksp, forces, slope[source]));
    *known = (PetscBool)!LinearCheckLost(model->linear);
    if (*known) PetscCall(ModelHeldOut(model, slope[source]));
  }
  PetscCall(LinearSolverSetPrediction(model->work->solver, PETSC_FALSE));
  PetscCall(VecDestroy(&forces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What two pairs press together that treat two surfaces from either side, and how that changes. Friction acts on the
   slave, which is the other one's master. */
static void JoinLoads(const ContactLoad load[2], const ContactLoad rise[2], ContactLoad *joint, ContactLoad *joint_rise)
{
  const int larger    = load[1].peak > load[0].peak;
  PetscReal moment[2] = {0, 0}; /* of forces times pressures, and its change */

  for (int k = 0; k < 2; k++) {
    moment[0] += load[k].force * load[k].pressure;
    moment[1] += rise[k].force * load[k].pressure + load[k].force * rise[k].pressure;
  }
  *joint      = (ContactLoad){.force = load[0].force + load[1].force,
                              .peak  = load[larger].peak,
                              .rubs  = load[0].rubs + load[1].rubs};
  *joint_rise = (ContactLoad){.force = rise[0].force + rise[1].force, .peak = rise[larger].peak};
  if (joint->force > 0) {
    joint->pressure      = moment[0] / joint->force;
    joint_rise->pressure = (moment[1] - joint->pressure * joint_rise->force) / joint->force;
  }
  for (int d = 0; d < 3; d++) {
    joint->friction[d]      = load[0].friction[d] - load[1].friction[d];
    joint_rise->friction[d] = rise[0].friction[d] - rise[1].friction[d];
  }
}

/* How each pair presses in the present state, and how that changes by rise[], which may be NULL. Two pairs that treat
   two surfaces from either side share the load between them, and stiffer penalties shift it. Both get what they press
   together. */
static PetscErrorCode ModelLoads(Model model, ContactLoad load[], ContactLoad rise[])
{
  const int pairs = ContactPairs(model->contact);

  PetscFunctionBeginUser;
  for (int p = 0; p < pairs; p++) PetscCall(ContactPairLoad(model->contact, p, model->problem->trial, &load[p]));
  for (int p = 0; p < pairs; p++) {
    const int         q    = ContactPairPartner(model->contact, p);
    const ContactLoad none = {.force = 0};

    if (q <= p) continue;
    JoinLoads((ContactLoad[]){load[p], load[q]}, (ContactLoad[]){rise ? rise[p] : none, rise ? rise[q] : none},
              &load[p], rise ? &rise[p] : &(ContactLoad){.force = 0});
    load[q] = load[p];
    if (rise) rise[q] = rise[p];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest entries of the local displacements and of their slope v, of all ranks: the second over the first. */
static PetscErrorCode ModelLargestChange(Model model, const PetscReal *v, PetscReal *part)
{
  const PetscReal *u       = model->problem->trial;
  PetscReal        most[2] = {0, 0};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->mesh->n_nodes * model->mesh->dim; i++) {
    if (IsPressureNode(model->mesh, i / model->mesh->dim)) continue;
    most[0] = PetscMax(most[0], PetscAbsReal(u[i]));
    most[1] = PetscMax(most[1], PetscAbsReal(v[i]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPIU_MAX, model->mesh->comm));
  *part = most[0] > 0 ? most[1] / most[0] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What errors are measured by at least: small parts of the largest force and pressures of all pairs. */
static ContactLoad LeastLoad(int pairs, const ContactLoad load[])
{
  ContactLoad least = {.force = 0};

  for (int p = 0; p < pairs; p++) {
    least.force    = PetscMax(least.force, PENALTY_LIGHT_PAIR * load[p].force);
    least.pressure = PetscMax(least.pressure, PENALTY_LIGHT_PAIR * load[p].pressure);
    least.peak     = PetscMax(least.peak, PENALTY_LIGHT_PAIR * load[p].peak);
  }
  return least;
}

/* Change of a value as a part of the value, or of the least one that counts. */
static PetscReal PartChanged(PetscReal now, PetscReal least, PetscReal rise)
{
  const PetscReal by = PetscMax(now, least);

  return now > 0 && by > 0 ? PetscAbsReal(rise) / by : 0;
}

/* Change of a pair's friction as a part of the whole of it. Friction that is light beside the pressure, or that cancels
   out, is measured by the pressure, and all of it by no less than the least force. */
static PetscReal FrictionChanged(const ContactLoad *now, const ContactLoad *least, const ContactLoad *rise)
{
  const PetscReal whole  = PetscMax(now->rubs, PetscMax(PENALTY_LIGHT_FRICTION * now->force, least->force));
  PetscReal       change = 0;

  for (int d = 0; d < 3; d++) change += PetscSqr(rise->friction[d]);
  return whole > 0 ? PetscSqrtReal(change) / whole : 0;
}

/* Fills the estimates of a pair from its loads and their changes by stiffer penalties. */
static void FillError(PenaltySource source, const ContactLoad *now, const ContactLoad *least, const ContactLoad *rise,
                      PetscReal displacement, PenaltyError *error)
{
  const PetscReal force = PartChanged(now->force, least->force, rise->force);

  if (source == BY_SLIP) {
    error->slip_force        = PetscMax(force, FrictionChanged(now, least, rise));
    error->slip_displacement = displacement;
    return;
  }
  error->force        = force;
  error->pressure     = PartChanged(now->pressure, least->pressure, rise->pressure);
  error->peak         = PartChanged(now->peak, least->peak, rise->peak);
  error->displacement = displacement;
}

/* Estimates the errors of all pairs from the slope of the free displacements at the trial state. */
static PetscErrorCode ModelFillErrors(Model model, PenaltySource source, Vec slope)
{
  const int    pairs = ContactPairs(model->contact);
  ContactLoad *load, least;
  PetscReal   *v, displacement = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(model->mesh->n_nodes * model->mesh->dim, &v));
  PetscCall(PetscMalloc1(2 * pairs, &load));
  PetscCall(MeshGlobalToLocal(model->mesh, slope, v));
  PetscCall(ModelLargestChange(model, v, &displacement));
  PetscCall(ContactLoadChanges(model->contact, source, model->problem->trial, v, &load[pairs]));
  PetscCall(ModelLoads(model, load, &load[pairs]));
  least = LeastLoad(pairs, load);
  for (int p = 0; p < pairs; p++)
    FillError(source, &load[p], &least, &load[pairs + p], displacement, &model->work->penalty_error[p]);
  PetscCall(PetscFree(load));
  PetscCall(PetscFree(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest error of a pair that stiffer penalties are to lower. */
static PetscReal WorstError(Model model, int pair, PenaltySource source)
{
  const PenaltyError *error = &model->work->penalty_error[pair];
  const PetscReal     press = model->work->weighs_pressure ? error->pressure / PENALTY_ERROR_PRESSURE : 0;

  if (source == BY_SLIP) return PetscMax(error->slip_displacement, error->slip_force);
  return PetscMax(PetscMax(error->displacement, error->force), press);
}

/* Has a raise by a factor, 0 or less for none, brought too little of what it was to lower, from `at` to `worst`? */
static PetscBool BroughtLittle(PetscReal at, PetscReal by, PetscReal worst)
{
  return (PetscBool)(by > 0 && worst > at * PetscPowReal(by, -PENALTY_GAIN));
}

/* Notes whether the last raise of a pair's penalties in this solve has brought too little of what was forecast. */
static void JudgeStiffening(Model model, PenaltySource source, int pair)
{
  const int k = source * ContactPairs(model->contact) + pair;

  if (BroughtLittle(model->work->stiffened_at[k], model->work->stiffened_by[k], WorstError(model, pair, source)))
    model->work->stiffened_by[k] *= -1;
}

/* Estimates the errors at the trial state, in which the step has converged. The state stays as it is. */
PetscErrorCode ModelEstimatePenalty(Model model)
{
  const int sources = ContactHasFriction(model->contact) ? PENALTY_SOURCES : BY_SLIP;
  PetscBool known   = PETSC_FALSE, ok;
  Vec       slope[PENALTY_SOURCES];

  PetscFunctionBeginUser;
  for (int source = 0; source < sources; source++) PetscCall(VecDuplicate(model->x, &slope[source]));
  PetscCall(ProblemSetTrial(model->problem, model->x, model->t));
  PetscCall(ProblemResidual(model->problem, model->problem->trial, model->t, model->t, &ok));
  PetscCall(ModelPenaltySlopes(model, sources, slope, &known));
  for (int p = 0; p < ContactPairs(model->contact); p++) model->work->penalty_error[p] = unknown;
  for (int source = 0; source < sources && known; source++) {
    PetscCall(ModelFillErrors(model, (PenaltySource)source, slope[source]));
    for (int p = 0; p < ContactPairs(model->contact); p++) JudgeStiffening(model, (PenaltySource)source, p);
  }
  for (int source = 0; source < sources; source++) PetscCall(VecDestroy(&slope[source]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The error above which penalties are made stiffer. */
static PetscReal LargeError(Model model)
{
  const SceneAccuracy *accuracy = &model->scene->accuracy;

  return accuracy->probe < 0 ? PENALTY_ERROR_LARGE
                             : PetscMin(PENALTY_ERROR_LARGE, PENALTY_ERROR_SHARE * (PetscReal)accuracy->to);
}

/* How many times as stiff penalties become for an estimated error above a large one, where it is 1. */
static PetscReal StiffeningOf(PetscReal error, PetscReal large)
{
  return PetscMin(PENALTY_MOST_STIFFER,
                  PetscMin(error / (PENALTY_ERROR_WANTED * large), 1 + PENALTY_RISE * (error / large - 1)));
}

/* May the run make a pair's penalties stiffer? */
static PetscBool MayStiffen(const SceneContact *scene, PenaltySource source)
{
  return (PetscBool)(source == BY_SLIP ? scene->stick_may_stiffen : scene->penalty_may_stiffen);
}

/* Chooses how much stiffer those penalties of one kind become that the run may choose and whose error is large. Those
   with such small forces stay as they are of which the solve itself leaves an error as large. *stiffened: some are.
 */
static PetscErrorCode StiffenSource(Model model, PenaltySource source, const ContactLoad load[], PetscReal factor[],
                                    PetscBool *stiffened)
{
  const int       pairs = ContactPairs(model->contact);
  const PetscReal large = LargeError(model);
  PetscReal       most = 0, left = model->scene->solver.tolerance * ProblemForceScale(model->problem);

  PetscFunctionBeginUser;
  for (int p = 0; p < pairs; p++) most = PetscMax(most, load[p].force);
  for (int p = 0; p < pairs; p++) {
    const PetscReal worst = WorstError(model, p, source);
    PetscReal      *at    = &model->work->stiffened_at[source * pairs + p];
    PetscReal      *by    = &model->work->stiffened_by[source * pairs + p];

    if (!MayStiffen(ContactPairScene(model->contact, p), source) || !(worst > large) ||
        load[p].force < PENALTY_LIGHT_PAIR * most || large * load[p].force <= left || *by < 0)
      continue;
    factor[p] = *by = StiffeningOf(worst, large);
    *at             = worst;
    PetscCall(PetscInfo(model->snes, "contact '%s': estimated error %g, penalties%s %g times as stiff\n",
                        ContactPairName(model->contact, p), (double)worst, source == BY_SLIP ? " of what sticks" : "",
                        (double)factor[p]));
    *stiffened = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chooses how much stiffer penalties become where the error is large, after ModelEstimatePenalty(): those of pressures,
   and those of what sticks when the first ones are stiff enough. So a raise that fails takes nothing else back.
   factor[]: of the first ones of all pairs, then of the second ones. *stiffened: some are. */
PetscErrorCode ModelStiffen(Model model, PetscReal factor[], PetscBool *stiffened)
{
  const int    pairs = ContactPairs(model->contact);
  ContactLoad *load;

  PetscFunctionBeginUser;
  *stiffened = PETSC_FALSE;
  for (int k = 0; k < PENALTY_SOURCES * pairs; k++) factor[k] = 1;
  PetscCall(PetscMalloc1(pairs, &load));
  PetscCall(ModelLoads(model, load, NULL));
  for (int source = 0; source < PENALTY_SOURCES && !*stiffened; source++)
    PetscCall(StiffenSource(model, (PenaltySource)source, load, &factor[source * pairs], stiffened));
  PetscCall(PetscFree(load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After ModelUnstiffen(): factor[] becomes its square roots. */
PetscErrorCode ModelStiffenLess(Model model, PetscReal factor[], PetscBool forecast)
{
  const int pairs = ContactPairs(model->contact);

  PetscFunctionBeginUser;
  for (int k = 0; k < PENALTY_SOURCES * pairs; k++) {
    if (factor[k] == 1) continue;
    factor[k] = PetscSqrtReal(factor[k]);
    if (forecast)
      model->work->stiffened_by[k] = factor[k];
    else if (k < pairs) /* a raise for depth */
      model->work->stiffened_by[BY_DEPTH * pairs + k] = factor[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves model->x from the solution at which it stands to where penalties that are factor[] times as stiff, which are
   not in force yet, have their solution to first order: displacements are linear in compliances. Contact then presses
   as before. At the solution itself it would press factor[] times as much. Where a surface is strongly curved, such
   pressures outweigh the stiffness of rubber in the tangent, and Newton's method leaves for another equilibrium: an
   O-ring squeezed by 30 % takes 18 instead of 53 iterations. With friction something is moved only where contact alone
   holds a body. Else a sharp-edged tool that is drawn over a slab takes more iterations, 463 instead of 414 at mu 0.3,
   and stops on the way at mu 0.8.
   estimated: ModelEstimatePenalty() has just been called, and the linear solver has its tangent. */
PetscErrorCode ModelPredictStiffer(Model model, const PetscReal factor[], PetscBool estimated, SolveReport *report)
{
  PetscBool ok;
  Vec       forces, x;
  KSP       ksp;
  PetscInt  its;

  PetscFunctionBeginUser;
  if (ContactHasFriction(model->contact) && !model->problem->bodies) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(model->x, &forces));
  PetscCall(VecDuplicate(model->x, &x));
  PetscCall(ProblemSetTrial(model->problem, model->x, model->t));
  PetscCall(ProblemResidual(model->problem, model->problem->trial, model->t, model->t, &ok));
  PetscCall(SNESGetKSP(model->snes, &ksp));
  if (!estimated) {
    PetscCall(ModelLinearise(model, &ksp));
    PetscCall(ModelReleaseTangent(model));
    report->newton++;
  }
  PetscCall(ModelRaisedForces(model, factor, forces));
  PetscCall(KSPSolve(ksp, forces, x));
  PetscCall(KSPGetIterationNumber(ksp, &its));
  report->krylov += its;
  PetscCall(ModelStepFromSolved(model, model->problem->trial));
  if (!LinearCheckLost(model->linear)) {
    PetscCall(ModelHoldInStep(model, x));
    PetscCall(VecAYPX(x, 1, model->x));
    PetscCall(ProblemSetTrial(model->problem, x, model->t));
    PetscCall(ProblemResidual(model->problem, model->problem->trial, model->t, model->t, &ok));
    if (ok) PetscCall(VecCopy(x, model->x));
    PetscCall(ProblemSetTrial(model->problem, model->x, model->t));
  }
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&forces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chooses how much stiffer penalties become that the run may choose and that let nodes stand deep in faces. factor[] is
   that of ModelStiffen(). *stiffened: some are. A depth that a raise has hardly lowered is that of nodes of a tool
   between the slave's on a coarse mesh. Such a pair is raised no more until it is much deeper: each step would raise it
   anew, in all by 4e8 for a plug that is drawn through a hole. */
PetscErrorCode ModelStiffenDeep(Model model, PetscReal factor[], PetscBool *stiffened)
{
  const int       pairs   = ContactPairs(model->contact);
  const PetscReal allowed = model->scene->certificate.penetration;
  PetscReal       over_h;

  PetscFunctionBeginUser;
  *stiffened = PETSC_FALSE;
  for (int k = 0; k < PENALTY_SOURCES * pairs; k++) factor[k] = 1;
  for (int p = 0; p < pairs; p++) {
    PetscReal *at = &model->work->stiffened_at[BY_DEPTH * pairs + p];
    PetscReal *by = &model->work->stiffened_by[BY_DEPTH * pairs + p];

    if (!MayStiffen(ContactPairScene(model->contact, p), BY_PENETRATION)) continue;
    PetscCall(ContactPairDepth(model->contact, p, &over_h));
    if (BroughtLittle(*at, *by, over_h)) *by = -over_h;
    if (!(over_h > PENALTY_DEEP * allowed) || over_h < -PENALTY_DEEPER * *by) continue;
    *at = over_h;
    *by = factor[p] = PetscMin(PENALTY_MOST_STIFFER, over_h / (PENALTY_SHALLOW * allowed));
    PetscCall(PetscInfo(model->snes, "contact '%s': %g of a face deep, penalties %g times as stiff\n",
                        ContactPairName(model->contact, p), (double)over_h, (double)factor[p]));
    *stiffened = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
