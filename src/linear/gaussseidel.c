/* Symmetric sweeps of Gauss-Seidel's method, and Chebyshev's iterations with them. */
#include <float.h>
#include "gaussseidel.h"
#include "blockrows.h"
#include "sweeppass.h"

/* Largest pivot, in parts of the block's diagonal, that is taken for zero: what rounding to single precision leaves. */
#define SWEEP_PIVOT FLT_EPSILON

#define GAUSSSEIDEL_NAME "symmetric Gauss-Seidel sweep across all ranks"

/* What must be subtracted before the residual is known: nothing; A times a guess; A times the last step. */
typedef enum { RESIDUAL_KNOWN, RESIDUAL_GUESS, RESIDUAL_STEP } ResidualKind;

typedef enum { FORWARD, BACKWARD, REST_ONLY } Way;

/* With A = L + D + U in the order of the sweep and a residual r, the sweeps solve (L + D) y = r and (D + U) z = D y.
   Then A z = r - L (y - z), so the next residual needs the blocks of L only. */
typedef struct _n_GaussSeidel {
  PetscReal    least, largest; /* eigenvalues that are smoothed */
  SweepOrder   order;
  SweepPass    pass, rest; /* of x; of what residuals need of the step before */
  BlockRows    rows;
  PetscReal   *inverse;                /* of the blocks on the diagonal, in the order of the sweep, column-major */
  PetscReal   *residual, *step, *fall; /* fall: A times the step */
  PetscReal   *x, *other;              /* with ghosts; x: y, then z; other: y - z, or a guess */
  ResidualKind what;
  PetscReal    keep, add; /* step = keep (last step) + add z */
} *GaussSeidel;

/* Inverts a block by the method of Gauss and Jordan. A singular block gets an inverse of zero, so that its unknowns
   stay as they are. Both are column-major. */
static void InvertBlock(int n, const float *block, PetscReal *inverse)
{
  PetscReal a[BLOCKROWS_SIZE][BLOCKROWS_SIZE], scale = 0;

  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++) {
      a[i][j]            = block[j * n + i];
      inverse[j * n + i] = i == j;
    }
    scale = PetscMax(scale, PetscAbsReal(a[i][i]));
  }
  for (int p = 0; p < n; p++) {
    const PetscReal pivot = a[p][p];

    if (PetscAbsReal(pivot) <= SWEEP_PIVOT * scale) {
      for (int k = 0; k < n * n; k++) inverse[k] = 0;
      return;
    }
    for (int j = 0; j < n; j++) {
      a[p][j] /= pivot;
      inverse[j * n + p] /= pivot;
    }
    for (int i = 0; i < n; i++) {
      const PetscReal factor = a[i][p];

      for (int j = 0; j < n && i != p; j++) {
        a[i][j] -= factor * a[p][j];
        inverse[j * n + i] -= factor * inverse[j * n + p];
      }
    }
  }
}

/* Finds the residual of a node: it falls by A (guess), or by A (step) = keep A (last step) + add A z. */
LANES_INLINE void GaussSeidelFindResidual(const int size, const ResidualKind what, GaussSeidel g, PetscInt place)
{
  const BlockPart *before = &g->rows->part[BLOCKROWS_BEFORE], *after = &g->rows->part[BLOCKROWS_AFTER];
  const PetscInt   row = g->order->node[place] * size;
  BlockDoubles     sum;

  if (what == RESIDUAL_KNOWN) return;
  sum = BlockRowsProduct(size, before, before->first[place], before->first[place + 1], 1, g->other);
  if (what == RESIDUAL_GUESS)
    sum += BlockRowsProduct(size, after, after->first[place], after->first[place + 1], 1, g->other);
  for (int r = 0; r < size; r++) {
    g->fall[row + r] =
      what == RESIDUAL_GUESS ? 0 : g->keep * g->fall[row + r] + g->add * (g->residual[row + r] - sum[r]);
    g->residual[row + r] -= what == RESIDUAL_GUESS ? sum[r] : g->fall[row + r];
  }
}

/* Solves for a node with its block on the diagonal. */
LANES_INLINE BlockDoubles GaussSeidelSolve(const int size, GaussSeidel g, PetscInt place, BlockDoubles right)
{
  const PetscReal *inverse = &g->inverse[place * size * size];
  BlockDoubles     x       = {0};

  for (int c = 0; c < size; c++) x += *(const BlockDoublesInArray *)&inverse[c * size] * right[c];
  return x;
}

