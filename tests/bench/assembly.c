/* Measures the elastic assembly on one rank, in CPU microseconds per element, and that of PetscFE with the same
   quadrature on a small mesh. A line is row, column and value; a line with # begins a table. The columns kernel-* are
   for one batch in the cache. The columns residual, tangent and insertion are for a mesh of some ten thousand dofs, and
   total is their sum. */
#include "../box.h"
#include <time.h>

/* Number of rounds. The fastest one counts, because the others were disturbed. */
enum { ROUNDS = 3 };

/* Shortest duration of a round in seconds. It is long compared with the resolution of the clock. */
static const double shortest_round = 0.1;

/* The data of all measured functions */
typedef struct {
  Box              *box;
  Elasticity        e;
  PetscReal        *f;
  const KernelCase *kernel;
  PetscReal        *X, *u, *batch_f, *K, *constants;
  DM                dm;
  Vec               petsc_u, F;
  Mat               J;
} Work;

static PetscErrorCode KernelForce(Work *w)
{
  PetscReal J[KERNEL_LANES];

  ElementKernel(w->kernel, w->X, w->u, NULL, w->constants, NULL, NULL, w->batch_f, NULL, J);
  return PETSC_SUCCESS;
}

static PetscErrorCode KernelBoth(Work *w)
{
  PetscReal J[KERNEL_LANES];

  ElementKernel(w->kernel, w->X, w->u, NULL, w->constants, NULL, NULL, w->batch_f, w->K, J);
  return PETSC_SUCCESS;
}

static PetscErrorCode Residual(Work *w)
{
  PetscBool ok;

  return ElasticityResidual(w->e, w->box->u, w->f, NULL, NULL, &ok);
}

static PetscErrorCode Tangent(Work *w)
{
  return ElasticityTangent(w->e, w->box->u, NULL);
}

static PetscErrorCode Insert(Work *w)
{
  Mat K;

  return ElasticityMatrix(w->e, NULL, NULL, &K);
}

