/* A balanced binary tree over the boxes. Each node is halved at the median centre along its widest direction until one
   box is left. Where boxes have directions, these count as places besides. The nodes are in one array in preorder: node
   i with n boxes has its left half of n/2 boxes at node i + 1 and the rest at node i + 2 (n/2), so that neither
   children nor ranges are stored. The boxes are halved by their number and not by their place, which keeps the depth at
   log2 n for any boxes, also for equal ones. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/boxtree.h"

enum { MAX_DIM = 3 };
/* Size of the stack of a search. The depth of the tree is log2 n, and n is an int. */
enum { MAX_DEPTH = 64 };
/* Bits in a word of `found` */
enum { WORD = 64 };

/* A subtree: its node and its range of `order`. distance is the squared distance from the point of the search. */
typedef struct {
  double distance;
  int    node, first, count;
} Range;

struct _n_Tree {
  int     dim, n;
  double *box;      /* [2n-1][2][dim]: lower and upper corners of the nodes */
  int    *order;    /* box numbers in the order of the leaves */
  Range  *queue;    /* [n + 1]: heap of BoxTreeClosest(), nearest first, or what BoxTreeGather() has found */
  int     gathered; /* length of that */
  double *facing;   /* [2n-1][2][dim]: lower and upper components of the directions below each node; NULL: none */
  double *ways;     /* [2n-1][2][dim]: least and largest components of the ways below each node; NULL: none */
  /* [n/64 + 1]: a bit for each box that BoxTreeNear() has found; all 0 outside of it */
  unsigned long long *found;
};

/* The boxes while the tree is built */
typedef struct {
  int           dim;
  const double *lower, *upper;
  const double *direction; /* NULL: they have none */
  double        turn;      /* the length that a direction of length 1 counts as */
} Boxes;

/* The place of a box along direction k: that of its centre, or from dim on that of its own direction. */
static double Centre(const Boxes *boxes, int box, int k)
{
  if (k >= boxes->dim) return boxes->turn * boxes->direction[(size_t)box * boxes->dim + k - boxes->dim];
  return 0.5 * boxes->lower[(size_t)box * boxes->dim + k] + 0.5 * boxes->upper[(size_t)box * boxes->dim + k];
}

/* Whether box a comes before box b along direction k. Boxes of equal centres are ordered by number, so that the same
   boxes always give the same tree. */
static int Before(const Boxes *boxes, int k, int a, int b)
{
  const double p = Centre(boxes, a, k), q = Centre(boxes, b, k);

  return p < q || (p == q && a < b);
}

/* fmax() and fmin() are calls of the library, which these are not. No box holds NaN. */
static inline double Larger(double a, double b)
{
  return a > b ? a : b;
}

static inline double Smaller(double a, double b)
{
  return a < b ? a : b;
}

static void Swap(int *a, int *b)
{
  const int keep = *a;

  *a = *b;
  *b = keep;
}

/* Puts the boxes that come first along direction k into the first `half` places (Hoare's selection). */
static void Select(const Boxes *boxes, int k, int *order, int count, int half)
{
  int low = 0, high = count - 1;

  while (low < high) {
    const int pivot = order[low + (high - low) / 2];
    int       i = low, j = high;

    while (i <= j) {
      while (Before(boxes, k, order[i], pivot)) ++i;
      while (Before(boxes, k, pivot, order[j])) --j;
      if (i <= j) Swap(&order[i++], &order[j--]);
    }
    if (half <= j)
      high = j;
    else if (half >= i)
      low = i;
    else
      return;
  }
}

static Range Left(const Range *range)
{
  return (Range){0, range->node + 1, range->first, range->count / 2};
}

static Range Right(const Range *range)
{
  const int half = range->count / 2;

  return (Range){0, range->node + 2 * half, range->first + half, range->count - half};
}

/* How far the places of some boxes lie apart along direction k. */
static double Width(const Boxes *boxes, const int *order, int count, int k)
{
  double low = INFINITY, high = -INFINITY;

  for (int i = 0; i < count; ++i) {
    const double centre = Centre(boxes, order[i], k);

    low  = Smaller(low, centre);
    high = Larger(high, centre);
  }
  return high - low;
}

