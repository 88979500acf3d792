/* Probes: the scalars that a scene asks for, by a registry of kinds.

   ProbesCreate() resolves what the probes refer to; ProbesEvaluate() computes their values in the model's present
   state. A new kind is one function and one line of the table in probe.c, its name in ProbeKind (scene.h), and its keys
   in schemakeys.c and sceneprobe.c. */
#pragma once
#include "solve/model.h"

typedef struct _n_Probes *Probes;

PetscErrorCode ProbesCreate(Model, Scene, Probes *);
PetscErrorCode ProbesDestroy(Probes *);
PetscErrorCode ProbesEvaluate(Probes, PetscReal values[]);
PetscErrorCode ProbesGetSpacing(Probes, int i, PetscReal *spacing);
