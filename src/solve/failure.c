/* Where a solve failed: the nodes with the largest residuals. */
#include "base/largest.h"
#include "solve/failure.h"
#include "kernels/umat.h"

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

/* Body of a local node: that of the first cell of this rank that has it, -1 where there is none. */
static int NodeBody(Mesh mesh, PetscInt node)
{
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt k = mesh->cell_ptr[c]; k < mesh->cell_ptr[c + 1]; k++)
      if (mesh->cell_nodes[k] == node) return mesh->cell_body[c];
  return -1;
}

/* Finds the node with the largest square of all ranks and sets its square to 0. *found: there was one. */
static PetscErrorCode TakeLargest(Mesh mesh, Contact contact, PetscReal *square, FailureNode *node, PetscBool *found)
{
  PetscReal   values[7] = {0, 0, 0, 0, 0, NAN, -1}; /* tag, X, residual, gap, body */
  PetscInt    at        = -1;
  PetscReal   largest   = 0, most;
  PetscMPIInt rank;
  PetscBool   here;

  PetscFunctionBeginUser;
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    if (!(square[n] > largest)) continue;
    largest = square[n];
    at      = n;
  }
  PetscCall(LargestOfRanks(mesh->comm, largest, &most, &rank, &here));
  *found = most > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (*found && here) {
    values[0] = (PetscReal)mesh->node_tag[at];
    MeshNodePlace(mesh, at, &values[1]);
    values[4]  = PetscSqrtReal(square[at]);
    values[5]  = contact ? ContactNodeGap(contact, at) : NAN;
    values[6]  = NodeBody(mesh, at);
    square[at] = 0;
  }
  PetscCallMPI(MPI_Bcast(values, 7, MPIU_REAL, rank, mesh->comm));
  *node = (FailureNode){.place    = {.tag = (PetscInt)values[0], .X = {values[1], values[2], values[3]}},
                        .residual = values[4],
                        .gap      = values[5],
                        .body     = (int)values[6]};
  PetscCall(ContactNearestPair(contact, mesh->comm, node->place.X, &node->pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Smallest ratio of the distance of two corners of a cell to that before any load. */
static PetscReal CellSqueeze(Mesh mesh, PetscInt c, const PetscReal *u)
{
  const PetscInt *nodes   = &mesh->cell_nodes[mesh->cell_ptr[c]];
  const int       corners = ElementGet(mesh->cell_type[c])->corners, dim = mesh->dim;
  PetscReal       least = PETSC_MAX_REAL;

  for (int a = 0; a < corners; a++) {
    for (int b = 0; b < a; b++) {
      PetscReal before = 0, now = 0;

      for (int d = 0; d < dim; d++) {
        const PetscReal X = mesh->coords[nodes[a] * dim + d] - mesh->coords[nodes[b] * dim + d];

        before += PetscSqr(X);
        now += PetscSqr(X + u[nodes[a] * dim + d] - u[nodes[b] * dim + d]);
      }
      least = PetscMin(least, now / before);
    }
  }
  return PetscSqrtReal(least);
}

/* Finds the body with the cell that is squeezed most. */
static PetscErrorCode LocateSqueeze(Mesh mesh, const PetscReal *u, Failure *failure)
{
  struct {
    double ratio;
    int    body;
  } mine = {PETSC_MAX_REAL, 0}, least;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscReal ratio = CellSqueeze(mesh, c, u);

    if (ratio >= mine.ratio) continue;
    mine.ratio = ratio;
    mine.body  = mesh->cell_body[c];
  }
  PetscCallMPI(MPI_Allreduce(&mine, &least, 1, MPI_DOUBLE_INT, MPI_MINLOC, mesh->comm));
  failure->squeeze       = least.ratio;
  failure->squeezed_body = least.body;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the inverted element of largest tag of all ranks, its body, and what a routine of the user did there. */
static PetscErrorCode LocateInverted(Mesh mesh, PetscInt inverted, int fault, Failure *failure)
{
  int mine[2] = {-1, 0}, all[2]; /* body, fault */

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(&inverted, &failure->inverted, 1, MPIU_INT, MPI_MAX, mesh->comm));
  for (PetscInt c = 0; c < mesh->n_cells && failure->inverted >= 0; c++)
    if (mesh->cell_tag[c] == failure->inverted) mine[0] = mesh->cell_body[c];
  if (inverted >= 0 && inverted == failure->inverted) mine[1] = fault;
  PetscCallMPI(MPI_Allreduce(mine, all, 2, MPI_INT, MPI_MAX, mesh->comm));
  failure->inverted_body = all[0];
  failure->routine       = UmatTell(all[1], &failure->point);
  if (!failure->routine) failure->point = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FailureLocate - finds the nodes that are farthest from equilibrium.

  Collective

  Input Parameters:
+ mesh     - the mesh
. loads    - prescribed dofs have no residual
. contact  - for the gaps of these nodes; may be NULL
. u        - local displacements of the last accepted state, u[n_nodes*dim] (length)
. f        - contributions of this rank to the residual (force) of the failed iterate, f[n_nodes*dim]
. inverted - gmsh's tag of an element of this rank that was turned inside out, or -1
- fault    - of a routine of the user there, from ElasticityInvertedCell()

  Output Parameter:
. failure - the same on all ranks
@*/
PetscErrorCode FailureLocate(Mesh mesh, Loads loads, Contact contact, const PetscReal *u, const PetscReal *f,
                             PetscInt inverted, int fault, Failure *failure)
{
  PetscReal *square;
  PetscBool  found = PETSC_TRUE;

  PetscFunctionBeginUser;
  *failure = (Failure){.n = 0};
  PetscCall(LocateInverted(mesh, inverted, fault, failure));
  PetscCall(LocateSqueeze(mesh, u, failure));
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
+ scene   - names bodies and pairs
. failure - from FailureLocate()
- size    - of the text

  Output Parameter:
. text - for example "largest residual at node 17 (1, 2, 3) of 'plate', pair 'crown'"
@*/
void FailureText(Scene scene, const Failure *failure, char *text, size_t size)
{
  const FailureNode  *node         = &failure->node[0];
  const ContactPlace *place        = &node->place;
  char                element[256] = "", of[256] = "", at[256] = "";

  if (failure->point)
    snprintf(element, sizeof(element), "the routine umat %s in element %lld, point %d of '%s'%s", failure->routine,
             (long long)failure->inverted, failure->point, scene->bodies[PetscMax(0, failure->inverted_body)].name,
             failure->n ? "; " : "");
  else if (failure->inverted >= 0)
    snprintf(element, sizeof(element), "element %lld of '%s' was inverted%s on the way%s", (long long)failure->inverted,
             scene->bodies[PetscMax(0, failure->inverted_body)].name,
             failure->enhanced ? ", or its enhanced strains found no equilibrium," : "", failure->n ? "; " : "");
  if (failure->n && node->body >= 0) snprintf(of, sizeof(of), " of '%s'", scene->bodies[node->body].name);
  if (failure->n && node->pair >= 0) snprintf(at, sizeof(at), ", pair '%s'", scene->contacts[node->pair].name);
  if (failure->n)
    snprintf(text, size, "%slargest residual at node %lld (%g, %g, %g)%s%s", element, (long long)place->tag,
             (double)place->X[0], (double)place->X[1], (double)place->X[2], of, at);
  else
    snprintf(text, size, "%s", element[0] ? element : "no node is out of balance");
}
