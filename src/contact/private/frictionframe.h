/* A frame of orthonormal vectors that turns with a face of the master. Plain C.

   With the face's tangents a_1 and a_2 at a place of it,
       n = (a_1 x a_2)/|a_1 x a_2|,   t_1 = a_1/|a_1|,   t_2 = n x t_1
   A distance that is part of the face's motion has fixed components in it. In two dimensions a_2 is the third axis. */
#pragma once

typedef struct {
  double axis[3][3];    /* t_1, t_2, n */
  double length, area;  /* of a_1, and of a_1 x a_2 */
  double tangent[2][3]; /* a_1 and a_2 */
} FrictionFrame;

int  FrictionFrameMake(const double tangent[2][3], FrictionFrame *);
void FrictionFrameTake(const FrictionFrame *, const double v[3], double component[3]);
void FrictionFrameCarry(const FrictionFrame *, const double component[3], double v[3]);
void FrictionFrameVary(const FrictionFrame *, const double component[3], double by[2][3][3]);
