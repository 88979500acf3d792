/* The nonlinear solver of a problem: it finds equilibrium at a load parameter t, starting from the state that was
   accepted last, and accepts the new state or takes it back.

   ModelCreate(), ModelPlace() and ModelSetUp() are called once, in this order; ModelArchive() with an archive that
   loads takes the place of ModelSetUp(). ModelSolve() finds equilibrium at t, ModelSolveSlowly() with shifted
   tangents where that fails. ModelAccept() makes it the accepted state, ModelCertify() judges the step to it before.
   ModelRestore() returns to the accepted state. ModelChangeSupports() comes between two steps. The model does not know
   step sizes; src/step chooses them. */
#pragma once
#include "certificate/certificate.h"
#include "linear/linearcheck.h"
#include "solve/energybalance.h"
#include "solve/failure.h"
#include "solve/problem.h"

/* An equilibrium counts as unstable that gives more than this part of its energy away over a turn by 0.1. Rings that
   would roll on give less, and where they lie changes no force. */
#define MODEL_GIVES 1e-2

typedef enum {
  SOLVE_CONVERGED,
  SOLVE_ITERATIONS,
  SOLVE_STALLED,
  SOLVE_LINE_SEARCH,
  SOLVE_DOMAIN,
  SOLVE_LINEAR,
  SOLVE_WORKSPACE,
  SOLVE_LISTS,
  SOLVE_CYCLE,
  SOLVE_LOST,
  SOLVE_UNCERTIFIED,
  SOLVE_ADRIFT,
  SOLVE_WINDOW,
  SOLVE_VOLUME,
  SOLVE_FLUID,
  SOLVE_LEAK,
  SOLVE_LEAKED,
  SOLVE_TURNED,
  SOLVE_FACING,
  SOLVE_FAR,
  SOLVE_ROUTINE,
  SOLVE_JUMP,
  SOLVE_UNSTABLE,
  SOLVE_NAN
} SolveResult;
extern const char *const SolveResults[]; /* in words, for messages */

/* Why the line search shortened a step. Over the whole step an element would have been inverted; or this part of the
   energy would have risen most: that of the volume where the law has one, the rest of the strain energy, contact,
   loads; or the norm of the residual would have risen. The last: the contact set had repeated itself. */
typedef enum {
  CUT_INVERTED,
  CUT_VOLUME,
  CUT_SHAPE,
  CUT_CONTACT,
  CUT_LOADS,
  CUT_RESIDUAL,
  CUT_CYCLE,
  CUT_CAUSES
} CutCause;
extern const char *const CutCauses[]; /* in words */

typedef struct {
  SolveResult result;
  PetscInt    newton;           /* linear solves, those of the prediction and of repeated solves included */
  PetscInt    first;            /* those of them until the first solution; until lists settle if once is not enough */
  PetscInt    krylov;           /* iterations of these linear solves */
  PetscInt    regathered;       /* times that contact lists were replaced */
  PetscInt    adjusted;         /* times that penalties or multipliers were changed and the step solved on */
  PetscInt    stiffened;        /* times that penalties were made stiffer for a smaller error, and the step solved on */
  PetscInt    deep;             /* times that they were because nodes stood deep in faces */
  PetscInt    wetted;           /* times that a fluid moved and the step was solved on */
  PetscInt    cuts[CUT_CAUSES]; /* iterations that the line search shortened, by their cause */
  PetscInt    turned;           /* iterations whose step led uphill and was turned round */
  PetscReal   residual;         /* |R|_2 / F_ref at the end */
  PetscInt    relaxed;          /* times that the contact springs were relaxed and the step solved on */
  PetscReal   taken;            /* energy that the contact springs took out of the bodies in this step */
  PetscReal   left;             /* energy left in the contact springs, over that in elements and contact */
  PetscReal   share;            /* norm of the forces left in the contact springs, over F_ref */
  PetscReal   tied;             /* largest force in a tie, over F_ref */
  PetscReal   unstable;   /* least stiffness of a tied motion, over that of its body, turned; 0: none is below 0 */
  PetscReal   friction;   /* coefficient of friction that would hold the soft motions that are held; 0: none is */
  PetscInt    motions;    /* soft motions that are held */
  PetscInt    cycles;     /* times that the contact set repeated itself and Newton's steps were shortened */
  char        cycle[256]; /* the last repetition: its period and nodes, in gmsh's tags */
  PetscInt    damped;     /* 1: tangents were shifted */
  PetscInt    negatives;  /* negative eigenvalues of the tangent at the end, see ModelFindStability(); -1: not known */
  PetscReal   gives;      /* energy that such a motion gives, over what is stored, see ModeGives(); INFINITY: unknown */
  PetscReal   damping;    /* energy that was taken away then */
  char        jump[256];  /* the node that jumped to another equilibrium, and how far; empty: none did */
  PetscReal   facing;     /* SOLVE_FACING: turn of surfaces that lie opposite each other (radians) */
  PetscReal   far;        /* SOLVE_FAR: turn of cells in the first linear step, over the largest one */
  PetscReal   excess;     /* SOLVE_UNCERTIFIED: depth over what is allowed; INFINITY: it is no depth */
  char        detail[640]; /* where a failed solve failed, in gmsh's tags */
  Failure     failure;     /* more about a failed solve */
} SolveReport;

