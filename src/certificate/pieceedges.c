/* The edges of pieces, each once, see pieces.h. */
#include "pieces.h"
#include <stdlib.h>

/* An edge of one piece: its points in ascending order, and its number there */
typedef struct {
  PetscInt low, high, piece;
  int      number;
} EdgeOf;

static int EarlierEdge(const void *a, const void *b)
{
  const EdgeOf *p = a, *q = b;

  if (p->low != q->low) return p->low < q->low ? -1 : 1;
  if (p->high != q->high) return p->high < q->high ? -1 : 1;
  return (p->piece > q->piece) - (p->piece < q->piece);
}

/* Lists the edges of all pieces, equal ones beside each other. Returns their number. */
static PetscInt ListEdges(Side side, EdgeOf *list)
{
  const int edges = side->dim == 2 ? 1 : 3;
  PetscInt  n     = 0;

  for (PetscInt k = 0; k < side->n_pieces; k++) {
    for (int e = 0; e < edges; e++) {
      const PetscInt a = side->corner[3 * k + e], b = side->corner[3 * k + (e + 1) % side->dim];

      list[n++] = (EdgeOf){PetscMin(a, b), PetscMax(a, b), k, e};
    }
  }
  if (n) qsort(list, (size_t)n, sizeof(*list), EarlierEdge);
  return n;
}

/*@
  SideEdges - finds the edges of a side's pieces on this rank. Two pieces share an edge.

  Not collective

  Input/Output Parameter:
. side - with pieces and points; its edges are set
@*/
PetscErrorCode SideEdges(Side side)
{
  EdgeOf  *list;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * side->n_pieces, &list));
  n = ListEdges(side, list);
  PetscCall(PetscMalloc1(n, &side->edges));
  for (PetscInt i = 0; i < n; i++) {
    const PetscBool shared =
      (PetscBool)(i + 1 < n && list[i].low == list[i + 1].low && list[i].high == list[i + 1].high);

    side->edges[side->n_edges++] = (Edge){
      .end    = {&side->points[list[i].low], &side->points[list[i].high]},
      .of     = {&side->pieces[list[i].piece], shared ? &side->pieces[list[i + 1].piece] : NULL},
      .number = list[i].number,
    };
    i += shared;
  }
  PetscCall(PetscFree(list));
  PetscFunctionReturn(PETSC_SUCCESS);
}
