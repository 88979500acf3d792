/* The diffuse fit: the master surface as a moving weighted least-squares polynomial through fit points, as one slave
   point sees it, with gap, first variation N and second variation M. Plain C: no PETSc, no MPI, no allocation. Source:
   Chamoret, Saillard, Rassineux, Bergheau, "New smoothing procedures in contact mechanics" (2004), eqs 1 to 14.

   DiffuseFitEvaluate() serves function, Jacobian and objective: FitWant says how far it goes. FitWorkspace() tells how
   much workspace it needs. FitSurfaceHeight() and FitShape() serve the offsets of quadrature points. Frame and metric
   (fitframe.h), points and multipliers are contact state, which is held in a solve. The weights are not held: they
   follow the positions.

   The equations, with the slave point x_c as origin, the frame E of tangents and normal, and the metric Q over the
   tangents:
       d_i = E^T (x_i - x_c) = (y_i, z_i),   rho_i^2 = y_i^T Q y_i,   w_i = v_i max(0, 1 - rho_i^2)^exponent
       A = sum w_i p_i p_i^T,   alpha = A^-1 sum w_i p_i z_i,   q(y) = p(y).alpha      (eqs 1 to 8)
       y* + q grad q = 0 at y*,   g = -q(y*) sqrt(1 + |grad q|^2)                      (eq. 9)
       N_i = E (dalpha/dd_i)^T dg/dalpha,   N_c = -sum N_i                             (eqs 11 and 12)
       M = dN/dx                                                                       (eqs 13 and 14)
   p(y) holds all monomials up to the degree. The distance rho is measured in the tangent plane, because weights by the
   distance in space would change with the gap. The differences x_i - x_c are formed as (X_i - X_c) + (u_i - u_c).

   A fit of revolution (degree + FIT_REVOLVED, in 2D) sees a body of revolution. Its points are points of rings, turned
   into the meridian plane: a point at radius r and angle theta has the coordinates (r cos theta, z) there and the
   distance t = r sin theta from it. Then rho_i^2 = Q (s_i^2 + t_i^2), and p holds the monomials s^a t^b with even b up
   to the degree, because the surface is even in t. The slave point and the foot have t = 0. t_i is no unknown.

   A fit in bent coordinates (degree + FIT_BENT, in 3D) serves surfaces whose faces are much longer than wide and run
   along curves, like those of a ring. Seen in the tangent plane the rows of such faces bend aside by more than the
   support is wide, so that a support along straight axes leaves them. With t = along.y
       y' = y - across (h[0] t^2 + h[1] t^4)
   takes the place of y in rho and p. At the slave point both agree, and so do their first derivatives. The bend is
   held like the metric.

   The kernel sees points, never elements or nodes. Only points inside the support take part. The result lists them,
   and N and M run over the slave point and these points. */
#pragma once

/* Guards of the fit. */

/* Smallest |R_kk| of the QR decomposition with unit columns. Below this the points do not carry the polynomial, for
   example because a row is missing at an edge. */
#define FIT_PIVOT 1e-2
/* Largest Lambda, which is the sum of the absolute shape values at the foot. Above this the error of one node
   appears enlarged at the foot. */
#define FIT_AMPLIFIED 3.0
/* Largest rho of the foot. Beyond it the polynomial no longer represents the points. */
#define FIT_REACH 0.5
/* Smallest eigenvalue of J that counts as positive. Below this the slave point is at a centre of curvature. */
#define FIT_FOCAL 1e-8
/* Pivot |R_kk| with unit columns below which there is no fit at all. The variations would keep no more than 6
   digits. */
#define FIT_SINGULAR 1e-10
/* Size of the last Newton step for the foot, in supports. As convergence is quadratic, the next step is below
   rounding. */
#define FIT_FOOT 1e-12
enum {
  /* Newton's method for the foot takes 3 to 5 iterations. More are needed only near a centre of curvature. */
  FIT_ITERATIONS = 20,
  FIT_MAX_TERMS  = 15,
  /* Added to the degree of a fit of revolution. */
  FIT_REVOLVED = 100,
  /* Added to the degree of a fit in bent coordinates. */
  FIT_BENT = 200,
  /* Lists end at this number of points. The kernel itself takes any number. */
  FIT_MAX_POINTS = 512
};

/* The guards that did not hold. They decide on the fall-backs (wider support, lower degree, facet) when lists are
   made and after a solve. */
typedef enum {
  FIT_HOLDS      = 0,
  FIT_NO_SURFACE = 1,  /* fewer points than terms, or the points determine no polynomial: nothing is evaluated */
  FIT_NO_FOOT    = 2,  /* Newton for the foot failed, or J is not positive definite there: no gap, N and M */
  FIT_FAR_FOOT   = 4,  /* the foot lies beyond FIT_REACH */
  FIT_FEW_POINTS = 8,  /* fewer points than FitPointsWanted(), which is meant for nodes as fit points */
  FIT_LOW_PIVOT  = 16, /* a pivot below FIT_PIVOT */
  FIT_HIGH_SUM   = 32  /* Lambda above FIT_AMPLIFIED */
} FitGuard;

