/* Rigid tools with free motions, see tools.h. */
#include "bodies/tools.h"
#include <string.h>

/*@
  ToolDof - returns the place of a component of a tool's motion among the dofs of its nodes.

  Not collective

  Input Parameters:
+ mesh      - the mesh
- component - 0 to 5: ux, uy, uz, rx, ry, rz

  Note:
  It is counted from the first dof of the first node. -1: the plane has no such component. Rotations count times the
  tool's arm.
@*/
int ToolDof(Mesh mesh, int component)
{
  if (component < 3) return component < mesh->dim ? component : -1;
  if (mesh->dim == 3) return component;
  return component == 5 ? mesh->dim : -1;
}

/*@
  ToolOfPair - finds the tool with free motions that is the master of a contact pair.

  Not collective

  Input Parameters:
+ mesh    - the mesh
. scene   - the scene
- contact - number of the pair in the scene

  Note:
  It returns NULL where the master is no such tool.
@*/
const MeshTool *ToolOfPair(Mesh mesh, Scene scene, int contact)
{
  for (int k = 0; k < mesh->n_tools; k++) {
    const MeshTool *tool = &mesh->tools[k];

    if (tool->contact == contact) return tool;
    if (tool->body >= 0 && !tool->bolt && SceneContactHasMaster(&scene->contacts[contact], tool->name)) return tool;
  }
  return NULL;
}

/*@
  ToolOfBolt - finds the unknown of a body that is tightened as a bolt.

  Not collective

  Input Parameters:
+ mesh - the mesh
- body - name of the body

  Note:
  It returns NULL where the body is no bolt.
@*/
const MeshTool *ToolOfBolt(Mesh mesh, const char *body)
{
  for (int k = 0; k < mesh->n_tools; k++)
    if (mesh->tools[k].bolt && !strcmp(mesh->tools[k].name, body)) return &mesh->tools[k];
  return NULL;
}

/* The components of a tool's motion in the displacements of its nodes: lengths and radians. */
static void Components(Mesh mesh, const MeshTool *tool, const PetscReal *own, PetscReal q[MOTION_COMPONENTS])
{
  for (int c = 0; c < MOTION_COMPONENTS; c++) {
    const int dof = ToolDof(mesh, c);

    q[c] = dof < 0 ? 0 : own[dof] / (c < 3 ? 1 : tool->arm);
  }
}

/*@
  ToolGetPlace - gives the place of a tool's point and the tool's rotation vector.

  Not collective

  Input Parameters:
+ mesh - the mesh
. tool - one of its tools
- own  - displacements of its two nodes (length)

  Output Parameters:
+ point - the tool's point, relative to the mesh's centre (length)
- turn  - rotation vector (radians)
@*/
void ToolGetPlace(Mesh mesh, const MeshTool *tool, const PetscReal *own, PetscReal point[3], PetscReal turn[3])
{
  PetscReal q[MOTION_COMPONENTS];

  Components(mesh, tool, own, q);
  for (int d = 0; d < 3; d++) {
    point[d] = d < mesh->dim ? mesh->coords[tool->node * mesh->dim + d] + q[d] : 0;
    turn[d]  = q[3 + d];
  }
}

/*@
  ToolsConstrain - marks the dofs of tools that are not free.

  Not collective

  Input Parameter:
. mesh - the mesh

  Output Parameter:
. constrained - of each local dof [n_nodes*dim]; those of the tools' nodes are written
@*/
void ToolsConstrain(Mesh mesh, PetscBool *constrained)
{
  for (int k = 0; k < mesh->n_tools; k++) {
    const MeshTool *tool = &mesh->tools[k];

    for (int i = 0; i < 2 * mesh->dim; i++) constrained[tool->node * mesh->dim + i] = PETSC_TRUE;
    for (int c = 0; c < MOTION_COMPONENTS; c++)
      if (tool->motion->free[c]) constrained[tool->node * mesh->dim + ToolDof(mesh, c)] = PETSC_FALSE;
  }
}

/*@
  ToolsPrescribe - writes the components of tools that are not free.

  Not collective

  Input Parameters:
+ mesh - the mesh
- t    - load parameter

  Output Parameter:
. u - local displacements u[n_nodes*dim] (length)
@*/
void ToolsPrescribe(Mesh mesh, PetscReal t, PetscReal *u)
{
  for (int k = 0; k < mesh->n_tools; k++) {
    const MeshTool *tool = &mesh->tools[k];
    PetscReal       q[MOTION_COMPONENTS];

    MotionComponents(tool->motion, t, q);
    if (mesh->dim == 2) u[tool->node * mesh->dim + mesh->dim + 1] = 0; /* the plane has one rotation */
    for (int c = 0; c < MOTION_COMPONENTS; c++) {
      const int dof = ToolDof(mesh, c);

      if (dof >= 0 && !tool->motion->free[c]) u[tool->node * mesh->dim + dof] = q[c] * (c < 3 ? 1 : tool->arm);
    }
  }
}

