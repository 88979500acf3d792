/* The softest motion in a linear step, by inverse iterations, and how far a step turns cells. */
#include "bodies/tools.h"
#include "mesh/meshdofs.h"
#include "mesh/pressurenodes.h"
#include "modelimpl.h"

/* Inverse iterations that start from a step, at least. The step itself is one more: it is a solve, too. */
enum { SOFT_ITERATIONS = 2 };
/* More of them are made until the motion turns by less than this, but not more than these: each one takes a tenth or
   less of what is not the softest motion, or there is none. */
#define SOFT_SAME 1e-2
enum { SOFT_MOST = 8 };

/*@
  ModelLargestTurn - finds how far a step turns or stretches a cell, or turns a rigid tool.

  Collective

  Input Parameters:
+ model - the model
. u     - local displacements u[n_nodes*dim] (length) at the start of the step
- v     - those at its end

  Output Parameter:
. turn - largest motion of the two ends of a cell's edge against each other, over the length of the edge, or free
         rotation of a tool (radians); of all ranks
@*/
PetscErrorCode ModelLargestTurn(Model model, const PetscReal *u, const PetscReal *v, PetscReal *turn)
{
  const Mesh mesh = model->mesh;

  PetscFunctionBeginUser;
  *turn = ToolsTurn(mesh, u, v, NULL);
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const Element  *element = ElementGet(mesh->cell_type[c]);
    const PetscInt *nodes   = &mesh->cell_nodes[mesh->cell_ptr[c]];

    for (int e = 0; e < element->edges; e++) {
      const PetscInt a = nodes[element->edge_corners[e][0]] * mesh->dim,
                     b = nodes[element->edge_corners[e][1]] * mesh->dim;
      PetscReal motion = 0, length = 0;

      for (int d = 0; d < mesh->dim; d++) {
        motion += PetscSqr((v[b + d] - v[a + d]) - (u[b + d] - u[a + d]));
        length += PetscSqr(mesh->coords[b + d] - mesh->coords[a + d]);
      }
      *turn = PetscMax(*turn, PetscSqrtReal(motion / length));
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, turn, 1, MPIU_REAL, MPI_MAX, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelDropPressures - copies a vector of the free dofs without the pressures of nodes.

  Collective

  Input Parameters:
+ model - the model
- from  - the vector

  Output Parameter:
. to - its copy, 0 for pressures
@*/
PetscErrorCode ModelDropPressures(Model model, Vec from, Vec to)
{
  const Mesh     mesh = model->mesh;
  const PetscInt n    = mesh->n_nodes * mesh->dim;
  PetscReal     *f;

  PetscFunctionBeginUser;
  if (!mesh->saddle) {
    PetscCall(VecCopy(from, to));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscCalloc1(n, &f));
  PetscCall(MeshGlobalToLocal(mesh, from, f));
  for (PetscInt i = 0; i < n; i++)
    if (IsPressureNode(mesh, i / mesh->dim)) f[i] = 0;
  PetscCall(MeshCollectFree(mesh, f, to));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Separates two motions that are equally soft, one of which has a stiffness below 0: inverse iterations go to and fro
   between their sums, and held along a sum a body is free along the difference. From b, of norm 1, and what the tangent
   gives for it as a force, v, and without pressures c, follows the plane of the two (Rayleigh and Ritz). b becomes the
   softer of them, v and c what the tangent gives for it. inverse: b . c. */
static PetscErrorCode SeparateMotions(Model model, Vec b, Vec v, Vec c, PetscReal *inverse)
{
  PetscReal across, own, off, mean, root, softer, first, second;
  Vec       q, z, w;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(b, &q));
  PetscCall(VecDuplicate(b, &z));
  PetscCall(VecDuplicate(b, &w));
  PetscCall(VecWAXPY(q, -*inverse, b, c));
  PetscCall(VecNormalize(q, &across));
  PetscCall(ModelHeldSolve(model, q, z));
  PetscCall(ModelDropPressures(model, z, w));
  PetscCall(VecDotRealPart(b, w, &off));
  PetscCall(VecDotRealPart(q, w, &own));
  off    = (off + across) / 2; /* they differ only where loads follow the surface */
  mean   = (*inverse + own) / 2;
  root   = PetscSqrtReal(PetscSqr((*inverse - own) / 2) + PetscSqr(off));
  softer = mean + (mean >= 0 ? root : -root);
  first  = PetscAbsReal(*inverse - softer) > PetscAbsReal(own - softer) ? off : softer - own;
  second = PetscAbsReal(*inverse - softer) > PetscAbsReal(own - softer) ? softer - *inverse : off;
  root   = PetscSqrtReal(PetscSqr(first) + PetscSqr(second));
  if (root > 0) {
    PetscCall(VecAXPBY(v, second / root, first / root, z));
    PetscCall(VecAXPBY(b, second / root, first / root, q));
    PetscCall(ModelDropPressures(model, v, c));
    PetscCall(VecDotRealPart(b, c, inverse));
  }
  PetscCall(VecDestroy(&w));
  PetscCall(VecDestroy(&z));
  PetscCall(VecDestroy(&q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelSoftMotion - finds the softest motion in a linear step, besides those that are held.

  Collective

  Input Parameters:
+ model - after a solve with the tangent at the step's start
- y     - the step: free displacements (length)

  Output Parameters:
+ v         - the motion, whose displacements have the norm 1
. stiffness - of the tangent along it; below 0 where the step leads to or from a saddle
- part      - of the motion in the step (length)

  Notes:
  Rubber that can roll or slide along rigid walls with next to no energy has one motion that is softer than all others
  by orders of magnitude. Newton's step may be much too long in this one motion alone, while the rest of the step is
  right. The motion keeps the volume where nodes have pressures.
@*/
PetscErrorCode ModelSoftMotion(Model model, Vec y, Vec v, PetscReal *stiffness, PetscReal *part)
{
  PetscReal norm = 0, inverse = 0;
  Vec       b, c;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(y, &b));
  PetscCall(VecDuplicate(y, &c));
  PetscCall(VecCopy(y, v));
  for (int i = 0; i < SOFT_ITERATIONS || (i < SOFT_MOST && PetscAbsReal(inverse) < (1 - SOFT_SAME) * norm); i++) {
    PetscCall(ModelDropPressures(model, v, b));
    PetscCall(VecNorm(b, NORM_2, &norm));
    if (norm > 0) PetscCall(VecScale(b, 1 / norm));
    PetscCall(ModelHeldSolve(model, b, v));
    PetscCall(VecDotRealPart(v, b, &inverse));
    PetscCall(ModelDropPressures(model, v, c));
    PetscCall(VecNorm(c, NORM_2, &norm));
  }
  if (norm > 0 && PetscAbsReal(inverse) < (1 - SOFT_SAME) * norm) {
    PetscCall(SeparateMotions(model, b, v, c, &inverse));
    PetscCall(VecNorm(c, NORM_2, &norm));
  }
  PetscCall(VecCopy(c, b));
  PetscCall(VecDestroy(&c));
  PetscCall(VecDotRealPart(b, y, part));
  PetscCall(VecScale(v, norm > 0 ? 1 / norm : 0));
  *part      = norm > 0 ? *part / norm : 0;
  *stiffness = inverse != 0 ? 1 / inverse : 0;
  PetscCall(VecDestroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelSoftPart - finds the part of a linear step that is its softest motion.

  Collective

  Input Parameters:
+ model - after a solve with the tangent at the step's start
- y     - the step: free displacements (length)

  Output Parameters:
+ soft      - that part (length)
- stiffness - of the tangent along it; below 0 where it leads to or from a saddle
@*/
PetscErrorCode ModelSoftPart(Model model, Vec y, Vec soft, PetscReal *stiffness)
{
  PetscReal part;

  PetscFunctionBeginUser;
  PetscCall(ModelSoftMotion(model, y, soft, stiffness, &part));
  PetscCall(VecScale(soft, part));
  PetscFunctionReturn(PETSC_SUCCESS);
}
