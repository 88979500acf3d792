/* The tree of boxes finds the same boxes as a loop over all of them, and the search for the closest one visits few. */
#include <math.h>
#include <string.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>
#include "base/boxtree.h"

enum { MAX_BOXES = 3000 };

static double lower[3 * MAX_BOXES], upper[3 * MAX_BOXES];

static double Random(double low, double high)
{
  static uint64_t state = 88172645463325252u;

  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return low + (high - low) * (double)(state >> 11) / 9007199254740992.0;
}

static double BoxDistance(int dim, int i, const double *point)
{
  double sum = 0;

  for (int k = 0; k < dim; ++k)
    sum += pow(fmax(0, fmax(lower[i * dim + k] - point[k], point[k] - upper[i * dim + k])), 2);
  return sqrt(sum);
}

static void RandomBoxes(int dim, int n, double size)
{
  for (int i = 0; i < n * dim; ++i) {
    lower[i] = Random(0, 1);
    upper[i] = lower[i] + Random(0, size);
  }
}

static void CheckNear(int dim, int n, BoxTree tree, const double *point, double radius, int max)
{
  static int found[MAX_BOXES];
  int        count = 0;
  const int  there = BoxTreeNear(tree, point, radius, max, found);

  for (int i = 0; i < n; ++i) {
    if (BoxDistance(dim, i, point) >= radius) continue;
    if (count < max) assert_int_equal(found[count], i);
    ++count;
  }
  assert_int_equal(there, count);
}

static void CheckMeet(int dim, int n, BoxTree tree)
{
  static int  found[MAX_BOXES];
  static char has[MAX_BOXES];
  double      low[3], high[3];
  int         count, few;

  for (int k = 0; k < 3; ++k) {
    low[k]  = Random(-0.5, 1.5);
    high[k] = low[k] + Random(0, 0.5);
  }
  count = BoxTreeMeet(tree, low, high, MAX_BOXES, found);
  for (int i = 0; i < n; ++i) has[i] = 0;
  for (int i = 0; i < count; ++i) has[found[i]] = 1;
  for (int i = 0; i < n; ++i) {
    int meets = 1;

    for (int k = 0; k < dim; ++k) meets &= lower[i * dim + k] <= high[k] && upper[i * dim + k] >= low[k];
    assert_int_equal(has[i], meets);
    count -= meets;
  }
  assert_int_equal(count, 0);
  few = BoxTreeMeet(tree, low, high, 2, found);
  assert_true(few <= n);
}

static void TestNear(void **state)
{
  static const int sizes[] = {0, 1, 2, 3, 7, 100, 1000};

  (void)state;
  for (int dim = 1; dim <= 3; ++dim) {
    for (int s = 0; s < 7; ++s) {
      BoxTree tree;

      RandomBoxes(dim, sizes[s], 0.1);
      assert_int_equal(BoxTreeBuild(dim, sizes[s], lower, upper, &tree), 0);
      for (int trial = 0; trial < 50; ++trial) {
        const double point[3] = {Random(-0.5, 1.5), Random(-0.5, 1.5), Random(-0.5, 1.5)};

        CheckNear(dim, sizes[s], tree, point, Random(0, 0.5), MAX_BOXES);
        CheckNear(dim, sizes[s], tree, point, Random(0, 0.5), 5);
        CheckNear(dim, sizes[s], tree, point, INFINITY, 3);
        CheckNear(dim, sizes[s], tree, point, 0, 3);
        CheckMeet(dim, sizes[s], tree);
      }
      BoxTreeDestroy(&tree);
      assert_null(tree);
    }
  }
}

typedef struct {
  int           dim, visited, last, shrink, best;
  const double *point;
  double        distance, least;
} Search;

/* Checks the order of the visits. Shrinks the bound to the least distance of an object inside the box, which here is
   its centre. */
