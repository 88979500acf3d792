/* Default values that depend on other keys. scene.c chooses them, and schemakeys.c tells them in its help. */
#pragma once

/* Factor on the automatic penalty where a scene names none, and its text. It leaves up to 1 % of error in most jobs.
   Where it leaves more, the run makes the penalty stiffer (solve/penaltyerror.c). A penalty of 100 takes up to a fifth
   more iterations, and forces of a cylinder that slides over coarse elements scatter three times as much. */
#define SCENE_PENALTY_SCALE      30
#define SCENE_PENALTY_SCALE_TEXT "30"
