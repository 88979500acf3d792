/* Mixed triangles and tetrahedra of second order, the pair of Taylor and Hood (Computers and Fluids 1, 1973). Their
   pressure is linear and continuous, so that the corners have an unknown for it besides their displacements.

   The elements make the Lagrangian of nodalpressurekernel.c stationary without its last integral, which this pair does
   not need, and with another one:

     int W_s + p (J - j) + tau^2 / (2 lambda) + gamma / 2 (J - j)^2 dV       j = exp(tau / lambda)       p = tau / j

   Pressures of corners keep J near j in the mean only. Where a surface is compressed, elements of coarse meshes then
   collapse beside each other, long before the rubber would. The last term keeps J near j at the points, too, as the
   stabilisation of the divergence does for fluids (Olshanskii and others, Comput. Methods Appl. Mech. Eng. 198, 2009).
   It vanishes in the solution, and its modulus is too small to lock.

   tau is linear in the reference coordinates of the element. The points are those of the element's table. The nodes of
   an element are followed by one for the pressure of each corner, whose unknown is as in nodalpressurekernel.c. */
#include "nodalpressure.h"

enum { MAX_CORNERS = 4, MAX_NODES = 10 };

/* Modulus of J - j at the points, over the initial shear modulus: that of a change of shape. Ten times as much changes
   the force of an X-ring by 0.3 % on a coarse mesh. */
static const double taylor_hood_volume = 2;

/* Modulus of J - j at the points. It is below half of lambda, so that the rows of the pressures keep their sign. */
LANES_INLINE Lanes VolumeModulus(const BatchCall *call)
{
  const Lanes most = taylor_hood_volume * call->mu + (Lanes){0};

  return most / (1 + 2 * most / call->modulus);
}

/* Linear shape functions of the corners at a point of the element */
LANES_INLINE void CornerShapes(const Element *e, const int corners, int q, double N[MAX_CORNERS])
{
  N[0] = 1;
  for (int a = 1; a < corners; a++) {
    N[a] = e->point[q][a - 1];
    N[0] -= N[a];
  }
}

/* Adds a point to the forces of the pressures. */
LANES_INLINE void AddPressureForce(const BatchCall *call, const int n, const int corners, const int dim,
                                   const Lanes *volume, const double N[MAX_CORNERS], const NodalPressure *x)
{
  for (int a = 0; a < corners; a++)
    LANE(call->f, (n + a) * dim + call->component) -= x->scale * *volume * x->slope * x->excess * N[a];
}

/* Adds a point to the rows and columns of the pressures. D: forces of a pressure 1 at the point. */
LANES_INLINE void AddPressureTangent(const BatchCall *call, const int n, const int corners, const int dim,
                                     const Lanes *volume, const double N[MAX_CORNERS], const NodalPressure *x,
                                     const double *D)
{
  const int   first = n * dim + call->component, all = (n + corners) * dim;
  const Lanes across = x->scale * x->slope;
  const Lanes own    = x->scale * x->scale * *volume * (x->slope * x->j_slope - x->bend * x->excess);

  for (int a = 0; a < corners; a++) {
    const int p = first + a * dim;

    for (int r = 0; r < n * dim; r++) {
      LANE(call->K, r * all + p) += across * N[a] * CONST_LANE(D, r);
      LANE(call->K, p * all + r) -= across * N[a] * CONST_LANE(D, r);
    }
    for (int b = 0; b < corners; b++) LANE(call->K, p * all + first + b * dim) += own * (N[a] * N[b]);
  }
}

