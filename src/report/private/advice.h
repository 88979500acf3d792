/* What to do about a bad figure of a run, and about a failure: one engine for both.

   A situation has a rule, which tells whether it is there, and the changes that help in it (advice.c); after a failed
   solve its result is the situation. The changes are those of advicechange.h. AdviceCollect() goes through the
   situations and drops changes that cannot be made or that oppose an earlier one; AdviceGive() and AdviceTry() print
   what is left. A new rule is one function and one line in a table of advice.c. */
#pragma once
#include "advicechange.h"

enum {
  ADVICE_TEXT    = 400, /* characters of a line of advice */
  ADVICE_CHANGES = 9,   /* changes that one situation may name, with the CHANGE_NONE that ends them */
  ADVICE_LINES   = 64
};

typedef struct {
  char        text[ADVICE_TEXT]; /* what is wrong */
  ChangePlace at;
  int         n;
  ChangeKind  changes[ADVICE_CHANGES];
} AdviceLine;

typedef struct {
  int        n;
  int        tries; /* 1: the first line is what to try after the failure */
  AdviceLine lines[ADVICE_LINES];
} Advice;

typedef void (*AdvicePrintFn)(const char *line, void *context);

void      AdviceCollect(const RunFigures *, Advice *);
void      AdviceGive(const RunFigures *, AdvicePrintFn print, void *context);
PetscBool AdviceMasterStands(const PairFigures *);
void      AdviceTry(const RunFigures *, AdvicePrintFn print, void *context);
