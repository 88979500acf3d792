/* Mixed elements, the formulation `mixed`. The pressure has its own shape functions in every element, so that solids
   that keep their volume nearly or exactly do not lock, and their pressures do not oscillate.

   The energy of an element is int W_s dV + lambda/2 int (ln j)^2 dV with j = 1 + Pi (J - 1). W_s is the energy of the
   law with a small part of the modulus of the volume, lambda is the rest of that modulus (VolumeModuli), and Pi the
   projection on the pressure's shape functions (least squares over the reference volume). The pressure is p =
   Pi (lambda ln j / j). This is the mixed method with displacements, pressures and volumes as unknowns; the last two
   are condensed in the element. In small strains the trace of the strain takes the place of J - 1, and j - 1 that of
   ln j.

   The projection is of J and not of ln J. J has no second variation that integrates to more than boundary terms, so
   that a pressure neither stiffens nor softens changes of the volume inside an element that the projection does not
   see. With ln J a mean tension above the shear modulus makes them unstable, although the solid is stable; bonded
   bushes stop there.

   Pressures are constant in quad4 and hex8. They are linear in quad9, hex27, tri6 and tet10, in reference coordinates,
   not in those of the parent element: on general quadrilaterals only the former converge at the full order (Arnold,
   Boffi and Falk, Mathematics of Computation 71, 2002). tri6 and tet10 have an inner node besides, whose shape function
   is a bubble that vanishes on all faces (Crouzeix and Raviart, RAIRO 7, 1973). Its displacement is solved for and
   condensed in the element, as enhancedkernel.c does with its modes. Every call starts from no bubble, so that energy,
   force and tangent are functions of u alone.

   Where lambda is large or infinite, a part Pi (kappa ln j / j) of the pressure and a multiplier make up the pressure.
   The caller changes the multiplier until the pressure is right (augmented Lagrangian).

   The geometric part of the tangent may have pressures that are extrapolated from an earlier state
   (stressreference.h): theta there and its linear change on the way, with the bubble's.

   Pressures and multipliers of an element are coefficients of shape functions that are orthonormal over the reference
   volume. Their unit is stress times the root of a volume. */
#include "mixedbubble.h"

/*@
  MixedPoints - counts the points at which a mixed element is integrated.

  Not collective
@*/
int MixedPoints(const Element *e)
{
  return MixedRuleGet(e, 0)->points;
}

/*@
  MixedPointVolumes - computes the reference volumes of these points, as ElementStateVolumes() does.

  Not collective
@*/
void MixedPointVolumes(const Element *e, Geometry geometry, const double *X, double *volume)
{
  const MixedRule *rule = MixedRuleGet(e, 0);
  double           lanes_X[ELEMENT_MAX_NODES * 3 * KERNEL_LANES];

  for (int k = 0; k < e->nodes * e->dim * KERNEL_LANES; k++) lanes_X[k] = X[k / KERNEL_LANES];
  for (int q = 0; q < rule->points; q++) {
    ChunkPoints c;
    Lanes       lanes;

    PointGradients(e->nodes, e->dim, geometry == GEOMETRY_AXISYMMETRIC, rule->N[q], rule->dN[q], rule->weight[q], 0,
                   lanes_X, &c, &lanes);
    volume[q] = lanes[0];
  }
}

/* Copies X and u and gives the inner node neither a place nor a displacement. */
LANES_INLINE void CopyNodes(const BatchCall *call, const int n, const int bubble, const int dim, Mixed *x)
{
  for (int k = 0; k < dim; k++) x->centre[k] = (Lanes){0};
  for (int k = 0; k < n * dim; k++) {
    LANE(x->X, k) = CONST_LANE(call->X, k);
    LANE(x->u, k) = CONST_LANE(call->u, k);
    x->centre[k % dim] += CONST_LANE(call->X, k) / n;
  }
  for (int k = n * dim; k < (n + bubble) * dim; k++) LANE(x->X, k) = LANE(x->u, k) = (Lanes){0};
  for (int k = 0; k < MAX_BUBBLE; k++) x->b[k] = (Lanes){0};
}

