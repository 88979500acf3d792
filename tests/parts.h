/* Makes the parts of a scene for a test: a mesh of rectangular blocks of 4-node quadrilaterals, which the test writes
   itself, and the problem on it. Each program includes it once.

   PartsStart() and PartsEnd() enclose the tests. PartsCreate() writes blocks.msh and scene.yaml and makes mesh and
   problem of them, PartsDestroy() frees these. Node tags are known beforehand: PartsTag(). The sides of a block "a"
   are the groups a_bottom, a_right, a_top and a_left; blocks of one name form one body and share their groups. */
#pragma once
#include "mesh/mesh.h"
#include "solve/problem.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>

#define OK(call)                     assert_int_equal(call, 0)
#define assert_near(a, b, tolerance) PartsNear(a, b, tolerance, #a " is not " #b, __FILE__, __LINE__)

enum { PARTS_BLOCKS = 3 };

/* A rectangle of nx times ny cells */
typedef struct {
  const char *name;
  int         nx, ny;
  double      x[2], y[2];
} PartsBlock;

typedef struct {
  int        n_blocks;
  PartsBlock block[PARTS_BLOCKS];
  Scene      scene;
  Mesh       mesh;
  Problem    problem;
  PetscReal *u, *f; /* local displacements (length) and forces, of all nodes */
} Parts;

/* Moves a node of the mesh before the file is written, or gives a displacement of it. */
typedef void (*PartsMap)(const double X[2], double x[2]);

static char        parts_folder[64];
static PetscMPIInt parts_rank;

static inline void PartsNear(double a, double b, double tolerance, const char *what, const char *file, int line)
{
  if (fabs(a - b) <= tolerance) return;
  print_error("%s: %.17g, %.17g\n", what, a, b);
  _fail(file, line);
}

