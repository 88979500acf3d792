/* Frame and metric of the diffuse fit: the least-squares plane of the fit points and the size and shape of the support.
   Plain C: no PETSc, no MPI, no allocation.

   FitFrame() finds the frame of one slave point, and FitFrameFromNormal() makes one about a given direction.
   FitMetricFromCovariance() then makes the metric over the frame's tangents. Frame and metric are contact state:
   they are made with the lists and held in a solve. */
#pragma once

/* Middle eigenvalue of the points' covariance over the largest one (3D). Below this the points lie on a line and
   have no plane. */
#define FRAME_LINE 1e-8
/* Smallest eigenvalue over the middle one (2D: over the largest one). Above this the points are a heap without a
   plane of their own. */
#define FRAME_AMBIGUOUS 0.9
/* Least cosine between the plane's normal and the outward direction. It matches the 60 degrees within which points
   are gathered. */
#define FRAME_OBLIQUE 0.5
/* Smallest semi-axis of the one-ring over the largest one. Rings that are flatter, from elements of 1:100, do not
   shape the support. */
#define METRIC_FLAT 1e-2

int  FitFrame(int dim, int n, const double *x, const double *multiplier, const double *outward, double frame[3][3]);
void FitFrameFromNormal(int dim, const double *normal, double frame[3][3]);
void FitMetricFromCovariance(int dim, double (*frame)[3], double (*covariance)[3], double area, double support,
                             double metric[2][2]);
