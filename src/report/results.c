#include "report/results.h"
#include "base/blas.h"
#include "scene/stepcolumns.h"
#include "scene/commandline.h"
#include "endreport.h"
#include "fields.h"
#include "optionrecord.h"
#include "report/precheck.h"
#include "base/refusal.h"
#include "summary.h"
#include "base/timing.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
  MESSAGE_SIZE       = 2 * PETSC_MAX_PATH_LEN,
  LINE_SIZE          = 160,
  EXTRAPOLATION_SIZE = PETSC_MAX_PATH_LEN + 32 /* a directory and one of our names */
};

struct _n_Results {
  Model       model;
  Probes      probes;
  Scene       scene;
  char        directory[PETSC_MAX_PATH_LEN];
  PetscBool   quiet, talks; /* talks: rank 0 of a run that is not quiet */
  PetscMPIInt rank, size;
  FILE       *csv; /* rank 0 */
  Fields      fields;
  PetscReal  *values; /* of the probes, at the last accepted step */
  PetscBool  *met;    /* per contact pair: some slave node has met its master */
  StepRecord  last;
  PetscReal   deepest;          /* largest penetration so far, in face sizes */
  PetscBool   stepped, written; /* there is an accepted step; results.h5 holds it */
  double      started;
  PetscReal   t_started;
  RunUsage    before;     /* of the parts of the run before this one */
  PetscInt    restarts;   /* how many they are */
  PetscInt csv_length[2]; /* of steps.csv at the loaded checkpoint: bytes, in two parts as integers may have 32 bits */

  OptionRecord options; /* PETSc's, and how they changed at restarts */
};

/* From this on elements of first order lock: at 0.49 the bulk modulus is fifty times the shear modulus. */
#define LOCKING_NU 0.49
/* Open MPI 4 ends with a buffer overflow where the path of a file that all ranks write has some 240 characters. */
#define LONGEST_DIRECTORY 220

/* The record of the scene in its directory: one line with the file's name, then the text */
static const char record_name[] = "scene.yaml", record_head[] = "# scene: ";

static void KeyPathJoin(char path[EXTRAPOLATION_SIZE], const char *directory, const char *name)
{
  snprintf(path, EXTRAPOLATION_SIZE, "%s/%s", directory, name);
}

static PetscBool FileExists(const char *directory, const char *name)
{
  char path[EXTRAPOLATION_SIZE];

  KeyPathJoin(path, directory, name);
  return access(path, F_OK) ? PETSC_FALSE : PETSC_TRUE;
}

/* The whole of a text file, to be freed; NULL if there is none */
static char *FileRead(const char *directory, const char *name)
{
  char   path[EXTRAPOLATION_SIZE], *text = NULL;
  size_t room = 0;
  FILE  *file;

  KeyPathJoin(path, directory, name);
  file = fopen(path, "r");
  if (!file) return NULL;
  if (getdelim(&text, &room, '\0', file) < 0) {
    free(text);
    text = NULL;
  }
  fclose(file);
  return text;
}

