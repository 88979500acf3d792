/* The derivatives of probes by numbers of the scene, at the solution at the end of the load.

   With the residual R(u, p) = 0 and a probe J(u, p) the derivative by the number p is

     dJ/dp = (J(u, p+h) - J(u, p-h)) / 2h + y . (R(u, p+h) - R(u, p-h)) / 2h,

   where y is the adjoint solution of J at the free dofs (solve/adjoint.h): one linear solve for a probe, whatever the
   number of numbers. Probes without a first variation take the direct way, and all where contact lists hold supports of
   fits or quadrature points, which follow the solution: du/dp from a few linear solves for the number, and the
   difference of J between u + h du/dp at p+h and u - h du/dp at p-h. J and R of the changed scene come from a twin of
   the model (solve/twin.h). A parameter of the mesh moves its nodes: gmsh makes the twin's mesh, which must have the
   same nodes and cells.

   Where the answer depends on the way to it, by friction, yielding, multipliers, locked bolts or supports that come and
   go, dJ/dp is the difference of two whole runs at p+h and p-h that take the steps of the run at hand
   (again.h). Where it is not smooth, as at a node that sticks for one and slips for the other, the slopes on both sides
   differ, and that is said.

   Factors by which the run has made penalties stiffer are held. SensitivitiesCheck() and SensitivitiesCheckModel()
   refuse what cannot be done before the run begins, SensitivitiesFind() writes sensitivity.csv before the last solution
   is accepted, SensitivitiesFindByRuns() at the end of the run. Source: Choi and Kim, Structural Sensitivity Analysis
   and Optimization 1 and 2 (Springer, 2005). */
#pragma once
#include "again.h"

PetscErrorCode SensitivitiesCheck(Run *);
PetscErrorCode SensitivitiesCheckModel(Run *, const RunInput *);
PetscErrorCode SensitivitiesFind(Run *, const RunInput *);
PetscErrorCode SensitivitiesFindByRuns(Run *, const RunInput *, RunAgainFn);
