/* What -check says of laws of rubber, see lawreport.h. */
#include "lawreport.h"
#include "kernels/stability.h"

/* Warns of a test in which the law is unstable below or above a stretch. */
static void Warn(Scene scene, const SceneBody *body, MaterialTest test, int tension, double end)
{
  fprintf(
    stderr,
    "burnish: warning: %s: %s loses its stability (Drucker) in %s %s at the stretch %.3g: the stress falls there, "
    "and a run that comes so far can fail\n",
    SceneWhere(scene, body->path, "material"), MaterialLaws[body->material.law], MaterialTests[test],
    tension ? "tension" : "compression", end);
}

static void ReportBody(Scene scene, const SceneBody *body, FILE *file)
{
  fprintf(file, "law      %s: %s, E = %g, nu = %g in small strains; stable for stretches of", body->name,
          MaterialLaws[body->material.law], body->material.E, body->material.nu);
  for (int test = 0; test < MATERIAL_TESTS; test++)
    fprintf(file, "%s %.3g to %.3g (%s)", test ? "," : "", MaterialStableEnd(&body->material, (MaterialTest)test, 0),
            MaterialStableEnd(&body->material, (MaterialTest)test, 1), MaterialTests[test]);
  fprintf(file, "\n");
  for (int test = 0; test < MATERIAL_TESTS; test++) {
    for (int tension = 0; tension < 2; tension++) {
      const double end = MaterialStableEnd(&body->material, (MaterialTest)test, tension);

      if (end != (tension ? STABILITY_MOST_STRETCH : STABILITY_LEAST_STRETCH))
        Warn(scene, body, (MaterialTest)test, tension, end);
    }
  }
}

/*@
  LawReport - prints a line for each body whose law can lose its stability, and warns where it does.

  Not collective

  Input Parameters:
+ scene - the scene
- file  - of rank 0, which prints

  Note:
  svk is not checked, and neither are the neo-Hookean laws, which are stable at every stretch. Small strains take
  Hooke's law.
@*/
void LawReport(Scene scene, FILE *file)
{
  for (int b = 0; b < scene->n_bodies && scene->kinematics == KINEMATICS_FINITE; b++) {
    const SceneBody *body = &scene->bodies[b];

    if (!body->rigid && !MaterialHasModuli(body->material.law)) ReportBody(scene, body, file);
  }
}
