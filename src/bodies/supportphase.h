/* Supports that hold in some steps with names only: which step it is, where they hold, and what those that have left
   still carry.

   A phase is a step with a name. The unknowns of a phase are the dofs that are free in it; LoadsCreate() builds the
   rules of a phase. SupportPhaseTake() notes where a dof is when a support takes hold of it, and the forces of supports
   that leave. These fade evenly over the phase, so that equilibrium changes continuously: SupportPhaseForces(). A scene
   whose supports all hold all the time has no such object, and every function takes NULL for it. */
#pragma once
#include "files/archive.h"
#include "mesh/mesh.h"

typedef struct _n_SupportPhase *SupportPhase;

PetscErrorCode SupportPhaseCreate(Mesh, Scene, PetscInt phase, SupportPhase *);
PetscErrorCode SupportPhaseDestroy(SupportPhase *);
PetscInt       SupportPhaseNumber(SupportPhase);
PetscReal      SupportPhasePlace(SupportPhase, PetscInt local_dof);
PetscErrorCode SupportPhaseTake(SupportPhase, PetscInt phase, const PetscBool *comes, const PetscReal *u,
                                const PetscBool *leaves, const PetscReal *force);
void           SupportPhaseForces(SupportPhase, PetscReal t, const PetscReal *u, PetscReal *f, PetscReal *energy,
                                  PetscReal *force2);
PetscReal      SupportPhaseForce(SupportPhase, PetscInt local_dof);
PetscErrorCode SupportPhaseArchive(SupportPhase, Archive);
