/* Cells at points where stresses have no bound, see singularpoints.h. */
#include "errors/singularpoints.h"
#include "kernels/elementkernel.h"
#include "mesh/meshdofs.h"
#include "mesh/meshsizes.h"

/* The error per measure around such a point is so many times that around the cells there: 3^(2 (1 + p - lambda)) at
   order 1 with lambda = 0.74, that of an end of a support. Of smooth errors on meshes of triangles it is at most 6. */
#define SINGULAR_RATIO 16
/* Errors that differ by less than this part are equal: round-off, which depends on the number of ranks, is not to
   decide. */
#define SINGULAR_EQUAL 1e-9

/* Sums at the corner nodes */
enum { ERROR, MEASURE, SKIPPED, SUMS };

typedef struct {
  Mesh             mesh;
  const PetscReal *error;
  const PetscBool *skip;
  PetscReal       *size, *measure;                /* of the cells */
  PetscReal       *patch, *outer, *ring, *beaten; /* [n_nodes][SUMS], the last one [n_nodes] */
} Points;

static int Corners(const Points *p, PetscInt cell, const PetscInt **nodes)
{
  *nodes = &p->mesh->cell_nodes[p->mesh->cell_ptr[cell]];
  return ElementGet(p->mesh->cell_type[cell])->corners;
}

/* Sums errors and measures of the cells around each node; inner: cells that are left out, NULL: none. */
static PetscErrorCode SumCells(const Points *p, const PetscBool *inner, PetscReal *sums)
{
  const PetscInt *nodes;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < p->mesh->n_cells; c++)
    for (int k = 0, n = Corners(p, c, &nodes); k < n && !(inner && inner[c]); k++) {
      PetscReal *sum = &sums[nodes[k] * SUMS];

      sum[ERROR] += PetscAbsReal(p->error[c]);
      sum[MEASURE] += p->measure[c];
      sum[SKIPPED] += p->skip[c];
    }
  PetscCall(MeshSumNodes(p->mesh, SUMS, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is there more error around node a than around node b? Of equal ones the lower number has more. */
static PetscBool Beats(const Points *p, PetscInt a, PetscInt b)
{
  const PetscReal at_a = p->patch[a * SUMS + ERROR], at_b = p->patch[b * SUMS + ERROR];

  if (PetscAbsReal(at_a - at_b) > SINGULAR_EQUAL * (at_a + at_b)) return (PetscBool)(at_a > at_b);
  return (PetscBool)(p->mesh->node_id[a] < p->mesh->node_id[b]);
}

/* Counts at each node the neighbours with more error around them. */
static PetscErrorCode CountBeaten(const Points *p)
{
  const PetscInt *nodes;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < p->mesh->n_cells; c++)
    for (int k = 0, n = Corners(p, c, &nodes); k < n; k++)
      for (int l = 0; l < n; l++)
        if (l != k && Beats(p, nodes[l], nodes[k])) p->beaten[nodes[k]]++;
  PetscCall(MeshSumNodes(p->mesh, 1, p->beaten));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The corner of a cell around which there is more error than around all its neighbours, -1: none. */
static PetscInt Peak(const Points *p, PetscInt cell)
{
  const PetscInt *nodes;

  for (int k = 0, n = Corners(p, cell, &nodes); k < n; k++)
    if (p->beaten[nodes[k]] == 0 && p->patch[nodes[k] * SUMS + SKIPPED] == 0) return nodes[k];
  return -1;
}

/* Sums at each peak what the cells around those at it have. */
static PetscErrorCode SumRings(const Points *p, const PetscBool *inner)
{
  const PetscInt *nodes;

  PetscFunctionBeginUser;
  PetscCall(SumCells(p, inner, p->outer));
  for (PetscInt c = 0; c < p->mesh->n_cells; c++) {
    const PetscInt peak = Peak(p, c);

    for (int k = 0, n = Corners(p, c, &nodes); k < n && peak >= 0; k++)
      for (int s = 0; s < SUMS && nodes[k] != peak; s++) p->ring[peak * SUMS + s] += p->outer[nodes[k] * SUMS + s];
  }
  PetscCall(MeshSumNodes(p->mesh, SUMS, p->ring));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is the error per measure at a peak much more than around it? */
static PetscBool IsSingular(const Points *p, PetscInt peak)
{
  const PetscReal *patch = &p->patch[peak * SUMS], *ring = &p->ring[peak * SUMS];

  return (PetscBool)(patch[ERROR] * ring[MEASURE] > SINGULAR_RATIO * ring[ERROR] * patch[MEASURE]);
}

/*@
  SingularCellsFind - finds the cells at points where stresses have no bound.

  Collective

  Input Parameters:
+ mesh  - the mesh
. error - what each local cell leaves of error; the sign does not count
- skip  - local cells whose corners are not asked about

  Output Parameter:
. cells - for each local cell: it has such a point as a corner
@*/
PetscErrorCode SingularCellsFind(Mesh mesh, const PetscReal *error, const PetscBool *skip, PetscBool *cells)
{
  Points p = {.mesh = mesh, .error = error, .skip = skip};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(mesh->n_cells, &p.size, mesh->n_cells, &p.measure));
  PetscCall(PetscCalloc4(mesh->n_nodes * SUMS, &p.patch, mesh->n_nodes * SUMS, &p.outer, mesh->n_nodes * SUMS, &p.ring,
                         mesh->n_nodes, &p.beaten));
  MeshCellSizes(mesh, p.size, p.measure);
  PetscCall(SumCells(&p, NULL, p.patch));
  PetscCall(CountBeaten(&p));
  for (PetscInt c = 0; c < mesh->n_cells; c++) cells[c] = (PetscBool)(Peak(&p, c) >= 0);
  PetscCall(SumRings(&p, cells));
  for (PetscInt c = 0; c < mesh->n_cells; c++) cells[c] = (PetscBool)(cells[c] && IsSingular(&p, Peak(&p, c)));
  PetscCall(PetscFree4(p.patch, p.outer, p.ring, p.beaten));
  PetscCall(PetscFree2(p.size, p.measure));
  PetscFunctionReturn(PETSC_SUCCESS);
}
