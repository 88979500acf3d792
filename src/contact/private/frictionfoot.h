/* Where the friction force of a slave point acts on a face of the master, and on which nodes. Plain C.

   The foot is the point of the true face that the line through the slave point x along its normal n hits:
       x - sum_k N_k(xi) x_k = distance n
   The force F of the point acts there on the face's nodes, as -N_k F. The foot is off the slave point by the distance
   of the two faces along n, so the two forces would turn the bodies. The couple that undoes this acts on the face's
   nodes too: with F = c n + sum_a F^a y_,a (y_,a the face's tangents at the foot) it is
       f_k = distance sum_a F^a N_k,a n
   Its sum is zero, its moment that of the force over the distance, to the first order in the distance.

   FrictionFootFind() finds the foot, FrictionFootForces() the nodal forces as linear maps of F, FrictionFootVary()
   their derivatives where F is held. Positions are relative to the slave point. In two dimensions all third components
   are 0. */
#pragma once
#include "kernels/element.h"

typedef struct {
  int    nodes, tangents;
  double xi[2], distance; /* a length, positive on the side of the normal */
  double outside;         /* how far xi is outside of the reference face; 0 inside */
  double normal[3];
  double N[FACE_MAX_NODES], dN[FACE_MAX_NODES][2], d2N[FACE_MAX_NODES][2][2];
  double inverse[3][3]; /* of the matrix with the columns n, y_,1 and y_,2 (2D: the third axis) */
  double bend[2][2][3]; /* y_,ab */
} FrictionFoot;

/* Derivatives of the force on one node of the face, F held: by w = dx - sum_k N_k dx_k, by n, and by the change of each
   tangent at fixed xi, sum_k N_k,a dx_k. */
typedef struct {
  double by_place[3][3], by_normal[3][3], by_tangent[2][3][3];
} FrictionFootVariation;

int  FrictionFootFind(int dim, ElementType, const double *x, const double normal[3], FrictionFoot *);
void FrictionFootForces(const FrictionFoot *, int node, double force[3][3]);
void FrictionFootVary(const FrictionFoot *, const double F[3], int node, FrictionFootVariation *);
