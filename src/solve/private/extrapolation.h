/* Extrapolation of the accepted states to the next load parameter. Bodies that rotate go on rotating, which a step with
   the tangent, a straight line, does not follow.

   ExtrapolationAdd() takes each accepted state, ExtrapolationEvaluate() computes the displacements to be expected and
   says whether they are worth a try. ExtrapolationForget() is called where the loads change their direction or rate,
   ExtrapolationReplace() where bodies were moved. */
#pragma once
#include "files/archive.h"
#include "mesh/mesh.h"

typedef struct _n_Extrapolation *Extrapolation;

PetscErrorCode ExtrapolationCreate(Mesh, Extrapolation *);
PetscErrorCode ExtrapolationDestroy(Extrapolation *);
PetscErrorCode ExtrapolationAdd(Extrapolation, const PetscReal *u, PetscReal t);
PetscErrorCode ExtrapolationForget(Extrapolation);
PetscErrorCode ExtrapolationReplace(Extrapolation, const PetscReal *u, PetscReal t);
PetscErrorCode ExtrapolationEvaluate(Extrapolation, PetscReal t, PetscReal *u, PetscBool *smooth);
PetscErrorCode ExtrapolationArchive(Extrapolation, Archive, const Hdf5Table *nodes, const PetscReal *u);
