#include "partition.h"
#include <metis.h>

enum { METIS_SEED = 1 }; /* any fixed number: the same mesh and ranks give the same partition */

/* How far parts may exceed the mean: cells decide the cost of every Newton iteration, contact cells a small part of it */
static const real_t CELL_TOLERANCE = 1.03f, CONTACT_TOLERANCE = 1.10f;

static PetscErrorCode IndexCast(PetscInt value, idx_t *index)
{
  PetscFunctionBeginUser;
  *index = (idx_t)value;
  PetscCheck((PetscInt)*index == value, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%" PetscInt_FMT " does not fit into METIS' index type of %zu bytes", value,
             sizeof(idx_t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode IndexArrayCast(PetscInt n, const PetscInt values[], idx_t **indices)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, indices));
  for (PetscInt i = 0; i < n; i++) PetscCall(IndexCast(values[i], &(*indices)[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  PartitionImbalance - the largest part over the mean; 1 where there is nothing to share out

  Not Collective

  Input Parameters:
+ n       - number of cells
. part    - per cell
. counted - per cell, or NULL: all of them
- parts   - number of parts

  Output Parameter:
. count - cells counted, per part
*/
PetscReal PartitionImbalance(PetscInt n, const PetscInt part[], const PetscBool counted[], PetscInt parts, PetscInt count[])
{
  PetscInt total = 0, largest = 0;

  for (PetscInt p = 0; p < parts; p++) count[p] = 0;
  for (PetscInt c = 0; c < n; c++) {
    if (counted && !counted[c]) continue;
    total++;
    count[part[c]]++;
    largest = PetscMax(largest, count[part[c]]);
  }
  return total ? (PetscReal)largest * parts / (PetscReal)total : 1;
}

/*
  PartitionGraph - METIS' k-way partition of a graph of cells

  Not Collective

  Input Parameters:
+ n         - number of cells
. offsets   - where each cell's neighbours start in adjacency, n + 1
. adjacency - neighbours
. contact   - per cell, whether it has a face in contact (a second weight), or NULL: cells alone are balanced
- parts     - number of parts, at least 2

  Output Parameters:
+ part     - per cell
- edge_cut - pairs of neighbours in different parts
*/
PetscErrorCode PartitionGraph(PetscInt n, const PetscInt offsets[], const PetscInt adjacency[], const PetscBool contact[], PetscInt parts, PetscInt part[],
                              PetscInt *edge_cut)
{
  idx_t *xadj, *adjncy, *weights, *found, options[METIS_NOPTIONS], n_vertices, n_constraints = 1, n_parts, cut = 0;
  real_t tolerance[2] = {CELL_TOLERANCE, CONTACT_TOLERANCE};
  int    status;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; contact && c < n; c++)
    if (contact[c]) n_constraints = 2; /* a constraint whose weights are all zero cannot be balanced */
  PetscCall(IndexCast(n, &n_vertices));
  PetscCall(IndexCast(parts, &n_parts));
  PetscCall(IndexArrayCast(n + 1, offsets, &xadj));
  PetscCall(IndexArrayCast(offsets[n], adjacency, &adjncy));
  PetscCall(PetscMalloc2(n * n_constraints, &weights, n, &found));
  for (PetscInt c = 0; c < n; c++) {
    weights[c * n_constraints] = 1;
    if (n_constraints == 2) weights[c * n_constraints + 1] = contact[c] ? 1 : 0;
  }
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED]      = METIS_SEED;
  options[METIS_OPTION_NUMBERING] = 0;
  status = METIS_PartGraphKway(&n_vertices, &n_constraints, xadj, adjncy, weights, NULL, NULL, &n_parts, NULL, tolerance, options, &cut, found);
  PetscCheck(status == METIS_OK, PETSC_COMM_SELF, PETSC_ERR_LIB, "METIS failed with status %d", status);
  *edge_cut = (PetscInt)cut;
  for (PetscInt c = 0; c < n; c++) part[c] = (PetscInt)found[c];
  PetscCall(PetscFree(xadj));
  PetscCall(PetscFree(adjncy));
  PetscCall(PetscFree2(weights, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells by part, as PETSCPARTITIONERSHELL wants them */
static PetscErrorCode PartitionSort(PetscInt n, const PetscInt part[], PetscMPIInt parts, const PetscInt sizes[], PetscInt cells[])
{
  PetscInt *next;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(parts + 1, &next));
  for (PetscMPIInt p = 0; p < parts; p++) next[p + 1] = next[p] + sizes[p];
  for (PetscInt c = 0; c < n; c++) cells[next[part[c]]++] = c;
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  PartitionCells - decides which rank gets which cell

  Collective

  Input Parameters:
+ dm      - DMPlex, interpolated, all its cells on rank 0
- contact - on rank 0: per cell, whether it has a face in contact (a second weight, so that contact work is shared out too)

  Output Parameter:
. partition - tool, edge cut and imbalances, the same on all ranks

  Note:
  DMPlexDistribute() follows the partition afterwards.
*/
PetscErrorCode PartitionCells(DM dm, const PetscBool contact[], Partition *partition)
{
  MPI_Comm         comm = PetscObjectComm((PetscObject)dm);
  PetscPartitioner partitioner;
  PetscMPIInt      rank, size;
  PetscInt         n, *offsets, *adjacency, *sizes, *contact_sizes, *cells, *part;
  PetscReal        imbalances[2] = {1, 1};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  *partition = (Partition){.tool = "none", .imbalance_cells = 1, .imbalance_contact = 1};
  if (size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  partition->tool = "metis";
  PetscCall(DMPlexCreatePartitionerGraph(dm, 0, &n, &offsets, &adjacency, NULL));
  PetscCall(PetscCalloc4(size, &sizes, size, &contact_sizes, n, &cells, n, &part));
  if (!rank) {
    PetscCall(PartitionGraph(n, offsets, adjacency, contact, size, part, &partition->edge_cut));
    imbalances[0] = PartitionImbalance(n, part, NULL, size, sizes);
    imbalances[1] = PartitionImbalance(n, part, contact, size, contact_sizes);
    PetscCall(PartitionSort(n, part, size, sizes, cells));
  }
  PetscCall(DMPlexGetPartitioner(dm, &partitioner));
  PetscCall(PetscPartitionerSetType(partitioner, PETSCPARTITIONERSHELL));
  PetscCall(PetscPartitionerShellSetPartition(partitioner, size, sizes, cells));
  PetscCallMPI(MPI_Bcast(&partition->edge_cut, 1, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(imbalances, 2, MPIU_REAL, 0, comm));
  partition->imbalance_cells   = imbalances[0];
  partition->imbalance_contact = imbalances[1];
  PetscCall(PetscFree4(sizes, contact_sizes, cells, part));
  PetscCall(PetscFree(offsets));
  PetscCall(PetscFree(adjacency));
  PetscFunctionReturn(PETSC_SUCCESS);
}