/* Sets the boxes and the order of a subtree. */
static void BuildRange(BoxTree tree, const Boxes *boxes, Range range)
{
  const int dim   = tree->dim;
  double   *lower = tree->box + (size_t)range.node * 2 * dim, *upper = lower + dim, widest = -1;
  int      *order = tree->order + range.first, along = 0;

  for (int k = 0; k < dim; ++k) {
    lower[k] = INFINITY;
    upper[k] = -INFINITY;
    for (int i = 0; i < range.count; ++i) {
      lower[k] = Smaller(lower[k], boxes->lower[(size_t)order[i] * dim + k]);
      upper[k] = Larger(upper[k], boxes->upper[(size_t)order[i] * dim + k]);
    }
  }
  for (int k = 0; k < (boxes->direction ? 2 : 1) * dim; ++k) {
    const double width = Width(boxes, order, range.count, k);

    if (!(width > widest)) continue;
    widest = width;
    along  = k;
  }
  if (range.count == 1) return;
  Select(boxes, along, order, range.count, range.count / 2);
  BuildRange(tree, boxes, Left(&range));
  BuildRange(tree, boxes, Right(&range));
}

/* Sets the least and largest components below each node of a subtree, from those of the boxes. */
static void Span(BoxTree tree, const double *least, const double *largest, double *nodes, Range range)
{
  const int dim  = tree->dim;
  double   *mine = nodes + (size_t)range.node * 2 * dim;
  Range     half[2];

  for (int k = 0; k < dim; ++k) {
    mine[k]       = least[(size_t)tree->order[range.first] * dim + k];
    mine[dim + k] = largest[(size_t)tree->order[range.first] * dim + k];
  }
  if (range.count == 1) return;
  half[0] = Left(&range);
  half[1] = Right(&range);
  for (int i = 0; i < 2; ++i) {
    const double *below = nodes + (size_t)half[i].node * 2 * dim;

    Span(tree, least, largest, nodes, half[i]);
    for (int k = 0; k < dim; ++k) {
      mine[k]       = Smaller(mine[k], below[k]);
      mine[dim + k] = Larger(mine[dim + k], below[dim + k]);
    }
  }
}

/*@
  BoxTreeBuild - builds the tree of some boxes

  Not collective, plain C

  Input Parameters:
+ dim   - 1 to 3
. n     - number of boxes, which may be 0
. lower - [n][dim] lower corners (length), not kept
- upper - [n][dim] upper corners (length), not kept

  Output Parameter:
. tree - freed with BoxTreeDestroy(); NULL without memory

  Note:
  Returns 0, or 1 if there is not enough memory.
@*/
int BoxTreeBuild(int dim, int n, const double *lower, const double *upper, BoxTree *tree)
{
  return BoxTreeBuildFacing(dim, n, lower, upper, NULL, tree);
}

/*@
  BoxTreeBuildFacing - builds the tree of some boxes that have directions, for BoxTreeClosest() with a side

  Not collective, plain C

  Input Parameters:
+ dim       - 1 to 3
. n         - number of boxes, which may be 0
. lower     - [n][dim] lower corners (length), not kept
. upper     - [n][dim] upper corners (length), not kept
- direction - [n][dim] of length 1, not kept; NULL: as BoxTreeBuild() does

  Output Parameter:
. tree - freed with BoxTreeDestroy(); NULL without memory

  Notes:
  Returns 0, or 1 if there is not enough memory.

  Boxes that look different ways go to different halves: turned round, a direction counts as much as the whole width of
  the boxes. What looks away from a point is left out as a whole then, and the far side of a sheet as what lies behind.
@*/
int BoxTreeBuildFacing(int dim, int n, const double *lower, const double *upper, const double *direction, BoxTree *tree)
{
  const size_t nodes = (size_t)2 * n + 1;
  Boxes        boxes = {dim, lower, upper, direction, 0};
  BoxTree      t     = calloc(1, sizeof(*t));

  *tree = t;
  if (!t) return 1;
  t->dim   = dim;
  t->n     = n;
  t->box   = malloc(sizeof(*t->box) * nodes * 2 * dim);
  t->order = malloc(sizeof(*t->order) * ((size_t)n + 1));
  t->queue = malloc(sizeof(*t->queue) * ((size_t)n + 1));
  t->found = calloc((size_t)n / WORD + 1, sizeof(*t->found));
  if (direction) t->facing = malloc(sizeof(*t->facing) * nodes * 2 * dim);
  if (!t->box || !t->order || !t->queue || !t->found || (direction && !t->facing)) {
    BoxTreeDestroy(tree);
    return 1;
  }
  for (int i = 0; i < n; ++i) t->order[i] = i;
  for (int k = 0; k < dim && n; ++k) boxes.turn = Larger(boxes.turn, Width(&boxes, t->order, n, k) / 2);
  if (n) BuildRange(t, &boxes, (Range){0, 0, 0, n});
  if (n && direction) Span(t, direction, direction, t->facing, (Range){0, 0, 0, n});
  return 0;
}

