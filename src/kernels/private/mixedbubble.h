/* The inner node of mixed tri6 and tet10, whose shape function is a bubble: its displacement is solved for in the
   element. SolveBubble() finds it, FollowBubble() its part in a linear change of the volume. mixedkernel.c explains the
   method. Plain C, inlined like elementbatch.h. */
#pragma once
#include "mixedpressure.h"
#include <string.h>

/* Iterations of Newton's method for the inner node. It takes 2 to 5; an element that needs more than this has failed.
 */
enum { MAX_ITERATIONS = 40 };
/* Newton's method has converged when the energy of a correction is below this part of the element's energy. */
static const double converged_energy = 1e-16;
/* Relative round-off error of an energy that is a sum over the points. Two energies this close count as equal. */
static const double energy_round_off = 1e-13;
/* Square of a strain that is negligible, for elements that have no energy. It is far above the round-off of
   displacements and far below any strain of interest. */
static const double converged_strain2 = 1e-20;

/* Adds the bubble to a displacement gradient. */
LANES_INLINE void AddBubble(const int dim, const int hoop, const Lanes b[MAX_BUBBLE], const Lanes g[3], Lanes H[9])
{
  for (int i = 0; i < dim; i++) {
    for (int m = 0; m < dim; m++) H[3 * i + m] += b[i] * g[m];
  }
  if (hoop) H[TENSOR_HOOP] += b[0] * g[2];
}

/* The equations of the bubble: energy W of the element, force f and tangent K of the inner node. size is a sum of
   absolute values that W is a sum of, for its round-off. */
typedef struct {
  Lanes W, size, f[MAX_BUBBLE], K[MAX_BUBBLE][MAX_BUBBLE];
} BubbleSystem;

/* What J adds to them: first and second derivatives of theta by the bubble */
typedef struct {
  Lanes first[MIXED_PRESSURES][MAX_BUBBLE], second[MIXED_PRESSURES][MAX_BUBBLE][MAX_BUBBLE];
} BubbleDilatation;

/* Adds a point to f and K of the inner node: the law's stress P and tangent A. */
LANES_INLINE void AddBubbleShape(const int dim, const int hoop, const Lanes g[3], const Lanes *volume, const Lanes P[9],
                                 const Lanes A[MATERIAL_TANGENT_SIZE], BubbleSystem *s)
{
  for (int i = 0; i < dim; i++) {
    for (int m = 0; m < dim; m++) s->f[i] += *volume * P[3 * i + m] * g[m];
    if (hoop && i == 0) s->f[i] += *volume * P[TENSOR_HOOP] * g[2];
    for (int j = i; j < dim; j++) {
      Lanes sum = {0};

      for (int m = 0; m < dim; m++) {
        for (int l = 0; l < dim; l++) sum += g[m] * g[l] * TANGENT(A, 3 * i + m, 3 * j + l);
        if (hoop && j == 0) sum += g[m] * g[2] * TANGENT(A, 3 * i + m, TENSOR_HOOP);
        if (hoop && i == 0) sum += g[m] * g[2] * TANGENT(A, 3 * j + m, TENSOR_HOOP);
      }
      if (hoop && i == 0 && j == 0) sum += g[2] * g[2] * TANGENT(A, TENSOR_HOOP, TENSOR_HOOP);
      s->K[i][j] += *volume * sum;
    }
  }
}

/* Adds a point to the derivatives of theta. J is linear in the bubble but for the hoop stretch. */
LANES_INLINE void AddBubbleDilatation(const int modes, const int dim, const int hoop, int finite, const Lanes g[3],
                                      const Lanes *volume, const Lanes shape[MIXED_PRESSURES], const Lanes H[9],
                                      const Lanes G[9], BubbleDilatation *d)
{
  Lanes v[MAX_BUBBLE], ring = {0};

  for (int i = 0; i < dim; i++) {
    v[i] = G[3 * i] * g[0];
    for (int m = 1; m < dim; m++) v[i] += G[3 * i + m] * g[m];
  }
  if (hoop && finite) ring = g[2] / (1 + H[TENSOR_HOOP]);
  for (int k = 0; k < modes; k++) {
    const Lanes weight = *volume * shape[k];

    for (int i = 0; i < dim; i++) {
      d->first[k][i] += weight * (hoop && i == 0 ? v[0] + G[TENSOR_HOOP] * g[2] : v[i]);
      if (hoop) d->second[k][0][i] += weight * ring * (i == 0 ? 2 * v[0] : v[i]);
    }
  }
}

