/* Connected pieces of the mesh. Every node begins with its id as a label, and the lowest label spreads over cells and
   ranks until nothing changes. */
#include "mesh/meshpieces.h"
#include "mesh/pressurenodes.h"

/* Gives all nodes of a cell the lowest of their labels, and repeats this until nothing changes on this rank. Cells are
   visited forwards and backwards, because labels then spread along rows of cells quickly. Returns whether any label
   changed. */
static PetscBool SpreadInCells(Mesh mesh, PetscInt label[])
{
  PetscBool any = PETSC_FALSE, changed = PETSC_TRUE;

  while (changed) {
    changed = PETSC_FALSE;
    for (PetscInt k = 0; k < 2 * mesh->n_cells; k++) {
      const PetscInt c   = k < mesh->n_cells ? k : 2 * mesh->n_cells - 1 - k;
      PetscInt       low = label[mesh->cell_nodes[mesh->cell_ptr[c]]];

      for (PetscInt i = mesh->cell_ptr[c]; i < mesh->cell_ptr[c + 1]; i++)
        low = PetscMin(low, label[mesh->cell_nodes[i]]);
      for (PetscInt i = mesh->cell_ptr[c]; i < mesh->cell_ptr[c + 1]; i++) {
        if (label[mesh->cell_nodes[i]] == low) continue;
        label[mesh->cell_nodes[i]] = low;
        changed = any = PETSC_TRUE;
      }
    }
  }
  return any;
}

/* Gives all copies of a node the lowest of their labels. */
static PetscErrorCode SpreadOverRanks(Mesh mesh, PetscInt label[])
{
  PetscInt *low;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes, &low));
  PetscCall(PetscArraycpy(low, label, mesh->n_nodes));
  PetscCall(PetscSFReduceBegin(mesh->node_sf, MPIU_INT, label, low, MPI_MIN));
  PetscCall(PetscSFReduceEnd(mesh->node_sf, MPIU_INT, label, low, MPI_MIN));
  PetscCall(PetscArraycpy(label, low, mesh->n_nodes));
  PetscCall(PetscSFBcastBegin(mesh->node_sf, MPIU_INT, low, label, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(mesh->node_sf, MPIU_INT, low, label, MPI_REPLACE));
  PetscCall(PetscFree(low));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the lowest label above the last one, over all ranks; PETSC_MAX_INT if there is none. */
static PetscErrorCode NextLabel(Mesh mesh, const PetscInt label[], PetscInt last, PetscInt *next)
{
  PetscFunctionBeginUser;
  *next = PETSC_MAX_INT;
  for (PetscInt i = 0; i < mesh->n_nodes; i++)
    if (label[i] > last) *next = PetscMin(*next, label[i]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, next, 1, MPIU_INT, MPI_MIN, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshFindPieces - finds the connected pieces of the mesh.

  Collective

  Input Parameter:
. mesh - the mesh

  Output Parameters:
+ n     - number of pieces on all ranks together
- piece - piece of each local node [n_nodes]

  Note:
  A tool with free motions is a piece of its own. Pieces are numbered in the order of their lowest gmsh node tag, so
that the numbers are the same on any number of ranks.
@*/
PetscErrorCode MeshFindPieces(Mesh mesh, PetscInt *n, PetscInt piece[])
{
  PetscInt   *label, last = -1;
  PetscMPIInt changed = 1;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes, &label));
  PetscCall(PetscArraycpy(label, mesh->node_id, mesh->n_nodes));
  for (PetscInt i = 0; i < mesh->n_pressure_nodes; i++) label[PressureNodeOf(mesh, i)] = -1;
  for (int k = 0; k < mesh->n_tools; k++) label[mesh->tools[k].node + 1] = label[mesh->tools[k].node];
  while (changed) {
    changed = SpreadInCells(mesh, label);
    PetscCall(SpreadOverRanks(mesh, label));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &changed, 1, MPI_INT, MPI_LOR, mesh->comm));
  }
  for (*n = 0;; (*n)++) {
    PetscInt next;

    PetscCall(NextLabel(mesh, label, last, &next));
    if (next == PETSC_MAX_INT) break;
    for (PetscInt i = 0; i < mesh->n_nodes; i++)
      if (label[i] == next) piece[i] = *n;
    last = next;
  }
  for (PetscInt i = 0; i < mesh->n_pressure_nodes; i++) piece[PressureNodeOf(mesh, i)] = piece[i];
  PetscCall(PetscFree(label));
  PetscFunctionReturn(PETSC_SUCCESS);
}
