/* Springs on surfaces, see foundation.h. */
#include "bodies/foundation.h"
#include "kernels/elementkernel.h"

/* A surface with springs */
typedef struct {
  const MeshGroup *group;
  const PetscReal *spring;  /* 3: force per length and area */
  const History   *history; /* factor over the load parameter; NULL: 1 */
} SpringSurface;

struct _n_Foundation {
  Mesh           mesh;
  Geometry       geometry;
  int            n;
  SpringSurface *surfaces;
  PetscBool     *holds; /* [n_nodes*dim] */
  PetscReal     *force; /* of the springs on this rank's faces, at the last residual [n_nodes*dim] */
};

static PetscBool HasSpring(const SceneSupport *support)
{
  return (PetscBool)(support->spring[0] > 0 || support->spring[1] > 0 || support->spring[2] > 0);
}

/* Marks the dofs of a surface that its springs hold. */
static void MarkHeld(Foundation foundation, const SpringSurface *surface)
{
  const int dim = foundation->mesh->dim;

  for (PetscInt i = 0; i < surface->group->n_nodes; i++)
    for (int d = 0; d < dim; d++)
      if (surface->spring[d] > 0) foundation->holds[surface->group->nodes[i] * dim + d] = PETSC_TRUE;
}

/*@
  FoundationCreate - reads the springs of the scene's supports.

  Collective

  Input Parameters:
+ mesh  - the mesh; borrowed
- scene - the scene; borrowed

  Output Parameter:
. out - free it with FoundationDestroy(); NULL without springs, which every function of this file takes
@*/
PetscErrorCode FoundationCreate(Mesh mesh, Scene scene, Foundation *out)
{
  Foundation foundation;
  int        n = 0;

  PetscFunctionBeginUser;
  *out = NULL;
  for (int s = 0; s < scene->n_supports; s++) n += HasSpring(&scene->supports[s]);
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&foundation));
  *out                 = foundation; /* FoundationDestroy() frees what a refusal leaves */
  foundation->mesh     = mesh;
  foundation->geometry = scene->geometry;
  PetscCall(PetscCalloc2(n, &foundation->surfaces, mesh->n_nodes * mesh->dim, &foundation->holds));
  PetscCall(MeshCreateLocal(mesh, mesh->dim, &foundation->force));
  for (int s = 0; s < scene->n_supports; s++) {
    const SceneSupport *support = &scene->supports[s];
    SpringSurface      *surface = &foundation->surfaces[foundation->n];
    MeshGroup          *group;

    if (!HasSpring(support)) continue;
    PetscCall(MeshGetGroup(mesh, scene, support->path, "surface", support->surface, mesh->dim - 1, &group));
    *surface = (SpringSurface){.group   = group,
                               .spring  = support->spring,
                               .history = support->history.n ? &support->history : NULL};
    MarkHeld(foundation, surface);
    foundation->n++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FoundationDestroy - frees the springs.

  Collective

  Input Parameter:
. foundation - set to NULL; may be NULL already
@*/
PetscErrorCode FoundationDestroy(Foundation *foundation)
{
  PetscFunctionBeginUser;
  if (!*foundation) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2((*foundation)->surfaces, (*foundation)->holds));
  PetscCall(PetscFree((*foundation)->force));
  PetscCall(PetscFree(*foundation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes of face f and its matrix int N_a N_b dA. Returns the number of nodes. */
static int FaceMatrix(Foundation foundation, const SpringSurface *surface, PetscInt f, PetscInt nodes[], double *matrix)
{
  Mesh              mesh = foundation->mesh;
  const ElementType type = MeshFaceNodes(mesh, surface->group, f, nodes);
  const int         n    = ElementGet(type)->nodes;
  double            X[FACE_MAX_NODES * 3];

  MeshGatherNodes(mesh, n, nodes, mesh->coords, X);
  FaceMassKernel(type, mesh->dim, foundation->geometry, X, matrix);
  return n;
}

/* Adds the forces of the springs of one face, their energy and their squares. */
static void FaceForces(Foundation foundation, const SpringSurface *surface, PetscReal factor, PetscInt f,
                       const PetscReal *u, PetscReal *forces, PetscReal *energy, PetscReal *force2)
{
  const int dim = foundation->mesh->dim;
  PetscInt  nodes[FACE_MAX_NODES];
  double    matrix[FACE_MAX_NODES * FACE_MAX_NODES];
  const int n = FaceMatrix(foundation, surface, f, nodes, matrix);

  for (int a = 0; a < n; a++) {
    for (int d = 0; d < dim; d++) {
      PetscReal force = 0;

      for (int b = 0; b < n; b++) force -= factor * surface->spring[d] * matrix[a * n + b] * u[nodes[b] * dim + d];
      forces[nodes[a] * dim + d] += force;
      if (energy) *energy -= force * u[nodes[a] * dim + d] / 2;
      if (force2) *force2 += PetscSqr(force);
    }
  }
}

/*@
  FoundationAddForces - adds the forces of the springs at some displacements.

  Not collective

  Input Parameters:
+ foundation - the springs; NULL: there are none
. t          - load parameter
- u          - local displacements (length) [n_nodes*dim], ghosts included

  Output Parameters:
+ forces - on the bodies, to which this rank's part is added [n_nodes*dim]
. energy - the energy of the springs is added; or NULL
- force2 - the squares of the unassembled forces are added; or NULL
@*/
void FoundationAddForces(Foundation foundation, PetscReal t, const PetscReal *u, PetscReal *forces, PetscReal *energy,
                         PetscReal *force2)
{
  for (int s = 0; foundation && s < foundation->n; s++)
    for (PetscInt face = 0; face < foundation->surfaces[s].group->n_faces; face++)
      FaceForces(foundation, &foundation->surfaces[s], HistoryFactor(foundation->surfaces[s].history, t), face, u,
                 forces, energy, force2);
}

/*@
  FoundationResidual - subtracts the forces of the springs from the residual.

  Not collective

  Input Parameters:
+ foundation - the springs
. t          - load parameter
- u          - local displacements (length) [n_nodes*dim]

  Output Parameters:
+ f      - [n_nodes*dim], from which the forces are subtracted
. energy - the energy of the springs is added
- force2 - the squares of the unassembled forces are added

  Note:
  f, energy and force2 may be NULL; each is this rank's part.
@*/
PetscErrorCode FoundationResidual(Foundation foundation, PetscReal t, const PetscReal *u, PetscReal *f,
                                  PetscReal *energy, PetscReal *force2)
{
  PetscFunctionBeginUser;
  if (!foundation) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArrayzero(foundation->force, foundation->mesh->n_nodes * foundation->mesh->dim));
  FoundationAddForces(foundation, t, u, foundation->force, energy, force2);
  for (PetscInt i = 0; f && i < foundation->mesh->n_nodes * foundation->mesh->dim; i++) f[i] -= foundation->force[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FoundationTangent - adds the stiffness of the springs to the local block CSR of the elasticity.

  Not collective

  Input Parameters:
+ foundation - the springs
. t          - load parameter
- elasticity - after ElasticityTangent()
@*/
PetscErrorCode FoundationTangent(Foundation foundation, PetscReal t, Elasticity elasticity)
{
  PetscInt nodes[FACE_MAX_NODES];
  double   matrix[FACE_MAX_NODES * FACE_MAX_NODES], ke[FACE_MAX_NODES * 3 * FACE_MAX_NODES * 3];

  PetscFunctionBeginUser;
  for (int s = 0; foundation && s < foundation->n; s++) {
    const SpringSurface *surface = &foundation->surfaces[s];
    const PetscReal      factor  = HistoryFactor(surface->history, t);
    const int            dim     = foundation->mesh->dim;

    for (PetscInt f = 0; f < surface->group->n_faces; f++) {
      const int n = FaceMatrix(foundation, surface, f, nodes, matrix), dofs = n * dim;

      for (int i = 0; i < dofs; i++)
        for (int j = 0; j < dofs; j++)
          ke[i * dofs + j] = i % dim == j % dim ? factor * surface->spring[i % dim] * matrix[i / dim * n + j / dim] : 0;
      PetscCall(ElasticityAddBlock(elasticity, n, nodes, ke));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FoundationHolds - tells whether a spring acts on a local dof.

  Not collective

  Input Parameters:
+ foundation - the springs
- local_dof  - number of the dof, local node times dim plus component
@*/
PetscBool FoundationHolds(Foundation foundation, PetscInt local_dof)
{
  return (PetscBool)(foundation && foundation->holds[local_dof]);
}

/*@
  FoundationForce - returns the forces of the springs on this rank's faces at the last residual.

  Not collective

  Input Parameter:
. foundation - it owns the array [n_nodes*dim]; NULL: the result is NULL
@*/
const PetscReal *FoundationForce(Foundation foundation)
{
  return foundation ? foundation->force : NULL;
}