static void Visit(void *context, int index, double *bound)
{
  Search      *search   = context;
  const double distance = BoxDistance(search->dim, index, search->point);
  double       centre   = 0;

  assert_true(distance >= search->distance - 1e-15);
  if (search->visited && distance == search->distance) assert_true(index > search->last);
  assert_true(distance <= *bound + 1e-15);
  search->distance = distance;
  search->last     = index;
  ++search->visited;
  for (int k = 0; k < search->dim; ++k)
    centre += pow(0.5 * (lower[index * search->dim + k] + upper[index * search->dim + k]) - search->point[k], 2);
  centre = sqrt(centre);
  if (centre < search->least) {
    search->least = centre;
    search->best  = index;
  }
  if (search->shrink) *bound = fmin(*bound, centre);
}

static void TestClosest(void **state)
{
  (void)state;
  for (int dim = 2; dim <= 3; ++dim) {
    const int n       = 3000;
    int       visited = 0;
    BoxTree   tree;

    RandomBoxes(dim, n, 0.02);
    assert_int_equal(BoxTreeBuild(dim, n, lower, upper, &tree), 0);
    for (int trial = 0; trial < 100; ++trial) {
      const double point[3] = {Random(0, 1), Random(0, 1), Random(0, 1)};
      Search       all      = {.dim = dim, .point = point, .least = INFINITY},
             search         = {.dim = dim, .point = point, .least = INFINITY, .shrink = 1};
      double bound          = INFINITY;

      BoxTreeClosest(tree, point, NULL, &bound, Visit, &all);
      assert_int_equal(all.visited, n);
      BoxTreeClosest(tree, point, NULL, &bound, Visit, &search);
      assert_int_equal(search.best, all.best);
      assert_true(bound == search.least);
      visited += search.visited;
      bound  = 0.1;
      search = (Search){.dim = dim, .point = point, .least = INFINITY};
      BoxTreeClosest(tree, point, NULL, &bound, Visit, &search);
      for (int i = 0; i < n; ++i) search.visited -= BoxDistance(dim, i, point) <= 0.1;
      assert_int_equal(search.visited, 0);
    }
    print_message("%dD: %.1f of %d boxes visited for the closest\n", dim, visited / 100.0, n);
    assert_true(visited <= 100 * 10);
    BoxTreeDestroy(&tree);
  }
}

/* Marks the boxes that were visited. */
static void VisitMark(void *context, int index, double *bound)
{
  (void)bound;
  ((int *)context)[index] = 1;
}

/* With directions no box within the bound is missed that is opposed. Directions that turn with the place, as those of a
   surface do, let most of the others be left out. */
static void TestDirections(void **state)
{
  static double direction[MAX_BOXES * 3];
  static int    seen[MAX_BOXES];

  (void)state;
  for (int dim = 2; dim <= 3; ++dim) {
    const int n    = 1000;
    int       left = 0, turned = 0;
    BoxTree   tree;

    RandomBoxes(dim, n, 0.02);
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < dim; ++k) direction[i * dim + k] = lower[i * dim + k] - 0.5;
    assert_int_equal(BoxTreeBuildFacing(dim, n, lower, upper, direction, &tree), 0);
    for (int trial = 0; trial < 100; ++trial) {
      const double point[3]   = {Random(0, 1), Random(0, 1), Random(0, 1)},
                   own[3]     = {Random(-1, 1), Random(-1, 1), Random(-1, 1)};
      const BoxTreeSide side  = {own, 0, INFINITY, 0, 0};
      double            bound = 0.5;

      memset(seen, 0, sizeof(seen));
      BoxTreeClosest(tree, point, &side, &bound, VisitMark, seen);
      for (int i = 0; i < n; ++i) {
        double product = 0;

        for (int k = 0; k < dim; ++k) product += own[k] * direction[i * dim + k];
        if (BoxDistance(dim, i, point) > bound) continue;
        if (product < 0) assert_int_equal(seen[i], 1);
        turned += product >= 0;
        left += product >= 0 && !seen[i];
      }
    }
    assert_true(left > 0.9 * turned);
    BoxTreeDestroy(&tree);
  }
}

/* Is a box wholly behind the plane through the point across a direction? */
static int Behind(int dim, int box, const double *point, const double *own)
{
  double most = -INFINITY;

  for (int corner = 0; corner < 1 << dim; ++corner) {
    double sum = 0;

    for (int k = 0; k < dim; ++k) sum += own[k] * ((corner >> k & 1 ? upper : lower)[box * dim + k] - point[k]);
    most = fmax(most, sum);
  }
  return most < 0;
}

