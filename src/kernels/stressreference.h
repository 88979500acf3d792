/* The state from which a tangent extrapolates stress. Plain C.

   The geometric part of a tangent holds the stress of the state at hand. An iterate of Newton's method is stretched a
   little where it should only bend or be sheared. In thin walls and in nearly incompressible solids its stress is then
   wrong by many times the stress at equilibrium. The stress that extrapolates linearly from an earlier state is not. Of
   separable laws (material.h) the pressure alone is extrapolated. Force and energy are always those of the state at
   hand, and so is the rest of the tangent.

   ElementKernel() takes displacements of a batch, ElasticityTangent() those of all local nodes.

   Sources: Magisano, Leonetti and Garcea, "How to improve efficiency and robustness of the Newton method in
   geometrically non-linear structural problem discretized via displacement-based finite elements", Computer Methods in
   Applied Mechanics and Engineering 313, 2017. For enhanced elements: Pfefferkorn, Bieber, Oesterle, Bischoff and
   Betsch, "Improving efficiency and robustness of enhanced assumed strain elements for nonlinear problems",
   International Journal for Numerical Methods in Engineering 122, 2021. Both change forces too on the way, by stresses
   that are unknowns of the iteration; here the forces stay. */
#pragma once

typedef struct {
  const double *u;    /* displacements of the earlier state (length) */
  double        rate; /* 1: the stress there and its linear change on the way; 0: the stress there alone */
  int           held; /* 1: elements with multipliers have the pressure to which ElementFollow() has set these */
} StressReference;
