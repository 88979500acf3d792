/* Moves cells at the borders of parts where that cuts fewer edges. All ranks move cells of theirs at a time.

   Cells without neighbours on other ranks move by the method of Fiduccia and Mattheyses: always the cell with the
   largest gain in edges, also where this is a loss, each cell once; what has come after the best state is taken back.
   So rows of cells move of which a single one would gain nothing. Then any cells move that gain: to parts with larger
   numbers, and to parts with smaller ones, in turn, so that neighbours on two ranks are never exchanged back and forth.
 */
#include "graphrefine.h"

/* Most passes. Most cells have moved after three. */
enum { PASSES = 8 };

/* Gains up to which cells are sorted. */
enum { CLIMB_GAIN = 31 };

/* States of a cell in a climb */
enum { CELL_IDLE, CELL_LISTED, CELL_MOVED };

/* What parts count: cells, and cells in contact */
enum { COUNT_CELLS, COUNT_CONTACT, COUNTS };

typedef struct {
  const CellGraph *graph;
  PetscInt         parts, *part;
  /* For each part and count, how many this rank may add, and how many it has added in this pass. */
  PetscInt *room, *added;
  PetscInt *bond, n_near, *near; /* parts beside a cell, and the weight of its edges with each part */
} Refinement;

static PetscErrorCode CreateRefinement(const CellGraph *graph, PetscInt parts, PetscInt part[], Refinement *r)
{
  PetscFunctionBeginUser;
  *r = (Refinement){.graph = graph, .parts = parts, .part = part};
  PetscCall(PetscMalloc2(COUNTS * parts, &r->room, COUNTS * parts, &r->added));
  PetscCall(PetscCalloc2(parts, &r->bond, parts, &r->near));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeRefinement(Refinement *r)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(r->room, r->added));
  PetscCall(PetscFree2(r->bond, r->near));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Shares out among the ranks what the parts have room for. */
