/* What the files of this folder share: the pair, the state of its terms, the contact object.

   A term is a slave node with area. Its gap is the weighted mean over its slave points, and its pressure acts on all of
   them. Node to surface: a term has one slave point, the node itself. Surface to surface: its slave points are the
   quadrature points of the faces around the node, which it shares with its neighbours. A node on a sharp edge may
   have a term for each further side of the edge (contactcorners.c), and where the surface ends one more for the end
   itself (contactends.c). Faces may have terms besides (contactfaces.c).
   Both press and have stiffness as others do, but what is counted and shown is that of the nodes.

   A rigid tool with sharp edges that stands on its slave has a second pair (contactridge.c), node to surface: points on
   the edges are its slave points, and the slave is its master.

   The files call each other downwards in this order: contactwork (room), contactpair, contactends,
   contactcorners, contactfaces and contactterm (a pair, its ends, the terms of its sharp edges and faces, one of its
   terms), contacttool (a tool with unknowns), contactpoint (one slave point), contactvariation (first variations that
   are kept), contactprojection (gaps of all points), contactvectors (first variations over dofs), frictiontravel,
   frictionenergy, friction, frictionstep, frictiontangent, contactresidual, contacttangent, contactlists, contact. */
#pragma once
#include "matrix/blockmatrix.h"
#include "contact/activeset.h"
#include "contact/contact.h"
#include "smooth/fitderivatives.h"
#include "contactlaw.h"
#include "anderson.h"
#include "contactwork.h"
#include "friction.h"
#include "search/offset.h"
#include "search/search.h"
#include "smooth/smoother.h"

/* What the scene's formulation means for a pair. ContactPairCreate() fills it, and nobody asks the question in another
 * way. */
typedef struct {
  PetscBool surface;   /* surface to surface: slave points are quadrature points of faces, and terms share them; each
                          side has offsets */
  PetscBool   faces;   /* there are terms of faces beside those of nodes */
  OffsetsKind offsets; /* what offsets there are, where surface is PETSC_TRUE */
  PetscBool   lags;    /* offsets are held in a solve, so that a fresh search may find them old */
} PairFormulation;

/* First variations of slave points over contact nodes at the last projection of a pair. Residual, tangent and its
   changes ask for the same ones, so they are evaluated once. The nodes of point q are number[first[q]] to
   number[end[q] - 1]; first[q] is -1 where it was not evaluated yet, and there are no nodes where no master is near. */
typedef struct {
  PetscInt   n_points, *first, *end;
  PetscInt  *number, n, room;
  PetscReal *N;   /* dim for each node */
  PetscReal *own; /* dim for each point: the part that belongs to the motion of the slave point itself */
} ContactVariations;

/* The slave point that was lost the deepest behind its master. */
typedef struct {
  PetscReal depth; /* behind the master (length); 0: no point was lost */
  PetscReal gap;   /* in front of the master, where the point is found now (length); NaN: no master is near */
  PetscReal size;  /* of the slave's faces there (length) */
  PetscInt  tag;   /* of its node */
} ContactLost;

