/* A viscous restraint of all bodies, for pseudo-time steps of a solve that static steps have failed at.

   In a pseudo-time step from the anchor a to x it has the force scale * V (x - a). V is a node's part of the volume of
   the bodies, so that the restraint does not depend on the mesh, and scale is the viscosity per volume over the length
   of the pseudo-time step. DampingSet() chooses the scale, 0 for none; DampingAnchor() moves the anchor to a state. All
   functions but DampingCreate() accept NULL for no damping. */
#pragma once
#include "mesh/mesh.h"
#include "scene/scene.h"

typedef struct _n_Damping *Damping;

PetscErrorCode DampingCreate(Mesh, Scene, Vec like, Damping *);
PetscErrorCode DampingDestroy(Damping *);
PetscErrorCode DampingAnchor(Damping, Vec x);
PetscErrorCode DampingReturn(Damping, Vec x);
void           DampingSet(Damping, PetscReal scale);
PetscBool      DampingChanged(Damping);
PetscErrorCode DampingMean(Damping, Vec diagonal, PetscReal *scale);
PetscErrorCode DampingResidual(Damping, Vec x, Vec F);
PetscErrorCode DampingEnergy(Damping, Vec x, PetscReal *energy);
PetscErrorCode DampingTangent(Damping, Mat A);
PetscErrorCode DampingLoad(Damping, Vec x, PetscReal *force, PetscReal *work);
