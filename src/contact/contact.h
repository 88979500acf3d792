/* Contact pairs: search, smoother and law behind residual, tangent and energy of contact. The only holder of contact
   state.

   A contact term belongs to a slave node, with its area, penalty, status and offset, and sums over the node's slave
   points. Node to surface: the node itself. Surface to surface: quadrature points of the faces around it. A slave point
   is a map from nodes with fixed weights, plus an offset. It is measured against a list of fit points and facets
   (search.h). The rank that owns a slave node computes its terms; masters come from any rank.

   Lists are frozen inside one solve. ContactGather() makes them before it, ContactResidual() and ContactTangent() are
   called in it, and ContactListsHold() says after it whether the lists were right. ContactAccept() ends a step that was
   successful, ContactRestore() one that was not. The other functions serve the prediction of a step, the control of its
   length, penalties, probes and reports. */
#pragma once
#include "linear/borderedfactor.h"
#include "contact/contactstate.h"
#include "bodies/loads.h"
#include "mesh/mesh.h"
#include "search/nodedepth.h"
#include "contact/touchstep.h"

/* What the slave nodes of a pair on this rank show to probes and output. */
typedef struct {
  PetscInt         n;
  const PetscInt  *node;          /* local node */
  const PetscReal *area;          /* reference tributary area (axisymmetric: 2 pi R) */
  const PetscReal *gap, *penalty; /* length; force per length and area */
  const PetscReal *force;         /* normal force */
  const PetscReal *pressure;      /* normal force over present tributary area */
  const PetscReal *normal;        /* n*3, out of the master; 0 where no master is near */
  /* With friction, else NULL: n*3 the traction on the slave in the tangent plane, friction force over present tributary
     area; the length that the node has slipped so far; 0 open, 1 sticking, 2 slipping. */
  const PetscReal *traction, *slid, *friction;
} ContactNodes;

/* All pairs together, in the present state. */
typedef struct {
  PetscInt  nodes;                  /* closed slave nodes; where faces press between open nodes, these faces */
  PetscInt  in, out;                /* nodes that closed and that opened since the accepted state */
  PetscReal max_penetration;        /* length */
  PetscReal min_penetration;        /* over nodes whose force is above 1e-3 of the largest nodal force (length) */
  PetscReal max_penetration_over_h; /* h: face size at the node */
  PetscReal penalty_min, penalty_max;
  PetscReal force;          /* norm of the total force on the slaves */
  PetscReal dissipated;     /* energy that friction has taken so far; NaN: no pair has friction */
  PetscInt  outside_window; /* nodes outside the window of their penalty; -1: no pair has a window */
} ContactSummary;

/* How the penetrations of a pair relate to the window of its penalty, and what was done for it. Of an augmented pair
   the window is g_max on either side of the master, and it binds every node in contact. */
typedef struct {
  PetscInt  loaded;                   /* nodes that the window binds: force above 1e-3 of the largest nodal force */
  PetscInt  outside;                  /* of these and of lighter nodes beyond g_max: the nodes outside the window */
  PetscReal excess;                   /* largest penetration over g_max */
  PetscInt  raised, lowered, clamped; /* updates of penalties in accepted steps so far */
  PetscInt  light;                    /* updates that were left out because the node is not loaded */
  PetscInt  augmented;                /* times that pressures became multipliers */
  PetscInt  missed;                   /* steps that ended beyond g_max after all updates */
} ContactWindow;

typedef enum { WINDOW_HOLDS, WINDOW_MISSED, WINDOW_AT_BOUND } ContactWindowState;

/* How the fits of a pair turned out, over all slave points near the master. */
typedef struct {
  PetscInt points;                                 /* slave points near the master */
  PetscInt plain, wider, degree_2, linear, facets; /* of these, by rung of the ladder of fall-backs */
  PetscInt within, within_low; /* points not beyond a free edge of the master; of these, without a fit of full degree on
                                  a surface that is not flat */
  PetscInt  neighbours_min, neighbours_max;
  PetscReal neighbours_mean;
  PetscReal pivot, amplified; /* worst guards: smallest pivot, largest sum of absolute shape values */
  PetscReal smoothing_error;  /* largest distance of a master node near the foot to the fit (length) */
  PetscReal facet_error;      /* largest distance between facets and fit at a slave point (length) */
  PetscReal apart_over_h;     /* the same where the facets are within a face of the slave, over the size of that */
} ContactFits;

