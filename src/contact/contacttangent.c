/* The tangent of the contact forces, and its product with a vector. */
#include "contactimpl.h"

/* Finds the stiffness of the terms, 0 where they take no part, and the forces of slave points that turn with the
   surface. */
static PetscErrorCode PairStiffness(Contact contact, ContactPair *pair, const PetscReal *u, PetscReal t)
{
  PetscFunctionBeginUser;
  PetscCall(ContactPairProject(contact, pair, u, t));
  PetscCall(PetscArrayzero(pair->point_force, pair->lists->n_slaves));
  for (PetscInt c = 0; c < pair->n; c++) {
    LawValue  value;
    PetscReal area;

    ContactTermLaw(pair, c, t, &value, NULL, &area);
    pair->stiffness_before[c] = pair->stiffness[c];
    pair->stiffness[c]        = value.stiffness;
    if (value.stiffness > 0)
      ContactTermPress(pair, c, ContactTermTurningPressure(pair, c, t, &value), pair->point_force);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Names the block over the nodes that were listed last. */
static PetscErrorCode NameListed(Contact contact, const ContactPair *pair, int p)
{
  PetscFunctionBeginUser;
  PetscCall(BlockMatrixName(contact->blocks, p, pair->work->count, pair->work->number,
                            (PetscBool)(contact->product || pair->tool)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Names the block over the nodes of some slave points, unless there are none. */
static PetscErrorCode NameBlock(Contact contact, const ContactPair *pair, int p, PetscInt n, const PetscInt *points)
{
  PetscFunctionBeginUser;
  PetscCall(ContactVariationsNodes(pair, n, points));
  PetscCall(NameListed(contact, pair, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Names the block of an active term, with the nodes of its friction where there is any. */
static PetscErrorCode NameTerm(Contact contact, const ContactPair *pair, int p, PetscInt c)
{
  PetscFunctionBeginUser;
  if (pair->friction) {
    PetscCall(FrictionTermNodes(pair, c));
    PetscCall(NameListed(contact, pair, p));
  } else
    PetscCall(
      NameBlock(contact, pair, p, pair->term_ptr[c + 1] - pair->term_ptr[c], &pair->term_point[pair->term_ptr[c]]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the loaded points of a face, which share most of their nodes. */
static PetscInt FacePoints(const ContactPair *pair, PetscInt face, PetscInt points[FACE_RULE_POINTS])
{
  PetscInt n = 0;

  for (PetscInt q = pair->slaves->first[face]; q < pair->slaves->first[face + 1]; q++)
    if (pair->point_force[q] != 0) points[n++] = q;
  return n;
}

/* Names the block of a face's loaded points and, with friction, of those that terms take. */
static PetscErrorCode NameFace(Contact contact, const ContactPair *pair, int p, PetscInt face)
{
  PetscInt       points[FACE_RULE_POINTS];
  const PetscInt n = FacePoints(pair, face, points);

  PetscFunctionBeginUser;
  if (pair->friction) {
    PetscCall(FrictionFaceNodes(pair, face, n, points));
    PetscCall(NameListed(contact, pair, p));
  } else
    PetscCall(NameBlock(contact, pair, p, n, points));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether a term has a block: it presses, or friction alone acts, as where a fluid bears all of the pressure. */
static PetscBool HasBlock(const ContactPair *pair, PetscInt c)
{
  return (PetscBool)(pair->stiffness[c] > 0 || (pair->friction && FrictionTermActs(pair, c, 0)));
}

/* Names the blocks of a pair: one for each active term and, where terms share their points, one for each loaded face.
 */
static PetscErrorCode PairName(Contact contact, const ContactPair *pair, int p)
{
  PetscFunctionBeginUser;
  if (pair->friction) PetscCall(FrictionTangentBegin(pair));
  for (PetscInt c = 0; c < pair->n; c++)
    if (HasBlock(pair, c)) PetscCall(NameTerm(contact, pair, p, c));
  for (PetscInt face = 0; pair->formulation.surface && face < pair->slaves->n_faces; face++)
    PetscCall(NameFace(contact, pair, p, face));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forces of slave points on the nodes of the block at hand, as residual force[n*dim]. */
static void PointForces(const ContactPair *pair, PetscInt points, const PetscInt *point, PetscReal *force)
{
  const int                dim = pair->mesh->dim;
  const ContactVariations *v   = pair->variations;

  for (PetscInt k = 0; k < points; k++) {
    for (PetscInt i = v->first[point[k]]; pair->point_force[point[k]] != 0 && i < v->end[point[k]]; i++) {
      const int place = pair->work->slot[v->number[i]];

      for (int d = 0; place >= 0 && d < dim; d++)
        force[place * dim + d] -= pair->point_force[point[k]] * v->N[i * dim + d];
    }
  }
}

/* Completes the sum of second variations in the work's M, of some slave points, by the dofs of a tool. */
static PetscErrorCode CoupleTool(const ContactPair *pair, PetscInt points, const PetscInt *point, PetscInt n,
                                 const PetscInt *nodes)
{
  const int      dim = pair->mesh->dim;
  const PetscInt m   = n * dim;
  PetscReal     *M   = pair->work->M, *force;

  PetscFunctionBeginUser;
  if (!pair->tool) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = 0; j < i; j++) M[i * m + j] = M[j * m + i]; /* it has its upper triangle */
  PetscCall(PetscCalloc1(m, &force));
  PointForces(pair, points, point, force);
  PetscCall(ContactToolBlock(pair, n, nodes, force, M));
  PetscCall(PetscFree(force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the block that the work's sum of second variations of some slave points makes, with the dofs of a tool. It is
   not formed where blocks are kept as factors. */
static PetscErrorCode AddSecond(Contact contact, const ContactPair *pair, int p, PetscInt points, const PetscInt *point,
                                PetscInt n, const PetscInt *nodes)
{
  FitDerivativesSum *sum = &pair->work->sum;

  PetscFunctionBeginUser;
  if (BlockMatrixKeepsFactors(contact->blocks) && !pair->tool) {
    FitDerivativesJoin(sum);
    PetscCall(BlockMatrixAddFactors(contact->blocks, p, n, nodes, sum->depth, sum->stride, sum->K, sum->J));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  ContactSecondEnd(pair);
  PetscCall(CoupleTool(pair, points, point, n, nodes));
  PetscCall(BlockMatrixAdd(contact->blocks, p, n, nodes, pair->work->M));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the second variation of a loaded slave point to the sum. With friction the derivatives of its own N are kept,
   too. */
static PetscErrorCode AddPoint(const ContactPair *pair, PetscInt q, double (*own)[FIT_DERIVATIVES_OWN])
{
  PetscBool found;

  PetscFunctionBeginUser;
  PetscCall(ContactSecondAdd(pair, q, -pair->point_force[q], own, &found));
  if (found && pair->friction) PetscCall(FrictionTurnsKeep(pair, q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the block A psi'' Nbar Nbar^T of a term. It stands alone where the term shares its points; else it comes with
   -p M of its one point. */
static PetscErrorCode TermBlock(Contact contact, const ContactPair *pair, int p, PetscInt c, PetscInt n,
                                const PetscInt *nodes, double (*own)[FIT_DERIVATIVES_OWN])
{
  const PetscInt q = pair->term_point[pair->term_ptr[c]];
  PetscReal     *v, area;

  PetscFunctionBeginUser;
  if (pair->stiffness[c] == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(n * contact->mesh->dim + BLOCK_PADDING, &v));
  ContactTermGap(pair, pair->factor, pair->point_gap, c, &area);
  ContactTermVary(pair, c, PetscSqrtReal(pair->stiffness[c] / area), v);
  if (pair->formulation.surface)
    PetscCall(BlockMatrixAddOuter(contact->blocks, p, n, nodes, v));
  else {
    PetscCall(ContactSecondBegin(pair, n, 1));
    FitDerivativesAddOuter(&pair->work->sum, 1, v);
    if (pair->point_force[q] != 0) PetscCall(AddPoint(pair, q, own));
    PetscCall(AddSecond(contact, pair, p, 1, &q, n, nodes));
  }
  PetscCall(PetscFree(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the block -sum p M of the points of one face, whose second variations are summed before they are carried to
   nodes. */
static PetscErrorCode FaceBlock(Contact contact, const ContactPair *pair, int p, PetscInt face, PetscInt n,
                                const PetscInt *nodes, double (*own)[FIT_DERIVATIVES_OWN])
{
  PetscInt       points[FACE_RULE_POINTS];
  const PetscInt loaded = FacePoints(pair, face, points);

  PetscFunctionBeginUser;
  PetscCall(ContactSecondBegin(pair, n, loaded));
  for (PetscInt k = 0; k < loaded; k++) PetscCall(AddPoint(pair, points[k], own));
  PetscCall(AddSecond(contact, pair, p, loaded, points, n, nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds what belongs to the fit points one by one, for all slave points at once. Points of one face are made of the
   same nodes and share a block. */
static PetscErrorCode OwnBlocks(Contact contact, const ContactPair *pair, int p,
                                const double (*own)[FIT_DERIVATIVES_OWN])
{
  NeighbourLists lists = pair->lists;

  PetscFunctionBeginUser;
  for (PetscInt first = 0, end; first < lists->n_points; first = end) {
    PetscInt  n, with, *nodes;
    PetscReal most = 0;

    end = NeighbourListsAlikeEnd(lists, first);
    for (PetscInt k = first; k < end; k++)
      for (int e = 0; e < FIT_DERIVATIVES_OWN; e++) most = PetscMax(most, PetscAbsReal(own[k][e]));
    if (most == 0) continue;
    PetscCall(ContactPointsToNodes(pair, first, end));
    nodes = pair->work->number;
    PetscCall(BlockMatrixSort(contact->blocks, p, pair->work->count, nodes, &with));
    n = contact->product ? pair->work->count : with;
    PetscCall(ContactWorkBlockBegin(pair->work, pair->lists->n_nodes, n, nodes));
    PetscCall(ContactOwnToNodes(pair, n, first, end, own));
    PetscCall(BlockMatrixAdd(contact->blocks, p, n, nodes, pair->work->M));
    ContactWorkBlockEnd(pair->work, n, nodes);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Goes on to the next block of a pair with nodes on this rank, of those that PairName() named: term number *k, or face
   number *k - pair->n. *block: number of the next named block. Returns PETSC_FALSE behind the last one. */
static PetscBool NextBlock(Contact contact, const ContactPair *pair, PetscInt *k, PetscInt *block, PetscInt *n,
                           const PetscInt **nodes)
{
  const PetscInt faces = pair->formulation.surface ? pair->slaves->n_faces : 0;

  for (; *k < pair->n + faces; (*k)++) {
    if (*k < pair->n && !HasBlock(pair, *k)) continue;
    BlockMatrixGetNodes(contact->blocks, (*block)++, n, nodes);
    if (*n) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Adds the blocks of friction of a pair, whose first named block is `block`. Those of terms come before those of
   faces, which need the forces of all terms. */
static PetscErrorCode FrictionBlocks(Contact contact, ContactPair *pair, int p, PetscReal t, PetscInt block)
{
  const PetscInt *nodes;
  PetscInt        n;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; NextBlock(contact, pair, &k, &block, &n, &nodes); k++) {
    if (k < pair->n) PetscCall(FrictionTermPrepare(pair, k));
    PetscCall(ContactWorkBlockBegin(pair->work, pair->lists->n_nodes, n, nodes));
    if (k < pair->n)
      PetscCall(FrictionTermBlock(pair, contact->blocks, p, k, t, n, nodes));
    else
      PetscCall(FrictionFaceBlock(pair, contact->blocks, p, k - pair->n, n, nodes));
    ContactWorkBlockEnd(pair->work, n, nodes);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the blocks of a pair in the order in which PairName() named them, from block number *block on. */
static PetscErrorCode PairBlocks(Contact contact, ContactPair *pair, int p, PetscReal t, PetscInt *block)
{
  const PetscInt  first = *block;
  const PetscInt *nodes;
  PetscInt        n;
  double(*own)[FIT_DERIVATIVES_OWN] = NULL;

  PetscFunctionBeginUser;
  if (pair->fit.fitted) PetscCall(PetscCalloc1(pair->lists->n_points, &own));
  for (PetscInt k = 0; NextBlock(contact, pair, &k, block, &n, &nodes); k++) {
    PetscCall(ContactWorkBlockBegin(pair->work, pair->lists->n_nodes, n, nodes));
    if (k < pair->n)
      PetscCall(TermBlock(contact, pair, p, k, n, nodes, own));
    else
      PetscCall(FaceBlock(contact, pair, p, k - pair->n, n, nodes, own));
    ContactWorkBlockEnd(pair->work, n, nodes);
  }
  if (pair->fit.fitted) PetscCall(OwnBlocks(contact, pair, p, own));
  if (pair->friction) PetscCall(FrictionBlocks(contact, pair, p, t, first));
  PetscCall(PetscFree(own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactMatrixRows - counts the rows of the contact matrix on this rank: the free dofs that it owns.

  Not collective

  Input Parameter:
. contact - the contact

  Output Parameter:
. rows - their number
@*/
PetscErrorCode ContactMatrixRows(Contact contact, PetscInt *rows)
{
  PetscFunctionBeginUser;
  *rows = contact->mesh->n_free;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Names all blocks and finds their places in the matrix. */
static PetscErrorCode PlaceBlocks(Contact contact, PetscBool *changed)
{
  const PetscInt **dof;
  PetscInt        *n, rows;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(contact->n_pairs, &dof, contact->n_pairs, &n));
  for (int p = 0; p < contact->n_pairs; p++) {
    dof[p] = contact->pairs[p].lists->dof;
    n[p]   = contact->pairs[p].lists->n_nodes;
  }
  PetscCall(BlockMatrixBegin(contact->blocks, contact->n_pairs, n, dof));
  PetscCall(PetscFree2(dof, n));
  for (int p = 0; p < contact->n_pairs; p++) PetscCall(PairName(contact, &contact->pairs[p], p));
  PetscCall(ContactMatrixRows(contact, &rows));
  PetscCall(BlockMatrixPlace(contact->blocks, rows, changed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactKeepFactors - lets the next tangents be matrices that multiply but have no entries, which are made in less
  time.

  Collective

  Input Parameter:
. contact - the contact; its tangents are symmetric
@*/
PetscErrorCode ContactKeepFactors(Contact contact)
{
  PetscInt rows;

  PetscFunctionBeginUser;
  PetscCall(ContactMatrixRows(contact, &rows));
  PetscCall(BlockMatrixKeepFactors(contact->blocks, rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactTangent - computes the derivative of ContactResidual()'s forces with respect to the free displacements.

  Collective

  Input Parameters:
+ contact - the contact, with lists
. u       - local displacements, u[n_nodes*dim] (length), ghosts included
- t       - load parameter

  Output Parameters:
+ C       - matrix over the global free dofs; it belongs to the contact
- changed - PETSC_TRUE where its pattern is new

  Note:
  It is the sum of A (psi'' N N^T - p M) over the closed terms, p being the pressure, and of friction's part, which is
  not symmetric. Source: Chamoret et al. (2004), eq. 14.
@*/
PetscErrorCode ContactTangent(Contact contact, const PetscReal *u, PetscReal t, Mat *C, PetscBool *changed)
{
  PetscInt block = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_tangent, 0, 0, 0, 0));
  for (int p = 0; p < contact->n_pairs; p++) PetscCall(PairStiffness(contact, &contact->pairs[p], u, t));
  PetscCall(PlaceBlocks(contact, changed));
  for (int p = 0; p < contact->n_pairs; p++) {
    if (contact->product)
      BlockMatrixMultiply(contact->blocks, contact->transposed, contact->product[p].x, contact->product[p].y);
    PetscCall(PairBlocks(contact, &contact->pairs[p], p, t, &block));
  }
  PetscCall(BlockMatrixEnd(contact->blocks, C));
  PetscCall(PetscLogEventEnd(contact->event_tangent, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactForgetForeseen - forgets the pressures that the last linear step was to lead to. The next tangent is the
  derivative of the forces, until another step has been made.

  Not collective

  Input Parameter:
. contact - the contact
@*/
void ContactForgetForeseen(Contact contact)
{
  for (int p = 0; p < contact->n_pairs; p++)
    for (PetscInt c = 0; c < contact->pairs[p].n; c++) contact->pairs[p].foreseen[c] = NAN;
}

/*@
  ContactMultiplyBegin - begins a product: the next ContactTangent() is multiplied with x, prescribed dofs included.

  Collective

  Input Parameters:
+ contact - the contact; its lists must stay until ContactMultiplyEnd()
. x       - local displacements, x[n_nodes*dim] (length), ghosts included
. t       - load parameter where the motion of rigid tools begins, which is joined to x
- t_next  - load parameter where it ends
@*/
PetscErrorCode ContactMultiplyBegin(Contact contact, const PetscReal *x, PetscReal t, PetscReal t_next)
{
  PetscFunctionBeginUser;
  contact->transposed = PETSC_FALSE;
  PetscCall(PetscMalloc1(contact->n_pairs, &contact->product));
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair    *pair    = &contact->pairs[p];
    ContactProduct *product = &contact->product[p];
    const PetscInt  n       = pair->lists->n_nodes * contact->mesh->dim;

    PetscCall(PetscCalloc2(n, &product->x, n, &product->y));
    PetscCall(ContactPairMove(contact, pair, x, t, t_next, product->x));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactMultiplyTransposed - makes the product that was begun one with the transposed tangent, and adds to what the
  parts of some pairs are multiplied with.

  Collective

  Input Parameters:
+ contact - after ContactMultiplyBegin()
. pairs   - of which pairs; NULL: nothing is added
- x       - local vector x[n_nodes*dim], ghosts included
@*/
PetscErrorCode ContactMultiplyTransposed(Contact contact, const PetscBool pairs[], const PetscReal *x)
{
  PetscFunctionBeginUser;
  contact->transposed = PETSC_TRUE;
  for (int p = 0; p < contact->n_pairs && pairs; p++) {
    ContactPair   *pair = &contact->pairs[p];
    const PetscInt n    = pair->lists->n_nodes * contact->mesh->dim;
    PetscReal     *values;

    if (!pairs[ContactIsRidge(pair) ? pair->tool_pair : p]) continue;
    PetscCall(PetscCalloc1(n, &values));
    PetscCall(ContactPairMove(contact, pair, x, pair->t, pair->t, values));
    for (PetscInt i = 0; i < n; i++) contact->product[p].x[i] += values[i];
    PetscCall(PetscFree(values));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactMultiplyEnd - adds C x of the tangent since ContactMultiplyBegin().

  Collective

  Input Parameter:
. contact - the contact

  Input/Output Parameter:
. y - local forces, y[n_nodes*dim], complete at owned nodes
@*/
PetscErrorCode ContactMultiplyEnd(Contact contact, PetscReal *y)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    PetscCall(NeighbourListsReduce(contact->pairs[p].lists, contact->product[p].y, y));
    PetscCall(PetscFree2(contact->product[p].x, contact->product[p].y));
  }
  PetscCall(PetscFree(contact->product));
  PetscFunctionReturn(PETSC_SUCCESS);
}
