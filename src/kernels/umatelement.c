/* Routines of users in batches of elements. */
#include "elementbatch.h"
#include <math.h>
#include <string.h>

/* Says where a point is and when. Coordinates are those of the deformed body in finite strains.

   number - place of the element in the arrays of the batch
   X, u   - of one element [node][dim][stride] */
UmatPlace UmatPlaceAt(const Element *e, int finite, const PlasticBatch *plastic, int number, int p, const double *X,
                      const double *u, int stride)
{
  UmatPlace place = {.finite  = finite,
                     .tensor  = e->dim == 3 ? 6 : 4,
                     .element = plastic->number[number],
                     .point   = p + 1,
                     .t       = plastic->t,
                     .dt      = plastic->dt,
                     .length  = plastic->length[number]};

  memcpy(place.x, plastic->origin, sizeof place.x);
  for (int a = 0; a < e->nodes; a++) {
    for (int i = 0; i < e->dim; i++) {
      const int k = (a * e->dim + i) * stride;

      place.x[i] += e->N[p][a] * (X[k] + (finite ? u[k] : 0));
    }
  }
  return place;
}

/* Evaluates a routine of the user at point p, one lane after the other. An element whose routine fails counts as one
   that is turned inside out, so that the step is taken back. Its first fault is kept. With the next state, the largest
   modulus by which J is to be held goes on, as that of hardening does: unloading does not end it. */
void PointUmat(const BatchCall *call, int p, const Lanes H[9], double *next, Lanes *W, Lanes P[9],
               Lanes A[MATERIAL_TANGENT_SIZE])
{
  const PlasticBatch *plastic = call->plastic;

  for (int lane = 0; lane < LANES; lane++) {
    const UmatPlace place =
      UmatPlaceAt(call->e, call->finite, plastic, call->part + lane, p, call->X + lane, call->u + lane, KERNEL_LANES);
    const size_t  at      = (size_t)p * call->states * KERNEL_LANES + lane;
    double *const largest = next && call->hold ? &next[at + (size_t)(call->hold + PLASTIC_HOLD) * KERNEL_LANES] : NULL;
    double        h[9], energy, stress[9], tangent[MATERIAL_TANGENT_SIZE], skew[UMAT_SKEW_SIZE], unheld;
    UmatFault     fault;

    for (int r = 0; r < 9; r++) h[r] = H[r][lane];
    fault = UmatPoint(plastic->umat, &place, h, &call->state[at], KERNEL_LANES, &energy, stress, A ? tangent : NULL,
                      skew, next ? &next[at] : NULL, largest ? &unheld : NULL);
    if (largest) *largest = fmax(*largest, unheld);
    if (call->fault && !call->fault[lane]) call->fault[lane] = UmatFaultAt(fault, place.point);
    if (W) (*W)[lane] = energy;
    for (int r = 0; r < 9 && P; r++) P[r][lane] = stress[r];
    for (int k = 0; k < MATERIAL_TANGENT_SIZE && A; k++) A[k][lane] = tangent[k];
    for (int k = 0; k < UMAT_SKEW_SIZE && A && call->skew; k++) call->skew[p][k][lane] = skew[k];
  }
}

/* Adds the skew part of the tangent at a point. V[dof] is the derivative of the gradient at which the law is evaluated
   by a displacement. */
void AddSkewPoint(int dofs, Lanes V[][9], const Lanes skew[UMAT_SKEW_SIZE], const Lanes *volume, double *K)
{
  for (int s = 0; s < dofs; s++) {
    Lanes T[9];

    memset(T, 0, sizeof T);
    for (int r = 0; r < 9; r++) {
      for (int m = r + 1; m < 9; m++) {
        T[r] += skew[UMAT_SKEW_INDEX(r, m)] * V[s][m];
        T[m] -= skew[UMAT_SKEW_INDEX(r, m)] * V[s][r];
      }
    }
    for (int r = 0; r < s; r++) {
      Lanes sum = {0};

      for (int k = 0; k < 9; k++) sum += V[r][k] * T[k];
      LANE(K, r * dofs + s) += sum * *volume;
      LANE(K, s * dofs + r) -= sum * *volume;
    }
  }
}

/* Adds the skew part of the tangent of an element with full integration. hoop: it is axisymmetric */
void AddSkewTangent(const BatchCall *call, int hoop)
{
  const Element *e = call->e;
  ChunkPoints    c;

  for (int p = 0; p < e->points; p++) {
    Lanes V[ELEMENT_MAX_NODES * 3][9], volume;

    PointGradients(e->nodes, e->dim, hoop, e->N[p], e->dN[p], e->weight[p], 0, call->X, &c, &volume);
    PointGradientDerivatives(e->nodes, e->dim, hoop, 0, &c, V);
    AddSkewPoint(e->nodes * e->dim, V, call->skew[p], &volume, call->K);
  }
}
