/* Reads the accuracy that a scene asks for, see sceneaccuracy.h. */
#include "sceneaccuracy.h"
#include "sceneread.h"
#include <string.h>

const char *const DensityKinds[] = {[DENSITY_COUNT] = "count", [DENSITY_SIZE] = "size", [DENSITY_DIVISOR] = "divisor"};

/* Finds the probe. */
static PetscErrorCode FindProbe(Scene scene)
{
  const char *name = SchemaText(SceneDocument(scene), "accuracy.probe");

  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_probes; i++)
    if (!strcmp(scene->probes[i].name, name)) scene->accuracy.probe = i;
  if (scene->accuracy.probe < 0)
    PetscCall(SceneRefuse(scene, "accuracy", "probe", "is no probe; allowed: the name of one under probes:", name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the parameters that refine the mesh. */
static PetscErrorCode ReadDensities(Scene scene)
{
  SceneAccuracy *accuracy = &scene->accuracy;

  PetscFunctionBeginUser;
  PetscCall(SceneReadPairs(scene, "accuracy.densities", &accuracy->n_densities, &accuracy->densities));
  for (int i = 0; i < accuracy->n_densities; i++) {
    const ScenePair *pair = &accuracy->densities[i];
    int              kind = 0;

    while (kind < DENSITY_KINDS && strcmp(pair->value, DensityKinds[kind])) kind++;
    if (kind == DENSITY_KINDS)
      PetscCall(SceneRefuse(scene, "accuracy.densities", pair->key, "is no density; allowed: count | size | divisor",
                            pair->value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Penalties that are no quantities of the model may be made stiffer by the run: their share of the error is part of
   what is asked for. A scale that the scene gives is the one with which the run begins. */
static void ReleasePenalties(Scene scene)
{
  for (int i = 0; i < scene->n_contacts; i++) {
    SceneContact *contact = &scene->contacts[i];

    if (!contact->penalty_auto || contact->adjust || contact->augment || contact->presence.n) continue;
    contact->penalty_may_stiffen = 1;
    contact->stick_may_stiffen   = contact->friction && !(contact->stick_penalty > 0) && !(contact->stick_slip > 0);
  }
}

/* Tells whether the answer is the same whatever the way to it: bodies of small strains that neither yield nor rub have
   one equilibrium under a load, as their energy is convex. */
static PetscBool AnyWay(Scene scene)
{
  if (scene->kinematics != KINEMATICS_SMALL || SceneDependsOnPath(scene) || SceneHasFluid(scene)) return PETSC_FALSE;
  for (int i = 0; i < scene->n_contacts; i++)
    if (scene->contacts[i].adjust) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Where the way to the answer does not count, each mesh goes there in the longest steps that succeed, unless the scene
   says how long they are to be. */
static void LengthenSteps(Scene scene)
{
  if (scene->stepping.control != STEP_ITERATIONS || SceneHas(scene, "stepping", "initial") || !AnyWay(scene)) return;
  scene->stepping.initial = scene->stepping.dt_max;
}

/*@
  SceneReadAccuracy - reads the accuracy that is asked for.

  Collective

  Input Parameter:
. scene - the scene, whose probes and output have been read

  Note:
  It refuses the first mistake.
@*/
PetscErrorCode SceneReadAccuracy(Scene scene)
{
  Document *document = SceneDocument(scene);

  PetscFunctionBeginUser;
  scene->accuracy.probe = -1;
  if (!SchemaHas(document, "accuracy")) PetscFunctionReturn(PETSC_SUCCESS);
  if (strcmp(scene->mesh_file + PetscMax(strlen(scene->mesh_file), 4) - 4, ".geo"))
    PetscCall(SceneRefuse(scene, "mesh", "file", "cannot be meshed anew; allowed with accuracy: a .geo file",
                          scene->mesh_file));
  PetscCall(FindProbe(scene));
  PetscCall(ReadDensities(scene));
  scene->accuracy.to     = SchemaReal(document, "accuracy.to") / 100;
  scene->accuracy.meshes = SchemaInteger(document, "accuracy.meshes");
  if (SchemaHas(document, "accuracy.limit.time")) scene->accuracy.cpu_s = SchemaReal(document, "accuracy.limit.time");
  if (SchemaHas(document, "accuracy.limit.memory"))
    scene->accuracy.rss_mb = SchemaReal(document, "accuracy.limit.memory");
  scene->order_chosen = !SceneHas(scene, "mesh", "order");
  for (int b = 0; b < scene->n_bodies; b++)
    scene->order_chosen = scene->order_chosen && (scene->bodies[b].rigid || scene->bodies[b].chosen);
  scene->output.error = PetscMax(scene->output.error, SCENE_ERROR_YES);
  ReleasePenalties(scene);
  LengthenSteps(scene);
  PetscFunctionReturn(PETSC_SUCCESS);
}
