/* The contact that is right at the end of a linear step, from columns of the factor. */
#include "base/timing.h"
#include "contact/contactstep.h"
#include "modelimpl.h"

/* At most this many terms may change in one step, with friction in each of their parts. As many solves at once cost
   about as much as two or three factors and save as many iterations. With half as many a pipe between plates has steps
   that stay as they are, and takes 69 iterations instead of 63. */
#define LINEAR_CONTACT_TERMS 256
/* More of them may change as long as their columns have at most this many numbers, which take as long as a few factors.
   A thin sheet between tools is near them all over, and a linear step that bends it presses nearly all terms. Left as
   it is, such a step throws the sheet off: an elastic sheet between die, holder and punch needed 59 iterations and a
   repeated step for half of the way that takes 16 now. A ring that rolls in its groove opens and closes terms all
   around: a quarter of an O-ring of 11,000 unknowns takes 33 iterations and 41 s of CPU, with 2e6 numbers 40 and 44 s.
 */
#define LINEAR_CONTACT_CHEAP 3e7
/* All columns Z together have at most this many numbers on all ranks, which is 0.4 GB. */
#define LINEAR_CONTACT_VALUES 5e7
/* So many columns are computed at a time. What they are computed from then takes little memory beside them. It is a
   multiple of what the factor solves for at a time. */
#define LINEAR_CONTACT_BATCH 512
/* Where bodies were moved into contact and more terms change, this share of the terms that are left is tried at first,
   and of the rest again and again. They touch in a point, and the first step presses everything around it. */
#define LINEAR_CONTACT_SHARE 2
/* Most rounds in which further terms are found to change. Each round computes the columns of the terms that are new.
   The last one computes those of all terms if there is room: a thin body peels off another one term by term. With
   friction most such steps end within twenty rounds and two thirds of the columns; with 16 rounds a sheet that is drawn
   over an edge took half as long again. */
#define LINEAR_CONTACT_ROUNDS 32

/* Most products of two numbers in the dense problem for each unknown, after which it is left to the next iteration. An
   iteration in space computes some 1e5 for each. Of a hundred ordinary scenes none that was solved took more than 2e5;
   a strand of seven wires that touched with all their points took 1e8 without an end. In a sheet that is drawn to a
   channel few problems that take more are solved, and each takes as long as twenty iterations. */
#define LINEAR_CONTACT_WORK 3e5
/* A problem may take the work of so many dense solves with all its columns, whatever their number. A metal sheet that
   is drawn to a square cup has half as many terms as unknowns. Its problems took up to 12 solves, or 75 and did not
   end; where all were left after one, as the bound for each unknown says, Newton's method made no step. */
#define LINEAR_CONTACT_SOLVES 16

/* Friction may leave this part of the residual out of balance at the end of a linear step of Newton's method. Where it
   could leave more, nodes that stick in the tangent and begin to slip were each found by an iteration of its own:
   blocks that are pushed along took 147 iterations instead of 59. */
#define LINEAR_CONTACT_ENOUGH 0.1
/* And a step that is carried along by prescribed motions this part of F_ref. */
#define LINEAR_CONTACT_CARRIED 0.01

/* Newton's method converges with a step after which the residual is below this part of what it was. */
#define LINEAR_CONTACT_CONVERGES 0.5

/* The contact problem of a linear step. The first rank alone solves it and keeps the influence of the terms on each
   other; results differ in their last bits between ranks, and the ranks must go on together. */
typedef struct {
  ContactStep contact;
  ActiveSet   active;                   /* NULL on the other ranks */
  PetscInt    n;                        /* terms near the contact */
  PetscInt    all;                      /* their components, as in activeset.h */
  PetscInt    m, most;                  /* components that change, and how many may */
  PetscInt    rounds;                   /* times that such components were added */
  Mat         Z[LINEAR_CONTACT_ROUNDS]; /* free displacements under 1 on each of these components, in their order */
  PetscReal  *du;                       /* n_nodes*dim (length) */
  PetscReal  *travel;                   /* of all components: change of gaps and slips in the step at hand (length) */
  PetscMPIInt rank;
} LinearContact;

