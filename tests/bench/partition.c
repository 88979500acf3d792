/* Estimates the costs of partitions of a scene's mesh on 2 to 4096 ranks, from the partition alone. One table is for
   partitions that balance cells and contact cells, as in a run, and one for partitions that balance cells alone. A line
   is row, column and value; a line with # begins a table. The arguments are SCENE.yaml KEY=VALUE ... Without arguments
   the scene is two rings with 1e5 unknowns. With -write DIR before them the partitions of a run are written for
   scripts/ranks_table.py: cells.txt (nodes of each cell), nodes.txt (coordinates), slave.txt and master.txt (nodes of
   each face in contact), parts.txt (number of parts, and the part of each cell). */
#include <float.h>
#include "mesh/mesh.h"
#include "base/boxtree.h"
#include "../celllists.h"

/* Largest number of parts, and smallest number of cells in a part. No rank of a run would have as few cells as that. */
enum { MOST_PARTS = 4096, LEAST_CELLS = 16 };

typedef struct {
  Mesh       mesh;
  PetscInt  *offsets, *adjacency; /* graph of the cells */
  PetscBool *contact;             /* whether a cell has a face of a contact surface */
  /* The cells of the slave faces, and for each the cell of a master face whose centre is nearest */
  PetscInt n_slaves, *slave, *opposite;
  PetscInt parts, *part, *count; /* number of parts, part of each cell, count for each part */
} Study;

/* The mesh */

/* The cells of a surface, ascending, and the centres of their nodes. */
static PetscErrorCode SurfaceCells(Mesh mesh, const MeshGroup *group, PetscInt *n, PetscInt **cells,
                                   PetscReal **centres)
{
  PetscFunctionBeginUser;
  *n = group->n_faces;
  PetscCall(PetscMalloc1(*n, cells));
  PetscCall(PetscArraycpy(*cells, group->face_cell, *n));
  PetscCall(PetscSortRemoveDupsInt(n, *cells));
  PetscCall(PetscCalloc1(*n * mesh->dim, centres));
  for (PetscInt i = 0; i < *n; i++) {
    const PetscInt first = mesh->cell_ptr[(*cells)[i]], end = mesh->cell_ptr[(*cells)[i] + 1];

    for (PetscInt k = first; k < end; k++)
      for (int d = 0; d < mesh->dim; d++)
        (*centres)[i * mesh->dim + d] += mesh->coords[mesh->cell_nodes[k] * mesh->dim + d] / (PetscReal)(end - first);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts the corners that cell a has of cell b. */
static int SharedCorners(const Mesh mesh, PetscInt a, PetscInt b)
{
  int n = 0;

  for (int i = 0; i < ElementGet(mesh->cell_type[a])->corners; i++)
    for (int k = 0; k < ElementGet(mesh->cell_type[b])->corners; k++)
      n += mesh->cell_nodes[mesh->cell_ptr[a] + i] == mesh->cell_nodes[mesh->cell_ptr[b] + k];
  return n;
}

/* Lists the cells at each node: the first of node i is at[ptr[i]]. */
static PetscErrorCode CellsAtNodes(const Mesh mesh, PetscInt **ptr, PetscInt **at)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes + 1, ptr));
  PetscCall(PetscMalloc1(mesh->cell_ptr[mesh->n_cells], at));
  for (PetscInt k = 0; k < mesh->cell_ptr[mesh->n_cells]; k++) (*ptr)[mesh->cell_nodes[k] + 1]++;
  for (PetscInt i = 0; i < mesh->n_nodes; i++) (*ptr)[i + 1] += (*ptr)[i];
  for (PetscInt c = mesh->n_cells - 1; c >= 0; c--)
    for (PetscInt k = mesh->cell_ptr[c]; k < mesh->cell_ptr[c + 1]; k++) (*at)[--(*ptr)[mesh->cell_nodes[k] + 1]] = c;
  for (PetscInt i = 0; i < mesh->n_nodes; i++) (*ptr)[i] = (*ptr)[i + 1];
  (*ptr)[mesh->n_nodes] = mesh->cell_ptr[mesh->n_cells];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the cells that share faces. A cell has at most as many neighbours as faces, which is fewer than corners times
   two. */
