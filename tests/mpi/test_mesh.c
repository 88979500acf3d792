/* Distributed mesh: it is the mesh of the file. Tested are every element type on a curved body, nodes, faces, groups,
   dofs and sums on any number of ranks, and the refusals of wrong meshes. */
#include "mesh/mesh.h"
#include "kernels/elementkernel.h"
#include "gmshfile.h"
#include "base/errorlog.h"
#include "base/refusal.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>
#include <unistd.h>

static char        folder[64];
static PetscMPIInt rank, size;

/* The message of the last refusal, empty if there was none. */
static char refused[4096];

/* Returns whether a code is that of a refusal, and keeps its message in refused[]. Any other code must be 0. */
static int Refused(PetscErrorCode code)
{
  char *message;

  if (code != REFUSED) assert_int_equal(code, PETSC_SUCCESS);
  if (!code) return 0;
  assert_int_equal(RefusalTake(&message), PETSC_SUCCESS);
  assert_non_null(message);
  snprintf(refused, sizeof(refused), "%s", message);
  assert_int_equal(PetscFree(message), PETSC_SUCCESS);
  return 1;
}

/* Scenes */

static void WriteText(const char *name, const char *text, char path[PETSC_MAX_PATH_LEN])
{
  snprintf(path, PETSC_MAX_PATH_LEN, "%s/%s", folder, name);
  if (!rank) {
    FILE *stream = fopen(path, "w");

    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0);
    fclose(stream);
  }
  assert_int_equal(MPI_Barrier(PETSC_COMM_WORLD), MPI_SUCCESS);
}

static Scene MakeScene(const char *text)
{
  char  path[PETSC_MAX_PATH_LEN];
  Scene scene;

  WriteText("scene.yaml", text, path);
  assert_int_equal(SceneRead(PETSC_COMM_WORLD, path, 0, NULL, &scene), 0);
  return scene;
}

/* A quarter of a ring with radii 1 and 2, ROUND cells around and ACROSS cells across; in three dimensions its height is
   0.5 and it has one layer of cells. */
enum { ROUND = 6, ACROSS = 2 };
static const double      height = 0.5;
static const char *const ring =
  "DefineConstant[ blocks = {1, Name \"blocks\"}, solid = {1, Name \"solid\"} ];\n"
  "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {2, 0, 0}; Point(4) = {0, 2, 0}; Point(5) = {0, 1, 0};\n"
  "Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};\n"
  "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n"
  "Transfinite Curve{2, 4} = 7; Transfinite Curve{1, 3} = 3; Transfinite Surface{1};\n"
  "If(blocks) Recombine Surface{1}; EndIf\n"
  "If(solid)\n"
  "  If(blocks) v[] = Extrude{0, 0, 0.5} { Surface{1}; Layers{1}; Recombine; };\n"
  "  Else v[] = Extrude{0, 0, 0.5} { Surface{1}; Layers{1}; };\n"
  "  EndIf\n"
  "  Physical Volume(\"ring\") = {v[1]}; Physical Surface(\"bottom\") = {1}; Physical Surface(\"top\") = {v[0]};\n"
  "  Physical Surface(\"cut_y\") = {v[2]}; Physical Surface(\"outer\") = {v[3]}; Physical Surface(\"cut_x\") = {v[4]}; "
  "Physical Surface(\"inner\") = {v[5]};\n"
  "  Physical Surface(\"cuts\") = {v[2], v[4]};\n"
  "  Physical Curve(\"edge\") = {2}; Physical Point(\"corner\") = {2};\n"
  "Else\n"
  "  Physical Surface(\"ring\") = {1};\n"
  "  Physical Curve(\"cut_y\") = {1}; Physical Curve(\"outer\") = {2}; Physical Curve(\"cut_x\") = {3}; Physical "
  "Curve(\"inner\") = {4};\n"
  "  Physical Curve(\"cuts\") = {1, 3}; Physical Point(\"corner\") = {2};\n"
  "EndIf\n";

typedef struct {
  const char *element;
  int         blocks, solid, order;
} Case;

static Scene RingScene(const Case *test)
{
  char text[1024], path[PETSC_MAX_PATH_LEN];

  WriteText("ring.geo", ring, path);
  snprintf(text, sizeof(text),
           "mesh: {file: ring.geo, order: %d, parameters: {blocks: %d, solid: %d}}\ngeometry: %s\nbodies: [{volume: "
           "ring, material: {law: svk, E: 1, nu: 0.3}}]\n"
           "supports: [{surface: cut_x, ux: 0}]\nloads: [{surface: inner, pressure: 1}]\n",
           test->order, test->blocks, test->solid, test->solid ? "solid" : "plane_strain");
  return MakeScene(text);
}

static Mesh MakeMesh(Scene scene, char file[PETSC_MAX_PATH_LEN])
{
  PetscReal seconds;
  Mesh      mesh;

  if (Refused(MeshGenerate(PETSC_COMM_WORLD, scene, folder, PETSC_FALSE, file, &seconds))) fail_msg("%s", refused);
  if (Refused(MeshCreate(PETSC_COMM_WORLD, scene, file, &mesh))) fail_msg("%s", refused);
  return mesh;
}

static MeshGroup *Group(Mesh mesh, Scene scene, const char *name)
{
  MeshGroup *group;

  if (Refused(MeshGetGroup(mesh, scene, "loads.0", "surface", name, mesh->dim - 1, &group))) fail_msg("%s", refused);
  return group;
}

static double Sum(double value)
{
  assert_int_equal(MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD), MPI_SUCCESS);
  return value;
}

/* Checks */

/* Nodes and cells have the tags, places and node order of the file. Ids follow the order of tags. Owners know their
   nodes. */
