/* Fit points of space as a slave point or a fit's origin sees them. All components of a point are found at once, and
   with them a fourth number that has no meaning: arrays of places have room for POINT_SEEN_PADDING numbers behind
   their last point. */
#pragma once
#include "base/lanes.h"
#include "search/neighbourlists.h"

enum { POINT_SEEN_PADDING = 1 };

typedef double SpacePoint __attribute__((vector_size(4 * sizeof(double))));

/* Where points are seen from: its reference position and its displacement. */
typedef struct {
  SpacePoint X, u;
} PointOrigin;

/*@
  PointOriginMake - makes an origin of 3D.

  Not collective

  Input Parameters:
+ X - its reference position, X[3] (length)
- u - its displacement, u[3] (length)

  Output Parameter:
. origin - the origin
@*/
static inline void PointOriginMake(const PetscReal *X, const PetscReal *u, PointOrigin *origin)
{
  origin->X = (SpacePoint){X[0], X[1], X[2], 0};
  origin->u = (SpacePoint){u[0], u[1], u[2], 0};
}

/*@
  PointSeen - computes the position of a point of 3D relative to an origin, as NeighbourListsRelative() does.

  Not collective

  Input Parameters:
+ lists  - the lists
. p      - the point
- origin - of PointOriginMake()

  Output Parameter:
. x - x[3], and one number more (length)
@*/
static inline void PointSeen(NeighbourLists lists, PetscInt p, const PointOrigin *origin, PetscReal *x)
{
  const PointInArray *X = (const PointInArray *)&lists->point_X[3 * p],
                     *u = (const PointInArray *)&lists->point_u[3 * p];

  *(PointInArray *)x = (*X - origin->X) + (*u - origin->u);
}

/*@
  PointsSeen - computes the positions of points relative to an origin, as NeighbourListsRelative() does.

  Not collective

  Input Parameters:
+ lists - the lists, of any dimension
. n     - number of points
. point - the points
. X     - reference position of the origin, X[dim] (length)
- u     - its displacement, u[dim] (length)

  Output Parameter:
. x - x[n*dim], and POINT_SEEN_PADDING numbers more (length)
@*/
static inline void PointsSeen(NeighbourLists lists, PetscInt n, const PetscInt point[], const PetscReal *X,
                              const PetscReal *u, PetscReal *x)
{
  PointOrigin origin;

  for (PetscInt i = 0; i < n && lists->dim == 2; i++)
    for (int d = 0; d < 2; d++)
      x[2 * i + d] = (lists->point_X[2 * point[i] + d] - X[d]) + (lists->point_u[2 * point[i] + d] - u[d]);
  if (lists->dim == 2) return;
  PointOriginMake(X, u, &origin);
  for (PetscInt i = 0; i < n; i++) PointSeen(lists, point[i], &origin, &x[3 * i]);
}
