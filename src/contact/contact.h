/* Contact pairs: search, smoother and law behind residual, tangent and energy; the only holder of contact state.

   A contact term belongs to a slave node (area, penalty, status, offset) and sums over its slave points (node to
   surface: the node itself). A slave point is a map from nodes (fixed weights, offset); what it is measured against is
   a list of fit points and facets (search.h). Lists are frozen inside one solve: ContactGather() makes them before it,
   ContactListsHold() says after it whether they were right. The rank that owns a slave node computes its terms; masters
   come from any rank. */
#pragma once
#include "linear/borderedfactor.h"
#include "contact/contactstate.h"
#include "bodies/loads.h"
#include "mesh/mesh.h"
#include "contact/touchstep.h"

/* What the slave nodes of a pair show to probes and output; this rank's. */
typedef struct {
  PetscInt         n;
  const PetscInt  *node; /* local node */
  const PetscReal *area; /* reference tributary area (axisymmetric: 2 pi R) */
  const PetscReal *gap, *penalty;
  const PetscReal *force;    /* normal force */
  const PetscReal *pressure; /* normal force over current tributary area */
  const PetscReal *normal;   /* n*3, out of the master; 0 where no master is near */
} ContactNodes;

typedef struct {
  PetscInt  nodes;                            /* closed slave nodes, all pairs */
  PetscInt  in, out;                          /* against the accepted state */
  PetscReal max_penetration, min_penetration; /* min: over nodes above 1e-3 of the largest nodal force */
  PetscReal max_penetration_over_h;
  PetscReal penalty_min, penalty_max;
  PetscReal force;          /* norm of the total force on the slaves */
  PetscInt  outside_window; /* nodes outside the window of their penalty; -1: no pair has one */
} ContactSummary;

/* How the penetrations of a pair stand to the window of its penalty, and what was done for it. Augmented: the window is
   g_max on either side of the master, and binds every node in contact */
typedef struct {
  PetscInt  loaded;                         /* nodes that the window binds: above 1e-3 of the largest nodal force */
  PetscInt  outside;                        /* of these, and of lighter ones beyond g_max, those outside */
  PetscReal excess;                         /* largest penetration over g_max */
  PetscInt raised, lowered, clamped, light; /* updates in accepted steps so far; light: spared as they are not loaded */
  PetscInt augmented,
    missed; /* times that pressures became multipliers; steps that ended beyond g_max after all updates */
} ContactWindow;

typedef enum { WINDOW_HOLDS, WINDOW_MISSED, WINDOW_AT_BOUND } ContactWindowState;

/* How the fits of a smooth master stand, all slave points near it */
typedef struct {
  PetscInt  points;                                 /* slave points near the master */
  PetscInt  plain, wider, degree_2, linear, facets; /* by rung of the ladder of fall-backs */
  PetscInt  neighbours_min, neighbours_max;
  PetscReal neighbours_mean;
  PetscReal pivot, amplified; /* worst guards */
  PetscReal smoothing_error;  /* largest distance of a master node near the foot to the fit (a length) */
  PetscReal facet_error;      /* largest distance between facets and fit at a slave point (a length) */
} ContactFits;

/* A slave node in a message: gmsh's tag and reference coordinates */
typedef struct {
  PetscInt  tag;
  PetscReal X[3];
} ContactPlace;

/* How the surfaces of a pair lie before any load; lengths and areas, what is below round-off is 0 */
typedef struct {
  PetscInt     nodes, near;          /* slave nodes, those with a master near */
  PetscInt     overlapping, refused; /* of the near ones; refused: deeper than the facets' own shape explains */
  PetscReal    least, most;          /* gaps */
  PetscReal    area;                 /* of the overlapping nodes */
  ContactPlace deepest;
} ContactGaps;

/* How well the surfaces of a pair are kept apart; lengths */
typedef struct {
  PetscInt  nodes; /* in contact */
  PetscReal max_penetration, max_penetration_over_h;
  PetscReal sagitta; /* of first-order facets of the master over the curved surface that they stand for, mean over the
                        slave points near it */
  ContactPlace deepest; /* where the largest penetration is */
} ContactQuality;

typedef struct _n_Contact *Contact;

