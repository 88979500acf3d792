/* Rings of points that a quadrature point of an axisymmetric surface becomes. */
#include "ring.h"

/* Distance of points along the hoop, in spacings of the master's nodes. A support has a radius of some 3 spacings. The
   midpoint rule is then exact to 1e-6, because weights end smoothly. */
#define RING_SPACING 0.5
/* Fewest points on half of a ring. Near the axis a support holds rings as a whole, and over an angle a weight and the
   polynomials hold few harmonics. */
#define RING_LEAST 8

/*@
  RingOf - divides a ring into points. Half of them, on one side of the meridian plane, stand for both sides.

  Not collective

  Input Parameters:
+ radius  - of the ring, in the reference configuration (length)
. spacing - of the nodes there (length)
- reach   - points farther than this from the ring's point in the meridian plane are left out (length)

  Note:
  The points are material points: they do not depend on the deformation.
@*/
Ring RingOf(PetscReal radius, PetscReal spacing, PetscReal reach)
{
  const PetscReal half = PETSC_PI * radius / (RING_SPACING * spacing), sine = reach / (2 * radius);
  Ring            ring = {.radius = radius, .step = PETSC_PI / PetscMax(RING_LEAST, PetscCeilReal(half))};
  const PetscReal most = sine < 1 ? 2 * PetscAsinReal(sine) : PETSC_PI;

  ring.n = PetscMin(RING_KEYS, PetscMax(1, (PetscInt)PetscFloorReal(most / ring.step + 0.5)));
  return ring;
}

/*@
  RingAngle - returns the angle of a point of a ring from the meridian plane.

  Not collective

  Input Parameters:
+ ring - the ring
- j    - the point, from 0 to n - 1
@*/
PetscReal RingAngle(const Ring *ring, PetscInt j)
{
  return (j + 0.5) * ring->step;
}

/*@
  RingWeight - returns the length of the ring that a point stands for, on both sides of the meridian plane (length).

  Not collective

  Input Parameter:
. ring - the ring
@*/
PetscReal RingWeight(const Ring *ring)
{
  return 2 * ring->radius * ring->step;
}
