/* Messages between ranks that sweep in turns. */
#include "sweeppass.h"

/* A rank that owns ghosts of this one. As the pattern is symmetric, it has ghosts that this rank owns. */
typedef struct {
  PetscMPIInt rank;
  PetscBool   before;   /* it is swept forward before this rank */
  PetscInt    first, n; /* its rows among those of ghosts, which follow each other */
  PetscInt    own;      /* number of rows of this rank that it needs */
  PetscInt   *row;      /* these rows */
  PetscReal  *value;    /* their values while they are sent */
} Neighbour;

struct _n_SweepPass {
  MPI_Comm     comm;
  PetscMPIInt  tag;
  PetscInt     ghosts; /* first row of ghosts */
  SFCount      n;
  Neighbour   *neighbour;
  PetscMPIInt  n_receives, n_sends; /* under way */
  MPI_Request *receive, *send;
};

/* Sets what a neighbour sends. row: rows of its ghosts, from the first ghost's on */
static PetscErrorCode SetReceived(SweepOrder o, PetscMPIInt rank, PetscInt n, const PetscInt *row, Neighbour *neighbour)
{
  PetscFunctionBeginUser;
  neighbour->rank   = rank;
  neighbour->first  = row[0];
  neighbour->n      = n;
  neighbour->before = (PetscBool)(o->place[o->n + row[0] / o->size] < 0);
  PetscCheck(row[n - 1] == row[0] + n - 1, PETSC_COMM_SELF, PETSC_ERR_PLIB, "ghosts of rank %d are apart", rank);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets what a neighbour needs. */
static PetscErrorCode SetSent(SweepPass pass, PetscMPIInt rank, PetscInt n, const PetscInt *row)
{
  Neighbour *neighbour = pass->neighbour, *end = pass->neighbour + pass->n;

  PetscFunctionBeginUser;
  while (neighbour < end && neighbour->rank != rank) neighbour++;
  PetscCheck(neighbour < end, PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP, "rank %d needs rows, but has none", rank);
  neighbour->own = n;
  PetscCall(PetscMalloc2(n, &neighbour->row, n, &neighbour->value));
  PetscCall(PetscArraycpy(neighbour->row, row, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the neighbours from what fetches all ghosts. */
static PetscErrorCode FindNeighbours(SweepPass pass, SweepOrder o)
{
  const PetscMPIInt *rank;
  const PetscInt    *first, *row, *ghost;
  SFCount            n;

  PetscFunctionBeginUser;
  PetscCall(PetscSFSetUp(o->sf));
  PetscCall(PetscSFGetRootRanks(o->sf, &pass->n, &rank, &first, &ghost, NULL));
  PetscCall(PetscCalloc1(pass->n, &pass->neighbour));
  for (SFCount k = 0; k < pass->n; k++)
    PetscCall(SetReceived(o, rank[k], first[k + 1] - first[k], &ghost[first[k]], &pass->neighbour[k]));
  PetscCall(PetscSFGetLeafRanks(o->sf, &n, &rank, &first, &row));
  for (SFCount k = 0; k < n; k++) PetscCall(SetSent(pass, rank[k], first[k + 1] - first[k], &row[first[k]]));
  PetscCall(PetscMalloc2(pass->n, &pass->receive, pass->n, &pass->send));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SweepPassCreate - finds what this rank and its neighbours pass on to each other.

  Collective

  Input Parameter:
. order - the order of the sweeps

  Output Parameter:
. pass - destroy it with SweepPassDestroy()
@*/
PetscErrorCode SweepPassCreate(SweepOrder order, SweepPass *pass)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(pass));
  (*pass)->ghosts = order->n * order->size;
  if (!order->sf) PetscFunctionReturn(PETSC_SUCCESS);
  (*pass)->comm = PetscObjectComm((PetscObject)order->sf);
  PetscCall(PetscObjectGetNewTag((PetscObject)order->sf, &(*pass)->tag));
  PetscCall(FindNeighbours(*pass, order));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SweepPassDestroy - frees the pass.

  Not collective

  Input Parameter:
. pass - may be NULL inside
@*/
PetscErrorCode SweepPassDestroy(SweepPass *pass)
{
  PetscFunctionBeginUser;
  if (!*pass) PetscFunctionReturn(PETSC_SUCCESS);
  for (SFCount k = 0; k < (*pass)->n; k++)
    PetscCall(PetscFree2((*pass)->neighbour[k].row, (*pass)->neighbour[k].value));
  PetscCall(PetscFree((*pass)->neighbour));
  PetscCall(PetscFree2((*pass)->receive, (*pass)->send));
  PetscCall(PetscFree(*pass));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SweepPassBegin - begins to fetch the values of ghosts that are swept before this rank.

  Logically collective

  Input Parameters:
+ pass - the pass; nothing is under way
- way  - of the sweep

  Input and Output Parameter:
. x - the array of SweepOrderShareBegin(); values of these ghosts are known after SweepPassAwait()
@*/
PetscErrorCode SweepPassBegin(SweepPass pass, SweepWay way, PetscReal *x)
{
  PetscFunctionBeginUser;
  for (SFCount k = 0; k < pass->n; k++) {
    const Neighbour *from = &pass->neighbour[k];

    if (from->before == (way == SWEEP_FORWARD))
      PetscCallMPI(MPI_Irecv(&x[pass->ghosts + from->first], (PetscMPIInt)from->n, MPIU_REAL, from->rank, pass->tag,
                             pass->comm, &pass->receive[pass->n_receives++]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SweepPassAwait - waits for what SweepPassBegin() has begun to fetch.

  Logically collective

  Input Parameter:
. pass - the pass
@*/
PetscErrorCode SweepPassAwait(SweepPass pass)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Waitall(pass->n_receives, pass->receive, MPI_STATUSES_IGNORE));
  pass->n_receives = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SweepPassSend - sends values of this rank to the ranks that are swept after it.

  Logically collective

  Input Parameters:
+ pass - the pass
. way  - of the sweep
- x    - values of this rank's nodes; they may change afterwards
@*/
PetscErrorCode SweepPassSend(SweepPass pass, SweepWay way, const PetscReal *x)
{
  PetscFunctionBeginUser;
  for (SFCount k = 0; k < pass->n; k++) {
    const Neighbour *to = &pass->neighbour[k];

    if (to->before == (way == SWEEP_FORWARD)) continue;
    for (PetscInt i = 0; i < to->own; i++) to->value[i] = x[to->row[i]];
    PetscCallMPI(MPI_Isend(to->value, (PetscMPIInt)to->own, MPIU_REAL, to->rank, pass->tag, pass->comm,
                           &pass->send[pass->n_sends++]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SweepPassEnd - waits until what SweepPassSend() sends has left.

  Logically collective

  Input Parameter:
. pass - the pass, which then serves again
@*/
PetscErrorCode SweepPassEnd(SweepPass pass)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Waitall(pass->n_sends, pass->send, MPI_STATUSES_IGNORE));
  pass->n_sends = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
