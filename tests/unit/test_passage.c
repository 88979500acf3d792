/* Floods and barriers in a graph, against the answers that a small grid shows. */
#include "base/passage.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

enum { SIDE = 5, NODES = SIDE * SIDE };

/* A square grid whose nodes have up to four neighbours */
typedef struct {
  int          ptr[NODES + 1], adj[4 * NODES];
  PassageGraph graph;
} Grid;

static void MakeGrid(Grid *g)
{
  int n = 0;

  for (int i = 0; i < NODES; i++) {
    const int x = i % SIDE, y = i / SIDE;

    g->ptr[i] = n;
    if (x > 0) g->adj[n++] = i - 1;
    if (x < SIDE - 1) g->adj[n++] = i + 1;
    if (y > 0) g->adj[n++] = i - SIDE;
    if (y < SIDE - 1) g->adj[n++] = i + SIDE;
  }
  g->ptr[NODES] = n;
  g->graph      = (PassageGraph){NODES, g->ptr, g->adj};
}

/* Marks the nodes of column x. */
static void Column(int x, char *flag)
{
  memset(flag, 0, NODES);
  for (int y = 0; y < SIDE; y++) flag[y * SIDE + x] = 1;
}

/* A wall with a hole lets the flood through, a whole wall does not, and an end behind a closed node is dry. */
static void test_flood(void **state)
{
  char open[NODES], from[NODES], reached[NODES];
  int  stack[NODES], wet = 0;
  Grid g;

  (void)state;
  MakeGrid(&g);
  Column(0, from);
  memset(open, 1, NODES);
  for (int y = 0; y < SIDE; y++) open[y * SIDE + 2] = 0;
  PassageFlood(&g.graph, open, from, stack, reached);
  for (int i = 0; i < NODES; i++) assert_int_equal(reached[i], i % SIDE < 2);
  open[3 * SIDE + 2] = 1;
  PassageFlood(&g.graph, open, from, stack, reached);
  for (int i = 0; i < NODES; i++) wet += reached[i];
  assert_int_equal(wet, NODES - SIDE + 1);
  memset(from, 0, NODES);
  from[2] = 1; /* in the wall */
  PassageFlood(&g.graph, open, from, stack, reached);
  for (int i = 0; i < NODES; i++) assert_int_equal(reached[i], 0);
}

/* The way over a wall leads through its lowest node, by whatever detour; without neighbours there is none. */
static void test_barrier(void **state)
{
  char   from[NODES], to[NODES];
  double height[NODES] = {0};
  int    order[NODES], root[NODES + 2];
  Grid   g;

  (void)state;
  MakeGrid(&g);
  Column(0, from);
  Column(SIDE - 1, to);
  for (int y = 0; y < SIDE; y++) {
    height[y * SIDE + 1] = y == 4 ? 2 : 9; /* two walls, lowest at opposite ends */
    height[y * SIDE + 3] = y == 0 ? 3 : 8 + y;
    height[y * SIDE + 2] = 1;
  }
  for (int i = 0; i < NODES; i++) order[i] = i;
  for (int i = 1; i < NODES; i++)
    for (int j = i; j > 0 && height[order[j]] < height[order[j - 1]]; j--) {
      const int o  = order[j];
      order[j]     = order[j - 1];
      order[j - 1] = o;
    }
  assert_int_equal(PassageBarrier(&g.graph, order, from, to, root), 3);
  memset(g.ptr, 0, sizeof(g.ptr));
  assert_int_equal(PassageBarrier(&g.graph, order, from, to, root), -1);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_flood), cmocka_unit_test(test_barrier)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
