/* The penalty parameter: its automatic start value. Plain C. */
#pragma once

/* PenaltyAutomatic - stiffness (force per length and area) of the softer side of a pair.

   slave, master: E over the height of the elements below the surface, area-weighted mean; 0 for a rigid side. */
double PenaltyAutomatic(double slave, double master);
