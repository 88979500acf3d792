/* A static tree of axis-aligned boxes for the local part of the contact search. Plain C.

   BoxTreeBuild() makes the tree, BoxTreeBuildFacing() one whose boxes have directions; BoxTreeDestroy() frees it.
   BoxTreeNear() gives all boxes around a point, BoxTreeNearing() also those that may come near it, BoxTreeMeet() all
   that a box meets. BoxTreeClosest() is for a search in which each box that was seen may make the rest superfluous,
   such as that for the closest facet; with directions it leaves out what faces away, and what lies behind. BoxTreeAny()
   asks whether there is any box that BoxTreeClosest() would visit, of those that BoxTreeGather() has found for a group
   of points. The tree keeps what these work with, so that one search runs in it at a time. */
#pragma once

typedef struct _n_Tree *BoxTree;

/* What a search for the closest boxes may leave out because of the side to which its point looks */
typedef struct {
  const double *own;     /* [dim] direction, of any length where `opposed` and `lean` are 0 or INFINITY, otherwise 1 */
  double        opposed; /* boxes of which no direction has a product with `own` below minus this; -INFINITY: none */
  double        behind;  /* boxes farther than this (length) that lie wholly behind the plane through the point */
  double        shift;   /* by this length, */
  double        lean;    /* and by this part of the distance of their farthest corner besides */
} BoxTreeSide;

/* Points that lie and look alike, for BoxTreeGather() */
typedef struct {
  double lower[3], upper[3];         /* corners of a box around the points (length) */
  double own_lower[3], own_upper[3]; /* least and largest components of their sides' directions */
  double behind;                     /* largest one of their sides (length); all else of the sides is the same */
} BoxTreeGroup;

/* How far a point and the boxes may yet move against each other, if they go on as before */
typedef struct {
  const double *way;   /* [dim] how far the point has moved (length); NULL: nothing is known of that */
  double        ahead; /* so many times as far may the point and a box move on against each other, */
  double        aside; /* and by this besides (length), */
  double        most;  /* but no farther than this (length), which counts for all boxes where nothing is known */
} BoxTreeWay;

int    BoxTreeBuild(int dim, int n, const double *lower, const double *upper, BoxTree *tree);
int    BoxTreeBuildFacing(int dim, int n, const double *lower, const double *upper, const double *direction,
                          BoxTree *tree);
void   BoxTreeDestroy(BoxTree *tree);
int    BoxTreeNear(BoxTree, const double *point, double radius, int max, int *found);
int    BoxTreeSetWays(BoxTree, const double *least, const double *largest);
double BoxTreeWayOn(int dim, const BoxTreeWay *way, const double *least, const double *largest);
double BoxTreeApproach(BoxTree, const double *point, const BoxTreeWay *way, double reach);
int    BoxTreeNearing(BoxTree, const double *point, const BoxTreeWay *way, double reach, int max, int *found);
int    BoxTreeMeet(BoxTree, const double *lower, const double *upper, int max, int *found);
void   BoxTreeClosest(BoxTree, const double *point, const BoxTreeSide *side, double *bound,
                      void (*visit)(void *context, int index, double *bound), void *context);
int    BoxTreeGather(BoxTree, const BoxTreeGroup *group, const BoxTreeSide *side, double bound);
int    BoxTreeAny(BoxTree, const double *point, const BoxTreeSide *side, double bound,
                  int (*test)(void *context, int index), void *context);