/* Computes gradients at the points, displacement gradients without the bubble, and the pressure's shape functions. */
LANES_INLINE void Prepare(const BatchCall *call, const MixedRule *rule, const int n, const int bubble, const int points,
                          const int modes, const int dim, const int hoop, Mixed *x)
{
  const int nodes = n + bubble;

  CopyNodes(call, n, bubble, dim, x);
  for (int q = 0; q < points; q++) {
    const int at = points > CHUNK ? 0 : q;

    PointGradients(nodes, dim, hoop, rule->N[q], rule->dN[q], rule->weight[q], at, x->X, &x->c, &x->volume[q]);
    PointDisplacementGradient(n, dim, hoop, at, x->u, &x->c, x->H[q]);
    for (int k = 0; k < dim + hoop && bubble; k++) x->bubble[q][k] = x->c.g[n][at][k];
    Monomials(nodes, modes, dim, rule->N[q], x, x->shape[q]);
  }
  PressureShapes(points, modes, x);
  x->hold = HoldModulus(call, points);
}

/* Extrapolates the pressures of the geometric part from the state u_0. x has displacement gradients without the
   bubble. */
LANES_INLINE void ReferencePressures(const BatchCall *call, const MixedRule *rule, const int n, const int bubble,
                                     const int points, const int modes, const int dim, const int hoop, Mixed *x)
{
  Mixed y;
  Lanes change[MIXED_PRESSURES], W;

  y.hold = x->hold;
  for (int i = 0; i < MAX_BUBBLE; i++) y.b[i] = (Lanes){0};
  for (int q = 0; q < points; q++) {
    PointGradients(n + bubble, dim, hoop, rule->N[q], rule->dN[q], rule->weight[q], 0, x->X, &y.c, &y.volume[q]);
    PointDisplacementGradient(n, dim, hoop, 0, call->u_0, &y.c, y.H[q]);
    for (int k = 0; k < modes; k++) y.shape[q][k] = x->shape[q][k];
    for (int k = 0; k < dim + hoop && bubble; k++) y.bubble[q][k] = x->bubble[q][k];
  }
  if (bubble) SolveBubble(call, points, modes, dim, hoop, &y);
  for (int k = 0; k < modes; k++) y.theta[k] = change[k] = (Lanes){0};
  for (int q = 0; q < points; q++) {
    Lanes H[9], G[9], dilatation, slope = {0};

    for (int r = 0; r < 9; r++) H[r] = y.H[q][r];
    if (bubble) AddBubble(dim, hoop, y.b, y.bubble[q], H);
    Dilatation(call, H, &dilatation);
    DilatationGradient(call, H, G);
    for (int r = 0; r < 9; r++) slope += G[r] * (x->H[q][r] - y.H[q][r]);
    for (int k = 0; k < modes; k++) {
      y.theta[k] += y.volume[q] * y.shape[q][k] * dilatation;
      change[k] += y.volume[q] * y.shape[q][k] * slope;
    }
  }
  Pressures(call, points, modes, &y, &W);
  for (int k = 0; k < modes; k++) x->geometric[k] = y.p[k];
  if (bubble) FollowBubble(call, points, modes, dim, hoop, x, &y, change);
  for (int k = 0; k < modes; k++) {
    for (int l = 0; l < modes; l++) x->geometric[k] += call->rate * y.C[k][l] * change[l];
    for (int lane = 0; lane < LANES && call->held; lane++) {
      if (call->rest[lane] > 0) x->geometric[k][lane] = Multiplier(call, k)[lane] / call->rest[lane];
    }
  }
}

