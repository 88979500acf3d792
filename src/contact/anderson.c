/* Anderson mixing: a fixed-point iteration x <- G(x) that makes use of its last results. */
#include "anderson.h"

/* Differences of results that are kept. For a cylinder pressed on a block, whose contact set changes during the
   iteration, 3 need 33 iterations, 5 need 40, and more than 5 do not always converge. */
#define ANDERSON_DEPTH 3

/* Smallest pivot in the Cholesky factorisation of the least-squares problem, as a part of the squared norm of the
   difference. Smaller pivots are round-off of differences that are nearly linearly dependent. */
#define ANDERSON_RIDGE 1e-10

struct _n_Mixing {
  MPI_Comm         comm;
  const PetscReal *weight;
  PetscInt         n, results;                              /* results: since the start */
  PetscReal       *g, *f;                                   /* the last result and its residual g - x */
  PetscReal       *dg[ANDERSON_DEPTH], *df[ANDERSON_DEPTH]; /* their differences, newest over oldest */
};

/*@
  AndersonCreate - makes a mixing of vectors that are spread over ranks.

  Collective

  Input Parameters:
+ comm   - the ranks
. n      - entries of this rank
- weight - weight[n] of the entries in inner products, above 0; borrowed

  Output Parameter:
. mixing - the mixing
@*/
PetscErrorCode AndersonCreate(MPI_Comm comm, PetscInt n, const PetscReal *weight, Anderson *mixing)
{
  Anderson m;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  m->comm   = comm;
  m->n      = n;
  m->weight = weight;
  PetscCall(PetscMalloc2(n, &m->g, n, &m->f));
  for (int k = 0; k < ANDERSON_DEPTH; k++) PetscCall(PetscMalloc2(n, &m->dg[k], n, &m->df[k]));
  *mixing = m;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  AndersonDestroy - frees a mixing.

  Collective

  Input Parameter:
. mixing - the mixing; set to NULL
@*/
PetscErrorCode AndersonDestroy(Anderson *mixing)
{
  PetscFunctionBeginUser;
  if (!*mixing) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < ANDERSON_DEPTH; k++) PetscCall(PetscFree2((*mixing)->dg[k], (*mixing)->df[k]));
  PetscCall(PetscFree2((*mixing)->g, (*mixing)->f));
  PetscCall(PetscFree(*mixing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  AndersonStart - begins another iteration, so that the next result stands alone.

  Not collective

  Input Parameter:
. m - the mixing
@*/
void AndersonStart(Anderson m)
{
  m->results = 0;
}

/* Solves A gamma = b by Cholesky's method, in place of b. A[n][n] is a Gram matrix: symmetric and, with the ridge,
   never quite singular. */
static void SolveGram(int n, PetscReal A[][ANDERSON_DEPTH], PetscReal b[])
{
  for (int k = 0; k < n; k++) {
    const PetscReal square = A[k][k];

    for (int j = 0; j < k; j++) {
      for (int i = 0; i < j; i++) A[k][j] -= A[k][i] * A[j][i];
      A[k][j] /= A[j][j];
      A[k][k] -= PetscSqr(A[k][j]);
      b[k] -= A[k][j] * b[j];
    }
    A[k][k] = square > 0 ? PetscSqrtReal(PetscMax(A[k][k], ANDERSON_RIDGE * square)) : 1;
    b[k] /= A[k][k];
  }
  for (int k = n - 1; k >= 0; k--) {
    for (int j = k + 1; j < n; j++) b[k] -= A[j][k] * b[j];
    b[k] /= A[k][k];
  }
}

/*@
  AndersonNext - computes what to put in next: of all combinations of the last results the one whose residuals cancel
  best.

  Collective

  Input Parameters:
+ m - the mixing
- x - what was put in, x[n]

  Input/Output Parameter:
. g - what came out, G(x), g[n]; replaced by what is to be put in next

  Note:
  After AndersonStart() it is the result itself. Source: Walker and Ni (2011), SIAM J. Numer. Anal. 49, 1715-1735, eq.
  1.1.
@*/
PetscErrorCode AndersonNext(Anderson m, const PetscReal *x, PetscReal *g)
{
  const int depth                                   = (int)PetscMin(m->results, ANDERSON_DEPTH),
            newest                                  = (int)((m->results + ANDERSON_DEPTH - 1) % ANDERSON_DEPTH);
  PetscReal sum[ANDERSON_DEPTH + 1][ANDERSON_DEPTH] = {{0}}, *gamma = sum[ANDERSON_DEPTH];

  PetscFunctionBeginUser;
  m->results++;
  for (PetscInt i = 0; i < m->n; i++) {
    const PetscReal f = g[i] - x[i];

    if (depth) m->dg[newest][i] = g[i] - m->g[i];
    if (depth) m->df[newest][i] = f - m->f[i];
    m->g[i] = g[i];
    m->f[i] = f;
    for (int k = 0; k < depth; k++) {
      for (int j = 0; j < depth; j++) sum[j][k] += m->weight[i] * m->df[j][i] * m->df[k][i];
      gamma[k] += m->weight[i] * m->df[k][i] * f;
    }
  }
  if (!depth) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, (ANDERSON_DEPTH + 1) * ANDERSON_DEPTH, MPIU_REAL, MPI_SUM, m->comm));
  SolveGram(depth, sum, gamma);
  for (PetscInt i = 0; i < m->n; i++)
    for (int k = 0; k < depth; k++) g[i] -= gamma[k] * m->dg[k][i];
  PetscFunctionReturn(PETSC_SUCCESS);
}
