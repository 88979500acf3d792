/* Messages between ranks that sweep in turns. */
#include "sweeppass.h"

/* Rows of an array that go to another rank, or come from there: first those that go early. */
typedef struct {
  PetscInt   n, early, *row;
  PetscReal *value; /* while they are under way */
} Parcel;

/* A rank that owns ghosts of this one. As the pattern is symmetric, it has ghosts that this rank owns. */
typedef struct {
  PetscMPIInt rank;
  PetscBool   before; /* its colour is lower */
  Parcel      from, to;
} Neighbour;

struct _n_SweepPass {
  MPI_Comm     comm;
  PetscMPIInt  tag;
  SFCount      n;
  Neighbour   *neighbour;
  SweepWay     way;                 /* of what is received */
  PetscMPIInt  n_receives, n_sends; /* under way */
  MPI_Request *receive, *send;
};

/* Sets the rows of a parcel. waits: for each row whether it has a turn; offset: of the rows within the array */
static PetscErrorCode FillParcel(PetscInt n, const PetscInt *row, PetscInt offset, const PetscInt *waits,
                                 Parcel *parcel)
{
  PetscInt next = 0;

  PetscFunctionBeginUser;
  parcel->n = n;
  PetscCall(PetscMalloc2(n, &parcel->row, n, &parcel->value));
  for (int late = 0; late < 2; late++) {
    for (PetscInt k = 0; k < n; k++)
      if ((waits[row[k]] != 0) == late) parcel->row[next++] = offset + row[k];
    if (!late) parcel->early = next;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static Neighbour *FindNeighbour(SweepPass pass, PetscMPIInt rank)
{
  for (SFCount k = 0; k < pass->n; k++)
    if (pass->neighbour[k].rank == rank) return &pass->neighbour[k];
  return NULL;
}

/* Finds the neighbours from what fetches all ghosts. own, ghost: for each row whether it has a turn */
static PetscErrorCode FindNeighbours(SweepPass pass, SweepOrder o, const PetscInt *own, const PetscInt *ghost)
{
  const PetscMPIInt *rank;
  const PetscInt    *first, *row;
  SFCount            n;

  PetscFunctionBeginUser;
  PetscCall(PetscSFGetRootRanks(o->sf, &pass->n, &rank, &first, &row, NULL));
  PetscCall(PetscCalloc1(pass->n, &pass->neighbour));
  for (SFCount k = 0; k < pass->n; k++) {
    Neighbour *neighbour = &pass->neighbour[k];

    neighbour->rank   = rank[k];
    neighbour->before = (PetscBool)(o->place[o->n + row[first[k]] / o->size] < 0);
    PetscCall(FillParcel(first[k + 1] - first[k], &row[first[k]], o->n * o->size, ghost, &neighbour->from));
  }
  PetscCall(PetscSFGetLeafRanks(o->sf, &n, &rank, &first, &row));
  for (SFCount k = 0; k < n; k++) {
    Neighbour *neighbour = FindNeighbour(pass, rank[k]);

    PetscCheck(neighbour, PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP, "rank %d needs rows, but has none", rank[k]);
    PetscCall(FillParcel(first[k + 1] - first[k], &row[first[k]], 0, own, &neighbour->to));
  }
  PetscCall(PetscMalloc2(PASS_STAGES * pass->n, &pass->receive, PASS_STAGES * pass->n, &pass->send));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SweepPassCreate - finds what this rank and its neighbours pass on to each other.

  Collective

  Input Parameters:
+ order  - the order of the sweeps
- staged - nodes without a turn are sent early; else all are sent at once, as PASS_EARLY

  Output Parameter:
. pass - destroy it with SweepPassDestroy()
@*/
PetscErrorCode SweepPassCreate(SweepOrder order, PetscBool staged, SweepPass *pass)
{
  PetscInt *own, *ghost;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(pass));
  if (!order->sf) PetscFunctionReturn(PETSC_SUCCESS);
  (*pass)->comm = PetscObjectComm((PetscObject)order->sf);
  PetscCall(PetscObjectGetNewTag((PetscObject)order->sf, &(*pass)->tag));
  PetscCall(PetscCalloc2(order->n * order->size, &own, order->n_ghosts * order->size, &ghost));
  for (PetscInt k = order->first[SWEEP_TURN]; staged && k < order->first[SWEEP_TURN + 1]; k++)
    for (int d = 0; d < order->size; d++) own[order->node[k] * order->size + d] = 1;
  PetscCall(PetscSFBcastBegin(order->sf, MPIU_INT, own, ghost, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(order->sf, MPIU_INT, own, ghost, MPI_REPLACE));
  PetscCall(FindNeighbours(*pass, order, own, ghost));
  PetscCall(PetscFree2(own, ghost));
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
  for (SFCount k = 0; k < (*pass)->n; k++) {
    PetscCall(PetscFree2((*pass)->neighbour[k].from.row, (*pass)->neighbour[k].from.value));
    PetscCall(PetscFree2((*pass)->neighbour[k].to.row, (*pass)->neighbour[k].to.value));
  }
  PetscCall(PetscFree((*pass)->neighbour));
  PetscCall(PetscFree2((*pass)->receive, (*pass)->send));
  PetscCall(PetscFree(*pass));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* First row of a stage of a parcel; of PASS_STAGES: the number of rows. */
static PetscInt StageRow(const Parcel *parcel, PassStage stage)
{
  return stage == PASS_EARLY ? 0 : stage == PASS_TURN ? parcel->early : parcel->n;
}

/*@
  SweepPassBegin - begins to fetch the values of ghosts that are swept before this rank.

  Logically collective

  Input Parameters:
+ pass - the pass; nothing is under way
- way  - of the sweep
@*/
PetscErrorCode SweepPassBegin(SweepPass pass, SweepWay way)
{
  PetscFunctionBeginUser;
  pass->way = way;
  for (SFCount k = 0; k < pass->n; k++) {
    const Neighbour *neighbour = &pass->neighbour[k];

    if (neighbour->before != (way == SWEEP_FORWARD)) continue;
    for (PassStage stage = PASS_EARLY; stage < PASS_STAGES; stage++) {
      const PetscInt first = StageRow(&neighbour->from, stage), n = StageRow(&neighbour->from, stage + 1) - first;

      if (n)
        PetscCallMPI(MPI_Irecv(&neighbour->from.value[first], (PetscMPIInt)n, MPIU_REAL, neighbour->rank, pass->tag,
                               pass->comm, &pass->receive[pass->n_receives++]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SweepPassAwait - waits for what SweepPassBegin() has begun to fetch.

  Logically collective

  Input Parameter:
. pass - the pass; nothing happens where nothing was begun

  Input and Output Parameter:
. x - the array of SweepOrderShareBegin(); gets the values of these ghosts
@*/
PetscErrorCode SweepPassAwait(SweepPass pass, PetscReal *x)
{
  PetscFunctionBeginUser;
  if (!pass->n_receives) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Waitall(pass->n_receives, pass->receive, MPI_STATUSES_IGNORE));
  pass->n_receives = 0;
  for (SFCount k = 0; k < pass->n; k++) {
    const Parcel *from = &pass->neighbour[k].from;

    if (pass->neighbour[k].before != (pass->way == SWEEP_FORWARD)) continue;
    for (PetscInt i = 0; i < from->n; i++) x[from->row[i]] = from->value[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SweepPassSend - sends values of this rank to the ranks that are swept after it.

  Logically collective

  Input Parameters:
+ pass  - the pass
. way   - of the sweep
. stage - PASS_EARLY: nodes without a turn are known; PASS_TURN: those with one are, too
- x     - values of this rank's nodes; they may change afterwards
@*/
PetscErrorCode SweepPassSend(SweepPass pass, SweepWay way, PassStage stage, const PetscReal *x)
{
  PetscFunctionBeginUser;
  for (SFCount k = 0; k < pass->n; k++) {
    const Neighbour *neighbour = &pass->neighbour[k];
    const Parcel    *to        = &neighbour->to;
    const PetscInt   first = StageRow(to, stage), end = StageRow(to, stage + 1);

    if (neighbour->before == (way == SWEEP_FORWARD) || first == end) continue;
    for (PetscInt i = first; i < end; i++) to->value[i] = x[to->row[i]];
    PetscCallMPI(MPI_Isend(&to->value[first], (PetscMPIInt)(end - first), MPIU_REAL, neighbour->rank, pass->tag,
                           pass->comm, &pass->send[pass->n_sends++]));
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
