/* The tangent of friction: rows of the nodes on which its forces act, columns of all nodes that they follow. */
#include "contactimpl.h"
#include "base/timing.h"

/* A block of a term while it is made. */
typedef struct {
  const ContactPair *pair;
  int                dim;
  PetscInt           columns;  /* nodes of the block times dim */
  PetscReal         *by_node;  /* dim rows: derivative of the traction */
  PetscInt           n_rows;   /* nodes on which forces act */
  PetscInt          *row_node; /* these nodes, contact nodes */
  int               *row_of;   /* of each node of the block, its number among them; -1: none */
  PetscReal         *share;    /* of each of them dim*dim: force over the traction of the term */
  PetscReal         *value;    /* n_rows*dim rows */
  PetscReal         *turns;    /* dim rows: derivative of the own N of the slave point at hand */
} TermBlock;

/* Room for the derivatives of the own N of slave point q over the nodes of its first variation: dim*dim for each, kept
   until the next projection. */
static PetscErrorCode TurnsRoom(const ContactPair *pair, PetscInt q, PetscReal **turns)
{
  Friction       f = pair->friction;
  const PetscInt n = ContactVariationsOwn(pair, q) * PetscSqr(pair->mesh->dim);

  PetscFunctionBeginUser;
  if (f->turns_used + n > f->turns_room) {
    f->turns_room = 2 * (f->turns_used + n);
    PetscCall(PetscRealloc(f->turns_room * sizeof(PetscReal), &f->turns));
  }
  *turns      = &f->turns[f->turns_used];
  f->first[q] = f->turns_used;
  f->turns_used += n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The derivative of component c of the own N that was evaluated last, over slave point and points. It overwrites the
   result's N where M is in factors. */
static PetscErrorCode OwnRow(const ContactPair *pair, int c, PetscReal *row)
{
  SmootherResult *result = &pair->work->result;
  const int       dim    = pair->mesh->dim;

  PetscFunctionBeginUser;
  if (result->factored)
    FitDerivativesSlave(&result->factors, c, row);
  else
    PetscCall(PetscArraycpy(row, &result->M[c * (1 + result->n) * dim], (1 + result->n) * dim));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FrictionTurnsKeep - keeps the derivatives of the own N of a slave point whose second variation was added last. Nothing
  is done where the block at hand has not all of the point's nodes, or where they are kept already.

  Not collective

  Input Parameters:
+ pair - the pair, after ContactSecondAdd() that found the point
- q    - the slave point; its first variation is kept

  Note:
  The result's N is overwritten.
@*/
PetscErrorCode FrictionTurnsKeep(const ContactPair *pair, PetscInt q)
{
  const int            dim    = pair->mesh->dim;
  const FitDerivatives map    = ContactWorkMap(pair->work, pair->work->sum.n_nodes);
  SmootherResult      *result = &pair->work->result;
  const PetscInt n = ContactVariationsOwn(pair, q), *number = &pair->variations->number[pair->variations->first[q]];
  PetscReal     *nodal, *to;

  PetscFunctionBeginUser;
  if (pair->friction->first[q] >= 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < n; i++)
    if (pair->work->slot[number[i]] < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TurnsRoom(pair, q, &to));
  PetscCall(PetscMalloc1(map.n_nodes * dim, &nodal));
  for (int c = 0; c < dim; c++) {
    PetscCall(OwnRow(pair, c, result->N));
    FitDerivativesFirst(dim, result->n, result->N, &map, nodal);
    for (PetscInt i = 0; i < n; i++)
      for (int d = 0; d < dim; d++) to[(i * dim + c) * dim + d] = nodal[pair->work->slot[number[i]] * dim + d];
  }
  PetscCall(PetscFree(nodal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Derivatives of the own N of slave point q, see TurnsRoom(). They are found where they are not kept yet, and then no
   list of nodes or block may be at hand. */
static PetscErrorCode PointTurns(const ContactPair *pair, PetscInt q, const PetscReal **turns)
{
  const int      dim  = pair->mesh->dim;
  ContactWork   *work = pair->work;
  Friction       f    = pair->friction;
  const PetscInt n    = ContactVariationsOwn(pair, q);
  PetscReal     *to;
  PetscBool      found;

  PetscFunctionBeginUser;
  *turns = f->first[q] >= 0 ? &f->turns[f->first[q]] : NULL;
  if (*turns) PetscFunctionReturn(PETSC_SUCCESS);
  if (pair->fit.fitted) TimingBegin(TIMING_FIT);
  PetscCall(
    ContactPointEvaluate(pair, pair->smoother, pair->lists, q, pair->seed[q], SMOOTHER_SECOND_VARIATION, &found));
  if (pair->fit.fitted) TimingEnd(TIMING_FIT);
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a slave point has a first variation and no second one");
  PetscCall(TurnsRoom(pair, q, &to));
  for (int c = 0; c < dim; c++) {
    PetscCall(OwnRow(pair, c, work->result.N));
    PetscCall(ContactPointToNodes(pair, pair->lists, q));
    PetscCheck(work->count == n, PETSC_COMM_SELF, PETSC_ERR_PLIB, "the variations of a slave point have other nodes");
    for (PetscInt i = 0; i < n; i++)
      for (int d = 0; d < dim; d++) to[(i * dim + c) * dim + d] = work->N[i * dim + d];
  }
  *turns = to;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The face on which slave point q is anchored; NULL: the tool is analytic, or the point came to the master in this step
   and has no anchor. */
static const Facet *AnchorFace(const ContactPair *pair, PetscInt q)
{
  const PetscInt at = pair->friction->at[q];

  return pair->master && at >= 0 ? &pair->lists->face[at] : NULL;
}

/* Adds the nodes of the anchor's face of slave point q to the list of nodes. */
static void AddAnchorNodes(const ContactPair *pair, PetscInt q)
{
  const Facet *face = AnchorFace(pair, q);

  for (int k = 0; face && k < ElementGet(face->type)->nodes; k++) {
    PetscReal sign[3];
    PetscInt  node;

    FrictionNodeSign(pair, face->nodes[k], &node, sign);
    ContactWorkNodesAdd(pair->work, 1, &node);
  }
}

/* Adds the nodes of the foot's face of slave point q and of its lever to the list of nodes. */
static PetscErrorCode AddFootNodes(const ContactPair *pair, PetscInt q)
{
  const FrictionFoot *foot;
  PetscBool           found;
  const PetscInt     *lever;
  const PetscReal    *slope;

  PetscFunctionBeginUser;
  PetscCall(FrictionPointFoot(pair, q, &foot, &found));
  for (int k = 0; found && k < foot->nodes; k++) {
    PetscReal sign[3];
    PetscInt  node;

    FrictionNodeSign(pair, FrictionFootPoint(pair, q, k), &node, sign);
    ContactWorkNodesAdd(pair->work, 1, &node);
  }
  if (found) {
    const PetscInt n = FrictionLeverNodes(pair, q, &lever, &slope);

    ContactWorkNodesAdd(pair->work, n, lever);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the feet of all slave points of a term before a list of nodes is begun. *room: nodes at most. */
static PetscErrorCode FindFeet(const ContactPair *pair, PetscInt c, PetscInt *room)
{
  PetscFunctionBeginUser;
  *room = FACE_MAX_NODES;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt      q = pair->term_point[k];
    const FrictionFoot *foot;
    PetscBool           found;

    if (pair->factor[q] == 0) continue;
    PetscCall(FrictionPointFoot(pair, q, &foot, &found));
    *room += pair->variations->end[q] - pair->variations->first[q] + 3 * FACE_MAX_NODES;
    if (found) *room += pair->slaves->lever_ptr[q + 1] - pair->slaves->lever_ptr[q];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FrictionTermNodes - lists the nodes of a term and of its friction, each once, into the work's number: those of its
  first variations, of its slave points' own faces and levers, and of the faces of feet and anchors.

  Not collective

  Input Parameters:
+ pair - the pair, projected
- c    - the term
@*/
PetscErrorCode FrictionTermNodes(const ContactPair *pair, PetscInt c)
{
  const ContactVariations *v = pair->variations;
  PetscInt                 room;

  PetscFunctionBeginUser;
  PetscCall(FindFeet(pair, c, &room));
  PetscCall(ContactWorkNodesBegin(pair->work, pair->lists->n_nodes, room));
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt   q = pair->term_point[k], *node;
    const PetscReal *S;
    PetscInt         n;

    if (pair->factor[q] == 0) continue;
    ContactWorkNodesAdd(pair->work, v->end[q] - v->first[q], &v->number[v->first[q]]);
    if (!pair->friction->anchored[c] || !FrictionTermTakes(pair, k)) continue;
    pair->friction->taken[q] = PETSC_TRUE;
    n                        = FrictionOwnNodes(pair, q, &node, &S);
    ContactWorkNodesAdd(pair->work, n, node);
    PetscCall(AddFootNodes(pair, q));
    AddAnchorNodes(pair, q);
  }
  if (pair->friction->anchored[c] && FrictionTermGuide(pair, c) >= 0) AddAnchorNodes(pair, FrictionTermGuide(pair, c));
  ContactWorkNodesEnd(pair->work);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FrictionTangentBegin - begins a tangent, in which no term has taken a slave point yet.

  Not collective

  Input Parameter:
. pair - the pair
@*/
PetscErrorCode FrictionTangentBegin(const ContactPair *pair)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(pair->friction->taken, pair->slaves->n));
  PetscCall(PetscArrayzero(pair->friction->held, 3 * pair->slaves->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FrictionFaceNodes - lists the nodes of a face's block, each once, into the work's number: those of the first
  variations of some of its slave points and of those that terms take, and of the latter ones' feet and levers.

  Not collective

  Input Parameters:
+ pair   - the pair, projected, after FrictionTermNodes() for all terms
. face   - the face
. n      - number of slave points
- points - the slave points, with area
@*/
PetscErrorCode FrictionFaceNodes(const ContactPair *pair, PetscInt face, PetscInt n, const PetscInt points[])
{
  const ContactVariations *v     = pair->variations;
  const PetscBool         *taken = pair->friction->taken;
  const PetscInt           first = pair->slaves->first[face], end = pair->slaves->first[face + 1];
  PetscInt                 room = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n + end - first; k++) {
    const PetscInt q = k < n ? points[k] : first + k - n;

    if (k >= n && !taken[q]) continue;
    PetscCall(ContactVariationsNeed(pair, q));
    room += v->end[q] - v->first[q] + 3 * FACE_MAX_NODES;
    if (pair->slaves->lever_ptr) room += pair->slaves->lever_ptr[q + 1] - pair->slaves->lever_ptr[q];
  }
  PetscCall(ContactWorkNodesBegin(pair->work, pair->lists->n_nodes, room));
  for (PetscInt k = 0; k < n + end - first; k++) {
    const PetscInt   q = k < n ? points[k] : first + k - n, *node;
    const PetscReal *S;
    PetscInt         own;

    if (k >= n && !taken[q]) continue;
    ContactWorkNodesAdd(pair->work, v->end[q] - v->first[q], &v->number[v->first[q]]);
    if (k < n) continue;
    own = FrictionOwnNodes(pair, q, &node, &S); /* sets node, before it is an argument */
    ContactWorkNodesAdd(pair->work, own, node);
    PetscCall(AddFootNodes(pair, q));
  }
  ContactWorkNodesEnd(pair->work);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FrictionTermPrepare - finds what FrictionTermBlock() needs and what cannot be found while a block is at hand.

  Not collective

  Input Parameters:
+ pair - the pair, projected
- c    - the term
@*/
PetscErrorCode FrictionTermPrepare(const ContactPair *pair, PetscInt c)
{
  const PetscReal *turns;

  PetscFunctionBeginUser;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    if (!pair->friction->anchored[c] || !FrictionTermTakes(pair, k)) continue;
    PetscCall(ContactVariationsNeed(pair, pair->term_point[k]));
    PetscCall(PointTurns(pair, pair->term_point[k], &turns));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds scale m sign to the columns of a node in dim rows. */
static void AddColumns(const TermBlock *b, PetscReal *rows, PetscInt node, PetscReal scale, const PetscReal m[3][3],
                       const PetscReal sign[3])
{
  const int place = b->pair->work->slot[node];

  if (place < 0) return;
  for (int i = 0; i < b->dim; i++)
    for (int j = 0; j < b->dim; j++)
      rows[i * b->columns + place * b->dim + j] += scale * m[i][j] * (sign ? sign[j] : 1);
}

/* Adds m times the derivative of the own N of slave point q, and by_gap times its first variation, both times scale. */
static PetscErrorCode AddVariations(const TermBlock *b, PetscReal *rows, PetscInt q, PetscReal scale,
                                    const PetscReal m[3][3], const PetscReal *by_gap)
{
  const ContactVariations *v   = b->pair->variations;
  const int                dim = b->dim;
  const PetscReal         *turns;

  PetscFunctionBeginUser;
  PetscCall(PointTurns(b->pair, q, &turns));
  for (PetscInt i = v->first[q]; i < v->first[q] + ContactVariationsOwn(b->pair, q); i++) {
    const PetscReal *turn = &turns[(i - v->first[q]) * dim * dim], *N = &v->N[i * dim];
    PetscReal        sum[3][3];

    for (int r = 0; r < dim; r++) {
      for (int j = 0; j < dim; j++) {
        sum[r][j] = by_gap ? by_gap[r] * N[j] : 0;
        for (int d = 0; d < dim; d++) sum[r][j] += m[r][d] * turn[d * dim + j];
      }
    }
    AddColumns(b, rows, v->number[i], scale, sum, NULL);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Spreads the derivative of the own N of slave point q over the columns of the block. */
static PetscErrorCode SpreadTurns(const TermBlock *b, PetscInt q)
{
  const ContactVariations *v   = b->pair->variations;
  const int                dim = b->dim;
  const PetscReal         *turns;

  PetscFunctionBeginUser;
  PetscCall(PointTurns(b->pair, q, &turns));
  PetscCall(PetscArrayzero(b->turns, dim * b->columns));
  for (PetscInt i = 0; i < ContactVariationsOwn(b->pair, q); i++) {
    const int place = b->pair->work->slot[v->number[v->first[q] + i]];

    for (int d = 0; place >= 0 && d < dim; d++)
      for (int j = 0; j < dim; j++) b->turns[d * b->columns + place * dim + j] += turns[(i * dim + d) * dim + j];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds m times the spread derivative of the own N to dim rows. */
static void AddTurns(const TermBlock *b, PetscReal *restrict rows, const PetscReal m[3][3])
{
  const PetscInt columns                = b->columns;
  const PetscReal *const restrict turns = b->turns, *const restrict last = b->dim == 3 ? &turns[2 * columns] : NULL;

  for (int r = 0; r < b->dim; r++) {
    PetscReal *const restrict row = &rows[r * columns];
    const PetscReal m_0 = m[r][0], m_1 = m[r][1], m_2 = m[r][2];

    if (last)
      for (PetscInt j = 0; j < columns; j++) row[j] += m_0 * turns[j] + m_1 * turns[columns + j] + m_2 * last[j];
    else
      for (PetscInt j = 0; j < columns; j++) row[j] += m_0 * turns[j] + m_1 * turns[columns + j];
  }
}

/* The derivatives of the traction by the tangents of the face on which slave point q is anchored: what is off the face
   turns with it. */
static void TurnOff(const ContactPair *pair, PetscInt q, const FrictionTraction *by, PetscReal turn[2][3][3])
{
  FrictionFrame frame;
  PetscReal     off[2][3][3];

  FrictionAnchorFrame(pair, q, &frame);
  FrictionFrameVary(&frame, &pair->friction->off[3 * q], off);
  for (int a = 0; a < 2; a++) {
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++) {
        turn[a][i][j] = 0;
        for (int d = 0; d < 3; d++) turn[a][i][j] -= by->by_slip[i][d] * off[a][d][j];
      }
    }
  }
}

/* Adds the derivative of the slip of slave point q, times scale. */
static void AddSlipColumns(const TermBlock *b, PetscInt q, PetscReal scale, const FrictionTraction *by)
{
  const ContactPair *pair = b->pair;
  const Facet       *face = AnchorFace(pair, q);
  const PetscInt    *node;
  const PetscReal   *S;
  const PetscInt     n = FrictionOwnNodes(pair, q, &node, &S);
  PetscReal          N[FACE_MAX_NODES], dN[FACE_MAX_NODES * 2], turn[2][3][3];

  for (PetscInt a = 0; a < n; a++) AddColumns(b, b->by_node, node[a], scale * S[a], by->by_slip, NULL);
  if (!face) return;
  TurnOff(pair, q, by, turn);
  ElementShape(face->type, &pair->friction->xi[2 * q], N, dN, NULL);
  for (int k = 0; k < ElementGet(face->type)->nodes; k++) {
    PetscReal sign[3];
    PetscInt  at;

    FrictionNodeSign(pair, face->nodes[k], &at, sign);
    AddColumns(b, b->by_node, at, -scale * N[k], by->by_slip, sign);
    for (int a = 0; a < b->dim - 1; a++) AddColumns(b, b->by_node, at, scale * dN[k * (b->dim - 1) + a], turn[a], sign);
  }
}

/* Adds the derivative of the direction along, which turns with the face on which slave point q is anchored. */
static void AddAlongColumns(const TermBlock *b, PetscInt q, const FrictionTraction *by)
{
  const ContactPair *pair = b->pair;
  const Facet       *face = AnchorFace(pair, q);
  PetscReal          N[FACE_MAX_NODES], dN[FACE_MAX_NODES * 2];

  if (!face) return;
  ElementShape(face->type, &pair->friction->xi[2 * q], N, dN, NULL);
  for (int k = 0; k < ElementGet(face->type)->nodes; k++) {
    PetscReal sign[3];
    PetscInt  at;

    FrictionNodeSign(pair, face->nodes[k], &at, sign);
    AddColumns(b, b->by_node, at, dN[k * (b->dim - 1)], by->by_along, sign);
  }
}

/* Lists a node as one on which a force acts, unless it is not in the block. */
static void AddRow(TermBlock *b, PetscInt node)
{
  const int place = b->pair->work->slot[node];

  if (place < 0 || b->row_of[place] >= 0) return;
  b->row_of[place]         = (int)b->n_rows;
  b->row_node[b->n_rows++] = node;
}

/* Lists a node as one on which a force acts, and adds its share of the term's traction. */
static void AddShare(TermBlock *b, PetscInt node, const PetscReal share[3][3], PetscReal scale, const PetscReal *sign)
{
  const int place = b->pair->work->slot[node], dim = b->dim;

  if (place < 0) return;
  AddRow(b, node);
  for (int i = 0; i < dim; i++)
    for (int j = 0; j < dim; j++)
      b->share[(b->row_of[place] * dim + i) * dim + j] += scale * share[i][j] * (sign ? sign[i] : 1);
}

/* The nodes on which the forces of slave point q act, and their shares. */
static PetscErrorCode AddShares(TermBlock *b, PetscInt q, PetscReal weight)
{
  static const PetscReal one[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const PetscInt        *node;
  const PetscReal       *S, *slope;
  const PetscInt         n = FrictionOwnNodes(b->pair, q, &node, &S);
  PetscInt               n_lever;
  const FrictionFoot    *foot;
  PetscBool              found;

  PetscFunctionBeginUser;
  PetscCall(FrictionPointFoot(b->pair, q, &foot, &found));
  if (b->pair->master && !found) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt a = 0; a < n; a++) AddShare(b, node[a], one, weight * S[a], NULL);
  if (!found) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < foot->nodes; k++) {
    PetscReal sign[3];
    PetscInt  at;

    FrictionNodeSign(b->pair, FrictionFootPoint(b->pair, q, k), &at, sign);
    AddShare(b, at, one, -weight * foot->N[k], sign);
  }
  n_lever = FrictionLeverNodes(b->pair, q, &node, &slope);
  for (PetscInt k = 0; k < n_lever; k++) {
    PetscReal force[3][3];

    FrictionLeverForces(&b->pair->friction->lever[q], foot, &slope[2 * k], force);
    AddShare(b, node[k], force, weight, NULL);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the derivatives of the force on one node, with the forces of slave point q held. sign: of the node, see
   FrictionNodeSign(). */
static PetscErrorCode AddNodeMotion(TermBlock *b, PetscInt q, const FrictionFoot *foot, PetscInt at,
                                    const PetscReal sign[3], FrictionFootVariation *by)
{
  const ContactPair *pair = b->pair;
  const PetscInt    *node;
  const PetscReal   *S, *slope;
  PetscInt           n = FrictionOwnNodes(pair, q, &node, &S);
  PetscReal         *rows;

  PetscFunctionBeginUser;
  if (pair->work->slot[at] < 0) PetscFunctionReturn(PETSC_SUCCESS);
  rows = &b->value[b->row_of[pair->work->slot[at]] * b->dim * b->columns];
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      by->by_place[i][j] *= sign[i];
      by->by_normal[i][j] *= sign[i];
      for (int a = 0; a < 2; a++) by->by_tangent[a][i][j] *= sign[i];
    }
  }
  for (PetscInt a = 0; a < n; a++) AddColumns(b, rows, node[a], S[a], by->by_place, NULL);
  for (int l = 0; l < foot->nodes; l++) {
    PetscReal other[3];
    PetscInt  with;

    FrictionNodeSign(pair, FrictionFootPoint(pair, q, l), &with, other);
    AddColumns(b, rows, with, -foot->N[l], by->by_place, other);
  }
  n = FrictionLeverNodes(pair, q, &node, &slope);
  for (PetscInt l = 0; l < n; l++)
    for (int a = 0; a < b->dim - 1; a++) AddColumns(b, rows, node[l], slope[2 * l + a], by->by_tangent[a], NULL);
  AddTurns(b, rows, by->by_normal);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds how the force F of slave point q moves over the nodes of the foot's face, and how those of its lever move, where
   F is held. */
static PetscErrorCode AddFootMotion(TermBlock *b, PetscInt q, const PetscReal F[3])
{
  const ContactPair    *pair   = b->pair;
  const PetscReal       one[3] = {1, 1, 1}, *slope;
  const FrictionFoot   *foot;
  FrictionFootVariation by;
  const PetscInt       *node;
  PetscInt              n;
  PetscBool             found;

  PetscFunctionBeginUser;
  PetscCall(FrictionPointFoot(pair, q, &foot, &found));
  if (!found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SpreadTurns(b, q));
  for (int k = 0; k < foot->nodes; k++) {
    PetscReal sign[3];
    PetscInt  at;

    FrictionNodeSign(pair, FrictionFootPoint(pair, q, k), &at, sign);
    FrictionFootVary(foot, F, k, &by);
    PetscCall(AddNodeMotion(b, q, foot, at, sign, &by));
  }
  n = FrictionLeverNodes(pair, q, &node, &slope);
  for (PetscInt k = 0; k < n; k++) {
    FrictionLeverVary(&pair->friction->lever[q], foot, F, &slope[2 * k], &by);
    PetscCall(AddNodeMotion(b, q, foot, node[k], one, &by));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the derivative of the traction of a term over the nodes of the block. */
static PetscErrorCode AddTraction(TermBlock *b, PetscInt c, const FrictionTraction *out)
{
  const ContactPair *pair = b->pair;
  PetscReal          area = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++)
    if (FrictionTermTakes(pair, k)) area += pair->term_weight[k] * pair->factor[pair->term_point[k]];
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt  q      = pair->term_point[k];
    const PetscReal weight = pair->term_weight[k] * pair->factor[q];

    if (!FrictionTermTakes(pair, k)) continue;
    PetscCall(AddVariations(b, b->by_node, q, weight / area, out->by_normal, out->by_gap));
    if (pair->friction->face[q] < 0) continue;
    AddSlipColumns(b, q, weight / area, out);
  }
  AddAlongColumns(b, FrictionTermGuide(pair, c), out);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the motion over the master of the forces of a term's slave points. Where terms share their points, the forces
   are summed, and FrictionFaceBlock() adds it once for each point. */
static PetscErrorCode AddTermMotion(TermBlock *b, PetscInt c, const PetscReal traction[3])
{
  const ContactPair *pair = b->pair;

  PetscFunctionBeginUser;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt q = pair->term_point[k];
    PetscReal      F[3];

    if (!FrictionTermTakes(pair, k)) continue;
    for (int d = 0; d < 3; d++) F[d] = pair->term_weight[k] * pair->factor[q] * traction[d];
    if (pair->formulation.surface)
      for (int d = 0; d < 3; d++) pair->friction->held[3 * q + d] += F[d];
    else
      PetscCall(AddFootMotion(b, q, F));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The traction whose motion over the master counts: no more than what sticks at the pressure whose turning counts.
   Beyond that it would make the tangent of a soft master indefinite. A rigid one has no unknowns that its forces move.
 */
static void MovingTraction(const ContactPair *pair, PetscInt c, PetscReal t, const FrictionInput *in,
                           const FrictionTraction *out, PetscReal moves[3])
{
  PetscReal most, length, area;
  LawValue  value;

  for (int d = 0; d < 3; d++) moves[d] = out->traction[d];
  if (!pair->master || pair->master->rigid) return;
  ContactTermLaw(pair, c, t, &value, NULL, &area);
  most   = FrictionBound(in, ContactTermTurningPressure(pair, c, t, &value));
  length = PetscSqrtReal(PetscSqr(out->traction[0]) + PetscSqr(out->traction[1]) + PetscSqr(out->traction[2]));
  for (int d = 0; d < 3 && length > most; d++) moves[d] *= most / length;
}

/* Fills the block: the derivative of the traction, taken to the nodes, and the motion of its forces over the master.
   moves: the traction whose motion counts. */
static PetscErrorCode FillBlock(TermBlock *b, PetscInt c, const FrictionTraction *out, const PetscReal moves[3])
{
  const ContactPair *pair = b->pair;
  const int          dim  = b->dim;

  PetscFunctionBeginUser;
  PetscCall(AddTraction(b, c, out));
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt q = pair->term_point[k];

    if (FrictionTermTakes(pair, k)) PetscCall(AddShares(b, q, pair->term_weight[k] * pair->factor[q]));
  }
  PetscCall(PetscCalloc1(b->n_rows * dim * b->columns, &b->value));
  PetscCall(PetscMalloc1(dim * b->columns, &b->turns));
  for (PetscInt r = 0; r < b->n_rows * dim; r++)
    for (int d = 0; d < dim; d++)
      for (PetscInt j = 0; j < b->columns; j++)
        b->value[r * b->columns + j] += b->share[r * dim + d] * b->by_node[d * b->columns + j];
  PetscCall(AddTermMotion(b, c, moves));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a block against a tool with unknowns, completed by the rows and columns of the tool. out: traction whose shares
   are on the nodes; NULL: the block is the derivative of no force. */
static PetscErrorCode AddWithTool(const TermBlock *b, BlockMatrix blocks, int list, PetscInt n, const PetscInt nodes[],
                                  const FrictionTraction *out)
{
  const int      dim = b->dim;
  const PetscInt m = n * dim, tool = b->pair->lists->tool;
  PetscInt      *rows = b->row_node, n_rows = 0;
  PetscReal     *M, *force;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(m * m, &M, m, &force));
  for (PetscInt r = 0; r < b->n_rows * dim; r++) {
    const PetscInt i = b->pair->work->slot[b->row_node[r / dim]] * dim + r % dim;

    PetscCall(PetscArraycpy(&M[i * m], &b->value[r * m], m));
    for (int d = 0; out && d < dim; d++) force[i] += b->share[r * dim + d] * out->traction[d];
  }
  PetscCall(ContactToolBlock(b->pair, n, nodes, force, M));
  for (PetscInt i = 0; i < n; i++) {
    if (nodes[i] >= tool + TOOL_NODES) continue;
    rows[n_rows] = nodes[i];
    if (n_rows < i) PetscCall(PetscArraymove(&M[n_rows * dim * m], &M[i * dim * m], dim * m));
    n_rows++;
  }
  PetscCall(BlockMatrixAddRows(blocks, list, n_rows, rows, n, nodes, M));
  PetscCall(PetscFree2(M, force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the block to the matrix. out: as for AddWithTool(). */
static PetscErrorCode AddBlock(const TermBlock *b, BlockMatrix blocks, int list, PetscInt n, const PetscInt nodes[],
                               const FrictionTraction *out)
{
  PetscFunctionBeginUser;
  if (b->pair->tool)
    PetscCall(AddWithTool(b, blocks, list, n, nodes, out));
  else
    PetscCall(BlockMatrixAddRows(blocks, list, b->n_rows, b->row_node, n, nodes, b->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes room for the rows of a block of n nodes, and lists none. */
static PetscErrorCode RowsBegin(TermBlock *b, PetscInt n)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &b->row_node, n, &b->row_of));
  for (PetscInt i = 0; i < n; i++) b->row_of[i] = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RowsEnd(TermBlock *b)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(b->row_node, b->row_of));
  PetscCall(PetscFree(b->value));
  PetscCall(PetscFree(b->turns));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FrictionTermBlock - adds the tangent of a term's friction. Where terms share their points, the motion of the forces
  over the master is left to FrictionFaceBlock().

  Not collective

  Input Parameters:
+ pair   - the pair, projected, after FrictionTermPrepare() and ContactWorkBlockBegin() with the block's nodes
. blocks - the matrix
. list   - the pair's list in it
. c      - the term
. t      - load parameter
. n      - nodes of the block, of FrictionTermNodes()
- nodes  - these nodes
@*/
PetscErrorCode FrictionTermBlock(const ContactPair *pair, BlockMatrix blocks, int list, PetscInt c, PetscReal t,
                                 PetscInt n, const PetscInt nodes[])
{
  const int        dim = pair->mesh->dim;
  TermBlock        b   = {.pair = pair, .dim = dim, .columns = n * dim};
  FrictionInput    in;
  FrictionTraction out;
  PetscReal        moves[3];
  PetscBool        acts;

  PetscFunctionBeginUser;
  PetscCall(FrictionTerm(pair, c, t, &in, &out, &acts));
  if (!acts) PetscFunctionReturn(PETSC_SUCCESS);
  MovingTraction(pair, c, t, &in, &out, moves);
  PetscCall(PetscCalloc2(dim * b.columns, &b.by_node, n * dim * dim, &b.share));
  PetscCall(RowsBegin(&b, n));
  PetscCall(FillBlock(&b, c, &out, moves));
  PetscCall(AddBlock(&b, blocks, list, n, nodes, &out));
  PetscCall(PetscFree2(b.by_node, b.share));
  PetscCall(RowsEnd(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the nodes on which the reaction and the lever's forces of slave point q act. */
static PetscErrorCode AddFootRows(TermBlock *b, PetscInt q)
{
  const FrictionFoot *foot;
  PetscBool           found;
  const PetscInt     *lever;
  const PetscReal    *slope;
  PetscInt            n;

  PetscFunctionBeginUser;
  PetscCall(FrictionPointFoot(b->pair, q, &foot, &found));
  if (!found) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < foot->nodes; k++) {
    PetscReal sign[3];
    PetscInt  at;

    FrictionNodeSign(b->pair, FrictionFootPoint(b->pair, q, k), &at, sign);
    AddRow(b, at);
  }
  n = FrictionLeverNodes(b->pair, q, &lever, &slope);
  for (PetscInt k = 0; k < n; k++) AddRow(b, lever[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FrictionFaceBlock - adds how the forces of friction on a face's slave points move over the master, where they are
  held.

  Not collective

  Input Parameters:
+ pair   - the pair, after FrictionTermBlock() for all terms and ContactWorkBlockBegin() with the block's nodes
. blocks - the matrix
. list   - the pair's list in it
. face   - the face
. n      - nodes of the block, of FrictionFaceNodes()
- nodes  - these nodes

  Note:
  A force of which terms have shares is linear in them, and so is this.
@*/
PetscErrorCode FrictionFaceBlock(const ContactPair *pair, BlockMatrix blocks, int list, PetscInt face, PetscInt n,
                                 const PetscInt nodes[])
{
  const PetscInt   first = pair->slaves->first[face], end = pair->slaves->first[face + 1];
  const int        dim  = pair->mesh->dim;
  const PetscReal *held = pair->friction->held;
  TermBlock        b    = {.pair = pair, .dim = dim, .columns = n * dim};

  PetscFunctionBeginUser;
  PetscCall(RowsBegin(&b, n));
  for (PetscInt q = first; q < end; q++)
    if (pair->friction->taken[q]) PetscCall(AddFootRows(&b, q));
  PetscCall(PetscCalloc1(b.n_rows * dim * b.columns, &b.value));
  PetscCall(PetscMalloc1(dim * b.columns, &b.turns));
  for (PetscInt q = first; q < end; q++)
    if (held[3 * q] != 0 || held[3 * q + 1] != 0 || held[3 * q + 2] != 0) PetscCall(AddFootMotion(&b, q, &held[3 * q]));
  if (b.n_rows) PetscCall(AddBlock(&b, blocks, list, n, nodes, NULL));
  PetscCall(RowsEnd(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FrictionTermAlong - computes how the traction of a term changes along a motion of the contact nodes.

  Not collective

  Input Parameters:
+ pair   - the pair, projected
. c      - the term
. out    - what the law says of it, of FrictionTerm()
- motion - motion[contact nodes*dim] (length), relative to a tool with unknowns, see ContactToolRelative()

  Output Parameter:
. change - of the traction (force per area), in the frame of such a tool
@*/
PetscErrorCode FrictionTermAlong(const ContactPair *pair, PetscInt c, const FrictionTraction *out,
                                 const PetscReal *motion, PetscReal change[3])
{
  const int dim = pair->mesh->dim;
  TermBlock b   = {.pair = pair, .dim = dim};
  PetscInt *nodes, n;

  PetscFunctionBeginUser;
  PetscCall(FrictionTermPrepare(pair, c));
  PetscCall(FrictionTermNodes(pair, c));
  n         = pair->work->count;
  b.columns = n * dim;
  PetscCall(PetscMalloc1(n, &nodes));
  PetscCall(PetscArraycpy(nodes, pair->work->number, n));
  PetscCall(PetscCalloc1(dim * b.columns, &b.by_node));
  PetscCall(ContactWorkBlockBegin(pair->work, pair->lists->n_nodes, n, nodes));
  PetscCall(AddTraction(&b, c, out));
  ContactWorkBlockEnd(pair->work, n, nodes);
  for (int d = 0; d < 3; d++) change[d] = 0;
  for (int d = 0; d < dim; d++)
    for (PetscInt j = 0; j < b.columns; j++)
      change[d] += b.by_node[d * b.columns + j] * motion[nodes[j / dim] * dim + j % dim];
  PetscCall(PetscFree(b.by_node));
  PetscCall(PetscFree(nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