static void CheckAgainstFile(Mesh mesh, const char *file)
{
  GmshMesh  gmsh;
  Complaint complaint = {""};
  PetscInt  ids       = 0;

  assert_int_equal(GmshRead(PETSC_COMM_SELF, file, &gmsh, &complaint), 0);
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    PetscInt at;

    assert_int_equal(PetscFindInt(mesh->node_tag[i], gmsh.n_nodes, gmsh.node_tag, &at), 0);
    assert_int_equal(at, mesh->node_id[i]); /* every node of the file belongs to a cell */
    for (int k = 0; k < mesh->dim; k++)
      assert_true(mesh->coords[i * mesh->dim + k] == gmsh.coords[3 * at + k] - mesh->centre[k]);
    if (mesh->node_owner[i] == rank) {
      assert_int_equal(mesh->node_owner_local[i], i);
      ids += mesh->node_id[i];
    }
  }
  assert_int_equal(mesh->n_global, gmsh.n_nodes);
  assert_true(Sum((double)mesh->n_owned) == (double)mesh->n_global);
  assert_true(Sum((double)ids) == (double)mesh->n_global * (double)(mesh->n_global - 1) / 2);
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    PetscBool found = PETSC_FALSE;

    for (int b = 0; b < gmsh.n_blocks; b++) {
      const GmshBlock *block = &gmsh.blocks[b];

      for (PetscInt item = 0; item < block->n && block->dim == mesh->dim; item++) {
        if (block->tag[item] != mesh->cell_tag[c]) continue;
        found = PETSC_TRUE;
        assert_int_equal(block->element->type, mesh->cell_type[c]);
        for (int k = 0; k < block->nodes; k++)
          assert_int_equal(gmsh.node_tag[block->connectivity[item * block->nodes + k]],
                           mesh->node_tag[mesh->cell_nodes[mesh->cell_ptr[c] + k]]);
      }
    }
    assert_true(found);
  }
  assert_int_equal(GmshReset(&gmsh), 0);
}

/* The owner of a ghost node has the same id at node_owner_local. */
static void CheckOwners(Mesh mesh)
{
  PetscMPIInt most = (PetscMPIInt)mesh->n_nodes;
  PetscInt   *mine, *all;

  assert_int_equal(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD), MPI_SUCCESS);
  assert_int_equal(PetscCalloc2(most, &mine, most * size, &all), 0);
  memcpy(mine, mesh->node_id, (size_t)mesh->n_nodes * sizeof(PetscInt));
  assert_int_equal(MPI_Allgather(mine, most, MPIU_INT, all, most, MPIU_INT, PETSC_COMM_WORLD), MPI_SUCCESS);
  for (PetscInt i = 0; i < mesh->n_nodes; i++)
    assert_int_equal(all[mesh->node_owner[i] * most + mesh->node_owner_local[i]], mesh->node_id[i]);
  assert_int_equal(PetscFree2(mine, all), 0);
}

static PetscBool OnGroup(const char *name, const double x[3])
{
  const double near = 1e-9, r = hypot(x[0], x[1]);

  if (!strcmp(name, "inner")) return fabs(r - 1) < near;
  if (!strcmp(name, "outer")) return fabs(r - 2) < near;
  if (!strcmp(name, "cut_x")) return fabs(x[0]) < near;
  if (!strcmp(name, "cut_y")) return fabs(x[1]) < near;
  if (!strcmp(name, "cuts")) return fabs(x[0]) < near || fabs(x[1]) < near;
  if (!strcmp(name, "bottom")) return fabs(x[2]) < near;
  if (!strcmp(name, "top")) return fabs(x[2] - height) < near;
  if (!strcmp(name, "edge")) return fabs(r - 2) < near && fabs(x[2]) < near;
  if (!strcmp(name, "corner")) return fabs(x[0] - 1) < near && fabs(x[1]) < near && fabs(x[2]) < near;
  if (!strcmp(name, "boundary")) return fabs(x[0] - 2) < near || fabs(x[1]) < near || fabs(x[1] - 1) < near;
  if (!strcmp(name, "middle")) return fabs(x[0] - 1) < near;
  if (!strcmp(name, "hexes")) return x[0] < 1.25;
  if (!strcmp(name, "tets")) return x[0] > 1.25;
  if (!strcmp(name, "outside")) {
    return fabs(x[0] - 1) < near || fabs(x[0] - 1.5) < near || fabs(x[0] - 2.5) < near || fabs(x[1]) < near ||
           fabs(x[1] - 1) < near || fabs(x[2]) < near || fabs(x[2] - 1) < near;
  }
  return !strcmp(name, "ring") || !strcmp(name, "both");
}

/* Every rank lists exactly the nodes that lie on the group, also nodes whose face of the group is on another rank.
   Middle nodes lie on the arc. */
static void CheckGroupNodes(Mesh mesh)
{
  for (int g = 0; g < mesh->n_groups; g++) {
    const MeshGroup *group = &mesh->groups[g];
    PetscInt         n     = 0;

    assert_true(group->attached);
    for (PetscInt i = 0; i < mesh->n_nodes; i++) {
      double x[3] = {0};

      for (int k = 0; k < mesh->dim; k++) x[k] = mesh->coords[i * mesh->dim + k] + mesh->centre[k];
      if (!OnGroup(group->name, x)) continue;
      assert_true(n < group->n_nodes);
      assert_int_equal(group->nodes[n++], i);
    }
    assert_int_equal(n, group->n_nodes);
  }
}

static double Volume(Mesh mesh)
{
  double volume = 0;

  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    double X[ELEMENT_MAX_NODES * 3];

    MeshCellCoordinates(mesh, c, X);
    volume += CellVolume(mesh->cell_type[c], mesh->dim, mesh->dim == 3 ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN, X);
  }
  return Sum(volume);
}

/* Computes the flux of x through the boundary with normals outward, which is dim times the volume by the divergence
   theorem. "cuts" repeats two surfaces, and "middle" is inside. */
