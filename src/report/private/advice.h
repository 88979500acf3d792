/* What to do about a bad figure of a run, one line each. AdviceGive() goes through the rules, AdviceForFailure()
   answers for a solve that failed. A new rule is one function and one line in a table of advice.c. */
#pragma once
#include "runfigures.h"

enum { ADVICE_TEXT = 400 /* characters of a line of advice */ };
typedef void (*AdvicePrintFn)(const char *line, void *context);

void        AdviceGive(const RunFigures *, AdvicePrintFn, void *context);
const char *AdviceForFailure(SolveResult);
