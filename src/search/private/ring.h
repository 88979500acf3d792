/* Rings of points: the quadrature points of an axisymmetric surface as the fits of a body of revolution see them, on
   both sides of the meridian plane. Plain arithmetic.

   RingOf() divides the ring of a quadrature point. RingAngle() and RingWeight() give place and weight of its points. */
#pragma once
#include <petscsys.h>

/* Numbers for the points of one ring, in keys. */
enum { RING_KEYS = 4096 };

typedef struct {
  PetscReal radius, step; /* in the reference configuration (length); angle between two points (radians) */
  PetscInt  n;            /* points on one side of the meridian plane */
} Ring;

Ring      RingOf(PetscReal radius, PetscReal spacing, PetscReal reach);
PetscReal RingAngle(const Ring *, PetscInt j);
PetscReal RingWeight(const Ring *);