LANES_INLINE void SetBubbleSystem(const BatchCall *call, const int points, const int modes, const int dim,
                                  const int hoop, Mixed *x, BubbleSystem *s, BubbleDilatation *d)
{
  Lanes volume;

  memset(s, 0, sizeof(*s));
  memset(d, 0, sizeof(*d));
  for (int k = 0; k < modes; k++) x->theta[k] = (Lanes){0};
  for (int q = 0; q < points; q++) {
    Lanes H[9], P[9], G[9], A[MATERIAL_TANGENT_SIZE], dilatation, energy;

    for (int r = 0; r < 9; r++) H[r] = x->H[q][r];
    AddBubble(dim, hoop, x->b, x->bubble[q], H);
    Dilatation(call, H, &dilatation);
    MixedLaw(call, &x->hold, q, H, &dilatation, &energy, P, A);
    DilatationGradient(call, H, G);
    s->W += x->volume[q] * energy;
    for (int k = 0; k < modes; k++) x->theta[k] += x->volume[q] * x->shape[q][k] * dilatation;
    AddBubbleShape(dim, hoop, x->bubble[q], &x->volume[q], P, A, s);
    AddBubbleDilatation(modes, dim, hoop, call->finite, x->bubble[q], &x->volume[q], x->shape[q], H, G, d);
  }
  Pressures(call, points, modes, x, &volume);
  s->size = s->W + volume;
  s->W += volume;
  for (int k = 0; k < modes; k++) {
    const Lanes work = x->theta[k] * Multiplier(call, k);
    Lanes       change[MAX_BUBBLE]; /* of the pressure by the bubble */

    for (int lane = 0; lane < LANES; lane++) s->size[lane] += fabs(work[lane]) - work[lane];
    for (int i = 0; i < dim; i++) {
      change[i] = (Lanes){0};
      for (int l = 0; l < modes; l++) change[i] += x->C[k][l] * d->first[l][i];
    }
    for (int i = 0; i < dim; i++) {
      s->f[i] += x->p[k] * d->first[k][i];
      for (int j = i; j < dim; j++) s->K[i][j] += d->first[k][i] * change[j] + x->p[k] * d->second[k][i][j];
    }
  }
}

/* Factors K = U^T D U from its upper triangle and solves K d = f. U is stored above the diagonal and 1 / D on it. */
LANES_INLINE void SolveBubbleSystem(const int dim, BubbleSystem *s, Lanes d[MAX_BUBBLE])
{
  for (int k = 0; k < dim; k++) {
    s->K[k][k] = 1 / s->K[k][k];
    for (int i = k + 1; i < dim; i++) {
      const Lanes u = s->K[k][i] * s->K[k][k];

      for (int j = i; j < dim; j++) s->K[i][j] -= u * s->K[k][j];
    }
    for (int i = k + 1; i < dim; i++) s->K[k][i] *= s->K[k][k];
    d[k] = s->f[k];
  }
  for (int k = 0; k < dim; k++) {
    for (int i = k + 1; i < dim; i++) d[i] -= s->K[k][i] * d[k];
  }
  for (int k = dim - 1; k >= 0; k--) {
    d[k] *= s->K[k][k];
    for (int i = k + 1; i < dim; i++) d[k] -= s->K[k][i] * d[i];
  }
}

/* State of Newton's method for the bubble of each lane */
typedef struct {
  Lanes W;                /* energy at the last point that was better than the one before */
  Lanes gone[MAX_BUBBLE]; /* step from that point to b */
  Lanes active;           /* 1 while the lane has not converged, else 0 */
  Lanes scale;            /* energy of a negligible strain */
} BubbleState;

/* A lane whose energy fell takes the correction d. A lane whose energy rose goes back by half of its last step. A lane
   that has converged does not change. Returns how many have not converged. */
LANES_INLINE int Advance(const int dim, const BubbleSystem *s, const Lanes *d, BubbleState *state, Mixed *x)
{
  int left = 0;

  for (int lane = 0; lane < LANES; lane++) {
    const double round_off = energy_round_off * s->size[lane] + state->scale[lane];
    double       work      = 0; /* twice the energy that the correction releases */

    if (state->active[lane] == 0) continue;
    if (s->W[lane] > state->W[lane] + round_off) {
      for (int k = 0; k < dim; k++) {
        state->gone[k][lane] /= 2;
        x->b[k][lane] -= state->gone[k][lane];
      }
      left++;
      continue;
    }
    state->W[lane] = s->W[lane];
    for (int k = 0; k < dim; k++) {
      state->gone[k][lane] = -d[k][lane];
      x->b[k][lane] -= d[k][lane];
      work += fabs(s->f[k][lane] * d[k][lane]);
    }
    state->active[lane] = !(work <= converged_energy * s->size[lane] + state->scale[lane]);
    left += state->active[lane] != 0;
  }
  return left;
}

