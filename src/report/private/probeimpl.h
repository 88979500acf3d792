/* What probe.c and probevariation.c share: the probes of a scene, resolved in its model. */
#pragma once
#include "base/gathertable.h"
#include "kernels/element.h"
#include "report/probe.h"
#include "search/freeedge.h"

/* A probe's point is at a node if it is within this part of the model's size from it: scene files that are written by
   hand can be expected to meet this. */
#define PROBE_POINT_TOLERANCE 1e-6

/* A point of a body: what a field has there is the sum over nodes of this rank, and over all ranks */
typedef struct {
  PetscInt  id; /* node_id of the node there; -1: the point lies between nodes */
  PetscInt  n;
  PetscInt  node[ELEMENT_MAX_NODES];
  PetscReal weight[ELEMENT_MAX_NODES]; /* of each node (no unit) */
} ProbePoint;

typedef struct {
  const SceneProbe *scene;
  const MeshGroup  *group; /* reaction; slave surface of the pair */
  int               pair;
  ProbePoint        point[2];
  FreeEdges         free_edges; /* of the slave surface, NULL: not asked for */
  PetscReal         face_size;  /* mean, of the slave surface */
  PetscReal         spacing;
  PetscReal         plain; /* the value at the last evaluation, before `absolute` and `factor` */
} Probe;

struct _n_Probes {
  Model        model;
  Scene        scene;
  int         *node_body; /* index into scene->bodies, during the preparation */
  Probe       *probe;
  GatherTable *slaves; /* per pair, of the evaluation under way; row NULL: not asked for yet */
};

/* Is a reaction asked for that is the force on a rigid tool? */
static inline PetscBool ProbeOfTool(const struct _n_Probes *probes, const Probe *probe)
{
  return (PetscBool)(MeshFindBody(probes->scene, probe->scene->target, PETSC_TRUE) >= 0);
}

/* Gives the slave nodes of a probe that is a mean pressure, and what each of them counts (area), weight[n]; the caller
   frees it. sum: of all ranks. Collective. */
PetscErrorCode ProbeMeanWeights(Probes, const Probe *, ContactNodes *, PetscReal **weight, PetscReal *sum);

/* Finds point number `which` of a probe: one of the nodes of a group, or else, with NULL, any point of a body. Refuses
   a point that is outside, and one where the body is left open. key: of the scene. Collective. */
PetscErrorCode ProbePointFind(Probes, Probe *, const char *key, int which, const MeshGroup *within);

/* What a local field[n_nodes*dim] has at a point, value[dim]. Collective. */
PetscErrorCode ProbePointValue(Probes, const ProbePoint *, const PetscReal *field, PetscReal value[3]);
