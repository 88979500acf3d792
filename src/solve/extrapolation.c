/* Extrapolation of accepted states in the load parameter by polynomials, whose degree follows from the last state. */
#include "extrapolation.h"
#include "mesh/pressurenodes.h"

/* Highest degree of the polynomials in t. A ring that is pinched in 10 steps takes 31 iterations with 3 and 37 with 2.
   On other scenes the iterations are the same. */
#define EXTRAPOLATION_DEGREE 3
/* Number of states that are kept: those of a polynomial, and the last one, by which the polynomial is judged. */
#define EXTRAPOLATION_STATES (EXTRAPOLATION_DEGREE + 2)
/* The states are smooth where the error that is expected at t is below this part of the step that is expected. With
   0.03 a cup in 40 steps takes 103 iterations, with 0.1 86. With 0.3 a pipe in four long steps takes 40 instead of 21.
 */
#define EXTRAPOLATION_SMOOTH 0.1
/* A higher degree is preferred where its error is below this part of a lower degree's error. Round-off, which depends
   on the number of ranks, must not decide. */
#define EXTRAPOLATION_BETTER 0.99

struct _n_Extrapolation {
  Mesh       mesh;
  PetscInt   known;                   /* number of states that are known; the last one comes first */
  PetscReal *u[EXTRAPOLATION_STATES]; /* local displacements (length) */
  PetscReal  t[EXTRAPOLATION_STATES];
};

/*@
  ExtrapolationCreate - creates an extrapolation that knows no state.

  Not collective

  Input Parameter:
. mesh - borrowed

  Output Parameter:
. out - the extrapolation
@*/
PetscErrorCode ExtrapolationCreate(Mesh mesh, Extrapolation *out)
{
  Extrapolation extrapolation;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&extrapolation));
  extrapolation->mesh = mesh;
  for (int i = 0; i < EXTRAPOLATION_STATES; i++)
    PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &extrapolation->u[i]));
  *out = extrapolation;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ExtrapolationDestroy - destroys the extrapolation.

  Not collective

  Input Parameter:
