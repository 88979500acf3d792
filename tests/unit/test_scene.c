/* Shows that the fields of the scene hold the value of every key of a scene file, its default and its -set. Shows that
   the places of values in messages, the canonical text and the command line are as their manual comments say. */
#include "base/petsccompat.h"
#include "scene/scene.h"
#include "schema.h"
#include "scene/commandline.h"
#include <stdlib.h>
#include <unistd.h>
#include <math.h>
#include <string.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

static const char Smallest[] = "mesh: {file: block.geo}\n"
                               "bodies:\n"
                               "  - {volume: block, material: {law: svk, E: 200, nu: 0.3}}\n";

/* Every key of the schema except those of analytic masters, of the law and of augmented penalties */
static const char Everything[] =
  "name: everything\n"
  "mesh: {file: /meshes/two.msh, order: 2, parameters: {n: 4, label: fine}}\n"
  "geometry: solid\n"
  "kinematics: small\n"
  "bodies:\n"
  "  - {volume: block, material: {law: linear, E: 200, nu: -0.25}, formulation: full}\n"
  "  - {volume: plate,\n"
  "    material: {law: neo_hookean, E: 3e5, nu: 0.49}, pretension: {axis: [0, 2, 0], force: 5, locked: 0.5}}\n"
  "  - {surface: die, rigid: {point: [1, 2, 3], motion: [{ux: 1, uy: 2, uz: 3, history: [[0, 0], [0.2, 1], [1, 1]]}, "
  "{rx: 4, ry: 5, rz: 6}]}}\n"
  "supports:\n"
  "  - {surface: bottom, ux: 0, uz: 0.0}\n"
  "loads:\n"
  "  - {surface: top, uy: -50, ux: 2}\n"
  "  - {surface: top, pressure: 20, follower: true, history: [[0, 0], [0.5, 2], [1, 1]]}\n"
  "  - {surface: side, pressure: 10, follower: false}\n"
  "  - {surface: side, traction: [0, -1, 0.5]}\n"
  "  - {volume: plate, body_force: [0, -9.8e-3, 0]}\n"
  "  - {surface: plate_bottom, pressure: 6, where: open, from: rim, to: [1, 2, 3]}\n"
  "contact:\n"
  "  - name: crown\n"
  "    slave: plate_bottom\n"
  "    master: die\n"
  "    smoother: facet\n"
  "    formulation: node_to_surface\n"
  "    offset: live\n"
  "    degree: 2\n"
  "    support: 3.5\n"
  "    weight: 6\n"
  "    frame: global\n"
  "    derivatives: diffuse\n"
  "    feature_angle: 30\n"
  "    symmetry: [symmetry_x, symmetry_z]\n"
  "    initial_overlap: refuse\n"
  "    stabilise: true\n"
  "    penalty: {initial: 1e5, scale: 10, adjust: true, when: step, g_min: 1e-6, g_max: 5e-6, unit: spacing, clamp: "
  "10, range: 100}\n"
  "  - {name: other, slave: block_top, master: plate_top}\n"
  "stepping: {control: contact, initial: 0.04, N_c_fraction: 0.05, prediction: tangent, dt_min: 1e-4, dt_max: 0.5, "
  "growth: 2, at: [0.25, 0.5]}\n"
  "solver: {type: direct, tolerance: 1e-9, max_iterations: 12}\n"
  "probes:\n"
  "  - {name: p0, reaction: top, component: y, absolute: true}\n"
  "  - {name: p1, contact_force: crown, component: x, factor: 2}\n"
  "  - {name: p2, displacement: [70, 4, 10], component: z, body: plate}\n"
  "  - {name: p3, distance: [[0, 1, 2], [3, 4, 5]], body: block, change: true}\n"
  "  - {name: p4, gap: crown, at: [1, 2, 3]}\n"
  "  - {name: p5, contact_edge: crown, axis: x, side: max, at: {z: 100}}\n"
  "  - {name: p6, pressure_max: other, at: {y: 10}}\n"
  "  - {name: p7, pressure_mean: crown}\n"
  "  - {name: p8, tool_motion: crown, component: z}\n"
  "  - {name: p9, tool_rotation: crown, component: y}\n"
  "  - {name: bolt_0, bolt_force: plate}\n"
  "  - {name: bolt_1, bolt_shortening: plate}\n"
  "  - {name: pressed, contact_area: crown}\n"
  "  - {name: p10, pressure_deviation: crown, measure: rms, excluding: 2}\n"
  "  - {name: p11, pressure_deviation: crown, measure: max, only: 1.5}\n"
  "  - {name: p12, reaction_torque: top, axis: z}\n"
  "  - {name: p13, contact_torque: crown, axis: x, at: [1, 2, 3]}\n"
  "  - {name: p14, fluid_front: plate_bottom, axis: y, side: min}\n"
  "  - {name: p15, fluid_area: plate_bottom}\n"
  "  - {name: p16, seal_pressure: plate_bottom}\n"
  "output: {every: 0, fields: [stress, contact], checkpoint: 0}\n"
  "petsc: {snes_monitor: , -pc_type: lu, ksp_rtol: 1e-9}\n";

