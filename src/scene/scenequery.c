/* What others ask of a scene that has been read, see scene.h. */
#include "scene/scene.h"
#include <string.h>

/* An edge whose faces differ by feature_angle but for this part of it is sharp: chamfers have 45 degrees, the default,
   and round-off must not decide whether a fit goes on past them. */
#define SCENE_SHARP_FROM (1 - 1e-4)

/*@
  SceneIsPlastic - tells whether some body has a plastic law.

  Not collective

  Input Parameter:
. scene - the scene
@*/
PetscBool SceneIsPlastic(Scene scene)
{
  for (int b = 0; b < scene->n_bodies; b++)
    if (!scene->bodies[b].rigid && MaterialGetLaw(scene->bodies[b].material.law)->plastic) return PETSC_TRUE;
  return PETSC_FALSE;
}

/*@
  SceneHasRoutine - tells whether the law of some body is a routine of the user, which has no potential.

  Not collective, the same on all ranks

  Input Parameter:
. scene - the scene
@*/
PetscBool SceneHasRoutine(Scene scene)
{
  for (int b = 0; b < scene->n_bodies; b++)
    if (scene->bodies[b].material.umat) return PETSC_TRUE;
  return PETSC_FALSE;
}

/*@
  SceneHasFluid - tells whether some load is the pressure of a fluid that enters between surfaces.

  Not collective, the same on all ranks

  Input Parameter:
. scene - the scene
@*/
PetscBool SceneHasFluid(Scene scene)
{
  for (int l = 0; l < scene->n_loads; l++)
    if (scene->loads[l].open) return PETSC_TRUE;
  return PETSC_FALSE;
}

/*@
  SceneHasFriction - tells whether some pair has friction.

  Not collective, the same on all ranks

  Input Parameter:
. scene - the scene
@*/
PetscBool SceneHasFriction(Scene scene)
{
  for (int c = 0; c < scene->n_contacts; c++)
    if (scene->contacts[c].friction) return PETSC_TRUE;
  return PETSC_FALSE;
}

/*@
  SceneDependsOnPath - tells whether the answer depends on the way to it, or on what stays from one solve to the next.

  Not collective, the same on all ranks

  Input Parameter:
. scene - the scene
@*/
PetscBool SceneDependsOnPath(Scene scene)
{
  PetscBool depends = (PetscBool)(SceneIsPlastic(scene) || SceneHasRoutine(scene) || SceneHasFriction(scene) ||
                                  SceneSupportsChange(scene));

  for (int c = 0; c < scene->n_contacts; c++) depends = (PetscBool)(depends || scene->contacts[c].augment);
  for (int b = 0; b < scene->n_bodies; b++) /* a locked length comes from an earlier force */
    depends = (PetscBool)(depends || (scene->bodies[b].bolt && scene->bodies[b].locked < 1));
  return depends;
}

