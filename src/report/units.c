/* Units of what a run writes, see units.h. */
#include "units.h"
#include <stdio.h>

/*@
  UnitsNamed - tells whether the scene names its units.

  Not collective

  Input Parameter:
. scene - the scene
@*/
PetscBool UnitsNamed(Scene scene)
{
  return (PetscBool)(scene->units.length && scene->units.force);
}

/*@
  UnitsLength - returns the unit of lengths.

  Not collective

  Input Parameter:
. scene - the scene
@*/
const char *UnitsLength(Scene scene)
{
  return scene->units.length ? scene->units.length : "length";
}

/*@
  UnitsForce - returns the unit of forces.

  Not collective

  Input Parameter:
. scene - the scene
@*/
const char *UnitsForce(Scene scene)
{
  return scene->units.force ? scene->units.force : "force";
}

/* What forces are divided by in the plane without a thickness. */
static const char *PerThickness(Scene scene, char text[UNITS_TEXT])
{
  snprintf(text, UNITS_TEXT, "%s%.60s", scene->per_thickness ? "/" : "",
           scene->per_thickness ? UnitsLength(scene) : "");
  return text;
}

/*@
  UnitsStress - gives the unit of stresses.

  Not collective

  Input Parameter:
. scene - the scene

  Output Parameter:
. text - the unit
@*/
void UnitsStress(Scene scene, char text[UNITS_TEXT])
{
  if (scene->units.stress || !UnitsNamed(scene))
    snprintf(text, UNITS_TEXT, "%.60s", scene->units.stress ? scene->units.stress : "stress");
  else
    snprintf(text, UNITS_TEXT, "%.60s/%.60s^2", UnitsForce(scene), UnitsLength(scene));
}

/*@
  UnitsProbe - gives the unit of a probe, without its factor.

  Not collective

  Input Parameters:
+ scene - the scene
- probe - of the scene

  Output Parameter:
. text - the unit; empty of parts
@*/
void UnitsProbe(Scene scene, const SceneProbe *probe, char text[UNITS_TEXT])
{
  char per[UNITS_TEXT];

  PerThickness(scene, per);
  switch (probe->kind) {
  case PROBE_REACTION:
  case PROBE_BOLT_FORCE:
  case PROBE_CONTACT_FORCE:
  case PROBE_FRICTION_FORCE: snprintf(text, UNITS_TEXT, "%.60s%.70s", UnitsForce(scene), per); break;
  case PROBE_REACTION_TORQUE:
  case PROBE_CONTACT_TORQUE:
  case PROBE_FRICTION_TORQUE:
    snprintf(text, UNITS_TEXT, "%.60s %.60s%.70s", UnitsForce(scene), UnitsLength(scene), per);
    break;
  case PROBE_CONTACT_AREA:
  case PROBE_SLIPPED_AREA: snprintf(text, UNITS_TEXT, "%.60s%s", UnitsLength(scene), *per ? "" : "^2"); break;
  case PROBE_PRESSURE_MAX:
  case PROBE_PRESSURE_MEAN:
  case PROBE_SEAL_PRESSURE: UnitsStress(scene, text); break;
  case PROBE_PRESSURE_DEVIATION: snprintf(text, UNITS_TEXT, "per cent"); break;
  case PROBE_TOOL_ROTATION: snprintf(text, UNITS_TEXT, "degrees"); break;
  case PROBE_FLUID_AREA: *text = 0; break;
  default: snprintf(text, UNITS_TEXT, "%.60s", UnitsLength(scene));
  }
}

/*@
  UnitsForces - says what the forces, areas and energies of the results are meant of.

  Not collective

  Input Parameter:
. scene - the scene

  Output Parameter:
. text - such as "per mm of thickness"
@*/
void UnitsForces(Scene scene, char text[UNITS_TEXT])
{
  if (scene->geometry == GEOMETRY_AXISYMMETRIC)
    snprintf(text, UNITS_TEXT, "over 360 degrees");
  else if (scene->geometry == GEOMETRY_SOLID)
    snprintf(text, UNITS_TEXT, "of the model");
  else if (scene->per_thickness)
    snprintf(text, UNITS_TEXT, "per %.60s of thickness", UnitsLength(scene));
  else
    snprintf(text, UNITS_TEXT, "on a thickness of %g%s%.60s", scene->thickness, scene->units.length ? " " : "",
             scene->units.length ? scene->units.length : "");
}