static double Flux(Mesh mesh, PetscInt *n_faces)
{
  double flux = 0;

  *n_faces = 0;
  for (int g = 0; g < mesh->n_groups; g++) {
    const MeshGroup *group = &mesh->groups[g];

    if (group->dim != mesh->dim - 1 || !strcmp(group->name, "cuts") || !strcmp(group->name, "middle")) continue;
    for (PetscInt f = 0; f < group->n_faces; f++) {
      PetscInt          nodes[FACE_MAX_NODES];
      const ElementType type = MeshFaceNodes(mesh, group, f, nodes);
      double            X[FACE_MAX_NODES * 3], area[FACE_MAX_NODES] = {0}, normal[FACE_MAX_NODES * 3] = {0};

      MeshGatherNodes(mesh, ElementGet(type)->nodes, nodes, mesh->coords, X);
      FaceAreaKernel(type, mesh->dim, mesh->dim == 3 ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN, X, area, normal);
      for (int k = 0; k < ElementGet(type)->nodes * mesh->dim; k++) flux += X[k] * normal[k];
    }
    *n_faces += group->n_faces;
  }
  assert_int_equal(MPI_Allreduce(MPI_IN_PLACE, n_faces, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD), MPI_SUCCESS);
  return Sum(flux) / mesh->dim;
}

/* Returns the exact volume for straight edges, and for the parabolas of second order, where the area of a segment is
   2/3 of chord times height. */
static double RingVolume(const Case *test)
{
  const double angle = acos(-1.) / 2 / ROUND, thickness = test->solid ? height : 1;
  double       area = 0;

  for (int r = 1; r <= 2; r++) {
    const double segment = test->order == 2 ? 2. / 3 * (2 * r * sin(angle / 2)) * r * (1 - cos(angle / 2)) : 0;

    area += (r == 2 ? 1 : -1) * ROUND * (r * r * sin(angle) / 2 + segment);
  }
  return area * thickness;
}

static double NodeValue(Mesh mesh, PetscInt i, int k)
{
  return (double)(mesh->node_id[i] * mesh->dim + k + 1);
}

/* Each point of the DMPlex is a cell with all its nodes, or a node. Its SF knows the owners, a label the group cut_x.
 */
static void CheckPlex(Mesh mesh, const MeshGroup *held)
{
  const PetscInt    *cone, *leaf;
  const PetscSFNode *remote;
  PetscInt           from, to, n, *id;
  PetscSF            sf;

  assert_int_equal(DMPlexGetChart(mesh->dm, &from, &to), 0);
  assert_true(from == 0 && to == mesh->n_cells + mesh->n_nodes);
  assert_int_equal(DMPlexGetDepthStratum(mesh->dm, 1, &from, &to), 0);
  assert_true(to - from == mesh->n_cells && (from == 0 || from == to));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    assert_int_equal(DMPlexGetConeSize(mesh->dm, c, &n), 0);
    assert_int_equal(n, mesh->cell_ptr[c + 1] - mesh->cell_ptr[c]);
    assert_int_equal(DMPlexGetCone(mesh->dm, c, &cone), 0);
    for (PetscInt k = 0; k < n; k++) assert_int_equal(cone[k], mesh->n_cells + mesh->cell_nodes[mesh->cell_ptr[c] + k]);
  }
  assert_int_equal(DMGetStratumSize(mesh->dm, "surface cut_x", 1, &n), 0);
  assert_int_equal(n, held->n_nodes);

  assert_int_equal(PetscMalloc1(mesh->n_cells + mesh->n_nodes, &id), 0);
  for (PetscInt p = 0; p < mesh->n_cells + mesh->n_nodes; p++)
    id[p] = p < mesh->n_cells || mesh->node_owner[p - mesh->n_cells] != rank ? -1 : mesh->node_id[p - mesh->n_cells];
  assert_int_equal(DMGetPointSF(mesh->dm, &sf), 0);
  assert_int_equal(PetscSFGetGraph(sf, NULL, &n, &leaf, &remote), 0);
  assert_int_equal(n, mesh->n_nodes - mesh->n_owned);
  for (PetscInt i = 0; i < n; i++) assert_int_equal(remote[i].rank, mesh->node_owner[leaf[i] - mesh->n_cells]);
  assert_int_equal(PetscSFBcastBegin(sf, MPIU_INT, id, id, MPI_REPLACE), 0);
  assert_int_equal(PetscSFBcastEnd(sf, MPIU_INT, id, id, MPI_REPLACE), 0);
  for (PetscInt i = 0; i < mesh->n_nodes; i++) assert_int_equal(id[mesh->n_cells + i], mesh->node_id[i]);
  assert_int_equal(PetscFree(id), 0);
}

/* The DM of a vector distributes the same values to the same dofs as the mesh. */
static void CheckDistribution(Mesh mesh, Vec x, const PetscReal *u, const PetscInt *dofs)
{
  const PetscScalar *values;
  PetscInt           n;
  DM                 dm;
  Vec                local;

  assert_int_equal(VecGetDM(x, &dm), 0);
  assert_ptr_equal(dm, mesh->dm);
  assert_int_equal(DMGetLocalVector(dm, &local), 0);
  assert_int_equal(VecGetSize(local, &n), 0);
  assert_int_equal(n, mesh->n_nodes * mesh->dim);
  assert_int_equal(DMGlobalToLocal(dm, x, INSERT_VALUES, local), 0);
  assert_int_equal(VecGetArrayRead(local, &values), 0);
  for (PetscInt i = 0; i < n; i++) assert_true(dofs[i] < 0 || PetscRealPart(values[i]) == u[i]);
  assert_int_equal(VecRestoreArrayRead(local, &values), 0);
  assert_int_equal(DMRestoreLocalVector(dm, &local), 0);
}