/*@
  SceneContactHasMaster - tells whether a surface is the master of a pair.

  Not collective, the same on all ranks

  Input Parameters:
+ contact - the pair
- surface - name of a surface or of a rigid tool
@*/
PetscBool SceneContactHasMaster(const SceneContact *contact, const char *surface)
{
  return contact->master && !strcmp(contact->master, surface) ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool MotionBreaks(const Motion *motion, PetscReal t)
{
  for (int m = 0; m < motion->n; m++)
    if (HistoryBreaks(&motion->components[m].history, t)) return PETSC_TRUE;
  return HistoryBreaks(&motion->history, t) ? PETSC_TRUE : PETSC_FALSE;
}

/* Tells whether a support that holds in some steps comes or leaves at t, or whether its last forces have faded there.
 */
static PetscBool SpanBreaks(Scene scene, const SceneSpan *span, PetscReal t)
{
  const SceneStep *step = scene->stepping.steps;

  if (!span->some) return PETSC_FALSE;
  if (t == step[span->first].begin || t == step[span->first].until || t == step[span->last].until) return PETSC_TRUE;
  return (PetscBool)(span->last + 1 < scene->stepping.n_steps && t == step[span->last + 1].until);
}

/*@
  SceneBreaks - tells whether some load, imposed displacement or motion has a breakpoint at load parameter t.

  Not collective

  Input Parameters:
+ scene - the scene
- t     - load parameter

  Note:
  At a breakpoint the rate of the load may change. The solution before it therefore predicts nothing about the solution
  after it.
@*/
PetscBool SceneBreaks(Scene scene, PetscReal t)
{
  for (int l = 0; l < scene->n_loads; l++)
    if (HistoryBreaks(&scene->loads[l].history, t)) return PETSC_TRUE;
  for (int s = 0; s < scene->n_supports; s++)
    if (HistoryBreaks(&scene->supports[s].history, t) || SpanBreaks(scene, &scene->supports[s].during, t))
      return PETSC_TRUE;
  for (int b = 0; b < scene->n_bodies; b++)
    if (MotionBreaks(&scene->bodies[b].motion, t) || (scene->bodies[b].bolt && scene->bodies[b].locked == t))
      return PETSC_TRUE;
  for (int c = 0; c < scene->n_contacts; c++)
    if (MotionBreaks(&scene->contacts[c].motion, t) || HistoryBreaks(&scene->contacts[c].presence, t))
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/*@
  SceneLoadVaries - tells whether a component of a load is an expression with t, to which no history applies.

  Not collective

  Input Parameters:
+ load      - the load
- component - 0 to 2; 0 for a pressure
@*/
PetscBool SceneLoadVaries(const SceneLoad *load, int component)
{
  return ExpressionUses(load->expression[component], EXPRESSION_T);
}

/*@
  SceneLoadValue - returns a component of a load at a place, without the factor of its history.

  Not collective

  Input Parameters:
+ load      - the load
. component - 0 to 2; 0 for a pressure
. X         - reference coordinates of the place (length); the third is 0 in the plane
- t         - load parameter

  Note:
  Where SceneLoadVaries(), this is the whole value at t. Otherwise it does not depend on t. It is not finite where an
  expression has no value.
@*/
PetscReal SceneLoadValue(const SceneLoad *load, int component, const PetscReal X[3], PetscReal t)
{
  return load->expression[component] ? ExpressionValue(load->expression[component], X, t) : load->value[component];
}

/*@
  SceneSupportsChange - tells whether some support holds in some steps only.

  Not collective

  Input Parameter:
. scene - the scene
@*/
PetscBool SceneSupportsChange(Scene scene)
{
  for (int s = 0; s < scene->n_supports; s++)
    if (scene->supports[s].during.some) return PETSC_TRUE;
  return PETSC_FALSE;
}

/*@
  SceneHolds - tells whether a support holds in a step.

  Not collective

  Input Parameters:
+ span - the steps of the support
- step - number of the step
@*/
PetscBool SceneHolds(const SceneSpan *span, PetscInt step)
{
  return (PetscBool)(!span->some || (span->first <= step && step <= span->last));
}

/*@
  SceneStepLeft - returns the part of a step that is still to come: from 1 where it begins to 0 where it ends.

  Not collective

  Input Parameters:
+ step - the step
- t    - load parameter
@*/
PetscReal SceneStepLeft(const SceneStep *step, PetscReal t)
{
  return PetscMax(0, PetscMin(1, (step->until - t) / (step->until - step->begin)));
}

/*@
  SceneSharpAngle - returns the angle from which on the faces of a pair meet at a sharp edge.

  Not collective

  Input Parameter:
. contact - the pair

  Note:
  In radians. Fits end at sharp edges.
@*/
PetscReal SceneSharpAngle(const SceneContact *contact)
{
  return SCENE_SHARP_FROM * contact->feature_angle * PETSC_PI / 180;
}
