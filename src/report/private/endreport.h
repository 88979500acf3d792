/* The last screen of a run: effects, time, contact quality, guards that acted and advice. After a failure also its
   cause, its place, what was tried and what to try. */
#pragma once
#include <stdio.h>
#include "runfigures.h"

void EndReportPrint(const RunFigures *, FILE *);