/* Only the lowest rank says which dofs are supported. All ranks must agree, number each free dof once, and exchange
   values without loss. */
static void CheckDofs(Mesh mesh, Scene scene)
{
  const PetscInt   n    = mesh->n_nodes * mesh->dim;
  const MeshGroup *held = Group(mesh, scene, "cut_x");
  const PetscInt  *dofs;
  PetscBool       *constrained;
  PetscInt         first, last, n_held = 0, total;
  PetscReal       *u, *ones;
  PetscScalar     *values;
  Vec              x, F;
  DM               dm;

  assert_int_equal(PetscCalloc1(n, &constrained), 0);
  assert_int_equal(PetscMalloc2(n, &u, n, &ones), 0);
  for (PetscInt i = 0; i < held->n_nodes; i++) {
    constrained[held->nodes[i] * mesh->dim] = mesh->node_owner[held->nodes[i]] == rank ? PETSC_TRUE : PETSC_FALSE;
    n_held += mesh->node_owner[held->nodes[i]] == rank;
  }
  assert_int_equal(MeshSetConstraints(mesh, constrained), 0);
  assert_int_equal(MeshGetGlobalDofs(mesh, &dofs), 0);
  for (PetscInt i = 0; i < held->n_nodes; i++) assert_int_equal(dofs[held->nodes[i] * mesh->dim], -1);
  assert_int_equal(MeshCreateVector(mesh, &x), 0);
  assert_int_equal(VecDuplicate(x, &F), 0);
  assert_int_equal(VecGetDM(F, &dm), 0);
  assert_ptr_equal(dm, mesh->dm);
  assert_int_equal(VecGetSize(x, &total), 0);
  assert_true((double)total == (double)(mesh->n_global * mesh->dim) - Sum((double)n_held));
  assert_int_equal(VecGetOwnershipRange(x, &first, &last), 0);
  assert_int_equal(VecSet(x, -1), 0);
  assert_int_equal(VecGetArray(x, &values), 0);
  for (PetscInt i = 0; i < n; i++) {
    u[i]    = -7;
    ones[i] = 1;
    if (dofs[i] >= first && dofs[i] < last)
      values[dofs[i] - first] = NodeValue(mesh, i / mesh->dim, (int)(i % mesh->dim));
  }
  for (PetscInt i = 0; i < last - first; i++) assert_true(PetscRealPart(values[i]) > 0); /* every entry has its dof */
  assert_int_equal(VecRestoreArray(x, &values), 0);
  assert_int_equal(MeshGlobalToLocal(mesh, x, u), 0);
  for (PetscInt i = 0; i < n; i++)
    assert_true(u[i] == (dofs[i] < 0 ? -7 : NodeValue(mesh, i / mesh->dim, (int)(i % mesh->dim))));
  CheckDistribution(mesh, x, u, dofs);

  /* a 1 from every copy gives the number of copies, in the vector and as nodal sum, and both agree */
  assert_int_equal(MeshLocalToGlobal(mesh, ones, F), 0);
  assert_int_equal(MeshSumNodes(mesh, mesh->dim, ones), 0);
  assert_int_equal(MeshGlobalToLocal(mesh, F, u), 0);
  for (PetscInt i = 0; i < n; i++)
    assert_true(ones[i] >= (mesh->node_owner[i / mesh->dim] == rank ? 1 : 2) && (dofs[i] < 0 || u[i] == ones[i]));
  double copies = 0;

  for (PetscInt i = 0; i < mesh->n_nodes; i++) copies += mesh->node_owner[i] == rank ? ones[i * mesh->dim] : 0;
  assert_true(Sum(copies) == Sum((double)mesh->n_nodes));
  assert_int_equal(VecDestroy(&x), 0);
  assert_int_equal(VecDestroy(&F), 0);
  assert_int_equal(PetscFree(constrained), 0);
  assert_int_equal(PetscFree2(u, ones), 0);
}

/* The report has these words, on rank 0 only, and its columns are aligned: every number of a column ends where the
   heading ends. */
static void CheckReport(Mesh mesh, Scene scene, const char *body, const char *cells)
{
  char  text[2048] = "";
  FILE *stream     = tmpfile();

  assert_non_null(stream);
  assert_int_equal(MeshReport(mesh, scene, stream), 0);
  rewind(stream);
  if (fread(text, 1, sizeof(text) - 1, stream) && rank) fail_msg("rank %d printed", rank);
  fclose(stream);
  if (rank) return;
  const char *heading = strstr(text, "         body"), *line = strstr(text, body),
             *faces = strstr(text, "         surface");

  assert_true(heading && line && faces && strstr(line, cells));
  for (const char *start = line; line > text && line[-1] != '\n';) line = --start;
  assert_int_equal(strstr(heading, "volume") + 6 - heading, strstr(faces, "area") + 4 - faces);
  assert_int_equal(line[strstr(heading, "nodes") + 5 - heading], ' ');
  assert_int_equal(line[strstr(heading, "in cell") + 7 - heading], ' ');
  assert_int_equal(strstr(line, cells) - line, strstr(heading, "cells") - heading);
  assert_true(!!strstr(text, "parts    metis: ") == (size > 1));
}

