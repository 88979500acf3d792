/* The fixed columns of steps.csv and the only list of their names. Plain C.

   stepscsv.c writes these columns. The columns of the probes follow the fixed ones, and sceneprobe.c therefore refuses
   a probe that has the name of a fixed column. A new column needs a line here, its name in stepcolumns.c and its value
   in stepscsv.c. */
#pragma once

typedef enum {
  COLUMN_STEP,
  COLUMN_T,
  COLUMN_DT,
  COLUMN_BETA, /* only the step control by contact has a beta */
  COLUMN_NEWTON,
  COLUMN_KRYLOV,
  COLUMN_ATTEMPTS,
  COLUMN_RESIDUAL,
  COLUMN_CONTACT_NODES,
  COLUMN_NODES_IN,
  COLUMN_NODES_OUT,
  COLUMN_MAX_PENETRATION,
  COLUMN_MIN_PENETRATION,
  COLUMN_OUTSIDE_WINDOW, /* only an adjusted or augmented penalty has a window */
  COLUMN_PENALTY_MIN,
  COLUMN_PENALTY_MAX,
  COLUMN_CONTACT_FORCE,
  COLUMN_PLASTIC_STRAIN, /* only scenes with a plastic body have this and the energies */
  COLUMN_ELASTIC_ENERGY,
  COLUMN_PLASTIC_WORK,
  COLUMN_WORK,
  COLUMN_EXTERNAL_WORK,
  COLUMN_CONTACT_ENERGY,
  COLUMN_DISSIPATED, /* only with friction */
  COLUMN_WALL_S,
  STEP_COLUMNS
} StepColumn;

/* The last column of all, behind the probes: the name of the step, where the scene has steps with names */
#define STEP_COLUMN_DURING "during"

extern const char *const StepColumnNames[STEP_COLUMNS];
