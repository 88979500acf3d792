/* The discrete problem of a scene: elements, loads and contact together, evaluated at displacements u and a load
   parameter t.

   ProblemCreate() makes the parts. ProblemResidual(), ProblemEnergy() and ProblemTangent() evaluate them;
   ProblemCollectResidual() hands the residual to a solver. ProblemGatherLists() makes the contact lists for a way from
   one state to another, ProblemRenewLists() replaces them on that way. ProblemMotion() and ProblemImposedMotion() say
   how far the bodies move between two states, ProblemRoundOff() what rounding leaves of the residual. The problem knows
   no solver, no iteration and no accepted state: its callers pass both states in. */
#pragma once
#include "bodies/elasticity.h"
#include "bodies/loads.h"
#include "contact/contact.h"
#include "contact/contactsprings.h"
#include "solve/damping.h"
#include "solve/fluid.h"
#include "solve/freebodies.h"

/* Round-off of the residual in machine epsilons times stiffness times displacement. A body that is moved without any
   force has no other scale for its residual. The measured factor is 0.1 to 1.5. */
#define PROBLEM_ROUND_OFF 16
/* No dof is stiffer in that estimate than this multiple of what it is in the undeformed state. Rubber at half or twice
   its length is some 10 times stiffer. Elements about to be inverted are stiffer without bound, and would let residuals
   pass that are no round-off. */
#define PROBLEM_STIFFENING 100
/* Contact lists are made for this multiple of the expected motion, which follows from the rate of the last step. Lists
   that replace others after a step are made for the same multiple, so that they serve an equal next step. */
#define PROBLEM_MOTION_SAFETY 1.5

/* How the tangent K + C of elements and contact is kept. Joined: in the one matrix P, which is A too. Bordered: P holds
   K alone and A is the operator K + C, for a solver that takes contact as a border of the factor of K. */
typedef enum { TANGENT_JOINED, TANGENT_BORDERED } TangentForm;

/* The parts of the potential energy that ProblemEnergy() may sum. */
enum {
  ENERGY_ELASTIC   = 1,
  ENERGY_LOADS     = 2,
  ENERGY_CONTACT   = 4,
  ENERGY_VOLUME    = 8, /* a part of ENERGY_ELASTIC, see ElasticLaw */
  ENERGY_POTENTIAL = ENERGY_ELASTIC | ENERGY_LOADS | ENERGY_CONTACT
};

/* What the last ProblemTangent() changed, for a solver that has the factor of an earlier tangent. */
typedef struct {
  Mat       C;       /* the contact part, owned by the contact; NULL without contact */
  PetscBool pattern; /* P has a new pattern */
  PetscInt  terms;   /* contact terms that came, went or changed their stiffness */
} TangentChange;

typedef struct _n_Problem {
  Scene          scene; /* borrowed */
  Mesh           mesh;  /* borrowed */
  Elasticity     elasticity;
  Loads          loads;
  Contact        contact; /* NULL: the scene has none */
  Fluids         fluids;  /* that enter between surfaces; NULL: there are none */
  FreeModes      modes;   /* rigid motions that supports leave to the bodies */
  FreeBodies     bodies;  /* that contact is to hold; NULL: there are none */
  ContactSprings springs; /* of these bodies; NULL: there are none */
  DofSprings     damping; /* of solves with shifted tangents; NULL: there was none yet */
  DofSprings     drag;    /* against sliding; NULL: there was none yet */
  PetscBool      tied;    /* other motions are tied than in the last tangent */
  TangentForm    form;
  Mat            A;            /* K + C */
  Mat            P;            /* K + C or K, see TangentForm; owned by the elasticity */
  Vec            diagonal;     /* of the elastic tangent, during its evaluation */
  Vec            undeformed;   /* diagonal of the elastic tangent in the undeformed state */
  PetscReal     *f;            /* local residual of the last evaluation (force), all dofs */
  PetscReal     *trial;        /* local displacements of the iterate (length), prescribed ones included */
  PetscReal      force;        /* norm of the forces in the last residual, before assembly */
  PetscReal      force_so_far; /* largest such norm of all accepted states */
  PetscReal      stiffness;    /* 2-norm of the diagonal of the elastic tangent, see PROBLEM_STIFFENING */
  PetscReal      edge;         /* shortest edge of a cell (length) with finite strains, else 0 */
  PetscReal      expected;     /* motion (length) that ProblemGatherLists() made the contact lists for */
  PetscInt       inverted;     /* gmsh's tag of a cell of this rank that a residual found inverted, or -1 */
  int            fault;        /* of the routine of the user in that cell, for UmatTell() */
} *Problem;

PetscErrorCode ProblemCreate(Scene, Mesh, PetscInt phase, Problem *);
PetscErrorCode ProblemDestroy(Problem *);
PetscErrorCode ProblemDisplacements(Problem, Vec x, PetscReal t, PetscReal *u);
PetscErrorCode ProblemSetTrial(Problem, Vec x, PetscReal t);
PetscErrorCode ProblemResidual(Problem, const PetscReal *u, PetscReal t, PetscReal t_contact, PetscBool *ok);
PetscErrorCode ProblemCollectResidual(Problem, Vec x, Vec F);
PetscErrorCode ProblemEnergy(Problem, const PetscReal *u, PetscReal t, int parts, PetscReal *energy, PetscBool *ok);
PetscErrorCode ProblemSetForm(Problem, TangentForm);
PetscErrorCode ProblemTangent(Problem, const PetscReal *u, const StressReference *, PetscReal t, TangentChange *);
PetscErrorCode ProblemRestoreTangent(Problem);
PetscReal      ProblemForceScale(Problem);
PetscErrorCode ProblemRoundOff(Problem, PetscReal *force);
PetscErrorCode ProblemMotion(Problem, const PetscReal *u_0, PetscReal t_0, const PetscReal *u, PetscReal t,
                             PetscReal *motion);
PetscErrorCode ProblemImposedMotion(Problem, const PetscReal *u_0, PetscReal t_0, PetscReal t, PetscReal *motion);
PetscErrorCode ProblemInOrder(Problem, const PetscReal *u_0, PetscReal t_0, const PetscReal *u, PetscReal t,
                              PetscBool *ok);
PetscErrorCode ProblemGatherLists(Problem, const PetscReal *u, PetscReal t, PetscReal t_next, PetscReal motion);
PetscErrorCode ProblemRenewLists(Problem, const PetscReal *u_0, PetscReal t_0, PetscReal t, PetscBool left,
                                 PetscReal lag, PetscBool passing, PetscBool *hold);
PetscErrorCode ProblemReaction(Problem, const MeshGroup *, PetscReal force[3], PetscReal moment[3]);
PetscErrorCode ProblemBoltForce(Problem, const char *body, PetscReal *force);
PetscBool      ProblemIsLinear(Problem);
PetscBool      ProblemIsPlastic(Problem);
PetscBool      ProblemConservative(Problem);
PetscBool      ProblemHasFormulation(Problem, Formulation);
