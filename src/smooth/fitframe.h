/* Where the diffuse fit looks at its points: the frame (least-squares plane of the points) and the metric of the
   support. Contact state, made with the lists and held in a solve. Plain C: no PETSc, no MPI, no allocation. */
#pragma once

#define FRAME_LINE                                                                                                   \
  1e-8 /* middle over largest eigenvalue of the points' covariance (3D): below, they lie on a line and have no plane \
        */
#define FRAME_AMBIGUOUS                                                                                               \
  0.9 /* smallest over middle (2D: largest) eigenvalue above which the points are a heap without a plane of their own \
       */
#define FRAME_OBLIQUE 0.5 /* least cosine between normal and outward direction: points are gathered within 60 degrees \
                           */
#define METRIC_FLAT \
  1e-2 /* smallest over largest semi-axis of the one-ring that still shapes the support: elements 1:100 */

/* frame[k]: tangents, then the normal e3 on the side of `outward`, of the least-squares plane (2D: line) of n points
   x[n][dim] with multipliers. Returns 0, with the frame of `outward` itself, where the points determine no such plane.
 */
int FitFrame(int dim, int n, const double *x, const double *multiplier, const double *outward, double frame[3][3]);
/* The frame whose normal is along a direction given. */
void FitFrameFromNormal(int dim, const double *normal, double frame[3][3]);
/* Q over the frame's tangents, such that a support of `support` spacings holds about pi support^2 nodes (2D: 2 support)
   on any mesh. area: mean reference area per node (2D: length) = spacing^(dim - 1); covariance: of the one-ring,
   averaged over its nodes, in space (2D: not read). */
void FitMetricFromCovariance(int dim, double (*frame)[3], double (*covariance)[3], double area, double support,
                             double metric[2][2]);
