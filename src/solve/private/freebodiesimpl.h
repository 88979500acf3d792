/* What the files of the free bodies share: freebodies.c finds them, bodymotions.c moves them, loosemotions.c finds the
   motions that nothing holds, bodyties.c ties some of these, and rigidsearch.c moves bodies into contact.

   Coordinates a[n] of all free motions together describe how the bodies move: those of a piece times its motions are a
   motion of six numbers (rigidkernel.h), in units of the piece's size. A rotation turns a body about its middle, where
   it is now, as far as its translations are free: FreeBodiesCentre() comes before all others. */
#pragma once
#include "solve/freebodies.h"

/* A contact holds a motion if its stiffness along it is above this part of its stiffness along any. Its root is the
   slope that the faces of a coarse round surface leave to a rotation about its own axis. */
#define FREE_BODIES_HELD 1e-3
/* A load that acts along a motion with less than this part of its amount does so because of the unevenness of meshes.
   It is a slope, the root of FREE_BODIES_HELD. */
#define FREE_BODIES_UNEVEN 3e-2

/* Characters of what FreeBodiesMoved() says. */
enum { FREE_BODIES_TEXT = 1000 };

/* A motion that contact has come to hold, one that was never tied or is loose again, one that is tied, one that is tied
   firmly because it is unstable. */
typedef enum { MOTION_CONTACT = -1, MOTION_PLAIN, MOTION_TIED, MOTION_FIRM } MotionState;

typedef double RigidMotion[RIGID_MODES];

struct _n_FreeBodies {
  Mesh             mesh;
  Scene            scene;
  Loads            loads;
  Contact          contact;
  FreeModes        modes; /* borrowed */
  PetscInt         n_pieces;
  const FreePiece *pieces;
  const PetscInt  *piece;      /* of each local node */
  PetscBool       *stabilised; /* n_pieces */
  int              n, *owner;  /* free motions of the stabilised pieces, and their pieces */
  RigidMotion     *motion;     /* n */
  PetscReal       *weight;     /* n_nodes: volume of this rank's cells at the node */
  PetscReal       *stiffness;  /* n_pieces: of the elements below one slave node (force per length) */
  PetscInt        *cell;       /* n_pieces: local cell at the middle of the piece, or -1 */
  PetscReal       *carried;    /* n_pieces: sum of the forces in its contacts, where ContactGram() saw these last */
  PetscReal        face;       /* size of the slaves' faces, the largest mean of a pair (length) */
  PetscInt        *state;      /* n: what holds each motion in the accepted state, a MotionState */
  char             moved[FREE_BODIES_TEXT];
};

/* bodymotions.c */
PetscErrorCode FreeBodiesCentre(FreeBodies, const PetscReal *u);
void           FreeBodiesRow(FreeBodies, PetscInt node, const PetscReal *u, int d, int first, int m, double row[]);
void           FreeBodiesPieceMotion(FreeBodies, PetscInt piece, const double a[], double q[RIGID_MODES]);
void           FreeBodiesVelocity(FreeBodies, const PetscReal *u, const double a[], PetscReal *du);
void           FreeBodiesMove(FreeBodies, const double a[], PetscReal *u);
PetscErrorCode FreeBodiesGram(FreeBodies, const PetscReal *u, double gram[]);
PetscErrorCode FreeBodiesForce(FreeBodies, const PetscReal *u, PetscReal t, double force[], double scale[]);
PetscErrorCode FreeBodiesLongest(FreeBodies, const PetscReal *u, const double a[], PetscReal *longest);
PetscErrorCode FreeBodiesMeanMotion(FreeBodies, const PetscReal *u, Vec x, int k, PetscReal *mean);
PetscBool      FreeBodiesTurns(FreeBodies, int k);
/* loosemotions.c */
PetscErrorCode FreeBodiesRub(FreeBodies, const PetscReal *u, PetscReal t, PetscReal factor, double gram[]);
PetscErrorCode FreeBodiesContactGram(FreeBodies, const PetscReal *u, PetscReal t, PetscBool touching, double gram[]);
PetscErrorCode FreeBodiesBasis(FreeBodies, const double gram[], PetscReal part, int *m, double free[], int pivot[]);
PetscErrorCode FreeBodiesDriven(FreeBodies, const PetscReal *u, PetscReal t, PetscReal part, int m, const double free[],
                                PetscBool driven[]);
PetscBool      FreeBodiesInContact(FreeBodies, PetscInt piece, const double gram[]);
PetscErrorCode FreeBodiesFall(FreeBodies, const PetscReal *u, PetscReal t, PetscReal t_loads, PetscReal part,
                              PetscBool *falls);