/* Computes displacement gradients with the bubble, theta, pressures, the energy of the volume and the smallest J. */
LANES_INLINE void SetPressures(const BatchCall *call, const int n, const int bubble, const int points, const int modes,
                               const int dim, const int hoop, Mixed *x, Lanes *W)
{
  for (int k = 0; k < modes; k++) x->theta[k] = (Lanes){0};
  for (int k = 0; k < dim && bubble; k++) LANE(x->u, n * dim + k) = x->b[k];
  for (int q = 0; q < points; q++) {
    Lanes dilatation;

    if (bubble) AddBubble(dim, hoop, x->b, x->bubble[q], x->H[q]);
    Dilatation(call, x->H[q], &dilatation);
    KeepLeastJ(call, &dilatation);
    for (int k = 0; k < modes; k++) x->theta[k] += x->volume[q] * x->shape[q][k] * dilatation;
  }
  Pressures(call, points, modes, x, W);
}

/* Adds t C t^T to the tangent, for the derivatives t of every theta by the displacements. */
LANES_INLINE void AddDilatationTangent(const int dofs, const int modes, const Mixed *x,
                                       double t[MIXED_PRESSURES][ELEMENT_MAX_NODES * 3 * KERNEL_LANES], double *K)
{
  for (int r = 0; r < dofs; r++) {
    Lanes row[MIXED_PRESSURES];

    for (int k = 0; k < modes; k++) {
      row[k] = x->C[k][0] * CONST_LANE(t[0], r);
      for (int l = 1; l < modes; l++) row[k] += x->C[k][l] * CONST_LANE(t[l], r);
    }
    for (int s = r; s < dofs; s++) {
      Lanes value = LANE(K, r * dofs + s);

      for (int k = 0; k < modes; k++) value += row[k] * CONST_LANE(t[k], s);
      LANE(K, r * dofs + s) = value;
      LANE(K, s * dofs + r) = value;
    }
  }
}

/* Writes the tangent of the nodes without the inner node, whose rows are the last: K = Kuu - Kub Kbb^-1 Kbu. Kub is
   overwritten. */
LANES_INLINE void Condense(const int dofs, const int dim, double *full, double *K)
{
  const int all = dofs + dim;

  for (int k = all - 1; k >= dofs; k--) { /* from the last row on, so that the rest is a smaller full tangent */
    const Lanes inverse = 1 / LANE(full, k * all + k);

    for (int r = 0; r < k; r++) {
      const Lanes factor = LANE(full, r * all + k) * inverse;

      for (int s = r; s < k; s++) LANE(full, r * all + s) -= factor * LANE(full, s * all + k);
    }
  }
  for (int r = 0; r < dofs; r++) {
    for (int s = r; s < dofs; s++) {
      LANE(K, r * dofs + s) = LANE(full, r * all + s);
      LANE(K, s * dofs + r) = LANE(full, r * all + s);
    }
  }
}

/* Stores J less its projection at the points. */
LANES_INLINE void StoreOff(const BatchCall *call, const int points, const int modes, const Mixed *x)
{
  for (int q = 0; q < points; q++) {
    Lanes dilatation;

    Dilatation(call, x->H[q], &dilatation);
    LANE(call->off, q) = dilatation - PressureAt(modes, x->theta, x->shape[q]);
  }
}

/* Stores displacement gradient and pressure at the points of the element's table, and the gradients at the points of
   integration before them where all points of the state are asked for. */
