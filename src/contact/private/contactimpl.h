/* What the files of the contact share and nobody else sees: a pair, its terms and the room to evaluate slave points in.
 */
#pragma once
#include "matrix/blockmatrix.h"
#include "contact/contact.h"
#include "smooth/fitderivatives.h"
#include "law.h"
#include "anderson.h"
#include "search/offset.h"
#include "search/search.h"
#include "smooth/smoother.h"

/* What the points of one evaluation are made of: row 0 the slave point, 1 + i the i-th point that takes part; entries
   ptr[r] to ptr[r + 1] are nodes (places in the work's number[]) with weights S, reflected by sign (3 for each entry).
 */
typedef struct {
  int    *ptr, *node;
  double *S, *sign;
  int     rows_room, entries_room;
} ContactMap;

/* Room to evaluate one slave point in, and its first variation carried to the contact nodes: number[count] are these, N
   runs over them. Second variations of some slave points are summed over the nodes of a block into M. */
typedef struct {
  SmootherResult    result;
  PetscReal        *x, *multiplier, *workspace; /* positions relative to the slave point */
  PetscInt          x_room;
  ContactMap        map;
  PetscInt          count, *number;
  PetscReal        *N;
  PetscInt          room;
  FitDerivativesSum sum;
  PetscReal        *sum_workspace, *M;
  PetscInt          sum_room, M_room;
  int *slot; /* of every contact node: its place in number[] or in the block at hand, -1 elsewhere and between
                evaluations */
  PetscInt slot_room;
} ContactWork;

/* First variations of slave points over contact nodes where the pair was last projected: residual, tangent and its
 * changes ask for the same ones. */
typedef struct {
  PetscInt   n_points, *first, *end; /* of each point; first -1: not evaluated yet; no nodes: no master is near */
  PetscInt  *number, n, room;        /* nodes of one point after another */
  PetscReal *N, *own;                /* over these; own[dim] of each point: by the slave point itself */
} ContactVariations;

/* The slave point that was lost the deepest behind its master; depth 0: none */
typedef struct {
  PetscReal depth,
    gap;          /* depth: behind the master; gap: in front of it, where it is found now (NaN: no master is near) */
  PetscReal size; /* of the slave's faces there */
  PetscInt  node; /* local */
} ContactLost;

/* A term is a slave node with area: its gap is the weighted mean over its slave points, its pressure acts on all of
   them. Node to surface: one point, the node itself. Surface to surface: the quadrature points of the faces around,
   shared with its neighbours. */
typedef struct {
  Mesh                mesh;
  const SceneContact *scene;
  Geometry            geometry;
  FitSettings         fit;
  ContactSurface      slave, master; /* master NULL: analytic, in scene */
  int                 n_images;
  SurfaceImage        images[SURFACE_MAX_IMAGES];
  const Smoother     *smoother;
  const Smoother     *facets; /* what serves where there is no fit, and tells where the master ends */
  const Law          *law;
  SlavePoints         slaves;
  Offsets             slave_offsets, master_offsets; /* surface to surface; NULL: none */
  PetscBool           lags;                          /* offsets are held in a solve: it may find them old */
  ContactSearch       search;
  PetscInt            n, *node; /* terms: local nodes */
  PetscReal          *area, *size, *turn;
  PetscInt           *term_ptr, *term_point; /* slave points of each term */
  PetscReal          *term_weight;           /* their areas in it: sum is the term's area */
  PetscReal           automatic;             /* penalty: force per length and area */
  PetscBool           holding, touching;     /* what is held stays closed; what touches is closed */
  PetscBool *held, *predicted; /* terms closed where the linear step began; those that the last prediction counted on */
  PetscReal  most;             /* that a penalty counts for (force per length and area) */
  ContactState   now, accepted;
  PetscReal     *before;                   /* gaps of the iterate before, where the penalty is adjusted */
  NeighbourLists lists, next;              /* next: fresh ones, NULL: none */
  PetscReal     *next_factor, next_motion; /* of the next ones: area factors, and the motion they were made for */
  PetscReal      motion;                   /* that those in force were made for */
  PetscBool      fresh;                    /* they were made where they are, with the offsets in force */
  /* per slave point; factor: frozen with the lists, fades out past a free edge; seed: the facet of last time; gap,
   * normal: of the last projection */
  PetscReal         *factor;
  int               *seed;
  PetscReal         *point_gap, *point_normal, *point_force;
  ContactVariations *variations;
  PetscReal         *stiffness, *stiffness_before; /* of the terms in the last tangent, in the one before */
  PetscReal         *force, *normal;               /* of the last residual: normal nodal force, contact normal (n*3) */
  PetscReal          total[3];                     /* and the force on this rank's terms */
  PetscReal          t;                            /* of the last residual */
  PetscReal         *pressure;                     /* what ContactGetNodes() shows: force over area */
  Anderson           mixing;                       /* of the multipliers of one step; NULL: not augmented */
  PetscBool          projected;                    /* there was one with these lists */
  ContactLost        lost;                         /* since the step began */
  PetscInt           updates; /* times in this step that penalties were adjusted, or pressures became multipliers */
  ContactWork       *work;    /* shared by all pairs */
} ContactPair;

