#include "modelimpl.h"
#include "smooth/smoother.h"
#include "matrix/sumoperator.h"
#include "base/timing.h"

const char *const SolveResults[] = {
  "converged",
  "Newton's method did not converge within solver.max_iterations",
  "the line search found no lower energy",
  "an element turned inside out",
  "the linear system is singular (is a body free to move?) or its solver failed",
  "the direct solver ran out of workspace (PETSc option mat_mumps_icntl_14 gives it more)",
  "the contact lists did not settle",
  "the contact set repeats itself",
  "contact was lost behind a master",
  "a body that is held by springs only (stabilise) does not come to rest",
  "the penetrations did not come into the window of the adjusted penalty",
  "not-a-number in the residual"};

/* ModelCreate - joins elasticity, loads, contact and the nonlinear solver.

   Collective. scene and mesh are borrowed. The loads come first: they settle which dofs are free. */
PetscErrorCode ModelCreate(Scene scene, Mesh mesh, Model *out)
{
  Model          model;
  const PetscInt n = mesh->n_nodes * mesh->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&model));
  PetscCall(PetscNew(&model->work));
  model->scene = scene;
  model->mesh  = mesh;
  PetscCall(LoadsCreate(mesh, scene, &model->loads));
  PetscCall(ElasticityCreate(mesh, scene, &model->elasticity));
  PetscCall(ElasticitySetSymmetric(model->elasticity, LoadsConservative(model->loads)));
  if (scene->n_contacts) PetscCall(ContactCreate(mesh, scene, model->elasticity, model->loads, &model->contact));
  PetscCall(PetscCalloc4(n, &model->u, n, &model->work->f, n, &model->work->trial, n, &model->work->accepted_u));
  PetscCall(ElasticityTangent(model->elasticity, model->u));
  PetscCall(ElasticityMatrix(model->elasticity, NULL, NULL, &model->P));
  model->A = model->P;
  PetscCall(PetscObjectReference((PetscObject)model->A));
  PetscCall(MatCreateVecs(model->A, &model->x, NULL));
  PetscCall(VecDuplicate(model->x, &model->work->accepted_x));
  PetscCall(VecDuplicate(model->x, &model->work->look_ahead));
  PetscCall(VecDuplicate(model->x, &model->work->residual));
  if (scene->kinematics != KINEMATICS_SMALL) PetscCall(ExtrapolationCreate(mesh, &model->work->extrapolation));
  PetscCall(ModelCreateSNES(model));
  if (model->contact) {
    PetscCall(ContactCycleCreate(model->contact, &model->work->watch));
    PetscCall(ContactSpringsCreate(model->contact, model->x, &model->work->stabiliser));
  }
  *out = model;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelDestroy - Collective. The scene and the mesh remain. */
