#include "extrapolation.h"

/* Highest degree of the polynomials in t. A ring that is pinched in 10 steps takes 31 iterations with 3, 37 with 2; on other scenes they are the same. */
#define PATH_DEGREE 3
/* States that are remembered: those of a polynomial, and the last one, by which it is judged */
#define PATH_STATES (PATH_DEGREE + 2)
/* A path is smooth where the last state was foretold to this part of the last step. With 0.03 a cup in 40 steps takes 103 iterations, with 0.1 86; with 0.3 a
   pipe in four long steps takes 40 instead of 21. */
#define PATH_SMOOTH 0.1
/* A higher degree is preferred where its error is less than this part of a lower one's: round-off does not decide, which may be another on more ranks. */
#define PATH_BETTER 0.99

struct _n_Path {
  Mesh       mesh;
  PetscInt   known;          /* states, the last one first */
  PetscReal *u[PATH_STATES]; /* local displacements (length) */
  PetscReal  t[PATH_STATES];
};

/* PathCreate - Not collective. */
PetscErrorCode PathCreate(Mesh mesh, Path *out)
{
  Path path;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&path));
  path->mesh = mesh;
  for (int i = 0; i < PATH_STATES; i++) PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &path->u[i]));
  *out = path;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PathDestroy - Not collective. */
PetscErrorCode PathDestroy(Path *path)
{
  PetscFunctionBeginUser;
  if (!*path) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; i < PATH_STATES; i++) PetscCall(PetscFree((*path)->u[i]));
  PetscCall(PetscFree(*path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PathAdd - Not collective. u[n_nodes*dim]: local displacements, prescribed ones included (length). */
PetscErrorCode PathAdd(Path path, const PetscReal *u, PetscReal t)
{
  PetscReal *oldest = path->u[PATH_STATES - 1];

  PetscFunctionBeginUser;
  PetscCheck(!path->known || t > path->t[0], path->mesh->comm, PETSC_ERR_ARG_OUTOFRANGE, "a state at t = %g follows one at %g", (double)t, (double)path->t[0]);
  for (int i = PATH_STATES - 1; i > 0; i--) {
    path->u[i] = path->u[i - 1];
    path->t[i] = path->t[i - 1];
  }
  path->u[0] = oldest;
  path->t[0] = t;
  PetscCall(PetscArraycpy(path->u[0], u, path->mesh->n_nodes * path->mesh->dim));
  path->known = PetscMin(path->known + 1, PATH_STATES);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PathForget - Not collective. */
PetscErrorCode PathForget(Path path)
{
  PetscFunctionBeginUser;
  path->known = PetscMin(path->known, 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lagrange's polynomial of a degree through the states from `first` on, at t */
static void Extrapolate(Path path, int first, int degree, PetscReal t, PetscReal *u)
{
  const PetscInt n = path->mesh->n_nodes * path->mesh->dim;

  for (PetscInt k = 0; k < n; k++) u[k] = 0;
  for (int i = first; i <= first + degree; i++) {
    PetscReal weight = 1;

    for (int j = first; j <= first + degree; j++)
      if (j != i) weight *= (t - path->t[j]) / (path->t[i] - path->t[j]);
    for (PetscInt k = 0; k < n; k++) u[k] += weight * path->u[i][k];
  }
}

/* Largest difference of two displacements, all ranks */
static PetscErrorCode Distance(Path path, const PetscReal *u, const PetscReal *v, PetscReal *distance)
{
  PetscFunctionBeginUser;
  *distance = 0;
  for (PetscInt k = 0; k < path->mesh->n_nodes * path->mesh->dim; k++) *distance = PetscMax(*distance, PetscAbsReal(u[k] - v[k]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, distance, 1, MPIU_REAL, MPI_MAX, path->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The error of a degree, one that the last state shows, as it grows on the way to t: by Lagrange's remainder. */
static PetscReal Growth(Path path, int degree, PetscReal t)
{
  PetscReal growth = 1;

  for (int i = 0; i <= degree; i++) growth *= (t - path->t[i]) / (path->t[0] - path->t[i + 1]);
  return growth;
}

/* PathForesee - Collective. u[n_nodes*dim]: local displacements (length), those that are prescribed are guesses as well.

   By the polynomial through the last states whose degree would have foretold the last one so well that it is to be trusted the most at t. */
PetscErrorCode PathForesee(Path path, PetscReal t, PetscReal *u, PetscBool *smooth)
{
  PetscReal step, error, least = PETSC_MAX_REAL;
  int       best = 0;

  PetscFunctionBeginUser;
  *smooth = PETSC_FALSE;
  if (path->known < 3) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Distance(path, path->u[0], path->u[1], &step));
  step *= (t - path->t[0]) / (path->t[0] - path->t[1]);
  for (int degree = 1; degree + 2 <= path->known; degree++) {
    Extrapolate(path, 1, degree, path->t[0], u);
    PetscCall(Distance(path, path->u[0], u, &error));
    error *= Growth(path, degree, t);
    if (error > PATH_BETTER * least) continue;
    least = error;
    best  = degree;
  }
  Extrapolate(path, 0, best, t, u);
  *smooth = (PetscBool)(least <= PATH_SMOOTH * step);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PathArchive - Collective. */
PetscErrorCode PathArchive(Path path, Archive archive, const Rows *nodes, const PetscReal *u)
{
  char name[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(ArchiveIntegers(archive, "path/known", 1, &path->known));
  PetscCheck(path->known >= 0 && path->known <= PATH_STATES, path->mesh->comm, PETSC_ERR_FILE_UNEXPECTED, "%" PetscInt_FMT " states of a path", path->known);
  PetscCall(ArchiveReals(archive, "path/t", PATH_STATES, path->t));
  PetscCall(PetscArraycpy(path->u[0], u, path->mesh->n_nodes * path->mesh->dim));
  for (PetscInt i = 1; i < path->known; i++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "path/displacement_%" PetscInt_FMT, i));
    PetscCall(ArchiveRows(archive, name, nodes, path->mesh->dim, path->u[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