/* First variations of the gaps of some terms over the free dofs: of vector k the entries ptr[k] to ptr[k + 1], in which
 * a row may occur more than once */
typedef struct {
  PetscInt     n, *ptr, *row, room, vectors_room;
  PetscScalar *value;
} ContactVectors;

/* What the next tangent is multiplied with, and the product, over the contact nodes of a pair */
typedef struct {
  PetscReal *x, *y;
} ContactProduct;

struct _n_Contact {
  Mesh            mesh;
  Scene           scene;
  Loads           loads;
  int             n_pairs;
  ContactPair    *pairs;
  ContactWork     work;
  BlockMatrix     blocks;  /* the last tangent */
  ContactVectors  border;  /* of its terms */
  ContactVectors  one;     /* room for one of them */
  ContactProduct *product; /* of each pair; NULL: none is asked for */
  PetscLogEvent   event_search, event_project, event_residual, event_tangent;
  PetscLogEvent   event_fit, event_offset, event_adjust,
    event_touch; /* of effects: none where the scene does not call for them */
};

/* contact.c */
PetscErrorCode ContactPairProject(Contact, ContactPair *, const PetscReal *u,
                                  PetscReal t); /* gaps of all slave points there */
PetscErrorCode ContactPairMove(Contact, ContactPair *, const PetscReal *x, PetscReal t, PetscReal t_next,
                               PetscReal *values); /* of its contact nodes */
LawState       ContactTermState(const ContactPair *, PetscInt term, PetscReal t);
void           ContactTermLaw(const ContactPair *, PetscInt term, PetscReal t, LawValue *, PetscReal *gap,
                              PetscReal *area); /* of the last projection */
PetscReal      ContactTermForce(const ContactPair *,
                                PetscInt term); /* what the term's own gap, of the last projection, presses with */
/* contactpair.c */
PetscErrorCode ContactPairCreate(Mesh, Scene, Elasticity, Loads, const SceneContact *, ContactPair *);
PetscErrorCode ContactPairDestroy(ContactPair *);
PetscReal      ContactTermOffset(const ContactPair *, PetscInt term, PetscReal t);
PetscReal ContactTermOnsetGap(const ContactPair *, PetscInt term, PetscReal t); /* gap below which the term presses */
PetscReal ContactTouchTolerance(const ContactPair *, PetscInt term);
PetscReal ContactMeanOpening(const ContactPair *, PetscInt term);
/* contactaugment.c */
PetscReal      ContactTermBound(const ContactPair *, PetscInt term); /* of the penetration; 0: not augmented */
PetscErrorCode ContactPairBeyond(const ContactPair *, ContactWindow *);
PetscErrorCode ContactPairAugment(ContactPair *, ContactWindowState *);
/* contactlists.c */
PetscErrorCode ContactListsArchive(Contact, Archive, const PetscReal *u, PetscReal t);
/* contactpoint.c */
PetscErrorCode ContactPointEvaluate(const ContactPair *, const Smoother *, NeighbourLists, PetscInt q, int seed,
                                    SmootherWant, PetscBool *found);
