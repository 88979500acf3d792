/* What the elements of the bodies leave of error in quantities of the solution.

   With the true solution u, the computed one u_h, the adjoint one y of a quantity J (solve/adjoint.h) and the form
   a = dR/du of the bodies, the error is

     J(u) - J(u_h) = -a(u - u_h, y - y_h),

   because a(u - u_h, y_h) = 0 by Galerkin's orthogonality. Both errors are estimated by recovered fields
   (errors/recovery.h): P* of the first Piola-Kirchhoff stress P of u_h, G* of the displacement gradient G of y_h:

     J(u) - J(u_h) ~ -sum over points of volume (P* - P) : (G* - G).

   The fields are recovered from the quadrature points. The points of the sum are those of ElementGetProducts(): at the
   one point of a triangle or tetrahedron of first order P and G are best, and nearly all that differs is elsewhere.

   Where the elements are mixed, the pressure p has its own equation, that the volume be right: with q the pressure
   of y and theta = ln det F (with small strains tr grad u) the form is that of the saddle point, and

     (q* - q)(theta* - theta) - (p* - p)(q* - q) / modulus

   is added to the product at each point; p itself is in P already.

   Where the elements are enhanced, modes add E to the displacement gradient of the nodes and e to that of the adjoint.
   The true solutions have none. With T the rate of P along the adjoint,

     P* : e + E : T*

   is added to the product at each point. With the true fields in the place of the recovered ones this is exact in
   linear elasticity: P is the exact stress there, but that of the elements does no work on the modes.
   In large strains modes turn with the element's centre, and P : e is 0 no more. Thin elements that bend by large
   angles have much of it; where it is not small beside the sum, there is no estimate.

   The product of two recovered differences is of the order of the true one, and its sign is kept. It is no bound.
   Near a singularity both fields are off, and there the estimate is low.

   BodyErrorCreate() recovers the fields of the solution once, BodyErrorEvaluate() weighs them with an adjoint
   solution. Sources: Zienkiewicz and Zhu (1992); Becker and Rannacher (2001); Zhang and Naga (2005). */
#pragma once
#include "errors/recovery.h"

typedef struct _n_BodyError *BodyError;

typedef struct {
  PetscReal error;  /* true less computed value */
  PetscReal spread; /* sum of the magnitudes of the cells' shares: parts of the error that cancel out count here */
  PetscBool holds;  /* the theory does: enhanced elements do not turn too much within themselves */
} BodyErrorSums;

PetscErrorCode BodyErrorCreate(Mesh, Elasticity, Kinematics, const PetscReal *u, BodyError *);
PetscErrorCode BodyErrorDestroy(BodyError *);
PetscErrorCode BodyErrorEvaluate(BodyError, const PetscReal *y, PetscReal *cells, BodyErrorSums *);
