/* steps.csv: a row for each accepted step, with the fixed columns of stepcolumns.h and a column for each probe.

   The object is for rank 0 alone; StepsCsvArchive() only is collective. StepsCsvCreate() touches no file.
   StepsCsvBegin() makes the file with its head; after a restart StepsCsvResume() instead cuts off the rows that were
   written after the loaded checkpoint. StepsCsvWrite() adds a row. To add a column: its name in stepcolumns.h and
   stepcolumns.c, its value in FillRow() or FillContact() of stepscsv.c. */
#pragma once
#include "files/archive.h"
#include "scene/scene.h"
#include "step/stepper.h"

typedef struct _n_StepsCsv *StepsCsv;

PetscErrorCode StepsCsvCreate(Scene, const char *directory, StepsCsv *);
PetscErrorCode StepsCsvDestroy(StepsCsv *);
PetscErrorCode StepsCsvBegin(StepsCsv);
PetscErrorCode StepsCsvResume(StepsCsv, PetscBool *lost);
PetscErrorCode StepsCsvWrite(StepsCsv, const StepRecord *, PetscReal wall_s, const PetscReal *probes);
PetscErrorCode StepsCsvArchive(StepsCsv, Archive);
