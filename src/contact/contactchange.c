#include "contactimpl.h"

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
