/* Long faces of a tool beside short ones are divided: a fillet between two walls, as lines and extruded in one layer.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "mesh/private/tooldivision.h"
#include "mesh/private/tooledges.h"

enum { ARC = 8, PROFILE = ARC + 2, FIRST_NODE = 1000, FIRST_FACE = 2000 };

static const double Wall = 31, Radius = 6, Depth = 30;

/* A point of the profile. s counts its faces: a wall, the fillet, the other wall. */
static void Profile(double s, double x[2])
{
  const double angle = PETSC_PI / 2 * PetscMin(PetscMax((s - 1) / ARC, 0), 1);

  x[0] = Radius * sin(angle) + (s < 1 ? (s - 1) * Wall : 0);
  x[1] = Radius * (1 - cos(angle)) + (s > ARC + 1 ? (s - ARC - 1) * Wall : 0);
}

/* Makes a tool of n faces of the profile from face `first` on, in one layer. */
static void Create(int dim, ElementType type, int first, int n, MeshRigid *tool)
{
  const Element *face  = ElementGet(type);
  const int      order = face->order, rows = dim == 2 ? 1 : order + 1, per = face->corners == 3 ? 2 : 1;
  const int      faces = n * per, columns = n * order + 1;
  /* places of a face's nodes in its cell of the grid, by steps of an element of second order; triangles: two */
  static const int edge[3]      = {0, 2, 1},
                   quad[9][2]   = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0}, {2, 1}, {1, 2}, {0, 1}, {1, 1}},
                   tri[2][6][2] = {{{0, 0}, {2, 0}, {2, 2}, {1, 0}, {2, 1}, {1, 1}},
                                   {{0, 0}, {2, 2}, {0, 2}, {1, 1}, {1, 2}, {0, 1}}};

  *tool = (MeshRigid){.n_nodes = columns * rows, .n_faces = faces};
  assert_int_equal(PetscMalloc2(tool->n_nodes * dim, &tool->coords, tool->n_nodes, &tool->node_tag), 0);
  assert_int_equal(PetscMalloc4(faces, &tool->face_type, faces + 1, &tool->face_ptr, faces * face->nodes,
                                &tool->face_nodes, faces, &tool->face_tag),
                   0);
  for (int i = 0; i < columns; i++) {
    for (int j = 0; j < rows; j++) {
      double x[2];

      Profile(first + (double)i / order, x);
      for (int d = 0; d < 2; d++) tool->coords[(i * rows + j) * dim + d] = x[d];
      if (dim == 3) tool->coords[(i * rows + j) * dim + 2] = Depth * j / order;
      tool->node_tag[i * rows + j] = i * rows + j + 1;
    }
  }
  tool->face_ptr[0] = 0;
  for (int f = 0; f < faces; f++) {
    tool->face_type[f]    = type;
    tool->face_tag[f]     = f + 1;
    tool->face_ptr[f + 1] = tool->face_ptr[f] + face->nodes;
    for (int a = 0; a < face->nodes; a++) {
      const int *at = face->corners == 4 ? quad[a] : tri[f % 2][a];
      const int  i = dim == 2 ? edge[a] : at[0], j = dim == 2 ? 0 : at[1];

      tool->face_nodes[tool->face_ptr[f] + a] = (f / per * order + i * order / 2) * rows + j * order / 2;
    }
  }
}

static void Destroy(MeshRigid *tool)
{
  assert_int_equal(PetscFree2(tool->coords, tool->node_tag), 0);
  assert_int_equal(PetscFree4(tool->face_type, tool->face_ptr, tool->face_nodes, tool->face_tag), 0);
}

/* Length or area of all faces, and their signed area seen along (1, -1): an overturned face would change it. */
static double Measure(int dim, const MeshRigid *tool, double *seen)
{
  double sum = *seen = 0;

  for (int f = 0; f < tool->n_faces; f++) {
    const Element *face = ElementGet(tool->face_type[f]);

    for (int q = 0; q < face->points; q++) {
      double t[2][3] = {{0}, {0, 0, dim == 2}}, n[3];

      for (int a = 0; a < face->nodes; a++)
        for (int k = 0; k < dim - 1; k++)
          for (int d = 0; d < dim; d++)
            t[k][d] += face->dN[q][a][k] * tool->coords[tool->face_nodes[tool->face_ptr[f] + a] * dim + d];
      for (int d = 0; d < 3; d++) n[d] = t[0][(d + 1) % 3] * t[1][(d + 2) % 3] - t[0][(d + 2) % 3] * t[1][(d + 1) % 3];
      sum += face->weight[q] * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      *seen += face->weight[q] * (n[0] - n[1]);
    }
  }
  return sum;
}

