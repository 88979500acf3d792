/* Quadrature points of faces do not lie on the smooth surface that the faces stand for: each gets an offset b along the
   face's normal, the sagitta of the surface's own nodal fit over its interpolant on the face.

   Held: a vector that stands still in a solve, is extrapolated over the step and taken again when lists are made. Rigid
   tools and small kinematics: once, in the reference position. Live: a fixed combination of the nodes that the fit
   sees, by the coefficients of the reference position. It moves with the nodes, within a solve too, and is part of the
   points' variations. A rigid tool's moves with the tool and is held. */
#pragma once
#include "files/archive.h"
#include "search/facemap.h"
#include "search/search.h"

typedef struct _n_Offsets *Offsets;

/* What offsets there are: none at all, held ones, live ones */
typedef enum { OFFSETS_NONE, OFFSETS_HELD, OFFSETS_LIVE } OffsetsKind;

/* surface, images are borrowed; finer: quadrature of one order more. Collective. */
PetscErrorCode OffsetsCreate(Mesh, Scene, Loads, ContactSurface, int n_images, const SurfaceImage *,
                             PetscReal feature_angle, int finer, OffsetsKind, Offsets *);
PetscErrorCode OffsetsDestroy(Offsets *);
/* Takes the offsets at the accepted state (u, t) and carries their change since the one before on to t_next; *changed
   is set if others were in force. Collective. */
PetscErrorCode OffsetsExtrapolate(Offsets, const PetscReal *u, PetscReal t, PetscReal t_next, PetscBool *changed);
/* Takes the offsets at u as they are. Collective. */
PetscErrorCode OffsetsTake(Offsets, const PetscReal *u, PetscReal t);
/* What the next extrapolation starts from; nothing where they are taken once. Collective. */
PetscErrorCode OffsetsArchive(Offsets, Archive, const char *name);
/* [faces of the surface on this rank][FACE_RULE_POINTS*dim]; the array stays the same. Not collective. */
const PetscReal *OffsetsGet(Offsets);
/* Live offsets: the points as combinations of nodes, [faces of the surface on this rank]; there once offsets have been
 * taken. NULL: not live. Not collective.
 */
const FaceMaps *OffsetsMaps(Offsets);