static PetscErrorCode PetscResidual(Work *w)
{
  PetscFunctionBeginUser;
  PetscCall(VecZeroEntries(w->F));
  PetscCall(DMPlexSNESComputeResidualFEM(w->dm, w->petsc_u, w->F, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PetscJacobian(Work *w)
{
  PetscFunctionBeginUser;
  PetscCall(MatZeroEntries(w->J));
  PetscCall(DMPlexSNESComputeJacobianFEM(w->dm, w->petsc_u, w->J, w->J, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static double Seconds(void)
{
  struct timespec t;

  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

/* Measures the CPU time of one call, in microseconds per element that the call treats. */
static PetscErrorCode Time(PetscErrorCode (*call)(Work *), Work *w, PetscInt elements, double *microseconds)
{
  PetscFunctionBeginUser;
  *microseconds = PETSC_MAX_REAL;
  PetscCall(call(w)); /* The first call allocates memory and touches it for the first time. */
  for (int round = 0; round < ROUNDS; round++) {
    double spent = 0;

    for (PetscInt calls = 1; spent < shortest_round; calls *= 2) {
      const double start = Seconds();

      for (PetscInt k = 0; k < calls; k++) PetscCall(call(w));
      spent = Seconds() - start;
      if (spent >= shortest_round) *microseconds = PetscMin(*microseconds, 1e6 * spent / calls / elements);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies the first cells of the box to one batch. */
static PetscErrorCode CreateBatch(Work *w)
{
  const Element *e        = ElementGet(w->kernel->type);
  const PetscInt dofs     = e->nodes * 3;
  const Material material = MaterialFromModuli(w->kernel->law, 1, 0);

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(dofs * KERNEL_LANES, &w->X, dofs * KERNEL_LANES, &w->u, dofs * KERNEL_LANES, &w->batch_f,
                         dofs * dofs * KERNEL_LANES, &w->K, 2 * KERNEL_LANES, &w->constants));
  for (PetscInt lane = 0; lane < KERNEL_LANES; lane++) {
    for (PetscInt k = 0; k < 2; k++) w->constants[k * KERNEL_LANES + lane] = material.constants[k];
    for (PetscInt k = 0; k < dofs; k++) {
      const PetscInt dof = w->box->mesh->cell_nodes[lane * e->nodes + k / 3] * 3 + k % 3;

      w->X[k * KERNEL_LANES + lane] = w->box->mesh->coords[dof];
      w->u[k * KERNEL_LANES + lane] = w->box->u[dof];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Print(ElementType type, const char *what, double microseconds)
{
  return PetscPrintf(PETSC_COMM_SELF, "%s %s %.3f\n", ElementGet(type)->name, what, microseconds);
}

static PetscErrorCode TimeOurs(ElementType type, PetscInt n)
{
  const KernelCase kernel = {.type        = type,
                             .geometry    = GEOMETRY_SOLID,
                             .kinematics  = KINEMATICS_FINITE,
                             .law         = MATERIAL_SVK,
                             .formulation = FORMULATION_FULL};
  const struct {
    const char *what;
    PetscErrorCode (*call)(Work *);
    PetscBool whole; /* whether a call treats the whole mesh, or one batch */
  } parts[] = {
    {"kernel-force", KernelForce, PETSC_FALSE}, {"kernel-force-tangent", KernelBoth, PETSC_FALSE},
    {"residual", Residual, PETSC_TRUE},         {"tangent", Tangent, PETSC_TRUE},
    {"insertion", Insert, PETSC_TRUE},
  };
  double total = 0;
  Box    box;
  Work   w = {.box = &box, .kernel = &kernel};

  PetscFunctionBeginUser;
  PetscCall(BoxCreate(type, n, &box));
  PetscCall(CreateBatch(&w));
  PetscCall(ElasticityCreate(box.mesh, box.scene, &w.e));
  PetscCall(PetscCalloc1(box.mesh->n_nodes * 3, &w.f));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(parts); k++) {
    double microseconds = 0;

    PetscCall(Time(parts[k].call, &w, parts[k].whole ? box.mesh->n_cells : (PetscInt)KERNEL_LANES, &microseconds));
    PetscCall(Print(type, parts[k].what, microseconds));
    if (parts[k].whole) total += microseconds;
  }
  PetscCall(Print(type, "total", total));
  PetscCall(PetscFree5(w.X, w.u, w.batch_f, w.K, w.constants));
  PetscCall(PetscFree(w.f));
  PetscCall(ElasticityDestroy(&w.e));
  PetscCall(BoxDestroy(&box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TimePetsc(ElementType type, PetscInt n)
{
  PetscErrorCode (*displacement[1])(PetscInt, PetscReal, const PetscReal[], PetscInt, PetscScalar[],
                                    void *) = {BoxDisplacement};
  double microseconds                       = 0;
  Box    box;
  Work   w = {.box = &box};

  PetscFunctionBeginUser;
  PetscCall(BoxCreate(type, n, &box));
  PetscCall(BoxCreatePetsc(&box, &w.dm));
  PetscCall(DMCreateLocalVector(w.dm, &w.petsc_u));
  PetscCall(DMProjectFunctionLocal(w.dm, 0, displacement, NULL, INSERT_ALL_VALUES, w.petsc_u));
  PetscCall(VecDuplicate(w.petsc_u, &w.F));
  PetscCall(DMCreateMatrix(w.dm, &w.J));
  PetscCall(Time(PetscResidual, &w, box.mesh->n_cells, &microseconds));
  PetscCall(Print(type, "petscfe-residual", microseconds));
  PetscCall(Time(PetscJacobian, &w, box.mesh->n_cells, &microseconds));
  PetscCall(Print(type, "petscfe-tangent", microseconds));
  PetscCall(VecDestroy(&w.petsc_u));
  PetscCall(VecDestroy(&w.F));
  PetscCall(MatDestroy(&w.J));
  PetscCall(DMDestroy(&w.dm));
  PetscCall(BoxDestroy(&box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  const struct {
    ElementType type;
    PetscInt    n, petsc_n; /* number of cubes per side, and that for PetscFE */
  } rows[] = {
    {ELEMENT_TET4, 18, 4},
    {ELEMENT_TET10, 10, 2},
    {ELEMENT_HEX8, 32, 6},
    {ELEMENT_HEX27, 14, 2},
  };

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscPrintf(
    PETSC_COMM_SELF,
    "# assembly, CPU microseconds per element: kernels alone, a whole mesh and its sum, PetscFE beside it\n"));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(rows); k++) {
    PetscCall(TimeOurs(rows[k].type, rows[k].n));
    PetscCall(TimePetsc(rows[k].type, rows[k].petsc_n));
  }
  PetscCall(PetscFinalize());
  return 0;
}