typedef struct {
  Mesh                mesh;
  const SceneContact *scene;
  Geometry            geometry;
  PairFormulation     formulation;
  FitSettings         fit;           /* fit.fitted: the master is fitted, so lists hold fits and timings count as fit */
  ContactSurface      slave, master; /* master NULL: analytic, in scene */
  const MeshTool     *tool;          /* the master or the slave, where its motion has free components; else NULL */
  int                 ridge;         /* number of the pair of its tool's sharp edges; 0: there is none */
  int                 tool_pair;     /* of such a pair: number of the one to which it belongs */
  PetscReal          *edge_length;   /* of such a pair of a deformable master: of the edges at each node (length) */
  SceneContact        ridge_scene;   /* of such a pair: what the scene would say of it */
  int                 n_images;      /* of the master, for fits and search */
  int             n_mirrors; /* those and the ones beyond planes at which a surface turns sharply, for its corners */
  SurfaceImage    images[SURFACE_MAX_IMAGES], mirrors[SURFACE_MAX_IMAGES];
  const Smoother *smoother; /* the scene's */
  const Smoother *facets;   /* serves where there is no fit, and says where the master ends */
  const Law      *law;
  SlavePoints     slaves;
  Offsets         slave_offsets, master_offsets; /* NULL: none */
  PetscBool       one_body;                      /* of a list of surfaces: slave and master have faces of one body */
  ContactSearch   search;
  FaceMarks      *marks; /* of each slave point, where other pairs treat some of its partners; else NULL */

  /* Terms: the first n_nodes are those of nodes, up to n_sides those of further sides of sharp edges and of ends, the
     others those of faces. */
  PetscInt   n, n_nodes, n_sides;
  PetscInt  *corner; /* FACE_MAX_NODES for each face of the slave points: term of a further side, or -1; NULL: none */
  PetscInt  *at_end; /* of each node of each slave point: its term of an end, or -1; NULL: there are no ends */
  PetscReal *below;  /* of each term before n_sides: it presses where it is deeper than this (length); NULL: all 0 */
  /* Of each node: its further sides and ends have the terms first_side[c] to first_side[c + 1] - 1. */
  PetscInt  *first_side;
  PetscReal *whole;                    /* reference area of each node, all sides together */
  PetscReal *shown_gap, *shown_normal; /* what ContactGetNodes() shows of nodes: of the side with the least gap */
  PetscInt  *node, *face;           /* local node of each term, of a face its first one; face of each term of a face */
  PetscReal *area, *size, *turn;    /* reference area; size of the faces around (length); turn of their normals */
  PetscInt  *term_ptr, *term_point; /* slave points of each term */
  PetscReal *term_weight;           /* their areas in it; where faces have terms, nodes and faces share the area */
  PetscReal  automatic;             /* penalty (force per length and area) */
  PetscReal  initial;               /* the penalty at the start of the run */
  PetscReal  most;                  /* largest penalty that counts (force per length and area), ContactSoften() */
  PetscReal  predicted_most;        /* that of terms which the prediction counted on */
  PetscBool  holding, touching;     /* a linear step: closed terms stay so, and what touches is closed */
  PetscBool  solved;                /* it begins at a solution, whose lists may have been replaced since */
  PetscBool *held, *predicted;      /* terms closed where the linear step began; those the prediction counted on */
  PetscReal *balanced;              /* pressures of the terms at the solution where it began, if solved */
  PetscReal *foreseen;              /* pressures of the terms at the end of the last linear step; NaN: not known */
  PetscBool *expected, *arrived;    /* terms that press at the end of the last linear step; of the one before */

  PetscReal   *carried;     /* pressure of each term that a fluid carries in the contact's place; NULL: no fluid */
  PetscReal   *carried_dry; /* of it where surfaces are dry, so that friction counts it; NULL: no fluid or friction */
  ContactState now, accepted;
  PetscReal   *before;  /* gaps of the iterate before, where the penalty is adjusted */
  Anderson     mixing;  /* of the multipliers of one step; NULL: the pair is not augmented */
  PetscReal   *weight;  /* of their entries there (area) */
  PetscInt     updates; /* of penalties or multipliers in this step */

  NeighbourLists lists, next; /* in force; fresh ones for the next step, or NULL */
  PetscBool      stays;       /* those in force are empty, and fresh ones would be too: they are the next ones */
  PetscReal      motion, next_motion;  /* relative motion that each was made for (length) */
  PetscReal     *factor, *next_factor; /* area factor of each slave point: frozen with the lists, fades out past a free
                                          edge of the master */
  /* Of each slave point: its factor before the one in force, in this step, and what the search said then less that. */
  PetscReal *factor_before, *factor_change;
  PetscReal *factor_low, *factor_high; /* factors of this step between which the right one is */
  int       *first_rung;               /* rung with which the fit of each slave point begins in this step */
  PetscBool *fallen;                   /* slave points whose fit has fallen to a lower rung in this step */
  /* Of each slave point, in this step: normals of the frame of the fit before the one in force and of the frame that
     its fit keeps, 0 for none; its frame has turned back once. */
  PetscReal         *frame_before, *frame_kept;
  PetscBool         *turned_back;
  PetscBool          undamped;  /* none of these has been set since the step began */
  PetscBool          fresh;     /* the lists in force were made where they are, with the offsets in force */
  PetscBool          begun;     /* the lists in force are those with which the step began */
  PetscBool          projected; /* the slave points were projected with these lists at their last update */
  int               *seed;      /* of each slave point: facet of the last projection */
  PetscReal         *point_gap, *point_normal, *point_force; /* of each slave point, at the last projection */
  ContactVariations *variations;
  Friction           friction; /* NULL: there is none */
  ContactLost        lost;     /* since the step began */

  PetscReal *stiffness, *stiffness_before; /* of the terms in the last tangent, and in the one before */
  PetscReal *force, *normal;               /* of the last residual: normal nodal force, direction of contact (3*n) */
  PetscReal  total[3];                     /* force on this rank's terms in the last residual */
  PetscReal  t;                            /* load parameter of the last residual */
  PetscReal *pressure;                     /* what ContactGetNodes() shows: force over area */
  /* Of the last residual, where the master is a slave as well, else NULL: force on the master by node of the mesh. */
  PetscReal   *reaction;
  NodeDepths   depths; /* NULL before the first report of depths in the slave */
  ContactWork *work;   /* shared by all pairs */
} ContactPair;

