/* Recovered fields on a distributed mesh, see recovery.h. */
#include "errors/recovery.h"

struct _n_Recovery {
  Mesh       mesh;
  int        dim, degree, terms;
  PetscInt  *point_ptr;   /* first point of each local cell */
  PetscReal *x, *volume;  /* of the points: reference coordinates (length), reference volume */
  PetscInt  *product_ptr; /* the same of the points of products, or that itself */
  PetscReal *product_x, *product_volume;
  PetscReal (*N)[ELEMENT_MAX_POINTS][ELEMENT_MAX_NODES]; /* of each type of cells: linear shape functions there */
  PetscReal *size;                                       /* of the patch of each node (length) */
  int       *patch_degree;                               /* -1: no patch */
  PetscReal *variance;                                   /* of its polynomial at the node */
  PetscInt   entries;                                    /* of the matrix of a patch */
  PetscReal *factor;                                     /* of each node [entries] */
};

/* The element with the corners of a cell alone. */
static ElementType LinearType(ElementType type)
{
  return ElementGet(type)->order == 1 ? type : (ElementType)(type - 1);
}

/* Places one set of points of all local cells; ptr: the first one of each. */
static PetscErrorCode PlacePoints(Mesh mesh, Elasticity elasticity, CellPoints set, PetscInt **ptr, PetscReal **x,
                                  PetscReal **volume)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_cells + 1, ptr));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const ElementType type = mesh->cell_type[c];

    (*ptr)[c] = n;
    n += set == POINTS_OF_PRODUCTS ? ElementGetProducts(type)->points : ElementGet(type)->points;
  }
  (*ptr)[mesh->n_cells] = n;
  PetscCall(PetscMalloc2(n * mesh->dim, x, n, volume));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    PetscCall(ElasticityPlacePoints(elasticity, c, set, &(*x)[(*ptr)[c] * mesh->dim], &(*volume)[(*ptr)[c]]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Places the points of products, which are the quadrature points unless some element has others. */
static PetscErrorCode PlaceProducts(Recovery r, Elasticity elasticity)
{
  PetscBool same = PETSC_TRUE;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < r->mesh->n_cells; c++)
    same = (PetscBool)(same && ElementGet(r->mesh->cell_type[c]) == ElementGetProducts(r->mesh->cell_type[c]));
  r->product_ptr    = r->point_ptr;
  r->product_x      = r->x;
  r->product_volume = r->volume;
  if (!same)
    PetscCall(PlacePoints(r->mesh, elasticity, POINTS_OF_PRODUCTS, &r->product_ptr, &r->product_x, &r->product_volume));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the sizes of the patches: the root mean square distance of their points from the node, doubled. */
static PetscErrorCode SizePatches(Recovery r)
{
  const Mesh mesh = r->mesh;
  PetscReal *sum;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * mesh->n_nodes, &sum));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    for (int k = 0; k < ElementGet(mesh->cell_type[c])->corners; k++) {
      const PetscInt node = mesh->cell_nodes[mesh->cell_ptr[c] + k];

      for (PetscInt p = r->point_ptr[c]; p < r->point_ptr[c + 1]; p++) {
        for (int i = 0; i < r->dim; i++)
          sum[2 * node] += PetscSqr(r->x[p * r->dim + i] - mesh->coords[node * r->dim + i]);
        sum[2 * node + 1]++;
      }
    }
  }
  PetscCall(MeshSumNodes(mesh, 2, sum));
  for (PetscInt n = 0; n < mesh->n_nodes; n++)
    r->size[n] = sum[2 * n + 1] > 0 ? 2 * PetscSqrtReal(sum[2 * n] / sum[2 * n + 1]) : 1;
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The terms of the polynomial of a node's patch at the place X. */
static void PointTerms(Recovery r, PetscInt node, const PetscReal *X, PetscReal terms[RECOVERY_TERMS])
{
  PetscReal x[3];

  for (int i = 0; i < r->dim; i++) x[i] = (X[i] - r->mesh->coords[node * r->dim + i]) / r->size[node];
  RecoveryBasis(r->dim, r->degree, x, terms);
}