static void test_elements(void **state)
{
  static const Case cases[] = {{"tri3", 0, 0, 1}, {"tri6", 0, 0, 2},  {"quad4", 1, 0, 1}, {"quad9", 1, 0, 2},
                               {"tet4", 0, 1, 1}, {"tet10", 0, 1, 2}, {"hex8", 1, 1, 1},  {"hex27", 1, 1, 2}};

  (void)state;
  for (size_t t = 0; t < sizeof(cases) / sizeof(*cases); t++) {
    const Case *test  = &cases[t];
    Scene       scene = RingScene(test);
    char        file[PETSC_MAX_PATH_LEN], cells_text[64];
    Mesh        mesh = MakeMesh(scene, file);
    const int   n = ROUND * test->order + 1, m = ACROSS * test->order + 1,
              cells = ROUND * ACROSS *
                      (test->blocks  ? 1
                       : test->solid ? 6
                                     : 2);
    const int around = 2 * (ROUND + ACROSS) * (test->solid && !test->blocks ? 2 : 1),
              plane  = test->solid ? 2 * ROUND * ACROSS * (test->blocks ? 1 : 2) : 0;
    PetscInt n_faces;
    double   flux = Flux(mesh, &n_faces);

    for (PetscInt c = 0; c < mesh->n_cells; c++)
      assert_string_equal(ElementGet(mesh->cell_type[c])->name, test->element);
    assert_int_equal(mesh->order, test->order);
    assert_int_equal(mesh->n_cells_global, cells);
    assert_int_equal(mesh->n_global, n * m * (test->solid ? test->order + 1 : 1));
    assert_int_equal(n_faces, around + plane);
    assert_true(fabs(Volume(mesh) - RingVolume(test)) < 1e-10);
    assert_true(fabs(flux - RingVolume(test)) < 1e-10);
    CheckAgainstFile(mesh, file);
    CheckOwners(mesh);
    CheckGroupNodes(mesh);
    CheckPlex(mesh, Group(mesh, scene, "cut_x"));
    CheckDofs(mesh, scene);
    assert_int_equal(MeshCheckQuality(mesh, scene), 0);
    snprintf(cells_text, sizeof(cells_text), "%d %s\n", cells, test->element);
    CheckReport(mesh, scene, "ring ", cells_text);
    assert_string_equal(mesh->partition.tool, size > 1 ? "metis" : "none");
    assert_true(mesh->partition.imbalance_cells >= 1 && (size == 1 || mesh->partition.edge_cut > 0));
    assert_int_equal(MeshDestroy(&mesh), 0);
    assert_int_equal(SceneDestroy(&scene), 0);
  }
}

/* Cell types in one mesh */

/* Two squares of one body, one of quadrangles and one of triangles, which share their middle, with 3 cells along each
   side. */
static const char *const quads_and_triangles =
  "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {2, 0, 0}; Point(4) = {2, 1, 0}; Point(5) = {1, 1, 0}; "
  "Point(6) = {0, 1, 0};\n"
  "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1}; Line(7) "
  "= {2, 5};\n"
  "Curve Loop(1) = {1, 7, 5, 6}; Plane Surface(1) = {1}; Curve Loop(2) = {2, 3, 4, -7}; Plane Surface(2) = {2};\n"
  "Transfinite Curve{1:7} = 4; Transfinite Surface{1:2}; Recombine Surface{1};\n"
  "Physical Surface(\"both\") = {1, 2};\n"
  "Physical Curve(\"cut_x\") = {6}; Physical Curve(\"boundary\") = {1:5}; Physical Curve(\"middle\") = {7};\n";

/* Two cubes, which are bodies that touch nowhere, one of hexahedra and one of tetrahedra, in 2 layers of 2 x 2. */
static const char *const hexes_and_tets =
  "For k In {0:1}\n"
  "  a = 10 * k; x = 1.5 * k;\n"
  "  Point(a + 1) = {x, 0, 0}; Point(a + 2) = {x + 1, 0, 0}; Point(a + 3) = {x + 1, 1, 0}; Point(a + 4) = {x, 1, 0};\n"
  "  Line(a + 1) = {a + 1, a + 2}; Line(a + 2) = {a + 2, a + 3}; Line(a + 3) = {a + 3, a + 4}; Line(a + 4) = {a + 4, a "
  "+ 1};\n"
  "  Curve Loop(a + 1) = {a + 1, a + 2, a + 3, a + 4}; Plane Surface(a + 1) = {a + 1};\n"
  "  Transfinite Curve{a + 1, a + 2, a + 3, a + 4} = 3; Transfinite Surface{a + 1};\n"
  "EndFor\n"
  "Recombine Surface{1};\n"
  "v[] = Extrude{0, 0, 1} { Surface{1}; Layers{2}; Recombine; };\n"
  "w[] = Extrude{0, 0, 1} { Surface{11}; Layers{2}; };\n"
  "Physical Volume(\"hexes\") = {v[1]}; Physical Volume(\"tets\") = {w[1]}; Physical Surface(\"cut_x\") = {v[5]};\n"
  "Physical Surface(\"outside\") = {1, v[0], v[2], v[3], v[4], 11, w[0], w[2], w[3], w[4], w[5]};\n";

typedef struct {
  const char *name, *geometry, *geo, *bodies, *loaded;
  int         order;
  ElementType type[2];
  int         body[2], cells[2], nodes, faces; /* body and number of cells of each type */
  const char *row[2], *report[2];              /* line of the report, and its cells */
} Mixed;

static Scene MixedScene(const Mixed *test)
{
  char text[1024], path[PETSC_MAX_PATH_LEN];

  WriteText(test->name, test->geo, path);
  snprintf(text, sizeof(text),
           "mesh: {file: %s, order: %d}\ngeometry: %s\nbodies: [%s]\nsupports: [{surface: cut_x, ux: 0}]\nloads: "
           "[{surface: %s, pressure: 1}]\n",
           test->name, test->order, test->geometry, test->bodies, test->loaded);
  return MakeScene(text);
}

static void CheckTypes(Mesh mesh, const Mixed *test)
{
  double count[2] = {0};

  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const int k = mesh->cell_type[c] == test->type[1];

    assert_int_equal(mesh->cell_type[c], test->type[k]);
    assert_int_equal(mesh->cell_body[c], test->body[k]);
    assert_int_equal(mesh->cell_ptr[c + 1] - mesh->cell_ptr[c], ElementGet(test->type[k])->nodes);
    count[k]++;
  }
  for (int k = 0; k < 2; k++) assert_true(Sum(count[k]) == test->cells[k]);
}