/* How contact nodes slide a term: the shares of their motion, 3 of each, and the unit normal across which it does not
   slide. */
typedef struct {
  PetscInt   n, *node;
  PetscReal *share, normal[3];
} FrictionSlide;

/* First variations of the gaps of some terms over the free dofs. Vector k has the entries ptr[k] to ptr[k + 1] - 1, in
   which a row may occur more than once. */
typedef struct {
  PetscInt     n, *ptr, *row, room, vectors_room;
  PetscScalar *value;
} ContactVectors;

/* What the next tangent is multiplied with, and the product, over the contact nodes of a pair. */
typedef struct {
  PetscReal *x, *y;
} ContactProduct;

struct _n_Contact {
  Mesh             mesh;
  Scene            scene;
  Loads            loads;
  int              n_pairs, n_scene; /* the first n_scene are those of the scene, the others those of sharp edges */
  ContactPair     *pairs;
  PetscInt        *piece;   /* connected piece of each local node, while pairs of listed surfaces are made; else NULL */
  const PetscReal *u_begun; /* local displacements at which the load step began, of the model */
  PetscReal        t_begun; /* its load parameter */
  PetscReal       *u_gathered; /* local displacements of the last ContactGather() (length); NULL: there was none */
  PetscReal        t_gathered; /* its load parameter */
  PetscReal       *u_before;   /* the same of the one before, from which the bodies came there; NULL: none */
  PetscReal        t_before;   /* its load parameter */
  ContactWork      work;
  BlockMatrix      blocks;     /* the last tangent */
  ContactVectors   border;     /* the first variations of its terms */
  ContactVectors   one;        /* room for one of them */
  ContactProduct  *product;    /* of each pair; NULL: no product is asked for */
  PetscBool        transposed; /* it is one with the transposed tangent */
  PetscReal       *outer;      /* forces of tools and mirror images are added here; NULL: nobody asks */
  PetscReal       *hold;       /* forces that drive the tools of pairs are added here; NULL: nobody asks */
  PetscLogEvent    event_search, event_project, event_residual, event_tangent;
  PetscLogEvent    event_fit, event_offset, event_adjust, event_touch; /* only where the scene calls for the effect */
};

/* A face of the slave points around a node, the node's number in it, and the face's reference normal at the node. */
typedef struct {
  PetscInt  face;
  int       at;
  PetscReal normal[3];
} ContactCornerFace;

/* What of a pair is in contact: closed nodes, or closed faces where no node is closed. */
typedef struct {
  PetscInt  n;
  PetscBool faces;         /* faces are counted */
  PetscReal depth, over_h; /* largest penetrations (length, face sizes) */
} ContactPressing;

/* contactpair.c */
PetscErrorCode ContactPairCreate(Mesh, Scene, Elasticity, Loads, const PetscInt piece[], const SceneContact *,
                                 ContactPair *);
