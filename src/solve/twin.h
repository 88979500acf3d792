/* Twins: a model of a scene in which one number is a little different, evaluated beside the solution of the model.

   ModelSettleLists() solves the model with contact lists that were made at its solution, which a twin can make, too.
   The two have meshes with the same nodes and cells. ModelTwinFollow() checks that and gives a fresh twin the penalties
   of the model. ModelTwinGather() makes its contact lists. ModelTwinEvaluate() puts the twin at free
   displacements, which it shares with the model, with the prescribed ones of its own scene. The residual there, less
   that of the model, is what the number changes of the equations, and probes of the twin say what it changes besides.
   No equilibrium is solved for. */
#pragma once
#include "solve/model.h"

PetscErrorCode ModelSettleLists(Model, Vec place, PetscBool *ok);
PetscErrorCode ModelTwinFollow(Model twin, Model, PetscBool *same);
PetscErrorCode ModelTwinGather(Model twin, Vec x, PetscReal t);
PetscErrorCode ModelTwinEvaluate(Model twin, Vec x, PetscReal t, Vec F, PetscBool *ok);
