/* First variations of gaps over the free dofs: as vectors of the tangent, and for its changes. */
#include "contactimpl.h"

/* Room for one vector more, of so many entries at most. */
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

/* ContactVectorsAdd - scale times the sum of a term's points' variations, weighted by their areas, over the free dofs,
 * as one vector more. Not collective. */
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

/* ContactVectorsAddZeros - Not collective. */
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

/* ContactVectorsFree - Not collective. There are none afterwards. */
PetscErrorCode ContactVectorsFree(ContactVectors *vectors)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(vectors->ptr));
  PetscCall(PetscFree(vectors->row));
  PetscCall(PetscFree(vectors->value));
  *vectors = (ContactVectors){.n = 0};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A vector more, of zeros in the rows that the kept pattern of the tangent couples a slave node with; *n: how many
 * these are, 0: it has none of the node. */
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

/* The values of a term into the vector at hand. */
static PetscErrorCode FillTerm(Contact contact, const ContactPair *pair, PetscInt c, PetscReal scale)
{
  ContactVectors *border = &contact->border, *one = &contact->one;
  const PetscInt  first = border->ptr[border->n - 1], n = border->ptr[border->n] - first;

  PetscFunctionBeginUser;
  one->n = 0;
  PetscCall(ContactVectorsAdd(one, pair, c, scale));
  for (PetscInt k = 0; k < one->ptr[1]; k++) {
    PetscInt at;

    PetscCall(PetscFindInt(one->row[k], n, &border->row[first], &at));
    PetscCheck(at >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "the tangent's pattern lacks a node of a term");
    border->value[first + at] += one->value[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactGetBorder - what the terms of the last ContactTangent() add to it as a sum of v v^T, but for pressures that
   turn with the surface: of each the first variation of its gap times the root of its stiffness. Vectors have the
   entries that the tangent's kept pattern leaves them, those of open terms that it still has are zero, so that they
   seldom have others than before.

   Not collective. The arrays are the contact's, until the next call. */
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
        continue; /* far from the master, but maybe in another pair */
      if (acts) scale = PetscSqrtReal(pair->stiffness[c] / area);
      PetscCall(AddZeros(contact, pair->node[c], &n));
      if (acts) PetscCall(n ? FillTerm(contact, pair, c, scale) : ContactVectorsAdd(border, pair, c, scale));
    }
  }
  *out = (Border){.n = border->n, .ptr = border->ptr, .row = border->row, .value = border->value};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactHasFits - does a surface of some pair couple many nodes to each slave node? Not collective, the same on all
 * ranks. */
PetscBool ContactHasFits(Contact contact)
{
  for (int p = 0; p < contact->n_pairs; p++)
    if (contact->pairs[p].fit.fitted && !MeshFindRigid(contact->mesh, contact->pairs[p].scene->master))
      return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscInt CountMine(Contact contact)
{
  PetscInt n = 0;

  for (int p = 0; p < contact->n_pairs; p++)
    for (PetscInt c = 0; c < contact->pairs[p].n; c++)
      n += contact->pairs[p].stiffness[c] != contact->pairs[p].stiffness_before[c];
  return n;
}

/* ContactTangentChanges - terms of all ranks that came, went or changed their stiffness between the last two calls of
 * ContactTangent(). Collective. */
PetscErrorCode ContactTangentChanges(Contact contact, PetscInt *terms)
{
  PetscFunctionBeginUser;
  *terms = CountMine(contact);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, terms, 1, MPIU_INT, MPI_SUM, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactChangeVectors - what ContactTangentChanges() counts, as N diag(s) N^T: by that much the last tangent is more
   than the one before, but for the motion in between and pressures that turn with the surface.

   Collective. rows: of this rank, as of the matrix; n: of ContactTangentChanges(); s[n]: stiffness over area (force per
   length and area squared), the same on all ranks; N: dense, n columns, the caller's. */
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
