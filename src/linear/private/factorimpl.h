/* What factor.c (analysis and factorisation) and factorsolve.c (solves) share: the object, and how MUMPS is called.

   Factor holds one instance of MUMPS, the entries of the matrix as MUMPS reads them, and the layout of right-hand sides
   and solutions. factor.c calls factorsolve.c, never the other way round. */
#pragma once
#include "linear/factor.h"
#include "matrix/matrixrows.h"
#include <dmumps_c.h>
#include <inttypes.h>

/* MUMPS's parameters have numbers, from 1. */
#define ICNTL(i)  icntl[(i) - 1]
#define INFO(i)   info[(i) - 1]
#define INFOG(i)  infog[(i) - 1]
#define RINFOG(i) rinfog[(i) - 1]

/* The largest number that MUMPS's integers hold. They have 32 or 64 bits, as MUMPS was compiled. */
#define FACTOR_INT_MAX (sizeof(MUMPS_INT) == sizeof(int64_t) ? INT64_MAX : (int64_t)INT32_MAX)

/* The jobs of MUMPS. */
enum { MUMPS_BEGIN = -1, MUMPS_END = -2, MUMPS_ANALYSE = 1, MUMPS_FACTOR = 2, MUMPS_SOLVE = 3 };

/* The rows that MUMPS solves for on this rank: it returns each unknown on the rank that has eliminated it. */
typedef struct {
  MUMPS_INT   *row;   /* numbers from 1, set by MUMPS's solve */
  PetscScalar *value; /* value[columns][rows] */
  size_t       room_row, room_value;
  PetscSF      to_rows; /* from these unknowns to the matrix's rows; NULL: no solve with this factor yet */
} FactorSolution;

struct _n_Factor {
  MPI_Comm         comm;
  PetscMPIInt      rank, size;
  PetscBool        symmetric, exists; /* exists: there is a factor */
  PetscBool        odd;               /* its matrix has a determinant below 0; not of symmetric ones */
  int              ordering;
  PetscObjectId    matrix;              /* whose places row and column hold; 0: none's */
  PetscObjectState pattern;             /* the state of its pattern */
  PetscBool        analysed;            /* it was analysed with the present ordering and border */
  PetscInt         n, rows, start;      /* rows of all ranks, of this rank, of the ranks before this one */
  PetscInt         entries, own;        /* of this rank: all entries, those of the matrix */
  PetscInt        *from[MATRIX_BLOCKS]; /* first entry that is taken of each row and block */
  PetscInt         room;                /* entries that the next three arrays can hold */
  MUMPS_INT       *row, *column;        /* of this rank's entries, from 1 */
  PetscScalar     *value;               /* of this rank's entries */
  BorderedFactor   bordering;           /* NULL: no border was prepared */
  PetscBool        bordered;            /* the next matrix has a border */
  PetscBool        changed;             /* that border has another pattern than the one that was analysed */
  MUMPS_INT        workspace;           /* ICNTL(14) before any retry (per cent) */
  MUMPS_INT       *position;            /* place of each row in a given ordering, from 1; on the first rank */
  MUMPS_INT       *mine;                /* this rank's rows, from 1 */
  FactorSolution   solution;
  DMUMPS_STRUC_C   mumps;
};

/* Runs one job of MUMPS. Floating-point traps are off meanwhile, as in PETSc's interface: MUMPS and the BLAS and
   ScaLAPACK below it may divide by zero where nothing is wrong. */
static inline PetscErrorCode FactorCall(Factor f, int job)
{
  PetscFunctionBeginUser;
  f->mumps.job = job;
  PetscCall(PetscFPTrapPush(PETSC_FP_TRAP_OFF));
  dmumps_c(&f->mumps);
  PetscCall(PetscFPTrapPop());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A count as MUMPS takes it; an error where it does not fit. */
static inline PetscErrorCode FactorIntCast(int64_t count, MUMPS_INT *out)
{
  PetscFunctionBeginUser;
  PetscCheck(count <= FACTOR_INT_MAX, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "%" PRId64 " is more than MUMPS's integers hold", count);
  *out = (MUMPS_INT)count;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In factorsolve.c: forgets where the unknowns of the last factor were, and frees everything of the solution. */
PetscErrorCode FactorSolutionForget(FactorSolution *);
PetscErrorCode FactorSolutionFree(FactorSolution *);
