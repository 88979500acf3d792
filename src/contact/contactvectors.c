/* First variations of gaps over the free dofs: as vectors of the tangent, and for its changes. */
#include "contactimpl.h"

/* Makes room for one vector more, of so many entries at most. */
static PetscErrorCode VectorsReserve(ContactVectors *vectors, PetscInt entries)
{
  const PetscInt used = vectors->n ? vectors->ptr[vectors->n] : 0;

  PetscFunctionBeginUser;
  if (vectors->n + 2 > vectors->vectors_room) {
    vectors->vectors_room = 2 * (vectors->n + 2);
    PetscCall(PetscRealloc(vectors->vectors_room * sizeof(PetscInt), &vectors->ptr));
  }
  if (used + entries > vectors->room) {
    vectors->room = 2 * (used + entries);
    PetscCall(PetscRealloc(vectors->room * sizeof(PetscInt), &vectors->row));
    PetscCall(PetscRealloc(vectors->room * sizeof(PetscScalar), &vectors->value));
  }
  vectors->ptr[vectors->n] = used;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactVectorsAdd - adds as one vector more: scale times the first variation of a term's gap, weighted by the areas
  of its points, over the free dofs.

  Not collective

  Input Parameters:
+ vectors - the vectors
. pair    - the pair, projected
. c       - the term
- scale   - factor
@*/
PetscErrorCode ContactVectorsAdd(ContactVectors *vectors, const ContactPair *pair, PetscInt c, PetscReal scale)
{
  const int                dim = pair->mesh->dim;
  const ContactVariations *all = pair->variations;
  const PetscInt          *dof = pair->lists->dof;
  PetscInt                 n   = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt q = pair->term_point[k];

    if (pair->factor[q] == 0) continue;
    PetscCall(ContactVariationsNeed(pair, q));
    n += (all->end[q] - all->first[q]) * dim;
  }
  PetscCall(VectorsReserve(vectors, n));
  n = vectors->ptr[vectors->n];
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt  q      = pair->term_point[k];
    const PetscReal weight = scale * pair->term_weight[k] * pair->factor[q];

    for (PetscInt i = all->first[q] * dim; weight != 0 && i < all->end[q] * dim; i++) {
      const PetscInt row = dof[all->number[i / dim] * dim + i % dim];

      if (row < 0) continue;
      vectors->row[n]     = row;
      vectors->value[n++] = weight * all->N[i];
    }
  }
  vectors->ptr[++vectors->n] = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactVectorsAddZeros - adds as one vector more: zeros in some rows.

  Not collective

  Input Parameters:
+ vectors - the vectors
. n       - number of rows
- row     - the rows
@*/
PetscErrorCode ContactVectorsAddZeros(ContactVectors *vectors, PetscInt n, const PetscInt row[])
{
  PetscInt first;

  PetscFunctionBeginUser;
  PetscCall(VectorsReserve(vectors, n));
  first = vectors->ptr[vectors->n];
  PetscCall(PetscArraycpy(&vectors->row[first], row, n));
  PetscCall(PetscArrayzero(&vectors->value[first], n));
  vectors->ptr[++vectors->n] = first + n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactVectorsFree - frees the vectors; there are none afterwards.

  Not collective

  Input Parameter:
. vectors - the vectors
@*/
PetscErrorCode ContactVectorsFree(ContactVectors *vectors)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(vectors->ptr));
  PetscCall(PetscFree(vectors->row));
  PetscCall(PetscFree(vectors->value));
  *vectors = (ContactVectors){.n = 0};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a vector with zeros in the rows that the kept pattern of the tangent couples with a slave node. *n is the number
   of these rows. It is 0 if the node is not in the pattern. */