LANES_INLINE void SweepForward(const int size, GaussSeidel g, PetscInt place)
{
  const BlockPart *before = &g->rows->part[BLOCKROWS_BEFORE];
  const PetscInt   row    = g->order->node[place] * size;
  BlockDoubles     x      = -BlockRowsProduct(size, before, before->first[place], before->first[place + 1], 1, g->x);

  for (int r = 0; r < size; r++) x[r] += g->residual[row + r];
  x = GaussSeidelSolve(size, g, place, x);
  for (int r = 0; r < size; r++) g->x[row + r] = x[r];
}

LANES_INLINE void SweepBackward(const int size, GaussSeidel g, PetscInt place)
{
  const BlockPart   *after = &g->rows->part[BLOCKROWS_AFTER];
  const PetscInt     row   = g->order->node[place] * size;
  const BlockDoubles other = GaussSeidelSolve(
    size, g, place, BlockRowsProduct(size, after, after->first[place + 1] - 1, after->first[place], -1, g->x));

  for (int r = 0; r < size; r++) {
    g->other[row + r] = other[r];
    g->x[row + r] -= other[r];
  }
}

/* Sweeps the places from..to-1, backward from the last to the first. */
LANES_INLINE void SweepPlaces(const int size, const ResidualKind what, GaussSeidel g, PetscInt from, PetscInt to,
                              Way way)
{
  for (PetscInt place = from; place < to && way == REST_ONLY; place++) GaussSeidelFindResidual(size, what, g, place);
  for (PetscInt place = to; place-- > from && way == BACKWARD;) SweepBackward(size, g, place);
  for (PetscInt place = from; place < to && way == FORWARD; place++) {
    GaussSeidelFindResidual(size, what, g, place);
    SweepForward(size, g, place);
  }
}

LANES_INLINE void SweepSize(const int size, GaussSeidel g, PetscInt from, PetscInt to, Way way)
{
  switch (way == BACKWARD ? RESIDUAL_KNOWN : g->what) {
  case RESIDUAL_KNOWN: SweepPlaces(size, RESIDUAL_KNOWN, g, from, to, way); break;
  case RESIDUAL_GUESS: SweepPlaces(size, RESIDUAL_GUESS, g, from, to, way); break;
  case RESIDUAL_STEP: SweepPlaces(size, RESIDUAL_STEP, g, from, to, way); break;
  }
}

static void Sweep(GaussSeidel g, PetscInt from, PetscInt n, Way way)
{
  switch (g->order->size) {
  case 1: SweepSize(1, g, from, from + n, way); break;
  case 2: SweepSize(2, g, from, from + n, way); break;
  default: SweepSize(3, g, from, from + n, way); break;
  }
}

/* Sweeps the parts of all nodes from one to another, which comes later in this way. */
static void SweepParts(GaussSeidel g, Way way, int from, int to)
{
  const PetscInt *first = g->order->first;

  if (way == FORWARD)
    Sweep(g, first[from], first[to + 1] - first[from], way);
  else
    Sweep(g, first[to], first[from + 1] - first[to], way);
}

