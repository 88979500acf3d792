/* Preconditioner of the iterative solver: algebraic multigrid for the bodies, a direct solve for the contact interface,
   one after the other.

   Multigrid alone cannot smooth what stiff penalties tie across two meshes (its iterations grow with the square root of
   the penalty). So the dofs that contact couples are solved with directly, by each rank its own with near ones of
   others; the surfaces are thin, and so are the factors. Multigrid wants whole nodes: it works on a copy of the matrix
   in which constrained dofs have rows of their own, and knows each node's rigid-body modes. */
#pragma once
#include "mesh/mesh.h"

typedef struct _n_Multigrid *Multigrid;

/* Makes such a preconditioner for a KSP of matrices over the mesh's free dofs. Collective. */
PetscErrorCode MultigridCreate(Mesh, PetscBool axisymmetric, PetscBool symmetric, KSP, Multigrid *);
PetscErrorCode MultigridDestroy(Multigrid *);
/* The contact part of the operator that the KSP is set up for next: its non-zero rows are the interface. changed: the
 * operator has a new pattern. Collective.
 */
PetscErrorCode MultigridSetContact(Multigrid, Mat C, PetscBool changed);
/* The next operator is a new beginning: multigrid is made for it, so that what follows does not depend on what was
 * before. Not collective. */
PetscErrorCode MultigridRenew(Multigrid);
