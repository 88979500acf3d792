/* What the files of the contact share and nobody else sees: a pair, its terms and the room to evaluate slave points in. */
#pragma once
#include "blockmatrix.h"
#include "contact.h"
#include "law.h"
#include "search.h"
#include "smoother.h"

typedef struct {
  SmootherResult result;
  PetscReal     *x; /* positions relative to the slave point */
  PetscReal     *multiplier, *workspace;
  PetscInt       x_room;
  PetscInt      *node;  /* contact nodes of a term, one after another over its slave points */
  PetscReal     *N, *M; /* over these nodes; M holds one slave point's part at a time */
  int           *from;  /* which row of the variations a contact node takes part in: 0 the slave point, 1 + i fit point i */
  PetscReal     *scale; /* and with what factor, by component */
} ContactWork;

typedef struct {
  Mesh                mesh;
  const SceneContact *scene;
  FitSettings         fit;
  ContactSurface      slave, master; /* master NULL: analytic, in scene */
  int                 n_images;
  SurfaceImage        images[SURFACE_MAX_IMAGES];
  const Smoother     *smoother;
  const Smoother     *facets; /* what serves where there is no fit, and tells where the master ends */
  const Law          *law;
  ContactSearch       search;
  PetscInt            n, *node; /* terms: slave nodes of this rank that carry area */
  PetscReal          *area, *size, *turn;
  PetscReal           automatic;   /* penalty: force per length and area */
  PetscInt           *term_ptr;    /* slave points of each term */
  PetscReal          *term_weight; /* their weights, sum 1 */
  ContactState        now, accepted;
  PetscReal          *before; /* gaps of the iterate before, where the penalty is adjusted */
  ContactLists        lists;
  PetscReal          *factor;                  /* per slave point, frozen with the lists: fades out past a free edge */
  int                *seed;                    /* per slave point: the facet of last time */
  PetscReal          *force, *vector, *normal; /* of the last residual: normal force, its sum over the slave points (n*3), contact normal (n*3) */
  PetscReal           t;                       /* of the last residual */
  PetscReal          *pressure, *trial;        /* trial: gaps of the last projection, of a residual or a tangent */
  ContactWork        *work;                    /* shared by all pairs */
} ContactPair;

struct _n_Contact {
  Mesh          mesh;
  Scene         scene;
  Loads         loads;
  int           n_pairs;
  ContactPair  *pairs;
  ContactWork   work;
  BlockMatrix   blocks; /* the last tangent */
  PetscLogEvent event_search, event_project, event_residual, event_tangent;
};

/* contactpair.c */
PetscErrorCode ContactPairCreate(Mesh, Scene, Elasticity, Loads, const SceneContact *, ContactPair *);
PetscErrorCode ContactPairDestroy(ContactPair *);
PetscReal      ContactTermOffset(const ContactPair *, PetscInt term, PetscReal t);
PetscReal      ContactTouchTolerance(const ContactPair *, PetscInt term);
/* contactpoint.c */
PetscErrorCode ContactPointEvaluate(const ContactPair *, const Smoother *, ContactLists, PetscInt q, int seed, SmootherWant, PetscBool *found);
int            ContactPointNodes(ContactLists, PetscInt q, const SmootherResult *);
void           ContactPointToNodes(const ContactPair *, ContactLists, PetscInt q, PetscReal weight, PetscBool second, PetscInt *node, PetscReal *N, int *count);
PetscErrorCode ContactTermGap(const ContactPair *, ContactLists, const PetscReal *factor, int *seed, PetscInt term, PetscReal *gap);
