/* The least-squares plane from the eigenvectors of a 3 x 3 covariance, and the metric of the fit's support. */
#include "smooth/fitframe.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* Most sweeps of Jacobi's method. A cyclic one for a 3 x 3 matrix ends within 6, so this bound is never reached. */
enum { SWEEPS = 16 };

/* Rotates rows and columns p and q so that a[p][q] vanishes. */
static void JacobiRotate(double a[3][3], double v[3][3], int p, int q)
{
  const double theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q],
               t     = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1));
  const double c = 1 / sqrt(t * t + 1), s = t * c;

  for (int k = 0; k < 3; k++) {
    const double kp = a[k][p], kq = a[k][q];

    a[k][p] = c * kp - s * kq;
    a[k][q] = s * kp + c * kq;
  }
  for (int k = 0; k < 3; k++) {
    const double pk = a[p][k], qk = a[q][k], vp = v[p][k], vq = v[q][k];

    a[p][k] = c * pk - s * qk;
    a[q][k] = s * pk + c * qk;
    v[p][k] = c * vp - s * vq;
    v[q][k] = s * vp + c * vq;
  }
}

/* Eigenvalues of a symmetric matrix in ascending order, with eigenvectors v[k], by Jacobi's method. */
static void Eigen(double a[3][3], double value[3], double v[3][3])
{
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) v[i][j] = i == j;
  }
  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    for (int p = 0; p < 2; p++) {
      for (int q = p + 1; q < 3; q++) {
        if (fabs(a[p][q]) > DBL_EPSILON * (fabs(a[p][p]) + fabs(a[q][q]))) JacobiRotate(a, v, p, q);
      }
    }
  }
  for (int k = 0; k < 3; k++) value[k] = a[k][k];
  for (int i = 0; i < 2; i++) {
    for (int k = 0; k < 2 - i; k++) {
      if (value[k] > value[k + 1]) {
        double       swap[3];
        const double larger = value[k];

        value[k]     = value[k + 1];
        value[k + 1] = larger;
        memcpy(swap, v[k], sizeof(swap));
        memcpy(v[k], v[k + 1], sizeof(swap));
        memcpy(v[k + 1], swap, sizeof(swap));
      }
    }
  }
}

/*@
  FitFrameFromNormal - makes a right-handed orthonormal frame about a direction.

  Not collective

  Input Parameters:
+ dim    - 2 or 3
- normal - the direction, normal[dim], of any length except 0

  Output Parameter:
. frame - frame[k]: the tangents, then the normal; third components are 0 in 2D

  Note:
  The tangents jump only where the normal passes between coordinate axes. The fit does not depend on them. Plain C.
@*/
void FitFrameFromNormal(int dim, const double *normal, double frame[3][3])
{
  double *const n = frame[dim - 1], *const t = frame[0], length = 0;
  int least = 0;

  memset(frame, 0, 9 * sizeof(double));
  for (int c = 0; c < dim; c++) length = hypot(length, normal[c]);
  for (int c = 0; c < dim; c++) n[c] = normal[c] / length;
  if (dim == 2) {
    t[0] = n[1];
    t[1] = -n[0];
    return;
  }
  for (int c = 1; c < 3; c++) {
    if (fabs(n[c]) < fabs(n[least])) least = c;
  }
  length = sqrt(1 - n[least] * n[least]);
  for (int c = 0; c < 3; c++) t[c] = ((c == least) - n[least] * n[c]) / length;
  for (int c = 0; c < 3; c++) frame[1][c] = n[(c + 1) % 3] * t[(c + 2) % 3] - n[(c + 2) % 3] * t[(c + 1) % 3];
}

/* Sum of the weights of points, and the lower triangle of their covariance, times that sum. dim is a constant where
   this is called. */
static inline double Moments(const int dim, int n, const double *x, const double *multiplier, double covariance[3][3])
{
  double sum = 0, first[3] = {0}, second[3][3] = {{0}};

  for (int i = 0; i < n; i++) {
    sum += multiplier[i];
    for (int c = 0; c < dim; c++) first[c] += multiplier[i] * x[i * dim + c];
  }
  for (int c = 0; c < dim; c++) first[c] /= sum;
  for (int i = 0; i < n; i++)
    for (int c = 0; c < dim; c++)
      for (int d = 0; d <= c; d++)
        second[c][d] += multiplier[i] * (x[i * dim + c] - first[c]) * (x[i * dim + d] - first[d]);
  memcpy(covariance, second, sizeof(second));
  return sum;
}

