/* The state from which a tangent extrapolates pressure. Plain C.

   The geometric part of a tangent holds the stress of the state at hand. In nearly incompressible solids an iterate of
   Newton's method violates the volume by little, and its pressure is wrong by many times the stress. The pressure that
   extrapolates linearly from an earlier state is not. Force and energy are always those of the state at hand, and so is
   the rest of the tangent.

   ElementKernel() takes displacements of a batch, ElasticityTangent() those of all local nodes.

   Source of the idea: Magisano, Leonetti and Garcea, "How to improve efficiency and robustness of the Newton method in
   geometrically non-linear structural problem discretized via displacement-based finite elements", Computer Methods in
   Applied Mechanics and Engineering 313, 2017, where all of the stress is extrapolated. */
#pragma once

typedef struct {
  const double *u;    /* displacements of the earlier state (length) */
  double        rate; /* 1: the pressure there and its linear change on the way; 0: the pressure there alone */
} PressureReference;
