/* Mixed triangles and tetrahedra of first order. Their pressure is linear and continuous, so that the nodes have an
   unknown for it besides their displacements.

   The elements make the Lagrangian stationary

     int W_s dV + int p (J - j) + tau^2 / (2 lambda) dV - 1/2 int (1 / mu + 1 / lambda) (tau - tau')^2 dV.

   W_s is the energy of the law without its modulus lambda of the volume, and mu the law's shear modulus. tau is the
   unknown, the derivative of the energy of the volume by ln j. The volume is j = exp(tau / lambda), and p = tau / j.
   tau' is the mean of tau in the element. The first two integrals have one point, the middle, and tau' there. The last
   integral is the projection of Dohrmann and Bochev (International Journal for Numerical Methods in Fluids 46, 2004).
   It makes the pair of displacements and pressures of equal order stable, and its error is of the order of the
   elements. In small strains the trace of the strain takes the place of J - 1, tau that of p, and tau / lambda that of
   j - 1. The energy is the value of the Lagrangian. Where the pressures are in equilibrium, its derivative along a path
   is the work of the forces.

   The nodes of an element are followed by as many nodes for the pressure. One component of the displacement of such a
   node is tau length / mu, with length and component of the KernelCase; the others do not count. The rows of the
   pressures have the sign with which the symmetric part of the tangent is positive definite where that of the
   displacements is: the tangent is not symmetric. */
#include "nodalpressure.h"
#include "volumehold.h"

enum { MAX_CORNERS = 4 };

/* The pressure at the middle of an element */
typedef struct {
  Lanes         tau[MAX_CORNERS]; /* at the nodes */
  Lanes         mean;
  Lanes         hold, carried, energy; /* of volumehold.h, with J - j: modulus, stress and energy carried over */
  NodalPressure at;
} Pressure;

/* Computes the pressure and its derivatives from the unknowns and J - 1. */
LANES_INLINE void SetPressure(const BatchCall *call, const int n, const int dim, const Lanes *dilatation, Pressure *x)
{
  const Lanes none = {0};

  x->mean    = (Lanes){0};
  x->hold    = HoldModulus(call, 1);
  x->carried = HoldStress(call, 0, &x->hold, &none);
  x->energy  = HoldEnergy(call, 0, &x->hold, &none);
  for (int a = 0; a < n; a++) {
    x->tau[a] = call->mu / call->length * CONST_LANE(call->u, (n + a) * dim + call->component);
    x->mean += x->tau[a] / n;
  }
  NodalPressureSet(call, &x->mean, dilatation, &x->at);
}

/* Second derivative of the last integral by tau at the nodes a and b */
LANES_INLINE Lanes Deviation(const BatchCall *call, const int n, const Lanes *volume, int a, int b)
{
  const double part = (a == b ? 2. : 1.) / (n * (n + 1)) - 1. / (n * n);

  return *volume * part * (1 / call->mu + 1 / call->modulus);
}

/* The part of the Lagrangian that has the pressure, over the volume. `projection` is the last integral over it. */
LANES_INLINE Lanes PressureEnergy(const BatchCall *call, const int n, const Pressure *x)
{
  const Lanes unit       = (Lanes){0} + 1;
  Lanes       projection = {0};

  for (int a = 0; a < n; a++)
    for (int b = 0; b < n; b++) projection += Deviation(call, n, &unit, a, b) * x->tau[a] * x->tau[b] / 2;
  return x->energy + (x->at.p - x->hold / 2 * x->at.excess) * x->at.excess + x->mean * x->mean / (2 * call->modulus) -
         projection;
}

LANES_INLINE void AddPressureForce(const BatchCall *call, const int n, const int dim, const Lanes *volume,
                                   const Pressure *x)
{
  for (int a = 0; a < n; a++) {
    Lanes force = -*volume * (x->at.slope * x->at.excess - x->carried * x->at.j_slope) / n;

    for (int b = 0; b < n; b++) force += Deviation(call, n, volume, a, b) * x->tau[b];
    for (int i = 0; i < dim; i++)
      LANE(call->f, (n + a) * dim + i) = i == call->component ? x->at.scale * force : (Lanes){0};
  }
}

