/* The share of strains that vary within elements, see strainvariation.h. */
#include "errors/strainvariation.h"

/* Strain and stress at a point, as xx yy zz xy yz xz with the shears of the strain doubled: their product is the sum
   over the six. */
typedef struct {
  PetscReal strain[6], stress[6];
} PointPair;

static const int component[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};

/* Solves F S = P for the second Piola-Kirchhoff stress S, F = 1 + H, by Cramer's rule. */
static void SecondStress(const PetscReal H[9], const PetscReal P[9], PetscReal S[9])
{
  PetscReal F[9], cofactor[9], J = 0;

  for (int k = 0; k < 9; k++) F[k] = H[k] + (k % 4 == 0);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;

      cofactor[3 * i + j] = F[3 * a + c] * F[3 * b + d] - F[3 * a + d] * F[3 * b + c];
    }
  for (int j = 0; j < 3; j++) J += F[j] * cofactor[j];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      S[3 * i + j] = 0;
      for (int k = 0; k < 3; k++) S[3 * i + j] += cofactor[3 * k + i] * P[3 * k + j] / J;
    }
}

/* Strain and stress of a displacement gradient and the first Piola-Kirchhoff stress. */
static PointPair Pair(PetscBool finite, const PetscReal H[9], const PetscReal P[9])
{
  PetscReal S[9];
  PointPair pair;

  if (finite)
    SecondStress(H, P, S);
  else
    for (int k = 0; k < 9; k++) S[k] = P[k];
  for (int c = 0; c < 6; c++) {
    const int i = component[c][0], j = component[c][1];

    pair.stress[c] = (S[3 * i + j] + S[3 * j + i]) / 2;
    pair.strain[c] = H[3 * i + j] + H[3 * j + i];
    for (int k = 0; k < 3 && finite; k++) pair.strain[c] += H[3 * k + i] * H[3 * k + j];
    if (i == j) pair.strain[c] /= 2;
  }
  return pair;
}

static PetscReal Product(const PointPair *pair)
{
  PetscReal sum = 0;

  for (int c = 0; c < 6; c++) sum += pair->strain[c] * pair->stress[c];
  return sum;
}

/* Adds the two integrals over a cell: sum[0] of what varies, sum[1] of all. */
static PetscErrorCode AddCell(Mesh mesh, Scene scene, Elasticity elasticity, PetscInt cell, const PointStates *states,
                              PetscReal sum[2])
{
  const int points = ElementGet(mesh->cell_type[cell])->points;
  PetscReal x[ELEMENT_MAX_POINTS * 3], volume[ELEMENT_MAX_POINTS], whole = 0, all = 0;
  PointPair mean = {{0}, {0}};

  PetscFunctionBeginUser;
  PetscCall(ElasticityPlacePoints(elasticity, cell, POINTS_OF_ELEMENT, x, volume));
  for (int p = 0; p < points; p++) {
    const PointPair pair =
      Pair((PetscBool)(scene->kinematics == KINEMATICS_FINITE), &states->H[9 * p], &states->P[9 * p]);

    for (int c = 0; c < 6; c++) {
      mean.strain[c] += volume[p] * pair.strain[c];
      mean.stress[c] += volume[p] * pair.stress[c];
    }
    all += volume[p] * Product(&pair);
    whole += volume[p];
  }
  sum[0] += all - Product(&mean) / whole;
  sum[1] += all;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is a cell of first order and fully integrated, with more than one point, in an elastic body? */
static PetscBool Counts(Mesh mesh, Scene scene, PetscInt cell)
{
  const SceneBody  *body = &scene->bodies[mesh->cell_body[cell]];
  const MaterialLaw law  = body->material.law;
  const Element    *type = ElementGet(mesh->cell_type[cell]);

  return (PetscBool)(type->order == 1 && type->points > 1 && body->formulation == FORMULATION_FULL &&
                     !MaterialGetLaw(law)->plastic && law != MATERIAL_UMAT);
}

/* Adds the cells of a batch that count to the sums of their bodies. */
static PetscErrorCode AddBatch(Mesh mesh, Scene scene, Elasticity elasticity, PetscInt batch, const PetscReal *u,
                               PetscReal *sum)
{
  PointStates     states[ELASTICITY_BATCH];
  const PetscInt *cell;
  int             n, counts = 0;

  PetscFunctionBeginUser;
  ElasticityBatch(elasticity, batch, &n, &cell);
  for (int i = 0; i < n; i++) counts += Counts(mesh, scene, cell[i]);
  if (counts) PetscCall(ElasticityPointStates(elasticity, batch, POINTS_OF_ELEMENT, u, states));
  for (int i = 0; i < n && counts; i++)
    if (Counts(mesh, scene, cell[i]))
      PetscCall(AddCell(mesh, scene, elasticity, cell[i], &states[i], &sum[2 * mesh->cell_body[cell[i]]]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  StrainVariation - finds which part of what bodies store is in strains that vary within their elements.

  Collective

  Input Parameters:
+ mesh       - the mesh
. scene      - its bodies
. elasticity - of the bodies
- u          - local displacements u[n_nodes*dim] (length), ghosts included

  Output Parameter:
. share - for each body of the scene, of its elements of first order with full integration; 0 of rigid and plastic
          bodies and of other elements; the same on all ranks

  Note:
  It is 0 for an even strain and 1 for one that only varies within elements.
@*/
PetscErrorCode StrainVariation(Mesh mesh, Scene scene, Elasticity elasticity, const PetscReal *u, PetscReal *share)
{
  PetscReal *sum;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * scene->n_bodies, &sum));
  for (PetscInt k = 0; k < ElasticityBatches(elasticity); k++) PetscCall(AddBatch(mesh, scene, elasticity, k, u, sum));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2 * scene->n_bodies, MPIU_REAL, MPIU_SUM, mesh->comm));
  for (int b = 0; b < scene->n_bodies; b++) share[b] = sum[2 * b + 1] > 0 ? sum[2 * b] / sum[2 * b + 1] : 0;
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}
