/* Variations of the diffuse gap over nodes, where fit points and slave point are combinations of nodes: x = sum S sign
   x_node, component by component. Quadrature points of faces are such points, also those on mirror images and those
   with an offset that follows the nodes around. Plain C: no PETSc, no MPI, no allocation.

   FitDerivativesFirst() makes the first variation of one slave point. The second variations of slave points over the
   same nodes are summed: FitDerivativesBegin(), then FitDerivativesAdd() for each slave point (FitDerivativesAddDense()
   where M itself is given, FitDerivativesAddOuter() for factor v v^T), then FitDerivativesEnd(). FitDerivativesSlave()
   gives the rows of M that belong to the slave point, which are the derivatives of its own N. FitDerivativesOwn()
   collects the points' own H, and FitDerivativesAddOwn() adds them separately. The workspace of the sum must not be the
   one in which the factors lie.

   A support has more points than nodes behind them, and the size of M grows with the square of their number.
   Therefore FitDerivativesAdd() takes the factors of M (FitResult.factors instead of FitResult.M) to the nodes, not
   M. */
#pragma once
#include "smooth/diffusefit.h"

/* Map from points to nodes. Row 0 is the slave point, and row 1 + i is the i-th point inside, as FitResult.points
   lists them. Row r has the entries ptr[r] to ptr[r + 1] - 1. A node may occur in many rows, also in that of the
   slave point. The functions are fast where rows with the same nodes and signs follow each other, like the points of
   a face. */
typedef struct {
  int        n_nodes;
  const int *ptr; /* [1 + points inside + 1] */
  const int *run; /* of each row: the first of the rows, one after the other, that have the same nodes and signs */
  /* Node of each entry, below n_nodes. A negative one is left out: a node of a rigid tool, which has no unknowns. Nodes
     and signs are read in the first row of each run. */
  const int    *node;
  const double *S;    /* of each entry */
  const double *sign; /* 3 for each entry, each +1 or -1, in 2D too */
} FitDerivatives;

/* Entries of a point's own H: xx xy yy xz yz zz (2D: the first three). */
enum { FIT_DERIVATIVES_OWN = 6 };

/* A sum of second variations. Of symmetric sums the upper triangle is written. */
typedef struct {
  int dim, n_nodes, stride, depth;
  /* Rows that couple slave points to their fit points. They are the last ones of K and J, behind `room` rows in all:
     those of J have entries at the nodes of slave points only. */
  int coupled, room;
  /* rows: of the present slave point; K, J: [depth][stride], of all slave points so far. */
  double *rows, *K, *J;
} FitDerivativesSum;

void FitDerivativesFirst(int dim, int n, const double *N, const FitDerivatives *, double *nodal);
int  FitDerivativesDepth(int dim, int degree);
long FitDerivativesWorkspace(int dim, int degree, int n_nodes, int depth);
void FitDerivativesBegin(FitDerivativesSum *, int dim, int degree, int n_nodes, int depth, double *workspace);
void FitDerivativesAdd(FitDerivativesSum *, double factor, const FitFactors *, const FitDerivatives *);
void FitDerivativesAddDense(FitDerivativesSum *, double factor, int n, const double *M, const FitDerivatives *);
void FitDerivativesAddOuter(FitDerivativesSum *, double factor, const double *v);
void FitDerivativesJoin(FitDerivativesSum *);
void FitDerivativesEnd(FitDerivativesSum *, double *M);
void FitDerivativesSlave(const FitFactors *, int component, double *row);
void FitDerivativesOwn(double factor, const FitFactors *, int i, double own[FIT_DERIVATIVES_OWN]);
void FitDerivativesAddOwn(int dim, int first, int end, const double (*own)[FIT_DERIVATIVES_OWN], const FitDerivatives *,
                          double *M);
