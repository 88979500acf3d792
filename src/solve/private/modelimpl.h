/* What the solvers share and no other folder sees: the working state of a model, and the functions that one solver
   offers to those above it.

   problem.c is below all of them, and freebodies.c and rigidsearch.c below it. tangent.c makes the tangent and prepares
   its linear solver. softmotion.c finds the softest motion in a linear step, shiftedstep.c shifts the tangent where
   bodies buckle or snap, heldmotion.c holds such motions: heldspace.c finds them, heldsolve.c solves with them held,
   heldfriction.c tells what friction would hold them. linearcontact.c finds the contact that is right at the end of a
   linear step. linecuts.c says why a line search shortened its step. slopesearch.c finds how far a step of bodies that
   yield leads to balance, relaxedsearch.c is the line search, linesearch.c chooses what it compares, and corrects steps
   for contact. newton.c runs SNES once with the present contact lists. prediction.c finds a first iterate,
   penaltyramp.c improves it on softened penalties, dampedsolve.c solves with shifted tangents where Newton's method
   finds no equilibrium. penaltyerror.c estimates what penetration leaves of error and stiffens penalties, jump.c tells
   an equilibrium that was reached by a jump, stability.c whether it is stable, adjoint.c weighs errors of a solution.
   equilibrium.c goes from an accepted state to the next one. model.c holds the accepted state. Each file calls only
   those named before it. */
#pragma once
#include "contact/contactcycle.h"
#include "extrapolation.h"
#include "linear/linearsolver.h"
#include "solve/model.h"

/* Lists that slave points leave while Newton's method runs are replaced this many times in one solve. */
#define MODEL_MAX_REGATHER 8

/* A linear step is divided into pieces if it moves the two ends of a cell's edge relative to each other by more than
   this part of the edge's length. A rotation of this size becomes, in a linear step, a stretch of one sixth. On a pipe
   between plates values from 0.5 to 0.75 work. Shorter pieces cost more than they save, because each of them may leave
   the contact. */
#define MODEL_FARTHEST 0.6

/* Energy of a state with an inverted element. It is above that of any other state, and its square, which the line
   search forms, is still a number. */
#define MODEL_INVERTED 1e100

/* What the line search compares. Energy is the potential energy; it needs conservative loads. Residual is the norm of
   the residual, for iterates so close to equilibrium that energies differ by round-off only. */
typedef enum { OBJECTIVE_ENERGY, OBJECTIVE_RESIDUAL } Objective;

/* Iterates whose residuals a line search with friction looks back to (Grippo, Lampariello, Lucidi, SIAM J. Numer. Anal.
   23, 1986). With one alone searches end in kinks; with ten nothing is gained. */
enum { LINE_MEMORY = 4 };

/* A step over which the energy rises, until it is known whether it pays */
typedef struct {
  PetscBool waits;    /* there is one, and it is not known yet */
  PetscBool linear;   /* the last step was taken as far as cells may turn, whatever its energy */
  PetscBool turns;    /* in this solve a step uphill close to an equilibrium did not pay: such steps are turned, too */
  PetscInt  times;    /* steps since */
  PetscReal rise;     /* of the energy over it and the steps since, where there is no energy to evaluate */
  PetscReal slope;    /* of the energy along it */
  PetscReal turn;     /* by which it turned a cell, see ModelLargestTurn() */
  PetscReal farthest; /* by which the next one may */
  Vec       x, y;     /* free displacements at its start, and the whole step (length) */
} RelaxedStep;

/* The shift of the tangent, see ModelShiftStep() */
typedef struct {
  PetscBool on;          /* tangents are shifted */
  PetscInt  pressures;   /* unknowns that are pressures of nodes */
  PetscReal mean, scale; /* the elements' mean stiffness, the present shift: see damping.h */
  PetscReal works;       /* work of the steps so far against springs that are anchored at each iterate */
  PetscReal start;       /* potential energy at the first iterate; infinite: there is none */
  PetscBool cut;         /* the last step was shortened much */
  Vec       lists;       /* free displacements at which contact lists were made (length) */
  PetscReal reach;       /* motion from there that they are good for (length) */
  PetscReal wanted;      /* motion that new ones must be good for, as a step leads out of them (length); 0: none does */
} ShiftedStep;

