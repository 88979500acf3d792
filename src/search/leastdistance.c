/* The distance between slave and master, for reports of pairs that never met. */
#include "searchimpl.h"
#include "base/boxtree.h"

/* The faces of this rank's master in the present position, and the point whose distance is wanted. */
typedef struct {
  int              dim;
  const Facet     *faces;
  const PetscReal *x, *point;
} LeastDistance;

static void VisitFace(void *context, int index, double *bound)
{
  const LeastDistance *look  = context;
  Facet                facet = look->faces[index];
  PetscReal            x[FACE_MAX_NODES * 3];
  Foot                 foot;

  for (int a = 0; a < ElementGet(facet.type)->nodes; a++) {
    for (int d = 0; d < look->dim; d++) x[a * look->dim + d] = look->x[facet.nodes[a] * look->dim + d] - look->point[d];
    facet.nodes[a] = a;
  }
  facet.free_edges = 0;
  FacetProject(look->dim, &facet, x, &foot);
  *bound = PetscMin(*bound, PetscAbsReal(foot.gap));
}

/* Positions of all slave points of all ranks. */
static PetscErrorCode GatherPoints(ContactSearch s, PetscInt *n, PetscReal **x)
{
  const int   dim = s->mesh->dim;
  PetscMPIInt rank, size, mine, *counts, *starts, total = 0;
  PetscReal  *own;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(s->mesh->comm, &rank));
  PetscCallMPI(MPI_Comm_size(s->mesh->comm, &size));
  PetscCall(PetscMalloc3(size, &counts, size, &starts, s->slaves->n * dim, &own));
  *n = 0;
  for (PetscInt q = 0; q < s->slaves->n; q++)
    if (SlavePointIsOwn(s->slaves, q, rank)) SlavePointsPosition(s->slaves, q, &own[(*n)++ * dim]);
  PetscCall(PetscMPIIntCast(*n * dim, &mine));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, counts, 1, MPI_INT, s->mesh->comm));
  for (PetscMPIInt r = 0; r < size; r++) {
    starts[r] = total;
    total += counts[r];
  }
  PetscCall(PetscMalloc1(total, x));
  PetscCallMPI(MPI_Allgatherv(own, mine, MPIU_REAL, *x, counts, starts, MPIU_REAL, s->mesh->comm));
  *n = total / dim;
  PetscCall(PetscFree3(counts, starts, own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchLeastDistance - computes the distance between the slave points and the master, whichever way their normals
point.

  Collective

  Input Parameters:
+ s - the search; its master is meshed
. u - local displacements u[mesh n_nodes*dim] (length), ghosts included
- t - load parameter, for rigid tools

  Output Parameter:
. distance - the distance (length), the same on all ranks; mirror images do not count
@*/
PetscErrorCode SearchLeastDistance(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal *distance)
{
  ContactSurface master  = s->master;
  const int      dim     = s->mesh->dim;
  const PetscInt n_nodes = master->rigid ? master->rigid->n_nodes : s->mesh->n_nodes;
  PetscInt       n       = 0;
  PetscReal     *points, *x, *lower, *upper;
  BoxTree        tree;

  PetscFunctionBeginUser;
  ToolsPlace(s->mesh, u, t);
  PetscCall(SlavePointsMove(s->slaves, u, t));
  PetscCall(GatherPoints(s, &n, &points));
  PetscCall(PetscMalloc3(n_nodes * dim, &x, master->n_faces * dim, &lower, master->n_faces * dim, &upper));
  for (PetscInt i = 0; i < n_nodes; i++) {
    PetscReal y[3] = {0, 0, 0};

    if (master->rigid) SearchRigidPosition(s, i, t, y);
    for (int d = 0; d < dim; d++) x[i * dim + d] = master->rigid ? y[d] : s->mesh->coords[i * dim + d] + u[i * dim + d];
  }
  for (PetscInt f = 0; f < master->n_faces; f++) {
    const Facet *face = &master->faces[f];

    for (int d = 0; d < dim; d++) {
      lower[f * dim + d] = PETSC_MAX_REAL;
      upper[f * dim + d] = PETSC_MIN_REAL;
      for (int a = 0; a < ElementGet(face->type)->nodes; a++) {
        lower[f * dim + d] = PetscMin(lower[f * dim + d], x[face->nodes[a] * dim + d]);
        upper[f * dim + d] = PetscMax(upper[f * dim + d], x[face->nodes[a] * dim + d]);
      }
    }
  }
  PetscCheck(!BoxTreeBuild(dim, (int)master->n_faces, lower, upper, &tree), PETSC_COMM_SELF, PETSC_ERR_MEM,
             "no memory for the search tree");
  *distance = PETSC_MAX_REAL;
  for (PetscInt q = 0; q < n; q++) {
    LeastDistance look = {dim, master->faces, x, &points[q * dim]};

    BoxTreeClosest(tree, look.point, NULL, distance, VisitFace, &look);
  }
  BoxTreeDestroy(&tree);
  PetscCall(PetscFree3(x, lower, upper));
  PetscCall(PetscFree(points));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, distance, 1, MPIU_REAL, MPI_MIN, s->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
