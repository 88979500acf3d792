/* A program that links the library can register a smoother of its own: a scene chooses it by name, and contact
 * evaluates it as it does the built-in ones. The smoothers here are the facets and the diffuse fit, pushed outward by a
 * constant distance. */
#include "contact/contact.h"
#include "mesh/mesh.h"
#include "smooth/smoother.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>

#define PUSH    0.15
#define APART   0.1 /* between the two blocks before any load */
#define PENALTY 1000.

static char folder[64];

static int EvaluatePushed(const SmootherInput *in, SmootherWant want, SmootherResult *out)
{
  if (!SmootherEvaluate_Facet(in, want, out)) return 0;
  out->gap -= PUSH; /* the variations are those of the facets */
  return 1;
}

static const Smoother pushed = {.capacity       = FACE_MAX_NODES,
                                .dense_capacity = FACE_MAX_NODES,
                                .evaluate       = EvaluatePushed};

static int EvaluatePushedFit(const SmootherInput *in, SmootherWant want, SmootherResult *out)
{
  if (!Smoother_Diffuse.evaluate(in, want, out)) return 0;
  out->gap -= PUSH;
  return 1;
}

/* The gap that the search finds with its fit is not the gap of this smoother: search_gap is 0. */
static Smoother pushed_fit = {.fitted = 1, .evaluate = EvaluatePushedFit};

static const char blocks[] =
  "For k In {0:1}\n"
  "  p = newp; y = k * 1.1;\n"
  "  Point(p) = {0, y, 0}; Point(p+1) = {1, y, 0};\n"
  "  Point(p+2) = {1, y+1, 0}; Point(p+3) = {0, y+1, 0};\n"
  "  l = 4*k + 1;\n"
  "  Line(l) = {p, p+1}; Line(l+1) = {p+1, p+2}; Line(l+2) = {p+2, p+3}; Line(l+3) = {p+3, p};\n"
  "  Curve Loop(k+1) = {l:l+3}; Plane Surface(k+1) = {k+1};\n"
  "  Transfinite Curve{l:l+3} = 4+k; Transfinite Surface{k+1}; Recombine Surface{k+1};\n"
  "EndFor\n"
  "Physical Surface(\"lower\") = {1}; Physical Surface(\"upper\") = {2};\n"
  "Physical Curve(\"bottom\") = {1}; Physical Curve(\"master\") = {3};\n"
  "Physical Curve(\"slave\") = {5}; Physical Curve(\"top\") = {7};\n";

static const char scene_text[] = "name: pushed\n"
                                 "mesh: {file: blocks.geo, order: 1}\n"
                                 "geometry: plane_strain\n"
                                 "kinematics: finite\n"
                                 "bodies:\n"
                                 "  - {volume: lower, material: {law: svk, E: 1000, nu: 0}}\n"
                                 "  - {volume: upper, material: {law: svk, E: 1000, nu: 0}}\n"
                                 "supports: [{surface: bottom, ux: 0, uy: 0}]\n"
                                 "loads: [{surface: top, pressure: 1}]\n"
                                 "contact:\n"
                                 "  - {name: joint, slave: slave, master: master, smoother: %s, formulation: %s, "
                                 "penalty: {initial: 1000}}\n"
                                 "stepping: {control: fixed, initial: 1}\n";

