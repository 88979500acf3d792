/* What -check says of laws of rubber, see lawreport.h. */
#include "lawreport.h"
#include "kernels/stability.h"

/* Warns of a law that is not stable all over the range that is checked: all tests in one line. */
static void Warn(Scene scene, const SceneBody *body, double end[MATERIAL_TESTS][2])
{
  const double most[2] = {STABILITY_LEAST_STRETCH, STABILITY_MOST_STRETCH};
  int          n       = 0;

  for (int test = 0; test < MATERIAL_TESTS; test++) {
    for (int tension = 0; tension < 2; tension++) {
      if (end[test][tension] == most[tension]) continue;
      if (!n++)
        fprintf(stderr,
                "burnish: warning: %s: %s loses its stability (Drucker):", SceneWhere(scene, body->path, "material"),
                MaterialLaws[body->material.law]);
      fprintf(stderr, "%s in %s %s at the stretch %.3g", n > 1 ? "," : "", MaterialTests[test],
              tension ? "tension" : "compression", end[test][tension]);
    }
  }
  if (n) fprintf(stderr, "; beyond, stresses can fall as strains grow, and a run can fail [B501]\n");
}

static void ReportBody(Scene scene, const SceneBody *body, FILE *file)
{
  double end[MATERIAL_TESTS][2];

  fprintf(file, "law      %s: %s, E = %g, nu = %g in small strains; stable for stretches of", body->name,
          MaterialLaws[body->material.law], body->material.E, body->material.nu);
  for (int test = 0; test < MATERIAL_TESTS; test++) {
    for (int tension = 0; tension < 2; tension++)
      end[test][tension] = MaterialStableEnd(&body->material, (MaterialTest)test, tension);
    fprintf(file, "%s %.3g to %.3g (%s)", test ? "," : "", end[test][0], end[test][1], MaterialTests[test]);
  }
  fprintf(file, "\n");
  Warn(scene, body, end);
}

/*@
  LawReport - prints a line for each body whose law can lose its stability, and warns where it does.

  Not collective

  Input Parameters:
+ scene - the scene
- file  - of rank 0, which prints

  Note:
  svk and hyperfoam are not checked, and neither are the neo-Hookean laws, which are stable at every stretch. Small
  strains take Hooke's law.
@*/
void LawReport(Scene scene, FILE *file)
{
  for (int b = 0; b < scene->n_bodies && scene->kinematics == KINEMATICS_FINITE; b++) {
    const SceneBody *body = &scene->bodies[b];

    if (!body->rigid && MaterialGetLaw(body->material.law)->separable && !MaterialHasModuli(body->material.law))
      ReportBody(scene, body, file);
  }
}