/*@
  BoxTreeDestroy - frees the tree and sets it to NULL

  Not collective, plain C

  Input Parameter:
. tree - may be NULL already
@*/
void BoxTreeDestroy(BoxTree *tree)
{
  if (!*tree) return;
  free((*tree)->box);
  free((*tree)->order);
  free((*tree)->queue);
  free((*tree)->facing);
  free((*tree)->ways);
  free((*tree)->found);
  free(*tree);
  *tree = NULL;
}

/* Squared distance of a node's box from a point; 0 inside of the box. */
static double SquaredDistance(BoxTree tree, int node, const double *point)
{
  const double *lower = tree->box + (size_t)node * 2 * tree->dim, *upper = lower + tree->dim;
  double        sum = 0;

  for (int k = 0; k < tree->dim; ++k) {
    const double d = Larger(0, Larger(lower[k] - point[k], point[k] - upper[k]));

    sum += d * d;
  }
  return sum;
}

/* Writes the numbers of the bits in some words in ascending order, the first max of them, and clears the words. */
static void TakeFound(unsigned long long *words, int first, int last, int max, int *found)
{
  int written = 0;

  for (int w = first; w <= last; ++w) {
    for (; words[w] && written < max; words[w] &= words[w] - 1) found[written++] = w * WORD + __builtin_ctzll(words[w]);
    words[w] = 0;
  }
}

/*@
  BoxTreeNear - finds all boxes that are nearer to a point than a radius

  Not collective, plain C

  Input Parameters:
+ tree   - the tree
. point  - [dim] coordinates (length)
. radius - a length
- max    - room in found

  Output Parameter:
. found - numbers of the boxes in ascending order, the first max of them

  Note:
  Returns how many boxes there are, which may be more than max.
@*/
int BoxTreeNear(BoxTree tree, const double *point, double radius, int max, int *found)
{
  return BoxTreeNearing(tree, point, &(BoxTreeWay){NULL, 0, 0, 0}, radius, max, found);
}

/*@
  BoxTreeSetWays - says how far the boxes have moved

  Not collective, plain C

  Input Parameters:
+ tree    - the tree
. least   - [n][dim] least components of what points of a box have moved (length), not kept
- largest - [n][dim] largest ones

  Note:
  Returns 0, or 1 if there is not enough memory.
@*/
int BoxTreeSetWays(BoxTree tree, const double *least, const double *largest)
{
  tree->ways = malloc(sizeof(*tree->ways) * ((size_t)2 * tree->n + 1) * 2 * tree->dim);
  if (!tree->ways) return 1;
  if (tree->n) Span(tree, least, largest, tree->ways, (Range){0, 0, 0, tree->n});
  return 0;
}

/*@
  BoxTreeWayOn - bounds how far a point and what moves in a range of ways may yet move against each other

  Not collective, plain C

  Input Parameters:
+ dim     - dimension
. way     - how both move
. least   - [dim] least components of how far that has moved (length); not read if nothing is known of the point
- largest - [dim] largest ones

  Note:
  Returns that motion (length).
@*/
double BoxTreeWayOn(int dim, const BoxTreeWay *way, const double *least, const double *largest)
{
  double square = 0;

  if (!way->way) return way->most;
  for (int k = 0; k < dim; ++k) {
    const double d = Larger(way->way[k] - least[k], largest[k] - way->way[k]);

    square += d * d;
  }
  return Smaller(way->most, way->ahead * sqrt(square) + way->aside);
}

/* How far a point and any box below a node may move against each other. */
static double Approach(BoxTree tree, int node, const BoxTreeWay *way)
{
  const double *least = way->way ? tree->ways + (size_t)node * 2 * tree->dim : NULL;

  return BoxTreeWayOn(tree->dim, way, least, least ? least + tree->dim : NULL);
}

