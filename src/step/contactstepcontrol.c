/* Control of the load step by contact: dt such that a wanted number of nodes comes into contact in each step. */
#include "stepcontrol.h"
#include <math.h>

/* A converged step that changes the status of up to this many times the wanted nodes is kept, because to repeat it
   costs more than it saves. On a pipe between plates, whose nodes come in rows, 2 takes 96 iterations and 1.5 takes
   148. */
#define STEP_CHANGES_KEPT 2.0
/* The next step should bring at most this many times the wanted nodes, if as many nodes change their status per dt as
   in the last step. */
#define STEP_CHANGES_AIM 1.25
/* The next step is at most this many times the dt after which the wanted nodes touch if everything moves on along
   straight lines. The nodes touch later than that, because those before them are held once they have touched. On a cup
   that is flattened they touch four times as late. */
#define STEP_REACH 6.0
/* That bound is never below this part of the last dt, because open nodes may be as close to the master as they like. */
#define STEP_LEAST_REACH 0.25
/* A step that is taken back is repeated with at least this part of its dt, because the change of status is not
   proportional to dt. */
#define STEP_LEAST_PART 0.1
/* With `prediction: tangent` a step goes this far past the predicted touch, so that the node is in contact at its end.
 */
#define STEP_PAST_TOUCH 1.02
/* A prediction by the tangent holds the contact set, so that open nodes come nearer than they do once the nodes before
   them have touched. Fewer nodes touch than it promises. What the last step brought corrects the next prediction, by at
   most this factor at a time. */
#define STEP_CORRECTION 2.0
/* All these corrections together are at most this factor. */
#define STEP_SHORTFALL 8.0
/* A step has its planned length if it differs by less than this part. The end of a step minus its start is not exactly
   dt. */
#define STEP_AS_PLANNED 1e-6
/* Factors on dt keep this many binary digits. Their last digits depend on the number of ranks, which steps must not. */
#define STEP_DIGITS 10

/* Rounds a factor on dt to STEP_DIGITS binary digits. */
static PetscReal Round(PetscReal factor)
{
  int       exponent;
  PetscReal digits = frexp(factor, &exponent);

  return ldexp(rint(ldexp(digits, STEP_DIGITS)), exponent - STEP_DIGITS);
}

