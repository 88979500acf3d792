/* The table of the accepted steps, see stepscsv.h. */
#include "stepscsv.h"
#include "files/textfile.h"
#include "scene/stepcolumns.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The length of the file in bytes is saved as two integers of so many bits each, because a PetscInt may have no more
   than 32 bits with its sign. */
enum { LENGTH_BITS = 31 };

struct _n_StepsCsv {
  Scene    scene;
  char     path[TEXTFILE_PATH_SIZE];
  FILE    *file;
  PetscInt length[2]; /* of the file at the last checkpoint: bytes, the upper and the lower LENGTH_BITS bits */
};

/*@
  StepsCsvCreate - prepares the table of a run's steps; no file is touched.

  Not collective

  Input Parameters:
+ scene     - the scene, whose probes are columns
- directory - of the results; exists before StepsCsvBegin()

  Output Parameter:
. result - free it with StepsCsvDestroy()
@*/
PetscErrorCode StepsCsvCreate(Scene scene, const char *directory, StepsCsv *result)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(result));
  (*result)->scene = scene;
  PetscCall(PetscSNPrintf((*result)->path, sizeof((*result)->path), "%s/steps.csv", directory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  StepsCsvDestroy - closes the file and frees the object; the file stays.

  Not collective

  Input Parameter:
. csv - the table; set to NULL
@*/
PetscErrorCode StepsCsvDestroy(StepsCsv *csv)
{
  PetscFunctionBeginUser;
  if (!*csv) PetscFunctionReturn(PETSC_SUCCESS);
  if ((*csv)->file) fclose((*csv)->file);
  PetscCall(PetscFree(*csv));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints a name as a field, in quotation marks where it needs them. */
static void PrintText(FILE *file, const char *text)
{
  if (!strpbrk(text, ",\"\n")) {
    fputs(text, file);
    return;
  }
  fputc('"', file);
  for (; *text; text++) {
    if (*text == '"') fputc('"', file);
    fputc(*text, file);
  }
  fputc('"', file);
}

/* Prints a number as a field; the field is empty where there is no value. */
static void PrintReal(FILE *file, PetscReal value)
{
  if (isfinite((double)value)) fprintf(file, "%.15g", (double)value);
}

/*@
  StepsCsvBegin - makes the file with the names of its columns.

  Not collective

  Input Parameter:
. csv - the table

  Note:
  For rank 0. Errors: PETSC_ERR_FILE_OPEN, PETSC_ERR_FILE_WRITE.
@*/
PetscErrorCode StepsCsvBegin(StepsCsv csv)
{
  PetscFunctionBeginUser;
  csv->file = fopen(csv->path, "w");
  PetscCheck(csv->file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "Cannot write %s: %s", csv->path, strerror(errno));
  for (int k = 0; k < STEP_COLUMNS; k++) fprintf(csv->file, "%s%s", k ? "," : "", StepColumnNames[k]);
  for (int i = 0; i < csv->scene->n_probes; i++) {
    fputc(',', csv->file);
    PrintText(csv->file, csv->scene->probes[i].name);
  }
  fprintf(csv->file, "%s\n", csv->scene->stepping.n_steps ? "," STEP_COLUMN_DURING : "");
  PetscCheck(!fflush(csv->file), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "Cannot write %s: %s", csv->path,
             strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  StepsCsvResume - cuts off the rows that were written after the loaded checkpoint, and adds to the others from then on.

  Not collective

  Input Parameter:
. csv - the table, after StepsCsvArchive() has loaded it

  Output Parameter:
. lost - the file is gone or shorter than it was at the checkpoint; nothing was done then

  Note:
  For rank 0. Errors: PETSC_ERR_FILE_OPEN.
@*/
PetscErrorCode StepsCsvResume(StepsCsv csv, PetscBool *lost)
{
  const off_t length = (off_t)csv->length[0] << LENGTH_BITS | (off_t)csv->length[1];
  struct stat status;

  PetscFunctionBeginUser;
  *lost = stat(csv->path, &status) || status.st_size < length ? PETSC_TRUE : PETSC_FALSE;
  if (*lost) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(!truncate(csv->path, length) && (csv->file = fopen(csv->path, "a")), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN,
             "Cannot write %s: %s", csv->path, strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fills the columns that only a run with contact has. */
static void FillContact(const StepRecord *step, PetscReal row[STEP_COLUMNS])
{
  const ContactSummary *contact = &step->contact;

  row[COLUMN_CONTACT_NODES]   = (PetscReal)contact->nodes;
  row[COLUMN_NODES_IN]        = (PetscReal)contact->in;
  row[COLUMN_NODES_OUT]       = (PetscReal)contact->out;
  row[COLUMN_MAX_PENETRATION] = contact->max_penetration;
  row[COLUMN_MIN_PENETRATION] = contact->min_penetration;
  row[COLUMN_PENALTY_MIN]     = contact->penalty_min;
  row[COLUMN_PENALTY_MAX]     = contact->penalty_max;
  row[COLUMN_CONTACT_FORCE]   = contact->force;
  row[COLUMN_DISSIPATED]      = contact->dissipated;
  row[COLUMN_BETA]            = step->beta;
  if (contact->outside_window >= 0) row[COLUMN_OUTSIDE_WINDOW] = (PetscReal)contact->outside_window;
}

/* Fills the columns of energies that a run has whose steps are judged, and those that only one with a plastic body
   has. */
static void FillEnergy(Scene scene, const EnergyFigures *energy, PetscReal row[STEP_COLUMNS])
{
  const PetscBool plastic = SceneIsPlastic(scene);

  if (!plastic && !(scene->n_contacts && scene->output.certificate)) return;
  row[COLUMN_ELASTIC_ENERGY] = energy->elastic;
  row[COLUMN_EXTERNAL_WORK]  = energy->outer.work;
  row[COLUMN_CONTACT_ENERGY] = energy->outer.stored;
  if (!plastic) return;
  row[COLUMN_PLASTIC_STRAIN] = energy->strain;
  row[COLUMN_PLASTIC_WORK]   = energy->plastic;
  row[COLUMN_WORK]           = energy->work;
}

/* Fills the fixed columns of a row; NaN where there is no value. */
static void FillRow(Scene scene, const StepRecord *step, PetscReal wall_s, PetscReal row[STEP_COLUMNS])
{
  for (int k = 0; k < STEP_COLUMNS; k++) row[k] = NAN;
  row[COLUMN_STEP]          = (PetscReal)step->step;
  row[COLUMN_T]             = step->t;
  row[COLUMN_DT]            = step->dt;
  row[COLUMN_NEWTON]        = (PetscReal)step->newton;
  row[COLUMN_KRYLOV]        = (PetscReal)step->krylov;
  row[COLUMN_ATTEMPTS]      = (PetscReal)step->attempts;
  row[COLUMN_RESIDUAL]      = step->residual;
  row[COLUMN_WALL_S]        = wall_s;
  row[COLUMN_CONTACT_NODES] = row[COLUMN_NODES_IN] = row[COLUMN_NODES_OUT] = 0.0;
  if (scene->n_contacts) FillContact(step, row);
  FillEnergy(scene, &step->energy, row);
}

/*@
  StepsCsvWrite - adds the row of an accepted step.

  Not collective

  Input Parameters:
+ csv    - the table
. step   - the step
. wall_s - wall time since the run began, its earlier parts included (s)
- probes - values of the scene's probes, NaN where there is no value

  Note:
  For rank 0. The row has left the program when the function returns. Errors: PETSC_ERR_FILE_WRITE.
@*/
PetscErrorCode StepsCsvWrite(StepsCsv csv, const StepRecord *step, PetscReal wall_s, const PetscReal *probes)
{
  const char *during = SceneStepAt(csv->scene, step->t);
  PetscReal   row[STEP_COLUMNS];

  PetscFunctionBeginUser;
  FillRow(csv->scene, step, wall_s, row);
  for (int k = 0; k < STEP_COLUMNS; k++) {
    if (k) fputc(',', csv->file);
    PrintReal(csv->file, row[k]);
  }
  for (int i = 0; i < csv->scene->n_probes; i++) {
    fputc(',', csv->file);
    PrintReal(csv->file, probes[i]);
  }
  if (during) fputc(',', csv->file);
  if (during) PrintText(csv->file, during);
  fputc('\n', csv->file);
  PetscCheck(!fflush(csv->file), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "Cannot write %s: %s", csv->path,
             strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  StepsCsvArchive - saves or takes over how long the file is at a checkpoint.

  Collective

  Input Parameters:
+ csv     - the table
- archive - the checkpoint

  Note:
  Saving also sends the rows to the disk. Loading touches no file: StepsCsvResume() does.
@*/
PetscErrorCode StepsCsvArchive(StepsCsv csv, Archive archive)
{
  PetscFunctionBeginUser;
  if (!ArchiveLoads(archive) && csv->file) { /* only rank 0 has opened it */
    const off_t length = ftello(csv->file);

    fsync(fileno(csv->file));
    csv->length[0] = (PetscInt)(length >> LENGTH_BITS);
    csv->length[1] = (PetscInt)(length & ((1LL << LENGTH_BITS) - 1));
  }
  PetscCall(ArchiveIntegers(archive, "results/csv_length", 2, csv->length));
  PetscFunctionReturn(PETSC_SUCCESS);
}
