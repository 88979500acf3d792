/* Weak springs that hold bodies which contact alone is to hold, until it does, and ties that hold what no contact does.

   Springs join dofs to where these were, see dofsprings.h. A tie holds one rigid motion of a body and resists no other:
   it measures the motion of a few nodes, those of one cell. ContactSpringsRelax() moves the anchors to a state, in
   which springs and ties then have no force, and ContactSpringsSlacken() those of the springs alone. The owner gives
   the stiffness of each; freebodies.h decides which bodies have them and how stiff they are. All functions but those
   that create accept NULL for no springs. */
#pragma once
#include "bodies/dofsprings.h"

/* stretch = sum value * (displacement of the dof less that of its anchor), and what ContactSpringsSlacken() has kept */
typedef struct {
  int       motion;                        /* which one it holds: a number of the owner */
  PetscBool released;                      /* it has no force for the time being */
  PetscBool unstable;                      /* without it the motion would go on by itself */
  PetscReal stiffness;                     /* force per length */
  PetscInt  n, dof[ELEMENT_MAX_NODES * 3]; /* global free dofs */
  PetscReal value[ELEMENT_MAX_NODES * 3];
} SpringTie;

typedef struct _n_Stabiliser *ContactSprings;

PetscErrorCode ContactSpringsCreate(Mesh, const PetscReal *stiffness, Vec like, ContactSprings *);
PetscErrorCode ContactSpringsDestroy(ContactSprings *);
PetscErrorCode ContactSpringsSetTies(ContactSprings, PetscInt n, const SpringTie *);
PetscErrorCode ContactSpringsRelease(ContactSprings, int n, const int *kept, PetscBool *any);
PetscErrorCode ContactSpringsMark(ContactSprings, int motion, PetscBool unstable);
PetscErrorCode ContactSpringsRetie(ContactSprings, PetscBool *any);
void           ContactSpringsGetTie(ContactSprings, int motion, const SpringTie **, PetscReal *force);
PetscBool      ContactSpringsHaveTie(ContactSprings, int motion);
PetscErrorCode ContactSpringsRelax(ContactSprings, Vec x);
PetscErrorCode ContactSpringsSlacken(ContactSprings, Vec x);
PetscErrorCode ContactSpringsResidual(ContactSprings, Vec x, Vec F);
PetscErrorCode ContactSpringsEnergy(ContactSprings, Vec x, PetscReal *energy);
PetscErrorCode ContactSpringsTangent(ContactSprings, Mat A);
PetscErrorCode ContactSpringsLoad(ContactSprings, Vec x, PetscReal *force, PetscReal *tied, PetscReal *energy);