/* What penetration leaves of error in the present state, estimated: parts of the present values. */
typedef struct {
  PetscReal force;             /* of the sum of a pair's nodal forces; NaN: not estimated */
  PetscReal pressure;          /* of its mean pressure, nodes weighted by their forces */
  PetscReal peak;              /* of its largest pressure; where pressures scatter, that of the scatter too */
  PetscReal displacement;      /* of the largest displacement in the model */
  PetscReal slip_force;        /* by elastic slip: of the sum of a pair's forces by friction, or of its normal ones */
  PetscReal slip_displacement; /* by elastic slip: of the largest displacement */
} PenaltyError;
#define PENALTY_ERROR_VALUES 6

typedef struct _n_Model {
  Problem       problem;
  Scene         scene;   /* of the problem */
  Mesh          mesh;    /* of the problem */
  Contact       contact; /* of the problem; NULL: the scene has none */
  SNES          snes;
  LinearCheck   linear; /* of the solver's KSP */
  Vec           x;      /* free displacements (length) */
  PetscReal    *u;      /* local displacements u[n_nodes*dim] (length) at load parameter t, prescribed ones included */
  PetscReal     t;
  EnergyBalance balance; /* NULL: no body is plastic, and no step is judged */
  PetscReal most_facing; /* turn (radians) of surfaces opposite each other above which ModelSolve() does not begin */
  PetscBool doubts;      /* the step has failed before, and a restraint may help: ModelSolve() ends where tangents stay
                            indefinite */
  PetscBool shortens; /* ModelSolve() does not begin where the first linear step goes too far and pieces do not help */
  Certificate          certificate; /* NULL: there is no contact, or the scene switches it off */
  struct _n_ModelWork *work;
} *Model;

/* Says whether a solve was given up before Newton's method began, for a shorter step. */
static inline PetscBool SolveHasNotBegun(SolveResult result)
{
  return (PetscBool)(result == SOLVE_FACING || result == SOLVE_FAR);
}

PetscErrorCode ModelCreate(Scene, Mesh, Model *);
PetscErrorCode ModelDestroy(Model *);
PetscErrorCode ModelPlace(Model, PetscReal t);
PetscErrorCode ModelAssemble(Model);
PetscErrorCode ModelSetUp(Model);
PetscErrorCode ModelSolve(Model, PetscReal t, SolveReport *);
PetscErrorCode ModelSolveSlowly(Model, PetscReal t, SolveReport *);
PetscErrorCode ModelLookAhead(Model, PetscReal t, PetscReal *u, SolveReport *);
PetscErrorCode ModelGetAccepted(Model, const PetscReal **u, PetscReal *t);
PetscErrorCode ModelCertify(Model, SolveReport *);
PetscErrorCode ModelAccept(Model);
PetscReal      ModelRate(Model);
PetscErrorCode ModelRestore(Model);
PetscErrorCode ModelArchive(Model, Archive);
PetscErrorCode ModelChangeSupports(Model, PetscBool *changed);
PetscErrorCode ModelEffects(Model, char *text, size_t size);
PetscErrorCode ModelDofs(Model, PetscInt *free_dofs);
PenaltyError   ModelPenaltyError(Model, int pair);
PetscBool      ModelPenaltyStays(Model, int pair);
