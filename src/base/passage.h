/* Ways through a graph whose nodes may bar them: what a fluid reaches, and how high the lowest barrier before its end
   is. Plain C.

   PassageFlood() marks the nodes that are reached through open nodes. PassageBarrier() finds the way between two sets
   of nodes on which the highest node is the lowest. */
#pragma once

/* Nodes and their neighbours: those of node i are adj[ptr[i]] to adj[ptr[i + 1] - 1]. */
typedef struct {
  int        n;
  const int *ptr, *adj;
} PassageGraph;

void PassageFlood(const PassageGraph *, const char *open, const char *from, int *stack, char *reached);
int  PassageBarrier(const PassageGraph *, const int *order, const char *from, const char *to, int *root);