PetscErrorCode ContactPairDestroy(ContactPair *);
PetscErrorCode ContactPairCreateRidge(Contact, Elasticity, int of, ContactPair *);
PetscErrorCode ContactPairCreateEdges(Contact, Elasticity, int of, ContactPair *);
/* contactridge.c */
PetscBool      ContactIsRidge(const ContactPair *);
PetscBool      ContactOnTool(const ContactPair *);
PetscInt       ContactTermTag(const ContactPair *, PetscInt term);
void           ContactTermPlace(const ContactPair *, PetscInt term, PetscReal X[3]);
PetscErrorCode ContactRidgeFaces(const ContactPair *, const PetscBool some[], PetscReal *mine);
/* contactoverride.c */
PetscErrorCode ContactOverride(Contact, Elasticity);
/* contactrepeated.c */
PetscErrorCode ContactRefuseRepeated(Contact);
/* contactoutside.c */
void ContactPairHold(Contact, const ContactPair *, PetscReal t, const PetscReal *values, PetscReal *out);
/* contactquery.c */
PetscErrorCode ContactNodePressures(Contact, int pair, const PetscReal *u, const PetscReal *force,
                                    const PetscReal *reaction, PetscReal *area, PetscReal *pressure);
PetscErrorCode ContactPairPressing(const ContactPair *, ContactPressing *);
/* contactends.c */
PetscReal      ContactSidesAngle(const ContactPair *);
PetscInt       ContactSideAdd(ContactPair *, PetscInt c);
PetscErrorCode ContactEndsFind(ContactPair *, Scene);
PetscErrorCode ContactEndsBegin(ContactPair *);
void           ContactEndsAdd(ContactPair *, PetscInt c, PetscInt n, const ContactCornerFace face[], PetscInt made[]);
void           ContactEndsPoints(ContactPair *);
PetscReal      ContactEndDepth(const ContactPair *, PetscInt term);
PetscErrorCode ContactEdgesBelow(ContactPair *);
/* contactcorners.c */
PetscErrorCode ContactCornersAdd(ContactPair *);
void           ContactCornersTake(const ContactPair *, PetscInt term[]);
PetscInt       ContactCornerId(const ContactPair *, PetscInt term);
PetscInt       ContactNodeTerm(const ContactPair *, const ContactState *, PetscInt c);
/* contactfaces.c */
PetscBool      ContactFacesServe(const ContactPair *, Scene, int order);
PetscErrorCode ContactFacesAdd(ContactPair *, const PetscReal turn[]);
PetscReal      ContactFacesShare(const ContactPair *);
void           ContactFacesPoints(ContactPair *);
PetscReal      ContactTermPenalty(const ContactPair *, PetscInt term, PetscReal penalty);
PetscBool      ContactTermAtBound(const ContactPair *, PetscInt term);
PetscInt       ContactTermId(const ContactPair *, PetscInt term);
/* contactterm.c */
PetscReal ContactPairPresence(const ContactPair *, PetscReal t);
LawState  ContactTermState(const ContactPair *, PetscInt term, PetscReal t, PetscReal most);
PetscReal ContactTermMost(const ContactPair *, PetscInt term);
LawState  ContactTermStateIn(const ContactPair *, PetscInt term, const ContactState *, PetscReal t, PetscReal most);
void      ContactTermLaw(const ContactPair *, PetscInt term, PetscReal t, LawValue *, PetscReal *gap, PetscReal *area);
PetscReal ContactTermGap(const ContactPair *, const PetscReal *factor, const PetscReal *point_gap, PetscInt term,
                         PetscReal *area);
PetscReal ContactTermTurningPressure(const ContactPair *, PetscInt term, PetscReal t, const LawValue *);
PetscReal ContactTermForce(const ContactPair *, PetscInt term);
PetscReal ContactTermAddedOverlap(const ContactPair *, PetscInt term, PetscReal t);
PetscReal ContactTermOverlap(const ContactPair *, PetscInt term, PetscReal t);
PetscReal ContactTermOffset(const ContactPair *, PetscInt term, PetscReal t);
PetscReal ContactTermOnsetGap(const ContactPair *, PetscInt term, PetscReal t);
PetscReal ContactTermBound(const ContactPair *, PetscInt term);
PetscReal ContactTouchTolerance(const ContactPair *, PetscInt term);
PetscReal ContactMeanOpening(const ContactPair *, PetscInt term);
void      ContactTermPress(const ContactPair *, PetscInt term, PetscReal pressure, PetscReal *point_force);
/* contactpoint.c */
PetscErrorCode ContactPointEvaluate(const ContactPair *, const Smoother *, NeighbourLists, PetscInt q, int seed,
                                    SmootherWant, PetscBool *found);