/* Sums up and factors the matrices of all patches. */
static PetscErrorCode FactorPatches(Recovery r)
{
  const Mesh mesh = r->mesh;
  PetscReal  terms[RECOVERY_TERMS];

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    for (int k = 0; k < ElementGet(mesh->cell_type[c])->corners; k++) {
      const PetscInt node = mesh->cell_nodes[mesh->cell_ptr[c] + k];

      for (PetscInt p = r->point_ptr[c]; p < r->point_ptr[c + 1]; p++) {
        PointTerms(r, node, &r->x[p * r->dim], terms);
        RecoveryAdd(r->terms, terms, &r->factor[node * r->entries]);
      }
    }
  }
  PetscCall(MeshSumNodes(mesh, r->entries, r->factor));
  for (PetscInt n = 0; n < mesh->n_nodes; n++)
    r->patch_degree[n] = RecoveryFactor(r->dim, r->degree, &r->factor[n * r->entries], &r->variance[n]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Evaluates the linear shape functions of all types of cells at their points of products. */
static PetscErrorCode ShapePoints(Recovery r)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(ELEMENT_TYPES, &r->N));
  for (int type = 0; type < ELEMENT_TYPES; type++) {
    const Element *element = ElementGetProducts((ElementType)type);

    for (int p = 0; element->dim == r->dim && p < element->points; p++)
      ElementShape(LinearType((ElementType)type), element->point[p], r->N[type][p], NULL, NULL);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RecoveryCreate - finds the patches of a mesh.

  Collective

  Input Parameters:
+ mesh       - the mesh
- elasticity - of the mesh: it knows the quadrature points

  Output Parameter:
. recovery - free it with RecoveryDestroy()
@*/
PetscErrorCode RecoveryCreate(Mesh mesh, Elasticity elasticity, Recovery *recovery)
{
  Recovery r;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&r));
  r->mesh    = mesh;
  r->dim     = mesh->dim;
  r->degree  = PetscMin(mesh->order, RECOVERY_DEGREE);
  r->terms   = RecoveryTerms(r->dim, r->degree);
  r->entries = r->terms * (r->terms + 1) / 2;
  PetscCall(PetscCalloc4(mesh->n_nodes, &r->size, mesh->n_nodes, &r->patch_degree, mesh->n_nodes, &r->variance,
                         mesh->n_nodes * r->entries, &r->factor));
  PetscCall(PlacePoints(mesh, elasticity, POINTS_OF_ELEMENT, &r->point_ptr, &r->x, &r->volume));
  PetscCall(PlaceProducts(r, elasticity));
  PetscCall(ShapePoints(r));
  PetscCall(SizePatches(r));
  PetscCall(FactorPatches(r));
  *recovery = r;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RecoveryDestroy - frees the patches.

  Not collective

  Input Parameter:
. recovery - set to NULL
@*/
PetscErrorCode RecoveryDestroy(Recovery *recovery)
{
  PetscFunctionBeginUser;
  if (!*recovery) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree4((*recovery)->size, (*recovery)->patch_degree, (*recovery)->variance, (*recovery)->factor));
  if ((*recovery)->product_ptr != (*recovery)->point_ptr) {
    PetscCall(PetscFree2((*recovery)->product_x, (*recovery)->product_volume));
    PetscCall(PetscFree((*recovery)->product_ptr));
  }
  PetscCall(PetscFree2((*recovery)->x, (*recovery)->volume));
  PetscCall(PetscFree((*recovery)->point_ptr));
  PetscCall(PetscFree((*recovery)->N));
  PetscCall(PetscFree(*recovery));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RecoveryPoints - returns the number of the first quadrature point of a local cell; the others follow it.

  Not collective

  Input Parameters:
+ recovery - the patches
- cell     - a local cell; the number of cells gives the number of points

  Output Parameter:
