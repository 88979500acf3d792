/* Fluids between surfaces: what fluid.c (places, load, fronts, leaks), fluidmaster.c (masters that deform) and
   fluidfacing.c (where slaves keep fluids from masters) share. */
#pragma once
#include "search/surfacegraph.h"
#include "solve/fluid.h"

/* Pressures that differ by less than this part of the fluid's are the same. It is above what the tolerance of the
   solver leaves, and far below what matters. */
#define FLUID_SAME 1e-6
/* Formulas are tried at the ends of so many intervals of t. */
enum { FLUID_SAMPLES = 16 };
/* The last accepted states before a leak, from which its pressure is extrapolated */
enum { FLUID_STATES = 2 };

/* How a pair measures contact: at nodes, with the areas of shape functions, or on faces, with those of hat functions */
enum { FLUID_NODES, FLUID_FACES, FLUID_FORMS };

/* What a fluid is in one state. It is what cutbacks and checkpoints keep. */
typedef struct {
  char      *wet, *form;             /* n: by node of the graph; form: of the pair that presses most */
  PetscReal *p;                      /* n: what contact alone presses; 0 where it presses less than the fluid there */
  PetscReal *react;                  /* n: pressure of the reactions of dry places; 0 on slaves alone */
  PetscInt   n_sealed;               /* accepted states without a leak, FLUID_STATES at most */
  PetscReal  sealed_p[FLUID_STATES]; /* pressure of the fluid in them, the last one first */
  PetscReal  barrier[FLUID_STATES];  /* and the pressure with which it would have leaked */
} FluidState;

typedef struct {
  int              number; /* of the load in the scene */
  const SceneLoad *load;
  const MeshGroup *group;
  SurfaceGraph     surface;
  int              finer;             /* rule of contact on faces, see FaceRuleGet() */
  PetscBool       *pair;              /* pairs whose slaves are on the surface */
  PetscBool       *reacts;            /* pairs whose masters are on it and deform: their forces on it are reactions */
  PetscBool        form[FLUID_FORMS]; /* how they measure contact */
  PetscBool        friction;          /* one of the slave's pairs has friction */
  PetscBool        master;            /* the surface is a master that deforms */
  PetscBool        deforms;           /* one of their masters deforms, or the surface is such a master */
  char            *from, *to;         /* n: the two ends */
  PetscBool        has_from, has_to;
  FluidState       now, accepted;
  char            *laid;       /* n: where the fluid's load lies: wet places and those ahead */
  char            *lubricated; /* n: places that were wet in this step: friction has what contact presses there */
  char            *bears;      /* n: where the load belongs: wet places, and on masters those beside them */
  PetscBool        shut;       /* no place was wet any more in this step */
  PetscBool        drained;    /* its load was taken from places that were dry again in this step */
  PetscReal       *area[FLUID_FORMS];                    /* n_nodes: present area of the surface around each node */
  PetscReal       *wet, *dry, *pressing, *pressing_form; /* n_nodes: of the state, by local node; dry: laid alone */
  PetscReal       *nodes, *points;                       /* shares for the load, see LoadsSetShares() */
  PetscReal       *force[FLUID_FORMS];                   /* n_nodes: of the contact terms */
  PetscReal       *share;                                /* n: part of the fluid's load that lies there */
  PetscReal       *weight;                               /* n: reference area of the nodes */
  PetscReal        pressure, height;                     /* of the fluid; of the barrier */
  PetscReal        leak_t, leak_pressure; /* t and pressure at which it was found to leak last; NaN: it was not */
} Fluid;

struct _n_Fluids {
  Mesh    mesh;
  Scene   scene;
  Loads   loads;
  Contact contact;
  int     n, *order; /* fluids on slaves alone come first in it: those on masters look at them */
  Fluid  *fluid;
};

ElementType    FluidFacePlaces(Fluids, const Fluid *, PetscInt face, const PetscReal *u, PetscInt *nodes, PetscReal *x);
PetscErrorCode FluidFindMasters(Fluids, Fluid *);
PetscErrorCode FluidCheckMasters(Fluids, Fluid *);
PetscErrorCode FluidFaceSlaves(Fluids, Fluid *, const PetscReal *u);
PetscBool      FluidOpen(const Fluid *, PetscReal pressure);
PetscErrorCode FluidMeasureReactions(Fluids, Fluid *, const PetscReal *u);
PetscReal      FluidShare(const Fluid *, int i);
PetscBool      FluidShareChanges(const Fluid *, int i);
