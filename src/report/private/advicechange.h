/* What can be changed in a scene: the one table from which advice after a run and `try` after a failure are taken.

   A change moves one axis of the scene in one direction, by a key where there is one. AdviceChangePossible() tells
   whether it can be made in the scene at hand, AdviceChangeWrite() writes it as the user makes it, with its value.
   AdviceChangesOppose() tells whether two changes pull one axis of one pair in opposite directions. A new change is one
   enumerator and one line in the table of advicechange.c. */
#pragma once
#include "runfigures.h"

typedef enum {
  CHANGE_NONE, /* ends a list of changes */
  CHANGE_FREE_PENALTY,
  CHANGE_STIFFER,
  CHANGE_SOFTER,
  CHANGE_STICK,
  CHANGE_WIDER_WINDOW,
  CHANGE_RANGE,
  CHANGE_UPDATES,
  CHANGE_WHEN_CONVERGED,
  CHANGE_WHEN_STEP,
  CHANGE_DIFFUSE,
  CHANGE_SURFACE,
  CHANGE_DEGREE_2,
  CHANGE_SYMMETRY,
  CHANGE_ROLES,
  CHANGE_ROOM,
  CHANGE_FINER_SLAVE,
  CHANGE_FINER_MASTER,
  CHANGE_WHOLE_MASTER,
  CHANGE_STABILISE,
  CHANGE_DISPLACEMENT,
  CHANGE_SUPPORT,
  CHANGE_LAW,
  CHANGE_FORMULATION,
  CHANGE_AUTO,
  CHANGE_SECOND_ORDER,
  CHANGE_ENHANCED,
  CHANGE_SHORTER,
  CHANGE_SHORTER_MIN,
  CHANGE_FLOW,
  CHANGE_LAG,
  CHANGE_TRAVEL,
  CHANGE_PATH,
  CHANGE_MORE_NODES,
  CHANGE_LONGER,
  CHANGE_PREDICTION,
  CHANGE_ITERATIONS,
  CHANGE_DAMPING,
  CHANGE_LINE_SEARCH,
  CHANGE_WORKSPACE,
  CHANGE_OUTPUT,
  CHANGE_LESS_OUTPUT,
  CHANGE_KERNELS,
  CHANGE_CHECK,
  CHANGES
} ChangeKind;

/* What a change can be made to */
typedef struct {
  const RunFigures  *figures;
  const PairFigures *pair;   /* NULL: no pair is meant */
  int                body;   /* index in the scene, -1: none is meant */
  double             factor; /* by which a value is wrong, where that is known; else 1 */
} ChangePlace;

int  AdviceChangePossible(ChangeKind, const ChangePlace *);
void AdviceChangeWrite(ChangeKind, const ChangePlace *, char *text, size_t size);
int  AdviceChangesOppose(ChangeKind, const PairFigures *, ChangeKind, const PairFigures *);
