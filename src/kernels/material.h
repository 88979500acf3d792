/* Point-wise elastic laws: stress and tangent from the deformation gradient. Plain C, no PETSc, no allocation, batched
   by lanes. A new law is a file with its function and a line in choices.h. */
#pragma once
#include "base/choices.h"
#include "base/lanes.h"

extern const char *const MaterialLaws[]; /* their words, NULL-terminated */

typedef struct {
  MaterialLaw law;
  double      E, nu; /* Young's modulus (stress), Poisson's ratio */
} Material;

/* Points are evaluated LANES at a time, one per lane of a vector as wide as the machine's registers: wider ones are
   taken apart by the compiler at many times the cost. Tensors of rank 2 have index 3 i + I (row i: space, column I:
   reference). The tangent dP_r/dH_s is symmetric and stored by rows of its upper triangle: MATERIAL_TANGENT_INDEX(r, s)
   for r <= s. */
enum { MATERIAL_TANGENT_SIZE = 45 };
#define MATERIAL_TANGENT_INDEX(r, s) ((r) * 9 - (r) * ((r) - 1) / 2 + (s) - (r))

/* det(1 + H) - 1 */
static inline void MaterialDilatation(const Lanes H[9], Lanes *dilatation)
{
  const Lanes m0 = H[4] * H[8] - H[5] * H[7], m1 = H[5] * H[6] - H[3] * H[8], m2 = H[3] * H[7] - H[4] * H[6];

  *dilatation = H[0] + H[4] + H[8] + m0 + (H[0] * H[4] - H[1] * H[3]) + (H[0] * H[8] - H[2] * H[6]) + H[0] * m0 +
                H[1] * m1 + H[2] * m2;
}

/* H: displacement gradient F - 1 and dilatation: det F - 1 (so formed that small strains keep their digits), lambda and
   mu: Lame's constants. Energy W, first Piola-Kirchhoff stress P[9] and tangent A[45] per reference volume; W and A may
   be NULL. Finite for every finite H. */
typedef void MaterialLawFn(const Lanes H[9], const Lanes *dilatation, const Lanes *lambda, const Lanes *mu, Lanes *W,
                           Lanes P[9], Lanes A[MATERIAL_TANGENT_SIZE]);
#define MATERIAL_DECLARE(law, word, function) MaterialLawFn function;
ELASTIC_LAWS(MATERIAL_DECLARE)
#undef MATERIAL_DECLARE

MaterialLawFn *MaterialGetLaw(MaterialLaw,
                              int finite); /* finite = 0: the linearisation, which is Hooke's for each law */
/* One point: H[9], W (or NULL), P[9], A[45] (or NULL) as plain numbers */
void MaterialPoint(const Material *, int finite, const double H[9], double *W, double P[9],
                   double A[MATERIAL_TANGENT_SIZE]);
void MaterialLame(double E, double nu, double *lambda, double *mu);
