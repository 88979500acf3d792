/* The two sides of a contact pair for the certificate: the pieces of their faces and the points of these at the two
   ends of a step, and the way of pieces to the ranks that they come near.

   SideCreate() finds pieces and points once, SideMove() places them at the two states. SideShare() sends pieces to
   every rank whose points they may meet. */
#pragma once
#include "bodies/loads.h"
#include "bodies/tools.h"
#include "certificate/sweep.h"
#include "search/surface.h"

/* A piece of a face. Where it is an image, all of it is reflected. */
typedef struct {
  Place  X[3], x[2][3];         /* vertices: reference, and at the two states */
  long   tag[3], face;          /* gmsh's tags of nodes and face */
  double size, height, sagitta; /* of its face, of the element below it (0: none), PieceHeight() at the end (length) */
  int    body;                  /* in the scene; bodies of tools have no cells */
  int    closed;                /* contact pressed at one of its vertices */
  int    seen;                  /* besides, an edge there is sharp, which a smooth surface rounds */
} Piece;

/* A vertex of pieces */
typedef struct {
  Place  X, x[2], normal[2]; /* reference, the two states, and directions of the surface there, of any length */
  long   tag;
  double size, height; /* means of the faces around (length) */
  int    body;
  int    closed; /* contact pressed there at one of the states */
  int    seen;   /* besides, an edge there is sharp, which a smooth surface rounds */
  double weight; /* sizes of the pieces around together (length) */
} Point;

typedef struct {
  ContactSurface surface;
  Loads          loads;
  int            dim;
  PetscInt       n_points, *node; /* local nodes of the mesh or of the tool */
  Point         *points;
  PetscInt       n_pieces, *corner; /* corner: 3 points of each piece */
  Piece         *pieces;            /* of this rank's faces; of a tool an equal part on each rank */
} *Side;

/* Pieces at hand */
typedef struct {
  PetscInt n;
  Piece   *pieces;
} PieceList;

PetscErrorCode SideCreate(ContactSurface, Loads, Side *);
PetscErrorCode SideDestroy(Side *);
PetscErrorCode SideMove(Side, const PetscReal *const u[2], const PetscReal t[2], const PetscReal *closed);
void           SideBox(Side, PetscReal box[6]);
void           BoxJoin(MPI_Comm, PetscReal box[6]);
PetscBool      BoxesMeet(const PetscReal a[6], const PetscReal b[6], PetscReal distance);
void           PieceBox(const Piece *, int dim, PetscReal box[6]);
PetscErrorCode SideShare(Side, const PetscReal near[6], int n_images, const SurfaceImage *, PieceList *);