/* A slave node in a message: gmsh's tag and reference coordinates. */
typedef struct {
  PetscInt  tag;
  PetscReal X[3];
} ContactPlace;

/* How the surfaces of a pair lie before any load. What is below round-off is 0. */
typedef struct {
  PetscInt     nodes, near; /* slave nodes, those with a master near */
  PetscInt     overlapping; /* of the near ones */
  PetscInt     refused;     /* of the overlapping ones, those deeper than the facets' own shape explains */
  PetscReal    least, most; /* gaps (length) */
  PetscReal    area;        /* of the overlapping nodes */
  ContactPlace deepest;
} ContactGaps;

/* How well the surfaces of a pair are kept apart. */
typedef struct {
  PetscInt  nodes; /* in contact; faces where only faces press */
  PetscBool faces; /* only faces press */
  PetscReal max_penetration, max_penetration_over_h;
  PetscReal sagitta; /* of first-order facets of the master over the curved surface that they stand for: the mean over
                        the slave points near it (length) */
  PetscInt     near, averse; /* slave points near the master; of these, those that do not face it and take no part */
  PetscInt     hanging;      /* slave points past a free edge of the master that are deep and hardly take part */
  PetscInt     edges;        /* points on sharp edges of a rigid master that press, which count as nodes, too */
  PetscInt     turned;       /* faces of a rigid master whose normals were turned to the slave */
  ContactPlace deepest;      /* where the largest penetration is */
} ContactQuality;

/* Where bodies give way in contact: what the error of the penalty comes from. */
typedef enum { BY_PENETRATION, BY_SLIP, PENALTY_SOURCES } PenaltySource;

/* How a pair presses, over all its slave nodes. */
typedef struct {
  PetscReal force;       /* sum of the normal forces; axisymmetric: over 360 degrees */
  PetscReal pressure;    /* mean, each node weighted by its force (force per area) */
  PetscReal peak;        /* largest pressure of a node */
  PetscReal friction[3]; /* sum of the forces by friction */
  PetscReal rubs; /* amount of that sum; of two pairs that treat two surfaces from either side, of both amounts */
} ContactLoad;

/* What friction does in a pair, over all its slave nodes. */
typedef struct {
  PetscReal force[3];  /* on the slave; axisymmetric: over 360 degrees */
  PetscReal moment[3]; /* on the master, about the origin of the scene; in the plane the third one alone */
  PetscInt  sticking, slipping;
  PetscInt  footless; /* of these, nodes with points from which no line along the normal meets the master */
  PetscReal sticking_area, slipped_area; /* reference areas of the sticking and the slipping nodes */
  PetscReal elastic;                     /* largest elastic slip (length) */
  PetscReal slid;                        /* longest slip of a node so far, without the elastic one (length) */
  PetscReal dissipated;                  /* energy that friction has taken so far */
  PetscReal turned;                      /* part of it at nodes whose slip turned much within a step */
  PetscReal travel;                      /* largest travel along the slave in a step so far, see ContactTravel() */
} ContactFriction;

/* The surfaces of a pair. */
typedef struct {
  const SceneContact *scene;
  ContactSurface      slave, master; /* master NULL: analytic, in scene */
  int                 n_images;      /* mirror images of the master that it may meet besides, the identity included */
  const SurfaceImage *images;
  int                 n_mirrors; /* images as which both surfaces go on, the identity included */
  const SurfaceImage *mirrors;
} ContactSides;

typedef struct _n_Contact *Contact;

/* Life and state */
PetscErrorCode ContactCreate(Mesh, Scene, Elasticity, Loads, Contact *);
PetscErrorCode ContactDestroy(Contact *);
PetscErrorCode ContactAccept(Contact);
PetscErrorCode ContactRestore(Contact);
PetscErrorCode ContactTangentRestore(Contact);
PetscErrorCode ContactArchive(Contact, Archive, const PetscReal *u, PetscReal t);
PetscErrorCode ContactFollow(Contact, Contact leader, PetscBool *same);
/* Lists */
PetscReal      ContactMotionAtHand(Contact, PetscReal least, PetscReal motion);
PetscErrorCode ContactGather(Contact, const PetscReal *u, PetscReal t, PetscReal t_next, PetscReal motion);
PetscErrorCode ContactListsReach(Contact, PetscBool *within);
PetscErrorCode ContactListsRenew(Contact, const PetscReal *u, PetscReal t, PetscReal motion);
PetscErrorCode ContactListsHold(Contact, const PetscReal *u, PetscReal t, PetscReal motion, PetscReal next,
                                PetscReal lag, PetscBool passing, PetscBool *hold);
