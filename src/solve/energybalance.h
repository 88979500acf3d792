/* The energies of plastic bodies: what was done to them, what they store and what they have dissipated.

   EnergyBalanceAdd() takes each accepted state, EnergyBalanceGet() gives the figures. The work on the bodies is the
   integral of the internal forces over the displacements, by the trapezoidal rule over the steps. Elastic energy and
   plastic work follow from the state alone. Their sum is the work, up to the error of that rule. The work from outside
   is that of EnergyBalanceOuter(). What contact stores and friction takes comes to the sum there. */
#pragma once
#include "solve/outerwork.h"

typedef struct {
  PetscReal elastic; /* energy that is stored in all bodies */
  PetscReal plastic; /* energy that plastic flow has dissipated, hardening included */
  PetscReal work;    /* done on all bodies by loads, supports and contact */
  PetscReal strain;  /* largest equivalent plastic strain of a quadrature point */
  PetscReal growth;  /* largest growth of it in a step so far */
  PetscReal lag;     /* plastic work times the part by which stresses lag behind the flow, over all steps */
  OuterFigures outer;
} EnergyFigures;

typedef struct _n_EnergyBalance *EnergyBalance;

PetscErrorCode EnergyBalanceCreate(Problem, EnergyBalance *);
PetscErrorCode EnergyBalanceDestroy(EnergyBalance *);
PetscErrorCode EnergyBalanceAdd(EnergyBalance, const PetscReal *u_0, const PetscReal *u, const PlasticPath *);
OuterWork      EnergyBalanceOuter(EnergyBalance);
EnergyFigures  EnergyBalanceGet(EnergyBalance);
PetscReal      EnergyApart(const EnergyFigures *);
PetscErrorCode EnergyBalanceArchive(EnergyBalance, Archive, const PetscReal *u);
