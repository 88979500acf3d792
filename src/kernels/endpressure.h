/* Pressures near the end of a contact zone, from their forces and moments. Plain C, no PETSc, no allocation.

   Where smooth surfaces part, the pressure falls as the root of the distance from the end of the zone (Johnson, Contact
   Mechanics, 1985), so that its square is a linear function of the place, and it is 0 beyond. EndPressureFit() finds
   the one with given force and moments; EndPressureAt() evaluates it. Of all pressures that are nowhere negative and
   have that force and these moments it is the one with the least integral of the cube, so that there is no other. A
   rate of force and moments gives the rate of the pressure, which grows as one over the root towards the end.

   The place is given as terms, the first of which is 1 and the others coordinates from about the middle, over the size
   of the region. A point stands for a square around it, whose mean rate is bounded. */
#pragma once

enum { ENDPRESSURE_TERMS = 3 }; /* at most: 1 and two coordinates */

typedef struct {
  double square[ENDPRESSURE_TERMS]; /* the square of the pressure where it is positive */
  double rate[ENDPRESSURE_TERMS];   /* the rate of the square */
  double least;                     /* of the square that counts for the rate of a point */
} EndPressure;

int EndPressureFit(int terms, int points, double extent, const double *term, const double *weight, const double *moment,
                   const double *moment_rate, EndPressure *);
void EndPressureAt(double square, double square_rate, double least, double *pressure, double *rate);
