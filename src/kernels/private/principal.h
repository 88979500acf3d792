/* Principal values of symmetric tensors, LANES at a time. Plain C. */
#pragma once
#include "base/lanes.h"

void PrincipalAxes(const Lanes tensor[6], Lanes value[3], Lanes axis[3][3]);
