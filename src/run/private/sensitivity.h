/* The derivatives of probes by numbers of the scene, at the solution at the end of the load.

   With the residual R(u, p) = 0 and a probe J(u, p) the derivative by the number p is

     dJ/dp = (J(u, p+h) - J(u, p-h)) / 2h + y . (R(u, p+h) - R(u, p-h)) / 2h,

   where y is the adjoint solution of J at the free dofs (solve/adjoint.h): one linear solve for a probe, whatever the
   number of numbers. Probes without a first variation take the direct way, and all where contact lists hold supports of
   fits or quadrature points, which follow the solution: du/dp from a few linear solves for the number, and the
   difference of J between u + h du/dp at p+h and u - h du/dp at p-h. J and R of the changed scene come from a twin of
   the model (solve/twin.h). A parameter of the mesh moves its nodes: gmsh makes the twin's mesh, which must have the
   same nodes and cells.

   Factors by which the run has made penalties stiffer are held. SensitivitiesCheck() and SensitivitiesCheckModel()
   refuse what cannot be done before the run begins, SensitivitiesFind() writes sensitivity.csv before the last solution
   is accepted. Source: Choi and Kim, Structural Sensitivity Analysis and Optimization 1 and 2 (Springer, 2005). */
#pragma once
#include "run.h"

PetscErrorCode SensitivitiesCheck(Run *);
PetscErrorCode SensitivitiesCheckModel(Run *, const RunInput *);
PetscErrorCode SensitivitiesFind(Run *, const RunInput *);