#define MATERIAL "material: {law: svk, E: 1, nu: 0.3}"
static void test_mixed_types(void **state)
{
  static const char *const one = "{volume: both, " MATERIAL "}", *const two = "{volume: hexes, " MATERIAL
                                                                              "}, {volume: tets, " MATERIAL "}";
  const Mixed cases[] = {
    {"plane.geo",
     "plane_strain",
     quads_and_triangles,
     one,
     "boundary",
     1,
     {ELEMENT_TRI3, ELEMENT_QUAD4},
     {0, 0},
     {18, 9},
     28,
     18,
     {"both ", "both "},
     {"18 tri3, 9 quad4\n", "18 tri3, 9 quad4\n"}},
    {"plane.geo",
     "plane_strain",
     quads_and_triangles,
     one,
     "boundary",
     2,
     {ELEMENT_TRI6, ELEMENT_QUAD9},
     {0, 0},
     {18, 9},
     91,
     18,
     {"both ", "both "},
     {"18 tri6, 9 quad9\n", "18 tri6, 9 quad9\n"}},
    {"solid.geo",
     "solid",
     hexes_and_tets,
     two,
     "outside",
     1,
     {ELEMENT_HEX8, ELEMENT_TET4},
     {0, 1},
     {8, 48},
     54,
     72,
     {"hexes ", "tets "},
     {"8 hex8\n", "48 tet4\n"}},
    {"solid.geo",
     "solid",
     hexes_and_tets,
     two,
     "outside",
     2,
     {ELEMENT_HEX27, ELEMENT_TET10},
     {0, 1},
     {8, 48},
     250,
     72,
     {"hexes ", "tets "},
     {"8 hex27\n", "48 tet10\n"}},
  };

  (void)state;
  for (size_t t = 0; t < sizeof(cases) / sizeof(*cases); t++) {
    Scene    scene = MixedScene(&cases[t]);
    char     file[PETSC_MAX_PATH_LEN];
    Mesh     mesh = MakeMesh(scene, file);
    PetscInt n_faces;

    CheckTypes(mesh, &cases[t]);
    assert_int_equal(mesh->order, cases[t].order);
    assert_int_equal(mesh->n_global, cases[t].nodes);
    assert_true(fabs(Volume(mesh) - 2) < 1e-12);
    assert_true(fabs(Flux(mesh, &n_faces) - 2) < 1e-12);
    assert_int_equal(n_faces, cases[t].faces);
    CheckAgainstFile(mesh, file);
    CheckOwners(mesh);
    CheckGroupNodes(mesh);
    CheckPlex(mesh, Group(mesh, scene, "cut_x"));
    CheckDofs(mesh, scene);
    assert_int_equal(MeshCheckQuality(mesh, scene), 0);
    for (int k = 0; k < 2; k++) CheckReport(mesh, scene, cases[t].row[k], cases[t].report[k]);
    assert_int_equal(MeshDestroy(&mesh), 0);
    assert_int_equal(SceneDestroy(&scene), 0);
  }
}
#undef MATERIAL

/* Each rank gives 2^rank. The sum of a node shows on which ranks it is, for any other values in the block. On one rank
   nothing is added. */
static void test_sum_nodes(void **state)
{
  const Case ring_case = {"hex27", 1, 1, 2};
  Scene      scene     = RingScene(&ring_case);
  char       file[PETSC_MAX_PATH_LEN];
  Mesh       mesh = MakeMesh(scene, file);
  double    *ranks, shared = 0;

  (void)state;
  assert_int_equal(PetscCalloc1(mesh->n_global, &ranks), 0);
  for (PetscInt i = 0; i < mesh->n_nodes; i++) ranks[mesh->node_id[i]] = 1 << rank;
  assert_int_equal(
    MPI_Allreduce(MPI_IN_PLACE, ranks, (PetscMPIInt)mesh->n_global, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD),
    MPI_SUCCESS);
  for (int block = 1; block <= 3; block++) {
    PetscReal *values;

    assert_int_equal(PetscMalloc1(mesh->n_nodes * block, &values), 0);
    for (PetscInt i = 0; i < mesh->n_nodes * block; i++) values[i] = (1 << rank) * (double)(1 + i % block);
    assert_int_equal(MeshSumNodes(mesh, block, values), 0);
    for (PetscInt i = 0; i < mesh->n_nodes * block; i++)
      assert_true(values[i] == ranks[mesh->node_id[i / block]] * (double)(1 + i % block));
    assert_int_equal(PetscFree(values), 0);
  }
  for (PetscInt i = 0; i < mesh->n_nodes; i++) shared += ranks[mesh->node_id[i]] != 1 << rank;
  assert_true((Sum(shared) > 0) == (size > 1));
  assert_int_equal(PetscFree(ranks), 0);
  assert_int_equal(MeshDestroy(&mesh), 0);
  assert_int_equal(SceneDestroy(&scene), 0);
}

/* Wrong meshes */

/* Three squares in a row, body a and two squares of body b, which share the nodes of "middle". "tool" is a separate
   surface above them, and its group has a minus sign. */
static const char *const squares =
  "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
  "$PhysicalNames\n5\n1 1 \"left\"\n1 4 \"middle\"\n1 5 \"tool\"\n2 2 \"a\"\n2 3 \"b\"\n$EndPhysicalNames\n"
  "$Entities\n0 3 2 0\n1 0 0 0 0 1 0 1 1 0\n2 1 0 0 1 1 0 1 4 0\n3 0 2 0 2 2 0 1 -5 0\n1 0 0 0 1 1 0 1 2 0\n2 1 0 0 3 "
  "1 0 1 3 0\n$EndEntities\n"
  "$Nodes\n1 11 10 21\n2 1 0 11\n10\n11\n12\n13\n14\n15\n16\n17\n19\n20\n21\n"
  "0 0 0\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n2 1 0\n3 0 0\n3 1 0\n0 2 0\n1 2 0\n2 2 0\n$EndNodes\n"
  "$Elements\n5 7 1 7\n1 1 1 1\n1 10 13\n1 2 1 1\n2 11 14\n1 3 1 2\n5 19 20\n6 20 21\n2 1 3 1\n3 10 11 14 13\n2 2 3 "
  "2\n4 11 12 15 14\n7 12 16 17 "
  "15\n$EndElements\n";
