/* Isotropic hardening: the yield stress as a function of the equivalent plastic strain. Plain C.

   The yield stress is a sum of the terms that a user names, or a table. HardeningStress() evaluates it with its slope
   and its integral, HardeningReturn() solves the equation of the return mapping. */
#pragma once

/* Rows of a table. Measured curves that are given by hand have some ten. */
enum { HARDENING_MAX_ROWS = 64 };

/* yield + linear a + (saturation - yield) (1 - exp(-rate a)) + strength (strain + a)^exponent - yield, where a is the
   equivalent plastic strain. Terms whose constants are zero are absent. With a table (rows > 0) the other terms are not
   used: the yield stress is linear between its rows and goes on with the last slope. Every slope is >= 0. */
typedef struct {
  double yield, linear;              /* stress */
  double saturation, rate;           /* Voce: stress, 1; rate 0: absent */
  double strength, exponent, strain; /* Swift: stress, 1, 1; strength 0: absent */
  int    rows;
  double table[HARDENING_MAX_ROWS][2]; /* equivalent plastic strain, yield stress */
} Hardening;

double HardeningStress(const Hardening *, double strain, double *slope, double *work);
double HardeningReturn(const Hardening *, double strain, double trial, double stiffness);
