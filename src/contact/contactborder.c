#include "contactimpl.h"

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
    if (contact->pairs[p].fit.degree && !MeshFindRigid(contact->mesh, contact->pairs[p].scene->master))
      return PETSC_TRUE;
  return PETSC_FALSE;
}