PetscErrorCode ContactTakeOffsetsPart(Contact, PetscReal part, PetscBool *any);
void           ContactForgetLost(Contact);
void           ContactWatchOuter(Contact, PetscReal *outer);
PetscErrorCode ContactLocateLost(Contact, PetscBool *lost, char *text, size_t size);
/* Residual */
PetscErrorCode ContactResidual(Contact, const PetscReal *u, PetscReal t, PetscReal *f, PetscReal *energy,
                               PetscReal *force2);
PetscErrorCode ContactRoundOff(Contact, PetscReal *force);
/* Work from outside and energy in contact */
const Motion  *ContactPairMotion(Contact, int pair);
void           ContactWatchTools(Contact, PetscReal *hold);
PetscErrorCode ContactStored(Contact, PetscReal t_0, const PetscReal *du, PetscBool moved, PetscReal *stored,
                             PetscReal *given);
/* Tangent */
PetscErrorCode ContactKeepFactors(Contact);
void           ContactForgetForeseen(Contact);
PetscErrorCode ContactTangent(Contact, const PetscReal *u, PetscReal t, Mat *C, PetscBool *changed);
PetscErrorCode ContactTangentChanges(Contact, PetscInt *terms);
PetscErrorCode ContactChangeVectors(Contact, PetscInt rows, PetscInt terms, PetscReal *s, Mat *N);
PetscErrorCode ContactGetBorder(Contact, Border *);
PetscBool      ContactHasFits(Contact);
PetscErrorCode ContactMultiplyBegin(Contact, const PetscReal *x, PetscReal t, PetscReal t_next);
PetscErrorCode ContactMultiplyTransposed(Contact, const PetscBool pairs[], const PetscReal *x);
PetscErrorCode ContactMultiplyEnd(Contact, PetscReal *y);
/* Linear steps and predictions */
PetscErrorCode ContactHoldActiveSet(Contact, PetscBool holding, PetscBool touching);
PetscErrorCode ContactHoldSolved(Contact, PetscBool again);
PetscErrorCode ContactHoldExpected(Contact, PetscBool last, PetscBool *any);
PetscErrorCode ContactDropExpected(Contact);
PetscErrorCode ContactMarkPredicted(Contact);
PetscErrorCode ContactPredictionMissed(Contact, PetscBool *missed);
PetscErrorCode ContactUnpredictedEnergy(Contact, const PetscReal *u, PetscReal t, PetscReal *energy);
/* Penalties and multipliers */
PetscErrorCode ContactSoften(Contact, PetscReal most, PetscBool all);
PetscErrorCode ContactStiffest(Contact, PetscReal *most);
PetscErrorCode ContactPairDepth(Contact, int pair, PetscReal *over_h);
PetscErrorCode ContactStiffen(Contact, int pair, PetscReal factor);
PetscErrorCode ContactStiffenStick(Contact, int pair, PetscReal factor);
PetscReal      ContactPairInitialPenalty(Contact, int pair);
PetscReal      ContactPairStick(Contact, int pair);
PetscErrorCode ContactPairFriction(Contact, int pair, ContactFriction *);
PetscErrorCode ContactTravel(Contact, PetscReal *travel);
PetscErrorCode ContactPairLoad(Contact, int pair, const PetscReal *u, ContactLoad *);
PetscErrorCode ContactStifferForces(Contact, PenaltySource, PetscReal *f);
PetscErrorCode ContactPairStifferForces(Contact, int pair, PenaltySource, PetscReal *f);
PetscErrorCode ContactPairShapeForces(Contact, int pair, const PetscReal *u, PetscReal *f, PetscBool *known);
PetscErrorCode ContactPairWithinFaces(Contact, int pair, const PetscReal *u, int n, PetscReal *const y[],
                                      PetscReal error[], PetscBool *known);