PetscErrorCode ContactCreate(Mesh, Scene, Elasticity, Loads, Contact *);
PetscErrorCode ContactDestroy(Contact *);
/* New lists for the accepted state u at load parameter t, for a step to t_next, good for a relative motion of `motion`
 * (a length). Collective. */
PetscErrorCode ContactGather(Contact, const PetscReal *u, PetscReal t, PetscReal t_next, PetscReal motion);
/* Are all slave points that may touch within the margin of their lists, at the last residual? Collective. */
PetscErrorCode ContactListsReach(Contact, PetscBool *within);
/* New lists at (u, t) in the middle of a step; offsets stay. Collective. */
PetscErrorCode ContactListsRenew(Contact, const PetscReal *u, PetscReal t, PetscReal motion);
/* After ContactResidual() at (u, t): does a fresh search, for `next` motion, give the same gaps? If not, the fresh
   lists replace the old. motion: since the accepted state; settle: offsets must not lag. Collective. */
PetscErrorCode ContactListsHold(Contact, const PetscReal *u, PetscReal t, PetscReal motion, PetscReal next,
                                PetscBool update_offsets, PetscBool *hold);
/* The force that rounding of positions stands for at the largest penalty. Collective. */
PetscErrorCode ContactRoundOff(Contact, PetscReal *force);
/* Has new lists' search lost a slave point that was behind its master by more than the face size, since the step began?
 * Its place into text. Collective. */
PetscErrorCode ContactLocateLost(Contact, PetscBool *lost, char *text, size_t size);
/* A linear step begins or ends: what is closed stays so, and what touches if that is asked for. Not collective. */
PetscErrorCode ContactHoldActiveSet(Contact, PetscBool holding, PetscBool touching);
/* Penalties count for no more than that many automatic ones; PETSC_MAX_REAL: as they are. The largest there is, so
 * measured. */
PetscErrorCode ContactSoften(Contact, PetscReal most);
PetscErrorCode ContactStiffest(Contact, PetscReal *most);
/* What is in contact now is what a prediction counts on; the energy of other terms at (u, t). */
PetscErrorCode ContactMarkPredicted(Contact);
PetscErrorCode ContactUnpredictedEnergy(Contact, const PetscReal *u, PetscReal t, PetscReal *energy);
/* Adds the contact forces to f (n_nodes*dim local, complete at owned nodes), this rank's energy and sum of squares of
   the terms' forces; each may be NULL. With f it also becomes the present state (gap, status, forces). Collective. */
PetscErrorCode ContactResidual(Contact, const PetscReal *u, PetscReal t, PetscReal *f, PetscReal *energy,
                               PetscReal *force2);
/* The contact matrix C over the global free dofs at (u, t), owned by the contact; *changed: its pattern is new.
 * Collective. */
PetscErrorCode ContactTangent(Contact, const PetscReal *u, PetscReal t, Mat *C, PetscBool *changed);
/* Terms that came, went or changed their stiffness from the tangent before to the last one. Collective. */
PetscErrorCode ContactTangentChanges(Contact, PetscInt *terms);
/* What these add to the tangent, N diag(s) N^T: s[terms] and a dense N of so many columns, the caller's. rows: the
 * matrix's on this rank. Collective. */
PetscErrorCode ContactChangeVectors(Contact, PetscInt rows, PetscInt terms, PetscReal *s, Mat *N);
/* The last tangent, C, as nearly a sum of v v^T over its terms; the arrays stay the contact's. Not collective. */
PetscErrorCode ContactGetBorder(Contact, Border *);
/* Do the surfaces of a pair of bodies couple many nodes with each slave node? Not collective. */
PetscBool ContactHasFits(Contact);
/* y += C x with the tangent that is asked for in between, all dofs; rigid tools contribute their motion from t to
   t_next. x, y local, y complete at owned nodes. Collective. */
PetscErrorCode ContactMultiplyBegin(Contact, const PetscReal *x, PetscReal t, PetscReal t_next);
PetscErrorCode ContactMultiplyEnd(Contact, PetscReal *y);
PetscErrorCode ContactAccept(
  Contact); /* the present state is the one that ContactRestore() returns to. Not collective */
