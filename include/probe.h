/* Probes: the scalars a scene asks for, by a registry of kinds (two functions and one line each in probe.c). */
#pragma once
#include "model.h"

typedef struct _n_Probes *Probes;

/* Resolves surfaces, pairs, bodies and points; refuses what does not exist (nearest node named). Collective. */
PetscErrorCode ProbesCreate(Model, Scene, Probes *);
PetscErrorCode ProbesDestroy(Probes *);
/* values[scene->n_probes] of the model's present state; NaN where there is no value (no contact). Collective, same on all ranks. */
PetscErrorCode ProbesEvaluate(Probes, PetscReal values[]);
/* Spacing of the nodes around the contact edge that probe i found at the last evaluation; NaN for other kinds and without contact. Not collective. */
PetscErrorCode ProbesGetSpacing(Probes, int i, PetscReal *spacing);

/* The end of contact along a line of nodes. Plain C.
   x[n] ascending coordinates and p[n] nodal pressures, loaded where p > 0; max_side: the end at large x, else at small x. The zero of p^2,
   extrapolated linearly from the last two loaded nodes and bounded by the next open one (Hertz's pressure falls so at its edge); half way
   to the open node where only one node is loaded; the last node of the line if that is loaded. NaN: no node is loaded. *spacing: distance
   of the last loaded and the open node, 0 at the line's end. */
double ContactEdge(int n, const double *x, const double *p, int max_side, double *spacing);
