/* Weak springs that hold bodies which contact alone is to hold, until it does.

   They join nodes to where these were. ContactSpringsRelax() moves the anchors to a state, in which the springs then
   have no force. The owner gives the stiffness of each; freebodies.h decides which bodies have springs and how stiff
   they are. All functions but the first accept NULL for no springs. */
#pragma once
#include "mesh/mesh.h"

typedef struct _n_Stabiliser *ContactSprings;

PetscErrorCode ContactSpringsCreate(Mesh, const PetscReal *stiffness, Vec like, ContactSprings *);
PetscErrorCode ContactSpringsDestroy(ContactSprings *);
PetscErrorCode ContactSpringsRelax(ContactSprings, Vec x);
PetscErrorCode ContactSpringsResidual(ContactSprings, Vec x, Vec F);
PetscErrorCode ContactSpringsEnergy(ContactSprings, Vec x, PetscReal *energy);
PetscErrorCode ContactSpringsTangent(ContactSprings, Mat A);
PetscErrorCode ContactSpringsLoad(ContactSprings, Vec x, PetscReal *force, PetscReal *energy);