/* May a point and a box below a node come within reach of each other? */
static int MayNear(BoxTree tree, int node, const double *point, const BoxTreeWay *way, double reach)
{
  const double square = SquaredDistance(tree, node, point), farthest = reach + way->most;

  if (square >= farthest * farthest) return 0;
  return (reach > 0 && square < reach * reach) || sqrt(square) < reach + Approach(tree, node, way);
}

/*@
  BoxTreeApproach - bounds how far the boxes that may come within reach of a point, and the point, move against each
  other

  Not collective, plain C

  Input Parameters:
+ tree  - the tree, after BoxTreeSetWays() if anything is known of the point's way
. point - [dim] coordinates (length)
. way   - how both move
- reach - a length

  Note:
  Returns the largest such motion (length), or -1 if no box may come within reach.
@*/
double BoxTreeApproach(BoxTree tree, const double *point, const BoxTreeWay *way, double reach)
{
  Range  stack[MAX_DEPTH];
  int    depth = 0;
  double most  = -1;

  if (tree->n) stack[depth++] = (Range){0, 0, 0, tree->n};
  while (depth) {
    const Range  range    = stack[--depth];
    const double approach = Approach(tree, range.node, way);

    if (approach <= most || !MayNear(tree, range.node, point, way, reach)) continue;
    if (range.count == 1)
      most = approach;
    else {
      stack[depth++] = Right(&range);
      stack[depth++] = Left(&range);
    }
  }
  return most;
}

/*@
  BoxTreeNearing - finds all boxes that are within reach of a point or may come there

  Not collective, plain C

  Input Parameters:
+ tree  - the tree, after BoxTreeSetWays() if anything is known of the point's way
. point - [dim] coordinates (length)
. way   - how both move
. reach - a length
- max   - room in found

  Output Parameter:
. found - numbers of the boxes in ascending order, the first max of them

  Note:
  Returns how many boxes there are, which may be more than max.
@*/
int BoxTreeNearing(BoxTree tree, const double *point, const BoxTreeWay *way, double reach, int max, int *found)
{
  Range stack[MAX_DEPTH];
  int   depth = 0, count = 0, first = tree->n / WORD, last = 0;

  if (!tree->n || reach + way->most <= 0) return 0;
  stack[depth++] = (Range){0, 0, 0, tree->n};
  while (depth) {
    const Range range = stack[--depth];

    if (!MayNear(tree, range.node, point, way, reach)) continue;
    if (range.count == 1) {
      const int box = tree->order[range.first], word = box / WORD;

      tree->found[word] |= 1ull << box % WORD;
      if (word < first) first = word;
      if (word > last) last = word;
      ++count;
    } else {
      stack[depth++] = Right(&range);
      stack[depth++] = Left(&range);
    }
  }
  TakeFound(tree->found, first, last, max, found);
  return count;
}

/* Does a node's box meet a box? They do where they touch. */
static int Meets(BoxTree tree, int node, const double *low, const double *high)
{
  const double *lower = tree->box + (size_t)node * 2 * tree->dim, *upper = lower + tree->dim;

  for (int k = 0; k < tree->dim; ++k)
    if (lower[k] > high[k] || low[k] > upper[k]) return 0;
  return 1;
}

/*@
  BoxTreeMeet - finds all boxes that meet or touch a box

  Not collective, plain C

  Input Parameters:
+ tree  - the tree
. lower - [dim] lower corner of the box (length)
. upper - [dim] upper corner (length)
- max   - room in found

  Output Parameter:
. found - numbers of the boxes, max of them, in the same order for the same boxes

  Note:
  Returns how many boxes there are, which may be more than max.
@*/
int BoxTreeMeet(BoxTree tree, const double *lower, const double *upper, int max, int *found)
{
  Range stack[MAX_DEPTH];
  int   depth = 0, count = 0;

  if (!tree->n) return 0;
  stack[depth++] = (Range){0, 0, 0, tree->n};
  while (depth) {
    const Range range = stack[--depth];

    if (!Meets(tree, range.node, lower, upper)) continue;
    if (range.count == 1) {
      if (count < max) found[count] = tree->order[range.first];
      ++count;
    } else {
      stack[depth++] = Right(&range);
      stack[depth++] = Left(&range);
    }
  }
  return count;
}