/*@
  FitFrame - finds the frame of the least-squares plane (2D: line) of weighted points, eq. 3 of Chamoret et al. (2004)
  (reference plane of the slave point).

  Not collective

  Input Parameters:
+ dim        - 2 or 3
. n          - number of points
. x          - the points, x[n][dim] (length)
. multiplier - their weights, multiplier[n]
- outward    - roughly the normal out of the master, outward[dim], of any length except 0

  Output Parameter:
. frame - frame[k]: the tangents, then the normal on the side of outward; third components are 0 in 2D

  Note:
  Returns 0, with the frame about outward itself, where the points have no plane (they lie on a line or form a heap) or
  where outward sees their plane edge-on. Plain C.
@*/
int FitFrame(int dim, int n, const double *x, const double *multiplier, const double *outward, double frame[3][3])
{
  double       covariance[3][3], value[3], vector[3][3], cosine = 0, length = 0;
  const double sum  = dim == 3 ? Moments(3, n, x, multiplier, covariance) : Moments(2, n, x, multiplier, covariance);
  const int    last = 2, first = 3 - dim; /* in 2D the third direction has no extent and comes first */
  double      *normal;

  FitFrameFromNormal(dim, outward, frame);
  if (!(sum > 0)) return 0;
  for (int c = 0; c < dim; c++) {
    for (int d = 0; d <= c; d++) covariance[c][d] = covariance[d][c] = covariance[c][d] / sum;
  }
  if (dim == 2) covariance[2][2] = -1; /* below every eigenvalue of the plane */
  Eigen(covariance, value, vector);
  normal = vector[first];
  if (!(value[first + 1] > FRAME_LINE * value[last] && value[first] < FRAME_AMBIGUOUS * value[first + 1])) return 0;
  for (int c = 0; c < dim; c++) {
    cosine += normal[c] * outward[c];
    length = hypot(length, outward[c]);
  }
  if (!(fabs(cosine) > FRAME_OBLIQUE * length)) return 0;
  for (int c = 0; c < dim; c++) normal[c] *= cosine < 0 ? -1 : 1;
  FitFrameFromNormal(dim, normal, frame);
  return 1;
}

/*@
  FitMetricFromCovariance - makes the metric of the support, so that a support of s spacings holds about pi s^2 nodes
  (2D: 2 s) on any mesh.

  Not collective

  Input Parameters:
+ dim        - 2 or 3
. frame      - of FitFrame()
. covariance - covariance[3][3] of the one-ring's nodes in space, averaged over the ring's nodes; of any scale; not read
               in 2D
. area       - mean reference area of the faces per node, which is the spacing^(dim - 1); a face's area is divided by 1
               (4-node face), 1/2 (triangle), 4 (9-node face) or 2 (6-node triangle); 2D: mean length per node
- support    - radius of the support in spacings

  Output Parameter:
. metric - Q over the frame's tangents, metric[2][2], per length squared; 2D: only [0][0]

  Note:
  The shape of Q is that of the one-ring seen along the normal. It is round where the ring is flatter than METRIC_FLAT.
  The size of Q follows from the area per node alone, so that the support holds as many nodes on any mesh. Plain C.
@*/
void FitMetricFromCovariance(int dim, double (*frame)[3], double (*covariance)[3], double area, double support,
                             double metric[2][2])
{
  double C[2][2] = {{0}}, determinant, mean, spread, root;

  memset(metric, 0, 4 * sizeof(double));
  if (dim == 2) {
    metric[0][0] = 1 / (support * support * area * area);
    return;
  }
  for (int a = 0; a < 2; a++) {
    for (int b = 0; b < 2; b++) {
      for (int c = 0; c < 3; c++) {
        for (int d = 0; d < 3; d++) C[a][b] += frame[a][c] * covariance[c][d] * frame[b][d];
      }
    }
  }
  mean   = 0.5 * (C[0][0] + C[1][1]);
  spread = hypot(0.5 * (C[0][0] - C[1][1]), C[0][1]);
  if (!(mean - spread > METRIC_FLAT * METRIC_FLAT * (mean + spread))) {
    C[0][0] = C[1][1] = 1;
    C[0][1] = C[1][0] = 0;
  }
  determinant  = C[0][0] * C[1][1] - C[0][1] * C[1][0];
  root         = sqrt(determinant) * support * support * area;
  metric[0][0] = C[1][1] / root;
  metric[1][1] = C[0][0] / root;
  metric[0][1] = metric[1][0] = -C[0][1] / root;
}
