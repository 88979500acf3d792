/* Quadrature points of faces do not lie on the smooth surface that the faces stand for: each gets an offset b along the face's normal, the
   sagitta of the surface's own nodal fit over its interpolant on the face. Held in a solve, extrapolated over the step, taken again when
   lists are made. Rigid tools and small kinematics: once, in the reference position. */
#pragma once
#include "archive.h"
#include "search.h"

typedef struct _n_Offsets *Offsets;

/* surface, images are borrowed; finer: quadrature of one order more; smooth: else all offsets stay 0. Collective. */
PetscErrorCode OffsetsCreate(Mesh, Scene, Loads, ContactSurface, int n_images, const SurfaceImage *, PetscReal feature_angle, int finer, PetscBool smooth,
                             Offsets *);
PetscErrorCode OffsetsDestroy(Offsets *);
/* Takes the offsets at the accepted state (u, t) and carries their change since the one before on to t_next. Collective. */
PetscErrorCode OffsetsExtrapolate(Offsets, const PetscReal *u, PetscReal t, PetscReal t_next);
/* Takes the offsets at u as they are. Collective. */
PetscErrorCode OffsetsTake(Offsets, const PetscReal *u, PetscReal t);
/* What the next extrapolation starts from; nothing where they are taken once. Collective. */
PetscErrorCode OffsetsArchive(Offsets, Archive, const char *name);
/* [faces of the surface on this rank][FACE_RULE_POINTS*dim]; the array stays the same. Not collective. */
const PetscReal *OffsetsGet(Offsets);
