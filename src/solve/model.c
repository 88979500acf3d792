/* The accepted state of a model: set-up, acceptance, return, and its place in an archive. */
#include "modelimpl.h"
#include "base/timing.h"
#include "smooth/smoother.h"
#include "solve/forcebalance.h"

const char *const SolveResults[] = {
  "converged",
  "Newton's method did not converge within solver.max_iterations",
  "Newton's method did not converge: the residual fell no more",
  "the line search found no lower energy",
  "an element turned inside out",
  "the linear system is singular (is a body free to move?) or its solver failed",
  "the direct solver ran out of workspace (PETSc option mat_mumps_icntl_14 gives it more)",
  "the contact lists did not settle",
  "the contact set repeats itself",
  "contact was lost behind a master",
  "the step cannot be certified",
  "nothing holds a body against its load",
  "the penetrations did not come into the window of the adjusted penalty",
  "the volumes of incompressible bodies did not settle (do the displacements of a whole surface change one?)",
  "the places that a fluid wets did not settle",
  "a fluid leaks, and the step is too long to say at which pressure",
  "a fluid leaks",
  "a rigid tool turned too far in one step",
  "surfaces that lie opposite each other turn too far in one step",
  "the bodies go too far in one step",
  "a routine of the user's (law: umat) failed",
  "the bodies go far for the load, and the step is too long to say whether they jump to another equilibrium",
  "the tangent stayed indefinite: the bodies leave an equilibrium that is not stable",
  "not-a-number in the residual"};

/* Makes all parts of a model for the supports of a phase. */
static PetscErrorCode ModelBuild(Model model, PetscInt phase)
{
  const Scene    scene = model->scene;
  const Mesh     mesh  = model->mesh;
  const PetscInt n     = mesh->n_nodes * mesh->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&model->work));
  PetscCall(ProblemCreate(scene, mesh, phase, &model->problem));
  model->contact = model->problem->contact;
  PetscCall(PetscCalloc2(n, &model->u, n, &model->work->accepted_u));
  PetscCall(MeshCreateVector(mesh, &model->x));
  PetscCall(VecDuplicate(model->x, &model->work->accepted_x));
  PetscCall(VecDuplicate(model->x, &model->work->look_ahead));
  PetscCall(VecDuplicate(model->x, &model->work->residual));
  PetscCall(VecDuplicate(model->x, &model->work->step));
  if (scene->kinematics != KINEMATICS_SMALL || SceneIsPlastic(scene))
    PetscCall(ExtrapolationCreate(mesh, &model->work->extrapolation));
  if (ProblemIsPlastic(model->problem) || (model->contact && scene->output.certificate))
    PetscCall(EnergyBalanceCreate(model->problem, &model->balance));
  PetscCall(ModelCreateSNES(model));
  PetscCall(ModelCreatePenaltyError(model));
  if (model->contact) PetscCall(ContactCycleCreate(model->contact, &model->work->watch));
  if (model->contact && scene->output.certificate)
    PetscCall(CertificateCreate(mesh, scene, model->problem->loads, model->contact, &model->certificate));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Frees all parts of a model. */