/* Evaluates a point: adds to energy and forces, makes the tangent in c->A, and adds the rows of the pressures. */
LANES_INLINE void EvaluatePoint(const BatchCall *call, const int n, const int corners, const int dim, const int hoop,
                                const int q, ChunkPoints *c)
{
  const Element *e = call->e;
  double         N[MAX_CORNERS], D[MAX_NODES * 3 * KERNEL_LANES];
  const Lanes    gamma = VolumeModulus(call);
  Lanes          H[9], P[9], G[9], volume, dilatation, energy, tau = {0};
  NodalPressure  x;

  PointGradients(n, dim, hoop, e->N[q], e->dN[q], e->weight[q], q, call->X, c, &volume);
  PointDisplacementGradient(n, dim, hoop, q, call->u, c, H);
  Dilatation(call, H, &dilatation);
  KeepLeastJ(call, &dilatation);
  CornerShapes(e, corners, q, N);
  for (int a = 0; a < corners; a++) tau += N[a] * CONST_LANE(call->u, (n + a) * dim + call->component);
  tau *= call->mu / call->length;
  NodalPressureSet(call, &tau, &dilatation, &x);
  if (call->H) NodalPressureStore(call, q, H, &dilatation, &x);
  KeepVolume(&gamma, call, &x);
  PointLaw(call, q, H, &dilatation, call->W ? &energy : NULL, P, call->K ? c->A[q] : NULL);
  DilatationGradient(call, H, G);
  if (call->W)
    LANE(call->W, 0) += volume * (energy + tau * tau / (2 * call->modulus) + (x.p - gamma * x.excess / 2) * x.excess);
  for (int r = 0; r < 9; r++) P[r] = volume * (P[r] + x.p * G[r]);
  if (call->f) AddForce(n, dim, hoop, q, c, P, call->f);
  if (call->f) AddPressureForce(call, n, corners, dim, &volume, N, &x);
  if (!call->K) return;
  if (call->finite) AddGeometry(&x.p, H, c->A[q]);
  AddVolumeModulus(&gamma, G, c->A[q]);
  for (int k = 0; k < MATERIAL_TANGENT_SIZE; k++) c->A[q][k] *= volume;
  for (int r = 0; r < 9; r++) G[r] *= volume;
  for (int i = 0; i < n * dim; i++) LANE(D, i) = (Lanes){0};
  AddForce(n, dim, hoop, q, c, G, D);
  AddPressureTangent(call, n, corners, dim, &volume, N, &x, D);
}

/* Computes energy, force and tangent of the first LANES elements of the arrays. n, corners, points, dim and hoop are
   constants of the instance. */
LANES_INLINE void Batch(const BatchCall *call, const int n, const int corners, const int points, const int dim,
                        const int hoop)
{
  const int   half = n * dim, all = (n + corners) * dim;
  double      part[MAX_NODES * 3 * MAX_NODES * 3 * KERNEL_LANES];
  ChunkPoints c;

  StartLeastJ(call);
  if (call->W) LANE(call->W, 0) = (Lanes){0};
  for (int r = 0; r < all && call->f; r++) LANE(call->f, r) = (Lanes){0};
  for (int r = 0; r < all * all && call->K; r++) LANE(call->K, r) = (Lanes){0};
  for (int q = 0; q < points; q++) EvaluatePoint(call, n, corners, dim, hoop, q, &c);
  if (!call->K) return;
  AddTangent(n, dim, hoop, points, 1, 1, &c, part);
  for (int r = 0; r < half; r++)
    for (int s = 0; s < half; s++) LANE(call->K, r * all + s) = CONST_LANE(part, r * half + s);
}

#define BATCH_INSTANCE(name, nodes, corners, points, dim, hoop) \
  static void name(const BatchCall *call)                       \
  {                                                             \
    Batch(call, nodes, corners, points, dim, hoop);             \
  }

BATCH_INSTANCE(BatchTri6, 6, 3, 3, 2, 0)
BATCH_INSTANCE(BatchTri6Axisymmetric, 6, 3, 3, 2, 1)
BATCH_INSTANCE(BatchTet10, 10, 4, 4, 3, 0)

BatchFn *const taylor_hood_batches[ELEMENT_TYPES][2] = {
  [ELEMENT_TRI6]  = {BatchTri6, BatchTri6Axisymmetric},
  [ELEMENT_TET10] = {BatchTet10, NULL},
};
