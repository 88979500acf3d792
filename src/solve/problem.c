/* The discrete problem: residual, energy and tangent of elements, loads and contact, and the motion between two states.
 */
#include "solve/problem.h"
#include "base/timing.h"
#include "base/vectors.h"
#include "matrix/sumoperator.h"
#include "mesh/pressurenodes.h"

/* Length of the shortest edge between the first two nodes of a cell, over all cells. */
static PetscErrorCode ShortestEdge(Mesh mesh, PetscReal *length)
{
  PetscReal least = PETSC_MAX_REAL;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt *nodes  = &mesh->cell_nodes[mesh->cell_ptr[c]];
    PetscReal       square = 0;

    for (int d = 0; d < mesh->dim; d++)
      square += PetscSqr(mesh->coords[nodes[1] * mesh->dim + d] - mesh->coords[nodes[0] * mesh->dim + d]);
    least = PetscMin(least, square);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPIU_REAL, MPIU_MIN, mesh->comm));
  *length = PetscSqrtReal(least);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemCreate - creates loads, elements and contact of a scene, and the matrix of their tangent.

  Collective

  Input Parameters:
+ scene - borrowed
. mesh  - borrowed
- phase - number of the step with a name whose supports hold, see LoadsCreate()

  Output Parameter:
. out - the problem, with its tangent in the form TANGENT_JOINED

  Note:
  The loads come first, because they decide which dofs are free.