PetscErrorCode ModelDestroy(Model *model)
{
  Model m = *model;

  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESDestroy(&m->snes));
  PetscCall(LinearSolverDestroy(&m->work->solver));
  PetscCall(LinearCheckDestroy(&m->linear));
  PetscCall(ContactCycleDestroy(&m->work->watch));
  PetscCall(ContactLineDestroy(&m->work->line));
  PetscCall(ContactSpringsDestroy(&m->work->stabiliser));
  PetscCall(ExtrapolationDestroy(&m->work->extrapolation));
  PetscCall(MatDestroy(&m->A));
  PetscCall(VecDestroy(&m->x));
  PetscCall(VecDestroy(&m->work->accepted_x));
  PetscCall(VecDestroy(&m->work->look_ahead));
  PetscCall(VecDestroy(&m->work->residual));
  PetscCall(ContactDestroy(&m->contact));
  PetscCall(ElasticityDestroy(&m->elasticity));
  PetscCall(LoadsDestroy(&m->loads));
  PetscCall(PetscFree4(m->u, m->work->f, m->work->trial, m->work->accepted_u));
  PetscCall(PetscFree(m->work));
  PetscCall(PetscFree(*model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelPlace - displacements, contact lists and gaps at t = 0, as they are: to be looked at before ModelSetUp() judges
   them.

   Collective. t: load parameter where the first step goes, whose lists these are then; 0: no step follows. */
PetscErrorCode ModelPlace(Model model, PetscReal t)
{
  PetscReal motion;
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(LoadsPrescribe(model->loads, 0, model->u));
  if (!model->contact) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArraycpy(model->work->accepted_u, model->u, model->mesh->n_nodes * model->mesh->dim));
  PetscCall(ModelImposedMotion(model, t, &motion));
  PetscCall(ContactGather(model->contact, model->u, 0, 0, motion));
  PetscCall(ModelResidual(model, model->u, 0, 0, &ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelAssemble - the tangent of the present state: to see its pattern and its cost without a solve. Collective. */
PetscErrorCode ModelAssemble(Model model)
{
  PetscFunctionBeginUser;
  PetscCall(ModelTangent(model, model->u, model->t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelSetUp - the state that ModelPlace() made as the first accepted one.

   Collective. Refuses (exit 1) initial overlaps, ContactTakeOverlap(). */
PetscErrorCode ModelSetUp(Model model)
{
  PetscFunctionBeginUser;
  if (model->contact) PetscCall(ContactTakeOverlap(model->contact));
  PetscCall(ModelAccept(model));
  model->work->rate = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has some body elements of that formulation? Rigid tools have none. */
PetscBool ModelHasFormulation(Scene scene, Formulation formulation)
{
  PetscBool has = PETSC_FALSE;

  for (int b = 0; b < scene->n_bodies; b++)
    has = (PetscBool)(has || (!scene->bodies[b].rigid && scene->bodies[b].formulation == formulation));
  return has;
}

/* ModelGetAccepted - local displacements (length, n_nodes*dim, the model's) and load parameter of the accepted state.
 * Not collective. */
PetscErrorCode ModelGetAccepted(Model model, const PetscReal **u, PetscReal *t)
{
  PetscFunctionBeginUser;
  *u = model->work->accepted_u;
  *t = model->work->accepted_t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelAccept - the present solution is the state to go on from and to return to. Collective. */
PetscErrorCode ModelAccept(Model model)
{
  ModelWork      *work    = model->work;
  const PetscBool stepped = model->t > work->accepted_t ? PETSC_TRUE : PETSC_FALSE;
  PetscReal       motion;
  PetscBool       ok;

  PetscFunctionBeginUser;
  PetscCall(
    ModelResidual(model, model->u, model->t, model->t, &ok)); /* reactions, gaps and forces of exactly this state */
  PetscCall(ModelMotion(model, model->u, model->t, &motion));
  if (stepped) work->rate = motion / (model->t - work->accepted_t);
  model->force_scale = PetscMax(model->force_scale, work->scale);
  PetscCall(PetscArraycpy(work->accepted_u, model->u, model->mesh->n_nodes * model->mesh->dim));
  PetscCall(VecCopy(model->x, work->accepted_x));
  work->accepted_t = model->t;
  if (stepped) work->accepted_start = work->start;
  if (work->extrapolation) PetscCall(ExtrapolationAdd(work->extrapolation, model->u, model->t));
  if (work->extrapolation && SceneBreaks(model->scene, model->t)) PetscCall(ExtrapolationForget(work->extrapolation));
  work->looked_ahead = PETSC_FALSE;
  if (model->contact) {
    PetscCall(ContactAccept(model->contact));
    if (stepped) PetscCall(ContactAdjustNextPenalty(model->contact));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelRestore - takes back everything since the last ModelAccept(). Collective. */
PetscErrorCode ModelRestore(Model model)
{
  ModelWork *work = model->work;
  PetscBool  ok;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(model->u, work->accepted_u, model->mesh->n_nodes * model->mesh->dim));
  PetscCall(VecCopy(work->accepted_x, model->x));
  PetscCall(LinearSolverRenew(work->solver)); /* a forecast may stand ready, and its solve is not repeated */
  model->t = work->accepted_t;
  if (model->contact) {
    PetscCall(ContactRestore(model->contact));
    if (model->A != model->P) PetscCall(SumOperatorSet(model->A, NULL));
    PetscCall(ContactTangentRestore(model->contact));
    PetscCall(ContactGather(model->contact, model->u, model->t, model->t, 0));
  }
  PetscCall(ModelResidual(model, model->u, model->t, model->t, &ok));
  if (model->contact) PetscCall(ContactRestore(model->contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelArchive - saves or takes over the accepted state: displacements and the way there, load parameter, scales,
   contact.

   Collective. To be saved between steps; to be loaded into a model fresh from ModelCreate(), in the place of
   ModelSetUp(). The model then stands as after the ModelAccept() of that step, forces and gaps included. */
PetscErrorCode ModelArchive(Model model, Archive archive)
{
  const Mesh mesh = model->mesh;
  ModelWork *work = model->work;
  Hdf5Table  nodes;
  PetscBool  ok;

  PetscFunctionBeginUser;
  PetscCall(Hdf5TableCreate(mesh->comm, mesh->n_global, mesh->n_nodes, mesh->node_id, &nodes));
  PetscCall(ArchiveRows(archive, "model/displacement", &nodes, mesh->dim, work->accepted_u));
  if (work->extrapolation) PetscCall(ExtrapolationArchive(work->extrapolation, archive, &nodes, work->accepted_u));
  PetscCall(Hdf5TableDestroy(&nodes));
  PetscCall(ArchiveReals(archive, "model/t", 1, &work->accepted_t));
  PetscCall(ArchiveReals(archive, "model/rate", 1, &work->rate));
  PetscCall(ArchiveReals(archive, "model/start", 1, &work->accepted_start));
  PetscCall(ArchiveReals(archive, "model/force_scale", 1, &model->force_scale));
  if (ArchiveLoads(archive)) {
    PetscCall(PetscArraycpy(model->u, work->accepted_u, mesh->n_nodes * mesh->dim));
    PetscCall(MeshCollectFree(mesh, model->u, model->x));
    PetscCall(VecCopy(model->x, work->accepted_x));
    model->t = work->accepted_t;
  }
  PetscCall(LinearCheckArchive(model->linear, archive));
  if (model->contact) PetscCall(ContactArchive(model->contact, archive, model->u, model->t));
  if (!ArchiveLoads(archive)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelResidual(model, model->u, model->t, model->t, &ok));
  if (model->contact) PetscCall(ContactRestore(model->contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelReaction - the force that supports and imposed displacements put on a group's nodes in the accepted state, the
   same on all ranks.

   Collective. Sums the residual over the group's prescribed dofs, those of its edges that it shares with other
   prescribed surfaces too; axisymmetric: over 360 degrees. force[dim..2] are 0. */
PetscErrorCode ModelReaction(Model model, const MeshGroup *group, PetscReal force[3])
{
  const int dim = model->mesh->dim;

  PetscFunctionBeginUser;
  force[0] = force[1] = force[2] = 0;
  for (PetscInt i = 0; i < group->n_nodes; i++) {
    for (int d = 0; d < dim; d++) {
      const PetscInt dof = group->nodes[i] * dim + d;
      if (LoadsPrescribed(model->loads, dof)) force[d] += model->work->f[dof];
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, 3, MPIU_REAL, MPI_SUM, model->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ", NAME contact" for each smoother that some pair has */
static PetscErrorCode ModelContactEffects(Scene scene, char *text, size_t size)
{
  PetscFunctionBeginUser;
  for (int kind = 0; kind < SMOOTHER_KINDS; kind++) {
    PetscBool used = PETSC_FALSE;

    for (int c = 0; c < scene->n_contacts; c++) used = (PetscBool)(used || (int)scene->contacts[c].smoother == kind);
    if (!used) continue;
    PetscCall(PetscStrlcat(text, ", ", size));
    PetscCall(PetscStrlcat(text, SmootherNames[kind], size));
    PetscCall(PetscStrlcat(text, " contact", size));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelEffects - what the scene calls for, in words with commas between, into text[size]. Not collective, same on all
 * ranks. */
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
  PetscCall(PetscSNPrintf(text, size, "%s%s%s",
                          scene->kinematics == KINEMATICS_FINITE ? "finite strain" : "small strain",
                          ModelHasFormulation(scene, FORMULATION_ENHANCED) ? ", enhanced strains" : "",
                          ModelHasFormulation(scene, FORMULATION_FBAR) ? ", mean dilatation" : ""));
  PetscCall(ModelContactEffects(scene, text, size));
  PetscCall(PetscStrlen(text, &start));
  PetscCall(PetscSNPrintf(text + start, size - start, "%s%s%s%s%s%s", surface ? ", surface to surface" : "",
                          adjusted ? ", adjusted penalty" : "", augmented ? ", augmented penalty" : "",
                          LoadsConservative(model->loads) ? "" : ", follower load", body_force ? ", body force" : "",
                          moving ? ", rigid motion" : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelDofs - number of free dofs on all ranks. Not collective. */
PetscErrorCode ModelDofs(Model model, PetscInt *free_dofs)
{
  PetscFunctionBeginUser;
  PetscCall(VecGetSize(model->x, free_dofs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelIsLinear - is one linear solve the answer at any t? Not collective, same on all ranks. */
PetscBool ModelIsLinear(Model model)
{
  return model->scene->kinematics == KINEMATICS_SMALL && !model->contact ? PETSC_TRUE : PETSC_FALSE;
}
