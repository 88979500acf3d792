/* Names of the fixed columns of steps.csv, see stepcolumns.h. */
#include "scene/stepcolumns.h"

const char *const StepColumnNames[STEP_COLUMNS] = {
  [COLUMN_STEP]            = "step",
  [COLUMN_T]               = "t",
  [COLUMN_DT]              = "dt",
  [COLUMN_BETA]            = "beta",
  [COLUMN_NEWTON]          = "newton",
  [COLUMN_KRYLOV]          = "krylov",
  [COLUMN_ATTEMPTS]        = "attempts",
  [COLUMN_RESIDUAL]        = "residual",
  [COLUMN_CONTACT_NODES]   = "contact_nodes",
  [COLUMN_NODES_IN]        = "nodes_in",
  [COLUMN_NODES_OUT]       = "nodes_out",
  [COLUMN_MAX_PENETRATION] = "max_penetration",
  [COLUMN_MIN_PENETRATION] = "min_penetration",
  [COLUMN_OUTSIDE_WINDOW]  = "outside_window",
  [COLUMN_PENALTY_MIN]     = "penalty_min",
  [COLUMN_PENALTY_MAX]     = "penalty_max",
  [COLUMN_CONTACT_FORCE]   = "contact_force",
  [COLUMN_PLASTIC_STRAIN]  = "max_plastic_strain",
  [COLUMN_ELASTIC_ENERGY]  = "elastic_energy",
  [COLUMN_PLASTIC_WORK]    = "plastic_work",
  [COLUMN_WORK]            = "work",
  [COLUMN_DISSIPATED]      = "dissipated",
  [COLUMN_WALL_S]          = "wall_s",
};
