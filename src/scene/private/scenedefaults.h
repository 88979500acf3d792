/* Default values that depend on other keys. scene.c chooses them, and schemakeys.c tells them in its help. */
#pragma once

/* Factor on the automatic penalty where a scene names none, and its text. With 100 forces are up to 0.4 % low and peak
   pressures in most jobs up to 0.9 %, for 5 % more iterations than 1. Where more is left at the end of the load, the
   run makes the penalty stiffer (solve/penaltyerror.c). */
#define SCENE_PENALTY_SCALE      100
#define SCENE_PENALTY_SCALE_TEXT "100"
