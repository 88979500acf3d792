/* Measures what ranks hold while a mesh is read and cut: one line for each rank with rank, cells, nodes, the peak of
   memory (MB) before the mesh is read and until it is cut, and CPU seconds. The last line has the edge cut, and the
   largest part over the mean by cells and by cells in contact. Arguments: SCENE.yaml KEY=VALUE ... */
#include <sys/resource.h>
#include "mesh/mesh.h"

enum { BEFORE, AFTER, SECONDS, CELLS, NODES, FIGURES };

/* Peak of memory in MB, and CPU seconds. */
static void Measure(PetscReal *peak, PetscReal *seconds)
{
  struct rusage self;

  getrusage(RUSAGE_SELF, &self);
  *peak    = (PetscReal)self.ru_maxrss / 1024; /* Linux counts kilobytes */
  *seconds = (PetscReal)(self.ru_utime.tv_sec + self.ru_stime.tv_sec) +
             1e-6 * (PetscReal)(self.ru_utime.tv_usec + self.ru_stime.tv_usec);
}

int main(int argc, char **argv)
{
  char        mesh_file[PETSC_MAX_PATH_LEN];
  PetscReal   mine[FIGURES], *all, started, seconds;
  PetscMPIInt rank, size;
  Scene       scene;
  Mesh        mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(NULL, NULL, NULL, NULL));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCall(SceneRead(PETSC_COMM_WORLD, argv[1], argc - 2, argv + 2, &scene));
  PetscCall(MeshGenerate(PETSC_COMM_WORLD, scene, "out/bench", PETSC_FALSE, mesh_file, &seconds));
  Measure(&mine[BEFORE], &started);
  PetscCall(MeshCreate(PETSC_COMM_WORLD, scene, mesh_file, &mesh));
  Measure(&mine[AFTER], &mine[SECONDS]);
  mine[SECONDS] -= started;
  mine[CELLS] = mesh->n_cells;
  mine[NODES] = mesh->n_nodes;
  PetscCall(PetscMalloc1(size * FIGURES, &all));
  PetscCallMPI(MPI_Gather(mine, FIGURES, MPIU_REAL, all, FIGURES, MPIU_REAL, 0, PETSC_COMM_WORLD));
  for (PetscMPIInt r = 0; r < size && !rank; r++)
    PetscCall(PetscPrintf(PETSC_COMM_SELF, "%d %.0f %.0f %.1f %.1f %.2f\n", r, (double)all[r * FIGURES + CELLS],
                          (double)all[r * FIGURES + NODES], (double)all[r * FIGURES + BEFORE],
                          (double)all[r * FIGURES + AFTER], (double)all[r * FIGURES + SECONDS]));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "cut %" PetscInt_FMT " %.3f %.3f\n", mesh->partition.edge_cut,
                        (double)mesh->partition.imbalance_cells, (double)mesh->partition.imbalance_contact));
  PetscCall(PetscFree(all));
  PetscCall(MeshDestroy(&mesh));
  PetscCall(SceneDestroy(&scene));
  PetscCall(PetscFinalize());
  return 0;
}
