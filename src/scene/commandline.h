/* What the user typed: ours of the arguments, and the rest for PETSc. Parsed before PetscInitialize(), because -help,
   -version and a repeated -set are ours; plain C that prints nothing, so that main can start MPI first and then print
   once, on rank 0. */
#pragma once
#include <stdio.h>

#define BURNISH_VERSION "0.1.0"

typedef enum { COMMAND_RUN, COMMAND_CHECK, COMMAND_MESH, COMMAND_HELP, COMMAND_VERSION } CommandMode;

typedef struct {
  CommandMode mode;
  char       *scene;      /* scene file */
  char       *directory;  /* -o, or NULL */
  char       *restart;    /* -restart, or NULL */
  double      time_limit; /* seconds; 0: none */
  int         n_set;
  char      **set; /* KEY=VALUE */
  int         overwrite, quiet;
  int         argc; /* what is left for PetscInitialize(), the program's name first */
  char      **argv;
  char        complaint[768]; /* empty, or why the command line is refused: for RefuseInput() once MPI runs */
} CommandLine;

void CommandLineParse(int argc, char **argv, CommandLine *);
void CommandLineDestroy(CommandLine *);
void CommandLineHelp(FILE *); /* commands, options, scene reference */
void CommandLineVersion(FILE *);
