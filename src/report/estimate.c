/* What a solve will cost, see estimate.h. */
#include "estimate.h"
#include "linear/directsolver.h"
#include <sys/resource.h>
#include <time.h>

/* Order of the matrices whose product measures the BLAS. They fit into a level-2 cache, like the blocks of a front. */
enum { ESTIMATE_ORDER = 128 };
/* CPU time for which products are computed (s). */
#define ESTIMATE_PRODUCT_S 0.01
/* The next three constants were chosen on three 3D scenes: a thin pipe, a cup and thick rings. With them the estimate
   of the CPU time of an iteration is right to a quarter, and that of the memory to 30 %. */
/* Speed of MUMPS in large fronts, as a part of the speed of the product. */
#define ESTIMATE_EFFICIENCY 0.6
/* CPU time for each entry of a factor, however large the fronts: assembly of fronts, the two triangular solves (s). */
#define ESTIMATE_ENTRY_S 2.5e-8
/* Least CPU time of a factorisation, in which the matrix is shared out (s). */
#define ESTIMATE_CALL_S 3e-3
/* Time that evaluating residuals and energies adds to an iteration, in assemblies of the tangent. */
#define ESTIMATE_RESIDUALS 1
/* Iterations of a load step, for the time of a step. The scenes in runs/ take so many with the default control. */
#define ESTIMATE_ITERATIONS 5

/* Returns the CPU time of this process, all its threads together. PetscGetCPUTime() counts clock ticks as microseconds
   on some systems. */
