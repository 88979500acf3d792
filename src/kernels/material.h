/* Elastic laws at a point: stress and tangent from the deformation gradient. Plain C, no PETSc, no allocation.

   A law has a vector of constants. constants[0] is the modulus of its volume part, mostly constants[0]/2 (ln J)^2 with
   J = det F. The others are its own. A Material is a law with its constants. MaterialGetLaw() gives a law, which treats
   LANES points at a time. MaterialPoint() and MaterialEvaluate() treat one point. A new law is a file that defines an
   ElasticLaw, and a line in base/choices.h. */
#pragma once
#include "base/choices.h"
#include "base/lanes.h"
#include "kernels/hardening.h"
#include "kernels/umat.h"

extern const char *const MaterialLaws[]; /* words of the laws in a scene, NULL-terminated */

enum {
  MATERIAL_TANGENT_SIZE = 45,
  /* One modulus of the volume and 16 terms of two constants. Fits of measured rubber have up to 6 terms. */
  MATERIAL_MAX_CONSTANTS = 33
};

#define MATERIAL_MAX_KEYS 3
#define MATERIAL_TERMS    "terms"

/* Smallest determinant of F at which a law is evaluated; smaller ones are replaced by it. No state with J <= 0 is
   accepted, but a line search evaluates such states and needs finite numbers. The value is far below any J of an
   accepted state. */
#define MATERIAL_LEAST_J 1e-8

/* E and nu belong to the undeformed state and follow from the constants. An incompressible material has constants[0] =
   INFINITY and nu = 1/2; only an element that does not evaluate the volume part can treat it. */
typedef struct {
  MaterialLaw law;
  int         n_constants;
  double      constants[MATERIAL_MAX_CONSTANTS];
  double      E, nu;     /* Young's modulus (stress), Poisson's ratio */
  Hardening   hardening; /* of a plastic law */
  Umat       *umat;      /* of MATERIAL_UMAT; the scene owns it */
} Material;

/* LANES points are evaluated together, one in each lane of a vector as wide as the machine's registers. Component (i,
   I) of a tensor has the index 3 i + I; i belongs to space, I to the reference configuration. The tangent dP_r/dH_s is
   symmetric. Its upper triangle is stored by rows: MATERIAL_TANGENT_INDEX(r, s) for r <= s. */
#define MATERIAL_TANGENT_INDEX(r, s) ((r) * 9 - (r) * ((r) - 1) / 2 + (s) - (r))

/* Computes det(1 + H) - 1 in a form in which small strains keep their digits. */
static inline void MaterialDilatation(const Lanes H[9], Lanes *dilatation)
{
  const Lanes m0 = H[4] * H[8] - H[5] * H[7], m1 = H[5] * H[6] - H[3] * H[8], m2 = H[3] * H[7] - H[4] * H[6];

  *dilatation = H[0] + H[4] + H[8] + m0 + (H[0] * H[4] - H[1] * H[3]) + (H[0] * H[8] - H[2] * H[6]) + H[0] * m0 +
                H[1] * m1 + H[2] * m2;
}

/* Evaluates a law with n constants. Its input is the displacement gradient H = F - 1 and the dilatation det F - 1 from
   MaterialDilatation(). Its output per reference volume is the energy W, the first Piola-Kirchhoff stress P[9] and the
   tangent A[45]. W and A may be NULL. The output is finite for every finite H and constants. With constants[0] = 0 it
   is that of the law without its volume part. */
typedef void MaterialLawFn(const Lanes H[9], const Lanes *dilatation, int n, const Lanes constants[], Lanes *W,
                           Lanes P[9], Lanes A[MATERIAL_TANGENT_SIZE]);

/* Computes the shear modulus mu of the undeformed state. */
typedef void MaterialShearFn(int n, const Lanes constants[], Lanes *mu);

/* Puts the stress that extrapolates from an earlier state into the geometric part of the tangent A at H, which on entry
   is that of evaluate(). H_0 is the displacement gradient of the earlier state. rate is 1: its stress changes linearly
   on the way, or 0: it does not change. */
typedef void MaterialExtrapolateFn(const Lanes H[9], const Lanes H_0[9], double rate, const Lanes constants[],
                                   Lanes A[MATERIAL_TANGENT_SIZE]);

/* A separable law is a sum of constants[0]/2 (ln J)^2 and of a part without constants[0]. Of the others svk has
   constants[0]/2 (tr E)^2 instead, linear constants[0]/2 (tr e)^2, and hyperfoam has powers of J. constants[0] is the first
   one of Lame's constants, or the bulk modulus where the law is isochoric: its other part does not depend on J. */
typedef struct {
  MaterialLawFn         *evaluate;
  MaterialShearFn       *shear;
  MaterialExtrapolateFn *extrapolate; /* NULL: the pressure of separable laws is extrapolated, nothing of others */
  int                    constants;   /* their number; for laws of any number of terms that of one term */
  int                    separable, isochoric;
  /* Keys of the own constants in a scene, in their order; the first `required` ones have no default, the others are 0.
     MATERIAL_TERMS is the key of a list of terms with two constants each. A law whose only key is mu takes E, too. */
  const char *keys[MATERIAL_MAX_KEYS + 1];
  int         required;
  int         plastic; /* evaluate() is the elastic part of a law that has a state, see vonmises.h and umat.h */
} ElasticLaw;

#define MATERIAL_DECLARE(law, word, object) extern const ElasticLaw object;
ELASTIC_LAWS(MATERIAL_DECLARE)
#undef MATERIAL_DECLARE

const ElasticLaw *MaterialGetLaw(MaterialLaw);
int               MaterialHasModuli(MaterialLaw);
Material          MaterialFromModuli(MaterialLaw, double E, double nu);
Material          MaterialFromConstants(MaterialLaw, int n, const double own[]);
void              MaterialSetBulk(Material *, double K);
double            MaterialBulk(double mu, double nu);
Material          MaterialLinearise(const Material *);
void   MaterialEvaluate(MaterialLaw, int n, const double constants[], const double H[9], double *W, double P[9],
                        double A[MATERIAL_TANGENT_SIZE]);
void   MaterialPoint(const Material *, int finite, const double H[9], double *W, double P[9],
                     double A[MATERIAL_TANGENT_SIZE]);
double MaterialShear(const Material *);