/* Solves for the bubble of each lane. A lane that does not converge gets J = NaN and no bubble. With small strains and
   without plasticity one step is enough. */
LANES_INLINE void SolveBubble(const BatchCall *call, const int points, const int modes, const int dim, const int hoop,
                              Mixed *x)
{
  const int   iterates = call->finite || call->state;
  BubbleState state    = {.W = (Lanes){0} + __DBL_MAX__, .active = (Lanes){0} + 1};
  int         left     = LANES;

  for (int q = 0; q < points; q++) state.scale += converged_strain2 * call->mu * x->volume[q];
  for (int iteration = 0; left && iteration < (iterates ? MAX_ITERATIONS : 1); iteration++) {
    BubbleSystem     s;
    BubbleDilatation dilatation;
    Lanes            d[MAX_BUBBLE];

    SetBubbleSystem(call, points, modes, dim, hoop, x, &s, &dilatation);
    SolveBubbleSystem(dim, &s, d);
    left = Advance(dim, &s, d, &state, x);
  }
  for (int lane = 0; lane < LANES && iterates; lane++) {
    for (int k = 0; k < dim && state.active[lane] != 0; k++) x->b[k][lane] = 0;
    if (state.active[lane] != 0) call->J[lane] = NAN;
  }
}

/* Adds a point to the force on the inner node that a change dH of the displacement gradient makes. */
LANES_INLINE void AddBubbleChange(const int dim, const int hoop, const Lanes g[3], const Lanes *volume,
                                  const Lanes A[MATERIAL_TANGENT_SIZE], const Lanes dH[9], Lanes f[MAX_BUBBLE])
{
  Lanes Q[9];

  for (int r = 0; r < 9; r++) {
    Q[r] = TANGENT(A, r, 0) * dH[0];
    for (int s = 1; s < 9; s++) Q[r] += TANGENT(A, r, s) * dH[s];
  }
  for (int i = 0; i < dim; i++) {
    for (int m = 0; m < dim; m++) f[i] += *volume * Q[3 * i + m] * g[m];
  }
  if (hoop) f[0] += *volume * Q[TENSOR_HOOP] * g[2];
}

/* Adds to the linear change of theta between the states y and x what the bubble of y does in it. */
LANES_INLINE void FollowBubble(const BatchCall *call, const int points, const int modes, const int dim, const int hoop,
                               const Mixed *x, Mixed *y, Lanes change[MIXED_PRESSURES])
{
  BubbleSystem     s;
  BubbleDilatation d;
  Lanes            follow[MAX_BUBBLE];

  SetBubbleSystem(call, points, modes, dim, hoop, y, &s, &d);
  for (int i = 0; i < dim; i++) s.f[i] = (Lanes){0};
  for (int q = 0; q < points; q++) {
    const Lanes pressure = PressureAt(modes, y->p, y->shape[q]);
    Lanes       H[9], P[9], A[MATERIAL_TANGENT_SIZE], dH[9], dilatation;

    for (int r = 0; r < 9; r++) {
      H[r]  = y->H[q][r];
      dH[r] = x->H[q][r] - y->H[q][r];
    }
    AddBubble(dim, hoop, y->b, y->bubble[q], H);
    Dilatation(call, H, &dilatation);
    MixedLaw(call, &y->hold, q, H, &dilatation, NULL, P, A);
    AddGeometry(&pressure, H, A);
    AddBubbleChange(dim, hoop, y->bubble[q], &y->volume[q], A, dH, s.f);
  }
  for (int k = 0; k < modes; k++) {
    Lanes pressure = y->C[k][0] * change[0];

    for (int l = 1; l < modes; l++) pressure += y->C[k][l] * change[l];
    for (int i = 0; i < dim; i++) s.f[i] += pressure * d.first[k][i];
  }
  SolveBubbleSystem(dim, &s, follow);
  for (int k = 0; k < modes; k++) {
    for (int i = 0; i < dim; i++) change[k] -= d.first[k][i] * follow[i];
  }
}
