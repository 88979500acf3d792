#include "penalty.h"

/* The penalty spring is in series with the layer of elements on either side; measured against the softer one it neither dominates the
   conditioning nor lets bodies of unlike stiffness sink into each other. */
double PenaltyAutomatic(double slave, double master)
{
  if (master <= 0) return slave;
  return slave < master ? slave : master;
}
