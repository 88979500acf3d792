/* What freebodies.c and rigidsearch.c share.

   Coordinates a[n] of all free motions together describe how the bodies move: those of a piece times its motions are a
   motion of six numbers (rigidkernel.h), in units of the piece's size. */
#pragma once
#include "solve/freebodies.h"

/* Characters of what FreeBodiesMoved() says. */
enum { FREE_BODIES_TEXT = 1000 };

/* A motion that was never tied or is loose again, one that is tied, one that contact has come to hold. */
typedef enum { MOTION_CONTACT = -1, MOTION_PLAIN, MOTION_TIED } MotionState;

struct _n_FreeBodies {
  Mesh             mesh;
  Scene            scene;
  Loads            loads;
  Contact          contact;
  FreeModes        modes;
  PetscInt         n_pieces;
  const FreePiece *pieces;
  const PetscInt  *piece;      /* of each local node */
  PetscBool       *stabilised; /* n_pieces */
  int              n, *owner;  /* free motions of the stabilised pieces, and their pieces */
  const double   **motion;     /* n: six numbers each */
  PetscReal       *weight;     /* n_nodes: volume of this rank's cells at the node */
  PetscReal       *stiffness;  /* n_pieces: of the elements below one slave node (force per length) */
  PetscInt        *cell;       /* n_pieces: local cell at the middle of the piece, or -1 */
  PetscReal        face;       /* size of the slaves' faces, the largest mean of a pair (length) */
  PetscInt        *state;      /* n: what holds each motion in the accepted state, a MotionState */
  char             moved[FREE_BODIES_TEXT];
};

void           FreeBodiesPieceMotion(FreeBodies, PetscInt piece, const double a[], double q[RIGID_MODES]);
void           FreeBodiesVelocity(FreeBodies, const PetscReal *u, const double a[], PetscReal *du);
void           FreeBodiesMove(FreeBodies, const double a[], PetscReal *u);
PetscErrorCode FreeBodiesGram(FreeBodies, const PetscReal *u, double gram[]);
PetscErrorCode FreeBodiesForce(FreeBodies, const PetscReal *u, PetscReal t, double force[], double scale[]);
PetscErrorCode FreeBodiesLongest(FreeBodies, const PetscReal *u, const double a[], PetscReal *longest);
PetscErrorCode FreeBodiesRub(FreeBodies, const PetscReal *u, PetscReal t, PetscReal factor, double gram[]);
PetscBool      FreeBodiesTurns(FreeBodies, int k);
PetscErrorCode FreeBodiesFall(FreeBodies, const PetscReal *u, PetscReal t, PetscReal t_loads, PetscReal part,
                              PetscBool *falls);