static PetscErrorCode AddZeros(Contact contact, PetscInt node, PetscInt *n)
{
  const int       dim = contact->mesh->dim;
  const PetscInt *dof, *row;
  PetscInt        first = -1;

  PetscFunctionBeginUser;
  PetscCall(MeshGetGlobalDofs(contact->mesh, &dof));
  for (int d = 0; d < dim && first < 0; d++) first = dof[node * dim + d];
  PetscCall(BlockMatrixGetCoupled(contact->blocks, first, n, &row));
  if (*n) PetscCall(ContactVectorsAddZeros(&contact->border, *n, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does the kept pattern couple the slave nodes of a pair with what their own terms have? Points on edges of a tool are
   in no pattern. A node of listed surfaces is a master of others, too, and coupled with all that their terms have: with
   zeros there a pipe between plates had 2.5 times the vectors, and its factors took twice the operations. */
static PetscBool HasPatternOfItsOwn(const ContactPair *pair)
{
  return (PetscBool)(!ContactOnTool(pair) && !pair->scene->listed);
}

/* Adds the values of a term to the vector that was added last. The rows of a node follow each other in both, so that
   one search serves them all. */
static PetscErrorCode FillTerm(Contact contact, const ContactPair *pair, PetscInt c, PetscReal scale)
{
  ContactVectors *border = &contact->border, *one = &contact->one;
  const PetscInt  first = border->ptr[border->n - 1], n = border->ptr[border->n] - first;
  PetscInt        at = -1;

  PetscFunctionBeginUser;
  one->n = 0;
  PetscCall(ContactVectorsAdd(one, pair, c, scale));
  for (PetscInt k = 0; k < one->ptr[1]; k++) {
    if (at + 1 < n && border->row[first + at + 1] == one->row[k])
      at++;
    else
      PetscCall(PetscFindInt(one->row[k], n, &border->row[first], &at));
    PetscCheck(at >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "the tangent's pattern lacks a node of a term");
    border->value[first + at] += one->value[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a vector with the values of a term that shares its points with its neighbours, each node once. */
static PetscErrorCode AddShared(ContactVectors *border, const ContactPair *pair, PetscInt c, PetscReal scale)
{
  const int       dim = pair->mesh->dim;
  const PetscInt *dof = pair->lists->dof, first = pair->term_ptr[c];
  ContactWork    *work = pair->work;
  PetscReal      *v;
  PetscInt        n;

  PetscFunctionBeginUser;
  PetscCall(ContactVariationsNodes(pair, pair->term_ptr[c + 1] - first, &pair->term_point[first]));
  PetscCall(PetscCalloc1(work->count * dim, &v));
  PetscCall(ContactWorkBlockBegin(work, pair->lists->n_nodes, work->count, work->number));
  ContactTermVary(pair, c, scale, v);
  ContactWorkBlockEnd(work, work->count, work->number);
  PetscCall(VectorsReserve(border, work->count * dim));
  n = border->ptr[border->n];
  for (PetscInt i = 0; i < work->count * dim; i++) {
    const PetscInt row = dof[work->number[i / dim] * dim + i % dim];

    if (row < 0) continue;
    border->row[n]     = row;
    border->value[n++] = v[i];
  }
  border->ptr[++border->n] = n;
  PetscCall(PetscFree(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactGetBorder - gets what the terms of the last ContactTangent() add to it as a sum of v v^T, without pressures
  that turn with the surface.

  Not collective

  Input Parameter:
. contact - the contact

  Output Parameter:
. out - arrays of the contact, valid until its next call

  Note:
  The vector of a term is the first variation of its gap times the root of its stiffness. Vectors have the entries
  that the tangent's kept pattern leaves them, and vectors of open terms that the pattern still has are zero. So their
  entries seldom differ from those of the call before. Terms that share their points have but their own entries: the
  pattern couples them with all that their neighbours have, which would be mostly zeros and a third of the factor's
  operations.
@*/
PetscErrorCode ContactGetBorder(Contact contact, Border *out)
{
  ContactVectors *border = &contact->border;

  PetscFunctionBeginUser;
  border->n = 0;
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++) {
      const PetscBool acts = pair->stiffness[c] > 0 ? PETSC_TRUE : PETSC_FALSE;
      PetscReal       area, scale = 0;
      PetscInt        n;

      if (PetscIsNanReal(ContactTermGap(pair, pair->factor, pair->point_gap, c, &area)))
        continue; /* far from the master; another pair may have the node */
      if (acts) scale = PetscSqrtReal(pair->stiffness[c] / area);
      if (pair->formulation.surface) {
        if (acts) PetscCall(AddShared(border, pair, c, scale));
        continue;
      }
      n = 0;
      if (HasPatternOfItsOwn(pair)) PetscCall(AddZeros(contact, pair->node[c], &n));
      if (acts) PetscCall(n ? FillTerm(contact, pair, c, scale) : ContactVectorsAdd(border, pair, c, scale));
    }
  }
  *out = (Border){.n = border->n, .ptr = border->ptr, .row = border->row, .value = border->value};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactHasFits - says whether a surface of some pair couples many nodes to each slave node: a fitted master that is
  no rigid tool.

  Not collective

  Input Parameter:
. contact - the contact
@*/
PetscBool ContactHasFits(Contact contact)
{
  for (int p = 0; p < contact->n_pairs; p++)
    if (contact->pairs[p].fit.fitted && !MeshFindRigid(contact->mesh, contact->pairs[p].scene->master))
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Terms of this rank whose stiffness differs between the last two tangents. */
static PetscInt CountMine(Contact contact)
{
  PetscInt n = 0;

  for (int p = 0; p < contact->n_pairs; p++)
    for (PetscInt c = 0; c < contact->pairs[p].n; c++)
      n += contact->pairs[p].stiffness[c] != contact->pairs[p].stiffness_before[c];
  return n;
}

/*@
  ContactTangentChanges - counts the terms of all ranks that came, went or changed their stiffness between the last
  two calls of ContactTangent().

  Collective

  Input Parameter:
. contact - the contact

  Output Parameter:
. terms - their number
@*/
PetscErrorCode ContactTangentChanges(Contact contact, PetscInt *terms)
{
  PetscFunctionBeginUser;
  *terms = CountMine(contact);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, terms, 1, MPIU_INT, MPI_SUM, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactChangeVectors - writes what ContactTangentChanges() counts as N diag(s) N^T: by this the last tangent exceeds
  the one before, without the motion in between and without pressures that turn with the surface.

  Collective

  Input Parameters:
+ contact - the contact
. rows    - rows of the matrix on this rank
- n       - number of terms, of ContactTangentChanges()

  Output Parameters:
+ s - stiffness over area (force per length and area squared), s[n], the same on all ranks
- N - dense matrix with n columns; the caller destroys it
@*/
PetscErrorCode ContactChangeVectors(Contact contact, PetscInt rows, PetscInt n, PetscReal *s, Mat *N)
{
  PetscInt       mine = CountMine(contact), column = 0;
  ContactVectors vectors = {.n = 0};

  PetscFunctionBeginUser;
  PetscCall(MatCreateDense(contact->mesh->comm, rows, PETSC_DECIDE, PETSC_DETERMINE, n, NULL, N));
  PetscCallMPI(MPI_Scan(&mine, &column, 1, MPIU_INT, MPI_SUM, contact->mesh->comm));
  column -= mine;
  for (PetscInt k = 0; k < n; k++) s[k] = 0;
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++) {
      PetscReal area;

      if (pair->stiffness[c] == pair->stiffness_before[c]) continue;
      ContactTermGap(pair, pair->factor, pair->point_gap, c, &area);
      s[column] =
        (pair->stiffness[c] - pair->stiffness_before[c]) / (area > 0 ? area : 1); /* no area: a column of zeros */
      vectors.n = 0;
      PetscCall(ContactVectorsAdd(&vectors, pair, c, 1));
      PetscCall(MatSetValues(*N, vectors.ptr[1], vectors.row, 1, &column, vectors.value, ADD_VALUES));
      column++;
    }
  }
  PetscCall(ContactVectorsFree(&vectors));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s, n, MPIU_REAL, MPIU_SUM, contact->mesh->comm));
  PetscCall(MatAssemblyBegin(*N, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*N, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}
