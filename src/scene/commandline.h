/* The command line: the arguments of Burnish, and the others for PETSc. Plain C.

   CommandLineParse() sorts the arguments before PetscInitialize(), because -help, -version and a repeated -set belong
   to Burnish and not to PETSc. It prints nothing, so that main can start MPI first and then print once, on rank 0. A
   mistake is kept in `complaint`. CommandLineHelp() and CommandLineVersion() print what -help and -version ask for.
   CommandLineDestroy() frees the result after PetscFinalize(). */
#pragma once
#include <stdio.h>

#define BURNISH_VERSION "0.1.0"

typedef enum {
  COMMAND_RUN,
  COMMAND_CHECK,
  COMMAND_MESH,
  COMMAND_IMPORT,
  COMMAND_EVALUATE,
  COMMAND_EXPLAIN,
  COMMAND_HELP,
  COMMAND_VERSION
} CommandMode;

typedef struct {
  CommandMode mode;
  char       *scene;      /* path of the scene file, or NULL */
  char       *deck;       /* value of -import, or NULL */
  char       *results;    /* value of -evaluate, or NULL */
  char       *code;       /* value of -explain, or NULL */
  char       *directory;  /* value of -o, or NULL */
  char       *restart;    /* value of -restart, or NULL */
  double      time_limit; /* value of -time_limit in seconds, or 0 for no limit */
  int         n_set;
  char      **set; /* values of -set, each KEY=VALUE */
  int         overwrite, quiet, trust;
  char        accuracy[2][256]; /* the edits that -to and -probe stand for, or empty */
  int         n_sensitivities;  /* given so far */
  char (*sensitivity)[1024];    /* the edits that they stand for */
  /* The arguments that are left for PetscInitialize(). The first one is the program's name. */
  int    argc;
  char **argv;
  /* Why the command line is refused, for RefuseInput() once MPI runs. It is empty if the command line is correct. */
  char complaint[1024];
} CommandLine;

void CommandLineParse(int argc, char **argv, CommandLine *);
void CommandLineDestroy(CommandLine *);
void CommandLineHelp(FILE *);
void CommandLineVersion(FILE *);
