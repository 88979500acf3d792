/* The law of Arruda and Boyce with eight chains, as the series of five terms in I = J^(-2/3) I1:
   w = mu sum_k c_k / lambda_m^(2 k - 2) (I^k - 3^k). Constants: K, mu, lambda_m. lambda_m is the stretch at which the
   chains lock. The series has no pole there: it stiffens strongly and stays finite. The initial shear modulus is
   mu (1 + 3/5 lambda_m^-2 + 99/175 lambda_m^-4 + 513/875 lambda_m^-6 + 42039/67375 lambda_m^-8). Source: Arruda and
   Boyce, "A three-dimensional constitutive model for the large stretch behavior of rubber elastic materials", Journal
   of the Mechanics and Physics of Solids 41, 1993, equations 21 and 22. */
#include "isochoriclaw.h"

enum { TERMS = 5 };
static const double coefficients[TERMS] = {1. / 2, 1. / 20, 11. / 1050, 19. / 7000, 519. / 673750};

/* With I = 3 + x, I^k - 3^k = x (I^(k - 1) + 3 I^(k - 2) + ... + 3^(k - 1)), which keeps the digits of small strains.
 */
static void Evaluate(const Lanes H[9], const Lanes *dilatation, int n, const Lanes constants[], Lanes *W, Lanes P[9],
                     Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes     K = constants[0], per_lambda2 = 1 / (constants[2] * constants[2]);
  IsochoricEnergy w = {.w2 = {0}};
  Lanes           I, factor = constants[1], power = {0}, before = {0}, sum = {0}; /* I^(k - 1), I^(k - 2), their sum */
  double          power_of_3 = 1;                                                 /* 3^(k - 1) */
  Isochoric       x;

  (void)n;
  IsochoricStart(H, dilatation, 0, &x);
  I = 3 + x.x1;
  power += 1;
  for (int k = 1; k <= TERMS; k++) {
    const Lanes c = factor * coefficients[k - 1];

    sum = sum * I + power_of_3;
    w.w += c * sum * x.x1;
    w.w1 += c * (double)k * power;
    w.w11 += c * (double)(k * (k - 1)) * before;
    before = power;
    power *= I;
    power_of_3 *= 3;
    factor *= per_lambda2;
  }
  IsochoricFinish(&x, 0, &w, &K, W, P, A);
}

static void Shear(int n, const Lanes constants[], Lanes *mu)
{
  const Lanes t = 1 / (constants[2] * constants[2]);

  (void)n;
  *mu = constants[1] * (1 + t * (3. / 5 + t * (99. / 175 + t * (513. / 875 + t * (42039. / 67375)))));
}

const ElasticLaw MaterialLaw_ArrudaBoyce = {.evaluate  = Evaluate,
                                            .shear     = Shear,
                                            .constants = 3,
                                            .separable = 1,
                                            .isochoric = 1,
                                            .keys      = {"mu", "lambda_m"},
                                            .required  = 2};
