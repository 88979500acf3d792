/* Every value a user can write, validated, with defaults; the only reader of YAML. Knows no PETSc objects but the
   communicator.

   SceneRead() reads the file on rank 0, applies the -set overrides, validates every key against the one table of
   schemakeys.c and refuses the first mistake (file, line, key, what is wrong, what is allowed). Checks that need the
   mesh are made later by the part that owns them; their messages start with SceneWhere(). */
#pragma once
#include <petscsys.h>
#include "smooth/analyticsurface.h"
#include "base/choices.h"
#include "kernels/formulation.h"
#include "kernels/material.h"
#include "scene/loadhistory.h"

typedef enum { OVERLAP_REFUSE, OVERLAP_RESOLVE, OVERLAP_RAMP, OVERLAP_IGNORE } InitialOverlap;
typedef enum { SOLVER_DIRECT, SOLVER_ITERATIVE, SOLVER_AUTO } SolverType;
typedef enum { CONTACT_NODE_TO_SURFACE, CONTACT_SURFACE_TO_SURFACE } ContactFormulation;

typedef struct {
  char       *path;  /* "bodies.0": for SceneWhere() */
  char       *name;  /* physical group: a volume, or for a rigid tool a surface */
  int         rigid; /* a meshed rigid tool: no material */
  Material    material;
  Formulation formulation; /* other than full: quad4 and hex8 only */
  Motion      motion;
} SceneBody;

typedef struct {
  char *path, *surface;
  int   fixed[3]; /* component held at 0 */
} SceneSupport;

typedef enum { LOAD_DISPLACEMENT, LOAD_PRESSURE, LOAD_TRACTION, LOAD_BODY_FORCE } LoadKind;
typedef struct {
  char    *path, *region; /* region: physical surface, for a body force physical volume */
  LoadKind kind;
  int      has[3];   /* LOAD_DISPLACEMENT: which components are imposed */
  double   value[3]; /* displacement, traction or body force; pressure in value[0] */
  int      follower; /* pressure acts on the deformed face */
  History  history;
} SceneLoad;

typedef struct {
  char              *path, *name, *slave, *master; /* master: physical surface, or NULL: analytic */
  AnalyticSurface    analytic;                     /* with motion.point: on the plane, on the axis, the centre */
  Motion             motion;
  int                smoother; /* index of Smoothers[] */
  ContactFormulation formulation;
  int                live_offset; /* of surface_to_surface: offsets follow the nodes within a solve */
  int                n_symmetry;
  char             **symmetry;        /* planar surfaces beyond which the model continues as its mirror image */
  int                degree;          /* of the fit: 4 or 2 */
  double             support, weight; /* spacings, exponent; 0: the default of dimension and degree */
  int                global_frame, diffuse_derivatives;
  double             feature_angle; /* degrees */
  InitialOverlap     initial_overlap;
  int                stabilise; /* springs hold its bodies until contact does */
  ContactLawKind     law;
  int                penalty_auto;
  double penalty, penalty_scale; /* force per length and area; the automatic value is multiplied by penalty_scale */
  int    adjust;                 /* the penalty follows the penetration */
  int    adjust_converged;       /* within the step, until the window holds; 0: from one step to the next */
  int    window_in_spacings;     /* g_min and g_max are multiples of the slave node's face size, not lengths */
  double g_min, g_max, clamp, range;
  int    augment,
    max_updates; /* pressures become multipliers, up to so often in a step, until penetrations are within g_max */
} SceneContact;

typedef enum {
  PROBE_REACTION,
  PROBE_CONTACT_FORCE,
  PROBE_DISPLACEMENT,
  PROBE_DISTANCE,
  PROBE_GAP,
  PROBE_CONTACT_EDGE,
  PROBE_PRESSURE_MAX,
  PROBE_PRESSURE_MEAN,
  PROBE_PRESSURE_DEVIATION,
  PROBE_KINDS
} ProbeKind;
typedef struct {
  char     *path, *name;
  ProbeKind kind;
  char     *target;      /* surface (reaction) or pair (contact kinds), else NULL */
  char     *body;        /* volume, or NULL */
  int       component;   /* 0..2 */
  double    point[2][3]; /* reference coordinates: displacement, distance, gap */
  int       axis;        /* contact_edge: 0..2 */
  int       max_side;    /* contact_edge: 1 max, 0 min */
  int has_at; /* contact_edge, pressure_max: restricted to nodes whose reference coordinate at_axis equals at_value */
  int at_axis;
  double at_value;
  int    rms; /* pressure_deviation: 1 rms, 0 max */
  int
    edge_filter; /* pressure_deviation: 0 none, 1 excluding, 2 only, within edge_faces mean face sizes of a free edge */
  double edge_faces;
  int    change; /* distance: minus the reference distance */
  int    absolute;
  double factor;
} SceneProbe;

typedef struct {
  char *key, *value; /* key without the dash */
} ScenePair;

typedef struct {
  char         *file, *directory; /* as given; the directory relative paths start at */
  char         *text; /* the document after -set, as one canonical YAML text: to recognise another scene's results */
  char         *name;
  char         *mesh_file; /* path as the process can open it */
  int           order;     /* 1, 2; 0: take the .msh file's own */
  int           n_parameters;
  ScenePair    *parameters; /* of the .geo */
  Geometry      geometry;
  Kinematics    kinematics;
  int           dim; /* 3 for solid, else 2 */
  int           n_bodies;
  SceneBody    *bodies;
  int           n_supports;
  SceneSupport *supports;
  int           n_loads;
  SceneLoad    *loads;
  int           n_contacts;
  SceneContact *contacts;
  struct {
    StepControlKind control;
    double          initial, dt_min, dt_max, growth;
    int             N_c;              /* contact: nodes per step; 0: N_c_fraction serves */
    double          N_c_fraction;     /* contact: part of the slave area per step */
    int             predict_linearly; /* contact: by one linear solve, not by the step's own solution */
    int             n_at;
    double         *at;
  } stepping;
  struct {
    SolverType type;
    double     tolerance;
    int        max_iterations;
  } solver;
  int         n_probes;
  SceneProbe *probes;
  struct {
    int every;                         /* 0: only the last state */
    int checkpoint;                    /* 0: only when the run ends early */
    int displacement, stress, contact; /* fields */
  } output;
  int        n_petsc;
  ScenePair *petsc;    /* PETSc options of the scene */
  void      *document; /* private: the document's tree with its marks (document.h), for SceneWhere() */
} *Scene;

PetscErrorCode SceneRead(MPI_Comm, const char *file, int n_set, char *const *set, Scene *);
/* The scene of a checkpoint: file: its name then; where: stands for it in messages; text: Scene.text of then. Only
 * solver, output and stepping may be set. */
PetscErrorCode SceneReadAgain(MPI_Comm, const char *file, const char *where, const char *text, int n_set,
                              char *const *set, Scene *);
PetscErrorCode SceneDestroy(Scene *);
/* Do two texts (Scene.text) differ in nothing but what a restart may change? */
PetscBool SceneSameProblem(const char *a, const char *b);
/* "runs/a.yaml:12: contact.0.slave": the place of a key (or of its nearest ancestor that the file has; "-set KEY" if it
   came from there). Returned text belongs to the scene and is valid until the next call. */
const char *SceneWhere(Scene, const char *path, const char *key);
/* Does some history have a breakpoint at t? */
PetscBool SceneBreaks(Scene, PetscReal t);
/* the scene reference: every key with type, range, unit, default and help, generated from the table */
PetscErrorCode SceneReference(FILE *);
