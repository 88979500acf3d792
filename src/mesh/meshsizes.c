/* Sizes of elements, see meshsizes.h. */
#include "mesh/meshsizes.h"
#include "private/toolsizes.h"
#include "mesh/mesh.h"
#include "kernels/elementkernel.h"
#include <math.h>
#include <stdio.h>

/* By how much the size may grow per length: an element is then at most so much larger than its neighbour, in parts. */
#define SIZES_GROWTH 0.35
/* The bound on growth is passed on from node to node at most so many times along the cells. */
enum { SIZES_SWEEPS = 50 };

enum { CORNERS = 8, CORNER_WIDTH = 4 /* node and place */, RECORD = 3 + CORNERS * CORNER_WIDTH };

/*@
  MeshCellSizes - measures the elements.

  Not collective

  Input Parameter:
. mesh - the mesh

  Output Parameters:
+ size    - length of an edge of the regular element of the same measure, for each local cell
- measure - area or volume between its corners; not that of revolution
@*/
void MeshCellSizes(Mesh mesh, PetscReal *size, PetscReal *measure)
{
  const Geometry flat = mesh->dim == 2 ? GEOMETRY_PLANE_STRAIN : GEOMETRY_SOLID;

  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const ElementType type = ElementCornerType(mesh->dim, ElementGet(mesh->cell_type[c])->corners);
    PetscReal         x[ELEMENT_MAX_NODES * 3];

    MeshCellCoordinates(mesh, c, x);
    measure[c] = CellVolume(type, mesh->dim, flat, x);
    size[c]    = ElementRegularSize(mesh->dim, ElementGet(type)->corners, measure[c]);
  }
}

/* Describes the local cells: id, corners, wanted size, then node and place of each corner. */
static void Describe(Mesh mesh, const PetscReal *size, double *record)
{
  for (PetscInt c = 0; c < mesh->n_cells; c++, record += RECORD) {
    const int corners = ElementGet(mesh->cell_type[c])->corners;

    record[0] = (double)mesh->cell_id[c];
    record[1] = corners;
    record[2] = (double)size[c];
    for (int k = 0; k < corners; k++) {
      const PetscInt node = mesh->cell_nodes[mesh->cell_ptr[c] + k];
      double        *at   = &record[3 + CORNER_WIDTH * k];

      at[0] = (double)mesh->node_id[node];
      for (int i = 0; i < 3; i++)
        at[1 + i] = i < mesh->dim ? (double)(mesh->coords[node * mesh->dim + i] + mesh->centre[i]) : 0;
    }
  }
}