PetscErrorCode ContactPointToNodes(const ContactPair *, NeighbourLists, PetscInt q);
PetscErrorCode ContactSecondBegin(const ContactPair *, PetscInt nodes, PetscInt points);
PetscErrorCode ContactSecondAdd(const ContactPair *, PetscInt q, PetscReal factor, double (*own)[FIT_DERIVATIVES_OWN],
                                PetscBool *found);
void           ContactSecondEnd(const ContactPair *);
PetscErrorCode ContactPointsToNodes(const ContactPair *, PetscInt first, PetscInt end);
PetscErrorCode ContactOwnToNodes(const ContactPair *, PetscInt nodes, PetscInt first, PetscInt end,
                                 const double (*own)[FIT_DERIVATIVES_OWN]);
/* contacttool.c */
PetscErrorCode ContactToolVariation(const ContactPair *, PetscInt n, const PetscInt nodes[], const PetscReal *N,
                                    PetscReal *own);
PetscErrorCode ContactToolForces(const ContactPair *, PetscReal *values);
PetscErrorCode ContactToolRelative(const ContactPair *, PetscReal *values);
PetscErrorCode ContactToolBlock(const ContactPair *, PetscInt n, const PetscInt nodes[], const PetscReal *force,
                                PetscReal *M);
/* contactvariation.c */
PetscErrorCode ContactVariationsCreate(int dim, PetscInt n_points, ContactVariations **);
PetscErrorCode ContactVariationsDestroy(ContactVariations **);
void           ContactVariationsReset(ContactVariations *);
PetscErrorCode ContactVariationsKeep(const ContactPair *, PetscInt q, PetscBool found);
PetscErrorCode ContactVariationsNeed(const ContactPair *, PetscInt q);
PetscErrorCode ContactVariationsAlong(const ContactPair *, PetscInt q, const PetscReal *motion, PetscReal *change);
PetscErrorCode ContactVariationsOwnPart(const ContactPair *, PetscInt slave, PetscReal own[], PetscBool *found);
PetscInt       ContactVariationsOwn(const ContactPair *, PetscInt q);
PetscErrorCode ContactVariationsNodes(const ContactPair *, PetscInt n, const PetscInt points[]);
void           ContactTermVary(const ContactPair *, PetscInt term, PetscReal scale, PetscReal *v);
/* contactprojection.c */
PetscErrorCode ContactPointGaps(const ContactPair *, NeighbourLists, const PetscReal *factor, const PetscReal *force,
                                int *seed, PetscReal *gap, PetscReal *normals);
PetscErrorCode ContactPairProject(Contact, ContactPair *, const PetscReal *u, PetscReal t);
PetscErrorCode ContactPairMove(Contact, ContactPair *, const PetscReal *x, PetscReal t, PetscReal t_next,
                               PetscReal *values);
/* contactvectors.c */
PetscErrorCode ContactVectorsAdd(ContactVectors *, const ContactPair *, PetscInt term, PetscReal scale);
PetscErrorCode ContactVectorsAddZeros(ContactVectors *, PetscInt n, const PetscInt row[]);
PetscErrorCode ContactVectorsFree(ContactVectors *);
/* friction.c */
PetscErrorCode FrictionCreate(ContactPair *);
PetscErrorCode FrictionDestroy(Friction *);
PetscErrorCode FrictionForget(const ContactPair *);
PetscErrorCode FrictionBegin(ContactPair *, PetscReal t, PetscReal t_next);
void           FrictionTravelBegin(ContactPair *, PetscReal t);
PetscBool      FrictionTermLeaves(const ContactPair *, PetscInt term);
PetscReal      FrictionTermEnergy(const ContactPair *, PetscInt term, const FrictionInput *, const FrictionTraction *,
                                  PetscReal area);
PetscErrorCode FrictionAnchorLate(ContactPair *, const PetscReal *u, PetscReal t, const PetscReal *u_begun,
                                  PetscReal t_begun, PetscBool *made);
void           FrictionAnchorFrame(const ContactPair *, PetscInt q, FrictionFrame *);
PetscErrorCode FrictionTerm(const ContactPair *, PetscInt term, PetscReal t, FrictionInput *, FrictionTraction *,
                            PetscBool *acts);
