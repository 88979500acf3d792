/* Damage that grows with the strain, for umat.py. PROPS: E, nu, rate, largest damage, slope of E along y, largest
   growth of kappa in an increment. The stress is (1 - d) times Hooke's, with d = PROPS(4) (1 - exp(-rate CELENT
   kappa)), where kappa is the largest norm of the strain so far. DDSDDE is not symmetric. STATEV: kappa, and the energy
   that the strain would store without damage. As many routines do, it sets its states up where KSTEP and KINC are 1. */
#include <math.h>

void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, double *stran, double *dstran, double *time, double *dtime,
           double *temp, double *dtemp, double *predef, double *dpred, char *cmname, int *ndi, int *nshr, int *ntens,
           int *nstatv, double *props, int *nprops, double *coords, double *drot, double *pnewdt, double *celent,
           double *dfgrd0, double *dfgrd1, int *noel, int *npt, int *layer, int *kspt, int *jstep, int *kinc)
{
  const int    n = *ntens;
  const double E = props[0] * (1 + props[4] * coords[1]), nu = props[1], rate = props[2] * *celent;
  const double mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  double       strain[6], elastic[6], trace = 0, norm = 0, energy = 0, kappa, damage, slope;

  if (jstep[0] == 1 && *kinc == 1) statev[0] = statev[1] = 0;
  for (int c = 0; c < n; c++) {
    strain[c] = stran[c] + dstran[c];
    if (c < 3) trace += strain[c];
    norm += strain[c] * strain[c] * (c < 3 ? 1 : 0.5);
  }
  norm   = sqrt(norm);
  kappa  = norm > statev[0] ? norm : statev[0];
  damage = props[3] * (1 - exp(-rate * kappa));
  slope  = norm > statev[0] ? props[3] * rate * exp(-rate * kappa) : 0;
  if (kappa - statev[0] > props[5]) *pnewdt = 0.5;
  for (int c = 0; c < n; c++) {
    elastic[c] = c < 3 ? lambda * trace + 2 * mu * strain[c] : mu * strain[c];
    stress[c]  = (1 - damage) * elastic[c];
    energy += elastic[c] * strain[c] / 2;
  }
  for (int c = 0; c < n; c++) {
    for (int d = 0; d < n; d++) {
      ddsdde[c + n * d] = (1 - damage) * ((c < 3 && d < 3 ? lambda : 0) + (c == d ? (c < 3 ? 2 * mu : mu) : 0));
      if (slope > 0) ddsdde[c + n * d] -= slope * elastic[c] * strain[d] * (d < 3 ? 1 : 0.5) / norm;
    }
  }
  *sse = (1 - damage) * energy;
  *spd += (damage - props[3] * (1 - exp(-rate * statev[0]))) * (energy + statev[1]) / 2;
  statev[0] = kappa;
  statev[1] = energy;
}
