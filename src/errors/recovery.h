/* Recovered fields: from values at the quadrature points of all cells a smooth field that is nearer to the true
   one.

   RecoveryCreate() finds the patch of each corner node, which are the cells around it, and factors its matrix.
   RecoveryFit() computes the polynomials of all patches for a field from its values at the quadrature points, and
   RecoveryEvaluate() gives the recovered field at a point of products (ElementGetProducts()): the polynomials of the
   corners of its cell, weighted by the linear shape functions and by how well each one is known there, which is one
   over the variance of its value at its node. At the boundary patches of nodes inside therefore count most, as in
   Zienkiewicz and Zhu (1992). Polynomials have the order of the elements. A field that is such a polynomial comes back
   exactly (kernels/recovery.h).

   The sums of a patch are added over the ranks that share it, so that the field does not depend on their number.
   Bodies share no nodes, and no patch reaches over two of them. */
#pragma once
#include "bodies/elasticity.h"
#include "kernels/recovery.h"

typedef struct _n_Recovery *Recovery;

PetscErrorCode RecoveryCreate(Mesh, Elasticity, Recovery *);
PetscErrorCode RecoveryDestroy(Recovery *);
PetscInt       RecoveryPoints(Recovery, PetscInt cell, const PetscReal **volume);
PetscInt       RecoveryProducts(Recovery, PetscInt cell, const PetscReal **volume);
PetscErrorCode RecoveryFit(Recovery, int width, const PetscReal *values, PetscReal **patches);
void           RecoveryEvaluate(Recovery, int width, const PetscReal *patches, PetscInt cell, int p, PetscReal *value);
