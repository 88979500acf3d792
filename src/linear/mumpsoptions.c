/* MUMPS's parameters from PETSc's options, checked against the ranges of MUMPS's guide. */
#include "mumpsoptions.h"
#include <limits.h>

/* Values that are allowed for a parameter. A parameter may have more than one range; one without any takes every value.
 */
typedef struct {
  int number, least, most;
} IntegerRange;
typedef struct {
  int       number;
  PetscReal least, most;
} RealRange;

/* A range for a parameter that this program sets itself: no value lies in it. */
#define OURS 1, 0

/* Sources: MUMPS 5.5 Users' guide, section 6, and PETSc's MATSOLVERMUMPS. */
static const IntegerRange IntegerRanges[] = {
  {4, 0, 4},                                /* level of printing */
  {5, 0, 0},                                /* the matrix is assembled, not given by elements */
  {6, 0, 7},                                /* permutation to a zero-free diagonal */
  {7, 0, 7},                                /* ordering */
  {8, -2, -2},                              /* scaling; -1 would read scalings that are not given */
  {8, 0, 8},        {8, 77, 77}, {9, 1, 1}, /* A x = b, not its transpose */
  {10, 0, 0}, /* no iterative refinement: MUMPS has none for solutions that stay distributed; linearcheck.h refines */
  {11, 0, 0}, /* no error analysis, for the same reason */
  {12, 0, 3}, /* ordering of symmetric matrices */
  {14, 0, INT_MAX}, /* workspace above the estimate (per cent) */
  {15, INT_MIN, 0}, /* analysis by blocks; a positive value would read blocks that are not given */
  {16, 0, INT_MAX}, /* OpenMP threads */
  {18, OURS},       /* distribution of the matrix */
  {19, 0, 0},       /* no Schur complement */
  {20, OURS},       /* distribution of right-hand sides */
  {21, OURS},       /* distribution of solutions */
  {22, 0, 1},       /* out of core */
  {23, 0, INT_MAX}, /* memory of each rank (MB) */
  {24, 0, 1},       /* null pivots are detected */
  {25, 0, 0},       /* solutions, not the null space */
  {26, 0, 0},       /* no Schur complement */
  {28, 0, 2},       /* sequential or parallel analysis */
  {29, 0, 2},       /* ordering of parallel analysis */
  {30, 0, 0},       /* no entries of the inverse */
  {31, 0, 0},       /* factors are kept */
  {32, 0, 0},       /* no elimination in the factorisation */
  {33, 0, 1},       /* determinant */
  {34, 0, 1},       /* files of an out-of-core factor are kept */
  {35, 0, 3},       /* block low-rank factors */
  {36, 0, 1},       /* their variant */
  {37, 0, 1},       /* compressed contribution blocks */
  {38, 0, 1000},    /* estimated compression of factors (parts of a thousand) */
  {39, 0, 1000},    /* estimated compression of contribution blocks (parts of a thousand) */
  {58, 0, 2},       /* symbolic factorisation */
};
static const RealRange RealRanges[] = {
  {1, PETSC_MIN_REAL, 1}, /* threshold of pivots; below 0: MUMPS's choice */
  {7, 0, PETSC_MAX_REAL}, /* precision of block low-rank factors */
};

/* Appends one range to the text of all that are allowed. */
static PetscErrorCode NameRange(const IntegerRange *range, size_t size, char *text)
{
  size_t length;

  PetscFunctionBeginUser;
  PetscCall(PetscStrlen(text, &length));
  text += length;
  size -= length;
  if (range->least == range->most)
    PetscCall(PetscSNPrintf(text, size, "%s%d", length ? ", " : "", range->least));
  else if (range->least == INT_MIN)
    PetscCall(PetscSNPrintf(text, size, "%sat most %d", length ? ", " : "", range->most));
  else if (range->most == INT_MAX)
    PetscCall(PetscSNPrintf(text, size, "%sat least %d", length ? ", " : "", range->least));
  else
    PetscCall(PetscSNPrintf(text, size, "%s%d to %d", length ? ", " : "", range->least, range->most));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An error where an integer parameter may not have a value. */
static PetscErrorCode CheckInteger(const char *name, int number, PetscInt value)
{
  char      allowed[64] = "";
  PetscBool limited = PETSC_FALSE, ours = PETSC_FALSE, inside = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(IntegerRanges); i++) {
    const IntegerRange *range = &IntegerRanges[i];

    if (range->number != number) continue;
    limited = PETSC_TRUE;
    if (range->least > range->most) ours = PETSC_TRUE;
    if (value >= range->least && value <= range->most) inside = PETSC_TRUE;
    PetscCall(NameRange(range, sizeof(allowed), allowed));
  }
  PetscCheck(!ours, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%s: the program sets this parameter itself", name);
  PetscCheck(!limited || inside, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%s %" PetscInt_FMT "; allowed: %s", name,
             value, allowed);
  PetscCheck(value >= INT_MIN && value <= INT_MAX, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "%s %" PetscInt_FMT " does not fit into 32 bits", name, value);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An error where a real parameter may not have a value. */
static PetscErrorCode CheckReal(const char *name, int number, PetscReal value)
{
  PetscFunctionBeginUser;
  PetscCheck(!PetscIsInfOrNanReal(value), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%s: a finite number is wanted",
             name);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(RealRanges); i++) {
    const RealRange *range = &RealRanges[i];

    if (range->number != number) continue;
    PetscCheck(value >= range->least, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%s %g; allowed: at least %d", name,
               (double)value, (int)range->least);
    PetscCheck(value <= range->most, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%s %g; allowed: at most %d", name,
               (double)value, (int)range->most);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MumpsOptionsRead - replaces those of MUMPS's parameters that the user has set.

  Not collective

  Input and Output Parameters:
+ icntl - integer parameters, MUMPS_ICNTL of them
- cntl  - real parameters, MUMPS_CNTL of them

  Options Database Keys:
+ -mat_mumps_icntl_<number> <integer> - an integer parameter
- -mat_mumps_cntl_<number> <real>     - a real parameter

  Note:
  A value that is no number, is out of its range, or belongs to a parameter that the program sets itself is an error of
  PETSc's (PETSC_ERR_ARG_OUTOFRANGE), whose message names the option and what is allowed.
@*/
PetscErrorCode MumpsOptionsRead(MUMPS_INT icntl[MUMPS_ICNTL], DMUMPS_REAL cntl[MUMPS_CNTL])
{
  char      name[64];
  PetscInt  integer;
  PetscReal real;
  PetscBool given;

  PetscFunctionBeginUser;
  for (int i = 1; i <= MUMPS_ICNTL; i++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "-mat_mumps_icntl_%d", i));
    PetscCall(PetscOptionsGetInt(NULL, NULL, name, &integer, &given));
    if (!given) continue;
    PetscCall(CheckInteger(name, i, integer));
    icntl[i - 1] = (MUMPS_INT)integer;
  }
  for (int i = 1; i <= MUMPS_CNTL; i++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "-mat_mumps_cntl_%d", i));
    PetscCall(PetscOptionsGetReal(NULL, NULL, name, &real, &given));
    if (!given) continue;
    PetscCall(CheckReal(name, i, real));
    cntl[i - 1] = real;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
