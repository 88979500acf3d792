/* What probe.c and probevariation.c share: the probes of a scene, resolved in its model. */
#pragma once
#include "base/gathertable.h"
#include "report/probe.h"
#include "search/freeedge.h"

typedef struct {
  const SceneProbe *scene;
  const MeshGroup  *group; /* reaction; slave surface of the pair */
  int               pair;
  PetscInt          id[2];      /* node_id of the points */
  PetscInt          node[2];    /* the local node on its owner, -1 elsewhere */
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