/* Of the boxes within the bound those are left out that lie behind and are farther than may be, and no others. */
static void TestBehind(void **state)
{
  static int seen[MAX_BOXES];

  (void)state;
  for (int dim = 2; dim <= 3; ++dim) {
    const int n    = 1000;
    int       left = 0;
    BoxTree   tree;

    RandomBoxes(dim, n, 0.02);
    assert_int_equal(BoxTreeBuild(dim, n, lower, upper, &tree), 0);
    for (int trial = 0; trial < 100; ++trial) {
      const double point[3]   = {Random(0, 1), Random(0, 1), Random(0, 1)},
                   own[3]     = {Random(-1, 1), Random(-1, 1), Random(-1, 1)};
      const BoxTreeSide side  = {own, -INFINITY, 0.1, 0, 0};
      double            bound = 0.5;

      memset(seen, 0, sizeof(seen));
      BoxTreeClosest(tree, point, &side, &bound, VisitMark, seen);
      for (int i = 0; i < n; ++i) {
        const double distance = BoxDistance(dim, i, point);
        const int    out      = distance > side.behind && Behind(dim, i, point, own);

        assert_int_equal(seen[i], distance <= bound && !out);
        left += distance <= bound && out;
      }
    }
    assert_true(left > 0);
    BoxTreeDestroy(&tree);
  }
}

typedef struct {
  int *seen, wanted; /* boxes that BoxTreeAny() has asked for; the one that passes */
} Any;

static int PassWanted(void *context, int index)
{
  Any *any = context;

  any->seen[index] = 1;
  return index == any->wanted;
}

/* Each point of a group finds the same boxes as a search of its own, and one that passes wherever it is. */
static void TestGroup(void **state)
{
  static double direction[MAX_BOXES * 3];
  static int    alone[MAX_BOXES], together[MAX_BOXES];

  (void)state;
  for (int dim = 2; dim <= 3; ++dim) {
    const int n    = 1000;
    int       left = 0;
    BoxTree   tree;

    RandomBoxes(dim, n, 0.02);
    for (int i = 0; i < n * dim; ++i) direction[i] = Random(-1, 1) / sqrt(dim);
    assert_int_equal(BoxTreeBuildFacing(dim, n, lower, upper, direction, &tree), 0);
    for (int trial = 0; trial < 100; ++trial) {
      double       point[4][3], own[4][3];
      BoxTreeGroup group = {{1, 1, 1}, {0, 0, 0}, {1, 1, 1}, {-1, -1, -1}, 0.1};
      BoxTreeSide  side  = {NULL, 0.1, 0.1, 0.01, 0.02};

      for (int k = 0; k < 3; ++k) {
        point[0][k] = Random(0, 0.9);
        own[0][k]   = Random(-0.5, 0.5);
        for (int p = 0; p < 4; ++p) {
          point[p][k]        = point[0][k] + Random(0, 0.1);
          own[p][k]          = own[0][k] + Random(-0.05, 0.05);
          group.lower[k]     = fmin(group.lower[k], point[p][k]);
          group.upper[k]     = fmax(group.upper[k], point[p][k]);
          group.own_lower[k] = fmin(group.own_lower[k], own[p][k]);
          group.own_upper[k] = fmax(group.own_upper[k], own[p][k]);
        }
      }
      left += n - BoxTreeGather(tree, &group, &side, 0.3);
      for (int p = 0; p < 4; ++p) {
        double bound = 0.3;
        Any    any   = {together, -1};

        side.own = own[p];
        memset(together, 0, sizeof(together));
        memset(alone, 0, sizeof(alone));
        assert_int_equal(BoxTreeAny(tree, point[p], &side, bound, PassWanted, &any), 0);
        for (int i = 0; i < n; ++i)
          if (together[i]) any.wanted = i;
        assert_int_equal(BoxTreeAny(tree, point[p], &side, bound, PassWanted, &any), any.wanted >= 0);
        BoxTreeGather(tree, &group, &side, 0.3);
        memset(together, 0, sizeof(together));
        any.wanted = -1;
        BoxTreeAny(tree, point[p], &side, bound, PassWanted, &any);
        BoxTreeClosest(tree, point[p], &side, &bound, VisitMark, alone);
        assert_memory_equal(alone, together, sizeof(alone));
        BoxTreeGather(tree, &group, &side, 0.3);
      }
    }
    assert_true(left > 50 * n);
    BoxTreeDestroy(&tree);
  }
}