static PetscErrorCode ModelClear(Model m)
{
  PetscFunctionBeginUser;
  PetscCall(CertificateDestroy(&m->certificate));
  PetscCall(SNESDestroy(&m->snes));
  PetscCall(LinearSolverDestroy(&m->work->solver));
  PetscCall(LinearCheckDestroy(&m->linear));
  PetscCall(SNESLineSearchDestroy(&m->work->backtracking));
  PetscCall(VecDestroy(&m->work->relaxed.x));
  PetscCall(VecDestroy(&m->work->relaxed.y));
  PetscCall(VecDestroy(&m->work->shift.lists));
  PetscCall(ModelHeldDestroy(&m->work->hold));
  PetscCall(ModelDragDestroy(&m->work->drag));
  PetscCall(ContactCycleDestroy(&m->work->watch));
  PetscCall(ExtrapolationDestroy(&m->work->extrapolation));
  PetscCall(EnergyBalanceDestroy(&m->balance));
  PetscCall(VecDestroy(&m->x));
  PetscCall(VecDestroy(&m->work->accepted_x));
  PetscCall(VecDestroy(&m->work->look_ahead));
  PetscCall(VecDestroy(&m->work->tangent_x));
  PetscCall(VecDestroy(&m->work->residual));
  PetscCall(VecDestroy(&m->work->step));
  PetscCall(ProblemDestroy(&m->problem));
  PetscCall(PetscFree2(m->u, m->work->accepted_u));
  PetscCall(PetscFree2(m->work->solved, m->work->from));
  PetscCall(PetscFree(m->work->penalty_error));
  PetscCall(PetscFree3(m->work->stiffened_at, m->work->stiffened_by, m->work->accepted_stays));
  PetscCall(PetscFree(m->work));
  *m = (struct _n_Model){.scene = m->scene, .mesh = m->mesh};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelCreate - creates the problem of a scene and its nonlinear solver.

  Collective

  Input Parameters:
+ scene - borrowed
- mesh  - borrowed

  Output Parameter:
. out - the model; ModelPlace() comes next
@*/
PetscErrorCode ModelCreate(Scene scene, Mesh mesh, Model *out)
{
  Model model;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&model));
  *out         = model; /* ModelDestroy() frees what a refusal leaves */
  model->scene = scene;
  model->mesh  = mesh;

  model->most_facing = INFINITY;
  PetscCall(ModelBuild(model, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelDestroy - destroys the model and its problem; the scene and the mesh remain.

  Collective

  Input Parameter:
. model - set to NULL; may be NULL already
@*/
PetscErrorCode ModelDestroy(Model *model)
{
  PetscFunctionBeginUser;
  if (!*model) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelClear(*model));
  PetscCall(PetscFree(*model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelPlace - sets displacements, contact lists and gaps at t = 0, for reports that come before ModelSetUp().

  Collective

  Input Parameters:
+ model - fresh from ModelCreate()
- t     - load parameter at the end of the first step, for which the contact lists are made; 0: no step follows
@*/
PetscErrorCode ModelPlace(Model model, PetscReal t)
{
  PetscReal motion;
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(LoadsPrescribe(model->problem->loads, 0, model->u));
  if (!model->contact) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArraycpy(model->work->accepted_u, model->u, model->mesh->n_nodes * model->mesh->dim));
  PetscCall(ProblemImposedMotion(model->problem, model->work->accepted_u, model->work->accepted_t, t, &motion));
  PetscCall(ProblemGatherLists(model->problem, model->u, 0, 0, motion));
  PetscCall(ProblemResidual(model->problem, model->u, 0, 0, &ok));
  PetscCall(FluidStart(model->problem->fluids, model->u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelAssemble - computes the tangent of the present state, to show its pattern and its cost without a solve.

  Collective

  Input Parameter:
. model - after ModelPlace()
@*/
PetscErrorCode ModelAssemble(Model model)
{
  PetscFunctionBeginUser;
  PetscCall(ModelTangent(model, model->u, NULL, model->t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelSetUp - makes the state of ModelPlace() the first accepted one.

  Collective

  Input Parameter:
. model - after ModelPlace()

  Note:
  Initial overlaps that the scene does not allow are refused, see ContactTakeOverlap().
@*/
PetscErrorCode ModelSetUp(Model model)
{
  PetscFunctionBeginUser;
  if (model->contact) PetscCall(ContactTakeOverlap(model->contact));
  PetscCall(ModelAccept(model));
  model->work->rate    = 0;
  model->work->settled = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelGetAccepted - returns the accepted state.

  Not collective

  Input Parameter:
. model - the model

  Output Parameters:
+ u - local displacements u[n_nodes*dim] (length); they belong to the model
- t - load parameter
@*/
PetscErrorCode ModelGetAccepted(Model model, const PetscReal **u, PetscReal *t)
{
  PetscFunctionBeginUser;
  *u = model->work->accepted_u;
  *t = model->work->accepted_t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelCertify - judges the step from the accepted state to the present solution.

  Collective

  Input Parameter:
. model - after a ModelSolve() that converged, before ModelAccept()

  Input/Output Parameter:
. report - of that solve: SOLVE_UNCERTIFIED with its detail where something passed through anything unseen
@*/
PetscErrorCode ModelCertify(Model model, SolveReport *report)
{
  PetscBool holds;

  PetscFunctionBeginUser;
  PetscCall(CertificateCheck(model->certificate, model->work->accepted_u, model->work->accepted_t, model->u, model->t,
                             &holds, &report->excess, report->detail, sizeof(report->detail)));
  if (!holds) report->result = SOLVE_UNCERTIFIED;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelAccept - makes the present solution the accepted state.

  Collective

  Input Parameter:
. model - after a ModelSolve() that converged

  Note:
  Reactions, gaps and contact forces are those of exactly this state afterwards. Penalties that are adjusted for the
  next step are adjusted here.
@*/
PetscErrorCode ModelAccept(Model model)
{
  ModelWork      *work    = model->work;
  const PetscBool stepped = model->t > work->accepted_t ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool holds   = (PetscBool)(work->hold.wanted > 0 || work->drag.on);
  PetscReal       motion;
  ForceBalance    balance;
  PlasticPath     path;
  PetscBool       ok;

  PetscFunctionBeginUser;
  PetscCall(LinearSolverRelease(work->solver));
  ToolsAccept(model->mesh, model->u, model->t);
  PetscCall(ElasticityAcceptPlastic(model->problem->elasticity, model->u, model->t, &path));
  if (model->balance) PetscCall(EnergyBalanceAdd(model->balance, work->accepted_u, model->u, model->t, &path));
  if (SceneBreaks(model->scene, model->t)) ElasticityForgetFlow(model->problem->elasticity);
  if (model->balance) PetscCall(OuterWorkBegin(EnergyBalanceOuter(model->balance), holds));
  if (model->certificate && stepped) {
    PetscCall(ForceBalanceFind(model->problem, model->u, model->t, &balance, &ok));
    CertificateBalance(model->certificate, balance.force, balance.moment);
  } else {
    PetscCall(ProblemResidual(model->problem, model->u, model->t, model->t, &ok));
  }
  if (model->balance) {
    PetscCall(OuterWorkAdd(EnergyBalanceOuter(model->balance), work->accepted_u, work->accepted_t, model->u, model->t,
                           work->drag.on ? work->drag.taken : NAN));
    EnergyBalanceEnd(model->balance);
  }
  if (model->problem->fluids) { /* the work of the step was that of the loads as they lay */
    PetscCall(FluidSettle(model->problem->fluids, model->u, model->t));
    PetscCall(ProblemResidual(model->problem, model->u, model->t, model->t, &ok));
  }
  PetscCall(ModelDragNote(model));
  PetscCall(ProblemMotion(model->problem, work->accepted_u, work->accepted_t, model->u, model->t, &motion));
  if (stepped) work->rate = motion / (model->t - work->accepted_t);
  model->problem->force_so_far = ProblemForceScale(model->problem);
  PetscCall(PetscArraycpy(work->accepted_u, model->u, model->mesh->n_nodes * model->mesh->dim));
  PetscCall(VecCopy(model->x, work->accepted_x));
  work->accepted_t = model->t;
  work->settled = work->searched = PETSC_FALSE;
  if (stepped) work->accepted_start = work->start;
  if (stepped) work->accepted_held = work->held;
  work->hold.accepted = work->hold.wanted;
  if (work->extrapolation) PetscCall(ExtrapolationAdd(work->extrapolation, model->u, model->t));
  if (work->extrapolation && SceneBreaks(model->scene, model->t)) PetscCall(ExtrapolationForget(work->extrapolation));
  work->looked_ahead = PETSC_FALSE;
  PetscCall(ElasticityAccept(model->problem->elasticity));
  if (model->problem->bodies) PetscCall(FreeBodiesAccept(model->problem->bodies, model->problem->springs));
  PetscCall(FluidAccept(model->problem->fluids, model->u, model->t));
  if (model->contact) {
    PetscCall(ContactAccept(model->contact));
    ModelAcceptPenaltyError(model);
    if (stepped) PetscCall(ContactAdjustNextPenalty(model->contact));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelRate - returns the largest displacement per unit of t in the last accepted step (length), 0 before the first one.

  Not collective, the same on all ranks

  Input Parameter:
. model - the model
@*/
PetscReal ModelRate(Model model)
{
  return model->work->rate;
}

/*@
  ModelRestore - returns to the accepted state.

  Collective

  Input Parameter:
. model - after a ModelSolve() that failed or whose solution is not wanted

  Note:
  The result of ModelLookAhead() stays valid, and its linear solve is not repeated.
@*/
PetscErrorCode ModelRestore(Model model)
{
  ModelWork *work = model->work;
  PetscBool  ok;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(model->u, work->accepted_u, model->mesh->n_nodes * model->mesh->dim));
  PetscCall(VecCopy(work->accepted_x, model->x));
  PetscCall(LinearSolverRenew(work->solver)); /* a step that starts from a look-ahead would not do so itself */
  ModelHeldFail(model);
  model->t = work->accepted_t;
  ToolsAccept(model->mesh, model->u, model->t);
  PetscCall(ElasticityRestore(model->problem->elasticity));
  PetscCall(FluidRestore(model->problem->fluids, model->u, model->t));
  if (model->contact) {
    PetscCall(ContactRestore(model->contact));
    PetscCall(ProblemRestoreTangent(model->problem));
    PetscCall(ProblemGatherLists(model->problem, model->u, model->t, model->t, 0));
  }
  PetscCall(ProblemResidual(model->problem, model->u, model->t, model->t, &ok));
  if (model->contact) PetscCall(ContactRestore(model->contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Saves or loads the balance of energies, if there is one. A run whose steps were not judged has none to load. */
static PetscErrorCode ModelArchiveBalance(Model model, Archive archive)
{
  PetscBool there = (PetscBool)(model->balance != NULL);

  PetscFunctionBeginUser;
  if (ArchiveLoads(archive)) PetscCall(ArchiveHas(archive, "model/energies", &there));
  if (model->balance && there) PetscCall(EnergyBalanceArchive(model->balance, archive, model->work->accepted_u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Saves or loads which supports hold. A model that loads is built anew where other ones do. */
static PetscErrorCode ModelArchivePhase(Model model, Archive archive)
{
  PetscInt phase = LoadsPhase(model->problem->loads);

  PetscFunctionBeginUser;
  PetscCall(ArchiveIntegers(archive, "supports/phase", 1, &phase));
  PetscCheck(phase >= 0 && phase < PetscMax(1, model->scene->stepping.n_steps), model->mesh->comm,
             PETSC_ERR_FILE_UNEXPECTED, "step %" PetscInt_FMT " of the supports", phase);
  if (phase != LoadsPhase(model->problem->loads)) {
    PetscCall(ModelClear(model));
    PetscCall(ModelBuild(model, phase));
  }
  PetscCall(LoadsArchive(model->problem->loads, archive));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelArchive - saves or loads the accepted state: displacements, states for the extrapolation, load parameter, scales
  and contact.

  Collective

  Input Parameters:
+ model   - between two steps to save; fresh from ModelCreate() to load, in the place of ModelSetUp()
- archive - decides whether the state is saved or loaded

  Note:
  After loading the model stands as after the ModelAccept() of that step, forces and gaps included.
@*/
PetscErrorCode ModelArchive(Model model, Archive archive)
{
  const Mesh mesh = model->mesh;
  ModelWork *work;
  PetscInt   held;
  Hdf5Table  nodes;
  PetscBool  ok;

  PetscFunctionBeginUser;
  if (SceneSupportsChange(model->scene)) PetscCall(ModelArchivePhase(model, archive));
  work = model->work;
  PetscCall(Hdf5TableCreate(mesh->comm, mesh->n_global, mesh->n_nodes, mesh->node_id, &nodes));
  PetscCall(ArchiveRows(archive, "model/displacement", &nodes, mesh->dim, work->accepted_u));
  if (work->extrapolation) PetscCall(ExtrapolationArchive(work->extrapolation, archive, &nodes, work->accepted_u));
  PetscCall(ModelHeldArchive(model, archive, &nodes));
  PetscCall(ModelDragArchive(model, archive, &nodes));
  PetscCall(Hdf5TableDestroy(&nodes));
  PetscCall(ArchiveReals(archive, "model/t", 1, &work->accepted_t));
  PetscCall(ArchiveReals(archive, "model/rate", 1, &work->rate));
  PetscCall(ArchiveReals(archive, "model/start", 1, &work->accepted_start));
  held = work->accepted_held;
  PetscCall(ArchiveIntegers(archive, "model/held", 1, &held));
  work->accepted_held = (PetscBool)held;
  PetscCall(ArchiveReals(archive, "model/force_scale", 1, &model->problem->force_so_far));
  if (ArchiveLoads(archive)) {
    PetscCall(PetscArraycpy(model->u, work->accepted_u, mesh->n_nodes * mesh->dim));
    PetscCall(MeshCollectFree(mesh, model->u, model->x));
    PetscCall(VecCopy(model->x, work->accepted_x));
    model->t = work->accepted_t;
    ToolsAccept(mesh, model->u, model->t);
    work->settled = (PetscBool)(work->accepted_t == 0);
  }
  PetscCall(ElasticityArchive(model->problem->elasticity, archive));
  PetscCall(ModelArchivePenaltyError(model, archive));
  PetscCall(LinearCheckArchive(model->linear, archive));
  if (model->problem->bodies) PetscCall(FreeBodiesArchive(model->problem->bodies, archive));
  if (model->contact) PetscCall(ContactArchive(model->contact, archive, model->u, model->t));
  PetscCall(ElasticityArchivePlastic(model->problem->elasticity, archive));
  PetscCall(ModelArchiveBalance(model, archive));
  PetscCall(FluidArchive(model->problem->fluids, archive));
  PetscCall(CertificateArchive(model->certificate, archive));
  if (!ArchiveLoads(archive)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FluidRestore(model->problem->fluids, model->u, model->t));
  PetscCall(ProblemResidual(model->problem, model->u, model->t, model->t, &ok));
  if (model->contact) PetscCall(ContactRestore(model->contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelChangeSupports - lets supports come and go where a step with a name ends in the accepted state.

  Collective

  Input Parameter:
. model - between two steps

  Output Parameter:
. changed - other supports hold from here on

  Note:
  The unknowns are those of the step that begins. All parts of the model are made anew for them and take over the
  accepted state, as they do in a restart. The forces of supports that leave fade over the step.
@*/
PetscErrorCode ModelChangeSupports(Model model, PetscBool *changed)
{
  const PetscInt n     = model->mesh->n_nodes * model->mesh->dim;
  const PetscInt phase = SceneStepFrom(model->scene, model->work->accepted_t);
  PetscReal     *force;
  Archive        archive;

  PetscFunctionBeginUser;
  *changed = PETSC_FALSE;
  if (!SceneSupportsChange(model->scene) || phase == LoadsPhase(model->problem->loads))
    PetscFunctionReturn(PETSC_SUCCESS);
  *changed = PETSC_TRUE;
  TimingBegin(TIMING_SETUP);
  PetscCall(PetscMalloc1(n, &force));
  PetscCall(PetscArraycpy(force, model->problem->f, n));
  PetscCall(MeshSumNodes(model->mesh, model->mesh->dim, force));
  PetscCall(LoadsChangePhase(model->problem->loads, phase, model->work->accepted_u, force));
  PetscCall(PetscFree(force));
  PetscCall(ArchiveKeep(model->mesh->comm, &archive));
  PetscCall(ModelArchive(model, archive));
  ArchiveTurn(archive);
  PetscCall(ModelClear(model));
  PetscCall(ModelBuild(model, phase));
  PetscCall(ModelArchive(model, archive));
  PetscCall(ArchiveClose(&archive));
  TimingEnd(TIMING_SETUP);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds ", NAME contact" to the text for each smoother that some pair has. */
static PetscErrorCode ModelContactEffects(Scene scene, char *text, size_t size)
{
  PetscFunctionBeginUser;
  for (int kind = 0; SmootherNames[kind]; kind++) {
    PetscBool used = PETSC_FALSE;

    for (int c = 0; c < scene->n_contacts; c++) used = (PetscBool)(used || scene->contacts[c].smoother == kind);
    if (!used) continue;
    PetscCall(PetscStrlcat(text, ", ", size));
    PetscCall(PetscStrlcat(text, SmootherNames[kind], size));
    PetscCall(PetscStrlcat(text, " contact", size));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelEffects - writes what the scene calls for in words with commas between them.

  Not collective, the same on all ranks

  Input Parameters:
+ model - the model
- size  - of the text

  Output Parameter:
. text - for example "finite strain, facet contact"
@*/
PetscErrorCode ModelEffects(Model model, char *text, size_t size)
{
  Scene     scene  = model->scene;
  PetscBool moving = PETSC_FALSE, body_force = PETSC_FALSE, adjusted = PETSC_FALSE, augmented = PETSC_FALSE,
            surface = PETSC_FALSE;
  size_t start;

  PetscFunctionBeginUser;
  for (int b = 0; b < scene->n_bodies; b++)
    moving = (PetscBool)(moving || (scene->bodies[b].rigid && scene->bodies[b].motion.n));
  for (int c = 0; c < scene->n_contacts; c++) adjusted = (PetscBool)(adjusted || scene->contacts[c].adjust);
  for (int c = 0; c < scene->n_contacts; c++) augmented = (PetscBool)(augmented || scene->contacts[c].augment);
  for (int l = 0; l < scene->n_loads; l++)
    body_force = (PetscBool)(body_force || scene->loads[l].kind == LOAD_BODY_FORCE);
  for (int c = 0; c < scene->n_contacts; c++)
    surface = (PetscBool)(surface || scene->contacts[c].formulation == CONTACT_SURFACE_TO_SURFACE);
  PetscCall(PetscSNPrintf(text, size, "%s%s%s%s",
                          scene->kinematics == KINEMATICS_FINITE ? "finite strain" : "small strain",
                          ProblemHasFormulation(model->problem, FORMULATION_ENHANCED) ? ", enhanced strains" : "",
                          ProblemHasFormulation(model->problem, FORMULATION_FBAR) ? ", mean dilatation" : "",
                          ProblemHasFormulation(model->problem, FORMULATION_MIXED) ? ", mixed elements" : ""));
  if (ProblemIsPlastic(model->problem)) PetscCall(PetscStrlcat(text, ", plasticity", size));
  PetscCall(ModelContactEffects(scene, text, size));
  PetscCall(PetscStrlen(text, &start));
  PetscCall(PetscSNPrintf(text + start, size - start, "%s%s%s%s%s%s%s%s", surface ? ", surface to surface" : "",
                          ContactHasFriction(model->contact) ? ", friction" : "", adjusted ? ", adjusted penalty" : "",
                          augmented ? ", augmented penalty" : "",
                          LoadsConservative(model->problem->loads) ? "" : ", follower load",
                          model->problem->fluids ? ", fluid between surfaces" : "", body_force ? ", body force" : "",
                          moving ? ", rigid motion" : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelDofs - returns the number of free dofs of all ranks.

  Not collective

  Input Parameter:
. model - the model

  Output Parameter:
. free_dofs - their number
@*/
PetscErrorCode ModelDofs(Model model, PetscInt *free_dofs)
{
  PetscFunctionBeginUser;
  PetscCall(VecGetSize(model->x, free_dofs));
  PetscFunctionReturn(PETSC_SUCCESS);
}