/*
  ResultsReplaceFile - Writes a text file under a temporary name and renames it, so that readers find it whole or not at
  all. Not collective.

  Input: directory, name of the file in it, text. Errors: PETSC_ERR_FILE_WRITE.
*/
PetscErrorCode ResultsReplaceFile(const char *directory, const char *name, const char *text)
{
  char  path[EXTRAPOLATION_SIZE], temporary[EXTRAPOLATION_SIZE + 8];
  FILE *file;
  int   failed;

  PetscFunctionBeginUser;
  KeyPathJoin(path, directory, name);
  snprintf(temporary, sizeof(temporary), "%s.tmp", path);
  file = fopen(temporary, "w");
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "Cannot write %s: %s", temporary, strerror(errno));
  failed = fputs(text, file) < 0;
  failed = fclose(file) || failed;
  PetscCheck(!failed && !rename(temporary, path), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "Cannot write %s: %s", path,
             strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The line at text, without its end */
static const char *LineCopy(const char *text, char line[LINE_SIZE])
{
  size_t n = strcspn(text, "\n");

  snprintf(line, LINE_SIZE, "%.*s", (int)n, text);
  return line;
}

/* First lines in which two texts differ; an end is "(nothing)" */
static void FirstDifference(const char *a, const char *b, char line_a[LINE_SIZE], char line_b[LINE_SIZE])
{
  const size_t end = strlen("\n");

  while (*a && *b && strcspn(a, "\n") == strcspn(b, "\n") && !strncmp(a, b, strcspn(a, "\n"))) {
    a += strcspn(a, "\n");
    b += strcspn(b, "\n");
    a += *a ? end : 0;
    b += *b ? end : 0;
  }
  LineCopy(*a ? a : "(nothing)", line_a);
  LineCopy(*b ? b : "(nothing)", line_b);
}

/* Characters in the path of a directory from the root */
static size_t PathLength(const char *directory)
{
  char here[PETSC_MAX_PATH_LEN];

  return strlen(directory) + (directory[0] != '/' && getcwd(here, sizeof(here)) ? strlen(here) + 1 : 0);
}

/* Rank 0: why the directory may not be used, or an empty message */
static void DirectoryComplaint(Scene scene, const char *directory, PetscBool overwrite, char message[MESSAGE_SIZE])
{
  struct stat status;
  char       *record, there[LINE_SIZE] = "unknown", line_there[LINE_SIZE], line_here[LINE_SIZE];

  *message = '\0';
  if (stat(directory, &status)) return;
  if (!S_ISDIR(status.st_mode)) {
    snprintf(message, MESSAGE_SIZE,
             "-o %s: a file of that name is in the way; allowed: a directory, or a name that is free", directory);
    return;
  }
  if (overwrite) return;
  record = FileRead(directory, record_name);
  if (record && !strncmp(record, record_head, strlen(record_head))) {
    const char *text = strchr(record, '\n');

    LineCopy(record + strlen(record_head), there);
    text = text ? text + 1 : "";
    if (strcmp(text, scene->text)) {
      FirstDifference(text, scene->text, line_there, line_here);
      snprintf(message, MESSAGE_SIZE,
               "%s holds the results of another scene: of %s, not of %s (first difference: \"%s\" there, \"%s\" here); "
               "allowed: another directory (-o DIR), or "
               "-overwrite",
               directory, there, scene->file, line_there, line_here);
    }
  } else if (record || FileExists(directory, "summary.json") || FileExists(directory, "steps.csv")) {
    snprintf(message, MESSAGE_SIZE,
             "%s holds results of an unknown scene, not of %s: it has no %s of ours; allowed: another directory (-o "
             "DIR), or -overwrite",
             directory, scene->file, record_name);
  }
  free(record);
}

/*@
  ResultsCheckPath - refuses (exit 1) a directory whose path is too long for the files in it.

  Collective

  Input Parameters:
+ comm      - all ranks
- directory - of the results; it need not exist
@*/
PetscErrorCode ResultsCheckPath(MPI_Comm comm, const char *directory)
{
  char        message[MESSAGE_SIZE] = "";
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank && PathLength(directory) > LONGEST_DIRECTORY)
    snprintf(
      message, sizeof(message),
      "-o %s: the path has %zu characters from the root; allowed: at most %d, as MPI's files take no longer ones",
      directory, PathLength(directory), LONGEST_DIRECTORY);
  PetscCall(RefuseInputAnywhere(comm, *message ? message : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  ResultsCheckDirectory - Refuses (exit 1) a directory that holds another scene's results, unless they may be
  overwritten. Collective.

  Input: scene, directory (need not exist), overwrite. Nothing is written; the same scene's results are overwritten
  without a word.
*/
PetscErrorCode ResultsCheckDirectory(MPI_Comm comm, Scene scene, const char *directory, PetscBool overwrite)
{
  char        message[MESSAGE_SIZE] = "";
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) DirectoryComplaint(scene, directory, overwrite, message);
  PetscCall(RefuseInputAnywhere(comm, *message ? message : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  ResultsCheckRestart - Refuses (exit 1) to go on in a directory that holds the results of another scene than its
  checkpoint's. Collective.

  Input: scene (of the checkpoint), directory. One without a record is fine: a checkpoint may be taken elsewhere.
*/
PetscErrorCode ResultsCheckRestart(MPI_Comm comm, Scene scene, const char *directory)
{
  char        message[MESSAGE_SIZE] = "", *record = NULL, *text;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) record = FileRead(directory, record_name);
  text = record ? strchr(record, '\n') : NULL;
  if (text && !SceneSameProblem(text + 1, scene->text))
    snprintf(message, MESSAGE_SIZE,
             "%s holds the results of another scene than checkpoint.h5 there, which is of %s; allowed: the checkpoint "
             "of these results",
             directory, scene->file);
  free(record);
  PetscCall(RefuseInputAnywhere(comm, *message ? message : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rank 0: makes the directory and those above it; an empty message if it is there in the end */
static void DirectoryMake(const char *directory, char message[MESSAGE_SIZE])
{
  char path[PETSC_MAX_PATH_LEN];

  *message = '\0';
  snprintf(path, sizeof(path), "%s", directory);
  for (char *slash = strchr(path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
    *slash = '\0';
    mkdir(path, 0777);
    *slash = '/';
  }
  if (mkdir(path, 0777) && errno != EEXIST)
    snprintf(message, MESSAGE_SIZE, "-o %s: the directory cannot be made: %s; allowed: a place that can be written",
             directory, strerror(errno));
  else if (access(path, W_OK | X_OK))
    snprintf(message, MESSAGE_SIZE, "-o %s: %s; allowed: a directory that can be written", directory, strerror(errno));
}

/* Rank 0: takes away what an earlier run left, so that a killed run shows no file of another one */
static void DirectoryClear(const char *directory)
{
  static const char *const names[] = {"summary.json", "results.xdmf", "results.h5", "checkpoint.h5",
                                      "checkpoint.h5.tmp"};
  char                     path[EXTRAPOLATION_SIZE];

  for (size_t i = 0; i < sizeof(names) / sizeof(names[0]); i++) {
    KeyPathJoin(path, directory, names[i]);
    unlink(path);
  }
}

static PetscErrorCode ResultsWriteRecord(Results results)
{
  const size_t size = strlen(record_head) + strlen(results->scene->file) + strlen(results->scene->text) + sizeof("\n");
  char        *text;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(size, &text));
  snprintf(text, size, "%s%s\n%s", record_head, results->scene->file, results->scene->text);
  PetscCall(ResultsReplaceFile(results->directory, record_name, text));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A name as a CSV field: quoted where it must be */
static void CsvPrintText(FILE *csv, const char *text)
{
  if (!strpbrk(text, ",\"\n")) {
    fputs(text, csv);
    return;
  }
  fputc('"', csv);
  for (; *text; text++) {
    if (*text == '"') fputc('"', csv);
    fputc(*text, csv);
  }
  fputc('"', csv);
}

/* A number as a CSV field; nothing where there is no value */
static void CsvPrintReal(FILE *csv, PetscReal value)
{
  if (isfinite((double)value)) fprintf(csv, "%.15g", (double)value);
}

/* Bytes in two numbers of 31 bits: an index may have no more */
enum { LENGTH_BITS = 31 };

static off_t CsvLength(const PetscInt length[2])
{
  return (off_t)length[0] << LENGTH_BITS | (off_t)length[1];
}

/* Cuts the rows after the loaded checkpoint off and goes on behind the others; *lost: they are gone. */
static PetscErrorCode ResultsReopenCsv(Results results, PetscBool *lost)
{
  const off_t length = CsvLength(results->csv_length);
  char        path[EXTRAPOLATION_SIZE];
  struct stat status;

  PetscFunctionBeginUser;
  KeyPathJoin(path, results->directory, "steps.csv");
  *lost = stat(path, &status) || status.st_size < length ? PETSC_TRUE : PETSC_FALSE;
  if (*lost) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(!truncate(path, length) && (results->csv = fopen(path, "a")), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN,
             "Cannot write %s: %s", path, strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ResultsOpenCsv(Results results)
{
  char path[EXTRAPOLATION_SIZE];

  PetscFunctionBeginUser;
  KeyPathJoin(path, results->directory, "steps.csv");
  results->csv = fopen(path, "w");
  PetscCheck(results->csv, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "Cannot write %s: %s", path, strerror(errno));
  for (int k = 0; k < STEP_COLUMNS; k++) fprintf(results->csv, "%s%s", k ? "," : "", StepColumnNames[k]);
  for (int i = 0; i < results->scene->n_probes; i++) {
    fputc(',', results->csv);
    CsvPrintText(results->csv, results->scene->probes[i].name);
  }
  fputc('\n', results->csv);
  PetscCheck(!fflush(results->csv), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "Cannot write %s: %s", path,
             strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The fixed columns of a row; NaN where there is no value */
static void ResultsFillRow(Results results, const StepRecord *step, PetscReal row[STEP_COLUMNS])
{
  const ContactSummary *contact = &step->contact;

  for (int k = 0; k < STEP_COLUMNS; k++) row[k] = NAN;
  row[COLUMN_STEP]          = (PetscReal)step->step;
  row[COLUMN_T]             = step->t;
  row[COLUMN_DT]            = step->dt;
  row[COLUMN_NEWTON]        = (PetscReal)step->newton;
  row[COLUMN_KRYLOV]        = (PetscReal)step->krylov;
  row[COLUMN_ATTEMPTS]      = (PetscReal)step->attempts;
  row[COLUMN_RESIDUAL]      = step->residual;
  row[COLUMN_WALL_S]        = results->before.wall_s + MPI_Wtime() - results->started;
  row[COLUMN_CONTACT_NODES] = row[COLUMN_NODES_IN] = row[COLUMN_NODES_OUT] = 0.0;
  if (!results->model->contact) return;
  row[COLUMN_CONTACT_NODES]   = (PetscReal)contact->nodes;
  row[COLUMN_NODES_IN]        = (PetscReal)contact->in;
  row[COLUMN_NODES_OUT]       = (PetscReal)contact->out;
  row[COLUMN_MAX_PENETRATION] = contact->max_penetration;
  row[COLUMN_MIN_PENETRATION] = contact->min_penetration;
  row[COLUMN_PENALTY_MIN]     = contact->penalty_min;
  row[COLUMN_PENALTY_MAX]     = contact->penalty_max;
  row[COLUMN_CONTACT_FORCE]   = contact->force;
  row[COLUMN_BETA]            = step->beta;
  if (contact->outside_window >= 0) row[COLUMN_OUTSIDE_WINDOW] = (PetscReal)contact->outside_window;
}

static PetscErrorCode ResultsPrintCsv(Results results, const StepRecord *step)
{
  FILE     *csv = results->csv;
  PetscReal row[STEP_COLUMNS];

  PetscFunctionBeginUser;
  ResultsFillRow(results, step, row);
  for (int k = 0; k < STEP_COLUMNS; k++) {
    if (k) fputc(',', csv);
    CsvPrintReal(csv, row[k]);
  }
  for (int i = 0; i < results->scene->n_probes; i++) {
    fputc(',', csv);
    CsvPrintReal(csv, results->values[i]);
  }
  fputc('\n', csv);
  PetscCheck(!fflush(csv), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "Cannot write %s/steps.csv: %s", results->directory,
             strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void ResultsPrintBlas(void)
{
  Blas blas;

  BlasFind(&blas);
  printf("BLAS     ");
  BlasPrint(&blas, stdout);
  if (blas.reference)
    printf("warning: this is the reference BLAS; the direct solver is 6 to 7 times faster with OpenBLAS (Debian: apt "
           "install libopenblas0-serial)\n");
}

static PetscErrorCode ResultsPrintSolver(Results results)
{
  KSP           ksp;
  PC            pc;
  KSPType       method;
  PCType        conditioner;
  MatSolverType package = NULL;
  PetscBool     factors = PETSC_FALSE, own = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(SNESGetKSP(results->model->snes, &ksp));
  PetscCall(KSPGetType(ksp, &method));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCGetType(pc, &conditioner));
  if (conditioner) PetscCall(PetscObjectTypeCompareAny((PetscObject)pc, &factors, PCLU, PCCHOLESKY, PCILU, PCICC, ""));
  if (factors) PetscCall(PCFactorGetMatSolverType(pc, &package));
  if (conditioner) PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCSHELL, &own));
  if (own) PetscCall(PCShellGetName(pc, &conditioner));
  if (results->talks)
    printf("solver   %s, %s%s%s\n", method ? method : "PETSc's default", conditioner ? conditioner : "PETSc's default",
           package ? ", " : "", package ? package : "");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ResultsPrintHead(Results results)
{
  char     effects[MESSAGE_SIZE];
  PetscInt dofs;

  PetscFunctionBeginUser;
  PetscCall(ModelEffects(results->model, effects, sizeof(effects)));
  PetscCall(ModelDofs(results->model, &dofs));
  if (results->talks) {
    printf("burnish %s: %s (%s)\n", BURNISH_VERSION, results->scene->name, results->scene->file);
    printf("machine  %d rank%s, PETSc %d.%d.%d, %d-bit indices\n", results->size, results->size > 1 ? "s" : "",
           PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR, (int)(8 * sizeof(PetscInt)));
    ResultsPrintBlas();
  }
  if (results->talks && results->restarts)
    printf("restart  after step %lld, t = %g\n", (long long)results->last.step, (double)results->model->t);
  if (results->talks) OptionRecordPrint(&results->options, stdout);
  PetscCall(ResultsPrintSolver(results));
  if (!results->quiet) PetscCall(MeshReport(results->model->mesh, results->scene, stdout));
  if (results->talks) printf("dofs     %lld free\neffects  %s\n", (long long)dofs, *effects ? effects : "none");
  if (!results->quiet) PetscCall(PrecheckMotions(results->model, stdout));
  if (results->talks) {
    printf("\n%5s %9s %9s %10s %10s %5s %5s %8s %12s %8s %8s\n", "step", "t", "dt", "iterations", "in contact", "in",
           "out", "beta", "penetration", "spent", "left");
    fflush(stdout);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "12.3 s", "4 min 5 s", "2 h 7 min" */
static const char *DurationText(double seconds, char text[32])
{
  const long s = (long)seconds;

  if (s < 60)
    snprintf(text, 32, "%.1f s", seconds);
  else if (s < 3600)
    snprintf(text, 32, "%ld:%02ld min", s / 60, s % 60);
  else
    snprintf(text, 32, "%ld:%02ld h", s / 3600, s / 60 % 60);
  return text;
}

static void ResultsPrintStep(Results results, const StepRecord *step)
{
  const double spent = MPI_Wtime() - results->started, way = (double)(step->t - results->t_started);
  char         spent_text[32], left_text[32];

  printf("%5lld %9.5g %9.3g %10lld", (long long)step->step, (double)step->t, (double)step->dt, (long long)step->newton);
  if (results->model->contact) {
    printf(" %10lld %5lld %5lld", (long long)step->contact.nodes, (long long)step->contact.in,
           (long long)step->contact.out);
    if (isfinite((double)step->beta))
      printf(" %8.3g", (double)step->beta);
    else
      printf(" %8s", "-");
    printf(" %12.3e", (double)step->contact.max_penetration);
  } else
    printf(" %10s %5s %5s %8s %12s", "-", "-", "-", "-", "-");
  printf(" %8s %8s\n", DurationText(spent, spent_text),
         way > 0.0 ? DurationText(spent * (1.0 - (double)step->t) / way, left_text) : "-");
  if (step->tied)
    printf("      %lld nodes come into contact together: no step above dt_min separates them\n", (long long)step->tied);
  fflush(stdout);
}

/*
  ResultsCreate - The results of one run; nothing is touched before ResultsStart(). Collective.

  Input: model, probes (of that model), scene, directory, quiet (nothing on the terminal but errors).
*/
PetscErrorCode ResultsCreate(Model model, Probes probes, Scene scene, const char *directory, PetscBool quiet,
                             Results *result)
{
  const MPI_Comm comm = model->mesh->comm;
  Results        results;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&results));
  results->model  = model;
  results->probes = probes;
  results->scene  = scene;
  PetscCall(PetscStrncpy(results->directory, directory, sizeof(results->directory)));
  PetscCallMPI(MPI_Comm_rank(comm, &results->rank));
  PetscCallMPI(MPI_Comm_size(comm, &results->size));
  results->quiet = quiet;
  results->talks = results->rank == 0 && !quiet ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscCalloc2(scene->n_probes, &results->values, scene->n_contacts, &results->met));
  PetscCall(FieldsCreate(model, scene, directory, &results->fields));
  PetscCall(OptionRecordCreate(&results->options));
  *result = results;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ResultsDestroy - Closes the files and frees the results. Collective. */
PetscErrorCode ResultsDestroy(Results *results)
{
  PetscFunctionBeginUser;
  if (!*results) PetscFunctionReturn(PETSC_SUCCESS);
  if ((*results)->csv) fclose((*results)->csv);
  PetscCall(FieldsDestroy(&(*results)->fields));
  PetscCall(OptionRecordDestroy(&(*results)->options));
  PetscCall(PetscFree2((*results)->values, (*results)->met));
  PetscCall(PetscFree(*results));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ResultsGetProbes - gives the values of the probes at the last accepted step

  Not collective

  Input Parameter:
. results - the results

  Output Parameter:
. values - scene->n_probes, which belong to the results; NULL before the first accepted step
@*/
PetscErrorCode ResultsGetProbes(Results results, const PetscReal **values)
{
  PetscFunctionBeginUser;
  *values = results->stepped ? results->values : NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rank 0 tells of a file that was there when the loaded checkpoint was written. */
static void ResultsPrintLost(Results results, const char *name)
{
  if (results->rank == 0)
    fprintf(stderr, "burnish: warning: %s/%s is not what the checkpoint left: it begins anew after step %lld\n",
            results->directory, name, (long long)results->last.step);
}

/* The directory as it was at the loaded checkpoint. */
static PetscErrorCode ResultsResume(Results results)
{
  char      path[EXTRAPOLATION_SIZE];
  PetscBool lost = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(FieldsResume(results->fields, &lost));
  if (lost) ResultsPrintLost(results, "results.h5");
  if (results->rank) PetscFunctionReturn(PETSC_SUCCESS);
  KeyPathJoin(path, results->directory, "summary.json");
  unlink(path);
  PetscCall(ResultsWriteRecord(results));
  PetscCall(ResultsReopenCsv(results, &lost));
  if (lost) {
    ResultsPrintLost(results, "steps.csv");
    PetscCall(ResultsOpenCsv(results));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Elements of first order with full integration keep their volume at every quadrature point where nu is near a half,
 * and so hardly deform. */
static void ResultsPrintLocking(Results results)
{
  const Scene scene = results->scene;

  for (int b = 0; b < scene->n_bodies && !results->rank && results->model->mesh->order == 1; b++) {
    if (scene->bodies[b].rigid || scene->bodies[b].formulation != FORMULATION_FULL ||
        scene->bodies[b].material.nu < LOCKING_NU)
      continue;
    fprintf(stderr,
            "burnish: warning: %s: nu = %g with elements of first order and full integration: they lock (too stiff); "
            "mesh.order: 2 does not\n",
            SceneWhere(scene, scene->bodies[b].path, "material.nu"), scene->bodies[b].material.nu);
  }
}

/* A mesher that merges the points in which two bodies touch has joined them: no load would part them, and no gap say
 * so. */
static PetscErrorCode ResultsPrintJoined(Results results)
{
  const Scene  scene = results->scene;
  PetscInt     nodes;
  ContactPlace place;

  PetscFunctionBeginUser;
  for (int p = 0; p < scene->n_contacts; p++) {
    const SceneContact *contact = &scene->contacts[p];

    PetscCall(ContactPairJoined(results->model->contact, p, &nodes, &place));
    if (results->rank || !nodes) continue;
    fprintf(stderr,
            "burnish: warning: contact '%s': '%s' and '%s' have %" PetscInt_FMT
            " node%s in common, as node %" PetscInt_FMT " (%.6g, %.6g, %.6g): there they are one body and never part\n",
            contact->name, contact->slave, contact->master, nodes, nodes > 1 ? "s" : "", place.tag, (double)place.X[0],
            (double)place.X[1], (double)place.X[2]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  ResultsStart - Makes the directory with the record of the scene and the head of steps.csv, and prints the run's first
  lines. The time spent counts from here. Collective. Errors: refuses (exit 1) a directory that cannot be made or
  written.
*/
PetscErrorCode ResultsStart(Results results)
{
  char message[MESSAGE_SIZE] = "";

  PetscFunctionBeginUser;
  results->started   = MPI_Wtime();
  results->t_started = results->model->t;
  if (results->rank == 0) DirectoryMake(results->directory, message);
  PetscCall(RefuseInputAnywhere(results->model->mesh->comm, *message ? message : NULL));
  if (results->restarts)
    PetscCall(ResultsResume(results));
  else if (results->rank == 0) {
    DirectoryClear(results->directory);
    PetscCall(ResultsWriteRecord(results));
    PetscCall(ResultsOpenCsv(results));
  }
  PetscCall(ResultsPrintHead(results));
  ResultsPrintLocking(results);
  PetscCall(ResultsPrintJoined(results));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The state of the last accepted step into results.h5 */
static PetscErrorCode ResultsWriteFields(Results results)
{
  PetscFunctionBeginUser;
  PetscCall(FieldsWrite(results->fields, results->last.step, results->last.t));
  results->written = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which pairs have come into contact by now */
static PetscErrorCode ResultsWatchContact(Results results)
{
  Model model = results->model;

  PetscFunctionBeginUser;
  for (int p = 0; p < results->scene->n_contacts; p++) {
    ContactNodes nodes;
    int          met = 0;

    if (results->met[p]) continue;
    PetscCall(ContactGetNodes(model->contact, p, model->u, &nodes));
    for (PetscInt c = 0; c < nodes.n; c++) met = met || nodes.force[c] != 0;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &met, 1, MPI_INT, MPI_LOR, model->mesh->comm));
    results->met[p] = met ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  ResultsStep - An accepted step, while the model is in its state: probes, a row of steps.csv, a line on the terminal,
  and fields at every output.every-th step. Collective.
*/
PetscErrorCode ResultsStep(Results results, const StepRecord *step)
{
  const int every = results->scene->output.every;

  PetscFunctionBeginUser;
  PetscCall(ProbesEvaluate(results->probes, results->values));
  TimingBegin(TIMING_OUTPUT);
  PetscCall(ResultsWatchContact(results));
  results->last    = *step;
  results->stepped = PETSC_TRUE;
  results->written = PETSC_FALSE;
  results->deepest = PetscMax(results->deepest, step->contact.max_penetration_over_h);
  if (results->rank == 0) PetscCall(ResultsPrintCsv(results, step));
  if (every > 0 && step->step % every == 0) PetscCall(ResultsWriteFields(results));
  TimingEnd(TIMING_OUTPUT);
  if (results->talks) ResultsPrintStep(results, step);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What all parts of the run have used until now */
static PetscErrorCode ResultsUsage(Results results, RunUsage *usage)
{
  const RunUsage *before = &results->before;

  PetscFunctionBeginUser;
  PetscCall(RunUsageCollect(results->model->mesh->comm, usage));
  usage->wall_s = before->wall_s + MPI_Wtime() - results->started;
  usage->cpu_s += before->cpu_s;
  usage->peak_rss_mb = PetscMax(usage->peak_rss_mb, before->peak_rss_mb);
  for (int k = 0; k < TIMING_KINDS; k++) usage->seconds[k] += before->seconds[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The last accepted step, and whether there is one. */
static PetscErrorCode ResultsArchiveStep(Results results, Archive archive)
{
  StepRecord     *last      = &results->last;
  ContactSummary *contact   = &last->contact;
  PetscReal      *real[]    = {&last->t,
                               &last->dt,
                               &last->residual,
                               &last->beta,
                               &results->deepest,
                               &contact->max_penetration,
                               &contact->min_penetration,
                               &contact->max_penetration_over_h,
                               &contact->penalty_min,
                               &contact->penalty_max,
                               &contact->force};
  PetscInt       *integer[] = {&last->step,     &last->attempts, &last->newton, &last->krylov,           &last->tied,
                               &contact->nodes, &contact->in,    &contact->out, &contact->outside_window};

  PetscFunctionBeginUser;
  PetscCall(ArchiveBoolean(archive, "results/stepped", &results->stepped));
  PetscCall(ArchiveBoolean(archive, "results/last_written", &results->written));
  PetscCall(ArchiveRealsAt(archive, "results/step_reals", PETSC_STATIC_ARRAY_LENGTH(real), real));
  PetscCall(ArchiveIntegersAt(archive, "results/step_numbers", PETSC_STATIC_ARRAY_LENGTH(integer), integer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  ResultsArchive - Saves or takes over what the directory holds up to the last accepted step. Collective.

  Saving also sends steps.csv to the disk. Loading comes between ResultsCreate() and ResultsStart(), which then takes
  the directory's files back to this step; nothing is touched before.
*/
PetscErrorCode ResultsArchive(Results results, Archive archive)
{
  RunUsage   usage    = {0};
  PetscReal *used[]   = {&usage.wall_s, &usage.cpu_s, &usage.peak_rss_mb};
  PetscInt   restarts = results->restarts;

  PetscFunctionBeginUser;
  if (!ArchiveLoads(archive)) PetscCall(ResultsUsage(results, &usage));
  if (!ArchiveLoads(archive) && results->rank == 0) {
    const off_t length = ftello(results->csv);

    fsync(fileno(results->csv));
    results->csv_length[0] = (PetscInt)(length >> LENGTH_BITS);
    results->csv_length[1] = (PetscInt)(length & ((1LL << LENGTH_BITS) - 1));
  }
  PetscCall(ResultsArchiveStep(results, archive));
  PetscCall(OptionRecordArchive(&results->options, results->last.step, archive));
  PetscCall(ArchiveReals(archive, "results/probes", results->scene->n_probes, results->values));
  for (int p = 0; p < results->scene->n_contacts; p++) {
    char name[LINE_SIZE];

    PetscCall(PetscSNPrintf(name, sizeof(name), "results/met/%d", p));
    PetscCall(ArchiveBoolean(archive, name, &results->met[p]));
  }
  PetscCall(ArchiveIntegers(archive, "results/csv_length", 2, results->csv_length));
  PetscCall(ArchiveRealsAt(archive, "results/used", PETSC_STATIC_ARRAY_LENGTH(used), used));
  PetscCall(ArchiveReals(archive, "results/seconds", TIMING_KINDS, usage.seconds));
  PetscCall(ArchiveIntegers(archive, "results/restarts", 1, &restarts));
  PetscCall(FieldsArchive(results->fields, archive));
  if (!ArchiveLoads(archive)) PetscFunctionReturn(PETSC_SUCCESS);
  results->before   = usage;
  results->restarts = restarts + 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Final values of the probes; a contact edge with the node spacing that is its resolution */
static PetscErrorCode ResultsPrintProbes(Results results)
{
  PetscFunctionBeginUser;
  if (!results->talks || !results->stepped) PetscFunctionReturn(PETSC_SUCCESS);
  printf("\n");
  for (int i = 0; i < results->scene->n_probes; i++) {
    PetscReal spacing;

    PetscCall(ProbesGetSpacing(results->probes, i, &spacing));
    printf("%-20s ", results->scene->probes[i].name);
    if (isfinite((double)results->values[i]))
      printf("%.9g", (double)results->values[i]);
    else
      printf("no value");
    if (isfinite((double)spacing)) printf(" (node spacing %.3g)", (double)spacing);
    printf("\n");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A misspelt PETSc option would go unnoticed: PETSc asks for what it knows and never looks at the rest. */
static PetscErrorCode ResultsPrintUnused(Results results)
{
  PetscInt n;
  char   **names, **values;

  PetscFunctionBeginUser;
  if (results->rank) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n; i++)
    fprintf(stderr, "burnish: warning: nothing used the PETSc option -%s; is it misspelt?\n", names[i]);
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the adjustment of the penalties came to; the window: at the last accepted step */
static PetscErrorCode ResultsPrintWindows(Results results)
{
  Contact contact = results->model->contact;

  PetscFunctionBeginUser;
  for (int p = 0; p < results->scene->n_contacts; p++) {
    ContactWindow window;

    if (!results->scene->contacts[p].adjust && !results->scene->contacts[p].augment) continue;
    PetscCall(ContactPairWindow(contact, p, &window));
    if (results->talks && results->scene->contacts[p].augment)
      printf("penalty of %s: augmented %lld times, %lld steps beyond g_max all the same; at the end %lld of %lld nodes "
             "in contact, largest penetration or "
             "opening %.3g g_max\n",
             ContactPairName(contact, p), (long long)window.augmented, (long long)window.missed,
             (long long)window.outside, (long long)window.loaded, (double)window.excess);
    else if (results->talks)
      printf("penalty of %s: raised %lld times, lowered %lld, cut short %lld, light nodes spared %lld; at the end %lld "
             "of %lld loaded nodes outside the "
             "window, largest penetration %.3g g_max\n",
             ContactPairName(contact, p), (long long)window.raised, (long long)window.lowered,
             (long long)window.clamped, (long long)window.light, (long long)window.outside, (long long)window.loaded,
             (double)window.excess);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A tool whose normals look the wrong way is never met: the run would end well, without contact. */
static void ResultsPrintUnmet(Results results)
{
  const Scene scene = results->scene;

  if (results->rank || !results->stepped) return;
  for (int p = 0; p < scene->n_contacts; p++) {
    const SceneContact *contact = &scene->contacts[p];

    if (results->met[p]) continue;
    fprintf(stderr,
            "burnish: warning: contact '%s': no node of '%s' met '%s' in this run; if it should have: do the master's "
            "normals point to the slave?\n",
            contact->name, contact->slave, contact->master);
  }
}

/* Bodies that lie in each other by more than their elements are no contact, whatever the law says. */
static void ResultsPrintDeep(Results results)
{
  if (results->rank || !(results->deepest > 1)) return;
  fprintf(stderr,
          "burnish: warning: a slave node was up to %.3g face sizes behind its master: the penalty is too soft for "
          "what presses\n",
          (double)results->deepest);
}

/* Linear solves that needed help, or did not become as accurate as they should be */
static void ResultsPrintLinear(Results results, const RunRecord *run)
{
  LinearCounts counts;

  LinearCheckGetCounts(results->model->linear, &counts);
  if (results->talks && counts.refined)
    printf("linear solves: %lld of %lld refined, in %lld steps\n", (long long)counts.refined, (long long)counts.solves,
           (long long)counts.steps);
  if (results->rank || !counts.inaccurate) return;
  fprintf(stderr,
          "burnish: warning: %lld of %lld linear solves left a relative residual of up to %.2g, more than 100 times "
          "the tolerance, and refinement could not lower "
          "it; %sthe system is badly conditioned: is a penalty too large?\n",
          (long long)counts.inaccurate, (long long)counts.solves, (double)counts.worst,
          run->message ? "" : "Newton's method converged all the same, but ");
}

static void ResultsPrintEnd(Results results, const RunRecord *run)
{
  char text[32];

  if (results->rank == 0 && run->message) fprintf(stderr, "burnish: %s: %s\n", run->status, run->message);
  if (!results->talks) return;
  if (run->way->relaxed)
    printf("stabilised pairs: springs relaxed %lld times, took out an energy of %.3g, hold at most %.2g of an accepted "
           "state's\n",
           (long long)run->way->relaxed, (double)run->way->taken, (double)run->way->left);
  if (run->way->cycles)
    printf("contact sets that repeated themselves: %lld, steps cut for it %lld; the last time %s\n",
           (long long)run->way->cycles, (long long)run->way->cycles_cut, run->way->cycle);
  printf("%s: %lld steps (%lld failed, %lld repeated), %lld iterations, %s; results in %s\n", run->status,
         (long long)run->way->steps, (long long)run->way->steps_failed, (long long)run->way->steps_repeated,
         (long long)run->way->newton_iterations, DurationText((double)run->wall_s, text), results->directory);
  fflush(stdout);
}

/*
  ResultsFinish - The last accepted state into results.h5 unless it is there, summary.json, and the last lines on the
  terminal. To be called however the run ended, with the model in its last accepted state. A message in the record goes
  to stderr, also when quiet. Collective.
*/
PetscErrorCode ResultsFinish(Results results, const RunRecord *run)
{
  RunUsage   usage;
  RunFigures figures;

  PetscFunctionBeginUser;
  TimingBegin(TIMING_OUTPUT);
  if (results->stepped && !results->written) PetscCall(ResultsWriteFields(results));
  TimingEnd(TIMING_OUTPUT);
  PetscCall(ResultsUsage(results, &usage));
  usage.wall_s = results->before.wall_s + run->wall_s;
  PetscCall(RunFiguresCollect(results->model, results->scene, run, &usage, results->restarts,
                              results->stepped ? &results->last : NULL, &figures));
  figures.options_changed = results->options.changes;
  if (!results->rank) PetscCall(SummaryWrite(results->model->mesh, &figures, results->directory, results->values));
  PetscCall(ResultsPrintProbes(results));
  PetscCall(ResultsPrintWindows(results));
  if (results->talks) EndReportPrint(&figures, stdout);
  PetscCall(RunFiguresDestroy(&figures));
  PetscCall(ResultsPrintUnused(results));
  ResultsPrintUnmet(results);
  ResultsPrintDeep(results);
  ResultsPrintLinear(results, run);
  ResultsPrintEnd(results, run);
  PetscFunctionReturn(PETSC_SUCCESS);
}
