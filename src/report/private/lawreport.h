/* What -check says of laws of rubber: the stretches for which each one is stable, and a warning where it is not. */
#pragma once
#include <stdio.h>
#include "scene/scene.h"

void LawReport(Scene, FILE *);
