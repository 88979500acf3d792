/* The error of quantities of a solution, split by cause.

   QuantityErrorsEstimate() takes first variations of quantities (solve/adjoint.h), solves for their adjoint
   solutions, and weighs with them what each cause leaves: the elements of the bodies (errors/bodyerror.h),
   penetration and elastic slip (the derivative by the penalty, solve/penaltyerror.c), and the residual at which the
   solver stopped. Every part is the true less the computed value, in the units of the quantity. A part that is not
   known is NaN: that of the load steps where the answer depends on the path, unless a second run gives it
   (QuantityErrorSetSteps(), run/historyerror.c), and that of the surfaces in contact
   where one master is a meshed rigid tool or of facets. Of smooth masters it is how far they miss their own nodes
   (ContactPairShapeForces()). That of contact within faces is known without friction
   (ContactPairWithinFaces()), but not between nodes of first order. Each is 0 where there is no such cause: masters are
   analytic, all of a slave is in contact. That straight edges of elements stand for curved boundaries is in no part.

   What is estimated by recovered fields is known to a factor of two: cells, contact surfaces, contact within faces.
   Half of their magnitudes is what the sum may be off by. The last two correct the same gaps and count together: nodes
   of a master that yield in waves under nodal forces are in both, with opposite signs. Behind a zone of contact the
   fields are off besides by as much of themselves as the end of the zone is off by, over its extent (ContactZoneOff()).
   Where all that is more than the sum, the parts cancel, and the error may be as large with either sign
   (QuantityErrorCancels()).

   QuantityErrorShares() serves quantities without a first variation, such as a peak or the end of a contact zone: it
   says where elements are to become smaller, but not how large the error is. */
#pragma once
#include "solve/adjoint.h"

typedef enum {
  ERROR_BODIES,
  ERROR_GEOMETRY,
  ERROR_FACES,
  ERROR_PENETRATION,
  ERROR_SLIP,
  ERROR_STEPS,
  ERROR_SOLVER,
  ERROR_CAUSES
} ErrorCause;
extern const char *const ErrorCauses[]; /* in words */

typedef struct {
  const char *why; /* there is no estimate; NULL: there is one */
  PetscReal   part[ERROR_CAUSES];
  PetscReal   sum;       /* of the known parts */
  PetscReal   magnitude; /* sum of their absolute values */
  PetscReal   uncertain; /* what the sum may be off by */
  PetscReal   end;       /* what cells behind zones of contact may be off by, as the ends of these are off */
  PetscReal   spread;    /* sum of the magnitudes of the cells' shares in that of the bodies */
  PetscBool   shared;    /* the cells' shares are known; the same on all ranks */
  PetscReal  *cells;     /* share of each local cell in that of the bodies; NULL on a rank without cells, too */
} QuantityError;

PetscErrorCode QuantityErrorsEstimate(Model, int n, const Functional[], const PetscReal off[], QuantityError[]);
PetscErrorCode QuantityErrorShares(Model, QuantityError *);
void           QuantityErrorScale(PetscReal value, QuantityError *);
PetscBool      ModelDependsOnPath(Model);
PetscBool      QuantityErrorCancels(const QuantityError *);
void           QuantityErrorSetSteps(QuantityError *, PetscReal steps);
PetscErrorCode QuantityErrorReset(QuantityError *);
