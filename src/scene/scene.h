/* The scene: every value that a user can write, validated and with its default. This is the only reader of YAML, and it
   uses no PETSc object but the communicator.

   SceneRead() reads the file on rank 0, applies the -set overrides and validates every key against the table of
   schemakeys.c. It refuses the first mistake with file, line, key, what is wrong and what is allowed. SceneReadAgain()
   reads the scene of a checkpoint, and SceneSameProblem() tells whether a restart may continue results of another text.
   Reading loads and runs nothing: SceneLoadRoutines() loads the libraries of users that the scene names.
   Checks that need the mesh are made later by the part that owns them. Their messages start with SceneWhere().
   SceneBreaks() tells the step control where loads change their rate, SceneStepAt() the name of the step at t, and
   SceneStepFrom() the number of the one that follows. SceneSupportsChange() and SceneHolds() tell about supports.
   SceneReference() prints the scene reference. */
#pragma once
#include <petscsys.h>
#include "smooth/analyticsurface.h"
#include "base/choices.h"
#include "kernels/formulation.h"
#include "kernels/material.h"
#include "scene/expression.h"
#include "scene/loadhistory.h"

/* OVERLAP_ADD is refuse with an overlap of its own besides that of the meshes. */
typedef enum { OVERLAP_REFUSE, OVERLAP_RESOLVE, OVERLAP_RAMP, OVERLAP_IGNORE, OVERLAP_ADD } InitialOverlap;
typedef enum { STABILISE_AUTO, STABILISE_TRUE, STABILISE_FALSE } Stabilise;
typedef enum { SOLVER_DIRECT, SOLVER_ITERATIVE, SOLVER_AUTO } SolverType;
/* Number of unknowns in space above which SOLVER_AUTO iterates. Two thick rings of first-order bricks take equal CPU
   time at 16,000 unknowns; at 120,000 iterations take a fifth of it and a third of the memory. Thin walls of
   second-order bricks take three times the iterations. */
enum { SOLVER_DIRECT_DOFS = 60000 };
/* The scene's word `auto` is one of the first two once a pair has been read. */
typedef enum { CONTACT_NODE_TO_SURFACE, CONTACT_SURFACE_TO_SURFACE, CONTACT_FORMULATION_AUTO } ContactFormulation;

typedef struct {
  char       *path;        /* such as "bodies.0", for SceneWhere() */
  char       *name;        /* physical group, which is a volume, or a surface for a rigid tool */
  int         rigid;       /* 1 for a meshed rigid tool, which has no material */
  Material    material;    /* of a deformable body */
  Formulation formulation; /* enhanced and fbar exist for quad4 and hex8 only */
  int         chosen;      /* 1 if `auto` chose the formulation: cells that have none of it take full */
  /* 1 if its volume is stiff or plastic flow keeps it, and cells of first order with full integration lock.
     MeshCheckFormulations() sets it. */
  int locks;
  int enclosed;  /* 1 if its volume is kept exactly and no free displacement changes it; EnclosedBodiesFind() sets it */
  int condensed; /* as in a KernelCase; PressureNodesExist() and EnclosedBodiesFind() set it */
  int component; /* as in a KernelCase; PressureNodesExist() sets it */
  /* Of a rigid tool. Of a bolt that is tightened the component 0 is free: the shortening of its unloaded length. */
  Motion motion;
  int    bolt;    /* 1 if the body is a bolt that is tightened */
  double axis[3]; /* of the bolt: a unit vector */
  double locked;  /* of the bolt: load parameter from which its length is kept; above 1: it never is */
} SceneBody;

/* Steps in which a support holds, by their numbers; with some = 0 it holds all the time. */
typedef struct {
  int some, first, last;
} SceneSpan;

typedef struct {
  char     *path, *surface;
  int       fixed[3]; /* whether a component of the displacement is held at 0, or where it is when the support comes */
  SceneSpan during;   /* of what it fixes */
  double    spring[3]; /* stiffness of springs to the ground (force per length and area); 0: there are none */
  History   history;   /* factor on springs over the load parameter; with n = 0 it is 1 */
} SceneSupport;

/* A step with a name: a part of the load parameter's way, which may have many load steps. */
typedef struct {
  char  *name, *acts; /* acts: paths of what names it in `during`, or NULL */
  double begin, until;
} SceneStep;

/* An end of a surface: another surface that has nodes in common with it, or a point; neither: the scene does not say.
 */
typedef struct {
  char  *surface;
  int    has_point;
  double point[3]; /* reference coordinates */
} SceneEnd;