/* Checks that edges meet, and that lengths change little from edge to edge; those across triangles are of any length.
   Returns the length of the outline. */
static double CheckEdges(int dim, const MeshRigid *tool)
{
  ToolEdges edges;
  double    outline = 0;

  assert_int_equal(ToolEdgesCreate(dim, tool, &edges), 0);
  for (int e = 0; e < edges.n; e++) {
    const double length = ToolEdgeLength(dim, tool, &edges.edge[e]);

    assert_true(edges.edge[e].n_faces <= 2);
    if (edges.edge[e].n_faces == 1) outline += length;
    for (int k = 0; k < 2; k++) {
      const PetscInt next = ToolEdgeNext(&edges, tool, e, edges.edge[e].corner[k]);

      if (next >= 0 && ElementGet(tool->face_type[0])->corners != 3)
        assert_true(length < 3 * ToolEdgeLength(dim, tool, &edges.edge[next]));
    }
  }
  assert_int_equal(ToolEdgesDestroy(&edges), 0);
  return outline;
}

/* Checks a division of the whole profile. The quadrature of a curved face's area is not exact. */
static void Check(int dim, ElementType type)
{
  MeshRigid tool;
  ToolEdges edges;
  PetscInt  tags[2] = {FIRST_NODE, FIRST_FACE};
  double    before, after, seen[2], outline = 0;

  Create(dim, type, 0, PROFILE, &tool);
  before = Measure(dim, &tool, &seen[0]);
  assert_int_equal(ToolEdgesCreate(dim, &tool, &edges), 0);
  for (int e = 0; e < edges.n; e++)
    if (edges.edge[e].n_faces == 1) outline += ToolEdgeLength(dim, &tool, &edges.edge[e]);
  assert_int_equal(ToolEdgesDestroy(&edges), 0);

  assert_int_equal(ToolDivide(dim, &tool, &tags[0], &tags[1]), 0);
  after = Measure(dim, &tool, &seen[1]);
  assert_true(tool.n_faces > (dim == 2 ? 2 * PROFILE : 5 * PROFILE));
  assert_true(tool.n_faces < (dim == 2 ? 40 : 2000));
  assert_true(fabs(after - before) < (ElementGet(type)->order > 1 ? 1e-4 : 1e-12) * before);
  assert_true(fabs(seen[1] - seen[0]) < 1e-9 * fabs(seen[0]));
  after = CheckEdges(dim, &tool);
  assert_true(fabs(after - outline) < (ElementGet(type)->order > 1 ? 1e-3 : 1e-12) * outline || dim == 2);
  assert_int_equal(tags[1] - FIRST_FACE,
                   tool.n_faces - (dim == 2 || type == ELEMENT_QUAD4 || type == ELEMENT_QUAD9 ? 1 : 2) * PROFILE);
  for (int i = 1; i < tool.n_nodes; i++) assert_true(tool.node_tag[i] > tool.node_tag[i - 1]);
  Destroy(&tool);
}

static void test_lines(void **state)
{
  (void)state;
  Check(2, ELEMENT_EDGE2);
  Check(2, ELEMENT_EDGE3);
}

static void test_extruded(void **state)
{
  (void)state;
  Check(3, ELEMENT_QUAD4);
  Check(3, ELEMENT_TRI3);
  Check(3, ELEMENT_QUAD9);
  Check(3, ELEMENT_TRI6);
}

/* A flat tool, and one of even faces, stay as they are. */
static void test_left(void **state)
{
  static const struct {
    int         dim;
    ElementType type;
    int         first, n;
  } left[] = {{2, ELEMENT_EDGE2, 0, 1}, {3, ELEMENT_QUAD4, 0, 1}, {3, ELEMENT_TRI6, 0, 1}, {2, ELEMENT_EDGE3, 1, ARC}};

  (void)state;
  for (size_t i = 0; i < sizeof(left) / sizeof(left[0]); i++) {
    MeshRigid tool;
    PetscInt  tags[2] = {FIRST_NODE, FIRST_FACE}, faces;

    Create(left[i].dim, left[i].type, left[i].first, left[i].n, &tool);
    faces = tool.n_faces;
    assert_int_equal(ToolDivide(left[i].dim, &tool, &tags[0], &tags[1]), 0);
    assert_int_equal(tool.n_faces, faces);
    assert_int_equal(tags[0], FIRST_NODE);
    Destroy(&tool);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_lines), cmocka_unit_test(test_extruded),
                                     cmocka_unit_test(test_left)};
  int                     failed;

  if (PetscInitializeNoArguments()) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