LANES_INLINE void StoreOutput(const BatchCall *call, const int n, const int bubble, const int modes, const int dim,
                              const int hoop, Mixed *x)
{
  const MixedRule *rule  = MixedRuleGet(call->e, 1);
  const int        first = call->all && bubble ? MixedPoints(call->e) : 0;

  for (int q = 0; q < first; q++) StorePoint(call, q, x->H[q]);
  for (int q = 0; q < rule->points; q++) {
    Lanes H[9], phi[MIXED_PRESSURES], volume, dilatation;

    PointGradients(n + bubble, dim, hoop, rule->N[q], rule->dN[q], rule->weight[q], 0, x->X, &x->c, &volume);
    PointDisplacementGradient(n + bubble, dim, hoop, 0, x->u, &x->c, H);
    StorePoint(call, first + q, H);
    if (!call->pressure) continue;
    Monomials(n + bubble, modes, dim, rule->N[q], x, phi);
    Orthonormal(modes, x, phi);
    Dilatation(call, H, &dilatation);
    LANE(call->pressure, q) = PressureAt(modes, x->p, phi);
    if (call->finite)
      LANE(call->pressure, q) =
        (1 + dilatation) * CONST_LANE(call->pressure, q) + call->constants[0] * LogVolume(dilatation);
    else
      LANE(call->pressure, q) += call->constants[0] * dilatation;
  }
}

/* Evaluates the points of a chunk, which starts at point `first`: adds to energy and force, and makes the tangents in
   x->c.A. */
LANES_INLINE void EvaluateChunk(const BatchCall *call, const int modes, const int nodes, const int dim, const int hoop,
                                const int first, const int count, Mixed *x, Lanes *W, double *f, const int tangent,
                                double t[MIXED_PRESSURES][ELEMENT_MAX_NODES * 3 * KERNEL_LANES])
{
  for (int at = 0; at < count; at++) {
    const int   q        = first + at;
    const Lanes pressure = PressureAt(modes, x->p, x->shape[q]);
    Lanes       P[9], G[9], D[9], dilatation, energy, geometric;

    Dilatation(call, x->H[q], &dilatation);
    MixedLaw(call, &x->hold, q, x->H[q], &dilatation, call->W ? &energy : NULL, P, tangent ? x->c.A[at] : NULL);
    if (call->W) *W += x->volume[q] * energy;
    DilatationGradient(call, x->H[q], G);
    for (int r = 0; r < 9; r++) P[r] = x->volume[q] * (P[r] + pressure * G[r]);
    if (f) AddForce(nodes, dim, hoop, at, &x->c, P, f);
    if (!tangent) continue;
    geometric = PressureAt(modes, x->geometric, x->shape[q]);
    if (call->finite) AddGeometry(&geometric, x->H[q], x->c.A[at]);
    for (int k = 0; k < MATERIAL_TANGENT_SIZE; k++) x->c.A[at][k] *= x->volume[q];
    for (int k = 0; k < modes; k++) {
      for (int r = 0; r < 9; r++) D[r] = x->volume[q] * x->shape[q][k] * G[r];
      AddForce(nodes, dim, hoop, at, &x->c, D, t[k]);
    }
  }
}

/* Computes energy, force and tangent. n, bubble (1 with an inner node), points, modes, dim and hoop are constants of
   the instance. */