typedef enum { LOAD_DISPLACEMENT, LOAD_PRESSURE, LOAD_TRACTION, LOAD_FORCE, LOAD_BODY_FORCE } LoadKind;
typedef struct {
  char    *path, *region; /* the region is a physical surface, for a body force a physical volume */
  LoadKind kind;
  int      has[3]; /* of LOAD_DISPLACEMENT: which components are imposed */
  /* Displacement (length), traction (force per reference area), force in all, or body force (force per reference
     volume). A pressure (stress) is value[0]. */
  double     value[3];
  Expression expression[3]; /* in place of value, where it is not NULL; it has a variable */
  int        follower;      /* 1 if a pressure acts on the deformed face */
  int        open;          /* 1 if a pressure is that of a fluid that enters between surfaces, with the two ends */
  SceneEnd   from, to;
  History    history; /* factor over the load parameter on values and on expressions without t */
  SceneSpan  during;  /* of a displacement that a support imposes in some steps; it has no history then */
} SceneLoad;

/* The side to which the normals of a meshed rigid master point: that of the slave's start, the other side of that of
   the mesh, or that of the mesh. */
typedef enum { MASTER_NORMAL_AUTO, MASTER_NORMAL_FLIP, MASTER_NORMAL_KEEP } MasterNormal;

/* Two surfaces that are parts of those of a pair and do not meet */
typedef struct {
  char *slave, *master;
} SceneApart;

typedef struct {
  char           *path, *name, *slave, *master; /* the master is a physical surface, or NULL if it is analytic */
  AnalyticSurface analytic;                     /* motion.point is a point of the plane or of the axis, or the centre */
  Motion          motion;                       /* of an analytic master */
  MasterNormal    master_normal;
  /* 1 if the scene lists surfaces and names no slave: any side of the bodies may meet any other. Each entry of such a
     list becomes pairs with names of their own. */
  int                listed;
  int                keep_roles; /* 1 if slave and master stay what the scene says, see sceneroles.h */
  int                n_apart; /* parts of joined surfaces that do not meet, see scenejoins.h */
  SceneApart        *apart;
  double             share; /* part of the slave's area that counts: 1/2 if its master is a slave of it too, else 1 */
  int                smoother; /* index in Smoothers[] */
  ContactFormulation formulation;
  int                formulation_chosen; /* 1 if `auto` chose it */
  int                live_offset;   /* of surface_to_surface: 1 if the offsets follow the nodes within a solve */
  int                find_symmetry; /* 1 if the scene does not name planes of symmetry */
  int                n_symmetry;
  char             **symmetry; /* planar surfaces beyond which the model continues as its mirror image */
  int                degree;   /* of the diffuse fit, 4 or 2 */
  /* Radius of the support in spacings, and exponent of the weight. 0 stands for the default of dimension and degree. */
  double         support, weight;
  int            global_frame, diffuse_derivatives;
  double         feature_angle; /* degrees */
  InitialOverlap initial_overlap;
  double         added_overlap;      /* of OVERLAP_ADD (length): its value at t = 1 */
  Expression     overlap_expression; /* in its place, where it is not NULL; one with t is the overlap at t */
  Stabilise      stabilise;          /* which of the pair's bodies are moved into contact and held by springs */
  ContactLawKind law;
  int            friction;      /* 1 if the pair has friction */
  double         mu;            /* coefficient of friction */
  Expression     mu_expression; /* in its place, where it is not NULL */
  /* Factors on mu over the load parameter and over the pressure; with n = 0 there is none. */
  History mu_history, mu_pressure;
  double  cohesion, tau_max; /* traction that sticks without pressure, and the largest one (force per area); 0: none */
  double  stick_penalty;     /* force per length and area; 0: automatic */
  double  stick_slip;        /* largest elastic slip, in face sizes; 0: stick_penalty decides */
  int     stick_may_stiffen; /* 1 if the run chooses both penalties: none of the three keys is named */
  int     penalty_auto;      /* 1 if the penalty is the automatic one */
  /* Penalty (force per length and area), 0 if it is automatic, and the factor on the automatic penalty. */
  double penalty, penalty_scale;
  int    penalty_may_stiffen; /* 1 if the run chooses the penalty: no key of the scene sets it or lets it follow */
  int    adjust;              /* 1 if the penalty follows the penetration */
  /* When the penalty is adjusted: 1 within the step, until the window holds; 0 from one step to the next. */
  int adjust_converged;
  int window_in_spacings; /* 1 if g_min and g_max are multiples of the slave node's face size; 0 if lengths */
  /* Window of the penetration, largest factor of one adjustment, and largest factor by which the penalty may differ
     from the automatic one. */
  double g_min, g_max, clamp, range;
  /* With augment, pressures become multipliers until all penetrations are within g_max, at most max_updates times in a
     step. */
  int augment, max_updates;
  /* Part of the pair that is there over the load parameter: 0 away, 1 there; between them it fades. With n = 0 it is
     always there. */
  History presence;
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
  PROBE_TOOL_MOTION,
  PROBE_TOOL_ROTATION,
  PROBE_BOLT_FORCE, /* the target is the body of a bolt, of the next one too */
  PROBE_BOLT_SHORTENING,
  PROBE_CONTACT_AREA,
  PROBE_PRESSURE_DEVIATION,
  PROBE_REACTION_TORQUE,
  PROBE_CONTACT_TORQUE,
  PROBE_FRICTION_FORCE, /* from here on the target is a pair with friction */
  PROBE_FRICTION_TORQUE,
  PROBE_SLIPPED_AREA,
  PROBE_ELASTIC_SLIP,
  PROBE_FLUID_FRONT, /* from here on the target is the surface of a fluid */
  PROBE_FLUID_AREA,
  PROBE_SEAL_PRESSURE,
  PROBE_KINDS
} ProbeKind;
typedef struct {
  char     *path, *name;
  ProbeKind kind;
  char     *target;    /* surface of a reaction, pair of a contact quantity, else NULL */
  char     *body;      /* volume, or NULL */
  int       component; /* 0 to 2 */
  double point[2][3];  /* of displacement, distance, gap and patch: reference coordinates; of a torque: of its axis (length) */
  int    axis;         /* of contact_edge and of a torque: 0 to 2 */
  int    max_side;     /* of contact_edge: 1 for max, 0 for min */
  /* Of contact_edge and pressure_max: 1 if only nodes count whose reference coordinate at_axis equals at_value. */
  int    has_at;
  int    at_axis;
  double at_value; /* length */
  double within;   /* of pressure_mean: radius of the patch around the point (length); 0: the whole surface */
  int    rms;      /* of pressure_deviation: 1 for rms, 0 for max */
  /* Of pressure_deviation: 0 takes all nodes; 1 (excluding) leaves out the nodes within edge_faces mean face sizes of a
     free edge; 2 (only) takes only those nodes. */
  int    edge_filter;
  double edge_faces;
  int    change;   /* of distance: 1 if the reference distance is subtracted */
  int    absolute; /* 1 if the absolute value is taken */
  double factor;   /* on the value */
} SceneProbe;