/* Nodes, or area, whose status differs from that in the accepted state, and how many the scene wants per step. */
static PetscErrorCode Changes(Model model, const StepSize *size, PetscReal *changed, PetscReal *wanted)
{
  const PetscReal *u;
  PetscReal        t, all;

  PetscFunctionBeginUser;
  PetscCall(ModelGetAccepted(model, &u, &t));
  PetscCall(ContactChanges(model->contact, t, size->by_area, changed, &all));
  *wanted = size->wanted * (size->by_area ? all : 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes beta_{N_c} from the step between the accepted state and (u, t). Source: Chamoret et al. 2004, eqs 17 to 20.
 */
static PetscErrorCode Choose(Model model, const PetscReal *u, PetscReal t, PetscBool still_open, PetscReal factor,
                             StepSize *size, TouchStepChoice *choice)
{
  const PetscReal *u_0;
  PetscReal        t_0, changed, wanted;
  Touch           *touch;
  int              n;

  PetscFunctionBeginUser;
  PetscCall(ModelGetAccepted(model, &u_0, &t_0));
  PetscCall(Changes(model, size, &changed, &wanted));
  PetscCall(ContactTouches(model->contact, u_0, t_0, u, t, size->by_area, still_open, &n, &touch));
  TouchStepChoose(n, touch, factor * wanted, size->dt_min / (t - t_0), choice);
  PetscCall(PetscFree(touch));
  size->beta     = choice->beta;
  size->together = choice->tied ? choice->met : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The order of the paper, for `prediction: tangent`: one linear solve over the present dt says when nodes touch, and dt
   is chosen so that the wanted nodes do. Collective. */
static PetscErrorCode StepControlPredict_Contact(Model model, PetscReal remaining, StepSize *size, SolveReport *report)
{
  const PetscReal dt = PetscMin(size->dt, remaining);
  PetscReal      *u;
  TouchStepChoice choice;

  PetscFunctionBeginUser;
  if (!size->linearly || !model->contact) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(model->mesh->n_nodes * model->mesh->dim, &u));
  PetscCall(ModelLookAhead(model, model->t + dt, u, report));
  if (report->result == SOLVE_CONVERGED) {
    PetscCall(Choose(model, u, model->t + dt, PETSC_FALSE, size->shortfall, size, &choice));
    size->tied    = choice.tied ? choice.nodes : 0;
    size->dt      = isnan(choice.beta) ? size->growth * size->dt
                                       : PetscMin(size->growth * size->dt, Round(STEP_PAST_TOUCH * choice.beta) * dt);
    size->dt      = PetscMax(size->dt_min, PetscMin(size->dt_max, size->dt));
    size->planned = isnan(choice.beta) ? 0 : Round(STEP_PAST_TOUCH * choice.beta) * dt;
  }
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* For `prediction: converged`: a step in which too many nodes changed their status is taken back, unless they change it
   at the same time. Collective. */
static PetscErrorCode StepControlJudge_Contact(Model model, PetscReal dt, StepSize *size, PetscBool *accepted)
{
  const PetscReal *u;
  PetscReal        t, changed = 0, all, wanted = 0;

  PetscFunctionBeginUser;
  *accepted = PETSC_TRUE;
  if (size->linearly || !model->contact) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Changes(model, size, &changed, &wanted));
  size->tied = 0;
  if (changed <= STEP_CHANGES_KEPT * wanted) PetscFunctionReturn(PETSC_SUCCESS);
  if (dt > size->dt_min && changed > STEP_CHANGES_KEPT * size->together) {
    *accepted = PETSC_FALSE;
    size->dt  = PetscMax(size->dt_min, dt * Round(PetscMax(wanted / changed, STEP_LEAST_PART)));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ModelGetAccepted(model, &u, &t));
  PetscCall(ContactChanges(model->contact, t, PETSC_FALSE, &changed, &all));
  size->tied = (PetscInt)changed;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Corrects the next prediction by what a step of its planned length brought. */
static PetscErrorCode Learn(Model model, PetscReal dt, StepSize *size)
{
  PetscReal changed, wanted;

  PetscFunctionBeginUser;
  if (PetscAbsReal(dt - size->planned) > STEP_AS_PLANNED * dt) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Changes(model, size, &changed, &wanted));
  size->shortfall *= Round(
    PetscMin(STEP_CORRECTION, PetscMax(1 / STEP_CORRECTION, wanted / PetscMax(changed, wanted / STEP_CORRECTION))));
  size->shortfall = PetscMax(1, PetscMin(STEP_SHORTFALL, size->shortfall));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The longest dt that should bring no more than the wanted nodes, judged by the last step, which had the given dt. */
static PetscErrorCode Longest(Model model, PetscReal dt, PetscReal beta, const StepSize *size, PetscReal *longest)
{
  PetscReal changed, wanted;

  PetscFunctionBeginUser;
  PetscCall(Changes(model, size, &changed, &wanted));
  *longest = size->growth;
  if (changed > 0 && !size->tied) *longest = PetscMin(*longest, STEP_CHANGES_AIM * wanted / changed);
  if (!isnan(beta)) *longest = PetscMin(*longest, PetscMax(STEP_LEAST_REACH, STEP_REACH * (beta - 1)));
  *longest = Round(*longest) * dt;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chooses dt by the open nodes that approach and by the nodes that changed their status. A beta above 1 enlarges the
   next step; the paper repeats the present step instead, whose solution is good as it is. With `prediction: tangent` dt
   is chosen before the next step. Collective. */
static PetscErrorCode StepControlNext_Contact(Model model, PetscReal dt, PetscBool clipped, PetscInt newton,
                                              StepSize *size)
{
  TouchStepChoice choice;
  PetscReal       longest = dt;

  PetscFunctionBeginUser;
  (void)newton;
  if (!model->contact) {
    if (!clipped) size->dt = size->growth * dt;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (size->linearly) {
    PetscCall(Learn(model, dt, size));
    if (!clipped) size->dt = dt;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(Choose(model, model->u, model->t, PETSC_TRUE, 1, size, &choice));
  PetscCall(Longest(model, dt, choice.beta, size, &longest));
  if (!clipped) size->dt = dt * (isnan(choice.beta) ? size->growth : PetscMin(size->growth, Round(choice.beta)));
  size->dt = PetscMax(size->dt_min, PetscMin(size->dt, longest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const StepControl StepControl_Contact = {StepControlPredict_Contact, StepControlJudge_Contact, StepControlNext_Contact};
