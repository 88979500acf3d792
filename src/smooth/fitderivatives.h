/* Variations of the diffuse gap over nodes, where fit points and slave point are combinations of nodes: x = sum S sign
   * x_node by component, as quadrature points of faces are, those on mirror images and those with an offset that
   follows the nodes around. Plain C: no PETSc, no MPI, no allocation.

   A support has more points than nodes behind them, and M grows with the square: FitDerivativesAdd() therefore takes
   the factors of M to the nodes (FitResult.factors instead of FitResult.M), not M. */
#pragma once
#include "smooth/diffusefit.h"

/* Row 0 is the slave point, row 1 + i the i-th point inside, as FitResult.points lists them; row r has the entries
   ptr[r] to ptr[r + 1] - 1. A node may occur in many rows, the slave point's among them. Fast where rows with the same
   nodes and signs follow each other: the points of a face. */
typedef struct {
  int           n_nodes;
  const int    *ptr;  /* [1 + points inside + 1] */
  const int    *node; /* of each entry, below n_nodes; negative: left out, a rigid tool's node without unknowns */
  const double *S;    /* of each entry */
  const double *sign; /* of each entry 3, each +1 or -1, whatever the dimension */
} FitDerivatives;

enum { FIT_DERIVATIVES_OWN = 6 }; /* entries of a point's own H: xx xy yy xz yz zz (2D: the first three) */

/* A sum of second variations in the making: FitDerivativesBegin(), FitDerivativesAdd() for each slave point,
   FitDerivativesEnd(); the points' own H are added apart, FitDerivativesAddOwn(). Of symmetric sums the upper triangle
   is written. */
typedef struct {
  int     dim, n_nodes, stride, depth;
  double *rows, *K, *J; /* rows: of the slave point at hand; K, J: [depth][stride], of all so far */
} FitDerivativesSum;

/* nodal[n_nodes*dim] = S^T N, for N[(1 + n)*dim] of n points inside. */
void FitDerivativesFirst(int dim, int n, const double *N, const FitDerivatives *, double *nodal);
/* M[(n_nodes*dim)^2] = sum factor S^T M S over slave points with maps to the same nodes. degree: the highest; depth:
   see there; workspace: FitDerivativesWorkspace() doubles, another one than that where the factors lie. */
int  FitDerivativesDepth(int dim, int degree);
long FitDerivativesWorkspace(int dim, int degree, int n_nodes, int depth);
void FitDerivativesBegin(FitDerivativesSum *, int dim, int degree, int n_nodes, int depth, double *workspace);
void FitDerivativesAdd(FitDerivativesSum *, double factor, const FitFactors *, const FitDerivatives *);
/* Where M itself is there instead of its factors; factor v v^T. */
void FitDerivativesAddDense(FitDerivativesSum *, double factor, int n, const double *M, const FitDerivatives *);
void FitDerivativesAddOuter(FitDerivativesSum *, double factor, const double *v);
void FitDerivativesEnd(FitDerivativesSum *, double *M);
/* The points' own H: own += factor H_i; M += sum of S^T own S over rows first to end - 1 of a map, which may belong to
 * points of many slave points. */
void FitDerivativesOwn(double factor, const FitFactors *, int i, double own[FIT_DERIVATIVES_OWN]);
void FitDerivativesAddOwn(int dim, int first, int end, const double (*own)[FIT_DERIVATIVES_OWN], const FitDerivatives *,
                          double *M);
