/* How much finer the next mesh has to be, and what it will cost, from the meshes so far. Plain C.

   The error of a mesh is taken as C f^-q, where f is the factor by which its elements are smaller than those of the
   first mesh; its CPU seconds as a power of its unknowns. Both powers are those between the last two meshes, within
   bounds; before there are two they are assumed. MeshPlanFactor() gives the factor that is wanted, MeshPlanForecast()
   the figures of a mesh with a factor, or with a number of unknowns.

   MeshPlanLargest() gives the factor of the largest mesh that limits of time and memory allow.

   Two meshes are witnesses of each other: where the error falls by the part q from one to the next, the change of the
   answer is (1 - q) / q times what is left. MeshPlanForetold() says whether the estimates have forecast it.
   MeshPlanImplied() gives that of the change that the estimates of both
   meshes have not forecast, and adds the estimate of the last mesh, both with a factor of safety. Source: Roache,
   Journal of Fluids Engineering 116 (1994), 405.

   Where surfaces are in contact, what no estimate sees is that of the zone's end, which falls with the square of the
   size of the elements there (errors/contactzone.h). MeshPlanSplit() gives either kind of error its share of what is
   wanted. As the power at the zone is no measured one, the factor of safety is 3 after one change, as Roache has it for
   two meshes. A change is not forecast by more than this factor times all that
   is known to leave errors, and by more than what is asked for, where the mesh before was too coarse to tell anything:
   it implies nothing. */
#pragma once

typedef struct {
  double factor; /* elements are smaller by it than those of the first mesh */
  double unknowns, error, cpu_s, rss_mb;
} MeshFigures;

/* From one mesh to the next */
typedef struct {
  double change;           /* of the answer */
  double before, estimate; /* estimated error of either mesh, with its sign; NaN: there is no estimate */
  double fall;             /* sum of the magnitudes of what single places leave: of the last mesh over the one before */
  double finer;            /* elements are smaller by this factor: all of them, or on average */
  double zone;    /* those at surfaces in contact are smaller by this factor; 0: no zone in contact has an end */
  double most;    /* sum of the magnitudes of all that is known to leave errors on the mesh before */
  double allowed; /* error that is asked for */
  int    known;   /* changes to the mesh before that have told something, one after the other */
  int    even;    /* all */
} MeshChange;

/* What the next mesh is to leave of the present errors */
typedef struct {
  double bodies; /* part of that which the shares of the cells show */
  double zone;   /* elements at surfaces in contact have this part of their size */
} MeshWish;

double      MeshPlanFactor(int n, const MeshFigures[], int order, double wanted);
MeshFigures MeshPlanForecast(int n, const MeshFigures[], int dim, int order, double factor);
double      MeshPlanLargest(int n, const MeshFigures[], int dim, int order, MeshFigures limit);
int         MeshPlanForetold(const MeshChange *);
double      MeshPlanUnseen(const MeshChange *, int order);
double      MeshPlanImplied(const MeshChange *, int order);
MeshWish    MeshPlanSplit(double wanted, double bodies, double zone);
double      MeshPlanResolve(double left, double to);