@*/
PetscErrorCode ProblemCreate(Scene scene, Mesh mesh, PetscInt phase, Problem *out)
{
  Problem problem;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&problem));
  *out              = problem; /* ProblemDestroy() frees what a refusal leaves */
  problem->scene    = scene;
  problem->mesh     = mesh;
  problem->form     = TANGENT_JOINED;
  problem->inverted = -1;
  if (scene->kinematics == KINEMATICS_FINITE) PetscCall(ShortestEdge(mesh, &problem->edge));
  PetscCall(LoadsCreate(mesh, scene, phase, &problem->loads));
  PetscCall(ElasticityCreate(mesh, scene, &problem->elasticity));
  if (scene->n_contacts) PetscCall(ContactCreate(mesh, scene, problem->elasticity, problem->loads, &problem->contact));
  PetscCall(ElasticitySetSymmetric(problem->elasticity, ProblemConservative(problem)));
  PetscCall(ElasticitySetEnclosed(problem->elasticity, scene, LoadsConstrained(problem->loads)));
  PetscCall(FluidCreate(mesh, scene, problem->loads, problem->contact, &problem->fluids));
  PetscCall(MeshCreateLocal(mesh, mesh->dim, &problem->f));
  PetscCall(MeshCreateLocal(mesh, mesh->dim, &problem->trial));
  PetscCall(ElasticityTangent(problem->elasticity, problem->trial, NULL));
  PetscCall(LoadsTangent(problem->loads, 0, problem->trial, problem->elasticity));
  PetscCall(ElasticityMatrix(problem->elasticity, NULL, NULL, &problem->P));
  problem->A = problem->P;
  PetscCall(PetscObjectReference((PetscObject)problem->A));
  PetscCall(MeshCreateVector(mesh, &problem->diagonal));
  PetscCall(VecDuplicate(problem->diagonal, &problem->undeformed));
  PetscCall(MatGetDiagonal(problem->P, problem->undeformed));
  PetscCall(FreeModesCreate(mesh, scene, problem->loads, &problem->modes));
  if (problem->contact)
    PetscCall(FreeBodiesCreate(mesh, scene, problem->loads, problem->contact, problem->modes, &problem->bodies));
  if (problem->bodies) PetscCall(FreeBodiesSprings(problem->bodies, problem->diagonal, &problem->springs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemDestroy - destroys the problem; the scene and the mesh remain.

  Collective

  Input Parameter:
. problem - set to NULL; may be NULL already
@*/
PetscErrorCode ProblemDestroy(Problem *problem)
{
  Problem p = *problem;

  PetscFunctionBeginUser;
  if (!p) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DofSpringsDestroy(&p->damping));
  PetscCall(DofSpringsDestroy(&p->drag));
  PetscCall(ContactSpringsDestroy(&p->springs));
  PetscCall(FreeBodiesDestroy(&p->bodies));
  PetscCall(FluidDestroy(&p->fluids));
  PetscCall(FreeModesDestroy(&p->modes));
  PetscCall(MatDestroy(&p->A));
  PetscCall(VecDestroy(&p->diagonal));
  PetscCall(VecDestroy(&p->undeformed));
  PetscCall(ContactDestroy(&p->contact));
  PetscCall(ElasticityDestroy(&p->elasticity));
  PetscCall(LoadsDestroy(&p->loads));
  PetscCall(PetscFree(p->f));
  PetscCall(PetscFree(p->trial));
  PetscCall(PetscFree(*problem));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemDisplacements - writes the local displacements that belong to free displacements and a load parameter.

  Collective

  Input Parameters:
+ problem - the problem
. x       - free displacements of all ranks (length)
- t       - load parameter of the prescribed displacements

  Output Parameter:
. u - local displacements u[n_nodes*dim] (length), prescribed ones and ghosts included
@*/
PetscErrorCode ProblemDisplacements(Problem problem, Vec x, PetscReal t, PetscReal *u)
{
  PetscFunctionBeginUser;
  PetscCall(LoadsPrescribe(problem->loads, t, u));
  PetscCall(MeshGlobalToLocal(problem->mesh, x, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemSetTrial - makes (x, t) the iterate: its local displacements are in problem->trial afterwards.

  Collective

  Input Parameters:
+ problem - the problem
. x       - free displacements of all ranks (length)
- t       - load parameter
@*/
PetscErrorCode ProblemSetTrial(Problem problem, Vec x, PetscReal t)
{
  PetscFunctionBeginUser;
  PetscCall(ProblemDisplacements(problem, x, t, problem->trial));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemResidual - computes the local residual of elements, loads and contact into problem->f.

  Collective

  Input Parameters:
+ problem   - the problem
. u         - local displacements u[n_nodes*dim] (length)
. t         - load parameter of the loads
- t_contact - load parameter of the contact, that is of its rigid tools

  Output Parameter:
. ok - every element of every rank has a positive determinant of F

  Notes:
  The result ok is the same on all ranks, because line searches act on it without asking the other ranks: a domain error
  on one rank alone would leave the others waiting. problem->force is set to the largest of the norms of element, load
  and contact forces before assembly. The contact state (gaps, status, forces) becomes that of this evaluation. The
  forces of contact springs are not included; ProblemCollectResidual() adds them.
@*/
PetscErrorCode ProblemResidual(Problem problem, const PetscReal *u, PetscReal t, PetscReal t_contact, PetscBool *ok)
{
  PetscReal sum[4] = {0, 0, 0, 0}; /* squares of forces in elements, loads, contact; ranks with an inverted element */
  PetscBool mine;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(problem->f, problem->mesh->n_nodes * problem->mesh->dim));
  TimingBegin(TIMING_ASSEMBLY_ELASTIC);
  ElasticitySetTime(problem->elasticity, t);
  PetscCall(ElasticityResidual(problem->elasticity, u, problem->f, NULL, &sum[0], &mine));
  PetscCall(LoadsResidual(problem->loads, t, u, problem->f, NULL, &sum[1]));
  TimingEnd(TIMING_ASSEMBLY_ELASTIC);
  if (!mine) problem->inverted = problem->mesh->cell_tag[ElasticityInvertedCell(problem->elasticity, &problem->fault)];
  if (problem->contact) {
    TimingBegin(TIMING_ASSEMBLY_CONTACT);
    PetscCall(ContactResidual(problem->contact, u, t_contact, problem->f, NULL, &sum[2]));
    TimingEnd(TIMING_ASSEMBLY_CONTACT);
  }
  sum[3] = mine ? 0 : 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPI_SUM, problem->mesh->comm));
  problem->force = PetscSqrtReal(PetscMax(sum[0], PetscMax(sum[1], sum[2])));
  *ok            = sum[3] > 0 ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemCollectResidual - sums the local residual over the ranks and adds the forces of contact springs and damping.

  Collective

  Input Parameters:
+ problem - after ProblemResidual()
- x       - free displacements (length) at which springs and damping are evaluated

  Output Parameter:
. F - residual of the free dofs (force)
@*/
PetscErrorCode ProblemCollectResidual(Problem problem, Vec x, Vec F)
{
  PetscFunctionBeginUser;
  PetscCall(MeshLocalToGlobal(problem->mesh, problem->f, F));
  PetscCall(ContactSpringsResidual(problem->springs, x, F));
  PetscCall(DofSpringsResidual(problem->damping, x, F));
  PetscCall(DofSpringsResidual(problem->drag, x, F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemEnergy - computes the energy of elements, loads and contact, summed over all ranks.

  Collective

  Input Parameters:
+ problem - the problem
. u       - local displacements u[n_nodes*dim] (length)
. t       - load parameter
- parts   - which parts are summed: ENERGY_ELASTIC, ENERGY_LOADS, ENERGY_CONTACT, ENERGY_VOLUME, joined by |

  Output Parameters:
+ energy - the sum; a follower load has none
- ok     - every element of every rank has a positive determinant of F; true where ENERGY_ELASTIC is not asked for

  Note:
  Each part adds to the sum, which starts from zero here. The energy of contact springs is not included.
@*/
PetscErrorCode ProblemEnergy(Problem problem, const PetscReal *u, PetscReal t, int parts, PetscReal *energy,
                             PetscBool *ok)
{
  PetscReal sum[2] = {0, 0}; /* energy, ranks with an inverted element */
  PetscBool mine   = PETSC_TRUE;

  PetscFunctionBeginUser;
  TimingBegin(TIMING_ASSEMBLY_ELASTIC);
  ElasticitySetTime(problem->elasticity, t);
  if (parts & ENERGY_ELASTIC) PetscCall(ElasticityResidual(problem->elasticity, u, NULL, &sum[0], NULL, &mine));
  if (parts & ENERGY_VOLUME) PetscCall(ElasticityVolumeEnergy(problem->elasticity, u, &sum[0]));
  if (parts & ENERGY_LOADS) PetscCall(LoadsResidual(problem->loads, t, u, NULL, &sum[0], NULL));
  TimingEnd(TIMING_ASSEMBLY_ELASTIC);
  if (problem->contact && (parts & ENERGY_CONTACT)) {
    TimingBegin(TIMING_ASSEMBLY_CONTACT);
    PetscCall(ContactResidual(problem->contact, u, t, NULL, &sum[0], NULL));
    TimingEnd(TIMING_ASSEMBLY_CONTACT);
  }
  sum[1] = mine ? 0 : 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, problem->mesh->comm));
  *energy = sum[0];
  *ok     = sum[1] > 0 ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemSetForm - decides how the tangent keeps its contact part.

  Collective

  Input Parameters:
+ problem - before its first ProblemTangent()
- form    - TANGENT_BORDERED makes problem->A an operator of its own; TANGENT_JOINED is the default

  Note:
  Solvers that hold problem->A must be given the new one.
@*/
PetscErrorCode ProblemSetForm(Problem problem, TangentForm form)
{
  PetscFunctionBeginUser;
  if (form == problem->form) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(form == TANGENT_BORDERED, problem->mesh->comm, PETSC_ERR_ARG_WRONGSTATE,
             "a bordered tangent cannot be joined again");
  PetscCall(MatDestroy(&problem->A));
  PetscCall(SumOperatorCreate(problem->P, &problem->A));
  if (problem->contact) PetscCall(ContactKeepFactors(problem->contact));
  problem->form = form;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The contact part C of the tangent at (u, t), with room for it in P where the tangent is joined. */
static PetscErrorCode ProblemContactTangent(Problem problem, const PetscReal *u, PetscReal t, TangentChange *change)
{
  PetscBool changed;

  PetscFunctionBeginUser;
  TimingBegin(TIMING_ASSEMBLY_CONTACT);
  PetscCall(ContactTangent(problem->contact, u, t, &change->C, &changed));
  change->pattern = (PetscBool)(changed && problem->form == TANGENT_JOINED);
  if (change->pattern) PetscCall(ElasticityMatrixJoin(problem->elasticity, change->C));
  PetscCall(ContactTangentChanges(problem->contact, &change->terms));
  TimingEnd(TIMING_ASSEMBLY_CONTACT);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The 2-norm of the diagonal of the elastic tangent, in which no dof is far stiffer than in the undeformed state. */
static PetscErrorCode ProblemStiffness(Problem problem, PetscReal *stiffness)
{
  const PetscScalar *now, *undeformed;
  PetscReal          sum = 0;
  PetscInt           n;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(problem->diagonal, &n));
  PetscCall(VecGetArrayRead(problem->diagonal, &now));
  PetscCall(VecGetArrayRead(problem->undeformed, &undeformed));
  for (PetscInt i = 0; i < n; i++)
    sum += PetscSqr(PetscMin(PetscAbsReal(now[i]), PROBLEM_STIFFENING * PetscAbsReal(undeformed[i])));
  PetscCall(VecRestoreArrayRead(problem->diagonal, &now));
  PetscCall(VecRestoreArrayRead(problem->undeformed, &undeformed));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPI_SUM, problem->mesh->comm));
  *stiffness = PetscSqrtReal(sum);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemTangent - computes the tangent of elements, loads, contact, contact springs and damping at (u, t) into
  problem->A and problem->P.

  Collective

  Input Parameters:
+ problem   - the problem
. u         - local displacements u[n_nodes*dim] (length)
. reference - the state from which the elements extrapolate stresses; NULL: they have those of u
- t         - load parameter

  Output Parameter:
. change - the contact part, and what is new against the tangent before

  Note:
  problem->stiffness is set to the norm of the diagonal without contact, from which ProblemRoundOff() estimates. Where
  elements are nearly inverted, the diagonal of the undeformed state bounds it.
@*/
PetscErrorCode ProblemTangent(Problem problem, const PetscReal *u, const StressReference *reference, PetscReal t,
                              TangentChange *change)
{
  const PetscBool joined = (PetscBool)(problem->form == TANGENT_JOINED);

  PetscFunctionBeginUser;
  *change = (TangentChange){.C = NULL};
  if (problem->contact) PetscCall(ProblemContactTangent(problem, u, t, change));
  TimingBegin(TIMING_ASSEMBLY_ELASTIC);
  ElasticitySetTime(problem->elasticity, t);
  PetscCall(ElasticityTangent(problem->elasticity, u, reference));
  PetscCall(LoadsTangent(problem->loads, t, u, problem->elasticity));
  PetscCall(ElasticityMatrix(problem->elasticity, joined ? change->C : NULL, problem->diagonal, &problem->P));
  PetscCall(ProblemStiffness(problem, &problem->stiffness));
  TimingEnd(TIMING_ASSEMBLY_ELASTIC);
  PetscCall(ContactSpringsTangent(problem->springs, problem->P));
  PetscCall(DofSpringsTangent(problem->damping, problem->P));
  PetscCall(DofSpringsTangent(problem->drag, problem->P));
  if (problem->tied) change->pattern = PETSC_TRUE; /* no earlier factor serves */
  if (DofSpringsChanged(problem->damping)) change->pattern = PETSC_TRUE;
  if (DofSpringsChanged(problem->drag)) change->pattern = PETSC_TRUE;
  problem->tied = PETSC_FALSE;
  if (!joined) PetscCall(SumOperatorSet(problem->A, change->C));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemRestoreTangent - makes what earlier tangents have left in the contact that of the accepted state.

  Collective

  Input Parameter:
. problem - after ContactRestore(); it has contact
@*/
PetscErrorCode ProblemRestoreTangent(Problem problem)
{
  PetscFunctionBeginUser;
  if (problem->form == TANGENT_BORDERED) PetscCall(SumOperatorSet(problem->A, NULL));
  PetscCall(ContactTangentRestore(problem->contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemForceScale - returns F_ref, the force against which residuals are measured.

  Not collective, the same on all ranks

  Input Parameter:
. problem - after ProblemResidual()

  Note:
  F_ref is the largest norm of the internal, contact and external forces before assembly, over the last evaluation and
  all accepted states.
@*/
PetscReal ProblemForceScale(Problem problem)
{
  return PetscMax(problem->force_so_far, problem->force);
}

/*@
  ProblemRoundOff - estimates what rounding leaves of the residual at the trial displacements.

  Collective

  Input Parameter:
. problem - after ProblemSetTrial() and a ProblemTangent()

  Output Parameter:
. force - a residual norm below this one cannot be told from zero

  Note:
  Finite strains come from deformation gradients near 1. Their rounding is that of displacements as large as an element,
  however small the displacements are.
@*/
PetscErrorCode ProblemRoundOff(Problem problem, PetscReal *force)
{
  PetscReal most = problem->edge;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < problem->mesh->n_nodes * problem->mesh->dim; i++)
    if (!IsPressureNode(problem->mesh, i / problem->mesh->dim)) most = PetscMax(most, PetscAbsReal(problem->trial[i]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPI_MAX, problem->mesh->comm));
  *force = PROBLEM_ROUND_OFF * PETSC_MACHINE_EPSILON * problem->stiffness * most;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemMotion - computes the largest displacement of a node or of a rigid tool from one state to another.

  Collective

  Input Parameters:
+ problem - the problem
. u_0     - local displacements u_0[n_nodes*dim] (length) of the first state
. t_0     - its load parameter
. u       - local displacements of the second state
- t       - its load parameter

  Output Parameter:
. motion - the largest displacement of all ranks (length)
@*/
PetscErrorCode ProblemMotion(Problem problem, const PetscReal *u_0, PetscReal t_0, const PetscReal *u, PetscReal t,
                             PetscReal *motion)
{
  const int dim = problem->mesh->dim;

  PetscFunctionBeginUser;
  *motion = 0;
  for (PetscInt n = 0; n < problem->mesh->n_nodes; n++) {
    PetscReal square = 0;

    for (int d = 0; d < dim && !IsPressureNode(problem->mesh, n); d++)
      square += PetscSqr(u[n * dim + d] - u_0[n * dim + d]);
    *motion = PetscMax(*motion, PetscSqrtReal(square));
  }
  for (int b = 0; b < problem->scene->n_bodies; b++)
    if (problem->scene->bodies[b].rigid) *motion = PetscMax(*motion, LoadsRigidTravel(problem->loads, b, t_0, t));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, motion, 1, MPIU_REAL, MPI_MAX, problem->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemImposedMotion - computes the largest motion that the scene prescribes on the way from a state to t.

  Collective

  Input Parameters:
+ problem - the problem
. u_0     - local displacements u_0[n_nodes*dim] (length) of the state
. t_0     - its load parameter
- t       - load parameter at the end of the way

  Output Parameter:
. motion - the largest displacement (length) of prescribed dofs and rigid tools
@*/
PetscErrorCode ProblemImposedMotion(Problem problem, const PetscReal *u_0, PetscReal t_0, PetscReal t,
                                    PetscReal *motion)
{
  const PetscInt n = problem->mesh->n_nodes * problem->mesh->dim;
  PetscReal     *u;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &u));
  PetscCall(PetscArraycpy(u, u_0, n));
  PetscCall(LoadsPrescribe(problem->loads, t, u));
  PetscCall(ProblemMotion(problem, u_0, t_0, u, t, motion));
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemInOrder - finds out whether a state can be evaluated: no element is inverted and the contact lists reach it.

  Collective

  Input Parameters:
+ problem - after ProblemGatherLists() from (u_0, t_0), if it has contact
. u_0     - local displacements u_0[n_nodes*dim] (length) for which the lists were made
. t_0     - load parameter for which the lists were made
. u       - local displacements of the state
- t       - its load parameter

  Output Parameter:
. ok - the same on all ranks
@*/
PetscErrorCode ProblemInOrder(Problem problem, const PetscReal *u_0, PetscReal t_0, const PetscReal *u, PetscReal t,
                              PetscBool *ok)
{
  PetscReal motion = 0;
  PetscBool mine;

  PetscFunctionBeginUser;
  TimingBegin(TIMING_ASSEMBLY_ELASTIC);
  ElasticitySetTime(problem->elasticity, t);
  PetscCall(ElasticityResidual(problem->elasticity, u, NULL, NULL, NULL, &mine));
  TimingEnd(TIMING_ASSEMBLY_ELASTIC);
  PetscCallMPI(MPI_Allreduce(&mine, ok, sizeof(PetscBool), MPI_BYTE, MPI_BAND, problem->mesh->comm));
  if (problem->contact) PetscCall(ProblemMotion(problem, u_0, t_0, u, t, &motion));
  *ok = (PetscBool)(*ok && motion <= problem->expected);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemGatherLists - makes the contact lists for a way that starts at (u, t).

  Collective

  Input Parameters:
+ problem - it has contact
. u       - local displacements u[n_nodes*dim] (length) of the accepted state
. t       - load parameter of the accepted state
. t_next  - load parameter at the end of the way
- motion  - largest motion (length) for which the lists are to be complete
@*/
PetscErrorCode ProblemGatherLists(Problem problem, const PetscReal *u, PetscReal t, PetscReal t_next, PetscReal motion)
{
  PetscFunctionBeginUser;
  problem->expected = motion;
  TimingBegin(TIMING_SEARCH);
  PetscCall(ContactGather(problem->contact, u, t, t_next, motion));
  TimingEnd(TIMING_SEARCH);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemRenewLists - checks the contact lists at the trial displacements after a solve, and replaces them where they do
  not hold.

  Collective

  Input Parameters:
+ problem        - after ProblemResidual() at the trial displacements; it has contact
. u_0            - local displacements u_0[n_nodes*dim] (length) of the accepted state
. t_0            - load parameter of the accepted state
. t              - load parameter of the trial displacements
. left           - the solve ended because a slave point left its lists; new ones are made without a check
. lag            - part of the usual drift by which offsets may lag before lists count as ones that do not hold
- passing        - no answers are asked for at t, see ContactListsHold()

  Output Parameter:
. hold - a new search finds the same gaps; the old lists were right

  Notes:
  Where the bodies moved further than the lists were made for, the new lists are made for twice the motion: two bodies
  that the lists at the start did not let meet may have passed through each other. Lists that replace others are made
  for PROBLEM_MOTION_SAFETY times the motion, so that they serve a next step of the same length.
@*/
PetscErrorCode ProblemRenewLists(Problem problem, const PetscReal *u_0, PetscReal t_0, PetscReal t, PetscBool left,
                                 PetscReal lag, PetscBool passing, PetscBool *hold)
{
  PetscReal motion, next;

  PetscFunctionBeginUser;
  PetscCall(ProblemMotion(problem, u_0, t_0, problem->trial, t, &motion));
  next = PROBLEM_MOTION_SAFETY * motion;
  if (motion > problem->expected) motion *= 2;
  TimingBegin(TIMING_SEARCH);
  *hold = PETSC_FALSE;
  if (left)
    PetscCall(ContactListsRenew(problem->contact, problem->trial, t, motion));
  else
    PetscCall(
      ContactListsHold(problem->contact, problem->trial, t, motion, PetscMax(motion, next), lag, passing, hold));
  TimingEnd(TIMING_SEARCH);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemReaction - computes the force that supports, their springs and imposed displacements exert on the nodes of a
  group, and its moment about the origin of the scene. The arms are those of the present state, with small strains those
  of the reference state, with which bodies are in balance there.

  Collective

  Input Parameters:
+ problem - after ProblemResidual() at an equilibrium
- group   - nodes of this rank

  Output Parameters:
+ force  - the same on all ranks; force[dim..2] are 0; axisymmetric: over 360 degrees
- moment - the same on all ranks (force times length); in the plane the third one alone; NULL: not asked for

  Note:
  The residual is summed over the prescribed dofs of the group, and the forces of springs over all of its dofs. These
  include dofs on the edges that the group shares with other supported surfaces. Where supports have left, their fading
  forces count.
@*/
PetscErrorCode ProblemReaction(Problem problem, const MeshGroup *group, PetscReal force[3], PetscReal moment[3])
{
  const Mesh       mesh   = problem->mesh;
  const int        dim    = mesh->dim;
  const PetscBool  moves  = (PetscBool)(problem->scene->kinematics != KINEMATICS_SMALL);
  const PetscReal *spring = LoadsSpringForce(problem->loads);
  PetscReal        sum[6] = {0, 0, 0, 0, 0, 0};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < group->n_nodes; i++) {
    PetscReal x[3] = {0, 0, 0}, on_node[3] = {0, 0, 0}, part[3];

    for (int d = 0; d < dim; d++) {
      const PetscInt dof = group->nodes[i] * dim + d;

      on_node[d] = LoadsPrescribed(problem->loads, dof) ? problem->f[dof] : LoadsFadingForce(problem->loads, dof);
      if (spring) on_node[d] += spring[dof];
      x[d] = mesh->coords[dof] + mesh->centre[d] + moves * problem->trial[dof];
      sum[d] += on_node[d];
    }
    Cross(x, on_node, part);
    for (int d = 0; d < 3; d++) sum[3 + d] += part[d];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 6, MPIU_REAL, MPI_SUM, mesh->comm));
  PetscCall(PetscArraycpy(force, sum, 3));
  if (moment) PetscCall(PetscArraycpy(moment, &sum[3], 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemBoltForce - computes the tension in a bolt at the trial state: the work of the stresses in its cells on the
  shortening, over the shortening.

  Collective

  Input Parameters:
+ problem - the problem
- body    - name of a body with pretension

  Output Parameter:
. force - the same on all ranks; in the plane per thickness, axisymmetric over 360 degrees
@*/
PetscErrorCode ProblemBoltForce(Problem problem, const char *body, PetscReal *force)
{
  const Mesh mesh = problem->mesh;
  PetscReal *f;
  PetscBool  ok;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &f));
  PetscCall(ElasticityResidual(problem->elasticity, problem->trial, f, NULL, NULL, &ok));
  *force = f[ToolOfBolt(mesh, body)->node * mesh->dim];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, 1, MPIU_REAL, MPI_SUM, mesh->comm));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProblemIsLinear - returns whether one linear solve gives the answer at any load parameter.

  Not collective, the same on all ranks

  Input Parameter:
. problem - the problem
@*/
PetscBool ProblemIsLinear(Problem problem)
{
  return problem->scene->kinematics == KINEMATICS_SMALL && !problem->contact && !ProblemIsPlastic(problem)
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/*@
  ProblemIsPlastic - returns whether a deformable body is plastic.

  Not collective, the same on all ranks

  Input Parameter:
. problem - the problem
@*/
PetscBool ProblemIsPlastic(Problem problem)
{
  return SceneIsPlastic(problem->scene) ? PETSC_TRUE : PETSC_FALSE;
}

/*@
  ProblemConservative - returns whether all forces have a potential with a least value, so that there is an energy to
  compare and the tangent is symmetric. Where nodes have pressures, equilibrium is a saddle.

  Not collective, the same on all ranks

  Input Parameter:
. problem - the problem
@*/
PetscBool ProblemConservative(Problem problem)
{
  return (PetscBool)(LoadsConservative(problem->loads) && !ContactHasFriction(problem->contact) &&
                     !SceneHasRoutine(problem->scene) && !problem->mesh->saddle);
}

/*@
  ProblemHasFormulation - returns whether a deformable body has elements of a formulation.

  Not collective, the same on all ranks

  Input Parameters:
+ problem     - the problem
- formulation - of the elements; rigid tools have none
@*/
PetscBool ProblemHasFormulation(Problem problem, Formulation formulation)
{
  const Scene scene = problem->scene;
  PetscBool   has   = PETSC_FALSE;

  for (int b = 0; b < scene->n_bodies; b++)
    has = (PetscBool)(has || (!scene->bodies[b].rigid && scene->bodies[b].formulation == formulation));
  return has;
}
