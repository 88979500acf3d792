/* Masters that deform know where fluids are kept out from the slaves that press on them: mean reactions would let a
   fluid pass where a seal is narrower than a face of the master, or where slave nodes are farther apart than faces. */
#include "base/boxtree.h"
#include "fluidimpl.h"

/* A node rules the part of a surface that is nearer to it than to its neighbours: in a square face it reaches to the
   middle, this part of an edge away. */
#define FLUID_REACH 0.7072

/* Says whether a fluid comes in where contact presses so much: less than the fluid. One without pressure is where the
   surfaces are apart. */
PetscBool FluidOpen(const Fluid *fluid, PetscReal pressure)
{
  return (PetscBool)(pressure == 0 || pressure < (1 - FLUID_SAME) * fluid->pressure);
}

/* Gathers the nodes of a face of the surface and their places x[nodes*dim]. Returns its type. u NULL: those of the
   reference. */
ElementType FluidFacePlaces(Fluids fluids, const Fluid *fluid, PetscInt face, const PetscReal *u, PetscInt *nodes,
                            PetscReal *x)
{
  const Mesh        mesh = fluids->mesh;
  const ElementType type = MeshFaceNodes(mesh, fluid->group, face, nodes);
  const int         n    = ElementGet(type)->nodes;
  PetscReal         v[3 * FACE_MAX_NODES];

  MeshGatherNodes(mesh, n, nodes, mesh->coords, x);
  if (u) MeshGatherNodes(mesh, n, nodes, u, v);
  for (int i = 0; i < n * mesh->dim && u; i++) x[i] += v[i];
  return type;
}

/* A search for the nearest node. */
typedef struct {
  const PetscReal *x, *point; /* places of all nodes; the point */
  int              nearest;
} NearestNode;

/* Visitor for BoxTreeClosest(). Of nodes at equal distance the first one counts. */
static void VisitNode(void *context, int index, double *bound)
{
  NearestNode *look   = context;
  PetscReal    square = 0, distance;

  for (int d = 0; d < 3; d++) square += PetscSqr(look->x[3 * index + d] - look->point[d]);
  distance = PetscSqrtReal(square);
  if (distance > *bound || (distance == *bound && look->nearest >= 0 && look->nearest < index)) return;
  *bound        = distance;
  look->nearest = index;
}

/* Finds the places of all nodes of a surface, x[3*n], and how far they reach; with small kinematics those of the
   reference. */
static PetscErrorCode FindPlaces(Fluids fluids, SurfaceGraph s, const PetscReal *u, PetscReal *x, PetscReal *reach)
{
  const int  dim = fluids->scene->kinematics == KINEMATICS_SMALL ? 0 : fluids->mesh->dim; /* the same on all ranks */
  PetscReal *local, *way;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(x, s->X, 3 * s->graph.n));
  PetscCall(PetscMalloc2(fluids->mesh->n_nodes, &local, s->graph.n, &way));
  for (int d = 0; d < dim; d++) {
    for (PetscInt i = 0; i < fluids->mesh->n_nodes; i++) local[i] = u[i * dim + d];
    PetscCall(SurfaceGraphGather(s, local, way));
    for (int i = 0; i < s->graph.n; i++) x[3 * i + d] += way[i];
  }
  for (int i = 0; i < s->graph.n; i++) {
    PetscReal square = 0;

    for (int k = s->ptr[i]; k < s->ptr[i + 1]; k++) {
      PetscReal edge = 0;

      for (int d = 0; d < 3; d++) edge += PetscSqr(x[3 * i + d] - x[3 * s->adj[k] + d]);
      square = PetscMax(square, edge);
    }
    reach[i] = FLUID_REACH * PetscSqrtReal(square);
  }
  PetscCall(PetscFree2(local, way));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* For each of n points the nearest of m nodes that reaches it, else -1. */
static PetscErrorCode FindNearest(int n, const PetscReal *point, int m, const PetscReal *x, const PetscReal *reach,
                                  int *nearest)
{
  BoxTree tree;

  PetscFunctionBeginUser;
  PetscCheck(!BoxTreeBuild(3, m, x, x, &tree), PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for a tree");
  for (int i = 0; i < n; i++) {
    NearestNode look  = {.x = x, .point = &point[3 * i], .nearest = -1};
    double      bound = INFINITY;

    BoxTreeClosest(tree, look.point, NULL, &bound, VisitNode, &look);
    nearest[i] = look.nearest >= 0 && bound <= reach[look.nearest] ? look.nearest : -1;
  }
  BoxTreeDestroy(&tree);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a slave of the other fluid press on the surface of the first? */
static PetscBool Faces(Fluids fluids, const Fluid *fluid, const Fluid *other)
{
  for (int p = 0; p < ContactPairs(fluids->contact) && fluid != other; p++)
    if (fluid->reacts[p] && other->pair[p]) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Where a slave presses at least as much as the fluid, the nodes of the master have its pressure: those to which a node
   of the slave is the nearest, and those nearest to it. So a closed line of either has its image. */
static PetscErrorCode FaceOne(Fluids fluids, Fluid *fluid, const Fluid *slave, const PetscReal *u)
{
  const int        n = fluid->surface->graph.n, m = slave->surface->graph.n;
  const PetscReal *p = slave->now.p;
  PetscReal       *x, *y, *reach, *reach_slave;
  int             *nearest, *nearest_slave;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc6(3 * n, &x, 3 * m, &y, n, &reach, m, &reach_slave, m, &nearest, n, &nearest_slave));
  PetscCall(FindPlaces(fluids, fluid->surface, u, x, reach));
  PetscCall(FindPlaces(fluids, slave->surface, u, y, reach_slave));
  PetscCall(FindNearest(n, x, m, y, reach_slave, nearest_slave));
  PetscCall(FindNearest(m, y, n, x, reach, nearest));
  for (int i = 0; i < n; i++) {
    const int k = nearest_slave[i];

    if (k >= 0 && !FluidOpen(fluid, p[k])) fluid->now.p[i] = PetscMax(fluid->now.p[i], p[k]);
  }
  for (int k = 0; k < m; k++) {
    const int i = nearest[k];

    if (i >= 0 && !FluidOpen(fluid, p[k])) fluid->now.p[i] = PetscMax(fluid->now.p[i], p[k]);
  }
  PetscCall(PetscFree6(x, y, reach, reach_slave, nearest, nearest_slave));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Raises the pressures at the nodes of a master to those of the slaves that keep the fluid out there. */
PetscErrorCode FluidFaceSlaves(Fluids fluids, Fluid *fluid, const PetscReal *u)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < fluids->n; i++)
    if (Faces(fluids, fluid, &fluids->fluid[i])) PetscCall(FaceOne(fluids, fluid, &fluids->fluid[i], u));
  PetscFunctionReturn(PETSC_SUCCESS);
}
