/* The figures of a finished run, see runfigures.h. */
#include "runfigures.h"
#include "errors/strainvariation.h"
#include "linear/directsolver.h"
#include <sys/resource.h>

/*@
  RunUsageCollect - collects what this program has used since it started.

  Collective

  Input Parameter:
. comm - of the run

  Output Parameter:
. usage - the same on all ranks; wall_s is left as it is
@*/
PetscErrorCode RunUsageCollect(MPI_Comm comm, RunUsage *usage)
{
  struct rusage self;

  PetscFunctionBeginUser;
  PetscCheck(!getrusage(RUSAGE_SELF, &self), PETSC_COMM_SELF, PETSC_ERR_SYS, "getrusage failed");
  for (int k = 0; k < TIMING_KINDS; k++) usage->seconds[k] = TimingSeconds((TimingKind)k);
  usage->cpu_s = (PetscReal)(self.ru_utime.tv_sec + self.ru_stime.tv_sec) +
                 1e-6 * (PetscReal)(self.ru_utime.tv_usec + self.ru_stime.tv_usec);
  usage->peak_rss_mb = (PetscReal)self.ru_maxrss / 1024.0; /* Linux counts kilobytes */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, usage->seconds, TIMING_KINDS, MPIU_REAL, MPI_MAX, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &usage->cpu_s, 1, MPIU_REAL, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &usage->peak_rss_mb, 1, MPIU_REAL, MPI_MAX, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multiplies forces, areas and energies by the thickness of the plane. */
static void ScaleFriction(PetscReal thickness, ContactFriction *friction)
{
  for (int d = 0; d < 3; d++) {
    friction->force[d] *= thickness;
    friction->moment[d] *= thickness;
  }
  friction->sticking_area *= thickness;
  friction->slipped_area *= thickness;
  friction->dissipated *= thickness;
  friction->turned *= thickness;
}

static PetscErrorCode CollectPair(Model model, int p, PairFigures *pair)
{
  const Contact contact = model->contact;

  PetscFunctionBeginUser;
  pair->name          = ContactPairName(contact, p);
  pair->scene         = ContactPairScene(contact, p);
  pair->penalty_error = ModelPenaltyError(model, p);
  pair->penalty_stays = ModelPenaltyStays(model, p);
  PetscCall(ContactPairFits(contact, p, &pair->fits));
  PetscCall(ContactPairGeometry(contact, p, &pair->geometry));
  PetscCall(ContactPairQuality(contact, p, &pair->quality));
  PetscCall(ContactPairPenalty(contact, p, &pair->penalty_min, &pair->penalty_max));
  pair->stiffened       = pair->penalty_max > 0 ? pair->penalty_max / ContactPairInitialPenalty(contact, p) : 1;
  pair->stick_stiffened = ContactPairStick(contact, p);
  PetscCall(ContactPairWindow(contact, p, &pair->window));
  PetscCall(ContactPairFriction(contact, p, &pair->friction));
  ScaleFriction(model->scene->thickness, &pair->friction);
  PetscCall(ContactPairScatter(contact, p, model->u, &pair->scatter));
  PetscCall(ContactPairMasterDepth(contact, p, model->u, model->t, &pair->master));
  pair->master_deepest = pair->master.depth;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What was done for bodies that only contact holds. */
static PetscErrorCode CollectFreeBodies(Model model, RunFigures *figures)
{
  const FreeBodies bodies = model->problem->bodies;

  PetscFunctionBeginUser;
  if (!bodies) PetscFunctionReturn(PETSC_SUCCESS);
  figures->free_bodies = PETSC_TRUE;
  PetscCall(PetscStrncpy(figures->moved, FreeBodiesMoved(bodies), sizeof(figures->moved)));
  if (model->t > 0)
    PetscCall(FreeBodiesLoose(bodies, model->u, model->t, PETSC_FALSE, sizeof(figures->loose), figures->loose));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The energy with which that of a viscous restraint is compared. */
static PetscErrorCode CollectStored(Model model, RunFigures *figures)
{
  PetscBool ok;

  PetscFunctionBeginUser;
  if (figures->run->way->damped)
    PetscCall(
      ProblemEnergy(model->problem, model->u, model->t, ENERGY_ELASTIC | ENERGY_CONTACT, &figures->stored, &ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RunFiguresCollect - collects the figures of a run.

  Collective

  Input Parameters:
+ model    - in its last accepted state
. scene    - of the model; borrowed
. run      - how the run ended; borrowed
. usage    - of all parts of the run
. restarts - number of these parts less one
- last     - the last accepted step, NULL where there is none; borrowed

  Output Parameter:
. figures - the same on all ranks; free it with RunFiguresDestroy()
@*/
PetscErrorCode RunFiguresCollect(Model model, Scene scene, const RunRecord *run, const RunUsage *usage,
                                 PetscInt restarts, const StepRecord *last, RunFigures *figures)
{
  PetscMPIInt ranks;
  KSP         ksp;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(model->mesh->comm, &ranks));
  *figures = (RunFigures){.scene    = scene,
                          .run      = run,
                          .usage    = *usage,
                          .restarts = restarts,
                          .last     = last,
                          .ranks    = ranks,
                          .n_pairs  = ContactPairs(model->contact)};
  PetscCall(ModelDofs(model, &figures->dofs));
  PetscCall(ModelEffects(model, figures->effects, sizeof(figures->effects)));
  LinearCheckGetCounts(model->linear, &figures->linear);
  PetscCall(SNESGetKSP(model->snes, &ksp));
  PetscCall(DirectSolverServes(ksp, &figures->direct));
  BlasFind(&figures->blas);
  CertificateGetFigures(model->certificate, &figures->certificate);
  figures->certified =
    (PetscBool)(model->certificate && figures->certificate.steps - figures->certificate.refused == run->way->steps);
  figures->n_fluids = FluidCount(model->problem->fluids);
  PetscCall(PetscMalloc1(figures->n_fluids, &figures->fluids));
  for (int i = 0; i < figures->n_fluids; i++) FluidGetReport(model->problem->fluids, i, &figures->fluids[i]);
  PetscCall(PetscMalloc1(scene->n_bodies, &figures->variation));
  PetscCall(StrainVariation(model->mesh, scene, model->problem->elasticity, model->u, figures->variation));
  PetscCall(CollectFreeBodies(model, figures));
  PetscCall(CollectStored(model, figures));
  PetscCall(PetscCalloc1(figures->n_pairs, &figures->pairs));
  for (int p = 0; p < figures->n_pairs; p++) PetscCall(CollectPair(model, p, &figures->pairs[p]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RunFiguresDestroy - frees the figures.

  Not collective

  Input Parameter:
. figures - from RunFiguresCollect()
@*/
PetscErrorCode RunFiguresDestroy(RunFigures *figures)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(figures->pairs));
  PetscCall(PetscFree(figures->fluids));
  PetscCall(PetscFree(figures->variation));
  PetscFunctionReturn(PETSC_SUCCESS);
}