/*@
  ToolMove - moves a tool to the displacements of an iterate.

  Not collective

  Input Parameters:
+ mesh - the mesh
. tool - one of its tools
. own  - displacements of its two nodes (length)
- t    - load parameter
@*/
void ToolMove(Mesh mesh, const MeshTool *tool, const PetscReal *own, PetscReal t)
{
  PetscReal q[MOTION_COMPONENTS];

  Components(mesh, tool, own, q);
  MotionSet(tool->motion, t, q);
}

/*@
  ToolsPlace - moves the tools to the displacements of an iterate.

  Not collective

  Input Parameters:
+ mesh - the mesh
. u    - local displacements u[n_nodes*dim] (length), ghosts included
- t    - load parameter
@*/
void ToolsPlace(Mesh mesh, const PetscReal *u, PetscReal t)
{
  for (int k = 0; k < mesh->n_tools; k++) ToolMove(mesh, &mesh->tools[k], &u[mesh->tools[k].node * mesh->dim], t);
}

/*@
  ToolsAccept - moves the tools to displacements that become those of the accepted state.

  Not collective

  Input Parameters:
+ mesh - the mesh
. u    - local displacements u[n_nodes*dim] (length), ghosts included
- t    - load parameter
@*/
void ToolsAccept(Mesh mesh, const PetscReal *u, PetscReal t)
{
  PetscReal q[MOTION_COMPONENTS];

  for (int k = 0; k < mesh->n_tools; k++) {
    Components(mesh, &mesh->tools[k], &u[mesh->tools[k].node * mesh->dim], q);
    MotionAccept(mesh->tools[k].motion, t, q);
  }
}

/*@
  ToolsTurn - finds the tool that turns most by its free rotations from one state to another.

  Not collective, the same on all ranks

  Input Parameters:
+ mesh - the mesh
. u_0  - local displacements u_0[n_nodes*dim] (length) of the first state
- u    - those of the second state

  Output Parameter:
. tool - that tool; NULL where none has a free rotation; may be NULL

  Note:
  It returns the change of the rotation vector (radians).
@*/
PetscReal ToolsTurn(Mesh mesh, const PetscReal *u_0, const PetscReal *u, const MeshTool **tool)
{
  PetscReal most = 0;

  if (tool) *tool = NULL;
  for (int k = 0; k < mesh->n_tools; k++) {
    const PetscInt first  = mesh->tools[k].node * mesh->dim;
    PetscReal      square = 0;

    for (int c = 3; c < MOTION_COMPONENTS; c++)
      if (mesh->tools[k].motion->free[c])
        square += PetscSqr((u[first + ToolDof(mesh, c)] - u_0[first + ToolDof(mesh, c)]) / mesh->tools[k].arm);
    if (!(square > PetscSqr(most))) continue;
    most = PetscSqrtReal(square);
    if (tool) *tool = &mesh->tools[k];
  }
  return most;
}

/*@
  ToolsResidual - subtracts the forces and moments on the tools from the residual.

  Not collective

  Input Parameters:
+ mesh - the mesh
. t    - load parameter
- u    - local displacements u[n_nodes*dim] (length)

  Output Parameters:
+ f      - [n_nodes*dim], from which the forces are subtracted
. energy - their potential is added
- force2 - their squares are added

  Note:
  f, energy and force2 may be NULL; each is this rank's part. A moment does its work along the rotation vector.
@*/
void ToolsResidual(Mesh mesh, PetscReal t, const PetscReal *u, PetscReal *f, PetscReal *energy, PetscReal *force2)
{
  PetscMPIInt rank;

  (void)MPI_Comm_rank(mesh->comm, &rank);
  for (int k = 0; k < mesh->n_tools && !rank; k++) {
    const MeshTool *tool = &mesh->tools[k];

    if (tool->bolt && t > tool->bolt->locked) {
      const PetscReal way = u[tool->node * mesh->dim] - tool->motion->accepted.value[0];

      if (f) f[tool->node * mesh->dim] += tool->stiffness * way;
      if (energy) *energy += tool->stiffness * way * way / 2;
      if (force2) *force2 += PetscSqr(tool->stiffness * way);
      continue;
    }
    for (int c = 0; c < MOTION_COMPONENTS; c++) {
      const PetscInt  dof   = tool->node * mesh->dim + ToolDof(mesh, c);
      const PetscReal force = tool->motion->free[c] ? MotionForce(tool->motion, t, c) / (c < 3 ? 1 : tool->arm) : 0;

      if (!tool->motion->free[c]) continue;
      if (f) f[dof] -= force;
      if (energy) *energy -= force * u[dof];
      if (force2) *force2 += PetscSqr(force);
    }
  }
}

/*@
  ToolsTangent - adds the stiffness of what keeps the length of bolts to the local block CSR of the elasticity.

  Not collective

  Input Parameters:
+ mesh       - the mesh
. t          - load parameter
- elasticity - after ElasticityTangent()
@*/
PetscErrorCode ToolsTangent(Mesh mesh, PetscReal t, Elasticity elasticity)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  for (int k = 0; k < mesh->n_tools && !rank; k++) {
    const MeshTool *tool  = &mesh->tools[k];
    PetscReal       ke[9] = {tool->stiffness};

    if (tool->bolt && t > tool->bolt->locked) PetscCall(ElasticityAddBlock(elasticity, 1, &tool->node, ke));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
