/* What to do about a bad figure of a run, one line each. A new rule is one function and one line in a table of
 * advice.c. */
#pragma once
#include "runfigures.h"

enum { ADVICE_TEXT = 400 };
typedef void (*AdvicePrintFn)(const char *line, void *context);

/* Calls print for every rule that applies. Not collective. */
void AdviceGive(const RunFigures *, AdvicePrintFn, void *context);
/* What to try after a solve that failed so. */
const char *AdviceForFailure(SolveResult);