/* Sweeps once through all nodes. */
static PetscErrorCode SweepAll(GaussSeidel g, Way way)
{
  const PetscBool forward = (PetscBool)(way == FORWARD);
  const SweepWay  passes  = forward ? SWEEP_FORWARD : SWEEP_BACKWARD;

  PetscFunctionBeginUser;
  PetscCall(SweepPassBegin(g->pass, passes));
  SweepParts(g, way, forward ? SWEEP_FIRST : SWEEP_LAST, forward ? SWEEP_FIRST : SWEEP_LAST);
  PetscCall(SweepPassSend(g->pass, passes, PASS_EARLY, g->x));
  SweepParts(g, way, forward ? SWEEP_BEFORE : SWEEP_AFTER, forward ? SWEEP_BEFORE : SWEEP_AFTER);
  PetscCall(SweepPassAwait(g->rest, g->other));
  PetscCall(SweepPassAwait(g->pass, g->x));
  SweepParts(g, way, SWEEP_TURN, SWEEP_TURN);
  PetscCall(SweepPassSend(g->pass, passes, PASS_TURN, g->x));
  SweepParts(g, way, forward ? SWEEP_AFTER : SWEEP_BEFORE, forward ? SWEEP_LAST : SWEEP_FIRST);
  PetscCall(SweepPassEnd(g->rest));
  PetscCall(SweepPassEnd(g->pass));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds z for the residual, which becomes known on the way. The residual of a guess needs all ghosts, that of a step
   only those that are swept before this rank. */
static PetscErrorCode SweepBothWays(GaussSeidel g)
{
  PetscFunctionBeginUser;
  if (g->what == RESIDUAL_GUESS) {
    PetscCall(SweepOrderShareBegin(g->order, g->other));
    PetscCall(SweepOrderShareEnd(g->order, g->other));
  }
  if (g->what == RESIDUAL_STEP) {
    PetscCall(SweepPassBegin(g->rest, SWEEP_FORWARD));
    PetscCall(SweepPassSend(g->rest, SWEEP_FORWARD, PASS_EARLY, g->other));
  }
  PetscCall(SweepAll(g, FORWARD));
  g->what = RESIDUAL_KNOWN;
  PetscCall(SweepAll(g, BACKWARD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CopyFrom(GaussSeidel g, Vec from, PetscReal *to)
{
  const PetscScalar *value;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(from, &value));
  PetscCall(PetscArraycpy(to, value, g->order->n * g->order->size));
  PetscCall(VecRestoreArrayRead(from, &value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CopyTo(GaussSeidel g, const PetscReal *from, Vec to)
{
  PetscScalar *value;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayWrite(to, &value));
  PetscCall(PetscArraycpy(value, from, g->order->n * g->order->size));
  PetscCall(VecRestoreArrayWrite(to, &value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Reset(GaussSeidel g)
{
  PetscFunctionBeginUser;
  PetscCall(SweepPassDestroy(&g->pass));
  PetscCall(SweepPassDestroy(&g->rest));
  PetscCall(SweepOrderDestroy(&g->order));
  PetscCall(BlockRowsDestroy(&g->rows));
  PetscCall(PetscFree(g->inverse));
  PetscCall(PetscFree5(g->residual, g->step, g->fall, g->x, g->other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GaussSeidelSetUp(PC pc)
{
  GaussSeidel      g;
  Mat              mat;
  const BlockPart *after;
  PetscInt         n, own, all;
  int              size;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &g));
  PetscCall(PCGetOperators(pc, NULL, &mat));
  PetscCall(Reset(g));
  PetscCall(SweepOrderCreate(mat, &g->order));
  PetscCall(SweepPassCreate(g->order, PETSC_TRUE, &g->pass));
  PetscCall(SweepPassCreate(g->order, PETSC_FALSE, &g->rest));
  PetscCall(BlockRowsCreate(mat, g->order, &g->rows));
  size  = g->order->size;
  n     = g->order->n;
  own   = n * size;
  all   = own + g->order->n_ghosts * size;
  after = &g->rows->part[BLOCKROWS_AFTER];
  PetscCall(PetscMalloc1(own * size + BLOCKROWS_LANES, &g->inverse));
  PetscCall(PetscArrayzero(&g->inverse[own * size], BLOCKROWS_LANES));
  for (PetscInt place = 0; place < n; place++)
    InvertBlock(size, &after->value[after->first[place] * size * size], &g->inverse[place * size * size]);
  PetscCall(PetscMalloc5(own, &g->residual, own, &g->step, own, &g->fall, all, &g->x, all, &g->other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sweeps forward and backward from 0. */
static PetscErrorCode GaussSeidelApply(PC pc, Vec right, Vec left)
{
  GaussSeidel g;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &g));
  PetscCall(CopyFrom(g, right, g->residual));
  g->what = RESIDUAL_KNOWN;
  PetscCall(SweepBothWays(g));
  PetscCall(CopyTo(g, g->x, left));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the next step to `left`. zero: `left` is 0 so far; first: there was no step before */
static PetscErrorCode AddStep(GaussSeidel g, PetscBool first, PetscBool zero, Vec left)
{
  PetscScalar *x;

  PetscFunctionBeginUser;
  PetscCall(VecGetArray(left, &x));
  for (PetscInt i = 0; i < g->order->n * g->order->size; i++) {
    g->step[i] = first ? g->add * g->x[i] : g->keep * g->step[i] + g->add * g->x[i];
    x[i]       = zero ? g->step[i] : x[i] + g->step[i];
  }
  PetscCall(VecRestoreArray(left, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chebyshev's iterations for the eigenvalues from least to largest. */
static PetscErrorCode Smooth(PC pc, Vec right, Vec left, Vec work, PetscReal rtol, PetscReal atol, PetscReal dtol,
                             PetscInt iterations, PetscBool zero, PetscInt *done, PCRichardsonConvergedReason *reason)
{
  GaussSeidel g;
  PetscReal   spread, omega = 2;

  PetscFunctionBeginUser;
  (void)work;
  (void)rtol;
  (void)atol;
  (void)dtol;
  PetscCall(PCShellGetContext(pc, &g));
  spread = (g->largest - g->least) / (g->largest + g->least);
  PetscCall(CopyFrom(g, right, g->residual));
  if (!zero) PetscCall(CopyFrom(g, left, g->other));
  if (zero) PetscCall(PetscArrayzero(g->fall, g->order->n * g->order->size));
  g->what = zero ? RESIDUAL_KNOWN : RESIDUAL_GUESS;
  for (PetscInt i = 0; i < iterations; i++) {
    PetscCall(SweepBothWays(g));
    if (i) omega = 1 / (1 - spread * spread * omega / 4);
    g->keep = i ? omega - 1 : 0;
    g->add  = (i ? omega : 1) * 2 / (g->largest + g->least);
    g->what = RESIDUAL_STEP;
    PetscCall(AddStep(g, i == 0, (PetscBool)(zero && i == 0), left));
  }
  *done   = iterations;
  *reason = PCRICHARDSON_CONVERGED_ITS;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GaussSeidelDestroy(PC pc)
{
  GaussSeidel g;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &g));
  PetscCall(Reset(g));
  PetscCall(PetscFree(g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GaussSeidelSet - makes a preconditioner one symmetric sweep of Gauss-Seidel's method over the nodes.

  Logically collective

  Input Parameters:
+ pc      - of AIJ matrices whose pattern and values are symmetric, on any number of ranks; the block size is that of
            nodes, up to three
. least   - smallest eigenvalue that is smoothed
- largest - largest eigenvalue that is smoothed; none is above 1, except by rounding

  Notes:
  As the preconditioner of KSPRICHARDSON it does Chebyshev's iterations.

  Source: Saad, Iterative Methods for Sparse Linear Systems, 4.1, 12.3 and 12.4; residuals from what sweeps leave:
  Eisenstat, SIAM J. Sci. Stat. Comput. 2, 1981.
@*/
PetscErrorCode GaussSeidelSet(PC pc, PetscReal least, PetscReal largest)
{
  GaussSeidel g;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&g));
  g->least   = least;
  g->largest = largest;
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, g));
  PetscCall(PCShellSetName(pc, GAUSSSEIDEL_NAME));
  PetscCall(PCShellSetSetUp(pc, GaussSeidelSetUp));
  PetscCall(PCShellSetApply(pc, GaussSeidelApply));
  PetscCall(PCShellSetApplyRichardson(pc, Smooth));
  PetscCall(PCShellSetDestroy(pc, GaussSeidelDestroy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GaussSeidelForget - frees the copy of the matrix, which the next set-up makes anew.

  Not collective

  Input Parameter:
. pc - after GaussSeidelSet(), of which GaussSeidelGetMat() has given a matrix
@*/
PetscErrorCode GaussSeidelForget(PC pc)
{
  GaussSeidel g;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &g));
  PetscCall(Reset(g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GaussSeidelGetMat - creates a matrix that stands for the preconditioner's, for GaussSeidelResidual().

  Collective

  Input Parameter:
. pc - after GaussSeidelSet()

  Output Parameter:
. mat - the caller destroys it; NULL: options have replaced the preconditioner
@*/
PetscErrorCode GaussSeidelGetMat(PC pc, Mat *mat)
{
  GaussSeidel g;
  Mat         A;
  PetscInt    n, all;
  PetscBool   ours; /* after GaussSeidelSet() a shell is ours: options can only put another type in its place */

  PetscFunctionBeginUser;
  *mat = NULL;
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCSHELL, &ours));
  if (!ours) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PCShellGetContext(pc, &g));
  PetscCall(PCGetOperators(pc, NULL, &A));
  PetscCall(MatGetLocalSize(A, &n, NULL));
  PetscCall(MatGetSize(A, &all, NULL));
  PetscCall(MatCreateShell(PetscObjectComm((PetscObject)pc), n, n, all, all, g, mat));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GaussSeidelResidual - computes residual = right - A x with the copy of A, in the form of PCMGSetResidual().

  Collective

  Input Parameters:
+ mat   - from GaussSeidelGetMat()
. right - right-hand side
- x     - iterate

  Output Parameter:
. residual - right - A x
@*/
PetscErrorCode GaussSeidelResidual(Mat mat, Vec right, Vec x, Vec residual)
{
  GaussSeidel g;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(mat, &g));
  PetscCall(CopyFrom(g, right, g->residual));
  PetscCall(CopyFrom(g, x, g->other));
  g->what = RESIDUAL_GUESS;
  PetscCall(SweepOrderShareBegin(g->order, g->other));
  PetscCall(SweepOrderShareEnd(g->order, g->other));
  Sweep(g, 0, g->order->n, REST_ONLY);
  PetscCall(CopyTo(g, g->residual, residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}