PetscBool      FrictionTermTakes(const ContactPair *, PetscInt k);
PetscBool      FrictionTermActs(const ContactPair *, PetscInt term, PetscReal stiffness);
PetscInt       FrictionTermGuide(const ContactPair *, PetscInt term);
PetscErrorCode FrictionPointFoot(const ContactPair *, PetscInt q, const FrictionFoot **, PetscBool *found);
PetscInt       FrictionOwnNodes(const ContactPair *, PetscInt q, const PetscInt **node, const PetscReal **S);
void           FrictionNodeSign(const ContactPair *, PetscInt point, PetscInt *node, PetscReal sign[3]);
PetscInt       FrictionLeverNodes(const ContactPair *, PetscInt q, const PetscInt **node, const PetscReal **slope);
PetscInt       FrictionFootPoint(const ContactPair *, PetscInt q, int node);
PetscErrorCode FrictionPointForces(const ContactPair *, PetscInt q, const PetscReal force[3], PetscReal *values);
PetscErrorCode FrictionTermAsk(const ContactPair *, PetscInt term, PetscReal t, FrictionInput *, PetscBool *found);
PetscErrorCode FrictionResidual(ContactPair *, PetscReal t, PetscReal *values);
PetscErrorCode FrictionNodalForces(const ContactPair *, const PetscReal *force, PetscReal *on_node);
PetscErrorCode FrictionShow(const ContactPair *, const PetscReal *area, ContactNodes *);
/* frictiongrip.c */
PetscReal      FrictionTermBeyond(const ContactPair *, PetscInt term);
PetscErrorCode FrictionGripNext(const ContactPair *, PetscReal *grip);
PetscErrorCode FrictionGripTake(ContactPair *, const PetscReal *grip);
/* frictionstep.c */
PetscErrorCode FrictionTermSlide(const ContactPair *, PetscInt term, FrictionSlide *);
PetscErrorCode FrictionSlideFree(FrictionSlide *);
void           FrictionSlideMotion(const FrictionSlide *, int dim, const PetscReal *values, PetscReal motion[3]);
PetscErrorCode FrictionTermForces(const ContactPair *, PetscInt term, const PetscReal traction[3], PetscReal *values);
PetscErrorCode FrictionStepTerm(const ContactPair *, PetscInt term, PetscReal t, ActiveSetFriction *,
                                PetscReal tangent[2][3]);
/* frictiontangent.c */
PetscErrorCode FrictionTurnsKeep(const ContactPair *, PetscInt q);
PetscErrorCode FrictionTermNodes(const ContactPair *, PetscInt term);
PetscErrorCode FrictionFaceNodes(const ContactPair *, PetscInt face, PetscInt n, const PetscInt points[]);
PetscErrorCode FrictionTangentBegin(const ContactPair *);
PetscErrorCode FrictionTermPrepare(const ContactPair *, PetscInt term);
PetscErrorCode FrictionTermBlock(const ContactPair *, BlockMatrix, int list, PetscInt term, PetscReal t, PetscInt n,
                                 const PetscInt nodes[]);
PetscErrorCode FrictionFaceBlock(const ContactPair *, BlockMatrix, int list, PetscInt face, PetscInt n,
                                 const PetscInt nodes[]);
PetscErrorCode FrictionTermAlong(const ContactPair *, PetscInt term, const FrictionTraction *, const PetscReal *motion,
                                 PetscReal change[3]);
/* contactresidual.c */
PetscErrorCode ContactPointForces(const ContactPair *, const PetscReal *point_force, PetscReal *values);
PetscErrorCode ContactPointReactions(const ContactPair *, const PetscReal *point_force, const PetscReal *values,
                                     PetscReal *reaction);
PetscErrorCode ContactNodalForces(const ContactPair *, const PetscReal *point_force, PetscReal *force);
/* contactbetween.c */
PetscErrorCode ContactBetweenNodes(Contact, ContactPair *, const PetscReal *u, int n, PetscReal *const y[],
                                   PetscReal error[]);
/* contacttangent.c */
PetscErrorCode ContactMatrixRows(Contact, PetscInt *rows);
/* contactlists.c */
PetscErrorCode ContactListsArchive(Contact, Archive, const PetscReal *u, PetscReal t);
/* contactimmersed.c */
PetscErrorCode ContactRefuseImmersed(Contact, int pair);
/* contacttunnelling.c */
PetscErrorCode ContactNoteLost(ContactPair *, PetscReal t);
PetscErrorCode ContactNoteTunnelled(ContactPair *, PetscReal t);
void           ContactNoteJumps(ContactPair *, PetscReal motion);
