/* The diffuse smoother's kernel: a master surface as a moving weighted least-squares polynomial through fit points,
   seen from one slave point: gap, first variation N and second variation M. Plain C: no PETSc, no MPI, no allocation.
   Source: Chamoret, Saillard, Rassineux, Bergheau, "New smoothing procedures in contact mechanics" (2004), eqs 1 to 14.

   DiffuseFitEvaluate() serves function, Jacobian and objective; frame and metric (fitframe.h), points and multipliers
   are contact state, held in a solve; the weights follow the positions. The kernel sees points, never elements or
   nodes. Only points inside the support take part: the result lists them, and N and M run over the slave point and
   these.

   In the frame a point is (y, z), the slave point the origin: rho^2 = y^T Q y, w = v max(0, 1 - rho^2)^exponent, height
   q(y) of all monomials up to the degree. Positions are differences x_i - x_c, formed as (X_i - X_c) + (u_i - u_c). */
#pragma once

/* Guards */
#define FIT_PIVOT                                                                                                      \
  1e-2 /* smallest |R_kk| of the QR with unit columns: lower, the points do not carry the polynomial (a row missing at \
          an edge) */
#define FIT_AMPLIFIED                                                                                                  \
  3.0 /* Lambda, the sum of the absolute shape values at the foot: higher, one node's error shows enlarged at the foot \
       */
#define FIT_REACH 0.5 /* rho of the foot: beyond, the polynomial is no longer what the points say */
#define FIT_FOCAL \
  1e-8 /* smallest eigenvalue of J that counts as positive: below, the slave point is at a centre of curvature */
#define FIT_SINGULAR \
  1e-10 /* |R_kk| with unit columns below which there is no fit at all: variations would keep no more than 6 digits */
#define FIT_FOOT 1e-12 /* last Newton step for the foot, in supports: the quadratic next one is below rounding */
enum {
  FIT_ITERATIONS = 20, /* Newton for the foot takes 3 to 5; more means a slave point near a centre of curvature */
  FIT_MAX_TERMS  = 15,
  FIT_MAX_POINTS = 512 /* where lists stop; the kernel itself takes any number */
};

/* What did not hold, for the ladder of fall-backs (wider support, lower degree, facet): to be asked when lists are made
 * and after a solve */
typedef enum {
  FIT_HOLDS      = 0,
  FIT_NO_SURFACE = 1,  /* fewer points than terms, or the points determine no polynomial: nothing is evaluated */
  FIT_NO_FOOT    = 2,  /* Newton for the foot failed, or J is not positive definite there: no gap, N and M */
  FIT_FAR_FOOT   = 4,  /* foot beyond FIT_REACH */
  FIT_FEW_POINTS = 8,  /* fewer points than FitPointsWanted(); meant for nodes as fit points */
  FIT_LOW_PIVOT  = 16, /* below FIT_PIVOT */
  FIT_HIGH_SUM   = 32  /* Lambda above FIT_AMPLIFIED */
} FitGuard;

/* FIT_GAP_ONLY: the gap, but neither Lambda, its guard nor shape values, which solves have no use for */
typedef enum { FIT_SURFACE, FIT_GAP_ONLY, FIT_GAP, FIT_FIRST_VARIATION, FIT_SECOND_VARIATION } FitWant;

/* Tangent only: M with or without the derivatives of the weights ("diffuse derivatives"); gap and N are exact in both.
 */
typedef enum { FIT_FULL, FIT_DIFFUSE } FitDerivativeKind;

typedef struct {
  int    dim, degree;         /* degree 1, 2 or 4 */
  double exponent;            /* of the weight, >= 3: twice continuously differentiable at the end of the support */
  double frame[3][3];         /* frame[k]: k-th vector; dim - 1 tangents, then the normal out of the master (2D: third
                                 components are not read) */
  double        metric[2][2]; /* Q over the tangents, symmetric positive definite, per length squared (2D: [0][0]) */
  int           n;
  const double *x;          /* [n][dim], relative to the slave point */
  const double *multiplier; /* [n], v > 0 */
  FitDerivativeKind derivatives;
} FitProblem;

/* The fitted height over the tangent plane, which outlives the evaluation. */
typedef struct {
  int    dim, degree;
  double scale[2][2];                /* scaled tangent coordinates = scale y: the monomials' arguments */
  double coefficient[FIT_MAX_TERMS]; /* along the normal, a length */
} FitSurface;

/* What M is made of: M_ij = K_i^T J_j + J_i^T K_j^T + the points' own H, for those who need it over fewer unknowns
   (fitmap.h). Lies in the workspace, until that is used again. A row belongs to one component of the slave point
   (first) or of a point inside: terms of K, terms of J, zeros. The slave point's rows are minus the sum over the
   points, its H is the sum. */
typedef struct {
  int           dim, degree, n;        /* n: points inside */
  int           stride, hessianstride; /* lengths of a row and of an H */
  const double *rows;                  /* [(1 + n)*dim][stride] */
  const double *hessians;              /* [1 + n][hessianstride]: xx xy yy xz yz zz (2D: the first three) */
} FitFactors;

/* Arrays belong to the caller, sized for the problem's n points; N, M, factors and shape may be NULL (not wanted). */
typedef struct {
  unsigned    guards; /* of FitGuard: what did not hold */
  FitSurface  surface;
  double      gap;           /* < 0: penetration */
  double      foot[2];       /* y*, in the frame's tangents */
  double      normal[3];     /* unit, out of the master at the foot; foot = slave point - gap normal */
  double      tangent[2][3]; /* dx/dy at the foot, covariant (2D: [0]) */
  double      J[2][2];       /* I + grad q grad q^T + q Hess q at the foot */
  double      curvature;     /* largest absolute principal curvature at the foot */
  double      reach;         /* rho of the foot */
  double      pivot;         /* smallest |R_kk| of the QR with unit columns */
  double      amplified;     /* Lambda */
  int         n, *points;    /* the points inside the support, in the problem's order */
  double     *shape;         /* [n] dq(y*)/dz_i, sum 1 */
  double     *N;             /* [(1 + n)*dim], the slave point first */
  double     *M;             /* [((1 + n)*dim)^2], symmetric */
  FitFactors *factors;       /* instead of M: where M is NULL only */
} FitResult;

int FitTerms(int dim, int degree);
/* Points inside the support that nodes as fit points need. */
int FitPointsWanted(int dim, int degree);
/* Doubles of workspace for one evaluation with n points. */
long FitWorkspace(int dim, int degree, int n);
/* Returns 1 if what was wanted is there (guards may still be set), 0 with FIT_NO_SURFACE or FIT_NO_FOOT. */
int DiffuseFitEvaluate(const FitProblem *, FitWant, double *workspace, FitResult *);
/* Many slave points with one workspace, large enough for each; returns how many have what was wanted. */
int DiffuseFitEvaluateBatch(int n, const FitProblem *, FitWant, double *workspace, FitResult *);
/* Height over tangent coordinates y, and its gradient with respect to them (may be NULL). */
double FitSurfaceHeight(const FitSurface *, const double *y, double *gradient);
/* shape[problem's n] = sum_a factor_a dq(y_a)/dz_i, y: [n][dim - 1]: the height's dependence on the points, weights
 * held. Returns 0 without a surface. */
int FitShape(const FitProblem *, int n, const double *y, const double *factor, double *workspace, double *shape);
