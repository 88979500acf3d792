/* The fixed columns of steps.csv, the one list of their names. Plain C. stepscsv.c writes them. sceneprobe.c refuses a
   probe of such a name, because the columns of the probes follow the fixed ones. To add a column: a line here, its name
   in stepcolumns.c, its value in stepscsv.c. */
#pragma once

typedef enum {
  COLUMN_STEP,
  COLUMN_T,
  COLUMN_DT,
  COLUMN_BETA, /* only the control by contact has one */
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
  COLUMN_WALL_S,
  STEP_COLUMNS
} StepColumn;

extern const char *const StepColumnNames[STEP_COLUMNS];
