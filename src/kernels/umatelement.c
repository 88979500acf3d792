/* Routines of users in batches of elements. */
#include "elementbatch.h"

/* Evaluates a routine of the user at point p, one lane after the other. An element whose routine fails counts as one
   that is turned inside out, so that the step is taken back. */
void PointUmat(const BatchCall *call, int p, const Lanes H[9], double *next, Lanes *W, Lanes P[9],
               Lanes A[MATERIAL_TANGENT_SIZE])
{
  const PlasticBatch *plastic = call->plastic;

  for (int lane = 0; lane < LANES; lane++) {
    const UmatPlace place = {.finite  = call->finite,
                             .tensor  = call->e->dim == 3 ? 6 : 4,
                             .element = plastic->number[call->part + lane],
                             .point   = p + 1,
                             .t       = plastic->t,
                             .dt      = plastic->dt};
    const size_t    at    = (size_t)p * call->states * KERNEL_LANES + lane;
    double          h[9], energy, stress[9], tangent[MATERIAL_TANGENT_SIZE];

    for (int r = 0; r < 9; r++) h[r] = H[r][lane];
    if (UmatPoint(plastic->umat, &place, h, &call->state[at], KERNEL_LANES, &energy, stress, A ? tangent : NULL,
                  next ? &next[at] : NULL) &&
        call->fault)
      call->fault[lane] = 1;
    if (W) (*W)[lane] = energy;
    for (int r = 0; r < 9 && P; r++) P[r][lane] = stress[r];
    for (int k = 0; k < MATERIAL_TANGENT_SIZE && A; k++) A[k][lane] = tangent[k];
  }
}
