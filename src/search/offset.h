/* Offsets of quadrature points. These points do not lie on the smooth surface for which the faces stand. Each gets an
   offset b along the face's normal: the sagitta of the surface's own nodal fit over the interpolant of that fit on the
   face, b = (f(0) - sum_a N_a f(s_a)) n with the fit f and the face's nodes s_a.

   Held offsets are vectors that stand still in a solve. They are extrapolated over the step and taken again when lists
   are made. On rigid tools and with small kinematics they are taken once, in the reference position. Live offsets are
   fixed combinations of the nodes that the fit sees, with the coefficients of the reference position. They move with
   the nodes, within a solve too, and are part of the points' variations. The offsets of a rigid tool move with the tool
   and are always held ones.

   OffsetsCreate() makes offsets of 0, and OffsetsWant() leaves out faces that no search will see. OffsetsChoose() says
   whether that is of any use. OffsetsExtrapolate() is called at the beginning of a step and OffsetsTake() when lists
   are made anew, and OffsetsDamp() where these replace those of the solve; OffsetsTakePart() takes back some of that.
   OffsetsGet(), OffsetsTouched() and OffsetsMaps() give the result to the search, and OffsetsArchive() writes or reads
   the state of the extrapolation. */
#pragma once
#include "files/archive.h"
#include "search/facemap.h"
#include "search/search.h"

typedef struct _n_Offsets *Offsets;

/* Kinds of offsets: none at all, held ones, live ones. */
typedef enum { OFFSETS_NONE, OFFSETS_HELD, OFFSETS_LIVE } OffsetsKind;

PetscErrorCode   OffsetsCreate(Mesh, Scene, Loads, ContactSurface, int n_images, const SurfaceImage *,
                               PetscReal feature_angle, int finer, OffsetsKind, Offsets *);
PetscErrorCode   OffsetsDestroy(Offsets *);
PetscErrorCode   OffsetsLend(Offsets lender, Offsets, PetscBool *alike);
PetscBool        OffsetsChoose(Offsets);
PetscBool        OffsetsBlank(Offsets);
PetscErrorCode   OffsetsWant(Offsets, const PetscBool *wanted, PetscBool anew);
PetscErrorCode   OffsetsExtrapolate(Offsets, const PetscReal *u, PetscReal t, PetscReal t_next);
PetscErrorCode   OffsetsTake(Offsets, const PetscReal *u, PetscReal t);
PetscErrorCode   OffsetsDamp(Offsets, PetscBool *changed);
void             OffsetsTakePart(Offsets, PetscReal part);
PetscErrorCode   OffsetsArchive(Offsets, Archive, const char *name);
PetscErrorCode   OffsetsArchiveStaying(Offsets, Archive, const char *name);
const PetscReal *OffsetsGet(Offsets);
const PetscBool *OffsetsTouched(Offsets);
const FaceMaps  *OffsetsMaps(Offsets);