/* At most so many soft motions are held at a time. A ring rolls in waves around it, and its mesh knows as many of them
   as it has elements there. Each takes a solve with the factor in an iteration; the bound keeps them cheap beside a
   factor.
 */
enum { HELD_MOST = 24 };

/* Soft motions that are held, see ModelHoldMotion() */
typedef struct {
  int       wanted;                /* how many are to be held; 0: none */
  int       accepted;              /* how many were held in the accepted state; in space b are these first */
  int       n;                     /* how many have their answers to the present tangent */
  int       known;                 /* how many b are motions of this load step */
  PetscBool released;              /* in this load step they take too much force */
  PetscBool firm;                  /* a load step has failed that moved them on: they are held by more friction */
  PetscBool stays;                 /* in this load step moves did not pay: they are held as firmly */
  PetscBool dull;                  /* in this load step or one before they did not */
  PetscReal least;                 /* coefficient of friction that would hold them, after the last move that paid */
  PetscInt  idle;                  /* moves since then */
  PetscInt  steps;                 /* of Newton's method since the last move */
  PetscBool anew;                  /* they are found anew with the next tangent */
  PetscBool futile;                /* in this solve a step went too far, however many motions were held */
  PetscBool ready;                 /* the n motions are those of the step at hand */
  Vec       b[HELD_MOST];          /* displacements of the motions, orthogonal to each other, of length 1 */
  Vec       w[HELD_MOST];          /* answers to the forces b with the present tangent, with the motions before held */
  PetscReal compliance[HELD_MOST]; /* b . w */
  PetscReal force[HELD_MOST];      /* along each of them, of the last residual */
  PetscBool moves;                 /* they move on in the next step */
  PetscBool moving;                /* the step at hand is such a step */
  PetscInt  times;                 /* such steps in this load step */
  PetscBool rested;                /* the force was small enough at the last solution, or there was none yet */
  Vec       last;                  /* the force that held them before the last of them */
  PetscReal bound;                 /* by which that may turn a cell */
  PetscReal turn;                  /* by which it turned one */
  PetscReal friction;              /* coefficient of friction that would hold them at the last solution */
} HeldMotion;

/* Springs against sliding, see ModelDragSolve(). */
typedef struct {
  PetscBool  on;       /* they take the place of held motions */
  PetscReal  length;   /* over which they have the contact force */
  PetscReal *force;    /* n_nodes: contact force by which the spring at a node is stiff; of terms of this rank */
  PetscBool  any;      /* there is such a force, on any rank */
  PetscReal  friction; /* coefficient of friction that would do as much work, at the last solution */
  PetscReal  least;    /* the same, after the last solution that lowered it much in this load step */
  PetscInt   idle;     /* solutions since then */
  Vec at, pull;    /* free displacements of the last solution (length), forces of the springs there; NULL: no springs */
  PetscReal taken; /* energy that the springs have taken in this load step */
} SlidingDrag;