static void Write(const char *name, const char *text, char *path, size_t size)
{
  FILE *file;

  snprintf(path, size, "%s/%s", folder, name);
  file = fopen(path, "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

/* Contact of the two blocks where they lie: gaps of all slave nodes, energy and force on the master against what the
 * smoother's own surface gives. */
static void CheckBlocks(const char *smoother, const char *formulation, double gap, const char *words)
{
  const double   depth = gap < 0 ? -gap : 0;
  char           text[2048], path[128], mesh_file[PETSC_MAX_PATH_LEN];
  double         seconds, energy = 0, force[3], *u, *f;
  Scene          scene;
  Mesh           mesh;
  Loads          loads;
  Elasticity     elasticity;
  Contact        contact;
  ContactNodes   nodes;
  ContactSummary summary;
  Mat            C;
  PetscBool      changed;

  snprintf(text, sizeof(text), scene_text, smoother, formulation);
  Write("blocks.geo", blocks, path, sizeof(path));
  Write("scene.yaml", text, path, sizeof(path));
  assert_int_equal(SceneRead(PETSC_COMM_WORLD, path, 0, NULL, &scene), 0);
  assert_string_equal(SmootherNames[scene->contacts[0].smoother], smoother);
  assert_int_equal(MeshGenerate(PETSC_COMM_WORLD, scene, folder, PETSC_FALSE, mesh_file, &seconds), 0);
  assert_int_equal(MeshCreate(PETSC_COMM_WORLD, scene, mesh_file, &mesh), 0);
  assert_int_equal(LoadsCreate(mesh, scene, 0, &loads), 0);
  assert_int_equal(ElasticityCreate(mesh, scene, &elasticity), 0);
  assert_int_equal(ContactCreate(mesh, scene, elasticity, loads, &contact), 0);
  assert_int_equal(PetscCalloc2(mesh->n_nodes * mesh->dim, &u, mesh->n_nodes * mesh->dim, &f), 0);

  assert_int_equal(ContactGather(contact, u, 0, 0, 0), 0);
  assert_int_equal(ContactResidual(contact, u, 0, f, &energy, NULL), 0);
  assert_int_equal(ContactGetNodes(contact, 0, u, &nodes), 0);
  assert_int_equal(nodes.n, 5);
  for (int c = 0; c < nodes.n; c++) assert_true(fabs(nodes.gap[c] - gap) < 1e-12);
  assert_true(fabs(energy - PENALTY * depth * depth / 2) < 1e-9);
  assert_int_equal(ContactMasterForce(contact, 0, force), 0);
  assert_true(fabs(force[0]) < 1e-9 && fabs(force[1] + PENALTY * depth) < 1e-9);
  assert_int_equal(ContactSummarise(contact, &summary), 0);
  assert_int_equal(summary.nodes, gap < 0 ? 5 : 0);
  assert_int_equal(ContactTangent(contact, u, 0, &C, &changed), 0);
  assert_int_equal(ContactPairText(contact, 0, text, sizeof(text)), 0);
  assert_string_equal(text, words);

  assert_int_equal(PetscFree2(u, f), 0);
  assert_int_equal(ContactDestroy(&contact), 0);
  assert_int_equal(ElasticityDestroy(&elasticity), 0);
  assert_int_equal(LoadsDestroy(&loads), 0);
  assert_int_equal(MeshDestroy(&mesh), 0);
  assert_int_equal(SceneDestroy(&scene), 0);
}

static void test_evaluated(void **state)
{
  (void)state;
  CheckBlocks("facet", "node_to_surface", APART, "slave on master, facets");
  CheckBlocks("diffuse", "node_to_surface", APART, "slave on master, diffuse, degree 4, support 4.5, weight 6");
  CheckBlocks("pushed", "node_to_surface", APART - PUSH, "slave on master, pushed");
  CheckBlocks("pushed", "surface_to_surface", APART - PUSH, "slave on master, pushed, surface to surface");
  CheckBlocks("pushed_fit", "node_to_surface", APART - PUSH,
              "slave on master, pushed_fit, degree 4, support 4.5, weight 6");
}

/* Names that a scene could not write, or that are taken, leave the table as it was; so does one too many. */
static void test_refused(void **state)
{
  static char names[SMOOTHER_MAX][8];

  (void)state;
  assert_int_equal(SmootherRegister("facet", &pushed), 0);
  assert_int_equal(SmootherRegister("pushed", &pushed), 0);
  assert_int_equal(SmootherRegister("", &pushed), 0);
  assert_int_equal(SmootherRegister("two words", &pushed), 0);
  assert_string_equal(SMOOTHER_CHOICES, &(SMOOTHERS(CHOICE_BAR) " | pushed | pushed_fit")[sizeof " | " - 1]);
  for (int k = SMOOTHER_KINDS + 2; k < SMOOTHER_MAX; k++) {
    snprintf(names[k], sizeof(names[k]), "more%d", k);
    assert_int_equal(SmootherRegister(names[k], &pushed), 1);
  }
  assert_int_equal(SmootherRegister("too_many", &pushed), 0);
  assert_ptr_equal(Smoothers[SMOOTHER_MAX - 1], &pushed);
  assert_null(Smoothers[SMOOTHER_MAX]);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_evaluated), cmocka_unit_test(test_refused)};
  char                    command[128];
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  snprintf(folder, sizeof(folder), "/tmp/burnish_smoother_XXXXXX");
  if (!mkdtemp(folder)) return 1;
  pushed_fit.capacity       = Smoother_Diffuse.capacity;
  pushed_fit.dense_capacity = Smoother_Diffuse.dense_capacity;
  pushed_fit.workspace      = Smoother_Diffuse.workspace;
  if (!SmootherRegister("pushed", &pushed) || !SmootherRegister("pushed_fit", &pushed_fit)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  snprintf(command, sizeof(command), "rm -r %s", folder);
  if (system(command)) failed++;
  if (PetscFinalize()) return 1;
  return failed;
}
