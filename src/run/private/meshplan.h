/* How much finer the next mesh has to be, and what it will cost, from the meshes so far. Plain C.

   The error of a mesh is taken as C f^-q, where f is the factor by which its elements are smaller than those of the
   first mesh; its CPU seconds as a power of its unknowns. Both powers are those between the last two meshes, within
   bounds; before there are two they are assumed. MeshPlanFactor() gives the factor that is wanted, MeshPlanForecast()
   the figures of a mesh with a factor, or with a number of unknowns. */
#pragma once

typedef struct {
  double factor; /* elements are smaller by it than those of the first mesh */
  double unknowns, error, cpu_s, rss_mb;
} MeshFigures;

double      MeshPlanFactor(int n, const MeshFigures[], int order, double wanted);
MeshFigures MeshPlanForecast(int n, const MeshFigures[], int dim, int order, double factor);
