/* Elastic laws at a point: stress and tangent from the deformation gradient. Plain C, no PETSc, no allocation.

   MaterialGetLaw() gives the function of a law, which treats LANES points at a time. MaterialPoint() evaluates one
   point. A new law is a file with its function and a line in base/choices.h. */
#pragma once
#include "base/choices.h"
#include "base/lanes.h"

extern const char *const MaterialLaws[]; /* words of the laws in a scene, NULL-terminated */

typedef struct {
  MaterialLaw law;
  double      E, nu; /* Young's modulus (stress), Poisson's ratio */
} Material;

/* LANES points are evaluated together, one in each lane of a vector as wide as the machine's registers. Component (i,
   I) of a tensor has the index 3 i + I; i belongs to space, I to the reference configuration. The tangent dP_r/dH_s is
   symmetric. Its upper triangle is stored by rows: MATERIAL_TANGENT_INDEX(r, s) for r <= s. */
enum { MATERIAL_TANGENT_SIZE = 45 };
#define MATERIAL_TANGENT_INDEX(r, s) ((r) * 9 - (r) * ((r) - 1) / 2 + (s) - (r))

/* Computes det(1 + H) - 1 in a form in which small strains keep their digits. */
static inline void MaterialDilatation(const Lanes H[9], Lanes *dilatation)
{
  const Lanes m0 = H[4] * H[8] - H[5] * H[7], m1 = H[5] * H[6] - H[3] * H[8], m2 = H[3] * H[7] - H[4] * H[6];

  *dilatation = H[0] + H[4] + H[8] + m0 + (H[0] * H[4] - H[1] * H[3]) + (H[0] * H[8] - H[2] * H[6]) + H[0] * m0 +
                H[1] * m1 + H[2] * m2;
}

/* A law. Its input is the displacement gradient H = F - 1, the dilatation det F - 1 from MaterialDilatation() and
   Lame's constants lambda and mu. Its output per reference volume is the energy W, the first Piola-Kirchhoff stress
   P[9] and the tangent A[45]. W and A may be NULL. The output is finite for every finite H. */
typedef void MaterialLawFn(const Lanes H[9], const Lanes *dilatation, const Lanes *lambda, const Lanes *mu, Lanes *W,
                           Lanes P[9], Lanes A[MATERIAL_TANGENT_SIZE]);
#define MATERIAL_DECLARE(law, word, function) MaterialLawFn function;
ELASTIC_LAWS(MATERIAL_DECLARE)
#undef MATERIAL_DECLARE

Material       MaterialShapeOnly(MaterialLaw, double E, double nu);
MaterialLawFn *MaterialGetLaw(MaterialLaw, int finite);
void           MaterialPoint(const Material *, int finite, const double H[9], double *W, double P[9],
                             double A[MATERIAL_TANGENT_SIZE]);
void           MaterialLame(double E, double nu, double *lambda, double *mu);
