/* The contact law: from the (weighted) gap of a slave node and its state to the potential per area and its derivatives.
   Plain C. A new law is one function in law.c and one line in its table. Where a term presses its pressure is -penalty
   (gap - LawOnsetGap()), as linear steps count on (pressing.h): a law of another shape must be left out there. */
#pragma once

typedef struct {
  double penalty;    /* force per length and area */
  double offset;     /* g_0, subtracted from the gap */
  double multiplier; /* pressure at no penetration, 0 without augmentation */
} LawState;

typedef struct {
  double psi, pressure, stiffness; /* psi, -psi' >= 0 in compression, psi'' */
} LawValue;

typedef struct {
  const char *name;
  int         symmetric; /* has a potential: Cholesky and the energy line search are right */
  void (*evaluate)(double gap, const LawState *state, LawValue *value);
} Law;

extern const Law Laws[]; /* terminated by a NULL name */
const Law       *LawFind(const char *name);
double LawOnsetGap(const LawState *); /* gap below which there is pressure: the offset, plus what the multiplier presses
                                         before the surfaces meet */
