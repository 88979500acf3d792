/* The discrete problem: elasticity, loads and contact behind SNES callbacks, and the state that a step accepts or takes
   back.

   ModelPlace() and ModelSetUp() once, then ModelSolve() finds equilibrium at a load parameter; ModelAccept() makes it
   the state that ModelRestore() returns to. The model knows nothing of step sizes. */
#pragma once
#include "contact/contact.h"
#include "bodies/elasticity.h"
#include "solve/failure.h"
#include "linear/linearcheck.h"
#include "bodies/loads.h"
#include "mesh/mesh.h"

typedef enum {
  SOLVE_CONVERGED,
  SOLVE_ITERATIONS,
  SOLVE_LINE_SEARCH,
  SOLVE_DOMAIN,
  SOLVE_LINEAR,
  SOLVE_WORKSPACE,
  SOLVE_LISTS,
  SOLVE_CYCLE,
  SOLVE_LOST,
  SOLVE_ADRIFT,
  SOLVE_WINDOW,
  SOLVE_NAN
} SolveResult;
extern const char *const SolveResults[]; /* in words, for messages */

typedef struct {
  SolveResult result;
  PetscInt    newton; /* Jacobian solves, prediction and re-gathered solves included */
  PetscInt    krylov;
  PetscInt    regathered;  /* times lists were replaced */
  PetscInt    adjusted;    /* times penalties or multipliers were changed and the step solved on */
  PetscInt    cuts;        /* iterations that the line search shortened */
  PetscReal   residual;    /* |R|_2 / F_ref at the end */
  PetscInt    relaxed;     /* times the springs of stabilised pairs were relaxed and the step solved on */
  PetscReal   taken, left; /* energy that the springs took out on the way; what is left in them at the end, as a part of
                              that in elements and contact */
  PetscInt cycles;         /* times the contact set repeated itself and Newton's steps were shortened */
  char     cycle[256];     /* the last of these: its period and nodes, in gmsh's tags */
  char     detail[256];    /* where it failed, in gmsh's tags */
  Failure  failure;        /* and more of that, if it did */
} SolveReport;

typedef struct _n_Model {
  Scene       scene;
  Mesh        mesh;
  Elasticity  elasticity;
  Loads       loads;
  Contact     contact; /* NULL: the scene has none */
  SNES        snes;
  LinearCheck linear; /* of the solver's KSP */
  Vec         x;      /* free displacements */
  Mat         A;      /* K + C: P, or an operator of its own where factors take contact as a border */
  Mat         P;      /* K + C or K; the elasticity's */
  PetscReal  *u;      /* n_nodes*dim local displacements, prescribed ones included, at load parameter t */
  PetscReal   t;
  PetscReal   force_scale; /* F_ref of the accepted states: the largest norm so far of the unassembled internal, contact
                              and external forces */
  struct _n_ModelWork *work;
} *Model;

PetscErrorCode ModelCreate(Scene, Mesh, Model *);
PetscErrorCode ModelDestroy(Model *);
/* First contact lists and gaps, the state at t = 0; lists are good for a step to t. Collective. */
PetscErrorCode ModelPlace(Model, PetscReal t);
/* The tangent of the present state. Collective. */
PetscErrorCode ModelAssemble(Model);
/* Refusal of initial overlaps, the state at t = 0 accepted. Collective. */
PetscErrorCode ModelSetUp(Model);
PetscErrorCode ModelSolve(Model, PetscReal t, SolveReport *);
/* Where one linear solve, for which the accepted state's contact stays as it is, leads at t: u[n_nodes*dim], the state
   is not changed. Its solve is added to the report. The contact lists are those of the way to t. */
PetscErrorCode ModelLookAhead(Model, PetscReal t, PetscReal *u, SolveReport *);
PetscErrorCode ModelGetAccepted(Model, const PetscReal **u, PetscReal *t);
PetscErrorCode ModelAccept(Model);
PetscErrorCode ModelRestore(Model);
/* The accepted state and all else that the next steps depend on; loading takes the place of ModelSetUp(). Collective.
 */
PetscErrorCode ModelArchive(Model, Archive);
/* The force that supports and imposed displacements put on the nodes of a group, at the accepted state. Collective. */
PetscErrorCode ModelReaction(Model, const MeshGroup *, PetscReal force[3]);
PetscErrorCode ModelEffects(Model, char *text, size_t size); /* "finite strain, facet contact": what is on */
PetscErrorCode ModelDofs(Model, PetscInt *free_dofs);
PetscBool      ModelIsLinear(Model); /* one linear solve is the answer */
