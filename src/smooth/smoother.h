/* What a contact surface looks like from one slave point: gap, first and second variation. Plain C, chosen by name; a
   new smoother is a file that defines a Smoother and a line in choices.h.

   A smoother sees points, never elements or nodes: x is relative to the slave point, and what a point is made of (nodes
   with weights, an offset, a mirror image) is the caller's business. Lists are frozen while a solve lasts. */
#pragma once
#include "base/choices.h"
#include "smooth/facet.h"
#include "smooth/diffusefit.h"

typedef struct {
  int           dim, n_points, n_facets;
  const double *x;      /* [n_points][dim], relative to the slave point */
  const Facet  *facets; /* nodes index the points */
  int           seed;   /* the facet of last time, or -1 */
  /* smooth surfaces: the first n_fit points carry the fit; 0: the facets serve */
  int               n_fit, degree;
  double            exponent;
  const double     *multiplier;     /* of the fit points' weights */
  const double     *frame, *metric; /* 9 and 4, held in a solve */
  FitDerivativeKind derivatives;
  double           *workspace; /* FitWorkspace(dim, degree, n_fit) */
} SmootherInput;

/* Arrays belong to the caller, sized for the smoother's capacity of points. */
typedef struct {
  double     gap;          /* < 0: penetration */
  double     normal[3];    /* out of the master at the foot */
  double     beyond;       /* how far the foot lies past a free edge of the master (a length) */
  int        seed;         /* for the next evaluation */
  int        facet_served; /* a smooth surface was asked for and had no foot here: the facets answered */
  int        n, *points;   /* the points that take part */
  double    *N;            /* [(1 + n)*dim], the slave point first */
  double    *M;            /* [((1 + n)*dim)^2], or ... */
  int        factored;     /* ... its factors instead, in the workspace until that is used again (fitmap.h) */
  FitFactors factors;
} SmootherResult;

/* The gap always, and one of the two variations */
typedef enum { SMOOTHER_GAP, SMOOTHER_FIRST_VARIATION, SMOOTHER_SECOND_VARIATION } SmootherWant;

typedef struct {
  int capacity; /* the most points that can take part */
  int smooth;   /* works on fits: needs neighbourhoods */
  /* returns 0 when the list holds no surface for this slave point */
  int (*evaluate)(const SmootherInput *, SmootherWant, SmootherResult *);
} Smoother;

#define SMOOTHER_DECLARE(kind, word, object) extern const Smoother object;
SMOOTHERS(SMOOTHER_DECLARE)
#undef SMOOTHER_DECLARE
extern const Smoother *const Smoothers[]; /* by SmootherKind */
extern const char *const     SmootherNames[];
int                          SmootherEvaluate_Facet(const SmootherInput *, SmootherWant,
                                                    SmootherResult *); /* what a smooth surface falls back on */