static PetscErrorCode ShareRoom(Refinement *r)
{
  static const PetscReal tolerance[COUNTS] = {PARTITION_CELL_TOLERANCE, PARTITION_CONTACT_TOLERANCE};
  const CellGraph       *graph             = r->graph;
  PetscReal              total[COUNTS]     = {0, 0};

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(r->room, COUNTS * r->parts));
  PetscCall(PetscArrayzero(r->added, COUNTS * r->parts));
  for (PetscInt v = 0; v < graph->n; v++) {
    r->room[COUNTS * r->part[v] + COUNT_CELLS]++;
    r->room[COUNTS * r->part[v] + COUNT_CONTACT] += graph->contact[v];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, r->room, (PetscMPIInt)(COUNTS * r->parts), MPIU_INT, MPI_SUM, graph->comm));
  for (PetscInt i = 0; i < COUNTS * r->parts; i++) total[i % COUNTS] += (PetscReal)r->room[i];
  for (PetscInt i = 0; i < COUNTS * r->parts; i++) {
    const PetscReal most = tolerance[i % COUNTS] * total[i % COUNTS] / (PetscReal)r->parts;

    r->room[i] = (PetscInt)(PetscMax(0, most - (PetscReal)r->room[i]) / (PetscReal)graph->size);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* May this rank add a cell to a part? */
static PetscBool HasRoom(const Refinement *r, PetscInt v, PetscInt part)
{
  const PetscInt i = COUNTS * part;

  if (r->added[i + COUNT_CELLS] >= r->room[i + COUNT_CELLS]) return PETSC_FALSE;
  return (PetscBool)(!r->graph->contact[v] || r->added[i + COUNT_CONTACT] < r->room[i + COUNT_CONTACT]);
}

/* Sums up the edges of a cell with each part beside it. Returns whether all its neighbours are on this rank. */
static PetscBool SumBonds(Refinement *r, PetscInt v)
{
  const CellGraph *graph = r->graph;
  PetscBool        alone = PETSC_TRUE;

  r->n_near = 0;
  for (PetscInt k = graph->offsets[v]; k < graph->offsets[v + 1]; k++) {
    const PetscInt part = r->part[graph->neighbours[k]];

    if (!r->bond[part]) r->near[r->n_near++] = part;
    r->bond[part] += graph->weight[k];
    if (graph->neighbours[k] >= graph->n) alone = PETSC_FALSE;
  }
  return alone;
}

/* The part in a direction, 1 or -1 or 0: both, to which the edges of a cell have most weight, its own one left out; -1:
   there is none. gain: what it has more of them than the own one */
static PetscInt BestPart(Refinement *r, PetscInt v, int direction, PetscInt *gain)
{
  const PetscInt own  = r->part[v];
  PetscInt       best = -1;

  for (PetscInt i = 0; i < r->n_near; i++) {
    const PetscInt part = r->near[i];

    if (part == own || (part - own) * direction < 0 || (best >= 0 && r->bond[part] <= r->bond[best])) continue;
    if (HasRoom(r, v, part)) best = part;
  }
  if (best >= 0) *gain = r->bond[best] - r->bond[own];
  for (PetscInt i = 0; i < r->n_near; i++) r->bond[r->near[i]] = 0;
  return best;
}

/* Moves a cell to another part. */
static void MoveCell(Refinement *r, PetscInt v, PetscInt to)
{
  const PetscInt from = r->part[v], contact = r->graph->contact[v];

  r->added[COUNTS * to + COUNT_CELLS]++;
  r->added[COUNTS * to + COUNT_CONTACT] += contact;
  r->added[COUNTS * from + COUNT_CELLS]--;
  r->added[COUNTS * from + COUNT_CONTACT] -= contact;
  r->part[v] = to;
}

/* Moves cells that gain in one direction once. Returns their number. */
static PetscInt MoveGaining(Refinement *r, int direction)
{
  PetscInt moved = 0;

  for (PetscInt v = 0; v < r->graph->n; v++) {
    PetscInt gain, to;

    SumBonds(r, v);
    to = BestPart(r, v, direction, &gain);
    if (to < 0 || gain <= 0) continue;
    MoveCell(r, v, to);
    moved++;
  }
  return moved;
}

/* Climbs */

/* Cells by their gains, in a list for each gain from -CLIMB_GAIN to CLIMB_GAIN. */
typedef struct {
  PetscInt  first[2 * CLIMB_GAIN + 1];
  PetscInt *next, *before, *to, *gain; /* of each cell; to: the part where it would go */
  char     *state;
  PetscInt  n_moved, *moved, *from; /* the cells that have moved, and the parts where they were */
} Climb;

static PetscErrorCode CreateClimb(PetscInt n, Climb *climb)
{
  PetscFunctionBeginUser;
  for (int i = 0; i <= 2 * CLIMB_GAIN; i++) climb->first[i] = -1;
  climb->n_moved = 0;
  PetscCall(PetscMalloc6(n, &climb->next, n, &climb->before, n, &climb->to, n, &climb->gain, n, &climb->moved, n,
                         &climb->from));
  PetscCall(PetscCalloc1(n, &climb->state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeClimb(Climb *climb)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree6(climb->next, climb->before, climb->to, climb->gain, climb->moved, climb->from));
  PetscCall(PetscFree(climb->state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The list of a cell */
static PetscInt *ListOf(Climb *climb, PetscInt v)
{
  return &climb->first[PetscMax(-CLIMB_GAIN, PetscMin(climb->gain[v], CLIMB_GAIN)) + CLIMB_GAIN];
}

static void Unlist(Climb *climb, PetscInt v)
{
  if (climb->before[v] >= 0)
    climb->next[climb->before[v]] = climb->next[v];
  else
    *ListOf(climb, v) = climb->next[v];
  if (climb->next[v] >= 0) climb->before[climb->next[v]] = climb->before[v];
  climb->state[v] = CELL_IDLE;
}

/* Lists a cell that has another part beside it and no neighbours on other ranks, and has not moved yet. */
static void List(Refinement *r, Climb *climb, PetscInt v)
{
  PetscBool alone;
  PetscInt *first;

  if (climb->state[v] == CELL_MOVED) return;
  if (climb->state[v] == CELL_LISTED) Unlist(climb, v);
  alone        = SumBonds(r, v);
  climb->to[v] = BestPart(r, v, 0, &climb->gain[v]);
  if (!alone || climb->to[v] < 0) return;
  first            = ListOf(climb, v);
  climb->next[v]   = *first;
  climb->before[v] = -1;
  if (*first >= 0) climb->before[*first] = v;
  *first          = v;
  climb->state[v] = CELL_LISTED;
}

/* Takes a cell with the largest gain that has room where it would go, -1: there is none. */
static PetscInt TakeBest(const Refinement *r, Climb *climb)
{
  for (int i = 2 * CLIMB_GAIN; i >= 0; i--) {
    while (climb->first[i] >= 0) {
      const PetscInt v = climb->first[i];

      Unlist(climb, v);
      if (HasRoom(r, v, climb->to[v])) return v;
    }
  }
  return -1;
}

/* Moves cells along the largest gains, and back to the best state. A climb ends when a layer of cells has moved without
   a better state. gain: of all moves */
static PetscErrorCode ClimbUp(Refinement *r, PetscInt *gain)
{
  const CellGraph *graph = r->graph;
  const PetscInt   most  = (PetscInt)PetscPowReal((PetscReal)graph->n, 2. / 3) + 1;
  PetscInt         sum = 0, n_best = 0;
  Climb            climb;

  PetscFunctionBeginUser;
  *gain = 0;
  PetscCall(CreateClimb(graph->n, &climb));
  for (PetscInt v = 0; v < graph->n; v++) List(r, &climb, v);
  for (PetscInt v; climb.n_moved < n_best + most && (v = TakeBest(r, &climb)) >= 0;) {
    climb.moved[climb.n_moved]  = v;
    climb.from[climb.n_moved++] = r->part[v];
    climb.state[v]              = CELL_MOVED;
    MoveCell(r, v, climb.to[v]);
    sum += climb.gain[v];
    for (PetscInt k = graph->offsets[v]; k < graph->offsets[v + 1]; k++)
      if (graph->neighbours[k] < graph->n) List(r, &climb, graph->neighbours[k]);
    if (sum <= *gain) continue;
    *gain  = sum;
    n_best = climb.n_moved;
  }
  while (climb.n_moved > n_best) {
    climb.n_moved--;
    MoveCell(r, climb.moved[climb.n_moved], climb.from[climb.n_moved]);
  }
  PetscCall(FreeClimb(&climb));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One pass of a climb and of moves in both directions. improved: number of moves and gains of all ranks */
static PetscErrorCode RefineOnce(Refinement *r, PetscInt *improved)
{
  PetscFunctionBeginUser;
  PetscCall(CellGraphFetch(r->graph, r->part));
  PetscCall(ShareRoom(r));
  PetscCall(ClimbUp(r, improved));
  for (int direction = 1; direction >= -1; direction -= 2) {
    PetscCall(CellGraphFetch(r->graph, r->part));
    PetscCall(ShareRoom(r));
    *improved += MoveGaining(r, direction);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, improved, 1, MPIU_INT, MPI_SUM, r->graph->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GraphRefine - moves cells to the part with which they have most edges, as far as parts stay balanced.

  Collective

  Input Parameters:
+ graph - the graph of the cells
- parts - number of parts

  Input/Output Parameter:
. part - part of each vertex, with room for the ghosts [n + n_ghosts]
@*/
PetscErrorCode GraphRefine(const CellGraph *graph, PetscInt parts, PetscInt part[])
{
  Refinement r;
  PetscInt   improved = 1;

  PetscFunctionBeginUser;
  PetscCall(CreateRefinement(graph, parts, part, &r));
  for (int pass = 0; pass < PASSES && improved; pass++) PetscCall(RefineOnce(&r, &improved));
  PetscCall(FreeRefinement(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}
