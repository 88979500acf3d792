/* A static tree of axis-aligned boxes for the local part of the contact search. Plain C; the only allocation is in
   BoxTreeBuild().

   BoxTreeNear() when all boxes around a point are wanted, BoxTreeClosest() when each box seen may make the rest
   superfluous. The tree keeps BoxTreeClosest()'s queue: one search in it at a time, and none from within visit. */
#pragma once

typedef struct _n_Tree *BoxTree;

/* lower, upper: [n][dim], copied; n may be 0 */
int  BoxTreeBuild(int dim, int n, const double *lower, const double *upper,
                  BoxTree *tree); /* 0 on success, else out of memory */
void BoxTreeDestroy(BoxTree *tree);
/* Indices of all boxes that come nearer than radius to point, ascending; the first max of them are written; returns how
 * many there are. */
int BoxTreeNear(BoxTree, const double *point, double radius, int max, int *found);
/* Calls visit(context, index, bound) on boxes in order of growing distance (of equal ones, growing index) while their
   distance is at most the bound, which may be INFINITY and which visit shrinks. For the closest facet: a box that only
   ties is visited too. */
void BoxTreeClosest(BoxTree, const double *point, double *bound, void (*visit)(void *context, int index, double *bound),
                    void *context);