typedef struct {
  char *key, *value; /* the key has no dash */
} ScenePair;

/* What a parameter of a .geo does that refines its mesh: it counts elements, it is a size, or it divides sizes */
typedef enum { DENSITY_COUNT, DENSITY_SIZE, DENSITY_DIVISOR, DENSITY_KINDS } DensityKind;
extern const char *const DensityKinds[]; /* their words */

/* A surface of CAD geometry that the scene names by a point on it, or whose elements get a size of their own. */
typedef struct {
  char  *name, *body; /* body: the body whose surface is meant, or NULL */
  int    has_point;
  double point[3];
  double size; /* of its elements; 0: that of the body */
} SceneCadSurface;

/* Tangents are stiffened in steps that fail: never; where the run would stop; where static solves fail repeatedly */
typedef enum { DAMPING_NONE, DAMPING_LAST, DAMPING_AUTO } StepDamping;

/* Errors of probes: not estimated; estimated; with what the load steps leave, by a second run */
typedef enum { SCENE_ERROR_NO, SCENE_ERROR_YES, SCENE_ERROR_HISTORY } SceneErrorWish;

/* The accuracy that a run is to reach on meshes of its own choice */
typedef struct {
  int        probe;       /* whose error counts; -1: none is asked for */
  double     to;          /* error that is allowed, over the value */
  double     cpu_s;       /* that may be used; 0: no limit */
  double     rss_mb;      /* memory of the largest rank; 0: no limit */
  int        meshes;      /* at most */
  int        n_densities; /* parameters of the .geo that refine, each with one of DensityKinds */
  ScenePair *densities;
} SceneAccuracy;

/* A derivative that is wanted: of a probe, by a number of the scene */
typedef struct {
  int    probe;
  char  *key; /* path of the number */
  double value;
} SceneSensitivity;

