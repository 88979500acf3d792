/* Fluids that enter between surfaces in contact: pressures with `where: open`.

   A fluid of pressure P wets a place of its surface where contact alone would press less than P, if wet places connect
   it to the end from which the fluid comes. There the fluid carries P, and contact only what is beyond it
   (ContactSetCarried()), so that both together press max(P, contact). A place that becomes wet or dry where contact
   presses P changes no force. Where contact presses more again, the fluid retreats.

   Where the master deforms, the fluid is a load on both surfaces. On the master it makes up for what the reactions of
   the slave's contact lack (fluidmaster.c).

   FluidCreate() makes the fluids of a scene, FluidStart() finds the ends that the state before any load shows.
   FluidBegin() begins a load step, FluidMove() wets and dries the surfaces at a solution, until nothing changes, and
   FluidSettle() ends the solve.
   FluidAccept(), FluidRestore() and FluidArchive() treat the wet places as the other parts of the state.
   FluidGetReport() says where a fluid is, and when it leaked. */
#pragma once
#include "contact/contact.h"

/* A fluid in the present state. */
typedef struct {
  const SceneLoad *load;
  PetscReal        pressure; /* of the fluid (force per area) */
  PetscReal        wetted;   /* part of the surface's reference area */
  PetscReal barrier;       /* lowest pressure with which the fluid would leak in this contact; NaN: it has leaked, or no
                              end is known at which it could */
  PetscReal leak_t;        /* load parameter of the step after this state in which it leaks; NaN: it was not found to */
  PetscReal leak_pressure; /* where pressure and barrier met before (force per area); NaN without a leak */
} FluidReport;

typedef struct _n_Fluids *Fluids;

PetscErrorCode FluidCreate(Mesh, Scene, Loads, Contact, Fluids *);
PetscErrorCode FluidDestroy(Fluids *);
PetscErrorCode FluidStart(Fluids, const PetscReal *u);
PetscErrorCode FluidBegins(Fluids, PetscReal t, PetscBool *begins);
PetscErrorCode FluidBegin(Fluids, const PetscReal *u, PetscReal t);
PetscErrorCode FluidMove(Fluids, const PetscReal *u, PetscReal t, PetscBool *moved);
PetscErrorCode FluidReaches(Fluids, PetscReal t_0, PetscReal t, PetscReal dt_min, PetscBool *reaches,
                            PetscBool *closely);
PetscErrorCode FluidSettle(Fluids, const PetscReal *u, PetscReal t);
PetscErrorCode FluidAccept(Fluids, const PetscReal *u, PetscReal t);
PetscErrorCode FluidRestore(Fluids, const PetscReal *u, PetscReal t);
PetscErrorCode FluidArchive(Fluids, Archive);
int            FluidCount(Fluids);
void           FluidGetReport(Fluids, int fluid, FluidReport *);
void           FluidLeakText(Fluids, char *text, size_t size);
int            FluidFind(Fluids, const char *surface);
PetscErrorCode FluidFront(Fluids, int fluid, const PetscReal *u, int axis, PetscBool max_side, PetscReal *front);
