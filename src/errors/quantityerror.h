/* The error of quantities of a solution, split by cause.

   QuantityErrorsEstimate() takes first variations of quantities (solve/adjoint.h), solves for their adjoint solutions, and
   weighs with them what each cause leaves: the elements of the bodies (errors/bodyerror.h), penetration and elastic slip
   (the derivative by the penalty, solve/penaltyerror.c), and the residual at which the solver stopped. Every part is the
   true less the computed value, in the units of the quantity. The load steps' part is not known where the answer depends
   on the path: it is NaN there and 0 elsewhere. */
#pragma once
#include "solve/adjoint.h"

typedef enum { ERROR_BODIES, ERROR_PENETRATION, ERROR_SLIP, ERROR_STEPS, ERROR_SOLVER, ERROR_CAUSES } ErrorCause;
extern const char *const ErrorCauses[]; /* in words */

typedef struct {
  PetscBool  known;
  PetscReal  part[ERROR_CAUSES];
  PetscReal  sum;       /* of the known parts */
  PetscReal  magnitude; /* sum of their absolute values, by which a wish is judged */
  PetscReal *cells;     /* indicators of this rank's cells: their parts of ERROR_BODIES [n_cells]; of the caller */
} QuantityError;

PetscErrorCode QuantityErrorsEstimate(Model, int n, const Functional[], QuantityError[]);