/* What is computed. FIT_GAP_ONLY gives the gap without Lambda, its guard and the shape values, because solves do not
   need them, and without what the surface misses its points by. */
typedef enum { FIT_SURFACE, FIT_GAP_ONLY, FIT_GAP, FIT_FIRST_VARIATION, FIT_SECOND_VARIATION } FitWant;

/* FIT_DIFFUSE leaves the derivatives of the weights out of M ("diffuse derivatives"). It affects the tangent only:
   gap and N are exact in both. */
typedef enum { FIT_FULL, FIT_DIFFUSE } FitDerivativeKind;

/* How far a row bends aside at t: the function of FitBend. */
static inline double FitBendAside(const double h[2], double t)
{
  return t * t * (h[0] + t * (t * h[1]));
}

/* How rows of long faces bend in the tangent plane. across is `along`, turned by a right angle to the left. */
typedef struct {
  double along[2]; /* unit vector over the tangents */
  double h[2];     /* of t^2 and t^4 (length^-1, length^-3) */
} FitBend;

typedef struct {
  /* degree 1, 2 or 4; in 2D also FIT_REVOLVED + one of these, in 3D FIT_BENT + one of these */
  int    dim, degree;
  double exponent; /* of the weight, >= 3: it is twice continuously differentiable at the end of the support */
  /* frame[k]: k-th vector; first the dim - 1 tangents, then the normal out of the master. In 2D the third components
     are not read. */
  double frame[3][3];
  /* Q over the tangents, symmetric positive definite, per length squared (2D: [0][0]). */
  double            metric[2][2];
  int               n;
  const double     *x;          /* [n][dim], relative to the slave point */
  const double     *multiplier; /* [n], v > 0 */
  const double     *hoop;       /* [n], t (length), held like the metric; read by a fit of revolution only */
  FitBend           bend;       /* read by a fit in bent coordinates only */
  FitDerivativeKind derivatives;
} FitProblem;

/* The fitted height over the tangent plane. It remains valid after the evaluation. */
typedef struct {
  int dim, degree;
  /* The monomials are taken at the scaled tangent coordinates, scale y. */
  double  scale[2][2];
  FitBend bend;
  double  coefficient[FIT_MAX_TERMS]; /* of the monomials, along the normal (length) */
} FitSurface;

/* The factors of M, for callers that need it over fewer unknowns (fitderivatives.h): M_ij = K_i^T J_j + J_i^T K_j^T
   + the points' own H. The factors lie in the workspace and are valid until that is used again. A row belongs to one
   component of the slave point, which comes first, or of a point inside. It holds the terms of K, the terms of J and
   zeros. The rows of the slave point are minus the sum over the points, and its H is the sum of theirs. */
typedef struct {
  int           dim, degree, n;        /* n: number of points inside */
  int           stride, hessianstride; /* lengths of a row and of an H */
  const double *rows;                  /* [(1 + n)*dim][stride] */
  const double *hessians;              /* [1 + n][hessianstride]: xx xy yy xz yz zz (2D: the first three) */
} FitFactors;

/* Result of one evaluation. The arrays belong to the caller and have room for the problem's n points. N, M, factors
   and shape may be NULL if they are not wanted. */
typedef struct {
  unsigned    guards; /* FitGuard bits of the guards that did not hold */
  FitSurface  surface;
  double      gap;           /* length; negative: penetration */
  double      foot[2];       /* y*, in the frame's tangents (length) */
  double      normal[3];     /* unit, out of the master at the foot; foot = slave point - gap normal */
  double      tangent[2][3]; /* dx/dy at the foot, covariant (2D: [0]) */
  double      J[2][2];       /* I + grad q grad q^T + q Hess q at the foot */
  double      curvature;     /* largest absolute principal curvature at the foot */
  double      reach;         /* rho of the foot */
  double      pivot;         /* smallest |R_kk| of the QR with unit columns */
  double      amplified;     /* Lambda */
  double      missed;        /* largest |e_i| of the points in the inner half of the support (length) */
  int         n, *points;    /* the points inside the support, in the problem's order */
  double     *shape;         /* [n] dq(y*)/dz_i, sum 1 */
  double     *N;             /* [(1 + n)*dim], the slave point first */
  double     *M;             /* [((1 + n)*dim)^2], symmetric */
  FitFactors *factors;       /* used instead of M, only where M is NULL */
} FitResult;

int    FitTerms(int dim, int degree);
int    FitPointsWanted(int dim, int degree);
long   FitWorkspace(int dim, int degree, int n);
int    DiffuseFitEvaluate(const FitProblem *, FitWant, double *workspace, FitResult *);
int    DiffuseFitEvaluateBatch(int n, const FitProblem *, FitWant, double *workspace, FitResult *);
double FitDistance2(int dim, int degree, const double (*metric)[2], const FitBend *, const double *y);
double FitSurfaceHeight(const FitSurface *, const double *y, double *gradient);
int    FitShape(const FitProblem *, int n, const double *y, const double *factor, double *workspace, double *shape);