/* Sets du to the carried local displacements, if there are any, plus scale times a global vector. */
static PetscErrorCode LocalChange(Model model, Vec x, PetscReal scale, const PetscReal *carried, PetscReal *du)
{
  const PetscInt n = model->mesh->n_nodes * model->mesh->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(du, n));
  PetscCall(MeshGlobalToLocal(model->mesh, x, du));
  for (PetscInt i = 0; i < n; i++) du[i] = scale * du[i] + (carried ? carried[i] : 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says what force friction may leave out of balance at the end of the step, which begins with the residual b. To a step
   that is carried along this tells nothing: b has what prescribed motions do to cells and contact. */
static PetscErrorCode LinearContactEnough(Model model, PetscBool carried, Vec b, const LinearContact *s)
{
  PetscReal force = LINEAR_CONTACT_CARRIED * ProblemForceScale(model->problem), norm;

  PetscFunctionBeginUser;
  if (!ContactHasFriction(model->contact)) PetscFunctionReturn(PETSC_SUCCESS);
  if (!carried) {
    PetscCall(VecNorm(b, NORM_2, &norm));
    force = LINEAR_CONTACT_ENOUGH * norm;
  }
  if (!s->rank) ActiveSetEnough(s->active, force);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the terms that may change in the step y and the travel of their gaps: those that the step `reach` may reach. */
static PetscErrorCode LinearContactBegin(Model model, const PetscReal *u, const PetscReal *carried, PetscReal t, Vec b,
                                         Vec reach, Vec y, LinearContact *s)
{
  const PetscBool      moved = (PetscBool)(carried || t != model->t);
  const ActiveSetTerm *terms;
  PetscInt             size;

  PetscFunctionBeginUser;
  *s = (LinearContact){.n = 0};
  PetscCallMPI(MPI_Comm_rank(model->mesh->comm, &s->rank));
  PetscCall(PetscMalloc1(model->mesh->n_nodes * model->mesh->dim, &s->du));
  PetscCall(LocalChange(model, reach, -1, carried, s->du));
  PetscCall(ContactStepCreate(model->contact, u, s->du, t, model->t, &s->contact));
  PetscCall(ContactStepGetTerms(s->contact, &s->n, &terms));
  s->all = s->n * ContactStepParts(s->contact);
  PetscCall(VecGetSize(model->x, &size));
  s->most =
    PetscMax(LINEAR_CONTACT_TERMS * ContactStepParts(s->contact), (PetscInt)(LINEAR_CONTACT_CHEAP / PetscMax(1, size)));
  PetscCall(PetscMalloc1(s->all, &s->travel));
  PetscCall(LocalChange(model, y, -1, carried, s->du));
  PetscCall(ContactStepChange(s->contact, s->du, t, model->t, s->travel));
  if (!s->rank) PetscCall(ActiveSetCreate(s->n, ContactStepParts(s->contact), s->most, terms, s->travel, &s->active));
  if (!s->rank) ActiveSetBound(s->active, LINEAR_CONTACT_WORK * (PetscReal)size, LINEAR_CONTACT_SOLVES);
  PetscCall(LinearContactEnough(model, moved, b, s));
  if (!s->rank && !moved) ActiveSetAllowPart(s->active);
  if (!s->rank && model->work->stalled) ActiveSetLeaveRelaxation(s->active);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Frees what LinearContactBegin() and the rounds have made. */
static PetscErrorCode LinearContactEnd(LinearContact *s)
{
  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < s->rounds; r++) PetscCall(MatDestroy(&s->Z[r]));
  if (s->active) PetscCall(ActiveSetDestroy(&s->active));
  PetscCall(ContactStepDestroy(&s->contact));
  PetscCall(PetscFree(s->travel));
  PetscCall(PetscFree(s->du));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to the first rank's contact problem how 1 on each component which[m] changes all gaps and slips; Z has a column
   of free displacements for each. The other ranks keep one column at a time, of which they compute their part. */
static PetscErrorCode LinearContactAddColumns(Model model, LinearContact *s, PetscInt m, const PetscInt *which, Mat Z)
{
  PetscReal *G;
  Vec        z;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((s->rank ? 1 : PetscMin(m, LINEAR_CONTACT_BATCH)) * s->all, &G));
  for (PetscInt j = 0; j < m; j++) {
    const PetscInt k = j % LINEAR_CONTACT_BATCH;

    PetscCall(MatDenseGetColumnVecRead(Z, j, &z));
    PetscCall(LocalChange(model, z, 1, NULL, s->du));
    PetscCall(MatDenseRestoreColumnVecRead(Z, j, &z));
    PetscCall(ContactStepChange(s->contact, s->du, model->t, model->t, &G[s->rank ? 0 : k * s->all]));
    if (!s->rank && (j + 1 == m || k + 1 == LINEAR_CONTACT_BATCH))
      PetscCall(ActiveSetAddColumns(s->active, k + 1, &which[j - k], G));
  }
  PetscCall(PetscFree(G));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves for the free displacements under 1 on each component which[m], the columns of a new Z. *able: that could be
   done. */
static PetscErrorCode LinearContactColumns(Model model, const LinearContact *s, PetscInt m, const PetscInt *which,
                                           Mat *Z, PetscBool *able)
{
  PetscInt rows;
  Mat      B, part;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(model->x, &rows));
  PetscCall(MatCreateDense(model->mesh->comm, rows, PETSC_DECIDE, PETSC_DETERMINE, m, NULL, Z));
  for (PetscInt first = 0, n; first < m && *able; first += n) {
    n = PetscMin(LINEAR_CONTACT_BATCH, m - first);
    PetscCall(ContactStepForces(s->contact, rows, n, &which[first], &B));
    PetscCall(MatDenseGetSubMatrix(*Z, PETSC_DECIDE, PETSC_DECIDE, first, first + n, &part));
    TimingBegin(TIMING_SOLVE);
    PetscCall(LinearSolverColumns(model->work->solver, B, part, able));
    TimingEnd(TIMING_SOLVE);
    PetscCall(MatDenseRestoreSubMatrix(*Z, &part));
    PetscCall(MatDestroy(&B));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the columns of the components which[m]. *able: that could be done. */
static PetscErrorCode LinearContactAdd(Model model, LinearContact *s, PetscInt m, const PetscInt *which,
                                       PetscBool *able)
{
  PetscInt n;
  Mat      Z;

  PetscFunctionBeginUser;
  PetscCall(VecGetSize(model->x, &n));
  *able = (PetscBool)(s->rounds < LINEAR_CONTACT_ROUNDS && s->m + m <= s->most &&
                      (PetscReal)(s->m + m) * n <= LINEAR_CONTACT_VALUES);
  if (!*able) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LinearContactColumns(model, s, m, which, &Z, able));
  s->Z[s->rounds++] = Z;
  s->m += m;
  if (*able) PetscCall(ModelHoldInColumns(model, Z));
  if (*able) PetscCall(LinearContactAddColumns(model, s, m, which, Z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Asks for the columns of all components in the last round, if there is room. */
static PetscErrorCode LinearContactAskAll(Model model, const LinearContact *s, PetscInt *m, PetscInt *which)
{
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(VecGetSize(model->x, &n));
  if (*m && s->rounds + 1 == LINEAR_CONTACT_ROUNDS && s->all <= s->most &&
      (PetscReal)s->all * n <= LINEAR_CONTACT_VALUES)
    ActiveSetRest(s->active, m, which);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Continues on the first rank as far as the columns that are known allow; the other ranks receive the components
   which[m] whose columns are missing. */
static PetscErrorCode LinearContactSolve(Model model, LinearContact *s, PetscInt *m, PetscInt *which,
                                         PetscBool *converged)
{
  MPI_Comm    comm = model->mesh->comm;
  PetscMPIInt n;

  PetscFunctionBeginUser;
  if (!s->rank) PetscCall(ActiveSetSolve(s->active, m, which, converged));
  if (!s->rank && model->work->settled && s->m + *m > LINEAR_CONTACT_TERMS)
    PetscCall(ActiveSetLimit(s->active, (LINEAR_CONTACT_TERMS - s->m) / LINEAR_CONTACT_SHARE, m, which));
  if (!s->rank) PetscCall(LinearContactAskAll(model, s, m, which));
  PetscCallMPI(MPI_Bcast(m, 1, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(converged, sizeof(PetscBool), MPI_BYTE, 0, comm));
  PetscCall(PetscMPIIntCast(*m, &n));
  PetscCallMPI(MPI_Bcast(which, n, MPIU_INT, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives all ranks the solution of the first: the excess pressure of each changed term, which terms are in contact, and
   the part of the step at which it ends. The caller frees excess[m] and pressed[n] with PetscFree2(). */
static PetscErrorCode LinearContactGet(Model model, const LinearContact *s, PetscReal **excess, PetscBool **pressed,
                                       PetscReal *part)
{
  MPI_Comm         comm = model->mesh->comm;
  const PetscReal *found;
  const PetscBool *in_contact;
  PetscMPIInt      m, n;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(s->m, excess, s->n, pressed));
  if (!s->rank) {
    ActiveSetGet(s->active, &found, &in_contact, part);
    PetscCall(PetscArraycpy(*excess, found, s->m));
    PetscCall(PetscArraycpy(*pressed, in_contact, s->n));
  }
  PetscCall(PetscMPIIntCast(s->m, &m));
  PetscCall(PetscMPIIntCast(s->n * (PetscInt)sizeof(PetscBool), &n));
  PetscCallMPI(MPI_Bcast(*excess, m, MPIU_REAL, 0, comm));
  PetscCallMPI(MPI_Bcast(*pressed, n, MPI_BYTE, 0, comm));
  PetscCallMPI(MPI_Bcast(part, 1, MPIU_REAL, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelResidualAt - evaluates the residual at free displacements, which become the trial ones.

  Collective

  Input Parameters:
+ model - the model, with contact
- x     - free displacements (length)

  Output Parameters:
+ ok   - no element is inverted there
- norm - of the residual (force); infinite where an element is inverted or where the contact lists do not reach
@*/
PetscErrorCode ModelResidualAt(Model model, Vec x, PetscBool *ok, PetscReal *norm)
{
  const Problem problem = model->problem;
  PetscBool     within;
  Vec           f;

  PetscFunctionBeginUser;
  *norm = PETSC_INFINITY;
  PetscCall(ProblemSetTrial(problem, x, model->t));
  PetscCall(ProblemResidual(problem, problem->trial, model->t, model->t, ok));
  if (!*ok) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactListsReach(model->contact, &within));
  if (!within) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(x, &f));
  PetscCall(ProblemCollectResidual(problem, x, f));
  PetscCall(VecNorm(f, NORM_2, norm));
  PetscCall(VecDestroy(&f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Evaluates the residual where the step y ends, as ModelResidualAt() does. The trial displacements stay. */
static PetscErrorCode ResidualAfter(Model model, Vec y, PetscBool *ok, PetscReal *norm)
{
  Vec end;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(y, &end));
  PetscCall(VecWAXPY(end, -1, y, model->x));
  PetscCall(ModelResidualAt(model, end, ok, norm));
  PetscCall(ProblemSetTrial(model->problem, model->x, model->t));
  PetscCall(VecDestroy(&end));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the step y as it is, which keeps what sticks and slips, does not converge. */
static PetscErrorCode LinearContactFails(Model model, Vec y, PetscBool *fails)
{
  PetscReal before, after;
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(SNESGetFunctionNorm(model->snes, &before));
  PetscCall(ResidualAfter(model, y, &ok, &after));
  *fails = (PetscBool) !(after < LINEAR_CONTACT_CONVERGES * before);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether what presses at the end of a linear step that is carried along presses where it really ends. Where tools
   turn far, points move on circles, and the linear step pushes a tool that a force holds away from them. */
static PetscErrorCode LinearContactMeets(Model model, const LinearContact *s, const PetscBool *pressed, Vec y,
                                         PetscBool *meets)
{
  PetscReal norm;

  PetscFunctionBeginUser;
  PetscCall(ResidualAfter(model, y, meets, &norm));
  if (*meets) PetscCall(ContactStepMeets(s->contact, pressed, meets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Changes the step y by the excess pressures, which makes its contact right. *taken: that was done. It is not where the
   changed step moves the surfaces further than the terms were chosen for: work->beyond is set, and `reach` becomes that
   step. Nor is it where it ends at a part of the step although the whole of it, with its wrong contact, converges:
   that step serves as it is. */
static PetscErrorCode LinearContactTake(Model model, const PetscReal *carried, PetscReal t, PetscBool again,
                                        LinearContact *s, Vec reach, Vec y, PetscBool *taken)
{
  PetscReal *excess, part;
  PetscBool *pressed;
  PetscInt   m, j = 0;
  Vec        z, end;

  PetscFunctionBeginUser;
  PetscCall(LinearContactGet(model, s, &excess, &pressed, &part));
  PetscCall(VecDuplicate(y, &end));
  PetscCall(VecCopy(y, end));
  PetscCall(VecScale(end, part));
  for (PetscInt r = 0; r < s->rounds; r++) {
    PetscCall(MatGetSize(s->Z[r], NULL, &m));
    for (PetscInt k = 0; k < m; k++, j++) {
      PetscCall(MatDenseGetColumnVecRead(s->Z[r], k, &z));
      PetscCall(VecAXPY(end, excess[j], z));
      PetscCall(MatDenseRestoreColumnVecRead(s->Z[r], k, &z));
    }
  }
  PetscCall(LocalChange(model, end, -1, carried, s->du));
  PetscCall(ContactStepWithin(s->contact, s->du, t, model->t, taken));
  model->work->unsettled = model->work->beyond = (PetscBool) !*taken;
  if (!*taken) PetscCall(VecCopy(end, reach));
  if (*taken && part < 1) PetscCall(LinearContactFails(model, y, taken));
  if (*taken && again && carried) PetscCall(LinearContactMeets(model, s, pressed, end, taken));
  if (*taken) PetscCall(ContactStepMarkPredicted(s->contact, pressed));
  if (*taken) PetscCall(VecCopy(end, y));
  PetscCall(VecDestroy(&end));
  PetscCall(PetscFree2(excess, pressed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Notes the pressures at the end of the step y, unless PETSc tests tangents against differences. */
static PetscErrorCode LinearContactForesee(Model model, const PetscReal *carried, PetscReal t, Vec y, LinearContact *s)
{
  PetscFunctionBeginUser;
  if (!model->work->foresees) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LocalChange(model, y, -1, carried, s->du));
  PetscCall(ContactStepForesee(s->contact, s->du, t, model->t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves the contact problem of the step y with the terms that the step `reach` may reach, as
   ModelSolveLinearContact() says. */
static PetscErrorCode LinearContactTry(Model model, const PetscReal *u, const PetscReal *carried, PetscReal t, Vec b,
                                       PetscBool again, Vec reach, Vec y)
{
  PetscBool     able = PETSC_TRUE, converged = PETSC_FALSE;
  PetscInt     *which, m                     = 1;
  LinearContact s;

  PetscFunctionBeginUser;
  model->work->beyond = PETSC_FALSE;
  PetscCall(LinearContactBegin(model, u, carried, t, b, reach, y, &s));
  PetscCall(PetscMalloc1(s.all, &which));
  while (able && m) {
    PetscCall(LinearContactSolve(model, &s, &m, which, &converged));
    if (m) PetscCall(LinearContactAdd(model, &s, m, which, &able));
  }
  model->work->unsettled = (PetscBool)!converged;
  if (converged) PetscCall(LinearContactTake(model, carried, t, again, &s, reach, y, &converged));
  PetscCall(PetscInfo(model->snes, "of %" PetscInt_FMT " terms near %" PetscInt_FMT " change: %s\n", s.n, s.m,
                      converged ? "settled" : "left to the next iteration"));
  PetscCall(PetscFree(which));
  PetscCall(LinearContactForesee(model, carried, t, y, &s));
  PetscCall(LinearContactEnd(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelSolveLinearContact - changes a linear step so that its contact is right where it ends.

  Collective

  Input Parameters:
+ model   - after a solve with the tangent at (u, t)
. u       - local displacements u[n_nodes*dim] (length) where the step begins
. carried - local displacements that belong to the step besides y (length); may be NULL
. t       - load parameter where the step begins; it ends at model->t
. b       - residual over the free dofs from which the step was made (force)
- y       - the step: free displacements go from x to x - y (length)

  Output Parameter:
. y - the changed step; unchanged without contact, with an iterative solver, or where the contact problem has no
      solution within the bounds at the top of this file. With friction it may be a part of the step

  Notes:
  The tangent holds terms that the step opens, and lacks terms that the step closes. Newton's method alone finds that
  out one iteration later, and repeats it until the set is right, which takes most of its iterations. Here the problem
  of the step, linear but for its contact conditions, is solved to its end with the factor that is known. With friction
  it finds what sticks and what slips too: a pinched pipe takes 65 iterations instead of 88.

  Where the solution moves the surfaces farther than the terms were chosen for, the problem is solved once more, with
  the terms that it may reach. Where that solution goes too far in its turn, as with a body that has lost its
  support, or is carried along to where a pair that should press is open, the step stays as it is: a third solution
  took a loose key in its seat past its contact, and the run took 319 iterations instead of 52.

  Source: Josephy, Newton's method for generalized equations, 1979. The convergence is of second order, whatever opens
  or closes.
@*/
PetscErrorCode ModelSolveLinearContact(Model model, const PetscReal *u, const PetscReal *carried, PetscReal t, Vec b,
                                       Vec y)
{
  PetscBool able;
  Vec       reach;

  PetscFunctionBeginUser;
  model->work->unsettled = model->work->beyond = PETSC_FALSE;
  PetscCall(ModelHoldInStep(model, y));
  if (!model->contact) PetscFunctionReturn(PETSC_SUCCESS);
  ContactForgetForeseen(model->contact);
  if (LinearCheckLost(model->linear)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LinearSolverDirect(model->work->solver, &able));
  if (!able) PetscFunctionReturn(PETSC_SUCCESS);
  TimingBegin(TIMING_ASSEMBLY_CONTACT);
  PetscCall(VecDuplicate(y, &reach));
  PetscCall(VecCopy(y, reach));
  PetscCall(LinearContactTry(model, u, carried, t, b, PETSC_FALSE, reach, y));
  if (model->work->beyond) {
    PetscCall(LinearContactTry(model, u, carried, t, b, PETSC_TRUE, reach, y));
    model->work->beyond = model->work->unsettled;
  }
  PetscCall(VecDestroy(&reach));
  TimingEnd(TIMING_ASSEMBLY_CONTACT);
  PetscFunctionReturn(PETSC_SUCCESS);
}