/* Gathers the descriptions of all cells on rank 0, in the order of their ids. */
static PetscErrorCode Gather(Mesh mesh, const PetscReal *size, double **all)
{
  PetscMPIInt rank, ranks, *count = NULL, *first = NULL;
  const int   mine = (int)mesh->n_cells * RECORD;
  double     *record, *found = NULL;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCallMPI(MPI_Comm_size(mesh->comm, &ranks));
  PetscCall(PetscCalloc1(mine, &record));
  Describe(mesh, size, record);
  if (!rank) PetscCall(PetscMalloc3(ranks, &count, ranks + 1, &first, mesh->n_cells_global * RECORD, &found));
  PetscCallMPI(MPI_Gather(&mine, 1, MPI_INT, count, 1, MPI_INT, 0, mesh->comm));
  for (int k = 0; !rank && k < ranks; k++) first[k + 1] = (k ? first[k] : (first[0] = 0)) + count[k];
  PetscCallMPI(MPI_Gatherv(record, mine, MPI_DOUBLE, found, count, first, MPI_DOUBLE, 0, mesh->comm));
  PetscCall(PetscFree(record));
  if (!rank) {
    PetscCall(PetscMalloc1(mesh->n_cells_global * RECORD, all));
    for (PetscInt c = 0; c < mesh->n_cells_global; c++)
      PetscCall(PetscArraycpy(&(*all)[(PetscInt)found[c * RECORD] * RECORD], &found[c * RECORD], RECORD));
    PetscCall(PetscFree3(count, first, found));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the nodes the geometric means of the sizes of their cells. */
static PetscErrorCode AverageSizes(PetscInt n_cells, const double *cell, PetscInt n_nodes, double *nodal)
{
  double *count;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n_nodes, &count));
  for (PetscInt c = 0; c < n_cells; c++, cell += RECORD)
    for (int k = 0; k < (int)cell[1]; k++) {
      const PetscInt node = (PetscInt)cell[3 + CORNER_WIDTH * k];

      nodal[node] += log(cell[2]);
      count[node]++;
    }
  for (PetscInt n = 0; n < n_nodes; n++)
    if (count[n] > 0) nodal[n] = exp(nodal[n] / count[n]);
  PetscCall(PetscFree(count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bounds the sizes at the corners of a cell by those at its other corners. Returns whether one has changed. */
static PetscBool BoundCell(const double *cell, double *nodal)
{
  PetscBool changed = PETSC_FALSE;

  for (int k = 0; k < (int)cell[1]; k++)
    for (int l = 0; l < (int)cell[1]; l++) {
      const double *a = &cell[3 + CORNER_WIDTH * k], *b = &cell[3 + CORNER_WIDTH * l];
      const double  most =
        nodal[(PetscInt)a[0]] + SIZES_GROWTH * sqrt((a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]) +
                                                    (a[3] - b[3]) * (a[3] - b[3]));

      if (nodal[(PetscInt)b[0]] <= most) continue;
      nodal[(PetscInt)b[0]] = most;
      changed               = PETSC_TRUE;
    }
  return changed;
}

/* Bounds the growth of the sizes, by sweeps forth and back over the cells. */
static void BoundGrowth(PetscInt n_cells, const double *cells, double *nodal)
{
  PetscBool changed = PETSC_TRUE;

  for (int sweep = 0; changed && sweep < SIZES_SWEEPS; sweep++) {
    changed = PETSC_FALSE;
    for (PetscInt c = 0; c < n_cells; c++) {
      const PetscInt at = sweep % 2 ? n_cells - 1 - c : c;

      if (BoundCell(&cells[at * RECORD], nodal)) changed = PETSC_TRUE;
    }
  }
}

/* Writes one element for each cell, with the sizes at its corners. */
static void WriteCells(PetscInt n_cells, const double *cell, int dim, const double *nodal, FILE *stream)
{
  for (PetscInt c = 0; c < n_cells; c++, cell += RECORD) {
    const int corners = (int)cell[1];

    fprintf(stream, "S%c(", dim == 2 ? (corners == 3 ? 'T' : 'Q') : corners == 4 ? 'S' : 'H');
    for (int k = 0; k < corners; k++)
      for (int i = 0; i < 3; i++) fprintf(stream, k + i ? ",%.12g" : "%.12g", cell[3 + CORNER_WIDTH * k + 1 + i]);
    fprintf(stream, "){");
    for (int k = 0; k < corners; k++)
      fprintf(stream, k ? ",%.6g" : "%.6g", nodal[(PetscInt)cell[3 + CORNER_WIDTH * k]]);
    fprintf(stream, "};\n");
  }
}

/*@
  MeshSizesWrite - writes wanted sizes of elements as a view of gmsh.

  Collective

  Input Parameters:
+ mesh - the mesh
. size - wanted size at each local cell
. tool - tool[mesh->n_rigid]: wanted size of a rigid tool's elements; 0: the present ones
- file - path of the view (.pos), which rank 0 writes

  Note:
  Errors: PETSC_ERR_FILE_OPEN, PETSC_ERR_FILE_WRITE.
@*/
PetscErrorCode MeshSizesWrite(Mesh mesh, const PetscReal *size, const PetscReal *tool, const char *file)
{
  PetscMPIInt rank;
  double     *cells = NULL, *nodal;
  FILE       *stream;

  PetscFunctionBeginUser;
  PetscCall(Gather(mesh, size, &cells));
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  if (rank) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(mesh->n_global, &nodal));
  PetscCall(AverageSizes(mesh->n_cells_global, cells, mesh->n_global, nodal));
  BoundGrowth(mesh->n_cells_global, cells, nodal);
  stream = fopen(file, "w");
  PetscCheck(stream, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "Cannot open %s", file);
  fprintf(stream, "View \"sizes\" {\n");
  WriteCells(mesh->n_cells_global, cells, mesh->dim, nodal, stream);
  ToolSizesWrite(mesh, tool, stream);
  fprintf(stream, "};\n");
  PetscCheck(!fclose(stream), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "Cannot write %s", file);
  PetscCall(PetscFree(nodal));
  PetscCall(PetscFree(cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}
