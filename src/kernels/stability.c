/* Drucker's stability of elastic laws, see stability.h. */
#include "kernels/stability.h"
#include <math.h>
#include <stddef.h>

/* Stretches that are checked on each side, equally spaced in their logarithm, and relative error of the end that is
   found */
enum { SAMPLES = 400 };
static const double end_error = 1e-6;

const char *const MaterialTests[MATERIAL_TESTS] = {"uniaxial", "equibiaxial", "planar"};

/* Product d1^T T d2 */
static double Form(double T[3][3], const double d1[3], const double d2[3])
{
  double sum = 0;

  for (int a = 0; a < 3; a++) {
    for (int b = 0; b < 3; b++) sum += d1[a] * T[a][b] * d2[b];
  }
  return sum;
}

/*@
  MaterialIsStable - says whether Kirchhoff's stress grows with every small strain that keeps the volume.

  Not collective

  Input Parameters:
+ material - of a separable law
- stretch  - principal stretches, the product of which is 1

  Note:
  In logarithmic strains e_a the principal stresses grow by T_ab de_b, and T must be positive for all de with de_1 +
  de_2 + de_3 = 0. Shear across the principal directions a and b grows with A_abab, which must be positive.
@*/
int MaterialIsStable(const Material *material, const double stretch[3])
{
  static const double first[3] = {1, -1, 0}, second[3] = {1, 1, -2};
  double constants[MATERIAL_MAX_CONSTANTS], H[9]       = {0}, P[9], A[MATERIAL_TANGENT_SIZE], T[3][3], one, two, both;

  for (int k = 0; k < material->n_constants; k++) constants[k] = k ? material->constants[k] : 0;
  for (int a = 0; a < 3; a++) H[4 * a] = stretch[a] - 1;
  MaterialEvaluate(material->law, material->n_constants, constants, H, NULL, P, A);
  for (int a = 0; a < 3; a++) {
    for (int b = a; b < 3; b++) {
      T[a][b] = T[b][a] = stretch[a] * stretch[b] * A[MATERIAL_TANGENT_INDEX(4 * a, 4 * b)];
      if (a == b) T[a][a] += stretch[a] * P[4 * a];
      if (a != b && !(A[MATERIAL_TANGENT_INDEX(3 * a + b, 3 * a + b)] > 0)) return 0;
    }
  }
  one  = Form(T, first, first);
  two  = Form(T, second, second);
  both = Form(T, first, second);
  return one > 0 && one * two > both * both;
}

static int IsStableInTest(const Material *material, MaterialTest test, double l)
{
  const double stretches[MATERIAL_TESTS][3] = {[TEST_UNIAXIAL]    = {l, 1 / sqrt(l), 1 / sqrt(l)},
                                               [TEST_EQUIBIAXIAL] = {l, l, 1 / (l * l)},
                                               [TEST_PLANAR]      = {l, 1, 1 / l}};

  return MaterialIsStable(material, stretches[test]);
}

/*@
  MaterialStableEnd - finds the stretch at which a material loses its stability in a test.

  Not collective

  Input Parameters:
+ material - of a separable law
. test     - the test
- tension  - 1 for stretches above 1, 0 for those below

  Note:
  It returns the end of the range that is checked if the material is stable all over it.
@*/
double MaterialStableEnd(const Material *material, MaterialTest test, int tension)
{
  const double most = tension ? STABILITY_MOST_STRETCH : STABILITY_LEAST_STRETCH, end = log(most);
  double       holds = 0, fails = 0; /* logarithms of stretches */
  int          sample = 1;

  for (; sample <= SAMPLES; sample++) {
    fails = end * sample / SAMPLES;
    if (!IsStableInTest(material, test, exp(fails))) break;
    holds = fails;
  }
  if (sample > SAMPLES) return most;
  while (fabs(fails - holds) > end_error) {
    const double middle = (holds + fails) / 2;

    if (IsStableInTest(material, test, exp(middle)))
      holds = middle;
    else
      fails = middle;
  }
  return exp(holds);
}
