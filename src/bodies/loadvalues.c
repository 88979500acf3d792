/* Values of loads at nodes and quadrature points, see loadvalues.h. */
#include "bodies/loadvalues.h"

/*@
  LoadHasExpression - tells whether some component of a load is an expression.

  Not collective

  Input Parameter:
. load - the load
@*/
PetscBool LoadHasExpression(const SceneLoad *load)
{
  return load->expression[0] || load->expression[1] || load->expression[2] ? PETSC_TRUE : PETSC_FALSE;
}

/*@
  LoadVaries - tells whether some component of a load is an expression with t, so that no history applies to the load as
  a whole.

  Not collective

  Input Parameter:
. load - the load
@*/
PetscBool LoadVaries(const SceneLoad *load)
{
  return SceneLoadVaries(load, 0) || SceneLoadVaries(load, 1) || SceneLoadVaries(load, 2) ? PETSC_TRUE : PETSC_FALSE;
}

/* Complains of a component of a load that has no finite value at a node or in a cell or face near it. */
static void CheckFinite(Mesh mesh, Scene scene, const SceneLoad *load, int component, const char *where, PetscInt node,
                        PetscReal t, PetscReal value, Complaint *complaint)
{
  static const char *const        displacements[] = {"ux", "uy", "uz"},
                           *const tractions[]     = {"traction.0", "traction.1", "traction.2"},
                           *const totals[]        = {"force.0", "force.1", "force.2"},
                           *const forces[]        = {"body_force.0", "body_force.1", "body_force.2"};
  const char                     *key             = load->kind == LOAD_DISPLACEMENT ? displacements[component]
                                                    : load->kind == LOAD_PRESSURE   ? "pressure"
                                                    : load->kind == LOAD_TRACTION   ? tractions[component]
                                                    : load->kind == LOAD_FORCE      ? totals[component]
                                                                                    : forces[component];
  PetscReal                       X[3];

  if (!PetscIsInfOrNanReal(value)) return;
  MeshNodePlace(mesh, node, X);
  Complain(complaint,
           "%s: the expression has no finite value %s node %" PetscInt_FMT
           " (%g, %g, %g) at t = %g; allowed: an expression that is finite wherever it acts",
           SceneWhere(scene, load->path, key), where, mesh->node_tag[node], (double)X[0], (double)X[1], (double)X[2],
           (double)t);
}

/*@
  LoadNodeValue - returns a component of an imposed displacement at a node, without the factor of its history.

  Not collective

  Input Parameters:
+ mesh      - the mesh
. scene     - the scene of the load
. load      - the load
. component - 0 to 2
. node      - local node
- t         - load parameter; it matters only where SceneLoadVaries()

  Output Parameter:
. complaint - about a value that is not finite
@*/
PetscReal LoadNodeValue(Mesh mesh, Scene scene, const SceneLoad *load, int component, PetscInt node, PetscReal t,
                        Complaint *complaint)
{
  PetscReal X[3], value;

  if (!load->expression[component]) return load->value[component];
  MeshNodePlace(mesh, node, X);
  value = SceneLoadValue(load, component, X, t);
  CheckFinite(mesh, scene, load, component, "at", node, t, value, complaint);
  return value;
}

/* Gives the reference coordinates of a quadrature point, and the node that is nearest by its shape function. */
static PetscInt PointPlace(Mesh mesh, const Element *e, int p, const PetscInt *nodes, PetscReal X[3])
{
  PetscReal node[3];
  int       nearest = 0;

  X[0] = X[1] = X[2] = 0;
  for (int a = 0; a < e->nodes; a++) {
    MeshNodePlace(mesh, nodes[a], node);
    for (int d = 0; d < 3; d++) X[d] += e->N[p][a] * node[d];
    if (e->N[p][a] > e->N[p][nearest]) nearest = a;
  }
  return nodes[nearest];
}

/*@
  LoadPointValues - evaluates a pressure, a traction or a body force at the quadrature points of a face or a cell.

  Not collective

  Input Parameters:
+ mesh  - the mesh
. scene - the scene of the load
. load  - the load
. e     - the face or cell
. nodes - its local nodes
- t     - load parameter; it matters only where LoadVaries()

  Output Parameters:
+ value     - the values for factor 1, or where LoadVaries() those at t [LOAD_MAX_VALUES]
- complaint - about a value that is not finite

  Note:
  It returns the stride of the values from one point to the next, which is 0 for a load without expressions.
@*/
int LoadPointValues(Mesh mesh, Scene scene, const SceneLoad *load, const Element *e, const PetscInt *nodes, PetscReal t,
                    double *value, Complaint *complaint)
{
  const int components = load->kind == LOAD_PRESSURE ? 1 : mesh->dim;

  for (int c = 0; c < components; c++) value[c] = load->value[c];
  if (!LoadHasExpression(load)) return 0;
  for (int p = 0; p < e->points; p++) {
    PetscReal      X[3];
    const PetscInt node = PointPlace(mesh, e, p, nodes, X);

    for (int c = 0; c < components; c++) {
      value[p * components + c] = SceneLoadValue(load, c, X, t);
      CheckFinite(mesh, scene, load, c, "near", node, t, value[p * components + c], complaint);
      if (LoadVaries(load) && !SceneLoadVaries(load, c)) value[p * components + c] *= HistoryValue(&load->history, t);
    }
  }
  return components;
}
