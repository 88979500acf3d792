/* Adjoint solutions: how a quantity of a solution depends on what is wrong in the equations.

   A Functional is the first variation of a quantity J of the solution:

     dJ = direct . du + held . dR + pressed . dR_p

   R is the residual (element and contact forces less the loads), R_p its part from some contact pairs. A
   displacement has `direct` alone; a reaction is the residual at prescribed dofs, which `held` sums up; a contact force
   is the residual of a pair at the nodes of its slave, which `pressed` sums up, and the reaction of a rigid tool that
   of all pairs whose master it is. The adjoint solution y is `held` at the
   prescribed dofs, and at the free ones it solves

     (K^T y)_f = -(direct + C_p^T pressed)_f,  K = dR/du, C_p = dR_p/du.

   A change dR of the residual then changes J by y . dR, after the solution has followed (and by pressed . dR_p
   besides). So y weighs every cause of error: what the elements leave (errors/bodyerror.h), what penetration
   leaves, what the solver leaves of the residual.

   ModelAdjoint() computes y for any number of functionals with one tangent and one factor. What is in
   contact at the solution stays so. ModelShapeErrors() weighs with them what masters leave that miss their own nodes,
   ModelWithinFaces() what contact leaves within faces.
   ModelRespond() goes the other way: one change of the residual, and how all
   displacements follow it. Source: Becker and Rannacher, Acta Numerica 10 (2001). */
#pragma once
#include "solve/model.h"

/* Each of the three is NULL on all ranks or on none: MeshCreateLocal() */
typedef struct {
  PetscReal *direct;  /* this rank's share [n_nodes*dim]; NULL: none */
  PetscReal *held;    /* [n_nodes*dim], ghosts included; NULL: none */
  PetscReal *pressed; /* [n_nodes*dim], ghosts included; NULL: none */
  PetscBool *pairs;   /* that it is of [ContactPairs()]; NULL with it */
} Functional;

typedef struct {
  PetscBool  known;       /* the linear solve succeeded */
  PetscReal *y;           /* [n_nodes*dim], ghosts included; of the caller */
  PetscReal  penetration; /* error of J by penetration: true less computed value */
  PetscReal  slip;        /* by elastic slip */
  PetscReal  residual;    /* by the residual that the solver left */
} Adjoint;

PetscErrorCode ModelAdjoint(Model, int n, const Functional[], Adjoint[]);
PetscErrorCode ModelShapeErrors(Model, int n, const Functional[], const Adjoint[], PetscReal error[]);
PetscErrorCode ModelWithinFaces(Model, int n, const Functional[], const Adjoint[], PetscReal error[]);
PetscErrorCode ModelRespond(Model, Vec change, Vec response, PetscBool *known);
