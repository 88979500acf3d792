/* Probes: the scalars a scene asks for, by a registry of kinds. A new kind is one function and one line of the table in
   probe.c, its name in ProbeKind (scene.h), its keys in schemakeys.c and sceneprobe.c. */
#pragma once
#include "solve/model.h"

typedef struct _n_Probes *Probes;

/* Resolves surfaces, pairs, bodies and points; refuses what does not exist (nearest node named). Collective. */
PetscErrorCode ProbesCreate(Model, Scene, Probes *);
PetscErrorCode ProbesDestroy(Probes *);
/* values[scene->n_probes] of the model's present state; NaN where there is no value (no contact). Collective, same on
 * all ranks. */
PetscErrorCode ProbesEvaluate(Probes, PetscReal values[]);
/* Spacing of the nodes around the contact edge that probe i found at the last evaluation; NaN for other kinds and
 * without contact. Not collective. */
PetscErrorCode ProbesGetSpacing(Probes, int i, PetscReal *spacing);