. extrapolation - set to NULL; may be NULL already
@*/
PetscErrorCode ExtrapolationDestroy(Extrapolation *extrapolation)
{
  PetscFunctionBeginUser;
  if (!*extrapolation) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; i < EXTRAPOLATION_STATES; i++) PetscCall(PetscFree((*extrapolation)->u[i]));
  PetscCall(PetscFree(*extrapolation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ExtrapolationAdd - adds an accepted state.

  Not collective

  Input Parameters:
+ extrapolation - the extrapolation
. u             - local displacements u[n_nodes*dim] (length), prescribed ones included; copied
- t             - load parameter

  Note:
  A state at the load parameter of the one before, as after a step too short to move it, replaces that one.
@*/
PetscErrorCode ExtrapolationAdd(Extrapolation extrapolation, const PetscReal *u, PetscReal t)
{
  PetscReal *oldest = extrapolation->u[EXTRAPOLATION_STATES - 1];

  PetscFunctionBeginUser;
  if (extrapolation->known && t <= extrapolation->t[0]) {
    extrapolation->t[0] = t;
    PetscCall(PetscArraycpy(extrapolation->u[0], u, extrapolation->mesh->n_nodes * extrapolation->mesh->dim));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (int i = EXTRAPOLATION_STATES - 1; i > 0; i--) {
    extrapolation->u[i] = extrapolation->u[i - 1];
    extrapolation->t[i] = extrapolation->t[i - 1];
  }
  extrapolation->u[0] = oldest;
  extrapolation->t[0] = t;
  PetscCall(PetscArraycpy(extrapolation->u[0], u, extrapolation->mesh->n_nodes * extrapolation->mesh->dim));
  extrapolation->known = PetscMin(extrapolation->known + 1, EXTRAPOLATION_STATES);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ExtrapolationForget - removes all states but the last one, where the loads change their direction or rate.

  Not collective

  Input Parameter:
. extrapolation - the extrapolation
@*/
PetscErrorCode ExtrapolationForget(Extrapolation extrapolation)
{
  PetscFunctionBeginUser;
  extrapolation->known = PetscMin(extrapolation->known, 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ExtrapolationReplace - replaces all states by one, where the bodies were moved.

  Not collective

  Input Parameters:
+ extrapolation - the extrapolation
. u             - local displacements u[n_nodes*dim] (length), prescribed ones included; copied
- t             - load parameter
@*/
PetscErrorCode ExtrapolationReplace(Extrapolation extrapolation, const PetscReal *u, PetscReal t)
{
  PetscFunctionBeginUser;
  extrapolation->known = 0;
  PetscCall(ExtrapolationAdd(extrapolation, u, t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Evaluates at t Lagrange's polynomial of a degree through the states from `first` on. */
static void Extrapolate(Extrapolation extrapolation, int first, int degree, PetscReal t, PetscReal *u)
{
  const PetscInt n = extrapolation->mesh->n_nodes * extrapolation->mesh->dim;

  for (PetscInt k = 0; k < n; k++) u[k] = 0;
  for (int i = first; i <= first + degree; i++) {
    PetscReal weight = 1;

    for (int j = first; j <= first + degree; j++)
      if (j != i) weight *= (t - extrapolation->t[j]) / (extrapolation->t[i] - extrapolation->t[j]);
    for (PetscInt k = 0; k < n; k++) u[k] += weight * extrapolation->u[i][k];
  }
}

/* Largest difference of a component of two displacements, of all ranks. Pressures at nodes do not count: they have
   another unit. */
static PetscErrorCode StateDistance(Extrapolation extrapolation, const PetscReal *u, const PetscReal *v,
                                    PetscReal *distance)
{
  const Mesh mesh = extrapolation->mesh;

  PetscFunctionBeginUser;
  *distance = 0;
  for (PetscInt k = 0; k < mesh->n_nodes * mesh->dim; k++)
    if (!IsPressureNode(mesh, k / mesh->dim)) *distance = PetscMax(*distance, PetscAbsReal(u[k] - v[k]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, distance, 1, MPIU_REAL, MPI_MAX, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Factor by which the error of a degree, which is known at the last state, grows until t: by Lagrange's remainder. */
static PetscReal Growth(Extrapolation extrapolation, int degree, PetscReal t)
{
  PetscReal growth = 1;

  for (int i = 0; i <= degree; i++)
    growth *= (t - extrapolation->t[i]) / (extrapolation->t[0] - extrapolation->t[i + 1]);
  return growth;
}

/*@
  ExtrapolationEvaluate - computes the displacements that are expected at a load parameter.

  Collective

  Input Parameters:
+ extrapolation - the extrapolation
- t             - load parameter, beyond that of the last state

  Output Parameters:
+ u      - local displacements u[n_nodes*dim] (length); prescribed ones are guesses as well
- smooth - the expected error is small; never with less than three states, where u is not set

  Note:
  Each degree is judged by how well the states before the last one predict the last one. The degree with the least
  expected error at t is taken.
@*/
PetscErrorCode ExtrapolationEvaluate(Extrapolation extrapolation, PetscReal t, PetscReal *u, PetscBool *smooth)
{
  PetscReal step, error, least = PETSC_MAX_REAL;
  int       best = 0;

  PetscFunctionBeginUser;
  *smooth = PETSC_FALSE;
  if (extrapolation->known < 3) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StateDistance(extrapolation, extrapolation->u[0], extrapolation->u[1], &step));
  step *= (t - extrapolation->t[0]) / (extrapolation->t[0] - extrapolation->t[1]);
  for (int degree = 1; degree + 2 <= extrapolation->known; degree++) {
    Extrapolate(extrapolation, 1, degree, extrapolation->t[0], u);
    PetscCall(StateDistance(extrapolation, extrapolation->u[0], u, &error));
    error *= Growth(extrapolation, degree, t);
    if (error > EXTRAPOLATION_BETTER * least) continue;
    least = error;
    best  = degree;
  }
  Extrapolate(extrapolation, 0, best, t, u);
  *smooth = (PetscBool)(least <= EXTRAPOLATION_SMOOTH * step);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ExtrapolationArchive - saves or loads the states other than the last one.

  Collective

  Input Parameters:
+ extrapolation - the extrapolation
. archive       - decides whether they are saved or loaded
. nodes         - rows of the local nodes in the archive
- u             - local displacements u[n_nodes*dim] (length) of the last state
@*/
PetscErrorCode ExtrapolationArchive(Extrapolation extrapolation, Archive archive, const Hdf5Table *nodes,
                                    const PetscReal *u)
{
  char name[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(ArchiveIntegers(archive, "path/known", 1, &extrapolation->known));
  PetscCheck(extrapolation->known >= 0 && extrapolation->known <= EXTRAPOLATION_STATES, extrapolation->mesh->comm,
             PETSC_ERR_FILE_UNEXPECTED, "%" PetscInt_FMT " states of a path", extrapolation->known);
  PetscCall(ArchiveReals(archive, "path/t", EXTRAPOLATION_STATES, extrapolation->t));
  PetscCall(PetscArraycpy(extrapolation->u[0], u, extrapolation->mesh->n_nodes * extrapolation->mesh->dim));
  for (PetscInt i = 1; i < extrapolation->known; i++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "path/displacement_%" PetscInt_FMT, i));
    PetscCall(ArchiveRows(archive, name, nodes, extrapolation->mesh->dim, extrapolation->u[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