/* The first variation of the last evaluation over contact nodes, into the work's number and N. */
PetscErrorCode ContactPointToNodes(const ContactPair *, NeighbourLists, PetscInt q);
/* Contact nodes that are mentioned, each once, into the work's number */
PetscErrorCode ContactNodesBegin(const ContactPair *, PetscInt room);
void           ContactNodesAdd(const ContactPair *, PetscInt n, const PetscInt nodes[]);
void           ContactNodesEnd(const ContactPair *);
/* The nodes of a block: where they stand in it, until they are forgotten. */
PetscErrorCode ContactBlockBegin(const ContactPair *, PetscInt n, const PetscInt nodes[]);
void           ContactBlockEnd(const ContactPair *, PetscInt n, const PetscInt nodes[]);
/* The sum of factor times second variations of some slave points over the nodes of a block, and of vectors' products
 * with themselves, into the work's M. */
PetscErrorCode ContactSecondBegin(const ContactPair *, PetscInt nodes, PetscInt points);
PetscErrorCode ContactSecondAdd(const ContactPair *, PetscInt q, PetscReal factor, double (*own)[FIT_DERIVATIVES_OWN]);
void           ContactSecondEnd(const ContactPair *);
/* What belongs to fit points one by one, own[n_points] of all slave points: some points' nodes into the work's number,
 * then the sum over a block. */
PetscErrorCode ContactPointsToNodes(const ContactPair *, PetscInt first, PetscInt end);
PetscErrorCode ContactOwnToNodes(const ContactPair *, PetscInt nodes, PetscInt first, PetscInt end,
                                 const double (*own)[FIT_DERIVATIVES_OWN]);
PetscErrorCode ContactWorkDestroy(ContactWork *);
/* Gaps of all slave points that have a factor, NaN of the others; force: points with one have their first variations
   kept too; force, seed, normals: may be NULL. */
PetscErrorCode ContactPointGaps(const ContactPair *, NeighbourLists, const PetscReal *factor, const PetscReal *force,
                                int *seed, PetscReal *gap, PetscReal *normals);
/* Weighted mean of its points' gaps, NaN without any; *area: of those that count. */
PetscReal ContactTermGap(const ContactPair *, const PetscReal *factor, const PetscReal *point_gap, PetscInt term,
                         PetscReal *area);
/* contactvariation.c */
PetscErrorCode ContactVariationsCreate(int dim, PetscInt n_points, ContactVariations **);
PetscErrorCode ContactVariationsDestroy(ContactVariations **);
void           ContactVariationsReset(ContactVariations *); /* the points have moved */
PetscErrorCode ContactVariationsKeep(const ContactPair *, PetscInt q,
                                     PetscBool found);                 /* that of the last evaluation */
PetscErrorCode ContactVariationsNeed(const ContactPair *, PetscInt q); /* evaluates it, unless it is there */
PetscErrorCode ContactVariationsNodes(
  const ContactPair *, PetscInt n,
  const PetscInt points[]); /* of some points that carry area, into the work's number */
void           ContactTermVary(const ContactPair *, PetscInt term, PetscReal scale,
                               PetscReal *v); /* adds scale area N of the term over the block at hand */
PetscErrorCode ContactVectorsAdd(ContactVectors *, const ContactPair *, PetscInt term,
                                 PetscReal scale); /* scale area N of the term as one more */
PetscErrorCode ContactVectorsAddZeros(ContactVectors *, PetscInt n,
                                      const PetscInt row[]); /* zeros in these rows as one more */
PetscErrorCode ContactVectorsFree(ContactVectors *);
/* contactlost.c */
/* Remember the slave points behind their masters that the next lists have lost; those that passed through it; those
 * that jumped out since the accepted state.
 */
PetscErrorCode ContactNoteLost(ContactPair *, PetscReal t);
void           ContactNoteTunnelled(ContactPair *, PetscReal t);
void           ContactNoteJumps(ContactPair *, PetscReal motion);
