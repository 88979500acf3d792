#include "contact/contactstep.h"
#include "modelimpl.h"
#include "base/timing.h"

/* Terms that change in one step, at most. As many solves at once cost about as much as two or three factors, and save
   as many iterations; with half as many a pipe between plates has steps that are left alone, and takes 69 iterations
   instead of 63. */
#define LINEAR_CONTACT_TERMS 256
/* Numbers in all columns, at most: 0.4 GB */
#define LINEAR_CONTACT_VALUES 5e7
/* Times that terms are found to change which did not seem to. */
#define LINEAR_CONTACT_ROUNDS 16

/* A linear step on the way to its end */
typedef struct {
  ContactStep contact;
  ActiveSet   pressing;
  PetscInt    n, m, rounds;     /* terms near, those that change */
  Mat Z[LINEAR_CONTACT_ROUNDS]; /* what a pressure of 1 on each of these, in their order, does to the free displacements
                                 */
  PetscReal *du, *travel;
} LinearContact;

/* Local displacements: those carried along, if any, and scale times a global vector. */
static PetscErrorCode LocalChange(Model model, Vec x, PetscReal scale, const PetscReal *carried, PetscReal *du)
{
  const PetscInt n = model->mesh->n_nodes * model->mesh->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(du, n));
  PetscCall(MeshGlobalToLocal(model->mesh, x, du));
  for (PetscInt i = 0; i < n; i++) du[i] = scale * du[i] + (carried ? carried[i] : 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LinearContactBegin(Model model, const PetscReal *u, const PetscReal *carried, PetscReal t, Vec y,
                                         LinearContact *s)
{
  const ActiveSetTerm *terms;

  PetscFunctionBeginUser;
  *s = (LinearContact){.n = 0};
  PetscCall(PetscMalloc1(model->mesh->n_nodes * model->mesh->dim, &s->du));
  PetscCall(LocalChange(model, y, -1, carried, s->du));
  PetscCall(ContactStepCreate(model->contact, u, s->du, t, model->t, &s->contact));
  PetscCall(ContactStepGetTerms(s->contact, &s->n, &terms));
  PetscCall(PetscMalloc1(s->n, &s->travel));
  PetscCall(ContactStepTravel(s->contact, s->du, t, model->t, s->travel));
  PetscCall(ActiveSetCreate(s->n, terms, s->travel, &s->pressing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LinearContactEnd(LinearContact *s)
{
  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < s->rounds; r++) PetscCall(MatDestroy(&s->Z[r]));
  PetscCall(ActiveSetDestroy(&s->pressing));
  PetscCall(ContactStepDestroy(&s->contact));
  PetscCall(PetscFree(s->travel));
  PetscCall(PetscFree(s->du));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the terms which[m] do to the step. *able: it could be found. */
static PetscErrorCode LinearContactAdd(Model model, LinearContact *s, PetscInt m, const PetscInt *which,
                                       PetscBool *able)
{
  PetscInt   rows, n;
  PetscReal *G;
  Mat        B, Z;
  Vec        z;

  PetscFunctionBeginUser;
  PetscCall(VecGetSize(model->x, &n));
  *able = (PetscBool)(s->rounds < LINEAR_CONTACT_ROUNDS && s->m + m <= LINEAR_CONTACT_TERMS &&
                      (PetscReal)(s->m + m) * n <= LINEAR_CONTACT_VALUES);
  if (!*able) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetLocalSize(model->x, &rows));
  PetscCall(ContactStepForces(s->contact, rows, m, which, &B));
  PetscCall(MatDuplicate(B, MAT_DO_NOT_COPY_VALUES, &Z));
  TimingBegin(TIMING_SOLVE);
  PetscCall(LinearSolverColumns(model->work->solver, B, Z, able));
  TimingEnd(TIMING_SOLVE);
  PetscCall(MatDestroy(&B));
  s->Z[s->rounds++] = Z;
  s->m += m;
  if (!*able) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(m * s->n, &G));
  for (PetscInt j = 0; j < m; j++) {
    PetscCall(MatDenseGetColumnVecRead(Z, j, &z));
    PetscCall(LocalChange(model, z, 1, NULL, s->du));
    PetscCall(MatDenseRestoreColumnVecRead(Z, j, &z));
    PetscCall(ContactStepTravel(s->contact, s->du, model->t, model->t, &G[j * s->n]));
  }
  PetscCall(ActiveSetAddColumns(s->pressing, m, which, G));
  PetscCall(PetscFree(G));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Goes on as far as the columns at hand allow, on the first rank: what each would find by itself may differ in the last
 * bits, and the ranks go on together. */
static PetscErrorCode LinearContactSolve(Model model, LinearContact *s, PetscInt *m, PetscInt *which,
                                         PetscBool *converged)
{
  MPI_Comm    comm = model->mesh->comm;
  PetscMPIInt rank, n;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) PetscCall(ActiveSetSolve(s->pressing, m, which, converged));
  PetscCallMPI(MPI_Bcast(m, 1, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(converged, sizeof(PetscBool), MPI_BYTE, 0, comm));
  PetscCall(PetscMPIIntCast(*m, &n));
  PetscCallMPI(MPI_Bcast(which, n, MPIU_INT, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the first rank has found: the caller frees excess[m] and pressed[n]. */
static PetscErrorCode LinearContactGet(Model model, const LinearContact *s, PetscReal **excess, PetscBool **pressed)
{
  MPI_Comm         comm = model->mesh->comm;
  const PetscReal *found;
  const PetscBool *presses;
  PetscMPIInt      m, n;

  PetscFunctionBeginUser;
  ActiveSetGet(s->pressing, &found, &presses);
  PetscCall(PetscMalloc2(s->m, excess, s->n, pressed));
  PetscCall(PetscArraycpy(*excess, found, s->m));
  PetscCall(PetscArraycpy(*pressed, presses, s->n));
  PetscCall(PetscMPIIntCast(s->m, &m));
  PetscCall(PetscMPIIntCast(s->n * (PetscInt)sizeof(PetscBool), &n));
  PetscCallMPI(MPI_Bcast(*excess, m, MPIU_REAL, 0, comm));
  PetscCallMPI(MPI_Bcast(*pressed, n, MPI_BYTE, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step with what presses in the end; y stays where that goes further than what is near was looked for, as that of a
 * body that has lost its hold. */
static PetscErrorCode LinearContactTake(Model model, const PetscReal *carried, PetscReal t, LinearContact *s, Vec y,
                                        PetscBool *taken)
{
  PetscReal *excess;
  PetscBool *pressed;
  PetscInt   m, j = 0;
  Vec        z, end;

  PetscFunctionBeginUser;
  PetscCall(LinearContactGet(model, s, &excess, &pressed));
  PetscCall(VecDuplicate(y, &end));
  PetscCall(VecCopy(y, end));
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
  if (*taken) PetscCall(ContactStepMarkPredicted(s->contact, pressed));
  if (*taken) PetscCall(VecCopy(end, y));
  PetscCall(VecDestroy(&end));
  PetscCall(PetscFree2(excess, pressed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelSolveLinearContact - a linear step whose contact is right where it ends.

   Collective. y: the step from free displacements x to x - y by the last tangent, at local displacements u and t;
   carried (may be NULL): local displacements that go with it. The tangent holds terms that the step opens, and lacks
   those that it closes; Newton's method finds that out one iteration later, and so on until the set is right: most of
   its iterations. Here the step's own problem, linear but for its contact conditions, is solved to its end, with the
   factor at hand. Where that is not had, y stays.

   Source: Josephy, Newton's method for generalized equations, 1979: of second order, whatever opens or closes. */
PetscErrorCode ModelSolveLinearContact(Model model, const PetscReal *u, const PetscReal *carried, PetscReal t, Vec y)
{
  PetscBool     able, converged = PETSC_FALSE;
  PetscInt     *which, m        = 1;
  LinearContact s;

  PetscFunctionBeginUser;
  if (!model->contact || LinearCheckLost(model->linear)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LinearSolverDirect(model->work->solver, &able));
  if (!able) PetscFunctionReturn(PETSC_SUCCESS);
  TimingBegin(TIMING_ASSEMBLY_CONTACT);
  PetscCall(LinearContactBegin(model, u, carried, t, y, &s));
  PetscCall(PetscMalloc1(s.n, &which));
  while (able && m) {
    PetscCall(LinearContactSolve(model, &s, &m, which, &converged));
    if (m) PetscCall(LinearContactAdd(model, &s, m, which, &able));
  }
  if (converged) PetscCall(LinearContactTake(model, carried, t, &s, y, &converged));
  PetscCall(PetscInfo(model->snes, "of %" PetscInt_FMT " terms near %" PetscInt_FMT " change: %s\n", s.n, s.m,
                      converged ? "settled" : "left to the next iteration"));
  PetscCall(PetscFree(which));
  PetscCall(LinearContactEnd(&s));
  TimingEnd(TIMING_ASSEMBLY_CONTACT);
  PetscFunctionReturn(PETSC_SUCCESS);
}
