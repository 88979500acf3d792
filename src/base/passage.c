/* Floods and barriers in a graph, see passage.h. */
#include "base/passage.h"

/*@
  PassageFlood - marks the nodes that are reached from some nodes through open nodes.

  Not collective

  Input Parameters:
+ graph - nodes and neighbours
. open  - open[n]: the node lets the flood in
- from  - from[n]: the flood starts here, where the node is open

  Output Parameters:
+ reached - reached[n]: 1 or 0
- stack   - room for n integers

  Note:
  Plain C.
@*/
void PassageFlood(const PassageGraph *graph, const char *open, const char *from, int *stack, char *reached)
{
  int top = 0;

  for (int i = 0; i < graph->n; i++) {
    reached[i] = from[i] && open[i];
    if (reached[i]) stack[top++] = i;
  }
  while (top) {
    const int i = stack[--top];

    for (int k = graph->ptr[i]; k < graph->ptr[i + 1]; k++) {
      const int j = graph->adj[k];

      if (reached[j] || !open[j]) continue;
      reached[j]   = 1;
      stack[top++] = j;
    }
  }
}

/* The number that stands for the set of i; sets are trees, which are flattened on the way. */
static int Root(int *root, int i)
{
  while (root[i] != i) {
    root[i] = root[root[i]];
    i       = root[i];
  }
  return i;
}

static void Join(int *root, int i, int j)
{
  root[Root(root, i)] = Root(root, j);
}

/*@
  PassageBarrier - finds the highest node of the way between two sets of nodes on which that node is lowest.

  Not collective

  Input Parameters:
+ graph - nodes and neighbours
. order - order[n]: the nodes by ascending height
. from  - from[n]: the way starts at one of these nodes
- to    - to[n]: and ends at one of these

  Output Parameter:
. root - room for n + 2 integers

  Note:
  It returns the number of that node, -1 where no way exists. Nodes are added by their heights until both ends are in
  one set (Kruskal's way to the bottleneck path). Plain C.
@*/
int PassageBarrier(const PassageGraph *graph, const int *order, const char *from, const char *to, int *root)
{
  const int n = graph->n, start = n, end = n + 1;

  for (int i = 0; i < n; i++) root[i] = -1; /* not added yet */
  root[start] = start;
  root[end]   = end;
  for (int k = 0; k < n; k++) {
    const int i = order[k];

    root[i] = i;
    for (int a = graph->ptr[i]; a < graph->ptr[i + 1]; a++)
      if (root[graph->adj[a]] >= 0) Join(root, i, graph->adj[a]);
    if (from[i]) Join(root, i, start);
    if (to[i]) Join(root, i, end);
    if (Root(root, start) == Root(root, end)) return i;
  }
  return -1;
}
