/* Smoothers: the master surface as one slave point sees it, with the gap and its first and second variation. Plain C.

   A Smoother is chosen by its name in the scene, and its evaluate() is called for one slave point at a time. It sees
   points, never elements or nodes. Positions are relative to the slave point. The caller knows what a point is made of
   (nodes with weights, an offset, a mirror image). The lists of points and facets do not change within one solve.

   A built-in smoother is a file in this folder that defines a Smoother, and a line in base/choices.h, from which the
   table Smoothers[], the names and the scene's key follow. A program that links the library adds its own smoother
   with SmootherRegister() before it reads a scene. Callers ask the entry of the table what the smoother needs and
   never ask which smoother it is. */
#pragma once
#include "base/choices.h"
#include "smooth/facet.h"
#include "smooth/diffusefit.h"

/* Most smoothers that a program can hold, the built-in ones included. The tables have one more place for the NULL at
   their end. */
#define SMOOTHER_MAX 16
/* Characters of all names together, each with " | " before it, and the final zero. */
#define SMOOTHER_WORDS 512

/* Input of one evaluation. The facets are always given. A smoother that needs fits also gets the points that carry
   the fit, with the frame and the metric that were found when the lists were made. */
typedef struct {
  int               dim, n_points, n_facets;
  const double     *x;      /* [n_points][dim], relative to the slave point (length) */
  const Facet      *facets; /* their nodes index the points */
  int               seed;   /* facet of the previous evaluation, or -1 */
  int               n_fit;  /* the first n_fit points carry the fit; 0: no fit was found here and the facets are used */
  int               degree; /* of the fit's polynomial here */
  double            exponent;       /* of the weight function */
  const double     *multiplier;     /* of the weights of the fit points */
  const double     *hoop;           /* of the fit points, as in FitProblem */
  const double     *frame, *metric; /* 9 and 4 entries as in FitProblem, held in a solve */
  const FitBend    *bend;           /* as in FitProblem; NULL: no fit is bent */
  double            lift;           /* height of the smooth surface over the facets, where these serve (length) */
  FitDerivativeKind derivatives;
  double           *workspace; /* of the size that the smoother's workspace() returned */
} SmootherInput;

/* Result of one evaluation. The arrays belong to the caller, who makes room for the smoother's capacity of points. */
typedef struct {
  double     gap;          /* length; negative: penetration */
  double     normal[3];    /* unit, out of the master at the foot */
  double     beyond;       /* distance of the foot past a free edge of the master (length) */
  int        seed;         /* facet to be tried first in the next evaluation */
  int        facet_served; /* the smoother needs a fit, there is none here, and the facets were used */
  int        n, *points;   /* the points that take part */
  double    *N;            /* [(1 + n)*dim], first variation of the gap, the slave point first */
  double    *M;            /* [((1 + n)*dim)^2], second variation, where factored is 0 */
  int        factored;     /* the second variation is given by its factors instead */
  FitFactors factors;      /* in the workspace, valid until that is used again; see fitderivatives.h */
} SmootherResult;

/* The gap is always computed, and one of the two variations where it is wanted. */
typedef enum { SMOOTHER_GAP, SMOOTHER_FIRST_VARIATION, SMOOTHER_SECOND_VARIATION } SmootherWant;

typedef struct {
  int capacity;       /* most points that can take part */
  int dense_capacity; /* most points of a result that gives M itself and not its factors */
  /* The smoother needs fits: the search finds points, frame and metric for each slave point when it makes lists. */
  int fitted;
  /* Where nothing has moved since the lists were made, the smoother's gap is that of the search's fit. The caller
     may use it and save an evaluation. */
  int search_gap;
  /* Length of the workspace for one evaluation, in doubles; NULL: no workspace. */
  long (*workspace)(int dim);
  /* Returns 0 when the list holds no surface for this slave point. */
  int (*evaluate)(const SmootherInput *, SmootherWant, SmootherResult *);
} Smoother;

#define SMOOTHER_DECLARE(kind, word, object) extern const Smoother object;
SMOOTHERS(SMOOTHER_DECLARE)
#undef SMOOTHER_DECLARE
/* The smoothers in the order of SmootherKind, then the registered ones in the order of registration; NULL at the
   end. */
extern const Smoother *Smoothers[SMOOTHER_MAX + 1];
extern const char     *SmootherNames[SMOOTHER_MAX + 1];
/* The names as " | facet | diffuse" and so on. SMOOTHER_CHOICES is the same without the first bar, as the scene's
   key shows it. */
extern char SmootherWords[SMOOTHER_WORDS];
#define SMOOTHER_CHOICES (&SmootherWords[sizeof " | " - 1])

int SmootherRegister(const char *name, const Smoother *);
int SmootherEvaluate_Facet(const SmootherInput *, SmootherWant, SmootherResult *);
