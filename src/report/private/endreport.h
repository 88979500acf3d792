/* The last screen of a run: effects, time, contact quality, guards that acted and advice; after a failure cause, place,
 * what was tried and what to try. */
#pragma once
#include <stdio.h>
#include "runfigures.h"

/* Not collective: for one rank. */
void EndReportPrint(const RunFigures *, FILE *);
