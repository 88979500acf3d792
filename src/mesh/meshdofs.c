/* Unknowns of a mesh: their vectors, and exchange of nodal values through the SF of the nodes. */
#include "mesh/meshdofs.h"
#include "meshplex.h"

/* Creates the MPI type of a node's values, `block` reals, to be freed with NodeTypeFree(). The values are reals,
   because MPI would treat two 64-bit integers as its pair type. One value is the basic type itself: PetscSF cannot sum
   with a contiguous type of one. */
static PetscErrorCode NodeTypeCreate(PetscInt block, MPI_Datatype *type)
{
  PetscMPIInt count;

  PetscFunctionBeginUser;
  *type = MPIU_REAL;
  if (block == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMPIIntCast(block, &count));
  PetscCallMPI(MPI_Type_contiguous(count, MPIU_REAL, type));
  PetscCallMPI(MPI_Type_commit(type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode NodeTypeFree(MPI_Datatype *type)
{
  PetscFunctionBeginUser;
  if (*type != MPIU_REAL) PetscCallMPI(MPI_Type_free(type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies the owners' values to the other copies of a node. */
static PetscErrorCode CopyNodes(Mesh mesh, PetscInt block, PetscReal *values)
{
  MPI_Datatype type;

  PetscFunctionBeginUser;
  PetscCall(NodeTypeCreate(block, &type));
  PetscCall(PetscSFBcastBegin(mesh->node_sf, type, values, values, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(mesh->node_sf, type, values, values, MPI_REPLACE));
  PetscCall(NodeTypeFree(&type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the copies' values to their owners' sums. values and sums may be the same array. */
static PetscErrorCode AddNodes(Mesh mesh, PetscInt block, const PetscReal *values, PetscReal *sums)
{
  MPI_Datatype type;

  PetscFunctionBeginUser;
  PetscCall(NodeTypeCreate(block, &type));
  PetscCall(PetscSFReduceBegin(mesh->node_sf, type, values, sums, MPIU_SUM));
  PetscCall(PetscSFReduceEnd(mesh->node_sf, type, values, sums, MPIU_SUM));
  PetscCall(NodeTypeFree(&type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshSetConstraints - sets which dofs are prescribed and numbers the free ones.

  Collective

  Input Parameters:
+ mesh        - the mesh
- constrained - for each local dof [n_nodes*dim]; a dof is prescribed if any rank that has its node says so

  Note:
  Call it before vectors and matrices are created, because older ones do not fit any more.
@*/
PetscErrorCode MeshSetConstraints(Mesh mesh, const PetscBool *constrained)
{
  const PetscInt n = mesh->n_nodes * mesh->dim;
  PetscReal     *votes;
  PetscBool     *agreed;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &votes, n, &agreed));
  for (PetscInt i = 0; i < n; i++) votes[i] = constrained[i] ? 1 : 0;
  PetscCall(MeshSumNodes(mesh, mesh->dim, votes));
  for (PetscInt i = 0; i < n; i++) agreed[i] = votes[i] > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(MeshPlexNumberDofs(mesh, agreed));
  PetscCall(PetscFree2(votes, agreed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshGetGlobalDofs - returns the global numbers of the local dofs.

  Not collective

  Input Parameter:
. mesh - the mesh, after MeshSetConstraints()

  Output Parameter:
. dofs - global numbers [n_nodes*dim], also for nodes of other ranks; -1 where constrained

  Note:
  The array belongs to the mesh. Each MeshSetConstraints() makes a new one.
@*/
PetscErrorCode MeshGetGlobalDofs(Mesh mesh, const PetscInt **dofs)
{
  PetscFunctionBeginUser;
  *dofs = mesh->global_dofs;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshCreateVector - creates a vector over the free dofs.

  Collective

  Input Parameter:
. mesh - the mesh, after MeshSetConstraints()

  Output Parameter:
. x - 0; the caller destroys it

  Note:
  VecGetDM() returns the mesh's DMPlex, also for its duplicates.
@*/
PetscErrorCode MeshCreateVector(Mesh mesh, Vec *x)
{
  PetscFunctionBeginUser;
  PetscCall(DMCreateGlobalVector(mesh->dm, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshGlobalToLocal - copies free displacements from a global vector to the local array, ghost nodes included.

  Collective

  Input Parameters:
+ mesh - the mesh, after MeshSetConstraints()
- x    - over the free dofs

  Output Parameter:
. u - local values [n_nodes*dim]; constrained entries are not changed
@*/
PetscErrorCode MeshGlobalToLocal(Mesh mesh, Vec x, PetscReal *u)
{
  const PetscInt     n = mesh->n_nodes * mesh->dim;
  const PetscScalar *values;
  PetscInt           first, last;

  PetscFunctionBeginUser;
  PetscCall(VecGetOwnershipRange(x, &first, &last));
  PetscCall(VecGetArrayRead(x, &values));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt dof = mesh->global_dofs[i];

    mesh->work[i] = dof >= first && dof < last ? PetscRealPart(values[dof - first]) : 0;
  }
  PetscCall(VecRestoreArrayRead(x, &values));
  PetscCall(CopyNodes(mesh, mesh->dim, mesh->work));
  for (PetscInt i = 0; i < n; i++)
    if (mesh->global_dofs[i] >= 0) u[i] = mesh->work[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshCollectFree - copies the free values from the local array to a global vector, each from the rank that owns it.

  Not collective

  Input Parameters:
+ mesh - the mesh, after MeshSetConstraints()
- u    - local values [n_nodes*dim]; those of ghost nodes are ignored

  Output Parameter:
. x - over the free dofs, overwritten
@*/
PetscErrorCode MeshCollectFree(Mesh mesh, const PetscReal *u, Vec x)
{
  PetscScalar *values;
  PetscInt     first, last;

  PetscFunctionBeginUser;
  PetscCall(VecGetOwnershipRange(x, &first, &last));
  PetscCall(VecGetArrayWrite(x, &values));
  for (PetscInt i = 0; i < mesh->n_nodes * mesh->dim; i++) {
    const PetscInt dof = mesh->global_dofs[i];

    if (dof >= first && dof < last) values[dof - first] = u[i];
  }
  PetscCall(VecRestoreArrayWrite(x, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshLocalToGlobal - sums local contributions of all ranks into a global vector over the free dofs.

  Collective

  Input Parameters:
+ mesh - the mesh, after MeshSetConstraints()
- f    - contributions of this rank [n_nodes*dim]

  Output Parameter:
. F - over the free dofs, overwritten
@*/
PetscErrorCode MeshLocalToGlobal(Mesh mesh, const PetscReal *f, Vec F)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(mesh->work, f, mesh->n_nodes * mesh->dim));
  PetscCall(AddNodes(mesh, mesh->dim, f, mesh->work));
  PetscCall(MeshCollectFree(mesh, mesh->work, F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshSumNodes - sums nodal values over all ranks' copies of a node.

  Collective

  Input Parameters:
+ mesh   - the mesh
. block  - values per node
- values - nodal values [n_nodes*block]; replaced by the sums, the same on every copy
@*/
PetscErrorCode MeshSumNodes(Mesh mesh, PetscInt block, PetscReal *values)
{
  PetscFunctionBeginUser;
  PetscCall(AddNodes(mesh, block, values, values));
  PetscCall(CopyNodes(mesh, block, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshCreateLocal - makes room for nodal values, which are 0.

  Not collective

  Input Parameters:
+ mesh  - the mesh
- block - values per node

  Output Parameter:
. values - values[n_nodes*block]; the caller frees them with PetscFree()

  Note:
  They are not NULL on a rank without nodes, on which other allocations of no bytes are. Functions in which NULL stands
  for values that are not there then go the same way on all ranks.
@*/
PetscErrorCode MeshCreateLocal(Mesh mesh, PetscInt block, PetscReal **values)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * block + 1, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}
