/* Where the friction force of a slave point acts on a face of the master, and on which nodes. Plain C.

   The foot is the point of the true face that the line through the slave point x along its normal n hits:
       x - sum_k N_k(xi) x_k = distance n
   The force F of the point acts there on the face's nodes, as -N_k F. The foot is off the slave point by the distance
   of the two faces along n, so the two forces would turn the bodies. The lever undoes this by a couple on the nodes
   around the slave point. Its tangents are z_a = sum_k D_ka x_k, with fixed slopes D whose sum over k is zero. With
   F = c n + sum_a F^a z_a the couple is
       f_k = distance sum_a F^a D_ka n
   Its sum is zero, its moment that of the force over the distance: sum_k x_k x f_k = distance F x n. The slopes stay
   when the foot goes on to another face of the master, so all forces are continuous then. On the nodes of the master's
   face the couple would jump there, and Newton's method would go to and fro.

   FrictionFootFind() finds the foot, FrictionFootVary() gives the derivatives of its forces where F is held.
   FrictionLeverMake() makes the lever, FrictionLeverForces() gives its forces as linear maps of F, FrictionLeverVary()
   their derivatives. Positions are relative to the slave point. In two dimensions all third components are 0. */
#pragma once
#include "kernels/element.h"

typedef struct {
  int    nodes, tangents;
  double xi[2], distance; /* a length, positive on the side of the normal */
  double outside;         /* how far xi is outside of the reference face; 0 inside */
  double normal[3];
  double N[FACE_MAX_NODES], dN[FACE_MAX_NODES][2];
  double inverse[3][3]; /* of the matrix with the columns n, y_,1 and y_,2 (2D: the third axis) */
} FrictionFoot;

typedef struct {
  int    tangents;
  double inverse[3][3]; /* of the matrix with the columns n, z_1 and z_2 (2D: the third axis) */
} FrictionLever;

/* Derivatives of the force on one node, F held: by w = dx - sum_k N_k dx_k, by n, and by the lever's tangents. */
typedef struct {
  double by_place[3][3], by_normal[3][3], by_tangent[2][3][3];
} FrictionFootVariation;

int  FrictionFootFind(int dim, ElementType, const double *x, const double normal[3], FrictionFoot *);
void FrictionFootVary(const FrictionFoot *, const double F[3], int node, FrictionFootVariation *);
int  FrictionLeverMake(int dim, const double normal[3], const double tangent[2][3], FrictionLever *);
void FrictionLeverForces(const FrictionLever *, const FrictionFoot *, const double slope[2], double force[3][3]);
void FrictionLeverVary(const FrictionLever *, const FrictionFoot *, const double F[3], const double slope[2],
                       FrictionFootVariation *);