/* Order of the queue: by distance, then subtrees before boxes, because a subtree may hold a box that is as near, then
   by number. */
static int Nearer(BoxTree tree, const Range *a, const Range *b)
{
  if (a->distance != b->distance) return a->distance < b->distance;
  if ((a->count == 1) != (b->count == 1)) return a->count > 1;
  return a->count == 1 ? tree->order[a->first] < tree->order[b->first] : a->node < b->node;
}

/* May a direction below a node be opposed to the side's own one? */
static int MayOppose(BoxTree tree, int node, const BoxTreeSide *side)
{
  const double *own = side->own, *lower = tree->facing + (size_t)node * 2 * tree->dim, *upper = lower + tree->dim;
  double        most = 0;

  for (int k = 0; k < tree->dim; ++k) most += Larger(-own[k] * lower[k], -own[k] * upper[k]);
  return most > side->opposed;
}

/* Is a node's box wholly behind the plane through the point across the side's own direction? */
static int IsBehind(BoxTree tree, int node, const double *point, const BoxTreeSide *side)
{
  const double *own = side->own, *lower = tree->box + (size_t)node * 2 * tree->dim, *upper = lower + tree->dim;
  double        most = 0, square = 0;

  for (int k = 0; k < tree->dim; ++k) most += own[k] * ((own[k] > 0 ? upper[k] : lower[k]) - point[k]);
  if (!(most < -side->shift) || side->lean == 0) return most < -side->shift;
  for (int k = 0; k < tree->dim; ++k) {
    const double farther = Larger(fabs(lower[k] - point[k]), fabs(upper[k] - point[k]));

    square += farther * farther;
  }
  return most < -side->shift - side->lean * sqrt(square);
}

/* May a point see a node's box at this squared distance? side: NULL: it sees all boxes within the bound. */
static int PointSees(BoxTree tree, int node, double distance, const double *point, const BoxTreeSide *side,
                     double bound)
{
  if (distance > bound * bound) return 0;
  if (!side) return 1;
  if (side->opposed > -INFINITY && !MayOppose(tree, node, side)) return 0;
  return distance <= side->behind * side->behind || !IsBehind(tree, node, point, side);
}

/* Adds a subtree to the queue and returns the new length. One that is beyond the bound, or that the side of the point
   leaves out, is not added. */
static int Push(BoxTree tree, Range range, const double *point, const BoxTreeSide *side, double bound, int length)
{
  Range *queue = tree->queue;
  int    i     = length;

  range.distance = SquaredDistance(tree, range.node, point);
  if (!PointSees(tree, range.node, range.distance, point, side, bound)) return length;
  for (; i > 0 && Nearer(tree, &range, &queue[(i - 1) / 2]); i = (i - 1) / 2) queue[i] = queue[(i - 1) / 2];
  queue[i] = range;
  return length + 1;
}

/* Takes the nearest subtree out of the queue of that length. */
static Range Pop(BoxTree tree, int length)
{
  Range      *queue = tree->queue;
  const Range top = queue[0], last = queue[length - 1];
  int         i = 0;

  for (int child = 1; child < length - 1; child = 2 * i + 1) {
    if (child + 1 < length - 1 && Nearer(tree, &queue[child + 1], &queue[child])) ++child;
    if (!Nearer(tree, &queue[child], &last)) break;
    queue[i] = queue[child];
    i        = child;
  }
  queue[i] = last;
  return top;
}

/*@
  BoxTreeClosest - visits boxes in the order of their distance from a point, as long as that is at most a bound

  Not collective, plain C

  Input Parameters:
+ tree    - the tree
. point   - [dim] coordinates (length)
. side    - which boxes may be left out besides; NULL: all are visited
. bound   - largest distance (length), which may be INFINITY
. visit   - is called with the context, the number of a box and the bound, which it may lower
- context - for visit

  Note:
  Boxes of equal distance are visited by number. A box whose distance equals the bound is visited too, so that of two
  equally near facets both are seen. visit must not call BoxTreeClosest() on the same tree, which keeps the queue.
  A side that asks for opposed directions needs BoxTreeBuildFacing().
@*/
void BoxTreeClosest(BoxTree tree, const double *point, const BoxTreeSide *side, double *bound,
                    void (*visit)(void *context, int index, double *bound), void *context)
{
  int length = tree->n ? Push(tree, (Range){0, 0, 0, tree->n}, point, side, *bound, 0) : 0;

  while (length) {
    const Range range = Pop(tree, length--);

    if (range.distance > *bound * *bound || *bound < 0) return;
    if (range.count == 1)
      visit(context, tree->order[range.first], bound);
    else {
      length = Push(tree, Left(&range), point, side, *bound, length);
      length = Push(tree, Right(&range), point, side, *bound, length);
    }
  }
}

