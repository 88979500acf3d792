/* The preconditioner of the iterative solver: algebraic multigrid for the bodies, then a direct solve for the contact
   interface.

   Multigrid alone cannot smooth what stiff penalties couple across two meshes; its iterations grow with the square root
   of the penalty. The dofs that contact couples are therefore solved for directly. Each rank solves for its own with
   near ones of other ranks. Surfaces are thin, and so their factors are small.

   Multigrid needs whole nodes. It works on a copy of the matrix in which constrained dofs have rows of their own, and
   gets the rigid-body modes of each node. Its coarse spaces are those of the bodies without contact, so that each
   aggregate belongs to one body. Contact is added to the coarse matrices afterwards, softer than it is
   (coarsecontact.h). The coarse spaces stay for the whole run, and of bodies whose stiffness stays the coarse matrices,
   too.

   Create it once for a KSP. Call MultigridSetContact() before each new operator, and MultigridRenew() at the
   start of a step. Solutions then depend on earlier solves within the tolerance of the linear solves only. */
#pragma once
#include "mesh/mesh.h"

typedef struct _n_Multigrid *Multigrid;

PetscErrorCode MultigridCreate(Mesh, PetscBool axisymmetric, PetscBool symmetric, PetscBool constant, KSP, Multigrid *);
PetscErrorCode MultigridDestroy(Multigrid *);
PetscErrorCode MultigridSetContact(Multigrid, Mat C);
PetscErrorCode MultigridRelease(Multigrid);
PetscErrorCode MultigridRenew(Multigrid);