PetscErrorCode ContactLoadChanges(Contact, PenaltySource, const PetscReal *u, const PetscReal *v, ContactLoad change[]);
PetscErrorCode ContactAdjustPenalty(Contact, ContactWindowState *);
PetscErrorCode ContactAdjustNextPenalty(Contact);
PetscErrorCode ContactGapsConverged(Contact, PetscBool *converged);
PetscErrorCode ContactLocateOutside(Contact, char *text, size_t size);
PetscErrorCode ContactPairWindow(Contact, int pair, ContactWindow *);
PetscErrorCode ContactPairPenalty(Contact, int pair, PetscReal *least, PetscReal *most);
/* Fluid between the surfaces */
PetscErrorCode ContactSetCarried(Contact, int pair, const PetscReal *carried, const PetscReal *dry);
PetscErrorCode ContactDryReactions(Contact, int pair, PetscReal *reaction);
PetscErrorCode ContactTermForces(Contact, int pair, PetscReal touch, PetscReal *force);
/* Control of the load step */
PetscErrorCode ContactTouches(Contact, const PetscReal *u_0, PetscReal t_0, const PetscReal *u, PetscReal t,
                              PetscBool by_area, PetscBool still_open, int *n, Touch **);
PetscErrorCode ContactChanges(Contact, PetscReal t_0, PetscBool by_area, PetscReal *changed, PetscReal *all);
/* Pairs */
int                 ContactPairs(Contact);
const char         *ContactPairName(Contact, int pair);
const SceneContact *ContactPairScene(Contact, int pair);
int                 ContactFindPair(Contact, const char *name);
int                 ContactPairPartner(Contact, int pair);
PetscBool           ContactPairIsSurface(Contact, int pair);
int                 ContactPairFiner(Contact, int pair);
PetscErrorCode      ContactPairText(Contact, int pair, char *text, size_t size);
PetscErrorCode      ContactPatchAreas(Contact, int pair, const PetscReal middle[3], PetscReal radius, PetscReal *area);
PetscErrorCode      ContactPairSurface(Contact, int pair, const MeshGroup **slave, PetscReal *mean_face_size);
PetscBool           ContactPairToolMoves(Contact, int pair);
PetscErrorCode      ContactPairTermStiffness(Contact, int pair, PetscReal *stiffness);
PetscErrorCode      ContactPairApart(Contact, int pair, PetscBool *apart);
PetscErrorCode      ContactPairClosed(Contact, int pair, const PetscInt *label, PetscInt n, PetscInt *closed);
PetscBool           ContactOffsetsLag(Contact);
void                ContactFitAll(Contact);
PetscBool           ContactHasFriction(Contact);
MPI_Comm            ContactComm(Contact);
/* What an accepted step is checked for */
void           ContactPairSides(Contact, int pair, ContactSides *);
PetscErrorCode ContactPairPressed(Contact, int pair, PetscReal *pressed);
PetscErrorCode ContactPairOverlap(Contact, int pair, PetscReal t, PetscReal *overlap);
/* Probes and reports */
PetscErrorCode ContactSummarise(Contact, ContactSummary *);
PetscErrorCode ContactGetNodes(Contact, int pair, const PetscReal *u, ContactNodes *);
PetscErrorCode ContactMasterForce(Contact, int pair, PetscReal force[3]);
PetscErrorCode ContactMasterMoment(Contact, int pair, PetscReal moment[3]);
PetscErrorCode ContactGapAt(Contact, int pair, const PetscReal *u, PetscReal t, PetscInt node_id, PetscReal *gap);
PetscErrorCode ContactNearestPair(Contact, MPI_Comm, const PetscReal X[3], int *pair);
PetscReal      ContactNodeGap(Contact, PetscInt node);
PetscErrorCode ContactTakeOverlap(Contact);
PetscErrorCode ContactPairFits(Contact, int pair, ContactFits *);
PetscErrorCode ContactPairGeometry(Contact, int pair, PetscReal *ratio);
PetscErrorCode ContactPairGaps(Contact, int pair, ContactGaps *);
PetscErrorCode ContactPairQuality(Contact, int pair, ContactQuality *);
PetscErrorCode ContactPairScatter(Contact, int pair, const PetscReal *u, PetscReal *scatter);
PetscErrorCode ContactPairMasterDepth(Contact, int pair, const PetscReal *u, PetscReal t, NodeDepth *);
PetscErrorCode ContactPairDistance(Contact, int pair, const PetscReal *u, PetscReal t, PetscReal *distance);
PetscErrorCode ContactPairJoined(Contact, int pair, PetscInt *nodes, ContactPlace *);
