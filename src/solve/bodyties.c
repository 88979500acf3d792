/* Ties of the motions that neither contact holds nor loads drive, and their release. */
#include "freebodiesimpl.h"

/* A tied motion is held by contact if its stiffness is above this part of the largest one of its body, each the force
   over the mean motion of the whole body, with all that is elastic. Even a motion that is held weakly, by a contact a
   tenth as wide as its body, is above, and what the unevenness of meshes does to a neutral one is far below. */
#define FREE_BODIES_STIFF 1e-2
/* A tie is this part of the stiffness of the elements below one slave node. It holds motions that no load drives
   against the unevenness of meshes, and bodies that roll on it at their place. */
#define FREE_BODIES_TIE 1e-2
/* The tie of a motion that has turned out to be unstable is this part of it. Round bodies that lie on each other roll
   off with a stiffness of their force over their radius, which stays below the stiffness of elements times what they
   are flattened by over that radius: such a tie is to hold them until that is a tenth. With the other one a stack of
   three rings between two plates tips over when it is pressed by a seventh of its height, and ends there. */
#define FREE_BODIES_FIRM 1e-1

/* The nodes by which a piece is tied, on the rank that ties it: those of the cell at its middle, or a tool's own.
   Returns their number, 0 on other ranks. */
static PetscInt TieNodes(FreeBodies b, PetscInt p, PetscMPIInt rank, PetscInt nodes[ELEMENT_MAX_NODES])
{
  const Mesh      mesh = b->mesh;
  const MeshTool *tool = b->pieces[p].tool;
  const PetscInt  cell = b->cell[p];
  PetscInt        n    = 0;

  for (int i = 0; tool && i < TOOL_NODES && mesh->node_owner[tool->node] == rank; i++) nodes[n++] = tool->node + i;
  for (PetscInt c = cell < 0 ? 0 : mesh->cell_ptr[cell]; cell >= 0 && c < mesh->cell_ptr[cell + 1]; c++)
    nodes[n++] = mesh->cell_nodes[c];
  return n;
}

/* A tie that measures coordinate k of the motions at displacements u, in lengths, by some nodes of its piece: the
   motion nearest to that of these nodes. */
static PetscErrorCode MakeTie(FreeBodies b, const PetscReal *u, int k, SpringTie *tie)
{
  const Mesh       mesh  = b->mesh;
  const PetscInt   p     = b->owner[k];
  const FreePiece *piece = &b->pieces[p];
  const PetscInt  *dofs;
  PetscInt         nodes[ELEMENT_MAX_NODES], n;
  double           gram[RIGID_MODES * RIGID_MODES] = {0}, factor[RIGID_MODES * RIGID_MODES], row[RIGID_MODES];
  int              first = k, m = piece->n_free;
  PetscMPIInt      owner;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &owner));
  n    = TieNodes(b, p, owner, nodes);
  *tie = (SpringTie){.motion    = k,
                     .unstable  = (PetscBool)(b->state[k] == MOTION_FIRM),
                     .stiffness = (b->state[k] == MOTION_FIRM ? FREE_BODIES_FIRM : FREE_BODIES_TIE) * b->stiffness[p]};
  PetscCall(MeshGetGlobalDofs(mesh, &dofs));
  while (first > 0 && b->owner[first - 1] == p) first--;
  if (n) {
    for (PetscInt c = 0; c < n; c++)
      for (int d = 0; d < mesh->dim; d++) {
        FreeBodiesRow(b, nodes[c], u, d, first, m, row);
        RigidAddRow(m, row, 1, gram);
      }
    RigidCholesky(m, gram, factor);
    for (PetscInt c = 0; c < n; c++)
      for (int d = 0; d < mesh->dim; d++) {
        const PetscInt dof = dofs[nodes[c] * mesh->dim + d];

        if (dof < 0) continue;
        FreeBodiesRow(b, nodes[c], u, d, first, m, row);
        RigidSolve(m, factor, row);
        tie->dof[tie->n]     = dof;
        tie->value[tie->n++] = piece->size * row[k - first];
      }
  } else
    owner = -1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &owner, 1, MPI_INT, MPI_MAX, mesh->comm));
  PetscCallMPI(MPI_Bcast(&tie->n, 1, MPIU_INT, owner, mesh->comm));
  PetscCallMPI(MPI_Bcast(tie->dof, (PetscMPIInt)tie->n, MPIU_INT, owner, mesh->comm));
  PetscCallMPI(MPI_Bcast(tie->value, (PetscMPIInt)tie->n, MPIU_REAL, owner, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Drops those of the motions tied[n] that the loads at t drive though a contact of stiffness gram[n][n] does not hold
   them, and translations of pieces without any contact. */
static PetscErrorCode DropDriven(FreeBodies b, const PetscReal *u, PetscReal t, const double gram[], PetscBool tied[])
{
  const int  n = b->n;
  double    *free;
  int       *pivot, loose;
  PetscBool *drives;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n * n, &free, n, &pivot, n, &drives));
  PetscCall(FreeBodiesBasis(b, gram, FREE_BODIES_HELD, &loose, free, pivot));
  PetscCall(FreeBodiesDriven(b, u, t, FREE_BODIES_UNEVEN, loose, free, drives));
  for (int k = 0; k < n; k++) {
    tied[k] = (PetscBool)(tied[k] && (FreeBodiesInContact(b, b->owner[k], gram) || FreeBodiesTurns(b, k)));
    for (int f = 0; f < loose; f++)
      if (drives[f] && free[f * n + k] != 0) tied[k] = PETSC_FALSE;
  }
  PetscCall(PetscFree3(free, pivot, drives));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to the motions tied[n] those that neither they nor contact hold and no load drives at (u, t). Drops those that a
   load drives. begins: what contact came to hold in a step before is not among them while its body has contact.
   touching: what touches holds, too. */
static PetscErrorCode FindTied(FreeBodies b, const PetscReal *u, PetscReal t, PetscReal t_loads, PetscBool begins,
                               PetscBool touching, PetscBool tied[])
{
  const int  n = b->n;
  double    *gram, *free;
  int       *pivot, loose;
  PetscBool *drives;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n * n, &gram, n * n, &free, n, &pivot, n, &drives));
  PetscCall(ContactHoldActiveSet(b->contact, PETSC_TRUE, touching)); /* fresh lists may have opened it a little */
  PetscCall(FreeBodiesContactGram(b, u, t, touching, gram));
  PetscCall(ContactHoldActiveSet(b->contact, PETSC_FALSE, PETSC_FALSE));
  PetscCall(DropDriven(b, u, t_loads, gram, tied));
  for (int k = 0; k < n; k++) gram[k * n + k] += tied[k] ? 1 : 0; /* the stiffness of the stiffest contact */
  PetscCall(FreeBodiesBasis(b, gram, FREE_BODIES_HELD, &loose, free, pivot));
  PetscCall(FreeBodiesDriven(b, u, t_loads, FREE_BODIES_UNEVEN, loose, free, drives));
  for (int f = 0; f < loose; f++) {
    const int k = pivot[f];

    if (drives[f]) continue;
    tied[k] =
      (PetscBool)(tied[k] || (FreeBodiesInContact(b, b->owner[k], gram) ? !(begins && b->state[k] == MOTION_CONTACT)
                                                                        : FreeBodiesTurns(b, k)));
  }
  PetscCall(PetscFree4(gram, free, pivot, drives));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeBodiesTie - ties the motions that neither contact holds nor loads drive.

  Collective

  Input Parameters:
+ b        - the bodies
. u        - local displacements u[n_nodes*dim] (length), within the reach of the contact's lists
. t        - load parameter there
. t_loads  - load parameter at which the loads are taken
. begins   - a load step begins: what was tied in the accepted state stays tied, otherwise what is tied now
- touching - the bodies were moved into contact: what touches holds, too

  Output Parameters:
+ springs - their ties
- changed - other motions than before are tied

  Note:
  Such a motion stays as it is, without changing anything else. Without a tie the unevenness of the meshes would drive
  it, far beyond what a linear step can follow. Of a body without any contact only rotations are tied, so that a tool
  can push it before it. FreeBodiesRelease() judges whether contact has come to hold it.
@*/
PetscErrorCode FreeBodiesTie(FreeBodies b, const PetscReal *u, PetscReal t, PetscReal t_loads, PetscBool begins,
                             PetscBool touching, ContactSprings springs, PetscBool *changed)
{
  int        m = 0;
  PetscBool *tied;
  SpringTie *ties;

  PetscFunctionBeginUser;
  *changed = PETSC_FALSE;
  if (!b->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FreeBodiesCentre(b, u));
  PetscCall(PetscMalloc2(b->n, &ties, b->n, &tied));
  for (int k = 0; k < b->n; k++)
    tied[k] = begins ? (PetscBool)(b->state[k] >= MOTION_TIED) : ContactSpringsHaveTie(springs, k);
  PetscCall(FindTied(b, u, t, t_loads, begins, touching, tied));
  for (int k = 0; k < b->n; k++) {
    *changed = (PetscBool)(*changed || tied[k] != ContactSpringsHaveTie(springs, k));
    if (tied[k]) PetscCall(MakeTie(b, u, k, &ties[m++]));
  }
  PetscCall(ContactSpringsSetTies(springs, m, ties));
  PetscCall(PetscFree2(ties, tied));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stiffness of what holds motion k at displacements u, but for its own tie: a force along the motion over the mean
   motion of the whole body that it causes. */
static PetscErrorCode MotionStiffness(FreeBodies b, const PetscReal *u, int k, KSP ksp, ContactSprings springs,
                                      PetscReal *stiffness)
{
  SpringTie   tie;
  Mat         P;
  Vec         force, x;
  PetscScalar stretch;
  PetscReal   mean = 0;
  PetscInt    first, end;

  PetscFunctionBeginUser;
  PetscCall(MakeTie(b, u, k, &tie));
  PetscCall(KSPGetOperators(ksp, NULL, &P));
  PetscCall(MatCreateVecs(P, &x, &force));
  PetscCall(VecZeroEntries(force));
  PetscCall(VecGetOwnershipRange(force, &first, &end));
  for (PetscInt i = 0; i < tie.n; i++)
    if (tie.dof[i] >= first && tie.dof[i] < end) PetscCall(VecSetValue(force, tie.dof[i], tie.value[i], ADD_VALUES));
  PetscCall(VecAssemblyBegin(force));
  PetscCall(VecAssemblyEnd(force));
  PetscCall(KSPSolve(ksp, force, x));
  PetscCall(VecDot(force, x, &stretch));
  PetscCall(FreeBodiesMeanMotion(b, u, x, k, &mean));
  *stiffness = (1 - (ContactSpringsHaveTie(springs, k) ? tie.stiffness * PetscRealPart(stretch) : 0)) / mean;
  PetscCall(VecDestroy(&force));
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The stiffness of all motions of pieces with ties, and the largest one of each of these pieces. Where all motions of a
   piece are tied, the elements below a slave node tell how stiff a contact may be. */
static PetscErrorCode FindMotionStiffness(FreeBodies b, const PetscReal *u, KSP ksp, ContactSprings springs,
                                          PetscReal *stiffness, PetscReal *largest)
{
  PetscBool *tied, *others; /* of each piece */

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(b->n_pieces, &tied, b->n_pieces, &others));
  for (int k = 0; k < b->n; k++) (ContactSpringsHaveTie(springs, k) ? tied : others)[b->owner[k]] = PETSC_TRUE;
  for (PetscInt p = 0; p < b->n_pieces; p++) largest[p] = others[p] ? 0 : b->stiffness[p];
  for (int k = 0; k < b->n; k++) {
    stiffness[k] = 0;
    if (tied[b->owner[k]]) PetscCall(MotionStiffness(b, u, k, ksp, springs, &stiffness[k]));
    largest[b->owner[k]] = PetscMax(largest[b->owner[k]], stiffness[k]);
  }
  PetscCall(PetscFree2(tied, others));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether a tied motion of this stiffness goes on by itself, whose body's largest one is given. One that did so
   before stays so until it is held a little. */
static PetscBool IsUnstable(FreeBodies b, int k, PetscReal stiffness, PetscReal largest)
{
  return (PetscBool)(stiffness < (b->state[k] == MOTION_FIRM ? 0 : -FREE_BODIES_STIFF * largest));
}

/*@
  FreeBodiesRelease - releases the ties of motions that contact has come to hold, or along which a load acts.

  Collective

  Input Parameters:
+ b     - the bodies
. u     - local displacements u[n_nodes*dim] (length) of the solution
. scale - of the forces
- ksp   - it solves with the tangent at the solution, springs and ties included

  Input/Output Parameter:
. springs - their ties

  Output Parameters:
+ any      - one was released
- unstable - least stiffness of a motion that stays tied, as a part of that of its body, with its sign turned; 0 where
             none is below 0

  Note:
  Contact holds a motion if the body resists a force along it. The shape of the contact does not tell: under a round
  body the faces have a slope, but the body rolls over them, as its shape gives way everywhere alike. What is left is
  the unevenness of meshes, of either sign. A motion that is more unstable than that has a firm tie from the next step
  on.
@*/
PetscErrorCode FreeBodiesRelease(FreeBodies b, const PetscReal *u, PetscReal scale, KSP ksp, ContactSprings springs,
                                 PetscBool *any, PetscReal *unstable)
{
  int        kept = 0, *motion;
  PetscReal *stiffness, *largest;

  PetscFunctionBeginUser;
  PetscCall(FreeBodiesCentre(b, u));
  PetscCall(PetscMalloc3(b->n, &motion, b->n, &stiffness, b->n_pieces, &largest));
  *unstable = 0;
  PetscCall(FindMotionStiffness(b, u, ksp, springs, stiffness, largest));
  for (int k = 0; k < b->n; k++) {
    const SpringTie *tie;
    PetscReal        force = 0;

    if (!ContactSpringsHaveTie(springs, k)) continue;
    ContactSpringsGetTie(springs, k, &tie, &force);
    PetscCall(PetscInfo(NULL, "tie of motion %d: stiffness %g, of the body %g, force %g of %g\n", k,
                        (double)stiffness[k], (double)largest[b->owner[k]], (double)force, (double)scale));
    if (!(stiffness[k] > FREE_BODIES_STIFF * largest[b->owner[k]]) &&
        !(PetscAbsReal(force) > FREE_BODIES_UNEVEN * scale)) {
      *unstable = PetscMax(*unstable, -stiffness[k] / largest[b->owner[k]]);
      PetscCall(ContactSpringsMark(springs, k, IsUnstable(b, k, stiffness[k], largest[b->owner[k]])));
      motion[kept++] = k;
    }
  }
  PetscCall(ContactSpringsRelease(springs, kept, motion, any));
  PetscCall(PetscFree3(motion, stiffness, largest));
  PetscFunctionReturn(PETSC_SUCCESS);
}
