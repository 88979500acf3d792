/* Hardening: the yield stress as a function of the equivalent plastic strain and of its rate, and the constants of
   backstresses. Plain C.

   The yield stress is a sum of the terms that a user names, or a table. HardeningStress() evaluates it with its slope
   and its integral, HardeningOverstress() what the rate adds, HardeningReturn() solves the equation of the return
   mapping. Source of the overstress: Perzyna, "Fundamental problems in viscoplasticity", Advances in Applied Mechanics
   9, 1966. */
#pragma once

/* Rows of a table. Measured curves that are given by hand have some ten. */
enum { HARDENING_MAX_ROWS = 64 };
/* Terms of the backstress. Cyclic tests of steel are fitted with two to four. */
enum { HARDENING_MAX_TERMS = 4 };

/* yield + linear a + (saturation - yield) (1 - exp(-rate a)) + strength (strain + a)^exponent - yield, where a is the
   equivalent plastic strain. Terms whose constants are zero are absent. With a table (rows > 0) the other terms are not
   used: the yield stress is linear between its rows and goes on with the last slope. Every slope is >= 0. */
typedef struct {
  double yield, linear;              /* stress */
  double saturation, rate;           /* Voce: stress, 1; rate 0: absent */
  double strength, exponent, strain; /* Swift: stress, 1, 1; strength 0: absent */
  int    rows;
  double table[HARDENING_MAX_ROWS][2]; /* equivalent plastic strain, yield stress */
  /* Backstresses of Armstrong and Frederick: C (stress) and gamma; each grows to C / gamma in tension */
  int    terms;
  double backstress[HARDENING_MAX_TERMS][2];
  /* Perzyna: the plastic strain grows at speed (stress above the yield stress / overstress)^power; overstress 0: absent
   */
  double overstress, speed, power; /* stress, 1 / time, 1 */
} Hardening;

double HardeningStress(const Hardening *, double strain, double *slope, double *work);
double HardeningMost(const Hardening *, double strain, double *slope);
double HardeningOverstress(const Hardening *, double increment, double dt, double *slope, double *work);
double HardeningReturn(const Hardening *, double strain, double dt, double trial, double stiffness);
