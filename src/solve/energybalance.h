/* The energies of bodies that yield or whose steps are judged: what was done to them, what they store and what they
   have dissipated.

   EnergyBalanceAdd() takes each accepted state, EnergyBalanceGet() gives the figures. The work on the bodies is the
   integral of the internal forces over the displacements, by the trapezoidal rule over the steps. Elastic energy and
   plastic work follow from the state alone. Their sum is the work, up to the error of that rule. Bodies that do not
   yield have their elastic energy alone. The work from outside is that of EnergyBalanceOuter(). What contact stores and
   what friction and held motions take comes to the sum there. EnergyBalanceEnd() compares what has been dissipated. */
#pragma once
#include "solve/outerwork.h"

typedef struct {
  PetscReal    elastic;    /* energy that is stored in all bodies */
  PetscReal    plastic;    /* energy that plastic flow has dissipated, hardening included */
  PetscReal    work;       /* done on all bodies by loads, supports and contact; 0 where none of them may yield */
  PetscReal    strain;     /* largest equivalent plastic strain of a quadrature point */
  PetscReal    growth;     /* largest growth of it in a step so far */
  PetscReal    lag;        /* plastic work times the part by which stresses lag behind the flow, over all steps */
  PetscReal    damping;    /* energy that the viscous restraint of unstable steps took */
  PetscReal    dissipated; /* by flow and friction */
  PetscReal    least;      /* the least energy that a step has dissipated so far, where that is below 0; else 0 */
  OuterFigures outer;
} EnergyFigures;

typedef struct _n_EnergyBalance *EnergyBalance;

PetscErrorCode EnergyBalanceCreate(Problem, EnergyBalance *);
PetscErrorCode EnergyBalanceDestroy(EnergyBalance *);
PetscErrorCode EnergyBalanceAdd(EnergyBalance, const PetscReal *u_0, const PetscReal *u, PetscReal t,
                                const PlasticPath *);
void           EnergyBalanceEnd(EnergyBalance);
OuterWork      EnergyBalanceOuter(EnergyBalance);
EnergyFigures  EnergyBalanceGet(EnergyBalance);
PetscReal      EnergySum(const EnergyFigures *);
PetscReal      EnergyApart(const EnergyFigures *);
PetscErrorCode EnergyBalanceArchive(EnergyBalance, Archive, const PetscReal *u);
