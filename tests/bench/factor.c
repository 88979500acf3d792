/* What an unsymmetric factor (LU) costs beside a symmetric one (L D L^T) of the same matrix: CPU seconds of the second
   factorisation, whose ordering is known, operations and entries. Grids of nodes with three unknowns, each coupled to
   the 26 around it: a thin wall and a cube. A line is row, column and value; a line with # begins a table. */
#include "bench.h"
#include "linear/factor.h"

enum { DOFS = 3, GRIDS = 2, REPEATS = 5 };

typedef struct {
  const char *name;
  PetscInt    edge[3];
} Grid;

static const Grid Grids[GRIDS] = {{"wall", {80, 40, 3}}, {"cube", {16, 16, 16}}};

/* Adds the stiffness of a spring between nodes i and j along and across the line between them. */
static PetscErrorCode AddSpring(Mat A, PetscInt i, PetscInt j, const PetscInt along[3])
{
  const PetscInt  node[2] = {i, j};
  const PetscReal length2 = along[0] * along[0] + along[1] * along[1] + along[2] * along[2];

  PetscFunctionBeginUser;
  for (int a = 0; a < 2; a++) {
    for (int b = 0; b < 2; b++) {
      for (int d = 0; d < DOFS; d++) {
        for (int e = 0; e < DOFS; e++) {
          const PetscReal k = along[d] * along[e] / length2 + (d == e ? 0.1 : 0);

          PetscCall(MatSetValue(A, node[a] * DOFS + d, node[b] * DOFS + e, a == b ? k : -k, ADD_VALUES));
        }
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the springs from a node to those around it that come later, and one that holds it. */
static PetscErrorCode AddNode(Mat A, const Grid *grid, PetscInt x, PetscInt y, PetscInt z)
{
  const PetscInt *edge = grid->edge, node = (z * edge[1] + y) * edge[0] + x;

  PetscFunctionBeginUser;
  for (int d = 0; d < DOFS; d++) PetscCall(MatSetValue(A, node * DOFS + d, node * DOFS + d, 1e-3, ADD_VALUES));
  for (int k = 14; k < 27; k++) {
    const PetscInt along[3] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
    const PetscInt to[3]    = {x + along[0], y + along[1], z + along[2]};

    if (to[0] < 0 || to[1] < 0 || to[0] >= edge[0] || to[1] >= edge[1] || to[2] >= edge[2]) continue;
    PetscCall(AddSpring(A, node, (to[2] * edge[1] + to[1]) * edge[0] + to[0], along));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeGrid(const Grid *grid, Mat *A)
{
  const PetscInt *edge = grid->edge, n = edge[0] * edge[1] * edge[2] * DOFS;

  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, n, n, 27 * DOFS, NULL, A));
  for (PetscInt z = 0; z < edge[2]; z++)
    for (PetscInt y = 0; y < edge[1]; y++)
      for (PetscInt x = 0; x < edge[0]; x++) PetscCall(AddNode(*A, grid, x, y, z));
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* CPU seconds of a factorisation with a known ordering: the least of some. */
static PetscErrorCode Measure(Mat A, PetscBool symmetric, double *seconds, FactorCost *cost)
{
  Factor         factor;
  PCFailedReason reason;

  PetscFunctionBeginUser;
  PetscCall(FactorCreate(PETSC_COMM_SELF, symmetric, &factor));
  PetscCall(FactorMake(factor, A, &reason));
  *seconds = PETSC_MAX_REAL;
  for (int repeat = 0; repeat < REPEATS; repeat++) {
    const double begin = Seconds();

    PetscCall(FactorMake(factor, A, &reason));
    PetscCheck(!reason, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a factorisation failed");
    *seconds = PetscMin(*seconds, Seconds() - begin);
  }
  FactorGetCost(factor, cost);
  PetscCall(FactorDestroy(&factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Bench(const Grid *grid)
{
  double     seconds[2];
  FactorCost cost[2];
  PetscInt   n;
  Mat        A;

  PetscFunctionBeginUser;
  PetscCall(MakeGrid(grid, &A));
  PetscCall(MatGetSize(A, &n, NULL));
  for (int symmetric = 0; symmetric < 2; symmetric++)
    PetscCall(Measure(A, symmetric ? PETSC_TRUE : PETSC_FALSE, &seconds[symmetric], &cost[symmetric]));
  printf("%s unknowns %d\n%s LDLT_s %.4f\n%s LU_s %.4f\n%s LU/LDLT %.3f\n", grid->name, (int)n, grid->name, seconds[1],
         grid->name, seconds[0], grid->name, seconds[0] / seconds[1]);
  printf("%s operations %.3f\n%s entries %.3f\n", grid->name, cost[0].operations / cost[1].operations, grid->name,
         cost[0].entries / cost[1].entries);
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  printf("# LU beside LDL^T: seconds of one factor; ratios of time, operations and entries\n");
  for (int g = 0; g < GRIDS; g++) PetscCall(Bench(&Grids[g]));
  PetscCall(PetscFinalize());
  return 0;
}
