/* What a contact surface looks like from one slave point: gap, first and second variation of the gap. Plain C.

   A Smoother is chosen by its name in the scene. It sees points, never elements or nodes: positions are relative to the
   slave point, and what a point is made of (nodes with weights, an offset, a mirror image) is the caller's business.
   The lists of points and facets do not change within one solve.

   A built-in smoother is a file in this folder that defines a Smoother and a line in base/choices.h, from which the
   table Smoothers[], the names and the scene's key follow. A program that links the library adds one of its own with
   SmootherRegister() before it reads a scene. Callers ask the entry of the table what the smoother needs and never ask
   which smoother it is. */
#pragma once
#include "base/choices.h"
#include "smooth/facet.h"
#include "smooth/diffusefit.h"

/* Smoothers that a program can hold, the built-in ones included. The tables have one place more, for the NULL at their
 * end. */
#define SMOOTHER_MAX 16
/* Characters of all names together, each with " | " before it, and the final zero. */
#define SMOOTHER_WORDS 512

/* What is given. The facets are always there. A smoother that needs fits also gets the points that carry the fit, with
   the frame and the metric that were found when the lists were made. */
typedef struct {
  int               dim, n_points, n_facets;
  const double     *x;        /* [n_points][dim], relative to the slave point (length) */
  const Facet      *facets;   /* their nodes index the points */
  int               seed;     /* facet of the previous evaluation, or -1 */
  int               n_fit;    /* the first n_fit points carry the fit; 0: no fit was found here and the facets serve */
  int               degree;   /* of the fit's polynomial here */
  double            exponent; /* of the weight function */
  const double     *multiplier;     /* of the weights of the fit points */
  const double     *frame, *metric; /* 9 and 4 entries as in FitProblem, held in a solve */
  FitDerivativeKind derivatives;
  double           *workspace; /* what the smoother's workspace() asked for */
} SmootherInput;

/* What is found. The arrays belong to the caller, who makes room for the smoother's capacity of points. */
typedef struct {
  double     gap;          /* length; negative: penetration */
  double     normal[3];    /* unit, out of the master at the foot */
  double     beyond;       /* how far the foot lies past a free edge of the master (length) */
  int        seed;         /* for the next evaluation */
  int        facet_served; /* the smoother needs a fit, there is none here, and the facets answered */
  int        n, *points;   /* the points that take part */
  double    *N;            /* [(1 + n)*dim], first variation of the gap, the slave point first */
  double    *M;            /* [((1 + n)*dim)^2], second variation, where factored is 0 */
  int        factored;     /* the second variation is given by its factors instead */
  FitFactors factors;      /* they lie in the workspace until that is used again; see fitderivatives.h */
} SmootherResult;

/* The gap is always found; one of the two variations may be wanted as well. */
typedef enum { SMOOTHER_GAP, SMOOTHER_FIRST_VARIATION, SMOOTHER_SECOND_VARIATION } SmootherWant;

typedef struct {
  int capacity;       /* the most points that can take part */
  int dense_capacity; /* the most points of a result that gives M itself and not its factors */
  int fitted;     /* needs fits: the search finds points, frame and metric for each slave point when it makes lists */
  int search_gap; /* its gap where nothing has moved since the lists were made is the one that the search's fit has:
                     the caller may take that one and save an evaluation */
  long (*workspace)(int dim); /* numbers of workspace for one evaluation; NULL: none */
  /* returns 0 when the list holds no surface for this slave point */
  int (*evaluate)(const SmootherInput *, SmootherWant, SmootherResult *);
} Smoother;

#define SMOOTHER_DECLARE(kind, word, object) extern const Smoother object;
SMOOTHERS(SMOOTHER_DECLARE)
#undef SMOOTHER_DECLARE
/* By SmootherKind, then those that were registered, in that order; NULL at the end. */
extern const Smoother *Smoothers[SMOOTHER_MAX + 1];
extern const char     *SmootherNames[SMOOTHER_MAX + 1];
/* " | facet | diffuse" and so on; SMOOTHER_CHOICES are the words of the scene's key without the first bar. */
extern char SmootherWords[SMOOTHER_WORDS];
#define SMOOTHER_CHOICES (&SmootherWords[sizeof " | " - 1])

int SmootherRegister(const char *name, const Smoother *);
int SmootherEvaluate_Facet(const SmootherInput *, SmootherWant, SmootherResult *);