. volume - reference volumes of the cell's points; or NULL
@*/
PetscInt RecoveryPoints(Recovery recovery, PetscInt cell, const PetscReal **volume)
{
  if (volume) *volume = &recovery->volume[recovery->point_ptr[cell]];
  return recovery->point_ptr[cell];
}

/*@
  RecoveryProducts - returns the number of the first point of products of a local cell; the others follow it.

  Not collective

  Input Parameters:
+ recovery - the patches
- cell     - a local cell; the number of cells gives the number of points

  Output Parameter:
. volume - reference volumes of the cell's points; or NULL
@*/
PetscInt RecoveryProducts(Recovery recovery, PetscInt cell, const PetscReal **volume)
{
  if (volume) *volume = &recovery->product_volume[recovery->product_ptr[cell]];
  return recovery->product_ptr[cell];
}

/*@
  RecoveryFit - computes the polynomials of all patches for a field.

  Collective

  Input Parameters:
+ r      - the patches
. width  - number of components
- values - at the quadrature points [points][width]

  Output Parameter:
. patches - the coefficients [n_nodes][terms][width]; free it with PetscFree()
@*/
PetscErrorCode RecoveryFit(Recovery r, int width, const PetscReal *values, PetscReal **patches)
{
  const Mesh     mesh   = r->mesh;
  const PetscInt stride = r->terms * width;
  PetscReal      terms[RECOVERY_TERMS], *sums;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * stride, &sums));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    for (int k = 0; k < ElementGet(mesh->cell_type[c])->corners; k++) {
      const PetscInt node = mesh->cell_nodes[mesh->cell_ptr[c] + k];

      for (PetscInt p = r->point_ptr[c]; p < r->point_ptr[c + 1]; p++) {
        PointTerms(r, node, &r->x[p * r->dim], terms);
        for (int t = 0; t < r->terms; t++)
          for (int i = 0; i < width; i++) sums[node * stride + t * width + i] += terms[t] * values[p * width + i];
      }
    }
  }
  PetscCall(MeshSumNodes(mesh, stride, sums));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    const int used = r->patch_degree[n] < 0 ? 0 : RecoveryTerms(r->dim, r->patch_degree[n]);

    for (int i = 0; i < width && used; i++)
      RecoverySolve(used, &r->factor[n * r->entries], width, &sums[n * stride + i]);
    for (PetscInt k = used * width; k < stride; k++) sums[n * stride + k] = 0;
  }
  *patches = sums;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RecoveryEvaluate - gives a recovered field at a point of products.

  Not collective

  Input Parameters:
+ r       - the patches
. width   - number of components
. patches - of RecoveryFit()
. cell    - a local cell
- p       - number of the point in it

  Output Parameter:
. value - the field [width]
@*/
void RecoveryEvaluate(Recovery r, int width, const PetscReal *patches, PetscInt cell, int p, PetscReal *value)
{
  const Mesh       mesh    = r->mesh;
  const Element   *element = ElementGetProducts(mesh->cell_type[cell]);
  const PetscInt  *nodes = &mesh->cell_nodes[mesh->cell_ptr[cell]], stride = r->terms * width;
  const PetscReal *N = r->N[mesh->cell_type[cell]][p];
  PetscReal        terms[RECOVERY_TERMS], all = 0;
  int              best = 0;

  for (int k = 0; k < element->corners; k++) best = PetscMax(best, r->patch_degree[nodes[k]]);
  for (int i = 0; i < width; i++) value[i] = 0;
  for (int k = 0; k < element->corners; k++) {
    const PetscReal weight = r->patch_degree[nodes[k]] < best ? 0 : N[k] / r->variance[nodes[k]];

    all += weight;
    if (weight == 0) continue;
    PointTerms(r, nodes[k], &r->product_x[(r->product_ptr[cell] + p) * r->dim], terms);
    for (int t = 0; t < r->terms; t++)
      for (int i = 0; i < width; i++) value[i] += weight * terms[t] * patches[nodes[k] * stride + t * width + i];
  }
  for (int i = 0; i < width; i++) value[i] /= all;
}
