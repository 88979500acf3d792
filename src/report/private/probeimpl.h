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

/* How much a slave node counts in a mean pressure. X: its reference place (length), not relative to the mesh's centre.
 */
static inline PetscReal ProbePatchWeight(const SceneProbe *scene, int dim, const PetscReal *X)
{
  PetscReal square = 0;

  if (!(scene->within > 0)) return 1;
  for (int i = 0; i < dim; i++) square += PetscSqr((X[i] - scene->point[0][i]) / scene->within);
  return square < 1 ? PetscSqr(1 - square) : 0;
}

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