static inline void PartsWrite(const char *name, const char *text)
{
  char  path[128];
  FILE *file;

  if (parts_rank) return;
  snprintf(path, sizeof(path), "%s/%s", parts_folder, name);
  file = fopen(path, "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

/* gmsh's tag of the node of column i and row j of a block. */
static inline int PartsTag(const Parts *parts, int b, int i, int j)
{
  int tag = 1;

  for (int k = 0; k < b; k++) tag += (parts->block[k].nx + 1) * (parts->block[k].ny + 1);
  return tag + j * (parts->block[b].nx + 1) + i;
}

/* Physical tag of a block's body (side 0) or of one of its sides (1 to 4). */
static inline int PartsGroup(const Parts *parts, int b, int side)
{
  for (int k = 0; k < b; k++)
    if (!strcmp(parts->block[k].name, parts->block[b].name)) b = k;
  return 5 * b + 1 + side;
}

static inline void PartsWriteEntities(const Parts *parts, FILE *file)
{
  static const char *const sides[] = {"", "_bottom", "_right", "_top", "_left"};
  int                      named   = 0;

  for (int b = 0; b < parts->n_blocks; b++) named += PartsGroup(parts, b, 0) == 5 * b + 1;
  fprintf(file, "$PhysicalNames\n%d\n", 5 * named);
  for (int b = 0; b < parts->n_blocks; b++)
    for (int s = 0; s <= 4 && PartsGroup(parts, b, 0) == 5 * b + 1; s++)
      fprintf(file, "%d %d \"%s%s\"\n", s ? 1 : 2, PartsGroup(parts, b, s), parts->block[b].name, sides[s]);
  fprintf(file, "$EndPhysicalNames\n$Entities\n0 %d %d 0\n", 4 * parts->n_blocks, parts->n_blocks);
  for (int b = 0; b < parts->n_blocks; b++)
    for (int s = 1; s <= 4; s++) fprintf(file, "%d 0 0 0 1 1 0 1 %d 0\n", 4 * b + s, PartsGroup(parts, b, s));
  for (int b = 0; b < parts->n_blocks; b++) fprintf(file, "%d 0 0 0 1 1 0 1 %d 0\n", b + 1, PartsGroup(parts, b, 0));
  fprintf(file, "$EndEntities\n");
}

static inline void PartsWriteNodes(const Parts *parts, PartsMap map, FILE *file)
{
  const PartsBlock *last = &parts->block[parts->n_blocks - 1];
  const int         n    = PartsTag(parts, parts->n_blocks - 1, last->nx, last->ny);

  fprintf(file, "$Nodes\n1 %d 1 %d\n2 1 0 %d\n", n, n, n);
  for (int k = 1; k <= n; k++) fprintf(file, "%d\n", k);
  for (int b = 0; b < parts->n_blocks; b++) {
    const PartsBlock *block = &parts->block[b];

    for (int j = 0; j <= block->ny; j++) {
      for (int i = 0; i <= block->nx; i++) {
        const double X[2] = {block->x[0] + (block->x[1] - block->x[0]) * i / block->nx,
                             block->y[0] + (block->y[1] - block->y[0]) * j / block->ny};
        double       x[2] = {X[0], X[1]};

        if (map) map(X, x);
        fprintf(file, "%.17g %.17g 0\n", x[0], x[1]);
      }
    }
  }
  fprintf(file, "$EndNodes\n");
}

static inline void PartsWriteElements(const Parts *parts, FILE *file)
{
  int n = 0, tag = 1;

  for (int b = 0; b < parts->n_blocks; b++)
    n += parts->block[b].nx * parts->block[b].ny + 2 * (parts->block[b].nx + parts->block[b].ny);
  fprintf(file, "$Elements\n%d %d 1 %d\n", 5 * parts->n_blocks, n, n);
  for (int b = 0; b < parts->n_blocks; b++) {
    const int nx = parts->block[b].nx, ny = parts->block[b].ny;

    for (int s = 1; s <= 4; s++) {
      const int along = s % 2 ? nx : ny;

      fprintf(file, "1 %d 1 %d\n", 4 * b + s, along);
      for (int k = 0; k < along; k++) {
        const int i = s == 1   ? k
                      : s == 2 ? nx
                      : s == 3 ? nx - k
                               : 0,
                  j = s == 1   ? 0
                      : s == 2 ? k
                      : s == 3 ? ny
                               : ny - k;

        fprintf(file, "%d %d %d\n", tag++, PartsTag(parts, b, i, j),
                PartsTag(parts, b, i + (s == 1) - (s == 3), j + (s == 2) - (s == 4)));
      }
    }
    fprintf(file, "2 %d 3 %d\n", b + 1, nx * ny);
    for (int j = 0; j < ny; j++)
      for (int i = 0; i < nx; i++)
        fprintf(file, "%d %d %d %d %d\n", tag++, PartsTag(parts, b, i, j), PartsTag(parts, b, i + 1, j),
                PartsTag(parts, b, i + 1, j + 1), PartsTag(parts, b, i, j + 1));
  }
  fprintf(file, "$EndElements\n");
}

static inline void PartsWriteMesh(const Parts *parts, PartsMap map)
{
  char  path[128];
  FILE *file;

  if (parts_rank) return;
  snprintf(path, sizeof(path), "%s/blocks.msh", parts_folder);
  file = fopen(path, "w");
  assert_non_null(file);
  fprintf(file, "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
  PartsWriteEntities(parts, file);
  PartsWriteNodes(parts, map, file);
  PartsWriteElements(parts, file);
  fclose(file);
}

/* Mesh and problem of blocks[n] and a scene. text: the scene without its key `mesh`; map: may be NULL. */
static inline void PartsCreate(int n, const PartsBlock blocks[], PartsMap map, const char *text, Parts *parts)
{
  char scene[4096], path[128], file[PETSC_MAX_PATH_LEN];

  *parts = (Parts){.n_blocks = n};
  memcpy(parts->block, blocks, n * sizeof(*blocks));
  PartsWriteMesh(parts, map);
  snprintf(scene, sizeof(scene), "mesh: {file: blocks.msh}\n%s", text);
  PartsWrite("scene.yaml", scene);
  OK(MPI_Barrier(PETSC_COMM_WORLD));
  snprintf(path, sizeof(path), "%s/scene.yaml", parts_folder);
  snprintf(file, sizeof(file), "%s/blocks.msh", parts_folder);
  OK(SceneRead(PETSC_COMM_WORLD, path, 0, NULL, &parts->scene));
  OK(MeshCreate(PETSC_COMM_WORLD, parts->scene, file, &parts->mesh));
  OK(ProblemCreate(parts->scene, parts->mesh, 0, &parts->problem));
  OK(PetscCalloc2(parts->mesh->n_nodes * 2, &parts->u, parts->mesh->n_nodes * 2, &parts->f));
}

static inline void PartsDestroy(Parts *parts)
{
  OK(PetscFree2(parts->u, parts->f));
  OK(ProblemDestroy(&parts->problem));
  OK(MeshDestroy(&parts->mesh));
  OK(SceneDestroy(&parts->scene));
  OK(MPI_Barrier(PETSC_COMM_WORLD));
}

/* Reference coordinates of a local node. */
static inline void PartsPlace(const Parts *parts, PetscInt node, double X[2])
{
  for (int d = 0; d < 2; d++) X[d] = parts->mesh->coords[node * 2 + d] + parts->mesh->centre[d];
}

/* Gives every node the displacement that brings it to map(X). */
static inline void PartsMove(Parts *parts, PartsMap map)
{
  for (PetscInt node = 0; node < parts->mesh->n_nodes; node++) {
    double X[2], x[2];

    PartsPlace(parts, node, X);
    x[0] = X[0], x[1] = X[1];
    map(X, x);
    for (int d = 0; d < 2; d++) parts->u[node * 2 + d] = x[d] - X[d];
  }
}

/* Gives the node of a tag a displacement, on every rank that has it. */
static inline void PartsMoveNode(Parts *parts, int tag, double ux, double uy)
{
  for (PetscInt node = 0; node < parts->mesh->n_nodes; node++)
    if (parts->mesh->node_tag[node] == tag) parts->u[node * 2] = ux, parts->u[node * 2 + 1] = uy;
}

/* Component of values[n_nodes*2] at the node of a tag, summed over all copies of the node. */
static inline double PartsSum(const Parts *parts, const PetscReal *values, int tag, int component)
{
  double sum = 0;

  for (PetscInt node = 0; node < parts->mesh->n_nodes; node++)
    if (parts->mesh->node_tag[node] == tag) sum += values[node * 2 + component];
  OK(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  return sum;
}

/* The largest of all ranks. */
static inline double PartsMost(double value)
{
  OK(MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD));
  return value;
}

/* A direction with no symmetry over the free dofs, the same on any number of ranks: as a vector and as local values,
   which are 0 at prescribed dofs. */
static inline void PartsDirection(const Parts *parts, Vec v, PetscReal *local)
{
  const PetscInt n = parts->mesh->n_nodes * 2;

  for (PetscInt k = 0; k < n; k++) local[k] = sin(1 + 3.7 * parts->mesh->node_tag[k / 2] + 1.3 * (k % 2));
  OK(MeshCollectFree(parts->mesh, local, v));
  OK(PetscArrayzero(local, n));
  OK(MeshGlobalToLocal(parts->mesh, v, local));
}

/* The residual of a test: local forces at local displacements, and the energy of all ranks, which is 0 without one. */
typedef double (*PartsResidual)(Parts *, const PetscReal *u, PetscReal *f);

/* What central differences at parts->u show along PartsDirection(), for a matrix A: relative difference of A v from
   that of the forces, and relative difference of the forces times v from that of the energy (where there is one). */
static inline void PartsDifferences(Parts *parts, Mat A, PartsResidual residual, double step, double *force,
                                    double *energy)
{
  const PetscInt n = parts->mesh->n_nodes * 2;
  PetscReal     *local, *u, *f, E[3], power, length, miss;
  Vec            v, F[3];

  OK(PetscMalloc3(n, &local, n, &u, n, &f));
  OK(MatCreateVecs(A, &v, NULL));
  PartsDirection(parts, v, local);
  for (int k = 0; k < 3; k++) {
    OK(VecDuplicate(v, &F[k]));
    for (PetscInt i = 0; i < n; i++) u[i] = parts->u[i] + (k - 1) * step * local[i];
    OK(PetscArrayzero(f, n));
    E[k] = residual(parts, u, f);
    OK(MeshLocalToGlobal(parts->mesh, f, F[k]));
  }
  OK(VecDot(F[1], v, &power));
  *energy = fabs((E[2] - E[0]) / (2 * step) - power) / fabs(power);
  OK(VecAXPY(F[2], -1, F[0]));
  OK(VecScale(F[2], 1 / (2 * step)));
  OK(MatMult(A, v, F[1]));
  OK(VecNorm(F[1], NORM_2, &length));
  OK(VecAXPY(F[2], -1, F[1]));
  OK(VecNorm(F[2], NORM_2, &miss));
  assert_true(length > 0);
  *force = miss / length;
  for (int k = 0; k < 3; k++) OK(VecDestroy(&F[k]));
  OK(VecDestroy(&v));
  OK(PetscFree3(local, u, f));
}

static inline int PartsStart(int *argc, char ***argv)
{
  if (PetscInitialize(argc, argv, NULL, NULL)) return 1;
  if (MPI_Comm_rank(PETSC_COMM_WORLD, &parts_rank)) return 1;
  snprintf(parts_folder, sizeof(parts_folder), "/tmp/burnish_parts_XXXXXX");
  if (!parts_rank && !mkdtemp(parts_folder)) return 1;
  return MPI_Bcast(parts_folder, sizeof(parts_folder), MPI_CHAR, 0, PETSC_COMM_WORLD);
}

static inline int PartsEnd(int failed)
{
  char command[128];

  snprintf(command, sizeof(command), "rm -r %s", parts_folder);
  if (MPI_Barrier(PETSC_COMM_WORLD)) return 1;
  if (!parts_rank && system(command)) failed++;
  return PetscFinalize() ? 1 : failed;
}
