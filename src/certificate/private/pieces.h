/* The two sides of a contact pair for the certificate: the pieces of their faces, the points and edges of these at the
   two ends of a step, and the way of pieces to the ranks that they come near.

   SideCreate() finds pieces, points and edges once, SideMove() places them at the two states, SideMeasure() finds
   their normals. SideShare() sends pieces to every rank whose points they may meet. */
#pragma once
#include "bodies/loads.h"
#include "bodies/tools.h"
#include "certificate/sweep.h"
#include "search/facemarks.h"
#include "search/surface.h"

/* Largest tip that explains a depth: a right angle. What is sharper is a needle, which the points around it miss. */
#define PIECE_TIP 1.0

/* Lower, then upper corner */
typedef PetscReal Box[6];

/* A piece of a face. Where it is an image, all of it is reflected. */
typedef struct {
  Place     X[3], x[2][3], normal[2]; /* vertices: reference, and at the two states; unit normals */
  Box       box;                      /* that it sweeps */
  long      tag[3], face;             /* gmsh's tags of nodes and face */
  double    size, height;             /* of its face, of the element below it (0: none) (length) */
  double    sagitta;                  /* PieceHeight() at the end (length) */
  double    side;                     /* its longest side at the end (length) */
  int       order;                    /* of its face, which is about as many pieces wide */
  double    tip[3];                   /* of its vertices */
  Place     across[3];                /* in space: unit normal across each edge at the end; its own where it ends */
  FaceMarks marks;                    /* pairs by name that treat its face, see facemarks.h */
  int       body;                     /* in the scene; bodies of tools have no cells */
  int       closed;                   /* contact pressed at one of its vertices */
} Piece;

/* A vertex of pieces */
typedef struct {
  Place     X, x[2], normal[2]; /* reference, the two states, and directions of the surface there, of any length */
  Place     ridge;              /* direction at the end, with each normal around weighted by its angle there */
  Place     turns, ridge_turns; /* of a tool: these directions in the reference state */
  long      tag;
  double    size, height; /* means of the faces around (length) */
  FaceMarks marks;        /* of all faces around */
  int       body;
  int       closed;       /* contact pressed there at one of the states */
  int       inside;       /* it stands in the other side at the end, PointFinding() */
  double    number;       /* of the pieces around, without images */
  int       reflected[3]; /* axes across which planes of symmetry reflect the surface there */
  double    side;         /* mean of their longest sides at the end (length) */
  int       order;        /* of their faces */
  double    tip; /* height of the edge there over a chord between its flanks, over half the chord: tan(turn/2) */
} Point;

/* An edge of pieces. In the plane it is the piece itself. */
typedef struct {
  const Point *end[2];
  const Piece *of[2];  /* around it on this rank; the second is NULL where there is one */
  int          number; /* of the edge in the first of these */
} Edge;

typedef struct {
  ContactSurface surface;
  Loads          loads;
  int            dim;
  PetscInt       n_points, *node; /* local nodes of the mesh or of the tool */
  Point         *points;
  PetscInt       n_pieces, *corner; /* corner: 3 points of each piece */
  Piece         *pieces;            /* of this rank's faces; of a tool an equal part on each rank */
  PetscInt       n_edges;
  Edge          *edges;
} *Side;

/* Pieces at hand; `room` for so many has been allocated */
typedef struct {
  PetscInt n, room;
  Piece   *pieces;
} PieceList;

PetscErrorCode SideCreate(ContactSurface, Loads, int n_mirrors, const SurfaceImage *, Side *);
PetscErrorCode SideDestroy(Side *);
PetscErrorCode SideMove(Side, const PetscReal *const u[2], const PetscReal t[2]);
PetscErrorCode SideMeasure(Side, const PetscReal *closed);
PetscErrorCode SideEdges(Side);
void           SideBox(Side, Box);

void           PiecePlace(Piece *, int dim);
void           BoxJoin(MPI_Comm, Box);
PetscBool      BoxesMeet(const Box a, const Box b, PetscReal distance);
void           BoxAround(int n, const Place x[], Box);
PetscErrorCode SideShare(Side, const Box near, int n_images, const SurfaceImage *, PieceList *);