LANES_INLINE void Batch(const BatchCall *call, const int n, const int bubble, const int points, const int modes,
                        const int dim, const int hoop)
{
  const int        nodes = n + bubble, dofs = nodes * dim;
  const MixedRule *rule = MixedRuleGet(call->e, 0);
  double           f[ELEMENT_MAX_NODES * 3 * KERNEL_LANES], t[MIXED_PRESSURES][ELEMENT_MAX_NODES * 3 * KERNEL_LANES];
  double full[bubble ? dofs * dofs * KERNEL_LANES : 1], *const K = bubble && call->K ? full : call->K;
  Lanes W;
  Mixed x;

  for (int i = 0; i < dofs; i++) {
    LANE(f, i) = (Lanes){0};
    for (int k = 0; k < modes && K; k++) LANE(t[k], i) = (Lanes){0};
  }
  Prepare(call, rule, n, bubble, points, modes, dim, hoop, &x);
  if ((K || call->follow) && call->u_0) ReferencePressures(call, rule, n, bubble, points, modes, dim, hoop, &x);
  for (int k = 0; k < modes && call->follow; k++) LANE(call->follow, k) = x.geometric[k];
  if (call->follow) return;
  StartLeastJ(call);
  if (bubble) SolveBubble(call, points, modes, dim, hoop, &x);
  SetPressures(call, n, bubble, points, modes, dim, hoop, &x, &W);
  for (int k = 0; k < modes && !call->u_0; k++) x.geometric[k] = x.p[k];
  for (int first = 0; first < points; first += CHUNK) {
    const int count = points - first < CHUNK ? points - first : CHUNK;
    Lanes     volume;

    for (int at = 0; at < count && points > CHUNK; at++)
      PointGradients(nodes, dim, hoop, rule->N[first + at], rule->dN[first + at], rule->weight[first + at], at, x.X,
                     &x.c, &volume);
    EvaluateChunk(call, modes, nodes, dim, hoop, first, count, &x, &W, call->f ? f : NULL, K != NULL, t);
    if (K) AddTangent(nodes, dim, hoop, count, first == 0, first + count == points, &x.c, K);
  }
  if (call->W) LANE(call->W, 0) = W;
  for (int i = 0; i < n * dim && call->f; i++) LANE(call->f, i) = LANE(f, i);
  if (K) AddDilatationTangent(dofs, modes, &x, t, K);
  if (K && bubble) Condense(n * dim, dim, full, call->K);
  for (int k = 0; k < modes; k++) x.p[k] += x.hold * x.theta[k]; /* results have the volume's alone */
  for (int k = 0; k < modes && call->theta; k++) LANE(call->theta, k) = (x.p[k] - Multiplier(call, k)) / call->kappa;
  if (call->off) StoreOff(call, points, modes, &x);
  if (call->H) StoreOutput(call, n, bubble, modes, dim, hoop, &x);
}

#define BATCH_INSTANCE(name, nodes, bubble, points, modes, dim, hoop) \
  static void name(const BatchCall *call)                             \
  {                                                                   \
    Batch(call, nodes, bubble, points, modes, dim, hoop);             \
  }

BATCH_INSTANCE(BatchTri6, 6, 1, 6, 3, 2, 0)
BATCH_INSTANCE(BatchQuad4, 4, 0, 4, 1, 2, 0)
BATCH_INSTANCE(BatchQuad9, 9, 0, 9, 3, 2, 0)
BATCH_INSTANCE(BatchTri6Axisymmetric, 6, 1, 6, 3, 2, 1)
BATCH_INSTANCE(BatchQuad4Axisymmetric, 4, 0, 4, 1, 2, 1)
BATCH_INSTANCE(BatchQuad9Axisymmetric, 9, 0, 9, 3, 2, 1)
BATCH_INSTANCE(BatchTet10, 10, 1, 14, 4, 3, 0)
BATCH_INSTANCE(BatchHex8, 8, 0, 8, 1, 3, 0)
BATCH_INSTANCE(BatchHex27, 27, 0, 27, 4, 3, 0)

BatchFn *const mixed_batches[ELEMENT_TYPES][2] = {
  [ELEMENT_TRI6]  = {BatchTri6, BatchTri6Axisymmetric},
  [ELEMENT_QUAD4] = {BatchQuad4, BatchQuad4Axisymmetric},
  [ELEMENT_QUAD9] = {BatchQuad9, BatchQuad9Axisymmetric},
  [ELEMENT_TET10] = {BatchTet10, NULL},
  [ELEMENT_HEX8]  = {BatchHex8, NULL},
  [ELEMENT_HEX27] = {BatchHex27, NULL},
};

/* Number of pressures of an element */
const int mixed_pressures[ELEMENT_TYPES] = {
  [ELEMENT_TRI6] = 3,  [ELEMENT_QUAD4] = 1, [ELEMENT_QUAD9] = 3,
  [ELEMENT_TET10] = 4, [ELEMENT_HEX8] = 1,  [ELEMENT_HEX27] = 4,
};