static void TestEqualBoxes(void **state)
{
  const int    n        = 1000;
  const double point[2] = {2, 2};
  double       bound    = INFINITY;
  Search       search   = {.dim = 2, .point = point, .least = INFINITY};
  BoxTree      tree;

  (void)state;
  for (int i = 0; i < 2 * n; ++i) {
    lower[i] = 0;
    upper[i] = 1;
  }
  assert_int_equal(BoxTreeBuild(2, n, lower, upper, &tree), 0);
  CheckNear(2, n, tree, point, 2, MAX_BOXES);
  CheckNear(2, n, tree, point, 2, 10);
  CheckNear(2, n, tree, point, 1, 10);
  BoxTreeClosest(tree, point, NULL, &bound, Visit, &search);
  assert_int_equal(search.visited, n);
  assert_int_equal(search.best, 0);
  BoxTreeDestroy(&tree);
}

static void TestEmpty(void **state)
{
  const double point[2] = {0, 0};
  double       bound    = INFINITY;
  Search       search   = {.dim = 2, .point = point, .least = INFINITY};
  BoxTree      tree;

  (void)state;
  assert_int_equal(BoxTreeBuild(2, 0, NULL, NULL, &tree), 0);
  BoxTreeClosest(tree, point, NULL, &bound, Visit, &search);
  assert_int_equal(search.visited, 0);
  BoxTreeDestroy(&tree);
  BoxTreeDestroy(&tree);
}

/* Boxes that move: those that may come within reach are found, and none else, as each one by itself says. */
static void TestNearing(void **state)
{
  static double least[3 * MAX_BOXES], largest[3 * MAX_BOXES];
  static int    found[MAX_BOXES];

  (void)state;
  for (int dim = 2; dim <= 3; ++dim) {
    BoxTree tree;

    RandomBoxes(dim, 500, 0.05);
    for (int i = 0; i < 500 * dim; ++i) {
      least[i]   = lower[i] * lower[i] + Random(0, 0.05);
      largest[i] = least[i] + Random(0, 0.05);
    }
    assert_int_equal(BoxTreeBuild(dim, 500, lower, upper, &tree), 0);
    assert_int_equal(BoxTreeSetWays(tree, least, largest), 0);
    for (int trial = 0; trial < 200; ++trial) {
      const double     point[3] = {Random(0, 1), Random(0, 1), Random(0, 1)};
      const double     moved[3] = {point[0] * point[0], point[1] * point[1], trial % 2 ? 0 : point[2] * point[2]};
      const BoxTreeWay way      = {trial % 10 ? moved : NULL, Random(0, 1), Random(0, 0.1), Random(0, 0.5)};
      const double     reach    = Random(-0.05, 0.2);
      const int        there    = BoxTreeNearing(tree, point, &way, reach, MAX_BOXES, found);
      double           most     = -1;
      int              count    = 0;

      for (int i = 0; i < 500; ++i) {
        double sum = 0, approach;

        for (int k = 0; k < dim; ++k)
          sum += pow(fmax(moved[k] - least[i * dim + k], largest[i * dim + k] - moved[k]), 2);
        approach = way.way ? fmin(way.most, way.ahead * sqrt(sum) + way.aside) : way.most;
        if (BoxDistance(dim, i, point) >= reach + approach) continue;
        assert_true(count < there && found[count] == i);
        most = fmax(most, approach);
        ++count;
      }
      assert_int_equal(there, count);
      assert_true(fabs(BoxTreeApproach(tree, point, &way, reach) - most) < 1e-14);
    }
    BoxTreeDestroy(&tree);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestNear),       cmocka_unit_test(TestClosest),
                                     cmocka_unit_test(TestDirections), cmocka_unit_test(TestBehind),
                                     cmocka_unit_test(TestGroup),      cmocka_unit_test(TestNearing),
                                     cmocka_unit_test(TestEqualBoxes), cmocka_unit_test(TestEmpty)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