static const char *const two_bodies = "mesh: {file: two.msh}\ngeometry: plane_strain\n"
                                      "bodies:\n  - {volume: a, material: {law: svk, E: 1, nu: 0.3}}\n  - {volume: b, "
                                      "material: {law: svk, E: 1, nu: 0.3}}\n"
                                      "  - {surface: tool, rigid: {point: [0, 0]}}\n"
                                      "loads: [{surface: left, ux: 0}]\n";

/* Copies text with the first `from` replaced by `to`. */
static void Edit(const char *text, const char *from, const char *to, char *edited, size_t room)
{
  const char *at = strstr(text, from);

  assert_non_null(at);
  snprintf(edited, room, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
}

typedef struct {
  const char *from, *to;             /* edit of the mesh */
  const char *scene_from, *scene_to; /* edit of the scene */
  const char *message[2];            /* text that the refusal must contain */
} Wrong;

static const Wrong wrong[] = {
  {"4.1 0 8", "2.2 0 8", "", "", {"two.msh' is not taken: gmsh cannot read it", "mesh.file"}},
  {"$MeshFormat\n4.1", "$Junk\n4.1", "", "", {"is no gmsh mesh", ""}},
  {"$PhysicalNames\n5\n1 1 \"left\"\n1 4 \"middle\"\n1 5 \"tool\"\n2 2 \"a\"\n2 3 \"b\"\n$EndPhysicalNames\n",
   "",
   "",
   "",
   {"no physical names", "Physical Volume"}},
  {"\n4 11 12 15 14\n7 12 16 17 15\n$EndElements\n",
   "\n4 11 12",
   "",
   "",
   {"two.msh:", "truncated or damaged in section $Elements"}},
  {"4 11 12 15 14", "4 11 12 15 99", "", "", {"element 4 has node 99", "not in the file"}},
  {"2 1 3 1\n3 10 11 14 13",
   "2 1 16 1\n3 10 11 14 13 10 10 10 10",
   "",
   "",
   {"serendipity", "-setnumber Mesh.SecondOrderIncomplete 0"}},
  {"2 1 3 1\n3 10 11 14 13", "2 1 7 1\n3 10 11 14 13 10", "", "", {"5-node pyramid", "hex27"}},
  {"2 1 3 1\n3 10 11 14 13", "2 1 21 1\n3 10 11 14 13 10", "", "", {"of order 3 or higher", ""}},
  {"2 1 3 1\n3 10 11 14 13", "2 1 10 1\n3 10 11 14 13 10 10 10 10 10", "", "", {"elements of two orders", "quad9"}},
  {"", "", "two.msh}", "two.msh, order: 2}", {"mesh.order", "of order 1"}},
  {"1 0 0 0 1 1 0 1 2 0", "1 0 0 0 1 1 0 2 2 3 0", "", "", {"cell 3 is in two bodies, 'a' and 'b'", ""}},
  {"2 2 \"a\"", "2 2 \"c\"", "", "", {"bodies.0.volume: ", "no volume group 'a'; its volume groups: c, b"}},
  {"",
   "",
   "  - {volume: b, material: {law: svk, E: 1, nu: 0.3}}\n",
   "",
   {"bodies: ", "volume group 'b' that is no body"}},
  {"2 1 0 0 3 1 0 1 3 0",
   "2 1 0 0 3 1 0 1 2 0",
   "",
   "",
   {"bodies.1.volume", "no cells of a volume group 'b'; its volume groups: a, b"}},
  {"6 20 21", "6 19 20", "", "", {"node 21 belongs to no element", ""}},
  {"\n1 0 0\n2 0 0", "\n1 0 0.5\n2 0 0", "", "", {"node 11 has z = 0.5", "z = 0"}},
  {"\n1 0 0\n2 0 0",
   "\n-1 0 0\n2 0 0",
   "geometry: plane_strain",
   "geometry: axisymmetric",
   {"node 11 has x = -1", "radius"}},
  {"3 10 11 14 13", "3 10 14 11 13", "", "", {"cell 3 of body 'a' is inverted", "inverted cells in all: 1"}},
  {"1 0 0 0 0 1 0 1 1 0", "1 0 0 0 0 1 0 2 1 5 0", "", "", {"bodies.2.surface", "is a face of a deformable body"}},
  {"", "", "surface: tool", "surface: tol", {"bodies.2.surface", "no surface group 'tol'"}},
  {"",
   "",
   "{surface: left, ux: 0}",
   "{surface: middle, pressure: 1}",
   {"loads.0.surface", "1 of the 1 faces of 'middle' lie between two cells"}},
  {"", "", "{surface: left, ux: 0}", "{surface: tool, ux: 0}", {"loads.0.surface", "is a rigid tool"}},
  {"",
   "",
   "{surface: left, ux: 0}",
   "{surface: lefft, ux: 0}",
   {"loads.0.surface", "no surface 'lefft'; it has: left, middle, tool"}},
  {"",
   "",
   "{surface: left, ux: 0}",
   "{surface: a, ux: 0}",
   {"loads.0.surface", "'a' is a volume; a surface is needed"}},
  {"",
   "",
   "  - {surface: tool, rigid: {point: [0, 0]}}\nloads: [{surface: left, ux: 0}]",
   "loads: [{surface: tool, ux: 0}]",
   {"loads.0.surface", "2 of the 2 elements of 'tool' do not lie on any body"}},
  {"\n11\n", "\n10\n", "", "", {"node 10 occurs twice", ""}},
  {"\n4 11 12 15 14", "\n3 11 12 15 14", "", "", {"two cells have the tag 3", ""}},
  {"$Nodes",
   "$PartitionedEntities\n2\n0\n0 0 1 0\n9 2 1 1 1 0 0 0 1 1 0 1 1 0\n$EndPartitionedEntities\n$Nodes",
   "",
   "",
   {"partition 1 of 2 is not in the file", ""}},
  {"", "", "two.msh", "none.msh", {"none.msh: there is no such file", ""}},
};

static void TryWrong(const Wrong *test)
{
  char       text[4096], path[PETSC_MAX_PATH_LEN], file[PETSC_MAX_PATH_LEN];
  Scene      scene;
  Mesh       mesh;
  PetscReal  seconds;
  MeshGroup *group;

  Edit(squares, test->from, test->to, text, sizeof(text));
  WriteText("two.msh", text, path);
  Edit(two_bodies, test->scene_from, test->scene_to, text, sizeof(text));
  refused[0] = '\0';
  WriteText("scene.yaml", text, path);
  if (Refused(SceneRead(PETSC_COMM_WORLD, path, 0, NULL, &scene))) return;
  if (!Refused(MeshGenerate(PETSC_COMM_WORLD, scene, folder, PETSC_FALSE, file, &seconds)) &&
      !Refused(MeshCreate(PETSC_COMM_WORLD, scene, file, &mesh))) {
    if (!Refused(MeshCheckQuality(mesh, scene)))
      Refused(MeshGetGroup(mesh, scene, "loads.0", "surface", scene->loads[0].region, mesh->dim - 1, &group));
    assert_int_equal(MeshDestroy(&mesh), 0);
  }
  assert_int_equal(SceneDestroy(&scene), 0);
}

/* The tool is whole on every rank, and its normals are reversed, because its group has a minus sign. The frame is the
   bodies' bounding box. */
static void test_rigid_tool(void **state)
{
  char       path[PETSC_MAX_PATH_LEN];
  Scene      scene;
  Mesh       mesh;
  MeshRigid *tool;
  MeshGroup *middle;

  (void)state;
  WriteText("two.msh", squares, path);
  scene = MakeScene(two_bodies);
  mesh  = MakeMesh(scene, path);
  tool  = MeshFindRigid(mesh, "tool");
  assert_null(MeshFindRigid(mesh, "left"));
  assert_non_null(tool);
  assert_int_equal(tool->n_faces, 2);
  assert_int_equal(tool->n_nodes, 3);
  for (int f = 0; f < 2; f++) {
    assert_int_equal(tool->face_tag[f], 5 + f);
    assert_int_equal(tool->face_type[f], ELEMENT_EDGE2);
    assert_int_equal(tool->face_ptr[f + 1] - tool->face_ptr[f], 2);
    assert_int_equal(tool->face_nodes[tool->face_ptr[f]], f + 1);
    assert_int_equal(tool->face_nodes[tool->face_ptr[f] + 1], f);
  }
  for (int i = 0; i < 3; i++) {
    assert_int_equal(tool->node_tag[i], 19 + i);
    assert_true(tool->coords[2 * i] == i - 1.5 && tool->coords[2 * i + 1] == 1.5);
  }
  assert_int_equal(mesh->n_global, 8);
  assert_true(fabs(mesh->size - sqrt(10.)) < 1e-15);

  /* a surface between cells belongs to one cell, on one rank; its nodes are on every rank that needs them */
  middle = Group(mesh, scene, "middle");
  assert_true(Sum((double)middle->n_faces) == 1);
  for (PetscInt f = 0; f < middle->n_faces; f++) assert_int_equal(mesh->cell_tag[middle->face_cell[f]], 3);
  for (PetscInt c = 0; c < mesh->n_cells; c++) assert_true(mesh->cell_tag[c] == 7 || middle->n_nodes == 2);
  assert_int_equal(MeshDestroy(&mesh), 0);
  assert_int_equal(SceneDestroy(&scene), 0);
}

static void test_wrong_meshes(void **state)
{
  (void)state;
  for (size_t t = 0; t < sizeof(wrong) / sizeof(*wrong); t++) {
    TryWrong(&wrong[t]);
    for (int k = 0; k < 2; k++)
      if (!strstr(refused, wrong[t].message[k]) || !refused[0])
        fail_msg("case %zu: expected '%s', got '%s'", t, wrong[t].message[k], refused);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_elements), cmocka_unit_test(test_mixed_types),
                                     cmocka_unit_test(test_sum_nodes), cmocka_unit_test(test_rigid_tool),
                                     cmocka_unit_test(test_wrong_meshes)};
  char                    command[128];
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  assert_int_equal(MPI_Comm_rank(PETSC_COMM_WORLD, &rank), MPI_SUCCESS);
  assert_int_equal(MPI_Comm_size(PETSC_COMM_WORLD, &size), MPI_SUCCESS);
  snprintf(folder, sizeof(folder), "/tmp/burnish_mesh_XXXXXX");
  if (!rank && !mkdtemp(folder)) return 1;
  assert_int_equal(MPI_Bcast(folder, sizeof(folder), MPI_CHAR, 0, PETSC_COMM_WORLD), MPI_SUCCESS);
  if (ErrorLogBegin()) return 1; /* refusals do not print a stack trace */
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (ErrorLogEnd()) return 1;
  snprintf(command, sizeof(command), "rm -r %s", folder);
  assert_int_equal(MPI_Barrier(PETSC_COMM_WORLD), MPI_SUCCESS);
  if (!rank && system(command)) failed++;
  if (PetscFinalize()) return 1;
  return failed;
}
