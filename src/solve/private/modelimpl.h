/* What the files of the model share and nobody else sees: model.c holds the state, newton.c finds equilibrium with the
   lists that are there, equilibrium.c is the way from an accepted state to the next one, prediction.c and softstart.c
   parts of it; settle.c makes the contact of their linear steps right. */
#pragma once
#include "contact/contactcycle.h"
#include "contact/contactline.h"
#include "linear/linearsolver.h"
#include "solve/model.h"
#include "extrapolation.h"
#include "contact/contactsprings.h"

/* Times that contact lists are replaced and the step solved on before it counts as unsettled. */
#define MODEL_MAX_REGATHER 8
/* Round-off of the residual, in machine epsilons times stiffness times displacement: a body that is moved without any
   force has nothing else to be measured against. Measured: 0.1 to 1.5. */
#define MODEL_ROUND_OFF 16

typedef struct _n_ModelWork {
  LinearSolver   solver;
  PetscBool      ordered; /* it has chosen its ordering */
  PetscReal     *f;       /* local residual of the last evaluation, all dofs */
  PetscReal     *trial;   /* local displacements of the last evaluation */
  PetscReal     *accepted_u;
  Extrapolation  extrapolation; /* NULL: small kinematics, whose bodies go straight */
  Vec            accepted_x;
  PetscReal      accepted_t;
  Vec            look_ahead; /* x at look_ahead_t by ModelLookAhead() */
  PetscReal      look_ahead_t;
  PetscBool      looked_ahead; /* and is one from the accepted state */
  PetscBool      extrapolated; /* the last prediction, or the way to a forecast, started from where the path leads to */
  PetscBool      look_ahead_extrapolated; /* so did the forecast */
  PetscReal      expected;                /* motion that the lists of this step were made for */
  PetscReal      rate;                    /* largest displacement per unit of t in the last accepted step */
  PetscReal      scale;                   /* force norm of the last evaluation */
  PetscReal      stiffness;               /* norm of the elastic tangent's diagonal */
  PetscInt       inverted;       /* gmsh's tag of a cell of this rank that was turned inside out in this solve, or -1 */
  PetscBool      near;           /* the iterate is so close that energies differ by round-off only */
  PetscBool      soft;           /* penalties are softened: a residual within MODEL_SOFT_ENOUGH will do */
  PetscReal      energy;         /* the last one that was evaluated in this step, 0: none was */
  PetscReal      step;           /* norm of Newton's last step, before the line search */
  PetscReal      norm;           /* residual of the iterate before */
  PetscReal      start;          /* residual where Newton started in this step, 0: it has not yet */
  PetscReal      accepted_start; /* the same in the last accepted step, 0: unknown */
  PetscBool      balanced;       /* the residual of the iterate is within the tolerance */
  PetscInt       renewed;        /* how often that happened in this step */
  PetscBool      cycling;        /* the contact set repeats itself whatever the steps: the solve ended */
  PetscInt       cycles;         /* times it repeated itself in this load step */
  char           cycle[256];     /* the last one in words */
  PetscReal      damping;        /* of the line search when nothing repeats */
  PetscBool      left;           /* a slave point slid out of its lists: the solve ended for new ones */
  PetscInt       cuts;           /* iterations of the last Newton solve that the line search shortened */
  Vec            residual;       /* of a trial point, while near; the tangent's diagonal for a moment */
  ContactSprings stabiliser;     /* NULL: no pair asks for it */
  ContactCycle   watch;          /* of the contact set; NULL: no contact */
  ContactLine    line;           /* contact along a Newton step; NULL: no contact */
} ModelWork;

/* model.c */
PetscBool ModelHasFormulation(Scene, Formulation); /* has some deformable body elements of that kind? */
/* newton.c */
PetscErrorCode ModelResidual(Model, const PetscReal *u, PetscReal t, PetscReal t_contact, PetscBool *ok);
PetscErrorCode ModelTrial(Model, Vec x); /* free displacements x and the prescribed ones into work->trial */
PetscErrorCode ModelTangent(Model, const PetscReal *u, PetscReal t);
PetscErrorCode ModelRoundOff(Model,
                             PetscReal *force); /* what round-off leaves of the residual at the trial displacements */
PetscErrorCode ModelCreateSNES(Model);
PetscErrorCode ModelLinearFailure(Model, SolveResult *); /* why the last linear solve failed */
PetscErrorCode ModelNewton(Model, SolveReport *);        /* SNES once, from model->x; adds what it cost */
/* linesearch.c */
PetscErrorCode ModelCreateLineSearch(Model); /* what the SNES's line search does where contact cuts a step */
PetscErrorCode ModelLocateEdge(Model, PetscBool *found,
                               ContactPlace *); /* does a failed iterate rest on an edge between facets? */
/* settle.c */
PetscErrorCode ModelSolveLinearContact(Model, const PetscReal *u, const PetscReal *carried, PetscReal t,
                                       Vec y); /* a linear step y whose contact is right where it ends */
/* prediction.c */
PetscErrorCode ModelExtrapolate(Model, PetscReal t, PetscReal *u, Vec x,
                                PetscBool *smooth);                    /* where the way so far leads to */
PetscErrorCode ModelInOrder(Model, const PetscReal *u, PetscBool *ok); /* can elements and contact lists be there? */
PetscErrorCode ModelPredict(Model, SolveReport *);                     /* model->x at model->t by one linear solve */
PetscErrorCode ModelPredictFar(Model, SolveReport *);                  /* in pieces, where that is too far */
PetscErrorCode ModelFollowLists(Model,
                                SolveReport *); /* a linear step that holds contact while its lists are other ones */
/* softstart.c */
PetscErrorCode ModelRampPenalty(
  Model, SolveReport *); /* from the prediction to where what touches is known, on softened penalties */
/* equilibrium.c */
PetscErrorCode ModelRenewLists(Model, PetscBool update_offsets,
                               PetscBool *hold); /* new lists after a solve, for the next one */
PetscErrorCode ModelMotion(Model, const PetscReal *u, PetscReal t,
                           PetscReal *motion); /* largest one between the accepted state and (u, t) */
PetscErrorCode ModelImposedMotion(Model, PetscReal t,
                                  PetscReal *motion); /* of what is prescribed, and of rigid tools */
