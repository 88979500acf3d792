/* Bodies that supports leave free to move and that contact is to hold: which they are, the rigid search that moves them
   into contact before anything is solved, the springs that hold what contact does not, and their names in messages.

   FreeBodiesCreate() gives NULL where a scene has none; nothing else is called then. FreeBodiesSettle() moves them
   along their loads until they rest on what is in their way, without any force. FreeBodiesTie() ties motions
   that neither contact nor a load acts along, and FreeBodiesRelease() releases those that contact has come to hold.
   FreeBodiesLoose() names the motions that contact does not hold in the present state. */
#pragma once
#include <petscksp.h>
#include "bodies/freemodes.h"
#include "contact/contact.h"
#include "contact/contactsprings.h"
#include "files/archive.h"

typedef enum { SETTLE_NONE, SETTLE_MOVED, SETTLE_ADRIFT } SettleResult;

typedef struct _n_FreeBodies *FreeBodies;

PetscErrorCode FreeBodiesCreate(Mesh, Scene, Loads, Contact, FreeModes, FreeBodies *);
PetscErrorCode FreeBodiesDestroy(FreeBodies *);
PetscErrorCode FreeBodiesSprings(FreeBodies, Vec like, ContactSprings *);
PetscErrorCode FreeBodiesSettle(FreeBodies, PetscReal t, PetscReal t_loads, PetscBool first, PetscReal *u,
                                SettleResult *);
PetscErrorCode FreeBodiesTie(FreeBodies, const PetscReal *u, PetscReal t, PetscReal t_loads, PetscBool begins,
                             PetscBool touching, ContactSprings, PetscBool *changed);
PetscErrorCode FreeBodiesRelease(FreeBodies, const PetscReal *u, PetscReal scale, KSP, ContactSprings, PetscBool *any,
                                 PetscReal *unstable);
PetscErrorCode FreeBodiesAccept(FreeBodies, ContactSprings);
PetscErrorCode FreeBodiesArchive(FreeBodies, Archive);
PetscErrorCode FreeBodiesLoose(FreeBodies, const PetscReal *u, PetscReal t, PetscBool driven, size_t size, char *text);
PetscErrorCode FreeBodiesDrivenOut(FreeBodies, const PetscReal *u, PetscReal t, PetscReal t_loads, PetscBool touching,
                                   size_t size, char *text);
const char    *FreeBodiesMoved(FreeBodies);