typedef struct _n_ModelWork {
  LinearSolver   solver;
  PetscBool      ordered;       /* the linear solver has chosen the order of its unknowns */
  Vec            residual;      /* of a trial point, for OBJECTIVE_RESIDUAL */
  Vec            step;          /* the whole step that the line search has got last: from x to x - step (length) */
  SNESLineSearch backtracking;  /* PETSc's, for steps that are to be shortened */
  ContactCycle   watch;         /* of the contact set; NULL without contact */
  Extrapolation  extrapolation; /* NULL with small kinematics and no plasticity: bodies move along straight lines */
  PetscReal      damping;       /* of the line search while no contact set repeats itself */

  /* The last tangent */
  PetscInt  tangents;  /* made so far */
  Vec       tangent_x; /* free displacements (length) where it is the derivative of the residual; NULL: unknown */
  PetscReal tangent_t; /* and its load parameter */

  /* The accepted state */
  PetscReal *accepted_u; /* local displacements (length) */
  Vec        accepted_x; /* free displacements (length) */
  PetscReal  accepted_t;
  PetscReal  accepted_start; /* residual norm where Newton's method started in that step; 0: unknown */
  PetscBool  accepted_held;  /* contact lists held at the first solution of that step */
  PetscReal  rate;           /* largest displacement per unit of t in that step */
  PetscBool  settled;        /* bodies were moved into contact there; always at t = 0 */
  PetscBool  searched;       /* it was tried to move them */

  PenaltyError *penalty_error; /* of each pair, once the load is at its end */
  /* Of each pair for penetration, then of each for elastic slip, then of each for the depth of nodes: */
  PetscReal *stiffened_at;    /* its worst estimate when this solve stiffened it for it last; 0: it has not */
  PetscReal *stiffened_by;    /* the factor by which it did; negative: that brought too little, and it stays. For the
                                 depth of nodes it is the negative depth then, in faces */
  PetscReal *accepted_stays;  /* the negative ones of stiffened_by in the accepted state; else 0 */
  PetscBool  weighs_pressure; /* the error of pressures counts in this solve, not on the way alone */

  /* A look-ahead from the accepted state */
  Vec       look_ahead; /* free displacements at look_ahead_t by ModelLookAhead() */
  PetscReal look_ahead_t;
  PetscBool looked_ahead; /* the look-ahead belongs to the accepted state */
  PetscBool look_ahead_extrapolated;

  /* The load step at hand */
  PetscBool adrift;       /* a body that only contact could hold meets none on the way of its load */
  PetscBool extrapolated; /* the prediction started from the extrapolated state */
  PetscBool held;         /* no contact lists were replaced at a solution */
  PetscBool staged;       /* penalties may change after the solution: lists need not settle at it */
  PetscBool unsettled;    /* the last linear step has not found its contact, and may not serve without it */
  PetscBool beyond;       /* because its solution goes farther than the terms were chosen for */
  PetscBool softens;      /* soft penalties are those of all contact, also of what the prediction counted on */
  PetscBool strayed;      /* a step uphill close to an equilibrium was turned round: the solve may end far from there */
  PetscReal jumped;       /* distance by which the last attempt of this step jumped (length); 0: it did not */
  PetscInt  jumps_alike;  /* attempts of this step, up to the last one, that jumped as far as the one before them */
  PetscReal start;        /* residual norm where Newton's method started; 0: it has not started */
  PetscReal energy;       /* the last energy that the line search evaluated; 0: none */
  PetscInt  renewed;      /* times that a slave point slid out of its lists and new lists were made */
  PetscInt  cycles;       /* times that the contact set repeated itself */
  PetscBool augmented;    /* multipliers of the volume were changed at the solution from which the next solve starts */
  char      cycle[256];   /* the last repetition in words */

  PetscBool  foresees;     /* tangents turn the pressures that linear steps lead to */
  PetscBool  extrapolates; /* stresses are extrapolated; the same on all ranks, some of which may have no nodes */
  PetscBool  rubber;       /* so are pressures of volumes of bodies that do not yield */
  PetscReal *solved;       /* local displacements (length) at the last equilibrium, where stresses are extrapolated */
  PetscReal *from;         /* those from which the last step led to the iterate */
  PetscBool  shortened;    /* that step was shortened */
  PetscBool  uphill;       /* all of it was turned round: the next tangent is the derivative of the residual */

  /* One solve by SNES */
  Objective   objective;
  RelaxedStep relaxed;
  ShiftedStep shift;
  HeldMotion  hold;
  SlidingDrag drag;
  PetscReal   norms[LINE_MEMORY]; /* residuals of the last iterates, where there is friction */
  PetscBool   stalled;            /* with friction: the last LINE_MEMORY iterations have hardly lowered the residual */
  PetscBool   soft;               /* penalties are softened: NEWTON_SOFT_ENOUGH is the tolerance */
  PetscBool   loosely;            /* contact lists are checked after the solve, before it goes on to the tolerance */
  PetscInt    nearly;             /* iterations to the first iterate that was solved for loosely; -1: none was yet */
  PetscInt    begun;              /* iterations before, of a solve that goes on */
  PetscBool   balanced;           /* the residual of the iterate is within the tolerance */
  PetscBool   left;               /* the solve ended because a slave point slid out of its lists */
  PetscReal   slack;              /* residual from which on springs of free bodies are relaxed once; 0: they are not */
  PetscBool   cycling;            /* the solve ended because the contact set repeats itself with shorter steps too */
  PetscInt    cuts[CUT_CAUSES];   /* iterations that the line search shortened, by their cause */
  PetscInt    turned;             /* iterations whose step led uphill and was turned round */
  PetscReal   least;              /* with friction: the least residual, or one up to a tenth above it (force) */
  PetscInt    least_at;           /* iteration that found it */
  PetscReal   longest;            /* norm of the longest step (length) */
  PetscInt    nulls;              /* steps in a row of no length beside that */
  PetscInt    crawls;             /* steps in a row of which the line search left next to nothing */
  PetscInt    indefinite;         /* iterations in a row whose tangents were indefinite */
  PetscBool   unstable;           /* the solve ended because they remained so */
  PetscBool   stuck;              /* with friction: it ended because the residual fell no more */
} ModelWork;

