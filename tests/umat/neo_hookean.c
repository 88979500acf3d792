/* The neo-Hookean law of `law: neo_hookean` from DFGRD1, for umat.py. PROPS: mu, lambda. The component of DDSDDE for
   Jaumann's rate over J. PROPS(3) = 1 lets it crash and 2 give no number where the first stretch is above 1.05. With
   PROPS(4) the stress is weakened by exp(-PROPS(4) (tr b - 3)), which makes DDSDDE unsymmetric. */
#include <math.h>
#include <string.h>

void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, double *stran, double *dstran, double *time, double *dtime,
           double *temp, double *dtemp, double *predef, double *dpred, char *cmname, int *ndi, int *nshr, int *ntens,
           int *nstatv, double *props, int *nprops, double *coords, double *drot, double *pnewdt, double *celent,
           double *dfgrd0, double *dfgrd1, int *noel, int *npt, int *layer, int *kspt, int *jstep, int *kinc)
{
  static const int at[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  const double    *F = dfgrd1, mu = props[0], lambda = props[1];
  const double     rate = *nprops > 3 ? props[3] : 0;
  double           b[3][3], J, left;

  if (*nprops > 2 && props[2] == 1 && F[0] > 1.05) *(volatile int *)4 = 1;
  J = F[0] * (F[4] * F[8] - F[7] * F[5]) - F[3] * (F[1] * F[8] - F[7] * F[2]) + F[6] * (F[1] * F[5] - F[4] * F[2]);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) b[i][j] = F[i] * F[j] + F[3 + i] * F[3 + j] + F[6 + i] * F[6 + j];
  left = exp(-rate * (b[0][0] + b[1][1] + b[2][2] - 3));
  for (int c = 0; c < *ntens; c++) {
    const int i = at[c][0], j = at[c][1];

    stress[c] = left * (mu * (b[i][j] - (i == j)) + lambda * log(J) * (i == j)) / J;
    if (*nprops > 2 && props[2] == 2 && F[0] > 1.05) stress[c] = NAN;
    for (int d = 0; d < *ntens; d++) {
      const int k = at[d][0], l = at[d][1];

      ddsdde[c + *ntens * d] =
        left *
          (lambda * (i == j) * (k == l) +
           mu / 2 * ((i == k) * b[j][l] + (j == l) * b[i][k] + (i == l) * b[j][k] + (j == k) * b[i][l])) /
          J -
        2 * rate * stress[c] * b[k][l];
    }
  }
  *sse = mu / 2 * (b[0][0] + b[1][1] + b[2][2] - 3) - mu * log(J) + lambda / 2 * log(J) * log(J);
}