static char Folder[] = "/tmp/burnish-scene-XXXXXX";
static char File[64];

static PetscErrorCode Read(const char *text, int n_set, char *const *set, Scene *scene)
{
  FILE *file = fopen(File, "w");

  PetscFunctionBeginUser;
  assert_non_null(file);
  assert_true(fputs(text, file) >= 0);
  fclose(file);
  PetscCall(SceneRead(PETSC_COMM_WORLD, File, n_set, set, scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void ReadOrFail(const char *text, int n_set, char *const *set, Scene *scene)
{
  assert_int_equal(Read(text, n_set, set, scene), PETSC_SUCCESS);
}

static void Free(Scene *scene)
{
  assert_int_equal(SceneDestroy(scene), PETSC_SUCCESS);
}

static void AssertPoint(const double *p, double x, double y, double z)
{
  assert_true(p[0] == x && p[1] == y && p[2] == z);
}

static void SmallestSceneHasDefaults(void **state)
{
  Scene scene;
  char  mesh[80];

  (void)state;
  ReadOrFail(Smallest, 0, NULL, &scene);
  snprintf(mesh, sizeof mesh, "%s/block.geo", Folder);
  assert_string_equal(scene->name, "small.case");
  assert_string_equal(scene->directory, Folder);
  assert_string_equal(scene->mesh_file, mesh);
  assert_int_equal(scene->order, 1);
  assert_int_equal(scene->geometry, GEOMETRY_SOLID);
  assert_int_equal(scene->kinematics, KINEMATICS_FINITE);
  assert_int_equal(scene->dim, 3);
  assert_int_equal(scene->n_bodies, 1);
  assert_int_equal(
    scene->n_supports + scene->n_loads + scene->n_contacts + scene->n_probes + scene->n_petsc + scene->n_parameters, 0);
  assert_int_equal(scene->stepping.control, STEP_ITERATIONS);
  assert_true(scene->stepping.initial == 0.1 && scene->stepping.dt_min == 1e-5 && scene->stepping.dt_max == 1 &&
              scene->stepping.growth == 4);
  assert_true(scene->solver.tolerance == 1e-8);
  assert_int_equal(scene->solver.max_iterations, 30);
  assert_true(scene->output.every == 1 && scene->output.displacement && scene->output.stress && scene->output.contact);
  Free(&scene);
}

static void BodiesArrive(void **state)
{
  Scene            scene;
  const SceneBody *die;

  (void)state;
  ReadOrFail(Everything, 0, NULL, &scene);
  assert_int_equal(scene->n_bodies, 3);
  assert_string_equal(scene->bodies[0].name, "block");
  assert_int_equal(scene->bodies[0].material.law, MATERIAL_LINEAR);
  assert_true(scene->bodies[0].material.nu == -0.25);
  assert_int_equal(scene->bodies[1].material.law, MATERIAL_NEO_HOOKEAN);
  assert_true(scene->bodies[1].material.E == 3e5);
  assert_false(scene->bodies[1].rigid);
  die = &scene->bodies[2];
  assert_true(die->rigid);
  assert_string_equal(die->name, "die");
  assert_string_equal(die->path, "bodies.2");
  AssertPoint(die->motion.point, 1, 2, 3);
  assert_int_equal(die->motion.n, 6);
  for (int k = 0; k < 6; k++) {
    assert_int_equal(die->motion.components[k].component, k);
    assert_true(die->motion.components[k].value == k + 1);
    assert_int_equal(die->motion.components[k].history.n, k < 3 ? 3 : 2);
  }
  assert_true(HistoryValue(&die->motion.components[0].history, 0.1) == 0.5);
  assert_true(HistoryValue(&die->motion.components[5].history, 0.25) == 0.25);
  Free(&scene);
}

static void SupportsAndLoadsArrive(void **state)
{
  Scene            scene;
  const SceneLoad *load;

  (void)state;
  ReadOrFail(Everything, 0, NULL, &scene);
  assert_int_equal(scene->n_supports, 1);
  assert_string_equal(scene->supports[0].surface, "bottom");
  assert_true(scene->supports[0].fixed[0] && !scene->supports[0].fixed[1] && scene->supports[0].fixed[2]);
  assert_int_equal(scene->n_loads, 6);
  load = scene->loads;
  assert_int_equal(load[0].kind, LOAD_DISPLACEMENT);
  assert_true(load[0].has[0] && load[0].has[1] && !load[0].has[2]);
  AssertPoint(load[0].value, 2, -50, 0);
  assert_true(HistoryValue(&load[0].history, 0.3) == 0.3);
  assert_int_equal(load[1].kind, LOAD_PRESSURE);
  assert_true(load[1].value[0] == 20 && load[1].follower);
  assert_true(HistoryValue(&load[1].history, 0.5) == 2);
  assert_false(load[2].follower);
  assert_int_equal(load[3].kind, LOAD_TRACTION);
  AssertPoint(load[3].value, 0, -1, 0.5);
  assert_int_equal(load[4].kind, LOAD_BODY_FORCE);
  assert_string_equal(load[4].region, "plate");
  AssertPoint(load[4].value, 0, -9.8e-3, 0);
  assert_true(!load[2].open && load[5].open && load[5].follower && !load[5].from.has_point && load[5].to.has_point);
  assert_string_equal(load[5].from.surface, "rim");
  AssertPoint(load[5].to.point, 1, 2, 3);
  Free(&scene);
}

static void ContactsArrive(void **state)
{
  Scene               scene;
  const SceneContact *contact;

  (void)state;
  ReadOrFail(Everything, 0, NULL, &scene);
  assert_int_equal(scene->n_contacts, 2);
  contact = &scene->contacts[0];
  assert_string_equal(contact->path, "contact.0");
  assert_string_equal(contact->name, "crown");
  assert_string_equal(contact->slave, "plate_bottom");
  assert_string_equal(contact->master, "die");
  assert_int_equal(contact->n_symmetry, 2);
  assert_string_equal(contact->symmetry[1], "symmetry_z");
  assert_true(contact->feature_angle == 30 && contact->stabilise == STABILISE_TRUE && !contact->penalty_auto &&
              contact->penalty == 1e5 && contact->penalty_scale == 10);
  assert_true(contact->adjust && !contact->adjust_converged && contact->window_in_spacings && contact->g_min == 1e-6 &&
              contact->g_max == 5e-6);
  assert_true(contact->clamp == 10 && contact->range == 100);
  contact = &scene->contacts[1];
  assert_true(!contact->adjust && contact->adjust_converged && contact->clamp == 100 && contact->range == 1e4);
  assert_int_equal(contact->smoother, SMOOTHER_DIFFUSE);
  assert_int_equal(contact->formulation, CONTACT_SURFACE_TO_SURFACE);
  assert_true(contact->n_symmetry == 0 && contact->feature_angle == 45 && contact->stabilise == STABILISE_AUTO &&
              contact->penalty_auto && contact->penalty_scale == 30 && contact->penalty_may_stiffen);
  Free(&scene);
}

static void ProbesOfEveryKindArrive(void **state)
{
  Scene             scene;
  const SceneProbe *probe;

  (void)state;
  ReadOrFail(Everything, 0, NULL, &scene);
  assert_int_equal(scene->n_probes, 20);
  probe = scene->probes;
  for (int i = 0; i <= PROBE_PRESSURE_DEVIATION; i++) assert_int_equal(probe[i].kind, i);
  for (int i = PROBE_REACTION_TORQUE; i < PROBE_FRICTION_FORCE; i++)
    assert_int_equal(probe[i + 1].kind, i);             /* p10 and p11 are one */
  for (int i = PROBE_FLUID_FRONT; i < PROBE_KINDS; i++) /* none is of friction */
    assert_int_equal(probe[PROBE_FRICTION_FORCE + 1 + i - PROBE_FLUID_FRONT].kind, i);
  assert_string_equal(probe[0].target, "top");
  assert_true(probe[0].component == 1 && probe[0].absolute && probe[0].factor == 1);
  assert_string_equal(probe[1].target, "crown");
  assert_true(probe[1].component == 0 && !probe[1].absolute && probe[1].factor == 2);
  AssertPoint(probe[2].point[0], 70, 4, 10);
  assert_true(probe[2].component == 2 && !probe[2].target);
  assert_string_equal(probe[2].body, "plate");
  AssertPoint(probe[3].point[0], 0, 1, 2);
  AssertPoint(probe[3].point[1], 3, 4, 5);
  assert_true(probe[3].change);
  AssertPoint(probe[4].point[0], 1, 2, 3);
  assert_false(probe[4].has_at);
  assert_true(probe[5].axis == 0 && probe[5].max_side && probe[5].has_at && probe[5].at_axis == 2 &&
              probe[5].at_value == 100);
  assert_true(probe[6].has_at && probe[6].at_axis == 1 && probe[6].at_value == 10);
  assert_false(probe[7].has_at);
  assert_true(probe[8].component == 2 && probe[9].component == 1);
  assert_string_equal(probe[10].target, "plate");
  assert_true(scene->bodies[1].bolt && scene->bodies[1].axis[1] == 1 && scene->bodies[1].locked == 0.5 &&
              MotionForce(&scene->bodies[1].motion, 0.5, 0) == 2.5 && SceneBreaks(scene, 0.5));
  assert_true(probe[13].rms && probe[13].edge_filter == 1 && probe[13].edge_faces == 2);
  assert_true(!probe[14].rms && probe[14].edge_filter == 2 && probe[14].edge_faces == 1.5);
  assert_true(probe[15].axis == 2);
  assert_true(probe[16].axis == 0);
  AssertPoint(probe[16].point[0], 1, 2, 3);
  assert_true(probe[17].axis == 1 && !probe[17].max_side);
  assert_string_equal(probe[19].target, "plate_bottom");
  Free(&scene);
}

static void TheRestArrives(void **state)
{
  Scene scene;

  (void)state;
  ReadOrFail(Everything, 0, NULL, &scene);
  assert_string_equal(scene->name, "everything");
  assert_string_equal(scene->mesh_file, "/meshes/two.msh");
  assert_int_equal(scene->order, 2);
  assert_int_equal(scene->n_parameters, 2);
  assert_string_equal(scene->parameters[0].key, "n");
  assert_string_equal(scene->parameters[1].value, "fine");
  assert_int_equal(scene->kinematics, KINEMATICS_SMALL);
  assert_int_equal(scene->stepping.control, STEP_CONTACT);
  assert_true(scene->stepping.N_c == 0 && scene->stepping.N_c_fraction == 0.05 && scene->stepping.predict_linearly);
  assert_true(scene->stepping.initial == 0.04 && scene->stepping.dt_min == 1e-4 && scene->stepping.dt_max == 0.5 &&
              scene->stepping.growth == 2);
  assert_true(scene->stepping.n_at == 2 && scene->stepping.at[1] == 0.5);
  assert_true(scene->solver.tolerance == 1e-9 && scene->solver.max_iterations == 12);
  assert_true(scene->output.every == 0 && !scene->output.displacement && scene->output.stress && scene->output.contact);
  assert_int_equal(scene->n_petsc, 3);
  assert_string_equal(scene->petsc[0].key, "snes_monitor");
  assert_string_equal(scene->petsc[0].value, "");
  assert_string_equal(scene->petsc[1].key, "pc_type");
  assert_string_equal(scene->petsc[2].value, "1e-9");
  Free(&scene);
}

static void TwoDimensionalScenesHaveTwoCoordinates(void **state)
{
  static const char Flat[] =
    "mesh: {file: a.msh}\ngeometry: axisymmetric\nbodies:\n"
    "  - {volume: cap, material: {law: svk, E: 5, nu: 0}}\n"
    "  - {surface: tool, rigid: {point: [1, 2], motion: [{uy: 1}]}}\n"
    "contact: [{name: c, slave: s, master: tool}]\n"
    "probes: [{name: edge, contact_edge: c, axis: x, side: max}, {name: d, distance: [[0, 1], [2, 3]]}]\n";
  Scene scene;

  (void)state;
  ReadOrFail(Flat, 0, NULL, &scene);
  assert_int_equal(scene->dim, 2);
  assert_int_equal(scene->geometry, GEOMETRY_AXISYMMETRIC);
  assert_int_equal(scene->order, 0);
  AssertPoint(scene->bodies[1].motion.point, 1, 2, 0);
  assert_false(scene->probes[0].has_at);
  AssertPoint(scene->probes[1].point[1], 2, 3, 0);
  Free(&scene);
}

static void SetReplacesAddsAndAppends(void **state)
{
  char *const set[] = {"bodies.0.material.E=7",
                       "name=first",
                       "name=edited",
                       "loads.0={surface: top, history: [[0, 0], [1, 2]], uy: -3}",
                       "loads.1.surface=top",
                       "loads.1.pressure=4",
                       "mesh.parameters.n=12",
                       "stepping.at=[0.5, 1]",
                       "kinematics=small",
                       "bodies.0.material.law=linear",
                       "contact=[]",
                       "output.fields.0=stress"};
  Scene       scene;

  (void)state;
  ReadOrFail(Smallest, sizeof set / sizeof set[0], set, &scene);
  assert_true(scene->bodies[0].material.E == 7 && scene->bodies[0].material.nu == 0.3);
  assert_string_equal(scene->name, "edited");
  assert_int_equal(scene->n_loads, 2);
  AssertPoint(scene->loads[0].value, 0, -3, 0);
  assert_true(HistoryValue(&scene->loads[0].history, 1) == 2);
  assert_true(scene->loads[1].value[0] == 4);
  assert_string_equal(scene->parameters[0].value, "12");
  assert_true(scene->stepping.n_at == 2 && scene->stepping.at[1] == 1);
  assert_int_equal(scene->bodies[0].material.law, MATERIAL_LINEAR);
  assert_true(scene->output.stress && !scene->output.displacement);
  assert_string_equal(SceneWhere(scene, "loads.1", "pressure"), "-set loads.1.pressure");
  assert_string_equal(SceneWhere(scene, "loads.0", "surface"), "-set loads.0: loads.0.surface");
  Free(&scene);
}

static void PlacesNameTheNearestLine(void **state)
{
  Scene scene;
  char  expect[120];

  (void)state;
  ReadOrFail(Everything, 0, NULL, &scene);
  snprintf(expect, sizeof expect, "%s:21: contact.0.slave", File);
  assert_string_equal(SceneWhere(scene, "contact.0", "slave"), expect);
  snprintf(expect, sizeof expect, "%s:36: contact.1.feature_angle", File);
  assert_string_equal(SceneWhere(scene, "contact.1", "feature_angle"), expect);
  snprintf(expect, sizeof expect, "%s:7: bodies.1", File);
  assert_string_equal(SceneWhere(scene, "bodies.1", ""), expect);
  snprintf(expect, sizeof expect, "%s:2: mesh.file", File);
  assert_string_equal(SceneWhere(scene, "mesh", "file"), expect);
  Free(&scene);
}

static void TextDependsOnValuesAlone(void **state)
{
  static const char Same[] = "# another layout\nbodies:\n- material:\n    nu: 0.3\n    law: svk\n    E: 200\n  volume: "
                             "block\nmesh:\n  file: block.geo\n";
  char *const change[] = {"bodies.0.material.E=201"}, *const back[] = {"bodies.0.material.E=201",
                                                                       "bodies.0.material.E=200"};
  Scene a, b;
  char *text;

  (void)state;
  ReadOrFail(Smallest, 0, NULL, &a);
  ReadOrFail(Same, 0, NULL, &b);
  assert_string_equal(a->text, b->text);
  Free(&b);
  ReadOrFail(Smallest, 1, change, &b);
  assert_string_not_equal(a->text, b->text);
  Free(&b);
  ReadOrFail(Smallest, 2, back, &b);
  assert_string_equal(a->text, b->text);
  Free(&b);
  Free(&a);
  ReadOrFail(Everything, 0, NULL, &a);
  assert_int_equal(PetscStrallocpy(a->text, &text), PETSC_SUCCESS);
  ReadOrFail(text, 0, NULL, &b);
  assert_string_equal(b->text, text);
  assert_int_equal(PetscFree(text), PETSC_SUCCESS);
  Free(&b);
  Free(&a);
}

/* The words of the table have the order of the enumerations into which they are read. */
static void LawsOfTheTableAreTheMaterials(void **state)
{
  char  text[128];
  Scene scene;

  (void)state;
  for (int law = 0; law < MATERIAL_LAWS; law++) {
    const ElasticLaw *elastic = MaterialGetLaw((MaterialLaw)law);
    char *const       edits[] = {"kinematics=small", text, "bodies.0.material.yield=100"};
    int               n       = snprintf(text, sizeof text, "bodies.0.material={law: %s, nu: 0.3", MaterialLaws[law]);

    if (law == MATERIAL_UMAT) continue; /* it needs a library */
    for (int k = 0; k < elastic->required; k++)
      n += snprintf(text + n, sizeof text - n, ", %s: %s", elastic->keys[k],
                    strcmp(elastic->keys[k], MATERIAL_TERMS) ? "2" : "[[2, 2]]");
    snprintf(text + n, sizeof text - n, "}");
    ReadOrFail(Smallest, elastic->plastic ? 3 : 2, edits, &scene);
    assert_int_equal(scene->bodies[0].material.law, law);
    assert_int_equal(scene->bodies[0].material.n_constants, elastic->constants);
    assert_true(scene->bodies[0].material.constants[1] == 2);
    assert_true(fabs(scene->bodies[0].material.nu - 0.3) < 1e-15);
    Free(&scene);
  }
}

/* nu, K, E and mu that say the same give the same material. */
static void ModuliMayBeGivenInSeveralWays(void **state)
{
  static char *const ways[] = {
    "bodies.0.material={law: neo_hookean, E: 2.6, nu: 0.3}",
    "bodies.0.material={law: neo_hookean, mu: 1, nu: 0.3}",
    "bodies.0.material={law: neo_hookean, mu: 1, K: 2.1666666666666667}",
    "bodies.0.material={law: neo_hookean, E: 2.6, K: 2.1666666666666667}",
    "bodies.0.material={law: isochoric_neo_hookean, E: 2.6, nu: 0.3}",
    "bodies.0.material={law: isochoric_neo_hookean, mu: 1, K: 2.1666666666666667}",
    "bodies.0.material={law: mooney_rivlin, c10: 0.3, c01: 0.2, nu: 0.3}",
    "bodies.0.material={law: yeoh, c10: 0.5, c30: 0.1, K: 2.1666666666666667}",
    "bodies.0.material={law: ogden, terms: [[1.5, 2], [0.25, -4]], nu: 0.3}",
  };
  Scene scene;

  (void)state;
  for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
    const Material *material;

    ReadOrFail(Smallest, 1, &ways[i], &scene);
    material = &scene->bodies[0].material;
    assert_true(fabs(material->E - 2.6) < 1e-14 && fabs(material->nu - 0.3) < 1e-15);
    assert_true(fabs(MaterialShear(material) - 1) < 1e-15);
    assert_true(fabs(material->constants[0] - (i < 4 ? 1.5 : 6.5 / 3)) < 1e-14);
    Free(&scene);
  }
}

static void ReferenceNamesKeysRangesAndDefaults(void **state)
{
  char  *text = NULL;
  size_t size = 0;
  FILE  *file = open_memstream(&text, &size);

  (void)state;
  assert_non_null(file);
  assert_int_equal(SceneReference(file), PETSC_SUCCESS);
  fclose(file);
  assert_non_null(strstr(text, "  bodies.N.material.nu: a number in (-1, 0.5] - Poisson's ratio"));
  assert_non_null(strstr(text, "  contact.N.formulation: node_to_surface | surface_to_surface | auto; default auto"));
  assert_non_null(strstr(text, "  probes.N.contact_edge: "));
  free(text);
}

static void CommandLineKeepsPetscOptions(void **state)
{
  char *argv[] = {"burnish", "-pc_type", "lu",     "-set",       "a=1", "-snes_monitor", "runs/a.yaml", "-o", "out/x",
                  "-set",    "b=-2",     "-quiet", "-snes_stol", "-1",  "-overwrite"};
  CommandLine line;

  (void)state;
  CommandLineParse(sizeof argv / sizeof argv[0], argv, &line);
  assert_string_equal(line.complaint, "");
  assert_int_equal(line.mode, COMMAND_RUN);
  assert_string_equal(line.scene, "runs/a.yaml");
  assert_string_equal(line.directory, "out/x");
  assert_int_equal(line.n_set, 2);
  assert_string_equal(line.set[1], "b=-2");
  assert_true(line.quiet && line.overwrite);
  assert_int_equal(line.argc, 6);
  assert_string_equal(line.argv[2], "lu");
  assert_string_equal(line.argv[3], "-snes_monitor");
  assert_string_equal(line.argv[5], "-1");
  assert_null(line.argv[6]);
  CommandLineDestroy(&line);
}

static void CommandLinePrefersAFreeStandingScene(void **state)
{
  char       *argv[] = {"burnish", "-options_file_yaml", "petsc.yaml", "-check", "scene"};
  CommandLine line;

  (void)state;
  CommandLineParse(5, argv, &line);
  assert_string_equal(line.complaint, "");
  assert_int_equal(line.mode, COMMAND_CHECK);
  assert_string_equal(line.scene, "scene");
  assert_int_equal(line.argc, 3);
  CommandLineDestroy(&line);
  CommandLineParse(1, argv, &line);
  assert_non_null(strstr(line.complaint, "no scene file [B120]\nusage: burnish"));
  CommandLineDestroy(&line);
}

static int MakeFolder(void **state)
{
  (void)state;
  if (!mkdtemp(Folder)) return 1;
  snprintf(File, sizeof File, "%s/small.case.yaml", Folder);
  return 0;
}

static int RemoveFolder(void **state)
{
  (void)state;
  return unlink(File) || rmdir(Folder);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(SmallestSceneHasDefaults),
    cmocka_unit_test(BodiesArrive),
    cmocka_unit_test(SupportsAndLoadsArrive),
    cmocka_unit_test(ContactsArrive),
    cmocka_unit_test(ProbesOfEveryKindArrive),
    cmocka_unit_test(TheRestArrives),
    cmocka_unit_test(TwoDimensionalScenesHaveTwoCoordinates),
    cmocka_unit_test(SetReplacesAddsAndAppends),
    cmocka_unit_test(PlacesNameTheNearestLine),
    cmocka_unit_test(TextDependsOnValuesAlone),
    cmocka_unit_test(LawsOfTheTableAreTheMaterials),
    cmocka_unit_test(ModuliMayBeGivenInSeveralWays),
    cmocka_unit_test(ReferenceNamesKeysRangesAndDefaults),
    cmocka_unit_test(CommandLineKeepsPetscOptions),
    cmocka_unit_test(CommandLinePrefersAFreeStandingScene),
  };
  int failed;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  failed = cmocka_run_group_tests(tests, MakeFolder, RemoveFolder);
  PetscCall(PetscFinalize());
  return failed;
}
