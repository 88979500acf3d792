#include "contactimpl.h"

/* Terms of the last tangent on this rank, and the entries of their vectors at most */
static void CountMine(Contact contact, PetscInt *terms, PetscInt *entries)
{
  *terms = *entries = 0;
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++) {
      if (!(pair->stiffness[c] > 0)) continue;
      ++*terms;
      for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
        const PetscInt q = pair->term_point[k];

        if (pair->factor[q] != 0) *entries += (pair->variations->end[q] - pair->variations->first[q]) * contact->mesh->dim;
      }
    }
  }
}

/* The vector of a term: the first variation of its gap times the root of its stiffness, over the free dofs. */
static void AddTerm(const ContactPair *pair, PetscInt c, ContactBorder *border)
{
  const int                dim = pair->mesh->dim;
  const ContactVariations *v   = pair->variations;
  const PetscInt          *dof = pair->lists->dof;
  PetscReal                area;
  PetscInt                 n = border->ptr[border->n];

  ContactTermGap(pair, pair->factor, pair->point_gap, c, &area);
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt  q      = pair->term_point[k];
    const PetscReal weight = PetscSqrtReal(pair->stiffness[c] / area) * pair->term_weight[k] * pair->factor[q];

    if (pair->factor[q] == 0) continue;
    for (PetscInt i = v->first[q] * dim; i < v->end[q] * dim; i++) {
      const PetscInt row = dof[v->number[i / dim] * dim + i % dim];

      if (row < 0) continue;
      border->row[n]     = row;
      border->value[n++] = weight * v->N[i];
    }
  }
  border->ptr[++border->n] = n;
}

/* ContactGetBorder - what the terms of the last tangent add to it, C, as a sum of v v^T, but for pressures that turn with the surface.

   Not collective. C: of ContactTangent(). The arrays are the contact's, until the next call. */
PetscErrorCode ContactGetBorder(Contact contact, Mat C, Border *out)
{
  ContactBorder *border = &contact->border;
  PetscInt       terms, entries;

  PetscFunctionBeginUser;
  CountMine(contact, &terms, &entries);
  PetscCall(PetscRealloc((terms + 1) * sizeof(PetscInt), &border->ptr));
  PetscCall(PetscRealloc((entries + 1) * sizeof(PetscInt), &border->row));
  PetscCall(PetscRealloc((entries + 1) * sizeof(PetscScalar), &border->value));
  border->n      = 0;
  border->ptr[0] = 0;
  for (int p = 0; p < contact->n_pairs; p++)
    for (PetscInt c = 0; c < contact->pairs[p].n; c++)
      if (contact->pairs[p].stiffness[c] > 0) AddTerm(&contact->pairs[p], c, border);
  *out = (Border){.sum = C, .n = border->n, .ptr = border->ptr, .row = border->row, .value = border->value};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactHasFits - does a surface of some pair couple many nodes to each slave node? Not collective, the same on all ranks. */
PetscBool ContactHasFits(Contact contact)
{
  for (int p = 0; p < contact->n_pairs; p++)
    if (contact->pairs[p].fit.degree && !MeshFindRigid(contact->mesh, contact->pairs[p].scene->master)) return PETSC_TRUE;
  return PETSC_FALSE;
}