/* Writes K from its part [n*dim][n*dim] for the displacements and from the forces D of a mean pressure 1. */
LANES_INLINE void JoinTangent(const BatchCall *call, const int n, const int dim, const Lanes *volume, const Pressure *x,
                              const double *part, const double *D)
{
  const int   half = n * dim, all = 2 * half, p = half + call->component;
  const Lanes across = x->at.scale * x->at.slope / n;
  const Lanes bend   = x->carried / call->modulus; /* j_slope times it is that of the stress carried over */
  const Lanes middle = *volume * ((x->at.slope + bend) * x->at.j_slope - x->at.bend * x->at.excess) / (n * n);

  for (int r = 0; r < all * all; r++) LANE(call->K, r) = (Lanes){0};
  for (int r = 0; r < half; r++) {
    for (int s = 0; s < half; s++) LANE(call->K, r * all + s) = CONST_LANE(part, r * half + s);
    for (int a = 0; a < n; a++) {
      LANE(call->K, r * all + p + a * dim)   = across * CONST_LANE(D, r);
      LANE(call->K, (p + a * dim) * all + r) = -across * CONST_LANE(D, r);
    }
  }
  for (int a = 0; a < n; a++) {
    for (int b = 0; b < n; b++)
      LANE(call->K, (p + a * dim) * all + p + b * dim) =
        x->at.scale * x->at.scale * (middle + Deviation(call, n, volume, a, b));
  }
}

/* Computes energy, force and tangent of the first LANES elements of the arrays. n, dim and hoop are constants of the
   instance. */
LANES_INLINE void Batch(const BatchCall *call, const int n, const int dim, const int hoop)
{
  const Element *e = call->e;
  double         D[MAX_CORNERS * 3 * KERNEL_LANES], part[MAX_CORNERS * 3 * MAX_CORNERS * 3 * KERNEL_LANES];
  Lanes          H[9], P[9], G[9], volume, dilatation, energy;
  ChunkPoints    c;
  Pressure       x;

  StartLeastJ(call);
  PointGradients(n, dim, hoop, e->N[0], e->dN[0], e->weight[0], 0, call->X, &c, &volume);
  PointDisplacementGradient(n, dim, hoop, 0, call->u, &c, H);
  Dilatation(call, H, &dilatation);
  KeepLeastJ(call, &dilatation);
  SetPressure(call, n, dim, &dilatation, &x);
  if (call->H) NodalPressureStore(call, 0, H, &dilatation, &x.at);
  if (call->off) LANE(call->off, 0) = x.at.excess;
  if (call->hold) {
    x.at.p += x.carried;
    KeepVolume(&x.hold, call, &x.at);
  }
  PointLaw(call, 0, H, &dilatation, call->W ? &energy : NULL, P, call->K ? c.A[0] : NULL);
  DilatationGradient(call, H, G);
  if (call->W) LANE(call->W, 0) = volume * (energy + PressureEnergy(call, n, &x));
  if (call->f) {
    for (int r = 0; r < 9; r++) P[r] = volume * (P[r] + x.at.p * G[r]);
    for (int i = 0; i < n * dim; i++) LANE(call->f, i) = (Lanes){0};
    AddForce(n, dim, hoop, 0, &c, P, call->f);
    AddPressureForce(call, n, dim, &volume, &x);
  }
  if (!call->K) return;
  if (call->finite) AddGeometry(&x.at.p, H, c.A[0]);
  if (call->hold) AddVolumeModulus(&x.hold, G, c.A[0]);
  for (int k = 0; k < MATERIAL_TANGENT_SIZE; k++) c.A[0][k] *= volume;
  for (int r = 0; r < 9; r++) G[r] *= volume;
  for (int i = 0; i < n * dim; i++) LANE(D, i) = (Lanes){0};
  AddForce(n, dim, hoop, 0, &c, G, D);
  AddTangent(n, dim, hoop, 1, 1, 1, &c, part);
  JoinTangent(call, n, dim, &volume, &x, part, D);
}

#define BATCH_INSTANCE(name, nodes, dim, hoop) \
  static void name(const BatchCall *call)      \
  {                                            \
    Batch(call, nodes, dim, hoop);             \
  }

BATCH_INSTANCE(BatchTri3, 3, 2, 0)
BATCH_INSTANCE(BatchTri3Axisymmetric, 3, 2, 1)
BATCH_INSTANCE(BatchTet4, 4, 3, 0)

BatchFn *const nodal_pressure_batches[ELEMENT_TYPES][2] = {
  [ELEMENT_TRI3] = {BatchTri3, BatchTri3Axisymmetric},
  [ELEMENT_TET4] = {BatchTet4, NULL},
};