typedef struct {
  char            *file, *directory; /* file as the user gave it; its directory, where relative paths start */
  char            *text; /* the document after -set as one canonical YAML text, to recognise another scene's results */
  char            *name;
  char            *mesh_file;    /* path with which the process can open the file */
  PetscBool        foreign_mesh; /* the mesh file is one of another program, by its ending; CAD geometry too */
  PetscBool        cad;          /* the file is geometry of a CAD program, by its ending */
  double           mesh_size;    /* of the elements of CAD geometry; 0: by the size of each body */
  int              n_cad_surfaces;
  SceneCadSurface *cad_surfaces;
  int              order; /* of the elements, 1 or 2; 0 stands for that of the .msh file */
  int              order_chosen; /* 1: the scene names neither the order nor a formulation */
  char            *sizes; /* view of gmsh with the sizes of elements; NULL: those of the .geo file */
  int              n_parameters;
  ScenePair       *parameters; /* of the .geo file */
  Geometry         geometry;
  Kinematics       kinematics;
  int              dim; /* 3 for solid, else 2 */
  int    plane_stress;  /* 1: geometry is plane strain for everything but the law, which has no stress across */
  double thickness;     /* of the bodies in the plane (length), by which results multiply forces; else 1 */
  int    per_thickness; /* 1: in the plane without the key, so that forces are those of a unit of thickness */
  struct {
    char *length, *force, *stress;
  } units; /* words for results and pictures, or NULL */
  int           n_bodies;
  SceneBody    *bodies;
  int           n_supports;
  SceneSupport *supports;
  int           n_loads; /* supports with an expression, which are imposed displacements, and loads */
  SceneLoad    *loads;
  int           n_contacts;
  SceneContact *contacts;
  struct {
    StepControlKind control;
    double          initial, dt_min, dt_max, growth;
    int             N_c;              /* of control contact: new nodes per step, or 0 if N_c_fraction is given */
    double          N_c_fraction;     /* of control contact: new part of the slave area per step */
    int             predict_linearly; /* of control contact: 1 if one linear solve predicts, 0 if the solution does */
    double          plastic_strain;   /* largest growth of the equivalent plastic strain in a step; 0: no bound */
    double          plastic_lag;      /* largest part by which stresses lag behind plastic flow; 0: no bound */
    double          contact_travel;   /* largest travel of a contact with friction in a step; 0: no bound */
    StepDamping     damping;          /* when steps that fail are tried with stiffened tangents */
    int             n_at;
    double         *at; /* load parameters at which a step must end [n_at] */
    int             n_steps;
    SceneStep      *steps; /* steps with names [n_steps]; they follow each other from 0 to 1 */
  } stepping;
  struct {
    SolverType type;
    double     tolerance;
    int        max_iterations;
    PetscBool  hold_rolling; /* next to free rolls are held, see ModelHoldMotion() */
  } solver;
  int         n_probes;
  SceneProbe *probes;
  struct {
    int every;      /* steps between two outputs, or 0 for the last state only */
    int checkpoint; /* steps between two checkpoints, or 0 for one only when the run ends early */
    int displacement, stress, contact, principal, strain; /* which fields are written */
    int error; /* are the errors of the probes estimated: SceneErrorWish */
    int certificate;                                      /* 1 if each accepted step is judged */
  } output;
  SceneAccuracy     accuracy;
  int               n_sensitivities;
  SceneSensitivity *sensitivities;
  PetscBool         sensitivities_by_runs; /* the answer depends on the way to it */
  struct {
    double penetration; /* largest depth to which faces may cross, in sizes of the smaller face */
  } certificate;
  int        n_petsc;
  ScenePair *petsc;    /* PETSc options of the scene */
  void      *document; /* private to this folder: the tree of the document (document.h), for SceneWhere() */
} * Scene;

PetscErrorCode SceneRead(MPI_Comm, const char *file, int n_set, char *const *set, Scene *);
PetscErrorCode SceneReadAgain(MPI_Comm, const char *file, const char *where, const char *text, int n_set,
                              char *const *set, Scene *);
PetscErrorCode SceneReadChanged(Scene, MPI_Comm, const char *key, double value, Scene *);
PetscErrorCode SceneLoadRoutines(Scene, MPI_Comm, PetscBool trust);
PetscErrorCode SceneDestroy(Scene *);
PetscBool      SceneSameProblem(const char *a, const char *b);
const char    *SceneWhere(Scene, const char *path, const char *key);
PetscErrorCode SceneCheckProbePairs(Scene);
void           SceneBodySkin(const SceneBody *, char *name, size_t size);
PetscBool      SceneIsPlastic(Scene);
PetscBool      SceneHasRoutine(Scene);
PetscBool      SceneHasFluid(Scene);
PetscBool      SceneHasFriction(Scene);
PetscBool      SceneDependsOnPath(Scene);
PetscBool      SceneContactHasMaster(const SceneContact *, const char *surface);
PetscReal      SceneSharpAngle(const SceneContact *);
PetscBool      SceneBreaks(Scene, PetscReal t);
const char    *SceneStepAt(Scene, PetscReal t);
int            SceneStepFrom(Scene, PetscReal t);
PetscBool      SceneSupportsChange(Scene);
PetscBool      SceneHolds(const SceneSpan *, PetscInt step);
PetscReal      SceneStepLeft(const SceneStep *, PetscReal t);
PetscBool      SceneLoadVaries(const SceneLoad *, int component);
PetscReal      SceneLoadValue(const SceneLoad *, int component, const PetscReal X[3], PetscReal t);
PetscErrorCode SceneReference(FILE *);