PetscErrorCode ContactRestore(Contact);
PetscErrorCode ContactTangentRestore(
  Contact); /* what earlier tangents have left is that of the accepted state too. Collective */
/* The accepted state, at (u, t), and all else that the next steps depend on. Loading it also makes it the present one,
 * with lists. Collective. */
PetscErrorCode ContactArchive(Contact, Archive, const PetscReal *u, PetscReal t);
/* What the scene says of overlaps before any load (initial_overlap): refuses those beyond what the facets' own shape
   explains (pair, node, amount), or keeps them as g_0. After ContactResidual(). Collective. */
PetscErrorCode ContactTakeOverlap(Contact);
PetscErrorCode ContactSummarise(Contact, ContactSummary *);
/* Adjustment and augmentation of the penalty (contactpenalty.c, contactaugment.c), after a converged ContactResidual():
   within the step, until the window holds, ... */
PetscErrorCode ContactAdjustPenalty(Contact, ContactWindowState *);
/* ... or, after ContactAccept(), for the next step. Each sees only the pairs whose scene asks for it. */
PetscErrorCode ContactAdjustNextPenalty(Contact);
/* Did the last iterate move the penetrations by so little that the window can be judged? Once for each iterate.
 * Collective. */
PetscErrorCode ContactGapsConverged(Contact, PetscBool *converged);
PetscErrorCode ContactPairWindow(Contact, int pair, ContactWindow *);
PetscErrorCode ContactLocateOutside(Contact, char *text,
                                    size_t size); /* which node misses its window most. Collective. */
/* Control of the load step (contacttouch.c): when open slave nodes touch if all goes on as from (u_0, t_0) to (u, t);
   sorted, the same on all ranks; still_open: only those that are open at (u, t). The caller frees the list. Collective.
 */
PetscErrorCode ContactTouches(Contact, const PetscReal *u_0, PetscReal t_0, const PetscReal *u, PetscReal t,
                              PetscBool by_area, PetscBool still_open, int *n, Touch **);
/* Slave nodes, or their area, whose status is another one than in the accepted state; *all: of all slave nodes.
 * Collective. */
PetscErrorCode      ContactChanges(Contact, PetscReal t_0, PetscBool by_area, PetscReal *changed, PetscReal *all);
int                 ContactPairs(Contact);
const char         *ContactPairName(Contact, int pair);
const SceneContact *ContactPairScene(Contact, int pair);
int                 ContactFindPair(Contact, const char *name); /* -1: none */
/* Arrays belong to the contact and are valid until its next call. Collective. */
PetscErrorCode ContactGetNodes(Contact, int pair, const PetscReal *u, ContactNodes *);
/* Force of the pair on its master. Collective. */
PetscErrorCode ContactMasterForce(Contact, int pair, PetscReal force[3]);
/* Gap of the slave node with that rank-independent number, however far its master; NaN if it is no slave node.
 * Collective. */
PetscErrorCode ContactGapAt(Contact, int pair, const PetscReal *u, PetscReal t, PetscInt node_id, PetscReal *gap);
/* Smallest and largest penalty of the pair. Collective. */
PetscErrorCode ContactPairPenalty(Contact, int pair, PetscReal *least, PetscReal *most);
PetscErrorCode ContactPairSurface(Contact, int pair, const MeshGroup **slave, PetscReal *mean_face_size);
PetscErrorCode ContactPairFits(Contact, int pair, ContactFits *);
/* contactquality.c: the present state of a pair, for reports. Collective. */
PetscErrorCode ContactPairGaps(Contact, int pair, ContactGaps *);
PetscErrorCode ContactPairQuality(Contact, int pair, ContactQuality *);
/* Slave nodes that are the master's too, and the place of one of them. */
PetscErrorCode ContactPairJoined(Contact, int pair, PetscInt *nodes, ContactPlace *);
PetscReal      ContactNodeGap(Contact,
                              PetscInt node); /* smallest gap of a local node of this rank, NaN: none. Not collective */
PetscErrorCode ContactPairText(Contact, int pair, char *text, size_t size);
PetscBool      ContactPairIsSurface(Contact, int pair);
MPI_Comm       ContactComm(Contact);
