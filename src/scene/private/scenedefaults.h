/* Default values that depend on other keys. scenecontact.c chooses them, and schemakeys.c tells them in its help. */
#pragma once

/* Factor on the automatic penalty where a scene names none, and its text. It leaves up to 1 % of error in most jobs.
   Where it leaves more, the run makes the penalty stiffer (solve/penaltyerror.c). A penalty of 100 takes up to a fifth
   more iterations, and forces of a cylinder that slides over coarse elements scatter three times as much. */
#define SCENE_PENALTY_SCALE      30
#define SCENE_PENALTY_SCALE_TEXT "30"
/* The same of pairs that come and go, whose penalty the run does not make stiffer. */
#define SCENE_PRESENCE_SCALE 100
/* The same with friction. Newton's method then takes many more iterations with a stiff penalty: a tool that is drawn
   over a slab takes 180 with this factor, 230 with 10, and 2000 with 30. */
#define SCENE_FRICTION_SCALE      3
#define SCENE_FRICTION_SCALE_TEXT "3"
