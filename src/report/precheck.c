/* What is looked at before anything is solved, see precheck.h. */
#include "report/precheck.h"
#include "contactreport.h"
#include "estimate.h"
#include "lawreport.h"
#include "units.h"
#include "bodies/freemodes.h"
#include "kernels/elementkernel.h"
#include "bodies/hinges.h"

/* Bodies are moved by about their own size, and seldom by more than a few. A displacement of more diagonals of the
   model than this is one in another unit; metres and millimetres differ by a thousand. */
#define PRECHECK_FAR 20

static PetscErrorCode PrintEffects(Model model, FILE *stream)
{
  char        effects[512];
  PetscMPIInt rank;
  PetscInt    dofs;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(model->mesh->comm, &rank));
  PetscCall(ModelEffects(model, effects, sizeof(effects)));
  PetscCall(ModelDofs(model, &dofs));
  if (!rank) fprintf(stream, "dofs     %" PetscInt_FMT " free\neffects  %s\n", dofs, effects);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PrecheckPlasticity - prints the memory of plastic states, and the formulation that was chosen for plastic bodies.

  Collective

  Input Parameters:
+ model  - after ModelCreate()
- stream - of rank 0, which prints

  Note:
  It prints nothing where no body is plastic.
@*/
PetscErrorCode PrecheckPlasticity(Model model, FILE *stream)
{
  const Scene scene = model->scene;
  PetscInt64  sum[2]; /* points and their bytes */
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  if (!SceneIsPlastic(scene)) PetscFunctionReturn(PETSC_SUCCESS);
  sum[0] = ElasticityPlasticPoints(model->problem->elasticity, &sum[1]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_INT64, MPI_SUM, model->mesh->comm));
  PetscCallMPI(MPI_Comm_rank(model->mesh->comm, &rank));
  if (rank) PetscFunctionReturn(PETSC_SUCCESS);
  fprintf(stream, "plastic  %lld quadrature points, %lld bytes each (%.3g MB)\n", (long long)sum[0],
          (long long)(sum[0] ? sum[1] / sum[0] : 0), (double)sum[1] / 1e6);
  for (int b = 0; b < scene->n_bodies; b++) {
    const SceneBody *body = &scene->bodies[b];

    if (!body->rigid && body->chosen && MaterialGetLaw(body->material.law)->plastic)
      fprintf(stream, "         '%s' names no formulation: it is %s\n", body->name, Formulations[body->formulation]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints the units that the scene names, and what forces are meant of. */
static void PrintUnits(Scene scene, FILE *stream)
{
  char stress[UNITS_TEXT], forces[UNITS_TEXT];

  if (!UnitsNamed(scene)) return;
  UnitsStress(scene, stress);
  UnitsForces(scene, forces);
  fprintf(stream, "units    length %s, force %s, stress %s; forces %s\n", scene->units.length, scene->units.force,
          stress, forces);
}

/* Prints what is special about a scene in the plane. */
static void PrintPlane(Scene scene, FILE *stream)
{
  if (!scene->plane_stress && scene->thickness == 1) return;
  fprintf(stream, "plane    %s, thickness %g\n", scene->plane_stress ? "stress" : "strain", scene->thickness);
}

/* Prints the steps with names, and what acts during each of them. */
static void PrintSteps(Scene scene, FILE *stream)
{
  for (int i = 0; i < scene->stepping.n_steps; i++) {
    const SceneStep *step = &scene->stepping.steps[i];

    fprintf(stream, "%-8s '%s' from t = %g to %g%s%s\n", i ? "" : "steps", step->name, step->begin, step->until,
            step->acts ? ": " : "", step->acts ? step->acts : "");
  }
}

/* Largest factor of a history, whatever its sign. */
static double LargestFactor(const History *history)
{
  double most = 0;

  for (int i = 0; i < history->n; i++) most = fmax(most, fabs(history->v[i]));
  return most;
}

/* Warns of imposed displacements that are much larger than the model: a mesh in metres and loads in millimetres. */
static void WarnOfLengths(Model model)
{
  static const char *const names[3] = {"ux", "uy", "uz"};
  const Scene              scene    = model->scene;

  for (int l = 0; l < scene->n_loads; l++) {
    const SceneLoad *load = &scene->loads[l];

    for (int d = 0; d < model->mesh->dim && load->kind == LOAD_DISPLACEMENT; d++) {
      const double length = load->expression[d] ? 0 : fabs(load->value[d]) * LargestFactor(&load->history);

      if (!load->has[d] || length <= PRECHECK_FAR * model->mesh->size) continue;
      fprintf(stderr,
              "burnish: warning: %s: a displacement of %g is %.3g times the diagonal of the model, which is %.4g; are "
              "mesh and scene in the same unit of length? [B502]\n",
              SceneWhere(scene, load->path, names[d]), length, length / (double)model->mesh->size,
              (double)model->mesh->size);
    }
  }
}

/* Says whether other supports hold in a step than in the one before. */
static PetscBool SupportsDiffer(Scene scene, int step)
{
  for (int s = 0; s < scene->n_supports; s++)
    if (SceneHolds(&scene->supports[s].during, step) != SceneHolds(&scene->supports[s].during, step - 1))
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Looks at what holds the bodies in each step that has other supports than the step before. It prints that to a stream,
   with the bodies that supports hold if `held`, or refuses a body that nothing holds where there is none. */
static PetscErrorCode LookAtSteps(Model model, PetscBool held, FILE *stream)
{
  const Scene    scene = model->scene;
  const Loads    loads = model->problem->loads;
  PetscErrorCode code  = PETSC_SUCCESS;
  PetscMPIInt    rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(model->mesh->comm, &rank));
  for (int k = 1; k < scene->stepping.n_steps && !code; k++) {
    const char *name = scene->stepping.steps[k].name;
    FreeModes   modes;

    if (!SupportsDiffer(scene, k)) continue;
    PetscCall(LoadsShowPhase(loads, k));
    PetscCall(FreeModesCreate(model->mesh, scene, loads, &modes));
    PetscCall(LoadsShowPhase(loads, LoadsPhase(loads)));
    if (stream && !rank && (held || FreeModesAny(modes))) fprintf(stream, "         from step '%s' on:\n", name);
    if (stream)
      PetscCall(FreeModesReport(modes, held, stream));
    else
      code = FreeModesRefuse(modes, name);
    PetscCall(FreeModesDestroy(&modes));
  }
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PrecheckModel - looks for what makes a scene fail before anything is solved.

  Collective

  Input Parameters:
+ model  - after ModelPlace() and before ModelSetUp(), which refuses initial overlaps: they are reported here first
. report - print what was found: dofs, effects, rigid motions, contact pairs, cost
- stream - of rank 0, which prints

  Note:
  It refuses a body that nothing can hold, see FreeModesRefuse().
@*/
PetscErrorCode PrecheckModel(Model model, PetscBool report, FILE *stream)
{
  const Scene scene = model->scene;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCall(HingesWarn(model->mesh, model->scene, stderr));
  PetscCallMPI(MPI_Comm_rank(model->mesh->comm, &rank));
  if (!rank) WarnOfLengths(model);
  if (report) {
    PetscCall(PrintEffects(model, stream));
    if (!rank) PrintUnits(model->scene, stream);
    if (!rank) PrintPlane(model->scene, stream);
    if (!rank) PrintSteps(model->scene, stream);
    PetscCall(PrecheckPlasticity(model, stream));
    if (!rank) LawReport(model->scene, stream);
    PetscCall(FreeModesReport(model->problem->modes, PETSC_TRUE, stream));
    PetscCall(LookAtSteps(model, PETSC_TRUE, stream));
    PetscCall(ContactReport(model->contact, stream));
    PetscCall(EstimatePrint(model, stream));
  }
  PetscCall(FreeModesRefuse(model->problem->modes, SceneSupportsChange(scene) ? scene->stepping.steps[0].name : NULL));
  PetscCall(LookAtSteps(model, PETSC_FALSE, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PrecheckMotions - prints the rigid motions that supports leave to the bodies, if there are any.

  Collective

  Input Parameters:
+ model  - after ModelPlace()
- stream - of rank 0, which prints
@*/
PetscErrorCode PrecheckMotions(Model model, FILE *stream)
{
  PetscFunctionBeginUser;
  PetscCall(FreeModesReport(model->problem->modes, PETSC_FALSE, stream));
  PetscCall(LookAtSteps(model, PETSC_FALSE, stream));
  PetscFunctionReturn(PETSC_SUCCESS);
}
