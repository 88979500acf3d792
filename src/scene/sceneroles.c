/* Swapped roles, see sceneroles.h. */
#include "scene/sceneroles.h"
#include <string.h>

/*@
  SceneMaySwapRoles - says whether the roles of a pair may be taken the other way round.

  Not collective

  Input Parameters:
+ scene - the scene
- pair  - one of its pairs

  Note:
  They stay where the scene says so, where the master is no surface of a body, and where something else names a place on
  the slave: a probe of its gap or of some of its nodes, a single reference plane, a fluid between the surfaces.
@*/
PetscBool SceneMaySwapRoles(Scene scene, const SceneContact *pair)
{
  if (pair->listed || pair->keep_roles || !pair->master || pair->global_frame || SceneHasFluid(scene))
    return PETSC_FALSE;
  for (int b = 0; b < scene->n_bodies; b++)
    if (scene->bodies[b].rigid && !strcmp(scene->bodies[b].name, pair->master)) return PETSC_FALSE;
  for (int p = 0; p < scene->n_probes; p++) {
    const SceneProbe *probe = &scene->probes[p];

    if ((probe->kind == PROBE_GAP || probe->has_at) && !strcmp(probe->target, pair->name)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/*@
  SceneSwapRoles - takes the roles of a pair the other way round.

  Not collective

  Input Parameters:
+ scene - the scene
- pair  - one of its pairs

  Note:
  Probes of its forces and torques stay those on the master that the scene names.
@*/
void SceneSwapRoles(Scene scene, SceneContact *pair)
{
  char *slave = pair->slave;

  pair->slave  = pair->master;
  pair->master = slave;
  for (int p = 0; p < scene->n_probes; p++) {
    SceneProbe *probe = &scene->probes[p];

    if (probe->kind != PROBE_CONTACT_FORCE && probe->kind != PROBE_CONTACT_TORQUE &&
        probe->kind != PROBE_FRICTION_FORCE && probe->kind != PROBE_FRICTION_TORQUE)
      continue;
    if (!strcmp(probe->target, pair->name) && !probe->absolute) probe->factor *= -1;
  }
}
