/* When open slave nodes will touch, and how much of a load step brings as many of them into contact as wanted (Chamoret
   et al. 2004, section 4). Plain C. */
#pragma once

/* One open node that approaches the master. */
typedef struct {
  double beta;   /* part of the step at whose end it touches; above 1: only after the step */
  double key;    /* number that is the same on any number of ranks */
  double weight; /* what it counts: 1, or its area */
} Touch;

typedef struct {
  double beta;  /* beta_{N_c}; NaN: no node approaches */
  double met;   /* weight that touches by then, nodes that tie included */
  int    nodes; /* how many nodes that is */
  int    tied;  /* how many of them beyond those wanted, as no step separates them from the last one wanted */
} TouchStepChoice;

double TouchStepBeta(double before, double after, double resting);
void   TouchStepChoose(int n, const Touch *, double wanted, double apart, TouchStepChoice *);