/* Largest product of two numbers of which each is in an interval. */
static double LargestProduct(double low, double high, double least, double most)
{
  return Larger(Larger(low * least, low * most), Larger(high * least, high * most));
}

/* May any point of a group see a box below a node? The same bounds as for a point, of all points. */
static int GroupMaySee(BoxTree tree, int node, const BoxTreeGroup *group, const BoxTreeSide *side, double bound)
{
  const double *lower = tree->box + (size_t)node * 2 * tree->dim, *upper = lower + tree->dim;
  const double *facing   = tree->facing ? tree->facing + (size_t)node * 2 * tree->dim : NULL;
  double        distance = 0, opposed = 0, height = 0, square = 0;

  for (int k = 0; k < tree->dim; ++k) {
    const double apart = Larger(0, Larger(lower[k] - group->upper[k], group->lower[k] - upper[k]));
    const double least = lower[k] - group->upper[k], most = upper[k] - group->lower[k];
    const double farther = Larger(fabs(least), fabs(most)), low = group->own_lower[k], high = group->own_upper[k];

    distance += apart * apart;
    square += farther * farther;
    height += LargestProduct(low, high, least, most);
    if (facing) opposed += LargestProduct(-high, -low, facing[k], facing[tree->dim + k]);
  }
  if (distance > bound * bound) return 0;
  if (side->opposed > -INFINITY && !(opposed > side->opposed)) return 0;
  return distance <= group->behind * group->behind ||
         !(height < -side->shift - (side->lean == 0 ? 0 : side->lean * sqrt(square)));
}

/*@
  BoxTreeGather - finds the boxes that any point of a group may see, for BoxTreeAny()

  Not collective, plain C

  Input Parameters:
+ tree  - the tree
. group - the points
. side  - what is the same for all of them: opposed, shift and lean; the rest is not read
- bound - largest distance (length)

  Note:
  Returns how many there are. The tree keeps them to the next search with BoxTreeClosest().
@*/
int BoxTreeGather(BoxTree tree, const BoxTreeGroup *group, const BoxTreeSide *side, double bound)
{
  Range stack[MAX_DEPTH];
  int   depth = 0;

  tree->gathered = 0;
  if (tree->n) stack[depth++] = (Range){0, 0, 0, tree->n};
  while (depth) {
    const Range range = stack[--depth];

    if (!GroupMaySee(tree, range.node, group, side, bound)) continue;
    if (range.count == 1)
      tree->queue[tree->gathered++] = range;
    else {
      stack[depth++] = Right(&range);
      stack[depth++] = Left(&range);
    }
  }
  return tree->gathered;
}

/*@
  BoxTreeAny - says whether any box passes a test that a point sees, of those that BoxTreeGather() has found

  Not collective, plain C

  Input Parameters:
+ tree    - the tree
. point   - [dim] coordinates (length)
. side    - which boxes the point does not see
. bound   - largest distance (length)
. test    - is called with the context and the number of a box, and says whether it passes
- context - for test

  Note:
  The box that passes is the first one for the next point, which often sees it too.
@*/
int BoxTreeAny(BoxTree tree, const double *point, const BoxTreeSide *side, double bound,
               int (*test)(void *context, int index), void *context)
{
  for (int i = 0; i < tree->gathered; ++i) {
    const Range  range    = tree->queue[i];
    const double distance = SquaredDistance(tree, range.node, point);

    if (!PointSees(tree, range.node, distance, point, side, bound)) continue;
    if (!test(context, tree->order[range.first])) continue;
    tree->queue[i] = tree->queue[0];
    tree->queue[0] = range;
    return 1;
  }
  return 0;
}
