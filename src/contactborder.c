#include "contactimpl.h"

/* ContactGetBorder - what the terms of the last tangent add to it, C, as a sum of v v^T, but for pressures that turn with the surface: of each the first
   variation of its gap times the root of its stiffness.

   Not collective. C: of ContactTangent(). The arrays are the contact's, until the next call. */
PetscErrorCode ContactGetBorder(Contact contact, Mat C, Border *out)
{
  ContactVectors *border = &contact->border;

  PetscFunctionBeginUser;
  border->n = 0;
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++) {
      PetscReal area;

      if (!(pair->stiffness[c] > 0)) continue;
      ContactTermGap(pair, pair->factor, pair->point_gap, c, &area);
      PetscCall(ContactVectorsAdd(border, pair, c, PetscSqrtReal(pair->stiffness[c] / area)));
    }
  }
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
