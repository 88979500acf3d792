/* Batched element kernels, total Lagrangian, plain C: no PETSc, no MPI, no allocation. A batch is KERNEL_LANES elements
   of one type, law, geometry, kinematics and formulation; arrays are [node][dim][lane], so that the inner loops
   vectorise. A short batch repeats its last element. Sources of the forms: Bonet and Wood, "Nonlinear Continuum
   Mechanics for Finite Element Analysis". */
#pragma once
#include "kernels/element.h"
#include "kernels/formulation.h"
#include "kernels/material.h"

enum { KERNEL_LANES = 8 };

typedef struct {
  ElementType type;
  Geometry    geometry;
  Kinematics  kinematics;
  MaterialLaw law;
  Formulation formulation;
} KernelCase;

/* X: reference coordinates, u: displacements, [nodes][dim][lanes]; material per lane E[], nu[]. Axisymmetric X[.][0] is
   the radius itself. W[lanes]: strain energy, f[nodes][dim][lanes]: internal force, K[(nodes*dim)][(nodes*dim)][lanes]:
   tangent (full, symmetric); each may be NULL. Axisymmetric quantities are over 360 degrees. Returns in J[lanes] the
   smallest determinant of F over the points (small kinematics: 1); finite kinematics with J <= 0 still fills the arrays
   with finite numbers. */
void ElementKernel(const KernelCase *, const double *X, const double *u, const double *E, const double *nu, double *W,
                   double *f, double *K, double *J);
int  ElementKernelExists(const KernelCase *);
/* One element: the displacement gradient that the law is evaluated at, at its quadrature points [points][9]. X, u:
 * [nodes][dim]. */
void ElementPointGradient(const KernelCase *, const double *X, const double *u, double E, double nu, double *H);
/* One element: Cauchy stress (xx yy zz xy yz xz; axisymmetric: x = r, y = z, z = hoop) at its quadrature points
   [points][6] and their reference volumes [points]. X, u: [nodes][dim]. */
void ElementPointStress(const KernelCase *, const double *X, const double *u, double E, double nu, double *stress,
                        double *volume);
/* The same averaged over the element's volume, and that volume (reference). */
void ElementStress(const KernelCase *, const double *X, const double *u, double E, double nu, double stress[6],
                   double *volume);
/* Smallest determinant of dX/dxi at nodes and quadrature points over its mean: <= 0 inverted, 1 a parallelepiped
 * ("scaled Jacobian"). */
double ElementQuality(ElementType, int dim, const double *X);

/* One face, node order outward. X, u: [nodes][dim]. Traction (force per reference area), dead pressure (reference
   normal) or follower pressure (current normal and area): adds the external force to f[nodes*dim]; K (nodes*dim
   squared, may be NULL; unsymmetric for followers) receives -d(external force)/du added: the load's part of the
   tangent. energy may be NULL: potential -int t.u for dead loads. */
typedef enum { FACE_TRACTION, FACE_DEAD_PRESSURE, FACE_FOLLOWER_PRESSURE } FaceLoad;
void FaceLoadKernel(ElementType face, int dim, Geometry, FaceLoad, const double *X, const double *u,
                    const double *value, double *f, double *K, double *energy);
/* External force of a body force (force per reference volume) on one cell, added to f[nodes*dim]. */
void BodyForceKernel(ElementType, int dim, Geometry, const double *X, const double *value, double *f);
/* Tributary areas int N_a dA of one face (axisymmetric: 2 pi R dA), X: [nodes][dim] reference or current coordinates:
   adds to area[nodes]; normal (may be NULL): adds int N_a n dA to normal[nodes*dim] */
void   FaceAreaKernel(ElementType face, int dim, Geometry, const double *X, double *area, double *normal);
double CellVolume(ElementType, int dim, Geometry, const double *X);