static PetscErrorCode FindNeighbours(Study *study)
{
  const Mesh mesh = study->mesh;
  PetscInt  *ptr, *at, n = 0;

  PetscFunctionBeginUser;
  PetscCall(CellsAtNodes(mesh, &ptr, &at));
  PetscCall(PetscMalloc1(mesh->n_cells + 1, &study->offsets));
  PetscCall(PetscMalloc1(2 * mesh->cell_ptr[mesh->n_cells], &study->adjacency));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const Element *e = ElementGet(mesh->cell_type[c]);

    study->offsets[c] = n;
    for (int i = 0; i < e->corners; i++) {
      const PetscInt node = mesh->cell_nodes[mesh->cell_ptr[c] + i];

      for (PetscInt k = ptr[node]; k < ptr[node + 1]; k++) {
        PetscBool known = (PetscBool)(at[k] == c);

        for (PetscInt j = study->offsets[c]; j < n; j++) known = (PetscBool)(known || study->adjacency[j] == at[k]);
        if (!known && SharedCorners(mesh, c, at[k]) == ElementGet((ElementType)e->face_type)->corners)
          study->adjacency[n++] = at[k];
      }
    }
  }
  study->offsets[mesh->n_cells] = n;
  PetscCall(PetscFree(ptr));
  PetscCall(PetscFree(at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The nodes that two cells share, ascending, and behind them the largest number. */
static void SharedNodes(const Mesh mesh, PetscInt a, PetscInt b, PetscInt shared[FACE_MAX_NODES])
{
  int n = 0;

  for (PetscInt i = mesh->cell_ptr[a]; i < mesh->cell_ptr[a + 1]; i++)
    for (PetscInt k = mesh->cell_ptr[b]; k < mesh->cell_ptr[b + 1] && n < FACE_MAX_NODES; k++)
      if (mesh->cell_nodes[i] == mesh->cell_nodes[k]) shared[n++] = mesh->cell_nodes[i];
  for (int k = n; k < FACE_MAX_NODES; k++) shared[k] = PETSC_MAX_INT;
  for (int i = 1; i < n; i++) {
    for (int k = i; k > 0 && shared[k - 1] > shared[k]; k--) {
      const PetscInt other = shared[k];

      shared[k]     = shared[k - 1];
      shared[k - 1] = other;
    }
  }
}

static PetscBool IsBefore(const PetscInt a[FACE_MAX_NODES], const PetscInt b[FACE_MAX_NODES])
{
  int k = 0;

  while (k + 1 < FACE_MAX_NODES && a[k] == b[k]) k++;
  return (PetscBool)(a[k] < b[k]);
}

/* Sorts the neighbours of each cell by the nodes of the faces between them, as a run does: what METIS finds depends on
   the order. */
static void SortNeighbours(Study *study)
{
  const Mesh mesh = study->mesh;

  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    for (PetscInt i = study->offsets[c] + 1; i < study->offsets[c + 1]; i++) {
      for (PetscInt k = i; k > study->offsets[c]; k--) {
        const PetscInt neighbour = study->adjacency[k];
        PetscInt       mine[FACE_MAX_NODES], before[FACE_MAX_NODES];

        SharedNodes(mesh, c, neighbour, mine);
        SharedNodes(mesh, c, study->adjacency[k - 1], before);
        if (!IsBefore(mine, before)) break;
        study->adjacency[k]     = study->adjacency[k - 1];
        study->adjacency[k - 1] = neighbour;
      }
    }
  }
}

typedef struct {
  int              dim, closest;
  const PetscReal *centres, *point;
} Nearest;

static void VisitCentre(void *context, int index, double *bound)
{
  Nearest  *nearest = context;
  PetscReal square  = 0;

  for (int k = 0; k < nearest->dim; k++)
    square += PetscSqr(nearest->centres[index * nearest->dim + k] - nearest->point[k]);
  if (PetscSqrtReal(square) > *bound || (PetscSqrtReal(square) == *bound && nearest->closest < index)) return;
  *bound           = PetscSqrtReal(square);
  nearest->closest = index;
}

/* Appends the slave cells of a pair, and the master cells that are nearest to them. */
static PetscErrorCode AddPair(Study *study, const MeshGroup *slave, const MeshGroup *master)
{
  const int  dim = study->mesh->dim;
  PetscInt   n, m, *slaves, *masters;
  PetscReal *points, *centres;
  BoxTree    tree;

  PetscFunctionBeginUser;
  PetscCall(SurfaceCells(study->mesh, slave, &n, &slaves, &points));
  PetscCall(SurfaceCells(study->mesh, master, &m, &masters, &centres));
  PetscCheck(!BoxTreeBuild(dim, (int)m, centres, centres, &tree), PETSC_COMM_SELF, PETSC_ERR_MEM,
             "no memory for the tree");
  for (PetscInt i = 0; i < n; i++) {
    Nearest nearest = {.dim = dim, .closest = -1, .centres = centres, .point = points + i * dim};
    double  bound   = DBL_MAX;

    BoxTreeClosest(tree, nearest.point, NULL, &bound, VisitCentre, &nearest);
    study->slave[study->n_slaves]      = slaves[i];
    study->opposite[study->n_slaves++] = masters[nearest.closest];
    study->contact[slaves[i]]          = PETSC_TRUE;
  }
  for (PetscInt i = 0; i < m; i++) study->contact[masters[i]] = PETSC_TRUE;
  BoxTreeDestroy(&tree);
  PetscCall(PetscFree(slaves));
  PetscCall(PetscFree(masters));
  PetscCall(PetscFree(points));
  PetscCall(PetscFree(centres));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Appends all pairs of meshed bodies. Pairs with an analytic master need no data of another rank. */
static PetscErrorCode AddPairs(Scene scene, Study *study)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (int g = 0; g < study->mesh->n_groups; g++) n += study->mesh->groups[g].n_faces;
  PetscCall(PetscMalloc2(n * scene->n_contacts, &study->slave, n * scene->n_contacts, &study->opposite));
  PetscCall(PetscCalloc1(study->mesh->n_cells, &study->contact));
  for (int i = 0; i < scene->n_contacts; i++) {
    const SceneContact *pair   = &scene->contacts[i];
    const int           slave  = MeshFindGroup(study->mesh, scene->dim - 1, pair->slave);
    const int           master = pair->master ? MeshFindGroup(study->mesh, scene->dim - 1, pair->master) : -1;

    if (slave >= 0 && master >= 0 && study->mesh->groups[master].n_faces)
      PetscCall(AddPair(study, &study->mesh->groups[slave], &study->mesh->groups[master]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The costs of parts */

/* Counts the distinct ones of n pairs (a, b), which are packed into numbers. *most is the largest number of distinct
   pairs with the same a. */
static PetscErrorCode CountPairs(PetscInt n, PetscInt64 pairs[], PetscInt *distinct, PetscInt *most)
{
  PetscInt of_one = 0;

  PetscFunctionBeginUser;
  *distinct = *most = 0;
  PetscCall(PetscSortInt64(n, pairs));
  for (PetscInt k = 0; k < n; k++) {
    if (k && pairs[k] == pairs[k - 1]) continue;
    of_one = k && pairs[k] / MOST_PARTS == pairs[k - 1] / MOST_PARTS ? of_one + 1 : 1;
    *most  = PetscMax(*most, of_one);
    (*distinct)++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Print(const Study *study, const char *what, PetscReal value)
{
  return PetscPrintf(PETSC_COMM_SELF, "%" PetscInt_FMT " %s %.4g\n", study->parts, what, (double)value);
}

/* Prints the number of nodes that a part needs and another part owns, and the number of parts with which a part
   exchanges them. The lowest part that touches a node owns it. */
static PetscErrorCode PrintGhosts(const Study *study)
{
  const Mesh  mesh = study->mesh;
  PetscInt    n = mesh->cell_ptr[mesh->n_cells], n_shared = 0, distinct, most;
  PetscInt64 *touched, *shared;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &touched));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt k = mesh->cell_ptr[c]; k < mesh->cell_ptr[c + 1]; k++)
      touched[k] = (PetscInt64)mesh->cell_nodes[k] * MOST_PARTS + study->part[c];
  PetscCall(PetscSortInt64(n, touched));
  PetscCall(PetscMalloc1(n, &shared)); /* A node of k cells has at most k parts, one of which owns it. */
  distinct = 0;
  for (PetscInt k = 0, owner = 0; k < n; k++) {
    if (k && touched[k] == touched[k - 1]) continue;
    distinct++;
    if (!k || touched[k] / MOST_PARTS != touched[k - 1] / MOST_PARTS)
      owner = (PetscInt)(touched[k] % MOST_PARTS);
    else
      shared[n_shared++] = (touched[k] % MOST_PARTS) * MOST_PARTS + owner;
  }
  PetscCall(Print(study, "ghosts,%", 100. * (distinct - mesh->n_nodes) / mesh->n_nodes));
  PetscCall(CountPairs(n_shared, shared, &distinct, &most));
  PetscCall(Print(study, "owners", (PetscReal)distinct / study->parts));
  PetscCall(Print(study, "most-owners", most));
  PetscCall(PetscFree(touched));
  PetscCall(PetscFree(shared));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints the share of slave faces whose master belongs to another part, and the largest number of parts from which one
   part needs master faces. */
static PetscErrorCode PrintContact(const Study *study)
{
  PetscInt    n_pairs = 0, distinct, most;
  PetscInt64 *pairs;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(study->n_slaves, &pairs));
  for (PetscInt s = 0; s < study->n_slaves; s++) {
    const PetscInt mine = study->part[study->slave[s]], other = study->part[study->opposite[s]];

    if (mine != other) pairs[n_pairs++] = (PetscInt64)mine * MOST_PARTS + other;
  }
  PetscCall(Print(study, "foreign-masters,%", study->n_slaves ? 100. * n_pairs / study->n_slaves : 0));
  PetscCall(CountPairs(n_pairs, pairs, &distinct, &most));
  PetscCall(Print(study, "most-master-parts", most));
  PetscCall(PetscFree(pairs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints the costs of all numbers of parts. Contact cells have a weight of their own if two_weights is true. */
static PetscErrorCode PrintPartitions(Study *study, PetscBool two_weights)
{
  const PetscInt n     = study->mesh->n_cells;
  CellLinks      links = {.n = study->n_slaves};
  PetscInt       edge_cut;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * links.n, &links.cell));
  for (PetscInt e = 0; e < 2 * links.n; e++) links.cell[e] = e % 2 ? study->opposite[e / 2] : study->slave[e / 2];
  for (study->parts = 2; study->parts <= MOST_PARTS && n / study->parts >= LEAST_CELLS; study->parts *= 2) {
    PetscCall(PartitionGraph(n, study->offsets, study->adjacency, two_weights ? study->contact : NULL, &links,
                             study->parts, study->part, &edge_cut));
    PetscCall(Print(study, "cells", PartitionImbalance(n, study->part, NULL, study->parts, study->count)));
    PetscCall(Print(study, "contact", PartitionImbalance(n, study->part, study->contact, study->parts, study->count)));
    PetscCall(PrintGhosts(study));
    PetscCall(PrintContact(study));
  }
  PetscCall(PetscFree(links.cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Opens a file of a directory. */
static FILE *Open(const char *directory, const char *name)
{
  char path[PETSC_MAX_PATH_LEN];

  snprintf(path, sizeof(path), "%s/%s", directory, name);
  return fopen(path, "w");
}

static void WriteCells(const Mesh mesh, FILE *cells, FILE *nodes)
{
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt k = mesh->cell_ptr[c]; k < mesh->cell_ptr[c + 1]; k++)
      fprintf(cells, "%" PetscInt_FMT "%s", mesh->cell_nodes[k], k + 1 < mesh->cell_ptr[c + 1] ? " " : "\n");
  for (PetscInt i = 0; i < mesh->n_nodes * mesh->dim; i++)
    fprintf(nodes, "%.17g%s", (double)mesh->coords[i], (i + 1) % mesh->dim ? " " : "\n");
}

static void WriteFaces(const Mesh mesh, const char *name, FILE *file)
{
  const MeshGroup *group = &mesh->groups[MeshFindGroup(mesh, mesh->dim - 1, name)];

  for (PetscInt f = 0; f < group->n_faces; f++) {
    PetscInt  nodes[FACE_MAX_NODES];
    const int n = ElementGet(MeshFaceNodes(mesh, group, f, nodes))->nodes;

    for (int a = 0; a < n; a++) fprintf(file, "%" PetscInt_FMT "%s", nodes[a], a + 1 < n ? " " : "\n");
  }
}

/* Writes the mesh and, for all numbers of parts, the part of each cell. The first pair's surfaces are written. */
static PetscErrorCode WriteStudy(Scene scene, Study *study, const char *directory)
{
  static const char *names[] = {"cells.txt", "nodes.txt", "slave.txt", "master.txt", "parts.txt"};
  const PetscInt     n       = study->mesh->n_cells;
  CellLinks          links   = {.n = study->n_slaves};
  FILE              *file[5];
  PetscInt           edge_cut;

  PetscFunctionBeginUser;
  for (int k = 0; k < 5; k++) {
    file[k] = Open(directory, names[k]);
    PetscCheck(file[k], PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write %s/%s", directory, names[k]);
  }
  WriteCells(study->mesh, file[0], file[1]);
  WriteFaces(study->mesh, scene->contacts[0].slave, file[2]);
  WriteFaces(study->mesh, scene->contacts[0].master, file[3]);
  PetscCall(PetscMalloc1(2 * links.n, &links.cell));
  for (PetscInt e = 0; e < 2 * links.n; e++) links.cell[e] = e % 2 ? study->opposite[e / 2] : study->slave[e / 2];
  for (study->parts = 2; study->parts <= MOST_PARTS && n / study->parts >= LEAST_CELLS; study->parts *= 2) {
    PetscCall(PartitionGraph(n, study->offsets, study->adjacency, study->contact, &links, study->parts, study->part,
                             &edge_cut));
    fprintf(file[4], "%" PetscInt_FMT, study->parts);
    for (PetscInt c = 0; c < n; c++) fprintf(file[4], " %" PetscInt_FMT, study->part[c]);
    fprintf(file[4], "\n");
  }
  PetscCall(PetscFree(links.cell));
  for (int k = 0; k < 5; k++) fclose(file[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  static char *rings[] = {"kinematics=small", "mesh.parameters={n_inner: 48, n_outer: 60, n_len: 16}"};
  const char  *write   = argc > 3 && !strcmp(argv[1], "-write") ? argv[2] : NULL;
  const char  *file    = write ? argv[3] : argc > 1 ? argv[1] : "runs/ring_in_ring_3d.yaml";
  const int    n_set   = write ? argc - 4 : argc > 1 ? argc - 2 : 2;
  char *const *set     = write ? argv + 4 : argc > 1 ? argv + 2 : rings;
  char         mesh_file[PETSC_MAX_PATH_LEN];
  PetscReal    seconds;
  Scene        scene;
  Study        study = {0};

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(NULL, NULL, NULL, NULL));
  PetscCall(SceneRead(PETSC_COMM_WORLD, file, n_set, set, &scene));
  PetscCall(MeshGenerate(PETSC_COMM_WORLD, scene, "out/bench", PETSC_FALSE, mesh_file, &seconds));
  PetscCall(MeshCreate(PETSC_COMM_WORLD, scene, mesh_file, &study.mesh));
  PetscCall(AddPairs(scene, &study));
  PetscCall(FindNeighbours(&study));
  SortNeighbours(&study);
  PetscCall(PetscMalloc2(study.mesh->n_cells, &study.part, MOST_PARTS, &study.count));
  if (write) PetscCall(WriteStudy(scene, &study, write));
  for (int two = 1; !write && two >= 0; two--) {
    PetscCall(PetscPrintf(
      PETSC_COMM_SELF, "# parts of %s, %" PetscInt_FMT " cells, %s: imbalances (largest over mean), ghosts, messages\n",
      scene->name, study.mesh->n_cells, two ? "cells and contact cells balanced" : "cells alone balanced"));
    PetscCall(PrintPartitions(&study, two ? PETSC_TRUE : PETSC_FALSE));
  }
  PetscCall(PetscFree2(study.part, study.count));
  PetscCall(PetscFree2(study.slave, study.opposite));
  PetscCall(PetscFree(study.contact));
  PetscCall(PetscFree(study.offsets));
  PetscCall(PetscFree(study.adjacency));
  PetscCall(MeshDestroy(&study.mesh));
  PetscCall(SceneDestroy(&scene));
  PetscCall(PetscFinalize());
  return 0;
}
