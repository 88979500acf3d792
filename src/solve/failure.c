/* Where a solve failed: the nodes with the largest residuals. */
#include "solve/failure.h"

/* Square of the residual's free components at each owned node. It is 0 at other nodes and where it is not a number. */
static PetscErrorCode NodeSquares(Mesh mesh, Loads loads, const PetscReal *f, PetscReal *square)
{
  const int   dim = mesh->dim;
  PetscReal  *sum;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscMalloc1(mesh->n_nodes * dim, &sum));
  PetscCall(PetscArraycpy(sum, f, mesh->n_nodes * dim));
  PetscCall(MeshSumNodes(mesh, dim, sum));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    square[n] = 0;
    for (int d = 0; d < dim && mesh->node_owner[n] == rank; d++)
      if (!LoadsPrescribed(loads, n * dim + d)) square[n] += PetscSqr(sum[n * dim + d]);
    if (PetscIsInfOrNanReal(square[n])) square[n] = 0;
  }
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the node with the largest square of all ranks and sets its square to 0. *found: there was one. */
static PetscErrorCode TakeLargest(Mesh mesh, Contact contact, PetscReal *square, FailureNode *node, PetscBool *found)
{
  PetscReal values[6] = {0, 0, 0, 0, 0, NAN}; /* tag, X, residual, gap */
  PetscInt  at        = -1;
  struct {
    double value;
    int    rank;
  } mine = {0, 0}, most;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &mine.rank));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    if (!(square[n] > mine.value)) continue;
    mine.value = square[n];
    at         = n;
  }
  PetscCallMPI(MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE_INT, MPI_MAXLOC, mesh->comm));
  *found = most.value > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (*found && most.rank == mine.rank) {
    values[0] = (PetscReal)mesh->node_tag[at];
    MeshNodePlace(mesh, at, &values[1]);
    values[4]  = PetscSqrtReal(square[at]);
    values[5]  = contact ? ContactNodeGap(contact, at) : NAN;
    square[at] = 0;
  }
  PetscCallMPI(MPI_Bcast(values, 6, MPIU_REAL, most.rank, mesh->comm));
  *node = (FailureNode){.place    = {.tag = (PetscInt)values[0], .X = {values[1], values[2], values[3]}},
                        .residual = values[4],
                        .gap      = values[5]};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FailureLocate - finds the nodes that are farthest from equilibrium.

  Collective

  Input Parameters:
+ mesh     - the mesh
. loads    - prescribed dofs have no residual
. contact  - for the gaps of these nodes; may be NULL
. f        - contributions of this rank to the residual (force) of the failed iterate, f[n_nodes*dim]
- inverted - gmsh's tag of an element of this rank that was turned inside out, or -1

  Output Parameter:
. failure - the same on all ranks
@*/
PetscErrorCode FailureLocate(Mesh mesh, Loads loads, Contact contact, const PetscReal *f, PetscInt inverted,
                             Failure *failure)
{
  PetscReal *square;
  PetscBool  found = PETSC_TRUE;

  PetscFunctionBeginUser;
  *failure = (Failure){.n = 0};
  PetscCallMPI(MPI_Allreduce(&inverted, &failure->inverted, 1, MPIU_INT, MPI_MAX, mesh->comm));
  PetscCall(PetscMalloc1(mesh->n_nodes, &square));
  PetscCall(NodeSquares(mesh, loads, f, square));
  while (found && failure->n < FAILURE_NODES) {
    PetscCall(TakeLargest(mesh, contact, square, &failure->node[failure->n], &found));
    failure->n += found;
  }
  PetscCall(PetscFree(square));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FailureText - writes the inverted element and the first node in one phrase, for a message.

  Not collective

  Input Parameters:
+ failure - from FailureLocate()
- size    - of the text

  Output Parameter:
. text - for example "largest residual at node 17 (1, 2, 3)"
@*/
void FailureText(const Failure *failure, char *text, size_t size)
{
  const ContactPlace *place        = &failure->node[0].place;
  char                element[128] = "";

  if (failure->inverted >= 0)
    snprintf(element, sizeof(element), "element %lld was inverted%s on the way%s", (long long)failure->inverted,
             failure->enhanced ? ", or its enhanced strains found no equilibrium," : "", failure->n ? "; " : "");
  if (failure->n)
    snprintf(text, size, "%slargest residual at node %lld (%g, %g, %g)", element, (long long)place->tag,
             (double)place->X[0], (double)place->X[1], (double)place->X[2]);
  else
    snprintf(text, size, "%s", element[0] ? element : "no node is out of balance");
}
