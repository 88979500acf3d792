#include "solve/failure.h"

/* Squares of the residual's free components, by owned node; 0 elsewhere and where it is no number */
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

/* The node of the largest square of all ranks, which is then taken out; *found: there was one */
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
  *node = (FailureNode){
    .place    = {.tag = (PetscInt)values[0], .X = {values[1], values[2], values[3]}},
    .residual = values[4],
    .gap      = values[5]
  };
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  FailureLocate - the nodes that are farthest from equilibrium

  Collective

  Input Parameters:
+ mesh, loads - what is prescribed has no residual
. contact     - for the gaps of these nodes, or NULL
. f           - n_nodes*dim: this rank's contributions to the residual (forces)
- inverted    - gmsh's tag of an element of this rank that was turned inside out, or -1

  Output Parameter:
. failure - the same on all ranks
*/
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

/* FailureText - element and first node in one phrase, into text[size]. Not collective. */
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