/* tangent.c */
PetscErrorCode ModelTangent(Model, const PetscReal *u, const StressReference *, PetscReal t);
PetscErrorCode ModelReleaseTangent(Model);
PetscErrorCode ModelTangentOdd(Model, PetscBool *odd);
PetscErrorCode ModelLinearise(Model, KSP *);
/* heldsolve.c */
PetscErrorCode ModelHeldTakeOut(Model, Vec z);
PetscErrorCode ModelHeldSolve(Model, Vec b, Vec z);
/* softmotion.c */
PetscErrorCode ModelLargestTurn(Model, const PetscReal *u, const PetscReal *v, PetscReal *turn);
PetscErrorCode ModelDropPressures(Model, Vec from, Vec to);
PetscErrorCode ModelSoftMotion(Model, Vec y, Vec v, PetscReal *stiffness, PetscReal *part);
PetscErrorCode ModelSoftPart(Model, Vec y, Vec soft, PetscReal *stiffness);
/* shiftedstep.c */
PetscErrorCode ModelShiftBegin(Model, PetscReal first, PetscReal mean);
PetscErrorCode ModelShiftEnd(Model, PetscReal *taken);
PetscInt       ModelShiftIterations(Model, PetscInt usual);
PetscErrorCode ModelShiftNext(Model, Vec x, PetscInt iteration, PetscReal lambda);
PetscErrorCode ModelShiftLists(Model, Vec x, PetscReal reach);
PetscErrorCode ModelShiftRenew(Model);
PetscErrorCode ModelShiftSolve(Model, const PetscReal *u, Vec x, Vec b, Vec y);
PetscErrorCode ModelShiftStep(Model, Vec x, Vec F, Vec y);
/* heldspace.c */
PetscErrorCode ModelHeldDestroy(HeldMotion *);
void           ModelHeldBegin(Model);
void           ModelHeldFail(Model);
void           ModelHeldBeginSolve(Model);
PetscErrorCode ModelHeldArchive(Model, Archive, const Hdf5Table *nodes);
PetscErrorCode ModelHeldAdd(Model, Vec start, PetscReal *stiffness, PetscReal *part);
PetscErrorCode ModelHeldRefresh(Model, Vec y);
PetscErrorCode ModelHeldOut(Model, Vec);
/* heldfriction.c */
PetscErrorCode ModelHeldFriction(Model, PetscReal *coefficient);
/* heldmotion.c */
PetscErrorCode ModelHoldInStep(Model, Vec y);
PetscErrorCode ModelHoldInColumns(Model, Mat Z);
PetscErrorCode ModelHoldMotion(Model, Vec x, Vec F, Vec y, PetscBool near);
PetscBool      ModelMayRoll(Model);
PetscBool      ModelMayDrag(Model);
PetscErrorCode ModelHeldResidual(Model, Vec F, PetscReal *norm, PetscReal *force);
PetscErrorCode ModelJudgeHeld(Model, PetscBool *holds);
void           ModelReleaseHeld(Model);
/* slidingdrag.c */
PetscErrorCode ModelDragDestroy(SlidingDrag *);
PetscErrorCode ModelDragStart(Model);
PetscErrorCode ModelDragBegin(Model);
PetscErrorCode ModelDragNote(Model);
PetscErrorCode ModelDragArchive(Model, Archive, const Hdf5Table *nodes);
PetscErrorCode ModelDragSolve(Model, SolveReport *);
/* linearcontact.c */
PetscErrorCode ModelResidualAt(Model, Vec x, PetscBool *ok, PetscReal *norm);
PetscErrorCode ModelSolveLinearContact(Model, const PetscReal *u, const PetscReal *carried, PetscReal t, Vec b, Vec y);
/* linecuts.c */
PetscErrorCode ModelCountCut(Model, Vec x);
/* slopesearch.c */
PetscErrorCode ModelSearchSlope(Model, SNESLineSearch, PetscReal slope, PetscReal first, PetscReal *part);
/* relaxedsearch.c */
PetscErrorCode ModelSearchRelaxed(SNESLineSearch, void *model);
/* linesearch.c */
PetscErrorCode ModelCreateLineSearch(Model);
void           ModelChooseObjective(Model, PetscReal residual, PetscReal slope);
PetscErrorCode ModelLocateEdge(Model, PetscBool *found, ContactPlace *);
/* jump.c */
PetscErrorCode ModelFindJump(Model, SolveReport *);
/* stability.c */
PetscErrorCode ModelFindStability(Model, SolveReport *);
/* newton.c */
PetscErrorCode ModelCreateSNES(Model);
PetscErrorCode ModelStepFrom(Model, const PetscReal *u);
PetscErrorCode ModelStepFromSolved(Model, const PetscReal *u);
PetscErrorCode ModelLinearFailure(Model, SolveResult *);
PetscErrorCode ModelNewton(Model, SolveReport *);
/* prediction.c */
PetscErrorCode ModelExtrapolate(Model, PetscReal t, PetscReal *u, Vec x, PetscBool *smooth);
PetscErrorCode ModelPredict(Model, SolveReport *);
PetscErrorCode ModelPredictFar(Model, SolveReport *);
PetscErrorCode ModelFollowLists(Model, SolveReport *);
/* dampedsolve.c */
typedef PetscErrorCode (*ModelStage)(Model, SolveReport *);
PetscErrorCode ModelSolveDamped(Model, ModelStage start, ModelStage solve, SolveReport *);
/* penaltyramp.c */
PetscErrorCode ModelContactOverdone(Model, PetscBool *overdone);
PetscErrorCode ModelRampPenalty(Model, PetscBool all, SolveReport *);
/* penaltyerror.c */
PetscErrorCode ModelCreatePenaltyError(Model);
void           ModelForgetPenaltyError(Model, PetscBool anew);
void           ModelAcceptPenaltyError(Model);
PetscErrorCode ModelArchivePenaltyError(Model, Archive);
PetscErrorCode ModelEstimatePenalty(Model);
PetscErrorCode ModelStiffenDeep(Model, PetscReal factor[], PetscBool *stiffened);
PetscErrorCode ModelStiffen(Model, PetscReal factor[], PetscBool *stiffened);
PetscErrorCode ModelPredictStiffer(Model, const PetscReal factor[], PetscBool estimated, SolveReport *);
PetscErrorCode ModelRaise(Model, const PetscReal factor[]);
PetscErrorCode ModelUnstiffen(Model, const PetscReal factor[], PetscBool forecast);
PetscErrorCode ModelStiffenLess(Model, PetscReal factor[], PetscBool forecast);