static double CpuSeconds(void)
{
  struct timespec now;

  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Measures the operations per second of one core while all ranks work, and takes the slowest rank's. It multiplies
   dense matrices of PETSc, which calls the BLAS. */
static PetscErrorCode MeasureProduct(MPI_Comm comm, PetscReal *rate)
{
  const PetscInt n = ESTIMATE_ORDER;
  Mat            a, c;
  double         start, now;
  PetscReal      done = 0;

  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, n, n, NULL, &a));
  PetscCall(MatShift(a, 1));
  PetscCall(
    MatMatMult(a, a, MAT_INITIAL_MATRIX, 1, &c)); /* the first call initialises the library and is not measured */
  start = CpuSeconds();
  do {
    PetscCall(MatMatMult(a, a, MAT_REUSE_MATRIX, 1, &c));
    done += 2.0 * n * n * n;
    now = CpuSeconds();
  } while (now - start < ESTIMATE_PRODUCT_S);
  *rate = done / (now - start);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, rate, 1, MPIU_REAL, MPIU_MIN, comm));
  PetscCall(MatDestroy(&a));
  PetscCall(MatDestroy(&c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Measures the CPU seconds of one tangent on the slowest rank. A first tangent, which makes patterns, does not count.
 */
static PetscErrorCode MeasureAssembly(Model model, PetscReal *seconds)
{
  double start, end;

  PetscFunctionBeginUser;
  PetscCall(ModelAssemble(model));
  start = CpuSeconds();
  PetscCall(ModelAssemble(model));
  end      = CpuSeconds();
  *seconds = end - start;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, seconds, 1, MPIU_REAL, MPIU_MAX, model->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the figures of MUMPS's analysis of the tangent. */
static PetscErrorCode AnalyseFactor(Model model, Factor factor, Estimate *estimate)
{
  const double   start = CpuSeconds();
  FactorCost     cost;
  PCFailedReason reason;

  PetscFunctionBeginUser;
  PetscCall(FactorAnalyse(factor, model->problem->P, &reason));
  if (reason) PetscFunctionReturn(PETSC_SUCCESS);
  FactorGetCost(factor, &cost);
  estimate->known        = PETSC_TRUE;
  estimate->flops        = cost.operations;
  estimate->entries      = cost.entries;
  estimate->solver_mb[0] = cost.memory_mb[0];
  estimate->solver_mb[1] = cost.memory_mb[1];
  estimate->analysis_s   = CpuSeconds() - start;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &estimate->analysis_s, 1, MPIU_REAL, MPIU_MAX, model->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives what the process holds now, on the largest rank and on all ranks (MB). */
static PetscErrorCode MeasureMemory(MPI_Comm comm, PetscReal mb[2])
{
  struct rusage self;

  PetscFunctionBeginUser;
  PetscCheck(!getrusage(RUSAGE_SELF, &self), PETSC_COMM_SELF, PETSC_ERR_SYS, "getrusage failed");
  mb[0] = mb[1] = (PetscReal)self.ru_maxrss / 1024; /* Linux counts kilobytes */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &mb[0], 1, MPIU_REAL, MPIU_MAX, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &mb[1], 1, MPIU_REAL, MPIU_SUM, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  EstimateModel - estimates what one Newton iteration of the model takes, on these ranks and this machine.

  Collective

  Input Parameter:
. model - after ModelPlace()

  Output Parameter:
. estimate - memory and time

  Note:
  The time is the operations over the speed of a matrix product, plus the entries of the factor times a constant, plus
  the assembly as measured: good to about a factor of two. The tangent of the present state is left in the model's
  matrix.
@*/
PetscErrorCode EstimateModel(Model model, Estimate *estimate)
{
  const MPI_Comm comm = model->mesh->comm;
  PetscReal      rate;
  PetscMPIInt    size;
  Factor         factor;
  MatInfo        info;
  KSP            ksp;

  PetscFunctionBeginUser;
  *estimate = (Estimate){.known = PETSC_FALSE};
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(ModelDofs(model, &estimate->dofs));
  if (!estimate->dofs) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MeasureAssembly(model, &estimate->assembly_s));
  PetscCall(MatGetInfo(model->problem->P, MAT_GLOBAL_SUM, &info));
  estimate->nonzeros = info.nz_used;
  PetscCall(SNESGetKSP(model->snes, &ksp));
  PetscCall(DirectSolverFactor(ksp, &factor));
  if (factor) PetscCall(AnalyseFactor(model, factor, estimate));
  if (!estimate->known) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MeasureProduct(comm, &rate));
  PetscCall(MeasureMemory(comm, estimate->memory_mb));
  for (int k = 0; k < 2; k++) estimate->memory_mb[k] += estimate->solver_mb[k];
  estimate->factor_s =
    ESTIMATE_CALL_S + (estimate->flops / (ESTIMATE_EFFICIENCY * rate) + ESTIMATE_ENTRY_S * estimate->entries) / size;
  estimate->iteration_s = (1 + ESTIMATE_RESIDUALS) * estimate->assembly_s + estimate->factor_s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  EstimatePrint - prints the estimate in three lines.

  Collective

  Input Parameters:
+ model  - after ModelPlace()
- stream - of rank 0, which prints
@*/
PetscErrorCode EstimatePrint(Model model, FILE *stream)
{
  Estimate    estimate;
  PetscMPIInt rank, size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(model->mesh->comm, &rank));
  PetscCallMPI(MPI_Comm_size(model->mesh->comm, &size));
  PetscCall(EstimateModel(model, &estimate));
  if (rank) PetscFunctionReturn(PETSC_SUCCESS);
  if (!estimate.known) {
    fprintf(stream, "cost     not estimated: PETSc's options replace the direct solver, it cannot order the tangent, "
                    "or no dof is free\n");
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  fprintf(stream, "cost     tangent of %.3g nonzeros at the start, its factor %.3g entries in %.3g operations\n",
          (double)estimate.nonzeros, (double)estimate.entries, (double)estimate.flops);
  fprintf(stream,
          "         on %d rank%s about %.0f MB in all, %.0f MB the largest rank; contact that grows adds to it\n", size,
          size > 1 ? "s" : "", (double)estimate.memory_mb[1], (double)estimate.memory_mb[0]);
  fprintf(stream, "         about %.2g s an iteration (tangent %.2g, factor and solve %.2g), %.2g s a step of %d\n",
          (double)estimate.iteration_s, (double)estimate.assembly_s, (double)estimate.factor_s,
          (double)estimate.analysis_s + ESTIMATE_ITERATIONS * (double)estimate.iteration_s, ESTIMATE_ITERATIONS);
  PetscFunctionReturn(PETSC_SUCCESS);
}
